"""All branches of any six-joint arm, by following them from a pose where all are known.

The joints are taken as complex numbers, where every arm has the same number of solutions k at
almost every pose: 16 for a general 6R arm (Primrose 1986; Raghavan and Roth 1993), fewer where
axes meet or are parallel or joints slide. Source of the method: Tsai and Morgan, "Solving the
kinematics of the most general six- and five-degree-of-freedom manipulators by continuation
methods" (1985); Wampler and Morgan, "Solving the 6R inverse position problem using a generic-case
solution methodology" (1991): solve one generic case once, then follow its k solutions to each
case asked for.

- Once per arm, :func:`generic_solutions` finds the k solutions of one random *complex* pose. It
  starts from one solution, which forward kinematics gives, and carries it around closed loops of
  random poses: its other sheets come up one after the other (monodromy; the set of all (q, T) is
  irreducible, being the image of the joint torus, so that loops reach every sheet).
- For each pose, :func:`follow_all` moves the pose from the generic one to the target and follows
  the k solutions. The way leads through complex poses, so that it meets no singularity in
  between with probability one, and each isolated solution of the target is the end of a path.

A path is dq/ds = J^-1 (v, omega), predicted by a cubic through the last two points and corrected
by Newton steps. Paths that end in the same regular solution, or whose ends are not closed under
complex conjugation, betray a slip: all are followed again, from another generic pose and with
smaller steps.
"""

from __future__ import annotations

import cmath
import math
from typing import Any, NamedTuple

import numpy as np

from kinlab.arrays import Array
from kinlab.engine.fast.compiled import kernel
from kinlab.engine.fast.kinematics_kernels import columns, frames, put

FOLLOWED, SINGULAR_END, LOST = 0, 1, 2
"""How a path ended: at a regular solution; where solutions run together; not at all."""

_STEPS = 600
"""Steps of one path at most; 15 to 40 are usual, some 150 at a double solution."""

_TRUST = (0.06, 0.01, 0.002)
"""Radians that the first Newton step may take after a prediction, in the first round and in two
more, each from another generic pose, where paths slipped."""

_TWIN = 1e-7
"""Radians within which two ends of paths are one solution."""

_QUIET_LOOPS = 24
"""Loops in a row that bring no new solution before the set counts as whole: a loop leaves a
part of the sheets to itself with a chance of one half at most."""

_FAR = 11.0
"""Imaginary part of an angle (its sine is 3e4) beyond which rounding decides whether a solution
exists: such ones lie at infinity."""

BOUNDS = {0: 16, 1: 16, 2: 8, 3: 2}
"""Most solutions of a six-joint arm with so many sliding joints (Mavroidis and Roth, "Structural
parameters which reduce the number of manipulator configurations", 1994)."""

_RANK = 1e-9
"""sigma_min / sigma_max of J at random complex states below which the arm cannot move in all
six directions."""


_BANK = 48
"""Poses at which all solutions are kept; following starts at the one nearest to the target."""


class Starts(NamedTuple):
    """All solutions at some generic complex poses.

    Attributes:
        poses: (b, 12), complex, rows of [R | p].
        q: (b, k, 6), complex.
        length: metres that count as a radian.
        loops: how many loops were made. quiet: the last of them that brought nothing new.
    """

    poses: Any
    q: Any
    length: float
    loops: int
    quiet: int


@kernel
def _size(value):  # type: ignore[no-untyped-def]
    """|Re| + |Im|, a norm without a square root."""
    return abs(value.real) + abs(value.imag)


