"""What a path asks of a five-bar's drives: motors for a cycle's time, and the time for a motor."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, replace
from pathlib import Path as File
from typing import TYPE_CHECKING

import numpy as np

from kinlab.arrays import Array, number
from kinlab.drives.cycles import Path
from kinlab.drives.demand import Demand
from kinlab.drives.fitting import Duty, MotorFit, fit_all, refuse_both, stretch_to_motor
from kinlab.drives.gears import Gearbox, gears_of
from kinlab.drives.motors import Motor, motors_of
from kinlab.drives.waypoints import Cycle
from kinlab.errors import (
    InertiaError,
    MotorError,
    OptionError,
    SingularError,
    UnreachableError,
    warn,
)
from kinlab.fivebar.arguments import HANGING, Mode
from kinlab.fivebar.dynamics import (
    bars_as_points,
    bars_without_mass,
    joint_mass,
    rod_model,
    tool_force,
    torques,
)
from kinlab.fivebar.geometry import Pose, ik, rate_bias, rate_matrix, solve_pose

if TYPE_CHECKING:
    from kinlab.fivebar.linkage import FiveBar

_SLOWEST = 64.0
"""How many times slower than its limits a cycle is tried."""

_STEPS = 30
"""Halvings of the range in which the fastest cycle lies: to 1e-9 of it."""


# -------- A path in joint coordinates


def follow(
    linkage: FiveBar,
    path: Path,
    mode: Mode = HANGING,
    model: str = "exact",
    margin: float = 0.02,
) -> Demand:
    """Crank motion, torques and power along a path in one working mode.

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
    pose = _regular_poses(linkage, path, mode, margin)
    jac, bias = rate_matrix(linkage, pose), rate_bias(linkage, pose, path.v)
    rate = np.einsum("nij,nj->ni", jac, path.v)
    theta_ddot = np.einsum("nij,nj->ni", jac, path.a) + bias
    tau = torques(linkage, pose, path.v, path.a, rod_model(linkage, model))
    if path.carried is not None:
        force = path.carried[:, None] * (path.a - linkage.gravity)
        tau = tau + tool_force(linkage, pose, force)
    theta = np.unwrap(ik(linkage, path.points, mode), axis=0)
    return Demand(path.t, theta, rate, theta_ddot, tau, linkage.reflected_inertia)


def _regular_poses(linkage: FiveBar, path: Path, mode: Mode, margin: float) -> Pose:
    """The poses along a path, refused where it cannot be followed; as :func:`follow`."""
    if not 0.0 <= margin < 1.0:
        raise OptionError(f"{linkage.name}: margin is {margin!r}; it must lie between 0 and 1")
    pose = solve_pose(linkage, path.points, mode, "mask")

    def place(k: int) -> str:
        x, y = path.points[k]
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


def fit_to_motor(
    linkage: FiveBar,
    path: Path,
    motor: Motor,
    gear_ratio: float,
    efficiency: float = 0.9,
    mode: Mode = HANGING,
) -> Path:
    """Stretches a path until a motor just follows it: N_max or peak torque is reached.

    Args:
        linkage: the five-bar; its own rotor inertia is left out in favour of the motor's.
        path: the tool's motion.
        motor: needs max_speed, peak_torque and rotor_inertia.
        gear_ratio: j.
        efficiency: of the gears, 0 to 1; see :meth:`kinlab.drives.demand.Demand.at_motor`.
        mode: signs of u_i x w_i.

    Raises:
        MotorError: the motor cannot hold the weight, or lacks a figure.
        UnreachableError, SingularError: as :func:`follow`.
    """
    moving, held = (follow(linkage, each, mode) for each in (path, path.held))
    return path.stretched(
        stretch_to_motor(moving, held, motor, gear_ratio, efficiency, linkage.name)
    )


# -------- A cycle

_MASSES = ("payload", "crank_mass", "crank_inertia", "rod_mass", "rod_inertia")


