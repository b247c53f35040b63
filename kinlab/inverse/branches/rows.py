"""All branches of many poses: candidates of the closed forms, sharpened, measured, told apart.

:func:`branch_rows` is the compiled entry for stacks; :func:`all_branches` calls it on all
processors and is what other rooms use where names and Pinocchio's word are not needed.
"""

from __future__ import annotations

import math
from typing import Any, NamedTuple

import numpy as np

from kinlab.arrays import Array
from kinlab.engine.fast.compiled import kernel
from kinlab.engine.fast.kinematics_kernels import columns, frames, put
from kinlab.engine.fast.threads import over_rows
from kinlab.inverse.branches.closed_forms import (
    in_the_plane,
    inverse,
    onto_plane,
    place_point,
    spherical_wrist,
    three_parallel,
)
from kinlab.inverse.branches.continuation import (
    LOST,
    SINGULAR_END,
    back_substitute,
    factorise,
    follow_all,
)
from kinlab.inverse.branches.structures import (
    GENERAL,
    PLANE,
    POINT,
    POINTING,
    POSE,
    POSITION,
    TRIPLE,
    WRIST,
    Form,
)
from kinlab.inverse.kernel import pose_error, wrap

MOST = 16
"""Branches of one pose at most: the degree of the general six-joint arm."""

TOLERANCE = 1e-9
"""Metres and radians that a branch must meet."""

UNDECIDED, SLIPPED, DOUBLE = 8, 16, 32
"""Flags beside those of the closed forms: a candidate that comes close and misses the tolerance;
a path that was lost or slipped; a solution at which branches run together."""

_CLOSE = 1e-6
"""A candidate that ends between TOLERANCE and this is undecided, neither taken nor dismissed."""

SAME = 2e-7
"""Radians or metres within which two solutions are one. Rounding moves a double solution by its
square root, some 1e-8."""

_SHARP = 1e-12
"""A candidate that is this good needs no sharpening."""

_BESIDE = 1e-5
"""Of its distance from joint 1: a wrist this near to the first axis has branches that rounding
may lose."""

_STRAYED = 1e-3
"""Radians or metres that sharpening may move a candidate which was already close."""

_STRAIGHT = 1e-7
"""Metres or sines below which a branch has neither one name nor the other."""


@kernel
def miss(task, pose, target, r, e):  # type: ignore[no-untyped-def]
    """Position and rotation error in what counts of the pose, metres and radians."""
    pose_error(pose, target, r, e)
    position = math.sqrt(e[0] * e[0] + e[1] * e[1] + e[2] * e[2])
    if task == POSITION:
        return position, 0.0
    if task == POINTING:
        x, y, z = pose[2], pose[6], pose[10]
        u, v, w = target[2], target[6], target[10]
        across = math.sqrt((y * w - z * v) ** 2 + (z * u - x * w) ** 2 + (x * v - y * u) ** 2)
        return position, math.atan2(across, x * u + y * v + z * w)
    return position, math.sqrt(e[3] * e[3] + e[4] * e[4] + e[5] * e[5])


@kernel
def sharpen(fixed, prismatic, target, q, axes, pose, jac, order, r, e):  # type: ignore[no-untyped-def]
    """Newton steps on a square problem as long as they help: six joints, or three and a point.

    Args:
        fixed, prismatic: the chain. target: (12,). q: (n,), changed in place.
        axes, pose, jac, order, r, e: work space.

    Returns:
        The error that is left.
    """
    n = prismatic.shape[0]
    rows = 6 if n == 6 else 3
    trial = q.copy()
    best, halved, damped = np.inf, 0, 1.0
    for _ in range(40):
        frames(fixed, prismatic, trial, axes, pose)
        pose_error(pose, target, r, e)
        now = 0.0
        for i in range(rows):
            now = max(now, abs(e[i]))
        if now < best:
            far = now < 0.9 * best
            best, halved, damped = now, 0, 1.0
            put(trial, q)
            if now < 1e-16 or (not far and now < 1e-14):
                break
        else:
            halved += 1
            damped *= 0.25
            if halved > 3 or best < 1e-14:
                break
            frames(fixed, prismatic, q, axes, pose)
            pose_error(pose, target, r, e)
        columns(prismatic, axes, pose, jac)
        square = jac[:rows, :n].copy()
        step = e[:rows].copy()
        if not factorise(square, order) > 0.0:
            break
        back_substitute(square, order, step)
        most = 0.0
        for i in range(n):
            most = max(most, abs(step[i]))
        scale = damped * min(1.0, 0.1 / most) if most > 0.0 else 0.0
        if not scale > 0.0:
            break
        for i in range(n):
            trial[i] = q[i] + scale * step[i]
    return best


