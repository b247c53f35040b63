"""The boundary of a planar arm's workspace as circular arcs in closed form, limits included.

On the boundary some joints stand at a limit and the others are singular together: their axes
and the tool lie on one line. With the first of them sweeping, the tool draws an arc about its
axis. All such arcs are candidates (Haug et al., "Numerical algorithms for mapping boundaries of
manipulator workspaces", ASME J. Mech. Des. 118, 1996, here in closed form); they are cut where
they cross, and a piece belongs to the boundary where one of its two sides is out of reach.
"""

from __future__ import annotations

from dataclasses import dataclass, field
from itertools import pairwise, product

import numpy as np

from kinlab.analysis.structure.axes import Axes
from kinlab.analysis.structure.task_space import search_box
from kinlab.arrays import Array, between, frozen
from kinlab.engine.fast.stacks import fk
from kinlab.errors import OptionError
from kinlab.host.evidence import Evidence
from kinlab.host.introductions import Answer, Introduction, counted, vector
from kinlab.model.library import ArmLike, as_robot
from kinlab.model.robot import Robot
from kinlab.tolerances import TOLERANCES

_MOST_JOINTS = 5
"""3^5 * 2^4 candidates; beyond, the sides would take minutes to try."""


@dataclass(frozen=True)
class BoundaryArc:
    """A circular arc of the boundary.

    Attributes:
        centre: (2,), metres. radius: metres.
        start, stop: angles in the base's x-y plane, radians, start < stop <= start + 2 pi.
    """

    centre: Array
    radius: float
    start: float
    stop: float

    def points(self, count: int = 64) -> Array:
        """Points along the arc, ends included, (count, 2)."""
        angle = np.linspace(self.start, self.stop, count)
        circle = np.stack([np.cos(angle), np.sin(angle)], axis=1)
        return self.centre + self.radius * circle


@dataclass(frozen=True, repr=False)
class PlanarBoundary(Answer):
    """Answer of :func:`planar_boundary`.

    Attributes:
        robot: its name.
        arcs: the boundary, outer and inner.
        candidates: how many arcs were tried.
        evidence: what was tried, and what is proved of it.
    """

    robot: str
    arcs: tuple[BoundaryArc, ...]
    candidates: int
    evidence: Evidence = field(repr=False)

    def introduction(self) -> Introduction:
        """Its arcs, and what was tried for them."""
        rows = tuple(
            (vector(arc.centre), f"{arc.radius:.6g}", f"{arc.start:.5g}", f"{arc.stop:.5g}")
            for arc in self.arcs
        )
        return Introduction(
            f"boundary of {self.robot}'s workspace in its plane: {counted(len(self.arcs), 'arc')}",
            (str(self.evidence),),
            ("centre [m]", "radius [m]", "from [rad]", "to [rad]"),
            rows,
        )

    def points(self, spacing: float = 0.01) -> Array:
        """Points along all arcs, at most ``spacing`` metres apart, (K, 2)."""
        return np.concatenate(
            [
                arc.points(2 + int(arc.radius * (arc.stop - arc.start) / spacing))
                for arc in self.arcs
            ]
        )


@dataclass(frozen=True)
class _Chain:
    """A planar chain in complex numbers: tool = root + sum_k link_k exp(i sum_{j<=k} s_j q_j)."""

    root: complex
    links: Array
    signs: Array
    lower: Array
    upper: Array

    @property
    def reach(self) -> float:
        return float(np.abs(self.links).sum())

    def full_turn(self, j: int) -> bool:
        return bool(self.upper[j] - self.lower[j] >= 2.0 * np.pi - 1e-9)

    def tool(self, q: Array) -> Array:
        turned = np.exp(1j * np.cumsum(self.signs * q, axis=-1))
        place: Array = self.root + (self.links * turned).sum(axis=-1)
        return place


def planar_boundary(robot: ArmLike) -> PlanarBoundary:
    """The boundary of the set of tool positions of a planar revolute arm.

    Args:
        robot: an arm of 1 to 5 revolute joints whose axes are parallel to the base's z axis.

    Returns:
        Arcs whose centres and radii are exact; for the 2R arm without limits the rings
        l1 + l2 and |l1 - l2|. Which of the candidates belong to it is found by trying both sides
        a thousandth of the reach away: voids and islands thinner than that may be missed.

    Raises:
        OptionError: another kind of arm.
    """
    robot = as_robot(robot)
    chain = _planar_chain(robot)
    candidates = _distinct(_candidates(chain))
    pieces = _cut(candidates, TOLERANCES.beside_boundary * chain.reach)
    if not pieces:
        return PlanarBoundary(robot.name, (), len(candidates), _evidence(len(candidates)))
    middle = np.array([a.centre + a.radius * _unit(0.5 * (a.start + a.stop)) for a in pieces])
    normal = np.array([_unit(0.5 * (a.start + a.stop)) for a in pieces])
    side = TOLERANCES.beside_boundary * chain.reach
    outside = _reachable(chain, middle + side * normal)
    inside = _reachable(chain, middle - side * normal)
    kept = [a for a, o, i in zip(pieces, outside, inside, strict=True) if not (o and i)]
    joined = tuple(_joined(kept))
    return PlanarBoundary(robot.name, joined, len(candidates), _evidence(len(candidates)))


