r"""Matrices and vectors as people type them: LaTeX, MATLAB, Python; their sums and products.

``M = [a, b; c, d]`` becomes M11, M12, ... as typed; of ``\frac12 [..] [..] + [..]`` the entries are
written out in plain text.
"""

from __future__ import annotations

import re
from collections.abc import Iterator, Mapping
from itertools import product

from kinlab.formulas.signs.brackets import closes, parts_at
from kinlab.formulas.signs.refusals import refused
from kinlab.formulas.typed import (
    LONG,
    TWO,
    Hand,
    bare,
    entry_name,
    hand,
    is_latex,
    of_one_name,
    plain_formula,
    sides,
    turned,
)
from kinlab.host.language import N_

Grid = list[list[str]]

_TURNED = r"(?:\s*(?:\^\s*\{?\s*(?:\\top|T|\\mathrm\s*\{?\s*T\}?|\\intercal)\s*\}?|\.?'|\.T(?!\w)))"
_INSIDE = (
    r"\\begin\{(bmatrix|pmatrix|matrix|smallmatrix|vmatrix|array)\}(?:\{[lcr| ]*\})?"
    r"((?:(?!\\begin|\\end).)*)\\end\{\1\}"
)
_MATRIX = re.compile(rf"{_INSIDE}({_TURNED})?", re.DOTALL)
_WRAPPED = re.compile(
    rf"(?:\\left\s*[(\[.]|[(\[])\s*{_INSIDE}\s*(?:\\right\s*[)\].]|[)\]])({_TURNED})?", re.DOTALL
)
_MADE = r"(?:(?:np|numpy|sp|sympy)\.)?(?:array|Matrix|asarray|Vector)"
_ARRAY = re.compile(rf"{_MADE}\s*\((.*)\)", re.DOTALL)
_MADE_INSIDE = re.compile(rf"(?<![\w.]){_MADE}\s*(?=\(\s*\[)")
_DIAGONAL = re.compile(
    r"(?:\\(?:mathrm|operatorname|text)\s*\{\s*diag\s*\}|(?<![A-Za-z])\\?diag)(?=\s*[(\[{\\])"
)
_SIZES = re.compile(r"\\(?:left|right|bigl|bigr|Bigl|Bigr|big|Big)(?![A-Za-z])\s?")
_BRACKETS = {"[": "]", "(": ")", "{": "}"}
_SYMMETRIC = {"M", "D", "H", "B", "mass_matrix"}
"""Matrices of which a star stands for the entry on the other side of the diagonal."""
_STAR = re.compile(r"\$?\s*(?:\*|\\ast|\\star|\\bullet|\\(?:text|mathrm)\{\s*sym\w*\.?\s*\})\s*\$?")
_MOST = 36
LONGEST = 20_000


def cells(text: str, place: str = "expression", writing: Hand | None = None) -> Grid | None:
    r"""The entries of a matrix, row by row; None of what is no matrix.

    Args:
        text: ``bmatrix``, ``pmatrix``, ``matrix`` or ``array``; ``[a, b; c, d]``;
            ``[[a, b], [c, d]]``, with ``np.array(...)`` around it or not; ``diag([a, b])``; sums
            and products of these, with factors.
        place: what to put in front of a message.
        writing: what the writer's formulas together say.

    Raises:
        ExpressionError: rows of different lengths, too many entries, or a product of matrices
            that do not fit.
    """
    text = bare(text)
    rows = _one(text, place, writing or hand([text]))
    if rows is not None:
        return rows
    return _total(_not_made(text), place, writing or hand([text]))


def _not_made(text: str) -> str:
    """``h*[[a, b], [c, d]]`` of ``h*Matrix([[a, b], [c, d]])``."""
    while found := _MADE_INSIDE.search(text):
        end = closes(text, found.end())
        if end < 0:
            return text
        inside = text[found.end() + 1 : end]
        text = f"{text[: found.start()]}{inside}{text[end + 1 :]}"
    return text


