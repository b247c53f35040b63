"""Everything that one can do otherwise in one place of a derivation.

A term left out or with the other sign, twice or half; an index that is one off; another quantity of
the same kind; a matrix transposed, or not, or left out; a cross product or a product of matrices in
the other order; sine for cosine; another power; a slide treated as a hinge; the inverse for the
matrix. Each follows from the expression alone: nothing here knows a textbook's mistakes.
"""

from __future__ import annotations

import ast
from collections.abc import Iterator, Mapping
from typing import Any

from kinlab.doctor.confusions.entries import Make, entry_steps
from kinlab.doctor.confusions.walk import Assignment, Program, Step, again
from kinlab.doctor.confusions.words import (
    KNOWN,
    across,
    halves,
    is_sum,
    meant,
    minus,
    name_of,
    spelt,
    summands,
    times,
    told,
    told_other,
    which,
)
from kinlab.host.language import _

_ALIKE = (
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
)
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
    found: list[Step] = []
    shapes: dict[str, tuple[int, ...]] = {}
    for line in of.lines:
        for node in ast.walk(line.statement):
            if isinstance(node, ast.Name | ast.Subscript) and id(node) in axes:
                shapes[name_of(node)] = (isinstance(node, ast.Subscript), *axes[id(node)])
    for line in of.lines:
        if line.about:
            found += _of_line(line, axes, shapes, not singly)
    found += _slides(of)
    if not singly:
        return found
    at_joint = _("{does}, at joint {joint}")
    looped = {id(x) for s in of.body if isinstance(s, ast.For) for x in ast.walk(s)}
    return [
        Step(s.kind, at_joint.format(does=s.sentence, joint=i + 1), s.edits, s.cost + 0.2, i + 1)
        for s in found
        if s.cost < 1.3 and id(s.edits[0][0]) in looped
        for i in range(n)
        if n > 1
    ]


def _of_line(
    line: Assignment,
    axes: Mapping[int, tuple[int, ...]],
    shapes: Mapping[str, tuple[int, ...]],
    wide: bool,
) -> Iterator[Step]:
    assert isinstance(line.statement, ast.Assign)
    whole = line.statement.value

    around = _surroundings(whole)

    def step(kind: str, does: str, cost: float, *edits: tuple[ast.expr, ast.expr]) -> Step:
        if kind == "only one term":
            return Step(kind, does, edits, cost)
        term = around.get(id(edits[0][0])) if len(edits) == 1 else None
        if term is None:
            said = _("{does} in {line}").format(does=does, line=_(line.about))
        else:
            said = _("{does} in {term}, in {line}").format(does=does, term=term, line=_(line.about))
        return Step(kind, said, edits, cost)

    yield from _terms(whole, axes, line.about, step)
    for node in ast.walk(whole):
        if not isinstance(node, ast.expr) or id(node) not in axes:
            continue
        if isinstance(node, ast.BinOp):
            yield from _binary(node, axes, step)
        elif isinstance(node, ast.Call):
            yield from _calls(node, step)
        elif isinstance(node, ast.Attribute):
            does = _("has {new} for {old} (not transposed)").format(
                new=spelt(node.value), old=spelt(node)
            )
            yield step("transposed", does, 1.05, (node, node.value))
        elif isinstance(node, ast.IfExp):
            yield from _choices(node, step)
        elif isinstance(node, ast.List):
            yield from entry_steps(node, step)
        elif isinstance(node, ast.Subscript) and "R" in shapes and name_of(node) in ("I", "c"):
            yield from _turned(node, step)
    yield from _others(whole, axes, shapes, wide, step)


def _surroundings(whole: ast.expr) -> dict[int, str]:
    """For everything inside a term of a sum, or inside an entry of a matrix: in which."""
    out: dict[int, str] = {}
    for node in ast.walk(whole):
        if isinstance(node, ast.List):
            for r, row in enumerate(node.elts):
                for c, entry in enumerate(row.elts if isinstance(row, ast.List) else ()):
                    where = _("entry ({row}, {column})").format(row=r + 1, column=c + 1)
                    out |= {id(inner): where for inner in ast.walk(entry)}
        elif isinstance(node, ast.BinOp) and is_sum(node):
            for part in summands(node):
                inside = (x for x in ast.walk(part) if x is not part)
                if not is_sum(part):
                    out |= {id(inner): told(part) for inner in inside}
    return out


