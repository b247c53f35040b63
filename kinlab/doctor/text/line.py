"""One formula as a line: the names in it, its places, and what a change does to the whole.

The parameters are random numbers, so that a length of 0.5 is no ½. What a change does to the value
of its place is climbed up to the whole, all changes of a place at once.
"""

from __future__ import annotations

import ast
import keyword
import re
from collections.abc import Callable, Mapping
from dataclasses import dataclass, field, replace
from functools import cached_property
from itertools import chain, combinations, combinations_with_replacement
from typing import Any, TypeGuard

import numpy as np

from kinlab.arrays import Array
from kinlab.doctor.text.meanings import Meanings, coefficients
from kinlab.doctor.text.written import Written, operands
from kinlab.formulas import tree
from kinlab.formulas.text import SHORTHAND, canonical, joint_spelling, parse, respelled, words_in
from kinlab.formulas.tree import Node
from kinlab.host.language import N_, _
from kinlab.tolerances import TOLERANCES

_NAMED = ("parameter", "missing factor", "extra factor", "power")
"""Changes that may rest on the value of a name alone."""


@dataclass(frozen=True)
class Names:
    """The names that may stand in a formula.

    Attributes:
        parameters: l1, m1, g, ...
        n: number of joints.
        letters: which of q, qd, qdd the quantity depends on.
        loads: parts of a wrench, fx, nz, ...
        spelling: how the joints are written where the writer has none of them: theta1 for q1.
    """

    parameters: tuple[str, ...]
    n: int
    letters: tuple[str, ...]
    loads: tuple[str, ...] = ()
    spelling: Mapping[str, str] = field(default_factory=dict)

    @property
    def angles(self) -> tuple[Node, ...]:
        """Sums of neighbouring joint positions, differences of two, and doubled ones.

        Joints that slide are among them: a wrong index may point at one.
        """
        joints = [tree.sym(f"q{i + 1}") for i in range(self.n)]
        sums = [
            tree.add(*joints[i:j])
            for i in range(len(joints))
            for j in range(i + 1, len(joints) + 1)
        ]
        differences = [tree.add(a, tree.mul(tree.num(-1), b)) for a, b in combinations(joints, 2)]
        gaps = [tree.add(a, b) for a, b in combinations(joints, 2)]
        twice = [tree.mul(tree.num(2), a) for a in joints]
        return tuple(dict.fromkeys([*sums, *gaps, *differences, *twice]))


@dataclass(frozen=True, eq=False)
class Change:
    """Something else at one place of a text.

    Attributes:
        start, end: the piece that goes. new: what comes.
        kind: ``"sign"``, ``"index"``, ...
        cost: how far-fetched it is.
        told: what is wrong there: a marked sentence with fields.
        everywhere: pairs of words exchanged in the whole text instead.
        pieces: what its fields are, pieces of formulas.
    """

    start: int
    end: int
    new: str
    kind: str
    cost: float
    told: str
    everywhere: tuple[tuple[str, str], ...] = ()
    pieces: Mapping[str, str] = field(default_factory=dict)

    def sentence(self, typed: Callable[[str], str]) -> str:
        """What is wrong there, in words; ``typed`` says how the writer types a piece."""
        pieces = {name: brief(typed(text)) for name, text in self.pieces.items()}
        return _(self.told).format(**pieces)


@dataclass(frozen=True, eq=False)
class Place:
    """A piece of the text and where it stands."""

    node: ast.expr
    above: Place | None
    role: int
    value: Array

    @property
    def span(self) -> tuple[int, int]:
        return self.node.col_offset, self.node.end_col_offset or 0


def _slid(node: Node) -> set[str]:
    """The joints' positions outside of sines and cosines: of slides."""
    if node.op in tree.FUNCTIONS:
        return set()
    own = {str(node.value)} if node.op == "sym" and _POSITION.fullmatch(str(node.value)) else set()
    return own.union(*map(_slid, node.args))


_LONG_NUMBER = re.compile(r"(?<![\w.])\d\.\d{9,}(?![\w.])")
"""A number that no writer types: 1.57079632679."""


