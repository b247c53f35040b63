"""Formulas as they are handed in: units, words, code and dress around them are no part of them."""

from __future__ import annotations

import pytest

import kinlab as kl
from kinlab.errors import ExpressionError
from kinlab.formulas.files import formula_file

X = "l1*c1 + l2*c12"
LATEX = r"l_1 c_1 + l_2 c_{12}"
G2 = "m2*g*l2*c12"
TAU2 = "m2*l2^2*({a1}+{a2}) + m2*l1*l2*c2*{a1} + m2*l1*l2*s2*{v1}^2 + m2*g*l2*cos(q1+q2)"
M11 = "1.115 + 0.6*cos(q2)"
V = "(m1+m2)*g*l1*s1 + m2*g*l2*s12"


def right(robot, entry, text):
    found = kl.diagnose(robot, entry, text)
    assert found.agrees, f"{text}\n{found}"
    return found


def refused(robot, entry, text, said="."):
    with pytest.raises(ExpressionError, match=said):
        kl.diagnose(robot, entry, text)


# -------- Units


@pytest.mark.parametrize(
    ("entry", "text"),
    [
        ("x", rf"x = {LATEX}\ \text{{m}}"), ("x", rf"${LATEX} \text{{ m}}$"), ("y", "l1*s1 + l2*s12 (m)"),
        ("x", f"x = {X} (in m)"), ("x", f"x = {X} [m]"), ("x", f"x = {X} m"), ("x", f"x = {X}, [x] = m"),
        ("x", rf"{LATEX}\,\mathrm{{m}}, \quad l_1 = 0.5\,\mathrm{{m}}"),
        ("M11", r"M_{11} = 1.115 + 0.6\cos\theta_2\ \mathrm{kg\,m^2}"), ("M11", f"{M11} kg m^2"),
        ("M11", "M11 = 1.115 + 0.6 cos θ2 kg·m²"), ("M11", f"({M11}) kg*m^2"), ("M11", f"{M11} (kg m^2)"),
        ("M22", "0.24 kg m^2"), ("M22", r"0.24\ \text{kg}\cdot\text{m}^2"), ("C12", "-0.3*s2*(qd1+qd2) Nms"),
        ("g2", f"{G2} N m"), ("g2", f"{G2} (N m)"), ("g2", f"{G2} kg m^2/s^2"),
        ("V", "17.1675*(1+s1) + 5.886*(1+s12) J"), ("V", "17.1675*s1 + 5.886*s12 (J)"),
        ("x", f"x = {X}, l1 = 0.5 m, l2 = 0.4 m"), ("x", f"x = {X}, l1 = 50 cm, l2 = 400 mm"),
        ("x", rf"{LATEX}, \quad l_1 = 50\,\text{{cm}}"), ("x", "50 cm * cos q1 + 40 cm * cos(q1+q2)"),
        ("x", r"50\,\mathrm{cm}\,c_1 + 40\,\mathrm{cm}\,c_{12}"), ("x", "0.5 m * cos(q1) + 0.4 m * cos(q1+q2)"),
        ("g2", f"{G2}, m2 = 1500 g, g = 9.81 m/s^2"), ("g2", f"{G2}, m2 = 1.5 kg"),
        ("x", "l1*cos(q1 + 0 deg) + l2*cos(q1 + q2)"),
    ],
)  # fmt: skip
def test_units_are_left_out_or_converted(entry, text):
    right("planar2r", entry, text)


@pytest.mark.parametrize(
    "unit", ["[cm]", "(in cm)", "cm", r"\ \text{cm}", r"\,\mathrm{mm}", "(mm)"]
)
def test_a_formula_in_another_unit_is_refused_with_the_remedy(unit):
    refused("planar2r", "x", rf"x = 50 c_1 + 40 c_{{12}} {unit}", "SI units")


@pytest.mark.parametrize(
    ("entry", "text"),
    [
        ("g2", f"{G2} (m)"), ("g2", r"m_2 g l_2 c_{12}\,\mathrm{m}"), ("g2", f"{G2}, l2 = 0.4 kg"),
        ("M22", "0.24 m"), ("x", f"m*{X} m"), ("g2", f"{G2}, m2 = 1.5 m"), ("T", "0.24 N"),
    ],
)  # fmt: skip
def test_a_unit_that_may_be_a_name_or_is_another_stays(entry, text):
    refused("planar2r", entry, text)


def test_a_mass_in_the_middle_is_no_unit():
    assert kl.diagnose("single_link", "V", "h = 0.5 m; V = h*g*l*sin(q)").agrees
    found = kl.diagnose("single_link", "g1", "0.5*m*g*l*cos(q)")
    assert found.agrees
    assert not kl.diagnose("planar2r", "g2", "1500 g * l2*c12").agrees  # no gram


# -------- LaTeX as it is dressed


