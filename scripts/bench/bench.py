"""Benchmark of kinlab beside raw Pinocchio, Robotics Toolbox and MuJoCo, in one run.

    python scripts/bench/bench.py                        # every section, a few minutes
    python scripts/bench/bench.py --sections single batch
    python scripts/bench/bench.py --compare old.json     # what changed against an earlier run

All parties of a row take turns on the same states, so that a busy machine troubles them alike.
A figure is the median over the rounds with its quartiles; a ratio is the median of the rounds'
own ratios. Each peer's answer is compared with kinlab's (``apart``) before it is timed. Writes
``scripts/bench/results/bench.json`` and ``bench.md``. Peers: ``pip install 'kinlab[bench]'``.
"""

from __future__ import annotations

import argparse
import importlib.metadata
import json
import os
import platform
import subprocess
import sys
import tempfile
import threading
import time
from collections.abc import Callable
from concurrent.futures import ProcessPoolExecutor
from contextlib import ExitStack
from datetime import UTC, datetime
from multiprocessing import active_children, get_context
from pathlib import Path
from typing import Any

import bench_parties as parties
import numpy as np

import kinlab as kl
from kinlab.engine.fast import stacks
from kinlab.engine.fast.threads import cores
from kinlab.host.files import read_text, write_text

RESULTS = Path(__file__).parent / "results"
STATES = (1, 10, 100, 1_000, 10_000, 100_000, 1_000_000)
JOINTS = (2, 4, 6, 7, 12, 25, 50)
Row = dict[str, Any]


def rounds(calls: dict[str, Callable[[], Any]], count: int, least: float) -> dict[str, np.ndarray]:
    """Seconds per call of each party: (count,) rounds in which the parties take turns.

    Args:
        calls: party to call.
        count: how many rounds.
        least: seconds that a party's turn lasts at least.
    """
    repeats = {}
    for party, call in calls.items():
        call()  # warm-up: compilation, caches, scratch data
        start = time.perf_counter()
        call()
        repeats[party] = max(1, int(least / (time.perf_counter() - start + 1e-9)))
    out = {party: np.empty(count) for party in calls}
    for i in range(count):
        for party, call in calls.items():
            start = time.perf_counter()
            for _ in range(repeats[party]):
                call()
            out[party][i] = (time.perf_counter() - start) / repeats[party]
    return out


def rows(
    section: str,
    what: str,
    calls: dict[str, Callable[[], Any]],
    n: int,
    states: int,
    **options: Any,
) -> list[Row]:
    """One row for each party; ratio = that party's time over kinlab's."""
    own = np.asarray(calls["kinlab"]())
    apart = {
        party: float(np.max(np.abs(np.asarray(call()) - own)) / max(1.0, np.max(np.abs(own))))
        for party, call in calls.items()
    }
    times = rounds(calls, options.get("count", 15), options.get("least", 0.01))
    out = []
    for party, seconds in times.items():
        low, middle, high = np.percentile(seconds, [25, 50, 75]) * 1e6 / states
        out.append(
            {
                "section": section,
                "what": what,
                "party": party,
                "joints": n,
                "states": states,
                "us": middle,
                "us_25": low,
                "us_75": high,
                "ratio": float(np.median(seconds / times["kinlab"])),
                "apart": apart[party],
            }
        )
    return out


def states_of(robot: kl.Robot, count: int | None) -> np.ndarray:
    """q, v, a: (3, n) or (3, count, n)."""
    shape = (3, robot.n) if count is None else (3, count, robot.n)
    return np.random.default_rng(0).uniform(-1.5, 1.5, shape)


def single() -> list[Row]:
    """One state at a time: kinlab, raw Pinocchio, Robotics Toolbox, MuJoCo."""
    out = []
    for name in ("puma560", "ur5"):
        robot = kl.load(name)
        assert robot.table is not None
        q, v, a = states_of(robot, None)
        others = {
            "pinocchio": parties.pinocchio_single(robot, q, v, a),
            "mujoco": parties.mujoco_single(robot, q, v, a),
            "toolbox": parties.toolbox_single(robot.table, q, v, a),
        }
        for what, own in parties.kinlab_single(robot, q, v, a).items():
            calls = {"kinlab": own}
            calls |= {party: known[what] for party, known in others.items() if what in known}
            out += rows(f"single {name}", what, calls, robot.n, 1)
    return out


