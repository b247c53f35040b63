"""Conditions of a program otherwise."""

from __future__ import annotations

import ast
from collections.abc import Iterator

from kinlab.doctor.program.edits.single.whole import plus, whole_constant
from kinlab.doctor.program.places import Here, ProgramEdit

_OPPOSITE: dict[type[ast.cmpop], type[ast.cmpop]] = {
    ast.Eq: ast.NotEq,
    ast.NotEq: ast.Eq,
    ast.Lt: ast.GtE,
    ast.GtE: ast.Lt,
    ast.Gt: ast.LtE,
    ast.LtE: ast.Gt,
    ast.In: ast.NotIn,
    ast.NotIn: ast.In,
    ast.Is: ast.IsNot,
    ast.IsNot: ast.Is,
}


_KINDS = (
    ("r", "p"),
    ("revolute", "prismatic"),
    ("rev", "pris"),
    ("rot", "lin"),
    ("rotary", "linear"),
    ("hinge", "slide"),
    ("hinge", "slider"),
)
"""What the two kinds of joints are called."""
_KIND = 1.03
"""Cost of the other kind of joint in a condition."""
_NUMBERED = 1.08
"""Cost of another joint's number in a test for one: ``i == 2`` for ``i == 3``."""


def of_comparison(here: Here) -> Iterator[ProgramEdit]:
    node = here.node
    if len(node.ops) != 1:
        return
    letter = getattr(node.comparators[0], "value", None)
    if isinstance(letter, str):  # the kind of a joint
        for other_kind in _other_kinds(letter):
            kind = [ast.Constant(other_kind)]
            yield here.within(node, "comparators", kind, "condition", _KIND)
        if isinstance(node.ops[0], ast.Eq | ast.NotEq) and not is_switch(node):
            turned = ast.Eq() if isinstance(node.ops[0], ast.NotEq) else ast.NotEq()
            yield here.within(node, "ops", [turned], "condition", _KIND + 0.03)
        return
    if isinstance(here.parent, ast.IfExp) and _is_of_a_number(node):
        yield from of_its_number(here, node)
    pairs = {ast.Lt: ast.LtE, ast.LtE: ast.Lt, ast.Gt: ast.GtE, ast.GtE: ast.Gt}
    other = pairs.get(type(node.ops[0]))
    if other is not None:
        yield here.within(node, "ops", [other()], "condition", 1.15)
    if isinstance(node.ops[0], ast.Eq | ast.NotEq | ast.Lt | ast.Gt):
        opposite = {ast.Eq: ast.NotEq, ast.NotEq: ast.Eq, ast.Lt: ast.Gt, ast.Gt: ast.Lt}
        new = opposite[type(node.ops[0])]()
        yield here.within(node, "ops", [new], "condition", 1.2)
    if isinstance(node.ops[0], ast.Eq | ast.LtE | ast.GtE):
        for new in (ast.Eq(), ast.LtE(), ast.GtE()):
            if type(new) is not type(node.ops[0]):
                yield here.within(node, "ops", [new], "condition", 1.12)


def is_switch(test: ast.expr) -> bool:
    """Whether a condition asks for a setting by its name, ``mode != "static"``, and no kind."""
    if not isinstance(test, ast.Compare):
        return False
    word = getattr(test.comparators[0], "value", None)
    return isinstance(word, str) and len(word) > _SIGNS and not _other_kinds(word)


_SIGNS = 2
"""The longest word that may be the kind of a joint, whatever it is: ``R``, ``PR``."""


def _other_kinds(kind: str) -> list[str]:
    """The other of two kinds of joints, written as one is."""
    pairs = [pair for pair in _KINDS if kind.lower() in pair]
    others = [one for pair in pairs for one in pair if one != kind.lower()]
    if kind.isupper():
        return [one.upper() for one in others]
    return [one.capitalize() if kind[:1].isupper() else one for one in others]


def of_comparisons(here: Here) -> Iterator[ProgramEdit]:
    """All comparisons of a condition otherwise, or ``and`` for ``or``."""
    node = here.node
    other = ast.Or() if isinstance(node.op, ast.And) else ast.And()
    yield here.within(node, "op", other, "condition", 1.15)
    own = [one for one in node.values if isinstance(one, ast.Compare) and len(one.ops) == 1]
    kinds = {type(one.ops[0]) for one in own}
    if len(own) == len(node.values) and len(kinds) == 1:
        for new in (ast.Eq(), ast.LtE(), ast.GtE(), ast.Lt(), ast.Gt()):
            if type(new) not in kinds:
                values = [ast.Compare(one.left, [new], one.comparators) for one in own]
                yield here.within(node, "values", values, "condition", 1.08)


def negated(test: ast.expr) -> ast.expr:
    """The opposite condition."""
    if isinstance(test, ast.Compare) and len(test.ops) == 1 and type(test.ops[0]) in _OPPOSITE:
        return ast.Compare(test.left, [_OPPOSITE[type(test.ops[0])]()], test.comparators)
    return ast.UnaryOp(ast.Not(), test)


def of_its_number(here: Here, test: ast.expr) -> Iterator[ProgramEdit]:
    """What a test compares with, one more and one less: ``i == 2`` for ``i == 3``."""
    if isinstance(test, ast.Compare) and len(test.comparators) == 1:
        cost = _NUMBERED if _is_of_a_number(test) else 1.25
        for step in (1, -1):
            number = [plus(test.comparators[0], step)]
            yield here.within(test, "comparators", number, "condition", cost)


def _is_of_a_number(test: ast.Compare) -> bool:
    """Whether it asks for one whole number."""
    return is_equality(test) and whole_constant(test.comparators[0])


def is_equality(test: ast.Compare) -> bool:
    """Whether it asks whether two are equal, or are not."""
    return isinstance(test.ops[0], ast.Eq | ast.NotEq)
