"""Every slip at one place of a formula, and those that turn it into another by their effect.

:func:`edits` lists what could stand in a place instead: sign, factor, power, index, function, ...

Each edit's effect is computed at random points by climbing from the changed place to the root.
One slip: an effect equal to what is missing. Two slips in different terms: two effects that add
up to it, found by sorting one projection of them (no pair is tried in vain). Two slips in one
product multiply instead: the logarithms of their ratios add up.
"""

from __future__ import annotations

import re
from collections.abc import Iterable, Iterator
from dataclasses import dataclass
from fractions import Fraction

import numpy as np

from kinlab.arrays import Array
from kinlab.doctor.text.line import Names
from kinlab.doctor.text.pairs import pairs_adding_up, pairs_in_product
from kinlab.formulas import tree
from kinlab.formulas.tree import Node, Path
from kinlab.tolerances import TOLERANCES

_CANDIDATES = 40
_EXCHANGED = 0.6
"""What it costs to exchange a whole term beside mending it."""
_TRIED = 150
"""Pairs that are written out and evaluated, the simplest first."""

_INDEXED = re.compile(r"([A-Za-z_]+?)(\d+)")
_FACTORS = tuple(
    Fraction(f) for f in ("-1", "2", "1/2", "-2", "-1/2", "3", "1/3", "4", "1/4", "3/2", "2/3")
)
_ORDERS = ("q", "qd", "qdd")


@dataclass(frozen=True)
class Edit:
    """Something else in one place.

    Attributes:
        path: the place.
        new: what stands there afterwards.
        kind: ``"sign"``, ``"factor"``, ``"power"``, ...
        cost: how far-fetched it is; the simplest explanation is named first.
        times: the factor, where the new node is the old one times a factor.
    """

    path: Path
    new: Node
    kind: str
    cost: float
    times: Node | None = None


def edits(root: Node, names: Names) -> Iterator[Edit]:
    """Every single slip in a formula.

    Args:
        root: the formula.
        names: what may be written in it.
    """
    for path, node in tree.nodes(root):
        inside = [tree.at_path(root, path[:k]).op for k in range(len(path))]
        if any(op in tree.FUNCTIONS for op in inside):
            continue  # arguments are changed as a whole, at their function
        parent = inside[-1] if inside else ""
        yield from _any_place(path, node, parent)
        if node.op == "sym":
            yield from _symbol(path, node, names)
        if node.op in ("sin", "cos", "tan"):
            yield from _function(path, node, names)
        if node.op == "pow" or (parent in ("mul", "add", "") and node.op not in ("add", "num")):
            yield from _powers(path, node)
        if node.op == "mul":
            yield from _product(path, node)
            yield from _opened(path, node)
        if not path or (parent == "add" and node.op != "add"):
            yield from _more_factors(path, node, names)
        if node.op == "add":
            yield from _signs(path, node)


def _any_place(path: Path, node: Node, parent: str) -> Iterator[Edit]:
    if parent == "add" or not path:
        for factor in _FACTORS:
            kind = "sign" if factor == -1 else "factor"
            cost = 1.0 if factor == -1 else 1.2 if factor in (2, Fraction(1, 2)) else 1.6
            yield _factor(path, node, tree.num(factor), kind, cost)
    if parent == "add":
        yield Edit(path, tree.num(0), "extra term", 1.1)
    if parent == "mul" and node.op not in ("num",):
        yield Edit(path, tree.num(1), "extra factor", 1.3)
        if node.op == "add":
            yield _factor(path, node, tree.num(-1), "sign", 1.4)
    if node.op == "num" and parent == "mul":
        yield Edit(path, tree.num(1), "factor", 1.2)


