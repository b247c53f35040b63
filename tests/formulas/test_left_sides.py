"""Names that nobody's list has, other points and frames in words, and what is the other's mirror."""

from __future__ import annotations

import pytest

import kinlab as kl
from kinlab.errors import ExpressionError

RATE, LEVER = r"l_1 c_2\dot\theta_1", r"l_1\cos q_1 + l_{c2}\cos(q_1+q_2)"
PULL = r"(l_1 s_2\ddot\theta_1 - l_1 c_2\dot\theta_1^2)"
M12 = r"m_2(l_{c2}^2 + l_1 l_{c2}\cos q_2) + I_2"


@pytest.mark.parametrize(
    ("entry", "name", "right"),
    [
        ("link_velocities[1,1]", "{}^2v_{2,y}", RATE),
        ("link_velocities[1,1]", "v_{2,y}", RATE),
        ("link_velocities[1,1]", "(v_2)_y", RATE),
        ("com_jacobians[1,1,0]", "[J_{v_{c2}}]_{21}", LEVER),
        ("link_accelerations[1,0]", r"{}^2\dot v_{2x}", PULL),
        ("link_accelerations[1,0]", r"{}^2\dot{v}_{2x}", PULL),
    ],
)
def test_a_name_that_no_list_has_is_told_as_not_read(entry, name, right) -> None:
    """It is judged as what it is asked for, right or wrong."""
    found = kl.diagnose("planar2r_rods", entry, f"${name} = {right}$")
    assert found.agrees
    assert f"the left side {name!r} was not read" in str(found)
    assert not kl.diagnose("planar2r_rods", entry, f"${name} = 2 {right}$").agrees


@pytest.mark.parametrize("name", ["P_2", "Q_2", "J_{v3}"])
def test_what_is_another_is_still_refused(name) -> None:
    with pytest.raises(ExpressionError, match="begins with"):
        kl.diagnose("planar2r_rods", "link_velocities[1,1]", f"${name} = {RATE}$")


@pytest.mark.parametrize(
    ("entry", "text"),
    [
        ("com_positions[1,0]", "x = l1*cos(q1) + lc2*cos(q1+q2), the position of the tool tip"),
        ("com_positions[1,0]", "末端位置 x = l1*cos(q1) + lc2*cos(q1+q2)"),
        ("fk[0,3]", "$x = l_1c_1 + l_2c_{12}$ is the position of the centre of mass of link 2"),
        ("jacobian[0,0]", r"$J_{11} = -l_1s_1 - l_2s_{12}$, expressed in frame $\{2\}$"),
    ],
)
def test_another_point_or_frame_in_words_is_refused(entry, text) -> None:
    with pytest.raises(ExpressionError, match="is not what it is asked for"):
        kl.diagnose("planar2r_rods", entry, text)


@pytest.mark.parametrize(
    ("entry", "text"),
    [
        ("fk[0,3]", "x = l1*cos(q1) + l2*cos(q1+q2), the position of the end effector"),
        ("jacobian[0,0]", r"$J_{11} = -l_1s_1 - l_2s_{12}$, expressed in frame $\{0\}$"),
        ("com_positions[1,0]", "x = l1*cos(q1) + lc2*cos(q1+q2), the position of the centre"),
        ("mass_matrix[0,1]", f"由对称性 $d_{{12}}=d_{{21}}$，所以 $d_{{12}} = {M12}$"),
        ("mass_matrix[0,1]", f"By symmetry $M_{{12}} = M_{{21}}$. So $M_{{12}} = {M12}$"),
    ],
)
def test_the_entry_s_own_point_frame_or_mirror_is_not(entry, text) -> None:
    assert kl.diagnose("planar2r_rods", entry, text).agrees


def test_a_block_of_christoffel_s_symbols_is_counted_as_it_is_asked_for() -> None:
    h = "m2*l1*lc2*sin(q2)"
    assert kl.diagnose("planar2r_rods", "christoffel[0]", f"[0, -{h}; -{h}, -{h}]").agrees
    assert not kl.diagnose("planar2r_rods", "christoffel[1]", f"[0, -{h}; -{h}, -{h}]").agrees


@pytest.mark.parametrize(
    ("entry", "text"),
    [
        ("mass_matrix[0,1]", "M12 = I2 + m2*lc2**2 + 2*b*cos(q2), b = m2*l1*lc2"),
        ("coriolis_matrix[0,1]", "C12 = -2*b*s2*(qd1 + qd2), b = m2*l1*lc2"),
    ],
)
def test_a_factor_that_stands_there_and_does_not_belong(entry, text) -> None:
    """It is dropped, and no name is halved to make up for it."""
    (cause,) = kl.diagnose("planar2r_rods", entry, text).causes
    assert "the factor 2 does not belong" in cause.sentence


