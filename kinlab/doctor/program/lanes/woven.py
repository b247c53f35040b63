"""The trees of a program with all edits in them, each asked for its lanes.

An expression of which there are edits becomes a call that gives its value, and what each edit
makes of it: ``_pick((3, 8), lambda: a + b, lambda _edit: a - b if _edit < 8 else a * b)``. These
calls are named in front of their statement, so that an expression that stands in several others
is written once.
"""

from __future__ import annotations

import ast
from collections import defaultdict
from collections.abc import Sequence
from typing import Any

import numpy as np

from kinlab.doctor.bytecode.syntax import called, located, names, nodes, pieces, shallow
from kinlab.doctor.program.lanes.functions import PARTS
from kinlab.doctor.program.lanes.room import with_room
from kinlab.doctor.program.lanes.ways import WRITES, apart, function_of, loaded, may_run_apart
from kinlab.doctor.program.observed import Observed
from kinlab.doctor.program.places import (
    BLOCKS,
    DATA,
    ProgramEdit,
    Spot,
    hanging,
    root,
    with_other,
)
from kinlab.doctor.program.trial import FieldChange, Trial

_SIMPLE = ast.Assign | ast.AugAssign | ast.AnnAssign | ast.Return | ast.Expr
"""Statements whose expressions are asked."""
_NUMPY = ("np", "numpy")
"""Names of the library whose ``append`` writes into nothing."""
_COUNTS = ("range", "len", "isinstance", "sorted", "map", "next")
"""Calls that no number with lanes can be given."""
_RUNS = ("enumerate", "zip", "reversed")
"""Calls that give what they are given one after another."""
_LARGE = 30
"""A whole number that counts nothing: one of degrees."""
_EDIT, _ASKED = "_edit", "_asked"
_LISTS = ast.ListComp | ast.SetComp | ast.GeneratorExp

Key = tuple[int, str, int | None]
Edits = Sequence[Sequence[ProgramEdit]]


