"""Slips of the pen in a text, found and mended in the line itself.

Every place of what stands there is tried with everything that may stand there instead, and what
each change does to the value is climbed up to the whole, all changes of a place at once. The
parameters are random numbers, so that a length of 0.5 is no ½. A repair replaces the changed
piece of the text; the rest stays as the writer wrote it, in his names and his order.
"""

from __future__ import annotations

import ast
import keyword
import re
from collections.abc import Callable, Iterator, Mapping, Sequence
from dataclasses import dataclass, field, replace
from fractions import Fraction
from functools import cached_property
from itertools import combinations_with_replacement, pairwise
from typing import Any

import numpy as np

from kinlab.arrays import Array
from kinlab.doctor.meanings import Meanings
from kinlab.doctor.search import Names, pairs_adding_up
from kinlab.doctor.written import Written, operands
from kinlab.formulas import tree
from kinlab.formulas.text import SHORTHAND, canonical, joint_spelling, parse, respelled
from kinlab.formulas.tree import Node
from kinlab.host.language import N_, _
from kinlab.tolerances import TOLERANCES

_NUMBERS = {"1": 1.0, "2": 2.0, "3": 3.0, "4": 4.0, "6": 6.0, "8": 8.0, "12": 12.0, "0.5": 0.5}
_NUMBERS |= {"(1/3)": 1 / 3, "(1/4)": 0.25, "(1/12)": 1 / 12}
_FACTORS = {"2": 2.0, "3": 3.0, "4": 4.0, "/2": 0.5, "/3": 1 / 3, "/4": 0.25}
_TRIED = 60
_LONG = 8
"""Names in a formula from which on three slips are looked for."""
_EXCHANGED = 0.6
"""What it costs to exchange a whole term beside mending it."""
_TERMS = {"extra term", "missing term"}
_NAMED = ("parameter", "missing factor", "extra factor", "power")
_MOTION = re.compile(r"(qdd|qd|q)(\d+)")


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


@dataclass(frozen=True)
class Mended:
    """A text with its slips mended.

    Attributes:
        changes: one to three.
        text: the formula after them.
        cost: the sum of theirs.
    """

    changes: tuple[Change, ...]
    text: str
    cost: float


@dataclass(frozen=True, eq=False)
class _Place:
    """A piece of the text and where it stands."""

    node: ast.expr
    above: _Place | None
    role: int
    value: Array

    @property
    def span(self) -> tuple[int, int]:
        return self.node.col_offset, self.node.end_col_offset or 0


