"""The browser viewer: an arm with sliders, as one HTML file or on a small local server."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

from kinlab.viewer.show import view

if TYPE_CHECKING:
    from kinlab.viewer.scene import Scene as Scene

__all__ = ["Scene", "view"]


def __getattr__(name: str) -> Any:
    """Loads :class:`Scene`, and meshcat with it, when it is first asked for."""
    if name == "Scene":
        from kinlab.viewer.scene import Scene

        return Scene
    raise AttributeError(f"module {__name__!r} has no attribute {name!r}")
