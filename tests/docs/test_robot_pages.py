"""The pages of the shipped robots: what is drawn lies on the table's frames, what is written is its."""

from __future__ import annotations

import re
import sys
import xml.etree.ElementTree as ET
from pathlib import Path

import numpy as np
import pytest

import kinlab as kl
from kinlab.model.library import presets, shipped

EXTENSIONS = Path(__file__).resolve().parents[2] / "docs" / "_ext"
sys.path.insert(0, str(EXTENSIONS))
try:
    import drawings_dh
    import robot_pages
    import robot_postures
finally:
    sys.path.remove(str(EXTENSIONS))


@pytest.mark.parametrize("name", shipped())
def test_steps_of_a_drawing_follow_the_axes_as_the_row_says(name):
    table = kl.load(name).table
    q = robot_postures.posture(table)
    frames = [np.asarray(table.base), *table.frames(q)]
    steps = drawings_dh.dh_steps(table, frames)
    for i, link in enumerate(table.links):
        for start, end, colour in steps[2 * i : 2 * i + 2]:
            move = end - start
            if colour == drawings_dh.RED:
                x = (
                    frames[i][:3, 0]
                    if str(table.convention) == "modified"
                    else frames[i + 1][:3, 0]
                )
                assert move == pytest.approx(link.a * x, abs=1e-12)
            else:
                d = link.d + (q[i] if link.joint == "prismatic" else 0.0)
                z = (
                    frames[i + 1][:3, 2]
                    if str(table.convention) == "modified"
                    else frames[i][:3, 2]
                )
                assert move == pytest.approx(d * z, abs=1e-12)
    assert np.all(np.array([x.lower for x in table.links]) <= q)
    assert np.all(np.array([x.upper for x in table.links]) >= q)


@pytest.mark.parametrize("name", shipped())
def test_a_drawing_names_every_frame_once(name):
    table = kl.load(name).table
    svg = drawings_dh.arm(table, robot_postures.posture(table))
    ET.fromstring(svg)
    for letter in "xz":
        found = re.findall(rf'italic">{letter}</tspan><tspan[^>]*>(\d+)<', svg)
        assert sorted(map(int, found)) == list(range(table.n + 1))


def test_a_five_bar_is_drawn_with_its_letters():
    bar = kl.FiveBar.load("unequal")
    svg = drawings_dh.five_bar(bar, robot_postures.hanging(bar))
    ET.fromstring(svg)
    letters = re.findall(r'italic">(\w)</tspan><tspan[^>]*>(\d)<', svg)
    assert sorted(letters) == sorted((x, k) for x in ("A", "B", "l", "l", "θ") for k in "12")


@pytest.mark.parametrize(
    ("value", "text"),
    [(np.pi / 2, "π/2"), (-np.pi, "−π"), (0.1, "5.72958°"), (0.0, "0°"), (np.pi / 12, "15°"), (2 * np.pi / 3, "2π/3")],
)  # fmt: skip
def test_angles_are_written_as_parts_of_pi_where_they_are(value, text):
    assert robot_pages.angle(value) == text


def test_every_robot_has_a_card_and_a_page_is_whole(tmp_path):
    cards = robot_pages.cards(["scara", "planar2r"], ["isotropic"])
    assert cards.count("grid-item-card") == 3 and "RRPR" in cards
    for name in ("scara", "planar2r", "isotropic"):
        assert f"generated/{name}\n" in cards
    assert not set(shipped()) & set(presets())  # one folder holds both
    page = robot_pages.arm_page("planar2r", shipped()["planar2r"].path, tmp_path)
    assert (tmp_path / "planar2r.png").stat().st_size > 10_000
    for words in ("## DH table", "iframe srcdoc=", "| elbow | `joint_2` | π |", r"\det J = l_{1}"):
        assert words in page
    assert str(kl.find_singularities("planar2r").evidence) in page
    assert (
        "found, not proved" in page
        and kl.load("planar2r").table.source[:20].lower() in page.lower()
    )
