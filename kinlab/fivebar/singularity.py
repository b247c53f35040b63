"""Where a five-bar is singular, and how far a pose is from the three kinds of singularity.

Type I, crank and rod of a leg in line: the tool loses a direction. It lies on four circles, the
edges of the two legs' reach. Type II, the rods in line: the tool moves while the cranks stand.
It lies on the path of a point of a four-bar's coupler: with w_2 = sigma w_1 the elbows are
L = l2_1 - sigma l2_2 apart along w_1, so crank 1, a coupler of length |L|, and crank 2 form a
four-bar, and the tool is a point on the coupler's line. That path is a sextic. Type III is both.

Sources: Gosselin & Angeles 1990, doi 10.1109/70.56660; the curve is derived here from note 003's
loop, and is the classical coupler curve (Hunt, *Kinematic Geometry of Mechanisms*, chapter 7).
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING, Literal

import numpy as np
from numpy.typing import ArrayLike

from kinlab.arrays import Array
from kinlab.errors import MissingExtraError, OptionError
from kinlab.fivebar.arguments import HANGING, Mask, Mode, cross, read_mode, read_points
from kinlab.fivebar.geometry import elbows, grid, solve_pose

if TYPE_CHECKING:
    from kinlab.fivebar.linkage import FiveBar

Kind = Literal["folded", "stretched"]
SIGMA: dict[str, float] = {"folded": 1.0, "stretched": -1.0}
"""w_1 · w_2 of the two ways in which the rods can be in line."""


@dataclass(frozen=True)
class Circle:
    """A circle of the plane: centre (2,) and radius, m; radius 0 is a point."""

    centre: tuple[float, float]
    radius: float


@dataclass(frozen=True)
class ForwardLocus:
    """One closed curve of type II.

    Attributes:
        kind: ``"folded"`` or ``"stretched"``.
        points: (K, 2), m; the last point joins the first.
        modes: signs of u_i x w_i at each point, (K, 2); 0 where it is of type III.
    """

    kind: str
    points: Array
    modes: Array


def type_one(linkage: FiveBar) -> tuple[tuple[Circle, Circle], tuple[Circle, Circle]]:
    """The circles of type I: for each leg the inner and the outer edge of its reach."""
    legs = []
    for leg in range(2):
        centre = (float(linkage.base_x[leg]), 0.0)
        l1, l2 = float(linkage.l1[leg]), float(linkage.l2[leg])
        legs.append((Circle(centre, abs(l1 - l2)), Circle(centre, l1 + l2)))
    return legs[0], legs[1]


def type_two(linkage: FiveBar, samples: int = 2048) -> list[ForwardLocus]:
    """The curves of type II by formula.

    Args:
        linkage: the five-bar.
        samples: points along each half of a closed curve; they crowd where the curve turns back.

    Returns:
        Closed curves; none where no pose has its rods in line in that way.

    Raises:
        OptionError: fewer than 8 samples.
    """
    if samples < 8:
        raise OptionError(f"samples is {samples}; it must be at least 8")
    out = []
    for kind in SIGMA:
        gap = _coupler(linkage, kind)
        if abs(gap) <= 1e-12 * float(np.sum(linkage.l2)):
            out += _coincident_elbows(linkage, samples)
        else:
            for start, stop in _crank_ranges(linkage, abs(gap)):
                out += _coupler_curve(linkage, kind, start, stop, samples)
    return out


def _coupler(linkage: FiveBar, kind: str) -> float:
    first, second = linkage.l2
    return float(first - SIGMA[kind] * second)


def _crank_ranges(linkage: FiveBar, gap: float) -> list[tuple[float, float]]:
    """Angles of crank 1 for which a coupler of length ``gap`` reaches crank 2's circle.

    |A_2 - B_1|² = 4e² + l² + 4 e l cos theta must lie between (l1_2 - gap)² and (l1_2 + gap)².
    """
    (length, other), shift = linkage.l1, 2.0 * linkage.e
    near, far = (other - gap) ** 2, (other + gap) ** 2
    if shift == 0.0:
        return [(-np.pi, np.pi)] if near <= length**2 <= far else []
    low = (near - shift**2 - length**2) / (2.0 * shift * length)
    high = (far - shift**2 - length**2) / (2.0 * shift * length)
    if low > 1.0 or high < -1.0:
        return []
    inner = np.arccos(min(high, 1.0)) if high < 1.0 else 0.0
    outer = np.arccos(max(low, -1.0)) if low > -1.0 else np.pi
    if high >= 1.0:
        return [(-outer, outer)]
    if low <= -1.0:
        return [(inner, 2.0 * np.pi - inner)]
    return [(inner, outer), (-outer, -inner)]


def _coupler_curve(
    linkage: FiveBar, kind: str, start: float, stop: float, samples: int
) -> list[ForwardLocus]:
    whole = np.isclose(stop - start, 2.0 * np.pi, rtol=0, atol=1e-12)
    ramp = np.linspace(0.0, 1.0, samples)
    ramp = ramp if whole else 0.5 * (1.0 - np.cos(np.pi * ramp))
    theta = start + (stop - start) * ramp
    up, down = (_coupler_points(linkage, kind, theta, side) for side in (1.0, -1.0))
    if whole:
        return [ForwardLocus(kind, *up), ForwardLocus(kind, *down)]
    points = np.concatenate([up[0], down[0][::-1]])
    return [ForwardLocus(kind, points, np.concatenate([up[1], down[1][::-1]]))]


def _coupler_points(linkage: FiveBar, kind: str, theta: Array, side: float) -> tuple[Array, Array]:
    """Tool and modes where crank 1 is at theta: |L w_1 - (A_2 - B_1)| = l1_2 gives w_1."""
    gap = _coupler(linkage, kind)
    b1 = elbows(linkage, np.stack([theta, theta], axis=1))[0].T
    to_base = np.array([linkage.base_x[1], 0.0]) - b1
    d = np.hypot(to_base[:, 0], to_base[:, 1])
    cosine = (gap**2 + d**2 - linkage.l1[1] ** 2) / (2.0 * gap * d)
    phi = np.arctan2(to_base[:, 1], to_base[:, 0])
    phi = phi + side * np.arccos(np.clip(cosine, -1.0, 1.0))  # ends of a range, to rounding
    w1 = np.stack([np.cos(phi), np.sin(phi)], axis=1)
    u1 = np.stack([np.cos(theta), np.sin(theta)], axis=1)
    u2 = (gap * w1 - to_base) / linkage.l1[1]
    signs = np.stack([cross(u1, w1), SIGMA[kind] * cross(u2, w1)], axis=1)
    return b1 + linkage.l2[0] * w1, np.sign(signs)


def _coincident_elbows(linkage: FiveBar, samples: int) -> list[ForwardLocus]:
    """Equal rods folded: both elbows in one place, about which the tool turns freely."""
    (first, second), shift = linkage.l1, 2.0 * linkage.e
    if shift == 0.0:
        return []  # equal cranks then coincide everywhere, in modes (+, +) and (-, -)
    along = (first**2 - second**2 + shift**2) / (2.0 * shift)
    height = first**2 - along**2
    if height < 0.0:
        return []
    phi = np.linspace(-np.pi, np.pi, 2 * samples, endpoint=False)
    w = np.stack([np.cos(phi), np.sin(phi)], axis=1)
    out = []
    for sign in (1.0, -1.0):
        elbow = np.array([linkage.e - along, sign * np.sqrt(height)])
        arms = elbow - np.stack([linkage.base_x, np.zeros(2)], axis=1)
        modes = np.stack([np.sign(cross(arm, w)) for arm in arms], axis=1)
        out.append(ForwardLocus("folded", elbow + linkage.l2[0] * w, modes))
    return out


def type_two_polynomial(linkage: FiveBar, xy: ArrayLike, kind: Kind) -> Array:
    """The sextic that vanishes on the curve of type II of that kind, () or (N,), m⁴.

    p = P - A_1, q = P - A_2; w·p = k_1 and w·q = sigma k_2 with
    k_i = (|P - A_i|² + l2_i² - l1_i²) / (2 l2_i), and |w| = 1 leaves
    k_1² |q|² - 2 sigma k_1 k_2 p·q + k_2² |p|² = (p x q)².
    It holds for all four working modes at once.

    Raises:
        OptionError: a kind other than ``"folded"`` and ``"stretched"``.
    """
    if kind not in SIGMA:
        raise OptionError(f'kind {kind!r} does not exist; choose "folded" or "stretched"')
    points, single = read_points(xy, f"{linkage.name}: xy")
    l1, l2 = linkage.l1, linkage.l2
    p = points - np.array([linkage.base_x[0], 0.0])
    q = points - np.array([linkage.base_x[1], 0.0])
    pp, qq = np.einsum("nj,nj->n", p, p), np.einsum("nj,nj->n", q, q)
    k1 = (pp + l2[0] ** 2 - l1[0] ** 2) / (2.0 * l2[0])
    k2 = (qq + l2[1] ** 2 - l1[1] ** 2) / (2.0 * l2[1])
    mixed = 2.0 * SIGMA[kind] * k1 * k2 * np.einsum("nj,nj->n", p, q)
    value: Array = k1**2 * qq - mixed + k2**2 * pp - cross(p, q) ** 2
    return value[0] if single else value


def type_two_contour(linkage: FiveBar, mode: Mode = HANGING, resolution: int = 400) -> list[Array]:
    """The curve of type II of one working mode as the zero contour of w_1 x w_2 on a grid.

    Args:
        linkage: the five-bar.
        mode: signs of u_i x w_i.
        resolution: points along the longer side of the grid.

    Returns:
        Open or closed polylines, each (K, 2), m.

    Raises:
        MissingExtraError: contourpy is not installed (``pip install "kinlab[plots]"``).
    """
    try:
        import contourpy
    except ImportError:
        raise MissingExtraError('contours need contourpy: pip install "kinlab[plots]"') from None
    read_mode(mode)
    x, y, points = grid(linkage, resolution)
    pose = solve_pose(linkage, points, mode, "mask")
    values = np.ma.array(pose.rods, mask=~pose.ok).reshape(len(y), len(x))
    return [np.asarray(line) for line in contourpy.contour_generator(x, y, values).lines(0.0)]


def type_two_of_mode(linkage: FiveBar, mode: Mode) -> Array:
    """Points of the type II curve of one working mode, (K, 2), m; denser than :func:`type_two`.

    Raises:
        OptionError: a mode that does not exist.
    """
    signs, curves = read_mode(mode), [np.empty((0, 2))]
    for locus in type_two(linkage):
        ours = np.all(locus.modes * signs >= 0.0, axis=1)
        curves.append(_filled(locus.points, ours))
    return np.concatenate(curves)


def _filled(points: Array, keep: Mask) -> Array:
    """The kept points of a closed curve, with each gap between neighbours filled to 1/8."""
    after, keep_after = np.roll(points, -1, axis=0), np.roll(keep, -1)
    both = keep & keep_after
    steps = np.arange(1, 8)[:, None, None] / 8.0
    between = points[both] + steps * (after - points)[both]
    return np.concatenate([points[keep], between.reshape(-1, 2)])


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


def distances(linkage: FiveBar, xy: ArrayLike, mode: Mode = HANGING) -> Distances:
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
    l1, l2 = linkage.l1, linkage.l2
    curve = type_two_of_mode(linkage, mode)
    along = np.full(len(d), np.inf)
    if len(curve):
        along = cKDTree(curve).query(pose.xy)[0]
    return Distances(
        pose.restore(l1 + l2 - d),
        pose.restore(d - np.abs(l1 - l2)),
        pose.restore(pose.sine),
        pose.restore(pose.rods),
        pose.restore(np.where(pose.rods < 0.0, -along, along)),
    )


def classify(
    linkage: FiveBar, xy: ArrayLike, mode: Mode = HANGING, sine: float = 1e-6
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
