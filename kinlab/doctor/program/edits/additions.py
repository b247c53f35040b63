"""What may be missing in a program: a sign, a transpose, a factor, a matrix, a term."""

from __future__ import annotations

import ast
import re
from collections.abc import Iterator
from itertools import permutations, product
from math import pi

import numpy as np

from kinlab.arrays import Array
from kinlab.doctor.bytecode.syntax import called, copied, factors, names, nodes, text_of
from kinlab.doctor.program.edits import chains
from kinlab.doctor.program.edits.numbers.data import GRAVITY
from kinlab.doctor.program.edits.scope.forms import (
    Turned,
    member,
    named,
    statement_of,
    stem_of,
    summands,
)
from kinlab.doctor.program.edits.scope.part import CENTRES, Scope
from kinlab.doctor.program.edits.scope.terms import of_any_link
from kinlab.doctor.program.edits.single.whole import value_of, whole_constant
from kinlab.doctor.program.observed import Shape
from kinlab.doctor.program.places import (
    ANGLES,
    Here,
    ProgramEdit,
    are_counted,
    array_of,
    follow,
    is_nothing,
    number,
    numbered,
    root,
)

ENTRIES = ast.Name | ast.Subscript | ast.Attribute
_ODD = 0.04
"""What a factor costs more of what is only passed on, or has a number in front."""
_GIVEN = 0.06
"""What it costs more to transpose what a line only returns, or a sum."""
_NEAR = 0.06
"""What a matrix costs more that stands in front of another vector of the line."""
_TURNING = 0.1
"""The same of one that stands in front of another vector of the part."""
_BESIDE = 0.04
"""The same of a term that stands in the line beside, of what is called alike."""
_FEW_MASSES = 2
"""Masses of which a sum is tried anyway."""
_TWIST = 6
"""Rows of a Jacobian, or of a twist."""
_REST = 1.12
"""Of a length what is behind the centre, l1 - lc1: rather lc1 itself."""
_NEXT_ANGLE = 1.08
"""Cost of the angle of the joint before, or next, in a sum: c12 for c2."""
_SQUARES = 1.07
"""Cost of the square of another constant in a sum of squares."""
_OF_AN_ANGLE = 0.1
"""What a factor costs more that is an angle: of these sines and cosines are factors."""
_MIXED = 0.96
"""Cost of a lost 2 in the mixed term of a square: a length for a distance is as soon mistaken."""
_FROM_ITS_ORIGIN = 1.08
"""Cost of a link's point for its origin."""
_CENTRES = (*CENTRES, "r", "c")
"""What may also be so called where a length is set for it: ``r = l2``."""
_AS_ITS_LIKE = 0.98
"""Cost of a factor that the term has in the line of another link."""
_MINUTE, _OF_A_TURN = 60, 0.98
"""Seconds; cost of a 2 that is lost of the angle of a turn."""
_OF_A_CENTRE = 1.0
"""Cost of the half of a length for all of it, where it is called as a centre's distance."""
_PUT_DOWN = 0.06
"""What a factor costs more of a name in a list: it is lost where that is worked out."""
_DOUBLES, _REMAINDER = 0.1, 1.05
"""What a term more costs more that doubles another; cost of 1 - x for x, where that stands."""
_MIXED_SQUARE = 1.07
"""Cost of a product of two rates for a square, or of a square for it."""
_ENTRY = 1.13
"""Cost of a product of the program for an entry that is zero."""
_AS_BESIDE = 1.1
"""Cost of the entry beside for a zero."""
_BEYOND = 1.08
"""Cost of the angle with the same sine for that with the same cosine: ``pi - t`` for ``-t``."""
_AS_THERE = 0.99
"""Cost of a sum for one of its terms, where another link has that sum."""
_BESIDE_A_PART = 1.08
"""What it is to forget all of one beside a part of another: ``m2/2 + m3``."""
_TYPED = 0.14
"""What it costs more to transpose numbers that are typed: they would be typed so."""
_AS_GIVEN = 0.02
"""What it is likelier of what a line only takes over: ``n = wrench[3:]``."""
_OF_ANOTHER_KIND = 0.04
"""What a term costs more beside a name that begins with another letter."""
_OF_A_WAVE = 1.08
"""Cost of a minus in ``c, s = cos(q), sin(q)``."""
_WITHIN = 1.16
"""Cost of a minus in front of a sum that is a factor."""
_GIVEN_ON = 1.12
"""Cost of a sign of what a function only gives on, or an object only keeps."""
_KEPT = 1.22
"""Cost of a factor of what an object only keeps."""
_UNPACKED = 1.2
"""Cost of a sign of all that is given to several names at once."""
_TARGETS = re.compile(r"\w*target\w*|\w*goal\w*|\w*des(?:ired)?|[xp]_?d|x_?ref|ref", re.IGNORECASE)
"""How what a tool is to reach is called."""
_LESS_THE_TARGET = 0.95
"""Cost of an error that is taken the other way round."""
_OF_A_LIST = 0.08
"""What a factor costs more of an array as it is typed: it is lost where that is used."""
_MILLIMETRES, _IN_MILLIMETRES = {"1000", "1000.0"}, 1.1
"""What lengths are divided by in the end, and cost of a term that is in metres all the same."""
_NAMED_FOR_THIS = 1.1
"""Cost of a sign of an entry that has a name for this alone: it is lost where that is set."""
_AS_SET = 1.05
"""Cost of a sign in a row of what was set before."""
_DIVIDED = 1.07
"""Cost of a divisor that is lost."""
_SAME_NUMBER = 0.06
"""What a name costs less that has the number of all others in a matrix."""
_INSIDE = 0.06
"""What a product of the program costs more as a term of what is turned."""
_SIGNED = 1.1
"""Cost of a sign that has a name for a term without."""
_OF_NOTHING = 0.06
"""What a term costs more beside a name that is always nought: the name is another."""
_SHARE_LEFT = 1.08
"""Cost of ``1 - x`` for a share x."""
_DIFFERENCE = 1.05
"""Cost of the same entry of another row taken from one, where others are: ``phi[i] - phi[j]``."""
_COUNTS = ("n", "N", "nj", "dof", "ndof")
"""Names of how many joints there are, which nobody takes twice."""
_THRICE = 3
"""How often a name may stand in a sum of three equal links."""


_SHARES, _SHARED = (3, 4, 6, 12), 1.14
"""What inertias and torques are divided by, beside halves, and cost of such a share for the whole.
"""
_OF_TWO_VECTORS = 1.06
"""Cost of the square of their product, taken from that of the squares of two vectors."""
_UNUSED = 1.06
"""Cost of a number that nothing uses, added to every entry of what is returned."""
_FALLING, _FALLING_TOO = 1.04, 1.12
"""Cost of gravity for a name of it that nothing uses, and for one that something does."""
_ROOTS = 1.14
"""Cost of the roots of what is returned, for their squares."""
_QUADRATIC = 1.0
"""Cost of the half of a quadratic form for all of it."""
_HALF_SQUARED = 1.09
"""Cost of half a length in a square, where it stands whole."""


