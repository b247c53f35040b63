"""A repair in words: the line, what stands there, what should."""

from __future__ import annotations

import ast
import re
from collections.abc import Callable, Iterator
from dataclasses import dataclass, replace
from functools import reduce
from pathlib import Path
from typing import Any

import numpy as np

from kinlab.arrays import Array
from kinlab.check.compare import relative_errors
from kinlab.check.diagnosis import Cause
from kinlab.doctor.bytecode.syntax import called, factors, nodes, targets_of
from kinlab.doctor.changes import Case, table_of
from kinlab.doctor.program.cuts import cuts
from kinlab.doctor.program.digits import of_rounded_numbers
from kinlab.doctor.program.edits.chains import SUMS, chain, joined
from kinlab.doctor.program.edits.numbers.as_the_arm import of_table
from kinlab.doctor.program.edits.numbers.data import leaves, shown
from kinlab.doctor.program.edits.numbers.exchanged import as_exchanged, label
from kinlab.doctor.program.grounds.scaled import is_own
from kinlab.doctor.program.named import named
from kinlab.doctor.program.nearly import of_small_numbers
from kinlab.doctor.program.own.definitions import DEFAULT
from kinlab.doctor.program.own.typed import line_of
from kinlab.doctor.program.places import BLOCKS, DATA, ProgramEdit, changed, row_of
from kinlab.doctor.program.read import read
from kinlab.doctor.program.search.repair import LineSearch, ProgramRepair
from kinlab.doctor.program.several.repairs import of_mistyped, several, single
from kinlab.doctor.program.trial import FailedError, FieldChange, NoProgramError, Trial, quietly
from kinlab.doctor.verdicts import Excuse, rounded_otherwise
from kinlab.host.language import N_, _
from kinlab.symbolic.vocabulary import vocabulary
from kinlab.tolerances import TOLERANCES

_MOST = 3
"""Repairs that are told."""
_NAMED = 2
"""Pieces of which it is said what they are."""
_ROUNDINGS = ("round", "around", "round_")
_STEP = 1e-2
"""Share of a number below which another one is rather the step of a difference."""
_NO_LIKELIER = 0.06
"""Cost beyond the likeliest meaning's of another that may be meant as well."""
_PAIR = 2
"""Repairs of which two may leave what differences leave."""
_LONGEST = 120
"""Letters of a statement up to which it is shown as a whole where several places are wrong."""
_WIDE = 72
"""Letters of a piece of a program that is shown; more of it where it is shorter."""

_WHAT = {
    "sign": N_("the sign is wrong"),
    "sin/cos": N_("sine and cosine are exchanged"),
    "index": N_("the index is that of another"),
    "name": N_("the name is another"),
    "transposed": N_("the transpose is wrong"),
    "factor": N_("a factor is wrong"),
    "number": N_("a number is wrong"),
    "power": N_("the power is wrong"),
    "argument": N_("the angle is another"),
    "parentheses": N_("the parentheses are wrong"),
    "degrees": N_("degrees are taken for radians"),
    "order": N_("the order is exchanged"),
    "axes": N_("the vector is in the axes of another frame"),
    "order of lines": N_("what the line uses is updated too early, or too late"),
    "loop": N_("the loop leaves one out, or takes one too many"),
    "direction": N_("it runs the other way"),
    "products' signs": N_("the products of inertia have the other sign"),
    "condition": N_("the condition is wrong"),
    "entries swapped": N_("two entries are exchanged"),
    "rows": N_("the rows are others: the linear ones, or the angular"),
    "inverse": N_("the inverse is wrong"),
    "function": N_("the function is another"),
    "operator": N_("a sum stands for a product, or a product for a sum"),
    "product": N_("it is a matrix product"),
    "cross product": N_("the cross product and the dot product are exchanged"),
    "sum": N_("the sum forgets what was there before"),
    "extra statement": N_("the line is one too many"),
    "extra term": N_("a term is too many"),
    "extra factor": N_("a factor is too many"),
    "missing term": N_("a term is missing"),
    "missing factor": N_("a factor is missing"),
    "names exchanged": N_("two names are exchanged"),
    "reversed": N_("the numbers stand in the reverse order"),
    "shifted": N_("the numbers stand one place on"),
    "rows swapped": N_("two rows are exchanged"),
    "columns swapped": N_("two columns are exchanged"),
    "aliased": N_("the array is changed in place later; a copy is meant"),
    "whole division": N_("the division leaves the remainder out"),
    "too deep": N_("the line stands in the block before it, and belongs behind it"),
    "not deep enough": N_("the line stands behind the loop or the condition, and belongs in it"),
    "in the loop": N_("the line stands in the loop, and belongs before it"),
    "before the loop": N_("the line stands before the loop, and belongs in it"),
    "missing statement": N_("a line is missing"),
    "missing argument": N_("an argument is missing"),
    "kind of joint": N_("it is a hinge's column, and the joint is a slide"),
    "missing entry": N_("the entry across from it is to be set, too"),
    "another term": N_("the term is another"),
    "missing matrix": N_("the product with a rotation or another matrix is missing"),
}

