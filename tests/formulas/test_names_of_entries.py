"""Names in front of formulas: those that books have for an entry, a row or a block; and no others."""

from __future__ import annotations

import pytest

import kinlab as kl
from kinlab.errors import ExpressionError
from kinlab.formulas.files import formula_file

XC2 = "l_1 c_1 + l_2 c_{12}"
D122 = "-m_2 l_1 l_2 s_2"
RATE = r"-m_2 l_1 l_2 \sin\theta_2\,\dot\theta_2"
Z3 = r"d_1 + q_3 \cos\theta_2"
ROW = "-l1*s1 - l2*s12, -l2*s12"
ROWS = "-l1*s1 - l2*s12, -l2*s12; l1*c1 + l2*c12, l2*c12"
POINT = "l1*c1 + l2*c12; l1*s1 + l2*s12; 0"
TURN = "c12, -s12, 0; s12, c12, 0; 0, 0, 1"
TAU = r"-(l_1 s_1 + l_2 s_{12}) F_x + (l_1 c_1 + l_2 c_{12}) F_y + N_z \\ -l_2 s_{12} F_x + l_2 c_{12} F_y + N_z"
ANGLE = r"2\arctan\frac{B \pm \sqrt{A^2 + B^2 - C^2}}{A + C}"
ABC = r"A = 2 l_1(s e - x),\ B = -2 l_1 y,\ C = l_2^2 - l_1^2 - (s e - x)^2 - y^2"


def refused(robot, entry, text, said="begins with"):
    with pytest.raises(ExpressionError, match=said):
        kl.diagnose(robot, entry, text)


NAMED = [
    ("stanford", "dh_poses[2,2,3]", Z3, ("z_3", "p_{3,z}", "p_{z3}", "{}^0p_{3z}"), ("z_2", "y_3", "x_{3}", "p_{2,z}")),
    ("planar2r", "com_positions[1,0]", XC2, ("x_{c2}", "x_{C_2}", r"x_{\mathrm{com},2}", "x_{S2}", "p_{c2,x}", "x_2"), ("y_{c2}", "x_{c1}", "p_{c2,y}", "x_{G1}")),
    ("planar2r", "christoffel[0,1,1]", D122, ("D_{122}", "c_{122}", r"\Gamma_{122}", r"\Gamma_{1,22}", "c_{1,2,2}"), ("c_{221}", "D_{112}", r"\Gamma_{212}", "h_{122}")),
    ("planar2r", "mass_matrix_dot[0,1]", RATE, (r"\dot M_{12}", r"\dot{M}_{12}", r"\frac{dM_{12}}{dt}", r"\frac{d}{dt} M_{12}", r"\dot m_{12}"), (r"\dot M_{11}", "M_{12}", r"\dot J_{12}")),
    ("planar2r", "mass_matrix_dot[0,1]", "-m2*l1*l2*s2*qd2", ("Mdot12", "M_dot_12", "dM12", "dM12/dt"), ("Mdot11", "dM22")),
    ("planar2r", "jacobian_dot[0,1]", r"-l_2 c_{12}(\dot\theta_1 + \dot\theta_2)", (r"\dot J_{12}",), (r"\dot J_{11}", r"\dot M_{12}")),
    ("planar2r", "x", XC2, ("x", "p_x"), ("y", "p_y", "z")),
]  # fmt: skip


@pytest.mark.parametrize(
    ("robot", "entry", "text", "name"),
    [(robot, entry, text, one) for robot, entry, text, names, _no in NAMED for one in names],
)
def test_an_entry_by_a_name_of_the_books(robot, entry, text, name):
    assert kl.diagnose(robot, entry, f"{name} = {text}").agrees


@pytest.mark.parametrize(
    ("robot", "entry", "text", "name"),
    [(robot, entry, text, one) for robot, entry, text, _yes, names in NAMED for one in names],
)
def test_a_name_of_another_entry_is_refused(robot, entry, text, name):
    refused(robot, entry, f"{name} = {text}")


def test_a_rate_is_not_the_matrix_itself():
    refused("planar2r", "M12", rf"\dot M_{{12}} = {RATE}")


