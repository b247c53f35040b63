"""The examination: compare, try the readings, look for slips in the entries, rank what explains.

Nothing is named that does not account for every state to 1e-9; what accounts equally well is
named too, the simplest first.
"""

from __future__ import annotations

import gc
import math
from collections.abc import Iterator
from contextlib import contextmanager
from dataclasses import replace
from typing import Any

import numpy as np

from kinlab.arrays import Array, first_largest, seed_of, whole
from kinlab.check.compare import relative_errors, rows_alone
from kinlab.check.diagnosis import Cause, Diagnosis
from kinlab.check.quantities.registry import quantity as find_quantity
from kinlab.check.quantities.registry import split_name
from kinlab.check.quantities.serial import SERIAL
from kinlab.doctor import verdicts
from kinlab.doctor.changes import Case, entries
from kinlab.doctor.confusions.known import readings
from kinlab.doctor.confusions.tried import in_pairs, singly, the_formula
from kinlab.doctor.derivations.joined import (
    Found,
    Ready,
    likeliest,
    one_for_each_kind,
    ready,
    several_taken_otherwise,
    taken_at_one_joint,
    taken_otherwise,
)
from kinlab.doctor.derivations.parts import Apart, apart, proved
from kinlab.doctor.derivations.shown import shown
from kinlab.doctor.excuses import (
    covered_up,
    excused,
    for_another_arm,
    rounding_alone,
    texts_again,
    without_value,
)
from kinlab.doctor.numbers import other_numbers
from kinlab.doctor.program.words import WrongLines, behind, meant
from kinlab.doctor.slips import LIST, RIVALS, reading_and_slips, slips_in
from kinlab.doctor.solutions.verdict import judged
from kinlab.doctor.text.written import Written
from kinlab.doctor.verdicts import Excuse
from kinlab.errors import KinlabError, OptionError
from kinlab.host.language import _
from kinlab.tolerances import TOLERANCES

_NAMED = 8
"""Causes that are kept."""
LOUD = False
"""Whether a fault in the search through a program's lines is raised: the verdict rests on none."""
_SLIPS = 2
"""Slips in a function's values above which one number of the robot that is another is likelier."""
_FAR = 0.15
"""Cost beyond the likeliest cause's from which another of the same evidence is not told."""
_FETCHED = 1.35
"""Cost above which what explains a formula does not keep from looking at single joints."""
_OF_NUMBERS = {"number", "sign", "entries swapped", "rows swapped", "name", "index", "factor"}
"""Kinds of edits that may be of a program's numbers."""
_PLAIN = 1.1
"""Cost up to which one reading is likelier than two slips in a text."""


def examine(
    case: Case, hand: Any, engine: Array, quantity: str, name: str, written: dict[str, Written]
) -> Diagnosis:
    """Judges answers that are known already; ``written`` holds entries given as text.

    Raises:
        OptionError: the answers are not real numbers.
    """
    with _uncollected(), np.errstate(all="ignore"):  # what has no value is looked for, not told
        try:
            return _examined(case, hand, engine, quantity, name, written)
        except KinlabError:
            raise
        except Exception as problem:
            if LOUD or case.lines is None:
                raise
            fault = f"{type(problem).__name__}: {problem}"
        found = _examined(replace(case, lines=None), hand, engine, quantity, name, written)
        note = _("its lines were not looked through: a fault of kinlab's own ended that ({fault})")
        return replace(found, remarks=(*found.remarks, note.format(fault=fault)))


@contextmanager
def _uncollected() -> Iterator[None]:
    """A search makes many small things that no other part of the program holds: a fifth faster."""
    collects = gc.isenabled()
    gc.disable()
    try:
        yield
    finally:
        if collects:
            gc.enable()


