"""Sides of equations behind words, and of names that are explained: each is judged, or told."""

from __future__ import annotations

import pytest

import kinlab as kl
from kinlab.doctor.report import of_document
from kinlab.errors import ExpressionError

OWN = "m1*l1^2/12 + m1*l1^2/4"


@pytest.mark.parametrize(
    "between",
    [
        " (Steiner)\n", " (Steiner) ", " by Steiner\n", " by the parallel axis theorem\n", " (parallel axis theorem)\n",
        ", i.e. ", ", that is ", ", so ", " hence ", ", which simplifies to ", "; this gives ", "，即", "，化简得", "，所以",
        " (using l_c = l/2) ", " (平行轴定理) ", "（平行轴定理）\n", " [Steiner] ", r" \text{(Steiner)} ", "\\quad\\text{(Steiner)}\n", " (Satz von Steiner)\n", ", d.h. ",
    ],
)  # fmt: skip
def test_a_side_behind_words_is_judged(between):
    right = kl.diagnose("single_link", "M11", f"M11 = {OWN}{between}= m1*l1^2/3")
    assert right.agrees, right
    assert not any("not judged" in one for one in right.remarks), right
    wrong = kl.diagnose("single_link", "M11", f"M11 = {OWN}{between}= m1*l1^2")
    assert not wrong.agrees, wrong
    assert "m1*l1^2 should be m1*l1^2/3" in wrong.causes[0].sentence
    middle = kl.diagnose("single_link", "M11", f"M11 = m1*l1^2/12 + m1*l1^2{between}= m1*l1^2/3")
    assert not middle.agrees, middle


@pytest.mark.parametrize("words", ["(移轴公式)", "（移轴公式）\n"])
def test_a_side_behind_words_that_nobody_has_listed_is_not_passed_over(words):
    right = kl.diagnose("single_link", "M11", f"M11 = {OWN} {words}= m1*l1^2/3")
    assert right.agrees and any("were not read" in one for one in right.remarks), right
    with pytest.raises(ExpressionError, match="were not read"):
        kl.diagnose("single_link", "M11", f"M11 = {OWN} {words}= m1*l1^2")


@pytest.mark.parametrize(
    ("robot", "entry", "right", "old", "new", "slip"),
    [
        (
            "planar2r_rods",
            "M11",
            "Model solution, exercise 4.2: M11 = I1 + m1*lc1^2 + I2 + m2*(l1^2 + lc2^2 + 2*l1*lc2*c2)",
            "I2 + ",
            "",
            "if it is M11 in every state, it has a slip: M11: the term I2 is missing",
        ),
        (
            "scara",
            "z",
            "Since the third joint points downwards, z = d1 - q3.",
            "- q3",
            "+ q3",
            "by the robot's own axes, it has a slip: z: + q3 should be - q3",
        ),
    ],
    ids=["term", "axes"],
)  # fmt: skip
def test_beside_words_that_nobody_has_listed_a_slip_is_told_as_what_it_may_be(
    robot, entry, right, old, new, slip
):
    """It is not called wrong: the words may say when it holds."""
    assert kl.diagnose(robot, entry, right).agrees
    with pytest.raises(ExpressionError, match="not judged") as refusal:
        kl.diagnose(robot, entry, right.replace(old, new))
    assert slip in str(refusal.value)


def test_what_it_may_be_is_told_of_one_line_of_a_file():
    slip = "Model solution, exercise 4.2: M11 = (m1+m2)*l1^2 + m2*l2^2 + m2*l1*l2*c2"
    document = {"robot": "planar2r", "formulas": {"M11": slip, "g2": "m2*g*l2*c12"}}
    judged, unread = of_document(document, "hand.toml")
    assert [one.agrees for one in judged] == [True]
    (lost,) = unread
    assert "if it is M11 in every state" in str(lost.reason), lost
    assert "m2*l1*l2*c2 should be 2*m2*l1*l2*c2" in str(lost.reason), lost


@pytest.mark.parametrize(
    "words", [", and its derivative", "; the torque", "，其导数", ", derivative", ", and another entry"]
)  # fmt: skip
def test_what_is_said_of_something_else_is_not_held_against_it(words):
    """The words name another quantity: what they are told to be is not this formula's."""
    found = kl.diagnose("single_link", "V", f"V = m1*g*l1/2*sin(q1){words} = m1*g*l1/2*cos(q1)")
    assert found.agrees and any("not judged" in one for one in found.remarks), found


