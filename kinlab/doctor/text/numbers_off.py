"""Several numbers of a text that are off, beside others that are only rounded.

Where the numbers of a text can be told apart by its values, they are solved for together: those
that are what was written, rounded, stay as they are; the others are put right.
"""

from __future__ import annotations

import re
from collections.abc import Mapping, Sequence
from dataclasses import replace

import numpy as np

from kinlab.arrays import Array
from kinlab.doctor.text.line import Change, Line
from kinlab.doctor.text.meanings import Meanings, coefficients, stands_for
from kinlab.doctor.text.mend import Mended, mended, together
from kinlab.doctor.text.stand_ins import FREE, fitted, stand_ins, told_apart
from kinlab.doctor.text.written import Literal, Written
from kinlab.formulas import tree
from kinlab.formulas.text import parse
from kinlab.formulas.tree import Node
from kinlab.host.language import N_
from kinlab.tolerances import TOLERANCES

_MOST = 3
"""Numbers that are off above which a list of them is no diagnosis."""
_LIKE = 3.0
"""Times that a number may be off and still be the same number mistaken."""


_EXACT = re.compile(r"\bexact_\d+_\d+\b")

Part = tuple[Mapping[str, Array], Array]
"""States at which a formula is one of its parts alone, and the values wanted there."""


def beside_rounded(line: Line, parts: Sequence[Part]) -> tuple[Written, list[Mended]]:
    """Numbers that are off, or slips, beside numbers that are right when rounded.

    Args:
        line: the formula at the robot's own numbers.
        parts: its parts, where it has several.

    Returns:
        The text with exact values for the rounded numbers, and its repairs.
    """
    text, found = _put_right(line)
    if found:
        return text, found
    text = _with_right_parts(line.text, parts)
    return text, [] if text is line.text else mended(_again(line, text), 2)


def as_meant(text: Written, right: Node, own: Mapping[str, Array]) -> Written:
    """The text with every number that is a number of the derived formula, rounded, as that.

    A slip beside it is then one slip. A coefficient comes before a product within one, and a
    number that could be two of them stays as it is written.

    Args:
        text: the formula.
        right: the derived one, as a sum of terms.
        own: values of the names, the robot's own.
    """
    meanings = Meanings.at(own)
    meant: dict[int, str] = {}
    circles = [[_positive(one, own) for one in circle] for circle in coefficients(right)]
    for k, (one, _span) in enumerate(zip(text.literals, text.spans, strict=False)):
        if one.half and meanings.parameter(one.value) is None:
            found = _meant(one, circles, meanings)
            if found is not None:
                plain = tree.names(found[0]).isdisjoint(text.symbols)
                meant[k] = tree.to_text(found[0]) if plain else repr(found[1])
    return _with_exact(text, meant) if meant else text


def _meant(
    one: Literal, circles: list[list[tuple[Node, float]]], meanings: Meanings
) -> tuple[Node, float] | None:
    """What a number is rounded from; None where it is exact, or may be two."""
    near, reach = TOLERANCES.same_relation * one.value, one.reach * (1 + TOLERANCES.same_relation)
    if any(abs(size - one.value) <= near for circle in circles for _node, size in circle):
        return None
    for circle in circles:
        close = [pair for pair in circle if abs(pair[1] - one.value) <= reach]
        found = [pair for pair in close if meanings.credible(one, pair[1])]
        if found:
            node, size = found[0]
            sure = all(abs(other - size) <= near for _node, other in found)
            return (node, size) if sure else None
    return None


def _positive(node: Node, own: Mapping[str, Array]) -> tuple[Node, float]:
    """A product of the robot's numbers without its sign, and its value."""
    value = float(np.ravel(tree.evaluate(node, dict(own)))[0])
    return (tree.mul(tree.num(-1), node), -value) if value < 0 else (node, value)


def _again(line: Line, text: Written) -> Line:
    return replace(line, text=text, places=[], changes=[], rows=[])


def _put_right(line: Line) -> tuple[Written, list[Mended]]:
    """The numbers that are off, each as it should be; empty where they are not sure."""
    text, meanings = line.text, line.meanings
    free = [
        k
        for k, (one, _span) in enumerate(zip(text.literals, text.spans, strict=False))
        if one.half and not one.whole and meanings.parameter(one.value) is None
    ]
    solved = fitted(text, line.at, line.target, free) if 1 < len(free) <= FREE else None
    if solved is None or not told_apart(text, line.at, solved, free):
        return text, []
    exact = {
        k: float(solved[k]) for k in free if meanings.credible(text.literals[k], float(solved[k]))
    }
    off = [k for k in free if k not in exact]
    written = [text.literals[k].value for k in off]
    ratio = solved[off] / written
    if not 1 <= len(off) <= _MOST or np.any(ratio < 1 / _LIKE) or np.any(ratio > _LIKE):
        return text, []
    named = _with_exact(text, {k: repr(value) for k, value in exact.items()})
    changes = []
    for one, value in zip(off, solved[off], strict=True):
        start, end = named.spans[one - sum(k < one for k in exact)]
        shown = np.format_float_positional(float(value), 12, fractional=False, trim="-")
        pieces = {"old": text.literals[one].text, "new": shown}
        told = N_("{old} should be {new}")
        changes.append(Change(start, end, shown, "coefficient", 1.15, told, pieces=pieces))
    return named, together(_again(line, named), tuple(changes))


def _with_exact(text: Written, exact: Mapping[int, str]) -> Written:
    """The text with names for numbers that are rounded: written as they were, and exact in value.

    What they stand for is given by their place among the literals, as digits or as a formula.
    """
    line, symbols, numbers = text.text, dict(text.symbols), dict(text.numbers)
    for k in sorted(exact, reverse=True):
        (start, end), name = text.spans[k], f"exact_{k}_{len(numbers)}"
        symbols[name], numbers[name] = exact[k], line[start:end]
        line = line[:start] + name + line[end:]
    return replace(text, text=line, symbols=symbols, numbers=numbers)


def rounded_in(text: Written, at: Mapping[str, Array]) -> list[str]:
    """What the numbers stand for that are exact by a name and shown as written, in words."""
    meanings, said = Meanings.at(at), []
    for name in dict.fromkeys(_EXACT.findall(text.text)):
        meant = parse(text.symbols[name])
        value = float(np.ravel(tree.evaluate(meant, dict(at)))[0])
        if abs(value - float(text.numbers[name])) > TOLERANCES.formula_agrees * abs(value):
            letters = bool(tree.names(meant))
            shown = f"{text.symbols[name]} = {value:.7g}" if letters else meanings.named(value)
            said.append(stands_for(text.numbers[name], shown))
    return list(dict.fromkeys(said))


def _with_right_parts(text: Written, parts: Sequence[Part]) -> Written:
    """The text with the numbers of those parts exact that are right when rounded."""
    exact: dict[int, str] = {}
    for at, target in parts:
        scale = np.full_like(target, np.max(np.abs(target)))
        meant = stand_ins(text, at, target, scale)
        for k, (one, _span) in enumerate(zip(text.literals, text.spans, strict=False)):
            if meant is not None and meant.numbers[k] != one.value:
                exact[k] = repr(float(meant.numbers[k]))
    return _with_exact(text, exact) if exact else text
