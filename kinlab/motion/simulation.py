"""Motion under torques: an arm or a five-bar in time, with friction, and its balance of energy.

Coulomb friction is what it is at rest, too: a joint without speed is held by any torque up to its
friction, and else slides. The accelerations then are those of least constraint (Gauss): they
minimise ½ a^T M a - a^T r + sum c_i |a_i| over the joints at rest, r being all other torques; M is
positive definite, so there is one answer. Between the instants where a joint stops or breaks loose
the right side is smooth.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass, field
from itertools import product

import numpy as np
import pinocchio as pin
from numpy.typing import ArrayLike

from kinlab.arrays import Array, between, frozen, number, real_array, shaped
from kinlab.engine.dynamics import kinetic_energy, potential_energy
from kinlab.engine.integrator import integrate
from kinlab.engine.kinematics import jacobian, read_wrench
from kinlab.engine.states import joint_vector
from kinlab.errors import OptionError, StateError
from kinlab.fivebar import FiveBar
from kinlab.fivebar import simulation as fivebar_simulation
from kinlab.fivebar.linkage import as_mechanism
from kinlab.fivebar.simulation import Torque
from kinlab.host.introductions import Told
from kinlab.model.library import ArmLike
from kinlab.model.robot import Robot, require_inertia, scratch
from kinlab.motion.record import even_times
from kinlab.tolerances import TOLERANCES

_MOST_CHANGES = 5_000
"""Instants at which joints stop or break loose before a simulation is given up."""
_MOST_AT_ONCE = 60
"""The same within a millionth of the duration."""
_ROUNDS = 400
"""Rounds over the joints before all patterns of sticking and sliding are tried."""
_MOST_PATTERNS = 8
"""Joints with friction up to which that is done: 3^8 patterns, a second."""


@dataclass(frozen=True, eq=False, repr=False)
class Simulation(Told):
    """A simulated motion, K samples.

    Attributes:
        name: of the robot.
        t: (K,), s. q, v, a: (K, n); of a five-bar all four joints.
        tau: torques that drove it, (K, n); of a five-bar (K, 2), at the cranks.
        energy: kinetic plus potential, (K,), J.
        work: by the torques, (K,), J. loss: in friction, (K,), J.
        tool_work: by the tool on the environment, (K,), J.
        remarks: what was noticed.
    """

    name: str
    t: Array
    q: Array
    v: Array
    a: Array
    tau: Array
    energy: Array
    work: Array
    loss: Array
    tool_work: Array
    remarks: tuple[str, ...] = field(default=())

    def __len__(self) -> int:
        return len(self.t)

    @property
    def balance(self) -> Array:
        """Change of energy less work plus what went out, (K,), J: zero but for the integration."""
        change = self.energy - self.energy[0]
        return np.asarray(change - self.work + self.loss + self.tool_work)

    @property
    def miss(self) -> float:
        """Largest |:attr:`balance`|, J."""
        return float(np.abs(self.balance).max())

    def __str__(self) -> str:
        change = self.energy[-1] - self.energy[0]
        text = (
            f"{self.name!r} over {self.t[-1]:.6g} s: work {self.work[-1]:.6g} J = change of energy "
            f"{change:.6g} J + friction {self.loss[-1]:.6g} J + tool {self.tool_work[-1]:.6g} J, "
            f"up to {self.miss:.2g} J"
        )
        return "\n".join([text, *self.remarks])


def simulate(
    robot: ArmLike | FiveBar,
    q0: ArrayLike,
    v0: ArrayLike | None = None,
    torque: Torque | ArrayLike | None = None,
    *,
    duration: float,
    wrench: ArrayLike | None = None,
    step: float = 0.01,
) -> Simulation:
    """Lets an arm or a five-bar move under torques.

    Viscous and Coulomb friction of the joints (``model.damping``, ``model.friction``) count, and
    joints stick; a payload is part of the robot. There are no end stops and no contacts: a joint
    beyond its limits goes on, and ``remarks`` says when it left them.

    Args:
        robot: the arm, or a :class:`kinlab.FiveBar` whose rods have masses.
        q0: positions at the start, (n,). Of a five-bar its crank angles, (2,), or all four joints.
        v0: velocities at the start, as q0; left out, at rest.
        torque: ``torque(t, q, v)``, or constant ones, (n,); of a five-bar at the cranks, (2,), from
            (t, q, v) with all four joints. Left out, none.
        duration: s.
        wrench: (f, n) that the tool exerts on the environment all the way, (6,), as for
            :func:`kinlab.inverse_dynamics`. Not for a five-bar.
        step: largest time between samples of the answer, s; the integration takes its own.

    Returns:
        Positions, velocities, accelerations, torques, and where the energy went.

    Raises:
        StateError: q0, v0, wrench or a torque of another shape, or not finite.
        OptionError: a duration or step that is not positive; torques too stiff to integrate.
        InertiaError: the arm has no masses.
        SingularError, UnreachableError: a five-bar that cannot close, or has no unique motion.
    """
    times = even_times(number(duration, "duration", above=0.0), step)
    robot = as_mechanism(robot)
    if isinstance(robot, FiveBar):
        if wrench is not None:
            raise OptionError(f"{robot.name}: a five-bar takes no wrench; give crank torques")
        return _five_bar(robot, q0, v0, torque, times)
    require_inertia(robot)
    q, v = (_one(robot, value, name) for value, name in ((q0, "q0"), (v0, "v0")))
    force = None if wrench is None else read_wrench(robot, wrench)
    if force is not None and force.shape != (6,):
        raise StateError(f"robot {robot.name!r}: wrench has shape {force.shape}; expected (6,)")
    return _Arm(robot, read_torque(torque, robot.n, f"robot {robot.name!r}"), force).run(
        q, v, times
    )


def _one(robot: Robot, value: ArrayLike | None, name: str) -> Array:
    state = np.zeros(robot.n) if value is None else joint_vector(robot, value, name)
    if state.ndim != 1:
        raise StateError(f"robot {robot.name!r}: {name} has shape {state.shape}; give one state")
    return state


def read_torque(
    torque: Torque | ArrayLike | None, n: int, name: str
) -> Callable[[float, Array, Array], Array]:
    """The torques as a function of (t, q, v), (n,), each answer checked.

    Raises:
        StateError: another shape, or not finite; a function's when it is asked.
    """
    if torque is None:
        return lambda t, q, v: np.zeros(n)
    if callable(torque):
        given = torque

        def asked(t: float, q: Array, v: Array) -> Array:
            return shaped(given(t, q.copy(), v.copy()), (n,), f"{name}: torque at t = {t:.6g} s")

        return asked
    constant = shaped(real_array(torque, f"{name}: torque"), (n,), f"{name}: torque")
    return lambda t, q, v: constant


class _Arm:
    """One arm under torques; what each joint's friction does is a mode: +1, -1 (sliding) or 0."""

    def __init__(
        self, robot: Robot, torque: Callable[[float, Array, Array], Array], force: Array | None
    ) -> None:
        self.robot, self.torque, self.force = robot, torque, force
        self.damping = np.array(robot.model.damping)
        self.dry = np.array(robot.model.friction)
        self.mode = np.zeros(robot.n)

    def run(self, q: Array, v: Array, times: Array) -> Simulation:
        n, here, changes, at_once = self.robot.n, times[0], 0, 0
        state = np.concatenate([q, v, np.zeros(3)])
        rows: list[Array] = []
        modes: list[Array] = []
        while True:
            self._choose_mode(here, state)
            left = times[times > here + 1e-15 * max(1.0, times[-1])]
            if not rows:
                grid, keep = times, 0
            else:
                grid, keep = np.concatenate([[here], left]), 1
            ran = integrate(self._slope, state, grid, stop=self._margin if self.dry.any() else None)
            rows.extend(ran.rows[keep:])
            modes.extend([self.mode.copy()] * len(ran.rows[keep:]))
            if not ran.stopped or len(rows) == len(times):
                break
            at_once = at_once + 1 if ran.t - here < 1e-6 * times[-1] else 0
            here, state, changes = ran.t, ran.state.copy(), changes + 1
            if changes > _MOST_CHANGES or at_once > _MOST_AT_ONCE:
                raise OptionError(
                    f"robot {self.robot.name!r}: joints stop and break loose without end at t = "
                    f"{here:.6g} s ({changes} times so far); soften the torque's gains"
                )
            turned = (self.mode != 0.0) & (self.mode * state[n : 2 * n] <= TOLERANCES.at_rest)
            state[n : 2 * n][turned] = 0.0
        table = np.array(rows)
        q, v = table[:, :n], table[:, n : 2 * n]
        tau = np.array([self.torque(t, *x) for t, *x in zip(times, q, v, strict=True)])
        a = np.empty_like(q)
        for k, mode in enumerate(modes):
            self.mode = mode
            a[k] = self._acceleration(q[k], v[k], tau[k])
        energy = kinetic_energy(self.robot, q, v) + potential_energy(self.robot, q)
        work, loss, tool = (frozen(x) for x in table[:, 2 * n :].T)
        return Simulation(
            name=self.robot.name,
            t=frozen(times),
            q=frozen(q),
            v=frozen(v),
            a=frozen(a),
            tau=frozen(tau),
            energy=frozen(np.asarray(energy)),
            work=work,
            loss=loss,
            tool_work=tool,
            remarks=self._remarks(times, q),
        )

    def _slope(self, t: float, state: Array) -> Array:
        n = self.robot.n
        q, v = state[:n], state[n : 2 * n]
        tau = self.torque(t, q, v)
        lost = float(v @ (self.damping * v + self.dry * self.mode))
        tool = 0.0 if self.force is None else float(self.force @ (jacobian(self.robot, q) @ v))
        moved = np.where((self.mode == 0.0) & (self.dry > 0.0), 0.0, v)
        return np.concatenate([moved, self._acceleration(q, v, tau), [float(tau @ v), lost, tool]])

    def _load(self, q: Array, v: Array, tau: Array) -> Array:
        """All torques but those of inertia, Coriolis, weight, and dry friction."""
        out = tau - self.damping * v
        return out if self.force is None else out - jacobian(self.robot, q).T @ self.force

    def _acceleration(self, q: Array, v: Array, tau: Array) -> Array:
        load = self._load(q, v, tau) - self.dry * self.mode
        held = (self.mode == 0.0) & (self.dry > 0.0)
        if not held.any():
            a = np.asarray(pin.aba(self.robot.model, scratch(self.robot), q, v, load))
        else:
            inertia, rest = self._equation(q, v, load)
            a, free = np.zeros(self.robot.n), ~held
            a[free] = np.linalg.solve(inertia[np.ix_(free, free)], rest[free])
        if not np.isfinite(a).all():
            raise StateError(f"robot {self.robot.name!r}: the simulated motion overflows")
        return a

    def _equation(self, q: Array, v: Array, load: Array) -> tuple[Array, Array]:
        """M and the torques less Coriolis and weight."""
        data = scratch(self.robot)
        bias = np.array(pin.nonLinearEffects(self.robot.model, data, q, v))
        return np.array(pin.crba(self.robot.model, data, q)), load - bias

    def _margin(self, t: float, state: Array) -> float:
        """What is left until a sliding joint stops, or a held one breaks loose."""
        n = self.robot.n
        q, v = state[:n], state[n : 2 * n]
        sliding = self.mode != 0.0
        least = float(np.min((self.mode * v + TOLERANCES.at_rest)[sliding], initial=np.inf))
        held = ~sliding & (self.dry > 0.0)
        if held.any():
            tau = self.torque(t, q, v)
            load = self._load(q, v, tau) - self.dry * self.mode
            inertia, rest = self._equation(q, v, load)
            a = self._acceleration(q, v, tau)
            needed = np.abs(rest - inertia @ a)[held]
            least = min(least, float(np.min(self.dry[held] * (1.0 + 1e-9) - needed)))
        return least

    def _choose_mode(self, t: float, state: Array) -> None:
        """Which way each joint slides; one at rest by the accelerations of least constraint."""
        n = self.robot.n
        q, v = state[:n], state[n : 2 * n]
        rubs = self.dry > 0.0
        rest = rubs & (v == 0.0)
        self.mode = np.where(rubs, np.sign(v), 0.0)
        if not rest.any():
            return
        load = self._load(q, v, self.torque(t, q, v)) - self.dry * self.mode
        inertia, right = self._equation(q, v, load)
        a = least_constraint(inertia, right, np.where(rest, self.dry, 0.0))
        self.mode = np.where(rest, np.sign(a), self.mode)

    def _remarks(self, times: Array, q: Array) -> tuple[str, ...]:
        outside = ~between(q, self.robot.lower, self.robot.upper, TOLERANCES.limit_digits)
        return tuple(
            f"{self.robot.joint_names[joint]} is outside its limits from t = "
            f"{times[int(np.argmax(outside[:, joint]))]:.4g} s on: there are no end stops"
            for joint in np.flatnonzero(outside.any(axis=0))
        )