_TENSOR, _SECOND_MOMENTS = (3, 3), 1.03
"""Shape of a tensor of inertia, and what it is to take it for the second moments."""
_QUARTERS = [
    [[0 if k != at else sign for k in range(3)] for at, sign in zip(order, signs, strict=True)]
    for order in permutations(range(3))
    for signs in product((1, -1), repeat=3)
    if (order != (0, 1, 2) or -1 in signs)
    and round(np.linalg.det(np.eye(3)[[*order]]) * np.prod(signs)) == 1
]
"""The rotations that take axes to axes."""
_TURNED = 1.13
"""What it is to take none of them for such a one."""
_POSE, _INVERTED = (4, 4), 1.06
"""Shape of a pose, and the cost of its inverse for it."""


def as_a_term(here: Here, scope: Scope, shape: Shape) -> Iterator[ProgramEdit]:
    """A sign, a transpose, a factor, a term more: where an expression stands for itself."""
    node, parent = here.node, here.parent
    zero = isinstance(node, ast.Constant) and node.value == 0
    literal = isinstance(node, ast.List | ast.Tuple)
    written = isinstance(parent, ast.Subscript) and isinstance(parent.ctx, ast.Store)
    of_method = isinstance(parent, ast.Attribute) and parent.attr != "dot"  # J.dot(w) is a product
    if shape and not literal and not written and not of_method:
        yield from _matrices(here, scope, shape)
    for unit in ("1", "1.0") if isinstance(node, ast.Name) else ():
        if (piece := scope.pieces_here(shape).get(f"{unit} - {node.id}")) is not None:
            yield here.instead(piece, "missing term", _REMAINDER)
    row = len(shape) == 1 and isinstance(node, ast.Name) and scope.has_numpy
    multiplied = isinstance(parent, ast.BinOp) and isinstance(parent.op, ast.Mult)
    summed = isinstance(parent, ast.BinOp) and isinstance(parent.op, ast.MatMult)
    summed = summed and here.field == "right" and not scope.is_pose(node)
    alone = isinstance(parent, ast.Assign)  # the squares of singular values
    if (multiplied or summed or alone) and len(shape) == 1 and isinstance(node, ast.Name):
        yield here.instead(ast.BinOp(node, ast.Pow(), number(2)), "power", 1.12)
    if row and not isinstance(parent, ast.Subscript | ast.BinOp | ast.Attribute):
        total = ast.Attribute(ast.Name("np", ast.Load()), "cumsum", ast.Load())
        unpacked = isinstance(parent, ast.Assign) and isinstance(parent.targets[0], ast.Tuple)
        cost = 1.14 if isinstance(parent, ast.Call) else 1.16 if unpacked else 1.1
        yield here.instead(ast.Call(total, [node], []), "function", cost)
    if shape in ((2,), (3,)) and isinstance(node, ast.Name):
        yield from _falling(here, scope, shape[0])
    if isinstance(parent, ast.Return) and len(shape) == 1:
        yield from _of_a_returned_row(here, scope)
    squared = isinstance(parent, ast.BinOp) and isinstance(parent.op, ast.Pow)
    if squared and here.field == "left" and isinstance(node, ast.Name | ast.Attribute):
        half = ast.BinOp(node, ast.Div(), number(2))
        yield here.instead(half, "missing factor", _HALF_SQUARED)
    if shape == () and isinstance(node, ast.BinOp):
        yield from _shares(here, node) if isinstance(node.op, ast.Div) else ()
        yield from _less_what_is_along(here, node) if isinstance(node.op, ast.Mult) else ()
    for term in _in_the_other_case(here) if zero else ():
        if scope.observed.shape(term) == ():
            yield here.instead(copied(term), "number", 1.06)
    if zero and isinstance(parent, ast.Call | ast.List | ast.Tuple):
        yield from _instead_of_zero(here, scope)
    for one in parent.elts if zero and isinstance(parent, ast.List | ast.Tuple) else ():
        if isinstance(one, ast.Subscript):
            yield here.instead(copied(one), "number", _AS_BESIDE)
    if isinstance(parent, ast.Subscript | ast.Attribute) or zero or literal:
        return
    operated = isinstance(parent, ast.BinOp)
    op = parent.op if isinstance(parent, ast.BinOp) else None
    summand = isinstance(op, ast.Add | ast.Sub)
    product = isinstance(op, ast.MatMult)
    entry = isinstance(parent, ast.List | ast.Tuple)
    entry = entry or (isinstance(parent, ast.Dict) and here.holder is parent.values)
    whole = isinstance(parent, ast.Assign | ast.AugAssign | ast.Return) or entry
    whole = whole or (isinstance(parent, ast.IfExp) and here.field != "test")
    kept = isinstance(parent, ast.Call) and called(parent) in ("append", "float")
    listed = whole or kept or here.field == "elt"  # of ``[x for ..]``
    trig = isinstance(parent, ast.Call) and called(parent) in ANGLES
    argument = isinstance(parent, ast.Call) and not trig
    first = summand and here.field == "left"
    negative = isinstance(_leftmost(node), ast.UnaryOp) or isinstance(parent, ast.UnaryOp)
    pose = shape == (4, 4) and scope.is_pose(node)
    beside = parent.right if summand and first and isinstance(parent, ast.BinOp) else None
    seen = None if beside is None else scope.observed.of(beside)
    nothing = seen is not None and seen.nothing  # the sign is then that of the sum
    if not negative and not pose and not nothing and (first or not operated):
        outer = here.above[-2] if isinstance(parent, ast.Tuple) else parent
        given = isinstance(outer, ast.Assign | ast.Return)
        alone = isinstance(node, ast.Name | ast.Subscript | ast.Attribute) and given
        cost = 1.06 if alone else 1.0 if first or entry else 1.03 if whole else 1.1
        given_on = here.part and isinstance(outer, ast.Return) and isinstance(node, ast.Name)
        if first and isinstance(op, ast.Add) and _is_a_factor(here):
            cost = _WITHIN
        waves = getattr(parent, "elts", ()) if isinstance(parent, ast.Tuple) else ()
        if len(waves) > 1 and all(isinstance(x, ast.Call) and called(x) in ANGLES for x in waves):
            cost = _OF_A_WAVE
        if alone and (_keeps(parent, node) or given_on):
            cost = _GIVEN_ON
        if alone and _is_unpacked(here):
            cost = _UNPACKED
        if entry and (are_counted(getattr(parent, "elts", ())) or _is_alone(parent, node)):
            cost = _AS_SET
        if entry and isinstance(node, ast.Name) and _is_for_this_alone(here, node.id):
            cost = _NAMED_FOR_THIS
        if isinstance(parent, ast.Assign) and _is_less_the_target(node):
            cost = _LESS_THE_TARGET
        yield here.instead(chains.opposite(node), "sign", cost)
    below = isinstance(op, ast.Div) and here.field == "right"
    own = scope.observed.of(node)
    counts = getattr(node, "attr", getattr(node, "id", "")) in _COUNTS
    count = own is not None and own.whole and (counts or isinstance(node, ast.IfExp))
    if (summand or listed or trig or below) and not (isinstance(node, ast.Constant) or count):
        passed = isinstance(parent, ast.Return) and not isinstance(node, ast.BinOp)
        counted = isinstance(_leftmost(node), ast.Constant)
        used = (_is_array(node) or here.field == "elt") and _is_a_term_elsewhere(here)
        for value in (2, 0.5, *([_THRICE] * (isinstance(node, ast.Name) and not trig))):
            of_names = isinstance(node, ast.BinOp) and not isinstance(node.right, ast.Constant)
            times = chains.without_two(node) if value < 1 else None
            times = times or (chains.part_of(node, 2) if value < 1 and of_names else None)
            times = times or chains.times(number(value), node)
            rare = trig or value == _THRICE
            cost = 1.15 if rare else 1.05 + _ODD * (passed or counted)
            cost = _KEPT if _keeps(parent, node) else cost
            cost = _OF_A_TURN if value == 2 and _has_half_a_turn(node) else cost
            cost = _MIXED if value == 2 and _is_mixed(here) else cost
            cost = _AS_ITS_LIKE if summand and _has_its_like(here, times, scope) else cost
            cost = _OF_A_CENTRE if value < 1 and _is_called_a_centre(here) else cost
            cost += _PUT_DOWN * (isinstance(parent, ast.List) and isinstance(node, ast.Name))
            cost += _OF_A_LIST * used
            cost = _QUADRATIC if value < 1 and _is_quadratic(node) else cost
            yield here.instead(times, "factor", cost)
        if summand and isinstance(node, ast.Name | ast.Subscript) and scope.divisors & _MILLIMETRES:
            yield here.instead(chains.times(number(1000), node), "factor", _IN_MILLIMETRES)
    if (summand or whole) and not isinstance(node, ast.Constant):
        yield from _divided(here, scope, summand)
    if trig:
        yield from _angle(here, scope)
        return
    if isinstance(node, ast.Constant):
        for _text, scalar in scope.simple(()):
            if operated and not isinstance(op, ast.Pow):
                yield here.instead(scalar, "name", 1.07 + scope.dear(scalar))
        return
    if summand or (isinstance(op, ast.Mult) and here.field == "left"):
        yield from _signs(here, scope)
    if shape == ():
        yield from _scalars(here, scope, summand or listed or below, operated)
        squares = _has_squares(node)
        if scope.root is not None and squares:
            yield here.instead(ast.Call(scope.root, [node], []), "function", 1.16)
        if squares and not summand:
            yield from _another_square(here, scope)
        if isinstance(node, ast.Name) and node.id in scope.arcs and (whole or summand):
            yield from _supplements(here, scope)
        if isinstance(op, ast.Mult) and isinstance(node, ast.Name) and _is_a_share(node, scope):
            rest = ast.BinOp(number(1), ast.Sub(), node)
            yield here.instead(rest, "missing term", _SHARE_LEFT)
        turned = isinstance(node, ast.UnaryOp) and isinstance(node.op, ast.USub)
        if turned and getattr(node.operand, "id", "") in scope.arcs and scope.pi is not None:
            beyond = ast.BinOp(scope.pi, ast.Sub(), node.operand)
            yield here.instead(beyond, "missing term", _BEYOND)
        given = isinstance(parent, ast.Call) and called(parent) in scope.functions
        if (entry or given) and isinstance(node, ast.Name | ast.Subscript):
            yield from _quarters(here, scope)
    rotated = isinstance(node, ast.BinOp) and isinstance(node.op, ast.MatMult)
    weighed = rotated and isinstance(op, ast.Mult) and len(shape) == 1  # m*(R @ c)
    if listed or summand or argument or product or weighed:
        yield from _terms(here, scope, shape, whole or here.field == "elt")


