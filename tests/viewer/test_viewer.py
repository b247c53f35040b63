"""The viewer without a browser: what is drawn, what is refused, what a cold start costs."""

from __future__ import annotations

import html
import json
import re
import subprocess
import sys
from pathlib import Path

import numpy as np
import pinocchio as pin
import pytest
import umsgpack
from console import kinlab as run
from scenes import drawn, paths, told

import kinlab as kl
from kinlab.errors import (
    FileError,
    NameUnknownError,
    OptionError,
    SingularError,
    StateError,
    StructureError,
    UnreachableError,
)
from kinlab.fivebar.files import presets
from kinlab.model.library import shipped
from kinlab.viewer import fivebar_motions, motions, show
from kinlab.viewer.arm_page import judged_rows
from kinlab.viewer.drawing.shapes import round_step
from kinlab.viewer.page.static_page import new_scene
from kinlab.viewer.scene import FiveBarScene, Scene

ROOT = Path(__file__).resolve().parents[2]

MESHES = """<robot name="meshy"><link name="a"><visual><geometry>
<mesh filename="package://nowhere/base.dae"/></geometry></visual></link>
<link name="b"><visual><geometry><mesh filename="arm.wrl"/></geometry></visual></link>
<joint name="j" type="revolute"><parent link="a"/><child link="b"/><axis xyz="0 0 1"/>
<limit lower="-1" upper="1" velocity="1" effort="1"/></joint></robot>"""


@pytest.mark.parametrize("name", sorted(shipped()))
def test_every_shipped_arm_is_drawn(name):
    robot = kl.load(name)
    scene = Scene(robot)
    assert scene.notes == ()
    bodies = [path for path in paths(scene) if "/visuals/" in path]
    assert len(bodies) >= robot.n
    text = scene.html()
    assert len(text) < 2_000_000
    # nothing is fetched: no script, style, image or socket from elsewhere in our part of the page
    ours = text.split("</script>")
    assert not re.search(r"""(?:src|href)=["'](?!data:)""", ours[0].split("<script>")[0])


@pytest.mark.parametrize("name", sorted(presets()))
def test_every_shipped_five_bar_is_drawn(name):
    page = FiveBarScene(kl.FiveBar.load(name))
    assert {f"/meshcat/fivebar/{part}{i}/bar" for part in ("crank",) for i in (1, 2)} <= paths(page)
    assert len(page.html()) < 4_000_000


def test_missing_meshes_are_named_and_stood_in_for():
    scene = Scene(kl.Robot.from_urdf(MESHES))
    assert len(scene.notes) == 2
    assert "link 'a': mesh 'package://nowhere/base.dae' is missing" in scene.notes[0]
    assert "link 'b': mesh 'arm.wrl' is missing" in scene.notes[1]
    assert any("stand_in" in path for path in paths(scene))


def test_without_meshes_rods_stand_in():
    robot = kl.load("erd:ur5")
    bare = Scene(robot, meshes=False)
    assert bare.notes == ()
    assert len(bare.html()) < 2_000_000
    assert sum("stand_in/ball" in path for path in paths(bare)) == robot.n


def test_robot_without_urdf_is_drawn():
    model = kl.load("puma560").model
    scene = Scene(kl.Robot.from_model(model))
    assert sum("stand_in/ball" in path for path in paths(scene)) == 6


def test_names_cannot_close_the_script():
    text = MESHES.replace('name="meshy"', 'name="&lt;/script>&lt;b>"')
    page = Scene(kl.Robot.from_urdf(text)).html()
    assert "</script><b>" not in page


def test_marks_are_drawn_replaced_and_deleted():
    robot = kl.load("puma560")
    scene = Scene(robot)
    scene.frame("goal", kl.fk(robot, np.zeros(6)))
    scene.path("way", [[0, 0, 0], [1, 0, 0], [1, 0, 1]], color=0xFF0000)
    scene.points("cloud", np.eye(3), values=[1, 2, 3])
    scene.ellipsoid("grip", np.full(6, 0.3), "force")
    scene.ghosts("branches", np.full((2, 6), 0.4))
    added = "/meshcat/added"
    assert {f"{added}/way", f"{added}/cloud", f"{added}/grip"} <= paths(scene)
    assert sum(path.startswith(f"{added}/branches/") for path in paths(scene)) > 12
    count = len(drawn(scene))
    scene.frame("goal", np.eye(4))
    scene.points("cloud", np.eye(3), values=[1, 2, 4])
    assert len(drawn(scene)) == count
    assert [x["html"] for x in told(scene)["labels"]].count("goal") == 1
    assert [x["high"] for x in told(scene)["legend"]] == [4.0]
    for name in ("goal", "way", "cloud", "grip", "branches"):
        scene.delete(name)
    assert not any(path.startswith(added) for path in paths(scene))
    assert told(scene)["legend"] == []


