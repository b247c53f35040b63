"""Cusps, crossings and nodes of the singular curves of a 3R arm, by exact conditions.

Joints 2 and 3 map to (rho^2, z), the square of the distance from the first axis and the height
along it: trigonometric polynomials of degree two at most, read off 25 samples. With D their
Jacobian determinant the arm is singular where D = 0. There the map has a cusp where D is stationary
along the kernel too: three solutions run together. Where D itself is stationary, singular curves
cross in joint space and the arm is not generic. Both sets are enclosed in boxes of the whole torus
of joints 2 and 3, so that none is missed (two within 0.02 rad may count as one); each is solved to
rounding. A node is a point of the section that two singular configurations share.

El Omri & Wenger, "How to recognize simply a non-singular posture changing 3-DOF manipulator", ICAR
1995; Baili, Wenger & Chablat, "Kinematic analysis of a family of 3R manipulators", IFToMM Problems
of Mechanics 15(2), 2004; Pai & Leu, "Genericity and singularities of robot manipulators", IEEE
Trans. Robotics and Automation 8(5), 1992.
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any

import numpy as np

from kinlab.analysis.singularities.factor import Factor
from kinlab.analysis.singularities.minors import factors
from kinlab.analysis.structure.axes import Axes, first_axis
from kinlab.analysis.structure.task_space import read_task, revolute
from kinlab.arrays import Array
from kinlab.engine.kinematics import fk
from kinlab.errors import OptionError
from kinlab.model.robot import Robot
from kinlab.tolerances import TOLERANCES

_DEPTH = 12
"""Halvings of the torus' 8 x 8 boxes before the boxes that are left are solved in."""
_MOST = 6_000
"""Boxes above which the zeros are taken to be curves, and nothing is said."""
_NEAR = 2e-2
"""rad around a solved zero in which boxes belong to it."""


@dataclass(frozen=True, eq=False)
class Part:
    """One factor f of D.

    Attributes:
        value: f. cusp: f and its change along both forms of the kernel of the map. crossing: f and
            its gradient.
        collapsed: f depends on one joint, and the other moves nothing at its zeros: each of these
            lines of the torus is one point of the section (the tool on the axis of joint 2, say).
    """

    value: Factor
    cusp: Factor
    crossing: Factor
    collapsed: bool


@dataclass(frozen=True, eq=False)
class Regional:
    """What joints 2 and 3 of a 3R arm do in the half plane through its first axis.

    Attributes:
        robot: the arm. origin, axis: of its first joint, (3,), as in
            :class:`kinlab.analysis.workspace.sections.WorkspaceSection`.
        size: metres, that lengths are divided by.
        map: rho^2 and z over size; functions of joints 2 and 3.
        determinant: D. parts: its factors.
    """

    robot: Robot
    origin: Array
    axis: Array
    size: float
    map: Factor
    determinant: Factor
    parts: tuple[Part, ...]

    @classmethod
    def of(cls, robot: Robot) -> Regional:
        """Reads the polynomials off samples.

        Raises:
            OptionError: not three revolute joints that place a point in space, or D is zero
                everywhere.
        """
        if not is_regional(robot):
            raise OptionError(
                f"robot {robot.name!r}: cusps and nodes are for three revolute joints that place a "
                "point in space"
            )
        origin, axis = first_axis(robot)
        x = _grid(2)
        q = np.concatenate([np.zeros((len(x), 1)), x], axis=1)
        apart = fk(robot, q)[:, :3, 3] - origin
        z = apart @ axis
        square = np.sum(apart**2, axis=1) - z**2
        size = float(np.sqrt(np.max(square + z**2)))
        place = _factor(np.stack([square / size**2, z / size], axis=1), 2)
        x = _grid(6)
        _, slope = place.values(x)
        if not np.abs(_det(slope)).max() > 1e-12:
            raise OptionError(f"robot {robot.name!r}: singular everywhere in the section")
        parts = []
        for part in factors(read_task(robot, "auto")) or ():
            parts.append(_part(part, place, slope, x))
        return cls(
            robot, origin, axis, size, place, _factor(_det(slope)[:, np.newaxis], 6), tuple(parts)
        )

    def points(self, x: Array) -> Array:
        """(rho, z) in metres of joints 2 and 3 at x (N, 2), (N, 2)."""
        value, _ = self.map.values(x)
        rho = np.sqrt(np.maximum(value[:, 0], 0.0))
        return self.size * np.stack([rho, value[:, 1]], axis=1)


@dataclass(frozen=True, eq=False)
class SingularPoints:
    """Special points of the singular curves, whole turns left out.

    Attributes:
        cusps: joints 2 and 3, (K, 2). crossings: where singular curves cross in joint space.
        complete: the boxes show that there are no others but within 0.02 rad of these; False:
            zeros may be missing, as where they are curves.
    """

    cusps: Array
    crossings: Array
    complete: bool

    @property
    def generic(self) -> bool:
        """Whether no singular curves cross; shown where ``complete``."""
        return not len(self.crossings)


