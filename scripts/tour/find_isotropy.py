"""Isotropic arms: the 2R arm of note 000, a planar 3R, and DIESTRO with six joints.

    python scripts/tour/find_isotropy.py --output isotropic.png

Note 000 derives l1 = sqrt(2) l2 and theta2 = 135°; the search finds both, and theta2 = -135°.
DIESTRO is the isotropic six-joint arm in Angeles, *Fundamentals of Robotic Mechanical Systems*.
"""

from __future__ import annotations

import argparse

import numpy as np

import kinlab as kl


def main() -> None:
    options = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    options.add_argument("--output", default="isotropic.png")
    chosen = options.parse_args()

    design = kl.design_isotropic(kl.load("planar2r").table, free=["a2", "tool.x"])[0]
    l1, l2 = design.values.values()
    print(f"2R: l1 = {l1:.9f}, l2 = {l2:.9f}, l1 / l2 = {l1 / l2:.9f}, q2 =",
          ", ".join(f"{np.degrees(c.q[1]):+.6f}°" for c in design.configurations))  # fmt: skip
    robot = kl.Robot.from_dh(design.table)
    jac = design.configurations[0].jacobian
    print(f"    J J^T = l2² 1:\n{jac @ jac.T}")

    three = kl.design_isotropic(kl.load("planar3r").table, free=["a2", "a3", "tool.x"])[0]
    print("3R:", ", ".join(f"{name} = {value:.6f}" for name, value in three.values.items()))
    print(f"    length {three.length:.6f} m, condition - 1 = {three.condition - 1:.1e}")

    links = [kl.DHLink("revolute", a=0.05, d=0.05, alpha=sign * np.pi / 2) for sign in (1, -1) * 3]
    diestro = kl.Robot.from_dh(kl.DHTable("diestro", "standard", links))
    for found in kl.find_isotropic(diestro):
        print(f"DIESTRO: q = {np.degrees(found.q).round(6)} deg, free: {', '.join(found.free)}")
        print(f"    length {found.length:.6f} m, condition - 1 = {found.condition - 1:.1e}")

    best = kl.find_isotropic(kl.load("puma560"))
    print(f"Puma 560 is nowhere isotropic: best condition number {best.best_condition:.6f} with "
          f"length {best.best_length:.4f} m, from {best.seeds} starts")  # fmt: skip

    from kinlab.plots import arms, canvas

    print(f"wrote {canvas.save(arms.ellipses(robot, design.q), chosen.output)}")


if __name__ == "__main__":
    main()
