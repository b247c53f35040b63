"""The numbers of an arm or a five-bar as the derivations ask for them, and which derivation gives
what.
"""

from __future__ import annotations

from collections.abc import Callable, Iterator
from dataclasses import dataclass
from itertools import pairwise
from typing import Any

import numpy as np

from kinlab.arrays import Array
from kinlab.check.quantities.action import DURATION, variation_with_free_ends
from kinlab.check.quantities.fivebar import FIVEBAR
from kinlab.check.quantities.fivebar import numbers as numbers_of_loop
from kinlab.check.quantities.serial import SERIAL, planar_jacobian, planar_pose
from kinlab.doctor.changes import Case
from kinlab.doctor.confusions import books
from kinlab.doctor.confusions.walk import Program, Step, Walk, program
from kinlab.engine.kinematics import jacobian
from kinlab.engine.lagrange import momentum
from kinlab.model.dh import link_transform
from kinlab.model.link import Convention
from kinlab.model.robot import Robot
from kinlab.notes.loop import E1, E2, H, S

_MOST_JOINTS = 7
_SMALL = 3
"""Joints up to which two steps are tried where M is differentiated."""

Ways = list[tuple[Step, ...]]
Stacks = dict[str, Array]


@dataclass(frozen=True, eq=False)
class Road:
    """One derivation of a case's quantity.

    Attributes:
        of: the derivation.
        walked: from ways and the case's arguments to the quantity, (B, N, ...), and the walk.
        n: joints, or legs.
        pairs: whether two steps are tried.
    """

    of: Program
    walked: Callable[[Ways, Stacks], tuple[Array, Walk]]
    n: int
    pairs: bool = True


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
    standard = _standard(robot)
    if robot.table is not None and name in _PRODUCTS:
        yield _road(case, books.product_of_links(standard), _PRODUCTS[name], _of_table)
        if name == "fk":
            yield _road(case, books.product_of_elements(standard), "pose", _of_table)
    frame = _FRAMES.get(name)
    if frame is not None:
        text = books.COLUMNS + books.TWISTED[frame]
        if name.startswith("statics"):
            yield _road(case, text + books.STATICS, "tau", _of_arm)
            for in_base in (False, True):
                yield _passed_on(case, in_base)
        else:
            rows = [0, 1, 5] if name == "planar_jacobian" else None
            yield _road(case, text, "Jb", _of_arm, rows)
    if name in books.ITERATIVE:
        yield _road(case, f"# the step\nE = {books.ITERATIVE[name]}", "E", _of_step)
    if name == "action_variation_free_ends":
        yield _road(case, books.BOUNDARY, "E", _of_path)
    if name == "isotropy_defect":
        yield _road(case, books.ISOTROPY, "E", _of_step)
    if name == "isotropy_conditions":
        yield _road(case, books.CONDITIONS, "E", _of_step)
    if name in books.ISOTROPIC:
        text = f"# the cosine of theta2\nE = {books.ISOTROPIC[name]}"
        yield _road(case, text, "E", _of_lengths)
    if name == "jacobian_dot":
        yield _road(case, books.COLUMNS + books.RATE, "E", _of_arm)
    ways = [*_recursions(case), *_lagrange(case)]
    # torques by the recursion first; their parts as people derive them alone
    yield from ways if name.startswith("inverse") else reversed(ways)
    if name in _OUTWARD and not standard:
        yield _newton_euler(case, _OUTWARD[name], False, "asked")
    if name in _WITHIN:
        asked, rest = _WITHIN[name]
        yield _newton_euler(case, books.newton_euler(standard, False) + rest, False, asked)


def _recursions(case: Case) -> Iterator[Road]:
    """Newton-Euler in base axes, and in the links'."""
    if case.quantity.name in _RECURSIVE:
        standard = _standard(case.robot)
        for in_base in (False, True):
            yield _newton_euler(case, books.newton_euler(standard, in_base), in_base)
        if standard and case.quantity.name == "inverse_dynamics":
            yield _newton_euler(case, books.SPONG, False)