_MOVED = (
    "extra statement",
    "missing statement",
    "too deep",
    "not deep enough",
    "in the loop",
    "before the loop",
)
"""Kinds of edit of a whole statement, of which nothing else is shown."""


@dataclass(frozen=True)
class WrongLines:
    """What lines of a program should be.

    Attributes:
        causes: the likeliest first.
        written_out: whether the program is a formula written out: no loops, no products of
            matrices.
        numbers: those that the program comes to at the first state, sorted.
        excuse: of a program that is right all the same, why; nothing else is said then.
        stepping: whether the program may take differences.
        odd: whether a number of the program is none that the arm's table has in its place.
        sure: the causes that leave nothing, and are no end of a loop, nor a number next to nothing.
        hidden: of several lines those of which all but one do nothing as long as that one is wrong,
            with the kind of that one's slip.
    """

    causes: list[Cause]
    written_out: bool
    numbers: Array
    excuse: Excuse | None = None
    odd: bool = False
    stepping: bool = False
    sure: tuple[Cause, ...] = ()
    hidden: tuple[tuple[Cause, str], ...] = ()


def lines(
    function: Callable[..., Any], case: Case, wanted: Array, allowed: float
) -> Iterator[WrongLines]:
    """What single lines of a function should be, and then, if asked on, what several should.

    Of a function that is right with rounded numbers nothing but that.

    Args:
        function: the hand formula; nothing comes of one that cannot be read.
        case: the states, and the formula's own answers.
        wanted: the right answers, (N, ...).
        allowed: the relative error that may be left.
    """
    program = read(function)
    if program is None:
        return
    try:
        search = LineSearch(program, case, wanted, allowed)
    except FailedError:  # what does not run where it was not written is not tried
        return
    if not search.asked.faithful:
        return
    numbers = search.observed.numbers(len(search.asked.states))
    excuse = of_small_numbers(search) or _of_cuts(search) or of_rounded_numbers(search)
    if excuse is not None:
        yield WrongLines([], search.written_out, numbers, excuse)
        return
    odd = any(True for _edit in of_table(search.trial, search.observed, case.robot))
    for found in (of_mistyped, single, several):
        repairs = found(search)[:_MOST]
        if not search.asked.faithful:
            return  # an edit has written into what the program keeps
        told = [one for one in (believed(repair, search) for repair in repairs) if one]
        if found is of_mistyped and not told:
            continue
        causes = [cause_of(one, search) for one in told]
        pairs = zip(causes, told, strict=True)
        hidden = ((cause, kind) for cause, one in pairs if (kind := _hiding(one, search)))
        sure = [x for x, one in zip(causes, told, strict=True) if _is_sure(one, search)]
        stepping = search.asked.differences
        yield WrongLines(
            causes, search.written_out, numbers, None, odd, stepping, (*sure,), (*hidden,)
        )


def _is_sure(repair: ProgramRepair, search: LineSearch) -> bool:
    """Whether one edit leaves nothing of a small error that could be one of digits.

    Of several each is to put a number of the robot's in. How often an iteration is gone through,
    and what damps it, are such as leave little.
    """
    if repair.error > TOLERANCES.formula_agrees:
        return False
    if len(repair.edits) > 1:
        put = [None if one.numbers is None else one.numbers[1] for one in repair.edits]
        return all(x is not None and is_own(search.case.robot, x) for x in put)
    (edit,) = repair.edits
    if edit.kind in _ENDING:
        return False
    return edit.of_the_arm or edit.numbers is None or abs(edit.numbers[1]) > TOLERANCES.is_small


