"""Which derivation gives what: a quantity's roads, each walked with any of its steps otherwise."""

from __future__ import annotations

from collections.abc import Callable, Iterator
from dataclasses import dataclass, replace
from typing import Any

import numpy as np

from kinlab.arrays import Array
from kinlab.check.quantities.fivebar import FIVEBAR
from kinlab.check.quantities.fivebar import numbers as numbers_of_loop
from kinlab.check.quantities.serial import SERIAL
from kinlab.doctor.bytecode.syntax import text_of
from kinlab.doctor.changes import Case
from kinlab.doctor.derivations.books import columns, energies, five_bar, matrices, recursions
from kinlab.doctor.derivations.givens import (
    Placed,
    Stacks,
    as_placed,
    of_arm,
    of_lengths,
    of_load,
    of_loop,
    of_path,
    of_recursion,
    of_step,
    of_table,
    standard,
)
from kinlab.doctor.derivations.walk import Program, Step, Walk, program, regular
from kinlab.model.robot import Robot

_MOST_JOINTS = 7
_SMALL = 3
"""Joints up to which two steps are tried where M is differentiated."""

Ways = list[tuple[Step, ...]]
Where = Callable[[Array], Placed]
"""From positions to the links' transforms and frames."""
Walked = Callable[[Ways, Stacks], tuple[Array, Walk]]
Asked = Callable[[Ways, Stacks, Where], tuple[Array, Walk]]


@dataclass(frozen=True, eq=False)
class Road:
    """One derivation of a case's quantity.

    Attributes:
        of: the derivation.
        walked: from ways and the case's arguments to the quantity, (B, N, ...), and the walk.
        n: joints, or legs.
        pairs: whether two steps are tried. singly: whether steps at one joint are.
        work: assignments that one way costs at one state.
        asked: the same with the links placed otherwise; None where nothing is asked of them.
    """

    of: Program
    walked: Walked
    n: int
    work: int
    pairs: bool = True
    asked: Asked | None = None
    singly: bool = True


def roads(case: Case) -> Iterator[Road]:
    """The derivations of a quantity; of a branch of a closed form its own."""
    own = getattr(case.quantity.engine, "road", None)
    if own is not None:
        yield own
        return
    name = case.quantity.name
    if case.quantity.domain is FIVEBAR:
        yield from _five_bar(case)
        return
    if case.quantity.domain is not SERIAL or "q" not in case.arguments:
        return
    robot: Robot = case.robot
    if robot.n > _MOST_JOINTS:
        return
    usual = standard(robot)
    if robot.table is not None and name in _PRODUCTS:
        yield _of_links(case, matrices.product_of_links(usual), _PRODUCTS[name])
        if name == "fk":
            yield _of_links(case, matrices.product_of_elements(usual), "pose")
            yield _of_links(case, columns.EXPONENTIALS, "pose")
    frame = _FRAMES.get(name)
    if frame is not None:
        text = columns.COLUMNS + columns.TWISTED[frame]
        if name.startswith("statics"):
            yield _of_arm(case, text + columns.STATICS, "tau")
            for in_base in (False, True):
                held = recursions.held(name == "statics_tool", in_base)
                yield _with_load(case, held + recursions.passed_on(usual, in_base), in_base, "tau")
        else:
            rows = [0, 1, 5] if name == "planar_jacobian" else None
            yield _of_arm(case, text, "Jb", rows)
            if frame == "tool":
                yield _with_load(case, columns.toolward(usual), False, "E", False)
    if name in columns.ITERATIVE:
        yield _of_step(case, f"# the step\nE = {columns.ITERATIVE[name]}")
    if name in columns.OF_COLUMNS:
        yield _of_arm(case, columns.of_columns(name), "E", pairs=False)
    if name == "action_variation_free_ends":
        yield _of_step(case, energies.BOUNDARY, of_path)
    if name == "isotropy_defect":
        yield _of_step(case, columns.ISOTROPY)
    if name == "isotropy_conditions":
        yield _of_step(case, columns.CONDITIONS)
    if name in columns.ISOTROPIC:
        text = f"# the cosine of theta2\nE = {columns.ISOTROPIC[name]}"
        yield _of_step(case, text, of_lengths)
    if name == "jacobian_dot":
        yield _of_arm(case, columns.RATES, "E")
        yield _of_arm(case, columns.COLUMNS + columns.RATE, "E")
    ways = [*_recursions(case), *_lagrange(case)]
    # torques by the recursion first; their parts as people derive them alone
    yield from ways if name.startswith("inverse") else reversed(ways)
    # of the links in their joints' frames, as the engine has them, whatever the table's are
    placed = replace(case, robot=replace(robot, table=None)) if usual else case
    if name in _OUTWARD:
        yield _recursion(placed, _OUTWARD[name], False, "asked")
    if name in ("static_wrenches", "joint_wrenches"):
        still = name == "static_wrenches"
        text = (
            recursions.passed_on(False, False) if still else recursions.newton_euler(False, False)
        )
        yield _with_load(
            placed,
            recursions.held(False, False) + recursions.loaded(text) + recursions.THROUGH,
            False,
            "asked",
        )
    if name == "inverse_dynamics_loaded":
        for in_base in (False, True):
            text = recursions.held(False, in_base) + recursions.loaded(
                recursions.newton_euler(usual, in_base)
            )
            yield _with_load(case, text, in_base, "tau")
    if name in _WITHIN:
        asked, rest = _WITHIN[name]
        yield _recursion(placed, recursions.newton_euler(False, False) + rest, False, asked)


