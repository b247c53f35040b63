"""What a slip leaves unused, arrays that are changed in place, keys, and a tool left out.

Every program is right before the slip; what is said makes it right, and is what was there.
"""

from __future__ import annotations

import pytest
from hand_programs import told_in_its_line, with_slips, written

import kinlab as kl

TOTAL = """
import numpy as np
LENGTHS = (0.5, 0.4, 0.25)

def f(q, v):
    angle, rate, speed = 0.0, 0.0, 0j
    for length, dq, dv in zip(LENGTHS, q, v):
        angle += dq
        rate += dv
        speed += 1j*rate*length*np.exp(1j*angle)
    return np.array(abs(speed)**2)
"""
DIFFERENCE = """
import numpy as np
K = np.array([[0, 0.4, 0.0625], [0.4, 0, 0.05], [0.0625, 0.05, 0]])
S = np.tril(np.ones((3, 3)))

def f(q):
    phi, out = S @ q, np.zeros((3, 3, 3))
    for k in range(3):
        d = np.zeros((3, 3))
        for i in range(3):
            for j in range(3):
                turns = S[i, k] - S[j, k]
                d[i, j] = -K[i, j]*np.sin(phi[i] - phi[j])*turns
        out[:, :, k] = S.T @ d @ S
    return out
"""
LEVER = """
import numpy as np
lengths = [0.5, 0.4, 0.25]

def f(q, wrench):
    x, y, phi, pins = 0.0, 0.0, 0.0, []
    for angle, length in zip(q, lengths):
        pins.append((x, y))
        phi += angle
        x, y = x + length*np.cos(phi), y + length*np.sin(phi)
    return np.array([(x - px)*wrench[1] - (y - py)*wrench[0] + wrench[5] for px, py in pins])
"""
TOOL = """
import numpy as np
ROWS = [(0.0, 0.0, 0.333), (0.0, -np.pi/2, 0.0), (0.0, np.pi/2, 0.316), (0.0825, np.pi/2, 0.0),
        (-0.0825, -np.pi/2, 0.384), (0.0, np.pi/2, 0.0), (0.088, np.pi/2, 0.0)]

def row(a, al, d, t):
    c, s, ca, sa = np.cos(t), np.sin(t), np.cos(al), np.sin(al)
    return np.array([[c, -s, 0, a], [s*ca, c*ca, -sa, -d*sa], [s*sa, c*sa, ca, d*ca], [0, 0, 0, 1]])

def f(q):
    T, frames = np.eye(4), []
    for (a, al, d), t in zip(ROWS, q):
        T = T @ row(a, al, d, t)
        frames.append(T)
    T = T @ row(0, 0, 0.107, 0)
    return np.array([[*np.cross(A[:3, 2], T[:3, 3] - A[:3, 3]), *A[:3, 2]] for A in frames]).T
"""
COPY = """
import numpy as np
step = 1e-20

def tip(q):
    return np.array([0.5*np.cos(q[0]) + 0.4*np.cos(q[0] + q[1]), 0.5*np.sin(q[0]) + 0.4*np.sin(q[0] + q[1]), q[0] + q[1]])

def f(q):
    q, columns = np.array(q, dtype=complex), []
    for k in range(2):
        moved = q.copy()
        moved[k] += 1j*step
        columns.append(tip(moved).imag/step)
    return np.array(columns).T
"""
KEYS = """
import numpy as np
def f(q):
    dM = np.zeros((2, 2, 2))
    dM[:, :, 1] = -1.5*0.5*0.2*np.sin(q[1])*np.array([[2.0, 1.0], [1.0, 0.0]])
    return dM
"""
COUNTED = """
import numpy as np
calls = 0
def f(q):
    global calls
    calls += 1
    return np.array([2.0*9.81*0.25*np.cos(q[0]) + 9.81*1.5*(0.5*np.cos(q[0]) + 0.2*np.cos(q[0] + q[1])), 9.81*1.5*0.2*np.cos(q[0] + q[1])])
"""
LEGS = """
from math import acos, atan2, hypot, sqrt
import numpy as np
l1, l2, e = 0.3, 0.5, 0.2/sqrt(2)

def leg(x, y, side):
    reach = hypot(x, y)
    inside = acos((l1**2 + reach**2 - l2**2)/(2*l1*reach))
    return atan2(y, x) - side*inside

def f(xy, mode):
    both = np.array([leg(xy[0] - e, xy[1], mode[0]), leg(xy[0] + e, xy[1], mode[1])])
    return np.arctan2(np.sin(both), np.cos(both))
"""