@kernel
def factorise(a, order):  # type: ignore[no-untyped-def]
    """LU with row pivoting in place; (6, 6) complex. Returns smallest / largest pivot."""
    n = a.shape[0]
    least, most = np.inf, 0.0
    for k in range(n):
        best, row = _size(a[k, k]), k
        for i in range(k + 1, n):
            size = _size(a[i, k])
            if size > best:
                best, row = size, i
        order[k] = row
        if row != k:
            for j in range(n):
                a[k, j], a[row, j] = a[row, j], a[k, j]
        if best < least:
            least = best
        if best > most:
            most = best
        if not best > 1e-300:
            return 0.0
        inverse = 1.0 / a[k, k]
        for i in range(k + 1, n):
            factor = a[i, k] * inverse
            a[i, k] = factor
            for j in range(k + 1, n):
                a[i, j] -= factor * a[k, j]
    return least / most


@kernel
def back_substitute(a, order, b):  # type: ignore[no-untyped-def]
    """Solves with the factors of :func:`factorise`; b is overwritten."""
    n = a.shape[0]
    for k in range(n):
        row = order[k]
        if row != k:
            b[k], b[row] = b[row], b[k]
    for k in range(n):
        for i in range(k + 1, n):
            b[i] -= a[i, k] * b[k]
    for k in range(n - 1, -1, -1):
        for j in range(k + 1, n):
            b[k] -= a[k, j] * b[j]
        b[k] /= a[k, k]


@kernel
def plan_path(start, target, way):  # type: ignore[no-untyped-def]
    """The way of the pose: p = p1 + s v, R = exp(s phi) R1, s from 1 (start) to 0 (target).

    Args:
        start, target: (12,) complex.
        way: (7, 6) complex, written: row 0 the twist (v, phi); rows 1 and 2 R1, 3 and 4 K R1,
            5 and 6 K^2 R1 (nine numbers each) with phi = theta K.

    Returns:
        theta, complex.
    """
    d = np.empty(9, np.complex128)
    for i in range(3):
        for j in range(3):
            d[3 * i + j] = (
                start[4 * i] * target[4 * j]
                + start[4 * i + 1] * target[4 * j + 1]
                + start[4 * i + 2] * target[4 * j + 2]
            )
    x, y, z = 0.5 * (d[7] - d[5]), 0.5 * (d[2] - d[6]), 0.5 * (d[3] - d[1])
    c = 0.5 * (d[0] + d[4] + d[8] - 1.0)
    s = cmath.sqrt(x * x + y * y + z * z)
    theta = -1j * cmath.log(c + 1j * s)
    kx, ky, kz = x / s, y / s, z / s
    for i in range(3):
        way[0, i] = start[4 * i + 3] - target[4 * i + 3]
    way[0, 3], way[0, 4], way[0, 5] = theta * kx, theta * ky, theta * kz
    for j in range(3):
        r0, r1, r2 = target[j], target[4 + j], target[8 + j]
        u0, u1, u2 = ky * r2 - kz * r1, kz * r0 - kx * r2, kx * r1 - ky * r0
        w0, w1, w2 = ky * u2 - kz * u1, kz * u0 - kx * u2, kx * u1 - ky * u0
        for base, a0, a1, a2 in ((1, r0, r1, r2), (3, u0, u1, u2), (5, w0, w1, w2)):
            way[base, j], way[base, 3 + j], way[base + 1, j] = a0, a1, a2
    return theta


@kernel
def _pose_at(way, theta, target, s, out):  # type: ignore[no-untyped-def]
    sine = cmath.sin(s * theta)
    versine = 1.0 - cmath.cos(s * theta)
    for i in range(3):
        out[4 * i + 3] = target[4 * i + 3] + s * way[0, i]
        for j in range(3):
            at = 3 * i + j
            row, column = at // 6, at % 6
            out[4 * i + j] = (
                way[1 + row, column] + sine * way[3 + row, column] + versine * way[5 + row, column]
            )