BLOCKS = [
    ("jacobian[0]", f"[{ROW}]", ("J_x", "J(1,:)", "J[0,:]", "J[0]", "Jvx"), ("J_y", "J(2,:)", "J_z")),
    ("planar_jacobian[0]", f"[[{ROW}]]", ("J_x",), ("J_y",)),
    ("jacobian[5]", "[1, 1]", (r"J_\omega", r"J_{\omega z}", r"J_\phi"), ("J_z", "J_v")),
    ("jacobian[:2]", f"[{ROWS}]", ("J", "J_v", "J_P", "J(1:2,:)"), (r"J_\omega", "J_O", "M")),
    ("jacobian[:2,1]", "[-l2*s12; l2*c12]", ("J_2", "J_{P2}"), ("J_1",)),
    ("jacobian[3:]", "[0, 0; 0, 0; 1, 1]", ("Jw", r"J_\omega", "J_O", r"\mathbf{J}_\omega"), ("J_v", "J_P")),
    ("fk[:3,3]", f"[{POINT}]", ("p", "p_e", r"\mathbf{p}", "{}^0p_e", "T(1:3,4)", "T[:3,3]"), ("R", "T", "T(1:3,3)")),
    ("fk[:3,:3]", f"[{TURN}]", ("R", "R^0_e", r"\mathbf{R}"), ("p", "T")),
    ("dh_poses[1,:3,:3]", f"[{TURN}]", ("R^0_2", "R_2^0", "R_2"), ("R_1^0", "R^0_1")),
    ("com_positions[1]", f"[{POINT}]", ("r_{c2}", "p_{C2}"), ("r_{c1}", "p_{C1}")),
    ("mass_matrix[0]", "[(m1+m2)*l1^2 + m2*l2^2 + 2*m2*l1*l2*c2, m2*l2^2 + m2*l1*l2*c2]", ("M(1,:)",), ("M(2,:)",)),
    ("gravity_torques[:2]", "[(m1+m2)*g*l1*c1 + m2*g*l2*c12; m2*g*l2*c12]", ("g", "G(q)"), ("tau",)),
    ("statics[:2]", rf"\begin{{bmatrix}} {TAU} \end{{bmatrix}}", (r"\tau", r"\boldsymbol{\tau}"), ("g",)),
]  # fmt: skip


@pytest.mark.parametrize(
    ("entry", "text", "name"), [(entry, text, one) for entry, text, names, _no in BLOCKS for one in ("", *names)]
)  # fmt: skip
def test_rows_columns_and_blocks_are_judged_whole(entry, text, name):
    assert kl.diagnose("planar2r", entry, f"{name} = {text}" if name else text).agrees


@pytest.mark.parametrize(
    ("entry", "text", "name"), [(entry, text, one) for entry, text, _yes, names in BLOCKS for one in names]
)  # fmt: skip
def test_a_block_by_the_name_of_another_is_refused(entry, text, name):
    refused("planar2r", entry, f"{name} = {text}")


@pytest.mark.parametrize(
    ("robot", "entry", "text", "places"),
    [
        ("planar2r", "jacobian[0]", "J_x = [l1*s1 - l2*s12, -l2*c12]", ("jacobian[0,0]", "jacobian[0,1]")),
        ("planar2r", "fk[:3,3]", "p = [l1*c1 + l2*c12; l1*s1 + l2*c12; 0]", ("fk[1,3]",)),
        ("planar2r", "com_positions[1,:2]", r"p_{C2} = \begin{pmatrix} l_1 c_1 + l_2 s_{12} \\ l_1 s_1 + l_2 s_{12} \end{pmatrix}", ("com_positions[1,0]",)),
        ("spatial3r", "jacobian[3:]", "[0, 0, sin(q1+q2); 0, 0, cos(q1+q2); 1, 1, 0]", ("jacobian[4,2]",)),
    ],
)  # fmt: skip
def test_what_is_wrong_in_a_block_is_told_by_its_entry(robot, entry, text, places):
    (cause,) = kl.diagnose(robot, entry, text).causes
    assert cause.places == places


@pytest.mark.parametrize(
    ("entry", "text"),
    [
        ("jacobian[0]", "J_x = -l1*s1 - l2*s12"),
        ("jacobian[0]", "J_x = [-l1*s1, -l2*s12, 0]"),
        ("jacobian[:2]", "J = [-l1*s1 - l2*s12, -l2*s12; l1*c1 + l2*c12, l2*c12; 1, 1]"),
        ("fk[:3,3]", "p = [l1*c1 + l2*c12; l1*s1 + l2*s12]"),
    ],
)
def test_a_block_of_another_size_is_refused_with_its_size(entry, text):
    refused("planar2r", entry, text, "write it as a matrix of")


