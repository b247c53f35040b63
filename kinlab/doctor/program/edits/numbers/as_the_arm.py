"""The numbers of a program as the arm's table has them, where all but a few of a column are so."""

from __future__ import annotations

import ast
from collections.abc import Callable, Container, Iterator, Sequence
from dataclasses import dataclass, replace
from fractions import Fraction
from itertools import combinations, combinations_with_replacement, islice, product
from typing import Any

import numpy as np

from kinlab.arrays import Array
from kinlab.doctor.bytecode.syntax import called, nodes
from kinlab.doctor.changes import table_of
from kinlab.doctor.derivations.words import minus
from kinlab.doctor.program.edits.numbers.data import NumberPlace, leaves, shown, together
from kinlab.doctor.program.observed import Observed, Seen
from kinlab.doctor.program.places import DATA, ProgramEdit, is_nothing, number, places
from kinlab.doctor.program.trial import FieldChange, Trial
from kinlab.fivebar import FiveBar
from kinlab.model.dh import DHTable
from kinlab.model.link import Convention
from kinlab.symbolic.vocabulary import vocabulary
from kinlab.tolerances import TOLERANCES

_COST = 0.96
"""Less than anything else in the numbers of a program: the table says so."""
_ROWS = 4
"""Rows that several columns of the table may make of one."""
_TOLD, _MOVING = 3, 2
"""Numbers of a column that tell which of the table's it is; how many may be no numbers."""
_APART = 2
"""Numbers other than nought of a column that is right but for one."""
_TOGETHER = 0.01
"""What several numbers of a row cost more than one, which may do alone."""
_PI = ast.Attribute(ast.Name("np", ast.Load()), "pi", ast.Load())
_PLAIN = ("a", "alpha", "d", "theta", "mass", "armature")
"""What the arm's table has one number of for each link."""
_END, _ABOUT, _DECIMALS = 1.0, 1.04, 15
"""Cost of the arm's base or tool for the identity, and of the angle by which the base is turned for
nought; decimals that its numbers have."""
_DECIMALS_OF_DEGREES = 9
"""Decimals that angles in degrees are typed with at most."""
_OF_AXES = 9
"""The last columns, of centres and of tensors, whose signs are those of a link's axes."""
_AXES = 3
"""Rows and columns of a tensor of inertia."""
_PARTS = 12
"""Into how many parts of pi a number may fall."""


def of_table(trial: Trial, observed: Observed, robot: Any) -> Iterator[ProgramEdit]:
    """Numbers with the arm's own names, and columns of which the others are the table's.

    A row in which several columns are off is one edit: somebody copied another row.
    """
    table = table_of(robot)
    if isinstance(robot, FiveBar):
        yield from _of_legs(trial, observed, robot)
    if table is None:
        return
    yield from _ends(trial, table)
    yield from _base_set(trial, observed, table)
    for cell, right in _named(trial, observed, table):
        if not _same(cell.value, right):
            yield cell.edit(right)
    yield from _of_tensors(trial, observed, table)
    off: dict[tuple[Any, int], dict[Any, list[tuple[_Cell, float]]]] = {}
    alone: set[tuple[_Cell, float]] = set()
    every = _columns_of(trial, observed)
    columns = {name: _from_zero(found, table.n) for name, found in every.items()}
    for name, found in columns.items():
        rows = sorted(found)  # of a column with None for what turns or slides, those that are told
        if rows and rows[-1] < table.n and len(rows) >= max(_TOLD, table.n - _MOVING):
            values = [found[i].value for i in rows]
            told = [column[rows] for column in _columns(table, values)]
            for k in _exchanged(values, told):
                some = [(found[rows[j]], values[k + k + 1 - j]) for j in (k, k + 1)]
                one, other = (x.holder if x.place is None else x.place.holder for x, _y in some)
                if one is other:  # numbers of two rows are told one by one
                    yield _row(some, [found[j] for j in rows], True)
            for (at, right), count in _wrong(values, told).items():
                k = rows[at]
                off.setdefault((name[0], k), {}).setdefault(name, []).append((found[k], right))
                alone |= {(found[k], right)} if count == 1 else set()
    for (whose, k), cells in off.items():
        whole = [found[k] for key, found in columns.items() if key[0] == whose and k in found]
        some_alone = [one for found in cells.values() for one in found if one in alone]
        pairs = (x for x in combinations(some_alone, 2) if _same(x[0][1], x[1][0].value))
        swapped = [x for x in pairs if _same(x[1][1], x[0][0].value)]
        others = islice(product(*cells.values()), _ROWS) if len(cells) > 1 else ()
        for some in (*swapped, *others):
            row = _row(some, whole, alone.issuperset(some))
            yield replace(row, cost=row.cost + _TOGETHER)
        yield from (cell.edit(right) for found in cells.values() for cell, right in found)