def _one(text: str, place: str, writing: Hand) -> Grid | None:
    """The entries of a matrix that stands alone."""
    found = _MATRIX.fullmatch(text) or _WRAPPED.fullmatch(text)
    if found and found[1] == "vmatrix":
        raise refused(place, N_("vmatrix is a determinant; write bmatrix for a matrix"))
    if found:
        lines = [row for row in re.split(r"\\\\(?:\[[^\]]*\])?|\\cr\b", found[2]) if row.strip()]
        rows = [[f"${cell.strip()}$" for cell in line.split("&")] for line in lines]
        over = bool(found[3])
    else:
        inside = _ARRAY.fullmatch(text)
        dollars = "$" if is_latex(text) else ""
        plain = _SIZES.sub("", inside[1] if inside else text).strip()
        core = re.sub(_TURNED + "$", "", plain)
        over = core != plain
        spaced = "*" in core and not dollars
        listed = _diagonal(core, spaced, writing) or _listed(core.strip(), over, spaced, writing)
        rows = [[f"{dollars}{cell}{dollars}" for cell in row] for row in listed]
        over = over and ";" in core
    if not rows:
        return None
    if len({len(row) for row in rows}) > 1 or not all(
        cell.strip("$") for row in rows for cell in row
    ):
        raise refused(place, N_("the rows of the matrix have different lengths, or gaps"))
    if len(rows) * len(rows[0]) > _MOST:
        raise refused(place, N_("a matrix of more than {most} entries"), most=_MOST)
    return [list(column) for column in zip(*rows, strict=True)] if over else rows


def _diagonal(text: str, spaced: bool, writing: Hand) -> Grid:
    found = _DIAGONAL.match(text)
    inside = text[found.end() :].replace("\\{", "{").replace("\\}", "}").strip() if found else ""
    while inside[:1] in _BRACKETS and closes(inside) == len(inside) - 1:
        inside = inside[1:-1].strip()
    members = [m for cell in parts_at(inside, ";") for m in _row(cell, spaced, writing)]
    if not inside or len(members) < 2:
        return []
    return [[m if i == k else "0" for i in range(len(members))] for k, m in enumerate(members)]


def _listed(text: str, over: bool, spaced: bool, writing: Hand) -> Grid:
    """The rows of a list in brackets; a list of one row is a column."""
    if text[:2] == "{{":  # Mathematica's
        text = text.replace("{", "[").replace("}", "]")
    if text[:1] not in ("[", "(") or closes(text) != len(text) - 1:
        return []
    inside = _on_one_line(text[1:-1])
    if text[0] == "(" and not (over or len(parts_at(inside, ",")) > 1):
        return []
    lines = [row for row in parts_at(inside, ";") if row]
    if len(lines) > 1:
        rows = [_row(row, spaced, writing) for row in lines]
        if len({*map(len, rows)}) > 1:  # one row's entries may be sums
            apart = [_row(row, True, writing) for row in lines]
            rows = apart if {*map(len, apart)} == {max(map(len, rows))} else rows
        return rows
    members = [member for member in _row(inside, spaced, writing) if member]
    if members and all(m.startswith("[") and closes(m) == len(m) - 1 for m in members):
        return [parts_at(m[1:-1], ",") for m in members]
    return [[member] for member in members] if len(members) > 1 else []


def _on_one_line(text: str) -> str:
    """The text with a semicolon where a line ends a row, as in MATLAB."""
    goes_on = re.compile(r"(?<=[-+*/^(,;\[])\s*\n\s*|\s*\n\s*(?=[-+*/^),;\]])")
    return re.sub(r"\s*\n\s*", ";", goes_on.sub(" ", text.strip()))


