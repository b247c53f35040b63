"""Rounded numbers of a function and of the robot's data, and whether they explain a difference."""

from __future__ import annotations

from collections.abc import Iterable, Iterator
from dataclasses import replace
from typing import Any

import numpy as np

from kinlab.arrays import Array
from kinlab.check.compare import error_sizes
from kinlab.check.quantities.serial import SERIAL
from kinlab.doctor.changes import Case
from kinlab.doctor.confusions.robots import with_gravity
from kinlab.doctor.numbers import rounded_robots
from kinlab.doctor.text.meanings import CLOSE, RODS, Meanings, exact_angle, stands_for
from kinlab.doctor.text.written import Literal, Written, literal
from kinlab.errors import KinlabError
from kinlab.fivebar import FiveBar
from kinlab.formulas import tree
from kinlab.formulas.tree import Node
from kinlab.host.language import _
from kinlab.model.robot import Robot
from kinlab.tolerances import TOLERANCES

_SEVERAL = 2
"""Coefficients that agree to the same digits by no accident."""
_FINE = 0.1
"""Share of the largest coefficient that the last digit of all is at most."""
_ROUGH = 0.03
"""Share of a function's answer that rounded constants may change: g = 10 is 2 %."""


def roundings(case: Case, engine: Array, function: bool) -> Iterator[tuple[str, ...]]:
    """Roundings in the robot's data, or of a function, that account for every state, in words."""
    if isinstance(case.robot, FiveBar):
        weighed = gravity_rounded(case, engine) if function else None
        if weighed is not None:
            yield weighed
        return
    if case.quantity.domain is not SERIAL:
        return
    full = exact_data(case.robot)
    if full is not None:
        answer = replace(case, robot=full[0]).answer(())
        if answer.shape == case.hand.shape and same_values(case.hand, answer, engine):
            yield full[1]
    if not function or case.hand.shape != engine.shape:
        return
    weighed = gravity_rounded(case, engine)
    if weighed is not None:
        yield weighed
    gap = np.where(np.isfinite(case.hand), np.abs(case.hand - engine), np.inf)
    if np.max(gap) <= _ROUGH * np.max(np.abs(engine)):
        yield from _other_robots(case, engine)


def _other_robots(case: Case, engine: Array) -> Iterator[tuple[str, ...]]:
    """Angles, or all numbers of the robot, rounded; and g with them."""
    few = case.few(2)
    for robot, said in rounded_robots(case.robot):
        other = replace(few, robot=robot)
        answer = other.answer(())
        if not same_values(few.hand, answer, engine[:2]) and not gravity_rounded(other, answer):
            continue
        other = replace(case, robot=robot)
        answer = other.answer(())
        if same_values(case.hand, answer, engine):
            yield said
        elif (also := gravity_rounded(other, answer)) is not None:
            yield (*said, *also)


def same_values(one: Array, two: Array, size: Array, slack: float = 0.0) -> bool:
    """Whether two answers are one, relative to the size of a third, to rounding or a slack."""
    gap = np.max(np.abs((one - two).reshape(len(one), -1)), axis=1)
    return bool(np.max(gap / error_sizes(size)) <= max(slack, TOLERANCES.formula_agrees))


def exact_data(robot: Robot) -> tuple[Robot, tuple[str, ...]] | None:
    """The robot with angles of its table in full where they were typed rounded: 1.5708 for pi/2."""
    table = robot.table
    if table is None:
        return None
    links: list[Any] = []
    said: list[str] = []
    for i, link in enumerate(table.links, 1):
        columns: dict[str, Any] = {}
        for column in ("alpha", "theta"):
            value = float(getattr(link, column))
            exact = exact_angle(value)
            if exact is not None:
                columns[column] = exact
                told = _(
                    "{column} of link {number} is {value:g} in the robot's data and stands for "
                    "{meant}"
                )
                meant = Meanings({}).named(exact)
                said.append(told.format(column=column, number=i, value=value, meant=meant))
        links.append(replace(link, **columns))
    if not said:
        return None
    return Robot.from_dh(replace(table, links=links)), tuple(said)


