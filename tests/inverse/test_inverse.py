"""Inverse kinematics of one pose and of many: honest, repeatable, within the limits."""

import subprocess
import sys
from dataclasses import replace

import numpy as np
import pinocchio as pin
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from random_models import random_model
from random_tables import random_table

import kinlab as kl
from kinlab.engine.fast import arrays as chain_arrays
from kinlab.errors import NameUnknownError, OptionError, StateError, StructureError
from kinlab.inverse import kernel, methods
from kinlab.inverse.result import IKStatus

ARMS = [
    "puma560", "puma560_modified", "stanford", "ur5", "ur10", "panda", "erd:kinova", "erd:xarm7",
    "erd:talos_arm", "erd:z1", "erd:so100", "erd:ur3_limited", "erd:bravo7_no_ee",
]  # fmt: skip


def poses(robot, count, seed=0):
    q = np.random.default_rng(seed).uniform(robot.lower, robot.upper, (count, robot.n))
    return q, kl.fk(robot, q)


def independent_errors(robot, q, T):
    """Position and angle by Pinocchio's own SE3 and log3, not by the code under test."""
    data = robot.model.createData()
    pin.framesForwardKinematics(robot.model, data, q)
    pose = data.oMf[robot.tool]
    angle = np.linalg.norm(pin.log3(pose.rotation.T @ T[:3, :3]))
    return np.linalg.norm(pose.translation - T[:3, 3]), angle


@pytest.mark.parametrize("name", ARMS)
def test_random_reachable_poses(name):
    robot = kl.load(name)
    _, T = poses(robot, 300)
    answer = kl.ik_batch(robot, T)
    assert answer.success.mean() >= 0.99
    for i in np.flatnonzero(answer.success):
        position, rotation = independent_errors(robot, answer.q[i], T[i])
        assert position <= 1e-6 and rotation <= 1e-6
        assert answer.position_error[i] == pytest.approx(position, abs=1e-14)
        assert answer.rotation_error[i] == pytest.approx(rotation, abs=1e-9)
        assert np.all(answer.q[i] >= robot.lower) and np.all(answer.q[i] <= robot.upper)
    assert (answer.success == (answer.status == "converged")).all()


@settings(max_examples=40)
@given(st.integers(0, 10**6))
def test_random_tables(seed):
    convention = "standard" if seed % 2 else "modified"
    robot = kl.Robot.from_dh(random_table(seed, 1 + seed % 8, convention))
    _, T = poses(robot, 5, seed)
    for pose in T:
        answer = kl.ik(robot, pose, seed=1)
        position, rotation = independent_errors(robot, answer.q, pose)
        within = np.all(answer.q >= robot.lower) and np.all(answer.q <= robot.upper)
        good = position <= 1e-6 and rotation <= 1.0000001e-6 and within
        assert answer.success == good or not answer.success
        assert within or answer.status is IKStatus.OUTSIDE_LIMITS


@pytest.mark.parametrize("name", ["puma560", "panda", "stanford"])
def test_a_batch_is_the_single_answers_whatever_the_threads(name):
    robot = kl.load(name)
    _, T = poses(robot, 100, 3)
    single = [kl.ik(robot, pose, seed=4) for pose in T]
    for threads in (1, 2, 3):
        batch = kl.ik_batch(robot, T, seed=4, threads=threads)
        assert np.array_equal(batch.q, [a.q for a in single])
        assert list(batch.status) == [str(a.status) for a in single]
        assert list(batch.iterations) == [a.iterations for a in single]
    turned = kl.ik_batch(robot, T[::-1], seed=4)
    assert np.array_equal(turned.q[::-1], batch.q)


@pytest.mark.parametrize(
    ("name", "task"),
    [("puma560", "pose"), ("stanford", "pose"), ("panda", "pose"), ("panda", "position"),
     ("puma560", "orientation"), ("puma560", "xytheta"), ("planar3r", "xytheta"),
     ("puma560", (1, 1, 1, 1, 1, 0))],
)  # fmt: skip
def test_the_kernel_visits_the_states_of_the_readable_search(name, task):
    robot = kl.load(name)
    _, T = poses(robot, 20, 5)
    same = 0
    for pose in T:
        fast = kl.ik(robot, pose, task=task)
        slow = kl.ik(robot, pose, task=task, history=True, tol_step=1e-300)
        assert fast.success and slow.success
        agree = fast.iterations == slow.iterations and fast.restarts == slow.restarts
        same += agree and np.allclose(fast.q, slow.q, atol=1e-7)
        assert len(slow.history.q) == slow.iterations
        assert slow.history.position_error[-1] <= 1e-6
    assert same >= 18  # rounding may send a long search another way


