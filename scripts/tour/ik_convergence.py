"""Newton, gradient and damped least squares side by side, near and far from a singularity.

    python scripts/tour/ik_convergence.py

The note says: Newton is fast but bad near singularities; gradient descent is slow but has no
singularity problem. Both are shown as numbers (``results/ik_convergence.md``) and drawn
(``ik_convergence.png``): the Puma with one start each, at random states (far), and with the wrist
or elbow nearly straight at the start and at the target (near).
"""

from __future__ import annotations

import argparse
from pathlib import Path

import numpy as np

import kinlab as kl
from kinlab.host.files import write_text
from kinlab.plots.canvas import new_axes, save
from kinlab.plots.searches import ik_history

METHODS = {
    "Newton, J⁻¹": {"method": "newton"},
    "gradient, exact step": {"method": "gradient"},
    "gradient, α = 0.05": {"method": "gradient", "alpha": 0.05},
    "damped (LM)": {"method": "lm"},
}
ROBOT = "puma560"
ELBOW, WRIST = 2, 4


def cases(robot: kl.Robot, count: int, away: float) -> dict[str, list[tuple[np.ndarray, ...]]]:
    """Starts and targets ``away`` radians apart in every joint, far from and near singularity."""
    rng = np.random.default_rng(0)
    straight = float(np.arctan2(0.0203, 0.4331))  # elbow angle of the stretched Puma, less pi/2
    found: dict[str, list[tuple[np.ndarray, ...]]] = {"far": [], "near": []}
    while len(found["far"]) < count or len(found["near"]) < count:
        q = rng.uniform(robot.lower + 0.4, robot.upper - 0.4)
        jac = kl.jacobian(robot, q)
        sigma = np.linalg.svd(jac, compute_uv=False)
        start = q + away * rng.choice([-1.0, 1.0], 6)
        if sigma[-1] / sigma[0] > 0.05 and len(found["far"]) < count:
            found["far"].append((start, kl.fk(robot, q)))
        if len(found["near"]) < count:
            near, begin = q.copy(), start.copy()
            # the wrist's axes 4 and 6 within a milliradian at the start, and again at the target
            begin[WRIST], near[WRIST] = 1e-3 * rng.choice([-1, 1]), 2e-3 * rng.choice([-1, 1])
            if rng.random() < 0.5:
                begin[ELBOW] = np.pi / 2 - straight + 1e-3
            found["near"].append((begin, kl.fk(robot, near)))
    return found


def main() -> None:
    """Runs all cases, prints the table and draws one case of each kind."""
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--count", type=int, default=100)
    parser.add_argument("--output", type=Path, default=Path(__file__).parent / "results")
    options = parser.parse_args()
    robot = kl.load(ROBOT)
    lines = [
        f"`python scripts/tour/ik_convergence.py`: {ROBOT}, {options.count} targets each, one "
        "start 0.2 rad away in every joint, at most 20,000 iterations (given up when the "
        "squared error has not halved in 10, 1000 or 5 of Newton, gradient or LM), tolerance "
        "1e-6 m and 1e-6 rad.",
        "",
        "| start and target | method | solved % | median iterations | worst growth of the error | "
        "largest step, rad |",
        "|---|---|---|---|---|---|",
    ]
    figure = new_axes(size=(11.0, 4.6)).figure
    figure.clear()
    panels = dict(zip(("far", "near"), figure.subplots(1, 2, sharey=True), strict=True))
    for kind, pairs in cases(robot, options.count, 0.2).items():
        drawn = {}
        for label, choice in METHODS.items():
            answers = [
                kl.ik(robot, T, q, **choice, restarts=0, max_iterations=20000, history=True)
                for q, T in pairs
            ]
            solved = [a.iterations for a in answers if a.success]
            growth, step = 0.0, 0.0
            for a in answers:
                error = a.history.position_error + a.history.rotation_error
                growth = max(growth, float(error.max() / error[0]))
                if len(error) > 1:
                    step = max(step, float(np.abs(np.diff(a.history.q, axis=0)).max()))
            lines.append(
                f"| {kind} | {label} | {100 * len(solved) / len(pairs):.0f} | "
                f"{np.median(solved) if solved else float('nan'):.0f} | {growth:.1f} | {step:.1f} |"
            )
            drawn[label] = answers[0].history
        ik_history(drawn, ax=panels[kind])
        panels[kind].set_title(
            {"far": "far from a singularity", "near": "near a singularity"}[kind]
        )
    panels["near"].set_ylabel("")
    text = "\n".join(lines) + "\n"
    write_text(options.output / "ik_convergence.md", text)
    save(panels["far"], options.output / "ik_convergence.png")
    print(text)


if __name__ == "__main__":
    main()