@pytest.mark.parametrize(
    ("entry", "text"),
    [
        ("x", rf"\boxed{{x = {LATEX}}}"), ("x", rf"x = \boxed{{{LATEX}}}"), ("x", rf"$$\boxed{{x = {LATEX}}}$$"),
        ("x", rf"\color{{red}}{{x = {LATEX}}}"), ("x", rf"x = \textcolor{{blue}}{{{LATEX}}}"),
        ("x", rf"\therefore x = {LATEX}"), ("x", rf"\Rightarrow\ x = {LATEX}"), ("x", f"=> x = {X}"), ("x", f"∴ x = {X}"),
        ("x", rf"\begin{{eqnarray}} x &=& {LATEX}\end{{eqnarray}}"),
        ("x", r"\begin{eqnarray*} x & = & l_1 c_1 \\ & & + l_2 c_{12}\end{eqnarray*}"),
        ("x", r"\nicefrac{1}{2}\,c_1 + \sfrac{2}{5} c_{12}"), ("x", r"{1\over 2}c_1 + {2 \over 5}c_{12}"),
        ("x", rf"x = {LATEX}\,."), ("x", rf"x = {LATEX}~."), ("x", rf"x = {LATEX}\;,"),
        ("x", r"l_1 c\theta_1 + l_2 c(\theta_1+\theta_2)"), ("x", r"l_1 C\theta_1 + l_2 C\theta_{12}"),
        ("x", r"l_1 c(\theta_1) + l_2 c\left(\theta_1+\theta_2\right)"), ("x", "l1*c(q1) + l2*c(q1+q2)"),
        ("x", r"l_1 \cos_1 + l_2 \cos_{12}"), ("y", r"l_1 \sin_1 + l_2 \sin_{12}"), ("x", "l1*cos1 + l2*cos12"),
        ("g", r"\vec{g} = \begin{Bmatrix} 17.1675 c_1 + 5.886 c_{12} \\ 5.886 c_{12} \end{Bmatrix}"),
        ("g", r"\boldsymbol{g} = \begin{bmatrix} 17.1675 c_1 + 5.886 c_{12} \\ 5.886 c_{12} \end{bmatrix}"),
        ("L", r"\mathcal L = \tfrac12 (m_1+m_2) l_1^2\dot q_1^2 + \tfrac12 m_2 l_2^2(\dot q_1+\dot q_2)^2"
              r" + m_2 l_1 l_2 c_2 \dot q_1(\dot q_1+\dot q_2) - (m_1+m_2) g l_1 s_1 - m_2 g l_2 s_{12}"),
        ("L", r"L = T - V = \frac12 (m_1+m_2) l_1^2\dot q_1^2 + \frac12 m_2 l_2^2(\dot q_1+\dot q_2)^2"
              r" + m_2 l_1 l_2 c_2 \dot q_1(\dot q_1+\dot q_2) - (m_1+m_2) g l_1 s_1 - m_2 g l_2 s_{12}"),
        ("tau2", r"\Gamma_2 = m_2l_2^2(\ddot q_1+\ddot q_2)+m_2l_1l_2c_2\ddot q_1+m_2l_1l_2s_2\dot q_1^2+m_2gl_2c_{12}"),
        ("det", r"\begin{vmatrix} -l_1 s_1 - l_2 s_{12} & -l_2 s_{12} \\ l_1 c_1 + l_2 c_{12} & l_2 c_{12} \end{vmatrix}"),
        ("det", r"\left|\begin{matrix} -l_1 s_1 - l_2 s_{12} & -l_2 s_{12} \\ l_1 c_1 + l_2 c_{12} & l_2 c_{12} \end{matrix}\right|"),
        ("det", r"\left|\mathbf{J}\right| = l_1 l_2 (s_{12}c_1 - c_{12}s_1) = l_1l_2s_2"),
        ("det", r"\det(J) = (-l_1s_1-l_2s_{12})l_2c_{12} + l_2s_{12}(l_1c_1+l_2c_{12}) = l_1l_2s_2"),
        ("M", r"\begin{bmatrix} 1.115+0.6c_2 & 0.24+0.3c_2 \\ \ast & 0.24 \end{bmatrix}"),
        ("M", r"\begin{bmatrix} 1.115+0.6c_2 & \star \\ 0.24+0.3c_2 & 0.24 \end{bmatrix}"),
    ],
)  # fmt: skip
def test_what_only_looks_is_left_out(entry, text):
    right("planar2r", entry, text)


COLUMN = rf"\begin{{bmatrix}} x \\ y \end{{bmatrix}} = \begin{{bmatrix}} {LATEX} \\ l_1 s_1 + l_2 s_{{12}} \end{{bmatrix}}"
BRACE = (
    rf"\left\{{\begin{{array}}{{l}} x = {LATEX} \\ y = l_1 s_1 + l_2 s_{{12}}\end{{array}}\right."
)
TORQUES = (
    r"\begin{bmatrix}\tau_1\\\tau_2\end{bmatrix} = \begin{bmatrix}(m_1+m_2) g l_1 c_1 + m_2 g l_2 c_{12}"
    r"\\ m_2 g l_2 c_{12}\end{bmatrix}"
)


@pytest.mark.parametrize("entry", ["x", "y"])
def test_of_a_column_the_entry_s_line(entry):
    for text in (COLUMN, BRACE, COLUMN.replace("x \\", "p_x \\").replace("y \\", "p_y \\")):
        right("planar2r", entry, text)


def test_a_column_of_the_whole():
    right("planar2r", "g", TORQUES.replace(r"\tau", "g"))
    file = formula_file({"robot": "planar2r", "formulas": {"tau": TORQUES}}, "f.toml")
    assert list(file.formulas) == ["tau1", "tau2"]


@pytest.mark.parametrize(
    ("entry", "text"),
    [
        ("x", r"1\over 2 c_1 + 0.4 c_{12}"), ("x", r"l_1 c(\theta_1) + c l_2 c_{12}"),
        ("M", r"\begin{vmatrix} 1 & 2 \\ 3 & 4 \end{vmatrix}"), ("J", r"\begin{bmatrix} 1 & \ast \\ 1 & 1 \end{bmatrix}"),
        ("x", r"l_1 C(q_1) + l_2 c_{12}"), ("g2", r"\Gamma_2 = m_2 g l_2 c_{12} + \Gamma_1"),
        ("x", r"l_1 \cos^{-1} q_1"), ("x", r"\begin{bmatrix}a\\b\end{bmatrix} = \begin{bmatrix}l_1\\l_2\end{bmatrix}"),
    ],
)  # fmt: skip
def test_dress_that_may_mean_something_is_refused(entry, text):
    refused("planar2r", entry, text)


# -------- Words


@pytest.mark.parametrize(
    "text",
    [
        rf"末端的 x 坐标为 $x = {LATEX}$", f"末端x坐标：x = {X}", f"末端x坐标 = {X}", f"x坐标为：x = {X}",
        f"x = {X}，其中 l1、l2 为杆长", rf"x = {LATEX}，\text{{其中}}\theta_1,\theta_2\text{{为关节角}}",
        f"x = {X}，式中 q1、q2 分别为关节角，l1 = 0.5", r"由几何关系 $x = l_1 c_1 + h$，其中 $h = l_2 c_{12}$",
        f"x = {X}, dabei ist q1 der Winkel des ersten Gelenks", f"Damit folgt: x = {X}", f"Es gilt x = {X}",
        rf"x = {LATEX} \quad\text{{mit}}\quad l_1 = 0.5\,\text{{m}}", f"x = {X}, wobei l1 die Länge des ersten Glieds ist",
        f"x = {X}, where q1 and q2 are the joint angles", f"x = {X} where l1, l2 are the link lengths",
        f"x = {X} where c12 denotes cos(q1+q2)", f"x = {X} with c1 = cos(q1) etc.",
        f"The x coordinate of the tool is x = {X}", f"Therefore x = {X}", f"Answer: x = {X}", f"x: {X}",
        "x = l1*c1 + h, where q1 is the joint angle and h = l2*c12",
    ],
)  # fmt: skip
def test_words_around_a_formula_are_left_out(text):
    right("planar2r", "x", text)


@pytest.mark.parametrize(
    ("entry", "text"),
    [
        ("g2", f"关节2力矩：g2 = {G2}"), ("g2", f"重力项 g2 = {G2}"), ("g2", f"Gravity torque: g_2 = {G2}"),
        ("V", f"Potential energy V = {V}"), ("V", f"势能 V = {V}"), ("V", f"Potentielle Energie: V = {V}"),
        ("T", r"动能 T = \frac12 m_1 l_1^2\omega_1^2 + \frac12 m_2[l_1^2\omega_1^2 + l_2^2(\omega_1+\omega_2)^2"
              r" + 2l_1l_2\omega_1(\omega_1+\omega_2)\cos q_2]，其中 \omega_1=\dot q_1, \omega_2=\dot q_2"),
    ],
)  # fmt: skip
def test_words_in_front_of_other_entries(entry, text):
    right("planar2r", entry, text)