@kernel
def _side(value):  # type: ignore[no-untyped-def]
    """1, -1, or 0 where it is too small to tell."""
    return 0 if abs(value) < _STRAIGHT else (1 if value > 0.0 else -1)


@kernel
def posture(form, axes, pose, q, target):  # type: ignore[no-untyped-def]
    """Shoulder, elbow and wrist of a branch as one number, 9 (s + 1) + 3 (e + 1) + (w + 1).

    See :mod:`kinlab.inverse.branches.names` for what they mean.
    """
    n = form.real
    shoulder, elbow, wrist = 0, 0, 0
    if form.family == PLANE:
        bars = np.empty((3, 3))
        count = 0
        for i in range(n):
            if not form.arm_prismatic[i]:
                put(axes[i, 3:], bars[count])
                count += 1
        if count == 2:
            bars[2, 0], bars[2, 1], bars[2, 2] = pose[3], pose[7], pose[11]
        one, two = bars[1] - bars[0], bars[2] - bars[1]
        bend = (
            (one[1] * two[2] - one[2] * two[1]) * axes[0, 0]
            + (one[2] * two[0] - one[0] * two[2]) * axes[0, 1]
            + (one[0] * two[1] - one[1] * two[0]) * axes[0, 2]
        )
        return 9 + 3 * (_side(bend) + 1) + 1
    if n < 3:
        return 13
    point, hand = np.empty(3), np.empty(3)
    named = form.family == POINT or (form.family in (WRIST, TRIPLE) and not form.turned)
    for i in range(3):
        hand[i] = pose[4 * i + 3] if n == 3 else axes[3, 3 + i]
        point[i] = hand[i]
        if named:
            point[i] = pose[4 * i + 3] + (
                pose[4 * i] * form.marker[0]
                + pose[4 * i + 1] * form.marker[1]
                + pose[4 * i + 2] * form.marker[2]
            )
        if form.family != TRIPLE:
            hand[i] = point[i]
    z1, z2 = axes[0, :3], axes[1, :3]
    fx = z1[1] * z2[2] - z1[2] * z2[1]
    fy = z1[2] * z2[0] - z1[0] * z2[2]
    fz = z1[0] * z2[1] - z1[1] * z2[0]
    ox, oy, oz = point[0] - axes[1, 3], point[1] - axes[1, 4], point[2] - axes[1, 5]
    lx, ly, lz = hand[0] - axes[1, 3], hand[1] - axes[1, 4], hand[2] - axes[1, 5]
    if math.sqrt(fx * fx + fy * fy + fz * fz) < _STRAIGHT:
        ax, ay, az = axes[1, 3] - axes[0, 3], axes[1, 4] - axes[0, 4], axes[1, 5] - axes[0, 5]
        elbow = _side(
            (ay * lz - az * ly) * z1[0] + (az * lx - ax * lz) * z1[1] + (ax * ly - ay * lx) * z1[2]
        )
    else:
        shoulder = _side(fx * ox + fy * oy + fz * oz)
        if not form.arm_prismatic[2]:
            bx, by, bz = axes[2, 3] - axes[1, 3], axes[2, 4] - axes[1, 4], axes[2, 5] - axes[1, 5]
            along = bx * z2[0] + by * z2[1] + bz * z2[2]
            bx, by, bz = bx - along * z2[0], by - along * z2[1], bz - along * z2[2]
            along = lx * z2[0] + ly * z2[1] + lz * z2[2]
            lx, ly, lz = lx - along * z2[0], ly - along * z2[1], lz - along * z2[2]
            square = lx * lx + ly * ly + lz * lz
            if square > _STRAIGHT * _STRAIGHT:
                along = (bx * lx + by * ly + bz * lz) / square
                bx, by, bz = bx - along * lx, by - along * ly, bz - along * lz
            elbow = _side(bx * z1[0] + by * z1[1] + bz * z1[2])
    if n == 6:
        z4, z5, z6 = axes[3, :3], axes[4, :3], axes[5, :3]
        wrist = _side(
            (z4[1] * z5[2] - z4[2] * z5[1]) * z6[0]
            + (z4[2] * z5[0] - z4[0] * z5[2]) * z6[1]
            + (z4[0] * z5[1] - z4[1] * z5[0]) * z6[2]
        )
    return 9 * (shoulder + 1) + 3 * (elbow + 1) + wrist + 1


