"""Commands about five-bars: list, analyse, size, export."""

from __future__ import annotations

from pathlib import Path
from typing import TYPE_CHECKING, Annotated

import typer

from kinlab.cli.screen import Screen, screen, styled
from kinlab.errors import OptionError, already_said
from kinlab.tolerances import TOLERANCES

if TYPE_CHECKING:
    from rich.table import Table

    from kinlab.fivebar import FiveBar
    from kinlab.fivebar.servo import ServoSizing

NAME = Annotated[str, typer.Argument(help="A name from `kinlab fivebar list`, or a .toml file.")]
MODE = Annotated[str, typer.Option(help="Working mode: signs of u1 x w1 and u2 x w2, as in -+.")]
ASSEMBLY = Annotated[int, typer.Option(help="Assembly mode: sign of w1 x w2, 1 or -1.")]
PICTURE = Annotated[Path | None, typer.Option(help="Write pictures: a .png, .svg or .pdf file.")]
AT = Annotated[
    tuple[float, float] | None, typer.Option(help="A place of the tool, m.", metavar="X Y")
]
BOX = Annotated[
    tuple[float, float, float, float] | None,
    typer.Option(help="Workspace, m.", metavar="X0 X1 Y0 Y1"),
]

_CONDITION = 3.0
"""Bound on the condition number of the workspace that `size` takes where none is given."""


def register(app: typer.Typer) -> None:
    """Adds the commands of this file under ``kinlab fivebar``."""
    group = typer.Typer(
        help="Five-bar linkages: analyse, size the servos, export.",
        no_args_is_help=True,
        context_settings={"help_option_names": ["-h", "--help"]},
    )
    group.command("list")(list_fivebars)
    group.command("analyse")(analyse)
    group.command("size")(size)
    group.command("export")(export)
    app.add_typer(group, name="fivebar")


