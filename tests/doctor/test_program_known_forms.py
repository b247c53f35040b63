"""Steps that known formulas have: roots, shares of an inertia, an identity, gravity's acceleration.

And what amounts to two of them, where no line of the program is found that does it.
"""

from __future__ import annotations

import numpy as np
import pytest
from hand_programs import asked, told_in_its_line, written
from test_program_of_rows import LOAD
from test_program_understood import ARTICULATED

import kinlab as kl
from kinlab.doctor.changes import Case
from kinlab.doctor.program.words import WrongLines

GAINS = """
import numpy as np

l1, l2, e = 0.3, 0.5, 0.2/np.sqrt(2)
m = 1.0
IA = 1.0*0.3*0.3/12 + 1.0*0.15**2

def f(xy, mode):
    J = np.empty((2, 2))
    for i in range(2):
        p = xy - np.array([(1 - 2*i)*e, 0])
        n = np.hypot(*p)
        t = np.arctan2(p[1], p[0]) - mode[i]*np.arccos((n*n + l1*l1 - l2*l2)/(2*l1*n))
        u = np.array([np.cos(t), np.sin(t)])
        w = (p - l1*u)/l2
        J[i] = w/(l1*(u[0]*w[1] - u[1]*w[0]))
    A = IA*J + m*np.linalg.inv(J).T
    A = A.T @ A
    half = np.trace(A)/2
    gap = np.sqrt(half**2 - np.linalg.det(A))
    return np.sqrt([half + gap, half - gap])
"""
LEAST = """
def f(IL, j):
    smallest = IL/(3.0*j**2)
    largest = IL/j**2
    return [smallest, largest]
"""
TURNING = """
import numpy as np

def f(points, masses, omega):
    T = 0.0
    for p, m in zip(points, masses):
        T += 0.5*m*(np.dot(omega, omega)*np.dot(p, p) - np.dot(omega, p)**2)
    return T
"""
STATICS = """
from math import sin, cos
import numpy as np

def f(q, wrench):
    L = (0.5, 0.4, 0.25)
    fx, fy = wrench[0], wrench[1]
    nz = wrench[5]
    tau = np.zeros(3)
    for j in range(3):
        ang = sum(q[:j])
        rx = ry = 0.0
        for k in range(j, 3):
            ang += q[k]
            rx += L[k]*cos(ang)
            ry += L[k]*sin(ang)
        tau[j] = rx*fy - ry*fx + nz
    return tau
"""
LOADED = """
import numpy as np

def f(q, wrench):
    s1, c1, s12, c12 = np.sin(q[0]), np.cos(q[0]), np.sin(q[0] + q[1]), np.cos(q[0] + q[1])
    J = np.array([[-0.5*s1 - 0.4*s12, -0.4*s12], [0.5*c1 + 0.4*c12, 0.4*c12]])
    force, moment = wrench[:2], wrench[5]
    return J.T @ force + moment
"""


@pytest.mark.parametrize(
    ("robot", "quantity", "text", "right", "slip"),
    [
        ("planar3r", "statics", STATICS, "ang = sum(q[:j])", "ang = 0.0"),
        ("planar2r", "statics", LOADED, "J.T @ force + moment", "J.T @ force"),
        ("isotropic", "fivebar_torque_gains", GAINS, "np.sqrt([half + gap", "np.array([half + gap"),
        ("isotropic", "servo_inertias", LEAST, "IL/(3.0*j**2)", "IL/(j**2)"),
        ("identity", "turning_energy", TURNING, "np.dot(p, p) - np.dot(omega, p)**2)", "np.dot(p, p))"),
        ("isotropic", "fivebar_torque_massless", LOAD, "m*(a + np.array([0, g]))", "m*a"),
    ],
    ids=["up to here", "moment", "roots", "share", "identity", "gravity of a payload"],
)  # fmt: skip
def test_a_slip_is_told_in_its_line(robot, quantity, text, right, slip, tmp_path):
    told_in_its_line(robot, quantity, text, right, slip, tmp_path / "hand.py")


def test_gravity_that_a_twist_leaves_out_is_told_in_its_line(tmp_path):
    wrong = ARTICULATED.replace("np.array([0, 0, 0, 0, 0, 9.81])", "np.zeros(6)")
    found, good = asked(wrong, "spatial3r", "forward_dynamics", tmp_path / "hand.py")
    assert good and "leaves gravity out" in found.sentence, found


def test_two_steps_that_no_line_was_found_for_are_told_as_what_it_amounts_to(monkeypatch, tmp_path):
    """It was unknown, and slow to find in lines: that nothing is found there is put here."""
    none_found = WrongLines([], written_out=False, numbers=np.zeros(0))
    monkeypatch.setattr(Case, "looked_through", lambda *_: iter([none_found]))
    wrong = LOAD.replace("m*(a + np.array([0, g]))", "m*a").replace("IA + mA*cA**2", "IA")
    found = kl.diagnose(
        "isotropic", "fivebar_torque_massless", written(wrong, tmp_path / "hand.py")
    )
    (cause,) = found.causes
    assert "g*E2" in cause.sentence and "no line was found that does it" in cause.sentence, found
    assert "crank" in cause.sentence and len(cause.kinds) == 2, found
