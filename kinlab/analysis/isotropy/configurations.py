"""Isotropic configurations: J J^T = a 1, where the tool moves equally well in every direction.

Solved as an overdetermined system, not by minimising the condition number: at isotropy all
singular values coincide, where the condition number has a kink and its minimisers stall.

Sources: Salisbury & Craig, IJRR 1(1), 1982; Angeles, IJRR 11(3), 1992; note 000, section 六.
"""

from __future__ import annotations

import math
from dataclasses import dataclass, field
from typing import Any

import numpy as np

from kinlab.analysis.characteristic_length import OPTIMAL, read_length_choice
from kinlab.analysis.isotropy.best_condition import ENOUGH, LeastCondition, least_condition
from kinlab.analysis.isotropy.system import IsotropySystem
from kinlab.analysis.metrics import condition_number, singular_values
from kinlab.analysis.solver import solve
from kinlab.analysis.structure.task_space import (
    read_reachable_task,
    revolute,
    search_box,
    wrap,
)
from kinlab.arrays import Array, between, frozen, seed_of, whole
from kinlab.host.evidence import Evidence
from kinlab.host.introductions import Introduction, Rows, counted, numbered, shown_cells, vector
from kinlab.host.progress import takes_long
from kinlab.model.library import ArmLike, as_robot
from kinlab.tolerances import TOLERANCES

_NEAR = 0.05
"""Residual after thirty steps from which an isotropic configuration may still be reached."""


@dataclass(frozen=True)
class IsotropicConfiguration:
    """One isotropic configuration, or one family of them.

    Attributes:
        q: joint positions, (n,); free joints stand at zero or the middle of their limits.
        condition: condition number of J there.
        length: characteristic length in metres, ``None`` where the task needs none.
        free: names of the joints of which each may take any value alone and J stays isotropic.
        freedom: dimension of the family in joint space; more than ``len(free)`` where joints move
            together. Measured by configurations around this one.
        jacobian: the task's J, entries in metres over ``length``, (m, n).
    """

    q: Array
    condition: float
    length: float | None
    free: tuple[str, ...]
    freedom: int
    jacobian: Array = field(repr=False)


@dataclass(frozen=True, repr=False)
class IsotropySearch(Rows):
    """Answer of :func:`find_isotropic`.

    Attributes:
        robot: its name. task: the task. rows: its rows. suggested: kinlab chose the task.
        length: ``given``, ``optimal`` or ``none needed``.
        configurations: isotropic configurations, families listed once. Empty: none was found.
        best_q: the best conditioned configuration, isotropic or not, (n,).
        best_condition: its condition number. best_length: its length, metres or ``None``.
        seeds: starts of the search. seed: of the random numbers.
        converged: starts that ended at isotropy.
        spread: 5 %, 50 % and 95 % quantiles of the condition number over the local minimisations,
            where there is no isotropy: how far they agree on the best one.
        evidence: what was searched, how often the answer was met, and how sure it is.
    """

    robot: str
    task: str
    rows: tuple[int, ...]
    suggested: bool
    length: str
    configurations: tuple[IsotropicConfiguration, ...]
    best_q: Array
    best_condition: float
    best_length: float | None
    seeds: int
    seed: int
    converged: int
    spread: tuple[float, float, float] | None
    evidence: Evidence = field(repr=False)

    def columns(self) -> dict[str, Any]:
        """Isotropic configuration by configuration."""
        found = self.configurations
        return {
            **(numbered("q", [one.q for one in found]) if found else {}),
            "condition": [one.condition for one in found],
            "length": [math.nan if one.length is None else one.length for one in found],
            "free": [" ".join(one.free) for one in found],
            "freedom": [one.freedom for one in found],
        }

    def introduction(self) -> Introduction:
        """Whether the arm is isotropic somewhere, where it is best, and how sure that is."""
        chosen = " (chosen for this arm)" if self.suggested else ""
        length = ""
        if self.best_length is not None:
            length = f", length {self.best_length:.6g} m ({self.length})"
        if self.found:
            count = counted(len(self.configurations), "isotropic configuration")
            told = f"{count} (families count once)"
        else:
            told = f"no isotropic configuration found; best condition {self.best_condition:.6g}"
        cells = self.columns()
        return Introduction(
            f"{self.robot}, task {self.task}{chosen}: {told}",
            (
                f"best: q = {vector(self.best_q)}, condition {self.best_condition:.8g}{length}",
                str(self.evidence),
            ),
            tuple(cells) if self.found else (),
            shown_cells(cells) if self.found else (),
            len(self.configurations),
            "good" if self.found else "unsure",
        )

    @property
    def found(self) -> bool:
        """Whether the arm is isotropic somewhere."""
        return bool(self.configurations)

    def __len__(self) -> int:
        return len(self.configurations)

    def __iter__(self) -> Any:
        return iter(self.configurations)

    def __getitem__(self, index: int) -> IsotropicConfiguration:
        return self.configurations[index]