@pytest.mark.parametrize("method", ["newton", "gradient", "lm"])
@pytest.mark.parametrize("name", ["planar2r", "planar3r", "puma560", "panda"])
def test_methods_near_the_answer(method, name):
    """Square, redundant and overdetermined (two joints asked for a whole pose)."""
    robot = kl.load(name)
    q, T = poses(robot, 5, 6)
    for state, pose in zip(q, T, strict=True):
        start = np.clip(state + 0.02, robot.lower, robot.upper)
        answer = kl.ik(robot, pose, start, method, max_iterations=20000)
        assert answer.success, (answer.status, answer.iterations)
        assert max(independent_errors(robot, answer.q, pose)) <= 1e-6


def test_fixed_alpha_descends_and_converges():
    robot = kl.load("planar2r")
    T = kl.fk(robot, [0.5, 1.0])
    answer = kl.ik(robot, T, [0.4, 0.9], "gradient", task="xy", alpha=0.1, history=True, restarts=0)
    errors = answer.history.position_error
    assert answer.success and np.all(np.diff(errors) < 0)
    assert answer.iterations > kl.ik(robot, T, [0.4, 0.9], "newton", task="xy").iterations


def test_newton_takes_the_right_inverse_where_redundant():
    rng = np.random.default_rng(0)
    for shape in ((3, 5), (5, 3), (4, 4)):
        jac, error = rng.normal(size=shape), rng.normal(size=shape[0])
        expected = np.linalg.pinv(jac) @ error
        np.testing.assert_allclose(methods.newton(jac, error), expected, atol=1e-12)


def test_exact_step_is_the_minimum_along_the_line():
    rng = np.random.default_rng(1)
    jac, error = rng.normal(size=(6, 7)), rng.normal(size=6)
    step = methods.gradient_exact(jac, error)
    left = np.linalg.norm(error - jac @ step)
    for factor in (0.99, 1.01):
        assert np.linalg.norm(error - factor * (jac @ step)) > left


def test_both_stopping_rules():
    robot = kl.load("puma560")
    q = np.array([0.1, -0.6, 0.3, 0.4, 0.9, 0.2])
    T = kl.fk(robot, q)
    by_error = kl.ik(robot, T, q + 0.1, "newton", history=True)
    by_step = kl.ik(robot, T, q + 0.1, "newton", tol_step=10.0, restarts=0)
    assert by_error.success and by_error.iterations > 2
    assert not by_step.success and by_step.iterations == 1


def test_newton_stalls_at_an_exact_singularity_and_lm_does_not():
    robot = kl.load("planar2r")
    T = kl.fk(robot, [0.3, 1.2])
    stuck = kl.ik(robot, T, [0.3, 0.0], "newton", task="xy", restarts=0)
    assert stuck.status is IKStatus.SINGULARITY and not stuck.success
    inside = np.eye(4)
    inside[:3, 3] = 0.5 * kl.fk(robot, [0.0, 0.0])[:3, 3]
    # pulled straight in along the stretched arm, J^T e = 0: no method of these can leave
    stuck = kl.ik(robot, inside, [0.0, 0.0], "lm", task="xy", restarts=0)
    assert stuck.status is IKStatus.SINGULARITY
    assert kl.ik(robot, inside, [0.0, 0.0], "lm", task="xy").success


@pytest.mark.parametrize("name", ["puma560", "ur5", "panda", "stanford", "planar3r"])
def test_targets_at_singular_states(name):
    robot = kl.load(name)
    state = np.clip(np.zeros(robot.n), robot.lower, robot.upper)
    answer = kl.ik(robot, kl.fk(robot, state))
    assert answer.success
    assert max(independent_errors(robot, answer.q, kl.fk(robot, state))) <= 1e-6


@pytest.mark.parametrize("name", ["puma560", "ur5", "panda"])
def test_targets_on_the_limits(name):
    robot = kl.load(name)
    for state in (robot.lower, robot.upper):
        assert kl.ik(robot, kl.fk(robot, state)).success


@pytest.mark.parametrize("name", ["puma560", "ur10", "panda", "stanford"])
def test_unreachable_poses_say_so(name):
    table = kl.load(name).table
    stick = np.eye(4)
    stick[2, 3] = 0.3
    robot = kl.Robot.from_dh(replace(table, tool=np.asarray(table.tool) @ stick))
    T = unreachable_poses(robot, 30)
    answer = kl.ik_batch(robot, T)
    assert not answer.success.any()
    assert set(answer.status) <= {"unreachable_suspected", "converged_outside_limits"}
    assert np.isfinite(answer.q).all()
    assert np.all(answer.restarts[:15] == 0) and np.all(answer.restarts[15:] > 0)


