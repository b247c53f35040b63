"""Benchmark of inverse kinematics by TRAC-IK's protocol: random reachable poses, one run for all.

    python scripts/bench/bench_ik.py                    # every arm, 10,000 poses, installed peers
    python scripts/bench/bench_ik.py --arms ur5 panda --poses 1000

Every party gets the same poses of the whole joint range, in one process, at the same accuracy
(1e-6 m and 1e-6 rad). An answer counts only if it lies within the limits and a forward
kinematics that shares no code with any party (numpy over the URDF's XML) finds it within the
tolerance. Writes ``scripts/bench/results/bench_ik.json`` and ``bench_ik.md``.
"""

from __future__ import annotations

import argparse
import json
import platform
import time
from collections.abc import Callable
from datetime import UTC, datetime
from pathlib import Path
from typing import Any
from xml.etree import ElementTree

import ik_peers as peers
import numpy as np

import kinlab as kl
from kinlab.engine.fast.threads import wanted_threads
from kinlab.host.files import write_text
from kinlab.model.rotations import rpy_matrix

ARMS = {
    "puma560": None, "ur5": None, "ur10": None, "panda": None, "stanford": None,
    "erd:kinova": None, "erd:xarm7": None, "erd:talos_arm": None, "erd:z1": None, "erd:ur3": None,
    "erd:ur5_limited": None, "erd:so100": None, "erd:bravo7_no_ee": None,
}  # fmt: skip
TOLERANCE = 1e-6
PATIENCE = 10.0
"""Seconds after which a party's poses are cut short; how many it got is in the report."""
RESULTS = Path(__file__).parent / "results"


def urdf_fk(robot: kl.Robot, q: np.ndarray) -> np.ndarray:
    """Tool poses (N, 4, 4) of states (N, n), read from the URDF's XML; no Pinocchio, no kernel."""
    root = ElementTree.fromstring(robot.urdf)
    above = {j.find("child").get("link"): j for j in root.findall("joint")}
    order = {name: i for i, name in enumerate(robot.joint_names)}
    link, path = robot.tool_name, []
    while link in above:
        path.append(above[link])
        link = above[link].find("parent").get("link")
    pose = np.tile(np.eye(4), (len(q), 1, 1))
    for joint in reversed(path):
        origin = joint.find("origin")
        step = np.eye(4)
        if origin is not None:
            step[:3, :3] = rpy_matrix(*map(float, (origin.get("rpy") or "0 0 0").split()))
            step[:3, 3] = [float(v) for v in (origin.get("xyz") or "0 0 0").split()]
        pose = pose @ step
        if joint.get("type") == "fixed" or joint.get("name") not in order:
            continue
        axis = joint.find("axis")
        u = np.array([float(v) for v in (axis.get("xyz") if axis is not None else "1 0 0").split()])
        u /= np.linalg.norm(u)
        value = q[:, order[joint.get("name")], None, None]
        move = np.tile(np.eye(4), (len(q), 1, 1))
        if joint.get("type") == "prismatic":
            move[:, :3, 3] = value[:, :, 0] * u
        else:
            cross = np.cross(np.eye(3), u)
            turn = np.sin(value) * cross + (1 - np.cos(value)) * (cross @ cross)
            move[:, :3, :3] += turn
        pose = pose @ move
    return pose


