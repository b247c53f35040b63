"""Whether an arm can change its posture without meeting a singularity: cuspidal arms.

Two solutions of one pose on one side of every factor of det J may lie in one aspect. Between such
pairs a path is sought, along straight lines first and then through a roadmap of sampled joint
positions; it counts only when it is shown to stay clear of singularities between its samples
(:mod:`kinlab.inverse.postures.nonsingular`). Nothing is concluded from signs of det J at samples.

Wenger, "Uniqueness domains and regions of feasible paths for cuspidal manipulators", IEEE Trans.
Robotics 20(4), 2004; Salunkhe, Spartalis, Capco, Chablat & Wenger, "Necessary and sufficient
condition for a generic 3R serial manipulator to be cuspidal", Mech. Mach. Theory 171, 2022.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass, field
from itertools import combinations
from typing import Any

import numpy as np
from numpy.typing import ArrayLike

from kinlab.analysis.singularities.factor import Factor
from kinlab.analysis.singularities.minors import factors
from kinlab.analysis.structure.task_space import TaskSpace, read_task, revolute, search_box
from kinlab.arrays import Array, between, seed_of, truth, whole
from kinlab.engine.fast.stacks import fk
from kinlab.engine.states import joint_vector
from kinlab.errors import OptionError, StateError
from kinlab.host.evidence import Evidence
from kinlab.host.progress import pulse, takes_long
from kinlab.inverse.branches.solutions import ik_branches
from kinlab.inverse.postures.nonsingular import NonsingularPath, same_sign, show_nonsingular
from kinlab.inverse.postures.regional import Regional, is_regional, singular_points
from kinlab.inverse.postures.roadmap import Roadmap
from kinlab.model.library import ArmLike, as_robot
from kinlab.model.robot import Robot
from kinlab.tolerances import TOLERANCES

CUSPIDAL, NONE_FOUND = "cuspidal", "none found"

_TURNS = 6
"""Ways round, by whole turns of joints, that are tried for a pair, the shortest first."""
_ROADMAPS = 4
"""Sides of det J, those with the most pairs first, that get a roadmap."""
_PAIRS = 24
"""Pairs that are asked of one roadmap."""

_BESIDE = 24
"""Joint positions drawn beside each cusp."""

Progress = Callable[[str, int, int], None]


@dataclass(frozen=True, eq=False)
class Cuspidality:
    """Answer of :func:`is_cuspidal`.

    Attributes:
        robot: its name. task: what a pose is.
        verdict: ``"cuspidal"`` (shown) or ``"none found"`` (which proves nothing unless the
            evidence says so).
        pose: (4, 4), a pose with two solutions in one aspect, or ``None``.
        path: from one of them to the other, without a singularity, or ``None``.
        poses: how many poses were tried. pairs: pairs of solutions on one side of every factor.
        evidence: what was searched, and what is proved.
    """

    robot: str
    task: str
    verdict: str
    pose: Array | None
    path: NonsingularPath | None
    poses: int
    pairs: int
    evidence: Evidence = field(repr=False)

    def __bool__(self) -> bool:
        raise TypeError('ask .verdict: it is "cuspidal" or "none found", and the latter is no "no"')


@dataclass(frozen=True, eq=False)
class _Pairs:
    """Pairs of solutions of one pose on one side: rows of q, (M, n) each, and their sides."""

    one: Array
    two: Array
    sides: tuple[tuple[int, ...], ...]


@takes_long("changes of posture")
def is_cuspidal(
    robot: ArmLike,
    *,
    poses: int = 200,
    nodes: int = 1500,
    limits: bool = True,
    seed: int = 0,
    progress: Progress | None = None,
) -> Cuspidality:
    """Seeks a change of posture without a singularity.

    Args:
        robot: an arm with as many joints as its task has coordinates: six for poses, three for
            positions, planar arms.
        poses: how many random poses are solved.
        nodes: joint positions in a roadmap.
        limits: stay within the joint limits. False: as the literature has it, revolute joints
            turn round without end (slides keep their limits).
        seed: of poses and roadmaps.
        progress: called with (what, done, total).

    Returns:
        The verdict, with pose and path where there is one.

    Raises:
        OptionError: a task with more or fewer coordinates than joints; bad numbers.
        StructureError: no pose has a finite number of solutions.
    """
    robot = as_robot(robot)
    count, seed = whole(poses, "poses"), seed_of(seed)
    nodes = whole(nodes, "nodes")
    space, limits = square_task(robot), truth(limits, "limits")
    parts = factors(space) or ()
    low, high = _range(robot, limits)
    rng = np.random.default_rng(seed)
    draw_low, draw_high = search_box(robot)
    drawn = rng.uniform(draw_low, draw_high, (count, robot.n))
    special = _near_cusps(robot, rng)
    drawn = np.concatenate([drawn, np.clip(special, draw_low, draw_high)])
    tell = progress or (lambda what, done, total: pulse())
    tell("poses", 0, count)
    pairs = _pairs(space, parts, drawn, low, high)
    tell("poses", count, count)
    beside = f" and {len(special)} beside cusps" if len(special) else ""
    searched = (
        f"{count} random poses (seed {seed}){beside}"
        f", {'within' if limits else 'without'} the joint "
        f"limits; {len(pairs.one)} pairs of solutions on one side of {_named(robot, parts)}"
    )
    path, proved, found = None, "", "that no posture changes without a singularity"
    if len(pairs.one):
        path = _straight(space, pairs, low, high, tell)
        if path is None:
            path = _by_roadmap(space, parts, pairs, low, high, nodes, rng, tell)
            searched += f"; straight lines, and roadmaps of {nodes} joint positions"
    else:
        found += ": no pose was met with two solutions on one side of every factor of det J"
    if path is not None:
        joined = "two solutions of one pose are joined by a path without a singularity"
        proved, found = f"{joined}: {path.evidence.proved}", ""
    return Cuspidality(
        robot.name,
        space.name,
        NONE_FOUND if path is None else CUSPIDAL,
        None if path is None else fk(robot, path.q[0]),
        path,
        count,
        len(pairs.one),
        Evidence(searched, proved=proved, found=found),
    )


def _near_cusps(robot: Robot, rng: np.random.Generator) -> Array:
    """Joint positions beside the cusps of a 3R arm, where four solutions are near, (M, n)."""
    if not is_regional(robot):
        return np.empty((0, robot.n))
    found = singular_points(Regional.of(robot)).cusps
    rows = np.repeat(found, _BESIDE, axis=0)
    rows = rows + rng.normal(scale=0.3, size=rows.shape)
    return np.concatenate([np.zeros((len(rows), 1)), rows], axis=1)


def posture_path(
    robot: ArmLike,
    one: ArrayLike,
    two: ArrayLike,
    *,
    nodes: int = 1500,
    limits: bool = True,
    seed: int = 0,
) -> NonsingularPath | None:
    """A path between two joint positions that is shown to meet no singularity.

    Args:
        robot, nodes, limits, seed: as for :func:`is_cuspidal`.
        one, two: where it starts and ends, (n,); ``two`` may be turned by whole turns.

    Returns:
        The path, or ``None``: none was found. Where a factor of det J has another sign at the two,
        there is none.

    Raises:
        StateError: q of the wrong shape, or outside the limits. OptionError: as above.
    """
    robot = as_robot(robot)
    space, limits = square_task(robot), truth(limits, "limits")
    first, second = joint_vector(robot, one, "one"), joint_vector(robot, two, "two")
    if first.ndim != 1 or second.ndim != 1:
        raise StateError(f"robot {robot.name!r}: give two states of shape ({robot.n},)")
    ends = np.stack([first, second])
    low, high = _range(robot, limits)
    for name, q in zip(("one", "two"), ends, strict=True):
        outside = ~between(q, low, high, TOLERANCES.limit_digits)
        if outside.any():
            joint = robot.joint_names[int(np.argmax(outside))]
            raise StateError(f"robot {robot.name!r}: {name} is outside the limits of {joint}")
    rng, nodes = np.random.default_rng(seed_of(seed)), whole(nodes, "nodes")
    parts = factors(space) or ()
    side = _sides(space, parts, ends)
    if side[0] != side[1]:
        return None
    pairs = _Pairs(ends[:1], ends[1:], (side[0],))
    quiet: Progress = lambda what, done, total: None  # noqa: E731
    path = _straight(space, pairs, low, high, quiet)
    if path is None:
        path = _by_roadmap(space, parts, pairs, low, high, nodes, rng, quiet)
    return path


def changes_without_singularity(robot: Robot, q: Array) -> NonsingularPath | None:
    """The path through rows of q (N, n), if it is shown to meet no singularity of the arm's task.

    For answers of :func:`kinlab.ik_path` whose first and last row are two postures of one pose.
    """
    return show_nonsingular(square_task(robot), np.asarray(q, dtype=np.float64))


def square_task(robot: Robot) -> TaskSpace:
    """The task that fixes all joints of an arm.

    Raises:
        OptionError: the arm's task has more or fewer coordinates than joints.
    """
    space = read_task(robot, "auto")
    if space.m != robot.n:
        raise OptionError(
            f"robot {robot.name!r}: {robot.n} joints and a task ({space.name}) of {space.m} "
            "coordinates; aspects and postures need as many of one as of the other"
        )
    return space


def side_of(space: TaskSpace, parts: tuple[Factor, ...], q: Array) -> Array:
    """Sign of det J and of each of its factors at q (N, n), (N, 1 + k) of integers."""
    found = [np.sign(np.linalg.det(space.jacobian(q, space.scale)))]
    for part in parts:
        if part.coefficients.shape[-1] == 1:
            found.append(np.sign(part.values(q[:, list(part.joints)])[0][:, 0]))
    return np.stack(found, axis=1).astype(np.int64)


def _sides(space: TaskSpace, parts: tuple[Factor, ...], q: Array) -> list[tuple[int, ...]]:
    return [tuple(row) for row in side_of(space, parts, q).tolist()]


def _named(robot: Robot, parts: tuple[Factor, ...]) -> str:
    names = [" and ".join(robot.joint_names[i] for i in f.joints) for f in parts]
    return f"every factor of det J ({'; '.join(names)})" if len(parts) > 1 else "det J = 0"


def _range(robot: Robot, limits: bool) -> tuple[Array, Array]:
    low, high = robot.lower.copy(), robot.upper.copy()
    if not limits:
        turns = revolute(robot)
        low[turns], high[turns] = -np.inf, np.inf
    return low, high


def _pairs(
    space: TaskSpace, parts: tuple[Factor, ...], drawn: Array, low: Array, high: Array
) -> _Pairs:
    """All pairs of solutions of the poses of ``drawn`` that lie on one side, well away from it."""
    robot = space.robot
    found = ik_branches(robot, fk(robot, drawn))
    one, two, sides = [], [], []
    for row, number in enumerate(found.counts):
        q = found.q[row, :number]
        q = q[((q >= low) & (q <= high)).all(axis=1)]
        least = space.sigma(q)[:, -1]
        q = q[least > 1e-4]
        side = _sides(space, parts, q)
        for i, j in combinations(range(len(q)), 2):
            if side[i] == side[j] and differ(robot, q[i], q[j]):
                one.append(q[i])
                two.append(q[j])
                sides.append(side[i])
    n = robot.n
    return _Pairs(np.reshape(one, (-1, n)), np.reshape(two, (-1, n)), tuple(sides))


def differ(robot: Robot, one: Array, two: Array) -> bool:
    """Whether two joint positions (n,) are two, whole turns left out."""
    gap = two - one
    turned = np.where(revolute(robot), gap - 2.0 * np.pi * np.round(gap / (2.0 * np.pi)), gap)
    return bool(np.abs(turned).max() > TOLERANCES.two_solutions)


def ways_round(robot: Robot, one: Array, two: Array, low: Array, high: Array) -> Array:
    """``two`` by whole turns of its joints, within the limits, nearest to ``one`` first, (M, n)."""
    turns = np.flatnonzero(revolute(robot))
    nearest = two.copy()
    nearest[turns] -= 2.0 * np.pi * np.round((two - one)[turns] / (2.0 * np.pi))
    ways = [nearest]
    for joint in turns:
        for way in (-1.0, 1.0):
            other = nearest.copy()
            other[joint] += way * 2.0 * np.pi
            ways.append(other)
    ways.append(two)
    every = np.array(ways)
    every = every[((every >= low) & (every <= high)).all(axis=1)]
    order = np.argsort(np.linalg.norm(every - one, axis=1), kind="stable")
    return np.asarray(every[order][:_TURNS])


def _straight(
    space: TaskSpace, pairs: _Pairs, low: Array, high: Array, tell: Progress
) -> NonsingularPath | None:
    """The first straight line between a pair that can be shown to be free, the likeliest first."""
    starts: list[Array] = []
    ends: list[Array] = []
    for one, two in zip(pairs.one, pairs.two, strict=True):
        ways = ways_round(space.robot, one, two, low, high)
        starts.extend([one] * len(ways))
        ends.extend(ways)
    if not starts:
        return None
    one, two = np.array(starts), np.array(ends)
    chosen = np.concatenate(
        [same_sign(space, one[i : i + 512], two[i : i + 512]) for i in range(0, len(one), 512)]
    )
    one, two = one[chosen], two[chosen]
    if not len(one):
        return None
    share = np.linspace(0.0, 1.0, 33)[:, np.newaxis]
    states = one[:, np.newaxis] + share * (two - one)[:, np.newaxis]
    values = space.sigma(states.reshape(-1, one.shape[1]))[:, -1].reshape(len(one), -1)
    order = np.argsort(-values.min(axis=1), kind="stable")
    for done, row in enumerate(order):
        tell("straight lines", done, len(order))
        path = show_nonsingular(space, np.stack([one[row], two[row]]))
        if path is not None:
            return path
    return None


def _by_roadmap(
    space: TaskSpace,
    parts: tuple[Factor, ...],
    pairs: _Pairs,
    low: Array,
    high: Array,
    nodes: int,
    rng: np.random.Generator,
    tell: Progress,
) -> NonsingularPath | None:
    sides = sorted(set(pairs.sides), key=lambda s: (-pairs.sides.count(s), s))[:_ROADMAPS]
    for done, side in enumerate(sides):
        tell("roadmaps", done, len(sides))
        rows = [i for i, s in enumerate(pairs.sides) if s == side][:_PAIRS]
        goals = [ways_round(space.robot, pairs.one[i], pairs.two[i], low, high) for i in rows]
        given = np.concatenate([pairs.one[rows], *goals])

        def inside(q: Array, side: tuple[int, ...] = side) -> Any:
            return (side_of(space, parts, q) == side).all(axis=1)

        map_ = Roadmap.sample(space, inside, given, low, high, nodes, rng)
        first = len(rows)
        for number, ways in enumerate(goals):
            for way in range(len(ways)):
                path = map_.path(number, first + way)
                if path is not None:
                    return path
            first += len(ways)
    return None
