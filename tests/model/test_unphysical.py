"""Inertias that no body can have: refused with a way out, computed with where meant, or rounded."""

from __future__ import annotations

import contextlib
import dataclasses
import re
import warnings

import numpy as np
import pytest
from newton_euler import mass_matrix, torques
from random_tables import random_rotation

import kinlab as kl
from kinlab.cli import app
from kinlab.errors import KinlabWarning, TableError, UrdfError
from kinlab.model.link import inertia_flaw
from kinlab.model.robot import remarks

CORKE = """
name = "corke"
convention = "standard"
{more}
links = [
  {{ name = "waist", joint = "revolute", a = 0, alpha = "pi/2", d = 0, theta = 0, inertia = {{ ixx = 0, iyy = 0.35, izz = 0 }}, armature = 1.14 }},
  {{ joint = "revolute", a = 0.4318, alpha = 0, d = 0, theta = 0, mass = 17.4, com = [-0.3638, 0.006, 0.2275], inertia = {{ ixx = 0.13, iyy = 0.524, izz = 0.539 }} }},
  {{ joint = "revolute", a = 0.0203, alpha = "-pi/2", d = 0.15, theta = 0, mass = 4.8, com = [-0.0203, -0.0141, 0.07], inertia = {{ ixx = 0.066, iyy = 0.086, izz = 0.0125 }} }},
]
"""
CSV = """joint,a,alpha,d,theta,mass,ixx,iyy,izz,armature{head}
revolute,0,pi/2,0,0,0,0,0.35,0,1.14{cell}
revolute,0.4318,0,0,0,17.4,0.13,0.524,0.539,0{cell}
"""


@pytest.fixture
def corke(tmp_path):
    file = tmp_path / "corke.toml"
    file.write_text(CORKE.format(more="unphysical = true"), encoding="utf-8")
    return file


def test_the_message_names_the_link_the_nearest_tensor_and_the_switch(tmp_path):
    file = tmp_path / "corke.toml"
    file.write_text(CORKE.format(more=""), encoding="utf-8")
    with pytest.raises(TableError) as caught:
        kl.load(file)
    said = str(caught.value)
    assert "table 'corke', link 1 'waist': inertia breaks the triangle" in said
    assert "{ ixx = 0.1167, iyy = 0.2333, izz = 0.1167 }" in said
    assert "unphysical = true" in said
    rows = [
        kl.DHLink(mass=1.0, inertia=np.eye(3)),
        kl.DHLink(inertia=np.diag([0.066, 0.086, 0.0125])),
    ]
    with pytest.raises(
        TableError, match=r"link 2: .* ixx = 0\.0685, iyy = 0\.0835, izz = 0\.015 }"
    ):
        kl.DHTable("arm", "standard", rows)
    assert kl.DHTable("arm", "standard", rows, unphysical=True).unphysical


def test_what_is_meant_is_computed_with_and_marked(corke, tmp_path):
    table = kl.DHTable.load(corke)
    robot = kl.load(corke)
    q, v, a = np.random.default_rng(1).uniform(-2, 2, (3, 5, 3))
    for arm in (robot, kl.Robot.from_urdf(robot.urdf)):
        for row in zip(q, v, a, strict=True):
            assert np.allclose(kl.inverse_dynamics(arm, *row), torques(table, *row), atol=1e-9)
        assert np.allclose(kl.mass_matrix(arm, q[0]), mass_matrix(table, q[0]), atol=1e-10)
    assert 'unphysical="true"' in robot.urdf
    assert kl.to_dh(kl.Robot.from_urdf(robot.urdf)).unphysical
    table.save(tmp_path / "again.toml")
    assert kl.DHTable.load(tmp_path / "again.toml") == table
    assert dataclasses.replace(table, unphysical=False, links=table.links[1:2]) != table
    with pytest.raises(UrdfError, match=r'link \'link_1\': .*<kinlab unphysical="true"/>'):
        kl.Robot.from_urdf(robot.urdf.replace(' unphysical="true"', ""))
    with pytest.raises(UrdfError, match="unphysical is 'yes'; it must be true or false"):
        kl.Robot.from_urdf(robot.urdf.replace('unphysical="true"', 'unphysical="yes"'))


def test_the_switch_in_csv_and_misplaced(tmp_path):
    file = tmp_path / "arm.csv"
    file.write_text(CSV.format(head="", cell=""))
    with pytest.raises(TableError, match="link 1: inertia breaks"):
        kl.DHTable.load(file, "standard")
    file.write_text(CSV.format(head=",unphysical", cell=",true"))
    assert kl.DHTable.load(file, "standard").unphysical
    file.write_text(CSV.format(head=",unphysical", cell=",perhaps"))
    with pytest.raises(TableError, match="unphysical is 'perhaps'; it must be true or false"):
        kl.DHTable.load(file, "standard")
    toml = tmp_path / "arm.toml"
    toml.write_text(CORKE.format(more="").replace("d = 0,", "d = 0, unphysical = true,", 1))
    with pytest.raises(TableError, match="unphysical belongs to the whole table"):
        kl.load(toml)
    toml.write_text(CORKE.format(more="unphysical = 1"))
    with pytest.raises(TableError, match="unphysical is 1; give True or False"):
        kl.load(toml)


