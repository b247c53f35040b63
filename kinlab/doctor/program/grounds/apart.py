"""An arm whose numbers have nothing to do with one another, on which no two of them are one.

In homework an arm often has l1 = l2 = m1 = m2 = 1 and lc1 = lc2 = 0.5: there a mass is as good as a
length, and twice a distance to a centre of mass is a length. Which number of a program is which of
the arm's is told from its value, from its name, and from its place in a list.
"""

from __future__ import annotations

import ast
from collections.abc import Callable, Iterable, Iterator, Sequence
from dataclasses import dataclass, replace
from itertools import combinations, islice
from typing import Any

import numpy as np

from kinlab.arrays import Array
from kinlab.doctor.bytecode.syntax import nodes
from kinlab.doctor.changes import table_of
from kinlab.doctor.program.edits.numbers.data import together
from kinlab.doctor.program.grounds.called import kinds_called, unlike
from kinlab.doctor.program.grounds.labels import Label, Labels
from kinlab.doctor.program.grounds.scaled import (
    OtherArm,
    ProgramNumber,
    holds_an_arm,
    may_be_of_one_arm,
    may_be_step,
    moments,
    named_at_will,
    numbers_of,
    stays,
    twisted_by,
)
from kinlab.doctor.program.observed import Observed
from kinlab.doctor.program.places import DATA, ProgramEdit, changed
from kinlab.doctor.program.trial import FailedError, Trial, quietly
from kinlab.model.dh import DHLink, DHTable
from kinlab.model.link import Convention
from kinlab.model.robot import Robot
from kinlab.tolerances import TOLERANCES

_WAYS = 64
"""Ways of understanding a program's numbers that are tried."""
_LEAST, _SPREAD, _TURN = 0.75, 1.1, (5**0.5 - 1) / 2
"""How much larger numbers of the arm are: never twice alike, and no simple parts of each other."""
_RUN = 8
"""Ways of understanding a program's numbers in which it is run."""
_OF_A_TENSOR = 9
"""Its numbers."""
_AXES = 2
"""Axes of a matrix."""
_ENDS = ("base", "tool")
"""What the transforms before and behind a table are called."""
Which = tuple[str, int]
"""A number of the arm's that is changed by itself: of a link its length, its mass, ..."""


@dataclass(frozen=True)
class _Cell:
    """A number that the arm's table gives.

    Attributes:
        kind: ``"length"``, ``"centre"``, ``"mass"``, ``"moment"``, ``"twist"``, ``"kept"``.
        which: with which of the arm's numbers it changes.
        links: the links after which it may be called; none where it has no number.
        value: what it is.
    """

    kind: str
    which: Which
    links: tuple[int, ...]
    value: float


_Option = tuple[tuple[ProgramNumber, int], ...]
"""What numbers of a program are: which cells, by their numbers."""


_Left = tuple[ProgramNumber, Label, bool, list[int]]
"""A number of a program, what it is called, whether that tells what it is, and which cells."""


@dataclass(frozen=True)
class _Item:
    """Numbers of a program that are understood together.

    Attributes:
        options: what they may be.
        alone: whether none other is the same of the arm's, where that can be.
    """

    options: tuple[_Option, ...]
    alone: bool


