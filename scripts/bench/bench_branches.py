"""All branches of one pose: time and completeness beside ssik and EAIK, in one run.

    python scripts/bench/bench_branches.py --poses 300 --compare 10000

Random poses of the whole joint range, the same for all. Times are the processor time of one
thread a pose, the best of several rounds (a busy machine does not show in them); sets are compared
after forward kinematics has thrown out what misses 1e-8. Writes results/bench_branches.{json,md}.
"""

from __future__ import annotations

import argparse
import json
import platform
import sys
import time
from collections.abc import Callable
from importlib.metadata import version
from pathlib import Path
from typing import Any

import numpy as np

import kinlab as kl

HERE = Path(__file__).resolve().parent
sys.path.insert(0, str(next(p for p in HERE.parents if (p / "tests").is_dir()) / "tests/inverse"))

from arms import built_by_ssik, manseur_doty, random_arm  # noqa: E402

ARMS = {
    "Puma 560": "puma560_ik", "UR5": "ur5_ik", "UR10e": "ur10e_ik",
    "Kinova j2s6s300": "j2s6s300_ik",
    "Kinova JACO2 j2n6s200": "jaco2_ik", "xArm6": "xarm6_ik", "Fanuc CRX-10iA": "fanuc_crx10ia_ik",
}  # fmt: skip
"""Those for which ssik ships a built solver, taken from its numbers."""

SOUND, SAME = 1e-8, 1e-4
ROUNDS = 5


def clock(call: Callable[[], Any], poses: int) -> float:
    """Microseconds of this thread a pose, the best of some rounds."""
    call()
    best = np.inf
    for _ in range(ROUNDS):
        start = time.thread_time()
        call()
        best = min(best, time.thread_time() - start)
    return 1e6 * best / poses


def eaik_all(robot: kl.Robot) -> Callable[[np.ndarray], np.ndarray] | None:
    """EAIK from the axes at q = 0; ``None`` where it knows no decomposition."""
    try:
        from eaik.IK_HP import HPRobot
    except ImportError:
        return None
    home = kl.fk(robot, np.zeros(6))
    screws = kl.jacobian(robot, np.zeros(6), "spatial").T
    points = np.cross(screws[:, 3:], screws[:, :3])
    offsets = np.diff(np.vstack([points, home[:3, 3]]), axis=0, prepend=np.zeros((1, 3)))
    try:
        arm = HPRobot(screws[:, 3:].T, offsets.T)
        if not arm.hasKnownDecomposition():
            return None
    except (RuntimeError, ValueError, TypeError):
        try:
            arm = HPRobot(screws[:, 3:], offsets)
            if not arm.hasKnownDecomposition():
                return None
        except (RuntimeError, ValueError, TypeError):
            return None
    back = np.eye(4)
    back[:3, :3] = home[:3, :3].T

    def solve(pose: np.ndarray) -> np.ndarray:
        answer = arm.IK(pose @ back)
        rough = np.asarray(answer.is_LS, dtype=bool)
        return np.asarray(answer.Q).reshape(-1, 6)[~rough]

    return solve


def gap(q: np.ndarray, others: np.ndarray) -> float:
    """Distance to the nearest of others, whole turns aside."""
    if not len(others):
        return np.inf
    return float(np.abs((others - q + np.pi) % (2 * np.pi) - np.pi).max(axis=1).min())


def against(robot: kl.Robot, poses: np.ndarray, solve: Callable[[np.ndarray], np.ndarray]) -> dict:
    """How often the other has a solution that kinlab has not, and the reverse."""
    more = fewer = false_complete = 0
    for pose, mine in zip(poses, kl.ik_branches(robot, poses), strict=True):
        other = solve(pose)
        if len(other):
            error = np.abs(kl.fk(robot, other) - pose).max(axis=(1, 2))
            other = other[error < SOUND]
        lacking = any(gap(q, mine.q) > SAME for q in other)
        more += lacking
        false_complete += lacking and mine.complete
        fewer += any(gap(q, other) > SAME for q in mine.q)
    return {
        "poses": len(poses), "other has more": more, "kinlab has more": fewer,
        "complete said wrongly": false_complete,
    }  # fmt: skip