T = "1/6*(m1 + 3*m2)*l1^2*qd1^2 + 1/6*m2*l2^2*(qd1+qd2)^2 + 1/2*m2*l1*l2*c2*qd1*(qd1+qd2)"
V = "(1/2*m1 + m2)*g*l1*s1 + 1/2*m2*g*l2*s12"


def test_explained_names_in_a_chain_are_judged():
    end = f"{T} - (1/2*m1 + m2)*g*l1*s1 - 1/2*m2*g*l2*s12"
    assert kl.diagnose("planar2r_rods", "L", f"T = {T}\nV = {V}\nL = T - V = {end}").agrees
    for wrong in (
        f"T = {T.replace('1/6*m2', 'm2')}\nV = {V}\nL = T - V = {end}",
        f"T = {T}\nV = {V.replace('s12', 'c12')}\nL = T - V = {end}",
    ):
        found = kl.diagnose("planar2r_rods", "L", wrong)
        assert not found.agrees and found.causes[0].sentence[:1] in "TV", found
    assert kl.diagnose("planar2r_rods", "M22", "h = m2*l2^2/3\nM22 = h = I2 + m2*l2^2/4").agrees
    wrong = "h = m2*l2^2/2\nM22 = h = I2 + m2*l2^2/4"
    assert not kl.diagnose("planar2r_rods", "M22", wrong).agrees
    # without what they are said to be, T and V say what the Lagrangian is
    assert kl.diagnose("planar2r_rods", "L", f"L = T - V = {end}").agrees


@pytest.mark.parametrize(
    "text",
    [
        "z = l3 sin(q3) so dz/dq3 = l3*cos(q3)", "z = l3 sin(q3), hence ∂z/∂q3 = l3*cos(q3)",
        "p_z = l3 sin(q3)\n∂p_z/∂q3 = l3*cos(q3)", r"$z = l_3 \sin q_3$, so $\frac{\partial z}{\partial q_3} = l_3 \cos q_3$",
        "z = l3*s3 so J33 = dz/dq3 = l3*cos(q3)",
    ],
)  # fmt: skip
def test_of_a_coordinate_and_its_derivative_the_latter_is_judged(text):
    assert kl.diagnose("spatial3r", "J33", text).agrees
    wrong = text[::-1].replace("soc", "nis", 1)[::-1]
    found = kl.diagnose("spatial3r", "J33", wrong)
    assert not found.agrees and "cos" in found.causes[0].sentence, found


@pytest.mark.parametrize("name", ["x", "y", "z", "p_x", "px"])
@pytest.mark.parametrize(
    ("entry", "formula"), [("J11", "-l1*s1 - l2*s12"), ("M22", "m2*l2^2"), ("g2", "m2*g*l2*c12")]
)
def test_a_coordinate_is_no_entry_of_something_else(name, entry, formula):
    assert kl.diagnose("planar2r", entry, formula).agrees
    with pytest.raises(ExpressionError, match="which is another"):
        kl.diagnose("planar2r", entry, f"{name} = {formula}")


def test_steps_with_a_derivative_in_front_are_told():
    steps = "d/dt(∂L/∂θ̇₂) = m₂l₂²(θ̈₁+θ̈₂)\n"
    end = "τ₂ = m₂l₂²(θ̈₁+θ̈₂) + m₂l₁l₂c₂θ̈₁ + m₂l₁l₂s₂θ̇₁² + m₂gl₂c₁₂"
    found = kl.diagnose("planar2r", "tau2", f"{steps}相减得 {end}")
    assert found.agrees and any("was not judged" in one for one in found.remarks), found


