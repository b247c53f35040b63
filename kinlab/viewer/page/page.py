"""Page: what every page has, whatever moves on it: marks, motion, saving, serving."""

from __future__ import annotations

import html
from collections.abc import Callable
from pathlib import Path
from typing import TYPE_CHECKING, Any

import numpy as np
from numpy.typing import ArrayLike

from kinlab.arrays import Array, real_array, rigid_transform, shaped
from kinlab.errors import OptionError, StateError
from kinlab.host.files import write_text
from kinlab.viewer.drawing import shapes
from kinlab.viewer.drawing.shapes import Label
from kinlab.viewer.motions import motion_json
from kinlab.viewer.page.static_page import Recorder, page_html

if TYPE_CHECKING:
    from kinlab.viewer.page.live import LiveServer

COLORS = (0x8E24AA, 0xEF6C00, 0x00897B, 0xC62828, 0x1565C0, 0x6D4C41)
"""Given out in turn to what asks for no colour."""


def one_pose(q: Array, name: str) -> Array:
    """Refuses a stack of poses where one is wanted.

    Raises:
        StateError: naming the mechanism.
    """
    if q.ndim != 1:
        raise StateError(f"{name!r}: q has shape {q.shape}; give one pose")
    return q


class Page:
    """A drawn mechanism and what a script adds to it.

    Names are the caller's; drawing under a name again replaces what was there. In a notebook
    the page shows itself inline and needs no server.

    Args:
        vis: the ``meshcat.Visualizer`` that holds the mechanism.
        recorder: its memory.
        spec: what the page must know of the mechanism.
        size: of the mechanism, metres.
        read: checks joint positions: (n,) or (N, n) in, float64 out.
    """

    def __init__(
        self,
        vis: Any,
        recorder: Recorder,
        spec: dict[str, Any],
        size: float,
        read: Callable[[ArrayLike], Array],
    ) -> None:
        self._vis, self._recorder, self._spec = vis, recorder, spec
        self._size, self._read = size, read
        self._lines = 0
        self.revision = 0

    @property
    def notes(self) -> tuple[str, ...]:
        """What could not be drawn as the robot's file asks, such as missing meshes."""
        return tuple(self._spec["notes"])

    @property
    def q(self) -> Array:
        """Joint positions the page starts with, (n,); a live page keeps them up to date."""
        return np.array(self._spec["q"])

    def show(self, q: ArrayLike) -> None:
        """Moves the mechanism to q, (n,).

        Raises:
            StateError: q of another shape, or not finite.
        """
        self._spec["q"] = self._one(q).tolist()
        self._recorder.tell({"q": self._spec["q"]})

    def frame(self, name: str, T: ArrayLike, size: float | None = None) -> None:
        """Draws a labelled triad.

        Args:
            name: what to call it.
            T: its pose in the base, (4, 4).
            size: length of its axes, metres.

        Raises:
            StateError: T is not a rigid transform.
        """
        pose = rigid_transform(shaped(T, (4, 4), f"frame {name!r}"), f"frame {name!r}")
        path = self._node(name)
        shapes.triad(self._vis[path], 0.12 * self._size if size is None else size)
        self._vis[path].set_transform(pose)
        self._forget(name)
        self._spec["labels"].append(Label(path, (0, 0, 0), html.escape(name), "added").as_json())
        self._changed()

    def path(self, name: str, points: ArrayLike, color: int | None = None) -> None:
        """Draws a line through points (N, 3), metres, N at least 2; colour 0xRRGGBB.

        Raises:
            StateError: points of another shape, or not finite.
        """
        line = self._points(name, points, least=2)
        shapes.tube(self._vis[self._node(name)], line, 0.003 * self._size, self._color(color))

    def points(
        self, name: str, points: ArrayLike, values: ArrayLike | None = None, size: float = 0.0
    ) -> None:
        """Draws a cloud of points, such as a workspace coloured by its condition number.

        Args:
            name: what to call it; stands in the legend.
            points: (N, 3), metres.
            values: one number per point, coloured from dark blue (least) to yellow (greatest).
            size: of a point, metres; left out, a hundredth of the mechanism.

        Raises:
            StateError: shapes that do not agree, or not finite.
        """
        cloud = self._points(name, points)
        colors = np.tile(shapes.rgb(0x546E7A), (len(cloud), 1))
        if values is not None:
            numbers = shaped(values, (len(cloud),), f"points {name!r}: values")
            low, high = float(numbers.min()), float(numbers.max())
            colors = shapes.scale_colors(numbers, low, high)
            self._forget(name)
            self._spec["legend"].append({"name": name, "low": low, "high": high})
            self._changed()
        shapes.cloud(self._vis[self._node(name)], cloud, colors, size or 0.01 * self._size)

    def animate(self, q: ArrayLike, duration: float | ArrayLike, name: str = "Motion") -> None:
        """Gives the page a motion with play, pause and scrub.

        Args:
            q: joint positions, (N, n).
            duration: seconds for the whole at even steps, or the times themselves, (N,).
            name: heading in the page.

        Raises:
            StateError, OptionError: as :func:`kinlab.viewer.motions.motion_json`.
        """
        rows = self._read(q)
        self._spec["animation"] = motion_json(rows, duration, name)
        self._changed()

    def delete(self, name: str) -> None:
        """Removes what was drawn under a name."""
        self._vis[self._node(name)].delete()
        self._forget(name)
        self._changed()

    def html(self, *, live: str = "") -> str:
        """The page as one HTML text; with ``live``, one that keeps in touch with its server."""
        return page_html({**self._spec, "live": live}, self._recorder.commands())

    def save(self, path: str | Path) -> None:
        """Writes the page as one file that needs no server and no network.

        Raises:
            FileError: the file cannot be written.
        """
        write_text(path, self.html())

    def serve(self, host: str = "127.0.0.1", port: int = 7000) -> LiveServer:
        """Serves the page in the background until the program ends.

        Returns:
            The :class:`kinlab.viewer.page.live.LiveServer`, already running; its ``url`` and
            ``stop()`` are there.
        """
        from kinlab.viewer.page.live import LiveServer

        return LiveServer(self, host, port).start()

    def remember(self, q: Array) -> None:
        """Keeps where a live page's sliders stand, for the next time it is opened.

        Raises:
            StateError: q of another shape, or not finite.
        """
        self._spec["q"] = self._one(q).tolist()

    def listen(self, listener: Callable[[bytes | dict[str, Any]], None]) -> None:
        """Has every later change of the scene told to ``listener``, as bytes or a mapping."""
        self._recorder.listeners.append(listener)

    def _repr_html_(self) -> str:
        page = html.escape(self.html(), quote=True)
        return f'<iframe srcdoc="{page}" style="width:100%;height:640px;border:0"></iframe>'

    def _changed(self) -> None:
        self.revision += 1
        self._recorder.tell({"reload": True})

    def _node(self, name: str) -> str:
        if not name.strip():
            raise OptionError(f"name {name!r}: what is drawn must have a name")
        return f"{self._spec['root']}/added/{name.replace('/', '_')}"

    def _points(self, name: str, points: ArrayLike, least: int = 1) -> Array:
        array = real_array(points, f"points {name!r}")
        if array.ndim != 2 or array.shape[1] != 3 or len(array) < least:
            raise StateError(
                f"points {name!r}: shape {array.shape}; expected (N, 3), N at least {least}"
            )
        return array

    def _color(self, color: int | None) -> int:
        if color is not None:
            return color
        self._lines += 1
        return COLORS[(self._lines - 1) % len(COLORS)]

    def _one(self, q: ArrayLike) -> Array:
        return one_pose(self._read(q), self._spec["title"])

    def _forget(self, name: str) -> None:
        path = self._node(name)
        self._spec["labels"] = [x for x in self._spec["labels"] if x["path"] != path]
        self._spec["legend"] = [x for x in self._spec["legend"] if x["name"] != name]
