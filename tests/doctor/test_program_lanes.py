"""A program run once for many combinations of edits: each lane answers as the program with its
edits does, run alone."""

import numpy as np
import pytest
from hand_programs import PROGRAMS, asked, lines_named, searched

from kinlab.doctor.bytecode.syntax import nodes
from kinlab.doctor.program.lanes.functions import with_lanes
from kinlab.doctor.program.lanes.numbers import Laned, Lanes
from kinlab.doctor.program.lanes.run import InLanes
from kinlab.doctor.program.lanes.ways import Ways
from kinlab.doctor.program.places import changed
from kinlab.doctor.program.trial import NoProgramError, quietly

FIVE_BAR = """
import numpy as np

l1, l2, E = np.array([.30, .26]), np.array([.50, .54]), np.array([.12, -.12])
mc, rc, Ic = [1.0, .8], [.12, .15], [.0075, .0060]
mr, rr, Ir = [.40, .35], [.22, .30], [.0083, .0090]
mp, g = 1.5, np.array([0, 9.81])
Im = np.array([1.0e-5*10**2, 1.2e-5*12**2])
perp = lambda p: np.array([-p[1], p[0]])

def f(xy, v, a, mode):
    U, W = [], []
    for i in (0, 1):
        d = xy - np.array([E[i], 0])
        n = np.linalg.norm(d)
        t = np.arctan2(d[1], d[0]) - mode[i]*np.arccos((l1[i]**2 + n*n - l2[i]**2)/(2*l1[i]*n))
        U.append(np.array([np.cos(t), np.sin(t)]))
        W.append((d - l1[i]*U[i])/l2[i])
    k = [perp(U[i]) @ W[i] for i in (0, 1)]
    J = np.array([W[i]/(l1[i]*k[i]) for i in (0, 1)])
    Ji = np.linalg.inv(J)
    B = np.array([-U[i]/(l2[i]*k[i]) for i in (0, 1)])
    td, bd = J @ v, B @ v
    tau = Ji.T @ (mp*(a + g))
    for i in (0, 1):
        u, w = U[i], W[i]
        rest = a + l1[i]*td[i]**2*u + l2[i]*bd[i]**2*w
        tdd = rest @ w/(l1[i]*k[i])
        bdd = -(rest @ u)/(l2[i]*k[i])
        ar = l1[i]*(tdd*perp(u) - td[i]**2*u) + rr[i]*(bdd*perp(w) - bd[i]**2*w)
        dB = B[i] @ Ji
        dT = np.eye(2)[i]
        dc = np.outer(l1[i]*perp(u), dT) + np.outer(rr[i]*perp(w), dB)
        tau += dc.T @ (mr[i]*(ar + g)) + dB*Ir[i]*bdd
        tau += dT*((Ic[i] + mc[i]*rc[i]**2 + Im[i])*tdd + mc[i]*rc[i]*g @ perp(u))
    return tau
"""
OTHERS = {
    "complex numbers": (
        "planar3r",
        "planar_jacobian",
        """
import numpy as np

def f(q):
    joints = [0]
    for k, l in enumerate((0.5, 0.4, 0.25)):
        joints.append(joints[-1] + l*np.exp(1j*sum(q[:k + 1])))
    tip = joints.pop()
    columns = [1j*(tip - z) for z in joints]
    return np.array([[c.real for c in columns], [c.imag for c in columns], [1.0]*3])
""",
    ),
    "objects, recursion, a table in the module": (
        "planar3r",
        "gravity_torques",
        """
import math
from dataclasses import dataclass

@dataclass
class Link:
    l: float
    lc: float
    m: float

ARM = [Link(0.5, 0.25, 3.0), Link(0.4, 0.2, 2.0), Link(0.25, 0.125, 1.0)]
G = 9.81

def below(k, angle):
    if k == len(ARM):
        return 0.0, 0.0
    link = ARM[k]
    weight, moment = below(k + 1, angle)
    return weight + link.m*G, moment

def f(q):
    tau = [0.0, 0.0, 0.0]
    for j in range(3):
        for k in range(j, 3):
            angle = 0.0
            x = 0.0
            for i in range(k + 1):
                angle += q[i]
                if i >= j:
                    x += (ARM[i].l if i < k else ARM[i].lc)*math.cos(angle)
            tau[j] += ARM[k].m*G*x
    return tau
""",
    ),
    "inverse of a matrix": (
        "planar2r",
        "forward_dynamics",
        """
import numpy as np

l1, l2, m1, m2, g = 0.5, 0.4, 2.0, 1.5, 9.81

def f(q, v, tau):
    b = m2*l1*l2*np.cos(q[1])
    h = m2*l1*l2*np.sin(q[1])
    d = m2*l2**2
    M = np.array([[(m1 + m2)*l1**2 + d + 2*b, d + b], [d + b, d]])
    G2 = m2*g*l2*np.cos(q[0] + q[1])
    n = np.array([-h*v[1]*(2*v[0] + v[1]) + (m1 + m2)*g*l1*np.cos(q[0]) + G2, h*v[0]**2 + G2])
    return np.linalg.inv(M) @ (tau - n)
""",
    ),
    "arrays that are filled and added to": (
        "unequal",
        "fivebar_torque",
        FIVE_BAR,
    ),
    "singular values": (
        "planar2r",
        "isotropy_defect",
        """
import numpy as np

def f(q):
    s1, c1, s12, c12 = np.sin(q[0]), np.cos(q[0]), np.sin(q[0] + q[1]), np.cos(q[0] + q[1])
    J = np.array([[-0.5*s1 - 0.4*s12, -0.4*s12], [0.5*c1 + 0.4*c12, 0.4*c12]])
    squares = np.linalg.svd(J, compute_uv=False)**2
    return float(np.sum((squares/squares.mean() - 1)**2))
""",
    ),
    "complex numbers, of the standard library": (
        "planar2r",
        "gravity_torques",
        """
from cmath import exp
import numpy as np

def f(q):
    a1, a2 = 0.5*exp(1j*q[0]), 0.4*exp(1j*(q[0] + q[1]))
    tau = np.array([2.0, 1.5])*9.81
    tau[0] = (tau[0] + tau[1])*a1.real
    tau[1] *= a2.real
    tau[0] += tau[1]
    return tau
""",
    ),
}


