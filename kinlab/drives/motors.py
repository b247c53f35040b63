"""Servomotors as data: the catalogue in ``robots/fivebar/motors.toml`` and files of one's own."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from pathlib import Path

import numpy as np

from kinlab.drives.records import check_figures, check_order, read_records, several
from kinlab.errors import MotorError, NameUnknownError, near
from kinlab.model.library import robots_dir

_HANG_TOGETHER = 2.0
"""Rated power may differ from rated torque times rated speed by this factor. Makers' sheets agree
to a few per cent; a torque in N cm or a speed in rad/s differs by ten or more."""


@dataclass(frozen=True)
class Motor:
    """One servomotor; a figure that its maker does not state is ``None``.

    Attributes:
        name: the maker's name of it.
        maker: who makes it.
        data_sheet: the maker's document that the figures stand in.
        rated_power: W.
        rated_torque: continuous, N m.
        peak_torque: instantaneous, N m.
        rated_speed: r/min.
        max_speed: N_max, r/min.
        rotor_inertia: I_M, kg m².

    Raises:
        MotorError: a figure that is not a positive number, a peak below the rated figure, or a
            rated power that is not that of rated torque and speed, even roughly.
    """

    name: str
    maker: str = ""
    data_sheet: str = ""
    rated_power: float | None = None
    rated_torque: float | None = None
    peak_torque: float | None = None
    rated_speed: float | None = None
    max_speed: float | None = None
    rotor_inertia: float | None = None

    def __post_init__(self) -> None:
        check_figures(self, "motor")
        check_order(self, "motor", "rated_torque", "peak_torque")
        check_order(self, "motor", "rated_speed", "max_speed")
        if self.rated_power and self.rated_torque and self.rated_speed:
            power = self.rated_torque * self.rated_speed * np.pi / 30.0
            if not 1.0 / _HANG_TOGETHER <= power / self.rated_power <= _HANG_TOGETHER:
                raise MotorError(
                    f"motor {self.name!r}: rated_power is {self.rated_power:g} W, rated torque and "
                    f"speed give {power:.4g} W; torques are in N m, speeds in r/min"
                )

    def need(self, figure: str) -> float:
        """A figure that must be there.

        Raises:
            MotorError: the motor does not state it.
        """
        value: float | None = getattr(self, figure)
        if value is None:
            raise MotorError(
                f"motor {self.name!r} states no {figure}, which sizing needs; add it from the "
                "maker's data sheet"
            )
        return value


def read_motors(path: str | Path) -> dict[str, Motor]:
    """Reads a catalogue of motors.

    TOML with one ``[[motors]]`` per motor, or CSV with the keys in its first line; keys and units
    are the attributes of :class:`Motor`. Sizing needs ``max_speed``, ``rated_torque``,
    ``peak_torque`` and ``rotor_inertia``.

    Raises:
        FileError: the file cannot be read.
        MotorError: not TOML or CSV, an unknown key, no name, a name twice, an impossible figure.
    """
    return read_records(path, "motors", Motor)


def catalogue() -> dict[str, Motor]:
    """The shipped motors by name."""
    return read_motors(robots_dir() / "fivebar" / "motors.toml")


def find_motor(motor: str | Motor, among: dict[str, Motor] | None = None) -> Motor:
    """A motor as given, or the one of that name among some, or among the shipped ones.

    Raises:
        NameUnknownError: none of that name.
    """
    if isinstance(motor, Motor):
        return motor
    known = catalogue() if among is None else among
    if motor not in known:
        raise NameUnknownError(f"no motor {motor!r}; {near(motor, known)}")
    return known[motor]


def motors_of(motors: str | Path | Motor | Sequence[Motor] | None) -> list[Motor]:
    """Reads motors in any of the forms that sizing takes.

    Args:
        motors: a file (see :func:`read_motors`), a motor, several, or none for the shipped ones.

    Raises:
        FileError, MotorError: as :func:`read_motors`.
        OptionError: anything else, or an empty list.
    """
    if motors is None:
        return list(catalogue().values())
    return several(motors, Motor, "motors", read_motors)
