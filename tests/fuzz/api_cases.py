"""The public functions with every argument made hostile, one at a time.

A variant of an argument is of one kind: ``same`` (another form of the same value: the answer must
be the clean one, or a refusal), ``never`` (no value at all: it must be refused) or ``far`` (a
value beyond use: a finite answer or a refusal).
"""

from __future__ import annotations

import dataclasses
import functools
import inspect
import random
import warnings
from collections.abc import Callable, Iterator
from pathlib import Path
from typing import Any

import numpy as np

import kinlab as kl

Q, V, A = [0.3, -0.7], [0.4, 0.2], [-0.5, 0.6]
W = [1.0, 2.0, 0.0, 0.0, 0.0, 0.5]
XY = [0.1, -0.5]
STACK = [[0.3, -0.7], [0.1, 0.4], [-1.0, 0.9]]

# name: (tag of each argument, clean value); the tag says which variants are tried
Calls = dict[str, tuple[str, dict[str, tuple[str, Any]]]]


def _arm(**rest: tuple[str, Any]) -> dict[str, tuple[str, Any]]:
    return {"robot": ("robot", "planar2r"), **rest}


_q, _v, _a = ("array", Q), ("array", V), ("array", A)
_w, _seed, _task = ("array", W), ("seed", 1), ("task", "auto")
_length = ("positive", 1.0)

