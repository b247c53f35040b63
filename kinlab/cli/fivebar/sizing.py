"""The command fivebar size: servos for a workspace, or for a cycle."""

from __future__ import annotations

from pathlib import Path
from typing import TYPE_CHECKING, Annotated

import typer

from kinlab.cli.screen import Screen, fine_table, screen, styled
from kinlab.errors import OptionError, already_said

if TYPE_CHECKING:
    from kinlab.drives.fitting import MotorFit
    from kinlab.drives.gears import Gearbox
    from kinlab.drives.motors import Motor
    from kinlab.drives.waypoints import Cycle
    from kinlab.fivebar import FiveBar
    from kinlab.fivebar.cycle import CycleSizing
    from kinlab.fivebar.servo import ServoSizing
    from kinlab.fivebar.workspace import Rectangle

from kinlab.cli.fivebar.words import BOX, MODE, NAME, PICTURE, pair

_CONDITION = 3.0
"""Bound on the condition number of the workspace that `size` takes where none is given."""


def size(
    name: NAME,
    v_max: Annotated[float | None, typer.Option(help="Largest speed of the tool, m/s.")] = None,
    a_max: Annotated[
        float | None, typer.Option(help="Largest acceleration of the tool, m/s².")
    ] = None,
    workspace: BOX = None,
    motor: Annotated[str | None, typer.Option(help="One motor; none tries all.")] = None,
    gear_ratio: Annotated[float | None, typer.Option(help="Motor turns per crank turn.")] = None,
    mode: MODE = "-+",
    efficiency: Annotated[float, typer.Option(help="Of the gear, 0 to 1.")] = 0.9,
    motors: Annotated[
        Path | None, typer.Option(help="Motors of your own: a .toml or .csv file.")
    ] = None,
    gears: Annotated[
        Path | None, typer.Option(help="Gearboxes of your own: a .toml or .csv file.")
    ] = None,
    gear: Annotated[str | None, typer.Option(help="One gearbox of --gears.")] = None,
    cycle: Annotated[
        str | None,
        typer.Option(help="A cycle: adept (25/305/25 mm), or a .toml or .csv file of way points."),
    ] = None,
    time: Annotated[
        float | None, typer.Option(help="Time of the cycle, s; with --motor and no time: found.")
    ] = None,
    crank_mass: Annotated[
        float | None, typer.Option(help="Of each crank, a uniform bar, kg.")
    ] = None,
    rod_mass: Annotated[float | None, typer.Option(help="Of each rod, a uniform bar, kg.")] = None,
    payload: Annotated[float | None, typer.Option(help="Point mass at the tool, kg.")] = None,
    massless: Annotated[
        bool, typer.Option("--massless", help="Bars without mass are meant.")
    ] = False,
    picture: PICTURE = None,
) -> None:
    """Size the servos for a workspace, a speed and an acceleration; or for a cycle (--cycle)."""
    from kinlab.fivebar import FiveBar
    from kinlab.fivebar.arguments import read_signs
    from kinlab.plots import mechanisms
    from kinlab.plots.canvas import save

    fivebar, signs = FiveBar.load(name), read_signs(mode)
    fivebar = fivebar.with_masses(crank_mass, rod_mass, payload)
    if cycle is None and (v_max is None or a_max is None):
        raise OptionError("give --v-max and --a-max, or a --cycle that states them")
    console = screen(highlight=False)
    pairs = _pairs(gears, gear)
    if cycle is not None and workspace is None:
        among, way = _motors(motors, motor), _read_cycle(cycle, fivebar, signs, v_max, a_max)
        drive = gear_ratio if pairs is None else pairs[0] if len(pairs) == 1 else None
        fastest = motor is not None and drive is not None and time is None
        if fastest and drive is not None:
            done = fivebar.fastest_cycle(
                way, among[0], drive, mode=signs, efficiency=efficiency, massless=massless
            )
        else:
            done = fivebar.size_cycle(
                way,
                time,
                motors=among,
                gears=pairs,
                gear_ratio=gear_ratio,
                mode=signs,
                efficiency=efficiency,
                massless=massless,
            )
        _print_cycle(done, console, fastest=fastest)
        if picture is not None:
            save(mechanisms.fivebar_cycle(fivebar, done), picture)
            console.print(f"wrote {picture}")
        return
    box = workspace or fivebar.largest_rectangle(signs, max_condition=_CONDITION)
    if workspace is None:
        console.print(f"workspace: the largest rectangle of condition number up to {_CONDITION:g}")
    round_trip = None if cycle is None else _read_cycle(cycle, fivebar, signs, v_max, a_max, box)
    with already_said():  # it is printed with the figures
        sizing = fivebar.size_servo(
            box,
            v_max or (round_trip.v_max if round_trip else 0.0),
            a_max or (round_trip.a_max if round_trip else 0.0),
            motor,
            gear_ratio,
            signs,
            efficiency,
            motors=motors,
            gears=pairs,
            cycle=round_trip,
            massless=massless,
        )
    _print_sizing(sizing, console)
    if picture is not None:
        gains = picture.with_name(f"{picture.stem}-gain{picture.suffix}")
        save(mechanisms.fivebar_cycle(fivebar, sizing), picture)
        save(mechanisms.fivebar_gains(fivebar, sizing), gains)
        console.print(f"wrote {picture} and {gains}")