@kernel
def _newton(fixed, prismatic, goal, q, axes, pose, jac, order, e):  # type: ignore[no-untyped-def]
    """One Newton step towards a pose: e (6,) becomes dq; J is left factorised. Returns pivots."""
    frames(fixed, prismatic, q, axes, pose)
    columns(prismatic, axes, pose, jac)
    for i in range(3):
        e[i] = goal[4 * i + 3] - pose[4 * i + 3]
        e[3 + i] = 0.0j
    for j in range(3):  # half the sum of columns of R crossed with those of R_d
        x, y, z = pose[j], pose[4 + j], pose[8 + j]
        u, v, w = goal[j], goal[4 + j], goal[8 + j]
        e[3] += 0.5 * (y * w - z * v)
        e[4] += 0.5 * (z * u - x * w)
        e[5] += 0.5 * (x * v - y * u)
    pivots = factorise(jac, order)
    if pivots > 0.0:
        back_substitute(jac, order, e)
    return pivots


@kernel
def _largest(prismatic, length, dq):  # type: ignore[no-untyped-def]
    most = 0.0
    for i in range(dq.shape[0]):
        size = _size(dq[i])
        if prismatic[i]:
            size /= length
        if not size <= most:  # NaN as well
            most = size
    return most


@kernel
def follow(fixed, prismatic, length, target, way, theta, trust, q):  # type: ignore[no-untyped-def]
    """Follows one solution from the start of the way to the target.

    Args:
        fixed, prismatic: the chain of six joints. length: metres that count as a radian.
        target: (12,) complex. way, theta: from :func:`plan_path`.
        trust: radians that the first correction may take.
        q: (6,) complex, changed in place.

    Returns:
        How it ended, and the number of evaluations.
    """
    n = prismatic.shape[0]
    axes, pose = np.empty((n, 6), np.complex128), np.empty(12, np.complex128)
    goal, jac = np.empty(12, np.complex128), np.empty((6, n), np.complex128)
    e, speed = np.empty(6, np.complex128), np.empty(6, np.complex128)
    old_q, old_speed = np.empty(6, np.complex128), np.empty(6, np.complex128)
    trial, order = np.empty(6, np.complex128), np.empty(6, np.int64)
    s, h, before = 1.0, 0.02, 0.0
    work = 1
    _pose_at(way, theta, target, 1.0, goal)
    _newton(fixed, prismatic, goal, q, axes, pose, jac, order, e)
    for i in range(n):
        speed[i] = way[0, i]
    back_substitute(jac, order, speed)
    for _ in range(_STEPS):
        ahead = min(h, s)
        if s - ahead < 0.2 * ahead:
            ahead = s
        last = ahead == s
        new = 0.0 if last else s - ahead
        if before > 0.0:  # cubic through both points and their speeds, t = 1 here, 0 before
            r = ahead / before
            t = 1.0 + r
            h00, h10 = (1.0 + 2.0 * t) * r * r, t * r * r
            h01, h11 = t * t * (1.0 - 2.0 * r), t * t * r
            for i in range(n):
                trial[i] = (
                    h00 * old_q[i] + h01 * q[i] - before * (h10 * old_speed[i] + h11 * speed[i])
                )
        else:
            for i in range(n):
                trial[i] = q[i] - ahead * speed[i]
        _pose_at(way, theta, target, new, goal)
        first, good, size = 0.0, False, 0.0
        for turn in range(4):
            work += 1
            if not _newton(fixed, prismatic, goal, trial, axes, pose, jac, order, e) > 1e-15:
                break
            size = _largest(prismatic, length, e)
            if turn == 0:
                first = size
            if not size <= trust or (turn > 0 and size > 0.5 * trust):
                break
            for i in range(n):
                trial[i] += e[i]
            if size < 2e-4:
                good = True
                break
        if good:
            before = ahead
            for i in range(n):
                old_q[i], old_speed[i] = q[i], speed[i]
                q[i] = trial[i]
                speed[i] = way[0, i]
            if last:
                for _ in range(8):
                    work += 1
                    pivots = _newton(fixed, prismatic, goal, trial, axes, pose, jac, order, e)
                    size = _largest(prismatic, length, e)
                    if not (pivots > 1e-15 and size < 1e-3):
                        return SINGULAR_END, work
                    for i in range(n):
                        q[i] = trial[i] = trial[i] + e[i]
                    if size < 1e-8:
                        return FOLLOWED, work
                return SINGULAR_END, work
            back_substitute(jac, order, speed)
            s = new
            grow = 2.0
            if first > 0.0:
                grow = min(2.0, max(0.5, 0.85 * (trust / first) ** 0.25))
            h = ahead * grow
        else:
            h = 0.4 * ahead
            if s < 1e-11:
                return SINGULAR_END, work
            if h < 1e-7 * s:
                return LOST, work
    return (SINGULAR_END if s < 1e-6 else LOST), work


