"""Short texts of which more than the arm's own numbers must be asked; centres, rates, statics."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest

import kinlab as kl
from kinlab.doctor.file import examine_file


@pytest.mark.parametrize(
    ("robot", "entry", "typed"),
    [
        # l3/4 is l3**2, and l3/2 is where the centre is, of this arm alone
        ("planar3r", "M23", "I3 + m3*l3/4 + m3*l2*l3*cos(q3)"),
    ],
)  # fmt: skip
def test_no_reading_that_holds_for_one_arm_alone_is_told(robot, entry, typed) -> None:
    found = kl.diagnose(robot, entry, typed)
    assert not found.agrees
    assert all("the formula" not in cause.sentence for cause in found.causes)


@pytest.mark.parametrize(
    ("robot", "entry", "typed", "told"),
    [
        ("planar2r", "jacobian", "[[l1*s1 + l2*s12, l2*s12], [-l1*c1 - l2*c12, -l2*c12], [0, 0], [0, 0], [0, 0], [-1, -1]]", "opposite sign"),
        ("planar2r", "M", "[[m2*l2**2, m2*l2**2 + m2*l1*l2*c2], [m2*l2**2 + m2*l1*l2*c2, m1*l1**2 + m2*l1**2 + m2*l2**2 + 2*m2*l1*l2*c2]]", "the formula"),
    ],
)  # fmt: skip
def test_a_reading_that_holds_for_every_arm_is_told(robot, entry, typed, told) -> None:
    found = kl.diagnose(robot, entry, typed)
    assert told in found.causes[0].sentence, str(found)


@pytest.mark.parametrize(
    ("robot", "entry", "typed", "told"),
    [
        ("planar3r", "com_positions[2,1]", r"l_1 \cos\theta_1 + l_2 \sin\theta_{12} + \frac{1}{2} l_3 \sin\theta_{123}", r"\cos\theta_1 should be \sin\theta_1"),
        ("planar2r_rods", "com_positions[1,0]", "l1*cos(θ₁) + (l2/2)*cos(θ₂)", "cos(θ₂) should be cos(θ₁ + θ₂)"),
        ("planar2r", "jacobian_dot[0,0]", "-l1*c1*qd1 - l2*s12*(qd1 + qd2)", "s12 should be c12"),
        ("planar2r", "lagrange_torques[1]", "m2*l2**2*(qdd1 + qdd2) + m2*l1*l2*c2*qdd1 - m2*l1*l2*s2*qd1**2 + m2*l2*g*c12", "(sign)"),
        ("scara", "T21", r"\sin(q_1+q_2+q_4)", r"should be \sin(q_1+q_2-q_4)"),
        ("planar2r_rods", "M22", "1/12*m2*l2**2", "12 should be 3"),
        ("puma560", "g5", "-m6*g*cz6*sin(q2+q3)*cos(q5) - m6*g*cz6*cos(q2+q3)*sin(q5)", "the factor cos(q4) is missing"),
        ("planar2r", "statics", "tau = [(-l1*s1 - l2*s12)*fx + (l1*c1 + l2*c12)*fy; -l2*s12*fx + l2*c12*fy + nz]", "the term nz is missing"),
    ],
)  # fmt: skip
def test_a_slip_in_a_text_is_told(robot, entry, typed, told) -> None:
    found = kl.diagnose(robot, entry, typed)
    assert len(found.causes[0].kinds) == 1
    assert told in found.causes[0].sentence, str(found)


H = "; C = [[-h*qd2, -h*(qd1 + qd2)], [h*qd1, 0]]"


@pytest.mark.parametrize(
    ("typed", "told"),
    [
        ("h = m2*l1*l1*sin(q2)" + H, ["h: l1 should be l2 in m2*l1*l1*sin(q2)"]),
        ("h = m2*l1*sin(q2)" + H, ["h: the factor l2 is missing"]),
        ("h = m2*l1*l2*cos(q2)" + H, ["h: cos(q2) should be sin(q2)"]),
        ("h = m2*l1*l1*sin(q2)" + H.replace("[h", "[-h"), ["h: l1 should be l2", "C21: -h*qd1 should be h*qd1"]),
        ("h = m2*l1*l2*sin(q2)" + H.replace("[h", "[-h"), ["C21: -h*qd1 should be h*qd1"]),
    ],
)  # fmt: skip
def test_a_slip_in_what_a_name_stands_for_is_told_there(typed, told) -> None:
    cause = kl.diagnose("planar2r", "coriolis_matrix", typed).causes[0]
    assert len(cause.kinds) == len(told)
    assert all(one in cause.sentence for one in told), cause.sentence


@pytest.mark.parametrize(
    ("robot", "entry", "typed"),
    [
        ("planar3r", "com_positions[2,1]", "l1*s1 + l2*s12 + l3/2*s123"),
        ("planar2r", "jacobian_dot[0,0]", "-l1*c1*qd1 - l2*c12*(qd1 + qd2)"),
        ("planar2r", "statics", "tau = [(-l1*s1 - l2*s12)*fx + (l1*c1 + l2*c12)*fy + nz; -l2*s12*fx + l2*c12*fy + nz]"),
    ],
)  # fmt: skip
def test_right_texts_agree(robot, entry, typed) -> None:
    assert kl.diagnose(robot, entry, typed).agrees


def test_a_slide_is_told_for_a_length() -> None:
    links = [
        kl.DHLink(d=0.52, alpha=np.pi / 2),
        kl.DHLink(theta=np.pi / 2, alpha=np.pi / 2),
        kl.DHLink("prismatic", lower=0.3, upper=1.1),
    ]
    found = kl.diagnose(kl.DHTable("polar", "standard", links), "T14", "d1*cos(q1)*cos(q2)")
    assert "d1 should be q3" in found.causes[0].sentence


_OPENED = (
    "J11 = -l1*sin(q1) - l2*sin(q1+q2); J12 = -l2*sin({a}); "
    "J21 = l1*{b}(q1) + l2*cos(q1+q2); J22 = l2*cos(q1+q2); det = J11*J22 - J12*J21"
)


@pytest.mark.parametrize(
    ("robot", "entry", "typed", "told"),
    [
        # one in what b stands for, one beside it: b's is told there, and not in each line
        ("planar3r", "G", "a = m3*g*lc3*cos(q1+q2+q3)\nb = (m2*lc2 + m2*l2)*g*cos(q1+q2)\nG = [(m1*l1 + m2*l1 + m3*l1)*g*cos(q1) + b + a, b + a, a]",
         {"b": ["m2 should be m3"], "G1": ["l1 should be lc1"]}),
        # both in what names stand for, of which one is seen in the shortest line alone
        ("planar3r", "G", "a = m3*g*lc3*cos(q3)\nb = (m2*lc2 + m2*l2)*g*cos(q1+q2)\nG = [(m1*lc1 + m2*l1 + m3*l1)*g*cos(q1) + b + a, b + a, a]",
         {"a": ["cos(q3) should be cos(q1+q2+q3)"], "b": ["m2 should be m3"]}),
        ("planar2r", "det", _OPENED.format(a="q2", b="sin"), {"J12": ["sin(q2) should be sin(q1+q2)"], "J21": ["sin(q1) should be cos(q1)"]}),
    ],
)  # fmt: skip
def test_two_slips_of_which_some_are_in_what_names_stand_for(robot, entry, typed, told) -> None:
    found = kl.diagnose(robot, entry, typed)
    assert len(found.causes[0].kinds) == 2, str(found)
    assert {*found.causes[0].places} == {*told}
    for words in told.values():
        assert all(word in found.causes[0].sentence for word in words), str(found)


@pytest.mark.parametrize(
    ("robot", "entry", "typed", "told"),
    [
        # the force that nobody names is the one that stands there by another's name
        ("planar3r", "tau2", "tau2 = -(l2*s12 + l3*s123)*fx + (l2*c12 + l3*c123)*fx + nz", "fx should be fy"),
        ("planar2r", "tau2", "tau2 = -l2*s12*fx + l2*c12*fx", "fx should be fy"),
        # and one that is left out on purpose stays zero
        ("planar2r", "tau2", "tau2 = -l2*s12*fx - l2*c12*fy", "should be + l2*c12*fy"),
        ("planar2r", "tau2", "tau2 = l2*s12*fx", "should be -l2*s12*fx"),
    ],
)  # fmt: skip
def test_a_force_by_another_name_is_told_as_such(robot, entry, typed, told) -> None:
    cause = kl.diagnose(robot, entry, typed).causes[0]
    assert told in cause.sentence
    assert len(cause.kinds) == 1


_JV = "r = a2 + xt*c3; Jv = [[-a1*s1 - r*s12, {0}r*s12, -xt*c12*s3], [a1*c1 + r*c12, r*c12, -xt*s12*s3], [0, 0, xt*c3]]"  # fmt: skip


@pytest.mark.parametrize(
    ("robot", "entry", "typed", "quantity"),
    [
        ("planar2r", "det J", "det J = l1*l2*sin(q2)", "planar_position_determinant"),
        ("planar2r", "det", "det(J) = l1*l2*sin(q2)", "planar_position_determinant"),
        ("planar2r", "|J|", "l1*l2*sin(q2)", "planar_position_determinant"),
        ("planar3r", "det J", "det J = l1*l2*sin(q2)", "planar_determinant"),
        ("planar3r", "phi", r"\phi = \theta_1 + \theta_2 + \theta_3", "planar_angle"),
        ("planar3r", r"\phi_e", "atan2(s123, c123)", "planar_angle"),
        ("planar2r", "p_y", "p_y = l1*s1 + l2*s12", "fk[1,3]"),
        ("planar2r", "p2", "m2*l2*(l2*(qd1 + qd2) + l1*qd1*cos(q2))", "momentum[1]"),
        ("planar2r", "cv", "[-m2*l1*l2*sin(q2)*qd2*(2*qd1 + qd2); m2*l1*l2*sin(q2)*qd1^2]", "coriolis_torques"),
        ("planar2r", "t2", r"\tau_2 = l_2 c_{12} f_y - l_2 s_{12} f_x", "statics[1]"),
        ("spatial3r", "Jv", _JV.format("-"), "jacobian[:3]"),
        ("spatial3r", "Jw31", "1", "jacobian[5,0]"),
    ],
)  # fmt: skip
def test_names_of_quantities_as_people_type_them(robot, entry, typed, quantity) -> None:
    found = kl.diagnose(robot, entry, typed)
    assert (found.agrees, found.quantity) == (True, quantity)


def test_half_of_a_jacobian_is_judged_as_a_whole() -> None:
    found = kl.diagnose("spatial3r", "Jv", _JV.format("").replace("xt*c3]", "xt*s3]"))
    assert sorted(found.causes[0].places) == ["Jv12", "Jv33"]


@pytest.mark.parametrize(
    ("typed", "told", "right"),
    [
        ("q1 + q2", "the term q3 is missing", "q1 + q2 + q3"),
        ("q1 + q2 - q3", "- q3 should be + q3", "q1 + q2 + q3"),
        ("th1+th3", "the term th2 is missing", "th1+th3+th2"),
    ],
)
def test_the_angle_of_a_planar_tool_is_a_sum_of_joint_positions(typed, told, right) -> None:
    cause = kl.diagnose("planar3r", "phi", typed).causes[0]
    assert told in cause.sentence
    assert cause.shown["phi"] == right


def test_a_determinant_of_what_has_none_is_refused() -> None:
    with pytest.raises(kl.errors.StructureError, match="is for arms whose Jacobian is square"):
        kl.diagnose("panda", "det J", "1")


DETERMINANTS = {
    "spatial3r": "a1*xt*(a2 + xt*c3)*s2*c3",
    "scara": "l1*l2*sin(theta_2)",
    "stanford": "d3^2*s2*s5",
    "puma560": "a2*(a3*s3 + d4*c3)*(a2*c2 + a3*c23 - d4*s23)*s5",
    "ur5": "a2*a3*(a2*c2 + a3*c23 + d5*s234)*s3*s5",
}
"""det J of the first n rows that move, in factors: the books' and note 000's, by hand."""


@pytest.mark.parametrize("robot", DETERMINANTS)
def test_a_determinant_of_an_arm_in_space_is_judged_in_its_factors(robot: str) -> None:
    right = DETERMINANTS[robot]
    assert kl.diagnose(robot, "det J", right).agrees
    slipped = right.replace("s5", "c5").replace("sin(", "cos(")
    slipped = slipped.replace("s2*c3", "c2*c3")
    found = kl.diagnose(robot, "det J", slipped)
    assert not found.agrees and [*found.causes[0].shown.values()] == [right], str(found)


def test_what_moves_a_potentials_zero_is_no_slip_beside_one() -> None:
    cause = kl.diagnose("planar2r", "V", "m1*g*l1*sin(q1) + m2*g*(l1*sin(q1) + l2*sin(q2) + 1)")
    assert cause.causes[0].kinds == ("argument",), str(cause)
    assert "+ 1)" in cause.causes[0].corrected["V"]


def test_what_goes_with_a_rate_is_no_potentials_zero() -> None:
    found = kl.diagnose("single_link", "lagrangian", "1/2*(I1 + m1*l1^2/2)*qd1^2 - m1*g*l1*sin(q1)")
    assert len(found.causes[0].kinds) == 2, str(found)


def test_a_definition_that_another_line_needs_is_left_as_it_is() -> None:
    typed = "h = m2*l1*l2*cos(q2); C = [[h*qd2, -h*(qd1 + qd2)], [h*qd1, 0]]"
    cause = kl.diagnose("planar2r", "coriolis_matrix", typed).causes[0]
    assert sorted(cause.kinds) == ["sign", "sin/cos"], cause.sentence
    assert cause.corrected["h"] == "m2*l1*l2*sin(q2)"
    assert cause.corrected["coriolis_matrix[0,0]"] == "-h*qd2"


_BEHIND = """
name = "behind"
convention = "modified"
gravity = [0.0, -9.81, 0.0]
links = [
  {joint = "revolute", a = 0.0, alpha = 0.0, d = 0.0, theta = "pi/2", mass = 3.0, com = [0, -0.1, 0]},
  {joint = "revolute", a = 0.5, alpha = 0.0, d = 0.0, theta = 0.0, mass = 1.8, com = [-0.2, 0, 0]},
]
"""


@pytest.mark.parametrize("length", ["lc2", "r2"])
def test_a_length_may_be_a_distance_or_stand_along_its_axis(length, tmp_path) -> None:
    arm = tmp_path / "behind.toml"
    arm.write_text(_BEHIND)
    along = kl.diagnose(arm, "G2", f"-m2*g*{length}*sin(q1+q2)")
    away = kl.diagnose(arm, "G2", f"m2*g*{length}*sin(q1+q2)")
    assert along.agrees and not along.remarks
    assert away.agrees and away.remarks[0].startswith(f"{length} is a distance, 0.2 m")
    # neither of both
    assert not kl.diagnose(arm, "G2", f"m2*g*{length}*cos(q1+q2)").agrees
    # what the table itself calls so is with its sign
    assert not kl.diagnose(arm, "G2", "m2*g*cx2*sin(q1+q2)").agrees


def test_a_plus_in_front_gives_way_to_the_minus() -> None:
    (cause,) = kl.diagnose("planar2r", "J11", "+l1*s1 - l2*s12").causes[:1]
    assert "+l1*s1 should be -l1*s1" in cause.sentence
    assert cause.shown == {"J11": "-l1*s1 - l2*s12"}


def test_of_distances_those_of_the_formula_are_told(tmp_path) -> None:
    arm, sheet = tmp_path / "behind.toml", tmp_path / "two.toml"
    arm.write_text(_BEHIND)
    texts = 'G2 = "m2*g*lc2*sin(q1+q2)"\nM11 = "m1*lc1**2"'
    sheet.write_text(f"robot = {str(arm)!r}\n[formulas]\n{texts}\n")
    found = {one.function: one for one in examine_file(sheet)}
    assert [told.partition(" ")[0] for told in found["G2"].remarks] == ["lc2"]
    assert not found["M11"].agrees


@pytest.mark.parametrize(
    ("robot", "entry", "typed", "told", "right"),
    [
        (
            "planar2r",
            "g2",
            r"m_2 g l_1 \sin(90^\circ - \theta_1 - \theta_2)",
            "l_1 should be l_2",
            r"m_2 g l_2 \sin(90^\circ - \theta_1 - \theta_2)",
        ),
        (
            "planar2r",
            "M22",
            r"\frac{1}{2} m_2 l_2^2",
            r"the factor \frac{1}{2} does not belong",
            "m_2 l_2^2",
        ),
        (
            "isotropic",
            "T_max1",
            r"(G_{11}^2 + G_{12}^2) a_{\max}",
            r"should be \sqrt{G_{11}^2 + G_{12}^2}",
            r"\sqrt{G_{11}^2 + G_{12}^2} a_{\max}",
        ),
        (
            "isotropic",
            "T_max1",
            "(G11^2 + G12^2)*a_max",
            "should be sqrt(G11^2 + G12^2)",
            "sqrt(G11^2 + G12^2)*a_max",
        ),
    ],
)
def test_a_corrected_formula_is_typed_as_its_writer_does(robot, entry, typed, told, right) -> None:
    cause = kl.diagnose(robot, entry, typed).causes[0]
    assert told in cause.sentence
    assert cause.shown[entry] == right


def test_a_halved_term_is_none_that_is_missing_twice() -> None:
    typed = r"\frac{I_{3}}{2} + \frac{l_1 l_3 m_3 c_{23}}{2} + \frac{l_2 l_3 m_3 c_3}{2} + \frac{l_3^2 m_3}{4}"
    cause = kl.diagnose("planar3r", "M13", typed).causes[0]
    assert r"/{2} does not belong in \frac{I_{3}}{2}" in cause.sentence
    assert cause.shown["M13"].startswith("I_{3} + ")


@pytest.mark.parametrize("entry", ["phi", "det J"])
@pytest.mark.parametrize("name", ["planar2r", "planar3r"])
def test_what_is_in_the_plane_of_x_and_y_is_not_judged_of_an_arm_that_stands(name, entry) -> None:
    base = np.array([[1, 0, 0, 0], [0, 0, -1, 0], [0, 1, 0, 0], [0, 0, 0, 1.0]])
    table = replace(kl.load(name).table, name="standing", base=base, gravity=(0.0, 0.0, -9.81))
    with pytest.raises(kl.errors.ExpressionError, match="names no quantity"):
        kl.diagnose(kl.Robot.from_dh(table), entry, "q1 + q2")


@pytest.mark.parametrize("typed", [r"l_1 c_1 + l_2 c_{1,2}", r"l_1 c_1 + l_2 \cos\theta_{1,2}"])
def test_a_comma_between_two_joints_is_refused(typed) -> None:
    with pytest.raises(kl.errors.ExpressionError, match="in a subscript"):
        kl.diagnose("planar2r", "x", typed)


def test_a_moment_is_missing_where_others_are_named_and_no_rods_quarter_is_a_third() -> None:
    """m l²/4 + m l²/12 is m l²/3 of this arm's rods alone."""
    typed = (
        "I1 + I2 + 1/4*m1*l1^2 + m2*(l1^2 + 1/4*l2^2 + l1*l2*c2) "
        "+ m3*(l1^2 + l2^2 + 1/4*l3^2 + l1*l2*c2 + l1*l3*c2 + l2*l3*c3)"
    )
    cause = kl.diagnose("planar3r", "M11", typed).causes[0]
    assert "the term I3 is missing" in cause.sentence and "should be 3" not in cause.sentence


