"""Another arm, on which what is one by the numbers alone is two things.

Where l1 is 0.5, a lost l1 and a lost half are one; on an arm with all lengths longer and all masses
heavier, with the program's own numbers changed alike, they are not.
"""

from __future__ import annotations

import ast
import math
import operator
import re
import sys
from collections.abc import Callable, Iterator, Sequence
from contextlib import suppress
from dataclasses import dataclass, replace
from fractions import Fraction
from functools import cached_property
from itertools import islice, product
from typing import Any

import numpy as np

from kinlab.arrays import Array
from kinlab.check.quantities.fivebar import numbers as plain_numbers
from kinlab.doctor.bytecode.syntax import called, nodes
from kinlab.doctor.changes import table_of
from kinlab.doctor.program.edits.numbers.data import (
    NumberPlace,
    holds_more,
    leaves,
    leaves_of,
    numbers,
    together,
)
from kinlab.doctor.program.edits.single.whole import SIZES
from kinlab.doctor.program.grounds.called import kinds_called
from kinlab.doctor.program.grounds.labels import Label, Labels
from kinlab.doctor.program.observed import Observed
from kinlab.doctor.program.own.plain import attributes, home
from kinlab.doctor.program.places import DATA, ProgramEdit, changed
from kinlab.doctor.program.read import of_numbers
from kinlab.doctor.program.trial import FailedError, NoProgramError, Trial, named_in, quietly
from kinlab.errors import KinlabError, already_said
from kinlab.fivebar.linkage import FiveBar
from kinlab.model.dh import DHLink, DHTable
from kinlab.model.robot import Robot
from kinlab.symbolic.vocabulary import vocabulary
from kinlab.tolerances import TOLERANCES

_LONGER, _HEAVIER, _STEP = 1.25, 1.375, 0.0625
"""How much; each link behind is heavier by a step more. No product of few of them is 1."""
_TWISTED = 0.8
"""How much the axes are turned towards each other: no sine or cosine of that is 0 or 1."""
_PARTS = 12
"""Denominator up to which a fraction, or one of pi, is nobody's length or mass."""
_WAYS = 32
"""Ways of understanding a program's numbers that are tried."""
_ROWS = ("array", "asarray", "diag")
"""Functions that make an array of a list."""
_NOBODYS = (0.0, 1.0, 2.0)
"""Sizes of numbers with a name that need be nothing of an arm's."""
_OPERATORS: dict[type[ast.operator], Callable[[Any, Any], float]] = {
    ast.Add: operator.add,
    ast.Sub: operator.sub,
    ast.Mult: operator.mul,
    ast.Div: operator.truediv,
    ast.Pow: math.pow,
}
"""What typed numbers are worked out with."""
_SIMPLE = 12
"""Denominator up to which a fraction may be meant."""


@dataclass(frozen=True, eq=False)
class OtherArm:
    """Another arm, and the program's numbers changed alike.

    Attributes:
        table: the arm's.
        ways: what is put into the program; several where a number may be several things.
        whole: whether nothing else of the program can be the first arm's own, so that a program
            that is right is right for this one, too.
        fitting: where numbers of the program are that the first arm has as they are called.
        noughts: where noughts are, which fit anything.
        odd: whether one is none of the first arm's, while others of its kind are.
    """

    table: DHTable
    ways: tuple[tuple[ProgramEdit, ...], ...]
    whole: bool
    fitting: frozenset[Any] = frozenset()
    noughts: frozenset[Any] = frozenset()
    odd: bool = False

    @cached_property
    def robot(self) -> Robot | None:
        """The arm; None where there is none with links like these."""
        try:
            with already_said():
                return Robot.from_dh(self.table)
        except (KinlabError, TypeError, ValueError):
            return None


