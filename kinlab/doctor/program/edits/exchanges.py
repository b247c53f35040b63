"""What a slip moves together: two names for one another, one name throughout a statement."""

from __future__ import annotations

import ast
from collections.abc import Iterator
from itertools import combinations
from typing import Any

from kinlab.doctor.bytecode.syntax import beginning, called, copied, names, nodes, text_of
from kinlab.doctor.program.edits.chains import SUMS, chain, joined, members, opposite
from kinlab.doctor.program.edits.scope.forms import Turned, statement_of, summands
from kinlab.doctor.program.edits.scope.part import Scope
from kinlab.doctor.program.edits.single.entries import without_the_first
from kinlab.doctor.program.edits.single.whole import plus
from kinlab.doctor.program.observed import Observed, Shape
from kinlab.doctor.program.places import ANGLES, Here, ProgramEdit, follow, number

_ANGLES = 1.13
"""Cost of the joint before in every angle of a statement."""
_ON = 1.15
"""Cost of the entry before, or behind, for all those of a counter; a row moved on is cheaper."""
_OF_ROWS = 1.15
"""Cost of one row for another wherever a statement reads it."""
_PAIR = 2
_OWNERS = 1.08
"""Cost of two objects for one another in a whole expression."""
_FRONTS = 1.1
"""Cost of what stands in front of two terms, exchanged."""
_TURNED = 1.02
"""Cost of a rotation in the plane the other way: ``c*x + s*y, -s*x + c*y``."""
_MOST = 6
"""Names of one statement of which any two may be exchanged."""
_PARTS = 1.06
"""Cost of the other parts of all complex numbers in a statement."""
_OF_TWO = 1.12
"""Cost of the other function and the other sign of one term."""
_OF_TERMS, _TERMS = 1.16, 12
"""Cost of another term of a statement for one, and of how many such at most."""


def of_owners(here: Here) -> Iterator[ProgramEdit]:
    """Two objects for one another: ``self.R @ o.p + self.p`` for ``o.R @ self.p + o.p``."""
    node, parent = here.node, here.parent
    given = isinstance(parent, ast.Call) and here.holder is parent.args
    if not given and not isinstance(parent, ast.Assign | ast.Return):
        return
    held = [one.value for one in nodes(node) if isinstance(one, ast.Attribute)]
    owners = sorted({one.id for one in held if isinstance(one, ast.Name)} - {"np", "math"})
    if len(owners) != _PAIR:
        return
    turned = copied(node)
    for one in nodes(turned):
        if isinstance(one, ast.Name) and one.id in owners:
            one.id = owners[1 - owners.index(one.id)]
    yield here.instead(turned, "names exchanged", _OWNERS)


def of_statement(here: Here, scope: Scope, observed: Observed) -> Iterator[ProgramEdit]:
    """All uses of a name in what a statement computes: another, or exchanged with those of one."""
    value = here.node.value
    if value is None:
        return
    uses: dict[str, list[ast.expr]] = {}
    for node in nodes(value):
        if isinstance(node, ast.Name | ast.Subscript) and _plain(node):
            uses.setdefault(ast.unparse(node), []).append(node)
    yield from _rows_throughout(here, value)
    for one, other in (("real", "imag"), ("imag", "real")):
        parts = [x for x in nodes(value) if isinstance(x, ast.Attribute) and x.attr == one]
        if len(parts) > 1:
            turned = copied(value)
            for node in nodes(turned):
                if isinstance(node, ast.Attribute) and node.attr == one:
                    node.attr = other
            yield here.within(here.node, "value", turned, "function", _PARTS)
    yield from _poses_exchanged(here, value)
    yield from _coefficients_exchanged(here, value, observed)
    shapes: dict[str, Shape | None] = {}
    for text, found in uses.items():
        shapes[text] = observed.shape(found[0])
    names = [text for text in uses if shapes[text] is not None and text not in scope.counters]
    for one, other in combinations(names[:_MOST], 2):
        if shapes[one] == shapes[other] and _go_together(one, other):
            both = Renamed({one: uses[other][0], other: uses[one][0]})
            cost = 1.08 + 0.02 * (len(uses[one]) + len(uses[other]))
            yield here.within(here.node, "value", both.of(value), "names exchanged", cost)
    calls = (node for node in nodes(value) if isinstance(node, ast.Call))
    angles = {id(call.args[0]) for call in calls if called(call) in ANGLES and call.args}
    for text in names:
        if len(uses[text]) > 1:
            for entry in _entries_beside(uses[text][0]):
                if ast.unparse(entry) not in uses:
                    new = Renamed({text: entry}).of(value)
                    counted = isinstance(getattr(uses[text][0], "slice", None), ast.Name)
                    yield here.within(here.node, "value", new, "index", _ON if counted else 1.1)
            if all(id(node) in angles for node in uses[text]) and _is_given(here, uses[text][0]):
                for _other, node in scope.simple(()):
                    if follow(node, uses[text][0]):
                        first, last = sorted((node, uses[text][0]), key=ast.unparse)
                        angle = ast.BinOp(first, ast.Add(), last)
                        new = Renamed({text: angle}).of(value)
                        yield here.within(here.node, "value", new, "argument", _ANGLES)
            for other, node in scope.simple(shapes[text] or ()):
                alike = other[0] == text[0]
                # q[j] - q[k] of p[j] - p[k]
                row = bool(shapes[text]) and isinstance(node, ast.Name)
                if other != text and (alike or row) and other not in uses:
                    new = Renamed({text: node}).of(value)
                    kind = "transposed" if other == f"{text}.T" else "name"
                    yield here.within(here.node, "value", new, kind, 1.14 if alike else _OF_ROWS)
    for text in names if isinstance(value, ast.Tuple | ast.List) and len(value.elts) == 2 else ():
        turned = [_with_the_other_sign(one, text) for one in value.elts] if not shapes[text] else []
        elts = [one for one in turned if one is not None]
        if len(elts) == 2:
            yield here.within(here.node, "value", type(value)(elts, ast.Load()), "sign", _TURNED)
    turns = {called(n) for n in nodes(value) if isinstance(n, ast.Call)} & {"sin", "cos"}
    count = sum(isinstance(n, ast.Call) and called(n) in ANGLES for n in nodes(value))
    if turns and count > 1:
        yield here.within(here.node, "value", Turned().visit(copied(value)), "sin/cos", 1.1)