def test_a_block_in_a_file(tmp_path):
    path = tmp_path / "mine.toml"
    path.write_text(f'robot = "planar2r"\n[formulas]\n"fk[:3,3]" = "[{POINT}]"\n', encoding="utf-8")
    (found,) = kl.doctor.file.examine_file(path)
    assert found.agrees and found.quantity == "fk[:3,3]"


@pytest.mark.parametrize(
    ("robot", "entry", "text"),
    [
        ("planar2r_rods", "tau2", "c12 = c12 = cos(q1 + q2)\ntau2 = (I2 + m2*lc2**2)*(qdd1 + qdd2) + m2*l1*lc2*(cos(q2)*qdd1 + sin(q2)*qd1**2) + m2*g*lc2*c12"),
        ("planar2r_rods", "coriolis_matrix", "h = h = 0.5*m2*l1*l2*sin(q2)\nC = [[-h*qd2, -h*(qd1+qd2)], [h*qd1, 0]]"),
        ("planar2r", "C11", r"$h = h = m_2 l_1 l_2 s_2$; $C_{11} = -h \dot\theta_2$"),
        ("single_link", "kinetic_energy", r"杆的动能 $T = \frac{1}{2}\left(I_1 + m_1 l_{c1}^2\right)\dot{q}_1^2$，其中 $l_{c1}=l_1/2$"),
        ("planar2r", "statics[:2]", "# J^T F, F = [Fx, Fy, Nz] at the tool\ntau = [-(l1*s1 + l2*s12)*Fx + (l1*c1 + l2*c12)*Fy + Nz,\n       -l2*s12*Fx + l2*c12*Fy + Nz]"),
        ("isotropic", "fivebar_leg_angles", rf"\theta = {ANGLE}, \quad {ABC}"),
        ("isotropic", "fivebar_leg_angles", rf"Using the tangent half-angle substitution, \theta = {ANGLE} with A = 2 l_1 (s e - x), B = -2 l_1 y and C = l_2^2 - l_1^2 - (s e - x)^2 - y^2; the sign chooses the working mode."),
    ],
)  # fmt: skip
def test_definitions_beside_a_formula(robot, entry, text):
    found = kl.diagnose(robot, entry, text)
    assert found.agrees and not found.remarks, found


def test_beside_a_definition_that_a_slip_leaves_unused_the_slip_is_told():
    text = r"杆的动能 $T = \frac{1}{2}\left(I_1 + m_1 l_1^2\right)\dot{q}_1^2$，其中 $l_{c1}=l_1/2$"
    (cause,) = kl.diagnose("single_link", "kinetic_energy", text).causes
    assert "l_{c1}" in cause.sentence


@pytest.mark.parametrize("wrong", ["B = 2 l_1 y", "C = l_2^2 + l_1^2 - (s e - x)^2 - y^2"])
def test_of_two_solutions_both_are_judged(wrong):
    old = next(one for one in ABC.split(r",\ ") if one[0] == wrong[0])
    found = kl.diagnose(
        "isotropic", "fivebar_leg_angles", rf"\theta = {ANGLE}, \quad {ABC.replace(old, wrong)}"
    )
    assert not found.agrees


@pytest.mark.parametrize(
    ("entry", "text"),
    [
        ("x", "x = l1*c1 ± l2*c12"),
        ("statics[:2]", f"# F = [Fy, Fx, Nz]\ntau = [{TAU}]"),
        ("jacobian[1,0]", "J21 = l1*c1 + l2*c12 (Einheit: mm)"),
        ("jacobian[1,0]", "J21 = l1*c1 + l2*c12 (units: mm)"),
    ],
)
def test_what_may_change_a_formula_is_still_refused(entry, text):
    refused("planar2r", entry, text, ".")


def test_without_a_robot_a_block_stays_one_entry():
    with pytest.raises(ExpressionError, match="is one entry"):
        formula_file({"robot": "planar2r", "formulas": {"jacobian[0]": f"[{ROW}]"}}, "here")


TOOL = "[[c12, -s12, 0, l1*c1 + l2*c12], [s12, c12, 0, l1*s1 + l2*s12], [0, 0, 1, 0], [0, 0, 0, 1]]"


