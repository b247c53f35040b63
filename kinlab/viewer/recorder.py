"""A meshcat window that remembers the scene instead of sending it to a server.

meshcat's own window starts a server process that listens on every interface. This one keeps
the drawing commands in memory: the static page embeds them, the live server sends them on.
"""

from __future__ import annotations

from collections.abc import Callable
from typing import Any

import meshcat
import umsgpack


class Recorder:
    """Drop-in for ``meshcat.visualizer.ViewerWindow``: keeps the newest command of each kind.

    Attributes:
        web_url: asked for by ``meshcat.Visualizer``; there is none.
        listeners: called with each packed command and each message of :meth:`tell`.
    """

    web_url = ""

    def __init__(self) -> None:
        self._commands: dict[tuple[str, ...], bytes] = {}
        self.listeners: list[Callable[[bytes | dict[str, Any]], None]] = []

    def send(self, command: Any) -> None:
        """Takes one meshcat command; a later one for the same path and property replaces it."""
        data = command.lower()
        kind, path = data["type"], _clean(data["path"])
        packed = umsgpack.packb(data)
        if kind == "delete":
            inside = path + "/"
            self._commands = {
                key: value
                for key, value in self._commands.items()
                if key[1] != path and not key[1].startswith(inside)
            }
        key = (kind, path, str(data.get("property", "")))
        self._commands.pop(key, None)  # a replaced command takes its place at the end
        self._commands[key] = packed
        self.tell(packed)

    def tell(self, message: bytes | dict[str, Any]) -> None:
        """Passes a packed command, or a message of ours, to every listener."""
        for listener in self.listeners:
            listener(message)

    def commands(self) -> list[bytes]:
        """The commands that build the scene in an empty viewer, packed, in order."""
        return list(self._commands.values())


def new_scene() -> tuple[Any, Recorder]:
    """A ``meshcat.Visualizer`` that draws into memory, and the memory."""
    recorder = Recorder()
    return meshcat.Visualizer(window=recorder), recorder


def _clean(path: str) -> str:
    return "/" + "/".join(part for part in path.split("/") if part)
