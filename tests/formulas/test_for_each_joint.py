r"""Definitions for every joint, ``c_i = \cos\theta_i``; prompts of shells; rows line by line."""

import numpy as np
import pytest

import kinlab as kl
from kinlab.errors import ExpressionError, KinlabError
from kinlab.formulas.handed.code import without_prompts
from kinlab.formulas.signs.general import for_each_joint

_X = "x = l1*c1 + l2*c12 + l3*c123"


def _agrees(robot: str, quantity: str, text: str) -> bool:
    return kl.diagnose(robot, quantity, text, samples=10).agrees


@pytest.mark.parametrize(
    ("typed", "plain"),
    [
        ("a*c1 + c2, ci = cos qi", "a*c1 + c2, c1 = cos q1, c2 = cos q2"),
        ("c12 with c_ij = cos(q_i+q_j)", "c12 with c_12 = cos(q_1+q_2)"),
        (
            r"$s_{23}$, $s_{ij}=\sin(\theta_i+\theta_j)$",
            r"$s_{23}$, $s_{23} = \sin(\theta_2+\theta_3)$",
        ),
        ("l_{c2} with l_{ci} = l_i/2, i = 1, ..., n", "l_{c2} with l_{c2} = l_2/2,"),
        (
            r"s_{12} + s_1, s_{ij\ldots} = \sin(q_i+q_j+\ldots)",
            r"s_{12} + s_1, s_{12} = \sin(q_1+q_2), s_1 = \sin(q_1)",
        ),
        ("phi = q1 + q2", "phi = q1 + q2"),
        ("M_ij = M_ji", "M_ij = M_ji"),
        ("c1*q2, c_i = 3", "c1*q2, c_i = 3"),
    ],
)
def test_a_definition_for_every_joint_is_that_of_each(typed: str, plain: str) -> None:
    assert for_each_joint(typed) == plain


@pytest.mark.parametrize(
    "behind",
    [
        " (ci = cos qi, cij = cos(qi+qj), cijk = cos(qi+qj+qk))",
        ", where c_i = cos(theta_i), c_ij = cos(theta_i+theta_j), c_ijk = cos(theta_i+theta_j+theta_k)",
        " [c1 = cos q1, c12 = cos(q1+q2), c123 = cos(q1+q2+q3)]",
        " with c_{ij} = cos(q_i + q_j) and c_i = cos(q_i)",
    ],
)
def test_what_everybody_calls_so_may_be_explained(behind: str) -> None:
    assert _agrees("planar3r", "fk[0,3]", _X + behind)


@pytest.mark.parametrize(
    ("behind", "told"),
    [
        (" (ci = sin qi)", "c1"),
        (", where c_ij = cos(theta_i - theta_j)", "c12"),
        (" with c_{ijk} = cos(q_i + q_j - q_k)", "c123"),
        (" (c12 = cos(q2))", "c12"),
    ],
)
def test_what_nobody_calls_so_is_wrong(behind: str, told: str) -> None:
    found = kl.diagnose("planar3r", "fk[0,3]", _X + behind, samples=10)
    assert not found.agrees
    assert f"{told}: " in str(found)


@pytest.mark.parametrize(("share", "right"), [(12, True), (3, False)])
def test_moments_of_every_link(share: int, right: bool) -> None:
    text = f"M22 = m2*lc2^2 + I2, where l_ci = l_i/2 and I_i = m_i*l_i^2/{share}"
    assert _agrees("planar2r_rods", "mass_matrix[1,1]", text) is right


@pytest.mark.parametrize(
    ("typed", "plain"),
    [
        ("Out[3]: 2*x", "2*x"),
        ("In [2]: simplify(T)\nOut[2]: 2*x", "T = 2*x"),
        (">>> print(T)\n2*x", "T = 2*x"),
        (">>> c = 2\n>>> T = c*x", "c = 2\nT = c*x"),
        (">> T\n\nT =\n\n2*x", "T =\n2*x"),
        ("In[1]:= Simplify[T[[1, 2]]]\nOut[1]//InputForm= 2*x", "T(1,2) = 2*x"),
        ("In [1]: M[0, 1]\nOut[1]: 2*x", "M(1,2) = 2*x"),
        (">>> a + b\n2*x", "2*x"),
        (">>> T  # wrong\n2*x", "# wrong\nT = 2*x"),
        (">> G(2)\nans = 2*x", "G(2) = 2*x"),
        ("print(sp.simplify(T))\n2*x", "T = 2*x"),
        ("a > b", "a > b"),
        ("print(x)", "print(x)"),
    ],
)
def test_prompts_are_left_out(typed: str, plain: str) -> None:
    assert without_prompts(typed) == plain


