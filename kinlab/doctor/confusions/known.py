"""The table of known confusions: every reading that makes sense for a quantity."""

from __future__ import annotations

from collections.abc import Callable, Iterator, Sequence
from functools import partial
from itertools import combinations

import numpy as np

from kinlab.arrays import Array
from kinlab.check.quantities.serial import SERIAL
from kinlab.doctor.changes import Arguments, Case, Confusion
from kinlab.doctor.confusions import otherwise
from kinlab.doctor.confusions.robots import gravity_readings, inertia_readings, table_readings
from kinlab.doctor.derivations.words import together
from kinlab.fivebar import FiveBar
from kinlab.host.language import N_, _
from kinlab.model.robot import Robot
from kinlab.tolerances import TOLERANCES

_FRAMES = {"jacobian": "base", "jacobian_tool": "tool", "jacobian_spatial": "spatial"}
_STATICS = {"statics": "base", "statics_tool": "tool"}
_KINEMATIC = {"fk", "planar_pose", "planar_jacobian", "jacobian_dot", "tip_speed_squared"}
_KINEMATIC |= {*_FRAMES, *_STATICS}
_WEIGHED = {"gravity_torques", "inverse_dynamics", "inverse_dynamics_loaded", "forward_dynamics"}
_WEIGHED |= {"potential_energy", "link_potential_energies", "lagrangian", "lagrangian_gradient"}
"""What depends on gravity."""

_WITHOUT_GRAVITY = ("mass_matrix", "coriolis_torques", "inverse_without_gravity")
"""What is asked of the recursion without gravity."""

_JACOBIANS = {
    "base": N_("is the base Jacobian"),
    "tool": N_("is the tool Jacobian"),
    "spatial": N_("is the spatial Jacobian"),
}
_WRENCHES = {
    "base": N_("takes the wrench in the base frame"),
    "tool": N_("takes the wrench in the tool frame"),
    "spatial": N_("takes the wrench in the spatial frame"),
}


def readings(case: Case) -> list[Confusion]:
    """Every reading for the case's quantity and robot."""
    if case.quantity.domain is not SERIAL:
        return [*_answers(case)]
    name = case.quantity.name
    found = [*table_readings(case.robot)]
    if name not in _KINEMATIC:
        found += inertia_readings(case.robot)
        if name in _WEIGHED:
            found += gravity_readings(case.robot)
    return [*found, *_arguments(case), *_engines(case), *_answers(case)]


def _arguments(case: Case) -> Iterator[Confusion]:
    have = case.arguments
    motion = [name for name in ("q", "v", "a") if name in have]
    q, v, a, w = ("q",), ("v",), ("a",), ("wrench",)
    if "q" in have:
        radians, degrees = _of_hinges(case.robot, np.pi / 180), _of_hinges(case.robot, 180 / np.pi)
        yield _argument("degrees", _("takes q in degrees"), q, radians)
        if len(motion) > 1:
            yield _argument("degrees", _("takes q and its rates in degrees"), motion, radians)
            said = _("takes the rates in degrees")
            yield _argument("degrees", said, motion[1:], radians, 1.05)
            said = _("turns the rates into degrees first")
            yield _argument("degrees", said, motion[1:], degrees, 1.2)
        yield _argument("degrees", _("turns q into degrees first"), q, degrees, 1.2)
        said = _("counts every joint the other way")
        yield _argument("turning sense", said, motion, np.negative, 1.2)
    if "q" in have and case.robot.n > 1:
        said = _("takes the joints from tool to base")
        yield _argument("joint order", said, motion, lambda x: x[:, ::-1])
        said = _("takes every angle from the base")
        yield _argument("absolute angles", said, motion, _relative, 1.2)
        said = _("adds up angles that are from the base already")
        yield _argument("absolute angles", said, motion, _absolute, 1.3)
    if "v" in have:
        said = _("leaves the velocity terms out")
        yield _argument("velocity left out", said, v, np.zeros_like, 1.1)
        said = _("has the velocity with the opposite sign")
        yield _argument("velocity sign", said, v, np.negative, 1.3)
    if "a" in have:
        said = _("leaves the acceleration terms out")
        yield _argument("acceleration left out", said, a, np.zeros_like, 1.1)
        said = _("leaves the terms in the velocities and in the accelerations out")
        yield _argument("acceleration left out", said, ("v", "a"), np.zeros_like, 0.7)
        said = _("has the acceleration with the opposite sign")
        yield _argument("acceleration sign", said, a, np.negative, 1.3)
    if "wrench" in have:
        said = _("takes the wrench that acts on the tool (passive sign)")
        yield _argument("wrench sign", said, w, np.negative)
        said = _("takes the moment first in the wrench")
        yield _argument("wrench order", said, w, lambda x: np.roll(x, 3, axis=1))
        said = _("leaves the moment of the wrench out")
        yield _argument("moment left out", said, w, lambda x: np.where(np.arange(6) < 3, x, 0), 1.2)
        said = _("leaves the force of the wrench out")
        yield _argument("force left out", said, w, lambda x: np.where(np.arange(6) < 3, 0, x), 1.3)