def unreachable_poses(robot, count):
    """Half out of reach; half at a position in reach, the last joint turned out of its reach."""
    arm = chain_arrays.chain(robot)
    hand, shoulder = arm.fixed[-1, [3, 7, 11]], arm.fixed[0, [3, 7, 11]]
    _, sample = poses(robot, 20000, 9)
    hand = arm.fixed[-1].reshape(3, 4)[:, :3].T @ hand  # last joint to tool, in the tool's axes
    wrist = sample[:, :3, 3] - sample[:, :3, :3] @ hand
    out = wrist - shoulder
    far = np.linalg.norm(out, axis=1)
    T = sample[:count].copy()
    T[:, :3, 3] *= 10.0 / np.linalg.norm(T[:, :3, 3], axis=1)[:, None]
    row = count // 2
    for pose in sample[np.argsort(-far)]:
        ahead = pose[:3, 3] - pose[:3, :3] @ hand - shoulder
        ahead /= np.linalg.norm(ahead)
        # the tool's vector points back at the shoulder, and puts the last joint too far out
        turn = pin.Quaternion.FromTwoVectors(pose[:3, :3] @ hand, -ahead).matrix()
        T[row, :3, :3] = turn @ pose[:3, :3]
        T[row, :3, 3] = shoulder + (1.02 * far.max() - 0.5 * np.linalg.norm(hand)) * ahead
        row += kl.ik(robot, T[row], task="position").success  # in reach, but for the orientation
        if row == count:
            return T
    raise AssertionError("too few")


def test_the_closest_pose_of_an_arm_that_cannot_reach():
    robot = kl.load("planar2r")
    T = np.eye(4)
    T[:2, 3] = [3.0, 4.0]
    answer = kl.ik(robot, T, task="xy")
    longest = kl.fk(robot, [0.0, 0.0])[0, 3]
    assert answer.position_error == pytest.approx(5.0 - longest, rel=1e-3)


def test_outside_the_limits_is_no_success():
    table = kl.load("planar2r").table
    links = [replace(link, lower=0.0, upper=0.2) for link in table.links]
    robot = kl.Robot.from_dh(replace(table, name="stiff", links=links))
    answer = kl.ik(robot, kl.fk(robot, [1.0, 1.0]), task="xy")
    assert not answer.success
    wide = [replace(link, lower=0.0, upper=5.5) for link in table.links]
    robot = kl.Robot.from_dh(replace(table, name="wide", links=wide))
    out = kl.ik(robot, kl.fk(robot, [-0.4, -0.3]))
    assert out.status is IKStatus.OUTSIDE_LIMITS and not out.success
    assert np.any((out.q < robot.lower) | (out.q > robot.upper))


def test_angles_are_the_turns_nearest_to_q0():
    robot = kl.load("erd:ur5")
    state = np.array([5.9, -1.0, 1.0, -5.5, 5.0, 6.1])
    answer = kl.ik(robot, kl.fk(robot, state), state - 0.05)
    np.testing.assert_allclose(answer.q, state, atol=1e-5)
    folded = np.mod(state - 0.05 + np.pi, 2 * np.pi) - np.pi
    other = kl.ik(robot, kl.fk(robot, state), folded)
    assert np.all(np.abs(other.q - folded) <= np.pi + 1e-9)


def test_single_joint_and_slide():
    for name in ("single_link", "scara"):
        robot = kl.load(name)
        q, T = poses(robot, 10, 11)
        for pose in T:
            assert kl.ik(robot, pose).success
        assert q.shape == (10, robot.n)


@pytest.mark.parametrize("seed", range(12))
def test_models_without_limits_and_with_any_axes(seed):
    model = random_model(np.random.default_rng(seed))
    robot = kl.Robot.from_model(model, "tool")
    T = kl.fk(robot, np.random.default_rng(seed).uniform(-1, 1, (5, robot.n)))
    answer = kl.ik_batch(robot, T)
    assert answer.success.all()
    for q, pose in zip(answer.q, T, strict=True):
        assert max(independent_errors(robot, q, pose)) <= 1e-6


def test_same_seed_same_bits_other_seed_other_starts():
    robot = kl.load("panda")
    _, T = poses(robot, 10, 12)
    first, second, third = (kl.ik_batch(robot, T, seed=s).q for s in (0, 0, 1))
    assert np.array_equal(first, second) and not np.array_equal(first, third)