@pytest.mark.parametrize(
    "text",
    [
        f"x = {X}, where q2 is the angle of the second link", f"x = {X}, where q1 is measured from the vertical",
        f"x = {X}，其中 q1 为与竖直方向的夹角", f"x = {X}, where l1 is the distance to the centre of mass",
        f"x = {X}, wobei q1 der Winkel zur Senkrechten ist", f"x = {X}, where q1 is in degrees", f"x = {X}，q1为角",
    ],
)  # fmt: skip
def test_words_that_may_change_a_meaning_are_refused(text):
    refused("planar2r", "x", text)


M22 = "I2 + m2*lc2^2"


@pytest.mark.parametrize(
    ("entry", "text"),
    [
        ("x", f"x = {X}, where q2 is the angle of link 2 relative to link 1"),
        ("x", f"x = {X}, where l1 and l2 are the link lengths and q2 is the angle between link 1 and link 2"),
        ("x", f"x = {X}，其中 θ2 是连杆2相对连杆1的转角"), ("M22", f"M22 = {M22}, with I2 about the centre of mass"),
        ("M22", f"M22 = {M22}, mit I2 bezüglich des Schwerpunkts"),
        ("M22", f"M22 = {M22} where $l_{{c2}}$ is the distance from joint 2 to the centre of mass of link 2"),
        ("M22", f"M22 = {M22}, where lc2 is the distance of the center of mass of link 2 from joint 2."),
    ],
)  # fmt: skip
def test_what_a_name_means_anyway_says_nothing(entry, text):
    found = kl.diagnose("planar2r_rods", entry, text)
    assert found.agrees
    assert not found.remarks


@pytest.mark.parametrize(
    "clause",
    [
        "where q2 is the angle of link 2 relative to link 1 in degrees", "where q2 is the angle of link 2 relative to link 2",
        "where q2 is the angle of link 2 relative to the base", "where q1 is the angle of link 1 relative to link 2",
        "where l2 is the distance from joint 2 to the centre of mass of link 2",
    ],
)  # fmt: skip
def test_what_it_means_with_another_number_is_refused(clause):
    refused("planar2r", "x", f"x = {X}, {clause}")


@pytest.mark.parametrize(
    "clause", ["lc2 is half of l2", "where lc2 is half of l2", "where lc2 equals half of l2"]
)
def test_a_share_that_a_centre_s_name_is_said_to_be_is_told(clause):
    """On this arm the centre is at the end of the link."""
    found = kl.diagnose("planar2r", "M22", f"M22 = m2*lc2^2, {clause}")
    assert any("lc2" in str(one) for one in found.remarks), str(found)


@pytest.mark.parametrize(
    "clause",
    [
        "I2 um das Gelenk", "wobei I2 bezüglich der Drehachse", "I2 about the joint", "其中 I2 为绕关节的转动惯量",
        "with l1 and l2 in cm", "Längen in Millimetern", "长度单位为毫米",
    ],
)  # fmt: skip
def test_another_point_and_other_units_are_not_passed_over(clause):
    try:
        found = kl.diagnose("planar2r_rods", "M22", f"M22 = {M22}, {clause}")
    except kl.KinlabError:
        return
    assert found.remarks, str(found)


@pytest.mark.parametrize(
    ("robot", "entry", "text"),
    [
        ("spatial3r", "J33", r"Bis auf das Vorzeichen gilt J_{33} = x_t \cos\theta_3."),
        ("spatial3r", "J33", r"相差一个符号：J_{33} = x_t \cos\theta_3"),
        ("spatial3r", "x", "x = (a1*c1 + a2*c12) + xt*c12*c3, where xt is the distance of the tool from joint 2"),
        ("planar2r", "M22", "M22 = m2*l2^2, where m2 is the mass of both links together"),
        ("isotropic", "loop1", "(x - e - l1*cos(theta1))^2 + (y - l1*sin(theta1))^2 = l2^2, with e the full distance"),
    ],
)  # fmt: skip
def test_what_makes_it_another_claim_is_not_passed_over(robot, entry, text):
    try:
        found = kl.diagnose(robot, entry, text)
    except kl.KinlabError:
        return
    assert found.remarks, str(found)


SPEED = r"l_1^2\dot\theta_1^2 + l_2^2(\dot\theta_1+\dot\theta_2)^2 + 2l_1l_2c_2\dot\theta_1(\dot\theta_1+\dot\theta_2)"


@pytest.mark.parametrize(
    ("robot", "entry", "text"),
    [
        ("planar2r", "tip_speed_squared", f"末端速度的平方为 v^2 = {SPEED}"), ("planar2r", "tip_speed_squared", f"v_e^2 = {SPEED}"),
        ("planar3r", "planar_angle", "φ = θ₁ + θ₂ + θ₃ (orientation of the hand, in rad)"),
        ("isotropic", "servo_ratio", r"减速比的上限：$j = \frac{\pi N_{\max}}{30\,\dot{\Theta}_{\max}}$"),
        ("scara", "M33", r"第三轴（移动关节）的惯量：M_{33} = m_3 + m_4 + I_{a3}"),
        ("plotclock", "fivebar_equation[0,2]", "Leg 1: A cos θ + B sin θ = C with C = l2² − l1² − e² − x² − y² + 2 e x"),
        ("planar2r_rods", "mass_matrix",
         r"\[ M(q) = \begin{bmatrix} \alpha + 2\beta\cos\theta_2 & \delta + \beta\cos\theta_2 \\ "
         r"\delta + \beta\cos\theta_2 & \delta \end{bmatrix} \] where $\alpha = I_1 + I_2 + m_1 l_{c1}^2 + "
         r"m_2(l_1^2 + l_{c2}^2)$, $\beta = m_2 l_1 l_{c2}$, $\delta = I_2 + m_2 l_{c2}^2$."),
        ("planar2r", "x", "% the position of the hand, cf. Paul (1981)\nx = l1*c1 + l2*c12"),
        ("isotropic", "fivebar_rates[0]",
         r"u_x = \cos\theta_1, u_y = \sin\theta_1, w_x = (x - e - l_1\cos\theta_1)/l_2, w_y = (y - l_1\sin\theta_1)/l_2"
         "\n" r"$$\dot\theta_1 = \frac{\dot x w_x + \dot y w_y}{l_1 (u_x w_y - u_y w_x)}$$"),
        ("planar2r", "x", "x = hypot(0.3, 0.4)*c1 + l2*c12"),
    ],
)  # fmt: skip
def test_squares_angles_and_definitions_are_read_by_their_names(robot, entry, text):
    found = right(robot, entry, text)
    assert not any("not read" in str(one) for one in found.remarks), str(found)


