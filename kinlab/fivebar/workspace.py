"""The workspace of a five-bar: what is reachable, and the regions free of singularities."""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING, NamedTuple

import numpy as np
from numpy.typing import ArrayLike

from kinlab.arrays import Array, real_array
from kinlab.errors import OptionError, StructureError
from kinlab.fivebar.arguments import HANGING, Mask, Mode, read_assembly, read_mode, read_points
from kinlab.fivebar.geometry import grid, solve_pose
from kinlab.fivebar.metrics import condition_number
from kinlab.fivebar.singularity import Circle, type_one, type_two_of_mode

if TYPE_CHECKING:
    from kinlab.fivebar.linkage import FiveBar

# -------- The free region of one working and assembly mode, and what bounds it


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
class FreeRegion:
    """The region free of singularities in one working and assembly mode, with what bounds it.

    Attributes:
        linkage: the five-bar.
        mode: working mode.
        assembly: sign of w_1 x w_2.
        circles: the edges of reach, inner and outer for each leg.
        curve: points of the type II curve of this mode, (K, 2), m.
    """

    linkage: FiveBar
    mode: Mode
    assembly: int
    circles: tuple[tuple[Circle, Circle], tuple[Circle, Circle]]
    curve: Array

    def contains(self, xy: Array) -> Mask:
        """Which points (N, 2) can be reached in this mode and assembly."""
        pose = solve_pose(self.linkage, xy, self.mode, "mask")
        return np.asarray(pose.ok & (np.sign(pose.rods) == self.assembly))

    def clearance(self, xy: ArrayLike) -> Array:
        """Distance to the nearest singularity, () or (N,), m; negative outside the region."""
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

    def contains_rectangle(self, box: Rectangle) -> bool:
        """Whether a rectangle lies in the region; decided by its edges, not by samples in it."""
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


def free_region(linkage: FiveBar, mode: Mode = HANGING, assembly: int = 1) -> FreeRegion:
    """The region free of singularities in one working and assembly mode.

    Raises:
        OptionError: a mode or assembly that does not exist.
    """
    signs = read_mode(mode)
    read_assembly(assembly)
    both = (int(signs[0]), int(signs[1]))
    return FreeRegion(linkage, both, assembly, type_one(linkage), type_two_of_mode(linkage, mode))


# -------- The reachable workspace of a five-bar and the free regions in it
# What can be reached is the common part of two rings, the same for all four working modes. The
# curve of type II cuts it into pieces, differently in each mode; a tool that stays in one mode
# and one assembly (the sign of w_1 x w_2) stays in one of those pieces.

_STARTS = 12
"""Best places of the grid from which a largest circle or rectangle is refined."""


def reachable_area(linkage: FiveBar) -> float:
    """Area of the common part of the two rings, m², in closed form."""
    (in1, out1), (in2, out2) = type_one(linkage)
    d = 2.0 * linkage.e
    parts = ((out1, out2, 1), (out1, in2, -1), (in1, out2, -1), (in1, in2, 1))
    return sum(sign * _lens(one.radius, two.radius, d) for one, two, sign in parts)


def _lens(r: float, s: float, d: float) -> float:
    """Common area of two discs of radii r and s whose centres are d apart."""
    if d >= r + s:
        return 0.0
    if d <= abs(r - s):
        return float(np.pi * min(r, s) ** 2)
    alpha = np.arccos((d * d + r * r - s * s) / (2.0 * d * r))
    beta = np.arccos((d * d + s * s - r * r) / (2.0 * d * s))
    return float(
        r * r * (alpha - 0.5 * np.sin(2.0 * alpha)) + s * s * (beta - 0.5 * np.sin(2.0 * beta))
    )


@dataclass(frozen=True)
class ModeMap:
    """One working mode on a grid of Y x X points.

    Attributes:
        x: (X,), m. y: (Y,), m.
        reachable: (Y, X).
        rods: w_1 x w_2, (Y, X), masked where out of reach.
        condition: kappa of J, (Y, X), masked where out of reach or singular.
        area: of the reachable points with w_1 x w_2 > 0 and < 0, m².
    """

    x: Array
    y: Array
    reachable: Mask
    rods: Array
    condition: Array
    area: tuple[float, float]


def workspace_map(linkage: FiveBar, mode: Mode = HANGING, resolution: int = 201) -> ModeMap:
    """Maps reach, assembly and condition number of one working mode.

    Args:
        linkage: the five-bar.
        mode: signs of u_i x w_i.
        resolution: points along the longer side.

    Raises:
        OptionError: a mode that does not exist, or fewer than 8 points.
    """
    x, y, points = grid(linkage, resolution)
    pose = solve_pose(linkage, points, mode, "mask")
    shape = (len(y), len(x))
    cell = (x[1] - x[0]) * (y[1] - y[0])
    positive, negative = (float(np.sum(pose.ok & (s * pose.rods > 0)) * cell) for s in (1, -1))
    return ModeMap(
        x,
        y,
        pose.ok.reshape(shape),
        np.ma.array(pose.rods, mask=~pose.ok).reshape(shape),
        condition_number(linkage, points, mode, "mask").reshape(shape),
        (positive, negative),
    )