@dataclass(eq=False)
class Line:
    """One formula, with what each change would do to it.

    Attributes:
        text: the formula.
        names: what may stand in it.
        at: values of the robot's names at random points.
        target: the values it should have.
        terms: the derived formula's terms, which may be missing.
        numeric: whether the names have the robot's own numbers: then nothing is believed that
            rests on the value of a name.
    """

    text: Written
    names: Names
    at: Mapping[str, Array]
    target: Array
    terms: list[Node]
    numeric: bool = False
    places: list[_Place] = field(default_factory=list)
    changes: list[Change] = field(default_factory=list)
    rows: list[Array] = field(default_factory=list)

    def __post_init__(self) -> None:
        self.count = len(self.target)
        self.source = self.text.text
        self.root = self._place(ast.parse(self.source, mode="eval").body, None, 0)
        self.scale = float(np.max(np.abs(self.target))) or float(np.max(np.abs(self.root.value)))

    # -------- what stands there

    def _place(self, node: ast.expr, above: _Place | None, role: int) -> _Place:
        # children need their parent and the parent its value: values first
        place = _Place(node, above, role, self._value(node))
        self.places.append(place)
        for k, child in enumerate(operands(node)):
            self._place(child, place, k)
        return place

    def _value(self, node: ast.expr) -> Array:
        piece = ast.unparse(node)
        return replace(self.text, text=piece).values(self.at)

    def segment(self, place: _Place) -> str:
        start, end = place.span
        return self.source[start:end]

    @cached_property
    def spelling(self) -> dict[str, str]:
        """The robot's names as the writer has them: q1 is theta1, l1 is L."""
        found = dict(self.text.spelled)
        for name, meaning in self.text.symbols.items():
            if re.fullmatch(r"[A-Za-z_]\w*", meaning) and name not in self.text.known:
                found.setdefault(meaning, name)
        for meaning, word in joint_spelling(_words(self.source), self.names.n).items():
            found.setdefault(meaning, word)
        return found

    @cached_property
    def short(self) -> bool:
        """Whether the writer has c12 for cos(q1 + q2)."""
        words = _words(self.source)
        return any(SHORTHAND.fullmatch(w) for w in words) and not {"sin", "cos"} & set(words)

    def spelled(self, node: Node) -> str:
        """A piece of a formula as the writer would write it."""
        return tree.to_text(respelled(node, self.spelling, self.short))

    @cached_property
    def atoms(self) -> dict[str, Array]:
        """Names of numbers that may stand in the text, with their values."""
        found: dict[str, Array] = {}
        for name in self.text.symbols:
            if name.isidentifier() and not keyword.iskeyword(name) and not self._turns(name):
                found[name] = self._named(name)
        mine = set(self.spelling)
        for name in self.names.parameters:
            if name not in mine:
                found[name] = np.asarray(self.at[name])
        return found

    def _named(self, name: str) -> Array:
        return replace(self.text, text=name).values(self.at)

    def _turns(self, name: str) -> bool:
        """Whether a symbol is one of the motion: th1 is q1."""
        meaning = self.text.symbols.get(name, name)
        return any(re.fullmatch(r"q\w*\d", w) or SHORTHAND.fullmatch(w) for w in _words(meaning))

    # -------- what may stand there instead

    def put(self, place: _Place, new: Array, change: Change) -> None:
        """Notes a change by what it does to the whole."""
        if self.numeric and change.kind in _NAMED:
            return
        effect = self._climbed(place, new) - self.root.value
        if np.isfinite(effect).all() and np.max(np.abs(effect)) > 1e-12 * self.scale:
            self.changes.append(change)
            self.rows.append(effect)

    def _climbed(self, place: _Place, new: Array) -> Array:
        with np.errstate(all="ignore"):
            while place.above is not None:
                above = place.above
                new = _recombined(above, place, new, self._siblings)
                place = above
        return np.broadcast_to(new, (self.count,))

    @cached_property
    def _siblings(self) -> dict[int, list[_Place]]:
        found: dict[int, list[_Place]] = {}
        for place in self.places:
            if place.above is not None:
                found.setdefault(id(place.above), []).append(place)
        return {key: sorted(value, key=lambda p: p.role) for key, value in found.items()}

    def instead(self, place: _Place, new: str, value: Array, kind: str, cost: float) -> None:
        """A piece in place of a piece."""
        start, end = place.span
        old = self.segment(place)
        told, pieces = self._told(
            place, N_("{old} should be {new}"), N_("{old} should be {new} in {term}")
        )
        if pieces.get("term") == old:
            told = N_("{old} should be {new}")
        pieces |= {"old": old, "new": new}
        self.put(place, value, Change(start, end, new, kind, cost, told, pieces=pieces))

    def _told(self, place: _Place, alone: str, inside: str) -> tuple[str, dict[str, str]]:
        """One of two sentences: with the term that a place is in, where it is worth showing."""
        term = self._around(place)
        return (inside, {"term": term}) if term else (alone, {})

    def _around(self, place: _Place) -> str:
        """The term that a place is in."""
        inner = place
        alone = not isinstance(place.node, ast.BinOp)
        while place.above is not None and (
            (alone and place is inner) or not _is_sum(place.above.node)
        ):
            place = place.above
        term = self.segment(place)
        return term if len(term) < 70 and (place is not inner or not alone) else ""

    def study(self) -> None:
        """Notes every change, once."""
        if self.changes:
            return
        for place in list(self.places):
            if _inside_call(place) or _is_exponent(place):
                continue
            node = place.node
            if isinstance(node, ast.Name):
                self._name(place, node.id)
            elif isinstance(node, ast.Constant):
                self._number(place)
            elif isinstance(node, ast.Call):
                self._call(place, node)
            elif isinstance(node, ast.BinOp):
                self._operation(place, node)
            elif isinstance(node, ast.UnaryOp) and isinstance(node.op, ast.USub):
                inner = self.source[place.span[0] + 1 : place.span[1]].lstrip()
                self.instead(place, inner, -place.value, "sign", 1.0)
            self._as_factor(place)
            self._as_term(place)
        self._whole_terms()
        self._throughout()

    def _name(self, place: _Place, name: str) -> None:
        meant = canonical(name) if name not in self.text.symbols else tree.sym(name)
        if self._turns(name) and name in self.text.symbols:
            meant = canonical(self.text.symbols[name])
        if meant.op in ("sin", "cos"):
            self._wave(place, meant)
            return
        joint = _MOTION.fullmatch(str(meant.value))
        if joint:
            head, index = joint.group(1), int(joint.group(2))
            for i in range(1, self.names.n + 1):
                if i != index:
                    self._node(place, tree.sym(f"{head}{i}"), "index", 1.2)
                    both = tree.add(
                        tree.sym(f"{head}{min(i, index)}"), tree.sym(f"{head}{max(i, index)}")
                    )
                    self._node(place, both, "missing term", 1.25)
            for word, value in self.atoms.items() if head == "q" else ():
                self.instead(place, f"({name} + {word})", place.value + value, "missing term", 1.5)
            for order in self.names.letters:
                if order != head:
                    other = tree.sym(f"{order}{index}")
                    self._node(place, other, "velocity for acceleration", 1.3)
                    self._node(
                        place, tree.power(other, Fraction(2)), "velocity for acceleration", 1.5
                    )
            return
        for word, value in self.atoms.items():
            if word != name:
                near = re.sub(r"\d+", "", word) == re.sub(r"\d+", "", name)
                cost = 1.2 if near else 1.4 if word[0].lower() == name[0].lower() else 1.8
                self.instead(place, word, value, "index" if near else "parameter", cost)
                more, less = f"({name} + {word})", f"({name} - {word})"
                self.instead(place, more, place.value + value, "missing term", 1.5)
                self.instead(place, less, place.value - value, "missing term", 1.7)

    def _node(self, place: _Place, node: Node, kind: str, cost: float) -> None:
        if tree.names(node) <= set(self.at):
            new = self.spelled(node)
            value = np.broadcast_to(tree.evaluate(node, self.at), (self.count,))
            tight = node.op == "add" and place.above is not None
            self.instead(place, f"({new})" if tight else new, value, kind, cost)

    def _number(self, place: _Place) -> None:
        idle = place.above is not None and _is_product(place.above.node)
        for shown, size in _NUMBERS.items():
            if size != float(self.segment(place)) and not (size == 1.0 and idle):
                self.instead(place, shown, np.full(self.count, size), "factor", 1.25)
        if "." not in self.segment(place):
            return
        for word, value in self.atoms.items():  # a length's number, mistaken: 0.41 for l2 = 0.4
            self.instead(place, word, value, "parameter", 1.2)
        if self.numeric:
            moved = self._climbed(place, place.value + 1.0) - self.root.value
            size = float(np.sum(moved * moved))
            right = place.value + np.sum(moved * (self.target - self.root.value)) / (size or 1.0)
            shown = np.format_float_positional(float(right[0]), 12, fractional=False, trim="-")
            if not shown.startswith("-") and not (idle and shown == "1"):
                held = self.meanings.holds(float(self.segment(place)))
                doubt = 0.5 * held + 0.3 * (not self.meanings.holds(float(right[0])))
                self.instead(place, shown, right, "coefficient", 1.15 + doubt)

    @cached_property
    def meanings(self) -> Meanings:
        """What numbers may stand for, at the robot's own."""
        return Meanings.at(self.at)

    def _call(self, place: _Place, node: ast.Call) -> None:
        name = node.func.id if isinstance(node.func, ast.Name) else ""
        if name in ("sin", "cos", "tan"):
            inside = parse(ast.unparse(node.args[0]))
            mapped = {w: canonical(self.text.symbols.get(w, w)) for w in tree.names(inside)}
            self._wave(place, tree.call(name, tree.renamed(inside, mapped)))

    def _wave(self, place: _Place, wave: Node) -> None:
        other = {"sin": "cos", "cos": "sin", "tan": "sin"}[wave.op]
        argument = wave.args[0]
        self._node(place, tree.call(other, argument), "sin/cos", 1.0)
        minus = tree.mul(tree.num(-1), tree.call(other, argument))
        self._node(place, minus, "sin/cos", 1.7)
        for angle in self.names.angles:
            if angle != argument:
                self._node(place, tree.call(wave.op, angle), "argument", 1.2)
                self._node(place, tree.call(other, angle), "argument", 2.0)

    def _operation(self, place: _Place, node: ast.BinOp) -> None:
        left, right = self._siblings[id(place)]
        start, end = place.span
        gap = self.source[left.span[1] : right.span[0]]
        if isinstance(node.op, (ast.Add, ast.Sub)):
            plus = isinstance(node.op, ast.Add)
            at = left.span[1] + gap.index("+" if plus else "-")
            old, new = ("+", "-") if plus else ("-", "+")
            term = self.source[at + 1 : end].strip()
            turned = left.value - right.value if plus else left.value + right.value
            pieces = {"old": f"{old} {term}", "new": f"{new} {term}"}
            told = N_("{old} should be {new}")
            change = Change(at, at + 1, new, "sign", 1.0, told, pieces=pieces)
            self.put(place, turned, change)
            told = N_("the term {term} does not belong there")
            pieces = {"term": f"{'' if plus else '-'}{term}"}
            change = Change(at, end, "", "extra term", 1.1, told, pieces=pieces)
            self.put(place, left.value, change)
            first = self.source[start:at].strip()
            alone = right.value if plus else -right.value
            kept = at + 1 if plus else at
            pieces = {"term": first}
            change = Change(start, kept, "", "extra term", 1.15, told, pieces=pieces)
            self.put(place, alone, change)
            return
        sign = {ast.Mult: "*", ast.Div: "/", ast.Pow: "**"}[type(node.op)]
        at = left.span[1] + gap.index(sign)
        first, second = self.source[start:at].strip(), self.source[at + len(sign) : end].strip()
        if isinstance(node.op, ast.Pow):
            base = left.value
            told, pieces = self._told(
                place, N_("{old} should be {new}"), N_("{old} should be {new} in {term}")
            )
            pieces |= {"old": self.segment(place), "new": first}
            cost = 1.1 if second.strip("()") == "2" else 1.5
            change = Change(at, end, "", "power", cost, told, pieces=pieces)
            self.put(place, base, change)
            for other in (2, 3, 4, -1):
                with np.errstate(all="ignore"):
                    value = np.power(base, float(other))
                raised = pieces | {"new": f"{first}**{other}"}
                change = Change(at + 2, end, str(other), "power", 1.3, told, pieces=raised)
                self.put(place, value, change)
            return
        if isinstance(node.op, ast.Div):
            told, pieces = self._told(
                place, N_("/{factor} does not belong"), N_("/{factor} does not belong in {term}")
            )
            pieces |= {"factor": second}
            change = Change(at, end, "", "factor", 1.25, told, pieces=pieces)
            self.put(place, left.value, change)
            return
        told, pieces = self._told(
            place,
            N_("the factor {factor} does not belong"),
            N_("the factor {factor} does not belong in {term}"),
        )
        one, two = pieces | {"factor": second}, pieces | {"factor": first}
        kinds = [
            "factor" if isinstance(part.node, ast.Constant) else "extra factor"
            for part in (right, left)
        ]
        self.put(place, left.value, Change(at, end, "", kinds[0], 1.3, told, pieces=one))
        kind = kinds[1]
        self.put(place, right.value, Change(start, at + 1, "", kind, 1.3, told, pieces=two))

    def _as_factor(self, place: _Place) -> None:
        """Squares, and factors that are missing in front of a term."""
        node = place.node
        piece = self.segment(place)
        wrapped = f"({piece})" if isinstance(node, (ast.BinOp, ast.UnaryOp)) else piece
        atom = isinstance(node, (ast.Name, ast.Call)) or _is_sum(node)
        if atom and not _is_base(place):
            cost = 1.1 if not _is_sum(node) else 1.4
            self.instead(place, f"{wrapped}**2", place.value**2, "power", cost)
        if not _is_term(place):
            return
        extra = 0.3 if _is_sum(node) else 0.0
        body = wrapped if _is_sum(node) else piece
        numbered = 0.15 * bool(re.search(r"(?<![\w.*])(?:/\s*)?\d", body))  # 2*x/2 is x
        for shown, size in _FACTORS.items():
            new = f"{body}{shown}" if shown[0] == "/" else f"{shown}*{body}"
            cost = (1.2 if size in (2.0, 0.5) else 1.6) + extra + numbered
            self.instead(place, new, size * place.value, "factor", cost)
        signed = place.above is not None and isinstance(place.above.node, ast.BinOp)
        if not signed or place.role == 0:
            self.instead(place, self._turned(place), -place.value, "sign", 1.0 + extra)
        for name, value in self.atoms.items():
            for power, more in ((1, 0.0), (2, 0.4)):
                word = name if power == 1 else f"{name}**{power}"
                change = Change(
                    place.span[1],
                    place.span[1],
                    f"*{word}",
                    "missing factor",
                    1.4 + more + extra,
                    N_("the factor {factor} is missing in {term}"),
                    pieces={"factor": word, "term": piece},
                )
                if _is_sum(node):
                    change = replace(change, start=place.span[0], new=f"{body}*{word}")
                self.put(place, place.value * value**power, change)
        moving = [tree.sym(f"{x}{i + 1}") for x in self.names.letters for i in range(self.names.n)]
        waves = [tree.call(f, angle) for angle in self.names.angles for f in ("cos", "sin")]
        for factor in (*moving, *waves):
            new = f"{body}*{self.spelled(factor)}"
            times = place.value * tree.evaluate(factor, self.at)
            change = Change(
                place.span[0],
                place.span[1],
                new,
                "missing factor",
                1.45 + extra,
                N_("the factor {factor} is missing in {term}"),
                pieces={"factor": self.spelled(factor), "term": piece},
            )
            self.put(place, times, change)

    def _turned(self, place: _Place) -> str:
        """A piece with the opposite sign, without a sign in front of a sign."""
        if not _is_sum(place.node):
            piece = self.segment(place)
            return piece[1:].lstrip() if piece.startswith("-") else f"-{piece}"
        left, right = self._siblings[id(place)]
        gap = self.source[left.span[1] : right.span[0]]
        sign = next(c for c in gap if c in "+-")
        start, end = place.span
        behind = self.source[left.span[1] : end].replace(sign, {"+": "-", "-": "+"}[sign], 1)
        if self.source[start : left.span[0]].strip():  # brackets: -(a + b) - c
            inner = self.source[start : left.span[1]] + ")" * gap[: gap.index(sign)].count(")")
            return f"-{inner}{behind[behind.index({'+': '-', '-': '+'}[sign]) :]}"
        return self._turned(left) + behind

    @cached_property
    def gap(self) -> str:
        """What the writer puts around a sign between terms."""
        return "" if re.search(r"\S[-+]\S", self.source) else " "

    def _as_term(self, place: _Place) -> None:
        """Terms that are missing in a sum between parentheses."""
        node = place.node
        chain = _is_sum(node) and not (place.above is not None and _is_sum(place.above.node))
        if not chain or place.above is None:
            return
        inside = self.segment(place)
        for piece, value in self.pieces.items():
            for sign in ("+", "-"):
                twice = re.search(rf"(?:^|[+-])\s*{re.escape(piece)}\s*(?:$|[+-])", inside)
                cost = (1.12 if sign == "+" else 1.6) + 0.03 * piece.count("*") + 0.4 * bool(twice)
                pieces = {"term": piece if sign == "+" else f"-{piece}", "sum": f"({inside})"}
                change = Change(
                    place.span[1],
                    place.span[1],
                    f"{self.gap}{sign}{self.gap}{piece}",
                    "missing term",
                    cost,
                    N_("the term {term} is missing in {sum}"),
                    pieces=pieces,
                )
                self.put(place, place.value + (value if sign == "+" else -value), change)

    @cached_property
    def pieces(self) -> dict[str, Array]:
        """What may be missing between parentheses: parts of the derived terms."""
        found: dict[str, Array] = {}
        for term in self.terms:
            factors = term.args if term.op == "mul" else (term,)
            plain = [f for f in factors if f.op != "num"]
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

    def _whole_terms(self) -> None:
        end = len(self.source)
        for term in self.terms:
            value = self.root.value + np.broadcast_to(tree.evaluate(term, self.at), (self.count,))
            shown = self.spelled(term)
            sign, body = ("-", shown[1:]) if shown.startswith("-") else ("+", shown)
            change = Change(
                end,
                end,
                f"{self.gap}{sign}{self.gap}{body}",
                "missing term",
                1.3,
                N_("the term {term} is missing"),
                pieces={"term": shown},
            )
            self.put(self.root, value, change)

    def _throughout(self) -> None:
        """One name for another in the whole text; sines and cosines exchanged; gravity turned."""
        words = _words(self.source)
        joints = {f"{x}{i + 1}" for x in ("q", "qd", "qdd") for i in range(self.names.n)}
        inside = [w for w in dict.fromkeys(words) if w in self.atoms and words.count(w) > 1]
        for word in inside:
            for other in self.atoms:
                if other != word:
                    told = N_("{old} should be {new} throughout")
                    pieces = {"old": word, "new": other}
                    self._global(((word, other),), "parameter", 1.9, told, pieces)
        shown = {self.spelling.get(j, j) for j in joints}
        for i in range(1, self.names.n + 1):
            for k in range(i + 1, self.names.n + 1):
                swap = []
                for x in ("q", "qd", "qdd"):
                    one = self.spelling.get(f"{x}{i}", f"{x}{i}")
                    two = self.spelling.get(f"{x}{k}", f"{x}{k}")
                    swap += [(one, two), (two, one)]
                if {a for a, _ in swap} & set(words) & shown:
                    told = N_("{one} and {two} are exchanged throughout")
                    pieces = {"one": swap[0][0], "two": swap[0][1]}
                    self._global(tuple(swap), "index", 2.2, told, pieces)
        if {"sin", "cos"} & set(words):
            self._global(
                (("sin", "cos"), ("cos", "sin")),
                "sin/cos",
                1.9,
                N_("sin and cos are exchanged throughout"),
                {},
            )
        weight = self.spelling.get("g", "g")
        if words.count(weight) > 1:
            told = N_("gravity has the opposite sign: every g should be -g")
            self._global(((weight, f"(-{weight})"),), "gravity sign", 1.5, told, {})

    def _global(
        self,
        swap: tuple[tuple[str, str], ...],
        kind: str,
        cost: float,
        told: str,
        pieces: Mapping[str, str],
    ) -> None:
        new = exchanged(self.source, swap)
        if new == self.source:
            return
        try:
            values = replace(self.text, text=new).values(self.at)
        except KeyError:
            return
        change = Change(0, len(self.source), new, kind, cost, told, swap, pieces)
        self.put(self.root, values, change)


