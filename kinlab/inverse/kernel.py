"""The compiled search: Levenberg-Marquardt with restarts on a serial chain.

Importing this module imports numba. The same method over Pinocchio calls is in
:mod:`kinlab.inverse.methods`, slow and readable; the two are tested against each other.

The step solves (J^T W J + mu 1) dq = J^T W e with mu = damping * E + floor, E = e^T W e / 2, so
that the damping fades by itself and convergence stays quadratic (Sugihara 2011, "Solvability-
unconcerned inverse kinematics by the Levenberg-Marquardt method"). W divides metres by a length
of the arm. What keeps the number of starts near one:

- the first start is the one of a table whose pose is nearest to the target;
- a joint at a limit whose gradient points outwards is held there for this step. Joints with
  nearly a full turn of range are left free and wrapped at the end: holding them made dead ends;
- a search that meets the tolerance outside the limits is put back onto them and goes on once;
- a search that has not halved E in some iterations is given up.
"""

from __future__ import annotations

import math
from typing import Any, NamedTuple

import numpy as np

from kinlab.arrays import Array
from kinlab.engine.fast.compiled import kernel
from kinlab.engine.fast.kinematics_kernels import columns, frames, put

CONVERGED, OUTSIDE, STALLED, RUNNING = 0, 1, 2, 3
"""How the best search ended: tolerance met; met, but outside the limits; no more progress;
still making progress when its iterations ran out."""

_MARGIN = 0.99
"""Share of the tolerance that a search must meet: Pinocchio, which has the last word, rounds
differently."""


class Search(NamedTuple):
    """What a search of one arm for one task works with; do not write to the arrays.

    Attributes:
        fixed, prismatic: the chain (:mod:`kinlab.engine.fast.kinematics_kernels`).
        lower, upper: limits, (n,).
        wide: joints left free inside the iteration, (n,), bool.
        weight: of the squared error, (6,), zero for what is not asked for.
        table: poses of the starts, (12, S). starts: the starts, (S, n).
        tolerances: metres, radians, (2,).
        damping, floor: mu = damping * E + floor.
        iterations: of one search. searches: how many. patience: iterations in which E must halve.
        reach: from the first joint, metres; infinite where it is not known.
    """

    fixed: Array
    prismatic: Any
    lower: Array
    upper: Array
    wide: Any
    weight: Array
    table: Array
    starts: Array
    tolerances: Array
    damping: float
    floor: float
    iterations: int
    searches: int
    patience: int
    reach: float


@kernel
def rotation_vector(r, e):  # type: ignore[no-untyped-def]
    """Logarithm of a rotation, angle times axis; well defined up to and at half a turn.

    Args:
        r: (9,), the rotation row by row.
        e: (3,), written; norm at most pi.
    """
    x, y, z = 0.5 * (r[7] - r[5]), 0.5 * (r[2] - r[6]), 0.5 * (r[3] - r[1])
    c = 0.5 * (r[0] + r[4] + r[8] - 1.0)
    s = math.sqrt(x * x + y * y + z * z)
    scale = 1.0
    if s > 1e-6:
        scale = math.atan2(s, c) / s
    elif c < 0.0:  # at half a turn the axis is in the symmetric part: R = 2 u u^T - 1
        scale = math.pi
        if r[0] >= r[4] and r[0] >= r[8]:
            x = math.sqrt(0.5 * (r[0] + 1.0))
            y, z = 0.25 * (r[1] + r[3]) / x, 0.25 * (r[2] + r[6]) / x
        elif r[4] >= r[8]:
            y = math.sqrt(0.5 * (r[4] + 1.0))
            x, z = 0.25 * (r[1] + r[3]) / y, 0.25 * (r[5] + r[7]) / y
        else:
            z = math.sqrt(0.5 * (r[8] + 1.0))
            x, y = 0.25 * (r[2] + r[6]) / z, 0.25 * (r[5] + r[7]) / z
    e[0], e[1], e[2] = scale * x, scale * y, scale * z