def require_masses(linkage: FiveBar, massless: bool) -> tuple[str, ...]:
    """Refuses a linkage whose bars have no mass where that was not said to be meant.

    Args:
        linkage: the five-bar.
        massless: bars without mass are meant.

    Returns:
        What the figures leave out: a sentence where bars have no mass.

    Raises:
        InertiaError: nothing at all to move, or bars without mass; says what to give.

    Warns:
        KinlabWarning: bars without mass, where they are meant.
    """
    if not any(np.any(getattr(linkage, name)) for name in _MASSES):
        raise InertiaError(
            f"{linkage.name}: nothing to move: no payload, mass or inertia is given, so no torque "
            "can be sized"
        )
    missing = bars_without_mass(linkage)
    if missing and not massless:
        raise InertiaError(
            f"{linkage.name}: {missing}; with_masses() and --crank-mass, --rod-mass take uniform "
            "bars; if bars without mass are meant, say so: massless=True, --massless"
        )
    for said in (missing, bars_as_points(linkage)):
        if said:
            warn(f"{linkage.name}: {said}")
    return (missing,) if missing else ()


@dataclass(frozen=True)
class CycleSizing:
    """What a cycle asks of the drives, and which meet it.

    Attributes:
        cycle: the cycle.
        mode: working mode.
        slower: by how much its limits of speed were divided.
        path: the tool's motion.
        demand: what the cranks do.
        load_inertia: worst inertia at a crank along the cycle, without rotor, kg m².
        fits: those that fit first.
    """

    cycle: Cycle
    mode: tuple[int, int]
    slower: float
    path: Path
    demand: Demand
    load_inertia: float
    fits: tuple[MotorFit, ...]

    @property
    def time(self) -> float:
        """Of one cycle, s."""
        return self.path.duration

    @property
    def short_list(self) -> tuple[MotorFit, ...]:
        """Those that meet every limit."""
        return tuple(fit for fit in self.fits if fit.fits)


def size_cycle(
    linkage: FiveBar,
    cycle: Cycle,
    time: float | None = None,
    *,
    motors: str | File | Motor | Sequence[Motor] | None = None,
    gears: str | File | Gearbox | Sequence[Gearbox] | None = None,
    gear_ratio: float | None = None,
    mode: Mode = HANGING,
    efficiency: float = 0.9,
    massless: bool = False,
) -> CycleSizing:
    """The motors, or pairs of motor and gearbox, that can do a cycle in a given time.

    Args:
        linkage: the five-bar; its rotors are left out in favour of the motors'.
        cycle: way points in the plane.
        time: of one cycle, s; none: as fast as the cycle's own limits allow.
        motors: a file, a motor or several; none: the shipped ones.
        gears: gearboxes likewise; none: for each motor the ratio of most margin, or gear_ratio.
        gear_ratio: j, where no gearboxes are given.
        mode: signs of u_i x w_i.
        efficiency: of the gears, where no gearboxes are given.
        massless: the linkage's bars are meant to have no mass.

    Raises:
        OptionError: a time that the cycle's limits do not allow; says which they do.
        UnreachableError, SingularError: the cycle leaves the workspace or meets a singularity;
            says where and when, and how far it must be moved.
        InertiaError: bars without mass, and ``massless`` not said. MotorError: a figure is missing.
    """
    refuse_both(gears, gear_ratio)
    require_masses(linkage, massless)
    return _sized(
        linkage, cycle, _slower(cycle, time), motors_of(motors), gears, gear_ratio, mode, efficiency
    )


def fastest_cycle(
    linkage: FiveBar,
    cycle: Cycle,
    motor: Motor,
    gear: Gearbox | float,
    *,
    mode: Mode = HANGING,
    efficiency: float = 0.9,
    massless: bool = False,
) -> CycleSizing:
    """The shortest time in which a motor with a gear can do a cycle.

    The limits of speed are divided by one factor and those of acceleration by its square until
    every limit of motor and gearbox is met; the dwells stay. The cycle's own limits are kept.

    Args:
        linkage, cycle, mode, massless: as :func:`size_cycle`.
        motor: needs max_speed, peak_torque, rated_torque and rotor_inertia.
        gear: a gearbox, or a ratio with ``efficiency``.
        efficiency: of the gear where only its ratio is given.

    Raises:
        MotorError: the pair cannot do the cycle at any speed; says which limit fails.
        MechanismError: and its kin, as :func:`size_cycle`.
    """
    require_masses(linkage, massless)
    gears = gear if isinstance(gear, Gearbox) else None
    ratio = None if isinstance(gear, Gearbox) else number(gear, "gear ratio", above=0.0)

    def at(slower: float) -> CycleSizing:
        return _sized(linkage, cycle, slower, [motor], gears, ratio, mode, efficiency)

    low, high = 1.0, 1.0
    found = at(high)
    while not found.short_list:
        if high >= _SLOWEST:
            why = ", ".join(str(check) for check in found.fits[0].failed)
            raise MotorError(
                f"{linkage.name}: motor {motor.name!r} with gear {found.fits[0].gear.name} cannot "
                f"do cycle {cycle.name!r} even {_SLOWEST:g} times slower: {why}"
            )
        low, high = high, 2.0 * high
        found = at(high)
    for _ in range(_STEPS if high > 1.0 else 0):
        middle = 0.5 * (low + high)
        trial = at(middle)
        if trial.short_list:
            high, found = middle, trial
        else:
            low = middle
    return found


