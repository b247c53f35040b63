"""Clauses beside a formula that say something of the arm: true ones are nothing, others refused."""

from __future__ import annotations

import numpy as np
import pytest

import kinlab as kl
from kinlab.doctor.file import examine_file
from kinlab.doctor.glossary.facts import holding
from kinlab.errors import ExpressionError
from kinlab.formulas.language.clauses import without_clauses

ARMS = ("single_link", "planar2r", "planar2r_rods", "planar3r", "spatial3r", "scara", "stanford")
G2 = "g2 = m2*g*l2*cos(q1+q2)"
X2 = "x = l1*cos(q1) + l2*cos(q1+q2)"
M22 = "M22 = I2 + m2*lc2^2"
Z4 = "z = d1 - q3"
LOOP = "(x - e - l1*cos(theta1))^2 + (y - l1*sin(theta1))^2 - l2^2"


@pytest.mark.parametrize("name", ARMS)
def test_which_way_gravity_acts_is_what_pinocchio_has(name) -> None:
    """Of six axes the one, or as many as Pinocchio's model says, in four ways to say it."""
    robot = kl.load(name)
    down = robot.model.gravity.linear / np.linalg.norm(robot.model.gravity.linear)
    for k, letter in enumerate("xyz"):
        for sign, word in ((1.0, "positive"), (-1.0, "negative")):
            axis = f"{'-' if sign < 0 else ''}{letter}"
            so = bool(np.isclose(down[k], sign))
            for clause in (
                f"gravity acts along {axis}",
                f"gravity points in the {word} {letter} direction",
                f"重力沿 {axis} 方向",
            ):
                assert _is_true(robot, clause) is so, clause
        assert _is_true(robot, f"the {letter} axis points downwards") is bool(down[k] > 0.9)
        assert _is_true(robot, f"${letter}$ points upwards") is bool(down[k] < -0.9)


@pytest.mark.parametrize("name", ARMS)
def test_which_joints_slide_is_what_pinocchio_has(name) -> None:
    robot = kl.load(name)
    for i, joint in enumerate(list(robot.model.joints)[1:], 1):
        slides = joint.shortname().startswith("JointModelP")
        assert (_is_true(robot, f"q{i} is the stroke of joint {i}") is True) is slides
        assert (_is_true(robot, f"q{i} is the angle of joint {i}") is True) is not slides
        if i > 1:
            said = f"q{i} is the angle of link {i} relative to link {i - 1}"
            assert (_is_true(robot, said) is True) is not slides


def _is_true(robot, clause: str) -> bool | None:
    """What becomes of a clause: left out, refused, or left where it stands."""
    text = f"tau1 = a + b, where {clause}"
    try:
        left = without_clauses(text, "here", holding(robot))
    except ExpressionError:
        return False
    assert left.startswith("tau1 = a + b")
    return None if left == text else True


TRUE = [
    ("planar2r", "g2", f"{G2}, with gravity along -y and g = 9.81 m/s^2"),
    ("planar2r", "g2", f"{G2} where l1, l2 are the link lengths and m2 is a point mass at its end"),
    ("planar2r", "g2", f"Der Arm bewegt sich in der vertikalen Ebene: {G2}"),
    ("planar2r", "x", f"{X2}, where q1 is measured from the x axis"),
    ("planar2r", "x", f"{X2} (q1, q2 in radians, x in m)"),
    ("planar2r", "x", f"{X2}，其中 θ2 是连杆2相对连杆1的转角，y 轴竖直向上"),
    ("planar2r", "V", "With the y axis pointing up: V = (m1+m2)*g*l1*sin(q1) + m2*g*l2*sin(q1+q2)"),
    ("planar2r_rods", "M22", f"{M22}, where lc2 = l2/2 is the distance from joint 2 to the centre of mass of link 2"),
    ("planar2r_rods", "M22", f"{M22}, wobei I2 das Trägheitsmoment um den Schwerpunkt ist"),
    ("planar2r_rods", "M22", "For uniform rods M22 = m2*l2^2/3, because the centre of mass lies at l2/2"),
    ("scara", "z", f"{Z4}, where q3 is the stroke of the quill, positive downwards"),
    ("stanford", "gravity_torques[2]", "The third joint slides, so g3 = (m3+m4+m5+m6)*g*cos(q2)"),
    ("isotropic", "fivebar_loop[0]", f"{LOOP}, where l1 is the length of the cranks, l2 that of the rods and 2e the distance of the motor axes"),
    ("planar3r", "planar_pose[0]", "x = l1*cos(q1) + l2*cos(q1+q2) + l3*cos(q1+q2+q3) holds for all q1, q2, q3"),
]  # fmt: skip


