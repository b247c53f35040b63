"""Note 000, statics, on the Panda: forces and moments from the hand to the base.

What the joints hold shows in tau; what the bearings carry does not, and is printed too.

Run: python scripts/compare/compare_statics.py
"""

from __future__ import annotations

import numpy as np

import kinlab as kl

robot = kl.load("panda")
table = robot.table


def propagate(q, wrench):
    """f_i = R f_{i+1} and n_i = R n_{i+1} + P x f_i, from the tool inwards, (n, 6)."""
    steps = table.link_transforms(q)
    turned = kl.fk(robot, q)[:3, :3]
    force = table.tool[:3, :3] @ turned.T @ wrench[:3]
    moment = table.tool[:3, :3] @ turned.T @ wrench[3:] + np.cross(table.tool[:3, 3], force)
    found = [np.r_[force, moment]]
    for step in steps[:0:-1]:
        force = step[:3, :3] @ force
        moment = step[:3, :3] @ moment + np.cross(step[:3, 3], force)
        found.append(np.r_[force, moment])
    return np.array(found[::-1])


def torques(q, wrench):
    """tau_i = n_i·Z: every joint of the Panda is revolute."""
    return propagate(q, wrench)[:, 5]


def main() -> None:
    print("Note 000, statics, on the Panda")
    print(kl.compare(robot, "static_wrenches", propagate))
    print(kl.compare(robot, "statics", torques))
    q = np.array([0.3, -0.5, 0.2, -2.0, 0.4, 1.6, 0.8])
    load = np.array([0.0, 0.0, -50.0, 0.0, 0.0, 0.0])
    print("\nPushing down with 50 N: what each joint holds, and what its bearing carries")
    for name, wrench in zip(robot.joint_names, kl.static_wrenches(robot, q, load), strict=True):
        passive = np.hypot(wrench[3], wrench[4])
        print(f"  {name}: tau {wrench[5]:8.3f} N m, bending moment {passive:8.3f} N m, "
              f"force {np.linalg.norm(wrench[:3]):6.2f} N")  # fmt: skip


if __name__ == "__main__":
    main()
