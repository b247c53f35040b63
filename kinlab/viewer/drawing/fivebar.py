"""The five-bar drawn in its own plane, stood upright: cranks, rods, loci and workspace.

The page closes the loop itself, by the closed form of :mod:`kinlab.fivebar.geometry`.
"""

from __future__ import annotations

from typing import Any

import numpy as np

from kinlab.arrays import Array
from kinlab.errors import StructureError
from kinlab.fivebar import FiveBar
from kinlab.fivebar.arguments import HANGING, Mode
from kinlab.fivebar.geometry import solve_pose
from kinlab.host.language import _
from kinlab.viewer.drawing import shapes
from kinlab.viewer.drawing.shapes import Label, add_ellipsoids, empty_spec, look_at, set_stage

HOME = "/meshcat/fivebar"
"""Its frame is the mechanism's plane: x to the right, y up, z towards the viewer."""

LEAST_SINE = 0.01
"""|w_1 x w_2| at which the page stops a crank: just short of type II, where the tool would be
free to take either side."""

_CRANK, _ROD, _PIN, _TOOL = 0x54789A, 0xDB7833, 0x33383F, 0xC62828
_ONE, _TWO = 0x1565C0, 0xC62828
"""Colours of the loci of type I and of type II."""


def size_of(linkage: FiveBar) -> float:
    """Length of the longer leg and the base together, metres: the scale for drawing it."""
    return float(np.max(linkage.l1 + linkage.l2) + linkage.e)


def best_start(linkage: FiveBar, assembly: int) -> Array:
    """The tool on the axis x = 0 where the condition number is least, elbows outward, (2,).

    Raises:
        StructureError: the axis cannot be reached in this assembly.
    """
    far = size_of(linkage)
    points = np.column_stack([np.zeros(400), np.linspace(-far, far, 400)])
    pose = solve_pose(linkage, points, HANGING, "mask")
    kappa = np.ma.filled(linkage.condition_number(points, HANGING, "mask"), np.inf)
    kappa = np.where(pose.ok & (assembly * pose.rods > 0.0), kappa, np.inf)
    k = int(np.argmin(kappa))
    if not np.isfinite(kappa[k]):
        raise StructureError(f"{linkage.name}: x = 0 cannot be reached; give the crank angles")
    best: Array = points[k]
    return best


def draw_page(
    vis: Any, linkage: FiveBar, theta: Array, assembly: int, mode: Mode
) -> dict[str, Any]:
    """Draws a five-bar with its singular loci and workspace.

    Args:
        vis: an empty ``meshcat.Visualizer``.
        linkage: the five-bar.
        theta: crank angles at the start, (2,), rad; they must close.
        assembly: sign of w_1 x w_2.
        mode: signs of u_i x w_i at the start.

    Returns:
        What ``start`` in page.js takes.
    """
    size = size_of(linkage)
    set_stage(vis, size)
    vis["/meshcat/floor"].delete()
    upright = np.array([[1.0, 0, 0, 0], [0, 0, -1, 0], [0, 1, 0, 0], [0, 0, 0, 1]])
    vis[HOME].set_transform(upright)
    edges = _type_one_points(linkage)
    corners = np.array([[p[0], 0.0, p[1]] for curve in edges for p in curve])
    camera = look_at(corners, np.array([0.25, -1.0, 0.12]), 0.0)
    spec = empty_spec(
        linkage.name, _("five-bar. {source}").format(source=linkage.source).strip(), camera, HOME
    )
    _draw_bars(vis, linkage, size)
    spec |= {
        "kind": "fivebar",
        "planar": True,
        "home": HOME,
        "l1": linkage.l1.tolist(),
        "l2": linkage.l2.tolist(),
        "e": linkage.e,
        "assembly": assembly,
        "least_sine": LEAST_SINE,
        "joints": [_crank(i, float(theta[i])) for i in range(2)],
        "q": theta.tolist(),
        "task": "θ̇ = J v",
        "poses": {_("Start"): theta.tolist()},
        "shown": [*spec["shown"], "names", "loci"],
        "labels": [
            Label(HOME, (linkage.e, 0, 0), "A<sub>1</sub>", "names").as_json(),
            Label(HOME, (-linkage.e, 0, 0), "A<sub>2</sub>", "names").as_json(),
            Label(f"{HOME}/rod1", (0, 0, 0), "B<sub>1</sub>", "names").as_json(),
            Label(f"{HOME}/rod2", (0, 0, 0), "B<sub>2</sub>", "names").as_json(),
            Label(f"{HOME}/tool", (0, 0, 0), "P", "names").as_json(),
        ],
    }
    add_ellipsoids(vis, spec, size, 2)
    spec["checks"] += [
        ["names", _("names")],
        ["loci", _("singular loci")],
        ["workspace", _("workspace")],
    ]
    spec["groups"]["loci"] = _draw_loci(vis, linkage, edges, size)
    spec["groups"]["workspace"] = [_draw_workspace(vis, linkage, mode, assembly, size)]
    spec["legend"] += [
        {"name": _("workspace: 1/κ"), "low": 0.0, "high": 1.0},
        {"name": _("type I loci"), "color": f"#{_ONE:06x}"},
        {"name": _("type II loci"), "color": f"#{_TWO:06x}"},
    ]
    return spec


