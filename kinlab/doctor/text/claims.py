"""What the names in a file of formulas claim to be: tau1, g2, M12, C11, J11, x, T, V."""

from __future__ import annotations

import re

from kinlab.check.quantities.registry import quantities
from kinlab.doctor.text.joints import joint_claimed
from kinlab.errors import ExpressionError, near
from kinlab.model.dh import DHTable
from kinlab.symbolic.vocabulary import is_planar

_VECTORS = {
    "inverse_dynamics": "tau Q torque",
    "gravity_torques": "g G D",
    "coriolis_torques": "c h V b",
}
_MATRICES = {
    "mass_matrix": "M D H B",
    "coriolis_matrix": "C",
    "jacobian": "J",
    "fk": "T R r",
}
_NUMBERS = {
    "fk[0,3]": "x px",
    "fk[1,3]": "y py",
    "fk[2,3]": "z pz",
    "kinetic_energy": "T K kinetic",
    "potential_energy": "V U P potential",
}
"""Each quantity with the letters that its vectors, matrices and numbers go by."""


def _by_letter(table: dict[str, str]) -> dict[str, str]:
    return {letter: name for name, letters in table.items() for letter in letters.split()}


_VECTOR_OF, _MATRIX_OF, _NUMBER_OF = map(_by_letter, (_VECTORS, _MATRICES, _NUMBERS))
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
    if entry in _NUMBER_OF:
        return _NUMBER_OF[entry]
    matrix = _MATRIX.fullmatch(entry)
    if matrix and matrix.group(1) in _MATRIX_OF:
        name = _MATRIX_OF[matrix.group(1)]
        if name == "jacobian" and table is not None and is_planar(table):
            name = "planar_jacobian"
        return f"{name}[{int(matrix.group(2)) - 1},{int(matrix.group(3)) - 1}]"
    vector = _VECTOR.fullmatch(entry)
    if vector and vector.group(1) in _VECTOR_OF:
        return f"{_VECTOR_OF[vector.group(1)]}[{int(vector.group(2)) - 1}]"
    joint = joint_claimed(entry, table)
    if joint:
        return joint
    choices = near(entry, ["tau1", "g1", "M11", "C11", "J11", "x", "y", *quantities()])
    raise ExpressionError(f"{entry!r} names no quantity; {choices}")
