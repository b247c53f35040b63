"""Names of branches: shoulder, elbow, wrist, after Lee and Ziegler (1984), from the geometry.

- shoulder ``right`` / ``left``: turning joint 2 forwards lifts (lowers) the wrist along axis 1;
- elbow ``up`` / ``down``: joint 3 lies above (below) the line from joint 2 to the wrist, seen
  along axis 2, up meaning along axis 1; where axes 1 and 2 are parallel ``left`` / ``right``,
  the way joint 2 bends the arm seen against axis 1, and no shoulder;
- wrist ``no flip`` / ``flip``: the sign of (z4 x z5) . z6.
"""

from __future__ import annotations

import numpy as np

from kinlab.arrays import Array
from kinlab.chain import frames
from kinlab.chain_arrays import Chain

_NONE = 1e-7


def planar_name(chain: Chain, q: Array) -> str:
    """``elbow left`` where joint 2 bends the arm anticlockwise seen against axis 1."""
    axes = _axes(chain, q)
    points = np.vstack([axes[:2, 3:], axes[2, 3:] if len(q) > 2 else _tool(chain, q)])
    bend = float(np.cross(points[1] - points[0], points[2] - points[1]) @ axes[0, :3])
    return _pick("elbow", bend, "left", "right", "straight")


def wrist_arm_name(chain: Chain, q: Array, centre: Array | None) -> str:
    """Names of a six-joint branch.

    Args:
        chain: the arm.
        q: (6,).
        centre: wrist centre in the base; ``None`` where the wrist is not spherical: the joint
            in front of the last two then stands for it.
    """
    axes = _axes(chain, q)
    z, o = axes[:, :3], axes[:, 3:]
    wrist = o[3] if centre is None else centre
    out = wrist - o[1]
    forwards = np.cross(z[0], z[1])
    if np.linalg.norm(forwards) < _NONE:  # two parallel axes: a planar elbow and no shoulder
        bend = float(np.cross(o[1] - o[0], out) @ z[0])
        names = [_pick("elbow", bend, "left", "right", "straight")]
    else:
        names = [_pick("shoulder", float(forwards @ out), "right", "left", "over")]
        if not chain.prismatic[2]:
            names.append(_pick("elbow", _height(z, o, out), "up", "down", "straight"))
    names.append(_pick("wrist", float(np.cross(z[3], z[4]) @ z[5]), "no flip", "flip", "aligned"))
    return ", ".join(names)


def _height(z: Array, o: Array, out: Array) -> float:
    """How far joint 3 lies above the line from joint 2 to the wrist, seen along axis 2."""
    flat = np.eye(3) - np.outer(z[1], z[1])
    bend, line = flat @ (o[2] - o[1]), flat @ out
    square = float(line @ line)
    if square > _NONE**2:
        bend = bend - line * (float(bend @ line) / square)
    return float(bend @ z[0])


def _pick(part: str, value: float, positive: str, negative: str, neither: str) -> str:
    word = neither if abs(value) < _NONE else positive if value > 0.0 else negative
    return f"{part} {word}"


def _axes(chain: Chain, q: Array) -> Array:
    axes, pose = np.empty((len(chain.prismatic), 6)), np.empty(12)
    frames(*chain, q, axes, pose)
    return axes


def _tool(chain: Chain, q: Array) -> Array:
    axes, pose = np.empty((len(chain.prismatic), 6)), np.empty(12)
    frames(*chain, q, axes, pose)
    return pose[[3, 7, 11]]
