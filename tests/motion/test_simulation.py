"""Motion under torques: MuJoCo, closed forms of friction, the planned motion, and the energy."""

from __future__ import annotations

import mujoco
import numpy as np
import pytest

import kinlab as kl
from kinlab.errors import InertiaError, OptionError, StateError
from kinlab.motion import simulation
from kinlab.motion.simulation import least_constraint


def wave(n):
    return lambda t, q, v: 0.5 * np.sin(3 * t + np.arange(n)) - 0.02 * v


def in_mujoco(robot, q0, torque, damping, steps=5000):
    """The same arm by MuJoCo's RK4 with steps of 0.2 ms, no contacts and no end stops."""
    model = mujoco.MjModel.from_xml_string(robot.urdf)
    model.opt.gravity[:] = robot.table.gravity
    model.opt.timestep, model.opt.integrator = 1.0 / steps, mujoco.mjtIntegrator.mjINT_RK4
    off = mujoco.mjtDisableBit
    model.opt.disableflags |= off.mjDSBL_LIMIT | off.mjDSBL_CONTACT
    model.dof_armature[:] = [link.armature for link in robot.table.links]
    model.dof_damping[:] = damping
    data = mujoco.MjData(model)
    data.qpos[:] = q0

    def apply(_, state):
        state.qfrc_applied[:] = torque(state.time, state.qpos, state.qvel)

    mujoco.set_mjcb_control(apply)
    try:
        for _ in range(steps):
            mujoco.mj_step(model, data)
    finally:
        mujoco.set_mjcb_control(None)
    return np.array(data.qpos), np.array(data.qvel)


@pytest.mark.parametrize(
    ("name", "rub"), [("ur5", 0.3), ("scara", 0.1), ("stanford", 0.0), ("spatial3r", 0.05)]
)
def test_the_same_trajectory_as_mujoco(name, rub):
    plain = kl.load(name)
    model = plain.model.copy()
    model.damping = np.full(plain.n, rub)
    robot = kl.Robot(name, model, plain.tool, plain.urdf, plain.table)
    q0 = np.clip(np.full(robot.n, 0.4), robot.lower, robot.upper)
    ours = kl.simulate(robot, q0, None, wave(robot.n), duration=1.0, step=0.1)
    q, v = in_mujoco(plain, q0, wave(robot.n), rub)
    assert np.abs(ours.q[-1] - q0).max() > 0.05
    np.testing.assert_allclose(ours.q[-1], q, rtol=0, atol=1e-6)
    np.testing.assert_allclose(ours.v[-1], v, rtol=0, atol=1e-6)
    assert ours.miss < 1e-7 * max(1.0, np.abs(ours.energy).max())
    assert ours.loss[-1] > 0 or rub == 0.0


def slide(mass=2.0, dry=1.0, damping=0.0, weight=0.0):
    """A block on a straight rail along x, with Coulomb friction; gravity along the rail."""
    table = kl.DHTable("block", "standard", links=[
        kl.DHLink(joint="prismatic", a=0, alpha=0, d=0, theta=0, lower=-10, upper=10, mass=mass, inertia=1e-3 * np.eye(3))
    ], gravity=(0, 0, -weight), source="one block")  # fmt: skip
    robot = kl.Robot.from_dh(table)
    model = robot.model.copy()
    model.friction, model.damping = np.array([dry]), np.array([damping])
    return kl.Robot("block", model, robot.tool)


def test_a_block_slides_until_friction_has_eaten_its_speed():
    """x = v0²/(2 mu), mu = c/m, at t = v0/mu; then it stays, held."""
    ran = kl.simulate(slide(), [0.0], [0.4], duration=1.0, step=0.05)
    stop = 0.4 / 0.5
    t = np.minimum(ran.t, stop)
    np.testing.assert_allclose(ran.q[:, 0], 0.4 * t - 0.25 * t**2, rtol=0, atol=1e-9)
    np.testing.assert_allclose(ran.v[:, 0], 0.4 - 0.5 * t, rtol=0, atol=1e-9)
    assert np.all(ran.v[ran.t > stop] == 0.0) and np.all(ran.a[ran.t > stop + 1e-6] == 0.0)
    assert ran.loss[-1] == pytest.approx(0.5 * 2.0 * 0.4**2, rel=1e-8)
    assert ran.miss < 1e-9


def test_a_force_below_the_friction_moves_nothing_and_one_above_it_does():
    """F = 0.5 t against c = 1: it breaks loose at t = 2 and then m a = F - c."""
    ran = kl.simulate(slide(), [0.0], None, lambda t, q, v: [0.5 * t], duration=4.0, step=0.1)
    late = np.maximum(ran.t - 2.0, 0.0)
    np.testing.assert_allclose(ran.q[:, 0], 0.5 * late**3 / 6 / 2.0, rtol=0, atol=1e-7)
    assert ran.miss < 1e-8
    held = kl.simulate(
        slide(weight=0.4), [1.0], None, duration=1.0
    )  # 0.8 N of weight, 1 N of friction
    assert np.array_equal(held.q, np.ones_like(held.q))
    slips = kl.simulate(slide(weight=0.6), [1.0], None, duration=1.0)
    np.testing.assert_allclose(slips.q[-1], 1.0 - 0.5 * 0.1 * 1.0, rtol=0, atol=1e-9)


