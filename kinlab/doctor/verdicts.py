"""Right in another way: with rounded numbers, with numbers for names, or another valid formula.

A number stands for anything within half a unit of its last digit. A formula is right with rounded
numbers only if there are numbers within those digits that give the engine's values at every state
to 1e-9: nothing that the digits do not explain is excused.
"""

from __future__ import annotations

import math
from collections.abc import Callable, Iterable, Iterator, Mapping
from dataclasses import dataclass, replace
from fractions import Fraction
from itertools import product
from typing import Any

import numpy as np

from kinlab.arrays import Array
from kinlab.check.compare import error_sizes
from kinlab.check.quantities.serial import SERIAL
from kinlab.doctor.changes import Case, table_of
from kinlab.doctor.confusions.numbers import rounded_robots
from kinlab.doctor.confusions.robots import with_gravity
from kinlab.doctor.derived import LETTERS, Derivation, derivation, searchable
from kinlab.doctor.regression import joint_functions
from kinlab.doctor.terms import AnswerEntry, anywhere, as_rods, entries, names_for
from kinlab.doctor.written import Literal, Written, literal
from kinlab.formulas import tree
from kinlab.formulas.tree import Node
from kinlab.host.language import _
from kinlab.model.robot import Robot
from kinlab.symbolic.trig import Poly
from kinlab.symbolic.vocabulary import vocabulary
from kinlab.tolerances import TOLERANCES

_STEPS = 12
_ROUNDS = 3
"""Sets of other numbers for the robot's parameters at which numbers for names must fit."""
_FREE = 120
"""Literals of one formula above which they are not fitted."""
_CLOSE = 0.025
"""Relative change up to which one digit is a rounding."""
_SIMPLE = 12
_UNITS = {"": 1.0, "pi": math.pi, "sqrt(2)": math.sqrt(2), "sqrt(3)": math.sqrt(3)}
CLOSE = 2e-3
"""Relative error up to which a function may be right with rounded constants inside."""
_SAME_DIGITS = 1e-4
"""Relative error below which a function that no slip explains is right to its digits: constants
of four digits and forward differences reach it, no term that is left out does."""
_ROUGH = 0.03
"""Share of the answer that rounded constants may change: g = 10 is 2 %."""
_ENERGIES = ("potential_energy", "lagrangian", "link_potential_energies")


@dataclass(frozen=True)
class Excuse:
    """Why a formula that is not the engine's, digit for digit, is right.

    Attributes:
        form: ``"rounded"``, ``"unusual"`` or ``"digits"``; ``""`` where there is only a remark.
        remarks: in plain words.
    """

    form: str
    remarks: tuple[str, ...]


# -------- Numbers within their digits


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
    # numbers that are the robot's in full are exact
    rest = [k for k in inexact if _parameter(literals[k].value, at) is None]
    groups: dict[str, list[int]] = {}
    for k in rest:
        groups.setdefault(literals[k].text, []).append(k)
    singly = [[members] for members in groups.values()]
    found = [way for way in (_stand_ins(text, at, target, scale, way) for way in singly) if way]
    if found:
        return min(found, key=lambda way: _oddness(way[0][0], way[0][1], at))
    for way in (list(groups.values()), [[k] for k in rest]):
        together = _stand_ins(text, at, target, scale, way) if len(way) > 1 else None
        if together is not None:
            return together
    return None


def _stand_ins(
    text: Written, at: Mapping[str, Array], target: Array, scale: Array, way: list[list[int]]
) -> list[tuple[Literal, float]] | None:
    found, literals = _fitted(text, at, target, scale, way), text.literals
    if found is None:
        return None
    changed = [
        (literals[members[0]], float(found[members[0]]))
        for members in way
        if abs(found[members[0]] - literals[members[0]].value)
        > TOLERANCES.formula_agrees * abs(literals[members[0]].value)
    ]
    return changed if changed and all(_credible(one, value, at) for one, value in changed) else None


def _oddness(one: Literal, value: float, at: Mapping[str, Array]) -> tuple[bool, int]:
    """Of several numbers that would do, the one that means something, and the roughest."""
    return _meant(value, at) == f"{value:.7g}", one.digits


