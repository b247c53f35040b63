"""Arms with round numbers, on which a mass is as good as a length: what is told holds for others.

With l1 = l2 = m1 = m2 = 1 and lc1 = lc2 = 0.5 many a wrong edit makes a program right.
"""

from __future__ import annotations

import importlib.util
import sys

import numpy as np
import pytest
from hand_programs import lines_named, repaired, with_slips, written

import kinlab as kl
from kinlab.doctor.program.grounds.apart import arm_apart
from kinlab.doctor.program.grounds.scaled import other_arm
from kinlab.doctor.program.observed import Observed
from kinlab.doctor.program.places import changed
from kinlab.doctor.program.read import read
from kinlab.doctor.program.trial import Trial

ROUND = {"l1": 1.0, "l2": 1.0, "c1": 0.5, "c2": 0.5, "m1": 1.0, "m2": 1.0, "I1": 0.1, "I2": 0.1}
OTHER = {"l1": 0.7, "l2": 0.3, "c1": 0.4, "c2": 0.1, "m1": 2.3, "m2": 3.7, "I1": 0.2, "I2": 0.11}

NAMED = """
import numpy as np

l1, l2, c1, c2 = @l1, @l2, @c1, @c2
m1, m2, I1, I2, g = @m1, @m2, @I1, @I2, 9.81

def f(q, v, a):
    b = m2*l1*c2*np.cos(q[1])
    h = m2*l1*c2*np.sin(q[1])
    d = I2 + m2*c2**2
    M = np.array([[I1 + m1*c1**2 + m2*l1**2 + d + 2*b, d + b], [d + b, d]])
    n = np.array([-h*v[1]*(2*v[0] + v[1]), h*v[0]**2])
    G2 = m2*g*c2*np.cos(q[0] + q[1])
    G = np.array([(m1*c1 + m2*l1)*g*np.cos(q[0]) + G2, G2])
    return M @ a + n + G
"""
WITHIN = """
import numpy as np

def f(q):
    a1, r1, r2 = @l1, @c1, @c2
    m = np.array([@m1, @m2])
    J = {"J1": @I1, "J2": @I2}
    c = np.cos(q[1])
    m11 = m[0]*r1**2 + J["J1"] + m[1]*(a1**2 + r2**2 + 2*a1*r2*c) + J["J2"]
    m12 = m[1]*(r2**2 + a1*r2*c) + J["J2"]
    return np.array([[m11, m12], [m12, m[1]*r2**2 + J["J2"]]])
"""
GIVEN = """
import numpy as np

def f(q, m1=@m1, m2=@m2, l1=@l1, lc1=@c1, lc2=@c2, *, g=9.81):
    G2 = m2*g*lc2*np.cos(q[0] + q[1])
    G1 = m1*g*lc1*np.cos(q[0]) + m2*g*l1*np.cos(q[0]) + G2
    return np.array([G1, G2])
"""
TABLE = """
import numpy as np

links = [[@l1, @c1, @m1], [@l2, @c2, @m2]]

def f(q):
    c = np.cos(np.cumsum(q))
    first, last = links
    second = 9.81*last[2]*last[1]*c[1]
    return np.array([9.81*(first[2]*first[1] + last[2]*first[0])*c[0] + second, second])
"""
PROGRAMS = {
    "named": ("inverse_dynamics", NAMED),
    "within": ("mass_matrix", WITHIN),
    "given": ("gravity_torques", GIVEN),
    "table": ("gravity_torques", TABLE),
}


def arm(numbers):
    """The planar arm of two links with these numbers."""
    links = [
        kl.DHLink(
            a=numbers[f"l{k}"],
            mass=numbers[f"m{k}"],
            com=(numbers[f"c{k}"] - numbers[f"l{k}"], 0, 0),
            inertia=np.diag([0, numbers[f"I{k}"], numbers[f"I{k}"]]),
        )
        for k in (1, 2)
    ]
    return kl.Robot.from_dh(kl.DHTable("round", "standard", links, gravity=(0, -9.81, 0)))