@dataclass(frozen=True, eq=False)
class ProgramNumber:
    """A number of a program: of ``pi/2`` the whole.

    Attributes:
        place: where it is.
        value: what it is.
        alone: whether it stands for itself, and may be the arm's.
        given: whether it is given on as it is, or raised to a power: it may be a plain number as
            well, or one that has a name, too.
        below: whether the place is what pi or a number is divided by.
        used: whether the program names it, and not the arm's table alone.
    """

    place: NumberPlace
    value: float
    alone: bool
    given: bool = False
    below: bool = False
    used: bool = True

    def times(self, factor: float) -> tuple[NumberPlace, float]:
        """What is put there so that it is so many times as large."""
        return self.place, self.place.value / factor if self.below else factor * self.place.value


def parallel_arm(
    robot: Robot, trial: Trial, observed: Observed, masses: bool = True
) -> OtherArm | None:
    """As :func:`other_arm`, of an arm whose axes are all parallel one whose axes are, too.

    A program may count on it, and turn by sums of angles. None of other arms.
    """
    table = table_of(robot)
    twists = [] if table is None else [link.alpha for link in table.links if link.alpha]
    if not twists or not all(math.isclose(abs(x), math.pi) for x in twists):
        return None
    return other_arm(robot, trial, observed, masses, twist=False)


def other_arm(
    robot: Robot, trial: Trial, observed: Observed, masses: bool = True, *, twist: bool = True
) -> OtherArm | None:
    """An arm with longer and heavier links, and other twists where the program's numbers hold them.

    Where no ``masses`` are asked for, what may be a length is none; without ``twist`` the twists
    stay as they are.

    None of a robot without a table, and where no number of the program is the arm's.
    """
    table = table_of(robot)
    if table is None:
        return None
    found = [*numbers_of(trial, observed)]
    twisted = twisted_by(table, found, trial) if twist else 1.0
    kinds = _kinds(robot, table, twisted)
    may = [_meant(kinds, one.value) for one in found]
    if not masses:
        may = [{x for x in some if x[0] not in ("mass", "moment")} or some for some in may]
    meant = _alike(found, may, Labels(trial, table.n))
    letters = vocabulary(table).values
    carried = np.array([one.value for one in found if one.alone])
    whole = True
    choices: dict[Any, tuple[list[ProgramNumber], list[float]]] = {}
    for one, some in zip(found, meant, strict=True):
        own = may_be_of_one_arm(one.value)
        if (one.alone or own or one.given) and some:
            plain = not own and not one.place.place and one.place.node not in letters
            factors = sorted({factor for _kind, factor in some}.union([1.0] * plain))
            choices.setdefault((_key(one), *factors), ([], factors))[0].append(one)
        elif own or (some and not one.alone):
            whole = whole and not own and _among(one.value, carried)
        elif one.alone and isinstance(one.place.value, float) and not one.place.place:
            whole = whole and named_at_will(one.value)
    ways: list[tuple[ProgramEdit, ...]] = []
    put: list[tuple[NumberPlace, float]] = []
    for chosen in islice(product(*(factors for _some, factors in choices.values())), _WAYS + 1):
        moved = [
            one.times(factor)
            for (some_, _factors), factor in zip(choices.values(), chosen, strict=True)
            for one in some_
            if factor != 1.0
        ]
        put = put or moved
        ways += [tuple(together(moved))] if moved else []
    if not ways:
        return None
    larger = _scaled(table, twisted)
    if larger is None:
        return None
    whole = whole and len(ways) <= _WAYS and not holds_an_arm(trial)
    whole = whole and not _one_for_several(found, kinds)
    whole = whole and stays(trial, put)
    other = OtherArm(larger, tuple(ways[:_WAYS]), whole)
    return replace(other, whole=whole and _works_out_too(trial, robot, other))


def stays(trial: Trial, put: Sequence[tuple[NumberPlace, float]]) -> bool:
    """Whether a program's numbers are what is put there also when its lines have run anew."""
    if not any(part.sets for part in trial.program.parts):
        return True

    def held() -> dict[Any, float]:
        return {(one.node, one.place): float(one.value) for one in leaves(trial)}

    expected = held()
    new = {(one.node, one.place): x for one, x in put if one.part == DATA}
    expected |= {key: x for key, x in new.items() if key in expected}  # others nothing uses
    edits = together(put)
    changes = [change for edit in edits for change in edit.changes]
    try:
        with quietly(), trial.changed({edit.part for edit in edits}, changes):
            trial.load()
            found = held()
    except (NoProgramError, FailedError):
        return False
    return found.keys() == expected.keys() and all(
        math.isclose(found[key], x, rel_tol=TOLERANCES.same_number) for key, x in expected.items()
    )


