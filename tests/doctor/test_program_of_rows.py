"""Slips of whole rows: of one that stands for another, of squares, of the rows that are left."""

from __future__ import annotations

import pytest
from hand_programs import asked, told_in_its_line
from test_program_lanes import FIVE_BAR

TOOL_AXES = """
import numpy as np

a, d = [0, -0.612, -0.5723, 0, 0, 0], [0.1273, 0, 0, 0.163941, 0.1157, 0.0922]
alpha = [np.pi/2, 0, 0, np.pi/2, -np.pi/2, 0]

def link(i, th):
    c, s, ca, sa = np.cos(th), np.sin(th), np.cos(alpha[i]), np.sin(alpha[i])
    return np.array([[c, -s*ca, s*sa, a[i]*c], [s, c*ca, -c*sa, a[i]*s], [0, sa, ca, d[i]], [0, 0, 0, 1]])

def f(q):
    T = [np.eye(4)]
    for i in range(6):
        T.append(T[-1] @ link(i, q[i]))
    Re, pe = T[6][:3, :3], T[6][:3, 3]
    J = np.zeros((6, 6))
    for i in range(6):
        z = T[i][:3, 2]
        J[:3, i] = np.cross(z, pe - T[i][:3, 3])
        J[3:, i] = z
    J[:3] = Re.T @ J[:3]
    J[3:] = Re.T @ J[3:]
    return J
"""
SQUARES = """
import numpy as np

def f(q):
    s1, c1, s12, c12 = np.sin(q[0]), np.cos(q[0]), np.sin(q[0] + q[1]), np.cos(q[0] + q[1])
    J = np.array([[-0.5*s1 - 0.4*s12, -0.4*s12], [0.5*c1 + 0.4*c12, 0.4*c12]])
    values = np.linalg.svd(J, compute_uv=False)
    lam = values**2
    return float(np.sum((lam/lam.mean() - 1)**2))
"""  # fmt: skip


@pytest.mark.parametrize(
    ("robot", "quantity", "text", "right", "slip"),
    [
        ("planar2r", "isotropy_defect", SQUARES, "lam = values**2", "lam = values"),
        ("unequal", "fivebar_torque", FIVE_BAR, "np.outer(rr[i]", "np.outer(l2[i]"),
    ],
    ids=["squares", "row"],
)
def test_a_slip_is_told_in_its_line(robot, quantity, text, right, slip, tmp_path):
    """Neither was found: the first was not tried, the second not in the time there is."""
    told_in_its_line(robot, quantity, text, right, slip, tmp_path / "hand.py")


def test_what_is_done_to_some_rows_is_done_to_the_others():
    """It was told in the line that fills them, which has nothing wrong."""
    text = TOOL_AXES.replace("    J[3:] = Re.T @ J[3:]\n", "")
    found, _good = asked(text, "ur10", "jacobian_tool")
    assert "a line is missing: `J[3:] = Re.T @ J[3:]`" in found.sentence, found
