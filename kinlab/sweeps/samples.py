"""Where the states of a sweep come from: a seeded box, or an array that is given."""

from __future__ import annotations

import hashlib
from dataclasses import dataclass
from typing import Any, Protocol

import numpy as np
from numpy.typing import ArrayLike

from kinlab.arrays import Array, real_array
from kinlab.errors import OptionError

BLOCK = 4096
"""States in one block. Part of what a seed means: changing it changes every sweep."""


class Samples(Protocol):
    """States in blocks of :data:`BLOCK`, the last one shorter."""

    @property
    def count(self) -> int:
        """How many states."""

    def block(self, index: int) -> Array:
        """The states of one block, (at most BLOCK, n)."""

    def portion(self, first: int, last: int) -> Samples:
        """What a worker needs for blocks first to last - 1, under the same indices."""

    def fingerprint(self) -> dict[str, Any]:
        """What must be equal for two sweeps to be the same, as plain JSON values."""


@dataclass(frozen=True, eq=False)
class Box:
    """Uniform states between two corners; block i draws from its own stream of the seed.

    Attributes:
        lower, upper: corners, (n,).
        count: how many states.
        seed: not negative.
    """

    lower: Array
    upper: Array
    count: int
    seed: int

    def block(self, index: int) -> Array:
        """See :class:`Samples`."""
        stream = np.random.SeedSequence(self.seed, spawn_key=(index,))
        rows = min(BLOCK, self.count - index * BLOCK)
        return np.random.default_rng(stream).uniform(
            self.lower, self.upper, (rows, len(self.lower))
        )

    def portion(self, first: int, last: int) -> Box:
        """The box itself: it is small."""
        return self

    def fingerprint(self) -> dict[str, Any]:
        """See :class:`Samples`."""
        corners = {"lower": self.lower.tolist(), "upper": self.upper.tolist()}
        return {"samples": self.count, "seed": self.seed, **corners}


@dataclass(frozen=True, eq=False)
class Given:
    """States that the caller gives, such as a grid.

    Attributes:
        states: (N, n).
        offset: index of the first block in it.
    """

    states: Array
    offset: int = 0

    @property
    def count(self) -> int:
        """How many states."""
        return len(self.states)

    def block(self, index: int) -> Array:
        """See :class:`Samples`; a copy, so that a measure may write into it."""
        first = (index - self.offset) * BLOCK
        return self.states[first : first + BLOCK].copy()

    def portion(self, first: int, last: int) -> Given:
        """Only the rows of these blocks."""
        rows = slice((first - self.offset) * BLOCK, (last - self.offset) * BLOCK)
        return Given(self.states[rows], first)

    def fingerprint(self) -> dict[str, Any]:
        """See :class:`Samples`."""
        digest = hashlib.sha256(np.ascontiguousarray(self.states).tobytes()).hexdigest()
        return {"samples": self.count, "states": digest}


def read_samples(
    subject: Any,
    samples: int | ArrayLike,
    seed: int,
    lower: ArrayLike | None,
    upper: ArrayLike | None,
) -> Samples:
    """Reads what :func:`kinlab.sweep` was given.

    Args:
        subject: whose ``lower`` and ``upper`` hold where none are given.
        samples: how many to draw, or the states (N, n).
        seed: of the drawing.
        lower, upper: corners of the box, (n,).

    Raises:
        OptionError: no states, a bad number, seed or box.
    """
    if isinstance(samples, (int, np.integer)) and not isinstance(samples, bool):
        if samples < 1:
            raise OptionError(f"sweep: samples is {samples}; at least 1")
        if isinstance(seed, bool) or not isinstance(seed, (int, np.integer)) or seed < 0:
            raise OptionError(f"sweep: seed is {seed!r}; it must be a whole number >= 0")
        corners = _box(subject, lower, upper)
        return Box(*corners, count=int(samples), seed=int(seed))
    states = real_array(samples, "sweep: samples", OptionError)
    if states.ndim != 2 or not len(states):
        raise OptionError(
            f"sweep: samples has shape {states.shape}; give a whole number, or states (N, n)"
        )
    if lower is not None or upper is not None:
        raise OptionError("sweep: lower and upper are for drawn samples; the states are given")
    return Given(states)


def _box(subject: Any, lower: ArrayLike | None, upper: ArrayLike | None) -> tuple[Array, Array]:
    corners = []
    for name, value in (("lower", lower), ("upper", upper)):
        value = getattr(subject, name, None) if value is None else value
        if value is None:
            raise OptionError(
                f"sweep: {type(subject).__name__} has no limits of its own; give {name}="
            )
        corner = real_array(value, f"sweep: {name}", OptionError)
        if corner.ndim != 1:
            raise OptionError(f"sweep: {name} has shape {corner.shape}; expected (n,)")
        corners.append(corner)
    if corners[0].shape != corners[1].shape:
        shapes = " and ".join(str(c.shape) for c in corners)
        raise OptionError(f"sweep: lower and upper have shapes {shapes}")
    if np.any(corners[0] > corners[1]):
        place = int(np.argmax(corners[0] > corners[1]))
        raise OptionError(
            f"sweep: lower[{place}] {corners[0][place]:g} is above upper {corners[1][place]:g}"
        )
    return corners[0], corners[1]