def _hiding(repair: ProgramRepair, search: LineSearch) -> str:
    """The kind of the slip that hides the others: without it, they do nothing; empty of none."""
    own = search.asked.values(search.asked.first)
    for edit in repair.edits if len(repair.edits) > 1 and own is not None else ():
        others = tuple(one for one in repair.edits if one is not edit)
        try:
            with quietly(), changed(search.trial, others):
                values = search.asked.values(search.asked.first)
        except NoProgramError:
            continue
        if values is not None and own is not None and search.asked.same(values, own):
            return edit.kind
    return ""


def _of_cuts(search: LineSearch) -> Excuse | None:
    """Why a program is right that rounds by itself, if nothing else is off but rounded numbers."""
    edits = cuts(search)
    if not edits:
        return None
    told = _("{place} rounds: `{piece}`")
    said = [told.format(place=_line(edit, search.trial), piece=_text(edit.node)) for edit in edits]
    try:
        with quietly(), changed(search.trial, edits):
            answers = search.asked.answers(range(len(search.asked.wanted)))
            if answers is None or not _little(search.case.hand, answers):
                return None
            more = rounded_otherwise(replace(search.case, hand=answers), search.asked.wanted, said)
            if more is None and (more := of_rounded_numbers(search)) is not None:
                more = replace(more, remarks=(*said, *more.remarks))
    except NoProgramError:
        return None
    return more


def _little(hand: Array, answers: Array) -> bool:
    """Whether answers differ by no more than rounding may change them."""
    same = hand.shape == answers.shape and bool(np.isfinite(answers).all())
    return same and bool(np.max(relative_errors(hand, answers)) <= TOLERANCES.may_be_rounded)


def behind(more: WrongLines, read: list[Cause]) -> list[Cause]:
    """Lines that are wrong, too, where one of them alone is what explains the formula.

    Args:
        more: what several lines should be.
        read: what the formula does otherwise, as a whole.
    """
    return [x for x, kind in more.hidden if any(_same_slip(cause, kind) for cause in read)]


def meant(edited: list[Cause], read: list[Cause]) -> list[Cause]:
    """What a line should be, with what that means where it is known.

    Args:
        edited: what lines should be, the likeliest first.
        read: what the formula does otherwise, as a whole.
    """
    line = edited[0]
    one = len(line.kinds) == 1
    known = [cause for cause in read if one and _same_slip(cause, line.kinds[0])]
    if not known:
        return [line]
    cause = min(known, key=lambda one: one.cost)
    near = {one.sentence for one in known if one.cost <= cause.cost + _NO_LIKELIER}
    if len(near) > 1 and "factor" in cause.kinds:  # twice of what, is not told by the whole
        return [line]
    said = _("{meaning}: {line}").format(meaning=cause.sentence, line=line.sentence)
    places = (*line.places, *cause.places)
    return [replace(line, sentence=said, kinds=cause.kinds, places=places)]


def _same_slip(reading: Cause, edit: str) -> bool:
    """Whether a reading of the whole may be what an edit of a line is; not by its numbers alone."""
    kinds = ["missing term" if kind.endswith(" term") else kind for kind in reading.kinds]
    return all(edit in _SLIPS.get(kind, (kind,)) for kind in kinds)


