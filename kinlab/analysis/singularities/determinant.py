"""det J in factors, each with what it means: on top of the derivation in :mod:`kinlab.symbolic`."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass, field
from typing import Any

import numpy as np
import sympy
from numpy.typing import ArrayLike

from kinlab import symbolic
from kinlab.analysis.singularities.singularity import Singularity, describe_singularity
from kinlab.analysis.solver import System, solve
from kinlab.analysis.structure.task_space import TaskSpace, mask_of, read_task, search_box, wrap
from kinlab.arrays import Array, between, seed_of
from kinlab.engine.states import joint_vector
from kinlab.errors import OptionError
from kinlab.host.evidence import Evidence
from kinlab.host.introductions import Answer, Introduction
from kinlab.model.extract import as_table
from kinlab.model.library import ArmLike, as_robot
from kinlab.model.robot import Robot
from kinlab.tolerances import TOLERANCES

_STARTS = 48
"""Starts from which a zero of each factor is sought."""

_EXAMPLES = 4
"""Zeros of a factor that are looked at to say what it means."""


@dataclass(frozen=True)
class SingularFactor:
    """One factor of det J that depends on the joints.

    Attributes:
        expression: sympy expression in q1 ... qn and the table's parameters.
        power: how often it stands in det J.
        joints: names of the joints in it.
        meaning: class of the singularities where it vanishes (``wrist``, ``shoulder``,
            ``elbow``, ``boundary``, ``interior``; joined by "/" where they differ), or
            ``never zero`` where the search found no zero at all.
        within_limits: whether a zero within the joint limits was found.
        example: a singular configuration on it, or ``None``.
        function: q (n,) to its value in SI units.
    """

    expression: Any
    power: int
    joints: tuple[str, ...]
    meaning: str
    within_limits: bool
    example: Singularity | None = field(repr=False)
    function: Callable[[ArrayLike], Array] = field(repr=False)


@dataclass(frozen=True, repr=False)
class FactoredDeterminant(Answer):
    """det J of a square task as a product.

    Attributes:
        robot: its name. task: the task. suggested: kinlab chose the task.
        expression: the whole product, a sympy expression.
        factors: the factors that can make the arm singular.
        complete: False where a block was too large to be factored.
        function: q (n,) to the value of det J in SI units.
        evidence: what is derived and what is searched.
    """

    robot: str
    task: str
    suggested: bool
    expression: Any
    factors: tuple[SingularFactor, ...]
    complete: bool
    function: Callable[[ArrayLike], Array] = field(repr=False)
    evidence: Evidence = field(repr=False)

    def introduction(self) -> Introduction:
        """The product, and what each factor means."""
        whole = "" if self.complete else "; NOT complete: a block was too large to be factored"
        rows = tuple(
            (str(one.expression), one.meaning, "yes" if one.within_limits else "no")
            for one in self.factors
        )
        return Introduction(
            f"{self.robot}, task {self.task}: det J = {self.expression}{whole}",
            (str(self.evidence),),
            ("factor", "singularity", "within limits"),
            rows,
        )

    def at(self, q: ArrayLike) -> float:
        """det J at q (n,), by the formula."""
        return float(self.function(q))

    @property
    def latex(self) -> str:
        """The product in LaTeX."""
        return symbolic.to_latex(self.expression)


def factored_determinant(
    robot: ArmLike, task: Any = "auto", *, seed: int = 0
) -> FactoredDeterminant:
    """Derives det J and says of each factor what its zeros are.

    Args:
        robot: the robot; without a DH table of its own one is extracted.
        task: a task with as many rows as the arm has joints, or ``"auto"``.
        seed: of the starts from which a zero of each factor is sought.

    Raises:
        OptionError: the task's J is not square (more or fewer joints than rows), or an arm of
            more than six joints.
        NameUnknownError: unknown task.
    """
    robot = as_robot(robot)
    space = read_task(robot, task)
    if space.m != robot.n:
        raise OptionError(
            f"robot {robot.name!r}: det J needs a square J; task {space.name} has {space.m} rows "
            f"and the arm {robot.n} joints; find_singularities serves any shape"
        )
    table = as_table(robot)
    arm = symbolic.arm(table)
    derived = symbolic.det_jacobian(arm, space.rows)
    singular = set(derived.singular_factors)
    rng = np.random.default_rng(seed_of(seed))
    factors = tuple(
        _meaning(space, arm, expression, power, rng)
        for expression, power in derived.factors
        if expression in singular
    )
    return FactoredDeterminant(
        robot.name,
        space.name,
        space.suggested,
        derived.expression,
        factors,
        derived.complete,
        symbolic.to_function(arm, derived.expression),
        Evidence(
            f"{_STARTS} starts for the zeros of each factor (seed {seed})",
            proved="det J is the product, by exact algebra on the table's numbers",
            found="what the zeros of a factor mean, from a few of them; which have none",
        ),
    )


def vanishing_factors(
    determinant: FactoredDeterminant, robot: Robot, q: ArrayLike
) -> tuple[SingularFactor, ...]:
    """The factors that are zero at q, to 1e-8 of their size in general position.

    Raises:
        StateError: q of the wrong shape or type, or not finite.
    """
    state = joint_vector(robot, q, "q")
    return tuple(
        f
        for f in determinant.factors
        if abs(float(f.function(state))) <= 1e-8 * _size(robot, f.function)
    )


def _meaning(
    space: TaskSpace, arm: Any, expression: Any, power: int, rng: np.random.Generator
) -> SingularFactor:
    robot = space.robot
    function = symbolic.to_function(arm, expression)
    gradient = symbolic.to_function(arm, sympy.Matrix([[sympy.diff(expression, q) for q in arm.q]]))
    size = _size(robot, function)
    lower, upper = search_box(robot)
    starts = rng.uniform(lower, upper, (_STARTS, robot.n))
    found, miss = solve(_as_system(function, gradient, size), starts)
    found = wrap(robot, found[miss < TOLERANCES.factor_vanishes])
    inside = between(found, lower, upper).all(axis=1)
    # zeros outside the limits show the meaning where there are none inside
    zeros = [*found[inside], *found[~inside]][:_EXAMPLES]
    examples = [describe_singularity(robot, q, mask_of(space.rows)) for q in zeros]
    meaning = "/".join(sorted({e.kind for e in examples})) or "never zero"
    names = tuple(
        name
        for name, q in zip(robot.joint_names, arm.q, strict=True)
        if q in expression.free_symbols
    )
    return SingularFactor(
        expression,
        power,
        names,
        meaning,
        bool(inside.any()),
        examples[0] if examples else None,
        function,
    )


def _as_system(
    function: Callable[[ArrayLike], Array], gradient: Callable[[ArrayLike], Array], size: float
) -> System:
    def system(x: Array) -> tuple[Array, Array]:
        values = np.array([[float(function(q)) / size] for q in x])
        gradients = np.array([gradient(q).reshape(1, -1) / size for q in x])
        return values, gradients

    return system


def _size(robot: Robot, function: Callable[[ArrayLike], Array]) -> float:
    lower, upper = search_box(robot)
    states = np.random.default_rng(0).uniform(lower, upper, (16, robot.n))
    return float(np.sqrt(np.mean([float(function(q)) ** 2 for q in states])))