def text_for(text, numbers):
    for name, value in numbers.items():
        text = text.replace(f"@{name}", repr(value))
    return text


def worst(robot, quantity, function) -> float:
    return float(np.max(kl.compare(robot, quantity, function, samples=6).errors))


def holds(name, slip, sentence) -> bool:
    """Whether the program with a slip, repaired as a sentence says, is right for another arm."""
    quantity, text = PROGRAMS[name]
    wrong = text_for(text.replace(*slip), OTHER)
    return any(
        worst(arm(OTHER), quantity, after["f"]) < 1e-9 for after in repaired(wrong, sentence)
    )


@pytest.mark.parametrize("name", PROGRAMS)
def test_the_program_with_the_numbers_of_an_arm_apart_is_right_for_it(name) -> None:
    quantity, text = PROGRAMS[name]
    function = written(text_for(text, ROUND))
    robot = arm(ROUND)
    assert worst(robot, quantity, function) < 1e-12
    trial = Trial(read(function))
    count = 3 if quantity == "inverse_dynamics" else 1
    states = [tuple(np.array([0.3 + k, -0.7 - k]) for k in range(count))]
    other = arm_apart(robot, trial, Observed(trial, states))
    assert other is not None and other.whole
    first, last = other.robot.table.links
    assert len({first.a, last.a, first.mass, last.mass, 1.0}) >= 4
    errors = []
    for way in other.ways:
        with changed(trial, way):
            errors.append(worst(other.robot, quantity, trial.function))
    assert min(errors) < 1e-12 < 1e-3 < worst(other.robot, quantity, function)


@pytest.mark.parametrize(
    ("name", "right", "slip"),
    [
        ("named", "b = m2*l1*c2", "b = m2*c1*c2"),
        ("named", "(m1*c1 + m2*l1)", "(m1*c1 + m2*c1)"),
        ("named", "m2*l1**2 + d", "m2*c1**2 + d"),
        ("named", "h = m2*l1*c2", "h = m2*I1*c2"),
        ("within", "2*a1*r2*c)", "a1*r2*c)"),
        ("within", "+ a1*r2*c)", "+ r1*r2*c)"),
        ("within", "(r2**2 + a1", "(r2 + a1"),
        ("given", "m2*g*lc2*np", "m2*g*l1*lc2**2*np"),
        ("given", "m2*g*l1*np.cos(q[0]) +", "m2*g*l1*np.cos(q[1]) +"),
        ("table", "last[2]*first[0]", "last[2]*first[1]"),
    ],
)
def test_a_repair_holds_for_an_arm_of_other_numbers(name, right, slip) -> None:
    quantity, text = PROGRAMS[name]
    assert text.count(right) == 1
    found = kl.diagnose(arm(ROUND), quantity, written(text_for(text.replace(right, slip), ROUND)))
    assert found.causes and holds(name, (right, slip), found.causes[0].sentence)


def test_a_length_is_not_exchanged_for_a_mass() -> None:
    """Both are half of what they should be, and ``c1, m1 = 1, 0.5`` would make up for it."""
    text = NAMED
    for slip in (("b = m2*l1*c2", "b = m2*c1*c2"), ("(m1*c1 + m2*l1)", "(m1*c1 + m2*c1)")):
        text = text.replace(*slip)
    found = kl.diagnose(arm(ROUND), "inverse_dynamics", written(text_for(text, ROUND)))
    assert found.causes and "exchanged" not in found.causes[0].sentence
    after = repaired(text_for(text, OTHER), found.causes[0].sentence)
    assert any(worst(arm(OTHER), "inverse_dynamics", one["f"]) < 1e-9 for one in after)


def apart(text, robot):
    trial = Trial(read(written(text)))
    states = [(np.array([0.3, -0.7]),) * 3]
    other = arm_apart(robot, trial, Observed(trial, states))
    assert other is not None
    return other


def test_a_number_that_is_none_of_those_called_so_is_odd() -> None:
    robot = arm(ROUND)
    right, wrong = (apart(text_for(NAMED, ROUND | more), robot) for more in ({}, {"c2": 2.0}))
    assert not right.odd and wrong.odd
    assert right.fitting - wrong.fitting == {("c2", ())}