_LEFT_OUT = ("missing term", "missing statement", "sum")
_ENDING = ("loop", "condition")
"""Kinds of edits of how long an iteration goes on."""
_NUMBERS = (
    "number",
    "sign",
    "factor",
    "entries swapped",
    "rows swapped",
    "columns swapped",
    "reversed",
    "shifted",
)
_SLIPS = {
    "missing term": _LEFT_OUT,
    "velocity left out": _LEFT_OUT,
    "acceleration left out": _LEFT_OUT,
    "gravity left out": (*_LEFT_OUT, "number"),
    "Coriolis terms": (*_LEFT_OUT, "factor", "number", "missing factor"),
    "centrifugal terms": _LEFT_OUT,
    "sign": ("sign", "order"),
    "factor": ("factor", "number", "missing factor", "extra factor", "parentheses"),
    "transposed": ("transposed", "inverse"),
    "inverse": ("inverse", "transposed", "function"),
    "power": ("power", "number", "missing factor"),
    "order": ("order", "sign"),
    "exchanged": ("entries swapped", "order", "sin/cos", "name", "names exchanged"),
    "sin/cos": ("sin/cos", "name"),
    "index": ("index", "name", "loop", "argument"),
    "another quantity": ("index", "name", "function", "argument"),
    "Christoffel": ("index", "order", "name"),
    "missing factor": ("missing factor", "missing matrix", "power", "function"),
    "rotation left out": ("missing matrix", "missing factor"),
    "extra factor": ("extra factor", "power", "factor"),
    "rotated twice": ("extra factor",),
    "tensor not rotated": ("missing matrix",),
    "tensor transposed": ("transposed", "order"),
    "sum": ("sum", "loop", "index", "condition"),
    "own joint": ("loop", "condition"),
    "slide as hinge": ("condition",),
    "hinge as slide": ("condition",),
    "convention": ("name", "index", "entries swapped", "missing factor", "extra factor", "order"),
    "degrees": ("degrees", "function", "factor", "number"),
    "absolute angles": ("name", "argument", "function", "sum"),
    "table entry": _NUMBERS,
    "tool": _NUMBERS,
    "mass": (*_NUMBERS, "index"),
    "row shift": (*_NUMBERS, "index"),
    "centre": (*_NUMBERS[:2], *_NUMBERS[3:], "index", "name", "missing factor"),
    "gravity axis": (*_NUMBERS, "index"),
    "alpha sign": ("sign", "number"),
    "a sign": ("sign", "number"),
    "gravity sign": ("sign", "number"),
}
"""Of kinds of readings the kinds of edit that are the same slip; of others only their own."""


def cause_of(repair: ProgramRepair, search: LineSearch) -> Cause:
    """A repair as a cause."""
    trial = search.trial
    rivals = repair.rivals if not _beside(repair, trial) else ()
    shared = {id(edit) for one in rivals[:1] for edit in one.edits}
    in_turn = sorted(repair.edits, key=lambda edit: id(edit) not in shared)  # what differs last
    told = [*_told(replace(repair, edits=tuple(in_turn)), trial)]
    known = [one for edit in repair.edits for one in named(edit, search)]
    is_ = _("`{piece}` is {thing}")
    told += [is_.format(piece=_typed(text), thing=thing) for text, thing in known[:_NAMED]]
    sentence = _("; ").join(dict.fromkeys(told))
    own = {id(edit) for edit in repair.edits}
    for rival in rivals:
        apart = tuple(edit for edit in rival.edits if id(edit) not in own)
        other = _("; ").join(dict.fromkeys(_told(replace(rival, edits=apart), trial)))
        sentence = _("{one}; or else {other}").format(one=sentence, other=other)
    return Cause(
        sentence,
        tuple(edit.kind for edit in repair.edits),
        tuple(_place(edit) for edit in repair.edits),
        repair.error,
        repair.cost,
    )


def _told(repair: ProgramRepair, trial: Trial) -> Iterator[str]:
    lines = _by_statement(repair, trial)
    for edit in repair.edits:
        statement, several = next(pair for pair in lines if any(one is edit for one in pair[1]))
        if statement is not None and len(several) > 1 and not _is_long(statement, several):
            if edit is several[0]:
                yield _of_statement(statement, several, trial)
            continue
        if edit.part == DATA:
            yield _of_data(edit, trial)
            continue
        old, new = _pieces(edit, trial) if edit.kind not in _MOVED else (_text(edit.node), "")
        said = {"place": _line(edit, trial), "old": old, "new": new, "what": _(_WHAT[edit.kind])}
        if edit.kind == "order of lines":
            yield _("{place}, `{old}`: {what}; it should stand {new}").format(**said)
        elif edit.kind == "missing statement":
            told = _("after {place}, {what}: `{new}`")
            yield told.format(place=said["place"], what=said["what"], new=_text(edit.node))
        elif edit.kind in _MOVED:
            yield _("{place}, `{old}`: {what}").format(**said)
        elif other := _beside(repair, trial):
            told = _("{place}, {what}: `{old}` should be `{new}` or `{other}`")
            yield told.format(**said, other=other)
        else:
            yield _("{place}, {what}: `{old}` should be `{new}`").format(**said)