# -------- One slip, two, three


def mended(line: Line, most: int = 3) -> list[Mended]:
    """The fewest changes that make the text right, the likeliest first; empty where none do."""
    if not line.source.isascii():
        return []  # places are counted in bytes
    line.study()
    wanted = line.target - line.root.value
    if not line.rows:
        return []
    effects = np.array(line.rows)
    allowed = TOLERANCES.effect_matches * line.scale
    gaps = np.max(np.abs(effects - wanted), axis=1)
    found: list[tuple[int, ...]] = [(int(k),) for k in np.flatnonzero(gaps <= allowed)]
    for more in (_pairs, _covers)[: most - 1]:
        good = list(_checked(line, found))
        if good:
            return sorted(good, key=lambda m: m.cost)
        found = more(line, effects, wanted, allowed)
    return sorted(_checked(line, found), key=lambda m: m.cost)


def _pairs(line: Line, effects: Array, wanted: Array, allowed: float) -> list[tuple[int, ...]]:
    found = [tuple(pair) for pair in pairs_adding_up(effects, wanted, allowed)]
    value = line.root.value
    for place in line.places:
        if not _is_term(place) or _inside_call(place) or _is_sum(place.node):
            continue
        start, end = place.span
        inside = [
            k
            for k, c in enumerate(line.changes)
            if start <= c.start and c.end <= end and not c.everywhere and c.kind != "missing term"
        ]
        if len(inside) < 2:
            continue
        slope = line._climbed(place, np.zeros(line.count))
        own = value - slope  # the share of this term in the whole
        with np.errstate(all="ignore"):
            goal = np.log(np.abs(1 + wanted / own))
            logs = np.log(np.abs(1 + effects[inside] / own))
        good = np.isfinite(logs).all(axis=1)
        if not np.isfinite(goal).all() or not good.any():
            continue
        kept = [inside[k] for k in np.flatnonzero(good)]
        found += [(kept[a], kept[b]) for a, b in pairs_adding_up(logs[good], goal, 1e-8)]
    return _cheapest(line, found)


