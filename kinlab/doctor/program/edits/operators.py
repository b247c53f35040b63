"""Single expressions of a program otherwise: their operators, calls, indices, names, numbers."""

from __future__ import annotations

import ast
from collections.abc import Iterator, Sequence
from itertools import combinations, permutations
from typing import Any

from kinlab.doctor.bytecode.syntax import copied, factors, names, nodes, shallow
from kinlab.doctor.program.edits import chains
from kinlab.doctor.program.edits.numbers.data import measured, moved_on, other_words
from kinlab.doctor.program.edits.scope import PI, Scope, Turned, statement_of
from kinlab.doctor.program.observed import Observed
from kinlab.doctor.program.places import ANGLES, Here, ProgramEdit, called, number

_ORDERED = ("cross", "dot", "arctan2", "atan2", "outer", "solve", "matmul", "subtract", "array")
SIZES = ("eye", "zeros", "ones", "range", "sin", "cos", "tan", "full", "reshape", "identity")
"""Functions whose numbers are no quantities."""
_FEW = 8
"""Attributes and keys among which a wrong one is looked for early."""
_LONGEST = 6
"""Entries of a list of which any two may have been exchanged."""
_PLACE = 3
"""Where the 1 stands in what a transform is multiplied with."""
_FLAT = 0.1
"""What it costs more to take a number for a matrix."""
_THREE = 3
"""Indices of which any order is tried."""
_PAIR, _NUMBERS = 2, ast.Constant | ast.Name | ast.UnaryOp | ast.Attribute
"""Entries that are exchanged where they are moved on; what rows of numbers are made of."""
_HALVES, _TYPED = (2, 0.5), 1.045
"""Factors that stand in front, and the cost of one that does not belong there."""
_POWER, _OF_A_NUMBER = 1.08, 1.25
"""Cost of another power, and of one of a number, which nobody means: ``0.25**2``."""
_OF_ITS_MASS = 0.015
"""What it costs less where the mass of its link stands beside it."""
_OF_ROD = 0.04
"""What that costs more in a rod's moment of inertia, whose number is as soon mistaken."""
_HALF = 1.03
"""Cost of a length for the distance of the centre, where that is half of it, or that for it."""
_OF_RODS = {3: 12, 12: 3}
"""A rod's moments of inertia about its end, and about its middle, are its mass by these."""
_DIAGONALS = ("tril", "triu", "eye", "diag")
"""Functions whose last argument is the number of a diagonal."""
_DIAGONAL = 1.02
"""Cost of the main diagonal for another."""
_HALVED = 1.04
"""Cost of the halves of a twist, or of a wrench, for one another."""
_BESIDE = 1.06
"""Cost of an index that another row has in the same line."""
_IN_LINE = 1.12
"""Cost of a name for another that stands in the same line."""
_ARGUMENTS, _APART = 4, 0.03
"""The same of arguments; what it costs more of those that do not stand side by side."""


