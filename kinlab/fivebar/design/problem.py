"""A design problem: what is free, what is asked, and what a candidate is worth at given points."""

from __future__ import annotations

import hashlib
import json
from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field
from functools import partial
from typing import Any

import numpy as np
from numpy.typing import ArrayLike

from kinlab.arrays import Array, number, shown, word
from kinlab.errors import OptionError
from kinlab.fivebar.arguments import HANGING, Mode, read_mode
from kinlab.fivebar.bounds.enclosure import smooth_pose
from kinlab.fivebar.bounds.worst import bound_over
from kinlab.fivebar.design.goals import GOALS, GRAVITY, Candidates
from kinlab.fivebar.linkage import FiveBar
from kinlab.fivebar.workspace import Rectangle, read_rectangle
from kinlab.tolerances import TOLERANCES

_SIZES = (0.02, 2.5)
"""Range of lengths where none is given, in parts of the farthest corner's distance."""

_SPAN = (1e-6, 1e6)
"""m. Shortest side and farthest corner of a rectangle that is designed for."""

Range = tuple[float, float] | float | None

_OUT = 1e3
"""Cost of a candidate that breaks a limit, before what it breaks by."""

_VARIABLES = ("l1", "l2", "e", "y")


@dataclass(frozen=True)
class Problem:
    """What is free, and what is asked.

    Attributes:
        box: the rectangle, m; where its height is free, its lower edge is a variable.
        free_height: whether it is.
        mode: working mode.
        lengths: range of each variable: l1, l2, e, and y of the lower edge where free, m.
        weights: goals by name with their weights.
        limits: what a goal may not exceed, or for clearance and transmission fall below.
        payload: kg, for the goal torque.
    """

    box: Rectangle
    free_height: bool
    mode: tuple[int, int]
    lengths: tuple[tuple[float, float], ...]
    weights: Mapping[str, float]
    limits: Mapping[str, float] = field(default_factory=dict)
    payload: float = 0.0

    @property
    def diagonal(self) -> float:
        """Of the rectangle, m: the unit of lengths in a mix of goals."""
        return float(np.hypot(self.box.x_max - self.box.x_min, self.box.y_max - self.box.y_min))

    @property
    def names(self) -> tuple[str, ...]:
        """The variables."""
        return _VARIABLES[: len(self.lengths)]

    @property
    def low(self) -> Array:
        """Least values of the variables."""
        return np.array([low for low, _ in self.lengths])

    @property
    def high(self) -> Array:
        """Largest values of the variables."""
        return np.array([high for _, high in self.lengths])

    def unit(self, goal: str) -> float:
        """What a goal is divided by in a mix."""
        if goal in ("size", "clearance"):
            return self.diagonal
        return self.force * self.diagonal if goal == "torque" else 1.0

    @property
    def force(self) -> float:
        """The payload's weight, N."""
        return self.payload * GRAVITY

    def key(self) -> str:
        """Tells problems apart, for a file that a search goes on from."""
        return hashlib.sha256(json.dumps(vars(self), default=dict).encode()).hexdigest()[:16]

    def box_of(self, x: Array) -> Rectangle:
        """The rectangle of one candidate."""
        if not self.free_height:
            return self.box
        height = self.box.y_max - self.box.y_min
        return Rectangle(self.box.x_min, self.box.x_max, float(x[3]), float(x[3] + height))

    def linkage(self, x: Array) -> FiveBar:
        """The five-bar of one candidate; its masses are not part of the question."""
        l1, l2, e = x[:3].tolist()
        return FiveBar(l1, l2, e, payload=self.payload, name="designed")

    def asked(self) -> list[str]:
        """Goals that are weighed or limited."""
        return list(dict.fromkeys([*self.weights, *self.limits]))

    def pieces(self, x: Array, points: Array) -> dict[str, Array]:
        """Worst-case pieces of P candidates at K points: (P, K, k) for each goal; NaN out of reach.

        Args:
            x: (P, variables). points: (K, 2) over the unit square, or (P, K, 2).
        """
        count, corner = len(x), np.array([self.box.x_min, self.box.y_min])
        size = np.array([self.box.x_max, self.box.y_max]) - corner
        corners = np.broadcast_to(corner, (count, 2)).copy()
        if self.free_height:
            corners[:, 1] = x[:, 3]
        xy = (corners[:, None] + size * points).reshape(-1, 2)
        rows = np.repeat(x, len(points), axis=0)
        l1, l2 = (np.repeat(rows[:, k : k + 1], 2, axis=1) for k in (0, 1))
        bars = Candidates(l1, l2, rows[:, 2])
        with np.errstate(all="ignore"):
            pose = smooth_pose(bars, xy, read_mode(self.mode))
            out = {"reach": _out_of_reach(bars, xy).reshape(count, len(points), -1)}
            rods = pose.rods.reshape(count, len(points))
            side = np.sign(np.nansum(np.sign(rods), axis=1))  # the assembly of most of the points
            out["rods"] = -(rods * side[:, None])[..., None]
            for goal in self.asked():
                of = GOALS[goal].pieces
                if of is not None:
                    scale = self.force if goal == "torque" else 1.0
                    out[goal] = scale * of(bars, pose).reshape(count, len(points), -1)
        return out

    def excess(self, x: Array, pieces: dict[str, Array]) -> dict[str, Array]:
        """By how much each limit is exceeded at each point, in its own unit; (P, ...)."""
        out = {"reach": pieces["reach"], "rods": pieces["rods"] + TOLERANCES.design_sine}
        for goal, limit in self.limits.items():
            allowed = GOALS[goal].inner(limit)
            scale = max(abs(allowed), 1e-12)
            values = pieces[goal] if goal in pieces else size_of(x)[:, None, None]
            out[goal] = (values - allowed) / scale
        return out

    def values(self, x: Array, pieces: dict[str, Array]) -> dict[str, Array]:
        """Worst of each weighed goal over the points, (P,)."""
        return {
            goal: pieces[goal].max(axis=(1, 2)) if goal in pieces else size_of(x)
            for goal in self.weights
        }

    def cost(self, x: Array, points: Array) -> Array:
        """What P candidates cost at the points, (P,): the weighed goals, or how far they miss."""
        pieces = self.pieces(x, points)
        breaks = np.zeros(len(x))
        for values in self.excess(x, pieces).values():
            worst = np.nan_to_num(values, nan=1.0, posinf=1e6).max(axis=(1, 2))
            breaks = breaks + np.maximum(worst, 0.0)
        mix = np.zeros(len(x))
        for goal, value in self.values(x, pieces).items():
            mix = mix + self.weights[goal] * value / self.unit(goal)
        fine = (breaks <= TOLERANCES.design_slack) & np.isfinite(mix)
        return np.where(fine, mix, _OUT * (1.0 + breaks))

    def proved(self, x: Array) -> tuple[dict[str, tuple[float, float]], Array]:
        """Value and bound of every goal over the whole rectangle, and the worst places.

        The linkage must reach the rectangle, and its rods must not get in line on the corners.

        Returns:
            (value, bound) by goal, of all goals, as the pieces have them; places (K, 2), m.
        """
        linkage, box = self.linkage(x), self.box_of(x)
        middle = [[0.5 * (box.x_min + box.x_max), 0.5 * (box.y_min + box.y_max)]]
        side = np.sign(smooth_pose(linkage, np.array(middle), read_mode(self.mode)).rods[0])
        out, places = {"size": (float(x[:3].sum()),) * 2}, []
        of_poses = {name: one.pieces for name, one in GOALS.items() if one.pieces is not None}

        def rods(bars: Any, pose: Any) -> Any:
            del bars
            return -(side * pose.rods)[:, None]

        of_poses["rods"] = rods
        for name, of in of_poses.items():  # one by one: a gap that closes slowly delays no other
            weighed = name in self.weights or name in self.limits
            gap = TOLERANCES.weighed_gap if weighed else TOLERANCES.reported_gap
            value, place, bound = bound_over(linkage, box, self.mode, partial(of, linkage), gap)
            scale = self.force if name == "torque" else 1.0
            out[name] = (scale * float(value.max()), scale * float(bound.max()))
            places.append(place)
        return out, np.concatenate(places)


