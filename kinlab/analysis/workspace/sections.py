"""Sections of a spatial arm's workspace through the first joint's axis: edges, voids, and the
curves inside across which the number of solutions changes.

Turning joint 1 sweeps the workspace round its axis, so that the half plane (rho, z) through the
axis shows it whole. The other joints map to (rho, z); where that map loses rank the image folds.
With some joints at a limit the rest fold on their own. The images of all these curves hold every
edge of the section, outer ones, those of voids, and internal ones (Haug, Luh, Adkins & Wang,
"Numerical algorithms for mapping boundaries of manipulator workspaces", ASME J. Mech. Des. 118,
1996; Wenger, "Uniqueness domains and regions of feasible paths for cuspidal manipulators", IEEE
Trans. Robotics 20, 2004, for arms of three joints).
"""

from __future__ import annotations

from dataclasses import dataclass, field, replace
from itertools import product
from typing import Any

import numpy as np

from kinlab.analysis.singularities.loci import trace_from
from kinlab.analysis.solver import jacobian_derivative, solve
from kinlab.analysis.structure.axes import first_axis
from kinlab.analysis.structure.task_space import TaskSpace, revolute, search_box, wrap
from kinlab.arrays import Array, between, frozen, number, seed_of
from kinlab.engine.fast.stacks import fk, jacobian
from kinlab.errors import OptionError
from kinlab.host.evidence import Evidence
from kinlab.host.progress import takes_long
from kinlab.model.library import ArmLike, as_robot
from kinlab.model.robot import Robot
from kinlab.tolerances import TOLERANCES

_STARTS = 240
"""Starts for the curves of one set of locked joints; a curve needs one of them."""
_MOST_LOCKED = 3
"""Joints that move the tool in the section up to which limits are taken into account: 3^3 sets of
them, some seconds; each joint more takes three times as long."""
_SAMPLES = 60_000
_TRIED = 240
"""Points of a curve at which the sides are tried; those between take the nearest one's answer."""


@dataclass(frozen=True)
class SectionCurve:
    """One curve of the section.

    Attributes:
        q: joint positions along it, (K, n); joint 1 in the middle of its limits.
        points: (rho, z) of the tool along it, metres, (K, 2).
        locked: names and values of the joints at a limit; empty: a singular curve of the arm.
        edge: (K,) of booleans: one side is out of reach there, on the outside or of a void. Else
            both sides are reached: an internal boundary.
    """

    q: Array = field(repr=False)
    points: Array = field(repr=False)
    locked: tuple[tuple[str, float], ...]
    edge: Any = field(repr=False)


@dataclass(frozen=True)
class WorkspaceSection:
    """Answer of :func:`workspace_section`.

    Attributes:
        robot: its name.
        origin, axis: a point of the first joint's axis, nearest to the base's origin, and its
            direction, (3,); rho is the distance from it, z the coordinate along it from there.
        joints: names of the joints that move the tool in the section.
        curves: what was found.
        evidence: what was searched, and what is found only.
    """

    robot: str
    origin: Array
    axis: Array
    joints: tuple[str, ...]
    curves: tuple[SectionCurve, ...]
    evidence: Evidence = field(repr=False)

    def project(self, positions: Array) -> Array:
        """(rho, z) of tool positions (N, 3), (N, 2)."""
        return _project(self.origin, self.axis, positions)


