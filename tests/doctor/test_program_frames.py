"""Matrices in another order, and a column for a row: the line is told with what should stand there."""

from __future__ import annotations

import pytest
from hand_programs import with_slips, written
from test_program_idle import heavy

import kinlab as kl

ELEMENTARY = """
import numpy as np

def turn_z(t):
    c, s = np.cos(t), np.sin(t)
    return np.array([[c, -s, 0, 0], [s, c, 0, 0], [0, 0, 1, 0], [0, 0, 0, 1]])

def turn_x(t):
    c, s = np.cos(t), np.sin(t)
    return np.array([[1, 0, 0, 0], [0, c, -s, 0], [0, s, c, 0], [0, 0, 0, 1]])

def shift(x, z):
    T = np.eye(4)
    T[0, 3], T[2, 3] = x, z
    return T
"""
STANDARD = (
    ELEMENTARY
    + """
a, d = [0.0, 0.4318, 0.0203, 0.0, 0.0, 0.0], [0.0, 0.0, 0.15005, 0.4318, 0.0, 0.0]
alpha = np.array([1, 0, -1, 1, -1, 0])*np.pi/2

def f(q):
    T = np.eye(4)
    for i, t in enumerate(q):
        T = T @ turn_z(t) @ shift(0, d[i]) @ shift(a[i], 0) @ turn_x(alpha[i])
    return T
"""
)
MODIFIED = (
    ELEMENTARY
    + """
H = np.pi/2
table = [(0, 0, 0), (H, 0, 0), (0, 0.4318, 0.15005), (-H, 0.0203, 0.4318), (H, 0, 0), (-H, 0, 0)]

def link(t, alpha, a, d):
    return turn_x(alpha) @ shift(a, 0) @ turn_z(t) @ shift(0, d)

def f(q):
    T = np.eye(4)
    for t, (alpha, a, d) in zip(q, table):
        T = T @ link(t, alpha, a, d)
    return T
"""
)
LOOP = "turn_z(t) @ shift(0, d[i]) @ shift(a[i], 0) @ turn_x(alpha[i])"
IN_LINK = "turn_x(alpha) @ shift(a, 0) @ turn_z(t) @ shift(0, d)"


@pytest.mark.parametrize(
    ("robot", "text", "right", "wrong"),
    [
        # the order of the other convention, however its commuting factors stand
        ("puma560", STANDARD, LOOP,
         "turn_x(alpha[i]) @ shift(a[i], 0) @ turn_z(t) @ shift(0, d[i])"),
        ("puma560", STANDARD, LOOP,
         "shift(a[i], 0) @ turn_x(alpha[i]) @ turn_z(t) @ shift(0, d[i])"),
        ("puma560_modified", MODIFIED, IN_LINK,
         "turn_z(t) @ shift(0, d) @ shift(a, 0) @ turn_x(alpha)"),
    ],
)  # fmt: skip
def test_the_order_of_the_other_convention_is_told_with_its_line(robot, text, right, wrong):
    assert kl.diagnose(robot, "fk", written(text)).agrees
    told = kl.diagnose(robot, "fk", written(with_slips(text, [(right, wrong)])))
    assert len(told.causes) == 1
    assert "the order is exchanged" in told.causes[0].sentence
    assert right in told.causes[0].sentence.split("should be")[1]


def test_what_a_loop_multiplies_may_be_from_the_last_to_the_first():
    wrong = "turn_x(alpha[i]) @ shift(a[i], d[i]) @ turn_z(t)"
    right = "turn_z(t) @ shift(a[i], d[i]) @ turn_x(alpha[i])"
    text = STANDARD.replace(LOOP, right)
    assert kl.diagnose("puma560", "fk", written(text)).agrees
    told = kl.diagnose("puma560", "fk", written(text.replace(right, wrong)))
    assert right in told.causes[0].sentence.split("should be")[1]


PUMA = """
import numpy as np
H = np.pi/2
rows = [(0.0, 0.0, H), (0.4318, 0.0, 0.0), (0.0203, 0.15005, -H), (0.0, 0.4318, H),
        (0.0, 0.0, -H), (0.0, 0.0, 0.0)]

def A(t, a, d, alpha):
    c, s, ca, sa = np.cos(t), np.sin(t), np.cos(alpha), np.sin(alpha)
    return np.array([[c, -s*ca, s*sa, a*c], [s, c*ca, -c*sa, a*s], [0, sa, ca, d], [0, 0, 0, 1]])

"""
TOOL = (
    PUMA
    + """def f(q):
    J = np.zeros((6, 6))
    T = np.eye(4)
    for k in reversed(range(6)):
        T = A(q[k], *rows[k]) @ T
        x, y, z = T[:3, 0], T[:3, 1], T[:3, 2]
        p = T[:3, 3]
        axis = np.array([x[2], y[2], z[2]])
        J[:3, k] = [p[0]*u[1] - p[1]*u[0] for u in (x, y, z)]
        J[3:, k] = axis
    return J
"""
)


@pytest.mark.parametrize(
    ("right", "wrong"),
    [
        ("axis = np.array([x[2], y[2], z[2]])", "axis = 1.0*z"),
        ("axis = np.array([x[2], y[2], z[2]])", "axis = z"),
    ],
)
def test_a_row_of_named_columns_is_told_for_a_column(right, wrong):
    assert kl.diagnose("puma560", "jacobian_tool", written(TOOL)).agrees
    told = kl.diagnose("puma560", "jacobian_tool", written(with_slips(TOOL, [(right, wrong)])))
    assert len(told.causes) == 1
    assert "line 18" in told.causes[0].sentence
    assert "x[2], y[2], z[2]" in told.causes[0].sentence


