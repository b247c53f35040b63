"""Slips in programs as engineers write them: chains of transforms, spatial vectors, own objects.

Every program is right before the slip, which its verdict tells first; what is said of a slip makes
the program right again.
"""

from __future__ import annotations

import importlib.util
import sys

import numpy as np
import pytest
from hand_programs import asked, with_slips, written

import kinlab as kl

CHAIN = """
import numpy as np

ALPHA, A, D = [np.pi/2, 0.0, 0.7], [0.05, 0.43, 0.0], [0.31, 0.0, 0.12]
TOOL = np.array([[1, 0, 0, 0.03], [0, 0, -1, 0.02], [0, 1, 0, 0.11], [0, 0, 0, 1.0]])

def turned(t, i, j):
    T = np.eye(4)
    T[i, i] = T[j, j] = np.cos(t)
    T[i, j], T[j, i] = -np.sin(t), np.sin(t)
    return T

def trans(x, y, z):
    T = np.eye(4)
    T[:3, 3] = x, y, z
    return T

def frames(q):
    out = [np.eye(4)]
    for i in range(3):
        step = turned(q[i], 0, 1) @ trans(0, 0, D[i]) @ trans(A[i], 0, 0) @ turned(ALPHA[i], 1, 2)
        out.append(out[-1] @ step)
    return out

def f(q):
    T = frames(q)
    tip = T[-1] @ TOOL
    J = np.zeros((6, 3))
    for k in range(3):
        z = T[k][:3, 2]
        arm = tip[:3, 3] - T[k][:3, 3]
        J[:, k] = np.hstack([np.cross(z, arm), z])
    return J
"""
SCREWS = """
import numpy as np
from scipy.linalg import expm

L1, L2, L3 = 0.34, 0.46, 0.27
AXES = np.array([[0, 0, 1], [0, -1, 0], [0, -1, 0]])
POINTS = np.array([[0, 0, 0], [0, 0, L1], [L2, 0, L1]])
HOME = np.array([[1, 0, 0, L2 + L3], [0, 0, -1, 0], [0, 1, 0, L1], [0, 0, 0, 1]])

def f(q):
    T = np.eye(4)
    for w, p, t in zip(AXES, POINTS, q):
        S = np.zeros((4, 4))
        S[:3, :3] = np.cross(w, np.eye(3)).T
        S[:3, 3] = -np.cross(w, p)
        T = T @ expm(S * t)
    return T @ HOME
"""
COLUMNS = """
import numpy as np

D1, A2, A3 = 0.42, 0.37, 0.29

def f(q):
    c1, s1, c2, s2 = np.cos(q[0]), np.sin(q[0]), np.cos(q[1]), np.sin(q[1])
    c23, s23 = np.cos(q[1] + q[2]), np.sin(q[1] + q[2])
    p0, p1 = np.zeros(3), np.array([0, 0, D1])
    p2 = p1 + np.array([A2*c1*c2, A2*s1*c2, A2*s2])
    pe = p2 + np.array([A3*c1*c23, A3*s1*c23, A3*s23])
    z0, z1 = np.array([0, 0, 1]), np.array([s1, -c1, 0])
    J = np.zeros((6, 3))
    J[:3, 0] = np.cross(z0, pe - p0)
    J[:3, 1] = np.cross(z1, pe - p1)
    J[:3, 2] = np.cross(z1, pe - p2)
    J[3:, 0], J[3:, 1], J[3:, 2] = z0, z1, z1
    return J
"""
BODIES = """
from typing import NamedTuple
import numpy as np

class Body(NamedTuple):
    mass: float
    length: float
    com: float
    inertia: float

BODIES = [Body(3.4, 0.45, 0.2, 0.064), Body(2.1, 0.36, 0.16, 0.029), Body(0.8, 0.19, 0.11, 0.006)]

def f(q):
    phi, M = np.cumsum(q), np.zeros((3, 3))
    for i, body in enumerate(BODIES):
        J = np.zeros((2, 3))
        for j in range(i + 1):
            x = body.com*np.cos(phi[i]) + sum(BODIES[k].length*np.cos(phi[k]) for k in range(j, i))
            y = body.com*np.sin(phi[i]) + sum(BODIES[k].length*np.sin(phi[k]) for k in range(j, i))
            J[:, j] = [-y, x]
        turning = np.array([1.0 if j <= i else 0.0 for j in range(3)])
        M += body.mass*J.T @ J
        M += body.inertia*np.outer(turning, turning)
    return M
"""
SPATIAL = """
import numpy as np

a, alpha, d = [0.0, 0.08, 0.41], [0.0, -np.pi/2, 0.6], [0.3, 0.1, -0.05]
mass, com = [3.1, 2.2, 1.3], np.array([[0.02, -0.03, 0.1], [0.2, 0.01, 0.05], [0.1, 0.04, 0.03]])
inertia = [np.diag(x) for x in ([0.08, 0.09, 0.05], [0.02, 0.07, 0.076], [0.03, 0.033, 0.013])]

def skew(v):
    return np.array([[0, -v[2], v[1]], [v[2], 0, -v[0]], [-v[1], v[0], 0]])

def motion(v):
    W, V = skew(v[:3]), skew(v[3:])
    return np.block([[W, np.zeros((3, 3))], [V, W]])

def body(k):
    C = skew(com[k])
    return np.block([[inertia[k] + mass[k]*C @ C.T, mass[k]*C], [mass[k]*C.T, mass[k]*np.eye(3)]])

def f(q, qd, qdd):
    S = np.array([0, 0, 1.0, 0, 0, 0])
    v, acc, X, forces = np.zeros(6), np.array([0, 0, 0, 0, 0, 9.81]), [], []
    for k in range(3):
        c, s, ca, sa = np.cos(q[k]), np.sin(q[k]), np.cos(alpha[k]), np.sin(alpha[k])
        R = np.array([[c, -s, 0], [s*ca, c*ca, -sa], [s*sa, c*sa, ca]])
        p = np.array([a[k], -sa*d[k], ca*d[k]])
        X.append(np.block([[R.T, np.zeros((3, 3))], [-R.T @ skew(p), R.T]]))
        v = X[k] @ v + S*qd[k]
        acc = X[k] @ acc + S*qdd[k] + motion(v) @ S*qd[k]
        forces.append(body(k) @ acc - motion(v).T @ body(k) @ v)
    tau = []
    for k in (2, 1, 0):
        tau.insert(0, S @ forces[k])
        if k > 0:
            forces[k - 1] += X[k].T @ forces[k]
    return np.array(tau)
"""


