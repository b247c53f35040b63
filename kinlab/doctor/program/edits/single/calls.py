"""Calls of a program otherwise: another function, other arguments, loops from elsewhere."""

from __future__ import annotations

import ast
from collections.abc import Iterator, Sequence
from itertools import combinations, permutations
from types import FunctionType

from kinlab.doctor.bytecode.syntax import called, names, nodes, pieces, text_of
from kinlab.doctor.program.edits import chains
from kinlab.doctor.program.edits.scope.part import Scope
from kinlab.doctor.program.edits.single.operators import DIAGONALS
from kinlab.doctor.program.edits.single.whole import plus, whole_constant
from kinlab.doctor.program.observed import Observed
from kinlab.doctor.program.places import (
    ANGLES,
    Here,
    ProgramEdit,
    called_with,
    number,
    root,
)

_AXES = 2
"""Axes of an array of which another may be meant, at least."""
_ORDERED = ("cross", "dot", "arctan2", "atan2", "outer", "solve", "matmul", "subtract", "array")
_PRODUCT = 1.05
"""Cost of a product of matrices the other way about."""
_BEHIND = 1.02
"""Cost of a list without its first, beside one that is so much shorter."""
_OF_THE_PART, _UNCALLED = 1.1, 1.02
"""Cost of another function of the part's own, less of one that nothing calls."""
_DIAGONAL = 1.02
"""Cost of the main diagonal for another."""
_ARGUMENTS, _APART = 4, 0.03
"""The same of arguments; what it costs more of those that do not stand side by side."""
_CONJUGATES, _CONJUGATE = ("conj", "conjugate"), 1.04
"""Functions that conjugate, and the cost of one that spoils a complex step."""
_AXES_OF_THREE, _ORDER = (0, 1, 2), 1.06
"""The axes of Christoffel's symbols, and the cost of another order."""
_WORD = 1.04
"""Cost of another word of a call."""
_ARCS = ("arcsin", "asin", "arccos", "acos")
"""Functions that do not tell the quadrant."""
_BACKWARDS = 0.97
"""Cost of the other order of a cross product that is the other way about than all write it."""
_TWISTS, _OF_FORCES = (6, 6), 1.08
"""Shape of what twists are crossed with, and the cost of that for what forces are."""
_LOADS = ("f", "F")
"""How names of forces begin, whose lever stands in front of them."""
_LED = 1.01
"""Cost of a difference the other way, which an axis or a rate is crossed with."""
_QUADRANT = 0.99
"""Cost of the angle of two sides for that of their quotient."""
_FEWER = 1.12
"""Cost of another function of the program's own that asks for less."""
_ALIASED = 1.0
"""Cost of a copy of what is changed in place."""
_TRIANGLES, _TRIANGLE = ("tril", "triu"), 0.98
"""Functions that take one triangle each, and the cost of one for the other."""
_OF_A_FAMILY = 1.14
"""Cost of another function of a family."""
_FAMILIES = (
    ("zeros", "ones"),
    ("array", "asarray", "cumsum"),
    ("sum", "cumsum", "prod"),
    ("dot", "cross", "outer", "multiply"),
    ("arcsin", "arccos", "arctan"),
    ("asin", "acos", "atan"),
    ("hstack", "vstack", "column_stack"),
    _TRIANGLES,
    ("radians", "degrees"),
    ("deg2rad", "rad2deg"),
    ("inv", "pinv"),
    ("min", "max"),
    ("sqrt", "square"),
)
"""Functions of which one is written for another."""


_BEYOND = {"sin": False, "cos": True}
"""Functions that stand in ``1 - cos(t)`` and ``t - sin(t)``; whether 1 is what they are taken of.
"""
_OTHERS = 1.07
"""Cost of the links outward for those inward, or the other way round."""
_FARTHER = 1.12
"""Cost of a loop from the farther of two counters on: ``range(max(i, j), n)``."""
_SQUARE = 1.1
"""Cost of a square for what is always positive."""
_RODRIGUES = 1.09
"""Cost of what they are taken of, that is not there."""