def test_tight_and_loose_tolerances_are_met():
    robot = kl.load("puma560")
    _, T = poses(robot, 50, 13)
    tight = kl.ik_batch(robot, T, tol_position=1e-12, tol_rotation=1e-12)
    assert tight.success.all() and tight.position_error.max() <= 1e-12
    mixed = kl.ik_batch(robot, T, tol_position=1e-2, tol_rotation=1e-9)
    assert mixed.success.all() and mixed.rotation_error.max() <= 1e-9


def test_rotation_vector_up_to_half_a_turn():
    rng = np.random.default_rng(14)
    out = np.empty(3)
    for angle in (0.0, 1e-9, 1e-5, 1.0, 3.0, np.pi - 1e-5, np.pi - 1e-8, np.pi):
        for axis in (*np.eye(3), *-np.eye(3), *rng.normal(size=(5, 3))):
            vector = angle * axis / np.linalg.norm(axis)
            kernel.rotation_vector(pin.exp3(vector).ravel(), out)
            np.testing.assert_allclose(pin.exp3(out), pin.exp3(vector), atol=3e-8)
            assert np.linalg.norm(out) == pytest.approx(angle, abs=3e-8)


def test_turned_rows_are_the_derivative_of_the_rotation_vector():
    rng = np.random.default_rng(15)
    target = np.concatenate([pin.exp3(rng.normal(size=3)), np.zeros((3, 1))], axis=1).ravel()
    turn, omega, h = pin.exp3(rng.normal(size=3)), rng.normal(size=3), 1e-6

    def error(rotation):
        pose = np.concatenate([rotation, np.zeros((3, 1))], axis=1).ravel()
        out, r = np.empty(6), np.empty(9)
        kernel.pose_error(pose, target, r, out)
        return out

    jac = np.zeros((6, 1))
    jac[3:, 0] = omega
    kernel.turn_rows(jac, error(turn), 1)
    ahead, behind = error(pin.exp3(h * omega) @ turn), error(pin.exp3(-h * omega) @ turn)
    np.testing.assert_allclose(-(ahead - behind)[3:] / (2 * h), jac[3:, 0], atol=1e-8)


GOOD = np.eye(4)
MIRROR = np.diag([1.0, 1.0, -1.0, 1.0])
SHEAR = GOOD + 1e-3 * np.eye(4, k=1) * [[1], [1], [0], [0]]
HOLE = np.where(GOOD == 1, np.nan, GOOD)


@pytest.mark.parametrize(
    ("change", "error", "said"),
    [
        ({"T": np.eye(3)}, StateError, "expected (4, 4)"),
        ({"T": SHEAR}, StateError, "misses 1 by 0.001"),
        ({"T": HOLE}, StateError, "nan"),
        ({"T": MIRROR}, StateError, "mirror"),
        ({"T": GOOD + np.eye(4, k=-3)}, StateError, "last row"),
        ({"T": [GOOD, GOOD]}, StateError, "ik_batch"),
        ({"T": "home"}, StateError, "T"),
        ({"q0": np.zeros(5)}, StateError, "expected (6,)"),
        ({"q0": [np.nan] * 6}, StateError, "nan"),
        ({"tol_position": 0.0}, OptionError, "tol_position is 0.0"),
        ({"tol_rotation": -1e-3}, OptionError, "tol_rotation is -0.001"),
        ({"tol_position": np.nan}, OptionError, "tol_position"),
        ({"tol_rotation": True}, OptionError, "tol_rotation"),
        ({"tol_step": 0}, OptionError, "tol_step"),
        ({"method": "nweton"}, NameUnknownError, "'newton'"),
        ({"task": "positon"}, NameUnknownError, "'position'"),
        ({"task": [1, 0]}, OptionError, "six"),
        ({"seed": -1}, OptionError, "seed"),
        ({"seed": 1.5}, OptionError, "seed"),
        ({"restarts": -1}, OptionError, "restarts"),
        ({"max_iterations": 0}, OptionError, "max_iterations"),
        ({"alpha": 0.1}, OptionError, "belongs to method 'gradient'"),
        ({"method": "gradient", "alpha": -1.0}, OptionError, "alpha is -1.0"),
        ({"method": "gradient", "alpha": "fast"}, OptionError, "alpha is 'fast'"),
    ],
)
def test_bad_input_is_named(change, error, said):
    with pytest.raises(error) as caught:
        kl.ik(kl.load("puma560"), **{"T": GOOD, **change})
    assert said in str(caught.value)