def _symbol(path: Path, node: Node, names: Names) -> Iterator[Edit]:
    name = str(node.value)
    found = _INDEXED.fullmatch(name)
    head, index = (found.group(1), int(found.group(2))) if found else (name, 0)
    if head in _ORDERS and found:
        for i in range(1, names.n + 1):
            if i != index:
                yield Edit(path, tree.sym(f"{head}{i}"), "index", 1.2)
        for order in names.letters:
            if order != head:
                yield Edit(path, tree.sym(f"{order}{index}"), "velocity for acceleration", 1.3)
                squared = tree.power(tree.sym(f"{order}{index}"), Fraction(2))
                yield Edit(path, squared, "velocity for acceleration", 1.5)
        return
    for other in names.parameters:
        if other != name:
            alike = _INDEXED.fullmatch(other)
            same = found and alike and alike.group(1) == head
            yield Edit(
                path, tree.sym(other), "index" if same else "parameter", 1.2 if same else 1.8
            )


def _function(path: Path, node: Node, names: Names) -> Iterator[Edit]:
    argument = node.args[0]
    other = {"sin": "cos", "cos": "sin", "tan": "sin"}[node.op]
    yield Edit(path, tree.call(other, argument), "sin/cos", 1.0)
    yield Edit(path, tree.mul(tree.num(-1), tree.call(other, argument)), "sin/cos", 1.7)
    if argument.op == "add":
        opened = tree.add(tree.call(node.op, argument.args[0]), *argument.args[1:])
        yield Edit(path, opened, "parentheses", 1.05)
    for angle in names.angles:
        if angle != argument:
            yield Edit(path, tree.call(node.op, angle), "argument", 1.2)
            yield Edit(path, tree.call(other, angle), "argument", 2.0)


def _powers(path: Path, node: Node) -> Iterator[Edit]:
    base, old = (node.args[0], node.value) if node.op == "pow" else (node, Fraction(1))
    if node.op == "mul":
        return
    for value in (1, 2, 3, Fraction(1, 2), -1, -2):
        if value != old:
            near = abs(value - old) == 1 and value > 0
            yield Edit(path, tree.power(base, Fraction(value)), "power", 1.1 if near else 1.6)


def _opened(path: Path, node: Node) -> Iterator[Edit]:
    """Parentheses lost: ``l2*cos q1 + q2`` for ``l2*cos(q1 + q2)``."""
    for k, factor in enumerate(node.args):
        if factor.op in ("sin", "cos") and factor.args[0].op == "add":
            first, *rest = factor.args[0].args
            args = [*node.args[:k], tree.call(factor.op, first), *node.args[k + 1 :]]
            yield Edit(path, tree.add(tree.mul(*args), *rest), "parentheses", 1.05)


def _product(path: Path, node: Node) -> Iterator[Edit]:
    """One factor given to another: l1*l2 for l1**2 is reached by index; here squares wander."""
    squares = [(k, a) for k, a in enumerate(node.args) if a.op == "pow" and a.value == 2]
    for k, square in squares:
        for j, other in enumerate(node.args):
            if j != k and other.op == "sym":
                args = list(node.args)
                args[k], args[j] = square.args[0], tree.power(other, Fraction(2))
                yield Edit(path, tree.mul(*args), "power", 1.7)


def _more_factors(path: Path, node: Node, names: Names) -> Iterator[Edit]:
    for name in names.parameters:
        yield _factor(path, node, tree.sym(name), "missing factor", 1.4)
    for letter in names.letters:
        for i in range(1, names.n + 1):
            yield _factor(path, node, tree.sym(f"{letter}{i}"), "missing factor", 1.5)
    for angle in names.angles:
        for function in ("cos", "sin"):
            yield _factor(path, node, tree.call(function, angle), "missing factor", 1.4)


def _factor(path: Path, node: Node, times: Node, kind: str, cost: float) -> Edit:
    # numbers go in front, names behind, as one writes
    new = tree.mul(times, node) if times.op == "num" else tree.mul(node, times)
    return Edit(path, new, kind, cost, times)


def _signs(path: Path, node: Node) -> Iterator[Edit]:
    """Parentheses lost: the sign in front meant the rest of the sum."""
    for k in range(1, len(node.args) - 1):
        kept = node.args[:k]
        turned = tree.add(*(tree.mul(tree.num(-1), a) for a in node.args[k:]))
        yield Edit(path, tree.add(*kept, turned), "sign", 1.5)


