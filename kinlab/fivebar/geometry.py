"""Kinematics of a five-bar in closed form: positions, rates, accelerations.

Every function takes points (2,) or (N, 2) and answers with the matching leading axis. A point
that cannot be reached, or where the quantity does not exist, raises; with
``on_unreachable="mask"`` the answer is a numpy masked array with those rows masked.

Sources: note 003 (003.loop, 003.w, 003.J, 003.acc); Huang et al. 2005, doi 10.1115/1.1898343.
"""

from __future__ import annotations

from collections.abc import Callable

import numpy as np
from numpy.typing import ArrayLike

from kinlab.arrays import Array
from kinlab.errors import OptionError, StateError, UnreachableError
from kinlab.fivebar.linkage import Linkage
from kinlab.fivebar.pose import (
    HANGING,
    Mask,
    Mode,
    OnUnreachable,
    Pose,
    crank_directions,
    cross,
    deliver,
    read_choice,
    read_mode,
    read_points,
    read_vectors,
    solve_pose,
)

_BLOCK = 8192
"""Points per pass of a long batch: the working arrays of one pass stay in the cache."""


def ik(
    linkage: Linkage,
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
    signs, masked = read_mode(mode), read_choice(on_unreachable)
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
    return deliver(theta, ok, single=single, masked=masked)


def fk(
    linkage: Linkage,
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
    if assembly not in (1, -1):
        raise OptionError(f"assembly {assembly!r} does not exist; choose +1 or -1")
    masked = read_choice(on_unreachable)
    angles, single = read_points(theta, f"{linkage.name}: theta")
    xy = np.empty_like(angles)
    ok = np.empty(len(angles), dtype=np.bool_)

    def block(rows: slice) -> None:
        xy[rows], ok[rows] = _meet(linkage, angles[rows], float(assembly))

    _in_blocks(len(angles), block)
    if not masked and not ok.all():
        raise _cannot_close(linkage, angles, ok)
    return deliver(xy, ok, single=single, masked=masked)


def elbows(linkage: Linkage, theta: Array) -> Array:
    """The elbows B_i for crank angles (N, 2): (2 legs, 2, N), m."""
    l1 = np.asarray(linkage.l1)[:, None]
    angles = theta.T
    return np.stack(
        [linkage.base_x[:, None] + l1 * np.cos(angles), l1 * np.sin(angles)], axis=1
    )  # fmt: skip


def _meet(linkage: Linkage, theta: Array, sign: float) -> tuple[Array, Mask]:
    """Where the rods meet: the apex of the triangle over the line from elbow 1 to elbow 2."""
    first, second = np.asarray(linkage.l2)
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


def _cannot_close(linkage: Linkage, theta: Array, ok: Mask) -> UnreachableError:
    point = int(np.argmin(ok))
    first, second = np.asarray(linkage.l2)
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
    linkage: Linkage,
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
    return pose.give(rate_matrix(linkage, pose))


def rate_matrix(linkage: Linkage, pose: Pose) -> Array:
    """J of theta_dot = J v for solved poses, (N, 2, 2)."""
    return pose.w / (np.asarray(linkage.l1) * pose.sine)[..., None]


def acceleration_bias(
    linkage: Linkage,
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
    velocity = read_vectors(v, pose, f"{linkage.name}: v")
    return pose.give(rate_bias(linkage, pose, velocity))


def rate_bias(linkage: Linkage, pose: Pose, v: Array) -> Array:
    """f(v) for solved poses, (N, 2)."""
    l1, l2 = np.asarray(linkage.l1), np.asarray(linkage.l2)
    vw = np.einsum("nij,nj->ni", pose.w, v)
    vu = np.einsum("nij,nj->ni", pose.u, v)
    uw = np.einsum("nij,nij->ni", pose.u, pose.w)
    bias: Array = (vw**2 * uw / l1 + vu**2 / l2) / (l1 * pose.sine**3)
    return bias


def joint_rates(
    linkage: Linkage, xy: ArrayLike, v: ArrayLike, mode: Mode = HANGING
) -> Array:  # fmt: skip
    """theta_dot = J v, (2,) or (N, 2), rad/s; arguments and errors as :func:`acceleration_bias`."""
    pose = solve_pose(linkage, xy, mode, regular="I")
    velocity = read_vectors(v, pose, f"{linkage.name}: v")
    return pose.give(np.einsum("nij,nj->ni", rate_matrix(linkage, pose), velocity))


def joint_accelerations(
    linkage: Linkage, xy: ArrayLike, v: ArrayLike, a: ArrayLike, mode: Mode = HANGING
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
    velocity = read_vectors(v, pose, f"{linkage.name}: v")
    acceleration = read_vectors(a, pose, f"{linkage.name}: a")
    linear = np.einsum("nij,nj->ni", rate_matrix(linkage, pose), acceleration)
    return pose.give(linear + rate_bias(linkage, pose, velocity))


def mode_of(linkage: Linkage, theta: ArrayLike, xy: ArrayLike) -> tuple[int, int]:
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
