"""Names that a writer explains beside his formula, in front of it or behind ``where``."""

from __future__ import annotations

import pytest

import kinlab as kl
from kinlab.errors import ExpressionError


def judged(entry: str, text: str, robot: str = "planar2r") -> kl.Diagnosis:
    return kl.diagnose(robot, entry, text)


def agrees(entry: str, text: str, robot: str = "planar2r") -> None:
    found = judged(entry, text, robot)
    assert found.agrees and found.function == entry, str(found)


H1, H2 = "h1 = l1*s1", "h2 = h1 + l2*s12"


@pytest.mark.parametrize(
    "text",
    [
        f"m1*g*h1 + m2*g*h2, where {H1}, {H2}",
        "m1 g h1 + m2 g h2; h1 = l1 s1; h2 = l1 s1 + l2 s12",
        f"{H1}; {H2}; m1*g*h1 + m2*g*h2",
        r"m_1 g h_1 + m_2 g h_2, \text{ where } h_1 = l_1 s_1, h_2 = l_1 s_1 + l_2 s_{12}",
        "m₁gh₁ + m₂gh₂; h₁ = l₁s₁; h₂ = l₁s₁ + l₂sin(θ₁+θ₂)",
    ],
)
def test_a_formula_without_a_left_side_is_what_is_asked_for(text):
    agrees("V", text)


def test_what_is_wrong_in_such_a_formula_is_told():
    found = judged("V", "m1*g*h1 + m2*g*h2, where h1 = l1*s1, h2 = h1 + l2*s2")
    assert (found.agrees, found.function) == (False, "V")
    assert "h2: s2 should be s12" in str(found)


def test_entries_of_a_vector_are_judged_as_before():
    g1, g2 = "(m1+m2)*g*l1*c1 + m2*g*l2*c12", "m2*g*l2*c12"
    assert judged("g", f"g1 = {g1}; g2 = {g2}; [g1; g2]").agrees
    h = "m2*l1*l2*s2"
    assert judged("V", f"V1 = -{h}*(2*qd1*qd2 + qd2^2); V2 = {h}*qd1^2").agrees


# -------- Names with an underscore

P1, P3 = "(m1+m2)*l1^2 + m2*l2^2", "m2*l1*l2"


@pytest.mark.parametrize(
    ("entry", "text"),
    [
        ("M11", "p_1 = 1.115; p_3 = 0.3; M11 = p_1 + 2 p_3 c_2"),
        ("M11", f"p_1 = {P1}; p_3 = {P3}; M_11 = p_1 + 2*p_3*cos(q_2)"),
        ("M11", rf"\pi_1 = {P1}; \pi_{{2}} = m_2 l_1 l_2; M_{{11}} = \pi_1 + 2 \pi_2 c_2"),
        ("M11", "π₁ = (m₁+m₂) l₁² + m₂ l₂²; π₂ = m₂ l₁ l₂; M₁₁ = π₁ + 2 π₂ cos θ₂"),
        ("V", "V_1 = m1*g*l1*s1; V_2 = m2*g*(l1*s1 + l2*s12); V = V_1 + V_2"),
        ("V", "V_1 = m1 g l1 s1; V_2 = m2 g (l1 s1 + l2 s12); V_1 + V_2"),
        ("V", "V_1 = m1*g*l1*s1; V_2 = V1/m1*m2 + m2*g*l2*s12; V = V_1 + V_2"),
        ("x", "l_1 = 0.5; x = l_1*c_1 + l_2*c_12"),
    ],
)
def test_a_name_with_an_underscore_that_is_explained(entry, text):
    agrees(entry, text)


def test_such_a_name_is_told_as_its_writer_has_it():
    text = "V_1 = m1*g*l1*s1; V_2 = m2*g*(l1*s1 + l2*s2); V = V_1 + V_2"
    assert "V_2: s2 should be s12 in l2*s2" in str(judged("V", text))
    assert not judged("M11", "p_1 = 1.115; p_3 = 0.35; M11 = p_1 + 2 p_3 c_2").agrees


@pytest.mark.parametrize(
    ("text", "said"),
    [
        ("V = V_1 + V_2", "'V_1' is unknown"),
        ("V_1 = m1*g*l1*s1; V = V_1 + V_2", "'V_2' is unknown"),
        (r"\pi_1 + \pi_2 \cos q_2", "'pi1' is unknown"),
        ("l_1 = 0.4; V = m1*g*l_1*s1", "l1 is 0.4"),
        ("V_1 = V_1 + m1; V = V_1", "'V_1' is unknown"),
    ],
)
def test_a_name_with_an_underscore_that_is_not_explained_is_refused(text, said):
    with pytest.raises(ExpressionError, match=said):
        judged("V", text)


# -------- How explanations are joined