def _recursions(case: Case) -> Iterator[Road]:
    """Newton-Euler in base axes, in the links', and with spatial vectors; composite bodies."""
    name, usual = case.quantity.name, standard(case.robot)
    if name in _RECURSIVE:
        yield _recursion(case, recursions.spatial(usual), False, pairs=False)
        for in_base in (False, True):
            yield _recursion(case, recursions.newton_euler(usual, in_base), in_base)
        if usual and name == "inverse_dynamics":
            yield _recursion(case, recursions.SPONG, False)
    if name == "mass_matrix":
        yield _recursion(case, recursions.composite(usual), False, "M", False)
        yield _of_arm(case, recursions.COMPOSITE_IN_BASE, "M", pairs=False)
    if name in recursions.ENERGIES:
        for in_base in (False, True):
            text = recursions.energies(usual, in_base)
            yield _recursion(case, text, in_base, recursions.ENERGIES[name])
        text = recursions.spatial_energies(usual)
        yield _recursion(case, text, False, recursions.ENERGIES[name], False)
    if name == "lagrangian":
        yield _recursion(case, recursions.lagrangian(usual), True, "E", False)
    if name == "momentum":
        for text, in_base in recursions.momenta(usual):
            yield _recursion(case, text, in_base, pairs=False)
    if name in _ABOUT_ORIGIN:
        yield _recursion(case, recursions.about_origin(usual), True, pairs=False)


def _lagrange(case: Case) -> Iterator[Road]:
    """What follows from the mass matrix by the links' Jacobians."""
    if case.quantity.name in energies.LAGRANGE:
        asked, rest = energies.LAGRANGE[case.quantity.name]
        pairs = "slope" not in rest or case.robot.n <= _SMALL
        yield _of_arm(case, energies.MASSES + rest, asked, pairs=pairs)


_PRODUCTS = {"fk": "pose", "link_transforms": "A", "dh_poses": "T", "link_poses": "T"}
_OUTWARD = {
    "link_velocities": recursions.VELOCITIES,
    "link_accelerations": recursions.ACCELERATIONS,
    "angular_jacobian_last": columns.ANGULAR,
}
_WITHIN = {
    "com_accelerations": ("asked", "for i in outward:\n    asked[i] = dvc[i]\n"),
    "inertial_wrenches": ("asked", recursions.WRENCHES),
}
_FRAMES = {
    "jacobian": "base",
    "jacobian_tool": "tool",
    "jacobian_spatial": "spatial",
    "planar_jacobian": "base",
    "statics": "base",
    "statics_tool": "tool",
}
_RECURSIVE = (
    "inverse_dynamics",
    "gravity_torques",
    "coriolis_torques",
    "mass_matrix",
    "inverse_without_gravity",
    "forward_dynamics",
)
_HEAVY = ("inverse_dynamics", "gravity_torques", "forward_dynamics", "lagrangian")
_ABOUT_ORIGIN = (
    "inverse_dynamics",
    "gravity_torques",
    "coriolis_torques",
    "inverse_without_gravity",
)