def _lagrange(case: Case) -> Iterator[Road]:
    """What follows from the mass matrix by the links' Jacobians."""
    if case.quantity.name in books.LAGRANGE:
        asked, rest = books.LAGRANGE[case.quantity.name]
        pairs = "slope" not in rest or case.robot.n <= _SMALL
        yield _road(case, books.MASSES + rest, asked, _of_arm, pairs=pairs)


_PRODUCTS = {"fk": "pose", "link_transforms": "A", "dh_poses": "T"}
_OUTWARD = {"link_velocities": books.VELOCITIES, "link_accelerations": books.ACCELERATIONS}
_WITHIN = {
    "com_accelerations": ("dvc", ""),
    "inertial_wrenches": ("asked", books.WRENCHES),
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
)


def _standard(robot: Robot) -> bool:
    return robot.table is not None and robot.table.convention is Convention.STANDARD


Numbers = Callable[[Robot, Array, Stacks], dict[str, Any]]


def _road(
    case: Case, text: str, asked: str, give: Numbers, rows: Any = None, pairs: bool = True
) -> Road:
    of, robot = program(text), case.robot

    def walked(ways: Ways, x: Stacks) -> tuple[Array, Walk]:
        walk = Walk(of, lambda q: give(robot, q, x), x["q"], ways, robot.n)
        values = walk.values(asked)
        return (values if rows is None else values[:, :, rows]), walk

    return Road(of, walked, robot.n, pairs)


def _newton_euler(case: Case, text: str, in_base: bool, said: str = "tau") -> Road:
    """The recursion; asked with unit accelerations for the mass matrix, at rest for gravity."""
    of, robot, name = program(text), case.robot, case.quantity.name
    heavy = name in ("inverse_dynamics", "gravity_torques")

    def walked(ways: Ways, x: Stacks) -> tuple[Array, Walk]:
        q, n = x["q"], robot.n
        asked = {"v": np.zeros_like(q), "a": np.zeros_like(q), **x}
        if name == "mass_matrix":
            units = np.tile(np.eye(n), (len(q), 1))
            asked = {"q": np.repeat(q, n, axis=0), "v": 0.0 * units, "a": units}

        def give(q_: Array) -> dict[str, Any]:
            found = _of_recursion(robot, q_, asked, in_base)
            return found if heavy else {**found, "g": 0.0 * found["g"]}

        walk = Walk(of, give, asked["q"], ways, n)
        values = walk.values(said)
        if name == "mass_matrix":
            values = np.swapaxes(values.reshape(len(ways), len(q), n, n), 2, 3)
        return values, walk

    return Road(of, walked, robot.n)


def _passed_on(case: Case, in_base: bool) -> Road:
    """Statics from link to link."""
    robot, standard = case.robot, _standard(case.robot)
    of = program(books.passed_on(standard, in_base))
    in_tool = case.quantity.name == "statics_tool"

    def walked(ways: Ways, x: Stacks) -> tuple[Array, Walk]:
        still = {**x, "v": 0.0 * x["q"], "a": 0.0 * x["q"]}

        def give(q: Array) -> dict[str, Any]:
            found = _of_recursion(robot, q, still, in_base)
            frames = _frames(robot, _links(robot, q)[0])
            last, tool = frames[-1][:, :3, :3], _tool(robot)
            turn = last @ tool[:3, :3]
            parts = [x["wrench"][:, :3], x["wrench"][:, 3:]]
            if in_tool and in_base:
                parts = [np.einsum("nij,nj->ni", turn, y) for y in parts]
            elif not in_tool and not in_base:
                parts = [np.einsum("nji,nj->ni", turn, y) for y in parts]
            force, moment = parts
            arm = np.broadcast_to(tool[:3, 3], force.shape)
            arm = np.einsum("nij,nj->ni", last, arm) if in_base else arm @ tool[:3, :3]
            moment = moment + np.cross(arm, force)  # about the last frame's origin
            return {**found, "force": force, "moment": moment, "turn": tool[None, :3, :3]}

        walk = Walk(of, give, x["q"], ways, robot.n)
        return walk.values("tau"), walk

    return Road(of, walked, robot.n)


