"""The minors of J as trigonometric polynomials: where all of them vanish the arm is singular.

Every entry of the base-frame J is of degree one in the cosine and sine of each revolute joint and
in each prismatic one, so that a minor with m rows is a polynomial of degree at most m in each. Its
coefficients follow from samples (a discrete Fourier transform), without algebra; the joints that
do not matter, and products over separate groups of joints, are read off them.
"""

from __future__ import annotations

from itertools import combinations
from weakref import WeakKeyDictionary

import numpy as np

from kinlab.analysis.singularities.factor import Factor
from kinlab.analysis.structure.task_space import TaskSpace, revolute, search_box
from kinlab.arrays import Array
from kinlab.model.robot import Robot
from kinlab.tolerances import TOLERANCES

_SAMPLES = 17
"""Samples along one joint that show its degree, which is at most 6."""
_MOST = 40_000
"""Coefficients above which the polynomials are not formed."""

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