def _is_multiplied(here: Here) -> bool:
    """Whether it is a factor."""
    return isinstance(here.parent, ast.BinOp) and isinstance(here.parent.op, ast.Mult)


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
    if name in _BEYOND and len(node.args) == 1 and _is_multiplied(here):
        begins = number(1) if _BEYOND[name] else node.args[0]
        rest = ast.BinOp(begins, ast.Sub(), node)
        yield here.instead(rest, "missing term", _RODRIGUES)  # of what a rotation is written with
    if name in ("abs", "fabs") and len(node.args) == 1:  # of a gear ratio
        squared = ast.BinOp(node.args[0], ast.Pow(), number(2))
        yield here.instead(squared, "power", _SQUARE)
    if isinstance(node.func, ast.Name) and name not in ANGLES:
        for other in _turned_alias(name, scope):
            yield here.within(node, "func", ast.Name(other, ast.Load()), "sin/cos", 1.0)
    if scope.crosses(node):
        inner = ast.Call(node.func, [node.args[0], node], [])  # w x (w x r) for w x r
        yield here.instead(inner, "missing factor", 1.1)
        for factor in node.args:
            yield here.instead(factor, "extra factor", 1.1)
    if name in DIAGONALS and len(node.args) > 1:
        diagonal = getattr(node.args[-1], "operand", node.args[-1])
        for k in (0, 1, -1) if whole_constant(diagonal) else ():
            cost = _DIAGONAL + _APART * bool(k)
            yield here.within(node.args, len(node.args) - 1, number(k), "index", cost)
    if name == "range":
        yield from _range(here, scope)
    if name in _CONJUGATES:
        of = [*node.args[:1], *([node.func.value] if isinstance(node.func, ast.Attribute) else [])]
        yield from (here.instead(one, "function", _CONJUGATE) for one in of[:1])
    if name == "transpose" and len(node.args) == len(_AXES_OF_THREE):
        yield from _other_axes(here)
    yield from _other_words(here, scope)
    for word in node.keywords:
        axes = range(max(_AXES, len(observed.shape(node) or ())))
        if word.arg == "axis" and getattr(word.value, "value", None) in axes:
            for axis in axes:
                if axis != getattr(word.value, "value", None):
                    yield here.within(word, "value", number(axis), "index", 1.08)
    if name == "zip" and len(cut := {_cut(one) for one in node.args}) == 1 and cut != {""}:
        wholes = [getattr(one, "value", one) for one in node.args]
        yield here.within(node, "args", wholes, "loop", 1.08)
    if name == "zip":
        yield from _behind_the_first(here, observed)
    yield from _other_function(here, name)
    if isinstance(node.func, ast.Name) and name not in scope.functions and name not in scope.space:
        yield from _other_of_the_part(here, name)
    if name == "list" and len(node.args) == 1 and scope.accumulating:
        yield from _accumulated(here, scope.accumulating)
    yield from _of_a_copy(here, scope, observed)
    if name in ("arctan", "atan") and len(node.args) == 1:
        yield from _of_both_sides(here, scope, name)
    if name in _ARCS and len(node.args) == 1:
        yield from _of_two(here, scope, name)
    if isinstance(node.func, ast.Attribute) and name in ("append", "insert") and node.args:
        first = [ast.Constant(0)] if name == "append" else []
        method = ast.Attribute(node.func.value, "insert" if first else "append", ast.Load())
        yield here.instead(ast.Call(method, [*first, node.args[-1]], []), "order", 1.12)
    if isinstance(node.func, ast.Name):
        uncalled = dict.fromkeys(scope.uncalled, 1)  # how many arguments they ask for
        for other, count in (scope.functions | uncalled).items():
            if other != name and count == len(node.args) and count == scope.functions.get(name):
                yield here.within(node, "func", ast.Name(other, ast.Load()), "function", 1.1)
            elif other != name and name in scope.functions and 0 < count < len(node.args):
                fewer = called_with(other, *node.args[:count])
                yield here.instead(fewer, "function", _FEWER)
        if scope.functions.get(name, 0) == len(node.args) + 1 and not node.keywords:
            for given in scope.shapes:  # the last one has a default
                if given not in scope.counters:
                    args = [*node.args, ast.Name(given, ast.Load())]
                    yield here.within(node, "args", args, "missing argument", 1.15)
    if isinstance(node.func, ast.Attribute) and isinstance(node.func.value, ast.Name):
        for other, count in scope.methods.items():
            if other != name and count == scope.methods.get(name):
                yield here.within(node.func, "attr", other, "function", 1.1)
    if name == "diag" and (observed.shape(node) or ())[1:] == ():
        yield here.instead(ast.Call(node.func, [node], []), "function", 1.1)
    if observed.shape(node) == _TWISTS and isinstance(
        getattr(here.parent, "op", None), ast.MatMult
    ):
        force = ast.UnaryOp(ast.USub(), ast.Attribute(node, "T", ast.Load()))
        yield here.instead(force, "transposed", _OF_FORCES)  # crm(v) for -crm(v).T
    plain = [a for a in node.args if not isinstance(a, ast.Starred)]
    if name == "dot" and len(node.args) == 1 and observed.shape(node.func.value):
        method = ast.Attribute(node.args[0], name, ast.Load())
        yield here.instead(ast.Call(method, [node.func.value], []), "order", _PRODUCT)
    if len(plain) == len(node.args):
        for i, j in combinations(range(len(plain)), 2):
            if j > i + 1 and len(plain) > _ARGUMENTS:
                continue
            swapped = [*plain]
            swapped[i], swapped[j] = swapped[j], swapped[i]
            less = isinstance(getattr(plain[1], "op", None), ast.Sub)
            load = text_of(plain[0]).startswith(_LOADS)
            if less and scope.crosses(node) and not isinstance(plain[0], ast.BinOp) and not load:
                turned = [plain[0], chains.opposite(plain[1])]
                yield here.within(node, "args", turned, "sign", _LED)
            cost = 1.02 if scope.crosses(node) else _PRODUCT if name in _ORDERED else 1.15
            cost = _BACKWARDS if scope.crosses(node) and _is_backwards(*plain[:2]) else cost
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