@pytest.mark.parametrize("moments", [(0.333, 0.333, 0.667), (0.0012, 0.0013, 0.00254), (2, 2, 4.1)])
def test_the_rounding_of_a_lamina_is_a_warning(moments):
    link = kl.DHLink(mass=1.0, inertia=np.diag(moments))
    with pytest.warns(KinlabWarning, match="link 1: inertia breaks .* the rounding of its printed"):
        table = kl.DHTable("plate", "modified", [link])
    with warnings.catch_warnings():
        warnings.simplefilter("error")  # said once, at the door
        robot = kl.Robot.from_dh(table)
        kl.to_dh(robot)
        kl.with_payload(robot, 1e-3)
    assert np.array_equal(table.links[0].inertia, np.diag(moments))
    with pytest.warns(KinlabWarning, match="link 'link_1'"):
        kl.Robot.from_urdf(robot.urdf)


@pytest.mark.parametrize(
    "moments",
    [
        (0.066, 0.086, 0.0125),
        (0, 0.35, 0),
        (0.3333333, 0.3333333, 0.669),
        (1, 1, 3),
        (0.1, 0.1, -0.1),
    ],
)
def test_more_than_rounding_is_refused(moments):
    with pytest.raises(TableError, match="link 1: inertia"):
        kl.DHTable("plate", "modified", [kl.DHLink(mass=1.0, inertia=np.diag(moments))])


def test_nearest_tensor_beside_a_search():
    """No tensor of a body among many random ones near it is nearer; it is a body's itself."""
    rng = np.random.default_rng(5)
    for _ in range(10):
        turn = random_rotation(rng)
        tensor = turn @ np.diag(rng.uniform(-0.5, 1.0, 3)) @ turn.T
        tensor = 0.5 * (tensor + tensor.T)
        flaw = inertia_flaw(tensor)
        if flaw is None:
            assert np.min(np.linalg.eigvalsh(0.5 * np.trace(tensor) * np.eye(3) - tensor)) > -1e-6
            continue
        assert inertia_flaw(flaw.nearest) is None
        gap = np.linalg.norm(flaw.nearest - tensor)
        for size in (1e-3, 1e-2, 1e-1):
            for _ in range(60):
                step = rng.normal(size=(3, 3)) * size
                other = flaw.nearest + step + step.T
                spread = 0.5 * np.trace(other) * np.eye(3) - other
                values, axes = np.linalg.eigh(spread)
                sound = axes @ np.diag(np.maximum(values, 0.0)) @ axes.T
                body = np.trace(sound) * np.eye(3) - sound
                assert np.linalg.norm(body - tensor) >= gap - 1e-9


def test_remarks_state_what_is_in_no_answer():
    def said(robot):
        return "\n".join(remarks(robot))

    plain = kl.DHLink(a=0.3, mass=1.0, inertia=0.1 * np.eye(3))
    rough = dataclasses.replace(plain, viscous_friction=0.1, name="elbow")
    point = kl.DHLink(a=0.2, mass=2.0, armature=0.1)
    bad = dataclasses.replace(plain, inertia=np.diag([0, 0.35, 0]))
    table = kl.DHTable("arm", "modified", [rough, plain, point, bad], unphysical=True)
    robot = kl.Robot.from_dh(table)
    assert remarks(kl.Robot.from_dh(kl.DHTable("arm", "modified", [plain]))) == ()
    for arm, two, three in (
        (robot, "link 3", "link 4"),
        (kl.Robot.from_urdf(robot.urdf), "link_3", "link_4"),
        (kl.Robot.from_model(robot.model), "joint joint_3", "joint joint_4"),
    ):
        friction, points, body = said(arm).splitlines()
        assert friction.startswith("joint friction of elbow: counted in simulations")
        assert re.match(f"mass without inertia: .*{two}: computed as point masses", points)
        assert re.match(f"unphysical: .*{three}: inertia breaks", body)


def test_info_and_check_say_so(corke, capsys):
    text = corke.read_text().replace("armature = 1.14", "coulomb_friction = 0.2, armature = 1.14")
    corke.write_text(text)
    for command in ("info", "check"):
        with contextlib.suppress(SystemExit):
            app([command, str(corke)], standalone_mode=False)
        out = capsys.readouterr().out
        assert "joint friction of waist: counted in simulations" in out
        assert "unphysical: link 1: inertia breaks the triangle inequality" in out
