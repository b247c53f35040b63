"""A row that cannot fail is a defect: one sign or one factor changed anywhere is caught.

Every function of the notes is changed at one place at a time: a plus for a minus, a minus sign
dropped, sin for cos, a factor of 2 made 3. The rows of the catalogue must notice each change.
"""

from __future__ import annotations

import ast
import copy
import importlib
import inspect
import textwrap
from dataclasses import dataclass
from functools import cache
from types import FunctionType
from typing import Any

import numpy as np
import pytest

from kinlab.check.catalogue import NOTES, catalogue, plan
from kinlab.check.compare import relative_errors
from kinlab.check.quantities.registry import quantity

HELPERS = ("kinlab.notes.arm", "kinlab.notes.loop")
TELLING = ("stanford", "spatial3r", "panda", "planar2r", "planar2r_rods", "planar3r", "single_link")
SAMPLES = 12


@dataclass
class Trial:
    """A formula on a robot with the engine's answer, ready to be run again and again."""

    function: Any
    module: str
    numbers: Any
    states: tuple[np.ndarray, ...]
    engine: np.ndarray
    scale: float

    def fails(self) -> bool:
        try:
            with np.errstate(all="ignore"):
                hand = np.asarray(self.function(self.numbers, *(s.copy() for s in self.states)))
        except (ArithmeticError, IndexError, ValueError, TypeError, np.linalg.LinAlgError):
            return True
        if hand.shape != self.engine.shape:
            return True
        errors = relative_errors(hand, self.engine, self.scale)
        return bool(np.max(errors) > 1e-9)


@cache
def trials() -> tuple[Trial, ...]:
    found = []
    for record in catalogue():
        names = [name for _, name in plan([record])]
        wanted = sorted(names, key=lambda n: TELLING.index(n) if n in TELLING else 99)[:3]
        known = quantity(record.quantity)
        for name in wanted:
            mechanism = known.domain.load(name)
            states = known.states(mechanism, SAMPLES, 1)
            found.append(
                Trial(
                    record.function, record.function.__module__, known.domain.numbers(mechanism),
                    states, np.asarray(known.engine(mechanism, *states), dtype=float), known.scale,
                )
            )  # fmt: skip
    return tuple(found)


class Changes(ast.NodeTransformer):
    """Counts the places, and changes the one numbered ``at``."""

    def __init__(self, at: int) -> None:
        self.at, self.count, self.what = at, 0, ""

    def _here(self, what: str) -> bool:
        self.count += 1
        if self.count - 1 == self.at:
            self.what = what
            return True
        return False

    def visit_Subscript(self, node: ast.Subscript) -> ast.AST:
        node.value = self.visit(node.value)  # an index is no formula
        return node

    def visit_BinOp(self, node: ast.BinOp) -> ast.AST:
        self.generic_visit(node)
        line = node.lineno
        if isinstance(node.op, ast.Add) and self._here(f"line {line}: + for -"):
            node.op = ast.Sub()
        elif isinstance(node.op, ast.Sub) and self._here(f"line {line}: - for +"):
            node.op = ast.Add()
        elif isinstance(node.op, (ast.Mult, ast.Div)):
            for side in ("left", "right"):
                value = getattr(node, side)
                number = isinstance(value, ast.Constant) and isinstance(value.value, (int, float))
                if number and self._here(f"line {line}: factor {value.value}"):
                    setattr(node, side, ast.Constant(value.value * 1.5))
        return node

    def visit_Call(self, node: ast.Call) -> ast.AST:
        node.func = self.visit(node.func)
        node.args = [value if _is_axis(value) else self.visit(value) for value in node.args]
        for keyword in node.keywords:
            keyword.value = keyword.value if keyword.arg == "axis" else self.visit(keyword.value)
        return node

    def visit_UnaryOp(self, node: ast.UnaryOp) -> ast.AST:
        self.generic_visit(node)
        if isinstance(node.op, ast.USub) and self._here(f"line {node.lineno}: minus dropped"):
            return node.operand
        return node

    def visit_Attribute(self, node: ast.Attribute) -> ast.AST:
        self.generic_visit(node)
        swap = {"sin": "cos", "cos": "sin"}
        if node.attr in swap and self._here(f"line {node.lineno}: {node.attr}"):
            node.attr = swap[node.attr]
        return node

    def visit_FunctionDef(self, node: ast.FunctionDef) -> ast.AST:
        node.body = [self.visit(statement) for statement in node.body]
        return node


def _is_axis(value: ast.expr) -> bool:
    """Whether an argument is a bare negative number: the number of an axis, no formula."""
    return isinstance(value, ast.UnaryOp) and isinstance(value.operand, ast.Constant)


def mutants(function: FunctionType):
    """(what was changed, code) for each place of a function."""
    tree = ast.parse(textwrap.dedent(inspect.getsource(function)))
    definition = tree.body[0]
    assert isinstance(definition, ast.FunctionDef)
    definition.decorator_list, definition.args.defaults = [], []
    definition.args.kw_defaults = [None] * len(definition.args.kwonlyargs)
    definition.returns = None
    at = 0
    while True:
        changes, changed = Changes(at), copy.deepcopy(tree)
        changed = ast.fix_missing_locations(changes.visit(changed))
        if at >= changes.count:
            return
        scope = dict(function.__globals__)
        exec(compile(changed, "<mutant>", "exec"), scope)  # noqa: S102
        yield changes.what, scope[function.__name__].__code__
        at += 1


def hand_functions():
    """Every function of the notes that stands behind a corrected form."""
    printed = {record.printed.function for record in catalogue() if record.printed}
    for name in (*NOTES, *HELPERS):
        module = importlib.import_module(name)
        for value in vars(module).values():
            own = isinstance(value, FunctionType) and value.__module__ == name
            if own and value not in printed and "printed" not in value.__name__:
                yield pytest.param(value, id=f"{name.rsplit('.', 1)[1]}.{value.__name__}")


@pytest.mark.parametrize("function", list(hand_functions()))
def test_one_sign_or_factor_changed_is_caught(function):
    order = sorted(
        trials(),
        key=lambda t: (t.function is not function, t.module != function.__module__),
    )
    unnoticed = []
    for what, code in mutants(function):
        kept = function.__code__
        function.__code__ = code
        try:
            caught = any(trial.fails() for trial in order)
        finally:
            function.__code__ = kept
        if not caught:
            unnoticed.append(what)
    assert unnoticed == []


def test_unchanged_formulas_pass_the_same_trials():
    assert not [t.function.__name__ for t in trials() if t.fails()]


@pytest.mark.parametrize("change", [lambda x: -x, lambda x: 1.01 * x, lambda x: x + 1e-3])
def test_changed_answers_are_caught(change):
    for trial in trials():
        hand = np.asarray(trial.function(trial.numbers, *trial.states))
        errors = relative_errors(change(hand), trial.engine, trial.scale)
        nothing_to_see = not np.any(hand) and not np.any(change(hand))
        assert nothing_to_see or np.max(errors) > 1e-6, trial.function.__name__
