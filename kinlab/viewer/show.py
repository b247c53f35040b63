"""``kl.view``: a robot in the browser, or inline in a notebook, with one call."""

from __future__ import annotations

import os
import sys
import webbrowser
from typing import TYPE_CHECKING, Any

from numpy.typing import ArrayLike

from kinlab.errors import OptionError
from kinlab.fivebar.linkage import as_mechanism
from kinlab.model.library import ArmLike
from kinlab.model.robot import Robot

if TYPE_CHECKING:
    from kinlab.fivebar import FiveBar
    from kinlab.motion.record import Motion
    from kinlab.motion.simulation import Simulation
    from kinlab.viewer.scene import FiveBarScene, Scene


def view(
    robot: ArmLike | FiveBar,
    q: ArrayLike | None = None,
    *,
    meshes: bool = True,
    against: Any = None,
    motion: Motion | Simulation | None = None,
) -> Scene | FiveBarScene:
    """Shows an arm or a five-bar: inline in a notebook, otherwise in the browser.

    The browser page is served on loopback in the background until the program ends; its address
    is printed. In a notebook nothing is served: the cell shows a page that stands by itself.

    Args:
        robot: anything that names an arm, or a :class:`kinlab.FiveBar`, its name or path.
        q: joint positions at the start, (n,); of a five-bar the crank angles, (2,). Left out,
            zero, and for a five-bar its best-conditioned hanging pose.
        meshes: draw the URDF's meshes; otherwise rods from joint to joint.
        against: another description of the same arm, as for :func:`kinlab.diagnose_table`: it is
            drawn see-through over the arm, moves with it, and what is wrong in the table is lit.
        motion: of :mod:`kinlab.motion` or :func:`kinlab.simulate`, of this arm: to play and scrub.

    Returns:
        The scene, to which frames, paths, clouds and (of an arm) ghosts can be added.

    Raises:
        StateError: q of another shape, or not finite.
        UnreachableError, SingularError: a five-bar that cannot close at q, or is singular there.
        OptionError: a motion beside ``against``, or of a five-bar.
    """
    from kinlab.viewer.scene import FiveBarScene, Scene

    arm: Any = robot
    scene: Scene | FiveBarScene
    robot = as_mechanism(robot)
    if motion is not None and (against is not None or not isinstance(robot, Robot)):
        raise OptionError("view: a motion is shown of one arm: a Robot, a table or a name")
    if against is not None:
        from kinlab.viewer.against import against_scene

        scene = against_scene(arm, against, q)
    elif isinstance(robot, Robot):
        scene = Scene(robot, motion.q[0] if q is None and motion is not None else q, meshes=meshes)
        if motion is not None:
            scene.play(motion)
    else:
        scene = FiveBarScene(robot, q)
    if not in_notebook():
        server = scene.serve()
        print(f"{robot.name}: {server.url}")
        open_browser(server.url)
    return scene


def in_notebook() -> bool:
    """Whether this runs in a Jupyter kernel, which shows what a cell returns."""
    shell = sys.modules.get("IPython")
    running = shell.get_ipython() if shell is not None else None
    return running is not None and hasattr(running, "kernel")


def open_browser(url: str) -> bool:
    """Opens the user's graphical browser, where there is one.

    Returns:
        Whether one was found. A browser in the terminal would take the terminal over, so
        without a display none is tried.
    """
    wants_display = sys.platform not in ("darwin", "win32")
    displays = ("DISPLAY", "WAYLAND_DISPLAY", "BROWSER")
    if wants_display and not any(os.environ.get(key) for key in displays):
        return False
    try:
        return webbrowser.open(url)
    except webbrowser.Error:
        return False
