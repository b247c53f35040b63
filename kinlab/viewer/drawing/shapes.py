"""What pages are drawn with: shapes, labels, camera and framing, background and floor."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from typing import Any

import meshcat.geometry as g
import numpy as np

from kinlab.arrays import Array
from kinlab.host.language import N_, _, language

# -------- Texts that the page hangs beside points of the scene


@dataclass(frozen=True)
class Label:
    """One text.

    Attributes:
        path: the node it moves with.
        at: where in that node's frame, metres, (3,).
        html: what it says; callers escape what a user wrote.
        group: groups of which any one shows it, separated by blanks.
    """

    path: str
    at: Sequence[float] | Array
    html: str
    group: str

    def as_json(self) -> dict[str, Any]:
        """Plain values for the page."""
        return {
            "path": self.path,
            "at": [float(x) for x in self.at],
            "html": self.html,
            "group": self.group,
        }


def short_number(value: float, places: int) -> str:
    """A number for a label: four digits, no more places than given, no sign before zero."""
    return f"{round(float(f'{value:.4g}'), places) + 0.0:g}"


# -------- Where to look from, and how large to draw, so that the mechanism fills the
#          picture

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


# -------- The few shapes that the pictures are made of, as meshcat objects; metres, colours
#          0xRRGGBB

RED, GREEN, BLUE = 0xC62828, 0x2E7D32, 0x1565C0
"""Axes x, y and z; in the DH picture red is what lies along x (a, alpha), blue along z."""


ELLIPSOIDS = {"velocity": 0x00897B, "force": 0xEF6C00}
"""The kinds of ellipsoid and their colours."""

ELLIPSOID_NAMES = {"velocity": N_("velocity ellipsoid"), "force": N_("force ellipsoid")}

ELLIPSOID_SIZE = 0.2
"""Longest semi-axis of an ellipsoid over the size of the mechanism."""

_SCALE = np.array(
    [
        (0.267, 0.005, 0.329),
        (0.231, 0.322, 0.546),
        (0.128, 0.567, 0.551),
        (0.369, 0.789, 0.383),
        (0.993, 0.906, 0.144),
    ]
)
"""Five knots of the colour map viridis, which stays readable in grey and to the colour-blind."""


class Torus(g.Geometry):  # type: ignore[misc]
    """A piece of a ring about z that starts at x and goes on for ``arc`` radians (0 to 2 pi)."""

    def __init__(self, radius: float, tube: float, arc: float) -> None:
        super().__init__()
        self.radius, self.tube, self.arc = radius, tube, arc

    def lower(self, object_data: Any) -> dict[str, Any]:
        """meshcat's wire format."""
        return {
            "uuid": self.uuid,
            "type": "TorusGeometry",
            "radius": self.radius,
            "tube": self.tube,
            "radialSegments": 8,
            "tubularSegments": 40,
            "arc": self.arc,
        }


def rgb(color: int) -> tuple[float, float, float]:
    """0xRRGGBB as three numbers from 0 to 1."""
    return ((color >> 16) / 255.0, (color >> 8 & 255) / 255.0, (color & 255) / 255.0)


def hexadecimal(color: Sequence[float]) -> int:
    """Three numbers from 0 to 1 as 0xRRGGBB."""
    red, green, blue = (round(255 * part) for part in color)
    return red << 16 | green << 8 | blue


def paint(color: int, opacity: float = 1.0) -> Any:
    """A shaded material."""
    return g.MeshPhongMaterial(color=color, opacity=opacity, shininess=40)


def flat(color: int, opacity: float = 1.0) -> Any:
    """A material that looks the same from everywhere, for lines."""
    return g.MeshBasicMaterial(color=color, opacity=opacity)