def arm_apart(
    robot: Robot, trial: Trial, observed: Observed, masses: bool = True
) -> OtherArm | None:
    """An arm all of whose numbers that a program has names for are different.

    Where no ``masses`` are asked for, what may be a length is none.

    What the program has no name for stays as it is; but a centre stays in the middle of its link,
    and a moment of inertia goes with mass and length, where no program has names for these at all.
    """
    table = table_of(robot)
    if table is None:
        return None
    found = [*numbers_of(trial, observed)]
    turned = twisted_by(table, found, trial)
    cells = _cells(table, float(np.linalg.norm(robot.model.gravity.linear)))
    far = _far_at_home(table, cells)
    cells += [_at_home(x, k) for k, x in far.items()]
    every = (node for tree in trial.trees for node in nodes(tree) if isinstance(node, ast.UnaryOp))
    negative = {id(node.operand) for node in every if isinstance(node.op, ast.USub)}
    names = {name: k for k, name in enumerate(trial.program.space)}
    unasked = frozenset[str]() if masses else frozenset(("mass", "moment", "centre"))
    labels = Labels(trial, table.n)
    rotors = np.array([link.armature for link in table.links])
    reader = _Reader(
        table.n, cells, labels, found, negative, _summed(trial), names, unasked, rotors
    )
    items = sorted(map(reader.of_one, reader.items), key=lambda item: len(item.options))
    reader.tie_what_has_no_number(items)
    ways = [*islice(_ways(items, frozenset()), _WAYS + 1)]
    if not ways:
        return None
    strange = (one for item in items for option in item.options for one in option)
    carried = {cells[k].which for one, k in strange if may_be_of_one_arm(one.value)}
    carried |= {cells[k].which for _one, k in ways[0]}
    back = _opposite(table, carried)
    other = _apart(table, carried | {*back.values()}, reader.tied | back, turned, reader.odd)
    points = home_of(other)
    new = _cells(other, 0.0) + [_at_home(float(points[k]), k) for k in far]
    puts = [
        [
            one.times(new[k].value / cells[k].value)
            for one, k in way
            if cells[k].kind != "kept" and new[k].value != cells[k].value
        ]
        for way in ways[:_WAYS]
    ]
    changed = tuple(tuple(together(put)) for put in puts if put)
    if not changed:
        return None
    named = any(hasattr(type(trial.space.get(n)), "_fields") for n in trial.program.held)
    whole = reader.whole and not (named or holds_an_arm(trial)) and len(ways) <= _WAYS
    whole = whole and stays(trial, puts[0])
    fitting, noughts = frozenset(reader.fitting), frozenset(reader.noughts)
    return OtherArm(other, changed, whole, fitting, noughts, reader.odd)


def works_out(
    other: OtherArm,
    table: DHTable,
    trial: Trial,
    observed: Observed,
    states: Sequence[tuple[Any, ...]],
) -> OtherArm:
    """The arm, with those ways in which a program works out its moments of inertia as its own.

    The 0.25 of ``m3*0.25**2/12`` may be a length, or a centre's distance of another link.

    Args:
        other: another arm.
        table: of the first arm.
        trial, observed: the program, and what it was for the first arm.
        states: some at which it is run.
    """
    own = _about_centres(table)
    every = [node for tree in trial.trees for node in nodes(tree) if isinstance(node, ast.BinOp)]
    held = [(node, seen.only) for node in every if (seen := observed.of(node)) is not None]
    told = [node for node, value in held if value and _close(own, value).any()]
    if not told or not other.whole:
        return other
    theirs = _about_centres(other.table)
    fit = [way for way in other.ways[:_RUN] if _all_are(theirs, told, trial, way, states)]
    return replace(other, ways=tuple(fit) or other.ways, whole=bool(fit))


def _about_centres(table: DHTable) -> Array:
    """The moments of inertia of an arm's links about their centres of mass, those that are some."""
    every: Array = np.ravel([link.inertia for link in table.links]).astype(float)
    some: Array = every[np.abs(every) > TOLERANCES.same_number]
    return some


def _all_are(
    theirs: Array,
    told: Sequence[ast.BinOp],
    trial: Trial,
    way: tuple[ProgramEdit, ...],
    states: Sequence[tuple[Any, ...]],
) -> bool:
    """Whether expressions are all of the other arm's numbers, with its numbers in the program."""
    try:
        with quietly(), changed(trial, way):
            there = Observed(trial, states)
    except FailedError:
        return False
    seen = (one for node in told if (one := there.of(node)) is not None)
    return all(x.only is None or bool(_close(theirs, x.only).any()) for x in seen)


def _opposite(table: DHTable, carried: set[Which]) -> dict[Which, Which]:
    """Lengths there and back, which leave nothing of each other: a program need not name them."""
    lengths = [(k, link.a) for k, link in enumerate(table.links) if link.a]
    return {
        ("a", j): ("a", i)
        for (i, there), (j, back) in combinations(lengths, 2)
        if there == -back and {("a", i), ("a", j)} & carried
    }


