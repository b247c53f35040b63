"""Joint positions as text, line by line: each judged with right values for the joints it stands on.

A line that is right by itself has no slip in it, whatever its joint comes to where another line is
wrong. In a line that is not, numbers are looked at first: rounded ones, and one that is off.
"""

from __future__ import annotations

import re
from dataclasses import dataclass, replace

import numpy as np

from kinlab.arrays import Array
from kinlab.check.diagnosis import Cause
from kinlab.doctor.changes import Case
from kinlab.doctor.derivations.walk import Step
from kinlab.doctor.solutions.closed_forms import closed_forms, compared, slides
from kinlab.doctor.text.joints import named_values
from kinlab.doctor.text.meanings import Meanings, stands_for
from kinlab.doctor.text.stand_ins import FREE, fitted, rounding_remarks, stand_ins, told_apart
from kinlab.doctor.text.written import Written
from kinlab.formulas import tree
from kinlab.formulas.record import SIDES
from kinlab.formulas.text import words_in
from kinlab.host.language import _
from kinlab.symbolic.vocabulary import vocabulary
from kinlab.tolerances import TOLERANCES

_JOINT = re.compile(r"q\d")
_FEWEST = 10
"""Targets at which a line must have a value."""


@dataclass(frozen=True)
class LineStudy:
    """What the lines are by themselves.

    Attributes:
        right: joints, from 1, whose line is right.
        rounded: what is to be said of lines that are right with rounded numbers.
        off: lines with a number that is off, as causes.
        unknown: joints whose line is neither.
        numbers: joints of lines that are not right and have numbers in place of every name.
    """

    right: frozenset[int]
    rounded: tuple[str, ...]
    off: tuple[Cause, ...]
    unknown: frozenset[int]
    numbers: frozenset[int]

    @property
    def order(self) -> tuple[int, int, int]:
        """The best comes first: nothing unknown, little off, little rounded."""
        return len(self.unknown), len(self.off), len(self.rounded)


def studied(case: Case, written: dict[str, Written]) -> LineStudy | None:
    """The lines beside the branch that they fit best; None where the arm has no closed form.

    Args:
        case: of a quantity of inverse kinematics.
        written: the text of every joint, by its place.
    """
    n, name = case.robot.n, case.quantity.name
    texts = [written[f"{name}[{k}]"] for k in range(n)]
    used = {word for text in texts for word in tree.names(text.node)}
    joints = {text.entry for text in texts}
    texts = [
        replace(t, symbols={w: x for w, x in t.symbols.items() if w not in joints}) for t in texts
    ]
    sides = [side for side in SIDES if side in used]
    rows = [
        _beside_branches(case, texts, dict.fromkeys(sides, sign))
        for sign in ((1.0, -1.0) if sides else (1.0,))
    ]
    known = [row for row in rows if row is not None]
    if len(known) < len(rows) or not known:
        return None
    # of two solutions by one text the worse says what is wrong with it
    return max(known, key=lambda row: row.order)


def _beside_branches(case: Case, texts: list[Written], sides: dict[str, float]) -> LineStudy | None:
    found = [
        _beside(case, texts, sides, one, q)
        for form in closed_forms(case, False)
        for one, _at in form
        if len(q := one.quantity.engine.joints(one.arguments)) >= _FEWEST  # type: ignore[attr-defined]
    ]
    return min(found, key=lambda study: study.order, default=None)


def _beside(
    case: Case, texts: list[Written], sides: dict[str, float], one: Case, q: Array
) -> LineStudy:
    """The lines where the other joints have a branch's values."""
    plain = named_values(one, sides)
    right, off, unknown, rounded, numbers = set(), [], set(), [], set()
    words = set(vocabulary(case.robot.table).values) if case.robot.table is not None else set()
    for k, text in enumerate(texts):
        at = plain | {f"q{j + 1}": q[:, j] for j in range(len(texts)) if j != k}
        values = text.values(at)
        if np.max(_apart(one, values, q, k)) <= TOLERANCES.same_branch:
            right.add(k + 1)
            continue
        if not _words(text) & words and any(number.half > 0 for number in text.literals):
            numbers.add(k + 1)
        turns = np.round((values - q[:, k]) / (2 * np.pi)) * (0 if slides(case.robot)[k] else 1)
        line = _Line(text, at, values, one, q, k)
        told, cause = line.rounded(q[:, k] + 2 * np.pi * turns), None
        for target in () if told else (q[:, k], q[:, k] + 2 * np.pi * turns):
            if cause is None:
                told, cause = line.off(target)
        rounded += told
        if cause is not None:
            off.append(cause)
        elif not told:
            unknown.add(k + 1)
    return LineStudy(
        frozenset(right),
        tuple(dict.fromkeys(rounded)),
        tuple(off),
        frozenset(unknown),
        frozenset(numbers),
    )


