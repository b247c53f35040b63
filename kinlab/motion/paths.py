"""Paths of the tool in space: lines and arcs from pose to pose, blended where they meet.

Leg k is a curve of position with parameter s_k from 0 to 1, and a turn about one axis fixed in the
tool, by exp([w_k] s_k): what is called slerp. Where neighbours overlap in time their displacements
add and their turns multiply, which rounds the corner: with a smooth law, position, velocity and
acceleration are continuous. Source: Lynch and Park, *Modern Robotics*, section 9.2 (decoupled
rotation and translation); Siciliano et al., *Robotics*, section 4.3.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from typing import Any, NamedTuple

import numpy as np
import pinocchio as pin
from numpy.typing import ArrayLike

from kinlab.arrays import Array, rigid_transform, shaped
from kinlab.drives import laws
from kinlab.errors import OptionError
from kinlab.model.rotations import rotations_along


@dataclass(frozen=True)
class Arc:
    """A leg along a circle.

    Attributes:
        via: a point that the tool passes, (3,), m, in the base.
        end: the pose where it ends, (4, 4).
    """

    via: ArrayLike
    end: ArrayLike


class Leg(NamedTuple):
    """From one pose to the next.

    Attributes:
        length: of the path, m. rotation_vector: in the tool's axes at the start, (3,), rad.
        displacement: for a line, end minus start, (3,), m.
        centre, radius, first, second, angle: for an arc: position is
            centre + radius (cos(s angle) first + sin(s angle) second); angle is 0 for a line.
    """

    length: float
    rotation_vector: Array
    displacement: Array
    radius: float = 0.0
    first: Array = np.zeros(3)
    second: Array = np.zeros(3)
    angle: float = 0.0

    @property
    def curvature(self) -> float:
        """1/m."""
        return 1.0 / self.radius if self.angle else 0.0

    def moved(self, s: Array, speed: Array, gain: Array) -> tuple[Array, Array, Array]:
        """Displacement from the start, velocity and acceleration, (N, 3), of s(t)."""
        s, speed, gain = (x[:, np.newaxis] for x in (s, speed, gain))
        if not self.angle:
            return s * self.displacement, speed * self.displacement, gain * self.displacement
        c, sn = np.cos(s * self.angle), np.sin(s * self.angle)
        out = self.radius * (c * self.first + sn * self.second)
        along = self.radius * self.angle * (c * self.second - sn * self.first)
        return (
            out - self.radius * self.first,
            speed * along,
            gain * along - (speed * self.angle) ** 2 * out,
        )


class TimedPath(NamedTuple):
    """Legs with their laws and when each begins: the tool's motion at any time.

    Attributes:
        start: (4, 4). legs: the legs. laws: s of each over its own time. begins: s.
    """

    start: Array
    legs: tuple[Leg, ...]
    laws: tuple[Any, ...]
    begins: Array

    @property
    def duration(self) -> float:
        """s."""
        return float(max(b + law.x[-1] for b, law in zip(self.begins, self.laws, strict=True)))

    @property
    def knots(self) -> Array:
        """Times at which the acceleration may jump, s."""
        times = [b + law.x for b, law in zip(self.begins, self.laws, strict=True)]
        found = np.unique(np.concatenate([[0.0, self.duration], *times]))
        kept: Array = found[np.concatenate([[True], np.diff(found) > 1e-9 * self.duration])]
        kept[-1] = self.duration
        return kept

    def stretched(self, factor: float) -> TimedPath:
        """The same way in ``factor`` times the time."""
        slower = []
        for law in self.laws:
            powers = np.arange(len(law.c) - 1, -1, -1.0)
            slower.append(type(law)(law.c / factor ** powers[:, np.newaxis], law.x * factor))
        return TimedPath(self.start, self.legs, tuple(slower), self.begins * factor)

    def at(self, t: Array, side: str = "right") -> tuple[Array, Array, Array]:
        """Poses (N, 4, 4), twists and their derivatives (N, 6), linear first, in base axes."""
        count = len(t)
        place = np.broadcast_to(self.start[:3, 3], (count, 3)).copy()
        rotation = np.broadcast_to(self.start[:3, :3], (count, 3, 3)).copy()
        twist, change = np.zeros((count, 6)), np.zeros((count, 6))
        for leg, law, begin in zip(self.legs, self.laws, self.begins, strict=True):
            s, speed, gain = laws.values(law, t - begin, side)
            shift, velocity, acceleration = leg.moved(s, speed, gain)
            place += shift
            twist[:, :3] += velocity
            change[:, :3] += acceleration
            if np.any(leg.rotation_vector):
                # in the base, carried along by the legs before
                axis = rotation @ leg.rotation_vector
                carried = np.cross(twist[:, 3:], axis)
                change[:, 3:] += gain[:, np.newaxis] * axis + speed[:, np.newaxis] * carried
                twist[:, 3:] += speed[:, np.newaxis] * axis
                rotation = rotation @ rotations_along(leg.rotation_vector, s)
        poses = np.zeros((count, 4, 4))
        poses[:, :3, :3], poses[:, :3, 3], poses[:, 3, 3] = rotation, place, 1.0
        return poses, twist, change


def read_legs(name: str, poses: Sequence[Any] | ArrayLike) -> tuple[Array, tuple[Leg, ...]]:
    """The start, (4, 4), and the legs from pose to pose.

    Raises:
        StateError: a pose that is not rigid, a via point of another shape.
        OptionError: fewer than two poses, a leg that goes nowhere, a half turn, an arc through
            three points on one line; says which leg.
    """
    given = list(poses) if isinstance(poses, (list, tuple, np.ndarray)) else []
    if len(given) < 2:
        raise OptionError(f"robot {name!r}: give at least two poses, the first where it starts")
    where = f"robot {name!r}: pose 1"
    if isinstance(given[0], Arc):
        raise OptionError(f"{where} is an arc; the first is the pose where the motion starts")
    start = _pose(given[0], where)
    here, legs = start, []
    for row, one in enumerate(given[1:], 2):
        where = f"robot {name!r}: pose {row}"
        end = _pose(one.end if isinstance(one, Arc) else one, where)
        rotation_vector = np.asarray(pin.log3(here[:3, :3].T @ end[:3, :3]))
        if np.linalg.norm(rotation_vector) > np.pi - 1e-6:
            raise OptionError(
                f"{where} is a half turn from the pose before: which way round is not given; put "
                "a pose between"
            )
        rotation_vector = np.where(np.linalg.norm(rotation_vector) > 1e-12, rotation_vector, 0.0)
        displacement = end[:3, 3] - here[:3, 3]
        if isinstance(one, Arc):
            via = shaped(one.via, (3,), f"{where}: via")
            legs.append(_arc(here[:3, 3], via, end[:3, 3], rotation_vector, where))
        else:
            length = float(np.linalg.norm(displacement))
            if length <= 1e-12 and not rotation_vector.any():
                raise OptionError(f"{where} is the pose before; leave it out")
            legs.append(Leg(length, rotation_vector, displacement))
        here = end
    return start, tuple(legs)


def _pose(value: Any, where: str) -> Array:
    return rigid_transform(shaped(value, (4, 4), where), where)


def _arc(start: Array, via: Array, end: Array, rotation_vector: Array, where: str) -> Leg:
    """The arc from start through via to end."""
    one, two = via - start, end - start
    normal = np.cross(one, two)
    size = float(normal @ normal)
    if size <= 1e-12 * float(one @ one) * float(two @ two) or not float(one @ one) > 0.0:
        raise OptionError(f"{where}: start, via and end lie on one line; an arc needs a corner")
    offset = np.cross(float(one @ one) * two - float(two @ two) * one, normal) / (2.0 * size)
    radius = float(np.linalg.norm(offset))
    first = -offset / radius
    second = np.cross(normal / np.sqrt(size), first)
    far = two - offset
    angle = float(np.arctan2(far @ second, far @ first) % (2.0 * np.pi))
    return Leg(radius * angle, rotation_vector, two, radius, first, second, angle)