class Woven:
    """A program's trees with edits in them.

    Args:
        trial: the program.
        observed: its expressions as it is.
        edits: of each effect those that have it; their numbers are their places here.
        watched: an expression whose values are told as they are met.

    Attributes:
        placed: the edits that are in them; others are none that lanes can follow.
        data: what edits change in the data: the number of each, and what is put where.
    """

    def __init__(
        self, trial: Trial, observed: Observed, edits: Edits, watched: ast.expr | None = None
    ) -> None:
        self.observed, self._count, self._watched = observed, len(edits), watched
        self._above: dict[int, Spot] = {}
        self._lists: dict[int, tuple[ast.AST, str]] = {}
        for tree in trial.trees:
            above, lists = hanging(tree)
            self._above |= above
            self._lists |= lists
        self._sites: dict[Key, list[tuple[int, ast.expr]]] = defaultdict(list)
        self._ways: dict[int, list[tuple[int, ast.expr]]] = defaultdict(list)
        self._lines: dict[tuple[int, int], list[tuple[int, ast.expr, ast.expr]]] = defaultdict(list)
        self._same: dict[int, ast.AST] = {}
        self._new: dict[int, Spot] = {}
        self._holding: set[int] = set()
        self.data: list[tuple[int, FieldChange]] = []
        self.placed: set[int] = set()
        self._at: list[tuple[int, list[Key]]] = []
        self._loops: list[tuple[int, ast.AST, set[str]]] = []
        self._reads: list[tuple[int, ast.AST, set[str]]] = []
        for number, alike in enumerate(edits):
            for edit in alike:
                if self._put(number, edit):
                    self.placed.add(number)
                    break
        self._names = 0
        if watched is not None:
            self._mark(self._above[id(watched)][0])

    def _put(self, number: int, edit: ProgramEdit) -> bool:
        """Puts an edit where it is asked, if it can be."""
        if edit.part == DATA:
            self.data += [(number, change) for change in edit.changes]
            return True
        if len(edit.changes) == 1:
            put = self._put_either if isinstance(edit.changes[0].new, ast.If) else self._put_line
            if put(number, edit.changes[0]):
                return True
        spots = [self._spot(change) for change in edit.changes]
        sound = [spot for spot in spots if spot is not None]
        if len(sound) < len(spots):
            return len(spots) == 1 and self._put_apart(number, edit.changes[0])
        for (parent, name, k), new in sound:
            self._sites[(id(parent), name, k)].append((number, new))
            self._mark(parent)
            self._at.append((number, self._path((parent, name, k))))
            self._reads.append((number, parent, {*names(new)}))
        return True

    def _put_apart(self, number: int, change: FieldChange) -> bool:
        """Puts an edit of what a loop runs over, or of a condition, where that is asked."""
        spot, new = self._place(change), change.new
        if spot is None:
            return False
        while isinstance(spot[0], ast.expr) and id(spot[0]) in self._above:
            _now, new, spot = self._outside(spot, new)
        statement, name, _k = spot
        asked = {ast.For: "iter", ast.If: "test"}.get(type(statement))
        if name != asked or not isinstance(new, ast.expr) or not may_run_apart(statement):
            return False
        if isinstance(statement, ast.For) and {*names(statement.target)} & {*names(new)}:
            return False  # from where the counter was left, which other lanes have had since
        if isinstance(statement, ast.For):
            self._loops.append((number, statement, {*names(statement.target)}))
        self._ways[id(statement)].append((number, new))
        self._mark(statement)
        self._at.append((number, [(id(statement), name, None)]))
        return True

    def _put_line(self, number: int, change: FieldChange) -> bool:
        """Puts a line more into a block: whatever it sets is then asked for its lanes."""
        node, block = change.holder, getattr(change.holder, str(change.field), None)
        new = change.new
        if change.field not in BLOCKS or not isinstance(block, list) or len(new) != len(block) + 1:
            return False
        at = next((k for k, one in enumerate(block) if one is not new[k]), len(block))
        line = new[at]
        if new[at + 1 :] != block[at:] or not isinstance(line, ast.Assign | ast.AugAssign):
            return False
        target = line.target if isinstance(line, ast.AugAssign) else line.targets[0]
        if not isinstance(target, ast.Name | ast.Subscript):
            return False
        value = line.value
        if isinstance(line, ast.AugAssign):
            value = ast.BinOp(loaded(target), line.op, line.value)
        self._lines[id(block), at].append((number, target, value))
        self._mark(node)
        self._at.append((number, [(id(block), "line", at)]))
        return True

    def _put_either(self, number: int, change: FieldChange) -> bool:
        """Puts a condition around a statement and another: each sets what it did, or is lost."""
        spot, new = self._place(change), change.new
        if spot is None or spot[2] is None or [len(new.body), len(new.orelse)] != [1, 1]:
            return False
        own, block = _at(spot), getattr(spot[0], spot[1])
        first = new.body[0] is own
        other = new.orelse[0] if first else new.body[0]
        if not isinstance(own, ast.Assign) or not isinstance(other, ast.Assign):
            return False
        for line, holds in ((own, first), (other, not first)):
            both = [line.value, loaded(line.targets[0])]
            value = ast.IfExp(new.test, *(both if holds else both[::-1]))
            if line is own:
                self._sites[(id(own), "value", None)].append((number, value))
            else:
                self._lines[id(block), spot[2] + 1].append((number, line.targets[0], value))
        self._mark(own)
        self._at.append((number, [(id(own), "value", None)]))
        return True

    def _mark(self, node: ast.AST) -> None:
        while id(node) not in self._holding:
            self._holding.add(id(node))
            if id(node) not in self._above:
                break
            node = self._above[id(node)][0]

    def _path(self, spot: Spot) -> list[Key]:
        """A place, and those in which it is, down from its statement."""
        path: list[Key] = []
        while True:
            parent, name, k = spot
            path.append((id(parent), name, k))
            if isinstance(parent, ast.stmt) or id(parent) not in self._above:
                return path
            spot = self._above[id(parent)]

    def inside(self) -> Any:
        """Which edits are in one another, or read where the other's loop left off, (E, E)."""
        found = np.zeros((self._count, self._count), dtype=bool)
        at: dict[Key, list[int]] = defaultdict(list)
        for number, path in self._at:
            at[path[0]].append(number)
        for number, path in self._at:
            for key in path:
                found[number, at.get(key, [])] = True
        for number, loop, counters in self._loops:
            for other, place, read in self._reads:
                if counters & read and not self._is_in(place, loop):
                    found[number, other] = True
        return found | found.T

    def _is_in(self, node: ast.AST, loop: ast.AST) -> bool:
        while node is not loop and id(node) in self._above:
            node = self._above[id(node)][0]
        return node is loop

    # -------- Where an edit is asked

    def _place(self, change: FieldChange) -> Spot | None:
        """The place that an edit changes; None of a list that is none of the trees'."""
        if not isinstance(change.holder, list):
            return change.holder, change.field, None
        if id(change.holder) not in self._lists:
            return None
        return *self._lists[id(change.holder)], change.field

    def _spot(self, change: FieldChange) -> tuple[Spot, ast.expr] | None:
        """The expression that an edit changes, and what that becomes; None without one."""
        spot, new = self._place(change), change.new
        if spot is None:
            return None
        now = _at(spot)
        if isinstance(now, ast.stmt):
            return self._of_statement(now, new)
        if isinstance(spot[0], ast.Tuple) and spot[1] == "elts" and isinstance(new, list):
            outer = self._above[id(spot[0])][0]
            if isinstance(outer, ast.Assign) and outer.value is not spot[0]:
                return (outer, "value", None), _permuted(outer.value, now, new)
        if isinstance(spot[0], ast.AugAssign) and spot[1] == "op":
            both = {type(now), type(new)} == {ast.Add, ast.Sub}
            value = ast.UnaryOp(ast.USub(), spot[0].value)
            return ((spot[0], "value", None), value) if both else None
        while not (isinstance(now, ast.expr) and isinstance(new, ast.expr)):
            if isinstance(spot[0], ast.stmt):
                return None
            now, new, spot = self._outside(spot, new)
        top = self._outermost(spot)
        while top is not None and (spot[0] is not top[0] or spot[1:] != top[1:]):
            _now, new, spot = self._outside(spot, new)
        if top is None or not isinstance(new, ast.expr):
            return None
        parts = [*pieces(new), *pieces(_at(spot))]
        calls = (node for node in parts if isinstance(node, ast.Call))
        writes = any(called(one) in WRITES and root(one.func) not in _NUMPY for one in calls)
        return None if writes else (spot, new)

    def _outside(self, spot: Spot, new: Any) -> tuple[ast.AST, ast.AST, Spot]:
        """The node in which a place is, with something else there."""
        parent, name, k = spot
        other: ast.AST = with_other(parent, name, k, new)
        self._same[id(other)] = parent
        self._new[id(other)] = (other, name, k)
        return parent, other, self._above[id(parent)]

    def _outermost(self, spot: Spot) -> Spot | None:
        """The place of the value that numbers with lanes may be part of; None without one."""
        best: Spot | None = spot
        at = spot
        while True:
            parent, name, _k = at
            node = _at(at)
            if isinstance(parent, ast.Call) and name == "args" and called(parent) in _RUNS:
                pass  # entries may have lanes, not what is run over
            elif not self._follows(parent, name, node):
                best = None
            elif best is None:
                best = at
            if isinstance(parent, ast.stmt):
                sound = isinstance(parent, _SIMPLE) and name == "value"
                passed = isinstance(parent, ast.For) and name == "iter" and not _counts(node)
                return best if sound or passed else None
            if not isinstance(parent, ast.AST) or id(parent) not in self._above:
                return None
            if isinstance(parent, ast.Lambda):
                return best if name == "body" and self._in_a_value(parent) else None
            if isinstance(parent, ast.JoinedStr | ast.NamedExpr | ast.arguments):
                return None
            at = self._above[id(parent)]

    def _in_a_value(self, node: ast.AST) -> bool:
        """Whether a statement whose expressions are asked sets what a node is in."""
        while id(node) in self._above and not isinstance(node, ast.stmt):
            node, name, _k = self._above[id(node)]
        return isinstance(node, _SIMPLE) and name == "value"

    def _follows(self, parent: ast.AST, name: str, node: Any) -> bool:
        """Whether a node may have lanes where it stands."""
        if isinstance(node, ast.keyword):
            return called(parent) not in _COUNTS if isinstance(parent, ast.Call) else False
        if not isinstance(node, ast.expr) or isinstance(getattr(node, "ctx", None), ast.Store):
            return False
        inner = ast.Subscript | ast.Slice | ast.Attribute | ast.Starred | ast.comprehension
        if isinstance(parent, inner | ast.Compare | ast.BoolOp | ast.GeneratorExp):
            # what a generator gives is used where it stands; what it runs over is not a number
            return isinstance(parent, ast.GeneratorExp) and name == "elt"
        if isinstance(parent, ast.UnaryOp) and isinstance(parent.op, ast.Not):
            return False
        if isinstance(parent, ast.IfExp) and name == "test":
            return False
        if isinstance(parent, ast.Call) and (name == "func" or called(parent) in _COUNTS):
            return False
        above = self._above.get(id(parent), (None,))[0]
        if isinstance(parent, ast.Tuple) and isinstance(above, ast.Subscript):
            return False
        if isinstance(node, ast.GeneratorExp | ast.Slice | ast.Lambda):
            return False
        seen = self.observed.of(node)
        values = [] if seen is None else seen.values
        large = any(np.max(np.abs(x), initial=0) >= _LARGE for x in values)
        if seen is not None and seen.whole and seen.shape is not None and not large:
            # what counts is a whole number, or one of several that are run over
            runs = isinstance(parent, ast.For)
            return not runs if seen.shape else isinstance(parent, ast.List)
        numeric = seen is not None and seen.shape is not None
        if isinstance(node, ast.Tuple | ast.List | ast.Dict) and isinstance(parent, ast.Call):
            numeric = numeric or called(parent) in WRITES  # put at the end of a list as it is
        return numeric or isinstance(node, _LISTS) or isinstance(parent, ast.stmt)

    def _of_statement(self, now: ast.stmt, new: Any) -> tuple[Spot, ast.expr] | None:
        """Of a statement that is left out, or becomes a sum: what it sets instead."""
        if isinstance(now, ast.AugAssign) and isinstance(new, ast.Pass):
            sums = isinstance(now.op, ast.Add | ast.Sub)
            return ((now, "value", None), ast.Constant(0.0)) if sums else None
        if isinstance(now, ast.Assign) and len(now.targets) == 1:
            target = now.targets[0]
            if not isinstance(target, ast.Name | ast.Subscript):
                return None
            old = shallow(target)
            old.ctx = ast.Load()
            if isinstance(new, ast.Pass):
                return (now, "value", None), old
            if isinstance(new, ast.AugAssign) and new.value is now.value:
                return (now, "value", None), ast.BinOp(old, new.op, now.value)
        return None

    # -------- The trees

    def tree(self, old: Any) -> Any:
        """A function's definition, or the lines of a module, with the edits in it."""
        found = shallow(old)
        found.body = self._body(old.body)
        return located(with_room(_with_parts(found)))

    def _body(self, body: list[ast.stmt], alone: bool = False) -> list[ast.stmt]:
        """A block; whether it may run for some lanes alone."""
        found: list[ast.stmt] = self._added(body, 0, alone)
        for k, statement in enumerate(body):
            if not alone and id(statement) not in self._holding:
                found.append(statement)
            elif isinstance(statement, _SIMPLE):
                found += self._statement(statement, alone)
            elif isinstance(statement, ast.ClassDef):
                found += self._of_class(statement, alone)
            elif isinstance(statement, ast.match_case | ast.ExceptHandler):
                one: Any = shallow(statement)
                one.body = self._body(statement.body, alone)
                found.append(one)
            else:
                found += self._block(statement, alone)
            found += self._added(body, k + 1, alone)
        return found

    def _of_class(self, statement: ast.ClassDef, alone: bool) -> list[ast.stmt]:
        """A class: what is asked of its members stands before it, where functions find it."""
        own = {name for one in statement.body for name in names(one, ast.Store)}
        if own.intersection(name for one in statement.body for name in names(one, ast.Load)):
            return [statement]
        other = shallow(statement)
        every = self._body(statement.body, alone)
        asked = [one for one in every if isinstance(one, ast.Assign) and _is_asked(one)]
        other.body = [one for one in every if one not in asked]
        return [*asked, other]

    def _added(self, body: list[ast.stmt], at: int, alone: bool) -> list[ast.stmt]:
        """The lines that edits put at a place of a block, each for its lanes."""
        found: list[ast.stmt] = []
        for number, target, value in self._lines.get((id(body), at), ()):
            given = [
                ast.Constant((number,)),  # type: ignore[arg-type]
                function_of(loaded(target)),
                function_of(value, (_EDIT,)),
            ]
            line = ast.Assign([target], ast.Call(ast.Name("_pick", ast.Load()), given, []))
            if alone:
                line.value = apart(line, line.value)
            if isinstance(target, ast.Subscript):
                there = ast.Call(ast.Name("_there", ast.Load()), given[:2], [])
                found.append(ast.For(ast.Name(_EDIT, ast.Store()), there, [line], []))
            else:
                found.append(line)
        return found

    def _block(self, statement: ast.stmt, alone: bool) -> list[ast.stmt]:
        """A loop, a condition."""
        found: list[ast.stmt] = []
        other: Any = shallow(statement)
        ways = self._ways.get(id(statement))
        if isinstance(statement, ast.For):
            asked: dict[Key, Any] = {}
            other.iter = self._expression((statement, "iter", None), (), asked)
            found += [one for one, _name, _given in asked.values()]
        for name in BLOCKS:
            block = getattr(statement, name, None)
            if isinstance(block, list):
                setattr(other, name, self._body(block, alone or bool(ways)))
        if not ways:
            return [*found, other]
        looped = isinstance(statement, ast.For)
        name = "iter" if looped else "test"
        numbers: Any = tuple(number for number, _new in ways)
        given = [ast.Constant(numbers), function_of(getattr(other, name)),
                 function_of(_chosen(ways), (_EDIT,))]  # fmt: skip
        if isinstance(statement, ast.For):
            given.append(function_of(loaded(statement.target)))
        call = ast.Call(ast.Name("_turns" if looped else "_sides", ast.Load()), given, [])
        setattr(other, name, call if looped else ast.Name("_yes", ast.Load()))
        if not looped:
            other = ast.For(ast.Name("_yes", ast.Store()), call, [other], [])
        return [*found, other]

    def _statement(self, statement: Any, alone: bool) -> list[ast.stmt]:
        inside = pieces(statement)
        if any(isinstance(node, ast.Yield | ast.YieldFrom | ast.NamedExpr) for node in inside):
            return [statement]
        if any(isinstance(node, ast.Name) and node.id == "super" for node in inside):
            return [statement]
        asked: dict[Key, tuple[ast.stmt | None, str, tuple[str, ...]]] = {}
        other = shallow(statement)
        other.value = self._expression((statement, "value", None), (), asked)
        if alone:
            other.value = apart(statement, other.value)
        return [*(one for one, _name, _given in asked.values() if one is not None), other]

    def _expression(self, spot: Spot, scope: tuple[str, ...], asked: dict[Key, Any]) -> Any:
        """An expression with the edits in it."""
        parent, name, k = spot
        return self._edited(_at(spot), (id(parent), name, k), scope, asked)

    def _edited(
        self, node: Any, key: Key | None, scope: tuple[str, ...], asked: dict[Key, Any]
    ) -> Any:
        found = self._asked_of(node, key, scope, asked)
        if node is not self._watched:
            return found
        return ast.Call(ast.Name("_met", ast.Load()), [found], [])

    def _asked_of(
        self, node: Any, key: Key | None, scope: tuple[str, ...], asked: dict[Key, Any]
    ) -> Any:
        edited = None if key is None else self._sites.get(key)
        if not edited or key is None:
            return self._inside(node, scope, asked)
        if key not in asked:
            self._names += 1
            label = f"{_ASKED}{self._names}"
            asked[key] = (None, label, scope)
            numbers: Any = tuple(number for number, _new in edited)
            new = _chosen([(number, self._inside(new, scope, asked)) for number, new in edited])
            given = [
                ast.Constant(numbers),
                function_of(self._inside(node, scope, asked)),
                function_of(new, (_EDIT,)),
            ]
            call = ast.Call(ast.Name("_pick", ast.Load()), given, [])
            target = ast.Name(label, ast.Store())
            asked[key] = (ast.Assign([target], function_of(call, scope)), label, scope)
        _statement, label, own = asked[key]
        if not {*own} <= {*scope}:  # an edit puts it where its names are others: without edits
            inside = function_of(self._inside(node, scope, asked))
            numbers = tuple(number for number, _new in edited)
            lost = [ast.Constant(numbers), inside, ast.Constant(None)]
            return ast.Call(ast.Name("_pick", ast.Load()), lost, [])
        names: list[ast.expr] = [ast.Name(one, ast.Load()) for one in own]
        return ast.Call(ast.Name(label, ast.Load()), names, [])

    def _inside(self, node: Any, scope: tuple[str, ...], asked: dict[Key, Any]) -> Any:
        """An expression with the edits of its pieces."""
        if not self._holds(node):
            return node
        if isinstance(node, _LISTS | ast.DictComp):
            targets = [one for part in node.generators for one in nodes(part.target)]
            scope = (*scope, *(one.id for one in targets if isinstance(one, ast.Name)))
            scope = tuple(dict.fromkeys(scope))
        if isinstance(node, ast.Lambda):
            scope = tuple(dict.fromkeys((*scope, *_given(node))))
        other = shallow(node)
        own = id(self._same.get(id(node), node))
        for name, value in ast.iter_fields(node):
            if name in ("slice", "generators", "ctx", "func") and not (
                name == "func" and isinstance(value, ast.Attribute)
            ):
                continue
            if isinstance(value, list):
                keys = [self._key(node, own, name, k) for k in range(len(value))]
                pieces = zip(value, keys, strict=True)
                setattr(other, name, [self._piece(one, key, scope, asked) for one, key in pieces])
            elif isinstance(value, ast.AST):
                key = self._key(node, own, name, None)
                setattr(other, name, self._piece(value, key, scope, asked))
        return other

    def _key(self, node: ast.AST, own: int, name: str, k: int | None) -> Key | None:
        """Under which edits of a piece are known; None of what an edit has put there."""
        _other, field, place = self._new.get(id(node), (None, "", None))
        new = field == name and (place is None or place == k)
        return None if new else (own, name, k)

    def _piece(
        self, value: Any, key: Key | None, scope: tuple[str, ...], asked: dict[Key, Any]
    ) -> Any:
        if isinstance(value, ast.expr):
            return self._edited(value, key, scope, asked)
        if isinstance(value, ast.keyword):
            return self._inside(value, scope, asked)
        return value

    def _holds(self, node: Any) -> bool:
        """Whether there are edits in it; what an edit puts there may have pieces of its own."""
        if id(node) in self._holding:
            return True
        if id(node) in self._above:
            return False
        return any(id(one) in self._holding for one in pieces(node))


