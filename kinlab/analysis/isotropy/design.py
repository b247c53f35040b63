"""Link lengths and twists that make an arm isotropic, solved together with the configuration.

Isotropy of a table with open numbers, as a system of smooth equations.
"""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from dataclasses import dataclass, field
from typing import Any

import numpy as np

from kinlab.analysis.characteristic_length import OPTIMAL, read_length_choice
from kinlab.analysis.isotropy.configurations import IsotropicConfiguration, isotropic_families
from kinlab.analysis.isotropy.design_model import OpenChain, open_chain
from kinlab.analysis.isotropy.system import IsotropySystem, LengthChoice, isotropy_equations
from kinlab.analysis.metrics import condition_number, singular_values
from kinlab.analysis.solver import jacobian_derivative, solve
from kinlab.analysis.structure.task_space import TaskSpace, read_reachable_task, search_box, wrap
from kinlab.arrays import Array, between, seed_of, whole
from kinlab.host.evidence import Evidence
from kinlab.host.introductions import Answer, Introduction, counted, vector
from kinlab.host.progress import takes_long
from kinlab.model.dh import DHTable
from kinlab.model.extract import as_table
from kinlab.model.library import ArmLike
from kinlab.model.robot import Robot
from kinlab.tolerances import TOLERANCES


@dataclass(frozen=True, repr=False)
class IsotropicDesign(Answer):
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

    def introduction(self) -> Introduction:
        """Its numbers, and where it is isotropic."""
        numbers = ", ".join(f"{name} = {value:.6g}" for name, value in self.values.items())
        alone = "stands alone" if not self.freedom else f"one of a {self.freedom}-parameter family"
        rows = tuple((vector(one.q, 6), f"{one.condition:.9g}") for one in self.configurations)
        return Introduction(
            f"isotropic design: {numbers}", (alone,), ("q", "condition number"), rows
        )

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


@dataclass(frozen=True, repr=False)
class DesignSearch(Answer):
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

    def introduction(self) -> Introduction:
        """How many designs there are, and their values."""
        count = counted(len(self.designs), "isotropic design")
        told = f"{count}, task {self.task}"
        if not self.designs:
            told += f" found; least condition number met: {self.best_condition:.6g}"
        rows = tuple(
            (", ".join(f"{name} = {value:.6g}" for name, value in one.values.items()),)
            for one in self.designs
        )
        return Introduction(told, (str(self.evidence),), ("values",) if rows else (), rows)

    def __len__(self) -> int:
        return len(self.designs)

    def __iter__(self) -> Iterator[IsotropicDesign]:
        return iter(self.designs)

    def __getitem__(self, index: int) -> IsotropicDesign:
        return self.designs[index]


