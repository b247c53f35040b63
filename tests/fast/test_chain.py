"""The compiled chain against Pinocchio, on shipped arms, URDF arms and random axes."""

import numba
import numpy as np
import pinocchio as pin
import pytest
from random_models import random_model

import kinlab as kl
from kinlab.engine.fast import compiled
from kinlab.engine.fast import kinematics_kernels as kernels
from kinlab.engine.fast.arrays import chain
from kinlab.engine.fast.threads import over_rows, wanted_threads
from kinlab.errors import OptionError

ARMS = ["puma560", "stanford", "planar2r", "scara", "erd:talos_arm", "erd:xarm7", "erd:hextilt"]


def answers(robot: kl.Robot, q: np.ndarray, threads: int = 1):
    arrays = chain(robot)
    poses = np.empty((len(q), 4, 4))
    jacobians = np.full((len(q), 6, robot.n), np.nan)
    over_rows(kernels.fk_rows, len(q), *arrays, q, poses, threads=threads, grain=4)
    over_rows(kernels.jacobian_rows, len(q), *arrays, q, jacobians, threads=threads, grain=4)
    return poses, jacobians


@pytest.mark.parametrize("name", ARMS)
def test_arms_agree_with_pinocchio(name):
    robot = kl.load(name)
    q = np.random.default_rng(1).uniform(-3, 3, (50, robot.n))
    poses, jacobians = answers(robot, q)
    np.testing.assert_allclose(poses, kl.fk(robot, q), atol=1e-13)
    np.testing.assert_allclose(jacobians, kl.jacobian(robot, q), atol=1e-13)


@pytest.mark.parametrize("seed", range(40))
def test_random_axes_agree_with_pinocchio(seed):
    rng = np.random.default_rng(seed)
    robot = kl.Robot.from_model(random_model(rng), "tool")
    q = rng.uniform(-3, 3, (5, robot.n))
    poses, jacobians = answers(robot, q)
    np.testing.assert_allclose(poses, kl.fk(robot, q), atol=1e-12)
    expected = kl.jacobian(robot, q).reshape(jacobians.shape)
    np.testing.assert_allclose(jacobians, expected, atol=1e-12)


def test_joints_behind_the_tool_have_zero_columns():
    model = random_model(np.random.default_rng(3))
    while model.nv < 3:
        model.addJoint(model.njoints - 1, pin.JointModelRX(), pin.SE3.Identity(), f"x{model.nv}")
    model.addFrame(pin.Frame("early", 2, pin.SE3.Identity(), pin.FrameType.OP_FRAME))
    robot = kl.Robot.from_model(model, "early")
    q = np.random.default_rng(4).uniform(-1, 1, (3, robot.n))
    poses, jacobians = answers(robot, q)
    np.testing.assert_allclose(poses, kl.fk(robot, q), atol=1e-13)
    np.testing.assert_allclose(jacobians, kl.jacobian(robot, q), atol=1e-13)
    assert not jacobians[:, :, 2:].any()


@pytest.mark.parametrize("shape", [(6, 7), (6, 6), (3, 5), (6, 2), (1, 4)])
def test_singular_values_agree_with_lapack(shape):
    rng = np.random.default_rng(5)
    short = min(shape)
    for scale in (1.0, 1e-8, 0.0):
        matrix = rng.normal(size=shape)
        matrix[-1] *= scale
        out = np.empty(short)
        kernels.singular_values(matrix, np.empty((short, max(shape))), out)
        expected = np.linalg.svd(matrix, compute_uv=False)
        np.testing.assert_allclose(out, expected, atol=1e-14 * max(1.0, expected[0]))


def test_singular_values_of_task_rows():
    robot = kl.load("puma560")
    q = np.random.default_rng(6).uniform(-3, 3, (20, 6))
    rows = np.array([0, 1, 5])
    out = np.empty((20, 3))
    kernels.singular_value_rows(*chain(robot), q, rows, out, 0, 20)
    expected = np.linalg.svd(kl.jacobian(robot, q)[:, rows], compute_uv=False)
    np.testing.assert_allclose(out, expected, atol=1e-13)


def test_threads_do_not_change_a_bit():
    robot = kl.load("erd:xarm7")
    q = np.random.default_rng(7).uniform(-3, 3, (200, 7))
    one, three = answers(robot, q, 1), answers(robot, q, 3)
    assert all(np.array_equal(a, b) for a, b in zip(one, three, strict=True))


@pytest.mark.parametrize("threads", [0, -1, 1.5, True, "2"])
def test_bad_wanted_threadss(threads):
    with pytest.raises(OptionError, match="threads"):
        wanted_threads(threads)


def test_compiling_is_announced_once_and_only_when_asked(caplog, monkeypatch):
    monkeypatch.setattr(compiled.event_announcer, "said", False)
    with caplog.at_level("WARNING", logger="kinlab.engine.fast.compiled"):
        numba.njit(lambda x: x + 1)(1)
    assert not caplog.records
    with caplog.at_level("INFO", logger="kinlab.engine.fast.compiled"):
        numba.njit(lambda x: x + 2)(1)
        numba.njit(lambda x: x + 3)(1)
    assert [r.message for r in caplog.records].count(caplog.records[0].message) == 1
    assert "compiling kernels" in caplog.records[0].message


def test_no_folder_to_cache_in_still_compiles(monkeypatch):
    real = numba.njit

    def njit(**options):
        if options.get("cache"):
            raise RuntimeError("cannot cache function: no locator available")
        return real(**options)

    monkeypatch.setattr(numba, "njit", njit)
    assert compiled.kernel(lambda x: 2 * x)(21) == 42
