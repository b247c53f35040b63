"""What the docstrings of the servo sizing say, run once."""

from __future__ import annotations

import numpy as np
import pytest

import kinlab as kl
from kinlab.fivebar.trajectory import motor_torques

BOX = (-0.2, 0.2, -0.65, -0.5)


@pytest.fixture(scope="module")
def sizing():
    return kl.FiveBar.load("isotropic").size_servo(BOX, v_max=3.0, a_max=60.0)


def test_the_ratio_makes_the_least_margin_largest(sizing):
    linkage = kl.FiveBar.load("isotropic")
    fit = sizing.short_list[0]
    for factor in (0.9, 1.1):
        other = linkage.size_servo(
            BOX, v_max=3.0, a_max=60.0, motor=fit.motor, gear_ratio=factor * fit.gear_ratio
        )
        assert other.fits[0].margin < fit.margin


def test_order_of_the_fits(sizing):
    fits = [f.fits for f in sizing.fits]
    assert fits == sorted(fits, reverse=True) and True in fits and False in fits
    peaks = [f.motor.need("peak_torque") for f in sizing.fits if f.fits]
    assert peaks == sorted(peaks)
    margins = [f.margin for f in sizing.fits if not f.fits]
    assert margins == sorted(margins, reverse=True)


def test_gear_losses_are_on_the_safe_side_only_while_the_rotor_is_light(sizing):
    linkage, cycle = kl.FiveBar.load("isotropic"), sizing.cycle
    worst = {}
    for fit in (sizing.short_list[0], sizing.short_list[-1]):
        for j in (fit.gear_ratio, 4.0 * fit.gear_ratio):
            said = motor_torques(linkage, cycle, fit.motor, j, 0.7)
            rotor = fit.motor.need("rotor_inertia") * j * cycle.theta_ddot
            load = (said - rotor) * j * 0.7
            drives = load * cycle.theta_dot > 0.0
            true = np.where(drives, load / (j * 0.7), load * 0.7 / j) + rotor
            worst[fit.motor.name, j == fit.gear_ratio] = np.abs(true).max() / np.abs(said).max()
    assert worst[sizing.short_list[0].motor.name, True] <= 1.0
    assert max(worst.values()) > 1.0  # a large rotor that brakes hard