def _is_quadratic(node: ast.expr) -> bool:
    """Whether it is a quadratic form: ``v @ M @ v``, of which energies have the half."""
    left = node.left if isinstance(node, ast.BinOp) and isinstance(node.op, ast.MatMult) else None
    if not isinstance(node, ast.BinOp) or not isinstance(left, ast.BinOp):
        return False
    return isinstance(left.op, ast.MatMult) and text_of(left.left) == text_of(node.right)


def _has_half_a_turn(node: ast.expr) -> bool:
    """Whether half a turn a minute is in a product: ``n*pi/60``."""
    first, others = chains.chain(node, chains.PRODUCTS)
    below = [x for op, x in others if isinstance(op, ast.Div)]
    names_ = {getattr(x, "attr", getattr(x, "id", "")) for x in chains.members((first, others))}
    return "pi" in names_ and any(getattr(x, "value", 0) == _MINUTE for x in below)


def _has_its_like(here: Here, new: ast.expr, scope: Scope) -> bool:
    """Whether the line of another link has such a term: ``0.5*m2*v2`` for ``0.5*m1*v1``."""
    return of_any_link(new) in scope.alike.get(stem_of(here.above), ())


def _in_the_other_case(here: Here) -> Iterator[ast.expr]:
    """The terms of what the other case has in a place: ``theta`` of ``q + theta``."""
    node, outer, entry = here.node, here.parent, None
    if isinstance(outer, ast.Tuple):
        node, outer, entry = outer, here.above[-2], here.field
    others: list[ast.expr] = []
    if isinstance(outer, ast.IfExp):
        others = [one for one in (outer.body, outer.orelse) if one is not node]
    elif isinstance(outer, ast.Assign):
        case = next((one for one in reversed(here.above) if isinstance(one, ast.If)), None)
        lines = [] if case is None else [x for x in nodes(case) if isinstance(x, ast.Assign)]
        own = [*map(ast.dump, outer.targets)]
        others = [x.value for x in lines if x is not outer and [*map(ast.dump, x.targets)] == own]
    for other in others:
        if entry is not None:
            entries = other.elts if isinstance(other, ast.Tuple) else []
            other = entries[entry] if entry < len(entries) else ast.Tuple([], ast.Load())
        for term in summands(other):
            if isinstance(term, ENTRIES):
                yield term


def _is_a_term_elsewhere(here: Here) -> bool:
    """Whether what a statement sets is a term of a sum: ``return rate - grad``."""
    line = statement_of(here.above)
    target = line.targets[0] if isinstance(line, ast.Assign) else None
    sums = [x for x in nodes(here.above[0]) if isinstance(x, ast.BinOp)
            and isinstance(x.op, chains.SUMS)]  # fmt: skip
    terms = {getattr(side, "id", "") for x in sums for side in (x.left, x.right)}
    return isinstance(target, ast.Name) and target.id in terms


def _is_less_the_target(node: ast.expr) -> bool:
    """Whether it is where the tool is less where it is to be: everybody takes that from it."""
    taken = isinstance(node, ast.BinOp) and isinstance(node.op, ast.Sub)
    return taken and bool(_TARGETS.fullmatch(getattr(getattr(node, "right", None), "id", "")))


def _is_for_this_alone(here: Here, name: str) -> bool:
    """Whether a name is set in the function, and used in this one place: ``[r21, r22, r23]``."""
    every = [x for x in nodes(here.above[0]) if isinstance(x, ast.Name) and x.id == name]
    return len(every) == 2 and any(isinstance(x.ctx, ast.Store) for x in every)


