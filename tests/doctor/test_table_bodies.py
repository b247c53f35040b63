"""Slips in masses, centres, inertias, armatures and gravity."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from random_tables import random_table

import kinlab as kl

PANDA = kl.load("panda").table
LINK = PANDA.links[3]
COM, INERTIA = np.asarray(LINK.com), np.asarray(LINK.inertia)
OFF = INERTIA - 2 * (INERTIA - np.diag(np.diag(INERTIA)))
STEP = PANDA.link_transforms(np.zeros(7))[3]
ONE_LESS, ONE_SMALL = INERTIA.copy(), INERTIA.copy()
ONE_LESS[0, 1] = ONE_LESS[1, 0] = 0.0
ONE_SMALL[0, 1] = ONE_SMALL[1, 0] = 0.1 * INERTIA[0, 1]


def steiner(mass, c):
    return mass * (c @ c * np.eye(3) - np.outer(c, c))


def row(table, i, **cells):
    links = list(table.links)
    links[i - 1] = replace(links[i - 1], **cells)
    return replace(table, links=links)


def dynamics(table, q):
    robot = kl.Robot.from_dh(table)
    return kl.mass_matrix(robot, q), kl.gravity_torques(robot, q)


@pytest.mark.parametrize(
    ("change", "cause"),
    [
        ({"mass": 0.0}, ("mass", "missing")),
        ({"mass": 10 * LINK.mass}, ("mass", "decimal")),
        ({"mass": 1000 * LINK.mass}, ("mass", "grams")),
        ({"com": -COM}, ("com", "sign")),
        ({"com": COM * (1, -1, 1)}, ("com", "sign")),
        ({"com": COM[[1, 0, 2]]}, ("com", "axes")),
        ({"com": 1000 * COM}, ("com", "millimetres")),
        ({"com": (STEP @ [*COM, 1])[:3]}, ("com", "frame")),
        ({"inertia": INERTIA + steiner(LINK.mass, COM)}, ("inertia", "origin")),
        ({"inertia": OFF}, ("inertia", "products")),
        ({"inertia": 10 * INERTIA}, ("inertia", "decimal")),
        ({"inertia": np.zeros((3, 3))}, ("inertia", "missing")),
        ({"inertia": ONE_LESS}, ("inertia", "missing")),
        ({"inertia": ONE_SMALL}, ("inertia", "decimal")),
        ({"inertia": np.diag(np.diag(INERTIA))}, ("inertia", "missing")),
        ({"inertia": INERTIA[np.ix_([1, 0, 2], [1, 0, 2])]}, ("inertia", "axes")),
        ({"inertia": 1e6 * INERTIA}, ("inertia", "units")),
        ({"com": COM * (1, 10, 1)}, ("com", "decimal")),
        ({"inertia": STEP[:3, :3] @ INERTIA @ STEP[:3, :3].T}, ("inertia", "frame")),
    ],
)
def test_one_slip_of_a_body_is_named(change, cause):
    for reference in (PANDA, kl.to_urdf(PANDA)):
        found = kl.diagnose_table(row(PANDA, 4, **change), reference)
        assert [(c.row, c.column, c.kind) for c in found.causes] == [(4, *cause)], found
        q = np.random.default_rng(0).uniform(-2, 2, (5, 7))
        for one, two in zip(dynamics(found.repaired, q), dynamics(PANDA, q), strict=True):
            np.testing.assert_allclose(one, two, atol=1e-9)


def test_the_motors_inertia_in_place_of_the_reflected_one():
    right = row(PANDA, 2, armature=0.5)
    found = kl.diagnose_table(row(PANDA, 2, armature=0.5 / 120**2), right)
    assert [(c.row, c.column, c.kind) for c in found.causes] == [(2, "armature", "gear")]
    assert "G = 120" in found.sentence and found.causes[0].meant == 0.5


def test_gravity():
    for gravity, kind in (((0, 0, 9.81), "sign"), ((0, -9.81, 0), "direction"),
                          ((0, 0, 0), "missing")):  # fmt: skip
        found = kl.diagnose_table(replace(PANDA, gravity=gravity), PANDA)
        assert [(c.row, c.column, c.kind) for c in found.causes] == [(None, "gravity", kind)]
        assert found.repaired == PANDA


def test_a_kinematic_and_a_dynamic_slip_together():
    mine = row(row(PANDA, 3, alpha=-PANDA.links[2].alpha), 5, mass=0.0)
    found = kl.diagnose_table(mine, PANDA)
    assert [(c.row, c.column) for c in found.causes] == [(3, "alpha"), (5, "mass")]


def test_tables_that_are_tried_do_not_warn(recwarn):
    """A length in millimetres, and a body left out: -690 m is tried as an angle, too."""
    right = random_table(145059, 2, "standard")
    mine = row(row(right, 2, a=1000 * right.links[1].a), 1, mass=0.0, com=(0, 0, 0),
               inertia=np.zeros((3, 3)))  # fmt: skip
    told = len(recwarn)
    found = kl.diagnose_table(mine, right)
    assert "row 2: a is in millimetres" in found.sentence
    assert len(recwarn) == told


@settings(max_examples=40, deadline=None)
@given(
    st.integers(0, 2**32 - 1), st.integers(2, 6), st.sampled_from(["standard", "modified"]),
    st.sampled_from(["mass", "com", "armature"]),
)  # fmt: skip
def test_a_body_number_is_found_in_random_arms(seed, n, convention, column):
    right = random_table(seed, n, convention)
    i = seed % n + 1
    value = getattr(right.links[i - 1], column)
    found = kl.diagnose_table(row(right, i, **{column: np.add(value, 0.0371)}), right)
    assert [(c.row, c.column) for c in found.causes] == [(i, column)]
    np.testing.assert_allclose(found.causes[0].meant, value, rtol=1e-9, atol=1e-10)


def test_what_is_not_compared_is_said():
    bare = replace(PANDA, links=[replace(k, mass=0.0, inertia=np.zeros((3, 3)), com=(0, 0, 0))
                                 for k in PANDA.links])  # fmt: skip
    found = kl.diagnose_table(PANDA, bare)
    assert found.agrees and "has no masses" in found.notes[0]
    assert "no masses" in kl.diagnose_table(bare, PANDA).notes[0]
    with pytest.raises(kl.KinlabError, match="has no masses: give a table or a URDF whose links"):
        kl.diagnose_table(PANDA, bare, dynamics=True)