def _examined(
    case: Case, hand: Any, engine: Array, quantity: str, name: str, written: dict[str, Written]
) -> Diagnosis:
    if case.quantity.read is not None:
        return judged(case, hand, engine, quantity, name, written)
    values = _read(hand, engine, name, quantity)
    case = replace(case, hand=values, again=case.again or texts_again(case, engine, written))
    same = values.shape == engine.shape
    errors = relative_errors(values, engine) if same else np.full(len(values), np.inf)
    worst = float(np.max(errors))
    label = case.quantity.domain.label(case.robot)
    if worst <= TOLERANCES.formula_agrees:
        hidden, gap, remarks = covered_up(case, engine, written)
        if gap > TOLERANCES.formula_agrees and not hidden:
            return _by_numbers_alone(case, engine, written, quantity, name, gap, remarks)
        right = Diagnosis(quantity, label, name, not hidden, max(worst, gap), tuple(hidden))
        rounded = tuple(dict.fromkeys(note for text in written.values() for note in text.rounded))
        form = "rounded" if rounded and not hidden else ""
        return replace(right, remarks=() if hidden else (*rounded, *remarks), form=form)
    case, excuse = excused(case, engine, written) if same else (case, None)
    near = excuse is not None and excuse.form == "near"
    sure: list[Cause] = []
    if near and not written:
        first = next(case.looked_through(engine, TOLERANCES.formula_agrees), None)
        if first is not None and first.excuse is not None:
            excuse, near = first.excuse, False
        elif first is not None:  # one line with which it is right leaves nothing to the digits
            sure = [*first.sure[:1]]
            excuse, near = (None, False) if sure else (excuse, near)
    if same and excuse is None:
        values, errors = case.hand, relative_errors(case.hand, engine)
        worst = float(np.max(errors))
    causes = sure
    partial: tuple[str, ...] = ()
    split: Apart | None = None
    if excuse is None and not sure:
        causes, partial, excuse, split = _explained(case, engine, written, worst)
    if excuse is not None and not near:
        right = Diagnosis(quantity, label, name, True, worst)
        return replace(right, form=excuse.form, remarks=excuse.remarks)
    if not same and (alone := rows_alone(values.shape, engine.shape, quantity)):
        said = _("to compare these rows alone, ask for {first} (the first) or {last} (the last)")
        partial = (said.format(first=repr(alone[0]), last=repr(alone[1])),)
    if not same and (other := _meant_instead(case)):
        said = _("it is right if {quantity} is meant: ask for that")
        partial = (said.format(quantity=repr(other)),)
    ranked = _ranked(causes)
    right_parts = proved(case, engine, split) if same and not ranked else ()
    off = verdicts.largest_share(case, engine) if same and not written else math.inf
    near = near or worst <= TOLERANCES.nearly_agrees or off <= TOLERANCES.nearly_throughout
    close = same and not ranked and not written and near
    if close:
        right_parts += verdicts.by_how_much(case, engine, off)
    return replace(
        _wrong(Diagnosis(quantity, label, name, False, worst), case, values, engine, errors),
        causes=tuple(ranked),
        partial=partial if not ranked else (),
        form="near" if close else "",
        proved=right_parts,
    )


def _wrong(found: Diagnosis, case: Case, values: Array, engine: Array, errors: Array) -> Diagnosis:
    """A diagnosis with its worst entry, and the state at which that is."""
    k = first_largest(errors)
    same = values.shape == engine.shape
    where, furthest = _worst(values, engine, k, case) if same else ("shape", ())
    return replace(
        found,
        worst_entry=where,
        worst_state={n: stack[k] for n, stack in case.arguments.items()},
        hand=values[(k, *furthest)],
        engine=engine[(k, *furthest)],
    )


