"""Newton-Euler in world coordinates, straight from a DH table: an oracle of its own.

It shares nothing with the URDF road or Pinocchio: frames come from the table's hand product,
velocities and accelerations from sums over the joints below, torques from force and moment
balance of everything beyond a joint.
"""

from __future__ import annotations

import numpy as np

import kinlab as kl


def axes(table: kl.DHTable, q: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """Joint axes (n, 3) and a point on each, in the world. A flipped joint moves against z."""
    frames = table.frames(q)
    if str(table.convention) == "standard":  # joint i moves about z_{i-1}
        frames = np.concatenate([np.asarray(table.base)[None], frames[:-1]])
    signs = np.array([-1.0 if link.flip else 1.0 for link in table.links])
    return frames[:, :3, 2] * signs[:, None], frames[:, :3, 3]


def torques(table: kl.DHTable, q: np.ndarray, v: np.ndarray, a: np.ndarray) -> np.ndarray:
    """tau for a motion, (n,)."""
    directions, points = axes(table, q)
    frames = table.frames(q)
    omega, alpha = np.zeros(3), np.zeros(3)
    point, point_acc = np.zeros(3), -np.asarray(table.gravity)  # gravity as an upward base
    forces, moments, centres = [], [], []
    for i, link in enumerate(table.links):
        z, p = directions[i], points[i]
        # carry the acceleration of the body so far to this joint's point
        point_acc = _carry(point_acc, point, p, omega, alpha)
        point = p
        if link.joint == "revolute":
            alpha = alpha + z * a[i] + np.cross(omega, z * v[i])
            omega = omega + z * v[i]
        else:
            point_acc = point_acc + z * a[i] + 2.0 * np.cross(omega, z * v[i])
            # point_acc is now that of the sliding body's own material point at `point`
        rotation = frames[i][:3, :3]
        centre = frames[i][:3, 3] + rotation @ np.asarray(link.com)
        tensor = rotation @ np.asarray(link.inertia) @ rotation.T
        forces.append(link.mass * _carry(point_acc, point, centre, omega, alpha))
        moments.append(tensor @ alpha + np.cross(omega, tensor @ omega))
        centres.append(centre)
    tau = np.empty(table.n)
    for i, link in enumerate(table.links):
        force = sum(forces[i:])
        if link.joint == "revolute":
            moment = sum(
                n + np.cross(c - points[i], f)
                for n, c, f in zip(moments[i:], centres[i:], forces[i:], strict=True)
            )
            tau[i] = directions[i] @ moment
        else:
            tau[i] = directions[i] @ force
        tau[i] += link.armature * a[i]
    return tau


def _carry(acc, start, end, omega, alpha):
    arm = end - start
    return acc + np.cross(alpha, arm) + np.cross(omega, np.cross(omega, arm))


def mass_matrix(table: kl.DHTable, q: np.ndarray) -> np.ndarray:
    """M column by column: torques of unit accelerations at rest, less gravity."""
    zero = np.zeros(table.n)
    gravity = torques(table, q, zero, zero)
    columns = [torques(table, q, zero, unit) - gravity for unit in np.eye(table.n)]
    return np.array(columns).T
