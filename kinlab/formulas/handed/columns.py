r"""Columns of names, and names of matrices: ``[x; y] = [...]``, ``J = [Jv; Jw]``."""

from __future__ import annotations

import re
from collections.abc import Mapping

from kinlab.errors import ExpressionError
from kinlab.formulas.grids import Grid, cells
from kinlab.formulas.signs.refusals import refused
from kinlab.formulas.typed import bare, entry_name, is_latex, is_name, of_one_name, own_name
from kinlab.host.language import N_

_COLUMN = (
    r"((?:\\left\s*[(\[]\s*)?\\begin\{(?P<kind>[bp]?matrix|array)\}(?:\{[lcr| ]*\})?"
    r"(?P<names>(?:(?!\\begin|\\end).){1,200})\\end\{(?P=kind)\}(?:\s*\\right\s*[)\]])?"
    r"|\[(?P<list>[\w\s;,]{3,60})\]\s*'?)"
)
_LEFT = re.compile(rf"^\s*{_COLUMN}\s*&?=\s*&?(?P<right>.*)$", re.DOTALL)
_RIGHT = re.compile(rf"^(?P<right>[^=]*[^=\s&])\s*&?=\s*&?\s*{_COLUMN}\s*\.?$", re.DOTALL)


def of_column(text: str, entry: str, place: str) -> str:
    """The formula of one of the names, or the whole where the names are its entries.

    Args:
        text: as typed.
        entry: what the formula is asked for.
        place: what to put in front of a message.

    Raises:
        ExpressionError: the right side is no matrix that can be read.
    """
    found = (_LEFT.match(bare(text)) or _RIGHT.match(bare(text))) if "=" in text else None
    if found is None or is_name(found["right"]):
        return text
    inside = found["names"] or found["list"]
    parts = re.split(r"\\\\(?:\[[^\]]*\])?" if found["names"] else r"[;,]", inside)
    try:
        names = [entry_name(part.strip("& ")) for part in parts if part.strip()]
        wanted = entry_name(entry)
    except ExpressionError:
        return text
    right = found["right"].strip()
    order = [_OF_TOOL.get(name, -1) for name in names]
    of_rates = "jacobian" in entry and -1 not in order and order == sorted({*order})
    right = _without_rates(right) if of_rates else right
    typeset = f"${right}$" if "\\" in text else right
    if of_rates and right != found["right"].strip():
        return typeset
    heads = {name.rstrip("0123456789") for name in names}
    in_order = [f"{head}{k}" for head in heads for k in range(1, len(names) + 1)] == names
    if in_order and of_one_name(heads.pop(), wanted):
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


_OF_TOOL = {f"{x}d": k for k, x in enumerate("xyz")} | {f"v_{x}": k for k, x in enumerate("xyz")}
_OF_TOOL |= {f"v{x}": k for k, x in enumerate("xyz")}
_OF_TOOL |= {f"omega{x}": 3 + k for k, x in enumerate("xyz")} | {"phid": 5, "thetad": 5}
"""Rates of the tool, of which J makes those of the joints, and in which order they stand."""
_RATE = re.compile(r"(?:q|theta|th)d\d|d(?:q|th|theta)\d")


def _without_rates(text: str) -> str:
    """The matrix before a column of the joints' rates."""
    at = max(text.rfind("\\begin"), text.rfind("["))
    found = _LEFT.match(f"{text[at:]} = 1") if at > 0 else None
    parts = re.split(r"\\\\|[;,]", found["names"] or found["list"]) if found else []
    try:
        rates = [entry_name(part.strip("& ")) for part in parts if part.strip()]
    except ExpressionError:
        return text
    before = re.sub(r"(?:\\left\s*[(\[]|\*|@|\\cdot)?\s*$", "", text[:at])
    in_order = [one[-1] for one in rates] == [str(k) for k in range(1, len(rates) + 1)]
    named = rates and in_order and all(map(_RATE.fullmatch, rates))
    return before.strip() if named else text


def _same(name: str, wanted: str) -> bool:
    return name == wanted or name.strip("pP_e") == wanted.strip("pP_e") or name[-1:] == wanted[-1:]


# -------- Names of matrices