# -------- the numbers of a serial arm


def _of_table(robot: Robot, q: Array, x: Stacks) -> dict[str, Any]:
    """The columns of the table, and the elementary transforms of its rows."""
    table = robot.table
    assert table is not None
    count, signs = len(q), _signs(robot)
    slide = [link.joint == "prismatic" for link in table.links]
    out: dict[str, Any] = {
        "base": np.asarray(table.base)[None],
        "tool": np.asarray(table.tool)[None],
        "q": [s * column for s, column in zip(signs, q.T, strict=True)],
        "hinge": [not s for s in slide],
    }
    for column in ("theta", "d", "a", "alpha"):
        out[column] = [np.full(1, float(getattr(link, column))) for link in table.links]
    rows = {name: [] for name in ("Rz", "Tz", "Tx", "Rx")}  # type: ignore[var-annotated]
    for k, link in enumerate(table.links):
        moved = out["q"][k]
        theta = link.theta + (0.0 * moved if slide[k] else moved)
        d = link.d + (moved if slide[k] else 0.0 * moved)
        zero = np.zeros(count, dtype=q.dtype)
        for name, a, alpha, move, turn in (
            ("Rz", 0.0, 0.0, zero, theta),
            ("Tz", 0.0, 0.0, d, zero),
            ("Tx", link.a, 0.0, zero, zero),
            ("Rx", 0.0, link.alpha, zero, zero),
        ):
            rows[name].append(link_transform(Convention.STANDARD, a, alpha, move, turn))
    return {**out, **rows}


def _signs(robot: Robot) -> list[float]:
    if robot.table is None:
        return [1.0] * robot.n
    return [-1.0 if link.flip else 1.0 for link in robot.table.links]


def _axis(joint: Any) -> Array:
    """A joint's motion in its own frame, (6,): along its axis, then about it."""
    column: Array = np.asarray(joint.createData().S).reshape(6, -1)[:, 0]
    return column


def _links(robot: Robot, q: Array) -> tuple[list[Array], list[Array], list[bool]]:
    """Each link's transform from the one before, (N, 4, 4), its joint's axis, and which slide."""
    table = robot.table
    if table is not None:
        slide = [link.joint == "prismatic" for link in table.links]
        signs = _signs(robot)
        found = []
        for k, link in enumerate(table.links):
            moved, none = signs[k] * q[:, k], 0.0 * q[:, k]
            theta, d = (none, moved) if slide[k] else (moved, none)
            found.append(
                link_transform(
                    Convention(str(table.convention)),
                    link.a,
                    link.alpha,
                    link.d + d,
                    link.theta + theta,
                )
            )
        return found, [s * np.array([0.0, 0.0, 1.0]) for s in signs], slide
    found, axes, slide = [], [], []
    for k in range(robot.n):
        column = _axis(robot.model.joints[k + 1])
        slides = bool(np.any(column[:3]))
        axis = column[:3] if slides else column[3:]
        move = np.zeros((len(q), 4, 4), dtype=q.dtype)
        move[:, 3, 3] = 1.0
        move[:, :3, :3] = np.eye(3)
        x = q[:, k, None]
        if slides:
            move[:, :3, 3] = x * axis
        else:
            k_ = np.cross(np.eye(3), axis)
            sine, versine = np.sin(x)[..., None], (1 - np.cos(x))[..., None]
            move[:, :3, :3] = np.eye(3) + sine * -k_ + versine * (k_ @ k_)
        found.append(robot.model.jointPlacements[k + 1].homogeneous @ move)
        axes.append(axis)
        slide.append(slides)
    return found, axes, slide


def _bodies(robot: Robot) -> dict[str, Any]:
    """Masses, centres and tensors in link axes, and rotors."""
    if robot.table is not None:
        rows = [(x.mass, np.array(x.com), np.array(x.inertia)) for x in robot.table.links]
    else:
        rows = [(x.mass, x.lever, x.inertia) for x in list(robot.model.inertias)[1:]]
    return {
        "m": [np.full(1, mass) for mass, _, _ in rows],
        "c": [com[None] for _, com, _ in rows],
        "I": [tensor[None] for _, _, tensor in rows],
    }


