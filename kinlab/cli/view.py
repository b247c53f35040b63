"""Command view: a robot in the browser, or as one HTML file."""

from __future__ import annotations

import os
from pathlib import Path
from typing import Annotated

import typer

from kinlab.cli.robots import NAME, TOOL


def register(app: typer.Typer) -> None:
    """Adds the command of this file."""
    app.command("view")(view)


def view(
    name: NAME,
    tool: TOOL = None,
    q: Annotated[
        str | None, typer.Option("-q", help='Joint positions, rad or m: "0,0.5,-1".')
    ] = None,
    save: Annotated[
        Path | None, typer.Option("--save", help="Write one HTML file instead of serving.")
    ] = None,
    animate: Annotated[
        str | None, typer.Option("--animate", help="A motion: sweep, line, pick or locus.")
    ] = None,
    meshes: Annotated[bool, typer.Option(help="Draw meshes, or rods from joint to joint.")] = True,
    host: Annotated[str, typer.Option(help="Address to listen on.")] = "127.0.0.1",
    port: Annotated[int, typer.Option(help="Port; the next free one if it is taken.")] = 7000,
    browser: Annotated[bool, typer.Option(help="Open the browser.")] = True,
) -> None:
    """Show a robot in the browser, with sliders, DH frames and ellipsoids."""
    from kinlab.library import load
    from kinlab.viewer.scene import Scene

    robot = load(name, tool)
    page = Scene(robot, q, meshes=meshes)
