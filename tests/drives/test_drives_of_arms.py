"""Drives of any arm: beside Pinocchio with armatures, quadrature of one's own, limits one by one."""

from __future__ import annotations

import numpy as np
import pinocchio as pin
import pytest
from scipy.integrate import quad_vec

import kinlab as kl
from kinlab.drives.gears import Gearbox
from kinlab.drives.motors import Motor, catalogue
from kinlab.errors import MotorError, NameUnknownError, OptionError, StructureError

PUMA = kl.load("puma560")
POINTS = [[0, 0, 0, 0, 0.5, 0], [1, 0.5, -1, 0.3, -0.5, 0.2], [0.4, 1.2, -0.6, -1, 0.2, 1]]
BIG = Motor("big", rated_torque=1.0, peak_torque=300.0, max_speed=30000, rotor_inertia=2e-4)
MOTION = kl.motion.joint(PUMA, POINTS, "trapezoid", acceleration=6, velocity=1.5)


def engine_torque(t):
    """Pinocchio's recursive Newton-Euler at one time: no array function of ours."""
    q, v, a = MOTION.at(t)
    return pin.rnea(PUMA.model, PUMA.model.createData(), q, v, a)


@pytest.mark.parametrize("law", ["trapezoid", "spline"])
def test_rms_torques_are_those_of_adaptive_quadrature(law):
    """scipy's quad_vec from knot to knot, error below 1e-10, beside ours to 1e-6."""
    motion = kl.motion.joint(PUMA, POINTS, law, acceleration=6, velocity=1.5)
    data = PUMA.model.createData()

    def square(t):
        return pin.rnea(PUMA.model, data, *motion.at(t)) ** 2

    area = np.zeros(6)
    for low, high in zip(motion.knots[:-1], motion.knots[1:], strict=True):
        area += quad_vec(square, low + 1e-12, high - 1e-12, epsrel=1e-9)[0]
    ours = kl.size_servos(PUMA, motion, BIG, gear_ratio=50)
    np.testing.assert_allclose(ours.demand.rms_torque, np.sqrt(area / motion.duration), rtol=1e-6)
    assert ours.resolution <= 2e-7


def test_gear_and_rotor_are_those_of_an_armature():
    """At efficiency 1, j times the shaft's torque is rnea with armature j² I_M in the model."""
    sizing = kl.size_servos(PUMA, MOTION, BIG, gear_ratio=80.0, efficiency=1.0)
    model = PUMA.model.copy()
    model.armature = np.full(6, 80.0**2 * 2e-4)
    data = model.createData()
    speed, torque = sizing.at_shafts()
    demand = sizing.demand
    for k in range(0, len(demand.t), 97):
        tau = pin.rnea(model, data, demand.q[k], demand.v[k], demand.a[k])
        np.testing.assert_allclose(80.0 * torque[k], tau, rtol=0, atol=1e-9)
    np.testing.assert_allclose(speed, demand.v * 80.0 * 30 / np.pi)
    for joint, (fit,) in enumerate(sizing.fits):
        assert fit.peak == pytest.approx(np.abs(torque[:, joint]).max(), rel=1e-9)
        assert fit.rms == pytest.approx(
            np.sqrt(np.trapezoid(torque[:, joint] ** 2, demand.t) / MOTION.duration), rel=1e-6
        )
        least = [
            pin.crba(PUMA.model, PUMA.model.createData(), q)[joint, joint] for q in demand.q[::97]
        ]
        most = max(least) - PUMA.model.armature[joint]
        assert fit.inertia_ratio == pytest.approx(most / (80.0**2 * 2e-4), rel=1e-3)


def test_friction_is_part_of_what_is_asked():
    robot = kl.load("planar2r")
    motion = kl.motion.joint(robot, [[0.4, 0.9], [1.0, 1.8]], acceleration=8)
    plain = kl.size_servos(robot, motion, BIG, gear_ratio=10).demand
    model = robot.model.copy()
    model.damping, model.friction = np.array([0.3, 0.2]), np.array([1.5, 0.5])
    rubbing = kl.Robot("rubbing", model, robot.tool)
    loaded = kl.size_servos(rubbing, motion, BIG, gear_ratio=10).demand
    extra = np.array([0.3, 0.2]) * plain.v + np.array([1.5, 0.5]) * np.sign(plain.v)
    assert np.array_equal(loaded.t, plain.t)
    np.testing.assert_allclose(loaded.tau, plain.tau + extra, rtol=0, atol=1e-12)
    assert np.abs(extra).min(axis=0).max() > 0.4  # both joints move all the way


def test_a_wrench_at_the_tool_is_held():
    held = kl.size_servos(PUMA, MOTION, BIG, gear_ratio=50, wrench=[0, 0, 20, 0, 0, 0]).demand
    q, v, a = (x[5] for x in (held.q, held.v, held.a))
    np.testing.assert_allclose(
        held.tau[5], kl.inverse_dynamics(PUMA, q, v, a, [0, 0, 20, 0, 0, 0]), atol=1e-9
    )


def test_each_limit_fails_by_name_and_the_catalogue_gives_drives():
    weak = Motor("weak", rated_torque=1e-3, peak_torque=2e-3, max_speed=100, rotor_inertia=1e-7)
    sizing = kl.size_servos(PUMA, MOTION, weak, gear_ratio=50)
    assert sizing.chosen == (None,) * 6
    failed = {limit.name for fits in sizing.fits for limit in fits[0].failed}
    assert failed == {"max speed", "peak torque", "rated torque"}
    assert "none fits; nearest weak" in str(sizing)
    shipped = kl.size_servos(PUMA, MOTION)
    assert all(len(fits) == len(catalogue()) for fits in shipped.fits)
    assert any(fit is not None for fit in shipped.chosen)
    box = Gearbox(
        "box", 60.0, 0.85, inertia=1e-5, nominal_torque=500, peak_torque=900, max_speed=9000
    )
    bought = kl.size_servos(PUMA, MOTION, [BIG, weak], gears=[box])
    assert {fit.gear for fits in bought.fits for fit in fits} == {box}
    assert bought.fits[0][0].motor.name == "big" and len(bought.fits[0]) == 2


@pytest.mark.parametrize(
    ("arguments", "error", "says"),
    [
        ({"motion": None}, StructureError, "kl.motion.joint"),
        ({"motion": kl.motion.joint(kl.load("planar2r"), [[0, 1], [1, 1]], acceleration=1)}, StructureError, "6 joints"),
        ({"efficiency": 1.2}, OptionError, "efficiency"),
        ({"gear_ratio": 0}, OptionError, "gear_ratio"),
        ({"motors": []}, OptionError, "motors"),
        ({"motors": [3]}, OptionError, "motors: give"),
        ({"motors": "SGMAH-00"}, NameUnknownError, "SGMAH"),
        ({"motors": Motor("bare")}, MotorError, "states no"),
        ({"gears": [], "motors": BIG}, OptionError, "gears"),
    ],
)  # fmt: skip
def test_bad_input(arguments, error, says):
    given = {"motion": MOTION} | arguments
    with pytest.raises(error, match=says):
        kl.size_servos(PUMA, **given)
