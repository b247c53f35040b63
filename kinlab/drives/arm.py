"""Drives of a serial arm: what a motion asks of each joint, and the motors and gears that do it.

Each joint has a drive of its own. A rotor with its gear's ratio j adds j² I to its own joint and to
no other, which is what an armature is: so the torque at a shaft is exact for each motor and ratio,
without iterating. The masses of motors are not added to the links: they are part of the arm's
table, or of a payload.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, field
from pathlib import Path
from typing import Any, Protocol

import numpy as np
from numpy.typing import ArrayLike

from kinlab.arrays import Array, number
from kinlab.drives.demand import Demand
from kinlab.drives.fitting import Duty, MotorFit, fit_all, refuse_both
from kinlab.drives.gears import Drive, Gearbox, gears_of
from kinlab.drives.motors import Motor, find_motor, motors_of
from kinlab.engine.dynamics import inverse_dynamics, mass_matrix
from kinlab.errors import MotorError, OptionError, StructureError
from kinlab.host.evidence import Evidence
from kinlab.host.introductions import Told
from kinlab.model.library import ArmLike, as_robot
from kinlab.model.robot import Robot, require_inertia
from kinlab.tolerances import TOLERANCES

_FIRST, _MOST = 2_000, 400_000
"""Instants of the first grid over a motion, and of the last."""


class JointMotion(Protocol):
    """What :class:`kinlab.motion.Motion` offers to sizing."""

    @property
    def knots(self) -> Array:
        """Times where pieces meet, (M+1,), s."""

    def at(self, t: ArrayLike) -> tuple[Array, Array, Array]:
        """Joint positions, velocities and accelerations at times."""


@dataclass(frozen=True, repr=False)
class ArmSizing(Told):
    """What a motion asks of the drives of an arm, joint by joint.

    Attributes:
        robot: its name. joints: their names.
        demand: motion and torques on the joints' side; friction and the arm's own armatures are
            in the torques.
        load_inertia: largest M_ii on the way, armature left out, (n,), kg m² (kg).
        fits: for each joint its drives: those that fit first, the one of least peak torque first.
        resolution: relative change of the RMS torques when the grid of instants was last halved:
            what the figures of the demand are good for.
    """

    robot: str
    joints: tuple[str, ...]
    demand: Demand
    load_inertia: Array
    fits: tuple[tuple[MotorFit, ...], ...]
    resolution: float = field(repr=False)

    @property
    def evidence(self) -> Evidence:
        """At how many instants the motion was looked at, and what that makes of its figures."""
        return Evidence(
            f"{len(self.demand.t):,} instants of the motion; every motor of the catalogue",
            proved="",
            found=f"RMS torques to {self.resolution:.1g} of the largest; peaks at those instants; "
            "of a gear of any make the ratio of most margin",
        )

    @property
    def chosen(self) -> tuple[MotorFit | None, ...]:
        """The first drive that fits of each joint; ``None`` where none does."""
        return tuple(next((fit for fit in fits if fit.fits), None) for fits in self.fits)

    def at_shafts(self) -> tuple[Array, Array]:
        """Speed, r/min, and torque, N m, at the shafts of the drives that stand first, (K, n).

        Where a joint has none that fits, the one nearest to fitting.
        """
        speeds, torques = [], []
        for joint, fits in enumerate(self.fits):
            drive = Drive(fits[0].motor, fits[0].gear)
            axis = self.demand.axis(joint)
            speeds.append(axis.v[:, 0] * drive.gear.ratio * 30.0 / np.pi)
            torques.append(axis.at_shaft(drive)[:, 0])
        return np.stack(speeds, axis=1), np.stack(torques, axis=1)

    def __str__(self) -> str:
        without = [name for name, one in zip(self.joints, self.chosen, strict=True) if one is None]
        verdict = f"no drive fits {', '.join(without)}" if without else "a drive fits every joint"
        lines = [f"robot {self.robot!r}: {verdict}, for a motion of {self.demand.t[-1]:.4g} s"]
        demand = self.demand
        for joint, (name, fits) in enumerate(zip(self.joints, self.fits, strict=True)):
            asked = (
                f"peak {demand.peak_torque[joint]:.4g}, RMS {demand.rms_torque[joint]:.4g}, "
                f"speed {demand.peak_rate[joint]:.4g}, power {demand.peak_power[joint]:.4g} W"
            )
            first = fits[0]
            what = f"{first.motor.name}, gear {first.gear_ratio:.4g}"
            if first.fits:
                verdict = f"{what}, inertia ratio {first.inertia_ratio:.3g}"
            else:
                failing = "; ".join(str(limit) for limit in first.failed)
                verdict = f"none fits; nearest {what}: {failing}"
            lines.append(f"  {name}: {asked}: {verdict}")
        return "\n".join(lines)


def size_servos(
    robot: ArmLike,
    motion: JointMotion,
    motors: str | Path | Motor | Sequence[str | Motor] | None = None,
    gears: str | Path | Gearbox | Sequence[Gearbox] | None = None,
    gear_ratio: float | None = None,
    efficiency: float = 0.9,
    wrench: ArrayLike | None = None,
) -> ArmSizing:
    """Sizes a drive for each joint of an arm from one motion.

    Args:
        robot: the arm, with masses; a payload is part of it.
        motion: of :mod:`kinlab.motion`; ``kl.motion.from_samples`` makes one of arrays.
        motors: a catalogue (.toml or .csv), one motor or several, by name or as data; none tries
            the shipped ones.
        gears: gearboxes that can be bought, as a catalogue or as data: every motor is tried behind
            each. Left out, a gear of any make with the ``efficiency``.
        gear_ratio: j of every joint, motor turns per joint turn (rad/m of a sliding joint); left
            out, for each motor the one of most margin. Not together with ``gears``.
        efficiency: of a gear of any make (without ``gears``), above 0, at most 1.
        wrench: (f, n) that the tool exerts all the way, (6,), as for
            :func:`kinlab.inverse_dynamics`.

    Returns:
        Torque, speed and power over the motion, and the drives of each joint. The steps between
        instants are halved until the RMS torques change by no more than 2e-7 of the largest, or
        there are 400,000 of them; ``resolution`` is the last change. Peaks are those of the
        instants.

    Raises:
        StructureError: a motion of another number of joints, or no motion.
        MotorError: a motor lacks a figure. InertiaError: the arm has no masses.
        OptionError: an option that cannot be used. FileError: as of the catalogues.
    """
    robot = as_robot(robot)
    require_inertia(robot)
    if not hasattr(motion, "at") or not hasattr(motion, "knots"):
        raise StructureError(
            f"robot {robot.name!r}: motion is a {type(motion).__name__}; kl.motion.joint, "
            ".cartesian and .from_samples make one"
        )
    share = number(efficiency, "efficiency", above=0.0)
    if share > 1.0:
        raise OptionError(f"efficiency is {share:g}; it must lie in (0, 1]")
    ratio = None if gear_ratio is None else number(gear_ratio, "gear_ratio", above=0.0)
    refuse_both(gears, ratio)
    tried, boxes = motors_of(_named(motors)), None if gears is None else gears_of(gears)
    demand, resolution = demand_of(robot, motion, wrench)
    armature = np.array(robot.model.armature)
    inertia = np.einsum("nii->ni", mass_matrix(robot, demand.q)).max(axis=0) - armature
    fits = []
    for joint in range(robot.n):
        axis = demand.axis(joint)
        duty = Duty.of_cycle(axis, float(inertia[joint]), share)
        try:
            fits.append(fit_all(duty, tried, boxes, ratio))
        except MotorError as problem:
            raise MotorError(f"{robot.joint_names[joint]}: {problem}") from None
    return ArmSizing(robot.name, robot.joint_names, demand, inertia, tuple(fits), resolution)


def demand_of(
    robot: Robot, motion: JointMotion, wrench: ArrayLike | None = None
) -> tuple[Demand, float]:
    """Torques over a motion, at instants laid ever more densely until the RMS stands still.

    Returns:
        The demand, and by what part the RMS torques changed at the last halving of the steps.

    Raises:
        StructureError: a motion of another number of joints.
    """
    knots = np.asarray(motion.knots)
    if motion.at(knots[:1])[0].shape[1] != robot.n:
        raise StructureError(f"robot {robot.name!r} has {robot.n} joints; the motion has others")
    count = max(8, _FIRST // (len(knots) - 1))
    before: Array | None = None
    while True:
        demand = _at_instants(robot, motion, knots, count, wrench)
        rms = demand.rms_torque
        size = float(rms.max()) or 1.0
        if before is not None:
            change = float(np.abs(rms - before).max()) / size
            if change <= TOLERANCES.rms_settles or len(demand.t) > _MOST:
                return demand, change
        before, count = rms, 2 * count


def _at_instants(
    robot: Robot, motion: JointMotion, knots: Array, count: int, wrench: ArrayLike | None
) -> Demand:
    """The demand with ``count`` steps in each piece of the motion."""
    part = np.linspace(0.0, 1.0, count + 1)
    part[0], part[-1] = TOLERANCES.inside_piece, 1.0 - TOLERANCES.inside_piece
    t = (knots[:-1, np.newaxis] + np.diff(knots)[:, np.newaxis] * part).ravel()
    q, v, a = motion.at(t)
    tau = inverse_dynamics(robot, q, v, a, wrench, friction=True)
    return Demand(t, q, v, a, tau, np.array(robot.model.armature))


def _named(motors: Any) -> Any:
    """The same with the shipped motors in place of their names; files stay names of files."""
    if isinstance(motors, str) and not motors.lower().endswith((".toml", ".csv")):
        return find_motor(motors)
    if isinstance(motors, Sequence) and not isinstance(motors, str):
        return [find_motor(one) if isinstance(one, str) else one for one in motors]
    return motors
