"""What is wrong with a cell, told from what is written and what is meant.

A relation between the two numbers (another sign, 90° apart, thousand times as much) is a likelier
slip than a number that has nothing to do with the one meant: ``cost`` orders explanations that
repair the table equally well.
"""

from __future__ import annotations

import math
from collections.abc import Iterator
from dataclasses import dataclass, field
from typing import Any

import numpy as np

from kinlab.arrays import Array
from kinlab.host.language import N_, _
from kinlab.tolerances import TOLERANCES

SIX = 2.7
"""Cost of a base or tool all of whose six numbers are solved for: more than two slips of a known
kind, which have no number to solve for."""

_TURN = 2.0 * math.pi
_ROUND = math.pi / 12
"""Angles of tables are mostly multiples of 15°."""


@dataclass(frozen=True, eq=False)
class Cause:
    """One slip.

    Attributes:
        row: 1-based; a tuple where several rows belong together; None for the whole table.
        column: ``"a"``, ``"alpha"``, ``"d"``, ``"theta"``, ``"convention"``, ``"joint"``,
            ``"flip"``, ``"tool"``, ``"base"``, ``"gravity"``, ``"mass"``, ``"com"``,
            ``"inertia"``, ``"armature"``, ``"order"`` or ``"units"``.
        written: what stands there.
        meant: what should stand there.
        kind: what sort of slip it is, in a word or two.
        sentence: the slip in words.
        cost: the less, the likelier among explanations that repair equally much.
        short: the slip alone, without its row and numbers, where several rows may share it.
    """

    row: int | tuple[int, ...] | None
    column: str
    written: Any
    meant: Any
    kind: str
    sentence: str
    cost: float = field(default=1.0, repr=False)
    short: str = field(default="", repr=False)

    @property
    def rows(self) -> tuple[int, ...]:
        """The rows, empty for the whole table."""
        if self.row is None:
            return ()
        return self.row if isinstance(self.row, tuple) else (self.row,)

    def as_dict(self) -> dict[str, Any]:
        """Plain values for JSON."""
        return {
            "row": list(self.row) if isinstance(self.row, tuple) else self.row,
            "column": self.column,
            "written": plain(self.written),
            "meant": plain(self.meant),
            "kind": self.kind,
            "sentence": self.sentence,
        }


def plain(value: Any) -> Any:
    """Numbers, text and lists in place of arrays."""
    if isinstance(value, np.ndarray):
        return value.tolist()
    if isinstance(value, (np.floating, np.bool_)):
        return value.item()
    if isinstance(value, tuple):
        return [plain(v) for v in value]
    return value


def where(row: int | tuple[int, ...]) -> str:
    """``row 3``, or ``rows 2 and 3``."""
    if isinstance(row, int):
        return _("row {number}").format(number=row)
    return _("rows {numbers}").format(numbers=listed(row))


def listed(items: Any) -> str:
    """``1``, ``1 and 2``, ``1, 2 and 3``."""
    words = [str(item) for item in items]
    if len(words) == 1:
        return words[0]
    several = _("{first} and {last}")
    return several.format(first=_(", ").join(words[:-1]), last=words[-1])


def at_row(row: int | tuple[int, ...], told: str) -> str:
    """``row 3: alpha lacks 90 deg``: where, and what is wrong there."""
    return _("{rows}: {slip}").format(rows=where(row), slip=told)


def number(value: float) -> str:
    """A length or mass in up to ten digits."""
    return f"{value + 0.0:.10g}"


def degrees(angle: float) -> str:
    """An angle in degrees, ``-90 deg``."""
    return f"{math.degrees(angle) + 0.0:.9g} deg"


def wrapped(angle: float) -> float:
    """The same angle from -180° (excluded) to 180°, and the multiple of 15° it is to rounding."""
    turned = -((-angle + math.pi) % _TURN) + math.pi
    nearest = round(turned / _ROUND) * _ROUND
    return nearest if abs(turned - nearest) < 1e-8 else turned


def tidy_length(length: float, written: float) -> float:
    """A solved length without its rounding residue: of twelve digits, or zero."""
    scale = max(abs(length), abs(written), 1e-3)
    short = float(f"{length:.9g}")
    if abs(length) < 1e-9 * scale:
        return 0.0
    return short if abs(short - length) < 1e-9 * scale else length


