"""The dexterity of a planar arm over its workspace, with its boundary and singular curves.

python scripts/tour/map_workspace.py                       # planar3r, task xy
python scripts/tour/map_workspace.py planar2r --samples 200000 --output map.png
"""

from __future__ import annotations

import argparse

import kinlab as kl


def main() -> None:
    options = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    options.add_argument("robot", nargs="?", default="planar3r")
    options.add_argument("--samples", type=int, default=100_000)
    options.add_argument("--output", default="workspace.png")
    chosen = options.parse_args()
    robot = kl.load(chosen.robot)

    chart = kl.sample_workspace(robot, "xy", samples=chosen.samples)
    boundary = kl.planar_boundary(robot)
    for arc in boundary.arcs:
        print(f"boundary: radius {arc.radius:.6f} m about {arc.centre.round(6)}")
    loci = kl.singular_loci(robot, range(robot.n), task="xy")
    print(f"{len(chart.values)} samples; 1/kappa up to {chart.values.max():.4f}; "
          f"{len(loci.curves)} singular curves")  # fmt: skip

    from kinlab.plots import canvas, maps

    curves = [kl.fk(robot, curve.q)[:, :3, 3] for curve in loci.curves]
    axes = maps.workspace_map(chart, boundary=boundary, curves=curves)
    print(f"wrote {canvas.save(axes, chosen.output)}")


if __name__ == "__main__":
    main()