def _crank(i: int, middle: float) -> dict[str, Any]:
    """A slider that starts in its middle, so that no crank begins at the end of its turn."""
    name = _("crank {number}").format(number=i + 1)
    return {
        "name": name,
        "label": f"θ{i + 1}  {name}",
        "type": "revolute",
        "lower": middle - np.pi,
        "upper": middle + np.pi,
    }


def _draw_bars(vis: Any, linkage: FiveBar, size: float) -> None:
    """Cranks in the plane, rod 1 in front of it and rod 2 behind, so that they can cross."""
    width, height = 0.045 * size, 0.02 * size
    for i, layer in ((0, 1.0), (1, -1.0)):
        l1, l2 = float(linkage.l1[i]), float(linkage.l2[i])
        shapes.slab(vis[f"{HOME}/crank{i + 1}"], l1, width, height, shapes.paint(_CRANK))
        rod = vis[f"{HOME}/rod{i + 1}"]
        shapes.slab(rod["body"], l2, 0.7 * width, height, shapes.paint(_ROD))
        aside = np.eye(4)
        aside[2, 3] = 1.1 * layer * height
        rod["body"].set_transform(aside)
        shapes.pin(rod["pin"], np.zeros(3), 0.25 * width, 4 * height, shapes.paint(_PIN))
        centre = np.array([linkage.base_x[i], 0.0, 0.0])
        shapes.pin(vis[f"{HOME}/base{i + 1}"], centre, 0.4 * width, 5 * height, shapes.paint(_PIN))
    shapes.pin(vis[f"{HOME}/tool/pin"], np.zeros(3), 0.45 * width, 5 * height, shapes.paint(_TOOL))


def _type_one_points(linkage: FiveBar) -> list[Array]:
    """The circles of type I as points, (K, 2) each; a circle of radius 0 is left out."""
    circles = [circle for leg in linkage.type_one() for circle in leg]
    angle = np.linspace(0.0, 2.0 * np.pi, 241)
    ring = np.column_stack([np.cos(angle), np.sin(angle)])
    return [np.array(c.centre) + c.radius * ring for c in circles if c.radius > 0.0]


def _draw_loci(vis: Any, linkage: FiveBar, edges: list[Array], size: float) -> list[str]:
    curves = [(curve, _ONE) for curve in edges]
    for locus in linkage.type_two(samples=200):
        curves.append((np.vstack([locus.points, locus.points[:1]]), _TWO))
    for k, (curve, color) in enumerate(curves):
        flat = np.column_stack([curve, np.zeros(len(curve))])
        shapes.tube(vis[f"{HOME}/loci/{k}"], flat, 0.003 * size, color)
    return [f"{HOME}/loci"]


def _draw_workspace(vis: Any, linkage: FiveBar, mode: Mode, assembly: int, size: float) -> str:
    """Reachable points of the start's working mode and assembly, coloured by 1/kappa."""
    area = linkage.workspace_map(mode, resolution=121)
    same = np.ma.filled(assembly * area.rods, -1.0) > 0.0
    quality = np.ma.filled(1.0 / area.condition, 0.0)[same]
    x, y = np.meshgrid(area.x, area.y)
    points = np.column_stack([x[same], y[same], np.full(int(same.sum()), -0.05 * size)])
    path = f"{HOME}/workspace"
    shapes.cloud(vis[path], points, shapes.scale_colors(quality, 0.0, 1.0), 0.03 * size)
    return path
