"""What a loop carries on, sums over a part of an arm, what helpers are asked, and settings.

Every program is right before the slip; what is said makes it right, and is what was there.
"""

from __future__ import annotations

import pytest
from hand_programs import asked, told_in_its_line, with_slips, written

import kinlab as kl

TURNS = """
import numpy as np

def f(q):
    at, turn = 0j, 1 + 0j
    for reach, angle in zip((0.5, 0.4, 0.25), q):
        turn = turn * np.exp(1j*angle)
        at += reach * turn
    return np.array([[turn.real, -turn.imag, 0, at.real], [turn.imag, turn.real, 0, at.imag],
                     [0, 0, 1, 0], [0, 0, 0, 1]])
"""
OUTWARD = """
import numpy as np
mass, reach = np.array([3.0, 2.0, 1.0]), np.array([0.5, 0.4, 0.25])

def f(q):
    phi = np.cumsum(q)
    x = np.concatenate([[0.0], np.cumsum(reach*np.cos(phi))])
    centres = x[:-1] + reach/2*np.cos(phi)
    G = np.zeros(3)
    for j in range(3):
        carried = mass[j:].sum()
        G[j] = 9.81*(mass[j:] @ centres[j:] - carried*x[j])
    return G
"""
LISTED = """
from itertools import accumulate
import numpy as np

def f(q):
    phi = list(accumulate(q))
    bars = [r*np.exp(1j*t) for r, t in zip((0.5, 0.4, 0.25), phi)]
    arms = list(accumulate(reversed(bars)))[::-1]
    return [[-z.imag for z in arms], [z.real for z in arms], [1, 1, 1]]
"""
DUAL = """
import math

class Dual:
    def __init__(self, a, b=0.0):
        self.a, self.b = a, b
    def __add__(self, other):
        return Dual(self.a + other.a, self.b + other.b)

def sine(x):
    return Dual(math.sin(x.a), math.cos(x.a)*x.b)

def cosine(x):
    return Dual(math.cos(x.a), -math.sin(x.a)*x.b)

def f(q, qd):
    one, two = Dual(q[0], qd[0]), Dual(q[0] + q[1], qd[0] + qd[1])
    x1, y1 = 0.5*cosine(one).b, 0.5*sine(one).b
    x2, y2 = x1 + 0.4*cosine(two).b, y1 + 0.4*sine(two).b
    return 0.5*2.0*(x1**2 + y1**2) + 0.5*1.5*(x2**2 + y2**2)
"""
COLUMNS = """
import numpy as np
m, l = [3.0, 2.0, 1.0], [0.5, 0.4, 0.25]

def energy(q, rates):
    phi = w = 0.0
    v, T = np.zeros(2), 0.0
    for k in range(3):
        phi, w = phi + q[k], w + rates[k]
        across = np.array([-np.sin(phi), np.cos(phi)])
        centre = v + w*l[k]/2*across
        T += 0.5*m[k]*centre @ centre + 0.5*(m[k]*l[k]**2/12)*w**2
        v = v + w*l[k]*across
    return T

def f(q):
    E = np.eye(3)
    own = [energy(q, one) for one in E]
    return np.array([[energy(q, E[i] + E[j]) - own[i] - own[j] for j in range(3)]
                     for i in range(3)])
"""
RATES = """
import numpy as np

def f(q, v):
    l1, l2 = 0.5, 0.4
    w = v[0] + v[1]
    s12, c12 = np.sin(q[0] + q[1]), np.cos(q[0] + q[1])
    out = np.zeros((6, 2))
    out[0, 1], out[1, 1] = -l2*c12*w, -l2*s12*w
    out[0, 0] = out[0, 1] - l1*np.cos(q[0])*v[0]
    out[1, 0] = out[1, 1] - l1*np.sin(q[0])*v[0]
    return out
"""
FORCES = """
import numpy as np
m, l = [2.0, 1.5], [0.5, 0.4]

def f(q, qd, qdd):
    phi, w, al = np.cumsum(q), np.cumsum(qd), np.cumsum(qdd)
    along = [np.array([np.cos(t), np.sin(t), 0.0]) for t in phi]
    across = [np.array([-np.sin(t), np.cos(t), 0.0]) for t in phi]
    acc, tips = np.array([0.0, 9.81, 0.0]), []
    for i in range(2):
        acc = acc + l[i]*(al[i]*across[i] - w[i]**2*along[i])
        tips.append(acc)
    F, N, tau = np.zeros(3), np.zeros(3), np.zeros(2)
    for i in (1, 0):
        F = F + m[i]*tips[i]
        N = N + np.cross(l[i]*along[i], F)
        tau[i] = N[2]
    return tau
"""


