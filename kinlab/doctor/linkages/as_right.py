"""A five-bar's answers that are as right as the engine's own: an equation times a factor, a branch.

A, B, C and the loop's equation are right with any common factor; a crank's angle on either branch,
and with whole turns more or less.
"""

from __future__ import annotations

import math
from collections.abc import Callable, Iterable, Iterator, Mapping
from dataclasses import dataclass, replace
from typing import TYPE_CHECKING, Any

import numpy as np

from kinlab.arrays import Array
from kinlab.check.compare import relative_errors
from kinlab.check.diagnosis import Diagnosis
from kinlab.check.quantities.fivebar import leg_of
from kinlab.check.quantities.quantity import Quantity
from kinlab.check.quantities.registry import quantities
from kinlab.doctor.changes import Case
from kinlab.doctor.linkages.five_bar import is_either
from kinlab.doctor.linkages.looked_up import looked_up
from kinlab.fivebar import FiveBar
from kinlab.formulas import tree
from kinlab.formulas.text import words_in
from kinlab.host.language import _
from kinlab.tolerances import TOLERANCES

if TYPE_CHECKING:
    from kinlab.doctor.text.written import Written

Judge = Callable[[Case, Array, Array], Diagnosis]
"""From a case, the answers and the right ones to what is said of them."""

_FACTORS = {
    "1": (1.0, 0), "-1": (-1.0, 0), "1/2": (0.5, 0), "-1/2": (-0.5, 0), "2": (2.0, 0),
    "-2": (-2.0, 0), "1/(2*l1)": (0.5, -1), "-1/(2*l1)": (-0.5, -1), "1/l1": (1.0, -1),
    "-1/l1": (-1.0, -1),
}  # fmt: skip
"""What an equation may be multiplied by, the likeliest first: a number, and a power of l1."""
_SIDES = {"1": (1.0, 0), "-1": (-1.0, 0)}
"""The same of the loop's equation, by the side on which it stands."""
_BRANCHED = {"sqrt", "acos", "arccos"}
"""Functions with which a crank's angle is on one of two branches."""
_GIVEN = ("x", "y", "vx", "vy", "ax", "ay")
"""What is the same in every working mode."""
_MODES, _MODE = ((-1, 1), (1, 1), (-1, -1), (1, -1)), "({:+d}, {:+d})"
_POWERS = ((0, 0), (-1, 0), (0, -1), (-2, 0), (0, -2), (-1, -1), (1, 0), (0, 1))
"""Powers of l1 and l2 by which the loop's equation may be multiplied."""
_LEG = 3
"""Numbers of a leg's equation: A, B and C."""
_HALF = 2
"""Of an angle as twice another, whose cosine is below zero where A + C is."""
_TRIED = 4
"""Answers beside which slips are looked for."""


@dataclass(frozen=True)
class AsRight:
    """One way of being right.

    Attributes:
        case: with the quantity that answers so.
        factor: what an equation is multiplied by, ``"1"``.
        told: what is to be said of it, where it is not the engine's.
    """

    case: Case
    factor: str = "1"
    told: str = ""

    @property
    def answers(self) -> Array:
        """The right answers."""
        return np.asarray(self.case.answer(()), dtype=float)

    def near(self, hand: Array) -> Array:
        """The answers without the whole turns by which an angle is off."""
        if not self.case.quantity.name.endswith("angles"):
            return hand
        with np.errstate(invalid="ignore"):
            return np.asarray(hand - 2 * np.pi * np.round((hand - self.answers) / (2 * np.pi)))

    def holds(self, hand: Array, text: Written) -> bool:
        """Whether a text that answers so is right, and of other five-bars if it has no numbers."""
        error = float(np.max(relative_errors(self.near(hand), self.answers)))
        if error > TOLERANCES.formula_agrees or any(one.half for one in text.literals):
            return error <= TOLERANCES.formula_agrees
        other = looked_up(self.case)
        return other is None or other.holds(text)


