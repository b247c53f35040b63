"""Texts that the page hangs beside points of the scene."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from typing import Any

from kinlab.arrays import Array


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