@takes_long("section of the workspace")
def workspace_section(robot: ArmLike, *, step: float = 0.05, seed: int = 0) -> WorkspaceSection:
    """Edges and internal boundaries of the tool's positions, in the half plane through axis 1.

    The limits of joint 1 are left out: the section holds wherever joint 1 can turn the arm there.
    Where more than three joints behind it move the tool, the curves of joints at a limit are left
    out, and with them edges (the evidence says so). That no curve is missing is found, not proved.

    Args:
        robot: three joints or more, the first revolute.
        step: length of a step along a curve, rad (or m), at least 1e-4.
        seed: of the starts.

    Raises:
        OptionError: fewer than three joints, a first joint that slides, or an arm whose tool
            leaves no section (fewer than two joints behind the first move it there); step or
            seed of another kind.
        StructureError: no robot.
    """
    robot = as_robot(robot)
    step, seed = number(step, "step"), seed_of(seed)
    if not step >= TOLERANCES.shortest_step:
        raise OptionError(f"step is {step:g}; it must be at least {TOLERANCES.shortest_step:g}")
    if robot.n < 3 or not revolute(robot)[0]:
        raise OptionError(
            f"robot {robot.name!r}: a section needs a revolute first joint and two joints more; "
            "planar arms: planar_boundary()"
        )
    lower, upper = search_box(robot)
    start = 0.5 * (lower + upper)
    origin, axis = first_axis(robot)
    space = TaskSpace(robot, (0, 1, 2), "position")
    moving = _moving(robot, origin, axis)
    if len(moving) < 2:
        raise OptionError(
            f"robot {robot.name!r}: the joints behind the first move the tool along one line of "
            "the section only; planar arms: planar_boundary()"
        )
    rng = np.random.default_rng(seed)
    drawn: list[SectionCurve] = []
    with_limits = len(moving) <= _MOST_LOCKED
    for locked in _choices(robot, moving, with_limits):
        held = start.copy()
        for joint, value in locked:
            held[joint] = value
        free = tuple(i for i in moving if i not in dict(locked))
        for q in _curves(_SectionSystem(space, free, free, held, origin, axis), rng, step):
            named = tuple((robot.joint_names[i], float(v)) for i, v in locked)
            points = _project(origin, axis, fk(robot, q)[:, :3, 3])
            drawn.append(SectionCurve(frozen(q), frozen(points), named, np.zeros(0, dtype=bool)))
    curves = _with_edges(robot, moving, origin, axis, start, drawn)
    left_out = "" if with_limits else "; curves of joints at a limit are left out"
    evidence = Evidence(
        f"{_STARTS} starts (seed {seed}) for every choice of joints at a limit, each curve "
        "followed to its ends; the sides of its points from the nearest of "
        f"{_SAMPLES} samples",
        proved="every listed curve folds the section, or the part of it with joints at limits",
        found=f"that there is no other curve, and which sides are out of reach{left_out}",
    )
    names = tuple(robot.joint_names[i] for i in moving)
    return WorkspaceSection(robot.name, frozen(origin), frozen(axis), names, curves, evidence)


def _project(origin: Array, axis: Array, positions: Array) -> Array:
    apart = positions - origin
    along = apart @ axis
    across = apart - along[:, np.newaxis] * axis
    return np.stack([np.linalg.norm(across, axis=1), along], axis=1)


def _section_rows(
    full: Array, positions: Array, origin: Array, axis: Array
) -> tuple[Array, Array, Array]:
    """Rows of J along rho and z, (N, 2, n), with the directions rho and phi, (N, 3), and rho."""
    apart = positions - origin
    across = apart - (apart @ axis)[:, np.newaxis] * axis
    rho = np.maximum(np.linalg.norm(across, axis=1), 1e-12)
    outward = across / rho[:, np.newaxis]
    rows = np.stack([outward, np.broadcast_to(axis, outward.shape)], axis=1) @ full[:, :3]
    return rows, outward, rho


def takes_limits(robot: Robot) -> bool:
    """Whether the section of this arm holds the curves of joints at a limit too: all edges."""
    if robot.n < 3 or not revolute(robot)[0]:
        return False
    return 2 <= len(_moving(robot, *first_axis(robot))) <= _MOST_LOCKED


def _moving(robot: Robot, origin: Array, axis: Array) -> tuple[int, ...]:
    lower, upper = search_box(robot)
    states = np.random.default_rng(3).uniform(lower, upper, (8, robot.n))
    rows, _, _ = _section_rows(jacobian(robot, states), fk(robot, states)[:, :3, 3], origin, axis)
    size = np.abs(rows).max(axis=(0, 1))
    spread = np.linalg.svd(rows, compute_uv=False)
    if float((spread[:, 1] / np.maximum(spread[:, 0], 1e-300)).max()) < 1e-9:
        return ()  # a tool that stays in a plane, or on a cone
    return tuple(i for i in range(1, robot.n) if size[i] > 1e-9 * size.max())


def _choices(
    robot: Robot, moving: tuple[int, ...], with_limits: bool
) -> list[tuple[tuple[int, float], ...]]:
    """Sets of joints at a limit that leave one free; joints that turn round have none."""
    if not with_limits:
        return [()]
    turning = revolute(robot) & (robot.upper - robot.lower >= 2.0 * np.pi - 1e-9)
    ends = [
        (None,) if turning[i] else (None, float(robot.lower[i]), float(robot.upper[i]))
        for i in moving
    ]
    out = []
    for choice in product(*ends):
        locked = tuple((i, v) for i, v in zip(moving, choice, strict=True) if v is not None)
        if len(locked) < len(moving):
            out.append(locked)
    return sorted(out, key=len)


