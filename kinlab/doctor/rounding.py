"""Rounded numbers: what a written number may stand for, and whether that explains a difference.

A number stands for anything within half a unit of its last digit. A formula is right with rounded
numbers only if there are numbers within those digits that give the engine's values at every state
to 1e-9, and each of them means something: a number of the robot, a product or sum of these, a
constant such as 1/3; or else it is the only number in its term, so that the engine's own
coefficient is what it stands for. Two numbers in one term that mean nothing excuse nothing: any
error could be laid between them.
"""

from __future__ import annotations

import math
from collections.abc import Iterator, Mapping
from dataclasses import dataclass, replace
from typing import Any

import numpy as np

from kinlab.arrays import Array
from kinlab.check.compare import error_sizes
from kinlab.check.quantities.serial import SERIAL
from kinlab.doctor.changes import Case
from kinlab.doctor.confusions.numbers import rounded_robots
from kinlab.doctor.confusions.robots import with_gravity
from kinlab.doctor.meanings import CLOSE, RODS, Meanings
from kinlab.doctor.written import Literal, Written, literal
from kinlab.formulas import tree
from kinlab.formulas.tree import Node
from kinlab.host.language import _
from kinlab.model.robot import Robot
from kinlab.tolerances import TOLERANCES

_STEPS = 12
_ROUGH = 0.03
"""Share of a function's answer that rounded constants may change: g = 10 is 2 %."""
_FREE = 120
"""Literals of one formula above which they are not fitted."""
_FITS = 200
"""Sets of numbers tried for one formula in which several numbers can share an error."""
# -------- Numbers of a text, within their digits


def stand_ins(
    text: Written, at: Mapping[str, Array], target: Array, scale: Array
) -> list[tuple[Literal, float]] | None:
    """Numbers within the digits of those written that give the wanted values at every state.

    Args:
        text: the formula.
        at: values of the robot's names, (N,) each.
        target: the values wanted, (N,).
        scale: what differences are relative to, (N,).

    Returns:
        The literals that must be other numbers, each with its number; None where none will do.
    """
    literals = text.literals
    inexact = [k for k, one in enumerate(literals) if one.half > 0]
    if not inexact or len(inexact) > _FREE:
        return None
    search = _Search(text, at, target, scale, Meanings.at(at))
    # numbers that are the robot's in full are exact
    rest = [k for k in inexact if search.meanings.parameter(literals[k].value) is None]
    groups: dict[str, list[int]] = {}
    for k in rest:
        groups.setdefault(literals[k].text, []).append(k)
    singly = [search.explained([members]) for members in groups.values()]
    found = [way for way in singly if way]
    if found:
        return min(found, key=lambda way: search.oddness(*way[0]))
    for ways in (list(groups.values()), [[k] for k in rest]):
        together = search.explained(ways) if len(ways) > 1 else None
        if together is not None:
            return together
    return None