@takes_long("isotropic designs")
def design_isotropic(
    table: ArmLike,
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
        table: the DH table, or an arm whose table is meant; its other numbers stay.
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
    table = as_table(table)
    chain = open_chain(table, free)
    space = read_reachable_task(Robot.from_dh(table), task)
    given = read_length_choice(length)
    system = DesignSystem(space, given, chain)
    x, _ = solve(system, system.starts(seeds, np.random.default_rng(seed)), iterations=120)
    q, values, lengths = system.split(x)
    q = wrap(space.robot, q)
    condition = condition_number(singular_values(system.matrix(x)))
    sound = system.sound(q, values)
    accepted = sound & (condition - 1.0 <= TOLERANCES.isotropic)
    designs = _designs(system, x[accepted], q[accepted], values[accepted], lengths[accepted], keep)
    finite = condition[sound & np.isfinite(condition)]
    return DesignSearch(
        space.name,
        space.suggested,
        system.how,
        "sum of the open lengths kept" if system.scalable else "set by the numbers that stay",
        designs,
        float(finite.min(initial=np.inf)),
        seeds,
        int(accepted.sum()),
        seed,
        Evidence(
            f"{seeds} starts in the open numbers and q (seed {seed})",
            int(accepted.sum()),
            seeds,
            "every listed design is isotropic to 1e-8 by the engine" if designs else "",
            "that there is no other design" if designs else "that no such design exists",
        ),
    )


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
            apart = float(np.max(np.abs((values[i] - values[group[0]]) / units)))
            if apart < TOLERANCES.same_design:
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
        good = reached - 1.0 <= TOLERANCES.isotropic
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


@dataclass(frozen=True)
class DesignSystem(LengthChoice):
    """Isotropy in q, the open numbers, and ln L where the length is open.

    Attributes:
        space: the task of the table as it is given.
        given: characteristic length, or ``None``.
        chain: the table with open numbers.
    """

    chain: OpenChain

    @property
    def units(self) -> Array:
        """Unit of each open number, so that the unknowns are of order one, (k,)."""
        return np.array([self.space.scale if o.is_length else 1.0 for o in self.chain.open])

    @property
    def scalable(self) -> bool:
        """Whether the whole arm may grow without a change: every length of it is open."""
        table = self.chain.table
        opened = {(o.row, o.column) for o in self.chain.open}
        fixed = [
            value
            for i, link in enumerate(table.links)
            for column, value in (("a", link.a), ("d", link.d))
            if (i, column) not in opened and not (column == "d" and link.joint == "prismatic")
        ]
        tool = np.asarray(table.tool)[:3, 3]
        fixed += [tool[i] for i, name in enumerate("xyz") if (None, name) not in opened]
        slides = any(link.joint == "prismatic" for link in table.links)
        metric = self.space.mixed and self.given is not None
        return not any(fixed) and not slides and not metric and self._total > 0.0

    @property
    def _total(self) -> float:
        return sum(abs(o.value) for o in self.chain.open if o.is_length)

    def starts(self, count: int, rng: np.random.Generator) -> Array:
        """The table as it is with random q, then random numbers too, (count, k)."""
        robot = self.space.robot
        q = rng.uniform(*search_box(robot), (count, robot.n))
        parts = [q]
        for entry, unit in zip(self.chain.open, self.units, strict=True):
            if entry.is_length:
                sign = np.sign(entry.value) if entry.value else rng.choice([-1.0, 1.0], count)
                drawn = sign * rng.uniform(0.1, 3.0, count)
            else:
                drawn = rng.uniform(-np.pi, np.pi, count)
            drawn[: count // 10] = entry.value / unit
            parts.append(drawn[:, np.newaxis])
        if self.open_length:
            parts.append(rng.uniform(-1.0, 1.0, (count, 1)) + np.log(self.space.scale))
        return np.concatenate(parts, axis=1)

    def split(self, x: Array) -> tuple[Array, Array, Array]:
        """q (N, n), open numbers in SI (N, k), lengths (N,)."""
        n, k = self.space.robot.n, len(self.chain.open)
        return x[:, :n], x[:, n : n + k] * self.units, self.length(x)

    def matrix(self, x: Array) -> Array:
        """The task's J, (N, m, n)."""
        return self._matrix(x)[0]

    def _matrix(self, x: Array) -> tuple[Array, Array]:
        n = self.space.robot.n
        q, values, lengths = self.split(x)
        full = self.chain.jacobian(np.concatenate([q, values], axis=1))
        order = self.chain.order
        driven = [order.index(i) for i in range(n)]
        variables = [order.index(i) for i in range(n + len(self.chain.open))]
        change = jacobian_derivative(full)[:, variables][..., driven]
        matrix = self.space.select(full[..., driven], lengths)
        derivative = self.space.select(change, lengths[:, np.newaxis])
        derivative[:, n:] *= self.units[:, np.newaxis, np.newaxis]
        return matrix, self.with_length(derivative, matrix)

    def __call__(self, x: Array) -> tuple[Array, Array]:
        """Residuals (N, p) and derivatives (N, p, unknowns)."""
        residual, slope = isotropy_equations(*self._matrix(x))
        if not self.scalable:
            return residual, slope
        n = self.space.robot.n
        _, values, _ = self.split(x)
        lengths = np.array([o.is_length for o in self.chain.open])
        excess = np.abs(values[:, lengths]).sum(axis=1) / self._total - 1.0
        row = np.zeros((len(x), 1, x.shape[1]))
        row[:, 0, n : n + len(lengths)] = np.sign(values) * lengths * self.units / self._total
        return (
            np.concatenate([residual, excess[:, np.newaxis]], axis=1),
            np.concatenate([slope, row], axis=1),
        )

    def sound(self, q: Array, values: Array) -> Any:
        """Which solutions (N,) keep limits and signs, with no vanished link."""
        lower, upper = search_box(self.space.robot)
        good = between(q, lower, upper, TOLERANCES.limit_digits).all(axis=1)
        for i, entry in enumerate(self.chain.open):
            if entry.is_length and entry.value:
                length = values[:, i] * np.sign(entry.value)
                good &= length > TOLERANCES.vanished_length * self.space.scale
        return good
