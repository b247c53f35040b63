"""A five-bar's quantity as the engine has it, at this and at other five-bars, as a reference.

It stands where a derived formula stands for an arm (:class:`kinlab.doctor.derived.Derivation`): the
right formula is a name whose values are the engine's, and what may be missing in a text are terms
of the right unit.
"""

from __future__ import annotations

from collections.abc import Collection, Mapping
from dataclasses import dataclass
from functools import cached_property, lru_cache
from typing import TYPE_CHECKING, Any

import numpy as np

from kinlab.arrays import Array
from kinlab.check.quantities.fivebar import FIVEBAR
from kinlab.check.quantities.quantity import Quantity
from kinlab.doctor.changes import Case
from kinlab.doctor.derived import Derivation, derivation_of
from kinlab.doctor.linkages import five_bar
from kinlab.doctor.solved import Solved, solved
from kinlab.fivebar import FiveBar
from kinlab.formulas import tree
from kinlab.formulas.tree import Node
from kinlab.tolerances import TOLERANCES

if TYPE_CHECKING:
    from kinlab.doctor.text.written import Written

_LINKAGES, _POSES = 8, 6
"""Other five-bars at which a text is looked at, and states of each."""
_SEED = 10
"""Of the states at which a text that is right here is asked again."""
_FEW = 12
"""States of a single other five-bar."""
_RIGHT = "q_engine"
"""The name whose values are the engine's; as a joint's, it is nobody's number."""
_SPREAD = (0.8, 1.25)
"""What the numbers of another five-bar are those of this one times."""
_MOVED = 1.09
"""What one number alone is multiplied by: the loop still closes."""


@dataclass(frozen=True, eq=False)
class LookedUp:
    """An entry of a five-bar's quantity.

    Attributes:
        linkage: the five-bar.
        quantity: the quantity.
        index: the entry.
    """

    linkage: FiveBar
    quantity: Quantity
    index: tuple[Any, ...]

    @property
    def n(self) -> int:
        """Cranks whose angles may stand in a text."""
        return 2 if self.letters(()) else 0

    @cached_property
    def parameters(self) -> tuple[str, ...]:
        """The names of the five-bar's numbers that are not zero."""
        return five_bar.parameters(self.quantity, self.linkage)

    @property
    def values(self) -> dict[str, float]:
        """What they are."""
        own = five_bar.numbers_of(self.linkage, self._leg)
        return {name: own[name] for name in self.parameters}

    @property
    def _leg(self) -> int:
        either = five_bar.is_either(self.quantity.name)
        return int(self.index[0]) if self.index and not either else 0

    @cached_property
    def loads(self) -> tuple[str, ...]:
        """The names of what moves, but the cranks."""
        return tuple(five_bar.words_of(self.quantity).states)

    @property
    def spelling(self) -> dict[str, str]:
        """How the cranks' angles and rates are written where the writer has none."""
        return {f"q{d}{i}": f"theta{d}{i}" for d in ("", "d", "dd") for i in (1, 2)}

    def letters(self, arguments: tuple[str, ...]) -> tuple[str, ...]:
        """Which of q, qd and qdd may stand in a text."""
        del arguments
        return five_bar.words_of(self.quantity).letters

    def entry(self, index: tuple[Any, ...]) -> tuple[str, ...]:
        """What stands for an entry's formula."""
        del index
        return (_RIGHT,)

    def held(self, poly: tuple[str, ...], named: Collection[str]) -> tuple[str, ...]:
        """The same: nothing of what moves is a load that may be zero."""
        del named
        return poly

    def tree(self, poly: tuple[str, ...]) -> Node:
        """The name whose values are the engine's."""
        return tree.sym(poly[0])

    def forms(self, poly: tuple[str, ...]) -> list[Node]:
        """The terms that may be missing in a text."""
        del poly
        names = (*self.parameters, *self.loads)
        moving = tuple(f"{x}{i}" for x in self.letters(())[1:] for i in (1, 2))
        return [tree.add(*five_bar.terms_of(self.quantity, (*names, *moving)))]

    def environment(self, states: Mapping[str, Array]) -> dict[str, Array]:
        """The values of every name at states of the five-bar."""
        return _environment(self, self.linkage, dict(states))

    def anywhere(self, seed: int, held: Mapping[str, float] | None = None) -> dict[str, Array]:
        """The values at states of other five-bars, some of whose numbers may be ``held``."""
        return _anywhere(self, seed, tuple(sorted((held or {}).items())))

    def another(self, seed: int) -> dict[str, Array]:
        """The values at states of one other five-bar."""
        return _of_one(self, seed)

    def but_for(self, name: str, here: Mapping[str, Array]) -> dict[str, Array]:
        """The values at states of the five-bar with one other number."""
        del here
        other = five_bar.with_numbers(self.linkage, {name: self._pair(name) * _MOVED})
        return _at_states(self, other, 1, _FEW)

    def holds(self, text: Written) -> bool:
        """Whether a text is right of other five-bars, but for whole turns of an angle."""
        at = self.anywhere(_SEED)
        gap = text.values(at) - at[_RIGHT]
        if self.quantity.name.endswith("angles"):
            gap = np.arctan2(np.sin(gap), np.cos(gap))
        scale = float(np.max(np.abs(at[_RIGHT])))
        return bool(np.max(np.abs(gap)) <= TOLERANCES.formula_agrees * scale)

    def _pair(self, name: str) -> Array:
        return np.array([five_bar.numbers_of(self.linkage, leg)[name] for leg in (0, 1)])

    @property
    def _alike(self) -> bool:
        """Whether both legs have the same numbers."""
        one, two = (five_bar.numbers_of(self.linkage, leg) for leg in (0, 1))
        return one == two

    def other(self, rng: np.random.Generator, held: Mapping[str, float]) -> FiveBar:
        """Another five-bar: the legs are alike if this one's are, and what is zero stays zero."""
        drawn: dict[str, Array] = {}
        for name in five_bar.numbers_of(self.linkage):
            share = rng.uniform(*_SPREAD, 2)
            same = self._alike or name in ("e", "m", "g")
            drawn[name] = self._pair(name) * (share[0] if same else share)
            if name in held:
                drawn[name] = self._pair(name)
        drawn["IA"] = np.maximum(drawn["IA"], 1.05 * drawn["m1"] * drawn["lc1"] ** 2)
        return five_bar.with_numbers(self.linkage, drawn)


