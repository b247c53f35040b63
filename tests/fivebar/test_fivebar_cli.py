"""The commands about five-bars, as a user types them, and the pictures they write."""

from __future__ import annotations

from pathlib import Path

import console
import mujoco
import pytest


def kinlab(*arguments):
    """Exit code, stdout, stderr."""
    said = console.kinlab(*arguments, columns=120)
    return said.returncode, said.stdout, said.stderr


def test_list_names_linkages_and_motors():
    code, out, _ = kinlab("fivebar", "list")
    assert code == 0
    for name in ("isotropic", "plotclock", "SGMAH-08A", "Mitsubishi Electric"):
        assert name in out


def test_analyse(tmp_path):
    picture = tmp_path / "workspace.png"
    code, out, _ = kinlab(
        "fivebar", "analyse", "isotropic", "--at", "0", "-0.5", "--picture", picture
    )
    assert code == 0
    for text in ("reachable area 1.33194 m²", "(0.000000, -0.565685) m, fully",
                 "largest circle: radius 0.3 m", "transmission angle 99.89°",
                 "condition number 1.18951"):  # fmt: skip
        assert text in out, text
    assert picture.read_bytes().startswith(b"\x89PNG") and picture.stat().st_size > 20_000


def test_size(tmp_path):
    code, out, _ = kinlab(
        "fivebar", "size", "unequal", "--workspace", "-0.2", "0.2", "-0.65", "-0.5",
        "--v-max", "3", "--a-max", "60", "--picture", tmp_path / "cycle.svg",
    )  # fmt: skip
    assert code == 0
    for text in ("torque, full", "SGMAH-02A", "limited by", "sqrt(eta) = 8.276 and 7.906"):
        assert text in out, text
    assert (tmp_path / "cycle.svg").stat().st_size > 10_000
    assert (tmp_path / "cycle-gain.svg").stat().st_size > 10_000


def test_size_takes_a_workspace_of_its_own():
    code, out, _ = kinlab(
        "fivebar", "size", "isotropic", "--v-max", "3", "--a-max", "60", "--motor", "HG-KN43J",
    )  # fmt: skip
    assert code == 0 and "condition number up to 3" in out and out.count("HG-KN") == 1


def test_export(tmp_path):
    code, out, _ = kinlab("fivebar", "export", "isotropic", "-o", tmp_path / "five.xml")
    assert (code, out) == (0, f"wrote {tmp_path / 'five.xml'}\n")
    assert mujoco.MjModel.from_xml_path(str(tmp_path / "five.xml")).nv == 4
    code, out, _ = kinlab("fivebar", "export", "isotropic", "-o", tmp_path / "five.urdf")
    assert code == 0 and "five.loop.toml" in out


@pytest.mark.parametrize(
    ("arguments", "message"),
    [
        (("analyse", "isotropc"), "no five-bar 'isotropc'; did you mean 'isotropic'"),
        (("analyse", "none.toml"), "none.toml: no such file"),
        (("analyse", "isotropic", "--mode", "ab"), "mode 'ab' does not exist"),
        (("analyse", "isotropic", "--at", "0", "-2"), "1.2 m too far for leg 1"),
        (("analyse", "isotropic", "--assembly", "3"), "assembly 3 does not exist"),
        (("analyse", "isotropic", "--picture", "x.gif"), "x.gif: a figure is a .png"),
        (("size", "plotclock", "--v-max", "1", "--a-max", "1"), "nothing to move"),
        (("size", "isotropic", "--v-max", "-1", "--a-max", "1"), "v_max is -1.0"),
        (("size", "isotropic", "--v-max", "1", "--a-max", "1", "--motor", "X"), "no motor 'X'"),
        (("export", "isotropic", "-o", "five.stl"), "five.stl: name a .xml"),
        (("export", "minitaur_leg", "-o", "leg.xml"), "crank 1 has mass 0"),
    ],
)
def test_an_error_is_one_line_and_exit_code_2(arguments, message):
    code, _, err = kinlab("fivebar", *arguments)
    assert code == 2 and message in err
    assert len(err.strip().splitlines()) == 1


def test_the_scripts_run(tmp_path):
    scripts = Path(__file__).resolve().parents[2] / "scripts"
    for script, arguments, text in [
        ("tour/five_bar_tour.py", ["--output", tmp_path], "wrote"),
        ("compare/compare_five_bar.py", ["--states", "40", "--points", "20000"], "agrees"),
    ]:
        done = console.script(scripts / script, *arguments)
        assert done.returncode == 0, done.stderr
        assert text in done.stdout
