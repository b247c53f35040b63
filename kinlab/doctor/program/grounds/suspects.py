"""Statements that are wrong by what they are made of: their parts are right, and they are not.

A slip in one statement spoils all that follow. The one to look at first is that whose value is
nothing a textbook has, though each piece of it is: numbers of the data, the angles and speeds that
were given, and what earlier statements have right.
"""

from __future__ import annotations

import ast
from collections.abc import Iterator, Sequence
from dataclasses import dataclass
from types import ModuleType

import numpy as np

from kinlab.arrays import Array
from kinlab.doctor.bytecode.syntax import called, names, nodes
from kinlab.doctor.glossary.meaning import as_vector
from kinlab.doctor.glossary.textbook import Glossary
from kinlab.doctor.program.grounds.evidence import zeros_and_ones
from kinlab.doctor.program.observed import Observed, Seen
from kinlab.doctor.program.places import root
from kinlab.doctor.program.trial import Trial, named_in
from kinlab.tolerances import TOLERANCES

_PASSES = 12
"""Passes of a statement that are looked at."""
TERM = 2
"""The rank of what is a term of a sum."""
_STATEMENTS = ast.Assign | ast.AugAssign | ast.Return
_PIECES = ast.Name | ast.Subscript | ast.Attribute


def suspects(trial: Trial, observed: Observed, known: Sequence[Glossary]) -> set[int]:
    """The nodes of statements that are wrong by what they are made of, by identity.

    Args:
        trial: a program in which no edit stands.
        observed: its expressions.
        known: the textbook's things at the states that it was observed at.
    """
    if not known:
        return set()
    found, _made = _wrong(trial, _Look(trial, observed, known))
    return found


@dataclass(frozen=True)
class OddValue:
    """A value that is nothing known, though all that it is made of is.

    Attributes:
        statement: what sets it.
        value: the expression.
        turn: the first pass at which it is that.
    """

    statement: ast.Assign | ast.AugAssign | ast.Return
    value: ast.expr
    turn: int


def odd_values(trial: Trial, observed: Observed, known: Sequence[Glossary]) -> list[OddValue]:
    """The values that are wrong by what they are made of, in the order of the program."""
    if not known:
        return []
    look = _Look(trial, observed, known)
    every = (node for tree in trial.trees for node in nodes(tree) if isinstance(node, _STATEMENTS))
    return [
        OddValue(node, value, turn)
        for node in every
        for value in (_values(node.value) if node.value is not None else ())
        if (turn := look.odd_pass(value)) is not None
    ]


def behind(trial: Trial, observed: Observed, known: Sequence[Glossary]) -> set[int]:
    """Suspects, and what may be at fault beside them, by identity.

    What gives a suspect a piece that is a term alone, another's value, or nothing but zeros and
    ones; and what is wrong by what it is made of, where suspects are taken for right.
    """
    if not known:
        return set()
    look = _Look(trial, observed, known)
    found, made = _wrong(trial, look)
    pieces = [piece for value in made for piece in _pieces(value)]
    doubtful = {root(one) for one in pieces if look.is_term(one)}
    for loop in (node for tree in trial.trees for node in nodes(tree) if isinstance(node, ast.For)):
        if doubtful.intersection(names(loop.target)):
            doubtful |= set(names(loop.iter))
    named = {root(one) for one in pieces}
    asked = set().union(*map(named_in, made))
    for tree, part in zip(trial.trees, trial.program.parts, strict=True):
        if part.name in asked:
            found |= {id(inner) for inner in nodes(tree)}
        for node in nodes(tree):
            sets = _set_by(node)
            alias = isinstance(node, ast.Assign) and isinstance(node.value, _PIECES)
            if sets & doubtful or (alias and sets & named):
                found |= {id(inner) for inner in nodes(node)}
            if sets and id(node) in found:
                look.given |= sets
    further, _made = _wrong(trial, look)
    return found | further


def _wrong(trial: Trial, look: _Look) -> tuple[set[int], list[ast.expr]]:
    """The nodes of statements that are wrong by what they are made of, and what these set."""
    found: set[int] = set()
    made: list[ast.expr] = []
    for tree in trial.trees:
        for node in nodes(tree):
            given = node.value if isinstance(node, _STATEMENTS) else None
            if given is not None and any(look.wrong(value) for value in _values(given)):
                found |= {id(inner) for inner in nodes(node)}
                made.append(given)
    return found, made


def _set_by(node: ast.AST) -> set[str]:
    """The names that a statement sets, of lists and arrays those whose entries it sets or adds."""
    if isinstance(node, ast.Assign | ast.AugAssign):
        targets = node.targets if isinstance(node, ast.Assign) else [node.target]
        inner = [one for to in targets for one in getattr(to, "elts", [to])]
        return {root(one) for one in inner}
    call = node.value if isinstance(node, ast.Expr) else None
    if isinstance(call, ast.Call) and called(call) == "append":
        return {root(call.func)}
    return set()