def _of_tensors(trial: Trial, observed: Observed, table: DHTable) -> Iterator[ProgramEdit]:
    """Numbers of a matrix that is a link's tensor but for one number, or for one and its mirror, or
    for the signs of its products of inertia.
    """
    own = [np.asarray(link.inertia, dtype=float) for link in table.links]
    for cells in _matrices(trial, observed):
        values = np.array([[cell.value for cell in row] for row in cells])
        for tensor in own:
            off = np.argwhere(~np.isclose(values, tensor, rtol=TOLERANCES.same_number, atol=0.0))
            mirrored = len(off) == 1 or (len(off) == 2 and tuple(off[0]) == tuple(off[1][::-1]))
            if mirrored and np.count_nonzero(tensor) > np.count_nonzero(tensor[tuple(off.T)]) + 1:
                for i, k in off:
                    yield cells[i][k].edit(float(tensor[i, k]))
            elif len(off) > 1 and all(i != k and values[i, k] == -tensor[i, k] for i, k in off):
                every = [cell for row in cells for cell in row]  # products with the other sign
                some = [(cells[i][k], float(tensor[i, k])) for i, k in off]
                held = every[0].place
                edit = replace(_row(some, every, False), kind="products' signs")
                yield edit if held is None else replace(edit, place=held.place[:-2])


def with_other_signs(
    trial: Trial, observed: Observed, turned: Callable[[float], bool]
) -> Iterator[ProgramEdit]:
    """Several numbers of a row that are the arm's with the other sign.

    Args:
        trial, observed: the program.
        turned: whether a number is not the arm's, and its opposite is.
    """
    held: dict[Any, list[_Cell]] = {}
    for leaf in leaves(trial):
        if leaf.place:
            cell = _Cell(float(leaf.value), leaf)
            held.setdefault((leaf.node, leaf.place[:-1]), []).append(cell)
    rows: list[tuple[Any, list[_Cell]]] = [(None, cells) for cells in held.values()]
    for part, tree in enumerate(trial.trees):
        for row in nodes(tree):
            if isinstance(row, ast.Call | ast.List | ast.Tuple):
                given = (_cell(observed, part, *at) for _key, *at in _cells([row], 0, row))
                rows.append((row, [cell for cell in given if cell is not None]))
    for node, cells in rows:
        some = [(x, -x.value) for x in cells if turned(x.value)]
        if len(some) > 1:
            edit = replace(_row(some, cells, False), kind="sign")
            yield edit if node is None else replace(edit, node=node)


def _matrices(trial: Trial, observed: Observed) -> Iterator[list[list[_Cell]]]:
    """Three rows of three numbers each, in the data or the text of a program."""
    data: dict[Any, dict[tuple[int, int], _Cell]] = {}
    for leaf in leaves(trial):
        i, k = leaf.place[-2:] if len(leaf.place) > 1 else (None, None)
        if isinstance(i, int) and isinstance(k, int):
            whose = (leaf.node, leaf.place[:-2])
            data.setdefault(whose, {})[i, k] = _Cell(float(leaf.value), leaf)
    square = [(i, k) for i in range(_AXES) for k in range(_AXES)]
    for found in data.values():
        if sorted(found) == square:
            yield [[found[i, k] for k in range(_AXES)] for i in range(_AXES)]
    for part, tree in enumerate(trial.trees):
        for node in nodes(tree):
            rows = node.elts if isinstance(node, ast.List) and len(node.elts) == _AXES else []
            lists = [x.elts for x in rows if isinstance(x, ast.List) and len(x.elts) == _AXES]
            cells = [[_cell(observed, part, row, k) for k in range(_AXES)] for row in lists]
            whole = [[one for one in row if one is not None] for row in cells]
            if len(whole) == _AXES and all(len(row) == _AXES for row in whole):
                yield whole


