"""Bad URDFs: what Pinocchio takes silently is refused by name."""

from __future__ import annotations

import re
import time

import numpy as np
import pytest

import kinlab as kl
from kinlab.errors import InertiaError, NameUnknownError, StructureError, UrdfError
from kinlab.model import urdf_read
from kinlab.model.urdf_records import WIDE_TURN

LIMIT = '<limit lower="-1" upper="1" velocity="1" effort="1"/>'


def link(name, *, mass="1", tensor='ixx="1" iyy="1" izz="1" ixy="0" ixz="0" iyz="0"', extra=""):
    return (
        f'<link name="{name}"><inertial><mass value="{mass}"/><inertia {tensor}/></inertial>'
        f"{extra}</link>"
    )


def joint(name, parent, child, *, kind="revolute", axis="0 0 1", inner=LIMIT, xyz="0.5 0 0"):
    return (
        f'<joint name="{name}" type="{kind}"><parent link="{parent}"/><child link="{child}"/>'
        f'<origin xyz="{xyz}" rpy="0 0 0"/><axis xyz="{axis}"/>{inner}</joint>'
    )


def robot(*parts):
    return '<robot name="arm"><link name="base"/>' + "".join(parts) + "</robot>"


GOOD = (link("a"), link("b"), joint("j1", "base", "a"), joint("j2", "a", "b"))


def test_the_good_one_loads():
    arm = kl.Robot.from_urdf(robot(*GOOD))
    assert (arm.n, arm.tool_name, arm.joint_names) == (2, "b", ("j1", "j2"))


@pytest.mark.parametrize(
    ("parts", "message"),
    [
        ((link("a"), joint("j1", "base", "a", axis="0 0 0")), "joint 'j1': axis is 0 0 0"),
        ((link("a"), joint("j1", "base", "a", axis="0 nan 0")), "joint 'j1': axis: '0 nan 0'"),
        ((link("a"), joint("j1", "base", "a", xyz="0 inf 0")), "joint 'j1': origin xyz"),
        ((link("a"), joint("j1", "base", "a", xyz="0 0")), "2 numbers; expected 3"),
        ((link("a"), joint("j1", "base", "a", xyz="x 0 0")), "'x 0 0' are not numbers"),
        ((*GOOD, joint("j3", "base", "b")), "link 'b' has two parents (second joint 'j3')"),
        ((link("a"), link("b"), joint("j1", "a", "b"), joint("j2", "b", "a")),
         "the links form a loop: a -> b -> a"),
        ((link("a"), joint("j1", "a", "a")), "the links form a loop: a -> a"),
        ((link("a"), link("b"), joint("j1", "base", "a")), "it has 2 roots: base, b"),
        ((link("a"), joint("j1", "base", "c")), "child link 'c' does not exist"),
        ((link("a"), joint("j1", "bse", "a")), "parent link 'bse' does not exist; did you mean 'base'"),
        ((link("a"), joint("j1", "base", "a", inner="")), "joint 'j1': <limit> is missing"),
        ((link("a"), joint("j1", "base", "a", inner='<limit lower="2" upper="1"/>')),
         "joint 'j1': lower 2 is above upper 1"),
        ((link("a"), joint("j1", "base", "a", inner='<limit upper="1" effort="-1"/>')),
         "limit effort is negative"),
        ((link("a"), joint("j1", "base", "a", kind="hinge")), "joint 'j1': type 'hinge' is unknown"),
        ((link("a", mass="-1"), joint("j1", "base", "a")), "link 'a': mass is -1; it must be >= 0"),
        ((link("a", mass="nan"), joint("j1", "base", "a")), "link 'a': mass: 'nan'"),
        ((link("a", tensor='ixx="1" iyy="1" izz="3"'), joint("j1", "base", "a")),
         "link 'a': inertia breaks the triangle inequality"),
        ((link("a", tensor='ixx="1" iyy="1" izz="-1"'), joint("j1", "base", "a")),
         "link 'a': inertia is not positive"),
        ((link("a", tensor='ixx="inf"'), joint("j1", "base", "a")), "link 'a': ixx"),
        ((link("a"), link("a"), joint("j1", "base", "a")), "link 'a' is defined twice"),
        ((*GOOD[:3], joint("j1", "a", "b")), "joint 'j1' is defined twice"),
        (('<link name="a"><inertial><inertia ixx="1"/></inertial></link>',), "<inertial> has no <mass>"),
    ],
)  # fmt: skip
def test_bad_urdf(parts, message):
    with pytest.raises(UrdfError, match=re.escape(message)):
        kl.Robot.from_urdf(robot(*parts))


@pytest.mark.parametrize(
    ("parts", "message"),
    [
        ((link("a"), joint("j1", "base", "a", kind="fixed")), "no moving joint"),
        ((link("a"), joint("j1", "base", "a", kind="planar")), "joint 'j1' is planar"),
        ((link("a"), joint("j1", "base", "a", kind="floating")), "joint 'j1' is floating"),
        ((*GOOD[:3], joint("j2", "a", "b", inner=LIMIT + '<mimic joint="j1"/>')), "joint 'j2' mimics"),
        ((link("a"), link("b"), joint("j1", "base", "a"), joint("j2", "base", "b")),
         "a tree: after link 'base' branch the joints 'j1', 'j2'; name the tool, one of 'a', 'b'"),
    ],
)  # fmt: skip
def test_not_a_serial_arm(parts, message):
    with pytest.raises(StructureError, match=re.escape(message)):
        kl.Robot.from_urdf(robot(*parts))


