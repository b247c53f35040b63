"""What the table doctor says: verdict, causes, evidence; as text, HTML and plain data."""

from __future__ import annotations

import math
from dataclasses import dataclass, field, replace
from typing import Any

from markupsafe import Markup

from kinlab.doctor.tables.words import Cause, at_row, degrees, listed, number
from kinlab.host.introductions import Introduction, Rows
from kinlab.host.language import N_, _, ngettext
from kinlab.model.dh import DHTable


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
        unseen_rows: rows around joints that rest in all the poses: of these nothing is sure.
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
    unseen_rows: tuple[int, ...] = ()

    @property
    def verdict(self) -> str:
        """``"agrees"``, ``"agrees at these poses"``, ``"differs"``, or ``"..., cause unknown"``."""
        if self.agrees:
            return N_("agrees at these poses") if self.unseen_rows else N_("agrees")
        return N_("differs") if self.causes else N_("differs, cause unknown")

    @property
    def told(self) -> tuple[str, ...]:
        """Everything below the verdict, line by line."""
        lines = []
        if self.same_arm and self.differences:
            same = _("same arm; {differences}")
            lines.append(same.format(differences=_("; ").join(self.differences)))
        lines += [
            _("or as well: {slips}").format(slips=joined(other)) for other in self.alternatives[:5]
        ]
        if len(self.alternatives) > 5:
            more = _("and {count} more that repair it as well")
            lines.append(more.format(count=len(self.alternatives) - 5))
        lines += [*self.evidence, self._numbers()]
        if self.causes and self.certain_rows:
            right = ngettext(
                "row {rows}: nothing to repair",
                "rows {rows}: nothing to repair",
                len(self.certain_rows),
            )
            lines.append(right.format(rows=listed(self.certain_rows)))
        return (*lines, *(_("note: {note}").format(note=note) for note in self.notes))

    def _numbers(self) -> str:
        """At how many states the poses were compared, and how far apart they are."""
        if self.clear:
            told = _("compared at {states} states: {noise}")
            return told.format(states=self.states, noise=self._noise())
        if self.agrees:
            told = _(
                "compared at {states} states: poses differ by {before:.1e} of the arm's size at "
                "most"
            )
        elif math.isinf(self.error_before):
            told = _("compared at {states} states, with another number of joints")
        elif self.error_after is None:
            told = _("compared at {states} states: poses differ by {before:.3g} of the arm's size")
        else:
            told = _(
                "compared at {states} states: poses differ by {before:.3g} of the arm's size, by "
                "{after:.2g} once repaired"
            )
        return told.format(states=self.states, before=self.error_before, after=self.error_after)

    def _noise(self) -> str:
        """The noise in words."""
        c = self.clear
        if "hidden_length" in c:
            told = _(
                "noise {position:.3g} mm, {angle:.3g} deg: in one cell a slip of up to "
                "{length:.2g} mm, or {turn:.2g} deg, may not show"
            )
        elif "effect" not in c:
            told = _("noise {position:.3g} mm, {angle:.3g} deg")
        elif "runner_up" not in c:
            told = _(
                "noise {position:.3g} mm, {angle:.3g} deg; the slip is {effect:.3g} times the noise"
            )
        else:
            told = _(
                "noise {position:.3g} mm, {angle:.3g} deg; the slip is {effect:.3g} times the "
                "noise, the next best cause leaves {next:.3g} times the noise"
            )
        size = {"position": 1000 * c["sigma_position"], "angle": c["sigma_angle_deg"]}
        size["length"] = 1000 * c.get("hidden_length", 0.0)
        size["turn"] = c.get("hidden_angle_deg", 0.0)
        return told.format(**size, effect=c.get("effect"), next=c.get("runner_up"))

    def columns(self) -> dict[str, Any]:
        """Slip by slip: row and column, what is written and what is meant."""
        told = [cause.as_dict() for cause in self.causes]
        names = ("row", "column", "written", "meant", "kind", "sentence")
        return {name: [str(one[name]) for one in told] for name in names}

    def introduction(self) -> Introduction:
        """The verdict, the slips in one sentence, and what they rest on."""
        verdict = _("{table}: {verdict} (against {reference})").format(
            table=self.name, verdict=_(self.verdict), reference=self.reference
        )
        mood: Any = "good" if self.agrees else "bad" if self.causes else "unsure"
        return Introduction(verdict, (self.sentence, *self.told), mood=mood)

    def _repr_html_(self) -> str:
        """With the table, its wrong cells struck out beside what is meant."""
        pair = Markup("<del>{}</del> <b>{}</b>")
        rows = tuple(
            (str(i), *(pair.format(was, shall) if shall else was for was, shall in row))
            for i, row in enumerate(self.cells, 1)
        )
        columns = (_("row"), "a", "alpha", "d", "theta")
        return replace(self.introduction(), columns=columns, rows=rows).html()

    @property
    def name(self) -> str:
        """The table's name."""
        return self.mine.name if self.mine is not None else _("table")

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
            "unseen_rows": list(self.unseen_rows),
            "repaired": self.repaired.to_toml() if self.repaired is not None else None,
        }


def stated(causes: tuple[Cause, ...], unseen: bool) -> str:
    """The causes in one sentence, which is no proof where poses do not see some rows."""
    said = joined(causes)
    if unseen and causes:
        return _("the poses allow, and do not prove: {causes}").format(causes=said)
    return said


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
        tail = _behind_the_rows(cause)
        for other in range(k + 1, len(causes)):
            if tail and _behind_the_rows(causes[other]) == tail:
                rows += causes[other].rows
                done.add(other)
        if len(rows) > len(cause.rows):
            said.append(at_row(tuple(sorted(rows)), tail))
        else:
            said.append(cause.sentence)
    return _("; ").join(said)


def _behind_the_rows(cause: Cause) -> str:
    """What a sentence says of its rows; empty where it does not begin with them."""
    if cause.row is None:
        return ""
    front = at_row(cause.row, "")
    return cause.sentence.removeprefix(front) if cause.sentence.startswith(front) else ""
