"""Isotropy of a table with open numbers, as a system of smooth equations."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any

import numpy as np

from kinlab.analysis.derivatives import jacobian_derivative
from kinlab.analysis.design_model import OpenChain
from kinlab.analysis.isotropy_system import isotropy_equations
from kinlab.arrays import Array
from kinlab.structure.task_space import TaskSpace, search_box

_COLLAPSED = 1e-6
"""Lengths below this share of the arm's own length unit are links that vanished."""


@dataclass(frozen=True)
class DesignSystem:
    """Isotropy in q, the open numbers, and ln L where the length is open.

    Attributes:
        chain: the table with open numbers.
        space: the task of the table as it is given.
        given: characteristic length, or ``None``.
    """

    chain: OpenChain
    space: TaskSpace
    given: float | None

    @property
    def open_length(self) -> bool:
        """Whether the characteristic length is an unknown."""
        return self.given is None and self.space.mixed

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
        size = self.given if self.given is not None else 1.0
        lengths = np.full(len(x), size)
        if self.open_length:
            lengths = np.exp(np.clip(x[:, -1], -30.0, 30.0))
        return x[:, :n], x[:, n : n + k] * self.units, lengths

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
        if self.open_length:
            by_length = (-matrix * self.space.metres)[:, np.newaxis]
            derivative = np.concatenate([derivative, by_length], axis=1)
        return matrix, derivative

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
        good = np.all((q >= lower - 1e-9) & (q <= upper + 1e-9), axis=1)
        for i, entry in enumerate(self.chain.open):
            if entry.is_length and entry.value:
                good &= values[:, i] * np.sign(entry.value) > _COLLAPSED * self.space.scale
        return good