CALLS: Calls = {
    **{
        name: (name, _arm(q=_q))
        for name in (
            "fk", "jacobian", "mass_matrix", "gravity_torques", "potential_energy", "link_poses",
            "com_positions", "com_jacobians", "link_potential_energies", "christoffel",
            "mass_matrix_derivatives", "coriolis_coefficients", "centrifugal_coefficients",
        )
    },
    **{
        name: (name, _arm(q=_q, v=_v))
        for name in (
            "coriolis_matrix", "kinetic_energy", "link_velocities", "lagrangian", "momentum",
            "lagrangian_gradient", "mass_matrix_dot", "link_kinetic_energies", "jacobian_dot",
        )
    },
    **{
        name: (name, _arm(q=_q, v=_v, a=_a))
        for name in (
            "com_accelerations", "link_accelerations", "inertial_wrenches", "lagrange_torques",
            "momentum_rate",
        )
    },
    "fk stack": ("fk", _arm(q=("array", STACK))),
    "mass_matrix stack": ("mass_matrix", _arm(q=("array", STACK))),
    "inverse_dynamics stack": ("inverse_dynamics", _arm(
        q=("array", STACK), v=("array", STACK), a=("array", STACK))),
    "inverse_dynamics": ("inverse_dynamics", _arm(
        q=_q, v=_v, a=_a, wrench=_w, friction=("bool", True))),
    "forward_dynamics": ("forward_dynamics", _arm(
        q=_q, v=_v, tau=_a, wrench=_w, friction=("bool", True))),
    "simulate": ("simulate", _arm(
        q0=_q, v0=_v, torque=_a, duration=("positive", 0.02), wrench=_w, step=("positive", 0.01))),
    "size_servos": ("size_servos", _arm(
        motion=("thing", "motion"), gear_ratio=("positive", 20.0), wrench=_w)),
    "motion.joint": ("motion.joint", _arm(
        points=("array", [Q, V]), law=("word", "quintic"), duration=("positive", 1.0),
        step=("positive", 0.1))),
    "mark": ("mark", {
        "sheet": ("thing", "sheet"), "submissions": ("thing", "submissions"),
        "feedback": ("word", "verdict"), "workers": ("count", 1)}),
    "friction_torques": ("friction_torques", _arm(v=_v)),
    "with_payload": ("with_payload", _arm(
        mass=("positive", 0.5), com=("array", [0.0, 0.0, 0.1]), inertia=("array", np.eye(3)))),
    "joint_wrenches": ("joint_wrenches", _arm(q=_q, v=_v, a=_a, wrench=_w)),
    "static_wrenches": ("static_wrenches", _arm(q=_q, wrench=_w)),
    "statics": ("statics", _arm(q=_q, wrench=_w, frame=("word", "tool"))),
    "jacobian frame": ("jacobian", _arm(q=_q, frame=("word", "spatial"))),
    "action": ("action", _arm(q=("array", STACK), v=("array", STACK), weights=("array", [0.1, 0.2, 0.1]))),
    "manipulability": ("manipulability", _arm(
        q=_q, kind=("word", "min_singular"), task=("task", "xy"), length=_length)),
    "dexterity": ("dexterity", _arm(q=_q, task=_task, length=_length)),
    "ellipsoid": ("ellipsoid", _arm(q=_q, kind=("word", "force"), task=_task, length=_length)),
    "redundancy": ("redundancy", _arm(q=_q, task=_task)),
    "describe_singularity": ("describe_singularity", _arm(q=("array", [0.3, 0.0]), task=_task)),
    "characteristic_length": ("characteristic_length", {
        "robot": ("robot", "puma560"), "q": ("array", [0.1, 0.3, -0.8, 0.4, 0.7, 0.1]),
        "task": ("task", "pose"), "length": ("positive", 0.5)}),
    "nearest_singularity": ("nearest_singularity", _arm(
        q=_q, task=_task, boxes=("count", 50), points=("count", 4), seed=_seed)),
    "workspace_section": ("workspace_section", {
        "robot": ("robot", "stanford"), "step": ("positive", 0.5), "seed": _seed}),
    "find_singularities": ("find_singularities", _arm(
        task=_task, points=("count", 2), seed=_seed, keep=("count", 3))),
    "find_isotropic": ("find_isotropic", _arm(
        task=_task, length=_length, seeds=("count", 5), seed=_seed)),
    "factored_determinant": ("factored_determinant", _arm(task=_task, seed=_seed)),
    "planar_boundary": ("planar_boundary", _arm()),
    "singular_loci": ("singular_loci", _arm(
        joints=("joints", [0, 1]), q=_q, task=_task, step=("positive", 0.5), levels=("count", 3), seed=_seed)),
    "sample_workspace": ("sample_workspace", _arm(
        task=_task, metric=("word", "min_singular"), samples=("count", 50),
        sampling=("word", "random"), length=_length, seed=_seed, workers=("count", 1))),
    "sweep": ("sweep", _arm(
        measure=("word", "min_singular"), samples=("count", 50), seed=_seed, lower=("array", [-1.0, -1.0]),
        upper=("array", [1.0, 1.0]), workers=("count", 1), chunk=("count", 16))),
    "design_isotropic": ("design_isotropic", {
        "table": ("table", "planar2r"), "free": ("names", ["a2", "tool.x"]), "task": _task,
        "length": _length, "seeds": ("count", 3), "seed": _seed, "keep": ("count", 2)}),
    "ik": ("ik", _arm(
        T=("pose", [0.3, -0.7]), q0=("array", [0.2, -0.5]), method=("word", "lm"),
        tol_position=("positive", 1e-6), tol_rotation=("positive", 1e-6), seed=_seed,
        task=("task", "pose"), restarts=("count0", 5), max_iterations=("count", 50))),
    "ik newton": ("ik", _arm(
        T=("pose", [0.3, -0.7]), q0=("array", [0.2, -0.5]), method=("word", "newton"),
        task=("task", "xy"), tol_step=("positive", 1e-9), history=("bool", True))),
    "ik gradient": ("ik", _arm(
        T=("pose", [0.3, -0.7]), q0=("array", [0.2, -0.5]), method=("word", "gradient"),
        task=("task", "xy"), alpha=("positive", 0.1))),
    "ik_batch": ("ik_batch", _arm(
        Ts=("poses", STACK), q0=("array", STACK), tol_position=("positive", 1e-6), seed=_seed,
        task=("task", "pose"), restarts=("count0", 5), max_iterations=("count", 50), threads=("count", 1))),
    "ik_branches": ("ik_branches", _arm(T=("pose", [0.3, -0.7]))),
    "ik_path": ("ik_path", _arm(
        Ts=("poses", [[0.3, -0.7], [0.31, -0.69]]), q0=("array", Q), tol_position=("positive", 1e-6),
        seed=_seed, task=("task", "pose"), max_step=("positive", 0.5))),
    "solution_count": ("solution_count", _arm(T=("pose", [0.3, -0.7]), threads=("count", 1))),
    "solution_map": ("solution_map", _arm(cells=("count", 12), angle=("real", 0.0))),
    "aspects": ("aspects", _arm(limits=("bool", True))),
    "is_cuspidal": ("is_cuspidal", _arm(
        poses=("count", 5), nodes=("count", 20), limits=("bool", True), seed=_seed)),
    "posture_path": ("posture_path", _arm(
        one=("array", [0.2, 0.5]), two=("array", [0.4, 0.8]), nodes=("count", 20),
        limits=("bool", True), seed=_seed)),
    "to_dh": ("to_dh", _arm()),
    "to_urdf": ("to_urdf", {"table": ("table", "planar2r")}),
    "load": ("load", {"name_or_path": ("path", "planar2r")}),
    "load tool": ("load", {"name_or_path": ("path", "planar2r"), "tool": ("path", None)}),
    "compare": ("compare", {
        "robot": ("path", "planar2r"), "quantity": ("word", "gravity_torques"),
        "function": ("function", None), "samples": ("count", 5), "seed": _seed}),
    "diagnose": ("diagnose", {
        "robot": ("path", "planar2r"), "quantity": ("word", "gravity_torques"),
        "function": ("function", None), "samples": ("count", 5), "seed": _seed}),
    "diagnose_table": ("diagnose_table", {
        "mine": ("path", "planar2r"), "against": ("path", "planar2r"), "tool": ("path", None),
        "dynamics": ("bool", True), "seed": _seed}),
    "DHLink": ("DHLink", {
        "joint": ("word", "revolute"), "a": ("real", 0.5), "alpha": ("real", 0.1), "d": ("real", 0.2),
        "theta": ("real", 0.3), "flip": ("bool", True), "lower": ("real", -1.0), "upper": ("real", 1.0),
        "velocity": ("real", 2.0), "effort": ("real", 3.0), "mass": ("real", 2.0),
        "com": ("array", [0.1, 0.2, 0.3]), "inertia": ("array", [[1.0, 0, 0], [0, 1, 0], [0, 0, 1]]),
        "armature": ("real", 0.1), "name": ("label", "shoulder")}),
    "DHTable": ("DHTable", {
        "name": ("label", "arm"), "convention": ("word", "standard"), "links": ("links", None),
        "base": ("pose", [0.3, -0.7]), "tool": ("pose", [0.3, -0.7]),
        "gravity": ("array", [0.0, 0.0, -9.81]), "source": ("free text", "here"), "tool_name": ("label", "tip")}),
    "FiveBar": ("FiveBar", {
        "l1": ("array", [0.4, 0.3]), "l2": ("array", [0.6, 0.7]), "e": ("real", 0.1),
        "crank_mass": ("array", [0.1, 0.2]), "rod_mass": ("array", [0.1, 0.2]), "payload": ("real", 0.3),
        "rotor_inertia": ("array", [0.01, 0.01]), "gear_ratio": ("array", [2.0, 3.0]),
        "gravity": ("array", [0.0, -9.81]), "name": ("label", "five")}),
    "five.fk": ("five.fk", {"theta": ("theta", None), "assembly": ("sign", 1)}),
    "five.ik": ("five.ik", {"xy": ("array", XY), "mode": ("mode", (-1, 1)), "on_unreachable": ("word", "raise")}),
    "five.reachable": ("five.reachable", {"xy": ("array", XY)}),
    **{
        f"five.{name}": (f"five.{name}", {"xy": ("array", XY), "mode": ("mode", (-1, 1))})
        for name in ("jacobian", "condition_number", "mass_matrix")
    },
    "five.acceleration_bias": ("five.acceleration_bias", {"xy": ("array", XY), "v": _v, "mode": ("mode", (-1, 1))}),
    "five.inverse_dynamics": ("five.inverse_dynamics", {
        "xy": ("array", XY), "v": _v, "a": _a, "mode": ("mode", (-1, 1)), "model": ("word", "exact")}),
    "five.forward_dynamics": ("five.forward_dynamics", {"xy": ("array", XY), "v": _v, "tau": _a, "mode": ("mode", (-1, 1))}),
    "five.size_servo": ("five.size_servo", {
        "workspace": ("array", [-0.1, 0.1, -0.55, -0.45]), "v_max": ("positive", 1.0), "a_max": ("positive", 5.0),
        "efficiency": ("positive", 0.9)}),
    "chain.assemble": ("chain.assemble", {"theta": ("theta", None), "assembly": ("sign", 1)}),
    "chain.at": ("chain.at", {"xy": ("array", XY), "mode": ("mode", (-1, 1))}),
    **{
        f"chain.{name}": (f"chain.{name}", {"q": ("chain q", None)})
        for name in ("fk", "jacobian", "mass_matrix", "projection", "tool_jacobian", "closure")
    },
    "chain.joint_rates": ("chain.joint_rates", {"q": ("chain q", None), "v": _v}),
    "chain.joint_accelerations": ("chain.joint_accelerations", {"q": ("chain q", None), "qd": ("chain qd", None), "a": _a}),
    "chain.inverse_dynamics": ("chain.inverse_dynamics", {
        "q": ("chain q", None), "qd": ("chain qd", None), "qdd": ("chain qd", None)}),
    "chain.closure_bias": ("chain.closure_bias", {"q": ("chain q", None), "qd": ("chain qd", None)}),
    "chain.energy": ("chain.energy", {"q": ("chain q", None), "qd": ("chain qd", None)}),
}  # fmt: skip