@pytest.mark.parametrize(("robot", "entry", "text"), TRUE)
def test_what_is_true_of_the_robot_says_nothing(robot, entry, text) -> None:
    found = kl.diagnose(robot, entry, text)
    assert found.agrees and not any("were not read" in one for one in found.remarks), str(found)


@pytest.mark.parametrize(("robot", "entry", "text"), TRUE)
def test_beside_what_is_true_a_wrong_formula_is_judged(robot, entry, text) -> None:
    wrong = text
    for old, new in (("cos(q1", "sin(q1"), ("sin(q1)", "cos(q1)"), ("I2 +", "I2 -"), ("- q3", "+ q3"), ("l2^2/3", "l2^2/4"), ("cos(q2)", "sin(q2)"), ("cos(theta1)", "sin(theta1)")):  # fmt: skip
        if old in text:
            wrong = text.replace(old, new, 1)
            break
    assert wrong != text
    assert not kl.diagnose(robot, entry, wrong).agrees


@pytest.mark.parametrize(
    ("robot", "entry", "text", "words"),
    [
        ("planar2r", "g2", f"{G2}, with gravity along -x", "gravity along -x"),
        ("planar2r", "g2", f"The arm moves in a horizontal plane: {G2}", "horizontal plane"),
        ("planar2r", "x", f"{X2}, with y downwards", "y downwards"),
        ("planar2r", "x", f"{X2}, where l1 is the length of link 2", "l1 is the length of link 2"),
        ("planar2r", "M22", "For uniform rods M22 = m2*l2^2/3", "uniform rods"),
        ("planar2r_rods", "M22", "M22 = m2*l2^2/3, with m2 concentrated at the end of link 2", "m2 concentrated"),
        ("planar2r_rods", "M22", f"{M22}, where I2 is the inertia of link 1 about its centre of mass", "I2 is the inertia"),
        ("scara", "z", f"{Z4}, where q3 is positive upwards", "q3 is positive upwards"),
        ("stanford", "gravity_torques[2]", "g3 = (m3+m4+m5+m6)*g*cos(q2), where q3 is the angle of joint 3", "angle of joint 3"),
        ("spatial3r", "z", "z = xt*sin(q3), where xt is the distance of the tool from joint 2", "xt is the distance"),
        ("isotropic", "fivebar_loop[0]", f"{LOOP}, where e is the distance between the two motors", "e is the distance"),
        ("isotropic", "fivebar_loop[0]", f"{LOOP}, where l2 is the length of the cranks", "l2 is the length"),
    ],
)  # fmt: skip
def test_what_is_not_so_is_refused_by_its_words(robot, entry, text, words) -> None:
    with pytest.raises(ExpressionError, match="is not so of this robot") as problem:
        kl.diagnose(robot, entry, text)
    assert words in str(problem.value)


