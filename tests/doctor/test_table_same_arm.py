"""Tables of one arm agree however their frames are placed; other zeros and bases are told."""

from __future__ import annotations

import math
from dataclasses import replace

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from random_tables import random_pose, random_table, tables

import kinlab as kl
from kinlab.model.library import shipped


@settings(max_examples=40, deadline=None)
@given(tables)
def test_a_table_agrees_with_itself_its_urdf_and_the_table_read_off_it(table):
    robot = kl.Robot.from_dh(table)
    for other in (table, robot, kl.to_urdf(table), kl.to_dh(robot)):
        found = kl.diagnose_table(table, other)
        assert found.agrees and found.same_arm and not found.causes, found
        assert found.error_before < 1e-9


@pytest.mark.parametrize("name", sorted(shipped()))
def test_shipped_tables_agree_with_their_urdf_in_the_other_convention(name):
    table = kl.load(name).table
    other = kl.to_dh(kl.load(name))
    assert kl.diagnose_table(table, other).agrees


@settings(max_examples=40, deadline=None)
@given(st.integers(0, 2**32 - 1), st.integers(2, 7))
def test_x_turned_over_and_whole_turns_agree(seed, n):
    table = random_table(seed, n, "standard")
    i = seed % (n - 1)
    links = list(table.links)
    one, two = links[i], links[i + 1]
    flat = np.diag([-1.0, -1.0, 1.0])  # frame i turned by pi about z
    links[i] = replace(
        one, theta=one.theta + math.pi, a=-one.a, alpha=-one.alpha + 2 * math.pi,
        com=flat @ one.com, inertia=flat @ one.inertia @ flat,
    )  # fmt: skip
    links[i + 1] = replace(two, theta=two.theta - math.pi)
    found = kl.diagnose_table(replace(table, links=links), table)
    assert found.agrees, found
    assert found.differences and "place the frames elsewhere" in found.differences[0]


def test_parallel_axes_may_have_any_d():
    table = kl.load("planar3r").table
    links = list(table.links)
    links[0] = replace(links[0], d=0.2, com=np.asarray(links[0].com) - (0, 0, 0.2))
    links[1] = replace(links[1], d=-0.2)
    assert kl.diagnose_table(replace(table, links=links), table).agrees


@settings(max_examples=10, deadline=None)
@given(st.integers(0, 2**32 - 1))
def test_other_zeros_base_and_tool_are_told_as_the_same_arm(seed):
    """Three changes and more: no list of slips holds them, the joint axes do."""
    rng = np.random.default_rng(seed)
    table = kl.load("puma560").table
    zeros = rng.uniform(-1.0, 1.0, table.n)
    links = [replace(k, theta=k.theta + z) for k, z in zip(table.links, zeros, strict=True)]
    mine = replace(table, links=links, base=random_pose(rng), tool=random_pose(rng))
    found = kl.diagnose_table(mine, table, dynamics=False)
    assert found.same_arm and not found.agrees and found.causes
    told = " ".join(found.differences)
    for i in range(2, table.n):
        gap = -math.degrees(zeros[i - 1])
        assert f"zero of joint {i} differs by {gap:.6g}"[:30] in told
    assert "base" in told
    q = rng.uniform(-2, 2, (10, table.n))
    np.testing.assert_allclose(found.repaired.fk(q)[:, -1], table.fk(q)[:, -1], atol=1e-8)


def test_a_nominal_urdf_with_fixed_frames_between():
    urdf = """<robot name="two"><link name="world"/><link name="foot"/><link name="arm"/>
    <link name="cover"/><link name="fore"/><link name="tip"/>
    <joint name="f" type="fixed"><parent link="world"/><child link="foot"/>
      <origin xyz="0 0 0.2" rpy="0 0 1.5707963267948966"/></joint>
    <joint name="one" type="revolute"><parent link="foot"/><child link="arm"/>
      <origin xyz="0 0 0.1"/><axis xyz="0 0 1"/>
      <limit lower="-1" upper="1" velocity="1" effort="1"/></joint>
    <joint name="g" type="fixed"><parent link="arm"/><child link="cover"/>
      <origin xyz="0.3 0 0" rpy="0.5 0 0"/></joint>
    <joint name="two" type="revolute"><parent link="cover"/><child link="fore"/>
      <origin rpy="-0.5 0 0"/><axis xyz="0 1 0"/>
      <limit lower="-1" upper="1" velocity="1" effort="1"/></joint>
    <joint name="t" type="fixed"><parent link="fore"/><child link="tip"/>
      <origin xyz="0.25 0 0"/></joint></robot>"""
    base = np.eye(4)
    base[:3, :3] = [[0, -1, 0], [1, 0, 0], [0, 0, 1]]
    base[2, 3] = 0.2
    links = [kl.DHLink(a=0.3, alpha=-math.pi / 2, d=0.1), kl.DHLink(a=0.25)]
    tool = np.array([[1, 0, 0, 0], [0, 0, -1, 0], [0, 1, 0, 0], [0, 0, 0, 1.0]])
    mine = kl.DHTable("two", "standard", links, base=base, tool=tool)
    assert kl.diagnose_table(mine, urdf).agrees
    wrong = replace(mine, links=[replace(links[0], alpha=math.pi / 2), links[1]])
    found = kl.diagnose_table(wrong, urdf)
    assert [(c.row, c.column, c.kind) for c in found.causes] == [(1, "alpha", "sign")]
    rounded = urdf.replace("1.5707963267948966", "1.5708")
    found = kl.diagnose_table(wrong, rounded)
    assert [(c.row, c.column) for c in found.causes] == [(1, "alpha")]
    assert kl.diagnose_table(mine, rounded).agrees