@takes_long("isotropic poses")
def find_isotropic(
    robot: ArmLike,
    task: Any = "auto",
    length: float | str = OPTIMAL,
    *,
    seeds: int = 400,
    seed: int = 0,
) -> IsotropySearch:
    """Isotropic configurations within the joint limits, or the least condition number found.

    Args:
        robot: the robot.
        task: a name, a mask of six booleans, or ``"auto"``; the answer states it.
        length: characteristic length in metres, or ``"optimal"``: solved for along with q. It
            matters for mixed tasks only; the answer states it.
        seeds: most random starts within the limits; more never give a worse condition number,
            but for rounding.
        seed: of the starts; the same seed gives the same answer.

    Returns:
        The search; its configurations have condition number - 1 <= 1e-8.

    Raises:
        NameUnknownError, OptionError: unknown task, one with coordinates that the arm cannot
            move independently (then no configuration is isotropic), length <= 0.
    """
    robot = as_robot(robot)
    seeds, seed = whole(seeds, "seeds"), seed_of(seed)
    space = read_reachable_task(robot, task)
    given = read_length_choice(length)
    system = IsotropySystem(space, given)
    lower, upper = search_box(robot)
    q = np.random.default_rng(seed).uniform(lower, upper, (seeds, robot.n))
    x, norm = solve(system, system.start(q), iterations=30)
    near = norm < _NEAR  # the others have stalled at a local minimum
    x[near], _ = solve(system, x[near], iterations=60)
    q, lengths = wrap(robot, system.q(x)), system.length(x)
    condition = condition_number(singular_values(space.jacobian(q, lengths)))
    inside = between(q, lower, upper, TOLERANCES.limit_digits).all(axis=1)
    isotropic = inside & (condition - 1.0 <= TOLERANCES.isotropic)
    configurations = isotropic_families(
        system, np.clip(q, lower, upper)[isotropic], lengths[isotropic]
    )
    spread, least = None, None
    if configurations:
        best = min(configurations, key=lambda c: c.condition)
        best_q, best_length, best_condition = best.q, best.length, best.condition
    else:
        least = least_condition(space, given, np.random.default_rng(seed), seeds)
        best_q, best_condition = frozen(least.q), least.condition
        best_length = least.length if space.mixed else None
        low, middle, high = np.quantile(least.ends, [0.05, 0.5, 0.95])
        spread = (float(low), float(middle), float(high))
    return IsotropySearch(
        robot.name,
        space.name,
        space.rows,
        space.suggested,
        system.how,
        configurations,
        best_q,
        best_condition,
        best_length,
        seeds,
        seed,
        int(isotropic.sum()),
        spread,
        _evidence(seeds, seed, int(isotropic.sum()), least),
    )


def _evidence(seeds: int, seed: int, met: int, least: LeastCondition | None) -> Evidence:
    if least is None:
        return Evidence(
            f"{seeds} starts within the limits (seed {seed})",
            met,
            seeds,
            f"J J^T = a 1 to {TOLERANCES.isotropic:g} at every listed configuration",
            "that there is no other family",
        )
    # no start of N ended lower: with a share p of such starts the chance of that is (1 - p)^N
    share = 1.0 - 0.05 ** (1.0 / least.starts)
    stopped = "once it was met often enough" if least.met >= ENOUGH else "at the end"
    return Evidence(
        f"{seeds} starts for isotropy, {least.starts} brought down on the condition number (seed "
        f"{seed}; stopped {stopped})",
        least.met,
        least.starts,
        "",
        f"the least condition number; a further start ends lower with a chance of at most "
        f"{100.0 * share:.2g} % (95 % sure)",
    )


