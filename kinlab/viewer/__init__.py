"""The browser viewer: an arm with sliders, as one HTML file or on a small local server.

===================  =============================================================================
module               what it holds
===================  =============================================================================
``against``          A DH table's arm and another description of it, over each other, with what is
                     wrong lit
``arm``              The arm itself: Pinocchio's MeshcatVisualizer, with the links nested joint in
                     joint
``arm_page``         What the page must know to move an arm without a server, as plain JSON values
``bodies``           The bodies of a URDF that can be drawn: read strictly, meshes tried one by
                     one
``dh_picture``       The picture that teaches DH: frames, z axes, and each row's a, alpha, d,
                     theta on the arm
``fivebar_motions``  Motions to show a five-bar with: round, straight, and pick and place, inside
                     its free circle
``fivebar_page``     The five-bar drawn in its own plane, stood upright: cranks, rods, loci and
                     workspace
``live``             The live page: a small server on loopback that shows a page and passes
                     changes on to it
``motions``          Motions of an arm for the page: joint sweeps, tool paths by IK, a walk on
                     singularities
``page``             Page: what every page has, whatever moves on it: marks, motion, saving,
                     serving
``scene``            Scene: an arm on a page, with its ellipsoids and ghosts; and the five-bar's
                     page
``shapes``           What pages are drawn with: shapes, labels, camera and framing, background and
                     floor
``show``             ``kl.view``: a robot in the browser, or inline in a notebook, with one call
``static_page``      One HTML file with meshcat's viewer, the scene and our script inside: no
                     server, no network
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
