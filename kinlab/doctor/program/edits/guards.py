"""What counts for some joints alone: conditions, and masks of arrays, around a term."""

from __future__ import annotations

import ast
from collections.abc import Iterator

from kinlab.doctor.bytecode.syntax import called, copied, names, nodes, text_of
from kinlab.doctor.program.edits.scope.forms import block_of
from kinlab.doctor.program.edits.scope.part import Scope
from kinlab.doctor.program.observed import Observed, Shape
from kinlab.doctor.program.places import Here, ProgramEdit, is_nothing

_GUARDED = 1.08
"""What it costs that a term counts for some joints only."""
_PART = 0.18
"""What it costs more of a part of an expression."""
_OF_THE_KIND = 1.06
"""The same of what a sum gets for the other kind of joint."""
_CHOSEN = 1.1
"""The same of a force or a moment, as the joint moves."""
_CHOICE = 3
"""Arguments of ``np.where``."""
_VECTOR, _KINDS = (3,), 2
"""Shape of an axis; letters of a column that tells the kind of joint."""


def masks(tree: ast.AST) -> dict[str, ast.expr]:
    """By what a program chooses from arrays, by its text: ``slide`` of ``where(slide, 0, q)``."""
    calls = (one for one in nodes(tree) if isinstance(one, ast.Call) and called(one) == "where")
    asked = (one.args[0] for one in calls if len(one.args) == _CHOICE)
    return {ast.unparse(one): one for one in asked if isinstance(one, ast.Name | ast.Attribute)}


def choices(tree: ast.AST) -> dict[str, ast.expr]:
    """Conditions by which something else is nothing: ``i == 1`` of ``q[i] if i == 1 else 0``."""
    every = (one for one in nodes(tree) if isinstance(one, ast.IfExp))
    some = (one for one in every if is_nothing(one.body) or is_nothing(one.orelse))
    return {ast.unparse(one.test): one.test for one in some}


def of_guards(
    here: Here,
    scope: Scope,
    observed: Observed,
    known: dict[str, ast.expr],
    tests: dict[str, ast.expr],
) -> Iterator[ProgramEdit]:
    """A term for a hinge or a slide alone: ``0 if slides[i] else q[i]``, ``np.where(slide, 0, q)``.

    Args:
        here: the term of a sum.
        scope: what may stand there.
        observed: its shape.
        known: what arrays are chosen by.
        tests: what numbers are chosen by.
    """
    node, shape = here.node, observed.shape(here.node)
    if isinstance(node, ast.Name) and shape is not None and node.id not in scope.unused:
        yield from _of_the_other_case(here, scope, tests, shape)
    if shape == _VECTOR and isinstance(here.parent, ast.Assign) and here.field == "value":
        yield from _of_the_other_kind(here)
        yield from _of_columns(here, scope, tests)
    op = getattr(here.parent, "op", None)
    if shape == _VECTOR and isinstance(op, ast.MatMult) and isinstance(node, ast.Name):
        yield from _of_a_slide(here, scope, tests)
    if shape is None:
        return
    if not isinstance(op, ast.Add | ast.Sub) and not _is_rate_along_an_axis(here, observed):
        return
    if not isinstance(node, ast.Name | ast.Subscript | ast.Attribute | ast.Call):
        return
    nothing = ast.Constant(0)
    if shape == ():
        for test in _tests_here(here, scope, tests):
            for both in ((nothing, node), (node, nothing)):
                yield here.instead(ast.IfExp(test, *both), "condition", _GUARDED)
    elif len(shape) == 1 and scope.has_numpy:
        where = ast.Attribute(ast.Name("np", ast.Load()), "where", ast.Load())
        for mask in known.values():
            for first, last in ((nothing, node), (node, nothing)):
                chosen = ast.Call(where, [mask, first, last], [])
                yield here.instead(chosen, "condition", _GUARDED)


def _is_rate_along_an_axis(here: Here, observed: Observed) -> bool:
    """Whether it is the entry of an array in front of an axis: ``rate[i]*z``."""
    product = here.parent
    if not isinstance(here.node, ast.Subscript) or not isinstance(product, ast.BinOp):
        return False
    other = product.right if product.left is here.node else product.left
    along = isinstance(product.op, ast.Mult) and observed.shape(other) == _VECTOR
    return along and isinstance(other, ast.Name | ast.Subscript)


def _of_the_other_case(
    here: Here, scope: Scope, tests: dict[str, ast.expr], shape: Shape
) -> Iterator[ProgramEdit]:
    """What is set and used nowhere, for one case: ``turning if kind == "R" else sliding``."""
    idle = sorted(one for one in scope.unused if scope.shapes.get(one) == shape)
    inside = isinstance(here.parent, ast.BinOp | ast.UnaryOp | ast.IfExp)
    cost = _GUARDED + _PART * inside
    for test in _tests_here(here, scope, tests) if idle else ():
        for other in (ast.Name(one, ast.Load()) for one in idle):
            for both in ((here.node, other), (other, here.node)):
                yield here.instead(ast.IfExp(test, *both), "condition", cost)