def of_the_row_above(here: Here, scope: Scope) -> Iterator[ProgramEdit]:
    """A term whose sine and sign are those of the row above: ``+ c1*b`` for ``- s1*b``.

    Only the function in front of a term is exchanged.
    """
    node = here.node
    for side, name in ((node.left, "left"), (node.right, "right")):
        if isinstance(side, ast.BinOp) and isinstance(side.op, SUMS):
            continue
        front = side.operand if isinstance(side, ast.UnaryOp) else side
        first, rest = chain(front, (ast.Mult, ast.Div))
        turned = Turned(scope.shapes).visit(copied(first))
        if isinstance(first, ast.Name | ast.Call) and ast.dump(turned) != ast.dump(first):
            new = joined(turned, rest)
            if name == "right":
                other = ast.Sub() if isinstance(node.op, ast.Add) else ast.Add()
                yield here.instead(ast.BinOp(node.left, other, new), "sin/cos", _OF_TWO)
            else:
                new = new if front is not side else ast.UnaryOp(ast.USub(), new)
                yield here.instead(ast.BinOp(new, node.op, node.right), "sin/cos", _OF_TWO)


def _rows_throughout(here: Here, value: ast.expr) -> Iterator[ProgramEdit]:
    """All but the first for all but the last, in every place of a statement: ``R[:6]``."""
    cut: dict[str, list[ast.Subscript]] = {}
    for node in nodes(value):
        if isinstance(node, ast.Subscript) and isinstance(node.slice, ast.Slice):
            cut.setdefault(text_of(node), []).append(node)
    for text, found in cut.items():
        key = found[0].slice
        assert isinstance(key, ast.Slice)
        moved = without_the_first(key)
        if len(found) > 1 and moved is not None:
            other = ast.Subscript(found[0].value, moved, ast.Load())
            new = Renamed({text: other}).of(value)
            yield here.within(here.node, "value", new, "index", 1.1)


def _poses_exchanged(here: Here, value: ast.expr) -> Iterator[ProgramEdit]:
    """In one entry of what is given on two of one kind for one another: ``Y[0] @ X[1] + Y[1]``."""
    entries = value.elts if isinstance(value, ast.Tuple | ast.List) else []
    for k, entry in enumerate(entries):
        kept = (x for x in nodes(entry) if isinstance(x, ast.Subscript))
        roots = dict.fromkeys(x.value.id for x in kept if isinstance(x.value, ast.Name))
        if len(roots) == len("XY"):
            one, other = roots
            both = {one: ast.Name(other, ast.Load()), other: ast.Name(one, ast.Load())}
            new = Renamed(dict[str, ast.expr](both)).of(entry)
            yield here.within(entries, k, new, "names exchanged", _ANGLES)


