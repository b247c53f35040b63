"""Commands about one five-bar: list, analyse, export."""

from __future__ import annotations

from pathlib import Path
from typing import TYPE_CHECKING, Annotated

import typer

from kinlab.cli.screen import fine_table, screen, styled
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
    table = fine_table("five-bar", "l1, m", "l2, m", "e, m", "payload, kg", left=(0,))
    for name in presets():
        one = FiveBar.load(name)
        table.add_row(name, pair(one.l1), pair(one.l2), f"{one.e:.4g}", f"{one.payload:g}")
    console.print(table)
    columns = {
        "rated W": "rated_power",
        "rated N m": "rated_torque",
        "peak N m": "peak_torque",
        "max r/min": "max_speed",
        "rotor kg m²": "rotor_inertia",
    }
    table = fine_table("motor", "maker", *columns, left=(0, 1))
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
    console.print(
        f"l1 {pair(fivebar.l1)} m, l2 {pair(fivebar.l2)} m, e {fivebar.e:.6g} m; "
        f"reachable area {fivebar.reachable_area():.6g} m²"
    )
    table = fine_table(
        "mode", "area w1 x w2 > 0, m²", "area w1 x w2 < 0, m²", "isotropic", left=(0,)
    )
    poses = {each: fivebar.isotropic_poses(each) for each in MODES}
    for each in MODES:
        areas = (f"{area:.4g}" for area in fivebar.workspace_map(each).area)
        table.add_row(signs_of(each), *areas, str(len(poses[each])))
    console.print(table)
    for pose in poses[signs]:
        place = f"({fixed(pose.xy[0])}, {fixed(pose.xy[1])}) m"
        full = (
            ", fully (pressure angles 0)" if max(pose.pressure) < TOLERANCES.pressure_angle else ""
        )
        console.print(f"isotropic in mode {signs_of(signs)}: {place}{full}")
    circle = fivebar.largest_circle(signs, assembly)
    box = fivebar.largest_rectangle(signs, assembly)
    console.print(f"free of singularities in mode {signs_of(signs)}, assembly {assembly:+d}:")
    console.print(
        f"  largest circle: radius {circle.radius:.6g} m about "
        f"({fixed(circle.centre[0])}, {fixed(circle.centre[1])}) m"
    )
    console.print(
        f"  largest rectangle: x {box.x_min:.6g} to {box.x_max:.6g}, "
        f"y {box.y_min:.6g} to {box.y_max:.6g} m ({box.area:.6g} m²)"
    )
    if at is not None:
        _print_place(fivebar, at, signs)
    if picture is not None:
        save(mechanisms.fivebar(fivebar, signs, assembly), picture)
        console.print(f"wrote {picture}")


def _print_place(fivebar: FiveBar, at: tuple[float, float], mode: tuple[int, int]) -> None:
    import numpy as np

    console = screen(highlight=False)
    away = fivebar.singularity_distances(at, mode)
    (kind,) = fivebar.classify(at, mode)
    console.print(f"at ({at[0]:g}, {at[1]:g}) m, mode {signs_of(mode)}: {kind}")

    def degrees(radians: object) -> str:
        return ", ".join(f"{x:.4g}°" for x in np.atleast_1d(np.degrees(np.asarray(radians))))

    console.print(f"  crank angles {degrees(fivebar.ik(at, mode))}")
    console.print(f"  passive angles {degrees(fivebar.passive_angles(at, mode))}")
    console.print(f"  pressure angles {degrees(fivebar.pressure_angles(at, mode))}")
    console.print(f"  transmission angle {degrees(fivebar.transmission_angle(at, mode))}")
    console.print(
        f"  to type I: outer {pair(away.outer)}, inner {pair(away.inner)} m; "
        f"to type II {float(away.type_two):.4g} m (w1 x w2 = {float(away.rods):.4g})"
    )
    if kind == "regular":
        console.print(f"  condition number {float(fivebar.condition_number(at, mode)):.6g}")


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
        typer.echo(f"wrote {file}")
