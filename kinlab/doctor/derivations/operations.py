"""What one can do otherwise at one operator, call, choice or matrix of a derivation.

A product's order, a transpose, a rotation or a factor left out, another power, parentheses lost;
sine for cosine, the inverse for the matrix; a slide treated as a hinge; the entries of a link's
matrix that is written out.
"""

from __future__ import annotations

import ast
from collections.abc import Callable, Iterator, Mapping
from typing import Any

from kinlab.doctor.derivations.books.matrices import MODIFIED, STANDARD
from kinlab.doctor.derivations.walk import Step, again
from kinlab.doctor.derivations.words import (
    across,
    is_sum,
    meant,
    minus,
    name_of,
    spelt,
    times,
    told,
)
from kinlab.host.language import N_, _

Make = Callable[..., Step]
ROTATIONS = ("R", "R_", "Rn", "Rt")


def at_operator(node: ast.BinOp, axes: Mapping[int, tuple[int, ...]], step: Make) -> Iterator[Step]:
    left, right = node.left, node.right
    one, two = (len(axes.get(id(x), ())) for x in (left, right))
    yield from _parallel_axis(node, step)
    yield from _squares(node, axes, step)
    if isinstance(node.op, ast.MatMult):
        if one == 2 and isinstance(left, ast.Attribute | ast.Name | ast.Subscript):
            if two == 1 and turns(left):
                does = _("does not rotate {term} ({factor} is left out)").format(
                    term=told(right), factor=spelt(left)
                )
                yield step("rotation left out", does, 1.1, (node, right))
            elif two == 1:
                does = _("leaves the factor {factor} out of {term}").format(
                    factor=spelt(left), term=spelt(node)
                )
                yield step("missing factor", does, 1.25, (node, right))
        if isinstance(left, ast.BinOp) and isinstance(left.op, ast.MatMult) and two == 1:
            does = _("leaves the factor {factor} out of {term}").format(
                factor=spelt(left.right), term=spelt(node)
            )
            less = ast.BinOp(left.left, ast.MatMult(), right)
            yield step("missing factor", does, 1.12, (node, less))
        if one == 2 and isinstance(left, ast.Attribute | ast.Name | ast.Subscript):
            if two == 1 and is_sum(right):
                yield from _opened(node, right, lambda x: ast.BinOp(left, node.op, x), step)
            if not isinstance(left, ast.Attribute):
                does = _("has {new} for {old} (transposed)").format(
                    new=spelt(across(left)), old=spelt(left)
                )
                yield step("transposed", does, 1.17, (left, across(left)))
        if one == 3 and two == 1:
            yield from _summed_otherwise(node, step)
        if one == two == 2:
            for factor, rest in ((left, right), (right, left)):
                if not isinstance(factor, ast.BinOp):
                    does = _("leaves the factor {factor} out of {term}").format(
                        factor=spelt(factor), term=spelt(node)
                    )
                    yield step("missing factor", does, 1.19, (node, rest))
            same = isinstance(right, ast.Attribute) and spelt(right.value) == spelt(left)
            both = turns(left) and turns(right)
            if (both or not turns(left)) and (same or not isinstance(right, ast.Attribute)):
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
            signed = isinstance(factor, ast.UnaryOp)
            plain = factor.operand if isinstance(factor, ast.UnaryOp) else factor
            if signed and isinstance(plain, ast.Name):
                # the factor's sign is lost with it, or it is not
                does = _("leaves the factor {factor} out of {term}").format(
                    factor=spelt(plain), term=spelt(node)
                )
                yield step("missing factor", does, 1.15, (node, ast.UnaryOp(ast.USub(), rest)))
            if isinstance(plain, ast.Name | ast.Subscript) and (
                isinstance(node.op, ast.Mult) or factor is right
            ):
                does = _("leaves the factor {factor} out of {term}").format(
                    factor=spelt(factor), term=spelt(node)
                )
                yield step("missing factor", does, 1.15, (node, rest))
        if isinstance(left, ast.Constant):
            does = _("has {new} for {old} (the factor)").format(new=spelt(right), old=spelt(node))
            yield step("factor", does, 1.1, (node, right))
            if is_sum(right):
                yield from _opened(node, right, lambda x: ast.BinOp(left, node.op, x), step)
    elif isinstance(node.op, ast.Pow):
        assert isinstance(node.right, ast.Constant)
        power: Any = node.right.value
        for other in (power - 1, power + 1):
            if other:
                new = ast.BinOp(left, ast.Pow(), ast.Constant(other))
                does = _("has {new} for {old} (power)").format(new=spelt(new), old=spelt(node))
                yield step("power", does, 1.1, (node, new))


