"""Rows of a program otherwise: entries exchanged, moved on, with other signs."""

from __future__ import annotations

import ast
from collections.abc import Iterator, Sequence
from itertools import combinations
from typing import Any

from kinlab.doctor.bytecode.syntax import called, copied, nodes, shallow, text_of
from kinlab.doctor.program.edits.chains import SUMS
from kinlab.doctor.program.edits.numbers.data import moved_on, other_words
from kinlab.doctor.program.observed import Observed
from kinlab.doctor.program.places import Here, ProgramEdit, follow, is_nothing, number

_LONGEST = 6
"""Entries of a list of which any two may have been exchanged."""
_SIDE_BY_SIDE = 1.06
"""Cost of two transforms of a list for one another that stand side by side."""
_PLACE = 3
"""Where the 1 stands in what a transform is multiplied with."""
FLAT = 0.1
"""What it costs more to take a number for a matrix."""
_THREE = 3
"""Sides of a rotation matrix."""
_POSE = 4
"""Rows of a homogeneous transform, in which the rotation alone may be transposed."""
_PAIR, _NUMBERS = 2, ast.Constant | ast.Name | ast.UnaryOp | ast.Attribute
"""Entries that are exchanged where they are moved on; what rows of numbers are made of."""
_SLIDE = 1.08
"""Cost of a slide's column for a hinge's."""
_ONES = 1.14
"""Cost of ones for a row with zeros."""
_TURNED = 1.05
"""Cost of a turn the other way for one about an axis."""
_MOMENT = 1.06
"""Cost of the other sign of half a twist: of the moment of a screw."""
_LIKE_ANOTHER = 1.06
"""Cost of an entry that is made as another one of its row is."""
_PRODUCTS = 1.08
"""Cost of the other sign of all products of inertia."""
_QUARTER = 0.99
"""Cost of a vector's normal on its other side."""
_HALVED = 1.04
"""Cost of the halves of a twist, or of a wrench, for one another."""


def of_sequence(here: Here, observed: Observed) -> Iterator[ProgramEdit]:
    elements = here.node.elts
    if any(isinstance(e, ast.Starred) for e in elements):
        return
    yield from _neighbours(here, observed)
    if len(elements) > _LONGEST:
        return
    if isinstance(here.parent, ast.Subscript) and here.field == "slice":
        return
    yield from swapped_in(here, here.node, observed)
    yield from _across(here, elements)
    yield from _between(here, elements)
    yield from _signs_of_two(here, elements)
    yield from _products_of_inertia(here, elements)
    yield from _laid_out(here, elements)
    yield from _like_another(here, elements)
    yield from _in_its_units(here, elements)
    turned = [_opposite(one) for one in elements]
    if sum(one is not old for one, old in zip(turned, elements, strict=True)) >= _PAIR:
        unpacked = isinstance(here.node, ast.Tuple) and isinstance(here.parent, ast.Assign)
        cost = 1.25 if unpacked else _QUARTER if _is_normal(elements) else 1.1
        yield here.within(here.node, "elts", turned, "sign", cost)
    for part in (slice(3), slice(3, 6)) if len(elements) == 2 * _THREE else ():
        half = [*elements]
        half[part] = turned[part]
        if sum(one is not old for one, old in zip(half, elements, strict=True)) >= _PAIR:
            yield here.within(here.node, "elts", half, "sign", _MOMENT)
    slid = _as_of_a_slide(elements)
    if slid:
        yield here.within(here.node, "elts", slid, "kind of joint", _SLIDE)
    flags = [getattr(one, "value", None) for one in elements]
    if {*flags} == {0, 1}:  # all joints turn the tool, or all before a link
        own = len(flags) - flags[::-1].index(1)
        for count in sorted({own, len(flags)}):
            ones = [ast.Constant(1) if k < count else x for k, x in enumerate(elements)]
            yield here.within(here.node, "elts", ones, "number", _ONES)
    if len(elements) > _PAIR and all(isinstance(one, _NUMBERS) for one in elements):
        for moved in moved_on(elements):
            yield here.within(here.node, "elts", moved, "shifted", 1.13)
    points = [one for one in elements if isinstance(one, ast.Name) and observed.shape(one) == (3,)]
    if len(points) == len(elements) > _PAIR:  # those of the frames before, of which one is the base
        base: ast.expr = ast.parse("np.zeros(3)", mode="eval").body
        yield here.within(here.node, "elts", [base, *elements[:-1]], "shifted", 1.13)
    named = [observed.shape(one) or () for one in elements if isinstance(one, ast.Name)]
    if len(elements) > _PAIR and named in ([(4, 4)] * len(elements), [(3, 3)] * len(elements)):
        base = ast.parse(f"np.eye({named[0][0]})", mode="eval").body
        yield here.within(here.node, "elts", [base, *elements[:-1]], "shifted", 1.1)