@pytest.mark.parametrize(
    ("robot", "quantity", "text", "right", "slip"),
    [
        ("planar3r", "fk", TURNS, "reach * turn", "reach * np.exp(1j*angle)"),
        ("planar3r", "gravity_torques", OUTWARD, "mass[j:].sum()", "mass.sum()"),
        ("planar3r", "planar_jacobian", LISTED, "list(accumulate(q))", "list(q)"),
        (
            "planar3r",
            "planar_jacobian",
            LISTED,
            "list(accumulate(reversed(bars)))[::-1]",
            "list(accumulate(bars))",
        ),
        ("planar2r", "kinetic_energy", DUAL, "-math.sin(x.a)*x.b", "-math.sin(x.a)"),
        ("planar3r", "mass_matrix", COLUMNS, "centre = v + w", "centre = w"),
        ("planar2r", "jacobian_dot", RATES, "np.sin(q[0])*v[0]", "np.sin(q[0])*w"),
        (
            "planar2r",
            "inverse_dynamics",
            FORCES,
            "np.cross(l[i]*along[i], F)",
            "np.cross(l[i]*along[i], m[i]*tips[i])",
        ),
    ],
)
def test_what_is_carried_on_is_told_in_its_line(robot, quantity, text, right, slip, tmp_path):
    told_in_its_line(robot, quantity, text, right, slip, tmp_path / "hand.py")


SWITCHED = """
import numpy as np
LEFT_OUT = "nothing"
A, ALPHA = [0.0, 0.45, 0.35], [0.0, 0.0, np.pi/2]
MASS = [3.0, 2.0, 1.2]
COM = [np.array([0.2, 0.02, -0.01]), np.array([0.15, -0.01, 0.03]), np.array([0.12, 0.03, 0.01])]
INERTIA = [np.diag([0.02, 0.08, 0.07]), np.diag([0.01, 0.04, 0.045]),
           np.array([[0.004, 0.001, 0], [0.001, 0.012, 0.0005], [0, 0.0005, 0.014]])]

def f(q, qd, qdd):
    w, dw, acc = np.zeros(3), np.zeros(3), np.array([0.0, 0.0, 9.81])
    R, P, F, N = [], [], [], []
    for i in range(3):
        c, s, ca, sa = np.cos(q[i]), np.sin(q[i]), np.cos(ALPHA[i]), np.sin(ALPHA[i])
        R.append(np.array([[c, -s, 0], [s*ca, c*ca, -sa], [s*sa, c*sa, ca]]))
        P.append(np.array([A[i], 0.0, 0.0]))
        z = np.array([0.0, 0.0, 1.0])
        acc = R[i].T @ (acc + np.cross(dw, P[i]) + np.cross(w, np.cross(w, P[i])))
        turned = R[i].T @ w
        dw = R[i].T @ dw + np.cross(turned, qd[i]*z) + qdd[i]*z
        w = turned + qd[i]*z
        centre = acc + np.cross(dw, COM[i]) + np.cross(w, np.cross(w, COM[i]))
        moment = INERTIA[i] @ dw
        if LEFT_OUT != "gyroscopic moment":
            moment = moment + np.cross(w, INERTIA[i] @ w)
        F.append(MASS[i]*centre)
        N.append(moment)
    n, force, tau = np.zeros(3), np.zeros(3), np.zeros(3)
    R.append(np.eye(3))
    P.append(np.zeros(3))
    for i in (2, 1, 0):
        n = N[i] + R[i+1] @ n + np.cross(COM[i], F[i]) + np.cross(P[i+1], R[i+1] @ force)
        force = R[i+1] @ force + F[i]
        tau[i] = n[2]
    return tau
"""


