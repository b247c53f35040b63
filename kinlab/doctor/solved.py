"""Forward dynamics of an arm as a reference: the accelerations that its equations of motion have.

It stands where a derived formula stands (:class:`kinlab.doctor.derived.Derivation`): the right
formula is the quotient that one has from the derived torques and the mass matrix, by Cramer's rule.
"""

from __future__ import annotations

from collections.abc import Collection, Mapping
from dataclasses import dataclass
from fractions import Fraction
from functools import cached_property, lru_cache
from typing import TYPE_CHECKING, Any

import numpy as np

from kinlab.arrays import Array
from kinlab.doctor.changes import Case, table_of
from kinlab.doctor.derived import Derivation, derivation
from kinlab.formulas import tree
from kinlab.formulas.tree import Node
from kinlab.model.dh import DHTable
from kinlab.tolerances import TOLERANCES

if TYPE_CHECKING:
    from kinlab.doctor.text.written import Written

_JOINTS = 2
"""Joints of an arm up to which one writes its accelerations out."""
_MINUS, _INVERSE = tree.num(-1), Fraction(-1)
_SEED = 10
"""Of the states at which a text that is right here is asked again."""


@dataclass(frozen=True, eq=False)
class Solved:
    """An acceleration of an arm.

    Attributes:
        torques, masses: its inverse dynamics and its mass matrix, derived.
        joint: whose acceleration it is, from 0.
    """

    torques: Derivation
    masses: Derivation
    joint: int

    @property
    def n(self) -> int:
        """Number of joints."""
        return self.torques.n

    @property
    def parameters(self) -> tuple[str, ...]:
        """The names of the arm's numbers."""
        return self.torques.parameters

    @property
    def values(self) -> Mapping[str, float]:
        """What they are."""
        return self.torques.values

    @property
    def loads(self) -> tuple[str, ...]:
        """The names of the torques that are given."""
        return tuple(f"tau{i + 1}" for i in range(self.n))

    @property
    def spelling(self) -> Mapping[str, str]:
        """How joints are written where the writer has none: as they are."""
        return {}

    def letters(self, arguments: tuple[str, ...]) -> tuple[str, ...]:
        """Which of q, qd and qdd may stand in a text."""
        del arguments
        return ("q", "qd")

    def entry(self, index: tuple[Any, ...]) -> tuple[str, ...]:
        """What stands for the formula."""
        del index
        return (f"qdd{self.joint + 1}",)

    def held(self, poly: tuple[str, ...], named: Collection[str]) -> tuple[str, ...]:
        """The same: a torque that is zero is given all the same."""
        del named
        return poly

    def tree(self, poly: tuple[str, ...]) -> Node:
        """The acceleration: of M qdd = tau - h."""
        del poly
        return self._right

    @cached_property
    def _right(self) -> Node:
        rest = [
            tree.add(tree.sym(load), *(tree.mul(_MINUS, term) for term in self._at_rest(i)))
            for i, load in enumerate(self.loads)
        ]
        masses = [
            [self.masses.tree(self.masses.entry((i, j))) for j in range(self.n)]
            for i in range(self.n)
        ]
        if self.n == 1:
            return tree.mul(rest[0], tree.power(masses[0][0], _INVERSE))
        k, other = self.joint, 1 - self.joint
        across = masses[0][1]
        above = tree.add(
            tree.mul(masses[other][other], rest[k]), tree.mul(_MINUS, across, rest[other])
        )
        below = tree.add(tree.mul(masses[0][0], masses[1][1]), tree.mul(_MINUS, across, across))
        return tree.mul(above, tree.power(below, _INVERSE))

    def _at_rest(self, joint: int) -> list[Node]:
        """The terms of a torque without accelerations."""
        whole = self.torques.tree(self.torques.entry((joint,)))
        moved = {f"qdd{i + 1}" for i in range(self.n)}
        return [one for one in whole.terms if not tree.names(one) & moved]

    def forms(self, poly: tuple[str, ...]) -> list[Node]:
        """The terms that may be missing in a text: those of the torques at rest and in motion."""
        del poly
        return [tree.add(*self._at_rest(self.joint))]

    def environment(self, states: Mapping[str, Array]) -> dict[str, Array]:
        """The values of every name at states of the arm."""
        at = self.torques.environment({name: states[name] for name in ("q", "v")})
        return at | dict(zip(self.loads, states["tau"].T, strict=True))

    def anywhere(self, seed: int, held: Mapping[str, float] | None = None) -> dict[str, Array]:
        """The values at random states of other arms, some of whose numbers may be ``held``."""
        return self._at_random(self.torques.anywhere(seed, held), seed)

    def another(self, seed: int) -> dict[str, Array]:
        """The values at random states of one other arm."""
        return self._at_random(self.torques.another(seed), seed)

    def but_for(self, name: str, here: Mapping[str, Array]) -> dict[str, Array]:
        """The values at states with another number for one name."""
        return self.torques.but_for(name, here)

    def holds(self, text: Written) -> bool:
        """Whether a text is right of other arms."""
        at = self.anywhere(_SEED)
        right = np.asarray(tree.evaluate(self._right, dict(at)))
        gap = np.max(np.abs(text.values(at) - right))
        return bool(gap <= TOLERANCES.formula_agrees * np.max(np.abs(right)))

    def _at_random(self, at: dict[str, Array], seed: int) -> dict[str, Array]:
        rng, size = np.random.default_rng(seed), len(at["q1"])
        return at | {name: rng.uniform(-2.0, 2.0, size) for name in self.loads}


def solved(case: Case) -> Solved | None:
    """What a case asks of an arm; None of anything but an acceleration of a short one."""
    table = table_of(case.robot)
    if case.quantity.name != "forward_dynamics" or table is None or len(case.index) > 1:
        return None
    if not case.index and table.n > 1:
        return None
    return _solved(table, int(case.index[0]) if case.index else 0)


@lru_cache(maxsize=64)
def _solved(table: DHTable, joint: int) -> Solved | None:
    if table.n > _JOINTS:
        return None
    torques, masses = (derivation(table, name) for name in ("inverse_dynamics", "mass_matrix"))
    return None if torques is None or masses is None else Solved(torques, masses, joint)
