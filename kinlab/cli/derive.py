"""The command derive: an arm's formulas, derived from its DH table."""

from __future__ import annotations

from pathlib import Path
from typing import Annotated

import typer

from kinlab.cli.robots import TOOL
from kinlab.cli.screen import echo, wrote

ROBOT = Annotated[str, typer.Argument(help="A name from `kinlab list`, or a .toml/.csv file.")]
WHAT = Annotated[str, typer.Option("--what", help="fk, J, det, M, C, g, tau, D, T or V.")]
FORMAT = Annotated[str, typer.Option("--format", help="text, latex or python.")]
NUMBERS = Annotated[bool, typer.Option("--numbers", help="Keep the table's numbers.")]
OUTPUT = Annotated[Path | None, typer.Option("--output", "-o", help="Write to this file.")]


def derive(
    robot: ROBOT,
    what: WHAT = "tau",
    format: FORMAT = "text",
    numbers: NUMBERS = False,
    output: OUTPUT = None,
    tool: TOOL = None,
) -> None:
    """Derive FK, J, det J, M, C, g or tau of an arm from its DH table."""
    from kinlab.host.files import write_text
    from kinlab.symbolic.derive import derived_text

    text = derived_text(robot, what, format, numbers, tool)
    if output is None:
        echo(text)
    else:
        write_text(output, text + "\n")
        wrote(output)


COMMANDS = {"derive": derive}
