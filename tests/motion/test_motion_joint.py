"""Motions in joint space: closed forms, differences, limits at all times, other planners."""

from __future__ import annotations

import sys

import numpy as np
import pytest

import kinlab as kl
from kinlab.errors import (
    FileError,
    LimitError,
    MissingExtraError,
    NameUnknownError,
    OptionError,
    StateError,
)
from kinlab.motion.record import peak_of

PUMA = kl.load("puma560")
POINTS = np.array([[0, 0, 0, 0, 0.5, 0], [1, 0.5, -1, 0.3, 0.5, 0.2], [0.4, 1.2, -0.6, -1, 0.2, 1]])
LAWS = ("quintic", "trapezoid", "spline", "jerk", "optimal")


def planned(law, points=POINTS, **options):
    limits = {"velocity": 2.0, "acceleration": 8.0} | ({"jerk": 60.0} if law == "jerk" else {})
    return kl.motion.joint(PUMA, points, law, **(limits | options))


@pytest.mark.parametrize("law", LAWS)
def test_velocities_and_accelerations_are_the_derivatives(law):
    """Central differences inside smooth pieces, whose error is h² q''' / 6."""
    motion = planned(law)
    h = 1e-5
    t = np.random.default_rng(0).uniform(2 * h, motion.duration - 2 * h, 400)
    t = t[np.abs(t[:, None] - motion.knots).min(axis=1) > h]
    assert len(t) > 300
    (before, vb, _), (_, v, a), (after, va, _) = (motion.at(x) for x in (t - h, t, t + h))
    np.testing.assert_allclose((after - before) / (2 * h), v, rtol=0, atol=1e-7)
    np.testing.assert_allclose((va - vb) / (2 * h), a, rtol=0, atol=1e-5)
    for row, point in ((0, POINTS[0]), (-1, POINTS[-1])):
        np.testing.assert_allclose(motion.q[row], point, rtol=0, atol=1e-12)
        np.testing.assert_allclose(motion.v[row], 0, rtol=0, atol=1e-9)
    for point in POINTS:  # passed exactly, whether with a stop or without
        grid = np.linspace(0, motion.duration, 20001)
        assert np.abs(motion.at(grid)[0] - point).max(axis=1).min() < 1e-3
    assert len(motion) == len(motion.t) and np.diff(motion.t).max() <= 0.01 + 1e-12


@pytest.mark.parametrize("law", LAWS)
def test_limits_hold_at_all_times_and_one_is_reached(law):
    motion = planned(law)
    t = np.linspace(0, motion.duration, 40001)
    _, v, a = (np.abs(x).max() for x in motion.at(t))
    assert v <= 2.0 * (1 + 1e-9) and a <= 8.0 * (1 + 1e-9)
    assert motion.peak_velocity.value.max() == pytest.approx(v, abs=1e-4)
    assert motion.peak_acceleration.value.max() == pytest.approx(a, rel=2e-2)
    jerk = peak_of(motion.curve, 3).value.max() if law == "jerk" else 0.0
    reached = max(v / 2.0, a / 8.0, jerk / 60.0)
    assert reached == pytest.approx(1.0, abs=1e-4)
    assert jerk <= 60.0 * (1 + 1e-9)


def test_the_times_of_a_trapezoid_and_of_a_quintic_in_closed_form():
    """T = D/V + V/A, or 2 sqrt(D/A) where V is not reached (Craig, section 7.3)."""
    for far, time in ((1.0, 1.0 / 2.0 + 2.0 / 8.0), (0.3, 2.0 * np.sqrt(0.3 / 8.0))):
        rows = np.outer([0.0, far], [1, 0.5, -0.2, 0, 0, 0.1])
        assert planned("trapezoid", rows).duration == pytest.approx(time, rel=1e-12)
        least = max(15.0 / 8.0 * far / 2.0, np.sqrt(10.0 / np.sqrt(3.0) * far / 8.0))
        assert planned("quintic", rows).duration == pytest.approx(least, rel=1e-12)
    # jerk: D = 1 with V = 2, A = 8, J = 60: T = D/V + V/A + A/J
    rows = np.outer([0.0, 1.0], [1, 0.5, -0.2, 0, 0, 0.1])
    assert planned("jerk", rows).duration == pytest.approx(0.5 + 0.25 + 8 / 60, rel=1e-9)


