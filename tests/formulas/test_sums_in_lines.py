r"""Sums that go on below: ``g_1 &= a \\ &\quad + b``, in every way in which people set these."""

import itertools

import pytest

import kinlab as kl
from kinlab.errors import KinlabError

_FIRST = r"(m_1 l_{c1}+m_2 l_1) g \cos q_1"
_SECOND = r"m_2 g l_{c2}\cos(q_1+q_2)"
_AROUND = (
    ("", ""),
    (r"\begin{aligned}", r"\end{aligned}"),
    ("$$\\begin{split}\n", "\n\\end{split}$$"),
)
_ENDS = (r"\\", "\\\\\n", r"\\[2pt]", "\\nonumber\\\\\n", " \\notag \\\\ \n")
_BEFORE = (
    r"&\quad",
    "&",
    r"\qquad",
    r"&\qquad\;{}",
    r"&\phantom{=}",
    r"&\hphantom{{}=}",
    r"&\hspace{1cm}",
    r"&\mathrel{\phantom{=}}",
    r"&\!\enspace",
)


def _agrees(quantity: str, text: str) -> bool:
    return kl.diagnose("planar2r", quantity, text, samples=10).agrees


@pytest.mark.parametrize("before", _BEFORE)
@pytest.mark.parametrize(
    "sum_of", ["{first} {end} {before} + {second}", "{first} + {end} {before} {second}"]
)
def test_a_sum_goes_on_below(before: str, sum_of: str) -> None:
    judged = []
    for (opened, closed), end in zip(itertools.cycle(_AROUND), _ENDS, strict=False):
        both = sum_of.format(first=_FIRST, second=_SECOND, end=end, before=before)
        wrong = sum_of.format(first=_FIRST, second=f"2 {_SECOND}", end=end, before=before)
        one = f"{opened}g_1 &= {both}{closed}"
        whole = f"{opened}g_1 &= {both} {end} g_2 &= {_SECOND}{closed}"
        turned = f"{opened}g_2 &= {_SECOND} {end} g_1 &= {both}{closed}"
        judged += [_agrees("gravity_torques[0]", one), _agrees("gravity_torques", whole)]
        judged += [_agrees("gravity_torques", turned)]
        assert not _agrees("gravity_torques[0]", one.replace(both, wrong))
        assert not _agrees("gravity_torques", whole.replace(both, wrong))
    assert all(judged)


def test_brackets_that_are_not_seen_close_a_line() -> None:
    text = (
        r"g_1 &= g\left[(m_1 l_{c1}+m_2 l_1)\cos q_1 \right. \\ &\quad \left. {} + "
        r"m_2 l_{c2}\cos(q_1+q_2) \right] \\ g_2 &= "
    )
    assert _agrees("gravity_torques", text + _SECOND)
    assert not _agrees("gravity_torques", text + _FIRST)


@pytest.mark.parametrize("between", [r" \\ ", " \\\\\n", "; ", "\n"])
def test_a_line_without_a_name_is_nobody_s(between: str) -> None:
    lines = f"g_1 = {_FIRST}+{_SECOND}", f"l_1 {_SECOND}", f"g_2 = {_SECOND}"
    with pytest.raises(KinlabError):
        kl.diagnose("planar2r", "gravity_torques", between.join(lines))


_P = "(m1*lc1 + m2*l1)*g*cos(q1) + m2*lc2*g*cos(q1+q2)"
_V = "m1*g*lc1*sin(q1) + m2*g*(l1*sin(q1)+lc2*sin(q1+q2))"
_MASSES = "I1+I2+m1*lc1^2+m2*(l1^2+lc2^2+2*l1*lc2*cos(q2)), I2+m2*(lc2^2+l1*lc2*cos(q2))"