@kernel
def pose_error(pose, target, r, e):  # type: ignore[no-untyped-def]
    """Twist-like error (p_d - p, log(R_d R^T)) in the base's axes.

    Args:
        pose, target: (12,), rows of [R | p].
        r: (9,), overwritten.
        e: (6,), written.
    """
    for i in range(3):
        e[i] = target[4 * i + 3] - pose[4 * i + 3]
        for j in range(3):
            r[3 * i + j] = (
                target[4 * i] * pose[4 * j]
                + target[4 * i + 1] * pose[4 * j + 1]
                + target[4 * i + 2] * pose[4 * j + 2]
            )
    rotation_vector(r, e[3:])


@kernel
def turn_rows(jac, e, n):  # type: ignore[no-untyped-def]
    """Turns the angular rows of J into the derivative of the rotation vector.

    -d/dt log(R_d R^T) = Jr^-1(phi) omega. Where all three angles are asked for, Jr^-1 leaves phi
    itself unchanged and may be left out; where some are free, the rows must be the true ones.

    Args:
        jac: (6, n), rows 3 to 5 overwritten.
        e: (6,), the error; phi = e[3:].
        n: columns.
    """
    x, y, z = e[3], e[4], e[5]
    square = x * x + y * y + z * z
    angle = math.sqrt(square)
    if angle < 1e-4:
        factor = 1.0 / 12.0
    else:
        factor = 1.0 / square - (1.0 + math.cos(angle)) / (2.0 * angle * math.sin(angle))
    for i in range(n):
        a, b, c = jac[3, i], jac[4, i], jac[5, i]
        dot = x * a + y * b + z * c
        jac[3, i] = a + 0.5 * (y * c - z * b) + factor * (x * dot - square * a)
        jac[4, i] = b + 0.5 * (z * a - x * c) + factor * (y * dot - square * b)
        jac[5, i] = c + 0.5 * (x * b - y * a) + factor * (z * dot - square * c)


@kernel
def cholesky_solve(a, x, n):  # type: ignore[no-untyped-def]
    """Solves a x = b for a symmetric positive definite matrix.

    Args:
        a: (n, n), lower triangle; overwritten.
        x: (n,), b on entry, the solution on exit.
        n: size.
    """
    for j in range(n):
        d = a[j, j]
        for k in range(j):
            d -= a[j, k] * a[j, k]
        d = 1.0 / math.sqrt(d)
        a[j, j] = d
        for i in range(j + 1, n):
            v = a[i, j]
            for k in range(j):
                v -= a[i, k] * a[j, k]
            a[i, j] = v * d
    for i in range(n):
        v = x[i]
        for k in range(i):
            v -= a[i, k] * x[k]
        x[i] = v * a[i, i]
    for i in range(n - 1, -1, -1):
        v = x[i]
        for k in range(i + 1, n):
            v -= a[k, i] * x[k]
        x[i] = v * a[i, i]


@kernel
def normal_equations(jac, e, weight, q, lower, upper, free, a, g):  # type: ignore[no-untyped-def]
    """J^T W J and J^T W e, with the joints held that stand at a limit and would leave it.

    Args:
        jac: (6, n). e, weight: (6,). q, lower, upper: (n,). free: (n,), joints without limits.
        a: (n, n), lower triangle written. g: (n,), written.
    """
    n = g.shape[0]
    for i in range(n):
        slope = 0.0
        for c in range(6):
            slope += weight[c] * jac[c, i] * e[c]
        g[i] = slope
        for j in range(i + 1):
            h = 0.0
            for c in range(6):
                h += weight[c] * jac[c, i] * jac[c, j]
            a[i, j] = h
    for i in range(n):
        if not free[i] and ((q[i] >= upper[i] and g[i] > 0.0) or (q[i] <= lower[i] and g[i] < 0.0)):
            a[i, :i] = 0.0
            a[i + 1 :, i] = 0.0
            a[i, i] = 1.0
            g[i] = 0.0


@kernel
def half_square(weight, e):  # type: ignore[no-untyped-def]
    """E = e^T W e / 2."""
    energy = 0.0
    for i in range(6):
        energy += 0.5 * weight[i] * e[i] * e[i]
    return energy


@kernel
def some_angles(weight):  # type: ignore[no-untyped-def]
    """Whether some but not all of the three angles are asked for."""
    asked = 0
    for i in range(3, 6):
        asked += weight[i] > 0.0
    return 0 < asked < 3


