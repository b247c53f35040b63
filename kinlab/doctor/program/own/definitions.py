"""Definitions as they are run in a trial: what prints is silent, what turns ends; classes too."""

from __future__ import annotations

import ast
import copy
from collections.abc import Iterable, Iterator, Sequence
from contextlib import contextmanager
from dataclasses import MISSING, Field
from types import FunctionType, MemberDescriptorType
from typing import Any

import numpy as np

from kinlab.doctor.bytecode.syntax import INSIDE, copied, names, nodes, shallow
from kinlab.doctor.program.own.plain import alike, closed


def _written(nodes_: Sequence[Any], values: Sequence[Any]) -> list[Any]:
    """Defaults that are numbers as they are, ``...`` for others; none if all are others."""
    if len(nodes_) != len(values):
        return []
    told = [(_literal(node), value) for node, value in zip(nodes_, values, strict=True)]
    same = [new is not None and type(new) is type(own) and new == own for new, own in told]
    pairs = zip(nodes_, same, strict=True)
    kept = any(same) or any(map(_is_mark, nodes_))
    return [n if own or _is_mark(n) else ast.Constant(...) for n, own in pairs] if kept else []


def _is_mark(node: ast.expr | None) -> bool:
    return node is None or (isinstance(node, ast.Name) and node.id == DEFAULT)


class ByDefault(ast.Assign):
    """Sets an argument that is not given to what it is by default."""


DEFAULT = "_default"
"""What stands for an argument that is not given: it is set in the first lines."""
_KNOWN = (
    *(ast.Name, ast.Attribute, ast.Subscript, ast.Constant, ast.UnaryOp, ast.BinOp, ast.Call),
    *(ast.Dict, ast.List, ast.Tuple, ast.expr_context, ast.operator, ast.unaryop),
)
"""Of what a default may be made that is reckoned anew in each call."""
_MAKING = ("array", "asarray", "diag", "eye", "zeros", "ones", "radians", "deg2rad")
"""What may be called for it."""


def with_defaults_inside(tree: ast.FunctionDef, function: FunctionType) -> ast.FunctionDef:
    """A definition that sets what is no plain number by default itself: ``l = LENGTHS``.

    Only where that is what the function has.
    """
    args = tree.args
    asked = [*args.posonlyargs, *args.args]
    named = function.__kwdefaults__ or {}
    plain = function.__defaults__ or ()
    if len(plain) != len(args.defaults):
        return tree
    last = zip(asked[len(asked) - len(plain) :], args.defaults, plain, strict=True)
    only = zip(args.kwonlyargs, args.kw_defaults, strict=True)
    every = [*last, *((arg, node, named.get(arg.arg)) for arg, node in only if node is not None)]
    inside = {
        id(node): _given(arg.arg, node)
        for arg, node, value in every
        if _literal(node) is None and _is(node, value, function)
    }
    if not inside:
        return tree
    own = shallow(tree)
    own.args = shallow(args)
    mark = ast.Name(DEFAULT, ast.Load())
    own.args.defaults = [mark if id(one) in inside else one for one in args.defaults]
    own.args.kw_defaults = [mark if id(one) in inside else one for one in args.kw_defaults]
    own.body = [*inside.values(), *tree.body]
    return ast.fix_missing_locations(own)


def _given(name: str, node: ast.expr) -> ByDefault:
    mark = ast.Compare(ast.Name(name, ast.Load()), [ast.Is()], [ast.Name(DEFAULT, ast.Load())])
    value = ast.IfExp(mark, node, ast.Name(name, ast.Load()))
    return ast.copy_location(ByDefault([ast.Name(name, ast.Store())], value), node)


def _is(node: ast.expr, value: Any, function: FunctionType) -> bool:
    """Whether a default is what its expression gives now."""
    made = [one for one in nodes(node) if isinstance(one, ast.Call)]
    if not all(isinstance(one, _KNOWN) for one in nodes(node)):
        return False
    if any(ast.unparse(one.func).rpartition(".")[2] not in _MAKING for one in made):
        return False
    try:
        code = compile(ast.fix_missing_locations(ast.Expression(node)), "<default>", "eval")
        now = eval(code, {**function.__globals__, **closed(function)})  # noqa: S307  names, numbers
    except Exception:  # noqa: BLE001  names that have gone
        return False
    return now is value or (value is not None and alike(now, value))


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


