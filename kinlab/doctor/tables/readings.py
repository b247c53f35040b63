"""Other readings of a whole table: what it would mean had one slip of a known form been made.

A reading is a change without an unknown: another convention, other units, another order of the
rows, two cells that stand in each other's place. Numbers that have to be found are solved for in
:mod:`kinlab.doctor.tables.cells`.
"""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass, replace
from itertools import combinations

import numpy as np

from kinlab.arrays import Array
from kinlab.doctor.tables.chain import ALPHA, COLUMNS, THETA, A, Chain, D, inverse
from kinlab.doctor.tables.words import FRAMES, Cause, at_row, listed, pose_cause
from kinlab.host.language import N_, _


@dataclass(frozen=True, eq=False)
class Reading:
    """A chain that differs from the user's by named slips.

    Attributes:
        chain: the table as it should be.
        causes: the slips, in the order in which they are taken back.
        maker: which sort of reading it is.
    """

    chain: Chain
    causes: tuple[Cause, ...] = ()
    maker: int = 0

    @property
    def cost(self) -> float:
        """Unlikeliness, a sum over the causes."""
        return sum(cause.cost for cause in self.causes)

    def after(self, first: Reading) -> Reading:
        """This reading of what another one had made of the table."""
        return Reading(self.chain, (*first.causes, *self.causes))


def readings(chain: Chain, base: list[Array], tool: list[Array], first: int = 0) -> list[Reading]:
    """Every reading of a chain that is one slip away and differs from it.

    Args:
        chain: the user's table.
        base, tool: frames that the reference is known to have.
        first: sorts of readings before this one are left out.
    """
    makers = (_convention, _shifted, _units, _signs, _exchanged, _order, _joints)
    found = []
    for k, maker in enumerate(makers):
        if k >= first:
            found += [Reading(r.chain, r.causes, k) for r in maker(chain)]
    found += [Reading(r.chain, r.causes, len(makers)) for r in _frames(chain, base, tool)]
    return [one for one in found if _differs(one.chain, chain)]


def _differs(one: Chain, two: Chain) -> bool:
    """Whether two chains differ; what a reading has not touched is the same object."""
    if one.modified != two.modified or one.source != two.source:
        return True
    return any(
        getattr(one, name) is not getattr(two, name)
        and bool((getattr(one, name) != getattr(two, name)).any())
        for name in ("cells", "prismatic", "sign", "base", "tool")
    )


def _convention(chain: Chain) -> Iterator[Reading]:
    names = ("standard", "modified")
    written, meant = names[chain.modified], names[not chain.modified]
    cause = Cause(
        None,
        "convention",
        written,
        meant,
        "convention",
        _("the rows are in the modified convention, not the standard")
        if meant == "modified"
        else _("the rows are in the standard convention, not the modified"),
        0.9,
    )
    yield Reading(chain.but(modified=not chain.modified), (cause,))


def _shifted(chain: Chain) -> Iterator[Reading]:
    """a and alpha stand in the row before or behind the one they belong to."""
    every = tuple(range(1, chain.n + 1))
    for step, told in (
        (1, _("a and alpha belong to the row behind the one they stand in")),
        (-1, _("a and alpha belong to the row before the one they stand in")),
    ):
        for fill in (True, False):
            cells = chain.cells.copy()
            moved = np.roll(cells[:, [A, ALPHA]], step, axis=0)
            if fill:
                moved[0 if step > 0 else -1] = 0.0
            cells[:, [A, ALPHA]] = moved
            end = 1 if step > 0 else chain.n
            none = _("{slip}; row {row} has none").format(slip=told, row=end)
            sentence = none if fill else told
            cost = 1.1 if fill else 1.15
            written = chain.cells[:, [A, ALPHA]]
            cause = Cause(every, "a, alpha", written, moved, "shifted", sentence, cost)
            yield Reading(chain.with_cells(cells), (cause,))


_SCALES = (
    (1e-3, "millimetres", N_("in millimetres")),
    (1e-2, "centimetres", N_("in centimetres")),
    (0.0254, "inches", N_("in inches")),
    (1e3, "metres for millimetres", N_("in thousandths of metres")),
)