def _behind_the_first(here: Here, observed: Observed) -> Iterator[ProgramEdit]:
    """All but the first of what has one more than what it runs beside: ``list(poses)[1:]``."""
    args = here.node.args
    sizes = [(observed.shape(one) or (0,))[0] for one in args]
    for k, (one, size) in enumerate(zip(args, sizes, strict=True)):
        if size > 1 and size - 1 in sizes and not isinstance(one, ast.Subscript):
            behind = ast.Subscript(one, ast.Slice(number(1)), ast.Load())
            yield here.within(args, k, behind, "index", _BEHIND)


def _other_of_the_part(here: Here, name: str) -> Iterator[ProgramEdit]:
    """Another function that is defined where it is called: ``u(t)`` for ``n(t)``."""
    inner = nodes(here.above[0])
    made: dict[str, ast.arguments] = {}
    for one in inner:
        if isinstance(one, ast.FunctionDef):
            made[one.name] = one.args
        elif isinstance(one, ast.Assign) and isinstance(one.value, ast.Lambda):
            made |= {x.id: one.value.args for x in one.targets if isinstance(x, ast.Name)}
    used = {called(one) for one in inner if isinstance(one, ast.Call)}
    for other, args in made.items() if name in made else ():
        if other != name and len(args.args) == len(made[name].args):
            new = ast.Name(other, ast.Load())
            cost = _OF_THE_PART if other in used else _UNCALLED
            yield here.within(here.node, "func", new, "function", cost)


def _whole_arc(node: ast.Call, scope: Scope, name: str) -> ast.expr | None:
    """What tells the quadrant, as the program may call it; None where it cannot."""
    whole = "arctan2" if name.startswith("arc") else "atan2"
    if isinstance(node.func, ast.Attribute):
        return ast.Attribute(node.func.value, whole, ast.Load())
    return ast.Name(whole, ast.Load()) if callable(scope.space.get(whole)) else None


def _is_backwards(one: ast.expr, other: ast.expr) -> bool:
    """Whether it is ``cross(I @ w, w)``, or ``cross(cross(w, r), w)``."""
    simple = isinstance(other, ast.Name | ast.Attribute | ast.Subscript)
    made = isinstance(one, ast.Call | ast.BinOp) and not isinstance(
        getattr(one, "op", None), ast.Add | ast.Sub
    )
    return simple and made and text_of(other) in map(text_of, pieces(one))


