"""``Motion``: joint positions, velocities and accelerations over time, exact between the samples.

A motion is one piecewise polynomial of fifth degree at most, with continuous positions and
velocities; accelerations may jump where pieces meet (a trapezoid's corners). So its largest speeds
and accelerations are roots of polynomials, found to rounding, not the largest of some samples.
"""

from __future__ import annotations

import csv
import io
from collections.abc import Callable
from dataclasses import dataclass, field
from itertools import pairwise
from math import factorial
from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import ArrayLike
from scipy.interpolate import BPoly, PPoly, make_interp_spline

from kinlab.arrays import Array, frozen, number, real_array
from kinlab.engine.states import joint_vector
from kinlab.errors import FileError, OptionError, StateError
from kinlab.host.files import read_text, write_text
from kinlab.model.library import ArmLike, as_robot

MOST_SAMPLES = 1_000_000


@dataclass(frozen=True)
class Peak:
    """The largest absolute value of each joint over a motion, and when it is reached.

    Attributes:
        value: (n,). when: (n,), s.
    """

    value: Array
    when: Array


@dataclass(frozen=True, eq=False)
class Motion:
    """A motion of an arm; what takes ``t, q, v, a`` as arrays takes this one's.

    Attributes:
        robot: name of the arm.
        law: how it was planned, in a word.
        t: times from 0, (N,), s.
        q, v, a: joint positions, velocities, accelerations, (N, n), rad (m) and per s, s².
        curve: the same at all times, ``scipy.interpolate.PPoly`` of (k, M, n).
        poses: what the tool was asked to do at the samples, (N, 4, 4); of a tool motion only.
        remarks: what was noticed while planning.
    """

    robot: str
    law: str
    t: Array
    q: Array
    v: Array
    a: Array
    curve: Any = field(repr=False)
    poses: Array | None = field(default=None, repr=False)
    remarks: tuple[str, ...] = ()

    def __len__(self) -> int:
        return len(self.t)

    def __repr__(self) -> str:
        return (
            f"Motion({self.robot!r}, {self.law}: {self.duration:.6g} s, {len(self)} samples, "
            f"{self.q.shape[1]} joints)"
        )

    @property
    def duration(self) -> float:
        """s."""
        return float(self.curve.x[-1])

    @property
    def knots(self) -> Array:
        """Times where pieces meet, first and last included, (M+1,), s."""
        return np.array(self.curve.x)

    @property
    def peak_velocity(self) -> Peak:
        """Largest |v| of each joint at any time, exact to rounding."""
        return peak_of(self.curve, 1)

    @property
    def peak_acceleration(self) -> Peak:
        """Largest |a| of each joint at any time, exact to rounding."""
        return peak_of(self.curve, 2)

    def at(self, t: ArrayLike) -> tuple[Array, Array, Array]:
        """Position, velocity and acceleration at any times.

        Args:
            t: times, (K,) or one, s, within 0 and :attr:`duration`.

        Returns:
            q, v, a, each (K, n) or (n,). Where a jumps, its value after the jump.

        Raises:
            OptionError: a time outside the motion.
        """
        times = real_array(t, "t", OptionError)
        slack = 1e-9 * self.duration
        if np.any(times < -slack) or np.any(times > self.duration + slack):
            raise OptionError(f"t lies outside the motion; it lasts from 0 to {self.duration:g} s")
        inside = np.clip(times, 0.0, self.duration)
        q, v, a = (np.asarray(self.curve(inside, order)) for order in range(3))
        return q, v, a

    def sampled(self, step: float) -> Motion:
        """The same motion with samples at most ``step`` seconds apart, evenly spaced.

        Raises:
            OptionError: a step that is not positive, or too many samples.
        """
        return motion_of(self.robot, self.law, self.curve, step, None, self.remarks)

    def stretched(self, factor: float) -> Motion:
        """The same way in ``factor`` times the time: v falls as 1/factor, a as 1/factor².

        Raises:
            OptionError: a factor that is not positive.
        """
        by = number(factor, "factor", above=0.0)
        t, v, a = (frozen(x) for x in (self.t * by, self.v / by, self.a / by**2))
        curve = stretch(self.curve, by)
        return Motion(self.robot, self.law, t, self.q, v, a, curve, self.poses, self.remarks)

    def write(self, path: str | Path) -> Path:
        """Writes a CSV file with the columns t, q1 ... qn, v1 ... vn, a1 ... an.

        Raises:
            FileError: the file cannot be written.
        """
        n = self.q.shape[1]
        text = io.StringIO()
        writer = csv.writer(text, lineterminator="\n")
        writer.writerow(["t", *(f"{name}{i + 1}" for name in "qva" for i in range(n))])
        rows = np.hstack([self.t[:, np.newaxis], self.q, self.v, self.a])
        writer.writerows([[repr(float(x)) for x in row] for row in rows])
        write_text(Path(path), text.getvalue())
        return Path(path)


