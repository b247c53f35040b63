"""The drawings of the page on conventions, from kinlab's own transforms, as SVG in the page.

Colours come from the page's style, so that the drawings are as dark or as light as it is. Lengths
and angles of a drawn link are numbers of a DH table; where its frames are, the table says.
"""

from __future__ import annotations

import re
from html import escape
from itertools import pairwise
from pathlib import Path

import numpy as np
from made_pages import write_if_changed

import kinlab as kl

Vector = np.ndarray


def write(docs: Path) -> None:
    """Writes each drawing as a piece of HTML."""
    folder = docs / "conventions" / "generated"
    for name, make in DRAWINGS.items():
        write_if_changed(folder / f"{name}.html", make())


class Canvas:
    """An orthographic view of points in space, as SVG.

    Args:
        azimuth, elevation: where the viewer stands, rad.
        scale: pixels a metre.
    """

    def __init__(self, azimuth: float, elevation: float, scale: float = 260.0) -> None:
        ca, sa, ce, se = np.cos(azimuth), np.sin(azimuth), np.cos(elevation), np.sin(elevation)
        self._view = scale * np.array([[-sa, ca, 0.0], [se * ca, se * sa, -ce]])
        self._parts: list[str] = []
        self._seen: list[Vector] = []

    def at(self, point: Vector) -> Vector:
        """Where a point is seen, px."""
        seen = self._view @ np.asarray(point, float)
        self._seen.append(seen)
        return seen

    def line(self, start: Vector, end: Vector, style: str) -> None:
        (x, y), (u, v) = self.at(start), self.at(end)
        self._parts.append(f'<path class="{style}" d="M{x:.1f} {y:.1f}L{u:.1f} {v:.1f}"/>')

    def arrow(self, start: Vector, end: Vector, style: str) -> None:
        """A line with a head."""
        self.line(start, end, style)
        p, q = self.at(start), self.at(end)
        if np.linalg.norm(q - p) < 6.0:  # it points at the viewer
            self._parts.append(
                f'<circle class="{style} head" cx="{q[0]:.1f}" cy="{q[1]:.1f}" r="4"/>'
            )
            return
        self._head(q, q - p, style)

    def _head(self, tip: Vector, along: Vector, style: str) -> None:
        along = along / np.linalg.norm(along)
        side = np.array([-along[1], along[0]])
        a, b = tip - 10 * along + 4 * side, tip - 10 * along - 4 * side
        self._parts.append(
            f'<path class="{style} head" d="M{tip[0]:.1f} {tip[1]:.1f}L{a[0]:.1f} {a[1]:.1f}'
            f'L{b[0]:.1f} {b[1]:.1f}Z"/>'
        )

    def arc(self, centre: Vector, start: Vector, axis: Vector, angle: float, radius: float,
            style: str) -> Vector:  # fmt: skip
        """An arc with a head about an axis, from a direction at right angles to it.

        Returns:
            The point in the middle, a little further out.
        """
        axis, start = axis / np.linalg.norm(axis), start / np.linalg.norm(start)
        across = np.cross(axis, start)

        def on(turn: float, r: float = radius) -> Vector:
            return centre + r * (np.cos(turn) * start + np.sin(turn) * across)

        points = [self.at(on(t)) for t in np.linspace(0.0, angle, 40)]
        path = "L".join(f"{x:.1f} {y:.1f}" for x, y in points[:-2])
        self._parts.append(f'<path class="{style}" d="M{path}"/>')
        self._head(points[-1], points[-1] - points[-5], style)
        return on(0.5 * angle, 1.28 * radius)

    def frame(
        self, T: Vector, name: str, size: float, labels: str, **moved: tuple[float, float]
    ) -> None:
        """The axes of a frame; x red, y green, z blue, as the viewer draws them.

        Args:
            T: the frame.
            name: what stands behind the letter of a labelled axis.
            size: length of the axes, m.
            labels: which axes have one.
            moved: by axis, how far its label stands from its place, px.
        """
        for axis, along in zip("xyz", T[:3, :3].T, strict=True):
            self.arrow(T[:3, 3], T[:3, 3] + size * along, f"axis-{axis}")
            if axis in labels:
                words = f"{axis}{name}"
                place = T[:3, 3] + 1.2 * size * along
                self.text(place, words, f"axis-{axis}", moved.get(axis, (0.0, 0.0)))
        self.dot(T[:3, 3])

    def dot(self, point: Vector, style: str = "dot", r: float = 3.0) -> None:
        x, y = self.at(point)
        self._parts.append(f'<circle class="{style}" cx="{x:.1f}" cy="{y:.1f}" r="{r}"/>')

    def text(self, point: Vector, words: str, style: str = "",
             move: tuple[float, float] = (0.0, 0.0)) -> None:  # fmt: skip
        """Words about a point; ``z_{i-1}`` has an index."""
        x, y = self.at(point) + move
        self._seen.append(np.array([x + 16, y + 8]))
        self._seen.append(np.array([x - 16, y - 12]))
        drawn = re.sub(
            r"_\{(.*?)\}",
            r'<tspan dy="4" class="index">\1</tspan><tspan dy="-4">&#8203;</tspan>',
            escape(words),
        ).replace("-1<", "−1<")
        self._parts.append(f'<text class="{style}" x="{x:.1f}" y="{y + 4:.1f}">{drawn}</text>')

    def svg(self, label: str) -> str:
        """The drawing, as large as what is in it."""
        seen = np.array(self._seen)
        low, high = seen.min(axis=0) - 12, seen.max(axis=0) + 12
        wide, tall = high - low
        return (
            f'<svg class="drawing" role="img" aria-label="{escape(label)}" width="{wide:.0f}" '
            f'viewBox="{low[0]:.0f} {low[1]:.0f} {wide:.0f} {tall:.0f}">'
            + "".join(self._parts) + "</svg>\n"
        )  # fmt: skip


