"""Right in another way: with numbers for names, or another valid formula."""

from __future__ import annotations

import math
from collections.abc import Callable, Iterable, Iterator, Mapping
from dataclasses import dataclass, replace
from itertools import islice, product
from typing import Any, Protocol

import numpy as np

from kinlab.arrays import Array
from kinlab.check.compare import error_sizes, relative_errors
from kinlab.check.quantities.fivebar import FIVEBAR
from kinlab.doctor.changes import ANGLES, AnswerEntry, Case, entries, less_turns, table_of
from kinlab.doctor.derived import LETTERS, WRENCH, Derivation, derivation_of, searchable
from kinlab.doctor.entries.regression import joint_functions
from kinlab.doctor.entries.terms import as_rods, names_for
from kinlab.doctor.linkages import five_bar
from kinlab.doctor.linkages.looked_up import Reference
from kinlab.doctor.rounding import (
    coefficients,
    coefficients_rounded,
    data_rounded,
    gravity_rounded,
    same_values,
)
from kinlab.doctor.text.stand_ins import FITS, FREE, Numbered, fitted, rounding_remarks, stand_ins
from kinlab.doctor.text.written import Literal, Written
from kinlab.errors import KinlabError
from kinlab.formulas import tree
from kinlab.formulas.tree import Node
from kinlab.host.language import _
from kinlab.symbolic.vocabulary import vocabulary
from kinlab.tolerances import TOLERANCES

_ROUNDS = 3
"""Sets of other numbers for the robot's parameters at which numbers for names must fit."""
_CHOICES = 32
"""Ways in which whole numbers may be parameters that are tried."""
_FEW = 8
"""States at which the noise of a function is measured."""
_COORDINATES = 6
"""Of a twist."""
_DIGITS_LEFT = 100.0
"""Units of the last decimal that rounded answers reach at least."""
_NOTICED = 0.01
"""Part of a decimal that is seen beside it."""
ENERGIES = ("potential_energy", "lagrangian", "link_potential_energies")


@dataclass(frozen=True)
class Excuse:
    """Why a formula that is not the engine's, digit for digit, is right.

    Attributes:
        form: ``"rounded"``, ``"unusual"`` or ``"digits"``; ``""`` where there is only a remark;
            ``"near"`` of one that may be right, but need not.
        remarks: in plain words.
    """

    form: str
    remarks: tuple[str, ...]


# -------- Numbers in place of names


def holds_with_other_numbers(
    text: Written,
    right: Callable[[Mapping[str, Array]], Array],
    states: Iterator[dict[str, Array]],
    own: Mapping[str, float],
) -> bool | None:
    """Whether the text is right for other robots too, once its numbers are those robots' numbers.

    Decimals may be anything; a whole number only the parameter that it equals: the 2 of ``l1/2``
    is a two, whatever else is 0.5.

    Args:
        text: the formula, which agrees at the robot's own numbers.
        right: the derived formula's values at any.
        states: sets of other numbers, with joint states.
        own: the robot's numbers.

    Returns:
        None where there are too many numbers to ask which of them are the robots'.
    """
    literals = text.literals
    decimal = [k for k, one in enumerate(literals) if one.half > 0 and not one.whole]
    whole = {
        k: [name for name, x in own.items() if x == one.value]
        for k, one in enumerate(literals)
        if one.whole and one.value != 1 and not one.exponent
    }
    whole = {k: names for k, names in whole.items() if names}
    rounds = [next(states) for _ in range(_ROUNDS)]
    if all(_gap(text, at, right(at)) <= TOLERANCES.formula_agrees for at in rounds):
        return True
    if len(literals) > FREE:
        return None if decimal else False
    for choice in islice(product(*([None, *names] for names in whole.values())), _CHOICES):
        put = {k: name for k, name in zip(whole, choice, strict=True) if name is not None}
        if all(_fits(text, at, right(at), decimal, put) for at in rounds):
            return True
    return False


def _gap(text: Written, at: dict[str, Array], target: Array) -> float:
    """The largest difference of a text as it is from what is wanted, relative to that."""
    scale = float(np.max(np.abs(target))) or 1.0
    return float(np.max(np.abs(text.values(at) - target))) / scale


