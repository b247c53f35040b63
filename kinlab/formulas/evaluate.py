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
from kinlab.formulas import tree
from kinlab.formulas.arithmetic import Meaning, read

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

    def value(name: str) -> Any:
        if name not in known:
            known[name] = meaning(name)
        return known[name]

    parts = combined(np.float64, value)
    with np.errstate(all="ignore"):
        result = read(ast.parse(text, mode="eval").body, parts)
    return np.array(np.broadcast_to(result, (count,)), dtype=float)


def combined(number: Callable[[int | float], Any], name: Callable[[str], Any]) -> Meaning[Any]:
    """Plain arithmetic of numbers and names.

    Args:
        number: the value of a literal.
        name: the values of a name; ``pi`` is the number.
    """
    return Meaning(
        number=number,
        name=lambda word: np.float64(math.pi) if word == "pi" else name(word),
        negative=operator.neg,
        binary=lambda op, left, right: _BINARY[type(op)](left, right),
        call=lambda word, args: tree.FUNCTIONS[tree.SYNONYMS.get(word, word)](*args),
        admit=lambda node, depth: None,
    )