def _neighbours(here: Here, observed: Observed) -> Iterator[ProgramEdit]:
    """Two transforms of a list for one another that stand side by side: of a long one, too; and
    two numbers of a long one.
    """
    elements = here.node.elts
    shapes = [observed.shape(one) for one in elements]
    for k in range(len(elements) - 1):
        square = shapes[k] if shapes[k] in ((3, 3), (4, 4)) else None
        same = ast.dump(elements[k]) == ast.dump(elements[k + 1])
        poses = square is not None and shapes[k + 1] == square
        numbers = len(elements) > _LONGEST and shapes[k : k + 2] == [(), ()]
        if (poses or numbers) and not same:
            swapped = [*elements[:k], elements[k + 1], elements[k], *elements[k + 2 :]]
            kind = "order" if poses else "entries swapped"
            yield here.within(here.node, "elts", swapped, kind, _SIDE_BY_SIDE)


def _like_another(here: Here, rows: Sequence[ast.expr]) -> Iterator[ProgramEdit]:
    """An entry, or its last term, as another one is, with its own index: ``f[1] + F[1]``."""
    for k, own in enumerate(rows):
        added = set[str]()
        for j, other in enumerate(rows):
            if j == k or not isinstance(other, ast.BinOp) or not isinstance(other.op, SUMS):
                continue
            term = _Counted(j, k).visit(copied(other.right))
            text = ast.dump(term)
            if text != ast.dump(other.right) and text not in added | {ast.dump(own)}:
                added.add(text)
                more = ast.BinOp(own, other.op, term)
                yield here.within(here.node.elts, k, more, "missing term", _LIKE_ANOTHER)
        for j, other in enumerate(rows):
            new = _Counted(j, k).visit(copied(other)) if j != k else own
            if ast.dump(new) != ast.dump(own) and ast.dump(new) != ast.dump(other):
                kind = "missing term" if ast.unparse(own) in ast.unparse(new) else "name"
                yield here.within(here.node.elts, k, new, kind, _LIKE_ANOTHER)


class _Counted(ast.NodeTransformer):
    """Another index for one: ``F[1]`` for ``F[0]``."""

    def __init__(self, old: int, new: int) -> None:
        self.old, self.new = old, new

    def visit_Subscript(self, node: ast.Subscript) -> ast.expr:
        self.generic_visit(node)
        key = node.slice
        if isinstance(key, ast.Constant) and type(key.value) is int and key.value == self.old:
            return ast.Subscript(node.value, number(self.new), node.ctx)
        return node


_LAYOUTS = (
    ((0, 3, 4), (3, 1, 5), (4, 5, 2)),  # xx, yy, zz, xy, xz, yz
    ((0, 1, 2), (1, 3, 4), (2, 4, 5)),  # xx, xy, xz, yy, yz, zz
    ((0, 1, 3), (1, 2, 4), (3, 4, 5)),  # xx, xy, yy, xz, yz, zz
    ((0, 5, 4), (5, 1, 3), (4, 3, 2)),  # xx, yy, zz, yz, xz, xy
)
"""Orders in which six numbers of an inertia tensor are kept."""


def _in_its_units(here: Here, entries: Sequence[ast.expr]) -> Iterator[ProgramEdit]:
    """A factor that another row of entries has: ``1000*v[0], 1000*v[1]`` beside ``1000*p[0]``."""
    if not all(isinstance(one, ast.Subscript) for one in entries):
        return
    for row in (x for x in nodes(here.above[0]) if isinstance(x, ast.Tuple | ast.List)):
        products = [x for x in row.elts if isinstance(x, ast.BinOp) and isinstance(x.op, ast.Mult)]
        factors = {text_of(one.left) for one in products if isinstance(one.left, ast.Constant)}
        if len(row.elts) == len(products) == len(entries) and len(factors) == 1:
            factor = products[0].left
            new: list[ast.expr] = [ast.BinOp(factor, ast.Mult(), one) for one in entries]
            yield here.within(here.node, "elts", new, "factor", _UNITS)
            return


def _laid_out(here: Here, rows: Sequence[ast.expr]) -> Iterator[ProgramEdit]:
    """A tensor of six numbers in a row that are kept in another order."""
    entries = [x for one in rows if isinstance(one, ast.List | ast.Tuple) for x in one.elts]
    if len(entries) != _THREE**2 or not all(isinstance(x, ast.Subscript) for x in entries):
        return
    kept = {ast.unparse(x.value) for x in entries if isinstance(x, ast.Subscript)}
    places_ = [getattr(getattr(x, "slice", None), "value", None) for x in entries]
    own = tuple(tuple(places_[k : k + _THREE]) for k in range(0, _THREE**2, _THREE))
    if len(kept) != 1 or own not in _LAYOUTS:
        return
    whole = entries[0].value if isinstance(entries[0], ast.Subscript) else entries[0]
    for layout in _LAYOUTS:
        if layout != own:
            new = [ast.List([_at(whole, k) for k in row], ast.Load()) for row in layout]
            yield here.within(here.node, "elts", new, "order", 1.08)


