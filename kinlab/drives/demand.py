"""What a motion asks of the drives over time, at the joints and at the motors' shafts."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from kinlab.arrays import Array
from kinlab.drives.gears import Drive, ideal_gear
from kinlab.drives.motors import Motor
from kinlab.tolerances import TOLERANCES


@dataclass(frozen=True)
class Demand:
    """A motion of n joints with the torques it takes, on the joints' side of the gears.

    Attributes:
        t: times, (K,), s.
        q: joint positions, (K, n), rad.
        v: joint rates, (K, n), rad/s.
        a: joint accelerations, (K, n), rad/s².
        tau: joint torques, (K, n), N m.
        rotor: inertia of the rotors that ``tau`` includes, at the joints, (n,), kg m².
    """

    t: Array
    q: Array
    v: Array
    a: Array
    tau: Array
    rotor: Array

    @property
    def power(self) -> Array:
        """tau_i v_i, (K, n), W."""
        return self.tau * self.v

    @property
    def peak_rate(self) -> Array:
        """(n,), rad/s."""
        return np.asarray(np.abs(self.v).max(axis=0))

    @property
    def peak_torque(self) -> Array:
        """(n,), N m."""
        return np.asarray(np.abs(self.tau).max(axis=0))

    @property
    def rms_torque(self) -> Array:
        """Root mean square over time, (n,), N m."""
        return root_mean_square(self.t, self.tau)

    @property
    def peak_power(self) -> Array:
        """(n,), W."""
        return np.asarray(np.abs(self.power).max(axis=0))

    @property
    def rms_power(self) -> Array:
        """Root mean square over time, (n,), W."""
        return root_mean_square(self.t, self.power)

    def at_motor(self, motor: Motor, gear_ratio: float, efficiency: float) -> Array:
        """Torque at the motors' shafts, (K, n), N m: a bound that losses cannot exceed.

        As :meth:`bound_at`, with a gear of any make.

        Args:
            motor: needs a rotor inertia, which replaces :attr:`rotor`.
            gear_ratio: j, motor turns per joint turn.
            efficiency: of the gears, 0 to 1.

        Raises:
            MotorError: the motor states no rotor inertia.
        """
        return self.bound_at(Drive(motor, ideal_gear(gear_ratio, efficiency)))

    @property
    def load(self) -> Array:
        """The torques at the joints without what the rotors in ``tau`` take, (K, n), N m."""
        return np.asarray(self.tau - self.rotor * self.a)

    def axis(self, joint: int) -> Demand:
        """The demand of one joint, n = 1: an axis with a drive of its own."""
        one = slice(joint, joint + 1)
        q, v, a, tau = (values[:, one] for values in (self.q, self.v, self.a, self.tau))
        return Demand(self.t, q, v, a, tau, self.rotor[one])

    def _parts_at(self, drive: Drive) -> tuple[Array, Array]:
        """What load and rotors ask of the motors' shafts, losses left out, (K, n) each, N m."""
        return self.load / drive.gear.ratio, drive.inertia * drive.gear.ratio * self.a

    def bound_at(self, drive: Drive) -> Array:
        """Torque at the motors' shafts, (K, n), N m: a bound that losses cannot exceed.

        With c = 1/efficiency where the motor drives the load and c = efficiency where the load
        drives the motor, the shaft carries c load / j + (I_M + I_G) j a, rotor and gearbox being
        on the motor's side. Where load and rotor pull against each other the smaller c gives the
        larger torque; so the larger of the two is taken at each instant.

        Args:
            drive: motor and gearbox, whose inertia replaces :attr:`rotor`.

        Raises:
            MotorError: the motor states no rotor inertia.
        """
        load, rotor = self._parts_at(drive)
        driving, driven = (c * load + rotor for c in drive.gear.shares)
        return np.where(np.abs(driving) >= np.abs(driven), driving, driven)

    def at_shaft(self, drive: Drive) -> Array:
        """Torque at the motors' shafts, (K, n), N m, by the direction of power at each instant.

        c load / j + (I_M + I_G) j a with c as in :meth:`bound_at`, the first where
        load · v > 0 and the second where it is < 0. Where a joint stands still the direction is
        not determined, and the bound is given.

        Args:
            drive: motor and gearbox, whose inertia replaces :attr:`rotor`.

        Raises:
            MotorError: the motor states no rotor inertia.
        """
        load, rotor = self._parts_at(drive)
        drives, driven = drive.gear.shares
        shaft = np.where(load * self.v > 0.0, drives, driven) * load + rotor
        still = np.abs(self.v) <= TOLERANCES.stands_still * self.peak_rate
        return np.where(still, self.bound_at(drive), shaft)

    def rms_at_shaft(self, drive: Drive) -> Array:
        """Root mean square of :meth:`at_shaft` over time, (n,), N m.

        Where a joint reverses, the share of the losses jumps: an interval of time in which it does
        is cut there, so that each part is integrated with its own direction of power.

        Args:
            drive: motor and gearbox.

        Raises:
            MotorError: the motor states no rotor inertia.
        """
        load, rotor = self._parts_at(drive)
        drives, driven = drive.gear.shares
        before, after = self.v[:-1], self.v[1:]
        size = np.abs(before) + np.abs(after)
        turn = np.divide(np.abs(before), size, out=np.ones_like(size), where=size > 0.0)
        cut = np.where(before * after < 0.0, turn, 1.0)  # in parts of the interval
        area = np.zeros_like(before)
        for way, low, high in ((before, 0.0 * cut, cut), (after, cut, np.ones_like(cut))):
            way = np.where(way == 0.0, before + after, way)
            ends = []
            for part in (low, high):
                at = load[:-1] + part * np.diff(load, axis=0)
                turned = rotor[:-1] + part * np.diff(rotor, axis=0)
                both = [c * at + turned for c in (drives, driven)]
                held = np.where(np.abs(both[0]) >= np.abs(both[1]), both[0], both[1])
                shaft = np.where(at * way > 0.0, both[0], both[1])
                ends.append(np.where(way == 0.0, held, shaft))
            share = 0.5 * (high - low) * (ends[0] ** 2 + ends[1] ** 2)
            area = area + share * np.diff(self.t)[:, None]
        still = np.abs(self.v) <= TOLERANCES.stands_still * self.peak_rate
        signs = np.where(
            still, np.nan, np.sign(self.v)
        )  # of one at rest the shaft has a bound only
        one_way = (signs[:-2:2] == signs[1:-1:2]) & (signs[1:-1:2] == signs[2::2])
        whole = integral(self.t, np.square(self.at_shaft(drive)), area, one_way)
        return np.asarray(np.sqrt(whole / (self.t[-1] - self.t[0])))