def test_what_a_program_has_no_name_for_stays_as_it_is() -> None:
    """Nobody can change an arm's length in a program that has none of it."""
    text = NAMED.replace("m1, m2, I1, I2, g = @m1,", "m2, I1, I2, g =").replace("m1*", "")
    assert "m1" not in text
    first, last = apart(text_for(text, ROUND), arm(ROUND)).table.links
    assert first.mass == 1.0 and last.mass != 1.0 and first.a != last.a


BY_NUMBERS = """
import numpy as np

LINKS = {1: (0.44, 2.3, 0.19, 0.05), 2: (0.37, 1.7, 0.21, 0.04), 3: (0.25, 1.2, 0.11, 0.05)}

def each(k):
    return LINKS[k]
"""
FROM_ONE = """
import numpy as np

LINKS = [None, (0.44, 2.3, 0.19, 0.05), (0.37, 1.7, 0.21, 0.04), (0.25, 1.2, 0.11, 0.05)]

def each(k):
    return LINKS[k]
"""
IN_TURN = """
import numpy as np

class Link:
    def __init__(self, l, m, c, I):
        self.l, self.m, self.c, self.I = l, m, c, I

LINKS = [Link(0.44, 2.3, 0.19, 0.05), Link(0.37, 1.7, 0.21, 0.04), Link(0.25, 1.2, 0.11, 0.05)]

def each(k):
    return LINKS[k - 1].l, LINKS[k - 1].m, LINKS[k - 1].c, LINKS[k - 1].I
"""
ALIKE = """
import numpy as np

class Link:
    def __init__(self, l, m, c, I):
        self.l, self.m, self.c, self.I = l, m, c, I

LINKS = [Link(1.0, 1.0, 0.5, 1 / 12) for _ in range(3)]

def each(k):
    return LINKS[k - 1].l, LINKS[k - 1].m, LINKS[k - 1].c, LINKS[k - 1].I
"""
MASSES = """
def f(q):
    turned = np.cumsum(q)
    M = np.zeros((3, 3))
    for k in (1, 2, 3):
        m, I = each(k)[1], each(k)[3]
        J = np.zeros((2, 3))
        for j in range(k):
            for i in range(j, k):
                reach = each(i + 1)[0] if i < k - 1 else each(k)[2]
                J[:, j] += reach * np.array([-np.sin(turned[i]), np.cos(turned[i])])
        w = np.array([float(j < k) for j in range(3)])
        M += m * J.T @ J + I * np.outer(w, w)
    return M
"""


@pytest.mark.parametrize("links", [BY_NUMBERS, FROM_ONE, IN_TURN, ALIKE])
def test_a_right_program_is_right_for_each_arm_that_stands_for_all(links, tmp_path) -> None:
    path = tmp_path / "links.py"
    path.write_text(links + MASSES)
    spec = importlib.util.spec_from_file_location("links_of_an_arm", path)
    module = sys.modules["links_of_an_arm"] = importlib.util.module_from_spec(spec)
    spec.loader.exec_module(module)
    own = [module.each(k) for k in (1, 2, 3)]
    table = kl.DHTable(
        "own",
        "standard",
        [
            kl.DHLink(a=a, mass=m, com=(c - a, 0, 0), inertia=np.diag([0, i, i]))
            for a, m, c, i in own
        ],
        gravity=(0, -9.81, 0),
    )
    robot = kl.Robot.from_dh(table)
    assert worst(robot, "mass_matrix", module.f) < 1e-12
    trial = Trial(read(module.f))
    observed = Observed(trial, [(np.array([0.3, -0.7, 0.9]),)])
    found = [arm_apart(robot, trial, observed), other_arm(robot, trial, observed)]
    whole = [other for other in found if other is not None and other.whole]
    assert whole
    for other in whole:
        errors = []
        for way in other.ways:
            with changed(trial, way):
                errors.append(worst(other.robot, "mass_matrix", trial.function))
        assert min(errors) < 1e-12


