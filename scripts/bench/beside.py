"""This checkout beside another one, call by call, in one run.

    git worktree add ../before e4af8b4
    python scripts/bench/beside.py ../before
    python scripts/bench/beside.py ../before --rounds 40 --only ik

Each checkout runs in a process of its own; the two take turns on the same states, so that a busy
machine troubles them alike. A ratio is the median over the rounds of the time here over the time
there, with its quartiles: above 1 this checkout is slower.
"""

from __future__ import annotations

import argparse
import os
import subprocess
import sys
import time
from collections.abc import Callable
from pathlib import Path
from typing import Any

import numpy as np

ROOT = Path(__file__).resolve().parents[2]
LEAST = 0.02
"""Seconds that a turn lasts at least."""


def calls() -> dict[str, Callable[[], Any]]:
    """What is timed, by name: single calls and stacks, with the names of either checkout."""
    import kinlab as kl

    robot = kl.load("puma560")
    fivebar = kl.FiveBar.load("isotropic")
    q, v, a = np.random.default_rng(0).uniform(-1.0, 1.0, (3, 3000, robot.n))
    one = q[0], v[0], a[0]
    start = np.full(robot.n, 0.3)
    goal = kl.fk(robot, start + 0.05)
    poses = kl.fk(robot, q[:200])
    points = np.random.default_rng(1).uniform([-0.1, -0.6], [0.1, -0.4], (3000, 2))
    return {
        "fk": lambda: kl.fk(robot, one[0]),
        "jacobian": lambda: kl.jacobian(robot, one[0]),
        "mass_matrix": lambda: kl.mass_matrix(robot, one[0]),
        "inverse_dynamics": lambda: kl.inverse_dynamics(robot, *one),
        "forward_dynamics": lambda: kl.forward_dynamics(robot, *one),
        "gravity_torques": lambda: kl.gravity_torques(robot, one[0]),
        "manipulability": lambda: kl.manipulability(robot, one[0]),
        "ik": lambda: kl.ik(robot, goal, start),
        "ik_branches": lambda: kl.ik_branches(robot, goal),
        "Robot.from_dh": lambda: kl.Robot.from_dh(robot.table),
        "five-bar ik": lambda: fivebar.ik(points[0]),
        "fk, 3000": lambda: kl.fk(robot, q),
        "jacobian, 300": lambda: kl.jacobian(robot, q[:300]),
        "mass_matrix, 3000": lambda: kl.mass_matrix(robot, q),
        "inverse_dynamics, 3000": lambda: kl.inverse_dynamics(robot, q, v, a),
        "ik_batch, 200": lambda: kl.ik_batch(robot, poses),
        "five-bar ik, 3000": lambda: fivebar.ik(points),
    }


def serve() -> None:
    """Answers a name and a number of repetitions with the seconds that one call took."""
    known = calls()
    for line in sys.stdin:
        name, count = line.rstrip("\n").split("\t")
        call = known[name]
        if count == "0":  # warm-up, and how often a turn has to repeat
            call()
            start = time.perf_counter()
            call()
            print(max(1, int(LEAST / (time.perf_counter() - start + 1e-9))), flush=True)
            continue
        start = time.perf_counter()
        for _ in range(int(count)):
            call()
        print((time.perf_counter() - start) / int(count), flush=True)


def ask(helper: subprocess.Popen[str], name: str, count: int) -> float:
    """One turn of a checkout."""
    assert helper.stdin is not None and helper.stdout is not None
    helper.stdin.write(f"{name}\t{count}\n")
    helper.stdin.flush()
    return float(helper.stdout.readline())


def main() -> None:
    """Prints a line for each call."""
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("checkout", type=Path, nargs="?", help="the other one")
    parser.add_argument("--rounds", type=int, default=21)
    parser.add_argument("--only", default="", help="calls with this in their name")
    parser.add_argument("--serve", action="store_true", help=argparse.SUPPRESS)
    options = parser.parse_args()
    if options.serve:
        serve()
        return
    if options.checkout is None:
        parser.error("name the other checkout")
    here, there = (
        subprocess.Popen(
            [sys.executable, __file__, "--serve"],
            stdin=subprocess.PIPE,
            stdout=subprocess.PIPE,
            text=True,
            env={**os.environ, "PYTHONPATH": str(root.resolve())},
        )
        for root in (ROOT, options.checkout)
    )
    print(f"{'call':24} {'here, us':>10} {'there, us':>10}  ratio  quartiles")
    for name in calls():
        if options.only not in name:
            continue
        count = int(min(ask(here, name, 0), ask(there, name, 0)))
        pairs = np.array([(ask(here, name, count), ask(there, name, count))
                          for _ in range(options.rounds)])  # fmt: skip
        low, middle, high = np.percentile(pairs[:, 0] / pairs[:, 1], [25, 50, 75])
        ours, theirs = 1e6 * np.median(pairs, axis=0)
        print(f"{name:24} {ours:10.2f} {theirs:10.2f}  {middle:5.2f}  {low:.2f} to {high:.2f}")
    for helper in (here, there):
        assert helper.stdin is not None
        helper.stdin.close()
        helper.wait()


if __name__ == "__main__":
    main()
