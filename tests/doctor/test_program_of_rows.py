"""Slips of whole rows: of one that stands for another, of squares, of the rows that are left."""

from __future__ import annotations

import pytest
from hand_programs import asked, told_in_its_line
from test_program_lanes import FIVE_BAR

TOOL_AXES = """
import numpy as np

a, d = [0, -0.612, -0.5723, 0, 0, 0], [0.1273, 0, 0, 0.163941, 0.1157, 0.0922]
alpha = [np.pi/2, 0, 0, np.pi/2, -np.pi/2, 0]

def link(i, th):
    c, s, ca, sa = np.cos(th), np.sin(th), np.cos(alpha[i]), np.sin(alpha[i])
    return np.array([[c, -s*ca, s*sa, a[i]*c], [s, c*ca, -c*sa, a[i]*s], [0, sa, ca, d[i]], [0, 0, 0, 1]])

def f(q):
    T = [np.eye(4)]
    for i in range(6):
        T.append(T[-1] @ link(i, q[i]))
    Re, pe = T[6][:3, :3], T[6][:3, 3]
    J = np.zeros((6, 6))
    for i in range(6):
        z = T[i][:3, 2]
        J[:3, i] = np.cross(z, pe - T[i][:3, 3])
        J[3:, i] = z
    J[:3] = Re.T @ J[:3]
    J[3:] = Re.T @ J[3:]
    return J
"""
SQUARES = """
import numpy as np

def f(q):
    s1, c1, s12, c12 = np.sin(q[0]), np.cos(q[0]), np.sin(q[0] + q[1]), np.cos(q[0] + q[1])
    J = np.array([[-0.5*s1 - 0.4*s12, -0.4*s12], [0.5*c1 + 0.4*c12, 0.4*c12]])
    values = np.linalg.svd(J, compute_uv=False)
    lam = values**2
    return float(np.sum((lam/lam.mean() - 1)**2))
"""  # fmt: skip


@pytest.mark.parametrize(
    ("robot", "quantity", "text", "right", "slip"),
    [
        ("planar2r", "isotropy_defect", SQUARES, "lam = values**2", "lam = values"),
        ("unequal", "fivebar_torque", FIVE_BAR, "np.outer(rr[i]", "np.outer(l2[i]"),
    ],
    ids=["squares", "row"],
)
def test_a_slip_is_told_in_its_line(robot, quantity, text, right, slip, tmp_path):
    """Neither was found: the first was not tried, the second not in the time there is."""
    told_in_its_line(robot, quantity, text, right, slip, tmp_path / "hand.py")