def gravity_rounded(
    case: Case, engine: Array, whole: bool = True, any_zero: bool = False
) -> tuple[str, ...] | None:
    """Answers with another g that is the robot's rounded: 9.8, or if it may be ``whole``, 10.

    Args:
        case: with the answers.
        engine: the engine's.
        whole: whether g may be a whole number.
        any_zero: whether a constant more or less is none of what is compared.
    """
    robot: Any = case.robot
    if case.quantity.domain is not SERIAL and not isinstance(robot, FiveBar):
        return None
    g = np.array(robot.gravity if isinstance(robot, FiveBar) else robot.model.gravity.linear)
    size = float(np.linalg.norm(g))
    if not size or case.hand.shape != engine.shape or not np.isfinite(case.hand).all():
        return None
    try:
        none = replace(case, robot=weightless(case.robot)).answer(())
    except KinlabError:  # what a URDF of the arm is asked for
        return None
    weight, rest = engine - none, case.hand - none
    if any_zero:
        weight, rest = (x - np.mean(x, axis=0) for x in (weight, rest))
    total = float(np.sum(weight * weight))
    if total <= 0:
        return None
    share = float(np.sum(weight * rest)) / total
    one = _decimal(share * size)
    if (
        one is None
        or (one.whole and not whole)
        or share <= 0
        or abs(one.value - size) > one.reach * (1 + TOLERANCES.same_relation)
        or not same_values(rest, share * weight, engine)
    ):
        return None
    return (stands_for(f"g = {one.text}", f"{size:.10g}"),)


def weightless(robot: Any) -> Any:
    """The robot, or the five-bar, without gravity."""
    if isinstance(robot, FiveBar):
        return replace(robot, gravity=(0.0,) * len(robot.gravity))
    return with_gravity(robot, np.zeros(3))


def _decimal(value: float) -> Literal | None:
    """The few digits that a number has, or None."""
    for digits in range(1, 7):
        shown = f"{value:.{digits}g}"
        if abs(float(shown) - value) <= TOLERANCES.same_number * abs(value):
            return literal(f"{float(shown):.15g}".lstrip("-"))
    return None


def short(value: float, against: float) -> Literal | None:
    """A number as few digits, where it is another number rounded: 5.89 of 5.886.

    Args:
        value: what was used.
        against: what it should be.
    """
    one = _decimal(value)
    gap = abs(abs(value) - abs(against))
    if one is None or one.whole or not 0 < gap <= one.half * (1 + TOLERANCES.same_relation):
        return None
    return one if one.digits > 1 or gap <= CLOSE * abs(against) else None


def coefficients(
    hand: Array, engine: Array, scale: Array, words: list[Node], at: dict[str, Array]
) -> tuple[Array, Array] | None:
    """A function's coefficients and the engine's, (W,) each, where the words are all of it.

    Args:
        hand, engine: an entry at the states, (N,).
        scale: what differences are relative to, (N,).
        words: the joint functions of the derived entry, each once.
        at: values of the names at the states.
    """
    columns = np.array([np.broadcast_to(tree.evaluate(w, at), hand.shape) for w in words]).T
    if 2 * columns.shape[1] > len(hand) or np.linalg.matrix_rank(columns) < columns.shape[1]:
        return None
    mine, *_rest = np.linalg.lstsq(columns, hand, rcond=None)
    theirs, *_rest = np.linalg.lstsq(columns, engine, rcond=None)
    if np.max(np.abs(columns @ mine - hand) / scale) > TOLERANCES.formula_agrees:
        return None
    return mine, theirs


def coefficients_rounded(
    mine: Array, theirs: Array, at: dict[str, Array], shown: Iterable[Literal] = ()
) -> list[str] | None:
    """Coefficients that are the derived ones to a few digits, in words, or None.

    Empty where they may be: their digits are not seen, as they are in a text, and 1.12 for 1.115
    may as well be a mass of 2.02.
    """
    seen = [*shown]
    throughout = _throughout(mine, theirs, seen)
    if throughout or seen:
        return [throughout] if throughout else None
    meanings, size = Meanings.at(at), float(np.max(np.abs(theirs)))
    said = []
    for one, two in zip(mine.tolist(), theirs.tolist(), strict=True):
        if abs(one - two) <= TOLERANCES.formula_agrees * max(size, 1e-12):
            continue
        found = _coefficient(one, two, meanings) if one * two > 0 else None
        if found is None:
            return None
        said.append(found)
    if not said:
        return None
    return list(dict.fromkeys(said)) if all(said) else []


