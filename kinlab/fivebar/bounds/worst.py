"""The worst case over a rectangle, with a proved bound: branch and bound on cells.

Cells in which a quantity is certainly below the best value found are dropped, the others are split
in four. The bound of a cell is that of its Taylor model (:mod:`kinlab.fivebar.bounds.enclosure`);
values are taken at the corners that the slopes point to. So no place between grid points is
missed, and the gap between value and bound is known.

Source: Neumaier, "Complete search in continuous global optimization and constraint satisfaction",
Acta Numerica 13, 2004.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass, replace
from typing import TYPE_CHECKING, Any

import numpy as np

from kinlab.arrays import Array
from kinlab.errors import SingularError
from kinlab.fivebar.arguments import Mode, read_mode
from kinlab.fivebar.bounds.enclosure import pose_over
from kinlab.fivebar.dynamics import RodModel, torques
from kinlab.fivebar.geometry import Pose, rate_bias, rate_matrix, solve_pose
from kinlab.fivebar.workspace import Rectangle, free_region
from kinlab.tolerances import TOLERANCES

if TYPE_CHECKING:
    from kinlab.fivebar.linkage import FiveBar

_FIRST, _LEVELS, _MOST_CELLS = 8, 34, 6000
"""Cells a side of the first division; how often cells are halved; cells of one level after which
the search stops, its bound standing."""


@dataclass(frozen=True)
class Worst:
    """Largest value over the workspace for each crank, where, and a bound.

    Attributes:
        value: (2,), reached.
        place: (2 cranks, 2), m: where.
        bound: (2,): no place of the workspace has more.
    """

    value: Array
    place: Array
    bound: Array

    @property
    def largest(self) -> float:
        """Over both cranks: the bound."""
        return float(self.bound.max())

    @property
    def gap(self) -> float:
        """Largest of bound less value, in parts of the value."""
        size = np.maximum(np.abs(self.value), 1e-300)
        return float(np.max((self.bound - self.value) / size))


PoseQuantity = Callable[[Pose], Any]
"""Quantities (N, k) at N poses; it must run on poses over cells too."""


def bound_over(
    linkage: FiveBar,
    box: Rectangle,
    mode: Mode,
    quantity: PoseQuantity,
    gap: float = TOLERANCES.worst_case_gap,
) -> tuple[Array, Array, Array]:
    """The largest of each of k quantities over a rectangle, edges included.

    Args:
        linkage: the five-bar.
        box: the rectangle; every point of it within reach.
        mode: signs of u_i x w_i.
        quantity: what to bound.
        gap: part of the value to which the bound is brought.

    Returns:
        Values reached (k,), their places (k, 2), bounds (k,); a bound is infinite where the
        rectangle meets a singularity at which the quantity has no value.
    """
    signs = read_mode(mode)
    low, high = _cells(box)
    corners = lattice(box, 3)
    found = np.asarray(quantity(solve_pose(linkage, corners, mode)))
    best = found.max(axis=0)
    place = corners[found.argmax(axis=0)]
    settled = np.full_like(best, -np.inf)
    for level in range(_LEVELS):
        with np.errstate(all="ignore"):
            over = quantity(pose_over(linkage, low, high, signs))
        top = over.high
        steep = np.argmax(top, axis=0)  # of each quantity, the cell that may hold most
        directions = np.stack([over.slope[:, cell, k] for k, cell in enumerate(steep)])
        at = np.where(directions > 0.0, high[steep], low[steep])
        at = np.concatenate([at, 0.5 * (low + high)[steep]])
        values = np.asarray(quantity(solve_pose(linkage, at, mode)))
        first = values.argmax(axis=0)
        values = values[first, np.arange(len(best))]
        place = np.where((values > best)[:, None], at[first], place)
        best = np.maximum(best, values)
        open_cells = np.any(top > best + gap * np.abs(best), axis=1)
        last = level == _LEVELS - 1 or np.count_nonzero(open_cells) > _MOST_CELLS
        closed = slice(None) if last else ~open_cells
        settled = np.maximum(settled, top[closed].max(axis=0, initial=-np.inf))
        if last or not open_cells.any():
            break
        low, high = _split(low[open_cells], high[open_cells])
    bound = np.maximum(settled, best)
    return best, place, bound + TOLERANCES.bound_rounding * np.abs(bound)


def _cells(box: Rectangle) -> tuple[Array, Array]:
    x, y = np.linspace(*box[:2], _FIRST + 1), np.linspace(*box[2:], _FIRST + 1)
    low = np.stack(np.meshgrid(x[:-1], y[:-1]), axis=-1).reshape(-1, 2)
    high = np.stack(np.meshgrid(x[1:], y[1:]), axis=-1).reshape(-1, 2)
    return low, high


def _split(low: Array, high: Array) -> tuple[Array, Array]:
    """Each cell in four."""
    middle = 0.5 * (low + high)
    x = [(low[:, 0], middle[:, 0]), (middle[:, 0], high[:, 0])]
    y = [(low[:, 1], middle[:, 1]), (middle[:, 1], high[:, 1])]
    lows = [np.stack([a[0], b[0]], axis=1) for a in x for b in y]
    highs = [np.stack([a[1], b[1]], axis=1) for a in x for b in y]
    return np.concatenate(lows), np.concatenate(highs)


def worst(
    linkage: FiveBar,
    box: Rectangle,
    mode: Mode,
    measure: Callable[[Pose], dict[str, Any]],
    gap: float = TOLERANCES.worst_case_gap,
) -> dict[str, Worst]:
    """Several quantities of the two cranks by :func:`bound_over`, all at once.

    Args:
        linkage: the five-bar.
        box: the rectangle; every point of it within reach.
        mode: signs of u_i x w_i.
        measure: the quantities by name, (N, 2) each; it must run on poses over cells too.
        gap: part of the value to which the bound is brought.
    """
    names: list[str] = []

    def all_of(pose: Pose) -> Any:
        found = measure(pose)
        names[:] = found
        return np.stack([rows[:, k] for rows in found.values() for k in (0, 1)], axis=1)

    value, place, bound = bound_over(linkage, box, mode, all_of, gap)
    pairs = {name: slice(2 * k, 2 * k + 2) for k, name in enumerate(names)}
    return {name: Worst(value[two], place[two], bound[two]) for name, two in pairs.items()}


def lattice(box: Rectangle, count: int) -> Array:
    """count x count points of a rectangle, edges included, (count², 2)."""
    axes = np.linspace(*box[:2], count), np.linspace(*box[2:], count)
    return np.stack(np.meshgrid(*axes), axis=-1).reshape(-1, 2)


_GRID = 33
"""Points a side of the grid that names a place where a rectangle is not free."""


def grid_of(box: Rectangle) -> Array:
    """A grid over a rectangle for quick estimates, (N, 2)."""
    return lattice(box, _GRID)


def require_regular(linkage: FiveBar, box: Rectangle, mode: Mode) -> None:
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
        free = free_region(linkage, mode, int(sign))
        if free.contains_rectangle(box):
            return
        at = points[int(np.argmin(free.clearance(points)))]
    raise SingularError(
        f"{linkage.name}: the workspace {tuple(box)} is not free of singularities in mode "
        f"{tuple(mode)}; the rods get in line, or a leg's reach ends, near ({at[0]:.6g}, "
        f"{at[1]:.6g}) m; largest_rectangle() gives one that is free"
    )


# -------- Torque and acceleration as functions of the tool's motion
# At one place the torque of a crank is linear in the tool's acceleration and quadratic in its
# velocity: tau_i = G_i a + v^T Q_i v + g_i. So the worst direction of each is exact: |G_i| a_max,
# and an eigenvalue of Q_i times v_max². Only the place has to be searched for.


@dataclass(frozen=True)
class MotionForms:
    """A pair of quantities as functions of the tool's motion.

    Their value is linear·a + v^T quadratic v + constant.

    Attributes:
        linear: (..., 2, 2). quadratic: (..., 2, 2, 2). constant: (..., 2).
    """

    linear: Any
    quadratic: Any
    constant: Any

    def behind_gears(self, turn: MotionForms, share: Array, rotor: Array) -> MotionForms:
        """share · self + rotor · turn for D gears: one more axis of D behind the poses'."""

        def sum_of(one: Any, other: Any, axes: int) -> Any:
            shape = (-1,) + (1,) * axes
            return share.reshape(shape) * one[:, None] + rotor.reshape(shape) * other[:, None]

        return MotionForms(
            sum_of(self.linear, turn.linear, 2),
            sum_of(self.quadratic, turn.quadratic, 3),
            sum_of(self.constant, turn.constant, 1),
        )

    def with_rotors(self, turn: MotionForms, rotor: Array) -> MotionForms:
        """self + rotor · turn, rotor (2,) being the inertia at the cranks."""
        return MotionForms(
            self.linear + rotor[:, None] * turn.linear,
            self.quadratic + rotor[:, None, None] * turn.quadratic,
            self.constant,
        )

    def peak(self, v_max: float, a_max: float) -> Any:
        """Largest absolute value over |a| <= a_max and |v| <= v_max, (..., 2), exact."""
        xx, xy, yy = (self.quadratic[..., i, j] for i, j in ((0, 0), (0, 1), (1, 1)))
        middle, radius = 0.5 * (xx + yy), np.hypot(0.5 * (xx - yy), xy)  # eigenvalues' circle
        up = np.maximum(middle + radius, 0.0) * v_max**2 + self.constant
        down = np.maximum(radius - middle, 0.0) * v_max**2 - self.constant
        return row_norms(self.linear) * a_max + np.maximum(up, down)


