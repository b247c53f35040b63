"""Programs of plain arithmetic: nothing in them reaches anything but their own numbers.

A list of what is allowed, not of what is forbidden: kinds of statements, builtins, functions of
numpy and math, attributes. No attribute is set, so that numpy stays what it is.
"""

from __future__ import annotations

import ast
import builtins
import math
from typing import Any

import numpy as np

_BUILTINS = [
    "abs", "all", "any", "bool", "complex", "dict", "enumerate", "float", "int", "len",
    "list", "map", "max", "min", "pow", "print", "range", "reversed", "round", "set",
    "sorted", "sum", "tuple", "zip",
]  # fmt: skip
_NUMPY = [
    "abs", "absolute", "acos", "add", "allclose", "amax", "amin", "append", "arange",
    "arccos", "arcsin", "arctan", "arctan2", "array", "asarray", "asin", "atan", "atan2",
    "atleast_1d", "atleast_2d", "block", "ceil", "clip", "column_stack", "concatenate",
    "copy", "cos", "cosh", "cross", "cumsum", "deg2rad", "degrees", "det", "diag", "divide",
    "dot", "e", "einsum", "empty", "exp", "eye", "fabs", "flip", "float64", "floor", "full",
    "hstack", "hypot", "identity", "inf", "inner", "insert", "inv", "isclose", "kron",
    "linalg", "linspace", "log", "lstsq", "matmul", "max", "maximum", "mean", "min",
    "minimum", "mod", "multiply", "negative", "newaxis", "norm", "ones", "ones_like",
    "outer", "pi", "pinv", "power", "prod", "rad2deg", "radians", "ravel", "repeat",
    "reshape", "round", "sign", "sin", "sinh", "solve", "sqrt", "square", "squeeze",
    "stack", "subtract", "sum", "tan", "tanh", "tile", "trace", "transpose", "tril", "triu",
    "vdot", "vstack", "where", "zeros", "zeros_like",
]  # fmt: skip
_METHODS = [
    "T", "append", "copy", "dot", "extend", "flatten", "get", "index", "items", "keys",
    "ndim", "shape", "size", "tolist", "values",
]  # fmt: skip
_MATH = [name for name in vars(math) if name[:1] != "_"]
_ATTRIBUTES = {*_NUMPY, *_MATH, *_METHODS}
_MODULES: dict[str, tuple[Any, list[str]]] = {
    "numpy": (np, _NUMPY),
    "numpy.linalg": (np.linalg, _NUMPY),
    "math": (math, _MATH),
}
_NODES = (
    ast.mod | ast.expr_context | ast.boolop | ast.operator | ast.unaryop | ast.cmpop
    | ast.arguments | ast.arg | ast.keyword | ast.comprehension | ast.alias
    | ast.FunctionDef | ast.Return | ast.Assign | ast.AugAssign | ast.AnnAssign | ast.For
    | ast.While | ast.If | ast.Expr | ast.Pass | ast.Break | ast.Continue | ast.Assert
    | ast.Import | ast.ImportFrom
    | ast.BoolOp | ast.BinOp | ast.UnaryOp | ast.Lambda | ast.IfExp | ast.Dict | ast.Set
    | ast.ListComp | ast.SetComp | ast.DictComp | ast.GeneratorExp | ast.Compare | ast.Call
    | ast.Constant | ast.Attribute | ast.Subscript | ast.Starred | ast.Name | ast.List
    | ast.Tuple | ast.Slice | ast.JoinedStr | ast.FormattedValue
)  # fmt: skip


def space_of(program: str, file: str) -> dict[str, Any]:
    """What a program defines, run with these builtins and modules only.

    Args:
        program: its text.
        file: what its code is said to be from.

    Raises:
        ValueError: it is more than plain arithmetic.
    """
    tree = ast.parse(program)
    space: dict[str, Any] = {
        "__name__": "submission",
        "__builtins__": {name: getattr(builtins, name) for name in _BUILTINS},
    }
    for node in ast.walk(tree):
        if not _allowed(node):
            raise ValueError(type(node).__name__)
    own: list[ast.stmt] = []
    for statement in tree.body:
        if isinstance(statement, ast.Import | ast.ImportFrom):
            space |= _imported(statement)
        else:
            own.append(statement)
    inner = [node for one in own for node in ast.walk(one)]
    if any(isinstance(node, ast.Import | ast.ImportFrom) for node in inner):
        raise ValueError("import")
    tree.body = own
    exec(compile(tree, file, "exec"), space)  # noqa: S102
    return space


def _allowed(node: ast.AST) -> bool:
    if isinstance(node, ast.Attribute):
        return isinstance(node.ctx, ast.Load) and node.attr in _ATTRIBUTES
    if isinstance(node, ast.FunctionDef):
        return not node.decorator_list and node.name[:1] != "_"
    if isinstance(node, ast.Name):
        return node.id[:1] != "_" or node.id == "_"
    return isinstance(node, _NODES)


def _imported(statement: ast.Import | ast.ImportFrom) -> dict[str, Any]:
    found: dict[str, Any] = {}
    for alias in statement.names:
        if isinstance(statement, ast.Import):
            module, _names = _module(alias.name)
            name = alias.asname or alias.name.partition(".")[0]
            found[name] = module if alias.asname else _module(name)[0]
            continue
        module, known = _module(statement.module or "")
        if alias.name == "*" and module is math:
            found |= {name: getattr(math, name) for name in _MATH}
        elif alias.name in known and hasattr(module, alias.name):
            found[alias.asname or alias.name] = getattr(module, alias.name)
        else:
            raise ValueError(alias.name)
    return found


def _module(name: str) -> tuple[Any, list[str]]:
    if name not in _MODULES:
        raise ValueError(name)
    return _MODULES[name]