@dataclass(eq=False)
class Line:
    """One formula, with what each change would do to it.

    Attributes:
        text: the formula.
        names: what may stand in it.
        at: values of the robot's names at random points.
        target: the values it should have.
        forms: the derived formula in the ways in which people write it, term by term.
        numeric: whether the names have the robot's own numbers: then nothing is believed that
            rests on the value of a name.
        factored: the factors of products, as far as they were asked for.
    """

    text: Written
    names: Names
    at: Mapping[str, Array]
    target: Array
    forms: list[list[Node]]
    numeric: bool = False
    places: list[Place] = field(default_factory=list)
    changes: list[Change] = field(default_factory=list)
    rows: list[Array] = field(default_factory=list)
    factored: dict[str, list[str]] = field(default_factory=dict)

    def __post_init__(self) -> None:
        self.count = len(self.target)
        self._spans: Any = ()
        self.source = self.text.text
        self.root = self._place(ast.parse(self.source, mode="eval").body, None, 0)
        self.scale = float(np.max(np.abs(self.target))) or float(np.max(np.abs(self.root.value)))

    @property
    def wrong_by(self) -> float:
        """The largest difference from the values it should have."""
        return float(np.max(np.abs(self.target - self.root.value)))

    @cached_property
    def right(self) -> Node:
        """The derived formula."""
        return tree.add(*self.forms[0])

    @cached_property
    def fronts(self) -> list[float]:
        """The derived formula's coefficients, at the robot's own numbers."""
        whole, *_parts = coefficients(self.right)
        sizes = [abs(float(np.ravel(tree.evaluate(one, dict(self.at)))[0])) for one in whole]
        return list(dict.fromkeys(sizes))

    @property
    def only_numbers(self) -> bool:
        """Whether none of the robot's numbers stands in it by its name."""
        return tree.names(self.text.node).isdisjoint(self.names.parameters)

    @cached_property
    def terms(self) -> list[Node]:
        """The derived formula's terms, which may be missing."""
        return list(dict.fromkeys(term for form in self.forms for term in form))

    def _place(self, node: ast.expr, above: Place | None, role: int) -> Place:
        # children need their parent and the parent its value: values first
        place = Place(node, above, role, self._value(node))
        self.places.append(place)
        for k, child in enumerate(operands(node)):
            self._place(child, place, k)
        return place

    def _value(self, node: ast.expr) -> Array:
        piece = ast.unparse(node)
        return replace(self.text, text=piece).values(self.at)

    def segment(self, place: Place) -> str:
        start, end = place.span
        return self.source[start:end]

    @cached_property
    def spelling(self) -> dict[str, str]:
        """The robot's names as the writer has them: q1 is theta1, l1 is L."""
        found = dict(self.text.spelled)
        for name, meaning in self.text.symbols.items():
            if meaning.isidentifier() and name not in self.text.known and not self._by_chance(name):
                found.setdefault(meaning, name)
        typed = [*words_in(self.source), *chain(*map(words_in, self.text.symbols.values()))]
        for meaning, word in joint_spelling(typed, self.names.n).items():
            found.setdefault(meaning, word)
        return {**self.names.spelling, **found}

    def _by_chance(self, name: str) -> bool:
        """Whether a name is a centre's that nobody typed: of a point mass a length is as long."""
        typed = name in words_in(self.source) or name in self.text.definitions
        meaning = self.text.symbols[name]
        length = meaning in self.names.parameters and not _CENTRE.fullmatch(meaning)
        return length and not typed and bool(_CENTRE.fullmatch(name))

    @cached_property
    def short(self) -> bool:
        """Whether the writer has c12 for cos(q1 + q2)."""
        words = words_in(self.source)
        return any(SHORTHAND.fullmatch(w) for w in words) and not {"sin", "cos"} & set(words)

    def meaning(self, word: str) -> Node:
        """What a name stands for: q1 for th1, q1 + q2 for q12."""
        own = self.text.symbols
        return self.meant(own[word]) if word in own else canonical(word)

    def meant(self, text: str) -> Node:
        """A piece of a formula in the robot's names."""
        node = parse(text)
        return tree.renamed(node, {name: self.meaning(name) for name in tree.names(node)})

    @cached_property
    def sums(self) -> dict[Node, Node]:
        """Sums of joint positions for which the writer has a name: phi for q1 + q2."""
        found: dict[Node, Node] = {}
        for name in self.text.symbols:
            node = self.meaning(name)
            if node.op == "add" and all(_POSITION.fullmatch(str(a.value)) for a in node.args):
                found.setdefault(node, tree.sym(name))
        return found

    def _summed(self, node: Node) -> Node:
        """A piece of a formula with the writer's names of sums of joint positions."""
        for some, name in self.sums.items() if node.op == "add" else ():
            if {*some.args} <= {*node.args}:
                return tree.add(name, *(one for one in node.args if one not in some.args))
        args = tuple(map(self._summed, node.args))
        return node if args == node.args else Node(node.op, args, node.value)

    def spelled(self, node: Node) -> str:
        """A piece of a formula as the writer would write it."""
        node = self._summed(node) if self.sums else node
        plain = tree.to_text(respelled(node, self.spelling, self.short))
        if self.short and any(map(self._means_another, words_in(plain))):
            plain = tree.to_text(respelled(node, self.spelling, False))
        plain = _LONG_NUMBER.sub(lambda one: Meanings({}).named(float(one[0])), plain)
        return re.sub(r" ([-+]) ", rf"{self.gap}\1{self.gap}", plain)

    def _means_another(self, word: str) -> bool:
        """Whether the writer has set c12 to anything but cos(q1 + q2)."""
        own = word in self.text.symbols and SHORTHAND.fullmatch(word)
        return bool(own) and self.meaning(word) != canonical(word)

    @cached_property
    def atoms(self) -> dict[str, Array]:
        """Names of numbers that may stand in the text, with their values: none that is nothing."""
        found: dict[str, Array] = {}
        for name in self.text.symbols:
            digits = name in self.text.numbers and not self.text.symbols[name].isidentifier()
            if digits or not name.isidentifier() or keyword.iskeyword(name):
                continue
            if self._by_chance(name) or replace(self.text, text=name).foreign({*self.at}):
                continue  # of what the formula does not use nobody has looked at the names
            if not self.turns(name) and np.any(value := self._named(name)):
                found[name] = value  # a factor that is zero takes a term out
        mine = set(self.spelling)
        for name in (*self.names.parameters, *self.names.loads):
            if name not in mine:
                found[name] = np.asarray(self.at[name])
        return found

    @cached_property
    def slides(self) -> dict[str, Array]:
        """The writer's names of joints that slide, with their values: d3 is q3."""
        own = {name: meaning for name, meaning in self.text.symbols.items() if name[0] == "d"}
        found = {name: q for name, q in own.items() if _POSITION.fullmatch(q)}
        for q in {name for form in self.forms for term in form for name in _slid(term)}:
            if q not in found.values():
                found[self.spelling.get(q, q)] = q
        return {name: np.asarray(self.at[q]) for name, q in sorted(found.items())}

    def _named(self, name: str) -> Array:
        return replace(self.text, text=name).values(self.at)

    def turns(self, name: str) -> bool:
        """Whether a symbol is one of the motion: th1 is q1."""
        meaning = self.text.symbols.get(name, name)
        return any(re.fullmatch(r"q\w*\d", w) or SHORTHAND.fullmatch(w) for w in words_in(meaning))

    @cached_property
    def gap(self) -> str:
        """What the writer puts around a sign between terms."""
        typed = (self.source, *self.text.symbols.values())
        sums = [text for text in typed if re.search(r"\S ?[-+] ?\S", text)]
        return "" if sums and re.search(r"\S[-+]\S", sums[0]) else " "

    @cached_property
    def meanings(self) -> Meanings:
        """What numbers may stand for, at the robot's own."""
        return Meanings.at(self.at)

    @cached_property
    def pieces(self) -> dict[str, Array]:
        """What may be missing between parentheses: parts of the derived terms."""
        found: dict[str, Array] = {}
        for term in self.terms:
            plain = [f for f in term.factors if f.op != "num"]
            for mask in range(1, 2 ** min(len(plain), 6)):
                part = [f for k, f in enumerate(plain) if mask >> k & 1]
                for front in (1, 2):
                    node = tree.mul(tree.num(front), *part) if front > 1 else tree.mul(*part)
                    found.setdefault(self.spelled(node), tree.evaluate(node, self.at))
                half = f"{self.spelled(tree.mul(*part))}/2"
                found.setdefault(half, 0.5 * tree.evaluate(tree.mul(*part), self.at))
            if len(found) > 400:
                break
        for (one, x), (two, y) in combinations_with_replacement(self.atoms.items(), 2):
            found.setdefault(f"{one}*{two}" if one != two else f"{one}**2", x * y)
        for one, x in self.atoms.items():
            found.setdefault(one, x)
        return found

    def put(self, place: Place, new: Array, change: Change) -> None:
        """Notes a change by what it does to the whole."""
        if self.numeric and change.kind in _NAMED and _in_proportion(place.value, new):
            return  # at the robot's own numbers that is any other number of the place
        if change.kind != "extra term" and self._vanishes(place, new):
            return  # qd1 - qd2 as qd2 - qd2: that takes a term out, and does not say so
        with np.errstate(invalid="ignore"):
            effect = self.climbed(place, new) - self.root.value
        if change.kind == "missing term" and self._is_there(effect):
            return  # m1 + (m2 - m1) takes a term out, m1 + (m2 + m1) doubles one
        if np.isfinite(effect).all() and np.max(np.abs(effect)) > 1e-12 * self.scale:
            self.changes.append(change)
            self.rows.append(effect)

    def put_terms(self, place: Place, added: Array, change: Callable[[int], Change]) -> None:
        """Notes terms that are missing in a place, as :meth:`put` does one after another.

        Args:
            place: where.
            added: their values, (K, N).
            change: makes the change of the one of a number; asked of those that are noted alone.
        """
        new = place.value + added
        with np.errstate(invalid="ignore"):
            effects = self.climbed(place, new) - self.root.value
            sizes = np.max(np.abs(effects), axis=-1)
        kept = np.isfinite(effects).all(axis=-1) & (sizes > 1e-12 * self.scale)
        kept &= ~self._vanishes(place, new)
        if self.numeric:
            kept &= ~np.array([_in_proportion(place.value, one) for one in new], dtype=bool)
        for k in np.flatnonzero(kept & ~self._is_there(effects)):
            self.changes.append(change(int(k)))
            self.rows.append(effects[k])

    def inside(self, start: int, end: int) -> list[int]:
        """The changes of what stands between two places of the text, by their numbers."""
        if len(self._spans) != len(self.changes):
            told = [(c.start, c.end, bool(c.everywhere)) for c in self.changes]
            self._spans = np.array(told, dtype=int).reshape(-1, 3)
        first, last, everywhere = self._spans.T
        return np.flatnonzero((start <= first) & (last <= end) & (everywhere == 0)).tolist()

    def _vanishes(self, place: Place, new: Array) -> Any:
        """Whether nothing is left of a sum with something else in one of its places."""
        above = place.above
        if above is None or not is_sum(above.node) or not np.any(above.value):
            return np.zeros(np.shape(new)[:-1], dtype=bool)
        left = np.atleast_1d(_recombined(above, place, new, self.siblings))
        return ~np.any(left, axis=-1)

    def _is_there(self, effect: Array) -> Any:
        """Whether what is added is a term that is there, or takes one away."""
        allowed = TOLERANCES.effect_matches * self.scale
        every = np.reshape(effect, (-1, self.count))
        both = np.concatenate([self.shares, -self.shares])
        # what is alike has one mark; of long formulas there are too many to compare each with each
        weights = np.random.default_rng(5).uniform(0.5, 1.5, self.count)
        marks, there = both @ weights, every @ weights
        order = np.argsort(marks, kind="stable")
        wide = allowed * float(weights.sum())
        low = np.searchsorted(marks[order], there - wide)
        high = np.searchsorted(marks[order], there + wide, "right")
        found = np.zeros(len(every), dtype=bool)
        for k in np.flatnonzero(high > low):
            gaps = np.abs(both[order[low[k] : high[k]]] - every[k])
            found[k] = np.any(np.max(gaps, axis=-1) <= allowed)
        return found.reshape(np.shape(effect)[:-1])

    @cached_property
    def shares(self) -> Array:
        """What each term of a sum adds to the whole."""
        inside = (one for one in self.places if one.above is not None and is_sum(one.above.node))
        shares = [self.root.value - self.climbed(one, np.zeros(self.count)) for one in inside]
        return np.array(shares).reshape(-1, self.count)

    def edit(
        self,
        place: Place,
        value: Array,
        span: tuple[int, int, str],
        kind: str,
        cost: float,
        told: str,
        pieces: Mapping[str, str],
        everywhere: tuple[tuple[str, str], ...] = (),
    ) -> None:
        """Notes a change of a piece of the text; ``pieces`` are the fields of what is told."""
        self.put(place, value, Change(*span, kind, cost, told, everywhere, pieces))

    def climbed(self, place: Place, new: Array) -> Array:
        with np.errstate(all="ignore"):
            while place.above is not None:
                above = place.above
                new = _recombined(above, place, new, self.siblings)
                place = above
        return np.broadcast_to(new, (*np.shape(new)[:-1], self.count))

    @cached_property
    def siblings(self) -> dict[int, list[Place]]:
        found: dict[int, list[Place]] = {}
        for place in self.places:
            if place.above is not None:
                found.setdefault(id(place.above), []).append(place)
        return {key: sorted(value, key=lambda p: p.role) for key, value in found.items()}

    def instead(
        self,
        place: Place,
        new: str,
        value: Array,
        kind: str,
        cost: float,
        span: tuple[int, int, str] | None = None,
    ) -> None:
        """A piece in place of a piece; ``span`` is what of it is really typed anew, and what."""
        old = self.segment(place)
        told, pieces = self.told(
            place, N_("{old} should be {new}"), N_("{old} should be {new} in {term}")
        )
        if pieces.get("term") == old:
            told = N_("{old} should be {new}")
        pieces |= {"old": old, "new": new}
        self.edit(place, value, span or (*place.span, new), kind, cost, told, pieces)

    def told(self, place: Place, alone: str, inside: str) -> tuple[str, dict[str, str]]:
        """One of two sentences: with the term that a place is in, where it is worth showing."""
        term = self._around(place)
        return (inside, {"term": term}) if term else (alone, {})

    def _around(self, place: Place) -> str:
        """The term that a place is in."""
        inner = place
        alone = not isinstance(place.node, ast.BinOp)
        while place.above is not None and (
            (alone and place is inner) or not is_sum(place.above.node)
        ):
            place = place.above
        term = self.segment(place)
        return term if len(term) < 70 and (place is not inner or not alone) else ""