def test_of_numbers_alone_the_one_that_becomes_the_robot_s_own_is_told():
    found = kl.diagnose("spatial3r", "M33", "M33 = 0.014 + 1.2*(0.12^2 + 0.01^2)")
    assert "0.01 should be 0.03" in str(found)


@pytest.mark.parametrize(
    ("entry", "text"),
    [
        ("V", "With zero gravity, V = 0"), ("M22", "For uniform rods M22 = m2*l2^2/3"), ("M22", "质心位于中点，M22 = m2*l2^2/4"),
        ("x", "With both links level x = l1 + l2"), ("tau1", "Im Gleichgewicht gilt tau1 = 0"), ("x", "在对称位置 x = 0"),
        ("planar_position_determinant", r"In gestreckter Lage ist \det J = 0"),
    ],
)  # fmt: skip
def test_what_is_right_under_its_words_is_not_called_wrong(entry, text):
    refused("planar2r", entry, text)


def test_the_refused_words_are_said_with_the_remedy():
    text = f"x = {X}, where q1 is measured from the vertical"
    refused("planar2r", "x", text, r"measured from the vertical.*leave it out")


SHOWN = "of what it is"
SENTENCES = [
    f"Differentiating and collecting terms, we find x = {X}. Done.", f"Q3b) So we get: x = {X}", rf"(c) Hence ${LATEX}$",
    f"By the law of cosines and the addition theorem x = {X}, which is the x coordinate of the tool.",
    "With h = l2*c12 the x coordinate is x = l1*c1 + h, in metres", f"x = {X}; it vanishes for q1 = pi/2 and q2 = 0",
    "l1*cos(q1) + l2*cos(q1+q2)，当 q1 = 0 时最大", "the coordinate is l1*cos(q1) + l2*cos(q1+q2), largest if q1 = 0 and q2 = 0",
    r"Let $h = l_2 c_{12}$ \text{ and therefore } $x = l_1 c_1 + h$", f"Using cos(a) = cos(-a) we get x = {X}",
    "Therefore\n\\begin{align}\nx &= l_1 c_1 \\\\\n &\\quad + l_2 c_{12}\n\\end{align}", f"x = {X} (since q1 turns both links)",
    f"由几何关系可得：x = {X}。", rf"代入化简后，末端横坐标为 $x = {LATEX}$，单位为米", f"Somit folgt für den Endeffektor x = {X}, sie hängt von beiden Winkeln ab.",
]  # fmt: skip


@pytest.mark.parametrize("text", SENTENCES)
def test_a_formula_in_sentences_is_read(text):
    right("planar2r", "x", text)


@pytest.mark.parametrize("text", SENTENCES[:5])
def test_a_slip_in_sentences_is_told(text):
    found = kl.diagnose("planar2r", "x", text.replace("c12", "s12").replace("c_{12}", "s_{12}"))
    assert found.known and "s" in found.sentence


@pytest.mark.parametrize(
    ("entry", "text"),
    [
        ("x", "At the upright pose $x = l_1$"), ("x", "In the stretched pose: x = l1 + l2"), ("x", "x = l1*c1  # of the elbow"),
        ("x", "The elbow has $x = l_1\\cos q_1$"), ("x", "x coordinate of joint 2: x = l1*c1"), ("x", "x_elbow = l1*c1"),
        ("x", r"x = l_1 + l_2 \quad \text{for the stretched arm}"), ("x", "With the arm nearly straight we get $x = l_1 + l_2$"),
        ("x", "x = l1 + l2, stretched out"), ("x", "We look at the stretched arm.\nx = l1 + l2"),
        ("tau2", f"neglecting the motion, tau2 = {G2}"), ("tau2", f"static torque tau2 = {G2}"), ("tau2", f"The gravity term is tau2 = {G2}"),
        ("tau1", f"Torque at joint 2: tau1 = {G2}"), ("V", "Potential energy of link 1: V = m1*g*l1*s1"),
        ("x", "当机械臂伸直时 x = l1 + l2"), ("x", "肘部的坐标 x = l1*cos(q1)"), ("x", "In Streckstellung gilt $x = l_1 + l_2$"),
        ("x", "x = l1 + l2; it holds for q1 = 0"), ("g2", f"对于连杆1: g2 = {G2}*2"),
    ],
)  # fmt: skip
def test_what_words_may_condition_is_not_judged(entry, text):
    refused("planar2r", entry, text, SHOWN)


@pytest.mark.parametrize(
    ("text", "said"),
    [
        (f"Whatever the elbow does, x = {X.replace('c12', 's12')}", "sin/cos"), (f"手臂任意摆放: x = {X.replace('+', '-')}", "sign"),
        (f"The elbow's own axis is irrelevant: x = {X.replace('+', '-')}", ""), ("Whatever the elbow does, x = l1*c1 + l2*c2", ""),
    ],
)  # fmt: skip
def test_a_slip_that_is_no_special_case_is_told_beside_any_words(text, said):
    """But a sign may be of another axis, and c2 for c12 may be of q1 = 0."""
    if said:
        assert said in kl.diagnose("planar2r", "x", text).sentence
    else:
        refused("planar2r", "x", text, SHOWN)


@pytest.mark.parametrize(
    ("entry", "text"),
    [("g2", f"on the ceiling: g2 = -{G2}"), ("g2", f"hanging upside down: g2 = -{G2}"), ("x", "behind the wall: x = -l1*c1 - l2*c12")],
)  # fmt: skip
def test_the_sign_of_the_whole_beside_unread_words_is_not_judged(entry, text):
    refused("planar2r", entry, text, SHOWN)


@pytest.mark.parametrize(
    ("text", "words"),
    [
        (f"Whatever the pose of the elbow may be: x = {X}", "Whatever the pose of the elbow may be"),
        (f"x = {X} but this is nonsense", "but this is nonsense"), (f"x = {X}, in cubits", "in cubits"),
        (f"x = {X} (up to a constant)", "up to a constant"),
    ],
)  # fmt: skip
def test_such_words_beside_a_right_formula_are_said(text, words):
    (said,) = kl.diagnose("planar2r", "x", text).remarks
    assert repr(words) in said
    assert right("planar2r", "x", f"From the figure we get x = {X}").remarks == ()


RODS_V = "V = m1*g*l1/2*sin(q1) + m2*g*(l1*sin(q1) + l2/2*sin(q1+q2))"