def _terms(
    whole: ast.expr, axes: Mapping[int, tuple[int, ...]], about: str, step: Make
) -> Iterator[Step]:
    """The terms of every sum: left out, with the other sign, twice, half; one alone."""
    inner = {id(x) for node in ast.walk(whole) if is_sum(node) for x in halves(node)}
    tops = [id(x) for x in _branches(whole)]
    for node in ast.walk(whole):
        if not isinstance(node, ast.expr) or id(node) not in axes or id(node) in inner:
            continue
        if not is_sum(node) and (id(node) not in tops or isinstance(node, ast.List)):
            continue
        parts = list(summands(node))
        for part in parts:
            term = told(part)
            if len(parts) > 1 or isinstance(part, ast.UnaryOp):
                called = KNOWN.get(spelt(part), "").partition(" of ")[0].removeprefix("the ")
                kind = called if called.endswith(" term") else "missing term"
                yield step(
                    kind, _("leaves {term} out").format(term=term), 1.0, (part, times(0, part))
                )
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
            if len(parts) > 2 and isinstance(part, ast.Name | ast.Subscript):
                does = _that_of(about, part)
                yield step("only one term", does, 1.0, (node, again(part)))


def _that_of(what: str, part: ast.expr) -> str:
    """Takes the acceleration of something for that of the centre of mass."""
    of_centre = what == "the acceleration of the centre of mass"
    if of_centre and name_of(part) == "dv":
        return _("takes the acceleration of the link's origin for that of the centre of mass")
    return _("takes {new} for {old}").format(new=meant(part), old=_(what))


def _branches(node: ast.expr) -> Iterator[ast.expr]:
    """An expression, or both of its cases."""
    if isinstance(node, ast.IfExp):
        yield from _branches(node.body)
        yield from _branches(node.orelse)
    else:
        yield node


def _binary(node: ast.BinOp, axes: Mapping[int, tuple[int, ...]], step: Make) -> Iterator[Step]:
    left, right = node.left, node.right
    one, two = (len(axes.get(id(x), ())) for x in (left, right))
    if isinstance(node.op, ast.MatMult):
        if one == 2 and isinstance(left, ast.Attribute | ast.Name | ast.Subscript):
            if two == 1 and _turns(left):
                does = _("does not rotate {term} ({factor} is left out)").format(
                    term=told(right), factor=spelt(left)
                )
                yield step("rotation left out", does, 1.1, (node, right))
            elif two == 1:
                does = _("leaves the factor {factor} out of {term}").format(
                    factor=spelt(left), term=spelt(node)
                )
                yield step("missing factor", does, 1.25, (node, right))
            if not isinstance(left, ast.Attribute):
                does = _("has {new} for {old} (transposed)").format(
                    new=spelt(across(left)), old=spelt(left)
                )
                yield step("transposed", does, 1.17, (left, across(left)))
        if one == two == 2:
            same = isinstance(right, ast.Attribute) and spelt(right.value) == spelt(left)
            if not _turns(left) and (same or not isinstance(right, ast.Attribute)):
                turned = ast.BinOp(right, ast.MatMult(), left)
                does = _("has {new} for {old} (the product's order)").format(
                    new=spelt(turned), old=spelt(node)
                )
                yield step("order", does, 1.1, (node, turned))
            if not isinstance(right, ast.Attribute) and not isinstance(right, ast.BinOp):
                does = _("has {new} for {old} (transposed)").format(
                    new=spelt(across(right)), old=spelt(right)
                )
                yield step("transposed", does, 1.17, (right, across(right)))
            yield from _sandwich(node, step)
    elif isinstance(node.op, ast.Mult | ast.Div):
        for factor, rest in ((left, right), (right, left)):
            if isinstance(factor, ast.Name | ast.Subscript) and (
                isinstance(node.op, ast.Mult) or factor is right
            ):
                does = _("leaves the factor {factor} out of {term}").format(
                    factor=spelt(factor), term=spelt(node)
                )
                yield step("missing factor", does, 1.15, (node, rest))
        if isinstance(left, ast.Constant):
            does = _("has {new} for {old} (the factor)").format(new=spelt(right), old=spelt(node))
            yield step("factor", does, 1.1, (node, right))
    elif isinstance(node.op, ast.Pow):
        assert isinstance(node.right, ast.Constant)
        power: Any = node.right.value
        for other in (power - 1, power + 1):
            if other:
                new = ast.BinOp(left, ast.Pow(), ast.Constant(other))
                does = _("has {new} for {old} (power)").format(new=spelt(new), old=spelt(node))
                yield step("power", does, 1.1, (node, new))


