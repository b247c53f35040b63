"""Everything that one can do otherwise in one place of a derivation.

A term left out or with the other sign, twice or half; an index that is one off; another quantity of
the same kind; a matrix transposed, or not, or left out; a cross product or a product of matrices in
the other order; sine for cosine; another power; parentheses lost; a slide treated as a hinge; the
inverse for the matrix; two lines exchanged. Each follows from the expression alone: nothing here
knows a textbook's mistakes.
"""

from __future__ import annotations

import ast
from collections.abc import Iterator, Mapping
from dataclasses import replace
from functools import lru_cache

from kinlab.doctor.bytecode.syntax import nodes, text_of
from kinlab.doctor.derivations.across import across, everywhere, slides
from kinlab.doctor.derivations.angles import at_angle, at_difference, exchanged, of_angles, of_rods
from kinlab.doctor.derivations.operations import (
    Make,
    at_call,
    at_choice,
    at_entries,
    at_operator,
    turned_again,
)
from kinlab.doctor.derivations.walk import Assignment, Program, Step, again
from kinlab.doctor.derivations.words import (
    KNOWN,
    halves,
    is_sum,
    meant,
    minus,
    name_of,
    shifted,
    spelt,
    summands,
    times,
    told,
    told_other,
    which,
)
from kinlab.host.language import _, language, speaking

_ALIKE = [
    pair.split()
    for pair in (
        "w dw",
        "dv dvc",
        "F f",
        "N nn",
        "P c",
        "F N",
        "f nn",
        "Jv Jw",
        "z o",
        "crank rod",
        "l1 l2",
        "A B C",
        "ct st",
        "sa ca",
        "a dd d",
        "x y",
        "qd qdd",
        "p o",
        "pc p",
        "E1 E2",
        "v a",
        "M C",
        "o_ o",
        "R_ R",
        "G q",
        "c2 s2",
        "c3 s3",
        "c4 s4",
        "c23 s23",
        "beta psi",
        "l2 l3",
        "d3 d4",
        "a2 a3",
        "px py",
        "late early",
        "later earlier",
    )
]
"""Names that are easily taken for one another."""

_GIVEN = ("zero", "one", "end", "g", "number", "zeros", "nothing")
"""Names that nobody writes for another."""


def steps(of: Program, axes: Mapping[int, tuple[int, ...]], n: int, singly: bool) -> list[Step]:
    """Every alternative of a derivation, at all joints; or at each of them alone.

    Args:
        of: the derivation.
        axes: the shape of each of its expressions at one state, from a walk.
        n: number of joints.
        singly: at each joint alone.
    """
    spoken = language()
    with speaking(spoken):  # so that it need not be asked for at every word
        return list(_steps(of, tuple(sorted(axes.items())), n, singly, spoken))


@lru_cache(maxsize=512)
def _steps(
    of: Program,
    shapes_of: tuple[tuple[int, tuple[int, ...]], ...],
    n: int,
    singly: bool,
    spoken: str,
) -> tuple[Step, ...]:
    """The steps, each list made once for a language."""
    del spoken
    axes = dict(shapes_of)
    found: list[Step] = []
    shapes: dict[str, tuple[int, ...]] = {}
    for line in of.lines:
        for node in nodes(line.statement):
            if isinstance(node, ast.Name | ast.Subscript) and id(node) in axes:
                shapes[name_of(node)] = (isinstance(node, ast.Subscript), *axes[id(node)])
    for line in reversed(of.lines):  # of steps that come to the same, the one nearest the answer
        if line.about:
            found += _of_line(line, axes, shapes, not singly)
    found += slides(of)
    found += [*exchanged(of), *of_angles(of), *of_rods(of)]
    if not singly:
        return (*everywhere(of), *found, *across(of, axes, n))
    at_joint = _("{does}, at joint {joint}")
    looped = {id(x) for s in of.body if isinstance(s, ast.For) for x in nodes(s)}
    return tuple(
        replace(
            s,
            sentence=at_joint.format(does=s.sentence, joint=i + 1),
            cost=s.cost + 0.2,
            joint=i + 1,
        )
        for s in found
        if s.cost < 1.3 and id(s.edits[0][0]) in looped
        for i in range(n)
        if n > 1
    )


