"""The pick-and-place cycle: up, across, down, and back, with blended corners.

The standard test of fast robots is 25 mm up, 305 mm across, 25 mm down (the Adept cycle). Each
leg of it follows 10 tau³ - 15 tau⁴ + 6 tau⁵, and neighbours overlap in time, which rounds the
corners: position, velocity and acceleration are continuous.

Time may be stretched uniformly: by lambda, velocities fall as 1/lambda and accelerations as
1/lambda², so the fastest cycle within limits follows in closed form from one evaluation.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import ArrayLike

from kinlab.arrays import Array, real_array, shaped
from kinlab.drives.laws import QUINTIC_ACCELERATION, QUINTIC_SPEED, rising
from kinlab.errors import OptionError

LIFT, TRAVEL = 0.025, 0.305
"""The Adept cycle, m."""


@dataclass(frozen=True)
class Path:
    """A motion of the tool.

    Attributes:
        t: times, (K,), s.
        points: positions, (K, d), m; d is 2 in the plane and 3 in space.
        v: velocities, (K, d), m/s.
        a: accelerations, (K, d), m/s².
        carried: mass at the tool beside the machine's own, (K,), kg; none: nothing.
    """

    t: Array
    points: Array
    v: Array
    a: Array
    carried: Array | None = None

    @property
    def duration(self) -> float:
        """s."""
        return float(self.t[-1])

    @property
    def held(self) -> Path:
        """The same places with the tool at rest in each of them."""
        still = np.zeros_like(self.v)
        return Path(self.t, self.points, still, still, self.carried)

    def stretched(self, factor: float) -> Path:
        """The same way in ``factor`` times the time."""
        v, a = self.v / factor, self.a / factor**2
        return Path(self.t * factor, self.points, v, a, self.carried)


def pick_and_place(
    centre: ArrayLike,
    v_max: float,
    a_max: float,
    lift: float = LIFT,
    travel: float = TRAVEL,
    blend: float = 0.5,
    samples: int = 2001,
    across: ArrayLike = (1.0, 0.0),
    up: ArrayLike = (0.0, 1.0),
) -> Path:
    """The cycle there and back, as fast as the tool's limits allow.

    Args:
        centre: the middle between pick and place, (d,), m; the lift goes up from there.
        v_max: largest speed of the tool, m/s. a_max: largest acceleration, m/s².
        lift: along ``up``, m. travel: along ``across``, m.
        blend: part of the shorter neighbour that overlaps at a corner, 0 (stop there) to 1.
        samples: points of the whole cycle.
        across, up: unit vectors, (d,), at right angles; the defaults are x and y of the plane.

    Returns:
        A path that reaches one of the two limits exactly and keeps the other.

    Raises:
        OptionError: a limit or length that is not positive, a blend outside 0 to 1.
    """
    way = real_array(across, "cycle: across", OptionError)
    if way.ndim != 1:
        raise OptionError(f"cycle: across has shape {way.shape}; expected (2,) or (3,)")
    rise = shaped(up, way.shape, "cycle: up", OptionError)
    if not np.allclose([way @ way, rise @ rise, way @ rise], [1.0, 1.0, 0.0], rtol=0, atol=1e-9):
        raise OptionError("cycle: across and up must be unit vectors at right angles")
    middle = shaped(centre, way.shape, "cycle: centre")
    for name, value in (("v_max", v_max), ("a_max", a_max), ("lift", lift), ("travel", travel)):
        if not (np.isfinite(value) and value > 0):
            raise OptionError(f"cycle: {name} is {value!r}; it must be positive")
    if not 0.0 <= blend <= 1.0:
        raise OptionError(f"cycle: blend is {blend!r}; it must lie between 0 and 1")
    if samples < 101:
        raise OptionError(f"cycle: samples is {samples}; it must be at least 101")
    lengths = np.array([lift, travel, lift])
    spans = np.maximum(
        QUINTIC_SPEED * lengths / v_max, np.sqrt(QUINTIC_ACCELERATION * lengths / a_max)
    )
    starts = np.concatenate(
        [[0.0], np.cumsum(spans[:-1] - blend * np.minimum(spans[:-1], spans[1:]))]
    )
    half = float((starts + spans).max())
    moves = np.array([lift * rise, travel * way, -lift * rise] * 2)
    moves[4] = -moves[1]
    path = superpose(
        middle - 0.5 * travel * way,
        moves,
        np.concatenate([starts, starts + half]),
        np.concatenate([spans, spans]),
        np.linspace(0.0, 2.0 * half, samples),
    )
    fastest = np.linalg.norm(path.v, axis=1).max() / v_max
    hardest = np.sqrt(np.linalg.norm(path.a, axis=1).max() / a_max)
    return path.stretched(float(max(fastest, hardest)))


def superpose(start: Array, moves: Array, begins: Array, spans: Array, t: Array) -> Path:
    """The sum of moves (M, d), each by the fifth-degree law from its begin over its span."""
    tau = np.clip((t[:, None] - begins) / spans, 0.0, 1.0)
    s, s1, s2 = rising(tau)
    return Path(t, start + s @ moves, (s1 / spans) @ moves, (s2 / spans**2) @ moves)