@kernel
def _after(code, q, other_code, other):  # type: ignore[no-untyped-def]
    """Whether a branch stands behind another: by posture, then joint by joint."""
    if code != other_code:
        return code > other_code
    for i in range(q.shape[0]):
        if abs(q[i] - other[i]) > 0.5 * SAME:
            return q[i] > other[i]
    return False


@kernel
def _same(prismatic, a, b):  # type: ignore[no-untyped-def]
    for i in range(prismatic.shape[0]):
        gap = a[i] - b[i]
        if not prismatic[i]:
            gap -= 2.0 * math.pi * math.floor(gap / (2.0 * math.pi) + 0.5)
        if abs(gap) > SAME:
            return False
    return True


@kernel
def _beside_axis(axis, centre, goal):  # type: ignore[no-untyped-def]
    """Whether a point of the tool lies on the first axis, or too near to tell its sides apart."""
    away = np.empty(3)
    for i in range(3):
        away[i] = goal[4 * i + 3] - axis[4 * i + 3]
        for j in range(3):
            away[i] += goal[4 * i + j] * centre[j]
    along = axis[2] * away[0] + axis[6] * away[1] + axis[10] * away[2]
    square = away[0] ** 2 + away[1] ** 2 + away[2] ** 2
    across = 0.0
    for i in range(3):
        across += (away[i] - along * axis[4 * i + 2]) ** 2
    return across < (_BESIDE * _BESIDE) * square


class Branches(NamedTuple):
    """Branches of a stack of poses, before names.

    Attributes:
        q: (N, 16, n); rows from ``counts`` on are not filled.
        counts: (N,), how many solutions. codes: (N, 16), :func:`posture`.
        states: (N,), flags; 0 where the set is whole (every solution, and no infinite family).
        goals: (N, 12), what was met: the targets, put into the plane for an arm of parallel axes.
    """

    q: Array
    counts: Any
    codes: Any
    states: Any
    goals: Array

    @classmethod
    def empty(cls, poses: int, joints: int) -> Branches:
        """Room for so many poses."""
        numbers = np.empty((2, poses), dtype=np.int64)
        codes = np.empty((poses, MOST), dtype=np.int64)
        q, goals = np.empty((poses, MOST, joints)), np.empty((poses, 12))
        return cls(q, numbers[0], codes, numbers[1], goals)


