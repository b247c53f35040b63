"""Where each shipped arm stands in its drawing: away from where frames hide each other."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

import kinlab as kl
from kinlab.viewer.drawing.fivebar import best_start

POSTURES: dict[str, tuple[float, ...]] = {
    "planar2r": (35, 50),
    "planar2r_rods": (35, 50),
    "planar3r": (30, 40, 35),
    "single_link": (40,),
    "scara": (-20, 60, 0.1, 0),
    "spatial3r": (20, 60, 50),
    "stanford": (-40, -60, 0.6, 0, 40, 0),
    "puma560": (10, 60, -60, 0, 40, 0),
    "puma560_modified": (10, 60, -60, 0, 40, 0),
    "ur5": (-40, -70, 80, -60, -90, 0),
    "ur10": (-40, -70, 80, -60, -90, 0),
    "panda": (15, -30, 0, -120, 0, 110, 45),
}
"""Degrees, metres for a joint that slides."""


def hanging(bar: kl.FiveBar) -> NDArray[np.float64]:
    """Crank angles for a drawing, (2,), rad: where the tool is farthest from what is singular
    below the base, else where the viewer starts."""
    point = np.array(bar.largest_circle((-1, 1), 1).centre)
    return bar.ik(point if point[1] < 0.0 else best_start(bar, 1), mode=(-1, 1))


def posture(table: kl.DHTable) -> NDArray[np.float64]:
    """Joint positions for a drawing, (n,), rad or m; of an arm not listed, its zero."""
    shown = POSTURES.get(table.name, (0.0,) * table.n)
    turns = np.array([link.joint == "revolute" for link in table.links])
    return np.where(turns, np.radians(shown), shown)