def in_every_way(robot, quantity, text):
    """A search with what it has tried."""
    search = searched(robot, quantity, text)
    search.singles()
    return search


def in_lanes(search, some):
    states, each = search.asked.states_at(search.asked.first), [[edit] for edit in some]
    return InLanes(search.trial, search.observed, each, states, counts=False)


def singly(search, tried):
    """Edits that were tried, each in a lane: which answer as they did alone, and which are lost."""
    lanes = in_lanes(search, [edit for edit, _values in tried])
    single = lanes.answers(np.arange(-1, len(tried))[:, None])
    assert single is not None
    alone = np.array([values.reshape(single.shape[1:]) for _edit, values in tried])
    close = np.isclose(single[1:], alone, rtol=1e-9, atol=1e-9).all(axis=(1, 2))
    return lanes, close, np.isnan(single[1:]).any(axis=(1, 2))


TEXTS = {
    **{name: (one.robot, one.quantity, one.text) for name, one in PROGRAMS.items()},
    **OTHERS,
}


def _is_tangent(new) -> bool:
    return isinstance(new, str) and new == "tan"


def _sets_one_block(fields, tried, i, j) -> bool:
    whole = isinstance(tried[i][0].changes[0].new, list)
    return whole and bool(fields[i] & fields[j])


@pytest.mark.many
@pytest.mark.parametrize("name", TEXTS)
def test_a_lane_answers_as_the_edited_program(name) -> None:
    search = in_every_way(*TEXTS[name])
    dice = np.random.default_rng(7)
    tried = [search.tried[k] for k in dice.permutation(len(search.tried))[:250]]
    with quietly():
        lanes, close, lost = singly(search, tried)
        placed = sorted(lanes.placed)
        followed = [k for k in placed if close[k]]
        assert len(placed) > 0.85 * len(tried)
        # what changes how often a loop turns is lost, and said to be
        assert len(followed) > 0.8 * len(placed)
        assert sum(not close[k] and not lost[k] for k in placed) < 0.03 * len(placed)
        apart = lanes.woven.inside()
        # tan(pi/2) is 1e16, and two of these differ by roundings
        followed = [k for k in followed if not _is_tangent(tried[k][0].changes[0].new)]
        fields = [{(id(x.holder), str(x.field)) for x in one.changes} for one, _values in tried]
        # two lines more in one block: alone the second takes the place of the first
        pairs = [(i, j) for i in followed for j in followed if i < j and not apart[i, j]]
        pairs = [(i, j) for i, j in pairs if not _sets_one_block(fields, tried, i, j)]
        pairs = [pairs[k] for k in dice.permutation(len(pairs))[:200]]
        both = lanes.answers(np.array(pairs))
        assert both is not None
        seen = 0
        for (i, j), values in zip(pairs, both, strict=True):
            if np.isnan(values).any():  # a lane that was lost tells nothing
                continue
            try:
                with changed(search.trial, (tried[i][0], tried[j][0])):
                    right = search.asked.answers(search.asked.first)
            except NoProgramError:
                continue
            if right is not None and not np.isfinite(right).all():
                assert not np.isfinite(values).all()
            elif right is not None:
                size = max(1.0, float(np.max(np.abs(right))))  # what cancels is as exact as that
                gap = np.abs(values.ravel() - right.ravel())
                assert float(np.max(gap)) <= 1e-8 * size
                seen += 1
    assert seen > 0.7 * len(pairs)


