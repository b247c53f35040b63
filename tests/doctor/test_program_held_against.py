"""Programs are held against the arm: its small numbers, its tensors, its branches, its rows.

Every program is right before its slips; what is told is what was there.
"""

from __future__ import annotations

import numpy as np
import pytest
from hand_programs import lines_named, repaired, searched, with_slips, written

import kinlab as kl
from kinlab.doctor.program.search.mistyped import mistyped

TENSORS = """
import numpy as np

def tensor(xx, yy, zz, xy=0.0, xz=0.0, yz=0.0):
    return np.array([[xx, xy, xz], [xy, yy, yz], [xz, yz, zz]])

BODIES = {
    1: dict(a=0.0, alpha=0.0, m=3.0, c=[0.2, 0.02, -0.01], I=tensor(0.02, 0.08, 0.07)),
    2: dict(a=0.45, alpha=0.0, m=2.0, c=[0.15, -0.01, 0.03], I=tensor(0.01, 0.04, 0.045)),
    3: dict(a=0.35, alpha=np.pi/2, m=1.2, c=[0.12, 0.03, 0.01],
            I=tensor(0.004, 0.012, 0.014, xy=0.001, yz=0.0005)),
}

def f(q):
    M, R, p, axes, points = np.zeros((3, 3)), np.eye(3), np.zeros(3), [], []
    for i in (1, 2, 3):
        one, t = BODIES[i], q[i - 1]
        ca, sa = np.cos(one["alpha"]), np.sin(one["alpha"])
        p = p + R @ np.array([one["a"], 0, 0])
        R = R @ np.array([[np.cos(t), -np.sin(t), 0],
                          [np.sin(t)*ca, np.cos(t)*ca, -sa],
                          [np.sin(t)*sa, np.cos(t)*sa, ca]])
        axes.append(R[:, 2])
        points.append(p)
        centre = p + R @ one["c"]
        Jv, Jw = np.zeros((3, 3)), np.zeros((3, 3))
        for j in range(i):
            Jv[:, j] = np.cross(axes[j], centre - points[j])
            Jw[:, j] = axes[j]
        inertia = R @ one["I"] @ R.T
        M += one["m"]*Jv.T @ Jv + Jw.T @ inertia @ Jw
    return M
"""
LEGS = """
import numpy as np
l1, l2 = 0.3, 0.5
e = (l2 - l1)/np.sqrt(2)

def crank(x, y, side, sign):
    A, B = 2*l1*(x - side*e), 2*l1*y
    C = (x - side*e)**2 + y**2 + l1**2 - l2**2
    return np.arctan2(B, A) - sign*np.arctan2(np.sqrt(A**2 + B**2 - C**2), C)

def f(xy, mode):
    J = np.zeros((2, 2))
    for i, side in enumerate((1, -1)):
        t = crank(*xy, side, mode[i])
        u = np.array([np.cos(t), np.sin(t)])
        w = (xy - np.array([side*e, 0]) - l1*u)/l2
        J[i] = w/(l1*(u[0]*w[1] - u[1]*w[0]))
    return J
"""
ENERGIES = """
import math
m, l = [3.0, 2.0, 1.0], [0.5, 0.4, 0.25]

def f(q, v):
    T = V = x = y = xd = yd = angle = rate = 0.0
    for i in range(3):
        angle, rate = angle + q[i], rate + v[i]
        c, s = math.cos(angle), math.sin(angle)
        cx, cy = xd - l[i]/2*s*rate, yd + l[i]/2*c*rate
        T += m[i]*(cx**2 + cy**2)/2 + m[i]*l[i]**2/12*rate**2/2
        V += m[i]*9.81*(y + l[i]/2*s)
        y += l[i]*s
        xd, yd = xd - l[i]*s*rate, yd + l[i]*c*rate
    return T - V
"""
SYMMETRIC = """
import numpy as np
l1, l2, m1, m2 = 0.5, 0.4, 2.0, 1.5

def f(q):
    h = m2*l1*l2/2*np.cos(q[1])
    I2 = m2*l2**2/3
    I1 = m1*l1**2/3 + m2*l1**2 + I2 + 2*h
    return np.array([[I1, I2 + h], [I2 + h, I2]])
"""
WRISTS = """
import math
L = [0.5, 0.4, 0.25]

def f(x, y, phi):
    xw, yw = x - L[2]*math.cos(phi), y - L[2]*math.sin(phi)
    r = math.hypot(xw, yw)
    at_shoulder = math.acos((L[0]**2 + r**2 - L[1]**2)/(2*L[0]*r))
    at_elbow = math.acos((L[0]**2 + L[1]**2 - r**2)/(2*L[0]*L[1]))
    way = math.atan2(yw, xw)
    found = []
    for side in (1, -1):
        q1, q2 = way - side*at_shoulder, side*(math.pi - at_elbow)
        found.append([q1, q2, phi - q1 - q2])
    return found
"""
ROWS = """
import numpy as np
dh = np.zeros((6, 3))
dh[0, :] = [np.pi/2, 0, 0.1273]
dh[1, :] = [0, -0.612, 0]
dh[2, :] = [0, -0.5723, 0]
dh[3, :] = [np.pi/2, 0, 0.163941]
dh[4, :] = [-np.pi/2, 0, 0.1157]
dh[5, :] = [0, 0, 0.0922]
masses = [7.778, 12.93, 3.87, 1.96, 1.96, 0.202]
com = np.zeros((3, 6))
com[:, 1] = [0.306, 0, 0.220941]
com[:, 2] = [0.28615, 0, 0.049041]
com[:, 3] = [0, -0.1149, 0]
com[:, 4] = [0, 0.1157, 0]
com[:, 5] = [0, 0, -0.0922]

def f(q):
    T, axes, points, tau = np.diag([-1.0, -1.0, 1.0, 1.0]), [], [], np.zeros(6)
    for i in range(6):
        axes.append(T[:3, 2])
        points.append(T[:3, 3])
        (alpha, a, d), c, s = dh[i], np.cos(q[i]), np.sin(q[i])
        ca, sa = np.cos(alpha), np.sin(alpha)
        T = T @ np.array([[c, -s*ca, s*sa, a*c], [s, c*ca, -c*sa, a*s], [0, sa, ca, d], [0, 0, 0, 1]])
        centre = T[:3, :3] @ com[:, i] + T[:3, 3]
        for j in range(i + 1):
            tau[j] -= axes[j] @ np.cross(centre - points[j], masses[i]*np.array([0, 0, -9.81]))
    return tau
"""
SPEEDS = """
import numpy as np
l = 0.115
k = 0.200

def f(xy, mode, vmax):
    rates = []
    for sign in mode:
        r = np.hypot(xy[0], xy[1])
        t = np.arctan2(xy[1], xy[0]) - sign*np.arccos((l**2 + r**2 - k**2)/(2*l*r))
        knee = l*np.array([np.cos(t), np.sin(t)])
        shin = xy - knee
        row = shin/(knee[0]*shin[1] - knee[1]*shin[0])
        rates.append(np.sqrt(row @ row)*vmax)
    return np.array(rates)
"""
QUILL = """
from math import cos, sin
l1, l2 = 0.325, 0.275
masses = [7.0, 5.0, 1.2, 0.4]
spins = [0.1, 0.055, 0.0008, 0.0006]
rotors = [0.3, 0.1, 2.0, 0.02]

def f(q, v):
    a, b, d = q[0], q[0] + q[1], q[0] + q[1] - q[3]
    w, wb, wd = v[0], v[0] + v[1], v[0] + v[1] - v[3]
    p = [0.0]*4
    centres = [(l1 - 0.16, 0, 0, 0), (l1, l2 - 0.13, -0.005, 0), (l1, l2, 0, 0), (l1, l2, 0, 0.01)]
    for m, (r1, r2, e, r4) in zip(masses, centres):
        one = (-r1*sin(a), r1*cos(a))
        two = (-r2*sin(b) - e*cos(b), r2*cos(b) - e*sin(b))
        four = (-r4*sin(d), r4*cos(d))
        x = one[0]*w + two[0]*wb + four[0]*wd
        y = one[1]*w + two[1]*wb + four[1]*wd
        p1, p2, p4 = (m*(x*k[0] + y*k[1]) for k in (one, two, four))
        p[0] += p1 + p2 + p4
        p[1] += p2 + p4
        p[3] -= p4
    turns = [spins[0]*w, (spins[1] + spins[2])*wb, spins[3]*wd]
    p[0] += sum(turns)
    p[1] += turns[1] + turns[2]
    p[3] -= turns[2]
    p[2] = (masses[2] + masses[3])*v[2]
    return [p[i] + rotors[i]*v[i] for i in range(4)]
"""
RIGHT = {
    "tensors": (TENSORS, "spatial3r", "mass_matrix"),
    "legs": (LEGS, "isotropic", "fivebar_jacobian"),
    "energies": (ENERGIES, "planar3r", "lagrangian"),
    "symmetric": (SYMMETRIC, "planar2r_rods", "mass_matrix"),
    "wrists": (WRISTS, "planar3r", "inverse_kinematics_xyphi"),
    "rows": (ROWS, "ur10", "gravity_torques"),
    "speeds": (SPEEDS, "minitaur_leg", "fivebar_worst_rate"),
    "quill": (QUILL, "scara", "momentum"),
}