def _turns(node: ast.expr) -> bool:
    """Whether an expression is a rotation."""
    return name_of(node.value if isinstance(node, ast.Attribute) else node) in ("R", "R_")


def _sandwich(node: ast.BinOp, step: Make) -> Iterator[Step]:
    """R I R^T: not rotated, or the wrong way."""
    inner, last = node.left, node.right
    if not (
        isinstance(inner, ast.BinOp)
        and isinstance(last, ast.Attribute)
        and spelt(last.value) == spelt(inner.left)
    ):
        return
    plain, turned = spelt(inner.right), f"{spelt(last)} {spelt(inner.right)} {spelt(inner.left)}"
    right = f"{spelt(inner.left)} {plain} {spelt(last)}"
    does = _(
        "takes the inertia tensors in link axes as if in base axes (not rotated: {new} for {old})"
    ).format(new=plain, old=right)
    yield step("tensor not rotated", does, 1.0, (node, inner.right))
    does = _("has {new} for {old} (the inertia tensor is rotated the wrong way)").format(
        new=turned, old=right
    )
    new = ast.BinOp(ast.BinOp(last, ast.MatMult(), inner.right), ast.MatMult(), inner.left)
    yield step("tensor transposed", does, 1.02, (node, new))


def _calls(node: ast.Call, step: Make) -> Iterator[Step]:
    assert isinstance(node.func, ast.Name)
    name, x = node.func.id, node.args
    if name == "cross":
        new = ast.Call(node.func, [x[1], x[0]], [])
        does = _(
            "has the cross product's order exchanged: {new} for {old}, the opposite sign,"
        ).format(new=spelt(new), old=spelt(node))
        yield step("sign", does, 1.0, (node, new))
        if isinstance(x[0], ast.BinOp) and isinstance(x[0].op, ast.MatMult) and _turns(x[0].left):
            inner = ast.Call(node.func, [x[0].right, x[1]], [])
            late = ast.BinOp(x[0].left, ast.MatMult(), inner)
            does = _("has {new} for {old} (rotated after the cross product)").format(
                new=spelt(late), old=spelt(node)
            )
            yield step("order", does, 1.1, (node, late))
        if isinstance(x[1], ast.Call):
            less = ast.Call(node.func, [x[0], x[1].args[1]], [])
            yield step(
                "power",
                _("has {new} for {old}").format(new=spelt(less), old=spelt(node)),
                1.15,
                (node, less),
            )
    elif name in ("sin", "cos"):
        new = ast.Call(ast.Name("cos" if name == "sin" else "sin"), x, [])
        yield step(
            "sin/cos",
            _("has {new} for {old} (sin/cos)").format(new=spelt(new), old=spelt(node)),
            1.0,
            (node, new),
        )
        does = _("has {angle} with the opposite sign in {term}").format(
            angle=spelt(x[0]), term=spelt(node)
        )
        yield step("sign", does, 1.1, (x[0], minus(x[0])))
    elif name == "solve":
        matrix, other = spelt(x[0]), x[1]
        plain, turned = ast.BinOp(x[0], ast.MatMult(), other), across(x[0])
        does = _("has {matrix} for its inverse {matrix}^-1").format(matrix=matrix)
        yield step("inverse", does, 1.05, (node, plain))
        does = _("has {new} for {old} (transposed)").format(new=spelt(turned), old=matrix)
        yield step("transposed", does, 1.1, (node, ast.Call(node.func, [turned, other], [])))
        does = _("has the transpose {matrix}^T for the inverse {matrix}^-1").format(matrix=matrix)
        yield step("inverse", does, 1.05, (node, ast.BinOp(turned, ast.MatMult(), other)))
    elif name == "defect" and isinstance(x[0], ast.BinOp):
        swapped = ast.BinOp(x[0].right, ast.MatMult(), x[0].left)
        does = _("has {new} for {old} (the product's order)")
        does = does.format(new=spelt(swapped), old=spelt(x[0]))
        yield step("order", does, 1.05, (node, ast.Call(node.func, [swapped], [])))
    elif name == "inv":
        does = _("has {matrix} for its inverse {matrix}^-1").format(matrix=spelt(x[0]))
        yield step("inverse", does, 1.05, (node, x[0]))
    elif name in ("ikj", "jki"):
        yield step(
            "Christoffel",
            _("has {new} for {old}").format(new="dM_ij/dq_k", old=told(node)),
            1.1,
            (node, x[0]),
        )
        other = ast.Call(ast.Name("jki" if name == "ikj" else "ikj"), x, [])
        yield step(
            "Christoffel",
            _("has {new} for {old}").format(new=told(other), old=told(node)),
            1.1,
            (node, other),
        )


