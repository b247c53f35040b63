"""Finds the one or two edits that turn one formula into another, by their effect on values.

Each edit's effect is computed at random points by climbing from the changed place to the root.
One slip: an effect equal to what is missing. Two slips in different terms: two effects that add
up to it, found by sorting one projection of them (no pair is tried in vain). Two slips in one
product multiply instead, so near misses of the first kind are followed one step deeper.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from kinlab.arrays import Array
from kinlab.doctor import tree
from kinlab.doctor.edits import Edit, Names, edits
from kinlab.doctor.tree import Node

MATCH = 1e-9
_CANDIDATES = 12
_DENSE = 50
"""Edits with equal effects that are tried as partners of one edit."""


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


def single(
    root: Node, target: Array, at: dict[str, Array], names: Names, extra: list[Node]
) -> list[Repair]:
    """All single edits of ``root`` that give ``target``, the simplest first.

    Args:
        root: the formula.
        target: the values wanted at the points.
        at: values of every name at the points.
        names: what may be written.
        extra: whole terms that may be missing.
    """
    found, effects, wanted, scale = _effects(root, target, at, names, extra)
    good = np.flatnonzero(np.max(np.abs(effects - wanted), axis=1, initial=0.0) <= MATCH * scale)
    repairs = [Repair((found[k],), apply(root, found[k]), found[k].cost) for k in good]
    return sorted(repairs, key=lambda r: r.cost)[:_CANDIDATES]


def double(
    root: Node, target: Array, at: dict[str, Array], names: Names, extra: list[Node]
) -> list[Repair]:
    """As :func:`single` with two edits whose effects add up."""
    found, effects, wanted, scale = _effects(root, target, at, names, extra)
    if not len(effects):
        return []
    repairs: list[Repair] = []
    for one, two in _pairs(effects, wanted, MATCH * scale):
        if _nested(found[one], found[two]):
            continue
        repair = _both(root, found[one], found[two])
        if np.max(np.abs(tree.evaluate(repair.result, at) - target)) <= MATCH * scale:
            repairs.append(repair)
    return sorted(repairs, key=lambda r: r.cost)[:_CANDIDATES]


def double_in_term(root: Node, target: Array, at: dict[str, Array], names: Names) -> list[Repair]:
    """As :func:`double` for two edits in factors of one term: their ratios multiply up to it."""
    found, effects, wanted, scale = _effects(root, target, at, names, [])
    value = tree.evaluate(root, at)
    terms = [((k,), a) for k, a in enumerate(root.args)] if root.op == "add" else [((), root)]
    repairs: list[Repair] = []
    for path, term in terms:
        if term.op != "mul":
            continue
        old = np.broadcast_to(tree.evaluate(term, at), value.shape)
        with np.errstate(divide="ignore", invalid="ignore"):
            goal = np.log(np.abs(1 + wanted / old))
            inside = [k for k, e in enumerate(found) if e.path[: len(path)] == path]
            inside = [k for k in inside if len(found[k].path) > len(path)]
            logs = np.log(np.abs(1 + effects[inside] / old))
        usable = np.isfinite(logs).all(axis=1)
        chosen = [inside[k] for k in np.flatnonzero(usable)]
        if not chosen or not np.isfinite(goal).all():
            continue
        for one, two in _pairs(logs[usable], goal, 1e-8):
            first, second = found[chosen[one]], found[chosen[two]]
            if _nested(first, second):
                continue
            repair = _both(root, first, second)
            if np.max(np.abs(tree.evaluate(repair.result, at) - target)) <= MATCH * scale:
                repairs.append(repair)
    return sorted(repairs, key=lambda r: r.cost)[:_CANDIDATES]


def _pairs(rows: Array, goal: Array, allowance: float) -> list[tuple[int, int]]:
    """Pairs of rows that add up to the goal, by sorting one projection."""
    weights = np.random.default_rng(5).uniform(0.5, 1.5, rows.shape[1])
    line = rows @ weights
    order = np.argsort(line)
    line = line[order]
    wide = allowance * rows.shape[1]
    low = np.searchsorted(line, goal @ weights - line - wide)
    high = np.searchsorted(line, goal @ weights - line + wide)
    pairs = []
    for i in np.flatnonzero(high > low):
        for j in range(low[i], min(high[i], low[i] + _DENSE)):
            one, two = int(order[i]), int(order[j])
            if one < two and np.max(np.abs(rows[one] + rows[two] - goal)) <= allowance:
                pairs.append((one, two))
    return pairs


def apply(root: Node, edit: Edit) -> Node:
    """The formula after one edit; an edit below the root of kind "missing term" adds it."""
    if edit.kind == "missing term":
        return tree.add(root, edit.new)
    return tree.replaced(root, edit.path, edit.new)


def _nested(one: Edit, two: Edit) -> bool:
    """Whether one edit replaces what the other changes; an added term is beside everything."""
    if "missing term" in (one.kind, two.kind):
        return False
    short, long = sorted((one.path, two.path), key=len)
    return long[: len(short)] == short


def _both(root: Node, one: Edit, two: Edit) -> Repair:
    """Applies two edits; added terms last, so that the other's place stays."""
    result, added = root, []
    for edit in (one, two):
        if edit.kind == "missing term":
            added.append(edit.new)
        else:
            result = _raw_node(result, edit)
    return Repair((one, two), tree.add(tidy(result), *added), one.cost + two.cost)


def _raw_node(root: Node, edit: Edit) -> Node:
    """Puts the new node in without tidying, so that other paths stay valid."""
    if not edit.path:
        return edit.new
    args = list(root.args)
    below = Edit(edit.path[1:], edit.new, edit.kind, edit.cost)
    args[edit.path[0]] = _raw_node(args[edit.path[0]], below)
    return Node(root.op, tuple(args), root.value)


def tidy(node: Node) -> Node:
    """The tree rebuilt from its leaves: ones and zeros go."""
    return tree.rebuilt(node, [tidy(a) for a in node.args]) if node.args else node


def _effects(
    root: Node, target: Array, at: dict[str, Array], names: Names, extra: list[Node]
) -> tuple[list[Edit], Array, Array, float]:
    climber = Climber(root, at)
    wanted = target - climber.value
    scale = (
        float(np.max(np.abs(target), initial=0.0)) or float(np.max(np.abs(climber.value))) or 1.0
    )
    found: list[Edit] = []
    rows: list[Array] = []
    memory: dict[Node, Array] = {}
    for edit in edits(root, names):
        if edit.new not in memory:
            memory[edit.new] = tree.evaluate(edit.new, at)
        effect = climber.climb(edit.path, memory[edit.new]) - climber.value
        if np.isfinite(effect).all() and np.any(effect):
            found.append(edit)
            rows.append(effect)
    for term in extra:
        for sign in (1, -1):
            node = tree.mul(tree.num(sign), term)
            found.append(Edit((), node, "missing term", 1.1 if sign > 0 else 1.9))
            rows.append(np.broadcast_to(tree.evaluate(node, at), wanted.shape))
    effects = np.array(rows) if rows else np.zeros((0, len(wanted)))
    return found, effects, wanted, scale


class Climber:
    """The values of a formula's nodes, and what the root becomes when one of them changes."""

    def __init__(self, root: Node, at: dict[str, Array]) -> None:
        self.root = root
        self.count = len(next(iter(at.values())))
        self.values = {path: np.broadcast_to(tree.evaluate(node, at), (self.count,))
                       for path, node in tree.nodes(root)}  # fmt: skip
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
