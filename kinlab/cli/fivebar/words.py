"""What the commands about five-bars share: their options, and numbers as text."""

from __future__ import annotations

from pathlib import Path
from typing import Annotated

import typer

NAME = Annotated[str, typer.Argument(help="A name from `kinlab fivebar list`, or a .toml file.")]
MODE = Annotated[str, typer.Option(help="Working mode: signs of u1 x w1 and u2 x w2, as in -+.")]
ASSEMBLY = Annotated[int, typer.Option(help="Assembly mode: sign of w1 x w2, 1 or -1.")]
PICTURE = Annotated[Path | None, typer.Option(help="Write pictures: a .png, .svg or .pdf file.")]
AT = Annotated[
    tuple[float, float] | None, typer.Option(help="A place of the tool, m.", metavar="X Y")
]
BOX = Annotated[
    tuple[float, float, float, float] | None,
    typer.Option(help="Workspace, m.", metavar="X0 X1 Y0 Y1"),
]


def signs_of(mode: tuple[int, int]) -> str:
    return "".join("+" if s > 0 else "-" for s in mode)


def pair(values: object) -> str:
    import numpy as np

    first, second = np.asarray(values, dtype=float)
    texts = dict.fromkeys((f"{first:.4g}", f"{second:.4g}"))
    return "/".join(texts)


def fixed(metres: float) -> str:
    """To a micrometre, without a minus before zero."""
    return f"{round(metres, 6) + 0.0:.6f}"