A, ALPHA, D, THETA = 0.8, 0.7, 0.5, 0.9
"""The drawn link: metres and radians."""


def _link(convention: str) -> Vector:
    """The link transform of the drawn link, by kinlab."""
    link = kl.DHLink(a=A, alpha=ALPHA, d=D, theta=THETA)
    return kl.DHTable("drawn", convention, [link]).fk([0.0])[-1]


def standard() -> str:
    """A row of a standard table: d and theta about the old z, then a and alpha about the new x."""
    view = Canvas(THETA - 2.2, 0.45)
    here, there = np.eye(4), _link("standard")
    x0, z0 = here[:3, 0], here[:3, 2]
    at, x1, z1 = there[:3, 3], there[:3, 0], there[:3, 2]
    foot = D * z0
    view.line(-0.2 * z0, 0.95 * z0, "joint")
    view.line(at - 0.35 * z1, at + 0.75 * z1, "joint")
    view.text(0.95 * z0, "axis of joint i", "soft", (0.0, -10.0))
    view.text(at + 0.75 * z1, "axis of joint i+1", "soft", (10.0, -10.0))
    view.line(foot, foot + 0.4 * x0, "thin")
    view.line(at, at + 0.55 * z0, "thin")
    view.frame(here, "_{i-1}", 0.28, "xz", x=(0.0, 16.0), z=(22.0, 8.0))
    view.frame(there, "_{i}", 0.28, "xz", z=(12.0, 4.0))
    view.line(0 * z0, foot, "of-z wide")
    view.text(0.75 * foot, "d_{i}", "of-z", (-16.0, 0.0))
    view.text(view.arc(foot, x0, z0, THETA, 0.28, "of-z"), "θ_{i}", "of-z", (8.0, 2.0))
    view.line(foot, at, "of-x wide")
    view.text(0.6 * at + 0.4 * foot, "a_{i}", "of-x", (0.0, -14.0))
    view.text(view.arc(at, z0, x1, ALPHA, 0.48, "of-x"), "α_{i}", "of-x", (0.0, -2.0))
    return view.svg("Standard DH: frame i is at the far end of link i, on the axis of joint i+1")