def _of_both_sides(here: Here, scope: Scope, name: str) -> Iterator[ProgramEdit]:
    """The angle in its quadrant: ``arctan2(y, x)`` for ``arctan(y/x)``."""
    own, share = _whole_arc(here.node, scope, name), here.node.args[0]
    if own is not None and isinstance(share, ast.BinOp) and isinstance(share.op, ast.Div):
        new = ast.Call(own, [share.left, share.right], [])
        yield here.instead(new, "function", _QUADRANT)


def _turned_alias(name: str, scope: Scope) -> Iterator[str]:
    """The program's name for the cosine, of its name for the sine: ``C`` of ``S = np.sin``."""
    waves = {"sin": "cos", "cos": "sin"}
    own = getattr(scope.space.get(name), "__name__", "")
    for other, value in scope.space.items() if own in waves else ():
        if getattr(value, "__name__", "") == waves[own] and other not in waves:
            yield other


def _of_two(here: Here, scope: Scope, name: str) -> Iterator[ProgramEdit]:
    """The angle of both sine and cosine: ``atan2(s3, c3)`` for ``asin(s3)``."""
    node, own = here.node, _whole_arc(here.node, scope, name)
    if own is None:
        return
    for text, other in scope.simple(()):
        if text != ast.unparse(node.args[0]):
            both = [node.args[0], other] if "sin" in name else [other, node.args[0]]
            yield here.instead(ast.Call(own, both, []), "function", 1.1 + scope.dear(other))


def _cut(node: ast.expr) -> str:
    """The part of a row that is taken, as it is written; empty of all of it."""
    cut = isinstance(node, ast.Subscript) and isinstance(node.slice, ast.Slice)
    return ast.unparse(node.slice) if cut and isinstance(node, ast.Subscript) else ""


def _is_typed_in(node: ast.expr) -> bool:
    """Whether nothing but numbers stand there."""
    plain = ast.List | ast.Tuple | ast.Constant | ast.UnaryOp | ast.unaryop | ast.expr_context
    return all(isinstance(one, plain) for one in nodes(node))


def _other_axes(here: Here) -> Iterator[ProgramEdit]:
    """Another order of axes: ``dM.transpose(2, 0, 1)`` for ``dM.transpose(1, 2, 0)``."""
    own = tuple(getattr(one, "value", None) for one in here.node.args)
    for order in permutations(_AXES_OF_THREE):
        if {*own} == {*order} and order != own:
            yield here.within(here.node, "args", [number(k) for k in order], "index", _ORDER)


def _other_words(here: Here, scope: Scope) -> Iterator[ProgramEdit]:
    """A word of a call that gives another argument: ``xz=0.001`` for ``xy=0.001``."""
    node = here.node
    own = scope.space.get(node.func.id) if isinstance(node.func, ast.Name) else None
    if not isinstance(own, FunctionType):
        return
    code, given = own.__code__, {word.arg for word in node.keywords}
    left = code.co_varnames[len(node.args) : code.co_argcount + code.co_kwonlyargcount]
    for word in node.keywords:
        for other in left:
            if word.arg in left and other not in given:
                yield here.within(word, "arg", other, "name", _WORD)


def _of_a_copy(here: Here, scope: Scope, observed: Observed) -> Iterator[ProgramEdit]:
    """A copy of an array that is kept in a list, and changed in place later."""
    node = here.node
    if called(node) != "append" or len(node.args) != 1 or not isinstance(node.args[0], ast.Name):
        return
    kept, shape = node.args[0], observed.shape(node.args[0])
    if shape and kept.id in _changed_in_place(here.above[0]):
        copy = ast.Call(ast.Attribute(kept, "copy", ast.Load()), [], [])
        yield here.within(node.args, 0, copy, "aliased", _ALIASED)


def begun_as_a_copy(here: Here, observed: Observed) -> Iterator[ProgramEdit]:
    """A copy of an array for it, where the new name is changed in place: ``x = x0.copy()``."""
    line = here.node
    own = [one.id for one in line.targets if isinstance(one, ast.Name)]
    array = isinstance(line.value, ast.Name) and observed.shape(line.value)
    if array and not _changed_in_place(here.above[0]).isdisjoint(own):
        copy = ast.Call(ast.Attribute(line.value, "copy", ast.Load()), [], [])
        yield here.within(line, "value", copy, "aliased", _ALIASED)