def _fitted(
    text: Written,
    at: Mapping[str, Array],
    target: Array,
    scale: Array,
    way: list[list[int]],
) -> Array | None:
    """All literals' numbers where each group moves as one within its digits, or None."""
    literals = text.literals
    start = np.array([one.value for one in literals])
    halves = np.array([literals[members[0]].half for members in way])
    moved = np.zeros(len(way))

    def numbers(share: Array) -> Array:
        out = start.copy()
        for members, half, part in zip(way, halves, share, strict=True):
            out[members] += half * part
        return out

    for _step in range(_STEPS):
        values = text.values(at, numbers(moved))
        rest = (target - values) / scale
        if not np.isfinite(rest).all():
            return None
        if np.max(np.abs(rest)) <= 0.01 * TOLERANCES.formula_agrees:
            break
        slopes = [
            (text.values(at, numbers(moved + 1e-3 * step)) - values) / (1e-3 * scale)
            for step in np.eye(len(way))
        ]
        turned = np.array(slopes).T
        if not np.isfinite(turned).all():
            return None
        moved = moved + np.linalg.lstsq(turned, rest, rcond=1e-10)[0]
        if np.max(np.abs(moved)) > 10.0:
            return None
    final = numbers(moved)
    gap = np.abs(target - text.values(at, final)) / scale
    fits = np.isfinite(gap).all() and float(np.max(gap)) <= TOLERANCES.formula_agrees
    within = bool(np.max(np.abs(moved)) <= 1.0 + TOLERANCES.same_relation)
    return final if fits and within else None


def _credible(one: Literal, value: float, at: Mapping[str, Array]) -> bool:
    """Whether so few digits are a rounding at all: 0.3 may be 1/3, but is not 0.25."""
    if one.whole:
        return _parameter(value, at) is not None
    close = abs(value - one.value) <= _CLOSE * abs(value)
    fine = one.half < 0.01 or one.digits > 1
    endless = any(abs(value * k - round(value * k)) < TOLERANCES.same_relation for k in (3, 7, 9))
    return close or fine or endless


def _parameter(value: float, at: Mapping[str, Array]) -> str | None:
    for name, stack in at.items():
        if name[0] != "q" and abs(float(stack[0]) - value) <= TOLERANCES.same_relation * abs(value):
            return name
    return None


def _meant(value: float, at: Mapping[str, Array]) -> str:
    """A number as one would write it exactly: g = 9.81, 1/3, pi/2, sqrt(2)/2."""
    name = _parameter(value, at)
    if name is not None:
        return f"{name} = {float(at[name][0]):.10g}"
    for word, unit in _UNITS.items():
        found = Fraction(value / unit).limit_denominator(_SIMPLE)
        if found and abs(float(found) * unit - value) <= TOLERANCES.same_relation * abs(value):
            above = word or str(found.numerator)
            above = f"{found.numerator}*{word}" if word and found.numerator != 1 else above
            return above if found.denominator == 1 else f"{above}/{found.denominator}"
    return f"{value:.7g}"


def rounding_remarks(changed: list[tuple[Literal, float]], at: Mapping[str, Array]) -> list[str]:
    """Each rounded number once: ``9.8 stands for g = 9.81``."""
    form = _("{written} stands for {meant}")
    said = (form.format(written=one.text, meant=_meant(value, at)) for one, value in changed)
    return list(dict.fromkeys(said))


def together(pieces: Iterable[str]) -> str:
    """Pieces of formulas in a sentence: ``l1 = 0.5 and m2 = 1``."""
    told, *rest = [*pieces] or [""]
    pair = _("{first} and {last}")
    for piece in rest:
        told = pair.format(first=told, last=piece)
    return told


# -------- Numbers in place of names


