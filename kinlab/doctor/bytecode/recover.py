"""The syntax tree of a function whose source text cannot be had.

A function typed at the plain prompt, or made by ``exec``, keeps no text; its byte code still says
everything but the comments. The reader here goes through the steps in the order in which they can
follow one another, makes expressions on a stack, and tells loops and branches from where the paths
part and meet. It needs no proof of its own: the tree is compiled again, and where the new byte code
does not do the same on every path the answer is None.

A tree compiles to the same, but need not be written the same: a nested ``if`` may come as ``and``,
a folded constant as its value.
"""

from __future__ import annotations

import ast
import math
import warnings
from types import CodeType, FunctionType

from kinlab.doctor.bytecode.expressions import Made, literal
from kinlab.doctor.bytecode.instructions import UnreadError, alike
from kinlab.doctor.bytecode.reading import definition
from kinlab.doctor.bytecode.syntax import nodes


def recovered(function: FunctionType) -> ast.FunctionDef | None:
    """The function's syntax tree, made again from its byte code; None where that is not certain.

    The line numbers are those of the source. A lambda comes as a function that returns. Defaults
    are given where all of them are literals, else none: they stand in ``__defaults__``.

    Args:
        function: A Python function.

    Returns:
        A tree that compiles to the same steps on every path, with equal constants and names, or
        None where a step is not known or the compiled tree differs.
    """
    code = function.__code__
    named = code.co_name.isidentifier()
    try:
        defaults = _literals(function.__defaults__ or ())
        keywords = _literals(tuple((function.__kwdefaults__ or {}).values()))
        given = dict(zip(function.__kwdefaults__ or {}, keywords or (), strict=False))
        if defaults is None or keywords is None:
            defaults, given = [], {}
        made = Made(code, defaults, given, {})
        tree = definition(made, code.co_name if named else "function")
        again = _compiled(tree, code)
        return tree if again is not None and alike(code, again, named=named) else None
    except (UnreadError, RecursionError):
        return None


def _literals(values: tuple[object, ...]) -> list[ast.expr] | None:
    """The values as literals, or None if one is not."""
    return [literal(value, None) for value in values] if all(map(_plain, values)) else None


def _plain(value: object) -> bool:
    if isinstance(value, tuple):
        return all(map(_plain, value))
    known = isinstance(value, (bool, int, float, str, type(None)))
    return known and not (isinstance(value, float) and not math.isfinite(value))


def _compiled(tree: ast.FunctionDef, code: CodeType) -> CodeType | None:
    """The tree's own byte code, in surroundings that have the variables it takes from outside."""
    calls = [n for n in nodes(tree) if isinstance(n, ast.Call) and hasattr(n, "of_import")]
    named = [n.func.value for n in calls if isinstance(n.func, ast.Attribute)]
    modules = sorted({n.id for n in named if isinstance(n, ast.Name)})
    body: list[ast.stmt] = [tree]
    if code.co_freevars:
        names = [ast.arg(name) for name in code.co_freevars]
        inside = ast.arguments([], names, None, [], [], None, [])
        body = [ast.FunctionDef("around", inside, body, [], None)]
    imports: list[ast.stmt] = [ast.Import([ast.alias(name)]) for name in modules]
    module = ast.fix_missing_locations(ast.Module(imports + body, []))
    try:
        with warnings.catch_warnings():  # told when the function was written
            warnings.simplefilter("ignore", SyntaxWarning)
            found = compile(module, "<recovered>", "exec", dont_inherit=True)
    except (SyntaxError, ValueError, TypeError):
        return None
    inner = [c for c in found.co_consts if isinstance(c, CodeType)]
    if inner and code.co_freevars:
        inner = [c for c in inner[0].co_consts if isinstance(c, CodeType)]
    return inner[0] if inner else None
