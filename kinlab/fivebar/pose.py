"""Poses of a five-bar: the closed-form triangles that everything else is built on.

Each leg is a triangle of sides l1, l2 and d = |P - A|. Its height comes from Heron's product
with every factor a difference of lengths, so the edge of the workspace is exact to rounding,
and no half-tangent is taken, so nothing divides by A + C (note 003, 003.tan).
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from typing import Literal

import numpy as np
from numpy.typing import ArrayLike, NDArray

from kinlab.arrays import Array, real_array, shown
from kinlab.errors import OptionError, SingularError, StateError, UnreachableError
from kinlab.fivebar.linkage import Linkage
from kinlab.tolerances import TOLERANCES

Mode = Sequence[int] | Array
OnUnreachable = Literal["raise", "mask"]
Mask = NDArray[np.bool_]

HANGING: Mode = (-1, 1)
"""The default working mode: elbows outward with the tool below the base, as Huang's robot."""

MODES: tuple[tuple[int, int], ...] = ((1, 1), (1, -1), (-1, 1), (-1, -1))


@dataclass(frozen=True)
class Pose:
    """N poses in one working mode; rows where ``ok`` is false hold harmless numbers.

    Attributes:
        xy: tool, (N, 2), m.
        u: unit vectors along the cranks, (N, 2 legs, 2).
        w: unit vectors along the rods, (N, 2 legs, 2).
        sine: u_i x w_i of each leg, (N, 2); 0 at a type I singularity.
        rods: w_1 x w_2, (N,); 0 at a type II singularity.
        ok: the pose exists and has what was asked of it, (N,).
        single: the caller gave one point and gets one answer.
        masked: the caller wants a masked array.
    """

    xy: Array
    u: Array
    w: Array
    sine: Array
    rods: Array
    ok: Mask
    single: bool
    masked: bool

    def give(self, result: Array) -> Array:
        """Hands a result of leading axis N back in the shape that the caller used."""
        return deliver(result, self.ok, single=self.single, masked=self.masked)


def deliver(result: Array, ok: Mask, *, single: bool, masked: bool) -> Array:
    """Masks the rows that are not ok if the caller wants that, and drops the axis of one point."""
    if masked:
        hidden = ~ok.reshape((-1,) + (1,) * (result.ndim - 1))
        result = np.ma.masked_array(result, np.broadcast_to(hidden, result.shape).copy())
    answer: Array = result[0] if single else result
    return answer


def read_points(value: ArrayLike, what: str) -> tuple[Array, bool]:
    """Reads (2,) or (N, 2) as (N, 2), and says whether it was one point.

    Raises:
        StateError: another shape, not numbers, not finite.
    """
    points = real_array(value, what)
    if points.ndim not in (1, 2) or points.shape[-1] != 2:
        raise StateError(f"{what} has shape {points.shape}; expected (2,) or (N, 2)")
    return np.atleast_2d(points), points.ndim == 1


def read_vectors(value: ArrayLike, poses: Pose, what: str) -> Array:
    """Reads one vector per pose; a single (2,) serves all of them.

    Raises:
        StateError: another shape, not numbers, not finite.
    """
    vectors, _ = read_points(value, what)
    if len(vectors) not in (1, len(poses.xy)):
        raise StateError(f"{what} has {len(vectors)} rows; there are {len(poses.xy)} points")
    return np.broadcast_to(vectors, poses.xy.shape)


def read_mode(mode: Mode) -> Array:
    """Reads a working mode as two signs.

    Raises:
        OptionError: not a pair of +1 and -1.
    """
    try:
        signs = np.asarray(mode)
    except Exception:  # noqa: BLE001  whatever an object's own __array__ raises
        signs = np.empty(0)
    if signs.shape != (2,) or signs.dtype.kind not in "if" or not np.all(np.abs(signs) == 1):
        raise OptionError(
            f"mode {shown(mode)} does not exist; choose one of {', '.join(map(str, MODES))}: "
            "the signs of u_1 x w_1 and u_2 x w_2"
        )
    return signs.astype(np.float64)


def read_choice(choice: str) -> bool:
    """True for ``"mask"``, false for ``"raise"``.

    Raises:
        OptionError: anything else.
    """
    if not isinstance(choice, str) or choice not in ("raise", "mask"):
        raise OptionError(f'on_unreachable is {shown(choice)}; choose "raise" or "mask"')
    return choice == "mask"


def crank_directions(linkage: Linkage, xy: Array, signs: Array) -> tuple[Array, Array, Mask]:
    """Solves both triangles; axis 0 is the leg, so that numpy runs over long rows.

    Args:
        linkage: the five-bar.
        xy: (N, 2), m.
        signs: s_1, s_2.

    Returns:
        (2 legs, 2, N) crank directions; (2, N) signed u x w; (2, N) leg can reach. Where it
        cannot, the numbers are finite and mean nothing.
    """
    l1, l2 = np.asarray(linkage.l1)[:, None], np.asarray(linkage.l2)[:, None]
    sign = signs[:, None]
    dx = xy[:, 0] - linkage.base_x[:, None]
    dy = xy[:, 1]
    d = np.hypot(dx, dy)
    outer = (l1 + l2) - d
    inner = d - np.abs(l1 - l2)
    slack = -8.0 * np.finfo(float).eps * (l1 + l2 + linkage.e)  # rounding of the point itself
    reach = (outer >= slack) & (inner >= slack) & (d > 0.0)
    d = np.where(reach, d, l1 + l2)
    height = (l1 + l2 + d) * np.maximum(outer, 0.0) * np.maximum(inner, 0.0)
    height = np.sqrt(height * (d + np.abs(l1 - l2)))  # four times the triangle's area
    cosine = (d + (l1 - l2) * (l1 + l2) / d) / (2.0 * l1 * d)
    sine = sign * height / (2.0 * l1 * d * d)
    u = np.stack([dx * cosine + dy * sine, dy * cosine - dx * sine], axis=1)
    return u, sign * height / (2.0 * l1 * l2), reach