def test_a_matrix_row_by_row() -> None:
    assert _agrees(
        "planar2r",
        "planar_jacobian",
        "J =\n[-l1*s1 - l2*s12, -l2*s12]\n[l1*c1 + l2*c12, l2*c12]\n[1, 1]",
    )
    assert not _agrees(
        "planar2r", "planar_jacobian", "[-l1*s1 - l2*s12, -l2*s12]\n[l1*c1, l2*c12]\n[1, 1]"
    )


@pytest.mark.parametrize("frame", ["{}^3", "^2", "{}^{3}", "{}^{E}"])
def test_the_tool_s_jacobian_in_its_own_frame(frame: str) -> None:
    assert _agrees("planar2r", "jacobian_tool[0,0]", f"{frame}J_{{11}} = l_1 s_2")


@pytest.mark.parametrize("frame", ["{}^0", "{}^1", "{}^4"])
def test_the_tool_s_jacobian_in_another_frame_is_another(frame: str) -> None:
    with pytest.raises(ExpressionError, match="is another"):
        _agrees("planar2r", "jacobian_tool[0,0]", f"{frame}J_{{11}} = l_1 s_2")


def test_the_angle_of_a_planar_pose_is_named() -> None:
    found = kl.diagnose(
        "planar2r", "planar_pose", "[l1*c1 + l2*c12; l1*s1 + l2*s12; q2]", samples=10
    )
    assert not found.agrees
    assert "cos(phi): cos(q2) should be cos(q1 + q2)" in str(found)


def test_capitals_of_an_arm_of_one_link() -> None:
    assert _agrees("single_link", "gravity_torques", "M*g*L*cos(q)/2")
    assert not _agrees("single_link", "gravity_torques", "M*g*L*cos(q)")


def test_a_dot_apart_from_its_letter() -> None:
    text = "K = 1/6 m l^2 \u03b8 \u0307^2"
    assert _agrees("single_link", "kinetic_energy", text)
    assert not _agrees("single_link", "kinetic_energy", text.replace("6", "3"))


def test_many_definitions_do_not_keep_the_doctor() -> None:
    """Forty definitions in a chain: what is tried has a bound, and the slip is told all the same."""
    chain = "; ".join(["a0 = q1 + q2", *(f"a{k} = a{k - 1}*1" for k in range(1, 40))])
    text = f"g1 = (m1+m2)*g*l1*cos(q1) - m2*l2*g*cos(a39); where {chain}"
    found = kl.diagnose("planar2r", "gravity_torques[0]", text, samples=10)
    assert "- m2*l2*g*cos(a39) should be + m2*l2*g*cos(a39)" in str(found)
    assert np.isfinite(found.error_before)


@pytest.mark.parametrize("sign", ["#", "%", "//"])
@pytest.mark.parametrize(("minus", "right"), [("+", True), ("-", False)])
def test_what_a_comment_gives_a_name_counts(sign: str, minus: str, right: bool) -> None:
    """``# c12 = cos(q1 - q2)`` had agreed: what stands in comments was left out."""
    behind = f"x = l1*c1 + l2*c12;   {sign} c12 = cos(q1{minus}q2)"
    before = f"{sign} c1 = cos(q1), c12 = cos(q1{minus}q2) etc.\nx = l1*c1 + l2*c12;"
    for text in (behind, before):
        assert _agrees("planar2r", "fk[0,3]", text) is right


@pytest.mark.parametrize("sign", ["#", "%"])
def test_another_equation_in_a_comment_says_nothing(sign: str) -> None:
    assert _agrees("planar2r", "fk[0,3]", f"x = l1*c1 + l2*c12 {sign} T = T1*T2")


def test_christoffel_s_symbols_are_no_cosines() -> None:
    text = "c21 = c211*qd1 + c221*qd2 = m2*l1*lc2*sin(q2)*qd1"
    assert _agrees("planar2r_rods", "coriolis_matrix[1,0]", text)
    with pytest.raises(KinlabError, match="c211"):
        _agrees("planar2r_rods", "coriolis_matrix[1,0]", text.rpartition(" = ")[0])


def test_a_part_of_a_chain_that_is_no_arithmetic() -> None:
    text = "y = Im(l1*e^(i*q1) + l2*e^(i*(q1+q2))) = l1*sin(q1) + l2*sin(q1+q2)"
    found = kl.diagnose("planar2r", "fk[1,3]", text, samples=10)
    assert found.agrees
    assert "was not judged" in str(found)
    wrong = kl.diagnose("planar2r", "fk[1,3]", text.replace("sin(q1)", "cos(q1)"), samples=10)
    assert "cos(q1) should be sin(q1)" in wrong.causes[0].sentence
    assert "was not judged" in str(wrong)
    with pytest.raises(KinlabError, match="not a number"):  # nobody knows why it is wrong
        _agrees(
            "planar2r",
            "fk[1,3]",
            text.replace("= l1*sin(q1) + l2*sin(q1+q2)", "= 0.31*q1^3/(1 + q2^2)"),
        )