def _of_legs(trial: Trial, observed: Observed, robot: FiveBar) -> Iterator[ProgramEdit]:
    """Numbers of a five-bar's two legs: exchanged, where as many others are in the legs' order;
    of the middles of its links, for any two of its own; of one leg, where the other's is right.
    """
    known = {tuple(x) for x in robot.values().values() if isinstance(x, list) and len({*x}) == 2}
    every = (x if isinstance(x, list) else [x] for x in robot.values().values())
    own = {abs(float(x)) for row in every for x in row if isinstance(x, int | float)}
    straight: list[Any] = []
    turned: list[list[_Cell]] = []
    for found in _columns_of(trial, observed).values():
        if sorted(found) == [0, 1]:
            cells = [found[0], found[1]]
            pair = cells[0].value, cells[1].value
            straight += [pair] if pair in known else []
            turned += [cells] if pair not in known and pair[::-1] in known else []
            middle = (2 * pair[0], 2 * pair[1]) in known
            for meant in known if pair not in known else ():
                off = [k for k in (0, 1) if not _same(pair[k], meant[k])]
                if middle:
                    yield _row([*zip(cells, meant, strict=True)], cells, False)
                if len(off) == 1 and abs(pair[off[0]]) not in own:
                    yield cells[off[0]].edit(meant[off[0]])
    for one, other in turned if len(straight) >= len(turned) else ():
        yield _row([(one, other.value), (other, one.value)], (one, other), True)


def _from_zero(found: dict[int, _Cell], count: int) -> dict[int, _Cell]:
    """A column by its rows, counted from 0, though its array may count from 1."""
    return {k - 1: found[k] for k in found} if sorted(found) == [*range(1, count + 1)] else found


def of_other_rows(trial: Trial, observed: Observed, robot: Any) -> Iterator[ProgramEdit]:
    """Numbers of the row above, or below, in columns that are the table's otherwise."""
    table = table_of(robot)
    for found in _columns_of(trial, observed).values() if table is not None else ():
        if table is None or sorted(found) != [*range(table.n)]:
            continue
        values = [found[k].value for k in range(table.n)]
        for column in _columns(table, values):
            off = [k for k, x in enumerate(values) if not _same(float(column[k]), x)]
            right = {float(x) for k, x in enumerate(column) if x and k not in off}
            if len(off) == 1 and values[off[0]] and len(right) >= _APART:
                (k,) = off
                if any(
                    _same(values[k], float(x)) for x in (*column[k - 1 : k], *column[k + 1 :][:1])
                ):
                    yield found[k].edit(float(column[k]))


def _ends(trial: Trial, table: DHTable) -> Iterator[ProgramEdit]:
    """The arm's base, and its tool, for a transform that does nothing."""
    one = np.eye(4)
    for name in trial.program.data:
        if np.array_equal(trial.space[name], one):
            for end in (table.base, table.tool):
                end = np.round(np.asarray(end, dtype=float), _DECIMALS) + 0.0
                if not np.array_equal(end, one):
                    told = (_matrix(one), _matrix(end))
                    change = FieldChange(trial.space, name, end)
                    yield ProgramEdit(DATA, (change,), "number", _END, name, exchanged=told)


def _base_set(trial: Trial, observed: Observed, table: DHTable) -> Iterator[ProgramEdit]:
    """The arm's base for the identity that a statement begins with."""
    base = np.round(np.asarray(table.base, dtype=float), _DECIMALS) + 0.0
    if np.array_equal(base, np.eye(4)):
        return
    if np.array_equal(base @ base, np.eye(4)):  # its inverse, and it stays as it is typed
        given = {one.arg for one in trial.trees[0].args.args}
        for here in places(0, trial.trees[0]):
            named = isinstance(here.node, ast.Name) and here.node.id in given
            if named and observed.shape(here.node) == (4, 4):
                product = ast.BinOp(matrix_typed(base), ast.MatMult(), here.node)
                yield here.instead(product, "missing matrix", _END)
    turned = float(np.arccos(np.clip((np.trace(base[:3, :3]) - 1) / 2, -1, 1)))
    angle = _PI if turned == np.pi and "np" in trial.space else number(turned)
    ends = {4: base, 3: base[:3, :3]}
    for here in (one for part, tree in enumerate(trial.trees) for one in places(part, tree)):
        if turned and isinstance(here.parent, ast.Call) and is_nothing(here.node):
            yield here.instead(angle, "number", _ABOUT)
        seen = observed.of(here.node) if isinstance(here.node, ast.Call) else None
        size = len(seen.values[0]) if seen is not None and seen.values and seen.shape else 0
        end = ends.get(size, np.eye(size))
        if seen is None or seen.shape != end.shape or np.array_equal(end, np.eye(size)):
            continue
        if all(np.array_equal(value, np.eye(size)) for value in seen.values):
            yield here.instead(matrix_typed(end), "number", _END)


