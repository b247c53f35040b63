"""Is an engine of our own for stacks of M, C and V worth having? It was removed; this is why.

    git worktree add ../with-own-engine d8e471d   # the last commit that has one, compiled
    python scripts/bench/second_engine.py ../with-own-engine

Parties, in processes of their own that take turns on the same states: that checkout's
``mass_matrix``, ``coriolis_matrix`` and ``potential_energy`` of (N, n); today's, one Pinocchio
call after the other; and Pinocchio on all cores. Ratios are medians over the rounds of a party's
time over that of the compiled engine, with quartiles. The rule: a second engine stays where it is
3 times faster than Pinocchio can be had, at every length of stack.
"""

from __future__ import annotations

import argparse
import os
import subprocess
import sys
import time
from collections.abc import Callable
from concurrent.futures import ThreadPoolExecutor
from pathlib import Path
from typing import Any

import numpy as np

ROOT = Path(__file__).resolve().parents[2]
LENGTHS = (300, 3_000, 30_000)
WHAT = ("mass_matrix", "coriolis_matrix", "potential_energy")
PARTIES = ("own engine", "one by one", "on threads")
ARM = "puma560"


def on_threads() -> dict[str, Callable[..., Any]]:
    """Pinocchio on all cores: M and C by its parallel Newton-Euler, V on threads of Python's.

    Without gravity a column of M is the torque of a unit acceleration at rest; a column of
    Christoffel's C is what the velocity torque's quadratic form makes of v and a unit vector.
    """
    import pinocchio as pin

    import kinlab as kl

    model = kl.load(ARM).model.copy()
    cores, n = len(os.sched_getaffinity(0)), model.nv
    datas, workers = [model.createData() for _ in range(cores)], ThreadPoolExecutor(cores)
    floating = model.copy()
    floating.gravity = pin.Motion.Zero()
    pool = pin.ModelPool(floating, cores)

    def torques(q: Any, v: Any, a: Any) -> Any:
        out = np.empty_like(q)
        pin.rneaInParallel(cores, pool, q.T, v.T, a.T, out.T)
        return out

    def mass_matrix(q: Any, v: Any) -> Any:
        still = np.zeros_like(q)
        columns = [torques(q, still, np.tile(unit, (len(q), 1))) for unit in np.eye(n)]
        return np.stack(columns, axis=2)

    def coriolis_matrix(q: Any, v: Any) -> Any:
        still, own = np.zeros_like(q), torques(q, v, np.zeros_like(q))
        columns = [
            0.5 * (torques(q, v + unit, still) - own - torques(q, still + unit, still))
            for unit in np.eye(n)
        ]
        return np.stack(columns, axis=2)

    def potential_energy(q: Any, v: Any) -> Any:
        out = np.empty(len(q))
        cuts = np.linspace(0, len(q), cores + 1).astype(int)

        def piece(k: int) -> None:
            ask, data = pin.computePotentialEnergy, datas[k]
            out[cuts[k] : cuts[k + 1]] = [ask(model, data, one) for one in q[cuts[k] : cuts[k + 1]]]

        list(workers.map(piece, range(cores)))
        return out

    return dict(zip(WHAT, (mass_matrix, coriolis_matrix, potential_energy), strict=True))


def serve(party: str) -> None:
    """Answers ``what N`` on standard input with the seconds of one warm call and a checksum."""
    if party == "on threads":
        calls = on_threads()
    else:
        import kinlab as kl

        robot = kl.load(ARM)
        calls = {
            "mass_matrix": lambda q, v: kl.mass_matrix(robot, q),
            "coriolis_matrix": lambda q, v: kl.coriolis_matrix(robot, q, v),
            "potential_energy": lambda q, v: kl.potential_energy(robot, q),
        }
    states = np.random.default_rng(0).uniform(-1.5, 1.5, (2, max(LENGTHS), 6))
    for name in calls:
        calls[name](*states[:, : LENGTHS[0]])
    for line in sys.stdin:
        name, count = line.split()
        q, v = states[:, : int(count)]
        start = time.perf_counter()
        out = calls[name](q, v)
        print(time.perf_counter() - start, float(np.sum(out)), flush=True)


def main() -> None:
    """Prints a line for each function and length."""
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("checkout", help="a checkout of d8e471d")
    parser.add_argument("--rounds", type=int, default=15)
    parser.add_argument("--party", choices=PARTIES, help=argparse.SUPPRESS)
    options = parser.parse_args()
    if options.party:
        serve(options.party)
        return
    helpers = {}
    for party in PARTIES:
        root = Path(options.checkout).resolve() if party == "own engine" else ROOT
        command = [sys.executable, __file__, options.checkout, "--party", party]
        helpers[party] = subprocess.Popen(
            command, stdin=subprocess.PIPE, stdout=subprocess.PIPE, text=True, cwd=root,
            env={**os.environ, "PYTHONPATH": str(root)},
        )  # fmt: skip
    print(f"{'function':17} {'states':>7}  own us/state    one by one / own     on threads / own")
    for name in WHAT:
        for length in LENGTHS:
            seconds: dict[str, list[float]] = {party: [] for party in PARTIES}
            for _ in range(options.rounds):
                sums = []
                for party, helper in helpers.items():
                    assert helper.stdin is not None and helper.stdout is not None
                    helper.stdin.write(f"{name} {length}\n")
                    helper.stdin.flush()
                    took, total = map(float, helper.stdout.readline().split())
                    seconds[party].append(took)
                    sums.append(total)
                assert np.allclose(sums, sums[0], rtol=1e-9), sums
            own = np.array(seconds["own engine"])
            told = ""
            for party in PARTIES[1:]:
                low, middle, high = np.percentile(np.array(seconds[party]) / own, [25, 50, 75])
                told += f"  {middle:5.2f} ({low:5.2f} to {high:5.2f})"
            print(f"{name:17} {length:7}  {1e6 * np.median(own) / length:12.3f}{told}")
    for helper in helpers.values():
        assert helper.stdin is not None
        helper.stdin.close()
        helper.wait()


if __name__ == "__main__":
    main()