def size_of(x: Array) -> Array:
    """l1 + l2 + e of candidates, (P,), m."""
    return np.asarray(x[:, :3].sum(axis=1))


def _out_of_reach(bars: Candidates, xy: Array) -> Array:
    """(N, 4), above zero where a point is out of a leg's reach, in parts of the leg's length."""
    d = np.hypot(xy[:, :1] - bars.base_x, xy[:, 1:])
    whole, fold = bars.l1 + bars.l2, np.abs(bars.l1 - bars.l2)
    edge = 1e-6
    return np.concatenate([d / whole - 1.0 + edge, fold / whole - d / whole + edge], axis=1)


def read_problem(
    workspace: ArrayLike,
    goal: str | Mapping[str, float],
    l1: Range,
    l2: Range,
    e: Range,
    height: Range,
    limits: Mapping[str, float] | None,
    payload: float | None,
    mode: Mode | None,
) -> Problem:
    """Reads the arguments of :func:`kinlab.design_fivebar`.

    Raises:
        OptionError: as there.
    """
    what = "design_fivebar"
    box = read_rectangle(workspace, what)
    if not (box.x_max > box.x_min and box.y_max > box.y_min):
        raise OptionError(f"{what}: workspace {tuple(box)} has no area; give it two sides")
    shortest = min(box.x_max - box.x_min, box.y_max - box.y_min)
    if shortest < _SPAN[0] or np.max(np.abs(box)) > _SPAN[1]:
        raise OptionError(
            f"{what}: workspace {tuple(box)} is no machine's, its shorter side being {shortest:g} "
            f"m; metres between {_SPAN[0]:g} and {_SPAN[1]:g} are taken"
        )
    weights = _weights(goal)
    asked = _limits(limits)
    needs = [name for name in ("torque",) if name in weights or name in asked]
    if needs and payload is None:
        raise OptionError(f"{what}: the goal torque needs the payload, kg; give payload=")
    mass = 0.0 if payload is None else number(payload, f"{what}: payload", above=0.0)
    tall = box.y_max - box.y_min
    far = float(np.hypot(max(abs(box.x_min), abs(box.x_max)), max(abs(box.y_min), abs(box.y_max))))
    far = far if height is None else float(np.hypot(box.x_max - box.x_min, tall))
    least, most = (part * far for part in _SIZES)
    ranges = [
        _range(value, f"{what}: {name}", (0.0 if name == "e" else least, most))
        for name, value in (("l1", l1), ("l2", l2), ("e", e))
    ]
    for name, (low, _) in zip(("l1", "l2", "e"), ranges, strict=True):
        if low < 0.0 or (low == 0.0 and name != "e"):
            raise OptionError(f"{what}: {name} starts at {low:g} m; lengths are positive")
    if height is not None:
        ranges.append(_range(height, f"{what}: height", (-2.0 * most, 0.0)))
    side = -1.0 if height is None and 0.5 * (box.y_min + box.y_max) > 0.0 else 1.0
    if height is not None and sum(ranges[3]) + tall > 0.0:
        side = -1.0
    signs = read_mode(mode if mode is not None else np.asarray(HANGING) * side)
    return Problem(
        box=box,
        free_height=height is not None,
        mode=(int(signs[0]), int(signs[1])),
        lengths=tuple(ranges),
        weights=weights,
        limits=asked,
        payload=mass,
    )


