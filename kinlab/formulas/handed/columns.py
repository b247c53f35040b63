r"""A column of names before a column of formulas: ``\begin{bmatrix}x\\y\end{bmatrix} = ...``."""

from __future__ import annotations

import re

from kinlab.errors import ExpressionError
from kinlab.formulas.grids import cells
from kinlab.formulas.typed import bare, entry_name, of_one_name

_LEFT = re.compile(
    r"^\s*((?:\\left\s*[(\[]\s*)?\\begin\{(?P<kind>[bp]?matrix|array)\}(?:\{[lcr| ]*\})?"
    r"(?P<names>(?:(?!\\begin|\\end).){1,200})\\end\{(?P=kind)\}(?:\s*\\right\s*[)\]])?"
    r"|\[(?P<list>[\w\s;,]{3,60})\]\s*'?)\s*&?=\s*&?(?P<right>.*)$",
    re.DOTALL,
)


def of_column(text: str, entry: str, place: str) -> str:
    """The formula of one of the names, or the whole where the names are its entries.

    Args:
        text: as typed.
        entry: what the formula is asked for.
        place: what to put in front of a message.

    Raises:
        ExpressionError: the right side is no matrix that can be read.
    """
    found = _LEFT.match(bare(text)) if "=" in text else None
    if found is None:
        return text
    inside = found["names"] or found["list"]
    parts = re.split(r"\\\\(?:\[[^\]]*\])?" if found["names"] else r"[;,]", inside)
    try:
        names = [entry_name(part.strip("& ")) for part in parts if part.strip()]
        wanted = entry_name(entry)
    except ExpressionError:
        return text
    right = found["right"].strip()
    typeset = f"${right}$" if "\\" in text else right
    if [f"{wanted}{k}" for k in range(1, len(names) + 1)] == names:
        return typeset
    places = [
        k for k, name in enumerate(names) if of_one_name(name, wanted) and _same(name, wanted)
    ]
    if len(places) != 1:
        return text
    rows = cells(typeset, place)
    if rows is None or len(rows) != len(names) or any(len(row) != 1 for row in rows):
        return text
    return rows[places[0]][0]


def _same(name: str, wanted: str) -> bool:
    return name == wanted or name.strip("pP_e") == wanted.strip("pP_e") or name[-1:] == wanted[-1:]
