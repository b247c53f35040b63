"""Two descriptions of one arm disagree: which cell of the table is wrong?"""

from __future__ import annotations

import warnings
from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import ArrayLike

from kinlab.arrays import Array, seed_of
from kinlab.doctor.tables import bodies as table_bodies
from kinlab.doctor.tables import noise as table_noise
from kinlab.doctor.tables import zeros as table_zeros
from kinlab.doctor.tables.chain import Chain
from kinlab.doctor.tables.readings import Reading
from kinlab.doctor.tables.reference.against import (
    Reference,
    check_joints,
    joint_counts,
    of_poses,
    read_mine,
    read_reference,
)
from kinlab.doctor.tables.result import TableDiagnosis, joined, stated
from kinlab.doctor.tables.search import explain
from kinlab.doctor.tables.words import SIX, Cause, listed
from kinlab.errors import InertiaError, KinlabWarning, OptionError, StructureError, TableError
from kinlab.host.language import N_, _, ngettext
from kinlab.model.dh import DHTable
from kinlab.model.robot import Robot

MOST = 2
"""Slips that are named at most; three would explain too much."""


def diagnose_table(
    mine: DHTable | Robot | str | Path,
    against: Any = None,
    *,
    poses: tuple[ArrayLike, ArrayLike] | None = None,
    tool: str | None = None,
    dynamics: bool | None = None,
    seed: int = 0,
) -> TableDiagnosis:
    """Says which cell of a DH table is wrong, from another description of the same arm.

    Two descriptions agree when the tool has the same pose in the same base at the same joint
    positions; rows may differ, for DH is not unique. Where only zeros of joints, base or tool
    differ, the diagnosis says so (``same_arm``) and still names the cells, for at the same q the
    poses do differ. A cause is named only if taking it back gives the reference's pose at every
    state, to 1e-9 of the arm's size.

    Args:
        mine: the table that may be wrong: a DHTable, a .toml or .csv file, a shipped name.
        against: the other description: a DHTable, a Robot, a name, a .toml, .csv or .urdf file,
            URDF text, a CSV of poses (see :mod:`kinlab.doctor.tables.reference.poses`), or ``(q,
            T)``.
        poses: ``(q, T)``: joint positions (N, n), rad and m, and tool poses (N, 4, 4) in the
            frame in which the table's base stands, simulated or measured.
        tool: for a URDF: the link that is the tool.
        dynamics: compare masses, centres, inertias, armatures and gravity too. Left out: where
            both descriptions have masses.
        seed: of the states at which whole descriptions are compared.

    Returns:
        The diagnosis.

    Raises:
        TableError: ``mine`` is no DH table, or nothing is given to hold it against.
        StructureError: other numbers of joints that no row left out or doubled explains.
        InertiaError: dynamics asked for where a side has none.
        KinlabError: a file or robot that cannot be used, with its remedy.
    """
    table, seed = read_mine(mine), seed_of(seed)
    if (against is None) == (poses is None):
        raise TableError("diagnose_table: give either against= or poses=(q, T)")
    if poses is not None:
        if not isinstance(poses, (tuple, list)) or len(poses) != 2:
            raise OptionError("diagnose_table: poses is a pair (q, T)")
        reference = of_poses(*poses)
    else:
        reference = read_reference(against, table, tool=tool, seed=seed)
    notes = [*reference.notes, *check_joints(table, reference), *_at_rest(table, reference)]
    wanted = _compares_bodies(table, reference, dynamics, notes)
    if wanted and any(x.viscous_friction or x.coulomb_friction for x in table.links):
        notes.append(_("friction is not compared"))
    return _judge(table, reference, wanted, notes)