def _fits(
    text: Written, at: dict[str, Array], target: Array, free: list[int], put: dict[int, str]
) -> bool:
    numbers = np.array([one.value for one in text.literals])
    for k, name in put.items():
        numbers[k] = float(at[name][0])
    return fitted(text, at, target, free, numbers) is not None


# -------- Valid formulas that are not the engine's


def unusual(case: Case, engine: Array, slack: float = 0.0) -> Excuse | None:
    """Another valid formula of the same thing: a C with the same C qd, a potential's other zero.

    Args:
        case: with the hand formula's answers, of the engine's shape.
        engine: the engine's answers.
        slack: relative error that finite differences may leave, beside rounding.
    """
    hand = case.hand
    if hand.shape != engine.shape or not np.isfinite(hand).all():
        return None
    if case.quantity.name == "christoffel" and not case.index:
        symmetric = 0.5 * (hand + np.swapaxes(hand, 2, 3))
        if same_values(symmetric, engine, engine, slack):
            said = _(
                "it is not symmetric in the last two indices, as Christoffel's symbols are; the "
                "sums over qd_j qd_k are the same"
            )
            return Excuse("unusual", (said,))
    if case.quantity.name in ANGLES:
        turned, said_of_turns = without_turns(case, engine)
        if said_of_turns and same_values(turned.hand, engine, engine, slack):
            return Excuse("unusual", said_of_turns)
    if not any_other(case) or (slack and same_values(hand, engine, engine, slack)):
        return None  # what is the engine's but for noise is no other form
    mine, theirs = essential(case, hand), essential(case, engine)
    size = engine if case.quantity.name in ENERGIES else theirs
    same = same_values(mine, theirs, size, slack)
    return Excuse("unusual", (other_form(case, engine, slack),)) if same else None


def any_other(case: Case) -> bool:
    """Whether other answers are right, too, if what is :func:`essential` of them is the same."""
    split = case.quantity.name == "coriolis_matrix" and len(case.index) <= 1
    return split or case.quantity.name in ENERGIES


def essential(case: Case, answers: Array, which: Any = slice(None)) -> Array:
    """What is the same of all valid formulas: of a C its C qd, of a potential what it changes by.

    Args:
        case: the states.
        answers: the answers at some of them.
        which: those states.
    """
    if not any_other(case):
        return answers
    if case.quantity.name in ENERGIES:
        return np.asarray(answers - np.mean(answers, axis=0))
    rates: Array = np.einsum("n...j,nj->n...", answers, case.arguments["v"][which])
    return rates


def other_form(case: Case, engine: Array, slack: float) -> str:
    """In what answers are others that are as valid, in words.

    Args:
        case: with the answers.
        engine: the engine's.
        slack: relative error of what is essential in them.
    """
    if case.quantity.name in ENERGIES:
        size = _between_zeros(case, engine)
        if size is None:
            return _("the potential has another zero, which changes no torque")
        said = _(
            "the potential has another zero (the difference is {size:.6g} J everywhere), "
            "which changes no torque"
        )
        return said.format(size=size)
    said = _("C*qd is right, but C is not Christoffel's")
    if case.index or slack > TOLERANCES.finite_differences:
        return said
    slope = engine + np.swapaxes(engine, 1, 2)  # Mdot
    rest = slope - case.hand - np.swapaxes(case.hand, 1, 2)
    if same_values(rest, np.zeros_like(rest), slope, slack):
        return _(
            "C*qd is right, but C is not Christoffel's: Mdot - 2C is skew-symmetric all the same"
        )
    return _("C*qd is right, but C is not Christoffel's: Mdot - 2C is not skew-symmetric")


def _between_zeros(case: Case, engine: Array) -> float | None:
    """The constant by which a potential differs, by the writer's own numbers; None of no single."""
    off = case.hand - engine
    if off.ndim > 1:
        middle = np.ravel(np.median(off, axis=0))
        return float(middle[np.argmax(np.abs(middle))])
    size = float(np.max(np.abs(engine)))
    if np.ptp(off) <= TOLERANCES.finite_differences * size:
        return float(np.median(off))
    derived = derivation_of(case)
    poly = None if derived is None else derived.entry(case.index)
    if derived is None or not searchable(poly):
        return None
    words = joint_functions([derived.tree(poly)], names_for(derived, case.quantity.arguments))
    at = numbers_at(case)
    columns = [np.broadcast_to(tree.evaluate(word, at), off.shape) for word in words]
    columns = [np.ones(off.shape), *(one for one in columns if np.ptp(one) > 0)]
    matrix = np.array(columns).T
    shares, *_rest = np.linalg.lstsq(matrix, off, rcond=None)
    fits = np.max(np.abs(matrix @ shares - off)) <= TOLERANCES.formula_agrees * size
    return float(shares[0]) if fits else None


