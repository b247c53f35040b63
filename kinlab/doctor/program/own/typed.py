"""Where the numbers of a program's data were typed."""

from __future__ import annotations

import ast
import inspect
import re
from collections.abc import Sequence
from types import FunctionType
from typing import Any

import numpy as np

from kinlab.doctor.bytecode.syntax import called, names, targets_of
from kinlab.doctor.program.own.loaded import setting

_WRAPPING = ("array", "asarray", "float64", "tuple", "list")
"""What is called with a table and gives the same table."""


def line_of(function: FunctionType, name: str, place: Sequence[Any]) -> int | None:
    """The line in which a number stands; None where it is not typed in just one place.

    Args:
        function: one of the file that the data stand in.
        name: of the data.
        place: the keys down to the number.
    """
    try:
        text, _first = inspect.findsource(function)
        module = ast.parse("".join(text))
    except (OSError, TypeError, SyntaxError, ValueError, IndexError):
        return None
    found = [one for one in module.body if name in setting(one)]
    if len(found) != 1 or not isinstance(found[0], ast.Assign | ast.AnnAssign):
        return None
    value = _given(found[0], name)
    if value is None:
        return found[0].lineno
    if place and (row := _row_of_text(module, value, function.__globals__.get(name), place[0])):
        return row
    for key in place:
        inner = _entry(value, key)
        if inner is None:
            break
        value = inner
    return value.lineno


_A_NUMBER = re.compile(r"(?<![\w.])[-+]?(?:\d+\.?\d*|\.\d+)(?![\w.])")


def _row_of_text(module: ast.Module, value: ast.expr, held: Any, row: Any) -> int | None:
    """The line of a row of numbers that are read from a text; None where it is not sure."""
    used, texts = {*names(value)}, dict[str, ast.Constant]()
    for line in module.body:
        text = line.value if isinstance(line, ast.Assign) else None
        if isinstance(text, ast.Constant) and isinstance(text.value, str):
            texts |= dict.fromkeys(setting(line) & used, text)
    if len(texts) != 1 or not isinstance(row, int):
        return None
    (text,) = texts.values()
    lines = enumerate(str(text.value).split("\n"), text.lineno)
    rows = [k for k, line in lines if line.lstrip()[:1] != "#" and len(_A_NUMBER.findall(line)) > 1]
    whole = isinstance(held, list | tuple | np.ndarray) and len(held) == len(rows)
    return rows[row] if whole and 0 <= row < len(rows) else None


def _given(line: ast.Assign | ast.AnnAssign, name: str) -> ast.expr | None:
    """What a statement gives one of the names that it sets."""
    for target in targets_of(line):
        if isinstance(target, ast.Name) and target.id == name:
            return line.value
        names = [getattr(one, "id", None) for one in getattr(target, "elts", ())]
        if name in names and isinstance(line.value, ast.Tuple | ast.List):
            k = names.index(name)
            return line.value.elts[k] if len(line.value.elts) == len(names) else None
    return None


def _entry(value: ast.expr, key: Any) -> ast.expr | None:
    """What stands in a table under a key; None where that is not typed there."""
    if isinstance(value, ast.Call) and len(value.args) == 1:
        return _entry(value.args[0], key) if called(value) in _WRAPPING else None
    if isinstance(value, ast.List | ast.Tuple):
        starred = any(isinstance(one, ast.Starred) for one in value.elts)
        whole = isinstance(key, int) and not starred and -len(value.elts) <= key < len(value.elts)
        return value.elts[key] if whole else None
    if isinstance(value, ast.Dict):
        same = (v for k, v in zip(value.keys, value.values, strict=True) if _is(k, key))
        return next(same, None)
    return None


def _is(node: ast.expr | None, key: Any) -> bool:
    return isinstance(node, ast.Constant) and type(node.value) is type(key) and node.value == key
