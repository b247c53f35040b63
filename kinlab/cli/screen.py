"""The one door to the terminal: what comes from a file is shown, never obeyed.

Names, sources and messages may hold control codes or rich's markup; here the codes become
visible and markup is plain text. Styles are given as styles.
"""

from __future__ import annotations

import sys
import unicodedata
from typing import TYPE_CHECKING, Any

import typer
from rich.console import Console
from rich.text import Text

if TYPE_CHECKING:
    from rich.table import Table

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
    """A rich console that shows text as it is."""

    def render_str(self, text: str, **options: Any) -> Text:
        """Every piece of text that is printed, and every cell of a table, passes here."""
        return super().render_str(visible(text), **{**options, "markup": False, "emoji": False})


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


def fine_table(*columns: str, left: tuple[int, ...]) -> Table:
    """A table of numbers; the columns of ``left`` are text."""
    from rich.box import SIMPLE_HEAD
    from rich.table import Table

    table = Table(box=SIMPLE_HEAD, pad_edge=False)
    for k, column in enumerate(columns):
        table.add_column(column, justify="left" if k in left else "right", no_wrap=k in left)
    return table
