"""The five-bar as Pinocchio sees it: a tree of four joints and one loop constraint.

Nothing of the closed form is used here, so each is an oracle for the other. The tree is cut at
the tool: base - crank 1 - rod 1 (carries the payload and the tool frame) and base - crank 2 -
rod 2; q = (theta_1, psi_1, theta_2, psi_2) with psi_i the rod's angle from its crank. A point
anchor holds the two rod ends together. In the plane it has rank 2 of 3, so only its x and y
rows are used.

Pinocchio has no inverse dynamics for loops: tau = G^T rnea(q, v, a), where G maps the cranks'
rates to all four joints through the loop.
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any

import numpy as np
import pinocchio as pin
from numpy.typing import ArrayLike

from kinlab.arrays import Array, shaped
from kinlab.errors import OptionError, SingularError, UnreachableError
from kinlab.fivebar.linkage import JOINTS, Linkage
from kinlab.tolerances import TOLERANCES

CRANKS, PASSIVE = (0, 2), (1, 3)
_STEPS = 30


@dataclass(frozen=True)
class ClosedChain:
    """A frozen handle; every method returns new arrays.

    Attributes:
        linkage: the numbers it was built from.
        model: the tree, with gravity, payload and reflected rotor inertia (armature).
        anchor: the loop constraint between the ends of the rods.
        tool: the frame at the end of rod 1.
    """

    linkage: Linkage
    model: Any
    anchor: Any
    tool: int

    def assemble(
        self, theta: ArrayLike, assembly: int = 1, guess: ArrayLike | None = None
    ) -> Array:
        """Closes the loop for given crank angles by Newton, staying in one assembly mode.

        Inside a branch the closure's Jacobian is regular, so the gap can be led straight to
        zero: in one go where Newton converges without changing the sign of w_1 x w_2, and
        else in as many parts as that takes.

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
        if assembly not in (1, -1):
            raise OptionError(f"assembly {assembly!r} does not exist; choose +1 or -1")
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
        q, gap = self._lead_to_zero(data, q, assembly)
        if gap > TOLERANCES.closure * self.size:
            raise UnreachableError(
                f"{name}: the loop stays open by {gap:.3g} m at theta = ({angles[0]:.9g}, "
                f"{angles[1]:.9g}) rad in assembly mode {assembly:+d}; the elbows are too far "
                "apart or too close"
            )
        return q

    def _right_angle(self, data: Any, q: Array, assembly: int) -> Array:
        """Absolute angles of rods at right angles whose ends are apart along the elbows' line.

        From there the straight way of the gap to zero never meets the edge of the branch.
        """
        pin.forwardKinematics(self.model, data, q)
        span = data.oMi[4].translation - data.oMi[2].translation
        first, second = np.asarray(self.linkage.l2)
        turn = np.arctan2(span[1], span[0]) + assembly * np.arctan2(second, first)
        return np.array([turn, turn + assembly * 0.5 * np.pi])

    def _lead_to_zero(self, data: Any, q: Array, assembly: int) -> tuple[Array, float]:
        """Leads the gap to zero along a straight line, in one step where Newton manages that."""
        first, _ = self.closure(q, data)
        done, stride = 0.0, 1.0
        while done < 1.0 and stride > 1e-6:
            goal = min(1.0, done + stride)
            found = self._newton(data, q, (1.0 - goal) * first, assembly)
            if found is None:
                stride *= 0.5
            else:
                q, done, stride = found, goal, 2.0 * stride
        return q, float(np.linalg.norm(self.closure(q, data)[0]))

    def _newton(self, data: Any, q: Array, gap: Array, assembly: int) -> Array | None:
        """Newton on the passive angles until the gap is as given; None if it leaves the branch."""
        q = q.copy()
        before = np.inf
        for _ in range(_STEPS):
            error, rows = self.closure(q, data)
            left = float(np.linalg.norm(error - gap))
            if left <= 1e-3 * TOLERANCES.closure * self.size:
                return q
            if left > 0.5 * before:  # not converging, or as near as rounding lets it
                return q if left <= TOLERANCES.closure * self.size else None
            before = left
            q[[*PASSIVE]] -= np.linalg.solve(rows[:, PASSIVE], error - gap)
            if self._rods_sine(q) * assembly <= 0:
                return None
        return None

    @staticmethod
    def _rods_sine(q: Array) -> float:
        """w_1 x w_2."""
        return float(np.sin(q[2] + q[3] - q[0] - q[1]))

    @property
    def size(self) -> float:
        """Sum of the bars, m: what a gap is measured against."""
        linkage = self.linkage
        return float(np.sum(linkage.l1) + np.sum(linkage.l2) + 2.0 * linkage.e)

    def closure(self, q: Array, data: Any = None) -> tuple[Array, Array]:
        """Gap of the loop (2,), m, and its Jacobian (2, 4), in the base's axes.

        Pinocchio gives both in the axes of rod 1, which turn; in the base's axes the Jacobian
        of the passive angles is regular wherever the rods are not in line, closed or not.
        """
        data = data or self.model.createData()
        anchor = self.anchor.createData()
        pin.computeJointJacobians(self.model, data, q)
        self.anchor.calc(self.model, data, anchor)
        rows = self.anchor.jacobian(self.model, data, anchor)
        turn = data.oMi[self.anchor.joint1_id].rotation[:2, :2]
        gap = turn @ anchor.constraint_position_error[:2]
        return gap, turn @ rows[:2] + np.outer([-gap[1], gap[0]], [1.0, 1.0, 0.0, 0.0])

    def closure_bias(self, q: Array, qd: Array) -> Array:
        """Jc_dot qd of the closed loop, (2,), m/s², in the base's axes."""
        data, anchor = self.model.createData(), self.anchor.createData()
        pin.forwardKinematics(self.model, data, q, qd, np.zeros(4))
        pin.computeJointJacobians(self.model, data, q)
        self.anchor.calc(self.model, data, anchor)
        turn = data.oMi[self.anchor.joint1_id].rotation[:2, :2]
        return np.asarray(turn @ anchor.constraint_acceleration_error[:2])

    def fk(self, q: Array) -> Array:
        """The tool, (2,), m."""
        data = self.model.createData()
        pin.framesForwardKinematics(self.model, data, q)
        return np.array(data.oMf[self.tool].translation[:2])

    def tool_jacobian(self, q: Array) -> Array:
        """Tool velocity per joint rate of the open tree, (2, 4), base axes."""
        data = self.model.createData()
        pin.computeJointJacobians(self.model, data, q)
        pin.updateFramePlacement(self.model, data, self.tool)
        rows = pin.getFrameJacobian(
            self.model, data, self.tool, pin.ReferenceFrame.LOCAL_WORLD_ALIGNED
        )
        return np.array(rows[:2])

    def projection(self, q: Array) -> Array:
        """G of qd = G theta_dot through the loop, (4, 2).

        Raises:
            SingularError: type II, where the cranks do not determine the rods.
        """
        self._refuse_type_two(q)
        _, rows = self.closure(q)
        out = np.zeros((4, 2))
        out[[*CRANKS], [0, 1]] = 1.0
        out[[*PASSIVE]] = -np.linalg.solve(rows[:, PASSIVE], rows[:, CRANKS])
        return out

    def jacobian(self, q: Array) -> Array:
        """J of theta_dot = J v, (2, 2), rad/m; raises SingularError at type I and II."""
        self._refuse_type_one(q)
        return np.asarray(np.linalg.inv(self.tool_jacobian(q) @ self.projection(q)), np.float64)

    def joint_rates(self, q: Array, v: ArrayLike) -> Array:
        """All four joint rates for a tool velocity (2,), rad/s."""
        self._refuse_type_one(q)
        velocity = shaped(v, (2,), f"{self.linkage.name}: v")
        _, rows = self.closure(q)
        return np.linalg.solve(np.vstack([self.tool_jacobian(q), rows]), [*velocity, 0.0, 0.0])

    def joint_accelerations(self, q: Array, qd: Array, a: ArrayLike) -> Array:
        """All four joint accelerations for a tool acceleration (2,), rad/s²."""
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

    def inverse_dynamics(self, q: Array, qd: Array, qdd: Array) -> Array:
        """Crank torques G^T rnea, (2,), N m; raises SingularError at type II."""
        tree = pin.rnea(self.model, self.model.createData(), q, qd, qdd)
        return np.asarray(self.projection(q).T @ tree)

    def mass_matrix(self, q: Array) -> Array:
        """G^T M G in the cranks' coordinates, (2, 2), kg m²; SingularError at type II."""
        projection = self.projection(q)
        mass = pin.crba(self.model, self.model.createData(), q)
        mass = np.triu(mass) + np.triu(mass, 1).T
        return np.asarray(projection.T @ mass @ projection)

    def energy(self, q: Array, qd: Array) -> tuple[float, float]:
        """Kinetic (rotors included) and potential energy, J."""
        data = self.model.createData()
        kinetic = pin.computeKineticEnergy(self.model, data, q, qd)
        return float(kinetic), float(pin.computePotentialEnergy(self.model, data, q))

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