def angle_cause(
    row: int, column: str, written: float, solved: float, slack: float = TOLERANCES.solved_angle
) -> Cause:
    """Names a slip in alpha or theta.

    Args:
        row: 1-based.
        column: ``"alpha"`` or ``"theta"``.
        written, solved: rad; ``solved`` is what the poses ask for.
        slack: how far ``solved`` may be off, rad. Within it the number that a relation gives is
            the one meant.
    """
    for kind, value, cost in _angle_relations(written):
        if not _same_angle(value, solved, slack):
            continue
        meant = wrapped(value)
        if kind == "missing" and not _round(solved, slack):
            meant, cost = wrapped(solved), 1.6
        fields = {"written": degrees(written), "meant": degrees(meant)}
        if kind == "degrees":
            fields["written"] = number(written)
        if kind == "decimal":
            fields = {"written": f"{number(written)} rad", "meant": f"{number(meant)} rad"}
        fields["change"] = degrees(wrapped(meant - written))
        told = _(_ANGLE_SLIPS[kind]).format(cell=column, **fields)
        return Cause(row, column, written, meant, kind, at_row(row, told), cost)
    meant = wrapped(solved)
    change = degrees(wrapped(meant - written))
    if _close(written, 0.0):
        told = at_row(row, _(_ANGLE_SLIPS["missing"]).format(cell=column, change=change))
        cost = 1.0 if _round(meant, TOLERANCES.solved_angle) else 1.6
        return Cause(row, column, written, meant, "missing", told, cost)
    kind, cost = _typed(written, meant)
    if cost > 1.7:
        kind, cost = _typed(math.degrees(written), math.degrees(meant))
    fields = {"change": change, "written": degrees(written), "meant": degrees(meant)}
    told = at_row(row, _(_ANGLE_SLIPS["quarter-turn"]).format(cell=column, **fields))
    return Cause(row, column, written, meant, kind, told, cost)


_ANGLE_SLIPS = {
    "degrees": N_("{cell} is in degrees: {written} written, {meant} meant"),
    "missing": N_("{cell} lacks {change}"),
    "sign": N_("{cell} has the wrong sign: {written} written, {meant} meant"),
    "half-turn": N_("{cell} is 180 deg off: {written} written, {meant} meant"),
    "quarter-turn": N_("{cell} lacks {change}: {written} written, {meant} meant"),
    "radians for degrees": N_(
        "{cell} was turned into radians twice: {written} written, {meant} meant"
    ),
    "decimal": N_("{cell} has the decimal point displaced: {written} written, {meant} meant"),
    "superfluous": N_("{cell} must be zero: {written} written"),
}
_LENGTH_SLIPS = {
    "sign": _ANGLE_SLIPS["sign"],
    "millimetres": N_("{cell} is in millimetres: {written} written, {meant} meant"),
    "decimal": _ANGLE_SLIPS["decimal"],
    "inches": N_("{cell} is in inches: {written} written, {meant} meant"),
    "superfluous": _ANGLE_SLIPS["superfluous"],
}


def _angle_relations(written: float) -> Iterator[tuple[str, float, float]]:
    """Kinds of slips, the angle each one makes of what is written, and its cost."""
    in_degrees = math.radians(written)
    if abs(written) > _TURN + 1e-9:
        yield "degrees", in_degrees, 1.0
    if _close(written, 0.0):
        for k in range(-11, 13):
            yield "missing", k * _ROUND, 1.0
        return
    yield "sign", -written, 1.0
    if abs(written) > 0.7:
        yield "degrees", in_degrees, 1.2
    yield "half-turn", written + math.pi, 1.1
    yield "quarter-turn", written + math.pi / 2, 1.1
    yield "quarter-turn", written - math.pi / 2, 1.1
    yield "radians for degrees", math.degrees(written), 1.2
    for power in (1, -1, 2, -2, 3, -3):
        yield "decimal", written * 10.0**power, 1.2
    yield "superfluous", 0.0, 1.4


def length_cause(
    row: int, column: str, written: float, solved: float, slides: bool, slack: float = 0.0
) -> Cause:
    """Names a slip in a or d.

    Args:
        row: 1-based.
        column: ``"a"`` or ``"d"``.
        written, solved: m; ``solved`` is what the poses ask for.
        slides: the cell is the offset of a prismatic joint.
        slack: how far ``solved`` may be off, m.
    """
    cell = column
    if slides and column == "d":
        cell = _("{cell}, the offset of the prismatic joint,").format(cell=column)
    if not _close(written, 0.0):
        for kind, meant, cost in _length_relations(written):
            if abs(meant - solved) > slack and not _close(meant, solved):
                continue
            told = _(_LENGTH_SLIPS[kind]).format(
                cell=cell, written=number(written), meant=number(meant)
            )
            return Cause(row, column, written, meant, kind, at_row(row, told), cost)
    meant = _rounded(solved, slack)
    if _close(written, 0.0):
        told = _("{cell} lacks {meant} m").format(cell=cell, meant=number(meant))
        return Cause(row, column, written, meant, "missing", at_row(row, told), 1.3)
    kind, cost = _typed(written, meant)
    told = _("{cell} is wrong: {written} written, {meant} meant").format(
        cell=cell, written=number(written), meant=number(meant)
    )
    return Cause(row, column, written, meant, kind, at_row(row, told), cost)


