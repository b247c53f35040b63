"""Scene: an arm on a page, with its ellipsoids and ghosts; and the five-bar's page."""

from __future__ import annotations

from pathlib import Path
from typing import TYPE_CHECKING

import numpy as np
from numpy.typing import ArrayLike

from kinlab.analysis.structure.axes import frame_origins
from kinlab.arrays import Array, real_array, shaped
from kinlab.engine.fast.stacks import fk, jacobian
from kinlab.engine.states import joint_vector, warn_far
from kinlab.errors import NameUnknownError, StateError, near, warn
from kinlab.fivebar import FiveBar
from kinlab.fivebar.geometry import solve_pose
from kinlab.fivebar.linkage import as_five_bar
from kinlab.host.language import _
from kinlab.model.library import ArmLike, as_robot
from kinlab.viewer.arm_page import DIRECTION, MARGIN, draw_page
from kinlab.viewer.drawing import shapes
from kinlab.viewer.drawing.arm import draw_ghost, reach
from kinlab.viewer.drawing.fivebar import best_start, size_of
from kinlab.viewer.drawing.fivebar import draw_page as draw_fivebar
from kinlab.viewer.drawing.shapes import look_at
from kinlab.viewer.page.page import COLORS, Page, one_pose
from kinlab.viewer.page.static_page import new_scene

if TYPE_CHECKING:
    from kinlab.motion.record import Motion
    from kinlab.motion.simulation import Simulation

_SEEN = 60
"""Poses of a motion that the camera is placed by."""


class Scene(Page):
    """A robot in the viewer, to which a script adds frames, ellipsoids, paths, clouds, ghosts.

    Args:
        robot: the arm to draw.
        q: joint positions at the start, (n,); left out, zero (or the nearest limit).
        meshes: draw the URDF's meshes; otherwise rods from joint to joint.

    Raises:
        StateError: q of another shape, or not finite.
    """

    def __init__(self, robot: ArmLike, q: ArrayLike | None = None, *, meshes: bool = True) -> None:
        robot = self.robot = as_robot(robot)
        if q is None:
            start = np.clip(np.zeros(robot.n), robot.lower, robot.upper)
        else:
            start = one_pose(self._joints(q), robot.name)
            if isinstance(q, np.ndarray):  # of a list, it has been asked
                warn_far(robot, start)
        vis, recorder = new_scene()
        spec = draw_page(vis, robot, start, meshes=meshes)
        super().__init__(vis, recorder, spec, reach(robot), self._joints)
        self._seen: list[Array] = []

    def animate(self, q: ArrayLike, duration: float | ArrayLike, name: str = "Motion") -> None:
        """As :meth:`Page.animate`; the camera sees the whole motion."""
        super().animate(q, duration, name)
        self._see(self._read(q))

    def _see(self, poses: Array) -> None:
        """Moves the camera so that it sees the arm at the start and at poses (N, n)."""
        some = np.unique(np.linspace(0, len(poses) - 1, _SEEN).astype(int))
        self._seen += [frame_origins(self.robot, poses[k]) for k in some if k < len(poses)]
        points = np.concatenate([frame_origins(self.robot, self.q), *self._seen])
        self._spec["camera"] = look_at(points, DIRECTION, MARGIN * self._size).as_json()

    def _joints(self, q: ArrayLike) -> Array:
        return joint_vector(self.robot, q, "q")

    def ellipsoid(self, name: str, q: ArrayLike, kind: str = "velocity") -> None:
        """Draws the ellipsoid of the tool's velocities or forces at a pose, and leaves it there.

        Args:
            name: what to call it.
            q: joint positions, (n,).
            kind: ``"velocity"``: semi-axes sigma_i; ``"force"``: 1/sigma_i. Both are scaled so
                that the longest is a fifth of the arm; a force without bound is drawn flat.

        Raises:
            NameUnknownError: another kind.
            StateError: q of another shape, or not finite.
        """
        if kind not in shapes.ELLIPSOIDS:
            raise NameUnknownError(f"ellipsoid {kind!r}; {near(kind, shapes.ELLIPSOIDS)}")
        pose = self._one(q)
        U, sigma, _ = np.linalg.svd(jacobian(self.robot, pose)[:3])
        sigma = np.append(sigma, np.zeros(3 - len(sigma)))
        moves = sigma > 1e-9 * sigma[0]
        axes = sigma if kind == "velocity" else np.where(moves, 1 / np.where(moves, sigma, 1), 0)
        scale = shapes.ELLIPSOID_SIZE * self._size
        radii = scale * np.maximum(axes / (axes.max() or 1.0), 0.01)
        place = np.eye(4)
        place[:3, :3] = U * radii * (1, 1, np.linalg.det(U))
        place[:3, 3] = fk(self.robot, pose)[:3, 3]
        path = self._node(name)
        shapes.ball(self._vis[path], 1.0, shapes.paint(shapes.ELLIPSOIDS[kind], 0.4))
        self._vis[path].set_transform(place)

    def play(self, motion: Motion | Simulation) -> None:
        """Gives the page a motion of :mod:`kinlab.motion`, or a simulated one, to play and scrub.

        The tool's way is drawn as a line; where a planned motion meets a singularity or breaks a
        limit, a labelled frame stands (:func:`kinlab.motion.check`).

        Raises:
            StateError: a motion of another number of joints.
        """
        from kinlab.motion.checks import check  # numba, which other pages do without
        from kinlab.motion.simulation import Simulation

        rows = self._joints(motion.q)
        tool = fk(self.robot, rows)[:, :3, 3]
        if np.ptp(tool, axis=0).max() > 0.0:
            self.path("the tool's way", tool)
        if isinstance(motion, Simulation):
            self.animate(rows, motion.t, _("Simulated motion"))
        else:
            self.animate(rows, motion.t, _("Motion: {law}").format(law=motion.law))
            found = check(self.robot, motion).findings
            for one in (x for x in found if x.kind != "branch"):  # it stands at its singularity
                name = f"{one.kind}, t = {one.t:.3g} s"
                self.frame(name, fk(self.robot, motion.at(one.t)[0]))

    def ghosts(self, name: str, q: ArrayLike, color: int | None = None) -> None:
        """Draws the robot see-through at other poses, such as the branches of an IK solution.

        Args:
            name: what to call them.
            q: joint positions, (n,) or (N, n).
            color: 0xRRGGBB; left out, each ghost has its own.

        Raises:
            StateError: q of another shape, or not finite.
        """
        poses = np.atleast_2d(self._read(q))
        root = self._node(name)
        for i, pose in enumerate(poses):
            paint = COLORS[i % len(COLORS)] if color is None else color
            draw_ghost(self._vis, self.robot, pose, f"{root}/{i + 1}", paint)
        self._see(poses)