def weighed_otherwise(case: Case, engine: Array) -> Excuse | None:
    """A potential or a Lagrangian that is worked out with g rounded, of any zero."""
    if case.quantity.name not in ENERGIES:
        return None
    if (said := gravity_rounded(case, engine, whole=False)) is not None:
        return Excuse("rounded", said)
    said = gravity_rounded(case, engine, whole=False, any_zero=True)
    return Excuse("unusual", (other_form(case, engine, 0.0), *said)) if said else None


# -------- The same asked of one entry of a case


def numbers_at(case: Case) -> dict[str, Array]:
    """Values of every name of the robot at the case's states."""
    if case.quantity.domain is FIVEBAR:
        return five_bar.values_at(case.robot, case.quantity, case.arguments, case.index)  # type: ignore[arg-type]
    count = len(next(iter(case.arguments.values())))
    table = table_of(case.robot)
    words = vocabulary(table).values if table is not None else {}
    at = {name: np.full(count, float(value)) for name, value in words.items()}
    for argument, stack in case.arguments.items():
        if argument in LETTERS:
            for i, column in enumerate(stack.T):
                at[f"{LETTERS[argument]}{i + 1}"] = column
        if argument == "tau":
            at |= {f"tau{i + 1}": column for i, column in enumerate(stack.T)}
        if argument == "wrench":
            at |= dict(zip(WRENCH, stack.T, strict=True))
    return at


def elsewhere(
    text: Written, derived: Reference, poly: Any, arguments: tuple[str, ...], turns: bool = False
) -> tuple[list[str], float]:
    """How a text that agrees at the robot's own numbers does at other ones.

    Args:
        text: the formula.
        derived, poly: what is right, and of it this entry.
        arguments: what the quantity depends on.
        turns: whether a whole turn more or less is the same.

    Returns:
        The names whose numbers it has in place of them, or that it must have with others; and
        the relative gap at other numbers, where a slip is behind it, if one can be told.
    """
    if not searchable(poly):
        return [], 0.0
    names = names_for(derived, arguments)
    right = derived.tree(derived.held(poly, tree.names(text.node)))
    states = [derived.another(seed) for seed in (11, 12, 13)]
    at = as_rods(derived.anywhere(10), text, derived)

    def whole(at: Mapping[str, Array]) -> Array:
        found = np.asarray(tree.evaluate(right, dict(at)))
        return less_turns(found, text.values(at)) if turns else found

    gap = _gap(text, at, whole(at))
    if gap <= TOLERANCES.formula_agrees:
        return [], 0.0
    own = {name: float(value) for name, value in derived.values.items()}
    missing = tree.names(right) & set(names.parameters) - tree.names(text.node)

    def held(at: dict[str, Array]) -> dict[str, Array]:
        return {n: np.full_like(x, own[n]) if n in missing else x for n, x in at.items()}

    def rods(at: dict[str, Array]) -> dict[str, Array]:
        return as_rods(held(at), text, derived)

    # what has no name in the text may be there as a number, or be a rod's
    known = True
    for there in (dict, held, rods) if missing else (dict,):
        holds = holds_with_other_numbers(text, whole, map(there, states), own)
        if holds:
            return _kept(text, right, own, at, missing, derived), 0.0
        known = known and holds is not None
    plain = all(n.value.denominator <= 12 for _, n in tree.nodes(text.node) if n.op == "num")
    told = gap if plain and known else 0.0
    # a linkage with other lengths may not close, or close the other way
    serial = isinstance(derived, Derivation)
    told_of = bool(missing) or (bool(told) and serial)
    return _kept(text, right, own, at, missing, derived) if told_of else [], told