@dataclass(frozen=True)
class _SectionSystem:
    """u . d(rho, z)/dq_i = 0 for the free joints, |u| = 1: where the section map folds.

    Attributes:
        space: position of the tool. free: joints off their limits. moving: those that are unknown.
        held: values of the others. origin, axis: of the first joint.
    """

    space: TaskSpace
    free: tuple[int, ...]
    moving: tuple[int, ...]
    held: Array
    origin: Array
    axis: Array

    def states(self, x: Array) -> Array:
        """Full joint vectors (N, n) of the unknowns."""
        q = np.repeat(self.held[np.newaxis], len(x), axis=0)
        q[:, list(self.moving)] = x[:, : len(self.moving)]
        return q

    def start(self, q: Array) -> Array:
        """Unknowns at q (N, n)."""
        rows = self._rows(q)[0][:, :, list(self.free)]
        left = np.linalg.svd(rows)[0]
        return np.concatenate([q[:, list(self.moving)], left[:, :, -1]], axis=1)

    def _rows(self, q: Array) -> tuple[Array, Array, Array, Array]:
        full = jacobian(self.space.robot, q)
        positions = fk(self.space.robot, q)[:, :3, 3]
        rows, outward, rho = _section_rows(full, positions, self.origin, self.axis)
        return rows, outward, rho, full

    def __call__(self, x: Array) -> tuple[Array, Array]:
        """Residuals (N, k + 1) and derivatives, in the arm's length unit, k free joints."""
        free, moving, scale = list(self.free), list(self.moving), self.space.scale
        k, unknown = len(free), len(moving)
        u = x[:, unknown:]
        rows, outward, rho, full = self._rows(self.states(x))
        change = jacobian_derivative(full)[:, moving][:, :, :3][..., free]  # (N, j, 3, i)
        round_ = np.cross(self.axis, outward)
        tangential = np.einsum("nc,nci->ni", round_, full[:, :3])  # speed around the axis
        swing = tangential[:, moving][:, :, np.newaxis] * tangential[:, free][:, np.newaxis, :]
        bent = np.stack(
            [
                np.einsum("nc,njci->nji", outward, change) + swing / rho[:, np.newaxis, np.newaxis],
                np.einsum("c,njci->nji", self.axis, change),
            ],
            axis=1,
        )  # (N, 2, j, i)
        chosen = rows[..., free]
        residual = np.empty((len(x), k + 1))
        residual[:, :k] = np.einsum("nr,nri->ni", u, chosen) / scale
        residual[:, k] = 0.5 * (np.einsum("nr,nr->n", u, u) - 1.0)
        derivative = np.zeros((len(x), k + 1, unknown + 2))
        derivative[:, :k, :unknown] = np.einsum("nr,nrji->nij", u, bent) / scale
        derivative[:, :k, unknown:] = chosen.swapaxes(1, 2) / scale
        derivative[:, k, unknown:] = u
        return residual, derivative


def _curves(system: _SectionSystem, rng: np.random.Generator, step: float) -> list[Array]:
    """Curves (K, n) of one choice of locked joints."""
    robot, moving = system.space.robot, list(system.moving)
    lower, upper = search_box(robot)
    if len(moving) == 1:  # one joint alone sweeps a curve
        joint = moving[0]
        count = 2 + int((upper[joint] - lower[joint]) / step)
        q = np.repeat(system.held[np.newaxis], count, axis=0)
        q[:, joint] = np.linspace(lower[joint], upper[joint], count)
        return [q]
    drawn = rng.uniform(lower[moving], upper[moving], (_STARTS, len(moving)))
    states = np.repeat(system.held[np.newaxis], _STARTS, axis=0)
    states[:, moving] = drawn
    x, norm = solve(system, system.start(states))
    solved = wrap(robot, system.states(x))
    inside = between(solved, lower, upper, TOLERANCES.limit_rounding).all(axis=1)
    x[:, : len(moving)] = solved[:, moving]
    return [
        system.states(points)
        for points in trace_from(system, x[inside & (norm <= TOLERANCES.on_singular_set)], step)
    ]