SPACE = (
    PUMA
    + """def f(q):
    T = np.eye(4)
    points, axes = [], []
    for k in range(6):
        R = T[:3, :3]
        x = R[:, 0]
        y = R[:, 1]
        z = R[:, 2]
        points.append(T[:3, 3])
        axes.append(z)
        T = T @ A(q[k], *rows[k])
    return np.array([np.hstack([np.cross(z, T[:3, 3] - p), z]) for z, p in zip(axes, points)]).T
"""
)


def test_a_named_column_is_told_for_a_row():
    assert kl.diagnose("puma560", "jacobian", written(SPACE)).agrees
    text = SPACE.replace("axes.append(z)", "axes.append(np.array([x[2], y[2], z[2]]))")
    told = kl.diagnose("puma560", "jacobian", written(text))
    assert len(told.causes) == 1
    assert "line 20" in told.causes[0].sentence
    assert "np.array(z)" in told.causes[0].sentence.split("should be")[1]


SUM = """
import numpy as np

def f(q):
    m, l, r, inertia = [2.0, 1.5], [0.5, 0.4], [0.25, 0.2], [2.0*0.25/12, 1.5*0.16/12]
    angle = np.cumsum(q)
    ways = [np.array([np.cos(t), np.sin(t)]) for t in angle]
    M = np.zeros((2, 2))
    for k in range(2):
        J = np.zeros((2, 2))
        for j in range(k + 1):
            way = sum(((l if n < k else r)[n]*ways[n] for n in range(j, k + 1)), np.zeros(2))
            J[:, j] = [-way[1], way[0]]
        turns = np.array([1.0, k])
        M = M + (m[k]*J.T @ J + inertia[k]*np.outer(turns, turns))
    return M
"""


def test_a_mass_stays_in_front_of_a_product_that_is_turned_over():
    assert kl.diagnose("planar2r_rods", "mass_matrix", written(SUM)).agrees
    text = SUM.replace("m[k]*J.T @ J", "m[k]*J @ J.T")
    told = kl.diagnose("planar2r_rods", "mass_matrix", written(text))
    assert "m[k]*J.T @ J" in told.causes[0].sentence.split("should be")[1]


@pytest.mark.parametrize("wrong", ["[A[k], 0, D[k]]", "[A[k]*c, A[k]*s, D[k]]"])
def test_the_way_to_a_frame_is_told_in_its_own_axes(wrong):
    robot, right = kl.load("puma560"), "[A[k], D[k]*sa, D[k]*ca]"
    text = heavy(robot).partition("\ndef f(")[0]
    text += "\ndef f(q, v, a):\n    return rne(q, v, a, 9.81) + Jm*a\n"
    assert text.count(right) == 1 and kl.diagnose(robot, "inverse_dynamics", written(text)).agrees
    told = kl.diagnose(robot, "inverse_dynamics", written(text.replace(right, wrong)))
    assert "axes" in told.causes[0].kinds and right in told.causes[0].sentence


TENSORS = """
import numpy as np

def f(q):
    I = [np.diag([0.02, 0.08, 0.07]), np.diag([0.01, 0.04, 0.045]),
         np.array([[0.004, 0.001, 0], [0.001, 0.012, 0.0005], [0, 0.0005, 0.014]])]
    m, l = [3.0, 2.0, 1.2], [0.45, 0.35]
    c = [np.array([0.2, 0.02, -0.01]), np.array([0.15, -0.01, 0.03]), np.array([0.12, 0.03, 0.01])]
    R, p, axes, points = np.eye(3), np.zeros(3), [], []
    M = np.zeros((3, 3))
    for k in range(3):
        if k:
            p = p + R @ np.array([l[k - 1], 0, 0])
        if k == 2:
            R = R @ np.array([[1, 0, 0], [0, 0, -1], [0, 1, 0]])
        cq, sq = np.cos(q[k]), np.sin(q[k])
        R = R @ np.array([[cq, -sq, 0], [sq, cq, 0], [0, 0, 1]])
        axes.append(R[:, 2])
        points.append(p)
        Jv, Jw = np.zeros((3, 3)), np.zeros((3, 3))
        for j in range(k + 1):
            Jv[:, j] = np.cross(axes[j], p + R @ c[k] - points[j])
            Jw[:, j] = axes[j]
        M = M + m[k]*Jv.T @ Jv + Jw.T @ R @ I[k] @ R.T @ Jw
    return M
"""


def test_products_of_inertia_with_the_other_sign_are_told_in_their_matrix():
    assert kl.diagnose("spatial3r", "mass_matrix", written(TENSORS)).agrees
    text = TENSORS.replace("0.001", "-0.001").replace("0.0005", "-0.0005")
    told = kl.diagnose("spatial3r", "mass_matrix", written(text))
    assert told.causes[0].kinds == ("products' signs",), str(told)
    assert "[0.001, 0.012, 0.0005]" in told.causes[0].sentence.split("should be")[1]


def test_what_each_joint_before_has_too_is_told():
    text = SUM.replace(
        "turns = np.array([1.0, k])", "turns = np.zeros(2)\n        turns[:k + 1] = 1"
    )
    assert kl.diagnose("planar2r_rods", "mass_matrix", written(text)).agrees
    told = kl.diagnose("planar2r_rods", "mass_matrix", written(text.replace("[:k + 1]", "[k]")))
    assert "turns[:k + 1] = 1" in told.causes[0].sentence.split("should be")[1], str(told)
