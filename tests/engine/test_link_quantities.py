"""Links, joint wrenches, dM/dq and Lagrange's terms beside independent computations."""

from __future__ import annotations

import numpy as np
import pytest
from random_tables import random_table

import kinlab as kl
from kinlab.check.table_check import table_rows
from kinlab.errors import InertiaError, StateError

ROBOTS = [
    kl.Robot.from_dh(random_table(seed, n, convention))
    for seed, (n, convention) in enumerate(
        [(1, "standard"), (2, "modified"), (4, "standard"), (6, "modified"), (8, "standard")]
    )
]


def state(robot, seed=0, count=4):
    rng = np.random.default_rng(seed)
    return (rng.standard_normal((count, robot.n)) for _ in range(3))


def slope(function, q, step=1e-3):
    """dF/dq by central differences of order 4, last axis."""
    columns = []
    for unit in np.eye(len(q)):
        near = function(q + step * unit) - function(q - step * unit)
        far = function(q + 2 * step * unit) - function(q - 2 * step * unit)
        columns.append((8.0 * near - far) / (12.0 * step))
    return np.stack(columns, axis=-1)


@pytest.fixture(params=ROBOTS, ids=lambda r: f"n{r.n}")
def robot(request):
    return request.param


def test_table_checks_hold_on_random_tables(robot):
    """Hand FK, J, M, tau beside both engines, prismatic and flipped joints included."""
    for row in table_rows(robot, samples=10):
        assert row.corrected.agrees, (row.formula.key, row.corrected.max_error)


