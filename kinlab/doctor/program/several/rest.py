"""A wrong program asked where parts of its answer are silent: at rest, with one motion alone.

Two slips that both change an answer in motion may show one at a time there: gravity alone, the
terms in the accelerations alone.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace

import numpy as np

from kinlab.arrays import Array
from kinlab.doctor.changes import ANY_ZERO
from kinlab.doctor.derivations.parts import MOVING
from kinlab.doctor.program.places import ProgramEdit
from kinlab.doctor.program.search.repair import LineSearch
from kinlab.doctor.program.several.effects import Effects
from kinlab.doctor.program.trial import NoProgramError
from kinlab.doctor.program.variants import Variants
from kinlab.errors import KinlabError
from kinlab.tolerances import TOLERANCES

_POSES = 3
"""States at rest of what has any zero."""


class AtRest:
    """Where a search is asked once more, at states of one argument alone.

    Args:
        search: whose program is wrong.
    """

    def __init__(self, search: LineSearch) -> None:
        self.asked, self.work = search.asked, search.work
        self.own: Array | None = None
        case = search.case
        any_zero = case.quantity.name in ANY_ZERO
        stacks = _at_rest(case.arguments) if any_zero else _states(case.arguments)
        if case.quantity.read is not None or not stacks:
            return
        try:
            with np.errstate(all="ignore"):
                wanted = np.asarray(replace(case, arguments=stacks).answer(()), dtype=float)
        except (KinlabError, np.linalg.LinAlgError, ValueError):
            return
        self.asked = search.asked.at(replace(case, arguments=stacks), wanted)
        self.differences = any(name in MOVING for name in stacks) and not any_zero
        self.goal = self._parts(wanted)
        size = np.abs(self.goal).max(axis=tuple(range(1, wanted.ndim)), keepdims=True)
        self.scale = np.maximum(size, max(float(np.max(size)) * TOLERANCES.formula_agrees, 1e-300))
        if np.isfinite(wanted).all() and (values := self._values()) is not None:
            self.own = values

    def _parts(self, values: Array) -> Array:
        """What there is at rest, and what each motion adds; or what there is at each state."""
        parts = np.array(values)
        if self.differences:
            parts[1:] -= parts[0]
        return parts

    def _values(self) -> Array | None:
        values = self.asked.values(self.asked.first)
        if values is None or not np.isfinite(values).all():
            return None
        parts: Array = self._parts(values) / self.scale
        return parts

    def effects(self, known: Effects, most: int) -> Effects | None:
        """The effects of the likeliest edits there, as many as so much work allows."""
        if self.own is None:
            return None
        alike: list[list[ProgramEdit]] = []
        rows: list[Array] = []
        trial = self.asked.trial
        variants = Variants(trial, [edits[0] for edits in known.alike])
        for edits in known.alike:
            edit = edits[0]
            most -= self.work.of(edit)
            if most < 0:
                break
            try:
                with trial.changed({edit.part}, edit.changes, variants.of(edit)):
                    values = self._values()
            except NoProgramError:
                continue
            if values is not None:
                alike.append(edits)
                rows.append((values - self.own).ravel())
        goal = (self.goal / self.scale - self.own).ravel()
        own = self.own.ravel()
        return Effects(
            alike, np.array(rows).reshape(len(rows), own.size), own, goal, known.near, known.likely
        )

    def making_right(self, there: Effects) -> list[ProgramEdit]:
        """The edits with which the answer is right at rest, or what a motion alone adds to it.

        Those that make most of these right come first.

        Args:
            there: the effects of edits there.
        """
        blocks = len(self.goal)
        wrong = there.wrong.reshape(blocks, -1).any(axis=1)
        right = there.right.reshape(len(there.alike), blocks, -1).all(axis=2)
        gains = (right & wrong).sum(axis=1) * (right | wrong).all(axis=1)
        some = np.flatnonzero(gains)
        return [there.alike[k][0] for k in some[np.lexsort((there.costs[some], -gains[some]))]]


def moving_alone(arguments: dict[str, Array], some: Sequence[str]) -> dict[str, Array]:
    """The same states where of all that moves, or pushes, there are some arguments alone."""
    return {
        name: np.zeros_like(x) if name in MOVING and name not in some else x
        for name, x in arguments.items()
    }


def _at_rest(arguments: dict[str, Array]) -> dict[str, Array]:
    """A few states at rest, of what has any zero: one alone tells nothing of it."""
    if not any(name in MOVING for name in arguments):
        return _states(arguments)
    return moving_alone({name: stack[:_POSES] for name, stack in arguments.items()}, [])


def _states(arguments: dict[str, Array]) -> dict[str, Array]:
    """The first state at rest, and with each of its motions alone; without motions other poses."""
    moving = [name for name in arguments if name in MOVING]
    here = {name: stack[:1] for name, stack in arguments.items()}
    if moving:
        blocks = [moving_alone(here, some) for some in ([], *([name] for name in moving))]
        return {name: np.concatenate([block[name] for block in blocks]) for name in here}
    if [*arguments] != ["q"] or here["q"].ndim != 2:
        return {}
    q = here["q"]
    one = np.zeros_like(q)
    one[:, 0] = q[:, 0]
    return {"q": np.concatenate([np.zeros_like(q), one])}
