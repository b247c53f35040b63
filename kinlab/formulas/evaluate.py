"""Plain evaluation of a formula's text as it is written: nothing opened, gathered or cancelled.

The trees of :mod:`kinlab.formulas.tree` are tidied as they are built; whether a formula agrees is
decided here, by the text itself, so that no tidying can ever decide it.
"""

from __future__ import annotations

import ast
import math
import operator
from collections.abc import Callable
from typing import Any

import numpy as np

from kinlab.arrays import Array

_BINARY: dict[type[ast.operator], Callable[[Any, Any], Any]] = {
    ast.Add: operator.add,
    ast.Sub: operator.sub,
    ast.Mult: operator.mul,
    ast.Div: operator.truediv,
    ast.Pow: lambda base, exponent: np.where(
        np.isnan(base),
        np.nan,
        np.power(base, exponent),  # numpy has nan**0 = 1
    ),
}
_FUNCTIONS: dict[str, Callable[..., Any]] = {
    "sin": np.sin, "cos": np.cos, "tan": np.tan, "sqrt": np.sqrt, "abs": np.abs, "exp": np.exp,
    "log": np.log, "sign": np.sign, "asin": np.arcsin, "acos": np.arccos, "atan": np.arctan,
    "atan2": np.arctan2, "arcsin": np.arcsin, "arccos": np.arccos, "arctan": np.arctan,
    "arctan2": np.arctan2, "ln": np.log, "Abs": np.abs,
}  # fmt: skip


def plain_values(text: str, meaning: Callable[[str], Array], count: int) -> Array:
    """The values of an expression that :func:`kinlab.formulas.text.parse` has accepted.

    Args:
        text: as that function leaves it, with ``**`` for powers.
        meaning: the values of a name, (count,).
        count: how many states.

    Returns:
        (count,); NaN or infinite where the text has no real value, whatever it is multiplied by.
    """
    known: dict[str, Array] = {}

    def value(node: ast.expr) -> Any:
        match node:
            case ast.Constant(value=number):
                return np.float64(number)  # type: ignore[arg-type]
            case ast.Name(id="pi"):
                return np.float64(math.pi)
            case ast.Name(id=name):
                if name not in known:
                    known[name] = meaning(name)
                return known[name]
            case ast.UnaryOp(op=ast.USub(), operand=operand):
                return -value(operand)
            case ast.UnaryOp(operand=operand):
                return value(operand)
            case ast.BinOp(left=left, op=op, right=right):
                return _BINARY[type(op)](value(left), value(right))
            case ast.Call(func=ast.Name(id=name), args=args):
                return _FUNCTIONS[name](*(value(part) for part in args))
        raise AssertionError(f"{type(node).__name__} was let through")  # pragma: no cover

    with np.errstate(all="ignore"):
        result = value(ast.parse(text, mode="eval").body)
    return np.array(np.broadcast_to(result, (count,)), dtype=float)
