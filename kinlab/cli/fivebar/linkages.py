"""Commands about one five-bar: list, analyse, export."""

from __future__ import annotations

from pathlib import Path
from typing import TYPE_CHECKING, Annotated

import typer

from kinlab.cli.screen import fine_table, screen, styled, wrote
from kinlab.host.language import _
from kinlab.tolerances import TOLERANCES

if TYPE_CHECKING:
    from kinlab.fivebar import FiveBar

from kinlab.cli.fivebar.words import ASSEMBLY, AT, MODE, NAME, PICTURE, fixed, pair, signs_of


def list_fivebars() -> None:
    """List the shipped five-bars and servomotors."""
    from kinlab.drives.motors import catalogue
    from kinlab.fivebar import FiveBar
    from kinlab.fivebar.files import presets

    console = screen(highlight=False)
    table = fine_table(_("five-bar"), "l1, m", "l2, m", "e, m", _("payload, kg"), left=(0,))
    for name in presets():
        one = FiveBar.load(name)
        table.add_row(name, pair(one.l1), pair(one.l2), f"{one.e:.4g}", f"{one.payload:g}")
    console.print(table)
    columns = {
        _("rated W"): "rated_power",
        _("rated N m"): "rated_torque",
        _("peak N m"): "peak_torque",
        _("max r/min"): "max_speed",
        _("rotor kg m²"): "rotor_inertia",
    }
    table = fine_table(_("motor"), _("maker"), *columns, left=(0, 1))
    for motor in catalogue().values():
        figures = (getattr(motor, column) for column in columns.values())
        table.add_row(motor.name, motor.maker, *("-" if f is None else f"{f:g}" for f in figures))
    console.print(table)


def analyse(
    name: NAME,
    mode: MODE = "-+",
    assembly: ASSEMBLY = 1,
    at: AT = None,
    picture: PICTURE = None,
) -> None:
    """Workspace, singularities and isotropic poses; with --at, everything at one place."""
    from kinlab.fivebar import FiveBar
    from kinlab.fivebar.arguments import MODES, read_signs
    from kinlab.plots import mechanisms
    from kinlab.plots.canvas import save

    fivebar, signs = FiveBar.load(name), read_signs(mode)
    console = screen(highlight=False)
    about = f": {fivebar.source}" if fivebar.source.strip() else ""
    console.print(styled((fivebar.name, "bold"), about))
    told = _("l1 {l1} m, l2 {l2} m, e {e} m; reachable area {area} m²")
    numbers = {"e": f"{fivebar.e:.6g}", "area": f"{fivebar.reachable_area():.6g}"}
    console.print(told.format(l1=pair(fivebar.l1), l2=pair(fivebar.l2), **numbers))
    heads = _("mode"), _("area w1 x w2 > 0, m²"), _("area w1 x w2 < 0, m²"), _("isotropic")
    table = fine_table(*heads, left=(0,))
    poses = {each: fivebar.isotropic_poses(each) for each in MODES}
    for each in MODES:
        areas = (f"{area:.4g}" for area in fivebar.workspace_map(each).area)
        table.add_row(signs_of(each), *areas, str(len(poses[each])))
    console.print(table)
    for pose in poses[signs]:
        place = f"({fixed(pose.xy[0])}, {fixed(pose.xy[1])}) m"
        told = _("isotropic in mode {mode}: {place}")
        if max(pose.pressure) < TOLERANCES.pressure_angle:
            told = _("isotropic in mode {mode}: {place}, fully (pressure angles 0)")
        console.print(told.format(mode=signs_of(signs), place=place))
    circle = fivebar.largest_circle(signs, assembly)
    box = fivebar.largest_rectangle(signs, assembly)
    told = _("free of singularities in mode {mode}, assembly {assembly}:")
    console.print(told.format(mode=signs_of(signs), assembly=f"{assembly:+d}"))
    told = _("largest circle: radius {radius} m about ({x}, {y}) m")
    x, y = map(fixed, circle.centre)
    console.print("  " + told.format(radius=f"{circle.radius:.6g}", x=x, y=y))
    told = _("largest rectangle: x {x0} to {x1}, y {y0} to {y1} m ({area} m²)")
    sides = {"x0": box.x_min, "x1": box.x_max, "y0": box.y_min, "y1": box.y_max, "area": box.area}
    console.print("  " + told.format(**{side: f"{value:.6g}" for side, value in sides.items()}))
    if at is not None:
        _print_place(fivebar, at, signs)
    if picture is not None:
        save(mechanisms.fivebar(fivebar, signs, assembly), picture)
        wrote(picture)


def _print_place(fivebar: FiveBar, at: tuple[float, float], mode: tuple[int, int]) -> None:
    import numpy as np

    console = screen(highlight=False)
    away = fivebar.singularity_distances(at, mode)
    (kind,) = fivebar.classify(at, mode)
    told = _("at ({x}, {y}) m, mode {mode}: {kind}")
    shown = {"x": f"{at[0]:g}", "y": f"{at[1]:g}", "mode": signs_of(mode), "kind": kind}
    console.print(told.format(**shown))

    def degrees(radians: object) -> str:
        return ", ".join(f"{x:.4g}°" for x in np.atleast_1d(np.degrees(np.asarray(radians))))

    for told, angles in (
        (_("crank angles {angles}"), fivebar.ik(at, mode)),
        (_("passive angles {angles}"), fivebar.passive_angles(at, mode)),
        (_("pressure angles {angles}"), fivebar.pressure_angles(at, mode)),
        (_("transmission angle {angles}"), fivebar.transmission_angle(at, mode)),
    ):
        console.print("  " + told.format(angles=degrees(angles)))
    told = _("to type I: outer {outer}, inner {inner} m; to type II {two} m (w1 x w2 = {rods})")
    gaps = {"outer": pair(away.outer), "inner": pair(away.inner)}
    numbers = {"two": f"{float(away.type_two):.4g}", "rods": f"{float(away.rods):.4g}"}
    console.print("  " + told.format(**gaps, **numbers))
    if kind == "regular":
        number = f"{float(fivebar.condition_number(at, mode)):.6g}"
        console.print("  " + _("condition number {number}").format(number=number))


def export(
    name: NAME,
    output: Annotated[Path, typer.Option("--output", "-o", help="A .xml (MJCF) or .urdf file.")],
    at: AT = None,
    mode: MODE = "-+",
    assembly: ASSEMBLY = 1,
) -> None:
    """Write MJCF with the loop, or URDF with a loop sidecar; joint zero is the pose --at."""
    from kinlab.fivebar import FiveBar
    from kinlab.fivebar.arguments import read_signs

    fivebar, signs = FiveBar.load(name), read_signs(mode)
    place = at or fivebar.largest_circle(signs, assembly).centre
    for file in fivebar.export(output, place, signs):
        wrote(file)