def holds_with_other_numbers(
    text: Written,
    right: Callable[[Mapping[str, Array]], Array],
    states: Iterator[dict[str, Array]],
    own: Mapping[str, float],
) -> bool:
    """Whether the text is right for other robots too, once its numbers are those robots' numbers.

    Decimals may be anything; a whole number only the parameter that it equals: the 2 of ``l1/2``
    is a two, whatever else is 0.5.

    Args:
        text: the formula, which agrees at the robot's own numbers.
        right: the derived formula's values at any.
        states: sets of other numbers, with joint states.
        own: the robot's numbers.
    """
    literals = text.literals
    decimal = [k for k, one in enumerate(literals) if one.half > 0 and not one.whole]
    whole = {
        k: [name for name, x in own.items() if x == one.value]
        for k, one in enumerate(literals)
        if one.whole and one.value != 1 and not one.exponent
    }
    whole = {k: names for k, names in whole.items() if names}
    if (not decimal and not whole) or len(literals) > _FREE:
        return False
    choices = list(product(*([None, *names] for names in whole.values())))[:32]
    rounds = [next(states) for _ in range(_ROUNDS)]
    for choice in choices:
        put = {k: name for k, name in zip(whole, choice, strict=True) if name is not None}
        if not decimal and not put:
            continue
        if all(_free_fit(text, at, right(at), decimal, put) for at in rounds):
            return True
    return False


def _free_fit(
    text: Written, at: dict[str, Array], target: Array, free: list[int], put: dict[int, str]
) -> bool:
    numbers = np.array([one.value for one in text.literals])
    for k, name in put.items():
        numbers[k] = float(at[name][0])
    scale = float(np.max(np.abs(target))) or 1.0
    for _step in range(2 * _STEPS):
        values = text.values(at, numbers)
        rest = (target - values) / scale
        if not np.isfinite(rest).all():
            return False
        if np.max(np.abs(rest)) <= TOLERANCES.formula_agrees:
            return True
        if not free:
            return False
        slopes = []
        for k in free:
            step = 1e-5 * max(1.0, abs(numbers[k]))
            other = numbers.copy()
            other[k] += step
            slopes.append((text.values(at, other) - values) / (step * scale))
        turned = np.array(slopes).T
        if not np.isfinite(turned).all():
            return False
        numbers[free] += np.linalg.lstsq(turned, rest, rcond=1e-9)[0]
    return False


# -------- Valid formulas that are not the engine's


def unusual(case: Case, engine: Array, slack: float = 0.0) -> Excuse | None:
    """Another valid formula of the same thing: a C with the same C qd, a potential's other zero.

    Args:
        case: with the hand formula's answers, of the engine's shape.
        engine: the engine's answers.
        slack: relative error that finite differences may leave, beside rounding.
    """
    name, hand = case.quantity.name, case.hand
    if hand.shape != engine.shape or not np.isfinite(hand).all():
        return None
    if name == "coriolis_matrix" and len(case.index) <= 1:
        return _another_split(case, engine, slack)
    if name == "christoffel" and not case.index:
        symmetric = 0.5 * (hand + np.swapaxes(hand, 2, 3))
        if _same(symmetric, engine, engine, slack):
            said = _(
                "it is not symmetric in the last two indices, as Christoffel's symbols are; the "
                "sums over qd_j qd_k are the same"
            )
            return Excuse("unusual", (said,))
    if name in _ENERGIES:
        gap = hand - engine
        constant = gap[:1]
        if _same(gap, np.broadcast_to(constant, gap.shape), engine, slack):
            size = float(np.ravel(constant)[np.argmax(np.abs(np.ravel(constant)))])
            said = _(
                "the potential has another zero (the difference is {size:.6g} J everywhere), "
                "which changes no torque"
            )
            return Excuse("unusual", (said.format(size=size),))
    return None


def _another_split(case: Case, engine: Array, slack: float) -> Excuse | None:
    speeds = case.arguments["v"]
    torques = np.einsum("n...j,nj->n...", engine, speeds)
    if not _same(np.einsum("n...j,nj->n...", case.hand, speeds), torques, torques, slack):
        return None
    if case.index:
        return Excuse("unusual", (_("C*qd is right, but C is not Christoffel's"),))
    slope = engine + np.swapaxes(engine, 1, 2)  # Mdot
    rest = slope - case.hand - np.swapaxes(case.hand, 1, 2)
    skew = _same(rest, np.zeros_like(rest), slope, slack)
    if skew:
        said = _(
            "C*qd is right, but C is not Christoffel's: Mdot - 2C is skew-symmetric all the same"
        )
    else:
        said = _("C*qd is right, but C is not Christoffel's: Mdot - 2C is not skew-symmetric")
    return Excuse("unusual", (said,))