@pytest.mark.parametrize(
    "words",
    [
        "angles in degrees",
        "lengths in mm",
        "I2 about joint 2",
        "where lc2 is half the length of link 2, measured from the end",
        "where q2 is the absolute angle of link 2",
        "where q2 is the angle of link 1 relative to link 2",
        "where q1 is measured negative from the horizontal",
        "without the rotor",
    ],
)
def test_what_is_no_known_clause_stays_in_doubt(words) -> None:
    """Refused, or said beside the verdict: never passed over."""
    try:
        found = kl.diagnose("planar2r_rods", "M22", f"{M22}, {words}")
    except ExpressionError:
        return
    assert any("were not read" in one for one in found.remarks), str(found)


@pytest.mark.parametrize("way", ["im Uhrzeigersinn", "gegen den Uhrzeigersinn"])
def test_which_way_an_angle_is_counted_is_never_passed_over_in_german(way) -> None:
    with pytest.raises(ExpressionError):
        kl.diagnose("planar2r", "x", f"{X2}, wobei q1 {way} von der Horizontalen gemessen wird")


def test_names_that_stay_behind_keep_the_word_that_opens_them() -> None:
    holds = holding(kl.load("planar2r"))
    text = "x = L*cos(q1), where the y axis points up, L = 0.5 and gravity acts along -y"
    assert without_clauses(text, "here", holds) == "x = L*cos(q1), where L = 0.5"


def test_no_clause_is_looked_for_in_a_text_without_end() -> None:
    text = "x = l1*cos(q1), " + "gravity along x and " * 400
    assert without_clauses(text, "here", holding(kl.load("planar2r"))) == text


def test_clauses_are_held_against_the_robot_of_a_file(tmp_path) -> None:
    path = tmp_path / "mine.toml"
    lines = f'robot = "planar2r"\n[formulas]\ng2 = "{G2}, where gravity acts along {{}}"\n'
    path.write_text(lines.format("-y"), encoding="utf-8")
    assert all(found.agrees for found in examine_file(path))
    path.write_text(lines.format("+x"), encoding="utf-8")
    with pytest.raises(ExpressionError, match="is not so of this robot"):
        examine_file(path)


J2 = "J = [-l1*sin(q1) - l2*sin(q1+q2), -l2*sin(q1+q2); l1*cos(q1) + l2*cos(q1+q2), l2*cos(q1+q2); 1, 1]"


@pytest.mark.parametrize(
    ("robot", "entry", "text", "said"),
    [
        ("planar2r", "planar_jacobian", f"{J2} expressed in the base frame", False),
        ("planar2r", "planar_jacobian", f"{J2} in the stretched pose", True),
        ("spatial3r", "M33", "M33 = Izz3 + m3*(cx3^2 + cy3^2), where Izz3 is taken about the centre of mass of link 3", False),
    ],
)  # fmt: skip
def test_words_beside_a_matrix_and_another_frame_or_point_are_said(
    robot, entry, text, said
) -> None:
    found = kl.diagnose(robot, entry, text)
    assert found.agrees and any("were not read" in one for one in found.remarks) is said, str(found)


@pytest.mark.parametrize(
    ("robot", "entry", "text"),
    [
        ("planar2r_rods", "M22", f"{M22}, where I2 is the moment of inertia about the second joint"),
        ("spatial3r", "M33", "M33 = Izz3 + m3*(cx3^2 + cy3^2), where Izz3 is taken about the axis of joint 3"),
    ],
)  # fmt: skip
def test_moments_about_another_point_are_refused(robot, entry, text) -> None:
    with pytest.raises(ExpressionError, match="about the"):
        kl.diagnose(robot, entry, text)


def test_a_letter_below_a_matrix_is_no_word() -> None:
    text = (
        r"{}^0_eT = \begin{bmatrix} c_{12} & s_{12} & 0 & l_1 c_1 + l_2 c_{12} \\ "
        r"s_{12} & c_{12} & 0 & l_1 s_1 + l_2 s_{12} \\ 0 & 0 & 1 & 0 \\ 0 & 0 & 0 & 1 \end{bmatrix}"
    )
    (cause,) = kl.diagnose("planar2r", "fk", text).causes
    assert cause.places == ("fk[0,1]",) and cause.kinds == ("sign",)


