"""The minors of J as trigonometric polynomials: where all of them vanish the arm is singular.

Every entry of the base-frame J is of degree one in the cosine and sine of each revolute joint and
in each prismatic one, so that a minor with m rows is a polynomial of degree at most m in each. Its
coefficients follow from samples (a discrete Fourier transform), without algebra; the joints that
do not matter, and products over separate groups of joints, are read off them. About any centre it
can be written in 1, sin kx, 1 - cos kx, which bounds it over a box, linear part apart, to second
order: what a search with a proof needs.
"""

from __future__ import annotations

from dataclasses import dataclass
from itertools import combinations
from typing import Any
from weakref import WeakKeyDictionary

import numpy as np

from kinlab.analysis.structure.task_space import TaskSpace, revolute, search_box
from kinlab.arrays import Array
from kinlab.model.robot import Robot
from kinlab.tolerances import TOLERANCES

_SAMPLES = 17
"""Samples along one joint that show its degree, which is at most 6."""
_MOST = 40_000
"""Coefficients above which the polynomials are not formed."""


@dataclass(frozen=True)
class Factor:
    """Functions of a few joints whose common zeros are singular configurations.

    Attributes:
        joints: indices of the joints they depend on.
        degrees: degree in each.
        turns: which of them are revolute.
        coefficients: (b_1, ..., b_d, k) for k functions; along a revolute joint in the order
            1, cos, sin, cos 2q, sin 2q, ..., along a prismatic one in powers. Largest 1.
        codimension: 1 for one function, else how many equations a rank drop is.
    """

    joints: tuple[int, ...]
    degrees: tuple[int, ...]
    turns: tuple[bool, ...]
    coefficients: Array
    codimension: int

    @property
    def slack(self) -> float:
        """What rounding may do to a value."""
        return 1e-12 * float(
            np.abs(self.coefficients).sum(axis=tuple(range(len(self.joints)))).max()
        )

    def values(self, x: Array) -> tuple[Array, Array]:
        """Values (N, k) and gradients (N, k, d) at x (N, d)."""
        bases = [self._basis(i, x[:, i]) for i in range(len(self.joints))]
        gradient = np.empty((len(x), self.coefficients.shape[-1], len(self.joints)))
        for i in range(len(self.joints)):
            gradient[..., i] = self._contract([b[1 if i == j else 0] for j, b in enumerate(bases)])
        return self._contract([b[0] for b in bases]), gradient

    def _contract(self, vectors: list[Array]) -> Array:
        first, *rest = vectors
        out = np.tensordot(first, self.coefficients, axes=(1, 0))
        for vector in rest:
            out = np.einsum("nb,nb...->n...", vector, out)
        return out

    def _basis(self, i: int, x: Array) -> tuple[Array, Array]:
        degree = self.degrees[i]
        size = 2 * degree + 1 if self.turns[i] else degree + 1
        value, slope = np.zeros((len(x), size)), np.zeros((len(x), size))
        value[:, 0] = 1.0
        for k in range(1, degree + 1):
            if self.turns[i]:
                c, s = np.cos(k * x), np.sin(k * x)
                value[:, 2 * k - 1], value[:, 2 * k] = c, s
                slope[:, 2 * k - 1], slope[:, 2 * k] = -k * s, k * c
            else:
                value[:, k], slope[:, k] = x**k, k * x ** (k - 1)
        return value, slope

    def enclosures(self, centre: Array, half: Array) -> Enclosures:
        """The functions over boxes |x_i| <= half_i about centres, both (N, d)."""
        count, d = centre.shape
        local = np.broadcast_to(self.coefficients, (count, *self.coefficients.shape))
        axes = [self._local(i, centre[:, i], half[:, i]) for i in range(d)]
        for i, axis in enumerate(axes):
            shape = local.shape
            before = int(np.prod(shape[1 : 1 + i], dtype=int))
            cut = local.reshape(count, before, shape[1 + i], -1)
            local = np.einsum("nbc,nxbr->nxcr", axis.shift, cut).reshape(shape)
        origin: Array = local[_slices(d)]
        rest = np.abs(local)
        for axis in axes:
            rest = np.einsum("nb,nb...->n...", axis.bound, rest)
        rest -= np.abs(origin)
        gradient = np.empty((count, origin.shape[1], d))
        hessian = np.zeros((count, origin.shape[1], d, d))
        second = rest.copy()
        for i, one in enumerate(axes):
            along = local[_slices(d, i)]  # (N, b, k)
            gradient[..., i] = np.einsum("b,nbk->nk", one.slope, along)
            hessian[..., i, i] = np.einsum("b,nbk->nk", one.curve, along)
            # the absolute sum counted the linear part, of which only its bend stays
            rest -= np.einsum("nb,nbk->nk", one.straight - one.bend, np.abs(along))
            gone = one.bound * (one.linear | one.square) - one.bend - one.bulge
            second -= np.einsum("nb,nbk->nk", gone, np.abs(along))
            for j in range(i + 1, d):
                two = axes[j]
                cross = local[_slices(d, i, j)]  # (N, b, c, k)
                hessian[..., i, j] = np.einsum("b,c,nbck->nk", one.slope, two.slope, cross)
                hessian[..., j, i] = hessian[..., i, j]
                size = half[:, i, np.newaxis, np.newaxis] * half[:, j, np.newaxis, np.newaxis]
                product = one.slope[:, np.newaxis] * two.slope * size
                counted = (one.bound * one.linear)[:, :, np.newaxis] * (two.bound * two.linear)[
                    :, np.newaxis
                ]
                second -= np.einsum("nbc,nbck->nk", 2.0 * counted - product, np.abs(cross))
        return Enclosures(origin, gradient, rest + self.slack, hessian, second + self.slack)

    def _local(self, i: int, centre: Array, half: Array) -> _Axis:
        """From the global basis to 1, sin kx, 1 - cos kx (or powers of x) about centres (N,)."""
        degree, count = self.degrees[i], len(centre)
        size = 2 * degree + 1 if self.turns[i] else degree + 1
        shift, bound = np.zeros((count, size, size)), np.ones((count, size))
        slope, curve = np.zeros(size), np.zeros(size)
        bend, bulge = np.zeros((count, size)), np.zeros((count, size))
        shift[:, 0, 0] = 1.0
        if not self.turns[i]:
            for power in range(1, degree + 1):
                choose = 1.0
                for k in range(power + 1):
                    shift[:, power, k] = choose * centre ** (power - k)
                    choose *= (power - k) / (k + 1)
                bound[:, power] = half**power
            slope[1:2], curve[2:3] = 1.0, 2.0
            return _Axis(shift, bound, slope, curve, bend, bulge)
        for k in range(1, degree + 1):
            c, s, angle = np.cos(k * centre), np.sin(k * centre), k * half
            odd, even = 2 * k - 1, 2 * k
            shift[:, odd, 0], shift[:, odd, odd], shift[:, odd, even] = c, -s, -c
            shift[:, even, 0], shift[:, even, odd], shift[:, even, even] = s, c, -s
            bound[:, odd] = np.sin(np.minimum(angle, 0.5 * np.pi))
            bound[:, even] = 1.0 - np.cos(np.minimum(angle, np.pi))
            slope[odd], curve[even] = k, k**2
            # |kx - sin kx| and |k^2 x^2 / 2 - (1 - cos kx)| grow with |x|
            bend[:, odd] = angle - np.sin(angle)
            bulge[:, even] = 0.5 * angle**2 - (1.0 - np.cos(angle))
        return _Axis(shift, bound, slope, curve, bend, bulge)


