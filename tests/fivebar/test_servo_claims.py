"""What the docstrings of the servo sizing say, run once."""

from __future__ import annotations

import numpy as np
import pytest
from kinlab.fivebar.trajectory import motor_torques

import kinlab as kl

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


def test_gear_losses_are_on_the_safe_side_except_where_a_rotor_brakes_harder_than_its_load():
    linkage = kl.FiveBar.load("isotropic")
    sizing = linkage.size_servo(BOX, v_max=3.0, a_max=60.0)
    cycle, motor = sizing.cycle, sizing.short_list[-1].motor
    for j in (0.3, 1.0, 3.0, 10.0, 30.0):
        said = motor_torques(linkage, cycle, motor, j, 0.7)
        rotor = motor.need("rotor_inertia") * j * cycle.theta_ddot
        load = (said - rotor) * j * 0.7
        driven = load * cycle.theta_dot < 0.0  # the load drives the motor
        true = np.where(driven, load * 0.7 / j, load / (j * 0.7)) + rotor
        low = np.abs(true) > np.abs(said) + 1e-12
        assert np.all(driven[low])
        assert np.all(load[low] * rotor[low] < 0.0)  # opposite, and the rotor's is the larger
        mean = 0.5 * (load[low] * 0.7 / j + load[low] / (j * 0.7))
        assert np.all(np.abs(rotor[low]) > np.abs(mean))
    assert low.any()