def ways(case: Case) -> list[AsRight]:
    """All the ways in which an entry of a five-bar may be right; the engine's is the first."""
    name = case.quantity.name
    if name.endswith("_equation"):
        return [_times(case, factor) for factor in _FACTORS]
    if name.endswith("_loop"):
        return [*(_times(case, side) for side in _SIDES), AsRight(_lengths(case))]
    if name.endswith("_angles"):
        return [
            AsRight(_branch(case, sign, turn)) for turn in (0, 1, -1, _HALF) for sign in (1.0, -1.0)
        ]
    return [AsRight(case)]


def judged_kindly(case: Case, hand: Array, text: Written, factor: str, judge: Judge) -> Diagnosis:
    """The diagnosis beside the way of being right that answers are nearest to.

    Args:
        case: of one entry.
        hand: its text's answers.
        text: the text.
        factor: of an equation, the factor of the other formulas of its leg; ``""`` of none.
        judge: judges the answers beside right ones.
    """
    every = [way for way in ways(case) if factor in ("", way.factor)]
    if case.quantity.name.endswith("_loop"):
        every += _times_any(case, hand)
    if "mode" in case.quantity.arguments and not case.quantity.name.endswith("angles"):
        every = _of_one_mode(case, hand, text) or every
    if len(every) == 1:
        return _said(every[0], judge(every[0].case, every[0].near(hand), every[0].answers))
    right = [way for way in every if way.holds(hand, text)]
    if not right and case.quantity.name.endswith("angles"):
        every.sort(key=lambda way: (_typical(way, hand), _turns(way, hand)))
    best: Diagnosis | None = None
    for way in right or every[:_TRIED]:
        found = _said(way, judge(way.case, way.near(hand), way.answers))
        if found.agrees or _slips(found) == 1:
            return found
        if best is None or _slips(found) < _slips(best):
            best = found
    assert best is not None
    return best


def _of_one_mode(case: Case, hand: Array, text: Written) -> list[AsRight]:
    """What a text has to be that works a crank's angle out by itself, and so on one branch.

    The working mode that its answers are nearest to.
    """
    typed = {name for one in (text.text, *text.symbols.values()) for name in words_in(one)}
    known = looked_up(case)
    if typed.isdisjoint(_BRANCHED) or known is None:
        return []
    if not tree.names(text.node) <= {*_GIVEN, *known.parameters}:
        return []  # J11 and w1x are those of the mode that is asked for
    said = _("it is of the working mode {mode} alone, the signs of crank x rod")
    every = [
        AsRight(_in_mode(case, signs), told=said.format(mode=_MODE.format(*signs)))
        for signs in _MODES
    ]
    every.sort(key=lambda way: _typical(way, hand))
    other = [x for x in every[1:] if not np.allclose(x.answers, every[0].answers)]
    return [every[0], *other[:1]]


def _in_mode(case: Case, signs: tuple[int, int]) -> Case:
    """A quantity in one working mode, whichever is asked for."""
    plain = case.quantity.engine

    def engine(fivebar: FiveBar, *stacks: Any) -> Array:
        given = dict(zip(case.quantity.arguments, stacks, strict=True))
        given["mode"] = np.broadcast_to(np.array(signs, dtype=float), np.shape(given["mode"]))
        return np.asarray(plain(fivebar, *given.values()))

    return _with_engine(case, engine)