def _row(row: str, spaced: bool, writing: Hand) -> list[str]:
    """The entries of a row, set apart by commas, or by blanks where these are no products."""
    entries = parts_at(row, ",")
    if len(entries) > 1:
        return entries
    apart = _beside(row)
    plain = all(_PLAIN_ENTRY.fullmatch(cell) or cell in writing.known for cell in apart)
    return apart if plain or spaced else entries


# -------- Sums and products


def _total(text: str, place: str, writing: Hand) -> Grid | None:
    """A sum of products of matrices and factors, its entries in plain text."""
    held, grids = _held(text, place, writing)
    if not grids:
        return None
    dollars = "$" if is_latex(text) else ""
    while found := next(filter(_holds_matrices, _INNERMOST.finditer(held)), None):
        grids.append(_in_brackets(found, grids, place, dollars, writing))
        held = _marked(held, found, len(grids) - 1)
    while found := _INVERTED.search(held):
        grids.append(_inverse(grids[int(found[1])], place))
        held = _marked(held, found, len(grids) - 1)
    return _summed(held, grids, place, dollars, writing)


_INNERMOST = re.compile(
    r"(?P<function>(?:(?:(?:np|numpy)\.)?linalg\.|sp\.)?(?:inv|solve)\s*)?(?:\\left\s*)?\("
    r"(?P<inside>[^()]*(?:\([^()\x01]*\)[^()]*)*)\)",
)
_INVERTED = re.compile(
    r"\x01(\d+)\x01\s*(?:(?:\^|\*\*)\s*(?:\{\s*-\s*1\s*\}|\(\s*-\s*1\s*\)|-\s?1)"
    r"|\\(?![A-Za-z,;:! \\])|\.inv\(\)|\\(?=\s*\x01))"
)
_VECTORS = ("tau", "u", "Q")
"""Names of vectors that are put in by their entries."""


def _marked(held: str, found: re.Match[str], k: int) -> str:
    """The text with the mark of a matrix for a piece."""
    return f"{held[: found.start()]}\x01{k}\x01{held[found.end() :]}"


def _holds_matrices(found: re.Match[str]) -> bool:
    """Whether brackets hold one sum of matrices, or two that a system of equations has."""
    function = (found["function"] or "").strip()
    count = len(parts_at(found["inside"], ","))
    return "\x01" in found["inside"] and count == 1 + function.endswith("solve")


def _in_brackets(
    found: re.Match[str], grids: list[Grid], place: str, dollars: str, writing: Hand
) -> Grid:
    """What brackets around matrices hold, its inverse, or what solves a system of equations."""
    function = (found["function"] or "").strip().rpartition(".")[2]
    inside = re.sub(r"\\(?:left|right)\s*$", "", found["inside"])
    first, *others = parts_at(inside, ",")
    made = _summed(first, grids, place, dollars, writing)
    if function:
        made = _inverse(made, place)
    for other in others:
        made = _product(made, _summed(other, grids, place, dollars, writing), place)
    return made


def _inverse(grid: Grid, place: str) -> Grid:
    """The inverse of a number, or of a matrix of two rows, by its cofactors.

    Raises:
        ExpressionError: it is larger.
    """
    if len(grid) == len(grid[0]) == 1:
        return [[f"1/({grid[0][0]})"]]
    if len(grid) != len(grid[0]) or len(grid) > len("ab"):
        raise refused(place, N_("the inverse of a matrix of three rows or more; write it out"))
    (a, b), (c, d) = ([_single(cell) for cell in row] for row in grid)
    whole = f"({a}*{d} - {b}*{c})"
    return [[f"{d}/{whole}", f"-{b}/{whole}"], [f"-{c}/{whole}", f"{a}/{whole}"]]


