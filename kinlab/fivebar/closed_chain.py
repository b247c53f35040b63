"""The five-bar as Pinocchio sees it: a tree of four joints and one loop constraint."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from typing import TYPE_CHECKING, Any

import numpy as np
import pinocchio as pin
from numpy.typing import ArrayLike

from kinlab.arrays import Array, shaped
from kinlab.errors import OptionError, SingularError, UnreachableError
from kinlab.fivebar.arguments import HANGING, JOINTS, Mode, read_assembly, read_mode
from kinlab.tolerances import TOLERANCES

if TYPE_CHECKING:
    from kinlab.fivebar.linkage import FiveBar

# -------- Newton's method that stays on one branch of solutions

Residual = Callable[[Array], tuple[Array, Array]]
_STEPS = 30


def follow_branch_to_zero(
    residual: Residual, start: Array, inside: Callable[[Array], bool], tolerance: float
) -> tuple[Array, float]:
    """Continuation: takes a residual to zero along a straight line, at once if Newton can.

    Where the Jacobian is regular on the whole branch, the residual can follow any line that the
    branch can reach; a step that Newton cannot make, or that leaves the branch, is halved.

    Args:
        residual: x (n,) to the residual (n,) and its Jacobian (n, n).
        start: a point of the branch, (n,).
        inside: whether a point is on the branch.
        tolerance: norm of the residual that is wanted.

    Returns:
        The point, and the norm of the residual that is left there: above the tolerance where
        the line leaves the branch.
    """
    x, (first, _) = start, residual(start)
    done, stride = 0.0, 1.0
    while done < 1.0 and stride > TOLERANCES.shortest_stride:
        goal = min(1.0, done + stride)
        found = _newton(residual, x, (1.0 - goal) * first, inside, tolerance)
        if found is None:
            stride *= 0.5
        else:
            x, done, stride = found, goal, 2.0 * stride
    return x, float(np.linalg.norm(residual(x)[0]))


def _newton(
    residual: Residual, x: Array, goal: Array, inside: Callable[[Array], bool], tolerance: float
) -> Array | None:
    """Newton until the residual is ``goal``; None if it leaves the branch or does not get there."""
    before = np.inf
    for _ in range(_STEPS):
        value, derivative = residual(x)
        left = float(np.linalg.norm(value - goal))
        if left <= 1e-3 * tolerance:
            return x
        if left > 0.5 * before:  # not converging, or as near as rounding lets it
            return x if left <= tolerance else None
        before = left
        try:
            x = x - np.linalg.solve(derivative, value - goal)
        except np.linalg.LinAlgError:  # singular to the last bit
            return None
        if not inside(x):
            return None
    return None


# -------- The five-bar as Pinocchio sees it: a tree of four joints and one loop constraint
# Nothing of the closed form is used here, so each is an oracle for the other. The tree is cut at
# the tool: base - crank 1 - rod 1 (carries the payload and the tool frame) and base - crank 2 -
# rod 2; q = (theta_1, psi_1, theta_2, psi_2) with psi_i the rod's angle from its crank. A point
# anchor holds the two rod ends together. In the plane it has rank 2 of 3, so only its x and y
# rows are used.
#
# Pinocchio has no inverse dynamics for loops: tau = G^T rnea(q, v, a), where G maps the cranks'
# rates to all four joints through the loop.

CRANKS, PASSIVE = (0, 2), (1, 3)


@dataclass(frozen=True)
class ClosedChain:
    """A frozen handle; every method returns new arrays.

    Attributes:
        linkage: the numbers it was built from.
        model: the tree, with gravity, payload and reflected rotor inertia (armature).
        anchor: the loop constraint between the ends of the rods.
        tool: the frame at the end of rod 1.
    """

    linkage: FiveBar
    model: Any
    anchor: Any
    tool: int

    def assemble(
        self, theta: ArrayLike, assembly: int = 1, guess: ArrayLike | None = None
    ) -> Array:
        """Closes the loop for given crank angles by Newton, staying in one assembly mode.

        Inside a branch the closure's Jacobian is regular, so the gap can be taken straight to
        zero without a change of the sign of w_1 x w_2.

        Args:
            theta: (2,), rad.
            assembly: sign of w_1 x w_2 that the pose must have.
            guess: (2,) passive angles to start from, rad, of the same sign; none starts with
                the rods at right angles.

        Returns:
            q, (4,), rad, with a gap below 1e-12 of the mechanism's size.

        Raises:
            UnreachableError: the rods cannot meet there; the message holds the gap that is left.
            OptionError: another assembly, or a guess of the other sign.
        """
        read_assembly(assembly)
        name, data = self.linkage.name, self.model.createData()
        angles = shaped(theta, (2,), f"{name}: theta")
        q = np.zeros(4)
        q[[*CRANKS]] = angles
        if guess is None:
            q[[*PASSIVE]] = self._right_angle(data, q, assembly) - angles
        else:
            q[[*PASSIVE]] = shaped(guess, (2,), f"{name}: guess")
            if self._rods_sine(q) * assembly <= 0:
                raise OptionError(f"{name}: the guess is not in assembly mode {assembly:+d}")
        data = self.model.createData()

        def residual(passive: Array) -> tuple[Array, Array]:
            gap, rows = self.closure(_joined(angles, passive), data)
            return gap, rows[:, PASSIVE]

        def inside(passive: Array) -> bool:
            return self._rods_sine(_joined(angles, passive)) * assembly > 0

        tolerance = TOLERANCES.closure * self.size
        passive, gap = follow_branch_to_zero(residual, q[[*PASSIVE]], inside, tolerance)
        if gap > tolerance:
            raise UnreachableError(
                f"{name}: the loop stays open by {gap:.3g} m at theta = ({angles[0]:.9g}, "
                f"{angles[1]:.9g}) rad in assembly mode {assembly:+d}; the elbows are too far "
                "apart or too close"
            )
        return _joined(angles, passive)

    def at(self, xy: ArrayLike, mode: Mode = HANGING) -> Array:
        """The pose with the tool at a point, leg by leg, by Newton in one working mode.

        Args:
            xy: (2,), m.
            mode: signs of u_i x w_i.

        Returns:
            q, (4,), rad, with both rod ends within 1e-12 of the mechanism's size of the point.

        Raises:
            UnreachableError: a leg cannot get there; the message holds the gap that is left.
            OptionError: a mode that does not exist.
        """
        point, signs = shaped(xy, (2,), f"{self.linkage.name}: xy"), read_mode(mode)
        data, tolerance = self.model.createData(), TOLERANCES.closure * self.size
        q = np.zeros(4)
        for leg, sign in enumerate(signs):
            joints = slice(2 * leg, 2 * leg + 2)

            def residual(x: Array, joints: slice = joints, leg: int = leg) -> tuple[Array, Array]:
                full = np.zeros(4)
                full[joints] = x
                end, rows = self._rod_end(full, leg, data)
                return end - point, rows[:, joints]

            def inside(x: Array, sign: float = sign) -> bool:
                return bool(np.sin(x[1]) * sign > 0)

            start = np.array([0.0, 0.5 * np.pi * sign])
            base = np.array([self.linkage.base_x[leg], 0.0])
            arm = residual(start)[0] + point - base
            start[0] = np.arctan2(*(point - base)[::-1]) - np.arctan2(arm[1], arm[0])
            q[joints], gap = follow_branch_to_zero(residual, start, inside, tolerance)
            if gap > tolerance:
                raise UnreachableError(
                    f"{self.linkage.name}: leg {leg + 1} stays {gap:.3g} m short of "
                    f"({point[0]:.9g}, {point[1]:.9g}) m"
                )
        return q

    def _rod_end(self, q: Array, leg: int, data: Any) -> tuple[Array, Array]:
        """The end of a leg's rod (2,) and its Jacobian (2, 4), base axes."""
        anchor = self.anchor
        joint = (anchor.joint1_id, anchor.joint2_id)[leg]
        place = (anchor.joint1_placement, anchor.joint2_placement)[leg]
        pin.computeJointJacobians(self.model, data, q)
        end = data.oMi[joint].act(place.translation)
        rows = pin.getFrameJacobian(
            self.model, data, joint, place, pin.ReferenceFrame.LOCAL_WORLD_ALIGNED
        )
        return np.array(end[:2]), np.array(rows[:2])

    def _right_angle(self, data: Any, q: Array, assembly: int) -> Array:
        """Absolute angles of rods at right angles whose ends are apart along the elbows' line.

        From there the straight way of the gap to zero never meets the edge of the branch.
        """
        pin.forwardKinematics(self.model, data, q)
        span = data.oMi[4].translation - data.oMi[2].translation
        first, second = np.asarray(self.linkage.l2)
        angle = np.arctan2(span[1], span[0]) + assembly * np.arctan2(second, first)
        return np.array([angle, angle + assembly * 0.5 * np.pi])

    @staticmethod
    def _rods_sine(q: Array) -> float:
        """w_1 x w_2."""
        return float(np.sin(q[2] + q[3] - q[0] - q[1]))

    @property
    def size(self) -> float:
        """Sum of the bars, m: what a gap is measured against."""
        linkage = self.linkage
        return float(np.sum(linkage.l1) + np.sum(linkage.l2) + 2.0 * linkage.e)

    def closure(self, q: ArrayLike, data: Any = None) -> tuple[Array, Array]:
        """Gap of the loop (2,), m, and its Jacobian (2, 4), in the base's axes.

        Pinocchio gives both in the axes of rod 1, which turn; in the base's axes the Jacobian
        of the passive angles is regular wherever the rods are not in line, closed or not.
        """
        q = self._four(q, "q")
        data = data or self.model.createData()
        anchor = self.anchor.createData()
        pin.computeJointJacobians(self.model, data, q)
        self.anchor.calc(self.model, data, anchor)
        rows = self.anchor.jacobian(self.model, data, anchor)
        rotation = data.oMi[self.anchor.joint1_id].rotation[:2, :2]
        gap = rotation @ anchor.constraint_position_error[:2]
        return gap, rotation @ rows[:2] + np.outer([-gap[1], gap[0]], [1.0, 1.0, 0.0, 0.0])

    def closure_bias(self, q: ArrayLike, qd: ArrayLike) -> Array:
        """Jc_dot qd of the closed loop, (2,), m/s², in the base's axes."""
        q, qd = self._four(q, "q"), self._four(qd, "qd")
        data, anchor = self.model.createData(), self.anchor.createData()
        pin.forwardKinematics(self.model, data, q, qd, np.zeros(4))
        pin.computeJointJacobians(self.model, data, q)
        self.anchor.calc(self.model, data, anchor)
        rotation = data.oMi[self.anchor.joint1_id].rotation[:2, :2]
        return np.asarray(rotation @ anchor.constraint_acceleration_error[:2])

    def fk(self, q: ArrayLike) -> Array:
        """The tool, (2,), m."""
        q = self._four(q, "q")
        data = self.model.createData()
        pin.framesForwardKinematics(self.model, data, q)
        return np.array(data.oMf[self.tool].translation[:2])

    def tool_jacobian(self, q: ArrayLike) -> Array:
        """Tool velocity per joint rate of the open tree, (2, 4), base axes."""
        q = self._four(q, "q")
        data = self.model.createData()
        pin.computeJointJacobians(self.model, data, q)
        pin.updateFramePlacement(self.model, data, self.tool)
        rows = pin.getFrameJacobian(
            self.model, data, self.tool, pin.ReferenceFrame.LOCAL_WORLD_ALIGNED
        )
        return np.array(rows[:2])

    def projection(self, q: ArrayLike) -> Array:
        """G of qd = G theta_dot through the loop, (4, 2).

        Raises:
            SingularError: type II, where the cranks do not determine the rods.
        """
        q = self._four(q, "q")
        self._refuse_type_two(q)
        _, rows = self.closure(q)
        out = np.zeros((4, 2))
        out[[*CRANKS], [0, 1]] = 1.0
        out[[*PASSIVE]] = -np.linalg.solve(rows[:, PASSIVE], rows[:, CRANKS])
        return out

    def jacobian(self, q: ArrayLike) -> Array:
        """J of theta_dot = J v, (2, 2), rad/m; raises SingularError at type I and II."""
        q = self._four(q, "q")
        self._refuse_type_one(q)
        return np.asarray(np.linalg.inv(self.tool_jacobian(q) @ self.projection(q)), np.float64)

    def joint_rates(self, q: ArrayLike, v: ArrayLike) -> Array:
        """All four joint rates for a tool velocity (2,), rad/s."""
        q = self._four(q, "q")
        self._refuse_type_one(q)
        velocity = shaped(v, (2,), f"{self.linkage.name}: v")
        _, rows = self.closure(q)
        return np.linalg.solve(np.vstack([self.tool_jacobian(q), rows]), [*velocity, 0.0, 0.0])

    def joint_accelerations(self, q: ArrayLike, qd: ArrayLike, a: ArrayLike) -> Array:
        """All four joint accelerations for a tool acceleration (2,), rad/s²."""
        q, qd = self._four(q, "q"), self._four(qd, "qd")
        self._refuse_type_one(q)
        acceleration = shaped(a, (2,), f"{self.linkage.name}: a")
        data = self.model.createData()
        pin.forwardKinematics(self.model, data, q, qd, np.zeros(4))
        pin.updateFramePlacement(self.model, data, self.tool)
        drift = pin.getFrameClassicalAcceleration(
            self.model, data, self.tool, pin.ReferenceFrame.LOCAL_WORLD_ALIGNED
        ).linear[:2]
        _, rows = self.closure(q)
        target = np.concatenate([acceleration - drift, -self.closure_bias(q, qd)])
        return np.linalg.solve(np.vstack([self.tool_jacobian(q), rows]), target)

    def inverse_dynamics(self, q: ArrayLike, qd: ArrayLike, qdd: ArrayLike) -> Array:
        """Crank torques G^T rnea, (2,), N m; raises SingularError at type II."""
        q, qd, qdd = self._four(q, "q"), self._four(qd, "qd"), self._four(qdd, "qdd")
        tree = pin.rnea(self.model, self.model.createData(), q, qd, qdd)
        return np.asarray(self.projection(q).T @ tree)

    def mass_matrix(self, q: ArrayLike) -> Array:
        """G^T M G in the cranks' coordinates, (2, 2), kg m²; SingularError at type II."""
        q = self._four(q, "q")
        projection = self.projection(q)
        mass = pin.crba(self.model, self.model.createData(), q)
        mass = np.triu(mass) + np.triu(mass, 1).T
        return np.asarray(projection.T @ mass @ projection)

    def energy(self, q: ArrayLike, qd: ArrayLike) -> tuple[float, float]:
        """Kinetic (rotors included) and potential energy, J."""
        q, qd = self._four(q, "q"), self._four(qd, "qd")
        data = self.model.createData()
        kinetic = pin.computeKineticEnergy(self.model, data, q, qd)
        return float(kinetic), float(pin.computePotentialEnergy(self.model, data, q))

    def _four(self, value: ArrayLike, name: str) -> Array:
        """A vector of the four joints at the door, in the machine's own numbers."""
        vector = shaped(value, (4,), f"{self.linkage.name}: {name}")
        return np.ascontiguousarray(vector)

    def _refuse_type_one(self, q: Array) -> None:
        for leg, joint in enumerate(PASSIVE, 1):
            if abs(np.sin(q[joint])) <= TOLERANCES.singular_sine:
                raise SingularError(
                    f"{self.linkage.name}: singular (type I): crank and rod of leg {leg} are in "
                    "line, so its rate is not determined by the tool"
                )

    def _refuse_type_two(self, q: Array) -> None:
        if abs(self._rods_sine(q)) <= TOLERANCES.singular_sine:
            raise SingularError(
                f"{self.linkage.name}: singular (type II): the two rods are in line, so the "
                "cranks do not determine the tool; constrained forward dynamics still exist"
            )


