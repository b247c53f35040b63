"""What is told of a program rests on more than this arm's own numbers, and on the user's lines."""

from __future__ import annotations

import ast
import importlib.util
import sys

import numpy as np
import pytest
from hand_programs import repaired, written

import kinlab as kl
from kinlab.doctor.program.edits.single.comparisons import negated
from kinlab.doctor.program.grounds.scaled import other_arm
from kinlab.doctor.program.observed import Observed
from kinlab.doctor.program.own.calls import QUICK
from kinlab.doctor.program.places import changed
from kinlab.doctor.program.read import read
from kinlab.doctor.program.trial import FailedError, Trial

TORQUES = """
import numpy as np

alpha = [0.0, -np.pi/2, 0.0]
a = (0.0, 0.08, 0.38)
d = (0.29, 0.1, -0.05)
m = [5.2, 3.4, 1.9]
pc = [np.array([0.03, 0.02, -0.07]), np.array([0.17, 0.02, -0.04]), np.array([0.14, -0.03, 0.02])]

def step(i, angle):
    c, s, ca, sa = np.cos(angle), np.sin(angle), np.cos(alpha[i]), np.sin(alpha[i])
    return (np.array([[c, -s, 0], [s*ca, c*ca, -sa], [s*sa, c*sa, ca]]),
            np.array([a[i], -sa*d[i], ca*d[i]]))

def f(q):
    g, forces, steps = np.array([0., 0., 9.81]), [], []
    for i in range(3):
        R, p = step(i, q[i])
        g = R.T @ g
        steps.append((R, p))
        forces.append(m[i]*g)
    tau, force, moment = np.zeros(3), np.zeros(3), np.zeros(3)
    for i in (2, 1, 0):
        force, moment = force + forces[i], moment + np.cross(pc[i], forces[i])
        tau[i] = moment[2]
        R, p = steps[i]
        force = R @ force
        moment = R @ moment + np.cross(p, force)
    return tau
"""


@pytest.fixture(scope="module")
def arm() -> kl.Robot:
    """The arm of the program, from its table."""
    twists, lengths, offsets = (0.0, -np.pi / 2, 0.0), (0.0, 0.08, 0.38), (0.29, 0.1, -0.05)
    centres = ((0.03, 0.02, -0.07), (0.17, 0.02, -0.04), (0.14, -0.03, 0.02))
    links = [
        kl.DHLink(a=x, alpha=twist, d=y, mass=mass, com=com, inertia=0.01 * np.eye(3))
        for x, twist, y, mass, com in zip(
            lengths, twists, offsets, (5.2, 3.4, 1.9), centres, strict=True
        )
    ]
    return kl.Robot.from_dh(kl.DHTable("grounds", "modified", links))


def test_the_program_is_right(arm) -> None:
    assert np.max(kl.compare(arm, "gravity_torques", written(TORQUES)).errors) < 1e-12


def test_the_program_with_another_arms_numbers_is_right_for_that_arm(arm) -> None:
    function = written(TORQUES)
    trial = Trial(read(function))
    states = [(np.array([0.3, -0.7, 1.1]),), (np.array([-1.2, 0.4, 0.9]),)]
    other = other_arm(arm, trial, Observed(trial, states))
    assert other is not None and other.whole  # 9.81 is the same for every arm
    twists = [link.alpha for link in other.robot.table.links]
    assert 0.1 < abs(np.cos(twists[1])) < 0.9 and twists[0] == twists[2] == 0
    (edit,) = [one for one in other.ways[0] if one.node == "a"]  # a tuple is made anew, once
    assert edit.changes[0].new == pytest.approx((0.0, 0.1, 0.475))
    with changed(trial, other.ways[0]):
        for (q,) in states:
            engine = kl.gravity_torques(other.robot, q)
            assert np.allclose(trial.function(q), engine, atol=1e-12)
            assert not np.allclose(engine, function(q), rtol=0.1)


def test_the_opposite_of_a_condition() -> None:
    pairs = {"a > 2": "a <= 2", "a == 'x'": "a != 'x'", "a is b": "a is not b", "f(a)": "not f(a)"}
    for text, opposite in pairs.items():
        assert ast.unparse(negated(ast.parse(text, mode="eval").body)) == opposite


@pytest.mark.parametrize(
    ("piece", "slip"),
    [
        ("c*sa, ca]", "c*sa**2, ca]"),
        ("[s*sa, c", "[s*sa**2, c"),
    ],
)
def test_a_repair_holds_at_other_twists(arm, piece, slip) -> None:
    """At alpha = -pi/2 a sine is -1: its square, its cube and its sign are one there."""
    assert TORQUES.count(piece) == 1
    wrong = TORQUES.replace(piece, slip)
    found = kl.diagnose(arm, "gravity_torques", written(wrong))
    assert found.causes
    states = np.random.default_rng(2).uniform(-2, 2, (6, 3))
    assert any(
        all(np.allclose(after["f"](q), written(TORQUES)(q), atol=1e-12) for q in states)
        for after in repaired(wrong, found.causes[0].sentence)
    )
    line = next(k for k, text in enumerate(wrong.splitlines(), 1) if slip in text)
    assert f"line {line} " in found.causes[0].sentence