def test_a_block_on_a_spring_turns_round_and_sticks_where_theory_says():
    """Each half swing loses 2c/k; it sticks once |k x| <= c (Coulomb damping)."""
    k, mass, dry, start = 100.0, 2.0, 1.0, 0.095
    ran = kl.simulate(slide(mass, dry), [start], None, lambda t, q, v: -k * q, duration=3.0)
    turns = [start]
    while k * abs(turns[-1]) > dry:
        turns.append(-(turns[-1] - np.sign(turns[-1]) * 2 * dry / k))
    half = np.pi * np.sqrt(mass / k)
    for i, x in enumerate(turns):
        at = np.searchsorted(ran.t, i * half)
        assert np.abs(ran.q[max(at - 1, 0) : at + 1, 0] - x).min() < 1e-3
    np.testing.assert_allclose(ran.q[-1], turns[-1], rtol=0, atol=1e-8)
    assert ran.v[-1] == 0.0 and ran.miss < 1e-8


def test_the_accelerations_of_least_constraint_are_the_least():
    """Beside random trials of the same sum, and its conditions one by one."""
    rng = np.random.default_rng(0)
    for _ in range(60):
        n = int(rng.integers(1, 7))
        half = rng.normal(size=(n, n))
        inertia, right = half @ half.T + 0.1 * np.eye(n), rng.normal(size=n)
        dry = np.where(rng.random(n) < 0.3, 0.0, rng.exponential(1.0, n))
        a = least_constraint(inertia, right, dry)
        value = 0.5 * a @ inertia @ a - a @ right + dry @ np.abs(a)
        trials = a + rng.normal(size=(300, n)) * rng.choice([1e-4, 1e-2, 1.0], (300, 1))
        others = (
            0.5 * np.einsum("ki,ij,kj->k", trials, inertia, trials)
            - trials @ right
            + np.abs(trials) @ dry
        )
        assert value <= others.min() + 1e-12
        friction = right - inertia @ a
        assert np.all(np.abs(friction) <= dry * (1 + 1e-9) + 1e-9)
        np.testing.assert_allclose(friction[a != 0], (dry * np.sign(a))[a != 0], atol=1e-9)


def coupled(rng):
    """M nearly singular, and r such that x is the minimiser: held joints pull less than c."""
    m = int(rng.integers(3, 6))
    half = rng.normal(size=(m, 2))
    inertia = half @ half.T + 10.0 ** rng.uniform(-7, -4) * np.eye(m)
    x = rng.normal(size=m) * (rng.random(m) < 0.7) * 10 ** rng.uniform(0, 3)
    dry = rng.uniform(0.1, 2.0, m)
    pulls = np.where(x == 0.0, rng.uniform(-0.9, 0.9, m), np.sign(x))
    return inertia, inertia @ x + dry * pulls, dry, x


def test_least_constraint_where_descent_is_slow():
    """Rounds over the joints do not come to the pattern here; the patterns are tried."""
    rng = np.random.default_rng(3)
    for _ in range(60):
        inertia, right, dry, x = coupled(rng)
        a = least_constraint(inertia, right, dry)
        np.testing.assert_array_equal(a == 0.0, x == 0.0)
        np.testing.assert_allclose(a, x, rtol=0, atol=1e-6 * (1 + np.abs(x).max()))


def test_least_constraint_is_no_guess(monkeypatch):
    """Without an answer that explains itself there is none."""
    monkeypatch.setattr(simulation, "_MOST_PATTERNS", 0)
    monkeypatch.setattr(simulation, "_ROUNDS", 1)
    rng, refused = np.random.default_rng(3), 0
    for _ in range(60):
        inertia, right, dry, x = coupled(rng)
        try:
            a = least_constraint(inertia, right, dry)
        except OptionError as error:
            refused += 1
            assert "mass matrix" in str(error)
        else:
            np.testing.assert_allclose(a, x, rtol=0, atol=1e-6 * (1 + np.abs(x).max()))
    assert refused > 10