@pytest.mark.parametrize(
    ("entry", "text"),
    [
        ("g2", "g2 = ∂V/∂q1 = m2*g*l2*c12"), ("g2", "g2 = dV/dq3 = m2*g*l2*c12"),
        ("g2", r"$g_2 = \frac{\partial V}{\partial q_1} = m_2 g l_2 c_{12}$"),
        ("J11", "J11 = ∂x/∂q2 = -l1*s1 - l2*s12"), ("J11", "J11 = ∂y/∂q1 = -l1*s1 - l2*s12"),
    ],
)  # fmt: skip
def test_the_derivative_of_something_else_is_refused(entry, text):
    with pytest.raises(ExpressionError, match="which is another"):
        kl.diagnose("planar2r", entry, text)
    own = text.replace("q1 =", "q2 =").replace("q3", "q2").replace("q_1", "q_2")
    own = {"g2": own, "J11": "J11 = ∂x/∂q1 = -l1*s1 - l2*s12"}[entry]
    assert kl.diagnose("planar2r", entry, own).agrees


def test_what_a_step_alone_uses_that_is_not_judged_is_told():
    """``\\dot M_{11}`` stands in the step in front, and not in what is judged."""
    text = "C_{11} = \\frac12 \\dot M_{11} here.\n\\dot M_{11} = -m_2^2 l_1 l_2 s_2 \\dot q_2\nC_{11} = -\\frac12 m_2 l_1 l_2 s_2 \\dot q_2"
    found = kl.diagnose("planar2r_rods", "C11", text)
    assert found.agrees and any("M_{11}" in one for one in found.remarks), found
    text = "v1^2 = l1^2*qd1^2\nv2^2 = l1^2*qd1^2 + l2^2*(qd1+qd2)^2 + 2*l1*l2*c2*qd1*(qd1+qd2)\nT = 1/2*m1*v1^2 + 1/2*m2*v2^2"
    end = "1/2*(m1+m2)*l1^2*qd1^2 + 1/2*m2*l2^2*(qd1+qd2)^2 + m2*l1*l2*c2*qd1*(qd1+qd2)"
    found = kl.diagnose("planar2r", "T", f"{text}\n = {end}")
    assert found.agrees and found.remarks == (), found


RIGHT, OTHER = "(m1+m2)*g*l1*c1 + m2*g*l2*c12", "(m1+m2)*g*l1*s1 + m2*g*l2*c12"


@pytest.mark.parametrize(
    "words", [", or ", ", that is ", ", which is the same as ", "\n  which equals\n  ", "，即 ", " 即为 ", "，也就是 ", ", i.e. "]
)  # fmt: skip
def test_words_for_a_sign_of_equality(words):
    found = kl.diagnose("planar2r", "g1", f"g1 = {RIGHT}{words}{RIGHT}")
    assert found.agrees and found.remarks == (), found
    wrong = kl.diagnose("planar2r", "g1", f"g1 = {RIGHT}{words}{OTHER}")
    assert not wrong.agrees and "s1 should be c1" in wrong.causes[0].sentence, wrong


@pytest.mark.parametrize(
    "behind",
    [
        " (using cos(q1)*cos(q2) - sin(q1)*sin(q2))", ", using c12 for cos(q1 + q2)", ", with c1*c2 - s1*s2 for c12",
        " which we get by differentiating V", ", so the arm balances when c1 + c12 vanish", ", the derivative of m1*y1 + m2*y2",
    ],
)  # fmt: skip
def test_what_is_said_behind_a_formula_is_no_other_side(behind):
    assert kl.diagnose("planar2r", "g1", f"g1 = {RIGHT}{behind}").agrees


def test_a_sum_behind_other_words_is_told():
    found = kl.diagnose("planar2r", "g1", f"g1 = {RIGHT}, after collecting terms {OTHER}")
    assert found.agrees and any("was not judged" in one for one in found.remarks), found


def test_a_number_behind_words_is_told():
    for behind in (", i.e. 0.3 kg m²", " which gives 0.3"):
        found = kl.diagnose("planar2r", "M22", f"M22 = m2*l2^2{behind}")
        assert found.agrees and any("was not judged" in one for one in found.remarks), found


def test_of_a_matrix_that_is_given_twice_each_is_judged():
    right = "[m1*l1^2 + m2*(l1^2 + l2^2 + 2*l1*l2*c2), m2*(l2^2 + l1*l2*c2); m2*(l2^2 + l1*l2*c2), m2*l2^2]"
    found = kl.diagnose("planar2r", "mass_matrix", f"M = {right} = {right}")
    assert found.agrees and found.remarks == (), found
    wrong = right.replace("2*l1*l2*c2", "l1*l2*c2")
    found = kl.diagnose("planar2r", "mass_matrix", f"M = {right} (symmetric) = {wrong}")
    assert not found.agrees and "2*l1*l2*c2" in found.causes[0].sentence, found


