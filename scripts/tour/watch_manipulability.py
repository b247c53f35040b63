"""Dexterity along a joint path of a Puma 560 that crosses a wrist singularity.

python scripts/tour/watch_manipulability.py --output path.png
"""

from __future__ import annotations

import argparse

import numpy as np

import kinlab as kl


def main() -> None:
    options = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    options.add_argument("--output", default="singular_values.png")
    chosen = options.parse_args()
    robot = kl.load("puma560")
    path = np.linspace([0.0, 0.6, -0.4, 0.3, -0.8, 0.2], [0.5, 0.2, 0.4, 0.1, 0.6, 0.2], 201)

    for kind in ("yoshikawa", "inverse_condition", "min_singular", "asada"):
        values = kl.manipulability(robot, path, kind)
        least = int(np.argmin(values))
        print(
            f"{kind:18} from {values.min():.3e} (q5 = {path[least, 4]:+.3f}) to {values.max():.3e}"
        )
    start = kl.dexterity(robot, path[0])
    best = kl.characteristic_length(robot, path[0])
    print(f"at the start: condition number {start.condition:.3f} with length {start.length} m,")
    print(f"    {best.condition:.3f} with the characteristic length {best.length:.4f} m")
    shape = kl.ellipsoid(robot, path[0], "velocity", "position")
    print(f"velocity ellipsoid of the tool point: semi-axes {shape.lengths.round(4)} m/s per rad/s")

    from kinlab.plots import canvas, curves

    print(f"wrote {canvas.save(curves.singular_values(robot, path), chosen.output)}")


if __name__ == "__main__":
    main()
