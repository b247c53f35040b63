"""Kinematics of a five-bar in closed form: positions, rates, accelerations.

Every function takes points (2,) or (N, 2) and answers with the matching leading axis. A point
that cannot be reached, or where the quantity does not exist, raises; with
``on_unreachable="mask"`` the answer is a numpy masked array with those rows masked.

Sources: note 003 (003.loop, 003.w, 003.J, 003.acc); Huang et al. 2005, doi 10.1115/1.1898343.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from typing import TYPE_CHECKING

import numpy as np
from numpy.typing import ArrayLike

from kinlab.arrays import Array
from kinlab.errors import OptionError, SingularError, StateError, UnreachableError
from kinlab.fivebar.arguments import (
    HANGING,
    Mask,
    Mode,
    OnUnreachable,
    cross,
    read_assembly,
    read_mode,
    read_on_unreachable,
    read_points,
    read_vectors,
    restore_shape,
)
from kinlab.tolerances import TOLERANCES

if TYPE_CHECKING:
    from kinlab.fivebar.linkage import FiveBar

_BLOCK = 8192
"""Points per pass of a long batch: the working arrays of one pass stay in the cache."""


# -------- Poses: the closed-form triangles that everything else is built on
# Each leg is a triangle of sides l1, l2 and d = |P - A|. Its height comes from Heron's product
# with every factor a difference of lengths, so the edge of the workspace is exact to rounding,
# and no half-tangent is taken, so nothing divides by A + C (note 003, 003.tan).


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

    def restore(self, result: Array) -> Array:
        """Returns a result of leading axis N in the shape that the caller used."""
        return restore_shape(result, self.ok, single=self.single, masked=self.masked)


def crank_directions(linkage: FiveBar, xy: Array, signs: Array) -> tuple[Array, Array, Mask]:
    """Solves both triangles; axis 0 is the leg, so that numpy runs over long rows.

    Args:
        linkage: the five-bar.
        xy: (N, 2), m.
        signs: s_1, s_2.

    Returns:
        (2 legs, 2, N) crank directions; (2, N) signed u x w; (2, N) leg can reach. Where it
        cannot, the numbers are finite and mean nothing.
    """
    l1, l2 = linkage.l1[:, None], linkage.l2[:, None]
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
    linkage: FiveBar,
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
    signs, masked = read_mode(mode), read_on_unreachable(on_unreachable)
    points, single = read_points(xy, f"{linkage.name}: xy")
    u, sine, reach = crank_directions(linkage, points, signs)
    ok: Mask = np.asarray(reach.all(axis=0))
    if not masked and not ok.all():
        raise _unreachable(linkage, points, reach)
    u = np.moveaxis(u, 2, 0)
    base = np.stack([linkage.base_x, np.zeros(2)], axis=1)
    arm = points[:, None, :] - base
    w = (arm - linkage.l1[:, None] * u) / linkage.l2[:, None]
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


def reachable(linkage: FiveBar, xy: ArrayLike) -> Mask:
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


def _unreachable(linkage: FiveBar, points: Array, reach: Mask) -> UnreachableError:
    point = int(np.argmin(reach.all(axis=0)))
    leg = int(np.argmin(reach[:, point]))
    place = f"{linkage.name}: point {point} at ({points[point, 0]:.9g}, {points[point, 1]:.9g}) m"
    d = float(np.hypot(points[point, 0] - linkage.base_x[leg], points[point, 1]))
    near = abs(linkage.l1[leg] - linkage.l2[leg])
    far = linkage.l1[leg] + linkage.l2[leg]
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
    linkage: FiveBar, points: Array, sine: Array, rods: Array, point: int
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


# -------- Positions


def ik(
    linkage: FiveBar,
    xy: ArrayLike,
    mode: Mode = HANGING,
    on_unreachable: OnUnreachable = "raise",
) -> Array:
    """Inverse kinematics in one of the four working modes (003.loop).

    Existence: both |P - A_i| lie in [|l1 - l2|, l1 + l2]; then each leg has exactly two
    solutions, told apart by the sign of u_i x w_i, which coincide at the edges.

    Args:
        linkage: the five-bar.
        xy: tool, (2,) or (N, 2), m.
        mode: (s_1, s_2), the signs of u_i x w_i.
        on_unreachable: ``"raise"`` or ``"mask"``.

    Returns:
        Crank angles in (-pi, pi], (2,) or (N, 2), rad.

    Raises:
        UnreachableError: a point out of reach, named with how far.
        StateError: xy of another shape, or not finite.
        OptionError: a mode that does not exist.
    """
    signs, masked = read_mode(mode), read_on_unreachable(on_unreachable)
    points, single = read_points(xy, f"{linkage.name}: xy")
    theta = np.empty_like(points)
    ok = np.empty(len(points), dtype=np.bool_)

    def block(rows: slice) -> None:
        u, _, reach = crank_directions(linkage, points[rows], signs)
        theta[rows] = np.arctan2(u[:, 1], u[:, 0]).T
        ok[rows] = reach.all(axis=0)

    _in_blocks(len(points), block)
    if not masked and not ok.all():
        solve_pose(linkage, xy, mode)  # raises, with the place named
    return restore_shape(theta, ok, single=single, masked=masked)


def fk(
    linkage: FiveBar,
    theta: ArrayLike,
    assembly: int = 1,
    on_unreachable: OnUnreachable = "raise",
) -> Array:
    """Forward kinematics in one of the two assembly modes.

    Existence: the elbows are between |l2_1 - l2_2| and l2_1 + l2_2 apart, and not in one place.

    Args:
        linkage: the five-bar.
        theta: crank angles, (2,) or (N, 2), rad.
        assembly: the sign of w_1 x w_2; +1 hangs below the elbows when elbow 1 is the right one.
        on_unreachable: ``"raise"`` or ``"mask"``.

    Returns:
        Tool, (2,) or (N, 2), m.

    Raises:
        UnreachableError: the rods cannot meet, or the elbows coincide.
        StateError: theta of another shape, or not finite.
        OptionError: an assembly other than +1 and -1.
    """
    sign = float(read_assembly(assembly))
    masked = read_on_unreachable(on_unreachable)
    angles, single = read_points(theta, f"{linkage.name}: theta")
    xy = np.empty_like(angles)
    ok = np.empty(len(angles), dtype=np.bool_)

    def block(rows: slice) -> None:
        xy[rows], ok[rows] = _rod_intersection(linkage, angles[rows], sign)

    _in_blocks(len(angles), block)
    if not masked and not ok.all():
        raise _cannot_close(linkage, angles, ok)
    return restore_shape(xy, ok, single=single, masked=masked)


def elbows(linkage: FiveBar, theta: Array) -> Array:
    """The elbows B_i for crank angles (N, 2): (2 legs, 2, N), m."""
    l1 = linkage.l1[:, None]
    angles = theta.T
    return np.stack([linkage.base_x[:, None] + l1 * np.cos(angles), l1 * np.sin(angles)], axis=1)


def _rod_intersection(linkage: FiveBar, theta: Array, sign: float) -> tuple[Array, Mask]:
    """Where the rods meet: the apex of the triangle over the line from elbow 1 to elbow 2."""
    first, second = linkage.l2
    b1, b2 = elbows(linkage, theta)
    span = b2 - b1
    d = np.hypot(span[0], span[1])
    outer, inner = (first + second) - d, d - abs(first - second)
    slack = -8.0 * np.finfo(float).eps * (first + second + linkage.e)
    ok = (outer >= slack) & (inner >= slack) & (d > 0.0)
    d = np.where(ok, d, first + second)
    height = (first + second + d) * np.maximum(outer, 0.0) * np.maximum(inner, 0.0)
    height = sign * np.sqrt(height * (d + abs(first - second))) / (2.0 * d * d)
    along = 0.5 * (1.0 + (first - second) * (first + second) / (d * d))
    x = b1[0] + along * span[0] - height * span[1]
    y = b1[1] + along * span[1] + height * span[0]
    return np.stack([x, y], axis=1), ok


def _cannot_close(linkage: FiveBar, theta: Array, ok: Mask) -> UnreachableError:
    point = int(np.argmin(ok))
    first, second = linkage.l2
    b1, b2 = elbows(linkage, theta[point : point + 1])
    d = float(np.hypot(*(b2 - b1)[:, 0]))
    place = f"{linkage.name}: theta[{point}] = ({theta[point, 0]:.9g}, {theta[point, 1]:.9g}) rad"
    if d == 0.0:
        return UnreachableError(
            f"{place}: the elbows coincide, so the tool's place is undetermined"
        )
    return UnreachableError(
        f"{place}: the elbows are {d:.9g} m apart; the rods meet only between "
        f"{abs(first - second):.9g} and {first + second:.9g} m"
    )


def _in_blocks(count: int, block: Callable[[slice], None]) -> None:
    for start in range(0, count, _BLOCK):
        block(slice(start, start + _BLOCK))


def jacobian(
    linkage: FiveBar,
    xy: ArrayLike,
    mode: Mode = HANGING,
    on_unreachable: OnUnreachable = "raise",
) -> Array:
    """The matrix J of theta_dot = J v, row i = w_i^T / (l1_i u_i x w_i) (003.J).

    Note the direction: from tool velocity to crank rates, the inverse of a serial arm's J.

    Args:
        linkage: the five-bar.
        xy: tool, (2,) or (N, 2), m.
        mode: signs of u_i x w_i.
        on_unreachable: ``"raise"`` or ``"mask"``.

    Returns:
        (2, 2) or (N, 2, 2), rad/m.

    Raises:
        UnreachableError: a point out of reach.
        SingularError: type I, where crank and rod are in line and J is infinite.
    """
    pose = solve_pose(linkage, xy, mode, on_unreachable, regular="I")
    return pose.restore(rate_matrix(linkage, pose))


def rate_matrix(linkage: FiveBar, pose: Pose) -> Array:
    """J of theta_dot = J v for solved poses, (N, 2, 2)."""
    return pose.w / (linkage.l1 * pose.sine)[..., None]


def acceleration_bias(
    linkage: FiveBar,
    xy: ArrayLike,
    v: ArrayLike,
    mode: Mode = HANGING,
    on_unreachable: OnUnreachable = "raise",
) -> Array:
    """f(v) of theta_ddot = J a + f(v) (003.acc).

    f_i = [(v·w)² (u·w)/l1 + (v·u)²/l2] / (l1 (u x w)³)

    Args:
        linkage: the five-bar.
        xy: tool, (2,) or (N, 2), m.
        v: tool velocity, (2,) or (N, 2), m/s.
        mode: signs of u_i x w_i.
        on_unreachable: ``"raise"`` or ``"mask"``.

    Returns:
        (2,) or (N, 2), rad/s².

    Raises:
        UnreachableError: a point out of reach.
        SingularError: type I.
    """
    pose = solve_pose(linkage, xy, mode, on_unreachable, regular="I")
    velocity = read_vectors(v, len(pose.xy), f"{linkage.name}: v")
    return pose.restore(rate_bias(linkage, pose, velocity))


def rate_bias(linkage: FiveBar, pose: Pose, v: Array) -> Array:
    """f(v) for solved poses, (N, 2)."""
    l1, l2 = linkage.l1, linkage.l2
    vw = np.einsum("nij,nj->ni", pose.w, v)
    vu = np.einsum("nij,nj->ni", pose.u, v)
    uw = np.einsum("nij,nij->ni", pose.u, pose.w)
    bias: Array = (vw**2 * uw / l1 + vu**2 / l2) / (l1 * pose.sine**3)
    return bias


def joint_rates(linkage: FiveBar, xy: ArrayLike, v: ArrayLike, mode: Mode = HANGING) -> Array:
    """theta_dot = J v, (2,) or (N, 2), rad/s; arguments and errors as :func:`acceleration_bias`."""
    pose = solve_pose(linkage, xy, mode, regular="I")
    velocity = read_vectors(v, len(pose.xy), f"{linkage.name}: v")
    return pose.restore(np.einsum("nij,nj->ni", rate_matrix(linkage, pose), velocity))


def joint_accelerations(
    linkage: FiveBar, xy: ArrayLike, v: ArrayLike, a: ArrayLike, mode: Mode = HANGING
) -> Array:
    """theta_ddot = J a + f(v).

    Args:
        linkage: the five-bar.
        xy, v, a: tool position, velocity, acceleration, (2,) or (N, 2), SI.
        mode: signs of u_i x w_i.

    Returns:
        (2,) or (N, 2), rad/s².

    Raises:
        UnreachableError: a point out of reach.
        SingularError: type I.
    """
    pose = solve_pose(linkage, xy, mode, regular="I")
    velocity = read_vectors(v, len(pose.xy), f"{linkage.name}: v")
    acceleration = read_vectors(a, len(pose.xy), f"{linkage.name}: a")
    linear = np.einsum("nij,nj->ni", rate_matrix(linkage, pose), acceleration)
    return pose.restore(linear + rate_bias(linkage, pose, velocity))


def mode_of(linkage: FiveBar, theta: ArrayLike, xy: ArrayLike) -> tuple[int, int]:
    """The working mode (s_1, s_2) of one pose given by its crank angles and its tool.

    Args:
        linkage: the five-bar.
        theta: (2,), rad.
        xy: (2,), m; need not close the loop exactly.

    Raises:
        StateError: not one pose, or a leg so nearly in line that it has no mode.
    """
    angles, _ = read_points(theta, f"{linkage.name}: theta")
    points, _ = read_points(xy, f"{linkage.name}: xy")
    if len(angles) != 1 or len(points) != 1:
        raise StateError(f"{linkage.name}: mode_of takes one pose, theta (2,) and xy (2,)")
    crank = np.stack([np.cos(angles[0]), np.sin(angles[0])], axis=1)
    rod = points[0] - elbows(linkage, angles)[:, :, 0]
    signs = np.sign(cross(crank, rod))
    if not signs.all():
        raise StateError(f"{linkage.name}: a leg is in line there; it has no working mode")
    return int(signs[0]), int(signs[1])


def grid(linkage: FiveBar, resolution: int) -> tuple[Array, Array, Array]:
    """A grid over the box that holds the reachable workspace.

    Returns:
        x (X,), y (Y,), and all points (Y·X, 2), row by row.

    Raises:
        OptionError: fewer than 8 points a side.
    """
    if resolution < 8:
        raise OptionError(f"resolution is {resolution}; it must be at least 8")
    reach = linkage.l1 + linkage.l2
    right, left = linkage.base_x + reach, linkage.base_x - reach
    x_low, x_high = float(left.max()), float(right.min())
    y_high = float(reach.min())
    step = max(x_high - x_low, 2.0 * y_high) / (resolution - 1)
    x = np.linspace(x_low, x_high, max(2, round((x_high - x_low) / step) + 1))
    y = np.linspace(-y_high, y_high, max(2, round(2.0 * y_high / step) + 1))
    points = np.stack(np.meshgrid(x, y), axis=-1).reshape(-1, 2)
    return x, y, points