def test_ellipsoid_axes():
    """Against the matrix J J^T itself."""
    robot = kl.load("puma560")
    q = np.array([0.1, 0.5, -0.3, 0.4, 0.8, 0.2])
    scene = Scene(robot)
    scene.ellipsoid("e", q)
    (move,) = (c for c in drawn(scene) if c["type"] == "set_transform" and c["path"].endswith("/e"))
    shape = np.reshape(move["matrix"], (4, 4)).T
    J = kl.jacobian(robot, q)[:3]
    ratio = shape[:3, :3] @ shape[:3, :3].T
    assert np.abs(ratio / np.trace(ratio) - J @ J.T / np.trace(J @ J.T)).max() < 1e-12
    assert np.linalg.det(shape[:3, :3]) > 0


@pytest.mark.parametrize(
    ("call", "error", "words"),
    [
        (lambda s: s.show([0.0]), StateError, "q has shape"),
        (lambda s: s.show([[0.0] * 6] * 2), StateError, "give one pose"),
        (lambda s: s.show([np.nan] * 6), StateError, "finite"),
        (lambda s: s.frame("f", np.zeros((4, 4))), StateError, "frame 'f'"),
        (lambda s: s.frame("", np.eye(4)), OptionError, "must have a name"),
        (lambda s: s.path("p", [[0, 0, 0]]), StateError, "N at least 2"),
        (lambda s: s.path("p", [[0, 0], [1, 1]]), StateError, "shape (2, 2)"),
        (lambda s: s.points("p", np.empty((0, 3))), StateError, "N at least 1"),
        (lambda s: s.points("p", np.eye(3), values=[1, 2]), StateError, "values"),
        (lambda s: s.ellipsoid("e", [0.0] * 6, "speed"), NameUnknownError, "velocity"),
        (lambda s: s.animate([[0.0] * 6], 1.0), StateError, "N at least 2"),
        (lambda s: s.animate(np.zeros((3, 6)), -1.0), OptionError, "positive"),
        (lambda s: s.animate(np.zeros((3, 6)), [0, 2, 1]), OptionError, "grow"),
        (lambda s: s.save("/nowhere/at/all.html"), FileError, "cannot be written"),
        (lambda s: s.save("/"), FileError, "folder"),
    ],
)
def test_bad_input_is_refused_by_name(call, error, words):
    scene = Scene(kl.load("puma560"))
    before = scene.html()
    with pytest.raises(error, match=re.escape(words)):
        call(scene)
    assert scene.html() == before


def test_five_bar_starts_are_checked():
    linkage = kl.FiveBar(l1=0.3, l2=0.35, e=0.1)
    with pytest.raises(UnreachableError):
        FiveBarScene(linkage, [0.0, np.pi])
    with pytest.raises(StateError):
        FiveBarScene(linkage, [0.0, 0.0, 0.0])
    stretched = np.arccos((0.7 - 0.2) / 0.6)
    with pytest.raises((SingularError, UnreachableError)):
        FiveBarScene(linkage, [-stretched, np.pi + stretched])
    with pytest.raises(StateError):
        FiveBarScene(linkage).show([1.0])


def test_tasks_of_the_read_out():
    expected = {
        "puma560": "task pose", "panda": "task pose", "planar2r": "task xy",
        "planar3r": "task xytheta", "spatial3r": "task position", "scara": "task x, y, z, ωz",
    }  # fmt: skip
    for name, task in expected.items():
        assert judged_rows(kl.load(name))[1] == task


@pytest.mark.parametrize("name", ["puma560", "planar2r", "panda", "stanford", "scara"])
@pytest.mark.parametrize("kind", ["sweep", "line", "pick"])
def test_motions_keep_limits_and_continuity(name, kind):
    robot = kl.load(name)
    found = motions.motion(robot, kind, np.clip(np.zeros(robot.n), robot.lower, robot.upper))
    assert np.all(found.q >= robot.lower - 1e-12)
    assert np.all(found.q <= robot.upper + 1e-12)
    assert np.abs(np.diff(found.q, axis=0)).max() < 0.35
    tool = kl.fk(robot, found.q)
    if kind == "line":  # straight: the positions have one singular value
        at = tool[:, :3, 3] - tool[:, :3, 3].mean(axis=0)
        sigma = np.linalg.svd(at, compute_uv=False)
        assert sigma[1] < 1e-7 * sigma[0]
    if kind != "sweep" and robot.n >= 6:
        assert np.abs(tool[:, :3, :3] - tool[0, :3, :3]).max() < 1e-7