def _summed(held: str, grids: list[Grid], place: str, dollars: str, writing: Hand) -> Grid:
    """The sum of products in a text with marks for its matrices."""
    total: Grid | None = None
    for sign, term in _terms(held, place):
        made: Grid = [["1"]]
        before, *others = re.split("\x01(\\d+)\x01", term)
        for piece, k in zip([before, *others[1::2]], [*others[::2], ""], strict=True):
            scalar = _factor(piece, place, dollars)
            if scalar:
                made = _product(made, [[plain_formula(scalar, place, writing)]], place)
            made = _product(made, grids[int(k)], place) if k else made
        if sign == "-":
            made = [[cell if cell == "0" else f"-{_single(cell)}" for cell in row] for row in made]
        total = made if total is None else _sum(total, made, place)
    assert total is not None
    return total


def _held(text: str, place: str, writing: Hand) -> tuple[str, list[Grid]]:
    """The text with a mark for each matrix, and the matrices in plain text."""
    grids: list[Grid] = []
    out, at = "", 0
    while at < len(text):
        end = _end_of_matrix(text, at)
        rows = _one(text[at:end], place, writing) if end else None
        if rows is None:
            out, at = out + text[at], at + 1
            continue
        if _is_row(text[at:end]):
            rows = [[row[0] for row in rows]]
        grids.append([[plain_formula(cell, place, writing) for cell in row] for row in rows])
        out, at = f"{out}\x01{len(grids) - 1}\x01", end
    return out, grids


def _is_row(text: str) -> bool:
    """Whether a list is a row beside a matrix: ``[a, b]``, not ``[a; b]`` or ``[[a], [b]]``."""
    over = re.search(_TURNED + "$", text)
    return text[0] == "[" and "[" not in text[1:] and ";" not in text and not over


def _end_of_matrix(text: str, at: int) -> int:
    """Where a matrix that begins at a place ends; 0 where none does."""
    found = _MATRIX.match(text, at) or _WRAPPED.match(text, at)
    if found is not None:
        return found.end()
    diagonal = _DIAGONAL.match(text, at)
    if diagonal is not None:
        return diagonal.end() + closes(text[diagonal.end() :]) + 1
    before = text[:at].rstrip()[-1:]
    if text[at] != "[" or before.isalnum() or before in (")", "]", "_") or is_latex(text):
        return 0
    end = at + closes(text[at:]) + 1
    over = re.compile(_TURNED).match(text, end)
    return over.end() if over else end


def _terms(held: str, place: str) -> Iterator[tuple[str, str]]:
    """The terms of a sum with their signs.

    Raises:
        ExpressionError: a matrix in brackets.
    """
    sign, term, depth = "+", "", 0
    for character in held:
        depth += (character in "([{") - (character in ")]}")
        if character == "\x01" and depth:
            raise refused(place, N_("a sum of matrices in brackets; write it without them"))
        if character in "+-" and depth == 0 and term.rstrip()[-1:] not in ("*", "/", "^", "@"):
            if term.strip():
                yield sign, term
                sign, term = "+", ""
            sign = "-" if (character == "-") != (sign == "-") else "+"
        else:
            term += character
    yield sign, term


_TIMES = r"(?:\s|\*|·|⋅|×|@|\\cdot(?![A-Za-z])|\\[,;:!]|~|&)*"


def _factor(piece: str, place: str, dollars: str) -> str:
    """What stands between two matrices, without the signs of multiplication."""
    if r"\times" in piece or ".*" in piece or piece.lstrip()[:1] == "^":
        raise refused(
            place, N_("{text} beside a matrix; write the entries out"), text=piece.strip()[:20]
        )
    piece = re.sub(f"^{_TIMES}|{_TIMES}$", "", piece)
    piece = f"1{piece}" if piece[:1] == "/" else piece
    return f"{dollars}{piece}{dollars}" if piece else ""


