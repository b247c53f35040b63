"""An answer that is a number with its unit: ``about 1.15 m``, ``0.023 kN m``, ``90°``.

The unit of the answer is found by measuring: with every length twice as long, every mass twice as
heavy and every second twice as long the model's answer is some power of two as large.
"""

from __future__ import annotations

import re
from functools import lru_cache

import numpy as np

from kinlab.doctor.linkages.named_numbers import named_numbers
from kinlab.doctor.marking.sheet import Question, Sheet
from kinlab.errors import ExpressionError, KinlabError
from kinlab.formulas import tree
from kinlab.formulas.files import formula_file
from kinlab.formulas.handed.units import Size, measured, size_of_name
from kinlab.formulas.text import canonical
from kinlab.host.language import _
from kinlab.tolerances import TOLERANCES

_WORD = re.compile(r"[A-Za-z]\w*")
_TYPESET = re.compile(r"\$|\\[,;: ]|~|\\(?:mathrm|text|textrm|rm|si|unit)(?![A-Za-z])|[{}\[\]()]")
_MEASURED = re.compile(
    r"\s*(?P<left>[\\A-Za-z][^=]{0,24}=\s*)?(?:about|approx(?:imately|\.)?|roughly|circa|ca\.?|etwa"
    r"|rund|≈|~|约|大约)?\s*(?P<number>[-+]?\d+(?:[.,]\d+)?(?:[eE][-+]?\d+)?|(?:pi|π)(?:\s?/\s?\d+)?)"
    r"\s*(?P<unit>[^\d\s=+,;](?:[^\d=+,;]|(?<=[\^*A-Za-z-])\d){0,24}?)?\s*"
    r"(?:,?\s*(?:rounded|approx\.?|gerundet|约))?\s*[.。]?\s*",
    re.IGNORECASE,
)
_JOINT = re.compile(r"(?:q|th|theta)(d{0,2})\d?")
_HALF = 0.5
_PLAIN = 8
"""Up to which the parts of a fraction are a plain number's."""


def without_unit(text: str, question: Question, sheet: Sheet) -> str:
    """A bare number without its unit, in SI units, where no letter of that is a name.

    Args:
        text: an answer as it was typed.
        question: with a model answer.
        sheet: whose robot it is of.

    Raises:
        ExpressionError: a unit that the answer does not have.
    """
    plain = _TYPESET.sub(" ", text) if len(text) <= 100 else ""
    found = _MEASURED.fullmatch(plain)
    if found is None or not found["unit"]:
        return text if found is None else _named(found, question) + _digits(found)
    numbers = named_numbers(sheet.robot)
    known = {*numbers}
    for one in question.answer.values():
        known |= {*_WORD.findall(one)}
    unit = found["unit"].strip()
    if known & {*_WORD.findall(unit)}:
        return text
    size, factor = measured(unit)
    if size is None:
        return text
    asked = _size_of(tuple(question.answer.items()), tuple(sorted(numbers.items())))
    if asked is not None and size != asked:
        said = _("{unit!r} is no unit of what is asked for")
        raise ExpressionError(said.format(unit=unit))
    number = _digits(found) if factor == "1" else f"{_digits(found)}*{factor}"
    return _named(found, question) + number


def _named(found: re.Match[str], question: Question) -> str:
    """What stands left of a number; of an only answer nobody asks what it is called."""
    return found["left"] or "" if len(question.answer) > 1 else ""


def _digits(found: re.Match[str]) -> str:
    return found["number"].replace(",", ".")


@lru_cache(maxsize=256)
def _size_of(
    answer: tuple[tuple[str, str], ...], numbers: tuple[tuple[str, float], ...]
) -> Size | None:
    """The powers of metre, kilogram and second in a model answer; None where it has none."""
    try:
        file = formula_file({"robot": "any", "formulas": dict(answer)}, "answer")
    except KinlabError:
        return None
    words = dict(numbers)
    for formula in file.formulas.values():
        formula = tree.renamed(formula, {name: canonical(name) for name in tree.names(formula)})
        names = tree.names(formula)
        sizes = {name: _of_name(name) for name in names}
        known = all(name in words or _JOINT.fullmatch(name) for name in names)
        plain = all(map(_is_plain, (part for _path, part in tree.nodes(formula))))
        if not names or file.symbols or not known or not plain:
            return None
        return _powers(formula, {name: words.get(name, _HALF) for name in names}, sizes)
    return None


def _is_plain(node: tree.Node) -> bool:
    """Whether it is no number that may have a unit of its own, as the 9.81 of m1*9.81*l1."""
    if node.op != "num":
        return True
    return bool(max(abs(node.value.numerator), node.value.denominator) <= _PLAIN)


def _powers(formula: tree.Node, at: dict[str, float], sizes: dict[str, Size | None]) -> Size | None:
    if any(size is None for size in sizes.values()):
        return None
    found: list[int] = []
    for k in range(3):
        both = {
            name: x * np.array([1.0, 2.0 ** (sizes[name] or (0, 0, 0))[k]])
            for name, x in at.items()
        }
        with np.errstate(all="ignore"):
            before, after = np.broadcast_to(tree.evaluate(formula, both), (2,))
            ratio = float(after / before)
        power = np.log2(ratio) if ratio > 0 else np.nan
        if not np.isfinite(power) or abs(power - round(power)) > TOLERANCES.same_number:
            return None
        found.append(round(power))
    return found[0], found[1], found[2]


def _of_name(name: str) -> Size | None:
    joint = _JOINT.fullmatch(name)
    return (0, 0, -len(joint[1])) if joint else size_of_name(name)