@pytest.mark.parametrize("name", RIGHT)
def test_the_programs_are_right_before_the_slips(name) -> None:
    text, robot, quantity = RIGHT[name]
    assert kl.compare(robot, quantity, written(text)).agrees


@pytest.mark.many
@pytest.mark.parametrize(
    ("name", "slips"),
    [
        pytest.param("tensors", [('R @ one["I"] @ R.T', 'R.T @ one["I"] @ R')],
                     id="tensors that a function makes are each link's own"),
        pytest.param("legs", [("mode[i]", "mode[0]"), ("u[0]*w[1] - u[1]*w[0]", "u[1]*w[0] - u[0]*w[1]")],
                     id="signs of a branch that are unlike"),
        pytest.param("energies", [("T - V", "T + V"), ("yd + l[i]*c*rate", "yd + l[i]*s*rate")],
                     id="what a sum comes to is the potential energy"),
        pytest.param("symmetric", [("[[I1, I2 + h]", "[[I1, I2]"), ("m2*l1**2 + I2", "m2*l2**2 + I2")],
                     id="the entry across the diagonal"),
        pytest.param("wrists", [("(L[0]**2 + r**2 - L[1]**2)/(2*L[0]*r)", "(L[1]**2 + r**2 - L[0]**2)/(2*L[0]*r)"),
                                ("y - L[2]*math.sin", "y - L[2]*math.cos")],
                     id="another side in the law of cosines"),
        pytest.param("rows", [("com[:, 4] = [0, 0.1157, 0]", "com[:, 4] = [0, -0.1157, 0]"),
                              ("range(i + 1)", "range(i)")], id="columns that are set one by one"),
        pytest.param("speeds", [("np.sqrt(row @ row)", "(row @ row)")], id="the root of a vector's square"),
        pytest.param("quill", [("r2*cos(b) - e*sin(b)", "r2*cos(b) + e*sin(b)"),
                               ("turns[1] + turns[2]", "turns[1]")], id="two small slips beside small numbers"),
    ],
)  # fmt: skip
def test_what_was_there_is_told(name, slips) -> None:
    text, robot, quantity = RIGHT[name]
    wrong = with_slips(text, slips)
    found = kl.diagnose(robot, quantity, written(wrong))
    assert not found.agrees and len(found.causes) == 1, str(found)
    said = found.causes[0].sentence
    places = {
        k
        for k, (a, b) in enumerate(zip(text.split("\n"), wrong.split("\n"), strict=True), 1)
        if a != b
    }
    numbers = (
        {15} if said.startswith("com[1][4], the sign is wrong") else set()
    )  # kept, not typed there
    told = {*lines_named(said)} | numbers
    assert told == places, said
    assert any(kl.compare(robot, quantity, one["f"]).agrees for one in repaired(wrong, said)), said