HEAVY = ("design_isotropic", "find_singularities", "find_isotropic", "factored_determinant",
         "diagnose", "singular_loci", "five.size_servo", "describe_singularity",
         "workspace_section")  # fmt: skip


class Raises:
    """Looks like an array until it is read."""

    def __array__(self, *args: Any, **rest: Any) -> Any:
        raise RuntimeError("boom")


class Gives:
    """An array by protocol."""

    def __init__(self, value: Any) -> None:
        self._value = value

    def __array__(self, *args: Any, **rest: Any) -> Any:
        return self._value


class Changes:
    """Another answer each time it is read."""

    def __init__(self, value: Any) -> None:
        self._value, self._reads = np.asarray(value, dtype=float), 0

    def __array__(self, *args: Any, **rest: Any) -> Any:
        self._reads += 1
        return self._value if self._reads == 1 else self._value * np.nan


class Endless:
    def __len__(self) -> int:
        return 2

    def __getitem__(self, i: int) -> float:
        raise ZeroDivisionError("boom")


class Unfloat:
    def __float__(self) -> float:
        raise RuntimeError("boom")

    def __index__(self) -> int:
        raise RuntimeError("boom")


class Sub(np.ndarray):
    pass


def arrays(clean: Any) -> Iterator[tuple[str, str, Any]]:
    """Variants of an array: name, kind, value."""
    x = np.asarray(clean, dtype=float)
    yield "big-endian", "same", x.astype(">f8")
    yield "little-endian float32", "same", (x.astype("<f4"), x.astype("<f4").astype(float))
    yield "big-endian float32", "same", (x.astype(">f4"), x.astype("<f4").astype(float))
    yield "half", "same", (x.astype("<f2"), x.astype("<f2").astype(float))
    yield "longdouble", "same", x.astype(np.longdouble)
    yield "object", "same", x.astype(object)
    yield "nested lists", "same", x.tolist()
    yield "Fortran order", "same", np.asfortranarray(x)
    yield "every other", "same", np.repeat(x, 2, axis=-1)[..., ::2]
    yield "reversed view", "same", x[..., ::-1].copy()[..., ::-1]
    yield "read-only", "same", np.frombuffer(x.tobytes()).reshape(x.shape)
    yield "unaligned", "same", np.frombuffer(b"x" + x.tobytes(), offset=1).reshape(x.shape)
    yield "subclass", "same", x.view(Sub)
    yield "masked, nothing masked", "same", np.ma.array(x)
    yield "an object with __array__", "same", Gives(x)
    yield "an object that changes", "same", Changes(x)
    yield "integers", "same", (np.round(x).astype(int), np.round(x))
    yield "big-endian integers", "same", (np.round(x * 2).astype(">i4"), np.round(x * 2))
    yield "memoryview", "same", memoryview(x.copy())
    masked = np.ma.array(x.copy(), mask=np.zeros(x.shape, bool))
    masked.mask.flat[-1] = True
    yield "masked", "never", masked
    for name, value in (("nan", np.nan), ("inf", np.inf), ("-inf", -np.inf)):
        bad = x.copy()
        bad.flat[-1] = value
        yield name, "never", bad
        yield f"{name} in lists", "never", bad.tolist()
        yield f"big-endian {name}", "never", bad.astype(">f8")
        yield f"{name} by __array__", "never", Gives(bad)
    yield "None", "never", None
    yield "None inside", "never", [None] * x.size
    yield "text", "never", "hello"
    yield "bytes", "never", b"hello"
    yield "complex", "never", x + 1j
    yield "complex objects", "never", (x + 1j).astype(object)
    yield "booleans", "never", x > 0
    yield "structured", "never", np.zeros(x.shape, dtype=[("a", float)])
    yield "dates", "never", np.zeros(x.shape, dtype="M8[s]")
    yield "dict", "never", {"a": 1}
    yield "set", "never", {1.0, 2.0}
    yield "generator", "never", (v for v in x.ravel())
    yield "ragged", "never", [[1.0], [1.0, 2.0]]
    yield "too long", "never", np.concatenate([x, x], axis=-1)
    yield "too short", "never", x[..., :-1]
    yield "empty", "never", np.zeros(0)
    yield "deeper", "never", np.zeros((1, 2, 3, *x.shape))
    yield "raises in __array__", "never", Raises()
    yield "__array__ of text", "never", Gives("hello")
    yield "__array__ of None", "never", Gives(None)
    yield "raises in __getitem__", "never", Endless()
    yield "raises in __float__", "never", [Unfloat()] * x.size
    yield "an object", "never", object()
    yield "a class", "never", float
    yield "huge integers", "never", [10**400] * x.size
    for size in (1e17, 1e155, 1e200, 1e308, -1.7e308):
        far = x.copy()
        far.flat[-1] = size
        yield f"{size:g}", "far", far
        yield f"all {size:g}", "far", np.full(x.shape, size)
    yield "5e-324", "far", np.full(x.shape, 5e-324)


