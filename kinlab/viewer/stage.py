"""What every page starts from: background, floor, camera, and the keys that the script reads."""

from __future__ import annotations

from typing import Any

from kinlab.viewer import shapes
from kinlab.viewer.framing import Camera, round_step


def set_stage(vis: Any, size: float) -> None:
    """Replaces meshcat's dark sky, huge grid and axes by a light stage of the right size."""
    vis["/Grid"].delete()
    vis["/Axes"].delete()
    vis["/Background"].set_property("top_color", [1.0, 1.0, 1.0])
    vis["/Background"].set_property("bottom_color", [0.86, 0.9, 0.94])
    shapes.floor(vis["/meshcat/floor"], 1.2 * size, round_step(size))


def empty_spec(
    title: str, subtitle: str, camera: Camera, root: str = "/meshcat"
) -> dict[str, Any]:  # fmt: skip
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
        "checks": [["trace", "tool trace"]],
        "ellipsoids": [],
        "legend": [],
        "trace": trace,
        "animation": None,
        "live": "",
    }


def add_ellipsoids(vis: Any, spec: dict[str, Any], size: float, rank: int) -> None:
    """The velocity and force ellipsoids at the tool, which the page shapes and shows.

    Args:
        vis: the scene.
        spec: the page's spec, filled in.
        size: of the mechanism, metres.
        rank: number of directions in which the tool can move.
    """
    for kind, color in shapes.ELLIPSOIDS.items():
        path = f"{spec['root']}/ellipsoids/{kind}"
        shapes.ball(vis[path], 1.0, shapes.paint(color, 0.4))
        entry = {"kind": kind, "path": path, "size": shapes.ELLIPSOID_SIZE * size, "rank": rank}
        spec["ellipsoids"].append(entry)
        spec["groups"][kind] = [path]
        spec["checks"].append([kind, f"{kind} ellipsoid"])