def _is_a_factor(here: Here) -> bool:
    """Whether the sum that begins with it is multiplied: ``l*(a + b)``, where no sign is lost."""
    outer = here.above[-2] if len(here.above) > 1 else None
    return isinstance(outer, ast.BinOp) and isinstance(outer.op, ast.Mult)


def _is_alone(row: ast.AST, node: ast.expr) -> bool:
    """Whether an entry of a list stands in a row beside noughts alone: ``[a[i], 0, 0]``."""
    others = [one for one in getattr(row, "elts", ()) if one is not node]
    return isinstance(node, ast.Subscript) and bool(others) and all(map(is_nothing, others))


def _keeps(parent: ast.AST, node: ast.expr) -> bool:
    """Whether an object keeps what it is given, by the same name: ``self.m = m``."""
    target = parent.targets[0] if isinstance(parent, ast.Assign) else None
    return isinstance(target, ast.Attribute) and target.attr == getattr(node, "id", "")


def _divided(here: Here, scope: Scope, summand: bool) -> Iterator[ProgramEdit]:
    """A term, or all that is set, by what is a divisor elsewhere."""
    node = here.node
    op = node.op if isinstance(node, ast.BinOp) else None
    if (summand and isinstance(op, ast.Add | ast.Sub)) or isinstance(op, ast.Div):
        return
    own = {text_of(one) for one in nodes(node) if isinstance(one, ENTRIES)}
    for text, divisor in scope.simple(()):
        if text in scope.divisors and text not in own:
            new = ast.BinOp(node, ast.Div(), divisor)
            yield here.instead(new, "missing factor", _DIVIDED)


def _falling(here: Here, scope: Scope, size: int) -> Iterator[ProgramEdit]:
    """An acceleration with gravity's, that the program has."""
    for name, known in scope.shapes.items() if scope.has_numpy else ():
        if known == () and GRAVITY.match(name):
            cost = _FALLING if name in scope.unused else _FALLING_TOO
            upwards = array_of([*[number(0)] * (size - 1), named(name)])
            yield here.instead(ast.BinOp(here.node, ast.Add(), upwards), "missing term", cost)


def _of_a_returned_row(here: Here, scope: Scope) -> Iterator[ProgramEdit]:
    """A number more in every entry, that nothing uses; the roots of what is returned."""
    node = here.node
    for name in sorted(scope.unused) if isinstance(node, ast.BinOp) else ():
        if scope.shapes.get(name) == ():
            more = ast.BinOp(node, ast.Add(), named(name))
            yield here.instead(more, "missing term", _UNUSED)
    if scope.has_numpy:
        entries = node.args[:1] if _is_array(node) else [node]
        roots = ast.Call(member(named("np"), "sqrt"), entries, [])
        yield here.instead(roots, "function", _ROOTS)


def _is_array(node: ast.expr) -> bool:
    """Whether an array is typed in: ``np.array([a, b])``."""
    return isinstance(node, ast.Call) and called(node) in ("array", "asarray")


def _shares(here: Here, quotient: ast.BinOp) -> Iterator[ProgramEdit]:
    """A share of what is divided: ``I/(3*j**2)`` for ``I/j**2``."""
    for value in _SHARES if not isinstance(quotient.right, ast.Constant) else ():
        below = chains.times(number(value), quotient.right)
        yield here.instead(ast.BinOp(quotient.left, ast.Div(), below), "factor", _SHARED)


def _less_what_is_along(here: Here, product_: ast.BinOp) -> Iterator[ProgramEdit]:
    """Of squares of two vectors that of their product: ``w @ w * (r @ r) - (w @ r)**2``."""
    first, second = _squared(product_.left), _squared(product_.right)
    if first and second:
        mixed = copied(product_.left)
        if isinstance(mixed, ast.BinOp):
            mixed.right = second
        elif isinstance(mixed, ast.Call):
            mixed.args = [first, second]
        square = ast.BinOp(mixed, ast.Pow(), number(2))
        rest = ast.BinOp(product_, ast.Sub(), square)
        yield here.instead(rest, "missing term", _OF_TWO_VECTORS)


def _squared(node: ast.expr) -> ast.expr | None:
    """The vector whose square it is: ``w @ w``, ``np.dot(w, w)``."""
    pair: list[ast.expr] = []
    if isinstance(node, ast.Call) and called(node) in ("dot", "inner", "vdot"):
        pair = node.args
    elif isinstance(node, ast.BinOp) and isinstance(node.op, ast.MatMult):
        pair = [node.left, node.right]
    return pair[0] if len(pair) == 2 and text_of(pair[0]) == text_of(pair[1]) else None


def _is_called_a_centre(here: Here) -> bool:
    """Whether a length is set for what is called as a centre's distance: ``r = l2``."""
    node, parent = here.node, here.parent
    if not isinstance(parent, ast.Assign) or not isinstance(node, ast.Name):
        return False
    target = parent.targets[-1]
    return isinstance(target, ast.Name) and target.id.rstrip("0123456789_").lower() in _CENTRES


def _is_mixed(here: Here) -> bool:
    """Whether it is the mixed term of a square of a sum: ``a*b*c`` beside ``a**2 + b**2``."""
    above = (x for x in here.above if isinstance(x, ast.BinOp))
    sums = [x for x in above if isinstance(x.op, ast.Add | ast.Sub)]
    if here.parent not in sums:
        return False
    squared = {
        frozenset(map(text_of, factors(x.left)))
        for one in summands(sums[0])
        for x in nodes(one)
        if isinstance(x, ast.BinOp) and isinstance(x.op, ast.Pow)
    }
    own = {text_of(x) for x in factors(here.node)}
    return sum(one <= own for one in squared) > 1


def _instead_of_zero(here: Here, scope: Scope) -> Iterator[ProgramEdit]:
    """A name, or a product, for a zero that is given on, or that is an entry.

    Soonest d6 beside c6 and s6.
    """
    tables = [one for one in here.above if isinstance(one, ast.List | ast.Tuple)][-2:]
    beside = {found[1] for one in nodes(tables[0]) if (found := numbered(one))} if tables else set()
    for _text, scalar in scope.simple(()):
        if isinstance(scalar, ast.Name) or scope.is_idle(scalar):
            own = numbered(scalar)
            less = _SAME_NUMBER if own is not None and {own[1]} == beside else 0.0
            yield here.instead(scalar, "name", 1.12 + scope.dear(scalar) - less)
    for piece in scope.pieces_here(()).values() if tables else ():
        if isinstance(piece, ast.BinOp) and isinstance(piece.op, ast.Mult):
            yield here.instead(copied(piece), "missing term", _ENTRY)
            yield here.instead(chains.opposite(copied(piece)), "missing term", _ENTRY)


def _is_typed(node: ast.expr) -> bool:
    """Whether it is an array of numbers that are typed."""
    given = node.args[:1] if isinstance(node, ast.Call) and called(node) == "array" else []
    known = ast.List | ast.Tuple | ast.Constant | ast.UnaryOp | ast.unaryop | ast.Load
    return bool(given) and all(isinstance(one, known) for one in nodes(given[0]))


def _leftmost(node: ast.expr) -> ast.expr:
    """What a product begins with, where its sign stands: ``-a`` of ``-a*b``."""
    while isinstance(node, ast.BinOp) and isinstance(node.op, ast.Mult | ast.Div | ast.MatMult):
        node = node.left
    return node