def _product(left: Grid, right: Grid, place: str) -> Grid:
    for one, other in ((left, right), (right, left)):
        if len(one) == len(one[0]) == 1:
            return [[_times(one[0][0], cell, place) for cell in row] for row in other]
    if len(left[0]) != len(right):
        sizes = (f"{len(one)} x {len(one[0])}" for one in (left, right))
        said = N_("a matrix of {size} has no product with one of {other}")
        raise refused(place, said, size=next(sizes), other=next(sizes))
    columns = list(zip(*right, strict=True))
    made: Grid = [[] for _row in left]
    for (i, row), column in product(enumerate(left), columns):
        terms = [_times(a, b, place) for a, b in zip(row, column, strict=True)]
        made[i].append(" + ".join(term for term in terms if term != "0") or "0")
    return made


def _sum(left: Grid, right: Grid, place: str) -> Grid:
    left, right = _by_entries(left, right), _by_entries(right, left)
    if (len(left), len(left[0])) != (len(right), len(right[0])):
        raise refused(place, N_("matrices of different sizes have no sum"))
    return [
        [_added(a, b) for a, b in zip(x, y, strict=True)] for x, y in zip(left, right, strict=True)
    ]


def _by_entries(one: Grid, other: Grid) -> Grid:
    """A vector that stands for itself as the column that is added to it: ``tau - [a; b]``."""
    (first, *_more), *_rows = one
    if len(one) == 1 and first.lstrip("-") in _VECTORS and len(other[0]) == 1 < len(other):
        return [[f"{first}{k + 1}"] for k in range(len(other))]
    return one


def _added(one: str, other: str) -> str:
    if "0" in (one, other):
        return one if other == "0" else other
    taken = other[0] == "-" and (
        _SINGLE.fullmatch(other[1:]) or closes(other[1:]) == len(other) - 2
    )
    return f"{one} - {other[1:]}" if taken else f"{one} + {other}"


_SINGLE = re.compile(r"[\w.]+(?:\*\*\d+)?(?:\([^()]*\))?")


def _times(left: str, right: str, place: str) -> str:
    if "0" in (left, right):
        return "0"
    if "1" in (left, right):
        return right if left == "1" else left
    if len(left) + len(right) > LONGEST:
        raise refused(place, N_("a product of matrices too long to be written out"))
    return f"{_single(left)}*{_single(right)}"


def _single(text: str) -> str:
    """A factor, in parentheses where it is a sum or a product."""
    return text if _SINGLE.fullmatch(text) else f"({text})"


# -------- Rows of MATLAB

_PLAIN_ENTRY = re.compile(r"-?(?:[A-Za-z]+_?\d\d|\d+(?:\.\d+)?)")
"""M11, d12, 0: where all are such they are no factors without a sign."""


def _beside(row: str) -> list[str]:
    """A row of MATLAB's, whose entries are set apart by blanks: ``a + b -c`` are two."""
    entries, depth = [""], 0
    for k, character in enumerate(row):
        depth += (character in "([{") - (character in ")]}")
        before, behind = entries[-1].rstrip()[-1:], row[k:].lstrip()[:2]
        signed = behind[:1] in "+-" and not behind[1:].isspace()
        apart = before not in "+-*/^.(" and (behind[:1] not in "+-*/^.)" or signed)
        if character.isspace() and depth == 0 and before and behind and apart:
            entries.append("")
        else:
            entries[-1] += character
    return [entry.strip() for entry in entries if entry.strip()]


