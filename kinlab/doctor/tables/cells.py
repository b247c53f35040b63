"""Cells that are solved for: which one or two numbers, changed, give the reference's poses?

A wrong cell moves what lies behind it by the same elementary motion at every state. Seen from the
cell's own frame F the difference of the poses, F^-1 T_ref T^-1 F, is then that motion: constant
over the states, about or along one axis. No value is guessed and no list is gone through.
Two turns are solved in closed form (subproblem 2 of Paden and Kahan without its ambiguity, for
the states are many), lengths by linear least squares once the rotations agree.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace
from itertools import combinations

import numpy as np
from numpy.typing import NDArray

from kinlab.arrays import Array
from kinlab.doctor.tables.chain import (
    ALPHA,
    AXIS_OF,
    COLUMNS,
    THETA,
    A,
    Chain,
    D,
    frames,
    inverse,
    row_of,
    row_transform,
    stacked_frames,
)
from kinlab.doctor.tables.readings import Reading
from kinlab.doctor.tables.reference.target import Target
from kinlab.doctor.tables.words import (
    Cause,
    angle_cause,
    degrees,
    length_cause,
    number,
    pose_cause,
    tidy_length,
    wrapped,
)
from kinlab.host.language import _
from kinlab.model.rotations import about_axis
from kinlab.tolerances import TOLERANCES


def one_change(bases: Sequence[Reading], target: Target) -> list[Reading]:
    """Every way to meet the target by one more change: a cell, a row, the base, the tool.

    Args:
        bases: readings to start from.
        target: poses; causes are looked for on its first states and confirmed on all.

    Returns:
        Readings that meet the target; those of one row may hold two causes.
    """
    few = target.few
    found: list[Reading] = []
    for start in range(0, len(bases), 64):
        part = bases[start : start + 64]
        poses = stacked_frames([one.chain for one in part], few.q)
        gap, last = differences(poses, few)
        steady, fixed = spread(gap, target.size), spread(last, target.size)
        for k, first in enumerate(part):
            n = first.chain.n
            for frame in np.flatnonzero(steady[k] <= target.steady):
                motion = np.mean(gap[k, :, frame], axis=0)
                found += _readings_at(first, int(frame), motion, target)
                if frame == 0:
                    found += _ends(first, "base", first.chain.base @ motion, target)
            if fixed[k] <= target.steady and n:
                motion = np.mean(last[k], axis=0)
                found += _ends(first, "tool", first.chain.tool @ motion, target)
    return found


def differences(poses: Array, target: Target) -> tuple[Array, Array]:
    """F^-1 T_ref T^-1 F for frames 0 to n, (K, N, n + 1, 4, 4), and T^-1 T_ref, (K, N, 4, 4)."""
    back = inverse(poses[:, :, -1])
    world = target.poses @ back
    own = poses[:, :, :-1]
    return inverse(own) @ (world[:, :, None] @ own), back @ target.poses


def spread(motion: Array, size: float) -> Array:
    """Largest change over the states (axis 1), lengths over the arm's size."""
    spread = np.abs(motion - motion[:, :1])
    spread[..., :3, 3] /= size
    out: Array = np.max(spread, axis=(1, -2, -1))
    return out


def _readings_at(first: Reading, frame: int, motion: Array, target: Target) -> list[Reading]:
    """What a constant motion in a frame means: cells about or along one axis, or a whole row."""
    chain = first.chain
    z_row, x_row = (frame - 1, frame) if chain.modified else (frame, frame - 1)
    found = []
    for row, turn, slide in ((z_row, THETA, D), (x_row, ALPHA, A)):
        if not 0 <= row < chain.n:
            continue
        angle, length, rest = screw(motion, AXIS_OF[turn])
        if rest > target.steady * target.size:
            continue
        changes = {}
        if abs(angle) > target.steady:
            changes[turn] = wrapped(float(chain.cells[row, turn]) + angle)
        if abs(length) > target.steady * target.size:
            written = float(chain.cells[row, slide])
            changes[slide] = tidy_length(written + length, written)
        if changes:
            found.append(changed(first, {(row, c): v for c, v in changes.items()}, target.slack))
    row = frame if chain.modified else frame - 1
    if 0 <= row < chain.n:
        found += _whole_row(first, row, motion, target)
    return [one for one in found if target.met(one.chain)]


def screw(motion: Array, axis: int) -> tuple[float, float, float]:
    """Angle about and length along a coordinate axis, and how far the motion is from them."""
    u, v = (axis + 1) % 3, (axis + 2) % 3
    angle = float(np.arctan2(motion[v, u] - motion[u, v], motion[u, u] + motion[v, v]))
    length = float(motion[axis, 3])
    rest = np.array(motion)
    rest[axis, 3] = 0.0
    rest[:3, :3] -= about_axis(axis, angle)
    rest[3, 3] = 0.0
    return angle, length, float(np.max(np.abs(rest)))