@pytest.mark.parametrize("angle", ["q3", "q2"])
def test_no_slip_is_told_that_leaves_nothing_of_its_term(angle: str) -> None:
    """qd2 - qd2 with the whole term put behind it is no repair of qd1 - qd2."""
    length = "l1" if angle == "q3" else "l3"
    found = kl.diagnose("planar3r", "C32", f"l2*{length}*m3*(qd1 - qd2)*sin({angle})/2")
    assert "- qd2 should be + qd2" in found.causes[0].sentence, str(found)
    assert "missing" not in found.causes[0].sentence


def test_a_formula_is_not_written_anew():
    """Of three slips in a product, none is told where what is left would be nothing."""
    wrong = "xt*(a2 - xt*cos(q3))*cos(q2)*cos(q3)"  # a1*xt*(a2 + xt*cos(q3))*sin(q2)*cos(q3)
    found = kl.diagnose("spatial3r", "jacobian_determinant", wrong)
    assert not found.agrees
    assert not any("is missing" in cause.sentence for cause in found.causes), found


def test_a_share_in_brackets_that_lost_its_square():
    found = kl.diagnose("single_link", "kinetic_energy", "1/2*(I1 + m1*(l1/2))*qd1^2")
    (cause,) = found.causes
    assert cause.kinds == ("power",) and "(l1/2)^2" in cause.sentence, found


@pytest.mark.parametrize(
    "where",
    [r"where $c_{123}$ stands for $\cos\theta_3$", r"where $c_{123}$ denotes $\cos\theta_3$"],
)
def test_what_a_name_stands_for_is_a_definition(where):
    text = rf"x = l_1c_1 + l_2c_{{12}} + l_3c_{{123}}, {where}"
    found = kl.diagnose("planar3r", "x", text)
    (cause,) = found.causes
    assert cause.sentence.startswith("c123: "), found
    right = text.replace(r"\cos\theta_3", r"\cos(\theta_1+\theta_2+\theta_3)")
    assert kl.diagnose("planar3r", "x", right).agrees


def test_of_numbers_in_a_constant_none_is_called_wrong_by_its_value_alone():
    """Any of them could be the wrong one."""
    text = "2.5*0.5^2 + 1.5*0.4 + 2*1.5*0.5*0.4*cos(q2)"  # 3.5*0.5^2 + 1.5*0.4^2 + ...
    found = kl.diagnose("planar2r", "M11", text)
    assert not found.agrees
    assert not any("2.06" in cause.sentence for cause in found.causes), found