def _road(of: Program, asked: Asked, robot: Robot, pairs: bool = True, walks: int = 1) -> Road:
    """A derivation that asks where the links are, walked so many times for one answer."""

    def walked(ways: Ways, x: Stacks) -> tuple[Array, Walk]:
        return asked(ways, x, lambda q: as_placed(robot, q))

    slopes = any("slope(" in text_of(line.statement) for line in of.lines)
    work = walks * of.work(robot.n)
    return Road(of, walked, robot.n, work, pairs, asked, pairs or not slopes)


def _of_links(case: Case, text: str, asked: str) -> Road:
    of, robot = program(text), case.robot

    def walked(ways: Ways, x: Stacks) -> tuple[Array, Walk]:
        walk = Walk(of, lambda q: of_table(robot, q), x["q"], ways, robot.n)
        return walk.values(asked), walk

    return Road(of, walked, robot.n, of.work(robot.n))


def _of_step(case: Case, text: str, given: Any = of_step) -> Road:
    of, robot = program(text), case.robot

    def walked(ways: Ways, x: Stacks) -> tuple[Array, Walk]:
        walk = Walk(of, lambda q: given(robot, q, x), x["q"], ways, robot.n)
        return walk.values("E"), walk

    return Road(of, walked, robot.n, of.work(robot.n))


def _of_arm(case: Case, text: str, asked: str, rows: Any = None, pairs: bool = True) -> Road:
    of, robot = program(text), case.robot

    def ask(ways: Ways, x: Stacks, where: Where) -> tuple[Array, Walk]:
        step = of_step(robot, x["q"], x) if {"target", "twist"} & {*x} else {}
        given: dict[str, Any] = {
            name: step[name] for name in ("target", "twist", "x") if name in step
        }

        def give(q: Array) -> dict[str, Any]:
            return {**of_arm(robot, q, x, where(q)), **given}

        walk = Walk(of, give, x["q"], ways, robot.n)
        values = walk.values(asked)
        return (values if rows is None else values[:, :, rows]), walk

    return _road(of, ask, robot, pairs)


def _recursion(case: Case, text: str, in_base: bool, said: str = "tau", pairs: bool = True) -> Road:
    """The recursion; asked with unit accelerations for the mass matrix, at rest for gravity."""
    of, robot, name = program(text), case.robot, case.quantity.name
    heavy = name in _HEAVY
    units = name in ("mass_matrix", "forward_dynamics") and said == "tau"

    def ask(ways: Ways, x: Stacks, where: Where) -> tuple[Array, Walk]:
        q, n = x["q"], robot.n
        asked = {"v": np.zeros_like(q), "a": np.zeros_like(q), **x}
        weighed = np.full((1, 1), float(heavy))
        if units:
            # at each state the unit accelerations, then the motion without acceleration
            each = np.vstack([np.eye(n), np.zeros(n)])
            last = np.tile(each.sum(axis=1) == 0, len(q))[:, None]
            asked = {
                "q": np.repeat(q, n + 1, axis=0),
                "v": np.where(last, np.repeat(asked["v"], n + 1, axis=0), 0.0),
                "a": np.tile(each, (len(q), 1)),
            }
            weighed = weighed * last

        def give(q_: Array) -> dict[str, Any]:
            found = of_recursion(robot, q_, asked, where(q_), in_base)
            return {**found, "g": found["g"] * weighed}

        walk = Walk(of, give, asked["q"], ways, n)
        values = walk.values(said)
        if units:
            every = values.reshape(len(ways), len(q), n + 1, n)
            values = np.swapaxes(every[:, :, :n], 2, 3)
            if name == "forward_dynamics":
                values = _solved(values, x["tau"] - every[:, :, n])
        return values, walk

    return _road(of, ask, robot, pairs, robot.n + 1 if units else 1)


