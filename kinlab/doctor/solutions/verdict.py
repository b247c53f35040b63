"""Inverse kinematics judged: right where Pinocchio finds the tool at the target, on any branch.

What is right says how many targets were tried and which branches are given; what is wrong, which of
its solutions are right and which step of the textbooks' closed form is taken otherwise.
"""

from __future__ import annotations

from collections.abc import Callable, Iterable, Iterator
from dataclasses import dataclass, replace
from functools import partial
from typing import Any

import numpy as np

from kinlab.arrays import Array, first_largest
from kinlab.check.compare import error_sizes
from kinlab.check.diagnosis import Cause, Diagnosis
from kinlab.check.quantities.inverse import TASKS, as_solutions, reached, row_by_row
from kinlab.doctor import verdicts
from kinlab.doctor.changes import Case, table_of
from kinlab.doctor.derivations.joined import (
    Found,
    ready,
    several_taken_otherwise,
    taken_otherwise,
    with_these,
)
from kinlab.doctor.program.words import meant
from kinlab.doctor.solutions.closed_forms import Branches, closed_forms, compared, slides
from kinlab.doctor.solutions.lines import LineStudy, believed, joint_of, studied
from kinlab.doctor.text.written import Written
from kinlab.errors import KinlabError
from kinlab.host.language import N_, _, ngettext
from kinlab.tolerances import TOLERANCES

_FAR = 0.15
"""Cost beyond the likeliest cause's from which another is not told."""
_FEWEST = 10
"""Targets that must be explained at least."""
_BEYOND = 50.0
"""Times the place of a target: out of every arm's reach that has no slide."""


@dataclass(frozen=True, eq=False)
class Solutions:
    """A hand formula's solutions beside the targets.

    Attributes:
        case: its case.
        q: (N, m, n), NaN where there is none.
        errors: how far Pinocchio finds the tool from the target, relative, (N, m).
    """

    case: Case
    q: Array
    errors: Array

    @property
    def given(self) -> Any:
        """Which there are, (N, m)."""
        return np.isfinite(self.q).all(axis=2)

    @property
    def right(self) -> Any:
        """Which are right, (N, m)."""
        return self.given & (self.errors <= TOLERANCES.formula_agrees)

    @property
    def wrong(self) -> Any:
        """Which are wrong, (N, m)."""
        return self.given & ~self.right


def judged(
    case: Case,
    hand: Any,
    engine: Array,
    quantity: str,
    name: str,
    written: dict[str, Written] | None = None,
) -> Diagnosis:
    """The diagnosis of answers to a quantity of inverse kinematics; of texts also line by line.

    Raises:
        AnswerShapeError: answers that are no joint positions.
    """
    task, robot = TASKS[case.quantity.name], case.robot
    found = _solutions(case, as_solutions(robot, hand), engine)
    label = case.quantity.domain.label(robot)
    worst = _worst(found)
    if not found.wrong.any() and found.right.any(axis=1).all():
        remarks = (*_branches_told(found), *_answers_beyond(found))
        return Diagnosis(quantity, label, name, True, float(np.max(worst)), remarks=remarks)
    furthest = float(np.max(worst))
    study = studied(case, written) if written else None
    if study is not None and study.rounded and not study.unknown and not study.off:
        # near the limit of reach a rounded acos may have no value
        most, remarks = float(np.max(worst[np.isfinite(worst)])), study.rounded
        return Diagnosis(quantity, label, name, True, most, form="rounded", remarks=remarks)
    right = Diagnosis(quantity, label, name, True, furthest)
    if study is None and furthest <= TOLERANCES.slips_leave:
        return _to_its_digits(right)
    if study is None and (places := _joints_rounded(found, engine)):
        return replace(right, form="rounded", remarks=(places,))
    if study is not None and study.off and not study.unknown:
        causes = [_all_off(study)]
    else:
        rows = found.q.shape[1]
        read = partial(row_by_row, rows, task)
        targets = np.repeat(engine[:, None], rows, axis=1)
        shown = replace(case.quantity, read=read)
        own = replace(case, quantity=shown, hand=read(robot, hand, targets))
        edited: list[Cause] = []
        for some in own.looked_through(targets, TOLERANCES.formula_agrees):
            if some.excuse is not None:
                return replace(right, form=some.excuse.form, remarks=some.excuse.remarks)
            if edited := some.causes:
                break
        causes = _causes(found, engine)
        causes = meant(edited, causes) if edited else causes
        causes = causes if study is None else believed(causes, study, case)
    if not causes and furthest <= TOLERANCES.slips_leave:
        return _to_its_digits(right)
    k = first_largest(worst)
    row = int(np.argmax(np.where(found.wrong[k], found.errors[k], -1.0)))
    return Diagnosis(
        quantity,
        label,
        name,
        False,
        float(worst[k]),
        tuple(_ranked(causes)),
        worst_entry=quantity,
        worst_state={n: stack[k] for n, stack in case.arguments.items()},
        hand=reached(robot, task, found.q[k, row][None])[0],
        engine=engine[k],
        form="near" if not causes and _rounded_perhaps(found, furthest) else "",
        proved=() if causes else tuple(_counted(found)),
    )


