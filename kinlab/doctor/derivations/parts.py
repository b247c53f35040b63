"""A formula taken apart by kind of term: what is right of it, what is not, one step for each.

A torque is a sum of gravity, of terms in the velocities and of terms in the accelerations. Asked
at rest, and with one motion at a time, a hand formula shows each of them alone.
"""

from __future__ import annotations

from dataclasses import dataclass, replace
from itertools import product
from typing import Any

import numpy as np

from kinlab.arrays import Array
from kinlab.check.compare import error_sizes
from kinlab.check.diagnosis import shown_entry
from kinlab.doctor.changes import Case
from kinlab.doctor.derivations.walk import Step
from kinlab.doctor.derivations.words import together
from kinlab.errors import KinlabError
from kinlab.host.language import N_, _
from kinlab.tolerances import TOLERANCES

Flags = Any
"""An array of truth values."""

_STATES = 3
_NAMED = 6
"""Entries that are named one by one."""
_TRIED = 4
"""Steps that are joined with others for one kind of term."""

REST = ""
MOVING = {
    "v": N_("the terms in the velocities"),
    "a": N_("the terms in the accelerations"),
    "tau": N_("the terms in tau"),
    "wrench": N_("the terms of the wrench"),
}
_AT_REST = {
    "lagrangian": N_("the potential energy"),
    "lagrangian_gradient": N_("the gravity terms"),
}
_GRAVITY = N_("the gravity terms")


@dataclass(frozen=True, eq=False)
class Apart:
    """A hand formula and the engine, taken apart at a few states.

    Attributes:
        names: ``REST`` and the arguments that move, as far as something depends on them.
        stacks: states at rest, then with each of these alone, one behind the other.
        hand, engine: (parts, N, ...), what each adds.
        size: (parts, N), what differences are relative to.
    """

    names: tuple[str, ...]
    stacks: dict[str, Array]
    hand: Array
    engine: Array
    size: Array

    def of(self, values: Array) -> Array:
        """Answers at ``stacks``, (..., parts * N, ...) from axis 1 on, by part: (B, parts, N, ...).

        The first part is what there is at rest; the others are what they add to it.
        """
        count = len(self.names)
        return _added(values.reshape(len(values), count, -1, *values.shape[2:]))

    def agreeing(
        self, parts: Array, wanted: Array, slack: float = TOLERANCES.formula_agrees
    ) -> Flags:
        """Which of the ways agree in which part, (B, parts)."""
        gap = np.abs(parts - wanted).reshape(*parts.shape[:3], -1)
        worst = np.max(gap, axis=3, initial=0.0) / self.size
        worst = np.where(np.isfinite(worst), worst, np.inf)
        return np.asarray(np.max(worst, axis=2) <= slack)

    @property
    def right(self) -> Flags:
        """Which parts of the hand formula are right, (parts,)."""
        return self.agreeing(self.hand[None], self.engine)[0]

    @property
    def wrong(self) -> Flags:
        """Which parts are off by more than finite differences leave, (parts,)."""
        return ~self.agreeing(self.hand[None], self.engine, TOLERANCES.nearly_agrees)[0]


def _added(values: Array) -> Array:
    """What each part adds to the first, (B, parts, ...)."""
    parts = np.array(values)
    parts[:, 1:] -= parts[:, :1]
    return parts


def apart(case: Case) -> Apart | None:
    """The case's formula by kind of term; None where it is no such sum, or cannot be asked."""
    moving = [name for name in case.arguments if name in MOVING]
    if case.again is None or "q" not in case.arguments or not moving:
        return None
    few = case.few(_STATES).arguments
    still = {name: np.zeros_like(x) if name in moving else x for name, x in few.items()}
    blocks = [still, *({**still, name: few[name]} for name in moving), few]
    stacks = {name: np.concatenate([block[name] for block in blocks]) for name in few}
    try:
        hand = np.asarray(case.again(stacks), dtype=float)
        engine = np.asarray(replace(case, arguments=stacks).answer(()), dtype=float)
    except (KinlabError, ValueError, TypeError):
        return None
    if hand.shape != engine.shape or not np.isfinite(hand).all():
        return None
    by_block = [x.reshape(len(blocks), _STATES, *x.shape[1:]) for x in (hand, engine)]
    sums = []
    for x in by_block:
        parts = _added(x[None, :-1])[0]
        rest = np.max(np.abs(x[-1] - np.sum(parts, axis=0)))
        if rest > TOLERANCES.formula_agrees * float(np.max(np.abs(by_block[1]))):
            return None
        sums.append(parts)
    live = [
        k
        for k in range(len(moving) + 1)
        if max(np.max(np.abs(parts[k])) for parts in sums) > TOLERANCES.vanishes
    ]
    if len(live) < 2 or live[0] != 0:
        return None
    kept = {name: np.concatenate([blocks[k][name] for k in live]) for name in few}
    size = np.stack([error_sizes(sums[1][k]) for k in live])
    whole = error_sizes(by_block[1][-1])
    size = np.maximum(size, TOLERANCES.formula_agrees * whole)
    names = tuple((REST, *moving)[k] for k in live)
    return Apart(names, kept, sums[0][live], sums[1][live], size)


