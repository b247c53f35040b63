"""The textbooks' vectors, matrices and numbers of an arm at one state, each with what it is.

They come from the engine, in the frames of the arm's DH table: link i moves with frame i, and the
joints lie as the table's convention has them.
"""

from __future__ import annotations

from collections.abc import Iterable
from dataclasses import dataclass, field, replace
from typing import Any

import numpy as np
from numpy.typing import ArrayLike

from kinlab.arrays import Array
from kinlab.doctor.glossary.spatial import PlacedLinks, Thing, moving, pushing, still
from kinlab.engine import dynamics, kinematics, lagrange, links
from kinlab.model.dh import DHTable
from kinlab.model.link import Convention, steiner
from kinlab.model.robot import Robot
from kinlab.tolerances import TOLERANCES


@dataclass(frozen=True)
class Sense:
    """What a value is.

    Attributes:
        what: a key of :data:`kinlab.doctor.glossary.meaning.PHRASES`.
        number: of which link, joint, frame or row, from 1 on; None where of one of several.
        frame: the axes of a vector or tensor: ``"base"``, its ``"own"`` frame's, those of the frame
            ``"before"`` or ``"next"``; empty where there is nothing to tell.
        of: what else tells it from its like: ``"q1 + q2"``, ``"1, 2"``, ``"y"``.
        form: empty, ``"minus"`` or ``"transpose"``.
    """

    what: str
    number: int | None = None
    frame: str = ""
    of: str = ""
    form: str = ""


Row = tuple[int, Sense]


@dataclass(frozen=True, eq=False)
class Glossary:
    """The things of one arm at one state, by the shape of their values.

    Attributes:
        things: for each shape the senses, each with its rank (a quantity of its own before a term
            of a sum), and their values, stacked.
        plane: whether the arm moves in the base's x and y: (2,) is then a vector, too.
    """

    things: dict[tuple[int, ...], tuple[list[Row], Array]] = field(default_factory=dict)
    plane: bool = False

    def gaps(self, value: Array) -> tuple[list[Row], Array]:
        """The senses of a value's shape, and how far each is from it: the largest difference."""
        if value.shape not in self.things:
            return [], np.empty(0)
        rows, things = self.things[value.shape]
        return rows, np.abs(things - value).reshape(len(rows), -1).max(axis=1)


def meanings(robot: Robot, arguments: dict[str, Array]) -> Glossary:
    """Every physical vector, matrix and number of the textbooks at one state.

    Args:
        robot: an arm; without a DH table nothing is known of it.
        arguments: ``q`` and, where the quantity has them, ``v``, ``a``, ``tau``, ``wrench``, one
            state each. What needs an argument that is missing is not known.
    """
    sizes = {"q": robot.n, "v": robot.n, "a": robot.n, "tau": robot.n, "wrench": 6}
    given = {name: np.asarray(x) for name, x in arguments.items() if name in sizes}
    one_state = all(x.shape == (sizes[name],) for name, x in given.items())
    if robot.table is None or "q" not in given or not one_state:
        return Glossary()
    if {"v", "tau"} <= set(given) and "a" not in given and not robot.singular_mass:
        given["a"] = dynamics.forward_dynamics(robot, given["q"], given["v"], given["tau"])
    return _Gathered(robot, given).glossary()


def without_base(robot: Any) -> Robot | None:
    """The same arm, whose base is turned or moved by a transform of its table, without that.

    None of one that has no such transform. What does not depend on it is often worked out so.
    """
    table: DHTable | None = getattr(robot, "table", None)
    if table is None or np.array_equal(table.base, np.eye(4)):
        return None
    gravity = np.asarray(table.base)[:3, :3].T @ np.asarray(table.gravity)
    return Robot.from_dh(replace(table, base=np.eye(4), gravity=gravity))