def _joined(cranks: Array, passive: Array) -> Array:
    q = np.empty(4)
    q[[*CRANKS]], q[[*PASSIVE]] = cranks, passive
    return q


# -------- Builds the Pinocchio tree of a five-bar, with payload, rotors and the anchor of
#          its loop


def build(linkage: FiveBar) -> ClosedChain:
    """Builds the tree, the payload and the anchor."""
    model = pin.Model()
    model.name = linkage.name
    model.gravity.linear = np.array([*linkage.gravity, 0.0])
    l1, l2 = linkage.l1, linkage.l2
    ends = []
    for leg in range(2):
        base = pin.SE3(np.eye(3), np.array([linkage.base_x[leg], 0.0, 0.0]))
        elbow = pin.SE3(np.eye(3), np.array([l1[leg], 0.0, 0.0]))
        crank = model.addJoint(0, pin.JointModelRZ(), base, JOINTS[2 * leg])
        rod = model.addJoint(crank, pin.JointModelRZ(), elbow, JOINTS[2 * leg + 1])
        for joint, part in ((crank, "crank"), (rod, "rod")):
            mass, com, inertia = (
                float(getattr(linkage, f"{part}_{what}")[leg])
                for what in ("mass", "com", "inertia")
            )
            body = pin.Inertia(mass, np.array([com, 0.0, 0.0]), inertia * np.eye(3))
            model.appendBodyToJoint(joint, body, pin.SE3.Identity())
        model.armature[model.joints[crank].idx_v] = linkage.reflected_inertia[leg]
        ends.append((rod, pin.SE3(np.eye(3), np.array([l2[leg], 0.0, 0.0]))))
    load = pin.Inertia(linkage.payload, ends[0][1].translation, np.zeros((3, 3)))
    model.appendBodyToJoint(ends[0][0], load, pin.SE3.Identity())
    tool = model.addFrame(pin.Frame("tool", ends[0][0], *ends[0][1:], pin.FrameType.OP_FRAME))
    anchor = pin.PointAnchorConstraintModel(model, *ends[0], *ends[1])
    return ClosedChain(linkage, model, anchor, tool)
