"""A hand formula, judged: a verdict, ranked causes with their evidence, the corrected formula.

The doctor, which stands above this room, makes them; :func:`kinlab.diagnose` answers with one, and
the reports show them.
"""

from __future__ import annotations

import re
from dataclasses import dataclass, field
from typing import Any

import numpy as np

from kinlab.arrays import Array
from kinlab.formulas.text import base_of
from kinlab.host.introductions import Answer, Introduction
from kinlab.host.language import N_, _, speaking

Typeset = tuple[str, str]
"""A name and a formula, both as LaTeX."""

_VERDICTS = {
    "": N_("agrees"),
    "rounded": N_("agrees, with rounded numbers"),
    "unusual": N_("agrees, written unusually"),
    "digits": N_("agrees to its digits"),
}
_GRADES = {
    "": N_("right"),
    "rounded": N_("right with rounded numbers"),
    "unusual": N_("right but written unusually"),
    "digits": N_("right to its digits"),
}
ENTRY_LETTERS = {
    "inverse_dynamics": "tau",
    "statics": "tau",
    "gravity_torques": "g",
    "coriolis_torques": "c",
    "mass_matrix": "M",
    "coriolis_matrix": "C",
    "jacobian": "J",
    "planar_jacobian": "J",
    "fk": "T",
    "kinetic_energy": "T",
    "potential_energy": "V",
}
"""What a quantity is called where its entries have no other name."""
PLANAR_POSE = {"0": "x", "1": "y", "2": "cos(phi)", "3": "sin(phi)"}
"""What the entries of a planar pose are."""

_ENTRY = re.compile(r"(\w+)\[([0-8](?:,[0-8])*)\]")
_OTHERS = 3
"""Causes that are told beside the first."""


def not_judged(entry: str, reason: str) -> str:
    """What is told of a formula that was not judged.

    Args:
        entry: what people call it.
        reason: why, a clause.
    """
    return _("{entry}: not judged: {reason}").format(entry=entry, reason=reason)


@dataclass(frozen=True)
class Cause:
    """One explanation that accounts for every state.

    Attributes:
        sentence: what is wrong, in plain words.
        kinds: the names of the confusions or slips in it.
        places: the links, rows or entries they are at.
        error_after: relative error that is left once it is repaired; at most 1e-9, or what the
            finite differences of a function leave (1e-5).
        cost: how far-fetched it is; causes are ranked by it.
        corrected: the right formulas by entry, where they are known.
        typed: those of them that their writer would type in another way: as LaTeX, MATLAB, ...
    """

    sentence: str
    kinds: tuple[str, ...]
    places: tuple[str, ...]
    error_after: float
    cost: float
    corrected: dict[str, str] = field(default_factory=dict)
    typed: dict[str, str] = field(default_factory=dict)

    @property
    def shown(self) -> dict[str, str]:
        """The right formulas by entry, as their writer would type them."""
        return {**self.corrected, **self.typed}