def of_operator(here: Here, observed: Observed, index: bool) -> Iterator[ProgramEdit]:
    node = here.node
    left, right, op = node.left, node.right, node.op
    if isinstance(op, ast.Add | ast.Sub):
        other = ast.Sub() if isinstance(op, ast.Add) else ast.Add()
        kind = "index" if index else "sign"
        yield here.within(node, "op", other, kind, 1.1 if index else 0.98)
        extra = "index" if index else "extra term"
        yield here.instead(left, extra, 1.08)
        alone = right if isinstance(op, ast.Add) else ast.UnaryOp(ast.USub(), right)
        yield here.instead(alone, extra, 1.1)
        if index:
            return
        for new in chains.together(node):
            yield here.instead(new, "parentheses", 1.09)
        for new in chains.multiplied(node):
            yield here.instead(new, "operator", 1.12)
        if all(len(observed.shape(side) or ()) == 2 for side in (left, right)):
            yield here.within(node, "op", ast.MatMult(), "operator", 1.12)
        for new in chains.squared(node):
            yield here.instead(new, "parentheses", 1.13)
        factor = isinstance(here.parent, ast.BinOp) and not isinstance(here.parent.op, ast.Pow)
        if factor and observed.shape(node) == ():
            yield here.instead(ast.BinOp(node, ast.Pow(), number(2)), "power", 1.12)
        for new in chains.crosswise(node):
            yield here.instead(new, "names exchanged", 1.13)
        for new in chains.called_once(node):
            yield here.instead(new, "parentheses", 1.14)
        for side, inner in (("left", left), ("right", right)):
            if isinstance(inner, ast.Call) and side == "left" and len(inner.args) == 1:
                into = ast.Call(inner.func, [ast.BinOp(inner.args[0], op, right)], inner.keywords)
                yield here.instead(into, "parentheses", 1.15)
        if isinstance(left, ast.BinOp) and isinstance(left.op, ast.Sub) and isinstance(op, ast.Add):
            # a - b + c for a - (b + c)
            rest = ast.BinOp(left.right, op, right)
            yield here.instead(ast.BinOp(left.left, left.op, rest), "parentheses", 1.2)
    elif isinstance(op, chains.PRODUCTS):
        for outer, sum_, name in ((left, right, "right"), (right, left, "left")):
            if isinstance(sum_, ast.BinOp) and isinstance(sum_.op, ast.Add | ast.Sub):
                # a*(b + c) for a*b + c
                one, last = sum_.left, sum_.right
                if name == "right":
                    opened = ast.BinOp(ast.BinOp(outer, op, one), sum_.op, last)
                else:
                    opened = ast.BinOp(one, sum_.op, ast.BinOp(last, op, outer))
                yield here.instead(opened, "parentheses", 1.15)
        matrices = [observed.shape(side) for side in (left, right)]
        for kept, left_out, cost in ((left, matrices[1], 1.15), (right, matrices[0], 1.17)):
            alone = observed.shape(kept) == () and bool(left_out)
            undone = kept is right and _turns_back(left, right)
            cost = 1.02 if undone else cost + _FLAT * alone
            typed = kept is right and getattr(left, "value", 0) in _HALVES
            yield here.instead(kept, "extra factor", _TYPED if typed else cost)
        if isinstance(op, ast.MatMult):
            yield here.instead(ast.BinOp(right, op, left), "order", 1.06)
            sizes = observed.shape(node) or (0,)
            twice = _halved(node) if len(sizes) == _PAIR and sizes[0] == sizes[1] else None
            if twice is not None:  # A + A.T for 2*A
                both = ast.BinOp(twice, ast.Add(), ast.Attribute(twice, "T", ast.Load()))
                yield here.instead(both, "transposed", 1.0)
            yield from _in_turn(here)
            if isinstance(left, ast.BinOp) and isinstance(left.op, ast.MatMult):
                last = ast.BinOp(ast.BinOp(left.left, op, right), left.op, left.right)
                yield here.instead(last, "order", 1.07)
            yield from _turned(here)
            inner = left.args[0] if isinstance(left, ast.Call) and len(left.args) == 1 else None
            if inner is not None and observed.shape(inner) == matrices[1] is not None:
                crossed = ast.Call(left.func, [right], left.keywords)  # skew(a) @ b
                yield here.instead(ast.BinOp(crossed, op, inner), "order", 1.03)
        elif isinstance(op, ast.Mult):
            if isinstance(right, ast.BinOp) and isinstance(right.op, ast.Pow):
                squared = ast.BinOp(ast.BinOp(left, op, right.left), right.op, right.right)
                yield here.instead(squared, "parentheses", 1.12)
            yield here.within(node, "op", ast.Div(), "factor", 1.35)
            if all(shape for shape in matrices):
                yield here.within(node, "op", ast.MatMult(), "product", 1.1)
            if matrices[0] == matrices[1] and matrices[0]:
                for other in (ast.Add(), ast.Sub()):
                    yield here.within(node, "op", other, "operator", 1.16)
            square = matrices[1] is not None and len(matrices[1]) == 2
            if square and isinstance(left, ast.Constant) and left.value == 2:
                across = ast.Attribute(right, "T", ast.Load())
                yield here.instead(ast.BinOp(right, ast.Add(), across), "transposed", 1.08)
            if not (
                isinstance(here.parent, ast.BinOp) and isinstance(here.parent.op, chains.PRODUCTS)
            ):
                for new in chains.added(node):
                    yield here.instead(new, "operator", 1.16)
            if isinstance(left, ast.BinOp) and isinstance(left.op, ast.Div):
                below = ast.BinOp(left.right, ast.Mult(), right)
                yield here.instead(ast.BinOp(left.left, ast.Div(), below), "parentheses", 1.2)
        else:
            yield here.within(node, "op", ast.Mult(), "factor", 1.3)
            yield here.instead(ast.BinOp(right, ast.Div(), left), "order", 1.3)
            if isinstance(left, ast.BinOp) and isinstance(left.op, ast.Add | ast.Sub):
                # (a + b)/c for a + b/c
                tail = ast.BinOp(left.right, ast.Div(), right)
                yield here.instead(ast.BinOp(left.left, left.op, tail), "parentheses", 1.25)
    elif isinstance(op, ast.Pow):
        cost = _OF_A_NUMBER if isinstance(left, ast.Constant) else _POWER
        yield here.instead(left, "power", cost)
        if isinstance(left, ast.BinOp) and isinstance(left.op, ast.Add):
            each = [ast.BinOp(one, op, right) for one in (left.left, left.right)]
            yield here.instead(ast.BinOp(each[0], left.op, each[1]), "parentheses", 1.15)
        if isinstance(left, ast.BinOp) and isinstance(left.op, ast.Mult):
            last = ast.BinOp(left.right, op, right)
            yield here.instead(ast.BinOp(left.left, left.op, last), "parentheses", 1.12)
    elif isinstance(op, ast.FloorDiv) and not index:
        yield here.within(node, "op", ast.Div(), "whole division", 0.97)


def _halved(product: ast.expr) -> ast.expr | None:
    """A product of matrices without the 2 that it begins with: ``A @ B`` of ``2*A @ B``."""
    if not isinstance(product, ast.BinOp):
        return None
    if isinstance(product.op, ast.Mult):
        return product.right if getattr(product.left, "value", 0) == 2 else None
    rest = _halved(product.left) if isinstance(product.op, ast.MatMult) else None
    return None if rest is None else ast.BinOp(rest, product.op, product.right)


def _turns_back(matrix: ast.expr, product: ast.expr) -> bool:
    """Whether a matrix stands before its own transpose: ``R.T @ (R @ v)``."""
    while isinstance(product, ast.BinOp) and isinstance(product.op, ast.MatMult):
        product = product.left
    one, other = ast.unparse(matrix), ast.unparse(product)
    return one == f"{other}.T" or other == f"{one}.T"


def _in_turn(here: Here) -> Iterator[ProgramEdit]:
    """A product of several matrices from another one on, from the last to the first, or with one
    of them further on or further back."""
    parent = here.parent
    if isinstance(parent, ast.BinOp) and isinstance(parent.op, ast.MatMult):
        return
    every = chains.members(chains.chain(here.node, (ast.MatMult,)))
    if len(every) > _PAIR:
        orders = [[*every[k:], *every[:k]] for k in range(1, len(every))]
        for k, to in permutations(range(len(every)), _PAIR):
            if 1 < abs(k - to) < len(every) - 1:  # others are of those above
                rest = [*every[:k], *every[k + 1 :]]
                orders.append([*rest[:to], every[k], *rest[to:]])
        for first, *others in (*orders, every[::-1]):
            by = [(ast.MatMult(), one) for one in others]
            yield here.instead(chains.joined(first, by), "order", 1.1)


