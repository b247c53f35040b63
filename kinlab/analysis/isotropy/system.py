"""Isotropy as a system of smooth equations, and the length that may be one of its unknowns."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from kinlab.analysis.solver import jacobian_derivative
from kinlab.analysis.structure.task_space import TaskSpace
from kinlab.arrays import Array
from kinlab.engine.fast.stacks import jacobian


@dataclass(frozen=True)
class LengthChoice:
    """A task with its characteristic length, which may be one more unknown: ln L behind the others.

    Attributes:
        space: the task.
        given: characteristic length in metres, or ``None``.
    """

    space: TaskSpace
    given: float | None

    @property
    def open_length(self) -> bool:
        """Whether the length is an unknown."""
        return self.given is None and self.space.mixed

    @property
    def how(self) -> str:
        """``none needed``, ``optimal`` or ``given``."""
        return (
            "none needed" if not self.space.mixed else "optimal" if self.given is None else "given"
        )

    def start(self, q: Array) -> Array:
        """Unknowns at q (N, n)."""
        if not self.open_length:
            return q
        return np.concatenate([q, np.full((len(q), 1), np.log(self.space.scale))], axis=1)

    def length(self, x: Array) -> Array:
        """The lengths, (N,)."""
        if self.open_length:
            # the span only stops a runaway start from overflowing
            return np.exp(np.clip(x[:, -1], -30.0, 30.0))
        return np.full(len(x), self.given if self.given is not None else 1.0)

    def with_length(self, change: Array, matrix: Array) -> Array:
        """Derivatives (N, k, m, n) of task Jacobians, and that by ln L where it is open."""
        if not self.open_length:
            return change
        return np.concatenate([change, (-matrix * self.space.metres)[:, np.newaxis]], axis=1)


@dataclass(frozen=True)
class IsotropySystem(LengthChoice):
    """J J^T / (trace / m) - 1 = 0 in q, and in ln L where the length is open."""

    def q(self, x: Array) -> Array:
        """The joint part of the unknowns, (N, n)."""
        return x[:, : self.space.robot.n]

    def __call__(self, x: Array) -> tuple[Array, Array]:
        """Residuals (N, p) and derivatives (N, p, k)."""
        space = self.space
        full, sizes = jacobian(space.robot, self.q(x)), self.length(x)
        matrix = space.select(full, sizes)
        change = space.select(jacobian_derivative(full), sizes[:, np.newaxis])
        return isotropy_equations(matrix, self.with_length(change, matrix))


def isotropy_equations(matrix: Array, change: Array) -> tuple[Array, Array]:
    """The upper triangle of J J^T / (trace / m) - 1, and its derivative.

    Args:
        matrix: task Jacobians, (N, m, n).
        change: their derivatives, (N, k, m, n).

    Returns:
        (N, p) and (N, p, k), p = m (m + 1) / 2.
    """
    m = matrix.shape[1]
    gram = matrix @ matrix.swapaxes(1, 2)
    mean = np.trace(gram, axis1=1, axis2=2)[:, np.newaxis, np.newaxis] / m
    half = change @ matrix.swapaxes(1, 2)[:, np.newaxis]
    gram_change = half + half.swapaxes(2, 3)
    mean_change = np.trace(gram_change, axis1=2, axis2=3)[..., np.newaxis, np.newaxis] / m
    upper = np.triu_indices(m)
    residual = (gram / mean - np.eye(m))[:, upper[0], upper[1]]
    slope = gram_change / mean[:, np.newaxis]
    slope = slope - gram[:, np.newaxis] * mean_change / mean[:, np.newaxis] ** 2
    return residual, slope[:, :, upper[0], upper[1]].swapaxes(1, 2)