def test_a_setting_by_its_name_is_no_condition_that_is_wrong(tmp_path) -> None:
    """What it leaves out is told, and not that the program should leave out the contrary."""
    slips = [('LEFT_OUT = "nothing"', 'LEFT_OUT = "gyroscopic moment"')]
    wrong = with_slips(SWITCHED, slips)
    found = kl.diagnose("spatial3r", "inverse_dynamics", written(wrong))
    assert not found.agrees
    assert found.causes
    assert all("condition" not in cause.kinds for cause in found.causes)
    assert "I w" in found.causes[0].sentence


ROWS = """
import numpy as np
C = [(0.0, 0.0, 0.0), (-0.3638, 0.006, 0.2275), (-0.0203, -0.0141, 0.07),
     (0.0, 0.019, 0.0), (0.0, 0.0, 0.0), (0.0, 0.0, 0.032)]
A, D = [0, 0.4318, 0.0203, 0, 0, 0], [0, 0, 0.15005, 0.4318, 0, 0]
ALPHA = [np.pi/2, 0, -np.pi/2, np.pi/2, -np.pi/2, 0]

def f(q):
    T, out = np.eye(4), []
    for k in range(6):
        c, s, ca, sa = np.cos(q[k]), np.sin(q[k]), np.cos(ALPHA[k]), np.sin(ALPHA[k])
        T = T @ np.array([[c, -s*ca, s*sa, A[k]*c], [s, c*ca, -c*sa, A[k]*s],
                          [0, sa, ca, D[k]], [0, 0, 0, 1]])
        out.append(T[:3, :3] @ np.array(C[k]) + T[:3, 3])
    return np.array(out)
"""
SCARA = """
import numpy as np
L1, L2 = 0.325, 0.275

def f(q):
    m = [7.0, 5.0, 1.2, 0.4]
    u1, u2 = np.exp(1j*q[0]), np.exp(1j*(q[0] + q[1]))
    u4 = np.exp(1j*(q[0] + q[1] - q[3]))
    elbow, wrist = L1*u1, L1*u1 + L2*u2
    c1, c2 = (L1 - 0.16)*u1, elbow + (0.145 - 0.005j)*u2
    c4 = wrist + 0.01*u4
    spins = [np.array([1, 0, 0, 0]), np.array([1, 1, 0, 0]), np.array([1, 1, 0, -1])]
    M = np.diag([0.3, 0.1, 2.0 + m[2] + m[3], 0.02])
    moved = [(m[0], [c1, 0, 0, 0]), (m[1], [c2, c2 - elbow, 0, 0]),
             (m[2], [wrist, wrist - elbow, 0, 0]), (m[3], [c4, c4 - elbow, 0, -(c4 - wrist)])]
    for mass, row in moved:
        z = np.array(row)
        M = M + mass*np.real(np.outer(np.conj(z), z))
    for I, w in zip((0.1, 0.055 + 0.0008, 0.0006), spins):
        M = M + I*np.outer(w, w)
    return M
"""


@pytest.mark.parametrize(
    ("robot", "quantity", "text", "right", "slip"),
    [
        ("scara", "mass_matrix", SCARA, "c1, c2 = (L1 - 0.16)*u1", "c1, c2 = L1*u1"),
        ("scara", "mass_matrix", SCARA, "0.055 + 0.0008", "0.055"),
    ],
)
def test_numbers_of_the_arm_in_another_place_or_left_out(
    robot, quantity, text, right, slip, tmp_path
):
    found, good = asked(with_slips(text, [(right, slip)]), robot, quantity, tmp_path / "hand.py")
    assert good, found.sentence
    assert len(found.causes[0].kinds) == 1