def solve_pose(
    linkage: Linkage,
    xy: ArrayLike,
    mode: Mode = HANGING,
    on_unreachable: OnUnreachable = "raise",
    *,
    regular: str = "",
) -> Pose:
    """Solves the closed-form inverse kinematics and checks what the caller needs of it.

    Args:
        linkage: the five-bar.
        xy: (2,) or (N, 2), m.
        mode: signs of u_i x w_i.
        on_unreachable: refuse, or mark the pose as not ok.
        regular: which singularities the caller cannot take: ``"I"``, ``"II"`` or ``"I II"``.

    Raises:
        UnreachableError: a point no leg pose can hold; says which, and by how much.
        SingularError: a pose excluded by ``regular``.
    """
    signs, masked = read_mode(mode), read_choice(on_unreachable)
    points, single = read_points(xy, f"{linkage.name}: xy")
    u, sine, reach = crank_directions(linkage, points, signs)
    ok: Mask = np.asarray(reach.all(axis=0))
    if not masked and not ok.all():
        raise _unreachable(linkage, points, reach)
    u = np.moveaxis(u, 2, 0)
    base = np.stack([linkage.base_x, np.zeros(2)], axis=1)
    arm = points[:, None, :] - base
    w = (arm - np.asarray(linkage.l1)[:, None] * u) / np.asarray(linkage.l2)[:, None]
    rods = cross(w[:, 0], w[:, 1])
    sine = sine.T
    kinds = regular.split()
    if "I" in kinds:
        ok = ok & (np.abs(sine).min(axis=1) > TOLERANCES.singular_sine)
    if "II" in kinds:
        ok = ok & (np.abs(rods) > TOLERANCES.singular_sine)
    if not masked and not ok.all():
        raise _singular(linkage, points, sine, rods, int(np.argmin(ok)))
    if not ok.all():  # harmless numbers where nothing may be said
        u = np.where(ok[:, None, None], u, np.eye(2))
        w = np.where(ok[:, None, None], w, np.eye(2)[::-1])
        sine, rods = np.where(ok[:, None], sine, 1.0), np.where(ok, rods, 1.0)
    return Pose(points, u, w, sine, rods, ok, single, masked)


def cross(a: Array, b: Array) -> Array:
    """k · (a x b) of plane vectors along the last axis."""
    result: Array = a[..., 0] * b[..., 1] - a[..., 1] * b[..., 0]
    return result


def turned(a: Array) -> Array:
    """k x a: plane vectors along the last axis, turned by +90 degrees."""
    return np.stack([-a[..., 1], a[..., 0]], axis=-1)


def reachable(linkage: Linkage, xy: ArrayLike) -> Mask:
    """Which points the tool can reach; the same for all four working modes.

    Args:
        linkage: the five-bar.
        xy: (2,) or (N, 2), m.

    Returns:
        bool () or (N,): inside both annuli |l1 - l2| <= |P - A_i| <= l1 + l2, edges included.
        A base pin itself is not reachable: the crank's angle would be undetermined there.

    Raises:
        StateError: xy of another shape, or not finite.
    """
    points, single = read_points(xy, f"{linkage.name}: xy")
    ok: Mask = np.asarray(crank_directions(linkage, points, np.ones(2))[2].all(axis=0))
    return ok[0] if single else ok


def _unreachable(linkage: Linkage, points: Array, reach: Mask) -> UnreachableError:
    point = int(np.argmin(reach.all(axis=0)))
    leg = int(np.argmin(reach[:, point]))
    place = f"{linkage.name}: point {point} at ({points[point, 0]:.9g}, {points[point, 1]:.9g}) m"
    d = float(np.hypot(points[point, 0] - linkage.base_x[leg], points[point, 1]))
    near = abs(np.asarray(linkage.l1)[leg] - np.asarray(linkage.l2)[leg])
    far = np.asarray(linkage.l1)[leg] + np.asarray(linkage.l2)[leg]
    count = int(np.sum(~reach.all(axis=0)))
    more = f" ({count} of {len(points)} points cannot be reached)" if len(points) > 1 else ""
    if d == 0.0 and near == 0.0:
        return UnreachableError(
            f"{place} is the base pin of leg {leg + 1}, where its angle is undetermined{more}"
        )
    miss = f"{d - far:.3g} m too far" if d > far else f"{near - d:.3g} m too near"
    return UnreachableError(
        f"{place} is {miss} for leg {leg + 1}, which reaches {near:.9g} to {far:.9g} m{more}; "
        'reachable() tells which points can be used, on_unreachable="mask" masks the others'
    )


def _singular(
    linkage: Linkage, points: Array, sine: Array, rods: Array, point: int
) -> SingularError:
    place = f"{linkage.name}: point {point} at ({points[point, 0]:.9g}, {points[point, 1]:.9g}) m"
    for leg in range(2):
        if abs(sine[point, leg]) <= TOLERANCES.singular_sine:
            return SingularError(
                f"{place} is singular (type I): crank and rod of leg {leg + 1} are in line; "
                "keep off the edge of its reach"
            )
    return SingularError(
        f"{place} is singular (type II): the two rods are in line "
        f"(w1 x w2 = {rods[point]:.3g}); keep the transmission angle off 0 and 180 degrees"
    )