def modified() -> str:
    """A row of a modified table: a and alpha about the old x, then d and theta about the new z."""
    view = Canvas(-2.2, 0.45)
    here, there = np.eye(4), _link("modified")
    x0, z0 = here[:3, 0], here[:3, 2]
    at, z1 = there[:3, 3], there[:3, 2]
    foot = A * x0
    view.line(-0.2 * z0, 0.7 * z0, "joint")
    view.line(foot - 0.2 * z1, foot + 1.15 * z1, "joint")
    view.text(0.7 * z0, "axis of joint i−1", "soft", (0.0, -10.0))
    view.text(foot + 1.15 * z1, "axis of joint i", "soft", (6.0, -10.0))
    view.line(foot, foot + 0.5 * z0, "thin")
    view.line(at, at + 0.4 * x0, "thin")
    view.frame(here, "_{i-1}", 0.28, "xz", x=(0.0, 16.0), z=(22.0, 8.0))
    view.frame(there, "_{i}", 0.28, "xz", z=(12.0, 4.0))
    view.line(0 * x0, foot, "of-x wide")
    view.text(0.68 * foot, "a_{i-1}", "of-x", (0.0, -14.0))
    view.text(view.arc(foot, z0, x0, ALPHA, 0.42, "of-x"), "α_{i-1}", "of-x", (0.0, -4.0))
    view.line(foot, at, "of-z wide")
    view.text(0.5 * (foot + at), "d_{i}", "of-z", (18.0, 6.0))
    view.text(view.arc(at, x0, z1, THETA, 0.28, "of-z"), "θ_{i}", "of-z", (10.0, 4.0))
    return view.svg("Modified DH: frame i is on the axis of joint i")


Q = np.array([0.9, -0.7])
"""The planar arm of the three Jacobians."""


def frames() -> str:
    """The three frames of a Jacobian: whose axes, and the velocity of which point."""
    arm = kl.DHTable("planar", "standard", [kl.DHLink(a=0.5), kl.DHLink(a=0.45)])
    places = arm.fk(Q)
    drawn = []
    for name, axes, point in (
        ("base", np.eye(3), places[-1][:3, 3]),
        ("tool", places[-1][:3, :3], places[-1][:3, 3]),
        ("spatial", np.eye(3), np.zeros(3)),
    ):
        view = Canvas(-np.pi / 2, np.pi / 2, 190.0)
        for start, end in pairwise(places):
            view.line(start[:3, 3], end[:3, 3], "bar")
        for place in places[:-1]:
            view.dot(place[:3, 3], "pin", 5.0)
        if name == "spatial":  # the point of the moving body that is at the base's origin now
            view.line(places[-1][:3, 3], point, "thin")
        T = np.eye(4)
        T[:3, :3], T[:3, 3] = axes, point
        view.frame(T, "", 0.24, "xy")
        view.dot(point, "reference", 5.5)
        corners = ((-0.14, -0.16, 0.0), (0.95, 1.0, 0.0))
        for corner in corners:
            view.at(np.array(corner))
        what = {
            "base": "axes of the base, point at the tool",
            "tool": "axes of the tool, point at the tool",
            "spatial": "axes of the base, point at its origin",
        }[name]
        drawn.append(
            f'<figure>{view.svg(what)}<figcaption><code>frame="{name}"</code><br>{what}'
            "</figcaption></figure>"
        )
    return f'<div class="drawings">{"".join(drawn)}</div>\n'


def body() -> str:
    """Where a link's centre of mass and inertia are given: in DH frame i, in both conventions."""
    drawn = []
    for convention, said in (
        ("standard", "standard: frame i at the far end, so com has a negative x"),
        ("modified", "modified: frame i at the joint, so com has a positive x"),
    ):
        view = Canvas(-np.pi / 2 + 0.35, 0.9, 190.0)
        near, far = np.eye(4), np.eye(4)
        far[0, 3] = 0.9
        view.line(near[:3, 3], far[:3, 3], "bar")
        for end in (near, far):
            view.line(end[:3, 3] - [0, 0, 0.16], end[:3, 3] + [0, 0, 0.2], "joint")
        at = far if convention == "standard" else near
        view.frame(at, "_{i}", 0.22, "xyz", x=(4.0, 14.0))
        view.dot(np.array([0.45, 0, 0]), "reference", 6.0)
        view.text(np.array([0.45, 0, 0]), "com", "", (0.0, 20.0))
        drawn.append(f"<figure>{view.svg(said)}<figcaption>{said}</figcaption></figure>")
    return f'<div class="drawings">{"".join(drawn)}</div>\n'


DRAWINGS = {"standard": standard, "modified": modified, "frames": frames, "body": body}
