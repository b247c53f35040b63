"""Dynamic slips: masses, centres, inertias, armatures and gravity, link by link.

A body is told by what no choice of link frames can change: its mass, the place of its centre and
its inertia about it with the axes of the world, all at q = 0; what is welded together counts as
one body. Both sides are brought into that form, and what differs is brought back into the frame
of the user's row, so that the numbers meant are known; the relation of the written ones to them
names the slip.
"""

from __future__ import annotations

from dataclasses import dataclass, replace

import numpy as np

from kinlab.arrays import Array
from kinlab.doctor.tables.body_slips import (
    Body,
    armature_cause,
    com_cause,
    gravity_cause,
    inertia_cause,
    mass_cause,
)
from kinlab.doctor.tables.chain import Chain, frames, inverse
from kinlab.doctor.tables.words import Cause
from kinlab.host.language import _
from kinlab.model.dh import DHTable, with_links
from kinlab.tolerances import TOLERANCES


@dataclass(frozen=True, eq=False)
class Bodies:
    """The moving bodies of an arm at q = 0, in the world.

    Attributes:
        mass: kg, (n,).
        com: centres, (n, 3), m.
        inertia: about the centres, axes of the world, (n, 3, 3), kg m².
        armature: (n,), or None where the reference has no place for it.
        gravity: (3,), m/s², or None likewise.
    """

    mass: Array
    com: Array
    inertia: Array
    armature: Array | None
    gravity: Array | None
    digit: float = 0.0
    """One unit of the last digit of printed numbers; 0 where all digits are known."""

    @property
    def any(self) -> bool:
        """Whether any body has mass or inertia."""
        return bool(self.mass.any() or self.inertia.any())

    @staticmethod
    def of(table: DHTable) -> Bodies:
        """The bodies of a table."""
        poses = frames(Chain.of(table), np.zeros((1, table.n)))[0, 1:-1]
        com = np.array([link.com for link in table.links])
        inertia = np.array([link.inertia for link in table.links])
        rotation = poses[:, :3, :3]
        return Bodies(
            np.array([link.mass for link in table.links]),
            (rotation @ com[..., None])[..., 0] + poses[:, :3, 3],
            rotation @ inertia @ np.swapaxes(rotation, -1, -2),
            np.array([link.armature for link in table.links]),
            np.array(table.gravity),
        )


ROUNDING = "rounding"
"""The kind of what differs in its last digits."""


def differences(table: DHTable, bodies: Bodies) -> tuple[DHTable, list[Cause]]:
    """Compares a table's bodies with a reference's, kinematics being the same.

    Args:
        table: the table, its kinematic slips taken back.
        bodies: of the reference.

    Returns:
        The table with the bodies of the reference, and one cause for each cell that differs; what
        differs in the last digits alone is of the kind :data:`ROUNDING`.
    """
    mine = Bodies.of(table)
    poses = frames(Chain.of(table), np.zeros((1, table.n)))[0]
    size = max(1.0, float(np.max(np.abs(poses[:, :3, 3]))))
    causes: list[Cause] = []
    links = list(table.links)
    slack = 2.0 * bodies.digit
    for i, link in enumerate(table.links):
        back = inverse(poses[i + 1])
        com = back[:3, :3] @ bodies.com[i] + back[:3, 3]
        inertia = back[:3, :3] @ bodies.inertia[i] @ back[:3, :3].T
        one = Body(
            i + 1, link, float(bodies.mass[i]), com, 0.5 * (inertia + inertia.T), slack, poses
        )
        changes: dict[str, object] = {}
        if abs(one.mass - link.mass) > TOLERANCES.same_body * max(one.mass, link.mass) + slack:
            causes.append(mass_cause(one))
            changes["mass"] = one.mass
        near = slack * (table.n + 1) * size
        off = float(np.max(np.abs(com - np.asarray(link.com))))
        if one.mass > 0.0 and off > 1e-9 * size + near and off <= TOLERANCES.last_digit * size:
            causes.append(_rounding(i + 1, "com", off))
        elif one.mass > 0.0 and off > 1e-9 * size + near:
            clean = _tidy(com)
            causes.append(com_cause(replace(one, com=clean, slack=near)))
            changes["com"] = clean
        limit = slack * (table.n + 1) * max(1.0, float(np.max(np.abs(inertia)))) + (
            TOLERANCES.same_body * float(np.max(np.abs(inertia)))
            + 1e-14
            + 1e-10 * float(np.max(np.abs(link.inertia)))
        )
        off = float(np.max(np.abs(one.inertia - np.asarray(link.inertia))))
        if limit < off <= TOLERANCES.last_digit * float(np.max(np.abs(inertia))):
            causes.append(_rounding(i + 1, "inertia", off))
        elif off > limit:
            clean = _tidy(one.inertia)
            causes.append(inertia_cause(replace(one, inertia=clean, slack=limit if slack else 0.0)))
            changes["inertia"] = clean
        if bodies.armature is not None:
            meant = float(bodies.armature[i])
            if abs(meant - link.armature) > TOLERANCES.same_body * max(meant, link.armature):
                causes.append(armature_cause(i + 1, link.armature, meant))
                changes["armature"] = meant
        if changes:
            links[i] = replace(link, **changes)  # type: ignore[arg-type]
    repaired = with_links(table, links)
    if bodies.gravity is not None and mine.gravity is not None:
        gap = float(np.max(np.abs(bodies.gravity - mine.gravity)))
        if gap > 1e-9 * max(1.0, float(np.max(np.abs(bodies.gravity)))):
            causes.append(gravity_cause(mine.gravity, bodies.gravity, poses))
            repaired = replace(repaired, gravity=bodies.gravity)
    return repaired, _together(causes, table.n)


def _rounding(row: int, column: str, off: float) -> Cause:
    said = _("row {row}: {column} agrees to six digits: {off:.1e} apart")
    told = said.format(row=row, column=column, off=off)
    return Cause(row, column, None, None, ROUNDING, told, 0.0, told)


def _tidy(values: Array) -> Array:
    """Without rounding residue, relative to the largest entry."""
    scale = float(np.max(np.abs(values), initial=0.0)) or 1.0
    digits = 13 - int(np.floor(np.log10(scale)))
    return np.asarray(np.round(values, digits) + 0.0) if digits < 300 else values


def _together(causes: list[Cause], n: int) -> list[Cause]:
    """The same slip in three rows or more, or in all of them, is one."""
    out: list[Cause] = []
    for cause in causes:
        same = [c for c in causes if (c.column, c.kind) == (cause.column, cause.kind)]
        every = len(same) > 1 and len(same) == n
        if (len(same) < 3 and not every) or cause.kind == "value" or cause.row is None:
            out.append(cause)
            continue
        if same[0] is not cause:
            continue
        rows = tuple(row for c in same for row in c.rows)
        told = _("rows {rows}: {slip}")
        named = _(", ").join(map(str, rows))
        if rows == tuple(range(rows[0], rows[-1] + 1)):
            told = _("rows {first} to {last}: {slip}")
        told = told.format(rows=named, first=rows[0], last=rows[-1], slip=cause.short)
        written, meant = [c.written for c in same], [c.meant for c in same]
        out.append(Cause(rows, cause.column, written, meant, cause.kind, told, cause.cost))
    return out
