"""The edits that make a program right: one, or several together.

Each edit is tried at a few states; what is right there is tried at all of them. The work is
counted in expressions, not in seconds, so that the answer is the same on every machine.
"""

from __future__ import annotations

import ast
from collections.abc import Sequence
from contextlib import AbstractContextManager
from dataclasses import dataclass

import numpy as np

from kinlab.arrays import Array
from kinlab.check.compare import error_sizes
from kinlab.doctor.changes import Case
from kinlab.doctor.program.edits import edits
from kinlab.doctor.program.observed import Observed
from kinlab.doctor.program.places import Edit
from kinlab.doctor.program.read import read
from kinlab.doctor.program.trial import Trial, quietly
from kinlab.errors import KinlabError
from kinlab.formulas.record import state_by_state

_WORK = 2_000_000
"""Expressions that may be evaluated, and nodes compiled, for single edits."""
_NUMBERS = 4
"""Numbers of the answer at which an edit is tried first."""
_TIED = 0.06
"""Cost beyond the first repair's up to which others are looked for."""
_CLOSE = 1e-7
"""Share of the answer's size within which an edit is tried at all states."""


@dataclass(frozen=True, eq=False)
class Repair:
    """Edits that make a program right.

    Attributes:
        edits: one or several.
        error: the relative error that is left.
        cost: how far-fetched they are.
    """

    edits: tuple[Edit, ...]
    error: float
    cost: float


class Search:
    """A wrong program beside what it should answer.

    Args:
        case: the states, and the program's own answers.
        wanted: the right answers, (N, ...).
        allowed: the relative error that may be left.
    """

    def __init__(self, case: Case, wanted: Array, allowed: float) -> None:
        self.program = None if case.function is None else read(case.function)
        self.case, self.wanted, self.allowed = case, wanted, allowed
        self.sizes = error_sizes(wanted)
        self.tried: list[tuple[Edit, Array]] = []
        self.work = 0
        if self.program is None:
            return
        self.trial = Trial(self.program)
        size = int(np.prod(wanted.shape[1:], initial=1))
        self.first = list(range(max(1, -(-_NUMBERS // size))))
        states = [tuple(stack[k] for stack in case.arguments.values()) for k in self.first]
        self.observed = Observed(self.trial, states)
        self.nodes = [sum(1 for _ in ast.walk(tree)) for tree in self.trial.trees]

    def singles(self) -> list[Repair]:
        """Single edits that make the program right, the likeliest first."""
        if self.program is None:
            return []
        found: list[Repair] = []
        with quietly():
            for edit in edits(self.trial, self.observed):
                if found and edit.cost > found[0].cost + _TIED:
                    break
                self.work += self.observed.work[edit.part]
                self.work += self.nodes[edit.part] if edit.part >= 0 else 0
                if self.work > _WORK:
                    break
                repair = self._one(edit)
                if repair is not None:
                    found.append(repair)
        return found

    def _one(self, edit: Edit) -> Repair | None:
        with changed(self.trial, (edit,)):
            values = self._values(self.first)
            if values is None:
                return None
            self.tried.append((edit, values))
            if not self._close(values):
                return None
            return self._all((edit,))

    def _close(self, values: Array) -> bool:
        gap = np.abs(values - self.wanted[self.first])
        sizes = self.sizes[self.first].reshape(-1, *[1] * (gap.ndim - 1))
        return bool(np.all(gap <= max(_CLOSE, self.allowed) * sizes))

    def _values(self, which: Sequence[int]) -> Array | None:
        """The answers of the program as it stands now, None where it has none."""
        quantity, robot = self.case.quantity, self.case.robot
        asked = state_by_state(quantity.asked(robot, self.trial.function))
        stacks = [stack[list(which)] for stack in self.case.arguments.values()]
        wanted = self.wanted[list(which)]
        try:
            values = np.asarray(asked(None, *stacks), dtype=float)
            if quantity.read is not None:
                values = np.asarray(quantity.read(robot, values, wanted))
        except (KinlabError, TypeError, ValueError):
            return None
        return values if values.shape == wanted.shape else None

    def _all(self, several: tuple[Edit, ...]) -> Repair | None:
        """The repair, if the program as it stands now is right at every state."""
        values = self._values(range(len(self.wanted)))
        if values is None:
            return None
        gap = np.abs(values - self.wanted).reshape(len(values), -1).max(axis=1, initial=0.0)
        error = float(np.max(gap / self.sizes))
        if not error <= self.allowed:
            return None
        return Repair(several, error, sum(edit.cost for edit in several))


def changed(trial: Trial, several: tuple[Edit, ...]) -> AbstractContextManager[None]:
    """The program with edits in it."""
    parts = {edit.part for edit in several}
    return trial.changed(parts, [change for edit in several for change in edit.changes])