def test_the_time_optimal_motion_is_the_closed_form_on_a_line_and_the_first_of_all_on_a_curve():
    rows = np.outer([0.0, 1.0], [1, 0.5, -0.2, 0, 0, 0.1])
    line = planned("optimal", rows).duration
    assert 0.75 * (1 - 1e-9) <= line <= 0.75 * 1.003
    times = {law: planned(law).duration for law in ("optimal", "spline", "quintic")}
    assert times["optimal"] < min(times["spline"], times["quintic"])


def test_the_time_optimal_speed_is_near_the_bound_of_its_path_everywhere():
    """At every time a joint is at a limit: else the path could be passed faster there."""
    motion = planned("optimal")
    t = np.linspace(0.02, motion.duration - 0.02, 3000)
    _, v, a = motion.at(t)
    busy = np.maximum(np.abs(v).max(axis=1) / 2.0, np.abs(a).max(axis=1) / 8.0)
    assert np.quantile(busy, 0.05) > 0.97


def test_a_given_duration_is_kept_and_refused_where_it_is_too_short():
    motion = planned("quintic", duration=5.0)
    assert motion.duration == pytest.approx(5.0, rel=1e-12)
    with pytest.raises(LimitError, match=r"the same way holds it in") as refused:
        planned("quintic", duration=1.0, velocity=1.7)  # no round number of seconds
    least = float(str(refused.value).split("holds it in ")[1].split(" s")[0])
    assert planned("quintic", duration=least, velocity=1.7).duration == pytest.approx(
        least, rel=1e-12
    )
    with pytest.raises(LimitError):
        planned("quintic", duration=least * 0.9999, velocity=1.7)
    alone = kl.motion.joint(PUMA, POINTS[:2], "trapezoid", duration=3.0)
    assert alone.duration == pytest.approx(3.0)
    assert alone.peak_velocity.value[0] == pytest.approx(1.5 / 3.0)  # a third of the time each


def test_a_motion_outside_the_limits_says_which_joint_and_when():
    low = np.array(
        [[0.0, 0, 0, 0, 0, 0], [0, 0, 0.7, 0, 0, 0], [0, 1, 0.7, 0, 0, 0], [0, 1, 0, 0, 0, 0]]
    )
    with pytest.raises(LimitError, match=r"joint_3 leaves its limits by .* at t = .*0\.785398"):
        kl.motion.joint(PUMA, low, "spline", acceleration=1)
    with pytest.raises(
        LimitError, match=r"point 2 of 2: joint_3 is 2, outside .*works is 0\.785398"
    ):
        kl.motion.joint(PUMA, [[0] * 6, [0, 0, 2, 0, 0, 0]], acceleration=1)


@pytest.mark.parametrize(
    ("options", "error", "says"),
    [
        ({}, OptionError, "give acceleration="),
        ({"law": "cubic"}, NameUnknownError, "quintic"),
        ({"acceleration": -1}, OptionError, "must be positive"),
        ({"acceleration": [1, 2]}, OptionError, "expected one number or"),
        ({"law": "jerk", "acceleration": 1}, OptionError, "needs jerk="),
        ({"acceleration": np.nan}, OptionError, "finite"),
        ({"acceleration": 1, "step": 0}, OptionError, "step"),
        ({"acceleration": 1, "step": 1e-9}, OptionError, "samples"),
        ({"duration": -1}, OptionError, "duration"),
    ],
)
def test_bad_options(options, error, says):
    with pytest.raises(error, match=says):
        kl.motion.joint(PUMA, POINTS, **options)