def test_a_row_with_noughts_is_exchanged_in_its_place(tmp_path) -> None:
    """A nought in the place where a centre's number was is no number of another link."""
    wrong = with_slips(ROWS, [("(0.0, 0.019, 0.0)", "(0.0, 0.0, 0.019)")])
    (tmp_path / "hand.py").write_text(wrong)
    f = written(wrong, tmp_path / "hand.py")
    told = kl.diagnose("puma560", "com_positions", f).sentence
    assert "C[3], two entries are exchanged: `0, 0, 0.019` should be `0, 0.019, 0`" in told


POSE = """
import numpy as np

def f(q):
    T = np.eye(3)
    for l, t in zip((0.5, 0.4, 0.25), q):
        c, s = np.cos(t), np.sin(t)
        T = T @ np.array([[c, -s, 0], [s, c, 0], [0, 0, 1]]) @ np.array([[1, 0, l], [0, 1, 0], [0, 0, 1]])
    return np.array([T[0, 2], T[1, 2], T[0, 0], T[1, 0]])
"""


def test_another_sign_or_the_transpose_are_both_told(tmp_path) -> None:
    wrong = with_slips(POSE, [("T[1, 0]])", "T[0, 1]])")])
    told = kl.diagnose("planar3r", "planar_pose", written(wrong)).sentence
    assert "-T[0, 1]" in told
    assert "or `" in told
    assert "T[1, 0]" in told


HEIGHTS = """
from math import sin

def f(q):
    shoulder = 0.1273
    middle = shoulder - 0.306*sin(q[1])
    elbow = shoulder - 0.612*sin(q[1])
    forearm = elbow - 0.28615*sin(q[1] + q[2])
    wrist = elbow - 0.5723*sin(q[1] + q[2])
    tool = wrist - 0.1157*__import__("math").cos(q[1] + q[2] + q[3])
    return 9.81*(7.778*shoulder + 12.93*middle + 3.87*forearm + (1.96 + 1.96)*wrist + 0.202*tool)
"""


def test_a_point_is_rather_another_point_than_taken_twice(tmp_path) -> None:
    text = HEIGHTS.replace('__import__("math").cos', "cos").replace("import sin", "import cos, sin")
    right, slip = "forearm = elbow - ", "forearm = middle - "
    told_in_its_line("ur10", "potential_energy", text, right, slip, tmp_path / "hand.py")


MOVING = """
import numpy as np

def f(q, v):
    a, b = q[0], q[0] + q[1]
    wa, wb = v[0], v[0] + v[1]
    x1, y1 = -0.165*np.sin(a)*wa, 0.165*np.cos(a)*wa
    ex, ey = -0.325*np.sin(a)*wa, 0.325*np.cos(a)*wa
    x2 = ex - (0.145*np.sin(b) - 0.005*np.cos(b))*wb
    y2 = ey + (0.145*np.cos(b) + 0.005*np.sin(b))*wb
    x3, y3, z3 = ex - 0.275*np.sin(b)*wb, ey + 0.275*np.cos(b)*wb, -v[2]
    d, wd = b - q[3], wb - v[3]
    x4, y4 = x3 - 0.01*np.sin(d)*wd, y3 + 0.01*np.cos(d)*wd
    T = 0.5*7.0*(x1**2 + y1**2) + 0.5*0.1*wa**2
    T += 0.5*5.0*(x2**2 + y2**2) + 0.5*0.055*wb**2
    T += 0.5*1.2*(x3**2 + y3**2 + z3**2) + 0.5*0.0008*wb**2
    T += 0.5*0.4*(x4**2 + y4**2 + z3**2) + 0.5*0.0006*wd**2
    return T + 0.5*(0.3*v[0]**2 + 0.1*v[1]**2 + 2.0*v[2]**2 + 0.02*v[3]**2)
"""


