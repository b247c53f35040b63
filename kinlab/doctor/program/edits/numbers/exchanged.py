"""Two numbers of the data that become each other: they were exchanged."""

from __future__ import annotations

from collections.abc import Sequence
from itertools import combinations

from kinlab.doctor.program.edits.numbers.data import shown
from kinlab.doctor.program.places import DATA, ProgramEdit

_KIND = "entries swapped"


def as_exchanged(edits: Sequence[ProgramEdit]) -> tuple[ProgramEdit, ...]:
    """The same edits, with one exchange for two numbers that become each other."""
    for one, other in combinations(edits, 2):
        back = None if other.numbers is None else other.numbers[::-1]
        if one.part == other.part == DATA and back is not None and one.numbers == back:
            both = _exchange(*sorted((one, other), key=label))
            rest = [x for x in edits if x is not other]
            return as_exchanged([both if x is one else x for x in rest])
    return tuple(edits)


def _exchange(one: ProgramEdit, other: ProgramEdit) -> ProgramEdit:
    assert one.numbers is not None
    first, last = map(shown, one.numbers)
    here, there = label(one), label(other)
    told = (f"{here} = {first}, {there} = {last}", f"{here} = {last}, {there} = {first}")
    changes, cost = (*one.changes, *other.changes), max(one.cost, other.cost)
    return ProgramEdit(DATA, changes, _KIND, cost, one.node, one.place, exchanged=told)


def label(edit: ProgramEdit) -> str:
    """A number of the data as a program has it: ``COM[2][1]``."""
    keys = (key if str(key).startswith(".") else f"[{key!r}]" for key in edit.place)
    return str(edit.node) + "".join(keys)