class _Reader:
    """What the numbers of a program may be.

    Args:
        count: of links.
        cells: the arm's numbers.
        labels: what the program's numbers are called.
        found: the program's numbers.
        negative: the numbers in a program's text with a minus in front.
        summed: those in sums of nothing but numbers.
        names: of the program, in the order in which they are defined.
        unasked: kinds of numbers that have no part in what is asked.
        rotors: the inertias of the drives' rotors, which may be called as the links' are.

    Attributes:
        items: numbers, and what they may be.
        tied: numbers of the arm's that have one name.
        whole: whether no other number of the program can be the arm's.
        fitting: where numbers are that the arm has as they are called.
        noughts: where noughts are.
        odd: whether one is none of the arm's, while others of its kind are.
        carried: the numbers that may be the arm's.
    """

    def __init__(
        self,
        count: int,
        cells: Sequence[_Cell],
        labels: Labels,
        found: Sequence[ProgramNumber],
        negative: set[int],
        summed: set[int],
        names: dict[str, int],
        unasked: frozenset[str],
        rotors: Array,
    ) -> None:
        self.rotors = rotors
        self.unasked = unasked
        self.cells, self.labels, self.negative = [*cells], labels, negative
        self.tied: dict[Which, Which] = {}
        self.whole = True
        told = self._by_owners(found, [labels.of(one.place) for one in found], count, names)
        self.from_zero = {name for name, digits, _at in told if digits == 0}
        last: dict[str, int] = {}
        for name, _digits, at in told:
            last[name] = max(last.get(name, 0), *at[:1], 0)
        self.listed = {name for name, most in last.items() if most + 1 == count}
        self._with_masses_at_ends(told, count)
        self.items: list[_Item] = []
        self.fitting: set[Any] = set()
        self.noughts: set[Any] = set()
        self.odd = False
        self._look_at_names([x for x in zip(found, told, strict=True) if x[0].alone])
        given: list[tuple[ProgramNumber, Label, list[int]]] = []
        plain: list[float] = []
        for one, label in zip(found, told, strict=True):
            place, own = one.place, may_be_of_one_arm(one.value)
            may = self._alike(one) if one.value else []
            if may and (one.alone or own or one.given):
                given.append((one, label, may))
                # the h of a difference, the same as a moment of inertia
                called = bool(kinds_called(label[0]))
                self.whole = self.whole and (called or not may_be_step(one.value))
            elif own or (may and id(place.node) in summed):
                self.whole = False
            elif may:
                if not isinstance(place.value, int):  # a factor, a power
                    plain.append(one.value)
                self.whole = self.whole and not may_be_step(one.value)  # or a centre's 0.01
            elif one.alone and isinstance(place.value, float) and not place.place:
                self.whole = self.whole and named_at_will(one.value)
        unknown: dict[Any, list[tuple[ProgramNumber, list[int]]]] = {}
        centres = self._whole_centres(given)
        left_of: list[_Left] = [
            (one, label, True, [centres[k]])
            if k in centres
            else (one, label, *self._as_called(may, label, one.place.part == DATA))
            for k, (one, label, may) in enumerate(given)
        ]
        for one, label, sure, left in left_of:
            if sure:
                others = {k for other, *_rest, some in left_of if other is not one for k in some}
                some = self._alone(label, left, [k for k in self._alike(one) if k not in others])
                self.items.append(_Item(tuple(((one, k),) for k in some), not label[2]))
            else:
                inner = label[2][1:]  # a tensor has the same number on both sides of its diagonal
                inner = (*inner[:-_AXES], *sorted(inner[-_AXES:])) if len(inner) >= _AXES else inner
                key = (label[:2], inner) if one.alone else ()
                own = may_be_of_one_arm(one.value)
                value = -one.value if id(one.place.node) in self.negative else one.value
                unknown.setdefault((key, value, own), []).append((one, left))
        unsure = 0
        surely: dict[Any, set[str]] = {}
        for (key, _value, own), group in unknown.items():
            if own and key:
                surely.setdefault(key, set()).update(
                    self.cells[k].kind for _one, some in group for k in some
                )
        for (key, _value, own), group in unknown.items():
            kinds = [*self._kinds(group)]
            # 0.5 in a list beside 0.4, a length, is no half
            alike = [
                x for x in kinds if {self.cells[k].kind for _one, k in x} & surely.get(key, set())
            ]
            kinds = alike or kinds
            stays: list[_Option] = [] if own or alike else [()]
            once = not any(one.given for one, _some in group)
            self.items.append(_Item((*kinds, *stays), once))
            unsure += own and len(kinds) > 1
        self.whole = self.whole and unsure < 2
        self.carried = [one.value for one, _label, _may in given]
        held = np.array([one.value for one in found if one.alone])
        self.whole = self.whole and all(bool(_close(held, x).any()) for x in plain)

    def _with_masses_at_ends(self, told: Sequence[Label], count: int) -> None:
        """Lengths that are called l1 to ln, with nothing else for where the masses are.

        Where each mass is at its link's end, in a modified table, that is the next link's length;
        of the last link its own.
        """
        named = [(kinds_called(name), digits, name) for name, digits, _at in told]
        lengths = {
            digits - (name not in self.from_zero)
            for kinds, digits, name in named
            if digits is not None and kinds == ("length",)
        }
        at = {cell.which: k for k, cell in reversed([*enumerate(self.cells)])}
        first = at.get(("a", 1))
        modified = first is not None and self.cells[first].links == (1, 0)
        if not modified or lengths != {*range(count)} or ("centre",) in (x[0] for x in named):
            return
        ends = [("a", k + 1) for k in range(count - 1)]
        coms = [("com0", k) for k in range(count)]
        if not {*ends, *coms} <= at.keys():
            return
        pairs = [(self.cells[at[end]].value, self.cells[at[com]].value)
                 for end, com in zip(ends, coms, strict=False)]  # fmt: skip
        if any(end != com for end, com in pairs):
            return
        self.tied |= dict(zip(coms, ends, strict=False))
        for k, end in enumerate(ends):
            self.cells[at[end]] = replace(self.cells[at[end]], links=(k,))
        last = at[coms[-1]]
        self.cells[last] = replace(self.cells[last], kind="length", links=(count - 1,))

    def _by_owners(
        self,
        found: Sequence[ProgramNumber],
        told: Sequence[Label],
        count: int,
        names: dict[str, int],
    ) -> list[Label]:
        """Of numbers that several objects have under one name, those of each are a link's."""
        owners: dict[str, list[str]] = {}
        of = [self.labels.owner(one.place) for one in found]
        for owner, (name, digits, at) in zip(of, told, strict=True):
            if owner and digits is None and not at and owner not in owners.setdefault(name, []):
                owners[name].append(owner)
        self.whole = self.whole and all(len(x) in (1, count) for x in owners.values())
        for some in owners.values():
            some.sort(key=lambda owner: names.get(owner, len(names)))
        kept: list[Label] = []
        for owner, label in zip(of, told, strict=True):
            among = owners.get(label[0], [])
            each = len(among) == count > 1 and owner in among and label[1] is None and not label[2]
            kept.append((*label[:2], (among.index(owner),)) if each else label)
        return kept

    def _whole_centres(
        self, given: Sequence[tuple[ProgramNumber, Label, list[int]]]
    ) -> dict[int, int]:
        """The cells of numbers that stand together as the coordinates of one link's centre do."""
        rows: dict[Any, list[tuple[int, dict[int, int]]]] = {}
        for k, (_one, (*name, at), may) in enumerate(given):
            if at:
                cells = [(x, self.cells[x].which) for x in may]
                links = {link: x for x, (what, link) in cells if what == f"com{at[-1]}"}
                rows.setdefault((*name, at[:-1]), []).append((k, links))
        told: dict[int, int] = {}
        for row in rows.values():
            of = set.intersection(*(set(links) for _k, links in row))
            if len(row) > 1 and len(of) == 1:
                (link,) = of
                told |= {k: links[link] for k, links in row}
        return told

    def _look_at_names(self, named: Sequence[tuple[ProgramNumber, Label]]) -> None:
        """Which numbers the arm has as they are called, and whether any is odd among these."""
        strange: list[Label] = []
        alike: set[str] = set()
        kept = [cell for cell in self.cells if cell.kind == "kept"]  # of a drive, gravity
        for one, label in named:
            node = one.place.node if one.place.part == DATA else id(one.place.node)
            if not one.value:  # which fits anything
                self.noughts.add((node, one.place.place))
            kinds, link = kinds_called(label[0]), self._link(label)
            some = [c for c in self.cells if c.kind in kinds and link in (None, *c.links)]
            every = [cell for cell in self.cells if cell.kind in kinds]
            if _among(some, one.value) and not self._is_of_another(kinds[0], link, one.value):
                if one.value:
                    self.fitting.add((node, one.place.place))
                alike.add(label[0])
            elif some and link is not None and len(label[2]) < 2 and not _among(every, one.value):
                of_a_drive = _among(kept, one.value) or bool(_close(self.rotors, one.value).any())
                plain = abs(one.value) == 1.0 and one.place.part != DATA  # R = diag([-1.0, -1, 1])
                strange += [] if of_a_drive or plain else [label]
        centres = {label[0] for label in strange if self._are_centres(label[0], named)}
        for name in (label[0] for label in strange if label[0] not in centres):
            same = alike if len(name) > 1 or name in "lmij" else alike & {name}
            self.odd = self.odd or any(not unlike(name, other) for other in same)

    def _are_centres(self, name: str, named: Sequence[tuple[ProgramNumber, Label]]) -> bool:
        """Whether what is called as lengths are is each link's way to its centre: l1, where a1 is
        the length."""
        own = [(one.value, self._link(label)) for one, label in named if label[0] == name]
        centres = [cell for cell in self.cells if cell.kind == "centre"]
        return "length" in kinds_called(name) and all(
            link is not None and _among([c for c in centres if link in c.links], value)
            for value, link in own
        )

    def _is_of_another(self, kind: str, link: int | None, value: float) -> bool:
        """Whether it is another link's number of what is first called so."""
        every = [cell for cell in self.cells if cell.kind == kind]
        own = [cell for cell in every if link in (None, *cell.links)]
        return _among(every, value) and not _among(own, value)

    def _link(self, label: Label) -> int | None:
        """The link after which a number is called, or at whose place it stands."""
        name, digits, at = label
        if digits is not None:
            return digits - (name not in self.from_zero)
        return at[0] if at and name in self.listed else None

    def _alike(self, one: ProgramNumber) -> list[int]:
        """The cells of a value; of the opposite one where it is none's, or measured along d."""
        value = -one.value if id(one.place.node) in self.negative else one.value
        values = np.array([cell.value for cell in self.cells])
        size, same = _close(values, value), _close(values, value, signed=True)
        if same.any():
            both = np.array([cell.which[0] in ("com1", "com2") for cell in self.cells])
            size &= same | both
        found = [int(k) for k in np.flatnonzero(size)]
        return [k for k in found if self.cells[k].kind not in self.unasked] or found

    def _as_called(self, may: list[int], label: Label, data: bool) -> tuple[bool, list[int]]:
        """Of cells those that are called so, and whether any is."""
        kinds, link = kinds_called(label[0]), self._link(label)
        may = [k for k in may if self.cells[k].kind != "moment" or not self._again(k, may)]
        ends = [k for k in may if label[0] in _ENDS and self.cells[k].which[0].startswith(label[0])]
        if ends:
            return True, ends
        left = [k for k in may if self.cells[k].kind in kinds]
        here = [k for k in may if link in self.cells[k].links and self.cells[k].kind == "centre"]
        if here and kinds == ("length",) and not any(link in self.cells[k].links for k in left):
            left = here  # l1 is another link's length, and this one's way to its centre
        sure = bool(left)
        left = left or may
        if link is not None and (sure or data):  # the text's rows may be those of a matrix
            left = [k for k in left if link in self.cells[k].links] or left
        elif not label[2] and (sure or not label[0]):  # one number for those of all links
            firsts = {self.cells[k].which[0]: self.cells[k].which for k in reversed(left)}
            for k in left:
                self.tied[self.cells[k].which] = firsts[self.cells[k].which[0]]
            left = [k for k in left if self.cells[k].which in firsts.values()]
        return sure, left

    def _alone(self, label: Label, left: list[int], free: list[int]) -> list[int]:
        """Of the cells that a number may be one, if it is all: a point mass is at a link's end.

        Args:
            label: what it is called.
            left: what it may be as it is called.
            free: what it may be, and no other number is.
        """
        link, first = self._link(label), self.cells[left[0]]
        if not {*left} <= {*free} or (link is None and label[2]):
            return left
        lengths = [k for k in free if self.cells[k].kind in ("length", "centre")]
        some = {*left, *(k for k in lengths if link in (None, *self.cells[k].links))}
        sizes = {abs(self.cells[k].value) for k in some}  # the frame before is at -d
        if first.kind not in ("length", "centre") or len(sizes) > 1:
            return left
        for k in some:
            self.tied.setdefault(self.cells[k].which, first.which)
        return left[:1]

    def of_one(self, item: _Item) -> _Item:
        """Of lengths and ways to centres that are one, for which there is but one number, one."""
        first = next((option for option in item.options if option), ())
        of = [k for option in item.options for one, k in option if one is first[0][0]]
        some = [k for k in of if self.cells[k].kind == "length" or self._is_a_coordinate(k)]
        whose = {self.tied.get(x, x) for x in (self.cells[k].which for k in some)}
        others = [option for option in item.options if not option]  # it may be nothing of the arm's
        if len(of) + len(others) < len(item.options) or len(whose) < 2 or len(first) > 1:
            return item
        if self._numbers_like(first[0][0].value) > 1:
            return item
        for k in some[1:]:
            self.tied.setdefault(self.cells[k].which, self.cells[some[0]].which)
        left = [((first[0][0], k),) for k in of if k not in some[1:]]
        return replace(item, options=(*left, *others))

    def tie_what_has_no_number(self, items: Sequence[_Item]) -> None:
        """Lengths for which a program has the number of another: ``d4 = a2``."""
        named = {k for item in items for option in item.options for _one, k in option}
        known = {self.cells[k].which for k in named}
        left = [x for x in self.cells if x.kind == "length" and x.which not in known]
        for item in items:
            of = {k for option in item.options for _one, k in option}
            own = self.cells[min(of)] if len(of) == 1 else None
            if own is None or own.kind != "length" or self._numbers_like(own.value) != 1:
                continue
            for one in (x for x in left if _among([x], own.value)):
                self.tied.setdefault(one.which, self.tied.get(own.which, own.which))

    def _numbers_like(self, value: float) -> int:
        """How many of the program's numbers have a value, whatever their sign."""
        return int(_close(np.array(self.carried), value).sum())

    def _is_a_coordinate(self, k: int) -> bool:
        """Whether it is a centre's coordinate as it stands, and no sum with a length."""
        cell = self.cells[k]
        before = ((one.kind, one.which) for one in self.cells[:k])
        return cell.kind == "centre" and (cell.kind, cell.which) not in before

    def _again(self, k: int, may: list[int]) -> bool:
        """Whether a moment of inertia is that of a cell before."""
        which = self.cells[k].which
        return any(self.cells[j].which == which for j in may if j < k)

    def _kinds(self, group: list[tuple[ProgramNumber, list[int]]]) -> Iterator[_Option]:
        """What numbers of one list may be: of one kind, all of them."""
        if len(group) == 1:
            yield from (((group[0][0], k),) for k in group[0][1])
            return
        for kind in dict.fromkeys(self.cells[k].kind for k in group[0][1]):
            each = [
                (one, next((k for k in left if self.cells[k].kind == kind), None))
                for one, left in group
            ]
            if all(k is not None for _one, k in each):
                yield tuple((one, k) for one, k in each if k is not None)
                self._tie_alike(kind, group)

    def _tie_alike(self, kind: str, group: list[tuple[ProgramNumber, list[int]]]) -> None:
        """Numbers of the arm's that are one, each of which any of several may be: a2 and d4."""
        each = {
            tuple(self.cells[k].which for k in left if self.cells[k].kind == kind)
            for _one, left in group
        }
        first, *others = dict.fromkeys(min(each))
        for which in others if len(each) == 1 else ():
            if self.tied.get(which, which) == which:
                self.tied[which] = self.tied.get(first, first)