def elbow():
    links = [
        kl.DHLink(a=a, alpha=alpha, d=d)
        for a, alpha, d in zip(
            (0.05, 0.43, 0.0), (np.pi / 2, 0.0, 0.7), (0.31, 0.0, 0.12), strict=True
        )
    ]
    tool = [[1, 0, 0, 0.03], [0, 0, -1, 0.02], [0, 1, 0, 0.11], [0, 0, 0, 1.0]]
    return kl.DHTable("elbow", "standard", links, tool=np.array(tool))


def anthropomorphic(d, a, b):
    links = [kl.DHLink(d=d, alpha=np.pi / 2), kl.DHLink(a=a), kl.DHLink(a=b)]
    return kl.DHTable("anthropomorphic", "standard", links)


def planar():
    sizes = ((3.4, 0.45, 0.2, 0.064), (2.1, 0.36, 0.16, 0.029), (0.8, 0.19, 0.11, 0.006))
    before = (0.0, 0.45, 0.36)
    links = [
        kl.DHLink(a=a, mass=m, com=(c, 0, 0), inertia=np.diag([0, I, I]))
        for a, (m, _l, c, I) in zip(before, sizes, strict=True)
    ]
    return kl.DHTable("planar", "modified", links)


def spatial():
    rows = (
        (0.0, 0.0, 0.3, 3.1, (0.02, -0.03, 0.1), (0.08, 0.09, 0.05)),
        (0.08, -np.pi / 2, 0.1, 2.2, (0.2, 0.01, 0.05), (0.02, 0.07, 0.076)),
        (0.41, 0.6, -0.05, 1.3, (0.1, 0.04, 0.03), (0.03, 0.033, 0.013)),
    )
    links = [
        kl.DHLink(a=a, alpha=alpha, d=d, mass=m, com=c, inertia=np.diag(I))
        for a, alpha, d, m, c, I in rows
    ]
    return kl.DHTable("spatial", "modified", links)


