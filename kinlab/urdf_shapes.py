"""What a DH arm looks like: a cylinder for each d, one for each a, a stub for each joint axis."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from kinlab.arrays import Array
from kinlab.dh import DHLink, DHTable
from kinlab.placements import LinkPlacement

_THICKNESS = 0.018
"""Radius of the rods over the arm's stretched length: a Puma gets 25 mm."""


@dataclass(frozen=True)
class Shape:
    """A cylinder along its own z (or a box), placed in a link frame; metres."""

    origin: Array
    radius: float = 0.0
    length: float = 0.0
    box: tuple[float, float, float] | None = None
    stub: bool = False


def stretched_length(table: DHTable) -> float:
    """Sum of all lengths and strokes of an arm, metres: the scale for drawing it."""
    total = float(np.linalg.norm(np.asarray(table.tool)[:3, 3]))
    for link in table.links:
        total += abs(link.a) + abs(link.d if link.joint == "revolute" else _far_end(link))
    return total or 1.0


def visuals(table: DHTable, places: list[LinkPlacement]) -> list[list[Shape]]:
    """The shapes of the base link and of links 1 to n, each in its URDF link frame.

    Zero lengths draw nothing; signed lengths are drawn on the side they point to.
    """
    radius = _THICKNESS * stretched_length(table)
    shapes: list[list[Shape]] = [[] for _ in range(table.n + 1)]
    for i, (link, place) in enumerate(zip(table.links, places, strict=True), 1):
        foot = place.origin @ _shift_z(-link.d)
        if link.joint == "revolute":
            shapes[i - 1].append(Shape(foot, 1.7 * radius, 4.0 * radius, stub=True))
            shapes[i] += _segment(np.array([0.0, 0.0, -link.d]), np.zeros(3), radius)
        else:
            size = (3.4 * radius, 3.4 * radius, 4.0 * radius)
            shapes[i - 1].append(Shape(foot, box=size, stub=True))
            # the rod must reach the joint at the far end of its stroke
            shapes[i] += _segment(np.array([0.0, 0.0, -_far_end(link)]), np.zeros(3), 0.8 * radius)
        # the common normal a lies behind the joint (standard) or in front of the next (modified)
        end = places[i].origin if i < table.n else place.tail @ np.asarray(table.tool)
        corner = end @ _shift_z(-table.links[i].d) if i < table.n else end
        shapes[i] += _segment(np.zeros(3), corner[:3, 3], radius)
    first = places[0].origin @ _shift_z(-table.links[0].d)
    shapes[0] += _segment(np.asarray(table.base)[:3, 3], first[:3, 3], radius)
    return shapes


def _far_end(link: DHLink) -> float:
    """The d at the end of a prismatic joint's stroke that lies farther from the joint, metres."""
    assert link.lower is not None and link.upper is not None
    sign = -1.0 if link.flip else 1.0
    return max(link.d + sign * link.lower, link.d + sign * link.upper, key=abs)


def _segment(start: Array, end: Array, radius: float) -> list[Shape]:
    """A cylinder from start to end; nothing where they coincide."""
    along = end - start
    length = float(np.linalg.norm(along))
    if length < 0.2 * radius:
        return []
    z = along / length
    other = np.eye(3)[int(np.argmin(np.abs(z)))]
    x = np.cross(other, z)
    x /= np.linalg.norm(x)
    origin = np.eye(4)
    origin[:3, :3] = np.column_stack([x, np.cross(z, x), z])
    origin[:3, 3] = 0.5 * (start + end)
    return [Shape(origin, radius, length)]


def _shift_z(d: float) -> Array:
    out = np.eye(4)
    out[2, 3] = d
    return out