def _by_numbers_alone(
    case: Case,
    engine: Array,
    written: dict[str, Written],
    quantity: str,
    name: str,
    gap: float,
    remarks: list[str],
) -> Diagnosis:
    """What is told of names that only this robot's numbers make right: l1 for 1/2."""
    label = case.quantity.domain.label(case.robot)
    wrong = Diagnosis(quantity, label, name, False, gap)
    other = for_another_arm(case, engine, written)
    if other is None:
        return replace(wrong, proved=tuple(remarks))
    there, right, texts = other
    return replace(
        _wrong(wrong, there, there.hand, right, relative_errors(there.hand, right)),
        causes=tuple(_ranked(_told(there, right, texts)[0])),
        proved=(_("it agrees with this robot's numbers, not with others"), *remarks),
    )


Explained = tuple[list[Cause], tuple[str, ...], Excuse | None, Apart | None]
"""Causes; sentences on single entries; an excuse; and, where nothing explains the formula by one
step, its kinds of term."""


def _explained(case: Case, engine: Array, written: dict[str, Written], worst: float) -> Explained:
    """What explains the difference, what is known of some entries, or why it is none.

    How a text with names is read must explain what it says of another arm, too: at one arm's
    numbers a lost square may come to a forgotten link.
    """
    told = _told(case, engine, written)
    found = _possible(case, engine, written, worst, told)
    found = [_with_formula(one, told[0]) for one in found[0]], *found[1:]
    doubtful = [one for one in found[0] if not any(one is known for known in told[0])]
    other = for_another_arm(case, engine, written) if doubtful else None
    if other is None:
        return found
    there, right, texts = other
    gap = float(np.max(relative_errors(there.hand, right)))
    again = _possible(there, right, texts, gap, _told(there, right, texts))[0]
    said = {one.sentence for one in again}
    kept = [x for x in found[0] if x.sentence in said or not any(x is one for one in doubtful)]
    return kept or told[0], *found[1:]


def _with_formula(cause: Cause, slips: list[Cause]) -> Cause:
    """A way of reading the whole with the right formula, where slips that come to it are known."""
    if cause.corrected or not slips or not slips[0].corrected:
        return cause
    return replace(cause, corrected=slips[0].corrected, typed=slips[0].typed)


Told = tuple[list[Cause], tuple[str, ...]]


def _told(case: Case, engine: Array, written: dict[str, Written]) -> Told:
    """Slips that stand in texts, and what is known of some entries."""
    same = written and case.hand.shape == engine.shape
    off = [e for e in entries(case, engine) if not e.agrees] if same else []
    try:
        return slips_in(case, off, written) if off else ([], ())
    except RecursionError:  # a sum of hundreds of terms
        return [], ()


