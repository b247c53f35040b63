"""The one door to the terminal: what comes from a file is shown, never obeyed.

Names, sources and messages may hold control codes or rich's markup; here the codes become
visible and markup is plain text. Styles are given as styles. A table that is too wide is broken
into more lines, between words and in names after a mark such as ``_``; no name is cut short.
"""

from __future__ import annotations

import re
import sys
import unicodedata
from typing import Any

import typer
from rich.box import SIMPLE_HEAD
from rich.cells import cell_len
from rich.console import Console
from rich.measure import Measurement
from rich.table import Column, Table
from rich.text import Text

from kinlab.host.language import _

LONGEST = 900
"""Characters of an error message that are shown."""


def visible(text: str) -> str:
    """The text with every code that a terminal would obey written out, such as ``\\x1b``.

    Line ends and tabs stay; codes that turn the direction of writing and halves of surrogate
    pairs go too.
    """
    lines = text.split("\n")
    return "\n".join(line if line.isprintable() else "".join(map(_shown, line)) for line in lines)


def _shown(letter: str) -> str:
    if letter.isprintable() or letter in "\n\t":
        return letter
    if unicodedata.category(letter) == "Zs":  # other blanks, such as the no-break space
        return letter
    return letter.encode("unicode_escape").decode("ascii")


class Screen(Console):
    """A rich console that shows text as it is, and all of it."""

    def print(self, *objects: Any, **options: Any) -> None:
        """As rich prints, but a table that does not fit is broken into more lines first."""
        for one in objects:
            if isinstance(one, Table):
                _fit(one, self)
        super().print(*objects, **options)

    def dim(self, text: object) -> None:
        """What an answer rests on, dim below it."""
        self.print(str(text), style="dim", highlight=False)

    def render_str(self, text: str, **options: Any) -> Text:
        """Every piece of text that is printed, and every cell of a table, passes here."""
        return super().render_str(visible(text), **{**options, "markup": False, "emoji": False})


_PIECE = re.compile(r"[^\s_/,:]*[_/,:]+|[^\s_/,:]+|\s+")
"""What is not broken where that can be helped: letters and the marks behind them, or blanks."""


def _fit(table: Table, console: Console) -> None:
    """Gives each column a width at which the table fits, and breaks the cells at it.

    Lines are broken between words; where that does not do, in the names with the most marks; and
    where nothing else is left, between letters. What room is left goes to the longest lines.
    """
    natural = [max(map(_width, _texts(column))) for column in table.columns]
    whole = Measurement.get(console, console.options.update(width=10_000), table).maximum
    room = console.width - (whole - sum(natural))
    if whole <= console.width or room < len(natural):
        return
    widths = [_longest(column, re.compile(r"\S+")) for column in table.columns]
    for least in ([_longest(column, _PIECE) for column in table.columns], [1] * len(natural)):
        while sum(widths) > room and widths != least:
            spare = _over(widths, least)
            widths[spare.index(max(spare))] -= 1
    while sum(widths) < room:
        missing = _over(natural, widths)
        widths[missing.index(max(missing))] += 1
    for column, width in zip(table.columns, widths, strict=True):
        column.width, column.no_wrap, column.overflow = width, False, "fold"
        column.header = _broken(column.header, width)
        column._cells = [_broken(cell, width) for cell in column._cells]


def _over(these: list[int], those: list[int]) -> list[int]:
    return [one - other for one, other in zip(these, those, strict=True)]


def _longest(column: Column, piece: re.Pattern[str]) -> int:
    """Width of a column's longest piece."""
    pieces = (found for text in _texts(column) for found in piece.findall(text))
    return max(map(_width, pieces), default=1)


def _texts(column: Column) -> list[str]:
    cells = (column.header, *column.cells)
    return [visible(c.plain if isinstance(c, Text) else str(c)) for c in cells]


def _width(text: str) -> int:
    return max((cell_len(line) for line in text.splitlines()), default=0)


def _broken(cell: Any, width: int) -> Any:
    """A cell's text with its lines broken between pieces; styled text breaks between words."""
    if not isinstance(cell, str) or _width(cell) <= width:
        return cell
    lines = []
    for line in visible(cell).splitlines():
        here = ""
        for piece in _PIECE.findall(line):
            if here and cell_len((here + piece).rstrip()) > width:
                lines.append(here.rstrip())
                here = ""
            here += piece if here else piece.lstrip()
        lines.append(here.rstrip())
    return "\n".join(lines)


def screen(**options: Any) -> Screen:
    """A console for the commands; options are rich's."""
    return Screen(markup=False, emoji=False, **options)


def styled(*parts: str | tuple[str, str]) -> Text:
    """Text in pieces, each plain or (text, style)."""
    pieces = [part if isinstance(part, tuple) else (part, "") for part in parts]
    return Text.assemble(*((visible(text), style) for text, style in pieces))


def echo(text: str, *, err: bool = False, nl: bool = True) -> None:
    """Prints a line without styles."""
    typer.echo(visible(text), err=err, nl=nl)


def complain(problem: BaseException | str) -> None:
    """An error or a warning as one line on stderr."""
    text = visible(" ".join(str(problem).split()))
    if len(text) > LONGEST:
        text = f"{text[:LONGEST]} ..."
    print(f"kinlab: {text}", file=sys.stderr)


def wrote(file: object, *, err: bool = False) -> None:
    """Says that a file was written."""
    echo(_("wrote {file}").format(file=file), err=err)


def fine_table(*columns: str, left: tuple[int, ...], title: str | None = None) -> Table:
    """A table of numbers; the columns of ``left`` are text."""
    table = Table(title=title, title_justify="left", box=SIMPLE_HEAD, pad_edge=False)
    for k, column in enumerate(columns):
        table.add_column(column, justify="left" if k in left else "right", no_wrap=k in left)
    return table


def plain_table(*columns: str, right: tuple[int, ...] = ()) -> Table:
    """A table of words without lines; the columns of ``right`` are numbers."""
    table = Table(box=None, header_style="bold", pad_edge=False)
    for k, column in enumerate(columns):
        table.add_column(column, justify="right" if k in right else "left")
    return table