@pytest.mark.parametrize(
    ("entry", "text"),
    [
        ("V", "m1 g h1 + m2 g h2, where h1 = l1 s1 and h2 = l1 s1 + l2 s12"),
        ("V", f"V = m1*g*h1 + m2*g*h2 with {H1}, and {H2}"),
        ("V", f"V = m1*g*h1 + m2*g*h2，其中 {H1} 和 {H2}"),
        ("M12", "k := m2 l2; M12 = k (l2 + l1 c2)"),
        ("M12", r"k \coloneqq m_2 l_2; M_{12} := k (l_2 + l_1 c_2)"),
    ],
)
def test_explanations_are_joined_by_words(entry, text):
    agrees(entry, text)


def test_what_is_wrong_behind_such_words_is_told():
    found = judged("V", "m1 g h1 + m2 g h2, where h1 = l1 s1 and h2 = l1 s1 - l2 s12")
    assert not found.agrees and found.function == "V"
    assert not judged("M12", "k := m2 l2; M12 = k (l2 + l1 s2)").agrees
    with pytest.raises(ExpressionError):
        judged("V", "m1 g h1 and m2 g h2")


# -------- L is a name of the writer's where he explains it

OF_SPATIAL = "a1*c1 + a2*c12 + L3*c12*c3"


@pytest.mark.parametrize(
    ("robot", "entry", "text"),
    [
        ("isotropic", "A1", "L = 0.3; A1 = 2*L*(e - x)"),
        ("isotropic", "A1", "A1 = 2*L*(e - x), where L = 0.3"),
        ("spatial3r", "x", f"L3 = 0.3; x = {OF_SPATIAL}"),
        ("spatial3r", "x", r"L_3 = 0.3; x = a_1 c_1 + a_2 c_{12} + L_3 c_{12} c_3"),
        ("spatial3r", "x", "L_1 = 0.45; L_3 = 0.3; x = L_1*c1 + a_2*c_12 + L_3*c_12*c3"),
        ("spatial3r", "x", "L3 = 0.3; x = L1*c1 + a2*c12 + L3*c12*c3"),
        ("planar2r", "V", "L = 0.5; V = m1*g*L*s1 + m2*g*(L*s1 + l2*s12)"),
    ],
)
def test_l_where_it_is_explained(robot, entry, text):
    agrees(entry, text, robot)
    assert not judged(entry, text.replace("0.3", "0.4").replace("m2*g", "m1*g"), robot).agrees


def test_l3_is_the_length_l3_of_an_arm_that_has_one():
    agrees("x", f"x = {OF_SPATIAL}", "spatial3r")
    assert not judged("x", "x = a1*c1 + a2*c12 + L3*c1*c3", "spatial3r").agrees
    assert not judged("x", "L3 = 0.4; x = a1*c1 + a2*c12 + L3*c12*c3", "spatial3r").agrees


@pytest.mark.parametrize(
    ("robot", "entry", "text", "said"),
    [
        ("isotropic", "A1", "A1 = 2*L*(e - x)", "'L' is unknown"),
        ("spatial3r", "x", "x = L1*c1 + a2*c12 + L4*c12*c3", "'L4' is unknown"),
        ("puma560", "x", "x = L3*c1", "'L3' is unknown"),
    ],
)
def test_l_where_it_is_not_explained_is_refused(robot, entry, text, said):
    with pytest.raises(ExpressionError, match=said):
        judged(entry, text, robot)


def test_the_lagrangian_is_an_entry_as_before():
    energies = "T = m1*l1^2*qd1^2/2; V = m1*g*l1*s1"
    assert judged("L", f"L = T - V; {energies}").function == "lagrangian"
    assert judged("V", "L = T - U; V = m1*g*l1*s1 + m2*g*(l1*s1 + l2*s12)").agrees


# -------- A square that is explained

V2 = "l1^2*qd1^2 + l2^2*(qd1+qd2)^2 + 2*l1*l2*c2*qd1*(qd1+qd2)"
V2_LATEX = (
    r"l_1^2 \dot q_1^2 + l_2^2(\dot q_1+\dot q_2)^2 + 2 l_1 l_2 c_2 \dot q_1(\dot q_1+\dot q_2)"
)
WHERE = rf", \quad \text{{where }} v_1 = l_1 \dot q_1, v_2^2 = {V2_LATEX}"


@pytest.mark.parametrize(
    "text",
    [
        f"v1 = l1*qd1; v2^2 = {V2}; T = m1*v1^2/2 + m2*v2^2/2",
        f"v_1**2 = l1^2*qd1^2; v_2**2 = {V2}; T = (m1*v_1**2 + m2*v_2**2)/2",
        rf"T = \frac12 m_1 v_1^2 + \frac12 m_2 v_2^2{WHERE}",
        rf"\frac12 m_1 v_1^2 + \frac12 m_2 v_2^{{2}}{WHERE}",
        "v₁² = l₁²θ̇₁²; v₂² = l₁²θ̇₁² + l₂²(θ̇₁+θ̇₂)² + 2l₁l₂cos(θ₂)θ̇₁(θ̇₁+θ̇₂); T = ½m₁v₁² + ½m₂v₂²",
        f"v2^2 = {V2}; T2 = m2*v2^2/2; T = m1*l1^2*qd1^2/2 + T2",
        f"v2^2 = {V2}; v2 = sqrt(v2^2); T = m1*l1^2*qd1^2/2 + m2*v2*v2/2",
    ],
)
def test_a_square_that_is_explained(text):
    agrees("T", text)


