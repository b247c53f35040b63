"""What may stand in a place of a part, and what speaks for it: what is used nowhere."""

from __future__ import annotations

import ast
import re
from collections.abc import Callable, Iterator, Sequence

import numpy as np

from kinlab.arrays import Array
from kinlab.doctor.bytecode.syntax import called, names, pieces, text_of
from kinlab.doctor.program.edits.numbers.data import is_number
from kinlab.doctor.program.edits.scope.known import Knowledge
from kinlab.doctor.program.observed import Observed, Shape
from kinlab.doctor.program.places import Here, places
from kinlab.doctor.program.trial import Trial

_SUM = re.compile(r"([A-Za-z]+)(\d+) \+ ([A-Za-z]+)(\d+)")
CENTRES = ("lc", "lg", "rc", "rg", "ac", "cc", "com")
"""Names for the distance of a link's centre from its joint, without their digits."""
_UNUSED = 0.2
"""What it is likelier that something is missing which is set and used nowhere."""


class Scope(Knowledge):
    """What may be written in one part: :meth:`stand` goes to a place of it.

    Args:
        trial: the program.
        observed: what its expressions were.
        part: which part.
    """

    def __init__(self, trial: Trial, observed: Observed, part: int) -> None:
        super().__init__(trial, observed, part)
        self._inside: frozenset[str] = frozenset()
        self._known_here: dict[tuple[frozenset[str], Shape], dict[str, ast.expr]] = {}
        self._names_in: dict[int, frozenset[str]] = {}
        both = (_SUM.fullmatch(text) for text in self.pieces.get((), {}))
        self.sums = {(x[1], x[3]) for x in both if x is not None and x[2] == x[4]}

    def are_halves(self, one: str, other: str) -> bool:
        """Whether one of two numbers of one link is half of the other: ``lc1`` of ``l1``."""
        digits = {name[len(name.rstrip("0123456789")) :] for name in (one, other)}
        values = [self.levels.get(name, self.space.get(name)) for name in (one, other)]
        if digits == {""} and one in self.vectors and other in self.vectors:
            rows = [*zip(self.vectors[one], self.vectors[other], strict=False)]
            return all(map(_is_twice, rows)) or all(_is_twice(row[::-1]) for row in rows)
        if len(digits) > 1 and "" in digits:  # of the one link's centre: lc beside l1
            bare = one if one.rstrip("0123456789") == one else other
            digits = set() if bare.lower() in CENTRES else digits
        if len(digits) > 1 or not all(isinstance(x, float | list | np.ndarray) for x in values):
            return False
        if type(values[0]) is type(values[1]) is float:
            return 0.0 != values[0] in (2 * values[1], values[1] / 2)
        try:
            first, last = (np.asarray(x, dtype=float) for x in values)
        except (TypeError, ValueError):
            return False
        doubled = first.shape == last.shape and bool(first.any())
        return doubled and any(np.array_equal(2 * x, y) for x, y in ((first, last), (last, first)))

    def level_of(self, name: str) -> float:
        """The number that a name stays at; 0 of what is none, or moves."""
        value = self.levels.get(name, self.space.get(name))
        return float(value) if is_number(value) else 0.0

    def is_idle(self, node: ast.AST) -> bool:
        """Whether it is what is set and used nowhere, or an entry of that."""
        while isinstance(node, ast.Subscript):
            if getattr(node.slice, "value", None) in self.idle_keys:
                return True
            node = node.value
        if isinstance(node, ast.Attribute):
            return node.attr in self.idle_attributes
        return isinstance(node, ast.Name) and node.id in self.unused

    def uses_idle(self, node: ast.AST) -> bool:
        """Whether there is anything in it that is set or given, and used nowhere."""
        if self.unused and not self.unused.isdisjoint(names(node)):
            return True
        if not self.idle_entries:
            return False
        entries = (one for one in pieces(node) if isinstance(one, ast.Subscript))
        return any(text_of(one) in self.idle_entries for one in entries)

    def dear(self, node: ast.expr) -> float:
        """What a piece costs more than one that is used nowhere."""
        if isinstance(node, ast.Name):
            return 0.0 if node.id in self.unused else _UNUSED / 2
        if (self.idle_attributes or self.idle_keys) and self.is_idle(node):
            return 0.0
        return 0.0 if self.uses_idle(node) else _UNUSED

    def crosses(self, node: ast.AST) -> bool:
        """Whether a call takes the product of two vectors, by whatever name."""
        if not isinstance(node, ast.Call) or len(node.args) != 2:
            return False
        own = self.cross is not None and text_of(node.func) == text_of(self.cross)
        return own or called(node) == "cross"

    def is_pose(self, node: ast.AST) -> bool:
        """Whether a matrix is a transform, which nobody transposes."""
        seen = self.observed.of(node)
        rows = [x[3] for x in seen.values if x.shape == (4, 4)] if seen is not None else []
        return bool(rows) and all(np.array_equal(row, (0, 0, 0, 1)) for row in rows)

    def stand(self, above: Sequence[ast.AST]) -> None:
        """Goes to a place of the part: counters of loops around it alone are known there."""
        around = [getattr(one, "generators", [one]) for one in above]
        loops = [x.target for some in around for x in some if hasattr(x, "iter")]
        self._inside = self._counted.union(name for target in loops for name in names(target))

    def pieces_here(self, shape: Shape) -> dict[str, ast.expr]:
        """The expressions of one shape that may stand there, by their text."""
        known = self._known_here.get((self._inside, shape))
        if known is None:
            outside = {*self.counters} - self._inside
            every = self.pieces.get(shape, {}).items()
            known = {text: one for text, one in every if outside.isdisjoint(names(one))}
            self._known_here[self._inside, shape] = known
        return known

    @property
    def counting(self) -> frozenset[str]:
        """The counters of the loops around the place."""
        return self._inside

    def names_in(self, statement: ast.stmt) -> frozenset[str]:
        """The names that a statement reads."""
        if id(statement) not in self._names_in:
            simple = isinstance(statement, ast.Assign | ast.AugAssign | ast.Return)
            read = names(statement, ast.Load) if simple else ()
            self._names_in[id(statement)] = frozenset(read)
        return self._names_in[id(statement)]

    def tests_here(self) -> list[ast.expr]:
        """The conditions that may stand there."""
        outside = {*self.counters} - self._inside
        return [one for one in self.tests.values() if outside.isdisjoint(names(one))]

    def simple(self, shape: Shape) -> Iterator[tuple[str, ast.expr]]:
        """Names, entries of lists and attributes of one shape."""
        for text, node in self.pieces_here(shape).items():
            if isinstance(node, ast.Name | ast.Subscript | ast.Attribute):
                yield text, node


def _is_twice(rows: tuple[Array, Array]) -> bool:
    """Whether the second of two rows is twice the first."""
    first, second = rows
    return first.shape == second.shape and bool(np.allclose(2 * first, second))


def standing(
    trial: Trial, scopes: Sequence[Scope], asked: Callable[[Here], bool]
) -> Iterator[tuple[Here, Scope]]:
    """The places of a program that are asked for, each with the scope, which stands there.

    Args:
        trial: a program.
        scopes: those of its parts.
        asked: whether a place is meant.
    """
    for part, tree in enumerate(trial.trees):
        for here in places(part, tree):
            if asked(here):
                scopes[part].stand((*here.above, here.node))
                yield here, scopes[part]