@dataclass(frozen=True, eq=False, repr=False)
class Diagnosis(Answer):
    """A hand formula, judged.

    Attributes:
        quantity, robot, function: what was compared.
        agrees: whether the formula is right: the engine's to rounding, or to the digits it is
            written with, or another valid one.
        error_before: its largest relative error over the states.
        causes: what explains the difference, the simplest first; empty where nothing does.
        partial: entries that are explained where others are not.
        worst_entry: the entry that is furthest off.
        worst_state: the state where, by argument.
        hand, engine: both answers there.
        source: the file the formula is from, where it is from one.
        form: how a right formula is right: ``""`` (as the engine has it), ``"rounded"`` (with
            rounded numbers), ``"unusual"`` (another valid one) or ``"digits"`` (to so many digits
            that no slip is known to be so small). Of a formula that nothing explains ``"near"``:
            so close that rounded constants may be all that is wrong with it; ``"words"`` where
            words beside it may mean that it claims something else, so that it is not judged.
        remarks: what is to be said of a right formula: which numbers are rounded, for which robot
            alone it holds, in what it is unusual; of a wrong one, what kept from finding more.
        proved: of a formula that nothing explains, what of it is right all the same: kinds of term
            (gravity, velocities, accelerations) and entries, in sentences.
        given, corrected: for a report, the formulas as written, and as they should be where that
            is known.
    """

    quantity: str
    robot: str
    function: str
    agrees: bool
    error_before: float
    causes: tuple[Cause, ...] = ()
    partial: tuple[str, ...] = ()
    worst_entry: str = ""
    worst_state: dict[str, Array] = field(default_factory=dict, repr=False)
    hand: Array | None = field(default=None, repr=False)
    engine: Array | None = field(default=None, repr=False)
    form: str = ""
    remarks: tuple[str, ...] = ()
    proved: tuple[str, ...] = ()
    source: str = field(default="", repr=False)
    given: tuple[Typeset, ...] = field(default=(), repr=False)
    corrected: tuple[Typeset, ...] = field(default=(), repr=False)

    @property
    def known(self) -> bool:
        """Whether what is wrong is known."""
        return bool(self.causes)

    @property
    def error_after(self) -> float | None:
        """The relative error that the first cause leaves once it is repaired."""
        return self.causes[0].error_after if self.causes else None

    @property
    def others(self) -> tuple[str, ...]:
        """What explains the difference equally well, in sentences."""
        return tuple(cause.sentence for cause in self.causes[1 : _OTHERS + 1])

    @property
    def evidence(self) -> tuple[str, ...]:
        """What is explained, the worst entry and its state, where the cause is unknown."""
        if self.agrees or self.causes:
            return ()
        if self._other_shape:
            return (self._shapes, *self.partial)
        worst = _("Worst entry {entry} at {state}").format(
            entry=self._worst, state=self._at_worst(200)
        )
        explained = (_("Explained: {slip}").format(slip=text) for text in self.partial)
        return (*self.proved, *explained, worst)

    @property
    def verdict(self) -> str:
        """``"agrees"`` (also with ``", with rounded numbers"`` or ``", written unusually"`` behind
        it), ``"differs"`` or ``"differs, cause unknown"``.
        """
        if self.agrees:
            return _VERDICTS[self.form]
        if self.form == "near":
            return N_("nearly agrees, cause unknown")
        if self.form == "words":
            return N_("not judged")
        return N_("differs") if self.causes else N_("differs, cause unknown")

    @property
    def grade(self) -> str:
        """As a teacher says it: ``"right"``, ``"right with rounded numbers"``, ``"right but written
        unusually"`` or ``"wrong"``.
        """
        if self.form in ("near", "words"):
            return N_("not sure")
        return _GRADES[self.form] if self.agrees else N_("wrong")

    @property
    def sentence(self) -> str:
        """The diagnosis in one sentence."""
        if self.agrees:
            said = _("{function} is {quantity} of {robot}").format(**self._names)
            return _("; ").join((said, *self.remarks))
        if self.causes:
            return self.causes[0].sentence
        if self.form == "words":
            return not_judged(self.title, self.reason)
        if self.form == "near":
            said = _(
                "{function} is {quantity} of {robot} to {digits} digits only: rounded constants, "
                "or a small slip?"
            ).format(digits=max(1, int(-np.log10(2 * self.error_before))), **self._names)
        else:
            said = _("{function} is not {quantity} of {robot}; no known slip explains it").format(
                **self._names
            )
        return _("; ").join((said, *self.proved))

    @property
    def reason(self) -> str:
        """Of a formula that was not judged for words beside it: which, and what is to be said."""
        return _("; ").join(self.remarks)

    @property
    def _worst(self) -> str:
        """The worst entry; by the writer's name, where only one is judged."""
        alone = self.worst_entry == self.quantity and "[" in self.quantity
        return self.function if alone else shown_entry(self.worst_entry)

    @property
    def _other_shape(self) -> bool:
        if self.hand is None or self.engine is None:
            return False
        return np.shape(self.hand) != np.shape(self.engine)

    @property
    def _shapes(self) -> str:
        told = _("it answers with {hand}, {quantity} has {engine}")
        hand, engine = (_numbers(np.shape(np.asarray(x))) for x in (self.hand, self.engine))
        return told.format(quantity=self._names["quantity"], hand=hand, engine=engine)

    @property
    def title(self) -> str:
        """What was examined, as people say it: M11, M12 for entries of a matrix in a text."""
        return ", ".join(map(shown_entry, self.function.split(", ")))

    @property
    def claimed(self) -> str:
        """What it was held against, as people say it: entries counted from 1."""
        found = _ENTRY.fullmatch(self.quantity)
        if found is None:
            return self.quantity
        place = ", ".join(str(int(k) + 1) for k in found[2].split(","))
        place = f"({place})" if "," in place else place
        return _("entry {place} of {quantity}").format(place=place, quantity=found[1])

    @property
    def _names(self) -> dict[str, str]:
        return {"function": self.title, "quantity": self.claimed, "robot": self.robot}

    def introduction(self) -> Introduction:
        """The verdict, what is wrong, and what is right."""
        verdict = _("{function}: {verdict} ({quantity} of {robot})").format(
            verdict=_(self.verdict), **self._names
        )
        if self.agrees and self.form == "unusual":  # the difference is none of an error
            return Introduction(verdict, tuple(self.remarks), mood="good")
        if self.agrees:
            text = _("{verdict}, largest relative error {error:.2g}").format(
                verdict=verdict, error=self.error_before
            )
            return Introduction(text, tuple(self.remarks), mood="good")
        if self.causes:
            best = self.causes[0]
            errors = _("relative error before {before:.3g}, after {after:.2g}").format(
                before=self.error_before, after=best.error_after
            )
            lines = [best.sentence, errors]
            lines += [
                _("correct: {formula}").format(formula=f"{shown_entry(name)} = {text}")
                for name, text in best.shown.items()
            ]
            lines += [_("or: {slip}").format(slip=text) for text in self.others]
            return Introduction(verdict, (*lines, *self.remarks), mood="bad")
        if self._other_shape:
            return Introduction(verdict, (self._shapes, *self.partial), mood="unsure")
        lines = [*self.proved]
        lines += [_("explained: {slip}").format(slip=text) for text in self.partial]
        lines.append(
            _("relative error {error:.3g}; worst entry {entry} at {state}").format(
                error=self.error_before,
                entry=self._worst,
                state=self._at_worst(100),
            )
        )
        lines += self.remarks if self.form != "words" else ()
        return Introduction(verdict, tuple(lines), mood="unsure")

    def _at_worst(self, width: int) -> str:
        """The worst state and both answers there."""
        with np.printoptions(precision=6, suppress=True, linewidth=width):
            state = ", ".join(f"{name} = {value}" for name, value in self.worst_state.items())
            return _("{state}: hand {hand}, engine {engine}").format(
                state=state, hand=self.hand, engine=self.engine
            )

    @speaking("en")
    def as_dict(self) -> dict[str, Any]:
        """Plain values for JSON, in English, whatever language is spoken."""
        return {
            "quantity": self.quantity,
            "robot": self.robot,
            "function": self.function,
            "verdict": self.verdict,
            "grade": self.grade,
            "remarks": list(self.remarks),
            "diagnosis": self.sentence,
            "error_before": _finite(self.error_before),
            "causes": [
                {
                    "sentence": c.sentence,
                    "kinds": list(c.kinds),
                    "places": list(c.places),
                    "error_after": _finite(c.error_after),
                    "corrected": c.shown,
                }
                for c in self.causes
            ],
            "proved": list(self.proved),
            "explained_entries": list(self.partial),
            "worst_entry": self.worst_entry,
            "worst_state": {name: np.ravel(v).tolist() for name, v in self.worst_state.items()},
        }


def shown_entry(label: str) -> str:
    """An entry as people write it, counted from 1: ``tau1`` for ``inverse_dynamics[0]``.

    Without a letter ``christoffel(1,2,3)``; of a square that a writer explains ``v2^2``; what is no
    single entry stays as it is.
    """
    found = _ENTRY.fullmatch(label)
    if found is None:
        base = base_of(label)
        return f"{base}^2" if base else label
    if found[1] == "planar_pose" and found[2] in PLANAR_POSE:
        return PLANAR_POSE[found[2]]
    places = [str(int(k) + 1) for k in found[2].split(",")]
    letter = ENTRY_LETTERS.get(found[1])
    return letter + "".join(places) if letter else f"{found[1]}({','.join(places)})"


def _numbers(shape: tuple[int, ...]) -> str:
    if not shape:
        return _("a single number")
    return _("{count} numbers").format(count=" x ".join(map(str, shape)))


def _finite(value: float) -> float | None:
    return float(value) if np.isfinite(value) else None