@kernel
def wrap(prismatic, lower, upper, centre, q):  # type: ignore[no-untyped-def]
    """Turns angles by whole turns into their limits, as near to ``centre`` as that allows.

    Args:
        prismatic: (k,). lower, upper, centre: (n,); centre within the limits.
        q: (n,), changed in place.

    Returns:
        True where every entry is within its limits.
    """
    inside = True
    turn = 2.0 * math.pi
    for i in range(q.shape[0]):
        if i < prismatic.shape[0] and not prismatic[i]:
            q[i] -= turn * math.floor((q[i] - centre[i]) / turn + 0.5)
            if q[i] > upper[i] and q[i] - turn >= lower[i]:
                q[i] -= turn
            elif q[i] < lower[i] and q[i] + turn <= upper[i]:
                q[i] += turn
        inside = inside and lower[i] <= q[i] <= upper[i]
    return inside


@kernel
def nearest(table, target, weight, distance):  # type: ignore[no-untyped-def]
    """Distance of every pose of the table to the target, squared and weighted.

    Args:
        table: (12, S), poses.
        target: (12,).
        weight: (6,), of the squared error; the orientation counts where all of it is asked for.
        distance: (S,), written.
    """
    distance[:] = 0.0
    turned = weight[3] * weight[4] * weight[5] > 0.0
    for i in range(3):
        if weight[i] > 0.0:
            for s in range(distance.shape[0]):
                d = table[4 * i + 3, s] - target[4 * i + 3]
                distance[s] += weight[i] * d * d
        if turned:
            for j in range(4 * i, 4 * i + 3):
                for s in range(distance.shape[0]):
                    # half of 3 - trace(R^T R_d) = 1 - cos(angle), about half the angle squared
                    distance[s] -= 0.5 * table[j, s] * target[j]


NEAREST = 20
"""Searches that begin at the nearest states of the table. Where these have all failed they ended
in the same place many times over, and the others begin anywhere: near limits twice as many poses
are met so."""


@kernel
def search_rows(problem, targets, guesses, guessed, q_out, outcome, first, last):  # type: ignore[no-untyped-def]
    """Searches for rows first to last - 1, each on its own.

    Args:
        problem: :class:`Search`.
        targets: (N, 12), rows of [R | p].
        guesses: (N or 1, n), where to start first; middle of the limits where there is no guess.
        guessed: whether to start there, or only prefer angles near there.
        q_out: (N, n), written: the answer, or the nearest within the limits.
        outcome: (N, 3), integers, written: how it ended, iterations, searches.
        first, last: range of rows.
    """
    fixed, prismatic, weight = problem.fixed, problem.prismatic, problem.weight
    lower, upper, starts = problem.lower, problem.upper, problem.starts
    n, k = lower.shape[0], prismatic.shape[0]
    tol_position = _MARGIN * problem.tolerances[0]
    tol_rotation = _MARGIN * problem.tolerances[1]
    axes, pose, r, e = np.empty((k, 6)), np.empty(12), np.empty(9), np.empty(6)
    jac, a, dq = np.zeros((6, n)), np.empty((n, n)), np.empty(n)
    q, free = np.empty(n), np.empty(n, np.bool_)
    distance = np.empty(starts.shape[0])
    partly = some_angles(weight)
    for row in range(first, last):
        target = targets[row]
        centre = guesses[row % guesses.shape[0]]
        best, best_end, total, tried = np.inf, STALLED, 0, 0
        measured = False
        far = 0.0
        for i in range(3):
            if weight[i] > 0.0:
                far += (target[4 * i + 3] - fixed[0, 4 * i + 3]) ** 2
        tries = 1 if math.sqrt(far) > problem.reach + tol_position else problem.searches
        while tried < tries:
            if guessed and tried == 0:
                put(centre, q)
            else:
                if not measured:
                    nearest(problem.table, target, weight, distance)
                    measured = True
                if tried == NEAREST:
                    for i in range(distance.shape[0]):
                        if distance[i] < np.inf:
                            distance[i] = 0.0
                choice = np.argmin(distance)
                distance[choice] = np.inf
                put(starts[choice], q)
            tried += 1
            put(problem.wide, free)
            corrected = False
            end, mark, energy = RUNNING, np.inf, np.inf
            for step in range(problem.iterations):
                total += 1
                frames(fixed, prismatic, q, axes, pose)
                pose_error(pose, target, r, e)
                position, rotation = 0.0, 0.0
                for i in range(3):
                    if weight[i] > 0.0:
                        position += e[i] * e[i]
                    if weight[i + 3] > 0.0:
                        rotation += e[i + 3] * e[i + 3]
                energy = half_square(weight, e)
                if position <= tol_position**2 and rotation <= tol_rotation**2:
                    if wrap(prismatic, lower, upper, centre, q):
                        end = CONVERGED
                        break
                    end = OUTSIDE
                    if best_end != OUTSIDE:
                        best, best_end = 0.0, OUTSIDE
                        put(q, q_out[row])
                    if corrected:
                        break
                    corrected = True
                    for i in range(n):
                        if q[i] < lower[i] or q[i] > upper[i]:
                            q[i] = min(max(q[i], lower[i]), upper[i])
                            free[i] = False
                    end, mark = RUNNING, np.inf
                    continue
                if step % problem.patience == problem.patience - 1:
                    if energy > 0.5 * mark:
                        end = STALLED
                        break
                    mark = energy
                columns(prismatic, axes, pose, jac)
                if partly:
                    turn_rows(jac, e, k)
                normal_equations(jac, e, weight, q, lower, upper, free, a, dq)
                for i in range(n):
                    a[i, i] += problem.damping * energy + problem.floor
                cholesky_solve(a, dq, n)
                for i in range(n):
                    q[i] += dq[i]
                    if not free[i]:
                        q[i] = min(max(q[i], lower[i]), upper[i])
            if end == CONVERGED:
                best_end = CONVERGED
                put(q, q_out[row])
                break
            if best_end != OUTSIDE:
                wrap(prismatic, lower, upper, centre, q)
                for i in range(n):
                    q[i] = min(max(q[i], lower[i]), upper[i])
                frames(fixed, prismatic, q, axes, pose)
                pose_error(pose, target, r, e)
                energy = half_square(weight, e)
                if energy < best:
                    best, best_end = energy, end
                    put(q, q_out[row])
        outcome[row, 0], outcome[row, 1], outcome[row, 2] = best_end, total, tried


