"""Servo sizing of a five-bar: the worst case over a workspace, and the motors that meet it.

At one place the torque of a crank is linear in the tool's acceleration and quadratic in its
velocity: tau_i = G_i a + v^T Q_i v + g_i. So the worst direction of each is exact: |G_i| a_max,
and an eigenvalue of Q_i times v_max². Only the place has to be searched for.

Source: note 003 (003.speed, 003.IM, 003.Tmax, 003.G); Huang et al. 2005, doi 10.1115/1.1898343.
The note's T_max keeps |G_1| a_max of massless rods alone; the full one adds f(v), gravity, the
rods, the rotor and the gear's efficiency.
"""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass, replace
from typing import TYPE_CHECKING, Any

import numpy as np
from numpy.typing import ArrayLike

from kinlab.arrays import Array, number
from kinlab.drives.cycles import LIFT, TRAVEL, Path, pick_and_place
from kinlab.drives.demand import Demand
from kinlab.drives.fitting import Duty, MotorFit, fit_motors, stretch_to_motor
from kinlab.drives.gears import Drive
from kinlab.drives.motors import Motor, catalogue, find_motor
from kinlab.errors import InertiaError, OptionError, SingularError, UnreachableError, warn
from kinlab.fivebar.arguments import HANGING, Mode
from kinlab.fivebar.dynamics import (
    RodModel,
    bars_without_mass,
    crank_inertia,
    joint_mass,
    rod_model,
    torques,
)
from kinlab.fivebar.geometry import Pose, ik, rate_bias, rate_matrix, solve_pose
from kinlab.fivebar.workspace import Rectangle, free_region, read_rectangle
from kinlab.host.introductions import Introduction, Rows, shown_cells, vector
from kinlab.tolerances import TOLERANCES

if TYPE_CHECKING:
    from kinlab.fivebar.linkage import FiveBar

# -------- A path in joint coordinates


def follow(
    linkage: FiveBar,
    path: Path,
    mode: Mode = HANGING,
    model: str = "exact",
    margin: float = 0.02,
) -> Demand:
    """Crank motion, torques and power along a path in one working mode.

    Args:
        linkage: the five-bar.
        path: the tool's motion.
        mode: signs of u_i x w_i.
        model: a rod model.
        margin: least sine allowed between two bars that must not get in line.

    Raises:
        UnreachableError: the path leaves the workspace; says when and where.
        SingularError: it meets or crosses a singularity; says when and where.
    """
    pose = _regular_poses(linkage, path, mode, margin)
    jac, bias = rate_matrix(linkage, pose), rate_bias(linkage, pose, path.v)
    rate = np.einsum("nij,nj->ni", jac, path.v)
    theta_ddot = np.einsum("nij,nj->ni", jac, path.a) + bias
    tau = torques(linkage, pose, path.v, path.a, rod_model(linkage, model))
    theta = np.unwrap(ik(linkage, path.points, mode), axis=0)
    return Demand(path.t, theta, rate, theta_ddot, tau, linkage.reflected_inertia)


def _regular_poses(linkage: FiveBar, path: Path, mode: Mode, margin: float) -> Pose:
    """The poses along a path, refused where it cannot be followed; as :func:`follow`."""
    if not 0.0 <= margin < 1.0:
        raise OptionError(f"{linkage.name}: margin is {margin!r}; it must lie between 0 and 1")
    pose = solve_pose(linkage, path.points, mode, "mask")

    def place(k: int) -> str:
        x, y = path.points[k]
        return f"{linkage.name}: the path at t = {path.t[k]:.4g} s, ({x:.6g}, {y:.6g}) m"

    if not pose.ok.all():
        raise UnreachableError(f"{place(int(np.argmin(pose.ok)))}, leaves the workspace")
    legs = np.abs(pose.sine).min(axis=1)
    if legs.min() <= margin:
        k = int(np.argmax(legs <= margin))
        leg = int(np.abs(pose.sine[k]).argmin()) + 1
        raise SingularError(
            f"{place(k)}, meets a singularity of type I: sine {legs[k]:.3g} between the bars of "
            f"leg {leg}, at most {margin:g} away"
        )
    rods = pose.rods * np.sign(pose.rods[0])
    if rods.min() <= margin:
        k = int(np.argmax(rods <= margin))
        raise SingularError(
            f"{place(k)}, meets a singularity of type II: w1 x w2 = {pose.rods[k]:.3g}, at most "
            f"{margin:g} away or past it"
        )
    return pose