def _same(one: Array, two: Array, size: Array, slack: float = 0.0) -> bool:
    gap = np.max(np.abs((one - two).reshape(len(one), -1)), axis=1)
    return bool(np.max(gap / error_sizes(size)) <= max(slack, TOLERANCES.formula_agrees))


# -------- Functions, and the robot's own data, rounded


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
                meant = _meant(exact, {})
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


def short(value: float, against: float) -> Literal | None:
    """A number as few digits, where it is another number rounded: 9.8 of 9.81, 10 too.

    Args:
        value: what was used.
        against: what it should be.
    """
    one = _decimal(value)
    gap = abs(abs(value) - abs(against))
    if one is None or not 0 < gap <= one.half * (1 + TOLERANCES.same_relation):
        return None
    return one if one.digits > 1 or gap <= _CLOSE * abs(against) else None


def _decimal(value: float) -> Literal | None:
    """The few digits that a number has, or None."""
    for digits in range(1, 7):
        shown = f"{value:.{digits}g}"
        if abs(float(shown) - value) <= TOLERANCES.same_number * abs(value):
            return literal(f"{float(shown):.15g}".lstrip("-"))
    return None


def gravity_rounded(case: Case, engine: Array) -> Excuse | None:
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
    one = short(share * size, size) or _decimal(share * size)
    if (
        one is None
        or abs(one.value - size) > one.half * (1 + TOLERANCES.same_relation)
        or share <= 0
        or not _same(rest, share * weight, engine)
    ):
        return None
    said = _("{written} stands for {meant}")
    return Excuse("rounded", (said.format(written=f"g = {one.text}", meant=f"{size:.10g}"),))


def to_digits(error: float) -> Excuse | None:
    """A function that nothing explains, and that is right to so many digits that no slip is."""
    if error > _SAME_DIGITS:
        return None
    said = _("it agrees to {digits} digits: finite differences, or rounded constants?")
    return Excuse("digits", (said.format(digits=_digits(error)),))


def _digits(error: float) -> int:
    return max(1, math.floor(-math.log10(2 * error)))


def roundings(case: Case, engine: Array, function: bool) -> Iterator[Excuse]:
    """Roundings in the robot's data, or of a function, that account for every state."""
    if case.quantity.domain is not SERIAL:
        return
    full = exact_data(case.robot)
    if full is not None:
        answer = replace(case, robot=full[0]).answer(())
        if answer.shape == case.hand.shape and _same(case.hand, answer, engine):
            yield Excuse("rounded", full[1])
    if not function or case.hand.shape != engine.shape:
        return
    weighed = gravity_rounded(case, engine)
    if weighed is not None:
        yield weighed
    gap = np.where(np.isfinite(case.hand), np.abs(case.hand - engine), np.inf)
    few = case.few(2)
    if np.max(gap) > _ROUGH * np.max(np.abs(engine)):
        return
    for robot, said in rounded_robots(case.robot):
        other = replace(few, robot=robot)
        answer = other.answer(())
        if _same(few.hand, answer, engine[:2]) or gravity_rounded(other, answer):
            other = replace(case, robot=robot)
            answer = other.answer(())
            if _same(case.hand, answer, engine):
                yield Excuse("rounded", said)
            elif (also := gravity_rounded(other, answer)) is not None:
                yield Excuse("rounded", (*said, *also.remarks))


_ENDLESS = tuple(
    Fraction(k, n) for n in (3, 6, 7, 9, 11, 12) for k in range(1, 6) if math.gcd(k, n) == 1
)
_IRRATIONAL = tuple(
    k * unit for unit in (math.pi, math.sqrt(2), math.sqrt(3)) for k in (0.25, 1 / 3, 0.5, 1, 2, 3)
)


def coefficients_rounded(
    entry: AnswerEntry, words: list[Node], at: dict[str, Array]
) -> list[str] | None:
    """Coefficients of a function that are the derived ones to a few digits, or None.

    Args:
        entry: hand and engine at the states.
        words: the joint functions of the derived entry, each once.
        at: values of the names at the states.
    """
    both = _coefficients(entry, words, at)
    return None if both is None else _all_rounded(*both)