@pytest.mark.parametrize(
    "words",
    [
        "Friction is neglected.",
        "Without friction:",
        "忽略摩擦",
        "with friction neglected",
        "Reibung vernachlässigt",
    ],
)
def test_an_arm_without_friction_has_none_neglected(words) -> None:
    formula = "tau2 = m2*l2^2*(qdd1+qdd2) + m2*l1*l2*c2*qdd1 + m2*l1*l2*s2*qd1^2 + m2*g*l2*c12"
    text = f"{words} {formula}" if words.endswith(":") else f"{formula}, {words}"
    found = kl.diagnose("planar2r", "tau2", text)
    assert found.agrees and not found.remarks, found


@pytest.mark.parametrize("words", ["不忽略摩擦", "friction is not neglected", "with friction"])
def test_friction_that_is_not_neglected_is_never_passed_over(words) -> None:
    try:
        found = kl.diagnose("planar2r", "g2", f"g2 = m2*g*l2*c12, {words}")
    except ExpressionError as problem:
        assert "friction" in str(problem)
    else:
        assert found.remarks, found


X = "x = l1*c1 + l2*c12"


@pytest.mark.parametrize(
    "words",
    [
        "where l2 is the length of the first link and l1 that of the second",
        "where l1 and l2 are the lengths of the second and first link",
        "wobei l1 die Länge des zweiten Glieds und l2 die des ersten ist",
        "but with the opposite sign",
        "the last term must be dropped",
        "which is only an approximation for small angles",
        "hier fehlt noch ein Term",
        "where theta2 is counted clockwise",
        "for the other arm in the lab",
        "twice the energy",
        "neglecting the mass of link 1",
        "this should be negated",
        "except for a factor of 2",
        "单位 cm",
        "the correct result is different",
        "after multiplying by -1",
        "which lacks a factor",
        "half of what I wrote before",
        "(gilt nur für l1 = l2)",
        "valid only for equal links",
        "仅当关节2锁定",
        "去掉连杆1后",
        "with l1 and l2 in cm",
        "on a moving base",
        "where m_2 denotes the mass of the payload",
        "公式有误",
        "gravity not included",
        "which is the friction torque",
        "expressed in frame 2",
        "in the end-effector frame",
        "senza gravità",
    ],
)
def test_what_denies_a_right_formula_is_refused(words) -> None:
    with pytest.raises(ExpressionError):
        kl.diagnose("planar2r", "x", f"{X}, {words}")


@pytest.mark.parametrize(
    "words",
    [
        "where l1 is the length of the first link and l2 that of the second",
        "where l1 and l2 are the lengths of the first and the second link",
        "angles positive counter-clockwise",
        "friction forces are neglected",
    ],
)
def test_what_only_sounds_so_is_not(words) -> None:
    assert kl.diagnose("planar2r", "x", f"{X}, {words}").agrees
    assert kl.diagnose("planar2r", "x", f"Don't forget the second link: {X}").agrees


@pytest.mark.parametrize(
    ("robot", "name", "agrees"),
    [
        ("puma560", "Puma 560", True),
        ("puma560", "Stanford arm", False),
        ("planar2r", "Two joints of a SCARA", True),
    ],
)
def test_the_name_of_another_arm(robot, name, agrees) -> None:
    own = "x = l1*c1 + l2*c12"
    text = f"{name}:\n" + ("M66 = 0.000134 + 0.193" if robot == "puma560" else own)
    entry = "M66" if robot == "puma560" else "x"
    if agrees:
        kl.diagnose(robot, entry, text)
        return
    with pytest.raises(ExpressionError, match="not what it is asked for"):
        kl.diagnose(robot, entry, text)