@pytest.mark.parametrize("name", ["puma560", "planar2r", "spatial3r"])
def test_walk_stays_singular(name):
    robot = kl.load(name)
    found = motions.motion(robot, "locus", np.zeros(robot.n))
    rows, _ = judged_rows(robot)
    sigma = np.linalg.svd(kl.jacobian(robot, found.q)[:, rows], compute_uv=False)
    assert (sigma[:, -1] / sigma[:, 0]).max() < 1e-6
    assert np.abs(found.q[-1] - found.q[0]).max() > 0.1 or np.ptp(found.q, axis=0).max() > 0.5


def test_motions_say_why_not():
    with pytest.raises(NameUnknownError, match="did you mean 'sweep'"):
        motions.motion(kl.load("puma560"), "sweeep", np.zeros(6))
    with pytest.raises(StructureError, match="square"):
        motions.motion(kl.load("panda"), "locus", np.zeros(7))
    with pytest.raises(StructureError, match="plane"):
        motions.motion(kl.Robot.from_urdf(MESHES), "line", np.zeros(1))
    linkage = kl.FiveBar.load("isotropic")
    with pytest.raises(NameUnknownError, match="five-bar"):
        fivebar_motions.motion(linkage, "locus", (-1, 1), 1)


@pytest.mark.parametrize("kind", sorted(fivebar_motions.MOTIONS))
def test_five_bar_motions_stay_closed(kind):
    scene = FiveBarScene(kl.FiveBar.load("isotropic"))
    found = fivebar_motions.motion(scene.linkage, kind, scene.mode, scene.assembly)
    xy = scene.linkage.fk(found.q, scene.assembly)
    assert np.isfinite(xy).all()
    assert np.abs(np.diff(found.q, axis=0)).max() < 0.3
    assert np.all(scene.linkage.condition_number(xy, scene.mode) < 50)


@pytest.mark.parametrize("name", ["puma560", "erd:talos_arm"])
def test_bodies_nest_where_pinocchio_places_them(name):
    """The chain of node transforms, walked by hand, against Pinocchio's geometry placements."""
    robot = kl.load(name)
    q = np.random.default_rng(5).uniform(robot.lower, robot.upper)
    moves = {
        c["path"]: np.reshape(c["matrix"], (4, 4)).T
        for c in drawn(Scene(robot, q))
        if c["type"] == "set_transform"
    }
    visuals = pin.buildGeomFromUrdfString(
        robot.model, robot.urdf, pin.GeometryType.VISUAL,
        package_dirs=[str(folder) for folder in (robot.folder.parents if robot.folder else [])],
    )  # fmt: skip
    data, placed = robot.model.createData(), visuals.createData()
    pin.updateGeometryPlacements(robot.model, data, visuals, placed, q)
    found = {path.split("/")[-1]: path for path in moves if "/visuals/" in path}
    assert len(found) == len(visuals.geometryObjects) > robot.n
    for body, at in zip(visuals.geometryObjects, placed.oMg, strict=True):
        parts = found[body.name].split("/")
        pose = np.eye(4)
        for end in range(2, len(parts) + 1):
            pose = pose @ moves.get("/".join(parts[:end]), np.eye(4))
        expected = at.homogeneous @ np.diag([*body.meshScale, 1.0])
        assert np.abs(pose - expected).max() < 1e-12


def test_recorder_keeps_the_newest_of_each():
    vis, recorder = new_scene()
    vis["a"].set_transform(np.eye(4))
    vis["a"].set_transform(2 * np.eye(4))
    vis["a"].set_property("visible", True)
    vis["a"].set_property("color", [1, 0, 0, 1])
    vis["a/b"].set_transform(np.eye(4))
    vis["ab"].set_transform(np.eye(4))
    assert len(recorder.commands()) == 5
    vis["a"].set_transform(np.eye(4))  # goes to the end, behind what it may rest on
    assert umsgpack.unpackb(recorder.commands()[-1])["path"] == "/meshcat/a"
    vis["a"].delete()
    kinds = [umsgpack.unpackb(c) for c in recorder.commands()]
    assert [(c["type"], c["path"]) for c in kinds] == [
        ("set_transform", "/meshcat/ab"),
        ("delete", "/meshcat/a"),
    ]