@pytest.mark.parametrize(
    "words",
    [
        "where l1 and l2 denote half the lengths of the rods", "where $l_1$ is half the length of link 1",
        "where l2 equals half the length", "where m2 is the total mass of both rods", "wobei l1 die halbe Länge ist",
        "其中 l1 为杆长的一半",
    ],
)  # fmt: skip
def test_half_a_length_is_another_length(words):
    refused("planar2r_rods", "V", f"{RODS_V}, {words}")
    right(
        "planar2r_rods",
        "V",
        f"{RODS_V}, where l1/2 and l2/2 are half the lengths of the uniform rods",
    )
    right("planar2r_rods", "V", f"{RODS_V}，其中杆为均质杆")
    right("planar2r_rods", "M22", "m2*lc2^2 + I2, where lc2 is half the length of link 2")
    (said,) = right("planar2r_rods", "V", f"l1 表示杆长的一半：{RODS_V}").remarks
    assert "'l1 表示杆长的一半'" in said


def test_what_a_name_means_may_stand_behind_a_comma_alone():
    for said in ("l1 is the length of link 1", "l1 为杆长", "m2 is the mass of link 2"):
        assert right("planar2r_rods", "V", f"{RODS_V}, {said}").remarks == ()
    for said in ("l1 is half the length of link 1", "l1 为杆长的一半", "I2 is about the pivot"):
        refused("planar2r_rods", "V", f"{RODS_V}, {said}")


@pytest.mark.parametrize(
    ("entry", "way", "formula", "wrong"),
    [
        ("x", "x = a + b", X, ("c12", "s12")), ("V", "V = A", None, None),
        ("tau2", "tau2 = A + B", None, None),
    ],
)  # fmt: skip
def test_how_the_writer_came_to_the_entry_is_no_definition(entry, way, formula, wrong):
    """``L = K - P`` and then ``L = ...``: its names, which nothing explains, were asked for."""
    if formula is not None:
        assert right("planar2r", entry, f"{way}\n{entry} = {formula}")
        (cause,) = kl.diagnose(
            "planar2r", entry, f"{way}\n{entry} = {formula.replace(*wrong)}"
        ).causes
        assert "s12 should be c12" in cause.sentence
    else:
        found = kl.diagnose("planar2r", entry, f"{way}\n{way.partition(' ')[0]} = m2*g*l2*s2")
        assert not found.agrees


def test_an_index_of_zero_on_the_left_says_how_it_is_counted():
    text = "c1, c12 = np.cos(q[0]), np.cos(q[0] + q[1])\ntau[0] = (m1 + m2)*g*l1*c1 + m2*g*l2*c12"
    right("planar2r", "g1", text.replace("tau[0]", "g[0]"))
    assert kl.diagnose("planar2r", "inverse_dynamics[0]", text).causes


def test_rates_may_be_multiplied_on_the_left():
    rows = r"-m_2l_1l_2 s_2(2\dot q_1\dot q_2 + \dot q_2^2) \\ m_2l_1l_2 s_2\dot q_1^2"
    right(
        "planar2r",
        "coriolis_torques",
        rf"C(q,\dot q)\dot q = \begin{{bmatrix}} {rows} \end{{bmatrix}}",
    )


@pytest.mark.parametrize("end", [" where", "\nwhere"])
def test_what_a_matrix_is_made_of_may_stand_on_a_line_of_its_own(end):
    matrix = (
        r"M(q) = \begin{pmatrix} a + 2b\cos q_2 & d + b\cos q_2 \\ d + b\cos q_2 & d \end{pmatrix}"
    )
    names = r"a = m_1l_1^2 + m_2(l_1^2 + l_2^2), b = m_2l_1l_2, d = m_2l_2^2"
    right("planar2r", "mass_matrix", f"{matrix}{end} {names}")


@pytest.mark.parametrize("score", ["(3 points)", "[2 Punkte]", "（5分）"])
def test_what_an_answer_gives_is_no_part_of_it(score):
    assert right("planar2r", "g2", f"g2 = {G2} {score}").remarks == ()
    assert kl.diagnose("planar2r", "g2", f"g2 = {G2.replace('c12', 's12')} {score}").known


def test_moments_about_another_point_are_said():
    (said,) = right(
        "planar2r_rods", "V", f"{RODS_V}; I1 and I2 are taken about the joints."
    ).remarks
    assert "about the joints" in said
    for text in (
        "M22 = m2*lc2^2 + I2, I2 taken at the pivot",
        "$M_{22} = m_2 l_{c2}^2 + I_2$, $I_2$ taken at the pivot",
    ):
        refused("planar2r_rods", "M22", text, "I2 taken at the pivot")


def test_the_words_that_were_not_read_are_said_and_cost_one_entry_alone():
    from kinlab.doctor.report import of_document

    given = {
        "robot": "planar2r",
        "formulas": {"x": "stretched: x = l1 + l2", "y": "l1*s1 + l2*s12"},
    }
    judged, unread = of_document(given, "f.toml")
    assert [one.function for one in judged] == ["y"] and judged[0].agrees
    assert [one.what for one in unread] == ["f.toml: x"] and "'stretched'" in unread[0].reason


@pytest.mark.parametrize(
    "text",
    [
        f"g2 = {G2} - offset", f"Then g2 = {G2} + friction", f"We get g2 = {G2} (friction)", f"g2 = {G2} friction",
        f"g2 = {G2} and friction", f"We find g2 = {G2}, plus friction", f"g2 = {G2} times two", f"hence g2 = {G2}, without the tool",
        f"g2 = {G2}，再加摩擦", "hence g2 = m2*g*l2*cos(angle)", f"g2 = {G2} in mm", "x = l1 - l2 (folded)",
    ],
)  # fmt: skip
def test_a_word_that_may_be_part_of_the_formula_is_not_left_out(text):
    refused("planar2r", "g2", text)


# -------- Code

PYTHON = "l1*np.cos(q[0]) + l2*np.cos(q[0]+q[1])"


@pytest.mark.parametrize(
    "text",
    [
        f"lambda q: {PYTHON}", f"x = lambda q: {PYTHON}", f"lambda q1, q2: {X}", f"def x(q):\n    return {PYTHON}",
        "def x(q):\n    c1 = np.cos(q[0])\n    c12 = np.cos(q[0]+q[1])\n    return l1*c1 + l2*c12",
        "import numpy as np\ndef x(self, q):\n    return self.l1*np.cos(q[0]) + self.l2*np.cos(q[0]+q[1])",
        f"c1, c12 = np.cos(q[0]), np.cos(q[0]+q[1])\nx = {X}", "x, y = l1*c1 + l2*c12, l1*s1 + l2*s12",
        "x = self.l1*np.cos(q[0]) + self.l2*np.cos(q[0]+q[1])", "p.l1*cos(q1) + p.l2*cos(q1+q2)",
        f"x = {X} // tool", f"x = {X}; // x of the tool", f"x = {X} /* tool */", f"(* tool *) x = {X}",
        f"```python\nx = {PYTHON}\n```", f"```\n{X}\n```", f"`x = {X}`", f"(1) x = {X}", f"(3.7) x = {X}", f"1. x = {X}",
        "x == l1 Cos[θ1] + l2 Cos[θ1 + θ2]", "l1*cosf(q1) + l2*cosf(q1+q2)", "l1*std::cos(q[0]) + l2*std::cos(q[0]+q[1])",
        "x = 0,5*cos(q1) + 0,4*cos(q1+q2)", "l1cos(q1) + l2cos(q1+q2)", "dot([l1, l2], [cos(q1), cos(q1+q2)])",
        "np.dot([l1, l2], [c1, c12])", "sum([l1*cos(q1), l2*cos(q1+q2)])", "x = [l1 + l2*c2]*c1 - l2*s2*s1",
        "x = lambda*c1 + l2*c12, lambda = 0.5", "λ = 0.5; x = λ*c1 + l2*c12",
    ],
)  # fmt: skip
def test_what_programs_have_around_a_formula(text):
    right("planar2r", "x", text)