@pytest.mark.parametrize(
    "left",
    ["{}^0_2T", "{}^0_3T", "T_2^0", "T^0_2", "{}^{0}T_{2}", r"\mathbf{T}_2^0", "T_{02}", "T_n"],
)
def test_a_pose_of_the_last_joints_frame_in_the_base_is_the_tools(left):
    assert kl.diagnose("planar2r", "fk", f"{left} = {TOOL}").agrees


@pytest.mark.parametrize(
    "left", ["{}^0_1T", "{}^1_2T", "T_1^0", "T_{1}^{2}", "{}^{0}T_{1}", r"\mathbf{T}_1^0", "T_{01}"]
)
def test_a_pose_of_another_frame_is_another(left):
    with pytest.raises(ExpressionError, match="which is another"):
        kl.diagnose("planar2r", "fk", f"{left} = {TOOL}")


TURNED = "[[c3, -s3, 0, a2], [0, 0, -1, 0], [s3, c3, 0, 0], [0, 0, 0, 1]]"


@pytest.mark.parametrize("left", ["{}^{2}_{3}T", "^2_3T", "{}^2T_3", "T_3^2", "T_{23}", "²T₃"])
def test_a_pose_of_neighbours_is_a_link_transform_in_any_writing(left):
    assert kl.diagnose("spatial3r", "link_transforms[2]", f"{left} = {TURNED}").agrees


@pytest.mark.parametrize("left", ["{}^1_2T", "T_2^3", "{}^{3}T_{2}", "³T₂", "{}^0_3T", "¹T₂"])
def test_a_pose_of_other_neighbours_is_another(left):
    with pytest.raises(ExpressionError, match="which is another"):
        kl.diagnose("spatial3r", "link_transforms[2]", f"{left} = {TURNED}")


def test_a_rotation_of_another_frame_is_another():
    turn = "[[c12, -s12, 0], [s12, c12, 0], [0, 0, 1]]"
    assert kl.diagnose("planar2r", "fk[:3,:3]", f"R_2^0 = {turn}").agrees
    with pytest.raises(ExpressionError, match="which is another"):
        kl.diagnose("planar2r", "fk[:3,:3]", f"R_1^0 = {turn}")


@pytest.mark.parametrize(
    ("left", "said"), [("{}^0_2T", True), ("{}^0_3T", False), ("T_2^0", False)]
)
def test_craigs_last_frame_is_said_to_be_another_than_the_tools(left, said):
    remarks = kl.diagnose("planar2r", "fk", f"{left} = {TOOL}").remarks
    assert any("frame 2 of the table" in one for one in remarks) is said


LAST = ("m2*l2**2 + m2*l1*l2*c2", "m2*l2**2")


@pytest.mark.parametrize(
    ("entry", "text"),
    [
        ("mass_matrix", f"[[(m1 + m2)*l1**2 + m2*l2**2 + 2*m2*l1*l2*c2, {LAST[0]}]]"),
        ("mass_matrix", f"[[(m1 + m2)*l1**2 + m2*l2**2 + 2*m2*l1*l2*c2], [{LAST[0]}]]"),
        ("jacobian", "[[-l1*s1 - l2*s12], [l1*c1 + l2*c12]]"),
        ("fk", "[[c12, -s12, 0, l1*c1 + l2*c12], [s12, c12, 0, l1*s1 + l2*s12]]"),
    ],
)
def test_a_matrix_without_a_row_or_column_is_not_the_whole(entry, text):
    with pytest.raises(ExpressionError, match=f"{entry}: a matrix of . x . is given"):
        kl.diagnose("planar2r", entry, text)


@pytest.mark.parametrize(
    ("entry", "text"),
    [
        ("jacobian", "[[-l1*s1 - l2*s12, -l2*s12], [l1*c1 + l2*c12, l2*c12]]"),
        ("fk", "[[c12, -s12, l1*c1 + l2*c12], [s12, c12, l1*s1 + l2*s12], [0, 0, 1]]"),
        ("fk", "[[c12, -s12, 0, l1*c1+l2*c12], [s12, c12, 0, l1*s1+l2*s12], [0, 0, 1, 0]]"),
        ("com_positions", "[[l1*c1, l1*s1], [l1*c1 + l2*c12, l1*s1 + l2*s12]]"),
    ],
)
def test_a_matrix_may_be_without_what_goes_without_saying(entry, text):
    assert kl.diagnose("planar2r", entry, text).agrees
