"""The closed form of the five-bar beside Pinocchio's closed chain and MuJoCo's."""

from __future__ import annotations

import mujoco
import numpy as np
import pinocchio as pin
import pytest
from fivebars import random_fivebar, random_state

import kinlab as kl
from kinlab.errors import FileError, InertiaError, OptionError, SingularError, UnreachableError
from kinlab.fivebar.export import loop_sidecar, to_mjcf, to_urdf
from kinlab.fivebar.simulation import forward_dynamics


def relative(found, expected):
    return np.abs(found - expected).max() / max(1.0, np.abs(expected).max())


def test_closed_form_is_the_closed_chain_on_a_thousand_states():
    rng = np.random.default_rng(3)
    worst = dict.fromkeys(
        ("fk", "jacobian", "turn", "torque", "mass", "kinetic", "potential", "forward"), 0.0
    )
    for _ in range(1000):
        fivebar = random_fivebar(rng)
        xy, mode, assembly = random_state(fivebar, rng)
        v, a = rng.uniform(-1, 1, 2), rng.uniform(-10, 10, 2)
        chain = fivebar.closed_chain()
        theta = fivebar.ik(xy, mode)
        q = chain.assemble(theta, assembly)
        qd = chain.joint_rates(q, v)
        qdd = chain.joint_accelerations(q, qd, a)
        torque = fivebar.inverse_dynamics(xy, v, a, mode)
        turn = fivebar.joint_accelerations(xy, v, a, mode)
        energy = chain.energy(q, qd)
        gaps = {
            "fk": np.abs(chain.fk(q) - fivebar.fk(theta, assembly)).max(),
            "jacobian": relative(chain.jacobian(q), fivebar.jacobian(xy, mode)),
            "turn": relative(qdd[[0, 2]], turn),
            "torque": relative(chain.inverse_dynamics(q, qd, qdd), torque),
            "mass": relative(chain.mass_matrix(q), fivebar.mass_matrix(xy, mode)),
            "kinetic": relative(energy[0], fivebar.kinetic_energy(xy, v, mode)),
            "potential": relative(energy[1], fivebar.potential_energy(xy, mode)),
            "forward": relative(forward_dynamics(chain, q, qd, torque)[[0, 2]], turn),
        }
        worst = {name: max(worst[name], gap) for name, gap in gaps.items()}
    limits = {"fk": 1e-12, "jacobian": 1e-12, "turn": 1e-11, "torque": 1e-11, "mass": 1e-12,
              "kinetic": 1e-12, "potential": 1e-12, "forward": 1e-9}  # fmt: skip
    assert {name: gap for name, gap in worst.items() if gap > limits[name]} == {}


def test_free_fall_keeps_its_energy_and_its_loop():
    fivebar = kl.FiveBar((0.3, 0.28), (0.5, 0.52), 0.14, 1.0, 0.15, 0.0075, 0.5, 0.25, 0.0104, 1.0)
    chain = fivebar.closed_chain()
    q = chain.assemble(fivebar.ik([0.1, -0.5]))
    motion = kl.simulate(fivebar, q, duration=3.0, step=1e-3)
    assert len(motion.t) == 3001
    assert np.abs(motion.q[-1] - q).max() > 0.1  # it did move
    assert np.ptp(motion.energy) <= 5e-6
    assert max(np.linalg.norm(chain.closure(x)[0]) for x in motion.q) <= 1e-12
    assert np.isfinite(motion.q).all()


def test_simulation_follows_the_closed_form_torque():
    """Torques of the closed form for a motion, applied to the chain, reproduce the motion."""
    fivebar = kl.FiveBar.load("isotropic")
    chain = fivebar.closed_chain()
    middle, size = np.array([0.0, -0.55]), np.array([0.05, 0.03])

    def motion(t):
        phase = np.array([np.sin(3 * t), np.cos(3 * t) - 1.0])
        speed = 3 * np.array([np.cos(3 * t), -np.sin(3 * t)])
        turn = -9 * np.array([np.sin(3 * t), np.cos(3 * t)])
        return middle + size * phase, size * speed, size * turn

    def torque(t, q, qd):
        return fivebar.inverse_dynamics(*motion(t))

    xy, v, _ = motion(0.0)
    q = chain.assemble(fivebar.ik(xy))
    run = kl.simulate(fivebar, q, chain.joint_rates(q, v), torque, duration=0.5, step=1e-3)
    np.testing.assert_allclose(chain.fk(run.q[-1]), motion(0.5)[0], atol=1e-8)


