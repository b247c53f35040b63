"""What a hand formula can be compared with: a quantity of a kind of mechanism.

A new kind of mechanism is a :class:`Domain`; a new engine answer is a :class:`Quantity` in the
``QUANTITIES`` of a module named in :mod:`kinlab.check.quantities`.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from typing import Any

import numpy as np

from kinlab.arrays import Array

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
    """

    name: str
    load: Callable[[Any], Any]
    label: Callable[[Any], str]
    numbers: Callable[[Any], Any]
    members: Callable[[str], tuple[str, ...]]
    sample: Sampler


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
        sample: draws the states where the domain's own way does not serve (singular poses, ...).
    """

    name: str
    arguments: tuple[str, ...]
    engine: Callable[..., Any]
    about: str
    domain: Domain
    sample: Sampler | None = None
    scale: float = 0.0

    def states(self, mechanism: Any, samples: int, seed: int) -> tuple[Array, ...]:
        """Draws random states; the same seed gives the same ones, bit for bit."""
        draw = self.sample or self.domain.sample
        return draw(mechanism, self.arguments, samples, np.random.default_rng(seed))
