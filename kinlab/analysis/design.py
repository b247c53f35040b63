"""Link lengths and twists that make an arm isotropic, solved together with the configuration."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from dataclasses import dataclass, field
from typing import Any

import numpy as np

from kinlab.analysis.design_model import open_chain
from kinlab.analysis.design_system import DesignSystem
from kinlab.analysis.evidence import Evidence
from kinlab.analysis.isotropy import ISOTROPIC, IsotropicConfiguration, isotropic_families
from kinlab.analysis.isotropy_system import IsotropySystem
from kinlab.analysis.lengths import OPTIMAL, read_length_choice
from kinlab.analysis.metrics import condition_number, singular_values
from kinlab.analysis.solver import solve
from kinlab.arrays import Array, seed_of, whole
from kinlab.errors import OptionError
from kinlab.model.dh import DHTable
from kinlab.model.robot import Robot
from kinlab.structure.task_space import TaskSpace, read_reachable_task, search_box, wrap

_SAME = 1e-5
"""Relative difference of open numbers below which two designs are one."""


@dataclass(frozen=True)
class IsotropicDesign:
    """One isotropic design.

    Attributes:
        table: the table with its open numbers filled in.
        values: open numbers by name, metres or radians.
        configurations: its isotropic configurations that the search met.
        freedom: dimension of the family of designs around it; 0 where it stands alone.
    """

    table: DHTable = field(repr=False)
    values: dict[str, float]
    configurations: tuple[IsotropicConfiguration, ...]
    freedom: int

    @property
    def q(self) -> Array:
        """The first isotropic configuration, (n,)."""
        return self.configurations[0].q

    @property
    def condition(self) -> float:
        """Condition number there, by the engine."""
        return self.configurations[0].condition

    @property
    def length(self) -> float | None:
        """Characteristic length there, metres, or ``None`` where the task needs none."""
        return self.configurations[0].length


@dataclass(frozen=True)
class DesignSearch:
    """Answer of :func:`design_isotropic`: designs, the one with the least changes first.

    Attributes:
        task: the task. suggested: kinlab chose the task.
        length: ``given``, ``optimal`` or ``none needed``.
        scale: how the size of the arm was fixed.
        designs: what was found; empty where no start became isotropic.
        best_condition: least condition number met by a start that kept limits and signs.
        seeds: starts. converged: those that ended at an accepted design. seed: of the numbers.
        evidence: what was searched, and what is proved of it.
    """

    task: str
    suggested: bool
    length: str
    scale: str
    designs: tuple[IsotropicDesign, ...]
    best_condition: float
    seeds: int
    converged: int
    seed: int
    evidence: Evidence = field(repr=False)

    def __len__(self) -> int:
        return len(self.designs)

    def __iter__(self) -> Iterator[IsotropicDesign]:
        return iter(self.designs)

    def __getitem__(self, index: int) -> IsotropicDesign:
        return self.designs[index]


def design_isotropic(
    table: DHTable,
    free: Sequence[str],
    task: Any = "auto",
    length: float | str = OPTIMAL,
    *,
    seeds: int = 300,
    seed: int = 0,
    keep: int = 20,
) -> DesignSearch:
    """Numbers of a DH table with which the arm has an isotropic configuration.

    Lengths keep the sign they have in the table (a zero may take either), and none may vanish.
    Where all lengths of the arm are open its size is arbitrary: their sum is kept.

    Args:
        table: the table; its other numbers stay.
        free: numbers to open: a column and its row (from 1), as ``"a2"``, ``"d1"``, ``"alpha3"``,
            or ``"tool.x"``, ``"tool.y"``, ``"tool.z"``.
        task: a name, a mask of six booleans, or ``"auto"``.
        length: characteristic length in metres, or ``"optimal"``: solved for along with the rest.
        seeds: random starts. seed: of the starts.
        keep: most designs returned, where they form a family.

    Returns:
        The designs, each with condition number - 1 <= 1e-8 by the engine.

    Raises:
        OptionError: a name in ``free`` that is none, a task the arm cannot do, length <= 0.
        NameUnknownError: unknown task.
    """
    seeds, keep, seed = whole(seeds, "seeds"), whole(keep, "keep"), seed_of(seed)
    if not isinstance(table, DHTable):
        raise OptionError(f"table: {type(table).__name__} is no DHTable; kl.to_dh makes one")
    chain = open_chain(table, free)
    space = read_reachable_task(Robot.from_dh(table), task)
    given = read_length_choice(length)
    system = DesignSystem(chain, space, given)
    x, _ = solve(system, system.starts(seeds, np.random.default_rng(seed)), iterations=120)
    q, values, lengths = system.split(x)
    q = wrap(space.robot, q)
    condition = condition_number(singular_values(system.matrix(x)))
    sound = system.sound(q, values)
    accepted = sound & (condition - 1.0 <= ISOTROPIC)
    designs = _designs(system, x[accepted], q[accepted], values[accepted], lengths[accepted], keep)
    how = "none needed" if not space.mixed else "optimal" if given is None else "given"
    finite = condition[sound & np.isfinite(condition)]
    return DesignSearch(
        space.name, space.suggested, how,
        "sum of the open lengths kept" if system.scalable else "set by the numbers that stay",
        designs, float(finite.min(initial=np.inf)), seeds, int(accepted.sum()), seed,
        Evidence(
            f"{seeds} starts in the open numbers and q (seed {seed})", int(accepted.sum()), seeds,
            "every listed design is isotropic to 1e-8 by the engine" if designs else "",
            "that there is no other design" if designs else "that no such design exists",
        ),
    )  # fmt: skip


def _designs(
    system: DesignSystem, x: Array, q: Array, values: Array, lengths: Array, keep: int
) -> tuple[IsotropicDesign, ...]:
    chain, units = system.chain, system.units
    angles = np.array([not o.is_length for o in chain.open])
    values = np.where(angles, np.mod(values + np.pi, 2.0 * np.pi) - np.pi, values)
    given = np.array([o.value for o in chain.open])
    order = np.argsort(np.linalg.norm((values - given) / units, axis=1), kind="stable")
    groups: list[list[int]] = []
    for i in order:
        for group in groups:
            if float(np.max(np.abs((values[i] - values[group[0]]) / units))) < _SAME:
                group.append(int(i))
                break
        else:
            groups.append([int(i)])
    designs = []
    lower, upper = search_box(system.space.robot)
    for group in groups[:keep]:
        table = chain.with_values(values[group[0]])
        robot = Robot.from_dh(table)
        space = TaskSpace(robot, system.space.rows, system.space.name, system.space.suggested)
        fixed = IsotropySystem(space, system.given)
        start = np.concatenate([q[group], np.log(lengths[group])[:, np.newaxis]], axis=1)
        solved, _ = solve(fixed, start if fixed.open_length else q[group])
        states, sizes = np.clip(wrap(robot, fixed.q(solved)), lower, upper), fixed.length(solved)
        reached = condition_number(singular_values(space.jacobian(states, sizes)))
        good = reached - 1.0 <= ISOTROPIC
        if not good.any():
            continue
        found = isotropic_families(fixed, states[good], sizes[good])
        named = {o.name: float(v) for o, v in zip(chain.open, values[group[0]], strict=True)}
        designs.append(IsotropicDesign(table, named, found, _freedom(system, x[group[0]])))
    return tuple(designs)


def _freedom(system: DesignSystem, x: Array) -> int:
    """Dimension, in the open numbers, of the solutions around x: tangent of the solution set."""
    _, slope = system(x[np.newaxis])
    _, sizes, right = np.linalg.svd(slope[0])
    n, k = system.space.robot.n, len(system.chain.open)
    tangent = right[int(np.sum(sizes > 1e-6 * sizes[0])) :, n : n + k]
    return int(np.linalg.matrix_rank(tangent, tol=1e-6)) if tangent.size else 0