def _engines(case: Case) -> Iterator[Confusion]:
    name = case.quantity.name
    frames = ("base", "tool", "spatial")
    if name in _FRAMES:
        for frame in [frame for frame in frames if frame != _FRAMES[name]]:
            yield _other("frame", _(_JACOBIANS[frame]), otherwise.in_frame(frame))
        said = _("has the base's axes, but refers to the last DH frame's origin, not the tool")
        yield _other("frame", said, otherwise.without_tool, 1.4)
    if name in _STATICS:
        for frame in [frame for frame in frames if frame != _STATICS[name]]:
            yield _other("frame", _(_WRENCHES[frame]), otherwise.wrench_in(frame))
        said = _("uses the pseudo-inverse of J for its transpose")
        yield _other("inverse for transpose", said, otherwise.pseudo_inverse, 1.3)
        said = _("uses J for J^T (not transposed)")
        yield _other("transposed", said, otherwise.jacobian_itself, 1.1)
    if name in _WITHOUT_GRAVITY:
        said = _("has the gravity torques in it")
        yield _other("gravity added", said, otherwise.with_gravity_torques, 1.1)
    if name == "mass_matrix" and case.robot.n > 1:
        said = _("is M for absolute angles (each counted from the base), not for the joint angles")
        for q_too in (False, True):
            yield _other("absolute angles", said, otherwise.in_absolute_angles(q_too), 1.1)
    if name == "coriolis_matrix":
        said = _(
            "uses C_ij = ½ Σ (dM_ik/dq_j + dM_jk/dq_i) qd_k, the symmetric form, not Christoffel's"
        )
        yield _other("symmetric Coriolis", said, otherwise.split(otherwise.symmetric))
        split = "C_ij = Σ (dM_ij/dq_k - ½ dM_jk/dq_i) qd_k"
        said = _(
            "splits C v otherwise: {split} gives the same torques, but Mdot - 2C is not skew"
        ).format(split=split)
        yield _other("Coriolis split", said, otherwise.split(otherwise.unskewed))
        yield _other("Coriolis split", _("is Mdot"), otherwise.split(otherwise.mass_rate), 1.2)
        half = otherwise.split(lambda slope: 0.5 * slope)
        yield _other("Coriolis split", _("is ½ Mdot"), half, 1.2)
    if name in ("coriolis_torques", "inverse_dynamics", "inverse_dynamics_loaded"):
        said = _("uses the symmetric formula for C, not Christoffel's")
        yield _other("symmetric Coriolis", said, otherwise.torques_by(otherwise.symmetric))
        said = _("leaves the products qd_i qd_j out")
        yield _other("Coriolis terms", said, otherwise.added(-1.0, otherwise.products), 1.1)
        said = _("counts each product qd_i qd_j once, not twice")
        yield _other("Coriolis terms", said, otherwise.added(-0.5, otherwise.products), 1.1)
        said = _("leaves the squares qd_i² out")
        yield _other("centrifugal terms", said, otherwise.added(-1.0, otherwise.squares), 1.1)
        said = _("uses Mdot v for C v")
        yield _other("Mdot for C", said, otherwise.torques_by(otherwise.mass_rate), 1.2)
    if name == "kinetic_gradient":
        said = _("adds the entries up, each times its qd_i: one number for the whole vector")
        yield _other("one number", said, otherwise.summed_with_rates, 1.1)


_PLANAR = 3
"""Rows of a Jacobian in the plane: vx, vy, wz."""