def test_what_one_sum_gets_and_another_loses_is_no_cause() -> None:
    """7 kg less 5 kg are the 2 kg of the rotor that was left out, by chance."""
    wrong = with_slips(MOVING, [(" + 2.0*v[2]**2", "")])
    found = kl.diagnose("scara", "kinetic_energy", written(wrong))
    assert not found.agrees
    assert not any(c.kinds == ("missing term", "missing term") for c in found.causes)


OBJECTS = """
import numpy as np

class Turn:
    def __init__(self, R, p):
        self.R, self.p = R, p
    def __matmul__(self, other):
        return Turn(self.R @ other.R, self.R @ other.p + self.p)

def f(q):
    T, out = Turn(np.eye(2), np.zeros(2)), []
    for t, l in zip(q, (0.5, 0.4, 0.25)):
        c, s = np.cos(t), np.sin(t)
        R = np.array([[c, -s], [s, c]])
        out.append((T @ Turn(R, np.zeros(2)) @ Turn(np.eye(2), np.array([l/2, 0.0]))).p)
        T = T @ Turn(R, np.zeros(2)) @ Turn(np.eye(2), np.array([l, 0.0]))
    return np.array([[p[0], p[1], 0.0] for p in out])
"""
BY_KEYS = """
import math
import numpy as np

def f(q):
    h = 1.5*0.5*0.4*math.sin(q[1])
    slopes = {(0, 0, 1): -2*h, (0, 1, 1): -h, (1, 0, 1): -h}
    c = np.zeros((2, 2, 2))
    for i, j, k in np.ndindex(2, 2, 2):
        c[i, j, k] = (slopes.get((i, j, k), 0.0) + slopes.get((i, k, j), 0.0)
                      - slopes.get((j, k, i), 0.0))/2
    return c
"""
IN_TEXT = '''
import numpy as np

TABLE = """
# a        alpha  d
0.0        90     0.089159
-0.425     0      0.0
-0.39225   0      0.0
0.0        90     0.10915
0.0        -90    0.09465
0.0        0      0.0823
"""
ROWS = [[float(x) for x in line.split()] for line in TABLE.strip().split("\\\\n")[1:]]

def f(q):
    T = np.diag([-1.0, -1.0, 1.0, 1.0])
    for (a, al, d), t in zip(ROWS, q):
        c, s = np.cos(t), np.sin(t)
        ca, sa = np.cos(np.deg2rad(al)), np.sin(np.deg2rad(al))
        T = T @ np.array([[c, -s*ca, s*sa, a*c], [s, c*ca, -c*sa, a*s], [0, sa, ca, d],
                          [0, 0, 0, 1]])
    return T
'''.replace("\\\\n", "\\n")
WEIGHTS = """
import numpy as np
a, d = [0, -0.425, -0.39225, 0, 0, 0], [0.089159, 0, 0, 0.10915, 0.09465, 0.0823]
al = np.array([1, 0, 0, 1, -1, 0])*np.pi/2
m = [3.7, 8.393, 2.275, 1.219, 1.219, 0.1879]
r = np.array([[0, 0, 0], [0.145, 0, 0.13585], [0.14225, 0, 0.01615],
              [0, -0.093, 0], [0, 0.09465, 0], [0, 0, -0.0823]])

def f(q):
    R, p = np.diag([-1.0, -1, 1]), np.zeros(3)
    axes, origins, centres = [], [], []
    for i in range(6):
        axes.append(R[:, 2])
        origins.append(p)
        c, s, ca, sa = np.cos(q[i]), np.sin(q[i]), np.cos(al[i]), np.sin(al[i])
        p = p + R @ np.array([a[i]*c, a[i]*s, d[i]])
        R = R @ np.array([[c, -s*ca, s*sa], [s, c*ca, -c*sa], [0, sa, ca]])
        centres.append(p + R @ r[i])
    G = np.zeros(6)
    for j in range(6):
        for i in range(j, 6):
            G[j] += m[i]*9.81*np.cross(axes[j], centres[i] - origins[j])[2]
    return G
"""


