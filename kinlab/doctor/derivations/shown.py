"""Whether a program computes what a derivation does where a step of it is taken otherwise.

A step explains an answer; that the program goes that way at all is another matter: torques that are
written out have no force of a link, though leaving one out may give the same numbers.
"""

from __future__ import annotations

import ast
from collections.abc import Iterable
from typing import Any

import numpy as np

from kinlab.arrays import Array
from kinlab.doctor.bytecode.syntax import nodes
from kinlab.doctor.changes import Case
from kinlab.doctor.derivations.joined import Found
from kinlab.doctor.derivations.walk import Rows, Step, Walk
from kinlab.tolerances import TOLERANCES


def shown(found: Found, case: Case, numbers: Array) -> bool:
    """Whether, for each step, the numbers of its line are among those that a program came to.

    Args:
        found: what explains the program's answer.
        case: the states.
        numbers: those that the program came to at the first state, sorted.
    """
    first = case.few(1)
    given, answer = _telling([*first.arguments.values()]), _telling([first.hand])
    _values, plain = found.road.walked([()], case.few(_STATES).arguments)
    told = (_Told(plain, found.steps, step) for step in found.steps)
    return all(one.among(numbers, given, answer) for one in told)


_STATES = 2
"""States at which a derivation is walked: numbers that are the same at both are the arm's own."""


class _Told(Walk):
    """A walk that keeps the numbers of the lines in which a step is taken otherwise."""

    def __init__(self, plain: Walk, way: tuple[Step, ...], step: Step) -> None:
        super().__init__(plain.of, plain.inputs, plain.q, [(), way], plain.n)
        self.changed = {id(old) for old, _new in step.edits}
        self.telling = False
        self.otherwise: list[Array] = []
        self.alike: list[Array] = []
        self.walk()

    def among(self, numbers: Array, given: Array, answer: Array) -> bool:
        """Whether one of them is among some numbers; of a line that is the answer a piece of it."""
        own = _telling(self.otherwise)
        own = own[~_near(own, given)]
        answers = _near(own, answer)
        if answers.all():
            own = _telling(self.alike) if len(own) else own
            answers = _near(own, given)
        return bool(_near(own[~answers], numbers).any())

    def _run(self, statement: ast.stmt) -> None:
        line = not isinstance(statement, ast.For)
        self.telling = line and any(id(node) in self.changed for node in nodes(statement))
        super()._run(statement)
        self.telling = False

    def value(self, node: ast.expr, rows: Rows) -> Array:
        found = super().value(node, rows)
        if self.telling and rows is None and found.shape[1] > 1:
            first, last, other = *found[[0, -1], : -(-found.shape[1] // _STATES)], found[-1]
            moving = last != other[-len(last) :]
            same = np.isclose(first, last, rtol=TOLERANCES.formula_agrees, atol=0.0)
            self.otherwise.append(last[moving & ~same])
            if getattr(getattr(node, "value", node), "id", "") not in self.given:
                self.alike.append(last[moving & same])
        return found


def _telling(arrays: Iterable[Array]) -> Array:
    """All numbers that are not plain, sorted."""
    flat = [np.ravel(x) for x in arrays if x.dtype.kind == "f"]
    every = np.sort(np.concatenate([*flat, np.empty(0)]))
    plain = np.abs(2.0 * every - np.round(2.0 * every)) <= TOLERANCES.plain_value
    return np.asarray(every[~plain & np.isfinite(every)])


def _near(some: Array, numbers: Array) -> Any:
    """Which of some numbers are among others, which are sorted."""
    if not len(numbers):
        return np.zeros(len(some), dtype=bool)
    at = np.searchsorted(numbers, some).clip(1, max(1, len(numbers) - 1))
    gaps = [np.abs(numbers[(at - k).clip(0, len(numbers) - 1)] - some) for k in (0, 1)]
    return np.asarray(np.minimum(*gaps) <= TOLERANCES.formula_agrees * np.abs(some))