def _throughout(mine: Array, theirs: Array, shown: list[Literal]) -> str:
    """That all coefficients are the derived ones to the same digits or decimals, in words.

    Not to fewer than are ``shown``, where that is seen.
    """
    exact, largest = mine[theirs == 0], float(np.max(np.abs(theirs)))
    near = TOLERANCES.same_number * largest
    if len(mine) < _SEVERAL or np.any(np.abs(exact) > near):
        return ""
    one, two = mine[theirs != 0], theirs[theirs != 0]
    sizes = np.floor(np.log10(np.abs(two)))
    digits = max((one.digits for one in shown if not one.whole), default=0)
    places = max((len(one.text.partition(".")[2]) for one in shown), default=0)
    for count in range(2, 7):
        for least, powers, said in (
            (digits, sizes + 1 - count, _("its coefficients are right to {count} digits")),
            (places, 0 * sizes - count, _("its coefficients are right to {count} decimals")),
        ):
            units = 10.0**powers
            if count < least or np.max(units) > _FINE * largest:
                continue
            whole = np.abs(np.round(one / units) * units - one) <= near
            close = np.abs(one - two) <= 0.5 * units * (1 + TOLERANCES.formula_agrees)
            if whole.all() and close.all():
                return said.format(count=count)
    return ""


def _coefficient(one: float, two: float, meanings: Meanings) -> str | None:
    """How a coefficient is rounded: itself, or a third in front of a rod's m l²; "" if in doubt."""
    whole = short(one, two)
    if whole is not None and abs(one - two) <= TOLERANCES.nearly_agrees * abs(two):
        said = _("the coefficient {written} stands for {meant:.7g}")
        return said.format(written=whole.text, meant=abs(two))
    for exact in RODS:
        for digits in range(2, 7):
            part = literal(np.format_float_positional(exact, digits, fractional=False, trim="-"))
            off = abs(part.value - exact)
            gap = abs(one - two) / off if 0 < off <= TOLERANCES.typed_rounding * exact else 0.0
            if any(abs(rod - gap) <= TOLERANCES.same_relation * gap for rod in meanings.rods):
                return stands_for(part.text, meanings.named(exact))
    return None if whole is None else ""


def data_rounded(
    text: Written, derived: Node, at: dict[str, Array], hand: Array, scale: Array
) -> str | None:
    """A number of the robot's data that is rounded where the text has it in full, or None.

    Args:
        text: the formula; the number's name does not stand in it.
        derived: the derived entry.
        at: values of the names at the states.
        hand: the text's values.
        scale: what differences are relative to.
    """
    if any(one.half > 0 and 4 * one.value % 1 for one in text.literals):
        return None
    meanings = Meanings.at(at)
    for name in sorted(tree.names(derived) - tree.names(text.node)):
        own = float(at[name][0]) if name[0] != "q" else 0.0
        one = literal(f"{abs(own):.15g}")
        if not 0 < one.half <= CLOSE * abs(own):
            continue
        base = tree.evaluate(derived, at)
        slope = (tree.evaluate(derived, {**at, name: at[name] + one.half}) - base) / one.half
        size = float(np.sum(slope * slope))
        if size <= 0:
            continue
        moved = float(np.sum(slope * (hand - base))) / size
        gap = tree.evaluate(derived, {**at, name: at[name] + moved}) - hand
        fits = np.max(np.abs(gap) / scale) <= TOLERANCES.formula_agrees
        within = abs(moved) <= one.half * (1 + TOLERANCES.same_relation)
        if fits and within and meanings.holds(own + moved):
            said = _("{name} = {written} in the robot's data stands for {meant:.7g}")
            return said.format(name=name, written=one.text, meant=own + moved)
    return None
