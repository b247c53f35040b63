"""What a hand formula can be compared with: a quantity of a kind of mechanism.

A new kind of mechanism is a :class:`Domain`; a new engine answer is a :class:`Quantity` in the
``QUANTITIES`` of a module named in :mod:`kinlab.check.quantities.registry`.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from functools import lru_cache
from typing import Any

import numpy as np

from kinlab.arrays import Array, frozen
from kinlab.errors import StructureError

Sampler = Callable[[Any, tuple[str, ...], int, np.random.Generator], tuple[Array, ...]]


@dataclass(frozen=True)
class Domain:
    """A kind of mechanism: how to get one, describe it in plain numbers, and draw its states.

    Attributes:
        name: ``"serial"``, ...
        load: from a name, a path or the mechanism itself, to the mechanism.
        label: what to call it in a table.
        numbers: the plain record that catalogue functions get as their first argument.
        members: the mechanisms that a group name such as ``"serial"`` stands for; any other
            name stands for itself.
        sample: draws ``count`` random states: (mechanism, argument names, count, generator) to
            one stack per argument.
        draws: arguments that every state is drawn with, whichever of them are asked for; these
            are drawn once for all quantities.
    """

    name: str
    load: Callable[[Any], Any]
    label: Callable[[Any], str]
    numbers: Callable[[Any], Any]
    members: Callable[[str], tuple[str, ...]]
    sample: Sampler
    draws: tuple[str, ...] = ()

    def quantity(
        self, name: str, arguments: str, engine: Callable[..., Any], about: str, **more: Any
    ) -> Quantity:
        """A quantity of this kind of mechanism; the arguments in one text, ``"q v a"``."""
        return Quantity(name, tuple(arguments.split()), engine, about, self, **more)


@dataclass(frozen=True)
class Quantity:
    """One thing that the engine computes.

    Attributes:
        name: how formulas name it.
        arguments: names of what it depends on, in order; a user's function is called with them.
        engine: ``engine(mechanism, *stacks)`` gives a stack of answers.
        about: shape, unit and frame, in one line.
        domain: the kind of mechanism.
        scale: its natural size where it is zero by nature, such as 1 for a share; errors are
            measured against this at least.
        joints: how many joints the mechanism must have, where not any number will do.
        sample: draws the states where the domain's own way does not serve (singular poses, ...).
        read: how a hand formula's answers become what is compared, where they are not that
            themselves: (mechanism, answers, engine's answers) to the shape of these.
        asks: how a user's function is asked where not as it is: (mechanism, function) to one
            whose answers ``read`` takes.
    """

    name: str
    arguments: tuple[str, ...]
    engine: Callable[..., Any]
    about: str
    domain: Domain
    sample: Sampler | None = None
    scale: float = 0.0
    joints: int | None = None
    read: Callable[[Any, Any, Array], Any] | None = None
    asks: Callable[[Any, Callable[..., Any]], Callable[..., Any]] | None = None

    def states(self, mechanism: Any, samples: int, seed: int) -> tuple[Array, ...]:
        """Draws random states; the same seed gives the same ones, bit for bit.

        Raises:
            StructureError: the mechanism has another number of joints than the quantity needs.
        """
        if self.joints is not None and mechanism.n != self.joints:
            raise StructureError(
                f"quantity {self.name!r} is for {self.joints} joints; "
                f"{self.domain.label(mechanism)!r} has {mechanism.n}"
            )
        draw, drawn = self.sample or self.domain.sample, self.arguments
        if self.sample is None and set(drawn) <= set(self.domain.draws):
            drawn = self.domain.draws
        stacks = dict(zip(drawn, _drawn(draw, mechanism, drawn, samples, seed), strict=True))
        return tuple(stacks[name] for name in self.arguments)

    def asked(self, mechanism: Any, function: Callable[..., Any]) -> Callable[..., Any]:
        """A user's function as it is asked, one state at a time."""
        return function if self.asks is None else self.asks(mechanism, function)

    def answers(self, mechanism: Any, samples: int, seed: int) -> Array:
        """The engine's answers at :meth:`states`, (samples, ...)."""
        return _answered(self, mechanism, samples, seed)


# Rows of the catalogue share states and answers (a printed and a corrected form, formulas of one
# quantity); closing a five-bar's loop at random takes longer than any formula.


@lru_cache(maxsize=256)
def _drawn(
    draw: Sampler, mechanism: Any, arguments: tuple[str, ...], samples: int, seed: int
) -> tuple[Array, ...]:
    stacks = draw(mechanism, arguments, samples, np.random.default_rng(seed))
    return tuple(frozen(stack) for stack in stacks)


@lru_cache(maxsize=128)
def _answered(quantity: Quantity, mechanism: Any, samples: int, seed: int) -> Array:
    states = quantity.states(mechanism, samples, seed)
    return frozen(np.asarray(quantity.engine(mechanism, *states)))
