"""Measured poses: a cell is named where its slip stands clear of the noise.

Every candidate (another reading of the table, one cell solved for, the base, the tool) is fitted
to the poses by least squares. The noise is what remains when all cells, base and tool are fitted
together, as in kinematic calibration (Siciliano et al., section 2.11). A candidate is named if
nothing significant remains beyond that noise, the table as written stands far out of it, and what
fits as well is listed.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, replace
from typing import Any

import numpy as np

from kinlab.arrays import Array
from kinlab.doctor.tables.cells import changed, screw
from kinlab.doctor.tables.chain import (
    ALPHA,
    AXIS_OF,
    THETA,
    A,
    Chain,
    D,
    frames,
    inverse,
    stacked_frames,
)
from kinlab.doctor.tables.readings import Reading, readings
from kinlab.doctor.tables.reference.against import Reference
from kinlab.doctor.tables.reference.target import Target
from kinlab.doctor.tables.result import TableDiagnosis, stated
from kinlab.doctor.tables.words import pose_cause
from kinlab.host.language import _
from kinlab.model.dh import DHTable
from kinlab.model.rotations import rotations_along
from kinlab.tolerances import TOLERANCES

_LARGEST = (5e-3, 5e-3)
"""Noise above this (over the arm's size, rad) is not taken for noise: something else is wrong."""

_CLEAR = 8.0
"""How far what a table leaves over the noise must stand out, as residual over noise (rms over the
states) times the square root of their number, before it is called a slip."""

_AS_GOOD = 12.0
"""Difference of chi-square below which two explanations count as equally good."""


_STANDS_OUT, _FARTHER = 6.0, 3.0
"""How far a pose is off whose fit stands out: as often as the median, and as the worst other one
where it is not fitted."""

_CUTS = (1e-6, 1e-4, 1e-3, 1e-2, 1e-1)
"""Shares of the largest singular value below which a direction of the fit is left alone."""


@dataclass(frozen=True, eq=False)
class _Fit:
    """A candidate with its numbers fitted."""

    reading: Reading
    unknowns: int
    chi: float


@dataclass(frozen=True, eq=False)
class Calibration:
    """All cells, base and tool fitted to poses together.

    Attributes:
        target: the poses.
        candidates: what was fitted alone, and may be what is meant.
        chain: the fit.
    """

    target: Target
    candidates: list[Reading]
    chain: Chain

    @staticmethod
    def of(chain: Chain, target: Target) -> Calibration | None:
        """The best fit from a table and the likeliest candidates; None of too few poses."""
        if 6 * len(target.q) < 2 * (4 * chain.n + 12):
            return None
        candidates = _candidates(Reading(chain), target)
        rough = (1e-3 * target.size, 1e-3)
        starts = sorted(candidates, key=lambda one: _chi(one.chain, target, rough))[:4]
        fits = (_calibrated(one, target) for one in [chain, *(x.chain for x in starts)])
        best = min(fits, key=lambda one: _chi(one, target, rough))
        return Calibration(target, candidates, best)

    def misses(self, target: Target) -> Array:
        """How far each of some poses is off beside the fit, lengths over the arm's size, (N,)."""
        rest = _rest(frames(self.chain, target.q)[:, -1], target)
        weight = np.repeat([1.0 / self.target.size, 1.0], 3)
        out: Array = np.linalg.norm(rest * weight, axis=1)
        return out


def judge(
    table: DHTable, reference: Reference, fit: Calibration | None, notes: Sequence[str]
) -> TableDiagnosis | None:
    """A verdict on a table from poses with noise.

    Args:
        table: the user's table.
        reference: poses.
        fit: to these.
        notes: for the result.

    Returns:
        The diagnosis; None where what remains is too large for noise, or nothing, or where the
        poses are too few.
    """
    chain, target = Chain.of(table), reference.target
    numbers = 6 * len(target.q)
    if fit is None:
        return None
    candidates, full = fit.candidates, fit.chain
    sigma, rank = _noise(full, target)
    if max(sigma[0] / target.size, sigma[1]) < TOLERANCES.exact_poses:
        return None
    if sigma[0] > _LARGEST[0] * target.size or sigma[1] > _LARGEST[1]:
        return None
    least = _chi(full, target, sigma)
    room = rank + 5.0 * np.sqrt(2.0 * rank)
    written = _chi(chain, target, sigma) - least
    common = reference.facts(table, target.error(chain), notes)
    rows = tuple(range(1, table.n + 1))
    clear = {"sigma_position": float(sigma[0]), "sigma_angle_deg": float(np.degrees(sigma[1]))}
    common["clear"], names = clear, {"table": table.name, "reference": reference.name}
    if written <= room:
        said = _("{table} agrees with {reference} within their noise").format(**names)
        length, angle = _hidden(full, target, sigma, room)
        clear |= {"hidden_length": float(length), "hidden_angle_deg": float(np.degrees(angle))}
        unseen = reference.unseen(chain)
        sure = tuple(i for i in rows if i not in unseen)
        right: dict[str, Any] = {"repaired": table, "same_arm": not unseen, "certain_rows": sure}
        return TableDiagnosis(agrees=True, sentence=said, **right, **common)
    effect = float(np.sqrt((written + numbers) / numbers))
    fits = _fitted(candidates, chain, target, sigma)
    good = [fit for fit in fits if fit.chi - least <= room]
    clear["effect"] = effect
    if not good or written < _CLEAR**2 + room:
        said = _(
            "{table} is not the arm of {reference}, beyond the noise; no single slip explains it"
        ).format(**names)
        return TableDiagnosis(agrees=False, sentence=said, rows_in_question=rows, **common)
    best = min(fit.chi + 2.0 * fit.unknowns for fit in good)
    equal = [fit for fit in good if fit.chi + 2.0 * fit.unknowns - best <= _AS_GOOD]
    equal.sort(key=lambda fit: (round(fit.reading.cost, 6), round(fit.chi, 6)))
    others = [fit.chi for fit in fits if fit not in equal]
    if others:
        clear["runner_up"] = float(np.sqrt(min(others) / numbers))
    first = equal[0].reading
    wrong = {row for cause in first.causes for row in cause.rows}
    return TableDiagnosis(
        agrees=False,
        sentence=stated(first.causes, bool(reference.unseen(chain))),
        causes=first.causes,
        alternatives=tuple(fit.reading.causes for fit in equal[1:]),
        repaired=first.chain.apply(table),
        error_after=target.error(first.chain),
        rows_in_question=tuple(sorted(wrong)),
        certain_rows=tuple(i for i in rows if wrong and i not in wrong),
        **common,
    )


def standing_out(chain: Chain, fit: Calibration | None) -> list[int]:
    """The poses that are off by far more than the others can be, counted from 0.

    Each is left out of a fit of all cells, base and tool, beside which it is off all the same: a
    marker that was lost, a row that was typed wrong. At most a tenth of all.

    Args:
        chain: the user's table.
        fit: to all the poses.
    """
    bad: list[int] = []
    if fit is None:
        return bad
    whole = fit.target
    kept = np.arange(len(whole.q))
    for _turn in range(max(1, len(kept) // 10)):
        misses = fit.misses(_some(whole, kept))
        worst = int(np.argmax(misses))
        rest = np.delete(kept, worst)
        if misses[worst] <= _STANDS_OUT * max(np.median(misses), TOLERANCES.exact_poses):
            break
        fewer = Calibration.of(chain, _some(whole, rest))
        if fewer is None:
            break
        most = max(float(np.max(fewer.misses(fewer.target))), TOLERANCES.exact_poses)
        if fewer.misses(_some(whole, kept[[worst]]))[0] <= _FARTHER * most:
            break
        bad.append(int(kept[worst]))
        kept, fit = rest, fewer
    return sorted(bad)


def without(reference: Reference, bad: Sequence[int]) -> Reference:
    """The same poses but for some."""
    kept = np.delete(np.arange(len(reference.target.q)), bad)
    return replace(reference, target=_some(reference.target, kept))


def _some(target: Target, which: Any) -> Target:
    return Target(target.q[which], target.poses[which], target.tolerance)


def _hidden(chain: Chain, target: Target, sigma: tuple[float, float], room: float) -> Array:
    """The largest slips of one length, and of one angle, that would not show: m and rad."""
    slopes = _slopes(chain, frames(chain, target.q))[:, : 4 * chain.n] / np.repeat(sigma, 3)
    sizes = np.sqrt(np.sum(slopes * slopes, axis=(0, 2))).reshape(chain.n, 4)
    seen = np.sqrt(room) / np.where(sizes > TOLERANCES.exact_poses, sizes, np.inf)
    return np.array([np.max(seen[:, [A, D]]), np.max(seen[:, [ALPHA, THETA]])])


def _candidates(plain: Reading, target: Target) -> list[Reading]:
    """Readings without an unknown, and the table with one cell, base or tool solved for."""
    chain = plain.chain
    found = [one for one in readings(chain, [], []) if one.chain.n == chain.n]
    poses = frames(chain, target.q)
    world = target.poses @ inverse(poses[:, -1])
    for row in range(chain.n):
        for column in (A, ALPHA, D, THETA):
            frame = poses[:, chain.frame_of(row, column)]
            motion = np.mean(inverse(frame) @ world @ frame, axis=0)
            angle, length, _off = screw(motion, AXIS_OF[column])
            change = angle if column in (ALPHA, THETA) else length
            start = chain.with_cell(row, column, float(chain.cells[row, column]) + change)
            solved = _solve_cell(start, row, column, target)
            found.append(Reading(start.with_cell(row, column, solved)))
    for which in ("base", "tool"):
        found.append(Reading(_solve_end(chain, which, target)))
    return found


def _solve_cell(chain: Chain, row: int, column: int, target: Target) -> float:
    """Least squares for one cell, by Gauss and Newton from a start near it."""
    value = float(chain.cells[row, column])
    for _step in range(6):
        current = chain.with_cell(row, column, value)
        poses = frames(current, target.q)
        derivative = _slopes(current, poses)[:, 4 * row + column]
        rest = _rest(poses[:, -1], target)
        weight = np.array([1.0 / target.size**2] * 3 + [1.0] * 3)
        size = float(np.sum(weight * derivative * derivative))
        if size < 1e-20:
            break
        step = float(np.sum(weight * derivative * rest)) / size
        value += step
        if abs(step) < 1e-12:
            break
    return value


def _solve_end(chain: Chain, which: str, target: Target) -> Chain:
    """The base or tool that fits best: the mean of what each state asks for, turned rigid."""
    poses = frames(chain, target.q)
    if which == "tool":
        each = chain.tool @ inverse(poses[:, -1]) @ target.poses
    else:
        each = target.poses @ inverse(poses[:, -1]) @ chain.base
    mean = np.mean(each, axis=0)
    U, _sizes, Vt = np.linalg.svd(mean[:3, :3])
    mean[:3, :3] = U @ np.diag([1.0, 1.0, np.linalg.det(U @ Vt)]) @ Vt
    if which == "base":  # the mean weighs errors of rotation by their lever; fit the place anew
        lever = inverse(chain.base) @ poses[:, -1]
        turned = (mean[:3, :3] @ lever[:, :3, 3, None])[..., 0]
        mean[:3, 3] = np.mean(target.poses[:, :3, 3] - turned, axis=0)
    return chain.but(**{which: mean})


def _fitted(
    candidates: list[Reading], chain: Chain, target: Target, sigma: tuple[float, float]
) -> list[_Fit]:
    """Each candidate with a cause and, where a known relation fits as well, its number."""
    fits = []
    for one in candidates:
        if one.causes:
            fits.append(_Fit(one, 0, _chi(one.chain, target, sigma)))
            continue
        told, unknowns = _told(one, chain, target, sigma)
        if told is not None:
            fits.append(_Fit(told, unknowns, _chi(told.chain, target, sigma)))
    return fits


def _told(
    one: Reading, chain: Chain, target: Target, sigma: tuple[float, float]
) -> tuple[Reading | None, int]:
    plain = Reading(chain)
    cells = np.argwhere(one.chain.cells != chain.cells)
    if len(cells):
        row, column = (int(k) for k in cells[0])
        derivative = _slopes(one.chain, frames(one.chain, target.q))[:, 4 * row + column]
        weighed = derivative / np.repeat(sigma, 3)
        size = float(np.sum(weighed * weighed))
        if size == 0.0:
            return None, 0
        slack = 4.0 / float(np.sqrt(size))
        if abs(float(one.chain.cells[row, column] - chain.cells[row, column])) <= slack:
            return None, 0
        value = {(row, column): float(one.chain.cells[row, column])}
        return changed(plain, value, slack), 1
    for which in ("base", "tool"):
        written, solved = getattr(chain, which), getattr(one.chain, which)
        if written is not solved:
            slack = 6.0 * max(sigma) / float(np.sqrt(len(target.q)))
            cause = pose_cause(which, written, solved, None, slack)
            meant = cause.meant
            return Reading(chain.but(**{which: meant}), (cause,)), 6
    return None, 0


def _slopes(chain: Chain, poses: Array) -> Array:
    """Twist of the tool (linear at its origin, then angular) per unit of each cell, base and tool.

    Returns:
        (N, 4 n + 12, 6); cell (row, column) at 4 row + column.
    """
    tool = poses[:, -1, :3, 3]
    out = np.zeros((len(poses), 4 * chain.n + 12, 6))
    for row in range(chain.n):
        for column in range(4):
            frame = poses[:, chain.frame_of(row, column)]
            axis = frame[:, :3, AXIS_OF[column]]
            if column in (ALPHA, THETA):
                out[:, 4 * row + column, :3] = np.cross(axis, tool - frame[:, :3, 3])
                out[:, 4 * row + column, 3:] = axis
            else:
                out[:, 4 * row + column, :3] = axis
    for k, frame in ((0, poses[:, 0]), (6, poses[:, -1])):
        for i in range(3):
            way = frame[:, :3, i]
            out[:, 4 * chain.n + k + i, :3] = way
            out[:, 4 * chain.n + k + 3 + i, :3] = np.cross(way, tool - frame[:, :3, 3])
            out[:, 4 * chain.n + k + 3 + i, 3:] = way
    return out


def _rest(poses: Array, target: Target) -> Array:
    """Twist from the poses to the target's, (..., N, 6)."""
    out = np.zeros((*poses.shape[:-2], 6))
    out[..., :3] = target.poses[..., :3, 3] - poses[..., :3, 3]
    rotation = target.poses[..., :3, :3] @ np.swapaxes(poses[..., :3, :3], -1, -2)
    turned = rotation - np.swapaxes(rotation, -1, -2)
    sine = 0.5 * np.stack([turned[..., 2, 1], turned[..., 0, 2], turned[..., 1, 0]], axis=-1)
    cosine = 0.5 * (np.trace(rotation, axis1=-2, axis2=-1) - 1.0)
    size = np.linalg.norm(sine, axis=-1)
    angle = np.arctan2(size, cosine)
    scale = np.where(size > 1e-9, angle / np.where(size > 1e-9, size, 1.0), 1.0)
    # near half a turn the axis is lost in the sine; the size of the angle is kept
    lost = (size <= 1e-9) & (cosine < 0)
    out[..., 3:] = sine * scale[..., None]
    out[..., 3] = np.where(lost, np.pi, out[..., 3])
    return out


def _chi(chain: Chain, target: Target, sigma: tuple[float, float]) -> float:
    rest = _rest(stacked_frames([chain], target.q)[0, :, -1], target)
    return float(np.sum((rest / np.repeat(sigma, 3)) ** 2))


def _calibrated(chain: Chain, target: Target) -> Chain:
    """All cells, base and tool fitted together, from a start; of least change where not unique."""
    weight = np.repeat([1.0 / target.size, 1.0], 3)

    def error(one: Chain) -> float:
        return float(np.sum((_rest(frames(one, target.q)[:, -1], target) * weight) ** 2))

    current, least = chain, error(chain)
    for _step in range(12):
        poses = frames(current, target.q)
        slopes = _slopes(current, poses) * weight
        rest = (_rest(poses[:, -1], target) * weight).reshape(-1)
        U, values, Vt = np.linalg.svd(
            np.moveaxis(slopes, 1, 2).reshape(len(rest), -1), full_matrices=False
        )
        part = U.T @ rest
        before = least
        for cut in _CUTS:  # nearly parallel axes make directions that mean nothing
            kept = values > cut * values[0]
            step = Vt[kept].T @ (part[kept] / values[kept])
            tried = _stepped(current, step)
            reached = error(tried)
            if reached < least:
                current, least = tried, reached
                break
        if not least < before * (1.0 - 1e-7):
            break
    return current


def _stepped(chain: Chain, step: Array) -> Chain:
    """The chain with its cells changed, and base and tool moved by twists in their own frames."""
    n = chain.n
    size = np.max(np.abs(step))
    step = step * min(1.0, 0.5 / size) if size > 0.5 else step
    ends = {}
    for k, which in ((0, "base"), (6, "tool")):
        part = step[4 * n + k : 4 * n + k + 6]
        move = np.eye(4)
        move[:3, :3] = rotations_along(part[3:])
        move[:3, 3] = part[:3]
        ends[which] = getattr(chain, which) @ move
    return chain.but(cells=chain.cells + step[: 4 * n].reshape(n, 4), **ends)


def _noise(chain: Chain, target: Target) -> tuple[tuple[float, float], int]:
    """Standard deviations of a coordinate and of an angle after the full fit; its rank."""
    poses = frames(chain, target.q)
    slopes = _slopes(chain, poses) * np.repeat([1.0 / target.size, 1.0], 3)
    matrix = np.moveaxis(slopes, 1, 2).reshape(-1, slopes.shape[1])
    values = np.linalg.svd(matrix, compute_uv=False)
    rank = int(np.sum(values > 1e-6 * values[0]))
    rest = _rest(poses[:, -1], target)
    freedom = 3.0 * len(target.q) - 0.5 * rank
    position = float(np.sqrt(np.sum(rest[:, :3] ** 2) / freedom))
    angle = float(np.sqrt(np.sum(rest[:, 3:] ** 2) / freedom))
    return (max(position, 1e-12), max(angle, 1e-12)), rank