def matrix_typed(value: Array) -> ast.expr:
    """A matrix as it is typed."""
    diagonal = np.diagonal(value)
    plain = np.array_equal(value, np.diag(diagonal))
    text = f"np.diag({diagonal.tolist()})" if plain else f"np.array({value.tolist()})"
    return ast.parse(text, mode="eval").body


def _matrix(value: Array) -> str:
    """A matrix as it is shown."""
    diagonal = np.diagonal(value)
    if np.array_equal(value, np.diag(diagonal)):
        return f"diag({', '.join(map(shown, diagonal))})"
    return f"[{', '.join('[' + ', '.join(map(shown, row)) + ']' for row in value)}]"


def as_it_is(trial: Trial, observed: Observed, robot: Any) -> Callable[[ProgramEdit], bool]:
    """Whether an edit is of a number that the arm's table has as it is."""
    table = table_of(robot)
    if table is None:
        return lambda _edit: False
    same: set[Any] = set()
    for cell, right in _named(trial, observed, table):
        if _same(cell.value, right):
            same.add(id(cell.node) if cell.place is None else ((cell.place.node,), ()))
    for name, found in _columns_of(trial, observed).items():
        values = [found[i].value for i in sorted(found)]
        told = len(values) == table.n and len({*map(abs, values)}) > 1
        if told and any(all(map(_same, column, values)) for column in _columns(table, values)):
            same.add(name)
            typed_ = [cell.node for cell in found.values() if cell.node is not None]
            same |= {id(inner) for node in typed_ for inner in nodes(node)}

    base = np.round(np.asarray(table.base, dtype=float), _DECIMALS) + 0.0
    turned = not np.array_equal(base[:3, :3], np.eye(3))  # a shift may be that of a link as well
    for node in (one for tree in trial.trees for one in nodes(tree)) if turned else ():
        seen = observed.of(node) if isinstance(node, ast.Call) else None
        if seen is None or seen.shape != base.shape or not seen.values:
            continue
        if all(np.array_equal(value, base) for value in seen.values):
            same |= {id(inner) for inner in nodes(node)}

    def sure(edit: ProgramEdit) -> bool:
        if edit.part == DATA and edit.kind == "degrees" and edit.numbers is not None:
            return False  # a column of one angle may be the arm's in degrees, and nobody turns it
        if edit.part == DATA:
            return _column(edit.node, edit.place)[0] in same
        return edit.kind in ("sign", "number") and id(edit.node) in same

    return sure


def columns_as_meant(
    trial: Trial, observed: Observed, robot: Any, alike: Callable[[float, float], bool]
) -> dict[Any, float]:
    """What the arm's table has for the numbers of whole columns that are alike, by their places."""
    table = table_of(robot)
    found: dict[Any, float] = {}
    for column in _columns_of(trial, observed).values() if table is not None else ():
        cells = [column[k] for k in sorted(column)]
        if table is None or len(cells) != table.n:
            continue
        values = [cell.value for cell in cells]
        for right in _columns(table, values):
            pairs = zip(values, right.tolist(), strict=True)
            if all(value == exact or alike(value, exact) for value, exact in pairs):
                found |= zip((cell.key for cell in cells), right.tolist(), strict=True)
                break
    return found


def key_of(place: NumberPlace) -> Any:
    """What tells a number's place from all others."""
    return id(place.node) if place.part != DATA else (place.node, place.place)


@dataclass(frozen=True, eq=False)
class _Cell:
    """A number of a table: in the data, or in the text of a program, where it hangs."""

    value: float
    place: NumberPlace | None = None
    part: int = DATA
    holder: Any = None
    field: Any = None
    node: Any = None

    @property
    def key(self) -> Any:
        return id(self.node) if self.place is None else key_of(self.place)

    def edit(self, right: float) -> ProgramEdit:
        """The table's number there."""
        kind = "sign" if right == -self.value else "number"
        if self.place is not None:
            return self.place.edit(right, kind, _COST)
        new = minus(self.node) if kind == "sign" else typed(right)
        change = FieldChange(self.holder, self.field, new)
        both = (self.value, right)
        return ProgramEdit(
            self.part, (change,), kind, _COST, self.node, numbers=both, of_the_arm=True
        )


