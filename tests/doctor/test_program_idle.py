"""What is left unused or in half: a rotor's row, an entry, all moments of a row, a ratio."""

from __future__ import annotations

import importlib.util

import numpy as np
import pytest
from hand_programs import asked, written

import kinlab as kl

RODS = """
import numpy as np
l, m = (0.5, 0.4), (2.0, 1.5)

def f(q):
    I = (m[0]*l[0]**2/12, m[1]*l[1]**2/12)
    mixed = I[1] + m[1]*(l[1]**2/4 + l[0]*l[1]/2*np.cos(q[1]))
    last = I[1] + m[1]*l[1]**2/4
    first = I[0] + m[0]*l[0]**2/4 + m[1]*l[0]**2
    return np.array([[first + 2*mixed - last, mixed], [mixed, last]])
"""
ENTRIES = """
import numpy as np

def f(q):
    s, c = np.sin(q[0] + q[1]), np.cos(q[0] + q[1])
    x, y = 0.5*np.cos(q[0]) + 0.4*c, 0.5*np.sin(q[0]) + 0.4*s
    J = np.zeros((6, 2))
    J[:2] = [[-y, -0.4*s], [x, 0.4*c]]
    J[5] = 1
    return J
"""
GEARED = """
import numpy as np
l, m, g = 0.5, 2.0, 9.81
Ia = np.array([3e-5*80**2, 2e-5*60**2])

def f(q, v, tau):
    c, s = np.cos(q[1]), np.sin(q[1])
    h = m*l*l*s
    M = np.array([[3*m*l*l + 2*m*l*l*c, m*l*l*(1 + c)], [m*l*l*(1 + c), m*l*l]]) + np.diag(Ia)
    n = np.array([-h*v[1]*(2*v[0] + v[1]), h*v[0]**2])
    G = m*g*l*np.array([2*np.cos(q[0]) + np.cos(q[0] + q[1]), np.cos(q[0] + q[1])])
    return np.linalg.solve(M, tau - n - G)
"""


def geared() -> kl.Robot:
    """Two equal point masses on geared motors."""
    links = [
        kl.DHLink(a=0.5, mass=2.0, armature=0.192),
        kl.DHLink(a=0.5, mass=2.0, armature=0.072),
    ]
    return kl.Robot.from_dh(kl.DHTable("geared", "standard", links, gravity=(0, -9.81, 0)))


@pytest.mark.parametrize(
    ("robot", "quantity", "text", "old", "new"),
    [
        ("planar2r_rods", "mass_matrix", RODS, "2/12, m[1]*l[1]**2/12", "2/3, m[1]*l[1]**2/3"),
        ("planar2r", "jacobian", ENTRIES, "[x, 0.4*c]", "[x, 0.0]"),
        ("planar2r", "jacobian", ENTRIES, "[-y, -0.4*s]", "[-y, 0.0]"),
        (geared(), "forward_dynamics", GEARED, " + np.diag(Ia)", ""),
    ],
    ids=["all moments", "an entry", "with its sign", "a row of rotors"],
)  # fmt: skip
def test_it_is_told(robot, quantity, text, old, new) -> None:
    assert text.count(old) == 1
    assert kl.diagnose(robot, quantity, written(text)).agrees
    found, good = asked(text.replace(old, new), robot, quantity)
    assert good, str(found)


def test_the_square_of_a_ratio_is_told_as_it_is_typed(tmp_path) -> None:
    path = tmp_path / "geared_arm.py"
    path.write_text(GEARED.replace("2e-5*60**2", "2e-5*60"))
    spec = importlib.util.spec_from_file_location("geared_arm", path)
    module = importlib.util.module_from_spec(spec)
    spec.loader.exec_module(module)
    found = kl.diagnose(geared(), "forward_dynamics", module.f)
    assert "2e-05*60**2" in found.causes[0].sentence, str(found)


def test_a_call_of_a_heavy_program_is_told() -> None:
    """Its own Newton-Euler called with gravity for each column of M: hundreds of edits come first."""
    robot = kl.load("puma560")
    assert kl.diagnose(robot, "forward_dynamics", written(heavy(robot))).agrees
    text = heavy(robot).replace("rne(q, none, e, 0.0)", "rne(q, none, e, 9.81)")
    found, good = asked(text, robot, "forward_dynamics")
    assert good, str(found)


def heavy(robot: kl.Robot) -> str:
    links = robot.table.links
    rows = {
        "A": [k.a for k in links],
        "D": [k.d for k in links],
        "al": [k.alpha for k in links],
        "m": [k.mass for k in links],
        "r": [[float(x) for x in k.com] for k in links],
        "I": [np.asarray(k.inertia).tolist() for k in links],
        "Jm": [k.armature for k in links],
    }
    head = "\n".join(f"{name} = np.array({row})" for name, row in rows.items())
    return f"import numpy as np\n{head}\n{HEAVY}"


HEAVY = """
z = np.array([0.0, 0.0, 1.0])

def rne(q, qd, qdd, grav):
    R, P, F, N = [], [], [], []
    w, dw, dv = np.zeros(3), np.zeros(3), np.array([0.0, 0.0, grav])
    for k in range(6):
        c, s, ca, sa = np.cos(q[k]), np.sin(q[k]), np.cos(al[k]), np.sin(al[k])
        R.append(np.array([[c, -s*ca, s*sa], [s, c*ca, -c*sa], [0, sa, ca]]))
        P.append(np.array([A[k], D[k]*sa, D[k]*ca]))
        dw = R[k].T @ (dw + z*qdd[k] + np.cross(w, z*qd[k]))
        w = R[k].T @ (w + z*qd[k])
        dv = np.cross(dw, P[k]) + np.cross(w, np.cross(w, P[k])) + R[k].T @ dv
        F.append(m[k]*(np.cross(dw, r[k]) + np.cross(w, np.cross(w, r[k])) + dv))
        N.append(I[k] @ dw + np.cross(w, I[k] @ w))
    f, n, tau = np.zeros(3), np.zeros(3), np.zeros(6)
    for k in range(5, -1, -1):
        if k < 5:
            f, n = R[k + 1] @ f, R[k + 1] @ n
        n = n + np.cross(P[k], f) + np.cross(P[k] + r[k], F[k]) + N[k]
        f = f + F[k]
        tau[k] = n @ R[k].T @ z
    return tau

def f(q, qd, tau):
    none, M = np.zeros(6), np.zeros((6, 6))
    for k in range(6):
        e = np.eye(6)[k]
        M[:, k] = rne(q, none, e, 0.0)
    M = M + np.diag(Jm)
    h = rne(q, qd, none, 9.81)
    return np.linalg.solve(M, tau - h)
"""
