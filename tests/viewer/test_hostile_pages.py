"""Nothing that a file says becomes part of a page's program; meshes that cannot be read are named."""

from __future__ import annotations

import re

import pytest

import kinlab as kl
from kinlab.formulas.typeset import mathml
from kinlab.viewer.scene import Scene

HOSTILE = [
    r"\text{<script>window.pwned=1</script>}", r"\text{<img src=x onerror=pwned()>}",
    r"\href{javascript:pwned()}{x}", r"\text{<![CDATA[<script>pwned()</script>]]>}",
    r"\text{</math><script>pwned()</script>}", r"\text{<!--<script>}",
]  # fmt: skip


@pytest.mark.parametrize("latex", HOSTILE)
def test_latex_becomes_mathematics_or_text(latex):
    made = mathml(latex)
    assert "<script" not in made
    assert "<img" not in made
    assert "<!--" not in made
    assert 'href="' not in made


def test_sound_latex_stays_mathematics():
    assert mathml(r"\frac{a}{b} < \left(c\right)^2").startswith("<math")


def test_every_page_has_a_policy():
    page = Scene(kl.load("planar2r")).html()
    policy = re.findall(r'<meta http-equiv="Content-Security-Policy" content="([^"]*)">', page)
    assert len(policy) == 1
    assert page.index("Content-Security-Policy") < page.index("<script")
    rules = dict(rule.split(" ", 1) for rule in policy[0].split("; "))
    assert rules["default-src"] == "'none'"
    assert rules["script-src"].count("'sha256-") == 3
    assert "unsafe" not in rules["script-src"]
    assert "'self'" not in rules["connect-src"]


URDF = """<robot name="arm"><link name="base"/>
<link name="a"><inertial><mass value="1"/><inertia ixx="1" iyy="1" izz="1"/></inertial>
<visual>{origin}<geometry>{shape}</geometry>{material}</visual></link>
<joint name="j" type="revolute"><parent link="base"/><child link="a"/><axis xyz="0 0 1"/>
<limit lower="-1" upper="1" effort="1" velocity="1"/></joint></robot>"""


@pytest.mark.parametrize(
    ("name", "content"),
    [
        ("m.stl", b"solid nothing"), ("m.stl", b"\0" * 90), ("m.obj", b"v 1 2\nf 1 2 3\n"),
        ("m.obj", b"\xff\xfe"), ("m.dae", b"<COLLADA>"), ("m.dae", b""), ("m.stl", b""),
    ],
)  # fmt: skip
def test_a_mesh_that_cannot_be_read_is_named(tmp_path, name, content):
    (tmp_path / name).write_bytes(content)
    file = tmp_path / "arm.urdf"
    shape = f'<mesh filename="{name}"/>'
    file.write_text(URDF.format(origin="", shape=shape, material=""), encoding="utf-8")
    notes = Scene(kl.load(file)).notes
    assert len(notes) == 1
    assert notes[0].startswith(f"link 'a': mesh '{name}' cannot be read")
    assert notes[0].endswith("; a rod stands for it")


@pytest.mark.parametrize(
    ("shape", "origin", "why"),
    [
        ("", "", "has 0 shapes"), ("<torus/>", "", "shape <torus> is unknown"),
        ('<box size="1 a 1"/>', "", "are not numbers"), ('<sphere radius="-1"/>', "", "is negative"),
        ('<cylinder radius="1"/>', "", "has no length"),
        ('<sphere radius="1"/>', '<origin xyz="0 0"/>', "2 numbers"),
    ],
)  # fmt: skip
def test_a_shape_that_cannot_be_read_is_named(shape, origin, why):
    notes = Scene(kl.Robot.from_urdf(URDF.format(shape=shape, origin=origin, material=""))).notes
    assert len(notes) == 1
    assert why in notes[0]


def test_a_colour_that_cannot_be_read_is_grey():
    paint = '<material name="m"><color rgba="a"/></material>'
    text = URDF.format(shape='<sphere radius="1"/>', origin="", material=paint)
    assert Scene(kl.Robot.from_urdf(text)).notes == ()
