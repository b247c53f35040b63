"""Products of several factors that a number lacks to be one of a textbook's: ``2*m2*l1*lc2*c2``.

What is missing is known where a statement's value is that less than something that the arm has at
every state: which product of the numbers at hand it is, is looked up.
"""

from __future__ import annotations

import ast
from collections import Counter
from collections.abc import Iterator, Sequence
from functools import reduce
from itertools import combinations_with_replacement

import numpy as np

from kinlab.arrays import Array
from kinlab.doctor.bytecode.syntax import called, copied, factors, names, nodes
from kinlab.doctor.glossary.textbook import Glossary
from kinlab.doctor.program.edits.scope.forms import statement_of, summands
from kinlab.doctor.program.edits.scope.part import Scope, standing
from kinlab.doctor.program.grounds.products import is_whole
from kinlab.doctor.program.observed import Observed
from kinlab.doctor.program.places import ANGLES, ProgramEdit, number
from kinlab.doctor.program.trial import Trial
from kinlab.tolerances import TOLERANCES

_ATOMS = 22
"""Numbers of which a product may be, those that stand most often."""
_FACTORS = 4
"""Factors of a product."""
_FRONTS = (1.0, 2.0, 0.5)
"""What may stand in front of it."""
_MOST = 6
"""Products that are tried in one place."""
_IDLE, _FEW = 100, 6
"""As how often what nothing uses counts among the numbers of a part; how many of these."""
_FRONT = 1.5
"""As how many more factors a number in front counts."""
_COST, _LONGER = 1.1, 0.01
"""What one is far-fetched of two factors, and what each further one adds."""


def lacking_terms(
    trial: Trial, observed: Observed, scopes: Sequence[Scope], known: Sequence[Glossary]
) -> Iterator[ProgramEdit]:
    """Products with which a number would be one of a textbook's.

    Args:
        trial: a program.
        observed: its expressions.
        scopes: those of its parts.
        known: the textbook's things at the states at which it was watched.
    """
    things = _scalars(known)
    if len(known) < 2 or not len(things):
        return
    tables: dict[int, _Products] = {}
    for here, scope in standing(trial, scopes, is_whole):
        value = _firsts(observed, here.node, len(known))
        if value is None or _is_among(value, things):
            continue
        if here.part not in tables:
            idle = _unread(trial, scope)
            tables[here.part] = _Products(trial.trees[here.part], observed, len(known), idle)
        sum_, below = _over(here.node)
        share = np.ones(len(known)) if below is None else _firsts(observed, below, len(known))
        if share is None:
            continue
        own = {ast.unparse(one) for one in summands(sum_)}
        line = statement_of(here.above).lineno
        last = factors([*summands(sum_)][-1])
        made = tables[here.part].making((things - value) * share)
        made.sort(key=lambda one: abs(one[2] - len(last)))  # as long as what stands beside it
        for op, product, length in made[:_MOST]:
            term = _as_beside(product, last)
            counted = {*scope.counters} - scope.counting  # by loops that are none around it
            late = any(scope.set_at.get(name, 0) > line for name in names(term))
            if not late and counted.isdisjoint(names(term)) and ast.unparse(term) not in own:
                new = ast.BinOp(sum_, op, term)
                new = new if below is None else ast.BinOp(new, ast.Div(), below)
                yield here.instead(new, "missing term", _COST + _LONGER * (length - 2))


def _over(node: ast.expr) -> tuple[ast.expr, ast.expr | None]:
    """A sum in brackets, and what it is divided by; any other expression as it is."""
    if isinstance(node, ast.BinOp) and isinstance(node.op, ast.Div):
        above = node.left
        if isinstance(above, ast.BinOp) and isinstance(above.op, ast.Add | ast.Sub):
            return above, node.right
    return node, None


def _as_beside(product: ast.expr, beside: list[ast.expr]) -> ast.expr:
    """A product with its factors in the order of those that begin so in another term."""
    letters = [ast.unparse(one)[:1].lower() for one in beside]
    own = factors(product)
    firsts = [ast.unparse(one)[:1].lower() for one in own]
    at = [letters.index(x) if x in letters else len(letters) for x in firsts]
    order = sorted(range(len(own)), key=lambda k: at[k])
    return reduce(lambda one, other: ast.BinOp(one, ast.Mult(), other), [own[k] for k in order])


def _unread(trial: Trial, scope: Scope) -> dict[str, float]:
    """Numbers with names that no function reads: what is made of them may have been forgotten."""
    parts = zip(trial.program.parts, trial.trees, strict=True)
    read = {name for part, tree in parts if not part.sets for name in names(tree, ast.Load)}
    every = {name: scope.level_of(name) for name in (*trial.program.space, *scope.unused)}
    free = [name for name, value in every.items() if value and name not in read]
    return {name: every[name] for name in free[:_FEW] if name[:1] != "_"}


def _scalars(known: Sequence[Glossary]) -> Array:
    """The numbers that the textbook has at the states, (G, S)."""
    found = [one.things.get((), ([], np.empty(0)))[1] for one in known]
    if not found or len({len(x) for x in found}) > 1:
        return np.empty((0, 0))
    return np.unique(np.stack(found, axis=1), axis=0)