def reals(clean: float) -> Iterator[tuple[str, str, Any]]:
    yield "float32", "same", (np.float32(clean), float(np.float32(clean)))
    yield "0-d array", "same", np.array(clean)
    yield "big-endian 0-d", "same", np.array(clean, dtype=">f8")
    yield "object 0-d", "same", np.array(clean, dtype=object)
    for name, value in (
        ("nan", np.nan), ("inf", np.inf), ("text", "x"), ("list", [1.0, 2.0, 3.0]), ("complex", 1 + 1j),
        ("dict", {}), ("raises in __float__", Unfloat()), ("raises in __array__", Raises()), ("object", object()),
        ("masked", np.ma.masked), ("10**400", 10**400), ("bytes", b"x"), ("bool", True), ("empty", []),
    ):  # fmt: skip
        yield name, "never", value
    for value in (1e200, -1e200, 1e308, 5e-324):
        yield f"{value:g}", "far", value


def variants(tag: str, clean: Any) -> Iterator[tuple[str, str, Any]]:
    """Name, kind and value of every variant of an argument."""
    if tag in ("array", "pose", "poses", "theta", "chain q", "chain qd"):
        yield from arrays(clean)
    elif tag == "real":
        yield from reals(clean)
    elif tag == "positive":
        yield from reals(clean)
        for value in (0.0, -1.0, -0.0):
            yield f"{value}", "never", value
    elif tag in ("seed", "count", "count0"):
        yield "numpy integer", "same", np.int64(clean)
        yield "big-endian", "same", np.array(clean, dtype=">i4")[()]
        for name, value in (
            ("-1", -1), ("1.5", 1.5), ("text", "5"), ("nan", np.nan), ("inf", np.inf), ("list", [1, 2]),
            ("complex", 1j), ("object", object()), ("bytes", b"1"), ("raises in __index__", Unfloat()),
            ("-10**30", -(10**30)), ("dict", {}),
        ):  # fmt: skip
            yield name, "never", value
        if tag == "count":
            yield "0", "never", 0
        if tag == "seed":
            yield "2**40", "far", 2**40
            yield "2**63", "far", 2**63
            yield "2**200", "far", 2**200
            yield "None", "far", None
    elif tag in ("word", "task", "label", "sign", "mode", "names", "joints", "path", "bool"):
        hostile: list[tuple[str, Any]] = [
            ("5", 5), ("1.5", 1.5), ("bytes", b"pose"), ("list", [[1], 2]), ("dict", {"a": 1}),
            ("object", object()), ("set", {1}), ("nan", np.nan), ("array", np.arange(3.0)), ("Raises", Raises()),
        ]  # fmt: skip
        if tag not in ("path", "label", "task"):  # no task means the one that suits the arm
            hostile.append(("None", None))
        if tag not in ("label",):
            hostile += [("unknown", "no such thing"), ("empty", ""), ("nul", "a\0b"), ("long", "x" * 5000),
                        ("surrogate", "\ud800"), ("markup", "[/bold]{x}")]  # fmt: skip
        else:
            hostile += [("empty", ""), ("nul", "a\0b"), ("newline", "a\nb"), ("escape", "\x1b[31m")]
        if tag == "joints":
            hostile += [("twice", [0, 0]), ("far", [0, 99]), ("negative", [-1, -2]), ("floats", [0.5, 1.5]), ("one", [0]),
                        ("10**30", [10**30, 0])]  # fmt: skip
        if tag == "mode":
            hostile += [
                ("0", (0, 0)),
                ("2", (2, 1)),
                ("one", (1,)),
                ("three", (1, 1, 1)),
                ("texts", ("1", "1")),
            ]
        if tag == "sign":
            hostile = [(n, v) for n, v in hostile] + [("0", 0), ("2", 2)]
        if tag == "task":
            hostile += [
                ("mask of 5", [True] * 5),
                ("no True", [False] * 6),
                ("numbers", [1, 2, 3, 4, 5, 6]),
            ]
        for name, value in hostile:
            yield name, "far" if tag == "bool" else "never", value
    elif tag in ("robot", "table"):
        for name, value in (
            ("None", None), ("name", "planar2x"), ("5", 5), ("object", object()), ("class", kl.Robot),
            ("array", np.zeros(2)), ("dict", {}), ("five-bar", kl.FiveBar.load("isotropic")),
            ("bytes", b"planar2r"), ("folder", Path(__file__).parent),
        ):  # fmt: skip
            yield name, "never", value
    elif tag == "thing":
        for name, value in (
            ("None", None), ("5", 5), ("object", object()), ("bytes", b"x"), ("array", np.zeros(3)),
            ("surrogate", "\ud800"), ("nul", "a\0b"), ("text", "no such thing"), ("class", kl.Robot),
        ):  # fmt: skip
            yield name, "never", value
    elif tag == "function":
        for name, value in (
            ("None", None), ("5", 5), ("text", "x"), ("gives None", lambda q: None), ("gives text", lambda q: "x"),
            ("gives another shape", lambda q: np.zeros(7)), ("gives complex", lambda q: np.zeros(2) + 1j),
            ("gives objects", lambda q: np.array([object(), 1])), ("takes nothing", lambda: 0),
            ("raises", lambda q: 1 / 0), ("gives ragged", lambda q: [[1], [1, 2]]),
        ):  # fmt: skip
            yield name, "function", value
    elif tag == "links":
        for name, value in (
            ("None", None), ("5", 5), ("empty", []), ("texts", ["a"]), ("a link", kl.DHLink()), ("None inside", [None]),
            ("dicts", [{"a": 1}]), ("generator", (x for x in [5])), ("text", "ab"),
        ):  # fmt: skip
            yield name, "never", value
    elif tag == "free text":
        for name, value in (("5", 5), ("None", None), ("object", object()), ("bytes", b"x")):
            yield name, "never", value