def motion_of(
    name: str,
    law: str,
    curve: Any,
    step: float,
    poses: Array | None = None,
    remarks: tuple[str, ...] = (),
    times: Array | None = None,
) -> Motion:
    """The motion of a curve, sampled evenly, or at given times.

    Raises:
        OptionError: a step that is not positive, or too many samples.
    """
    if times is None:
        times = even_times(float(curve.x[-1]), step)
    q, v, a = (frozen(curve(times, order)) for order in range(3))
    # at its end a motion rests or not; the last piece says so, not what an extrapolation would
    return Motion(name, law, frozen(times), q, v, a, curve, poses, remarks)


def even_times(duration: float, step: float) -> Array:
    """Times from 0 to a duration, evenly spaced and at most a step apart.

    Raises:
        OptionError: a step that is not positive, or too many samples.
    """
    wide = number(step, "step", above=0.0)
    if duration / wide > MOST_SAMPLES:
        raise OptionError(
            f"step is {wide:g}: {duration:g} s would be more than {MOST_SAMPLES} samples"
        )
    return np.linspace(0.0, duration, max(2, int(np.ceil(duration / wide - 1e-9)) + 1))


def hermite(times: Array, q: Array, v: Array, before: Array, after: Array) -> Any:
    """The curve of fifth degree through q with velocities v and one-sided accelerations.

    Args:
        times: (N,). q, v: (N, n).
        before, after: accelerations on the two sides of each time, (N, n).
    """
    pieces = np.diff(times)[:, np.newaxis]
    # Bernstein coefficients of each piece from value and derivatives at both of its ends
    near, far = slice(None, -1), slice(1, None)
    b0, b5 = q[near], q[far]
    b1, b4 = b0 + pieces * v[near] / 5.0, b5 - pieces * v[far] / 5.0
    b2 = pieces**2 * after[near] / 20.0 + 2.0 * b1 - b0
    b3 = pieces**2 * before[far] / 20.0 + 2.0 * b4 - b5
    return PPoly.from_bernstein_basis(BPoly(np.stack([b0, b1, b2, b3, b4, b5]), times))


def along_lines(rows: Array, law: Callable[[Array], Any]) -> Any:
    """Straight lines from point to point (K, n), at rest in each, as pieces.

    Args:
        rows: the points.
        law: from a line, end minus start (n,), to its curve from 0 to 1 (``PPoly`` of (k, M)).
    """
    breaks, pieces = [np.zeros(1)], []
    for one, two in pairwise(rows):
        unit = law(two - one)
        coefficients = unit.c[:, :, np.newaxis] * (two - one)
        coefficients[-1] += one
        pieces.append(coefficients)
        breaks.append(breaks[-1][-1] + unit.x[1:])
    return PPoly(np.concatenate(pieces, axis=1), np.concatenate(breaks))


def pieces_of(spline: Any) -> Any:
    """A spline of n joints (``scipy.interpolate.BSpline``) as pieces."""
    breaks = np.unique(spline.t)
    orders = range(spline.k, -1, -1)
    rows = [spline(breaks[:-1], order) / factorial(order) for order in orders]
    return PPoly(np.stack(rows), breaks)


def stretch(curve: Any, factor: float) -> Any:
    """The same way in ``factor`` times the time."""
    powers = np.arange(len(curve.c) - 1, -1, -1.0)
    return PPoly(curve.c / factor ** powers[:, np.newaxis, np.newaxis], curve.x * factor)


def peak_of(curve: Any, order: int) -> Peak:
    """Largest |derivative| of each joint of a curve, and when.

    Candidates are both ends of every piece and the zeros of the next derivative.
    """
    n = curve.c.shape[2]
    wanted = curve.derivative(order) if order else curve
    lengths = np.diff(wanted.x)
    begin, end = wanted.c[-1], _ends(wanted.c, lengths)
    value, when = np.zeros(n), np.zeros(n)
    slope = wanted.derivative()
    for joint in range(n):
        times = np.concatenate([wanted.x[:-1], wanted.x[1:]])
        values = np.abs(np.concatenate([begin[:, joint], end[:, joint]]))
        zeros = PPoly(slope.c[:, :, joint], slope.x).roots(discontinuity=False, extrapolate=False)
        zeros = zeros[np.isfinite(zeros)]
        if len(zeros):
            inner = np.abs(PPoly(wanted.c[:, :, joint], wanted.x)(zeros))
            times, values = np.concatenate([times, zeros]), np.concatenate([values, inner])
        at = int(np.argmax(values >= values.max() * (1.0 - 1e-12)))  # of equal ones the first
        value[joint], when[joint] = values[at], times[at]
    return Peak(frozen(value), frozen(when))