@kernel
def settle_rows(problem, iterations, targets, q, first, last):  # type: ignore[no-untyped-def]
    """Walks from the best of failed searches down to the nearest point of rest within limits.

    A search gives up early where it cannot succeed; this one ends where E is least, so that the
    closest pose is handed back. Here E does not vanish, so a step that raises it is taken back
    and the damping adapted (Marquardt 1963).

    Args:
        problem, targets: as in :func:`search_rows`. iterations: at most.
        q: (N, n), within the limits; changed in place.
        first, last: range of rows.
    """
    fixed, prismatic, weight = problem.fixed, problem.prismatic, problem.weight
    lower, upper = problem.lower, problem.upper
    n, k = lower.shape[0], prismatic.shape[0]
    axes, pose, r, e = np.empty((k, 6)), np.empty(12), np.empty(9), np.empty(6)
    jac, a, g = np.zeros((6, n)), np.empty((n, n)), np.empty(n)
    trial, free = np.empty(n), np.zeros(n, np.bool_)
    partly = some_angles(weight)
    for row in range(first, last):
        target = targets[row]
        put(q[row], trial)
        energy, mu = np.inf, 1e-2
        for _ in range(iterations):
            frames(fixed, prismatic, trial, axes, pose)
            pose_error(pose, target, r, e)
            now = half_square(weight, e)
            if now < energy:
                rest = now > (1.0 - 1e-12) * energy
                energy = now
                put(trial, q[row])
                mu = max(0.2 * mu, 1e-12)
                if rest:
                    break
            else:
                mu *= 5.0
                if mu > 1e12:
                    break
                frames(fixed, prismatic, q[row], axes, pose)
                pose_error(pose, target, r, e)
            columns(prismatic, axes, pose, jac)
            if partly:
                turn_rows(jac, e, k)
            normal_equations(jac, e, weight, q[row], lower, upper, free, a, g)
            for i in range(n):
                a[i, i] += mu
            cholesky_solve(a, g, n)
            for i in range(n):
                trial[i] = min(max(q[row, i] + g[i], lower[i]), upper[i])