def _cheapest(line: Line, found: list[tuple[int, ...]]) -> list[tuple[int, ...]]:
    ranked = sorted(set(found), key=lambda way: (_cost([line.changes[k] for k in way]), way))
    return ranked[:_TRIED]


def _cost(changes: Sequence[Change]) -> float:
    """How far-fetched several changes are together."""
    terms = {c.kind for c in changes} >= _TERMS
    return sum(c.cost for c in changes) + 0.4 * (len(changes) - 1) + _EXCHANGED * terms


def _covers(line: Line, effects: Array, wanted: Array, allowed: float) -> list[tuple[int, ...]]:
    """Three changes: one of them leaves what two others add up to.

    Only changes that take a whole term of the difference away are tried as the first.
    """
    rest = np.sum((wanted[:, None] - effects.T) ** 2, axis=0)
    order = np.argsort(rest + 1e-9 * np.array([c.cost for c in line.changes]), kind="stable")
    found: list[tuple[int, ...]] = []
    for first in order[:_TRIED]:
        pairs = pairs_adding_up(effects, wanted - effects[first], allowed)
        found += [tuple(sorted((int(first), *pair))) for pair in pairs if first not in pair]
    return _cheapest(line, found)


def together(line: Line, changes: tuple[Change, ...]) -> list[Mended]:
    """Changes that were found one by one, as one repair, if they are."""
    line.changes += changes
    behind = len(line.changes)
    found = [tuple(range(behind - len(changes), behind))]
    done = list(_checked(line, found))
    del line.changes[behind - len(changes) :]
    return done


