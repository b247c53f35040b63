"""How far a pose of a five-bar is from the three kinds of singularity.

Type I: crank and rod of a leg in line; the tool loses a direction. Type II: the rods in line;
the tool moves while the cranks stand. Type III: both.

Source: Gosselin & Angeles 1990, doi 10.1109/70.56660; note 003 for the symbols.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import ArrayLike

from kinlab.arrays import Array
from kinlab.errors import OptionError
from kinlab.fivebar.linkage import Linkage
from kinlab.fivebar.pose import HANGING, Mode, read_points, solve_pose
from kinlab.fivebar.workspace import room


@dataclass(frozen=True)
class Distances:
    """Signed distances to singularity; leading axis as the points given.

    Attributes:
        outer: l1 + l2 - |P - A_i|, (..., 2), m; negative out of reach.
        inner: |P - A_i| - |l1 - l2|, (..., 2), m; negative out of reach.
        legs: u_i x w_i, (..., 2); its sign is the working mode, 0 is type I.
        rods: w_1 x w_2, (...); its sign is the assembly mode, 0 is type II.
        type_two: to the type II curve of this working mode, (...), m, with the sign of ``rods``;
            infinite where the mode has no such curve.
    """

    outer: Array
    inner: Array
    legs: Array
    rods: Array
    type_two: Array


def distances(linkage: Linkage, xy: ArrayLike, mode: Mode = HANGING) -> Distances:
    """Signed distances to the singularities.

    Args:
        linkage: the five-bar.
        xy: (2,) or (N, 2), m; all within reach.
        mode: signs of u_i x w_i.

    Returns:
        Distances; the lengths of type I are exact, that of type II holds to about 1e-6 of the
        linkage's size.

    Raises:
        UnreachableError: a point out of reach.
    """
    from scipy.spatial import cKDTree

    pose = solve_pose(linkage, xy, mode)
    d = np.hypot(pose.xy[:, :1] - linkage.base_x, pose.xy[:, 1:])
    l1, l2 = np.asarray(linkage.l1), np.asarray(linkage.l2)
    curve = room(linkage, mode).curve
    along = np.full(len(d), np.inf)
    if len(curve):
        along = cKDTree(curve).query(pose.xy)[0]
    return Distances(
        pose.give(l1 + l2 - d),
        pose.give(d - np.abs(l1 - l2)),
        pose.give(pose.sine),
        pose.give(pose.rods),
        pose.give(np.where(pose.rods < 0.0, -along, along)),
    )


def classify(
    linkage: Linkage, xy: ArrayLike, mode: Mode = HANGING, sine: float = 1e-6
) -> list[str]:
    """Names the kind of each pose.

    Args:
        linkage: the five-bar.
        xy: (2,) or (N, 2), m.
        mode: signs of u_i x w_i.
        sine: two bars are in line when the sine of their angle is at most this.

    Returns:
        For each point ``"regular"``, ``"I"``, ``"II"``, ``"III"`` or ``"out of reach"``.

    Raises:
        OptionError: a threshold outside [0, 1].
    """
    if not 0.0 <= sine <= 1.0:
        raise OptionError(f"sine is {sine!r}; it must lie between 0 and 1")
    points, _ = read_points(xy, f"{linkage.name}: xy")
    pose = solve_pose(linkage, points, mode, "mask")
    first = np.abs(pose.sine).min(axis=1) <= sine
    second = np.abs(pose.rods) <= sine
    names = np.array([["regular", "II"], ["I", "III"]])[first.astype(int), second.astype(int)]
    return [str(n) if ok else "out of reach" for n, ok in zip(names, pose.ok, strict=True)]
