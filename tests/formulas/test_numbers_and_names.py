r"""Numbers of equations, columns of names, names of matrices: ``x = ... (3.12)``, ``[τ1; τ2] =``."""

import pytest

import kinlab as kl
from kinlab.errors import ExpressionError

X = "l1*cos(q1) + l2*cos(q1+q2)"
LATEX = r"l_1\cos\theta_1 + l_2\cos(\theta_1+\theta_2)"
M = r"(m_1+m_2)l_1^2+m_2l_2^2+2m_2l_1l_2c_2 & d \\ d & m_2l_2^2".replace(
    "d", "m_2l_2^2+m_2l_1l_2c_2"
)
H = r"-m_2l_1l_2s_2(2\dot q_1\dot q_2+\dot q_2^2)\\ m_2l_1l_2s_2\dot q_1^2"
G = r"(m_1+m_2)l_1gc_1+m_2l_2gc_{12}\\ m_2l_2gc_{12}"
TAU = r"\begin{bmatrix}\tau_1\\ \tau_2\end{bmatrix}"
J = r"-l_1s_1-l_2s_{12} & -l_2s_{12}\\ l_1c_1+l_2c_{12} & l_2c_{12}"


def boxed(rows):
    return rf"\begin{{bmatrix}}{rows}\end{{bmatrix}}"


RATES = r"\ddot q_1\\ \ddot q_2"
MOTION = rf"{boxed(M)}{boxed(RATES)}+{boxed(H)}+{boxed(G)}"
IN_MATLAB = """M = [(m1+m2)*l1^2+m2*l2^2+2*m2*l1*l2*c2, m2*l2^2+m2*l1*l2*c2; m2*l2^2+m2*l1*l2*c2, m2*l2^2];
C = [-m2*l1*l2*s2*qd2, -m2*l1*l2*s2*(qd1+qd2); m2*l1*l2*s2*qd1, 0];
G = [(m1+m2)*g*l1*c1+m2*g*l2*c12; m2*g*l2*c12];
tau = M*qdd + C*qd + G"""
STACKED = """Jv = [-l1*s1-l2*s12, -l2*s12; l1*c1+l2*c12, l2*c12; 0, 0];
Jw = [0, 0; 0, 0; 1, 1];
J = [Jv; Jw]"""


def told(robot, quantity, text):
    return kl.diagnose(robot, quantity, text)


@pytest.mark.parametrize(
    "behind",
    [
        "      (3.12)", "   (2)", "  [3.12]", ", (3)", " …… (3-12)", " --- (3)", " (*)", " (ii)",
        "  (4b)", "   (A.3)", "    （3.12）", "    (式2-3)", " ①", " ✓",
    ],
)  # fmt: skip
def test_the_number_of_an_equation_is_no_factor(behind):
    found = told("planar2r", "x", f"x = {X}{behind}")
    assert found.agrees and not found.remarks
    wrong = told("planar2r", "x", f"x = {X.replace('+ l2', '- l2')}{behind}")
    assert "should be + l2" in wrong.causes[0].sentence


@pytest.mark.parametrize("behind", [" (3.12)", " (2)", "(2)", " [12]"])
def test_of_one_close_behind_it_is_said_how_it_is_read(behind):
    found = told("planar2r", "x", f"x = {X}{behind}")
    assert found.agrees
    assert found.remarks == (f"{behind.strip()} behind it is read as the number of an equation, not as a factor",)  # fmt: skip


@pytest.mark.parametrize(
    "behind",
    [
        r" \qquad (3.12)", r"\quad (4)", r"\quad\quad (3-12)", r"\; (3.12)", r" \; (3.12)", r"\hfill (3.12)",
        r" \eqno(3.12)", r" \cdots (5)", r"\tag{3.12}",
    ],
)  # fmt: skip
def test_so_it_is_in_latex(behind):
    assert told("planar2r", "x", f"x = {LATEX}{behind}").agrees


def test_in_a_matrix_no_equation_has_a_number():
    twice = M.replace(
        r"2m_2l_1l_2c_2 & m_2l_2^2+m_2l_1l_2c_2", "2m_2l_1l_2c_2 & m_2l_2(l_2+l_1c_2)(2)"
    )
    assert twice != M
    found = told("planar2r", "mass_matrix", f"M = {boxed(twice)}")
    assert not found.agrees and "factor (2)" in found.causes[0].sentence