def _works_out_too(trial: Trial, robot: Robot, other: OtherArm) -> bool:
    """Whether what is worked out of typed numbers alone, and is the arm's, is the other's, too.

    In ``2*0.4**2/12`` the 2 may be a mass that nothing tells from a plain number.
    """
    typed = [node for tree in trial.trees for node in _worked_out(tree)]
    own = [node for node in typed if is_own(robot, _value(node)) and not _plain(_value(node))]
    if not own or other.robot is None:
        return True
    for way in other.ways:
        with changed(trial, way):
            if all(is_own(other.robot, _value(node)) for node in own):
                return True
    return False


def _worked_out(node: ast.AST) -> Iterator[ast.BinOp]:
    """The largest expressions of an operator and nothing but typed numbers."""
    inner = [*nodes(node)] if isinstance(node, ast.BinOp) else []
    known = ast.Constant | ast.BinOp | ast.UnaryOp | ast.operator | ast.unaryop
    if isinstance(node, ast.BinOp) and all(isinstance(one, known) for one in inner):
        yield node
    else:
        for below in ast.iter_child_nodes(node):
            yield from _worked_out(below)


def _value(node: ast.expr) -> float:
    """What typed numbers give; NaN where they have no value."""
    if isinstance(node, ast.BinOp):
        by = _OPERATORS.get(type(node.op))
        try:
            return by(_value(node.left), _value(node.right)) if by is not None else math.nan
        except (ArithmeticError, ValueError):
            return math.nan
    if isinstance(node, ast.UnaryOp):
        return -_value(node.operand) if isinstance(node.op, ast.USub) else math.nan
    value = getattr(node, "value", None)
    return float(value) if isinstance(value, int | float) else math.nan


def _plain(value: float) -> bool:
    """Whether a number is whole, or half of one, and need be nothing of an arm's."""
    return float(2 * value).is_integer()


def _one_for_several(found: Sequence[ProgramNumber], kinds: Kinds) -> bool:
    """Whether one number is the masses of several links, which are heavier each by another part."""
    may = (one for one in found if one.alone or one.given or may_be_of_one_arm(one.value))
    named = np.array([one.value for one in may])
    masses = [known[0] for what, _k, _by, known in kinds if what == "mass" and known[0]]
    return any(1 <= np.isclose(named, m).sum() < np.isclose(masses, m).sum() for m in masses)


_DECIMALS = re.compile(r"\d\.\d")
"""What numbers in a text have."""


def holds_an_arm(trial: Trial) -> bool:
    """Whether a program asks an arm itself, or this package, where no other can be put.

    Nor can it be where an array has too many numbers, or where these are read from a text.
    """
    read = (x.value for part in trial.program.parts if part.sets for x in nodes(part.tree)
            if isinstance(x, ast.Constant) and isinstance(x.value, str))  # fmt: skip
    if any(len(_DECIMALS.findall(text)) > 1 for text in read):
        return True
    used = {name for tree in trial.trees for name in named_in(tree)}
    held = [value for name, value in trial.program.space.items() if name in used]
    kept = [attributes(one) for one in (*held, *trial.program.bound)]
    held += [x for of in kept for name, x in of.items() if name in used]
    return any(home(x) in ("kinlab", "pinocchio") for x in held) or holds_more(trial)


def twisted_by(table: DHTable, found: Sequence[ProgramNumber], trial: Trial) -> float:
    """How many times as large twists are, where the program's numbers hold them.

    Where these hold an offset as it is turned, ``[a, d*sin(alpha), d*cos(alpha)]``, they stay.
    """
    if _offsets_turned(table, trial):
        return 1.0
    twists = [link.alpha for link in table.links if link.alpha]
    held = np.array([one.value for one in found if one.alone and one.used])
    turned = bool(twists) and all(_among(x, held) for x in twists) and not _shared(table, held)
    return _TWISTED if turned else 1.0