def _slower(cycle: Cycle, time: float | None) -> float:
    if time is None:
        return 1.0
    asked = number(time, f"cycle {cycle.name!r}: time", above=0.0)
    fastest = cycle.path().duration
    slower = (asked - cycle.dwell) / (fastest - cycle.dwell)
    if slower < 1.0 - 1e-12:
        raise OptionError(
            f"cycle {cycle.name!r} takes at least {fastest:.4g} s within its limits of speed and "
            f"acceleration ({cycle.dwell:.4g} s of it at rest); {asked:g} s are asked"
            + (f", which takes {1 / slower:.3g} times the speed" if slower > 0.0 else "")
        )
    return max(slower, 1.0)


def _sized(
    linkage: FiveBar,
    cycle: Cycle,
    slower: float,
    motors: list[Motor],
    gears: str | File | Gearbox | Sequence[Gearbox] | None,
    gear_ratio: float | None,
    mode: Mode,
    efficiency: float,
) -> CycleSizing:
    if len(cycle.points[0].at) != 2:
        raise OptionError(f"cycle {cycle.name!r} has points in space; a five-bar moves in a plane")
    path = cycle.path(slower)
    bare = replace(linkage, rotor_inertia=0.0)
    try:
        demand = follow(bare, path, mode)
    except (UnreachableError, SingularError) as problem:
        raise type(problem)(f"{problem}; {_shift(bare, path, mode)}") from None
    inertia = _load_inertia(bare, path, mode)
    duty = Duty.of_cycle(demand, inertia, efficiency)
    fits = fit_all(duty, motors, None if gears is None else gears_of(gears), gear_ratio)
    signs = int(mode[0]), int(mode[1])
    return CycleSizing(cycle, signs, slower, path, demand, inertia, fits)


def _load_inertia(linkage: FiveBar, path: Path, mode: Mode) -> float:
    """The worst diagonal entry of the mass matrix, with what is carried as payload."""
    pose = solve_pose(linkage, path.points, mode)
    carried = np.zeros(len(path.t)) if path.carried is None else path.carried
    worst = 0.0
    for mass in np.unique(carried):
        loaded = replace(linkage, payload=linkage.payload + float(mass))
        matrix = joint_mass(loaded, pose, rod_model(loaded, "exact"))
        at = np.einsum("nii->ni", matrix)[carried == mass]
        worst = max(worst, float(at.max()))
    return worst


def _shift(linkage: FiveBar, path: Path, mode: Mode) -> str:
    """The nearest place to which the cycle can be moved as a whole, in words."""
    few = slice(None, None, max(1, len(path.t) // 200))
    points, still = path.points[few], np.zeros_like(path.points[few])
    angles = np.linspace(-np.pi, np.pi, 48, endpoint=False)
    directions = np.stack([np.cos(angles), np.sin(angles)], axis=1)

    def works(shift: Array) -> bool:
        try:
            follow(linkage, Path(path.t[few], points + shift, still, still), mode)
        except (UnreachableError, SingularError):
            return False
        return True

    size = float(np.sum(linkage.l1) + np.sum(linkage.l2))
    for distance in np.geomspace(1e-3, 1.0, 40) * size:
        for way in directions:
            if works(distance * way):
                x, y = (round(float(value), 9) + 0.0 for value in distance * way)
                return f"moved as a whole by ({x:.3g}, {y:.3g}) m it can be done"
    wide = np.ptp(path.points, axis=0)
    return (
        f"there is no place for a cycle of {wide[0]:.3g} x {wide[1]:.3g} m in mode {tuple(mode)}; "
        "largest_rectangle() gives the room that there is"
    )