PROGRAMS = {
    "chain": (elbow(), "jacobian", CHAIN),
    "screws": (anthropomorphic(0.34, 0.46, 0.27), "fk", SCREWS),
    "columns": (anthropomorphic(0.42, 0.37, 0.29), "jacobian", COLUMNS),
    "bodies": (planar(), "mass_matrix", BODIES),
    "spatial": (spatial(), "inverse_dynamics", SPATIAL),
}
SLIPS = [
    ("chain", [("    T[:3, 3] = x, y, z\n", "")], "the column of a transform"),
    ("chain", [(" @ trans(A[i], 0, 0)", "")], "one transform of a chain"),
    ("chain", [("turned(q[i], 0, 1) @ trans(0, 0, D[i]) @ trans(A[i], 0, 0) @ turned(ALPHA[i], 1, 2)", "trans(A[i], 0, 0) @ turned(ALPHA[i], 1, 2) @ turned(q[i], 0, 1) @ trans(0, 0, D[i])")], "the other convention's order"),
    ("chain", [("np.hstack([np.cross(z, arm), z])", "np.hstack([np.cross(z, arm), np.zeros(3)])")], "nothing for an axis"),
    ("screws", [("        S[:3, 3] = -np.cross(w, p)\n", "")], "the moment of a screw"),
    ("screws", [("        S[:3, 3] = -np.cross(w, p)\n        T = T @ expm(S * t)\n", "        T = T @ expm(S * t)\n        S[:3, 3] = -np.cross(w, p)\n")], "lines in the other order"),
    ("screws", [("T @ expm(S * t)", "T + expm(S * t)")], "a sum for a product"),
    ("columns", [("np.cos(q[1] + q[2]), np.sin(q[1] + q[2])", "np.cos(q[0] + q[2]), np.sin(q[0] + q[2])")], "an entry beside it, twice"),
    ("columns", [("    J[:3, 0] = np.cross(z0, pe - p0)\n", "")], "a column"),
    ("bodies", [("body.inertia*np", "body.mass*np")], "a field that nothing else uses"),
    ("bodies", [("np.outer(turning, turning)", "turning")], "an outer product"),
    ("bodies", [("BODIES[k].length*np.cos(phi[k])", "np.cos(phi[k])")], "a factor in a generator"),
    ("bodies", [("body.inertia*np", "body.mass*np"), ("range(i + 1)", "range(i)")], "a field and a loop"),
    ("spatial", [("[[W, np.zeros((3, 3))], [V, W]]", "[[W, V], [np.zeros((3, 3)), W]]")], "blocks in the other corner"),
    ("spatial", [("tau.insert(0, S @ forces[k])", "tau.append(S @ forces[k])")], "the torques' order"),
    ("spatial", [("inertia[k] + mass[k]*C @ C.T, ", "inertia[k], "), ("0, 9.81]", "0, -9.81]")], "another axis, gravity"),
]  # fmt: skip


@pytest.mark.parametrize("name", PROGRAMS)
def test_the_programs_are_right(name) -> None:
    robot, quantity, text = PROGRAMS[name]
    assert kl.diagnose(robot, quantity, written(text)).agrees


@pytest.mark.many
@pytest.mark.parametrize(("name", "slips"), [x[:2] for x in SLIPS], ids=[x[2] for x in SLIPS])
def test_slips_of_structured_programs_are_told(name, slips, tmp_path) -> None:
    robot, quantity, text = PROGRAMS[name]
    found, good = asked(with_slips(text, slips), robot, quantity, tmp_path / "hand.py")
    assert good, str(found)


def test_an_array_that_nothing_uses_any_more_is_the_arms() -> None:
    robot, quantity, text = PROGRAMS["chain"]
    text = text.replace("tip = T[-1] @ TOOL", "tip = T[-1]").replace("- T[k][:3, 3]", "")
    told = kl.diagnose(robot, quantity, written(text)).sentence
    assert "`tip = T[-1] @ TOOL`" in told
    assert "- T[k][:3, 3]" in told


def test_an_index_one_on_is_told_as_it_is_typed() -> None:
    robot, quantity, text = PROGRAMS["chain"]
    found = kl.diagnose(robot, quantity, written(text.replace("T[k][:3, 2]", "T[k + 1][:3, 2]")))
    assert "`z = T[k + 1][:3, 2]` should be `z = T[k][:3, 2]`" in str(found)


POINTS = """
from math import cos, sin

m1, m2, l1, l2, g = 2.0, 1.0, 1.0, 0.5, 9.81

def f(q, qd, qdd):
    s2, c2, c1, c12 = sin(q[1]), cos(q[1]), cos(q[0]), cos(q[0] + q[1])
    t1 = m2*l2**2*(qdd[0] + qdd[1]) + m2*l1*l2*c2*(2*qdd[0] + qdd[1]) + (m1 + m2)*l1**2*qdd[0]
    t1 += -m2*l1*l2*s2*qd[1]**2 - 2*m2*l1*l2*s2*qd[0]*qd[1] + m2*l2*g*c12 + (m1 + m2)*l1*g*c1
    t2 = m2*l1*l2*c2*qdd[0] + m2*l1*l2*s2*qd[0]**2 + m2*l2*g*c12 + m2*l2**2*(qdd[0] + qdd[1])
    return [t1, t2]
"""


