"""The browser viewer: an arm with sliders, as one HTML file or on a small local server."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

from kinlab.viewer.show import view

if TYPE_CHECKING:
    from kinlab.viewer.scene import FiveBarScene as FiveBarScene
    from kinlab.viewer.scene import Scene as Scene

__all__ = ["FiveBarScene", "Scene", "view"]


def __getattr__(name: str) -> Any:
    """Loads the scenes, and meshcat with them, when they are first asked for."""
    if name in ("FiveBarScene", "Scene"):
        from kinlab.viewer import scene

        return getattr(scene, name)
    raise AttributeError(f"module {__name__!r} has no attribute {name!r}")
