"""Numbers and angles written as text: ``"pi/2"``, ``"-90 deg"``, ``"sqrt(2)*0.3"``.

A small whitelist over Python's own syntax tree; nothing is ever evaluated as code.
"""

from __future__ import annotations

import ast
import math
import operator
from collections.abc import Callable

from kinlab.errors import ExpressionError

_MAX_LENGTH = 200
_CONSTANTS = {"pi": math.pi, "π": math.pi}
_FUNCTIONS: dict[str, Callable[[float], float]] = {
    "sqrt": math.sqrt,
    "sin": math.sin,
    "cos": math.cos,
    "tan": math.tan,
    "atan": math.atan,
    "acos": math.acos,
    "asin": math.asin,
}
_BINARY: dict[type[ast.operator], Callable[[float, float], float]] = {
    ast.Add: operator.add,
    ast.Sub: operator.sub,
    ast.Mult: operator.mul,
    ast.Div: operator.truediv,
}
_UNITS = {"deg": math.pi / 180.0, "°": math.pi / 180.0, "rad": 1.0}


def parse_number(value: object) -> float:
    """Reads a finite number, or an arithmetic expression of numbers and ``pi``.

    Args:
        value: a number, or text such as ``"0.15005"`` or ``"sqrt(2)/2"``.

    Returns:
        The value as a float.

    Raises:
        ExpressionError: not a number, not arithmetic, or not finite.
    """
    if isinstance(value, bool) or value is None:
        raise ExpressionError(f"{value!r} is not a number")
    if isinstance(value, str):
        return _finite(_evaluate(value), value)
    try:
        number = float(value)  # type: ignore[arg-type]
    except (TypeError, ValueError):
        raise ExpressionError(f"{value!r} is not a number") from None
    return _finite(number, value)


def parse_angle(value: object) -> float:
    """Reads an angle in radians; text may carry a unit, as in ``"-90 deg"`` or ``"45°"``.

    Args:
        value: a number of radians, or text.

    Returns:
        The angle in radians.

    Raises:
        ExpressionError: not a number, not arithmetic, or not finite.
    """
    if isinstance(value, str):
        text = value.strip()
        for unit, factor in _UNITS.items():
            if text.endswith(unit):
                return _finite(_evaluate(text.removesuffix(unit)) * factor, value)
    return parse_number(value)


def _finite(number: float, value: object) -> float:
    if not math.isfinite(number):
        raise ExpressionError(f"{value!r} is not finite")
    return number


def _evaluate(text: str) -> float:
    if len(text) > _MAX_LENGTH:
        raise ExpressionError(f"expression of {len(text)} characters; at most {_MAX_LENGTH}")
    try:
        tree = ast.parse(text.strip(), mode="eval")
        return _walk(tree.body, text)
    except (SyntaxError, RecursionError, MemoryError):
        message = f"cannot read {text!r}; write a number or arithmetic such as 'pi/2' or '-90 deg'"
        raise ExpressionError(message) from None
    except (ZeroDivisionError, OverflowError, ValueError) as error:
        if isinstance(error, ExpressionError):
            raise
        raise ExpressionError(f"cannot evaluate {text!r}: {error}") from None


def _walk(node: ast.expr, text: str) -> float:
    match node:
        case ast.Constant(value=int() | float() as number) if not isinstance(number, bool):
            return float(number)
        case ast.Name(id=name) if name in _CONSTANTS:
            return _CONSTANTS[name]
        case ast.UnaryOp(op=ast.USub(), operand=operand):
            return -_walk(operand, text)
        case ast.UnaryOp(op=ast.UAdd(), operand=operand):
            return _walk(operand, text)
        case ast.BinOp(left=left, op=op, right=right) if type(op) in _BINARY:
            return _BINARY[type(op)](_walk(left, text), _walk(right, text))
        case ast.Call(func=ast.Name(id=name), args=[argument], keywords=[]) if name in _FUNCTIONS:
            return _FUNCTIONS[name](_walk(argument, text))
    allowed = ", ".join([*_CONSTANTS, *_FUNCTIONS])
    raise ExpressionError(f"cannot read {text!r}: only numbers, + - * / ( ) and {allowed}")