def least_constraint(inertia: Array, right: Array, dry: Array) -> Array:
    """The a that minimises ½ a^T M a - a^T r + sum c_i |a_i|, (n,).

    A pattern says of each joint with friction whether it is held or slides, and which way; with it
    the free accelerations solve a linear equation. Coordinate by coordinate the iterates come to
    the pattern of the minimum; where that takes too long (joints of very unlike inertia), all
    patterns are tried. An answer is given only if it explains itself: every free joint slides as
    its pattern says, every held one needs no more than its friction. The function is strictly
    convex, so that this proves it.

    Raises:
        OptionError: no pattern explains itself in double precision.
    """
    a = np.zeros(len(right))
    for _ in range(_ROUNDS):
        for i in range(len(right)):
            pull = right[i] - inertia[i] @ a + inertia[i, i] * a[i]
            a[i] = np.sign(pull) * max(abs(pull) - dry[i], 0.0) / inertia[i, i]
        exact = _explained(inertia, right, dry, np.where(dry > 0.0, np.sign(a), 0.0))
        if exact is not None:
            return exact
    rubbing = np.flatnonzero(dry > 0.0)
    if len(rubbing) <= _MOST_PATTERNS:
        for signs in product((0.0, 1.0, -1.0), repeat=len(rubbing)):
            pattern = np.zeros(len(right))
            pattern[rubbing] = signs
            exact = _explained(inertia, right, dry, pattern)
            if exact is not None:
                return exact
    raise OptionError(
        "at rest no joint is found to stick or slide without contradiction: the mass matrix is so "
        f"ill-conditioned ({np.linalg.cond(inertia):.2g}) that rounding decides; give the links "
        "inertias, or leave Coulomb friction out"
    )