@kernel
def _gap(prismatic, length, a, b, mirrored):  # type: ignore[no-untyped-def]
    """Distance of two complex solutions, whole turns aside; of a and conj(b) where asked."""
    most = 0.0
    for i in range(a.shape[0]):
        real = a[i].real - b[i].real
        imag = a[i].imag + b[i].imag if mirrored else a[i].imag - b[i].imag
        if prismatic[i]:
            size = (abs(real) + abs(imag)) / length
        else:
            size = abs(real - 2.0 * math.pi * math.floor(real / (2.0 * math.pi) + 0.5)) + abs(imag)
        most = max(most, size)
    return most


@kernel
def follow_all(fixed, prismatic, length, poses, bank, target, ends, codes):  # type: ignore[no-untyped-def]
    """Follows all solutions of the nearest generic pose to a real target.

    Args:
        fixed, prismatic, length: as in :func:`follow`.
        poses: (b, 12) complex. bank: (b, k, 6) complex.
        target: (12,), real.
        ends: (k, 6) complex, written: all solutions, real and complex.
        codes: (k,), integers, written: how each path ended.

    Returns:
        Whether every path ended in a solution of its own, and the set is its own conjugate.
    """
    k = bank.shape[1]
    goal, way = target.astype(np.complex128), np.empty((7, 6), np.complex128)
    away = np.zeros(poses.shape[0])
    for i in range(poses.shape[0]):
        for j in range(12):
            gap = _size(poses[i, j] - goal[j])
            away[i] += (gap / length if j % 4 == 3 else gap) ** 2
    clean = False
    for trust in _TRUST:
        nearest = np.argmin(away)
        if poses.shape[0] > 1:
            away[nearest] = np.inf  # another way, where this one does not do
        theta = plan_path(poses[nearest], goal, way)
        clean = True
        for i in range(k):
            put(bank[nearest, i], ends[i])
            codes[i], _ = follow(fixed, prismatic, length, goal, way, theta, trust, ends[i])
            clean = clean and codes[i] != LOST
        for i in range(k):
            if codes[i] != FOLLOWED:
                continue
            conjugate = False
            for j in range(k):
                if codes[j] != FOLLOWED:
                    continue
                if j != i and _gap(prismatic, length, ends[i], ends[j], False) < _TWIN:
                    clean = False
                if _gap(prismatic, length, ends[i], ends[j], True) < _TWIN:
                    conjugate = True
            clean = clean and conjugate
        if clean:
            break
    return clean


@kernel
def _carry(fixed, prismatic, length, poses, closed, q, ends, good):  # type: ignore[no-untyped-def]
    """Carries solutions q (k, 6) from pose to pose (m, 12), back to the first where closed."""
    way = np.empty((7, 6), np.complex128)
    for i in range(q.shape[0]):
        put(q[i], ends[i])
        good[i] = True
    count = poses.shape[0]
    for leg in range(count if closed else count - 1):
        target = poses[(leg + 1) % count]
        theta = plan_path(poses[leg], target, way)
        for i in range(q.shape[0]):
            if good[i]:
                code, _ = follow(fixed, prismatic, length, target, way, theta, _TRUST[1], ends[i])
                good[i] = code == FOLLOWED


