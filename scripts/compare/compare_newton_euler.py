"""Note 000, Newton-Euler, on the Stanford arm, whose third joint slides.

The note's recursion for Craig's frames, the prismatic case included, gravity as v_dot_0 = -g.
Then the note's omega_dot term as it is printed.

Run: python scripts/compare/compare_newton_euler.py
"""

from __future__ import annotations

import numpy as np

import kinlab as kl

robot = kl.load("stanford")
table = kl.to_dh(robot)  # the same arm in Craig's convention
Z = np.array([0.0, 0.0, 1.0])


def turn_then_cross(down, omega, rate):
    return np.cross(down @ omega, rate)


def cross_then_turn(down, omega, rate):
    """As printed: the cross product in frame i."""
    return down @ np.cross(omega, rate)


def newton_euler(q, v, a, swing=turn_then_cross):
    """tau by the outward and the inward recursion."""
    steps = table.link_transforms(q)
    omega, omega_dot = np.zeros(3), np.zeros(3)
    v_dot = -(table.base[:3, :3].T @ table.gravity)
    forces, moments = [], []
    for step, row, rate, pull in zip(steps, table.links, v, a, strict=True):
        down, p = step[:3, :3].T, step[:3, 3]
        rate, pull = rate * Z, pull * Z
        v_dot = down @ (v_dot + np.cross(omega_dot, p) + np.cross(omega, np.cross(omega, p)))
        before, omega, omega_dot = omega, down @ omega, down @ omega_dot
        if row.joint == "revolute":
            omega, omega_dot = omega + rate, omega_dot + pull + swing(down, before, rate)
        else:
            v_dot = v_dot + 2 * np.cross(omega, rate) + pull
        centre = v_dot + np.cross(omega_dot, row.com) + np.cross(omega, np.cross(omega, row.com))
        forces.append(row.mass * centre)
        moments.append(row.inertia @ omega_dot + np.cross(omega, row.inertia @ omega))
    f, n, tau = np.zeros(3), np.zeros(3), np.zeros(len(q))
    for i in reversed(range(len(q))):
        row = table.links[i]
        if i + 1 < len(q):
            up, p = steps[i + 1][:3, :3], steps[i + 1][:3, 3]
            n = up @ n + np.cross(p, up @ f)
            f = up @ f
        f, n = f + forces[i], n + moments[i] + np.cross(row.com, forces[i])
        tau[i] = (n if row.joint == "revolute" else f) @ Z + row.armature * a[i]
    return tau


def printed(q, v, a):
    return newton_euler(q, v, a, swing=cross_then_turn)


def main() -> None:
    print("Note 000, Newton-Euler, on the Stanford arm (joint 3 slides)")
    print(kl.compare(robot, "inverse_dynamics", newton_euler))
    print("\nThe omega_dot term as printed, cross product first:")
    wrong = kl.compare(robot, "inverse_dynamics", printed)
    print(f"largest relative error {wrong.max_error:.2g}")


if __name__ == "__main__":
    main()