def _weights(goal: Any) -> dict[str, float]:
    if isinstance(goal, str):
        return {word(goal, GOALS, "design_fivebar: goal"): 1.0}
    if not isinstance(goal, Mapping) or not goal:
        raise OptionError(
            f"design_fivebar: goal is {shown(goal)}; give a name, or names with weights"
        )
    out = {}
    for name, weight in goal.items():
        word(name, GOALS, "design_fivebar: goal")
        out[name] = number(weight, f"design_fivebar: weight of {name}", above=0.0)
    return out


def _limits(limits: Any) -> dict[str, float]:
    if limits is None:
        return {}
    if not isinstance(limits, Mapping):
        raise OptionError(f"design_fivebar: limits is {shown(limits)}; give names with numbers")
    out = {}
    for name, limit in limits.items():
        word(name, GOALS, "design_fivebar: limit")
        value = number(limit, f"design_fivebar: limit of {name}", above=0.0)
        if name == "transmission" and not value < 90.0:
            raise OptionError(
                f"design_fivebar: limit of transmission is {value:g}°; it is an angle below 90°"
            )
        if name == "condition" and not value > 1.0:
            raise OptionError(f"design_fivebar: limit of condition is {value:g}; above 1")
        out[name] = value
    return out


def _range(value: Any, what: str, default: tuple[float, float]) -> tuple[float, float]:
    if value is None:
        return default
    if isinstance(value, Sequence) and not isinstance(value, str) and len(value) == 2:
        low, high = (number(each, what) for each in value)
        if max(abs(low), abs(high)) > _SPAN[1]:
            raise OptionError(f"{what} is ({low:g}, {high:g}); at most {_SPAN[1]:g} m")
        if low > high:
            raise OptionError(f"{what} is ({low:g}, {high:g}); give the least first")
        return low, high
    one = number(value, what)
    if abs(one) > _SPAN[1]:
        raise OptionError(f"{what} is {one:g}; at most {_SPAN[1]:g} m")
    return one, one