def _row(some: Sequence[tuple[_Cell, float]], whole: Sequence[_Cell], alone: bool) -> ProgramEdit:
    """Several numbers of a row; exchanged, where all else of their columns is right."""
    first = some[0][0]
    put = {id(cell): right for cell, right in some}
    old = [cell.value for cell in whole]
    new = [put.get(id(cell), cell.value) for cell in whole]
    kind = "entries swapped" if alone and sorted(old) == sorted(new) else "number"
    if first.place is None:
        changes = [change for cell, right in some for change in cell.edit(right).changes]
        return ProgramEdit(first.part, tuple(changes), kind, _COST, first.node, of_the_arm=True)
    both = [(cell.place, right) for cell, right in some if cell.place is not None]
    changes = [change for edit in together(both) for change in edit.changes]
    told = (", ".join(map(shown, old)), ", ".join(map(shown, new)))
    node, several, place = first.place.node, tuple(changes), first.place.place
    row = next((k for k, at in enumerate(place) if isinstance(at, int)), -1)
    whole_row = place[: row + 1]
    return ProgramEdit(DATA, several, kind, _COST, node, whole_row, exchanged=told, of_the_arm=True)


def typed(value: float) -> ast.expr:
    """A number as it is typed: parts of pi as such."""
    part = Fraction(value / np.pi).limit_denominator(_PARTS)
    if not value or abs(value - float(part) * np.pi) > TOLERANCES.same_number * abs(value):
        return number(int(value) if value == int(value) else float(f"{value:.12g}"))
    pi: ast.expr = ast.Attribute(ast.Name("np", ast.Load()), "pi", ast.Load())
    top = abs(part.numerator)
    pi = ast.BinOp(number(top), ast.Mult(), pi) if top > 1 else pi
    pi = ast.UnaryOp(ast.USub(), pi) if value < 0 else pi
    return ast.BinOp(pi, ast.Div(), number(part.denominator)) if part.denominator > 1 else pi


def _column(node: Any, place: tuple[Any, ...]) -> tuple[Any, int | None]:
    """The column of a number of the data, with the table before it, and the number's row.

    An attribute of a class may be a table, as a name of the module is.
    """
    row = next((k for k, at in enumerate(place) if isinstance(at, int)), None)
    if row is None:
        return ((node, *place), ()), None
    return ((node, *place[:row]), place[row + 1 :]), place[row]


def _columns_of(trial: Trial, observed: Observed) -> dict[Any, dict[int, _Cell]]:
    """The columns of the tables of a program, each by the row.

    Calls of one function of its own, as many as there are links, are the rows of a table too.
    """
    found: dict[Any, dict[int, _Cell]] = {}
    alike: dict[type, list[Any]] = {}
    for name in trial.program.data:
        alike.setdefault(type(trial.space.get(name)), []).append(name)
    for leaf in leaves(trial):
        column, at = _column(leaf.node, leaf.place)
        kind = type(trial.space.get(leaf.node))
        if at is None and kind in trial.classes.values() and leaf.node in alike.get(kind, ()):
            column, at = (kind, leaf.place), alike[kind].index(leaf.node)  # objects, one each
        if at is not None:
            found.setdefault(column, {})[at] = _Cell(float(leaf.value), leaf)
    own = {part.name for part in trial.program.parts} | {one.__name__ for one in trial.classes}
    for part, tree in enumerate(trial.trees):
        rows: dict[str, list[ast.expr]] = {}
        for call in sorted(_calls(tree), key=lambda one: (one.lineno, one.col_offset)):
            if called(call) in own:
                rows.setdefault(called(call), []).append(call)
        for name, calls in rows.items():
            for k, row in enumerate(calls):
                for key, holder, field in _cells(calls, k, row):
                    cell = _cell(observed, part, holder, field)
                    if cell is not None:
                        found.setdefault(((part, name), key), {})[k] = cell
        for name, k, row in _rows_set(tree):
            for key, holder, field in _cells([row], 0, row):
                cell = _cell(observed, part, holder, field)
                if cell is not None:
                    found.setdefault(((part, name), key), {})[k] = cell
        for table in nodes(tree):
            if isinstance(table, ast.List | ast.Tuple) and isinstance(table.ctx, ast.Load):
                for k, row in enumerate(table.elts):
                    for key, holder, field in _cells(table.elts, k, row):
                        cell = _cell(observed, part, holder, field)
                        if cell is not None:
                            found.setdefault((id(table), key), {})[k] = cell
    return found