def test_each_of_several_edits_is_the_users() -> None:
    """tanh(q2) is no slip of the second torque: nothing is added to it and taken away again."""
    text = """
import numpy as np
def f(q):
    second = 1.5 * 9.81 * 0.4 * np.cos(q[0] + q[1])
    return np.array([3.5 * 9.81 * 0.5 * np.cos(q[0]) + second, np.tanh(q[1])])
"""
    found = kl.diagnose("planar2r", "gravity_torques", written(text))
    assert not found.agrees and not found.causes
    assert any("g1" in said for said in found.proved)


def test_an_edit_that_grows_without_end_is_left() -> None:
    """np.outer for np.dot in a product of six frames has 16**7 entries."""
    links = [kl.DHLink(a=0.1 * k, alpha=0.3 * k, d=0.05) for k in range(1, 8)]
    arm = kl.Robot.from_dh(kl.DHTable("seven", "modified", links))
    text = """
import numpy as np
a = [0.1, 0.2, 0.3, 0.4, 0.5, 0.6, 0.7]
alpha = [0.3, 0.6, 0.9, 1.2, 1.5, 1.8, 2.1]
def A(i, th):
    c, s, ca, sa = np.cos(th), np.sin(th), np.cos(alpha[i]), np.sin(alpha[i])
    return np.array([[c, -s, 0, a[i]], [s*ca, s*ca, -sa, -sa*0.05], [s*sa, c*sa, ca, ca*0.05],
                     [0, 0, 0, 1]])
def f(q):
    T = np.eye(4)
    for i, th in enumerate(q):
        T = np.dot(T, A(i, th))
    return T
"""
    with pytest.raises(ValueError, match="so many"):
        QUICK.outer(np.ones(400), np.ones(400))
    grown = "import numpy as np\ndef f(q):\n    return np.outer(np.ones(400), np.ones(400))"
    with pytest.raises(FailedError, match="so many"):
        Trial(read(written(grown))).function(np.zeros(2))
    found = kl.diagnose(arm, "fk", written(text))
    assert "line 7 (in A)" in found.causes[0].sentence


@pytest.mark.parametrize(
    "grown",
    [
        "np.array([sum(q[0] for _ in range(200**2))])",
        "np.array([np.array([[1.0] * 400] * 400)[0, 0]])",
    ],
)
def test_no_loop_and_no_array_grows_with_an_edit(grown):
    text = f"import numpy as np\ndef f(q):\n    return {grown}"
    with pytest.raises(FailedError, match="so many"):
        Trial(read(written(text))).function(np.zeros(2))


_OF_OBJECTS = """
import numpy as np

class Link:
    def __init__(self, a, m, lc, I, Ia):
        self.a, self.m, self.lc, self.I, self.Ia = a, m, lc, I, Ia

LINKS = [Link(0.5, 2.0, 0.31, 0.07, 0.45), Link(0.4, 1.5, 0.27, {moment}, 0.33)]

def f(q):
    one, two = LINKS
    c = np.cos(q[1])
    m22 = two.I + two.m * two.lc**2
    m12 = m22 + two.m * one.a * two.lc * {turn}
    m11 = one.I + one.m * one.lc**2 + two.I
    m11 += two.m * (one.a**2 + two.lc**2 + 2 * one.a * two.lc * c)
    return np.array([[m11 + one.Ia, m12], [m12, m22 + two.Ia]])
"""


def _arm_of_objects() -> kl.DHTable:
    links = [
        kl.DHLink(a=a, mass=m, com=(lc - a, 0, 0), inertia=np.diag([0, i, i]), armature=drive)
        for a, m, lc, i, drive in ((0.5, 2.0, 0.31, 0.07, 0.45), (0.4, 1.5, 0.27, 0.04, 0.33))
    ]
    return kl.DHTable("objects", "standard", links)


@pytest.mark.parametrize("moment", ["0.04", "0.06"])
@pytest.mark.parametrize("turn", ["c", "np.sin(q[1])"])
def test_numbers_of_objects_are_called_as_what_makes_these_is_given(moment, turn, tmp_path) -> None:
    """A repair in the lines that make the objects is believed; no drive's inertia is odd."""
    path = tmp_path / "objects_of_links.py"
    path.write_text(_OF_OBJECTS.format(moment=moment, turn=turn))
    spec = importlib.util.spec_from_file_location("objects_of_links", path)
    module = sys.modules["objects_of_links"] = importlib.util.module_from_spec(spec)
    spec.loader.exec_module(module)
    found = kl.diagnose(_arm_of_objects(), "mass_matrix", module.f)
    told = found.causes[0].sentence if found.causes else ""
    assert found.agrees == ((moment, turn) == ("0.04", "c"))
    assert ("0.06" in told) == (moment == "0.06"), str(found)
    assert ("np.sin(q[1])" in told) == (turn != "c"), str(found)