def _length_relations(written: float) -> Iterator[tuple[str, float, float]]:
    yield "sign", -written, 1.0
    yield "millimetres", written / 1000.0, 1.0
    for power in (1, -1, 2, -2, 3, -3):
        yield "decimal", written * 10.0**power, 1.1
    yield "inches", written * 0.0254, 1.2
    yield "superfluous", 0.0, 1.5


def _rounded(value: float, slack: float) -> float:
    """The value in no more digits than its uncertainty allows."""
    if slack < 1e-9:
        return value
    return round(value, max(0, math.ceil(-math.log10(slack))))


def _typed(written: float, meant: float) -> tuple[str, float]:
    """A number that shares its digits with the one meant is a misprint."""
    one, two = (f"{abs(x):.6g}".replace(".", "").lstrip("0") for x in (written, meant))
    if written * meant > 0 and len(one) > 1 and abs(len(one) - len(two)) <= 1:
        if sorted(one) == sorted(two):
            return "digits exchanged", 1.5
        if len(one) == len(two) and sum(x != y for x, y in zip(one, two, strict=True)) == 1:
            return "digit", 1.5
        if len(one) != len(two) and (one.startswith(two) or two.startswith(one)):
            return "digit", 1.5
    return "value", 2.0


def pose_cause(
    which: str, written: Array, solved: Array, known: Array | None = None, slack: float = 0.0
) -> Cause:
    """Names a slip in base or tool, (4, 4) each.

    Args:
        which: ``"base"`` or ``"tool"``.
        written, solved: ``solved`` is what the poses ask for.
        known: the reference's own.
        slack: how far entries of ``solved`` may be off.
    """
    meant = solved

    def cause(kind: str, told: str, cost: float) -> Cause:
        said = _(told).format(frame=_(FRAMES[which]), meant=pose_text(meant))
        return Cause(None, which, written, meant, kind, said, cost)

    if _same_pose(written, np.eye(4)):
        sure = known is not None and _same_pose(known, meant, slack)
        return cause("missing", N_("{frame} is missing: {meant}"), 1.2 if sure else 1.9)
    for kind, value, told in _pose_relations(written):
        if _same_pose(value, solved, slack):
            meant = value
            return cause(kind, told, 1.0)
    if _same_pose(meant, np.eye(4), slack):
        meant = np.eye(4)
        return cause("superfluous", N_("{frame} must be the identity"), 1.8)
    return cause("value", N_("{frame} is wrong: meant is {meant}"), SIX)


FRAMES = {"base": N_("base"), "tool": N_("tool")}
"""The frames at the ends of a chain, as they are told."""


def _pose_relations(written: Array) -> Iterator[tuple[str, Array, str]]:
    turned = np.array(written)
    turned[:3, :3] = written[:3, :3].T
    back = np.array(turned)
    back[:3, 3] = -turned[:3, :3] @ written[:3, 3]
    yield "inverted", back, N_("{frame} is inverted: meant is {meant}")
    yield "transposed", turned, N_("{frame} has its rotation transposed")
    if not np.any(written[:3, 3]):
        return
    metres = N_("{frame} has the slip 'millimetres' in its translation: meant is {meant}")
    point = N_("{frame} has the slip 'decimal' in its translation: meant is {meant}")
    sign = N_("{frame} has the slip 'sign' in its translation: meant is {meant}")
    ways = ((1e-3, "millimetres", metres), (0.1, "decimal", point), (10.0, "decimal", point))
    for factor, kind, told in (*ways, (-1.0, "sign", sign)):
        scaled = np.array(written)
        scaled[:3, 3] *= factor
        yield kind, scaled, told


def pose_text(pose: Array) -> str:
    """A pose as translation and roll, pitch, yaw."""
    from kinlab.model.rotations import matrices_rpy

    place = ", ".join(number(float(round(x, 9))) for x in pose[:3, 3])
    if np.max(np.abs(pose[:3, :3] - np.eye(3))) < 1e-9:
        return _("shift ({place}) m").format(place=place)
    turn = ", ".join(f"{math.degrees(x) + 0.0:.6g}" for x in matrices_rpy([pose[:3, :3]])[0])
    return _("shift ({place}) m, roll, pitch, yaw ({turn}) deg").format(place=place, turn=turn)


def _same_pose(one: Array, two: Array, slack: float = 0.0) -> bool:
    scale = max(1.0, float(np.max(np.abs(two))))
    return bool(np.max(np.abs(one - two)) < max(slack, 1e-8) * scale)


def _same_angle(one: float, two: float, slack: float) -> bool:
    return abs(math.remainder(one - two, _TURN)) < slack


def _close(one: float, two: float) -> bool:
    return abs(one - two) <= TOLERANCES.same_relation * max(abs(one), abs(two)) + 1e-10


def _round(angle: float, slack: float) -> bool:
    return abs(math.remainder(angle, _ROUND)) < slack