def _rows_set(tree: ast.AST) -> Iterator[tuple[str, int, ast.expr]]:
    """The rows, or columns, of an array that are set one by one: ``dh[4, :] = [...]``."""
    for line in (node for node in nodes(tree) if isinstance(node, ast.Assign)):
        target, value = line.targets[0], line.value
        if isinstance(target, ast.Subscript) and isinstance(target.value, ast.Name):
            keys = target.slice.elts if isinstance(target.slice, ast.Tuple) else [target.slice]
            at = [key.value for key in keys if isinstance(key, ast.Constant)]
            if len(at) == 1 and type(at[0]) is int and isinstance(value, ast.List | ast.Tuple):
                yield target.value.id, at[0], value


def _calls(tree: ast.AST) -> list[ast.Call]:
    return [node for node in nodes(tree) if isinstance(node, ast.Call)]


def _named(trial: Trial, observed: Observed, table: DHTable) -> Iterator[tuple[_Cell, float]]:
    """The numbers to which a program gives the arm's own names, each with what the arm has."""
    words = vocabulary(table)
    sums = {
        name: sum(float(share) * float(words.values[part]) for share, part in parts)
        for name, parts in words.others.items()
        if all(part in words.values for _share, part in parts)
    }
    known = {name: value for name, value in sums.items() if value}  # of rods: lc1 = l1/2
    known |= {name: float(value) for name, value in words.values.items()}
    known |= {name.lower(): value for name, value in known.items() if name.lower() not in known}
    for leaf in leaves(trial):
        name = _label(leaf.place[-1] if leaf.place else leaf.node, known)
        if name and all(isinstance(at, str) for at in leaf.place):
            yield _Cell(float(leaf.value), leaf), known[name]
    for part, tree in enumerate(trial.trees):
        for line in (node for node in nodes(tree) if isinstance(node, ast.Assign)):
            for told, holder, field in _given(line):
                name = _label(told, known)
                cell = _cell(observed, part, holder, field) if name else None
                if cell is not None:
                    yield cell, known[name]


def _label(typed: Any, known: Container[str]) -> str:
    """The arm's name for one as it is typed: d3 of ``D3`` and of ``d_3``; empty where none is."""
    plain = str(typed).replace("_", "")
    return next((name for name in (plain, plain.lower()) if name in known), "")


def _given(line: ast.Assign) -> Iterator[tuple[str, Any, Any]]:
    """The names that a statement sets, each with where its value hangs."""
    target, value = line.targets[0], line.value
    if isinstance(target, ast.Name | ast.Attribute):
        yield getattr(target, "id", getattr(target, "attr", "")), line, "value"
    elif isinstance(target, ast.Tuple) and isinstance(value, ast.Tuple):
        for k, one in enumerate(target.elts[: len(value.elts)]):
            if isinstance(one, ast.Name):
                yield one.id, value.elts, k


def _cell(observed: Observed, part: int, holder: Any, field: Any) -> _Cell | None:
    """What stands at a place, if it is a number as somebody types it."""
    node = FieldChange(holder, field, None).now
    seen = observed.of(node)
    if not all(isinstance(one, _TYPED) for one in nodes(node)):
        return None
    named = [one for one in nodes(node) if isinstance(one, ast.Name)]
    if not all(one.id in _OF_PI or _is_of_angles(observed.of(one)) for one in named):
        return None
    if seen is None or seen.shape != () or not seen.values:
        return None
    return _Cell(float(seen.values[0]), None, part, holder, field, node)


_OF_PI = ("np", "numpy", "math", "pi")


def _is_of_angles(seen: Seen | None) -> bool:
    """Whether a name is of pi, a right angle or a degree: ``90*deg``."""
    if seen is None or seen.shape != () or not seen.values:
        return False
    return any(all(_same(float(x), angle) for x in seen.values) for angle in _ANGLES)


_ANGLES = (np.pi, np.pi / 2, np.pi / 180)
_TYPED = (
    ast.Constant,
    ast.UnaryOp,
    ast.BinOp,
    ast.Attribute,
    ast.Name,
    ast.operator,
    ast.unaryop,
    ast.Load,
)
"""What a number is typed with: ``-np.pi/2``."""