def test_a_matrix_under_the_name_of_its_inverse() -> None:
    rows = "[(m1+m2)*l1^2 + m2*l2^2 + 2*m2*l1*l2*c2, m2*l2^2 + m2*l1*l2*c2; m2*l2^2 + m2*l1*l2*c2, m2*l2^2]"
    assert kl.diagnose("planar2r", "mass_matrix", f"% Mass matrix\nM = {rows}").agrees
    with pytest.raises(ExpressionError, match="Inverse"):
        kl.diagnose("planar2r", "mass_matrix", f"% Inverse of the mass matrix\nM = {rows}")


def test_the_tools_own_jacobian_is_in_its_axes() -> None:
    with pytest.raises(ExpressionError, match="not what it is asked for"):
        kl.diagnose("planar2r", "planar_jacobian", f"{J2} expressed in the tool frame")
    rows = "[[l1*s2, 0], [l1*c2 + l2, l2], [0, 0], [0, 0], [0, 0], [1, 1]]"
    assert kl.diagnose("planar2r", "jacobian_tool", f"In the tool frame: {rows}").agrees
    with pytest.raises(ExpressionError, match="not what it is asked for"):
        kl.diagnose("planar2r", "jacobian", f"In the tool frame: {rows}")


def test_a_text_that_begins_with_another_joint_is_not_of_this_one() -> None:
    tau2 = "m2*l2^2*(qdd1 + qdd2) + m2*l1*l2*c2*qdd1 + m2*l1*l2*s2*qd1^2 + m2*g*l2*c12"
    assert kl.diagnose("planar2r", "tau2", f"Torque of the second joint: {tau2}").agrees
    with pytest.raises(ExpressionError, match="FIRST joint"):
        kl.diagnose("planar2r", "tau2", f"Torque of the FIRST joint: {tau2}")


@pytest.mark.parametrize(
    ("robot", "entry", "text"),
    [
        ("planar2r", "y", "y-Koordinate:\ny = l1*s1 + l2*s12"),
        ("planar2r", "planar_position_determinant", "Singular where it vanishes:\n$l_1 l_2 \\sin(\\theta_2)$"),
        ("planar2r", "x", f"the tool (units: m)\n{X}"),
        ("planar2r_rods", "M22", "lc2 is the distance to the centre, lc2 = l2/2:\nM22 = I2 + m2*lc2^2"),
        ("planar2r", "phi", "atan2(s12, c12)"),
        ("planar2r", "phi", "2*atan(s12/(1 + c12))"),
    ],
)  # fmt: skip
def test_headings_and_other_forms_are_read(robot, entry, text) -> None:
    found = kl.diagnose(robot, entry, text)
    assert found.agrees and not any("holds only" in one for one in found.remarks), str(found)