def _inverted(here: Here, scope: Scope) -> Iterator[ProgramEdit]:
    """The inverse of a pose, soonest of one that is given to a function."""
    inverse = isinstance(here.node, ast.Call) and called(here.node) == "inv"
    if scope.has_numpy and not inverse:
        linear = ast.Attribute(ast.Name("np", ast.Load()), "linalg", ast.Load())
        call = ast.Call(ast.Attribute(linear, "inv", ast.Load()), [here.node], [])
        given = isinstance(here.parent, ast.Call)
        yield here.instead(call, "inverse", _INVERTED + _GIVEN * (not given))


def _of_tensors(here: Here, scope: Scope) -> Iterator[ProgramEdit]:
    """The second moments of a tensor of inertia, ``tr(I)/2 - I``; a quarter turn for none."""
    node, seen = here.node, scope.observed.of(here.node)
    if isinstance(node, ast.Call) and called(node) == "eye" and isinstance(here.parent, ast.Assign):
        for rows in _QUARTERS:
            turned = ast.parse(f"np.array({rows})", mode="eval").body
            yield here.instead(turned, "missing matrix", _TURNED)
    elif isinstance(node, ast.Name | ast.Subscript) and any(
        map(_may_be_a_tensor, seen.values if seen is not None else ())
    ):
        half = ast.parse(f"np.trace({text_of(node)})/2*np.eye(3)", mode="eval").body
        yield here.instead(ast.BinOp(half, ast.Sub(), node), "missing term", _SECOND_MOMENTS)


def _may_be_a_tensor(value: Array) -> bool:
    """Whether it is symmetric, with positive numbers on its diagonal, and no unit matrix."""
    diagonal = np.diagonal(value)
    same = np.allclose(diagonal, diagonal[0])
    return bool(np.allclose(value, value.T) and (diagonal > 0).all()) and not bool(same)


def _matrices(here: Here, scope: Scope, shape: Shape) -> Iterator[ProgramEdit]:
    node = here.node
    transposed = isinstance(node, ast.Attribute) and node.attr == "T"
    if len(shape) == 2 and not transposed and not scope.is_pose(node):
        passed = isinstance(node, ast.Call) and root(node.func) not in ("np", "numpy")
        passed = passed or isinstance(node, ast.Name)
        given = isinstance(here.parent, ast.Return) and passed
        whole = isinstance(node, ast.BinOp) and isinstance(node.op, ast.Add | ast.Sub)
        cost = 1.04 + _GIVEN * (given or whole) + _TYPED * _is_typed(node)
        yield here.instead(ast.Attribute(node, "T", ast.Load()), "transposed", cost)
    if shape == _POSE and not isinstance(here.parent, ast.Subscript) and scope.is_pose(node):
        yield from _inverted(here, scope)
    if shape == _TENSOR and scope.has_numpy:
        yield from _of_tensors(here, scope)
    if isinstance(here.parent, ast.Subscript) and here.field == "value" and len(shape) > 2:
        return
    if isinstance(here.parent, ast.Return) and shape[0] == _TWIST and isinstance(node, ast.Name):
        yield here.instead(_other_half_first(node), "order", 1.1)
    if (isinstance(node, ast.Name) and len(shape) > 2) or _is_unpacked(here):
        return
    beside = scope.factors.get(id(statement_of(here.above)), set())
    for size in {shape[0], shape[-1]}:
        for text, matrix in scope.simple((size, size)):
            turning = not scope.fronts.isdisjoint(names(matrix))
            near = _NEAR if text in beside else _TURNING if turning else 1.0
            cost = 1.02 + min(scope.dear(matrix), near)
            given = isinstance(here.parent, ast.Assign) and isinstance(node, ast.Subscript)
            cost -= _AS_GIVEN * given
            for turned in (matrix, ast.Attribute(matrix, "T", ast.Load())):
                if turned is not matrix and isinstance(matrix, ast.Attribute):
                    continue
                if turned is not matrix and text == text_of(node):
                    continue  # a rotation's product with its own transpose is 1
                if size == shape[0]:
                    new = ast.BinOp(turned, ast.MatMult(), node)
                    yield here.instead(new, "missing matrix", cost)
                if len(shape) == 2 and size == shape[-1]:
                    new = ast.BinOp(node, ast.MatMult(), turned)
                    yield here.instead(new, "missing matrix", cost)
                cost += 0.02


def _is_unpacked(here: Here) -> bool:
    """Whether it is set to several names at once: ``u, w = leg(i)``, of which none is a row."""
    targets = here.parent.targets if isinstance(here.parent, ast.Assign) else []
    return any(isinstance(one, ast.Tuple | ast.List) for one in targets)


def _other_half_first(node: ast.Name) -> ast.expr:
    """The angular rows first, or the linear ones."""
    text = f"np.concatenate([{node.id}[3:], {node.id}[:3]])"
    return ast.parse(text, mode="eval").body


def _angle(here: Here, scope: Scope) -> Iterator[ProgramEdit]:
    node = here.node
    radians = ast.BinOp(node, ast.Mult(), number(pi / 180))
    yield here.instead(radians, "degrees", 1.1)
    own = {text_of(n) for n in nodes(node)}
    every = _all_angles(node, scope)
    if every is not None:
        yield here.instead(every, "argument", _NEXT_ANGLE)
    for text, angle in scope.simple(()):
        if text not in own:
            cost = 1.0 + scope.dear(angle)
            cost = min(cost, _NEXT_ANGLE) if follow(angle, node) else cost
            first, last = (angle, node) if text < text_of(node) else (node, angle)
            yield here.instead(ast.BinOp(first, ast.Add(), last), "argument", cost)


def _all_angles(node: ast.expr, scope: Scope) -> ast.expr | None:
    """The angles of all joints up to one: ``q[0] + q[1] + q[2]`` for ``q[2]``."""
    own = numbered(node)
    terms: list[ast.expr] = []
    if own is not None:
        known = [f"{own[0]}{k}" for k in range(1, own[1] + 1)]
        terms = [ast.Name(x, ast.Load()) for x in known if x in scope.shapes]
    elif isinstance(node, ast.Subscript) and whole_constant(node.slice):
        at = value_of(node.slice)
        terms = [ast.Subscript(node.value, number(k), ast.Load()) for k in range(at + 1)]
    if len(terms) < _THRICE or text_of(terms[-1]) != text_of(node):
        return None
    return chains.joined(terms[0], [(ast.Add(), one) for one in terms[1:]])


def _signs(here: Here, scope: Scope) -> Iterator[ProgramEdit]:
    """What is 1 or -1, of a solution's branch or of a side, times a term that lacks it."""
    if not isinstance(here.node, ast.Name | ast.Subscript | ast.Call):
        return
    beside = {text_of(one) for one in nodes(statement_of(here.above) or here.node)}
    for text, one in scope.simple(()):
        seen = scope.observed.of(one)
        told = {*map(float, seen.values)} if seen is not None else set()
        if told and told <= {1.0, -1.0} and text not in beside:
            yield here.instead(ast.BinOp(one, ast.Mult(), here.node), "missing factor", _SIGNED)


