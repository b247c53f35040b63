"""What a program leaves out though it has its like: the tool's offset, a rotor's term."""

from __future__ import annotations

import ast
from collections.abc import Iterator, Mapping, Sequence
from dataclasses import replace
from typing import Any

import numpy as np

from kinlab.doctor.bytecode.syntax import copied, names, nodes, text_of
from kinlab.doctor.program.edits.chains import SUMS, chain
from kinlab.doctor.program.edits.numbers.as_the_arm import matrix_typed, typed
from kinlab.doctor.program.observed import Observed
from kinlab.doctor.program.places import Here, ProgramEdit, line_more
from kinlab.model.dh import DHTable
from kinlab.tolerances import TOLERANCES

_TOOL, _ROTOR = 1.05, 1.04
"""Cost of the tool's offset where noughts stand, and of rotors that are left out beside others."""
_BEHIND, _DECIMALS = 1.1, 12
"""Cost of the tool's transform behind a loop, and digits of it."""
_FEWEST = 2
"""Rotors that are there, of which others are missed."""


def has_the_tool(table: DHTable, given: Sequence[float]) -> bool:
    """Whether a number of the tool's point is among those of a program, which rather uses it."""
    point = np.asarray(table.tool, dtype=float)[:3, 3]
    near = (np.isclose(abs(x), given, rtol=TOLERANCES.same_number) for x in point if x)
    return any(map(np.any, near))


def at_the_tool(here: Here, table: DHTable, given: Sequence[float]) -> Iterator[ProgramEdit]:
    """The tool's point for the last frame's origin: ``[0, 0, 0.107, 1]`` for ``[0, 0, 0, 1]``."""
    row = [getattr(one, "value", None) for one in getattr(here.node, "elts", ())]
    if row not in ([0, 0, 0, 1], [0, 0, 0]) or isinstance(here.parent, ast.List | ast.Tuple):
        return
    point = np.asarray(table.tool, dtype=float)[:3, 3]
    if point.any() and not has_the_tool(table, given):
        new = [typed(float(x)) if x else ast.Constant(0) for x in point]
        yield replace(
            here.within(here.node, "elts", [*new, *here.node.elts[3:]], "number", _TOOL),
            of_the_arm=True,
        )


def tool_behind_a_loop(
    part: int, tree: ast.AST, observed: Observed, table: DHTable
) -> Iterator[ProgramEdit]:
    """The tool's transform behind a loop that goes from frame to frame: ``T = T @ tool``."""
    tool = np.round(np.asarray(table.tool, dtype=float), _DECIMALS) + 0.0
    for function in (x for x in nodes(tree) if isinstance(x, ast.FunctionDef)):
        block = function.body
        for at, loop in ((k, x) for k, x in enumerate(block, 1) if isinstance(x, ast.For)):
            behind = {name for line in block[at:] for name in names(line, ast.Load)}
            for name in sorted(behind.intersection(_carried_on(loop, observed))):
                product = ast.BinOp(ast.Name(name, ast.Load()), ast.MatMult(), matrix_typed(tool))
                line = ast.Assign([ast.Name(name, ast.Store())], product)
                edit = line_more(part, function, "body", block, at, line, _BEHIND)
                yield replace(edit, of_the_arm=True)


def tool_along_an_axis(
    here: Here, observed: Observed, table: DHTable, stacks: Mapping[str, Any]
) -> Iterator[ProgramEdit]:
    """The tool's offset along the last axis: ``o[-1] + 0.1*z[-1]`` for ``o[-1]``.

    Args:
        here: an entry of an array of points.
        observed: its shape.
        table: with the tool.
        stacks: shapes of the arrays that are known there.
    """
    node, point = here.node, np.asarray(table.tool, dtype=float)[:3, 3]
    axes = np.flatnonzero(point)
    if len(axes) != 1 or not isinstance(node, ast.Subscript) or observed.shape(node) != (3,):
        return
    if not isinstance(node.value, ast.Name) or not _is_last(node.slice, table.n):
        return
    length = typed(float(point[axes[0]]))
    for name in sorted(stacks):
        if name != node.value.id and stacks[name] == observed.shape(node.value):
            axis = ast.Subscript(ast.Name(name, ast.Load()), copied(node.slice), ast.Load())
            new = ast.BinOp(node, ast.Add(), ast.BinOp(length, ast.Mult(), axis))
            yield replace(here.instead(new, "missing term", _BEHIND), of_the_arm=True)


def _is_last(key: ast.expr, count: int) -> bool:
    """Whether an index is that of the last of so many, or of one more."""
    text = text_of(key)
    return text in ("-1", str(count - 1), str(count))


def _carried_on(loop: ast.For, observed: Observed) -> Iterator[str]:
    """The transforms that a loop multiplies by another each time: ``T = T @ A``."""
    for line in nodes(loop):
        if not isinstance(line, ast.Assign):
            continue
        first, others = chain(line.value, (ast.MatMult,))
        carried = others and isinstance(first, ast.Name) and observed.shape(first) == (4, 4)
        if carried and text_of(first) == text_of(line.targets[0]):
            yield text_of(first)


def rotors_left_out(here: Here, table: DHTable) -> Iterator[ProgramEdit]:
    """A rotor's term where those of other joints stand: ``0.3*v[0]**2 + 0.02*v[3]**2``."""
    outer = here.parent
    if not isinstance(here.node, ast.BinOp) or not isinstance(here.node.op, ast.Add):
        return
    if isinstance(outer, ast.BinOp) and isinstance(outer.op, ast.Add):
        return  # of the whole sum
    rotors = [float(link.armature) for link in table.links]
    told: dict[int, ast.expr] = {}
    first, others = chain(here.node, SUMS)
    for term in (first, *(one for _sign, one in others)):
        sizes = [x for x in nodes(term) if isinstance(getattr(x, "value", None), float)]
        places_ = {k for x in nodes(term) if (k := _joint_of(x)) is not None}
        if len(sizes) == 1 and len(places_) == 1:
            (k,) = places_
            if k < len(rotors) and sizes[0].value == rotors[k]:  # type: ignore[attr-defined]
                told[k] = term
    left = [k for k, x in enumerate(rotors) if x and k not in told]
    if len(told) < _FEWEST or not left:
        return
    (j, like), *_rest = told.items()
    new: ast.expr = here.node
    for k in left:
        new = ast.BinOp(new, ast.Add(), _OfJoint(j, k, rotors[j], rotors[k]).visit(copied(like)))
    yield replace(here.instead(new, "missing term", _ROTOR), of_the_arm=True)


def _joint_of(node: ast.AST) -> int | None:
    """The index of an entry of a row: 2 of ``v[2]``."""
    key = getattr(node, "slice", None) if isinstance(node, ast.Subscript) else None
    value = getattr(key, "value", None)
    return value if type(value) is int else None


class _OfJoint(ast.NodeTransformer):
    """Another joint's index and number for a joint's."""

    def __init__(self, old: int, new: int, size: float, other: float) -> None:
        self.old, self.new, self.size, self.other = old, new, size, other

    def visit_Constant(self, node: ast.Constant) -> ast.Constant:
        return ast.Constant(self.other) if node.value == self.size else node

    def visit_Subscript(self, node: ast.Subscript) -> ast.expr:
        return ast.Subscript(node.value, ast.Constant(self.new), node.ctx)
