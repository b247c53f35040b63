"""Torques as text that name the tool's force and moment: tau1 = -fx*(l1*s1 + ...) is statics.

``fx``, ``F_x``, ``nz``, ``M_z``, ...: base axes. Parts of the wrench that no line names are zero.
"""

from __future__ import annotations

import re
from dataclasses import replace

import numpy as np

from kinlab.arrays import Array
from kinlab.doctor.changes import Case
from kinlab.formulas import tree
from kinlab.formulas.text import FormulaFile, canonical
from kinlab.model.robot import Robot
from kinlab.symbolic.vocabulary import vocabulary

WRENCH = ("fx", "fy", "fz", "nx", "ny", "nz")
"""The names of a wrench's parts, in order."""
_SPELT = re.compile(r"([fFnNM])_?([xyz])")
_MOVING = re.compile(r"qdd?\d+|m\d+|g")


def with_forces(file: FormulaFile, robot: Robot) -> FormulaFile:
    """The file with fx for F_x, nz for M_z, where nothing else is called so.

    Args:
        file: the formulas.
        robot: whose they are.
    """
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
        if entry.startswith(("tau", "Q", "torque"))
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
