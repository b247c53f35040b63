"""Programs whose numbers, objects and records must be understood before a slip in them can be told.

Every program is right before its slip, which its verdict tells first; what is said makes it right.
"""

from __future__ import annotations

import numpy as np
import pytest
from hand_programs import told_in_its_line, written

import kinlab as kl
from kinlab.doctor.examine import prepare
from kinlab.doctor.program.read import read
from kinlab.doctor.program.search.repair import LineSearch

ARTICULATED = """
import numpy as np

def rx(v):
    x, y, z = v
    return np.array([[0, -z, y], [z, 0, -x], [-y, x, 0]])

def xform(E, r):
    X = np.zeros((6, 6))
    X[:3, :3] = X[3:, 3:] = E
    X[3:, :3] = -E @ rx(r)
    return X

def mcI(m, c, I):
    C = rx(c)
    return np.block([[I + m*C @ C.T, m*C], [m*C.T, m*np.eye(3)]])

def crm(v):
    return np.block([[rx(v[:3]), np.zeros((3, 3))], [rx(v[3:]), rx(v[:3])]])

def crf(v):
    return -crm(v).T

a = [0.0, 0.45, 0.35]
alpha = [0.0, 0.0, np.pi/2]
I1 = np.diag([0.02, 0.08, 0.07])
I2 = np.diag([0.01, 0.04, 0.045])
I3 = np.array([[0.004, 0.001, 0], [0.001, 0.012, 0.0005], [0, 0.0005, 0.014]])
inertia = [
    mcI(3.0, (0.2, 0.02, -0.01), I1),
    mcI(2.0, (0.15, -0.01, 0.03), I2),
    mcI(1.2, (0.12, 0.03, 0.01), I3),
]
S = np.array([0, 0, 1, 0, 0, 0.0])

def f(q, qd, tau):
    X, v, c, IA, pA = [], [], [], [], []
    for i in range(3):
        ct, st, ca, sa = np.cos(q[i]), np.sin(q[i]), np.cos(alpha[i]), np.sin(alpha[i])
        R = np.array([[ct, -st, 0], [st*ca, ct*ca, -sa], [st*sa, ct*sa, ca]])
        X.append(xform(R.T, [a[i], 0, 0]))
        vJ = S*qd[i]
        v.append(vJ if i == 0 else X[i] @ v[i - 1] + vJ)
        c.append(crm(v[i]) @ vJ)
        IA.append(inertia[i].copy())
        pA.append(crf(v[i]) @ inertia[i] @ v[i])
    U, D, u = [0]*3, [0]*3, [0]*3
    for i in (2, 1, 0):
        U[i] = IA[i] @ S
        D[i] = S @ U[i]
        u[i] = tau[i] - S @ pA[i]
        if i > 0:
            Ia = IA[i] - np.outer(U[i], U[i])/D[i]
            pa = pA[i] + Ia @ c[i] + U[i]*u[i]/D[i]
            IA[i - 1] += X[i].T @ Ia @ X[i]
            pA[i - 1] = pA[i - 1] + X[i].T @ pa
    acc = np.array([0, 0, 0, 0, 0, 9.81])
    qdd = np.zeros(3)
    for i in range(3):
        acc = X[i] @ acc + c[i]
        qdd[i] = (u[i] - U[i] @ acc)/D[i]
        acc = acc + S*qdd[i]
    return qdd
"""
LEGS = """
import numpy as np

class Leg:
    def __init__(self, x0, l1, l2, mc, cc, ic, rotor, ratio):
        self.base = np.array([x0, 0.0])
        self.l1, self.l2 = l1, l2
        self.mc, self.cc, self.ic = mc, cc, ic + rotor*ratio**2

    def solve(self, p, v, a, side):
        s = p - self.base
        d = np.linalg.norm(s)
        lean = np.arctan2(s[1], s[0])
        th = lean - side*np.arccos((self.l1**2 + d**2 - self.l2**2)/(2*self.l1*d))
        self.u = np.array([np.cos(th), np.sin(th)])
        self.w = (s - self.l1*self.u)/self.l2
        self.nu = np.array([-self.u[1], self.u[0]])
        k = self.u[0]*self.w[1] - self.u[1]*self.w[0]
        self.Jc = self.w/(self.l1*k)
        self.Jr = -self.u/(self.l2*k)
        self.wc, self.wr = self.Jc @ v, self.Jr @ v
        b = a + self.l1*self.wc**2*self.u + self.l2*self.wr**2*self.w
        self.ac = self.Jc @ b

    def torque(self, g):
        return (self.ic + self.mc*self.cc**2)*self.ac - self.mc*self.cc*self.nu @ g

LEGS = (Leg(0.12, 0.30, 0.50, 1.0, 0.12, 0.0075, 1.0e-5, 10.0),
        Leg(-0.12, 0.26, 0.54, 0.8, 0.15, 0.0060, 1.2e-5, 12.0))
PAYLOAD = 1.5
GRAVITY = np.array([0.0, -9.81])

def f(xy, v, a, mode):
    own = np.zeros(2)
    for i, leg in enumerate(LEGS):
        leg.solve(xy, v, a, mode[i])
        own[i] = leg.torque(GRAVITY)
    J = np.array([leg.Jc for leg in LEGS])
    return own + np.linalg.solve(J.T, PAYLOAD*(a - GRAVITY))
"""
RECORDS = """
import numpy as np

TABLE = [[0, 0.1273, 0, np.pi/2], [0, 0, -0.612, 0], [0, 0, -0.5723, 0],
         [0, 0.163941, 0, np.pi/2], [0, 0.1157, 0, -np.pi/2], [0, 0.0922, 0, 0]]
LINKS = [
    dict(m=7.778, r=(0, 0, 0), I=(0.031474313, 0.021875625, 0.031474313)),
    dict(m=12.93, r=(0.306, 0, 0.220941), I=(0.036365625, 0.421753804, 0.421753804)),
    dict(m=3.87, r=(0.28615, 0, 0.049041), I=(0.010884375, 0.111069694, 0.111069694)),
    dict(m=1.96, r=(0, -0.1149, 0), I=(0.005108248, 0.005108248, 0.0055125)),
    dict(m=1.96, r=(0, 0.1157, 0), I=(0.005108248, 0.0055125, 0.005108248)),
    dict(m=0.202, r=(0, 0, -0.0922), I=(0.000526462, 0.000568125, 0.000526462)),
]

def A(row, q):
    th, d, a, al = row
    th = th + q
    return np.array([
        [np.cos(th), -np.sin(th)*np.cos(al), np.sin(th)*np.sin(al), a*np.cos(th)],
        [np.sin(th), np.cos(th)*np.cos(al), -np.cos(th)*np.sin(al), a*np.sin(th)],
        [0, np.sin(al), np.cos(al), d], [0, 0, 0, 1]])

def f(q):
    n = len(q)
    T = [np.eye(4)]
    for k in range(n):
        T.append(T[k] @ A(TABLE[k], q[k]))
    M = np.zeros((n, n))
    for k, link in enumerate(LINKS):
        R = T[k + 1][:3, :3]
        pc = T[k + 1][:3, 3] + R @ np.array(link["r"])
        Jv, Jw = np.zeros((3, n)), np.zeros((3, n))
        for j in range(k + 1):
            zj = T[j][:3, 2]
            Jv[:, j] = np.cross(zj, pc - T[j][:3, 3])
            Jw[:, j] = zj
        I0 = R @ np.diag(link["I"]) @ R.T
        M += link["m"]*Jv.T @ Jv + Jw.T @ I0 @ Jw
    return M
"""
TURNS = """
import numpy as np

ROWS = [(0.1273, 0, 90), (0, -0.612, 0), (0, -0.5723, 0), (0.163941, 0, 90),
        (0.1157, 0, -90), (0.0922, 0, 0)]

def about(axis, angle):
    c, s = np.cos(angle), np.sin(angle)
    if axis == "z":
        return np.array([[c, -s, 0], [s, c, 0], [0, 0, 1]])
    return np.array([[1, 0, 0], [0, c, -s], [0, s, c]])

def f(q):
    rot, pos = about("z", np.pi), np.zeros(3)
    for theta, (d, a, alpha) in zip(q, ROWS):
        pos = pos + rot @ [0, 0, d]
        rot = rot @ about("z", theta)
        pos = pos + rot @ [a, 0, 0]
        rot = rot @ about("x", np.deg2rad(alpha))
    out = np.eye(4)
    out[:3, :3], out[:3, 3] = rot, pos
    return out
"""
SCREWS = """
import numpy as np

d1, d3, d5, a4, a5, a7, dF = 0.333, 0.316, 0.384, 0.0825, -0.0825, 0.088, 0.107
W = np.array([[0, 0, 1], [0, 1, 0], [0, 0, 1], [0, -1, 0], [0, 0, 1], [0, -1, 0], [0, 0, -1.0]])
P = np.array([[0, 0, 0], [0, 0, d1], [0, 0, 0], [a4, 0, d1 + d3], [0, 0, 0],
              [0, 0, d1 + d3 + d5], [a7, 0, 0]])
HOME = np.array([a7, 0, d1 + d3 + d5 - dF])

def turn(w, p, t):
    K = np.array([[0, -w[2], w[1]], [w[2], 0, -w[0]], [-w[1], w[0], 0]])
    R = np.eye(3) + np.sin(t)*K + (1 - np.cos(t))*K @ K
    return R, p - R @ p

def f(q):
    R, p = np.eye(3), np.zeros(3)
    axes, points = [], []
    for w, on, t in zip(W, P, q):
        axes.append(R @ w)
        points.append(R @ on + p)
        R2, p2 = turn(w, on, t)
        R, p = R @ R2, R @ p2 + p
    tip = R @ HOME + p
    J = np.zeros((6, 7))
    for k in range(7):
        J[:3, k] = np.cross(axes[k], tip - points[k])
        J[3:, k] = axes[k]
    return J
"""
RATES = """
import numpy as np

l1, l2 = 0.3, 0.5
e = 0.2/np.sqrt(2)

def row(base, xy, side):
    s = np.asarray(xy) - base
    d = np.hypot(s[0], s[1])
    th = np.arctan2(s[1], s[0]) - side*np.arccos((l1**2 + d**2 - l2**2)/(2*l1*d))
    u = np.array([np.cos(th), np.sin(th)])
    w = (s - l1*u)/l2
    return w/(l1*(u[0]*w[1] - u[1]*w[0]))

def f(xy, mode):
    return np.array([row([e, 0.0], xy, mode[0]), row([-e, 0.0], xy, mode[1])])
"""
PROGRAMS = {
    "articulated": ("spatial3r", "forward_dynamics", ARTICULATED),
    "legs": ("unequal", "fivebar_torque_massless", LEGS),
    "records": ("ur10", "mass_matrix", RECORDS),
    "turns": ("ur10", "fk", TURNS),
    "screws": ("panda", "jacobian", SCREWS),
    "rates": ("isotropic", "fivebar_jacobian", RATES),
}


