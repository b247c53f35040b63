"""What the pieces of a program around an edit are: ``z`` is the axis of joint 2."""

from __future__ import annotations

import ast
from collections.abc import Iterator
from dataclasses import replace

import numpy as np

from kinlab.doctor.bytecode.syntax import nodes
from kinlab.doctor.changes import table_of
from kinlab.doctor.glossary.meaning import meaning_of, said
from kinlab.doctor.glossary.textbook import Glossary, Sense
from kinlab.doctor.program.edits.numbers.data import shown
from kinlab.doctor.program.observed import Observed
from kinlab.doctor.program.places import DATA, ProgramEdit
from kinlab.doctor.program.search.repair import LineSearch
from kinlab.tolerances import TOLERANCES

_PLAIN = ("positions", "velocities", "accelerations")
"""What everybody knows of a function's own arguments."""


def named(edit: ProgramEdit, search: LineSearch) -> list[tuple[str, str]]:
    """Pieces of what an edit changes, each with what it is; none where nothing is known.

    Args:
        edit: of the program.
        search: whose program was observed.
    """
    known = search.evidence.known
    if not known or edit.kind in ("loop", "condition"):
        return []
    if edit.part == DATA:
        if edit.numbers is None or _is_of_several(edit.numbers[1], search):
            return []
        right = np.array(edit.numbers[1])
        sense = meaning_of(known, [right for _state in known])
        return [] if sense is None else [(shown(edit.numbers[1]), said(sense))]
    changed = [edit.node, *(c.new for c in edit.changes if isinstance(c.new, ast.AST))]
    texts = {ast.unparse(n): n for n in nodes(search.trial.trees[edit.part]) if _piece(n)}
    out: dict[str, str] = {}
    for node in changed:
        for piece in _pieces(node):
            text = ast.unparse(piece)
            sense = _sense(texts.get(text, piece), search.observed, known)
            if sense is not None and sense.what not in _PLAIN:
                out.setdefault(text, said(sense))
    return [*out.items()]


def _is_of_several(value: float, search: LineSearch) -> bool:
    """Whether several numbers of the arm's are that, with either sign: whose it is, is not said."""
    table = table_of(search.case.robot)
    links = () if table is None else table.links
    moments = (float(x) for k in links for x in np.diagonal(np.asarray(k.inertia)))
    lengths = [x for k in links for x in (float(k.a), float(k.d), float(k.mass))]
    lengths += [float(x) for k in links for x in np.asarray(k.com)]
    same = [abs(abs(x) - abs(value)) <= TOLERANCES.same_number for x in (*lengths, *moments)]
    return sum(same) > 1


def _pieces(node: ast.AST) -> Iterator[ast.expr]:
    """Names and entries, the widest first; what stands in an index is none."""
    if _piece(node):
        assert isinstance(node, ast.expr)
        yield node
    for child in ast.iter_child_nodes(node):
        if not (isinstance(node, ast.Subscript) and child is node.slice):
            yield from _pieces(child)


def _piece(node: ast.AST) -> bool:
    loaded = isinstance(getattr(node, "ctx", None), ast.Load)
    return loaded and isinstance(node, ast.Name | ast.Subscript | ast.Attribute)


def _sense(node: ast.AST, observed: Observed, known: list[Glossary]) -> Sense | None:
    """What a piece is whenever it is passed, by the values that it had at each of the states."""
    seen = observed.of(node)
    if seen is None or not seen.values or seen.count % len(known):
        return None
    passes = seen.count // len(known)
    if len(seen.values) < seen.count:
        return None
    found: list[Sense] = []
    for k in range(passes):
        values = [seen.values[k + passes * j] for j in range(len(known))]
        sense = meaning_of(known, values)
        if sense is not None:
            found.append(sense)
        elif any(map(np.any, values)):
            return None  # it is that in some passes only
    if not found or len({(x.what, x.of, x.frame, x.form) for x in found}) > 1:
        return None
    one = {x.number for x in found}
    return found[0] if len(one) == 1 and passes == len(found) else replace(found[0], number=None)