def test_a_factor_that_a_name_has_too_much_is_told_there() -> None:
    text = "M12 = I2 + m2*lc2**2 + b*cos(q2), b = 2*m2*l1*lc2"
    (cause,) = kl.diagnose("planar2r_rods", "mass_matrix[0,1]", text).causes
    assert cause.sentence.startswith("b: ")


LAST = r"m_3\left(\frac{l_3^2}{3} + \frac{l_2 l_3}{2}c_3 + \frac{l_1 l_3}{2}c_{23}\right)"
FIRST = r"I_3 + m_3(l_{c3}^2 + l_2 l_{c3}c_3 + l_1 l_{c3}c_{23})"


@pytest.mark.parametrize("which", [0, 1])
def test_a_step_that_is_a_product_in_parentheses_is_judged(which) -> None:
    """``m_3(...)`` is no name with a state behind it, and no step is passed over for it."""
    steps = [FIRST, LAST]
    assert kl.diagnose("planar3r", "mass_matrix[0,2]", f"$M_{{13}} = {' = '.join(steps)}$").agrees
    steps[which] = steps[which].replace("c_{23}", "c_2")
    found = kl.diagnose("planar3r", "mass_matrix[0,2]", f"$M_{{13}} = {' = '.join(steps)}$")
    assert "c_{23}" in found.causes[0].sentence


@pytest.mark.parametrize("last", ["m_2", "m_2(l_2)", "m_2(q_2)"])
def test_a_mass_is_no_name_of_the_entry(last) -> None:
    """A wrong last step is judged or refused, and not passed over."""
    text = f"M_{{12}} = {M12}"
    assert kl.diagnose("planar2r_rods", "mass_matrix[0,1]", f"${text}$").agrees
    try:
        found = kl.diagnose("planar2r_rods", "mass_matrix[0,1]", f"${text} = {last}$")
    except ExpressionError:
        return
    assert not found.agrees


def test_the_name_of_the_mirrored_entry_is_one() -> None:
    text = f"$M_{{12}} = M_{{21}} = {M12}$"
    assert kl.diagnose("planar2r_rods", "mass_matrix[0,1]", text).agrees


def test_rates_in_parentheses_are_a_product() -> None:
    text = r"$C_{12} = -m_2 l_1 l_{c2}s_2(\dot q_1 + \dot q_2) = h(\dot q_1 \dot q_2), h = -m_2 l_1 l_{c2}s_2$"
    assert not kl.diagnose("planar2r_rods", "coriolis_matrix[0,1]", text).agrees


@pytest.mark.parametrize(
    "state", ["(q)", r"(\theta)", r"\left(q_1, q_2\right)", r"(\boldsymbol{q})"]
)
def test_a_state_behind_a_name_still_says_nothing(state) -> None:
    assert kl.diagnose("planar2r_rods", "mass_matrix[0,1]", f"$M_{{12}}{state} = {M12}$").agrees


def test_an_index_is_the_one_that_is_asked_for() -> None:
    text = "tau[2] = fx*cos(q1)*sin(q2) + fy*sin(q1)*sin(q2) + fz*cos(q2)"
    assert kl.diagnose("stanford", "statics[2]", text).agrees
    with pytest.raises(ExpressionError, match="counted from 0"):
        kl.diagnose("stanford", "statics[1]", text)


@pytest.mark.parametrize(
    ("robot", "entry", "text", "right", "slip"),
    [
        ("planar2r", "gravity_torques[1]", "Ableiten der potentiellen Energie nach den Gelenkwinkeln liefert g2 = m2*g*l2*cos(q1+q2)", "cos(q1+q2)", "cos(q2)"),
        ("planar2r", "inverse_dynamics[1]", "Für das zweite Gelenk erhalte ich tau2 = m2*l2^2*(qdd1+qdd2) + m2*l1*l2*c2*qdd1 + m2*l1*l2*s2*qd1^2 + m2*g*l2*c12", "l2*s2*qd1^2", "l2*s2*qd1"),
        ("planar2r", "statics[1]", "El par de la segunda articulación se obtiene con la traspuesta: tau2 = -l2*s12*fx + l2*c12*fy + nz", "l2*c12*fy + nz", "l2*c12*fx + nz"),
        ("single_link", "inverse_dynamics", "由动量矩定理，关节力矩为 tau = m*l^2/3*qdd + m*g*l/2*cos(q)", "m*l^2/3", "m*l^2/12"),
        ("planar2r", "mass_matrix_dot[0,0]", "Since only $q_2$ enters $M$, we have $\\dot M_{11} = -2m_2 l_1 l_2 s_2 \\dot q_2$.", "s_2 \\dot q_2", "c_2 \\dot q_2"),
    ],
)  # fmt: skip
def test_words_of_a_derivation_are_no_reason_not_to_judge(robot, entry, text, right, slip) -> None:
    assert kl.diagnose(robot, entry, text).agrees
    assert kl.diagnose(robot, entry, text.replace(right, slip)).causes