def rod(node: Any, start: Array, end: Array, radius: float, material: Any) -> None:
    """Puts a cylinder from start to end, (3,) each in the parent's frame, at ``node``.

    Nothing is drawn where they coincide.
    """
    along = np.asarray(end, dtype=float) - start
    length = float(np.linalg.norm(along))
    if length < 1e-9:
        return
    node.set_object(g.Cylinder(length, radius), material)
    pose = np.eye(4)
    pose[:3, :3] = turn_to(along / length, 1)
    pose[:3, 3] = np.asarray(start) + 0.5 * along
    node.set_transform(pose)


def arrow(node: Any, start: Array, end: Array, radius: float, material: Any) -> None:
    """A rod with a point at its end, (3,) each in the parent's frame."""
    along = np.asarray(end, dtype=float) - start
    length = float(np.linalg.norm(along))
    direction = along / length
    tip = min(0.3 * length, 8.0 * radius)
    neck = np.asarray(start) + direction * (length - tip)
    rod(node["shaft"], start, neck, radius, material)
    cone = g.Cylinder(tip, radiusTop=0.0, radiusBottom=2.6 * radius)
    node["tip"].set_object(cone, material)
    pose = np.eye(4)
    pose[:3, :3] = turn_to(direction, 1)
    pose[:3, 3] = neck + 0.5 * tip * direction
    node["tip"].set_transform(pose)


def pin(node: Any, centre: Array, radius: float, height: float, material: Any) -> None:
    """A short cylinder along z about ``centre``, (3,)."""
    half = np.array([0.0, 0.0, 0.5 * height])
    rod(node, centre - half, centre + half, radius, material)


def slab(node: Any, length: float, width: float, height: float, material: Any) -> None:
    """A flat bar along x from the node's origin, with round ends."""
    node["bar"].set_object(g.Box([length, width, height]), material)
    middle = np.eye(4)
    middle[0, 3] = 0.5 * length
    node["bar"].set_transform(middle)
    pin(node["near"], np.zeros(3), 0.5 * width, height, material)
    pin(node["far"], np.array([length, 0.0, 0.0]), 0.5 * width, height, material)


def ball(node: Any, radius: float, material: Any) -> None:
    """A ball about the node's origin."""
    node.set_object(g.Sphere(radius), material)


def triad(node: Any, size: float) -> None:
    """Three arrows, x red, y green, z blue, in the node's own frame."""
    for name, axis, color in zip("xyz", np.eye(3), (RED, GREEN, BLUE), strict=True):
        arrow(node[name], np.zeros(3), size * axis, 0.03 * size, flat(color))


def tube(node: Any, points: Array, radius: float, color: int) -> None:
    """A six-sided tube through points (N, 3); a line would be one pixel thin everywhere."""
    start, along = points[:-1], np.diff(points, axis=0)
    long = np.linalg.norm(along, axis=1) > 1e-12
    start, along = start[long], along[long]
    along_unit = along / np.linalg.norm(along, axis=1, keepdims=True)
    side = np.cross(along_unit, np.eye(3)[np.argmin(np.abs(along_unit), axis=1)])
    side *= radius / np.linalg.norm(side, axis=1, keepdims=True)
    up = np.cross(along_unit, side)
    turn = np.arange(6) * np.pi / 3
    ring = np.cos(turn)[:, None] * side[:, None] + np.sin(turn)[:, None] * up[:, None]
    near, far = start[:, None] + ring, (start + along)[:, None] + ring
    corners = np.concatenate([near, far], axis=1).reshape(-1, 3)
    i, j = np.arange(6), np.roll(np.arange(6), -1)
    one = np.concatenate([np.stack([i, j, i + 6], 1), np.stack([j, j + 6, i + 6], 1)])
    faces = (one + 12 * np.arange(len(start))[:, None, None]).reshape(-1, 3)
    node.set_object(g.TriangularMeshGeometry(corners, faces), flat(color))


def cloud(node: Any, points: Array, colors: Array, size: float) -> None:
    """Points (N, 3) with colours (N, 3) from 0 to 1, drawn ``size`` metres large."""
    at, paint_of = np.asarray(points, np.float32).T, np.asarray(colors, np.float32).T
    node.set_object(g.PointCloud(at, paint_of, size=size))


