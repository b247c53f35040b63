"""Programs with rounded numbers, and programs that round: right, as a text with these numbers is."""

from __future__ import annotations

import numpy as np
import pytest
from hand_programs import written

import kinlab as kl

ARM = kl.DHTable(
    "arm",
    "standard",
    [
        kl.DHLink("revolute", a=0.45, mass=3.2, com=(-0.24, 0, 0), inertia=np.diag([0, 0.1, 0.1])),
        kl.DHLink("revolute", a=0.37, mass=1.7, com=(-0.21, 0, 0)),
    ],
    gravity=(0, -9.81, 0),
)
"""m2 l1 lc2 = 0.1224; the weights are 14.09697 and 2.66832."""
C = """
def f(q, v):
    h = {h}*np.sin(q[1])
    return np.array([[{first}, -h*v[1]], [h*v[0], 0]])
"""
V = """
def f(q):
    return {a}*np.sin(q[0]) + {b}*np.sin(q[0] + q[1]) + 100
"""
WEIGHT = """
def f(q):
    a, b = {a}*np.cos(q[0]), {b}*np.cos(q[0] + q[1])
    return np.array([a + b, b])
"""
CUT = """
def C(x):
    return {cut}

def f(q):
    g2 = {b}*C(q[0] + q[1])
    return np.array([14.09697*C(q[0]) + g2, g2])
"""


def judged(quantity: str, text: str, **numbers: object) -> kl.Diagnosis:
    space = {"np": np}
    exec("import numpy as np\n" + text.format(**numbers), space)  # noqa: S102
    return kl.diagnose(ARM, quantity, space["f"], samples=30)


@pytest.mark.parametrize(
    ("h", "first", "right"),
    [
        ("0.122", "-2*h*v[1]", True),
        ("0.12", "-2*h*v[1]", True),
        ("0.124", "-2*h*v[1]", False),
        ("0.122", "-3*h*v[1]", False),
        ("0.122", "2*h*v[1]", False),
    ],
)
def test_another_c_with_a_rounded_number(h: str, first: str, right: bool) -> None:
    found = judged("coriolis_matrix", C, h=h, first=first)
    assert found.agrees == right
    if right:
        assert found.form == "unusual"
        said = "C*qd is right, but C is not Christoffel's: Mdot - 2C is not skew-symmetric"
        assert found.remarks == (said, f"{h} stands for 0.1224")


@pytest.mark.parametrize(
    ("a", "b", "right"),
    [
        ("14.1", "2.67", True),
        ("14", "2.7", True),
        ("14.2", "2.67", False),
        ("14", "2.9", False),
        ("14", "-2.7", False),
    ],
)
def test_another_zero_with_rounded_numbers(a: str, b: str, right: bool) -> None:
    found = judged("potential_energy", V, a=a, b=b)
    assert found.agrees == right
    if right:
        assert found.form == "unusual"
        assert "another zero (the difference is 100 J everywhere)" in found.remarks[0]
        assert f"{b} stands for 2.66832" in found.remarks


@pytest.mark.parametrize(
    ("a", "b", "right"),
    [("14", "2.7", True), ("14.1", "2.7", True), ("15", "2.7", False), ("14", "2.6", False)],
)
def test_two_digits_and_whole_numbers(a: str, b: str, right: bool) -> None:
    found = judged("gravity_torques", WEIGHT, a=a, b=b)
    assert found.agrees == right
    if right:
        assert found.form == "rounded"
        assert "2.7 stands for 2.66832" in found.remarks


def test_whole_numbers_with_places_behind() -> None:
    heavy = kl.DHTable(
        "crane",
        "standard",
        [kl.DHLink("revolute", a=14.0, mass=3200.0, com=(-7.0, 0, 0))],
        gravity=(0, -9.81, 0),
    )
    assert kl.diagnose(heavy, "V", "220000*sin(q1) + 100", samples=30).form == "unusual"
    assert not kl.diagnose(heavy, "V", "210000*sin(q1) + 100", samples=30).agrees


def test_a_divisor_is_no_rounding() -> None:
    """m l^2 / 12 is not the inertia of something that is nearly a rod."""
    nearly = kl.DHTable(
        "nearly",
        "standard",
        [kl.DHLink("revolute", a=1.0, mass=12.0, inertia=np.diag([0, 1.01, 1.01]))],
    )
    assert not kl.diagnose(nearly, "M11", "m1*l1^2/12", samples=20).agrees


