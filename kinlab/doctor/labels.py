"""What the names in a formula file claim to be: tau1, g2, M12, C11, J11, x, T, V."""

from __future__ import annotations

import re

from kinlab.check.quantities import quantities
from kinlab.dh import DHTable
from kinlab.errors import ExpressionError, near
from kinlab.symbolic.vocabulary import is_planar

_VECTORS = {
    "tau": "inverse_dynamics", "Q": "inverse_dynamics", "torque": "inverse_dynamics",
    "g": "gravity_torques", "G": "gravity_torques", "D": "gravity_torques",
    "c": "coriolis_torques", "h": "coriolis_torques", "V": "coriolis_torques",
    "b": "coriolis_torques",
}  # fmt: skip
_MATRICES = {
    "M": "mass_matrix", "D": "mass_matrix", "H": "mass_matrix", "B": "mass_matrix",
    "C": "coriolis_matrix", "J": "jacobian", "T": "fk", "R": "fk", "r": "fk",
}  # fmt: skip
_NUMBERS = {
    "x": "fk[0,3]", "y": "fk[1,3]", "z": "fk[2,3]",
    "px": "fk[0,3]", "py": "fk[1,3]", "pz": "fk[2,3]",
    "T": "kinetic_energy", "K": "kinetic_energy", "kinetic": "kinetic_energy",
    "V": "potential_energy", "U": "potential_energy", "P": "potential_energy",
    "potential": "potential_energy",
}  # fmt: skip
_VECTOR = re.compile(r"([A-Za-z]+)_?(\d)")
_MATRIX = re.compile(r"([A-Za-z]+)_?(\d)_?(\d)")


def quantity_of(entry: str, table: DHTable | None) -> str:
    """The quantity that an entry's name stands for, such as ``"inverse_dynamics[0]"``.

    Args:
        entry: ``tau1``, ``M12``, ... (rows and columns from 1), or the quantity itself.
        table: the robot's table; of a planar arm ``J11`` ... are the rows vx, vy, wz.

    Raises:
        ExpressionError: a name that says nothing.
    """
    plain = entry.split("[")[0].strip()
    if plain in quantities():
        return entry.strip()
    if entry in _NUMBERS:
        return _NUMBERS[entry]
    matrix = _MATRIX.fullmatch(entry)
    if matrix and matrix.group(1) in _MATRICES:
        name = _MATRICES[matrix.group(1)]
        if name == "jacobian" and table is not None and is_planar(table):
            name = "planar_jacobian"
        return f"{name}[{int(matrix.group(2)) - 1},{int(matrix.group(3)) - 1}]"
    vector = _VECTOR.fullmatch(entry)
    if vector and vector.group(1) in _VECTORS:
        return f"{_VECTORS[vector.group(1)]}[{int(vector.group(2)) - 1}]"
    choices = near(entry, ["tau1", "g1", "M11", "C11", "J11", "x", "y", *quantities()])
    raise ExpressionError(f"{entry!r} names no quantity; {choices}")
