"""Formulas as small trees that keep the writer's own form, so that a repair can point at it.

sympy would rearrange what the user wrote; here ``(m1 + m2)*l1**2`` stays a product of a sum.
"""

from __future__ import annotations

import math
from collections.abc import Iterator, Mapping
from dataclasses import dataclass
from fractions import Fraction
from functools import reduce
from typing import Any

import numpy as np
import sympy

from kinlab.arrays import Array

FUNCTIONS = {
    "sin": np.sin,
    "cos": np.cos,
    "tan": np.tan,
    "sqrt": np.sqrt,
    "atan2": np.arctan2,
    "asin": np.arcsin,
    "acos": np.arccos,
    "atan": np.arctan,
    "abs": np.abs,
    "exp": np.exp,
    "log": np.log,
    "sign": np.sign,
}
SYNONYMS = {
    "arcsin": "asin",
    "arccos": "acos",
    "arctan": "atan",
    "arctan2": "atan2",
    "Abs": "abs",
    "ln": "log",
}
"""Other names that people write for these functions."""

Path = tuple[int, ...]
"""Way from the root: which child to take at each level."""


@dataclass(frozen=True)
class Node:
    """One node of a formula.

    Attributes:
        op: ``"num"``, ``"sym"``, ``"add"``, ``"mul"``, ``"pow"``, or a name in :data:`FUNCTIONS`.
        args: the children.
        value: the number, the name, or the constant exponent.
    """

    op: str
    args: tuple[Node, ...] = ()
    value: Any = None

    @property
    def terms(self) -> tuple[Node, ...]:
        """The terms of a sum; of anything else itself."""
        return self.args if self.op == "add" else (self,)

    @property
    def factors(self) -> tuple[Node, ...]:
        """The factors of a product; of anything else itself."""
        return self.args if self.op == "mul" else (self,)

    def __str__(self) -> str:
        return to_text(self)


def num(value: Any) -> Node:
    """A number."""
    return Node("num", value=Fraction(value))


def sym(name: str) -> Node:
    """A name."""
    return Node("sym", value=name)


def add(*args: Node) -> Node:
    """A sum; sums inside it are opened, zeros go."""
    flat = [term for a in args for term in a.terms]
    flat = [a for a in flat if not (a.op == "num" and a.value == 0)]
    if not flat:
        return num(0)
    return flat[0] if len(flat) == 1 else Node("add", tuple(flat))


def mul(*args: Node) -> Node:
    """A product; products inside it are opened, numbers are gathered in front.

    Zero times what may have no real value (log(q1), 1/q1) stays as it is.
    """
    flat = [factor for a in args for factor in a.factors]
    factor = reduce(lambda x, y: x * y, (a.value for a in flat if a.op == "num"), Fraction(1))
    rest = [a for a in flat if a.op != "num"]
    if factor == 0 and all(everywhere(a) for a in rest):
        return num(0)
    if factor != 1 or not rest:
        rest = [num(factor), *rest]
    return rest[0] if len(rest) == 1 else Node("mul", tuple(rest))


def power(base: Node, exponent: Fraction) -> Node:
    """A power with a constant exponent.

    Powers of powers are joined where both exponents are whole: (x**2)**(1/2) is not x, and
    (x**(1/2))**2 is x only where x is not negative.
    """
    if exponent == 1:
        return base
    if exponent == 0 and everywhere(base):
        return num(1)
    if base.op == "pow" and base.value.denominator == exponent.denominator == 1 and exponent:
        return power(base.args[0], base.value * exponent)
    if base.op == "num" and exponent.denominator == 1 and (base.value or exponent > 0):
        return num(base.value ** int(exponent))
    return Node("pow", (base,), exponent)


def everywhere(node: Node) -> bool:
    """Whether a tree surely has a real value for all real values of its names."""
    if node.op == "pow" and (node.value.denominator != 1 or node.value < 0):
        return False
    if node.op in ("tan", "asin", "acos", "log", "sqrt", "exp"):
        return False
    return all(everywhere(a) for a in node.args)


def call(name: str, *args: Node) -> Node:
    """A function of :data:`FUNCTIONS`."""
    return Node(name, args)


def evaluate(node: Node, at: Mapping[str, Array]) -> Array:
    """Value of the tree where each name has a stack of numbers."""
    if node.op == "num":
        return np.asarray(float(node.value))
    if node.op == "sym":
        return at[node.value]
    return combine(node, [evaluate(a, at) for a in node.args])


def combine(node: Node, values: list[Array]) -> Array:
    """Value of a node from its children's values."""
    if node.op == "add":
        return reduce(np.add, values)
    if node.op == "mul":
        return reduce(np.multiply, values)
    if node.op == "pow":
        with np.errstate(divide="ignore", invalid="ignore"):
            if node.value.denominator == 1:
                return np.asarray(values[0] ** float(node.value))
            return np.power(values[0], float(node.value))
    with np.errstate(divide="ignore", invalid="ignore", over="ignore"):
        result: Array = FUNCTIONS[node.op](*values)
    return result


