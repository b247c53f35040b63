"""The numbers of an arm or a five-bar as the derivations ask for them."""

from __future__ import annotations

from itertools import pairwise
from typing import Any

import numpy as np

from kinlab.arrays import Array
from kinlab.check.quantities.action import DURATION, variation_with_free_ends
from kinlab.check.quantities.serial import planar_jacobian, planar_pose
from kinlab.engine.kinematics import jacobian
from kinlab.engine.lagrange import momentum
from kinlab.model.dh import link_transform
from kinlab.model.link import Convention
from kinlab.model.robot import Robot
from kinlab.notes.loop import E1, E2, H, S

Stacks = dict[str, Array]


Placed = tuple[list[Array], list[Array]]
"""Each link's transform from the one before, and frames 0 to n in the world, (N, 4, 4) each."""


def standard(robot: Robot) -> bool:
    return robot.table is not None and robot.table.convention is Convention.STANDARD


def of_table(robot: Robot, q: Array) -> dict[str, Any]:
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
    at_rest = [f[0] for f in as_placed(robot, np.zeros((1, robot.n)))[1]]
    own = [np.linalg.inv(at_rest[0]) @ f for f in at_rest]
    axes = own[:-1] if standard(robot) else own[1:]
    for k, name in ((2, "z"), (3, "o")):
        out[name] = [frame[None, :3, k] for frame in axes]
    out |= {"home": own[-1][None], "one": np.eye(3)[None]}
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


def as_placed(robot: Robot, q: Array) -> Placed:
    """The links' transforms and frames as they are."""
    found = _links(robot, q)
    base = np.eye(4) if robot.table is None else np.asarray(robot.table.base)
    frames = [np.broadcast_to(base, found[0].shape)]
    for one in found:
        frames.append(frames[-1] @ one)
    return found, frames


def _axes(robot: Robot) -> tuple[list[Array], list[bool]]:
    """Each joint's axis in its frame, and which joints slide."""
    if robot.table is not None:
        slide = [link.joint == "prismatic" for link in robot.table.links]
        return [s * np.array([0.0, 0.0, 1.0]) for s in _signs(robot)], slide
    columns = [_axis(joint) for joint in list(robot.model.joints)[1:]]
    slide = [bool(np.any(column[:3])) for column in columns]
    return [x[:3] if s else x[3:] for x, s in zip(columns, slide, strict=True)], slide


def _links(robot: Robot, q: Array) -> list[Array]:
    """Each link's transform from the one before, (N, 4, 4)."""
    table, (axes, slide) = robot.table, _axes(robot)
    found = []
    if table is not None:
        signs = _signs(robot)
        for k, link in enumerate(table.links):
            moved, none = signs[k] * q[:, k], 0.0 * q[:, k]
            theta, d = (none, moved) if slide[k] else (moved, none)
            convention = Convention(str(table.convention))
            one = link_transform(convention, link.a, link.alpha, link.d + d, link.theta + theta)
            found.append(one)
        return found
    for k, axis in enumerate(axes):
        move = np.zeros((len(q), 4, 4), dtype=q.dtype)
        move[:, 3, 3] = 1.0
        move[:, :3, :3] = np.eye(3)
        x = q[:, k, None]
        if slide[k]:
            move[:, :3, 3] = x * axis
        else:
            k_ = np.cross(np.eye(3), axis)
            sine, versine = np.sin(x)[..., None], (1 - np.cos(x))[..., None]
            move[:, :3, :3] = np.eye(3) + sine * k_ + versine * (k_ @ k_)
        found.append(robot.model.jointPlacements[k + 1].homogeneous @ move)
    return found


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


def of_recursion(
    robot: Robot, q: Array, x: Stacks, placed: Placed, in_base: bool
) -> dict[str, Any]:
    """What recursions from link to link ask for, in the links' axes or in the base's."""
    found, frames = placed
    axes, slide = _axes(robot)
    usual = standard(robot)
    base = frames[0][:, :3, :3]
    gravity = np.array(robot.model.gravity.linear)[None]
    turns, places = [f[:, :3, :3] for f in found], [f[:, :3, 3] for f in found]
    if in_base:
        at = frames[:-1] if usual else frames[1:]
        z = [np.einsum("nij,j->ni", f[:, :3, :3], k) for f, k in zip(at, axes, strict=True)]
        places = [b[:, :3, 3] - a[:, :3, 3] for a, b in pairwise(frames)]
    else:
        gravity = np.einsum("nji,nj->ni", base, np.broadcast_to(gravity, (len(q), 3)))
        z = [k[None] for k in axes]
        if usual:
            places = [np.einsum("nji,nj->ni", t, p) for t, p in zip(turns, places, strict=True)]
    return {
        **_bodies(robot),
        "Ia": [np.full(1, r) for r in robot.model.armature.tolist()],
        "rotors": robot.model.armature[None],
        "number": np.zeros(1),
        "zero": np.zeros((1, 3)),
        "nil": np.zeros((1, 3, 3)),
        "one": np.eye(3)[None],
        "end": np.zeros((1, 3)),
        "g": gravity,
        "qd": list(x["v"].T),
        "qdd": list(x["a"].T),
        "hinge": [not s for s in slide],
        "z": z,
        "R": turns,
        "P": places,
        "R_": {k: f[:, :3, :3] for k, f in enumerate(frames)},
        "o_": {k: f[:, :3, 3] for k, f in enumerate(frames)},
        "o": {k: f[:, :3, 3] for k, f in enumerate(frames[:-1] if usual else frames[1:], 1)},
    }