@functools.cache
def _arm_of(name: str) -> Any:
    return kl.load(name)


def _resolve(arm: bool, name: str) -> Any:
    return _arm_of(name) if arm else _arm_of(name).table


def _gravity(q: Any) -> Any:
    return kl.gravity_torques(_arm_of("planar2r"), q)


def _motion() -> Any:
    return kl.motion.joint(_arm_of("planar2r"), [Q, V], duration=1.0)


SHEET = {
    "title": "t",
    "robot": "planar2r",
    "questions": [{"id": "q", "quantity": "gravity_torques[0]", "points": 1}],
}


def clean_value(tag: str, value: Any) -> Any:
    """What the clean call passes."""
    if tag == "robot":
        return _resolve(True, value)
    if tag == "table":
        return _resolve(False, value)
    if tag in ("pose", "poses"):
        return kl.fk(_arm_of("planar2r"), np.asarray(value))
    if tag == "function":
        return _gravity
    if tag == "thing":
        return {
            "motion": _motion,
            "sheet": lambda: SHEET,
            "submissions": lambda: {"ada": {"q": "0"}},
        }[value]()
    if tag == "links":
        return [kl.DHLink(a=0.5, mass=1.0, inertia=np.eye(3)), kl.DHLink(a=0.4)]
    five = kl.FiveBar.load("isotropic")
    if tag == "theta":
        return five.ik(XY)
    if tag == "chain q":
        return five.closed_chain().assemble(five.ik(XY))
    if tag == "chain qd":
        chain = five.closed_chain()
        return chain.joint_rates(chain.assemble(five.ik(XY)), np.array(V))
    return np.asarray(value, dtype=float) if tag == "array" else value


