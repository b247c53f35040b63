"""Curves of the singular set in a slice of joint space, by pseudo-arclength continuation.

In a slice of c + 1 joints, c the codimension of the singular set (1 for a square J, hence two
joints; 2 for one joint more than task rows, hence three), the set is made of curves. They are
traced in (q, u) with u the null vector, where sheets that cross in q pass each other (Keller's
method; Allgower & Georg, *Introduction to Numerical Continuation Methods*, chapter 2).
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, field, replace
from typing import Any

import numpy as np
from numpy.typing import ArrayLike

from kinlab.analysis.metrics import counting
from kinlab.analysis.singularities import singular_set as sets
from kinlab.analysis.solver import solve
from kinlab.analysis.structure.task_space import read_reachable_task, revolute, search_box, wrap
from kinlab.arrays import Array, frozen, number, seed_of, shown, whole
from kinlab.engine.states import joint_vector
from kinlab.errors import NameUnknownError, OptionError, near
from kinlab.host.evidence import Evidence
from kinlab.host.introductions import Answer, Introduction, counted
from kinlab.host.progress import takes_long
from kinlab.model.library import ArmLike, as_robot
from kinlab.model.robot import Robot
from kinlab.tolerances import TOLERANCES

_LINES = 64
"""Scan lines along each joint of a slice, stratified over the others' ranges: an arc that spans
two 64ths of the range of any joint is met, however short it is along the others."""


_MOST = 6000
"""Steps after which one curve is cut: a closed curve of 100 turns."""


_ALIKE = 0.95
"""Cosine between null vectors above which two near points are on one curve."""


_STRAIGHT = 0.995
"""Least cosine between neighbouring tangents: a chord then leaves its curve by at most 1.3 % of
the step, and a bend is not cut over to a neighbouring sheet."""
_BESIDE = 0.03
"""Distance from a traced curve, in steps, up to which a point belongs to it. The Puma with its
arm folded has two sheets 0.07 steps apart with one null vector, which must stay two."""


@dataclass(frozen=True)
class Locus:
    """One curve of singular configurations.

    Attributes:
        q: points along it, full joint vectors, (K, n), each solved to rounding; joints that turn
            round go on past ±pi, so that neighbours stay neighbours.
        closed: it returns to its start, revolute joints by whole turns.
    """

    q: Array
    closed: bool


@dataclass(frozen=True, repr=False)
class Loci(Answer):
    """Answer of :func:`singular_loci`.

    Attributes:
        robot: its name. task: the task.
        joints: indices of the joints of the slice.
        held: q of the other joints, (n,).
        curves: what was found.
        evidence: what was searched for a first point of each curve.
    """

    robot: str
    task: str
    joints: tuple[int, ...]
    held: Array
    curves: tuple[Locus, ...]
    evidence: Evidence = field(repr=False)

    def introduction(self) -> Introduction:
        """How many curves there are in the slice."""
        one, two = (joint + 1 for joint in self.joints)
        return Introduction(
            f"{self.robot}, task {self.task}: {counted(len(self.curves), 'singular curve')} in the "
            f"slice of joints {one} and {two}",
            (str(self.evidence),),
        )


@takes_long("singular curves")
def singular_loci(
    robot: ArmLike,
    joints: Sequence[int | str],
    q: ArrayLike | None = None,
    task: Any = "auto",
    *,
    step: float = 0.05,
    levels: int = 9,
    seed: int = 0,
) -> Loci:
    """Singular curves in the slice of the given joints, the others held at q.

    With one joint more than the curves need (three for a square J), the last joint is held at
    ``levels`` values across its limits, and the curves of each slice are returned together:
    contour lines of the singular surface.

    Args:
        robot: the robot.
        joints: names or indices (from 0) of two or three joints.
        q: where the others are held, (n,); drawn within the limits where left out, since middles
            and zeros are singular themselves in many arms. The answer states it.
        task: a name, a mask, or ``"auto"``.
        step: length of a step along a curve, rad (or m).
        levels: slices of the last joint, where there is one joint more.
        seed: of the drawn q, and of the scan that finds a first point of each curve.

    Raises:
        NameUnknownError, OptionError, StateError: unknown joint or task, a joint named twice, a
            number of joints in whose slice the singular set is no curve (says how many it needs).
    """
    robot = as_robot(robot)
    space = read_reachable_task(robot, task)
    chosen = _read_joints(robot, joints)
    lower, upper = search_box(robot)
    seed = seed_of(seed)
    drawn = np.random.default_rng(seed).uniform(lower, upper)
    middle = drawn if q is None else joint_vector(robot, q, "q")
    if middle.shape != (robot.n,):
        raise OptionError(f"robot {robot.name!r}: q has shape {middle.shape}; give one state")
    step = number(step, "step", above=TOLERANCES.shortest_step)
    levels = whole(levels, "levels")
    needed = abs(space.m - robot.n) + 2
    if len(chosen) == needed:
        system = sets.SingularSystem(space, chosen, middle)
        if _all_singular(system):
            raise OptionError(
                f"robot {robot.name!r}: with the other joints held there, every configuration of "
                "the slice is singular; hold them elsewhere (q=...)"
            )
        curves = _trace_all(system, step, seed)
    elif len(chosen) == needed + 1 == 3:
        curves = ()
        last = chosen[-1]
        for value in np.linspace(lower[last], upper[last], levels):
            held = middle.copy()
            held[last] = value
            system = sets.SingularSystem(space, chosen[:-1], held)
            if not _all_singular(system):  # such a level is a sheet of the surface, not a curve
                curves += _trace_all(system, step, seed)
    else:
        raise OptionError(
            f"robot {robot.name!r}: {len(chosen)} joints; for task {space.name} with {robot.n} "
            f"joints the singular set is made of curves in slices of {needed}"
        )
    evidence = Evidence(
        f"{_LINES} stratified lines along each joint of every slice (seed {seed}), each curve "
        "followed to its ends",
        proved="every listed point is singular",
        found="that there is no other curve",
    )
    return Loci(robot.name, space.name, chosen, frozen(middle), curves, evidence)


def _read_joints(robot: Robot, joints: Sequence[int | str]) -> tuple[int, ...]:
    if isinstance(joints, str) or not isinstance(joints, (Sequence, np.ndarray)):
        raise OptionError(f"joints {shown(joints)}; give a list of two or three joints")
    names = robot.joint_names
    chosen = []
    for joint in joints:
        if isinstance(joint, str):
            if joint not in names:
                raise NameUnknownError(
                    f"robot {robot.name!r}: joint {joint!r} does not exist; {near(joint, names)}"
                )
            chosen.append(names.index(joint))
        else:
            what = f"robot {robot.name!r}: index of a joint"
            chosen.append(whole(joint, what, 0, robot.n - 1))
    if len(set(chosen)) < len(chosen):
        raise OptionError(f"robot {robot.name!r}: joints {list(joints)}: one is named twice")
    return tuple(chosen)


def _trace_all(system: sets.SingularSystem, step: float, seed: int) -> tuple[Locus, ...]:
    """Every curve that some start lies on, each once."""
    starts = sets.seeds(system, np.random.default_rng(seed), points=_LINES)
    x, good = sets.project(system, starts)
    return tuple(
        Locus(frozen(_continuous(system.space.robot, system.states(points))), closed)
        for points, closed in _traced(system, x[good], step)
    )


def trace_from(system: Any, x: Array, step: float) -> list[Array]:
    """Every curve that some solution (N, k) of a system lies on, each once, as unknowns (K, k).

    Args:
        system: as :class:`kinlab.analysis.singularities.singular_set.SingularSystem`, with one
            equation less than unknowns.
        x: solutions.
        step: length of a step.
    """
    return [points for points, _ in _traced(system, x, step)]


def _traced(system: Any, x: Array, step: float) -> list[tuple[Array, bool]]:
    found: list[tuple[Array, bool]] = []
    for point in x:
        if any(_on(system, points, point, step) for points, _ in found):
            continue
        points, closed = _trace(system, point, step)
        # where the rank drops by two, u may turn alone
        if np.ptp(points[:, : len(system.moving)], axis=0).max() > step:
            found.append((points, closed))
    return found


def _all_singular(system: sets.SingularSystem) -> bool:
    lower, upper = search_box(system.space.robot)
    drawn = np.random.default_rng(2).uniform(lower, upper, (8, system.space.robot.n))
    states = system.states(drawn[:, list(system.moving)])
    sigma = system.space.sigma(states)
    return not bool(counting(sigma)[:, -1].any())


def _on(system: sets.SingularSystem, points: Array, point: Array, step: float) -> bool:
    """Whether ``point`` lies on a traced curve: near it in q, with the same null vector."""
    free = len(system.moving)
    chord = np.diff(points[:, :free], axis=0)
    apart = point[:free] - points[:-1, :free]
    turns = revolute(system.space.robot)[list(system.moving)]
    apart = np.where(turns, np.arctan2(np.sin(apart), np.cos(apart)), apart)
    size = np.maximum(np.einsum("ki,ki->k", chord, chord), 1e-300)
    share = np.clip(np.einsum("ki,ki->k", apart, chord) / size, 0.0, 1.0)
    distance = np.linalg.norm(apart - share[:, np.newaxis] * chord, axis=1)
    alike = np.abs(points[:-1, free:] @ point[free:]) > _ALIKE
    return bool(np.any((distance < _BESIDE * step) & alike))


def _trace(system: sets.SingularSystem, start: Array, step: float) -> tuple[Array, bool]:
    """Both ways from a start, until the curve closes or leaves the limits: unknowns (K, k)."""
    forward, closed = _follow(system, start, step, 1.0)
    if closed:
        return forward, True
    backward, _ = _follow(system, start, step, -1.0)
    return np.concatenate([backward[:0:-1], forward]), False


def _continuous(robot: Robot, states: Array) -> Array:
    """The curve moved by whole turns so that its middle point lies in the search box."""
    middle = states[len(states) // 2]
    moved: Array = states + (wrap(robot, middle) - middle)
    return moved


def _bounds(system: sets.SingularSystem) -> tuple[Array, Array]:
    """Limits of the moving joints; none for those that may turn all the way round."""
    lower, upper = search_box(system.space.robot)
    round_ = revolute(system.space.robot) & (upper - lower >= 2.0 * np.pi - 1e-9)
    chosen = list(system.moving)
    lower = np.where(round_, -np.inf, lower - TOLERANCES.limit_rounding)
    upper = np.where(round_, np.inf, upper + TOLERANCES.limit_rounding)
    return lower[chosen], upper[chosen]


def _follow(
    system: sets.SingularSystem, start: Array, step: float, sign: float
) -> tuple[Array, bool]:
    free = len(system.moving)
    lower, upper = _bounds(system)
    turns = revolute(system.space.robot)[list(system.moving)]
    direction = sign * _tangent(system, start, None)
    points = [start]
    size = step
    travelled = 0.0
    while len(points) < _MOST:
        here = points[-1]
        trial = here + size * direction
        fixed, norm = solve(system, trial[np.newaxis], iterations=12)
        moved = float(np.linalg.norm(fixed[0] - trial))
        if norm[0] > TOLERANCES.on_singular_set or moved > 0.5 * size:
            size *= 0.5
            if size < 1e-6 * step:
                break  # an end, or a point where the curve has no tangent
            continue
        new = fixed[0]
        ahead = _tangent(system, new, direction)
        if float(ahead @ direction) < _STRAIGHT and size > 1e-3 * step:
            size *= 0.5
            continue
        if np.any(new[:free] < lower) or np.any(new[:free] > upper):
            end = _end_on_limit(system, here, new, lower, upper)
            if end is not None:
                points.append(end)
            return np.array(points), False
        points.append(new)
        travelled += size
        direction = ahead
        size = min(step, 1.5 * size)
        apart = new[:free] - start[:free]
        apart = np.where(turns, np.arctan2(np.sin(apart), np.cos(apart)), apart)
        if travelled > 3.0 * step and float(np.linalg.norm(apart)) < 0.75 * step:
            turned = 2.0 * np.pi * np.round((new[:free] - start[:free]) / (2.0 * np.pi))
            last = start.copy()
            last[:free] += np.where(turns, turned, 0.0)
            return np.array([*points, last]), True
    return np.array(points), False


def _tangent(system: sets.SingularSystem, x: Array, along: Array | None) -> Array:
    """Unit tangent in (q, u), with a q part of unit length where it has one."""
    _, derivative = system(x[np.newaxis])
    _, _, right = np.linalg.svd(derivative[0])
    tangent: Array = right[-1]
    free = len(system.moving)
    if along is None:
        lead = tangent[int(np.argmax(np.abs(tangent[:free])))]
        return tangent if lead > 0.0 else -tangent
    return tangent if float(tangent @ along) > 0.0 else -tangent


def _end_on_limit(
    system: sets.SingularSystem, inside: Array, outside: Array, lower: Array, upper: Array
) -> Array | None:
    """Where the curve meets the limits between two of its points."""
    free = len(system.moving)
    change = outside[:free] - inside[:free]
    with np.errstate(divide="ignore", invalid="ignore"):
        shares = np.where(
            change > 0.0, (upper - inside[:free]) / change, (lower - inside[:free]) / change
        )
    shares[change == 0.0] = np.inf
    joint = int(np.argmin(shares))
    limit = upper[joint] if change[joint] > 0.0 else lower[joint]
    held = system.held.copy()
    held[system.moving[joint]] = limit
    rest = tuple(j for j in system.moving if j != system.moving[joint])
    guess = inside + float(shares[joint]) * (outside - inside)
    reduced = replace(system, moving=rest, held=held)
    found, norm = solve(reduced, np.delete(guess, joint)[np.newaxis], iterations=20)
    if norm[0] > TOLERANCES.on_singular_set:
        return None
    return np.insert(found[0], joint, limit)