def _ends(c: Array, lengths: Array) -> Array:
    """Values at the far ends of all pieces, by Horner, (M, n) from (k, M, n)."""
    out = np.zeros(c.shape[1:])
    for row in c:
        out = out * lengths[:, np.newaxis] + row
    return out


# -------- Motions from numbers of one's own


def from_samples(
    robot: ArmLike,
    t: ArrayLike,
    q: ArrayLike,
    v: ArrayLike | None = None,
    a: ArrayLike | None = None,
) -> Motion:
    """A motion through samples: of q alone a spline of fifth degree, of q, v and a Hermite's.

    Args:
        robot: the arm.
        t: times that grow, (N,), s; counted from the first.
        q: joint positions, (N, n), N at least 6 where v and a are left out, else 2.
        v, a: velocities and accelerations, (N, n); both, or neither.

    Raises:
        StateError: shapes that do not agree, or not finite.
        OptionError: times that do not grow, too few samples, or only one of v and a.
    """
    robot = as_robot(robot)
    where = f"robot {robot.name!r}: motion"
    times = real_array(t, f"{where}: t", OptionError)
    rows = joint_vector(robot, q, "q")
    least = 6 if v is None else 2
    if rows.ndim != 2 or times.shape != (len(rows),) or len(rows) < least:
        raise StateError(
            f"{where}: t {times.shape} and q {rows.shape}; expected (N,) and (N, {robot.n}), N at "
            f"least {least}"
        )
    if np.any(np.diff(times) <= 0.0):
        row = int(np.argmax(np.diff(times) <= 0.0)) + 1
        raise OptionError(f"{where}: t does not grow at row {row} ({times[row]:g} s)")
    if (v is None) != (a is None):
        raise OptionError(f"{where}: give both v and a, or neither")
    times = times - times[0]
    if v is None or a is None:
        curve = pieces_of(make_interp_spline(times, rows, k=5))
        return motion_of(robot.name, "samples", curve, 1.0, times=times)
    speed, gain = joint_vector(robot, v, "v"), joint_vector(robot, a, "a")
    if speed.shape != rows.shape or gain.shape != rows.shape:
        raise StateError(f"{where}: v {speed.shape}, a {gain.shape}; expected {rows.shape}")
    curve = hermite(times, rows, speed, gain, gain)
    return Motion(
        robot.name, "samples", frozen(times), frozen(rows), frozen(speed), frozen(gain), curve
    )


def read_motion(robot: ArmLike, path: str | Path) -> Motion:
    """Reads a CSV file of :meth:`Motion.write`, or one with the columns t and q1 ... qn only.

    Raises:
        FileError: no such file, another header, or a cell that is no number (says which).
        StateError, OptionError: as :func:`from_samples`.
    """
    robot = as_robot(robot)
    lines = [row for row in csv.reader(io.StringIO(read_text(path))) if row]
    header = [cell.strip() for cell in lines[0]] if lines else []
    wide = ["t", *(f"{name}{i + 1}" for name in "qva" for i in range(robot.n))]
    if header not in (wide, wide[: robot.n + 1]):
        raise FileError(
            f"{path}: the header is {', '.join(header) or 'missing'}; expected "
            f"t, q1 ... q{robot.n}, and then v1 ... v{robot.n}, a1 ... a{robot.n} or nothing"
        )
    rows = []
    for number_, row in enumerate(lines[1:], 2):
        try:
            rows.append([float(cell) for cell in row])
        except ValueError:
            bad = next(cell for cell in row if not _reads(cell))
            raise FileError(f"{path}, line {number_}: {bad!r} is no number") from None
        if len(row) != len(header):
            raise FileError(f"{path}, line {number_}: {len(row)} cells; expected {len(header)}")
    table = np.array(rows).reshape(-1, len(header))
    n = robot.n
    if len(header) == n + 1:
        return from_samples(robot, table[:, 0], table[:, 1:])
    return from_samples(
        robot, table[:, 0], *(table[:, 1 + k * n : 1 + (k + 1) * n] for k in range(3))
    )


def _reads(cell: str) -> bool:
    try:
        float(cell)
    except ValueError:
        return False
    return True