def _firsts(observed: Observed, node: ast.AST, states: int) -> Array | None:
    """What a number is when it is first met at each state; None where that is not known."""
    seen = observed.of(node)
    if seen is None or seen.shape != () or seen.count % states or len(seen.values) < seen.count:
        return None
    found = np.array(seen.values[:: seen.count // states], dtype=float)
    return found if np.isfinite(found).all() else None


def _is_among(value: Array, things: Array) -> bool:
    gap = np.abs(np.abs(things) - np.abs(value)).max(axis=1)
    return bool((gap <= TOLERANCES.same_relation * np.max(np.abs(value))).any())


class _Products:
    """All products of the numbers of one part, by their size at the first state.

    Args:
        tree: the part.
        observed: its expressions.
        states: at which they were watched.
        idle: numbers that nothing uses, by their names: these come first.
    """

    def __init__(
        self, tree: ast.AST, observed: Observed, states: int, idle: dict[str, float]
    ) -> None:
        met: Counter[str] = Counter(dict.fromkeys(idle, _IDLE))
        self.atoms: dict[str, tuple[ast.expr, Array]] = {
            name: (ast.Name(name, ast.Load()), np.full(states, value))
            for name, value in idle.items()
        }
        for name, given in _never_read(tree):
            value = _firsts(observed, given, states)
            if value is not None and value.all():
                met[name] = _IDLE
                self.atoms[name] = ast.Name(name, ast.Load()), value
        for node in nodes(tree):
            if not isinstance(node, ast.expr) or not _may_be_factor(node):
                continue
            value, text = _firsts(observed, node, states), ast.unparse(node)
            if value is not None and value.all():
                met[text] += 1
                self.atoms.setdefault(text, (node, value))
        self.texts = [text for text, _count in met.most_common() if not self._is_named(text)]
        self.texts = self.texts[:_ATOMS]
        values = np.array([self.atoms[text][1] for text in self.texts]).reshape(-1, states)
        sizes, signs = np.log(np.abs(values)), np.sign(values)
        self.ways: list[tuple[int, ...]] = []
        for count in range(2, _FACTORS + 1):
            self.ways += combinations_with_replacement(range(len(self.texts)), count)
        # what is left out of shorter ones is a factor 1
        one = np.zeros((1, states))
        each = np.array([[*way, *[-1] * (_FACTORS - len(way))] for way in self.ways], dtype=int)
        each = each.reshape(-1, _FACTORS)
        self.sizes = np.concatenate([sizes, one])[each].sum(axis=1)
        self.signs = np.concatenate([signs, one + 1])[each].prod(axis=1)
        self.order = np.argsort(self.sizes[:, 0], kind="stable")

    def _is_named(self, text: str) -> bool:
        """Whether something has a name: cos(t1) beside c1."""
        node, value = self.atoms[text]
        names_ = (x for x, _value in self.atoms.values() if isinstance(x, ast.Name))
        others = (self.atoms[one.id][1] for one in names_) if isinstance(node, ast.Call) else ()
        return any(np.array_equal(value, other) for other in others)

    def making(self, wanted: Array) -> list[tuple[ast.operator, ast.expr, float]]:
        """The products that are one of the numbers wanted, (G, S), or less; the shortest first."""
        moving = np.ptp(wanted, axis=1) > TOLERANCES.same_relation * np.abs(wanted).max(axis=1)
        wanted = wanted[moving & wanted.all(axis=1)]
        found: set[tuple[float, int, float, bool]] = set()
        line = self.sizes[self.order, 0]
        near = TOLERANCES.same_relation
        for front in _FRONTS:
            sizes = np.log(np.abs(wanted) / front)
            low = np.searchsorted(line, sizes[:, 0] - near)
            high = np.searchsorted(line, sizes[:, 0] + near)
            for g in np.flatnonzero(high > low):
                for k in map(int, self.order[low[g] : high[g]]):
                    signs = np.sign(wanted[g]) * self.signs[k]
                    if np.abs(self.sizes[k] - sizes[g]).max() <= near and np.ptp(signs) == 0:
                        length = len(self.ways[k]) + _FRONT * (front != 1.0)
                        found.add((length, k, front, bool(signs[0] < 0)))
        return [
            (ast.Sub() if less else ast.Add(), self._term(k, front), n)
            for n, k, front, less in sorted(found)
        ]

    def _term(self, k: int, front: float) -> ast.expr:
        factors: list[ast.expr] = []
        for n, power in Counter(self.ways[k]).items():
            one = copied(self.atoms[self.texts[n]][0])
            factors.append(one if power == 1 else ast.BinOp(one, ast.Pow(), number(power)))
        factors = [number(2 if front == 2.0 else front)] * (front != 1.0) + factors
        return reduce(lambda one, other: ast.BinOp(one, ast.Mult(), other), factors)


def _never_read(tree: ast.AST) -> Iterator[tuple[str, ast.expr]]:
    """What a part sets by a name and never reads: what was made of it may have been forgotten."""
    read = {*names(tree, ast.Load)}
    for node in nodes(tree):
        if isinstance(node, ast.Assign):
            named = (x.id for x in node.targets if isinstance(x, ast.Name) and x.id not in read)
            yield from ((name, node.value) for name in named)


def _may_be_factor(node: ast.expr) -> bool:
    """Whether it is a name, an entry, an attribute, or a sine or cosine, that is read."""
    if isinstance(node, ast.Call):
        return called(node) in ANGLES
    return isinstance(node, ast.Name | ast.Subscript | ast.Attribute) and isinstance(
        node.ctx, ast.Load
    )