@pytest.mark.parametrize("between", ["\n", "; "])
@pytest.mark.parametrize(
    ("quantity", "named", "right"),
    [
        ("gravity_torques[0]", "g1", _P),
        ("gravity_torques[0]", "phi1", _P),
        ("potential_energy", "V", _V),
        ("fk[0,3]", "T14", "l1*c1 + l2*c12"),
        ("fk[0,3]", "p_x", "l1*c1 + l2*c12"),
        ("com_positions[1,0]", "x_c2", "l1*c1 + lc2*c12"),
        ("mass_matrix[0,1]", "D12", "I2 + m2*(lc2^2 + l1*lc2*cos(q2))"),
        ("mass_matrix[0]", "M", ""),
    ],
)
def test_the_line_that_is_asked_for_is_judged(
    between: str, quantity: str, named: str, right: str
) -> None:
    """Whatever stands beside it, and in whatever order."""
    beside = "w = m1*l1"
    if named == "M":
        quantity = "mass_matrix"
        right = f"[{_MASSES}; I2+m2*(lc2^2+l1*lc2*cos(q2)), I2+m2*lc2^2]"
        beside = "w = [1, 2; 3, 4]"
    for lines in ((f"{named} = {right}", beside), (beside, f"{named} = {right}")):
        assert kl.diagnose("planar2r_rods", quantity, between.join(lines), samples=10).agrees
    name, formula = beside.split(" = ")
    for lines in ((f"{named} = {formula}", f"{name} = {right}"), (beside, f"{named} = {formula}")):
        assert not kl.diagnose("planar2r_rods", quantity, between.join(lines), samples=10).agrees


@pytest.mark.parametrize("name", ["phi1", "G1", "w"])
def test_what_is_explained_behind_may_have_the_name_of_another_quantity(name: str) -> None:
    first, second = _MASSES.split(", ")
    text = (
        f"tau_1 = d11*ddq1 + d12*ddq2 + h*dq2^2 + 2*h*dq1*dq2 + {name}\nd12 = {second}\n"
        f"d11 = {first}\nh = -m2*l1*lc2*sin(q2)\n{name} = {_P}"
    )
    assert kl.diagnose("planar2r_rods", "inverse_dynamics[0]", text).agrees
    assert not kl.diagnose("planar2r_rods", "inverse_dynamics[0]", text + "*2").agrees


@pytest.mark.parametrize(
    "text",
    [
        r"\[g_1 = {sum} \qquad (7)\]",
        r"g_1 &= {sum}\,. \qquad (7)",
        r"g_1 = {sum}. \tag{{3}}",
        r"\begin{{align*}}{first} + k_1 \cos(q_1+q_2), \quad \text{{where}}\quad k_1 := "
        r"m_2 g l_{{c2}}\,.\end{{align*}}",
        r"k_1 &= m_2 g l_{{c2}} and a := l_1 \\ g_1 &= (m_1 l_{{c1}}+m_2 a) g \cos q_1 "
        r"\\ &\quad + k_1 \cos(q_1+q_2)",
        r"g_1 &= \mathcal{{A}} + \mathcal{{B}} \\ &= {sum}",
        "k := m2*g*lc2: g1 := (m1*lc1+m2*l1)*g*cos(q1) + k*cos(q1+q2):",
        r"A := m_2 l_1 \\ g_1 &= m_1 l_{{c1}} g \cos q_1 +\quad A g \cos q_1 + {second}",
    ],
)
def test_numbers_points_and_definitions_beside_it(text: str) -> None:
    whole = text.format(sum=f"{_FIRST} + {_SECOND}", first=_FIRST, second=_SECOND)
    assert _agrees("gravity_torques[0]", whole)
    assert not _agrees("gravity_torques[0]", whole.replace("l_1", "l_2").replace("m2*l1", "m2*l2"))


def test_a_step_with_names_of_its_own_is_said_to_be_none_that_was_judged() -> None:
    text = rf"g_1 = G_a \cos q_1 + G_b = {_FIRST} + {_SECOND}"
    found = kl.diagnose("planar2r", "gravity_torques[0]", text)
    assert found.agrees and "not judged" in " ".join(found.remarks)
    wrong = kl.diagnose("planar2r", "gravity_torques[0]", text + " + 1")
    assert not wrong.agrees