# -------- Small questions about places


def _in_proportion(old: Array, new: Array) -> bool:
    """Whether values are a multiple of others, the same at every state."""
    gap = new * old[0] - new[0] * old
    size = np.max(np.abs(new)) * np.max(np.abs(old))
    return bool(np.max(np.abs(gap)) <= TOLERANCES.same_relation * size)


_POSITION = re.compile(r"q\d+")
_CENTRE = re.compile(r"(?:[lL]_?c|r_?c?)_?\d+")
_LONGEST = 90
"""Letters of a piece of a formula in a sentence above which its middle is left out."""


def brief(text: str) -> str:
    """A piece of a formula that is short enough for a sentence: its beginning and its end."""
    if len(text) <= _LONGEST:
        return text
    ends = [m.start() for m in re.finditer(r" [+-] |\*(?!\*)", text)]
    first = max((k for k in ends if k <= _LONGEST // 2), default=_LONGEST // 2)
    last = min((k for k in ends if k >= len(text) - _LONGEST // 3), default=len(text) - 12)
    return f"{text[:first]} ... {text[last:].strip()}"


def is_sum(node: ast.AST | None) -> TypeGuard[ast.BinOp]:
    """Whether something is a sum or difference of two."""
    return isinstance(node, ast.BinOp) and isinstance(node.op, (ast.Add, ast.Sub))


def is_product(node: ast.AST | None) -> TypeGuard[ast.BinOp]:
    """Whether something is a product or quotient of two."""
    return isinstance(node, ast.BinOp) and isinstance(node.op, (ast.Mult, ast.Div))


def is_term(place: Place) -> bool:
    """Whether a place is a whole term of a sum, the formula, or what stands in parentheses."""
    above = place.above
    if above is None or isinstance(above.node, ast.UnaryOp):
        return True
    return is_sum(above.node)


_WAVES = ("sin", "cos", "tan")


def inside_wave(place: Place) -> bool:
    """Whether a place is in the angle of a sine, which is looked at as a whole."""
    while place.above is not None:
        place = place.above
        node = place.node
        if isinstance(node, ast.Call) and getattr(node.func, "id", "") in _WAVES:
            return True
    return False


def _recombined(
    above: Place, place: Place, new: Array, siblings: Mapping[int, list[Place]]
) -> Array:
    node = above.node
    if isinstance(node, ast.UnaryOp):
        return -new if isinstance(node.op, ast.USub) else new
    parts: list[Any] = [p.value for p in siblings[id(above)]]
    parts[place.role] = new
    if isinstance(node, ast.Call):
        name = node.func.id if isinstance(node.func, ast.Name) else ""
        return np.asarray(tree.FUNCTIONS[tree.SYNONYMS.get(name, name)](*parts))
    assert isinstance(node, ast.BinOp)
    left, right = parts
    match node.op:
        case ast.Add():
            return np.asarray(left + right)
        case ast.Sub():
            return np.asarray(left - right)
        case ast.Mult():
            return np.asarray(left * right)
        case ast.Div():
            return np.asarray(left / right)
    return np.asarray(np.power(left, right))