CENTRES = """
import numpy as np

def f(q, v, a):
    a1, a2 = 0.5, 0.4
    l1, l2 = 0.25, 0.2
    ml1, ml2 = 2.0, 1.5
    Il1, Il2 = 2.0*0.5**2/12, 1.5*0.4**2/12
    g = 9.81
    c1, s2, c2, c12 = np.cos(q[0]), np.sin(q[1]), np.cos(q[1]), np.cos(q[0] + q[1])
    h = ml2*a1*l2*s2
    m12 = Il2 + ml2*(l2**2 + a1*l2*c2)
    m11 = Il1 + ml1*l1**2 + Il2 + ml2*(a1**2 + l2**2 + 2*a1*l2*c2)
    t1 = m11*a[0] + m12*a[1] - h*v[1]*(2*v[0] + v[1]) + (ml1*l1 + ml2*a1)*g*c1 + ml2*l2*g*c12
    t2 = m12*a[0] + (Il2 + ml2*l2**2)*a[1] + h*v[0]**2 + ml2*l2*g*c12
    return np.array([t1, t2])
"""


@pytest.mark.parametrize(
    "slips",
    [
        [("h*v[0]**2 + ml2*l2*g*c12", "h*v[0]**2 + ml2*l2*g*c2"), ("(2*v[0] + v[1])", "(v[0] + v[1])")],
        [("2*a1*l2*c2", "a1*l2*c2"), ("+ h*v[0]**2", "- h*v[0]**2")],
    ],
)  # fmt: skip
def test_lengths_a_and_centres_l_are_those_of_one_arm(slips, tmp_path) -> None:
    """What is called l1 need be no length, where a1 is: two slips are found all the same."""
    found = []
    for name, text in (("right", CENTRES), ("slips", with_slips(CENTRES, slips))):
        path = tmp_path / f"{name}.py"
        path.write_text(text)
        found.append(kl.diagnose("planar2r_rods", "inverse_dynamics", written(text, path)))
    assert found[0].agrees
    lines = CENTRES.split("\n")
    want = {lines.index(next(x for x in lines if right in x)) + 1 for right, _wrong in slips}
    assert {*lines_named(found[1].causes[0].sentence)} == want


ROWS = """
import numpy as np
H = np.pi/180
rows = [(0*H, 0.0, 0.0), (90*H, 0.0, 0.0), (0*H, 0.4318, 0.15005), (-90*H, 0.0203, 0.4318),
        (90*H, 0.0, 0.0), (-90*H, 0.0, 0.0)]

def f(q):
    T = np.eye(4)
    for k, (al, a, d) in enumerate(rows):
        c, s, ca, sa = np.cos(q[k]), np.sin(q[k]), np.cos(al), np.sin(al)
        T = T @ np.array([[c, -s, 0, a], [s*ca, c*ca, -sa, -sa*d], [s*sa, c*sa, ca, ca*d],
                          [0, 0, 0, 1]])
    return T
"""


def test_numbers_of_a_row_that_are_exchanged_are_told_as_that(tmp_path) -> None:
    """Of the numbers of a row the place tells which is whose: they are not two wrong ones."""
    told = []
    for name, text in (("right", ROWS), ("slip", ROWS.replace("0.0203, 0.4318", "0.4318, 0.0203"))):
        path = tmp_path / f"{name}.py"
        path.write_text(text)
        told.append(kl.diagnose("puma560_modified", "fk", written(text, path)).causes)
    assert not told[0]
    told = told[1]
    assert told[0].kinds == ("entries swapped",)
    assert "0.0203, 0.4318)" in told[0].sentence.split("should be")[1]