def _parallel_axis(node: ast.BinOp, step: Make) -> Iterator[Step]:
    """Of -m skew(c) skew(c) = m (c.c 1 - c c^T): one of its terms left out, or its sign."""
    inner, last = node.left, node.right
    if not (
        isinstance(node.op, ast.MatMult)
        and isinstance(last, ast.Call)
        and name_of(last.func) == "skew"
        and isinstance(inner, ast.BinOp)
        and spelt(inner.right) == spelt(last)
    ):
        return
    c = last.args[0]
    outer = ast.Call(ast.Name("outer"), [c, c], [])
    square = ast.BinOp(ast.BinOp(c, ast.MatMult(), c), ast.Mult(), ast.Name("one"))
    name = spelt(c)
    whole = f"{spelt(inner.left)}*({name}.{name} 1 - {name} {name}^T)"
    plus, minus_ = f"+ {name} {name}^T", f"- {name} {name}^T"
    for kind, does, new in (
        (
            "sign",
            _("has {new} for {old} in the parallel-axis term {term}").format(
                new=plus, old=minus_, term=whole
            ),
            ast.UnaryOp(ast.USub(), ast.BinOp(square, ast.Add(), outer)),
        ),
        (
            "missing term",
            _("leaves {what} out of the parallel-axis term {term}").format(what=minus_, term=whole),
            ast.UnaryOp(ast.USub(), square),
        ),
        (
            "missing term",
            _("leaves {what} out of the parallel-axis term {term}").format(
                what=f"{name}.{name} 1", term=whole
            ),
            outer,
        ),
    ):
        yield step(kind, does, 1.05, (node, ast.BinOp(inner.left, ast.Mult(), new)))


def _squares(node: ast.BinOp, axes: Mapping[int, tuple[int, ...]], step: Make) -> Iterator[Step]:
    """Of the square of a vector one component left out; ½ k x² with neither square nor half."""
    left, right = node.left, node.right
    if isinstance(node.op, ast.MatMult):
        first = left.right if isinstance(left, ast.BinOp) else left
        plain = first.value if isinstance(first, ast.Attribute) else first
        if spelt(plain) == spelt(right) and axes.get(id(right), ())[:1] == (3,):
            for axis in "xyz":
                does = _("leaves the {axis} components out of {term}").format(
                    axis=axis, term=spelt(node)
                )
                new = ast.Call(ast.Name("without_" + axis), [again(right)], [])
                yield step("missing term", does, 1.1, (right, new))
        return
    halved = isinstance(left, ast.BinOp) and isinstance(left.left, ast.Constant)
    if halved and isinstance(right, ast.BinOp) and isinstance(right.op, ast.Pow):
        less = ast.BinOp(left.right, ast.Mult(), right.left)  # type: ignore[attr-defined]
        does = _("has {new} for {old} (power)").format(new=spelt(less), old=spelt(node))
        yield step("power", does, 1.1, (node, less))


def _summed_otherwise(node: ast.BinOp, step: Make) -> Iterator[Step]:
    """A sum over the last of three indices, with the vector's entry of another index in it."""
    for name, index in (("times_j", "j"), ("times_i", "i")):
        new = ast.Call(ast.Name(name), [node.left, node.right], [])
        does = _("has qd_{index} for qd_k in the sum over k")
        yield step("index", does.format(index=index), 1.1, (node, new))


def _opened(
    node: ast.expr, inner: ast.expr, applied: Callable[[ast.expr], ast.expr], step: Make
) -> Iterator[Step]:
    """A factor of a sum that reaches its first term only: the parentheses are lost."""

    def first(part: ast.expr) -> ast.expr:
        if isinstance(part, ast.BinOp) and is_sum(part):
            return ast.BinOp(first(part.left), part.op, part.right)
        return applied(part)

    new = first(inner)
    does = _("has {new} for {old} (parentheses)").format(new=spelt(new), old=spelt(node))
    yield step("parentheses", does, 1.1, (node, new))


def turns(node: ast.expr) -> bool:
    """Whether an expression is a rotation."""
    return name_of(node.value if isinstance(node, ast.Attribute) else node) in ROTATIONS


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


def at_call(node: ast.Call, step: Make) -> Iterator[Step]:
    assert isinstance(node.func, ast.Name)
    name, x = node.func.id, node.args
    if name == "cross":
        new = ast.Call(node.func, [x[1], x[0]], [])
        does = _(
            "has the cross product's order exchanged: {new} for {old}, the opposite sign,"
        ).format(new=spelt(new), old=spelt(node))
        yield step("sign", does, 1.0, (node, new))
        if isinstance(x[0], ast.BinOp) and isinstance(x[0].op, ast.MatMult) and turns(x[0].left):
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
        if is_sum(other):
            yield from _opened(node, other, lambda y: ast.Call(node.func, [x[0], y], []), step)
    elif name == "twist":
        for part, which in ((x[0], _("the linear part")), (x[1], _("the angular part"))):
            if spelt(part) != "zero":
                does = _("leaves {term} out").format(term=f"{spelt(part)} ({which})")
                yield step("missing term", does, 1.03, (part, times(0, part)))
                does = _("has {term} with the opposite sign").format(
                    term=f"{spelt(part)} ({which})"
                )
                yield step("sign", does, 1.04, (part, minus(part)))
    elif name in ("defect", "conditions") and isinstance(x[0], ast.BinOp):
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