def _cells(rows: list[Any], k: int, row: ast.expr) -> Iterator[tuple[Any, Any, Any]]:
    """The numbers of a row, and of the rows in it: the key of each, and where it hangs."""
    if isinstance(row, ast.List | ast.Tuple):
        below: list[tuple[Any, Any, Any]] = [(j, row.elts, j) for j in range(len(row.elts))]
    elif isinstance(row, ast.Dict):
        keys = [getattr(key, "value", None) for key in row.keys]
        below = [(key, row.values, j) for j, key in enumerate(keys)]
    elif isinstance(row, ast.Call):
        below = [(j, row.args, j) for j in range(len(row.args))]
        below += [(word.arg, word, "value") for word in row.keywords]
    else:
        below = [(None, rows, k)]
    for key, holder, field in below:
        yield key, holder, field
        inner = FieldChange(holder, field, None).now
        if isinstance(inner, ast.List | ast.Tuple):
            yield from (((key, j), inner.elts, j) for j in range(len(inner.elts)))


def _wrong(values: Sequence[float], columns: Sequence[Array]) -> dict[tuple[int, float], int]:
    """The numbers that are not as in a column of which most others are, and are not all alike.

    Each with how many of them the column has.
    """
    alike = [[_same(float(x), y) for x, y in zip(c, values, strict=True)] for c in columns]
    found: dict[tuple[int, float], int] = {}
    if len({*values}) > 1 and any(map(all, alike)):
        return found
    for at, (column, same) in enumerate(zip(columns, alike, strict=True)):
        of_axes = at >= len(columns) - _OF_AXES
        apart = {float(x) for x, good in zip(column, same, strict=True) if good}
        off = [int(k) for k in np.flatnonzero(np.logical_not(same))]
        if 2 * sum(same) >= len(same):
            for k in off:
                if of_axes and not any(apart) and _same(float(column[k]), -values[k]):
                    continue  # noughts do not tell which way an axis points
                if column[k] or len(apart) > 1:
                    found.setdefault((k, float(column[k])), len(off))
    return found


def _exchanged(values: Sequence[float], columns: Sequence[Array]) -> list[int]:
    """Where two neighbours are exchanged in what is a column otherwise, of which no two are one."""
    if len({*values}) < max(_TOLD, len(values)):
        return []
    found: set[int] = set()
    for k in range(len(values) - 1):
        right = [*values[:k], values[k + 1], values[k], *values[k + 2 :]]
        if any(all(map(_same, right, column.tolist())) for column in columns):
            found.add(k)
    return sorted(found)


def _columns(table: DHTable, typed: Sequence[float]) -> list[Array]:
    """The columns of a table: its lengths, angles, masses, centres, moments of inertia, rotors.

    Its lengths and twists also as the other convention has them, a row further on or back. Where
    one of those that are typed is no angle in radians, its angles in degrees, too, and its
    lengths and masses by the thousandth; its twists in quarter turns where all are whole.
    """
    links = table.links
    plain = [[getattr(k, name) for k in links] for name in _PLAIN]
    if table.convention is Convention.STANDARD:
        plain += [[0.0, *column[:-1]] for column in plain[:2]]
    else:
        ends = float(np.asarray(table.tool)[0, 3]), 0.0
        plain += [[*column[1:], end] for column, end in zip(plain[:2], ends, strict=True)]
    centres = np.array([k.com for k in links], dtype=float).T
    if max(map(abs, typed), default=0.0) > 2 * np.pi:
        degrees = np.degrees(plain[1:4:2])
        thousandths = 1000 * np.array([plain[0], plain[2], plain[4], *centres])
        plain += np.round([*degrees, *thousandths], _DECIMALS_OF_DEGREES).tolist()
    elif all(x == round(x) for x in typed) and np.count_nonzero(typed) >= _TOLD:
        turns = np.array(plain[1], dtype=float) / (np.pi / 2)
        plain += [turns.tolist()] if np.array_equal(turns, np.round(turns)) else []
    tensors = np.array([k.inertia for k in links], dtype=float)
    moments = [tensors[:, i, j] for i, j in combinations_with_replacement(range(3), 2)]
    return [np.array(column, dtype=float) for column in (*plain, *centres, *moments)]


def _same(one: float, other: float) -> bool:
    return abs(one - other) <= TOLERANCES.same_number * max(abs(one), abs(other))