def _possible(
    case: Case, engine: Array, written: dict[str, Written], worst: float, told: Told
) -> Explained:
    """What explains the difference at the arm's own numbers, beside what stands in the texts."""
    same = case.hand.shape == engine.shape
    silent = (without_value(case, engine) or rounding_alone(case)) if same else None
    tried = readings(case)
    signs = _bare_signs(case.hand) or _next_to_nothing(case.hand, engine)
    if signs:
        # bare signs agree by accident: no evidence for anything about the robot
        tried = [reading for reading in tried if reading.stage == "answer"]
        if engine.ndim == 1:  # of one entry, not even for rows that are exchanged
            tried = [reading for reading in tried if reading.kind == "sign"]
    partial: tuple[str, ...] = ()
    off = [e for e in entries(case, engine) if not e.agrees] if same else []
    causes: list[Cause] = [silent] if silent is not None else []
    if silent is None:
        causes, partial = [*told[0]], told[1]
    visible = bool(causes) and len(causes[0].kinds) <= 1
    # a formula that solves for accelerations holds no step of a recursion
    solved = bool(written) and case.quantity.name == "forward_dynamics"
    bare = signs and _bare_signs(engine)
    read = same and not written and (silent is not None or not bare)
    looking = case.looked_through(engine, _left(worst)) if read else iter(())
    program: WrongLines | None = next(looking, None)
    # so near, what leaves the numbers open is no cause: rounding would be laid into it
    near = read and verdicts.largest_share(case, engine) <= TOLERANCES.nearly_throughout
    if program is not None and program.excuse is not None:
        return [], (), program.excuse, None
    edited = _exactly(program.causes, worst) if program else []
    rough: list[Cause] = []
    ways: Ready = []
    if program and silent and not edited:  # two slips may leave no number
        edited = [c for more in looking for c in _exactly(more.causes, worst)]
    if program and edited and (silent or program.written_out or len(edited[0].kinds) > 1):
        return edited[:1], (), None, None  # with nothing more to be said of what that means
    if not visible:
        # a slip that stands in the text comes before any step of a derivation
        loose = case if written else replace(case, slack=_left(worst))
        ways = [] if (written and (causes or solved)) or signs else ready(case)

        def backed(found: list[Found]) -> list[Cause]:
            """Of a program's steps only those whose numbers it comes to; of formulas none."""
            if program is not None and program.written_out:
                return []
            numbers = None if program is None else program.numbers
            kept = [one for one in found if numbers is None or shown(one, case, numbers)]
            return [*map(_as_steps, kept)]

        if edited:  # what that may well mean
            likely = [reading for reading in tried if reading.cost <= _FETCHED]
            every = [*singly(loose, likely)]
            known = [c.cost for c in every if c.error_after <= TOLERANCES.formula_agrees]
            every += backed(likeliest(loose, ways, min([_FETCHED, *known])))
        else:
            every = [*singly(loose, tried), *backed(taken_otherwise(loose, ways))]
        exact = [c for c in every if c.error_after <= TOLERANCES.formula_agrees]
        if ways and program is None and all(cause.cost > _FETCHED for cause in exact):
            every += map(_as_steps, taken_at_one_joint(loose, ways))
            exact = [c for c in every if c.error_after <= TOLERANCES.formula_agrees]
        rough = [] if exact or near else _roughly(every, worst)
        if program is not None and not edited:
            limit = _PLAIN if program.written_out else _FETCHED
            if all(cause.cost > limit for cause in exact or rough):
                noise = None if exact or rough else verdicts.to_digits(case, engine)
                if noise is not None:
                    return [], (), noise, None
                # what is so near has no several slips but in its numbers, or such as leave nothing
                some = looking if not (near and program.stepping) else ()
                edited = [c for more in some for c in _exactly(more.causes, worst)]
                nothing = TOLERANCES.left_of_several
                edited = [
                    c
                    for c in edited
                    if not near or c.error_after <= nothing or _OF_NUMBERS >= {*c.kinds}
                ]
            elif exact and not program.written_out:
                # two lines may do it together, but of a convention, which is one thing; and a
                # number that is wrong, too, may do nothing as long as a frame is another
                whole = any("convention" in cause.kinds for cause in exact)
                for more in looking if program.odd or not whole else ():
                    two = [c for c in more.causes if len(c.kinds) <= _SLIPS and not whole]
                    hidden = behind(more, exact) if program.odd else []
                    edited = _exactly(hidden or two, worst)
        if program is not None and edited:
            read_so = [] if program.written_out else exact or rough
            plain = [cause for cause in read_so if cause.cost <= _FETCHED]
            return meant(edited, plain), (), None, None
        if program is not None:
            exact = [*map(_without_a_line, exact)]
        causes = _outranked(causes, exact)
        by_values = program is None or program.written_out
        if not written and by_values and off and (not causes or len(off) <= RIVALS):
            found, partial = slips_in(case, off, written)
            causes += [c for c in found if not near or "coefficient" not in c.kinds]
    # one number of the robot that is another may look like a slip in every term it stands in
    listed = all({*c.kinds} == {"coefficient"} or len(c.kinds) > _SLIPS for c in causes)
    if listed and same and not written and not signs:
        held = None if program is None else program.numbers
        changed = [] if near else list(other_numbers(case, held))
        causes = [*singly(case, changed)] or rough or causes
        excuse = None if causes else verdicts.to_digits(case, engine)
        if excuse is not None:
            return [], (), excuse, None
    if near:
        return causes, (), None, None
    split: Apart | None = None
    if not causes and not signs:
        split = apart(case)
        if not solved and (program is None or not program.written_out):
            slack = min(_left(worst), TOLERANCES.slips_leave)
            few = case if written else replace(case, slack=slack)
            found_ = one_for_each_kind(few, ways, split)
            found_ = found_ or several_taken_otherwise(few, ways, split)
            causes = _exactly([_as_steps(found) for found in found_], worst)
            if program is None:
                causes = causes or _exactly([*in_pairs(few, tried)], worst)
            else:  # which three steps, or two readings of the whole, fit by accident more often
                causes = [_without_a_line(one) for one in causes if len(one.kinds) <= _SLIPS]
    if not causes and signs:
        causes = [*in_pairs(case, tried)]
    if same and all(len(cause.kinds) > LIST for cause in causes):
        # beside a list of slips only the likeliest reading: each costs a search of its own
        likely = [r for r in tried if r.kind == "sign"] if causes else tried
        more = reading_and_slips(case, likely, engine)
        # of a program of which no line explains it a list of numbers says nothing
        causes += [x for x in more if program is None or len(x.kinds) <= _SLIPS]
    return causes, partial, None, split