@pytest.mark.parametrize(
    "between",
    ["\n", "; ", "\nso ", ", then ", ":\nlast step\n", "\n由此得\n"],
)
def test_an_earlier_line_of_the_entry_is_judged(between):
    """``M33 = (wrong)`` and ``M33 = (right)`` below it: it agreed without a word."""
    own, last = "M33 = m3*l3^2/4 + m3*l3^2/12", "M33 = m3*l3^2/3"
    assert kl.diagnose("planar3r", "M33", f"{own}{between}{last}").agrees
    wrong = own.replace("l3^2/12", "l3^3/12")
    found = kl.diagnose("planar3r", "M33", f"{wrong}{between}{last}")
    assert not found.agrees, found
    assert "l3^3 should be l3^2" in found.causes[0].sentence
    assert not kl.diagnose("planar3r", "M33", f"{own}{between}{last}*l3").agrees


def test_what_an_earlier_line_is_made_of_is_no_step_where_it_is_not_explained():
    text = "T = T1 + T2\nT = m1*l1^2*qd1^2/6 + m2*(l1^2*qd1^2 + l2^2*(qd1+qd2)^2/3 + l1*l2*cos(q2)*qd1*(qd1+qd2))/2"
    assert kl.diagnose("planar2r_rods", "T", text).agrees
    assert not kl.diagnose("planar2r_rods", "T", text.replace("/6", "/3")).agrees


@pytest.mark.parametrize(
    "text",
    [
        "with l1 = {} m and l2 = 0.275 m we get x = 0.325 cos(q1) + 0.275 cos(q1+q2)",
        "手册里 l1 = {} m, l2 = 0.275 m，所以 x = 0.325 cos(q1) + 0.275 cos(q1+q2)",
        "l1 = {}, x = 0.325 cos(q1) + 0.275 cos(q1+q2)",
    ],
)
def test_a_number_of_the_arm_beside_a_formula_of_numbers_is_held_against_it(text):
    assert kl.diagnose("scara", "x", text.format("0.325")).agrees
    with pytest.raises(ExpressionError, match="l1 = 3.325.*is not so of this robot"):
        kl.diagnose("scara", "x", text.format("3.325"))


@pytest.mark.parametrize("name", ["v2x", "xc2", "h2a"])
def test_what_is_given_for_a_name_with_letters_behind_its_number_is_told(name):
    found = kl.diagnose("planar2r", "M12", f"{name} = l1*s1*qd1\nM12 = m2*l2^2 + m2*l1*l2*c2")
    assert found.agrees
    assert found.remarks == (f"not judged: what is given for {name}",)


M, G = "m1*l1^2 + m2*(l1^2 + l2^2 + 2*l1*l2*cos(q2))", "(m1+m2)*g*l1*c1 + m2*g*l2*c12"
OF_PARTS = [
    ("planar2r", "g1", "term of the first mass: g1 = m1*g*l1*c1\nall terms: ", f"g1 = {G}"),
    ("planar2r", "M11", "Start with M11 = m1*l1^2\nthen add the second mass: ", f"M11 = {M}"),
    ("planar2r", "M11", "M11 = m1*l1^2  # first link\n", f"M11 = {M}  # both"),
    ("planar2r", "x", "对第一杆 x = l1*c1\n末端 ", "x = l1*c1 + l2*c12"),
    ("planar2r", "x", "first x = l1*c1, then ", "x = l1*c1 + l2*c12"),
    ("planar2r", "x", "Gelenk 2: x = l1*c1\nWerkzeug: ", "x = l1*c1 + l2*c12"),
    ("planar2r_rods", "M22", "about its centre M22 = m2*l2^2/12\nabout the joint ", "M22 = m2*l2^2/3"),
    ("planar2r", "M", "first link: M = [m1*l1^2, 0; 0, 0]\nboth links: ",
     f"M = [{M}, m2*(l2^2+l1*l2*c2); m2*(l2^2+l1*l2*c2), m2*l2^2]"),
]  # fmt: skip


