"""Motions to show a five-bar with: round, straight, and pick and place, inside its free circle."""

from __future__ import annotations

from collections.abc import Callable

import numpy as np

from kinlab.arrays import Array
from kinlab.drives.cycles import pick_and_place
from kinlab.errors import NameUnknownError, near
from kinlab.fivebar import FiveBar
from kinlab.fivebar.arguments import Mode
from kinlab.fivebar.singularity import Circle
from kinlab.host.language import N_, _
from kinlab.viewer.motions import ShownMotion

_SAMPLES = 201


def motion(linkage: FiveBar, kind: str, mode: Mode, assembly: int) -> ShownMotion:
    """A motion of a five-bar by name, within its largest circle free of singularities.

    Args:
        linkage: the five-bar.
        kind: one of :data:`MOTIONS`.
        mode: signs of u_i x w_i.
        assembly: sign of w_1 x w_2.

    Raises:
        NameUnknownError: no motion of that name.
    """
    if kind not in MOTIONS:
        raise NameUnknownError(f"motion {kind!r} of a five-bar; {near(kind, MOTIONS)}")
    name, path = MOTIONS[kind]
    xy, duration = path(linkage.largest_circle(mode, assembly))
    theta = np.unwrap(linkage.ik(xy, mode), axis=0)
    return ShownMotion(_(name), theta, duration)


def _round(free: Circle) -> tuple[Array, float]:
    angle = np.linspace(0.0, 2.0 * np.pi, _SAMPLES)
    ring = np.column_stack([np.cos(angle), np.sin(angle)])
    return np.array(free.centre) + 0.8 * free.radius * ring, 5.0


def _straight(free: Circle) -> tuple[Array, float]:
    across = 0.8 * free.radius * np.cos(np.linspace(0.0, 2.0 * np.pi, _SAMPLES))
    return np.array(free.centre) + np.column_stack([across, np.zeros(_SAMPLES)]), 5.0


def _pick(free: Circle) -> tuple[Array, float]:
    lift = 0.5 * free.radius
    centre = np.array(free.centre) - [0.0, 0.5 * lift]
    speed = 2.0 * free.radius
    cycle = pick_and_place(centre, speed, 4.0 * speed, lift, 1.4 * free.radius, samples=_SAMPLES)
    return cycle.points, float(cycle.t[-1])


MOTIONS: dict[str, tuple[str, Callable[[Circle], tuple[Array, float]]]] = {
    "sweep": (N_("Round the free circle"), _round),
    "line": (N_("Straight line by IK"), _straight),
    "pick": (N_("Pick and place by IK"), _pick),
}
"""What ``kinlab view --animate`` can show of a five-bar: heading and path."""