def _of_line(
    line: Assignment,
    axes: Mapping[int, tuple[int, ...]],
    shapes: Mapping[str, tuple[int, ...]],
    wide: bool,
) -> Iterator[Step]:
    whole = line.statement.value

    around = _surroundings(whole)

    def step(kind: str, does: str, cost: float, *edits: tuple[ast.expr, ast.expr]) -> Step:
        if kind == "only one term":
            return Step(kind, does, edits, cost, about=line.about)
        term = around.get(id(edits[0][0])) if len(edits) == 1 else None
        if term is None:
            said = _("{does} in {line}").format(does=does, line=_(line.about))
        else:
            said = _("{does} in {term}, in {line}").format(does=does, term=term, line=_(line.about))
        return Step(kind, said, edits, cost, about=line.about)

    yield from _terms(whole, axes, line.about, step)
    given = {
        id(x)
        for call in nodes(whole)
        if isinstance(call, ast.Call) and name_of(call.func) in ("ikj", "jki")
        for x in call.args
    }
    for node in nodes(whole):
        if not isinstance(node, ast.expr) or id(node) not in axes:
            continue
        if isinstance(node, ast.BinOp):
            yield from at_operator(node, axes, step)
            yield from at_difference(node, step)
            yield from _own_for_next(node, shapes, step)
        elif isinstance(node, ast.Call):
            yield from at_call(node, step)
            yield from at_angle(node, step)
        elif isinstance(node, ast.Name) and node.id == "D" and id(node) not in given:
            for other in ("ikj", "jki"):
                new = ast.Call(ast.Name(other), [again(node)], [])
                does = _("has {new} for {old}").format(new=told(new), old="dM_ij/dq_k")
                yield step("Christoffel", does, 1.1, (node, new))
        elif isinstance(node, ast.Attribute):
            does = _("has {new} for {old} (not transposed)").format(
                new=spelt(node.value), old=spelt(node)
            )
            yield step("transposed", does, 1.05, (node, node.value))
        elif isinstance(node, ast.IfExp):
            yield from at_choice(node, step)
        elif isinstance(node, ast.List):
            yield from at_entries(node, step)
        elif isinstance(node, ast.Subscript) and "R" in shapes and name_of(node) in ("I", "c", "z"):
            yield from turned_again(node, step)
    yield from _before_for_behind(whole, step)
    yield from _others(whole, axes, shapes, wide, step)


def _surroundings(whole: ast.expr) -> dict[int, str]:
    """For everything inside a term of a sum, or inside an entry of a matrix: in which."""
    out: dict[int, str] = {}
    for node in nodes(whole):
        if isinstance(node, ast.List):
            for r, row in enumerate(node.elts):
                for c, entry in enumerate(row.elts if isinstance(row, ast.List) else ()):
                    where = _("entry ({row}, {column})").format(row=r + 1, column=c + 1)
                    out |= {id(inner): where for inner in nodes(entry)}
        elif isinstance(node, ast.BinOp) and is_sum(node):
            for part in summands(node):
                term = told(part)
                out |= {id(inner): term for inner in nodes(part)[1:]}
    return out


def _terms(
    whole: ast.expr, axes: Mapping[int, tuple[int, ...]], about: str, step: Make
) -> Iterator[Step]:
    """The terms of every sum: left out, with the other sign, twice, half; one alone."""
    inner = {id(x) for node in nodes(whole) if is_sum(node) for x in halves(node)}
    tops = [id(x) for x in _branches(whole)]
    for node in nodes(whole):
        if not isinstance(node, ast.expr) or id(node) not in axes or id(node) in inner:
            continue
        if not is_sum(node) and (id(node) not in tops or isinstance(node, ast.List)):
            continue
        parts = list(summands(node))
        if isinstance(node, ast.BinOp) and isinstance(node.op, ast.Sub) and len(parts) == 2:
            does = _("has {new} for {old}").format(new=spelt(node.right), old=spelt(node))
            yield step("missing term", does, 1.08, (node, node.right))
        rotors = any("Ia" in spelt(part) for part in parts)
        for part in parts:
            if rotors and isinstance(part, ast.Name):  # what the rotors' inertia is added to
                continue
            term = told(part)
            if len(parts) > 1 or isinstance(part, ast.UnaryOp):
                called = KNOWN.get(spelt(part), "").partition(" of ")[0].removeprefix("the ")
                kind = called if called.endswith(" term") else "missing term"
                yield step(
                    kind, _("leaves {term} out").format(term=term), 1.0, (part, times(0, part))
                )
            if not _angle_alone(part):
                yield step(
                    "sign",
                    _("has {term} with the opposite sign").format(term=term),
                    1.02,
                    (part, minus(part)),
                )
            yield step(
                "factor", _("counts {term} twice").format(term=term), 1.2, (part, times(2, part))
            )
            yield step(
                "factor", _("counts {term} half").format(term=term), 1.15, (part, times(0.5, part))
            )
            summed = isinstance(part, ast.Name) and part.id in ("M", "G", "V")
            if len(parts) > 2 and isinstance(part, ast.Name | ast.Subscript) and not summed:
                does = _that_of(about, part)
                yield step("only one term", does, 1.0, (node, again(part)))


def _angle_alone(node: ast.expr) -> bool:
    """An acos: nobody loses the sign of an angle that has none."""
    return isinstance(node, ast.Call) and name_of(node.func) == "arccos"