def unnamed(text: Written | None, derived: Reference, poly: Any) -> set[str]:
    """The robot's numbers in a derived entry that a text has no name for."""
    if text is None or not searchable(poly):
        return set()
    right = derived.tree(derived.held(poly, tree.names(text.node)))
    return tree.names(right) & {*derived.parameters} - tree.names(text.node)


def _kept(
    text: Written,
    right: Node,
    own: dict[str, float],
    at: dict[str, Array],
    missing: set[str],
    derived: Reference,
) -> list[str]:
    """The names whose change the text does not follow."""
    count = len(next(iter(at.values())))
    here = {**at, **{name: np.full(count, value) for name, value in own.items()}}
    found = []
    # of a rod the moment follows its mass and length, which moved alone would seem to be held
    rods = any(name[0] == "I" for name in missing)
    for name in sorted(missing if rods else own):
        moved = derived.but_for(name, here)
        target = np.asarray(tree.evaluate(right, moved))
        gap = np.max(np.abs(text.values(moved) - target))
        if gap > TOLERANCES.formula_agrees * (float(np.max(np.abs(target))) or 1.0):
            found.append(name)
    return found


def by_differences(case: Case, engine: Array) -> Excuse | None:
    """A function with the noise of differences, nearer the engine than any slip leaves it."""
    error, size = _own_error(case, engine)
    near = error <= TOLERANCES.slips_leave and _takes_differences(case, size)
    return of_digits(error) if near else None


def answers_rounded(case: Case, engine: Array) -> Excuse | None:
    """A function whose answers are the engine's, rounded to so many decimals."""
    size = float(np.max(np.abs(engine)))
    if case.hand.shape != engine.shape or not np.isfinite(case.hand).all():
        return None
    for places in range(2, 10):
        unit = 10.0**-places
        if size < _DIGITS_LEFT * unit:
            continue
        if TOLERANCES.same_number * size > _NOTICED * unit:
            return None  # any answer would be as near to so fine a decimal
        off = np.abs(np.round(case.hand / unit) * unit - case.hand)
        if float(np.max(off)) > TOLERANCES.same_number * size:
            continue
        near = np.abs(case.hand - engine) <= 0.5 * unit * (1 + TOLERANCES.formula_agrees)
        said = _("its answers are rounded to {places} decimals").format(places=places)
        return Excuse("rounded", (said,)) if np.all(near) else None
    return None


def answers_to_digits(case: Case, engine: Array) -> Excuse | None:
    """A function whose answers are the engine's, rounded to so many significant digits."""
    if case.hand.shape != engine.shape or not np.isfinite(case.hand).all():
        return None
    sizes = np.abs(engine)
    places = np.floor(np.log10(np.where(sizes > 0.0, sizes, 1.0)))
    for digits in range(2, 9):
        units = 10.0 ** (places - digits + 1)
        off = np.abs(np.round(case.hand / units) * units - case.hand)
        if np.all(off <= TOLERANCES.same_number * sizes):
            near = np.abs(case.hand - engine) <= 0.5 * units * (1 + TOLERANCES.same_relation)
            said = _("its answers are rounded to {digits} significant digits")
            return Excuse("rounded", (said.format(digits=digits),)) if np.all(near) else None
    return None


def without_turns(case: Case, engine: Array) -> tuple[Case, tuple[str, ...]]:
    """Answers without the whole turns by which an angle is off, and what is said of these."""
    hand = case.hand
    if case.quantity.name not in ANGLES or hand.shape != engine.shape:
        return case, ()
    turned = less_turns(hand, engine)
    if not np.isfinite(turned).all() or np.array_equal(turned, hand):
        return case, ()
    said = _("the angle differs by whole turns (2*pi) in places: it is the same angle")
    return replace(case, hand=turned), (said,)


def _own_error(case: Case, engine: Array) -> tuple[float, float]:
    """The largest error relative to its entry's own largest value, and the largest value."""
    gap, own = (np.max(np.abs(x), axis=0) for x in (case.hand - engine, engine))
    most = float(np.max(own))
    error = float(np.max(gap / np.where(own > TOLERANCES.formula_agrees * most, own, most)))
    return error, most


def largest_share(case: Case, engine: Array) -> float:
    """The largest error of what is essential, by the largest value of its own entry."""
    if case.hand.shape != engine.shape or not np.isfinite(case.hand).all():
        return math.inf
    own = replace(case, hand=essential(case, case.hand))
    return _own_error(own, essential(case, engine))[0]


