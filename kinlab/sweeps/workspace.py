"""Where the tool can be and how well it moves there: samples of joint space, binned in space."""

from __future__ import annotations

import io
import json
from collections.abc import Callable
from concurrent.futures import Executor
from dataclasses import dataclass, field
from pathlib import Path
from typing import Any

import numpy as np

from kinlab.analysis.metrics import read_kind, singular_values, weighted
from kinlab.analysis.structure.task_space import (
    TaskSpace,
    mask_of,
    read_length,
    read_task,
    search_box,
)
from kinlab.arrays import Array, frozen, seed_of, whole, word
from kinlab.engine.dynamics import mass_matrix
from kinlab.engine.fast.stacks import fk
from kinlab.errors import FileError, NameUnknownError, OptionError
from kinlab.host.evidence import Evidence
from kinlab.host.files import write_bytes
from kinlab.host.introductions import Introduction, Rows, counted
from kinlab.host.progress import progress as line
from kinlab.model.library import ArmLike, as_robot
from kinlab.model.robot import Robot
from kinlab.sweeps.run import plan
from kinlab.tolerances import TOLERANCES

Progress = Callable[[int, int], None]
"""Called with (done, total) after every chunk."""

_FORMAT = 1


@dataclass(frozen=True, repr=False)
class WorkspaceMap(Rows):
    """Tool positions with a measure at each.

    Attributes:
        robot: its name. task: the task of the measure. rows: its rows. metric: the measure.
        length: characteristic length in metres; the measure depends on it for mixed tasks.
        points: tool positions in the base, (N, 3), metres.
        values: the measure, (N,).
        sampling: ``random`` or ``grid``. seed: of random samples.
        complete: False where the run was stopped; the points are then those of finished chunks.
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

    def columns(self) -> dict[str, Any]:
        """Tool positions and the measure there."""
        x, y, z = self.points.T
        return {"x": x, "y": y, "z": z, self.metric: self.values}

    def introduction(self) -> Introduction:
        """How far the tool went, and the range of the measure."""
        partly = "" if self.complete else ", stopped before its end"
        lines = [str(self.evidence)]
        if len(self.values):
            low, high = self.points.min(axis=0), self.points.max(axis=0)
            reach = ", ".join(
                f"{axis} {a:.4g} to {b:.4g}" for axis, a, b in zip("xyz", low, high, strict=True)
            )
            span = f"{self.metric} {self.values.min():.4g} to {self.values.max():.4g}"
            lines[:0] = [f"met: {reach} m", span]
        return Introduction(
            f"workspace map of {self.robot}, task {self.task}: "
            f"{counted(len(self.values), 'tool position')}{partly}",
            tuple(lines),
        )

    @property
    def evidence(self) -> Evidence:
        """What the map rests on: samples, which show where the tool can be and nothing beyond."""
        how = f"seed {self.seed}" if self.sampling == "random" else "evenly spaced"
        count = f"{len(self.values):,} {self.sampling} states within the joint limits, {how}"
        return Evidence(
            searched=count if self.complete else f"{count}; the run was stopped before its end",
            proved="each point is reached by its state, up to rounding",
            found="the extent and the best and least values: between samples there may be more",
        )

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
        except Exception:  # noqa: BLE001  whatever a damaged archive makes its reader raise
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
    robot: ArmLike,
    task: Any = "auto",
    metric: str = "inverse_condition",
    *,
    samples: int = 50_000,
    sampling: str = "random",
    length: float = 1.0,
    seed: int = 0,
    progress: Progress | None = None,
    workers: int = 1,
    executor: Executor | None = None,
    folder: str | Path | None = None,
) -> WorkspaceMap:
    """Samples joint space within the limits and measures dexterity at every sample.

    The samples are swept (see :func:`kinlab.sweep`): in this process, or on workers. Ctrl-C stops
    it and returns what was computed, marked as not complete; with a ``folder`` the same call goes
    on from there.

    Args:
        robot: the robot.
        task: a name, a mask, or ``"auto"``. metric: as in :func:`kinlab.manipulability`.
        samples: how many states; a grid takes the nearest number k^n, k >= 2 per joint.
        sampling: ``"random"`` (uniform in joint space) or ``"grid"`` (limits included).
        length: characteristic length in metres.
        seed: of the random states.
        progress: called with (done, total); left out, a line says how far it is, as in
            :func:`kinlab.sweep`.
        workers, executor, folder: as in :func:`kinlab.sweep`.

    Raises:
        NameUnknownError: unknown task, metric or sampling. OptionError: samples < 1, length <= 0.
        FileError: the folder cannot be written.
        InertiaError: metric ``"asada"`` of a robot with a singular mass matrix.
    """
    robot = as_robot(robot)
    space, size = read_task(robot, task), read_length(length)
    read_kind(metric)
    sampling = word(sampling, ("random", "grid"), "sampling")
    samples, seed = whole(samples, "samples"), seed_of(seed)
    states = _random(robot, samples, seed) if sampling == "random" else _grid(robot, samples)
    measure = DexterityMeasure(space.rows, metric, size)
    sweep = plan(robot, measure, states, workers=workers, executor=executor, folder=folder)
    try:
        show = None if progress is None else False
        with line("workspace", len(states), show, unit="samples") as tell:
            for done in sweep.steps:
                tell(done)
                if progress is not None:
                    progress(done, len(states))
    except KeyboardInterrupt:
        pass  # what was computed is the answer, and says that it is a part
    kept = [sweep.parts.read(run) for run in sweep.parts.runs()]
    points = np.concatenate([part["points"] for part in kept] or [np.empty((0, 3))])
    values = np.concatenate([part["values"] for part in kept] or [np.empty(0)])
    return WorkspaceMap(
        robot.name,
        space.name,
        space.rows,
        metric,
        size,
        frozen(points),
        frozen(values),
        sampling,
        seed,
        len(values) == len(states),
        stays_in_plane(space),
    )


@dataclass(frozen=True)
class DexterityMeasure:
    """The measure that is swept: tool positions and one metric; small enough for any worker.

    Attributes:
        rows: of the task. metric: as in :func:`kinlab.manipulability`. length: metres.
    """

    rows: tuple[int, ...]
    metric: str
    length: float

    def __call__(self, robot: Robot, q: Array) -> dict[str, Array]:
        """``points`` (m, 3) and ``values`` (m,) of the states q (m, n)."""
        space = read_task(robot, mask_of(self.rows))
        matrix = space.jacobian(q, self.length)
        if self.metric == "asada":
            matrix = weighted(matrix, mass_matrix(robot, q))
        values = read_kind(self.metric)(singular_values(matrix))
        return {"points": fk(robot, q)[:, :3, 3], "values": values}


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
    return bool(linear[:, 2].max() <= TOLERANCES.in_plane * linear.max(initial=1e-300))


def _random(robot: Robot, samples: int, seed: int) -> Array:
    lower, upper = search_box(robot)
    return np.random.default_rng(seed).uniform(lower, upper, (samples, robot.n))


def _grid(robot: Robot, samples: int) -> Array:
    lower, upper = search_box(robot)
    each = max(2, round(samples ** (1.0 / robot.n)))
    lines = [np.linspace(a, b, each) for a, b in zip(lower, upper, strict=True)]
    return np.stack(np.meshgrid(*lines, indexing="ij"), axis=-1).reshape(-1, robot.n)
