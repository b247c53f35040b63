r"""Definitions for every joint, ``c_i = \cos\theta_i``; prompts of shells; rows line by line."""

import numpy as np
import pytest

import kinlab as kl
from kinlab.errors import ExpressionError
from kinlab.formulas.handed.code import without_prompts
from kinlab.formulas.handed.general import for_each_joint

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
        ("In [2]: simplify(T)\nOut[2]: 2*x", "2*x"),
        (">>> print(T)\n2*x", "2*x"),
        (">>> c = 2\n>>> T = c*x", "c = 2\nT = c*x"),
        (">> T\n\nT =\n\n2*x", "T =\n2*x"),
        ("In[1]:= Simplify[T]\nOut[1]//InputForm= 2*x", "2*x"),
        ("print(sp.simplify(T))\n2*x", "2*x"),
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