def _that_of(what: str, part: ast.expr) -> str:
    """Takes the acceleration of something for that of the centre of mass."""
    of_centre = what == "the acceleration of the centre of mass"
    if of_centre and name_of(part) == "dv":
        return _("takes the acceleration of the link's origin for that of the centre of mass")
    new = meant(part)
    if isinstance(part, ast.Subscript) and "+ 1" in text_of(part.slice):
        new = _("{what} of the next link").format(what=new)
    return _("takes {new} for {old}").format(new=new, old=_(what))


def _branches(node: ast.expr) -> Iterator[ast.expr]:
    """An expression, or both of its cases."""
    if isinstance(node, ast.IfExp):
        yield from _branches(node.body)
        yield from _branches(node.orelse)
    else:
        yield node


def _own_for_next(
    node: ast.BinOp, shapes: Mapping[str, tuple[int, ...]], step: Make
) -> Iterator[Step]:
    """What is the link's own, in its axes already, for what comes from the next: F for R f."""
    right = node.right
    if not (isinstance(node.op, ast.MatMult) and isinstance(right, ast.Subscript)):
        return
    if name_of(node.left) != "R" or text_of(right.slice) != "i + 1":
        return
    for pair in (("f", "F"), ("nn", "N")):
        if name_of(right) == pair[0] and pair[1] in shapes:
            new = ast.Subscript(ast.Name(pair[1]), ast.Name("i"))
            does = _("has {new} for {old} ({what} for {other})").format(
                new=spelt(new), old=spelt(node), what=meant(new), other=told(node)
            )
            yield step("another quantity", does, 1.16, (node, new))


def _before_for_behind(whole: ast.expr, step: Make) -> Iterator[Step]:
    """The way from the base to the link's end for that from the joint to the tool; all of it."""
    for node in nodes(whole):
        if isinstance(node, ast.BinOp) and text_of(node) in ("p - o[i]", "pc - o[j]"):
            first = ast.BinOp(node.left, ast.Sub(), ast.parse("o[1]", mode="eval").body)
            does = _(
                "adds up all links for those behind the joint ({new} for {old}: the inner sum "
                "begins at the first joint)"
            ).format(new=spelt(first, True), old=spelt(node, True))
            yield step("sum", does, 1.1, (node, first))
        if isinstance(node, ast.BinOp) and text_of(node) == "p - o[i]":
            new = ast.parse("o_[i] - o_[0]", mode="eval").body
            does = _(
                "adds up the links before the joint for those behind it ({new} for {old})"
            ).format(new=spelt(new, True), old=spelt(node, True))
            yield step("sum", does, 1.12, (node, new))


def _others(
    whole: ast.expr,
    axes: Mapping[int, tuple[int, ...]],
    shapes: Mapping[str, tuple[int, ...]],
    wide: bool,
    step: Make,
) -> Iterator[Step]:
    """Another index or another name, in one place and wherever it stands in the line."""
    places: dict[str, list[ast.expr]] = {}
    every = nodes(whole)
    inner = {id(x.value) for x in every if isinstance(x, ast.Subscript)}
    called = {id(x.func) for x in every if isinstance(x, ast.Call)}
    index = {id(y) for x in every if isinstance(x, ast.Subscript) for y in nodes(x.slice)}
    for node in every:
        named = isinstance(node, ast.Name | ast.Subscript) and id(node) in axes
        if named and not {id(node)} & (inner | called | index):
            assert isinstance(node, ast.expr)
            places.setdefault(text_of(node), []).append(node)
    for found in places.values():
        sets = [found, *([x] for x in found)] if len(found) > 1 else [found]
        for chosen in sets:
            extra = 0.0 if chosen is found else 0.05
            for new, kind, cost in _instead(chosen[0], shapes, axes[id(chosen[0])], wide):
                if kind == "index":
                    does = _("takes {what} ({new} for {old})").format(
                        what=which(chosen[0], new),
                        new=spelt(new, True),
                        old=spelt(chosen[0], True),
                    )
                else:
                    does = told_other(chosen[0], new)
                yield step(kind, does, cost + extra, *((x, again(new)) for x in chosen))


def _instead(
    node: ast.expr, shapes: Mapping[str, tuple[int, ...]], axes: tuple[int, ...], wide: bool
) -> Iterator[tuple[ast.expr, str, float]]:
    name = name_of(node)
    if isinstance(node, ast.Subscript) and not isinstance(node.slice, ast.Constant):
        for shift in (-1, 1):
            index = shifted(node.slice, shift)
            if index is not None:
                cost = 1.1 if name in ("z", "o") else 1.16
                yield ast.Subscript(node.value, index), "index", cost
    likely = {x for group in _ALIKE if name in group for x in group}
    for other in sorted(shapes):
        if other == name or shapes[other][1:] != axes or other in _GIVEN:
            continue
        far = other not in likely
        if far and (not wide or axes != (3,)):
            continue
        new: ast.expr = ast.Name(other)
        if shapes[other][0]:
            if not isinstance(node, ast.Subscript):
                continue
            new = ast.Subscript(new, node.slice)
        yield new, "another quantity", 1.5 if far else 1.16
