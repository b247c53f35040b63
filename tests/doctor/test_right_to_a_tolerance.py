"""Functions that are right up to where they stop, to digits, or to a turn: none is called wrong."""

from __future__ import annotations

import pytest
from hand_programs import written

import kinlab as kl

ARM = kl.DHTable(
    "arm",
    "standard",
    [
        kl.DHLink("revolute", a=0.5, mass=2.0, com=(-0.25, 0, 0)),
        kl.DHLink("revolute", a=0.4, mass=2.0, com=(-0.2, 0, 0)),
    ],
    gravity=(0, -9.81, 0),
)
RIGHT = {
    "an inverse by iterations": ("mass_matrix", """
def f(q):
    h = 0.4*np.cos(q[1])
    A = np.array([[0.125 + 0.5 + 0.08 + h, 0.08 + h/2], [0.08 + h/2, 0.08]])
    return iterated(iterated(A, 1e-14), {small})

def iterated(M, near):
    X = M.T/np.trace(M @ M.T)
    for _ in range(100):
        X2 = 2*X - X @ M @ X
        if np.abs(X2 - X).max() < near:
            break
        X = X2
    return X
"""),
    "a damped inverse": ("mass_matrix", """
def f(q):
    h = 0.4*np.cos(q[1])
    A = np.array([[0.125 + 0.5 + 0.08 + h, 0.08 + h/2], [0.08 + h/2, 0.08]])
    return np.linalg.inv(np.linalg.inv(A) + {small}*np.eye(2))
"""),
    "inverse kinematics by Newton": ("inverse_kinematics_xy", """
def f(x, y):
    b = np.arccos((x**2 + y**2 - 0.41)/0.4)
    q = np.array([np.arctan2(y, x) - np.arctan2(0.4*np.sin(b), 0.5 + 0.4*np.cos(b)), b]) + 0.02
    for _ in range(60):
        c1, s1, c12, s12 = np.cos(q[0]), np.sin(q[0]), np.cos(q[0] + q[1]), np.sin(q[0] + q[1])
        e = np.array([x - 0.5*c1 - 0.4*c12, y - 0.5*s1 - 0.4*s12])
        if np.linalg.norm(e) < {small}:
            break
        J = np.array([[-0.5*s1 - 0.4*s12, -0.4*s12], [0.5*c1 + 0.4*c12, 0.4*c12]])
        q = q + J.T @ np.linalg.solve(J @ J.T + 1e-9*np.eye(2), e)
    return q
"""),
}  # fmt: skip


@pytest.mark.parametrize("name", RIGHT)
def test_what_stops_early_is_right_to_there(name: str) -> None:
    quantity, text = RIGHT[name]
    f = written("import numpy as np\n" + text.replace("{small}", "1e-05"))
    assert not kl.compare(kl.Robot.from_dh(ARM), quantity, f).agrees
    found = kl.diagnose(ARM, quantity, f)
    assert found.agrees and found.form == "digits", str(found)
    assert "1e-05" in str(found)


def test_a_slip_beside_a_small_number_is_none() -> None:
    quantity, text = RIGHT["a damped inverse"]
    wrong = text.replace("{small}", "1e-05").replace("0.08 + h/2", "0.0805 + h/2")
    found = kl.diagnose(ARM, quantity, written("import numpy as np\n" + wrong))
    assert not found.agrees, str(found)


ROUNDED = """
import numpy as np

def f(q):
    g = np.array([14.715*np.cos(q[0]) + 3.924*np.cos(q[0] + q[1]), 3.924*np.cos(q[0] + q[1])])
    return {answer}
"""


@pytest.mark.parametrize(
    ("answer", "right"),
    [
        ("[float(f'{x:.4g}') for x in g]", True),
        ("[float(f'{x:.3e}') for x in g]", True),
        ("[float(f'{1.004*x:.4g}') for x in g]", False),
    ],
)
def test_answers_to_significant_digits(answer: str, right: bool) -> None:
    found = kl.diagnose(ARM, "gravity_torques", written(ROUNDED.replace("{answer}", answer)))
    assert found.agrees is right, str(found)
    assert not right or "4 significant digits" in str(found)


ANGLES = """
import numpy as np

def f(xy, mode):
    th = []
    for e, m in zip(({e}, -{e}), mode):
        x, y = xy[0] - e, xy[1]
        r = np.hypot(x, y)
        th.append(np.arctan2(y, x) {sign} m*np.arccos((r**2 + {l1}**2 - {l2}**2)/(2*{l1}*r)))
    return np.array(th)
"""


@pytest.mark.parametrize(
    ("e", "sign", "right"), [(None, "-", True), ("0.1414", "-", True), (None, "+", False)]
)
def test_angles_to_whole_turns_and_to_digits(e: str | None, sign: str, right: bool) -> None:
    """They leave the engine's range, and the distance of the cranks is rounded as well."""
    bar = kl.FiveBar.load("isotropic")
    text = ANGLES.replace("{l1}", str(bar.l1[0])).replace("{l2}", str(bar.l2[0]))
    f = written(text.replace("{e}", e or repr(float(bar.e))).replace("{sign}", sign))
    found = kl.diagnose("isotropic", "fivebar_angles", f)
    assert found.agrees is right, str(found)


SOLVED = """
import numpy as np

def f(x, y):
    c = (x**2 + y**2 - {l1}**2 - {l2}**2)/(2*{l1}*{l2})
    q2 = np.arccos(c)
    q1 = np.arctan2(y, x) - np.arctan2({l2}*np.sin(q2), {l1} + {l2}*np.cos(q2)){off}
    return {answer}
"""


@pytest.mark.parametrize(
    ("answer", "off", "right"),
    [
        ("np.round([q1, q2], 3)", "", True),
        ("np.deg2rad(np.round(np.rad2deg([q1, q2]), 1))", "", True),
        ("np.round([q1, q2], 3)", " + 0.02", False),
    ],
)
def test_joint_positions_that_are_rounded(answer: str, off: str, right: bool) -> None:
    text = SOLVED.replace("{l1}", "0.5").replace("{l2}", "0.4")
    f = written(text.replace("{answer}", answer).replace("{off}", off))
    found = kl.diagnose(ARM, "inverse_kinematics_xy", f)
    assert found.agrees is right, str(found)


ROWS = """
from typing import NamedTuple

import numpy as np

class Row(NamedTuple):
    a: float
    m: float
    c: float
    n: np.ndarray

ROWS = [Row(0.5, 2.0, 0.25, np.zeros(3000)), Row(0.4, 2.0, {c}, np.zeros(3000))]

def f(q):
    th = np.cumsum(q)
    long = np.zeros(3000) + np.cos(th[0])
    g2 = 9.81*ROWS[1].m*ROWS[1].c*np.cos(th[1])
    return np.array([9.81*(ROWS[0].m*ROWS[0].c + ROWS[1].m*ROWS[0].a)*long[0] + g2, g2])
"""


def test_rows_with_names_and_long_vectors_are_read() -> None:
    assert kl.diagnose(ARM, "gravity_torques", written(ROWS.replace("{c}", "0.2"))).agrees
    found = kl.diagnose(ARM, "gravity_torques", written(ROWS.replace("{c}", "0.4")))
    assert found.causes and "0.2" in found.causes[0].sentence, str(found)