def _function(name: str) -> Callable[..., Any]:
    if name.startswith("five."):
        return getattr(kl.FiveBar.load("isotropic"), name[5:])
    if name.startswith("motion."):
        return getattr(kl.motion, name[7:])
    if name.startswith("chain."):
        return getattr(kl.FiveBar.load("isotropic").closed_chain(), name[6:])
    return getattr(kl, name)


def flat(value: Any, depth: int = 0) -> list[np.ndarray]:
    """All numbers of an answer, in order."""
    if isinstance(value, (str, bytes)) or value is None or callable(value):
        return []
    if isinstance(value, np.ma.MaskedArray):
        return [np.asarray(value.filled(0.0), dtype=float)]
    if isinstance(value, (int, float, np.number, np.bool_)):
        return [np.array(float(value))]
    if isinstance(value, np.ndarray):
        return [value.astype(float)] if value.dtype.kind in "fiub" else []
    if depth > 4:
        return []
    if dataclasses.is_dataclass(value):
        return [x for f in dataclasses.fields(value) if f.name not in ("model", "seed", "folder")
                for x in flat(getattr(value, f.name, None), depth + 1)]  # fmt: skip
    if isinstance(value, dict):
        return [x for v in value.values() for x in flat(v, depth + 1)]
    if isinstance(value, (list, tuple)):
        return [x for v in value for x in flat(v, depth + 1)]
    return []