def _turned(here: Here) -> Iterator[ProgramEdit]:
    """R I R.T for R.T I R."""
    parent = here.parent
    if (
        isinstance(parent, ast.BinOp)
        and isinstance(parent.op, ast.MatMult)
        and here.field == "left"
    ):
        return
    every = chains.members(chains.chain(here.node, (ast.MatMult,)))
    for k in range(len(every) - _PAIR):
        first, last = every[k], every[k + _PAIR]
        if f"{ast.unparse(first)}.T" == ast.unparse(last) or _is_turned_into(last, first):
            new = [*every[:k], last, every[k + 1], first, *every[k + _THREE :]]
            by = [(ast.MatMult(), other) for other in new[1:]]
            yield here.instead(chains.joined(new[0], by), "transposed", 1.03)


def _is_turned_into(one: ast.expr, other: ast.expr) -> bool:
    """Whether one of two matrices is the transpose of the first."""
    return f"{ast.unparse(one)}.T" == ast.unparse(other)


def is_diagonal(here: Here) -> bool:
    """Whether an argument is the number of a diagonal."""
    call = here.parent
    if not isinstance(call, ast.Call) or called(call) not in _DIAGONALS or len(call.args) < _PAIR:
        return False
    return here.node is call.args[-1]


def of_call(here: Here, scope: Scope, observed: Observed) -> Iterator[ProgramEdit]:
    node = here.node
    name = called(node)
    if name in ANGLES:
        for other in ANGLES:
            if other != name:
                cost = 1.0 if {other, name} == {"sin", "cos"} else 1.5
                if isinstance(node.func, ast.Attribute):
                    yield here.within(node.func, "attr", other, "sin/cos", cost)
                else:
                    new = ast.Name(other, ast.Load())
                    yield here.within(node, "func", new, "sin/cos", cost)
        if node.args:
            argument = ast.unparse(node.args[0])
            for text, angle in scope.angles.items():
                if text != argument:  # what is odd among others is rather meant as they are
                    odd = scope.taken[argument] == 1 < scope.taken[text] + 1
                    yield here.within(node.args, 0, angle, "argument", 1.08 if odd else 1.15)
    if scope.crosses(node):
        for factor in node.args:
            yield here.instead(factor, "extra factor", 1.1)
    if name in _DIAGONALS and len(node.args) > 1:
        diagonal = getattr(node.args[-1], "operand", node.args[-1])
        for k in (0, 1, -1) if whole_constant(diagonal) else ():
            cost = _DIAGONAL + _APART * bool(k)
            yield here.within(node.args, len(node.args) - 1, number(k), "index", cost)
    if name == "range":
        yield from _range(here, scope)
    for word in node.keywords:
        if (
            word.arg == "axis"
            and isinstance(word.value, ast.Constant)
            and word.value.value in (0, 1)
        ):
            yield here.within(word, "value", number(1 - word.value.value), "index", 1.08)
    if name == "zip" and len(cut := {_cut(one) for one in node.args}) == 1 and cut != {""}:
        wholes = [getattr(one, "value", one) for one in node.args]
        yield here.within(node, "args", wholes, "loop", 1.08)
    yield from _other_function(here, name)
    if isinstance(node.func, ast.Attribute) and name in ("append", "insert") and node.args:
        first = [ast.Constant(0)] if name == "append" else []
        method = ast.Attribute(node.func.value, "insert" if first else "append", ast.Load())
        yield here.instead(ast.Call(method, [*first, node.args[-1]], []), "order", 1.12)
    if isinstance(node.func, ast.Name):
        for other, count in scope.functions.items():
            if other != name and count == len(node.args) and count == scope.functions.get(name):
                yield here.within(node, "func", ast.Name(other, ast.Load()), "function", 1.1)
        if scope.functions.get(name, 0) == len(node.args) + 1 and not node.keywords:
            for given in scope.shapes:  # the last one has a default
                if given not in scope.counters:
                    args = [*node.args, ast.Name(given, ast.Load())]
                    yield here.within(node, "args", args, "missing argument", 1.15)
    if name == "diag" and (observed.shape(node) or ())[1:] == ():
        yield here.instead(ast.Call(node.func, [node], []), "function", 1.1)
    plain = [a for a in node.args if not isinstance(a, ast.Starred)]
    if len(plain) == len(node.args):
        for i, j in combinations(range(len(plain)), 2):
            if j > i + 1 and len(plain) > _ARGUMENTS:
                continue
            swapped = [*plain]
            swapped[i], swapped[j] = swapped[j], swapped[i]
            cost = 1.02 if scope.crosses(node) else 1.05 if name in _ORDERED else 1.15
            yield here.within(node, "args", swapped, "order", cost + _APART * (j > i + 1))
        if name in ("arctan2", "atan2") and len(plain) == 2:
            for one in (0, 1):  # the angle from the other axis
                turned = [plain[1], plain[0]]
                turned[one] = ast.UnaryOp(ast.USub(), turned[one])
                yield here.within(node, "args", turned, "order", 1.12)
        if len(plain) == 1 and observed.shape(plain[0]) is not None and name not in ANGLES:
            yield here.instead(plain[0], "extra factor", 1.25)
        if name == "inv" and observed.shape(plain[0]) is not None:
            yield here.instead(ast.Attribute(plain[0], "T", ast.Load()), "inverse", 1.15)
        if name == "solve" and len(plain) == 2:
            product = ast.BinOp(plain[0], ast.MatMult(), plain[1])
            yield here.instead(product, "inverse", 1.25)


