"""How many solutions each point of a section of the workspace has, with its singular curves."""

from __future__ import annotations

from dataclasses import dataclass, field
from typing import Any

import numpy as np

from kinlab.analysis.structure.axes import Axes
from kinlab.analysis.structure.task_space import read_task, revolute
from kinlab.arrays import Array, number, whole
from kinlab.engine.fast.stacks import fk
from kinlab.errors import OptionError
from kinlab.host.evidence import Evidence
from kinlab.host.introductions import Answer, Introduction
from kinlab.host.progress import takes_long
from kinlab.inverse.postures.regional import (
    Regional,
    collapsed_points,
    is_regional,
    nodes,
    singular_points,
    singular_segments,
)
from kinlab.inverse.postures.solution_count import SolutionCounts, solution_count
from kinlab.model.library import ArmLike, as_robot
from kinlab.model.robot import Robot

_DRAWN = 400
"""Random joint positions whose tool positions are counted beside the cells."""
_MARGIN = 0.03
"""Of the section's size around it."""


@dataclass(frozen=True, eq=False, repr=False)
class SolutionMap(Answer):
    """Answer of :func:`solution_map`.

    Attributes:
        robot: its name.
        labels: of the two coordinates: ``("rho", "z")`` or ``("x", "y")``.
        u, v: metres, where the cells' middles are, (M,) and (N,).
        count: (M, N) of integers: solutions, limits left out. within_limits: those within.
        complete: (M, N), bool: whether a count is of all there are.
        curves: singular configurations' tool positions, short segments (K, 2, 2), limits left out.
        evidence: what was searched, and what is proved.
        cusps, nodes: points, (c, 2) and (d, 2): three solutions run together; the curve passes
            twice.
        collapsed: points that a whole line of singular configurations is, (e, 2).
        kind: for three revolute joints in space ``"binary"`` (two solutions at most) or
            ``"quaternary"``; else empty.
        generic: no singular curves cross in joint space; ``None`` where not known.
    """

    robot: str
    labels: tuple[str, str]
    u: Array
    v: Array
    count: Any
    within_limits: Any
    complete: Any
    curves: Array
    evidence: Evidence = field(repr=False)
    cusps: Array = field(default_factory=lambda: np.empty((0, 2)))
    nodes: Array = field(default_factory=lambda: np.empty((0, 2)))
    collapsed: Array = field(default_factory=lambda: np.empty((0, 2)))
    kind: str = ""
    generic: bool | None = None

    def introduction(self) -> Introduction:
        """What the map shows, and what it rests on."""
        return Introduction(
            f"map of the number of solutions of {self.robot}: {self.text}", (str(self.evidence),)
        )

    @property
    def text(self) -> str:
        """What the map shows, in words."""
        if not self.kind:
            return f"at most {int(self.count.max())} solutions"
        manner = {True: "generic", False: "not generic", None: "genericity not known"}[self.generic]
        return (
            f"{self.kind}, {manner}, {len(self.cusps)} cusps and {len(self.nodes)} nodes in the "
            "half section"
        )


@takes_long("map of solutions")
def solution_map(robot: ArmLike, *, cells: int = 160, angle: float = 0.0) -> SolutionMap:
    """Counts the solutions over a section of the workspace.

    Three revolute joints in space: the half plane (rho, z) through the first axis. Planar arms of
    two or three revolute joints: the plane, the tool at one angle where there are three.

    Args:
        robot: one of these arms.
        cells: along the longer side of the section.
        angle: of the tool in the plane, rad, for three joints in the plane.

    Raises:
        OptionError: another arm, or bad numbers.
    """
    robot = as_robot(robot)
    count, held = whole(cells, "cells", 2, 2000), number(angle, "angle")
    if is_regional(robot):
        return _regional(robot, count)
    if robot.n in (2, 3) and bool(np.all(revolute(robot))):
        space = read_task(robot, "auto")
        if space.rows in ((0, 1), (0, 1, 5)):
            return _planar(robot, count, held)
    raise OptionError(
        f"robot {robot.name!r}: maps of the number of solutions are for three revolute joints that "
        "place a point, and for planar arms of two or three; other arms: solution_count at poses"
    )


