"""A program beside what it should answer: at a few states first, then at all of them."""

from __future__ import annotations

import ast
import copy
import re
from collections.abc import Sequence
from types import FunctionType
from typing import Any

import numpy as np

from kinlab.arrays import Array
from kinlab.check.compare import error_sizes, relative_errors
from kinlab.doctor.bytecode.syntax import nodes
from kinlab.doctor.changes import ANGLES, ANY_ZERO, Case, less_turns
from kinlab.doctor.program.grounds.scaled import is_own
from kinlab.doctor.program.places import paired
from kinlab.doctor.program.trial import TURNS, Trial, named_in, quietly
from kinlab.errors import KinlabError
from kinlab.formulas.record import state_by_state
from kinlab.tolerances import TOLERANCES

_NUMBERS = 4
"""Numbers of the answer at which an edit is tried first."""
_CLEARLY = 0.5
"""Share of a program's largest error that shows it to be wrong at a state."""
_TURNS, _LONGER = 100, 6
"""Turns that loops may take at the first states; how many times as many as without an edit."""
_STEP = re.compile(r"_*(h|dt|d?h|dq|dx|eps|step|delta|tol)\w?(_|$)", re.IGNORECASE)
"""What the step of a difference is called, or where an iteration ends."""
_WATCHED = 2
"""States at which a program is watched."""