def _offsets_turned(table: DHTable, trial: Trial) -> bool:
    """Whether a row of a program is the way from a frame to the next, with its twist in it."""
    turned = [
        np.abs([link.a, link.d * math.sin(link.alpha), link.d * math.cos(link.alpha)])
        for link in table.links
    ]
    turned = [row for row in turned if row[1] > TOLERANCES.same_number]
    held = [trial.space.get(name) for name in trial.program.data] if turned else []
    rows = [row for one in held if isinstance(one, list | tuple | np.ndarray) for row in one]
    near = TOLERANCES.same_number
    for row in rows:
        with suppress(TypeError, ValueError):  # what is no row of numbers
            typed = np.abs(np.asarray(row, dtype=float))
            same = turned if typed.shape == turned[0].shape else []
            if any(np.allclose(typed, own, rtol=near, atol=near) for own in same):
                return True
    return False


def named_at_will(value: float) -> bool:
    """Whether a number with a name need be nothing of an arm's."""
    return abs(value) in _NOBODYS or may_be_step(value) or _turns_degrees(value)


def _turns_degrees(value: float) -> bool:
    """Whether a number is what degrees are multiplied with, or radians."""
    parts = value * 180 / np.pi, value * np.pi / 180
    return any(abs(abs(x) - 1) <= TOLERANCES.same_relation for x in parts)


def own_rows(robot: Robot) -> list[Array]:
    """The arm's own numbers as they stand in rows: centres of mass, moments of inertia, columns."""
    table = table_of(robot)
    if table is None:
        return []
    rows = [np.array(link.com, dtype=float) for link in table.links]
    tensors = [np.array(link.inertia, dtype=float) for link in table.links]
    rows += [np.diag(one) for one in tensors] + [one.ravel() for one in tensors]
    for name in ("a", "d", "mass"):
        rows.append(np.array([getattr(link, name) for link in table.links], dtype=float))
    return [row for row in rows if row.any()]


def _shared(table: DHTable, held: Array) -> bool:
    """Whether one number of a program may be a twist and a joint's angle at once: ``H = pi/2``."""
    twists = np.abs([link.alpha for link in table.links])
    for angle in {abs(link.theta) for link in table.links if link.theta}:
        alike = np.isclose(twists, angle)
        cells = alike.sum() + np.isclose(np.abs([link.theta for link in table.links]), angle).sum()
        if alike.any() and np.isclose(np.abs(held), angle).sum() < cells:
            return True
    return False


def own_numbers(robot: Any) -> Array:
    """The arm's, or the five-bar's, own numbers, with their signs."""
    if isinstance(robot, FiveBar):
        plain = plain_numbers(robot)
        both = [plain.l1, plain.l2, plain.arm, plain.crank, plain.crank_com, plain.crank_inertia]
        both += [plain.rod, plain.rod_com, plain.rod_inertia, plain.rotor]
        both += [robot.rotor_inertia, robot.gear_ratio]
        return np.unique(np.concatenate([*map(np.ravel, both), [plain.e, plain.payload, plain.g]]))
    table = table_of(robot)
    if table is None:
        return np.empty(0)
    every = np.concatenate([known for *_what, known in _kinds(robot, table, 1.0)])
    return np.unique(every[every != 0.0])


def is_own(robot: Any, value: float) -> bool:
    """Whether the robot has a number, with its sign."""
    if not abs(value) <= sys.float_info.max:  # NaN is never less
        return False
    return bool(np.isclose(own_numbers(robot), value, rtol=TOLERANCES.same_number, atol=0).any())


def is_free(value: float) -> bool:
    """Whether a number is neither whole, nor half of one, nor a simple part of it or of pi."""
    simple = (Fraction(x).limit_denominator(_SIMPLE) for x in (value, value / np.pi))
    return not any(
        math.isclose(x, float(part), rel_tol=TOLERANCES.same_number)
        for x, part in zip((value, value / np.pi), simple, strict=True)
    )