@pytest.mark.parametrize(
    "words",
    [
        "Im Gleichgewicht gilt",
        "At equilibrium",
        "For the inverted arm",
        "平衡时",
        "For the folded arm",
    ],
)
def test_words_of_a_state_are_one(words) -> None:
    """What may hold only there is not called wrong."""
    with pytest.raises(ExpressionError, match="were not read|may change"):
        kl.diagnose("planar2r", "gravity_torques[1]", f"{words} g2 = m2*g*l2")


TORQUE = "tau3 = -l3 s3 c12 Fx - l3 s3 s12 Fy + l3 c3 Fz + s12 Mx - c12 My"


@pytest.mark.parametrize(
    "text",
    [
        f"The torque of joint 3 is {TORQUE}. My answer.",
        f"El par de la tercera articulación es {TORQUE}, con c12 = cos(q1+q2).",
        f"My answer: {TORQUE}",
    ],
)
def test_a_moment_is_no_word(text) -> None:
    """``My`` was left out as the English word: a right formula was called wrong."""
    assert kl.diagnose("spatial3r", "statics[2]", text).agrees


@pytest.mark.parametrize(
    ("entry", "text"),
    [
        ("forward_dynamics", "qdd = np.array([(tau - m*g*(l/2)*np.cos(q))/(m*l**2/3)])"),
        ("mass_matrix", "M = [I + m*(l/2)^2] = [m*l^2/3] = [0.3]"),
    ],
)
def test_a_list_of_one_number_is_that_number(entry, text) -> None:
    assert kl.diagnose("single_link", entry, text).agrees


@pytest.mark.parametrize(
    "behind", [" J", " J, as derived in class.", " J. This follows from Steiner."]
)
def test_a_unit_behind_dollars_is_no_factor(behind) -> None:
    text = r"$T = \frac16 ml^2\dot\theta^2 = 0.15\,\dot\theta^2$"
    assert kl.diagnose("single_link", "kinetic_energy", text + behind).agrees


@pytest.mark.parametrize("front", ["", "(a) Hence ", "b) So ", "Therefore "])
def test_a_letter_in_front_of_hence_is_no_line(front) -> None:
    """What follows was read as one chain, of which the last definition was told as wrong."""
    text = "L = T - V;  T = m*l^2*qd^2/6;  V = m*g*l/2*sin(q)"
    assert kl.diagnose("single_link", "lagrangian", front + text).agrees


@pytest.mark.parametrize("rate", ["q̇₂", "qd2", "q̇2"])
def test_a_factor_behind_a_bracket_begins_no_clause(rate) -> None:
    """``sin(q2) qd2 in SI units``: the rate was left out with the words, and a right one wrong."""
    text = f"Mdot12 = -m2 l1 lc2 sin(q2) {rate} in SI units."
    assert kl.diagnose("planar2r_rods", "mass_matrix_dot[0,1]", text).agrees


SECOND = "m2*g*l2/2*cos(q1+q2)"
OFF_DIAGONAL = "I2 + m2*l2^2/4 + m2*l1*l2/2*cos(q2)"


@pytest.mark.parametrize(
    ("entry", "text", "ends"),
    [
        ("g2", f"g_2 = {SECOND}", ["g_1", "g", "g_1(q)", "G_2(a_2)", "g_2(q_2)", "x", "h"]),
        ("M12", f"M_{{12}} = {OFF_DIAGONAL}", ["M_{11}", "H_{22}", "M", "I_2", "M12(q1)", "x"]),
    ],
)
def test_a_chain_does_not_end_in_the_name_of_something_else(entry, text, ends) -> None:
    """The name was left out without a word, and the formula before it agreed."""
    for end in ends:
        with pytest.raises(ExpressionError, match="signs of equality"):
            kl.diagnose("planar2r_rods", entry, f"{text} = {end}")


