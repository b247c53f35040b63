"""Motors and gears against what a duty asks: pairs that can be bought, or the ratio that suits.

Source: note 003 (003.speed for the bound on j, 003.IM for the range of I_M, 003.Tmax).
"""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass

import numpy as np

from kinlab.arrays import Array
from kinlab.drives.demand import Demand, cubic_mean, mean_size, root_mean_square
from kinlab.drives.gears import Drive, Gearbox, ideal_gear
from kinlab.drives.motors import Motor
from kinlab.errors import MotorError, OptionError
from kinlab.tolerances import TOLERANCES

PeakTorque = Callable[[Sequence[Drive]], Array]
"""Worst torque at the shaft of each of several drives, (D,), N m."""


@dataclass(frozen=True)
class Duty:
    """What one drive must do, apart from the motor that does it.

    Attributes:
        rate: worst joint rate, rad/s.
        load_inertia: I_L, worst inertia at the joint without rotor, kg m².
        cycle: motion for the RMS torque; the worst of its joints counts.
        efficiency: of the gears, where none in particular is named.
        peak: worst torque at the motors' shafts.
        estimate: the same, quickly: the gear ratio is searched for with it.
        load_torque: worst torque at the output of a gearbox, N m.
    """

    rate: float
    load_inertia: float
    cycle: Demand
    efficiency: float
    peak: PeakTorque
    estimate: PeakTorque
    load_torque: float

    @staticmethod
    def of_cycle(cycle: Demand, load_inertia: float, efficiency: float = 1.0) -> Duty:
        """The duty of a drive that does one motion only, of any arm.

        Args:
            cycle: the motion; ``cycle.axis(k)`` where each joint has a drive of its own.
            load_inertia: worst inertia at the joint without rotor, kg m².
            efficiency: of the gears, where none in particular is named.
        """

        def peak(drives: Sequence[Drive]) -> Array:
            return np.array([np.abs(cycle.bound_at(drive)).max() for drive in drives])

        rate, load = float(cycle.peak_rate.max()), float(np.abs(cycle.load).max())
        return Duty(rate, load_inertia, cycle, efficiency, peak, peak, load)

    def rms(self, motor: Motor, gear_ratio: float) -> float:
        """Root mean square torque at the motor's shaft over the cycle, N m: a bound."""
        shaft = self.cycle.at_motor(motor, gear_ratio, self.efficiency)
        return float(root_mean_square(self.cycle.t, shaft).max())

    def mean_load(self) -> float:
        """What a gearbox's nominal torque stands against: RMS or cubic mean, N m."""
        cycle = self.cycle
        means = (root_mean_square(cycle.t, cycle.load), cubic_mean(cycle.t, cycle.load, cycle.v))
        return float(np.max(means))


@dataclass(frozen=True)
class Limit:
    """One figure of a motor or gearbox against what is asked of it.

    Attributes:
        name: such as ``"peak torque"`` or ``"gear mean torque"``.
        asked: what the duty asks. allowed: what the maker permits.
        unit: of both.
    """

    name: str
    asked: float
    allowed: float
    unit: str

    @property
    def margin(self) -> float:
        """allowed / asked: below 1 the limit fails."""
        return self.allowed / self.asked if self.asked > 0.0 else np.inf

    def __str__(self) -> str:
        return f"{self.name} {self.asked:.4g} of {self.allowed:.4g} {self.unit}"


