"""A formula as its writer wrote it: names, literals with their digits, and values at any numbers.

The tree of a formula gathers numbers and opens brackets; here the text stands as it is, so that
one can ask how many digits a number was written with, and change one place and nothing else.
"""

from __future__ import annotations

import ast
import re
from collections.abc import Callable, Iterable, Iterator, Mapping
from dataclasses import dataclass, field, replace
from functools import cached_property, lru_cache
from typing import Any

import numpy as np

from kinlab.arrays import Array
from kinlab.formulas import tree
from kinlab.formulas.arithmetic import read
from kinlab.formulas.evaluate import combined
from kinlab.formulas.retyped import Typing
from kinlab.formulas.text import canonical, words_in
from kinlab.formulas.tree import Node

_DECIMAL = re.compile(r"(\d*)\.?(\d*)(?:[eE]([+-]?\d+))?")
_WEIGHTS, _STANDARD, _PLACES = (9.77, 9.84), 9.80665, 0.012
"""Values of g to three digits, the standard one, and how far the textbooks' are apart."""
_SEEN = 3
"""Digits in front of the zeros of a whole number from which on these may be nothing but places."""
_LEAST_WHOLE = 10
"""Whole numbers below this are exact: 2 is two, but 10 may be a rounded 9.81."""


@dataclass(frozen=True)
class Literal:
    """A number in a text.

    Attributes:
        text: its digits.
        value: what they say.
        half: half a unit of the last digit; 0 for a number that is exact (an exponent, a 2).
        exponent: whether it is one.
    """

    text: str
    value: float
    half: float
    exponent: bool = False

    @property
    def whole(self) -> bool:
        """Whether it has no decimal point."""
        return "." not in self.text and "e" not in self.text.lower()

    @property
    def digits(self) -> int:
        """Significant digits."""
        found = _DECIMAL.fullmatch(self.text)
        shown = "".join(found.group(1, 2)) if found else self.text
        return len(shown.lstrip("0"))

    @property
    def seen(self) -> int:
        """Digits that are no mere places: of 43600 three."""
        return len(self.text.rstrip("0").lstrip("0")) if self.whole else self.digits

    @property
    def reach(self) -> float:
        """How far off what it stands for may be, where that is g: 9.80665 is 9.81 elsewhere."""
        plain = self.digits < 4 and _WEIGHTS[0] < self.value < _WEIGHTS[1]
        weight = plain or abs(self.value - _STANDARD) <= self.half
        return max(self.half, _PLACES) if weight and not self.whole else self.half


def literal(text: str) -> Literal:
    """A number with its digits: ``"9.8"`` may be anything from 9.75 to 9.85."""
    found = _DECIMAL.fullmatch(text)
    value = float(text)
    if found is None:
        return Literal(text, value, 0.0)
    if "." not in text and found.group(3) is None:
        zeros = len(text) - len(text.rstrip("0"))
        unit = 10.0**zeros if len(text) - zeros >= _SEEN else 1.0  # 43600 has three digits
        return Literal(text, value, 0.5 * unit if value >= _LEAST_WHOLE else 0.0)
    return Literal(text, value, 0.5 * 10.0 ** (int(found.group(3) or 0) - len(found.group(2))))


def _as_it_is(_name: str, _text: str) -> Typing | None:
    return None