@kernel
def branch_rows(form, limits, targets, found, first, last):  # type: ignore[no-untyped-def]
    """All branches of rows first to last - 1, each on its own.

    Args:
        form: :class:`~kinlab.inverse.branches.structures.Form`.
        limits: lower, upper, and where angles are wrapped to, (n,) each.
        targets: (N, 12), rows of [R | p].
        found: :class:`Branches`, written; those of a pose ordered by posture and then by q.
        first, last: range of rows.
    """
    n, m = form.real, form.prismatic.shape[0]
    lower, upper, centre = limits
    q, counts, codes, states, goals = found
    candidates, closed, start = np.zeros((MOST, m)), np.empty((8, 6)), np.empty(m)
    places, flat = np.empty((4, 3)), np.empty((2, m))
    axes, arm_axes, pose = np.empty((m, 6)), np.empty((n, 6)), np.empty(12)
    jac, order = np.zeros((6, m)), np.empty(6, np.int64)
    r, e, goal = np.empty(9), np.empty(6), np.empty(12)
    k = form.starts.shape[1]
    ends, how = np.empty((k, 6), np.complex128), np.empty(k, np.int64)
    nothing = False
    for row in range(first, last):
        target = goals[row]
        put(targets[row], target)
        state, number = 0, 0
        if form.family == WRIST or form.family == TRIPLE:
            put(target, goal)
            if form.turned:
                inverse(target, goal)
            fixed = form.turned_fixed if form.turned else form.fixed
            kinds = form.turned_prismatic if form.turned else form.prismatic
            if form.family == WRIST:
                number, state = spherical_wrist(
                    fixed, kinds, form.centre, form.centre_tool, goal, closed
                )
            else:
                number, state = three_parallel(fixed, goal, closed)
            for i in range(number):
                for j in range(6):
                    candidates[i, j] = -closed[i, 5 - j] if form.turned else closed[i, j]
        elif form.family == POINT:
            for i in range(3):
                e[i] = target[4 * i + 3]
            number, state = place_point(form.fixed, form.prismatic[2], form.centre, e[:3], places)
            for i in range(number):
                put(places[i], candidates[i, :3])
        elif form.family == PLANE:
            slides = False
            for i in range(n):
                slides = slides or form.prismatic[i]
            onto_plane(form.fixed, slides, targets[row], target)
            number, state = in_the_plane(
                form.fixed, form.prismatic, target, form.task == POSE, flat
            )
            for i in range(number):
                put(flat[i], candidates[i])
        else:
            if not follow_all(
                form.fixed, form.prismatic, form.length, form.poses, form.starts, target, ends, how
            ):
                state |= SLIPPED
            for i in range(k):
                imaginary = 0.0
                for j in range(6):
                    size = abs(ends[i, j].imag)
                    imaginary = max(imaginary, size / form.length if form.prismatic[j] else size)
                if how[i] == LOST:
                    continue
                if imaginary < (1e-2 if how[i] == SINGULAR_END else 1e-4):
                    for j in range(6):
                        candidates[number, j] = ends[i, j].real
                    if how[i] == SINGULAR_END:
                        state |= DOUBLE
                    number += 1
        if form.family == WRIST and _beside_axis(fixed[0], form.centre_tool, goal):
            state |= UNDECIDED
        if form.family == POINT and _beside_axis(form.fixed[0], np.zeros(3), target):
            state |= UNDECIDED
        count = 0
        for i in range(number):
            trial = candidates[i]
            frames(form.arm_fixed, form.arm_prismatic, trial, arm_axes, pose)
            position, rotation = miss(form.task, pose, target, r, e)
            before = max(position, rotation)
            rough = form.family == GENERAL or before > _SHARP
            if rough and form.family != PLANE:
                put(trial, start)
                sharpen(form.fixed, form.prismatic, target, trial, axes, pose, jac, order, r, e)
                frames(form.arm_fixed, form.arm_prismatic, trial, arm_axes, pose)
                position, rotation = miss(form.task, pose, target, r, e)
            error = max(position, rotation)
            if not error <= TOLERANCE:
                near = min(before, error) < _CLOSE and not form.real < m
                if near or state & DOUBLE:
                    state |= UNDECIDED
                continue
            if rough and form.family != PLANE and form.family != GENERAL and before < _CLOSE:
                # sharpening beside a singular pose may end at another branch: the one it came
                # from is then neither found nor dismissed
                for j in range(m):
                    if abs(trial[j] - start[j]) > _STRAYED:
                        state |= UNDECIDED
            wrap(form.arm_prismatic, lower, upper, centre, trial[:n])
            nothing = False
            for j in range(count):
                nothing = nothing or _same(form.arm_prismatic, trial, q[row, j])
            if nothing:
                continue
            code = posture(form, arm_axes, pose, trial, target)
            at = count
            while at > 0 and _after(codes[row, at - 1], q[row, at - 1], code, trial):
                codes[row, at] = codes[row, at - 1]
                put(q[row, at - 1], q[row, at])
                at -= 1
            codes[row, at] = code
            for j in range(n):
                q[row, at, j] = trial[j]
            count += 1
        # complex solutions come in pairs, so that the real ones are odd in number only where two
        # run together
        whole = form.family == GENERAL and form.real == 6 and not state & DOUBLE
        if whole and (k - count) % 2 == 1:
            state |= UNDECIDED
        counts[row] = count
        states[row] = state


def all_branches(
    form: Form,
    limits: tuple[Array, Array, Array],
    targets: Array,
    threads: int | None = None,
    then: Any = None,
) -> Branches:
    """All branches of many poses on all processors, without names and without Pinocchio.

    Args:
        form: from :func:`~kinlab.inverse.branches.structures.known_form`.
        limits: lower, upper and centre, (n,) each, of the joints that are solved for: angles
            are turned by whole turns into the limits where that is possible.
        targets: (N, 12), rows of [R | p], rigid.
        threads: how many; ``None`` for all processors.
        then: called with the arrays and (first, last) of each range that is finished.

    Returns:
        The branches, each within 1e-9 m and rad by this chain's own kinematics.
    """
    answer = Branches.empty(len(targets), form.real)
    over_rows(
        branch_rows,
        len(targets),
        form,
        limits,
        targets,
        answer,
        threads=threads,
        grain=1 if form.family == GENERAL else 64,
        then=None if then is None else (lambda first, last: then(answer, first, last)),
    )
    return answer