def _key(one: ProgramNumber) -> Any:
    """Numbers of one list are of one kind, and equal ones that are given on; others each alone."""
    if one.given:
        return one.value
    listed = one.place.part == DATA and one.place.place
    return (one.place.node, *_names_down(one.place)) if listed else id(one)


def numbers_of(trial: Trial, observed: Observed) -> Iterator[ProgramNumber]:
    """The numbers of a program, those that a slip has left unused among them."""
    made = {name for name, x in trial.space.items() if isinstance(x, type)}
    plain = {id(node): node for tree in trial.trees for node in _alone(tree, made)}
    calls = [node for tree in trial.trees for node in nodes(tree) if isinstance(node, ast.Call)]
    given = {id(one) for call in calls for one in call.args if called(call) not in SIZES}
    raised = (one for tree in trial.trees for one in nodes(tree) if isinstance(one, ast.BinOp))
    given |= {id(one.left) for one in raised if isinstance(one.op, ast.Pow)}  # 0.5**2
    below = {id(node.right): node for node in plain.values() if isinstance(node, ast.BinOp)}
    above = {id(one) for whole in below.values() for one in nodes(whole.left)}
    idle = [leaf for name in unused(trial) for leaf in leaves_of(trial, name)]
    alone_idle = {leaf.node for leaf in idle if not leaf.place}
    directions = _directions(trial)
    for place in (*numbers(trial, observed), *_defaults(trial), *idle):
        if id(place.holder) in directions or id(place.node) in above:
            continue  # of 0.4/2 the 2 stands for both
        whole = below.get(id(place.node))
        if place.value and whole is not None:
            yield ProgramNumber(place, _above(whole) / place.value, True, below=True)
        else:
            alone = place.part == DATA or id(place.node) in plain
            value = float(place.value)
            plainly = id(place.node) in given and not may_be_of_one_arm(value)
            used = place.part != DATA or place.node not in alone_idle
            yield ProgramNumber(place, value, alone, plainly, used=used)


def _directions(trial: Trial) -> set[int]:
    """What holds nothing but 0, 1 and -1, with a zero: the numbers of axes, and of no arm."""
    held: list[Any] = [trial.space.get(name) for name in trial.program.data]
    inner = [x for one in held if isinstance(one, list | tuple) for x in one]
    found = {id(one) for one in (*held, *inner) if _is_direction(one)}
    for tree in trial.trees:
        for node in nodes(tree):
            if isinstance(node, ast.List | ast.Tuple):
                entries = [x.operand if isinstance(x, ast.UnaryOp) else x for x in node.elts]
                if _is_direction([getattr(x, "value", None) for x in entries]):
                    found |= {*map(id, entries)}
    return found


def _is_direction(value: Any) -> bool:
    if not isinstance(value, list | tuple | np.ndarray):
        return False
    try:
        numbers = np.abs(np.asarray(value, dtype=float))
    except (TypeError, ValueError, OverflowError):
        return False
    some = numbers.ndim > 0 and numbers.size > 1 and (numbers == 0).any()
    return bool(some and np.isin(numbers, (0.0, 1.0)).all())


def _defaults(trial: Trial) -> Iterator[NumberPlace]:
    """The numbers that are written as what arguments are by default."""
    for part, tree in enumerate(trial.trees):
        for given in (*tree.args.defaults, *tree.args.kw_defaults):
            if isinstance(given, ast.Constant) and isinstance(given.value, float):
                yield NumberPlace(given.value, part, given, "value", given)


def unused(trial: Trial) -> list[str]:
    """Names of numbers of the module that a slip has left unused: a repair may use them again."""
    used = {*trial.program.data, *trial.sets}
    kinds = (int, float, list, tuple, np.ndarray)
    known = [(name, x) for name, x in trial.program.space.items() if type(x) in kinds]
    return [name for name, x in known if name not in used and of_numbers(x)]