def _compares_bodies(
    table: DHTable, reference: Reference, dynamics: bool | None, notes: list[str]
) -> bool:
    """Whether bodies are compared; why not goes to the notes, or is refused where asked for."""
    has = table_bodies.Bodies.of(table).any
    if dynamics is False:
        return False
    lacking = ""
    if reference.axes is None:
        lacking = N_("poses say nothing of masses") if dynamics else ""
    elif reference.bodies is None and (has or dynamics):
        lacking = N_(
            "{reference!r} has no masses: give a table or a URDF whose links have <inertial>"
        )
    elif not has and (reference.bodies is not None or dynamics):
        lacking = N_("table {table!r} has no masses: fill in mass, com and inertia of its rows")
    names = {"reference": reference.name, "table": table.name}
    if lacking and dynamics:
        why = lacking.format(**names)
        raise InertiaError(f"dynamics cannot be compared: {why}, or leave dynamics out")
    if lacking:
        why = _(lacking).format(**names)
        notes.append(_("kinematics alone are compared; {why}").format(why=why))
    return reference.bodies is not None and has


def _judge(table: DHTable, reference: Reference, bodies: bool, notes: list[str]) -> TableDiagnosis:
    chain = Chain.of(table)
    before = reference.target.error(chain)
    agreed = before <= reference.target.tolerance
    found = [Reading(chain)] if agreed else _explained(chain, reference, (1,))
    if not found and reference.axes is None and table.n == reference.n:
        fit = table_noise.Calibration.of(chain, reference.target)
        bad = table_noise.standing_out(chain, fit)
        if bad:
            fewer = table_noise.without(reference, bad)
            return _judge(table, fewer, bodies, [*notes, _left_out(bad)])
        noisy = table_noise.judge(table, reference, fit, notes)
        if noisy is not None:
            return noisy
    if not found or found[0].cost >= SIX:
        found = _explained(chain, reference, (1, 2))
    same = None
    if not found:
        same = table_zeros.same_arm(chain, reference)
        found = [] if same is None else [same]
    if not found and reference.sharper is not None:
        return _judge(table, reference.sharper, bodies, [*notes, *reference.sharper.notes[-1:]])
    if not found and table.n != reference.n:
        raise StructureError(joint_counts(table, reference))
    return _told(table, reference, found, same is not None, bodies, before, notes)


def _explained(chain: Chain, reference: Reference, slips: tuple[int, ...]) -> list[Reading]:
    bases, tools = table_zeros.ends(chain, reference)
    return explain(
        chain, reference.target, [*reference.base, *bases], [*reference.tool, *tools], slips
    )


def _told(
    table: DHTable,
    reference: Reference,
    found: list[Reading],
    many: bool,
    bodies: bool,
    before: float,
    notes: list[str],
) -> TableDiagnosis:
    """The result from what the search found; none found is a result too."""
    chain = Chain.of(table)
    common = reference.facts(table, before, notes)
    if not found:
        unseen = reference.unseen(chain)
        sure = tuple(i for i in table_zeros.sure_rows(chain, reference) if i not in unseen)
        doubt = tuple(i for i in range(1, table.n + 1) if i not in sure)
        rows_: dict[str, Any] = {"certain_rows": sure, "rows_in_question": doubt}
        said = _unknown(sure, doubt, reference)
        return TableDiagnosis(agrees=False, sentence=said, **rows_, **common)
    options = _with_bodies(table, reference, found, bodies)
    if len(found[0].causes) == 1 and options[0][2] and table.n == reference.n:
        # bodies that are wrong, too, speak against the one kinematic slip
        more = _explained(chain, reference, (2,))
        options = _with_bodies(table, reference, [*found, *more], bodies)
    repaired, causes, dynamic, rounded = options[0]
    common["notes"] = (*common["notes"], *rounded)
    if len(dynamic) > MOST or (len(causes) > MOST and not many):
        rows = sorted({row for cause in dynamic for row in cause.rows})
        kinematic = tuple(c for c in causes if c not in dynamic)
        said = _("{kinematics}; {columns} differ, more than one or two slips explain")
        if rows:
            said = _(
                "{kinematics}; {columns} differ in rows {rows}, more than one or two slips explain"
            )
        found_ = joined(kinematic) if kinematic else _("the kinematics agree")
        columns = listed(sorted({c.column for c in dynamic}))
        said = said.format(kinematics=found_, columns=columns, rows=listed(rows) if rows else "")
        return TableDiagnosis(
            agrees=False,
            sentence=said,
            certain_rows=tuple(i for i in range(1, table.n + 1) if i not in rows),
            rows_in_question=tuple(rows),
            evidence=tuple(c.sentence for c in dynamic),
            **common,
        )
    after = reference.target.error(Chain.of(repaired))
    differences = _frames_told(causes, chain)
    wrong = {row for cause in causes for row in cause.rows}
    whole = any(c.row is None and c.column in ("convention", "units", "order") for c in causes)
    unseen = reference.unseen(chain)
    maybe = unseen.union(*(cause.rows for option in options for cause in option[1]))
    rest = tuple(i for i in range(1, repaired.n + 1) if i not in maybe and not whole)
    told = stated(causes, bool(unseen))
    if reference.axes is None and any(cause.column == "units" for cause in causes):
        units = _("it may as well be the poses that are in another unit than metres")
        common["notes"] = (*common["notes"], units)
    if not causes and unseen:
        told = _("{table} gives {reference} at these q, and other tables would as well")
        told = told.format(table=table.name, reference=reference.name)
    elif not causes:
        told = _("{table} and {reference} are the same arm")
        told = told.format(table=table.name, reference=reference.name)
        if reference.chain is not None:
            differences = _gauge(chain, reference.chain)
    return TableDiagnosis(
        agrees=not causes,
        sentence=told,
        causes=causes,
        repaired=repaired,
        alternatives=tuple(option[1] for option in options[1:]),
        differences=differences,
        same_arm=not causes or bool(differences) or many,
        error_after=after,
        certain_rows=rest,
        rows_in_question=tuple(sorted(wrong)),
        **common,
    )