@dataclass(frozen=True)
class Enclosures:
    """Functions over boxes, with bounds on what is left out.

    f(centre + x) = value + gradient . x + r with |r| <= rest, and
    f(centre + x) = value + gradient . x + x . hessian x / 2 + s with |s| <= second.

    Attributes:
        value: (N, k). gradient: (N, k, d). rest: (N, k). hessian: (N, k, d, d).
        second: (N, k).
    """

    value: Array
    gradient: Array
    rest: Array
    hessian: Array
    second: Array


@dataclass(frozen=True)
class _Axis:
    """One joint's local basis: shift matrices, bounds, slopes and second derivatives at zero, and
    how far each is from its linear or quadratic part."""

    shift: Array
    bound: Array
    slope: Array
    curve: Array
    bend: Array
    bulge: Array

    @property
    def linear(self) -> Any:
        return self.slope != 0.0

    @property
    def straight(self) -> Array:
        """Bounds of the linear functions; zero for the others."""
        return np.where(self.linear, self.bound, 0.0)

    @property
    def square(self) -> Any:
        return self.curve != 0.0


def _slices(d: int, *kept: int) -> tuple[Any, ...]:
    """All boxes, the whole axes ``kept``, and the constant along the others."""
    return (slice(None), *(slice(None) if i in kept else 0 for i in range(d)))


