"""The commands about robots, as a user types them."""

from __future__ import annotations

import os
import subprocess
import sys

import pytest
from console import kinlab

import kinlab as kl


def test_list_by_a_process_of_its_own():
    result = subprocess.run(
        [sys.executable, "-m", "kinlab", "list"],
        capture_output=True, text=True, env={**os.environ, "COLUMNS": "160"}, check=False,
    )  # fmt: skip
    assert result.returncode == 0
    for name in ("puma560", "stanford", "erd:ur5", "kinova"):
        assert name in result.stdout


def test_info(tmp_path):
    result = kinlab("info", "stanford", cwd=tmp_path)
    assert result.returncode == 0
    for text in ("6 joints", "prismatic", "170°", "standard convention", "q3", "frames: base_link"):
        assert text in result.stdout


def test_info_of_a_urdf_shows_the_extracted_rows():
    result = kinlab("info", "kinova")
    assert result.returncode == 0
    assert "modified convention, extracted" in result.stdout
    assert "missing" not in result.stdout


def test_urdf_to_a_file_from_another_folder(tmp_path):
    result = kinlab("urdf", "puma560", "-o", "puma.urdf", cwd=tmp_path)
    assert (result.returncode, result.stdout) == (0, "wrote puma.urdf\n")
    assert (tmp_path / "puma.urdf").read_text(encoding="utf-8") == kl.load("puma560").urdf


def test_dh_of_ur5(tmp_path):
    result = kinlab("dh", "ur5", "--tip", "tool0", "-o", "ur5.toml", cwd=tmp_path)
    assert result.returncode == 0, result.stderr
    table = kl.DHTable.load(tmp_path / "ur5.toml")
    assert table == kl.to_dh(kl.load("ur5"))
    assert "0.39225" in kinlab("dh", "erd:ur5", "--tip", "tool0").stdout


@pytest.mark.parametrize(
    ("arguments", "message"),
    [
        (("info", "pume560"), "robot 'pume560' is unknown; did you mean 'puma560'"),
        (("info", "none.toml"), "none.toml: no such file"),
        (("dh", "erd:panda"), "a tree: after link 'panda_link7' branch"),
        (("dh", "erd:ur5", "--tip", "tol0"), "link 'tol0' does not exist; did you mean 'tool0'"),
        (("dh", "puma560", "--tip", "hand"), "a DH table has one tool"),
        (("urdf", "puma560", "-o", "/nowhere/puma.urdf"), "/nowhere/puma.urdf: cannot be written"),
    ],
)
def test_an_error_is_one_line_and_exit_code_2(arguments, message):
    result = kinlab(*arguments)
    assert result.returncode == 2
    assert message in result.stderr
    assert len(result.stderr.strip().splitlines()) == 1


def test_unknown_command_and_no_arguments_show_help():
    assert kinlab("frobnicate").returncode == 2
    assert "Usage" in kinlab().stdout + kinlab().stderr
