"""The thin layer over Pinocchio: frames, shapes, identities, input."""

from __future__ import annotations

import math

import numpy as np
import pytest

import kinlab as kl
from kinlab.errors import NameUnknownError, StateError

NAMES = ["planar2r", "spatial3r", "scara", "stanford", "puma560", "panda", "single_link"]


@pytest.fixture(params=NAMES)
def robot(request):
    return kl.load(request.param)


def states(robot, count=6, rows=3):
    return np.random.default_rng(7).uniform(-2.0, 2.0, (rows, count, robot.n))


def twist(robot, q, v, h=1e-6):
    """Tool twist by central differences of the pose, base axes at the tool origin."""
    before, after = kl.fk(robot, q - h * v), kl.fk(robot, q + h * v)
    here = kl.fk(robot, q)
    linear = (after[:3, 3] - before[:3, 3]) / (2 * h)
    spin = (after[:3, :3] - before[:3, :3]) / (2 * h) @ here[:3, :3].T
    return np.array([*linear, spin[2, 1], spin[0, 2], spin[1, 0]])


def test_base_jacobian_is_the_derivative_of_the_pose(robot):
    for q in states(robot)[0]:
        jac = kl.jacobian(robot, q)
        for i, unit in enumerate(np.eye(robot.n)):
            assert jac[:, i] == pytest.approx(twist(robot, q, unit), abs=2e-9)


def test_the_three_frames_are_the_textbook_ones(robot):
    for q in states(robot)[0]:
        pose, jac = kl.fk(robot, q), kl.jacobian(robot, q, "base")
        turn = np.kron(np.eye(2), pose[:3, :3])
        assert kl.jacobian(robot, q, "tool") == pytest.approx(turn.T @ jac, abs=1e-12)
        spatial = jac.copy()  # the point of the tool body that is at the base origin
        spatial[:3] += np.cross(pose[:3, 3], jac[3:].T).T
        assert kl.jacobian(robot, q, "spatial") == pytest.approx(spatial, abs=1e-12)


@pytest.mark.parametrize("frame", ["base", "tool", "spatial"])
def test_jacobian_dot_is_the_derivative_along_the_motion(robot, frame):
    h = 1e-6
    for q, v in zip(*states(robot, rows=2), strict=True):
        ahead, behind = (kl.jacobian(robot, q + s * h * v, frame) for s in (1, -1))
        expected = (ahead - behind) / (2 * h)
        assert kl.jacobian_dot(robot, q, v, frame) == pytest.approx(expected, abs=5e-9)


@pytest.mark.parametrize("frame", ["base", "tool", "spatial"])
def test_statics_is_virtual_work(robot, frame):
    wrench = np.array([1.0, -2.0, 3.0, 0.4, 0.5, -0.6])
    for q, v in zip(*states(robot, rows=2), strict=True):
        power = wrench @ kl.jacobian(robot, q, frame) @ v
        assert kl.statics(robot, q, wrench, frame) @ v == pytest.approx(power, abs=1e-10)


def test_wrench_on_the_tool_enters_the_dynamics(robot):
    wrench = np.array([1.0, -2.0, 3.0, 0.4, 0.5, -0.6])
    for q, v, a in zip(*states(robot), strict=True):
        tau = kl.inverse_dynamics(robot, q, v, a, wrench)
        free = kl.inverse_dynamics(robot, q, v, a)
        assert tau - free == pytest.approx(kl.jacobian(robot, q).T @ wrench, abs=1e-10)
        assert kl.forward_dynamics(robot, q, v, tau, wrench) == pytest.approx(a, abs=1e-7)


def test_equation_of_motion(robot):
    for q, v, a in zip(*states(robot), strict=True):
        mass, coriolis = kl.mass_matrix(robot, q), kl.coriolis_matrix(robot, q, v)
        tau = mass @ a + coriolis @ v + kl.gravity_torques(robot, q)
        assert kl.inverse_dynamics(robot, q, v, a) == pytest.approx(tau, rel=1e-10, abs=1e-9)
        assert kl.forward_dynamics(robot, q, v, tau) == pytest.approx(a, abs=1e-8)
        assert np.array_equal(mass, mass.T)
        assert np.linalg.eigvalsh(mass)[0] > 0


def test_mdot_minus_2c_is_skew(robot):
    h = 1e-6
    for q, v in zip(*states(robot, rows=2), strict=True):
        ahead, behind = kl.mass_matrix(robot, q + h * v), kl.mass_matrix(robot, q - h * v)
        s = (ahead - behind) / (2 * h) - 2 * kl.coriolis_matrix(robot, q, v)
        assert s + s.T == pytest.approx(np.zeros_like(s), abs=2e-8 * max(1, np.abs(ahead).max()))


