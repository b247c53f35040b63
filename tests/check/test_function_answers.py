"""What a student's function may answer with, and what is said of what it may not."""

import numpy as np
import pytest
import sympy as sp

import kinlab as kl
from kinlab.formulas.record import FormulaError

M1, M2, L1, L2, G = 2.0, 1.5, 0.5, 0.4, 9.81  # planar2r
BUFFER = np.zeros(2)


def torques(q):
    second = M2 * G * L2 * np.cos(q[0] + q[1])
    return [(M1 + M2) * G * L1 * np.cos(q[0]) + second, second]


def into_one_array(q):
    BUFFER[:] = torques(q)
    return BUFFER


def with_sympy(q):
    second = M2 * G * L2 * sp.cos(q[0] + q[1])
    return [(M1 + M2) * G * L1 * sp.cos(q[0]) + second, second]


def without_return(q):
    torques(q)


@pytest.mark.parametrize("function", [into_one_array, with_sympy])
@pytest.mark.parametrize("asked", [kl.compare, kl.diagnose])
def test_a_right_function_is_right_however_it_holds_its_answer(asked, function):
    assert asked("planar2r", "gravity_torques", function).agrees


@pytest.mark.parametrize("asked", [kl.compare, kl.diagnose])
def test_a_function_without_return_is_told_so(asked):
    with pytest.raises(FormulaError, match="'without_return' gives nothing back.*return"):
        asked("planar2r", "gravity_torques", without_return)


@pytest.mark.parametrize("asked", [kl.compare, kl.diagnose])
def test_a_masked_entry_is_no_number(asked):
    """What stands below the mask may be right by accident."""

    def masked(q):
        return np.ma.array(torques(q), mask=[False, True])

    def unmasked(q):
        return np.ma.array(torques(q), mask=False)

    assert asked("planar2r", "gravity_torques", unmasked).agrees
    assert not asked("planar2r", "gravity_torques", masked).agrees