class _Gathered:
    """The things of one state while they are gathered."""

    def __init__(self, robot: Robot, given: dict[str, Array]) -> None:
        table = robot.table
        assert table is not None
        self.robot, self.table, self.given, self.n = robot, table, given, robot.n
        self.found: dict[tuple[int, ...], tuple[list[Row], list[Array]]] = {}
        self.turned: list[tuple[int, str, Array]] = []
        q = given["q"]
        self.frames = np.concatenate([np.asarray(table.base)[None], table.frames(q)])
        self.R, self.o = self.frames[1:, :3, :3], self.frames[1:, :3, 3]
        self.standard = table.convention is Convention.STANDARD
        at = self.frames[:-1] if self.standard else self.frames[1:]
        self.flips = np.array([-1.0 if link.flip else 1.0 for link in table.links])
        self.z, self.joint = at[:, :3, 2] * self.flips[:, None], at[:, :3, 3]
        self.hinge = np.array([kind == "revolute" for kind in robot.joint_kinds])
        self.plane = bool(np.all(np.abs(self.z[:, :2]) <= TOLERANCES.structure_holds))
        self.mass = np.array([link.mass for link in table.links])
        self.P = np.diff(self.frames[:, :3, 3], axis=0)
        self.c = np.einsum("nij,nj->ni", self.R, [np.asarray(x.com) for x in table.links])
        self.tensor = np.stack([np.asarray(x.inertia) for x in table.links])
        self.I = self.R @ self.tensor @ np.swapaxes(self.R, 1, 2)
        self.gravity = np.asarray(robot.model.gravity.linear)
        zero = np.zeros(self.n)
        tool = kinematics.fk(robot, q), kinematics.fk(robot, zero)
        self.bodies = PlacedLinks(
            self.frames[1:], self.frames[:-1], table.frames(zero), tool, self.z, self.joint,
            self.hinge, self.mass, self.c, self.I,
        )  # fmt: skip

    def glossary(self) -> Glossary:
        self.geometry()
        self.cells()
        self.angles()
        if "wrench" in self.given:
            self.load(self.given["wrench"])
        if "v" in self.given:
            self.motion(self.given["v"])
        if not self.robot.singular_mass:
            self.dynamics()
        self.vectors()
        self.spatial()
        things = {shape: (rows, np.stack(x)) for shape, (rows, x) in self.found.items()}
        return Glossary(things, self.plane)

    def put(
        self, what: str, value: ArrayLike, k: int | None = None, frame: str = "", of: str = "",
        rank: int = 0,
    ) -> None:  # fmt: skip
        array = np.squeeze(np.asarray(value, dtype=np.float64))
        rows, values = self.found.setdefault(array.shape, ([], []))
        rows.append((rank, Sense(what, k, frame, of)))
        values.append(array)

    def each(self, what: str, values: Iterable[ArrayLike], frame: str = "", rank: int = 0) -> None:
        """One for each link, joint or frame from 1 on."""
        for k, value in enumerate(values, 1):
            self.put(what, value, k, frame, rank=rank)

    def vector(self, rank: int, values: dict[str, Array]) -> None:
        """Vectors of the links, (n, 3) in base axes, which are told in other axes, too."""
        self.turned += [(rank, what, value) for what, value in values.items()]

    def vectors(self) -> None:
        """Lays all vectors of the links down in base axes, their own, and their neighbours'."""
        stack = np.stack([value for _, _, value in self.turned])
        for frame, turn, some in (
            ("base", np.broadcast_to(np.eye(3), self.R.shape), slice(None)),
            ("own", self.R, slice(None)),
            ("before", self.R[:-1], slice(1, None)),
            ("next", self.R[1:], slice(None, -1)),
        ):
            seen = np.einsum("nij,kni->knj", turn, stack[:, some])
            for (rank, what, _stack), values in zip(self.turned, seen, strict=True):
                for k, value in enumerate(values, 2 if frame == "before" else 1):
                    self.put(what, value, k, frame, rank=rank)

    def spatial(self) -> None:
        """Screws, twists and wrenches."""
        some: list[Thing] = [*still(self.bodies)]
        if "wrench" in self.given:
            some += pushing(self.bodies, self.given["wrench"])
        if "v" in self.given:
            some += moving(self.bodies, self.given["v"], self.given.get("a"), self.gravity)
        for rank, what, values, frame in some:
            self.each(what, values, frame, rank)

    def geometry(self) -> None:
        q, n, frames = self.given["q"], self.n, self.frames
        steps = np.linalg.inv(frames[:-1]) @ frames[1:]
        tool = self.bodies.tool[0]
        p, origins = tool[:3, 3], frames[:, :3, 3]
        self.each("T0", frames[1:])
        self.each("T", steps, rank=1)
        self.each("T0_inverse", np.linalg.inv(frames[1:]))
        self.each("T_inverse", np.linalg.inv(steps), rank=1)
        self.each("R0", self.R)
        self.each("R", steps[:, :3, :3], rank=1)
        self.put("tool_pose", tool, rank=1)
        self.put("tool_rotation", tool[:3, :3], rank=1)
        self.vector(0, {"axis": self.z})
        self.vector(1, {"lever": self.P, "own_centre": self.c})
        self.vector(2, {"joint_centre": self.c + self.P})
        for k, frame in enumerate(frames):
            self.put("z_axis", frame[:3, 2], k, rank=2)
        centres = self.o + self.c
        for what, points in (("origin", self.o), ("centre", centres)):
            self.each(what, points)
            name = "coordinate" if what == "origin" else "centre_coordinate"
            for k, point in enumerate(points, 1):
                for c, letter in enumerate("xyz"):
                    self.put(name, point[c], k, of=letter, rank=1)
        for c, letter in enumerate("xyz"):
            self.put("tool_coordinate", p[c], of=letter, rank=2)
        self.put("tool_point", p, rank=1)
        for k, origin in enumerate(origins):
            self.put("tool_lever", p - origin, k, "base", rank=3)
            for i in range(k + 2, n + 1):
                self.put("far_lever", origins[i] - origin, i, "base", str(k), rank=4)
                self.put("far_centre", centres[i - 1] - origin, i, "base", str(k), rank=4)
        J = kinematics.jacobian(self.robot, q)
        self.put("J", J, frame="base")
        self.put("J", kinematics.jacobian(self.robot, q, "tool"), frame="tool")
        self.put("Jv", J[:3])
        self.put("Jw", J[3:])
        self.each("Jv_column", J[:3].T, rank=1)
        self.each("J_column", J.T)
        for (row, column), x in np.ndenumerate(J):
            self.put("J_entry", x, of=f"{row + 1}, {column + 1}", rank=2)
        task = J[[0, 1, 5]][:n] if self.plane and n in (2, 3) else J
        if self.plane:
            self.put("J", J[[0, 1, 5]])
        if len(task) == n:
            self.put("J_inverse", np.linalg.pinv(task))
        self.Jc = links.com_jacobians(self.robot, q)
        self.each("Jvc", self.Jc[:, :3], rank=1)
        self.each("Jwc", self.Jc[:, 3:], rank=1)
        for i, columns in enumerate(self.Jc, 1):
            for j, column in enumerate(columns[:3].T[:i], 1):
                self.put("Jvc_column", column, i, of=str(j), rank=2)

    def cells(self) -> None:
        """The table's own numbers, and what does not move in the links' axes."""
        for k, link in enumerate(self.table.links, 1):
            below = k if self.standard else k - 1
            for column in ("a", "alpha", "d", "theta"):
                self.put("cell", np.array(getattr(link, column)), k, of=column)
            self.put("sine", np.sin(link.alpha), of=f"alpha{below}", rank=1)
            self.put("cosine", np.cos(link.alpha), of=f"alpha{below}", rank=1)
        self.each("mass", self.mass)
        self.put("g", np.linalg.norm(self.gravity))
        self.put("g", self.gravity, frame="base")
        self.each("g", np.einsum("nij,i->nj", self.R, self.gravity), "own")
        self.each("weight", self.mass[:, None] * self.gravity)
        centres = [np.asarray(link.com) for link in self.table.links]
        shifted = [
            t + steiner(m, c) for t, m, c in zip(self.tensor, self.mass, centres, strict=True)
        ]
        turned = self.R @ np.stack(shifted) @ np.swapaxes(self.R, 1, 2)
        for what, own, base in (
            ("inertia", self.tensor, self.I),
            ("frame_inertia", np.stack(shifted), turned),
        ):
            self.each(what, own, "own", rank=int(what != "inertia"))
            self.each(what, base, "base", rank=int(what != "inertia"))
        if self.plane:
            arms = np.linalg.norm((self.o + self.c - self.joint)[:, :2], axis=1)
            self.each("centre_distance", arms)
            self.each("Izz", self.I[:, 2, 2])
            self.each("joint_Izz", self.I[:, 2, 2] + self.mass * arms**2, rank=1)

    def angles(self) -> None:
        q = self.given["q"]
        theta = self.flips * q + [link.theta for link in self.table.links]
        self.put("positions", q)
        self.each("q", q)
        if self.plane and self.hinge.all():
            self.put("angles", np.cumsum(self.z[:, 2] * self.flips * theta), rank=1)
        turning = [int(k) for k in np.flatnonzero(self.hinge)]
        for name, values, rank in (("q", q, 0), ("theta", theta, 1)):
            for first in range(len(turning)):
                for last in range(first, len(turning)):
                    some = turning[first : last + 1]
                    told, value = " + ".join(f"{name}{k + 1}" for k in some), np.sum(values[some])
                    self.put("sine", np.sin(value), of=told, rank=rank)
                    self.put("cosine", np.cos(value), of=told, rank=rank)
                    self.put("angle", value, of=told, rank=rank + 1)

    def load(self, wrench: Array) -> None:
        self.put("load", wrench)
        self.put("load_force", wrench[:3])
        self.put("load_moment", wrench[3:])
        held = kinematics.statics(self.robot, self.given["q"], wrench)
        self.put("J^T F", held)
        self.each("tau_entry", held, rank=1)
        force, moment = (np.broadcast_to(x, (self.n, 3)) for x in (wrench[:3], wrench[3:]))
        self.vector(1, {"load_force": force, "load_moment": moment})
        if "v" not in self.given and not self.robot.singular_mass:
            self.wrenches(links.static_wrenches(self.robot, self.given["q"], wrench))

    def motion(self, v: Array) -> None:
        robot, q, z = self.robot, self.given["q"], self.z
        poses = links.link_poses(robot, q)
        turn, self.at = poses[:, :3, :3], poses[:, :3, 3]
        self.L = turn
        speed = links.link_velocities(robot, q, v)
        w, at = _turned(turn, speed[:, 3:]), _turned(turn, speed[:, :3])
        r, c, P = self.o - self.at, self.c, self.P
        bearer = w if self.standard else np.concatenate([np.zeros((1, 3)), w[:-1]])
        self.put("velocities", v)
        if self.plane and self.hinge.all():
            self.put("rates", np.cumsum(self.z[:, 2] * v), rank=1)
        self.each("qd", v)
        twist = kinematics.jacobian(robot, q) @ v
        self.put("twist", twist)
        self.put("tool_velocity", twist[:3], rank=1)
        vo = at + _x(w, r)
        self.vc = vo + _x(w, c)
        Iw = np.einsum("nij,nj->ni", self.I, w)
        self.vector(0, {"w": w, "v": vo, "vc": self.vc})
        self.vector(1, {"p": self.mass[:, None] * self.vc, "L": Iw, "w x Iw": _x(w, Iw)})
        self.vector(2, {"wP": _x(bearer, P), "wc": _x(w, c), "wwP": _x(bearer, _x(bearer, P))})
        self.vector(2, {"wwc": _x(w, _x(w, c))})
        slide = z * np.where(self.hinge, 0.0, v)[:, None]
        self.vector(2, {"Coriolis": 2.0 * _x(w, slide), "z qd": z * v[:, None]})
        self.vector(2, {"w x z qd": _x(w, z * v[:, None])})
        if self.standard:
            self.vector(3, {"wr": _x(w, c + P), "wwr": _x(w, _x(w, c + P))})
        self.each("k_linear", 0.5 * self.mass * np.sum(self.vc**2, axis=1), rank=1)
        self.each("k_rotational", 0.5 * np.sum(w * Iw, axis=1), rank=1)
        if "a" in self.given:
            self.acceleration(self.given["a"], w, bearer, Iw)

    def acceleration(self, a: Array, w: Array, bearer: Array, Iw: Array) -> None:
        robot, q, v, c, P = self.robot, self.given["q"], self.given["v"], self.c, self.P
        rate = links.link_accelerations(robot, q, v, a)
        dw, at = _turned(self.L, rate[:, 3:]), _turned(self.L, rate[:, :3])
        r = self.o - self.at
        dv = at + _x(dw, r) + _x(w, _x(w, r))
        dvc = dv + _x(dw, c) + _x(w, _x(w, c))
        carried = dw if self.standard else np.concatenate([np.zeros((1, 3)), dw[:-1]])
        Idw, m = np.einsum("nij,nj->ni", self.I, dw), self.mass[:, None]
        self.put("accelerations", a)
        self.each("qdd", a)
        F = m * (dvc - self.gravity)
        self.vector(0, {"dw": dw, "dv": dv, "dvc": dvc, "F": m * dvc, "N": Idw + _x(w, Iw)})
        self.vector(0, {"dv-g": dv - self.gravity, "dvc-g": dvc - self.gravity, "F-g": F})
        self.vector(2, {"aP": _x(carried, P), "ac": _x(dw, c), "I dw": Idw, "c x F": _x(c, F)})
        self.vector(2, {"z qdd": self.z * a[:, None]})
        if self.standard:
            self.vector(3, {"ar": _x(dw, c + P), "r x F": _x(c + P, F)})
        if not robot.singular_mass:
            load = self.given.get("wrench")
            self.wrenches(links.joint_wrenches(robot, q, v, a, load))

    def wrenches(self, seen: Array) -> None:
        """Forces and moments through the joints, moments about a point of the joint's axis."""
        poses = links.link_poses(self.robot, self.given["q"])
        f, n = (_turned(poses[:, :3, :3], x) for x in (seen[:, :3], seen[:, 3:]))
        n = n + _x(poses[:, :3, 3] - self.joint, f)
        self.vector(0, {"f": f, "n": n})
        if self.standard:  # force i + 1 acts at the end of link i
            arms = np.concatenate([np.zeros((1, 3)), _x(self.P[:-1], f[1:])])
        else:
            arms = _x(self.P, f)
        self.vector(2, {"P x f": arms})
        along = np.sum(np.where(self.hinge[:, None], n, f) * self.z, axis=1)
        self.each("tau_without_rotor", along, rank=1)

    def dynamics(self) -> None:
        robot, given, q = self.robot, self.given, self.given["q"]
        M, gravity = dynamics.mass_matrix(robot, q), dynamics.gravity_torques(robot, q)
        self.put("M", M)
        self.put("M_inverse", np.linalg.inv(M))
        self.each("M_row", M)
        for i in range(self.n):
            for j in range(i, self.n):
                self.put("M_entry", M[i, j], of=f"{i + 1}, {j + 1}")
        self.slopes(lagrange.christoffel(robot, q), lagrange.mass_matrix_derivatives(robot, q))
        linear, angular = self.Jc[:, :3], self.Jc[:, 3:]
        mass = self.mass[:, None, None] * (np.swapaxes(linear, 1, 2) @ linear)
        self.each("m Jv^T Jv", mass, rank=1)
        self.each("Jw^T I Jw", np.swapaxes(angular, 1, 2) @ self.I @ angular, rank=1)
        self.put("gravity", gravity)
        self.each("gravity_entry", gravity)
        self.each("u", links.link_potential_energies(robot, q))
        self.put("potential", np.asarray(dynamics.potential_energy(robot, q)))
        if "v" in given:
            v = given["v"]
            C = dynamics.coriolis_matrix(robot, q, v)
            self.put("C", C)
            self.put("C v", C @ v)
            self.put("bias", C @ v + gravity)
            self.each("C_v_entry", C @ v)
            for (i, j), x in np.ndenumerate(C):
                self.put("C_entry", np.asarray(x), of=f"{i + 1}, {j + 1}", rank=1)
            self.each("k", links.link_kinetic_energies(robot, q, v))
            self.put("kinetic", np.asarray(dynamics.kinetic_energy(robot, q, v)))
        if "a" in given:
            self.put("M a", M @ given["a"])
        tau = given.get("tau")
        if tau is None and {"v", "a"} <= set(given):
            tau = dynamics.inverse_dynamics(robot, q, given["v"], given["a"], given.get("wrench"))
        if tau is not None:
            self.put("tau", tau)
            self.each("tau_entry", tau)

    def slopes(self, symbols: Array, derivatives: Array) -> None:
        """Christoffel's symbols, and dM/dq with the index of q behind and in front."""
        self.put("christoffel", symbols, rank=1)
        self.put("M_slopes", derivatives, rank=1)
        self.put("M_slopes", np.moveaxis(derivatives, 2, 0), rank=1)
        self.each("M_slope", np.moveaxis(derivatives, 2, 0), rank=1)
        for (i, j, k), x in np.ndenumerate(symbols):
            if j <= k:
                self.put("christoffel_entry", x, of=f"{i + 1}, {j + 1}, {k + 1}", rank=2)
        if "v" in self.given:
            self.put("M_dot", derivatives @ self.given["v"], rank=1)


def _turned(turn: Array, vectors: Array) -> Array:
    out: Array = np.einsum("nij,nj->ni", turn, vectors)
    return out


def _x(one: Array, two: Array) -> Array:
    """Cross products of rows; numpy's own takes three times as long for so few."""
    (a, b, c), (d, e, f) = one.T, two.T
    return np.stack([b * f - c * e, c * d - a * f, a * e - b * d], axis=1)