@pytest.mark.parametrize(
    ("behind", "right"),
    [
        (r"$x=u c_1+w c_{12}$, with $u=0.5$ m, $w=0.4$ m.", True),
        (r"$x=u c_1+w c_{12}$, avec $u=0.5$ et $w=0.4$", True),
        (r"$x=u c_1+w c_{12}$, con $u=500$ mm y $w=400$ mm", True),
        (r"$x=u c_1+w c_{12}$, with $u=0.5$ m, $w=0.3$ m.", False),
        ("x = A + B, donde A = l1*cos(q1) y B = l2*cos(q1+q2)", True),
        ("x = A + B, donde A = l1*cos(q1) y B = l2*cos(q2)", False),
        ("x = A + B, где A = l1*cos(q1) и B = l2*cos(q1+q2)", True),
        ("Координата схвата: x = l1*cos(q1) + l2*cos(q1+q2)", True),
    ],
)
def test_explained_in_other_languages(behind: str, right: bool) -> None:
    assert _agrees("planar2r", "fk[0,3]", behind) is right


@pytest.mark.parametrize(
    "behind",
    [
        "но это неверно",
        "углы от вертикали",
        "which I computed for an arm whose second joint is prismatic",
        "gravity acts along +y in my drawing",
        "a rough estimate",
    ],
)
def test_what_denies_it_is_refused(behind: str) -> None:
    with pytest.raises(ExpressionError, match="beside the formula"):
        _agrees("planar2r", "fk[0,3]", f"x = l1*cos(q1) + l2*cos(q1+q2), {behind}")


@pytest.mark.parametrize(
    ("quantity", "left", "right"),
    [("kinetic_energy", "with v = dq/dt:\n", "v"), ("kinetic_energy", "ω_i = dq_i/dt;", "ω"),
     ("kinetic_energy", "w = qd;", "w")],
)  # fmt: skip
def test_a_vector_that_is_the_rates(quantity: str, left: str, right: str) -> None:
    v = right
    text = (
        f"1/2*(m1+m2)*l1^2*{v}1^2 + 1/2*m2*l2^2*({v}1+{v}2)^2 + m2*l1*l2*cos(q2)*{v}1*({v}1+{v}2)"
    )
    assert _agrees("planar2r", quantity, f"{left} T = {text}")


@pytest.mark.parametrize(
    ("place", "entry"), [("(2,3)", "jacobian[4,2]"), ("(3,1)", "jacobian[5,0]")]
)
def test_the_angular_part_of_a_jacobian_by_its_places(place: str, entry: str) -> None:
    told = {"jacobian[4,2]": "-cos(q1+q2)", "jacobian[5,0]": "1"}[entry]
    assert _agrees("spatial3r", entry, f"Jw{place} = {told}")


@pytest.mark.parametrize(
    ("robot", "quantity", "text"),
    [
        ("planar2r", "fk[0,3]", ">>> y\nl1*c1 + l2*c12"),
        ("planar2r", "fk[0,3]", ">>> x  # wrong sign\nl1*c1 + l2*c12"),
        ("planar2r", "fk[0,3]", "x = l1*c1 + l2*c12  # c12 = cos(q1+q2), but the sign is wrong"),
        ("planar2r", "gravity_torques[0]", ">> G(2)\nans = (m1+m2)*g*l1*c1 + m2*g*l2*c12"),
        ("planar2r", "gravity_torques[0]", "In [1]: G[1]\nOut[1]: (m1+m2)*g*l1*c1 + m2*g*l2*c12"),
    ],
)
def test_what_a_shell_was_asked_counts(robot: str, quantity: str, text: str) -> None:
    with pytest.raises(ExpressionError):
        _agrees(robot, quantity, text)


@pytest.mark.parametrize(
    ("quantity", "front"),
    [
        ("kinetic_energy", "Energía potencial: "),
        ("kinetic_energy", "Energia potenziale: "),
        ("kinetic_energy", "La matriz de inercia es "),
        ("kinetic_energy", "慣性行列 "),
        ("kinetic_energy", "トルクは "),
        ("fk[0,3]", "トルクは "),
        ("fk[0,3]", "Velocidad: "),
        ("gravity_torques[0]", "Par de la segunda articulación: "),
        ("gravity_torques[0]", "Energía cinética: "),
        ("fk[0,3]", "acceleration: "),
        ("fk[0,3]", "加速度 "),
        ("kinetic_energy", "joint acceleration "),
    ],
)
def test_what_another_quantity_is_called_is_not_passed_over(quantity: str, front: str) -> None:
    """These had been words that say nothing, beside any entry."""
    rates = "1/2*m2*l2^2*(qd1+qd2)^2 + m2*l1*l2*cos(q2)*qd1*(qd1+qd2)"
    text = {
        "kinetic_energy": f"K = 1/2*(m1+m2)*l1^2*qd1^2 + {rates}",
        "fk[0,3]": "x = l1*c1 + l2*c12",
        "gravity_torques[0]": "g1 = (m1+m2)*g*l1*c1 + m2*g*l2*c12",
    }[quantity]
    try:
        found = kl.diagnose("planar2r", quantity, front + text, samples=10)
    except ExpressionError:
        return
    assert any("were not read" in one for one in found.remarks)