def _regional(robot: Robot, cells: int) -> SolutionMap:
    arm = Regional.of(robot)
    segments = singular_segments(arm)
    curves = arm.points(segments.reshape(-1, 2)).reshape(-1, 2, 2)
    special = singular_points(arm)
    crossed = nodes(arm, special.cusps)
    low, high = _bounds(curves)
    low[0] = 0.0
    u, v, flat = _cells(low, high, cells)
    across = np.linalg.svd(arm.axis[np.newaxis])[2][1]
    poses = np.tile(np.eye(4), (len(flat), 1, 1))
    poses[:, :3, 3] = arm.origin + flat[:, :1] * across + flat[:, 1:] * arm.axis
    counts: SolutionCounts = solution_count(robot, poses)
    drawn = np.random.default_rng(0).uniform(-np.pi, np.pi, (_DRAWN, robot.n))
    tried: SolutionCounts = solution_count(robot, fk(robot, drawn))
    most = int(max(counts.count.max(initial=0), tried.count.max(initial=0)))
    cusps = arm.points(special.cusps)
    four = most >= 3 or len(cusps) > 0
    generic = special.generic if special.complete or not special.generic else None
    proved = "each counted solution is one"
    if special.complete:
        proved += (
            "; every other cusp would lie within 0.02 rad, in joints 2 and 3, of one of these "
            f"{len(cusps)} or of a crossing"
        )
    evidence = Evidence(
        f"{len(flat)} points of the half section and {_DRAWN} random ones that are reached; cusps "
        "and crossings in boxes of the whole torus of joints 2 and 3",
        proved=proved + ("; some pose has more than two solutions" if four else ""),
        found="the nodes"
        + ("" if four else "; that no pose has more than two solutions")
        + ("" if special.complete else "; the cusps"),
    )
    return SolutionMap(
        robot.name,
        ("rho", "z"),
        u,
        v,
        **_grids(counts, u, v),
        curves=curves,
        evidence=evidence,
        cusps=cusps,
        nodes=arm.points(crossed[:, :2]),
        collapsed=collapsed_points(arm),
        kind="quaternary" if four else "binary",
        generic=generic,
    )


def _planar(robot: Robot, cells: int, angle: float) -> SolutionMap:
    curves = _planar_curves(robot, angle)
    low, high = _bounds(curves)
    u, v, flat = _cells(low, high, cells)
    turn = np.array([[np.cos(angle), -np.sin(angle)], [np.sin(angle), np.cos(angle)]])
    poses = np.tile(fk(robot, np.zeros(robot.n)), (len(flat), 1, 1))
    poses[:, :3, :3] = np.eye(3)
    poses[:, :2, :2], poses[:, :2, 3] = turn, flat
    counts: SolutionCounts = solution_count(robot, poses)
    held = "" if robot.n == 2 else f", the tool at {angle:g} rad"
    evidence = Evidence(
        f"{len(flat)} points of the plane{held}",
        proved="each counted solution is one",
        found="that there is no other at any of them",
    )
    return SolutionMap(
        robot.name, ("x", "y"), u, v, **_grids(counts, u, v), curves=curves, evidence=evidence
    )


def _grids(counts: SolutionCounts, u: Array, v: Array) -> dict[str, Any]:
    """Counts of a stack of points as fields of a map over u and v."""
    shape = (len(u), len(v))
    return {
        "count": counts.count.reshape(shape),
        "within_limits": counts.within_limits.reshape(shape),
        "complete": counts.complete.reshape(shape),
    }


def _planar_curves(robot: Robot, angle: float) -> Array:
    """Tool positions with joints 1 and 2 stretched or folded, the tool held at an angle."""
    axes = Axes.at(robot, np.zeros(robot.n))
    corners = [*axes.point[:, :2], fk(robot, np.zeros(robot.n))[:2, 3]]
    one, two = corners[1] - corners[0], corners[2] - corners[1]
    bend = np.arctan2(one[1], one[0]) - np.arctan2(two[1], two[0])
    line = np.linspace(-np.pi, np.pi, 241)
    curves = []
    for side in (0.0, np.pi):
        q = np.zeros((len(line), robot.n))
        q[:, 0], q[:, 1] = line, np.sign(axes.direction[1, 2]) * (bend + side)
        if robot.n == 3:
            placed = fk(robot, q)
            now = np.arctan2(placed[:, 1, 0], placed[:, 0, 0])
            q[:, 2] = np.sign(axes.direction[2, 2]) * (angle - now)
        points = fk(robot, q)[:, :2, 3]
        curves.append(np.stack([points[:-1], points[1:]], axis=1))
    return np.concatenate(curves)


def _bounds(curves: Array) -> tuple[Array, Array]:
    points = curves.reshape(-1, 2)
    low, high = points.min(axis=0), points.max(axis=0)
    margin = _MARGIN * float((high - low).max())
    return low - margin, high + margin


def _cells(low: Array, high: Array, cells: int) -> tuple[Array, Array, Array]:
    """Middles along both sides, and all pairs of them (M N, 2); cells are about square."""
    side = float((high - low).max()) / cells
    sizes = np.maximum(1, np.ceil((high - low) / side).astype(int))
    # off any axis of symmetry by an irrational share: middles do not fall on singular lines
    u, v = (
        lo + (np.arange(size) + 0.5 + 0.0123 * np.sqrt(2.0)) * side
        for lo, size in zip(low, sizes, strict=True)
    )
    flat = np.stack(np.meshgrid(u, v, indexing="ij"), axis=-1).reshape(-1, 2)
    return u, v, flat
