"""Definitions as they are run in a trial: what prints is silent, what turns ends; classes too."""

from __future__ import annotations

import ast
import copy
from collections.abc import Iterable, Sequence
from types import FunctionType
from typing import Any

import numpy as np

from kinlab.doctor.bytecode.syntax import copied, names, nodes


def _written(nodes_: Sequence[Any], values: Sequence[Any]) -> list[Any]:
    """Defaults that are numbers as they are, ``...`` for others; none if all are others."""
    if len(nodes_) != len(values):
        return []
    told = [(_literal(node), value) for node, value in zip(nodes_, values, strict=True)]
    same = [new is not None and type(new) is type(own) and new == own for new, own in told]
    pairs = zip(nodes_, same, strict=True)
    return [n if own or n is None else ast.Constant(...) for n, own in pairs] if any(same) else []


def _literal(node: ast.expr | None) -> Any:
    """A number, or a list or tuple of numbers, as it is written."""
    try:
        value = None if node is None else ast.literal_eval(node)
    except (ValueError, TypeError):
        return None
    flat = value if isinstance(value, list | tuple) else [value]
    plain = all(isinstance(one, int | float) and not isinstance(one, bool) for one in flat)
    return value if plain else None


def bounded(tree: ast.FunctionDef, function: FunctionType | None) -> ast.FunctionDef:
    """A copy that prints nothing and whose loops end.

    Args:
        tree: a definition.
        function: whose; None of the lines of a module.
    """
    own = copied(tree)
    for node in nodes(own) if function is None else ():
        if isinstance(node, ast.ClassDef):
            node.keywords = [ast.keyword("metaclass", ast.Name(META + node.name, ast.Load()))]
    own.returns = None
    if function is not None:
        plain, named = function.__defaults__ or (), function.__kwdefaults__ or {}
        only = [named.get(one.arg) for one in own.args.kwonlyargs]
        own.args.defaults = _written(own.args.defaults, plain)
        own.args.kw_defaults = _written(own.args.kw_defaults, only) or [None] * len(only)
    for name in (*own.args.posonlyargs, *own.args.args, *own.args.kwonlyargs):
        name.annotation = None
    _Quiet().visit(own)
    return ast.fix_missing_locations(own)


class _Quiet(ast.NodeTransformer):
    def visit_Expr(self, node: ast.Expr) -> ast.stmt:
        called = node.value.func if isinstance(node.value, ast.Call) else None
        silent = isinstance(called, ast.Name) and called.id in ("print", "display")
        return ast.copy_location(ast.Pass(), node) if silent else node

    def visit_While(self, node: ast.While) -> ast.While:
        self.generic_visit(node)
        turn = ast.Call(ast.Name("_turn", ast.Load()), [], [])
        node.test = ast.BoolOp(ast.And(), [turn, node.test])
        return node


def class_like(owner: type) -> type:
    """A class like another, whose methods can be changed."""
    own: dict[str, Any] = {}
    for name, value in vars(owner).items():
        data = isinstance(value, list | dict | np.ndarray) and name[:2] != "__"
        own[name] = copy.deepcopy(value) if data else value
    own.pop("__dict__", None)
    own.pop("__weakref__", None)
    return type(owner.__name__, owner.__bases__, own)


META = "_class_"
"""Before the name of a class: what its lines are given to."""
FIELDS = "__dataclass_fields__"
"""In a class that is a dataclass."""


class ClassBody:
    """In place of the class of a class: what its lines set is given to the class that is there."""

    def __init__(self, owner: type) -> None:
        self.owner = owner

    def __prepare__(self, _name: str, _bases: Any) -> dict[str, Any]:
        return {**vars(self.owner)}

    def __call__(self, _name: str, _bases: Any, space: dict[str, Any]) -> type:
        for name, value in space.items():
            if name[:2] != "__" and value is not vars(self.owner).get(name):
                setattr(self.owner, name, value)
        return self.owner


def names_by_class(trees: Iterable[ast.AST]) -> dict[str, set[str]]:
    """The names that the lines of classes set, by the classes' names."""
    found = [node for tree in trees for node in nodes(tree) if isinstance(node, ast.ClassDef)]
    return {node.name: {*names(ast.Module(node.body, []), ast.Store)} for node in found}


def with_defaults(owner: Any) -> None:
    """Gives the method that makes objects of a dataclass the defaults that stand in the class."""
    init = vars(owner)["__init__"]
    given = [name for name in getattr(owner, FIELDS) if name in vars(owner)]
    if not isinstance(init, FunctionType) or len(init.__defaults__ or ()) != len(given):
        return
    values = tuple(vars(owner)[name] for name in given)
    code, space, closure = init.__code__, init.__globals__, init.__closure__
    made = FunctionType(code, space, init.__name__, values, closure)
    made.__kwdefaults__ = init.__kwdefaults__
    owner.__init__ = made