@pytest.mark.parametrize(("robot", "entry", "part", "whole"), OF_PARTS)
def test_what_is_said_of_a_part_is_not_held_against_the_whole(robot, entry, part, whole):
    """Each was called wrong for its first line, of which words say what it is."""
    found = kl.diagnose(robot, entry, part + whole)
    assert found.agrees, found
    assert any("another line" in one and "was not judged" in one for one in found.remarks), found
    wrong = kl.diagnose(robot, entry, part + whole.replace("l2", "l1", 1))
    assert not wrong.agrees, wrong


def test_of_a_whole_and_a_part_behind_it_nothing_is_said():
    text = f"all terms: g1 = {G}\nof which the first mass: g1 = m1*g*l1*c1"
    with pytest.raises(ExpressionError, match="several lines that are not the same"):
        kl.diagnose("planar2r", "g1", text)
    # nothing but what leads over: the last line is wrong
    for between in ("\nso ", ". Collecting terms, ", "\n"):
        found = kl.diagnose("planar2r", "g1", f"g1 = {G}{between}g1 = {G.replace('c12', 'c2')}")
        assert not found.agrees and "c2 should be c12" in found.causes[0].sentence, found


def test_words_of_a_part_say_nothing_of_the_whole():
    part, whole = "Only link 1: M11 = m1*l1^2", f"Both: M11 = {M.replace('2*l1', 'l1')}"
    found = kl.diagnose("planar2r", "M11", f"{part}\n{whole}")
    assert not found.agrees and "2*l1*l2*cos(q2)" in found.causes[0].sentence, found
    for other in (
        f"Only massless links: M11 = m1*l1^2\n{whole}",
        f"{whole[6:]}\n{part}",
        f"At rest, only link 1: tau1 = m1*g*l1*c1\nBoth links: tau1 = {G}",
    ):
        with pytest.raises(ExpressionError, match="not read"):
            kl.diagnose("planar2r", "tau1" if "tau1" in other else "M11", other)


ADDED = [
    ("M11 = m1*l1^2\nM11 += {}", "M11"), ("M11 = m1*l1^2;\nM11 = M11 + {};", "M11"), ("M(1,1) = m1*l1^2;\nM(1,1) = M(1,1) + {};", "M11"),
    ("a = m1*l1^2; a += {}; M11 = a", "M11"), ("M11 = m1*l1^2  # first\nM11 += {}  # second", "M11"),
]  # fmt: skip


@pytest.mark.parametrize(("text", "entry"), ADDED)
def test_what_is_added_to_a_name_belongs_to_it(text, entry):
    """A right sum was called wrong for its first line."""
    second = "m2*(l1^2 + l2^2 + 2*l1*l2*cos(q2))"
    assert kl.diagnose("planar2r", entry, text.format(second)).agrees
    wrong = kl.diagnose("planar2r", entry, text.format(second.replace("2*l1", "l1")))
    assert not wrong.agrees and "2*l1*l2*cos(q2)" in str(wrong), wrong
    with pytest.raises(ExpressionError, match="adds to what is not there"):
        kl.diagnose("planar2r", entry, f"{entry} += {second}")


H = "m2*l1*lc2*sin(q2)"


@pytest.mark.parametrize(
    "text",
    [
        f"C11 = -h*qd2 with h = {H}, i.e. -{H}*qd2", f"C11 = -h*qd2, h = {H}, that is -{H}*qd2",
        f"C11 = -h*qd2，其中 h = {H}，即 -{H}*qd2",
        r"$C_{11} = -h\dot q_2$ with $h = m_2 l_1 l_{c2}\sin q_2$, i.e. $-m_2 l_1 l_{c2}\sin q_2\,\dot q_2$",
    ],
)  # fmt: skip
def test_what_goes_on_behind_an_explanation_is_the_formula_s(text):
    """The last side was taken for what h is, and the right formula called wrong."""
    assert kl.diagnose("planar2r_rods", "C11", text).agrees
    wrong = (
        text.replace("*qd2", "*qd1") if "*qd2" in text else text.replace(r"\dot q_2", r"\dot q_1")
    )
    last = text[: -len("qd2")] + "qd1" if "*qd2" in text else wrong
    assert not kl.diagnose("planar2r_rods", "C11", last).agrees
    said = f"C11 = -h*qd2 with h = {H}, i.e. m2*l1*l2*sin(q2)/2"
    assert kl.diagnose("planar2r_rods", "C11", said).agrees


