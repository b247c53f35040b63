"""Designed five-bars against brute force: is any linkage of a fine grid better than the optimum?

python scripts/bench/fivebar_design.py [--side 24] [--boxes 3]
"""

from __future__ import annotations

import argparse

import numpy as np

import kinlab as kl
from kinlab.fivebar.bounds.enclosure import smooth_pose
from kinlab.fivebar.design.goals import Candidates

BOXES = ((-0.2, 0.15, -0.65, -0.5), (-0.3, 0.3, -0.5, -0.3), (-0.05, 0.25, -0.9, -0.6))
RANGES = {"l1": (0.1, 1.0), "l2": (0.1, 1.2), "e": (0.0, 0.6)}


def conditions(lengths: np.ndarray, box: tuple[float, ...], side: int = 9) -> np.ndarray:
    """Worst condition number of many linkages over a grid of places; infinite out of reach."""
    x, y = np.meshgrid(np.linspace(*box[:2], side), np.linspace(*box[2:], side))
    points = np.stack([x.ravel(), y.ravel()], axis=1)
    rows = np.repeat(lengths, len(points), axis=0)
    bars = Candidates(*(np.repeat(rows[:, k : k + 1], 2, axis=1) for k in (0, 1)), rows[:, 2])
    with np.errstate(all="ignore"):
        pose = smooth_pose(bars, np.tile(points, (len(lengths), 1)), np.array([-1.0, 1.0]))
        jac = pose.w / (bars.l1 * pose.sine)[..., None]
    fine = np.isfinite(jac).all(axis=(1, 2))
    kappa = np.full(len(jac), np.inf)
    kappa[fine] = np.linalg.cond(jac[fine])
    kappa = kappa.reshape(len(lengths), -1)
    sides = np.sign(pose.rods).reshape(kappa.shape)
    one = np.abs(np.nan_to_num(sides).sum(axis=1)) == kappa.shape[1]
    return np.where(one, kappa.max(axis=1), np.inf)


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--side", type=int, default=24)
    parser.add_argument("--boxes", type=int, default=len(BOXES))
    options = parser.parse_args()
    axes = [np.linspace(*RANGES[name], options.side) for name in RANGES]
    grid = np.stack(np.meshgrid(*axes), axis=-1).reshape(-1, 3)
    for box in BOXES[: options.boxes]:
        found = kl.design_fivebar(box, **RANGES).goals["condition"]
        parts = np.array_split(grid, max(1, len(grid) // 500))
        best = min(float(conditions(part, box).min()) for part in parts)
        verdict = "never worse" if found.value <= best * (1 + 1e-9) else "WORSE"
        print(
            f"{box}: optimum {found.value:.6f}, proved to {found.bound:.6f}; best of "
            f"{len(grid)} linkages {best:.6f}: {verdict}"
        )


if __name__ == "__main__":
    main()
