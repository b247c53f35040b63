"""Answers introduce themselves: the verdict first, then the numbers that matter, short.

A result says what it is once, as an :class:`Introduction`; ``print``, the prompt and a notebook
show it. Results with rows are written as CSV or handed on as a pandas frame.
"""

from __future__ import annotations

import csv
import io
from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from pathlib import Path
from textwrap import shorten
from typing import Any, Literal

import numpy as np
from markupsafe import Markup, escape

from kinlab.errors import MissingExtraError
from kinlab.host.files import write_text
from kinlab.host.language import _

MOST_ROWS = 12
"""Rows of a table that are shown; the rest is counted."""

_COLOURS = {"good": "#2e8b57", "bad": "#c0392b", "unsure": "#c98a00", "": "#8a8f98"}
_BOX = "border-left: 4px solid {}; padding: 0.1em 0 0.1em 0.8em; max-width: 60em; overflow-x: auto"
_CELL = "padding: 0.1em 0.8em 0.1em 0; text-align: {}; white-space: nowrap"


@dataclass(frozen=True)
class Introduction:
    """What a result says of itself.

    Attributes:
        verdict: what was found and how sure it is, in one sentence.
        lines: the numbers that matter and what they rest on, a line each.
        columns: heads of a small table.
        rows: its cells; those of type ``Markup`` are HTML already.
        of: how many rows there are, where not all are given.
        mood: ``"good"``, ``"bad"`` or ``"unsure"`` where the verdict is one; the colour beside it.
    """

    verdict: str
    lines: tuple[str, ...] = ()
    columns: tuple[str, ...] = ()
    rows: tuple[tuple[str, ...], ...] = ()
    of: int = 0
    mood: Literal["good", "bad", "unsure", ""] = ""

    @property
    def more(self) -> str:
        """How many rows are not shown, in words."""
        left = max(self.of, len(self.rows)) - min(len(self.rows), MOST_ROWS)
        return _("... and {count} more").format(count=left) if left else ""

    def text(self) -> str:
        """As text: the verdict, and the rest indented below it."""
        shown = [line.replace("\n", "\n  ") for line in self.lines]
        if self.rows:
            cells = [self.columns, *self.rows[:MOST_ROWS]]
            widths = [max(len(row[k]) for row in cells) for k in range(len(self.columns))]
            for row in cells:
                pairs = zip(row, widths, self._numeric, strict=True)
                padded = (c.rjust(w) if right else c.ljust(w) for c, w, right in pairs)
                shown.append("  ".join(padded).rstrip())
        return "\n".join([self.verdict, *(f"  {line}" for line in [*shown, self.more] if line)])

    def html(self) -> str:
        """As HTML that needs no style sheet and suits light and dark pages; all text escaped."""
        parts = [Markup("<div><b>{}</b></div>").format(self.verdict)]
        parts += [
            Markup('<div style="white-space: pre-wrap">{}</div>').format(line)
            for line in self.lines
        ]
        if self.rows:
            parts.append(self._table())
        if self.more:
            parts.append(Markup("<div>{}</div>").format(self.more))
        box = _BOX.format(_COLOURS[self.mood])
        return f'<div style="{box}">{"".join(parts)}</div>'

    def _table(self) -> Markup:
        def line(tag: str, cells: Sequence[str]) -> str:
            styles = [_CELL.format("right" if right else "left") for right in self._numeric]
            told = zip(cells, styles, strict=True)
            row = "".join(f'<{tag} style="{style}">{escape(cell)}</{tag}>' for cell, style in told)
            return f"<tr>{row}</tr>"

        body = "".join(line("td", row) for row in self.rows[:MOST_ROWS])
        head = line("th", self.columns)
        table = f"<table>{head}{body}</table>"
        return Markup(table)

    @property
    def _numeric(self) -> list[bool]:
        """Whether a column holds numbers, which stand at the right."""
        columns = zip(*self.rows[:MOST_ROWS], strict=True)
        return [all(_is_number(str(cell)) for cell in column) for column in columns]