def largest_circle(
    linkage: FiveBar, mode: Mode = HANGING, assembly: int = 1, resolution: int = 121
) -> Circle:
    """The largest circle found without a singularity in one working and assembly mode.

    The grid's best places are refined by halving steps, so the answer is a local best to
    1e-6 m; a second region narrower than a cell of the grid can be missed. With both cranks on
    one axis (e = 0) it can be turned about that axis; the one straight below is returned.

    Raises:
        StructureError: no pose in that mode and assembly.
        OptionError: a mode or assembly that does not exist.
    """
    free = free_region(linkage, mode, assembly)
    x, _, points = grid(linkage, resolution)
    clear = free.clearance(points)
    best = np.argsort(clear)[::-1][:_STARTS]
    if clear[best[0]] <= 0.0:
        raise _no_free_region(linkage, mode, assembly)
    centres, radii, step = points[best], clear[best], float(x[1] - x[0])
    directions = np.array([[1, 0], [-1, 0], [0, 1], [0, -1], [1, 1], [1, -1], [-1, 1], [-1, -1]])
    while step > 1e-7 * float(np.sum(linkage.l1)):
        moved = centres[:, None] + step * directions
        found = free.clearance(moved.reshape(-1, 2)).reshape(len(centres), len(directions))
        pick = found.argmax(axis=1)
        rows = np.arange(len(centres))
        better = found[rows, pick] > radii
        centres = np.where(better[:, None], moved[rows, pick], centres)
        radii = np.where(better, found[rows, pick], radii)
        step *= 1.0 if better.any() else 0.5
    top = int(radii.argmax())
    x_best, y_best = map(float, centres[top])
    if linkage.e == 0.0:
        x_best, y_best = 0.0, -float(np.hypot(x_best, y_best))
    return Circle((x_best, y_best), float(radii[top]))


def largest_rectangle(
    linkage: FiveBar,
    mode: Mode = HANGING,
    assembly: int = 1,
    resolution: int = 121,
    max_condition: float = np.inf,
) -> Rectangle:
    """The largest upright rectangle found without a singularity in one working and assembly mode.

    Cells of a grid that are free as a whole are joined; without a bound on the condition
    number the sides are then moved outward as far as they go: a local best. A bound on the
    condition number is held at the corners of the grid's cells, and nowhere else.

    Args:
        linkage: the five-bar.
        mode: signs of u_i x w_i.
        assembly: sign of w_1 x w_2.
        resolution: grid points along the longer side.
        max_condition: bound on kappa at the corners of the grid's cells.

    Raises:
        StructureError: no pose in that mode and assembly, or none so well conditioned.
        OptionError: a mode or assembly that does not exist.
    """
    free = free_region(linkage, mode, assembly)
    x, y, points = grid(linkage, resolution)
    good = free.contains(points)
    if max_condition < np.inf:
        kappa = condition_number(linkage, points, mode, "mask")
        good &= np.ma.filled(kappa <= max_condition, False)
    half = 0.5 * float(np.hypot(x[1] - x[0], y[1] - y[0]))
    corner = good.reshape(len(y), len(x))
    cells = corner[:-1, :-1] & corner[1:, :-1] & corner[:-1, 1:] & corner[1:, 1:]
    middles = np.stack(np.meshgrid(0.5 * (x[1:] + x[:-1]), 0.5 * (y[1:] + y[:-1])), axis=-1)
    cells &= (free.clearance(middles.reshape(-1, 2)) > half).reshape(cells.shape)
    if not cells.any():
        raise _no_free_region(linkage, mode, assembly)
    top, bottom, left, right = _largest_block(cells)
    box = Rectangle(float(x[left]), float(x[right]), float(y[top]), float(y[bottom]))
    return box if max_condition < np.inf else _enlarged(free, box, float(x[1] - x[0]))


def _largest_block(cells: Mask) -> tuple[int, int, int, int]:
    """First and past-the-last row and column of the largest full block (histogram method)."""
    best, block = 0, (0, 0, 0, 0)
    heights = np.zeros(cells.shape[1] + 1, dtype=int)
    for row, line in enumerate(cells):
        heights[:-1] = np.where(line, heights[:-1] + 1, 0)
        stack: list[int] = []
        for column, height in enumerate(heights):
            while stack and heights[stack[-1]] >= height:
                tall = int(heights[stack.pop()])
                left = stack[-1] + 1 if stack else 0
                if tall * (column - left) > best:
                    best = tall * (column - left)
                    block = (row + 1 - tall, row + 1, left, column)
            stack.append(column)
    return block


def _enlarged(free: FreeRegion, box: Rectangle, step: float) -> Rectangle:
    """Moves one side, or two against each other, while the area grows and stays in the region."""
    directions = np.stack(np.meshgrid(*[[-1.0, 0.0, 1.0]] * 4), axis=-1).reshape(-1, 4)
    least = 1e-6 * float(np.sum(free.linkage.l1))
    while step > least:
        trials = [Rectangle(*(np.asarray(box) + step * way).tolist()) for way in directions]
        trials = [t for t in trials if t.area > box.area and free.contains_rectangle(t)]
        if trials:
            box = max(trials, key=lambda t: t.area)
        else:
            step *= 0.5
    return box


def _no_free_region(linkage: FiveBar, mode: Mode, assembly: int) -> StructureError:
    return StructureError(
        f"{linkage.name}: no free place in working mode {tuple(mode)} and assembly {assembly:+d} "
        "on this grid; try another mode, a finer resolution, or a larger max_condition"
    )
