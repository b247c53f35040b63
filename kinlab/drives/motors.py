"""Servomotors as data: the catalogue in ``robots/fivebar/motors.toml`` and files of one's own."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, fields
from pathlib import Path
from typing import Any

import numpy as np

from kinlab.errors import MotorError, NameUnknownError, near
from kinlab.host.files import read_text, read_toml
from kinlab.model.library import robots_dir

_TEXT = ("name", "maker", "data_sheet")
"""What of a motor is no figure."""


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
        MotorError: a figure that is not a positive number.
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
        for figure, value in vars(self).items():
            if figure in _TEXT or value is None:
                continue
            sound = isinstance(value, (int, float)) and not isinstance(value, bool)
            if not sound or not np.isfinite(value) or value <= 0:
                raise MotorError(
                    f"motor {self.name!r}: {figure} is {value!r}; it must be a positive number"
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
    """Reads a catalogue: a TOML file with one ``[[motors]]`` per motor.

    Raises:
        FileError: the file cannot be read.
        MotorError: not TOML, an unknown key, no name, a name twice, an impossible figure.
    """
    data = read_toml(read_text(path), str(path), MotorError)
    rows = data.get("motors", [])
    if not isinstance(rows, list) or not rows:
        raise MotorError(f"{path}: no [[motors]] in it")
    out: dict[str, Motor] = {}
    for i, row in enumerate(rows, 1):
        motor = _motor(row, f"{path}, motor {i}")
        if motor.name in out:
            raise MotorError(f"{path}, motor {i}: the name {motor.name!r} is used twice")
        out[motor.name] = motor
    return out


def _motor(row: Mapping[str, Any], place: str) -> Motor:
    keys = tuple(f.name for f in fields(Motor))
    for key in row:
        if key not in keys:
            raise MotorError(f"{place}: key {key!r} is unknown; {near(key, keys)}")
    if not isinstance(row.get("name"), str):
        raise MotorError(f"{place}: name is missing")
    return Motor(**row)


def catalogue() -> dict[str, Motor]:
    """The shipped motors by name."""
    return read_motors(robots_dir() / "fivebar" / "motors.toml")


def find_motor(motor: str | Motor) -> Motor:
    """A motor as given, or the shipped one of that name.

    Raises:
        NameUnknownError: none of that name.
    """
    if isinstance(motor, Motor):
        return motor
    known = catalogue()
    if motor not in known:
        raise NameUnknownError(f"no motor {motor!r}; {near(motor, known)}")
    return known[motor]