def fit_to_motor(
    linkage: FiveBar,
    path: Path,
    motor: Motor,
    gear_ratio: float,
    efficiency: float = 0.9,
    mode: Mode = HANGING,
) -> Path:
    """Stretches a path until a motor just follows it: N_max or peak torque is reached.

    Args:
        linkage: the five-bar; its own rotor inertia is left out in favour of the motor's.
        path: the tool's motion.
        motor: needs max_speed, peak_torque and rotor_inertia.
        gear_ratio: j.
        efficiency: of the gears, 0 to 1; see :meth:`kinlab.drives.demand.Demand.at_motor`.
        mode: signs of u_i x w_i.

    Raises:
        MotorError: the motor cannot hold the weight, or lacks a figure.
        UnreachableError, SingularError: as :func:`follow`.
    """
    moving, held = (follow(linkage, each, mode) for each in (path, path.held))
    return path.stretched(
        stretch_to_motor(moving, held, motor, gear_ratio, efficiency, linkage.name)
    )


# -------- The worst case over a rectangle

_GRID, _ZOOM, _ZOOMS = 33, 9, 14
"""Points a side of the first grid and of each zoom, and how often the best cell is zoomed in."""


@dataclass(frozen=True)
class Worst:
    """Largest value over the workspace for each crank, and where.

    Attributes:
        value: (2,). place: (2 cranks, 2), m.
    """

    value: Array
    place: Array

    @property
    def largest(self) -> float:
        """Over both cranks."""
        return float(self.value.max())


@dataclass(frozen=True)
class MotionForms:
    """A pair of quantities as functions of the tool's motion.

    Their value is linear·a + v^T quadratic v + constant.

    Attributes:
        linear: (N, 2, 2). quadratic: (N, 2, 2, 2). constant: (N, 2).
    """

    linear: Array
    quadratic: Array
    constant: Array

    def plus(self, other: MotionForms, share: float, other_share: float) -> MotionForms:
        """share · self + other_share · other."""
        return MotionForms(
            share * self.linear + other_share * other.linear,
            share * self.quadratic + other_share * other.quadratic,
            share * self.constant + other_share * other.constant,
        )

    def peak(self, v_max: float, a_max: float) -> Array:
        """Largest absolute value over |a| <= a_max and |v| <= v_max, (N, 2), exact."""
        xx, xy, yy = (self.quadratic[..., i, j] for i, j in ((0, 0), (0, 1), (1, 1)))
        middle, radius = 0.5 * (xx + yy), np.hypot(0.5 * (xx - yy), xy)  # eigenvalues' circle
        up = np.maximum(middle + radius, 0.0) * v_max**2 + self.constant
        down = np.maximum(radius - middle, 0.0) * v_max**2 - self.constant
        return np.asarray(row_norms(self.linear) * a_max + np.maximum(up, down))


def torque_forms(linkage: FiveBar, pose: Pose, rods: RodModel) -> MotionForms:
    """The crank torques, N m."""

    def at(v: Array, a: Array) -> Array:
        shape = pose.xy.shape
        return torques(linkage, pose, np.broadcast_to(v, shape), np.broadcast_to(a, shape), rods)

    none, (x, y) = np.zeros(2), np.eye(2)
    still = at(none, none)
    linear = np.stack([at(none, x) - still, at(none, y) - still], axis=2)
    return MotionForms(linear, _quadratic(lambda v: at(v, none) - still), still)


def acceleration_forms(linkage: FiveBar, pose: Pose) -> MotionForms:
    """The crank accelerations theta_ddot = J a + f(v), rad/s²."""
    bias = _quadratic(lambda v: rate_bias(linkage, pose, np.broadcast_to(v, pose.xy.shape)))
    return MotionForms(rate_matrix(linkage, pose), bias, np.zeros_like(pose.xy))