class Asked:
    """A wrong program, and what it should answer.

    Args:
        trial: the program.
        case: the states, and the program's own answers.
        wanted: the right answers, (N, ...).
        allowed: the relative error that may be left.

    Attributes:
        first: the states at which an edit is tried first.
        watched, states: those at which the program is watched; each as the arguments of one call.
        differences: whether a number of the program may be the step of a difference.
        sizes: what errors are relative to, (N,).
        several: how many different answers there are at the first states.
    """

    def __init__(self, trial: Trial, case: Case, wanted: Array, allowed: float) -> None:
        self.trial, self.case, self.wanted = trial, case, wanted
        size = int(np.prod(wanted.shape[1:], initial=1))
        self.first = list(range(max(1, -(-_NUMBERS // size))))
        self.watched = [*self.first, len(self.first)][:_WATCHED]
        self._add_a_wrong_one()
        self._add_another_branch()
        self._turns = TURNS
        self.differences = self._differences()
        self.allowed = allowed if self.differences else TOLERANCES.formula_agrees
        self._ask()
        self.states = self.states_at(self.watched)
        self.answers(self.first)
        self._turns = max(_TURNS, _LONGER * self.trial.longest)

    def _ask(self) -> None:
        """What is asked of the program at the first states, and what it should answer."""
        asked = self.case.quantity.asked(self.case.robot, self.trial.function)
        self.sizes = error_sizes(self.wanted)
        self._asked = state_by_state(asked)
        self._few = self._at(self.first)
        self.several = self.distinct() if self.case.quantity.read is not None else 1
        self._near = max(TOLERANCES.tried_further, self.allowed) * self.scale

    def _differences(self) -> bool:
        """Whether a number of the program may be the step of a difference.

        A number of the robot's own is none, unless it is called one.
        """
        inner = [node for tree in self.trial.trees for node in nodes(tree)]
        named = [("", getattr(node, "value", None)) for node in inner]
        named += [
            (one.id, getattr(value, "value", None))
            for node in inner
            if isinstance(node, ast.Assign)
            for one, value in paired(node.targets[0], node.value)
            if isinstance(one, ast.Name)
        ]
        named += [(name, self.trial.space[name]) for name in self.trial.program.data]
        for part in self.trial.program.parts:
            named += [("", value) for value in _defaults(part.function)]
        words = {word for tree in self.trial.trees for word in named_in(tree)}
        steps = (
            isinstance(x, float)
            and 0 < abs(x) <= TOLERANCES.may_be_step
            and (_STEP.match(name) or not is_own(self.case.robot, x))
            for name, x in named
        )
        return any(steps) or any("eps" in word or word == "finfo" for word in words)

    def _add_a_wrong_one(self) -> None:
        """Sees to it that the program as it is fails at the first states, if it does anywhere.

        Where one state has numbers enough, it is the one at which it does.
        """
        if self.case.hand.shape != self.wanted.shape:
            return
        errors = relative_errors(self.case.hand, self.wanted)
        clearly = errors > _CLEARLY * np.max(errors)
        if clearly.any() and not clearly[self.first].any():
            others = self.first if len(self.first) > 1 else []
            self.first = [*others, int(np.argmax(clearly))]

    def _add_another_branch(self) -> None:
        """Sees to it that the signs of a branch are not all alike at each of the first states.

        ``mode[0]`` in place of ``mode[i]`` is as good where they are.
        """
        answered = np.isfinite(self.case.hand.reshape(len(self.case.hand), -1)).all(axis=1)
        for stack in self.case.arguments.values():
            if stack.ndim > 1 and np.all(np.abs(stack) == 1.0):
                apart = (stack.min(axis=1) < stack.max(axis=1)) & answered
                if apart.any() and not apart[self.first].any():
                    self.first.append(int(np.argmax(apart)))

    def _at(self, which: Sequence[int]) -> tuple[list[Array], Array]:
        """The arguments and the right answers at some states."""
        chosen = list(which)
        return [stack[chosen] for stack in self.case.arguments.values()], self.wanted[chosen]

    def states_at(self, which: Sequence[int]) -> list[tuple[Array, ...]]:
        """Some states, each as the arguments of one call."""
        stacks = self.case.arguments.values()
        return [tuple(stack[k].copy() for stack in stacks) for k in which]

    def watched_of(self, argument: str) -> list[Array]:
        """One of the arguments at the watched states, where the quantity has it."""
        given = self.case.arguments
        return [given[argument][k] for k in self.watched] if argument in given else []

    def as_compared(self, values: Array, wanted: Array) -> Array:
        """A potential's answers moved to the right zero, angles without whole turns.

        Others are as they are.

        Args:
            values: at some states, or stacks of these.
            wanted: what is right there.
        """
        if self.case.quantity.name in ANGLES:
            return less_turns(values, wanted)
        if self.case.quantity.name not in ANY_ZERO:
            return values
        firsts = np.take(values, [0], axis=values.ndim - wanted.ndim)
        return np.asarray(values + (wanted[:1] - firsts))

    def of_lanes(self, found: Array) -> Array | None:
        """What is compared of answers in lanes; None of answers of another size.

        Args:
            found: all the numbers of the answers at the first states, or some of these, (C, S, P).
        """
        wanted = self._few[1][: found.shape[1]]
        shape = (len(found), *wanted.shape)
        read, robot = self.case.quantity.read, self.case.robot
        if read is None:
            if found.size != np.prod(shape):
                return None
            return self.as_compared(found.reshape(shape), wanted)
        if found.shape[2] % robot.n:
            return None
        solutions = found.reshape(len(found) * len(wanted), -1, robot.n)
        every = np.broadcast_to(wanted, shape).reshape(len(solutions), *wanted.shape[1:])
        return np.asarray(read(robot, solutions, every)).reshape(shape)

    @property
    def scale(self) -> Array:
        """What differences at the first states are relative to, beside the answers there."""
        sizes = self.sizes[self.first]
        return sizes.reshape(-1, *[1] * (self.wanted.ndim - 1))

    @property
    def faithful(self) -> bool:
        """Whether the program as it was read answers what the user's own function did."""
        with quietly():
            own, hand = self.values(self.watched), self.case.hand[self.watched]
        if own is None or own.shape != hand.shape:
            return False
        hand = self.as_compared(hand, self.wanted[self.watched])
        known = np.abs(hand[np.isfinite(hand)])
        size = max(float(np.max(known, initial=0.0)), float(np.max(self.sizes)))
        return bool(np.allclose(own, hand, rtol=1e-9, atol=1e-9 * size, equal_nan=True))

    def at(self, case: Case, wanted: Array) -> Asked:
        """The same program asked at other states, all of which are its first."""
        other = copy.copy(self)
        other.case, other.wanted, other.first = case, wanted, list(range(len(wanted)))
        other._ask()
        return other

    def same(self, values: Array, own: Array) -> bool:
        """Whether answers at the first states are the same, as those of a lane without an edit."""
        none = ~np.isfinite(values) & ~np.isfinite(own)
        return bool((none | (np.abs(values - own) <= self._near)).all())

    def right(self, values: Array) -> Any:
        """Which entries of answers at the first states are right."""
        gap = np.abs(values - self._few[1])
        return (gap <= self._near).all(axis=0).ravel()

    def error(self, which: range) -> float:
        """The largest relative error at some states of the program as it stands now."""
        values = self.values(which)
        if values is None:
            return np.inf
        gap = np.abs(values - self.wanted[list(which)]).reshape(len(which), -1)
        return float(np.max(gap.max(axis=1, initial=0.0) / self.sizes[list(which)]))

    @property
    def off(self) -> float:
        """The largest relative error of the program's own answers."""
        if self.case.hand.shape != self.wanted.shape:
            return np.inf
        hand = self.as_compared(self.case.hand, self.wanted)
        worst = np.max(relative_errors(hand, self.wanted))
        return float(worst) if np.isfinite(worst) else np.inf

    def fits(self) -> bool:
        """Whether the program as it stands now is right at every state."""
        return self.error(range(len(self.wanted))) <= self.allowed

    def distinct(self) -> int:
        """How many different answers there are at the first states; solutions are several."""
        try:
            answers = np.asarray(self._asked(None, *self._few[0]), dtype=float)
        except (KinlabError, TypeError, ValueError):
            return 0
        rows = answers.reshape(len(answers), -1, answers.shape[-1]) if answers.ndim > 1 else answers
        return sum(len(np.unique(np.round(one, 9), axis=0)) for one in rows)

    def values(self, which: Sequence[int]) -> Array | None:
        """The answers of the program as it stands now, None where it has none.

        A potential's are moved to the right zero.
        """
        values = self.answers(which)
        if values is None:
            return None
        _stacks, wanted = self._few if which is self.first else self._at(which)
        return self.as_compared(values, wanted)

    def answers(self, which: Sequence[int]) -> Array | None:
        """The same as they are."""
        quantity, robot = self.case.quantity, self.case.robot
        stacks, wanted = self._few if which is self.first else self._at(which)
        self.trial.most_turns = self._turns if which is self.first else TURNS
        try:
            answers = np.asarray(self._asked(None, *stacks))
            if np.iscomplexobj(answers):
                if answers.imag.any():
                    return None
                answers = answers.real
            values = np.asarray(answers, dtype=float)
            if quantity.read is not None:
                values = np.asarray(quantity.read(robot, values, wanted))
        except (KinlabError, TypeError, ValueError):
            return None
        return values if values.shape == wanted.shape else None


def _defaults(function: FunctionType) -> list[Any]:
    return [*(function.__defaults__ or ()), *(function.__kwdefaults__ or {}).values()]
