"""Paths keep their branch; the command line and the figure of a search."""

import logging

import numpy as np
import pytest
from typer.testing import CliRunner

import kinlab as kl
from kinlab.cli import app
from kinlab.errors import NameUnknownError, OptionError, StateError
from kinlab.plots.searches import ik_history

RUN = CliRunner()


def joint_path(robot, one, two, count=60):
    return np.linspace(one, two, count)


def test_a_path_in_joint_space_is_found_again():
    robot = kl.load("puma560")
    path = joint_path(robot, [0.1, -0.6, 0.3, 0.4, 0.9, 0.2], [0.9, 0.2, 0.7, -0.4, 0.5, 1.0])
    found = kl.ik_path(robot, kl.fk(robot, path), path[0])
    assert found.success.all() and len(found) == 60
    np.testing.assert_allclose(found.q, path, atol=1e-4)
    assert not len(found.jumps) and not len(found.singular)
    assert found.position_error.max() <= 1e-6 and set(found.status) == {"converged"}


def test_a_path_through_a_wrist_singularity_is_reported():
    robot = kl.load("puma560")
    path = joint_path(robot, [0.1, -0.6, 0.3, 0.4, 0.3, 0.2], [0.3, -0.5, 0.4, 0.3, -0.3, 0.2], 61)
    found = kl.ik_path(robot, kl.fk(robot, path), path[0])
    assert found.success.all() and 30 in found.singular
    assert found.conditioning.argmin() == pytest.approx(30, abs=1)


def test_a_change_of_branch_is_a_jump():
    robot = kl.load("puma560")
    q = np.array([0.1, -0.6, 0.3, 0.4, 0.9, 0.2])
    T = kl.fk(robot, np.array([q, q + 0.01, q + [0, 0, 0, 2.0, 0, 0]]))
    found = kl.ik_path(robot, T, q)
    assert found.success.all() and list(found.jumps) == [2]


def test_a_pose_out_of_reach_does_not_end_the_path():
    robot = kl.load("puma560")
    q = np.array([0.1, -0.6, 0.3, 0.4, 0.9, 0.2])
    T = kl.fk(robot, np.array([q, q + 0.01, q + 0.02]))
    T[1, :3, 3] = 9.0
    found = kl.ik_path(robot, T, q)
    assert list(found.success) == [True, False, True]
    assert found.status[1] == "unreachable_suspected"


def test_paths_at_the_door():
    robot = kl.load("puma560")
    with pytest.raises(StateError, match="expected"):
        kl.ik_path(robot, np.eye(4), np.zeros(6))
    with pytest.raises(OptionError, match="max_step"):
        kl.ik_path(robot, np.eye(4)[None], np.zeros(6), max_step=0.0)
    with pytest.raises(NameUnknownError, match="task"):
        kl.ik_path(robot, np.eye(4)[None], np.zeros(6), task="sideways")
    assert len(kl.ik_path(robot, np.empty((0, 4, 4)), np.zeros(6))) == 0


def test_the_command_prints_the_solution(tmp_path):
    figure = tmp_path / "search.png"
    done = RUN.invoke(
        app, "ik puma560 --xyz .4 .1 .3 --rpy 0 pi 0 --history".split() + [str(figure)]
    )
    assert done.exit_code == 0, done.output
    assert (
        "converged: position error" in done.output
        and "task pose" in done.output
        and "mm" in done.output
    )
    assert figure.stat().st_size > 5000
    values = [float(line.split()[1]) for line in done.output.splitlines()[:6]]
    pose = kl.fk(kl.load("puma560"), values)
    np.testing.assert_allclose(pose[:3, 3], [0.4, 0.1, 0.3], atol=2e-6)
    np.testing.assert_allclose(pose[:3, :3], np.diag([-1, 1, -1]), atol=2e-6)


def test_the_command_warns_of_a_pose_met_only_outside_the_limits():
    done = RUN.invoke(app, "ik puma560 --xyz -.3 .05 -.6 --rpy 0 0 0".split())
    assert done.exit_code == 1
    assert "converged_outside_limits" in done.output
    assert "kinlab: outside the limits of joint_" in done.output
    robot = kl.load("puma560")
    pose = np.eye(4)
    pose[:3, 3] = [-0.3, 0.05, -0.6]
    assert not kl.ik_branches(robot, pose).within_limits.any()  # the closed form agrees


def test_the_command_lists_branches_and_fails_with_one():
    many = RUN.invoke(app, "ik puma560 --xyz .4 .1 .3 --rpy 0 pi 0 --branches".split())
    assert many.exit_code == 0 and many.output.count("shoulder") == 8
    far = RUN.invoke(app, "ik puma560 --xyz 9 0 0".split())
    assert far.exit_code == 1 and "unreachable_suspected" in far.output
    assert RUN.invoke(app, "ik puma560 --xyz 9 0 0 --branches".split()).exit_code == 1
    slide = RUN.invoke(
        app, ["ik", "stanford", "--xyz", ".4", ".1", ".3", "--q0", "0,0,.5,-pi/2,0,0"]
    )
    assert "mm)" in slide.output


@pytest.mark.parametrize(
    "words", ["--task nose", "--method fast", "--q0 0,0", "--rpy 0 x 0", "--tol-position 0"]
)
def test_the_command_names_bad_input(words):
    done = RUN.invoke(app, ["ik", "puma560", "--xyz", ".4", ".1", ".3", *words.split()])
    assert isinstance(done.exception, kl.KinlabError)


def test_the_figure_marks_new_starts():
    robot = kl.load("puma560")
    T = kl.fk(robot, [0.3, -0.5, 0.6, 0.4, 0.9, -0.3])
    answer = kl.ik(robot, T, np.full(6, -1.5), history=True)
    axes = ik_history({"lm": answer.history}, "puma560")
    lines = [line for line in axes.lines if len(line.get_xdata()) == answer.iterations]
    assert len(lines) == 2 and axes.get_yscale() == "log"


def test_the_word_about_compiling_has_one_handler_however_often_ik_is_called():
    logger = logging.getLogger("kinlab.engine.fast.compiled")
    for _ in range(3):
        assert RUN.invoke(app, ["ik", "planar2r", "--xyz", ".4", ".1", "0"]).exit_code == 0
    assert [handler.get_name() for handler in logger.handlers].count("kinlab ik") == 1