def _quadratic(form: Callable[[Array], Array]) -> Array:
    """Matrices of the quadratic forms v -> (N, 2), by polarisation, (N, 2, 2, 2)."""
    x, y = np.eye(2)
    xx, yy = form(x), form(y)
    xy = 0.5 * (form(x + y) - xx - yy)
    return np.stack([np.stack([xx, xy], axis=2), np.stack([xy, yy], axis=2)], axis=3)


def row_norms(matrix: Array) -> Array:
    """Lengths of the rows, (N, 2) from (N, 2, 2)."""
    return np.asarray(np.linalg.norm(matrix, axis=2))


def worst(linkage: FiveBar, box: Rectangle, mode: Mode, quantity: Callable[[Pose], Array]) -> Worst:
    """Largest (2,) of a quantity (N, 2) over a rectangle, edges included, by zooming grids."""
    low, high = np.array([box.x_min, box.y_min]), np.array([box.x_max, box.y_max])
    values, places = np.empty(2), np.empty((2, 2))
    first = lattice(low, high, _GRID)
    found = quantity(solve_pose(linkage, first, mode))
    for crank in range(2):
        place, best = first[found[:, crank].argmax()], found[:, crank].max()
        reach = (high - low) / (_GRID - 1)
        for _ in range(_ZOOMS):
            near = lattice(np.maximum(place - reach, low), np.minimum(place + reach, high), _ZOOM)
            value = quantity(solve_pose(linkage, near, mode))[:, crank]
            if value.max() > best:
                place, best = near[value.argmax()], value.max()
            reach = reach * 0.4
        values[crank], places[crank] = best, place
    return Worst(values, places)


def lattice(low: Array, high: Array, count: int) -> Array:
    """count x count points of a rectangle, edges included, (count², 2)."""
    axes = [np.linspace(a, b, count) for a, b in zip(low, high, strict=True)]
    return np.stack(np.meshgrid(*axes), axis=-1).reshape(-1, 2)


def grid_of(box: Rectangle) -> Array:
    """The first grid over a rectangle, (N, 2)."""
    return lattice(np.array([box.x_min, box.y_min]), np.array([box.x_max, box.y_max]), _GRID)


def require_regular(linkage: FiveBar, box: Rectangle, mode: Mode) -> None:
    """Refuses a rectangle that is not free of singularities in one working mode.

    Raises:
        UnreachableError, SingularError: with a place.
    """
    points = grid_of(box)
    pose = solve_pose(linkage, points, mode, regular="I II")  # names an unreachable place
    middle = solve_pose(linkage, [0.5 * (box[0] + box[1]), 0.5 * (box[2] + box[3])], mode)
    sign = np.sign(middle.rods[0])
    if sign == 0.0 or np.any(pose.rods * sign <= 0.0):
        at = points[int(np.argmin(pose.rods * sign))]
    else:
        free = free_region(linkage, mode, int(sign))
        if free.contains_rectangle(box):
            return
        at = points[int(np.argmin(free.clearance(points)))]
    raise SingularError(
        f"{linkage.name}: the workspace {tuple(box)} is not free of singularities in mode "
        f"{tuple(mode)}; the rods get in line, or a leg's reach ends, near ({at[0]:.6g}, "
        f"{at[1]:.6g}) m; largest_rectangle() gives one that is free"
    )


# -------- Sizing

