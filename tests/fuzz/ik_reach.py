"""How many reachable poses inverse kinematics misses; false successes by an own forward kinematics.

    python tests/fuzz/ik_reach.py --poses 500000 --folder reach     # again: goes on
    python tests/fuzz/ik_reach.py --poses 20000 --folder small --allowed 1

Poses are those of joint vectors drawn over the whole joint range (seven tenths), at or near a
limit (two tenths), and with joints at multiples of a quarter turn, where wrists and elbows are
singular (one tenth). Every chunk is a file; the exit code is 0 where at most `--allowed` poses
are missed and no success is false.
"""

from __future__ import annotations

import argparse
import json
import sys
import time
from pathlib import Path

import numpy as np
import urdf_oracle

ARMS = [
    "puma560",
    "ur5",
    "panda",
    "stanford",
    "erd:kinova",
    "erd:xarm7",
    "erd:z1",
    "erd:ur3",
    "erd:so100",
    "erd:bravo7_no_ee",
]
CHUNK = 2500


def own_poses(tree: urdf_oracle.Tree, tool: str, names: list[str], q: np.ndarray) -> np.ndarray:
    """Poses of the tool by the own reading of the URDF, (N, 4, 4)."""
    out = np.broadcast_to(np.eye(4), (len(q), 4, 4)).copy()
    for joint in urdf_oracle.chain_to(tree, tool):
        out = out @ joint.place
        if joint.name not in names:
            continue
        x = q[:, names.index(joint.name)]
        step = np.broadcast_to(np.eye(4), out.shape).copy()
        if joint.kind == "prismatic":
            step[:, :3, 3] = x[:, None] * joint.axis
        else:
            k = joint.axis
            skew = np.array([[0, -k[2], k[1]], [k[2], 0, -k[0]], [-k[1], k[0], 0]])
            step[:, :3, :3] += np.sin(x)[:, None, None] * skew + (1 - np.cos(x))[:, None, None] * (
                skew @ skew
            )
        out = out @ step
    return out


def draw(rng: np.random.Generator, lower: np.ndarray, upper: np.ndarray, count: int) -> np.ndarray:
    """Joint vectors within the limits: anywhere, near limits, and at singular angles."""
    q = rng.uniform(lower, upper, (count, len(lower)))
    near = rng.random(count) < 0.2
    side = np.where(rng.random(q.shape) < 0.5, lower, upper)
    inward = (
        np.where(side == lower, 1.0, -1.0) * 10.0 ** rng.uniform(-9, -1, q.shape) * (upper - lower)
    )
    at_limit = near[:, None] & (rng.random(q.shape) < 0.4)
    q = np.where(at_limit, side + inward, q)
    odd = ~near & (rng.random(count) < 0.125)
    quarter = np.round(q / (np.pi / 2)) * (np.pi / 2) + 10.0 ** rng.uniform(-12, -2, q.shape)
    q = np.where(odd[:, None] & (rng.random(q.shape) < 0.5), quarter, q)
    return np.clip(q, lower, upper)


def chunk(arm: str, index: int, seed: int) -> dict[str, object]:
    """Asks one chunk of poses of one arm."""
    import kinlab as kl

    robot = kl.load(arm)
    tree = urdf_oracle.read(robot.urdf)
    names, tool = list(robot.joint_names), robot.tool_name
    q = draw(
        np.random.default_rng([seed, ARMS.index(arm) if arm in ARMS else 99, index]),
        robot.lower,
        robot.upper,
        CHUNK,
    )
    poses = own_poses(tree, tool, names, q)
    started = time.perf_counter()
    answer = kl.ik_batch(robot, poses, seed=index)
    seconds = time.perf_counter() - started
    success = np.asarray(answer.success)
    found = np.asarray(answer.q)
    back = own_poses(tree, tool, names, found)
    position = np.linalg.norm(back[:, :3, 3] - poses[:, :3, 3], axis=1)
    relative = np.swapaxes(back[:, :3, :3], 1, 2) @ poses[:, :3, :3]
    vector = np.stack(
        [
            relative[:, 2, 1] - relative[:, 1, 2],
            relative[:, 0, 2] - relative[:, 2, 0],
            relative[:, 1, 0] - relative[:, 0, 1],
        ],
        1,
    )
    angle = np.arctan2(np.linalg.norm(vector, axis=1), np.trace(relative, axis1=1, axis2=2) - 1)
    inside = ((found >= robot.lower) & (found <= robot.upper)).all(axis=1)
    good = (position <= 1.001e-6) & (angle <= 1.001e-6) & inside
    return {
        "arm": arm, "index": index, "poses": CHUNK, "missed": int((~success).sum()), "false": int((success & ~good).sum()), "seconds": seconds,
        "missed q": q[~success].tolist(), "status": [str(s) for s in np.asarray(getattr(answer, "status", []))[~success]][:CHUNK],
        "false q": q[success & ~good].tolist(),
    }  # fmt: skip


def main() -> int:
    """Runs the chunks that are missing and prints the counts."""
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--poses", type=int, default=500_000)
    parser.add_argument("--folder", type=Path, default=Path("ik_reach"))
    parser.add_argument("--seed", type=int, default=0)
    parser.add_argument("--allowed", type=int, default=20)
    parser.add_argument("--arms", default=",".join(ARMS))
    options = parser.parse_args()
    arms = options.arms.split(",")
    options.folder.mkdir(parents=True, exist_ok=True)
    each = -(-options.poses // (CHUNK * len(arms)))
    total: dict[str, list[int]] = {arm: [0, 0, 0] for arm in arms}
    print(f"seed {options.seed}, {each * CHUNK * len(arms)} poses")
    for index in range(each):
        for arm in arms:
            file = options.folder / f"{options.seed}-{arm.replace(':', '_')}-{index:04d}.json"
            if not file.is_file():
                part = file.with_suffix(".part")
                part.write_text(json.dumps(chunk(arm, index, options.seed)))
                part.rename(file)
            done = json.loads(file.read_text())
            for i, key in enumerate(("poses", "missed", "false")):
                total[arm][i] += done[key]
    for arm, (poses, missed, false) in total.items():
        print(f"{arm:16s} {poses:8d} poses, missed {missed:4d}, false successes {false}")
    missed, false = (sum(t[i] for t in total.values()) for i in (1, 2))
    print(
        f"{'all':16s} {sum(t[0] for t in total.values()):8d} poses, missed {missed:4d}, false successes {false}"
    )
    return int(missed > options.allowed or false > 0)


if __name__ == "__main__":
    sys.exit(main())