def measure(robot: kl.Robot, count: int, solve: Callable[[np.ndarray], np.ndarray] | None) -> dict:
    """Times and completeness of one arm."""
    q = np.random.default_rng(0).uniform(-np.pi, np.pi, (count, robot.n))
    poses = kl.fk(robot, q)
    row: dict[str, Any] = {}
    batch = kl.ik_branches(robot, poses, threads=1)
    row["method"] = batch.method
    row["one pose"] = clock(lambda: [kl.ik_branches(robot, T) for T in poses], count)
    row["stack"] = clock(lambda: kl.ik_branches(robot, poses, threads=1), count)
    start = time.perf_counter()
    kl.ik_branches(robot, poses)
    row["stack, all processors, wall"] = 1e6 * (time.perf_counter() - start) / count
    row["own q found"] = sum(gap(a, b.q) < 1e-6 for a, b in zip(q, batch, strict=True)) / count
    row["complete"] = float(batch.complete.mean())
    row["solutions"] = float(batch.counts.mean())
    row["worst error"] = float(
        max(np.nanmax(batch.position_error), np.nanmax(batch.rotation_error))
    )
    others = {
        "ssik": solve,
        "EAIK": eaik_all(robot) if not robot.name.startswith("random") else None,
    }
    for name, other in others.items():
        if other is None:
            continue
        row[name] = clock(lambda other=other: [other(T) for T in poses], count)
        row[f"{name} own q found"] = sum(
            gap(a, other(T)) < 1e-6 for a, T in zip(q, poses, strict=True)
        ) / count  # fmt: skip
    return row


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--poses", type=int, default=200, help="poses that are timed")
    parser.add_argument("--compare", type=int, default=500, help="poses whose sets are compared")
    parser.add_argument("--arms", nargs="*", help="some of the arms")
    options = parser.parse_args()
    rows = {}
    for name, built in ARMS.items():
        if options.arms and name not in options.arms:
            continue
        robot, _, solve = built_by_ssik(built)
        rows[name] = measure(robot, options.poses, solve)
        q = np.random.default_rng(1).uniform(-np.pi, np.pi, (options.compare, 6))
        rows[name]["sets"] = against(robot, kl.fk(robot, q), solve)
        print(name, rows[name], flush=True)
    if not options.arms:
        rows["general 6R"] = measure(random_arm(1), options.poses, None)
        rows["Manseur and Doty"] = measure(manseur_doty()[0], options.poses, None)
    machine = f"{platform.machine()}, Python {platform.python_version()}"
    parties = {name: version(name) for name in ("ssik", "EAIK")}
    folder = HERE / "results" if (HERE / "results").is_dir() else HERE.parent / "results"
    record = {"machine": machine, "versions": parties, "arms": rows}
    (folder / "bench_branches.json").write_text(json.dumps(record, indent=1) + "\n")
    lines = [
        "# All branches of one pose", "",
        f"Processor time of one thread, µs a pose, best of {ROUNDS} rounds ({machine}; ssik "
        f"{parties['ssik']}, EAIK {parties['EAIK']}). kinlab's times include the check of every "
        "branch by Pinocchio.", "",
        "| arm | method | one pose | stack | ssik | EAIK | solutions | complete | own q found: "
        "kinlab, ssik, EAIK | sets beside ssik |",
        "|---|---|---|---|---|---|---|---|---|---|",
    ]  # fmt: skip
    for name, row in rows.items():
        sets = row.get("sets")
        said = "" if sets is None else (
            f"{sets['poses']} poses: ssik more {sets['other has more']}, kinlab more "
            f"{sets['kinlab has more']}"
        )  # fmt: skip
        found = ", ".join(
            f"{100 * row[key]:.1f} %" if key in row else "-"
            for key in ("own q found", "ssik own q found", "EAIK own q found")
        )
        times = [
            f"{row[key]:.0f}" if key in row else "-"
            for key in ("one pose", "stack", "ssik", "EAIK")
        ]
        lines.append(
            f"| {name} | {row['method']} | {' | '.join(times)} | {row['solutions']:.2f} | "
            f"{100 * row['complete']:.1f} % | {found} | {said} |"
        )
    (folder / "bench_branches.md").write_text("\n".join(lines) + "\n")
    print("\n".join(lines))


if __name__ == "__main__":
    main()