def _coefficients(
    entry: AnswerEntry, words: list[Node], at: dict[str, Array]
) -> tuple[Array, Array] | None:
    """The hand formula's and the engine's coefficients of the words, where they are all of it."""
    columns = np.array([np.broadcast_to(tree.evaluate(w, at), entry.hand.shape) for w in words]).T
    if 2 * columns.shape[1] > len(entry.hand) or np.linalg.matrix_rank(columns) < columns.shape[1]:
        return None
    mine, *_rest = np.linalg.lstsq(columns, entry.hand, rcond=None)
    theirs, *_rest = np.linalg.lstsq(columns, entry.engine, rcond=None)
    if entry.error(columns @ mine, entry.hand) > TOLERANCES.formula_agrees:
        return None
    return mine, theirs


def _all_rounded(mine: Array, theirs: Array) -> list[str] | None:
    said = []
    for one, two in zip(mine.tolist(), theirs.tolist(), strict=True):
        if abs(one - two) <= TOLERANCES.formula_agrees * max(np.max(np.abs(theirs)), 1e-12):
            continue
        found = _coefficient(one, two) if one * two > 0 else None
        if found is None:
            return None
        said.append(found)
    return list(dict.fromkeys(said)) or None


def _coefficient(one: float, two: float) -> str | None:
    for exact in (*map(float, _ENDLESS), *_IRRATIONAL):
        part = short(one / two * exact, exact)
        if part is not None and part.digits > 1:
            said = _("{written} stands for {meant}")
            return said.format(written=part.text, meant=_meant(exact, {}))
    whole = short(one, two)
    if whole is not None and not whole.whole:
        said = _("the coefficient {written} stands for {meant:.7g}")
        return said.format(written=whole.text, meant=abs(two))
    return None


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
    for name in sorted(tree.names(derived) - tree.names(text.node)):
        own = float(at[name][0]) if name[0] != "q" else 0.0
        one = literal(f"{abs(own):.15g}")
        if not 0 < one.half <= _CLOSE * abs(own):
            continue
        base = tree.evaluate(derived, at)
        slope = (tree.evaluate(derived, {**at, name: at[name] + one.half}) - base) / one.half
        size = float(np.sum(slope * slope))
        if size <= 0:
            continue
        moved = float(np.sum(slope * (hand - base))) / size
        gap = tree.evaluate(derived, {**at, name: at[name] + moved}) - hand
        fits = np.max(np.abs(gap) / scale) <= TOLERANCES.formula_agrees
        if fits and abs(moved) <= one.half * (1 + TOLERANCES.same_relation):
            said = _("{name} = {written} in the robot's data stands for {meant:.7g}")
            return said.format(name=name, written=one.text, meant=own + moved)
    return None


# -------- The same asked of one entry of a case


def numbers_at(case: Case) -> dict[str, Array]:
    """Values of every name of the robot at the case's states."""
    count = len(next(iter(case.arguments.values())))
    words = vocabulary(case.robot.table).values if case.robot.table is not None else {}
    at = {name: np.full(count, float(value)) for name, value in words.items()}
    for argument, stack in case.arguments.items():
        if argument in LETTERS:
            for i in range(case.robot.n):
                at[f"{LETTERS[argument]}{i + 1}"] = stack[:, i]
    return at