def test_one_length_ends_a_link_and_holds_its_point_mass() -> None:
    links = [kl.DHLink(mass=2.0, com=(1.0, 0, 0)), kl.DHLink(a=1.0, mass=1.0, com=(0.5, 0, 0))]
    craig = kl.DHTable("craig", "modified", links, gravity=(0, -9.81, 0))
    assert kl.diagnose(craig, "inverse_dynamics", written(POINTS)).agrees
    text = POINTS.replace("m2*l2*g*c12 + (m1", "m2*l2*g*c1 + (m1").replace(
        "s2*qd[0]**2", "s2*qd[1]**2"
    )
    found, good = asked(text, craig, "inverse_dynamics")
    assert good, str(found)
    assert "line" in str(found)


UNIT = """
from math import sin

m1, m2, m3 = 1.0, 1.0, 1.0
l1, l2, l3 = 1.0, 1.0, 1.0
A, B, C = (m2 + m3)*l1*l2, m3*l2*l3, m3*l1*l3

def f(q, v):
    a, b, c = A*sin(q[1]), B*sin(q[2]), C*sin(q[1] + q[2])
    v12, v123 = v[0] + v[1], v[0] + v[1] + v[2]
    t1 = -a*(v12**2 - v[0]**2) - b*(v123**2 - v12**2) - c*(v123**2 - v[0]**2)
    t2 = a*v[0]**2 - b*(v123**2 - v12**2) + c*v[0]**2
    return [t1, t2, b*v12**2 + c*v[0]**2]
"""


def test_one_number_for_all_of_a_unit_arm_is_each_links_own(tmp_path) -> None:
    lengths = (0.0, 1.0, 1.0)
    links = [kl.DHLink(a=a, mass=1.0, com=(1.0, 0, 0)) for a in lengths]
    arm = kl.DHTable("unit", "modified", links)
    assert kl.diagnose(arm, "coriolis_torques", written(UNIT)).agrees
    found, good = asked(UNIT.replace("(m2 + m3)", "m2"), arm, "coriolis_torques", tmp_path / "h.py")
    assert good, str(found)
    assert "(m2 + m3)*l1*l2" in found.sentence


LOGGED = """
import logging
import numpy as np

log = logging.getLogger(__name__)
ROWS = [(0.00, np.pi / 2, 0.31), (0.43, 0.0, 0.12), (0.35, 0.0, 0.0)]

def turned(a, alpha, d, theta):
    c, s = np.cos(theta), np.sin(theta)
    ca, sa = np.cos(alpha), np.sin(alpha)
    return np.array([[c, -s*ca, s*sa, a*c], [s, c*ca, -c*sa, a*s], [0, sa, ca, d], [0, 0, 0, 1]])

def f(q, wrench):
    T = np.eye(4)
    origins, axes = [T[:3, 3]], [T[:3, 2]]
    for qi, (a, alpha, d) in zip(q, ROWS):
        T = T @ turned(a, alpha, d, qi)
        origins.append(T[:3, 3])
        axes.append(T[:3, 2])
    force, moment = np.asarray(wrench[:3]), np.asarray(wrench[3:])
    tau = []
    for z, o in zip(axes[:-1], origins):
        tau.append(z @ np.cross(origins[-1] - o, force) + z @ moment)
    log.debug("tau = %s", tau)
    return np.array(tau)
"""


def test_a_logger_which_leads_back_to_itself_ends_nothing(tmp_path, monkeypatch) -> None:
    links = [kl.DHLink(alpha=np.pi / 2, d=0.31), kl.DHLink(a=0.43, d=0.12), kl.DHLink(a=0.35)]
    arm = kl.DHTable("elbow", "standard", links)
    text = LOGGED.replace("+ z @ moment", "- z @ moment").replace(
        "axes.append(T[:3, 2])", "axes.append(T[:3, 1])"
    )
    (tmp_path / "logged.py").write_text(text)
    spec = importlib.util.spec_from_file_location("logged", tmp_path / "logged.py")
    module = importlib.util.module_from_spec(spec)
    monkeypatch.setitem(sys.modules, "logged", module)
    spec.loader.exec_module(module)
    told = kl.diagnose(arm, "statics", module.f).sentence
    assert "`axes.append(T[:3, 1])` should be `axes.append(T[:3, 2])`" in told
