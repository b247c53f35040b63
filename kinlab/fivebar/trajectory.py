"""The pick-and-place cycle: up, across, down, and back, with blended corners.

The standard test of fast parallel robots is 25 mm up, 305 mm across, 25 mm down (the Adept
cycle). Each leg of it follows 10 tau³ - 15 tau⁴ + 6 tau⁵, and neighbours overlap in time, which
rounds the corners: position, velocity and acceleration are continuous.

Time may be stretched uniformly: by lambda, velocities fall as 1/lambda and accelerations as
1/lambda², so the fastest cycle within limits follows in closed form from one evaluation.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import ArrayLike

from kinlab.arrays import Array, shaped
from kinlab.drives.motors import Motor
from kinlab.errors import MotorError, OptionError, SingularError, UnreachableError
from kinlab.fivebar.dynamics import rod_model, torques
from kinlab.fivebar.geometry import ik, rate_bias, rate_matrix
from kinlab.fivebar.linkage import Linkage
from kinlab.fivebar.pose import HANGING, Mode, Pose, solve_pose

LIFT, TRAVEL = 0.025, 0.305
"""The Adept cycle, m."""

_PEAK_SPEED = 1.875
_PEAK_ACCELERATION = 10.0 / np.sqrt(3.0)
"""Peaks of the fifth-degree law over 1 m in 1 s."""


@dataclass(frozen=True)
class Path:
    """A motion of the tool: (K,) times and (K, 2) positions, velocities, accelerations, SI."""

    t: Array
    xy: Array
    v: Array
    a: Array

    @property
    def duration(self) -> float:
        """s."""
        return float(self.t[-1])

    def stretched(self, factor: float) -> Path:
        """The same way in ``factor`` times the time."""
        return Path(self.t * factor, self.xy, self.v / factor, self.a / factor**2)


@dataclass(frozen=True)
class Cycle:
    """A path with what the cranks do along it.

    Attributes:
        path: the tool's motion.
        theta, theta_dot, theta_ddot: cranks, (K, 2), rad, rad/s, rad/s².
        tau: crank torques, (K, 2), N m.
        power: tau_i theta_dot_i, (K, 2), W.
    """

    path: Path
    theta: Array
    theta_dot: Array
    theta_ddot: Array
    tau: Array
    power: Array

    @property
    def peak_torque(self) -> Array:
        """(2,), N m."""
        return np.asarray(np.abs(self.tau).max(axis=0))

    @property
    def rms_torque(self) -> Array:
        """Root mean square over the cycle, (2,), N m."""
        return mean_square(self.path.t, self.tau)

    @property
    def peak_power(self) -> Array:
        """(2,), W."""
        return np.asarray(np.abs(self.power).max(axis=0))

    @property
    def rms_power(self) -> Array:
        """Root mean square over the cycle, (2,), W."""
        return mean_square(self.path.t, self.power)


def mean_square(t: Array, values: Array) -> Array:
    """Square root of the mean over time of the squares, by trapezoids, (2,)."""
    area = np.trapezoid(np.square(values), t, axis=0)
    return np.asarray(np.sqrt(area / (t[-1] - t[0])))


def pick_and_place(
    centre: ArrayLike,
    v_max: float,
    a_max: float,
    lift: float = LIFT,
    travel: float = TRAVEL,
    blend: float = 0.5,
    samples: int = 2001,
) -> Path:
    """The cycle there and back, as fast as the tool's limits allow.

    Args:
        centre: the middle between pick and place, (2,), m; the lift goes up from there, +y.
        v_max: largest speed of the tool, m/s. a_max: largest acceleration, m/s².
        lift: m. travel: along x, m.
        blend: part of the shorter neighbour that overlaps at a corner, 0 (stop there) to 1.
        samples: points of the whole cycle.

    Returns:
        A path that reaches one of the two limits exactly and keeps the other.

    Raises:
        OptionError: a limit or length that is not positive, a blend outside 0 to 1.
    """
    middle = shaped(centre, (2,), "cycle: centre")
    for name, value in (("v_max", v_max), ("a_max", a_max), ("lift", lift), ("travel", travel)):
        if not (np.isfinite(value) and value > 0):
            raise OptionError(f"cycle: {name} is {value!r}; it must be positive")
    if not 0.0 <= blend <= 1.0:
        raise OptionError(f"cycle: blend is {blend!r}; it must lie between 0 and 1")
    if samples < 101:
        raise OptionError(f"cycle: samples is {samples}; it must be at least 101")
    lengths = np.array([lift, travel, lift])
    spans = np.maximum(_PEAK_SPEED * lengths / v_max, np.sqrt(_PEAK_ACCELERATION * lengths / a_max))
    starts = np.concatenate(
        [[0.0], np.cumsum(spans[:-1] - blend * np.minimum(spans[:-1], spans[1:]))]
    )
    half = float((starts + spans).max())
    there = np.array([[0.0, lift], [travel, 0.0], [0.0, -lift]])
    moves = np.concatenate([there, there * [-1.0, 1.0]])
    path = _superpose(
        middle - [0.5 * travel, 0.0],
        moves,
        np.concatenate([starts, starts + half]),
        np.concatenate([spans, spans]),
        np.linspace(0.0, 2.0 * half, samples),
    )
    fastest = np.linalg.norm(path.v, axis=1).max() / v_max
    hardest = np.sqrt(np.linalg.norm(path.a, axis=1).max() / a_max)
    return path.stretched(float(max(fastest, hardest)))


def _superpose(start: Array, moves: Array, begins: Array, spans: Array, t: Array) -> Path:
    tau = np.clip((t[:, None] - begins) / spans, 0.0, 1.0)
    s = tau**3 * (10.0 - 15.0 * tau + 6.0 * tau**2)
    s1 = 30.0 * tau**2 * (1.0 - tau) ** 2 / spans
    s2 = 60.0 * tau * (1.0 - tau) * (1.0 - 2.0 * tau) / spans**2
    return Path(t, start + s @ moves, s1 @ moves, s2 @ moves)


def follow(
    linkage: Linkage,
    path: Path,
    mode: Mode = HANGING,
    model: str = "exact",
    margin: float = 0.02,
) -> Cycle:
    """Joint motion, torques and power along a path in one working mode.

    Args:
        linkage: the five-bar.
        path: the tool's motion.
        mode: signs of u_i x w_i.
        model: a rod model.
        margin: least sine allowed between two bars that must not get in line.

    Raises:
        UnreachableError: the path leaves the workspace; says when and where.
        SingularError: it meets or crosses a singularity; says when and where.
    """
    pose = sound_poses(linkage, path, mode, margin)
    jac, bias = rate_matrix(linkage, pose), rate_bias(linkage, pose, path.v)
    rate = np.einsum("nij,nj->ni", jac, path.v)
    turn = np.einsum("nij,nj->ni", jac, path.a) + bias
    tau = torques(linkage, pose, path.v, path.a, rod_model(linkage, model))
    theta = np.unwrap(ik(linkage, path.xy, mode), axis=0)
    return Cycle(path, theta, rate, turn, tau, tau * rate)


def sound_poses(linkage: Linkage, path: Path, mode: Mode, margin: float) -> Pose:
    """The poses along a path, refused where it cannot be followed; as :func:`follow`."""
    if not 0.0 <= margin < 1.0:
        raise OptionError(f"{linkage.name}: margin is {margin!r}; it must lie between 0 and 1")
    pose = solve_pose(linkage, path.xy, mode, "mask")

    def place(k: int) -> str:
        x, y = path.xy[k]
        return f"{linkage.name}: the path at t = {path.t[k]:.4g} s, ({x:.6g}, {y:.6g}) m"

    if not pose.ok.all():
        raise UnreachableError(f"{place(int(np.argmin(pose.ok)))}, leaves the workspace")
    legs = np.abs(pose.sine).min(axis=1)
    if legs.min() <= margin:
        k = int(np.argmax(legs <= margin))
        leg = int(np.abs(pose.sine[k]).argmin()) + 1
        raise SingularError(
            f"{place(k)}, meets a singularity of type I: sine {legs[k]:.3g} between the bars of "
            f"leg {leg}, at most {margin:g} away"
        )
    rods = pose.rods * np.sign(pose.rods[0])
    if rods.min() <= margin:
        k = int(np.argmax(rods <= margin))
        raise SingularError(
            f"{place(k)}, meets a singularity of type II: w1 x w2 = {pose.rods[k]:.3g}, at most "
            f"{margin:g} away or past it"
        )
    return pose


def motor_torques(
    linkage: Linkage, cycle: Cycle, motor: Motor, gear_ratio: float, efficiency: float
) -> Array:
    """Torque at the motors' shafts along a cycle, (K, 2), N m.

    tau_load / (j efficiency) + I_M j theta_ddot: the load passes the gear and pays its losses in
    both directions of power, the rotor does not. While the load drives the motor its true part is
    tau_load efficiency / j; counting more is on the safe side except where the rotor's torque is
    opposite to the load's and larger, as in hard braking of a large rotor.

    Args:
        linkage: the five-bar; its own rotor inertia is left out in favour of the motor's.
        cycle: from :func:`follow` on that linkage.
        motor: needs a rotor inertia.
        gear_ratio: j.
        efficiency: of the gear.
    """
    own = np.square(linkage.gear_ratio) * np.asarray(linkage.rotor_inertia)
    load = cycle.tau - own * cycle.theta_ddot
    rotor = motor.need("rotor_inertia") * gear_ratio * cycle.theta_ddot
    return np.asarray(load / (gear_ratio * efficiency) + rotor)


def fit_to_motor(
    linkage: Linkage,
    path: Path,
    motor: Motor,
    gear_ratio: float,
    efficiency: float = 0.9,
    mode: Mode = HANGING,
) -> Path:
    """Stretches a path until a motor just follows it: N_max or peak torque is reached.

    Along a path the motor's torque is g + d / lambda² with g what holds the weight, so each
    sample bounds lambda in closed form.

    Raises:
        MotorError: the motor cannot hold the weight, or lacks a figure.
        UnreachableError, SingularError: as :func:`follow`.
    """
    cycle = follow(linkage, path, mode)
    still = Path(path.t, path.xy, np.zeros_like(path.v), np.zeros_like(path.a))
    held = motor_torques(linkage, follow(linkage, still, mode), motor, gear_ratio, efficiency)
    moving = motor_torques(linkage, cycle, motor, gear_ratio, efficiency) - held
    peak = motor.need("peak_torque")
    if np.abs(held).max() >= peak:
        raise MotorError(
            f"motor {motor.name!r} with gear ratio {gear_ratio:g} cannot hold {linkage.name}: "
            f"{np.abs(held).max():.4g} N m needed at rest, {peak:g} N m is its peak"
        )
    size = np.abs(moving)
    share = (peak - np.sign(moving) * held)[size > 0] / size[size > 0]
    by_torque = 1.0 / np.sqrt(share.min()) if share.size else 0.0
    top = motor.need("max_speed") * np.pi / 30.0
    by_speed = gear_ratio * np.abs(cycle.theta_dot).max() / top
    return path.stretched(float(max(by_torque, by_speed)))