def scale_colors(values: Array, low: float, high: float) -> Array:
    """Colours (N, 3) for values (N,): from dark blue at ``low`` to yellow at ``high``."""
    where = np.clip((values - low) / ((high - low) or 1.0), 0.0, 1.0) * (len(_SCALE) - 1)
    ticks = np.arange(len(_SCALE))
    return np.column_stack([np.interp(where, ticks, _SCALE[:, k]) for k in range(3)])


def floor(node: Any, size: float, step: float) -> None:
    """A square grid of half-width ``size`` in the plane z = 0."""
    count = max(1, round(size / step))
    marks = step * np.arange(-count, count + 1)
    end = step * count
    lines = [((-end, m, 0.0), (end, m, 0.0)) for m in marks]
    lines += [((m, -end, 0.0), (m, end, 0.0)) for m in marks]
    points = np.array(lines, dtype=np.float32).reshape(-1, 3)
    node.set_object(g.LineSegments(g.PointsGeometry(points.T), g.LineBasicMaterial(color=0xC3CCD5)))


def turn_to(direction: Array, axis: int) -> Array:
    """A rotation (3, 3) that turns the given coordinate axis to a unit direction."""
    other = np.eye(3)[int(np.argmin(np.abs(direction)))]
    side = np.cross(other, direction)
    side /= np.linalg.norm(side)
    columns = [np.zeros(3)] * 3
    columns[axis], columns[(axis + 1) % 3] = direction, side
    columns[(axis + 2) % 3] = np.cross(direction, side)
    return np.column_stack(columns)


# -------- What every page starts from: background, floor, camera, and the keys that the
#          script reads


def set_stage(vis: Any, size: float) -> None:
    """Replaces meshcat's dark sky, huge grid and axes by a light stage of the right size."""
    vis["/Grid"].delete()
    vis["/Axes"].delete()
    vis["/Background"].set_property("top_color", [1.0, 1.0, 1.0])
    vis["/Background"].set_property("bottom_color", [0.86, 0.9, 0.94])
    floor(vis["/meshcat/floor"], 1.2 * size, round_step(size))


def empty_spec(title: str, subtitle: str, camera: Camera, root: str = "/meshcat") -> dict[str, Any]:
    """A page of nothing but its title; the mechanisms fill in the rest.

    Args:
        title: the mechanism's name.
        subtitle: where it comes from.
        camera: where to look from.
        root: the node in whose frame the tool's position, and what is added, are given.
    """
    trace = f"{root}/trace"
    return {
        "root": root,
        "title": title,
        "subtitle": subtitle,
        "notes": [],
        "camera": camera.as_json(),
        "planar": False,
        "body": "",
        "dh": [],
        "dh_convention": "",
        "dh_columns": [],
        "groups": {"trace": [trace]},
        "labels": [],
        "shown": ["added"],
        "checks": [["trace", _("tool trace")]],
        "ellipsoids": [],
        "legend": [],
        "trace": trace,
        "animation": None,
        "live": "",
        "lang": language(),
    }


def add_ellipsoids(vis: Any, spec: dict[str, Any], size: float, rank: int) -> None:
    """The velocity and force ellipsoids at the tool, which the page shapes and shows.

    Args:
        vis: the scene.
        spec: the page's spec, filled in.
        size: of the mechanism, metres.
        rank: number of directions in which the tool can move.
    """
    for kind, color in ELLIPSOIDS.items():
        path = f"{spec['root']}/ellipsoids/{kind}"
        ball(vis[path], 1.0, paint(color, 0.4))
        entry = {"kind": kind, "path": path, "size": ELLIPSOID_SIZE * size, "rank": rank}
        spec["ellipsoids"].append(entry)
        spec["groups"][kind] = [path]
        spec["checks"].append([kind, _(ELLIPSOID_NAMES[kind])])