def _evidence(candidates: int) -> Evidence:
    return Evidence(
        f"{candidates} arcs that limits and stretched or folded parts allow: all there are",
        proved="the boundary is made of these arcs",
        found="which pieces: a side where no solution was met, "
        f"{TOLERANCES.beside_boundary:g} of the reach away",
    )


def _planar_chain(robot: Robot) -> _Chain:
    axes = Axes.at(robot, np.zeros(robot.n))
    upright = np.abs(np.abs(axes.direction[:, 2]) - 1.0) < 1e-9
    if not (axes.turns.all() and upright.all()) or robot.n > _MOST_JOINTS:
        raise OptionError(
            f"robot {robot.name!r}: the boundary in closed form is for 1 to {_MOST_JOINTS} "
            "revolute joints about axes parallel to the base's z; other arms: sample_workspace()"
        )
    tip = fk(robot, np.zeros(robot.n))[:2, 3]
    corners = np.concatenate([axes.point[:, :2], tip[np.newaxis]]) @ np.array([1.0, 1.0j])
    lower, upper = search_box(robot)
    return _Chain(
        complex(corners[0]), np.diff(corners), np.sign(axes.direction[:, 2]), lower, upper
    )


def _candidates(chain: _Chain) -> list[BoundaryArc]:
    n = len(chain.links)
    choices = [
        (None,) if chain.full_turn(j) else (None, float(chain.lower[j]), float(chain.upper[j]))
        for j in range(n)
    ]
    arcs: list[BoundaryArc] = []
    for locked in product(*choices):
        free = [j for j in range(n) if locked[j] is None]
        if free:
            arcs += _sweeps(chain, locked, free)
    return arcs


def _sweeps(chain: _Chain, locked: tuple[float | None, ...], free: list[int]) -> list[BoundaryArc]:
    """Arcs with these joints locked and the free ones on one line with the tool."""
    n = len(chain.links)
    turn = np.array([0.0 if v is None else v for v in locked]) * chain.signs
    ends = [*free[1:], n]
    # each rigid segment between free joints, in the frame of its first joint at zero
    segments = []
    for first, end in zip(free, ends, strict=True):
        angles = np.concatenate([[0.0], np.cumsum(turn[first + 1 : end])])
        segments.append(complex((chain.links[first:end] * np.exp(1j * angles)).sum()))
    if min(abs(s) for s in segments) < 1e-12 * chain.reach:
        return []  # a free joint that carries the next axis on its own moves nothing
    before = np.exp(1j * np.cumsum(turn[: free[0]]))
    centre = chain.root + complex((chain.links[: free[0]] * before).sum())
    heading = float(np.sum(turn[: free[0]]))
    arcs = []
    for flips in product((0.0, np.pi), repeat=len(free) - 1):
        total, direction, allowed = abs(segments[0]), np.angle(segments[0]), True
        last = 0.0  # turn of the frame that carries the next free joint, the sweep left out
        for k, flip in enumerate(flips, 1):
            carried = last + float(turn[free[k - 1] + 1 : free[k]].sum())
            wanted = direction + flip - np.angle(segments[k])  # absolute turn of segment k
            q = chain.signs[free[k]] * (wanted - carried)
            allowed &= _within(q, chain.lower[free[k]], chain.upper[free[k]])
            total += abs(segments[k]) * float(np.cos(flip))
            last = wanted
        if allowed and abs(total) > 1e-12 * chain.reach:
            base = heading + direction + (np.pi if total < 0.0 else 0.0)
            swing = sorted(
                chain.signs[free[0]] * b for b in (chain.lower[free[0]], chain.upper[free[0]])
            )
            where = frozen(np.array([centre.real, centre.imag]))
            arcs.append(BoundaryArc(where, abs(total), base + swing[0], base + swing[1]))
    return arcs


def _within(q: float, lower: float, upper: float) -> bool:
    turns = np.arange(-2.0, 3.0) * 2.0 * np.pi
    shifted = np.arctan2(np.sin(q), np.cos(q)) + turns
    return bool(between(shifted, lower, upper, TOLERANCES.limit_digits).any())