@dataclass(eq=False)
class _Search:
    """Looks for numbers that explain a text's difference."""

    text: Written
    at: Mapping[str, Array]
    target: Array
    scale: Array
    meanings: Meanings
    left: int = _FITS

    def oddness(self, one: Literal, value: float) -> tuple[bool, int]:
        """Of several numbers that would do, the one that means something, and the roughest."""
        return self.meanings.named(value) == f"{value:.7g}", one.digits

    def explained(self, ways: list[list[int]]) -> list[tuple[Literal, float]] | None:
        """The literals that change, where each group moves as one within its digits, or None."""
        found = self._settled(ways, {}, False)
        return found if found is not None else self._settled(ways, {}, True)

    def _settled(
        self, ways: list[list[int]], fixed: Mapping[int, float], own: bool
    ) -> list[tuple[Literal, float]] | None:
        """The same with the values of some groups settled, by their first member.

        An error that could lie in either of two numbers is laid into neither unless all of them
        mean something, or the one is the robot's ``own`` number and the other its coefficient.
        """
        fitted = self._fitted(ways, fixed) if self.left > 0 else None
        self.left -= 1
        if fitted is None:
            return None
        numbers, loose = fitted
        if loose is None:
            return self._sound(ways, numbers, own or not fixed)
        one = self.text.literals[loose[0]]
        for value in (one.value, *self.meanings.around(one)):
            if not own or value == one.value or self.meanings.parameter(value) is not None:
                found = self._settled(ways, {**fixed, loose[0]: value}, own)
                if found is not None:
                    return found
        return None

    def _fitted(
        self, ways: list[list[int]], fixed: Mapping[int, float]
    ) -> tuple[Array, list[int] | None] | None:
        """All literals' numbers, and a group that the values leave undecided."""
        literals = self.text.literals
        start = np.array([one.value for one in literals])
        for members in ways:
            start[members] = fixed.get(members[0], literals[members[0]].value)
        free = [members for members in ways if members[0] not in fixed]
        reach = np.array([literals[members[0]].reach for members in free])
        moved = np.zeros(len(free))
        turned = np.zeros((len(self.target), len(free)))

        def numbers(share: Array) -> Array:
            out = start.copy()
            for members, size, part in zip(free, reach, share, strict=True):
                out[members] += size * part
            return out

        for _step in range(_STEPS):
            values = self.text.values(self.at, numbers(moved))
            rest = (self.target - values) / self.scale
            if not np.isfinite(rest).all():
                return None
            slopes = [
                (self.text.values(self.at, numbers(moved + 1e-3 * step)) - values)
                / (1e-3 * self.scale)
                for step in np.eye(len(free))
            ]
            turned = np.array(slopes).reshape(len(free), -1).T
            if not np.isfinite(turned).all():
                return None
            if not free or np.max(np.abs(rest)) <= 0.01 * TOLERANCES.formula_agrees:
                break
            moved = moved + np.linalg.lstsq(turned, rest, rcond=1e-10)[0]
            if np.max(np.abs(moved)) > 10.0:
                return None
        final = numbers(moved)
        gap = np.abs(self.target - self.text.values(self.at, final)) / self.scale
        fits = np.isfinite(gap).all() and float(np.max(gap)) <= TOLERANCES.formula_agrees
        within = not free or np.max(np.abs(moved)) <= 1.0 + TOLERANCES.same_relation
        if not fits or not within:
            return None
        return final, self._loose(free, turned)

    def _loose(self, free: list[list[int]], turned: Array) -> list[int] | None:
        """The group that can move most while others make up for it."""
        if len(free) < 2:
            return None
        _u, sizes, axes = np.linalg.svd(turned, full_matrices=True)
        rank = int(np.sum(sizes > TOLERANCES.same_relation * sizes[0])) if sizes[0] else 0
        share = np.sum(axes[rank:] ** 2, axis=0)
        # what changes nothing at all is no matter
        felt = np.max(np.abs(turned), axis=0) > TOLERANCES.no_effect
        share = np.where(felt, share, 0.0)
        k = int(np.argmax(np.round(share, 6)))
        return free[k] if share[k] > TOLERANCES.same_relation else None

    def _sound(
        self, ways: list[list[int]], numbers: Array, alone: bool
    ) -> list[tuple[Literal, float]] | None:
        """What changes, if every number means something or, as is allowed, is alone in its term."""
        literals = self.text.literals
        changed = [
            (literals[k], float(numbers[k]))
            for k in (members[0] for members in ways)
            if abs(numbers[k] - literals[k].value)
            > TOLERANCES.formula_agrees * abs(literals[k].value)
        ]
        if not changed or not all(self.meanings.credible(*pair) for pair in changed):
            return None
        bare = [
            k
            for k, one in enumerate(literals)
            if one.half > 0 and not self.meanings.holds(float(numbers[k]))
        ]
        if bare and not (alone and self._told_apart(bare, numbers)):
            return None
        return changed

    def _told_apart(self, bare: list[int], numbers: Array) -> bool:
        """Whether no error of one number could be another's: not of one term or one coefficient."""
        if len(bare) < 2:
            return True
        here = self.text.values(self.at, numbers)
        columns = []
        for k in bare:
            moved = numbers.copy()
            moved[k] += 1e-3 * self.text.literals[k].reach
            column = (self.text.values(self.at, moved) - here) / self.scale
            size = float(np.linalg.norm(column))
            if size == 0.0 or not np.isfinite(size):
                return False
            columns.append(column / size)
        return bool(np.linalg.matrix_rank(np.array(columns), TOLERANCES.same_relation) == len(bare))