def _with_parts(node: Any, asked: bool = False) -> Any:
    """``x.imag`` as a call: an array of numbers with lanes has only that of real ones."""
    if not any(isinstance(one, ast.Attribute) and one.attr in PARTS for one in nodes(node)):
        return node
    other = shallow(node)
    for name, value in ast.iter_fields(node):
        if isinstance(value, list):
            new = [_with_parts(x) if isinstance(x, ast.AST) else x for x in value]
            setattr(other, name, new)
        elif isinstance(value, ast.AST):
            setattr(other, name, _with_parts(value, name == "func"))
    if not isinstance(node, ast.Attribute) or node.attr not in PARTS or asked:
        return other
    if not isinstance(node.ctx, ast.Load):
        return other
    return ast.Call(ast.Name("_part", ast.Load()), [other.value, ast.Constant(node.attr)], [])


def _is_asked(line: ast.Assign) -> bool:
    target = line.targets[0]
    return isinstance(target, ast.Name) and target.id.startswith(_ASKED)


def _given(function: ast.Lambda) -> list[str]:
    """The names of what a function is given."""
    return [node.arg for node in nodes(function.args) if isinstance(node, ast.arg)]


def _counts(node: ast.expr) -> bool:
    """Whether a loop runs over whole numbers."""
    return any(isinstance(one, ast.Call) and called(one) == "range" for one in nodes(node))


def _permuted(value: ast.expr, names: list[ast.expr], other: list[ast.expr]) -> ast.expr:
    """What is set where names stand in another order."""
    given = ast.Name("_given", ast.Load())
    entries: list[ast.expr] = [
        ast.Subscript(given, ast.Constant(other.index(one)), ast.Load()) for one in names
    ]
    return ast.Call(function_of(ast.Tuple(entries, ast.Load()), ("_given",)), [value], [])


def _chosen(edited: list[tuple[int, ast.expr]]) -> ast.expr:
    """What the edit of a number makes of an expression; their numbers ascend."""
    if len(edited) == 1:
        return edited[0][1]
    half = len(edited) // 2
    before = ast.Compare(ast.Name(_EDIT, ast.Load()), [ast.Lt()], [ast.Constant(edited[half][0])])
    return ast.IfExp(before, _chosen(edited[:half]), _chosen(edited[half:]))


def _at(spot: Spot) -> Any:
    parent, name, k = spot
    value = getattr(parent, name)
    return value if k is None else value[k]
