"""URDFs that programs read differently: refused by name, or read as they are written."""

from __future__ import annotations

import re

import numpy as np
import pytest

import kinlab as kl
from kinlab.errors import StructureError, UrdfError
from kinlab.model import urdf_engine

ARM = """<robot name="arm">
<link name="base"/>
<link name="upper"><inertial><origin xyz="0.2 0.1 0"/><mass value="2"/>
  <inertia ixx="0.1" ixy="0.01" ixz="0" iyy="0.2" iyz="0" izz="0.15"/></inertial></link>
<link name="hand"/>
<joint name="shoulder" type="revolute"><parent link="base"/><child link="upper"/>
  <origin xyz="0.1 0 0.3" rpy="0.1 0.2 0.3"/><axis xyz="0 0 1"/>
  <limit lower="-1" upper="2" effort="5" velocity="3"/><dynamics damping="0.7" friction="0.2"/></joint>
<joint name="wrist" type="fixed"><parent link="upper"/><child link="hand"/><origin xyz="0.4 0 0"/></joint>
</robot>"""


def changed(old: str, new: str) -> str:
    assert ARM.count(old) == 1
    return ARM.replace(old, new)


def m(text: str) -> float:
    """The only entry of the mass matrix of a one-joint arm."""
    return float(kl.mass_matrix(kl.Robot.from_urdf(text), [0.3])[0, 0])


PLAIN = 0.15 + 2 * (0.2**2 + 0.1**2)
"""Moment of the upper link about its joint's axis, by Steiner."""


@pytest.mark.parametrize(
    ("old", "new"),
    [
        ('ixz="0" ', ""), ('iyz="0" ', ""), ('value="2"', 'value=" 2 "'),
        ('value="2"', 'value="\t+2.0e0\n"'), ('xyz="0.2 0.1 0"', 'xyz=" 0.2\n0.1\t+0 "'),
        ('xyz="0.2 0.1 0"', 'xyz="0.2 0.1 1e-400"'), ('xyz="0 0 1"', 'xyz="0 0 1e200"'),
        ('xyz="0 0 1"', 'xyz="0 0 1e-200"'), ('xyz="0 0 1"', 'xyz="0 0 5e-324"'),
        ('name="shoulder"', 'name="upper"'), ('name="wrist"', 'name="hand"'),
        ('name="wrist"', 'name="{x}[/bold]"'),
    ],
)  # fmt: skip
def test_other_spellings_mean_the_same(old, new):
    assert m(changed(old, new)) == pytest.approx(PLAIN, rel=1e-12)


@pytest.mark.parametrize(
    ("old", "new", "message"),
    [
        ('value="2"', 'value="5_0"', "link 'upper': mass: '5_0' is not a number"),
        ('value="2"', 'value="٥"', "link 'upper': mass: '٥' is not a number"),
        ('value="2"', 'value="\u00a02"', "link 'upper': mass"),
        ('value="2"', 'value="0x2"', "link 'upper': mass: '0x2' is not a number"),
        ('value="2"', 'value="2,0"', "link 'upper': mass: '2,0' is not a number"),
        ('value="2"', 'vaule="2"', "<mass> has an unknown attribute 'vaule'; did you mean 'value'?"),
        ('<axis xyz="0 0 1"/>', "<axis/>", "joint 'shoulder': <axis> has no xyz"),
        ('<axis xyz="0 0 1"/>', '<axis xzy="0 0 1"/>', "<axis> has an unknown attribute 'xzy'"),
        ('<axis xyz="0 0 1"/>', '<axis xyz="0 0 1"/><axis xyz="1 0 0"/>', "<axis> is given 2 times"),
        ("<inertial>", "<inertail>", "not XML"),
        ('effort="5" ', "", "joint 'shoulder': <limit> has no effort"),
        ('damping="0.7"', 'damping="-0.7"', "damping is negative"),
        ('xyz="0.4 0 0"', 'xyz="4e9 0 0"', "is beyond 1e+09"),
        ('<link name="hand"/>', '<link name="hand"/><xacro:x xmlns:xacro="http://ros.org/xacro"/>',
         "run xacro on it first"),
        ('<link name="hand"/>', '<link name="ha&#10;nd"/>', "control characters"),
    ],
)  # fmt: skip
def test_what_is_ambiguous_is_refused(old, new, message):
    with pytest.raises(UrdfError, match=re.escape(message)):
        kl.Robot.from_urdf(changed(old, new))


def test_a_misspelt_element_is_refused():
    text = ARM.replace("inertial>", "inertal>")
    with pytest.raises(UrdfError, match=r"unknown element <inertal>; did you mean <inertial>\?"):
        kl.Robot.from_urdf(text)


def test_losses_in_the_joints_are_kept():
    model = kl.Robot.from_urdf(ARM).model
    assert (model.damping[0], model.friction[0]) == (0.7, 0.2)


def test_the_file_s_own_words_about_its_letters_do_not_count():
    text = '<?xml version="1.0" encoding="latin-1"?>' + changed(
        'name="hand"', 'name="händ"'
    ).replace('link="hand"', 'link="händ"')
    assert kl.Robot.from_urdf(text).tool_name == "händ"


@pytest.mark.parametrize("spoiled", ["mass", "lever", "placement", "frame", "limit", "axis"])
def test_a_model_that_is_not_the_file_is_refused(monkeypatch, spoiled):
    import pinocchio as pin

    read = pin.buildModelFromXML

    def other(text: str):
        model = read(
            text.replace('xyz="0.0 0.0 1.0"', 'xyz="0.0 1.0 0.0"') if spoiled == "axis" else text
        )
        if spoiled == "mass":
            model.inertias[1].mass *= 1.000001
        elif spoiled == "lever":
            model.inertias[1].lever += np.array([1e-6, 0, 0])
        elif spoiled == "placement":
            model.jointPlacements[1].translation += np.array([0, 1e-6, 0])
        elif spoiled == "frame":
            model.frames[model.nframes - 1].placement.translation += np.array([0, 0, 1e-6])
        elif spoiled == "limit":
            model.upperPositionLimit = np.array([2.5])
        return model

    monkeypatch.setattr(urdf_engine.pin, "buildModelFromXML", other)
    with pytest.raises(UrdfError, match="Pinocchio"):
        kl.Robot.from_urdf(ARM)


def long_arm(joints: int, kind: str) -> str:
    parts = ['<robot name="long"><link name="l0"/>']
    for i in range(joints):
        moves = "revolute" if kind == "revolute" or i == 0 else "fixed"
        parts.append(
            f'<link name="l{i + 1}"/><joint name="j{i}" type="{moves}"><parent link="l{i}"/>'
            f'<child link="l{i + 1}"/><limit lower="-1" upper="1" effort="1" velocity="1"/></joint>'
        )
    return "".join([*parts, "</robot>"])


def test_limits_are_stated():
    assert kl.Robot.from_urdf(long_arm(60, "revolute")).n == 60
    assert kl.Robot.from_urdf(long_arm(990, "fixed")).n == 1
    with pytest.raises(StructureError, match="101 moving joints .* at most 100"):
        kl.Robot.from_urdf(long_arm(101, "revolute"))
    with pytest.raises(UrdfError, match="1100 joints; at most 1000"):
        kl.Robot.from_urdf(long_arm(1100, "fixed"))
    with pytest.raises(kl.KinlabError, match="101 links; at most 100"):
        kl.DHTable("long", "standard", [kl.DHLink(a=0.1, mass=1.0)] * 101)