ENDLESS = ("limit", "lower", "upper", "bounds", "torque_limit")


def catalogue() -> list[tuple[str, str, str, str]]:
    """Every (call, argument, variant, kind)."""
    out = []
    for name, (_, arguments) in CALLS.items():
        for argument, (tag, clean) in arguments.items():
            for variant, kind, _ in variants(tag, clean_value(tag, clean)):
                out.append((name, argument, variant, kind))
    return out


def cases(seed: int, count: int) -> list[tuple[str, tuple[str, str, str]]]:
    """``count`` of the catalogue, drawn without repetition; the heavy calls seldom."""
    rng = random.Random(seed)
    whole = catalogue()
    rng.shuffle(whole)
    light = [c for c in whole if c[0] not in HEAVY]
    heavy = [c for c in whole if c[0] in HEAVY]
    chosen = light[: count - count // 12] + heavy[: count // 12]
    return [(f"{c[0]}({c[1]}: {c[2]})", c[:3]) for c in chosen]


@functools.cache
def _clean_answer(name: str) -> list[np.ndarray]:
    function, arguments = CALLS[name]
    call = {key: clean_value(*pair) for key, pair in arguments.items()}
    return flat(_function(function)(**call))


def judge(case: tuple[str, str, str]) -> tuple[str, str]:
    """One call with one hostile argument."""
    name, argument, wanted = case
    function, arguments = CALLS[name]
    call = {key: clean_value(*pair) for key, pair in arguments.items()}
    tag, _ = arguments[argument]
    kind, value = next(
        (k, v) for variant, k, v in variants(tag, call[argument]) if variant == wanted
    )
    want = None
    if kind == "same":
        if isinstance(value, tuple):
            value, plain = value
            call[argument] = plain
            try:
                want = flat(_function(function)(**call))
            except kl.KinlabError:
                return "refused", "the plain value is refused"
        else:
            want = _clean_answer(name)
    call[argument] = value
    with warnings.catch_warnings():
        warnings.simplefilter("ignore")
        answer = _function(function)(**call)
        have = flat(answer)
    if kind == "function":
        agrees = getattr(answer, "agrees", None)
        return ("wrong", "said to agree") if agrees is True else ("right", "")
    if kind == "never":
        default = inspect.signature(_function(function)).parameters[argument].default
        if value is None and default is None:
            return "right", "left out"
        return "wrong", f"accepted: {str(answer)[:80]!r}"
    if kind == "far":
        # at a singular q (zero, or so near that no number tells it from zero) the force ellipsoid
        # has an endless half axis and the condition number is infinite, and that is right
        endless = name in ("ellipsoid", "dexterity")
        sound = (lambda x: ~np.isnan(x)) if endless else np.isfinite
        finite = all(sound(x).all() for x in have)
        clean_finite = all(np.isfinite(x).all() for x in _clean_answer(name))
        return (
            ("right", "")
            if finite or not clean_finite
            else ("wrong", "an answer that is not finite")
        )
    assert want is not None
    if len(have) != len(want) or any(a.shape != b.shape for a, b in zip(have, want, strict=True)):
        return "wrong", "an answer of another shape"
    for a, b in zip(have, want, strict=True):
        if not np.allclose(a, b, rtol=1e-9, atol=1e-9, equal_nan=True):
            return "wrong", f"differs from the clean answer by {np.nanmax(np.abs(a - b)):.1e}"
    return "right", ""


def judge_clean(name: str) -> tuple[str, str]:
    """The clean call itself must work, or the campaign says nothing about it."""
    numbers = _clean_answer(name)
    if name in (
        "DHLink",
        "DHTable",
        "FiveBar",
        "load",
        "load tool",
        "to_urdf",
        "to_dh",
        "redundancy",
    ):
        return "right", ""
    return ("right", "") if numbers else ("wrong", "no numbers to compare")