def torque_forms(linkage: FiveBar, pose: Pose, rods: RodModel) -> MotionForms:
    """The crank torques, N m."""

    weightless = replace(linkage, gravity=(0.0, 0.0))  # what is left has no constant part

    def at(bars: FiveBar, v: Array, a: Array) -> Any:
        shape = pose.xy.shape
        return torques(bars, pose, np.broadcast_to(v, shape), np.broadcast_to(a, shape), rods)

    none, (x, y) = np.zeros(2), np.eye(2)
    linear = np.stack([at(weightless, none, x), at(weightless, none, y)], axis=2)
    quadratic = _quadratic(lambda v: at(weightless, v, none))
    return MotionForms(linear, quadratic, at(linkage, none, none))


def acceleration_forms(linkage: FiveBar, pose: Pose) -> MotionForms:
    """The crank accelerations theta_ddot = J a + f(v), rad/s²."""
    bias = _quadratic(lambda v: rate_bias(linkage, pose, np.broadcast_to(v, pose.xy.shape)))
    return MotionForms(rate_matrix(linkage, pose), bias, np.zeros(pose.xy.shape))


def _quadratic(form: Callable[[Array], Any]) -> Any:
    """Matrices of the quadratic forms v -> (N, 2), by polarisation, (N, 2, 2, 2)."""
    x, y = np.eye(2)
    xx, yy = form(x), form(y)
    xy = 0.5 * (form(x + y) - xx - yy)
    return np.stack([np.stack([xx, xy], axis=2), np.stack([xy, yy], axis=2)], axis=3)


def row_norms(matrix: Any) -> Any:
    """Lengths of the rows, (..., 2) from (..., 2, 2)."""
    return np.hypot(matrix[..., 0], matrix[..., 1])
