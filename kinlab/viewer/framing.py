"""Where to look from, and how large to draw, so that the mechanism fills the picture."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any

import numpy as np

from kinlab.arrays import Array

_FIELD_OF_VIEW = 35.0
"""Vertical, degrees. meshcat's own 75 bends everything near the edge."""


@dataclass(frozen=True)
class Camera:
    """Position and target in the world, metres, (3,) each."""

    position: Array
    target: Array

    def as_json(self) -> dict[str, Any]:
        """Plain values for the page."""
        return {
            "position": [float(x) for x in self.position],
            "target": [float(x) for x in self.target],
            "fov": _FIELD_OF_VIEW,
        }


def look_at(points: Array, direction: Array, margin: float) -> Camera:
    """A camera that sees all points.

    Args:
        points: (N, 3), metres.
        direction: from the target towards the camera, (3,).
        margin: what must be visible around them, metres.
    """
    low, high = points.min(axis=0), points.max(axis=0)
    target = 0.5 * (low + high)
    radius = 0.5 * float(np.linalg.norm(high - low)) + margin
    distance = radius / np.sin(np.radians(_FIELD_OF_VIEW / 2))
    return Camera(target + distance * direction / np.linalg.norm(direction), target)


def round_step(size: float) -> float:
    """A step 1, 2 or 5 times a power of ten, about a fifth of ``size``."""
    power = 10.0 ** np.floor(np.log10(size / 5))
    return float(power * max(k for k in (1, 2, 5) if k * power <= size / 5 * (1 + 1e-9)))