def _left(worst: float) -> float:
    """The relative error that finite differences may leave once a slip of that size is undone."""
    most = min(TOLERANCES.finite_differences, TOLERANCES.left_of_slip * worst)
    return max(TOLERANCES.formula_agrees, most)


def _exactly(causes: list[Cause], worst: float) -> list[Cause]:
    """Explanations that leave nothing; where there are none, those that leave differences."""
    exact = [cause for cause in causes if cause.error_after <= TOLERANCES.formula_agrees]
    return exact or _roughly(causes, worst)


def _without_a_line(cause: Cause) -> Cause:
    """What explains a program of which no line was found that does it: something else may, too."""
    said = _("{slip}, or does what amounts to that: no line was found that does it")
    return replace(cause, sentence=said.format(slip=cause.sentence))


def _roughly(causes: list[Cause], worst: float) -> list[Cause]:
    """Explanations that leave what finite differences leave, and far less than was off."""
    near = [cause for cause in causes if cause.error_after <= _left(worst)]
    least = min((cause.error_after for cause in near), default=0.0)
    said = _("{slip} (what is left, {left:.0e}, is that of finite differences)")
    return [
        replace(cause, sentence=said.format(slip=cause.sentence, left=cause.error_after))
        for cause in near
        if cause.error_after <= 10 * least
    ]


def _ranked(causes: list[Cause]) -> list[Cause]:
    """The likeliest first, of each kind one; what is clearly more far-fetched is not told."""
    kinds: dict[tuple[str, ...], Cause] = {}
    for cause in sorted(causes, key=lambda c: c.cost):
        kinds.setdefault(cause.kinds, cause)
    kept = list(kinds.values())
    return [cause for cause in kept if cause.cost <= kept[0].cost + _FAR][:_NAMED]


def _as_steps(found: Found) -> Cause:
    return Cause(
        the_formula(step.sentence for step in found.steps),
        tuple(step.kind for step in found.steps),
        tuple("" if step.joint is None else f"joint {step.joint}" for step in found.steps),
        found.error,
        found.cost,
    )


def _outranked(slips: list[Cause], whole_: list[Cause]) -> list[Cause]:
    """Slips in the writer's line before a far-fetched reading; a plain one before many slips."""
    if not slips:
        return whole_
    plain = [cause for cause in whole_ if cause.cost <= _PLAIN and len(slips[0].kinds) > 1]
    return plain or slips