def test_neighbours_of_a_list_that_are_exchanged_are_wrong_whatever_else_is() -> None:
    slips = [("m, l = [3.0, 2.0, 1.0]", "m, l = [3.0, 1.0, 2.0]"), ("l[i]**2/12", "l[i]/12")]
    found = kl.diagnose("planar3r", "lagrangian", written(with_slips(ENERGIES, slips)))
    assert "`3, 1, 2` should be `3, 2, 1`" in found.causes[0].sentence, str(found)
    assert "power" in found.causes[0].kinds


def test_a_point_of_a_screw_axis_with_two_digits_exchanged() -> None:
    text = """
import numpy as np
POINTS = [0.333, 0.333, 0.649, 0.649, 1.033, 1.033, 1.033]

def f(q):
    return POINTS[4]*q[0]
"""
    wrong = text.replace("0.649, 1.033, 1.033, 1.033", "0.649, 1.303, 1.033, 1.033")
    for typed, meant in ((text, []), (wrong, [1.033])):
        search = searched("panda", "potential_energy", typed)
        told = mistyped(search.trial, search.observed, search.case.robot)
        assert [edit.numbers[1] for edit in told if edit.numbers] == meant


@pytest.mark.parametrize(("name", "stepping"), [("b", False), ("h", True), ("eps", True)])
def test_a_number_of_the_robot_s_own_is_no_step(name, stepping) -> None:
    text = f"def f(q):\n    {name} = 0.0006\n    return 7.0*{name}*q[0]\n"
    assert searched("scara", "potential_energy", text).asked.differences is stepping


def test_the_states_have_unlike_signs_of_a_branch() -> None:
    search = searched("isotropic", "fivebar_jacobian", LEGS)
    signs = search.case.arguments["mode"][search.asked.first]
    assert np.any(signs[:, 0] != signs[:, 1])