@pytest.mark.parametrize(
    ("robot", "quantity", "text"),
    [
        ("planar2r", "gravity_torques", r"g(q) = \begin{cases} g_1 = (m_1+m_2) g l_1 c_1 + m_2 g l_2 c_{12} \\ g_2 = m_2 g l_2 c_{12}\end{cases}"),
        ("planar2r", "gravity_torques[0]", "g_1 = (2 kg + 1.5 kg) * 9.81 m/s^2 * 0.5 m * cos(q1) + 1.5 kg * 9.81 m/s^2 * 0.4 m * cos(q1+q2)"),
        ("planar2r", "statics[1]", "tau2 = -l2*s12*fx + l2*c12*fy + mz"),
        ("stanford", "dh_poses[0]", r"{}^{0}A_1=\begin{pmatrix}\cos\theta_1&0&-\sin\theta_1&0\\ \sin\theta_1&0&\cos\theta_1&0\\ 0&-1&0&0.412\\ 0&0&0&1\end{pmatrix}"),
        ("single_link", "mass_matrix[0,0]", r"$M = \frac{1}{12}ml^2 + m\left(\frac{l}{2}\right)^2 = \frac13 m l^2$"),
        ("single_link", "kinetic_energy", r"E_k = \frac12 J\omega^2 = \frac12\cdot\frac{m l^2}{3}\,\dot q^2 = \frac{m l^2\dot q^2}{6}"),
        ("scara", "fk[1,3]", "Sumando: y = l1*sin(q1) + l2*sin(q1+q2), con los a\u0301ngulos en radianes"),
        ("planar2r_rods", "mass_matrix[1,1]", "Come visto a lezione, M22 = I2 + m2*lc2^2 (costante)"),
    ],
)  # fmt: skip
def test_other_writings_are_right(robot: str, quantity: str, text: str) -> None:
    assert kl.diagnose(robot, quantity, text).agrees


def test_a_letter_that_is_a_unit_and_a_name_is_refused() -> None:
    with pytest.raises(KinlabError, match="a unit, or a name"):
        kl.diagnose("single_link", "gravity_torques[0]", "m * 9.81 m/s^2 * 0.5 m * cos(q)")


@pytest.mark.parametrize(
    ("quantity", "text"),
    [("mass_matrix_dot[1,1]", "-m2*l1*lc2*s2*qd1"), ("coriolis_matrix[1,1]", "-m2*l1*lc2*s2*qd2")],
)
def test_what_should_be_nothing_is_told_so(quantity: str, text: str) -> None:
    found = kl.diagnose("planar2r_rods", quantity, text)
    assert f"{text} should be 0" in found.causes[0].sentence
    assert found.causes[0].kinds == ("extra term",)


@pytest.mark.parametrize(
    ("robot", "quantity", "text"),
    [
        ("planar2r", "kinetic_energy", "v_{c1}^2 &= l_1^2\\dot q_1^2\\\\\nv_{c2}^2 &= \\dot x_2^2+\\dot y_2^2 = l_1^2\\dot q_1^2 + l_2^2(\\dot q_1+\\dot q_2)^2 + 2 l_1 l_2\\cos q_2\\,\\dot q_1(\\dot q_1+\\dot q_2)\\\\\nT &= \\tfrac12 m_1 v_{c1}^2 + \\tfrac12 m_2 v_{c2}^2"),
        ("single_link", "inverse_dynamics", r"\tau = I_O\ddot\theta + m g \frac{l}{2}\cos\theta,\quad I_O = \frac{m l^2}{12} + m\left(\frac{l}{2}\right)^2 = \frac{m l^2}{3}"),
        ("planar2r", "gravity_torques[1]", r"because rod 2 only turns with q1+q2: $\tau_{2} = m_2 g l_2 \cos(q_1+q_2)$"),
        ("planar3r", "com_positions", r"r_1 = [l_{c1}c_1, l_{c1}s_1, 0], r_2 = [l_1c_1 + l_{c2}c_{12}, l_1s_1 + l_{c2}s_{12}, 0], r_3 = [l_1c_1+l_2c_{12}+l_{c3}c_{123}, l_1s_1+l_2s_{12}+l_{c3}s_{123}, 0]"),
        ("planar2r", "mass_matrix", r"M = \begin{bmatrix} (m_1+m_2)l_1^2+m_2l_2^2+2m_2l_1l_2c_2 & m_2l_2^2+m_2l_1l_2c_2\\ * & m_2l_2^2\end{bmatrix} where * denotes the symmetric entry"),
        ("planar2r", "mass_matrix", "double c2 = cos(q2);\nM[0][0] = (m1+m2)*l1*l1 + m2*l2*l2 + 2.0*m2*l1*l2*c2;\nM[0][1] = m2*l2*(l2 + l1*c2);\nM[1][0] = M[0][1];   // symmetric\nM[1][1] = m2*l2*l2;"),
        ("scara", "fk[2,3]", "第3関節は下向きに動くので、z = d1 - q3 です。"),
    ],
)  # fmt: skip
def test_derivations_rows_and_code_are_right(robot: str, quantity: str, text: str) -> None:
    assert kl.diagnose(robot, quantity, text).agrees