def _to_its_digits(right: Diagnosis) -> Diagnosis:
    said = verdicts.of_digits(right.error_before).remarks
    return replace(right, form="digits", remarks=said)


def _joints_rounded(found: Solutions, engine: Array) -> str:
    """What is said of joint positions that are rounded to some decimals; empty of others."""
    case, given = found.case, found.q[found.given]
    turning, table = ~slides(case.robot), table_of(case.robot)
    if not turning.any() or table is None or not found.given.any(axis=1).all():
        return ""
    places = reached(case.robot, TASKS[case.quantity.name], found.q)
    gaps = np.abs(places - engine[:, None])[found.given]
    reach = max(1.0, sum(abs(link.a) + abs(link.d) for link in table.links))
    for unit, said in (
        (1.0, N_("its joint positions are rounded to {places} decimals")),
        (np.pi / 180.0, N_("its joint positions are rounded to {places} decimals of a degree")),
    ):
        for decimals in range(7):
            step = unit * 10.0**-decimals
            off = np.abs(np.round(given[:, turning] / step) * step - given[:, turning])
            if np.max(off) <= TOLERANCES.slips_leave * step:
                small = np.max(gaps) <= 0.5 * step * case.robot.n * reach
                return _(said).format(places=decimals) if small else ""
    return ""


def _rounded_perhaps(found: Solutions, furthest: float) -> bool:
    """Whether all that is wrong may be rounded constants, which leave few targets as they are."""
    every = ~found.wrong.any(axis=1)
    near = furthest <= TOLERANCES.nearly_agrees and 2 * int(every.sum()) <= len(every)
    return near or furthest <= TOLERANCES.finite_differences  # an iteration stops somewhere


def _all_off(study: LineStudy) -> Cause:
    """The numbers of several lines that are off, as one cause, with what is only rounded."""
    told = _("; ").join([*(cause.sentence for cause in study.off), *study.rounded])
    kinds = tuple(kind for cause in study.off for kind in cause.kinds)
    places = tuple(place for cause in study.off for place in cause.places)
    return Cause(told, kinds, places, 0.0, 1.0)


def _solutions(case: Case, q: Array, engine: Array) -> Solutions:
    """Rows without any number at any target are no solutions at all."""
    kept = np.isfinite(q).all(axis=2).any(axis=0)
    q = q[:, kept] if kept.any() else q[:, :1]
    places = reached(case.robot, TASKS[case.quantity.name], q)
    gap = np.abs(places - engine[:, None]).reshape(*q.shape[:2], -1).max(axis=2)
    return Solutions(case, q, gap / error_sizes(engine)[:, None])


def _worst(found: Solutions) -> Array:
    """The largest error of each target; infinite where there is no solution."""
    errors = np.max(np.where(found.given, found.errors, 0.0), axis=1)
    return np.where(found.given.any(axis=1), errors, np.inf)


def _ranked(causes: list[Cause]) -> Iterator[Cause]:
    seen: set[tuple[str, ...]] = set()
    for cause in sorted(causes, key=lambda c: c.cost):
        near = cause.cost <= min(c.cost for c in causes) + _FAR
        if near and cause.kinds not in seen:
            seen.add(cause.kinds)
            yield cause


# -------- What is said of right solutions


def _branches_told(found: Solutions) -> Iterator[str]:
    """How many solutions were shown to be right, and of how many there are."""
    number = _distinct(found).sum(axis=1)
    least, most = int(number.min()), int(number.max())
    said = ngettext(
        "{count} solution of each of {targets} targets, verified by Pinocchio's forward kinematics",
        "{count} solutions of each of {targets} targets, verified by Pinocchio's forward "
        "kinematics",
        most,
    )
    count = str(least) if least == most else f"{least}–{most}"
    yield said.format(count=count, targets=len(number))
    mine = compared(found.case.robot, found.q)
    there = []
    for one, at in next(closed_forms(found.case, False), []):
        gap = np.max(np.abs(mine[at] - one.answer(())[:, None]), axis=2)
        met = np.any(found.given[at] & (gap <= TOLERANCES.same_branch), axis=1)
        there.append(bool(met.all()))
    if there and not all(there):
        told = _("of the {every} branches of the closed form it gives {covered}")
        yield told.format(every=len(there), covered=sum(there))