def _beside(repair: ProgramRepair, trial: Trial) -> str:
    """What may stand as well in the line of a single edit; empty where it is of another line."""
    rival = repair.rivals[0] if len(repair.edits) == len(repair.rivals) == 1 else None
    if rival is None or len(rival.edits) != 1:
        return ""
    (one,), (other,) = repair.edits, rival.edits
    if DATA in (one.part, other.part) or {one.kind, other.kind} & {"order of lines", *_MOVED}:
        return ""
    (old, _new), (also, new) = _pieces(one, trial), _pieces(other, trial)
    same = one.part == other.part and row_of(one) == row_of(other)
    alike = one.kind == other.kind or (one.kind, other.kind) == ("sign", "transposed")
    return new if same and alike and old == also else ""


def _by_statement(
    repair: ProgramRepair, trial: Trial
) -> list[tuple[ast.stmt | None, list[ProgramEdit]]]:
    """The edits of a repair by the statement that they stand in; others each for itself."""
    found: list[tuple[ast.stmt | None, list[ProgramEdit]]] = []
    before = [_statements(tree) for tree in trial.trees]
    with changed(trial, repair.edits):
        after = [_statements(tree) for tree in trial.trees]
    for edit in repair.edits:
        own = None
        if edit.part != DATA and edit.kind not in ("order of lines", *_MOVED):
            own = before[edit.part].get(id(edit.node)) or after[edit.part].get(id(edit.node))
        same = next((edits for one, edits in found if one is own and own is not None), None)
        if same is None:
            found.append((own, [edit]))
        else:
            same.append(edit)
    return found


def _statements(tree: ast.AST, inside: ast.stmt | None = None) -> dict[int, ast.stmt]:
    """The statement around each node."""
    own = tree if isinstance(tree, ast.stmt) else inside
    out = {} if own is None else {id(tree): own}
    for child in ast.iter_child_nodes(tree):
        out |= _statements(child, own)
    return out


def _is_long(statement: ast.stmt, several: list[ProgramEdit]) -> bool:
    """Whether a statement is too long to be shown whole, and its places are apart from another."""
    if len(_text(statement)) <= _LONGEST:
        return False
    places = [edit.node for edit in several]
    return not any(one is not other and _inside(one, other) for one in places for other in places)


def _of_statement(statement: ast.stmt, several: list[ProgramEdit], trial: Trial) -> str:
    """What is wrong in several places of one statement."""
    old = _text(statement)
    with changed(trial, tuple(several)):
        new = _flat(_text(statement), old)
    what = _("; ").join(dict.fromkeys(_(_WHAT[edit.kind]) for edit in several))
    told = _("{place}, {what}: `{old}` should be `{new}`")
    place = _line(replace(several[0], node=statement), trial)
    return told.format(place=place, what=what, old=old, new=new)


def _line(edit: ProgramEdit, trial: Trial) -> str:
    part, first = trial.program.parts[edit.part], trial.program.parts[0]
    file, own = (Path(one.function.__code__.co_filename).name for one in (part, first))
    if file != own:
        said = {"number": row_of(edit), "file": file, "function": part.name}
        return _("line {number} of {file} (in {function})").format(**said)
    if edit.part and not part.sets:
        return _("line {number} (in {function})").format(number=row_of(edit), function=part.name)
    return _("line {number}").format(number=row_of(edit))


def _place(edit: ProgramEdit) -> str:
    return str(edit.node) if edit.part == DATA else f"line {row_of(edit)}"


def _of_data(edit: ProgramEdit, trial: Trial) -> str:
    name = label(edit)
    number = line_of(trial.program.parts[0].function, edit.node, edit.place)
    if number is not None:
        name = _("line {number}, {name}").format(number=number, name=name)
    said = {"name": name, "what": _(_WHAT[edit.kind])}
    if edit.exchanged is not None:
        old_, new_ = edit.exchanged
        told = _("{name}, {what}: `{old}` should be `{new}`")
        if edit.kind in ("rows swapped", "columns swapped"):
            told = _("{name}, {what}: `{old}` and `{new}`")
        return told.format(**said, old=old_, new=new_)
    if edit.numbers is None:
        return _("{name}, {what}").format(**said)
    old, new = edit.numbers
    for leaf in leaves(trial):  # another edit may have stood there when it was found
        if (leaf.node, leaf.place) == (edit.node, edit.place):
            old = float(leaf.value)
    told = _("{name}, {what}: {old} should be {new}")
    return told.format(**said, old=shown(old), new=shown(new))