def _summed(trial: Trial) -> set[int]:
    """The numbers in sums and products of nothing but numbers, by identity.

    Such are two moments of inertia, or one from a mass and a length: ``2*0.4**2/12``.
    """
    found: set[int] = set()
    plain = ast.Constant | ast.BinOp | ast.operator
    for tree in trial.trees:
        for node in nodes(tree):
            if isinstance(node, ast.BinOp) and isinstance(node.op, ast.Add | ast.Sub | ast.Mult):
                sides = (node.left, node.right)
                if all(isinstance(x, plain) for x in nodes(node)):
                    found |= {id(node), *map(id, sides)}
    return found


def _among(cells: Sequence[_Cell], value: float) -> bool:
    return bool(_close(np.array([cell.value for cell in cells]), value).any())


def _ways(items: Sequence[_Item], used: frozenset[int]) -> Iterator[_Option]:
    """Ways to understand all, those in which nothing has two names where that can be."""
    if not items:
        yield ()
        return
    first, rest = items[0], items[1:]
    free = [x for x in first.options if not first.alone or not {k for _one, k in x} & used]
    for option in free or first.options:
        for others in _ways(rest, used | {k for _one, k in option}):
            yield (*option, *others)


def _close(values: Array, value: float, signed: bool = False) -> Any:
    near = TOLERANCES.same_relation * abs(value)
    gap = values - value if signed else np.abs(values) - abs(value)
    return np.abs(gap) <= near