@pytest.mark.parametrize(
    ("text", "said"),
    [
        (f"v2^2 = {V2}; T = m1*l1^2*qd1^2/2 + m1*v2^2/2", "+ m2*v2^2/2"),
        (f"v2^2 = {V2.replace('c2', 's2')}; T = m1*l1^2*qd1^2/2 + m2*v2^2/2", "s2 should be c2"),
    ],
)
def test_what_is_wrong_with_such_a_square_is_told(text, said):
    found = judged("T", text)
    assert not found.agrees and said in str(found)


@pytest.mark.parametrize(
    ("text", "said"),
    [
        (f"v2^2 = {V2}; T = m1*l1^2*qd1^2/2 + m2*v2*v2/2", "v2 stands alone, and only v2\\^2"),
        (f"v2^2 = {V2}; T = m1*l1^2*qd1^2/2 + m2*v2^3/2", "v2 stands alone"),
        ("T = m2*v2^2/2", "'v2' is unknown"),
        ("c2^2 = 1 - s2^2; T = m1*c2^2", "T: "),
        ("q1^2 = m1; T = m1*q1^2", "T: "),
    ],
)
def test_a_name_of_which_only_the_square_is_explained_is_refused(text, said):
    with pytest.raises(ExpressionError, match=said):
        judged("T", text)


TWICE = {
    "semicolons": ("planar2r", "fk[0,3]", "a = l1*s1; b = l2*c12; a = l1*c1; T14 = a + b"),
    "with": ("planar2r", "M22", "M22 = a with a = m2*l2 and a = m2*l2^2"),
    "dollars": ("planar2r", "M22", "$M_{22} = a$ with $a = m_2 l_2$ and $a = m_2 l_2^2$"),
}


@pytest.mark.parametrize("case", TWICE.values(), ids=TWICE.keys())
def test_a_name_that_is_explained_twice_is_told(case):
    """The last one was taken without a word, and the first one, which is wrong, passed over."""
    found = kl.diagnose(*case)
    assert not found.agrees or "and no other step" in found.remarks[-1], found


def test_a_name_that_is_explained_twice_alike_is_judged():
    twice = "a = l1*c1; b = l2*c12; a = l1*cos(q1); x = a + b"
    found = kl.diagnose("planar2r", "x", twice)
    assert found.agrees and not found.remarks, found


def test_an_earlier_explanation_by_other_names_is_told():
    found = kl.diagnose(
        "planar2r",
        "T",
        "v2^2 = u^2 + w^2; v2^2 = l1^2*qd1^2 + l2^2*(qd1+qd2)^2 + 2*l1*l2*c2*qd1*(qd1+qd2); "
        "T = 1/2*m1*l1^2*qd1^2 + 1/2*m2*v2^2",
    )
    assert found.agrees and "v2^2" in "; ".join(found.remarks), found


def test_what_is_judged_is_not_said_to_be_passed_over():
    found = kl.diagnose("planar2r", "fk[0,3]", "x = a + b; a = l1*c1; b = l2*c12")
    assert found.agrees and not found.remarks, found
    found = kl.diagnose("planar2r", "fk[1,3]", "x = l1*c1 + l2*s12; y = l1*s1 + l2*s12")
    assert found.agrees and "x" in found.remarks[-1], found


@pytest.mark.parametrize(
    ("text", "told"),
    [
        (
            "v_1^2 = l1^2 qd1^2\nv_2^2 = l1^2 qd1^2 + l2^2 (qd1+qd2)^2 + 2 l1 l2 cos(q2) qd1 qd2\n"
            "T = 1/2 m1 v_1^2 + 1/2 m2 v_2^2",
            "v2^2: qd2 should be (qd1+qd2) in 2 l1 l2 cos(q2) qd1 qd2",
        ),
        (
            r"$T = 1/2 m_1 v_1^2 + 1/2 m_1 v_2^2$ with $v_1^2 = l_1^2 \dot q_1^2$, $v_2^2 = "
            r"l_1^2 \dot q_1^2 + l_2^2 (\dot q_1+\dot q_2)^2 + 2 l_1 l_2 \cos q_2 \dot q_1 (\dot q_1 + \dot q_2)$",
            "m_1 should be m_2 in 1/2 m_1 v_2^{2}",
        ),
    ],
    ids=["in it", "beside it"],
)  # fmt: skip
def test_a_square_that_is_explained_keeps_its_writers_name(text, told):
    found = kl.diagnose("planar2r", "T", text)
    assert told in found.sentence and "squared" not in str(found), found