@pytest.mark.parametrize("front", ["* ", "• ", "① ", "(b) "])
def test_the_sign_of_an_item_is_none_of_the_formula(front):
    assert told("planar2r", "x", f"{front}x = {X}").agrees


def test_a_dash_in_front_is_a_list_s_or_a_minus():
    for entry, text in (("x", f"- x = {X}"), ("J11", "- J11 = l1*s1 + l2*s12")):
        with pytest.raises(ExpressionError, match="a dash in front"):
            told("planar2r", entry, text)
    assert told("planar2r", "J11", "-J11 = l1*s1 + l2*s12").agrees
    both = "- g1 = (m1+m2)*l1*g*c1 + m2*l2*g*c12\n- g2 = m2*l2*g*c12"
    assert told("planar2r", "gravity_torques", both).agrees


def test_a_sum_that_goes_on_with_a_minus_keeps_it():
    inertia = "((m1+m2)*l1^2 + m2*l2^2 + 2*m2*l1*l2*c2)*qdd1 + (m2*l2^2 + m2*l1*l2*c2)*qdd2"
    lines = f"h = m2*l1*l2*s2*(2*qd1*qd2 + qd2^2)\n{inertia} + (m1+m2)*g*l1*c1 + m2*g*l2*c12\n - h = tau1"
    assert told("planar2r", "tau1", lines).agrees
    assert not told("planar2r", "tau1", lines.replace("- h", "+ h")).agrees


def test_a_factor_in_parentheses_stays_one():
    assert told("planar2r", "M22", "M22 = m2*l2^2*(2)/2").agrees
    assert not told("planar2r", "M22", "M22 = m2*l2^2*(2)").agrees


def test_each_line_has_its_number():
    lines = "g1 = (m1+m2)*l1*g*c1 + m2*l2*g*c12   (3.12)\ng2 = m2*l2*g*c12   (3.13)"
    assert told("planar2r", "gravity_torques", lines).agrees


@pytest.mark.parametrize("text", [f"{MOTION} = {TAU}", f"{TAU} = {MOTION}"])
def test_torques_may_stand_in_a_column_on_either_side(text):
    assert told("planar2r", "inverse_dynamics", text).agrees
    for old, new in (("2m_2l_1l_2c_2", "m_2l_1l_2c_2"), (r"gc_{12}\end", r"gs_{12}\end")):
        found = told("planar2r", "inverse_dynamics", text.replace(old, new))
        assert len(found.causes) == 1, found.causes


def test_torques_in_another_order_are_not_taken_for_right():
    with pytest.raises(ExpressionError, match="tau2"):
        told("planar2r", "inverse_dynamics", f"{MOTION} = {TAU}".replace("_1\\\\ \\tau_2", "_2\\\\ \\tau_1"))  # fmt: skip


def test_the_rates_of_the_tool_tell_a_jacobian():
    joints = boxed(r"\dot\theta_1\\ \dot\theta_2")
    right, left = r"\dot x\\ \dot y", r"\dot y\\ \dot x"
    assert told("planar2r", "planar_jacobian", f"{boxed(right)} = {boxed(J)}{joints}").agrees
    for tool, turned in ((left, joints), (right, boxed(r"\dot q_2\\ \dot q_1"))):
        with pytest.raises(ExpressionError):
            told("planar2r", "planar_jacobian", f"{boxed(tool)} = {boxed(J)}{turned}")


def test_matrices_stand_where_they_are_named():
    assert told("planar2r", "inverse_dynamics", IN_MATLAB).agrees
    for old, new in (("s2*qd1, 0", "c2*qd1, 0"), ("2*m2*l1*l2*c2", "m2*l1*l2*c2")):
        assert told("planar2r", "inverse_dynamics", IN_MATLAB.replace(old, new)).causes
    assert not told("planar2r", "inverse_dynamics", IN_MATLAB.replace("M*qdd + C*qd", "M*qdd - C*qd")).agrees  # fmt: skip
    named = rf"\tau = M(q)\ddot q + h + g(q), \quad M(q) = {boxed(M)}, \quad h = {boxed(H)}, \quad g(q) = {boxed(G)}"
    assert told("planar2r", "inverse_dynamics", named).agrees