def test_assembly_keeps_its_branch_near_its_edge():
    """Rods almost in line, unequal legs: Newton must not fall into the other assembly."""
    rng = np.random.default_rng(5)
    for _ in range(150):
        fivebar = random_fivebar(rng)
        xy, mode, assembly = random_state(fivebar, rng, clear=1e-3)
        q = fivebar.closed_chain().assemble(fivebar.ik(xy, mode), assembly)
        assert np.sign(np.sin(q[2] + q[3] - q[0] - q[1])) == assembly
        np.testing.assert_allclose(fivebar.closed_chain().fk(q), xy, atol=1e-9)


def test_chain_errors_have_names():
    fivebar = kl.FiveBar.load("isotropic")
    chain = fivebar.closed_chain()
    apart = kl.FiveBar(0.3, 0.3, 0.2).closed_chain()
    with pytest.raises(UnreachableError, match="stays open by 0.4"):
        apart.assemble([0.0, np.pi])
    with pytest.raises(OptionError, match="assembly 0"):
        chain.assemble([0, 1], 0)
    with pytest.raises(OptionError, match="not in assembly mode"):
        chain.assemble([-0.7, -2.3], 1, guess=[0.0, 0.0])
    stretched = kl.FiveBar(0.09, 0.09, 0.059, rod_mass=1, rod_inertia=1e-3).closed_chain()
    up = np.arccos((0.09 - 0.059) / 0.09)
    q = np.array([up, np.pi - up, np.pi - up, up - np.pi])
    np.testing.assert_allclose(stretched.closure(q)[0], 0.0, atol=1e-15)
    with pytest.raises(SingularError, match="type II"):
        stretched.mass_matrix(q)
    bare = kl.FiveBar(0.3, 0.5, 0.14, crank_mass=1, crank_com=0.1, payload=1).closed_chain()
    q = bare.assemble([-0.8, -2.3])
    with pytest.raises(InertiaError, match="rod without mass"):
        forward_dynamics(bare, q, np.zeros(4), [0, 0])
    with pytest.raises(OptionError, match="step"):
        kl.simulate(fivebar, chain.assemble([-0.8, -2.3]), duration=1.0, step=0.0)


def test_forward_dynamics_exists_at_a_type_two_pose():
    fivebar = kl.FiveBar(0.09, 0.09, 0.059, 0.1, 0.045, 1e-4, 0.1, 0.045, 1e-4, 0.1)
    chain = fivebar.closed_chain()
    up = np.arccos((0.09 - 0.059) / 0.09)
    q = np.array([up, np.pi - up, np.pi - up, up - np.pi])
    qdd = forward_dynamics(chain, q, np.zeros(4), [0.0, 0.0])
    _, rows = chain.closure(q)
    np.testing.assert_allclose(rows @ qdd, 0.0, atol=1e-8 * np.abs(qdd).max())


MODEL = kl.FiveBar(
    (0.3, 0.25), (0.5, 0.45), 0.1, (1, 0.8), (0.15, 0.1), (0.01, 0.008), (0.5, 0.4), (0.2, 0.25),
    (0.02, 0.01), 0.7, 1e-4, (5, 6), (1.0, -9.81), name="tilted",
)  # fmt: skip