def joined(found: Apart, values: Array, singles: list[Step]) -> list[tuple[Step, ...]]:
    """Sets of steps, one for each kind of term that is wrong, that leave the others right.

    Args:
        found: the formula, taken apart.
        values: the derivation's answers at its states, itself and with each step, (B + 1, ...).
        singles: the steps.
    """
    parts = found.of(values)
    mine = found.agreeing(parts, found.hand)
    plain = found.agreeing(parts, found.engine)
    wrong = np.flatnonzero(~found.right)
    choices: list[list[int]] = []
    for part in wrong:
        fits = [b for b in range(1, len(values)) if mine[b, part] and all(plain[b] | mine[b])]
        choices.append(sorted(fits, key=lambda b: singles[b - 1].cost)[:_TRIED])
    sets = dict.fromkeys(tuple(sorted(set(choice))) for choice in product(*choices))
    return [tuple(singles[b - 1] for b in chosen) for chosen in sets if len(chosen) > 1]


def spoils(found: Apart, values: Array) -> Flags:
    """Which ways change a kind of term that is right, (B,): no part of what is wrong."""
    still = found.agreeing(found.of(values), found.engine)
    return np.asarray(np.any(found.right & ~still, axis=1))


def proved(case: Case, engine: Array, found: Apart | None) -> tuple[str, ...]:
    """What is right of a formula that is wrong, in sentences: kinds of term, and entries."""
    said = []
    if found is not None and found.right.any() and found.wrong.any():
        at_rest = _(_AT_REST.get(case.quantity.name, _GRAVITY))
        words = [_(MOVING[name]) if name else at_rest for name in found.names]
        good = [word for word, right in zip(words, found.right, strict=True) if right]
        bad = [word for word, wrong in zip(words, found.wrong, strict=True) if wrong]
        told = _("{good}: right; {bad}: wrong")
        said.append(told.format(good=together(good), bad=together(bad)))
    entries = _entries(case, engine)
    return (*said, entries) if entries else tuple(said)


def _entries(case: Case, engine: Array) -> str:
    """The entries that are right, where some are, and not only those that are always zero."""
    hand: Any = case.hand
    if hand.shape != engine.shape or engine.ndim < 2:
        return ""
    scale = error_sizes(engine).reshape(-1, *(1,) * (engine.ndim - 1))
    gap = np.max(np.where(np.isfinite(hand), np.abs(hand - engine), np.inf) / scale, axis=0)
    live = np.max(np.abs(engine) / scale, axis=0) > TOLERANCES.no_effect
    right = live & (gap <= TOLERANCES.formula_agrees)
    if not right.any() or engine.ndim > 3:
        return ""
    if engine.ndim == 3 and not case.index:
        columns = np.any(live, axis=0) & np.all(right | ~live, axis=0)
        rows = np.any(live, axis=1) & np.all(right | ~live, axis=1)
        for whole, axis, one, many in (
            (columns, 1, N_("column {list}: right"), N_("columns {list}: right")),
            (rows, 0, N_("row {list}: right"), N_("rows {list}: right")),
        ):
            inside = np.take(right, np.flatnonzero(whole), axis=axis)
            if inside.any() and inside.sum() == right.sum():
                names = [str(int(k) + 1) for k in np.flatnonzero(whole)]
                return _(one if len(names) == 1 else many).format(list=together(names))
    places = np.argwhere(right)
    if case.index or len(places) > _NAMED:
        said = _("{right} of {all} entries: right")
        return said.format(right=len(places), all=int(live.sum()))
    name = case.quantity.name
    names = [shown_entry(f"{name}[{','.join(map(str, place.tolist()))}]") for place in places]
    return _("{list}: right").format(list=together(names))