def elsewhere(
    text: Written, derived: Derivation, poly: Poly, arguments: tuple[str, ...]
) -> tuple[list[str], float]:
    """How a text that agrees at the robot's own numbers does at other ones.

    Returns:
        The names whose numbers it has in place of them, or that it must have with others; and
        the relative gap at other numbers, where nothing but a slip can be behind it.
    """
    if not searchable(poly):
        return [], 0.0
    names = names_for(derived, arguments)
    right = derived.tree(poly)
    states = (_one_robot(anywhere(names, seed), names.parameters) for seed in (11, 12, 13))
    at = as_rods(anywhere(names, 10), text, derived)
    target = np.broadcast_to(tree.evaluate(right, at), np.shape(next(iter(at.values()))))
    scale = float(np.max(np.abs(target))) or 1.0
    gap = float(np.max(np.abs(text.values(at) - target))) / scale
    if gap <= TOLERANCES.formula_agrees:
        return [], 0.0
    own = {name: float(value) for name, value in derived.arm.values.items()}
    whole = lambda x: tree.evaluate(right, dict(x))  # noqa: E731
    missing = tree.names(right) & set(names.parameters) - tree.names(text.node)
    if missing or holds_with_other_numbers(text, whole, states, own):
        return _kept(text, right, own, at, missing), 0.0
    plain = all(n.value.denominator <= 12 for _, n in tree.nodes(text.node) if n.op == "num")
    return [], gap if plain else 0.0


def _one_robot(at: dict[str, Array], parameters: tuple[str, ...]) -> dict[str, Array]:
    """The same numbers for the robot at every state."""
    return {n: np.full_like(x, x[0]) if n in parameters else x for n, x in at.items()}


def _kept(
    text: Written, right: Node, own: dict[str, float], at: dict[str, Array], missing: set[str]
) -> list[str]:
    """The names whose change the text does not follow."""
    count = len(next(iter(at.values())))
    here = {**at, **{name: np.full(count, value) for name, value in own.items()}}
    found = []
    for name in sorted(missing or own):
        moved = {**here, name: here[name] * 1.37 + 0.1}
        target = np.broadcast_to(tree.evaluate(right, moved), (count,))
        gap = np.max(np.abs(text.values(moved) - target))
        if gap > TOLERANCES.formula_agrees * (float(np.max(np.abs(target))) or 1.0):
            found.append(name)
    return found


def of_coefficients(case: Case, engine: Array) -> Excuse | None:
    """A function whose coefficients are the derived ones, rounded, in every entry; or None.

    Where the digits of each cannot be told (a sum of rounded numbers), it is right to digits.
    """
    table = table_of(case.robot)
    derived = derivation(table, case.quantity.name) if table is not None else None
    if derived is None:
        return None
    remarks: list[str] = []
    largest = 0.0
    for entry in entries(case, engine):
        if entry.agrees:
            continue
        found = _of_function(entry, derived, case)
        if found is None:
            return None
        remarks += found[0]
        largest = max(largest, found[1])
    if not largest:
        return Excuse("rounded", tuple(dict.fromkeys(remarks))) if remarks else None
    said = _("its coefficients agree to {digits} digits: finite differences, or rounded constants?")
    return Excuse("digits", (said.format(digits=_digits(largest)), *dict.fromkeys(remarks)))


def _of_function(
    entry: AnswerEntry, derived: Derivation, case: Case
) -> tuple[list[str], float] | None:
    """Rounded coefficients of a function's entry, in words; else how far they are off, relative."""
    poly = derived.polys[entry.index] if entry.index else derived.polys.item()
    if not searchable(poly) or not len(poly):
        return None
    right = derived.tree(poly)
    words = joint_functions([right], names_for(derived, case.quantity.arguments))
    both = _coefficients(entry, words, numbers_at(case))
    if both is None:
        return None
    told = _all_rounded(*both)
    if told is not None:
        return told, 0.0
    mine, theirs = both
    known = np.abs(theirs) > TOLERANCES.no_share * np.max(np.abs(theirs))
    with np.errstate(divide="ignore", invalid="ignore"):
        gap = float(np.max(np.abs(mine - theirs)[known] / np.abs(theirs)[known]))
    stray = np.max(np.abs(mine[~known]), initial=0.0)
    small = stray <= TOLERANCES.formula_agrees * np.max(np.abs(theirs))
    return ([], gap) if small and gap <= CLOSE else None


def of_data(text: Written, entry: AnswerEntry, derived: Derivation, case: Case) -> str | None:
    """The number of the robot's data that is rounded where the text is not, or None."""
    poly = derived.polys[entry.index] if entry.index else derived.polys.item()
    if not searchable(poly):
        return None
    at = numbers_at(case)
    return data_rounded(text, derived.tree(poly), at, entry.hand, entry.scale)