MOVED = """
import numpy as np

a_prev, d = [0, 0, 0, 0.0825, -0.0825, 0, 0.088], [0.333, 0, 0.316, 0, 0.384, 0, 0]
alpha_prev = np.array([0, -1, 1, 1, -1, 1, 1])*np.pi/2

def f(q):
    T = np.eye(4)
    for i in range(7):
        c, s, ca, sa = np.cos(q[i]), np.sin(q[i]), np.cos(alpha_prev[i]), np.sin(alpha_prev[i])
        T = T @ np.array([[c, -s, 0, a_prev[i]], [s*ca, c*ca, -sa, -d[i]*sa],
                          [s*sa, c*sa, ca, d[i]*ca], [0, 0, 0, 1]])
    T[:3, 3] += 0.107*T[:3, 2]
    return T
"""
TURN = """
from math import acos, atan2, hypot
import numpy as np

e, l1, l2 = 0.12, (0.30, 0.26), (0.50, 0.54)

def clip(c):
    return max(-1.0, min(1.0, c))

def f(xy, mode):
    x, y = xy
    dx = x - e
    r = hypot(dx, y)
    t1 = atan2(y, dx) - mode[0]*acos(clip((l1[0]**2 + r**2 - l2[0]**2)/(2*l1[0]*r)))
    dx = x + e
    r = hypot(dx, y)
    t2 = atan2(y, dx) - mode[1]*acos(clip((l1[1]**2 + r**2 - l2[1]**2)/(2*l1[1]*r)))
    return np.array([t1, t2])
"""
LOAD = """
import numpy as np

l1, l2, e = 0.3, 0.5, 0.2/np.sqrt(2)
mA, cA, IA, m, g = 1.0, 0.15, 0.3**2/12, 1.0, 9.81
I = IA + mA*cA**2

def leg(xy, v, a, s, k):
    p = xy - np.array([s*e, 0])
    r = np.hypot(*p)
    th = np.arctan2(p[1], p[0]) - k*np.arccos((l1**2 + r**2 - l2**2)/(2*l1*r))
    u = np.array([np.cos(th), np.sin(th)])
    w = (p - l1*u)/l2
    h = u[0]*w[1] - u[1]*w[0]
    J, td, pd = w/(l1*h), w @ v/(l1*h), -(v @ u)/(l2*h)
    return th, J, J @ a + (l1*td**2*(u @ w) + l2*pd**2)/(l1*h)

def f(xy, v, a, mode):
    t1, J1, a1 = leg(xy, v, a, 1, mode[0])
    t2, J2, a2 = leg(xy, v, a, -1, mode[1])
    tau = np.linalg.inv(np.vstack([J1, J2]).T) @ (m*(a + np.array([0, g])))
    tau += I*np.array([a1, a2])
    tau += mA*g*cA*np.cos([t1, t2])
    return tau
"""
RATES = """
import numpy as np

l1, l2, m1, m2, g = 0.5, 0.4, 2.0, 1.5, 9.81

def mass(q):
    b = m2*l1*l2*np.cos(q[1])
    return np.array([[(m1 + m2)*l1**2 + m2*l2**2 + 2*b, m2*l2**2 + b], [m2*l2**2 + b, m2*l2**2]])

def f(q, v):
    h = 1e-6
    steps = h*np.eye(2)
    dM = np.array([(mass(q + s) - mass(q - s))/(2*h) for s in steps])
    Mdot = dM[0]*v[0] + dM[1]*v[1]
    grad = np.array([0.5*v @ dM[k] @ v for k in range(2)])
    return Mdot @ v - grad
"""


@pytest.mark.parametrize(
    ("robot", "quantity", "text", "right", "slip", "told"),
    [
        ("panda", "fk", MOVED, "[0, 0, 0, 0.0825, -0.0825, 0, 0.088]",
         "[0, 0, 0.0825, -0.0825, 0, 0.088, 0]", "the numbers stand one place on"),
        ("isotropic", "fivebar_torque_massless", LOAD, "I = IA + mA*cA**2", "I = IA",
         "`I = IA` should be `I = IA + mA*cA**2`"),
        ("planar2r", "coriolis_torques", RATES, "0.5*v @ dM[k] @ v", "v @ dM[k] @ v",
         "should be `grad = np.array([0.5*v @ dM[k] @ v for k in range(2)])`"),
    ],
    ids=["column", "axis", "energy"],
)  # fmt: skip
def test_what_a_textbook_has_comes_before_what_amounts_to_it(
    robot, quantity, text, right, slip, told, tmp_path
):
    """Each was told in another line, or as another number, with which the program is right too."""
    assert text.count(right) == 1
    found, _good = asked(text.replace(right, slip), robot, quantity, tmp_path / "hand.py")
    assert told in found.sentence and "or else" not in found.sentence, found


def test_two_slips_beside_what_holds_a_cosine_below_one():
    """No two of them were found together: what is held below one was lost in most lanes."""
    text = TURN.replace("dx = x + e", "dx = x - e").replace("- l2[1]**2", "- l2[0]**2")
    found, _good = asked(text, "unequal", "fivebar_angles")
    assert "`dx = x - e` should be `dx = x + e`" in found.sentence, found
    assert "- l2[1]**2)/(2*l1[1]*r)" in found.sentence, found


def test_what_is_done_to_some_rows_is_done_to_the_others():
    """It was told in the line that fills them, which has nothing wrong."""
    text = TOOL_AXES.replace("    J[3:] = Re.T @ J[3:]\n", "")
    found, _good = asked(text, "ur10", "jacobian_tool")
    assert "a line is missing: `J[3:] = Re.T @ J[3:]`" in found.sentence, found
