"""Numbers in the text of a program otherwise."""

from __future__ import annotations

import ast
import math
from collections.abc import Iterator
from fractions import Fraction

from kinlab.doctor.bytecode.syntax import called, nodes
from kinlab.doctor.program.edits.numbers.data import is_number, measured
from kinlab.doctor.program.edits.scope.counters import counters_around
from kinlab.doctor.program.edits.scope.forms import entry, named
from kinlab.doctor.program.edits.scope.functions import PI
from kinlab.doctor.program.edits.scope.part import Scope
from kinlab.doctor.program.edits.single.whole import SIZES, value_of, whole_constant
from kinlab.doctor.program.observed import Seen
from kinlab.doctor.program.places import ANGLES, Here, ProgramEdit, called_with, number
from kinlab.doctor.program.trial import FieldChange

POWER, OF_A_NUMBER = 1.08, 1.25
"""Cost of another power, and of one of a number, which nobody means: ``0.25**2``."""
OF_RODS = {3: 12, 12: 3}
"""A rod's moments of inertia about its end, and about its middle, are its mass by these."""
_HOMOGENEOUS, _OF_A_POINT = 4, 1.03
"""Coordinates of a point with its 1, and the cost of 0 for that."""
_RODS = 1.02
"""Cost of all moments of a row about the other point."""
_RATIO, _SQUARED = 5, 1.1
"""A whole number from which on it may be a ratio of gears, and cost of its square for it."""
_ENTRIES, _OF_AN_ARGUMENT = 7, 1.1
"""Entries of an argument, and cost of one that is not read for nothing."""
_UP_TO_HERE = 1.1
"""Cost of a sum of an argument's entries that begins with nothing."""
_ROOTS, _OF_A_ROOT = (2, 3, 5), 1.1
"""Numbers that may be lost roots, and cost of one."""
_OF_A_BRANCH, _KEYS = 1.1, 2
"""Cost of something for nothing in a branch, and indices of the other one that are looked at."""
_QUARTER, _IN_DEGREES = 15, 1.1
"""Angles in degrees are typed in multiples of it, and cost of such a one in radians."""
_OF_ONE = 0.97
"""Cost of a half for a factor of one that is typed."""
_ANGLE_FOR_ONE = 1.05
"""Cost of the angle for a 1 in front of its sine: ``th - sin(th)``."""


def _angle_beside(here: Here) -> ast.expr | None:
    """The angle whose sine is taken away from a 1, if that is a name."""
    parent = here.parent
    if not isinstance(parent, ast.BinOp) or not isinstance(parent.op, ast.Sub):
        return None
    call = parent.right if parent.left is here.node else None
    if not isinstance(call, ast.Call) or called(call) != "sin" or len(call.args) != 1:
        return None
    return call.args[0] if isinstance(call.args[0], ast.Name) else None


def _as_in_the_other_branch(here: Here, scope: Scope) -> Iterator[ast.expr]:
    """What a branch may be that is nothing: a name, or a vector's entry as the other branch has."""
    parent = here.parent
    assert isinstance(parent, ast.IfExp)
    other = parent.orelse if here.field == "body" else parent.body
    for _text, node in scope.simple(()):
        yield node
    keys = [x.slice for x in nodes(other) if isinstance(x, ast.Subscript)]
    for key in [x for x in keys if isinstance(x, ast.Constant)][:_KEYS]:
        for _text, node in scope.simple((3,)):
            yield ast.Subscript(node, key, ast.Load())


def _up_to_here(here: Here, scope: Scope) -> Iterator[ast.expr]:
    """What a row of an argument comes to up to a loop's turn: ``angle = sum(q[:i])``."""
    turns = counters_around(here, scope.counting)
    rows = [name for name in _given(here) if len(scope.shapes.get(name) or ()) == 1]
    for row in rows if turns else ():
        part = ast.Slice(None, named(turns[-1]), None)
        yield called_with("sum", entry(named(row), part))


