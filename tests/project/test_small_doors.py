"""Doors that let nonsense through once: each says what was given and what to give instead."""

from __future__ import annotations

import numpy as np
import pytest

import kinlab as kl
from kinlab.errors import FileError, NameUnknownError, OptionError, StateError

ARM = kl.load("planar2r")
T = kl.fk(ARM, [0.3, 0.4])


@pytest.mark.parametrize("tiny", [5e-324, 1e-320, 1e-309, 3e-309, 1e-308])
@pytest.mark.parametrize("name", ["single_link", "planar2r", "puma560", "scara"])
def test_a_state_beside_zero_is_the_state_zero(name, tiny):
    """No number tells such a q from 0: what is endless there is endless here, nothing is NaN."""
    robot = kl.load(name)
    here, zero = np.full(robot.n, tiny), np.zeros(robot.n)
    for task in ("auto", "position"):
        one, other = kl.dexterity(robot, here, task), kl.dexterity(robot, zero, task)
        assert one.rank == other.rank
        assert np.allclose(one.sigma, other.sigma, rtol=0, atol=1e-15)
        for field in ("yoshikawa", "min_singular"):
            assert getattr(one, field) == pytest.approx(getattr(other, field), abs=1e-15)
        if len(one.sigma) > 1:  # one number alone is always best conditioned
            assert one.condition >= 1e15 or one.condition == pytest.approx(other.condition)
    assert (kl.redundancy(robot, here).inverse is None) == (
        kl.redundancy(robot, zero).inverse is None
    )
    force = kl.ellipsoid(robot, here, "force").lengths
    assert np.array_equal(np.isinf(force), np.isinf(kl.ellipsoid(robot, zero, "force").lengths))


def test_a_joint_is_given_once():
    robot = kl.load("panda")
    pose = kl.fk(robot, np.zeros(7))
    with pytest.raises(OptionError, match=r"joint 'panda_joint3' twice.*index 2"):
        kl.ik_branches(robot, pose, given={"panda_joint3": 0.1, 2: 0.2})
    for key in ("panda_joint3", 2):
        assert len(kl.ik_branches(robot, pose, given={key: 0.0}))


@pytest.mark.parametrize("threads", [0, -1, 1.5, True, "2"])
def test_threads_are_a_whole_number_wherever_they_are_given(threads):
    for call in (
        lambda: kl.ik_batch(ARM, [T], threads=threads),
        lambda: kl.ik_batch(ARM, np.empty((0, 4, 4)), threads=threads),
        lambda: kl.ik_branches(ARM, T, threads=threads),
        lambda: kl.ik_branches(ARM, [T, T], threads=threads),
        lambda: kl.ik_branches("panda", kl.fk("panda", np.zeros(7)), threads=threads, samples=1),
        lambda: kl.solution_count(ARM, T, threads=threads),
        lambda: kl.solution_count(ARM, [T], threads=threads),
    ):
        with pytest.raises(OptionError, match="threads is .*whole number from 1"):
            call()


def test_a_stack_of_stacks_is_told_the_shapes_taken():
    deep = np.tile(T, (2, 3, 1, 1))
    for call, shapes in (
        (lambda: kl.ik(ARM, deep), r"\(4, 4\); for many use ik_batch"),
        (lambda: kl.ik_batch(ARM, deep), r"\(N, 4, 4\)"),
        (lambda: kl.ik_path(ARM, deep, [0, 0]), r"\(N, 4, 4\)"),
        (lambda: kl.ik_branches(ARM, deep), r"\(4, 4\) or \(N, 4, 4\)"),
        (lambda: kl.solution_count(ARM, deep), r"\(4, 4\) or \(N, 4, 4\)"),
        (lambda: kl.fk(ARM, np.zeros((2, 2, 2))), r"\(2,\) or \(N, 2\)"),
    ):
        with pytest.raises(StateError, match=f"shape .*expected {shapes}"):
            call()


def test_a_length_that_no_number_can_be_divided_by():
    for length in (5e-324, 1e-300, 1e50):
        with pytest.raises(OptionError, match="characteristic length .*give one from"):
            kl.dexterity(ARM, [0.1, 0.2], length=length)


