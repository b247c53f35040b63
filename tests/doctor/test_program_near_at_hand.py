"""What stands in a line beside, what others of its kind have, what the program's own functions do.

Every program is right before the slip; what is said makes it right, and is what was there.
"""

from __future__ import annotations

import pytest
from hand_programs import told_in_its_line, with_slips, written

import kinlab as kl

RODS = """
import numpy as np
l1, l2, e = 0.035, 0.0551, 0.0125
side = np.array([1.0, -1.0])

def f(p, mode):
    px = p[0] - side*e
    py = np.full(2, p[1])
    far = px**2 + py**2
    k = (far + l1**2 - l2**2)/2
    h = np.sqrt(l1**2*far - k**2)
    ux, uy = (k*px + mode*h*py)/(l1*far), (k*py - mode*h*px)/(l1*far)
    wx = (p[0] - side*e - l1*ux)/l2
    wy = (p[1] - l1*uy)/l2
    return np.stack([wx, wy], axis=1)
"""
RATES = """
import numpy as np
L1, L2, E = 0.3, 0.5, 0.2/2**0.5

def perp(a):
    return np.array([-a[1], a[0]])

def f(p, v, mode):
    out = []
    for s, x0 in zip(mode, (E, -E)):
        r = np.array([p[0] - x0, p[1]])
        n = np.linalg.norm(r)
        c = (n**2 + L1**2 - L2**2)/(2*n*L1)
        u = c*r/n - s*np.sqrt(1 - c**2)*perp(r/n)
        w = (r - L1*u)/L2
        out.append(np.linalg.solve(np.column_stack([L1*perp(u), L2*perp(w)]), v)[0])
    return np.array(out)
"""
HEIGHTS = """
from math import cos, sin

def f(q):
    r, h, E = (0.0, 0.0, 1.0), 0.0, 0.0
    table = [(0, 0, 1), (0.4318, 0, 0), (0.0203, 0.15005, -1), (0, 0.4318, 1), (0, 0, -1), (0, 0, 0)]
    kg = [0, 17.4, 4.8, 0.82, 0.34, 0.09]
    com = [(0, 0, 0), (-0.3638, 0.006, 0.2275), (-0.0203, -0.0141, 0.07), (0, 0.019, 0), (0, 0, 0),
           (0, 0, 0.032)]
    for t, (a, d, sa), m, (x, y, z) in zip(q, table, kg, com):
        ca, u, v = 1 - abs(sa), r[0]*cos(t) + r[1]*sin(t), r[1]*cos(t) - r[0]*sin(t)
        h += a*u + d*r[2]
        r = (u, v*ca + r[2]*sa, r[2]*ca - v*sa)
        E += m*9.81*(h + r[0]*x + r[1]*y + r[2]*z)
    return E
"""
ROTORS = """
from math import cos, sin

def f(q, v):
    w2, w4 = v[0] + v[1], v[0] + v[1] - v[3]
    T = 0.5*(0.1 + 7.0*0.165**2)*v[0]**2 + 0.5*0.055*w2**2
    T += 0.5*5.0*(0.325**2*v[0]**2 + (0.145**2 + 0.005**2)*w2**2)
    T += 5.0*0.325*v[0]*w2*(0.145*cos(q[1]) + 0.005*sin(q[1]))
    tip = 0.325**2*v[0]**2 + 0.275**2*w2**2 + 2*0.325*0.275*v[0]*w2*cos(q[1]) + v[2]**2
    away = 0.325*v[0]*cos(q[1] - q[3]) + 0.275*w2*cos(q[3])
    T += 0.5*1.6*tip + 0.5*0.4*(0.01**2*w4**2 + 2*0.01*w4*away) + 0.5*0.0008*w2**2 + 0.5*0.0006*w4**2
    T += 0.5*(0.3*v[0]**2 + 0.1*v[1]**2 + 2.0*v[2]**2 + 0.02*v[3]**2)
    return T
"""
TIP = """
import numpy as np
ROWS = [(0, 0, .333), (0, -1, 0), (0, 1, .316), (.0825, 1, 0), (-.0825, -1, .384), (0, 1, 0),
        (.088, 1, 0)]

def f(q):
    T, frames = np.eye(4), []
    for (a, s, d), t in zip(ROWS, q):
        c = 1.0 - abs(s)
        T = T @ np.array([[np.cos(t), -np.sin(t), 0, a], [np.sin(t)*c, np.cos(t)*c, -s, -s*d],
                          [np.sin(t)*s, np.cos(t)*s, c, c*d], [0, 0, 0, 1]])
        frames.append(T)
    tip = T @ np.array([0, 0, 0.107, 1])
    return np.column_stack([np.hstack((np.cross(F[:3, 2], tip[:3] - F[:3, 3]), F[:3, 2]))
                            for F in frames])
"""