def times(case: Case, hand: Array, engine: Array) -> tuple[Array, str] | None:
    """A function's equation without the factor on both of its sides, and what is told of it.

    A, B and C of a leg may share any factor, another one at each state; of the loop's equation,
    which is one number, it must be the same at all of them.

    Args:
        case: with the states.
        hand: the function's answers.
        engine: the engine's.
    """
    name = case.quantity.name
    known = hand.shape == engine.shape and hand.dtype.kind in "iuf" and np.isfinite(hand).all()
    if not known or not name.endswith(("_equation", "_loop")):
        return None
    if name.endswith("_loop"):
        return _as_loop(case, hand, engine)
    if engine.ndim > 1 and engine.shape[-1] == _LEG:
        told = _(
            "the equation is multiplied by a factor that A, B and C of a leg share: it is the same "
            "equation"
        )
        same = _without_factor(hand, engine, -1)
        return None if same is None else (same, told)
    if engine.ndim == 1:  # A, B or C alone
        for way in ways(case)[1:]:
            if np.max(relative_errors(hand, way.answers)) <= TOLERANCES.formula_agrees:
                return engine, way.told
    return None


def _as_loop(case: Case, hand: Array, engine: Array) -> tuple[Array, str] | None:
    """The loop's equation times a number, or one of lengths and not of their squares."""
    same = _without_factor(hand, engine)
    if same is not None:
        return same, _by_a_constant()
    lengths = np.asarray(_lengths(case).answer(()), dtype=float)
    if np.max(relative_errors(hand, lengths)) <= TOLERANCES.formula_agrees:
        same = lengths
    else:
        same = _without_factor(hand, lengths)
    told = _("the equation is one of lengths: it is the same equation")
    return None if same is None else (engine, told)


def _times_any(case: Case, hand: Array) -> Iterator[AsRight]:
    """The loop's equation, or that of lengths, times what it is here, as powers of the lengths.

    ``(x/l2)^2 + (y/l2)^2 - 1`` is that of squares by l2^2.
    """
    for one in (case, _lengths(case)):
        right = np.asarray(one.answer(()), dtype=float)
        same = _without_factor(hand, right)
        if same is None:
            continue
        number = float(np.sum(hand * right) / np.sum(right * right))
        for powers in _POWERS:
            yield AsRight(_scaled(one, number, powers), told=_by_a_constant())


def _scaled(case: Case, here: float, powers: tuple[int, int]) -> Case:
    """An equation times a number and powers of the lengths that are a factor at this five-bar."""
    plain, own_linkage = case.quantity.engine, case.robot
    assert isinstance(own_linkage, FiveBar)

    def size(fivebar: FiveBar, stacks: Any) -> Array:
        given = dict(zip(case.quantity.arguments, stacks, strict=True))
        sizes = [fivebar.l1, fivebar.l2]
        if "s" in given:
            sizes = [one[leg_of(given["s"])] for one in sizes]
        return np.asarray(math.prod(one**k for one, k in zip(sizes, powers, strict=True)))

    def engine(fivebar: FiveBar, *stacks: Any) -> Array:
        own = size(own_linkage, stacks)
        return np.asarray(plain(fivebar, *stacks)) * here * size(fivebar, stacks) / own

    return _with_engine(case, engine)


def _without_factor(hand: Array, right: Array, axis: int = 0) -> Array | None:
    """Answers without a factor that those along an axis share; None where none but 1 is."""
    size = np.sum(right * right, axis=axis, keepdims=True)
    factor = np.sum(hand * right, axis=axis, keepdims=True) / size
    least, most = float(np.min(np.abs(factor))), float(np.max(np.abs(factor)))
    if not least > TOLERANCES.formula_agrees * most:
        return None
    same = np.asarray(hand / factor)
    if np.max(relative_errors(same, right)) > TOLERANCES.formula_agrees:
        return None
    plain = np.max(np.abs(factor - 1.0)) <= TOLERANCES.formula_agrees
    return None if plain else same


def _slips(found: Diagnosis) -> float:
    """How many slips a diagnosis names; infinite where it knows none."""
    return len(found.causes[0].kinds) if found.causes else math.inf


def common_factor(cases: Iterable[tuple[Case, Array, Written]]) -> str:
    """The factor with which most formulas of a leg's equation are right; ``""`` where none is."""
    right = dict.fromkeys(_FACTORS, 0)
    for case, hand, text in cases:
        for way in ways(case):
            right[way.factor] += way.holds(hand, text)
    best = max(right, key=lambda factor: right[factor])
    return best if right[best] else ""