HALF_TURN = """
import numpy as np
def about_z(t):
    c, s = np.cos(t), np.sin(t)
    return np.array([[c, -s, 0, 0], [s, c, 0, 0], [0, 0, 1, 0], [0, 0, 0, 1]])

def along(x=0.0, z=0.0):
    T = np.eye(4)
    T[0, 3], T[2, 3] = x, z
    return T

def f(q):
    over = np.diag([1.0, -1.0, -1.0, 1.0])
    one = along(z=0.387) @ about_z(q[0]) @ along(x=0.325)
    return one @ about_z(q[1]) @ along(x=0.275) @ over @ along(z=q[2]) @ about_z(q[3])
"""
NORMAL = """
import numpy as np
def f(q):
    up, t = np.array([0, 0, 1.0]), q[0] + q[1]
    one, two = np.array([np.cos(q[0]), np.sin(q[0]), 0]), np.array([np.cos(t), np.sin(t), 0])
    hand = 0.3*(np.cos(q[2])*two + np.sin(q[2])*up)
    normal = np.array([two[1], -two[0], 0])
    arm = 0.35*two + hand
    return np.cross(up, 0.45*one + arm) @ np.cross(np.cross(up, arm), np.cross(normal, hand))
"""
BOTH_WAYS = """
import numpy as np
M, L = [2.0, 1.5], [0.5, 0.4]

def f(q, v):
    t, w, rates = np.cumsum(q), np.cumsum(v), np.zeros((2, 2))
    for i in range(2):
        J, D = np.zeros((2, 2)), np.zeros((2, 2))
        for k in range(i + 1):
            r = L[k]/2 if k == i else L[k]
            J[:, :k + 1] += r*np.array([[-np.sin(t[k])], [np.cos(t[k])]])
            D[:, :k + 1] += -r*w[k]*np.array([[np.cos(t[k])], [np.sin(t[k])]])
        S = D.T @ J
        rates += M[i]*(S + S.T)
    return rates
"""
MILLIMETRES = """
import numpy as np
crank, rod, half = 35.0, 55.1, 12.5

def f(xy, v, mode):
    x, y = 1000*xy[0], 1000*xy[1]
    u, w = 1000*v[0], 1000*v[1]
    out = []
    for base, side in ((half, mode[0]), (-half, mode[1])):
        far = np.hypot(x - base, y)
        t = np.arctan2(y, x - base) - side*np.arccos((far**2 + crank**2 - rod**2)/(2*far*crank))
        a, b = x - base - crank*np.cos(t), y - crank*np.sin(t)
        out.append((a*u + b*w)/(crank*(b*np.cos(t) - a*np.sin(t))))
    return np.array(out)
"""


@pytest.mark.many
@pytest.mark.parametrize(
    ("robot", "quantity", "text", "right", "slip"),
    [
        ("planar3r", "tip_speed_squared", TOTAL, "1j*rate*length", "1j*dv*length"),
        ("planar3r", "mass_matrix_derivatives", DIFFERENCE, "turns = S[i, k] - S[j, k]", "turns = S[i, k]"),
        ("planar3r", "statics", LEVER, "[(x - px)*wrench[1] - (y - py)*wrench[0]", "[x*wrench[1] - y*wrench[0]"),
        ("planar2r_rods", "planar_jacobian", COPY, "moved = q.copy()", "moved = q"),
        ("planar2r_rods", "mass_matrix_derivatives", KEYS, "dM[:, :, 1]", "dM[1]"),
        ("isotropic", "fivebar_angles", LEGS, "(l1**2 + reach**2 - l2**2)/(2*l1*", "(l2**2 + reach**2 - l1**2)/(2*l2*"),
        ("scara", "fk", HALF_TURN, "np.diag([1.0, -1.0, -1.0, 1.0])", "np.diag([-1.0, 1.0, -1.0, 1.0])"),
        ("spatial3r", "jacobian_determinant", NORMAL, "[two[1], -two[0], 0]", "[two[0], two[1], 0]"),
        ("plotclock", "fivebar_rates", MILLIMETRES, "u, w = 1000*v[0], 1000*v[1]", "u, w = v[0], v[1]"),
        ("planar2r_rods", "mass_matrix_dot", BOTH_WAYS, "rates += M[i]*(S + S.T)", "rates += M[i]*2*S"),
    ],
    ids=["total", "difference", "lever", "copy", "keys", "names", "half turn", "normal", "units", "both ways"],
)  # fmt: skip
def test_what_is_not_used_and_what_is_changed_is_told_in_its_line(
    robot, quantity, text, right, slip, tmp_path
) -> None:
    told_in_its_line(robot, quantity, text, right, slip, tmp_path / "hand.py")


def test_a_tool_that_is_left_out_behind_a_loop_is_told(tmp_path) -> None:
    last = "    T = T @ row(0, 0, 0.107, 0)\n"
    file = tmp_path / "hand.py"
    assert kl.diagnose("panda", "jacobian", written(TOOL)).agrees
    file.write_text(with_slips(TOOL, [(last, "")]))
    found = kl.diagnose("panda", "jacobian", written(file.read_text(), file))
    (cause,) = found.causes
    assert "after line 14, a line is missing: `T = T @" in cause.sentence, found
    assert "0.107" in cause.sentence, found


def test_what_only_counts_its_calls_is_looked_through(tmp_path) -> None:
    slip = ("0.2*np.cos(q[0] + q[1])])", "0.2*np.cos(q[1])])")
    told_in_its_line("planar2r_rods", "gravity_torques", COUNTED, *slip, tmp_path / "hand.py")


@pytest.mark.parametrize(
    ("old", "new"),
    [("calls += 1", "calls = calls + q[0]"), ("calls = 0\n", "calls = 0\ndef often():\n    return calls > 99\n")],
    ids=["set", "read elsewhere"],
)  # fmt: skip
def test_what_keeps_its_counter_is_not_looked_through(old, new, tmp_path) -> None:
    file = tmp_path / "hand.py"
    file.write_text(with_slips(COUNTED, [(old, new), ("q[1])])", "q[1]*2)])")]))
    found = kl.diagnose("planar2r_rods", "gravity_torques", written(file.read_text(), file))
    assert not found.agrees
    assert not any("line" in place for one in found.causes for place in one.places)