def test_lists_of_other_languages_and_norms():
    right("planar2r", "g", "{(m1+m2) g l1 Cos[q1] + m2 g l2 Cos[q1+q2], m2 g l2 Cos[q1+q2]}")
    right("planar2r", "M11", "m1*l1^2 + m2*norm([l1+l2*c2; l2*s2])^2")
    assert not kl.diagnose("planar2r", "x", "atan2(1,2)*c1").agrees  # two arguments
    right("planar2r", "C12", "C(1,2) = -m2*l1*l2*sin(q(2))*(qd(1)+qd(2))")
    given = {"robot": "planar2r", "symbols": {"lambda": 0.5}, "x": "lambda*c1 + l2*c12"}
    assert formula_file(given, "f.toml").texts["x"] == "lam*c1 + l2*c12"


@pytest.mark.parametrize(
    ("entry", "text"),
    [
        ("x", "l1.c1 + l2.c12"), ("x", "p.l1*c1 + self.l1*c12"), ("x", f"{X} // l2"), ("x", f"{X}//2"),
        ("g", "17,1675*c1, 5,886*c12"), ("x", "0,5*c1 + 0.4*c12"), ("x", "dot([l1], [c1, c12])"),
        ("x", "lambda w: 0.5*cos(w[0])"), ("x", "l1*c(1) + l2*c(12)"), ("x", "a, b = l1*c1"), ("x", "l1*sin2 q1"), ("x", "l1*c1 + h，高度 h = l2*c12 + 末端"),
    ],
)  # fmt: skip
def test_code_that_may_mean_something_else_is_refused(entry, text):
    refused("planar2r", entry, text)


# -------- Letters


@pytest.mark.parametrize(
    "text",
    [
        "x = l₁ cos\u2061(θ₁) + l₂ cos\u2061(θ₁+θ₂)", "𝑥 = 𝑙_1 cos\u2061(𝜃_1) + 𝑙_2 cos\u2061(𝜃_1 + 𝜃_2)",
        "x=l_1 cos\u2061〖θ_1〗+l_2 cos\u2061(θ_1+θ_2)", "x = l1∙cosθ1 + l2∙cos(θ1+θ2)", "x = l1∗cos(θ1)+l2∗cos(θ1+θ2)",
        "x = l<sub>1</sub> cos θ<sub>1</sub> + l<sub>2</sub> cos(θ<sub>1</sub>+θ<sub>2</sub>)", "x = ½ c1 + ⅖ c12",
        "x = l1\u00a0c1 + l2\u2009c12",
    ],
)  # fmt: skip
def test_letters_of_word_processors(text):
    right("planar2r", "x", text)


def test_fractions_and_brackets_of_unicode():
    right("planar2r_rods", "M22", "⅓ m2 l2²")
    right("planar2r", "M22", "m2 l<sub>2</sub><sup>2</sup>")
    tau1 = (
        "τ₁ = [(m₁+m₂)l₁² + m₂l₂² + 2m₂l₁l₂cosθ₂]θ̈₁ + (m₂l₂² + m₂l₁l₂cosθ₂)θ̈₂ "
        "− m₂l₁l₂sinθ₂(2θ̇₁θ̇₂ + θ̇₂²) + (m₁+m₂)gl₁cosθ₁ + m₂gl₂cos(θ₁+θ₂)"
    )
    right("planar2r", "tau1", tau1)


@pytest.mark.parametrize("text", ["2⅓ m2 l2²", "1½*m2", "1 ½ m2", "m2 ⚙ l2"])
def test_a_number_before_a_fraction_is_refused(text):
    refused("planar2r_rods", "M22", text)


# -------- A free constant, names, rates


@pytest.mark.parametrize(
    "constant",
    ["const", "const.", "C", "C_0", "V0", "V_0", r"\text{const.}", r"\mathrm{const}", "常数"],
)
def test_a_potential_s_constant_is_zero_and_that_is_said(constant):
    text = rf"V = (m_1+m_2) g l_1 s_1 + m_2 g l_2 s_{{12}} + {constant}"
    remarks = right("planar2r", "V", text).remarks
    assert len(remarks) == 1 and "zero is free" in remarks[0]
    assert kl.diagnose("planar2r", "V", f"{V.replace('s12', 'c12')} + {constant}").known


@pytest.mark.parametrize(
    ("entry", "text"),
    [
        ("T", "0.4375*qd1^2 + C"), ("V", f"C*{V} + C"), ("V", f"{V} - C*s1"), ("g2", f"{G2} + const"),
        ("V", f"{V} + h"), ("L", f"-({V}) + K"), ("V", f"{V} + c"), ("V", f"{V} + k*S + C"), ("x", f"{X} + x0"),
    ],
)  # fmt: skip
def test_a_constant_that_is_not_free_is_refused(entry, text):
    refused("planar2r", entry, text)


def test_a_constant_that_is_explained_is_what_it_is():
    found = kl.diagnose("planar2r", "V", f"{V} + C, C = 2")
    assert found.agrees and "another zero" in " ".join(found.remarks)


@pytest.mark.parametrize("name", ["I_{C_2}", "I_{C2}", "I_{c2}", "I_{G2}", "I_{S_2}"])
def test_the_inertia_about_the_centre_by_other_names(name):
    right("planar2r_rods", "M22", rf"m_2 l_{{c2}}^2 + {name}")
    refused("planar2r_rods", "M22", rf"m_2 l_{{c2}}^2 + {name.replace('2', '3')}")
    refused("planar2r_rods", "M22", rf"m_2 l_{{c2}}^2 + {name} + I_2")