@pytest.mark.parametrize(
    "text",
    [
        "At q1 = q2 = 0: g2 = m2*g*l2.\nIn general g2 = m2*g*l2*cos(q1+q2)",
        "Für q1 = 0 ist g2 = m2*g*l2*cos(q2), ein Sonderfall.\nAllgemein: g2 = m2*g*l2*cos(q1+q2)",
        "当 q2 = 0 时：g2 = m2*g*l2*cos(q1)\n一般地：g2 = m2*g*l2*cos(q1+q2)",
    ],
)
def test_of_special_cases_and_what_holds_in_general_the_latter_is_judged(text):
    found = kl.diagnose("planar2r", "g2", text)
    assert found.agrees and any("not judged: the special case" in x for x in found.remarks), found
    wrong = kl.diagnose("planar2r", "g2", text[::-1].replace("soc", "nis", 1)[::-1])
    assert not wrong.agrees and "cos" in str(wrong.causes[0].sentence), wrong


def test_a_state_in_a_sentence_explains_no_name():
    """It was put in for q2 everywhere, and the right formula called wrong."""
    text = "In general g2 = m2*g*l2*cos(q1+q2), for q2 = 0 it is g2 = m2*g*l2*cos(q1)"
    assert kl.diagnose("planar2r", "g2", text).agrees


@pytest.mark.parametrize("word", ["So", "so", "By this", "We have", "Es ist"])
def test_the_last_line_is_not_passed_over(word):
    """Behind a word of two letters it was not seen, and the line above it judged alone."""
    text = "Rods: I2 + m2*lc2^2 = m2*l2^2/3 and I3 + m3*lc3^2 = m3*l3^2/3."
    first = "M22 = I2 + m2*lc2^2 + I3 + m3*(l2^2 + lc3^2 + 2*l2*lc3*cos(q3))"
    wrong = f"{first}\n{text}\n{word} M22 = (m2 + m3)/3*l2^2 + m3*l3^2/3 + m3*l2*l3*cos(q3)"
    with pytest.raises(ExpressionError):
        kl.diagnose("planar3r", "M22", wrong)
    assert kl.diagnose("planar3r", "M22", wrong.replace("(m2 + m3)/3", "(m2/3 + m3)")).agrees


def test_what_is_said_of_names_that_the_formula_has_not_is_told():
    right = "x = l1*cos(q1) + l2*cos(q1+q2)"
    for behind, names in (("(a1=l2, a2=l1)", "a1, a2"), ("(and y = l1*cos(q1))", "y")):
        found = kl.diagnose("planar2r", "x", f"{right} {behind}")
        assert found.agrees and f"not judged: what is given for {names}" in found.remarks, found
    with pytest.raises(ExpressionError, match="is not so of this robot"):
        kl.diagnose("planar2r", "x", f"{right} (l1=l2)")


@pytest.mark.parametrize("name", ["J(1,)", "J(,2)"])
def test_a_name_that_lacks_a_place_is_none(name):
    with pytest.raises(ExpressionError, match="which is another"):
        kl.diagnose("planar2r", "J12", f"{name} = -l2*sin(q1+q2)")


@pytest.mark.parametrize(
    ("robot", "entry", "text"),
    [
        ("planar2r", "M11", f"first link: M11 = m1*l1^2   # link 2\nboth: M11 = {M}"),
        ("planar2r", "M11", f"first link: M11 = m1*l1^2 % masses in kg\nboth: M11 = {M}"),
        ("planar2r", "x", "x = l1*cos(q1) (rods)\nx = x + l2*cos(q1+q2)"),
        ("planar2r", "V", "h1 = l1*sin(q1) and h2 = h1 + l2*sin(q1+q2)\n1) V = m1*g*h1 + m2*g*h2"),
    ],
)
def test_what_stands_beside_a_line_ends_with_it(robot, entry, text):
    """Each was called wrong: what was left of a comment took the lines behind it along."""
    found = kl.diagnose(robot, entry, text)
    assert found.agrees and found.function == entry, found