_FAMILIES = (
    ("zeros", "ones"),
    ("array", "asarray", "cumsum"),
    ("sum", "cumsum", "prod"),
    ("dot", "cross", "outer", "multiply"),
    ("arcsin", "arccos", "arctan"),
    ("asin", "acos", "atan"),
    ("hstack", "vstack", "column_stack"),
    ("tril", "triu"),
    ("radians", "degrees"),
    ("deg2rad", "rad2deg"),
    ("inv", "pinv"),
    ("min", "max"),
    ("sqrt", "square"),
)
"""Functions of which one is written for another."""


def _cut(node: ast.expr) -> str:
    """The part of a row that is taken, as it is written; empty of all of it."""
    cut = isinstance(node, ast.Subscript) and isinstance(node.slice, ast.Slice)
    return ast.unparse(node.slice) if cut and isinstance(node, ast.Subscript) else ""


def _is_typed_in(node: ast.expr) -> bool:
    """Whether nothing but numbers stand there."""
    plain = ast.List | ast.Tuple | ast.Constant | ast.UnaryOp | ast.unaryop | ast.expr_context
    return all(isinstance(one, plain) for one in nodes(node))


def _other_function(here: Here, name: str) -> Iterator[ProgramEdit]:
    node = here.node
    for family in _FAMILIES:
        for other in family:
            if other == "cumsum" and node.args and _is_typed_in(node.args[0]):
                continue  # numbers are rather wrong themselves
            if name in family and other != name and isinstance(node.func, ast.Attribute):
                yield here.within(node.func, "attr", other, "function", 1.14)
    if name in ("ones", "zeros", "full") and isinstance(node.func, ast.Attribute) and node.args:
        first = node.args[0]
        size = first.elts[0] if isinstance(first, ast.Tuple) and first.elts else first
        eye = ast.Call(ast.Attribute(node.func.value, "eye", ast.Load()), [size], [])
        yield here.instead(eye, "function", 1.14)
    if name in ("eye", "identity") and isinstance(node.func, ast.Attribute) and node.args:
        shape = ast.Tuple([node.args[0], node.args[0]], ast.Load())
        for other in ("ones", "zeros"):
            filled = ast.Call(ast.Attribute(node.func.value, other, ast.Load()), [shape], [])
            yield here.instead(filled, "function", 1.2)


def _range(here: Here, scope: Scope) -> Iterator[ProgramEdit]:
    node = here.node
    args = node.args
    for k, argument in enumerate(args):
        for step in (1, -1):
            new = [*args]
            new[k] = plus(argument, step)
            yield here.within(node, "args", new, "loop", 1.1)
    if isinstance(here.parent, ast.For):
        yield from _other_way(here)
    for others in scope.ranges:
        if ast.dump(others) != ast.dump(node):
            yield here.within(node, "args", [*others.args], "loop", 1.12)
    inner = scope.counters
    loops = [one for one in here.above if isinstance(one, ast.For) and one.iter is not node]
    around = {name for one in loops for name in names(one.target)}
    if len(args) == 1:
        for name in inner:
            load, cost = ast.Name(name, ast.Load()), 1.13 if name in around else 1.2
            for new in ([load], [plus(load, 1)], [load, args[0]], [plus(load, 1), args[0]]):
                yield here.within(node, "args", new, "loop", cost)
        yield here.within(node, "args", [ast.Constant(1), args[0]], "loop", 1.2)
    else:
        yield here.within(node, "args", [args[1]], "loop", 1.25)
        for name in inner:
            load = ast.Name(name, ast.Load())
            yield here.within(node, "args", [load, *args[1:]], "loop", 1.25)
            yield here.within(node, "args", [plus(load, 1), *args[1:]], "loop", 1.25)


def _other_way(here: Here) -> Iterator[ProgramEdit]:
    """A loop from the last to the first, or from the first to the last."""
    args = here.node.args
    first, last = (args[0], args[1]) if len(args) > 1 else (number(0), args[0])
    if len(args) == 3 and ast.unparse(args[2]) == "-1":
        forward = [plus(last, 1), plus(first, 1)]
        forward = forward[1:] if ast.unparse(forward[0]) == "0" else forward
        yield here.within(here.node, "args", forward, "direction", 1.1)
    elif len(args) < 3:
        back = [plus(last, -1), plus(first, -1), number(-1)]
        yield here.within(here.node, "args", back, "direction", 1.1)