# -------- Their effects


@dataclass(frozen=True)
class Repair:
    """Edits that make one formula the other.

    Attributes:
        edits: one or two.
        result: the formula after them.
        cost: sum of the edits' costs.
    """

    edits: tuple[Edit, ...]
    result: Node
    cost: float


@dataclass(frozen=True, eq=False)
class Study:
    """A formula beside the values it should have, with the effect of every edit.

    Attributes:
        root: the formula.
        target: the values wanted at the points, (P,).
        at: values of every name at the points.
        value: the formula's own values, (P,).
        found: the edits. effects: what each adds to the value, (E, P).
        scale: what differences are relative to.
    """

    root: Node
    target: Array
    at: dict[str, Array]
    value: Array
    found: list[Edit]
    effects: Array
    scale: float

    @property
    def wanted(self) -> Array:
        """What is missing."""
        return self.target - self.value

    def fits(self, result: Node) -> bool:
        """Whether a formula has the values wanted."""
        gap = np.abs(tree.evaluate(result, self.at) - self.target)
        return bool(np.max(gap) <= TOLERANCES.effect_matches * self.scale)


def study(
    root: Node, target: Array, at: dict[str, Array], names: Names, extra: list[Node]
) -> Study:
    """Computes the effects of all edits of ``root``, once for all searches.

    Args:
        root: the formula.
        target: the values wanted at the points.
        at: values of every name at the points.
        names: what may be written.
        extra: whole terms that may be missing.
    """
    climber = Climber(root, at)
    size = float(np.max(np.abs(target), initial=0.0))
    scale = size or float(np.max(np.abs(climber.value))) or 1.0
    found: list[Edit] = []
    rows: list[Array] = []
    memory: dict[Node, Array] = {}
    for edit in edits(root, names):
        if edit.new not in memory:
            memory[edit.new] = tree.evaluate(edit.new, at)
        effect = climber.climb(edit.path, memory[edit.new]) - climber.value
        if np.isfinite(effect).all() and np.max(np.abs(effect)) > TOLERANCES.no_effect * scale:
            found.append(edit)
            rows.append(effect)
    for term in extra:
        for sign in (1, -1):
            node = tree.mul(tree.num(sign), term)
            found.append(Edit((), node, "missing term", 1.1 if sign > 0 else 1.9))
            rows.append(np.broadcast_to(tree.evaluate(node, at), target.shape))
    effects = np.array(rows) if rows else np.zeros((0, len(target)))
    return Study(root, target, at, climber.value, found, effects, scale)


def single(case: Study) -> list[Repair]:
    """All single edits that give the values wanted, the simplest first."""
    gaps = np.max(np.abs(case.effects - case.wanted), axis=1, initial=0.0)
    good = [case.found[k] for k in np.flatnonzero(gaps <= TOLERANCES.effect_matches * case.scale)]
    return _best(Repair((edit,), apply(case.root, edit), edit.cost) for edit in good)


def double(case: Study) -> list[Repair]:
    """As :func:`single` with two edits whose effects add up."""
    if not len(case.effects):
        return []
    pairs = pairs_adding_up(case.effects, case.wanted, TOLERANCES.effect_matches * case.scale)
    return _together(case, [(case.found[one], case.found[two]) for one, two in pairs])


def double_in_term(case: Study) -> list[Repair]:
    """As :func:`double` for two edits in factors of one term: their ratios multiply up to it."""
    root = case.root
    terms = [((k,), a) for k, a in enumerate(root.args)] if root.op == "add" else [((), root)]
    repairs: list[Repair] = []
    for path, term in terms:
        old = np.broadcast_to(tree.evaluate(term, case.at), case.value.shape)
        inside = [
            k
            for k, e in enumerate(case.found)
            if e.path[: len(path)] == path
            and e.kind != "missing term"
            and (len(e.path) > len(path) or e.times is not None)
        ]
        pairs = pairs_in_product(case.effects[inside], case.wanted, old)
        both = [(case.found[inside[one]], case.found[inside[two]]) for one, two in pairs]
        repairs += _together(case, both)
    return _best(repairs)