@pytest.mark.parametrize(
    ("entry", "text", "ends"),
    [
        ("g2", f"g_2 = {SECOND}", ["g_2", "G_2", "g_2(q)", "g_2(q_1, q_2)", r"\phi_2"]),
        ("M12", f"M_{{12}} = {OFF_DIAGONAL}", ["M_{21}", "H_{21}", "d_{12}", r"M_{12}(\theta_2)"]),
        ("x", "x = l1*cos(q1) + l2*cos(q1+q2)", ["p_x", "x(q)"]),
    ],
)
def test_a_chain_may_end_in_another_name_of_the_same(entry, text, ends) -> None:
    for end in ends:
        assert kl.diagnose("planar2r_rods", entry, f"{text} = {end}").agrees
        assert not kl.diagnose("planar2r_rods", entry, f"{text} + l1 = {end}").agrees


@pytest.mark.parametrize("front", [r"-m_2 l_1 l_2 s_2(\dot q_1+\dot q_2) = ", ""])
def test_another_entry_of_c_is_no_cosine(front) -> None:
    """It was read as cos(2*q1), and a right formula called wrong."""
    with pytest.raises(ExpressionError, match="an entry of the matrix C"):
        kl.diagnose("planar2r", "C12", f"C_{{12}} = {front}C_{{11}} - C_{{21}}")


@pytest.mark.parametrize(
    ("entry", "text"),
    [
        ("J11", "J11 = -l1*sin(q1) - l2*sin(q1+q2) = -x"),
        ("J11", "J11 = -l1*sin(q1) - l2*sin(q1+q2) = ∂x/∂q2"),
        ("J11", "x = l1*cos(q1) + l2*cos(q1+q2)\nJ11 = -l1*sin(q1) - l2*sin(q1+q2) = y"),
        ("M22", "M22 = m2*l2^2 N m"),
        ("x", r"$x = l_1 c_1 + l_2 c_{12}\,\mathrm{kg}$"),
    ],
)
def test_an_end_that_is_not_so_does_not_agree(entry, text) -> None:
    with pytest.raises(ExpressionError):
        kl.diagnose("planar2r", entry, text)


@pytest.mark.parametrize("end", ["l_1l_1s_2", "l_1 l_2 s_1"])
def test_a_product_of_names_at_the_end_is_judged(end) -> None:
    text = r"\det(J) = l_1 l_2 (s_{12}c_1 - c_{12}s_1)"
    assert kl.diagnose("planar2r", "det", f"{text} = l_1l_2s_2").agrees
    assert kl.diagnose("planar2r", "det", f"{text} = {end}").causes


def test_an_equation_that_is_not_used_is_named() -> None:
    text = (
        "y2 = l1*sin(q1) + l2*sin(q1+q2)\nV = m1*g*l1*sin(q1) + m2*g*(l1*sin(q1) + l2*sin(q1+q2))"
    )
    assert any("y2" in remark for remark in kl.diagnose("planar2r", "V", text).remarks)


@pytest.mark.parametrize("number", ["", " (1)", " (3a)"])
def test_a_number_of_an_equation_behind_a_unit_is_no_factor(number) -> None:
    text = f"y = l1*sin(theta1) = 0.6 sin(theta1) m{number}"
    assert kl.diagnose("single_link", "y", text).agrees


@pytest.mark.parametrize("left", ["M", "M(q)", "D", "$M", "H(q)"])
def test_the_mass_matrix_of_one_joint_has_no_number(left) -> None:
    formula = f"{left} = m*l^2/3" if left[0] != "$" else "$M = \\frac{m l^2}{3}$"
    assert kl.diagnose("single_link", "M11", formula).agrees
    assert not kl.diagnose("single_link", "M11", formula.replace("3", "2")).agrees


def test_the_mass_matrix_of_several_is_none_of_its_entries() -> None:
    with pytest.raises(ExpressionError, match="begins with M"):
        kl.diagnose("planar2r", "M11", "M = m1*l1^2 + m2*(l1^2 + l2^2 + 2*l1*l2*c2)")


def test_a_product_of_letters_is_no_word() -> None:
    front, behind = "the torque is τ = ⅓ml²·θ̈ + ", ", friction neglected"
    assert kl.diagnose("single_link", "tau1", f"{front}½mgl·cosθ{behind}").agrees
    (cause,) = kl.diagnose("single_link", "tau1", f"{front}mgl·cosθ{behind}").causes
    assert cause.kinds == ("factor",)


def test_a_mass_is_no_mass_matrix() -> None:
    """Nor is it told as not judged what is judged."""
    front = "By the parallel axis theorem "
    told = kl.diagnose("single_link", "M11", f"{front}M = 1/12*m*l^2 + m*(l/2)^2 = 1/3*m*l^2.")
    assert told.agrees and not told.remarks
    assert kl.diagnose("single_link", "M11", "M = 2.5 kg: M11 = M*l^2/3").agrees