def _turned(node: ast.Subscript, step: Make) -> Iterator[Step]:
    """What is in the link's axes already, rotated once more."""
    turn = ast.Subscript(ast.Name("R"), node.slice)
    for one, two in ((turn, across(turn)), (across(turn), turn)):
        new: ast.expr = ast.BinOp(one, ast.MatMult(), again(node))
        if name_of(node) == "I":
            new = ast.BinOp(new, ast.MatMult(), two)
        does = _("rotates {what} ({new} for {old})").format(
            what=meant(node), new=spelt(new), old=spelt(node)
        )
        yield step("rotated twice", does, 1.15, (node, new))


def _choices(node: ast.IfExp, step: Make) -> Iterator[Step]:
    if isinstance(node.test, ast.Compare):
        test = ast.Compare(node.test.left, [ast.Lt()], node.test.comparators)
        less = ast.IfExp(test, node.body, node.orelse)
        does = _("leaves the link's own joint out (j < i for j <= i)")
        yield step("own joint", does, 1.1, (node, less))
        return
    does = _("treats a slide (prismatic joint) as a hinge (revolute)")
    yield step("slide as hinge", does, 1.1, (node, node.body))
    does = _("treats a hinge (revolute) as a slide (prismatic joint)")
    yield step("hinge as slide", does, 1.2, (node, node.orelse))


def _slides(of: Program) -> Iterator[Step]:
    """A slide treated as a hinge in every line, and the other way."""
    nodes = [
        node
        for line in of.lines
        if line.about
        for node in ast.walk(line.statement)
        if isinstance(node, ast.IfExp) and isinstance(node.test, ast.Subscript)
    ]
    if len(nodes) > 1:
        yield Step(
            "slide as hinge",
            _("treats a slide (prismatic joint) as a hinge (revolute)"),
            tuple((node, node.body) for node in nodes),
            1.0,
        )
        yield Step(
            "hinge as slide",
            _("treats a hinge (revolute) as a slide (prismatic joint)"),
            tuple((node, node.orelse) for node in nodes),
            1.15,
        )


def _others(
    whole: ast.expr,
    axes: Mapping[int, tuple[int, ...]],
    shapes: Mapping[str, tuple[int, ...]],
    wide: bool,
    step: Make,
) -> Iterator[Step]:
    """Another index or another name, in one place and wherever it stands in the line."""
    places: dict[str, list[ast.expr]] = {}
    inner = {id(x.value) for x in ast.walk(whole) if isinstance(x, ast.Subscript)}
    called = {id(x.func) for x in ast.walk(whole) if isinstance(x, ast.Call)}
    index = {
        id(y) for x in ast.walk(whole) if isinstance(x, ast.Subscript) for y in ast.walk(x.slice)
    }
    for node in ast.walk(whole):
        named = isinstance(node, ast.Name | ast.Subscript) and id(node) in axes
        if named and not {id(node)} & (inner | called | index):
            assert isinstance(node, ast.expr)
            places.setdefault(ast.unparse(node), []).append(node)
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
            index = _shifted(node.slice, shift)
            if index is not None:
                cost = 1.1 if name in ("z", "o") else 1.16
                yield ast.Subscript(node.value, index), "index", cost
    likely = {x for group in _ALIKE for x in group.split() if name in group.split()}
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
        yield new, "another quantity", 1.5 if far else 1.15


def _shifted(index: ast.expr, shift: int) -> ast.expr | None:
    """An index one more or less: i - 1 from i, i from i + 1."""
    base, by = index, 0
    if isinstance(index, ast.BinOp) and isinstance(index.right, ast.Constant):
        base = index.left
        by = (1 if isinstance(index.op, ast.Add) else -1) * int(str(index.right.value))
    by += shift
    if abs(by) > 1:
        return None
    if not by:
        return base
    return ast.BinOp(base, ast.Add() if by > 0 else ast.Sub(), ast.Constant(1))
