"""Slips made in right tables are named, and the repaired table is right by Pinocchio."""

from __future__ import annotations

import math
from dataclasses import replace

import numpy as np
import pytest
from hypothesis import assume, given, settings
from hypothesis import strategies as st
from random_tables import random_table

import kinlab as kl


def row(table, i, **cells):
    """The table with cells of row i (1-based) replaced."""
    links = list(table.links)
    links[i - 1] = replace(links[i - 1], **cells)
    return replace(table, links=links)


def poses(table, seed=5, count=20):
    """Tool poses by Pinocchio."""
    q = np.random.default_rng(seed).uniform(-2.0, 2.0, (count, table.n))
    return kl.fk(kl.Robot.from_dh(table), q)


def poses_at(table, q):
    """The same at given joint positions."""
    return kl.fk(kl.Robot.from_dh(table), q)


def named(found):
    return [(cause.row, cause.column, cause.kind) for cause in found.causes]


def diagnosed(mine, against):
    """The diagnosis, whose repaired table must have the reference's poses."""
    found = kl.diagnose_table(mine, against)
    assert not found.agrees and found.verdict == "differs"
    right = against if isinstance(against, kl.DHTable) else against.table
    np.testing.assert_allclose(poses(found.repaired), poses(right), atol=1e-8)
    return found


PUMA = kl.load("puma560").table
PANDA = kl.load("panda").table
STANFORD = kl.load("stanford").table


def test_the_sentence_of_the_issue_theta_lacks_90_degrees():
    right = row(PUMA, 3, theta=-math.pi / 2)
    found = diagnosed(PUMA, right)
    assert found.sentence == "row 3: theta lacks -90 deg"
    cause = found.causes[0]
    assert (cause.row, cause.column, cause.kind) == (3, "theta", "missing")
    assert cause.written == 0.0 and cause.meant == -math.pi / 2
    assert found.repaired == right
    assert found.same_arm and found.differences == ("zero of joint 3 differs by -90 deg",)


def test_the_sentence_of_the_issue_two_rows_with_a_and_d_exchanged():
    links = PUMA.links
    mine = row(row(PUMA, 2, a=links[1].d, d=links[1].a), 3, a=links[2].d, d=links[2].a)
    found = diagnosed(mine, PUMA)
    assert found.sentence == "rows 2 and 3: a and d are exchanged"
    assert found.repaired == PUMA


def test_five_classic_slips_in_a_puma_table():
    slips = {
        "convention": (replace(PUMA, convention="modified"), [(None, "convention", "convention")]),
        "alpha": (row(PUMA, 3, alpha=math.pi / 2), [(3, "alpha", "sign")]),
        "offset": (row(PUMA, 2, theta=math.pi / 2), [(2, "theta", "quarter-turn")]),
        "a and d": (row(PUMA, 3, a=PUMA.links[2].d, d=PUMA.links[2].a),
                    [(3, "a, d", "exchanged")]),
        "mm": (replace(PUMA, links=[replace(k, a=1000 * k.a, d=1000 * k.d) for k in PUMA.links]),
               [(None, "units", "millimetres")]),
    }  # fmt: skip
    for name, (mine, causes) in slips.items():
        found = diagnosed(mine, PUMA)
        assert named(found) == causes, name
        assert found.repaired == PUMA, name


@pytest.mark.parametrize(
    ("change", "cause"),
    [
        ({"theta": math.pi}, (4, "theta", "half-turn")),
        ({"theta": 0.0}, (4, "theta", "missing")),
        ({"theta": 1.0}, (4, "theta", "sign")),
        ({"theta": math.degrees(-1.0)}, (4, "theta", "degrees")),
        ({"alpha": -math.pi / 2}, (4, "alpha", "sign")),
        ({"alpha": 0.0}, (4, "alpha", "missing")),
        ({"alpha": 90.0}, (4, "alpha", "degrees")),
        ({"a": -0.0825}, (4, "a", "sign")),
        ({"a": 82.5}, (4, "a", "millimetres")),
        ({"a": 0.825}, (4, "a", "decimal")),
        ({"a": 0.0285}, (4, "a", "digits exchanged")),
        ({"a": 0.0}, (4, "a", "missing")),
        ({"flip": True}, (4, "flip", "sense")),
        ({"joint": "prismatic", "lower": None, "upper": None}, (4, "joint", "type")),
    ],
)
def test_one_cell_is_named(change, cause):
    right = row(PANDA, 4, theta=-1.0)
    if change.get("theta") == math.pi:
        right = row(PANDA, 4, theta=0.0)
    found = diagnosed(row(right, 4, **change), right)
    assert named(found) == [cause]
    assert found.certain_rows == (1, 2, 3, 5, 6, 7) and found.rows_in_question == (4,)


def test_the_offset_of_a_prismatic_joint():
    right = row(STANFORD, 3, d=0.2)
    found = diagnosed(STANFORD, right)
    assert named(found) == [(3, "d", "missing")]
    assert "the offset of the prismatic joint" in found.sentence
    assert found.differences == ("zero of joint 3 differs by 0.2 m",)