RATES = {
    "diff(q{k}(t),t,2)": "diff(q{k}(t),t)", "Derivative(q{k},t,t)": "Derivative(q{k},t)",
    "sp.Derivative(q{k}(t), (t, 2))": "sp.Derivative(q{k}(t), t)", "diff(theta{k}, t, t)": "diff(theta{k}, t)",
    "q{k}''[t]": "q{k}'[t]", "D[q{k}[t], {{t, 2}}]": "D[q{k}[t], t]", "q{k}.diff(t, 2)": "q{k}.diff(t)",
    "q{k}pp": "q{k}p", "qpp{k}": "qp{k}", "theta{k}pp": "theta{k}p", "D2q{k}": "Dq{k}", "d²q{k}/dt²": "dq{k}/dt",
    "d^2q{k}/dt^2": "dq{k}/dt", "ddot_q{k}": "dot_q{k}",
}  # fmt: skip


@pytest.mark.parametrize("twice", [one for one in RATES if "dot" not in one])
def test_rates_by_other_names(twice):
    once = RATES[twice]
    text = TAU2.format(a1=twice.format(k=1), a2=twice.format(k=2), v1=once.format(k=1))
    right("planar2r", "tau2", text)


def test_rates_as_fractions_and_beside_angles():
    dots = [rf"\frac{{d^2\theta_{k}}}{{dt^2}}" for k in (1, 2)]
    once = r"\left(\frac{\mathrm{d}\theta_1}{\mathrm{d}t}\right)"
    text = (
        rf"m_2 l_2^2 ({dots[0]} + {dots[1]}) + m_2 l_1 l_2 c_2 {dots[0]} + m_2 l_1 l_2 s_2 {once}^2"
        r" + m_2 g l_2 c_{12}"
    )
    right("planar2r", "tau2", text)
    text = (
        TAU2.format(a1="ddt1", a2="ddt2", v1="dt1")
        .replace("c2", "cos(t2)")
        .replace("s2", "sin(t2)")
    )
    right("planar2r", "tau2", text.replace("q1+q2", "t1+t2"))


@pytest.mark.parametrize(
    "rates",
    [
        ("diff(q1, x)", "diff(q1, t)"),
        ("diff(q1(t), t, 3)", "q1p"),
        ("q1ppp", "q1p"),
        ("ddt1", "dt1"),
        ("q1pp", "cos(q1p)"),
    ],
)
def test_rates_that_are_none_are_refused(rates):
    refused("planar2r", "tau2", TAU2.format(a1=rates[0], a2="qdd2", v1=rates[1]))


def test_a_name_that_the_writer_explains_stays():
    text = "q1p = qd1 + qd2; " + TAU2.format(a1="qdd1", a2="qdd2", v1="q1p")
    assert not kl.diagnose("planar2r", "tau2", f"{text}").agrees


# -------- Corrections


@pytest.mark.parametrize(
    ("entry", "text", "correct"),
    [
        ("x", r"\boxed{x = l_1 c_1 + l_2 s_{12}}", r"l_1 c_1 + l_2 c_{12}"),
        ("x", "x = l1*c1 + l2*s12 (in m)", "l1*c1 + l2*c12"), ("x", "x = self.l1*c1 + self.l2*s12", "l1*c1 + l2*c12"),
        ("x", r"末端的 x 坐标为 $x = l_1 c_1 + l_2 s_{12}$", r"l_1 c_1 + l_2 c_{12}"),
        ("x", "lambda q: l1*np.cos(q[0]) + l2*np.sin(q[0]+q[1])", "l1*np.cos(q[0]) + l2*np.cos(q[0]+q[1])"),
        ("V", "V = 17.1675*s1 + 5.886*c12 + const", "17.1675*s1 + 5.886*s12"),
        ("x", r"l_1 c\theta_1 + l_2 s(\theta_1+\theta_2)", r"l_1 c\theta_1 + l_2 \cos(\theta_1+\theta_2)"),
        ("x", r"\nicefrac{1}{2}\,s_1 + 0.4 c_{12}", r"\frac{1}{2}\,c_1 + 0.4 c_{12}"),
    ],
)  # fmt: skip
def test_the_corrected_line_is_as_it_was_typed(entry, text, correct):
    found = kl.diagnose("planar2r", entry, text)
    assert found.known, str(found)
    assert f"correct: {entry} = {correct}" in str(found).split("\n  ")


