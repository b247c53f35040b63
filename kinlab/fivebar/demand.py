"""What a rectangle, a speed and an acceleration ask of the cranks at the worst place.

At one place the torque of a crank is linear in the tool's acceleration and quadratic in its
velocity: tau_i = G_i a + v^T Q_i v + g_i. So the worst direction of each is exact: |G_i| a_max,
and an eigenvalue of Q_i times v_max². Only the place has to be searched for.

Source: note 003 (003.speed, 003.Tmax) for G and J; Q and g are what the note leaves out.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass

import numpy as np

from kinlab.arrays import Array
from kinlab.errors import SingularError
from kinlab.fivebar.dynamics import RodModel, torques
from kinlab.fivebar.geometry import rate_bias, rate_matrix
from kinlab.fivebar.linkage import Linkage
from kinlab.fivebar.pose import Mode, Pose, solve_pose
from kinlab.fivebar.workspace import Rectangle, room

_GRID, _ZOOM, _ZOOMS = 33, 9, 14
"""Points a side of the first grid and of each zoom, and how often the best cell is zoomed in."""


@dataclass(frozen=True)
class Worst:
    """Largest value over the workspace for each crank, and where.

    Attributes:
        value: (2,). place: (2 cranks, 2), m.
    """

    value: Array
    place: Array

    @property
    def largest(self) -> float:
        """Over both cranks."""
        return float(self.value.max())


@dataclass(frozen=True)
class Forms:
    """A pair of quantities as functions of the tool's motion: linear·a + v^T quadratic v + still.

    Attributes:
        linear: (N, 2, 2). quadratic: (N, 2, 2, 2). still: (N, 2).
    """

    linear: Array
    quadratic: Array
    still: Array

    def plus(self, other: Forms, share: float, other_share: float) -> Forms:
        """share · self + other_share · other."""
        return Forms(
            share * self.linear + other_share * other.linear,
            share * self.quadratic + other_share * other.quadratic,
            share * self.still + other_share * other.still,
        )

    def peak(self, v_max: float, a_max: float) -> Array:
        """Largest absolute value over |a| <= a_max and |v| <= v_max, (N, 2), exact."""
        least, most = np.moveaxis(np.linalg.eigvalsh(self.quadratic), -1, 0)
        up = np.maximum(most, 0.0) * v_max**2 + self.still
        down = np.maximum(-least, 0.0) * v_max**2 - self.still
        return np.asarray(row_norms(self.linear) * a_max + np.maximum(up, down))


def torque_forms(linkage: Linkage, pose: Pose, rods: RodModel) -> Forms:
    """The crank torques, N m."""

    def at(v: Array, a: Array) -> Array:
        shape = pose.xy.shape
        return torques(linkage, pose, np.broadcast_to(v, shape), np.broadcast_to(a, shape), rods)

    none, (x, y) = np.zeros(2), np.eye(2)
    still = at(none, none)
    linear = np.stack([at(none, x) - still, at(none, y) - still], axis=2)
    return Forms(linear, _quadratic(lambda v: at(v, none) - still), still)


def turn_forms(linkage: Linkage, pose: Pose) -> Forms:
    """The crank accelerations theta_ddot = J a + f(v), rad/s²."""
    bias = _quadratic(lambda v: rate_bias(linkage, pose, np.broadcast_to(v, pose.xy.shape)))
    return Forms(rate_matrix(linkage, pose), bias, np.zeros_like(pose.xy))


def _quadratic(form: Callable[[Array], Array]) -> Array:
    """Matrices of the quadratic forms v -> (N, 2), by polarisation, (N, 2, 2, 2)."""
    x, y = np.eye(2)
    xx, yy = form(x), form(y)
    xy = 0.5 * (form(x + y) - xx - yy)
    return np.stack([np.stack([xx, xy], axis=2), np.stack([xy, yy], axis=2)], axis=3)


def row_norms(matrix: Array) -> Array:
    """Lengths of the rows, (N, 2) from (N, 2, 2)."""
    return np.asarray(np.linalg.norm(matrix, axis=2))


def worst(linkage: Linkage, box: Rectangle, mode: Mode, quantity: Callable[[Pose], Array]) -> Worst:
    """Largest (2,) of a quantity (N, 2) over a rectangle, edges included, by zooming grids."""
    low, high = np.array([box.x_min, box.y_min]), np.array([box.x_max, box.y_max])
    values, places = np.empty(2), np.empty((2, 2))
    first = lattice(low, high, _GRID)
    found = quantity(solve_pose(linkage, first, mode))
    for crank in range(2):
        place, best = first[found[:, crank].argmax()], found[:, crank].max()
        reach = (high - low) / (_GRID - 1)
        for _ in range(_ZOOMS):
            near = lattice(np.maximum(place - reach, low), np.minimum(place + reach, high), _ZOOM)
            value = quantity(solve_pose(linkage, near, mode))[:, crank]
            if value.max() > best:
                place, best = near[value.argmax()], value.max()
            reach = reach * 0.4
        values[crank], places[crank] = best, place
    return Worst(values, places)


def lattice(low: Array, high: Array, count: int) -> Array:
    """count x count points of a rectangle, edges included, (count², 2)."""
    axes = [np.linspace(a, b, count) for a, b in zip(low, high, strict=True)]
    return np.stack(np.meshgrid(*axes), axis=-1).reshape(-1, 2)


def grid_of(box: Rectangle) -> Array:
    """The first grid over a rectangle, (N, 2)."""
    return lattice(np.array([box.x_min, box.y_min]), np.array([box.x_max, box.y_max]), _GRID)


def refuse_singular(linkage: Linkage, box: Rectangle, mode: Mode) -> None:
    """Refuses a rectangle that is not free of singularities in one working mode.

    Raises:
        UnreachableError, SingularError: with a place.
    """
    points = grid_of(box)
    pose = solve_pose(linkage, points, mode, regular="I II")  # names an unreachable place
    middle = solve_pose(linkage, [0.5 * (box[0] + box[1]), 0.5 * (box[2] + box[3])], mode)
    sign = np.sign(middle.rods[0])
    if sign == 0.0 or np.any(pose.rods * sign <= 0.0):
        at = points[int(np.argmin(pose.rods * sign))]
    else:
        free = room(linkage, mode, int(sign))
        if free.holds(box):
            return
        at = points[int(np.argmin(free.clearance(points)))]
    raise SingularError(
        f"{linkage.name}: the workspace {tuple(box)} is not free of singularities in mode "
        f"{tuple(mode)}; the rods get in line, or a leg's reach ends, near ({at[0]:.6g}, "
        f"{at[1]:.6g}) m; largest_rectangle() gives one that is free"
    )