def _tool(robot: Robot) -> Array:
    """The tool in the last frame, (4, 4)."""
    if robot.table is not None:
        return np.asarray(robot.table.tool)
    placed: Array = robot.model.frames[robot.tool].placement.homogeneous
    return placed


def of_load(robot: Robot, x: Stacks, placed: Placed) -> dict[str, Any]:
    """The tool in the last link and in the base, and a wrench at it."""
    end, last = _tool(robot), placed[1][-1][:, :3, :3]
    wrench = x.get("wrench", np.zeros((1, 6)))
    return {
        "fw": wrench[:, :3],
        "nw": wrench[:, 3:],
        "Rn": last,
        "Rt": end[None, :3, :3],
        "e": end[None, :3, 3],
        "arm": np.einsum("nij,j->ni", last, end[:3, 3]),
    }


def of_arm(robot: Robot, q: Array, x: Stacks, placed: Placed) -> dict[str, Any]:
    """What the Jacobian's columns and the mass matrix ask for, in base axes."""
    n, frames = robot.n, placed[1]
    axes, slide = _axes(robot)
    at = frames[:-1] if standard(robot) else frames[1:]
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
        "nil": np.zeros((1, 3, 3)),
        "one": np.eye(3)[None],
        "g": np.array(robot.model.gravity.linear)[None],
        "hinge": [not s for s in slide],
        "z": z,
        "o": o,
        **{
            f"{name}_": {k: f[:, :3, c] for k, f in enumerate(at, 1)} for c, name in enumerate("xy")
        },
        "last": frames[-1][:, :3, 3],
        "Rn": frames[-1][:, :3, :3],
        "tool": _tool(robot)[None, :3, 3],
        "q": q,
        "Jt": jacobian(robot, np.real(q)),
        "both": both,
        "carried": carried,
        "o_": {k: f[:, :3, 3] for k, f in enumerate(frames)},
        "R_": {k: f[:, :3, :3] for k, f in enumerate(frames)},
        **{name: x[name] for name in ("v", "a", "tau", "wrench") if name in x},
        **({"qd": list(x["v"].T)} if "v" in x else {}),
    }


def of_step(robot: Robot, q: Array, x: Stacks) -> dict[str, Any]:
    """What iterative inverse kinematics asks for."""
    rest: dict[str, Any] = {name: x[name] for name in ("target", "twist") if name in x}
    if "twist" in x:
        return {**rest, "J": jacobian(robot, q)}
    if "target" not in x:
        return {"J": jacobian(robot, q)[:, :2]}
    pose = planar_pose(robot, q)
    here = np.stack([pose[:, 0], pose[:, 1], np.sum(q, axis=1)], axis=1)
    return {**rest, "q": q, "x": here, "J": planar_jacobian(robot, q)}


def of_lengths(robot: Robot, q: Array, x: Stacks) -> dict[str, Any]:
    """The lengths of a planar 2R arm, by its Jacobian's columns."""
    del x
    one, two = jacobian(robot, 0.0 * q)[:, :2].transpose(2, 0, 1)
    return {"l1": np.linalg.norm(one - two, axis=1), "l2": np.linalg.norm(two, axis=1)}


def of_path(robot: Robot, q: Array, x: Stacks) -> dict[str, Any]:
    """dL/dqd and dq at both ends of a path; what is left of the variation is the integral's."""
    v, a, dq = x["v"], x["a"], x["dq"]
    early = momentum(robot, q, v)
    late = momentum(robot, q + v * DURATION + 0.5 * a * DURATION**2, v + a * DURATION)
    whole = variation_with_free_ends(robot, q, v, a, dq)
    inner = whole - np.sum(late * 3.0 * dq, axis=1) + np.sum(early * dq, axis=1)
    return {"inner": inner, "late": late, "early": early, "later": 3.0 * dq, "earlier": dq}


def of_loop(mechanism: Any, loop: Any, x: Stacks) -> dict[str, Any]:
    def each(values: Any) -> list[Array]:
        return [np.full(1, float(value)) for value in np.broadcast_to(values, 2)]

    r = x["xy"]
    out: dict[str, Any] = {
        "e": np.full(1, loop.e),
        "m": np.full(1, loop.payload),
        "g": np.full(1, loop.g),
        "l1": each(loop.l1),
        "l2": each(loop.l2),
        "s": each(S),
        "Iz": each(loop.crank_inertia),
        "mc": each(loop.crank),
        "md": each(loop.rod),
        "cd": each(loop.rod_com),
        "Id": each(loop.rod_inertia),
        "legs": np.ones((1, 2)),
        "cc": each(loop.crank_com),
        "Im": each(mechanism.rotor_inertia),
        "j": each(mechanism.gear_ratio),
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