def _pieces(edit: ProgramEdit, trial: Trial) -> tuple[str, str]:
    """What stands there, and what should: the widest that is short."""
    tree = trial.trees[edit.part]
    above = {id(child): node for node in nodes(tree) for child in ast.iter_child_nodes(node)}
    chain = [edit.node]
    while id(chain[-1]) in above and isinstance(chain[-1], ast.expr):
        chain.append(above[id(chain[-1])])
    chain = [n for n in chain if not isinstance(n, ast.FunctionDef | ast.comprehension)]
    if edit.kind == "order of lines":
        return _text(edit.node), _after(edit)
    before = [_text(node) for node in chain]
    with changed(trial, (edit,)):
        after = [_text(node) for node in chain]
        if before[0] == after[0] and len(edit.changes) == 1:
            new = edit.changes[0].new
            if before[-1] == after[-1]:
                after = [_text(new)] if isinstance(new, ast.AST) else after
                before = before[:1]
    pairs = [(one, other) for one, other in zip(before, after, strict=True) if one != other]
    short = [pair for pair in pairs if max(map(len, pair)) <= _WIDE]
    old, new = short[-1] if short else pairs[0] if pairs else (before[0], after[0])
    return old, _flat(new, old)


def _flat(new: str, old: str) -> str:
    """A piece with signs and factors of products as people type them: ``-2*a*b`` for ``2*(-a*b)``.

    One that had such parentheses before keeps them.
    """
    try:
        tree, before = ast.parse(new), ast.parse(old)
    except SyntaxError:  # the head of a loop
        return new
    if any(map(_is_odd, nodes(before))) or not any(map(_is_odd, nodes(tree))):
        return new
    return _text(_Flat().visit(tree).body[0])


def _is_odd(node: ast.AST) -> bool:
    return _in_front(node) or _is_signed_twice(node) or _is_sum_added(node)


def _is_sum_added(node: ast.AST) -> bool:
    """Whether a sum in parentheses is added: ``a + (b + c)``."""
    if not isinstance(node, ast.BinOp) or not isinstance(node.op, ast.Add):
        return False
    return isinstance(node.right, ast.BinOp) and isinstance(node.right.op, SUMS)


def _is_signed_twice(node: ast.AST) -> bool:
    """Whether something that begins with a minus is added, or subtracted: ``a - -b*c``."""
    if not isinstance(node, ast.BinOp) or not isinstance(node.op, ast.Add | ast.Sub):
        return False
    first = factors(node.right)[0]
    return isinstance(first, ast.UnaryOp) and isinstance(first.op, ast.USub)


def _in_front(node: ast.AST) -> bool:
    """Whether it is something times a product in parentheses, or a minus in front of one."""
    if isinstance(node, ast.UnaryOp) and isinstance(node.op, ast.USub):
        parts = factors(node.operand)
        return len(parts) > 1 and not isinstance(parts[0], ast.Constant | ast.UnaryOp)
    if not isinstance(node, ast.BinOp) or not isinstance(node.op, ast.Mult):
        return False
    return len(factors(node.right)) > 1


def _product(*parts: ast.expr) -> ast.expr:
    return reduce(lambda one, other: ast.BinOp(one, ast.Mult(), other), parts)


def _numbers_first(one: ast.expr, other: ast.expr, *rest: ast.expr) -> list[ast.expr]:
    """Factors with two numbers in front as one, and no 1: ``0.5*(2*a)`` is ``a``."""
    first, last = (getattr(x, "value", None) for x in (one, other))
    if not isinstance(first, int | float) or not isinstance(last, int | float):
        return [one, other, *rest]
    value = first * last
    if value == 1 and rest:
        return [*rest]
    return [ast.Constant(int(value) if value == int(value) else value), *rest]