@pytest.mark.parametrize(("size", "step"), [(1.0, 0.2), (5.0, 1.0), (0.34, 0.05), (24, 2.0)])
def test_grid_steps_are_round(size, step):
    assert round_step(size) == pytest.approx(step)


def test_view_in_a_notebook_serves_nothing(monkeypatch):
    monkeypatch.setattr(show, "in_notebook", lambda: True)
    monkeypatch.setattr(Scene, "serve", lambda *_: pytest.fail("it served"))
    cell = kl.view(kl.load("planar2r"), [0.1, 0.2])._repr_html_()
    assert cell.startswith("<iframe srcdoc=")
    inside = html.unescape(re.search(r'srcdoc="([^"]*)"', cell)[1])
    assert '"q": [0.1, 0.2]' in inside
    assert "five-bar" in kl.view(kl.FiveBar.load("isotropic"))._repr_html_()


def test_view_serves_and_says_where(monkeypatch, capsys):
    opened = []
    monkeypatch.setattr(show, "open_browser", opened.append)
    scene = kl.view(kl.load("planar2r"))
    assert isinstance(scene, kl.viewer.Scene)
    url = capsys.readouterr().out.split()[-1]
    assert opened == [url]
    assert url.startswith("http://127.0.0.1:")


def test_no_browser_is_tried_without_a_display(monkeypatch):
    for key in ("DISPLAY", "WAYLAND_DISPLAY", "BROWSER"):
        monkeypatch.delenv(key, raising=False)
    monkeypatch.setattr(show.webbrowser, "open", lambda _: pytest.fail("it tried"))
    monkeypatch.setattr(show.sys, "platform", "linux")
    assert show.open_browser("http://127.0.0.1:1/") is False


def test_plain_pages_do_without_compiled_code(tmp_path):
    """numba and sympy would double the time of a cold start."""
    code = (
        "import sys; from kinlab.cli import main\n"
        "for name in ('puma560', 'isotropic'):\n"
        "    sys.argv = ['kinlab', 'view', name, '--save', sys.argv[-1]]\n"
        "    try: main()\n"
        "    except SystemExit as done: assert not done.code\n"
        "print(sorted({'numba', 'sympy', 'matplotlib'} & set(sys.modules)))"
    )
    done = subprocess.run([sys.executable, "-c", code, tmp_path / "page.html"], cwd=ROOT,
                          capture_output=True, text=True, check=True)  # fmt: skip
    assert done.stdout.splitlines()[-1] == "[]"


def test_command_saves_one_file(tmp_path):
    out = tmp_path / "puma.html"
    done = run("view", "puma560", "--animate", "pick", "-q", "0, pi/4, -0.5, 0, 1, 0", "--save",
               str(out))  # fmt: skip
    assert done.returncode == 0, done.stderr
    assert f"wrote {out}" in done.stdout
    text = out.read_text()
    spec = json.loads(re.search(r"kinlab\.start\((.*)\);", text)[1])
    assert spec["q"][1] == np.pi / 4
    assert spec["animation"]["name"] == "Pick and place by IK"
    assert len(text) < 2_000_000


@pytest.mark.parametrize(
    ("arguments", "words"),
    [
        (("view", "puma561", "--save", "x.html"), "did you mean 'puma560'"),
        (("view", "fivebar", "--save", "x.html"), "five-bars: "),
        (("view", "puma560", "--save", "/nowhere/x.html"), "cannot be written"),
        (("view", "puma560", "-q", "1,2", "--save", "x.html"), "q has shape (2,)"),
        (("view", "puma560", "-q", "1,two", "--save", "x.html"), "two"),
        (("view", "puma560", "--animate", "dance", "--save", "x.html"), "'dance'"),
        (("view", "puma560", "--port", "99999"), "port 99999"),
        (("view", "isotropic", "--tool", "tool"), "leave --tool 'tool' out"),
        (("view", "puma560", "--host", "192.0.2.1"), "cannot listen on 192.0.2.1"),
    ],
)
def test_command_refuses_in_one_line(arguments, words):
    done = run(*arguments)
    assert done.returncode == 2
    assert len(done.stderr.splitlines()) == 1
    assert words in done.stderr
