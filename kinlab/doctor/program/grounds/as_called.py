"""A link's length where a program has its centre's distance by name: ``lc2 = 0.4`` of a rod."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import replace
from typing import Any

import numpy as np

from kinlab.doctor.changes import table_of
from kinlab.doctor.program.edits.numbers.data import numbers
from kinlab.doctor.program.grounds.called import kinds_called
from kinlab.doctor.program.grounds.labels import Labels
from kinlab.doctor.program.observed import Observed
from kinlab.doctor.program.places import ProgramEdit
from kinlab.doctor.program.trial import Trial
from kinlab.tolerances import TOLERANCES

_COST = 0.95
"""How far-fetched it is: no other number is called so."""


def of_centres(trial: Trial, observed: Observed, robot: Any) -> Iterator[ProgramEdit]:
    """The distance of a link's centre for its length, where a number is called after that.

    Args:
        trial: the program.
        observed: what its expressions were.
        robot: the arm; nothing of one without a table.
    """
    table = table_of(robot)
    if table is None:
        return
    labels = Labels(trial, table.n)
    for place in numbers(trial, observed):
        name, digits, at = labels.of(place)
        k = digits - 1 if digits is not None else at[0] if at else 0
        if kinds_called(name) != ("centre",) or not 0 <= k < table.n or len(at) > 1:
            continue
        link = table.links[k]
        length, centre = link.a, link.a + float(np.ravel(link.com)[0])
        near = TOLERANCES.same_number * abs(length)
        if length and centre and abs(place.value - length) <= near < abs(centre - length):
            yield replace(place.edit(centre, "number", _COST), of_the_arm=True)