def _checked(line: Line, found: list[tuple[int, ...]]) -> Iterator[Mended]:
    """Those that really give the values wanted once they are written down."""
    seen: set[str] = set()
    for way in found:
        changes = tuple(sorted((line.changes[k] for k in way), key=lambda c: (c.start, c.end)))
        if any(a.end > b.start or a.everywhere or b.everywhere for a, b in pairwise(changes)):
            continue
        text = rewritten(line.source, changes)
        if text is None or text in seen:
            continue
        seen.add(text)
        if (len(changes) > 2 and len(_words(line.source)) < _LONG) or not _same_formula(changes):
            continue
        values = replace(line.text, text=text).values(line.at)
        with np.errstate(all="ignore"):
            gap = np.max(np.abs(values - line.target))
        if gap <= TOLERANCES.effect_matches * line.scale:
            yield Mended(changes, text, _cost(changes))


def _same_formula(changes: tuple[Change, ...]) -> bool:
    """Whether something of the formula is left: terms out and other terms in make any other."""
    return sum(c.kind in _TERMS for c in changes) < 3


def rewritten(source: str, changes: tuple[Change, ...]) -> str | None:
    """The text with the changes in place; None where it is no formula any more."""
    text = source
    for change in sorted(changes, key=lambda c: -c.start):
        text = text[: change.start] + change.new + text[change.end :]
    text = re.sub(r"^\s*\+\s*", "", text.strip())
    text = re.sub(r"\(\s*\+\s*", "(", text)
    text = re.sub(r"(^|\()\s*-\s+", r"\1-", re.sub(r"  +", " ", text))
    try:
        ast.parse(text, mode="eval")
    except SyntaxError:
        return None
    return text


