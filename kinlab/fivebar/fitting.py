"""One motor against what a task asks of it, and the gear ratio that suits it.

Source: note 003 (003.speed for the bound on j, 003.IM for the range of I_M, 003.Tmax).
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass, replace

import numpy as np

from kinlab.arrays import Array
from kinlab.drives.motors import Motor
from kinlab.fivebar.demand import grid_of, torque_forms, turn_forms, worst
from kinlab.fivebar.dynamics import rod_model
from kinlab.fivebar.linkage import Linkage
from kinlab.fivebar.pose import Mode, Pose, solve_pose
from kinlab.fivebar.trajectory import Cycle, mean_square, motor_torques
from kinlab.fivebar.workspace import Rectangle

_RATIO_SPAN = 1e-3
"""Gear ratios are tried from this part of the bound up to the bound."""


@dataclass(frozen=True)
class Task:
    """What the drives must do, and the demands that do not depend on the motor.

    Attributes:
        linkage: the five-bar; its own rotor inertia is replaced by each motor's.
        box: workspace. mode: working mode.
        v_max: m/s. a_max: m/s².
        efficiency: of the gears.
        rate: worst crank rate, rad/s.
        load_inertia: I_L, worst diagonal of the mass matrix without rotor, kg m².
        cycle: pick-and-place cycle for the RMS torque.
    """

    linkage: Linkage
    box: Rectangle
    mode: Mode
    v_max: float
    a_max: float
    efficiency: float
    rate: float
    load_inertia: float
    cycle: Cycle


@dataclass(frozen=True)
class MotorFit:
    """One motor with one gear ratio against what the task asks.

    Attributes:
        motor: the motor.
        gear_ratio: j that was taken.
        gear_ratio_bound: largest j that N_max allows.
        inertia_range: I_L/(3 j²) and I_L/j² for I_M, kg m² (003.IM).
        inertia_ratio: I_L / (j² I_M); the note wants 1 to 3.
        peak: worst torque at the motor, everything included, N m.
        rms: over the pick-and-place cycle, N m.
        speed: worst motor speed, r/min.
        margins: what the motor has over what is asked, by quantity; below 1 it fails.
        limit: the quantity with the least margin.
    """

    motor: Motor
    gear_ratio: float
    gear_ratio_bound: float
    inertia_range: tuple[float, float]
    inertia_ratio: float
    peak: float
    rms: float
    speed: float
    margins: dict[str, float]
    limit: str

    @property
    def margin(self) -> float:
        """The least of the margins."""
        return self.margins[self.limit]

    @property
    def fits(self) -> bool:
        """Every margin is at least 1."""
        return self.margin >= 1.0


def fit_motor(task: Task, motor: Motor, gear_ratio: float | None) -> MotorFit:
    """Compares one motor with a task.

    Args:
        task: the demands.
        motor: needs max_speed, peak_torque, rated_torque and rotor_inertia.
        gear_ratio: j; none takes the one whose least margin is largest.

    Raises:
        MotorError: a figure is missing.
    """
    figures = {name: motor.need(name) for name in ("max_speed", "peak_torque", "rated_torque")}
    bound = np.pi * figures["max_speed"] / (30.0 * task.rate)
    coarse = solve_pose(task.linkage, grid_of(task.box), task.mode)
    at_grid = _peak_at(task, motor, coarse)

    def margins(j: float, peak: float) -> dict[str, float]:
        return {
            "max speed": bound / j,
            "peak torque": figures["peak_torque"] / peak,
            "rated torque": figures["rated_torque"] / _rms(task, motor, j),
        }

    def least(j: float) -> float:
        return min(margins(j, float(at_grid(j).max())).values())

    ratio = _golden(least, bound * _RATIO_SPAN, bound) if gear_ratio is None else gear_ratio

    def everywhere(pose: Pose) -> Array:
        return _peak_at(task, motor, pose)(ratio)

    peak = worst(task.linkage, task.box, task.mode, everywhere).largest
    found = margins(ratio, peak)
    inertia = task.load_inertia / ratio**2
    return MotorFit(
        motor=motor,
        gear_ratio=ratio,
        gear_ratio_bound=bound,
        inertia_range=(inertia / 3.0, inertia),
        inertia_ratio=inertia / motor.need("rotor_inertia"),
        peak=peak,
        rms=_rms(task, motor, ratio),
        speed=ratio * task.rate * 30.0 / np.pi,
        margins=found,
        limit=min(found, key=lambda name: found[name]),
    )


def _peak_at(task: Task, motor: Motor, pose: Pose) -> Callable[[float], Array]:
    """Worst motor torque (N, 2) at some poses as a function of the gear ratio."""
    bare = replace(task.linkage, rotor_inertia=0.0)
    load = torque_forms(bare, pose, rod_model(bare, "exact"))
    turn = turn_forms(bare, pose)
    rotor = motor.need("rotor_inertia")
    return lambda j: load.plus(turn, 1.0 / (j * task.efficiency), rotor * j).peak(
        task.v_max, task.a_max
    )


def _rms(task: Task, motor: Motor, j: float) -> float:
    shaft = motor_torques(task.linkage, task.cycle, motor, j, task.efficiency)
    return float(mean_square(task.cycle.path.t, shaft).max())


def _golden(value: Callable[[float], float], low: float, high: float) -> float:
    """Where a function of one peak over a logarithmic range is largest, to 1e-4."""
    part = 0.5 * (np.sqrt(5.0) - 1.0)
    a, b = np.log(low), np.log(high)
    c, d = b - part * (b - a), a + part * (b - a)
    at_c, at_d = value(np.exp(c)), value(np.exp(d))
    while b - a > 1e-4:
        if at_c > at_d:
            b, d, at_d = d, c, at_c
            c = b - part * (b - a)
            at_c = value(np.exp(c))
        else:
            a, c, at_c = c, d, at_d
            d = a + part * (b - a)
            at_d = value(np.exp(d))
    return float(np.exp(0.5 * (a + b)))
