"""The viewer's page as text: what its script is told, and the commands that draw the scene."""

from __future__ import annotations

import base64
import json
import re

import umsgpack

_START = re.compile(r"for \(const command of (\[.*?\])\).*kinlab\.start\((.*)\);\s*</script>", re.S)


def _given(page):
    return [json.loads(text) for text in _START.search(page.html()).groups()]


def told(page):
    """What the page's script is told: labels, legend, notes, animation."""
    return _given(page)[1]


def drawn(page):
    """The scene's commands, unpacked."""
    return [umsgpack.unpackb(base64.b64decode(command)) for command in _given(page)[0]]


def paths(page, kind="set_object"):
    """Where the scene holds something of a kind."""
    return {command["path"] for command in drawn(page) if command["type"] == kind}