class Answer:
    """A result that introduces itself in ``print``, at the prompt and in a notebook."""

    def introduction(self) -> Introduction:
        """What the result says of itself."""
        raise NotImplementedError

    def __str__(self) -> str:
        return self.introduction().text()

    def __repr__(self) -> str:
        return str(self)

    def _repr_html_(self) -> str:
        return self.introduction().html()


class Told:
    """A result that says itself in its own ``__str__``, the verdict in the first line."""

    def __repr__(self) -> str:
        return str(self)

    def _repr_html_(self) -> str:
        verdict, *lines = str(self).splitlines()
        return Introduction(verdict, tuple(line.removeprefix("  ") for line in lines)).html()


class Rows(Answer):
    """A result with rows, which other programs can have."""

    def columns(self) -> dict[str, Any]:
        """The rows as columns of one length, by name."""
        raise NotImplementedError

    def to_csv(self, path: str | Path) -> None:
        """Writes the rows as CSV, numbers with every digit.

        Raises:
            FileError: the file cannot be written; an old one stays whole.
        """
        columns = self.columns()
        text = io.StringIO()
        writer = csv.writer(text, lineterminator="\n")
        writer.writerow(columns)
        plain = [np.asarray(column).tolist() for column in columns.values()]
        writer.writerows(zip(*plain, strict=True))
        write_text(path, text.getvalue())

    def to_dataframe(self) -> Any:
        """The rows as a ``pandas.DataFrame``.

        Raises:
            MissingExtraError: pandas is not installed.
        """
        try:
            import pandas as pd
        except ImportError:
            raise MissingExtraError(
                "to_dataframe needs pandas: pip install 'kinlab[dataframes]'"
            ) from None
        return pd.DataFrame(self.columns())


def numbered(name: str, values: Any) -> dict[str, Any]:
    """Columns ``name1``, ``name2``, ... of an array (N, k); ``name`` alone of one (N,).

    Higher shapes are written out entry by entry: ``name11``, ``name12``, ... of (N, k, l).
    """
    array = np.asarray(values)
    if array.ndim < 2:
        return {name: array}
    places = list(np.ndindex(array.shape[1:]))
    dot = "_" if max(array.shape[1:], default=0) > 9 and array.ndim > 2 else ""
    return {
        name + dot.join(str(k + 1) for k in place): array[(slice(None), *place)] for place in places
    }


def vector(values: Any, digits: int = 5) -> str:
    """A few numbers in one line: ``[0.1, -2.5, 0]``."""
    return "[" + ", ".join(f"{float(x) + 0.0:.{digits}g}" for x in np.ravel(values)) + "]"


def brief(text: str, longest: int = 120) -> str:
    """The beginning of a text, whole words."""
    return shorten(text, longest, placeholder=" ...")


def counted(count: int, thing: str) -> str:
    """``1 solution``, ``8 solutions``, ``no solution``."""
    if count == 0:
        return f"no {thing}"
    plural = f"{thing[:-1]}ies" if thing.endswith("y") else f"{thing}s"
    return f"{count:,} {thing if count == 1 else plural}"


def shown_cells(columns: Mapping[str, Any], digits: int = 5) -> tuple[tuple[str, ...], ...]:
    """The first rows of columns as short text."""
    parts = [np.asarray(column)[:MOST_ROWS].tolist() for column in columns.values()]
    return tuple(tuple(_cell(x, digits) for x in row) for row in zip(*parts, strict=True))


def _cell(value: Any, digits: int) -> str:
    if isinstance(value, bool):
        return _("yes") if value else _("no")
    return f"{value + 0.0:.{digits}g}" if isinstance(value, float) else str(value)


def _is_number(text: str) -> bool:
    try:
        float(text.rstrip("°%m "))
    except ValueError:
        return text in ("", "-")
    return True
