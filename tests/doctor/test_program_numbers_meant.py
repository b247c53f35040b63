"""Programs whose numbers are the robot's own, as far as somebody typed them: these are right."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest
from hand_programs import written

import kinlab as kl

RECURSION = """
import numpy as np

alpha = [np.pi/2, 0, -np.pi/2, np.pi/2, -np.pi/2, 0]
a = [0, 0.4318, 0.0203, 0, 0, 0]
d = [0, 0, 0.15005, 0.4318, 0, 0]
m = [0, 17.4, 4.8, 0.82, 0.34, 0.09]
r = np.array([[0, 0, 0], [-0.3638, 0.006, 0.2275], [-0.0203, -0.0141, 0.07],
              [0, 0.019, 0], [0, 0, 0], [0, 0, 0.032]])
I = [np.zeros(3), [0.13, 0.524, 0.539], [0.0685, 0.0835, 0.015], [0.0018, 0.0013, 0.0018],
     [0.0003, 0.0004, 0.0003], [0.00015, 0.00015, 4e-05]]
Jm = [1.134029969, 2.324814845, 0.576873332, 0.190790626, 0.170706292, 0.194064506]


def f(q, qd, qdd):
    x, z = np.cross, np.array([0, 0, 1.0])
    w, wd, vd = np.zeros(3), np.zeros(3), np.array([0, 0, 9.81])
    R, p, F, N = [], [], [], []
    for i in range(6):
        ct, st, ca, sa = np.cos(q[i]), np.sin(q[i]), np.cos(alpha[i]), np.sin(alpha[i])
        R.append(np.array([[ct, -st*ca, st*sa], [st, ct*ca, -ct*sa], [0, sa, ca]]))
        p.append(np.array([a[i], d[i]*sa, d[i]*ca]))
        wd = R[i].T @ (wd + z*qdd[i] + x(w, z*qd[i]))
        w = R[i].T @ (w + z*qd[i])
        vd = x(wd, p[i]) + x(w, x(w, p[i])) + R[i].T @ vd
        J = np.diag(I[i])
        F.append(m[i]*(x(wd, r[i]) + x(w, x(w, r[i])) + vd))
        N.append(J @ wd + x(w, J @ w))
    f_, n_, tau = np.zeros(3), np.zeros(3), np.zeros(6)
    for i in reversed(range(6)):
        if i < 5:
            f_, n_ = R[i + 1] @ f_, R[i + 1] @ n_
        n_ = n_ + x(p[i], f_) + x(p[i] + r[i], F[i]) + N[i]
        f_ = f_ + F[i]
        tau[i] = n_ @ (R[i].T @ z) + Jm[i]*qdd[i]
    return tau
"""
TENSORS = [
    (0.031474313, 0.021875625, 0.031474313),
    (0.036365625, 0.421753804, 0.421753804),
    (0.010884375, 0.111069694, 0.111069694),
    (0.005108248, 0.005108248, 0.0055125),
    (0.005108248, 0.0055125, 0.005108248),
    (0.000526462, 0.000568125, 0.000526462),
]
TURNING = """
import numpy as np

I = {tensors}

def f(q, v):
    alpha = [np.pi/2, 0, 0, np.pi/2, -np.pi/2, 0]
    w, T = np.zeros(3), []
    for i in range(6):
        c, s, ca, sa = np.cos(q[i]), np.sin(q[i]), np.cos(alpha[i]), np.sin(alpha[i])
        R = np.array([[c, -s*ca, s*sa], [s, c*ca, -c*sa], [0, sa, ca]])
        w = R.T @ (w + np.array([0, 0, v[i]]))
        T.append(0.5*np.sum(np.array(I[i])*w**2))
    return np.array(T)
"""
REMEMBERING = """
import numpy as np

seen = {{}}

def f(q):
    key = tuple(q)
    if key not in seen:
        seen[key] = 2.5*9.81*0.3*np.{function}({pi}/2 - q[0])
    return np.array([seen[key]])
"""
ANGLES = """
import numpy as np

l1, l2, e = np.array([0.30, 0.26]), np.array([0.50, 0.54]), np.array([0.12, -0.12])

def f(xy, mode):
    x, y = xy
    A, B = 2*(e - x)*l1, -2*y*l1
    C = l2**2 - l1**2 - (x - e)**2 - y**2
    return np.arctan2(B, A) {sign} mode*np.arctan2(np.sqrt(A**2 + B**2 - C**2), C)
