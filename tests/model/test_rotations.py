"""Rotations about an axis and along a rotation vector, beside Pinocchio's."""

from __future__ import annotations

import numpy as np
import pinocchio as pin
import pytest

from kinlab.model.rotations import about_axis, rotations_along


@pytest.mark.parametrize("axis", [0, 1, 2])
def test_about_an_axis_one_angle_or_many(axis):
    angles = np.array([[0.0, 0.3, -2.0], [np.pi, 7.0, -np.pi / 2]])
    turns = about_axis(axis, angles)
    assert turns.shape == (2, 3, 3, 3)
    for angle, turn in zip(angles.ravel(), turns.reshape(-1, 3, 3), strict=True):
        np.testing.assert_allclose(turn, pin.utils.rotate("xyz"[axis], angle), rtol=0, atol=1e-15)
        np.testing.assert_array_equal(about_axis(axis, angle), turn)


def test_along_a_rotation_vector():
    rng = np.random.default_rng(5)
    shares = np.linspace(-1.0, 2.0, 7)
    for size in (0.0, 1e-300, 1e-12, 1e-5, 0.4, np.pi, 20.0):
        vector = rng.normal(size=3)
        vector *= size / np.linalg.norm(vector)
        turns = rotations_along(vector, shares)
        assert turns.shape == (7, 3, 3)
        wanted = [pin.exp3(share * vector) for share in shares]
        np.testing.assert_allclose(turns, wanted, rtol=0, atol=1e-14)
    np.testing.assert_array_equal(rotations_along(vector), rotations_along(vector, np.ones(1))[0])
