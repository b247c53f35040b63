"""The two Denavit-Hartenberg conventions. Every table states its own; there is no default."""

from __future__ import annotations

from enum import StrEnum

from kinlab.errors import TableError


class Convention(StrEnum):
    """Which of the two DH conventions a table is written in.

    STANDARD: T_i = Rz(theta_i) Tz(d_i) Tx(a_i) Rx(alpha_i); frame i at the far end of link i.
    MODIFIED: T_i = Rx(alpha_{i-1}) Tx(a_{i-1}) Rz(theta_i) Tz(d_i); frame i on joint axis i.
        The row of link i holds alpha_{i-1} and a_{i-1}, as Craig prints it.
    """

    STANDARD = "standard"
    MODIFIED = "modified"


def read_convention(value: object, place: str) -> Convention:
    """Reads a convention; there is no default.

    Raises:
        TableError: missing or unknown, with ``place`` in front.
    """
    choices = 'choose "standard" or "modified"'
    if value is None or value == "":
        raise TableError(f"{place}: convention is missing; {choices}")
    if isinstance(value, str) and value in tuple(Convention):
        return Convention(value)
    raise TableError(f"{place}: convention {value!r} is unknown; {choices}")