@pytest.mark.parametrize(
    "points", [[0] * 6, [[0] * 6], [[0] * 6] * 2, [[0] * 5] * 2, [[np.nan] * 6] * 2]
)
def test_bad_points(points):
    with pytest.raises(StateError):
        kl.motion.joint(PUMA, points, acceleration=1)


@pytest.mark.parametrize(("law", "package"), [("jerk", "ruckig"), ("optimal", "toppra")])
def test_a_missing_package_is_named(law, package, monkeypatch):
    monkeypatch.setitem(sys.modules, package, None)
    with pytest.raises(MissingExtraError, match=rf"{package}: .*kinlab\[motion\]"):
        planned(law)


def test_a_file_there_and_back(tmp_path):
    motion = planned("quintic")
    back = kl.motion.read_motion(PUMA, motion.write(tmp_path / "motion.csv"))
    for column in "tqva":
        assert np.array_equal(getattr(back, column), getattr(motion, column))
    middles = 0.5 * (motion.t[1:] + motion.t[:-1])
    apart = np.abs(back.at(middles)[0] - motion.at(middles)[0]).max(axis=1)
    meets = np.abs(middles[:, None] - motion.knots).min(axis=1) < 0.01  # there the jerk jumps
    assert apart[~meets].max() < 1e-13 and apart.max() < 1e-6
    bare = tmp_path / "bare.csv"
    names = ",".join(["t", *(f"q{i + 1}" for i in range(6))])
    np.savetxt(
        bare, np.column_stack([motion.t, motion.q]), delimiter=",", header=names, comments=""
    )
    splined = kl.motion.read_motion(PUMA, bare)
    np.testing.assert_allclose(splined.at(middles)[1], motion.at(middles)[1], rtol=0, atol=1e-4)
    for text, says in (("t,q1\n0,1\n", "header"), (f"{names}\n0,1,x,3,4,5,6\n", "line 2: 'x'"),
                       (f"{names}\n0,1\n", "line 2: 2 cells")):  # fmt: skip
        bare.write_text(text)
        with pytest.raises(FileError, match=says):
            kl.motion.read_motion(PUMA, bare)


def test_samples_of_ones_own():
    t = np.linspace(0, 2, 81)
    q = np.column_stack([np.sin(t + i) * 0.3 for i in range(6)])
    motion = kl.motion.from_samples(PUMA, t, q)
    inside = np.linspace(0.1, 1.9, 333)
    exact = np.column_stack([np.cos(inside + i) * 0.3 for i in range(6)])
    np.testing.assert_allclose(motion.at(inside)[1], exact, rtol=0, atol=1e-8)
    with pytest.raises(OptionError, match="grow at row 3"):
        kl.motion.from_samples(PUMA, [0, 1, 2, 2, 3, 4], q[:6])
    with pytest.raises(OptionError, match="both v and a"):
        kl.motion.from_samples(PUMA, t, q, v=q)
    with pytest.raises(OptionError, match="outside the motion"):
        motion.at(2.1)


def test_a_stretched_motion_is_the_same_way():
    motion = planned("spline")
    slow = motion.stretched(2.0)
    t = np.linspace(0, motion.duration, 50)
    for order, (one, two) in enumerate(zip(motion.at(t), slow.at(2 * t), strict=True)):
        np.testing.assert_allclose(two, one / 2.0**order, rtol=0, atol=1e-9)
    assert np.array_equal(slow.q, motion.q) and slow.duration == 2 * motion.duration


def test_what_takes_arrays_takes_a_motion():
    motion = planned("quintic", step=0.05)
    tau = kl.inverse_dynamics(PUMA, motion.q, motion.v, motion.a)
    assert tau.shape == motion.q.shape
    found = kl.ik_path(PUMA, kl.fk(PUMA, motion.q), motion.q[0])
    assert found.success.all() and np.abs(found.q - motion.q).max() < 1e-4
