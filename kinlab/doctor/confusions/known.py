"""The table of known confusions: every reading that makes sense for a quantity."""

from __future__ import annotations

from collections.abc import Callable, Iterator
from itertools import combinations
from typing import Any

import numpy as np

from kinlab.arrays import Array
from kinlab.check.quantities.serial import SERIAL
from kinlab.doctor.changes import Arguments, Case, Confusion, Engine
from kinlab.doctor.confusions import otherwise
from kinlab.doctor.confusions.robots import gravity_readings, inertia_readings, table_readings
from kinlab.doctor.derivations.words import together
from kinlab.host.language import N_, _
from kinlab.model.robot import Robot
from kinlab.tolerances import TOLERANCES

_FRAMES = {"jacobian": "base", "jacobian_tool": "tool", "jacobian_spatial": "spatial"}
_STATICS = {"statics": "base", "statics_tool": "tool"}
_KINEMATIC = {
    "fk",
    "planar_pose",
    "planar_jacobian",
    "jacobian_dot",
    "tip_speed_squared",
    *_FRAMES,
    *_STATICS,
}
_WEIGHED = {
    "gravity_torques",
    "inverse_dynamics",
    "inverse_dynamics_loaded",
    "potential_energy",
    "forward_dynamics",
    "lagrangian",
    "lagrangian_gradient",
    "link_potential_energies",
}
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
    if "q" in have:
        radians, degrees = _of_hinges(case.robot, np.pi / 180), _of_hinges(case.robot, 180 / np.pi)
        yield _argument("degrees", _("takes q in degrees"), ("q",), radians)
        if len(motion) > 1:
            yield _argument("degrees", _("takes q and its rates in degrees"), motion, radians)
            said = _("takes the rates in degrees")
            yield _argument("degrees", said, motion[1:], radians, 1.05)
            said = _("turns the rates into degrees first")
            yield _argument("degrees", said, motion[1:], degrees, 1.2)
        yield _argument("degrees", _("turns q into degrees first"), ("q",), degrees, 1.2)
        yield _argument(
            "turning sense", _("counts every joint the other way"), motion, np.negative, 1.2
        )
        if case.robot.n > 1:
            yield _argument(
                "joint order", _("takes the joints from tool to base"), motion, _backwards
            )
            yield _argument(
                "absolute angles", _("takes every angle from the base"), motion, _relative, 1.2
            )
            yield _argument(
                "absolute angles",
                _("adds up angles that are from the base already"),
                motion,
                _absolute,
                1.3,
            )
    for name, words, left_out, turned in (
        (
            "v",
            "velocity",
            _("leaves the velocity terms out"),
            _("has the velocity with the opposite sign"),
        ),
        (
            "a",
            "acceleration",
            _("leaves the acceleration terms out"),
            _("has the acceleration with the opposite sign"),
        ),
    ):
        if name in have:
            yield _argument(f"{words} left out", left_out, (name,), np.zeros_like, 1.1)
            yield _argument(
                f"{words} sign",
                turned,
                (name,),
                np.negative,
                1.3,
            )
    if "wrench" in have:
        yield _argument(
            "wrench sign",
            _("takes the wrench that acts on the tool (passive sign)"),
            ("wrench",),
            np.negative,
        )
        yield _argument(
            "wrench order", _("takes the moment first in the wrench"), ("wrench",), _halves
        )
        yield _argument(
            "moment left out", _("leaves the moment of the wrench out"), ("wrench",), _force, 1.2
        )
        yield _argument(
            "force left out", _("leaves the force of the wrench out"), ("wrench",), _moment, 1.3
        )