def of_subscript(here: Here, scope: Scope, observed: Observed) -> Iterator[ProgramEdit]:
    node = here.node
    shape = observed.shape(node.value)
    if isinstance(node.slice, ast.Constant) and isinstance(node.slice.value, str):
        yield from _of_key(here, node.slice, scope)
        return
    if _is_stacked(node):
        if isinstance(node.slice, ast.Tuple) and len(node.slice.elts) <= _LONGEST:
            yield from _swapped(here, node.slice, observed)
        return
    keys = keys_of(node)
    if isinstance(node.slice, ast.Slice) and isinstance(node.ctx, ast.Load):
        yield here.instead(node.value, "index", 1.1)
    yield from of_keys(here, node, 1.1)
    yield from _other_slices(here)
    yield from _in_another_order(here)
    for name in sorted(scope.unused) if isinstance(node.ctx, ast.Load) else ():
        if scope.shapes.get(name) == observed.shape(node):
            yield here.instead(ast.Name(name, ast.Load()), "name", 1.05)
    beside = _keys_beside(here)
    for k, (holder, field, key) in enumerate(keys):
        size = shape[k] if shape is not None and k < len(shape) else 0
        if whole_constant(key):
            for other in range(-1, max(size, 4 if not size else 0)):
                if other != value_of(key) and not (other == -1 and size):
                    near = abs(other - value_of(key)) == 1
                    yield here.within(holder, field, number(other), "index", 1.05 if near else 1.1)
            for name in scope.counters:
                cost = _BESIDE if name in beside else 1.13
                yield here.within(holder, field, ast.Name(name, ast.Load()), "index", cost)
        elif not isinstance(key, ast.Constant | ast.Slice):
            for text, index in beside.items():
                if text not in _near(key):
                    yield here.within(holder, field, copied(index), "index", 1.08)
    _holder, _field, key = keys[0]
    single = len(keys) == 1 and not isinstance(node.slice, ast.Tuple)
    if single and shape is not None and len(shape) == 2 and not isinstance(key, ast.Slice):
        column = ast.Tuple([ast.Slice(None, None, None), key], ast.Load())
        yield here.within(node, "slice", column, "transposed", 1.15)


def _other_slices(here: Here) -> Iterator[ProgramEdit]:
    """The part of a row that is taken of another one in the same line."""
    line = next(one for one in reversed(here.above) if isinstance(one, ast.stmt))
    known = {ast.dump(one): one for one in nodes(line) if isinstance(one, ast.Slice)}
    for holder, field, key in keys_of(here.node):
        for text, other in known.items() if isinstance(key, ast.Slice) else ():
            if text != ast.dump(key):
                yield here.within(holder, field, copied(other), "index", 1.09)


def _keys_beside(here: Here) -> dict[str, ast.expr]:
    """The indices that rows have in the same line, and that are counted: ``i``, ``j + 1``."""
    line = nodes(statement_of(here.above))
    rows = [one for one in line if isinstance(one, ast.Subscript) and not _is_stacked(one)]
    keys = [key for one in rows for _holder, _field, key in keys_of(one)]
    return {ast.unparse(one): one for one in keys if isinstance(one, ast.Name) or shifted(one)}


def _is_stacked(node: ast.Subscript) -> bool:
    """Whether it is ``np.r_[a, b]``, whose entries are no indices."""
    return getattr(node.value, "attr", "") in ("r_", "c_")


def _near(key: ast.expr) -> set[str]:
    """What is tried in place of an index all the same: itself, one more, one less."""
    return {ast.unparse(one) for one in (key, plus(key, 1), plus(key, -1))}


def _in_another_order(here: Here) -> Iterator[ProgramEdit]:
    """The indices of ``D[k][i, j]``, and of ``D[k][i][j]``, in another order."""
    chain = [here.node]
    while isinstance(chain[0].value, ast.Subscript):
        chain.insert(0, chain[0].value)
    if len(chain) < 2 or isinstance(here.parent, ast.Subscript):
        return
    keys = [key for one in chain for _holder, _field, key in keys_of(one)]
    plain = all(isinstance(key, ast.Name) or whole_constant(key) for key in keys)
    if not plain or len(keys) > _THREE:
        return
    for order in [*permutations(keys)][1:]:
        if [*map(ast.dump, order)] != [*map(ast.dump, keys)]:
            new, left = chain[0].value, [*order]
            for one in chain:
                count = len(keys_of(one))
                new, left = ast.Subscript(new, _key(left[:count]), one.ctx), left[count:]
            yield here.instead(new, "index", 1.12)


def _key(keys: Sequence[ast.expr]) -> ast.expr:
    return keys[0] if len(keys) == 1 else ast.Tuple([*keys], ast.Load())


def _of_key(here: Here, key: ast.Constant, scope: Scope) -> Iterator[ProgramEdit]:
    """Another key of a dictionary: ``arm["r"]`` for ``arm["l"]``."""
    own, cost = str(key.value), 1.05 if len(scope.keys) <= _FEW else 1.15
    for other, shape in scope.keys.items():
        if other != own and shape == scope.keys.get(own):
            yield here.within(key, "value", other, "name", cost)


def keys_of(node: ast.Subscript) -> list[tuple[Any, Any, ast.expr]]:
    """The indices of an entry, each with where it hangs."""
    if isinstance(node.slice, ast.Tuple):
        return [(node.slice.elts, k, key) for k, key in enumerate(node.slice.elts)]
    return [(node, "slice", node.slice)]


def _moved(here: Here, holder: Any, field: Any, key: ast.Slice) -> Iterator[ProgramEdit]:
    """All but the first for all but the last, and the other way round."""
    if key.upper is None and key.lower is not None and ast.unparse(key.lower) == "1":
        yield here.within(holder, field, ast.Slice(None, number(-1), None), "index", 1.08)
    elif key.lower is None and key.upper is not None and ast.unparse(key.upper) == "-1":
        yield here.within(holder, field, ast.Slice(number(1), None, None), "index", 1.08)


def _beside(key: ast.Slice) -> ast.Slice | None:
    """As many rows above, or below the first ones: ``0:3`` for ``3:6``."""
    if key.lower is None or key.upper is None:
        return None
    if not whole_constant(key.lower) or not whole_constant(key.upper):
        return None
    first, behind = value_of(key.lower), value_of(key.upper)
    other = behind if first == 0 else 2 * first - behind
    return ast.Slice(number(other), number(other + behind - first), None) if other >= 0 else None


