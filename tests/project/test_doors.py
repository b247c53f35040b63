"""Arguments at the doors of the public functions: an answer, or an error that says what to do."""

from __future__ import annotations

import numpy as np
import pytest

import kinlab as kl
from kinlab.errors import KinlabError, OptionError, StateError, StructureError

ARM = kl.load("planar2r")
FIVE = kl.FiveBar.load("isotropic")
CHAIN = FIVE.closed_chain()
POSE = CHAIN.at([0.1, -0.5])


class Raises:
    def __array__(self, *args, **kwargs):
        raise RuntimeError("boom")


BAD = [
    None, "q", b"q", [1, "x"], Raises(), [0.1, np.nan], [0.1, np.inf], [0.1, 1e155], [0.1 + 1j, 0],
    np.ma.array([0.1, 0.2], mask=[False, True]), [10**400, 0], [True, False], {0.1, 0.2},
]  # fmt: skip


@pytest.mark.parametrize("q", BAD, ids=lambda value: type(value).__name__)
def test_what_are_no_numbers_is_refused(q):
    for call in (lambda: kl.fk(ARM, q), lambda: kl.inverse_dynamics(ARM, [0, 0], q, [0, 0]),
                 lambda: FIVE.ik(q), lambda: CHAIN.fk(q)):  # fmt: skip
        with pytest.raises(KinlabError):
            call()


def test_the_closed_chain_reads_numbers_of_any_machine():
    for name in ("fk", "jacobian", "mass_matrix", "projection", "tool_jacobian"):
        plain = getattr(CHAIN, name)(POSE)
        for other in (POSE.astype(">f8"), POSE.tolist(), POSE[::-1].copy()[::-1]):
            assert np.array_equal(getattr(CHAIN, name)(other), plain)
    for bad in (POSE[:3], np.full(4, np.nan), None, POSE * 1e200):
        with pytest.raises(StateError):
            CHAIN.fk(bad)
        with pytest.raises(StateError):
            CHAIN.energy(POSE, bad)


@pytest.mark.parametrize(
    "robot",
    [None, 5, np.zeros(2), kl.Robot, FIVE, b"x", ["planar2r"], kl.DHLink()],
    ids=lambda value: type(value).__name__,
)
def test_what_is_no_robot_is_refused(robot):
    for call in (lambda: kl.fk(robot, [0.0, 0.0]), lambda: kl.mass_matrix(robot, [0.0, 0.0]),
                 lambda: kl.planar_boundary(robot), lambda: kl.find_isotropic(robot, seeds=2),
                 lambda: kl.to_dh(robot)):  # fmt: skip
        with pytest.raises(StructureError, match="robot"):
            call()


@pytest.mark.parametrize(
    "seed",
    [-1, 1.5, "5", np.nan, [1, 2], None, True, b"1", object()],
    ids=lambda value: type(value).__name__,
)
def test_a_seed_that_is_none_is_refused(seed):
    for call in (
        lambda: kl.find_singularities(ARM, points=1, seed=seed),
        lambda: kl.sample_workspace(ARM, samples=10, seed=seed),
        lambda: kl.compare(ARM, "fk", lambda q: np.eye(4), samples=3, seed=seed),
        lambda: kl.nearest_singularity(ARM, [0.1, 0.2], seed=seed),
    ):
        with pytest.raises(OptionError, match="seed is"):
            call()


@pytest.mark.parametrize(
    "count", [0, -1, 1.5, "5", None, [3], True], ids=lambda value: type(value).__name__
)
def test_a_count_that_is_none_is_refused(count):
    for call in (
        lambda: kl.find_singularities(ARM, points=count),
        lambda: kl.find_isotropic(ARM, seeds=count),
        lambda: kl.sample_workspace(ARM, samples=count),
        lambda: kl.compare(ARM, "fk", lambda q: np.eye(4), samples=count),
        lambda: kl.singular_loci(ARM, [0, 1], levels=count),
    ):
        with pytest.raises(OptionError, match="whole number"):
            call()


@pytest.mark.parametrize(
    "text", ["0.5#7", "0.5 # x", "5_0", "٥", "0x10", "1j", "tan(pi/2)", "2pi", "1e400"]
)
def test_a_number_of_a_table_that_has_no_value(tmp_path, text):
    file = tmp_path / "t.toml"
    file.write_text(
        f'name = "t"\nconvention = "standard"\n[[links]]\njoint = "revolute"\na = "{text}"\n'
        "alpha = 0\nd = 0\ntheta = 0\n", encoding="utf-8",
    )  # fmt: skip
    with pytest.raises(KinlabError, match="link 1: a: "):
        kl.load(file)


@pytest.mark.parametrize("text", ["x = " + "[" * 5000 + "]" * 5000, "a = " + "1" * 5000])
def test_toml_that_cannot_be_held_is_one_error(tmp_path, text):
    file = tmp_path / "t.toml"
    file.write_text(text, encoding="utf-8")
    with pytest.raises(KinlabError, match="not TOML"):
        kl.load(file)