def test_a_tree_with_its_tool_named_is_a_chain():
    tree = robot(link("a"), link("b"), joint("j1", "base", "a"), joint("j2", "base", "b"))
    arm = kl.Robot.from_urdf(tree, tool="b")
    assert arm.joint_names == ("j2",)
    with pytest.raises(NameUnknownError, match="link 'bb' does not exist; did you mean 'b'"):
        kl.Robot.from_urdf(tree, tool="bb")


def test_not_xml():
    for text in ("<robot", "<model/>", "<robot name='x'/>"):
        with pytest.raises(UrdfError, match="not XML|starts with <robot>|no links"):
            kl.Robot.from_urdf(text)


def test_entities_are_neither_fetched_nor_expanded(tmp_path):
    secret = tmp_path / "secret.txt"
    secret.write_text("hidden", encoding="utf-8")
    external = f'<!DOCTYPE r [<!ENTITY x SYSTEM "file://{secret}">]><robot name="&x;"/>'
    rows = "".join(f'<!ENTITY e{i + 1} "{f"&e{i};" * 10}">' for i in range(12))
    bomb = f'<!DOCTYPE r [<!ENTITY e0 "ha">{rows}]><robot name="&e12;"/>'
    for text in (external, bomb):
        start = time.monotonic()
        with pytest.raises(UrdfError, match="document type and entity declarations") as caught:
            kl.Robot.from_urdf(text)
        assert "hidden" not in str(caught.value)
        assert time.monotonic() - start < 5.0  # expanded, it would be 2e12 characters


def test_utf16_does_not_smuggle_entities(tmp_path):
    file = tmp_path / "arm.urdf"
    file.write_bytes('<!DOCTYPE r [<!ENTITY x "y">]><robot name="&x;"/>'.encode("utf-16"))
    with pytest.raises(kl.KinlabError, match="not UTF-8"):
        kl.Robot.from_urdf(file)


def test_continuous_joint_becomes_revolute_with_wide_limits():
    arm = kl.Robot.from_urdf(
        robot(link("a"), joint("j1", "base", "a", kind="continuous", inner=""))
    )
    assert arm.model.nq == arm.model.nv == 1
    assert (arm.lower[0], arm.upper[0]) == (-WIDE_TURN, WIDE_TURN)


def test_missing_mesh_is_named_and_harmless(tmp_path):
    mesh = '<visual><geometry><mesh filename="package://x/hand.stl"/></geometry></visual>'
    file = tmp_path / "arm.urdf"
    file.write_text(robot(link("a", extra=mesh), joint("j1", "base", "a")), encoding="utf-8")
    arm = kl.load(file)
    lines = list(urdf_read.missing_meshes(urdf_read.parse(arm.urdf, "arm"), [tmp_path]))
    assert lines == ["link 'a': mesh 'package://x/hand.stl' is missing"]
    (tmp_path / "x").mkdir()
    (tmp_path / "x" / "hand.stl").write_text("solid", encoding="utf-8")
    assert not list(urdf_read.missing_meshes(urdf_read.parse(arm.urdf, "arm"), [tmp_path]))


def massless(last_mass):
    light = {"mass": "0", "tensor": 'ixx="0"'}
    parts = (link("a"), link("b", **(light if last_mass == 0 else {})), *GOOD[2:])
    return kl.Robot.from_urdf(robot(*parts))


@pytest.mark.parametrize("function", ["mass_matrix", "gravity_torques", "potential_energy"])
def test_moving_massless_link_names_its_joint(function):
    arm = massless(0)
    with pytest.raises(
        InertiaError, match="the mass matrix is singular: joint 'j2' moves no inertia"
    ):
        getattr(kl, function)(arm, np.zeros(2))
    with pytest.raises(InertiaError, match="joint 'j2'"):
        kl.forward_dynamics(arm, np.zeros(2), np.zeros(2), np.zeros(2))
    assert kl.fk(arm, np.zeros(2))[0, 3] == 1.0  # kinematics work without


def test_a_table_without_masses_is_for_kinematics():
    arm = kl.Robot.from_dh(kl.DHTable("bare", "standard", [kl.DHLink(a=1.0), kl.DHLink(a=1.0)]))
    assert kl.fk(arm, [0, 0])[0, 3] == 2.0
    with pytest.raises(InertiaError, match="robot 'bare': no link has mass: kinematics only"):
        kl.mass_matrix(arm, [0, 0])


def test_an_armature_is_inertia_enough():
    links = [kl.DHLink(a=1.0, mass=1.0), kl.DHLink(a=1.0, armature=0.1)]
    arm = kl.Robot.from_dh(kl.DHTable("geared", "standard", links))
    assert kl.mass_matrix(arm, [0, 0])[1, 1] == pytest.approx(0.1)


@pytest.mark.parametrize("name", ["pume560", "urr5", "zzzzzzzz", "", "robots/none.toml", "x.urdf"])
def test_unknown_robot(name):
    with pytest.raises(kl.KinlabError) as caught:
        kl.load(name)
    assert "\n" not in str(caught.value)
    if name == "pume560":
        assert "did you mean 'puma560'" in str(caught.value)


def test_a_floating_base_model_is_refused():
    import pinocchio as pin

    model = pin.buildModelFromXML(robot(*GOOD), pin.JointModelFreeFlyer())
    with pytest.raises(StructureError, match="one degree of freedom"):
        kl.to_dh(model)


def test_a_branching_model_is_refused():
    import pinocchio as pin

    tree = robot(link("a"), link("b"), joint("j1", "base", "a"), joint("j2", "base", "b"))
    with pytest.raises(StructureError, match="joint 'j2' branches off"):
        kl.to_dh(pin.buildModelFromXML(tree))
