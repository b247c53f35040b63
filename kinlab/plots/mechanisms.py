"""Pictures of a five-bar: its workspace in one mode, a cycle, and what sizing rests on."""

from __future__ import annotations

from pathlib import Path
from typing import Any

import numpy as np

from kinlab.arrays import Array
from kinlab.fivebar import FiveBar
from kinlab.fivebar.arguments import HANGING, Mode
from kinlab.fivebar.cycle import CycleSizing
from kinlab.fivebar.dynamics import crank_inertia, rod_model
from kinlab.fivebar.geometry import solve_pose
from kinlab.fivebar.linkage import as_five_bar
from kinlab.fivebar.servo import ServoSizing
from kinlab.fivebar.workspace import Rectangle
from kinlab.plots.canvas import figure_text, new_axes, new_figure

_LEGS = ("tab:blue", "tab:orange")
_WORST_SHOWN = 10.0
"""Condition numbers above this share the darkest colour."""


def fivebar(
    linkage: FiveBar | str | Path,
    mode: Mode = HANGING,
    assembly: int = 1,
    resolution: int = 301,
    ax: Any = None,
) -> Any:
    """Condition number over the workspace with the loci, the free circle and rectangle.

    Args:
        linkage: the five-bar.
        mode: signs of u_i x w_i.
        assembly: sign of w_1 x w_2 for circle and rectangle.
        resolution: points along the longer side of the map.
        ax: where to draw; a new figure if left out.

    Returns:
        The axes.

    Raises:
        MissingExtraError: matplotlib is not installed.
        StructureError: no pose in that mode and assembly.
    """
    linkage = as_five_bar(linkage)
    axes = ax if ax is not None else new_axes(size=(8.4, 6.6))
    grid = linkage.workspace_map(mode, resolution)
    drawn = axes.pcolormesh(
        grid.x,
        grid.y,
        np.minimum(grid.condition, _WORST_SHOWN),
        cmap="viridis_r",
        vmin=1.0,
        vmax=_WORST_SHOWN,
        shading="nearest",
        rasterized=True,
    )
    axes.figure.colorbar(
        drawn, ax=axes, label=f"condition number of J (from {_WORST_SHOWN:g} up: same)"
    )
    circle = linkage.largest_circle(mode, assembly)
    _loci(axes, linkage, mode)
    ring = _circle(circle.centre, circle.radius)
    axes.plot(
        *ring.T, color="black", lw=1.6, label=f"largest free circle, r = {circle.radius:.3g} m"
    )
    box = linkage.largest_rectangle(mode, assembly)
    box_of(axes, box, f"largest free rectangle, {box.area:.3g} m²")
    for k, pose in enumerate(linkage.isotropic_poses(mode)):
        label = "isotropic pose" if k == 0 else None
        axes.plot(*pose.xy, marker="*", ms=12, color="gold", mec="black", ls="none", label=label)
    bars(axes, linkage, np.array(circle.centre), mode)
    axes.set(aspect="equal", xlabel="x, m", ylabel="y, m")
    signs = ", ".join("+" if s > 0 else "−" for s in mode)
    axes.set_title(f"{figure_text(linkage.name)}: working mode ({signs})")
    axes.figure.legend(loc="outside lower center", ncols=3, fontsize=8, frameon=False)
    return axes


def _loci(axes: Any, linkage: FiveBar, mode: Mode) -> None:
    for leg, circles in enumerate(linkage.type_one()):
        for k, circle in enumerate(circles):
            label = f"type I, leg {leg + 1}" if k else None
            ring = _circle(circle.centre, circle.radius)
            axes.plot(*ring.T, color=_LEGS[leg], lw=1.0, ls="--", label=label)
    first = True
    for locus in linkage.type_two():
        ours = np.all(locus.modes * np.asarray(mode) >= 0, axis=1)
        points = np.where(ours[:, None], locus.points, np.nan)
        points = np.concatenate([points, points[:1]])
        axes.plot(*points.T, color="crimson", lw=2.0, label="type II" if first else None)
        label = "type II, other modes" if first else None
        axes.plot(*locus.points.T, color="crimson", lw=0.6, ls=":", label=label)
        first = False
    for k, line in enumerate(linkage.type_two_contour(mode)):
        label = "type II, by contour" if k == 0 else None
        axes.plot(*line.T, color="black", lw=0.9, ls=(0, (1, 4)), label=label)


def bars(axes: Any, linkage: FiveBar, xy: Array, mode: Mode) -> None:
    """Draws the linkage with its tool at a place (2,)."""
    pose = solve_pose(linkage, xy, mode)
    for leg in range(2):
        base = np.array([linkage.base_x[leg], 0.0])
        elbow = base + linkage.l1[leg] * pose.u[0, leg]
        chain = np.stack([base, elbow, pose.xy[0]])
        axes.plot(*chain.T, color="black", lw=3.4, solid_capstyle="round")
        axes.plot(*chain.T, color=_LEGS[leg], lw=2.0, marker="o", ms=5, mec="black")