def _values(value: ast.expr) -> list[ast.expr]:
    return value.elts if isinstance(value, ast.Tuple) else [value]


class _Look:
    """What pieces were at the first state."""

    def __init__(self, trial: Trial, observed: Observed, known: Sequence[Glossary]) -> None:
        self.observed, self.known, self.states = observed, known[0], len(known)
        modules = (name for name, x in trial.space.items() if isinstance(x, ModuleType))
        self.given = {*trial.program.data, *modules}
        self.seen: dict[tuple[tuple[int, ...], bytes], bool] = {}

    def wrong(self, value: ast.expr) -> bool:
        """Whether an expression is nothing known at some pass, and all that it is made of is."""
        return self.odd_pass(value) is not None

    def odd_pass(self, value: ast.expr) -> int | None:
        """The first pass at which it is that."""
        seen = self.observed.of(value)
        if seen is None or seen.shape is None or seen.whole or not seen.values:
            return None
        pieces = [*_pieces(value)]
        passes = self.passes(seen)
        odd = [
            k for k, one in enumerate(passes) if not zeros_and_ones(one) and not self.textbook(one)
        ]
        if not odd and all(map(zeros_and_ones, passes)):
            odd = [0] if any(self.moves(piece) for piece in pieces) else []
        if not odd or not pieces or not all(self.vouched(one, seen, odd[0]) for one in pieces):
            return None
        return odd[0]

    def is_term(self, piece: ast.expr) -> bool:
        """Whether a piece is of zeros and ones alone, a term of a sum, or turned or transposed."""
        seen = self.observed.of(piece)
        if seen is None or not seen.shape:
            return False
        told = [one for one in self.passes(seen) if not zeros_and_ones(one)]
        return not told or any(self._least_rank(one) >= TERM for one in told)

    def passes(self, seen: Seen) -> list[Array]:
        """What an expression was at the first state."""
        return seen.values[: min(_PASSES, -(-seen.count // self.states))]

    def _least_rank(self, value: Array) -> int:
        """How far a thing is from being a quantity of its own: the least of what a value may be."""
        value = np.squeeze(value)
        rows, gap = self.known.gaps(value)
        near = gap <= TOLERANCES.nearly_agrees * float(np.max(np.abs(value)))
        return min((rows[int(k)][0] for k in np.flatnonzero(near)), default=TERM)

    def moves(self, piece: ast.expr) -> bool:
        """Whether a piece is a value that an earlier statement made, and no whole number."""
        seen = self.observed.of(piece)
        return seen is not None and seen.shape is not None and not seen.whole

    def vouched(self, piece: ast.expr, whole: Seen, k: int) -> bool:
        """Whether a piece was right at a pass of the expression that it stands in."""
        at: ast.expr = piece
        while True:
            seen = self.observed.of(at)
            if isinstance(at, ast.Name) and (at.id in self.given or seen is None):
                return True  # the user's numbers, or what is no value: a module, a function
            if seen is not None and seen.shape is not None:
                each = max(1, seen.count // max(1, whole.count))
                here = seen.values[k * each : (k + 1) * each]
                if seen.whole or all(zeros_and_ones(x) or self.textbook(x) for x in here):
                    return True
            if isinstance(at, ast.Name):
                return False
            assert isinstance(at, ast.Subscript | ast.Attribute)
            at = at.value
            if not isinstance(at, _PIECES):
                return all(self.vouched(inner, whole, k) for inner in _pieces(at))

    def textbook(self, value: Array) -> bool:
        """Whether a value is a thing of the textbooks, or minus it, or its transpose; nearly: it
        may be that of a state beside, where differences are taken."""
        value = np.squeeze(value)
        key = (value.shape, value.tobytes())
        if key not in self.seen:
            forms = [value, -value, value.T] if value.ndim == 2 else [value, -value]
            self.seen[key] = any(self._near(form) for form in forms)
        return self.seen[key]

    def _near(self, value: Array) -> bool:
        if self.known.plane and value.shape in ((), (2,)):
            lifted = as_vector(value)
            if lifted is not None and self._one_of(lifted):
                return True
        return self._one_of(value)

    def _one_of(self, value: Array) -> bool:
        rows, gap = self.known.gaps(value)
        return bool(rows) and bool(
            gap.min() <= TOLERANCES.nearly_agrees * float(np.max(np.abs(value)))
        )


def _pieces(node: ast.AST) -> Iterator[ast.expr]:
    """Names, entries and attributes, the widest; what stands in an index is none."""
    if isinstance(node, _PIECES):
        yield node
        return
    for child in ast.iter_child_nodes(node):
        yield from _pieces(child)
