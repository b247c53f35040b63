"""Numbers that a writer gives names of his own: one of them is off, and nothing else is told."""

import pytest

import kinlab as kl


@pytest.mark.parametrize(
    ("robot", "quantity", "text", "told"),
    [
        ("planar2r", "fk[1,3]", "y = u*sin(q1) + w*sin(q1+q2), u = 0.7, w = 0.4", "u: 0.7 should be 0.5"),
        ("planar2r", "fk[1,3]", "y = u*sin(q1) + w*sin(q1+q2), u = 0.5, w = 0.04", "w: 0.04 should be 0.4"),
        ("planar2r_rods", "gravity_torques[1]", "k*r*9.81*cos(q1+q2), k = 1.7, r = 0.2", "k: 1.7 should be 1.5"),
        ("planar2r_rods", "gravity_torques[0]",
         "g1 = m1*g*u*cos(q1) + m2*g*(v*cos(q1) + w*cos(q1+q2)), u = 0.25, v = 0.55, w = 0.2", "v: 0.55 should be 0.5"),
        ("planar2r", "mass_matrix", "M = [u + 2*v*c2, w + v*c2; w + v*c2, w], u = 1.115, v = 0.3, w = 0.42", "w: 0.42 should be 0.24"),
        ("spatial3r", "gravity_torques[2]", "m3*g*(u*cos(q3) - v*sin(q3)), u = 0.12, v = 0.13", "v: 0.13 should be 0.03"),
    ],
)  # fmt: skip
def test_the_number_is_told(robot: str, quantity: str, text: str, told: str) -> None:
    found = kl.diagnose(robot, quantity, text, samples=20)
    assert [cause.kinds for cause in found.causes[:1]] == [("number",)]
    assert told in str(found)


@pytest.mark.parametrize(
    ("robot", "quantity", "text", "kinds"),
    [
        ("planar2r", "fk[0,3]", "x = u*cos(q1) - w*cos(q1+q2), u = 0.5, w = 0.4", ("sign",)),
        ("planar2r", "fk[0,3]", "x = u*cos(q1) + w*cos(q2), u = 0.5, w = 0.4", ("argument",)),
        ("planar2r_rods", "gravity_torques[1]", "g2 = m2*g*u*cos(q1+q2), u = 0.4", ("parameter",)),
    ],
)
def test_a_number_of_the_arm_s_is_right(
    robot: str, quantity: str, text: str, kinds: tuple[str, ...]
) -> None:
    assert kl.diagnose(robot, quantity, text, samples=20).causes[0].kinds == kinds