def errors(robot: kl.Robot, q: np.ndarray, T: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """Metres and radians, by :func:`urdf_fk`."""
    pose = urdf_fk(robot, q)
    turn = np.swapaxes(pose[:, :3, :3], 1, 2) @ T[:, :3, :3]
    skew = turn - np.swapaxes(turn, 1, 2)
    sine = np.sqrt(skew[:, 2, 1] ** 2 + skew[:, 0, 2] ** 2 + skew[:, 1, 0] ** 2) / 2
    angle = np.arctan2(sine, (np.trace(turn, axis1=1, axis2=2) - 1) / 2)
    return np.linalg.norm(pose[:, :3, 3] - T[:, :3, 3], axis=1), angle


def judge(robot: kl.Robot, T: np.ndarray, answers: list[np.ndarray | None]) -> dict[str, Any]:
    """Success rate, false successes and worst error of what a party calls solved."""
    rows = [i for i, q in enumerate(answers) if q is not None]
    if not rows:
        return {"success_percent": 0.0, "called_solved": 0, "false_successes": 0}
    q = np.array([answers[i] for i in rows])
    position, angle = errors(robot, q, T[rows])
    # 1e-9: the URDF's own text, read twice, differs by so much
    close = (position <= TOLERANCE + 1e-9) & (angle <= TOLERANCE + 1e-9)
    inside = np.all((q >= robot.lower - 1e-12) & (q <= robot.upper + 1e-12), axis=1)
    return {
        "success_percent": round(100.0 * float((close & inside).sum()) / len(T), 3),
        "called_solved": len(rows),
        "false_successes": int((~(close & inside)).sum()),
        "worst_mm_of_solved": float(1e3 * position.max()),
        "worst_mrad_of_solved": float(1e3 * angle.max()),
    }


def timed(solve: Callable[[np.ndarray], Any], T: np.ndarray) -> tuple[list[Any], dict[str, float]]:
    """Answers and microseconds a pose, of this thread's processor time.

    All of these solvers run in the calling thread; its processor time leaves out what other
    programs on the machine take.
    """
    solve(T[0])
    took, answers = np.empty(len(T)), []
    began = time.perf_counter()
    for i, pose in enumerate(T):
        start = time.thread_time_ns()
        answers.append(solve(pose))
        took[i] = time.thread_time_ns() - start
        if time.perf_counter() - began > PATIENCE:
            break
    wall = time.perf_counter() - began
    took = 1e-3 * took[: len(answers)]
    return answers, {
        "median_us": round(float(np.median(took)), 2),
        "mean_us": round(float(took.mean()), 2),
        "p99_us": round(float(np.percentile(took, 99)), 2),
        "mean_wall_us": round(1e6 * wall / len(took), 2),
    }


def batch(robot: kl.Robot, T: np.ndarray) -> tuple[list[Any], dict[str, float]]:
    """``ik_batch`` on all processors: wall and processor time, the best of five calls."""
    kl.ik_batch(robot, T[:200])
    took, used = [], []
    for _ in range(5):
        start, begin = time.perf_counter(), time.process_time()
        answer = kl.ik_batch(robot, T)
        took.append(time.perf_counter() - start)
        used.append(time.process_time() - begin)
    good = zip(answer.q, answer.success, strict=True)
    mean, cost = (round(1e6 * float(min(x)) / len(T), 3) for x in (took, used))
    return [q if ok else None for q, ok in good], {"mean_us": mean, "processor_us": cost}


def parties(robot: kl.Robot, count: int) -> dict[str, tuple[Callable[[], Any], int, str]]:
    """Name to maker, number of poses, and kind (one, batch, branches)."""

    def kinlab(**options: Any) -> Callable[[np.ndarray], np.ndarray | None]:
        def solve(pose: np.ndarray) -> np.ndarray | None:
            answer = kl.ik(robot, pose, **options)
            return answer.q if answer.success else None

        away = np.eye(4)
        away[:3, 3] = 100.0
        solve(away)  # compiles what only a failed search runs
        return solve

    found: dict[str, tuple[Callable[[], Any], int, str]] = {
        "kinlab ik": (lambda: kinlab(), count, "one"),
        "kinlab ik, one search": (lambda: kinlab(restarts=0), count, "one"),
        "kinlab ik_batch": (lambda: None, count, "batch"),
    }
    if peers.installed("roboticstoolbox-python"):
        found["Robotics Toolbox ik_LM"] = (lambda: peers.rtb_lm(robot, 100), count, "one")
        found["Robotics Toolbox ik_LM, one search"] = (
            lambda: peers.rtb_lm(robot, 1), count, "one",
        )  # fmt: skip
    if peers.installed("ssik"):
        found["ssik, all branches"] = (lambda: peers.ssik_all(robot), count // 20, "branches")
    if peers.installed("EAIK"):
        found["EAIK, all branches"] = (lambda: peers.eaik_all(robot), count, "branches")
    if peers.installed("modern_robotics"):
        found["Modern Robotics IKinSpace, one start"] = (
            lambda: peers.modern_robotics_newton(robot), count // 50, "one",
        )  # fmt: skip
    if peers.installed("ikpy"):
        found["ikpy, one start"] = (
            lambda: peers.ikpy_least_squares(robot), max(count // 500, 5), "one",
        )  # fmt: skip
    return found


def run_arm(name: str, count: int) -> dict[str, Any]:
    """All parties on one arm."""
    robot = kl.load(name, ARMS.get(name))
    q = np.random.default_rng(2024).uniform(robot.lower, robot.upper, (count, robot.n))
    T = kl.fk(robot, q)
    check = max(float(e.max()) for e in errors(robot, q, T))
    if check > 1e-9:
        raise SystemExit(f"{name}: the two forward kinematics differ by {check:.2g}")
    rows: dict[str, Any] = {}
    for label, (make, poses, kind) in parties(robot, count).items():
        few = T[:poses]
        try:
            solve = make()
            answers, times = batch(robot, few) if kind == "batch" else timed(solve, few)
        except (ValueError, RuntimeError, NotImplementedError) as problem:
            rows[label] = {"left_out": str(problem).splitlines()[0][:100]}
            continue
        few = few[: len(answers)]
        extra: dict[str, Any] = {"poses": len(few)}
        if kind == "branches":
            extra["mean_branches"] = round(float(np.mean([len(a) for a in answers])), 2)
            answers = [a[0] if len(a) else None for a in answers]
        rows[label] = {**judge(robot, few, answers), **times, **extra}
    return {"n": robot.n, "fk_agreement": check, "parties": rows}


def unreachable_poses(robot: kl.Robot, count: int) -> np.ndarray:
    """Half out of reach; half in reach, but turned so that the last joint is out of its reach."""
    rng = np.random.default_rng(7)
    fixed, _ = peers.chain(robot)
    turn, shoulder = fixed[-1].reshape(3, 4)[:, :3], fixed[0, [3, 7, 11]]
    hand = turn.T @ fixed[-1, [3, 7, 11]]  # from the last joint to the tool, in the tool's axes
    sample = kl.fk(robot, rng.uniform(robot.lower, robot.upper, (max(8 * count, 50000), robot.n)))
    out = sample[:, :3, 3] - sample[:, :3, :3] @ hand - shoulder
    far = np.linalg.norm(out, axis=1)
    T = sample[:count].copy()
    T[:, :3, 3] *= (10.0 + rng.random(count) * 10.0)[:, None] / np.linalg.norm(
        T[:, :3, 3], axis=1, keepdims=True
    )
    turned = []
    for pose, ahead in zip(sample[np.argsort(-far)], out[np.argsort(-far)], strict=True):
        ahead = ahead / np.linalg.norm(ahead)
        new = np.eye(4)
        # z of the turned tool: its hand vector points at the shoulder
        have = pose[:3, :3] @ hand / np.linalg.norm(hand)
        half = have - ahead
        half /= np.linalg.norm(half)
        new[:3, :3] = (2.0 * np.outer(half, half) - np.eye(3)) @ pose[:3, :3]
        new[:3, 3] = shoulder + (1.02 * far.max() - 0.5 * np.linalg.norm(hand)) * ahead
        turned.append(new)
        if len(turned) == count:
            break
    stack = np.array(turned)
    reached = kl.ik_batch(robot, stack, task="position").success
    stack = stack[reached][: count - count // 2]
    return np.concatenate([T[: count - len(stack)], stack])


def run_unreachable(count: int) -> dict[str, Any]:
    """Arms with a 0.3 m stick, so that a turned tool provably cannot be had."""
    from dataclasses import replace

    stick = np.eye(4)
    stick[2, 3] = 0.3
    result: dict[str, Any] = {}
    for name in ("puma560", "ur10", "panda", "stanford"):
        table = kl.load(name).table
        robot = kl.Robot.from_dh(replace(table, tool=np.asarray(table.tool) @ stick))
        rng = np.random.default_rng(1)
        fine = kl.fk(robot, rng.uniform(robot.lower, robot.upper, (2000, robot.n)))
        T = unreachable_poses(robot, count // 4)
        answers, times = timed(lambda pose, robot=robot: kl.ik(robot, pose), T)
        _, reachable = timed(lambda pose, robot=robot: kl.ik(robot, pose), fine)
        status, number = np.unique([str(a.status) for a in answers], return_counts=True)
        turned = sum(a.restarts > 0 for a in answers)
        result[name] = {
            "poses": len(T),
            "in_reach_but_turned": int(turned),
            "called_success": int(sum(a.success for a in answers)),
            "status": dict(zip(map(str, status), map(int, number), strict=True)),
            **times,
            "reachable_mean_us": reachable["mean_us"],
            "cost_ratio_of_means": round(times["mean_us"] / reachable["mean_us"], 2),
        }
    return result


def ratios(arms: dict[str, Any]) -> dict[str, Any]:
    """kinlab against Robotics Toolbox, within this run."""
    out = {}
    for name, arm in arms.items():
        rows = arm["parties"]
        other = rows.get("Robotics Toolbox ik_LM", {})
        if "mean_us" not in other:
            continue
        ours, many = rows["kinlab ik"], rows["kinlab ik_batch"]
        out[name] = {
            "median": round(ours["median_us"] / other["median_us"], 3),
            "mean": round(ours["mean_us"] / other["mean_us"], 3),
            "batch_throughput_wall": round(other["mean_wall_us"] / many["mean_us"], 1),
            "batch_throughput_free": round(
                wanted_threads(None) * other["mean_us"] / many["processor_us"], 1
            ),
        }
    return out


def markdown(report: dict[str, Any]) -> str:
    """The report as tables."""
    lines = [
        f"{report['date']}, `{report['command']}`, {report['machine']}. Random poses of the whole "
        f"joint range, tolerance 1e-6 m and 1e-6 rad, same poses and one run for all; processor "
        f"time of the calling thread, for ik_batch wall time on {report['processors']} processors. "
        f"Peers: {', '.join(f'{k} {v}' for k, v in report['peers'].items()) or 'none'}.",
        "",
        "| arm | party | poses | success % | false * | worst mm | median µs | mean µs | p99 µs |",
        "|---|---|---|---|---|---|---|---|---|",
    ]
    for name, arm in report["arms"].items():
        for label, row in arm["parties"].items():
            if "left_out" in row:
                lines.append(f"| {name} | {label} | left out: {row['left_out']} | | | | | | |")
                continue
            worst = row.get("worst_mm_of_solved")
            cells = [
                name, label, row["poses"], row["success_percent"], row["false_successes"],
                "" if worst is None else f"{worst:.1e}", row.get("median_us", ""), row["mean_us"],
                row.get("p99_us", ""),
            ]  # fmt: skip
            lines.append("| " + " | ".join(map(str, cells)) + " |")
    lines += ["", "\\* Called solved, but outside the limits or the tolerance. Modern Robotics and "
              "ikpy's least squares do not look at limits."]  # fmt: skip
    if report["ratios"]:
        lines += [
            "",
            "Against Robotics Toolbox's ik_LM: kl.ik's time as a share of its; ik_batch's "
            "throughput as a multiple, by wall time in this run (other programs may have been "
            "running), and by processor time as if all processors were free.",
            "",
            "| arm | median | mean | ik_batch, wall | ik_batch, processors free |",
            "|---|---|---|---|---|",
        ]
        lines += [
            f"| {k} | " + " | ".join(map(str, v.values())) + " |"
            for k, v in report["ratios"].items()
        ]
    lines += [
        "",
        "| unreachable on | poses | of these in reach but turned | called success | mean µs | "
        "times a reachable one | status |",
        "|---|---|---|---|---|---|---|",
    ]
    for name, row in report["unreachable"].items():
        status = ", ".join(f"{k} {v}" for k, v in row["status"].items())
        cells = [
            f"{name} + 0.3 m", row["poses"], row["in_reach_but_turned"], row["called_success"],
            row["mean_us"], row["cost_ratio_of_means"], status,
        ]  # fmt: skip
        lines.append("| " + " | ".join(map(str, cells)) + " |")
    return "\n".join(lines) + "\n"


def main() -> None:
    """Runs the benchmark."""
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--arms", nargs="+", default=list(ARMS))
    parser.add_argument("--poses", type=int, default=10000)
    parser.add_argument("--unreachable", type=int, default=10000)
    parser.add_argument("--output", type=Path, default=RESULTS)
    options = parser.parse_args()
    arms = {}
    for name in options.arms:
        print(name, flush=True)
        arms[name] = run_arm(name, options.poses)
        for label, row in arms[name]["parties"].items():
            print("   ", label, row, flush=True)
    names = ("roboticstoolbox-python", "ssik", "EAIK", "modern_robotics", "ikpy")
    report = {
        "date": datetime.now(UTC).strftime("%Y-%m-%d"),
        "command": "python scripts/bench/bench_ik.py",
        "machine": f"{platform.machine()}, Python {platform.python_version()}",
        "processors": wanted_threads(None),
        "peers": {name: peers.installed(name) for name in names if peers.installed(name)},
        "arms": arms,
        "ratios": ratios(arms),
        "unreachable": run_unreachable(options.unreachable),
        "false_successes_of_kinlab": sum(
            row["false_successes"]
            for arm in arms.values()
            for label, row in arm["parties"].items()
            if label.startswith("kinlab")
        ),
    }
    options.output.mkdir(parents=True, exist_ok=True)
    write_text(options.output / "bench_ik.json", json.dumps(report, indent=1) + "\n")
    write_text(options.output / "bench_ik.md", markdown(report))
    print(markdown(report))


if __name__ == "__main__":
    main()