class _Flat(ast.NodeTransformer):
    def visit_UnaryOp(self, node: ast.UnaryOp) -> ast.expr:
        self.generic_visit(node)
        if not _in_front(node):
            return node
        first, *rest = factors(node.operand)
        return _product(ast.UnaryOp(node.op, first), *rest)

    def visit_BinOp(self, node: ast.BinOp) -> ast.expr:
        self.generic_visit(node)
        if _is_sum_added(node):
            first, terms = chain(node.right, SUMS)
            return joined(node.left, [(ast.Add(), first), *terms])
        if _is_signed_twice(node):
            first, *rest = factors(node.right)
            assert isinstance(first, ast.UnaryOp)
            other = ast.Sub() if isinstance(node.op, ast.Add) else ast.Add()
            return ast.BinOp(node.left, other, _product(first.operand, *rest))
        if not _in_front(node):
            return node
        first, *rest = factors(node.right)
        if isinstance(first, ast.UnaryOp) and isinstance(first.op, ast.USub):
            front, *rest = _numbers_first(node.left, first.operand, *rest)
            return _product(ast.UnaryOp(ast.USub(), front), *rest)
        return _product(*_numbers_first(node.left, first, *rest))


def _after(edit: ProgramEdit) -> str:
    later = edit.changes[0].new
    k = next(i for i, one in enumerate(later) if one is edit.node)
    if k + 1 < len(later):
        return _("before line {number}").format(number=later[k + 1].lineno)
    return _("after line {number}").format(number=later[k - 1].lineno)


def _text(node: ast.AST) -> str:
    """A piece of a program as it is usually typed."""
    if isinstance(node, ast.If) and getattr(node.test, "value", None) is True:  # a line and another
        return "; ".join(map(_text, node.body))
    inner = [*node.body, *node.orelse] if isinstance(node, ast.If) else []
    if isinstance(node, ast.If) and node.lineno in [one.lineno for one in inner]:  # it was made
        one, last = ("; ".join(map(_text, block)) for block in (node.body, node.orelse))
        return f"if {_text(node.test)}: {one}; else: {last}"
    text = ast.unparse(node).replace("_turn() and ", "")  # what ends loops is not the user's
    text = re.sub(rf" if (\w+) is {DEFAULT} else \1", "", text)
    return _typed(text.partition("\n")[0].rstrip(":"))


def _typed(text: str) -> str:
    text = re.sub(r"(?<![\w)\]])--(?=\d)", "", text)  # a minus of a number that has one
    return re.sub(r" (\*\*|\*|/) ", r"\1", text)


def believed(repair: ProgramRepair, search: LineSearch) -> ProgramRepair | None:
    """A repair as it may be told; None where it hides the slip.

    A test that is changed until it never holds says only that its branch is wrong; the robot's own
    g is not to be another; decimals of a rounding and the step of a difference are no formula; and
    what takes a statement's own part away and adds the right one names nothing. A line that writes
    somewhere else where it does nothing is one too many. What is put to one sum and taken from
    another makes a number of two that are there by chance.
    """
    for _statement, own in _by_statement(repair, search.trial):
        if sum(edit.kind == "missing term" for edit in own) > 1:
            return None
    added = [one for edit in repair.edits for one in _added(edit)]
    if any(text == other and sign != turned for text, sign in added for other, turned in added):
        return None
    exact = repair.error <= TOLERANCES.left_of_several or search.asked.differences
    if len(repair.edits) > _PAIR and repair.error > TOLERANCES.left_of_three:
        return None
    if len(repair.edits) > 1 and not (exact and _needed(repair, search)):
        return None
    edits = []
    for edit in repair.edits:
        if _robots_own(edit, search) or _of_rounding(edit, search) or _a_step(edit, repair):
            return None
        edits.append(_branch(edit, repair, search) or _idle(edit, repair, search) or edit)
    rivals = [believed(one, search) for one in repair.rivals]
    known = tuple(one for one in rivals if one)
    return replace(repair, edits=as_exchanged(edits), rivals=known)


def _added(edit: ProgramEdit) -> Iterator[tuple[str, bool]]:
    """What an edit adds to a sum, or takes from it."""
    new = edit.changes[0].new
    more = edit.kind == "missing term" and edit.part != DATA and isinstance(new, ast.BinOp)
    if more and isinstance(new.op, ast.Add | ast.Sub):
        yield _text(new.right), isinstance(new.op, ast.Sub)


def _needed(repair: ProgramRepair, search: LineSearch) -> bool:
    """Whether each of several edits is of the user's program, and the others alone do not do.

    Where they do for this arm alone, all together must hold for another one.
    """
    for edit in repair.edits:
        own = edit.part == DATA or edit.kind == "missing statement"
        own = own or _inside(edit.node, search.trial.trees[edit.part])
        others = tuple(one for one in repair.edits if one is not edit)
        if not own or _right(others, search):
            return False
        if _fits(others, search) and not search.arms.holds_elsewhere(repair.edits):
            return False
    return True


