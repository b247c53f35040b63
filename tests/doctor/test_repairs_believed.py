"""Edits that make a program right and are not its slip are not told."""

import numpy as np
import pytest

import kinlab as kl

M1, M2, L1, L2, g = 2.0, 1.5, 0.5, 0.4, 9.81  # planar2r


def right(q):
    second = M2 * g * L2 * np.cos(q[0] + q[1])
    return np.array([(M1 + M2) * g * L1 * np.cos(q[0]) + second, second])


def with_a_branch(q):
    second = M2 * g * L2 * np.cos(q[0] + q[1])
    if abs(q[1]) < 0.5:
        return np.zeros(2)
    return np.array([(M1 + M2) * g * L1 * np.cos(q[0]) + second, second])


def with_a_rare_branch(q):
    second = M2 * g * L2 * np.cos(q[0] + q[1])
    if q[0] > 3.1:
        second = 0.0
    return np.array([(M1 + M2) * g * L1 * np.cos(q[0]) + second, second])


def in_millimetres(q):
    l1, l2 = 500.0, 400.0
    second = M2 * g * l2 * np.cos(q[0] + q[1])
    return np.array([(M1 + M2) * g * l1 * np.cos(q[0]) + second, second])


def rounded(q):
    return np.round(right(q), 2)


@pytest.mark.parametrize(
    ("function", "told", "false"),
    [
        (with_a_branch, "`if abs(q[1]) < 0.5` should be `if False`", "abs(M2)"),
        (with_a_rare_branch, "`if q[0] > 3.1` should be `if False`", "6.2"),
        (in_millimetres, "differs", "9.81 should be"),
        (rounded, "nearly agrees", "should be"),
    ],
)
def test_a_repair_that_hides_the_slip_is_not_told(function, told, false):
    said = str(kl.diagnose("planar2r", "gravity_torques", function))
    assert told in said
    assert false not in said


def test_the_step_of_a_difference_is_no_slip():
    def potential(q):
        return g * (M1 * L1 * np.sin(q[0]) + M2 * (L1 * np.sin(q[0]) + L2 * np.sin(q[0] + q[1])))

    def differences(q):
        step = 0.01
        return np.array([(potential(q + step * d) - potential(q)) / step for d in np.eye(2)])

    said = str(kl.diagnose("planar2r", "gravity_torques", differences))
    assert "step = 0.01` should be" not in said