def _left_out(bad: list[int]) -> str:
    """What is said of poses that are far off."""
    said = ngettext(
        "pose {poses} is left out: it is off by far more than the others",
        "poses {poses} are left out: they are off by far more than the others",
        len(bad),
    )
    return said.format(poses=listed([k + 1 for k in bad]))


def _at_rest(table: DHTable, reference: Reference) -> list[str]:
    """What is said of joints that move in none of the poses."""
    unseen = reference.unseen(Chain.of(table))
    if not unseen:
        return []
    still = ngettext(
        "joint {joints} does not move in the poses: of rows {rows} they say nothing for sure",
        "joints {joints} do not move in the poses: of rows {rows} they say nothing for sure",
        len(reference.still),
    )
    return [still.format(joints=listed(reference.still), rows=listed(sorted(unseen)))]


_Option = tuple[DHTable, tuple[Cause, ...], list[Cause], list[str]]


def _with_bodies(
    table: DHTable, reference: Reference, found: list[Reading], bodies: bool
) -> list[_Option]:
    """Each explanation with its dynamic slips; the fewest slips and nearest to the reference first.

    Args:
        table: the user's table.
        reference: the other side.
        found: kinematic explanations, the likeliest first.
        bodies: compare masses too.
    """
    options = []
    for place, one in enumerate(found[:24]):
        with warnings.catch_warnings():  # nobody wrote the tables that are tried
            warnings.simplefilter("ignore", KinlabWarning)
            repaired = one.chain.apply(table)
        dynamic: list[Cause] = []
        rounded: list[str] = []
        if bodies and reference.bodies is not None and repaired.n == reference.n:
            repaired, dynamic = table_bodies.differences(repaired, reference.bodies)
            new = {i + 1 for i, origin in enumerate(one.chain.source) if origin is None}
            dynamic = [c for c in dynamic if not c.rows or not set(c.rows) <= new]
            rounded = [c.sentence for c in dynamic if c.kind == table_bodies.ROUNDING]
            dynamic = [c for c in dynamic if c.kind != table_bodies.ROUNDING]
        rank = (len(dynamic), _foreign(one.chain, reference), place)
        options.append((rank, (repaired, (*one.causes, *dynamic), dynamic, rounded)))
    options.sort(key=lambda option: option[0])
    least = options[0][0][0]
    return [option for rank, option in options if rank[0] == least]