def test_steps_of_a_definition_that_are_unequal_are_refused() -> None:
    text = r"\tau = I_O\ddot\theta + m g \frac{l}{2}\cos\theta,\quad I_O = m l^2 = \frac{m l^2}{3}"
    with pytest.raises(KinlabError):
        kl.diagnose("single_link", "inverse_dynamics", text)


def test_tau_with_rates_is_no_torque_of_gravity() -> None:
    with pytest.raises(KinlabError):
        kl.diagnose("planar2r", "gravity_torques[1]", "tau2 = m2*l2^2*qdd2 + m2*g*l2*c12")


def test_a_sum_of_hundreds_of_terms_ends_in_a_verdict() -> None:
    assert not kl.diagnose("planar2r", "gravity_torques[1]", "1" + " + 1" * 400, samples=10).agrees


_POSE = "x = l1*c1 + l2*c12 + l3*c123", "y = l1*s1 + l2*s12 + l3*s123", "phi = q1 + q2 + q3"


@pytest.mark.parametrize("between", ["; ", "\n", r" \\ "])
def test_a_planar_pose_may_have_the_angle_itself(between: str) -> None:
    text = between.join(_POSE)
    if "\\" in between:
        text = text.replace("*", " ").replace("phi", r"\varphi")
    assert kl.diagnose("planar3r", "planar_pose", text).agrees
    column = "; ".join(line.partition(" = ")[2] for line in _POSE)
    assert kl.diagnose("planar3r", "planar_pose", f"[{column}]").agrees
    found = kl.diagnose("planar3r", "planar_pose", text.replace("+ q3", "- q3"))
    assert not found.agrees and found.causes
    with pytest.raises(KinlabError):
        kl.diagnose("planar3r", "planar_pose[2]", _POSE[2])


def test_torques_without_one_of_the_tool_s_forces_say_so() -> None:
    found = kl.diagnose("planar2r", "statics[1]", "tau2 = -l2*s12*fx + l2*c12*fy")
    assert found.agrees and "no nz of the tool" in " ".join(found.remarks)
    whole = kl.diagnose("planar2r", "statics[1]", "tau2 = -l2*s12*fx + l2*c12*fy + nz")
    assert whole.agrees and not whole.remarks


def test_maple_counts_from_one() -> None:
    assert kl.diagnose("planar2r", "gravity_torques[1]", "g[2] := m2*g*l2*cos(q1+q2);").agrees


def test_a_step_of_a_definition_that_cannot_be_held_against_the_last_is_said() -> None:
    text = (
        r"v^2 = \dot x^2 + 2\dot y^2 = l_1^2\dot q_1^2 + l_2^2(\dot q_1+\dot q_2)^2 + "
        r"2 l_1 l_2\cos q_2\,\dot q_1(\dot q_1+\dot q_2); T = \frac12 m_1 l_1^2\dot q_1^2 + "
        r"\frac12 m_2 v^2"
    )
    found = kl.diagnose("planar2r", "kinetic_energy", text)
    assert found.agrees and "another was not judged" in " ".join(found.remarks)
    alone = text.replace(r"\dot x^2 + 2\dot y^2 = ", "")
    assert not kl.diagnose("planar2r", "kinetic_energy", alone).remarks