def _distinct(found: Solutions) -> Any:
    """Which right solutions are no repetition of one before, (N, m)."""
    mine, out = compared(found.case.robot, found.q), found.right.copy()
    for k in range(1, out.shape[1]):
        gap = np.max(np.abs(mine[:, :k] - mine[:, k : k + 1]), axis=2)
        out[:, k] &= ~np.any(out[:, :k] & (gap <= TOLERANCES.same_branch), axis=1)
    return out


def _answers_beyond(found: Solutions) -> Iterator[str]:
    """Where nothing can reach, a formula that answers all the same."""
    if found.case.again is None or slides(found.case.robot).any():
        return
    few = found.case.few(3).arguments
    far = {n: x if n == "phi" else _BEYOND * x for n, x in few.items() if n != "pose"}
    if not far:
        return
    try:
        with np.errstate(all="ignore"):
            answers = np.asarray(found.case.again(far), dtype=float)
    except (KinlabError, ValueError, TypeError):
        return
    if np.isfinite(answers).all(axis=-1).any():
        yield _("beyond reach it answers as well: ask first whether |cos| <= 1")


# -------- What explains wrong ones


def _counted(found: Solutions) -> Iterator[str]:
    """What was shown of each solution."""
    count = len(found.q)
    for k in range(found.q.shape[1]):
        right = int(found.right[:, k].sum())
        said = _("solution {number}: right at {right} of {count} targets")
        told = said.format(number=k + 1, right=right, count=count)
        wrong: Any = found.wrong[:, k]
        nearly = found.given[:, k].all() and wrong.any()
        furthest = float(np.max(found.errors[wrong, k])) if nearly else np.inf
        if furthest <= TOLERANCES.nearly_agrees:  # an iteration stops somewhere
            near = _("at the others the tool is within {error:.1e} of the target, relative")
            told = _("; ").join((told, near.format(error=furthest)))
        yield told


def _causes(found: Solutions, engine: Array) -> list[Cause]:
    silent = _without_solution(found)
    if silent is not None:
        return [silent]
    whole = list(_by_reading(found, engine)) or list(_by_offset(found, engine))
    whole = whole or list(_by_mixing(found))
    if whole and whole[0].cost <= 1.0:
        return whole
    searches: tuple[Callable[[Case], list[Found]], ...] = (
        lambda case: taken_otherwise(case, ready(case)),
        lambda case: several_taken_otherwise(case, ready(case), None),
    )
    for search in searches:
        for limited in (False, True):
            causes = _by_derivation(found, search, limited)
            if causes or whole:
                return [*causes, *whole]
    return []


def _without_solution(found: Solutions) -> Cause | None:
    """No solution at some targets, right ones at the others."""
    if found.wrong.any():
        return None
    none = int(np.sum(~found.given.any(axis=1)))
    if none == len(found.q):
        return None
    told = _(
        "the formula gives no solution at {none} of {count} targets within reach; elsewhere it is "
        "right"
    ).format(none=none, count=len(found.q))
    return Cause(told, ("no value",), ("",), 0.0, 1.0)


_READINGS: tuple[tuple[str, str, Callable[[Array, Any], Array]], ...] = (
    ("degrees", N_("answers in degrees"), lambda q, slide: np.where(slide, q, np.deg2rad(q))),
    (
        "absolute angles",
        N_("gives every angle from the base"),
        lambda q, slide: np.diff(q, axis=-1, prepend=0.0),
    ),
    ("joint order", N_("gives the joints from tool to base"), lambda q, slide: q[..., ::-1]),
    ("turning sense", N_("counts every joint the other way"), lambda q, slide: -q),
)
"""What undoes a reading of all joints."""
_FAR_FETCHED = {"turning sense": 1.2}
"""What such a reading costs, where one step of the closed form is likelier."""


def _by_reading(found: Solutions, engine: Array) -> Iterator[Cause]:
    slide = slides(found.case.robot)
    for kind, does, undone in _READINGS:
        if kind == "absolute angles" and slide.any():
            continue
        other = _solutions(found.case, undone(found.q, slide), engine)
        if not other.wrong.any() and other.right.any(axis=1).all():
            told = _("the formula {does}").format(does=_(does))
            cost = _FAR_FETCHED.get(kind, 1.0)
            yield Cause(told, (kind,), ("",), float(np.max(_worst(other))), cost)


_OFFSETS = (("pi", np.pi), ("pi/2", np.pi / 2), ("-pi/2", -np.pi / 2))
"""Constants that are forgotten, or are too much, in one joint."""


