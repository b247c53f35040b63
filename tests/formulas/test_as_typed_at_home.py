r"""Formulas with what their writers bring along: own commands, derivatives, indices, comments."""

import pytest

import kinlab as kl
from kinlab.errors import ExpressionError, KinlabError
from kinlab.formulas.signs.macros import written_out

_G1 = r"(m_1+m_2) g l_1 c_1 + m_2 g l_2 c_{12}"
_TAU2 = (
    r"m_2 l_2^2 (\ddot q_1 + \ddot q_2) + m_2 l_1 l_2 c_2 \ddot q_1 + m_2 l_1 l_2 s_2 \dot q_1^2"
    r" + m_2 g l_2 c_{12}"
)
_ENERGY = "1/2*(m1+m2)*l1^2*{w}1^2 + 1/2*m2*l2^2*({w}1+{w}2)^2 + m2*l1*l2*{w}1*({w}1+{w}2)*{f}(q2)"


def _agrees(robot: str, quantity: str, text: str) -> bool:
    return kl.diagnose(robot, quantity, text, samples=10).agrees


# -------- Own commands of LaTeX


@pytest.mark.parametrize(
    ("typed", "plain"),
    [
        (r"\newcommand{\q}{\theta} \ddot{\q}_1 + \cos\q_2", r"\ddot{\theta}_1 + \cos\theta_2"),
        (r"\renewcommand\m{m_2}\m l", r"m_2 l"),
        (r"\def\f#1#2{\frac{#1}{#2}} \f12 + \f{a}{b}", r"\frac{1}{2} + \frac{a}{b}"),
        (r"\newcommand{\v}[1]{\dot{#1}} \v q_1 + \v{\theta}_2", r"\dot{q}_1 + \dot{\theta}_2"),
        (r"\DeclareMathOperator{\atan}{atan2}\atan(y,x)", r"\operatorname{atan2}(y,x)"),
        (r"\def\x{a}\xy \x", r"\xy a"),
        (r"\newcommand{\s}{\sin}\s q_1", r"\sin q_1"),
    ],
)
def test_commands_are_written_out(typed: str, plain: str) -> None:
    assert written_out(typed, "p") == plain


@pytest.mark.parametrize(
    "typed",
    [
        r"\newcommand{\a}{\b}\newcommand{\b}{\a} \a",
        r"\newcommand{\a}{\a\a} \a",
        r"\newcommand{\a}{" + "x" * 500 + r"}" + r"\a" * 100,
    ],
)
def test_commands_without_end_are_refused(typed: str) -> None:
    with pytest.raises(ExpressionError, match="newcommand"):
        written_out(typed, "p")


@pytest.mark.parametrize("typed", [r"\newcommand{\x", r"\newcommand{\x}{", r"\def", r"\def\x"])
def test_what_is_no_command_stays(typed: str) -> None:
    assert written_out(typed, "p") == typed


def test_a_formula_with_commands_is_judged() -> None:
    head = r"\newcommand{\q}{\theta}\newcommand{\dd}[1]{\ddot{#1}} \tau_2 = "
    text = _TAU2.replace("q_", r"\q_").replace(r"\ddot \q_1", r"\dd{\q_1}")
    assert _agrees("planar2r", "inverse_dynamics[1]", head + text)
    assert not _agrees("planar2r", "inverse_dynamics[1]", head + text.replace("l_2^2", "l_2"))


# -------- Derivatives on the left, and names on the right