@dataclass(frozen=True)
class MotorFit:
    """One motor with one gear against what its duty asks.

    Attributes:
        motor: the motor.
        gear: the gearbox; one of any make where only a ratio was looked for.
        gear_ratio_bound: largest j that N_max allows.
        inertia_range: I_L/(3 j²) and I_L/j² for I_M, kg m² (003.IM).
        inertia_ratio: I_L / (j² (I_M + I_G)); the note wants 1 to 3.
        peak: worst torque at the motor's shaft, rotor and gear losses included, N m.
        rms: at the motor's shaft over the duty's cycle, N m.
        speed: worst motor speed, r/min.
        checks: every limit with what is asked of it.
    """

    motor: Motor
    gear: Gearbox
    gear_ratio_bound: float
    inertia_range: tuple[float, float]
    inertia_ratio: float
    peak: float
    rms: float
    speed: float
    checks: tuple[Limit, ...]

    @property
    def gear_ratio(self) -> float:
        """j that was taken."""
        return self.gear.ratio

    @property
    def margins(self) -> dict[str, float]:
        """What the drive has over what is asked, by quantity; below 1 it fails."""
        return {check.name: check.margin for check in self.checks}

    @property
    def margin(self) -> float:
        """The least of the margins."""
        return min(self.margins.values())

    @property
    def limits(self) -> tuple[str, ...]:
        """The quantities with the least margin: at the best gear ratio mostly two at once."""
        least = self.margin * (1.0 + TOLERANCES.equal_margins)
        return tuple(name for name, margin in self.margins.items() if margin <= least)

    @property
    def limit(self) -> str:
        """The first of :attr:`limits`."""
        return self.limits[0]

    @property
    def fits(self) -> bool:
        """Every margin is at least 1."""
        return self.margin >= 1.0

    @property
    def failed(self) -> tuple[Limit, ...]:
        """The limits that are exceeded, the worst first."""
        return tuple(sorted((c for c in self.checks if c.margin < 1.0), key=lambda c: c.margin))

    @property
    def unstated(self) -> tuple[str, ...]:
        """Limits of the gearbox that its record does not state, so that nothing is judged."""
        return self.gear.unstated


def fit_motor(duty: Duty, motor: Motor, gear_ratio: float | None = None) -> MotorFit:
    """Compares one motor behind a gear of any make with a duty.

    Args:
        duty: what is asked.
        motor: needs max_speed, peak_torque, rated_torque and rotor_inertia.
        gear_ratio: j; none takes the one whose least margin is largest.

    Raises:
        MotorError: a figure is missing.
    """
    return fit_motors(duty, [motor], gear_ratio)[0]


def fit_motors(
    duty: Duty, motors: Sequence[Motor], gear_ratio: float | None = None
) -> tuple[MotorFit, ...]:
    """As :func:`fit_motor` for several motors.

    Returns:
        The motors that fit first, the one of least peak torque first; then the others, the
        nearest to fitting first.
    """
    drives = []
    _require(motors)
    for motor in motors:
        bound = _ratio_bound(duty, motor)

        def least_margin(j: float, motor: Motor = motor) -> float:
            peak = float(duty.estimate([_any_gear(duty, motor, j)])[0])
            checks = _motor_checks(motor, j * duty.rate, peak, duty.rms(motor, j))
            return min(check.margin for check in checks)

        ratio = gear_ratio
        if ratio is None and not np.isfinite(bound):
            raise MotorError(
                f"motor {motor.name!r}: nothing moves, so no gear ratio is the best; name one"
            )
        if ratio is None:
            ratio = _largest(least_margin, bound * TOLERANCES.least_ratio, bound)
        drives.append(_any_gear(duty, motor, ratio))
    peaks = duty.peak(drives)
    fits = [
        _fit(duty, drive, float(peak), duty.rms(drive.motor, drive.gear.ratio))
        for drive, peak in zip(drives, peaks, strict=True)
    ]
    return _ranked(fits)


def fit_drives(
    duty: Duty, motors: Sequence[Motor], gears: Sequence[Gearbox]
) -> tuple[MotorFit, ...]:
    """Every motor behind every gearbox against a duty: pairs that can be bought.

    The peak torque at the shaft is a bound over both directions of power, the RMS torque goes by
    the direction at each instant (:meth:`kinlab.drives.demand.Demand.rms_at_shaft`).

    Args:
        duty: what is asked.
        motors: need max_speed, peak_torque, rated_torque and rotor_inertia.
        gears: gearboxes; a limit that one does not state is not judged
            (:attr:`MotorFit.unstated`).

    Returns:
        The pairs that fit first, the motor of least peak torque first, with its gearbox of most
        margin; then the others, the nearest to fitting first.

    Raises:
        MotorError: a figure of a motor is missing.
    """
    _require(motors)
    drives = [Drive(motor, gear) for motor in motors for gear in gears]
    peaks = duty.peak(drives)
    fits = [
        _fit(duty, drive, float(peak), float(duty.cycle.rms_at_shaft(drive).max()))
        for drive, peak in zip(drives, peaks, strict=True)
    ]
    return _ranked(fits)