def _coefficients_exchanged(
    here: Here, value: ast.expr, observed: Observed
) -> Iterator[ProgramEdit]:
    """Two terms of a sum with the sum in each for one another: ``(1 - c)*W + (t - s)*W @ W``,
    ``c*(x - bx) - s*(y - by)``.
    """
    first, terms = chain(value, SUMS)
    for one, other in combinations([first, *(term for _op, term in terms)], 2):
        fronts = [sum_ for x in (one, other) if (sum_ := _only_sum(x)) is not None]
        if len(fronts) < 2:
            continue
        texts = [ast.unparse(x) for x in fronts]
        if texts[0] != texts[1] and all(observed.shape(x) == () for x in fronts):
            both = _Swapped(dict[str, ast.expr](zip(texts, reversed(fronts), strict=True)))
            yield here.within(here.node, "value", both.of(value), "names exchanged", _FRONTS)


def _only_sum(term: ast.expr) -> ast.expr | None:
    """The sum in front of a term, or its only factor that is one."""
    factors = [beginning(term), *members(chain(term, (ast.Mult,)))]
    sums = {id(x): x for x in factors if isinstance(x, ast.BinOp) and isinstance(x.op, SUMS)}
    return next(iter(sums.values())) if len(sums) == 1 else None


def of_terms(here: Here, observed: Observed) -> Iterator[ProgramEdit]:
    """Another term of the statement for one in a list: ``l1*c1`` for ``l2*c12`` in a matrix."""
    rows = any(isinstance(one, ast.List | ast.Tuple) for one in here.above)
    value = getattr(statement_of(here.above), "value", None) if rows and _is_summand(here) else None
    if value is None:
        return
    own, shape = text_of(here.node), observed.shape(here.node)
    terms = (x for row in nodes(value) if isinstance(row, ast.List | ast.Tuple) for x in row.elts)
    every = (one for entry in terms for one in summands(entry) if isinstance(one, ast.BinOp))
    others = {text_of(one).removeprefix("-"): one for one in every}
    for text, other in others.items() if len(others) <= _TERMS else ():
        if text != own.removeprefix("-") and observed.shape(other) == shape:
            turned = own.startswith("-") and not text_of(other).startswith("-")
            new = opposite(other) if turned else other
            yield here.instead(new, "another term", _OF_TERMS)


def _is_summand(here: Here) -> bool:
    """Whether a product is an entry of a list, or a term of one."""
    node = here.node
    if not isinstance(node, ast.BinOp) or isinstance(node.op, ast.Add | ast.Sub):
        return False
    outer = here.parent
    if isinstance(outer, ast.BinOp):
        return isinstance(outer.op, ast.Add | ast.Sub)
    return isinstance(outer, ast.List | ast.Tuple)


def _with_the_other_sign(node: ast.expr, name: str) -> ast.expr | None:
    """A sum in which the one term with a name has the other sign: None of what has no such."""
    first, terms = chain(node, SUMS)
    every = [first, *(term for _op, term in terms)]
    has = [k for k, term in enumerate(every) if name in {text_of(x) for x in nodes(term)}]
    if len(has) != 1 or not terms:
        return None
    (k,) = has
    if not k:
        return joined(opposite(first), terms)
    op, term = terms[k - 1]
    other = ast.Sub() if isinstance(op, ast.Add) else ast.Add()
    return joined(first, [*terms[: k - 1], (other, term), *terms[k:]])


def _is_given(here: Here, node: ast.expr) -> bool:
    """Whether it is an entry, or a name to which nothing but one is given: ``t1, t2 = q``."""
    if isinstance(node, ast.Subscript):
        return True
    lines = (one for one in nodes(here.above[0]) if isinstance(one, ast.Assign))
    own = [one for one in lines for to in one.targets if ast.unparse(node) in names(to)]
    return all(isinstance(one.value, ast.Name | ast.Subscript) for one in own)


def _entries_beside(node: ast.expr) -> Iterator[ast.expr]:
    """The entries before and behind one of a row: ``q[1]`` and ``q[3]`` of ``q[2]``."""
    if isinstance(node, ast.Subscript) and isinstance(node.slice, ast.Name):
        for step in (1, -1):
            yield ast.Subscript(node.value, plus(node.slice, step), ast.Load())
    if not isinstance(node, ast.Subscript) or not isinstance(node.slice, ast.Constant):
        return
    own = node.slice.value
    for k in (own - 1, own + 1) if type(own) is int else ():
        if k >= 0:
            yield ast.Subscript(node.value, number(k), ast.Load())


def of_repeated(here: Here, scope: Scope, observed: Observed) -> Iterator[ProgramEdit]:
    """Another name in both places of a call or product: ``outer(p, p)`` for ``outer(c, c)``."""
    node = here.node
    if isinstance(node, ast.Call) and len(node.args) == 2:
        first, last = node.args
    elif isinstance(node, ast.BinOp) and isinstance(node.op, ast.Mult | ast.MatMult):
        first, last = node.left, node.right
    else:
        return
    shape = observed.shape(first)
    if shape is None or not isinstance(first, ast.Name | ast.Subscript | ast.Attribute):
        return
    if ast.dump(first) == ast.dump(last):
        for text, other in scope.simple(shape):
            if text != ast.unparse(first):
                if isinstance(node, ast.Call):
                    yield here.within(node, "args", [other, other], "name", 1.16)
                else:
                    yield here.instead(ast.BinOp(other, node.op, other), "name", 1.16)