def _cells(table: DHTable, gravity: float) -> list[_Cell]:
    """The numbers of an arm, in the same order for arms of one kind."""
    standard = table.convention is Convention.STANDARD
    cells: list[_Cell] = []

    def put(kind: str, what: str, k: int, links: tuple[int, ...], values: Iterable[float]) -> None:
        cells.extend(_Cell(kind, (what, k), links, float(x)) for x in values)

    for k, link in enumerate(table.links):
        com = np.asarray(link.com, dtype=float)
        put("length", "a", k, (k,) if standard else (k, k - 1), [link.a])
        put("length", "d", k, (k,), [link.d])
        for axis, (x, end) in enumerate(zip(com, (link.a, link.d, link.d), strict=True)):
            which = f"com{axis}" if x else "d" if axis else "a"
            put("centre", which, k, (k,), [x, end + x, end - x] if end else [x])
        put("mass", "m", k, (k,), [link.mass])
        about = [*moments(link)]  # its centre, its frame, its joint: that rather than a far end
        of_joint = about[-_OF_A_TENSOR:] if standard else []
        centre, behind = about[:_OF_A_TENSOR], about[_OF_A_TENSOR : len(about) - len(of_joint)]
        put("moment", "I", k, (k,), [*centre, *of_joint, *behind])
        put("twist", "twist", -1, (k,), [link.alpha])
        put("kept", "kept", -1, (), _strange([link.theta, link.armature]))
    ends = np.asarray(table.tool, dtype=float), np.asarray(table.base, dtype=float)
    for name, pose in zip(("tool", "base"), ends, strict=True):
        links = (table.n - 1,) if name == "tool" and not standard else ()
        for axis in range(3):
            put("length", f"{name}{axis}", -1, links, [pose[axis, 3]])
        put("kept", "kept", -1, (), _strange(pose[:3, :3].ravel()))
    put("kept", "kept", -1, (), [gravity])
    return cells


