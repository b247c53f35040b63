"""Note 000 on the Puma 560: link transforms, the tool's pose, the Jacobian; and a misprint.

Run: python scripts/compare/compare_kinematics.py
"""

from __future__ import annotations

import numpy as np

import kinlab as kl

table = kl.load("puma560_modified").table
robot = kl.load("puma560_modified")


def link(a, alpha, d, theta):
    """Craig's link transform, as note 000 prints it."""
    c, s, ca, sa = np.cos(theta), np.sin(theta), np.cos(alpha), np.sin(alpha)
    return np.array(
        [[c, -s, 0, a], [s * ca, c * ca, -sa, -sa * d], [s * sa, c * sa, ca, ca * d], [0, 0, 0, 1]]
    )


def frames(q):
    """Poses of frames 1 to 6 in the base: the product of the link transforms."""
    poses = [table.base]
    for row, angle in zip(table.links, q, strict=True):
        poses.append(poses[-1] @ link(row.a, row.alpha, row.d, row.theta + angle))
    return poses[1:]


def pose(q):
    return frames(q)[-1] @ table.tool


def jacobian(q):
    """Columns (z x (p_tool - p), z)."""
    tip = pose(q)[:3, 3]
    return np.stack(
        [np.r_[np.cross(f[:3, 2], tip - f[:3, 3]), f[:3, 2]] for f in frames(q)], axis=1
    )


def clockwise(q):
    """The text of note 000 says that theta is positive clockwise."""
    return pose(-np.asarray(q))


def main() -> None:
    print("Note 000, kinematics, on the Puma 560 in Craig's convention")
    print(kl.compare(robot, "fk", pose))
    print(kl.compare(robot, "jacobian", jacobian))
    print("\nThe text's clockwise theta:")
    print(f"largest relative error {kl.compare(robot, 'fk', clockwise).max_error:.2g}")


if __name__ == "__main__":
    main()
