"""The characteristic length of a mixed task: the one that makes J best conditioned at a q.

Angeles, *Fundamentals of Robotic Mechanical Systems*, section 5.8, and Ranjbaran, Angeles &
Gonzalez-Palacios, "The mechanical design of a seven-axes manipulator with kinematic isotropy"
(JIRS 14, 1995): the characteristic length is the L that minimises the condition number of J with
its entries in metres divided by L.
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any

import numpy as np
from numpy.typing import ArrayLike

from kinlab.analysis.metrics import singular_values
from kinlab.analysis.structure.task_space import TaskSpace, one_state, read_length, read_task
from kinlab.arrays import Array
from kinlab.errors import NameUnknownError, OptionError
from kinlab.model.library import ArmLike, as_robot

OPTIMAL = "optimal"
"""In place of a number of metres: the length that minimises the condition number."""

_DECADES = 3.0
"""The search spans the arm's own length unit times 10^-3 to 10^3."""


@dataclass(frozen=True)
class CharacteristicLength:
    """Answer of :func:`characteristic_length`.

    Attributes:
        length: metres, or ``None`` where the condition number depends on no length.
        condition: condition number of J at that length; infinity where J has a singular value 0.
        task: name of the task.
        how: ``given``, ``optimal`` or ``none needed``.
    """

    length: float | None
    condition: float
    task: str
    how: str


def characteristic_length(
    robot: ArmLike, q: ArrayLike, task: Any = "auto", length: float | str = OPTIMAL
) -> CharacteristicLength:
    """The length that minimises the condition number at q, or the effect of a given one.

    It is looked for from 1/1000 to 1000 times the arm's own length unit. There is one minimum:
    log kappa is convex in log L (norms of D1 J D2 and its inverse, by Hadamard's three lines).

    Args:
        robot: the robot.
        q: joint positions, (n,).
        task: as in :func:`kinlab.manipulability`, or ``"auto"``.
        length: metres, or ``"optimal"``.

    Raises:
        StateError, NameUnknownError, OptionError: bad q, unknown task, length <= 0, or a
            singular q, at which every length is as bad as any other.
    """
    robot = as_robot(robot)
    space = read_task(robot, task)
    state = one_state(robot, q)
    given = read_length_choice(length)
    if not space.mixed:
        return CharacteristicLength(None, _condition(space, state, 1.0), space.name, "none needed")
    if given is not None:
        return CharacteristicLength(given, _condition(space, state, given), space.name, "given")
    values = singular_values(space.jacobian(state, space.scale))
    if values[-1] <= 1e-10 * values[0]:
        raise OptionError(
            f"robot {robot.name!r}: q is singular for task {space.name}; every length gives an "
            "infinite condition number"
        )
    best = best_length(space, state)
    return CharacteristicLength(best, _condition(space, state, best), space.name, "optimal")


def best_length(space: TaskSpace, q: Array) -> float:
    """The minimiser of the condition number over L: log kappa is scanned, then bracketed."""
    from scipy.optimize import minimize_scalar  # `import kinlab` does not wait for scipy

    exponents = np.linspace(-_DECADES, _DECADES, 121)

    def cost(exponent: float) -> float:
        return float(np.log(_condition(space, q, space.scale * 10.0**exponent)))

    at = int(np.argmin([cost(float(e)) for e in exponents]))
    around = exponents[max(at - 1, 0)], exponents[min(at + 1, len(exponents) - 1)]
    found = minimize_scalar(cost, bounds=around, method="bounded", options={"xatol": 1e-12})
    return float(space.scale * 10.0**found.x)


def read_length_choice(length: Any) -> float | None:
    """A number of metres, or ``None`` for ``"optimal"``.

    Raises:
        NameUnknownError: another word. OptionError: not a number above zero.
    """
    if isinstance(length, str):
        if length != OPTIMAL:
            raise NameUnknownError(f'length {length!r} is unknown; give metres or "{OPTIMAL}"')
        return None
    return read_length(length)


def _condition(space: TaskSpace, q: Array, length: float) -> float:
    sigma = singular_values(space.jacobian(q, length))
    return float(sigma[0] / sigma[-1]) if sigma[-1] > 0.0 else float("inf")