def home_of(table: DHTable) -> Array:
    """The coordinates of an arm's frames and of its tool while all joints are at zero."""
    still = np.zeros(table.n)
    points: Array = np.concatenate([table.frames(still), table.fk(still)])[:, :3, 3].ravel()
    return points


def _far_at_home(table: DHTable, cells: Sequence[_Cell]) -> dict[int, float]:
    """Those of these coordinates, by their places, that are none of the table's lengths.

    The points of screw axes have them.
    """
    lengths = [0.0, *(one.value for one in cells if one.kind == "length")]
    far: dict[int, float] = {}
    for k, x in enumerate(home_of(table).tolist()):
        if not _close(np.array([*lengths, *far.values()]), x).any():
            far[k] = x
    return far


def _at_home(value: float, place: int) -> _Cell:
    return _Cell("length", ("home", place), (), value)


def _strange(values: Iterable[float]) -> list[float]:
    """Of numbers those that need be something of an arm's."""
    return [x for x in map(float, values) if not named_at_will(x)]


def _apart(
    table: DHTable, carried: set[Which], tied: dict[Which, Which], turned: float, odd: bool
) -> DHTable:
    """The arm with other numbers for those that a program has names for.

    Where one of these is ``odd`` it may be a centre's, and none need be in the middle of its link.
    """
    every = [(f"{name}{axis}", -1) for name in ("tool", "base") for axis in range(3)]
    every += [(what, k) for what in ("a", "d", "m", "I") for k in range(table.n)]
    every += [(f"com{axis}", k) for axis in range(3) for k in range(table.n)]

    def factor(what: str, k: int) -> float:
        which = tied.get((what, k), (what, k))
        if which not in carried:
            return 1.0
        return _LEAST + _SPREAD * ((1 + every.index(which)) * _TURN % 1.0)

    has = {what[:3] for what, _k in carried}
    told = [{what for what, of in carried | {*tied} if of == k} for k in range(table.n)]
    standard = table.convention is Convention.STANDARD
    links: list[DHLink] = []
    for k, link in enumerate(table.links):
        com = np.asarray(link.com, dtype=float)
        length, longer = _along(table, k, factor)
        a, mass = factor("a", k) * link.a, factor("m", k) * link.mass
        moved = longer * com
        for axis, x in enumerate(com if "com" in has else ()):
            which = f"com{axis}"
            lengths = np.array([link.a, link.d, length])
            middle = np.flatnonzero(_close(lengths, 2 * x))
            if which not in told[k] and x and len(middle) and not odd:
                moved[axis] = x * (factor("a", k), factor("d", k), longer)[middle[0]]
            elif standard and x and not axis:
                moved[0] = factor(which, k) * (link.a + x) - a
            else:
                moved[axis] = factor(which, k) * x
        half = _close(2 * abs(com[0]), abs(length))
        if half and longer == 1.0 and {"com0", "m"} <= told[k]:
            longer = factor("com0", k)  # a rod, of which the program has half the length
        grown = factor("I", k) if "I" in told[k] else factor("m", k) * longer**2
        links.append(
            replace(
                link,
                a=a,
                alpha=turned * link.alpha,
                d=factor("d", k) * link.d,
                mass=mass,
                com=moved,
                inertia=grown * np.asarray(link.inertia),
            )
        )
    ends: list[Array] = []
    for name in ("tool", "base"):
        pose = np.array(getattr(table, name), dtype=float)
        pose[:3, 3] *= [factor(f"{name}{axis}", -1) for axis in range(3)]
        ends.append(pose)
    return replace(table, links=links, unphysical=True, tool=ends[0], base=ends[1])


def _along(table: DHTable, k: int, factor: Callable[[str, int], float]) -> tuple[float, float]:
    """How long a link is, and how much longer it becomes."""
    link = table.links[k]
    if table.convention is Convention.STANDARD:
        found = (link.a, factor("a", k))
    elif k + 1 == table.n:
        found = (float(np.asarray(table.tool)[0, 3]), factor("tool0", -1))
    else:
        found = (table.links[k + 1].a, factor("a", k + 1))
    return found if found[0] else (link.d, factor("d", k))