def batch() -> list[Row]:
    """100,000 states of a 6-joint arm, on all cores."""
    robot, count = kl.load("ur5"), 100_000
    q, v, a = states_of(robot, count)
    own = parties.kinlab_single(robot, q, v, a)
    raw = parties.pinocchio_batch(robot, q, v, a, cores())
    own["fk + jacobian"] = lambda: (kl.fk(robot, q), kl.jacobian(robot, q))[1]
    own["singular values of J"] = lambda: stacks.singular_values(robot, q, np.arange(6))
    out = []
    for what, call in own.items():
        calls = {"kinlab": call}
        if what in raw:
            calls["pinocchio"] = raw[what]
        out += rows("batch ur5", what, calls, robot.n, count, count=5, least=0.0)
    return out


def growth() -> list[Row]:
    """How cost grows with the states of a call and with the joints."""
    out = []
    robot = kl.load("ur5")
    for count in STATES:
        q, v, a = states_of(robot, count)
        for what in ("inverse_dynamics", "fk", "jacobian", "mass_matrix"):
            call = parties.kinlab_single(robot, q, v, a)[what]
            out += rows("states", what, {"kinlab": call}, robot.n, count, count=5, least=0.002)
    for n in JOINTS:
        arm = kl.Robot.from_dh(parties.random_table(n))
        for count in (None, 10_000):
            for what, call in parties.kinlab_single(arm, *states_of(arm, count)).items():
                if what in ("jacobian_dot", "gravity_torques"):
                    continue
                section = "joints, single" if count is None else "joints, batch"
                calls = {"kinlab": call}
                out += rows(section, what, calls, n, count or 1, count=5, least=0.002)
    return out


def sweeps() -> list[Row]:
    """10^6 states on one worker and two, twice each in a process of its own.

    ``kept small``: pose and J are worked out, the position, sigma_min and condition kept, in
    memory. ``kept whole``: pose, J and both in parts on disk. ``running``: as the first, on
    worker processes that are there already (``executor=``). Peak memory is that of the
    parent and its workers together.
    """
    out = []
    for what in ("kept small", "kept small, running", "kept whole, on disk"):
        found: dict[int, list[list[float]]] = {1: [], 2: []}
        for _ in range(2):
            for workers, runs in found.items():
                code = f"import bench; bench.one_sweep({what!r}, {workers})"
                done = subprocess.run(
                    [sys.executable, "-c", code],
                    cwd=Path(__file__).parent,
                    text=True,
                    capture_output=True,
                    check=True,
                )
                runs.append(json.loads(done.stdout))
        assert len({run[2] for runs in found.values() for run in runs}) == 1, "answers differ"
        alone = np.median([run[0] for run in found[1]])
        for workers, runs in found.items():
            low, middle, high = np.percentile([run[0] for run in runs], [25, 50, 75])
            times = {"us": middle, "us_25": low, "us_75": high, "ratio": middle / alone}
            size = {"joints": 6, "states": 10**6, "memory_mb": max(run[1] for run in runs)}
            party = {"section": "sweep", "what": what, "party": f"workers: {workers}"}
            out.append({**party, **size, **times})
    return out


def one_sweep(what: str, workers: int) -> None:
    """Prints µs a state (seconds for all 10^6), peak memory in MB, and a sum over the answer."""
    robot = kl.load("ur5")
    whole = what.startswith("kept whole")
    names = ("pose" if whole else "position", "min_singular", "condition")
    names += ("jacobian",) if whole else ()
    kl.sweep(robot, names, 1000, workers=1)  # kernels loaded, or compiled once per machine
    with tempfile.TemporaryDirectory() as folder, ExitStack() as stack:
        options: dict[str, Any] = {"workers": workers, "folder": folder if whole else None}
        if what.endswith("running"):
            pool = ProcessPoolExecutor(workers, mp_context=get_context("spawn"))
            options = {"executor": stack.enter_context(pool)}
            kl.sweep(robot, names, 2**16, chunk=2**12, **options)
        sizes = [0.0]
        stop = threading.Event()
        watcher = threading.Thread(target=watch, args=(sizes, stop))
        watcher.start()
        start = time.perf_counter()
        result = kl.sweep(robot, names, 10**6, **options)
        seconds = time.perf_counter() - start
        stop.set()
        watcher.join()
        total = float(result["min_singular"].sum())
    print(json.dumps([seconds, max(sizes), total]))


def watch(sizes: list[float], stop: threading.Event) -> None:
    """Adds the memory of this process and its workers, in MB, every 0.1 s until told to stop."""
    while not stop.wait(0.1):
        sizes.append(memory(os.getpid()) + sum(memory(w.pid) for w in active_children()))


