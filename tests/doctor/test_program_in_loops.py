"""Slips of loops, of what a loop has at its turn, and of terms that another link's line has."""

from __future__ import annotations

import pytest
from hand_programs import told_in_its_line

import kinlab as kl

GRAVITY = """
import numpy as np
l, m, g = [0.5, 0.4, 0.25], [3.0, 2.0, 1.0], 9.81

def f(q):
    out = np.zeros(3)
    for j in range(3):
        for i in range(j, 3):
            lever = l[i]/2*np.cos(sum(q[:i + 1]))
            for k in range(j, i):
                lever += l[k]*np.cos(sum(q[:k + 1]))
            out[j] += m[i]*g*lever
    return out
"""
RATES = """
import numpy as np
l = [0.5, 0.4, 0.25]

def jac(q):
    t, J = np.cumsum(q), np.zeros((3, 3))
    for i in range(3):
        for k in range(i, 3):
            J[0, i] -= l[k]*np.sin(t[k])
            J[1, i] += l[k]*np.cos(t[k])
    J[2] = 1.0
    return J

def f(q, v):
    h, vel = 1e-6, np.zeros(3)
    for i in range(3):
        vel += jac(q)[:, i]*v[i]
    return (vel[:2]**2).sum()
"""
SOLVED = """
import numpy as np

def f(q, w, tau):
    c2, s2, k = np.cos(q[1]), np.sin(q[1]), 1.5*0.5*0.4
    M = np.array([[3.5*0.25 + 1.5*0.16 + 2*k*c2, 1.5*0.16 + k*c2], [1.5*0.16 + k*c2, 1.5*0.16]])
    h = k*s2*np.array([-w[1]*(2*w[0] + w[1]), w[0]**2])
    grav = 9.81*np.array([3.5*0.5*np.cos(q[0]) + 1.5*0.4*np.cos(sum(q)), 1.5*0.4*np.cos(sum(q))])
    return np.linalg.solve(M, tau - h - grav)
"""
BRANCHES = """
import numpy as np
l1, l2, l3 = 0.45, 0.35, 0.3

def f(x, y, z):
    out = []
    for t3 in (np.arcsin(z/l3), np.pi - np.arcsin(z/l3)):
        reach = l2 + l3*np.cos(t3)
        c2 = (x*x + y*y - l1**2 - reach**2)/(2*l1*reach)
        if abs(c2) > 1:
            continue
        for up in (1, -1):
            t2 = up*np.arccos(c2)
            t1 = np.arctan2(y, x) - np.arctan2(reach*np.sin(t2), l1 + reach*np.cos(t2))
            out.append([t1, t2, t3])
    return np.array(out)
"""
SLIDE = """
import numpy as np
a, d = [0, 0, 0.0203, 0, 0, 0], [0.412, 0.154, 0, 0, 0, 0.263]
al, th = [-np.pi/2, np.pi/2, 0, -np.pi/2, np.pi/2, 0], [0, 0, -np.pi/2, 0, 0, 0]

def f(q, F):
    T, lines = np.eye(4), []
    for i in range(6):
        lines.append((T[:3, 2], T[:3, 3]))
        t, s = (th[i], q[i]) if i == 2 else (q[i], d[i])
        c, n, ca, sa = np.cos(t), np.sin(t), np.cos(al[i]), np.sin(al[i])
        T = T @ [[c, -n*ca, n*sa, a[i]*c], [n, c*ca, -c*sa, a[i]*n], [0, sa, ca, s], [0, 0, 0, 1]]
    tau = []
    for k, (z, p) in enumerate(lines):
        tau.append(z @ F[:3] if k == 2 else z @ (F[3:] + np.cross(T[:3, 3] - p, F[:3])))
    return np.array(tau)
"""
ENERGY = """
import numpy as np

def f(q, w):
    a1, a2, a3 = np.cumsum(q)
    w1, w2, w3 = np.cumsum(w)

    def square(*links):
        x = sum(r*u*np.sin(t) for r, u, t in links)
        return x**2 + sum(r*u*np.cos(t) for r, u, t in links)**2

    s1 = square((0.25, w1, a1))
    s2 = square((0.5, w1, a1), (0.2, w2, a2))
    s3 = square((0.5, w1, a1), (0.4, w2, a2), (0.125, w3, a3))
    k1 = 0.5*3.0*s1 + 0.5*3.0*0.5**2/12*w1**2
    k2 = 0.5*2.0*s2 + 0.5*2.0*0.4**2/12*w2**2
    k3 = 0.5*1.0*s3 + 0.5*1.0*0.25**2/12*w3**2
    return k1 + k2 + k3
"""


@pytest.mark.parametrize(
    ("robot", "quantity", "text", "right", "slip"),
    [
        ("planar3r", "gravity_torques", GRAVITY, "l[k]*np.cos(sum(q[:k + 1]))", "l[k]*np.cos(q[k])"),
        ("planar3r", "tip_speed_squared", RATES, "for k in range(i, 3)", "for k in range(i + 1)"),
        ("planar3r", "tip_speed_squared", RATES, "jac(q)[:, i]*v[i]", "jac(q)[:, i]*v"),
        ("planar2r", "forward_dynamics", SOLVED, "tau - h - grav)", "tau) - h - grav"),
        ("spatial3r", "inverse_kinematics_xyz", BRANCHES, "l2 + l3*np.cos(t3)", "l2 + l3"),
        ("stanford", "statics", SLIDE, "F[:3] if k == 2", "F[:3] if k == 3"),
    ],
    ids=["sum", "outward", "entry", "solved", "cosine", "slide"],
)  # fmt: skip
def test_a_slip_is_told_in_its_line(robot, quantity, text, right, slip, tmp_path):
    told_in_its_line(robot, quantity, text, right, slip, tmp_path / "hand.py")


def test_a_half_is_lost_where_the_lines_of_other_links_have_it(tmp_path):
    """And no more where the square of the speed is set, which gives the same energy."""
    text = ENERGY.replace("3.0*s1", "m1*s1").replace("2.0*s2", "m2*s2").replace("1.0*s3", "m3*s3")
    text = text.replace("    a1, a2", "    m1, m2, m3 = 3.0, 2.0, 1.0\n    a1, a2")
    told_in_its_line(
        "planar3r", "kinetic_energy", text, "k1 = 0.5*m1", "k1 = m1", tmp_path / "x.py"
    )


def test_no_half_length_where_no_mass_is():
    """A length for the distance of the centre of mass, in a formula of no masses."""
    found = kl.diagnose("planar2r_rods", "det", "det(J) = l1*lc2*sin(q2)")
    assert found.sentence.startswith("det: lc2 should be l2"), found
