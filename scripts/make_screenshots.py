"""Takes the pictures of README from the pages themselves, in a headless Chromium.

    python scripts/make_screenshots.py [folder]

Needs the extra ``test`` (playwright) and a Chromium on the path. Look at the pictures: a script
can tell that there is one, not that it is readable.
"""

from __future__ import annotations

import io
import shutil
import sys
import tempfile
from collections.abc import Callable
from pathlib import Path

import numpy as np
from PIL import Image
from playwright.sync_api import sync_playwright

import kinlab as kl
from kinlab.host.files import write_bytes
from kinlab.viewer import motions
from kinlab.viewer.page.page import Page

FLAGS = ("--use-angle=swiftshader", "--enable-unsafe-swiftshader", "--no-sandbox")
SIZE = {"width": 1200, "height": 700}


def dh_rows() -> Page:
    """The Puma with Craig's frames: one row, all rows, and the ellipsoid."""
    return kl.viewer.Scene(kl.load("puma560_modified"), [0.6, 0.75, -0.35, 0.4, 0.8, 0.3])


def five_bar() -> Page:
    """The isotropic five-bar with its workspace, loci and velocity ellipsoid."""
    scene = kl.viewer.FiveBarScene(kl.FiveBar.load("isotropic"))
    scene.show(scene.q + np.array([0.25, -0.1]))
    return scene


def workspace() -> Page:
    """A slice of the UR5's workspace coloured by 1/kappa, with two ghosts and a path."""
    robot = kl.load("erd:ur5")
    q = np.array([-0.4, -1.0, 1.5, -0.9, -1.4, 0.3])
    scene = kl.viewer.Scene(robot, q)
    rng = np.random.default_rng(0)
    poses = np.tile(q, (4000, 1))
    poses[:, 1:4] = rng.uniform([-2.6, -2.8, -2.0], [-0.2, 2.8, 2.0], (4000, 3))
    at = kl.fk(robot, poses)[:, :3, 3]
    sigma = np.linalg.svd(kl.jacobian(robot, poses), compute_uv=False)
    above = (at[:, 2] > 0.0) & (at[:, 2] < 0.7)
    scene.points("workspace slice: 1/κ", at[above], (sigma[:, -1] / sigma[:, 0])[above], 0.012)
    move = motions.motion(robot, "pick", q)
    scene.path("pick and place", kl.fk(robot, move.q)[:, :3, 3])
    scene.show(move.q[0])
    scene.ghosts("along it", move.q[[60, 120]])
    return scene


PICTURES: dict[str, tuple[Callable[[], Page], str]] = {
    "dh_row": (dh_rows, "page.show('frames', false); page.showRow('2');"),
    "dh_all": (dh_rows, "page.show('frames', false); page.showRow('all');"),
    "ellipsoid": (dh_rows, "page.show('frames', false); page.show('velocity', true);"),
    "five_bar": (five_bar, "page.show('workspace', true); page.show('velocity', true);"),
    "workspace": (workspace, "page.show('frames', false);"),
}
"""Name: the page, and what is clicked in it."""


def main(folder: Path) -> None:
    """Takes every picture."""
    folder.mkdir(parents=True, exist_ok=True)
    executable = shutil.which("chromium") or shutil.which("google-chrome")
    with sync_playwright() as playwright, tempfile.TemporaryDirectory() as work:
        browser = playwright.chromium.launch(executable_path=executable, args=list(FLAGS))
        for name, (build, clicks) in PICTURES.items():
            file = Path(work) / f"{name}.html"
            build().save(file)
            tab = browser.new_page(viewport=SIZE)
            tab.goto(file.as_uri())
            tab.wait_for_function("window.page && !viewer.needs_render")
            tab.evaluate(f"() => {{ {clicks} }}")
            tab.wait_for_timeout(500)
            picture = Image.open(io.BytesIO(tab.screenshot())).convert("RGB")
            out = io.BytesIO()
            picture.save(out, "PNG", optimize=True)
            write_bytes(folder / f"{name}.png", out.getvalue())
            print(f"{folder / name}.png  {len(out.getvalue()) // 1000} kB")
            tab.close()
        browser.close()


if __name__ == "__main__":
    default = Path(__file__).resolve().parent / "screenshots"
    main(Path(sys.argv[1]) if len(sys.argv) > 1 else default)
