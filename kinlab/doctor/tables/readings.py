"""Other readings of a whole table: what it would mean had one slip of a known form been made.

A reading is a change without an unknown: another convention, other units, another order of the
rows, two cells that stand in each other's place. Numbers that have to be found are solved for in
:mod:`kinlab.doctor.tables.cells`.
"""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass, replace
from itertools import combinations, product

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
    written, meant = "standard", "modified"
    told = _("the rows are in the modified convention, not the standard")
    if chain.modified:
        written, meant = meant, written
        told = _("the rows are in the standard convention, not the modified")
    cause = Cause(None, "convention", written, meant, "convention", told, 0.9)
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
            said, cost = (none, 1.1) if fill else (told, 1.15)
            written = chain.cells[:, [A, ALPHA]]
            cause = Cause(every, "a, alpha", written, moved, "shifted", said, cost)
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
        for factor, kind, told in angles if _entries(chain, columns) > 1 else ():
            yield Reading(_scaled(chain, columns, factor), (_unit_cause(columns, kind, told, ()),))
    for factor, kind, told in _SCALES:
        for columns in ((A,), (D,)):
            if _entries(chain, columns) > 1:
                other = _scaled(chain, columns, factor)
                yield Reading(other, (_unit_cause(columns, kind, told, ()),))
        other = _scaled(chain, (A, D), factor)
        for some in ((), ("tool",), ("base",), ("base", "tool")):
            ends = {which: getattr(chain, which).copy() for which in some}
            for pose in ends.values():
                pose[:3, 3] *= factor
            yield Reading(other.but(**ends), (_unit_cause((A, D), kind, told, some),))
    both = _scaled(_scaled(chain, (A, D), 1e-3), (ALPHA, THETA), turn)
    written, meant = "degrees and millimetres", "radians and metres"
    said = _("the table is in degrees and millimetres")
    yield Reading(both, (Cause(None, "units", written, meant, "units", said, 1.3),))


def _scaled(chain: Chain, columns: tuple[int, ...], factor: float) -> Chain:
    """The columns in other units; a single entry that is off is a cell of its own."""
    cells = chain.cells.copy()
    cells[:, columns] *= factor
    return chain.with_cells(cells)


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
        name, written = COLUMNS[column], chain.cells[:, column]
        rows = tuple(int(k) + 1 for k in np.flatnonzero(written))
        if len(rows) < 2:
            continue  # a cell of its own
        told = _("column {column} has the wrong sign").format(column=name)
        cause = Cause(rows, name, written, -written, "sign", told, 1.1)
        yield Reading(_scaled(chain, (column,), -1.0), (cause,))
    told, before, after = _("every joint turns the other way"), chain.sign < 0, chain.sign > 0
    cause = Cause(every, "flip", list(before), list(after), "sense", told, 1.2)
    yield Reading(chain.but(sign=-chain.sign), (cause,))


def _exchanged(chain: Chain) -> Iterator[Reading]:
    for one, two, likely in ((A, D, 1.0), (ALPHA, THETA, 1.2), (A, ALPHA, 1.5), (D, THETA, 1.5)):
        names = (COLUMNS[one], COLUMNS[two])
        different = [int(k) for k in np.flatnonzero(chain.cells[:, one] != chain.cells[:, two])]
        sets = [[k] for k in different]
        if likely == 1.0:
            sets += [list(two) for two in combinations(different, 2)]
        if len(different) > 2 or (likely > 1.0 and len(different) == 2):
            sets.append(different)
        for rows in sets:
            cells = chain.cells.copy()
            cells[rows, one], cells[rows, two] = chain.cells[rows, two], chain.cells[rows, one]
            named = rows[0] + 1 if len(rows) == 1 else tuple(k + 1 for k in rows)
            told = _("{one} and {two} are exchanged").format(one=names[0], two=names[1])
            written, meant = (x[rows][:, [one, two]] for x in (chain.cells, cells))
            cost = likely + (0.1 if len(rows) > 1 else 0.0)
            both, said = ", ".join(names), at_row(named, told)
            cause = Cause(named, both, written, meant, "exchanged", said, cost)
            yield Reading(chain.with_cells(cells), (cause,))


def _order(chain: Chain) -> Iterator[Reading]:
    n = chain.n
    for i, j in combinations(range(n), 2):
        order = list(range(n))
        order[i], order[j] = j, i
        told = _("rows {one} and {two} are exchanged").format(one=i + 1, two=j + 1)
        one, two = (i + 1, j + 1), (j + 1, i + 1)
        cost = 1.0 if j == i + 1 else 1.1
        cause = Cause(one, "order", one, two, "exchanged", told, cost)
        yield Reading(chain.permuted(order), (cause,))
        cells = chain.cells[order]  # the joints and bodies stayed where they are
        yield Reading(chain.with_cells(cells), (replace(cause, cost=cost + 0.02),))
    for i, j in product(range(n), repeat=2):
        if abs(i - j) > 1:
            order = [k for k in range(n) if k != i]
            order.insert(j, i)
            told = _("row {row} belongs at place {place}").format(row=i + 1, place=j + 1)
            cause = Cause((i + 1, j + 1), "order", i + 1, j + 1, "displaced", told, 1.3)
            yield Reading(chain.permuted(order), (cause,))
    if n > 3:
        told, way = _("the rows stand in reversed order"), ("tool to base", "base to tool")
        cause = Cause(None, "order", *way, "reversed", told, 1.3)
        yield Reading(chain.permuted(list(range(n))[::-1]), (cause,))


def _joints(chain: Chain) -> Iterator[Reading]:
    kinds = ("revolute", "prismatic")
    for k in range(chain.n):
        slides = bool(chain.prismatic[k])
        other, turned = (
            _("the joint is prismatic, not revolute"),
            _("the joint turns the other way"),
        )
        if slides:
            other = _("the joint is revolute, not prismatic")
            turned = _("the joint slides the other way")
        kind, sign = chain.prismatic.copy(), chain.sign.copy()
        kind[k], sign[k] = not slides, -sign[k]
        told, (written, meant) = at_row(k + 1, other), (kinds[slides], kinds[not slides])
        cause = Cause(k + 1, "joint", written, meant, "type", told, 1.0)
        yield Reading(chain.but(prismatic=kind), (cause,))
        told, (before, after) = at_row(k + 1, turned), (bool(x[k] < 0) for x in (chain.sign, sign))
        cause = Cause(k + 1, "flip", before, after, "sense", told, 1.0)
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
        both, told = "base, tool", _("base and tool are exchanged")
        cause = Cause(None, both, both, "tool, base", "exchanged", told, 1.2)
        yield Reading(chain.but(base=chain.tool, tool=chain.base), (cause,))
