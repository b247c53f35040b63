"""Slips that the rest of the program shows: a line of another link, a point in another function.

Every program is right before the slip, which its verdict tells first; what is said of a slip makes
the program right again.
"""

from __future__ import annotations

import numpy as np
import pytest
from hand_programs import asked, with_slips, written

import kinlab as kl

WALL = kl.DHTable(
    "wall",
    "standard",
    [
        kl.DHLink(d=0.31, alpha=np.pi / 2, mass=4.1, com=(0.02, -0.09, 0.03), inertia=np.diag([0.05, 0.03, 0.04])),
        kl.DHLink(a=0.43, mass=2.7, com=(-0.17, 0.02, 0.05), inertia=np.diag([0.01, 0.06, 0.07])),
        kl.DHLink(a=0.29, mass=1.3, com=(-0.12, 0.01, -0.02), inertia=np.diag([0.004, 0.02, 0.022])),
    ],
)  # fmt: skip
ELBOW = kl.DHTable(
    "elbow",
    "standard",
    [
        kl.DHLink(a=0.44, mass=2.3, com=(-0.25, 0, 0), inertia=np.diag([0, 0.05, 0.05])),
        kl.DHLink(a=0.37, mass=1.7, com=(-0.16, 0, 0), inertia=np.diag([0, 0.04, 0.04])),
        kl.DHLink(a=0.25, mass=1.2, com=(-0.14, 0, 0), inertia=np.diag([0, 0.02, 0.02])),
    ],
    gravity=(0, -9.81, 0),
)
FRAMES = """
import numpy as np

ROWS = [(0.0, 0.31, np.pi / 2), (0.43, 0.0, 0.0), (0.29, 0.0, 0.0)]
m = [4.1, 2.7, 1.3]
rc = np.array([[0.02, -0.09, 0.03], [-0.17, 0.02, 0.05], [-0.12, 0.01, -0.02]])
I = [np.diag([0.05, 0.03, 0.04]), np.diag([0.01, 0.06, 0.07]), np.diag([0.004, 0.02, 0.022])]

def frames(q):
    T = [np.eye(4)]
    for (a, d, al), t in zip(ROWS, q):
        c, s, ca, sa = np.cos(t), np.sin(t), np.cos(al), np.sin(al)
        A = np.array([[c, -s*ca, s*sa, a*c], [s, c*ca, -c*sa, a*s], [0, sa, ca, d], [0, 0, 0, 1]])
        T.append(T[-1] @ A)
    return T

def energy(q):
    T = frames(q)
    V = 0.0
    for i in range(3):
        V += 9.81*m[i]*(T[i + 1][:3, 3] + T[i + 1][:3, :3] @ rc[i])[2]
    return V

def masses(q):
    T = frames(q)
    M = np.zeros((3, 3))
    for i in range(3):
        R = T[i + 1][:3, :3]
        pc = T[i + 1][:3, 3] + R @ rc[i]
        Jv, Jw = np.zeros((3, 3)), np.zeros((3, 3))
        for j in range(i + 1):
            z = T[j][:3, 2]
            Jv[:, j] = np.cross(z, pc - T[j][:3, 3])
            Jw[:, j] = z
        M += m[i]*Jv.T @ Jv + Jw.T @ R @ I[i] @ R.T @ Jw
    return M

def f(q, a):
    h = 1e-5*np.eye(3)
    g = [(energy(q + h[i]) - energy(q - h[i]))/2e-5 for i in range(3)]
    return masses(q) @ a + g
"""
HEIGHT = FRAMES.replace("def f(q, a):", "def f(q):").replace("return masses(q) @ a + g", "return g")
AT_REST = FRAMES.replace("def f(q, a):", "def f(q):").replace("return masses(q) @ a + g", "return masses(q)")  # fmt: skip
UNROLLED = """
from math import cos, sin

l1, l2, l3 = 0.44, 0.37, 0.25
r1, r2, r3 = 0.19, 0.21, 0.11
m1, m2, m3 = 2.3, 1.7, 1.2
I1, I2, I3 = 0.05, 0.04, 0.02

def f(q, v):
    t1, w1 = q[0], v[0]
    t2, w2 = t1 + q[1], w1 + v[1]
    t3, w3 = t2 + q[2], w2 + v[2]
    x1, y1 = -l1*sin(t1)*w1, l1*cos(t1)*w1
    x2, y2 = x1 - l2*sin(t2)*w2, y1 + l2*cos(t2)*w2
    u1, n1 = -r1*sin(t1)*w1, r1*cos(t1)*w1
    u2, n2 = x1 - r2*sin(t2)*w2, y1 + r2*cos(t2)*w2
    u3, n3 = x2 - r3*sin(t3)*w3, y2 + r3*cos(t3)*w3
    T1 = 0.5*m1*(u1**2 + n1**2) + 0.5*I1*w1**2
    T2 = 0.5*m2*(u2**2 + n2**2) + 0.5*I2*w2**2
    T3 = 0.5*m3*(u3**2 + n3**2) + 0.5*I3*w3**2
    return T1 + T2 + T3
"""
OWN_PRODUCT = """
from math import cos, sin, pi

ROWS = [(0.0, 0.31, pi / 2), (0.43, 0.0, 0.0), (0.29, 0.0, 0.0)]

def mul(A, B):
    return [[sum(A[i][k]*B[k][j] for k in range(4)) for j in range(4)] for i in range(4)]

def step(row, t):
    a, d, al = row
    c, s, ca, sa = cos(t), sin(t), cos(al), sin(al)
    return [[c, -s*ca, s*sa, a*c], [s, c*ca, -c*sa, a*s], [0, sa, ca, d], [0, 0, 0, 1]]

def f(q):
    T = [[1, 0, 0, 0], [0, 1, 0, 0], [0, 0, 1, 0], [0, 0, 0, 1]]
    for row, t in zip(ROWS, q):
        T = mul(T, step(row, t))
    return T
"""
SUMS = """
import numpy as np

l, r = [0.44, 0.37, 0.25], [0.19, 0.21, 0.11]
m, I = [2.3, 1.7, 1.2], [0.05, 0.04, 0.02]

def of(a, b):
    a, b = min(a, b), max(a, b)
    outer = sum(m[k] for k in range(b + 1, 3))
    if a == b:
        return I[a] + m[a]*r[a]**2 + outer*l[a]**2
    return l[a]*(m[b]*r[b] + outer*l[b])

def f(q):
    t = np.cumsum(q)
    M = np.zeros((3, 3))
    for i in range(3):
        for j in range(3):
            for a in range(i, 3):
                for b in range(j, 3):
                    M[i, j] += of(a, b)*np.cos(t[a] - t[b])
    return M
"""
LISTS = """
from math import cos, sin

l1, l2, l3 = 0.44, 0.37, 0.25

def turn(t, v):
    return [v[0]*cos(t) - v[1]*sin(t), v[0]*sin(t) + v[1]*cos(t), v[2]]

def times(R, v):
    return [sum(R[i][k]*v[k] for k in range(3)) for i in range(3)]

def tr(R):
    return [list(column) for column in zip(*R)]

def add(u, v):
    return [a + b for a, b in zip(u, v)]

def moment(p, f):
    return [p[1]*f[2] - p[2]*f[1], p[2]*f[0] - p[0]*f[2], p[0]*f[1] - p[1]*f[0]]

def rot(t):
    return [[cos(t), -sin(t), 0], [sin(t), cos(t), 0], [0, 0, 1]]

def f(q, w):
    t3 = q[0] + q[1] + q[2]
    force = times(tr(rot(t3)), list(w[:3]))
    n = times(tr(rot(t3)), list(w[3:]))
    n3 = add(n, moment([l3, 0, 0], force))
    f2, n2 = turn(q[2], force), turn(q[2], n3)
    n2 = add(n2, moment([l2, 0, 0], f2))
    f1, n1 = turn(q[1], f2), turn(q[1], n2)
    n1 = add(n1, moment([l1, 0, 0], f1))
    return [n1[2], n2[2], n3[2]]
"""
ENERGIES = """
from math import cos, sin

l, r = (0.44, 0.37, 0.25), (0.19, 0.21, 0.11)
m, I = (2.3, 1.7, 1.2), (0.05, 0.04, 0.02)

def square(x, y):
    return x**2 + y**2

def f(q, v):
    a, b, c = v
    t1, t2, t3 = q[0], q[0] + q[1], q[0] + q[1] + q[2]
    s1, k1, s2, k2, s3, k3 = sin(t1), cos(t1), sin(t2), cos(t2), sin(t3), cos(t3)
    d, e = a + b, a + b + c
    x, y = -l[0]*s1*a, l[0]*k1*a
    X, Y = x - l[1]*s2*d, y + l[1]*k2*d
    T = 0.5*m[0]*square(-r[0]*s1*a, r[0]*k1*a) + 0.5*I[0]*a**2
    T += 0.5*m[1]*square(x - r[1]*s2*d, y + r[1]*k2*d) + 0.5*I[1]*d**2
    T += 0.5*m[2]*square(X - r[2]*s3*e, Y + r[2]*k3*e) + 0.5*I[2]*e**2
    return T
"""
ALIAS = """
import numpy as np

X = np.cross
D, L2, L3 = 0.31, 0.43, 0.29
m = [4.1, 2.7, 1.3]
PC = np.array([[0.02, -0.09, 0.03], [-0.17, 0.02, 0.05], [-0.12, 0.01, -0.02]])
IC = [np.diag([0.05, 0.03, 0.04]), np.diag([0.01, 0.06, 0.07]), np.diag([0.004, 0.02, 0.022])]
Z = np.array([0, 0, 1.0])

def turned(t, al):
    c, s, ca, sa = np.cos(t), np.sin(t), np.cos(al), np.sin(al)
    return np.array([[c, -s*ca, s*sa], [s, c*ca, -c*sa], [0, sa, ca]])

def f(q, v, a):
    R = [turned(q[0], np.pi/2), turned(q[1], 0.0), turned(q[2], 0.0), np.eye(3)]
    P = [np.array([0, D, 0]), np.array([L2, 0, 0]), np.array([L3, 0, 0])]
    w, dw, acc = np.zeros(3), np.zeros(3), np.array([0, 0, 9.81])
    F, N = [], []
    for k in range(3):
        dw = R[k].T @ (dw + a[k]*Z + X(w, v[k]*Z))
        w = R[k].T @ (w + v[k]*Z)
        acc = R[k].T @ acc + X(dw, P[k]) + X(w, X(w, P[k]))
        F.append(m[k]*(acc + X(dw, PC[k]) + X(w, X(w, PC[k]))))
        N.append(IC[k] @ dw + X(w, IC[k] @ w))
    force, n, tau = np.zeros(3), np.zeros(3), np.zeros(3)
    for k in (2, 1, 0):
        force = R[k + 1] @ force
        n = R[k + 1] @ n + X(P[k], force) + X(P[k] + PC[k], F[k]) + N[k]
        force = force + F[k]
        tau[k] = n @ (R[k].T @ Z)
    return tau
"""
PROGRAMS = {
    "lists": (ELBOW, "statics", LISTS),
    "energies": (ELBOW, "kinetic_energy", ENERGIES),
    "alias": (WALL, "inverse_dynamics", ALIAS),
    "frames": (WALL, "mass_matrix", AT_REST),
    "height": (WALL, "gravity_torques", HEIGHT),
    "summed": (
        ELBOW,
        "mass_matrix",
        SUMS.replace("np.cumsum(q)", "np.tril(np.ones((3, 3)), 0) @ q"),
    ),
    "lines": (ELBOW, "kinetic_energy", UNROLLED),
    "product": (WALL, "fk", OWN_PRODUCT),
    "sums": (ELBOW, "mass_matrix", SUMS),
}
SLIPS = [
    ("frames", [(" + R @ rc[i]", "")], "a point of another function"),
    ("frames", [("pc - T[j][:3, 3]", "pc")], "from the axis"),
    ("frames", [("pc - T[j][:3, 3]", "pc"), ("a*c]", "a*s]")], "from the axis, and a sine"),
    ("lines", [("x1 - r2*sin(t2)*w2, y1", "-r2*sin(t2)*w2, y1"), ("t3, w3 = t2 + q[2]", "t3, w3 = q[2]")], "lines of other links"),
    ("lines", [("0.5*m2*(u2**2 + n2**2)", "0.5*m2*(u2**2)"), ("y1 + l2*cos(t2)*w2", "y1 + l2*cos(t2)*w1")], "a square and a rate"),
    ("lines", [("(u2**2 + n2**2) + 0.5*I2*w2**2", "(u2**2 + n2**2)"), ("y1 + l2*cos(t2)*w2", "y1 + l2*cos(t2)*w1")], "an energy and a rate"),
    ("height", [(" + T[i + 1][:3, :3] @ rc[i])[2]", " + rc[i])[2]"), ("9.81*m[i]", "-9.81*m[i]")], "a vector that is not turned, and a sign"),
    ("lists", [("n2 = add(n2, moment([l2, 0, 0], f2))", "n2 = n2")], "a moment by own functions"),
    ("lists", [("force = times(tr(rot(t3))", "force = times(rot(t3)")], "an own transpose"),
    ("lists", [("n2 = add(n2, moment([l2, 0, 0], f2))", "n2 = n2"), ("f1, n1 = turn(q[1], f2)", "f1, n1 = turn(q[0], f2)")], "a moment, and a joint"),
    ("energies", [("0.5*I[0]*a**2", "0.5*I[0]*c**2")], "a name set beside it"),
    ("energies", [("0.5*I[0]*a**2", "0.5*I[0]*c**2"), ("y + r[1]*k2*d", "y + r[1]*s2*d")], "a name set beside it, and a cosine"),
    ("alias", [(" + X(w, X(w, P[k]))", "")], "a cross product by another name"),
    ("alias", [(" + X(w, X(w, P[k]))", ""), ("[k] @ dw + X(w", "[k] @ dw - X(w")], "the same, and a sign"),
    ("alias", [("IC[k] @ dw + X(w", "X(w, IC[k] @ dw) + X(w"), ("acc = R[k].T @ acc", "acc = R[k] @ acc")], "a cross product too many, and a transpose"),
    ("summed", [("np.ones((3, 3)), 0)", "np.ones((3, 3)), -1)")], "another diagonal"),
    ("product", [("T = mul(T, step(row, t))", "T = step(row, t)")], "a product of one's own"),
    ("sums", [("range(i, 3)", "range(i + 1)")], "what another loop runs through"),
]  # fmt: skip


@pytest.mark.parametrize("name", PROGRAMS)
def test_the_programs_are_right(name) -> None:
    robot, quantity, text = PROGRAMS[name]
    assert kl.diagnose(robot, quantity, written(text)).agrees


@pytest.mark.many
@pytest.mark.parametrize(("name", "slips"), [x[:2] for x in SLIPS], ids=[x[2] for x in SLIPS])
def test_what_the_rest_of_the_program_shows_is_told(name, slips, tmp_path) -> None:
    robot, quantity, text = PROGRAMS[name]
    found, good = asked(with_slips(text, slips), robot, quantity, tmp_path / "hand.py")
    assert good, str(found)
    assert len(found.causes[0].kinds) <= len(slips)