def test_mujoco_reads_the_mjcf_and_agrees():
    xy, v, a, mode = np.array([0.1, -0.5]), np.array([0.5, -0.3]), np.array([1.0, 2.0]), (-1, 1)
    model = mujoco.MjModel.from_xml_string(to_mjcf(MODEL, xy, mode))
    data = mujoco.MjData(model)
    chain = MODEL.closed_chain()
    q = chain.assemble(MODEL.ik(xy, mode))
    qd = chain.joint_rates(q, v)
    tau = MODEL.inverse_dynamics(xy, v, a, mode)
    data.qvel[:], data.ctrl[:] = qd, tau
    mujoco.mj_forward(model, data)
    np.testing.assert_allclose(data.site_xpos[0], [*xy, 0.0], atol=1e-15)
    np.testing.assert_allclose(data.site_xpos[1], [*xy, 0.0], atol=1e-15)
    # the tree's own terms are exact: project M qdd + bias through the loop
    qdd = chain.joint_accelerations(q, qd, a)
    product = np.zeros(4)
    mujoco.mj_mulM(model, data, product, qdd)
    tree = product + data.qfrc_bias
    np.testing.assert_allclose(chain.projection(q).T @ tree, tau, rtol=1e-12)
    # its loop is a stiff spring, so the motion agrees to the spring's softness
    np.testing.assert_allclose(data.qacc, qdd, atol=5e-3)
    assert np.abs(MODEL.joint_rates(xy, v, mode) - qd[[0, 2]]).max() < 1e-13


def test_pinocchio_reads_the_mjcf_with_its_loop(tmp_path):
    xy, mode = np.array([0.1, -0.5]), (-1, 1)
    (file,) = MODEL.export(tmp_path / "tilted.xml", xy, mode)
    model, points, frames = pin.buildModelAndConstraintsFromMJCF(str(file))
    assert (model.nq, len(points), len(frames)) == (4, 1, 0)
    data, anchor = model.createData(), points[0].createData()
    zero = np.zeros(4)
    pin.computeJointJacobians(model, data, zero)
    points[0].calc(model, data, anchor)
    assert np.abs(anchor.constraint_position_error).max() < 1e-12
    chain = MODEL.closed_chain()
    q = chain.assemble(MODEL.ik(xy, mode))
    ours = pin.crba(chain.model, chain.model.createData(), q)
    np.testing.assert_allclose(np.triu(pin.crba(model, data, zero)), np.triu(ours), atol=1e-15)


def test_urdf_and_its_sidecar_hold_the_same_tree(tmp_path):
    import tomllib

    files = MODEL.export(tmp_path / "tilted.urdf", [0.1, -0.5])
    assert [f.name for f in files] == ["tilted.urdf", "tilted.loop.toml"]
    model = pin.buildModelFromXML(files[0].read_text(encoding="utf-8"))
    loop = tomllib.loads(files[1].read_text(encoding="utf-8"))
    assert list(model.names)[1:] == ["crank_1", "elbow_1", "crank_2", "elbow_2"]
    for joint, armature in loop["armature"].items():
        model.armature[model.joints[model.getJointId(joint)].idx_v] = armature
    model.gravity.linear = np.array(loop["gravity"])
    q = np.array([loop["closed_pose"][name] for name in list(model.names)[1:]])
    data = model.createData()
    pin.framesForwardKinematics(model, data, q)
    (ends,) = loop["loop"]
    places = [
        data.oMf[model.getFrameId(ends[f"link_{k}"])].act(np.array(ends[f"point_{k}"]))
        for k in (1, 2)
    ]
    np.testing.assert_allclose(places[0], [0.1, -0.5, 0.0], atol=1e-15)
    np.testing.assert_allclose(places[0], places[1], atol=1e-15)
    chain = MODEL.closed_chain()
    v, a = np.random.default_rng(0).uniform(-1, 1, (2, 4))
    np.testing.assert_allclose(
        pin.rnea(model, data, q, v, a),
        pin.rnea(chain.model, chain.model.createData(), q, v, a), atol=1e-14,
    )  # fmt: skip


def test_export_refuses_by_name(tmp_path):
    with pytest.raises(FileError, match="name a .xml file"):
        MODEL.export(tmp_path / "five.obj", [0.1, -0.5])
    with pytest.raises(InertiaError, match="crank 1 has mass 0"):
        to_mjcf(kl.FiveBar(0.3, 0.5, 0.1), [0.0, -0.5])
    with pytest.raises(UnreachableError):
        loop_sidecar(MODEL, [0.0, -2.0])
    assert "<inertial>" not in to_urdf(kl.FiveBar(0.3, 0.5, 0.1))
