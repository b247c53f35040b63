"""Stacks of states: the same answers as one call a state, whatever the road and the threads."""

from __future__ import annotations

import math
import sys
from concurrent.futures import ThreadPoolExecutor

import numpy as np
import pytest
from random_tables import random_table

import kinlab as kl
from kinlab.engine.fast import stacks as fast_road
from kinlab.engine.fast import threads
from kinlab.errors import OptionError, StateError

FUNCTIONS = {
    "fk": (kl.fk, 1),
    "jacobian": (kl.jacobian, 1),
    "jacobian, tool": (lambda robot, q: kl.jacobian(robot, q, "tool"), 1),
    "jacobian, spatial": (lambda robot, q: kl.jacobian(robot, q, "spatial"), 1),
    "jacobian_dot": (kl.jacobian_dot, 2),
    "mass_matrix": (kl.mass_matrix, 1),
    "coriolis_matrix": (kl.coriolis_matrix, 2),
    "gravity_torques": (kl.gravity_torques, 1),
    "inverse_dynamics": (kl.inverse_dynamics, 3),
    "forward_dynamics": (kl.forward_dynamics, 3),
    "kinetic_energy": (kl.kinetic_energy, 2),
    "potential_energy": (kl.potential_energy, 1),
}
NAMED = ["puma560", "panda", "stanford", "planar2r", "single_link", "erd:ur5"]
LARGE = fast_road.COMPILED_FROM


def arms():
    for name in NAMED:
        yield kl.load(name)
    for seed in range(6):
        n, convention = 1 + 2 * seed, ("standard", "modified")[seed % 2]
        yield kl.Robot.from_dh(random_table(seed, n, convention))


def behind_the_tool():
    """Panda with its tool on link 4: three joints lie behind it."""
    model = kl.load("panda").model
    return kl.Robot.from_model(model, str(next(f.name for f in model.frames if f.parentJoint == 4)))


ARMS = [*arms(), behind_the_tool()]


@pytest.fixture(params=ARMS, ids=lambda robot: f"{robot.name}-{robot.n}")
def robot(request):
    return request.param


def stacks(robot, count, rows=3, seed=3):
    return np.random.default_rng(seed).uniform(-2.5, 2.5, (rows, count, robot.n))


@pytest.mark.parametrize("name", FUNCTIONS)
def test_a_stack_is_its_single_calls(robot, name):
    function, inputs = FUNCTIONS[name]
    large = stacks(robot, LARGE)[:inputs]
    singles = np.stack([np.asarray(function(robot, *row)) for row in zip(*large, strict=True)])
    for count in (0, 1, 2, LARGE - 1, LARGE):
        answer = function(robot, *(stack[:count] for stack in large))
        assert answer.shape == (count, *singles.shape[1:])
        scale = np.abs(singles[:count]).max(initial=1.0)
        # ABA solves with M: its rounding grows with the condition of M
        limit = 1e-10 if name == "forward_dynamics" else 1e-12
        assert np.abs(answer - singles[:count]).max(initial=0.0) <= limit * scale


@pytest.mark.parametrize("name", FUNCTIONS)
def test_the_number_of_threads_changes_no_bit(name, monkeypatch):
    robot = kl.load("puma560")
    function, inputs = FUNCTIONS[name]
    arguments = stacks(robot, 8192)[:inputs]
    with threads.one_thread():
        alone = function(robot, *arguments)
    monkeypatch.setenv(threads.VARIABLE, "3")
    assert np.array_equal(function(robot, *arguments), alone)


def test_fifty_joints():
    robot = kl.Robot.from_dh(random_table(11, 50, "standard"))
    q, v = stacks(robot, LARGE, rows=2)
    for function, arguments in ((kl.mass_matrix, (q,)), (kl.coriolis_matrix, (q, v))):
        answer = function(robot, *arguments)[:20]
        singles = np.stack([function(robot, *(a[i] for a in arguments)) for i in range(20)])
        assert np.abs(answer - singles).max() <= 1e-12 * np.abs(singles).max()


def test_mass_matrices_keep_the_digits_of_a_light_hand_far_out():
    """M_nn of a gram at the end of 40 m of arm, relative to itself."""
    links = [
        kl.DHLink("revolute", a=10.0, mass=100.0, com=(-5, 0, 0), inertia=np.eye(3))
        for _ in range(4)
    ]
    links.append(kl.DHLink("revolute", alpha=0.3, mass=1e-3, inertia=1e-7 * np.eye(3)))
    robot = kl.Robot.from_dh(kl.DHTable("long", "standard", links))
    q = stacks(robot, LARGE)[0]
    assert kl.mass_matrix(robot, q)[:, 4, 4] == pytest.approx(1e-7, rel=1e-12)


@pytest.mark.parametrize("rows", [(0, 1, 2, 3, 4, 5), (0, 1, 2), (0, 1, 5), (3,)])
def test_singular_values_are_those_of_the_single_jacobians(robot, rows):
    q = stacks(robot, LARGE)[0]
    got = fast_road.singular_values(robot, q, np.array(rows))
    for i in range(0, LARGE, 16):
        part = kl.jacobian(robot, q[i])[list(rows)]
        expected = np.linalg.svd(part, compute_uv=False)
        assert got[i] == pytest.approx(expected, abs=1e-12 * max(1.0, expected[0]))