def _answers(case: Case) -> Iterator[Confusion]:
    name = case.quantity.name
    shape = case.engine(case.robot, {k: v[:1] for k, v in case.arguments.items()}).shape[1:]
    if name in _FRAMES or name == "jacobian_dot":
        yield _answer("row order", _("has the angular rows first"), lambda x: np.roll(x, 3, axis=1))
    if name == "planar_jacobian" and len(shape) == 2 and shape[0] == _PLANAR:
        yield _answer("row order", _("has the angular row first"), lambda x: np.roll(x, 1, axis=1))
    if name == "fk":
        said = _("is the inverse transform (the base in the tool)")
        yield _answer("inverse", said, _inverse)
        yield _answer("rotation transposed", _("has the rotation transposed"), _rotation_transposed)
    if len(shape) == 2 and (shape[0] > 1 or shape[1] > 1):
        yield _answer("transposed", _("is transposed"), lambda x: np.swapaxes(x, 1, 2))
    yield _answer("sign", _("has the opposite sign as a whole"), np.negative)
    yield _answer("factor", _("is twice as large as a whole"), lambda x: 2.0 * x, 1.2)
    yield _answer("factor", _("is half as large as a whole"), lambda x: 0.5 * x, 1.2)
    yield _answer("degrees", _("answers in degrees"), np.rad2deg, 1.4)
    if not shape or shape == (1,):
        return
    if name.startswith("link_") or "_wrenches" in name:
        yield _answer("sum", _("adds up over the links: each entry has those before"), _absolute)
        yield _answer("sum", _("adds up over the links: each entry has those behind"), _behind)
        yield _answer("sum", _("is the share of each link alone, not the sum"), _relative)
        yield _answer("sum", _("is the share of each link alone, not the sum"), _relative_behind)
    yield from _of_entries(case)
    of_legs = isinstance(case.robot, FiveBar)
    said = _("is the other crank's") if of_legs else _("answers from tool to base")
    yield _answer("joint order", said, lambda x: x[:, ::-1], 1.2)
    if len(shape) == 2:
        said = _("has the columns from tool to base")
        yield _answer("joint order", said, lambda x: x[:, :, ::-1], 1.2)
        if shape[0] == shape[1]:
            said = _("has rows and columns from tool to base")
            yield _answer("joint order", said, lambda x: x[:, ::-1, ::-1], 1.1)
        said = N_("has columns {one} and {two} exchanged")
        for j, k in combinations(range(shape[1]), 2):
            yield _exchanged(said, "columns", j, k)
        for k in range(shape[1]):
            place: Place = (slice(None), slice(None), k)
            for factor, kind in _FACTORS:
                told = _(_COLUMN_SAID[kind]).format(number=k + 1)
                yield _scaled(factor, f"column {kind}", told, place, 1.5, f"column {k + 1}")
    what, many, of_one, said = (
        "entry",
        "entries",
        _ENTRY_SAID,
        N_("has entries {one} and {two} exchanged"),
    )
    if len(shape) == 2:
        what, many, of_one, said = (
            "row",
            "rows",
            _ROW_SAID,
            N_("has rows {one} and {two} exchanged"),
        )
    for k in range(shape[0]):
        for factor, kind in _FACTORS:
            told = _(of_one[kind]).format(number=k + 1)
            yield _scaled(factor, f"row {kind}", told, (slice(None), k), 1.4, f"{what} {k + 1}")
        for j in range(k):
            yield _exchanged(said, many, j, k)


def _of_entries(case: Case) -> Iterator[Confusion]:
    """Where one entry of a matrix is off, or it and its mirror image: what may stand there."""
    engine = np.asarray(case.answer(()), dtype=float)
    if case.index or engine.ndim != 3 or engine.shape != case.hand.shape:
        return
    gap = np.max(np.abs(case.hand - engine), axis=0) / (np.max(np.abs(engine)) or 1.0)
    places = [tuple(place) for place in np.argwhere(~(gap <= TOLERANCES.formula_agrees)).tolist()]
    if not places or len(places) > 2 or (len(places) == 2 and places[0] != places[1][::-1]):
        return
    entry = together(f"({i + 1}, {j + 1})" for i, j in places)
    place: Place = (slice(None), [i for i, _j in places], [j for _i, j in places])
    for factor, kind in _FACTORS:
        told = _(_ENTRY_SAID[kind]).format(number=entry)
        yield _scaled(factor, f"row {kind}", told, place, 1.05, f"entry {entry}")
    for i, j in np.ndindex(*engine.shape[1:]):
        size = float(np.max(np.abs(engine[:, i, j])))
        if (i, j) not in places and size > TOLERANCES.no_effect * float(np.max(np.abs(engine))):
            told = _("has entry {other} for entry {number}")
            told = told.format(other=f"({i + 1}, {j + 1})", number=entry)
            put = _with(place, (slice(None), [i], [j]))
            yield _answer("another quantity", told, put, 1.15, f"entry {entry}")