def changed(first: Reading, values: dict[tuple[int, int], float], slack: float = 0.0) -> Reading:
    """A reading with cells replaced, each a cause of its own.

    Args:
        first: the reading.
        values: by 0-based row and column, as solved for.
        slack: how far these may be off, rad and m; a relation that gives a number within it
            tells what is meant.
    """
    chain, causes = first.chain, list(first.causes)
    for (row, column), value in sorted(values.items()):
        written = float(chain.cells[row, column])
        name = COLUMNS[column]
        if column in (ALPHA, THETA):
            cause = angle_cause(row + 1, name, written, value, max(slack, TOLERANCES.solved_angle))
        else:
            slides = bool(chain.prismatic[row])
            cause = length_cause(row + 1, name, written, value, slides, slack)
        causes.append(cause)
        chain = chain.with_cell(row, column, float(cause.meant))
    return Reading(chain, tuple(causes))


def _ends(first: Reading, which: str, meant: Array, target: Target) -> list[Reading]:
    written = getattr(first.chain, which)
    pose = _tidy_pose(meant)
    if np.max(np.abs(pose - written)) <= target.tolerance:
        return []
    cause = pose_cause(which, written, pose, None, target.slack)
    pose = cause.meant
    one = Reading(replace(first.chain, **{which: pose}), (*first.causes, cause))
    return [one] if target.met(one.chain) else []


def _tidy_pose(pose: Array) -> Array:
    out = np.array(pose)
    near = np.round(out, 9)
    out = np.where(np.abs(near - out) < 1e-12, near + 0.0, out)
    out[3] = (0.0, 0.0, 0.0, 1.0)
    return out


def _whole_row(first: Reading, row: int, motion: Array, target: Target) -> list[Reading]:
    """The row that a constant motion makes of a row: two cells of it, or a row written twice."""
    chain = first.chain
    step = row_transform(chain.modified, chain.cells[row])
    moved = motion @ step if chain.modified else step @ motion
    solved = row_of(chain.modified, moved, target.steady)
    if solved is None:
        return []
    written = chain.cells[row]
    values = {}
    for column in range(4):
        if column in (ALPHA, THETA):
            value = wrapped(float(solved[column]))
            same = abs(wrapped(value - float(written[column]))) < target.steady
        else:
            value = tidy_length(float(solved[column]), float(written[column]))
            same = abs(value - written[column]) < 0.1 * target.steady * target.size
        if not same:
            values[row, column] = value
    if not values:
        return []
    if len(values) <= 2:
        return [changed(first, values, target.slack)]
    new = chain
    for (_row, column), value in values.items():
        new = new.with_cell(row, column, value)
    told = row_text(new.cells[row])
    for other in (row - 1, row + 1):
        if 0 <= other < chain.n and np.array_equal(chain.cells[other], written):
            said = _("row {row} repeats row {other}: meant is {meant}").format(
                row=row + 1, other=other + 1, meant=told
            )
            cause = Cause(row + 1, "order", written, new.cells[row], "doubled", said, 1.2)
            return [Reading(new, (*first.causes, cause))]
    return []


def row_text(row: Array) -> str:
    """A row in words."""
    a, d = number(row[A]), number(row[D])
    return f"a {a}, alpha {degrees(row[ALPHA])}, d {d}, theta {degrees(row[THETA])}"


def two_cells(chain: Chain, target: Target) -> list[Reading]:
    """Every way to meet the target by changing two cells of the user's table."""
    found = _two_angles(chain, target)
    plain = Reading(chain)
    found += _lengths(plain, target, 2)
    for turned in _turned(chain, target):
        found += _lengths(turned, target, 1)
    return [one for one in found if target.met(one.chain)]