OF_C = """
from math import cos, sin
import numpy as np

def product(A, B, out):
    for i in range(3):
        for j in range(3):
            out[3*i + j] = A[3*i]*B[j] + A[3*i + 1]*B[3 + j] + A[3*i + 2]*B[6 + j]

def step(A, angle, reach):
    A[0] = cos(angle); A[1] = -sin(angle); A[2] = reach*cos(angle)
    A[3] = sin(angle); A[4] = cos(angle); A[5] = reach*sin(angle)
    A[6] = 0.0; A[7] = 0.0; A[8] = 1.0

def f(q):
    T, A = [1.0, 0.0, 0.0, 0.0, 1.0, 0.0, 0.0, 0.0, 1.0], [0.0]*9
    for n in range(3):
        out = [0.0]*9
        step(A, q[n], (0.5, 0.4, 0.25)[n])
        product(T, A, out)
        T = out
    return np.array([T[2], T[5], T[0], T[3]])
"""


@pytest.mark.parametrize(
    ("robot", "quantity", "text", "right", "slip"),
    [
        ("planar3r", "planar_pose", OF_C, "A[5] = reach*sin(angle)", "A[5] = reach*cos(angle)"),
        (
            "planar3r",
            "com_positions",
            OBJECTS,
            "self.R @ other.p + self.p",
            "other.R @ self.p + other.p",
        ),
        ("planar2r", "christoffel", BY_KEYS, "(0, 0, 1): -2*h", "(0, 0, 1): -h"),
    ],
)
def test_objects_and_what_stands_under_keys(robot, quantity, text, right, slip, tmp_path):
    told_in_its_line(robot, quantity, text, right, slip, tmp_path / "hand.py")


def test_a_number_in_a_text_is_told_in_the_text_s_line(tmp_path) -> None:
    wrong = with_slips(IN_TEXT, [("90     0.10915", "90     0.09465")])
    (tmp_path / "hand.py").write_text(wrong)
    told = kl.diagnose("ur5", "fk", written(wrong, tmp_path / "hand.py")).sentence
    assert wrong.split("\n")[8].startswith("0.0        90     0.09465")
    assert "line 9, ROWS[3][2], a number is wrong: 0.09465 should be 0.10915" in told


def test_signs_on_a_diagonal_are_no_lengths(tmp_path) -> None:
    """``R = diag([-1.0, -1, 1])`` was held for a length that is none of the arm's."""
    slips = [("8.393", "8.933"), ("centres[i] - origins[j]", "centres[i] - origins[i]")]
    wrong = with_slips(WEIGHTS, slips)
    (tmp_path / "hand.py").write_text(wrong)
    found = kl.diagnose("ur5", "gravity_torques", written(wrong, tmp_path / "hand.py"))
    assert "8.933 should be 8.393" in found.sentence
    assert "centres[i] - origins[j]" in found.sentence
    assert sorted(found.causes[0].kinds) == ["index", "number"]


FILLED = """
import numpy as np

def put(out, x):
    WAY

def along(out, angle):
    put(out, np.array([np.cos(angle), np.sin(angle)]))

def f(q):
    p, e, g = np.zeros(2), np.zeros(2), np.zeros(2)
    along(e, q[0])
    along(g, q[0] + q[1])
    put(p, 0.5*e)
    put(p, 0.4*g)
    return p
"""


@pytest.mark.parametrize("way", ["out += x", "out[:] = out + x", "np.add(out, x, out=out)"])
def test_what_fills_its_arguments_by_what_it_calls_is_run_each_time(way, tmp_path) -> None:
    """``along`` was taken for a function that gives nothing: a second sign had to be wrong."""
    wrong = with_slips(
        FILLED.replace("WAY", way), [("along(g, q[0] + q[1])", "along(g, q[0] - q[1])")]
    )
    found = kl.diagnose("planar2r", "planar_pose[:2]", written(wrong, tmp_path / "hand.py"))
    assert found.causes[0].kinds == ("sign",)
    assert "should be `along(g, q[0] + q[1])`" in found.sentence
