"""What the table doctor says: verdict, causes, evidence; as text, HTML and plain data."""

from __future__ import annotations

import math
import re
from dataclasses import dataclass, field, replace
from typing import Any

from markupsafe import Markup

from kinlab.doctor.tables.words import Cause, degrees, listed, number, where
from kinlab.host.introductions import Introduction, Rows
from kinlab.model.dh import DHTable

_ROW = re.compile(r"rows? [^:]*")


@dataclass(frozen=True, eq=False, repr=False)
class TableDiagnosis(Rows):
    """A DH table, judged against another description of the arm.

    Attributes:
        agrees: the tool poses (and bodies, where compared) are the reference's. False too where
            the cause is unknown.
        sentence: the verdict in one sentence.
        causes: the slips of the likeliest explanation; empty where none is known.
        alternatives: other explanations that repair the table as well, each a tuple of causes.
        repaired: the table as it should be; None where no cause is known.
        same_arm: the joint axes are the same arm's: only zeros, base or tool differ, if anything.
        differences: how two descriptions of the same arm differ, in words.
        certain_rows: rows (1-based) that are right for certain.
        rows_in_question: the others.
        mine: the table as given.
        reference: what it was held against.
        states: at how many states.
        error_before, error_after: largest difference of the poses over them, relative to the
            arm's size, of the table as written and as repaired.
        tolerance: below which a difference is rounding.
        clear: with measured poses: how far the slip stands clear of the noise.
        evidence: further lines.
        notes: what was not compared, and why.
    """

    agrees: bool
    sentence: str
    causes: tuple[Cause, ...] = ()
    alternatives: tuple[tuple[Cause, ...], ...] = ()
    repaired: DHTable | None = field(default=None, repr=False)
    same_arm: bool = False
    differences: tuple[str, ...] = ()
    certain_rows: tuple[int, ...] = ()
    rows_in_question: tuple[int, ...] = ()
    mine: DHTable | None = field(default=None, repr=False)
    reference: str = ""
    states: int = 0
    error_before: float = 0.0
    error_after: float | None = None
    tolerance: float = 1e-9
    clear: dict[str, float] = field(default_factory=dict)
    evidence: tuple[str, ...] = ()
    notes: tuple[str, ...] = ()

    @property
    def verdict(self) -> str:
        """``"agrees"``, ``"differs"`` or ``"differs, cause unknown"``."""
        if self.agrees:
            return "agrees"
        return "differs" if self.causes else "differs, cause unknown"

    @property
    def told(self) -> tuple[str, ...]:
        """Everything below the verdict, line by line."""
        lines = []
        if self.same_arm and self.differences:
            lines.append(f"same arm; {'; '.join(self.differences)}")
        lines += [f"or as well: {joined(other)}" for other in self.alternatives[:5]]
        if len(self.alternatives) > 5:
            lines.append(f"and {len(self.alternatives) - 5} more that repair it as well")
        lines += list(self.evidence)
        numbers = f"compared at {self.states} states"
        if self.clear:
            numbers += f": {self._noise()}"
        elif self.agrees:
            numbers += f": poses differ by {self.error_before:.1e} of the arm's size at most"
        elif math.isinf(self.error_before):
            numbers += ", with another number of joints"
        else:
            numbers += f": poses differ by {self.error_before:.3g} of the arm's size"
            if self.error_after is not None:
                numbers += f", by {self.error_after:.1e} once repaired"
        lines.append(numbers)
        if self.causes and self.certain_rows:
            rows = "row" if len(self.certain_rows) == 1 else "rows"
            lines.append(f"{rows} {listed(self.certain_rows)}: nothing to repair")
        return (*lines, *(f"note: {note}" for note in self.notes))

    def _noise(self) -> str:
        """The noise in words."""
        c = self.clear
        text = f"noise {1000 * c['sigma_position']:.3g} mm, {c['sigma_angle_deg']:.3g} deg"
        if "effect" in c:
            text += f"; the slip is {c['effect']:.3g} times the noise"
        if "runner_up" in c:
            text += f", the next best cause leaves {c['runner_up']:.3g} times the noise"
        return text

    def columns(self) -> dict[str, Any]:
        """Slip by slip: row and column, what is written and what is meant."""
        told = [cause.as_dict() for cause in self.causes]
        names = ("row", "column", "written", "meant", "kind", "sentence")
        return {name: [str(one[name]) for one in told] for name in names}

    def introduction(self) -> Introduction:
        """The verdict, the slips in one sentence, and what they rest on."""
        verdict = f"{self.name}: {self.verdict} (against {self.reference})"
        mood: Any = "good" if self.agrees else "bad" if self.causes else "unsure"
        return Introduction(verdict, (self.sentence, *self.told), mood=mood)

    def _repr_html_(self) -> str:
        """With the table, its wrong cells struck out beside what is meant."""
        pair = Markup("<del>{}</del> <b>{}</b>")
        rows = tuple(
            (str(i), *(pair.format(was, shall) if shall else was for was, shall in row))
            for i, row in enumerate(self.cells, 1)
        )
        columns = ("row", "a", "alpha", "d", "theta")
        return replace(self.introduction(), columns=columns, rows=rows).html()

    @property
    def name(self) -> str:
        """The table's name."""
        return self.mine.name if self.mine is not None else "table"

    @property
    def cells(self) -> list[list[tuple[str, str]]]:
        """a, alpha, d, theta of every row as written, each with what is meant where it differs.

        Empty where no cell-wise repair is known.
        """
        if self.mine is None or self.repaired is None or not self.causes:
            return []
        if self.mine.n != self.repaired.n:
            return []
        rows = []
        for one, two in zip(self.mine.links, self.repaired.links, strict=True):
            row = []
            for column in ("a", "alpha", "d", "theta"):
                was, shall = getattr(one, column), getattr(two, column)
                form = degrees if column in ("alpha", "theta") else number
                row.append((form(was), form(shall) if abs(was - shall) > 1e-9 else ""))
            rows.append(row)
        return rows

    def as_dict(self) -> dict[str, Any]:
        """Plain values for JSON."""
        return {
            "table": self.mine.name if self.mine is not None else "",
            "against": self.reference,
            "verdict": self.verdict,
            "agrees": self.agrees,
            "same_arm": self.same_arm,
            "diagnosis": self.sentence,
            "causes": [cause.as_dict() for cause in self.causes],
            "alternatives": [[c.as_dict() for c in other] for other in self.alternatives],
            "differences": list(self.differences),
            "certain_rows": list(self.certain_rows),
            "rows_in_question": list(self.rows_in_question),
            "states": self.states,
            "error_before": self.error_before if math.isfinite(self.error_before) else None,
            "error_after": self.error_after,
            "tolerance": self.tolerance,
            "clear": dict(self.clear),
            "evidence": list(self.evidence),
            "notes": list(self.notes),
            "repaired": self.repaired.to_toml() if self.repaired is not None else None,
        }


def joined(causes: tuple[Cause, ...]) -> str:
    """The causes in one sentence; the same slip in several rows is told once.

    Example:
        ``rows 2 and 3: a and d are exchanged``.
    """
    said: list[str] = []
    done: set[int] = set()
    for k, cause in enumerate(causes):
        if k in done:
            continue
        rows = list(cause.rows)
        tail = _ROW.sub("", cause.sentence, count=1) if cause.sentence.startswith("row") else ""
        for other in range(k + 1, len(causes)):
            two = causes[other]
            if tail and two.sentence.startswith("row") and _ROW.sub("", two.sentence, 1) == tail:
                rows += two.rows
                done.add(other)
        if len(rows) > len(cause.rows):
            said.append(f"{where(tuple(sorted(rows)))}{tail}")
        else:
            said.append(cause.sentence)
    return "; ".join(said)