def exchanged(text: str, swap: tuple[tuple[str, str], ...]) -> str:
    """The text with words exchanged, all at once."""
    table = dict(swap)
    return re.sub(r"[A-Za-z_]\w*", lambda m: table.get(m.group(), m.group()), text)


# -------- Small questions about places

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


def _words(text: str) -> list[str]:
    return re.findall(r"[A-Za-z_]\w*", text)


def _is_sum(node: ast.expr) -> bool:
    return isinstance(node, ast.BinOp) and isinstance(node.op, (ast.Add, ast.Sub))


def _is_product(node: ast.expr) -> bool:
    return isinstance(node, ast.BinOp) and isinstance(node.op, (ast.Mult, ast.Div))


def _is_exponent(place: _Place) -> bool:
    while place.above is not None:
        node = place.above.node
        if isinstance(node, ast.BinOp) and isinstance(node.op, ast.Pow) and place.role == 1:
            return True
        place = place.above
    return False


def _is_base(place: _Place) -> bool:
    above = place.above
    return (
        above is not None
        and isinstance(above.node, ast.BinOp)
        and isinstance(above.node.op, ast.Pow)
    )


def _inside_call(place: _Place) -> bool:
    while place.above is not None:
        place = place.above
        if isinstance(place.node, ast.Call):
            return True
    return False


def _is_term(place: _Place) -> bool:
    """Whether a place is a whole term of a sum, the formula, or what stands in parentheses."""
    above = place.above
    if above is None or isinstance(above.node, ast.UnaryOp):
        return True
    return _is_sum(above.node)


def _recombined(
    above: _Place, place: _Place, new: Array, siblings: Mapping[int, list[_Place]]
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
