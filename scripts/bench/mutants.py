"""Seeded slips of the pen in formulas, made on Python's syntax tree (nothing of the doctor's)."""

from __future__ import annotations

import ast
import random
import re
from collections.abc import Callable, Iterator, Mapping

import numpy as np

Site = tuple[ast.AST, ast.expr]
"""A node, and what stands there after the slip."""

INDEXED = re.compile(r"([A-Za-z]+)(\d)")


class _Swap(ast.NodeTransformer):
    def __init__(self, old: ast.AST, new: ast.expr) -> None:
        self.old, self.new = old, new

    def visit(self, node: ast.AST) -> ast.AST:
        return self.new if node is self.old else self.generic_visit(node)


def _sums(root: ast.AST) -> Iterator[ast.BinOp]:
    for node in ast.walk(root):
        if isinstance(node, ast.BinOp) and isinstance(node.op, ast.Add | ast.Sub):
            yield node


def _is_sum(node: ast.AST) -> bool:
    return isinstance(node, ast.BinOp) and isinstance(node.op, ast.Add | ast.Sub)


def _inside_calls(root: ast.AST) -> set[int]:
    return {id(below) for node in ast.walk(root) if isinstance(node, ast.Call)
            for argument in node.args for below in ast.walk(argument)}  # fmt: skip


def _terms(root: ast.Expression) -> Iterator[tuple[ast.BinOp | None, ast.expr]]:
    """The terms of every sum outside of function arguments, with the sum they are in."""
    inside = _inside_calls(root)
    if not _is_sum(root.body):
        yield None, root.body
    for node in _sums(root):
        if id(node) not in inside:
            yield from ((node, t) for t in (node.left, node.right) if not _is_sum(t))


def _times(factor: ast.expr, node: ast.expr) -> ast.BinOp:
    return ast.BinOp(factor, ast.Mult(), node)


def sign(root: ast.Expression, names: list[str]) -> Iterator[Site]:
    """One sign in front of a term."""
    inside = _inside_calls(root)
    for node in ast.walk(root):
        if isinstance(node, ast.UnaryOp) and isinstance(node.op, ast.USub):
            yield node, node.operand
    for node in _sums(root):
        if id(node) not in inside:
            other = ast.Add() if isinstance(node.op, ast.Sub) else ast.Sub()
            yield node, ast.BinOp(node.left, other, node.right)


def factor(root: ast.Expression, names: list[str]) -> Iterator[Site]:
    """A factor 2 or a half too many, or a 2 that is lost."""
    for _, term in _terms(root):
        yield term, _times(ast.Constant(2), term)
        yield term, ast.BinOp(term, ast.Div(), ast.Constant(2))
    for node in ast.walk(root):
        if (isinstance(node, ast.BinOp) and isinstance(node.op, ast.Mult)
                and isinstance(node.left, ast.Constant) and node.left.value == 2):  # fmt: skip
            yield node, node.right


def missing(root: ast.Expression, names: list[str]) -> Iterator[Site]:
    """A term left out."""
    for above, term in _terms(root):
        if above is None:
            continue
        if term is above.right:
            yield above, above.left
        elif isinstance(above.op, ast.Add):
            yield above, above.right
        else:
            yield above, ast.UnaryOp(ast.USub(), above.right)


def doubled(root: ast.Expression, names: list[str]) -> Iterator[Site]:
    """A term written twice."""
    for above, term in _terms(root):
        if above is not None and term is above.right:
            yield above, ast.BinOp(above, above.op, term)


def power(root: ast.Expression, names: list[str]) -> Iterator[Site]:
    """A square lost, or one too many."""
    inside = _inside_calls(root)
    bases = set()
    for node in ast.walk(root):
        if isinstance(node, ast.BinOp) and isinstance(node.op, ast.Pow):
            bases.add(id(node.left))
            yield node, node.left
    for node in ast.walk(root):
        free = isinstance(node, ast.Name) and id(node) not in inside | bases
        if free and node.id not in ("sin", "cos"):
            yield node, ast.BinOp(node, ast.Pow(), ast.Constant(2))