def _of_recursion(robot: Robot, q: Array, x: Stacks, in_base: bool) -> dict[str, Any]:
    """What Newton-Euler asks for, in the links' axes or in the base's."""
    found, axes, slide = _links(robot, q)
    frames = _frames(robot, found)
    standard = _standard(robot)
    base = frames[0][:, :3, :3]
    gravity = np.array(robot.model.gravity.linear)[None]
    turns, places = [f[:, :3, :3] for f in found], [f[:, :3, 3] for f in found]
    if in_base:
        at = frames[:-1] if standard else frames[1:]
        z = [np.einsum("nij,j->ni", f[:, :3, :3], k) for f, k in zip(at, axes, strict=True)]
        places = [b[:, :3, 3] - a[:, :3, 3] for a, b in pairwise(frames)]
    else:
        gravity = np.einsum("nji,nj->ni", base, np.broadcast_to(gravity, (len(q), 3)))
        z = [k[None] for k in axes]
        if standard:
            places = [np.einsum("nji,nj->ni", t, p) for t, p in zip(turns, places, strict=True)]
    return {
        **_bodies(robot),
        "Ia": [np.full(1, r) for r in robot.model.armature.tolist()],
        "zero": np.zeros((1, 3)),
        "one": np.eye(3)[None],
        "end": np.zeros((1, 3)),
        "g": gravity,
        "qd": list(x["v"].T),
        "qdd": list(x["a"].T),
        "hinge": [not s for s in slide],
        "z": z,
        "R": turns,
        "P": places,
        "R_": [f[:, :3, :3] for f in frames[1:]],
    }


def _frames(robot: Robot, found: list[Array]) -> list[Array]:
    """Frames 0 to n in the world."""
    base = np.eye(4) if robot.table is None else np.asarray(robot.table.base)
    frames = [np.broadcast_to(base, found[0].shape)]
    for one in found:
        frames.append(frames[-1] @ one)
    return frames


def _tool(robot: Robot) -> Array:
    """The tool in the last frame, (4, 4)."""
    if robot.table is not None:
        return np.asarray(robot.table.tool)
    placed: Array = robot.model.frames[robot.tool].placement.homogeneous
    return placed


def _of_arm(robot: Robot, q: Array, x: Stacks) -> dict[str, Any]:
    """What the Jacobian's columns and the mass matrix ask for, in base axes."""
    n = robot.n
    found, axes, slide = _links(robot, q)
    frames = _frames(robot, found)
    at = frames[:-1] if _standard(robot) else frames[1:]
    z = {k: np.einsum("nij,j->ni", f[:, :3, :3], axes[k - 1]) for k, f in enumerate(at, 1)}
    o = {k: f[:, :3, 3] for k, f in enumerate(at, 1)}
    # the neighbours of the first and of the last joint, as the textbooks' frames have them
    for k, frame in ((0, frames[0]), (n + 1, frames[-1])):
        z[k], o[k] = frame[:, :3, 2], frame[:, :3, 3]
    pose = frames[-1] @ _tool(robot)
    turn, p = pose[:, :3, :3], pose[:, :3, 3]
    both, carried = np.zeros((len(q), 6, 6), q.dtype), np.zeros((len(q), 6, 6), q.dtype)
    both[:, :3, :3] = both[:, 3:, 3:] = turn
    carried[:] = np.eye(6)
    carried[:, :3, 3:] = np.cross(p[:, None, :], np.eye(3)).swapaxes(1, 2)
    return {
        **_bodies(robot),
        "Ia": robot.model.armature[None],
        "zero": np.zeros((1, 3)),
        "number": np.zeros(1),
        "zeros": np.zeros((1, n)),
        "nothing": np.zeros((1, n, n)),
        "g": np.array(robot.model.gravity.linear)[None],
        "hinge": [not s for s in slide],
        "z": z,
        "o": o,
        "last": frames[-1][:, :3, 3],
        "tool": p - frames[-1][:, :3, 3],
        "q": q,
        "Jt": jacobian(robot, np.real(q)),
        "both": both,
        "carried": carried,
        "o_": {k: f[:, :3, 3] for k, f in enumerate(frames)},
        "R_": {k: f[:, :3, :3] for k, f in enumerate(frames)},
        **{name: x[name] for name in ("v", "a", "tau", "wrench") if name in x},
    }


