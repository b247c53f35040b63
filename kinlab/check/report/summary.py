"""Rows put together by formula, and as plain data for machines."""

from __future__ import annotations

import math
from collections.abc import Iterable
from dataclasses import dataclass
from typing import Any

import numpy as np

from kinlab.arrays import Array
from kinlab.check.catalogue import Row
from kinlab.check.diagnosis import Diagnosis
from kinlab.check.unread import Unread
from kinlab.formulas.record import Formula
from kinlab.host.language import _, speaking

NO_ROBOT = "-"
"""Stands for the robots of an identity, which has none."""


@dataclass(frozen=True)
class Group:
    """All rows of one formula.

    Attributes:
        formula: the record.
        rows: one per robot, at least one.
    """

    formula: Formula
    rows: tuple[Row, ...]

    @property
    def ok(self) -> bool:
        """Whether every row is as it should be."""
        return all(row.ok for row in self.rows)

    @property
    def quiet(self) -> bool:
        """Whether there is nothing to show but that it agrees."""
        return self.ok and self.printed_error is None

    @property
    def robots(self) -> str:
        """The robots in a few words."""
        names = [row.robot for row in self.rows]
        if names == ["identity"]:
            return NO_ROBOT
        if len(names) <= 2:
            return _(", ").join(names)
        return _("{count} robots").format(count=len(names))

    @property
    def worst(self) -> Row:
        """The row with the largest error of the corrected form."""
        return max(self.rows, key=lambda row: row.corrected.max_error)

    @property
    def printed_error(self) -> float | None:
        """The smallest of the printed form's largest errors, or None without a printed form."""
        errors = [row.printed.max_error for row in self.rows if row.printed is not None]
        return min(errors) if errors else None

    @property
    def printed_finite(self) -> bool:
        """Whether the printed form gives a value at every state of some robot."""
        return self.printed_error is not None and math.isfinite(self.printed_error)

    @property
    def verdict(self) -> str:
        """One line for all robots: the first that is not as it should be, or the misprint."""
        for row in self.rows:
            if not row.ok:
                told = _("{robot}: {verdict}").format(robot=row.robot, verdict=row.verdict)
                return told if len(self.rows) > 1 else row.verdict
        shown = [row for row in self.rows if row.printed is not None]
        return (shown or list(self.rows))[0].verdict

    @property
    def errors(self) -> Array:
        """Errors of the corrected form over all robots and states."""
        return np.concatenate([row.corrected.errors for row in self.rows])

    @property
    def printed_errors(self) -> Array | None:
        """The same for the printed form."""
        shown = [row.printed.errors for row in self.rows if row.printed is not None]
        return np.concatenate(shown) if shown else None


def grouped(rows: Iterable[Row]) -> list[Group]:
    """Rows by formula, in the order in which the formulas first appear."""
    found: dict[int, list[Row]] = {}
    for row in rows:
        found.setdefault(id(row.formula), []).append(row)
    return [Group(several[0].formula, tuple(several)) for several in found.values()]


@speaking("en")
def as_data(
    rows: Iterable[Row], judged: Iterable[Diagnosis] = (), unread: Iterable[Unread] = ()
) -> dict[str, Any]:
    """The rows and diagnoses as plain data; an infinite error is null.

    Returns:
        In English, whatever language is spoken:
        ``{"ok": bool, "rows": [...], "formulas": [...]}``; and ``"unread": [{"what", "reason"}]``
        where something could not be judged, which is not ok.
    """
    listed, judged, missed = list(rows), list(judged), list(unread)
    sound = all(row.ok for row in listed) and all(one.agrees for one in judged)
    data: dict[str, Any] = {
        "ok": sound and not missed,
        "rows": [_row(row) for row in listed],
        "formulas": [_diagnosis(one) for one in judged],
    }
    if missed:
        data["unread"] = [{"what": one.what, "reason": one.reason} for one in missed]
    return data


def _row(row: Row) -> dict[str, Any]:
    record = row.formula
    return {
        "id": record.id,
        "part": record.part,
        "note": record.note,
        "title": record.title,
        "source": record.source,
        "quantity": record.quantity,
        "robot": row.robot,
        "samples": row.corrected.samples,
        "seed": row.corrected.seed,
        "max_error": _number(row.corrected.max_error),
        "agrees": row.corrected.agrees,
        "printed_error": None if row.printed is None else _number(row.printed.max_error),
        "misprint": record.printed.misprint if record.printed and row.printed else None,
        "remark": record.remark,
        "verdict": row.verdict,
        "diagnosis": None if row.diagnosis is None else _diagnosis(row.diagnosis),
        "ok": row.ok,
    }


def _diagnosis(found: Diagnosis) -> dict[str, Any]:
    return {"file": found.source, "ok": found.agrees, **found.as_dict()}


def _number(value: float) -> float | None:
    return value if math.isfinite(value) else None


def size(value: float | None) -> str:
    """An error in two digits; "no value" where the formula gave none, empty for None."""
    if value is None:
        return ""
    return f"{value:.1e}" if math.isfinite(value) else _("no value")
