"""Curves in joint space and along paths."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any

import numpy as np
from numpy.typing import ArrayLike

from kinlab.analysis import metrics
from kinlab.analysis.singularities.loci import Loci
from kinlab.analysis.singularities.loci import singular_loci as traced
from kinlab.analysis.structure.task_space import read_length, read_task
from kinlab.engine.states import joint_vector
from kinlab.errors import OptionError
from kinlab.model.library import ArmLike, as_robot
from kinlab.model.robot import Robot
from kinlab.plots.canvas import BLUE, RED, degree_ticks, figure_text, new_axes, spread_labels


def singular_values(
    robot: ArmLike, path: ArrayLike, task: Any = "auto", length: float = 1.0, ax: Any = None
) -> Any:
    """Singular values of J along a path of configurations, on a logarithmic scale.

    Args:
        robot: the robot.
        path: configurations in order, (N, n), N >= 2.
        task, length: as in :func:`kinlab.manipulability`, or ``"auto"``.
        ax: where to draw; a new figure if left out.

    Returns:
        The axes.

    Raises:
        StateError, OptionError, NameUnknownError, MissingExtraError: bad path, task or length.
    """
    robot = as_robot(robot)
    space, size = read_task(robot, task), read_length(length)
    states = joint_vector(robot, path, "path")
    if states.ndim != 2 or len(states) < 2:
        raise OptionError(f"robot {robot.name!r}: path has shape {states.shape}; expected (N, n)")
    sigma = metrics.singular_values(space.jacobian(states, size))
    axes = ax if ax is not None else new_axes(f"{robot.name}: singular values, task {space.name}")
    along = np.concatenate([[0.0], np.cumsum(np.linalg.norm(np.diff(states, axis=0), axis=1))])
    floor = 1e-16 * max(float(sigma.max()), 1e-300)
    for i, values in enumerate(sigma.T):
        last = i == sigma.shape[1] - 1
        axes.semilogy(
            along,
            np.maximum(values, floor),
            lw=2.0 if last else 1.2,
            color=RED if last else BLUE,
            alpha=1.0 if last else 0.9 - 0.12 * i,
            label=f"σ{i + 1}",
        )
    axes.set_ylim(max(floor, 0.3 * float(sigma[sigma > 0.0].min(initial=1.0))), None)
    axes.set_xlabel("way in joint space [rad or m]")
    axes.set_ylabel(f"singular value (length {size:g} m)" if space.mixed else "singular value")
    axes.grid(alpha=0.25, which="both")
    axes.legend(fontsize=9, ncols=3)
    return axes


def singular_loci(
    robot: ArmLike,
    loci: Loci | None = None,
    *,
    joints: Sequence[int] | None = None,
    task: Any = "auto",
    seed: int = 0,
    ax: Any = None,
) -> Any:
    """Singular curves over two joints, or in the space of three.

    Args:
        robot: the robot.
        loci: of :func:`kinlab.singular_loci`; traced here if left out.
        joints, task, seed: as there, for curves that are traced here; left out, the slice begins
            with the second joint where one can be spared, since the first seldom decides anything.
        ax: where to draw; a new figure if left out.

    Returns:
        The axes.

    Raises:
        KinlabError: as :func:`kinlab.singular_loci`.
        MissingExtraError: matplotlib is not installed.
    """
    robot = as_robot(robot)
    if loci is None:
        needed = abs(read_task(robot, task).m - robot.n) + 2
        first = 1 if robot.n > needed else 0
        chosen = range(first, first + needed) if joints is None else joints
        loci = traced(robot, list(chosen), task=task, seed=seed)
    three = len(loci.joints) == 3
    title = f"{loci.robot}: singular curves, task {loci.task}"
    axes = ax if ax is not None else new_axes(title, three_d=three)
    label: str | None = "singular: det J = 0" if _square(robot, loci) else "singular: J loses rank"
    lower, upper = (np.degrees(b[list(loci.joints)]) for b in (robot.lower, robot.upper))
    for curve in loci.curves:
        angles = np.degrees(curve.q[:, list(loci.joints)])
        wrapped = np.where(
            upper - lower >= 360.0 - 1e-6, np.mod(angles + 180.001, 360.0) - 180.001, angles
        )
        jumps = np.abs(np.diff(wrapped, axis=0)).max(axis=1) > 180.0
        for piece in np.split(wrapped, np.flatnonzero(jumps) + 1):
            axes.plot(*piece.T, color=RED, lw=1.6, label=label)
            label = None
    names = [figure_text(robot.joint_names[j]) for j in loci.joints]
    axes.set_xlabel(f"{names[0]} [deg]")
    axes.set_ylabel(f"{names[1]} [deg]")
    for which, (low, high) in zip("xyz", zip(lower, upper, strict=True), strict=False):
        reach = (-180.0, 180.0) if high - low >= 360.0 - 1e-6 else (low, high)
        getattr(axes, f"set_{which}lim")(reach[0] - 5.0, reach[1] + 5.0)
        degree_ticks(getattr(axes, f"{which}axis"), reach, few=three)
    if three:
        axes.set_zlabel(f"{names[2]} [deg]")
        spread_labels(axes)
    axes.grid(alpha=0.25)
    if loci.curves:
        axes.legend(fontsize=9, loc="upper right")
    return axes


def _square(robot: Robot, loci: Loci) -> bool:
    """Whether the Jacobian of the curves' task is square, so that it has a determinant."""
    return len(loci.joints) == 2 and read_task(robot, loci.task).m == robot.n