def _together(case: Study, pairs: list[tuple[Edit, Edit]]) -> list[Repair]:
    """The pairs that really give the values wanted."""
    apart = [(one, two) for one, two in pairs if not _nested(one, two)]
    cheapest = sorted(apart, key=lambda both: both[0].cost + both[1].cost)[:_TRIED]
    made = (_both(case.root, one, two) for one, two in cheapest)
    return _best(repair for repair in made if case.fits(repair.result))


def _best(repairs: Iterable[Repair]) -> list[Repair]:
    return sorted(repairs, key=lambda r: r.cost)[:_CANDIDATES]


def apply(root: Node, edit: Edit) -> Node:
    """The formula after one edit; an edit below the root of kind "missing term" adds it."""
    if edit.kind == "missing term":
        return tree.add(root, edit.new)
    return tree.replaced(root, edit.path, edit.new)


def _nested(one: Edit, two: Edit) -> bool:
    """Whether one edit replaces what the other changes; terms and factors put on do not."""
    if "missing term" in (one.kind, two.kind):
        return False
    outer, inner = sorted((one, two), key=lambda e: (len(e.path), e.times is None))
    return inner.path[: len(outer.path)] == outer.path and outer.times is None


def _both(root: Node, one: Edit, two: Edit) -> Repair:
    """Applies two edits, the inner one first; added terms last, so that places stay."""
    result, added = root, []
    for edit in sorted((one, two), key=lambda e: (-len(e.path), e.times is not None)):
        if edit.kind == "missing term":
            added.append(edit.new)
        else:
            result = _raw_node(result, edit.path, edit)
    cost = one.cost + two.cost
    if {one.kind, two.kind} == {"extra term", "missing term"}:
        cost += _EXCHANGED  # any two slips in one term can be told so
    return Repair((one, two), tree.add(tidy(result), *added), cost)


def _raw_node(root: Node, path: Path, edit: Edit) -> Node:
    """Puts the new node in without tidying, so that other paths stay valid."""
    if not path:
        return edit.new if edit.times is None else Node("mul", (edit.times, root))
    args = list(root.args)
    args[path[0]] = _raw_node(args[path[0]], path[1:], edit)
    return Node(root.op, tuple(args), root.value)


def tidy(node: Node) -> Node:
    """The tree rebuilt from its leaves: ones and zeros go."""
    return tree.rebuilt(node, [tidy(a) for a in node.args]) if node.args else node


class Climber:
    """The values of a formula's nodes, and what the root becomes when one of them changes."""

    def __init__(self, root: Node, at: dict[str, Array]) -> None:
        self.root = root
        self.count = len(next(iter(at.values())))
        self.values = {
            path: np.broadcast_to(tree.evaluate(node, at), (self.count,))
            for path, node in tree.nodes(root)
        }
        self.nodes = dict(tree.nodes(root))
        self.others: dict[tuple[int, ...], Array] = {}

    @property
    def value(self) -> Array:
        """The root's values."""
        return self.values[()]

    def climb(self, path: tuple[int, ...], new: Array) -> Array:
        """The root's values where the node at ``path`` has the values ``new``."""
        while path:
            above = path[:-1]
            parent = self.nodes[above]
            if parent.op == "add":
                new = self.values[above] - self.values[path] + new
            elif parent.op == "mul":
                new = self._others(path) * new
            else:
                values = [self.values[(*above, k)] for k in range(len(parent.args))]
                values[path[-1]] = new
                new = tree.combine(parent, values)
            path = above
        return np.broadcast_to(new, (self.count,))

    def _others(self, path: tuple[int, ...]) -> Array:
        if path not in self.others:
            above = path[:-1]
            count = len(self.nodes[above].args)
            rest = [self.values[(*above, k)] for k in range(count) if k != path[-1]]
            self.others[path] = np.prod(rest, axis=0) if rest else np.ones(self.count)
        return self.others[path]