def _at(whole: ast.expr, k: int) -> ast.expr:
    return ast.Subscript(whole, ast.Constant(k), ast.Load())


def _as_of_a_slide(elements: Sequence[ast.expr]) -> list[ast.expr]:
    """A slide's column for a hinge's: ``[z, 0]`` for ``[z x r, z]``; empty of other rows."""
    if len(elements) != _PAIR:
        return []
    moments = [isinstance(one, ast.Call) and called(one) == "cross" for one in elements]
    if sum(moments) != 1:
        return []
    axis = elements[moments.index(False)]
    nothing: ast.expr = ast.parse("np.zeros(3)", mode="eval").body
    return [axis, nothing] if moments[0] else [nothing, axis]


def _between(here: Here, rows: Sequence[ast.expr]) -> Iterator[ProgramEdit]:
    """What two rows, or two calls of one function, have at the same place, for one another."""
    several = [_members_of(one) for one in rows]
    if not 1 < len(rows) <= _LONGEST or len({len(one) for one in several}) > 1:
        return
    if len({type(one) for one in rows}) > 1 or len({ast.unparse(x.func) for x in rows
                                                    if isinstance(x, ast.Call)}) > 1:  # fmt: skip
        return
    for i, j in combinations(range(len(rows)), 2):
        for k in range(len(several[0])):
            one, other = several[i][k], several[j][k]
            if ast.dump(one) != ast.dump(other):
                new = [*rows]
                new[i] = _with_member(rows[i], k, other)
                new[j] = _with_member(rows[j], k, one)
                yield here.within(here.node, "elts", new, "entries swapped", 1.13)


def _members_of(row: ast.expr) -> list[ast.expr]:
    """What a row has, or what a call is given."""
    if isinstance(row, ast.Call):
        return [*row.args, *(word.value for word in row.keywords)]
    if isinstance(row, ast.Dict):
        return row.values
    return row.elts if isinstance(row, ast.List | ast.Tuple) else []


def _with_member(row: Any, k: int, new: ast.expr) -> Any:
    other = shallow(row)
    if isinstance(row, ast.Call):
        other.args = [new if i == k else x for i, x in enumerate(row.args)]
        count = len(row.args)
        words = [ast.keyword(x.arg, new if i + count == k else x.value)
                 for i, x in enumerate(row.keywords)]  # fmt: skip
        other.keywords = words
    else:
        field = "values" if isinstance(row, ast.Dict) else "elts"
        setattr(other, field, [new if i == k else x for i, x in enumerate(_members_of(row))])
    return other


def _of_axes(rows: Sequence[ast.expr]) -> list[list[ast.expr]]:
    """The entries of three rows of three; none of others."""
    entries = [one.elts for one in rows if isinstance(one, ast.List | ast.Tuple)]
    square = len(entries) == len(rows) and {len(rows), *map(len, entries)} == {_THREE}
    return entries if square else []


def _is_normal(elements: Sequence[ast.expr]) -> bool:
    """Whether two coordinates are exchanged, and one has a minus: ``[-d[1], d[0]]``."""
    minus = [isinstance(one, ast.UnaryOp) and isinstance(one.op, ast.USub) for one in elements]
    parts = [getattr(one, "operand", one) for one in elements]
    return len(parts) == _PAIR and sum(minus) == 1 and follow(parts[0], parts[1])


def _signs_of_two(here: Here, rows: Sequence[ast.expr]) -> Iterator[ProgramEdit]:
    """Two rows or columns of a rotation matrix with the other sign: a frame is turned over."""
    entries = _of_axes(rows)
    for some in combinations(range(len(entries)), 2):
        for columns in (False, True):
            turned = [
                ast.List([_opposite(x) if (k if columns else i) in some else x
                          for k, x in enumerate(row)], ast.Load())
                for i, row in enumerate(entries)
            ]  # fmt: skip
            yield here.within(here.node, "elts", turned, "sign", 1.15)


def _products_of_inertia(here: Here, rows: Sequence[ast.expr]) -> Iterator[ProgramEdit]:
    """A tensor with the other sign of its products of inertia, as other books define them."""
    entries = _of_axes(rows)
    texts = [[ast.unparse(x) for x in row] for row in entries]
    if not entries or texts != [[*column] for column in zip(*texts, strict=True)]:
        return
    turned = [
        ast.List([x if i == k else _opposite(x) for k, x in enumerate(row)], ast.Load())
        for i, row in enumerate(entries)
    ]
    yield here.within(here.node, "elts", turned, "products' signs", _PRODUCTS)