def _two_angles(chain: Chain, target: Target) -> list[Reading]:
    few = target.few
    poses = frames(chain, few.q)
    world = few.poses @ inverse(poses[:, -1])
    cells = _in_order(chain, (ALPHA, THETA))
    pairs = list(combinations(cells, 2))
    if not pairs:
        return []
    one, two = ([chain.frame_of(*pair[k]) for pair in pairs] for k in (0, 1))
    before = inverse(poses[:, one])
    between = before @ poses[:, two]  # (N, P, 4, 4)
    wanted = before @ (world[:, None] @ poses[:, two])
    axis1 = np.array([AXIS_OF[pair[0][1]] for pair in pairs])
    axis2 = np.array([AXIS_OF[pair[1][1]] for pair in pairs])
    each = np.arange(len(pairs))
    # what the second turn leaves alone: its own axis and a point on it
    was, shall = (
        np.concatenate([_columns(x, axis2), x[..., :3, 3] / target.size]) for x in (between, wanted)
    )  # (2N, P, 3)
    still = np.max(np.abs(was[:, each, axis1] - shall[:, each, axis1]), axis=0)
    u, v = (axis1 + 1) % 3, (axis1 + 2) % 3
    flat_was = was[:, each, u] + 1j * was[:, each, v]
    flat_shall = shall[:, each, u] + 1j * shall[:, each, v]
    product = np.sum(np.conj(flat_was) * flat_shall, axis=0)
    found = []
    for k in np.flatnonzero((still < target.steady) & (np.abs(product) > 1e-6)):
        first = float(np.angle(product[k]))
        rest = np.swapaxes(between[:, k, :3, :3], -1, -2) @ (
            about_axis(int(axis1[k]), -first) @ wanted[:, k, :3, :3]
        )
        s, t = (axis2[k] + 1) % 3, (axis2[k] + 2) % 3
        sine = np.sum(rest[:, t, s] - rest[:, s, t])
        second = float(np.arctan2(sine, np.sum(rest[:, s, s] + rest[:, t, t])))
        if abs(first) < target.steady or abs(second) < target.steady:
            continue
        values = {
            cell: wrapped(float(chain.cells[cell]) + turn)
            for cell, turn in zip(pairs[k], (first, second), strict=True)
        }
        found.append(changed(Reading(chain), values, target.slack))
    return [found[k] for k in target.met_by([one.chain for one in found])]


def _columns(poses: Array, axis: NDArray[np.intp]) -> Array:
    """Column axis[p] of the rotation of each pose (N, P, 4, 4), (N, P, 3)."""
    index = axis[None, :, None, None]
    return np.take_along_axis(poses[..., :3, :3], index, axis=-1)[..., 0]


def _in_order(chain: Chain, columns: Sequence[int]) -> list[tuple[int, int]]:
    """Cells of the given columns in the order in which their motions follow one another."""
    order = (ALPHA, A, THETA, D) if chain.modified else (THETA, D, ALPHA, A)
    return [(row, c) for row in range(chain.n) for c in order if c in columns]


def _turned(chain: Chain, target: Target) -> list[Reading]:
    """Single angles that make the rotations agree, whatever the positions."""
    few = target.few
    poses = frames(chain, few.q)
    gap, _last = differences(poses[None], few)
    found = []
    for row, column in _in_order(chain, (ALPHA, THETA)):
        motion = gap[0, :, chain.frame_of(row, column)].copy()
        motion[:, :3, 3] = 0.0
        if spread(motion[None], 1.0)[0] > target.steady:
            continue
        angle, _length, rest = screw(np.mean(motion, axis=0), AXIS_OF[column])
        if rest <= target.steady and abs(angle) > target.steady:
            value = wrapped(float(chain.cells[row, column]) + angle)
            found.append(changed(Reading(chain), {(row, column): value}, target.slack))
    return found


def _lengths(first: Reading, target: Target, most: int) -> list[Reading]:
    """Lengths that make the positions agree where the rotations do, at most so many of them."""
    chain, few = first.chain, target.few
    poses = frames(chain, few.q)
    rotation = np.abs(poses[:, -1, :3, :3] - few.poses[:, :3, :3])
    if np.max(rotation) > target.steady:
        return []
    wanted = (few.poses[:, :3, 3] - poses[:, -1, :3, 3]).reshape(-1)
    cells = _in_order(chain, (A, D))
    slopes = np.array(
        [poses[:, chain.frame_of(*cell), :3, AXIS_OF[cell[1]]].reshape(-1) for cell in cells]
    ).T
    found = []
    for support in combinations(range(len(cells)), most):
        matrix = slopes[:, support]
        gram = matrix.T @ matrix
        if np.linalg.det(gram) < 1e-12 * len(wanted) ** most:
            continue  # these two do the same
        solution = np.linalg.lstsq(matrix, wanted, rcond=None)[0]
        if np.max(np.abs(matrix @ solution - wanted)) > target.steady * target.size:
            continue
        values = {}
        for k, change in zip(support, solution, strict=True):
            written = float(chain.cells[cells[k]])
            if abs(change) > target.steady * target.size:
                values[cells[k]] = tidy_length(written + float(change), written)
        if len(values) == most:
            found.append(changed(first, values, target.slack))
    return found
