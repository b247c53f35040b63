"""Isotropic configurations: J J^T = a 1, where the tool moves equally well in every direction.

Solved as an overdetermined system, not by minimising the condition number: at isotropy all
singular values coincide, where the condition number has a kink and its minimisers stall.

Sources: Salisbury & Craig, IJRR 1(1), 1982; Angeles, IJRR 11(3), 1992; note 000, section 六.
"""

from __future__ import annotations

from dataclasses import dataclass, field
from typing import Any

import numpy as np

from kinlab.analysis.best_condition import lower_condition
from kinlab.analysis.isotropy_system import IsotropySystem
from kinlab.analysis.lengths import OPTIMAL, read_length_choice
from kinlab.analysis.metrics import condition_number, singular_values
from kinlab.analysis.solver import solve
from kinlab.analysis.task_space import (
    read_reachable_task,
    revolute,
    search_box,
    wrap,
)
from kinlab.arrays import Array, frozen
from kinlab.options import seed_of, whole
from kinlab.robot import Robot

ISOTROPIC = 1e-8
"""Condition number - 1 at and below which a configuration is isotropic."""

_SAME = 1e-5
"""rad or m between two listings of one configuration. Double roots are solved to half the
digits, so that 1e-8 would list them twice."""


@dataclass(frozen=True)
class IsotropicConfiguration:
    """One isotropic configuration, or one family of them.

    Attributes:
        q: joint positions, (n,); free joints stand at zero or the middle of their limits.
        condition: condition number of J there.
        length: characteristic length in metres, ``None`` where the task needs none.
        free: names of the joints that may take any value without changing J J^T.
        freedom: dimension of the family; more than ``len(free)`` where joints move together.
        jacobian: the task's J, entries in metres over ``length``, (m, n).
    """

    q: Array
    condition: float
    length: float | None
    free: tuple[str, ...]
    freedom: int
    jacobian: Array = field(repr=False)


@dataclass(frozen=True)
class IsotropySearch:
    """Answer of :func:`find_isotropic`.

    Attributes:
        robot: its name. task: the task. rows: its rows. suggested: kinlab chose the task.
        length: ``given``, ``optimal`` or ``none needed``.
        configurations: isotropic configurations, families listed once. Empty: none was found.
        best_q: the best conditioned configuration, isotropic or not, (n,).
        best_condition: its condition number. best_length: its length, metres or ``None``.
        seeds: starts of the search. seed: of the random numbers.
        converged: starts that ended at isotropy.
        spread: 5 %, 50 % and 95 % quantiles of the condition number over the local minimisations
            (from the dozen best starts that differ), where there is no isotropy: how far they
            agree on the best one.
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


def find_isotropic(
    robot: Robot,
    task: Any = "auto",
    length: float | str = OPTIMAL,
    *,
    seeds: int = 400,
    seed: int = 0,
) -> IsotropySearch:
    """Isotropic configurations within the joint limits, or the best reachable condition number.

    Args:
        robot: the robot.
        task: a name, a mask of six booleans, or ``"auto"``; the answer states it.
        length: characteristic length in metres, or ``"optimal"``: solved for along with q. It
            matters for mixed tasks only; the answer states it.
        seeds: random starts within the limits.
        seed: of the starts; the same seed gives the same answer.

    Returns:
        The search; its configurations have condition number - 1 <= 1e-8.

    Raises:
        NameUnknownError, OptionError: unknown task, one with coordinates that the arm cannot
            move independently (then no configuration is isotropic), length <= 0.
    """
    seeds, seed = whole(seeds, "seeds"), seed_of(seed)
    space = read_reachable_task(robot, task)
    given = read_length_choice(length)
    system = IsotropySystem(space, given)
    lower, upper = search_box(robot)
    q = np.random.default_rng(seed).uniform(lower, upper, (seeds, robot.n))
    x, _ = solve(system, system.start(q), iterations=80)
    q, lengths = wrap(robot, system.q(x)), system.length(x)
    condition = condition_number(singular_values(space.jacobian(q, lengths)))
    inside = np.all((q >= lower - 1e-9) & (q <= upper + 1e-9), axis=1)
    isotropic = inside & (condition - 1.0 <= ISOTROPIC)
    configurations = isotropic_families(
        system, np.clip(q, lower, upper)[isotropic], lengths[isotropic]
    )
    spread = None
    if configurations:
        best = min(configurations, key=lambda c: c.condition)
        best_q, best_length, best_condition = best.q, best.length, best.condition
    else:
        state, size, reached = lower_condition(space, given, q, lengths)
        least = int(np.argmin(reached))
        best_q, best_condition = frozen(state[least]), float(reached[least])
        best_length = float(size[least]) if space.mixed else None
        low, middle, high = np.quantile(reached, [0.05, 0.5, 0.95])
        spread = (float(low), float(middle), float(high))
    how = "none needed" if not space.mixed else "optimal" if given is None else "given"
    return IsotropySearch(
        robot.name, space.name, space.rows, space.suggested, how, configurations, best_q,
        best_condition, best_length, seeds, seed, int(isotropic.sum()), spread,
    )  # fmt: skip


def isotropic_families(
    system: IsotropySystem, q: Array, lengths: Array
) -> tuple[IsotropicConfiguration, ...]:
    """One entry per configuration or family, ordered by q."""
    space, robot = system.space, system.space.robot
    lower, upper = search_box(robot)
    turns = revolute(robot)
    parked = np.clip(np.zeros(robot.n), lower, upper)
    seen: list[tuple[tuple[int, ...], int, Array, float]] = []
    for state, size in zip(q, lengths, strict=True):
        free, freedom = _freedom(system, state, float(size))
        place = state.copy()
        place[list(free)] = parked[list(free)]
        apart = [
            np.where(turns, 2.0 * np.abs(np.sin(0.5 * (place - other))), np.abs(place - other))
            for group, _, other, _ in seen
            if group == free
        ]
        # a curved family has no coordinates to compare: it is listed by its first member
        known_curve = freedom > len(free) and any(g[:2] == (free, freedom) for g in seen)
        if known_curve or any(float(d.max()) < _SAME for d in apart):
            continue
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


def _freedom(system: IsotropySystem, q: Array, length: float) -> tuple[tuple[int, ...], int]:
    """Joints that may move alone, tried and not only linearised, and the family's dimension."""
    space, robot = system.space, system.space.robot
    free = []
    for joint in range(robot.n):
        moved = np.repeat(q[np.newaxis], 3, axis=0)
        moved[:, joint] += (0.4, 1.1, -0.7)
        sigma = singular_values(space.jacobian(moved, length))
        if float((condition_number(sigma) - 1.0).max()) <= 10.0 * ISOTROPIC:
            free.append(joint)
    x = system.start(q[np.newaxis])
    if system.open_length:
        x[:, -1] = np.log(length)
    _, slope = system(x)
    _, values, right = np.linalg.svd(slope[0])
    still = right[int(np.sum(values > 1e-5 * values[0])) :]
    others = [i for i in range(right.shape[1]) if i not in free]
    curved = 0
    for direction in still:
        rest = np.zeros_like(direction)
        rest[others] = direction[others]
        if float(np.linalg.norm(rest)) < 0.5:
            continue
        # a double root linearises like a curve; only a step along it tells them apart
        ahead, norm = solve(system, x + 0.05 * rest)
        if norm[0] < 1e-10 and float(np.linalg.norm(ahead - x)) > 0.025:
            curved += 1
    return tuple(free), len(free) + curved