def _by_offset(found: Solutions, engine: Array) -> Iterator[Cause]:
    """One joint that is a constant off in all rows that are wrong."""
    off = found.wrong.any(axis=0)
    wrong: Any = found.wrong[:, off]
    if not np.all(wrong | ~found.given[:, off]):
        return
    for joint in np.flatnonzero(~slides(found.case.robot)).tolist():
        for name, angle in _OFFSETS:
            q = found.q.copy()
            q[:, off, joint] += angle
            other = _solutions(found.case, q, engine)
            if other.wrong.any() or not other.right.any(axis=1).all():
                continue
            told = _("q{joint} is off by a constant: with {angle} added it is right")
            told = _in_rows(told.format(joint=joint + 1, angle=name), off)
            error = float(np.max(_worst(other)))
            yield Cause(told, ("constant angle",), (f"q{joint + 1}",), error, 1.0)


def _in_rows(told: str, off: Any) -> str:
    """What is told, and of which solutions where it is not of all, (m,)."""
    if off.all():
        return told
    said = _("{what} (in solution {places}; the others are right)")
    return said.format(what=told, places=_rows(off))


def _rows(off: Any) -> str:
    return ", ".join(str(k + 1) for k in np.flatnonzero(off))


def _by_mixing(found: Solutions) -> Iterator[Cause]:
    """Beside right rows others, each joint of which is that of a branch, but not of one branch."""
    off = found.wrong.any(axis=0)
    if off.all() or not found.given.all():
        return
    n, mine = found.case.robot.n, compared(found.case.robot, found.q[:, off])
    own: list[Array] = []
    for one, at in next(closed_forms(found.case, False), []):
        if not at.all():
            return
        gap = np.abs(mine - one.answer(())[:, None])
        own.append(np.max(np.maximum(gap[..., :n], gap[..., n:]), axis=0) <= TOLERANCES.same_branch)
    # (branches, rows, joints)
    if own and np.any(own, axis=0).all():
        told = _(
            "the formula joins angles of different branches: each angle is right on a branch of "
            "its own (in solution {places}; the others are right)"
        ).format(places=_rows(off))
        yield Cause(told, ("branches mixed",), ("",), 0.0, 1.0)


def _by_derivation(
    found: Solutions, search: Callable[[Case], Iterable[Found]], limited: bool
) -> list[Cause]:
    """Causes that are steps of a closed form, one and the same for all wrong rows or one for each.

    Nothing where a row stays unexplained.
    """
    wrong = found.wrong.any(axis=0)
    off = np.flatnonzero(wrong).tolist()
    forms = list(closed_forms(found.case, limited))
    explained: list[dict[str, Found]] = []
    for k in off:
        ways: dict[str, Found] = {}
        known = [one for ways_ in explained for one in ways_.values()]
        again = _of_row(found, k, forms, partial(with_these, known)) if known else ()
        for one in [*again] or _of_row(found, k, forms, search):
            said = _(" and ").join(step.sentence for step in one.steps)
            if said not in ways or one.cost < ways[said].cost:
                ways[said] = one
        if not ways:
            return []
        explained.append(ways)
    if not explained:
        return []
    common = [said for said in explained[0] if all(said in ways for ways in explained)]
    formula = _("the formula {does}")
    if common:
        said_of = {said: _in_rows(formula.format(does=said), wrong) for said in common}
        chosen = [(said_of[said], [explained[0][said]]) for said in common]
    else:
        best = [min(ways.items(), key=lambda x: x[1].cost) for ways in explained]
        told = [
            _("solution {number}: {what}").format(number=k + 1, what=formula.format(does=said))
            for k, (said, _one) in zip(off, best, strict=True)
        ]
        chosen = [(_("; ").join(told), [one for _said, one in best])]
    return [_as_cause(said, founds) for said, founds in chosen]


def _as_cause(told: str, founds: list[Found]) -> Cause:
    steps = [step for one in founds for step in one.steps]
    kinds = tuple(step.kind for step in steps)
    error, cost = max(one.error for one in founds), sum(one.cost for one in founds)
    return Cause(told, kinds, tuple(joint_of(step) for step in steps), error, cost)


def _of_row(
    found: Solutions, k: int, forms: list[Branches], search: Callable[[Case], Iterable[Found]]
) -> Iterator[Found]:
    """What gives one row at every target, from whichever branch."""
    for one, at in (pair for form in forms for pair in form):
        row = found.q[at, k]
        known = np.isfinite(row).all(axis=1)
        if np.sum(known) >= _FEWEST:
            given = {n: x[known] for n, x in one.arguments.items()}
            hand = compared(found.case.robot, row[known])
            yield from search(replace(one, arguments=given, hand=hand, again=None))