def _engines(case: Case) -> Iterator[Confusion]:
    name = case.quantity.name
    if name in _FRAMES:
        for frame in ("base", "tool", "spatial"):
            if frame != _FRAMES[name]:
                yield _other("frame", _(_JACOBIANS[frame]), otherwise.in_frame(frame))
        yield _other(
            "frame",
            _("has the base's axes, but refers to the last DH frame's origin, not the tool"),
            otherwise.without_tool,
            1.4,
        )
    if name in _STATICS:
        for frame in ("base", "tool", "spatial"):
            if frame != _STATICS[name]:
                yield _other("frame", _(_WRENCHES[frame]), otherwise.wrench_in(frame))
        yield _other(
            "inverse for transpose",
            _("uses the pseudo-inverse of J for its transpose"),
            otherwise.pseudo_inverse,
            1.3,
        )
        yield _other(
            "transposed", _("uses J for J^T (not transposed)"), otherwise.jacobian_itself, 1.1
        )
    if name in _WITHOUT_GRAVITY:
        said = _("has the gravity torques in it")
        yield _other("gravity added", said, otherwise.with_gravity_torques, 1.1)
    if name == "mass_matrix" and case.robot.n > 1:
        said = _("is M for absolute angles (each counted from the base), not for the joint angles")
        for q_too in (False, True):
            yield _other("absolute angles", said, otherwise.in_absolute_angles(q_too), 1.1)
    if name == "coriolis_matrix":
        yield _other(
            "symmetric Coriolis",
            _(
                "uses C_ij = ½ Σ (dM_ik/dq_j + dM_jk/dq_i) qd_k, the symmetric form, not "
                "Christoffel's"
            ),
            otherwise.symmetric,
        )
        split = "C_ij = Σ (dM_ij/dq_k - ½ dM_jk/dq_i) qd_k"
        said = _(
            "splits C v otherwise: {split} gives the same torques, but Mdot - 2C is not skew"
        ).format(split=split)
        yield _other("Coriolis split", said, otherwise.unskewed)
        yield _other("Coriolis split", _("is Mdot"), otherwise.mass_rate, 1.2)
        yield _other("Coriolis split", _("is ½ Mdot"), otherwise.half_mass_rate, 1.2)
    if name in ("coriolis_torques", "inverse_dynamics", "inverse_dynamics_loaded"):
        yield _other(
            "symmetric Coriolis",
            _("uses the symmetric formula for C, not Christoffel's"),
            otherwise.added(otherwise.symmetric_extra),
        )
        yield _other(
            "Coriolis terms",
            _("leaves the products qd_i qd_j out"),
            otherwise.added(otherwise.joint_products(-1.0)),
            1.1,
        )
        yield _other(
            "Coriolis terms",
            _("counts each product qd_i qd_j once, not twice"),
            otherwise.added(otherwise.joint_products(-0.5)),
            1.1,
        )
        yield _other(
            "centrifugal terms",
            _("leaves the squares qd_i² out"),
            otherwise.added(otherwise.centrifugal(-1.0)),
            1.1,
        )
        yield _other(
            "Mdot for C", _("uses Mdot v for C v"), otherwise.added(otherwise.mass_rate_extra), 1.2
        )

    if name == "kinetic_gradient":
        said = _("adds the entries up, each times its qd_i: one number for the whole vector")
        yield _other("one number", said, otherwise.summed_with_rates, 1.1)


def _answers(case: Case) -> Iterator[Confusion]:
    name = case.quantity.name
    shape = case.engine(case.robot, {k: v[:1] for k, v in case.arguments.items()}).shape[1:]
    if name in _FRAMES or name == "jacobian_dot":
        yield _answer("row order", _("has the angular rows first"), lambda x: np.roll(x, 3, axis=1))
    if name == "fk":
        yield _answer("inverse", _("is the inverse transform (the base in the tool)"), _inverse)
        yield _answer("rotation transposed", _("has the rotation transposed"), _rotation_transposed)
    if len(shape) == 2 and (shape[0] > 1 or shape[1] > 1):
        yield _answer("transposed", _("is transposed"), lambda x: np.swapaxes(x, 1, 2))
    yield _answer("sign", _("has the opposite sign as a whole"), np.negative)
    yield _answer("factor", _("is twice as large as a whole"), _scaled(2.0), 1.2)
    yield _answer("factor", _("is half as large as a whole"), _scaled(0.5), 1.2)
    yield _answer("degrees", _("answers in degrees"), np.rad2deg, 1.4)
    if not shape or shape == (1,):
        return
    if name.startswith("link_") or "_wrenches" in name:
        yield _answer("sum", _("adds up over the links: each entry has those before"), _absolute)
        yield _answer("sum", _("adds up over the links: each entry has those behind"), _behind)
        yield _answer("sum", _("is the share of each link alone, not the sum"), _relative)
        yield _answer("sum", _("is the share of each link alone, not the sum"), _relative_behind)
    yield from _of_entries(case)
    rows = len(shape) == 2
    yield _answer("joint order", _("answers from tool to base"), lambda x: x[:, ::-1], 1.2)
    if len(shape) == 2:
        yield _answer(
            "joint order", _("has the columns from tool to base"), lambda x: x[:, :, ::-1], 1.2
        )
        if shape[0] == shape[1]:
            yield _answer(
                "joint order",
                _("has rows and columns from tool to base"),
                lambda x: x[:, ::-1, ::-1],
                1.1,
            )
        for j, k in combinations(range(shape[1]), 2):
            yield _answer(
                "rows swapped",
                _("has columns {one} and {two} exchanged").format(one=j + 1, two=k + 1),
                _columns_swapped(j, k),
                1.5,
                f"columns {j + 1} and {k + 1}",
            )
        for k in range(shape[1]):
            for factor, said in _FACTORS:
                yield _answer(
                    f"column {said}",
                    _(_COLUMN_SAID[said]).format(number=k + 1),
                    _scaled_at(factor, (slice(None), slice(None), k)),
                    1.5,
                    f"column {k + 1}",
                )
    for k in range(shape[0]):
        for factor, said in _FACTORS:
            place = f"{'row' if rows else 'entry'} {k + 1}"
            told = _ROW_SAID[said] if rows else _ENTRY_SAID[said]
            yield _answer(
                f"row {said}",
                _(told).format(number=k + 1),
                _scaled_at(factor, (slice(None), k)),
                1.4,
                place,
            )
        exchanged = (
            N_("has rows {one} and {two} exchanged")
            if rows
            else N_("has entries {one} and {two} exchanged")
        )
        for j in range(k):
            yield _answer(
                "rows swapped",
                _(exchanged).format(one=j + 1, two=k + 1),
                _swapped(j, k),
                1.5,
                f"{'rows' if rows else 'entries'} {j + 1} and {k + 1}",
            )


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
    for factor, kind in _FACTORS:
        told = _(_ENTRY_SAID[kind]).format(number=entry)
        yield _answer(f"row {kind}", told, _scaled_places(factor, places), 1.05, f"entry {entry}")
    for i, j in np.ndindex(*engine.shape[1:]):
        size = float(np.max(np.abs(engine[:, i, j])))
        if (i, j) not in places and size > TOLERANCES.no_effect * float(np.max(np.abs(engine))):
            told = _("has entry {other} for entry {number}")
            told = told.format(other=f"({i + 1}, {j + 1})", number=entry)
            yield _answer("another quantity", told, _put(i, j, places), 1.15, f"entry {entry}")