def isotropic_families(
    system: IsotropySystem, q: Array, lengths: Array
) -> tuple[IsotropicConfiguration, ...]:
    """One entry per configuration or family, ordered by q."""
    space, robot = system.space, system.space.robot
    lower, upper = search_box(robot)
    turns = revolute(robot)
    at_zero = np.clip(np.zeros(robot.n), lower, upper)
    seen: list[tuple[tuple[int, ...], int, Array, float]] = []
    for state, size in zip(q, lengths, strict=True):
        free = _free_joints(system, state, float(size))
        place = state.copy()
        place[list(free)] = at_zero[list(free)]
        alike = [(freedom, other) for group, freedom, other, _ in seen if group == free]
        apart = [
            np.where(turns, 2.0 * np.abs(np.sin(0.5 * (place - other))), np.abs(place - other))
            for _, other in alike
        ]
        # a curved family has no coordinates to compare: it is listed by its first member
        known_curve = any(freedom > len(free) for freedom, _ in alike)
        if known_curve or any(float(d.max()) < TOLERANCES.same_configuration for d in apart):
            continue
        freedom = max(len(free), _dimension(system, state, float(size)))
        seen.append((free, freedom, place, float(size)))
    names = robot.joint_names
    found = []
    for free, freedom, place, size in seen:
        matrix = space.jacobian(place, size)
        sigma = singular_values(matrix)
        condition = float(sigma[0] / sigma[-1])
        used = size if space.mixed else None
        loose = tuple(names[i] for i in free)
        entry = IsotropicConfiguration(
            frozen(place), condition, used, loose, freedom, frozen(matrix)
        )
        found.append(entry)
    return tuple(sorted(found, key=lambda c: tuple(np.round(c.q, 6))))


def _free_joints(system: IsotropySystem, q: Array, length: float) -> tuple[int, ...]:
    """Joints that may move alone, tried and not only linearised.

    J J^T - a 1 is of degree two in the cosine and sine of a joint, or in a slide: five values, the
    given one among them, at which it is zero are enough.
    """
    space, robot = system.space, system.space.robot
    free = []
    for joint in range(robot.n):
        moved = np.repeat(q[np.newaxis], 4, axis=0)
        moved[:, joint] += (0.4, 1.1, -0.7, -1.9)
        sigma = singular_values(space.jacobian(moved, length))
        if float((condition_number(sigma) - 1.0).max()) <= 10.0 * TOLERANCES.isotropic:
            free.append(joint)
    return tuple(free)


def _dimension(system: IsotropySystem, q: Array, length: float) -> int:
    """Dimension of the solutions near q, from solutions around it and not from a tangent.

    Where families cross their solutions together span more: the least of x and of a few solutions
    around it counts.
    """
    x = system.start(q[np.newaxis])
    if system.open_length:
        x[:, -1] = np.log(length)
    around, size = _neighbours(system, x)
    for number in range(0, len(around), max(1, len(around) // 3)):
        if size == 0:
            break
        size = min(size, _neighbours(system, around[number : number + 1])[1])
    return size


def _neighbours(system: IsotropySystem, x: Array) -> tuple[Array, int]:
    """Solutions around x (1, k), (N, k), and how many directions they span."""
    _, derivative = system(x)
    _, values, right = np.linalg.svd(derivative[0])
    still = right[int(np.sum(values > 1e-5 * values[0])) :]
    if not len(still):
        return x[:0], 0
    drawn = np.random.default_rng(6).normal(size=(8 * len(still), len(still))) @ still
    drawn *= TOLERANCES.family_radius / np.linalg.norm(drawn, axis=1, keepdims=True)
    ahead, norm = solve(system, x + drawn, iterations=120)
    around = ahead[norm < 1e-9]
    if not len(around):
        return around, 0
    apart = system.q(around) - system.q(x)
    spread = np.linalg.svd(apart / np.sqrt(len(around)), compute_uv=False)
    return around, int(np.sum(spread > 0.15 * TOLERANCES.family_radius / np.sqrt(len(still))))