def nodes(root: Node) -> Iterator[tuple[Path, Node]]:
    """Every node with its path, parents first."""
    waiting: list[tuple[Path, Node]] = [((), root)]
    while waiting:
        path, node = waiting.pop()
        yield path, node
        waiting += [((*path, k), child) for k, child in enumerate(node.args)]


def at_path(root: Node, path: Path) -> Node:
    """The node there."""
    return reduce(lambda node, k: node.args[k], path, root)


def replaced(root: Node, path: Path, new: Node) -> Node:
    """The tree with another node there."""
    if not path:
        return new
    args = list(root.args)
    args[path[0]] = replaced(args[path[0]], path[1:], new)
    return rebuilt(root, args)


def rebuilt(node: Node, args: list[Node]) -> Node:
    """The node with other children, tidied."""
    if node.op == "add":
        return add(*args)
    if node.op == "mul":
        return mul(*args)
    if node.op == "pow":
        return power(args[0], node.value)
    return Node(node.op, tuple(args), node.value)


def names(root: Node) -> set[str]:
    """The names in a tree."""
    return {node.value for _, node in nodes(root) if node.op == "sym"}


def renamed(root: Node, mapping: Mapping[str, Node]) -> Node:
    """The tree with names replaced by other trees."""
    if root.op == "sym":
        return mapping.get(root.value, root)
    if not root.args:
        return root
    return rebuilt(root, [renamed(a, mapping) for a in root.args])


def from_sympy(expression: sympy.Expr) -> Node:
    """A derived expression as a tree."""
    if expression.is_Rational:
        return num(Fraction(int(expression.p), int(expression.q)))
    if expression.is_Symbol:
        return sym(expression.name)
    if expression.is_Pow and expression.exp.is_Rational:
        exponent = Fraction(int(expression.exp.p), int(expression.exp.q))
        return power(from_sympy(expression.base), exponent)
    args = [from_sympy(a) for a in expression.args]
    if expression.is_Add:
        return add(*sorted(args, key=_term_order))
    if expression.is_Mul:
        return mul(*sorted(args, key=_factor_order))
    return call(type(expression).__name__, *args)


def ordered(node: Node) -> Node:
    """A product with its factors in the textbooks' order; anything else as it is."""
    return mul(*sorted(node.args, key=_factor_order)) if node.op == "mul" else node


_HEADS = ("I", "m", "g", "l", "a", "d", "x", "y", "z", "c")


def _factor_order(factor: Node) -> tuple[int, int, str]:
    """Masses, lengths, sines and cosines, then speeds: the order of the textbooks."""
    text = to_text(factor)
    if names(factor) and all(name.startswith("qd") for name in names(factor)):
        return 3, 0, text
    if factor.op in FUNCTIONS:
        return 2, 0, text
    head = _HEADS.index(text[0]) if text[0] in _HEADS else len(_HEADS)
    return (0, 0, text) if factor.op == "num" else (1, head, text)


def _term_order(term: Node) -> tuple[int, str]:
    """Accelerations first, then speeds, then the rest."""
    found = names(term)
    rates = 0 if any(n.startswith("qdd") for n in found) else 1
    rates = rates if rates == 0 or any(n.startswith("qd") for n in found) else 2
    text = to_text(term).lstrip("-")
    last = sorted(n for n in found if n.startswith("qd"))
    return rates, " ".join(last) + text


def to_text(node: Node) -> str:
    """Python text, in the order the tree has."""
    if node.op == "num":
        return _number(node.value)
    if node.op == "sym":
        return str(node.value)
    if node.op == "add":
        text = to_text(node.args[0])
        for child in node.args[1:]:
            piece = to_text(child)
            text += f" - {piece[1:]}" if piece.startswith("-") else f" + {piece}"
        return text
    if node.op == "mul":
        return _product(node)
    if node.op == "pow":
        base = to_text(node.args[0])
        base = f"({base})" if node.args[0].op in ("add", "mul", "pow", "num") else base
        exponent = _number(node.value)
        return f"{base}**({exponent})" if node.value.denominator > 1 else f"{base}**{exponent}"
    return f"{node.op}({', '.join(to_text(a) for a in node.args)})"


def _product(node: Node) -> str:
    above, below, sign = [], [], ""
    for child in node.args:
        if child.op == "num" and child.value < 0:
            sign, child = "-", num(-child.value)
            if child.value == 1:
                continue
        if child.op == "pow" and child.value == -1:
            below.append(_wrapped(child.args[0], ("add", "mul")))
        elif child.op == "num" and child.value.denominator > 1 and not _short(child.value):
            above += [str(child.value.numerator)] if child.value.numerator != 1 else []
            below.append(str(child.value.denominator))
        else:
            above.append(_wrapped(child, ("add",)))
    return sign + ("*".join(above) or "1") + "".join(f"/{b}" for b in below)


def _wrapped(node: Node, ops: tuple[str, ...]) -> str:
    text = to_text(node)
    return f"({text})" if node.op in ops else text


def _short(value: Fraction) -> bool:
    """Whether a fraction is a decimal as people write it: 9.81, 0.25."""
    return value.denominator > 12 and math.isclose(float(f"{float(value):.12g}"), value)


def _number(value: Fraction) -> str:
    if value.denominator == 1 or not _short(value):
        return str(value)
    return f"{float(value):.12g}"