@pytest.mark.parametrize(
    ("robot", "quantity", "text"),
    [
        ("planar2r", "gravity_torques[0]", rf"\frac{{\partial V}}{{\partial q_1}} = {_G1}"),
        ("planar2r", "jacobian[0,1]", r"\frac{\partial x}{\partial q_2} = -l_2 s_{12}"),
        ("planar2r", "jacobian[0,1]", "dx/dq2 = -l2*s12"),
        (
            "planar2r",
            "com_jacobians[1,0,0]",
            r"\frac{\partial x_{c2}}{\partial\theta_1} = \frac{\partial}{\partial\theta_1}"
            r"\left(l_1 c_1 + l_2 c_{12}\right) = -l_1 s_1 - l_2 s_{12}",
        ),
        ("planar2r", "inverse_dynamics[1]", rf"{_TAU2} = \tau_2"),
        (
            "planar2r",
            "inverse_dynamics[1]",
            r"\frac{d}{dt}\left(\frac{\partial L}{\partial \dot q_2}\right)"
            rf" - \frac{{\partial L}}{{\partial q_2}} = \tau_2 = {_TAU2}",
        ),
    ],
)
def test_a_derivative_may_stand_in_front(robot: str, quantity: str, text: str) -> None:
    assert _agrees(robot, quantity, text)
    wrong = text.replace("l_2 s_{12}", "l_1 s_{12}").replace("l2*s12", "l1*s12")
    wrong = wrong.replace("l_2 c_{12}", "l_1 c_{12}") if wrong == text else wrong
    assert not _agrees(robot, quantity, wrong)


@pytest.mark.parametrize(
    ("quantity", "text"),
    [
        ("gravity_torques[0]", rf"\frac{{\partial V}}{{\partial q_2}} = {_G1}"),
        ("jacobian[0,1]", r"\frac{\partial y}{\partial q_2} = -l_2 s_{12}"),
        ("jacobian[0,1]", r"J_{12} = \frac{\partial x}{\partial q_1} = -l_2 s_{12}"),
        ("jacobian[0,1]", "∂y/∂q2 = -l2*s12"),
        (
            "com_jacobians[1,0,0]",
            r"\frac{\partial x_{c1}}{\partial\theta_1} = -l_1 s_1 - l_2 s_{12}",
        ),
    ],
)
def test_another_derivative_is_no_answer(quantity: str, text: str) -> None:
    with pytest.raises(KinlabError, match="which is another"):
        _agrees("planar2r", quantity, text)


# -------- Indices, rates, names


@pytest.mark.parametrize(
    ("robot", "quantity", "text"),
    [
        ("planar2r", "mass_matrix[0,1]", "m2*l2^2 + m2*l1*l2*cos(theta[2](t))"),
        ("planar2r", "kinetic_energy", f"T = {_ENERGY.format(w='w', f='cos')}"),
        ("planar2r", "kinetic_energy", f"T = {_ENERGY.format(w='omega', f='cos')}"),
        ("scara", "fk[0,1]", "R12 = sin(q1+q2-q4)"),
        ("scara", "fk[0,1]", "r_{12} = sin(q_1+q_2-q_4)"),
        ("planar2r_rods", "coriolis_torques[0]", "-m₂·l₁·l_c2·sin q₂·(2·q̇₁·q̇₂ + q̇₂²)"),
        ("planar2r", "gravity_torques[1]", r"\tau_{g,2} = m_2 g l_2 c_{12}"),
        ("planar2r", "gravity_torques", rf"\tau_{{g1}} = {_G1}, \tau_{{g2}} = m_2 g l_2 c_{{12}}"),
        (
            "planar2r",
            "gravity_torques[1]",
            r"\tau_2 = k_3 k_4 \cos(q_1+q_2) \text{ where } k_3 = 0.4,\ k_4 = 1.5\cdot 9.81",
        ),
        (
            "planar2r",
            "mass_matrix",
            "double c2 = cos(q[1]);\nM[0][0] = (m1+m2)*l1*l1 + m2*l2*l2 + 2*m2*l1*l2*c2;\n"
            "M[0][1] = m2*l2*(l2 + l1*c2);\nM[1][0] = M[0][1];\nM[1][1] = m2*l2*l2;",
        ),
        ("planar2r", "mass_matrix[1,1]", "M22 = m2*l2**2  # the outer link alone"),
        ("scara", "mass_matrix[2,2]", "m3 + m4 + 2.0  (2.0 kg from the rotor)"),
        (
            "stanford",
            "fk[2,3]",
            "pz = 0.412 + d3 cosθ2 + 0.263 (cosθ2 cosθ5 − sinθ2 sinθ4 sinθ5)",
        ),
        (
            "planar2r",
            "planar_pose[0]",
            r"**Pose:** $$x = l_1\cos\theta_1 + l_2\cos(\theta_1+\theta_2)$$",
        ),
        (
            "single_link",
            "inverse_dynamics",
            "(I + m*s^2)*phidd + m*g*s*cos(phi), s = l/2, I = m*l^2/12",
        ),
        ("spatial3r", "jacobian[2,2]", r"J_{33}=L_3\cos\theta_3"),
        (
            "planar2r_rods",
            "mass_matrix[0,0]",
            r"I_1 + I_2 + m_1 a_{c1}^2 + m_2\left(a_1^2 + a_{c2}^2 + 2 a_1 a_{c2} c_2\right)",
        ),
    ],
)
def test_what_can_be_read_in_one_way_alone(robot: str, quantity: str, text: str) -> None:
    assert _agrees(robot, quantity, text)


