"""The difference of a function from the derived formula as a short sum of known terms.

The terms are products of joint functions (sines and cosines of angle sums, velocities,
accelerations), each in one canonical order and each distinct function once. A difference that is
a sum of them has one set of coefficients, found by least squares and kept only if it explains
every state.
"""

from __future__ import annotations

from dataclasses import dataclass
from fractions import Fraction
from itertools import combinations_with_replacement

import numpy as np

from kinlab.arrays import Array, first_largest, largest_first
from kinlab.doctor.text.line import Names
from kinlab.formulas import tree
from kinlab.formulas.tree import Node
from kinlab.tolerances import TOLERANCES

_SHORT = 6
"""More terms than this are no explanation."""


@dataclass(frozen=True)
class Term:
    """One term of a difference: coefficient times joint functions."""

    coefficient: float
    product: Node


def dictionaries(derived: list[Node], names: Names) -> list[list[Node]]:
    """Joint functions that may stand in a formula like the derived ones, in widening circles.

    Args:
        derived: the derived entries, as sums of terms.
        names: what may be written.

    Returns:
        Their own joint functions; their waves with every product of speeds; all waves. Each
        product once, its factors in the order of :func:`kinlab.formulas.tree.ordered`.
    """
    own = [_joint_part(term, names) for entry in derived for term in entry.terms]
    met = [wave for part in own for wave in _waves(part)]
    anything = [tree.call(f, angle) for angle in names.angles for f in ("cos", "sin")]
    speeds: list[Node] = [tree.num(1)]
    moving = [tree.sym(f"qd{i + 1}") for i in range(names.n)] if "qd" in names.letters else []
    speeds += moving
    speeds += [_product(a, b) for a, b in combinations_with_replacement(moving, 2)]
    if "qdd" in names.letters:
        turning = [tree.sym(f"qdd{i + 1}") for i in range(names.n)]
        speeds += turning
        speeds += [_product(a, b) for a, b in combinations_with_replacement(turning, 2)]
    circles = [own]
    for waves in ([tree.num(1), *met], [tree.num(1), *met, *anything]):
        circles.append([*circles[-1], *(tree.mul(s, w) for s in speeds for w in waves)])
    return [list(dict.fromkeys(map(tree.ordered, circle))) for circle in circles]


def joint_functions(derived: list[Node], names: Names) -> list[Node]:
    """The joint functions of derived entries, each once."""
    parts = (_joint_part(term, names) for entry in derived for term in entry.terms)
    return list(dict.fromkeys(tree.ordered(part) for part in parts))


def explain(difference: Array, words: list[Node], at: dict[str, Array]) -> list[Term]:
    """The few terms that add up to the difference at every state, or none.

    Args:
        difference: hand minus engine, (N,).
        words: the dictionary.
        at: values of the names, (N,) each.

    Returns:
        The terms, the largest first, equal ones in the dictionary's order; empty where no short
        exact sum was found.
    """
    columns = np.array([np.broadcast_to(tree.evaluate(w, at), difference.shape) for w in words]).T
    size = np.linalg.norm(columns, axis=0)
    usable = np.isfinite(size) & (size > 0)
    one = _distinct(columns[:, usable] / size[usable])
    kept = [np.flatnonzero(usable)[k] for k in one]
    columns, size = columns[:, kept], size[kept]
    scale = float(np.max(np.abs(difference))) or 1.0
    chosen = _few(columns / size, difference, scale)
    if chosen is None:
        return []
    factors, *_ = np.linalg.lstsq(columns[:, chosen], difference, rcond=None)
    order = sorted(range(len(chosen)), key=lambda k: chosen[k])
    terms = [Term(float(factors[k]), words[kept[chosen[k]]]) for k in order]
    return [terms[k] for k in largest_first([abs(t.coefficient) for t in terms])]


def _distinct(columns: Array) -> list[int]:
    """The columns of unit length that are not plus or minus one before them."""
    if not columns.shape[1]:
        return []
    alike = np.triu(1.0 - np.abs(columns.T @ columns) < TOLERANCES.same_function, 1)
    return [int(k) for k in np.flatnonzero(~alike.any(axis=0))]


def _few(columns: Array, difference: Array, scale: float) -> list[int] | None:
    """The columns that are needed: all at once where the states allow, else one at a time."""
    if 5 * columns.shape[1] <= 4 * len(difference):
        chosen = _needed(columns, list(range(columns.shape[1])), difference, scale)
        return chosen if chosen is not None and len(chosen) <= _SHORT else None
    chosen = []
    rest = difference
    for _ in range(_SHORT + 2):
        chosen.append(first_largest(np.abs(columns.T @ rest)))
        factors, *_ = np.linalg.lstsq(columns[:, chosen], difference, rcond=None)
        rest = difference - columns[:, chosen] @ factors
        found = _needed(columns, chosen, difference, scale)
        if found is not None:
            return found if len(found) <= _SHORT else None
    return None


def _needed(columns: Array, chosen: list[int], difference: Array, scale: float) -> list[int] | None:
    """The chosen columns with a share in the difference, if together they are all of it."""
    factors, *_ = np.linalg.lstsq(columns[:, chosen], difference, rcond=None)
    rest = np.max(np.abs(columns[:, chosen] @ factors - difference))
    if rest > TOLERANCES.no_share * 0.1 * scale:
        return None
    share = np.abs(factors) > TOLERANCES.no_share * np.max(np.abs(factors))
    return [k for k, s in zip(chosen, share, strict=True) if s]


def _joint_part(term: Node, names: Names) -> Node:
    parameters = set(names.parameters)
    moving = (f for f in term.factors if f.op != "num" and not tree.names(f) <= parameters)
    return tree.mul(tree.num(1), *moving)


def _waves(part: Node) -> list[Node]:
    waves = [f for f in part.factors if any(name[:2] != "qd" for name in tree.names(f))]
    return [tree.mul(*waves)] if waves else []


def _product(a: Node, b: Node) -> Node:
    return tree.power(a, Fraction(2)) if a == b else tree.mul(a, b)
