"""What kinlab makes of one URDF text, beside the own reading."""

from __future__ import annotations

import os
import sys
import tempfile
from pathlib import Path

import numpy as np
import urdf_oracle

import kinlab as kl

TOLERANCE = 1e-9


def judge(case: tuple[str, str | None, int]) -> tuple[str, str]:
    """Loads the text and compares pose, mass matrix, gravity torques, limits and order."""
    text, tool, seed = case
    try:
        tree: urdf_oracle.Tree | None = urdf_oracle.read(text)
        why = ""
    except urdf_oracle.Unreadable as problem:
        tree, why = None, str(problem)
    robot = kl.Robot.from_urdf(text, tool)
    if tree is None:
        return "wrong", f"accepted although {why}"
    end = tool or robot.tool_name
    if end not in tree.links:
        return "wrong", f"the tool {end!r} is no link"
    try:
        chain = [j for j in urdf_oracle.chain_to(tree, end) if j.kind != "fixed"]
    except (urdf_oracle.Unreadable, StopIteration):
        return "wrong", "accepted although the links form a loop"
    if any(joint.kind not in urdf_oracle.MOVING or joint.mimic for joint in chain):
        return "wrong", "accepted a mimic or multi-freedom joint on the way to the tool"
    if tool is None and any(
        end in [j.child for j in urdf_oracle.chain_to(tree, joint.parent)]
        for joint in tree.joints
        if joint.kind in urdf_oracle.MOVING
    ):
        return "wrong", f"the tool {end!r} has moving joints behind it"
    if robot.n != len(chain):
        return "wrong", f"{robot.n} joints where the file has {len(chain)}"
    if list(robot.joint_names) != [joint.name for joint in chain]:
        return "wrong", f"joints {robot.joint_names}"
    for i, joint in enumerate(chain):
        if joint.kind != "continuous" and (robot.lower[i], robot.upper[i]) != (
            joint.lower,
            joint.upper,
        ):
            return "wrong", f"limits of {joint.name!r}: {robot.lower[i]}, {robot.upper[i]}"
    rng = np.random.default_rng(seed)
    heavy = True
    for q in rng.uniform(-1.0, 1.0, (2, robot.n)):
        with np.errstate(all="ignore"):
            own = urdf_oracle.answers(tree, end, q)
        if not all(np.isfinite(value).all() for value in own.values()):
            try:  # beyond what doubles can hold: only a refusal or a NaN-free answer will do
                T = kl.fk(robot, q)
            except kl.KinlabError as problem:
                return "refused", str(problem)
            return (
                ("wrong", "answers beyond doubles") if not np.isfinite(T).all() else ("right", "")
            )
        for name in ("fk", "mass_matrix", "gravity_torques"):
            if name != "fk" and not heavy:
                continue
            try:
                value = getattr(kl, name)(robot, q)
            except kl.KinlabError:
                if name == "fk":
                    raise
                heavy = False
                continue
            error = np.max(np.abs(value - own[name])) / float(own[f"{name} size"])
            if not error <= TOLERANCE:
                return "wrong", f"{name} differs by {error:.1e}"
            if name == "fk":
                turn = value[:3, :3]
                if not np.allclose(turn @ turn.T, np.eye(3), atol=1e-9):
                    return "wrong", "fk is no rotation"
    return "right", ""


def judge_check(case: tuple[str, str | None, int]) -> tuple[str, str]:
    """``kinlab check`` of the text as a file: one exit code of 0, 1 or 2, never a traceback."""
    text, _, _ = case
    with tempfile.TemporaryDirectory() as folder:
        file = Path(folder) / "mutant.urdf"
        file.write_text(text, encoding="utf-8", errors="surrogatepass")
        return command(["check", str(file)], folder)


def command(words: list[str], folder: str | None = None) -> tuple[str, str]:
    """One command line in this process; its exit code, or the exception that escaped."""
    from kinlab.cli import main

    before, place = sys.argv, os.getcwd()  # noqa: PTH109
    try:
        sys.argv = ["kinlab", *words]
        if folder:
            os.chdir(folder)
        main()
        code: object = 0
    except SystemExit as end:
        code = end.code or 0
    finally:
        sys.argv = before
        os.chdir(place)
    if code in (0, 1):
        return "right", str(code)
    return ("refused", "2") if code == 2 else ("raw", f"exit code {code!r}")