_STACKED = re.compile(
    r"(?:(?:np|numpy)\.)?(?:vstack|concatenate|row_stack)\(\s*[(\[](?P<rows>[^()\[\]]*)[)\]]"
    r"\s*(?:,\s*axis\s*=\s*0\s*)?\)|\[(?P<lines>[^()\[\]]*)\]"
    r"|(?:\\left\s*[(\[]\s*)?\\begin\{(?P<kind>[bp]?matrix)\}(?P<below>(?:(?!\\begin|\\end).)*)"
    r"\\end\{(?P=kind)\}(?:\s*\\right\s*[)\]])?",
    re.DOTALL,
)
_NAMED = re.compile(
    r"(?<![\w\\])(?P<name>(?:\\(?:mathbf|boldsymbol|bm|mathrm)\s*\{\s*[A-Za-z]+\s*\}|[A-Za-z]+)"
    r"(?:_(?:\{[^{}]{1,20}\}|\\[A-Za-z]+|\w+))?)(?:\((?:[q,\s{}]|\\d?dot|\\?theta)*\))?(?![\w(])"
)
_RATES = re.compile(
    r"\\(d{1,2})ot\s*(?:\{\s*)?(?:\\(?:mathbf|boldsymbol|bm)\s*\{?\s*)?(?:q|\\theta)(?![\w_])[\s}]*"
    r"(?!\s*[_\d])|(?<![\w.\\])(?:(?P<before>d{1,2})(?:q|th|theta)|(?:q|th|theta)(?P<behind>d{1,2}))(?!\w)"
)


_ENTRY_BY_ENTRY = re.compile(r"\]\s*\*\s*\[")
_OF_NUMPY = re.compile(r"(?:np|numpy)\.|(?<!\w)array\s*\(")


def with_matrices(own: Mapping[str, str], text: str, place: str) -> tuple[dict[str, str], str]:
    """What a writer explains without the matrices among it, which stand where they are named.

    Args:
        own: the names with their formulas, as typed.
        text: the formula in which they are used.
        place: what to put in front of a message.

    Returns:
        The other names, and the formula: ``J = [Jv; Jw]`` with all its rows, ``M*qdd + g`` with the
        entries of M.

    Raises:
        ExpressionError: a matrix that cannot be read, or a product of arrays entry by entry.
    """
    given = {name: rows for name, formula in own.items() if (rows := cells(formula, place))}
    given = {name: rows for name, rows in given.items() if len(rows) * len(rows[0]) > 1}
    if not given:
        return dict(own), text
    typeset = is_latex(text)
    rest = {name: formula for name, formula in own.items() if name not in given}
    left, sign, right = bare(text).partition("=")
    if not sign:
        left, right = "", bare(text)
    rows = _stacked(right.strip(), given)
    if rows is not None:
        right = _as_typed(rows, typeset)
    else:
        right = _NAMED.sub(lambda found: _instead(found, given, typeset), right)
        joints = max(len(row) for matrix in given.values() for row in matrix)
        right = _RATES.sub(lambda found: _as_typed(_rates(found, joints, typeset), typeset), right)
        if _ENTRY_BY_ENTRY.search(right) and any(map(_OF_NUMPY.search, own.values())):
            said = N_("* multiplies arrays entry by entry; write @ for a product of matrices")
            raise refused(place, said)
    whole = f"{left}{sign}{right}"
    return rest, f"${whole}$" if typeset else whole


def _stacked(text: str, given: Mapping[str, Grid]) -> Grid | None:
    """The rows of matrices one below the other; None of anything else."""
    found = _STACKED.fullmatch(text)
    if found is None:
        return None
    if found["below"] is not None:
        parts = re.split(r"\\\\(?:\[[^\]]*\])?", found["below"])
    else:
        parts = (found["rows"] or found["lines"] or "").split(";" if found["rows"] is None else ",")
    try:
        names = [own_name(part.strip("& ")) for part in parts if part.strip()]
    except ExpressionError:
        return None
    if len(names) < 2 or not {*names} <= given.keys():
        return None
    rows = [row for name in names for row in given[name]]
    return rows if len({len(row) for row in rows}) == 1 else None


def _instead(found: re.Match[str], given: Mapping[str, Grid], typeset: bool) -> str:
    """The matrix of a name; what is no such name as it is."""
    try:
        rows = given.get(own_name(found["name"]))
    except ExpressionError:
        return found[0]
    return found[0] if rows is None else f" {_as_typed(rows, typeset)} "


def _as_typed(rows: Grid, typeset: bool) -> str:
    """A matrix as one types it."""
    if typeset:
        lines = r"\\".join("&".join(cell.strip("$") for cell in row) for row in rows)
        return rf"\begin{{bmatrix}}{lines}\end{{bmatrix}}"
    return f"[{'; '.join(', '.join(row) for row in rows)}]"


def _rates(found: re.Match[str], joints: int, typeset: bool) -> Grid:
    """The column of all joints' rates, or accelerations, of one name for all."""
    dots = found[1] or found["before"] or found["behind"]
    head = rf"\{dots}ot{{q}}_" if typeset else f"q{dots}"
    return [[f"{head}{k}"] for k in range(1, joints + 1)]
