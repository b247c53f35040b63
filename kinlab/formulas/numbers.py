"""Numbers and angles written as text: ``"pi/2"``, ``"-90 deg"``, ``"sqrt(2)*0.3"``.

A small whitelist over Python's own syntax tree; nothing is ever evaluated as code.
"""

from __future__ import annotations

import ast
import math
import operator
import re
from collections.abc import Callable

import numpy as np

from kinlab.errors import ExpressionError
from kinlab.formulas.arithmetic import Meaning, is_arithmetic, read
from kinlab.tolerances import TOLERANCES

_MAX_LENGTH = 200
_CONSTANTS = {"pi": math.pi, "π": math.pi}


def _tan(angle: float) -> float:
    if abs(math.cos(angle)) < TOLERANCES.pole_of_tan:
        raise ValueError("the tangent of 90 deg has no value")
    return math.tan(angle)


_FUNCTIONS: dict[str, Callable[[float], float]] = {
    "sqrt": math.sqrt,
    "sin": math.sin,
    "cos": math.cos,
    "tan": _tan,
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

_TEXT = re.compile(
    r"(?:\s|[-+*/()]|(?:[0-9]+\.?[0-9]*|\.[0-9]+)(?:[eE][+-]?[0-9]+)?(?![0-9A-Za-z_.])|[A-Za-z]+|π)*",
    re.ASCII,
)
"""Decimal numbers, signs, brackets and words. Python's own comments, digits of other scripts,
``5_0``, ``0x10`` and ``2pi`` are none."""

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
    if isinstance(value, (bool, np.bool_)) or value is None:
        raise ExpressionError(f"{value!r} is not a number")
    if isinstance(value, str):
        return _finite(_evaluate(value), value)
    try:
        number = float(value)  # type: ignore[arg-type]
    except OverflowError:
        raise ExpressionError("a whole number too large to be held") from None
    except Exception:  # noqa: BLE001  whatever an object's own __float__ raises
        raise ExpressionError(f"{_shown(value)} is not a number") from None
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


def _shown(value: object) -> str:
    try:
        return repr(value)[:80]
    except Exception:  # noqa: BLE001  whatever an object's own __repr__ raises
        return type(value).__name__


def _evaluate(text: str) -> float:
    if len(text) > _MAX_LENGTH:
        raise ExpressionError(f"expression of {len(text)} characters; at most {_MAX_LENGTH}")
    if not _TEXT.fullmatch(text):
        raise ExpressionError(
            f"cannot read {text!r}; write a number or arithmetic such as 'pi/2' or '-90 deg'"
        )
    try:
        tree = ast.parse(text.strip(), mode="eval")
        return _read(tree.body, text)
    except (SyntaxError, RecursionError, MemoryError):
        message = f"cannot read {text!r}; write a number or arithmetic such as 'pi/2' or '-90 deg'"
        raise ExpressionError(message) from None
    except (ZeroDivisionError, OverflowError, ValueError) as error:
        if isinstance(error, ExpressionError):
            raise
        raise ExpressionError(f"cannot evaluate {text!r}: {error}") from None


def _read(node: ast.expr, text: str) -> float:
    def admit(part: ast.expr, depth: int) -> None:
        match part:
            case ast.Name(id=name) if name not in _CONSTANTS:
                known = False
            case ast.BinOp(op=op):
                known = type(op) in _BINARY
            case ast.Call(func=ast.Name(id=name), args=[_]) if name in _FUNCTIONS:
                known = is_arithmetic(part)
            case ast.Call():
                known = False
            case _:
                known = is_arithmetic(part)
        if not known:
            allowed = ", ".join([*_CONSTANTS, *_FUNCTIONS])
            raise ExpressionError(f"cannot read {text!r}: only numbers, + - * / ( ) and {allowed}")

    meaning: Meaning[float] = Meaning(
        number=float,
        name=lambda name: _CONSTANTS[name],
        negative=operator.neg,
        binary=lambda op, left, right: _BINARY[type(op)](left, right),
        call=lambda name, args: _FUNCTIONS[name](*args),
        admit=admit,
    )
    return read(node, meaning)