_MASSES = ("payload", "crank_mass", "crank_inertia", "rod_mass", "rod_inertia")


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

    Returns:
        The demands and the motors that meet them. The cycle is the 25/305/25 mm one at the
        bottom of the workspace, shrunk in proportion where the workspace is smaller.

    Raises:
        OptionError: a limit that is not positive, an empty rectangle, an impossible efficiency.
        UnreachableError, SingularError: the rectangle is not free of singularities; says where.
        MotorError: the motor lacks a figure. NameUnknownError: no motor of that name.
        InertiaError: the linkage has neither masses nor a payload.

    Warns:
        KinlabWarning: cranks or rods have no mass.
    """
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
    if not any(np.any(getattr(linkage, name)) for name in _MASSES):
        raise InertiaError(
            f"{linkage.name}: nothing to move: no payload, mass or inertia is given, so no torque "
            "can be sized"
        )
    require_regular(linkage, box, mode)
    missing = bars_without_mass(linkage)
    if missing:
        warn(f"{linkage.name}: {missing}")
    exact, massless = rod_model(linkage, "exact"), rod_model(linkage, "massless")
    bare = replace(linkage, rotor_inertia=0.0)

    def search(quantity: Callable[[Pose], Array]) -> Worst:
        return worst(linkage, box, mode, quantity)

    rate = search(lambda pose: row_norms(rate_matrix(linkage, pose)) * v_max)
    inertia = search(lambda pose: _diagonal(joint_mass(bare, pose, exact)))
    path = _cycle_in(box, v_max, a_max)
    cycle = follow(linkage, path, mode)

    def shaft(pose: Pose) -> Callable[[Drive], Array]:
        """Worst torque at the motors' shafts at some poses, (N, 2), by drive."""
        load = torque_forms(bare, pose, exact)
        acceleration = acceleration_forms(linkage, pose)

        def at(drive: Drive) -> Array:
            rotor = drive.inertia * drive.gear.ratio
            shares = [c / drive.gear.ratio for c in dict.fromkeys(drive.gear.shares)]
            peaks = [load.plus(acceleration, c, rotor).peak(v_max, a_max) for c in shares]
            return np.asarray(np.max(peaks, axis=0))

        return at

    def peak(drives: Sequence[Drive]) -> Array:
        return np.array([search(lambda pose, d=d: shaft(pose)(d)).largest for d in drives])  # type: ignore[misc]

    on_grid = shaft(solve_pose(linkage, grid_of(box), mode))

    def estimate(drives: Sequence[Drive]) -> Array:
        return np.array([on_grid(drive).max() for drive in drives])

    load = search(lambda pose: torque_forms(bare, pose, exact).peak(v_max, a_max)).largest
    duty = Duty(rate.largest, inertia.largest, cycle, efficiency, peak, estimate, load)
    motors = list(catalogue().values()) if motor is None else [find_motor(motor)]
    arm = crank_inertia(bare, massless)
    return ServoSizing(
        workspace=box,
        v_max=float(v_max),
        a_max=float(a_max),
        mode=(int(mode[0]), int(mode[1])),
        efficiency=float(efficiency),
        rate=rate,
        load_inertia_note=search(lambda pose: _diagonal(joint_mass(bare, pose, massless))),
        load_inertia=inertia,
        torque_note=search(
            lambda pose: row_norms(torque_forms(bare, pose, massless).linear) * a_max
        ),
        torque=search(lambda pose: torque_forms(linkage, pose, exact).peak(v_max, a_max)),
        eta=np.divide(linkage.payload, arm, out=np.full(2, np.inf), where=arm > 0.0),
        sigma=(
            -search(lambda pose: -_sigma(linkage, pose)).largest,
            search(lambda pose: _sigma(linkage, pose)).largest,
        ),
        path=path,
        cycle=cycle,
        fits=fit_motors(duty, motors, gear_ratio),
        remarks=(missing,) if missing else (),
    )


def _diagonal(matrix: Array) -> Array:
    return np.asarray(np.einsum("nii->ni", matrix))


def _sigma(linkage: FiveBar, pose: Pose) -> Array:
    return np.asarray(np.linalg.svd(rate_matrix(linkage, pose), compute_uv=False))


def _cycle_in(box: Rectangle, v_max: float, a_max: float) -> Path:
    shrink = min(1.0, (box.x_max - box.x_min) / TRAVEL, (box.y_max - box.y_min) / LIFT)
    if shrink <= 0.0:
        raise OptionError("workspace: a cycle needs a rectangle with both sides longer than zero")
    centre = np.array([0.5 * (box.x_min + box.x_max), box.y_min])
    return pick_and_place(centre, v_max, a_max, LIFT * shrink, TRAVEL * shrink)