DET = r"\det J = l_1 l_2 \sin\theta_2"
Z3 = r"z = a_3 \sin\theta_3"
HARMLESS = [
    ("planar2r", "planar_position_determinant", rf"The determinant is {DET}, so the arm is singular at \theta_2 = 0 and \theta_2 = \pi."),
    ("planar2r", "planar_position_determinant", rf"{DET}, which is singular for $\theta_2 = 0$ or $\pi$"),
    ("planar2r", "planar_position_determinant", "det J = l1*l2*sin(q2). The arm is singular when q2 = 0 or q2 = 180°"),
    ("planar2r", "planar_position_determinant", "det J = l1*l2*sin(q2), singulär für q2 = 0"),
    ("planar2r", "planar_position_determinant", "det J = l1*l2*sin(q2)，因此 q2 = 0 时奇异"),
    ("spatial3r", "fk[2,3]", f"{Z3}, where a_3 is the distance from joint 3 to the tool"),
    ("spatial3r", "fk[2,3]", f"{Z3}, wobei a_3 der Abstand von Gelenk 3 zum Werkzeug ist"),
    ("spatial3r", "fk[2,3]", f"{Z3}，其中 a_3 为关节3到末端的距离"),
    ("spatial3r", "fk[2,3]", f"{Z3}, where a_2 is the distance from joint 2 to joint 3"),
    ("planar2r_rods", "M12", r"设杆的参数如题，则 M_{12} = 0.08 + 0.15\cos q_2"),
    ("planar2r_rods", "M22", f"{M22};  % lci: distance from joint i to the center of mass"),
    ("planar2r_rods", "M22", f"{M22};  % l2: length of link 2"),
    ("planar2r", "christoffel[0,1,1]", r"The Christoffel symbol is D_{122} = -m_2 l_1 l_2 \sin\theta_2; the minus sign is correct, since M_{12} falls with \theta_2."),
    ("scara", "jacobian[1,1]", r"wie im Skript (Kap. 5): $J_{22} = a_2 \cos(\theta_1+\theta_2)$"),
    ("planar2r", "gravity_torques[1]", r"The gravity term is g_2 = m_2 g l_2 \cos(\theta_1+\theta_2)"),
    ("scara", "mass_matrix[2,2]", "M_{33} = m_3 + m_4 + I_{a3} [kg], constant"),
    ("isotropic", "fivebar_leg_loop", r"支链闭环方程：(s e + l_1\cos\theta - x)^2 + (l_1\sin\theta - y)^2 - l_2^2 = 0，其中 l_1 为曲柄长度"),
    ("stanford", "dh_poses[2,2,3]", r"The height of the wrist is z_3 = d_1 + q_3 \cos\theta_2 (cf. Paul, 1981)."),
    ("planar2r", "jacobian[1,0]", "Durch Ableiten nach q1 folgt J21 = l1*cos(q1) + l2*cos(q1+q2) (Einheit: m)"),
]  # fmt: skip


@pytest.mark.parametrize(("robot", "entry", "text"), HARMLESS)
def test_harmless_words_say_nothing(robot, entry, text) -> None:
    found = kl.diagnose(robot, entry, text)
    assert found.agrees and not any("were not read" in one for one in found.remarks), str(found)


@pytest.mark.parametrize(
    ("robot", "entry", "text"),
    [
        ("planar2r", "planar_position_determinant", rf"{DET}, so the arm is singular at \theta_2 = 0 and \theta_2 = \pi/2"),
        ("planar2r", "planar_position_determinant", f"{DET}, singular at q1 = 0"),
        ("spatial3r", "fk[2,3]", f"{Z3}, where a_3 is the distance from joint 2 to the tool"),
        ("spatial3r", "fk[2,3]", f"{Z3}, where a_3 is the distance from joint 2 to joint 3"),
        ("planar2r", "x", f"{X2}, where l2 is the distance between joint 1 and joint 2"),
        ("planar2r_rods", "M22", f"{M22};  % l2: length of link 1"),
        ("planar2r", "x", f"{X2}, the minus sign is missing"),
        ("single_link", "tau1", "τ = (I + m l_c²) q̈ + m g l_c cos q, where I is the moment of inertia of the rod about its joint and l_c = l/2"),
        ("single_link", "tau1", "τ = (I + m l_c²) q̈ + m g l_c cos q, wobei I das Trägheitsmoment des Stabes um das Gelenk ist und l_c = l/2"),
        ("planar2r", "x", f"{X2}, the minus sign must be added"),
        ("planar2r", "x", f"{X2}, the correct sign is the minus sign"),
        ("planar2r", "x", f"{X2}, das richtige Vorzeichen ist minus"),
        ("planar2r", "x", f"{X2}, 正确的符号是负号"),
        ("planar2r", "x", f"{X2}, the sign is not correct"),
        ("planar2r", "x", f"{X2} with a minus sign"),
        ("isotropic", "fivebar_leg_loop", r"(s e + l_1\cos\theta - x)^2 + (l_1\sin\theta - y)^2 - l_2^2 = 0, where the sign is wrong"),
    ],
)  # fmt: skip
def test_words_that_are_not_so_or_deny_are_refused(robot, entry, text) -> None:
    with pytest.raises(ExpressionError):
        kl.diagnose(robot, entry, text)


