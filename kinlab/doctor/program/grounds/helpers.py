"""Functions of a program that are what textbooks have, of whatever they are given.

The matrix of a cross product, a rotation about an axis, an adjoint, an exponential: such a function
need not be given what is right to be right itself. What it is, is looked at in each of its calls.
"""

from __future__ import annotations

import ast
from collections.abc import Callable, Iterator, Sequence
from itertools import permutations

import numpy as np
from scipy.linalg import expm

from kinlab.arrays import Array
from kinlab.doctor.bytecode.syntax import called, nodes
from kinlab.doctor.program.observed import Observed, Shape
from kinlab.doctor.program.trial import Trial
from kinlab.tolerances import TOLERANCES

_AXES = np.eye(3)
_MOST = 6
"""Calls that are looked at."""


def true_helpers(trial: Trial, observed: Observed) -> tuple[set[int], set[int]]:
    """The parts of a program that are one of those functions in each of their calls.

    Returns:
        those that are, and those that are with the other sign.
    """
    names = [part.name for part in trial.program.parts]
    found: tuple[set[int], set[int]] = set(), set()
    for k in range(1, len(names)):
        calls = [*_calls(trial, observed, names[k])] if names.count(names[k]) == 1 else []
        if calls and any(_tells(given) for given, _value in calls):
            shapes = tuple(x.shape for x in calls[0][0]), calls[0][1].shape
            known = _KNOWN.get(shapes)
            mirrored = [(given, -value) for given, value in calls]
            for parts, answers in zip(found, (calls, mirrored), strict=True):
                if known is not None and _is_one_of([*known(answers[0])], answers, known):
                    parts.add(k)
    return found


Call = tuple[list[Array], Array]
"""What a function was given, and its answer."""
Known = Callable[[Call], Iterator[Array]]
"""What textbooks' functions would answer, in the same order for any call."""


def _is_one_of(first: Sequence[Array], calls: Sequence[Call], known: Known) -> bool:
    """Whether one of the textbooks' functions answers as the program's does."""
    same = np.ones(len(first), dtype=bool)
    for call in calls:
        size = max(1.0, float(np.max(np.abs(call[1]))))
        gaps = [float(np.max(np.abs(one - call[1]))) for one in known(call)]
        same &= np.array(gaps) <= TOLERANCES.same_relation * size
    return bool(same.any())


def _tells(given: Sequence[Array]) -> bool:
    """Whether anything but zeros and units is given: of these much would be one thing."""
    return any(bool(np.any((x != 0) & (np.abs(x) != 1))) for x in given)


def _calls(trial: Trial, observed: Observed, name: str) -> Iterator[Call]:
    """The calls of a function of the program's, of one kind of arguments."""
    kind: tuple[Shape | None, ...] | None = None
    for node in (node for tree in trial.trees for node in nodes(tree)):
        if not isinstance(node, ast.Call) or called(node) != name or node.keywords:
            continue
        typed = {k: _typed(x) for k, x in enumerate(node.args) if isinstance(x, ast.Constant)}
        others = [observed.of(x) for k, x in enumerate((*node.args, node)) if k not in typed]
        told = [one for one in others if one is not None]
        if len(told) < len(others) or len({one.count for one in told}) != 1:
            continue
        values = [one.values for one in told]
        for k, number in sorted(typed.items()):
            values.insert(k, [number] * _MOST)
        shapes = tuple(one[0].shape if one else None for one in values)
        if None in shapes:
            continue
        kind = kind or shapes
        every = zip(*values, strict=False)
        for (*given, value), _k in zip(every, range(_MOST), strict=False):
            if shapes == kind and all(np.isfinite(x).all() for x in (*given, value)):
                yield given, value


def _typed(node: ast.Constant) -> Array:
    """The number that a call is given as it stands; NaN of what is none."""
    return np.array(float(node.value) if isinstance(node.value, int | float) else np.nan)


def _cross(v: Array) -> Array:
    """The matrix of the product with a vector (Lynch & Park, eq. 3.30)."""
    return np.array([[0, -v[2], v[1]], [v[2], 0, -v[0]], [-v[1], v[0], 0]])


def _blocks(matrices: Sequence[Sequence[Array]]) -> Iterator[Array]:
    """A matrix of blocks with the linear part first, and with the angular one first."""
    (a, b), (c, d) = matrices
    yield np.block([[a, b], [c, d]])
    yield np.block([[d, c], [b, a]])


def _twists(s: Array) -> Iterator[Array]:
    """The matrix of a twist (Lynch & Park, eq. 3.85), the angular part first, or the linear one."""
    for angular, linear in ((s[:3], s[3:]), (s[3:], s[:3])):
        yield np.block([[_cross(angular), linear[:, None]], [np.zeros((1, 4))]])


def _pose(turn: Array, place: Array) -> Array:
    return np.block([[turn, place[:, None]], [np.array([[0, 0, 0, 1.0]])]])


