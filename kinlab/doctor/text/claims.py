"""What the names in a file of formulas claim to be: tau1, g2, M12, C11, J11, x, T, V.

A torque that names the tool's force or moment (``fx``, ``F_x``, ``nz``, ``M_z``: base axes) is
statics; parts of the wrench that no line names are zero.
"""

from __future__ import annotations

import re
from dataclasses import replace

import numpy as np

from kinlab.arrays import Array
from kinlab.check.quantities.registry import quantities
from kinlab.doctor.changes import Case, Mechanism
from kinlab.doctor.derived import WRENCH
from kinlab.doctor.linkages import five_bar
from kinlab.doctor.text.joints import joint_claimed
from kinlab.errors import ExpressionError
from kinlab.fivebar import FiveBar
from kinlab.formulas import tree
from kinlab.formulas.files import FormulaFile
from kinlab.formulas.signs.refusals import near_names
from kinlab.formulas.text import canonical
from kinlab.host.language import _
from kinlab.model.dh import DHTable
from kinlab.symbolic.vocabulary import is_planar, vocabulary

VECTORS = {
    "inverse_dynamics": "tau Q torque t",
    "gravity_torques": "g G D",
    "coriolis_torques": "c h V b cv",
    "momentum": "p",
    "forward_dynamics": "qdd",
}
"""The vectors that formulas are of, with the letters that they go by."""
_MATRICES = {
    "mass_matrix": "M D H B",
    "coriolis_matrix": "C",
    "jacobian": "J Jv",
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


_VECTOR_OF, _MATRIX_OF, _NUMBER_OF = map(_by_letter, (VECTORS, _MATRICES, _NUMBERS))
_DETERMINANTS = {2: "planar_position_determinant", 3: "planar_determinant"}
"""What det J is of a planar arm with so many joints: of the rows vx, vy, or of vx, vy, wz."""
_ANGLES = ("phi", "phie")
"""What the angle of a planar arm's tool is called."""
_PARTS = ("R", "r")
"""Letters of a part of a matrix."""
_VECTOR = re.compile(r"([A-Za-z]+)_?(\d)")
_MATRIX = re.compile(r"([A-Za-z]+)_?(\d)_?(\d)")
_CUBE = re.compile(r"D_?(\d)_?(\d)_?(\d)")
_TURNING = re.compile(r"J_?w_?(\d)_?(\d)")
_PLACE = re.compile(r"p_([xyz])")
_DETERMINANT = re.compile(r"\\?det ?\(?J\)?|\\?det|\|J\|")


def claimed_of(entry: str, robot: Mechanism) -> str:
    """The quantity that an entry's name stands for, of an arm or of a five-bar.

    Raises:
        ExpressionError: a name that says nothing.
    """
    if isinstance(robot, FiveBar):
        return five_bar.claimed(entry)
    return quantity_of(entry, robot.table)


def whole_claimed(entry: str, robot: Mechanism) -> str:
    """The whole vector or matrix that a letter alone is, or ``""``."""
    if isinstance(robot, FiveBar):
        return five_bar.whole_claimed(entry)
    return whole_of(entry, robot.table)


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
    planar = table is not None and is_planar(table)
    if _PLACE.fullmatch(entry):
        return _NUMBER_OF[entry.replace("_", "")]
    level = table is not None and planar and float(np.asarray(table.base)[2, 2]) == 1.0
    if level and entry in _ANGLES:  # in the plane x-y of the base, as the engine has them
        return "planar_angle"
    count = len(table.links) if table is not None and level else 0
    if _DETERMINANT.fullmatch(entry) and (level or not planar):
        return _DETERMINANTS.get(count, "jacobian_determinant")
    turning = _TURNING.fullmatch(entry)
    if turning:
        return f"jacobian[{int(turning.group(1)) + 2},{int(turning.group(2)) - 1}]"
    matrix = _MATRIX.fullmatch(entry)
    if matrix and matrix.group(1) in _MATRIX_OF:
        name = _MATRIX_OF[matrix.group(1)]
        if name == "jacobian" and planar:
            name = "planar_jacobian"
        return f"{name}[{int(matrix.group(2)) - 1},{int(matrix.group(3)) - 1}]"
    cube = _CUBE.fullmatch(entry)
    if cube:
        return f"christoffel[{','.join(str(int(k) - 1) for k in cube.groups())}]"
    vector = _VECTOR.fullmatch(entry)
    if vector and vector.group(1) in _VECTOR_OF:
        return f"{_VECTOR_OF[vector.group(1)]}[{int(vector.group(2)) - 1}]"
    joint = joint_claimed(entry, table)
    if joint:
        return joint
    if table is not None and len(table.links) == 1 and whole_of(entry, table):
        return alone(whole_of(entry, table))
    choices = near_names(entry, ["tau1", "g1", "M11", "C11", "J11", "x", "y", *quantities()])
    said = _("{entry!r} names no quantity; {choices}")
    raise ExpressionError(said.format(entry=entry, choices=choices))


def whole_of(entry: str, table: DHTable | None) -> str:
    """The whole vector or matrix that a letter alone is, or ``""``: M, g, tau, J."""
    if entry in _NUMBER_OF or entry in _PARTS:
        return ""
    name = _MATRIX_OF.get(entry) or _VECTOR_OF.get(entry, "")
    if name == "jacobian" and table is not None and is_planar(table):
        return "planar_jacobian"
    return name


def alone(quantity: str) -> str:
    """The only entry of a vector or a square matrix, of an arm of one joint."""
    if quantity in VECTORS:
        return f"{quantity}[0]"
    return f"{quantity}[0,0]" if quantity in ("mass_matrix", "coriolis_matrix") else quantity


# -------- A force or a moment of the tool in a torque

_TORQUE = re.compile(r"tau|Q|torque|t_?\d")
_SPELT = re.compile(r"([fFnNMm])_?([xyz])")
_MOVING = re.compile(r"qdd?\d+|m\d+|g")


def with_forces(file: FormulaFile, robot: Mechanism) -> FormulaFile:
    """The file with fx for F_x, nz for M_z, where nothing else is called so.

    Args:
        file: the formulas.
        robot: whose they are.
    """
    if isinstance(robot, FiveBar):
        return file
    taken = set(vocabulary(robot.table).values) if robot.table is not None else set()
    used = {name for node in file.formulas.values() for name in tree.names(node)}
    meant = {}
    for name in sorted(used - {*file.symbols} - taken):
        found = _SPELT.fullmatch(name)
        if found is not None:
            plain = ("f" if found[1] in "fF" else "n") + found[2]
            if plain != name:
                meant[name] = plain
    symbols = file.symbols | {name: tree.sym(plain) for name, plain in meant.items()}
    return replace(file, symbols=symbols, symbol_texts=file.symbol_texts | meant)


def with_wrench(file: FormulaFile, name: str) -> str:
    """The quantity that a torque is where lines of the file name the tool's force or moment."""
    if not name.startswith("inverse_dynamics["):
        return name
    used = {
        str(inner)
        for entry in file.formulas
        if _TORQUE.match(entry)
        for inner in _names(file, tree.names(file.formulas[entry]))
    }
    if not used & {*WRENCH}:
        return name
    moving = any(_MOVING.fullmatch(word) for word in used)
    return name.replace("inverse_dynamics", "inverse_dynamics_loaded" if moving else "statics")


def _names(file: FormulaFile, names: set[str]) -> set[str]:
    """Names as they are meant, through the file's own symbols."""
    found, waiting, seen = set(), [*names], set()
    while waiting:
        name = waiting.pop()
        if name in seen:
            continue
        seen.add(name)
        if name in file.symbols:
            waiting += tree.names(file.symbols[name])
        else:
            found |= tree.names(canonical(name))
    return found


def named_alone(case: Case, named: set[str]) -> Case:
    """The case with the parts of the wrench that no line names at zero."""
    if "wrench" not in case.arguments:
        return case
    kept = np.array([name in named for name in WRENCH])
    wrench: Array = np.where(kept, case.arguments["wrench"], 0.0)
    return replace(case, arguments={**case.arguments, "wrench": wrench})