def opened(
    entries: Mapping[str, str],
    place: str,
    writing: Hand | None = None,
    parts: Mapping[str, Grid] | None = None,
) -> dict[str, str]:
    """Each entry by a plain name, a matrix as its entries, without left sides.

    Args:
        entries: name to formula, both as typed.
        place: the file, for messages.
        writing: what all the writer's formulas say; None looks at these.
        parts: the entries of those that are rows, columns or blocks of a quantity.

    Raises:
        ExpressionError: a name or matrix that cannot be read, a left side that is not the
            entry's name, or an entry that is given twice.
    """
    writing = writing or hand(entries.values())
    plain: dict[str, str] = {}
    for key, value in entries.items():
        at = f"{place}: {key}"
        left, right = sides(value, at)
        name = entry_name(key, at, writing)
        if turned(left, right, name):  # ... = tau2
            left, right = "", f"${left}$" if right[:1] == "$" else left
        if left and not of_one_name(entry_name(left, at, writing), name):
            raise refused(
                at, N_("the formula begins with {text} =, which is another"), text=left[:40]
            )
        part = (parts or {}).get(key)
        whole = part is not None or not (name[-1:].isdigit() or name.endswith("]"))
        grid = cells(right, at, writing) or (_in_a_row(right) if whole else None)
        if part is not None:
            for there, cell in _beside_each(part, grid, at):
                _put(plain, there, cell, at)
            continue
        if grid and len(grid) == len(grid[0]) == 1:
            right, grid = grid[0][0], None
        if grid and len(grid) == 1 and name not in TWO:
            grid = [[cell] for cell in grid[0]]
        if grid and name == "planar_pose" and len(grid) == _WITH_ANGLE:
            grid = [*grid[:2], *([_wave(x, grid[2][0])] for x in ("cos", "sin"))]
        in_a_list = right[:1] == "[" and right[:2] != "[[" and ";" not in right
        if grid and name in TWO and len(grid[0]) == 1 and in_a_list:
            raise refused(at, N_("a row or a column? write [a, b; c, d] or [[a, b], [c, d]]"))
        if grid is None:
            _put(plain, name, right, at)
            continue
        if not whole:
            raise refused(at, N_("{name} is one entry, and a matrix is given"), name=name)
        symmetric = name in _SYMMETRIC and len(grid) == len(grid[0])
        for i, row in enumerate(grid, 1):
            for j, cell in enumerate(row, 1):
                if symmetric and i != j and _STAR.fullmatch(cell):
                    cell = grid[j - 1][i - 1]
                long = name in LONG or "_" in name
                below = f"[{i - 1}" if long else f"{i}"
                column = len(row) > 1 or name in TWO
                if long:
                    below += f",{j - 1}]" if column else "]"
                elif column:
                    below += f"{j}"
                _put(plain, name + below, cell, at)
    return plain


_WITH_ANGLE = 3
"""Entries of a planar pose that has the angle itself, of which the engine has cosine and sine."""


def _wave(function: str, cell: str) -> str:
    """The cosine or sine of a cell, as typed."""
    inside = cell.strip("$")
    return f"$\\{function}({inside})$" if is_latex(cell) else f"{function}({inside})"


def _beside_each(part: Grid, grid: Grid | None, place: str) -> Iterator[tuple[str, str]]:
    """The entries of a part of a quantity, each with what is typed for it.

    Raises:
        ExpressionError: no matrix, or one of another size.
    """
    rows, columns = len(part), len(part[0])
    given = grid or [[""]]
    if 1 in (rows, columns) and 1 in (len(given), len(given[0])):  # a row or a column
        part, given = ([[x for row in one for x in row]] for one in (part, given))
    centre = len(part) == 1 and part[0][0].startswith("com_positions")
    if centre and len(given[0]) == 2:
        part = [part[0][:2]]  # of a point in the plane z goes without saying
    if grid is None or (len(given), len(given[0])) != (len(part), len(part[0])):
        size = f"{rows} x {columns}" if columns > 1 else str(rows)
        raise refused(place, N_("write it as a matrix of {size} entries"), size=size)
    for names, cells_ in zip(part, given, strict=True):
        yield from zip(names, cells_, strict=True)


def _in_a_row(text: str) -> Grid | None:
    """The entries of ``a, b`` without brackets."""
    dollars = "$" if is_latex(text) else ""
    entries = parts_at(bare(text), ",")
    return [[f"{dollars}{one}{dollars}"] for one in entries] if len(entries) > 1 else None


def _put(entries: dict[str, str], name: str, formula: str, place: str) -> None:
    if name in entries:
        raise refused(place, N_("{name} is given twice; keep one"), name=name)
    entries[name] = formula