"""


def told(robot: object, quantity: str, text: str, file: Path | None = None) -> kl.Diagnosis:
    if file is not None:
        file.write_text(text)
    return kl.diagnose(robot, quantity, written(text, file))


def test_the_recursion_is_right() -> None:
    assert told("puma560", "inverse_dynamics", RECURSION).form == ""


@pytest.mark.parametrize(
    ("slips", "remark"),
    [
        pytest.param([("1.134029969", "1.134")], "1.134 stands for", id="one rotor's inertia"),
        pytest.param([("2.324814845", "2.3")], "2.3 stands for", id="a rotor's to two digits"),
        pytest.param([("0.4318", "0.432"), ("0.15005", "0.15")], "0.432 stands for", id="lengths"),
        pytest.param([("9.81", "9.8"), ("1.134029969", "1.1340")], "9.8 stands for", id="g, and a rotor's"),
    ],
)  # fmt: skip
def test_the_robots_numbers_to_the_digits_written(slips: list, remark: str) -> None:
    text = RECURSION
    for right, rounded in slips:
        assert right in text
        text = text.replace(right, rounded)
    found = told("puma560", "inverse_dynamics", text)
    assert found.agrees and found.form == "rounded", str(found)
    assert any(one.startswith(remark) for one in found.remarks)


@pytest.mark.many
@pytest.mark.parametrize(
    ("right", "slip"),
    [
        pytest.param("1.134029969", "1.314", id="digits exchanged"),
        pytest.param("0.15005", "0.15505", id="a digit twice"),
        pytest.param("17.4", "14.7", id="two of three digits exchanged"),
        pytest.param("wd + z*qdd[i] + x(", "wd + z*qdd[i] - x(", id="a sign"),
    ],
)
def test_a_slip_is_no_rounding_be_a_number_rounded_beside_it(right: str, slip: str) -> None:
    for text in (RECURSION, RECURSION.replace("2.324814845", "2.325")):
        assert right in text
        found = told("puma560", "inverse_dynamics", text.replace(right, slip))
        assert not found.agrees
        if text is RECURSION and right[0].isdigit():
            assert f"{slip} should be {right}" in found.causes[0].sentence


def test_columns_of_one_number_of_decimals() -> None:
    """In a column that is the table's so far, one digit of a small number is a rounding, too."""
    arm = kl.DHTable(
        "wrist",
        "standard",
        [
            kl.DHLink(alpha=alpha, mass=1.0, inertia=np.diag(row))
            for alpha, row in zip([np.pi / 2, 0, 0, np.pi / 2, -np.pi / 2, 0], TENSORS, strict=True)
        ],
    )
    rounded = [tuple(round(x, 4) for x in row) for row in TENSORS]
    assert rounded[-1] == (0.0005, 0.0006, 0.0005)
    found = told(arm, "link_kinetic_energies", TURNING.format(tensors=rounded))
    assert found.agrees and found.form == "rounded", str(found)
    off = [*rounded[:-1], (0.0005, 0.0006, 0.0007)]
    assert not told(arm, "link_kinetic_energies", TURNING.format(tensors=off)).agrees


def test_a_program_that_remembers_its_answers(tmp_path: Path) -> None:
    rounded = REMEMBERING.format(function="sin", pi="3.1416")
    found = told("single_link", "gravity_torques", rounded, tmp_path / "rounded.py")
    assert found.agrees and found.form == "rounded", str(found)
    assert "3.1416 stands for pi" in found.remarks
    slip = REMEMBERING.format(function="cos", pi="np.pi")
    found = told("single_link", "gravity_torques", slip, tmp_path / "slip.py")
    assert "sine and cosine are exchanged" in found.sentence


@pytest.mark.parametrize(("typed", "right"), [("3.14", True), ("1.571*2", True), ("1.6*2", False)])
def test_a_constant_is_a_rounding_within_one_per_cent(typed: str, right: bool) -> None:
    text = f"""
import numpy as np

def f(q):
    return np.array([2.5*9.81*0.3*np.sin(({typed})/2 - q[0])])
"""
    assert told("single_link", "gravity_torques", text).agrees == right


def test_a_whole_turn_more_is_the_same_angle() -> None:
    found = told("unequal", "fivebar_angles", ANGLES.format(sign="+"))
    assert found.agrees and found.form == "unusual", str(found)
    assert "the same angle" in found.remarks[0]
    assert not told("unequal", "fivebar_angles", ANGLES.format(sign="-")).agrees


def test_a_c_from_differences_is_christoffels() -> None:
    def M(q: np.ndarray) -> np.ndarray:
        h = 0.5 * 2 * 0.25 * np.cos(q[1])
        return np.array([[1.5 + 2 * h, 0.5 + h], [0.5 + h, 0.5]])

    arm = kl.DHTable(
        "plain",
        "standard",
        [
            kl.DHLink(a=0.5, mass=1.0, com=(-0.25, 0, 0), inertia=np.diag([0.3, 0.3, 0.4375])),
            kl.DHLink(a=0.5, mass=2.0, com=(-0.25, 0, 0), inertia=np.diag([0.3, 0.3, 0.375])),
        ],
    )
    assert kl.compare(arm, "mass_matrix", M).agrees

    def f(q: np.ndarray, v: np.ndarray) -> np.ndarray:
        step = 1e-6
        slope = np.array([(M(q + step * e) - M(q)) / step for e in np.eye(2)])
        C = np.zeros((2, 2))
        for k in range(2):
            C += 0.5 * v[k] * slope[k]
            C += 0.5 * v[k] * (slope[:, :, k].T - slope[:, k, :])
        return C

    found = kl.diagnose(arm, "coriolis_matrix", f)
    assert found.agrees, str(found)
    assert not any("not Christoffel's" in one for one in found.remarks)
