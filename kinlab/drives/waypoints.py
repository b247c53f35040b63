"""Cycles of one's own: way points with dwell, blend, speed and payload, from TOML or CSV.

Between two stops each move follows 10 tau³ - 15 tau⁴ + 6 tau⁵ and neighbours overlap in time, as in
the pick-and-place cycle, which is one of these by the name ``adept``. A stop is the first and last
point, a point with a dwell, with a payload picked or dropped, or with blend 0. Each run from one
stop to the next is as fast as its limits of speed and acceleration allow.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, fields, replace
from pathlib import Path as File
from typing import Any

import numpy as np

from kinlab.arrays import Array, number, real_array, shown
from kinlab.drives.cycles import LIFT, TRAVEL, Path, superpose
from kinlab.drives.laws import quintic_time
from kinlab.drives.records import csv_rows, require_known
from kinlab.errors import ExpressionError, OptionError
from kinlab.formulas.numbers import parse_number
from kinlab.host.files import read_text, read_toml

_SAMPLES = 2000
"""About so many intervals of time in a cycle; each piece between two kinks has an even number."""

_FINER = 16
"""Into so many parts an interval is cut to find the largest speed and acceleration."""

_AXES = ("x", "y", "z")


@dataclass(frozen=True)
class Waypoint:
    """One point of a cycle.

    Attributes:
        at: place, (2,) or (3,), m.
        dwell: rest there, s.
        blend: part of the shorter neighbour that overlaps there, 0 (stop) to 1; none: the cycle's.
        speed: largest speed of the move to this point, m/s; none: the cycle's.
        acceleration: likewise, m/s².
        payload: picked (positive) or dropped (negative) there, at the end of the dwell, kg.
    """

    at: tuple[float, ...]
    dwell: float = 0.0
    blend: float | None = None
    speed: float | None = None
    acceleration: float | None = None
    payload: float = 0.0


@dataclass(frozen=True)
class Cycle:
    """A cycle through way points, from the first and back to it.

    Attributes:
        points: the way points, at least two.
        v_max: m/s. a_max: m/s²; of moves that state none.
        blend: of points that state none.
        closed: the tool returns from the last point to the first.
        name: how messages call it.

    Raises:
        OptionError: a number out of its range, two equal neighbours, a payload that is not there
            to be dropped or not dropped again.
    """

    points: tuple[Waypoint, ...]
    v_max: float
    a_max: float
    blend: float = 0.5
    closed: bool = True
    name: str = "cycle"

    def __post_init__(self) -> None:
        what = f"cycle {self.name!r}"
        for key in ("v_max", "a_max"):
            number(getattr(self, key), f"{what}: {key}", above=0.0)
        _part(self.blend, f"{what}: blend")
        if len(self.points) < 2:
            raise OptionError(f"{what}: {len(self.points)} points; give at least two")
        carried = 0.0
        for k, point in enumerate(self.points, 1):
            place = f"{what}, point {k}"
            at = real_array(point.at, f"{place}: place", OptionError)
            if at.shape not in ((2,), (3,)) or at.shape != np.shape(self.points[0].at):
                raise OptionError(f"{place}: {at.size} coordinates; all points have two or three")
            if number(point.dwell, f"{place}: dwell") < 0.0:
                raise OptionError(f"{place}: dwell is {point.dwell:g} s; it must not be negative")
            if point.blend is not None:
                _part(point.blend, f"{place}: blend")
            for key in ("speed", "acceleration"):
                if getattr(point, key) is not None:
                    number(getattr(point, key), f"{place}: {key}", above=0.0)
            carried += number(point.payload, f"{place}: payload")
            if carried < -1e-9:
                raise OptionError(
                    f"{place}: drops {-point.payload:g} kg, {-carried:.3g} more than is carried"
                )
            if point.blend and (point.dwell or point.payload):
                raise OptionError(
                    f"{place}: the tool stops there (dwell or payload), so blend must be 0"
                )
        if self.closed and abs(carried) > 1e-9:
            raise OptionError(
                f"{what}: {carried:.4g} kg are picked and not dropped again; the next round would "
                "start with them"
            )
        for k, (a, b) in enumerate(self._moves(), 1):
            if np.allclose(a.at, b.at, rtol=0.0, atol=1e-9):
                raise OptionError(f"{what}: move {k} ends where it starts; leave out one point")

    def _moves(self) -> list[tuple[Waypoint, Waypoint]]:
        ends = [*self.points[1:], *self.points[:1]] if self.closed else list(self.points[1:])
        return list(zip(self.points, ends, strict=False))

    def _stops(self, point: Waypoint) -> bool:
        blend = self.blend if point.blend is None else point.blend
        return point.dwell > 0.0 or point.payload != 0.0 or blend == 0.0

    def _runs(self) -> list[list[tuple[Waypoint, Waypoint]]]:
        """The moves from stop to stop."""
        runs: list[list[tuple[Waypoint, Waypoint]]] = [[]]
        for start, end in self._moves():
            if runs[-1] and self._stops(start):
                runs.append([])
            runs[-1].append((start, end))
        return runs

    @property
    def dwell(self) -> float:
        """Time at rest, s."""
        return float(sum(point.dwell for point in self.points))

    def path(self, slower: float = 1.0) -> Path:
        """The motion, with limits of speed 1/slower and of acceleration 1/slower² of the cycle's.

        The dwells stay as they are. The times are dense where the moves are short, and every kink
        of the acceleration is one of them.
        """
        runs = [self._run(moves) for moves in self._runs()]
        moving = slower * sum(run.duration for run in runs)
        start, carried = 0.0, 0.0
        parts: list[Path] = []

        def rest(point: Waypoint) -> None:
            nonlocal start
            if point.dwell > 0.0:
                count = 2 * int(np.ceil(0.5 * _SAMPLES * point.dwell / (moving + self.dwell))) + 1
                t = np.linspace(start, start + point.dwell, max(count, 3))
                at = np.broadcast_to(np.array(point.at, dtype=float), (len(t), len(point.at)))
                still = np.zeros_like(at)
                parts.append(Path(t, at, still, still, np.full(len(t), carried)))
                start += point.dwell

        for run, moves in zip(runs, self._runs(), strict=True):
            first = moves[0][0]
            rest(first)
            carried += first.payload
            slow = run.stretched(slower)
            parts.append(replace(slow, t=slow.t + start, carried=np.full(len(run.t), carried)))
            start += slow.duration
        if not self.closed:
            rest(self.points[-1])
        joined = (np.concatenate([getattr(p, f.name) for p in parts]) for f in fields(Path))
        return Path(*joined)

    def _run(self, moves: Sequence[tuple[Waypoint, Waypoint]]) -> Path:
        """From stop to stop, from time 0, at its limits."""
        vectors = np.array([np.subtract(end.at, start.at) for start, end in moves], dtype=float)
        lengths = np.linalg.norm(vectors, axis=1)
        fast = np.array([self.v_max if end.speed is None else end.speed for _, end in moves])
        hard = np.array(
            [self.a_max if end.acceleration is None else end.acceleration for _, end in moves]
        )
        spans = quintic_time(fast / lengths, hard / lengths)
        blends = [self.blend if end.blend is None else end.blend for _, end in moves[:-1]]
        overlap = np.array(blends) * np.minimum(spans[:-1], spans[1:])
        begins = np.concatenate([[0.0], np.cumsum(spans[:-1] - overlap)])
        t = _nodes(np.concatenate([begins, begins + spans]))
        start = np.array(moves[0][0].at, dtype=float)
        fine = np.interp(np.arange(_FINER * (len(t) - 1) + 1) / _FINER, np.arange(len(t)), t)
        dense = superpose(start, vectors, begins, spans, fine)  # its peaks are those of the motion
        at_work = (fine[:, None] >= begins) & (fine[:, None] <= begins + spans)
        v_limit = np.where(at_work, fast, 0.0).max(axis=1)
        a_limit = np.where(at_work, hard, 0.0).max(axis=1)
        speed = np.max(np.linalg.norm(dense.v, axis=1) / v_limit)
        excess = np.max(np.linalg.norm(dense.a, axis=1) / a_limit)
        slower = float(max(speed, np.sqrt(excess)))
        return superpose(start, vectors, begins, spans, t).stretched(slower)


def _nodes(kinks: Array) -> Array:
    """Times with every kink among them, an even number of equal intervals between two of them."""
    ends = np.unique(kinks)
    ends = ends[np.concatenate([[True], np.diff(ends) > 1e-9 * ends[-1]])]
    share = np.diff(ends) / (ends[-1] - ends[0])
    counts = 2 * np.maximum(np.ceil(0.5 * 0.5 * _SAMPLES * share), 4).astype(int)
    pieces = [
        np.linspace(a, b, count, endpoint=False)
        for a, b, count in zip(ends[:-1], ends[1:], counts, strict=True)
    ]
    return np.concatenate([*pieces, ends[-1:]])


def _part(value: Any, what: str) -> None:
    if not 0.0 <= number(value, what) <= 1.0:
        raise OptionError(f"{what} is {value!r}; it must lie between 0 and 1")


def adept(
    centre: Sequence[float],
    v_max: float,
    a_max: float,
    lift: float = LIFT,
    travel: float = TRAVEL,
    blend: float = 0.5,
) -> Cycle:
    """The cycle 25/305/25 mm in the plane: up, across, down, and back; ``centre`` lies below it."""
    x, y = (float(value) for value in centre)
    left, right, top = x - 0.5 * travel, x + 0.5 * travel, y + lift
    points = (
        Waypoint((left, y)),
        Waypoint((left, top)),
        Waypoint((right, top)),
        Waypoint((right, y), blend=0.0),
        Waypoint((right, top)),
        Waypoint((left, top)),
    )
    return Cycle(points, v_max, a_max, blend, name="adept")


def read_cycle(path: str | File, v_max: float | None = None, a_max: float | None = None) -> Cycle:
    """Reads a cycle.

    TOML: ``v_max``, ``a_max``, ``blend``, ``closed``, ``name`` and one ``[[points]]`` per point
    with ``at = [x, y]`` and the other keys of :class:`Waypoint`. CSV: a first line with x, y (z)
    and keys of :class:`Waypoint`, one point a line, empty cells where nothing is stated; the
    limits are then arguments.

    Args:
        path: a file; one that ends in .csv is CSV.
        v_max, a_max: take the place of the file's.

    Raises:
        FileError: the file cannot be read.
        OptionError: not TOML or CSV, an unknown or missing key, or as :class:`Cycle`.
    """
    text, place = read_text(path), str(path)
    if File(path).suffix.lower() == ".csv":
        data: dict[str, Any] = {
            "points": [_from_csv(row, place) for row in csv_rows(text, place, OptionError)]
        }
    else:
        data = read_toml(text, place, OptionError)
    require_known(data, (f.name for f in fields(Cycle)), place, OptionError)
    rows = data.get("points")
    if not isinstance(rows, list) or not rows or not all(isinstance(row, dict) for row in rows):
        raise OptionError(f"{place}: no [[points]] in it")
    points = tuple(_waypoint(row, f"{place}, point {k}") for k, row in enumerate(rows, 1))
    numbers = [key for key in ("v_max", "a_max", "blend") if key in data]
    given: dict[str, Any] = {key: _value(data[key], f"{place}: {key}") for key in numbers}
    given |= {key: value for key, value in (("v_max", v_max), ("a_max", a_max)) if value}
    for key in ("v_max", "a_max"):
        if key not in given:
            raise OptionError(f"{place}: {key} is missing; write it there, or give it beside it")
    if not isinstance(data.get("closed", True), bool):
        raise OptionError(f"{place}: closed is {shown(data['closed'])}; it is true or false")
    name = str(data.get("name", File(path).stem))
    return Cycle(points, closed=data.get("closed", True), name=name, **given)


def _from_csv(row: Mapping[str, Any], place: str) -> dict[str, Any]:
    for axis in ("x", "y"):
        if axis not in row:
            raise OptionError(f"{place}: the column {axis!r} is missing, or empty in a line")
    rest = {key: value for key, value in row.items() if key not in _AXES}
    return {"at": [row[axis] for axis in _AXES if axis in row], **rest}


def _waypoint(row: Mapping[str, Any], place: str) -> Waypoint:
    keys = tuple(f.name for f in fields(Waypoint))
    require_known(row, keys, place, OptionError)
    at = row.get("at")
    if not isinstance(at, list) or len(at) not in (2, 3):
        raise OptionError(f"{place}: at is {shown(at)}; write at = [x, y], m")
    rest = {key: _value(row[key], f"{place}: {key}") for key in keys[1:] if key in row}
    return Waypoint(tuple(_value(each, f"{place}: at") for each in at), **rest)


def _value(value: Any, place: str) -> float:
    try:
        return parse_number(value)
    except ExpressionError as problem:
        raise OptionError(f"{place}: {problem}") from None