def _changed_in_place(tree: ast.AST) -> set[str | None]:
    """The names of arrays of which entries are set, or to which something is added."""
    added = [x.target for x in nodes(tree) if isinstance(x, ast.AugAssign)]
    stores = (x for x in nodes(tree) if isinstance(x, ast.Subscript))
    return {*map(root, added), *(root(x) for x in stores if isinstance(x.ctx, ast.Store))}


def _other_function(here: Here, name: str) -> Iterator[ProgramEdit]:
    node = here.node
    for family in _FAMILIES:
        for other in family:
            if other == "cumsum" and node.args and _is_typed_in(node.args[0]):
                continue  # numbers are rather wrong themselves
            if name in family and other != name and isinstance(node.func, ast.Attribute):
                cost = _TRIANGLE if family == _TRIANGLES else _OF_A_FAMILY
                yield here.within(node.func, "attr", other, "function", cost)
    if name == "cumsum" and isinstance(node.func, ast.Attribute) and len(node.args) == 1:
        back = ast.Slice(None, None, number(-1))  # what lies behind: forces and masses
        inner = ast.Subscript(node.args[0], back, ast.Load())
        within = ast.Call(node.func, [inner], [])
        yield here.instead(within, "direction", 1.1)
        yield here.instead(ast.Subscript(within, back, ast.Load()), "direction", 1.1)
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


def _accumulated(here: Here, name: str) -> Iterator[ProgramEdit]:
    """Sums up to each for a list of what is summed; sums from each on for those up to it."""
    node, own = here.node.args[0], ast.Name(name, ast.Load())
    if called(node) != name if isinstance(node, ast.Call) else True:
        sums = ast.Call(own, [node], [])
        yield here.within(here.node.args, 0, sums, "function", 1.1)
        return
    back = ast.Slice(None, None, number(-1))
    first = node.args[0]
    back_already = isinstance(first, ast.Call) and called(first) == "reversed"
    turned = first.args[0] if back_already else None
    turned = turned or called_with("reversed", first)
    sums = ast.Call(node.func, [turned, *node.args[1:]], node.keywords)
    listed = ast.Call(here.node.func, [sums], [])
    yield here.instead(listed, "direction", 1.1)
    yield here.instead(ast.Subscript(listed, back, ast.Load()), "direction", 1.1)


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
        yield from _of_the_others(here, loops)
        for both in combinations(sorted(around), 2):
            farther = called_with("max", *(ast.Name(one, ast.Load()) for one in both))
            yield here.within(node, "args", [farther, args[0]], "loop", _FARTHER)
    else:
        around_first = len(args) == 2 and not around.isdisjoint(names(args[0]))
        for end in (args[0], plus(args[0], 1)) if around_first else ():
            yield here.within(node, "args", [end], "loop", _OTHERS)
        counted = {*inner, *scope.whole} if isinstance(args[0], ast.Name) else set[str]()
        for name in sorted(counted - {*names(args[0])}):
            farther = called_with("max", args[0], ast.Name(name, ast.Load()))
            yield here.within(node, "args", [farther, *args[1:]], "loop", _FARTHER)
        yield here.within(node, "args", [args[1]], "loop", 1.25)
        for name in inner:
            load = ast.Name(name, ast.Load())
            yield here.within(node, "args", [load, *args[1:]], "loop", 1.25)
            yield here.within(node, "args", [plus(load, 1), *args[1:]], "loop", 1.25)


def _of_the_others(here: Here, loops: Sequence[ast.For]) -> Iterator[ProgramEdit]:
    """From an outer loop's counter on for up to it: ``range(j, 3)`` for ``range(j + 1)``."""
    (upto,) = here.node.args
    for loop in loops:
        over = loop.iter if isinstance(loop.iter, ast.Call) else None
        if over is None or called(over) != "range" or len(over.args) > 2:
            continue
        for counter in (x for x in names(loop.target) if x in names(upto)):
            first = ast.Name(counter, ast.Load())
            for start in (first, plus(first, 1)):
                yield here.within(here.node, "args", [start, over.args[-1]], "loop", _OTHERS)


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