def test_shapes_of_one_state_and_of_a_stack(robot):
    q, v, a = state(robot)
    n = robot.n
    for function, arguments, shape in [
        (kl.link_poses, (q,), (n, 4, 4)), (kl.link_velocities, (q, v), (n, 6)),
        (kl.link_accelerations, (q, v, a), (n, 6)), (kl.com_positions, (q,), (n, 3)),
        (kl.com_jacobians, (q,), (n, 6, n)), (kl.com_accelerations, (q, v, a), (n, 3)),
        (kl.joint_wrenches, (q, v, a), (n, 6)), (kl.inertial_wrenches, (q, v, a), (n, 6)),
        (kl.link_kinetic_energies, (q, v), (n,)), (kl.link_potential_energies, (q,), (n,)),
        (kl.christoffel, (q,), (n, n, n)), (kl.mass_matrix_derivatives, (q,), (n, n, n)),
        (kl.mass_matrix_dot, (q, v), (n, n)), (kl.centrifugal_coefficients, (q,), (n, n)),
        (kl.coriolis_coefficients, (q,), (n, n * (n - 1) // 2)), (kl.momentum, (q, v), (n,)),
        (kl.momentum_rate, (q, v, a), (n,)), (kl.lagrangian_gradient, (q, v), (n,)),
        (kl.lagrange_torques, (q, v, a), (n,)), (kl.lagrangian, (q, v), ()),
    ]:  # fmt: skip
        stack = np.asarray(function(robot, *arguments))
        assert stack.shape == (len(q), *shape), function.__name__
        one = np.asarray(function(robot, *(x[1] for x in arguments)))
        assert one.shape == shape and np.array_equal(one, stack[1]), function.__name__
        empty = np.asarray(function(robot, *(x[:0] for x in arguments)))
        assert empty.shape == (0, *shape), function.__name__


def test_mass_matrix_derivatives_are_those_of_the_mass_matrix(robot):
    q = next(state(robot))[0]
    found = kl.mass_matrix_derivatives(robot, q)
    assert found == pytest.approx(slope(lambda x: kl.mass_matrix(robot, x), q), abs=1e-8)
    assert found == pytest.approx(np.swapaxes(found, 0, 1), abs=1e-12)


def test_christoffel_comes_from_the_derivatives(robot):
    q, v, _ = state(robot)
    d = kl.mass_matrix_derivatives(robot, q[0])
    stated = 0.5 * (d + np.swapaxes(d, 1, 2) - np.moveaxis(d, -1, 0))
    symbols = kl.christoffel(robot, q[0])
    assert symbols == pytest.approx(stated, abs=1e-11)
    still = np.zeros(robot.n)
    torque = kl.inverse_dynamics(robot, q[0], v[0], still) - kl.gravity_torques(robot, q[0])
    assert np.einsum("ijk,j,k->i", symbols, v[0], v[0]) == pytest.approx(torque, abs=1e-10)


def test_mvg_split_puts_the_velocity_torques_together(robot):
    q, v, _ = (x[0] for x in state(robot))
    j, k = np.triu_indices(robot.n, 1)
    torque = kl.coriolis_coefficients(robot, q) @ (v[j] * v[k])
    torque = torque + kl.centrifugal_coefficients(robot, q) @ v**2
    assert torque == pytest.approx(kl.coriolis_matrix(robot, q, v) @ v, abs=1e-10)


def test_lagrange_equation_gives_the_torques(robot):
    q, v, a = state(robot)
    found = kl.lagrange_torques(robot, q, v, a)
    assert found == pytest.approx(kl.inverse_dynamics(robot, q, v, a), abs=1e-9)
    gradient = slope(lambda x: np.array(kl.lagrangian(robot, x, v[0])), q[0])
    assert kl.lagrangian_gradient(robot, q[0], v[0]) == pytest.approx(gradient, abs=1e-8)
    momentum = slope(lambda x: np.array(kl.lagrangian(robot, q[0], x)), v[0])
    assert kl.momentum(robot, q[0], v[0]) == pytest.approx(momentum, abs=1e-8)


def test_link_motion_is_the_rate_of_the_link_poses(robot):
    q, v, a = (x[0] for x in state(robot))
    motion, rate = kl.link_velocities(robot, q, v), slope(lambda x: kl.link_poses(robot, x), q) @ v
    turned = kl.link_poses(robot, q)[:, :3, :3]
    assert np.einsum("iab,ib->ia", turned, motion[:, :3]) == pytest.approx(rate[:, :3, 3], abs=1e-9)
    spin = np.swapaxes(turned, 1, 2) @ rate[:, :3, :3]
    assert motion[:, 3:] == pytest.approx(
        np.stack([spin[:, 2, 1], spin[:, 0, 2], spin[:, 1, 0]], axis=1), abs=1e-9
    )

    def in_base(t):
        here = q + v * t + 0.5 * a * t**2
        turned = kl.link_poses(robot, here)[:, :3, :3]
        moving = kl.link_velocities(robot, here, v + a * t)
        return np.einsum("iab,ikb->ika", turned, moving.reshape(-1, 2, 3))

    h = 1e-4
    rates = (8 * (in_base(h) - in_base(-h)) - (in_base(2 * h) - in_base(-2 * h))) / (12 * h)
    found = kl.link_accelerations(robot, q, v, a).reshape(-1, 2, 3)
    assert np.einsum("iab,ikb->ika", turned, found) == pytest.approx(rates, abs=1e-7)


def test_centres_move_as_their_jacobians_say(robot):
    q = next(state(robot))[0]
    found = kl.com_jacobians(robot, q)[:, :3]
    assert found == pytest.approx(slope(lambda x: kl.com_positions(robot, x), q), abs=1e-9)


def test_joint_wrenches_hold_the_torques(robot):
    q, v, a = state(robot)
    load = np.random.default_rng(5).standard_normal((len(q), 6))
    tau = kl.inverse_dynamics(robot, q, v, a, load) - robot.model.armature * a
    along = [2 if link.joint == "prismatic" else 5 for link in robot.table.links]
    sign = [-1.0 if link.flip else 1.0 for link in robot.table.links]
    wrenches = kl.joint_wrenches(robot, q, v, a, load)
    assert wrenches[:, range(robot.n), along] * sign == pytest.approx(tau, abs=1e-10)


def test_first_joint_carries_the_whole_arm(robot):
    """The force through joint 1 of an arm at rest is its whole weight, in base axes."""
    q = next(state(robot))[0]
    still = np.zeros(robot.n)
    force = kl.link_poses(robot, q)[0, :3, :3] @ kl.joint_wrenches(robot, q, still, still)[0, :3]
    mass = sum(link.mass for link in robot.table.links)
    assert force == pytest.approx(-mass * np.asarray(robot.table.gravity), abs=1e-9)


def test_static_wrenches_are_the_load_moved(robot):
    q = next(state(robot))[0]
    load = np.arange(1.0, 7.0)
    poses, tip = kl.link_poses(robot, q), kl.fk(robot, q)[:3, 3]
    for pose, wrench in zip(poses, kl.static_wrenches(robot, q, load), strict=True):
        moment = load[3:] + np.cross(tip - pose[:3, 3], load[:3])
        assert pose[:3, :3] @ wrench[:3] == pytest.approx(load[:3], abs=1e-9)
        assert pose[:3, :3] @ wrench[3:] == pytest.approx(moment, abs=1e-9)


def test_link_energies_add_up(robot):
    q, v, _ = state(robot)
    rotors = 0.5 * np.sum(robot.model.armature * v**2, axis=1)
    kinetic = kl.link_kinetic_energies(robot, q, v).sum(axis=1) + rotors
    assert kinetic == pytest.approx(kl.kinetic_energy(robot, q, v), abs=1e-10)
    potential = kl.link_potential_energies(robot, q).sum(axis=1)
    assert potential == pytest.approx(kl.potential_energy(robot, q), abs=1e-10)


def test_a_table_whose_urdf_is_another_arm_fails_where_it_differs():
    """The standard-DH trap: inertia left in the far frame changes M and tau, and no pose."""
    table = kl.load("puma560").table
    text = kl.to_urdf(table).replace('<mass value="17.4"', '<mass value="18.0"')
    other = kl.Robot.from_urdf(text, tool=table.tool_name)
    mixed = kl.Robot(table.name, other.model, other.tool, text, table)
    found = {row.formula.part: row.ok for row in table_rows(mixed, samples=10)}
    assert found["fk"] and found["fk, yourdfpy"] and found["J"] and found["M > 0"]
    assert not found["M"] and not found["tau"] and not found["M a + C v + g"]


def test_action_of_a_motion_at_constant_speed():
    """One link turning at constant speed through whole turns: S = ½ I w² T, V averages out."""
    robot = kl.load("single_link")
    nodes, weights = np.polynomial.legendre.leggauss(40)
    duration, speed = 2.0, np.pi
    t = 0.5 * duration * (nodes + 1.0)
    inertia = 2.5 * 0.6**2 / 3.0
    found = kl.action(robot, speed * t[:, None], np.full((40, 1), speed), 0.5 * duration * weights)
    assert found == pytest.approx(0.5 * inertia * speed**2 * duration, rel=1e-12)


def test_bad_input_is_told():
    robot = kl.load("planar2r")
    q = np.zeros(2)
    with pytest.raises(StateError, match=r"q has shape \(3,\)"):
        kl.link_poses(robot, np.zeros(3))
    with pytest.raises(StateError, match="nan"):
        kl.christoffel(robot, [0.0, np.nan])
    with pytest.raises(StateError, match=r"wrench has shape \(3,\)"):
        kl.joint_wrenches(robot, q, q, q, np.zeros(3))
    with pytest.raises(StateError, match="different length"):
        kl.static_wrenches(robot, np.zeros((3, 2)), np.zeros((2, 6)))
    with pytest.raises(StateError, match="expected one for each of the states"):
        kl.action(robot, np.zeros((3, 2)), np.zeros((3, 2)), np.ones(4))
    light = kl.Robot.from_dh(kl.DHTable("light", "modified", [kl.DHLink(a=0.4)]))
    with pytest.raises(InertiaError, match="light"):
        kl.christoffel(light, [0.1])
    with pytest.raises(InertiaError, match="light"):
        kl.joint_wrenches(light, [0.1], [0.1], [0.1])
    assert kl.static_wrenches(light, [0.1], np.ones(6)).shape == (1, 6)