def _of_the_other_kind(here: Here) -> Iterator[ProgramEdit]:
    """What one kind of joint adds above, for the other: ``v = ... + (0 if hinge else rate*z)``."""
    block, at = block_of(here.above)
    for line in block[:at]:
        if isinstance(line, ast.If) and not line.orelse and len(line.body) == 1:
            for term in _added(line.body[0]):
                chosen = ast.IfExp(copied(line.test), ast.Constant(0), copied(term))
                new = ast.BinOp(here.node, ast.Add(), chosen)
                yield here.instead(new, "missing term", _OF_THE_KIND)


def _added(line: ast.stmt) -> Iterator[ast.expr]:
    """What a statement adds to what it sets: ``rate*z`` of ``w = w + rate*z``."""
    if isinstance(line, ast.AugAssign) and isinstance(line.op, ast.Add):
        yield line.value
    elif isinstance(line, ast.Assign) and isinstance(line.value, ast.BinOp):
        summed = isinstance(line.value.op, ast.Add)
        if summed and text_of(line.value.left) == text_of(line.targets[0]):
            yield line.value.right


def _tests_here(here: Here, scope: Scope, tests: dict[str, ast.expr]) -> list[ast.expr]:
    """Of the conditions by which numbers are chosen those that may stand there, and others."""
    block, at = block_of(here.above) if tests else ([], 0)
    lines = [line for line in block[:at] if isinstance(line, ast.Assign)]
    above = (name for line in lines for to in line.targets for name in names(to))
    inside = {*scope.shapes, *scope.counting, *above}
    own = {text: one for text, one in tests.items() if inside.issuperset(names(one))}
    return [*(own | {ast.unparse(one): one for one in scope.tests_here()}).values()]


def _tests_of_rows(here: Here, scope: Scope) -> Iterator[ast.expr]:
    """Whether a row has a letter in a table of several: ``LINKS[j][0] == "P"``."""
    used = names(here.above[0])
    for name in dict.fromkeys(x for x in used if x in scope.space):
        rows = scope.space[name]
        if not isinstance(rows, list | tuple) or not all(isinstance(x, list | tuple) for x in rows):
            continue
        for k, cells in enumerate(zip(*rows, strict=False)):
            letters = {*cells} if all(isinstance(one, str) for one in cells) else {""}
            for counter in sorted(scope.counting) if len(letters) == _KINDS else ():
                at = ast.Name(counter, ast.Load())
                row = ast.Subscript(ast.Name(name, ast.Load()), at, ast.Load())
                cell = ast.Subscript(row, ast.Constant(k), ast.Load())
                yield ast.Compare(cell, [ast.Eq()], [ast.Constant(min(letters))])


def _of_a_slide(here: Here, scope: Scope, tests: dict[str, ast.expr]) -> Iterator[ProgramEdit]:
    """The force for a slide where the moment is for a hinge: ``z @ (f if slides[i] else n)``."""
    others = [one for text, one in scope.simple(_VECTOR) if text != ast.unparse(here.node)]
    for test in _tests_here(here, scope, tests):
        for other in (one for one in others if isinstance(one, ast.Name)):
            for both in ((other, here.node), (here.node, other)):
                yield here.instead(ast.IfExp(test, *both), "condition", _CHOSEN)


def _of_columns(here: Here, scope: Scope, tests: dict[str, ast.expr]) -> Iterator[ProgramEdit]:
    """A column of a Jacobian for a hinge or a slide alone: ``J[3:, i] = 0 if slides[i] else z``."""
    target = here.above[-1].targets[0] if isinstance(here.above[-1], ast.Assign) else None
    crossed = isinstance(here.node, ast.Call) and called(here.node) == "cross"
    if not (isinstance(target, ast.Subscript) or crossed) or isinstance(here.node, ast.IfExp):
        return
    own = ast.unparse(here.node)
    axes = [one for text, one in scope.simple(_VECTOR) if text != own and text in own]
    others = [ast.Constant(0), *(one for one in axes if isinstance(one, ast.Name))]
    decided = {ast.unparse(one.test) for one in here.above if isinstance(one, ast.If)}
    every = [*_tests_here(here, scope, tests), *_tests_of_rows(here, scope)]
    for test in (one for one in every if ast.unparse(one) not in decided):
        for other in others:
            for both in ((other, here.node), (here.node, other)):
                yield here.instead(ast.IfExp(test, *both), "condition", _GUARDED)
