"""One HTML file with meshcat's viewer, the scene and our script inside: no server, no network."""

from __future__ import annotations

import base64
import html
import json
import re
from collections.abc import Callable, Sequence
from importlib import resources
from typing import Any

import meshcat
import umsgpack

from kinlab.host.language import _, language_tag, speaking
from kinlab.host.web import page_text, policy

# -------- A meshcat window that remembers the scene instead of sending it to a server
# meshcat's own window starts a server process that listens on every interface. This one keeps
# the drawing commands in memory: the static page embeds them, the live server sends them on.


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


# -------- One HTML file with meshcat's viewer, the scene and our script inside: no server,
#          no network

_PAGE = """<!DOCTYPE html>
<html lang="{lang}">
<head>
<meta charset="utf-8">
{policy}
<meta name="viewport" content="width=device-width, initial-scale=1">
<title>{title}</title>
<link rel="icon" href="data:,">
<style>{style}</style>
</head>
<body>
<div id="panel"></div>
<div id="stage"><div id="meshcat-pane"></div><div id="labels"></div></div>
<script>{meshcat}</script>
<script>{script}</script>
<script>{start}</script>
</body>
</html>
"""

_MARKED = re.compile(r'\b_\("([^"]+)"\)')
"""The sentences of our script that are translated."""

_START = """
const viewer = new MeshCat.Viewer(document.getElementById("meshcat-pane"));
const bytes = (text) => Uint8Array.from(atob(text), (letter) => letter.charCodeAt(0));
for (const command of {commands}) viewer.handle_command_bytearray(bytes(command));
window.page = kinlab.start({spec});
"""


def page_html(spec: dict[str, Any], commands: Sequence[bytes]) -> str:
    """The page as text.

    Args:
        spec: what the page must know, see :mod:`kinlab.viewer.page.page`.
        commands: packed meshcat commands that build the scene.
    """
    ours = resources.files("kinlab.viewer.page")
    script = (ours / "page.js").read_text(encoding="utf-8")
    with speaking(spec["lang"]):
        lang = language_tag()
        words = {text: _(text) for text in _MARKED.findall(script)}
    # meshcat's script stands in the page as it is; ours and the data are kept from closing it
    if spec["lang"] != "en":
        spec = {**spec, "words": words}
    data = json.dumps(spec, allow_nan=False).replace("<", "\\u003c")
    packed = json.dumps([base64.b64encode(c).decode("ascii") for c in commands])
    parts = {
        "title": html.escape(f"{spec['title']} - kinlab"),
        "style": (ours / "page.css").read_text(encoding="utf-8"),
        "meshcat": (resources.files("meshcat") / "viewer/dist/main.min.js").read_text("utf-8"),
        "script": script,
        "lang": lang,
        "start": _START.format(commands=packed, spec=data),
    }
    # line ends as the browser sees them, or the digests would differ
    parts = {name: page_text(text.replace("\r\n", "\n")) for name, text in parts.items()}
    scripts = [parts["meshcat"], parts["script"], parts["start"]]
    return _PAGE.format(**parts, policy=policy(scripts, live=bool(spec.get("live"))))