def of_keys(here: Here, node: ast.Subscript, cost: float) -> Iterator[ProgramEdit]:
    """Other rows, and indices in another order: of what is read, or where a value is put."""
    for holder, field, key in keys_of(node):
        if isinstance(key, ast.Slice) and key.step is None:
            if key.lower is None and key.upper is not None:
                yield here.within(holder, field, ast.Slice(key.upper, None, None), "rows", cost)
            elif key.upper is None and key.lower is not None:
                yield here.within(holder, field, ast.Slice(None, key.lower, None), "rows", cost)
            elif (moved := _beside(key)) is not None:
                yield here.within(holder, field, moved, "rows", cost)
            ends = (key.lower, key.upper)
            yield from _moved(here, holder, field, key)
            if ends[0] is None and ends[1] is not None and shifted(ends[1]):
                above = ast.Slice(plus(ends[1], -1), None, None)
                yield here.within(holder, field, above, "index", 1.15)
            elif ends[1] is None and isinstance(ends[0], ast.Name):
                below = ast.Slice(None, plus(ends[0], 1), None)
                yield here.within(holder, field, below, "index", 1.15)
    keys = node.slice.elts if isinstance(node.slice, ast.Tuple) else []
    if len(keys) == 2:
        swapped = ast.Tuple([keys[1], keys[0]], ast.Load())
        yield here.within(node, "slice", swapped, "transposed", cost)
    if len(keys) == _THREE and len({ast.dump(key) for key in keys}) > 1:
        for order in [*permutations(range(_THREE))][1:]:
            other = ast.Tuple([keys[k] for k in order], ast.Load())
            if ast.dump(other) != ast.dump(node.slice):
                yield here.within(node, "slice", other, "index", 1.12)


def of_name(here: Here, scope: Scope, observed: Observed, index: bool) -> Iterator[ProgramEdit]:
    node = here.node
    shape = observed.shape(node)
    if shape is None:
        return
    if index:
        for other in scope.whole:
            if other != node.id:
                yield here.instead(ast.Name(other, ast.Load()), "index", 1.12)
        return
    if node.id in scope.arcs and scope.has_numpy:
        yield here.instead(ast.BinOp(PI, ast.Sub(), node), "argument", 1.12)
    across = Turned(scope.shapes).visit_Name(node).id
    for other, known in scope.shapes.items():
        if other != node.id and known == shape and other not in scope.counters:
            near = _alike(other, node.id)
            kind = "index" if near and _letters(other) == _letters(node.id) else "name"
            beside = other in scope.beside.get(node.id, ())
            cost = 1.1 if near else 1.14 if beside else 1.25
            if cost > _IN_LINE and other in scope.names_in(statement_of(here.above)):
                cost = _IN_LINE  # of what stands in one line one is taken for another
            if scope.are_halves(other, node.id):
                cost = _HALF + _OF_ROD * _in_a_rods_moment(here)
                cost -= _OF_ITS_MASS * _is_of_the_mass(here, other)
            if other == across and {other, node.id} <= scope.sines:
                kind, cost = "sin/cos", 1.04
            yield here.instead(ast.Name(other, ast.Load()), kind, cost)
    if shape and not isinstance(here.parent, ast.Subscript | ast.Attribute):
        for text, entry in scope.simple(shape):  # an entry of a list by a counter
            if isinstance(entry, ast.Subscript) and text != node.id:
                yield here.instead(entry, "name", 1.2)
    if isinstance(here.parent, ast.Subscript) and here.field == "value" and shape:
        for other, entries in scope.lists.items():
            if other != node.id and entries == shape[1:] and scope.shapes.get(other) != shape:
                cost = 1.15 if _alike(other, node.id) else 1.2
                yield here.instead(ast.Name(other, ast.Load()), "name", cost)


def _is_of_the_mass(here: Here, name: str) -> bool:
    """Whether a name has the number of a mass that it is multiplied with: ``m2*l1*lc2``."""
    product: ast.expr = here.node
    for above in reversed(here.above):
        if not isinstance(above, ast.BinOp) or not isinstance(above.op, ast.Mult):
            break
        product = above
    parts = (x.operand if isinstance(x, ast.UnaryOp) else x for x in factors(product))
    masses = (x.id for x in parts if isinstance(x, ast.Name) and x.id[0] in "mM")
    own = name[len(_letters(name)) :]
    return own != "" and any(one[len(_letters(one)) :] == own for one in masses)


def _in_a_rods_moment(here: Here) -> bool:
    """Whether it stands in ``m*l**2/12`` or in ``m*l**2/3``."""
    divided = (one for one in here.above if isinstance(one, ast.BinOp))
    below = (one.right for one in divided if isinstance(one.op, ast.Div))
    return any(isinstance(one, ast.Constant) and one.value in _OF_RODS for one in below)


def _letters(name: str) -> str:
    return name.rstrip("0123456789")


def _alike(one: str, other: str) -> bool:
    """Names that are easily mistaken: of one first letter, or of one number."""
    same = one[0].lower() == other[0].lower() or _letters(one)[-1:] == _letters(other)[-1:]
    return same or one[len(_letters(one)) :] == other[len(_letters(other)) :] != ""


