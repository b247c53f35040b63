"""Gearboxes as data, and a drive: one motor behind one gearbox.

The direction of power counts. Where the motor drives the load, the shaft carries the load's torque
divided by the ratio and by the efficiency; where the load drives the motor, the losses help to
hold it: divided by the ratio, times the efficiency of that direction.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from pathlib import Path

from kinlab.drives.motors import Motor
from kinlab.drives.records import check_figures, check_order, read_records, several
from kinlab.errors import MotorError, NameUnknownError, near


@dataclass(frozen=True)
class Gearbox:
    """One gearbox; a limit that its maker does not state is ``None`` and cannot be judged.

    Attributes:
        name: the maker's name of it.
        ratio: j, motor turns per joint turn; for a joint that slides, rad of the motor per metre.
        efficiency: of power from motor to load, above 0, at most 1.
        back_efficiency: of power from load to motor, 0 (it locks itself) to 1; none takes
            :attr:`efficiency`.
        inertia: at the motor's shaft, kg m².
        nominal_torque: permissible mean torque at the output, N m. Against it stand the root mean
            square over time and the cubic mean weighted by speed, whichever is larger.
        peak_torque: permissible repeated peak (acceleration) torque at the output, N m.
        rated_speed: permissible mean speed of the input, r/min.
        max_speed: permissible speed of the input, r/min.
        maker: who makes it.
        data_sheet: the maker's document that the figures stand in.

    Raises:
        MotorError: a figure that is not a positive number, an efficiency above 1, a peak below
            the nominal figure.
    """

    name: str
    ratio: float
    efficiency: float
    inertia: float = 0.0
    back_efficiency: float | None = None
    nominal_torque: float | None = None
    peak_torque: float | None = None
    rated_speed: float | None = None
    max_speed: float | None = None
    maker: str = ""
    data_sheet: str = ""

    def __post_init__(self) -> None:
        check_figures(self, "gearbox", may_be_zero=("inertia", "back_efficiency"))
        check_order(self, "gearbox", "nominal_torque", "peak_torque")
        check_order(self, "gearbox", "rated_speed", "max_speed")
        for figure in ("efficiency", "back_efficiency"):
            value = getattr(self, figure)
            if value is not None and value > 1.0:
                raise MotorError(
                    f"gearbox {self.name!r}: {figure} is {value:g}; it is a part, at most 1"
                )

    @property
    def shares(self) -> tuple[float, float]:
        """By what it multiplies the load: where the motor drives it, and where it drives back."""
        back = self.efficiency if self.back_efficiency is None else self.back_efficiency
        return 1.0 / self.efficiency, back

    @property
    def unstated(self) -> tuple[str, ...]:
        """The limits that are not stated."""
        limits = ("nominal_torque", "peak_torque", "rated_speed", "max_speed")
        return tuple(limit for limit in limits if getattr(self, limit) is None)


def ideal_gear(ratio: float, efficiency: float = 1.0) -> Gearbox:
    """A gear of any ratio without inertia and limits of its own: what a first sizing assumes."""
    return Gearbox(f"any {ratio:.4g}:1", ratio, efficiency)


@dataclass(frozen=True)
class Drive:
    """One motor behind one gearbox.

    Attributes:
        motor: needs a rotor inertia.
        gear: the gearbox.
    """

    motor: Motor
    gear: Gearbox

    @property
    def inertia(self) -> float:
        """Of rotor and gearbox at the motor's shaft, kg m².

        Raises:
            MotorError: the motor states no rotor inertia.
        """
        return self.motor.need("rotor_inertia") + self.gear.inertia

    @property
    def reflected_inertia(self) -> float:
        """The same at the joint, kg m²: what a model of the arm takes as armature."""
        return self.gear.ratio**2 * self.inertia


def read_gears(path: str | Path) -> dict[str, Gearbox]:
    """Reads a catalogue of gearboxes.

    TOML with one ``[[gears]]`` per gearbox, or CSV with the keys in its first line; keys and units
    are the attributes of :class:`Gearbox`. A row must state ``ratio``, ``efficiency``,
    ``inertia``, ``nominal_torque``, ``peak_torque`` and ``max_speed``: nothing is assumed.

    Raises:
        FileError: the file cannot be read.
        MotorError: not TOML or CSV, an unknown or missing key, a name twice, an impossible figure.
    """
    needed = ("ratio", "efficiency", "inertia", "nominal_torque", "peak_torque", "max_speed")
    return read_records(path, "gears", Gearbox, needed)


def gears_of(gears: str | Path | Gearbox | Sequence[Gearbox]) -> list[Gearbox]:
    """Reads gearboxes in any of the forms that sizing takes: a file, one, or several.

    Raises:
        FileError, MotorError: as :func:`read_gears`.
        OptionError: anything else, or an empty list.
    """
    return several(gears, Gearbox, "gears", read_gears)


def find_gear(gear: str | Gearbox, among: Sequence[Gearbox]) -> Gearbox:
    """A gearbox as given, or the one of that name among some.

    Raises:
        NameUnknownError: none of that name.
    """
    if isinstance(gear, Gearbox):
        return gear
    known = {one.name: one for one in among}
    if gear not in known:
        choices = near(gear, known) if known else "no gearboxes are given: name a file of them"
        raise NameUnknownError(f"no gearbox {gear!r}; {choices}")
    return known[gear]
