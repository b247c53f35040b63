"""Edits that make a program right and are not its slip are not told."""

import numpy as np
import pytest

import kinlab as kl
from kinlab.doctor.program.search import solved

M1, M2, L1, L2, g = 2.0, 1.5, 0.5, 0.4, 9.81  # planar2r


def right(q):
    second = M2 * g * L2 * np.cos(q[0] + q[1])
    return np.array([(M1 + M2) * g * L1 * np.cos(q[0]) + second, second])


def with_a_branch(q):
    second = M2 * g * L2 * np.cos(q[0] + q[1])
    if abs(q[1]) < 0.5:
        return np.zeros(2)
    return np.array([(M1 + M2) * g * L1 * np.cos(q[0]) + second, second])


def with_a_rare_branch(q):
    second = M2 * g * L2 * np.cos(q[0] + q[1])
    if q[0] > 3.1:
        second = 0.0
    return np.array([(M1 + M2) * g * L1 * np.cos(q[0]) + second, second])


def in_millimetres(q):
    l1, l2 = 500.0, 400.0
    second = M2 * g * l2 * np.cos(q[0] + q[1])
    return np.array([(M1 + M2) * g * l1 * np.cos(q[0]) + second, second])


def rounded(q):
    return np.round(right(q), 2)


@pytest.mark.parametrize(
    ("function", "told", "false"),
    [
        (with_a_branch, "`if abs(q[1]) < 0.5` should be `if False`", "abs(M2)"),
        (with_a_rare_branch, "`if q[0] > 3.1` should be `if False`", "6.2"),
        (in_millimetres, "differs", "9.81 should be"),
        (rounded, "its answers are rounded to 2 decimals", "should be"),
    ],
)
def test_a_repair_that_hides_the_slip_is_not_told(function, told, false):
    said = str(kl.diagnose("planar2r", "gravity_torques", function))
    assert told in said
    assert false not in said


def test_the_step_of_a_difference_is_no_slip():
    def potential(q):
        return g * (M1 * L1 * np.sin(q[0]) + M2 * (L1 * np.sin(q[0]) + L2 * np.sin(q[0] + q[1])))

    def differences(q):
        step = 0.01
        return np.array([(potential(q + step * d) - potential(q)) / step for d in np.eye(2)])

    said = str(kl.diagnose("planar2r", "gravity_torques", differences))
    assert "step = 0.01` should be" not in said


@pytest.mark.parametrize(
    ("old", "new", "makes_up"),
    [(2.0, 0.6143, True), (2.0, 1.5, False), (2.0, 1 / 3, False), (0.7, 0.6143, False)],
)
def test_a_number_of_the_arm_does_not_become_one_of_nobodys(old, new, makes_up) -> None:
    assert solved.makes_up(kl.load("planar2r"), old, new) is makes_up


def test_a_wrong_solution_is_not_left_out_by_giving_the_other_twice() -> None:
    def solve(x, y):  # type: ignore[no-untyped-def]
        inner = np.arccos((0.25 + 0.16 - x * x - y * y) / 0.4)
        lean = np.arccos((x * x + y * y + 0.09) / np.hypot(x, y))
        down = (np.arctan2(y, x) - lean, inner)
        up = (np.arctan2(y, x) + lean, inner - np.pi)
        return [down, up]

    found = kl.diagnose("planar2r", "inverse_kinematics_xy", solve, samples=60)
    assert found.proved or found.causes
    told = [cause.sentence for cause in found.causes]
    assert not any("[up, up]" in one or "[down, up]" in one for one in told)


def test_what_is_left_is_no_difference_where_nothing_is_differenced() -> None:
    """A number solved for to six digits leaves 1e-6: there is no step that would excuse it."""

    def lost(q):  # type: ignore[no-untyped-def]
        outer = 1.5 * 9.81 * 0.4 * np.cos(q[0] + q[1])
        return np.array([2.123457 * 9.81 * np.cos(q[0]) + outer, outer])

    found = kl.diagnose("planar2r", "gravity_torques", lost)
    assert "finite differences" not in str(found) and all(
        c.error_after < 1e-9 for c in found.causes
    )


def test_a_number_that_the_table_has_there_is_not_solved_for() -> None:
    """Where an offset of 0.1 is forgotten, a centre at -0.02 for -0.12 would make up for it."""
    centres, masses = [0.03, -0.12], [2.0, 1.0]

    def slide(q):
        s, c = np.sin(q[0]), np.cos(q[0])
        r = q[1] + centres[1]
        first = -s * (masses[0] * centres[0] + masses[1] * r) - masses[1] * 0.02 * c
        return 9.81 * np.array([first, masses[1] * c])

    coms = ([0, 0, 0.03], [-0.02, 0, -0.12])
    rows = (("revolute", -np.pi / 2, 0.0), ("prismatic", 0.0, 0.1))
    links = [
        kl.DHLink(kind, a=0, alpha=alpha, d=d, theta=0, mass=m, com=com, inertia=0.01 * np.eye(3))
        for (kind, alpha, d), m, com in zip(rows, masses, coms, strict=True)
    ]
    arm = kl.DHTable("slide", "standard", links, gravity=[0, -9.81, 0])
    said = str(kl.diagnose(arm, "gravity_torques", slide))
    assert "-0.12 should be" not in said
    assert "0.1" in said