def _scalars(here: Here, scope: Scope, term: bool, operated: bool) -> Iterator[ProgramEdit]:
    node, parent = here.node, here.parent
    own = text_of(node)
    power = isinstance(parent, ast.BinOp) and isinstance(parent.op, ast.Pow)
    a_name = isinstance(node, ast.Name | ast.Subscript)
    beside = _factors_beside(here) if term else set()
    dot = isinstance(node, ast.BinOp) and isinstance(node.op, ast.MatMult)  # (v @ u)**2
    dot = dot or (isinstance(node, ast.Call) and called(node) in ("dot", "norm", *scope.called))
    negated = isinstance(parent, ast.UnaryOp)  # -w*l
    share = isinstance(node, ast.BinOp) and isinstance(node.op, ast.Div)
    share = share and here.field == "right" and isinstance(getattr(parent, "op", None), ast.Mult)
    signs = isinstance(parent, ast.BinOp) and isinstance(here.above[-2], ast.Compare)  # a*b < 0
    may_be = (isinstance(node, ENTRIES) or dot or share) and not power and not signs
    if may_be and (operated or term or negated):
        yield here.instead(ast.BinOp(node, ast.Pow(), number(2)), "power", 1.08)
    yield from _squares_and_products(here, scope)
    yield from _beyond_the_origin(here, scope)
    if term:
        yield from _two_factors(here, scope)
    if operated:
        yield from _masses_behind(here, scope)
        yield from _beside_a_part(here, scope)
    doubled = _of_the_same_values(here, scope) if a_name and operated and not term else ()
    for text, scalar in scope.pieces_here(()).items():
        if text == own or isinstance(scalar, ast.BinOp | ast.UnaryOp):
            continue
        dear = 0.0 if text in beside else scope.dear(scalar)
        if a_name and isinstance(node, ast.Subscript) and isinstance(scalar, ast.Name):
            yield here.instead(scalar, "name", 1.05 + dear)
        elif isinstance(node, ast.Attribute) and isinstance(scalar, ast.Name):
            yield here.instead(scalar, "name", 1.03 if node.attr == text else 1.08 + dear)
        if term:
            angle = _OF_AN_ANGLE * (text in scope.turned)
            new = ast.BinOp(node, ast.Mult(), scalar)
            yield here.instead(new, "missing factor", 1.08 + dear + angle)
            if isinstance(scalar, ast.Name | ast.Subscript):
                square = ast.BinOp(scalar, ast.Pow(), number(2))
                new = ast.BinOp(node, ast.Mult(), square)
                yield here.instead(new, "missing factor", 1.12 + dear)
        elif a_name and operated and (text[0] == own[0] or not dear or _of_one_link(text, own)):
            both = sorted((own, text))  # a sum that stands elsewhere, as it is written there
            dear = 0.0 if " + ".join(both) in scope.pieces_here(()) else dear
            if _stems(text, own) in scope.sums:  # a2 + r2 beside a3 + r3
                yield here.instead(ast.BinOp(scalar, ast.Add(), node), "missing term", _AS_THERE)
            dear += _OF_ANOTHER_KIND * (text[0] != own[0])
            rest = _REST if text[0] in "lLar" and _of_one_link(text, own) else 1.05
            dear += _DOUBLES * (text in doubled)
            for op, cost in ((ast.Add(), 1.0), (ast.Sub(), rest)):
                new = ast.BinOp(node, op, scalar)
                yield here.instead(new, "missing term", cost + dear)


def _of_the_same_values(here: Here, scope: Scope) -> set[str]:
    """What else stands in the statement and has the values of an expression: it would double it.

    Numbers that stay, as all masses of a unit arm, say nothing.
    """
    own = scope.observed.of(here.node)
    values = [] if own is None else own.values
    if all(np.array_equal(one, values[0]) for one in values):
        return set()
    beside: dict[str, list[Array]] = {}  # each as it stands there first
    for one in nodes(statement_of(here.above)):
        seen = scope.observed.of(one) if isinstance(one, ast.Name | ast.Subscript) else None
        if seen is not None:
            beside.setdefault(text_of(one), seen.values)
    return {
        text
        for text, others in beside.items()
        if all(np.array_equal(x, y) for x, y in zip(values, others, strict=False))
    }


def _beyond_the_origin(here: Here, scope: Scope) -> Iterator[ProgramEdit]:
    """A coordinate of a point of the link for that of its origin: ``T[2, 3] + T[2, :3] @ c``."""
    node = here.node
    key = node.slice if isinstance(node, ast.Subscript) else None
    if not isinstance(node, ast.Subscript) or not isinstance(key, ast.Tuple) or len(key.elts) != 2:
        return
    row, column = key.elts
    if getattr(column, "value", None) not in (3, -1) or not scope.is_pose(node.value):
        return
    axes = ast.Tuple([row, ast.Slice(None, number(3))], ast.Load())
    along = ast.Subscript(node.value, axes, ast.Load())
    for _text, point in scope.pieces_here((3,)).items():
        new = ast.BinOp(node, ast.Add(), ast.BinOp(along, ast.MatMult(), point))
        yield here.instead(new, "missing term", _FROM_ITS_ORIGIN + scope.dear(point))


def _squares_and_products(here: Here, scope: Scope) -> Iterator[ProgramEdit]:
    """``qd1*qd2`` for ``qd1**2``, and a square for the product of two that follow on another."""
    node = here.node
    if not isinstance(node, ast.BinOp):
        return
    if _is_square(node):
        for _text, other in scope.simple(()):
            if follow(other, node.left):
                first, last = sorted((other, node.left), key=text_of)
                yield here.instead(ast.BinOp(first, ast.Mult(), last), "index", _MIXED_SQUARE)
    if isinstance(node.op, ast.Mult) and isinstance(node.right, ENTRIES):
        front = node.left.right if isinstance(node.left, ast.BinOp) else node.left
        if not follow(front, node.right):
            return
        for one in (front, node.right):
            new = squared = ast.BinOp(one, ast.Pow(), number(2))
            if front is not node.left and isinstance(node.left, ast.BinOp):
                if not isinstance(node.left.op, ast.Mult):
                    return
                new = ast.BinOp(node.left.left, node.left.op, squared)
            yield here.instead(new, "index", _MIXED_SQUARE)


def _of_one_link(one: str, other: str) -> bool:
    """Whether two lengths have one number, as a2 and r2."""
    return any(_stems(one, other)) and one[0] in "aldr" and other[0] in "aldrcx"


def _stems(one: str, other: str) -> tuple[str, str]:
    """The letters of two names with one number; of others nothing."""
    letters = (one.rstrip("0123456789"), other.rstrip("0123456789"))
    same = one[len(letters[0]) :] == other[len(letters[1]) :] != ""
    return letters if same else ("", "")