def _solved(matrix: Array, right: Array) -> Array:
    """The solutions of (B, N, n, n) systems; NaN where there is none."""
    some = np.asarray(np.isfinite(matrix).all(axis=(2, 3)))[..., None, None]
    safe = np.where(some, matrix, np.eye(matrix.shape[-1]))
    regular = np.asarray(np.linalg.matrix_rank(safe) == matrix.shape[-1])
    some = some & regular[..., None, None]
    safe = np.where(some, safe, np.eye(matrix.shape[-1]))
    return np.where(some[..., 0], np.linalg.solve(safe, right[..., None])[..., 0], np.nan)


def _with_load(case: Case, text: str, in_base: bool, said: str, pairs: bool = True) -> Road:
    """Forces passed on from the tool, from link to link."""
    robot = case.robot
    of = program(text)

    def ask(ways: Ways, x: Stacks, where: Where) -> tuple[Array, Walk]:
        moved = {"v": 0.0 * x["q"], "a": 0.0 * x["q"], **x}

        def give(q: Array) -> dict[str, Any]:
            placed = where(q)
            found = of_recursion(robot, q, moved, placed, in_base)
            return {**found, **of_load(robot, x, placed)}

        walk = Walk(of, give, x["q"], ways, robot.n)
        return walk.values(said), walk

    return _road(of, ask, robot, pairs)


def through_links(case: Case) -> Iterator[Road]:
    """The same with a step of the links' matrices, on which all the rest stands, otherwise."""
    robot = case.robot
    if getattr(robot, "table", None) is None:
        return
    product, turns = (
        program(text) for text in (matrices.product_of_links(standard(robot)), columns.EXPONENTIALS)
    )
    asked = [road for road in roads(case) if road.asked is not None]
    lightest = sorted(asked, key=lambda road: road.work)[:1]
    for of, some in ((product, asked), (turns, lightest)):
        for road in some:
            assert road.asked is not None
            yield Road(of, _through(of, robot, road.asked), robot.n, road.work, False)


def _through(of: Program, robot: Robot, asked: Asked) -> Walked:
    rest = np.array([f[0] for f in as_placed(robot, np.zeros((1, robot.n)))[1]])
    base = np.asarray(robot.table.base)  # type: ignore[union-attr]
    exponential = not any("A[" in text_of(line.statement) for line in of.lines)

    def walked(ways: Ways, x: Stacks) -> tuple[Array, Walk]:
        count, n = len(ways), robot.n
        walks = []

        def where(q: Array) -> Placed:
            """Every way's links as if each way were a state."""
            own = q.reshape(count, -1, n)[0]
            walk = Walk(of, lambda at: of_table(robot, at), own, ways, n)
            walks.append(walk)
            made = walk.values("T").reshape(-1, n, 4, 4)
            if exponential:
                # T moves what is at rest; links without an inverse make no sense
                made = made @ np.linalg.inv(base) @ rest[1:]
                frames = [*np.moveaxis(made, 1, 0)]
                before = regular(np.array([np.broadcast_to(base, frames[0].shape), *frames[:-1]]))
                links = [*(np.linalg.inv(before) @ np.array(frames))]
            else:
                frames = [*np.moveaxis(made, 1, 0)]
                links = [*np.moveaxis(walk.stacked("A").reshape(-1, n, 4, 4), 1, 0)]
            return links, [np.broadcast_to(base, frames[0].shape), *frames]

        tiled = {k: np.tile(y, (count, *(1,) * (y.ndim - 1))) for k, y in x.items()}
        values, _walk = asked([()], tiled, where)
        return values.reshape(count, len(x["q"]), *values.shape[2:]), walks[0]

    return walked


# -------- the five-bar


def _five_bar(case: Case) -> Iterator[Road]:
    name = case.quantity.name
    asked, text = five_bar.CLOSED.get(name, ("", ""))
    mechanism: Any = case.robot
    loop = numbers_of_loop(mechanism)

    def road(text: str, asked: str) -> Road:
        of = program(text)

        def walked(ways: Ways, x: Stacks) -> tuple[Array, Walk]:
            some = next(iter(x.values()))
            walk = Walk(of, lambda _: of_loop(mechanism, loop, x), some, ways, 2)
            return walk.values(asked), walk

        return Road(of, walked, 2, of.work(2), pairs=name != "fivebar_torque")

    if asked:
        yield road(text, asked)
    if name == "fivebar_projection":
        yield road(five_bar.OTHER_SIDE, "C")