_KEPT: WeakKeyDictionary[Robot, dict[tuple[int, ...], tuple[Factor, ...] | None]] = (
    WeakKeyDictionary()
)


def factors(space: TaskSpace) -> tuple[Factor, ...] | None:
    """The singular set as a union of common zeros, each of functions of as few joints as can be.

    Args:
        space: the task.

    Returns:
        The factors; ``None`` where the polynomials would be too large.
    """
    kept = _KEPT.setdefault(space.robot, {})
    if space.rows not in kept:
        kept[space.rows] = _work_out(space)
    return kept[space.rows]


def _work_out(space: TaskSpace) -> tuple[Factor, ...] | None:
    robot = space.robot
    columns = list(combinations(range(robot.n), space.m))
    degrees = _degrees(space, columns)
    joints = tuple(i for i in range(robot.n) if degrees[i])
    turns = revolute(robot)
    counts = [2 * degrees[i] + 1 if turns[i] else degrees[i] + 1 for i in joints]
    if int(np.prod(counts, dtype=float)) * len(columns) > _MOST:
        return None
    lines, inverses = [], []
    for i, count in zip(joints, counts, strict=True):
        line, inverse = _line(robot, i, bool(turns[i]), count)
        lines.append(line)
        inverses.append(inverse)
    grid = np.stack(np.meshgrid(*lines, indexing="ij"), axis=-1).reshape(-1, len(joints))
    states = np.zeros((len(grid), robot.n))
    states[:, list(joints)] = grid
    tensor = _minors(space, states, columns).reshape(*counts, len(columns))
    for i, inverse in enumerate(inverses):
        tensor = np.moveaxis(np.tensordot(inverse, tensor, axes=(1, i)), 0, i)
    return _split(
        joints,
        tuple(degrees[i] for i in joints),
        tuple(bool(turns[i]) for i in joints),
        tensor,
        robot.n - space.m + 1,
    )


def _minors(space: TaskSpace, q: Array, columns: list[tuple[int, ...]]) -> Array:
    matrix = space.jacobian(q, space.scale)
    return np.stack([np.linalg.det(matrix[..., list(chosen)]) for chosen in columns], axis=-1)


