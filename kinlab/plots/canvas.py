"""Figures and files, and the one place that imports matplotlib."""

from __future__ import annotations

import io
from pathlib import Path
from typing import Any

from kinlab.errors import FileError, MissingExtraError
from kinlab.host.files import write_bytes

BLUE, RED, GREEN, GREY = "#1f5fa8", "#c2352b", "#2e8540", "#6b7280"
"""The colours that every figure shares: arm, singular, isotropic, background."""

_FORMATS = ("png", "svg", "pdf")


def new_figure(size: tuple[float, float] = (6.4, 5.2)) -> Any:
    """A new figure that belongs to no window system.

    Raises:
        MissingExtraError: matplotlib is not installed.
    """
    try:
        from matplotlib.backends.backend_agg import FigureCanvasAgg
        from matplotlib.figure import Figure
    except ImportError:
        raise MissingExtraError(
            "figures need matplotlib: install it with pip install 'kinlab[plots]'"
        ) from None
    figure = Figure(figsize=size, layout="constrained")
    FigureCanvasAgg(figure)
    return figure


def figure_text(text: str) -> str:
    """A name as a figure shows it: dollars are no formulas, control codes no codes."""
    shown = "".join(
        letter if letter.isprintable() else "\N{REPLACEMENT CHARACTER}" for letter in text
    )
    return shown.replace("$", r"\$")


def new_axes(title: str = "", three_d: bool = False, size: tuple[float, float] = (6.4, 5.2)) -> Any:
    """Axes of a :func:`new_figure`.

    Raises:
        MissingExtraError: matplotlib is not installed.
    """
    figure = new_figure(size)
    axes = figure.add_subplot(projection="3d" if three_d else None)
    if title:
        axes.set_title(figure_text(title), fontsize=11)
    return axes


def save(axes: Any, path: str | Path) -> Path:
    """Writes the figure of these axes as .png, .svg or .pdf.

    Raises:
        FileError: another ending, or the file cannot be written.
    """
    file = Path(path)
    kind = file.suffix.lower().lstrip(".")
    if kind not in _FORMATS:
        raise FileError(f"{file}: a figure is a .png, .svg or .pdf file")
    buffer = io.BytesIO()
    axes.figure.savefig(buffer, format=kind, dpi=150)
    write_bytes(file, buffer.getvalue())
    return file