def _units(chain: Chain) -> Iterator[Reading]:
    turn = np.pi / 180.0
    angles = (
        (turn, "degrees", N_("in degrees")),
        (1.0 / turn, "radians for degrees", N_("turned into radians twice")),
    )
    for columns in ((ALPHA,), (THETA,), (ALPHA, THETA)):
        if _entries(chain, columns) < 2:
            continue  # a cell of its own
        for factor, kind, told in angles:
            cells = chain.cells.copy()
            cells[:, columns] *= factor
            yield Reading(chain.with_cells(cells), (_unit_cause(columns, kind, told, ()),))
    for factor, kind, told in _SCALES:
        for columns in ((A,), (D,), (A, D)):
            if len(columns) == 1 and _entries(chain, columns) < 2:
                continue
            cells = chain.cells.copy()
            cells[:, columns] *= factor
            other = chain.with_cells(cells)
            yield Reading(other, (_unit_cause(columns, kind, told, ()),))
            if len(columns) == 2:
                ends = {}
                for which in ("base", "tool"):
                    pose = getattr(chain, which).copy()
                    pose[:3, 3] *= factor
                    ends[which] = pose
                for some in (("tool",), ("base",), ("base", "tool")):
                    changed = {which: ends[which] for which in some}
                    yield Reading(
                        other.but(**changed),
                        (_unit_cause(columns, kind, told, some),),
                    )
    cells = chain.cells.copy()
    cells[:, [A, D]] *= 1e-3
    cells[:, [ALPHA, THETA]] *= turn
    yield Reading(
        chain.with_cells(cells),
        (
            Cause(
                None,
                "units",
                "degrees and millimetres",
                "radians and metres",
                "units",
                _("the table is in degrees and millimetres"),
                1.3,
            ),
        ),
    )


def _entries(chain: Chain, columns: tuple[int, ...]) -> int:
    """How many cells of the columns are not zero."""
    return int(np.count_nonzero(chain.cells[:, columns]))


def _unit_cause(columns: tuple[int, ...], kind: str, told: str, extra: tuple[str, ...]) -> Cause:
    names = listed([COLUMNS[c] for c in columns])
    if extra:
        ends = listed(_(FRAMES[which]) for which in extra)
        sentence = _("columns {columns}, {frames} are {units}").format(
            columns=names, frames=ends, units=_(told)
        )
    elif len(columns) > 1:
        sentence = _("columns {columns} are {units}").format(columns=names, units=_(told))
    else:
        sentence = _("column {column} is {units}").format(column=names, units=_(told))
    written = told.removeprefix("in ")
    meant = "radians" if columns[0] in (ALPHA, THETA) else "metres"
    cost = 1.0 + 0.05 * (len(columns) - 1) + (0.05 if extra else 0.0)
    return Cause(None, "units", written, meant, kind, sentence, cost)


def _signs(chain: Chain) -> Iterator[Reading]:
    every = tuple(range(1, chain.n + 1))
    for column in range(4):
        cells = chain.cells.copy()
        cells[:, column] *= -1.0
        name = COLUMNS[column]
        rows = tuple(int(k) + 1 for k in np.flatnonzero(chain.cells[:, column]))
        if len(rows) < 2:
            continue  # a cell of its own
        told = _("column {column} has the wrong sign").format(column=name)
        place = every if len(rows) == chain.n else rows
        cause = Cause(place, name, chain.cells[:, column], cells[:, column], "sign", told, 1.1)
        yield Reading(chain.with_cells(cells), (cause,))
    cause = Cause(
        every,
        "flip",
        list(chain.sign < 0),
        list(chain.sign > 0),
        "sense",
        _("every joint turns the other way"),
        1.2,
    )
    yield Reading(chain.but(sign=-chain.sign), (cause,))


def _exchanged(chain: Chain) -> Iterator[Reading]:
    for one, two in ((A, D), (ALPHA, THETA), (A, ALPHA), (D, THETA)):
        names = (COLUMNS[one], COLUMNS[two])
        likely = 1.0 if one == A and two == D else 1.2
        if one == A and two == ALPHA:
            likely = 1.5
        if one == D:
            likely = 1.5
        different = [int(k) for k in np.flatnonzero(chain.cells[:, one] != chain.cells[:, two])]
        sets = [[k] for k in different]
        if likely == 1.0:
            sets += [list(two) for two in combinations(different, 2)]
        if len(different) > 2 or (likely > 1.0 and len(different) == 2):
            sets.append(different)
        for rows in sets:
            cells = chain.cells.copy()
            cells[rows, one], cells[rows, two] = chain.cells[rows, two], chain.cells[rows, one]
            named = tuple(k + 1 for k in rows)
            told = _("{one} and {two} are exchanged").format(one=names[0], two=names[1])
            yield Reading(
                chain.with_cells(cells),
                (
                    Cause(
                        named[0] if len(rows) == 1 else named,
                        f"{names[0]}, {names[1]}",
                        chain.cells[rows][:, [one, two]],
                        cells[rows][:, [one, two]],
                        "exchanged",
                        at_row(named[0] if len(rows) == 1 else named, told),
                        likely + (0.1 if len(rows) > 1 else 0.0),
                    ),
                ),
            )