Reference = Derivation | LookedUp | Solved
"""What texts are held against: derived formulas of an arm, its accelerations as they are solved
for, the engine's values of a five-bar."""


def reference_of(case: Case) -> Reference | None:
    """What the texts of a case are held against, or None where none is offered."""
    return looked_up(case) or derivation_of(case) or solved(case)


def looked_up(case: Case) -> LookedUp | None:
    """What a case asks of a five-bar; None of anything else."""
    if case.quantity.domain is not FIVEBAR or case.quantity.name not in five_bar.READ:
        return None
    return _looked_up(case.robot, case.quantity, tuple(case.index))


@lru_cache(maxsize=256)
def _looked_up(linkage: FiveBar, quantity: Quantity, index: tuple[Any, ...]) -> LookedUp:
    return LookedUp(linkage, quantity, index)


def _environment(of: LookedUp, linkage: FiveBar, states: dict[str, Array]) -> dict[str, Array]:
    at = five_bar.values_at(linkage, of.quantity, states, of.index)
    whole = np.asarray(of.quantity.engine(linkage, *states.values()))
    return {**at, _RIGHT: whole[(slice(None), *of.index)]}


def _at_states(of: LookedUp, linkage: FiveBar, seed: int, count: int) -> dict[str, Array]:
    quantity = of.quantity
    stacks = quantity.states(linkage, count, seed)
    return _environment(of, linkage, dict(zip(quantity.arguments, stacks, strict=True)))


@lru_cache(maxsize=256)
def _anywhere(of: LookedUp, seed: int, held: tuple[tuple[str, float], ...]) -> dict[str, Array]:
    rng = np.random.default_rng(seed)
    parts = [_at_states(of, of.other(rng, dict(held)), seed + k, _POSES) for k in range(_LINKAGES)]
    return {name: np.concatenate([part[name] for part in parts]) for name in parts[0]}


@lru_cache(maxsize=256)
def _of_one(of: LookedUp, seed: int) -> dict[str, Array]:
    linkage = of.other(np.random.default_rng(seed), {})
    return _at_states(of, linkage, seed, _FEW)
