"""The catalogue: every formula of the notes, run on its robots."""

from __future__ import annotations

import importlib
from collections.abc import Callable, Iterable, Iterator
from dataclasses import dataclass
from functools import cache
from typing import Any

import numpy as np

from kinlab.check.compare import Comparison, compare_stacked
from kinlab.check.diagnosis import Diagnosis
from kinlab.check.quantities.registry import quantity as find_quantity
from kinlab.formulas.record import Formula, formulas_in, function_name
from kinlab.host.language import _
from kinlab.tolerances import TOLERANCES

NOTES = (
    "kinlab.notes.note000_kinematics",
    "kinlab.notes.note000_inverse",
    "kinlab.notes.note000_dynamics",
    "kinlab.notes.note001_energies",
    "kinlab.notes.note001_torques",
    "kinlab.notes.note002_dynamics",
    "kinlab.notes.note002_frames",
    "kinlab.notes.note002_mass",
    "kinlab.notes.note002_coriolis",
    "kinlab.notes.note003_kinematics",
    "kinlab.notes.note003_dynamics",
)
"""Modules of hand formulas, in the order of the report."""


@dataclass(frozen=True)
class Row:
    """One formula on one robot.

    Attributes:
        formula: the record.
        robot: the robot's name.
        corrected: the corrected form beside the engine.
        printed: the printed form beside the engine, where the note has a misprint that shows on
            this robot.
        diagnosis: what is wrong in a user's formula that differs, where it was looked for; or
            that it is right all the same, written otherwise.
        failure: why the function gave no answer at all, or an empty string.
    """

    formula: Formula
    robot: str
    corrected: Comparison
    printed: Comparison | None = None
    diagnosis: Diagnosis | None = None
    failure: str = ""

    @property
    def misprint_shown(self) -> bool:
        """Whether the printed form disagrees plainly; true where there is none."""
        return self.printed is None or self.printed.max_error > TOLERANCES.formula_differs

    @property
    def right(self) -> bool:
        """Whether the corrected form is the engine's, or another that is as right."""
        return self.corrected.agrees or (self.diagnosis is not None and self.diagnosis.agrees)

    @property
    def ok(self) -> bool:
        """Whether the corrected form is right and the printed one, if any, does not agree."""
        return self.right and self.misprint_shown

    @property
    def verdict(self) -> str:
        """One line: agrees, or what is wrong."""
        if self.failure:
            return _("FAILED: {reason}").format(reason=self.failure)
        if not self.right:
            return _("DIFFERS from the engine")
        if not self.corrected.agrees and self.diagnosis is not None:
            return _(self.diagnosis.verdict)
        if self.printed is None or self.formula.printed is None:
            return _("agrees")
        if not self.misprint_shown:
            return _("agrees; the misprint does NOT show here")
        return _("misprint: {what}").format(what=_(self.formula.printed.misprint))


@cache
def catalogue() -> tuple[Formula, ...]:
    """The formulas of all notes."""
    return tuple(f for name in NOTES for f in formulas_in(importlib.import_module(name)))


def plan(
    formulas: Iterable[Formula], keep: Callable[[str], bool] = lambda name: True
) -> list[tuple[Formula, str]]:
    """The pairs of formula and robot name to run, groups of robots spelled out.

    Args:
        formulas: the records.
        keep: which robot names to run on.
    """
    pairs = []
    for record in formulas:
        domain = find_quantity(record.quantity).domain
        for name in _members(domain, record.robots):
            if keep(name):
                pairs.append((record, name))
    return pairs


def run(pairs: Iterable[tuple[Formula, str]], samples: int = 200, seed: int = 0) -> Iterator[Row]:
    """Runs formulas on robots, one after the other.

    Args:
        pairs: from :func:`plan`.
        samples, seed: as for :func:`kinlab.compare`.

    Yields:
        One row per pair.
    """
    for record, name in pairs:
        yield run_one(record, name, samples, seed)


def run_one(record: Formula, robot: Any, samples: int = 200, seed: int = 0) -> Row:
    """Runs one formula, and its printed form where it has one, on one robot."""
    quantity = find_quantity(record.quantity)
    mechanism = quantity.domain.load(robot)
    numbers = quantity.domain.numbers(mechanism)

    def beside(function: Callable[..., Any]) -> Comparison:
        name = function_name(function)
        return compare_stacked(mechanism, quantity, function, name, numbers, samples, seed)

    corrected = beside(record.function)
    printed = None
    if record.printed is not None:
        shown = _members(quantity.domain, record.printed.robots or record.robots)
        label = quantity.domain.label(mechanism)
        if label in shown or robot in shown:
            printed = beside(record.printed.function)
    return Row(record, quantity.domain.label(mechanism), corrected, printed)


def failed_row(record: Formula, robot: Any, samples: int, seed: int, failure: str) -> Row:
    """The row of a function that gave no answer."""
    quantity = find_quantity(record.quantity)
    mechanism = quantity.domain.load(robot)

    def silent(numbers: Any, *states: Any) -> Any:
        return np.full(quantity.answers(mechanism, samples, seed).shape, np.nan)

    name = function_name(record.function)
    compared = compare_stacked(mechanism, quantity, silent, name, None, samples, seed)
    return Row(record, quantity.domain.label(mechanism), compared, failure=failure)


def _members(domain: Any, names: Iterable[str]) -> tuple[str, ...]:
    spelled = [one for name in names for one in domain.members(name)]
    return tuple(dict.fromkeys(spelled))