def _explained(inertia: Array, right: Array, dry: Array, pattern: Array) -> Array | None:
    """The accelerations of a pattern of -1, 0 and 1, (n,), if they agree with it."""
    free = (pattern != 0.0) | (dry == 0.0)
    a = np.zeros(len(right))
    if free.any():
        a[free] = np.linalg.solve(inertia[np.ix_(free, free)], (right - dry * pattern)[free])
    slides = free & (dry > 0.0)
    if not np.all(np.sign(a[slides]) == pattern[slides]):
        return None
    needed = np.abs(right - inertia @ a)[~free]
    slack = 1e-12 * (1.0 + np.abs(right).max())
    return a if np.all(needed <= dry[~free] + slack) else None


# -------- Five-bar


def _five_bar(
    linkage: FiveBar,
    q0: ArrayLike,
    v0: ArrayLike | None,
    torque: Torque | ArrayLike | None,
    times: Array,
) -> Simulation:
    chain = linkage.closed_chain()
    start = real_array(q0, f"{linkage.name}: q0")
    pose = (
        chain.assemble(start) if start.shape == (2,) else shaped(start, (4,), f"{linkage.name}: q0")
    )
    rates = real_array(np.zeros(4) if v0 is None else v0, f"{linkage.name}: v0")
    if rates.shape == (2,):
        rates = chain.projection(pose) @ rates
    driven = read_torque(torque, 2, linkage.name)
    ran = fivebar_simulation.follow(
        chain, pose, shaped(rates, (4,), f"{linkage.name}: v0"), times, driven
    )
    none = frozen(np.zeros(len(times)))
    return Simulation(
        name=linkage.name,
        t=frozen(ran.t),
        q=frozen(ran.q),
        v=frozen(ran.qd),
        a=frozen(ran.qdd),
        tau=frozen(ran.tau),
        energy=frozen(ran.energy),
        work=frozen(ran.work),
        loss=none,
        tool_work=none,
    )