@pytest.mark.parametrize("whole", ["[Jv; Jw]", "np.vstack((Jv, Jw))", "np.concatenate([Jv, Jw])"])
def test_matrices_stand_one_below_the_other(whole):
    text = STACKED.replace("[Jv; Jw]", whole)
    found = told("planar2r", "jacobian", text)
    assert found.agrees and not found.remarks
    (cause,) = told("planar2r", "jacobian", text.replace("l2*c12; 0", "l2*s12; 0")).causes
    assert cause.sentence.startswith("J22: s12 should be c12")
    assert not told("planar2r", "jacobian", text.replace("Jv; Jw", "Jw; Jv").replace("Jv, Jw", "Jw, Jv")).agrees  # fmt: skip


def test_a_product_of_arrays_entry_by_entry_is_none_of_matrices():
    given = """M = np.array([[(m1+m2)*l1**2+m2*l2**2+2*m2*l1*l2*c2, m2*l2**2+m2*l1*l2*c2],
              [m2*l2**2+m2*l1*l2*c2, m2*l2**2]])
h = np.array([(m1+m2)*g*l1*c1+m2*g*l2*c12-m2*l1*l2*s2*(2*qd1*qd2+qd2**2),
              m2*g*l2*c12+m2*l1*l2*s2*qd1**2])
tau = M @ qdd + h"""
    assert told("planar2r", "inverse_dynamics", given).agrees
    with pytest.raises(ExpressionError, match="write @"):
        told("planar2r", "inverse_dynamics", given.replace("M @ qdd", "M * qdd"))


def test_a_matrix_may_stand_turned():
    given = "J = [-l1*s1-l2*s12, -l2*s12; l1*c1+l2*c12, l2*c12];\ntau = J'*[fx; fy]"
    assert told("planar2r", "statics", given).agrees
    assert not told("planar2r", "statics", given.replace("J'*", "J*")).agrees


def test_entries_of_a_row_may_be_sums_apart_by_blanks():
    text = "M = [(m1+m2)*l1^2+m2*l2^2+2*m2*l1*l2*cos(q2) M12; M12 m2*l2^2]"
    assert told("planar2r", "mass_matrix", f"M12 = m2*l2^2 + m2*l1*l2*cos(q2);\n{text}").agrees


@pytest.mark.parametrize("angle", [r"\varphi", r"\phi"])
def test_phi_with_rates_is_a_joint_s_angle(angle):
    text = (
        r"\tau_2 = m_2l_2^2(\ddot Q_1+\ddot Q_2) + m_2l_1l_2\cos Q_2\ddot Q_1"
        r" + m_2l_1l_2\sin Q_2\dot Q_1^2 + m_2gl_2\cos(Q_1+Q_2)"
    ).replace("Q", angle)
    assert told("planar2r", "tau2", text).agrees
    plain = "m2*l2^2*(phidd1+phidd2) + m2*l1*l2*cos(phi2)*phidd1 + m2*l1*l2*sin(phi2)*phid1^2"
    assert told("planar2r", "tau2", f"tau2 = {plain} + m2*g*l2*cos(phi1+phi2)").agrees


def test_accelerations_may_be_given_one_by_one():
    text = """d11 = (m1+m2)*l1^2 + m2*l2^2 + 2*m2*l1*l2*c2
d12 = m2*l2^2 + m2*l1*l2*c2
d22 = m2*l2^2
b1 = tau1 + m2*l1*l2*s2*(2*qd1*qd2 + qd2^2) - (m1+m2)*g*l1*c1 - m2*g*l2*c12
b2 = tau2 - m2*l1*l2*s2*qd1^2 - m2*g*l2*c12
det = d11*d22 - d12^2
qdd1 = (d22*b1 - d12*b2)/det
qdd2 = (d11*b2 - d12*b1)/det"""
    assert told("planar2r", "forward_dynamics", text).agrees
    assert not told("planar2r", "forward_dynamics", text.replace("- d12*b1", "+ d12*b1")).agrees


def test_one_entry_of_a_whole_is_not_taken_for_it():
    with pytest.raises(ExpressionError, match="write it as a matrix, or ask for one entry"):
        told("planar2r", "fk", f"x = {X}\ny = {X.replace('cos', 'sin')}")