def _foreign(chain: Chain, reference: Reference) -> int:
    """In how many cells a repaired table differs from the reference's own, where it has any."""
    other = reference.chain
    if other is None or chain.n != other.n:
        return 0
    turn = np.abs(np.exp(1j * chain.cells[:, [1, 3]]) - np.exp(1j * other.cells[:, [1, 3]]))
    shift = np.abs(chain.cells[:, [0, 2]] - other.cells[:, [0, 2]])
    count = int(np.sum(turn > 1e-8) + np.sum(shift > 1e-8))
    count += int(np.sum(chain.sign != other.sign))
    for which in ("base", "tool"):
        count += int(np.max(np.abs(getattr(chain, which) - getattr(other, which))) > 1e-8)
    return count + 100 * int(chain.modified != other.modified)


def _unknown(sure: tuple[int, ...], doubt: tuple[int, ...], reference: Reference) -> str:
    text = _("not the arm of {reference}; no one or two slips explain the difference").format(
        reference=reference.name
    )
    if not sure:
        return text
    right = ngettext("row {rows} certainly right", "rows {rows} certainly right", len(sure))
    told = _("{verdict}; {rows}").format(verdict=text, rows=right.format(rows=listed(sure)))
    if not doubt:
        return told
    rest = ngettext("{told}, row {rows} in question", "{told}, rows {rows} in question", len(doubt))
    return rest.format(told=told, rows=listed(doubt))


_OTHER_END = {"base": N_("the base is another"), "tool": N_("the tool is another")}


def _frames_told(causes: tuple[Cause, ...], chain: Chain) -> tuple[str, ...]:
    """What differs in words, where it is nothing but zeros of joints, base and tool."""
    told = []
    for cause in causes:
        if cause.column in ("base", "tool"):
            told.append(_(_OTHER_END[cause.column]))
            continue
        if len(cause.rows) != 1 or cause.column not in ("theta", "d"):
            return ()
        row = cause.rows[0]
        if row > chain.n or bool(chain.prismatic[row - 1]) != (cause.column == "d"):
            return ()
        gap = (float(cause.meant) - float(cause.written)) * float(chain.sign[row - 1])
        if cause.column == "theta":
            gap = float(np.degrees(np.angle(np.exp(1j * gap))))
            said = _("zero of joint {joint} differs by {gap:.9g} deg")
        else:
            said = _("zero of joint {joint} differs by {gap:.9g} m")
        told.append(said.format(joint=row, gap=gap))
    return tuple(told)


def _gauge(mine: Chain, theirs: Chain) -> tuple[str, ...]:
    """How two tables of one arm differ, row by row."""
    if mine.modified != theirs.modified:
        return (_("the conventions differ"),)
    if mine.n != theirs.n:
        return ()
    gaps = [
        np.max(np.abs(_circle(mine.cells[i]) - _circle(theirs.cells[i]))) for i in range(mine.n)
    ]
    rows = [i + 1 for i, gap in enumerate(gaps) if gap > 1e-9]
    told = []
    if rows:
        elsewhere = ngettext(
            "row {rows} place the frames elsewhere",
            "rows {rows} place the frames elsewhere",
            len(rows),
        )
        told.append(elsewhere.format(rows=listed(rows)))
    flips = [i + 1 for i in range(mine.n) if mine.sign[i] != theirs.sign[i]]
    if flips:
        turned = ngettext(
            "z of joint {joints} points the other way",
            "z of joints {joints} points the other way",
            len(flips),
        )
        told.append(turned.format(joints=listed(flips)))
    for which in ("base", "tool"):
        if np.max(np.abs(getattr(mine, which) - getattr(theirs, which))) > 1e-9:
            told.append(_(_OTHER_END[which]))
    return tuple(told)


def _circle(row: Array) -> Array:
    a, alpha, d, theta = row
    return np.array([a, d, np.cos(alpha), np.sin(alpha), np.cos(theta), np.sin(theta)])
