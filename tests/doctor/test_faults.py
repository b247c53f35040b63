"""A fault of the search for a cause: the verdict stands, and the fault is told."""

from __future__ import annotations

import numpy as np
import pytest
from hand_programs import told_in_its_line

import kinlab as kl
from kinlab.doctor.program import words


@pytest.fixture
def faulty(monkeypatch) -> None:
    """A search that comes upon what it does not know."""

    def fails(*_given):
        raise IndexError("nothing there")

    monkeypatch.setattr(words, "LineSearch", fails)


def answer(q):
    return np.array([-0.5 * np.sin(q[0]), 0.4 * np.sin(q[0] + q[1])])


@pytest.mark.usefixtures("faulty")
def test_the_verdict_stands_and_the_fault_is_told(monkeypatch):
    monkeypatch.setattr("kinlab.doctor.examine.LOUD", False)
    found = kl.diagnose("planar2r", "gravity_torques", answer)
    assert not found.agrees
    assert "IndexError: nothing there" in str(found)


@pytest.mark.usefixtures("faulty")
def test_tests_see_the_fault():
    with pytest.raises(IndexError, match="nothing there"):
        kl.diagnose("planar2r", "gravity_torques", answer)


NUMBERED = """
import numpy as np

def f(q):
    S6 = []
    T = np.eye(4)
    for length, centre, angle in ((0.5, 0.5, q[0]), (0.4, 0.4, q[1])):
        z, o = T[:3, 2], T[:3, 3]
        S0 = np.concatenate([z, np.cross(o, z)])
        S6.append(S0)
        c, s = np.cos(angle), np.sin(angle)
        T = T @ np.array([[c, -s, 0, length*c], [s, c, 0, length*s], [0, 0, 1, 0], [0, 0, 0, 1]])
    J = np.array([[0.0, 0.0], [0.0, 0.0], [1.0, 1.0]])
    for i in range(2):
        J[:, i] += S6[i][3:] + np.cross(S6[i][:3], T[:3, 3])
    return J
"""


def test_a_list_begun_empty_under_a_numbered_name():
    """``S6 = []`` beside ``S0 = ...``: what one has is looked for in the other."""
    right, slip = "np.cross(o, z)", "np.cross(z, o)"
    told_in_its_line("planar2r", "planar_jacobian", NUMBERED, right, slip)


ENDING = """
import numpy as np

m1, m2, l1, l2, g = 2.0, 1.5, 0.5, 0.4, 9.81

def told(x, most=70.0):
    if x > most:
        END
    return x

def f(q):
    c1, c12 = np.cos(q[0]), np.cos(q[0] + q[1])
    return np.array([told((m1 + m2)*l1*g*c1 + m2*l2*g*c12), told(m2*l2*g*c12)])
"""


@pytest.mark.parametrize("end", ["raise KeyboardInterrupt", "raise SystemExit(2)"])
def test_an_edit_that_leads_to_where_the_program_ends_itself(end):
    text = ENDING.replace("END", end)
    told_in_its_line("planar2r", "gravity_torques", text, "told(m2*l2*g*c12)", "told(m2*l1*g*c12)")