def test_rows_exchanged_left_out_and_doubled():
    links = list(PANDA.links)
    exchanged = replace(PANDA, links=[*links[:3], links[4], links[3], *links[5:]])
    assert named(diagnosed(exchanged, PANDA)) == [((4, 5), "order", "exchanged")]
    out = diagnosed(replace(PANDA, links=[*links[:3], *links[4:]]), PANDA)
    assert named(out) == [(4, "order", "left out")]
    assert out.repaired.links[3].mass == PANDA.links[3].mass
    twice = replace(PANDA, links=[*links[:3], replace(links[2], name=None), *links[3:]])
    found = diagnosed(twice, PANDA)
    assert named(found)[0][1:] == ("order", "doubled") and named(found)[0][0] in (3, 4)


def test_columns_and_index():
    degrees = replace(PANDA, links=[replace(k, alpha=math.degrees(k.alpha)) for k in PANDA.links])
    assert named(diagnosed(degrees, PANDA)) == [(None, "units", "degrees")]
    a = [k.a for k in PANDA.links[1:]] + [0.0]
    alpha = [k.alpha for k in PANDA.links[1:]] + [0.0]
    shifted = replace(
        PANDA,
        links=[replace(k, a=x, alpha=y) for k, x, y in zip(PANDA.links, a, alpha, strict=True)],
    )
    found = kl.diagnose_table(shifted, PANDA, dynamics=False)
    assert named(found)[0][1:] == ("a, alpha", "shifted")
    # the same rows read by the other convention are the same arm: listed as equally good
    assert [c.column for c in found.alternatives[0]] == ["convention"]


@pytest.mark.parametrize("which", ["base", "tool"])
def test_base_and_tool(which):
    rng = np.random.default_rng(1)
    turn, _ = np.linalg.qr(rng.normal(size=(3, 3)))
    pose = np.eye(4)
    pose[:3, :3] = turn * np.sign(np.linalg.det(turn))
    pose[:3, 3] = (0.1, -0.2, 0.3)
    right = replace(PUMA, **{which: pose})
    back = np.linalg.inv(pose)
    back[3] = (0, 0, 0, 1)
    turned = pose.copy()
    turned[:3, :3] = pose[:3, :3].T
    for mine, kind in ((np.eye(4), "missing"), (back, "inverted"), (turned, "transposed")):
        found = diagnosed(replace(PUMA, **{which: mine}), right)
        assert named(found) == [(None, which, kind)]
        np.testing.assert_allclose(getattr(found.repaired, which), pose, atol=1e-12)


def test_two_slips_are_found():
    mine = row(row(PUMA, 2, theta=math.pi / 2), 3, a=PUMA.links[2].a + 0.01)
    assert sorted(named(diagnosed(mine, PUMA))) == [
        (2, "theta", "quarter-turn"), (3, "a", "digit"),
    ]  # fmt: skip
    mine = replace(row(PUMA, 3, d=-PUMA.links[2].d), convention="modified")
    assert {c.column for c in diagnosed(mine, PUMA).causes} == {"convention", "d"}


def test_three_slips_are_not_guessed_and_the_rows_in_question_are_told():
    mine = row(row(PUMA, 1, alpha=0.3), 2, theta=0.7, a=0.1)
    mine = row(mine, 3, d=0.4)
    found = kl.diagnose_table(mine, PUMA)
    assert not found.agrees and not found.causes and found.repaired is None
    assert found.verdict == "differs, cause unknown"
    assert found.certain_rows == (4, 5, 6) and found.rows_in_question == (1, 2, 3)
    assert "rows 4, 5 and 6 certainly right" in found.sentence


def test_equally_good_causes_are_listed():
    scara = kl.load("scara").table  # parallel axes: d of any row lifts the tool as well
    q = np.random.default_rng(2).uniform(-1.0, 1.0, (20, scara.n))
    mine = row(scara, 2, d=scara.links[1].d + 0.05)
    found = kl.diagnose_table(mine, poses=(q, poses_at(scara, q)))
    told = [named(found)[0], *[(c.row, c.column, c.kind) for o in found.alternatives for c in o]]
    assert {place[0] for place in told if place[1] == "d"} == {1, 2, 3, 4}


@settings(max_examples=60, deadline=None)
@given(
    st.integers(0, 2**32 - 1), st.integers(3, 7), st.sampled_from(["standard", "modified"]),
    st.sampled_from(["a", "alpha", "d", "theta"]), st.floats(-1.0, 1.0),
)  # fmt: skip
def test_a_number_that_nobody_could_guess_is_solved_for(seed, n, convention, column, change):
    assume(abs(change) > 1e-3)
    right = random_table(seed, n, convention)
    i = seed % n + 1
    value = getattr(right.links[i - 1], column)
    mine = row(right, i, **{column: value + change})
    assume(np.max(np.abs(poses(mine) - poses(right))) > 1e-4)
    found = kl.diagnose_table(mine, right)
    assert not found.agrees and found.causes
    np.testing.assert_allclose(poses(found.repaired), poses(right), atol=1e-8)
    told = [found.causes, *found.alternatives]
    assert any((c.row, c.column) == (i, column) for causes in told for c in causes)


def test_the_same_seed_gives_the_same_answer():
    mine = row(PUMA, 2, theta=math.pi / 2)
    one, two = (kl.diagnose_table(mine, PUMA, seed=3).as_dict() for _ in range(2))
    assert one == two