def of_attribute(here: Here, scope: Scope, observed: Observed) -> Iterator[ProgramEdit]:
    """Another attribute of the same object: ``arm.r`` for ``arm.l``."""
    node = here.node
    shape = observed.shape(node)
    if shape is None:
        return
    for one, other in (("real", "imag"), ("imag", "real")):
        if node.attr == one:
            yield here.within(node, "attr", other, "function", 1.05)
    if not isinstance(node.value, ast.Name | ast.Subscript | ast.Attribute):
        return
    product = isinstance(getattr(here.parent, "op", None), ast.MatMult)
    for other, known in scope.attributes.items():
        if other != node.attr and known == shape:
            cost = 1.07 if _alike(other, node.attr) else 1.15
            cost = 1.05 if len(scope.attributes) <= _FEW else cost
            yield here.within(node, "attr", other, "name", cost)
        elif other != node.attr and product:
            yield here.within(node, "attr", other, "name", 1.15)
    for _text, piece in scope.simple(shape):
        if isinstance(piece, ast.Attribute) and ast.dump(piece.value) != ast.dump(node.value):
            cost = 1.12 if piece.attr == node.attr else 1.15  # of another object
            yield here.instead(piece, "name", cost)
    for other, known in scope.shapes.items():
        if known == shape and other not in scope.counters and shape == ():
            cost = 1.2 if other[:1].lower() == node.attr[:1].lower() else 1.25
            yield here.instead(ast.Name(other, ast.Load()), "name", cost)


def of_constant(here: Here, index: bool, scope: Scope) -> Iterator[ProgramEdit]:
    value = here.node.value
    if isinstance(value, bool) or not isinstance(value, int | float):
        return
    if isinstance(here.parent, ast.Call) and called(here.parent) not in SIZES and value:
        yield here.within(here.node, "value", 0, "number", 1.12)
    if index:
        if isinstance(here.parent, ast.Slice):
            for step in (1, -1):
                yield here.within(here.node, "value", value + step, "index", 1.15)
        return
    given = here.parent if isinstance(here.parent, ast.Call) else None
    own = given is not None and isinstance(given.func, ast.Name)
    own = own and given is not None and called(given) not in (*SIZES, *ANGLES)
    if value == 0 and scope.has_numpy and (own or measured(here.parent)):
        half: ast.expr = ast.BinOp(PI, ast.Div(), number(2))
        for turned in (half, ast.UnaryOp(ast.USub(), half)):
            yield here.instead(turned, "number", 1.13)
    if (
        isinstance(value, int)
        and value in _OF_RODS
        and isinstance(getattr(here.parent, "op", None), ast.Div)
    ):
        yield here.within(here.node, "value", _OF_RODS[value], "number", 1.05)
    if given is not None and called(given) == "append" and value in (0, 1):
        yield here.within(here.node, "value", type(value)(1 - value), "number", 1.05)
    for factor in (2, 0.5, 3, 1 / 3, 4, 0.25):
        new = value * factor
        new = int(new) if new == int(new) else new
        yield here.within(here.node, "value", new, "factor", 1.15)
    if isinstance(value, int) or value in (0.0, 1.0):
        for new in (value + 1, value - 1):
            power = isinstance(here.parent, ast.BinOp) and isinstance(here.parent.op, ast.Pow)
            kind = "power" if power else "number"
            cost = _POWER if power else 1.18
            if power and isinstance(getattr(here.parent, "left", None), ast.Constant):
                cost = _OF_A_NUMBER
            if not power or new != 1:  # what has none is typed without
                yield here.within(here.node, "value", new, kind, cost)


def of_sequence(here: Here, observed: Observed) -> Iterator[ProgramEdit]:
    elements = here.node.elts
    if any(isinstance(e, ast.Starred) for e in elements) or len(elements) > _LONGEST:
        return
    if isinstance(here.parent, ast.Subscript) and here.field == "slice":
        return
    yield from _swapped(here, here.node, observed)
    yield from _across(here, elements)
    yield from _between(here, elements)
    yield from _signs_of_two(here, elements)
    turned = [_opposite(one) for one in elements]
    if sum(one is not old for one, old in zip(turned, elements, strict=True)) >= _PAIR:
        unpacked = isinstance(here.node, ast.Tuple) and isinstance(here.parent, ast.Assign)
        yield here.within(here.node, "elts", turned, "sign", 1.25 if unpacked else 1.1)
    if len(elements) > _PAIR and all(isinstance(one, _NUMBERS) for one in elements):
        for moved in moved_on(elements):
            yield here.within(here.node, "elts", moved, "shifted", 1.13)
    points = [one for one in elements if isinstance(one, ast.Name) and observed.shape(one) == (3,)]
    if len(points) == len(elements) > _PAIR:  # those of the frames before, of which one is the base
        base: ast.expr = ast.parse("np.zeros(3)", mode="eval").body
        yield here.within(here.node, "elts", [base, *elements[:-1]], "shifted", 1.13)


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


def _signs_of_two(here: Here, rows: Sequence[ast.expr]) -> Iterator[ProgramEdit]:
    """Two rows or columns of a rotation matrix with the other sign: a frame is turned over."""
    entries = [one.elts for one in rows if isinstance(one, ast.List | ast.Tuple)]
    if len(entries) != len(rows) or {len(rows), *map(len, entries)} != {_THREE}:
        return
    for some in combinations(range(_THREE), 2):
        for columns in (False, True):
            turned = [
                ast.List([_opposite(x) if (k if columns else i) in some else x
                          for k, x in enumerate(row)], ast.Load())
                for i, row in enumerate(entries)
            ]  # fmt: skip
            yield here.within(here.node, "elts", turned, "sign", 1.15)


def _across(here: Here, rows: Sequence[ast.expr]) -> Iterator[ProgramEdit]:
    """What is written as rows, with columns for rows."""
    entries = [one.elts for one in rows if isinstance(one, ast.List | ast.Tuple)]
    if len(entries) == len(rows) > 1 and all(len(one) == len(rows) for one in entries):
        columns = [ast.List([*one], ast.Load()) for one in zip(*entries, strict=True)]
        if ast.dump(ast.List([*columns])) != ast.dump(ast.List([*rows])):
            cost = 1.12 if len(rows) == _PAIR else 1.3
            yield here.within(here.node, "elts", columns, "transposed", cost)