def _scaled(table: DHTable, twisted: float) -> DHTable | None:
    """The arm with all its lengths and masses larger; None where that is none."""
    links = [
        replace(
            link,
            a=_LONGER * link.a,
            alpha=twisted * link.alpha,
            d=_LONGER * link.d,
            mass=_heavier(k) * float(link.mass),
            com=_LONGER * np.asarray(link.com),
            inertia=_heavier(k) * _LONGER**2 * np.asarray(link.inertia),
        )
        for k, link in enumerate(table.links)
    ]
    tool, base = np.array(table.tool, dtype=float), np.array(table.base, dtype=float)
    tool[:3, 3] *= _LONGER
    base[:3, 3] *= _LONGER
    try:
        with already_said():
            return replace(table, links=links, tool=tool, base=base)
    except KinlabError:
        return None


Kinds = Sequence[tuple[str, int, float, Array]]
"""Numbers of the first arm: what they are, of which link, what they are multiplied by, and they."""
Meant = set[tuple[str, float]]
"""What a number may be, with what it is multiplied by."""


def _heavier(k: int) -> float:
    return _HEAVIER + k * _STEP


def _kinds(robot: Robot, table: DHTable, twisted: float) -> Kinds:
    links = table.links
    lengths = [x for k in links for x in (k.a, k.d, *np.ravel(k.com))]
    lengths += [x for k in links for x in np.add((k.a, k.d, k.d), np.asarray(k.com)[[0, 1, 2]])]
    lengths += [x for k in links for x in np.subtract((k.a, k.d, k.d), np.asarray(k.com))]
    lengths += [*np.ravel(np.asarray(table.tool)[:3, 3]), *np.ravel(np.asarray(table.base)[:3, 3])]
    kept = [x for k in links for x in (k.theta, k.armature)]
    kept += [*np.ravel(np.asarray(table.tool)[:3, :3]), *np.ravel(np.asarray(table.base)[:3, :3])]
    kept = [x for x in kept if abs(x) not in _NOBODYS]
    kinds: list[tuple[str, int, float, Any]] = [
        ("length", -1, _LONGER, lengths),
        ("twist", -1, twisted, [k.alpha for k in links]),
        ("kept", -1, 1.0, [*kept, np.linalg.norm(robot.model.gravity.linear)]),
    ]
    for k, link in enumerate(links):
        kinds.append(("mass", k, _heavier(k), [link.mass]))
        kinds.append(("moment", k, _heavier(k) * _LONGER**2, [*moments(link)]))
    return [(what, k, by, np.array(known, dtype=float)) for what, k, by, known in kinds]


def moments(link: DHLink) -> Iterator[float]:
    """Of a link's inertia about its centre of mass, about its frame, and about its joint."""
    centre = np.asarray(link.com, dtype=float)
    for arm in (np.zeros(3), centre, centre + (link.a, 0.0, link.d)):
        about = np.asarray(link.inertia) + link.mass * (arm @ arm * np.eye(3) - np.outer(arm, arm))
        yield from np.ravel(about)


def _meant(kinds: Kinds, value: float) -> set[tuple[str, int, float]]:
    """What a number of the first arm may be: several where it has the value of several."""
    return {(what, k, by) for what, k, by, known in kinds if value and _among(value, known)}


def _alike(
    found: Sequence[ProgramNumber], meant: Sequence[set[tuple[str, int, float]]], labels: Labels
) -> list[set[tuple[str, float]]]:
    """What numbers are, the same kind in all of a list, or of a column of it, where there is one.

    Of several links the one at whose place a number stands.
    """
    common: dict[Any, set[str]] = {}
    for one, some in zip(found, meant, strict=True):
        nobodys = not some and abs(one.value) in _NOBODYS  # a rotor's 2.0 beside 0.3 and 0.1
        for key in _groups(one.place) if one.value and not nobodys else ():
            kinds = {what for what, _k, _by in some}
            common[key] = common.get(key, kinds) & kinds
    out: list[Meant] = []
    for one, some in zip(found, meant, strict=True):
        kind = next((common[key] for key in _groups(one.place) if common.get(key)), None)
        left = {x for x in some if kind is None or x[0] in kind}
        called_so = _as_called(labels.of(one.place), one.place.part == DATA, left)
        out.append({(what, by) for what, _k, by in called_so})
    return out


