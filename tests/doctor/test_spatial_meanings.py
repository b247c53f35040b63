"""Twists, wrenches, adjoints and spatial inertias against Pinocchio's own, and the ways they are typed."""

from __future__ import annotations

import numpy as np
import pinocchio as pin
import pytest
from test_meaning import general_table

import kinlab as kl
from kinlab.doctor.glossary.meaning import meaning_of
from kinlab.doctor.glossary.textbook import meanings

LINEAR_FIRST = [3, 4, 5, 0, 1, 2]


@pytest.fixture(params=range(4), ids=lambda k: f"arm {k}")
def arm(request):
    rng = np.random.default_rng(request.param)
    convention = ("standard", "modified")[request.param % 2]
    kinds = ("RRRR", "RPRR", "PRRP", "RRPR")[request.param]
    robot = kl.Robot.from_dh(general_table(4, convention, kinds))
    states = [dict(zip("qva", rng.uniform(-2, 2, (3, 4)), strict=True)) for _ in range(2)]
    return robot, states, [meanings(robot, state) for state in states]


def world(robot, state):
    """Pinocchio's motions, forces and inertias, moved to the world's origin; linear part first."""
    model, data = robot.model, robot.model.createData()
    model = model.copy()
    model.armature[:] = 0
    pin.rnea(model, data, state["q"], state["v"], state["a"])
    pin.forwardKinematics(model, data, state["q"], state["v"], state["a"])
    joints = range(1, model.njoints)
    twists = [data.oMi[k].act(data.v[k]).vector for k in joints]
    rates = [data.oMi[k].act(data.a[k]).vector for k in joints]
    wrenches = [data.oMi[k].act(data.f[k]).vector for k in joints]
    inertias = [data.oMi[k].act(model.inertias[k]).matrix() for k in joints]
    return twists, rates, wrenches, inertias, data.oMi[1:]


@pytest.mark.parametrize("first", ["linear", "angular"])
def test_twists_and_wrenches_are_pinocchios(arm, first) -> None:
    robot, states, known = arm
    order = LINEAR_FIRST if first == "angular" else slice(None)
    every = [world(robot, state) for state in states]
    for k in range(1, 5):
        for which, what in enumerate(("V", "dV", "wrench")):
            sense = meaning_of(known, [one[which][k - 1][order] for one in every])
            assert sense is not None and (sense.what, sense.frame) == (what, "base")
            assert sense.number == k
        tensors = [one[3][k - 1][order][:, order] for one in every]
        sense = meaning_of(known, tensors)
        assert sense is not None and (sense.what, sense.number) == ("spatial_inertia", k)


def test_a_matrix_of_six_is_an_adjoint(arm) -> None:
    robot, states, known = arm
    frames = [robot.table.frames(state["q"]) for state in states]
    for k in range(2, 5):
        steps = [pin.SE3(np.linalg.inv(one[k - 2]) @ one[k - 1]) for one in frames]
        for order in (slice(None), LINEAR_FIRST):
            there = [one.toActionMatrix()[order][:, order] for one in steps]
            back = [one.toActionMatrixInverse()[order][:, order] for one in steps]
            for what, some in (("adjoint", there), ("adjoint_inverse", back)):
                sense = meaning_of(known, some)
                assert sense is not None and (sense.what, sense.number) == (what, k)
                # what carries wrenches, moments first, carries twists with these last
                sense = meaning_of(known, [one.T for one in some])
                assert sense is not None and sense.what in ("adjoint", "adjoint_inverse")


def test_screws_are_the_columns_of_the_spatial_jacobian(arm) -> None:
    robot, states, known = arm
    columns = [kl.jacobian(robot, state["q"], frame="spatial").T for state in states]
    for k in range(2, 5):
        sense = meaning_of(known, [one[k - 1][LINEAR_FIRST] for one in columns])
        assert sense is not None and (sense.what, sense.number) == ("screw", k)


def test_exponentials_multiply_to_the_frames(arm) -> None:
    robot, states, known = arm
    at_home = robot.table.frames(np.zeros(4))
    screws = [kl.jacobian(robot, np.zeros(4), frame="spatial")[:, k] for k in range(4)]
    product = [np.eye(4) for _state in states]
    for k, screw in enumerate(screws):
        steps = [pin.exp6(screw * state["q"][k]).homogeneous for state in states]
        product = [one @ step for one, step in zip(product, steps, strict=True)]
        for state, one in zip(states, product, strict=True):
            assert np.allclose(one @ at_home[k], robot.table.frames(state["q"])[k])
        if k:
            assert meaning_of(known, steps).what == "exponential"
            assert meaning_of(known, product).what == "exponentials"