@pytest.mark.parametrize(
    ("robot", "entry", "text"),
    [
        (
            "planar2r",
            "planar_position_determinant",
            "det J = l1*l2*sin(q2), not singular at q2 = 0",
        ),
        ("planar2r", "M12", "M12 = m2*l2^2 + m2*l1*l2*cos(q2), constant"),
        ("planar2r", "x", f"{X2}, base turned by 180°"),
    ],
)
def test_what_is_left_in_doubt_is_said(robot, entry, text) -> None:
    assert any("were not read" in one for one in kl.diagnose(robot, entry, text).remarks)


def test_a_sum_goes_on_in_the_next_line_of_aligned_equations() -> None:
    """Not the last line alone is the formula."""
    text = (
        r"\begin{aligned} T &= \frac{1}{2}(m_1+m_2) l_1^2 \dot\theta_1^2 + \frac{1}{2} m_2 l_2^2"
        r" (\dot\theta_1+\dot\theta_2)^2 \\ &\quad + m_2 l_1 l_2 \cos\theta_2\, \dot\theta_1"
        r"(\dot\theta_1+\dot\theta_2) \end{aligned}"
    )
    assert kl.diagnose("planar2r", "kinetic_energy", text).agrees
    wrong = kl.diagnose("planar2r", "kinetic_energy", text.replace(r"\cos", r"\sin"))
    assert "sin/cos" in wrong.sentence


@pytest.mark.parametrize(
    ("robot", "entry", "text", "said"),
    [
        (
            "stanford",
            "dh_poses[2,0,3]",
            "q3*cos(q1)*sin(q2) - d2*cos(q1) + a3*sin(q1)",
            "cos(q1) should be sin(q1) in d2*cos(q1)",
        ),
        (
            "ur5",
            "dh_poses[1,0,3]",
            r"x_2 = -a_2 \cos\theta_1\sin\theta_2",
            r"\sin\theta_2 should be \cos\theta_2",
        ),
    ],
)
def test_a_slip_in_the_pose_of_a_frame_of_six_joints_is_told_in_the_text(
    robot, entry, text, said
) -> None:
    assert said in kl.diagnose(robot, entry, text).sentence


_WRIST = "x = l1*c1 + l2*c12"


@pytest.mark.parametrize(
    "words",
    [
        "valid for small angles", "in inches", "the torque would be in kgf, instead of newtons", "seen by the camera",
        "in a left-handed frame", "senza il peso", "sans la gravité", "sin términos de Coriolis", "second link only",
        "ungefähr", "大约", "not verified yet", "das Doppelte davon", "muss noch mit 2 multipliziert werden",
        "the sign must be reversed", "falta un término", "manca un termine", "valida solo per q2 piccolo",
        "valable seulement si q2 = 0", "válido sólo para q1 = 0", "摩擦を無視", "ではなく y である", "roughly",
        "hence minus 0.1 for the gripper", "so minus the base offset", "not in degrees but in gradians",
        "no approximation, but the second link is left out",
    ],
)  # fmt: skip
@pytest.mark.parametrize(
    "text",
    ["{formula}, {words}", "{formula}. {words}.", "{formula}  # {words}", "{formula}  // {words}"],
)
def test_words_that_deny_in_many_languages_are_refused(text, words):
    with pytest.raises(ExpressionError):
        kl.diagnose("planar2r", "x", text.format(formula=_WRIST, words=words))


@pytest.mark.parametrize(
    "words",
    ["relative joint angles", "No minus sign here", "not in degrees", "assume small angles"],
)  # fmt: skip
def test_words_that_look_like_a_denial(words):
    found = kl.diagnose("planar2r", "x", f"{_WRIST}. {words}.")
    assert found.agrees