def _robots_own(edit: ProgramEdit, search: LineSearch) -> bool:
    """Whether the number that should be another is the robot's own: of the same name, or at all."""
    table = table_of(search.case.robot)
    if edit.part != DATA or edit.numbers is None or table is None:
        return False
    named = vocabulary(table).values
    own = None if edit.place else named.get(edit.node)
    own = named.get(f"{edit.node}1") if own is None and table.n == 1 else own  # l of one link
    old, new = edit.numbers
    if own is not None and float(own) == old:
        return True
    is_old, is_new = (is_own(search.case.robot, x) for x in (old, new))
    turned = new == -old and bool(edit.place)  # a point of axes may lie on the other side
    return is_old and not (is_new or edit.of_the_arm or turned)


def _of_rounding(edit: ProgramEdit, search: LineSearch) -> bool:
    """Whether the edit is in the decimals of ``np.round``."""
    if edit.part == DATA:
        return False
    for node in nodes(search.trial.trees[edit.part]):
        if isinstance(node, ast.Call) and called(node) in _ROUNDINGS:
            decimals = [*node.args[1:], *(word.value for word in node.keywords)]
            if any(_inside(edit.node, one) for one in decimals):
                return True
    return False


def _a_step(edit: ProgramEdit, repair: ProgramRepair) -> bool:
    """Whether a number is made small until only the noise of differences is left."""
    if edit.numbers is None or repair.error <= TOLERANCES.formula_agrees:
        return False
    old, new = map(abs, edit.numbers)
    return bool(0 < new < _STEP * old)


def _branch(edit: ProgramEdit, repair: ProgramRepair, search: LineSearch) -> ProgramEdit | None:
    """The whole test, where the program is right too if it never holds, or always."""
    if edit.part == DATA or edit.kind == "condition":
        return None
    for node in nodes(search.trial.trees[edit.part]):
        if isinstance(node, ast.If | ast.IfExp) and _inside(edit.node, node.test):
            for always in (False, True):
                change = FieldChange(node, "test", ast.Constant(always))
                other = ProgramEdit(edit.part, (change,), "condition", edit.cost, node.test)
                whole = tuple(other if one is edit else one for one in repair.edits)
                if _right(whole, search):
                    return other
    return None


def _idle(edit: ProgramEdit, repair: ProgramRepair, search: LineSearch) -> ProgramEdit | None:
    """The whole line, where it is to write somewhere else, and the program is right without it."""
    if edit.part == DATA or edit.kind in ("order of lines", *_MOVED):
        return None
    tree = search.trial.trees[edit.part]
    line = _statements(tree).get(id(edit.node))
    if not isinstance(line, ast.Assign | ast.AugAssign):
        return None
    target, value = targets_of(line)[0], ast.unparse(line.value)
    if not isinstance(target, ast.Subscript):
        return None
    place = ast.unparse(target)
    with changed(search.trial, (edit,)):
        if ast.unparse(line.value) != value or ast.unparse(target) == place:
            return None
    for node in nodes(tree):
        for field in BLOCKS:
            block = getattr(node, field, None)
            if not isinstance(block, list) or not any(one is line for one in block):
                continue
            rest = [ast.Pass() if one is line else one for one in block]
            change = FieldChange(node, field, rest)
            other = ProgramEdit(edit.part, (change,), "extra statement", edit.cost, line)
            if _right(tuple(other if one is edit else one for one in repair.edits), search):
                return other
    return None


def _inside(node: object, of: ast.AST) -> bool:
    return any(one is node for one in nodes(of))


def _fits(edits: tuple[ProgramEdit, ...], search: LineSearch) -> bool:
    """Whether edits make the program right, be it for this arm alone."""
    try:
        with quietly(), changed(search.trial, edits):
            return search.asked.fits()
    except NoProgramError:
        return False


def _right(edits: tuple[ProgramEdit, ...], search: LineSearch) -> bool:
    try:
        with quietly(), changed(search.trial, edits):
            return search.verdict(edits) is not None
    except NoProgramError:
        return False