def prepare(
    robot: Any, plain: str, index: tuple[Any, ...], samples: int, seed: int
) -> tuple[Case, Array]:
    """The case of a comparison, without an answer yet, and what the engine says.

    Raises:
        NameUnknownError, OptionError: as :func:`kinlab.diagnose`.
    """
    samples, seed = whole(samples, "samples", 10), seed_of(seed)
    found = find_quantity(plain)
    mechanism = found.domain.load(robot)
    states = found.states(mechanism, int(samples), seed)
    arguments = dict(zip(found.arguments, states, strict=True))
    case = Case(mechanism, found, arguments, np.empty(0), index)
    return case, np.asarray(case.answer(()), dtype=float)


def _bare_signs(values: Array) -> bool:
    """Whether every number is -1, 0 or 1, to rounding."""
    signs = np.clip(np.nan_to_num(np.rint(values)), -1.0, 1.0)
    return bool(np.all(np.abs(values - signs) <= TOLERANCES.formula_agrees))


def _next_to_nothing(values: Array, engine: Array) -> bool:
    """Whether the answers are no more than what differences leave of the engine's."""
    size = TOLERANCES.finite_differences * float(np.max(np.abs(engine), initial=0.0))
    return bool(np.max(np.abs(values), initial=0.0) <= size)


_PARTS_OF = {
    "jacobian": ("planar_jacobian", "planar_jacobian[:2]", "jacobian[:3]", "jacobian[3:]"),
    "planar_jacobian": ("planar_jacobian[:2]", "jacobian", "jacobian[:3]"),
    "fk": ("fk[:3]", "fk[:3,3]", "fk[:3,:3]", "fk[:2,3]"),
    "planar_pose": ("fk", "fk[:3,3]", "fk[:2,3]"),
}
"""Quantities, or parts of them, that are handed in for others."""


def _meant_instead(case: Case) -> str:
    """The quantity that answers of another shape are; empty where they are none that is known."""
    if case.index or case.quantity.domain is not SERIAL:
        return ""
    for name in _PARTS_OF.get(case.quantity.name, ()):
        plain, index = split_name(name)
        try:
            there = replace(case, quantity=find_quantity(plain), index=index).answer(())
        except KinlabError:  # none of this arm: it is not planar
            continue
        same = there.shape == case.hand.shape
        if same and np.max(relative_errors(case.hand, there)) <= TOLERANCES.formula_agrees:
            return name
    return ""


def real(values: Any) -> np.ndarray[Any, Any]:
    """Complex answers without an imaginary part as real ones; others as they are."""
    found = np.asarray(values)
    return found.real if found.dtype.kind == "c" and not found.imag.any() else found


def _require_real(values: np.ndarray[Any, Any], name: str, quantity: str, engine: Array) -> None:
    one = values.flat[0] if values.size else None
    if values.dtype.kind == "O" and not isinstance(one, int | float | complex):
        shape = " x ".join(map(str, engine.shape[1:])) or 1
        raise OptionError(
            f"{name}: answered with a {type(one).__name__}; {quantity!r} is an array or a list of "
            f"{shape} real numbers"
        )
    if values.dtype.kind not in "iuf":
        raise OptionError(
            f"{name}: answered with dtype {values.dtype}; {quantity!r} is real numbers"
            + ("; give their real part: .real" if values.dtype.kind == "c" else "")
        )


def _read(hand: Any, engine: Array, name: str, quantity: str) -> Array:
    found = real(hand)
    _require_real(found, name, quantity, engine)
    values: Array = found.astype(float)
    if values.shape != engine.shape and values.size == engine.size:
        squeezed = [s for s in values.shape[1:] if s != 1]
        if squeezed == [s for s in engine.shape[1:] if s != 1]:
            return values.reshape(engine.shape)
    return values


def _worst(hand: Array, engine: Array, k: int, case: Case) -> tuple[str, tuple[int, ...]]:
    gap = np.abs(hand[k] - engine[k])
    gap = np.where(np.isfinite(gap), gap, np.inf)
    place = tuple(int(i) for i in np.unravel_index(first_largest(np.ravel(gap)), gap.shape))
    labels = {e.local: e.label for e in entries(case, engine)}
    return labels[place], place
