"""The arm's own numbers: one for another, one for a number of nobody's, one that is missing."""

from __future__ import annotations

import ast
from collections.abc import Iterator, Sequence
from contextlib import suppress
from dataclasses import replace
from itertools import chain, combinations
from types import ModuleType
from typing import Any

import numpy as np

from kinlab.arrays import Array
from kinlab.doctor.bytecode.syntax import called, nodes
from kinlab.doctor.changes import table_of
from kinlab.doctor.program.edits.numbers.as_the_arm import typed
from kinlab.doctor.program.edits.numbers.data import NumberPlace, measured, numbers
from kinlab.doctor.program.edits.numbers.left_out import (
    at_the_tool,
    has_the_tool,
    rotors_left_out,
    tool_along_an_axis,
    tool_behind_a_loop,
)
from kinlab.doctor.program.observed import Observed
from kinlab.doctor.program.places import (
    ANGLES,
    DATA,
    Here,
    ProgramEdit,
    array_of,
    number,
    places,
    root,
)
from kinlab.doctor.program.trial import Trial
from kinlab.fivebar import FiveBar
from kinlab.model.dh import DHTable
from kinlab.model.link import Convention
from kinlab.tolerances import TOLERANCES

_PLAIN = (0.0, 0.5, 1.0, 2.0, 3.0, 4.0)
"""Sizes of numbers that are rather factors."""
_GRAVITY = (9.7, 9.9)
"""Between which a number is rather gravity's."""
_TURNED = 0.02
"""What it costs more to put a number in with the other sign."""
_SUMMED = 0.04
"""The same of a number that is a sum of two, in place of one of these."""
_OTHER_END = 1.06
"""Cost of how far a centre is from the joint for how far it is from its frame."""
_HALVES = 2
_AT_CENTRE = 1.08
"""Cost of where a link's centre is for its length."""
_COPIED = 0.01
"""What it costs more where a name is used that is another's copy."""
_OF_POINTS = 1.14
"""Cost of a point's coordinate for a number."""
_CONSTANT = 1.06
"""Cost of the part of a joint's coordinate that does not move, and of gravity."""
_WITH_ANOTHER = 1.1
"""Cost of what is carried with what else is."""
_MOVED, _LEFT_OUT = 1.1, 4
"""Cost of a transform that is missing; lengths of which one may be its."""
_TRANSFORMS = ((4, 4), (3, 3))
"""Shapes of transforms, and of rotations."""
_MOST = 16
"""Numbers of one kind of which any may be meant."""


