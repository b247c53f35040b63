"""Every slip of the pen at one place of a formula: sign, factor, power, index, function, ...

:func:`edits` lists what could stand in a place instead. Each kind of slip is undone by a kind in
the list, so the same list serves both ways: a user's text is edited until it is the engine's, and
the engine's formula is edited until it is the user's function.
"""

from __future__ import annotations

import re
from collections.abc import Iterator
from dataclasses import dataclass
from fractions import Fraction
from itertools import combinations

from kinlab.formulas import tree
from kinlab.formulas.tree import Node, Path

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


@dataclass(frozen=True)
class Names:
    """The names that may stand in a formula.

    Attributes:
        parameters: l1, m1, g, ...
        n: number of joints.
        letters: which of q, qd, qdd the quantity depends on.
    """

    parameters: tuple[str, ...]
    n: int
    letters: tuple[str, ...]

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
