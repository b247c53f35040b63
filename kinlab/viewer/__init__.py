"""The browser viewer: an arm with sliders, as one HTML file or on a small local server.

===================  =============================================================================
module               what it holds
===================  =============================================================================
``against``          A DH table's arm and another description of it, over each other, with what is
                     wrong lit
``arm_page``         What the page must know to move an arm without a server, as plain JSON values
``fivebar_motions``  Motions to show a five-bar with: round, straight, and pick and place, inside
                     its free circle
``motions``          Motions of an arm for the page: joint sweeps, tool paths by IK, a walk on
                     singularities
``scene``            Scene: an arm on a page, with its ellipsoids and ghosts; and the five-bar's
                     page
``show``             ``kl.view``: a robot in the browser, or inline in a notebook, with one call
``drawing/``         What stands on a page: arms, bodies of a URDF, DH frames, the five-bar,
                     shapes
``page/``            The page itself: one HTML file, or live on a small server; its script and
                     style
===================  =============================================================================
"""

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