class FiveBarScene(Page):
    """A five-bar in the viewer. Points that are added are in its plane: (x, y, 0).

    Args:
        linkage: the five-bar.
        theta: crank angles at the start, (2,), rad; left out, the best-conditioned pose on the
            axis x = 0 that hangs below the base.
        assembly: sign of w_1 x w_2.

    Attributes:
        mode: signs of u_i x w_i at the start.

    Raises:
        UnreachableError: the loop cannot close there.
        SingularError: the start is a singularity of type II.
        StateError: theta of another shape, or not finite.
    """

    def __init__(
        self,
        linkage: FiveBar | str | Path,
        theta: ArrayLike | None = None,
        assembly: int = 1,
    ) -> None:
        linkage = as_five_bar(linkage)
        self.linkage, self.assembly = linkage, assembly
        if theta is None:
            start = linkage.ik(best_start(linkage, assembly))
        else:
            start = shaped(theta, (2,), f"{linkage.name}: theta")
            if np.max(np.abs(start)) > 4.0 * np.pi:
                angles = " and ".join(f"{angle:.6g}" for angle in start)
                warn(f"{linkage.name}: the cranks stand at {angles} rad: degrees?")
        xy = linkage.fk(start, assembly)
        self.mode = linkage.mode_of(start, xy)
        solve_pose(linkage, xy, self.mode, regular="II")
        vis, recorder = new_scene()
        spec = draw_fivebar(vis, linkage, start, assembly, self.mode)
        super().__init__(vis, recorder, spec, size_of(linkage), self._angles)

    def _angles(self, theta: ArrayLike) -> Array:
        angles = real_array(theta, f"{self.linkage.name}: theta")
        if angles.ndim not in (1, 2) or angles.shape[-1] != 2:
            raise StateError(
                f"{self.linkage.name}: theta has shape {angles.shape}; expected (2,) or (N, 2)"
            )
        return angles
