"""Servo sizing of a five-bar: the worst case over a workspace, and the motors that meet it.

Source: note 003 (003.speed, 003.IM, 003.Tmax, 003.G); Huang et al. 2005, doi 10.1115/1.1898343.
The note's T_max keeps |G_1| a_max of massless rods alone; the full one adds f(v), gravity, the
rods, the rotor and the gear's efficiency.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass, replace

import numpy as np
from numpy.typing import ArrayLike

from kinlab.arrays import Array, number
from kinlab.drives.motors import Motor, catalogue, find_motor
from kinlab.errors import InertiaError, OptionError
from kinlab.fivebar.demand import Worst, refuse_singular, row_norms, torque_forms, worst
from kinlab.fivebar.dynamics import crank_inertia, joint_mass, rod_model
from kinlab.fivebar.fitting import MotorFit, Task, fit_motor
from kinlab.fivebar.geometry import rate_matrix
from kinlab.fivebar.linkage import Linkage
from kinlab.fivebar.pose import HANGING, Mode, Pose
from kinlab.fivebar.trajectory import LIFT, TRAVEL, Cycle, Path, follow, pick_and_place
from kinlab.fivebar.workspace import Rectangle, read_rectangle

_MASSES = ("payload", "crank_mass", "crank_inertia", "rod_mass", "rod_inertia")

_LEAST = 1e-9
"""A speed, acceleration, ratio or efficiency of no more than this is none."""


@dataclass(frozen=True)
class ServoSizing:
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
        cycle: the pick-and-place cycle that the RMS figures are taken over.
        fits: motors: those that fit first, the smallest peak torque first; then the others, the
            nearest to fitting first.
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
    cycle: Cycle
    fits: tuple[MotorFit, ...]

    @property
    def short_list(self) -> tuple[MotorFit, ...]:
        """The motors that meet every limit."""
        return tuple(fit for fit in self.fits if fit.fits)


def size_servo(
    linkage: Linkage,
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
        gear_ratio: j; none takes for each motor the one whose least margin (speed, peak and rated
            torque) is largest.
        mode: signs of u_i x w_i.
        efficiency: of the gears, 0 to 1.

    Returns:
        The demands and the motors that meet them. The cycle is the 25/305/25 mm one at the
        bottom of the workspace, shrunk in proportion where the workspace is smaller.

    Raises:
        OptionError: a limit that is not positive, an empty rectangle, an impossible efficiency.
        UnreachableError, SingularError: the rectangle is not free of singularities; says where.
        MotorError: the motor lacks a figure. NameUnknownError: no motor of that name.
        InertiaError: the linkage has neither masses nor a payload.
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
        if not value > _LEAST:
            raise OptionError(f"{linkage.name}: {name} is {value!r}; it must be positive")
    if not _LEAST < efficiency <= 1.0:
        raise OptionError(f"{linkage.name}: efficiency is {efficiency!r}; it must lie in (0, 1]")
    if not any(np.any(getattr(linkage, name)) for name in _MASSES):
        raise InertiaError(
            f"{linkage.name}: nothing to move: no payload, mass or inertia is given, so no torque "
            "can be sized"
        )
    refuse_singular(linkage, box, mode)
    exact, massless = rod_model(linkage, "exact"), rod_model(linkage, "massless")
    bare = replace(linkage, rotor_inertia=0.0)

    def search(quantity: Callable[[Pose], Array]) -> Worst:
        return worst(linkage, box, mode, quantity)

    rate = search(lambda pose: row_norms(rate_matrix(linkage, pose)) * v_max)
    inertia = search(lambda pose: _diagonal(joint_mass(bare, pose, exact)))
    cycle = follow(linkage, _cycle_in(box, v_max, a_max), mode)
    task = Task(linkage, box, mode, v_max, a_max, efficiency, rate.largest, inertia.largest, cycle)
    motors = catalogue().values() if motor is None else [find_motor(motor)]
    fits = [fit_motor(task, one, gear_ratio) for one in motors]
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
        cycle=cycle,
        fits=tuple(sorted(fits, key=_rank)),
    )


def _rank(fit: MotorFit) -> tuple[bool, float]:
    """Fitting motors first, the smallest first; then the others, the nearest to fitting first."""
    return not fit.fits, fit.motor.need("peak_torque") if fit.fits else -fit.margin


def _diagonal(matrix: Array) -> Array:
    return np.asarray(np.einsum("nii->ni", matrix))


def _sigma(linkage: Linkage, pose: Pose) -> Array:
    return np.asarray(np.linalg.svd(rate_matrix(linkage, pose), compute_uv=False))


def _cycle_in(box: Rectangle, v_max: float, a_max: float) -> Path:
    shrink = min(1.0, (box.x_max - box.x_min) / TRAVEL, (box.y_max - box.y_min) / LIFT)
    if shrink <= 0.0:
        raise OptionError("workspace: a cycle needs a rectangle with both sides longer than zero")
    centre = np.array([0.5 * (box.x_min + box.x_max), box.y_min])
    return pick_and_place(centre, v_max, a_max, LIFT * shrink, TRAVEL * shrink)