def by_how_much(case: Case, engine: Array, share: float) -> tuple[str, ...]:
    """Of a function that is nearly right, how nearly, and what that may be."""
    if not share <= TOLERANCES.nearly_throughout:
        return ()
    other = max(relative_errors(case.hand, engine)) > TOLERANCES.may_be_rounded
    said = _(
        "no entry is off by more than {share:.2g} % of its largest value: the step of a "
        "difference, single precision, a series or a table, numbers of few digits, or a small slip"
    ).format(share=100 * share)
    return (*([other_form(case, engine, share)] if other and any_other(case) else ()), said)


def to_digits(case: Case, engine: Array) -> Excuse | None:
    """A function that nothing explains, and whose differences from the engine are its rounding.

    Either each entry has so many digits right, by its own largest value, that no slip is so small
    (one per cent of a small inertia is no digit of a large arm's mass matrix, but it is one per
    cent of the entry where it stands alone); or the function has the noise of differences.
    """
    error, most = _own_error(case, engine)
    noisy = error <= TOLERANCES.coefficient_digits and _takes_differences(case, most)
    if not noisy and not error <= TOLERANCES.slips_leave:
        return None
    return of_digits(error)


def of_digits(error: float) -> Excuse:
    """The excuse of a function that is right to the digits of its constants."""
    said = _(
        "it agrees to {digits} digits: finite differences, single precision, or rounded numbers?"
    )
    return Excuse("digits", (said.format(digits=_digits(error)),))


def _takes_differences(case: Case, size: float) -> bool:
    """Whether a function has more noise than its own arithmetic: a derivative by differences.

    Over steps of 1e-8 rad a smooth function is straight to 1e-16 of its size; one that divides a
    difference by its step h carries the rounding of what it subtracts, divided by h.
    """
    if case.again is None or "q" not in case.arguments:
        return False
    few = {name: stack[:_FEW] for name, stack in case.arguments.items()}
    before, at, after = (
        np.asarray(case.again({**few, "q": few["q"] + k * TOLERANCES.noise_step}))
        for k in (-1, 0, 1)
    )
    noise = float(np.max(np.abs(before - 2.0 * at + after)))
    return noise > TOLERANCES.noise_of_differences * size


def erratic(case: Case) -> str | None:
    """What is wrong with a function whose answer is rounding alone, or None.

    A step of 1e-13 rad changes a formula by 1e-13 of its size and what inverts a singular matrix as
    a whole.
    """
    if case.again is None or "q" not in case.arguments:
        return None
    few = {name: stack[:_FEW] for name, stack in case.arguments.items()}
    with np.errstate(all="ignore"):
        try:
            at, near = (
                np.asarray(case.again({**few, "q": few["q"] + k * TOLERANCES.least_step}))
                for k in (0, 1)
            )
        except (KinlabError, np.linalg.LinAlgError):
            return None
    flat = at.reshape(len(at), -1)
    change = np.max(np.abs(near.reshape(flat.shape) - flat), axis=1)
    known = np.isfinite(change)
    if not known.any():
        return None
    size = np.max(np.abs(flat[known]), axis=1)
    if np.median(change[known] / np.where(size, size, 1.0)) < TOLERANCES.erratic:
        return None
    if case.quantity.name == "least_rates" and case.robot.n > _COORDINATES:
        return _(
            "what the formula gives is rounding alone: it inverts a singular matrix. J^T J has no "
            "inverse where there are more joints than coordinates; J^T (J J^T)^-1 is meant, not "
            "(J^T J)^-1 J^T"
        )
    return _(
        "what the formula gives is rounding alone: it inverts a singular matrix, or divides by "
        "what is zero"
    )


def _digits(error: float) -> int:
    return max(1, math.floor(-math.log10(2 * error)))


def of_coefficients(case: Case, engine: Array) -> Excuse | None:
    """A function whose coefficients are the derived ones, rounded, in every entry; or None.

    Where the digits of each cannot be told, it is right to four digits or more, or ``"near"``.
    """
    derived = derivation_of(case)
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
    said = _(
        "its coefficients agree to {digits} digits: finite differences, single precision, or "
        "rounded numbers?"
    )
    return Excuse(
        "digits" if largest <= TOLERANCES.coefficient_digits else "near",
        (said.format(digits=_digits(largest)), *dict.fromkeys(remarks)),
    )