def integral(
    t: Array, values: Array, cells: Array | None = None, smooth: Array | None = None
) -> Array:
    """The integral over time: Simpson's rule over pairs of equal intervals, else trapezoids.

    Args:
        t: (K,). values: (K, n).
        cells: areas of the intervals that are no trapezoids, (K - 1, n).
        smooth: for which pairs Simpson's rule may be taken, (pairs, n); none: for all.

    Returns:
        (n,).
    """
    dt = np.diff(t)[:, None]
    if cells is None:
        cells = 0.5 * (values[:-1] + values[1:]) * dt
    pairs = len(dt) // 2
    one, other = dt[0 : 2 * pairs : 2], dt[1 : 2 * pairs : 2]
    three = (values[k : k + 2 * pairs - 1 : 2] for k in (0, 1, 2))
    first, middle, last = three
    simpson = (one + other) / 6.0 * (first + 4.0 * middle + last)
    equal = np.abs(one - other) <= 1e-9 * (one + other)
    if smooth is not None:
        equal = np.logical_and(equal, smooth[:pairs])
    each = np.where(equal, simpson, cells[0 : 2 * pairs : 2] + cells[1 : 2 * pairs : 2])
    return np.asarray(each.sum(axis=0) + cells[2 * pairs :].sum(axis=0))


def root_mean_square(t: Array, values: Array) -> Array:
    """Square root of the mean over time of the squares, (n,) from (K, n)."""
    return np.asarray(np.sqrt(integral(t, np.square(values)) / (t[-1] - t[0])))


def cubic_mean(t: Array, torque: Array, rate: Array) -> Array:
    """Mean of |torque|³ over the turns that are made, to the power 1/3, (n,) from (K, n).

    (integral |v| |T|³ dt / integral |v| dt)^(1/3): by what makers of gearboxes judge fatigue; 0
    for a joint that does not move.
    """
    turns = np.trapezoid(np.abs(rate), t, axis=0)
    work = np.trapezoid(np.abs(rate) * np.abs(torque) ** 3, t, axis=0)
    return np.asarray(np.cbrt(np.divide(work, turns, out=np.zeros_like(work), where=turns > 0.0)))


def mean_size(t: Array, values: Array) -> Array:
    """Mean over time of the absolute values, by trapezoids, (n,) from (K, n)."""
    return np.asarray(np.trapezoid(np.abs(values), t, axis=0) / (t[-1] - t[0]))