def _distinct(arcs: list[BoundaryArc]) -> list[BoundaryArc]:
    seen: dict[tuple[float, ...], BoundaryArc] = {}
    for a in arcs:
        start = float(np.mod(a.start + 1e-12, 2.0 * np.pi))
        seen.setdefault(tuple(np.round([*a.centre, a.radius, start, a.stop - a.start], 10)), a)
    return list(seen.values())


def _cut(arcs: list[BoundaryArc], shortest: float) -> list[BoundaryArc]:
    """Cuts every arc where another one crosses it or ends on it; drops crumbs."""
    pieces = []
    for arc in arcs:
        cuts = [0.0, arc.stop - arc.start]
        for other in arcs:
            for angle in _meetings(arc, other):
                ahead = float(np.mod(angle - arc.start, 2.0 * np.pi))
                if ahead < arc.stop - arc.start:
                    cuts.append(ahead)
        cuts.sort()
        for one, two in pairwise(cuts):
            if (two - one) * arc.radius > 1e-9 * shortest:
                pieces.append(BoundaryArc(arc.centre, arc.radius, arc.start + one, arc.start + two))
    return pieces


def _meetings(arc: BoundaryArc, other: BoundaryArc) -> list[float]:
    """Angles on ``arc`` where the other circle crosses it, or its end lies on it."""
    gap = other.centre - arc.centre
    distance = float(np.hypot(*gap))
    bearing = float(np.arctan2(gap[1], gap[0]))
    if distance < 1e-12:
        same = abs(arc.radius - other.radius) < 1e-12
        return [other.start, other.stop] if same else []
    along = (distance**2 + arc.radius**2 - other.radius**2) / (2.0 * distance)
    share = along / arc.radius
    if abs(share) > 1.0 + 1e-12:
        return []
    half = float(np.arccos(np.clip(share, -1.0, 1.0)))
    return [bearing - half, bearing + half]


def _joined(pieces: list[BoundaryArc]) -> list[BoundaryArc]:
    """Neighbouring pieces of one circle as one arc."""
    left = sorted(pieces, key=lambda a: (*np.round(a.centre, 9), round(a.radius, 9), a.start))
    out: list[BoundaryArc] = []
    for arc in left:
        last = out[-1] if out else None
        same = (
            last is not None
            and np.allclose(last.centre, arc.centre, atol=1e-9)
            and abs(last.radius - arc.radius) < 1e-9
        )
        if last is not None and same and arc.start <= last.stop + 1e-9:
            out[-1] = BoundaryArc(last.centre, last.radius, last.start, max(last.stop, arc.stop))
        else:
            out.append(arc)
    return out


def _reachable(chain: _Chain, points: Array) -> Array:
    """Which points (P, 2) the tool can reach: Newton within the limits from the nearest samples."""
    from scipy.spatial import cKDTree  # `import kinlab` does not wait for scipy

    n, targets = len(chain.links), points @ np.array([1.0, 1.0j])
    drawn = np.random.default_rng(0).uniform(chain.lower, chain.upper, (40_000, n))
    placed = chain.tool(drawn)
    tree = cKDTree(np.stack([placed.real, placed.imag], axis=1))
    _, nearest = tree.query(points, k=24)
    q = drawn[nearest]  # (P, 24, n)
    reached = np.zeros(len(points), dtype=bool)
    goal = 0.1 * TOLERANCES.beside_boundary * chain.reach
    for _ in range(80):
        todo = np.flatnonzero(~reached)
        if not len(todo):
            break
        state = q[todo]
        turned = chain.links * np.exp(1j * np.cumsum(chain.signs * state, axis=-1))
        miss = (targets[todo, np.newaxis] - chain.root - turned.sum(axis=-1)) / chain.reach
        reached[todo[(np.abs(miss) < goal / chain.reach).any(axis=1)]] = True
        levers = np.cumsum(turned[..., ::-1], axis=-1)[..., ::-1]  # tool minus axis k
        column = 1j * chain.signs * levers / chain.reach
        jac = np.stack([column.real, column.imag], axis=-2)
        error = np.stack([miss.real, miss.imag], axis=-1)
        damping = (1e-10 + 1e-3 * np.abs(miss) ** 2)[..., np.newaxis, np.newaxis]
        gram = jac @ jac.swapaxes(-1, -2) + damping * np.eye(2)
        step = np.einsum(
            "psij,psi->psj", jac, np.linalg.solve(gram, error[..., np.newaxis])[..., 0]
        )
        largest = np.abs(step).max(axis=-1, keepdims=True)
        step *= np.minimum(1.0, 0.3 / np.maximum(largest, 1e-12))
        q[todo] = np.clip(state + step, chain.lower, chain.upper)
    return reached


def _unit(angle: float) -> Array:
    return np.array([np.cos(angle), np.sin(angle)])