def _unread_entries(here: Here, scope: Scope) -> Iterator[ast.expr]:
    """The entries of an argument of which only others are read: ``wrench[5]`` for no moment."""
    tree = here.above[0]
    for name in _given(here):
        sizes = scope.shapes.get(name) or ()
        uses = [x for x in nodes(tree) if isinstance(x, ast.Name) and x.id == name]
        read = [x for x in nodes(tree) if isinstance(x, ast.Subscript) and x.value in uses]
        if len(sizes) != 1 or sizes[0] > _ENTRIES or len(read) != len(uses):
            continue
        left = {*range(sizes[0])}
        for one in read:
            left -= {*_constant_keys(one.slice, sizes[0])} or left
        for k in sorted(left):
            yield ast.Subscript(ast.Name(name, ast.Load()), ast.Constant(k), ast.Load())


def _given(here: Here) -> list[str]:
    """The arguments of the function that it stands in."""
    tree = here.above[0]
    return [one.arg for one in tree.args.args] if isinstance(tree, ast.FunctionDef) else []


def _constant_keys(key: ast.expr, size: int) -> list[int]:
    """The numbers of entries that a whole number, or a slice between such, stands for."""
    parts = [key.lower, key.upper, key.step] if isinstance(key, ast.Slice) else [key]
    if not all(one is None or whole_constant(one) for one in parts):
        return []
    told = [None if one is None else value_of(one) for one in parts]
    if isinstance(key, ast.Slice):
        return [*range(size)[slice(*told)]]
    return [k % size for k in told if k is not None]


def _in_radians(degrees: int, scope: Scope) -> ast.expr:
    """An angle as one types it: ``np.pi/2``, ``2*np.pi/3``."""
    share = Fraction(degrees, 180)
    above = number(math.pi) if not scope.has_numpy else PI
    if share.numerator != 1:
        above = ast.BinOp(number(share.numerator), ast.Mult(), above)
    return (
        above if share.denominator == 1 else ast.BinOp(above, ast.Div(), number(share.denominator))
    )


def of_degrees(here: Here, scope: Scope, seen: Seen | None) -> Iterator[ProgramEdit]:
    """What is given on was in whole degrees: in radians."""
    values = [float(x) for x in seen.values] if seen is not None else []
    if all(abs(x) < 2 * _QUARTER for x in values) or any(x % _QUARTER for x in values):
        return
    levels = ((name, scope.level_of(name)) for name, shape in scope.shapes.items() if shape == ())
    own = [name for name, level in levels if level and math.isclose(level, math.pi / 180)]
    if own:
        turned: ast.expr = ast.BinOp(here.node, ast.Mult(), ast.Name(own[0], ast.Load()))
    elif scope.has_numpy:
        radians = ast.Attribute(ast.Name("np", ast.Load()), "radians", ast.Load())
        turned = ast.Call(radians, [here.node], [])
    else:
        turned = ast.BinOp(here.node, ast.Mult(), number(math.pi / 180))
    yield here.instead(turned, "degrees", _IN_DEGREES)


def of_rods(here: Here) -> Iterator[ProgramEdit]:
    """All moments of a row about the rods' middles for those about their ends, or the other way."""
    divided = (
        x for x in nodes(here.node) if isinstance(x, ast.BinOp) and isinstance(x.op, ast.Div)
    )
    below = [x.right for x in divided if isinstance(x.right, ast.Constant)]
    for value, other in OF_RODS.items():
        alike = [x for x in below if type(x.value) is int and x.value == value]
        if len(alike) > 1:
            changes = tuple(FieldChange(x, "value", other) for x in alike)
            yield ProgramEdit(here.part, changes, "number", _RODS, here.node)


def _is_an_angle(here: Here) -> bool:
    """Whether it stands among the joints' positions: ``[q[0], q[1], 0, q[3]]``."""
    row = here.parent
    if not isinstance(row, ast.List | ast.Tuple) or not isinstance(row.ctx, ast.Load):
        return False
    return sum(isinstance(one, ast.Subscript) for one in row.elts) > len(row.elts) // 2 > 1


