"""Servo sizing of a five-bar: the worst case over a workspace, and the motors that meet it.

Source: note 003 (003.speed, 003.IM, 003.Tmax, 003.G); Huang et al. 2005, doi 10.1115/1.1898343.
The note's T_max keeps |G_1| a_max of massless rods alone; the full one adds f(v), gravity, the
rods, the rotor and the gear's efficiency.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, replace
from pathlib import Path as File
from typing import TYPE_CHECKING, Any

import numpy as np
from numpy.typing import ArrayLike

from kinlab.arrays import Array, number
from kinlab.drives.cycles import LIFT, TRAVEL, Path
from kinlab.drives.demand import Demand
from kinlab.drives.fitting import Duty, MotorFit, fit_all, refuse_both
from kinlab.drives.gears import Drive, Gearbox, gears_of
from kinlab.drives.motors import Motor, find_motor, motors_of
from kinlab.drives.waypoints import Cycle, adept
from kinlab.errors import OptionError
from kinlab.fivebar.arguments import HANGING, Mode
from kinlab.fivebar.bounds.worst import (
    MotionForms,
    Worst,
    acceleration_forms,
    bound_over,
    grid_of,
    require_regular,
    row_norms,
    torque_forms,
    worst,
)
from kinlab.fivebar.cycle import follow, require_masses
from kinlab.fivebar.dynamics import (
    crank_inertia,
    joint_mass,
    rod_model,
)
from kinlab.fivebar.geometry import Pose, solve_pose
from kinlab.fivebar.metrics import sigma
from kinlab.fivebar.workspace import Rectangle, read_rectangle
from kinlab.host.evidence import Evidence
from kinlab.host.introductions import Introduction, Rows, shown_cells, vector
from kinlab.tolerances import TOLERANCES

if TYPE_CHECKING:
    from kinlab.fivebar.linkage import FiveBar


@dataclass(frozen=True, repr=False)
class ServoSizing(Rows):
    """What a workspace, a speed and an acceleration ask of the drives.

    Attributes:
        workspace: the rectangle, m.
        v_max: m/s. a_max: m/s².
        mode: working mode.
        efficiency: of the gears.
        rate: worst crank rate |J_i| v_max, rad/s (003.speed).
        load_inertia_note: worst diagonal of I_A + m J^-T J^-1, rods and rotor left out, kg m².
        load_inertia: worst diagonal of the mass matrix without rotor, kg m².
        torque_note: worst |G_i| a_max with G = I_A J + m J^-T, N m (003.Tmax).
        torque: worst torque at the cranks: rods, f(v), gravity, and the linkage's own rotor, N m.
        eta: m / I_A of each crank, 1/m² (003.G); infinite where I_A is zero.
        sigma: least and largest singular value of J in the workspace, rad/m. |G| is least where
            sigma is sqrt(eta): there each crank works half for itself and half for the payload.
        path: the pick-and-place cycle that the RMS figures are taken over.
        cycle: what the cranks do along it.
        fits: the motors that fit first, the one of least peak torque first; then the others,
            the nearest to fitting first.
        remarks: what the figures leave out, a sentence each: bars without mass.
    """

    workspace: Rectangle
    v_max: float
    a_max: float
    mode: tuple[int, int]
    efficiency: float
    rate: Worst
    load_inertia_note: Worst
    load_inertia: Worst
    torque_note: Worst
    torque: Worst
    eta: Array
    sigma: tuple[float, float]
    path: Path
    cycle: Demand
    fits: tuple[MotorFit, ...]
    remarks: tuple[str, ...] = ()

    def columns(self) -> dict[str, Any]:
        """Motor by motor: what it must give and what it has over that."""
        return {
            "motor": [fit.motor.name for fit in self.fits],
            "gear_ratio": [fit.gear_ratio for fit in self.fits],
            "peak_torque": [fit.peak for fit in self.fits],
            "rms_torque": [fit.rms for fit in self.fits],
            "speed": [fit.speed for fit in self.fits],
            "inertia_ratio": [fit.inertia_ratio for fit in self.fits],
            "margin": [fit.margin for fit in self.fits],
            "fits": [fit.fits for fit in self.fits],
            "limited_by": [" and ".join(fit.limits) for fit in self.fits],
        }

    def introduction(self) -> Introduction:
        """The torque, speed and power asked for, the motor that meets them, what is left out."""
        torque = f"{self.torque.largest:.4g} N m at the cranks"
        fitting = self.short_list
        if fitting:
            first = f"{fitting[0].motor.name} at a gear of {fitting[0].gear_ratio:.4g} fits"
            told = f"{torque}; {first}"
            if len(self.fits) > 1:
                told += f" ({len(fitting)} of {len(self.fits)} motors fit)"
        else:
            told = f"{torque}; NO motor of {len(self.fits)} fits"
        light = " FOR THE PAYLOAD ALONE" if self.remarks else ""
        cells, cycle = self.columns(), self.cycle
        return Introduction(
            f"servo sizing{light}: {told}",
            (
                *self.remarks,
                f"at v {self.v_max:g} m/s, a {self.a_max:g} m/s² in any direction of workspace "
                f"{vector(self.workspace)}; gear efficiency {self.efficiency:g}",
                f"crank rate {self.rate.largest:.4g} rad/s, load inertia "
                f"{self.load_inertia.largest:.4g} kg m²",
                f"pick-and-place cycle of {self.path.duration:.4g} s: RMS "
                f"{float(np.max(cycle.rms_torque)):.4g} N m, peak power "
                f"{float(np.max(cycle.peak_power)):.4g} W",
            ),
            ("motor", "gear", "peak N m", "RMS N m", "r/min", *tuple(cells)[5:8], "limited by"),
            shown_cells(cells, 4),
            len(self.fits),
            "unsure" if self.remarks else "good" if fitting else "bad",
        )

    @property
    def evidence(self) -> Evidence:
        """What is bounded over the whole workspace, and what is worked out on one cycle."""
        return Evidence(
            "the whole workspace by branch and bound; the cycle at its instants",
            proved="no pose, direction or speed within the limits asks for more than the bounds of "
            "rate, torque and load inertia",
            found=f"RMS torques of the cycle, at {len(self.cycle.t):,} instants; of a gear of any "
            "make the ratio of most margin",
        )

    @property
    def short_list(self) -> tuple[MotorFit, ...]:
        """The motors that meet every limit."""
        return tuple(fit for fit in self.fits if fit.fits)


def size_servo(
    linkage: FiveBar,
    workspace: ArrayLike,
    v_max: float,
    a_max: float,
    motor: str | Motor | None = None,
    gear_ratio: float | None = None,
    mode: Mode = HANGING,
    efficiency: float = 0.9,
    *,
    motors: str | File | Sequence[Motor] | None = None,
    gears: str | File | Gearbox | Sequence[Gearbox] | None = None,
    cycle: Cycle | None = None,
    massless: bool = False,
) -> ServoSizing:
    """Sizes the drives for a rectangle, a speed and an acceleration of the tool in any direction.

    Args:
        linkage: the five-bar.
        workspace: (x_min, x_max, y_min, y_max), m.
        v_max: m/s. a_max: m/s².
        motor: one motor, by name or as data; none tries the whole catalogue.
        gear_ratio: j; none takes for each motor the one whose least margin (of speed, peak torque
            and rated torque) is largest.
        mode: signs of u_i x w_i.
        efficiency: of the gears, 0 to 1. The load is taken to pay the losses or to be held by
            them, whichever asks more of the motor: an upper bound of the peak.
        motors: a catalogue of one's own: a .toml or .csv file, or motors; none: the shipped one.
        gears: gearboxes likewise, for pairs that can be bought; gear_ratio and efficiency are then
            the gearboxes'.
        cycle: what the RMS torques are taken over; none: the 25/305/25 mm one at the bottom of
            the workspace, shrunk in proportion where the workspace is smaller.
        massless: the bars are meant to have no mass.

    Returns:
        The demands, by their proved bounds, and the motors or pairs that meet them.

    Raises:
        OptionError: a limit that is not positive, an empty rectangle, an impossible efficiency.
        UnreachableError, SingularError: the rectangle is not free of singularities; says where.
        MotorError: the motor lacks a figure. NameUnknownError: no motor of that name.
        InertiaError: the linkage has neither masses nor a payload, or bars without mass where
            ``massless`` does not say so.

    Warns:
        KinlabWarning: cranks or rods have no mass, and are meant to.
    """
    refuse_both(gears, gear_ratio)
    box = read_rectangle(workspace, linkage.name)
    v_max, a_max = (
        number(value, f"{linkage.name}: {name}")
        for name, value in (("v_max", v_max), ("a_max", a_max))
    )
    efficiency = number(efficiency, f"{linkage.name}: efficiency")
    if gear_ratio is not None:
        gear_ratio = number(gear_ratio, f"{linkage.name}: gear_ratio")
    limits = {"v_max": v_max, "a_max": a_max}
    for name, value in (
        limits if gear_ratio is None else limits | {"gear_ratio": gear_ratio}
    ).items():
        if not value > TOLERANCES.no_motion:
            raise OptionError(f"{linkage.name}: {name} is {value!r}; it must be positive")
    if not TOLERANCES.no_motion < efficiency <= 1.0:
        raise OptionError(f"{linkage.name}: efficiency is {efficiency!r}; it must lie in (0, 1]")
    remarks = require_masses(linkage, massless)
    require_regular(linkage, box, mode)
    exact, none = rod_model(linkage, "exact"), rod_model(linkage, "massless")
    bare = replace(linkage, rotor_inertia=0.0)

    def measure(pose: Pose) -> dict[str, Any]:
        load, turn = torque_forms(bare, pose, exact), acceleration_forms(linkage, pose)
        return {
            "rate": row_norms(turn.linear) * v_max,
            "load_inertia_note": _diagonal(joint_mass(bare, pose, none)),
            "load_inertia": _diagonal(joint_mass(bare, pose, exact)),
            "torque_note": row_norms(torque_forms(bare, pose, none).linear) * a_max,
            "torque": load.with_rotors(turn, linkage.reflected_inertia).peak(v_max, a_max),
            "load": load.peak(v_max, a_max),
            "sigma": sigma(linkage, pose) * np.array([1.0, -1.0]),
        }

    found = worst(linkage, box, mode, measure)
    path = (adept_in(box, v_max, a_max) if cycle is None else cycle).path()
    demand = follow(linkage, path, mode)

    def forms(pose: Pose) -> tuple[MotionForms, MotionForms]:
        return torque_forms(bare, pose, exact), acceleration_forms(linkage, pose)

    def shaft(both: tuple[MotionForms, MotionForms], drives: Sequence[Drive]) -> Any:
        """Worst torque at the motors' shafts, (N, D · 2 directions of power · 2 cranks)."""
        load, turn = both
        share = np.array([c / drive.gear.ratio for drive in drives for c in drive.gear.shares])
        rotor = np.array([drive.inertia * drive.gear.ratio for drive in drives for _ in range(2)])
        peaks = load.behind_gears(turn, share, rotor).peak(v_max, a_max)
        return peaks.reshape(peaks.shape[0], 4 * len(drives))

    def peak(drives: Sequence[Drive]) -> Array:
        bound = bound_over(linkage, box, mode, lambda pose: shaft(forms(pose), drives))[2]
        return np.asarray(bound.reshape(len(drives), 4).max(axis=1))

    on_grid = forms(solve_pose(linkage, grid_of(box), mode))

    def estimate(drives: Sequence[Drive]) -> Array:
        at = np.asarray(shaft(on_grid, drives)).max(axis=0)
        return np.asarray(at.reshape(len(drives), 4).max(axis=1))

    rate, inertia = found["rate"], found["load_inertia"]
    load = found["load"].largest
    duty = Duty(rate.largest, inertia.largest, demand, efficiency, peak, estimate, load)
    among = motors_of(motors)
    if motor is not None:
        among = [find_motor(motor, None if motors is None else {m.name: m for m in among})]
    fits = fit_all(duty, among, None if gears is None else gears_of(gears), gear_ratio)
    arm = crank_inertia(bare, none)
    return ServoSizing(
        workspace=box,
        v_max=float(v_max),
        a_max=float(a_max),
        mode=(int(mode[0]), int(mode[1])),
        efficiency=float(efficiency),
        rate=rate,
        load_inertia_note=found["load_inertia_note"],
        load_inertia=inertia,
        torque_note=found["torque_note"],
        torque=found["torque"],
        eta=np.divide(linkage.payload, arm, out=np.full(2, np.inf), where=arm > 0.0),
        sigma=(-float(found["sigma"].bound[1]), float(found["sigma"].bound[0])),
        path=path,
        cycle=demand,
        fits=fits,
        remarks=remarks,
    )


def _diagonal(matrix: Any) -> Any:
    return np.einsum("nii->ni", matrix)


def adept_in(box: Rectangle, v_max: float, a_max: float) -> Cycle:
    """The 25/305/25 mm cycle at the bottom of a rectangle, shrunk where that is smaller."""
    shrink = min(1.0, (box.x_max - box.x_min) / TRAVEL, (box.y_max - box.y_min) / LIFT)
    if shrink <= 0.0:
        raise OptionError("workspace: a cycle needs a rectangle with both sides longer than zero")
    centre = (0.5 * (box.x_min + box.x_max), box.y_min)
    return adept(centre, v_max, a_max, LIFT * shrink, TRAVEL * shrink)