def is_regional(robot: Robot) -> bool:
    """Whether an arm is three revolute joints that place a point in space."""
    if robot.n != 3 or not bool(np.all(revolute(robot))):
        return False
    parallel = np.linalg.norm(np.cross(*Axes.at(robot, np.zeros(3)).direction[:2])) < 1e-9
    task = read_task(robot, "auto")
    return task.rows == (0, 1, 2) and not (parallel and task.m < 3)


def singular_points(arm: Regional) -> SingularPoints:
    """All cusps and crossings."""
    complete = True
    crossings, cusps = np.empty((0, 2)), np.empty((0, 2))
    for i, part in enumerate(arm.parts):
        systems = [part.crossing]
        for other in arm.parts[:i]:
            both = np.concatenate([part.value.coefficients, other.value.coefficients], axis=-1)
            systems.append(Factor((1, 2), (6, 6), (True, True), both, 1))
        for system in systems:
            zeros, every = _zeros(system, crossings)
            crossings, complete = np.concatenate([crossings, zeros]), complete and every
    for part in arm.parts:
        if not part.collapsed:
            zeros, every = _zeros(part.cusp, crossings)
            away = np.array([not _close(x, crossings, _NEAR) for x in zeros], dtype=bool)
            cusps, complete = np.concatenate([cusps, zeros[away]]), complete and every
    return SingularPoints(cusps, crossings, complete)


def _part(part: Factor, place: Factor, slope: Array, x: Array) -> Part:
    """A factor with the systems of its cusps and crossings, from samples at x (N, 2)."""
    own = [j - 1 for j in part.joints]
    value, own_slope = part.values(x[:, own])
    change = np.zeros((len(x), 2))
    change[:, own] = own_slope[:, 0]
    along = [change[:, 1] * slope[:, k, 0] - change[:, 0] * slope[:, k, 1] for k in (0, 1)]
    single = len(own) == 1 and _collapses(part, place, own[0])
    return Part(
        _factor(value, 6),
        _factor(np.stack([value[:, 0], *along], axis=1), 6),
        _factor(np.column_stack([value[:, 0], change]), 6),
        single,
    )


def _collapses(part: Factor, place: Factor, joint: int) -> bool:
    """Whether the other joint moves nothing where a function of one joint is zero."""
    line = np.linspace(-np.pi, np.pi, 400)[:, np.newaxis]
    value = part.values(line)[0][:, 0]
    roots = line[:-1][(value[:-1] > 0.0) != (value[1:] > 0.0)]
    for _ in range(30):
        value_, slope = part.values(roots)
        roots = roots - value_ / slope[:, 0]
    if not len(roots):
        return False
    x = np.zeros((5 * len(roots), 2))
    x[:, joint] = np.repeat(roots[:, 0], 5)
    x[:, 1 - joint] = np.tile([-2.0, -1.0, 0.3, 1.1, 2.5], len(roots))
    return bool(np.abs(place.values(x)[1][:, :, 1 - joint]).max() < 1e-9)


def singular_segments(arm: Regional, cells: int = 240) -> Array:
    """D = 0 on the torus of joints 2 and 3 as short segments, their ends on the curve, (M, 2, 2).

    Lines that are one point of the section each are left out (:func:`collapsed_points`).

    Args:
        arm: the arm. cells: of the torus along each joint; curves within one cell are missed.
    """
    return _by_part(arm, cells)[0]


def _by_part(arm: Regional, cells: int = 240) -> tuple[Array, Any]:
    """The segments, and the number of the factor that each is a zero of, (M,)."""
    chosen = [i for i, part in enumerate(arm.parts) if not part.collapsed]
    pieces = [_segments(arm.parts[i].value, cells) for i in chosen]
    numbers = np.repeat(np.array(chosen, dtype=np.int64), [len(piece) for piece in pieces])
    return np.concatenate([np.empty((0, 2, 2)), *pieces]), numbers


def collapsed_points(arm: Regional) -> Array:
    """Points (rho, z) of the section that a whole line of singular configurations is, (K, 2)."""
    found = [np.empty((0, 2))]
    for part in arm.parts:
        if part.collapsed:
            points = arm.points(_segments(part.value, 240)[:, 0])
            _, first = np.unique(np.round(points / arm.size, 6), axis=0, return_index=True)
            found.append(points[first])
    return np.concatenate(found)