_FACTORS = ((-1.0, "sign"), (2.0, "twice"), (0.5, "half"), (0.0, "zero"))
_COLUMN_SAID = {
    "sign": N_("has column {number} with the opposite sign"),
    "twice": N_("has column {number} twice as large"),
    "half": N_("has column {number} half as large"),
    "zero": N_("has column {number} zero"),
}
_ROW_SAID = {
    "sign": N_("has row {number} with the opposite sign"),
    "twice": N_("has row {number} twice as large"),
    "half": N_("has row {number} half as large"),
    "zero": N_("has row {number} zero"),
}
_ENTRY_SAID = {
    "sign": N_("has entry {number} with the opposite sign"),
    "twice": N_("has entry {number} twice as large"),
    "half": N_("has entry {number} half as large"),
    "zero": N_("has entry {number} zero"),
}


Place = tuple[slice | int | list[int], ...]


def _scaled(
    factor: float, kind: str, told: str, place: Place, cost: float, where: str
) -> Confusion:
    return _answer(kind, told, _with(place, place, lambda x: factor * x), cost, where)


def _exchanged(said: str, what: str, j: int, k: int) -> Confusion:
    """Two columns, rows or entries in each other's place."""
    told = _(said).format(one=j + 1, two=k + 1)
    before: Place = (slice(None),) * (2 if what == "columns" else 1)
    change = _with((*before, [j, k]), (*before, [k, j]))
    return _answer("rows swapped", told, change, 1.5, f"{what} {j + 1} and {k + 1}")


def _with(
    place: Place, source: Place, change: Callable[[Array], Array] = np.asarray
) -> Callable[[Array], Array]:
    """An answer with something else at a place: what stands at another, changed."""

    def apply(x: Array) -> Array:
        out = x.copy()
        out[place] = change(x[source])
        return out

    return apply


_ROTATION: Place = (slice(None), slice(3), slice(3))
_rotation_transposed = _with(_ROTATION, _ROTATION, lambda x: np.swapaxes(x, 1, 2))


def _inverse(x: Array) -> Array:
    return np.asarray(np.linalg.inv(x), dtype=float)


def _argument(
    kind: str,
    sentence: str,
    names: Sequence[str],
    change: Callable[[Array], Array],
    cost: float = 1.0,
) -> Confusion:
    def apply(arguments: Arguments) -> Arguments:
        return {k: change(v) if k in names else v for k, v in arguments.items()}

    return Confusion(kind, sentence, "arguments", apply, cost)


def _other(kind: str, sentence: str, asked: otherwise.Asked, cost: float = 1.0) -> Confusion:
    return Confusion(kind, sentence, "engine", lambda engine: partial(asked, engine), cost)


def _answer(
    kind: str, sentence: str, apply: Callable[[Array], Array], cost: float = 1.0, place: str = ""
) -> Confusion:
    return Confusion(kind, sentence, "answer", apply, cost, place)


def _of_hinges(robot: Robot, factor: float) -> Callable[[Array], Array]:
    """The angles in other units; a slide's way stays in metres."""
    links = robot.table.links if robot.table is not None else ()
    slides = [link.joint == "prismatic" for link in links]
    factors = np.where(slides, 1.0, factor) if slides else factor
    return lambda x: x * factors


def _relative(x: Array) -> Array:
    steps: Array = np.diff(x, axis=1, prepend=0.0)
    return steps


def _relative_behind(x: Array) -> Array:
    return -np.diff(x, axis=1, append=0.0)


def _absolute(x: Array) -> Array:
    total: Array = np.cumsum(x, axis=1)
    return total


def _behind(x: Array) -> Array:
    return _absolute(x[:, ::-1])[:, ::-1]