def _pairs(gears: Path | None, gear: str | None) -> list[Gearbox] | None:
    from kinlab.drives.gears import find_gear, gears_of

    if gears is None and gear is None:
        return None
    among = [] if gears is None else gears_of(gears)
    return among if gear is None else [find_gear(gear, among)]


def _motors(motors: Path | None, motor: str | None) -> list[Motor]:
    from kinlab.drives.motors import find_motor, motors_of

    among = motors_of(motors)
    return among if motor is None else [find_motor(motor, {one.name: one for one in among})]


def _read_cycle(
    cycle: str,
    fivebar: FiveBar,
    mode: tuple[int, int],
    v_max: float | None,
    a_max: float | None,
    box: Rectangle | tuple[float, float, float, float] | None = None,
) -> Cycle:
    from kinlab.drives.waypoints import read_cycle
    from kinlab.errors import NameUnknownError
    from kinlab.fivebar.servo import adept_in
    from kinlab.fivebar.workspace import read_rectangle

    if cycle == "adept":
        if v_max is None or a_max is None:
            raise OptionError("the cycle adept states no limits: give --v-max and --a-max")
        if box is None:
            box = fivebar.largest_rectangle(mode, max_condition=_CONDITION)
        return adept_in(read_rectangle(box, fivebar.name), v_max, a_max)
    if Path(cycle).suffix.lower() not in (".toml", ".csv"):
        raise NameUnknownError(f"no cycle {cycle!r}; give 'adept', or a .toml or .csv file")
    return read_cycle(cycle, v_max, a_max)


def _print_cycle(found: CycleSizing, console: Screen, *, fastest: bool) -> None:
    demand = found.demand
    stretch = "" if found.slower == 1.0 else f", {found.slower:.4g} times slower than its limits"
    head = "the fastest cycle of this drive: " if fastest else ""
    console.print(f"{head}cycle {found.cycle.name}: {found.time:.4g} s{stretch}")
    console.print(
        f"cranks: peak {pair(demand.peak_torque)} N m, RMS {pair(demand.rms_torque)} N m, "
        f"rate {pair(demand.peak_rate)} rad/s, power {pair(demand.peak_power)} W; "
        f"load inertia {found.load_inertia:.4g} kg m²"
    )
    _print_fits(found.fits, console)


def _print_sizing(sizing: ServoSizing, console: object) -> None:

    assert isinstance(console, Screen)
    box, cycle = sizing.workspace, sizing.cycle
    console.print(
        f"workspace x {box.x_min:.4g} to {box.x_max:.4g}, y {box.y_min:.4g} to {box.y_max:.4g} m; "
        f"v {sizing.v_max:g} m/s, a {sizing.a_max:g} m/s²"
    )
    for remark in sizing.remarks:
        console.print(remark, style="bold yellow", soft_wrap=True)
    table = fine_table("worst over the workspace", "crank 1", "crank 2", left=(0,))
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
        f"pick-and-place cycle of {sizing.path.duration:.4g} s: peak {pair(cycle.peak_torque)}, "
        f"RMS {pair(cycle.rms_torque)} N m, peak power {pair(cycle.peak_power)} W"
    )
    _print_fits(sizing.fits, console)


_SHOWN = 24
"""Pairs of a table that are shown: all that fit, and the nearest of the others up to this."""


def _print_fits(fits: tuple[MotorFit, ...], console: Screen) -> None:
    columns = ["motor", "gear", "peak N m", "RMS N m", "r/min", "inertia", "margin"]
    table = fine_table(*columns, "limited by, or fails", left=(0, 1, 7))
    good = sum(fit.fits for fit in fits)
    for fit in fits[: max(_SHOWN, good)]:
        torques, ratio = (f"{fit.peak:.3g}", f"{fit.rms:.3g}"), f"{fit.inertia_ratio:.3g}"
        named = fit.gear.nominal_torque is not None or fit.gear.max_speed is not None
        more = f", and {len(fit.failed) - 1} more" if len(fit.failed) > 1 else ""
        failed = f"{fit.failed[0]}{more}" if fit.failed else ""
        table.add_row(
            fit.motor.name,
            fit.gear.name if named else f"{fit.gear_ratio:.3g}",
            *torques,
            f"{fit.speed:.0f}",
            ratio,
            styled((f"{fit.margin:.3g}", "" if fit.fits else "red")),
            " and ".join(fit.limits) if fit.fits else styled((f"fails: {failed}", "red")),
        )
    console.print(table)
    if len(fits) > max(_SHOWN, good):
        console.print(f"{len(fits) - max(_SHOWN, good)} more fail by more")
    unstated = {what for fit in fits for what in fit.unstated if fit.gear.inertia}
    if unstated:
        console.print(f"not judged, for a gearbox does not state it: {', '.join(sorted(unstated))}")
    console.print("inertia: I_L / (j² I_M), which the note wants between 1 and 3")