def sine(root: ast.Expression, names: list[str]) -> Iterator[Site]:
    """Sine for cosine and back."""
    other = {"sin": "cos", "cos": "sin"}
    for node in ast.walk(root):
        if isinstance(node, ast.Call) and isinstance(node.func, ast.Name):
            yield node, ast.Call(ast.Name(other[node.func.id]), node.args, [])


def argument(root: ast.Expression, names: list[str]) -> Iterator[Site]:
    """q2 for q1 + q2, and q1 + q2 for q2."""
    angles = [n for n in names if re.fullmatch(r"q\d", n)]
    for node in ast.walk(root):
        if not isinstance(node, ast.Call):
            continue
        inner = node.args[0]
        if _is_sum(inner):
            assert isinstance(inner, ast.BinOp)
            parts: list[ast.expr] = [inner.left, inner.right]
        elif isinstance(inner, ast.Name):
            k = int(inner.id[1])
            near = [n for n in angles if abs(int(n[1]) - k) == 1]
            parts = [ast.BinOp(ast.Name(n), ast.Add(), inner) for n in near]
        else:
            continue
        for part in parts:
            yield node, ast.Call(node.func, [part], [])


def order(root: ast.Expression, names: list[str]) -> Iterator[Site]:
    """A velocity for an acceleration and back, where the quantity depends on both."""
    for node in ast.walk(root):
        if isinstance(node, ast.Name) and "qdd1" in names:
            if node.id.startswith("qdd"):
                yield node, ast.Name("qd" + node.id[3:])
            elif node.id.startswith("qd"):
                yield node, ast.Name("qdd" + node.id[2:])


def index(root: ast.Expression, names: list[str]) -> Iterator[Site]:
    """m1 for m2, qd1 for qd2."""
    inside = _inside_calls(root)
    for node in ast.walk(root):
        found = INDEXED.fullmatch(node.id) if isinstance(node, ast.Name) else None
        if found is None or id(node) in inside:
            continue
        for other in names:
            alike = INDEXED.fullmatch(other)
            if alike and alike.group(1) == found.group(1) and other != node.id:  # type: ignore[attr-defined]
                yield node, ast.Name(other)


def lost(root: ast.Expression, names: list[str]) -> Iterator[Site]:
    """A factor left out."""
    for node in ast.walk(root):
        if isinstance(node, ast.BinOp) and isinstance(node.op, ast.Mult):
            for one, other in ((node.left, node.right), (node.right, node.left)):
                if isinstance(one, ast.Name | ast.Call):
                    yield node, other


RULES: dict[str, Callable[[ast.Expression, list[str]], Iterator[Site]]] = {
    "sign": sign, "factor 2 or 1/2": factor, "missing term": missing, "doubled term": doubled,
    "power": power, "sin/cos": sine, "wrong argument": argument,
    "velocity for acceleration": order, "wrong index": index, "missing factor": lost,
}  # fmt: skip


def mutate(text: str, rule: str, names: list[str], others: list[str],
           rng: random.Random) -> str | None:  # fmt: skip
    """The text with one slip of a class, or None where it has no place for it.

    ``others`` are terms from elsewhere, for the class ``"extra term"``.
    """
    if rule == "extra term":
        term = rng.choice(others) if others else None
        return f"{text} {rng.choice('+-')} {term}" if term else None
    count = len(list(RULES[rule](ast.parse(text, mode="eval"), names)))
    return _slipped(text, rule, names, rng.randrange(count)) if count else None


def every(text: str, rule: str, names: list[str]) -> Iterator[str]:
    """The text with each slip of a class."""
    for k in range(len(list(RULES[rule](ast.parse(text, mode="eval"), names)))):
        yield _slipped(text, rule, names, k)


