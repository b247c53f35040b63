"""Two and three slips in one program, and what tells which edits may go together."""

import numpy as np
import pytest
from hand_programs import PROGRAMS, asked, lines_named, names_a_line, slipped

from kinlab.doctor.program.several.effects import Effects

FK, NE = PROGRAMS["dh fk"], PROGRAMS["newton-euler"]
ENERGIES = """
import numpy as np

l1, l2 = 0.5, 0.4
m = [2.0, 1.5]

def f(q, v):
    Jv1 = np.array([[-l1*np.sin(q[0]), 0], [l1*np.cos(q[0]), 0]])
    s12, c12 = np.sin(q[0] + q[1]), np.cos(q[0] + q[1])
    Jv2 = np.array([[-l1*np.sin(q[0]) - l2*s12, -l2*s12], [l1*np.cos(q[0]) + l2*c12, l2*c12]])
    return np.array([0.5*m[0]*np.sum((Jv1 @ v)**2), 0.5*m[1]*np.sum((Jv2 @ v)**2)])
"""

GRADIENT = """
import numpy as np

L = np.array([0.5, 0.4, 0.25])

def f(q, target):
    th = np.cumsum(q)
    c, s = L * np.cos(th), L * np.sin(th)
    e = np.asarray(target) - np.array([c.sum(), s.sum(), th[2]])
    out = np.zeros(3)
    for j in range(3):
        out[j] = e[0] * s[j:].sum() - e[1] * c[j:].sum() - e[2]
    return out
"""


@pytest.mark.many
@pytest.mark.parametrize(
    ("robot", "quantity", "text", "slips"),
    [
        pytest.param(
            FK.robot, FK.quantity, FK.text,
            [("-pi/2, pi/2, -pi/2", "pi/2, pi/2, -pi/2"), ("0.4318, 0.0203", "-0.4318, 0.0203")],
            id="two factors of one product",
        ),
        pytest.param(
            NE.robot, NE.quantity, NE.text,
            [("9.81, 0])", "-9.81, 0])"), ("np.cross(r, fi)", "np.cross(fi, r)")],
            id="gravity alone at rest",
        ),
        pytest.param(
            "planar2r", "link_kinetic_energies", ENERGIES,
            [("0.5*m[0]", "m[0]"), ("c12, l2*c12", "c12, l1*c12")],
            id="an entry each",
        ),
        pytest.param(
            "planar3r", "loss_gradient", GRADIENT,
            [("np.cumsum(q)", "np.asarray(q)"), ("c[j:]", "s[j:]")],
            id="neither alone makes any number right",
        ),
    ],
)  # fmt: skip
def test_slips_that_are_apart(robot, quantity, text, slips) -> None:
    for right, wrong in slips:
        assert text.count(right) == 1
        text = text.replace(right, wrong)
    found, good = asked(text, robot, quantity)
    assert good, found.sentence
    assert len(found.causes[0].kinds) == 2


@pytest.mark.campaign
@pytest.mark.parametrize("name", PROGRAMS)
def test_no_repair_of_two_slips_is_false(name) -> None:
    program, told = PROGRAMS[name], 0
    for seed in range(5000, 5012):
        first = slipped(program.text, seed)
        both = slipped(first[0], seed + 100) if first else None
        if both is None:
            continue
        try:
            found, good = asked(both[0], program.robot, program.quantity)
        except Exception:  # noqa: BLE001  what does not run is no program
            continue
        if found.causes and names_a_line(found.causes[0].sentence):
            assert good, (seed, found.sentence)
            told += 1
    assert told >= 2


def test_what_edited_runs_write_into_data_is_undone() -> None:
    """Among the edits is `D[5] = ...` for `tau[5] = ...`; the slip is in D itself."""
    text = """
import numpy as np

D = [0.5, -0.4, 0.25]

def f(q, W):
    th = np.cumsum(q)
    tau = np.zeros(3)
    x, y = 0.0, 0.0
    for i in range(2, -1, -1):
        x = x + D[i]*np.sin(th[i])
        y = y + D[i]*np.sin(th[i])
        tau[i] = x*W[1] - y*W[0] + W[5]
    return tau
"""
    found, good = asked(text, "planar3r", "statics")
    assert good, found.sentence
    assert 11 in lines_named(found.sentence)
    assert "D[1]" in found.sentence


def effects(rows, own, goal):
    rows = np.array(rows, dtype=float)
    return Effects(
        [[Named(k)] for k in range(len(rows))],
        rows,
        np.array(own),
        np.array(goal),
        1e-7,
        lambda edit: 1.0,
    )


class Named:
    """An edit as far as effects know it."""

    kind, cost = "sign", 1.0

    def __init__(self, k) -> None:
        self.k = k


def test_where_one_is_silent_the_other_must_be_right() -> None:
    # number 0 is changed by edits 0 and 2, number 1 by 1 and 2; edit 3 spoils number 0
    rows = [[1, 0, 3], [0, 2, 1], [1, 1, 1], [5, 0, 1]]
    known = effects(rows, [1, 1, 1], [1, 2, 7])
    assert known.pairs()[0] == (0, 1)
    assert (1, 3) not in known.pairs()
    assert known.gaining[:2] == [0, 1]


def test_effects_that_add_up_or_multiply_come_first() -> None:
    rows = [[1, 1], [2, 3], [4, 0.5], [0.5, 0.25]]
    sums = effects(rows, [10, 20], [3, 4])
    assert sums.pairs()[0] == (0, 1)
    assert sums.adding_up(2) == [(0, 1)]
    own, both = np.array([10, 20]), np.array([14 / 10, 20.5 / 20]) * np.array([10.5, 20.25])
    assert effects(rows, own, both - own).pairs()[0] == (2, 3)


def test_edits_of_two_factors_of_a_product() -> None:
    dice = np.random.default_rng(3)
    first, middle, last, other, another = dice.uniform(-1, 1, (5, 4, 4))
    own = first @ middle @ last
    rows = [
        dice.uniform(-1, 1, (4, 4)),
        other @ middle @ last - own,
        first @ middle @ another - own,
    ]
    known = effects(
        [row.ravel() for row in rows], own.ravel(), (other @ middle @ another - own).ravel()
    )
    assert known.in_a_row(2, (4, 4)) == [(1, 2)]
