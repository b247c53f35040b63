"""Command view: a robot or five-bar in the browser, or as one HTML file."""

from __future__ import annotations

import os
from pathlib import Path
from typing import TYPE_CHECKING, Annotated

import typer

from kinlab.cli.robots import TOOL
from kinlab.cli.screen import echo
from kinlab.host.language import _

if TYPE_CHECKING:
    from kinlab.arrays import Array
    from kinlab.viewer.page.page import Page

NAME = Annotated[
    str,
    typer.Argument(
        help="A name from `kinlab list`, a five-bar preset, or a .toml/.csv/.urdf file."
    ),
]


def view(
    name: NAME,
    tool: TOOL = None,
    q: Annotated[
        str | None,
        typer.Option("-q", help='Joint positions, rad and m: "0, pi/4, 30 deg". Five-bar: cranks.'),
    ] = None,
    save: Annotated[
        Path | None, typer.Option("--save", help="Write one HTML file instead of serving.")
    ] = None,
    animate: Annotated[
        str | None,
        typer.Option(
            "--animate",
            help="Give it a motion: sweep, line, pick, locus, posture, or a .csv (t, q1, ...).",
        ),
    ] = None,
    branches: Annotated[
        bool, typer.Option("--branches", help="Draw all solutions of the pose at q as ghosts.")
    ] = False,
    meshes: Annotated[
        bool, typer.Option(help="Draw the URDF's meshes, or rods from joint to joint.")
    ] = True,
    against: Annotated[
        str | None,
        typer.Option(
            "--against",
            help="Another description of the arm (as for check --against), drawn over the table.",
        ),
    ] = None,
    host: Annotated[
        str, typer.Option(help="Address to listen on; anything but loopback opens it to others.")
    ] = "127.0.0.1",
    port: Annotated[int, typer.Option(help="Port; where it is taken, the next free one.")] = 7000,
    browser: Annotated[bool, typer.Option(help="Open the browser.")] = True,
) -> None:
    """Show a robot with sliders, frames, DH rows and ellipsoids, in the browser or as a file."""
    page = _open(name, tool, q, animate, meshes, against, branches)
    for note in page.notes:
        echo(_("note: {note}").format(note=note), err=True)
    if save is not None:
        page.save(save)
        told = _("wrote {file}: open it in a browser; it needs no server and no network")
        echo(told.format(file=save))
        return
    _serve(page, name, host, port, browser)


def _open(
    name: str,
    tool: str | None,
    q: str | None,
    animate: str | None,
    meshes: bool,
    against: str | None = None,
    branches: bool = False,
) -> Page:
    from kinlab.errors import NameUnknownError, OptionError
    from kinlab.fivebar.files import holds_five_bar, presets
    from kinlab.model.library import load
    from kinlab.viewer.scene import Scene

    start = None if q is None else _numbers(q)
    if branches and (against is not None or holds_five_bar(name)):
        raise OptionError("view --branches is for one arm; leave --against out")
    if against is not None:
        from kinlab.viewer.against import against_scene

        if animate is not None:
            raise OptionError("view --against: leave --animate out; the sliders move both arms")
        return against_scene(name, against, start, tool=tool)
    if holds_five_bar(name):
        if tool is not None:
            raise OptionError(f"{name}: a five-bar has one tool; leave --tool {tool!r} out")
        return _open_five_bar(name, start, animate)
    try:
        robot = load(name, tool)
    except NameUnknownError as problem:
        if tool is not None or "/" in name:
            raise
        raise NameUnknownError(f"{problem}; five-bars: {', '.join(presets())}") from None
    scene = Scene(robot, start, meshes=meshes)
    if branches:
        from kinlab.engine.fast.stacks import fk
        from kinlab.inverse.branches.solutions import ik_branches

        found = ik_branches(robot, fk(robot, scene.q))
        if len(found):
            scene.ghosts("branches", found.q)
    if animate is not None and animate.lower().endswith(".csv"):
        from kinlab.motion.record import read_motion

        scene.play(read_motion(robot, animate))
    elif animate is not None:
        from kinlab.viewer import motions

        shown = motions.motion(robot, animate, scene.q)
        scene.animate(shown.q, shown.duration, shown.name)
    return scene


def _open_five_bar(name: str, theta: Array | None, animate: str | None) -> Page:
    from kinlab.fivebar import FiveBar
    from kinlab.viewer.scene import FiveBarScene

    page = FiveBarScene(FiveBar.load(name), theta)
    if animate is not None:
        from kinlab.viewer import fivebar_motions

        shown = fivebar_motions.motion(page.linkage, animate, page.mode, page.assembly)
        page.animate(shown.q, shown.duration, shown.name)
    return page


def _numbers(text: str) -> Array:
    import numpy as np

    from kinlab.formulas.numbers import parse_angle

    return np.array([parse_angle(word.strip()) for word in text.split(",")])


def _serve(page: Page, name: str, host: str, port: int, browser: bool) -> None:
    from kinlab.viewer.page.live import LiveServer
    from kinlab.viewer.show import open_browser

    server = LiveServer(page, host, port)
    if port not in (0, server.port):
        echo(_("port {port} is taken; using {other}").format(port=port, other=server.port))
    echo(_("{name}: {url}   (Ctrl-C ends)").format(name=name, url=server.url))
    if host not in ("127.0.0.1", "::1", "localhost"):
        told = _("note: {host} is not loopback; others on the network can open this page")
        echo(told.format(host=host))
    if os.environ.get("SSH_CONNECTION"):
        told = _("from your machine: ssh -L {port}:127.0.0.1:{port} <this host>")
        echo(told.format(port=server.port))
    if browser and not open_browser(server.url):
        echo(_("no browser found here; open the address in yours"))
    server.run()
    echo(_("viewer closed"))


COMMANDS = {"view": view}