def fivebar_cycle(
    linkage: FiveBar | str | Path, sizing: ServoSizing | CycleSizing, ax: Any = None
) -> Any:
    """The pick-and-place cycle in its workspace, with joint rates, torques and power.

    Args:
        linkage: the five-bar.
        sizing: of :meth:`kinlab.FiveBar.size_servo` or ``size_cycle``.
        ax: four axes of one figure; a new figure if left out.

    Returns:
        The first of its four axes.

    Raises:
        MissingExtraError: matplotlib is not installed.
    """
    four = new_figure((9.6, 6.4)).subplots(2, 2) if ax is None else ax
    where, rate, torque, power = np.ravel(four)
    figure = where.figure
    path, linkage = sizing.path, as_five_bar(linkage)
    if isinstance(sizing, CycleSizing):
        cycle, mode, limits = sizing.demand, sizing.mode, f"cycle {figure_text(sizing.cycle.name)}"
    else:
        cycle, mode = sizing.cycle, sizing.mode
        limits = f"v ≤ {sizing.v_max:g} m/s, a ≤ {sizing.a_max:g} m/s²"
        box_of(where, sizing.workspace, None, colour="tab:green")
    where.plot(*path.points.T, color="black", lw=1.5)
    bars(where, linkage, path.points[len(path.t) // 4], mode)
    where.set(aspect="equal", xlabel="x, m", ylabel="y, m", title="path in the workspace")
    curves = (
        (rate, cycle.v, "crank rate, rad/s"),
        (torque, cycle.tau, "crank torque, N m"),
        (power, cycle.power, "crank power, W"),
    )
    for axes, values, label in curves:
        for leg in range(2):
            axes.plot(path.t, values[:, leg], color=_LEGS[leg], label=f"crank {leg + 1}")
        axes.axhline(0.0, color="0.6", lw=0.6, zorder=0)
        axes.set(xlabel="t, s", ylabel=label, xlim=(0.0, path.duration))
    rms = cycle.rms_torque.max()
    torque.axhline(rms, color="0.4", lw=1.0, ls=":")
    torque.axhline(-rms, color="0.4", lw=1.0, ls=":", label=f"± RMS, {rms:.3g} N m")
    figure.legend(*torque.get_legend_handles_labels(), loc="outside lower center", ncols=3)
    figure.suptitle(
        f"{figure_text(linkage.name)}: {60 / path.duration:.0f} cycles a minute, {limits}"
    )
    return where


def fivebar_gains(linkage: FiveBar | str | Path, sizing: ServoSizing, ax: Any = None) -> Any:
    """Torque per acceleration over the gain of J: I_A sigma + m / sigma, least at sqrt(eta).

    Args:
        linkage: the five-bar.
        sizing: of :meth:`kinlab.FiveBar.size_servo` or ``size_cycle``.
        ax: where to draw; a new figure if left out.

    Returns:
        The axes.

    Raises:
        MissingExtraError: matplotlib is not installed.
    """
    linkage = as_five_bar(linkage)
    axes = ax if ax is not None else new_axes(size=(7.2, 4.4))
    arms = crank_inertia(linkage, rod_model(linkage, "massless"))
    arms = arms - linkage.reflected_inertia
    best = np.sqrt(sizing.eta[np.isfinite(sizing.eta)])
    low = 0.5 * min([sizing.sigma[0], *best])
    high = 1.5 * max([sizing.sigma[1], *best])
    sigma = np.linspace(low, high, 400)
    for leg, (arm, eta) in enumerate(zip(arms, sizing.eta, strict=True)):
        if leg == 1 and arm == arms[0]:
            continue  # the same curve again
        name = "both cranks" if arms[0] == arms[1] else f"crank {leg + 1}"
        label = f"{name}: η = m/I$_A$ = {eta:.3g} m⁻²"
        axes.plot(sigma, arm * sigma + linkage.payload / sigma, color=_LEGS[leg], label=label)
        if np.isfinite(eta) and eta > 0:
            least = 2.0 * np.sqrt(arm * linkage.payload)
            label = f"least at σ = √η = {np.sqrt(eta):.3g} rad/m"
            axes.plot(np.sqrt(eta), least, "o", color=_LEGS[leg], label=label)
    axes.axvspan(*sizing.sigma, color="tab:green", alpha=0.18, label="J in the workspace")
    axes.set(title=f"{figure_text(linkage.name)}: torque per acceleration")
    axes.set(xlabel="singular value σ of J, rad/m", ylabel="I$_A$ σ + m/σ, kg m")
    axes.set_ylim(bottom=0.0)
    axes.legend(fontsize=9)
    return axes


def _circle(centre: tuple[float, float], radius: float) -> Array:
    phi = np.linspace(0.0, 2.0 * np.pi, 361)
    return np.array(centre) + radius * np.stack([np.cos(phi), np.sin(phi)], axis=1)


def box_of(axes: Any, box: Rectangle, label: str | None, colour: str = "black") -> None:
    """Draws the outline of a rectangle."""
    x, y = box[:2], box[2:]
    corners = np.array([[x[0], x[1], x[1], x[0], x[0]], [y[0], y[0], y[1], y[1], y[0]]])
    axes.plot(*corners, color=colour, lw=1.8, ls="-.", label=label)