def _scaled_places(factor: float, places: Any) -> Callable[[Array], Array]:
    def apply(x: Array) -> Array:
        out = x.copy()
        for i, j in places:
            out[:, i, j] *= factor
        return out

    return apply


def _put(i: int, j: int, places: Any) -> Callable[[Array], Array]:
    def apply(x: Array) -> Array:
        out = x.copy()
        for k, m in places:
            out[:, k, m] = x[:, i, j]
        return out

    return apply


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


def _argument(
    kind: str, sentence: str, names: Any, change: Callable[[Array], Array], cost: float = 1.0
) -> Confusion:
    chosen = tuple(names)

    def apply(arguments: Arguments) -> Arguments:
        return {k: change(v) if k in chosen else v for k, v in arguments.items()}

    return Confusion(kind, sentence, "arguments", apply, cost)


def _other(
    kind: str, sentence: str, apply: Callable[[Engine], Engine], cost: float = 1.0
) -> Confusion:
    return Confusion(kind, sentence, "engine", apply, cost)


def _answer(
    kind: str, sentence: str, apply: Callable[[Array], Array], cost: float = 1.0, place: str = ""
) -> Confusion:
    return Confusion(kind, sentence, "answer", apply, cost, place)


def _of_hinges(robot: Robot, factor: float) -> Callable[[Array], Array]:
    """The angles in other units; a slide's way stays in metres."""
    slides = [
        link.joint == "prismatic" for link in (robot.table.links if robot.table is not None else ())
    ]
    factors = np.where(slides, 1.0, factor) if slides else factor

    def change(x: Array) -> Array:
        out: Array = x * factors
        return out

    return change


def _backwards(x: Array) -> Array:
    return x[:, ::-1]


def _relative(x: Array) -> Array:
    steps: Array = np.diff(x, axis=1, prepend=0.0)
    return steps


def _relative_behind(x: Array) -> Array:
    return -np.diff(x, axis=1, append=0.0)


def _behind(x: Array) -> Array:
    return _absolute(x[:, ::-1])[:, ::-1]


def _absolute(x: Array) -> Array:
    total: Array = np.cumsum(x, axis=1)
    return total


def _halves(x: Array) -> Array:
    return np.roll(x, 3, axis=1)


def _force(x: Array) -> Array:
    kept: Array = np.where(np.arange(6) < 3, x, 0.0)
    return kept


def _moment(x: Array) -> Array:
    kept: Array = np.where(np.arange(6) >= 3, x, 0.0)
    return kept


def _inverse(x: Array) -> Array:
    return np.asarray(np.linalg.inv(x), dtype=float)


def _rotation_transposed(x: Array) -> Array:
    out = x.copy()
    out[:, :3, :3] = np.swapaxes(x[:, :3, :3], 1, 2)
    return out


def _scaled(factor: float) -> Callable[[Array], Array]:
    return lambda x: factor * x


def _scaled_at(factor: float, place: tuple[Any, ...]) -> Callable[[Array], Array]:
    def apply(x: Array) -> Array:
        out = x.copy()
        out[place] *= factor
        return out

    return apply


def _columns_swapped(j: int, k: int) -> Callable[[Array], Array]:
    rows = _swapped(j, k)
    return lambda x: np.swapaxes(rows(np.swapaxes(x, 1, 2)), 1, 2)


def _swapped(j: int, k: int) -> Callable[[Array], Array]:
    def apply(x: Array) -> Array:
        out = x.copy()
        out[:, [j, k]] = x[:, [k, j]]
        return out

    return apply