def _slipped(text: str, rule: str, names: list[str], k: int) -> str:
    root = ast.parse(text, mode="eval")
    old, new = list(RULES[rule](root, names))[k]
    return ast.unparse(_Swap(old, new).visit(root)).replace(" ** ", "**").replace(" * ", "*")


def rewritten(text: str, rng: random.Random) -> str:
    """The same value in another form: terms and factors shuffled and grouped, identities used."""
    root = ast.parse(text, mode="eval")
    return ast.unparse(ast.fix_missing_locations(_Rewrite(rng).visit(root)))


class _Rewrite(ast.NodeTransformer):
    def __init__(self, rng: random.Random) -> None:
        self.rng = rng

    def visit_BinOp(self, node: ast.BinOp) -> ast.expr:
        left, right = self.visit(node.left), self.visit(node.right)
        if isinstance(node.op, ast.Pow):
            if self.rng.random() < 0.4 and getattr(node.right, "value", 0) == 2:
                return _times(left, left)
            return ast.BinOp(left, node.op, right)
        if isinstance(node.op, ast.Add | ast.Mult) and self.rng.random() < 0.5:
            left, right = right, left
        if isinstance(node.op, ast.Sub) and self.rng.random() < 0.3:
            return ast.BinOp(ast.UnaryOp(ast.USub(), right), ast.Add(), left)
        if isinstance(node.op, ast.Mult) and _is_sum(left) and self.rng.random() < 0.4:
            assert isinstance(left, ast.BinOp)
            return ast.BinOp(_times(left.left, right), left.op, _times(left.right, right))
        return ast.BinOp(left, node.op, right)

    def visit_Call(self, node: ast.Call) -> ast.expr:
        assert isinstance(node.func, ast.Name)
        inner, name, pick = node.args[0], node.func.id, self.rng.random()
        if isinstance(inner, ast.BinOp) and isinstance(inner.op, ast.Add) and pick < 0.5:
            a, b = inner.left, inner.right
            sin = lambda x: ast.Call(ast.Name("sin"), [x], [])  # noqa: E731
            cos = lambda x: ast.Call(ast.Name("cos"), [x], [])  # noqa: E731
            if name == "cos":
                return ast.BinOp(_times(cos(a), cos(b)), ast.Sub(), _times(sin(a), sin(b)))
            return ast.BinOp(_times(sin(a), cos(b)), ast.Add(), _times(cos(a), sin(b)))
        half = ast.BinOp(inner, ast.Div(), ast.Constant(2))
        if pick < 0.15:
            wave = ast.Call(ast.Name("sin"), [half], [])
            if name == "cos":
                square = ast.BinOp(wave, ast.Pow(), ast.Constant(2))
                return ast.BinOp(ast.Constant(1), ast.Sub(), _times(ast.Constant(2), square))
            return _times(_times(ast.Constant(2), wave), ast.Call(ast.Name("cos"), [half], []))
        return node


_OPERATORS = {ast.Add: np.add, ast.Sub: np.subtract, ast.Mult: np.multiply, ast.Div: np.divide,
              ast.Pow: np.power}  # fmt: skip


def value(text: str, at: Mapping[str, np.ndarray]) -> np.ndarray:
    """The value of a formula; the bench's own arithmetic, beside the doctor's."""

    def of(node: ast.expr) -> np.ndarray:
        match node:
            case ast.Constant(value=number):
                return np.float64(number)
            case ast.Name(id=name):
                return at[name]
            case ast.UnaryOp(op=op, operand=operand):
                return -of(operand) if isinstance(op, ast.USub) else of(operand)
            case ast.BinOp(left=left, op=op, right=right):
                return _OPERATORS[type(op)](of(left), of(right))
            case ast.Call(func=ast.Name(id=name), args=[inner]):
                return {"sin": np.sin, "cos": np.cos, "sqrt": np.sqrt}[name](of(inner))
        raise ValueError(ast.dump(node))

    return of(ast.parse(text, mode="eval").body)