def test_long_texts_are_read_soon():
    for piece in (
        "x y ",
        "where a, ",
        "1 cm ",
        "其中",
        "q1(t) ",
        "{",
        r"\boxed{",
        "[a+",
        "self.",
        "0,5 ",
        "m kg ",
        "(in ",
    ):
        text = "l1*c1 + " + piece * (18_000 // len(piece))
        refused("planar2r", "x", text)


@pytest.mark.parametrize(
    "words",
    [
        "其中 q2 为连杆2与水平线的夹角, ",
        "设 θ₂ 为与水平线的夹角，则 ",
        "角度从竖直方向量起, ",
        "Here q2 is measured from the x axis, ",
        "q2 is the absolute angle: ",
        "With absolute angles ",
        "In degrees: ",
        "Angles measured from the vertical: ",
        "Mit absoluten Winkeln: ",
    ],
)
def test_words_in_front_that_say_what_a_name_means_are_no_dress(words: str) -> None:
    """A right formula of other angles would be called wrong, and nothing said of the words."""
    with pytest.raises(ExpressionError, match="beside the formula"):
        kl.diagnose("planar2r", "x", f"{words}x = l1*c1 + l2*c2")


# -------- Several formulas in one sentence, and marks above letters


ROD = r"均质细杆绕端点的转动惯量为 $I_O = \frac{1}{3}ml^2$，所以 $\tau = I_O\ddot q + mg\frac{l}{2}\cos q$"
TIP = r"由 $x = l_1c_1+l_2c_{12}$ 对 $\theta_1$ 求偏导，得 $J_{11} = -l_1s_1-l_2s_{12}$"
SPEEDS = (
    r"T = \frac{1}{2}m_1(\dot x_1^2+\dot y_1^2) + \frac12 m_2(\dot x_2^2+\dot y_2^2), where"
    "\n"
    r"\dot x_1 = -l_1 s_1\dot\theta_1, \dot y_1 = l_1c_1\dot\theta_1,"
    "\n"
    r"\dot x_2 = -l_1s_1\dot\theta_1 - l_2s_{12}(\dot\theta_1+\dot\theta_2), "
    r"\dot y_2 = l_1c_1\dot\theta_1 + l_2c_{12}(\dot\theta_1+\dot\theta_2)"
)


@pytest.mark.parametrize(
    ("robot", "entry", "text"),
    [
        ("single_link", "tau1", ROD),
        ("planar2r", "J11", TIP),
        ("planar2r", "J11", "$x = l_1c_1+l_2c_{12}$\n$J_{11} = -l_1s_1-l_2s_{12}$"),
        ("planar2r", "T", SPEEDS),
        ("planar2r", "x", "The elbow is at $x_e = l_1c_1$ and so the tip at $x = x_e+l_2c_{12}$"),
        ("planar2r", "M22", r"M_{22} = \mathfrak{m}_2 L_2^2"),
        ("ur5", "R33", "T[2,2] = -np.sin(q[1]+q[2]+q[3])*np.sin(q[4])"),
        ("single_link", "V", "V = -m g (l/2) (1 - sin q)"),
    ],
)
def test_a_sentence_with_formulas_is_read(robot, entry, text) -> None:
    right(robot, entry, text)


def test_a_mark_above_a_letter_is_told() -> None:
    text = (
        r"M_{11} = m_1 l_{g1}^2 + \tilde I_1 + m_2(l_1^2 + l_{g2}^2 + 2l_1 l_{g2} C_2) + \tilde I_2"
    )
    found = right("planar2r_rods", "M11", text)
    assert r"\tilde I is read without the mark" in str(found)


def test_a_letter_with_and_without_a_mark_is_refused() -> None:
    refused("planar2r_rods", "M22", r"M_{22} = \bar I_2 + m_2 l_{c2}^2 + I_2 - I_2")


@pytest.mark.parametrize(
    "text",
    [
        "When $q_1 = 0$ the tip is at $x = l_1c_1+l_2c_{12}$",
        "$x = l_1c_1$ is wrong; right is $x = l_1c_1+l_2c_{12}$",
        "$q_2$ is measured from the base: $x_e = l_1c_1$, $x = x_e+l_2c_2$",
        "For $l_1 = l_2$ the tip is at $x = l_1c_1+l_1c_{12}$",
        r"While $\dot q_1 = 0$ the tip is at $x = l_1c_1+l_2c_{12}$",
        "The tip is not at $x = l_1c_1+l_2c_{12}$",
        "如果关节锁死，$x = l_1c_1+l_2c_{12}$",
    ],
)
def test_a_sentence_that_says_more_is_refused(text) -> None:
    refused("planar2r", "x", text)


# -------- What denies a formula, or says of what it is


TAU2_ROD = "(I2 + m2*l2^2/4 + m2*l1*l2/2*c2)*qdd1 + (I2 + m2*l2^2/4)*qdd2 + m2*l1*l2/2*s2*qd1^2 + m2*g*l2/2*c12"
OF_A_ROD = "I2 + m2*l2^2/4"


@pytest.mark.parametrize(
    ("robot", "entry", "text", "said"),
    [
        ("planar2r", "x", f"Someone wrote x = {X}. That is not correct.", "not correct"),
        ("planar2r", "x", f"The answer should not be x = {X}.", "should not be"),
        ("planar2r", "y", "y = l1 s1 + l2 s12 stimmt nicht ganz", "stimmt nicht"),
        ("planar2r", "g2", f"Bis auf einen Faktor 2 gilt g2 = {G2}", "Bis auf einen Faktor"),
        ("planar2r", "g2", f"up to the sign g2 = {G2}", "up to the sign"),
        ("planar2r", "V", f"V = {V} is the potential energy per unit mass.", "per unit mass"),
        ("planar2r", "V", "potential energy per unit mass V = g*l1*s1", "per unit mass"),
        ("planar2r", "y", "y = l1 s1 + l2 s12 (角度单位：度，l 单位：毫米)", "角度单位"),
        ("planar2r", "x", f"x = {X} is the y coordinate of the tool.", "y coordinate"),
        ("planar2r", "y", "y = l1*s1 + l2*s12 is the x-component", "x component|x-component"),
        ("planar2r_rods", "M22", r"M_{22} = I_2 + \frac14 m_2 l_2^2, where $I_2$ is taken about the joint.",
         "I2 is taken about the joint"),
        ("planar2r_rods", "tau2", f"tau2 = {TAU2_ROD} with I2 taken about joint 2", "about joint"),
        ("planar2r", "x", f"{X}, m2 = 1", "m2 = 1"),
    ],
)  # fmt: skip
def test_a_formula_that_is_denied_or_of_something_else_is_refused(robot, entry, text, said):
    refused(robot, entry, text, said)


@pytest.mark.parametrize(
    ("robot", "entry", "text"),
    [
        ("planar2r", "y", "Das ergibt y = l1 sin θ1 + l2 sin(θ1+θ2) (siehe Abb. 3)."),
        ("planar2r", "x", f"The x and y coordinates follow from the picture: x = {X}"),
        ("planar2r", "x", f"the x coordinate of the tool is x = {X}"),
        ("planar2r", "J22", "Differenzieren nach θ₂ liefert J₂₂ = l₂ cos(θ₁+θ₂)."),
        ("planar2r", "M12", r"质量矩阵的非对角元：M_{12} = m_2 l_2 (l_2 + l_1 \cos\theta_2)"),
        ("planar2r", "g2", f"Don't forget the gravity term: g2 = {G2}"),
        ("planar2r", "x", f"l1 = 0.5, l2 = 0.4, x = {X}"),
        ("planar2r_rods", "M22", f"M22 = {OF_A_ROD}, I2 about the centre of mass (not about the joint)"),
        ("spatial3r", "y", r"y = a_1\sin\theta_1 + a_2\sin(\theta_1+\theta_2) + xt\cos\theta_3\sin(\theta_1+\theta_2)"),
        ("spatial3r", "x", r"x = a_1\cos\theta_1 + (a_2 + xt\cos\theta_3)\cos(\theta_1+\theta_2) aus der letzten Spalte"),
        ("scara", "M44", "M_{44} = Ia4 + Izz4 + m_4 cx4^2"),
        ("single_link", "tau1", "(I1 + m1*l1^2/4)*theta'' + m1*g*l1/2*cos(theta)"),
        ("single_link", "tau1", "(I1 + m1*l1^2/4)*ddot(theta) + m1*g*l1/2*cos(theta)"),
        ("planar2r", "L", "Lagrange-Funktion L = T − V\nL = ½(m₁+m₂) l₁² θ̇₁² + ½ m₂ l₂² (θ̇₁+θ̇₂)² + m₂ l₁ l₂ cos θ₂ θ̇₁ "
         "(θ̇₁+θ̇₂) − (m₁+m₂) g l₁ sin θ₁ − m₂ g l₂ sin(θ₁+θ₂)"),
        ("planar2r", "x", "l1*cos(q1) + ...\n l2*cos(q1+q2)"),
        ("planar2r", "x", "l1*cos(q1) + \\\n   l2*cos(q1+q2)"),
    ],
)  # fmt: skip
def test_what_is_around_it_changes_nothing(robot, entry, text):
    right(robot, entry, text)


@pytest.mark.parametrize("words", ["for m2 = 0", ", q2=0", ", q1 := 0", "for q2 = 0"])
def test_a_condition_is_never_passed_over(words):
    assert right("planar2r", "x", f"{X} {words}").remarks
