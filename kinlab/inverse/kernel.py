"""The compiled search: Levenberg-Marquardt with restarts on a serial chain.

Importing this module imports numba. :mod:`kinlab.inverse.methods` and ``solve`` hold the same
method over Pinocchio calls, slow and readable; the two are tested against each other.

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

import numpy as np

from kinlab.chain import columns, frames
from kinlab.compiled import kernel
from kinlab.inverse.kernel_parts import (
    cholesky_solve,
    half_square,
    nearest,
    normal_equations,
    pose_error,
    some_angles,
    turn_rows,
    wrap,
)

CONVERGED, OUTSIDE, STALLED, RUNNING = 0, 1, 2, 3
"""How the best search ended: tolerance met; met, but outside the limits; no more progress;
still making progress when its iterations ran out."""

_MARGIN = 0.99
"""Share of the tolerance that a search must meet: Pinocchio, which has the last word, rounds
differently."""


@kernel
def search_rows(  # type: ignore[no-untyped-def]
    fixed, prismatic, lower, upper, wide, weight, numbers, table, starts,
    targets, guesses, guessed, q_out, outcome, first, last,
):  # fmt: skip
    """Searches for rows first to last - 1, each on its own.

    Args:
        fixed, prismatic: the chain (:mod:`kinlab.chain`).
        lower, upper: (n,), limits.
        wide: (n,), bool: joints left free inside the iteration.
        weight: (6,), of the squared error, zero for what is not asked for.
        numbers: (8,): tolerance in metres, in radians, damping, floor of the damping,
            iterations a search, searches, iterations in which E must halve, reach from the
            first joint (infinite: not known).
        table: (12, S), poses of the starts. starts: (S, n).
        targets: (N, 12), rows of [R | p].
        guesses: (N or 1, n), where to start first; middle of the limits where there is no guess.
        guessed: whether to start there, or only prefer angles near there.
        q_out: (N, n), written: the answer, or the nearest within the limits.
        outcome: (N, 3), integers, written: how it ended, iterations, searches.
        first, last: range of rows.
    """
    n, k = lower.shape[0], prismatic.shape[0]
    tol_position, tol_rotation = _MARGIN * numbers[0], _MARGIN * numbers[1]
    damping, floor = numbers[2], numbers[3]
    iterations, searches, patience = int(numbers[4]), int(numbers[5]), int(numbers[6])
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
        tries = 1 if math.sqrt(far) > numbers[7] + tol_position else searches
        while tried < tries:
            if guessed and tried == 0:
                q[:] = centre
            else:
                if not measured:
                    nearest(table, target, weight, distance)
                    measured = True
                choice = np.argmin(distance)
                distance[choice] = np.inf
                q[:] = starts[choice]
            tried += 1
            free[:] = wide
            corrected = False
            end, mark, energy = RUNNING, np.inf, np.inf
            for step in range(iterations):
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
                        q_out[row] = q
                    if corrected:
                        break
                    corrected = True
                    for i in range(n):
                        if q[i] < lower[i] or q[i] > upper[i]:
                            q[i] = min(max(q[i], lower[i]), upper[i])
                            free[i] = False
                    end, mark = RUNNING, np.inf
                    continue
                if step % patience == patience - 1:
                    if energy > 0.5 * mark:
                        end = STALLED
                        break
                    mark = energy
                columns(prismatic, axes, pose, jac)
                if partly:
                    turn_rows(jac, e, k)
                normal_equations(jac, e, weight, q, lower, upper, free, a, dq)
                for i in range(n):
                    a[i, i] += damping * energy + floor
                cholesky_solve(a, dq, n)
                for i in range(n):
                    q[i] += dq[i]
                    if not free[i]:
                        q[i] = min(max(q[i], lower[i]), upper[i])
            if end == CONVERGED:
                best_end = CONVERGED
                q_out[row] = q
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
                    q_out[row] = q
        outcome[row, 0], outcome[row, 1], outcome[row, 2] = best_end, total, tried


@kernel
def settle_rows(  # type: ignore[no-untyped-def]
    fixed, prismatic, lower, upper, weight, iterations, targets, q, first, last
):
    """Walks from the best of failed searches down to the nearest point of rest within limits.

    A search gives up early where it cannot succeed; this one ends where E is least, so that the
    closest pose is handed back. Here E does not vanish, so a step that raises it is taken back
    and the damping adapted (Marquardt 1963).

    Args:
        fixed, prismatic, lower, upper, weight, targets: as in :func:`search_rows`.
        iterations: at most.
        q: (N, n), within the limits; changed in place.
        first, last: range of rows.
    """
    n, k = lower.shape[0], prismatic.shape[0]
    axes, pose, r, e = np.empty((k, 6)), np.empty(12), np.empty(9), np.empty(6)
    jac, a, g = np.zeros((6, n)), np.empty((n, n)), np.empty(n)
    trial, free = np.empty(n), np.zeros(n, np.bool_)
    partly = some_angles(weight)
    for row in range(first, last):
        target = targets[row]
        trial[:] = q[row]
        energy, mu = np.inf, 1e-2
        for _ in range(iterations):
            frames(fixed, prismatic, trial, axes, pose)
            pose_error(pose, target, r, e)
            now = half_square(weight, e)
            if now < energy:
                rest = now > (1.0 - 1e-12) * energy
                energy = now
                q[row] = trial
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