@pytest.mark.parametrize(
    ("quantity", "text"),
    [
        ("potential_energy", "Kinetic energy: {V}"), ("potential_energy", "动能为 {V}"),
        ("gravity_torques[1]", "Mass matrix: g2 = m2*g*l2*c12"), ("gravity_torques[1]", "The Coriolis matrix is g2 = m2*g*l2*c12"),
        ("jacobian", "{}^2J = {J}"), ("jacobian", "J^T = {J}"), ("jacobian", "J_b = {J}"), ("jacobian", "{}^EJ = {J}"),
        ("jacobian_tool", "{}^0J = [l1*s2, 0; l1*c2 + l2, l2]"),
    ],
)  # fmt: skip
def test_what_says_that_it_is_another_quantity_is_refused(quantity, text):
    """Though the formula is right of what is asked for."""
    text = text.replace("{V}", "V = m1*g*l1*s1 + m2*g*(l1*s1 + l2*s12)")
    text = text.replace("{J}", "[-l1*s1-l2*s12, -l2*s12; l1*c1+l2*c12, l2*c12]")
    with pytest.raises(ExpressionError):
        kl.diagnose("planar2r", quantity, text)


def test_the_same_of_what_is_asked_for_is_right():
    for quantity, text in (
        ("potential_energy", "Potential energy: V = m1*g*l1*s1 + m2*g*(l1*s1 + l2*s12)"),
        ("gravity_torques[1]", "By the potential energy, g2 = m2*g*l2*c12"),
        ("jacobian", "{}^0J = [-l1*s1-l2*s12, -l2*s12; l1*c1+l2*c12, l2*c12]"),
        ("jacobian_tool", "{}^2J = [l1*s2, 0; l1*c2 + l2, l2]"),
    ):
        found = kl.diagnose("planar2r", quantity, text)
        assert found.agrees
        if "J" in text:
            assert found.function.count(",") >= 3  # all that is right is told


@pytest.mark.parametrize(
    "words",
    ["The slide moves downwards, hence", "Der Schieber bewegt sich nach unten, deshalb", "滑块向下移动，因此"],
)  # fmt: skip
def test_which_way_the_only_slide_moves_is_held_against_the_arm(words):
    up = words.replace("downwards", "upwards").replace("unten", "oben").replace("下", "上")
    for formula, agrees in (("d_1 - d_3", True), ("d_1 + d_3", False)):
        assert kl.diagnose("scara", "z", f"{words} $z = {formula}$.").agrees is agrees
        with pytest.raises(ExpressionError, match="not so of this robot"):
            kl.diagnose("scara", "z", f"{up} $z = {formula}$.")


def test_a_full_stop_behind_the_dollars_is_none_of_the_formula():
    found = kl.diagnose("planar2r", "g2", f"Gravity acts downwards, hence ${G2}$.")
    assert found.agrees, found


def test_nothing_in_braces_behind_a_sign_of_equality():
    """As LaTeX has it in front of the first of several lines."""
    given = "with $h_2 = m_2 l_1 l_2 \\sin q_2$:\n\n"
    text = "\\begin{align}\nc_1 = {} & -h_2 \\dot q_2^2 \\\\\n & - 2 h_2 \\dot q_1 \\dot q_2\n\\end{align}"
    for front in ("", given):
        right = text if front else text.replace("h_2", "m_2 l_1 l_2 \\sin q_2")
        assert kl.diagnose("planar2r", "c1", front + right).agrees
        wrong = kl.diagnose("planar2r", "c1", front + right.replace("- 2 ", "- "))
        assert "should be 2" in wrong.sentence, wrong


def test_numbers_that_were_worked_out_lose_no_sign():
    text = "T = ½·I₁·q̇₁² + ½·m₁·(l₁/2)²·q̇₁² = (0.075 + 0.225)·q̇₁²"
    found = kl.diagnose("single_link", "T", text)
    assert found.causes[0].kinds == ("factor",) and "/2" in found.sentence, found