@pytest.mark.parametrize(
    "text",
    [
        "x = l1*cos(q1) at first\nx += l2*cos(q1+q2)", "x = l1*cos(q1)\nDaraus folgt x += l2*cos(q1+q2)",
        "x = l1*cos(q1) we start\nx = x + l2*cos(q1+q2)",
        "x = l1*c1 + l2*c12\n- With l1 = 0.5 m and l2 = 0.4 m this is\nx = 0.5*c1 + 0.4*c12",
    ],
)  # fmt: skip
def test_what_cannot_be_read_surely_is_refused(text):
    with pytest.raises(ExpressionError):
        kl.diagnose("planar2r", "x", text)


@pytest.mark.parametrize(
    "comment", ["in mm", "position of the centre of mass of link 2", "at rest"]
)
@pytest.mark.parametrize("sign", ["#", "//"])
def test_a_comment_that_says_more_than_the_part_is_told(comment, sign):
    """With the part's it was left out, and the sum agreed without a word."""
    text = "x = l1*c1\nx += l2*c12"
    (remark,) = kl.diagnose("planar2r", "x", f"{text}  {sign} {comment}").remarks
    assert f"{comment}' beside the formula were not read" in remark
    assert kl.diagnose("planar2r", "x", f"{text}  {sign} link 2").remarks == ()


@pytest.mark.parametrize("comment", ["without link 1", "ohne Glied 1", "only link 2", "只看连杆 2"])
def test_a_comment_that_a_part_stands_alone_is_not_dropped(comment):
    """Of link 1, or of nothing but link 2, the sum may be no tool's position: that is told."""
    text = f"x = l1*c1\nx += l2*c12  # {comment}"
    try:
        assert kl.diagnose("planar2r", "x", text).remarks
    except ExpressionError as refused:
        assert comment in str(refused)


def test_a_definition_whose_name_is_of_two_words():
    """It ended in a SyntaxError: the name was read as a formula."""
    assert kl.diagnose("planar2r", "M22", "det J = l1*l2*s2\nM22 = m2*l2^2").agrees


def test_a_dash_before_a_greek_name_is_refused_too():
    with pytest.raises(ExpressionError, match="dash"):
        kl.diagnose("planar3r", "phi", "- φ = θ1+θ2+θ3")


def test_what_a_function_answers_by_the_entry_s_name():
    text = "def kinetic(q2, qd1, qd2):\n    x = l1*cos(q1)\n    x += l2*cos(q1+q2)\n    return x"
    assert kl.diagnose("planar2r", "x", text).agrees
    assert not kl.diagnose("planar2r", "x", text.replace("l2*cos", "l2*sin")).agrees


@pytest.mark.parametrize("sign", ["#", "//", "%", "(", ","])
def test_a_line_ends_behind_a_clause_that_is_true(sign):
    """The end of the line went with it: ``lc2 = l2/2`` was taken for another side of I2."""
    lines = f"I2 = m2*l2^2/12   {sign} rod about its centre{')' * (sign == '(')}\nlc2 = l2/2\n"
    assert kl.diagnose("planar2r_rods", "M22", f"{lines}M22 = I2 + m2*lc2^2").agrees
    assert not kl.diagnose("planar2r_rods", "M22", f"{lines}M22 = I2 + m2*l2^2").agrees


def test_what_is_pointed_at_is_a_remark():
    right = "g2 = m2*g*l2*c12   <- gravity term"
    assert kl.diagnose("planar2r", "g2", right).agrees
    wrong = kl.diagnose("planar2r", "g2", right.replace("c12", "s12"))
    assert "s12 should be c12" in wrong.sentence
    for words in ("from the vertical", "times two"):
        with pytest.raises(ExpressionError, match="may change"):
            kl.diagnose("planar2r", "g2", f"g2 = m2*g*l2*c12   <- {words}")


def test_what_is_not_to_be_forgotten_denies_nothing():
    text = r"Differentiate $T$ (do not forget the cross term!): $p_2 = m_2 l_2^2(\dot\theta_1+\dot\theta_2) + m_2 l_1 l_2 c_2\dot\theta_1$"
    assert kl.diagnose("planar2r", "p2", text).agrees
