"""The command fivebar size: servos for a workspace, or for a cycle."""

from __future__ import annotations

from pathlib import Path
from typing import TYPE_CHECKING, Annotated

import typer

from kinlab.cli.screen import Screen, fine_table, screen, styled, wrote
from kinlab.errors import OptionError, already_said
from kinlab.host.language import _

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
            wrote(picture)
        return
    box = workspace or fivebar.largest_rectangle(signs, max_condition=_CONDITION)
    if workspace is None:
        told = _("workspace: the largest rectangle of condition number up to {number}")
        console.print(told.format(number=f"{_CONDITION:g}"))
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
        told = _("wrote {file} and {other}").format(file=picture, other=gains)
        console.print(told)


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
    told = _("cycle {name}: {time} s").format(name=found.cycle.name, time=f"{found.time:.4g}")
    if fastest:
        told = _("the fastest cycle of this drive: {cycle}").format(cycle=told)
    if found.slower != 1.0:
        slower = _("{cycle}, {times} times slower than its limits")
        told = slower.format(cycle=told, times=f"{found.slower:.4g}")
    console.print(told)
    told = _(
        "cranks: peak {peak} N m, RMS {rms} N m, rate {rate} rad/s, power {power} W; load inertia "
        "{inertia} kg m²"
    )
    console.print(
        told.format(
            peak=pair(demand.peak_torque),
            rms=pair(demand.rms_torque),
            rate=pair(demand.peak_rate),
            power=pair(demand.peak_power),
            inertia=f"{found.load_inertia:.4g}",
        )
    )
    _print_fits(found.fits, console)


def _print_sizing(sizing: ServoSizing, console: object) -> None:

    assert isinstance(console, Screen)
    box, cycle = sizing.workspace, sizing.cycle
    told = _("workspace x {x0} to {x1}, y {y0} to {y1} m; v {v} m/s, a {a} m/s²")
    sides = {"x0": box.x_min, "x1": box.x_max, "y0": box.y_min, "y1": box.y_max}
    limits = {"v": f"{sizing.v_max:g}", "a": f"{sizing.a_max:g}"}
    console.print(told.format(**{side: f"{at:.4g}" for side, at in sides.items()}, **limits))
    for remark in sizing.remarks:
        console.print(remark, style="bold yellow", soft_wrap=True)
    table = fine_table(
        _("worst over the workspace"),
        *(_("crank {number}").format(number=k) for k in (1, 2)),
        left=(0,),
    )
    rows = {
        _("crank rate, rad/s"): sizing.rate,
        _("load inertia, note's form, kg m²"): sizing.load_inertia_note,
        _("load inertia, full, kg m²"): sizing.load_inertia,
        _("torque, note's form, N m"): sizing.torque_note,
        _("torque, full, N m"): sizing.torque,
    }
    for label, worst in rows.items():
        table.add_row(label, *(f"{v:.4g}" for v in worst.value))
    console.print(table)
    share = 100.0 * (1.0 - sizing.torque_note.largest / sizing.torque.largest)
    told = _("the note's torque leaves out rods, f(v), gravity and rotor: {share} % low")
    console.print(told.format(share=f"{share:.0f}"))
    best = _(" and ").join(f"{x**0.5:.4g}" for x in dict.fromkeys(sizing.eta.tolist()))
    told = _(
        "eta = m/I_A: torque per acceleration is least at sigma = sqrt(eta) = {best} rad/m; sigma "
        "in the workspace is {low} to {high}"
    )
    low, high = (f"{one:.4g}" for one in sizing.sigma)
    console.print(told.format(best=best, low=low, high=high))
    told = _("pick-and-place cycle of {time} s: peak {peak}, RMS {rms} N m, peak power {power} W")
    console.print(
        told.format(
            time=f"{sizing.path.duration:.4g}",
            peak=pair(cycle.peak_torque),
            rms=pair(cycle.rms_torque),
            power=pair(cycle.peak_power),
        )
    )
    _print_fits(sizing.fits, console)


_SHOWN = 24
"""Pairs of a table that are shown: all that fit, and the nearest of the others up to this."""


def _print_fits(fits: tuple[MotorFit, ...], console: Screen) -> None:
    columns = [_("motor"), _("gear"), _("peak N m"), _("RMS N m"), _("r/min"), _("inertia")]
    table = fine_table(*columns, _("margin"), _("limited by, or fails"), left=(0, 1, 7))
    good = sum(fit.fits for fit in fits)
    for fit in fits[: max(_SHOWN, good)]:
        torques, ratio = (f"{fit.peak:.3g}", f"{fit.rms:.3g}"), f"{fit.inertia_ratio:.3g}"
        named = fit.gear.nominal_torque is not None or fit.gear.max_speed is not None
        failed = fit.failed[0] if fit.failed else ""
        if len(fit.failed) > 1:
            failed = _("{first}, and {count} more").format(first=failed, count=len(fit.failed) - 1)
        fails = _("fails: {what}").format(what=failed)
        table.add_row(
            fit.motor.name,
            fit.gear.name if named else f"{fit.gear_ratio:.3g}",
            *torques,
            f"{fit.speed:.0f}",
            ratio,
            styled((f"{fit.margin:.3g}", "" if fit.fits else "red")),
            _(" and ").join(fit.limits) if fit.fits else styled((fails, "red")),
        )
    console.print(table)
    if len(fits) > max(_SHOWN, good):
        told = _("{count} more fail by more")
        console.print(told.format(count=len(fits) - max(_SHOWN, good)))
    unstated = {what for fit in fits for what in fit.unstated if fit.gear.inertia}
    if unstated:
        told = _("not judged, for a gearbox does not state it: {names}")
        console.print(told.format(names=_(", ").join(sorted(unstated))))
    console.print(_("inertia: I_L / (j² I_M), which the note wants between 1 and 3"))
