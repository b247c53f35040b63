"""Many edits of one function compiled together: each in a branch of the statement it changes.

Compiling a function anew for each edit takes longer than running it. Here a statement becomes
``if _edit == 3: ... elif _edit == 8: ... else: ...``, with what other edits make of it, and the
function is compiled once for all of them.
"""

from __future__ import annotations

import ast
from collections.abc import Sequence
from types import FunctionType
from typing import Any

from kinlab.doctor.bytecode.syntax import nodes, shallow
from kinlab.doctor.program.places import BLOCKS, DATA, ProgramEdit, hanging, with_other
from kinlab.doctor.program.trial import NoProgramError, Trial

_TOGETHER = 64
"""Edits that are compiled together."""
_SIMPLE = ast.Assign | ast.AugAssign | ast.Return | ast.Expr
"""Statements of which there are branches."""
_AT: dict[str, Any] = {"lineno": 1, "col_offset": 0, "end_lineno": 1, "end_col_offset": 0}
_NONE: frozenset[str] = frozenset()

Branch = tuple[ProgramEdit, int, ast.stmt, ast.stmt]
"""An edit, its number, the statement that it changes, and what that becomes."""


class Variants:
    """The functions of a program with one edit each, as its trees stand now.

    Args:
        trial: the program.
        edits: in the order in which they are tried.
    """

    def __init__(self, trial: Trial, edits: Sequence[ProgramEdit]) -> None:
        self.trial = trial
        self._parts = [_Part(tree) for tree in trial.trees]
        self._waiting: list[list[ProgramEdit]] = [[] for _tree in trial.trees]
        for edit in reversed(edits):
            if edit.part != DATA:
                self._waiting[edit.part].append(edit)
        self._functions: dict[ProgramEdit, FunctionType] = {}
        self._numbers: dict[ProgramEdit, int] = {}

    def of(self, edit: ProgramEdit) -> tuple[int, FunctionType] | None:
        """The number of an edit, and the function that has it; None of what is compiled alone.

        Args:
            edit: asked for in the order that was given.
        """
        if edit.part == DATA:
            return None
        if edit not in self._numbers:
            self._prepare(edit.part)
        function = self._functions.pop(edit, None)
        return None if function is None else (self._numbers[edit], function)

    def _prepare(self, part: int) -> None:
        waiting = self._waiting[part]
        some = [waiting.pop() for _edit in range(min(_TOGETHER, len(waiting)))]
        branches: list[Branch] = []
        for edit in some:
            self._numbers[edit] = len(self._numbers) + 1
            both = self._parts[part].statement(edit)
            if both is not None:
                branches.append((edit, self._numbers[edit], *both))
        self._compile(part, branches)

    def _compile(self, part: int, branches: list[Branch]) -> None:
        """All together; of those among which one is no program, each half for itself."""
        if len(branches) < 2:
            return
        instead: dict[int, ast.stmt] = {}
        for _edit, number, old, new in branches:
            edited = ast.Name("_edit", ast.Load(), **_AT)
            asked = ast.Compare(edited, [ast.Eq()], [ast.Constant(number, **_AT)], **_AT)
            instead[id(old)] = ast.If(asked, [new], [instead.get(id(old), old)], **_AT)
        tree = _with_instead(self.trial.trees[part], instead)
        try:
            function = self.trial.made(tree, part)
        except NoProgramError:
            half = len(branches) // 2
            self._compile(part, branches[:half])
            self._compile(part, branches[half:])
            return
        self._functions |= {edit: function for edit, _number, _old, _new in branches}


class _Part:
    """Where everything in a function hangs."""

    def __init__(self, tree: ast.FunctionDef) -> None:
        self._above, self._lists = hanging(tree)
        self._sets: dict[int, frozenset[str]] = {}
        for node in reversed(nodes(tree)):
            self._sets[id(node)] = self._set_in(node)

    def statement(self, edit: ProgramEdit) -> tuple[ast.stmt, ast.stmt] | None:
        """The statement that an edit changes, and what it becomes; None where it is not simple."""
        if len(edit.changes) > 1:
            return None
        (change,) = edit.changes
        holder, field, new = change.holder, change.field, change.new
        if self._set_in(change.now) != self._set_in(new):
            return None  # what a function sets nowhere is not its own
        if isinstance(holder, list):
            if id(holder) not in self._lists or not isinstance(new, ast.AST):
                return None
            old: Any = holder[field]
            holder, name = self._lists[id(holder)]
            if not isinstance(old, ast.stmt):
                new = with_other(holder, name, field, new)
                old = holder
        else:
            new, old = with_other(holder, field, None, new), holder
        while not isinstance(old, ast.stmt):
            if id(old) not in self._above:
                return None
            holder, name, k = self._above[id(old)]
            new, old = with_other(holder, name, k, new), holder
        return (old, new) if isinstance(old, _SIMPLE) and isinstance(new, ast.stmt) else None

    def _set_in(self, piece: Any) -> frozenset[str]:
        """Names that are set in a piece; new nodes get a line, which compiling asks for."""
        known = self._sets.get(id(piece))
        if known is not None:
            return known
        if isinstance(piece, list):
            return _NONE.union(*map(self._set_in, piece))
        if not isinstance(piece, ast.AST):
            return _NONE
        if "lineno" in piece._attributes and not hasattr(piece, "lineno"):
            piece.__dict__.update(_AT)
        if isinstance(piece, ast.Name):
            return _NONE if isinstance(piece.ctx, ast.Load) else frozenset([piece.id])
        inside = [self._set_in(getattr(piece, name, None)) for name in piece._fields]
        return _NONE.union(*inside)


def _with_instead(tree: Any, instead: dict[int, ast.stmt]) -> Any:
    """A copy of a definition, or of a block's statement, with other statements in it."""
    other = shallow(tree)
    for name in BLOCKS:
        block = getattr(tree, name, None)
        if isinstance(block, list):
            setattr(other, name, [_placed(statement, instead) for statement in block])
    return other


def _placed(statement: ast.stmt, instead: dict[int, ast.stmt]) -> ast.stmt:
    if id(statement) in instead:
        return instead[id(statement)]
    blocks = any(hasattr(statement, name) for name in BLOCKS)
    return _with_instead(statement, instead) if blocks else statement