def _is_last_of_a_point(here: Here) -> bool:
    """Whether it is the 1 of a point, or the 0 of a direction: ``np.r_[c, 1]``."""
    row = here.parent
    if not isinstance(row, ast.Tuple | ast.List) or row.elts[-1] is not here.node:
        return False
    joined = here.above[-2] if len(here.above) > 1 else None
    glued = isinstance(joined, ast.Subscript) and getattr(joined.value, "attr", "") == "r_"
    return glued or len(row.elts) == _HOMOGENEOUS


def of_constant(here: Here, index: bool, scope: Scope) -> Iterator[ProgramEdit]:
    value = here.node.value
    if not is_number(value):
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
    if value in (0, 1) and _is_last_of_a_point(here):
        yield here.within(here.node, "value", type(value)(1 - value), "number", _OF_A_POINT)
    if value == 0 and scope.has_numpy and (own or measured(here.parent) or _is_an_angle(here)):
        half: ast.expr = ast.BinOp(PI, ast.Div(), number(2))
        minus = ast.BinOp(ast.UnaryOp(ast.USub(), PI), ast.Div(), number(2))
        for turned in (half, minus):
            yield here.instead(turned, "number", 1.13)
    if (
        isinstance(value, int)
        and value in OF_RODS
        and isinstance(getattr(here.parent, "op", None), ast.Div)
    ):
        yield here.within(here.node, "value", OF_RODS[value], "number", 1.03)
    if given is not None and called(given) == "append" and value in (0, 1):
        yield here.within(here.node, "value", type(value)(1 - value), "number", 1.05)
    if value == 0 and isinstance(here.parent, ast.IfExp) and here.field in ("body", "orelse"):
        for other in _as_in_the_other_branch(here, scope):
            yield here.instead(other, "name", _OF_A_BRANCH)
    if value == 0 and isinstance(here.parent, ast.Assign):
        for other in _unread_entries(here, scope):
            yield here.instead(other, "name", _OF_AN_ARGUMENT)
        for other in _up_to_here(here, scope):
            yield here.instead(other, "missing term", _UP_TO_HERE)
    product = getattr(here.parent, "op", None)
    if value == 1 and isinstance(value, float) and isinstance(product, ast.Mult):
        yield here.within(here.node, "value", 0.5, "factor", _OF_ONE)  # 1.0*x says nothing
    if value == 1 and (angle := _angle_beside(here)) is not None:
        yield here.instead(angle, "name", _ANGLE_FOR_ONE)
    if value in _ROOTS and scope.has_numpy and isinstance(here.parent, ast.BinOp):
        root = ast.Attribute(ast.Name("np", ast.Load()), "sqrt", ast.Load())
        yield here.instead(ast.Call(root, [number(value)], []), "power", _OF_A_ROOT)
    if abs(value) >= 2 * _QUARTER and value % _QUARTER == 0 and not value % 1:
        yield here.instead(_in_radians(int(value), scope), "degrees", _IN_DEGREES)
    for factor in (2, 0.5, 3, 1 / 3, 4, 0.25):
        new = value * factor
        new = int(new) if new == int(new) else new
        yield here.within(here.node, "value", new, "factor", 1.15)
    if isinstance(getattr(here.parent, "op", None), ast.Mult) and value == int(value) >= _RATIO:
        squared = ast.BinOp(number(int(value)), ast.Pow(), number(2))
        yield here.instead(squared, "power", _SQUARED)
    if isinstance(value, int) or value in (0.0, 1.0):
        for new in (value + 1, value - 1):
            power = isinstance(here.parent, ast.BinOp) and isinstance(here.parent.op, ast.Pow)
            kind = "power" if power else "number"
            cost = POWER if power else 1.18
            if power and isinstance(getattr(here.parent, "left", None), ast.Constant):
                cost = OF_A_NUMBER
            if not power or new != 1:  # what has none is typed without
                yield here.within(here.node, "value", new, kind, cost)