@pytest.mark.parametrize("name", PROGRAMS)
def test_every_program_is_right(name):
    robot, quantity, text = PROGRAMS[name]
    assert kl.diagnose(robot, quantity, written(text)).agrees


@pytest.mark.many
@pytest.mark.parametrize(
    ("name", "right", "slip", "kind"),
    [
        pytest.param("articulated", "0, 9.81])", "0, -9.81])", "sign", id="gravity of a body"),
        pytest.param("articulated", "[m*C.T, m*np.eye", "[m*C, m*np.eye", "", id="a block"),
        pytest.param("articulated", "-E @ rx(r)", "E @ rx(r)", "sign", id="a transform"),
        pytest.param("articulated", "(u[i] - U[i] @ acc)/D[i]", "u[i]/D[i] - U[i] @ acc", "", id="brackets"),
        pytest.param("legs", "rotor*ratio**2", "rotor*ratio", "power", id="how an object is made"),
        pytest.param("records", 'link["m"]*Jv.T', "Jv.T", "missing factor", id="a key unread"),
        pytest.param("turns", 'about("z", np.pi)', 'about("z", 0.0)', "number", id="a base turned"),
        pytest.param("screws", "d5 - dF", "d5 + dF", "sign", id="beside a number of the other sign"),
        pytest.param("rates", "u[0]*w[1] - u[1]*w[0]", "u[0]*w[0] + u[1]*w[1]", "cross product", id="a product"),
    ],
)  # fmt: skip
def test_a_slip_in_it_is_told(name, right, slip, kind, tmp_path):
    cause = told_in_its_line(*PROGRAMS[name], right, slip, tmp_path / "own.py")
    assert not kind or cause.kinds[0] == kind or "sign" in cause.kinds[0], cause


@pytest.mark.parametrize("name", ["articulated", "records", "turns", "screws"])
def test_a_right_program_is_right_for_other_arms_as_it_is_understood(name):
    """Where it is not, every true repair would be taken for one that holds for this arm alone."""
    robot, quantity, text = PROGRAMS[name]
    case, engine = prepare(kl.load(robot), quantity, (), 10, 3)
    f = written(text)
    hand = np.array([f(*x) for x in zip(*case.arguments.values(), strict=True)])
    search = LineSearch(read(f), case.__class__(**{**vars(case), "hand": hand}), engine, 1e-9)
    others = [one for one in search.arms.before if one is not None and one.whole]
    assert all(search.arms.hold_for(one) for one in others)
