"""Whole rows: which one is left out, doubled or too many?"""

from __future__ import annotations

import numpy as np

from kinlab.doctor.tables.cells import differences, row_text, spread
from kinlab.doctor.tables.chain import ALPHA, THETA, Chain, frames, row_of
from kinlab.doctor.tables.readings import Reading
from kinlab.doctor.tables.reference.target import Target
from kinlab.doctor.tables.words import Cause, tidy_length, wrapped
from kinlab.host.language import _


def inserted(chain: Chain, target: Target) -> list[Reading]:
    """Rows that are left out: a chain with one joint fewer than the target."""
    found = []
    for row in range(chain.n + 1):
        for slides in (False, True):
            for sign in (1.0, -1.0):
                new = chain.but(
                    cells=np.insert(chain.cells, row, 0.0, axis=0),
                    prismatic=np.insert(chain.prismatic, row, slides),
                    sign=np.insert(chain.sign, row, sign),
                    source=(*chain.source[:row], None, *chain.source[row:]),
                )
                frame = row if chain.modified else row + 1
                gap, _last = differences(frames(new, target.few.q)[None], target.few)
                if spread(gap, target.size)[0, frame] > target.steady:
                    continue
                solved = row_of(chain.modified, np.mean(gap[0, :, frame], axis=0), target.steady)
                if solved is None:
                    continue
                for column, value in enumerate(map(float, solved)):
                    angle = column in (ALPHA, THETA)
                    tidy = wrapped(value) if angle else tidy_length(value, 0.0)
                    new = new.with_cell(row, column, tidy)
                if not target.met(new):
                    continue
                told = _("row {row} is left out: revolute, {meant}")
                if slides:
                    told = _("row {row} is left out: prismatic, {meant}")
                told = told.format(row=row + 1, meant=row_text(new.cells[row]))
                cost = 1.0 if sign > 0 else 1.4
                cause = Cause(row + 1, "order", None, new.cells[row], "left out", told, cost)
                found.append(Reading(new, (cause,)))
    return found


def removed(chain: Chain) -> list[Reading]:
    """The chain without each of its rows."""
    found = []
    for row in range(chain.n):
        keep = [k for k in range(chain.n) if k != row]
        new = chain.permuted(keep)
        beside = [k for k in (row - 1, row + 1) if 0 <= k < chain.n]
        twins = [k for k in beside if np.array_equal(chain.cells[k], chain.cells[row])]
        told = _("row {row} is too many").format(row=row + 1)
        if twins:
            told = _("row {row} repeats row {other}").format(row=row + 1, other=twins[0] + 1)
        cost = 1.0 if twins and twins[0] < row else 1.1 if twins else 1.5
        kind = "doubled" if twins else "too many"
        cause = Cause(row + 1, "order", chain.cells[row], None, kind, told, cost)
        found.append(Reading(new, (cause,)))
    return found