def memory(pid: int | None) -> float:
    """A process's share of resident memory in MB (Linux); 0 if it has gone.

    Its share (Pss): what it has in common with other processes counts in part.
    """
    try:
        text = Path(f"/proc/{pid}/smaps_rollup").read_text(encoding="ascii")
    except OSError:
        return 0.0
    return int(text.split("Pss:")[1].split()[0]) / 1024


def cold() -> list[Row]:
    """A process from start to end."""
    commands = {
        "import kinlab": ["-c", "import kinlab"],
        "kinlab check planar2r": ["-m", "kinlab", "check", "planar2r"],
    }
    out = []
    for what, command in commands.items():

        def call(command: list[str] = command) -> int:
            done = subprocess.run([sys.executable, *command], capture_output=True, check=False)
            return done.returncode

        if call() == 0:
            out += rows("cold start", what, {"kinlab": call}, 0, 1, count=5, least=0.0)
    return out


SECTIONS = {"single": single, "batch": batch, "growth": growth, "sweep": sweeps, "cold": cold}


def machine() -> dict[str, Any]:
    """What the figures depend on."""
    packages = ("pin", "numpy", "numba", "mujoco", "roboticstoolbox-python")
    versions = {}
    for package in packages:
        try:
            versions[package] = importlib.metadata.version(package)
        except importlib.metadata.PackageNotFoundError:
            versions[package] = "not installed"
    return {
        "date": datetime.now(UTC).date().isoformat(),
        "python": platform.python_version(),
        "system": f"{platform.system()} {platform.machine()}",
        "cores": cores(),
        "load": round(os.getloadavg()[0], 2),
        "versions": versions,
    }


def key(row: Row) -> tuple[Any, ...]:
    """What makes two rows of two runs the same."""
    return tuple(row[k] for k in ("section", "what", "party", "joints", "states"))


def markdown(report: dict[str, Any], old: dict[str, Any] | None) -> str:
    """The report as one table a section."""
    before = {key(row): row for row in old["rows"]} if old else {}
    facts = {k: v for k, v in report["machine"].items() if k != "versions"}
    lines = ["# Benchmark", "", ", ".join(f"{k} {v}" for k, v in facts.items()) + "; "]
    lines[-1] += ", ".join(f"{k} {v}" for k, v in report["machine"]["versions"].items()) + "."
    for section in dict.fromkeys(row["section"] for row in report["rows"]):
        mine = [row for row in report["rows"] if row["section"] == section]
        lines += ["", f"## {section}", ""]
        head = ["", "party", "joints", "states", "µs a state", "quartiles", "x kinlab", "apart"]
        head += ["MB"] * ("memory_mb" in mine[0]) + ["µs, x before", "x kinlab before"] * bool(old)
        lines += ["| " + " | ".join(head) + " |", "|" + "---|" * len(head)]
        for row in mine:
            apart = f"{row['apart']:.0e}" if "apart" in row else ""
            cells = [row["what"], row["party"], row["joints"], row["states"], f"{row['us']:.3g}"]
            cells += [f"{row['us_25']:.3g} to {row['us_75']:.3g}", f"{row['ratio']:.2f}", apart]
            cells += [f"{row['memory_mb']:.0f}"] if "memory_mb" in row else []
            if old:
                was = before.get(key(row))
                cells += (
                    [f"{row['us'] / was['us']:.2f}", f"{was['ratio']:.2f}"] if was else ["", ""]
                )
            lines.append("| " + " | ".join(str(cell) for cell in cells) + " |")
    return "\n".join(lines) + "\n"


def main() -> None:
    """Runs the sections and writes both files."""
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--sections", nargs="+", choices=SECTIONS, default=list(SECTIONS))
    parser.add_argument("--compare", type=Path, help="an earlier bench.json")
    parser.add_argument("--output", type=Path, default=RESULTS / "bench.json")
    options = parser.parse_args()
    old = json.loads(read_text(options.compare)) if options.compare else None
    report: dict[str, Any] = {"machine": machine(), "rows": []}
    for name in options.sections:
        start = time.perf_counter()
        report["rows"] += SECTIONS[name]()
        print(f"{name}: {time.perf_counter() - start:.0f} s", file=sys.stderr)
    text = markdown(report, old)
    options.output.parent.mkdir(parents=True, exist_ok=True)
    write_text(options.output, json.dumps(report, indent=1) + "\n")
    write_text(options.output.with_suffix(".md"), text)
    print(text)


if __name__ == "__main__":
    main()