def _words(text: Written) -> set[str]:
    """The names in a text, also in what its own names stand for."""
    found: set[str] = set()
    waiting = [text.text]
    while waiting:
        for word in {*words_in(waiting.pop())} - found:
            found.add(word)
            waiting += [text.symbols[word]] if word in text.symbols else []
    return found | {str(text.known[word].value) for word in found & set(text.known)}


def _apart(one: Case, values: Array, q: Array, k: int) -> Array:
    """How far values of a joint are from a branch's, (N,), without whole turns."""
    rows = q.copy()
    rows[:, k] = values
    gap: Array = np.max(np.abs(compared(one.robot, rows) - compared(one.robot, q)), axis=1)
    return gap


@dataclass(frozen=True, eq=False)
class _Line:
    """A line that is not right, with its values and a branch's.

    Attributes:
        text: the line.
        at: values of all names at the targets.
        values: the line's.
        one, q, k: the branch's case, its joint positions, and which of them is the line's.
    """

    text: Written
    at: dict[str, Array]
    values: Array
    one: Case
    q: Array
    k: int

    def rounded(self, target: Array) -> list[str]:
        """What is to be said of numbers that are only rounded; empty where that is not all."""
        # the last targets are near a singular pose, where a rounded acos may have no value
        few = np.arange(len(target)) < len(target) // 2
        if not np.isfinite(self.values[few]).all():
            return []
        at = {word: x[few] for word, x in self.at.items()}
        scale = np.full(int(few.sum()), np.max(np.abs(target[few])))
        meant = stand_ins(self.text, at, target[few], scale)
        right = meant is not None and self._right(meant.numbers)
        return rounding_remarks(meant.changed, at) if meant is not None and right else []

    def off(self, target: Array) -> tuple[list[str], Cause | None]:
        """The one number that is off, beside others that are only rounded."""
        free = [k for k, one in enumerate(self.text.literals) if one.half > 0 and not one.exponent]
        gap = np.where(np.isfinite(self.values), np.abs(self.values - target), np.inf)
        # far from a singular pose an angle feels a number least: there it is solved for
        few = np.argsort(gap, kind="stable")[: min(len(gap) // 2, int(np.isfinite(gap).sum()))]
        if len(few) < _FEWEST:
            return [], None
        at = {word: x[few] for word, x in self.at.items()}
        found = [way for k in free if (way := self._solved(at, target[few], [k]))]
        if not found and 1 < len(free) <= FREE:
            found = [way for way in [self._solved(at, target[few], free)] if way]
        if len(found) != 1:
            return [], None
        meanings, told, slips = Meanings.at(at), [], []
        for k, value in found[0].items():
            one = self.text.literals[k]
            # a number alone that were only rounded would have been found so: it costs solutions
            if len(found[0]) == 1 or not meanings.credible(one, value):
                slips.append((one.text, value))
            elif abs(value - one.value) > TOLERANCES.same_relation * abs(value):
                told.append(stands_for(one.text, meanings.named(value)))
        if len(slips) != 1:
            return [], None
        ((old, value),) = slips
        constant = Meanings({}).named(value)
        new = constant if "pi" in constant else f"{value:.7g}"
        slip = _("{old} should be {new}").format(old=old, new=new)
        form = _("{entry}: {slip} ({kind})")
        said = form.format(entry=self.text.entry, slip=slip, kind=_("coefficient"))
        return told, Cause(said, ("coefficient",), (self.text.entry,), 0.0, 1.0)

    def _solved(self, at: dict[str, Array], target: Array, free: list[int]) -> dict[int, float]:
        """The numbers that make the line right at every target; empty where none are sure."""
        solved = fitted(self.text, at, target, free)
        if solved is None or not told_apart(self.text, at, solved, free):
            return {}
        # near a singular pose an acos feels the last digit that was solved for
        short = np.array([float(f"{value:.9g}") for value in solved])
        right = self._right(solved) or self._right(short)
        return {k: float(solved[k]) for k in free} if right else {}

    def _right(self, numbers: Array) -> bool:
        values = self.text.values(self.at, numbers)
        return bool(np.max(_apart(self.one, values, self.q, self.k)) <= TOLERANCES.same_branch)


def joint_of(step: Step) -> str:
    """The joint whose line a step of a closed form is in: ``"q1"``; ``""`` where it is none's."""
    words = step.about.split()  # "the angle q1", but "the cosine of q2" is another line
    return words[2] if len(words) == 3 and _JOINT.fullmatch(words[2]) else ""


def believed(causes: list[Cause], study: LineStudy, case: Case) -> list[Cause]:
    """Causes that speak of no line that is right, nor of a name where a line has only numbers."""
    words = vocabulary(case.robot.table).values if case.robot.table is not None else {}
    named = re.compile(rf"\b(?:{'|'.join(map(re.escape, words))})\b") if words else None
    right = {f"q{k}" for k in study.right}
    wrong = set(range(1, case.robot.n + 1)) - study.right
    bare = named is not None and wrong == study.numbers
    return [
        cause
        for cause in causes
        if right.isdisjoint(cause.places)
        and not (bare and named is not None and named.search(cause.sentence))
    ]