def _of_angle(call: Call) -> Iterator[Array]:
    """Elementary rotations and translations of a number (Spong, eq. 2.8 and 2.63)."""
    x, size = float(call[0][0]), call[1].shape[0]
    if size == 2:
        yield np.array([[np.cos(x), -np.sin(x)], [np.sin(x), np.cos(x)]])
        return
    for axis in _AXES:
        turn = expm(x * _cross(axis))
        yield turn if size == 3 else _pose(turn, np.zeros(3))
        if size == 4:
            yield _pose(np.eye(3), x * axis)


def _of_place(call: Call) -> Iterator[Array]:
    """A translation, by a vector or by its coordinates."""
    yield _pose(np.eye(3), np.hstack(call[0]))


def _of_a_row(call: Call) -> Iterator[Array]:
    """A row of a DH table, standard and modified, whatever its order (Craig, eq. 3.6)."""
    x, z = _AXES[0], _AXES[2]
    for a, alpha, d, theta in permutations(map(float, call[0])):
        about = _pose(expm(theta * _cross(z)), d * z)
        along = _pose(expm(alpha * _cross(x)), a * x)
        yield about @ along
        yield along @ about


def _adjoint(call: Call) -> Iterator[Array]:
    """Of a pose (Lynch & Park, definition 3.20)."""
    turn, place = call[0][0][:3, :3], call[0][0][:3, 3]
    yield from _blocks([[turn, _cross(place) @ turn], [np.zeros((3, 3)), turn]])


def _of_turn_and_place(call: Call) -> Iterator[Array]:
    """The adjoint, and Featherstone's transforms of motions (Rigid Body Dynamics, eq. 2.24)."""
    turn, place = call[0]
    if call[1].shape == (4, 4):
        yield _pose(turn, place)
        return
    nothing = np.zeros((3, 3))
    yield from _blocks([[turn, _cross(place) @ turn], [nothing, turn]])
    for axes in (turn, turn.T):
        yield from _blocks([[axes, -axes @ _cross(place)], [nothing, axes]])


def _crossed_twists(call: Call) -> Iterator[Array]:
    """The products of a twist with motions and with forces (Featherstone, eq. 2.31 and 2.32)."""
    (twist,) = call[0]
    first, last, nothing = _cross(twist[:3]), _cross(twist[3:]), np.zeros((3, 3))
    for motion in (
        np.block([[first, nothing], [last, first]]),  # the angular part first
        np.block([[last, first], [nothing, last]]),
    ):
        yield motion
        yield -motion.T


def _exponential(call: Call) -> Iterator[Array]:
    """Of a twist and an angle (Lynch & Park, eq. 3.88), of an axis and one (eq. 3.51)."""
    axis, angle = call[0]
    if len(axis) == 3:
        yield expm(float(angle) * _cross(axis))
    else:
        yield from (expm(float(angle) * one) for one in _twists(axis))


def _about_a_line(call: Call) -> Iterator[Array]:
    """A turn about an axis through a point (Lynch & Park, section 3.3.2.2)."""
    axis, point, angle = call[0]
    turn = expm(float(angle) * _cross(axis))
    yield _pose(turn, point - turn @ point)


def _less_turns(call: Call) -> Iterator[Array]:
    """An angle without whole turns, about nought or from it."""
    angle = float(call[0][0])
    yield np.array(np.arctan2(np.sin(angle), np.cos(angle)))
    yield np.array(angle % (2 * np.pi))


def _inverse(call: Call) -> Iterator[Array]:
    if abs(np.linalg.det(call[0][0])) > TOLERANCES.same_relation:
        yield np.asarray(np.linalg.inv(call[0][0]), dtype=float)
    else:
        yield np.zeros(call[1].shape)


_KNOWN: dict[tuple[tuple[Shape, ...], Shape], Known] = {
    (((),), ()): _less_turns,
    (((3,),), (3, 3)): lambda call: iter([_cross(call[0][0])]),
    (((),), (2, 2)): _of_angle,
    (((),), (3, 3)): _of_angle,
    (((),), (4, 4)): _of_angle,
    (((3,),), (4, 4)): _of_place,
    (((), (), ()), (4, 4)): _of_place,
    (((), (), (), ()), (4, 4)): _of_a_row,
    (((4, 4),), (4, 4)): _inverse,
    (((4, 4),), (6, 6)): _adjoint,
    (((6,),), (6, 6)): _crossed_twists,
    (((6,),), (4, 4)): lambda call: _twists(call[0][0]),
    (((6,), ()), (4, 4)): _exponential,
    (((3,), ()), (3, 3)): _exponential,
    (((3,), (3,), ()), (4, 4)): _about_a_line,
    (((3, 3), (3,)), (4, 4)): _of_turn_and_place,
    (((3, 3), (3,)), (6, 6)): _of_turn_and_place,
    (((3,), (3,)), (3,)): lambda call: iter([_cross(call[0][0]) @ call[0][1]]),
}
"""By the shapes of what is given and of the answer."""