def of_own_numbers(
    trial: Trial,
    observed: Observed,
    robot: Any,
    positions: Sequence[Array],
    accelerations: Sequence[Array],
) -> Iterator[ProgramEdit]:
    """Numbers of a program as others of the arm's of their kind, and lengths that are missing.

    Args:
        trial: the program.
        observed: what its expressions were.
        robot: the arm.
        positions, accelerations: its joints' at each of the states; empty where none are asked for.
    """
    table = table_of(robot)
    if table is None:
        return
    kinds, summed = sizes_of(table), _from_the_joint(table)
    centres = [abs(float(x)) for k in table.links for x in np.ravel(k.com)]
    turned = {pair for pair in zip(centres, summed, strict=True) if all(pair)}
    weight = float(np.linalg.norm(table.gravity))
    every = [*numbers(trial, observed)]
    given = [abs(float(place.value)) for place in every]
    for place in every:
        if not isinstance(place.value, float):
            continue
        if may_be_gravity(abs(place.value)):  # what is asked for may be without it
            yield place.edit(0.0, "number", _CONSTANT)
        for value, cost in _meant(place, kinds | {"gravity": [weight]}, summed, given):
            both = abs(float(place.value)), abs(value)
            other_end = any(_are(both, pair) or _are(both[::-1], pair) for pair in turned)
            cost = _OTHER_END if other_end else cost
            yield replace(place.edit(value, "number", cost), of_the_arm=True)
    yield from _of_points(table, every, kinds["length"])
    lengths = kinds["length"][:_MOST]
    in_text = {abs(float(place.value)) for place in every if place.part != DATA}
    left_out = [x for x in lengths if not among(x, given)]
    slides = [kind == "prismatic" for kind in robot.joint_kinds]
    cells = [one.d if slide else one.theta for one, slide in zip(table.links, slides, strict=True)]
    falls = [weight, -weight] if weight else []
    sums = (
        (positions, {k: [x] for k, x in enumerate(cells) if x}),
        (accelerations, {k: falls for k, slide in enumerate(slides) if slide}),
    )
    for part, tree in enumerate(trial.trees) if any(more for _, more in sums) else ():
        for here in places(part, tree):
            for stack, more in sums:
                yield from _without_what_is_constant(here, observed, stack, more)
    if weight and not any(map(may_be_gravity, given)):
        yield from _without_gravity(trial, observed, np.asarray(table.gravity, dtype=float))
    if any(among(x, some) for x in in_text for some in kinds.values()):  # where they are used
        for part, tree in enumerate(trial.trees):
            for here in places(part, tree):
                yield from _missing(here, observed, lengths)
                yield from _with_another(here, kinds)
                yield from _instead_of_zero(here, trial, left_out)
    to_centres = _to_centres(table, given)
    copies = {one for tree in trial.trees for one in _copies(tree)} if to_centres else set()
    for part, tree in enumerate(trial.trees) if to_centres else ():
        for here in places(part, tree):
            dear = isinstance(here.node, ast.Name) and here.node.id in copies
            for edit in _at_the_centre(here, observed, to_centres):
                yield replace(edit, cost=edit.cost + _COPIED) if dear else edit
    ends = (np.ravel(np.asarray(end)[:3, 3]) for end in (table.tool, table.base))
    arm = {abs(float(x)) for x in (*(x for k in table.links for x in (k.a, k.d)), *chain(*ends))}
    unnamed = [x for x in sorted(arm) if x and not among(x, given)]
    offset = np.asarray(table.tool, dtype=float)[:3, 3].any()
    has_tool = has_the_tool(table, given)
    has_more = offset or any(link.armature for link in table.links)
    for part, tree in enumerate(trial.trees) if has_more else ():
        held = (
            (node.id, observed.shape(node)) for node in nodes(tree) if isinstance(node, ast.Name)
        )
        stacks = {name: shape for name, shape in held if shape is not None}
        for here in places(part, tree):
            yield from at_the_tool(here, table, given)
            yield from rotors_left_out(here, table)
            if not has_tool:
                yield from tool_along_an_axis(here, observed, table, stacks)
    whole = not np.array_equal(np.asarray(table.tool, dtype=float), np.eye(4))
    whole = whole and "np" in trial.space and not has_the_tool(table, [*given, *_held(trial)])
    for part, tree in enumerate(trial.trees) if whole else ():
        yield from tool_behind_a_loop(part, tree, observed, table)
    yield from _moves_left_out(trial, observed, table, unnamed)
    yield from _begun_at_the_base(trial, observed, table)


def _held(trial: Trial) -> Iterator[float]:
    """The numbers that a module's names hold, used or not."""
    kinds = (int, float, list, tuple, np.ndarray)
    for value in (x for x in trial.space.values() if isinstance(x, kinds)):
        with suppress(ValueError, TypeError):
            yield from np.abs(np.ravel(np.asarray(value, dtype=float))).tolist()


def _copies(tree: ast.AST) -> Iterator[str]:
    """The names that are set to what another one is: ``R1 = A1``, where it is rather wrong."""
    for line in nodes(tree):
        if isinstance(line, ast.Assign) and isinstance(line.value, ast.Name):
            yield from (one.id for one in line.targets if isinstance(one, ast.Name))


def _are(both: tuple[float, float], pair: tuple[float, float]) -> bool:
    """Whether two numbers are a pair's."""
    return all(among(one, [other]) for one, other in zip(both, pair, strict=True))