def _of_step(robot: Robot, q: Array, x: Stacks) -> dict[str, Any]:
    """What iterative inverse kinematics asks for."""
    rest: dict[str, Any] = {name: x[name] for name in ("target", "twist") if name in x}
    if "twist" in x:
        return {**rest, "J": jacobian(robot, q)}
    if "target" not in x:
        return {"J": jacobian(robot, q)[:, :2]}
    pose = planar_pose(robot, q)
    here = np.stack([pose[:, 0], pose[:, 1], np.sum(q, axis=1)], axis=1)
    return {**rest, "q": q, "x": here, "J": planar_jacobian(robot, q)}


def _of_lengths(robot: Robot, q: Array, x: Stacks) -> dict[str, Any]:
    """The lengths of a planar 2R arm, by its Jacobian's columns."""
    del x
    one, two = jacobian(robot, 0.0 * q)[:, :2].transpose(2, 0, 1)
    return {"l1": np.linalg.norm(one - two, axis=1), "l2": np.linalg.norm(two, axis=1)}


def _of_path(robot: Robot, q: Array, x: Stacks) -> dict[str, Any]:
    """dL/dqd and dq at both ends of a path; what is left of the variation is the integral's."""
    v, a, dq = x["v"], x["a"], x["dq"]
    early = momentum(robot, q, v)
    late = momentum(robot, q + v * DURATION + 0.5 * a * DURATION**2, v + a * DURATION)
    whole = variation_with_free_ends(robot, q, v, a, dq)
    inner = whole - np.sum(late * 3.0 * dq, axis=1) + np.sum(early * dq, axis=1)
    return {"inner": inner, "late": late, "early": early, "later": 3.0 * dq, "earlier": dq}


# -------- the five-bar


def _five_bar(case: Case) -> Iterator[Road]:
    name = case.quantity.name
    asked, text = books.CLOSED.get(name, ("", ""))
    mechanism: Any = case.robot
    loop = numbers_of_loop(mechanism)

    def road(text: str, asked: str) -> Road:
        of = program(text)

        def walked(ways: Ways, x: Stacks) -> tuple[Array, Walk]:
            some = next(iter(x.values()))
            walk = Walk(of, lambda _: _of_loop(loop, x), some, ways, 2)
            return walk.values(asked), walk

        return Road(of, walked, 2, pairs=name != "fivebar_torque")

    if asked:
        yield road(text, asked)
    if name == "fivebar_projection":
        yield road(books.OTHER_SIDE, "C")


def _of_loop(loop: Any, x: Stacks) -> dict[str, Any]:
    def each(values: Any) -> list[Array]:
        return [np.full(1, float(value)) for value in values]

    r = x["xy"]
    out: dict[str, Any] = {
        "e": np.full(1, loop.e),
        "m": np.full(1, loop.payload),
        "g": np.full(1, loop.g),
        "l1": each(loop.l1),
        "l2": each(loop.l2),
        "s": each(S),
        "IA": each(loop.arm),
        "mc": each(loop.crank * loop.crank_com),
        "md": each(loop.rod),
        "cd": each(loop.rod_com),
        "Id": each(loop.rod_inertia),
        "legs": np.ones((1, 2)),
        "E1": E1[None],
        "E2": E2[None],
        "H": H[None],
        "r": r,
        "x": r[:, 0],
        "y": r[:, 1],
        **{name: x[name] for name in ("v", "a") if name in x},
    }
    for name in ("theta", "mode"):
        if name in x:
            out[name] = list(x[name].T)
    return out
