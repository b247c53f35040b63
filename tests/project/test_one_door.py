"""Whatever names an arm is an arm: every public function, given an arm in each of five ways."""

from __future__ import annotations

import inspect
from dataclasses import fields, is_dataclass, replace
from pathlib import Path

import numpy as np
import pytest

import kinlab as kl
from kinlab.errors import KinlabError, StructureError
from kinlab.model.library import as_robot, shipped

ARM_NAMES = ("robot", "table")
"""What the first parameter of a function is called where it is an arm."""

NOT_ARMS = {"design_fivebar", "fivebar_front", "load", "diagnose_table", "hand_formula", "mark"}
"""load makes the robot; diagnose_table judges a table; hand_formula marks a function; mark reads a
sheet that names its robot; the designs make a five-bar."""

SMALL: dict[str, dict[str, object]] = {
    "compare": {"quantity": "gravity_torques", "samples": 3},
    "diagnose": {"quantity": "gravity_torques", "samples": 10},
    "design_isotropic": {"free": ["a2"], "seeds": 3},
    "find_isotropic": {"seeds": 4},
    "find_singularities": {"points": 1},
    "is_cuspidal": {"poses": 3, "nodes": 40},
    "nearest_singularity": {"boxes": 50},
    "posture_path": {"nodes": 40},
    "sample_workspace": {"samples": 20},
    "solution_map": {"cells": 8},
    "simulate": {"duration": 0.02},
    "sweep": {"measure": "position", "samples": 10},
    "singular_loci": {"joints": [0, 7]},
}
"""Arguments that make a function quick, by its name. Where the two-link arm is none for a function,
its refusal is the answer: it names the arm."""


def functions():
    for name in kl.__all__:
        function = getattr(kl, name)
        if inspect.isfunction(function) and name not in NOT_ARMS:
            first = next(iter(inspect.signature(function).parameters), "")
            if first in ARM_NAMES:
                yield name


NAMES = sorted(functions())


def arguments(name: str, robot: kl.Robot) -> dict[str, object]:
    """Something for every parameter that has no default."""
    q = np.linspace(0.3, -0.7, robot.n)
    pose = kl.fk(robot, q)
    known: dict[str, object] = {
        "q": q,
        "v": q + 0.2,
        "a": 0.4 - q,
        "tau": 2.0 * q,
        "wrench": np.arange(6.0),
        "T": pose,
        "Ts": np.stack([pose, pose]),
        "q0": q,
        "one": q,
        "two": q + 0.05,
        "function": lambda q: 0.0 * np.asarray(q),
        "mass": 0.5,
    }
    if name == "size_servos":
        known["motion"] = kl.motion.joint(robot, [q, q + 0.3], duration=1.0)
    if name == "size_servos":
        known["motion"] = kl.motion.joint(robot, [q, q + 0.2], duration=1.0)
    if name == "action":
        times = np.linspace(0.0, 1.0, 5)[:, None]
        known.update(q=times * q, v=np.tile(q, (5, 1)), weights=np.full(5, 0.2))
    given = dict(SMALL.get(name, {}))
    for key, parameter in list(inspect.signature(getattr(kl, name)).parameters.items())[1:]:
        if parameter.default is parameter.empty and key not in given:
            assert key in known, f"{name}: say in this test what {key} may be"
            given[key] = known[key]
    return given


def answer(name: str, arm: object, given: dict[str, object]) -> object:
    try:
        return getattr(kl, name)(arm, **given)
    except KinlabError as problem:  # an arm that the function is not for
        assert robot_named(str(problem)), str(problem)
        return type(problem), str(problem)


def robot_named(text: str) -> bool:
    return "'planar2r'" in text and "no serial arm" not in text


def same(one: object, other: object) -> bool:
    """Whether two answers say the same, entry by entry, bit for bit."""
    if isinstance(one, kl.Robot):
        return isinstance(other, kl.Robot) and one.urdf == other.urdf
    if type(one) is not type(other):
        return False
    if isinstance(one, np.ndarray):
        return np.array_equal(one, other, equal_nan=one.dtype.kind == "f")
    if isinstance(one, float):
        return one == other or (one != one and other != other)
    if isinstance(one, dict):
        return one.keys() == other.keys() and all(same(one[k], other[k]) for k in one)
    if isinstance(one, (list, tuple)):
        return len(one) == len(other) and all(map(same, one, other))
    if is_dataclass(one) and not isinstance(one, kl.DHTable):
        shown = [f.name for f in fields(one) if not f.name.startswith("_") and f.compare]
        return all(same(getattr(one, f), getattr(other, f)) for f in shown)
    if hasattr(one, "__dict__") and type(one).__module__.startswith("kinlab"):
        return True  # what answers are made of lazily; the numbers are compared above
    return callable(one) or one == other