@pytest.mark.parametrize(
    ("robot", "quantity", "text", "right", "slip"),
    [
        ("plotclock", "fivebar_rods", RODS, "(p[0] - side*e - l1*ux)", "(p[0] - l1*ux)"),
        ("isotropic", "fivebar_rates", RATES, "L2*perp(w)", "L2*w"),
        ("puma560", "potential_energy", HEIGHTS, "a*u + d*r[2]", "a*u + d*v"),
        ("scara", "kinetic_energy", ROTORS, " + 2.0*v[2]**2 + 0.02", " + 0.02"),
        ("panda", "jacobian", TIP, "[0, 0, 0.107, 1]", "[0, 0, 0, 1])\n    return"),
    ],
    ids=["sum", "function", "entry", "rotor", "tip"],
)
def test_what_is_near_at_hand_is_told_in_its_line(robot, quantity, text, right, slip, tmp_path):
    if slip.endswith("return"):
        right, slip = right + ")\n    return", slip
    told_in_its_line(robot, quantity, text, right, slip, tmp_path / "hand.py")


FALLING = """
import numpy as np

class Arm:
    m, l, I = [3.0, 2.0, 1.0], [0.5, 0.4, 0.25], [0.0625, 2.0*0.4**2/12, 0.25**2/12]
    gravity = np.array([0, -9.81, 0])

    def outward(self, q, v, a):
        self.at, self.c, self.F, self.N = [], [], [], []
        t = w = dw = 0.0
        p, acc = np.zeros(3), np.zeros(3)
        for k in range(3):
            t, w, dw = t + q[k], w + v[k], dw + a[k]
            way = self.l[k]*np.array([np.cos(t), np.sin(t), 0])
            turned = dw*np.array([-way[1], way[0], 0]) - w**2*way
            self.at.append(p)
            self.c.append(p + way/2)
            self.F.append(self.m[k]*(acc + turned/2 - self.gravity))
            self.N.append(self.I[k]*dw)
            p, acc = p + way, acc + turned

    def inward(self):
        return [sum(np.cross(self.c[j] - self.at[k], self.F[j])[2] + self.N[j] for j in range(k, 3))
                for k in range(3)]

arm = Arm()

def f(q, v, a):
    arm.outward(q, v, a)
    return arm.inward()
"""


def test_gravity_that_falls_is_right_as_it_is_typed(tmp_path) -> None:
    """In a class, too: the sign in the line that uses it is told, and not the number's."""
    wrong = with_slips(FALLING, [("turned/2 - self.gravity", "turned/2 + self.gravity")])
    (tmp_path / "hand.py").write_text(wrong)
    found = kl.diagnose("planar3r", "inverse_dynamics", written(wrong, tmp_path / "hand.py"))
    (cause,) = found.causes
    assert "turned/2 - self.gravity" in cause.sentence.partition("; or else")[0]


POINTS = """
from math import cos, sin
L, LC = (0.5, 0.4, 0.25), (0.25, 0.2, 0.125)

def f(q, v, a):
    ax = ay = t = w = dw = 0.0
    out = []
    for k in range(3):
        t, w, dw = t + q[k], w + v[k], dw + a[k]
        r, n = (cos(t), sin(t)), (-sin(t), cos(t))
        acc = lambda s: (ax + s*(dw*n[0] - w**2*r[0]), ay + s*(dw*n[1] - w**2*r[1]))
        bx, by = acc(LC[k])
        out.append([bx*r[0] + by*r[1], bx*n[0] + by*n[1], 0.0])
        ax, ay = acc(L[k])
    return out
"""


def test_an_edit_of_the_data_is_in_no_row_of_the_text(tmp_path) -> None:
    """Two slips, between which the data are looked at, end in no fault."""
    slips = [("ax, ay = acc(L[k])", "ax, ay = acc(LC[k])")]
    slips += [("dw*n[0] - w**2*r[0]), ay + s*(dw*n[1] - w**2*r[1]", "dw*n[0] - w*r[0]), ay + s*(dw*n[1] - w*r[1]")]  # fmt: skip
    wrong = with_slips(POINTS, slips)
    (tmp_path / "hand.py").write_text(wrong)
    found = kl.diagnose("planar3r", "com_accelerations", written(wrong, tmp_path / "hand.py"))
    assert "acc(L[k])" in found.sentence
    assert found.sentence.count("w**2") == 2