def _without_what_is_constant(
    here: Here, observed: Observed, stack: Sequence[Array], more: dict[int, list[float]]
) -> Iterator[ProgramEdit]:
    """A joint's position with the part of its coordinate that does not move, or a slide's
    acceleration with gravity's."""
    node, parent = here.node, here.parent
    stored = isinstance(getattr(node, "ctx", None), ast.Store)
    if not isinstance(node, ast.Name | ast.Subscript) or stored or observed.shape(node) != ():
        return
    seen = observed.of(node)
    summed = isinstance(parent, ast.BinOp) and isinstance(parent.op, ast.Add | ast.Sub)
    if seen is None or summed or not seen.values or not len(stack):
        return
    if len(seen.values) % len(stack):
        return
    at = np.repeat(stack, len(seen.values) // len(stack), axis=0)
    for k, values in more.items():
        beside = np.abs(np.ravel(seen.values) - at[:, k])  # where differences are taken
        for value in values if np.max(beside) <= TOLERANCES.may_be_step else ():
            new = ast.BinOp(node, ast.Add() if value > 0 else ast.Sub(), typed(abs(value)))
            yield replace(here.instead(new, "missing term", _CONSTANT), of_the_arm=True)


def _without_gravity(trial: Trial, observed: Observed, down: Array) -> Iterator[ProgramEdit]:
    """Gravity for nothing, where the program has none: the base's acceleration is -g."""
    if not isinstance(trial.space.get("np"), ModuleType):
        return
    for part, tree in enumerate(trial.trees):
        for here in places(part, tree):
            zeros = isinstance(here.node, ast.Call) and called(here.node) == "zeros"
            shape = observed.shape(here.node) if zeros else None
            if shape in ((len(down),), (2 * len(down),)):
                still = np.zeros(len(down))
                ways = [down] if shape == down.shape else [np.r_[still, down], np.r_[down, still]]
                for vector in (sign * way for way in ways for sign in (-1, 1)):
                    new = array_of([number(float(x)) for x in vector + 0.0])
                    yield replace(here.instead(new, "number", 1.05), of_the_arm=True)


def sizes_of_legs(robot: FiveBar) -> dict[str, list[float]]:
    """The sizes of a five-bar's lengths, masses, and moments of inertia, each once."""
    lengths = [*robot.l1, *robot.l2, robot.e, 2 * robot.e, *robot.crank_com, *robot.rod_com]
    moments = [*robot.crank_inertia, *robot.rod_inertia, *robot.rotor_inertia]
    masses = [*robot.crank_mass, *robot.rod_mass, robot.payload]
    return _each_once({"length": lengths, "mass": masses, "moment": moments})


def sizes_of(table: DHTable) -> dict[str, list[float]]:
    """The sizes of the arm's lengths, masses, and moments of inertia, each once."""
    lengths = [x for k in table.links for x in (k.a, k.d, *np.ravel(k.com))]
    lengths += _from_the_joint(table)
    lengths += [*np.ravel(np.asarray(table.tool)[:3, 3]), *np.ravel(np.asarray(table.base)[:3, 3])]
    moments = [x for k in table.links for x in np.ravel(k.inertia)]
    masses = [k.mass for k in table.links]
    return _each_once({"length": lengths, "mass": masses, "moment": moments})


def _each_once(kinds: dict[str, list[float]]) -> dict[str, list[float]]:
    return {
        kind: sorted({float(f"{abs(x):.12g}") for x in some if x}) for kind, some in kinds.items()
    }


def _from_the_joint(table: DHTable) -> list[float]:
    """How far centres of mass are from their links' joints, along each axis."""
    sums = [np.add((k.a, k.d, k.d), np.ravel(k.com)) for k in table.links]
    return [float(f"{abs(x):.12g}") for x in np.ravel(sums)]


def _to_centres(table: DHTable, given: Sequence[float]) -> dict[float, tuple[float, ...]]:
    """How far from a link's end its centre is, by the link's length, where no number says it.

    Of a frame at the joint it is the distance from there, and not from the end.
    """
    found: dict[float, tuple[float, ...]] = {}
    for link, after in zip(table.links, [*table.links[1:], None], strict=True):
        com = float(np.ravel(link.com)[0])
        at_joint = table.convention is Convention.MODIFIED
        length = abs(after.a if after else 0.0) if at_joint else abs(link.a)
        way = abs(com) if at_joint else abs(link.a + com)
        if length and way and not among(way, [*given, length, length / _HALVES]):
            found[length] = (way,) if at_joint else (way, length - way)
    return found


def _at_the_centre(
    here: Here, observed: Observed, to_centres: dict[float, tuple[float, ...]]
) -> Iterator[ProgramEdit]:
    """Where a link's centre is for its length, which is named: ``L1 - 0.16`` for ``L1``."""
    node = here.node
    stored = isinstance(getattr(node, "ctx", None), ast.Store)
    if stored or not isinstance(node, ast.Name | ast.Attribute | ast.Subscript):
        return
    seen = observed.of(node)
    own = (None if seen is None else seen.only) or 0.0
    for length, (way, *back) in to_centres.items() if own else ():
        if among(abs(own), [length]):
            new: ast.expr = number(way if own > 0 else -way)
            if back and own > 0:
                new = ast.BinOp(node, ast.Sub(), number(float(f"{back[0]:.12g}")))
            yield replace(here.instead(new, "number", _AT_CENTRE), of_the_arm=True)


def _of_points(
    table: DHTable, every: Sequence[NumberPlace], lengths: Sequence[float]
) -> Iterator[ProgramEdit]:
    """The coordinates of points at the zero position: sums of lengths that follow one another."""
    steps = [abs(np.array([k.a for k in table.links])), abs(np.array([k.d for k in table.links]))]
    runs = [(i, j) for i, j in combinations(range(table.n + 1), 2) if j - i > 1]
    sums = {float(one[i:j].sum()) for one in steps for i, j in runs}
    points = sorted({float(f"{x:.12g}") for x in sums if x and not among(x, lengths)})[:_MOST]
    floats = [place for place in every if isinstance(place.value, float)]
    if not any(among(abs(place.value), points) for place in floats):
        return
    for place in floats:
        size = abs(place.value)
        for value in points if among(size, points) or among(size, lengths) else ():
            if abs(value - size) > TOLERANCES.same_number * value:
                edit = place.edit(float(np.copysign(value, place.value)), "number", _OF_POINTS)
                yield replace(edit, of_the_arm=True)


def _meant(
    place: NumberPlace,
    kinds: dict[str, list[float]],
    summed: Sequence[float],
    given: Sequence[float],
) -> Iterator[tuple[float, float]]:
    """Numbers that may be meant, and how far-fetched each is."""
    size = abs(float(place.value))
    own = [known for known in kinds.values() if among(size, known)]
    if own:
        if place.part == DATA and not place.place:  # a name for one of the arm's numbers
            kinds = {kind: [x for x in some if not among(x, given)] for kind, some in kinds.items()
                     if some in own}  # fmt: skip
            own = [*kinds.values()]
    elif size in _PLAIN or may_be_gravity(size) or size <= TOLERANCES.may_be_step:
        return
    cost = 1.12 if own else 1.1
    for kind, known in kinds.items():
        if own and known not in own:
            continue
        for value in known[:_MOST]:
            if abs(value - size) > TOLERANCES.same_number * value:
                far = _SUMMED if own and among(value, summed) else 0.0
                same = float(np.copysign(value, place.value))
                yield same, cost + far
                if kind == "length":
                    yield -same, cost + far + _TURNED


def _missing(here: Here, observed: Observed, lengths: Sequence[float]) -> Iterator[ProgramEdit]:
    """A length more or less, in a sum, or in what is set or given on."""
    node, parent = here.node, here.parent
    if not isinstance(node, ast.Name | ast.Subscript) or observed.shape(node) != ():
        return
    seen = observed.of(node)
    if seen is None or seen.whole:
        return
    op = parent.op if isinstance(parent, ast.BinOp) else None
    term = isinstance(op, ast.Add | ast.Sub) or isinstance(parent, ast.Assign)
    given = isinstance(parent, ast.Call) and called(parent) not in ANGLES and here.field != "func"
    if term or given:
        for length in lengths:
            for more in (ast.Add(), ast.Sub()):
                edit = here.instead(ast.BinOp(node, more, number(length)), "missing term", 1.24)
                yield replace(edit, of_the_arm=True)


def _with_another(here: Here, kinds: dict[str, list[float]]) -> Iterator[ProgramEdit]:
    """A mass, or a moment of inertia, and another link's: ``0.055 + 0.0008`` for ``0.055``."""
    node = here.node
    typed_in = node.value if isinstance(node, ast.Constant) else None
    if not isinstance(typed_in, float) or abs(typed_in) <= TOLERANCES.may_be_step:
        return
    for known in (kinds["mass"], kinds["moment"]):
        for other in known[:_MOST] if among(abs(typed_in), known) else ():
            if not among(abs(typed_in), [other]):
                new = ast.BinOp(node, ast.Add(), number(other))
                yield replace(here.instead(new, "missing term", _WITH_ANOTHER), of_the_arm=True)


def _instead_of_zero(here: Here, trial: Trial, lengths: Sequence[float]) -> Iterator[ProgramEdit]:
    """A length that the program names nowhere for a zero of a row, or one that is given on."""
    node, parent = here.node, here.parent
    if not isinstance(node, ast.Constant) or isinstance(node.value, bool) or node.value != 0:
        return
    own = {part.name for part in trial.program.parts}
    if measured(parent) or (isinstance(parent, ast.Call) and called(parent) in own):
        for length in lengths:
            yield replace(here.instead(number(length), "number", 1.12), of_the_arm=True)


def _moves_left_out(
    trial: Trial, observed: Observed, table: DHTable, lengths: Sequence[float]
) -> Iterator[ProgramEdit]:
    """A transform that is missing: of a length that the program names nowhere, of an angle of the
    arm's that does not move: ``@ trans(0, 0, 0.263)``, ``rotz(pi/2) @``."""
    calls: dict[str, ast.Call] = {}
    for tree in trial.trees:
        for node in nodes(tree):
            if not isinstance(node, ast.Call) or root(node.func) in ("np", "numpy"):
                continue  # no np.diag
            if observed.shape(node) in _TRANSFORMS and node.args:
                zeros = sum(isinstance(x, ast.Constant) and x.value == 0 for x in node.args)
                if 2 * zeros >= len(node.args) or len(node.args) == 1:
                    calls.setdefault(ast.unparse(node.func), node)
    angles = {float(x) for k in table.links for x in (k.alpha, k.theta) if x}
    sizes = {1: [typed(x) for x in sorted(angles)]}
    others = [number(x) for x in lengths[:_LEFT_OUT]]
    moves = [
        (name, observed.shape(call), ast.Call(call.func, _zeros_but(x, k, len(call.args)), []))
        for name, call in calls.items()
        for k in range(len(call.args))
        for x in sizes.get(len(call.args), others)
    ]
    for part, tree in enumerate(trial.trees) if moves else ():
        for here in places(part, tree):
            set_ = isinstance(here.parent, ast.Assign | ast.Return) and here.field == "value"
            inner = nodes(here.node) if set_ else ()
            there = {ast.unparse(x.func) for x in inner if isinstance(x, ast.Call)}
            for name, shape, move in moves if there else ():
                if observed.shape(here.node) == shape and name not in there:
                    for both in ((here.node, move), (move, here.node)):
                        new = ast.BinOp(both[0], ast.MatMult(), both[1])
                        edit = here.instead(new, "missing matrix", _MOVED)
                        yield replace(edit, of_the_arm=True)


def _zeros_but(value: ast.expr, at: int, count: int) -> list[ast.expr]:
    return [value if n == at else number(0) for n in range(count)]


def _begun_at_the_base(trial: Trial, observed: Observed, table: DHTable) -> Iterator[ProgramEdit]:
    """The transform of the arm's base for a unit matrix, where it is nothing but signs."""
    base = np.asarray(table.base, dtype=float)
    signs = np.diag(base)
    if not np.array_equal(base, np.diag(np.sign(signs))) or (signs == 1).all():
        return
    row = ast.List([number(x) for x in signs.tolist()], ast.Load())
    for part, tree in enumerate(trial.trees):
        for here in places(part, tree):
            node, seen = here.node, observed.of(here.node)
            if not isinstance(node, ast.Call) or called(node) not in ("eye", "identity"):
                continue
            library: ast.expr = ast.Name("np", ast.Load())
            library = node.func.value if isinstance(node.func, ast.Attribute) else library
            own = ast.Attribute(library, "diag", ast.Load())
            known = "np" in trial.space or isinstance(node.func, ast.Attribute)
            if known and seen is not None and seen.shape == base.shape:
                edit = here.instead(ast.Call(own, [row], []), "number", _MOVED)
                yield replace(edit, of_the_arm=True)


def may_be_gravity(value: float) -> bool:
    """Whether a number is rather the acceleration of gravity, to some digits."""
    return _GRAVITY[0] < value < _GRAVITY[1]


def among(value: float, known: Sequence[float]) -> bool:
    """Whether a number is one of those that are known."""
    return any(abs(value - x) <= TOLERANCES.same_number * max(x, value) for x in known)