@pytest.mark.parametrize("name", [n for n in NAMES if n != "view"])
def test_five_ways_to_name_an_arm(name):
    robot = kl.load("planar2r")
    given = arguments(name, robot)
    want = answer(name, robot, given)
    entry = shipped()["planar2r"].path
    for arm in ("planar2r", str(entry), entry, robot.table):
        assert same(answer(name, arm, given), want), type(arm)
    bare = kl.Robot.from_model(robot.model)  # a model has no table: its own robot is the measure
    assert same(answer(name, robot.model, given), answer(name, bare, given))


def test_the_list_is_whole():
    """The stub's functions that this file does not see take no arm."""
    others = {n for n in kl.__all__ if inspect.isfunction(getattr(kl, n))} - set(NAMES)
    assert others == NOT_ARMS
    assert len(NAMES) >= 55


@pytest.mark.parametrize("name", [n for n in NAMES if n != "sweep"])  # that is of any object
def test_what_is_no_arm_is_refused_by_every_function(name):
    given = arguments(name, kl.load("planar2r"))
    for thing in (None, 5, b"puma560", ["puma560"], kl.Robot, np.eye(4)):
        with pytest.raises(KinlabError, match=r"no serial arm; give a Robot, a DHTable"):
            getattr(kl, name)(thing, **given)


@pytest.mark.parametrize("of", ["joint", "cartesian"])
def test_motions_are_of_any_arm(of):
    robot = kl.load("planar2r")
    q = np.array([[0.3, 0.4], [0.5, 0.6]])
    points = q if of == "joint" else kl.fk(robot, q)
    given = {"duration": 1.0, **({} if of == "joint" else {"q0": q[0]})}
    want = getattr(kl.motion, of)(robot, points, **given).q
    for arm in ("planar2r", shipped()["planar2r"].path, robot.table, robot.model):
        assert np.array_equal(getattr(kl.motion, of)(arm, points, **given).q, want)


def test_a_sweep_of_anything():
    """A sweep takes any object with its measure; text is the name of a mechanism."""
    five = kl.sweep("isotropic", lambda bar, q: bar.fk(q)[:, 0], np.array([[0.1, 3.0]]), workers=1)
    want = kl.FiveBar.load("isotropic").fk([0.1, 3.0])[0]
    assert five["value"] == pytest.approx([want])


def test_the_viewer_takes_every_way(monkeypatch):
    from kinlab.viewer import show

    monkeypatch.setattr(show, "in_notebook", lambda: True)
    robot = kl.load("planar2r")
    for arm in (robot, "planar2r", shipped()["planar2r"].path, robot.table, robot.model):
        assert kl.view(arm).robot.n == 2
    preset = Path(shipped()["planar2r"].path).parent / "fivebar" / "isotropic.toml"
    for five in (kl.FiveBar.load("isotropic"), "isotropic", preset, str(preset)):
        assert kl.view(five).linkage.name == "isotropic"
    for thing in (None, 5, np.eye(4)):
        with pytest.raises(StructureError, match="no serial arm"):
            kl.view(thing)


def test_five_bars_are_five_bars_by_name_and_path():
    preset = Path(shipped()["planar2r"].path).parent / "fivebar" / "isotropic.toml"
    states = {}
    for five in (kl.FiveBar.load("isotropic"), "isotropic", preset, str(preset)):
        found = kl.compare(five, "fivebar_cranks", lambda xy, mode: np.zeros((2, 2)), samples=3)
        states[str(five)] = found.engine
    first, *rest = states.values()
    assert all(np.array_equal(first, one) for one in rest)
    with pytest.raises(KinlabError, match="give a FiveBar"):
        kl.compare(5, "fivebar_cranks", lambda xy, mode: np.zeros((2, 2)), samples=3)
    with pytest.raises(StructureError, match="a five-bar's functions are its methods"):
        kl.fk(kl.FiveBar.load("isotropic"), [0.0, 0.0])


def test_what_is_loaded_once_and_what_again(tmp_path):
    robot = kl.load("planar2r")
    assert as_robot(robot) is robot
    assert as_robot("planar2r") is as_robot("planar2r")
    assert as_robot(robot.table) is as_robot(robot.table)
    file = tmp_path / "arm.toml"
    robot.table.save(file)
    first = as_robot(file)
    assert as_robot(str(file)) is first
    longer = replace(robot.table, links=[replace(one, a=one.a + 0.25) for one in robot.table.links])
    longer.save(file)  # the same name: what it says now holds
    assert as_robot(file) is not first
    assert np.allclose(kl.fk(file, [0.1, 0.2]), longer.fk([0.1, 0.2])[-1], rtol=0, atol=1e-14)
    robot.table.save(file)
    assert np.allclose(kl.fk(file, [0.1, 0.2]), kl.fk(robot, [0.1, 0.2]), rtol=0, atol=0)


def test_a_model_may_change_between_calls():
    model = kl.load("planar2r").model.copy()
    before = kl.gravity_torques(model, [0.1, 0.2])
    model.gravity.linear *= 2.0
    assert kl.gravity_torques(model, [0.1, 0.2]) == pytest.approx(2.0 * before, rel=1e-14)