@contextmanager
def with_products(tree: ast.AST) -> Iterator[None]:
    """A tree with functions for ``@`` and ``@=``, as it is compiled."""
    spots: list[tuple[Any, Any]] = []
    every: list[Any] = [tree]
    known: set[int] = set()  # what edits leave of a statement hangs in each of its branches
    for node in every:
        fields = INSIDE[type(node)]
        if not fields or id(node) in known:
            continue
        known.add(id(node))
        inside = node.__dict__
        for name in fields:
            value = inside.get(name)
            if type(value) is list:
                every += value
                for k, one in enumerate(value):
                    if type(one) in _PRODUCTS and type(one.op) is ast.MatMult:
                        spots.append((value, k))
            elif value is not None:
                every.append(value)
                if type(value) in _PRODUCTS and type(value.op) is ast.MatMult:
                    spots.append((inside, name))
    kept = [holder[key] for holder, key in spots]
    calls = {id(one): _called(one) for one in kept}
    try:
        for (holder, key), one in zip(spots, kept, strict=True):
            holder[key] = calls[id(one)]
        for call in calls.values():
            given = call.value if isinstance(call, ast.Assign) else call
            if isinstance(given, ast.Call):
                given.args = [calls.get(id(one), one) for one in given.args]
        yield
    finally:
        for (holder, key), one in zip(spots, kept, strict=True):
            holder[key] = one


_PRODUCTS = frozenset((ast.BinOp, ast.AugAssign))


def _called(node: Any) -> Any:
    """A function for a product of matrices; for one in place of what has a name."""
    at = {name: getattr(node, name) for name in node._attributes}
    if isinstance(node, ast.BinOp):
        return ast.Call(ast.Name("_product", ast.Load(), **at), [node.left, node.right], [], **at)
    if not isinstance(node.target, ast.Name):
        return node
    given = [ast.Name(node.target.id, ast.Load(), **at), node.value]
    call = ast.Call(ast.Name("_multiplied", ast.Load(), **at), given, [], **at)
    return ast.Assign([node.target], call, **at)


_TELLING = ("print", "display", "debug", "info", "warning", "error", "critical", "warn")
"""Functions and methods that only tell something."""


class _Quiet(ast.NodeTransformer):
    def visit_Expr(self, node: ast.Expr) -> ast.stmt:
        called = node.value.func if isinstance(node.value, ast.Call) else None
        name = getattr(called, "id", None) or getattr(called, "attr", None)
        silent = name in _TELLING
        return ast.copy_location(ast.Pass(), node) if silent else node

    def visit_While(self, node: ast.While) -> ast.While:
        self.generic_visit(node)
        turn = ast.Call(ast.Name("_turn", ast.Load()), [], [])
        node.test = ast.BoolOp(ast.And(), [turn, node.test])
        return node


def class_like(owner: type) -> type:
    """A class like another, whose methods can be changed; what has slots keeps a dictionary."""
    own: dict[str, Any] = {}
    for name, value in vars(owner).items():
        if name == "__slots__" or isinstance(value, MemberDescriptorType):
            continue
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
            if isinstance(value, Field):  # a dataclass keeps what it is by default, if that
                value = value.default
            if value is MISSING:
                continue
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
    fields = getattr(owner, FIELDS).items()
    given = [name for name, f in fields if name in vars(owner) or f.default_factory is not MISSING]
    if not isinstance(init, FunctionType) or len(init.__defaults__ or ()) != len(given):
        return
    old = zip(given, init.__defaults__ or (), strict=True)
    values = tuple(vars(owner).get(name, default) for name, default in old)
    code, space, closure = init.__code__, init.__globals__, init.__closure__
    made = FunctionType(code, space, init.__name__, values, closure)
    made.__kwdefaults__ = init.__kwdefaults__
    owner.__init__ = made