def _across(here: Here, rows: Sequence[ast.expr]) -> Iterator[ProgramEdit]:
    """What is written as rows, with columns for rows."""
    entries = [one.elts for one in rows if isinstance(one, ast.List | ast.Tuple)]
    if len(entries) == len(rows) > 1 and all(len(one) == len(rows) for one in entries):
        if len(rows) == _POSE and _is_turn(turn := [one[:-1] for one in entries[:-1]]):
            turned = [ast.List([*one], ast.Load()) for one in zip(*turn, strict=True)]
            beside = zip(turned, entries, strict=False)
            new = [ast.List([*one.elts, row[-1]], ast.Load()) for one, row in beside]
            yield here.within(here.node, "elts", [*new, rows[-1]], "transposed", _TURNED)
        columns = [ast.List([*one], ast.Load()) for one in zip(*entries, strict=True)]
        if ast.dump(ast.List([*columns])) != ast.dump(ast.List([*rows])):
            cost = _TURNED if _is_turn(entries) else 1.12 if len(rows) == _PAIR else 1.3
            yield here.within(here.node, "elts", columns, "transposed", cost)


def _is_turn(entries: Sequence[Sequence[ast.expr]]) -> bool:
    """Whether entries turn about one axis: a sine, and across from it its opposite."""
    size = range(len(entries))
    off = [(i, k) for i in size for k in size if i < k and getattr(entries[i][k], "value", 1) != 0]
    across = [(entries[i][k], entries[k][i]) for i, k in off]
    return len(across) == 1 and any(
        ast.dump(_opposite(one)) == ast.dump(other) and not isinstance(other, ast.Constant)
        for one, other in (*across, across[0][::-1])
    )


def _opposite(node: ast.expr) -> ast.expr:
    """A number with the other sign; a zero, and what is no single number, as it is."""
    if isinstance(node, ast.UnaryOp):
        return node.operand if isinstance(node.op, ast.USub) else node
    if isinstance(node, ast.List | ast.Tuple) or not getattr(node, "value", 1):
        return node
    return ast.UnaryOp(ast.USub(), node)


_UNITS = 1.08
"""Cost of a factor of all entries of a row that those of another row have."""
_SIGNS = 1.06
"""Cost of two signs for one another in a row of signs: about which axis something is turned."""
_TURNED_AWAY = 1.14
"""Cost of a number along another axis, with the other sign."""


def swapped_in(here: Here, row: ast.List | ast.Tuple, observed: Observed) -> Iterator[ProgramEdit]:
    """Two entries for one another."""
    halves = _are_halves(row, observed)
    for i, j in combinations(range(len(row.elts)), 2):
        if ast.dump(row.elts[i]) != ast.dump(row.elts[j]):
            swapped = [*row.elts]
            swapped[i], swapped[j] = swapped[j], swapped[i]
            moved = j == _PLACE and getattr(row.elts[j], "value", None) == 1
            cost = 1.12 + FLAT * moved  # of what is a place, and no direction
            cost = _HALVED if halves else _SIGNS if _are_signs(row) else cost
            yield here.within(row, "elts", swapped, "entries swapped", cost)
            empty = [is_nothing(one) for one in (row.elts[i], row.elts[j])]
            if any(empty) and not all(empty):  # along another axis, the other way
                turned = [_opposite(x) if k in (i, j) else x for k, x in enumerate(swapped)]
                yield here.within(row, "elts", turned, "entries swapped", _TURNED_AWAY)
            elif not any(empty) and len(row.elts) <= _THREE and any(map(is_nothing, row.elts)):
                for at in (i, j):  # the normal of a direction in a plane
                    turned = [_opposite(x) if k == at else x for k, x in enumerate(swapped)]
                    yield here.within(row, "elts", turned, "entries swapped", _TURNED_AWAY)


def _are_signs(row: ast.List | ast.Tuple) -> bool:
    """Whether a row has nothing but signs in it, as a half turn's matrix on its diagonal."""
    typed = {text_of(one).lstrip("-") for one in row.elts}
    return len(row.elts) > _PAIR and typed <= {"1", "1.0"}


def _are_halves(row: ast.List | ast.Tuple, observed: Observed) -> bool:
    """Whether two vectors stand one behind the other: a twist, the angular half and the linear."""
    shapes = [observed.shape(one) for one in row.elts]
    return len(shapes) == _PAIR and shapes[0] == shapes[1] and len(shapes[0] or ()) == 1


def of_letters(here: Here) -> Iterator[ProgramEdit]:
    """The kinds of joints in the order of a word, ``"RRPR"``: two for one another, or one other."""
    for word, kind, cost in other_words(here.node.value):
        yield here.within(here.node, "value", word, kind, cost)
