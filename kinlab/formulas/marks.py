"""Where a formula and its corrected form differ, for the eye."""

from __future__ import annotations

from collections.abc import Mapping

from kinlab.formulas import tree
from kinlab.formulas.tree import Node, Path


def differences(
    hand: Node, right: Node, meaning: Mapping[str, Node]
) -> tuple[frozenset[Path], frozenset[Path]]:
    """Where two trees differ, for the eye: paths in the first and in the second.

    Args:
        hand: as the user wrote it.
        right: the corrected form.
        meaning: what the user's names stand for.

    Returns:
        Both empty where they differ so much that marks would only confuse.
    """
    left: set[Path] = set()
    found: set[Path] = set()
    _compare(hand, right, (), (), meaning, (left, found))
    if () in left or () in found:
        return frozenset(), frozenset()
    return frozenset(left), frozenset(found)


def _compare(
    hand: Node,
    right: Node,
    at: Path,
    other: Path,
    meaning: Mapping[str, Node],
    marks: tuple[set[Path], set[Path]],
) -> None:
    if tree.renamed(hand, meaning) == right:
        return
    if hand.op != right.op or hand.value != right.value or not hand.args:
        marks[0].add(at)
        marks[1].add(other)
        return
    ours, theirs = _unpaired(hand, right, meaning)
    if hand.op == "mul" and (not ours or not theirs or _sign(hand) != _sign(right)):
        whole = _sign(hand) != _sign(right)  # the sign of a term is no factor to point at
        marks[0].update([(*at, k) for k in ours if not whole] or [at])
        marks[1].update([(*other, k) for k in theirs if not whole] or [other])
        return
    for k in ours:
        mate = _mate(hand.args[k], [right.args[m] for m in theirs], meaning)
        if mate is None:
            marks[0].add((*at, k))
            continue
        m = theirs.pop(mate)
        _compare(hand.args[k], right.args[m], (*at, k), (*other, m), meaning, marks)
    marks[1].update((*other, m) for m in theirs)


def _unpaired(hand: Node, right: Node, meaning: Mapping[str, Node]) -> tuple[list[int], list[int]]:
    """Children without an equal on the other side."""
    ours, theirs = [], list(range(len(right.args)))
    for k, child in enumerate(hand.args):
        plain = tree.renamed(child, meaning)
        same = next((m for m in theirs if right.args[m] == plain), None)
        if same is None:
            ours.append(k)
        else:
            theirs.remove(same)
    return ours, theirs


def _sign(node: Node) -> bool:
    return any(a.op == "num" and a.value < 0 for a in node.args)


def _mate(node: Node, rest: list[Node], meaning: Mapping[str, Node]) -> int | None:
    """Which of the others has most leaves in common with a child, at least half."""
    mine = _leaves(tree.renamed(node, meaning))
    best, place = 0.5, None
    for m, other in enumerate(rest):
        theirs = _leaves(other)
        share = len(mine & theirs) / len(mine | theirs) if mine | theirs else 1.0
        if share >= best:
            best, place = share + 1e-9, m
    return 0 if place is None and len(rest) == 1 and not node.args else place


def _leaves(node: Node) -> set[str]:
    return {str(one.value) for _, one in tree.nodes(node) if one.op in ("sym", "num")}