def test_friction_of_two_coupled_joints_keeps_its_energy():
    robot = kl.load("planar2r")
    model = robot.model.copy()
    model.damping, model.friction = np.array([0.4, 0.1]), np.array([3.0, 1.0])
    rubbing = kl.Robot("rubbing", model, robot.tool)
    ran = kl.simulate(rubbing, [0.0, 0.4], [0.0, 0.0], duration=4.0)
    assert ran.loss[-1] > 1.0 and ran.miss < 1e-6 * ran.loss[-1]
    assert np.all(np.diff(ran.loss) >= -1e-9)
    assert np.all(ran.v[-1] == 0.0)  # it hangs still, held by its friction
    moving = np.abs(ran.v).max(axis=1) > 1e-3
    want = kl.forward_dynamics(
        robot, ran.q, ran.v, -(model.damping * ran.v) - model.friction * np.sign(ran.v))  # fmt: skip
    both = moving & np.all(np.abs(ran.v) > 1e-6, axis=1)
    assert both.sum() > 30
    np.testing.assert_allclose(ran.a[both], want[both], rtol=0, atol=1e-8)


def test_a_planned_motion_comes_back_from_its_torques():
    robot = kl.load("scara")
    motion = kl.motion.joint(
        robot, [[0.0, 0.3, 0.05, 0.0], [0.8, -0.4, 0.15, 1.0]], "spline", acceleration=4
    )

    def torque(t, q, v):
        return kl.inverse_dynamics(robot, *motion.at(min(t, motion.duration)))

    ran = kl.simulate(robot, motion.q[0], None, torque, duration=motion.duration)
    np.testing.assert_allclose(ran.q, motion.at(ran.t)[0], rtol=0, atol=1e-7)


def test_a_wrench_at_the_tool_takes_its_work():
    """The tool pulls with a constant force: its work is force times way, energy is conserved."""
    robot = kl.load("ur5")
    ran = kl.simulate(
        robot, [0.3, -1, 1.2, 0.3, 0.8, 0.2], None, wrench=[5, -3, 2, 0, 0, 0], duration=0.5
    )
    place = kl.fk(robot, ran.q)[:, :3, 3]
    np.testing.assert_allclose(ran.tool_work, (place - place[0]) @ [5, -3, 2], rtol=0, atol=1e-8)
    assert ran.miss < 1e-7
    np.testing.assert_allclose(
        ran.a[7], kl.forward_dynamics(robot, ran.q[7], ran.v[7], ran.tau[7], [5, -3, 2, 0, 0, 0])
    )


def test_a_five_bar_by_the_same_road():
    fivebar = kl.FiveBar((0.3, 0.28), (0.5, 0.52), 0.14, 1.0, 0.15, 0.0075, 0.5, 0.25, 0.0104, 1.0)
    theta = fivebar.ik([0.1, -0.5])
    fall = kl.simulate(fivebar, theta, duration=1.0)
    assert fall.q.shape == (101, 4) and fall.miss < 1e-8
    assert np.abs(fall.q[-1] - fall.q[0]).max() > 0.1
    pushed = kl.simulate(fivebar, theta, [0.1, 0.0], [2.0, -1.0], duration=0.5)
    turned = pushed.q[:, [0, 2]] - pushed.q[0, [0, 2]]
    np.testing.assert_allclose(pushed.work, turned @ [2.0, -1.0], rtol=0, atol=1e-8)
    assert pushed.miss < 1e-8 and pushed.v[0, 0] == pytest.approx(0.1)


@pytest.mark.parametrize(
    ("arguments", "error", "says"),
    [
        ({"q0": [0, 0, 0]}, StateError, "q0"),
        ({"q0": [[0, 0], [0, 0]]}, StateError, "one state"),
        ({"v0": [np.nan, 0]}, StateError, "v0"),
        ({"torque": [1, 2, 3]}, StateError, "torque"),
        ({"torque": lambda t, q, v: [np.nan, 0]}, StateError, r"torque at t = 0"),
        ({"duration": 0.0}, OptionError, "duration"),
        ({"step": -1}, OptionError, "step"),
        ({"wrench": [1, 2, 3]}, StateError, "wrench"),
    ],
)
def test_bad_input(arguments, error, says):
    given = {"q0": [0.1, 0.2], "duration": 0.1} | arguments
    with pytest.raises(error, match=says):
        kl.simulate(kl.load("planar2r"), **given)


def test_an_arm_without_masses_and_a_five_bar_with_a_wrench_are_refused():
    bare = kl.Robot.from_dh(kl.DHTable("bare", "standard", links=[kl.DHLink(a=0.3)]))
    with pytest.raises(InertiaError):
        kl.simulate(bare, [0.0], duration=1.0)
    with pytest.raises(OptionError, match="no wrench"):
        kl.simulate(kl.FiveBar.load("isotropic"), [0, 1], duration=1.0, wrench=[0] * 6)


def test_what_leaves_its_limits_is_said():
    ran = kl.simulate(kl.load("planar2r"), [0.0, 3.1], [0.0, 2.0], duration=0.2)
    first = ran.t[np.argmax(ran.q[:, 1] > np.pi)]
    assert 0 < first < 0.04
    assert f"joint_2 is outside its limits from t = {first:.4g} s on" in str(ran)
