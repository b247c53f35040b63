"""Where the tool can be and how well it moves there: samples of joint space, binned in space."""

from __future__ import annotations

import io
import json
import zipfile
from collections.abc import Callable
from dataclasses import dataclass, field
from pathlib import Path
from typing import Any

import numpy as np

from kinlab.analysis.metrics import read_kind, singular_values, weighted
from kinlab.analysis.task_space import TaskSpace, read_length, read_task, search_box
from kinlab.arrays import Array, frozen
from kinlab.dynamics import mass_matrix
from kinlab.errors import FileError, NameUnknownError, OptionError, near
from kinlab.files import write_bytes
from kinlab.kinematics import fk
from kinlab.robot import Robot

Progress = Callable[[int, int], None]
"""Called with (done, total) after every chunk."""

_CHUNK = 4096
"""States between two calls of the progress function: about 0.05 s of work."""
_FORMAT = 1


@dataclass(frozen=True)
class WorkspaceMap:
    """Tool positions with a measure at each.

    Attributes:
        robot: its name. task: the task of the measure. rows: its rows. metric: the measure.
        length: characteristic length in metres; the measure depends on it for mixed tasks.
        points: tool positions in the base, (N, 3), metres.
        values: the measure, (N,).
        sampling: ``random`` or ``grid``. seed: of random samples.
        complete: False where the run was stopped; the points are then the first ones.
        planar: the tool stays in a plane z = const.
    """

    robot: str
    task: str
    rows: tuple[int, ...]
    metric: str
    length: float
    points: Array = field(repr=False)
    values: Array = field(repr=False)
    sampling: str
    seed: int
    complete: bool
    planar: bool

    def save(self, path: str | Path) -> None:
        """Writes a compressed .npz; an old file stays whole if writing fails.

        Raises:
            FileError: the file cannot be written.
        """
        said = {k: getattr(self, k) for k in _TEXT} | {"format": _FORMAT}
        buffer = io.BytesIO()
        np.savez_compressed(
            buffer, points=self.points, values=self.values, about=np.array(json.dumps(said))
        )
        write_bytes(path, buffer.getvalue())

    @staticmethod
    def load(path: str | Path) -> WorkspaceMap:
        """Reads what :meth:`save` wrote, bit for bit.

        Raises:
            FileError: missing, or no workspace map.
        """
        try:
            with np.load(Path(path), allow_pickle=False) as file:
                about = json.loads(str(file["about"]))
                points, values = frozen(file["points"]), frozen(file["values"])
            if about.pop("format") != _FORMAT:
                raise FileError(f"{path}: a workspace map of another version")
            if points.shape != (len(values), 3):
                raise FileError(f"{path}: {points.shape} points and {values.shape} values")
            about["rows"] = tuple(about["rows"])
            return WorkspaceMap(points=points, values=values, **about)
        except FileError:
            raise
        except FileNotFoundError:
            raise FileError(f"{path}: no such file") from None
        except (OSError, KeyError, ValueError, TypeError, zipfile.BadZipFile):
            raise FileError(f"{path}: not a workspace map (.npz written by save)") from None


_TEXT = ("robot", "task", "rows", "metric", "length", "sampling", "seed", "complete", "planar")


@dataclass(frozen=True)
class BinnedMap:
    """A workspace map over the cells of a plane.

    Attributes:
        plane: ``xy``, ``xz``, ``yz``, or ``rz`` with r the distance from the base's z axis.
        u, v: edges of the cells, (U+1,) and (V+1,), metres.
        count: samples in each cell, (U, V).
        best: greatest measure in each cell, 0 where there is no sample, (U, V).
        mean: mean measure, 0 where there is no sample, (U, V).
    """

    plane: str
    u: Array
    v: Array
    count: Array
    best: Array
    mean: Array


