"""Names that nobody's list has, other points and frames in words, and what is the other's mirror."""

from __future__ import annotations

import pytest

import kinlab as kl
from kinlab.errors import ExpressionError

RATE, LEVER = r"l_1 c_2\dot\theta_1", r"l_1\cos q_1 + l_{c2}\cos(q_1+q_2)"
M12 = r"m_2(l_{c2}^2 + l_1 l_{c2}\cos q_2) + I_2"


@pytest.mark.parametrize(
    ("entry", "name", "right"),
    [
        ("link_velocities[1,1]", "{}^2v_{2,y}", RATE),
        ("link_velocities[1,1]", "v_{2,y}", RATE),
        ("link_velocities[1,1]", "(v_2)_y", RATE),
        ("com_jacobians[1,1,0]", "[J_{v_{c2}}]_{21}", LEVER),
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
