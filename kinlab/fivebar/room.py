"""The free room of one working and assembly mode, and what bounds it."""

from __future__ import annotations

from dataclasses import dataclass
from typing import NamedTuple

import numpy as np
from numpy.typing import ArrayLike

from kinlab.arrays import Array, real_array
from kinlab.errors import OptionError
from kinlab.fivebar.linkage import Linkage
from kinlab.fivebar.loci import Circle, type_one, type_two
from kinlab.fivebar.pose import HANGING, Mask, Mode, read_mode, read_points, solve_pose


class Rectangle(NamedTuple):
    """An upright rectangle, m."""

    x_min: float
    x_max: float
    y_min: float
    y_max: float

    @property
    def area(self) -> float:
        """m²."""
        return (self.x_max - self.x_min) * (self.y_max - self.y_min)


def read_rectangle(value: ArrayLike, name: str) -> Rectangle:
    """Reads (x_min, x_max, y_min, y_max).

    Raises:
        OptionError: not four finite numbers, or empty.
    """
    numbers = real_array(value, f"{name}: workspace", OptionError)
    if numbers.shape != (4,):
        raise OptionError(
            f"{name}: workspace has shape {numbers.shape}; expected (x_min, x_max, y_min, y_max)"
        )
    box = Rectangle(*map(float, numbers))
    if box.x_min > box.x_max or box.y_min > box.y_max:
        raise OptionError(f"{name}: workspace {tuple(box)} is empty; order is min, max, min, max")
    return box


@dataclass(frozen=True)
class Room:
    """The free places of one working and assembly mode, with what bounds them.

    Attributes:
        linkage: the five-bar.
        mode: working mode.
        assembly: sign of w_1 x w_2.
        circles: the edges of reach, inner and outer for each leg.
        curve: points of the type II curve of this mode, (K, 2), m.
    """

    linkage: Linkage
    mode: Mode
    assembly: int
    circles: tuple[tuple[Circle, Circle], tuple[Circle, Circle]]
    curve: Array

    def contains(self, xy: Array) -> Mask:
        """Which points (N, 2) can be reached in this mode and assembly."""
        pose = solve_pose(self.linkage, xy, self.mode, "mask")
        return np.asarray(pose.ok & (np.sign(pose.rods) == self.assembly))

    def clearance(self, xy: ArrayLike) -> Array:
        """Distance to the nearest singularity, () or (N,), m; negative outside the room."""
        from scipy.spatial import cKDTree

        points, single = read_points(xy, f"{self.linkage.name}: xy")
        nearest = np.full(len(points), np.inf)
        for inner, outer in self.circles:
            d = np.hypot(*(points - np.array(inner.centre)).T)
            nearest = np.minimum(nearest, np.minimum(outer.radius - d, d - inner.radius))
        if len(self.curve):
            nearest = np.minimum(nearest, cKDTree(self.curve).query(points)[0])
        inside = self.contains(points)
        nearest = np.where(inside, nearest, -np.abs(nearest))
        return nearest[0] if single else nearest

    def holds(self, box: Rectangle) -> bool:
        """Whether a rectangle lies in the room; decided by its edges, not by samples in it."""
        middle = np.array([[0.5 * (box.x_min + box.x_max), 0.5 * (box.y_min + box.y_max)]])
        if not self.contains(middle)[0]:
            return False
        for inner, outer in self.circles:
            x, y = inner.centre
            far = np.hypot(
                max(abs(box.x_min - x), abs(box.x_max - x)),
                max(abs(box.y_min - y), abs(box.y_max - y)),
            )
            near = np.hypot(
                max(box.x_min - x, x - box.x_max, 0.0), max(box.y_min - y, y - box.y_max, 0.0)
            )
            if far >= outer.radius or near <= inner.radius:
                return False
        x, y = self.curve.T
        inside = (x >= box.x_min) & (x <= box.x_max) & (y >= box.y_min) & (y <= box.y_max)
        return not bool(inside.any())


def room(linkage: Linkage, mode: Mode = HANGING, assembly: int = 1) -> Room:
    """The free places of one working and assembly mode.

    Raises:
        OptionError: a mode or assembly that does not exist.
    """
    signs = read_mode(mode)
    if assembly not in (1, -1):
        raise OptionError(f"assembly {assembly!r} does not exist; choose +1 or -1")
    curves = [np.empty((0, 2))]
    for locus in type_two(linkage):
        ours = np.all(locus.modes * signs >= 0.0, axis=1)
        curves.append(_closed(locus.points, ours))
    both = (int(signs[0]), int(signs[1]))
    return Room(linkage, both, assembly, type_one(linkage), np.concatenate(curves))


def _closed(points: Array, keep: Mask) -> Array:
    """The kept points of a closed curve, with each gap between neighbours filled to 1/8."""
    after, keep_after = np.roll(points, -1, axis=0), np.roll(keep, -1)
    both = keep & keep_after
    steps = np.arange(1, 8)[:, None, None] / 8.0
    between = points[both] + steps * (after - points)[both]
    return np.concatenate([points[keep], between.reshape(-1, 2)])