def of_row(here: Here, scope: Scope, observed: Observed) -> Iterator[ProgramEdit]:
    """Another name in all entries of a row: ``[l*c, l*s]`` for ``[r*c, r*s]``.

    What an object or a dictionary has stands for another number of the same one.
    """
    entries = [one for one in here.node.elts if not isinstance(one, ast.Constant)]
    if len(entries) < 2:
        return
    for moved in _of_other_places(entries, observed):
        yield here.within(here.node, "elts", moved, "index", 1.06)
    used = [
        {ast.unparse(x): x for x in nodes(one) if isinstance(x, _PIECES) and _is_piece(x)}
        for one in entries
    ]
    for text in [text for text in used[0] if all(text in other for other in used[1:])]:
        node = used[0][text]
        shape = observed.shape(node)
        if shape is None or text in scope.counters:
            continue
        for other, new in scope.simple(shape):
            if other == text or other in used[0]:
                continue
            if isinstance(node, ast.Name):
                like, cost = isinstance(new, ast.Name) and other[0] == text[0], 1.1
            else:
                like, cost = _owner(new) == _owner(node), 1.06
            if like:
                put = [Renamed({text: new}).of(one) for one in here.node.elts]
                yield here.within(here.node, "elts", put, "name", cost)


def _of_other_places(entries: list[ast.expr], observed: Observed) -> Iterator[list[ast.expr]]:
    """The entries at another place of each: ``n[2], o[2], a[2]`` for ``n[0], o[0], a[0]``."""
    given = [one for one in entries if isinstance(one, ast.Subscript)]
    at: set[Any] = {getattr(one.slice, "value", None) for one in given}
    sizes = [shape[0] for one in given if (shape := observed.shape(one.value))]
    if len(sizes) < len(entries) or len(at) > 1 or not all(type(k) is int for k in at):
        return
    for k in range(min(sizes)):
        if k not in at:
            yield [ast.Subscript(one.value, number(k), ast.Load()) for one in given]


_PIECES = ast.Name | ast.Subscript | ast.Attribute


def _is_piece(node: ast.Name | ast.Subscript | ast.Attribute) -> bool:
    """Whether it is a name, an attribute, or what a dictionary has under a key."""
    if not isinstance(node.ctx, ast.Load):
        return False
    key = node.slice if isinstance(node, ast.Subscript) else ast.Constant("")
    return isinstance(key, ast.Constant) and isinstance(key.value, str)


def _owner(node: ast.expr) -> str:
    return ast.unparse(node.value) if isinstance(node, ast.Subscript | ast.Attribute) else ""


def _go_together(one: str, other: str) -> bool:
    """Whether names may be taken for one another: ``l1`` and ``l2``, ``s12`` and ``c12``."""
    waves = one[0] + other[0] in ("sc", "cs") and one[1:] == other[1:]
    letters = len(one) == len(other) == 1 and one.isupper() and other.isupper()  # A and B
    return one[0] == other[0] or waves or letters


def _plain(node: ast.Name | ast.Subscript) -> bool:
    if isinstance(node, ast.Name):
        return isinstance(node.ctx, ast.Load)
    return isinstance(node.value, ast.Name) and isinstance(node.slice, ast.Constant | ast.Name)


class Renamed(ast.NodeTransformer):
    """Other expressions for names and entries, by what they are as text."""

    def __init__(self, others: dict[str, ast.expr]) -> None:
        self.others = others

    def of(self, value: ast.expr) -> ast.expr:
        """A copy of an expression with the others in it."""
        new: ast.expr = self.visit(copied(value))
        return new

    def visit_Name(self, node: ast.Name) -> ast.expr:
        return copied(self.others.get(node.id, node))

    def _piece(self, node: ast.expr) -> ast.expr:
        other = self.others.get(ast.unparse(node))
        if other is not None:
            return copied(other)
        self.generic_visit(node)
        below = node.value if isinstance(node, ast.Attribute) and node.attr == "T" else None
        twice = isinstance(below, ast.Attribute) and below.attr == "T"
        return below.value if twice else node  # type: ignore[union-attr]  # R of R.T.T

    visit_Attribute = visit_Subscript = _piece


class _Swapped(Renamed):
    """Other sums for sums, too."""

    visit_BinOp = Renamed._piece