def test_a_single_vector_beside_stacks_is_repeated():
    robot = kl.load("puma560")
    q, v, a = stacks(robot, 40)
    repeated = kl.inverse_dynamics(robot, q, np.tile(v[0], (40, 1)), a)
    assert np.array_equal(kl.inverse_dynamics(robot, q, v[0], a), repeated)
    with pytest.raises(StateError, match=r"different length: q \(40, 6\), v \(39, 6\)"):
        kl.inverse_dynamics(robot, q, v[:39], a)


@pytest.mark.parametrize("count", [7, LARGE])
def test_stacks_in_any_memory_order(count):
    robot = kl.load("puma560")
    q, v, a = stacks(robot, count)
    expected = kl.inverse_dynamics(robot, q, v, a), kl.mass_matrix(robot, q)
    wide = np.zeros((count, 12))
    wide[:, ::2] = q
    shut = q.copy()
    shut.flags.writeable = False
    for other in (np.asfortranarray(q), wide[:, ::2], shut, q.astype(np.longdouble), q.tolist()):
        assert np.array_equal(kl.inverse_dynamics(robot, other, v, a), expected[0])
        assert np.array_equal(kl.mass_matrix(robot, other), expected[1])


@pytest.mark.parametrize("bad", [math.nan, math.inf, -math.inf])
@pytest.mark.parametrize("name", FUNCTIONS)
def test_no_number_that_is_none_gets_through(robot, name, bad):
    """Every entry of every input, single and stacked: an error that names input and index."""
    function, inputs = FUNCTIONS[name]
    names = ("q", "v", "tau" if name == "forward_dynamics" else "a")
    sound = stacks(robot, 3)[:inputs]
    for which in range(inputs):
        for joint in range(robot.n):
            one = [stack[0].copy() for stack in sound]
            one[which][joint] = bad
            with pytest.raises(StateError, match=rf"{names[which]}: -?(nan|inf) at index {joint};"):
                function(robot, *one)
            many = [stack.copy() for stack in sound]
            many[which][1, joint] = bad
            with pytest.raises(StateError, match=rf"{names[which]}: -?(nan|inf) at index \(1, "):
                function(robot, *many)


@pytest.mark.parametrize("name", ["inverse_dynamics", "forward_dynamics", "kinetic_energy"])
@pytest.mark.parametrize("count", [None, 3])
def test_an_overflow_is_an_error(name, count):
    function, inputs = FUNCTIONS[name]
    robot = kl.load("puma560")
    huge = np.full((6,) if count is None else (count, 6), 1e200)
    with (
        np.errstate(over="ignore", invalid="ignore"),  # numpy warns of squares beyond 1e308
        pytest.raises(
            StateError, match=r"q: 1e\+200 at index .*; beyond 1e\+100 products overflow"
        ),
    ):
        function(robot, *[huge] * inputs)


@pytest.mark.parametrize("shape", [(5,), (7,), (6, 1), (1, 5), (2, 3, 6), ()])
@pytest.mark.parametrize("name", FUNCTIONS)
def test_a_wrong_shape_is_named(name, shape):
    function, inputs = FUNCTIONS[name]
    sound = np.zeros(6)
    for which in range(inputs):
        arguments = [sound] * which + [np.zeros(shape)] + [sound] * (inputs - which - 1)
        with pytest.raises(StateError, match=r"has shape .*; expected \(6,\) or \(N, 6\)"):
            function(kl.load("puma560"), *arguments)


def test_eight_threads_on_one_robot():
    robot = kl.load("puma560")
    work = [(name, seed) for seed in range(8) for name in FUNCTIONS]

    def answers(item):
        function, inputs = FUNCTIONS[item[0]]
        large = stacks(robot, 4096, seed=item[1])[:inputs]  # enough for two threads
        singles = [function(robot, *(stack[i] for stack in large)) for i in range(40)]
        return function(robot, *large), np.array(singles)

    expected = [answers(item) for item in work]
    with ThreadPoolExecutor(8) as pool:
        for got, want in zip(pool.map(answers, work), expected, strict=True):
            assert np.array_equal(got[0], want[0])
            assert np.array_equal(got[1], want[1])


def test_threads_that_change_between_two_calls_of_the_engine():
    """fk is several engine calls on one scratch: with a scratch in common this goes wrong."""
    robot = kl.load("puma560")
    q = stacks(robot, 8)[0]
    expected = [(kl.fk(robot, row), kl.jacobian(robot, row)) for row in q]

    def wrong(i):
        same = np.array_equal
        return sum(
            not (same(kl.fk(robot, q[i]), pose) and same(kl.jacobian(robot, q[i]), jac))
            for pose, jac in [expected[i]] * 4000
        )

    interval = sys.getswitchinterval()
    sys.setswitchinterval(1e-6)
    try:
        with ThreadPoolExecutor(8) as pool:
            assert list(pool.map(wrong, range(8))) == [0] * 8
    finally:
        sys.setswitchinterval(interval)


def test_answers_are_the_callers_own():
    """A later call must not write into an earlier answer."""
    robot = kl.load("puma560")
    q, v, a = stacks(robot, 2)
    for function, inputs in FUNCTIONS.values():
        first = np.array(before := function(robot, *(x[0] for x in (q, v, a)[:inputs])))
        function(robot, *(x[1] for x in (q, v, a)[:inputs]))
        assert np.array_equal(before, first)


@pytest.mark.parametrize("text", ["0", "-1", "two", "1.5", ""])
def test_a_bad_number_of_threads_is_named(monkeypatch, text):
    monkeypatch.setenv(threads.VARIABLE, text)
    with pytest.raises(OptionError, match="KINLAB_THREADS is .* whole number above zero"):
        threads.thread_count(100_000)
