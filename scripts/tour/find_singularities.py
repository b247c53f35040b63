"""Where is an arm singular, what is lost there, and how far away is it?

    python scripts/tour/find_singularities.py                 # puma560
    python scripts/tour/find_singularities.py ur5 --output loci.png

Prints det J in factors with their meaning, the families of singular configurations, and the
nearest one to a pose; draws the singular curves over joints 2 and 3.
"""

from __future__ import annotations

import argparse

import numpy as np

import kinlab as kl


def main() -> None:
    options = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    options.add_argument("robot", nargs="?", default="puma560")
    options.add_argument("--output", default="singular_curves.png")
    chosen = options.parse_args()
    robot = kl.load(chosen.robot)

    determinant = kl.factored_determinant(robot)
    print(f"{robot.name}, task {determinant.task}: det J = {determinant.expression}")
    for factor in determinant.factors:
        print(f"  zero of {factor.expression}: {factor.meaning}")

    for family in kl.find_singularities(robot).families:
        first = family.representative
        print(f"{family.kind:18} decided by {', '.join(family.deciding)}; rank {first.rank}; "
              f"lost: {first.lost_direction}")  # fmt: skip

    q = np.random.default_rng(1).uniform(robot.lower, robot.upper)
    near = kl.nearest_singularity(robot, q)
    print(f"q = {np.round(q, 3)}: {near.singularity.kind} singularity at {near.distance:.4f} rad, "
          f"q = {np.round(near.singularity.q, 3)}")  # fmt: skip

    from kinlab.plots import canvas, curves

    axes = curves.singular_loci(robot, kl.singular_loci(robot, [1, 2], q))
    print(f"wrote {canvas.save(axes, chosen.output)}")


if __name__ == "__main__":
    main()