def fit_all(
    duty: Duty,
    motors: Sequence[Motor],
    gears: Sequence[Gearbox] | None,
    gear_ratio: float | None = None,
) -> tuple[MotorFit, ...]:
    """:func:`fit_drives` where there are gearboxes, else :func:`fit_motors`."""
    if gears is None:
        return fit_motors(duty, motors, gear_ratio)
    return fit_drives(duty, motors, gears)


def refuse_both(gears: object, gear_ratio: object) -> None:
    """Refuses gearboxes together with a ratio.

    Raises:
        OptionError: both are given.
    """
    if gears is not None and gear_ratio is not None:
        raise OptionError("give gears or gear_ratio, not both: a gearbox has its ratio")


def _require(motors: Sequence[Motor]) -> None:
    for motor in motors:
        for figure in ("max_speed", "peak_torque", "rated_torque", "rotor_inertia"):
            motor.need(figure)


def _any_gear(duty: Duty, motor: Motor, ratio: float) -> Drive:
    return Drive(motor, ideal_gear(ratio, duty.efficiency))


def _ratio_bound(duty: Duty, motor: Motor) -> float:
    top = np.pi * motor.need("max_speed") / 30.0
    return float(top / duty.rate) if duty.rate > 0.0 else np.inf


def _motor_checks(motor: Motor, speed: float, peak: float, rms: float) -> tuple[Limit, ...]:
    return (
        Limit("max speed", speed * 30.0 / np.pi, motor.need("max_speed"), "r/min"),
        Limit("peak torque", peak, motor.need("peak_torque"), "N m"),
        Limit("rated torque", rms, motor.need("rated_torque"), "N m"),
    )


def _gear_checks(duty: Duty, gear: Gearbox) -> tuple[Limit, ...]:
    turns = gear.ratio * 30.0 / np.pi
    mean = float(mean_size(duty.cycle.t, duty.cycle.v).max())
    rows = (
        ("gear peak torque", duty.load_torque, gear.peak_torque, "N m"),
        ("gear mean torque", duty.mean_load(), gear.nominal_torque, "N m"),
        ("gear max speed", duty.rate * turns, gear.max_speed, "r/min"),
        ("gear mean speed", mean * turns, gear.rated_speed, "r/min"),
    )
    return tuple(Limit(n, asked, most, unit) for n, asked, most, unit in rows if most is not None)


def _fit(duty: Duty, drive: Drive, peak: float, rms: float) -> MotorFit:
    motor, ratio = drive.motor, drive.gear.ratio
    inertia = duty.load_inertia / ratio**2
    speed = ratio * duty.rate
    return MotorFit(
        motor=motor,
        gear=drive.gear,
        gear_ratio_bound=_ratio_bound(duty, motor),
        inertia_range=(inertia / 3.0, inertia),
        inertia_ratio=inertia / drive.inertia,
        peak=peak,
        rms=rms,
        speed=speed * 30.0 / np.pi,
        checks=_motor_checks(motor, speed, peak, rms) + _gear_checks(duty, drive.gear),
    )


def _ranked(fits: Sequence[MotorFit]) -> tuple[MotorFit, ...]:
    def rank(fit: MotorFit) -> tuple[bool, float, float]:
        size = fit.motor.need("peak_torque") if fit.fits else 0.0
        return not fit.fits, size, -fit.margin

    return tuple(sorted(fits, key=rank))


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
    for share in ideal_gear(gear_ratio, efficiency).shares:
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