@pytest.mark.parametrize(
    ("cut", "b", "piece"),
    [
        ("round(np.cos(x)*4096)/4096", "2.66832", "round(np.cos(x)*4096)"),
        ("float(np.float16(np.cos(x)))", "2.66832", "np.float16(np.cos(x))"),
        ("np.asarray(np.cos(x)).astype(np.float16)", "2.66832", "astype(np.float16)"),
        ("round(np.cos(x)*4096)/4096", "2.67", "round(np.cos(x)*4096)"),
    ],
)
def test_a_program_that_rounds_is_right_with_rounded_numbers(cut: str, b: str, piece: str) -> None:
    found = judged("gravity_torques", CUT, cut=cut, b=b)
    assert found.agrees and found.form == "rounded"
    assert found.remarks[0].startswith("line 4 (in C) rounds: ")
    assert piece in found.remarks[0]
    assert ("2.67 stands for 2.66832" in found.remarks) == (b == "2.67")
    assert not judged("gravity_torques", CUT, cut=cut.replace("cos", "sin"), b=b).agrees


def test_what_rounds_far_too_much_is_wrong() -> None:
    assert not judged("gravity_torques", CUT, cut="int(np.cos(x)*4)/4", b="2.66832").agrees


def test_of_what_is_nearly_right_it_is_said_how_nearly() -> None:
    text = """
def V(q):
    return 14.09697*np.sin(q[0]) + 2.66832*np.sin(q[0] + q[1])

def f(q):
    return np.array([(V(q + 1e-2*e) - V(q))/1e-2 for e in np.eye(2)])
"""
    found = judged("gravity_torques", text)
    assert found.grade == "not sure" and not found.causes
    assert any("no entry is off by more than 0.5" in one for one in found.proved)


@pytest.mark.parametrize("pi", ["3.1415927", "3.141593", "3.1416"])
def test_pi_to_however_many_digits(pi: str) -> None:
    text = f"""
def f(q):
    turned = {pi}/2 - q[0] - q[1]
    g2 = 2.66832*np.sin(turned)
    return np.array([14.09697*np.cos(q[0]) + g2, g2])
"""
    found = judged("gravity_torques", text)
    assert found.form == "rounded", str(found)
    assert "stands for pi" in str(found)


def test_of_pi_a_digit_that_is_another_is_wrong() -> None:
    text = """
def f(q):
    turned = 3.1425927/2 - q[0] - q[1]
    g2 = 2.66832*np.sin(turned)
    return np.array([14.09697*np.cos(q[0]) + g2, g2])
"""
    assert judged("gravity_torques", text).form != "rounded"


def test_another_c_is_rounded_row_by_row() -> None:
    """0.063 and 0.031 stand for one number and its half, each in a row that is looked at alone."""
    rows = (
        "[-0.8*s2*qd2 - 0.13*s23*(qd2 + qd3) - 0.1*s3*qd3,"
        " -0.4*s2*qd2 - 0.1*s3*qd3 - 0.063*s23*(qd2 + qd3), -0.063*s23*(qd2 + qd3) - 0.05*s3*qd3]",
        "[-0.2*s2*qd2 - 0.1*s3*qd3 - 0.031*s23*(qd2 + qd3) + 0.063*s23*qd1 + 0.4*s2*qd1,"
        " -0.1*s3*qd3 + 0.2*s2*qd1 + 0.031*s23*qd1, -0.05*s3*qd3 + 0.031*s23*qd1]",
        "[-0.031*s23*(qd2 + qd3) - 0.025*s3*qd3 + 0.063*s23*qd1 + 0.05*s3*(qd1 + qd2),"
        " -0.025*s3*qd3 + 0.05*s3*(qd1 + qd2) + 0.031*s23*qd1,"
        " 0.031*s23*qd1 + 0.025*s3*(qd1 + qd2)]",
    )
    found = kl.diagnose("planar3r", "C", f"[{', '.join(rows)}]", samples=40)
    assert found.form == "unusual"
    assert found.remarks[0] == "C*qd is right, but C is not Christoffel's"
    off = kl.diagnose("planar3r", "C", f"[{', '.join(rows)}]".replace("0.8*", "0.82*"), samples=40)
    assert not off.agrees


def test_a_number_that_the_robot_has_stands_for_no_other() -> None:
    """0.16 is the distance of the scara's centre from the far end, and no 0.165 that is rounded."""
    text = """
import numpy as np

def f(q):
    e = 0.01*np.exp(1j*(q[0] + q[1] - q[3]))
    hand = 0.275*np.exp(1j*(q[0] + q[1])) + e
    second = (0.145 - 0.005j)*np.exp(1j*(q[0] + q[1]))
    elbow = 0.325*np.exp(1j*q[0])
    moved = [0.165*np.exp(1j*q[0]), elbow + second, elbow + hand - e, elbow + hand]
    height = [0.407, 0.417, 0.437 - q[2], 0.397 - q[2]]
    return np.array([[z.real, z.imag, h] for z, h in zip(moved, height)])
"""
    right = kl.diagnose("scara", "com_positions", written(text))
    wrong = kl.diagnose("scara", "com_positions", written(text.replace("0.165", "0.16")))
    assert right.agrees and not wrong.agrees, (str(right), str(wrong))
