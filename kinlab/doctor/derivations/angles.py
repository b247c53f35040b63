"""What one can do otherwise where an angle is found: atan2, acos, roots, quotients, exchanges.

The arguments of atan2 exchanged, or atan of their quotient, which loses the quadrant; the
supplementary angle; the root forgotten; ``a/2*l1*l2`` for ``a/(2*l1*l2)``; l1 and l2 exchanged.
"""

from __future__ import annotations

import ast
import re
from collections.abc import Iterator, Sequence

from kinlab.doctor.bytecode.syntax import factors, nodes
from kinlab.doctor.derivations.operations import Make
from kinlab.doctor.derivations.walk import Assignment, Program, Step, again
from kinlab.doctor.derivations.words import is_sum, minus, name_of, spelt, times
from kinlab.host.language import _

_EXCHANGED = (
    ("l1", "l2"),
    ("l2", "l3"),
    ("x", "y"),
    ("px", "py"),
    ("s2", "c2"),
    ("s3", "c3"),
    ("later", "earlier"),
    ("late", "early"),
)
"""Names that are taken for each other, both at once."""


def at_angle(node: ast.Call, step: Make) -> Iterator[Step]:
    """At a call that gives an angle, or a root."""
    assert isinstance(node.func, ast.Name)
    name, x = node.func.id, node.args
    if name == "arctan2":
        turned = ast.Call(node.func, [x[1], x[0]], [])
        does = _("has {new} for {old} (the arguments exchanged)")
        yield step(
            "arguments exchanged",
            does.format(new=spelt(turned), old=spelt(node)),
            1.0,
            (node, turned),
        )
        plain = ast.Call(ast.Name("arctan"), [ast.BinOp(x[0], ast.Div(), x[1])], [])
        does = _("has {new} for {old} (the quadrant is lost)")
        yield step("quadrant", does.format(new=spelt(plain), old=spelt(node)), 1.0, (node, plain))
        for part in x:
            other = [minus(y) if y is part else y for y in x]
            does = _("has {new} for {old} (the sign)")
            new = ast.Call(node.func, other, [])
            yield step("sign", does.format(new=spelt(new), old=spelt(node)), 1.06, (node, new))
        if name_of(x[0])[:1] == "s" and name_of(x[1])[:1] == "c":
            for inverse, part in (("arcsin", x[0]), ("arccos", x[1])):
                alone = ast.Call(ast.Name(inverse), [part], [])
                does = _("has {new} for {old} (the quadrant is lost)")
                does = does.format(new=spelt(alone), old=spelt(node))
                cost = 1.0 if inverse == "arcsin" else 1.03
                yield step("quadrant", does, cost, (node, alone))
    elif name == "arccos":
        turned = ast.Call(node.func, [minus(x[0])], [])
        does = _("has the supplementary angle {new} for {old}")
        yield step(
            "supplementary angle",
            does.format(new=spelt(turned), old=spelt(node)),
            1.03,
            (node, turned),
        )
        wave = ast.Call(ast.Name("arcsin"), x, [])
        does = _("has {new} for {old} (sin/cos)")
        yield step("sin/cos", does.format(new=spelt(wave), old=spelt(node)), 1.05, (node, wave))
    elif name == "sqrt":
        does = _("leaves the root out: {new} for {old}")
        yield step("root", does.format(new=spelt(x[0]), old=spelt(node)), 1.05, (node, x[0]))


def at_difference(node: ast.BinOp, step: Make) -> Iterator[Step]:
    """``beta`` for ``pi - beta``; ``a/b*c`` for ``a/(b*c)``."""
    if isinstance(node.op, ast.Sub) and name_of(node.left) == "pi":
        does = _("has the supplementary angle {new} for {old}")
        does = does.format(new=spelt(node.right), old=spelt(node))
        yield step("supplementary angle", does, 0.99, (node, node.right))
    if (
        isinstance(node.op, ast.Div)
        and isinstance(node.right, ast.BinOp)
        and not is_sum(node.right)
    ):
        new: ast.expr = node.left
        below = factors(node.right)
        for k, factor in enumerate(below):
            new = ast.BinOp(new, ast.Mult() if k else ast.Div(), factor)
        if len(below) > 1:
            does = _("has {new} for {old} (parentheses)")
            yield step(
                "parentheses", does.format(new=spelt(new), old=spelt(node)), 1.05, (node, new)
            )