@pytest.mark.parametrize(
    ("text", "error", "said"),
    [
        ("my_arm.tml", FileError, "did you mean 'my_arm.toml'"),
        ("folder/my.urd", FileError, "did you mean 'folder/my.urdf'"),
        ("my_arm.TOLM", FileError, "did you mean 'my_arm.toml'"),
        ("folder/arm", FileError, "ends in .toml, .csv or .urdf"),
        ("arm.docx", FileError, "ends in .toml, .csv or .urdf"),
        ("isotropic", NameUnknownError, "kinlab fivebar analyse isotropic"),
        ("pumma560", NameUnknownError, "did you mean 'puma560'"),
    ],
)
def test_what_is_nearly_a_file_or_a_robot(text, error, said):
    for call in (lambda: kl.load(text), lambda: kl.fk(text, [0.0, 0.0])):
        with pytest.raises(error) as problem:
            call()
        assert said in str(problem.value)
        assert len(str(problem.value)) < 300  # not the list of all robots


@pytest.mark.parametrize(
    ("row", "said"),
    [
        ("d =", r"line 8: 'd' has no value: d = 0\.5, or d = \"pi/2\""),
        ("d = # later", r"line 8: 'd' has no value"),
        ("d = pi/2", r"line 8: 'd' cannot be pi/2; text stands in quotes"),
    ],
)
@pytest.mark.parametrize("end", ["", "\n", "\n\n[[links]]\n"])
def test_a_key_without_a_value_is_named_with_its_line(tmp_path, row, said, end):
    file = tmp_path / "arm.toml"
    above = 'name = "x"\nconvention = "standard"\n[[links]]\njoint = "revolute"\na = 1\nalpha = 0\n'
    file.write_text(f"{above}theta = 0\n{row}{end}", encoding="utf-8")
    with pytest.raises(kl.KinlabError, match=said):
        kl.load(file)


def test_a_position_jacobian_is_told_of_the_rows_that_it_is():
    def mine(q):
        return kl.jacobian("spatial3r", q)[:3]

    told = r"'jacobian\[:3\]', the last 'jacobian\[3:\]'"
    with pytest.raises(kl.KinlabError, match=rf"shape \(3, 3\).*shape \(6, 3\).*{told}"):
        kl.compare("spatial3r", "jacobian", mine, samples=3)
    assert "'jacobian[:3]'" in str(kl.diagnose("spatial3r", "jacobian", mine, samples=10))
    assert kl.compare("spatial3r", "jacobian[:3]", mine, samples=3).agrees


def test_a_table_is_not_saved_under_another_kind_of_file(tmp_path):
    with pytest.raises(kl.errors.FileError, match=r"saved as TOML; name a \.toml"):
        kl.load("planar2r").table.save(tmp_path / "p.csv")
    with pytest.warns(kl.errors.KinlabWarning, match="no place for tool and gravity"):
        kl.load("planar2r").table.to_csv(tmp_path / "p.csv")


@pytest.mark.parametrize(("typed", "meant"), [("UR5", "'ur5'"), ("PUMA560", "'puma560'")])
def test_capitals_do_not_count_where_names_are_near(typed, meant):
    with pytest.raises(kl.errors.NameUnknownError, match=f"did you mean {meant}"):
        kl.load(typed)


def test_scenes_and_figures_take_names():
    assert kl.viewer.Scene("planar2r").robot.name == "planar2r"
    assert kl.plots.ellipses("planar2r", [0.3, 0.6]) is not None
    assert kl.plots.fivebar("isotropic", resolution=11) is not None


def test_answers_about_singularities_introduce_themselves():
    puma, q = "puma560", [0.1, 0.3, -0.8, 0.4, 0.7, 0.1]
    near = kl.nearest_singularity(puma, q)
    assert str(near).startswith("nearest singularity: 0.7 away") and "proved" in str(near)
    assert repr(near) == str(near) and "<b>nearest" in near._repr_html_()
    assert str(kl.factored_determinant(puma)).startswith("puma560, task pose: det J = a2*")
    assert str(kl.design_isotropic("planar2r", ["a2", "tool.x"], seeds=5)).startswith("1 isotropic")
    assert "4 singular curves in the slice of joints 2 and 3" in str(kl.singular_loci(puma, [1, 2]))


def test_bars_that_count_as_points_are_said():
    bars = {"crank_mass": 1.0, "rod_mass": 0.4, "rod_com": 0.2}
    with pytest.warns(kl.errors.KinlabWarning, match="cranks and rods have mass without inertia"):
        kl.FiveBar(0.3, 0.5, 0.1, **bars).size_servo((-0.1, 0.1, -0.6, -0.5), v_max=3.0, a_max=60.0)