SHARED = """
import numpy as np

def f(q):
    s2, c2 = np.sin(q[1]), np.cos(q[1])
    elbow = 0.089159 - 0.425*s2
    wrist = elbow - 0.39225*np.sin(q[1] + q[2])
    tip = wrist - 0.09465*np.cos(q[1] + q[2] + q[3])
    h2, h3 = elbow + 0.145*s2, wrist + 0.14225*np.sin(q[1] + q[2])
    return 9.81*(3.7*0.089159 + 8.393*h2 + 2.275*h3 + 1.219*(wrist + wrist) + 0.1879*tip)
"""
ALONG = """
import numpy as np
TABLE = \"\"\"
0 0 0.333
0 -90 0
0 90 0.316
0.0825 90 0
-0.0825 -90 0.384
0 90 0
0.088 90 0
\"\"\"
ROWS = [tuple(map(float, line.split())) for line in TABLE.strip().splitlines()]

def f(q):
    T = np.eye(4)
    for (a, turn, d), t in zip(ROWS, q):
        c, s, ca, sa = np.cos(t), np.sin(t), np.cos(np.radians(turn)), np.sin(np.radians(turn))
        T = T @ np.array([[c, -s, 0, a], [s*ca, c*ca, -sa, -d*sa], [s*sa, c*sa, ca, d*ca],
                          [0, 0, 0, 1]])
    T[:3, 3] += 0.107*T[:3, 2]
    return T
"""


def test_one_number_for_two_masses_is_no_reason_to_doubt(tmp_path) -> None:
    """No arm with two other masses can be put in; and the cosine is one by its name."""
    right, slip = "elbow + 0.145*s2", "elbow + 0.145*c2"
    told_in_its_line("ur5", "potential_energy", SHARED, right, slip, tmp_path / "hand.py")


def test_a_cosine_that_is_set_to_a_sine_is_still_told_there(tmp_path) -> None:
    right, slip = "np.sin(q[1]), np.cos(q[1])\n", "np.cos(q[1]), np.cos(q[1])\n"
    told_in_its_line("ur5", "potential_energy", SHARED, right, slip, tmp_path / "hand.py")


def test_a_way_along_the_base_s_axis_is_one_along_the_frame_s(tmp_path) -> None:
    right, slip = "T[:3, 3] += 0.107*T[:3, 2]", "T[2, 3] += 0.107"
    told_in_its_line("panda", "fk", ALONG, right, slip, tmp_path / "hand.py")


CARRIED = """
import numpy as np
ALPHA = [0, np.pi/2, 0, -np.pi/2, np.pi/2, -np.pi/2]
A, D = [0, 0, 0.4318, 0.0203, 0, 0], [0, 0, 0.15005, 0.4318, 0, 0]

def one(q, rate):
    w, v = np.zeros(3), np.zeros(3)
    for k in range(6):
        c, s, ca, sa = np.cos(q[k]), np.sin(q[k]), np.cos(ALPHA[k]), np.sin(ALPHA[k])
        R = np.array([[c, s*ca, s*sa], [-s, c*ca, c*sa], [0, -sa, ca]])
        P = np.array([A[k], -sa*D[k], ca*D[k]])
        v = R @ (v + np.cross(w, P))
        w = R @ w
        w[2] += rate[k]
    return np.r_[v, w]

def f(q):
    return np.array([one(q, e) for e in np.eye(6)]).T
"""


def test_a_sign_that_does_what_the_other_order_does_is_not_told_alone(tmp_path) -> None:
    wrong = with_slips(CARRIED, [("np.cross(w, P)", "np.cross(P, w)")])
    (tmp_path / "hand.py").write_text(wrong)
    found = kl.diagnose("puma560_modified", "jacobian_tool", written(wrong, tmp_path / "hand.py"))
    assert "np.cross(w, P)" in found.causes[0].sentence