def test_loops_and_conditions_have_lanes() -> None:
    search = in_every_way(*OTHERS["objects, recursion, a table in the module"])
    kinds = ("loop", "condition")
    tried = [one for one in search.tried if one[0].kind in kinds]
    with quietly():
        lanes, close, _lost = singly(search, tried)
    assert {edit.kind for edit, _values in tried} == {*kinds}
    assert len(tried) > 20
    assert len(lanes.placed) == len(tried)
    assert close.all()


def test_numbers_of_tables_have_lanes() -> None:
    """Beside edits of whole rows, and of the table as a whole."""
    text = """
import numpy as np

LENGTHS = [0.5, 0.4]
MASSES = [2.0, 1.5]
TABLE = [[0.53, 2.1], [0.47, 1.7]]

def f(q):
    tip = TABLE[1][1]*9.81*LENGTHS[1]*np.cos(q[0] + q[1])
    return np.array([(MASSES[0] + MASSES[1])*9.81*TABLE[0][0]*np.cos(q[0]) + tip, tip])
"""
    search = in_every_way("planar2r", "gravity_torques", text)
    tried = [one for one in search.tried if one[0].part == -1]
    with quietly():
        _lanes, close, _lost = singly(search, tried)
    assert {"rows swapped", "columns swapped", "entries swapped"} <= {
        edit.kind for edit, _ in tried
    }
    assert len(tried) > 30
    assert close.all()


def test_a_program_is_left_as_it_was() -> None:
    search = in_every_way(*OTHERS["objects, recursion, a table in the module"])
    before = search.asked.answers(search.asked.first)
    space, sizes = dict(search.trial.space), [len(nodes(tree)) for tree in search.trial.trees]
    with quietly():
        in_lanes(search, [edit for edit, _values in search.tried]).answers(
            np.arange(len(search.tried))[:, None]
        )
    assert search.trial.space == space
    assert [len(nodes(tree)) for tree in search.trial.trees] == sizes
    np.testing.assert_array_equal(search.asked.answers(search.asked.first), before)


def test_a_place_within_a_place() -> None:
    lanes = Lanes(np.array([[0, 1], [0, -1], [1, -1], [-1, -1]]), 10**9)
    x = 3.0

    def inner():
        return lanes.pick((1,), lambda: x, lambda _edit: 2 * x)

    value = lanes.pick((0,), lambda: inner() + 1.0, lambda _edit: 10 * inner())
    np.testing.assert_array_equal(value.within(lanes.all), [60.0, 30.0, 7.0, 4.0])


def test_lanes_that_would_go_another_way_are_lost() -> None:
    lanes = Lanes(np.array([[0], [1], [-1], [-1]]), 10**9)
    value = lanes.pick((0, 1), lambda: 1.0, lambda edit: -1.0 if edit == 0 else 2.0)
    assert isinstance(value, Laned)
    assert value > 0
    np.testing.assert_array_equal(lanes.lost, [True, False, False, False])


