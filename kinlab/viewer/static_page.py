"""One HTML file with meshcat's viewer, the scene and our script inside: no server, no network."""

from __future__ import annotations

import base64
import html
import json
from collections.abc import Sequence
from importlib import resources
from typing import Any

from kinlab.web import page_text, policy

_PAGE = """<!DOCTYPE html>
<html lang="en">
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

_START = """
const viewer = new MeshCat.Viewer(document.getElementById("meshcat-pane"));
const bytes = (text) => Uint8Array.from(atob(text), (letter) => letter.charCodeAt(0));
for (const command of {commands}) viewer.handle_command_bytearray(bytes(command));
window.page = kinlab.start({spec});
"""


def page_html(spec: dict[str, Any], commands: Sequence[bytes]) -> str:
    """The page as text.

    Args:
        spec: what the page must know, see :mod:`kinlab.viewer.page_spec`.
        commands: packed meshcat commands that build the scene.
    """
    ours = resources.files("kinlab.viewer")
    # meshcat's script stands in the page as it is; ours and the data are kept from closing it
    data = json.dumps(spec, allow_nan=False).replace("<", "\\u003c")
    packed = json.dumps([base64.b64encode(c).decode("ascii") for c in commands])
    parts = {
        "title": html.escape(f"{spec['title']} - kinlab"),
        "style": (ours / "page.css").read_text(encoding="utf-8"),
        "meshcat": (resources.files("meshcat") / "viewer/dist/main.min.js").read_text("utf-8"),
        "script": (ours / "page.js").read_text(encoding="utf-8"),
        "start": _START.format(commands=packed, spec=data),
    }
    # line ends as the browser sees them, or the digests would differ
    parts = {name: page_text(text.replace("\r\n", "\n")) for name, text in parts.items()}
    scripts = [parts["meshcat"], parts["script"], parts["start"]]
    return _PAGE.format(**parts, policy=policy(scripts, live=bool(spec.get("live"))))