def _masses_behind(here: Here, scope: Scope) -> Iterator[ProgramEdit]:
    """All the masses that a link carries: ``m3 + m4 + m5`` for ``m3``, or for ``m3 + m4``."""
    summed = isinstance(here.parent, ast.BinOp) and isinstance(here.parent.op, ast.Add | ast.Sub)
    given = [numbered(one) for one in summands(here.node)]
    heads = {one[0] for one in given if one is not None}
    if summed or None in given or len(heads) > 1 or not heads <= {"m", "M"}:
        return
    known, (head,) = scope.pieces_here(()), heads
    new, count, last = here.node, 0, max(one[1] for one in given if one is not None)
    while (name := f"{head}{last + count + 1}") in known:
        new, count = ast.BinOp(new, ast.Add(), ast.Name(name, ast.Load())), count + 1
    if count + len(given) > _FEW_MASSES:
        yield here.instead(new, "missing term", 1.08)


def _beside_a_part(here: Here, scope: Scope) -> Iterator[ProgramEdit]:
    """All of one beside a part of another: ``m2/2 + m3`` for ``m2/2``, in a product."""
    node = here.node
    if not isinstance(node, ast.BinOp) or not isinstance(node.op, ast.Mult | ast.Div):
        return
    numbers = [x for x in (node.left, node.right) if isinstance(x, ast.Constant)]
    own = [x for x in (node.left, node.right) if isinstance(x, ENTRIES)]
    if (
        len(numbers) != 1
        or len(own) != 1
        or (isinstance(node.op, ast.Div) and numbers[0] is node.left)
    ):
        return
    alike = own[0].value if isinstance(own[0], ast.Subscript) else own[0]
    text, letters = text_of(own[0]), text_of(alike).rstrip("0123456789")
    for other, scalar in scope.pieces_here(()).items():
        beside = scalar.value if isinstance(scalar, ast.Subscript) else scalar
        if other != text and text_of(beside).rstrip("0123456789") == letters:
            new = ast.BinOp(node, ast.Add(), scalar)
            yield here.instead(new, "missing term", _BESIDE_A_PART)


def _two_factors(here: Here, scope: Scope) -> Iterator[ProgramEdit]:
    """Two names that stand together elsewhere as a factor: ``m*l``."""
    own = {*names(here.node)}
    for piece in scope.pieces_here(()).values():
        if isinstance(piece, ast.BinOp) and isinstance(piece.op, ast.Mult):
            both = isinstance(piece.left, ENTRIES) and isinstance(piece.right, ENTRIES)
            if both and own.isdisjoint(names(piece)):
                new = ast.BinOp(piece, ast.Mult(), here.node)
                yield here.instead(new, "missing factor", 1.2)


def _another_square(here: Here, scope: Scope) -> Iterator[ProgramEdit]:
    """The square of another constant beside that of one in a sum: ``rod**2 - crank**2 - x**2``."""
    squares = [x.left for x in summands(here.node) if isinstance(x, ast.BinOp) and _is_square(x)]
    known = {text_of(one) for one in squares}
    if known.isdisjoint(scope.levels):
        return
    for name in sorted(scope.levels.keys() - known):
        square = ast.BinOp(ast.Name(name, ast.Load()), ast.Pow(), number(2))
        for op in (ast.Sub(), ast.Add()):
            yield here.instead(ast.BinOp(here.node, op, square), "missing term", _SQUARES)


def _is_square(node: ast.BinOp) -> bool:
    return isinstance(node.op, ast.Pow) and chains.is_two(node.right)


def _has_squares(node: ast.expr) -> bool:
    """Whether it is a sum with a square in it, of which the root may be meant.

    A vector times itself is such a sum.
    """
    if isinstance(node, ast.BinOp) and isinstance(node.op, ast.MatMult):
        return text_of(node.left) == text_of(node.right)
    if not isinstance(node, ast.BinOp) or not isinstance(node.op, ast.Add | ast.Sub):
        return False
    powers = [one.op for one in summands(node) if isinstance(one, ast.BinOp)]
    return any(isinstance(op, ast.Pow) for op in powers)


def _is_a_share(node: ast.Name, scope: Scope) -> bool:
    """Whether a name stands for a part of a whole, of which the rest may be meant."""
    seen = scope.observed.of(node)
    if seen is None or seen.shape != () or not seen.values or node.id in scope.arcs:
        return False
    return all(0.0 < float(value) < 1.0 for value in seen.values)


def _supplements(here: Here, scope: Scope) -> Iterator[ProgramEdit]:
    """The other angle of a triangle, or the one that is measured the other way."""
    node, pi_ = here.node, scope.pi
    if pi_ is not None:
        yield here.instead(ast.BinOp(pi_, ast.Sub(), node), "missing term", 1.1)
        for op in (ast.Sub(), ast.Add()):
            yield here.instead(ast.BinOp(node, op, pi_), "missing term", 1.12)


def _quarters(here: Here, scope: Scope) -> Iterator[ProgramEdit]:
    """The angle at which a joint stands in its zero position."""
    if scope.pi is not None:
        for op in (ast.Add(), ast.Sub()):
            quarter = ast.BinOp(scope.pi, ast.Div(), number(2))
            yield here.instead(ast.BinOp(here.node, op, quarter), "missing term", 1.14)


def _factors_beside(here: Here) -> set[str]:
    """The factors that every other term of the sum or of the list around a term has."""
    terms: list[ast.expr] = []
    own: ast.AST = here.node
    for above in reversed(here.above):
        if isinstance(above, ast.BinOp) and isinstance(above.op, ast.Add | ast.Sub):
            terms.append(above.left if above.right is own else above.right)
        elif isinstance(above, ast.List | ast.Tuple):
            terms += [one for one in above.elts if one is not own]
        else:
            break
        own = above
    sets = [
        {text_of(n) for n in nodes(summand) if isinstance(n, ast.Name | ast.Attribute)}
        for one in terms
        for summand in summands(one)
        if not isinstance(summand, ast.Constant)
    ]
    inside = {*names(here.node)}
    every = set[str].intersection(*sets) if sets else set[str]()
    return (every | _factors_in_the_row(here)) - inside


def _factors_in_the_row(here: Here) -> set[str]:
    """The factors of products in the row of a matrix: ``sa`` of ``[s, c*sa, ca]``."""
    row, rows = here.parent, here.above[-2] if len(here.above) > 1 else None
    if not isinstance(row, ast.List | ast.Tuple) or not isinstance(rows, ast.List | ast.Tuple):
        return set()
    products = (one for one in row.elts if isinstance(one, ast.BinOp) and one is not here.node)
    return {x for one in products if isinstance(one.op, ast.Mult) for x in names(one)}


