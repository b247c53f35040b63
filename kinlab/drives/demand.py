"""What a motion asks of the drives over time, at the joints and at the motors' shafts."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from kinlab.arrays import Array
from kinlab.drives.motors import Motor


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

        With c = 1/efficiency where the motor drives the load and c = efficiency where the load
        drives the motor, the shaft carries c tau_load / j + I_M j a, the rotor being on the
        motor's side of the gear. Where load and rotor pull against each other the smaller c
        gives the larger torque; so the larger of the two is taken at each instant.

        Args:
            motor: needs a rotor inertia, which replaces :attr:`rotor`.
            gear_ratio: j, motor turns per joint turn.
            efficiency: of the gears, 0 to 1.

        Raises:
            MotorError: the motor states no rotor inertia.
        """
        load = (self.tau - self.rotor * self.a) / gear_ratio
        rotor = motor.need("rotor_inertia") * gear_ratio * self.a
        driving, driven = (c * load + rotor for c in gear_shares(efficiency))
        return np.where(np.abs(driving) >= np.abs(driven), driving, driven)


def gear_shares(efficiency: float) -> tuple[float, float]:
    """By what a gear multiplies the load: where the motor drives it, and where it drives back."""
    return 1.0 / efficiency, efficiency


def root_mean_square(t: Array, values: Array) -> Array:
    """Square root of the mean over time of the squares, by trapezoids, (n,) from (K, n)."""
    area = np.trapezoid(np.square(values), t, axis=0)
    return np.asarray(np.sqrt(area / (t[-1] - t[0])))
