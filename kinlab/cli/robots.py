"""Commands about robots: list, info, urdf, dh."""

from __future__ import annotations

from pathlib import Path
from typing import Annotated

import typer

NAME = Annotated[str, typer.Argument(help="A name from `kinlab list`, or a .toml/.csv/.urdf file.")]
TOOL = Annotated[str | None, typer.Option("--tip", "--tool", help="Link that is the tool (URDF).")]
OUTPUT = Annotated[Path | None, typer.Option("--output", "-o", help="Write to this file.")]


def register(app: typer.Typer) -> None:
    """Adds the commands of this file."""
    app.command("urdf")(urdf)


def urdf(name: NAME, output: OUTPUT = None) -> None:
    """Print the URDF of a robot, or write it to a file."""
    from kinlab.files import write_text
    from kinlab.library import load

    text = load(name).urdf
    if output is None:
        typer.echo(text, nl=False)
    else:
        write_text(output, text)
        typer.echo(f"wrote {output}")