def test_energies_and_power(robot):
    h = 1e-6
    for q, v, a in zip(*states(robot), strict=True):
        mass = kl.mass_matrix(robot, q)
        assert kl.kinetic_energy(robot, q, v) == pytest.approx(0.5 * v @ mass @ v, rel=1e-12)
        gradient = [
            (kl.potential_energy(robot, q + h * e) - kl.potential_energy(robot, q - h * e))
            / (2 * h)
            for e in np.eye(robot.n)
        ]
        assert kl.gravity_torques(robot, q) == pytest.approx(gradient, abs=1e-6)

        def energy(t, q=q, v=v, a=a):
            qt, vt = q + t * v + 0.5 * t * t * a, v + t * a
            return kl.kinetic_energy(robot, qt, vt) + kl.potential_energy(robot, qt)

        power = (energy(h) - energy(-h)) / (2 * h)
        assert kl.inverse_dynamics(robot, q, v, a) @ v == pytest.approx(power, abs=1e-5)


CALLS = {
    "fk": (1, (4, 4)), "jacobian": (1, (6, -1)), "jacobian_dot": (2, (6, -1)),
    "mass_matrix": (1, (-1, -1)), "coriolis_matrix": (2, (-1, -1)), "gravity_torques": (1, (-1,)),
    "inverse_dynamics": (3, (-1,)), "forward_dynamics": (3, (-1,)), "kinetic_energy": (2, ()),
    "potential_energy": (1, ()),
}  # fmt: skip


@pytest.mark.parametrize("name", CALLS)
def test_one_state_or_many(robot, name):
    count, shape = CALLS[name]
    shape = tuple(robot.n if k == -1 else k for k in shape)
    call = getattr(kl, name)
    stacks = states(robot)[:count]
    many = call(robot, *stacks)
    assert many.shape == (6, *shape)
    for k in range(6):
        one = call(robot, *stacks[:, k])
        assert np.shape(one) == shape
        assert many[k] == pytest.approx(np.asarray(one), rel=1e-12, abs=1e-12)
    assert call(robot, *stacks[:, :0]).shape == (0, *shape)
    integers = [np.zeros(robot.n, dtype=int)] * count
    assert np.array_equal(call(robot, *integers), call(robot, *np.zeros((count, robot.n))))


@pytest.mark.parametrize("name", CALLS)
@pytest.mark.parametrize("bad", [math.nan, math.inf, -math.inf])
def test_nan_in_is_an_error(name, bad):
    robot = kl.load("scara")
    count = CALLS[name][0]
    for place in range(count):
        for shape in ((4,), (3, 4)):
            values = [np.full(shape, 0.1) for _ in range(count)]
            values[place][..., 2] = bad
            with pytest.raises(StateError, match=r"every entry must be finite"):
                getattr(kl, name)(robot, *values)


def test_answers_are_copies():
    robot = kl.load("scara")
    q = np.array([0.1, 0.2, 0.05, 0.3])
    for name, (count, _) in CALLS.items():
        first = getattr(kl, name)(robot, *[q] * count)
        before = np.array(first)
        getattr(kl, name)(robot, *[2 * q] * count)
        assert np.array_equal(first, before), name


def test_bad_calls():
    robot = kl.load("scara")
    with pytest.raises(StateError, match=r"robot 'scara': q has shape \(3,\); expected \(4,\) or"):
        kl.fk(robot, [0, 0, 0])
    with pytest.raises(
        NameUnknownError, match="frame 'world' is unknown; choose one of 'base', 'tool'"
    ):
        kl.jacobian(robot, np.zeros(4), "world")
    with pytest.raises(NameUnknownError, match="frame 'tol' is unknown; did you mean 'tool'"):
        kl.jacobian(robot, np.zeros(4), "tol")
    with pytest.raises(StateError, match="stacks of different length: q"):
        kl.inverse_dynamics(robot, np.zeros((2, 4)), np.zeros((3, 4)), np.zeros(4))
    with pytest.raises(StateError, match=r"wrench has shape \(3,\); expected \(6,\)"):
        kl.statics(robot, np.zeros(4), [1, 2, 3])
    with pytest.raises(StateError, match="different length"):
        kl.statics(robot, np.zeros((2, 4)), np.zeros((3, 6)))
