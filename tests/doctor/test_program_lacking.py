"""What a line lacks of a textbook's number, and in which line a slip is that several would undo."""

from __future__ import annotations

import pytest
from hand_programs import asked, with_slips, written

import kinlab as kl

PROGRAMS = {
    "crank": ("isotropic", "fivebar_jacobian", """
import numpy as np

l1, l2, e = 0.3, 0.5, 0.2/np.sqrt(2)
H = np.array([[0, 1], [-1, 0]])

def f(r, mode):
    J = np.zeros((2, 2))
    for i, (side, m) in enumerate(zip((1, -1), mode)):
        x, y = r
        A = 2*(side*e - x)*l1
        B = -2*y*l1
        C = l2**2 - e**2 - l1**2 - x**2 - y**2 + 2*side*e*x
        th = 2*np.arctan((B + m*np.sqrt(A**2 + B**2 - C**2))/(A + C))
        u = np.array([np.cos(th), np.sin(th)])
        w = (np.array([x - side*e, y]) - l1*u)/l2
        J[i] = w/(l1*(u @ H @ w))
    return J
"""),
    "rods": ("planar2r_rods", "coriolis_matrix", """
import numpy as np

def f(q, qdot):
    m2 = 1.5
    a1 = 0.5
    ac2 = 0.4/2
    h = -m2*a1*ac2*np.sin(q[1])
    C = np.zeros((2, 2))
    C[0, 0] = h*qdot[1]
    C[0, 1] = h*qdot[1] + h*qdot[0]
    C[1, 0] = -h*qdot[0]
    return C
"""),
    "products": ("planar3r", "coriolis_torques", """
import numpy as np

m2, m3, l1, l2, l3 = 2.0, 1.0, 0.5, 0.4, 0.25
p12 = (m2/2 + m3)*l1*l2
p13 = m3/2*l1*l3
p23 = m3/2*l2*l3

def f(q, v):
    s2, s3, s23 = np.sin(q[1]), np.sin(q[2]), np.sin(q[1] + q[2])
    D = np.zeros((3, 3, 3))
    D[0, 0, 1] = -2*p12*s2 - 2*p13*s23
    D[0, 1, 1] = D[1, 0, 1] = -p12*s2 - p13*s23
    D[0, 2, 1] = D[2, 0, 1] = -p13*s23
    D[0, 0, 2] = -2*p13*s23 - 2*p23*s3
    D[0, 1, 2] = D[1, 0, 2] = -p13*s23 - 2*p23*s3
    D[0, 2, 2] = D[2, 0, 2] = -p13*s23 - p23*s3
    D[1, 1, 2] = -2*p23*s3
    D[1, 2, 2] = D[2, 1, 2] = -p23*s3
    c = np.zeros(3)
    for i in range(3):
        for j in range(3):
            for k in range(3):
                c[i] += 0.5*(D[i, j, k] + D[i, k, j] - D[j, k, i])*v[j]*v[k]
    return c
"""),
    "screws": ("ur5", "jacobian_spatial", """
import numpy as np

L1, L2, W1, H1, H2 = 0.425, 0.39225, 0.10915, 0.089159, 0.09465
W = np.array([[0, 0, 1], [0, 1, 0], [0, 1, 0], [0, 1, 0], [0, 0, -1], [0, 1, 0]], float)
Q = np.array([[0, 0, 0], [0, 0, H1], [L1, 0, H1], [L1 + L2, 0, H1], [L1 + L2, W1, 0],
              [L1 + L2, 0, H1 - H2]])

def skew(w):
    return np.array([[0, -w[2], w[1]], [w[2], 0, -w[0]], [-w[1], w[0], 0]])

def exp6(w, v, th):
    K = skew(w)
    T = np.eye(4)
    T[:3, :3] = np.eye(3) + np.sin(th)*K + (1 - np.cos(th))*K @ K
    T[:3, 3] = (np.eye(3)*th + (1 - np.cos(th))*K + (th - np.sin(th))*K @ K) @ v
    return T

def f(q):
    J, T = np.zeros((6, 6)), np.eye(4)
    for i in range(6):
        w = W[i]
        v = -np.cross(w, Q[i])
        R, p = T[:3, :3], T[:3, 3]
        J[3:, i] = R @ w
        J[:3, i] = R @ v + skew(p) @ R @ w
        T = T @ exp6(w, v, q[i])
    return J
"""),
    "poses": ("planar3r", "newton_step", """
import numpy as np

LINKS = (0.5, 0.4, 0.25)

def pose(q):
    x = y = angle = 0.0
    for l, t in zip(LINKS, q):
        angle += t
        x += l*np.cos(angle)
        y += l*np.sin(angle)
    return np.array([x, y, angle])

def jacobian(q):
    J = np.ones((3, 3))
    for col in range(3):
        J[0, col] = J[1, col] = 0.0
        for k in range(col, 3):
            phi = sum(q[:k + 1])
            J[0, col] -= LINKS[k]*np.sin(phi)
            J[1, col] += LINKS[k]*np.cos(phi)
    return J

def f(q, xd):
    return q + np.linalg.solve(jacobian(q), xd - pose(q))
"""),
    "statics": ("planar3r", "statics", """
import numpy as np

L1, L2, L3 = 0.5, 0.4, 0.25

def f(q, wrench):
    fx, fy, nz = wrench[0], wrench[1], wrench[5]
    a1 = q[0]
    a2 = a1 + q[1]
    a3 = a2 + q[2]
    tau3 = -L3*np.sin(a3)*fx + L3*np.cos(a3)*fy + nz
    tau2 = tau3 - L2*np.sin(a2)*fx + L2*np.cos(a2)*fy
    tau1 = tau2 - L1*np.sin(a1)*fx + L1*np.cos(a1)*fy
    return np.array([tau1, tau2, tau3])
"""),
    "minors": ("planar3r", "planar_determinant", """
import numpy as np

l1, l2, l3 = 0.5, 0.4, 0.25

def f(q):
    t1, t2, t3 = q
    s1, c1 = np.sin(t1), np.cos(t1)
    s12, c12 = np.sin(t1 + t2), np.cos(t1 + t2)
    s123, c123 = np.sin(t1 + t2 + t3), np.cos(t1 + t2 + t3)
    a, b, c = -l1*s1 - l2*s12 - l3*s123, -l2*s12 - l3*s123, -l3*s123
    d, e, h = l1*c1 + l2*c12 + l3*c123, l2*c12 + l3*c123, l3*c123
    return a*(e - h) - b*(d - h) + c*(d - e)
"""),
}  # fmt: skip