def _segments(function: Factor, cells: int) -> Array:
    """Zeros of a function on the torus, by marching squares and Newton's steps."""
    line = -np.pi + 2.0 * np.pi * np.arange(cells) / cells + 0.3 / cells
    corners = np.stack(np.meshgrid(line, line, indexing="ij"), axis=-1)
    value = function.values(corners.reshape(-1, 2))[0].reshape(cells, cells)
    step = 2.0 * np.pi / cells
    square = step * np.array([[0, 0], [1, 0], [1, 1], [0, 1]])
    at = np.stack([np.roll(value, (-i, -j), (0, 1)) for i, j in ((0, 0), (1, 0), (1, 1), (0, 1))])
    cut = (at > 0.0) != (np.roll(at, -1, axis=0) > 0.0)  # the four sides of each cell
    segments: list[Array] = []
    for i, j in zip(*np.nonzero(cut.any(axis=0)), strict=True):
        ends = []
        for k in np.flatnonzero(cut[:, i, j]):
            one, two = at[k, i, j], at[(k + 1) % 4, i, j]
            share = one / (one - two)
            ends.append(corners[i, j] + square[k] + share * (square[(k + 1) % 4] - square[k]))
        if len(ends) == 4:  # a saddle: its middle tells which sides belong together
            middle = function.values(corners[i, j][np.newaxis] + 0.5 * step)[0][0, 0]
            if (middle > 0.0) == (at[0, i, j] > 0.0):
                ends = [ends[0], ends[1], ends[2], ends[3]]
            else:
                ends = [ends[3], ends[0], ends[1], ends[2]]
            segments.append(np.array(ends[2:]))
        segments.append(np.array(ends[:2]))
    flat = np.reshape(segments, (-1, 2))
    for _ in range(4):
        d, slope = function.values(flat)
        square_ = np.maximum(np.sum(slope[:, 0] ** 2, axis=1), 1e-12)
        move = -(d[:, 0] / square_)[:, np.newaxis] * slope[:, 0]
        flat = flat + np.clip(move, -0.2 * step, 0.2 * step)
    return flat.reshape(-1, 2, 2)


def nodes(arm: Regional, cusps: Array) -> Array:
    """Points that the singular curves pass twice, from crossings of their images.

    Args:
        arm: the arm. cusps: as found, (K, 2).

    Returns:
        Joints 2 and 3 on the one curve and on the other, (M, 4); found, not shown to be all.
    """
    segments, part = _by_part(arm)
    one, two = segments[:, 0], segments[:, 1]
    found: list[Array] = []
    for i, j in _crossing_segments(arm.points(one), arm.points(two)):
        if _close(one[i], one[j][np.newaxis], 0.1):
            continue
        functions = arm.parts[part[i]].value, arm.parts[part[j]].value
        solved = _solve_node(
            arm, functions, 0.5 * np.concatenate([one[i] + two[i], one[j] + two[j]])
        )
        if solved is None:
            continue
        a, b = _wrapped(solved[:2]), _wrapped(solved[2:])
        if _close(a, b[np.newaxis], 1e-3) or _close(a, cusps, 1e-3):
            continue
        pair = np.concatenate([a, b] if tuple(a) <= tuple(b) else [b, a])
        place = arm.points(pair[np.newaxis, :2])[0]
        if all(
            np.linalg.norm(arm.points(p[np.newaxis, :2])[0] - place) > 1e-6 * arm.size
            for p in found
        ):
            found.append(pair)
    return np.reshape(found, (-1, 4))


def _grid(degree: int) -> Array:
    line = 2.0 * np.pi * np.arange(2 * degree + 1) / (2 * degree + 1)
    return np.stack(np.meshgrid(line, line, indexing="ij"), axis=-1).reshape(-1, 2)


def _factor(values: Array, degree: int) -> Factor:
    """The trigonometric polynomials with these values (N, k) on :func:`_grid`."""
    size = 2 * degree + 1
    line = 2.0 * np.pi * np.arange(size) / size
    basis = np.ones((size, size))
    orders = np.arange(1, degree + 1)
    basis[:, 1::2], basis[:, 2::2] = np.cos(np.outer(line, orders)), np.sin(np.outer(line, orders))
    inverse = np.linalg.inv(basis)
    grid = values.reshape(size, size, -1)
    coefficients = np.einsum("ai,bj,ijk->abk", inverse, inverse, grid)
    small = np.abs(coefficients) < 1e-14 * np.abs(coefficients).max()
    return Factor((1, 2), (degree, degree), (True, True), np.where(small, 0.0, coefficients), 1)


def _det(slope: Array) -> Array:
    found: Array = slope[:, 0, 0] * slope[:, 1, 1] - slope[:, 0, 1] * slope[:, 1, 0]
    return found


def _wrapped(x: Array) -> Array:
    out: Array = np.mod(x + np.pi, 2.0 * np.pi) - np.pi
    return out


def _close(x: Array, others: Array, within: float) -> bool:
    return bool(len(others)) and bool(np.any(np.abs(_wrapped(others - x)).max(axis=1) < within))