def list_fivebars() -> None:
    """List the shipped five-bars and servomotors."""
    from kinlab.drives.motors import catalogue
    from kinlab.fivebar import FiveBar
    from kinlab.fivebar.files import presets

    console = screen(highlight=False)
    table = _table("five-bar", "l1, m", "l2, m", "e, m", "payload, kg", left=(0,))
    for name in presets():
        one = FiveBar.load(name)
        table.add_row(name, _pair(one.l1), _pair(one.l2), f"{one.e:.4g}", f"{one.payload:g}")
    console.print(table)
    columns = {
        "rated W": "rated_power",
        "rated N m": "rated_torque",
        "peak N m": "peak_torque",
        "max r/min": "max_speed",
        "rotor kg m²": "rotor_inertia",
    }
    table = _table("motor", "maker", *columns, left=(0, 1))
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
    from kinlab.fivebar.arguments import MODES
    from kinlab.plots import mechanisms
    from kinlab.plots.canvas import save

    fivebar, signs = FiveBar.load(name), read_signs(mode)
    console = screen(highlight=False)
    about = f": {fivebar.source}" if fivebar.source.strip() else ""
    console.print(styled((fivebar.name, "bold"), about))
    console.print(
        f"l1 {_pair(fivebar.l1)} m, l2 {_pair(fivebar.l2)} m, e {fivebar.e:.6g} m; "
        f"reachable area {fivebar.reachable_area():.6g} m²"
    )
    table = _table("mode", "area w1 x w2 > 0, m²", "area w1 x w2 < 0, m²", "isotropic", left=(0,))
    poses = {each: fivebar.isotropic_poses(each) for each in MODES}
    for each in MODES:
        areas = (f"{area:.4g}" for area in fivebar.workspace_map(each).area)
        table.add_row(_signs(each), *areas, str(len(poses[each])))
    console.print(table)
    for pose in poses[signs]:
        place = f"({_fixed(pose.xy[0])}, {_fixed(pose.xy[1])}) m"
        full = (
            ", fully (pressure angles 0)" if max(pose.pressure) < TOLERANCES.pressure_angle else ""
        )
        console.print(f"isotropic in mode {_signs(signs)}: {place}{full}")
    circle = fivebar.largest_circle(signs, assembly)
    box = fivebar.largest_rectangle(signs, assembly)
    console.print(f"free of singularities in mode {_signs(signs)}, assembly {assembly:+d}:")
    console.print(
        f"  largest circle: radius {circle.radius:.6g} m about "
        f"({_fixed(circle.centre[0])}, {_fixed(circle.centre[1])}) m"
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
    console.print(f"at ({at[0]:g}, {at[1]:g}) m, mode {_signs(mode)}: {kind}")

    def degrees(radians: object) -> str:
        return ", ".join(f"{x:.4g}°" for x in np.atleast_1d(np.degrees(np.asarray(radians))))

    console.print(f"  crank angles {degrees(fivebar.ik(at, mode))}")
    console.print(f"  passive angles {degrees(fivebar.passive_angles(at, mode))}")
    console.print(f"  pressure angles {degrees(fivebar.pressure_angles(at, mode))}")
    console.print(f"  transmission angle {degrees(fivebar.transmission_angle(at, mode))}")
    console.print(
        f"  to type I: outer {_pair(away.outer)}, inner {_pair(away.inner)} m; "
        f"to type II {float(away.type_two):.4g} m (w1 x w2 = {float(away.rods):.4g})"
    )
    if kind == "regular":
        console.print(f"  condition number {float(fivebar.condition_number(at, mode)):.6g}")


def size(
    name: NAME,
    v_max: Annotated[float, typer.Option(help="Largest speed of the tool, m/s.")],
    a_max: Annotated[float, typer.Option(help="Largest acceleration of the tool, m/s².")],
    workspace: BOX = None,
    motor: Annotated[str | None, typer.Option(help="One motor; none tries all.")] = None,
    gear_ratio: Annotated[float | None, typer.Option(help="Motor turns per crank turn.")] = None,
    mode: MODE = "-+",
    efficiency: Annotated[float, typer.Option(help="Of the gear, 0 to 1.")] = 0.9,
    picture: PICTURE = None,
) -> None:
    """Size the servos for a workspace, a speed and an acceleration in any direction."""
    from kinlab.fivebar import FiveBar
    from kinlab.plots import mechanisms
    from kinlab.plots.canvas import save

    fivebar, signs = FiveBar.load(name), read_signs(mode)
    console = screen(highlight=False)
    box = workspace or fivebar.largest_rectangle(signs, max_condition=_CONDITION)
    if workspace is None:
        console.print(f"workspace: the largest rectangle of condition number up to {_CONDITION:g}")
    with already_said():  # it is printed with the figures
        sizing = fivebar.size_servo(box, v_max, a_max, motor, gear_ratio, signs, efficiency)
    _print_sizing(sizing, console)
    if picture is not None:
        gains = picture.with_name(f"{picture.stem}-gain{picture.suffix}")
        save(mechanisms.fivebar_cycle(fivebar, sizing), picture)
        save(mechanisms.fivebar_gains(fivebar, sizing), gains)
        console.print(f"wrote {picture} and {gains}")


def _print_sizing(sizing: ServoSizing, console: object) -> None:

    assert isinstance(console, Screen)
    box, cycle = sizing.workspace, sizing.cycle
    console.print(
        f"workspace x {box.x_min:.4g} to {box.x_max:.4g}, y {box.y_min:.4g} to {box.y_max:.4g} m; "
        f"v {sizing.v_max:g} m/s, a {sizing.a_max:g} m/s²"
    )
    for remark in sizing.remarks:
        console.print(remark, style="bold yellow", soft_wrap=True)
    table = _table("worst over the workspace", "crank 1", "crank 2", left=(0,))
    rows = {
        "crank rate, rad/s": sizing.rate,
        "load inertia, note's form, kg m²": sizing.load_inertia_note,
        "load inertia, full, kg m²": sizing.load_inertia,
        "torque, note's form, N m": sizing.torque_note,
        "torque, full, N m": sizing.torque,
    }
    for label, worst in rows.items():
        table.add_row(label, *(f"{v:.4g}" for v in worst.value))
    console.print(table)
    share = 100.0 * (1.0 - sizing.torque_note.largest / sizing.torque.largest)
    console.print(f"the note's torque leaves out rods, f(v), gravity and rotor: {share:.0f} % low")
    best = " and ".join(f"{x**0.5:.4g}" for x in dict.fromkeys(sizing.eta.tolist()))
    console.print(
        f"eta = m/I_A: torque per acceleration is least at sigma = sqrt(eta) = {best} rad/m; "
        f"sigma in the workspace is {sizing.sigma[0]:.4g} to {sizing.sigma[1]:.4g}"
    )
    console.print(
        f"pick-and-place cycle of {sizing.path.duration:.4g} s: peak {_pair(cycle.peak_torque)}, "
        f"RMS {_pair(cycle.rms_torque)} N m, peak power {_pair(cycle.peak_power)} W"
    )
    console.print(_fits(sizing))
    console.print("inertia: I_L / (j² I_M), which the note wants between 1 and 3")


def _fits(sizing: ServoSizing) -> Table:
    columns = ["motor", "gear", "peak N m", "RMS N m", "r/min", "inertia", "margin", "limited by"]
    table = _table(*columns, left=(0, 7))
    for fit in sizing.fits:
        figures = (fit.gear_ratio, fit.peak, fit.rms)
        margin = f"{fit.margin:.3g}"
        table.add_row(
            fit.motor.name,
            *(f"{figure:.3g}" for figure in figures),
            f"{fit.speed:.0f}",
            f"{fit.inertia_ratio:.3g}",
            styled((margin, "" if fit.fits else "red")),
            " and ".join(fit.limits),
        )
    return table


def export(
    name: NAME,
    output: Annotated[Path, typer.Option("--output", "-o", help="A .xml (MJCF) or .urdf file.")],
    at: AT = None,
    mode: MODE = "-+",
    assembly: ASSEMBLY = 1,
) -> None:
    """Write MJCF with the loop, or URDF with a loop sidecar; joint zero is the pose --at."""
    from kinlab.fivebar import FiveBar

    fivebar, signs = FiveBar.load(name), read_signs(mode)
    place = at or fivebar.largest_circle(signs, assembly).centre
    for file in fivebar.export(output, place, signs):
        typer.echo(f"wrote {file}")


def read_signs(mode: str) -> tuple[int, int]:
    """Reads ``-+`` and the like.

    Raises:
        OptionError: anything but two signs.
    """
    if len(mode) != 2 or set(mode) - {"+", "-"}:
        raise OptionError(f"mode {mode!r} does not exist; choose one of ++, +-, -+, --")
    first, second = (1 if sign == "+" else -1 for sign in mode)
    return first, second


def _signs(mode: tuple[int, int]) -> str:
    return "".join("+" if s > 0 else "-" for s in mode)


def _pair(values: object) -> str:
    import numpy as np

    first, second = np.asarray(values, dtype=float)
    texts = dict.fromkeys((f"{first:.4g}", f"{second:.4g}"))
    return "/".join(texts)


def _fixed(metres: float) -> str:
    """To a micrometre, without a minus before zero."""
    return f"{round(metres, 6) + 0.0:.6f}"


def _table(*columns: str, left: tuple[int, ...]) -> Table:
    from rich.box import SIMPLE_HEAD
    from rich.table import Table

    table = Table(box=SIMPLE_HEAD, pad_edge=False)
    for k, column in enumerate(columns):
        table.add_column(column, justify="left" if k in left else "right", no_wrap=k in left)
    return table