class Answering(Numbered, Protocol):
    """What has answers whose values are what is :func:`essential` of them, one after the other."""

    def answers(self, at: Mapping[str, Array], numbers: Array | None = None) -> Array:
        """Its answers at all states where the numbers are others; NaN where it has none."""


def by_digits(
    formula: Answering, case: Case, engine: Array, which: Any = slice(None), fits: int = FITS
) -> Excuse | None:
    """Why a formula is right, and what its numbers stand for, if those are all that is off.

    Args:
        formula: texts, or a program.
        case: the states, and its answers.
        engine: the engine's answers.
        which: the states at which its values are.
        fits: sets of numbers that may be tried.
    """
    wanted = essential(case, engine[which], which)
    at = numbers_at(case)
    scale = np.repeat(error_sizes(wanted), wanted[0].size)
    found = stand_ins(formula, at, wanted.ravel(), scale, fits, case.hand.ndim == 1)
    if found is None:
        return None
    meant = replace(case, hand=formula.answers(at, found.numbers))
    return rounded_otherwise(meant, engine, rounding_remarks(found.changed, at), own=case)


def rounded_otherwise(
    meant: Case,
    engine: Array,
    rounded: Iterable[str],
    slack: float = 0.0,
    own: Case | None = None,
) -> Excuse | None:
    """The excuse of rounded numbers, if what they stand for is right, or another valid form.

    Args:
        meant: the answers with the numbers that are meant.
        engine: the engine's answers.
        rounded: what the numbers stand for, in words.
        slack: relative error that finite differences may leave.
        own: the answers with the writer's own numbers.
    """
    if np.max(relative_errors(meant.hand, engine)) <= max(TOLERANCES.formula_agrees, slack):
        return Excuse("rounded", tuple(rounded))
    odd = unusual(meant, engine, slack)
    if odd is not None and own is not None and own.quantity.name in ENERGIES:
        odd = replace(odd, remarks=(other_form(own, engine, slack),))
    return odd and replace(odd, remarks=(*odd.remarks, *rounded))


def of_bare_numbers(
    text: Written, entry: AnswerEntry, derived: Derivation, case: Case
) -> list[str] | None:
    """Rounded coefficients of a text without any of the robot's names, in words."""
    if not tree.names(text.node).isdisjoint(derived.parameters):
        return None
    shown = [one for one in text.literals if not one.exponent]
    found = _of_function(entry, derived, case, shown)
    return found[0] or None if found is not None else None


def _of_function(
    entry: AnswerEntry, derived: Derivation, case: Case, shown: Iterable[Literal] = ()
) -> tuple[list[str], float] | None:
    """Rounded coefficients of a function's entry, in words; else how far they are off, relative."""
    poly = derived.entry(entry.index)
    if not searchable(poly) or not len(poly):
        return None
    right = derived.tree(poly)
    words = joint_functions([right], names_for(derived, case.quantity.arguments))
    at = numbers_at(case)
    both = coefficients(entry.hand, entry.engine, entry.scale, words, at)
    if both is None:
        return None
    told = coefficients_rounded(*both, at, shown)
    if told:
        return told, 0.0
    mine, theirs = both
    size = float(np.max(np.abs(theirs)))
    known = np.abs(theirs) > TOLERANCES.no_share * size
    gap = float(np.max(np.abs(mine - theirs)[known] / np.abs(theirs)[known]))
    if told is not None:
        return [], gap
    stray = float(np.max(np.abs(mine[~known]), initial=0.0))
    return (
        ([], gap)
        if stray <= TOLERANCES.formula_agrees * size and gap <= TOLERANCES.nearly_agrees
        else None
    )


def of_data(text: Written, entry: AnswerEntry, derived: Derivation, case: Case) -> str | None:
    """The number of the robot's data that is rounded where the text is not, or None."""
    poly = derived.entry(entry.index)
    if not searchable(poly):
        return None
    at = numbers_at(case)
    return data_rounded(text, derived.tree(poly), at, entry.hand, entry.scale)