SOLVED = """
import numpy as np
L, d = 0.09, 0.118

def f(p, v, mode):
    r = p - np.array([[d/2, 0.0], [-d/2, 0.0]])
    far = np.hypot(r[:, 0], r[:, 1])
    t = np.arctan2(r[:, 1], r[:, 0]) - mode*np.arccos(far/(2*L))
    crank = L*np.column_stack((np.cos(t), np.sin(t)))
    A = r - crank
    B = np.diag(crank[:, 0]*A[:, 1] - crank[:, 1]*A[:, 0])
    return np.linalg.solve(B, A @ v)
"""
TURNED = """
import numpy as np
A, D = [0, 0.4318, 0.0203, 0, 0, 0], [0, 0, 0.15005, 0.4318, 0, 0]
AL = [np.pi/2, 0, -np.pi/2, np.pi/2, -np.pi/2, 0]
M = [0, 17.4, 4.8, 0.82, 0.34, 0.09]
C = [[0, 0, 0], [-0.3638, 0.006, 0.2275], [-0.0203, -0.0141, 0.07], [0, 0.019, 0], [0, 0, 0], [0, 0, 0.032]]
I = [[0, 0, 0], [0.13, 0.524, 0.539], [0.0685, 0.0835, 0.015], [0.0018, 0.0013, 0.0018],
     [0.0003, 0.0004, 0.0003], [0.00015, 0.00015, 0.00004]]

def f(q):
    R, o = [np.eye(3)], [np.zeros(3)]
    for k in range(6):
        c, s, ca, sa = np.cos(q[k]), np.sin(q[k]), np.cos(AL[k]), np.sin(AL[k])
        o.append(o[k] + R[k] @ [A[k]*c, A[k]*s, D[k]])
        R.append(R[k] @ [[c, -s*ca, s*sa], [s, c*ca, -c*sa], [0, sa, ca]])
    H = np.diag([1.134029969, 2.324814845, 0.576873332, 0.190790626, 0.170706292, 0.194064506])
    for k in range(6):
        at = o[k+1] + R[k+1] @ C[k]
        V, W = np.zeros((3, 6)), np.zeros((3, 6))
        for j in range(k + 1):
            W[:, j] = R[j][:, 2]
            V[:, j] = np.cross(R[j][:, 2], at - o[j])
        own = R[k+1] @ np.diag(I[k]) @ R[k+1].T
        H = H + M[k]*V.T @ V + W.T @ own @ W
    return H
"""
KINDS = """
import numpy as np
h = np.pi/2
ARM = [("R", -h, 0, 0.412, 0, 9.29, [0, 0.0175, -0.1105], [0.276, 0.255, 0.071], 0.953),
       ("R", h, 0, 0.154, 0, 5.01, [0, -0.1054, 0], [0.108, 0.018, 0.1], 2.193),
       ("P", 0, 0.0203, 0, -h, 4.25, [0, 0, -0.6447], [2.51, 2.51, 0.006], 0.782),
       ("R", -h, 0, 0, 0, 1.08, [0, 0.0092, -0.0054], [0.002, 0.001, 0.001], 0.106),
       ("R", h, 0, 0, 0, 0.63, [0, 0, 0.0566], [0.003, 0.003, 0.0004], 0.097),
       ("R", 0, 0, 0.263, 0, 0.51, [0, 0, 0.1554], [0.013, 0.013, 0.0003], 0.02)]

def f(q, v):
    R, w, u, T = np.eye(3), np.zeros(3), np.zeros(3), 0.0
    for (kind, al, a, d, th, m, c, I, J), x, rate in zip(ARM, q, v):
        z = R[:, 2]
        t, d = (th + x, d) if kind == "R" else (th, d + x)
        ct, st, ca, sa = np.cos(t), np.sin(t), np.cos(al), np.sin(al)
        step = R @ [a*ct, a*st, d]
        if kind == "R":
            w = w + rate*z
        u = u + np.cross(w, step) + (rate*z if kind == "P" else 0)
        R = R @ np.array([[ct, -st*ca, st*sa], [st, ct*ca, -ct*sa], [0, sa, ca]])
        g, own = u + np.cross(w, R @ c), R.T @ w
        T += 0.5*m*g @ g + 0.5*own @ (np.array(I)*own) + 0.5*J*rate**2
    return T
"""


@pytest.mark.parametrize(
    ("robot", "quantity", "text", "right", "slip"),
    [
        ("equal_links", "fivebar_rates", SOLVED, "solve(B, A @ v)", "solve(A, B @ v)"),
        ("puma560", "mass_matrix", TURNED, "own = R[k+1] @ np.diag(I[k]) @ R[k+1].T", "own = R[k] @ np.diag(I[k]) @ R[k].T"),
        ("stanford", "kinetic_energy", KINDS, ' + (rate*z if kind == "P" else 0)', "\n        R = R"),
    ],
    ids=["exchanged", "throughout", "kind"],
)  # fmt: skip
def test_what_goes_together_is_told_together(robot, quantity, text, right, slip, tmp_path) -> None:
    if slip.startswith("\n"):
        right, slip = right + "\n        R = R", slip
    told_in_its_line(robot, quantity, text, right, slip, tmp_path / "hand.py")


LIFTED = """
import numpy as np

def f(q):
    a1, a2, high = 0.325, 0.275, 0.387
    t = q[0] + q[1] - q[3]
    x, y = a1*np.cos(q[0]) + a2*np.cos(q[0] + q[1]), a1*np.sin(q[0]) + a2*np.sin(q[0] + q[1])
    z = high - q[2]
    return np.array([[np.cos(t), np.sin(t), 0, x], [np.sin(t), -np.cos(t), 0, y], [0, 0, -1, z],
                     [0, 0, 0, 1]])
"""


def test_a_term_is_missing_where_the_name_is_set(tmp_path) -> None:
    wrong = with_slips(LIFTED, [("z = high - q[2]", "z = -q[2]")])
    (tmp_path / "hand.py").write_text(wrong)
    found = kl.diagnose("scara", "fk", written(wrong, tmp_path / "hand.py"))
    first = found.causes[0].sentence.partition("; or else")[0]
    assert "`z = -q[2]`" in first