@dataclass(frozen=True, eq=False)
class Written:
    """One formula as it was given.

    Attributes:
        entry: what the writer calls it: ``tau1``.
        text: the formula, with the writer's names.
        node: the same in the robot's names, as a tree.
        symbols: what the writer's own names stand for: text over other names, or digits.
        known: the writer's names that stand for a number of the robot: ``L`` is ``l1``.
        rounded: what is to be said of names whose number is one of the robot's, rounded.
        numbers: names that stand in the text for a number that was written.
        typing: how it was typed, where that is not the text.
        definition_typed: how the definition of a name was typed, where that is not its text.
    """

    entry: str
    text: str
    node: Node
    symbols: Mapping[str, str] = field(default_factory=dict)
    known: Mapping[str, Node] = field(default_factory=dict)
    rounded: tuple[str, ...] = ()
    numbers: Mapping[str, str] = field(default_factory=dict)
    typing: Typing | None = None
    definition_typed: Callable[[str, str], Typing | None] = _as_it_is

    def told(self, piece: str) -> str:
        """A piece of the text, or of what comes instead, as the writer types it."""
        piece = self.restored(piece)
        return self.typing.piece(piece) if self.typing is not None else piece

    def restored(self, text: str) -> str:
        """The text with the numbers that were written."""
        return re.sub(r"\w+", lambda m: self.numbers.get(m[0], m[0]), text)

    @cached_property
    def _trees(self) -> dict[str, ast.expr]:
        return {name: _parsed(text) for name, text in {"": self.text, **self.symbols}.items()}

    @cached_property
    def literals(self) -> tuple[Literal, ...]:
        """Every number of the text and of the symbols in it, in the order of reading."""
        found: list[Literal] = []
        for place in self._used:
            source = self.symbols.get(place, self.text) if place else self.text
            for constant, above in constants(self._trees[place]):
                piece = source.encode()[constant.col_offset : constant.end_col_offset]
                found.append(beneath(literal(piece.decode()), above))
        return tuple(found)

    @cached_property
    def definitions(self) -> list[str]:
        """The writer's own names in it that stand for formulas."""
        return [
            x for x in self._used[1:] if not isinstance(self._trees[x], ast.Name | ast.Constant)
        ]

    @cached_property
    def spans(self) -> list[tuple[int, int]]:
        """Where the numbers of the text itself stand, which are the first of :attr:`literals`."""
        inside = (constant for constant, _above in constants(self._trees[""]))
        return [(one.col_offset, one.end_col_offset or 0) for one in inside]

    @cached_property
    def _used(self) -> list[str]:
        """The symbols with numbers of their own that the text reaches, the text itself first."""
        found, waiting = [""], [""]
        while waiting:
            for node in ast.walk(self._trees[waiting.pop()]):
                name = node.id if isinstance(node, ast.Name) else ""
                if name in self.symbols and name not in self.known and name not in found:
                    found.append(name)
                    waiting.append(name)
        return found

    def definition(self, name: str) -> Written:
        """What one of these names stands for, in which no name may stand that is made of it."""
        text = self.symbols[name]
        own = replace(self, entry=name, text=text, typing=self.definition_typed(name, text))
        made = {x for x in self.symbols if name in replace(self, text=x)._used}
        return replace(own, symbols={x: y for x, y in self.symbols.items() if x not in made})

    def opened(self) -> Written:
        """The same with what the writer's own names stand for, where each stands but once.

        What is a part of a single other name, ``lc3`` of ``l3``, stays.
        """
        texts = {"": self.text, **{x: self.symbols[x] for x in self._used[1:]}}
        met = [name for text in texts.values() for name in words_in(text)]
        opened, left = self, dict(self.symbols)
        for name in self.definitions:
            several = len({*words_in(self.symbols[name])}) > 1
            if several and met.count(name) == 1 and name in words_in(opened.text):
                inner = left.pop(name)
                text = re.sub(rf"\b{name}\b", lambda _, inner=inner: f"({inner})", opened.text)  # type: ignore[misc]
                opened = replace(opened, text=text, symbols=left, typing=None)
        return opened

    def foreign(self, names: set[str]) -> list[str]:
        """Names in the text that have no value, where the robot's are ``names``."""
        met = {
            node.id
            for place in self._used
            for node in ast.walk(self._trees[place])
            if isinstance(node, ast.Name) and node.id not in self.known
        }
        met -= {"pi", *self.symbols, *_called(self._trees.values())}
        return sorted(name for name in met if not tree.names(canonical(name)) <= names)

    def with_what_is_known(self, names: set[str]) -> Written:
        """The same without definitions that it does not use and that have names without a value.

        Args:
            names: the robot's, as for :meth:`foreign`.
        """
        unused = [name for name in self.symbols if name not in self._used]
        told = {name: replace(self, text=self.symbols[name], typing=None) for name in unused}
        strange = {name for name, definition in told.items() if definition.foreign(names)}
        kept = {name: text for name, text in self.symbols.items() if name not in strange}
        return replace(self, symbols=kept) if strange else self

    @property
    def spelled(self) -> dict[str, str]:
        """How the writer spells the robot's names, where otherwise: ``l1`` is ``L``."""
        return {str(n.value): name for name, n in self.known.items() if n.op == "sym"}

    def values(self, at: Mapping[str, Array], numbers: Array | None = None) -> Array:
        """The values of the text, nothing opened, gathered or cancelled.

        Args:
            at: values of the robot's names, (N,) each.
            numbers: what the literals stand for instead of what they say, in their order.

        Returns:
            (N,); NaN or infinite where the text has no real value.
        """
        count = len(next(iter(at.values())))
        start = {} if numbers is None else dict(zip(self._used, self._starts, strict=True))
        known: dict[str, Array] = {}

        def name_value(name: str) -> Any:
            if name not in known:
                known[name] = self._name(name, at, lambda: walk(name))
            return known[name]

        def walk(place: str) -> Any:
            position = start.get(place, 0)

            def number(value: float) -> Any:
                nonlocal position
                position += 1
                return np.float64(value) if numbers is None else numbers[position - 1]

            return read(self._trees[place], combined(number, name_value))

        with np.errstate(all="ignore"):
            result = walk("")
        return np.array(np.broadcast_to(result, (count,)), dtype=float)

    def _name(self, name: str, at: Mapping[str, Array], walk: Any) -> Any:
        if name in self.known:
            return tree.evaluate(self.known[name], dict(at))
        if name in self.symbols:
            return walk()
        return at[name] if name in at else tree.evaluate(canonical(name), dict(at))

    @cached_property
    def _starts(self) -> list[int]:
        counts = [sum(1 for _ in constants(self._trees[place])) for place in self._used]
        return [int(k) for k in np.concatenate([[0], np.cumsum(counts)[:-1]])]