def _with_edges(
    robot: Robot,
    moving: tuple[int, ...],
    origin: Array,
    axis: Array,
    start: Array,
    drawn: list[SectionCurve],
) -> tuple[SectionCurve, ...]:
    """Marks where one side of a curve is out of reach."""
    reach = _Reach(robot, moving, origin, axis, start)
    out = []
    for curve in drawn:
        chosen = np.unique(np.linspace(0, len(curve.points) - 1, _TRIED).astype(int))
        points = curve.points
        tangent = np.gradient(points, axis=0)[chosen]
        size = np.linalg.norm(tangent, axis=1, keepdims=True)
        normal = np.stack([-tangent[:, 1], tangent[:, 0]], axis=1) / np.maximum(size, 1e-300)
        side = TOLERANCES.beside_section * reach.size
        sides = (points[chosen] + side * normal, points[chosen] - side * normal)
        both = np.logical_and(reach.reached(sides[0]), reach.reached(sides[1]))
        nearest = np.searchsorted(chosen, np.arange(len(points)), side="right") - 1
        edge = ~both[nearest]
        edge.setflags(write=False)
        out.append(replace(curve, edge=edge))
    return tuple(out)


class _Reach:
    """Which points of the section the tool reaches: Newton from the nearest samples."""

    def __init__(
        self, robot: Robot, moving: tuple[int, ...], origin: Array, axis: Array, start: Array
    ) -> None:
        from scipy.spatial import cKDTree  # `import kinlab` does not wait for scipy

        self.robot, self.moving, self.origin, self.axis = robot, list(moving), origin, axis
        self.lower, self.upper = search_box(robot)
        q = np.repeat(start[np.newaxis], _SAMPLES, axis=0)
        rng = np.random.default_rng(0)
        q[:, self.moving] = rng.uniform(
            self.lower[self.moving], self.upper[self.moving], (_SAMPLES, len(moving))
        )
        self.samples = q
        placed = _project(origin, axis, fk(robot, q)[:, :3, 3])
        self.size = float(np.ptp(placed, axis=0).max())
        self.tree = cKDTree(placed)

    def reached(self, targets: Array) -> Any:
        """(N,) of booleans for targets (N, 2): from a few samples near by, then from many."""
        found = np.zeros(len(targets), dtype=bool)
        for count, rounds in ((8, 20), (120, 60)):
            left = np.flatnonzero(~found)
            if len(left):
                found[left] = self._solved(targets[left], count, rounds)
        return found

    def _solved(self, targets: Array, count: int, rounds: int) -> Any:
        _, near = self.tree.query(targets, k=count)
        q = self.samples[near].reshape(-1, self.robot.n)
        wanted = np.repeat(targets, count, axis=0)
        active = np.arange(len(wanted))
        found = np.zeros(len(wanted), dtype=bool)
        goal = 0.1 * TOLERANCES.beside_section * self.size
        for _ in range(rounds):
            if not len(active):
                break
            state = q[active]
            positions = fk(self.robot, state)[:, :3, 3]
            miss = wanted[active] - _project(self.origin, self.axis, positions)
            there = np.linalg.norm(miss, axis=1) < goal
            found[active[there]] = True
            settled = found.reshape(-1, count).any(axis=1).repeat(count)
            rows, _, _ = _section_rows(
                jacobian(self.robot, state), positions, self.origin, self.axis
            )
            rows = rows[..., self.moving]
            damping = (
                1e-6
                * self.size**2
                * np.eye(2)
                * np.minimum(1.0, np.linalg.norm(miss, axis=1) / self.size)[
                    :, np.newaxis, np.newaxis
                ]
            )
            gram = rows @ rows.swapaxes(1, 2) + damping + 1e-14 * np.eye(2)
            step = np.einsum("nri,nr->ni", rows, np.linalg.solve(gram, miss[..., None])[..., 0])
            largest = np.abs(step).max(axis=1, keepdims=True)
            step *= np.minimum(1.0, 0.3 / np.maximum(largest, 1e-300))
            state[:, self.moving] = np.clip(
                state[:, self.moving] + step, self.lower[self.moving], self.upper[self.moving]
            )
            q[active] = state
            active = active[~settled[active]]
        return np.asarray(found.reshape(-1, count).any(axis=1))
