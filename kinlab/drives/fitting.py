"""One motor against what its duty asks, and the gear ratio that suits it.

Source: note 003 (003.speed for the bound on j, 003.IM for the range of I_M, 003.Tmax).
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass

import numpy as np

from kinlab.arrays import Array
from kinlab.drives.demand import Demand, gear_shares, root_mean_square
from kinlab.drives.motors import Motor
from kinlab.errors import MotorError

_RATIO_SPAN = 1e-3
"""Gear ratios are tried from this part of the bound up to the bound."""

_TIE = 1e-3
"""Margins that differ by less than this part are equal: the ratio is searched for to 1e-4."""

PeakTorque = Callable[[Motor, float], float]
"""Worst torque at the shaft of a motor with a gear ratio, N m."""


@dataclass(frozen=True)
class Duty:
    """What one drive must do, apart from the motor that does it.

    Attributes:
        rate: worst joint rate, rad/s.
        load_inertia: I_L, worst inertia at the joint without rotor, kg m².
        cycle: motion for the RMS torque; the worst of its joints counts.
        efficiency: of the gears.
        peak: worst torque at the motor's shaft.
        estimate: the same, quickly: the gear ratio is searched for with it.
    """

    rate: float
    load_inertia: float
    cycle: Demand
    efficiency: float
    peak: PeakTorque
    estimate: PeakTorque

    @staticmethod
    def of_cycle(cycle: Demand, load_inertia: float, efficiency: float) -> Duty:
        """The duty of a drive that does one motion only, of any arm."""

        def peak(motor: Motor, gear_ratio: float) -> float:
            return float(np.abs(cycle.at_motor(motor, gear_ratio, efficiency)).max())

        rate = float(cycle.peak_rate.max())
        return Duty(rate, load_inertia, cycle, efficiency, peak, peak)

    def rms(self, motor: Motor, gear_ratio: float) -> float:
        """Root mean square torque at the motor's shaft over the cycle, N m."""
        shaft = self.cycle.at_motor(motor, gear_ratio, self.efficiency)
        return float(root_mean_square(self.cycle.t, shaft).max())


@dataclass(frozen=True)
class MotorFit:
    """One motor with one gear ratio against what its duty asks.

    Attributes:
        motor: the motor.
        gear_ratio: j that was taken.
        gear_ratio_bound: largest j that N_max allows.
        inertia_range: I_L/(3 j²) and I_L/j² for I_M, kg m² (003.IM).
        inertia_ratio: I_L / (j² I_M); the note wants 1 to 3.
        peak: worst torque at the motor's shaft, rotor and gear losses included, N m.
        rms: at the motor's shaft over the duty's cycle, N m.
        speed: worst motor speed, r/min.
        margins: what the motor has over what is asked, by quantity; below 1 it fails.
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

    @property
    def margin(self) -> float:
        """The least of the margins."""
        return min(self.margins.values())

    @property
    def limits(self) -> tuple[str, ...]:
        """The quantities with the least margin: at the best gear ratio mostly two at once."""
        least = self.margin * (1.0 + _TIE)
        return tuple(name for name, margin in self.margins.items() if margin <= least)

    @property
    def limit(self) -> str:
        """The first of :attr:`limits`."""
        return self.limits[0]

    @property
    def fits(self) -> bool:
        """Every margin is at least 1."""
        return self.margin >= 1.0


def fit_motor(duty: Duty, motor: Motor, gear_ratio: float | None = None) -> MotorFit:
    """Compares one motor with a duty.

    Args:
        duty: what is asked.
        motor: needs max_speed, peak_torque, rated_torque and rotor_inertia.
        gear_ratio: j; none takes the one whose least margin is largest.

    Raises:
        MotorError: a figure is missing.
    """
    figures = {name: motor.need(name) for name in ("max_speed", "peak_torque", "rated_torque")}
    bound = np.pi * figures["max_speed"] / (30.0 * duty.rate)

    def margins(j: float, peak: float) -> dict[str, float]:
        return {
            "max speed": bound / j,
            "peak torque": figures["peak_torque"] / peak,
            "rated torque": figures["rated_torque"] / duty.rms(motor, j),
        }

    if gear_ratio is None:
        ratio = _largest(
            lambda j: min(margins(j, duty.estimate(motor, j)).values()), bound * _RATIO_SPAN, bound
        )
    else:
        ratio = gear_ratio
    peak = duty.peak(motor, ratio)
    inertia = duty.load_inertia / ratio**2
    return MotorFit(
        motor=motor,
        gear_ratio=ratio,
        gear_ratio_bound=bound,
        inertia_range=(inertia / 3.0, inertia),
        inertia_ratio=inertia / motor.need("rotor_inertia"),
        peak=peak,
        rms=duty.rms(motor, ratio),
        speed=ratio * duty.rate * 30.0 / np.pi,
        margins=margins(ratio, peak),
    )


def fit_motors(
    duty: Duty, motors: list[Motor], gear_ratio: float | None = None
) -> tuple[MotorFit, ...]:
    """As :func:`fit_motor` for several motors.

    Returns:
        The motors that fit first, the one of least peak torque first; then the others, the
        nearest to fitting first.
    """

    def rank(fit: MotorFit) -> tuple[bool, float]:
        return not fit.fits, fit.motor.need("peak_torque") if fit.fits else -fit.margin

    return tuple(sorted((fit_motor(duty, motor, gear_ratio) for motor in motors), key=rank))


def stretch_to_motor(
    moving: Demand, held: Demand, motor: Motor, gear_ratio: float, efficiency: float, name: str
) -> float:
    """By what factor a motion must take longer until a motor just follows it.

    Along a motion the torque at the shaft is g + d / lambda², with g what holds the weight, so
    each instant bounds lambda in closed form.

    Args:
        moving: the motion as it is.
        held: the same places at rest.
        motor: needs max_speed, peak_torque and rotor_inertia.
        gear_ratio: j.
        efficiency: of the gears.
        name: how the message calls the machine.

    Returns:
        lambda, at which N_max or the peak torque is reached; below 1 the motion may be faster.

    Raises:
        MotorError: the motor cannot hold the weight, or lacks a figure.
    """
    peak = motor.need("peak_torque")
    top = motor.need("max_speed") * np.pi / 30.0
    at_rest = float(np.abs(held.at_motor(motor, gear_ratio, efficiency)).max())
    if at_rest >= peak:
        raise MotorError(
            f"motor {motor.name!r} with gear ratio {gear_ratio:g} cannot hold {name}: "
            f"{at_rest:.4g} N m needed at rest, {peak:g} N m is its peak"
        )
    factors = [gear_ratio * float(moving.peak_rate.max()) / top]
    rotor = motor.need("rotor_inertia") * gear_ratio * moving.a
    for share in gear_shares(efficiency):
        weight = share * held.tau / gear_ratio
        motion = share * (moving.tau - held.tau - moving.rotor * moving.a) / gear_ratio + rotor
        factors.append(_until(peak, weight, motion))
    return max(factors)


def _until(peak: float, weight: Array, motion: Array) -> float:
    """The least lambda with |weight + motion / lambda²| <= peak everywhere."""
    size = np.abs(motion)
    left = (peak - np.sign(motion) * weight)[size > 0] / size[size > 0]
    return float(1.0 / np.sqrt(left.min())) if left.size else 0.0


def _largest(value: Callable[[float], float], low: float, high: float) -> float:
    """Where a function of one peak over a logarithmic range is largest, to 1e-4: golden section."""
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