def turned_again(node: ast.Subscript, step: Make) -> Iterator[Step]:
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


def without_own(node: ast.IfExp) -> ast.IfExp:
    """A choice by ``j <= k`` that has ``j < k``."""
    assert isinstance(node.test, ast.Compare)
    test = ast.Compare(node.test.left, [ast.Lt()], node.test.comparators)
    return ast.IfExp(test, node.body, node.orelse)


def at_choice(node: ast.IfExp, step: Make) -> Iterator[Step]:
    if isinstance(node.test, ast.Compare):
        does = _("leaves the link's own joint out (j < i for j <= i)")
        yield step("own joint", does, 1.1, (node, without_own(node)))
        return
    does = _("treats a slide (prismatic joint) as a hinge (revolute)")
    yield step("slide as hinge", does, 1.1, (node, node.body))
    does = _("treats a hinge (revolute) as a slide (prismatic joint)")
    yield step("hinge as slide", does, 1.2, (node, node.orelse))


# -------- The entries of a matrix that is written out

_AS_IN = {
    "standard": N_("{does} (as in the standard convention, {new} for {old})"),
    "modified": N_("{does} (as in the modified convention, {new} for {old})"),
}


def at_entries(node: ast.List, step: Make) -> Iterator[Step]:
    """The entries of a matrix that is written out."""
    rows = [row.elts for row in node.elts if isinstance(row, ast.List)][:3]
    for r, row in enumerate(rows):
        for c, entry in enumerate(row):
            empty = isinstance(entry, ast.Constant)
            text = spelt(entry)
            theirs = _other_convention(node, r, c)
            if theirs is not None:
                kind, does = _against(entry, theirs[1])
                does = _(_AS_IN[theirs[0]]).format(does=does, new=spelt(theirs[1]), old=text)
                yield step(kind, does, 1.1, (entry, theirs[1]))
            if not empty:
                does = _(
                    "has the opposite sign in entry ({row}, {column}): {new} for {old}"
                ).format(row=r + 1, column=c + 1, new=spelt(minus(entry)), old=text)
                yield step("sign", does, 1.02, (entry, minus(entry)))
                does = _("leaves {term} out (0 for it)").format(term=text)
                yield step("missing term", does, 1.08, (entry, ast.Constant(0)))
                for name in ("ct", "st", "ca", "sa"):
                    new = ast.BinOp(again(entry), ast.Mult(), ast.Name(name))
                    does = _("has the extra factor {factor} in {new} for {old}").format(
                        factor=spelt(new.right), new=spelt(new), old=text
                    )
                    yield step("extra factor", does, 1.2, (entry, new))
            if c + 1 < len(row) and not (empty and isinstance(row[c + 1], ast.Constant)):
                does = _("has {one} and {other} exchanged in row {row} of the matrix").format(
                    one=text, other=spelt(row[c + 1]), row=r + 1
                )
                swapped = ((entry, again(row[c + 1])), (row[c + 1], again(entry)))
                yield step("exchanged", does, 1.15, *swapped)
        negative = [(x, minus(x)) for x in row if minus(x) is not x and spelt(x)[0] == "-"]
        if len(negative) > 1:
            does = _("leaves the minus sign out in row {row} of the matrix").format(row=r + 1)
            yield step("sign", does, 1.1, *negative)


def _other_convention(node: ast.List, r: int, c: int) -> tuple[str, ast.expr] | None:
    """The entry that stands there in the other convention's matrix, where it is another one."""
    for convention, text in (("standard", STANDARD), ("modified", MODIFIED)):
        other = ast.parse(text.partition("=")[2].strip(), mode="eval").body
        if ast.dump(other) != ast.dump(node):
            mine, theirs = (x.elts[r].elts[c] for x in (node, other))  # type: ignore[attr-defined]
            return None if ast.dump(mine) == ast.dump(theirs) else (convention, theirs)
    return None


def _against(mine: ast.expr, theirs: ast.expr) -> tuple[str, str]:
    """A kind and words for another entry: a factor more, a factor less, or something else."""
    one, two = (set(spelt(x).lstrip("-").split("*")) for x in (mine, theirs))
    if two < one:
        return "missing factor", _("leaves the factor {factor} out").format(
            factor="*".join(sorted(one - two))
        )
    if one < two:
        return "extra factor", _("has the extra factor {factor}").format(
            factor="*".join(sorted(two - one))
        )
    return "convention", _("has {new} for {old}").format(new=spelt(theirs), old=spelt(mine))
