"""The subscripts of a sum of products otherwise: ``einsum('ijk,k->ij', C, v)``."""

from __future__ import annotations

import ast
from collections import Counter
from collections.abc import Iterator
from itertools import combinations
from typing import Any

from kinlab.doctor.bytecode.syntax import called, nodes
from kinlab.doctor.program.edits.scope.part import Scope
from kinlab.doctor.program.observed import Observed, Shape
from kinlab.doctor.program.places import Here, ProgramEdit

_LETTER, _EXCHANGED, _THROUGHOUT = 1.04, 1.05, 1.0
"""Cost of another letter, of two for one another, of those of one array at all its places."""
_MORE = 1.1
"""Cost of an array that lacks."""
_ARROW, _BETWEEN = "->", ","
_LONGEST = 24
"""Letters and signs of subscripts of which any may be another."""


def of_subscripts(here: Here, observed: Observed, scope: Scope) -> Iterator[ProgramEdit]:
    """One letter another of those in use, two of one array for one another, an array that lacks:
    what the shapes allow.

    What only gives the letters other names is the same sum.
    """
    call, own = here.parent, "".join(here.node.value.split())
    if not isinstance(call, ast.Call) or called(call) != "einsum" or here.field != 0:
        return
    if own.count(_ARROW) != 1 or len(own) > _LONGEST or not _plain(own):
        return
    shapes = [observed.shape(one) for one in call.args[1:]]
    answer = observed.shape(call)
    lone = _lone(own)
    seen = {_renamed(own)}
    every = (*_turned(own, call.args[1:]), *_other_letters(own), *_exchanged(own))
    for new, kind, cost in every:
        if _renamed(new) not in seen and _lone(new) <= lone and _fits(new, shapes, answer):
            seen.add(_renamed(new))
            yield here.within(here.node, "value", new, kind, cost)
    yield from _lacking(own, here, observed, scope)


def _lacking(own: str, here: Here, observed: Observed, scope: Scope) -> Iterator[ProgramEdit]:
    """A stack of the arm's numbers more, one for each of a letter: ``'i,ij->j', m, J``."""
    call: Any = here.parent
    sizes: dict[str, int] = {}
    for group, one in zip(own.partition(_ARROW)[0].split(_BETWEEN), call.args[1:], strict=False):
        sizes.update(zip(group, observed.shape(one) or (), strict=False))
    used = {one.id for one in nodes(call) if isinstance(one, ast.Name)}
    for letter, size in sizes.items():
        for name, stack in scope.simple((size,)):
            if name not in used:
                given = [ast.Constant(f"{letter}{_BETWEEN}{own}"), stack, *call.args[1:]]
                yield here.within(call, "args", given, "missing factor", _MORE)


def _plain(text: str) -> bool:
    """Whether there are letters alone in it, each of a result once."""
    result = text.partition(_ARROW)[2]
    rest = text.replace(_ARROW, "").replace(_BETWEEN, "")
    return rest.isalpha() and len({*result}) == len(result)


def _other_letters(text: str) -> Iterator[tuple[str, str, float]]:
    known = sorted({one for one in text if one.isalpha()})
    for k, letter in enumerate(text):
        for other in known if letter.isalpha() else ():
            if other != letter:
                yield text[:k] + other + text[k + 1 :], "index", _LETTER


def _exchanged(text: str) -> Iterator[tuple[str, str, float]]:
    """Two letters of one array, or of the result, for one another."""
    for i, j in combinations(range(len(text)), 2):
        between = text[i : j + 1]
        if between.isalpha() and text[i] != text[j]:
            yield (
                text[:i] + text[j] + between[1:-1] + text[i] + text[j + 1 :],
                "transposed",
                _EXCHANGED,
            )


def _turned(text: str, given: list[ast.expr]) -> Iterator[tuple[str, str, float]]:
    """An array that stands at several places transposed at each: ``R.T @ I @ R``."""
    groups, _arrow, result = text.partition(_ARROW)
    arrays = [ast.dump(one) for one in given]
    for name, count in Counter(arrays).items():
        if count > 1 and len(arrays) == groups.count(_BETWEEN) + 1:
            new = [
                group[:-2] + group[:-3:-1] if array == name and len(group) > 1 else group
                for group, array in zip(groups.split(_BETWEEN), arrays, strict=True)
            ]
            yield _BETWEEN.join(new) + _ARROW + result, "transposed", _THROUGHOUT


def _lone(text: str) -> set[str]:
    """The letters that stand once: nothing but a sum over one axis."""
    return {one for one, count in Counter(text).items() if count == 1 and one.isalpha()}


def _renamed(text: str) -> str:
    """The subscripts with the letters in alphabetical order as they come."""
    found: dict[str, str] = {}
    for one in text:
        if one.isalpha():
            found.setdefault(one, chr(ord("a") + len(found)))
    return "".join(found.get(one, one) for one in text)


def _fits(text: str, shapes: list[Shape | None], answer: Shape | None) -> bool:
    """Whether arrays of these shapes may have these subscripts, and the answer is as long."""
    given, _arrow, result = text.partition(_ARROW)
    groups = given.split(_BETWEEN)
    if len({*result}) < len(result) or not {*result} <= {*given} or len(groups) != len(shapes):
        return False
    sizes: dict[str, int] = {}
    for group, shape in zip((*groups, result), (*shapes, answer), strict=True):
        if shape is not None and len(shape) != len(group):
            return False
        for letter, size in zip(group, shape or (), strict=False):
            if sizes.setdefault(letter, size) != size:
                return False
    return True