def exchanged(of: Program) -> Iterator[Step]:
    """Two names each for the other, in one sum, in one line and in every line."""
    named = [
        (line, [node for node in nodes(line.statement.value) if isinstance(node, ast.Name)])
        for line in of.lines
        if line.about
    ]
    for one, two in _EXCHANGED:
        names = [spelt(ast.Name(x)) for x in (one, two)]
        every: list[tuple[ast.expr, ast.expr]] = []
        for line, inside in named:
            found = [node for node in inside if node.id in (one, two)]
            edits = [(x, again(ast.Name(two if x.id == one else one))) for x in found]
            every += edits
            if len({x.id for x in found}) == 2:
                does = _("has {one} and {two} exchanged in {line}")
                said = does.format(one=names[0], two=names[1], line=_(line.about))
                yield Step("exchanged", said, tuple(edits), 1.02, about=line.about)
                yield from _in_a_sum(line, edits, names)
        if len({x.id for x, _new in every if isinstance(x, ast.Name)}) == 2:
            does = _("has {one} and {two} exchanged in every line")
            yield Step("exchanged", does.format(one=names[0], two=names[1]), tuple(every), 1.03)


def _in_a_sum(
    line: Assignment, edits: Sequence[tuple[ast.Name, ast.expr]], names: Sequence[str]
) -> Iterator[Step]:
    """The same where the line has them elsewhere as well: ``l2 + l1*c2`` beside ``l2*s2``."""
    for whole in nodes(line.statement.value):
        if not isinstance(whole, ast.expr) or not is_sum(whole):
            continue
        inside = {id(node) for node in nodes(whole)}
        some = [pair for pair in edits if id(pair[0]) in inside]
        if len(some) == len({x.id for x, _new in some}) == 2 < len(edits):
            does = _("has {one} and {two} exchanged in {term}, in {line}").format(
                one=names[0], two=names[1], term=spelt(whole), line=_(line.about)
            )
            yield Step("exchanged", does, tuple(some), 1.04, about=line.about)


def of_angles(of: Program) -> Iterator[Step]:
    """The lines of a closed form: an angle with the other sign, a length left out of every line."""
    made = {name_of(target) for line in of.lines for target in line.statement.targets}
    places: dict[str, list[ast.expr]] = {}
    for line in of.lines:
        target, whole = line.statement.targets[0], line.statement.value
        if not line.about:
            continue
        angle = isinstance(target, ast.Subscript) and isinstance(target.slice, ast.Constant)
        if angle and is_sum(whole):
            does = _("has {what} with the opposite sign").format(what=_(line.about))
            turned = ast.UnaryOp(ast.USub(), again(whole))
            yield Step("sign", does, ((whole, turned),), 1.02, about=line.about)
        for node in nodes(whole):
            if angle and is_sum(node) and isinstance(node, ast.BinOp) and is_sum(node.right):
                # both at once: phi + (q1 + q2)
                does = _("{does} in {line}").format(
                    does=_("has {what} with the opposite sign").format(what=spelt(node.right)),
                    line=_(line.about),
                )
                turned = ast.UnaryOp(ast.USub(), again(node.right))
                yield Step("sign", does, ((node.right, turned),), 1.02, about=line.about)
            if isinstance(node, ast.Name) and re.fullmatch(r"[lad]\d", node.id):
                places.setdefault(node.id, []).append(node)
    for name, found in places.items():
        if len(found) > 1 and name not in made:
            does = _("leaves {term} out in every line").format(term=name)
            yield Step("missing term", does, tuple((x, times(0, x)) for x in found), 1.06)
            does = _("has {term} with the opposite sign in every line").format(term=name)
            yield Step("sign", does, tuple((x, minus(x)) for x in found), 1.06)


def of_rods(of: Program) -> Iterator[Step]:
    """A rod's data otherwise in every line: the centre at an end, the inertia about an end."""
    others = {
        "cd": (
            ("0", _("takes the rods' centres at the elbows"), 1.08),
            ("l2[i]", _("takes the rods' centres at their far ends"), 1.08),
            ("l2[i]/2", _("takes the rods' centres in their middles"), 1.08),
        ),
        "Id": (
            ("0*Id[i]", _("leaves the rods' inertia out"), 1.05),
            (
                "Id[i] + md[i]*cd[i]**2",
                _("takes the rods' inertia about the elbows, not about their centres"),
                1.05,
            ),
        ),
        "md": (("0*md[i]", _("leaves the rods' mass out"), 1.05),),
    }
    for name, ways in others.items():
        found = [
            node
            for line in of.lines
            for node in nodes(line.statement.value)
            if isinstance(node, ast.Subscript) and name_of(node) == name
        ]
        for text, does, cost in ways if found else ():
            new = ast.parse(text, mode="eval").body
            yield Step("inertia point", does, tuple((x, again(new)) for x in found), cost)