def _as_called(
    label: Label, data: bool, left: set[tuple[str, int, float]]
) -> set[tuple[str, int, float]]:
    """Of what a number may be what its name says, and of the link at whose place it stands."""
    name, digits, at = label
    kinds = {"length" if kind == "centre" else kind for kind in kinds_called(name)}
    called_so = {x for x in left if x[0] in kinds}
    left = called_so or left
    if not data and not called_so:  # the text's rows may be those of a matrix
        return left
    link = at[0] if at else digits - 1 if digits is not None else None
    return {x for x in left if link is not None and x[1] in (-1, link)} or left


def _groups(place: NumberPlace) -> list[Any]:
    list_ = (place.node, *_names_down(place))
    return [list_, (*list_, *place.place[-1:])] if place.part == DATA else []


def _names_down(place: NumberPlace) -> list[str]:
    """The attributes and keys down to a number."""
    return [one for one in place.place if isinstance(one, str)]


def may_be_step(value: float) -> bool:
    return abs(value) <= TOLERANCES.may_be_step


def may_be_of_one_arm(value: float) -> bool:
    """Whether a number that stays in a program may be made of the first arm's numbers."""
    if not np.isfinite(value):
        return False
    parts = _PARTS * value, _PARTS * value / np.pi
    plain = any(abs(x - round(x)) <= TOLERANCES.same_relation * abs(x) for x in parts)
    return not may_be_step(value) and not plain and not _turns_degrees(value)


def _among(value: float, known: Array) -> bool:
    close = TOLERANCES.same_relation * abs(value)
    return bool(np.any(np.abs(np.abs(known) - abs(value)) <= close))


_THROUGH = ("enumerate", "zip", "reversed")
"""What a loop goes through rows by."""


def _alone(tree: ast.AST, made: set[str]) -> Iterator[ast.expr]:
    """The numbers, and parts of pi or 1, that names are set to as they are, or that are in lists.

    What is given by its name, or to a class of those ``made``, or what a function's arguments are
    by default, has a name, too.
    """
    for node in nodes(tree):
        waiting: list[Any] = [node.value] if isinstance(node, ast.Assign) else []
        if isinstance(node, ast.For | ast.comprehension):  # rows that a loop goes through
            over = node.iter
            through = isinstance(over, ast.Call) and called(over) in _THROUGH
            waiting += over.args if isinstance(over, ast.Call) and through else [over]
        if isinstance(node, ast.arguments):
            waiting += [one for one in (*node.defaults, *node.kw_defaults) if one is not None]
        while waiting:
            one = waiting.pop()
            if isinstance(one, ast.Constant) or _is_quotient(one):
                yield one
            elif isinstance(one, ast.Tuple | ast.List):
                waiting += one.elts
            elif isinstance(one, ast.Dict):
                waiting += one.values
            elif isinstance(one, ast.UnaryOp):
                waiting.append(one.operand)
            elif isinstance(one, ast.ListComp):
                waiting.append(one.elt)
            elif isinstance(one, ast.Call):
                waiting += [keyword.value for keyword in one.keywords]
                given = len(one.args) if called(one) in made else called(one) in _ROWS
                waiting += one.args[:given]


def _is_quotient(node: ast.AST) -> bool:
    """Whether a node is pi or a number, over a number."""
    if not isinstance(node, ast.BinOp) or not isinstance(node.op, ast.Div):
        return False
    return bool(_above(node)) and isinstance(node.right, ast.Constant)


def _above(node: ast.BinOp) -> float:
    """The size of what is divided, pi or a number; 0 of anything else."""
    top = node.left.operand if isinstance(node.left, ast.UnaryOp) else node.left
    if isinstance(top, ast.Constant) and isinstance(top.value, int | float):
        return abs(float(top.value))
    return np.pi * ((getattr(top, "attr", None) or getattr(top, "id", None)) == "pi")