def _degrees(space: TaskSpace, columns: list[tuple[int, ...]]) -> list[int]:
    """Degree of the minors in each joint, from lines through three points in general position."""
    robot = space.robot
    lower, upper = search_box(robot)
    turns = revolute(robot)
    drawn = np.random.default_rng(4).uniform(lower, upper, (3, robot.n))
    out = []
    for i in range(robot.n):
        line, inverse = _line(robot, i, bool(turns[i]), _SAMPLES if turns[i] else 7)
        states = np.repeat(drawn, len(line), axis=0)
        states[:, i] = np.tile(line, len(drawn))
        values = _minors(space, states, columns).reshape(len(drawn), len(line), -1)
        along = np.abs(np.einsum("ab,dbk->adk", inverse, values)).max(axis=(1, 2))
        if not turns[i]:  # powers of metres: weigh each by the size it has within the limits
            along *= np.abs(line).max() ** np.arange(len(line))
        there = np.flatnonzero(along > TOLERANCES.coefficient_rounding * along.max())
        last = int(there[-1]) if len(there) else 0
        out.append((last + 1) // 2 if turns[i] else last)
    return out


def _line(robot: Robot, i: int, turns: bool, count: int) -> tuple[Array, Array]:
    """Samples along a joint, and the matrix from values there to coefficients."""
    if turns:
        line = 2.0 * np.pi * np.arange(count) / count
        k = np.arange(1, (count - 1) // 2 + 1)
        basis = np.ones((count, count))
        basis[:, 1::2], basis[:, 2::2] = np.cos(np.outer(line, k)), np.sin(np.outer(line, k))
    else:
        lower, upper = search_box(robot)
        nodes = np.cos(np.pi * (np.arange(count) + 0.5) / count)
        line = 0.5 * (lower[i] + upper[i]) + 0.5 * (upper[i] - lower[i]) * nodes
        basis = np.vander(line, count, increasing=True)
    return line, np.asarray(np.linalg.inv(basis), dtype=np.float64)


def _split(
    joints: tuple[int, ...],
    degrees: tuple[int, ...],
    turns: tuple[bool, ...],
    tensor: Array,
    codimension: int,
) -> tuple[Factor, ...]:
    """Takes factors over separate groups of joints apart."""
    d = len(joints)
    if not d:
        return ()
    least = TOLERANCES.coefficient_rounding * np.abs(tensor).max()
    tensor = np.where(np.abs(tensor) < least, 0.0, tensor)
    if d > 1:
        for i in range(d):
            divided = _divide(tensor, i) if turns[i] else None
            if divided is not None:
                line, quotient = divided
                fewer = degrees[i] - 1
                left = tuple(k for k in range(d) if k != i or fewer)
                lower = tuple(fewer if k == i else degrees[k] for k in left)
                if not fewer:
                    quotient = quotient[(slice(None),) * i + (0,)]
                return (
                    Factor((joints[i],), (1,), (True,), line, 1),
                    *_split(
                        tuple(joints[k] for k in left),
                        lower,
                        tuple(turns[k] for k in left),
                        quotient,
                        codimension,
                    ),
                )
    for size in range(1, d):
        for group in combinations(range(d), size):
            rest = [i for i in range(d) if i not in group]
            if tensor.shape[-1] == 1 and 2 * size > d:
                continue
            moved = np.moveaxis(tensor, group, range(size))
            shape = moved.shape
            flat = moved.reshape(int(np.prod(shape[:size])), -1)
            columns, sizes, rows = np.linalg.svd(flat, full_matrices=False)
            if len(sizes) > 1 and sizes[1] > TOLERANCES.coefficient_rounding * sizes[0]:
                continue
            one = columns[:, 0].reshape(*shape[:size], 1)
            two = rows[0].reshape(shape[size:])
            parts: tuple[Factor, ...] = ()
            for chosen, part, equations in ((list(group), one, 1), (rest, two, codimension)):
                parts += _split(
                    tuple(joints[k] for k in chosen),
                    tuple(degrees[k] for k in chosen),
                    tuple(turns[k] for k in chosen),
                    part,
                    equations,
                )
            return parts
    functions = np.moveaxis(tensor, -1, 0).reshape(tensor.shape[-1], -1)
    _, sizes, right = np.linalg.svd(functions, full_matrices=False)
    counts = sizes > TOLERANCES.coefficient_rounding * sizes[0]
    # independent combinations, the strongest first
    kept = right[counts] * (sizes[counts] / sizes[0])[:, np.newaxis]
    alone = len(kept) == 1
    coefficients = np.moveaxis(kept.reshape(len(kept), *tensor.shape[:-1]), 0, -1)
    coefficients = coefficients / np.abs(coefficients).max()
    return (Factor(joints, degrees, turns, coefficients, 1 if alone else codimension),)


def _divide(tensor: Array, i: int) -> tuple[Array, Array] | None:
    """Takes a factor a + b cos q_i + c sin q_i with two zeros out of all functions.

    Returns:
        The factor's coefficients (3, 1), and the quotient, of one degree less along axis i.
    """
    moved = np.moveaxis(tensor, i, 0)
    flat = moved.reshape(len(moved), -1)
    degree = (len(flat) - 1) // 2
    _, sizes, right = np.linalg.svd(flat.T, full_matrices=False)
    rows = sizes[:, np.newaxis] * right / sizes[0]  # the same zeros, (<= b, b)
    roots = _zeros(rows, degree)
    for one, two in combinations(roots, 2):
        # 2 sin((q - one)/2) sin((q - two)/2) = cos((one - two)/2) - cos(q - (one + two)/2)
        middle = 0.5 * (one + two)
        line = np.array([np.cos(0.5 * (one - two)), -np.cos(middle), -np.sin(middle)])
        line[np.abs(line) < TOLERANCES.coefficient_rounding] = 0.0
        times = _products(line, degree - 1)
        quotient = np.asarray(np.linalg.lstsq(times, flat, rcond=None)[0], dtype=np.float64)
        rest = np.abs(times @ quotient - flat).max()
        if rest <= 1e3 * TOLERANCES.coefficient_rounding * np.abs(flat).max():
            shaped = quotient.reshape(2 * degree - 1, *moved.shape[1:])
            return line[:, np.newaxis] / np.abs(line).max(), np.moveaxis(shaped, 0, i)
    return None


def _zeros(rows: Array, degree: int) -> list[float]:
    """Angles at which all trigonometric polynomials (k, 2 degree + 1) vanish, each once."""
    # z = exp(iq): each row is z^-degree times a polynomial of degree 2 degree
    weights = np.zeros(2 * degree + 1, dtype=complex)
    weights[degree] = rows[0, 0]
    for k in range(1, degree + 1):
        cosine, sine = rows[0, 2 * k - 1], rows[0, 2 * k]
        weights[degree + k] = 0.5 * (cosine - 1j * sine)
        weights[degree - k] = 0.5 * (cosine + 1j * sine)
    roots = np.roots(weights[::-1])
    # a zero of multiplicity m comes as m roots around it, some 1e-16^(1/m) away; their mean is
    # as good as a simple root
    means = [roots[np.abs(roots - z) < TOLERANCES.root_crowd].mean() for z in roots]
    orders = np.arange(1, degree + 1)
    found = []
    for z in [*means, *roots]:
        if abs(abs(z) - 1.0) > 1e-5:
            continue
        q = float(np.angle(z))
        basis = np.ones(2 * degree + 1)
        basis[1::2], basis[2::2] = np.cos(orders * q), np.sin(orders * q)
        found.append((float(np.abs(rows @ basis).max()), q))
    out: list[float] = []
    # the means stand first: of equally small values the mean is taken
    for value, q in sorted(found, key=lambda one: one[0] > 1e-14):
        if value < 1e-8 and all(abs(np.sin(0.5 * (q - other))) > 1e-4 for other in out):
            out.append(q)
    return sorted(out)


def _products(line: Array, degree: int) -> Array:
    """The matrix that multiplies trigonometric polynomials of a degree by ``line``."""
    size = 2 * degree + 3
    q = 2.0 * np.pi * np.arange(size) / size
    k = np.arange(1, degree + 2)
    whole = np.ones((size, size))
    whole[:, 1::2], whole[:, 2::2] = np.cos(np.outer(q, k)), np.sin(np.outer(q, k))
    values = whole[:, :3] @ line
    right = values[:, np.newaxis] * whole[:, : 2 * degree + 1]
    return np.asarray(np.linalg.solve(whole, right), dtype=np.float64)
