"""What the docstrings of the servo sizing say, run once."""

from __future__ import annotations

import pytest

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