def _terms(here: Here, scope: Scope, shape: Shape, whole: bool) -> Iterator[ProgramEdit]:
    node = here.node
    own = text_of(node)
    entry = isinstance(here.parent, ast.List | ast.Tuple | ast.Dict)
    stem = stem_of(here.above)
    siblings = scope.addends.get(stem, set()) if whole else set()
    turned = isinstance(here.parent, ast.BinOp) and isinstance(here.parent.op, ast.MatMult)
    turned = turned and here.field == "right" and len(shape) == 1
    seen = scope.observed.of(node)
    zero = _OF_NOTHING if isinstance(node, ast.Name) and seen is not None and seen.nothing else 0.0
    if shape == ():
        across = (scope.addends.get(one, set()) for one in _of_the_other_axis(stem))
        yield from _turned_terms(here, scope, siblings.union(*across if whole else ()))
        yield from _terms_of_others(here, scope, siblings)
        yield from _other_of_two(here, scope)
    doubled = _of_the_same_values(here, scope)
    for text, piece in scope.pieces_here(shape).items():
        named = isinstance(piece, ast.Name | ast.Subscript)
        one = isinstance(piece, ast.Call) and called(piece) == "eye"
        inside = turned and isinstance(piece, ast.BinOp) and isinstance(piece.op, ast.Mult)
        if text == own or not (whole or named or one or inside or isinstance(piece, ast.Attribute)):
            continue
        if isinstance(piece, ast.List | ast.Tuple) or (_is_typed(piece) and _is_typed(node)):
            continue  # what an array is made of is no term of it
        used = not isinstance(piece, ast.BinOp) and scope.dear(piece)
        known = {text, own} <= scope.constants
        beside = entry and used and not known and not _of_a_kind(piece, node)
        if beside and text not in _entries_beside(here):
            continue
        near = _BESIDE if text in siblings else _INSIDE if inside else 1.0
        dear = min(scope.dear(piece), near)
        follows = follow(node, piece)
        more = 0.0 if follows and not zero else dear + zero  # m4 behind m3
        more += _DOUBLES * (text in doubled)
        less = 0.0 if follows and entry else dear  # tau[2] beside tau[1], in a row of differences
        for op, cost in ((ast.Add(), 1.06 + more), (ast.Sub(), 1.08 + less)):
            yield here.instead(ast.BinOp(node, op, piece), "missing term", cost)
        if one:
            yield here.instead(ast.BinOp(piece, ast.Sub(), node), "missing term", 1.1)
        if whole and shape == () and not dear:
            for factor, other in scope.simple(()):
                product = ast.BinOp(piece, ast.Mult(), other)
                if factor != text:
                    new = ast.BinOp(node, ast.Add(), product)
                    cost = 1.08 if _of_one_joint(piece, other) else 1.15
                    yield here.instead(new, "missing term", cost)


def _of_one_joint(one: ast.expr, other: ast.expr) -> bool:
    """Whether two numbers are one joint's: ``friction[j]*v[j]``."""
    if not isinstance(one, ast.Subscript) or not isinstance(other, ast.Subscript):
        return False
    return ast.dump(one.slice) == ast.dump(other.slice)


def _turned_terms(here: Here, scope: Scope, siblings: set[str]) -> Iterator[ProgramEdit]:
    """What stands in the line beside, with cosines for sines: of x what is there of y."""
    own = {text_of(one) for one in summands(here.node)}
    for text in sorted(siblings):
        piece = Turned(scope.shapes).visit(ast.parse(text, mode="eval").body)
        turned = text_of(piece)
        if turned != text and turned not in own and isinstance(piece, ast.BinOp):
            for op, cost in ((ast.Add(), 1.1), (ast.Sub(), 1.12)):
                yield here.instead(ast.BinOp(here.node, op, piece), "missing term", cost)


def _other_of_two(here: Here, scope: Scope) -> Iterator[ProgramEdit]:
    """The other half of a difference: ``T[i, k] - T[j, k]`` for ``T[i, k]``."""
    keys = getattr(getattr(here.node, "slice", None), "elts", [])
    counters = [one.id for one in keys if isinstance(one, ast.Name) and one.id in scope.counters]
    for own in counters if len(keys) > 1 else ():
        for other in sorted({*scope.counters} - {*counters}):
            new = OtherName(own, other).visit(copied(here.node))
            taken = _are_taken_from_each_other(scope, own, other)
            for op, cost in ((ast.Sub(), _DIFFERENCE if taken else 1.1), (ast.Add(), 1.12)):
                yield here.instead(ast.BinOp(here.node, op, new), "missing term", cost)


def _are_taken_from_each_other(scope: Scope, own: str, other: str) -> bool:
    """Whether an entry with one counter is taken from that with another: ``phi[i] - phi[j]``."""
    halves = ({f"{name}[{k}]" for k in (own, other)} for name in scope.shapes)
    return any(frozenset(both) in scope.differences for both in halves)


def _terms_of_others(here: Here, scope: Scope, siblings: set[str]) -> Iterator[ProgramEdit]:
    """A term of the line beside, with one of its names for another link's: ``p1`` for ``p2``."""
    for text in sorted(siblings):
        piece = ast.parse(text, mode="eval").body
        for name in dict.fromkeys(names(piece)):
            stem = name.rstrip("0123456789")
            for other in scope.shapes if stem != name else ():
                if other in (name, stem) or other.rstrip("0123456789") != stem:
                    continue
                new = OtherName(name, other).visit(copied(piece))
                for op, cost in ((ast.Add(), 1.12), (ast.Sub(), 1.14)):
                    yield here.instead(summed(here.node, op, new), "missing term", cost)


def summed(node: ast.expr, op: ast.operator, term: ast.expr) -> ast.expr:
    """A sum as it is written: ``a - b`` for ``a + -b``."""
    first = _leftmost(term)
    if not isinstance(first, ast.UnaryOp) or not isinstance(first.op, ast.USub):
        return ast.BinOp(node, op, term)
    other = ast.Sub() if isinstance(op, ast.Add) else ast.Add()
    return ast.BinOp(node, other, _without_sign(term))


def _without_sign(term: ast.expr) -> ast.expr:
    if isinstance(term, ast.BinOp):
        return ast.BinOp(_without_sign(term.left), term.op, term.right)
    return term.operand if isinstance(term, ast.UnaryOp) else term


class OtherName(ast.NodeTransformer):
    """One name for another."""

    def __init__(self, name: str, other: str) -> None:
        self.name, self.other = name, other

    def visit_Name(self, node: ast.Name) -> ast.expr:
        return ast.Name(self.other, node.ctx) if node.id == self.name else node


def _of_the_other_axis(stem: str) -> list[str]:
    """What a coordinate's name is for another one: ``vy`` for ``vx``."""
    return [stem.replace(one, other) for one, other in ("xy", "yx", "xz", "zx") if one in stem]


class OtherAxis(Turned):
    """Of x what is there of y, with cosines for sines."""

    def visit_Name(self, node: ast.Name) -> ast.Name:
        for one, other in ("xy", "yx", "XY", "YX"):
            name = node.id.replace(one, other)
            if name != node.id and name in self.known:
                return ast.Name(name, node.ctx)
        return super().visit_Name(node)


def _of_a_kind(piece: ast.expr, node: ast.expr) -> bool:
    """Whether a name has another number than those of an expression: ``a3`` and ``-a2``."""
    letters = {name.rstrip("0123456789").lower() for name in names(node)}
    return isinstance(piece, ast.Name) and piece.id.rstrip("0123456789").lower() in letters


def _entries_beside(here: Here) -> set[str]:
    """The names in the other entries of a list, and these themselves."""
    row = here.parent
    assert isinstance(row, ast.List | ast.Tuple | ast.Dict)
    every = row.values if isinstance(row, ast.Dict) else row.elts
    others = [one for one in every if one is not here.node]
    return {*(name for one in others for name in names(one)), *map(text_of, others)}