def sample_workspace(
    robot: Robot,
    task: Any = "auto",
    metric: str = "inverse_condition",
    *,
    samples: int = 50_000,
    sampling: str = "random",
    length: float = 1.0,
    seed: int = 0,
    progress: Progress | None = None,
) -> WorkspaceMap:
    """Samples joint space within the limits and measures dexterity at every sample.

    Ctrl-C stops the sampling and returns what was computed, marked as not complete.

    Args:
        robot: the robot.
        task: a name, a mask, or ``"auto"``. metric: as in :func:`kinlab.manipulability`.
        samples: how many states; a grid takes the nearest number k^n, k >= 2 per joint.
        sampling: ``"random"`` (uniform in joint space) or ``"grid"`` (limits included).
        length: characteristic length in metres.
        seed: of the random states.
        progress: called with (done, total).

    Raises:
        NameUnknownError: unknown task, metric or sampling. OptionError: samples < 1, length <= 0.
        InertiaError: metric ``"asada"`` of a robot with a singular mass matrix.
    """
    space, size = read_task(robot, task), read_length(length)
    read_kind(metric)
    if sampling not in ("random", "grid"):
        raise NameUnknownError(
            f"sampling {sampling!r} is unknown; {near(str(sampling), ('random', 'grid'))}"
        )
    if samples < 1:
        raise OptionError(f"samples {samples}; at least 1 is needed")
    states = _random(robot, samples, seed) if sampling == "random" else _grid(robot, samples)
    points, values, done = np.empty((len(states), 3)), np.empty(len(states)), 0
    try:
        for start in range(0, len(states), _CHUNK):
            q = states[start : start + _CHUNK]
            points[start : start + len(q)] = fk(robot, q)[:, :3, 3]
            values[start : start + len(q)] = _measure(space, q, metric, size)
            done = start + len(q)
            if progress is not None:
                progress(done, len(states))
    except KeyboardInterrupt:
        pass  # what was computed is the answer, and says that it is a part
    return WorkspaceMap(
        robot.name, space.name, space.rows, metric, size, frozen(points[:done]),
        frozen(values[:done]), sampling, seed, done == len(states), stays_in_plane(space),
    )  # fmt: skip


def binned(chart: WorkspaceMap, cells: int = 0, plane: str = "") -> BinnedMap:
    """Bins a map over a plane.

    Args:
        chart: the map.
        cells: along the longer side; 0 takes as many as the samples fill, at most 160.
        plane: ``"xy"``, ``"xz"``, ``"yz"`` or ``"rz"``; left out: xy for a planar arm, else rz.

    Raises:
        NameUnknownError: another plane. OptionError: cells < 0, or an empty map.
    """
    plane = plane or ("xy" if chart.planar else "rz")
    if plane not in ("xy", "xz", "yz", "rz"):
        raise NameUnknownError(f"plane {plane!r}; choose one of 'xy', 'xz', 'yz', 'rz'")
    if cells < 0 or not len(chart.points):
        raise OptionError(f"cells {cells}, {len(chart.points)} points; give cells >= 0 and points")
    cells = cells or int(np.clip(np.sqrt(len(chart.points) / 12.0), 8, 160))
    x, y, z = chart.points.T
    named = {"x": x, "y": y, "z": z, "r": np.hypot(x, y)}
    a, b = named[plane[0]], named[plane[1]]
    size = max(float(np.ptp(a)), float(np.ptp(b)), 1e-9) / cells
    u = a.min() + size * np.arange(max(1, int(np.ceil(np.ptp(a) / size))) + 1)
    v = b.min() + size * np.arange(max(1, int(np.ceil(np.ptp(b) / size))) + 1)
    i = np.clip(((a - u[0]) / size).astype(np.int64), 0, len(u) - 2)
    j = np.clip(((b - v[0]) / size).astype(np.int64), 0, len(v) - 2)
    shape = (len(u) - 1, len(v) - 1)
    count, total, best = np.zeros(shape), np.zeros(shape), np.zeros(shape)
    np.add.at(count, (i, j), 1.0)
    np.add.at(total, (i, j), chart.values)
    np.maximum.at(best, (i, j), chart.values)
    return BinnedMap(plane, u, v, count, best, total / np.maximum(count, 1.0))


def stays_in_plane(space: TaskSpace) -> bool:
    """Whether the tool never leaves a plane z = const of the base."""
    linear = np.abs(space.sample[:, :3, :])
    return bool(linear[:, 2].max() <= 1e-9 * linear.max(initial=1e-300))


def _measure(space: TaskSpace, q: Array, metric: str, length: float) -> Array:
    matrix = space.jacobian(q, length)
    if metric == "asada":
        matrix = weighted(matrix, mass_matrix(space.robot, q))
    return read_kind(metric)(singular_values(matrix))


def _random(robot: Robot, samples: int, seed: int) -> Array:
    lower, upper = search_box(robot)
    return np.random.default_rng(seed).uniform(lower, upper, (samples, robot.n))


def _grid(robot: Robot, samples: int) -> Array:
    lower, upper = search_box(robot)
    each = max(2, round(samples ** (1.0 / robot.n)))
    lines = [np.linspace(a, b, each) for a, b in zip(lower, upper, strict=True)]
    return np.stack(np.meshgrid(*lines, indexing="ij"), axis=-1).reshape(-1, robot.n)
