"""Matrices as textbooks have them, with fewer rows than the engine's; accelerations as ``a[0]``."""

from __future__ import annotations

import pytest

import kinlab as kl
from kinlab.errors import KinlabError

SCARA = (
    r"\begin{bmatrix}-a_1s_1-a_2s_{12}&-a_2s_{12}&0&0\\a_1c_1+a_2c_{12}&a_2c_{12}&0&0"
    r"\\0&0&-1&0\\1&1&0&-1\end{bmatrix}"
)
PLANE = "[c12, -s12, l1*c1 + l2*c12; s12, c12, l1*s1 + l2*s12; 0, 0, 1]"
POSES = {
    "single_link": "[cos(q1), -sin(q1), l*cos(q1); sin(q1), cos(q1), l*sin(q1); 0, 0, 1]",
    "planar2r": PLANE,
    "planar3r": "[c123, -s123, l1*c1 + l2*c12 + l3*c123; s123, c123, l1*s1 + l2*s12 + l3*s123; 0, 0, 1]",
}  # fmt: skip


@pytest.mark.parametrize("entry", ["J", "jacobian"])
def test_the_four_rows_of_a_scaras_jacobian_are_its_rates(entry: str) -> None:
    found = kl.diagnose("scara", entry, SCARA)
    assert found.agrees and "vx, vy, vz, wz" in str(found)
    wrong = kl.diagnose("scara", entry, SCARA.replace(r"1&1&0&-1", r"1&1&0&1"))
    assert not wrong.agrees and "wz" in str(wrong) and "1 should be -1" in str(wrong)


@pytest.mark.parametrize("robot", POSES)
@pytest.mark.parametrize("entry", ["fk", "T"])
def test_a_pose_in_the_plane_is_judged_as_one(robot: str, entry: str) -> None:
    text = POSES[robot]
    assert kl.diagnose(robot, entry, text).agrees
    wrong = kl.diagnose(
        robot, entry, text.replace("l1*c1 +", "l1*s1 +").replace(", l*cos", ", l*sin")
    )
    assert not wrong.agrees and wrong.causes[0].kinds == ("sin/cos",), str(wrong)


def test_a_rotation_is_no_pose_in_the_plane() -> None:
    assert kl.diagnose("planar2r", "R", "[c12, -s12, 0; s12, c12, 0; 0, 0, 1]").agrees
    assert not kl.diagnose("planar2r", "R", "[c12, -s12, 0; s12, c12, 0; 0, 0, 2]").agrees


ACCELERATIONS = [
    ("planar2r", "tau2", "0.24*(a[0] + a[1]) + 0.3*np.cos(q[1])*a[0] + 0.3*np.sin(q[1])*v[0]**2 + 5.886*np.cos(q[0]+q[1])"),
    ("planar2r_rods", "tau2", "0.08*(a[0]+a[1]) + 0.15*cos(q[1])*a[0] + 0.15*sin(q[1])*v[0]**2 + 2.943*cos(q[0]+q[1])"),
    ("single_link", "tau1", "0.3*a[0] + 7.3575*np.cos(q[0])"),
    ("single_link", "tau", "tau = m*l**2/3*a[0] + m*g*l/2*cos(q[0])"),
]  # fmt: skip


@pytest.mark.parametrize(("robot", "entry", "text"), ACCELERATIONS)
def test_the_third_argument_of_a_function_is_the_accelerations(robot, entry, text) -> None:
    assert kl.diagnose(robot, entry, text).agrees


@pytest.mark.parametrize(
    ("robot", "entry", "text"),
    [
        ("single_link", "tau1", "0.3*a1 + 7.3575*cos(q1)"),
        ("planar2r", "tau2", "0.24*(a1 + a2) + 0.3*c2*a1 + 0.3*s2*qd1^2 + 5.886*c12"),
        ("scara", "tau3", "3.6*a3 - 15.696"),
    ],
)
def test_what_may_be_a_length_or_an_acceleration_is_asked(robot, entry, text) -> None:
    with pytest.raises(kl.errors.ExpressionError, match="a length or an acceleration"):
        kl.diagnose(robot, entry, text)


@pytest.mark.parametrize(
    ("entry", "text"),
    [
        ("x", "a[0]*cos(q[0]) + a[1]*cos(q[0] + q[1])"),
        ("g2", "m2*g*a[1]*cos(q[0] + q[1])"),
        ("tau2", "m2*a2*(a2*(qdd1 + qdd2) + a1*cos(q2)*qdd1 + a1*sin(q2)*qd1^2 + g*cos(q1 + q2))"),
    ],
)
def test_where_nothing_is_accelerated_it_is_a_length(entry: str, text: str) -> None:
    assert kl.diagnose("planar2r", entry, text).agrees


@pytest.mark.parametrize(
    ("robot", "quantity", "rows"),
    [
        ("planar2r", "jacobian", "-l1*s1-l2*s12, -l2*s12; l1*c1+l2*c12, l2*c12; 1, 1"),
        ("planar3r", "jacobian", "-l1*s1-l2*s12-l3*s123, -l2*s12-l3*s123, -l3*s123; "
         "l1*c1+l2*c12+l3*c123, l2*c12+l3*c123, l3*c123; 1, 1, 1"),
        ("planar2r", "jacobian_tool", "l1*s2, 0; l1*c2+l2, l2; 1, 1"),
    ],
)  # fmt: skip
def test_three_rows_of_a_planar_arm_may_be_those_of_the_plane(robot, quantity, rows):
    found = kl.diagnose(robot, quantity, f"[{rows}]")
    assert found.agrees and "vx, vy, wz" in " ".join(found.remarks)
    wrong = kl.diagnose(robot, quantity, f"[{rows.replace('l2', 'l1', 1)}]")
    assert not wrong.agrees and wrong.causes
    linear = ", ".join("0" for _ in rows.rpartition(";")[2].split(","))
    assert kl.diagnose(robot, quantity, f"[{rows.rpartition(';')[0]}; {linear}]").agrees


def test_a_point_in_the_plane_has_two_coordinates_and_one_in_space_three():
    for robot, quantity, text in (
        ("single_link", "com_positions", "[l/2*cos(q); l/2*sin(q)]"),
        ("planar2r", "com_positions[1]", "[l1*c1+l2*c12; l1*s1+l2*s12]"),
        ("planar2r", "com_positions[1]", "[l1*c1+l2*c12; l1*s1+l2*s12; 0]"),
    ):
        assert kl.diagnose(robot, quantity, text).agrees
    for robot, quantity in (
        ("spatial3r", "com_positions[2]"), ("planar2r", "com_positions"), ("planar2r", "mass_matrix"),
        ("planar2r", "link_velocities"),
    ):  # fmt: skip
        with pytest.raises(KinlabError):
            kl.diagnose(robot, quantity, "[l1*c1; l1*s1]")