@pytest.mark.many
@pytest.mark.parametrize(
    ("name", "slips"),
    [
        pytest.param(
            "inverse of a matrix",
            [("l1*np.cos(q[0])", "l1*np.sin(q[0])"), ("2*b, d + b], [d", "2*b, d - b], [d")],
            id="two that multiply",
        ),
        pytest.param(
            "complex numbers",
            [("1j*(tip - z)", "1j*(tip + z)"), ("sum(q[:k + 1])", "sum(q[:k])"),
             ("[[c.real for", "[[c.imag for")],
            id="three in one chain",
        ),
        pytest.param(
            "inverse of a matrix",
            [("d = m2*l2**2", "d = m2*l2"), ("h*v[0]**2 + G2", "-h*v[0]**2 + G2"),
             ("2*b, d + b", "b, d + b")],
            id="three that multiply two by two",
        ),
    ],
)  # fmt: skip
def test_slips_that_act_on_one_another(name, slips) -> None:
    robot, quantity, text = TEXTS[name]
    for right, wrong in slips:
        assert text.count(right) == 1, right
        text = text.replace(right, wrong)
    found, good = asked(text, robot, quantity)
    assert good, found.sentence
    assert len({*lines_named(found.sentence)}) == len(slips)


def test_types_of_numbers_stay_types() -> None:
    """``dtype=float``, ``isinstance``, ``float(x)``: a number with lanes is one already."""
    text = """
import numpy as np

def f(q):
    q = np.asarray(q, float)
    g = np.zeros(2, dtype=float)
    assert isinstance(float(q[0]), float) or q is not None
    g[1] = 1.5*9.81*0.4*float(np.cos(q[0] + q[1]))
    g[0] = (2.0 + 1.5)*9.81*0.5*np.cos(q[0]) + g[1]
    return np.array(g, dtype=float)
"""
    search = in_every_way("planar2r", "gravity_torques", text)
    tried = search.tried
    with quietly():
        _lanes, close, _lost = singly(search, tried)
    assert close.sum() > 0.8 * len(tried)


def test_a_loop_that_no_lane_runs_through() -> None:
    lanes = Lanes(np.array([[0]]), 10**9)

    def no_range(_edit):
        raise ValueError

    assert [*Ways(lanes).turns((0,), lambda: range(3), no_range, lambda: 2)] == []
    assert lanes.lost.all()


def test_a_singular_matrix_loses_its_lane_alone() -> None:
    lanes = Lanes(np.array([[0], [1], [2]]), 10**9)
    stack = np.random.default_rng(0).normal(size=(3, 2, 2))
    stack[1] = 0.0
    matrix = np.empty((2, 2), dtype=object)
    for i, j in np.ndindex(2, 2):
        matrix[i, j] = Laned(stack[:, i, j].copy(), lanes, lanes.all)
    found = with_lanes({"inv": np.linalg.inv})["inv"](matrix)
    np.testing.assert_array_equal(lanes.lost, [False, True, False])
    for k in (0, 2):
        mine = [[found[i, j].within(lanes.all)[k] for j in (0, 1)] for i in (0, 1)]
        np.testing.assert_allclose(mine, np.linalg.inv(stack[k]), rtol=1e-12)


def test_a_line_that_sets_what_is_not_there_loses_its_lane_alone() -> None:
    lanes = Lanes(np.array([[0], [-1]]), 10**9)
    row = [1.0, 2.0]
    assert lanes.there((0,), lambda: row[2]) == ()
    np.testing.assert_array_equal(lanes.lost, [True, False])
    assert lanes.there((0,), lambda: row[1]) == (0,)


def test_the_least_and_what_is_chosen_in_each_lane() -> None:
    """The lanes that were not of the majority were lost: of a cosine that is held below one."""
    lanes = Lanes(np.array([[0], [1], [2]]), 10**9)
    x = Laned(np.array([-3.0, 0.5, 2.0]), lanes, lanes.all)
    known = with_lanes({name: getattr(np, name) for name in ("clip", "where", "minimum")})
    clipped = [
        known["max"](-1.0, known["min"](1.0, x)),
        known["clip"](x, -1.0, 1.0),
        known["where"](x > 1.0, 1.0, known["where"](x < -1.0, -1.0, x)),
        known["max"]([known["minimum"](x, 1.0), -1.0]),
    ]
    for one in clipped:
        entry = one.item() if isinstance(one, np.ndarray) else one
        np.testing.assert_array_equal(entry.within(lanes.all), [-1.0, 0.5, 1.0])
    assert not lanes.lost.any()
    assert known["max"]([1, 3, 2]) == 3 and known["min"]("ab", key=ord) == "a"