HALF_BESIDE = """
import numpy as np

L = [0.5, 0.4, 0.25]
M = [3.0, 2.0, 1.0]
C = [np.array([L[i]/2, 0, 0]) for i in range(3)]
P = [np.array([0.0, 0, 0]), np.array([0.5, 0, 0]), np.array([0.4, 0, 0]), np.array([0.25, 0, 0])]
Z = np.array([0.0, 0.0, 1.0])


def rot(t):
    c, s = np.cos(t), np.sin(t)
    return np.array([[c, -s, 0], [s, c, 0], [0, 0, 1]])


def f(q):
    R = [rot(t) for t in q] + [np.eye(3)]
    up, F = np.array([0.0, 9.81, 0.0]), []
    for i in range(3):
        up = R[i].T @ up
        F.append(M[i]*up)
    force, moment, tau = np.zeros(3), np.zeros(3), np.zeros(3)
    for i in (2, 1, 0):
        outer = R[i + 1] @ force
        moment = R[i + 1] @ moment + np.cross(C[i], F[i]) + np.cross(P[i + 1], outer)
        force = outer + F[i]
        tau[i] = moment @ Z
    return tau
"""


@pytest.mark.parametrize(
    ("right", "wrong"),
    [("R[i].T @ up", "R[i] @ up"), ("cross(P[i + 1], outer)", "cross(P[i], outer)")],
)
def test_a_half_in_a_list_of_lengths_is_a_length(right, wrong, tmp_path) -> None:
    """0.5 beside 0.4 and 0.25, so that the lines are right of other arms, too."""
    path = tmp_path / "half.py"
    path.write_text(HALF_BESIDE.replace(right, wrong))
    found = kl.diagnose("planar3r", "gravity_torques", written(path.read_text(), path))
    line = next(k for k, x in enumerate(HALF_BESIDE.split("\n"), 1) if right in x)
    assert lines_named(found.causes[0].sentence)[0] == line


IDLE = """
import numpy as np

def f(q):
    m1, m2, l1, lc1, lc2 = 2.0, 1.5, 0.5, 0.25, 0.2
    I1, I2 = 2.0*0.5**2/12, 1.5*0.4**2/12
    d11 = m1*lc1**2 + m2*(l1**2 + lc2**2 + 2*l1*lc2*np.cos(q[1])) + I1 + I2
    d12 = m2*(lc2**2 + l1*lc2*np.cos(q[1])) + I2
    return np.array([[d11, d12], [d12, m2*lc2**2 + I2]])
"""


def test_a_length_for_a_centre_that_nothing_uses_any_more(tmp_path) -> None:
    """Not m1*(l1 - lc1)**2, which has the same value."""
    path = tmp_path / "idle.py"
    path.write_text(IDLE.replace("m1*lc1**2", "m1*l1**2"))
    found = kl.diagnose("planar2r_rods", "mass_matrix", written(path.read_text(), path))
    assert found.causes[0].kinds[-1] in ("name", "parameter")
    assert "should be `d11 = m1*lc1**2 + m2*" in found.causes[0].sentence


AT_THE_FRAME_BEFORE = """
import numpy as np

d1, a2, d3 = 0.4, 0.5, 0.2
m2, m3, g = 2.0, 1.5, 9.81

def f(q):
    weight = (m2/2 + m3)*a2
    return np.array([0.0, weight*g*np.cos(q[1]), 0.0])
"""


def test_a_centre_at_the_frame_before_goes_along_with_it() -> None:
    """It is at -d of its link: a program needs no number of its own for it."""
    links = [
        kl.DHLink(d=0.4, alpha=np.pi / 2, mass=1.0),
        kl.DHLink(a=0.5, mass=2.0, com=(-0.25, 0, 0)),
        kl.DHLink(d=0.2, mass=1.5, com=(0, 0, -0.2), inertia=np.eye(3)),
    ]
    robot = kl.Robot.from_dh(kl.DHTable("own", "standard", links))
    function = written(AT_THE_FRAME_BEFORE)
    assert worst(robot, "gravity_torques", function) < 1e-12
    trial = Trial(read(function))
    other = arm_apart(robot, trial, Observed(trial, [(np.array([0.3, -0.7, 0.2]),)]))
    last = other.robot.table.links[2]
    assert other.whole and last.com[2] == pytest.approx(-last.d) and last.d != 0.2
    assert any(worst_in(trial, way, other.robot, "gravity_torques") < 1e-12 for way in other.ways)


def worst_in(trial, way, robot, quantity) -> float:
    with changed(trial, way):
        return worst(robot, quantity, trial.function)