def test_no_matrix_stands_before_several_names_at_once() -> None:
    """``H @ leg(i)`` would turn the rows of both vectors into one another, not each vector."""
    text = """
import numpy as np
L1, L2 = [0.30, 0.26], [0.50, 0.54]
E, SIDE = 0.12, [1, -1]

def leg(i, x, y, mode):
    e = SIDE[i]*E
    l1, l2 = L1[i], L2[i]
    A = 2*(e - x)*l1
    B = -2*y*l1
    C = l2**2 - l1**2 - e**2 - x**2 - y**2 + 2*e*x
    root = np.sqrt(max(A**2 + B**2 - C**2, 0))
    th = 2*np.arctan2(B + mode[i]*root, A + C)
    u = np.array([np.cos(th), np.sin(th)])
    w = (np.array([x, y]) - np.array([e, 0]) - l1*u)/l2
    return u, w

def f(xy, mode):
    H = np.array([[0, 1], [-1, 0]])
    J = []
    for i in range(2):
        u, w = leg(i, xy[0], xy[1], mode)
        J.append(w/(L1[i]*(u @ H @ w)))
    return np.array(J)
"""
    assert kl.diagnose("unequal", "fivebar_jacobian", written(text)).agrees
    slips = [("np.array([e, 0])", "np.array([E, 0])"), ("J.append(w/(", "J.append(u/(")]
    found = kl.diagnose("unequal", "fivebar_jacobian", written(with_slips(text, slips)))
    assert "should be `J.append(w/(L1[i]*(u @ H @ w)))`" in found.causes[0].sentence, str(found)
    assert "should be `w = (np.array([x, y]) - np.array([e, 0])" in found.causes[0].sentence


def test_the_rest_of_a_share_is_told() -> None:
    text = """
import numpy as np

def f(q):
    m1, m2, g, l1, l2 = 2.0, 1.5, 9.81, 0.5, 0.4
    share = m1/(m1 + m2)
    elbow = l1*np.sin(q[0])
    tip = elbow + l2*np.sin(q[0] + q[1])
    return (m1 + m2)*g*(share*elbow + (1 - share)*tip)
"""
    assert kl.diagnose("planar2r", "potential_energy", written(text)).agrees
    wrong = with_slips(text, [("(1 - share)*tip", "share*tip")])
    found = kl.diagnose("planar2r", "potential_energy", written(wrong))
    assert "(share*elbow + (1 - share)*tip)`" in found.causes[0].sentence, str(found)


@pytest.mark.parametrize(
    ("lengths", "meant"),
    [("[0.30, 0.26], [0.54, 0.50]", True), ("[0.30, 0.26], [0.50, 0.54]", False),
     ("[0.26, 0.30], [0.54, 0.50]", False)],
)  # fmt: skip
def test_numbers_of_two_legs_exchanged_are_wrong_where_others_are_in_their_order(
    lengths, meant
) -> None:
    """Legs that are all listed the other way round are a writer's own order."""
    text = f"L1, L2 = {lengths}\n\ndef f(xy, mode):\n    return L1[0]*L2[1]*xy\n"
    search = searched("unequal", "fivebar_loop", text.replace("xy, mode", "theta, xy"))
    told = [*mistyped(search.trial, search.observed, search.case.robot)]
    assert bool(told) is meant
    assert all(edit.kind == "entries swapped" for edit in told)


def test_a_sign_is_told_where_a_name_is_set_if_that_is_the_textbook_s() -> None:
    text = """
import numpy as np

def f(q, v, a):
    m1, m2, g, l1, l2 = 2.0, 1.5, 9.81, 0.5, 0.4
    h = m2*l1*l2*np.sin(q[1])
    b = m2*l1*l2*np.cos(q[1])
    cor1 = -h*(2*v[0]*v[1] + v[1]**2)
    cor2 = h*v[0]**2
    grav2 = m2*g*l2*np.cos(q[0] + q[1])
    grav1 = (m1 + m2)*g*l1*np.cos(q[0]) + grav2
    first = ((m1 + m2)*l1**2 + m2*l2**2 + 2*b)*a[0] + (m2*l2**2 + b)*a[1]
    second = (m2*l2**2 + b)*a[0] + m2*l2**2*a[1]
    return np.array([first + cor1 + grav1, second + cor2 + grav2])
"""
    wrong = with_slips(text, [("cor2 = h*", "cor2 = -h*")])
    assert kl.diagnose("planar2r", "inverse_dynamics", written(text)).agrees
    found = kl.diagnose("planar2r", "inverse_dynamics", written(wrong))
    assert "should be `cor2 = h*v[0]**2`" in found.causes[0].sentence, str(found)