def _typical(way: AsRight, hand: Array) -> float:
    gap = np.abs(way.near(hand) - way.answers)
    return float(np.median(np.where(np.isfinite(gap), gap, np.inf)))


def _turns(way: AsRight, hand: Array) -> float:
    return float(np.mean(np.abs(np.nan_to_num(way.near(hand) - hand))))


def _said(way: AsRight, found: Diagnosis) -> Diagnosis:
    if not way.told or not found.agrees:
        return found
    return replace(found, form=found.form or "unusual", remarks=(*found.remarks, way.told))


def _by_a_constant() -> str:
    return _("the equation is multiplied by a constant: it is the same equation")


def _with_engine(case: Case, answer: Callable[..., Any]) -> Case:
    quantity: Quantity = replace(case.quantity, engine=answer)
    return replace(case, quantity=quantity)


def _times(case: Case, factor: str) -> AsRight:
    number, power = {**_FACTORS, **_SIDES}[factor]
    if factor == "1":
        return AsRight(case)
    plain = case.quantity.engine

    def engine(fivebar: FiveBar, *stacks: Any) -> Array:
        found = np.asarray(plain(fivebar, *stacks))
        lengths = _of_leg(case, fivebar, dict(zip(case.quantity.arguments, stacks, strict=True)))
        sizes = number * lengths**power
        return found * sizes.reshape(sizes.shape + (1,) * (found.ndim - sizes.ndim))

    of_one = case.quantity.name.endswith("_equation")  # A, B or C
    told = (
        _("it is multiplied by {factor}: right if A, B and C all are")
        if of_one
        else _("the equation is multiplied by {factor}")
    )
    return AsRight(_with_engine(case, engine), factor, told.format(factor=factor))


def _of_leg(case: Case, fivebar: FiveBar, given: Mapping[str, Any]) -> Array:
    """l1 of each state's leg, (N,), or of both, (N, 2)."""
    if is_either(case.quantity.name):
        return np.asarray(fivebar.l1[leg_of(given["s"])])
    return np.broadcast_to(fivebar.l1, (len(given["xy"]), 2))


def _lengths(case: Case) -> Case:
    """The loop's equation as lengths: |elbow to tool| - l2."""
    plain = case.quantity.engine

    def engine(fivebar: FiveBar, *stacks: Any) -> Array:
        given = dict(zip(case.quantity.arguments, stacks, strict=True))
        rods = fivebar.l2[leg_of(given["s"])] if "s" in given else fivebar.l2
        return np.sqrt(np.asarray(plain(fivebar, *stacks)) + rods**2) - rods

    return _with_engine(case, engine)


def _branch(case: Case, sign: float, turn: int) -> Case:
    """A crank's angle where u x w has one sign, with the whole turns that a formula gives it.

    In (-pi, pi] as 2 atan(...) has it, around atan2(B, A) or its back, or as 2 atan2(..., A + C).
    """
    plain = case.quantity.engine

    def engine(fivebar: FiveBar, *stacks: Any) -> Array:
        given = dict(zip(case.quantity.arguments, stacks, strict=True))
        given["mode"] = np.full_like(np.asarray(given["mode"], dtype=float), sign)
        angle = np.asarray(plain(fivebar, *given.values()))
        if not turn:
            return angle
        found = quantities()["fivebar_equation"].engine(fivebar, given["xy"])
        if "s" in given:
            found = found[np.arange(len(found)), leg_of(given["s"])]
        a, b, c = np.moveaxis(found, -1, 0)
        if turn == _HALF:
            return np.asarray(angle - 2 * np.pi * np.sign(angle) * (a + c < 0))
        middle = np.arctan2(turn * b, turn * a)
        return np.asarray(middle + np.arctan2(np.sin(angle - middle), np.cos(angle - middle)))

    return _with_engine(case, engine)