@dataclass(frozen=True, eq=False)
class Together:
    """Several formulas, and what is made of their values: of a matrix C, say, C qd.

    Attributes:
        texts: the formulas.
        shape: that of the answer they are.
        made: what counts of their values, (N, *shape).
    """

    texts: tuple[Written, ...]
    shape: tuple[int, ...]
    made: Callable[[Array], Array]

    @cached_property
    def literals(self) -> tuple[Literal, ...]:
        """The numbers of all of them."""
        return tuple(one for text in self.texts for one in text.literals)

    def values(self, at: Mapping[str, Array], numbers: Array | None = None) -> Array:
        """What is made of the values, one after the other."""
        return self.made(self.answers(at, numbers)).ravel()

    def answers(self, at: Mapping[str, Array], numbers: Array | None = None) -> Array:
        """The values themselves."""
        ends = np.cumsum([len(text.literals) for text in self.texts])
        parts = [None] * len(self.texts) if numbers is None else np.split(numbers, ends[:-1])
        columns = [text.values(at, own) for text, own in zip(self.texts, parts, strict=True)]
        return np.stack(columns, axis=1).reshape(-1, *self.shape)


@lru_cache(maxsize=4096)
def _parsed(text: str) -> ast.expr:
    return ast.parse(text, mode="eval").body


def _called(trees: Iterable[ast.expr]) -> set[str]:
    calls = (node.func for part in trees for node in ast.walk(part) if isinstance(node, ast.Call))
    return {name.id for name in calls if isinstance(name, ast.Name)}


def operands(node: ast.expr) -> list[ast.expr]:
    """What stands within an operator, a sign or a call."""
    match node:
        case ast.BinOp(left=left, right=right):
            return [left, right]
        case ast.UnaryOp(operand=operand):
            return [operand]
        case ast.Call(args=args):
            return list(args)
    return []


def constants(node: ast.expr, above: str = "") -> Iterator[tuple[ast.Constant, str]]:
    """The numbers in the order in which they are read, and what each is: see :func:`beneath`."""
    if isinstance(node, ast.Constant):
        yield node, above
    for k, part in enumerate(operands(node)):
        yield from constants(part, inside(node, k, above))


def inside(node: ast.AST, k: int, above: str = "") -> str:
    """What numbers are that stand in an operand: an exponent, a divisor's factors, or nothing."""
    operator = node.op if isinstance(node, ast.BinOp) else None
    if above == "exponent" or (k == 1 and isinstance(operator, ast.Pow)):
        return "exponent"
    factor = above == "divisor" and isinstance(operator, ast.Mult)
    return "divisor" if factor or (k == 1 and isinstance(operator, ast.Div)) else ""


def beneath(one: Literal, above: str) -> Literal:
    """A number as an exponent, or as a divisor: of these whole ones are what they say."""
    if above == "exponent" or (above and one.whole):
        return replace(one, half=0.0, exponent=above == "exponent")
    return one