def _order(chain: Chain) -> Iterator[Reading]:
    n = chain.n
    for i in range(n):
        for j in range(i + 1, n):
            order = list(range(n))
            order[i], order[j] = j, i
            near = 0.0 if j == i + 1 else 0.1
            cause = Cause(
                (i + 1, j + 1),
                "order",
                (i + 1, j + 1),
                (j + 1, i + 1),
                "exchanged",
                _("rows {one} and {two} are exchanged").format(one=i + 1, two=j + 1),
                1.0 + near,
            )
            yield Reading(_permuted(chain, order), (cause,))
            cells = chain.cells[order]  # the joints and bodies stayed where they are
            yield Reading(chain.with_cells(cells), (replace(cause, cost=cause.cost + 0.02),))
    for i in range(n):
        for j in range(n):
            if abs(i - j) < 2:
                continue
            order = [k for k in range(n) if k != i]
            order.insert(j, i)
            cause = Cause(
                (i + 1, j + 1),
                "order",
                i + 1,
                j + 1,
                "displaced",
                _("row {row} belongs at place {place}").format(row=i + 1, place=j + 1),
                1.3,
            )
            yield Reading(_permuted(chain, order), (cause,))
    if n > 3:
        cause = Cause(
            None,
            "order",
            "tool to base",
            "base to tool",
            "reversed",
            _("the rows stand in reversed order"),
            1.3,
        )
        yield Reading(_permuted(chain, list(range(n))[::-1]), (cause,))


def _permuted(chain: Chain, order: list[int]) -> Chain:
    return chain.but(
        cells=chain.cells[order],
        prismatic=chain.prismatic[order],
        sign=chain.sign[order],
        source=tuple(chain.source[k] for k in order),
    )


def _joints(chain: Chain) -> Iterator[Reading]:
    kinds = ("revolute", "prismatic")
    for k in range(chain.n):
        slides = bool(chain.prismatic[k])
        kind = chain.prismatic.copy()
        kind[k] = not slides
        cause = Cause(
            k + 1,
            "joint",
            kinds[slides],
            kinds[not slides],
            "type",
            at_row(
                k + 1,
                _("the joint is revolute, not prismatic")
                if slides
                else _("the joint is prismatic, not revolute"),
            ),
            1.0,
        )
        yield Reading(chain.but(prismatic=kind), (cause,))
        sign = chain.sign.copy()
        sign[k] *= -1.0
        cause = Cause(
            k + 1,
            "flip",
            bool(chain.sign[k] < 0),
            bool(sign[k] < 0),
            "sense",
            at_row(
                k + 1,
                _("the joint slides the other way")
                if slides
                else _("the joint turns the other way"),
            ),
            1.0,
        )
        yield Reading(chain.but(sign=sign), (cause,))


def _frames(chain: Chain, base: list[Array], tool: list[Array]) -> Iterator[Reading]:
    for which, known in (("base", base), ("tool", tool)):
        written = getattr(chain, which)
        turned = written.copy()
        turned[:3, :3] = written[:3, :3].T
        tried = [written]
        for meant in [inverse(written), turned, *known, np.eye(4)]:
            if any(np.max(np.abs(meant - other)) < 1e-9 for other in tried):
                continue
            tried.append(meant)
            cause = pose_cause(which, written, meant, known[0] if known else None)
            yield Reading(chain.but(**{which: meant}), (cause,))
    if np.max(np.abs(chain.base - chain.tool)) > 1e-12:
        cause = Cause(
            None,
            "base, tool",
            "base, tool",
            "tool, base",
            "exchanged",
            _("base and tool are exchanged"),
            1.2,
        )
        yield Reading(chain.but(base=chain.tool, tool=chain.base), (cause,))