def _opposite(node: ast.expr) -> ast.expr:
    """A number with the other sign; a zero, and what is no single number, as it is."""
    if isinstance(node, ast.UnaryOp):
        return node.operand if isinstance(node.op, ast.USub) else node
    if isinstance(node, ast.List | ast.Tuple) or not getattr(node, "value", 1):
        return node
    return ast.UnaryOp(ast.USub(), node)


def _swapped(here: Here, row: ast.List | ast.Tuple, observed: Observed) -> Iterator[ProgramEdit]:
    """Two entries for one another."""
    halves = _are_halves(row, observed)
    for i, j in combinations(range(len(row.elts)), 2):
        if ast.dump(row.elts[i]) != ast.dump(row.elts[j]):
            swapped = [*row.elts]
            swapped[i], swapped[j] = swapped[j], swapped[i]
            moved = j == _PLACE and getattr(row.elts[j], "value", None) == 1
            cost = 1.12 + _FLAT * moved  # of what is a place, and no direction
            cost = _HALVED if halves else cost
            yield here.within(row, "elts", swapped, "entries swapped", cost)


def _are_halves(row: ast.List | ast.Tuple, observed: Observed) -> bool:
    """Whether two vectors stand one behind the other: a twist, the angular half and the linear."""
    shapes = [observed.shape(one) for one in row.elts]
    return len(shapes) == _PAIR and shapes[0] == shapes[1] and len(shapes[0] or ()) == 1


def of_letters(here: Here) -> Iterator[ProgramEdit]:
    """The kinds of joints in the order of a word, ``"RRPR"``: two for one another, or one other."""
    for word, kind, cost in other_words(here.node.value):
        yield here.within(here.node, "value", word, kind, cost)


def of_comparison(here: Here) -> Iterator[ProgramEdit]:
    node = here.node
    if len(node.ops) != 1:
        return
    pairs = {ast.Lt: ast.LtE, ast.LtE: ast.Lt, ast.Gt: ast.GtE, ast.GtE: ast.Gt}
    other = pairs.get(type(node.ops[0]))
    if other is not None:
        yield here.within(node, "ops", [other()], "condition", 1.15)
    if isinstance(node.ops[0], ast.Eq | ast.NotEq | ast.Lt | ast.Gt):
        opposite = {ast.Eq: ast.NotEq, ast.NotEq: ast.Eq, ast.Lt: ast.Gt, ast.Gt: ast.Lt}
        new = opposite[type(node.ops[0])]()
        yield here.within(node, "ops", [new], "condition", 1.2)
    if isinstance(node.ops[0], ast.Eq | ast.LtE | ast.GtE):
        for new in (ast.Eq(), ast.LtE(), ast.GtE()):
            if type(new) is not type(node.ops[0]):
                yield here.within(node, "ops", [new], "condition", 1.12)


def of_comparisons(here: Here) -> Iterator[ProgramEdit]:
    """All comparisons of a condition otherwise, or ``and`` for ``or``."""
    node = here.node
    other = ast.Or() if isinstance(node.op, ast.And) else ast.And()
    yield here.within(node, "op", other, "condition", 1.15)
    own = [one for one in node.values if isinstance(one, ast.Compare) and len(one.ops) == 1]
    kinds = {type(one.ops[0]) for one in own}
    if len(own) == len(node.values) and len(kinds) == 1:
        for new in (ast.Eq(), ast.LtE(), ast.GtE(), ast.Lt(), ast.Gt()):
            if type(new) not in kinds:
                values = [ast.Compare(one.left, [new], one.comparators) for one in own]
                yield here.within(node, "values", values, "condition", 1.08)


# -------- Small trees


def plus(node: ast.expr, step: int) -> ast.expr:
    """A whole number more: ``i + 1`` of ``i``, and ``i`` of ``i - 1``."""
    if isinstance(node, ast.Constant) and isinstance(node.value, int):
        return number(node.value + step)
    if isinstance(node, ast.BinOp) and shifted(node) and whole_constant(node.right):
        sign = 1 if isinstance(node.op, ast.Add) else -1
        total = sign * value_of(node.right) + step
        return node.left if total == 0 else plus(node.left, total)
    return ast.BinOp(node, ast.Add() if step > 0 else ast.Sub(), number(abs(step)))


_OPPOSITE: dict[type[ast.cmpop], type[ast.cmpop]] = {
    ast.Eq: ast.NotEq,
    ast.NotEq: ast.Eq,
    ast.Lt: ast.GtE,
    ast.GtE: ast.Lt,
    ast.Gt: ast.LtE,
    ast.LtE: ast.Gt,
    ast.In: ast.NotIn,
    ast.NotIn: ast.In,
    ast.Is: ast.IsNot,
    ast.IsNot: ast.Is,
}


def negated(test: ast.expr) -> ast.expr:
    """The opposite condition."""
    if isinstance(test, ast.Compare) and len(test.ops) == 1 and type(test.ops[0]) in _OPPOSITE:
        return ast.Compare(test.left, [_OPPOSITE[type(test.ops[0])]()], test.comparators)
    return ast.UnaryOp(ast.Not(), test)


def whole_constant(node: ast.AST) -> bool:
    """Whether a node is a whole number as it is written."""
    inner = node.operand if isinstance(node, ast.UnaryOp) else node
    return isinstance(inner, ast.Constant) and type(inner.value) is int


def value_of(node: ast.expr) -> int:
    """A whole number as it is written."""
    return int(ast.literal_eval(node))


def shifted(node: ast.expr) -> bool:
    """Whether a number is added to something."""
    return (
        isinstance(node, ast.BinOp)
        and isinstance(node.op, ast.Add | ast.Sub)
        and isinstance(node.right, ast.Constant)
    )