@pytest.mark.parametrize(
    ("quantity", "text"),
    [
        ("mass_matrix[0,1]", "m2*l2**2 + m2*l1*l2*cos(theta[2](t))"),
        ("kinetic_energy", "T = 1/2*(m1+m2)*l1^2*omega1^2 + 1/2*m2*l2^2*omega2^2"),
        ("fk[0,1]", "R21 = -sin(q1+q2)"),
        ("fk[0,3]", "l1*cos(q1) + l2*cos(q1+q2), in millimetres"),
        ("mass_matrix[1,1]", "m2*l2^2  (without the rotor)"),
        ("gravity_torques[0]", r"\tau_{g2} = m_2 g l_2 c_{12}"),
        ("mass_matrix[1,1]", "M22 = m2*l2**2  # wrong, should be I2 + m2*lc2**2"),
        ("lagrangian", f"{_ENERGY.format(w='qd', f='cos')} is the total energy"),
        ("inverse_dynamics[1]", rf"{_TAU2}. This is the torque of joint 1."),
        ("gravity_torques[1]", "g2 = m2*g*l2*cos(q1+q2), das ist nicht das gesuchte Moment"),
    ],
)
def test_what_may_be_another_is_refused(quantity: str, text: str) -> None:
    with pytest.raises(KinlabError):
        _agrees("planar2r", quantity, text)


@pytest.mark.parametrize("comment", ["# {}", "// {}", "/* {} */", "(* {} *)"])
@pytest.mark.parametrize("words", [0, 60])
def test_a_comment_is_read_to_its_end(comment: str, words: int) -> None:
    said = comment.format("as on the board " * words + "and its sign is wrong")
    with pytest.raises(KinlabError, match="may change"):
        _agrees("planar2r", "gravity_torques[1]", f"g2 = m2*g*l2*cos(q1+q2)  {said}")


_L = (
    "1/2*(m1+m2)*l1^2*dq1^2 + 1/2*m2*l2^2*(dq1+dq2)^2 + m2*l1*l2*dq1*(dq1+dq2)*cos(q2)"
    " - (m1+m2)*g*l1*sin(q1) - m2*g*l2*sin(q1+q2)"
)


@pytest.mark.parametrize(
    ("quantity", "text"),
    [
        ("lagrangian", f"L = T - V = {_L}, T is the kinetic energy"),
        ("gravity_torques[1]", "m2*g*l2*cos(q1+q2), the derivative of the potential energy"),
        ("inverse_dynamics[1]", rf"\tau_2 = {_TAU2}, the last term is the gravity torque"),
        ("mass_matrix[1,1]", "M22 = m2*l2^2, das ist das zweite Element der Massenmatrix"),
    ],
)
def test_words_of_its_terms_deny_nothing(quantity: str, text: str) -> None:
    assert _agrees("planar2r", quantity, text)