def build(linkage: Linkage) -> ClosedChain:
    """Builds the tree, the payload and the anchor."""
    model = pin.Model()
    model.name = linkage.name
    model.gravity.linear = np.array([*np.asarray(linkage.gravity), 0.0])
    l1, l2 = np.asarray(linkage.l1), np.asarray(linkage.l2)
    rotor = np.square(linkage.gear_ratio) * np.asarray(linkage.rotor_inertia)
    ends = []
    for leg in range(2):
        base = pin.SE3(np.eye(3), np.array([linkage.base_x[leg], 0.0, 0.0]))
        elbow = pin.SE3(np.eye(3), np.array([l1[leg], 0.0, 0.0]))
        crank = model.addJoint(0, pin.JointModelRZ(), base, JOINTS[2 * leg])
        rod = model.addJoint(crank, pin.JointModelRZ(), elbow, JOINTS[2 * leg + 1])
        for joint, part in ((crank, "crank"), (rod, "rod")):
            mass, com, spin = (
                float(getattr(linkage, f"{part}_{what}")[leg])
                for what in ("mass", "com", "inertia")
            )
            body = pin.Inertia(mass, np.array([com, 0.0, 0.0]), spin * np.eye(3))
            model.appendBodyToJoint(joint, body, pin.SE3.Identity())
        model.armature[model.joints[crank].idx_v] = rotor[leg]
        ends.append((rod, pin.SE3(np.eye(3), np.array([l2[leg], 0.0, 0.0]))))
    load = pin.Inertia(linkage.payload, ends[0][1].translation, np.zeros((3, 3)))
    model.appendBodyToJoint(ends[0][0], load, pin.SE3.Identity())
    tool = model.addFrame(pin.Frame("tool", ends[0][0], *ends[0][1:], pin.FrameType.OP_FRAME))
    anchor = pin.PointAnchorConstraintModel(model, *ends[0], *ends[1])
    return ClosedChain(linkage, model, anchor, tool)