@pytest.mark.parametrize("name", PROGRAMS)
def test_the_programs_are_right(name: str) -> None:
    robot, quantity, text = PROGRAMS[name]
    assert kl.diagnose(robot, quantity, written(text), samples=20).agrees


@pytest.mark.many
@pytest.mark.parametrize(
    ("name", "slips", "told"),
    [
        pytest.param("crank", [(" + 2*side*e*x", "")], ["a term is missing", "`C = "], id="a product of four"),
        pytest.param("rods", [("h = -m2", "h = m2")], ["the sign is wrong", "`h = "], id="a sign beside 0.4/2"),
        pytest.param("rods", [("0.4/2", "0.4"), ("-h*qdot[0]", "-h*qdot[1]")], ["`ac2 = 0.4` should be `ac2 = 0.2`"], id="a length by a centre's name"),
        pytest.param("products", [("(m2/2 + m3)", "(m2/2)"), ("D[2, 0, 1] = -p13*s23", "D[2, 0, 1] = -p13*s3")], ["p12, a number is wrong: 0.2 should be 0.4"], id="all of one beside half of another"),
        pytest.param("screws", [(" + skew(p) @ R @ w", "")], ["np.cross(p, R @ w)"], id="a vector that nothing uses"),
        pytest.param("poses", [("angle += t", "angle = t"), ("J[0, col] -=", "J[0, col] +=")], ["`angle += t`"], id="a sum that is set anew"),
        pytest.param("statics", [("a3 = a2 + q[2]", "a3 = q[2]"), ("L1*np.cos", "L2*np.cos")], ["`a3 = a2 + q[2]`"], id="where a name is set"),
        pytest.param("minors", [("c*(d - e)", "c*(e - d)"), ("np.sin(t1 + t2), np", "np.sin(t2), np")], ["line 13"], id="an entry of J is right"),
        pytest.param("crank", [("B = -2*y*l1", "B = 2*y*l1"), ("(l1*(u @ H", "(l2*(u @ H")], ["`B = 2*y*l1`"], id="where B is worked out"),
    ],
)  # fmt: skip
def test_a_slip_is_told_where_it_is(name, slips, told) -> None:
    robot, quantity, text = PROGRAMS[name]
    found, good = asked(with_slips(text, slips), robot, quantity)
    assert good, str(found)
    assert len(found.causes[0].kinds) == len(slips), str(found)
    for piece in told:
        assert piece in found.causes[0].sentence, str(found)


def test_the_transpose_of_the_inverse_is_told() -> None:
    """J^T f for J^-T f, where force is asked of torque or the other way round."""
    text = """
import numpy as np

def f(q, wrench):
    s1, c1, s12, c12 = np.sin(q[0]), np.cos(q[0]), np.sin(q[0] + q[1]), np.cos(q[0] + q[1])
    J = np.array([[-0.5*s1 - 0.4*s12, -0.4*s12], [0.5*c1 + 0.4*c12, 0.4*c12]])
    J = np.linalg.inv(J)
    return {} @ wrench[:2] + wrench[5]
"""
    right, wrong = (text.format(x) for x in ("np.linalg.inv(J).T", "J.T"))
    assert kl.diagnose("planar2r", "statics", written(right), samples=20).agrees
    found, good = asked(wrong, "planar2r", "statics")
    assert good, str(found)