def test_tasks_an_arm_cannot_have():
    with pytest.raises(OptionError, match=r"'planar2r': task 'xytheta' .* use task 'xy'"):
        kl.ik(kl.load("planar2r"), GOOD, task="xytheta")
    with pytest.raises(OptionError, match="never moves in z"):
        kl.ik(kl.load("planar3r"), GOOD, task="position")


def test_the_task_that_suits_the_arm():
    for name, task in (("planar2r", "xy"), ("planar3r", "xytheta"), ("puma560", "pose")):
        robot = kl.load(name)
        _, T = poses(robot, 3, 17)
        for pose in T:
            answer = kl.ik(robot, pose)
            assert answer.task == task == kl.ik_batch(robot, [pose]).task
            assert max(independent_errors(robot, answer.q, pose)) <= 1e-6  # the whole pose is met
            assert np.array_equal(answer.q, kl.ik(robot, pose, task="auto").q)
            if robot.n < 6:  # what the arm never moves in cannot be met, and is not asked for
                pose = pose @ turned_about_x(0.7)
                answer = kl.ik(robot, pose)
                assert answer.success and answer.task == task
                assert np.array_equal(answer.q, kl.ik(robot, pose, task=task).q)


def turned_about_x(angle):
    pose = np.eye(4)
    pose[1:3, 1:3] = [[np.cos(angle), -np.sin(angle)], [np.sin(angle), np.cos(angle)]]
    return pose


@pytest.mark.parametrize("method", ["lm", "newton"])
def test_a_spatial_3r_arm_meets_positions(method):
    robot = kl.load("spatial3r")
    q, T = poses(robot, 12, 3)
    T[:, :3, :3] = np.eye(3)  # an orientation that three joints cannot give there
    for start, pose in zip(q + 0.1, T, strict=True):
        answer = kl.ik(robot, pose, np.clip(start, robot.lower, robot.upper), method)
        assert answer.task == "position"
        assert answer.success
        assert independent_errors(robot, answer.q, pose)[0] <= 1e-6
    batch = kl.ik_batch(robot, T, q)
    assert batch.task == "position" and batch.success.all()
    for row, (start, pose) in enumerate(zip(q, T, strict=True)):  # each as ik answers it
        assert np.array_equal(batch.q[row], kl.ik(robot, pose, start).q)
    values = kl.manipulability(robot, q)
    linear = kl.jacobian(robot, q)[:, :3]
    assert values.task == values[2:].task == kl.manipulability(robot, q[0]).task == "position"
    assert values == pytest.approx(np.abs(np.linalg.det(linear)), rel=1e-9) and (values > 0).any()


def test_no_robot_and_a_floating_base():
    with pytest.raises(StructureError, match=r"kl\.load"):
        kl.ik(pin.Model(), GOOD)
    model = pin.Model()
    model.addJoint(0, pin.JointModelFreeFlyer(), pin.SE3.Identity(), "base")
    with pytest.raises(StructureError, match="floating"):
        kl.Robot.from_model(model)


def test_batch_names_the_bad_pose_and_takes_none():
    robot = kl.load("puma560")
    with pytest.raises(StateError, match=r"Ts\[2\]: .*mirror"):
        kl.ik_batch(robot, np.stack([GOOD, GOOD, MIRROR]))
    with pytest.raises(StateError, match="expected \\(N, 4, 4\\)"):
        kl.ik_batch(robot, GOOD)
    with pytest.raises(StateError, match=r"expected \(6,\) or \(3, 6\)"):
        kl.ik_batch(robot, np.stack([GOOD] * 3), np.zeros((2, 6)))
    empty = kl.ik_batch(robot, np.empty((0, 4, 4)))
    assert len(empty) == 0 and empty.q.shape == (0, 6)


def test_q0_outside_the_limits_is_clamped_and_said():
    robot = kl.load("puma560")
    answer = kl.ik(robot, kl.fk(robot, np.full(6, 0.2)), np.full(6, 3.0))
    assert "joint_3" in answer.remarks[0] and "limit" in answer.remarks[0]
    assert answer.success


def test_the_arrays_of_a_robot_are_read_once():
    robot = kl.load("puma560")
    assert chain_arrays.chain(robot) is chain_arrays.chain(robot)


def test_importing_kinlab_does_not_import_numba():
    code = "import sys, kinlab; sys.exit('numba' in sys.modules or 'scipy' in sys.modules)"
    assert subprocess.run([sys.executable, "-c", code], check=False).returncode == 0
