"""Check and doctor ask Pinocchio, however many states: kinlab's own kernels are not even loaded."""

from __future__ import annotations

import json
import subprocess
import sys
from pathlib import Path

import numpy as np
import pytest

import kinlab as kl
from kinlab.engine import dynamics, kinematics
from kinlab.engine.fast import stacks

CHECK = """
import sys
from kinlab.cli import main
sys.argv = ["kinlab", *{arguments!r}]
try:
    main()
except SystemExit as ended:
    assert not ended.code or {fails}, ended.code
"""
DIAGNOSE = """
import numpy as np, kinlab as kl
robot = kl.load("puma560")
for quantity in ("fk", "jacobian", "coriolis_matrix", "potential_energy", "mass_matrix"):
    found = kl.diagnose(robot, quantity, lambda *state: 2.0 * np.asarray(
        getattr(kl, quantity)(robot, *state)), samples=300)
    assert found.causes and found.causes[0].kinds == ("factor",), found
"""
FORMULAS = """
robot = "planar2r"
[formulas]
g1 = "m1*g*l1*cos(q1) + m2*g*l2*cos(q1+q2) + m2*g*l1*sin(q1)"
"""


def modules_after(code: str, folder: Path) -> set[str]:
    """What a fresh interpreter has imported once it has run the code."""
    tail = "\nimport json, sys\nprint(chr(10) + json.dumps(sorted(sys.modules)))"
    done = subprocess.run(
        [sys.executable, "-c", code + tail], capture_output=True, text=True, cwd=folder, check=False
    )
    assert done.returncode == 0, done.stderr
    return set(json.loads(done.stdout.splitlines()[-1]))


@pytest.mark.parametrize(
    ("arguments", "fails"),
    [
        (["check", "puma560", "--samples", "300"], False),
        (["check", "f.toml", "--samples", "300"], True),
    ],
)
def test_check_loads_no_kernel(arguments, fails, tmp_path):
    (tmp_path / "f.toml").write_text(FORMULAS, encoding="utf-8")
    loaded = modules_after(CHECK.format(arguments=arguments, fails=fails), tmp_path)
    assert "kinlab.check.catalogue" in loaded and "pinocchio" in loaded
    assert "numba" not in loaded


def test_the_doctor_loads_no_kernel(tmp_path):
    loaded = modules_after(DIAGNOSE, tmp_path)
    assert "kinlab.doctor.examine" in loaded
    assert "numba" not in loaded


ENGINE = {
    "fk": (kinematics.fk, 1),
    "jacobian": (kinematics.jacobian, 1),
    "mass_matrix": (dynamics.mass_matrix, 1),
    "coriolis_matrix": (dynamics.coriolis_matrix, 2),
    "gravity_torques": (dynamics.gravity_torques, 1),
    "inverse_dynamics": (dynamics.inverse_dynamics, 3),
    "forward_dynamics": (dynamics.forward_dynamics, 3),
    "kinetic_energy": (dynamics.kinetic_energy, 2),
    "potential_energy": (dynamics.potential_energy, 1),
}


@pytest.mark.parametrize("name", ENGINE)
def test_a_long_stack_of_the_engine_is_its_single_calls_bit_for_bit(name):
    """The fast road differs by rounding, so equality to the last bit tells the roads apart."""
    function, inputs = ENGINE[name]
    robot = kl.load("puma560")
    states = np.random.default_rng(4).uniform(-2.5, 2.5, (inputs, 300, robot.n))
    whole = function(robot, *states)
    singles = [function(robot, *row) for row in zip(*states, strict=True)]
    if name == "kinetic_energy":  # ½ v^T M v is summed by numpy, in another order for a stack
        assert whole == pytest.approx(np.array(singles), rel=1e-14)
    else:
        assert np.array_equal(whole, np.stack(singles))


@pytest.mark.parametrize("frame", ["base", "tool", "spatial"])
def test_statics_of_a_long_stack(frame):
    robot = kl.load("puma560")
    rng = np.random.default_rng(5)
    q, wrench = rng.uniform(-2.5, 2.5, (300, 6)), rng.standard_normal((300, 6))
    for one in (wrench, wrench[0]):
        got = stacks.statics(robot, q, one, frame)
        assert got == pytest.approx(kinematics.statics(robot, q, one, frame), abs=1e-12)


def test_the_two_roads_have_one_description():
    fast = [name for name in ENGINE if hasattr(stacks, name)]
    assert {"fk", "jacobian", "inverse_dynamics", "forward_dynamics"} <= set(fast)
    for name, (function, _) in ENGINE.items():
        if name in fast:
            assert getattr(stacks, name).__doc__ == function.__doc__
            assert getattr(kl, name) is getattr(stacks, name)
        else:
            assert getattr(kl, name) is function