def _zeros(system: Factor, known: Array) -> tuple[Array, bool]:
    """Common zeros on the torus apart from those known, and whether these are all."""
    line = -np.pi + 2.0 * np.pi * (np.arange(8) + 0.5) / 8
    centre = np.stack(np.meshgrid(line, line, indexing="ij"), axis=-1).reshape(-1, 2)
    half = np.pi / 8
    for level in range(_DEPTH + 1):
        over = system.enclosures(centre, np.full(centre.shape, half))
        reach = half * np.abs(over.gradient).sum(axis=2) + over.rest
        centre = centre[np.all(np.abs(over.value) <= reach, axis=1)]
        if not len(centre):
            return centre, True
        if len(centre) > _MOST:
            return np.empty((0, 2)), False
        if level < _DEPTH:
            half *= 0.5
            offsets = half * np.array([[-1, -1], [-1, 1], [1, -1], [1, 1]])
            centre = (centre[:, np.newaxis] + offsets).reshape(-1, 2)
    found: list[Array] = []
    _, thin = np.unique(np.round(centre / 5e-3), axis=0, return_index=True)
    for x in _newton(system, centre[thin]):
        x = _wrapped(x)
        if not _close(x, np.reshape(found, (-1, 2)), TOLERANCES.same_zero):
            found.append(x)
    zeros = np.reshape(found, (-1, 2))
    near = np.concatenate([zeros, known])
    every = all(_close(x, near, _NEAR) for x in centre)
    order = np.lexsort(zeros.round(6).T[::-1]) if len(zeros) else np.zeros(0, dtype=int)
    return zeros[order], every


def _newton(system: Factor, x: Array) -> Array:
    """Gauss-Newton from x (N, 2); those that reach a zero."""
    if not len(x):
        return x
    start = x
    for _ in range(40):
        value, slope = system.values(x)
        step = -np.einsum("ndk,nk->nd", np.linalg.pinv(slope, rcond=1e-8), value)
        size = np.linalg.norm(step, axis=1, keepdims=True)
        x = x + step * np.minimum(1.0, 0.1 / np.maximum(size, 1e-300))
    value, _ = system.values(x)
    scale = np.abs(system.coefficients).sum(axis=(0, 1))
    good = np.all(np.abs(value) < 1e-11 * scale, axis=1)
    good &= np.abs(_wrapped(x - start)).max(axis=1) < _NEAR
    out: Array = x[good]
    return out


def _crossing_segments(one: Array, two: Array) -> list[tuple[int, int]]:
    """Pairs of segments of the plane, ends (N, 2) each, that cross."""
    along = two - one
    found: list[tuple[int, int]] = []
    for i in range(len(one)):
        u, v, w = along[i], along[i + 1 :], one[i + 1 :] - one[i]
        cross = u[0] * v[:, 1] - u[1] * v[:, 0]
        with np.errstate(divide="ignore", invalid="ignore"):
            s = (w[:, 0] * v[:, 1] - w[:, 1] * v[:, 0]) / cross
            t = (w[:, 0] * u[1] - w[:, 1] * u[0]) / cross
        size = np.linalg.norm(v, axis=1) * np.linalg.norm(u)
        # images that lie on one another meet at no angle: no node
        hit = (
            (np.abs(cross) > TOLERANCES.crossing_sine * size)
            & (s >= -0.01)
            & (s <= 1.01)
            & (t >= -0.01)
            & (t <= 1.01)
        )
        found.extend((i, i + 1 + int(j)) for j in np.flatnonzero(hit) if j > 0)
    return found


def _solve_node(arm: Regional, functions: tuple[Factor, Factor], x: Array) -> Array | None:
    """Two singular configurations at one point: four equations in x (4,)."""
    start = x
    for _ in range(30):
        one, two = x[np.newaxis, :2], x[np.newaxis, 2:]
        (p, dp), (r, dr) = arm.map.values(one), arm.map.values(two)
        (d, dd), (e, de) = functions[0].values(one), functions[1].values(two)
        value = np.concatenate([p[0] - r[0], d[0], e[0]])
        slope = np.zeros((4, 4))
        slope[:2, :2], slope[:2, 2:] = dp[0], -dr[0]
        slope[2, :2], slope[3, 2:] = dd[0, 0], de[0, 0]
        step = -np.linalg.pinv(slope, rcond=1e-10) @ value
        x = x + step * min(1.0, 0.2 / max(float(np.linalg.norm(step)), 1e-300))
    # curves whose images lie on one another share every point: none of these is a node
    values = np.linalg.svd(slope, compute_uv=False)
    good = np.abs(value).max() < 1e-10 and values[-1] > 1e-5 * values[0]
    return x if good and np.abs(x - start).max() < 0.3 else None
