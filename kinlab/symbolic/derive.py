"""Derived formulas as text, by the letters of the textbooks."""

from __future__ import annotations

from collections.abc import Callable, Iterator
from typing import Any

import sympy

from kinlab.errors import NameUnknownError, OptionError, StructureError, near
from kinlab.model.library import load
from kinlab.symbolic import dynamics, kinematics
from kinlab.symbolic.arm import SymbolicArm, arm
from kinlab.symbolic.determinant import det_jacobian
from kinlab.symbolic.output import to_latex, to_python

FORMATS = ("text", "latex", "python")
_LARGEST = 3
"""Joints up to which M, C and tau are short enough to print."""


def _coefficients(a: SymbolicArm) -> Any:
    cube = dynamics.christoffel(a)
    return sympy.Matrix(
        [[cube[i][j][k] for j in range(a.n) for k in range(a.n)] for i in range(a.n)]
    )


WHAT: dict[str, Callable[[SymbolicArm], Any]] = {
    "fk": kinematics.fk,
    "J": kinematics.jacobian,
    "det": lambda a: det_jacobian(a).expression,
    "M": dynamics.mass_matrix,
    "C": dynamics.coriolis_matrix,
    "g": dynamics.gravity_torques,
    "tau": dynamics.inverse_dynamics,
    "D": _coefficients,
    "T": dynamics.kinetic_energy,
    "V": dynamics.potential_energy,
}
"""What can be derived. D has row i and columns jk = 11, 12, ... of D_ijk."""

_ARGUMENTS = {"C": 2, "T": 2, "tau": 3}
"""How many of q, qd, qdd a formula's function takes, also where an arm does not need them."""

_HEAVY = ("M", "C", "tau", "D", "T")


def derived_text(robot: str, what: str, form: str, numbers: bool, tool: str | None = None) -> str:
    """One formula of an arm as text.

    Args:
        robot: a name or path with a DH table.
        what: a key of :data:`WHAT`.
        form: ``"text"``, ``"latex"`` or ``"python"``.
        numbers: keep the table's numbers instead of names.
        tool: the tool's name, as for :func:`kinlab.load`.

    Raises:
        NameUnknownError: another robot, formula or format.
        StructureError: the robot has no DH table.
        OptionError: M, C or tau of more than four joints.
    """
    for given, known in ((what, tuple(WHAT)), (form, FORMATS)):
        if given not in known:
            raise NameUnknownError(f"derive: {given!r} is unknown; {near(given, known)}")
    table = load(robot, tool).table
    if table is None:
        named = "" if tool is None else f" --tool {tool}"
        raise StructureError(
            f"robot {robot!r} has no DH table to derive from (kinlab dh makes one: "
            f"kinlab dh {robot}{named} -o arm.toml)"
        )
    if what in _HEAVY and table.n > _LARGEST + 1:
        raise OptionError(
            f"{what} of {table.n} joints fills hundreds of pages; it is offered up to "
            f"{_LARGEST + 1} joints (fk, J, det, g and V: any number)"
        )
    made = arm(table, "none" if numbers else "all")
    expression = WHAT[what](made)
    if numbers:
        expression = _decimal(expression)
    if form == "python":
        return to_python(made, expression, what, _ARGUMENTS.get(what, 1)).rstrip()
    expression = _by_rates(made, expression)
    if form == "latex":
        return to_latex(expression)
    return "\n".join([*_lines(made, what, expression), *_where(made, expression)])


def _lines(made: SymbolicArm, what: str, expression: Any) -> Iterator[str]:
    """One line for each entry; that of a coefficient names all three of its indices."""
    if not isinstance(expression, sympy.MatrixBase):
        yield f"{what} = {sympy.sstr(expression, full_prec=False)}"
        return
    for r in range(expression.rows):
        for c in range(expression.cols):
            column = "" if what in ("g", "tau") else f"{c + 1}"
            if what == "D":
                column = f"{c // made.n + 1}{c % made.n + 1}"
            name = f"{what}{r + 1}{column}"
            yield f"{name} = {sympy.sstr(expression[r, c], full_prec=False)}"


def _where(made: SymbolicArm, expression: Any) -> list[str]:
    """What the names stand for in this table."""
    used = [
        f"{s.name} = {float(value):.12g}"
        for s, value in made.parameters.items()
        if s in expression.free_symbols
    ]
    return [f"where {', '.join(used)}"] if used else []


def _by_rates(made: SymbolicArm, expression: Any) -> Any:
    """Terms of the same acceleration or product of speeds put together, as textbooks do."""
    speeds = [one * other for k, one in enumerate(made.qd) for other in made.qd[k:]]
    rates = [*made.qdd, *speeds]
    if not expression.free_symbols & {*made.qdd, *made.qd}:
        return expression
    if isinstance(expression, sympy.MatrixBase):
        return expression.applyfunc(lambda entry: sympy.collect(entry, rates))
    return sympy.collect(expression, rates)


def _decimal(expression: Any) -> Any:
    """The decimal numbers of a table, which the derivation keeps as exact fractions."""
    fractions = (r for r in expression.atoms(sympy.Rational) if r.q > 1)
    return expression.xreplace({r: sympy.Float(float(r)) for r in fractions})
