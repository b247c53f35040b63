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

    class Shown(Figure):
        """A figure that a notebook shows, whether or not pyplot is there to teach it."""

        def _repr_png_(self) -> bytes:
            return picture(self, "png", dpi=100)

    figure = Shown(figsize=size, layout="constrained")
    FigureCanvasAgg(figure)
    return figure


def picture(figure: Any, kind: str, dpi: float) -> bytes:
    """The bytes of a figure as ``png``, ``svg`` or ``pdf``."""
    buffer = io.BytesIO()
    figure.savefig(buffer, format=kind, dpi=dpi)
    return buffer.getvalue()


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


def degree_ticks(axis: Any, reach: tuple[float, float], *, few: bool = False) -> None:
    """Ticks at whole parts of a turn.

    Args:
        axis: ``axes.xaxis``, ...
        reach: least and largest angle, degrees.
        few: at most five and none in the corners, as the slanted axes of space have room for.
    """
    from matplotlib.ticker import FixedLocator, MultipleLocator

    span, most = reach[1] - reach[0], 4 if few else 8
    step = next((s for s in (5, 10, 15, 30, 45, 60, 90) if span / s <= most + 1e-6), 180)
    if not few:
        axis.set_major_locator(MultipleLocator(step))
        return
    first, last = (round(end / step) for end in reach)
    ticks = [step * k for k in range(first, last + 1)]
    clear = [x for x in ticks if reach[0] + 0.08 * span < x < reach[1] - 0.08 * span]
    axis.set_major_locator(FixedLocator(clear or ticks))


def whole_ticks(axis: Any) -> None:
    """Ticks at whole numbers only, for what is counted."""
    from matplotlib.ticker import MaxNLocator

    axis.set_major_locator(MaxNLocator(integer=True))


def spread_labels(axes: Any) -> None:
    """Gives the ticks of axes in space room: few, small, and clear of the axes' names."""
    from matplotlib.ticker import FixedLocator, MaxNLocator

    for axis in (axes.xaxis, axes.yaxis, axes.zaxis):
        if not isinstance(axis.get_major_locator(), FixedLocator):
            axis.set_major_locator(MaxNLocator(4, prune="both"))
        axis.set_tick_params(labelsize=8, pad=1)
        axis.labelpad = 6


def save(axes: Any, path: str | Path) -> Path:
    """Writes the figure of these axes as .png, .svg or .pdf.

    Raises:
        FileError: another ending, or the file cannot be written.
    """
    file = Path(path)
    kind = file.suffix.lower().lstrip(".")
    if kind not in _FORMATS:
        raise FileError(f"{file}: a figure is a .png, .svg or .pdf file")
    write_bytes(file, picture(axes.figure, kind, dpi=150))
    return file
