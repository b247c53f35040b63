"""Sentences that a student reads: none says what is not so, none needs the engine's own names."""

from dataclasses import replace

import numpy as np

import kinlab as kl

L1, L2 = 0.5, 0.4  # planar2r


def told(robot, quantity, formula):
    found = kl.diagnose(robot, quantity, formula)
    assert not found.agrees
    return str(found)


def test_a_factor_that_is_missing_is_not_there_twice():
    def torque(q, v, a):  # the weight acts at l/2, and with the cosine
        return 2.5 * 0.6**2 / 3 * a[0] + 2.5 * 9.81 * 0.6 * np.sin(q[0])

    said = told("single_link", "inverse_dynamics", torque)
    assert "twice" not in said
    assert "it has 1 where the engine has 1/2 in m1*g*l1*cos(q1)/2" in said


def test_a_bare_number_is_no_formula_with_every_factor_left_out():
    for quantity in ("gravity_torques", "isotropy_conditions"):
        assert "is missing in" not in told("planar2r", quantity, lambda q: np.array([1.0, 2.0]))


def test_another_shape_is_told_in_numbers():
    said = told("planar2r", "jacobian", lambda q: np.zeros((2, 2)))
    assert "it answers with 2 x 2 numbers, jacobian has 6 x 2 numbers" in said
    assert "ask for 'jacobian[:2]' (the first) or 'jacobian[4:]' (the last)" in said
    assert "shape at" not in said
    assert "inf" not in said
    assert "it answers with a single number" in told("planar2r", "gravity_torques", lambda q: 3.0)


def test_entries_of_a_matrix_are_counted_from_one():
    m11, m12 = "m1*l1^2 + m2*(l1^2 + l2^2 + 2*l1*l2*c2)", "m2*l2^2 + m2*l1*l2*c2"
    said = told("planar2r", "mass_matrix", f"[[{m11}, {m12}], [{m12}, m1*l2^2]]")
    assert said.startswith("M11, M12, M21, M22: differs")
    assert "M22: m1 should be m2" in said
    assert "[" not in said


def test_a_link_left_out_of_the_kinetic_energy_is_not_told_of_gravity():
    said = told("planar2r", "T", "m1*l1^2*qd1^2/2")
    assert "leaves link 2 out" in said
    assert "gravity" not in said


def test_another_mass_is_not_told_as_a_slip_in_every_term_it_stands_in():
    """A default is no line: m2 = 1 looks like a factor that is left out, and m1 + m2 like 2 m2."""

    def torques(q, m1=2.0, m2=1.0):
        second = m2 * 9.81 * L2 * np.cos(q[0] + q[1])
        return np.array([(m1 + m2) * 9.81 * L1 * np.cos(q[0]) + second, second])

    said = told("planar2r", "gravity_torques", torques)
    assert "m1*g*l1*cos(q1) (index)" not in said
    assert "1.5" in said


def test_the_sign_of_a_text_is_told_where_nothing_is_derived():
    """The torque of an arm with five joints; beside it no rotation was left out in every line."""
    table = kl.load("scara").table
    arm = replace(
        table, name="scara5", links=[*table.links, kl.DHLink(mass=0.1, inertia=0.01 * np.eye(3))]
    )
    for typed in (
        "(m3 + m4 + m5)*g - (m3 + m4 + m5 + Ia3)*qdd3",
        "m3*g + m4*g + m5*g - (m3 + m4 + m5 + Ia3)*qdd3",
    ):
        said = told(arm, "tau3", typed)
        assert f"tau3: {typed} should be -({typed}) (sign)" in said
        assert f"correct: tau3 = -({typed})" in said
        assert "or:" not in said


def test_one_entry_of_bare_ones_says_nothing_of_rows():
    """A one for a zero: the entry of another row is one, but so are half of all entries."""
    assert "exchanged" not in told("double_pendulum", "jacobian[5,0]", "1")
    assert "sign" in told("planar2r", "J31", "-1")