def generic_solutions(fixed: Array, prismatic: Any) -> Starts | None:
    """All complex solutions of a random complex pose, and of others that they are carried to.

    A solution may lie so far out at one pose that rounding hides it. Unless as many are found as
    such an arm can have (:data:`BOUNDS`), other first poses are tried until an even number comes
    up twice as the largest.

    Args:
        fixed: (7, 12). prismatic: (6,).

    Returns:
        The solutions; ``None`` where J is singular everywhere, so that no pose has isolated ones.
    """
    best: Starts | None = None
    times, most = 0, BOUNDS.get(int(np.sum(prismatic)), 2)
    for seed in range(8):
        found = _from_one_home(fixed, prismatic, seed)
        if found is None:
            return None
        count = found.q.shape[1]
        if best is None or count > best.q.shape[1]:
            best, times = found, 1
        elif count == best.q.shape[1]:
            times += 1
        if best.q.shape[1] == most or (times == 2 and best.q.shape[1] % 2 == 0):
            break
    return best


def _from_one_home(fixed: Array, prismatic: Any, seed: int) -> Starts | None:
    """The solutions of one random complex pose, or ``None``."""
    rng = np.random.default_rng(seed)
    length = max(float(np.linalg.norm(fixed[1:, [3, 7, 11]], axis=1).sum()), 1e-3)
    scale = np.where(prismatic, length, 1.0)

    def at(q: Any) -> Any:
        axes, pose = np.empty((6, 6), np.complex128), np.empty(12, np.complex128)
        jac = np.empty((6, 6), np.complex128)
        frames(fixed, prismatic, q, axes, pose)
        columns(prismatic, axes, pose, jac)
        jac[:3] /= length
        values = np.linalg.svd(jac * scale, compute_uv=False)
        return pose, values[-1] / values[0]

    def some(size: float) -> Any:
        return scale * (rng.uniform(-2.5, 2.5, 6) + 1j * size * rng.uniform(-1.0, 1.0, 6))

    best, most = some(0.4), 0.0
    for _ in range(12):  # of some, the one farthest from singular
        q = some(0.4)
        regular = float(at(q)[1])
        if regular > most:
            best, most = q, regular
    if most < _RANK:
        return None
    home = at(best)[0]
    known = best.reshape(1, 6)
    loops = quiet = 0
    bound = BOUNDS.get(int(np.sum(prismatic)), 2)
    while quiet < _QUIET_LOOPS and len(known) < bound and loops < 400:
        poses = np.array([home, at(some(0.8))[0], at(some(0.8))[0]])
        ends, good = np.empty_like(known), np.empty(len(known), dtype=np.bool_)
        _carry(fixed, prismatic, length, poses, True, known, ends, good)
        fresh: list[Any] = []
        for q in ends[good]:
            near = np.abs(np.where(prismatic, 0.0, q).imag).max() < _FAR
            if near and all(_gap(prismatic, length, q, k, False) > _TWIN for k in [*known, *fresh]):
                fresh.append(q)
        loops += 1
        quiet = 0 if fresh else quiet + int(good.sum() >= 0.7 * len(good))
        if fresh:
            known = np.vstack([known, *fresh])
    stations, sets = [home], [known]
    for _ in range(3 * _BANK):
        if len(stations) == _BANK:
            break
        pose = at(some(0.4))[0]
        ends, good = np.empty_like(known), np.empty(len(known), dtype=np.bool_)
        _carry(fixed, prismatic, length, np.array([home, pose]), False, known, ends, good)
        apart = all(
            _gap(prismatic, length, ends[i], ends[j], False) > _TWIN
            for i in range(len(ends))
            for j in range(i)
        )
        if good.all() and apart:
            stations.append(pose)
            sets.append(ends)
    return Starts(np.array(stations), np.array(sets), length, loops, quiet)