@pytest.mark.parametrize(
    ("quantity", "text"),
    [
        ("mass_matrix[1,1]", "慣性行列の(2,2)成分: M22 = m2*l2"),
        ("mass_matrix[1,1]", "Elemento de la matriz de inercia: M22 = m2*l2"),
        (
            "potential_energy",
            "Energía potencial: V = m1*g*l1*sin(q1) + m2*g*l1*sin(q1) - m2*g*l2*sin(q1+q2)",
        ),
    ],
)
def test_what_the_entry_is_called_keeps_no_slip_from_being_told(quantity: str, text: str) -> None:
    assert kl.diagnose("planar2r", quantity, text, samples=10).causes


def test_a_remark_on_a_definition_in_front_is_passed_over() -> None:
    rows = r"\begin{pmatrix} h\dot q_2 & h(\dot q_1 + \dot q_2) \\ %sh\dot q_1 & 0 \end{pmatrix}"
    front = "With h = -m_2 l_1 l_{c2} \\sin q_2 (Spong's Christoffel symbols):\nC = "
    assert _agrees("planar2r_rods", "coriolis_matrix", front + rows % "-")
    assert not _agrees("planar2r_rods", "coriolis_matrix", front + rows % "")
    with pytest.raises(ExpressionError):
        front = front.replace("Spong's Christoffel symbols", "this is Spong's, without the sign")
        _agrees("planar2r_rods", "coriolis_matrix", front + rows % "-")


@pytest.mark.parametrize("rate", ["d3dd", "d3_ddot", "d3ddot", "ddd3"])
def test_the_acceleration_of_a_slide(rate: str) -> None:
    assert _agrees("scara", "inverse_dynamics[2]", f"F3 = (m3 + m4 + 2.0)*{rate} - (m3 + m4)*g")


@pytest.mark.parametrize(
    "words",
    [
        "-- hold on, that is another coordinate of the tool",
        ", that is the height of the tool, not x",
        " (of ours the sign is the other one)",
        ". This is the part of the first two links, that of the third comes on top.",
        ", in millijoule",
        " (in Newtonmillimeter)",
        ", in newton millimetres",
    ],
)
def test_second_thoughts_behind_a_formula_are_heard(words: str) -> None:
    with pytest.raises(ExpressionError):
        _agrees("planar3r", "fk[0,3]", "x = l1*c1 + l2*c12 + l3*c123" + words)


@pytest.mark.parametrize(
    ("robot", "quantity", "text", "mended"),
    [
        ("single_link", "forward_dynamics[0]", "qdd = (tau - m*g*lc*cos(q))/I + m*lc^2", "(I + m*lc^2)"),
        ("planar2r", "potential_energy", "V = m1*g*l1*s1 + m2*g*l1*s1 + l2*s12", "m2*g*(l1*s1 + l2*s12)"),
        ("planar2r", "potential_energy", "V = m_1 g l_1 s_1 + m_2 g l_1 s_1 + l_2 s_{12}",
         "m_2 g (l_1 s_1 + l_2 s_{12})"),
    ],
)  # fmt: skip
def test_lost_parentheses_are_one_slip(robot: str, quantity: str, text: str, mended: str) -> None:
    found = kl.diagnose(robot, quantity, text, samples=20)
    assert found.causes[0].kinds == ("parentheses",)
    assert mended in str(found)


def test_what_stands_in_parentheses_already_is_in_no_others() -> None:
    text = "V = (m1*g*l1*s1 + m2*g*l1*s1) + l2*s12"
    found = kl.diagnose("planar2r", "potential_energy", text, samples=20)
    assert found.causes[0].kinds == ("missing factor", "missing factor")


def test_of_one_factor_it_is_missing_in_the_other_term() -> None:
    text = "M12 = I2 + m2*lc2^2 + l1*lc2*c2"
    found = kl.diagnose("planar2r_rods", "mass_matrix[0,1]", text, samples=20)
    assert found.causes[0].kinds == ("missing factor",)