def rounding_remarks(changed: list[tuple[Literal, float]], at: Mapping[str, Array]) -> list[str]:
    """Each rounded number once: ``9.8 stands for g = 9.81``."""
    form, meanings = _("{written} stands for {meant}"), Meanings.at(at)
    said = (form.format(written=one.text, meant=meanings.named(value)) for one, value in changed)
    return list(dict.fromkeys(said))


# -------- Numbers of a function, and of the robot's own data


def roundings(case: Case, engine: Array, function: bool) -> Iterator[tuple[str, ...]]:
    """Roundings in the robot's data, or of a function, that account for every state, in words."""
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
            exact = _angle(value)
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


def _angle(value: float) -> float | None:
    """The multiple of 15 degrees that an angle is, rounded; None where it is exact or none."""
    one = literal(f"{abs(value):.15g}")
    exact = round(value / (math.pi / 12)) * math.pi / 12
    gap = abs(value - exact)
    if not 0 < one.half <= 0.006 or gap <= 1e-14:
        return None
    return exact if gap <= one.half * (1 + TOLERANCES.same_relation) else None


def gravity_rounded(case: Case, engine: Array) -> tuple[str, ...] | None:
    """A function with another g that is the robot's rounded: 9.8, 10."""
    g = np.array(case.robot.model.gravity.linear)
    size = float(np.linalg.norm(g))
    if not size or case.hand.shape != engine.shape:
        return None
    none = replace(case, robot=with_gravity(case.robot, 0 * g)).answer(())
    weight, rest = engine - none, case.hand - none
    total = float(np.sum(weight * weight))
    if total <= 0:
        return None
    share = float(np.sum(weight * rest)) / total
    one = _decimal(share * size)
    if (
        one is None
        or share <= 0
        or abs(one.value - size) > one.reach * (1 + TOLERANCES.same_relation)
        or not same_values(rest, share * weight, engine)
    ):
        return None
    said = _("{written} stands for {meant}")
    return (said.format(written=f"g = {one.text}", meant=f"{size:.10g}"),)


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


def coefficients_rounded(mine: Array, theirs: Array, at: dict[str, Array]) -> list[str] | None:
    """Coefficients that are the derived ones to a few digits, in words, or None.

    Empty where they may be: their digits are not seen, as they are in a text, and 1.12 for 1.115
    may as well be a mass of 2.02.
    """
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


def _coefficient(one: float, two: float, meanings: Meanings) -> str | None:
    """How a coefficient is rounded: itself, or a third in front of a rod's m l²; "" if in doubt."""
    whole = short(one, two)
    if whole is not None and abs(one - two) <= TOLERANCES.nearly_agrees * abs(two):
        said = _("the coefficient {written} stands for {meant:.7g}")
        return said.format(written=whole.text, meant=abs(two))
    said = _("{written} stands for {meant}")
    for exact in RODS:
        for digits in range(2, 7):
            part = literal(np.format_float_positional(exact, digits, fractional=False, trim="-"))
            gap = abs(one - two) / abs(part.value - exact) if part.value != exact else 0.0
            if any(abs(rod - gap) <= TOLERANCES.same_relation * gap for rod in meanings.rods):
                return said.format(written=part.text, meant=meanings.named(exact))
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
