"""What to do with a derived expression: a fast function, LaTeX, or Python text."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from typing import Any

import numpy as np
import sympy
from numpy.typing import ArrayLike
from sympy.printing.numpy import NumPyPrinter

from kinlab.arrays import Array, shaped
from kinlab.symbolic.arm import SymbolicArm, values_at

Expression = Any
"""A sympy expression or matrix; sympy has no types that mypy could read."""


def to_function(
    arm: SymbolicArm, expression: Expression, changed: Mapping[str, float] | None = None
) -> Callable[..., Array]:
    """Compiles an expression to numpy with common subexpressions computed once.

    Args:
        arm: the arm it was derived from.
        expression: a scalar or a matrix.
        changed: other numbers for some parameters (name to value).

    Returns:
        ``f(q, qd, qdd)``; the arguments the expression does not use may be left out. It answers
        with the shape of the expression, a column of two or more as (n,).

    Raises:
        NameUnknownError: ``changed`` names no parameter.
    """
    numbers = values_at(arm, changed or {})
    scalar = not isinstance(expression, sympy.MatrixBase)
    grid = sympy.Matrix([[expression]]) if scalar else expression
    used = [s for s in numbers if s in grid.free_symbols]
    arguments = [*arm.q, *arm.qd, *arm.qdd, *used]
    compiled = sympy.lambdify(arguments, list(grid), modules="math", cse=True)
    fixed = [numbers[s] for s in used]
    shape: tuple[int, ...] = grid.shape[:1] if grid.rows > 1 == grid.cols else grid.shape
    shape = () if scalar else shape

    def function(q: ArrayLike, qd: ArrayLike | None = None, qdd: ArrayLike | None = None) -> Array:
        states = []
        for name, value in (("q", q), ("qd", qd), ("qdd", qdd)):
            given = np.zeros(arm.n) if value is None else value
            states += shaped(given, (arm.n,), f"table {arm.table.name!r}: {name}").tolist()
        return np.array(compiled(*states, *fixed), dtype=np.float64).reshape(shape)

    return function


def to_latex(expression: Expression) -> str:
    """LaTeX in the field's notation: \\dot q_1, \\theta-free, products without dots."""
    names: dict[Any, str] = {}
    for s in expression.free_symbols:
        head = s.name.rstrip("0123456789")
        index = s.name[len(head) :]
        dots = {"qd": r"\dot{q}", "qdd": r"\ddot{q}"}.get(head, head)
        base = dots if len(head) == 1 or head in ("qd", "qdd") else f"{head[0]}_{{{head[1:]}}}"
        if index and base.endswith("}") and head not in ("qd", "qdd"):
            names[s] = f"{head[0]}_{{{head[1:]}{index}}}"
        else:
            names[s] = f"{base}_{{{index}}}" if index else base
    text: str = sympy.latex(expression, symbol_names=names)
    return text


def to_python(arm: SymbolicArm, expression: Expression, name: str, arguments: int = 1) -> str:
    """A Python function with numpy as its only import.

    Args:
        arm: the arm it was derived from.
        expression: a scalar or a matrix.
        name: the function's name.
        arguments: how many of q, qd, qdd it takes at least, used or not.

    Returns:
        Source text that ends in a newline.
    """
    printer = NumPyPrinter({"fully_qualified_modules": False})
    scalar = not isinstance(expression, sympy.MatrixBase)
    grid = sympy.Matrix([[expression]]) if scalar else expression
    shared, (reduced,) = sympy.cse(grid, symbols=sympy.numbered_symbols("x"))
    lines = ["import numpy as np", "from numpy import cos, sin", "", ""]
    letters = [
        x for x in ("q", "qd", "qdd") if any(s in grid.free_symbols for s in getattr(arm, x))
    ]
    highest = max((len(x) for x in letters), default=1)
    taken = ("q", "qd", "qdd")[: max(arguments, highest)]
    lines.append(f"def {name}({', '.join(taken)}):")
    lines.append(f'    """Derived from the DH table {arm.table.name!r}; SI units, radians."""')
    for letter in letters:
        symbols = ", ".join(s.name for s in getattr(arm, letter))
        lines.append(f"    {symbols}{',' if arm.n == 1 else ''} = {letter}")
    for s, value in arm.parameters.items():
        if s in grid.free_symbols:
            lines.append(f"    {s.name} = {float(value)!r}")
    lines += [f"    {s.name} = {printer.doprint(e)}" for s, e in shared]
    entries = [[printer.doprint(reduced[r, c]) for c in range(grid.cols)] for r in range(grid.rows)]
    if scalar:
        lines.append(f"    return {entries[0][0]}")
    elif grid.cols == 1:
        lines.append(f"    return np.array([{', '.join(row[0] for row in entries)}])")
    else:
        lines.append("    return np.array([")
        lines += [f"        [{', '.join(row)}]," for row in entries]
        lines.append("    ])")
    return "\n".join(lines) + "\n"
