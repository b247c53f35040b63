"""Everything that one can do otherwise in one place of a derivation.

A term left out or with the other sign, twice or half; an index that is one off; another quantity of
the same kind; a matrix transposed, or not, or left out; a cross product or a product of matrices in
the other order; sine for cosine; another power; a slide treated as a hinge; the inverse for the
matrix. Each follows from the expression alone: nothing here knows a textbook's mistakes.
"""

from __future__ import annotations

import ast
from collections.abc import Callable, Iterator, Mapping
from typing import Any

from kinlab.doctor.confusions.books import MODIFIED, STANDARD
from kinlab.doctor.confusions.walk import Line, Program, Step, again
from kinlab.host.language import N_, _

_ALIKE = (
    "w dw", "dv dvc", "F f", "N nn", "P c", "F N", "f nn", "Jv Jw", "z o", "crank rod", "l1 l2",
    "A B C", "ct st", "sa ca", "a dd d", "x y", "qd qdd", "p o", "pc p", "E1 E2", "v a", "M C",
    "o_ o", "R_ R", "G q",
)  # fmt: skip
"""Names that are easily taken for one another."""

_GIVEN = ("zero", "one", "end", "g", "number", "zeros", "nothing")
"""Names that nobody writes for another."""

MEANT = {
    "w": N_("the angular velocity w"), "dw": N_("the angular acceleration omega_dot"),
    "dv": N_("the acceleration of the link's origin"),
    "dvc": N_("the acceleration of the centre of mass"), "F": N_("the link's own force F"),
    "N": N_("the link's own moment N"), "f": N_("the force f"), "nn": N_("the moment n"),
    "P": N_("the lever arm P"), "c": N_("the centre of mass P_C"), "z": N_("the axis z"),
    "o": N_("the origin o"), "p": N_("the tool's point p"), "pc": N_("the centre of mass"),
    "R": N_("the rotation R"), "I": N_("the inertia tensor"), "m": N_("the mass m"),
    "Ia": N_("the rotor inertia"),
    "T": N_("the transform T"), "A": N_("the matrix A"), "g": N_("gravity"), "q": "q",
    "qd": N_("the velocity qd"),
    "qdd": N_("the acceleration qdd"), "R_": N_("the rotation R"),
    "crank": N_("the crank's direction u"), "rod": N_("the rod's direction w"),
    "l1": N_("the crank's length l1"), "l2": N_("the rod's length l2"),
    "Ib": N_("the inertia tensor"), "cb": N_("the centre of mass P_C"),
    "o_": N_("the frame's origin"),
}  # fmt: skip
"""What names stand for."""

_SPELT = {"ct": "cos(theta)", "st": "sin(theta)", "ca": "cos(alpha)", "sa": "sin(alpha)",
          "crank": "u", "rod": "w", "dw": "omega_dot", "dv": "v_dot", "dvc": "v_dot_C",
          "nn": "n", "c": "P_C", "R_": "R", "o_": "o", "dd": "d", "Jb": "J", "Jm": "J",
          "th": "theta", "Ib": "I", "cb": "P_C"}  # fmt: skip

_KNOWN = {
    "w x (I w)": N_("the gyroscopic term"),
    "w x (w x P)": N_("the centripetal term of the link's origin"),
    "w x (w x P_C)": N_("the centripetal term of the centre of mass"),
    "omega_dot x P": N_("the tangential term of the link's origin"),
    "omega_dot x P_C": N_("the tangential term of the centre of mass"),
    "2*w x (qd*z)": N_("the Coriolis acceleration of a slide, prismatic joint"),
    "2*w x (qd*(R^T z))": N_("the Coriolis acceleration of a slide, prismatic joint"),
    "(R^T w) x (qd*z)": N_("w x z qd"),
    "w x (qd*z)": N_("w x z qd"),
    "qdd*z": N_("the acceleration d_ddot of a slide, theta_ddot of a hinge"),
    "I omega_dot": N_("the inertia tensor's moment"),
    "N": N_("the link's own moment"),
    "F": N_("the link's own force"),
    "P_C x F": N_("the moment of F"),
    "(P + P_C) x F": N_("the moment of F at the centre of mass"),
    "P x (R f)": N_("the lever arm of the next link's force"),
    "R f": N_("the force of the next link"),
    "R n": N_("the moment of the next link"),
    "Ia*qdd": N_("the rotor inertia"),
    "diagonal(Ia)": N_("the rotor inertia"),
    "-g": N_("gravity"),
    "g": N_("gravity"),
    "G": N_("the gravity torques"),
    "C v": N_("the velocity terms"),
    "M a": N_("the inertia terms"),
    "o": N_("the joint's origin"),
    "R P_C": N_("the centre of mass in the link"),
    "m*Jv^T Jv": N_("the mass's part"),
    "Jw^T (R I R^T) Jw": N_("the inertia tensor's part"),
    "D": "dM_ij/dq_k",
    "D_ikj": "dM_ik/dq_j",
    "D_jki": "dM_jk/dq_i",
}
"""What terms are called."""


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
                shapes[_name(node)] = (isinstance(node, ast.Subscript), *axes[id(node)])
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
    line: Line,
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
        told = around.get(id(edits[0][0])) if len(edits) == 1 else None
        if told is None:
            said = _("{does} in {line}").format(does=does, line=_(line.about))
        else:
            said = _("{does} in {term}, in {line}").format(does=does, term=told, line=_(line.about))
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
            yield from _entries(node, step)
        elif isinstance(node, ast.Subscript) and "R" in shapes and _name(node) in ("I", "c"):
            yield from _turned(node, step)
    yield from _others(whole, axes, shapes, wide, step)


Make = Callable[..., Step]


def _surroundings(whole: ast.expr) -> dict[int, str]:
    """For everything inside a term of a sum, or inside an entry of a matrix: in which."""
    out: dict[int, str] = {}
    for node in ast.walk(whole):
        if isinstance(node, ast.List):
            for r, row in enumerate(node.elts):
                for c, entry in enumerate(row.elts if isinstance(row, ast.List) else ()):
                    where = _("entry ({row}, {column})").format(row=r + 1, column=c + 1)
                    out |= {id(inner): where for inner in ast.walk(entry)}
        elif isinstance(node, ast.BinOp) and _is_sum(node):
            for part in _summands(node):
                inside = (x for x in ast.walk(part) if x is not part)
                if not _is_sum(part):
                    out |= {id(inner): _told(part) for inner in inside}
    return out


def _terms(
    whole: ast.expr, axes: Mapping[int, tuple[int, ...]], about: str, step: Make
) -> Iterator[Step]:
    """The terms of every sum: left out, with the other sign, twice, half; one alone."""
    halves = {id(x) for node in ast.walk(whole) if _is_sum(node) for x in _halves(node)}
    tops = [id(x) for x in _branches(whole)]
    for node in ast.walk(whole):
        if not isinstance(node, ast.expr) or id(node) not in axes or id(node) in halves:
            continue
        if not _is_sum(node) and (id(node) not in tops or isinstance(node, ast.List)):
            continue
        parts = list(_summands(node))
        for part in parts:
            told = _told(part)
            if len(parts) > 1 or isinstance(part, ast.UnaryOp):
                called = _KNOWN.get(spelt(part), "").partition(" of ")[0].removeprefix("the ")
                kind = called if called.endswith(" term") else "missing term"
                yield step(
                    kind, _("leaves {term} out").format(term=told), 1.0, (part, _times(0, part))
                )
            yield step(
                "sign",
                _("has {term} with the opposite sign").format(term=told),
                1.02,
                (part, _minus(part)),
            )
            yield step(
                "factor", _("counts {term} twice").format(term=told), 1.2, (part, _times(2, part))
            )
            yield step(
                "factor", _("counts {term} half").format(term=told), 1.15, (part, _times(0.5, part))
            )
            if len(parts) > 2 and isinstance(part, ast.Name | ast.Subscript):
                does = _that_of(about, part)
                yield step("only one term", does, 1.0, (node, again(part)))


def _that_of(what: str, part: ast.expr) -> str:
    """Takes the acceleration of something for that of the centre of mass."""
    of_centre = what == "the acceleration of the centre of mass"
    if of_centre and _name(part) == "dv":
        return _("takes the acceleration of the link's origin for that of the centre of mass")
    return _("takes {new} for {old}").format(new=_meant(part), old=_(what))


def _branches(node: ast.expr) -> Iterator[ast.expr]:
    """An expression, or both of its cases."""
    if isinstance(node, ast.IfExp):
        yield from _branches(node.body)
        yield from _branches(node.orelse)
    else:
        yield node


def _halves(node: ast.AST) -> tuple[ast.expr, ast.expr]:
    assert isinstance(node, ast.BinOp)
    return node.left, node.right


def _is_sum(node: ast.AST) -> bool:
    return isinstance(node, ast.BinOp) and isinstance(node.op, ast.Add | ast.Sub)


def _summands(node: ast.expr) -> Iterator[ast.expr]:
    if _is_sum(node):
        assert isinstance(node, ast.BinOp)
        yield from _summands(node.left)
        yield from _summands(node.right)
    else:
        yield node


def _binary(node: ast.BinOp, axes: Mapping[int, tuple[int, ...]], step: Make) -> Iterator[Step]:
    left, right = node.left, node.right
    one, two = (len(axes.get(id(x), ())) for x in (left, right))
    if isinstance(node.op, ast.MatMult):
        if one == 2 and isinstance(left, ast.Attribute | ast.Name | ast.Subscript):
            if two == 1 and _turns(left):
                does = _("does not rotate {term} ({factor} is left out)").format(
                    term=_told(right), factor=spelt(left)
                )
                yield step("rotation left out", does, 1.1, (node, right))
            elif two == 1:
                does = _("leaves the factor {factor} out of {term}").format(
                    factor=spelt(left), term=spelt(node)
                )
                yield step("missing factor", does, 1.25, (node, right))
            if not isinstance(left, ast.Attribute):
                does = _("has {new} for {old} (transposed)").format(
                    new=spelt(_across(left)), old=spelt(left)
                )
                yield step("transposed", does, 1.17, (left, _across(left)))
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
                    new=spelt(_across(right)), old=spelt(right)
                )
                yield step("transposed", does, 1.17, (right, _across(right)))
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
    return _name(node.value if isinstance(node, ast.Attribute) else node) in ("R", "R_")


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
        yield step("sign", does, 1.1, (x[0], _minus(x[0])))
    elif name == "solve":
        matrix, other = spelt(x[0]), x[1]
        plain, turned = ast.BinOp(x[0], ast.MatMult(), other), _across(x[0])
        does = _("has {matrix} for its inverse {matrix}^-1").format(matrix=matrix)
        yield step("inverse", does, 1.05, (node, plain))
        does = _("has {new} for {old} (transposed)").format(new=spelt(turned), old=matrix)
        yield step("transposed", does, 1.1, (node, ast.Call(node.func, [turned, other], [])))
        does = _("has the transpose {matrix}^T for the inverse {matrix}^-1").format(matrix=matrix)
        yield step("inverse", does, 1.05, (node, ast.BinOp(turned, ast.MatMult(), other)))
    elif name == "inv":
        does = _("has {matrix} for its inverse {matrix}^-1").format(matrix=spelt(x[0]))
        yield step("inverse", does, 1.05, (node, x[0]))
    elif name in ("ikj", "jki"):
        yield step(
            "Christoffel",
            _("has {new} for {old}").format(new="dM_ij/dq_k", old=_told(node)),
            1.1,
            (node, x[0]),
        )
        other = ast.Call(ast.Name("jki" if name == "ikj" else "ikj"), x, [])
        yield step(
            "Christoffel",
            _("has {new} for {old}").format(new=_told(other), old=_told(node)),
            1.1,
            (node, other),
        )


def _turned(node: ast.Subscript, step: Make) -> Iterator[Step]:
    """What is in the link's axes already, rotated once more."""
    turn = ast.Subscript(ast.Name("R"), node.slice)
    for one, two in ((turn, _across(turn)), (_across(turn), turn)):
        new: ast.expr = ast.BinOp(one, ast.MatMult(), again(node))
        if _name(node) == "I":
            new = ast.BinOp(new, ast.MatMult(), two)
        does = _("rotates {what} ({new} for {old})").format(
            what=_meant(node), new=spelt(new), old=spelt(node)
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
        yield Step("slide as hinge", _("treats a slide (prismatic joint) as a hinge (revolute)"),
                   tuple((node, node.body) for node in nodes), 1.0)  # fmt: skip
        yield Step("hinge as slide", _("treats a hinge (revolute) as a slide (prismatic joint)"),
                   tuple((node, node.orelse) for node in nodes), 1.15)  # fmt: skip


def _entries(node: ast.List, step: Make) -> Iterator[Step]:
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
                ).format(row=r + 1, column=c + 1, new=spelt(_minus(entry)), old=text)
                yield step("sign", does, 1.02, (entry, _minus(entry)))
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
        negative = [(x, _minus(x)) for x in row if _minus(x) is not x and spelt(x)[0] == "-"]
        if len(negative) > 1:
            does = _("leaves the minus sign out in row {row} of the matrix").format(row=r + 1)
            yield step("sign", does, 1.1, *negative)


_AS_IN = {
    "standard": N_("{does} (as in the standard convention, {new} for {old})"),
    "modified": N_("{does} (as in the modified convention, {new} for {old})"),
}


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
    index = {id(y) for x in ast.walk(whole) if isinstance(x, ast.Subscript)
             for y in ast.walk(x.slice)}  # fmt: skip
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
                        what=_which(chosen[0], new),
                        new=spelt(new, True),
                        old=spelt(chosen[0], True),
                    )
                else:
                    does = _("has {new} for {old} ({what} for {other})").format(
                        new=spelt(new),
                        old=spelt(chosen[0]),
                        what=_meant(new),
                        other=_meant(chosen[0]),
                    )
                yield step(kind, does, cost + extra, *((x, again(new)) for x in chosen))


def _instead(
    node: ast.expr, shapes: Mapping[str, tuple[int, ...]], axes: tuple[int, ...], wide: bool
) -> Iterator[tuple[ast.expr, str, float]]:
    name = _name(node)
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


def _which(old: ast.expr, new: ast.expr) -> str:
    """Of which joint or link: the one before, or the next."""
    assert isinstance(old, ast.Subscript)
    assert isinstance(new, ast.Subscript)
    name = _name(new)
    thing = "joint" if name == "z" else "frame" if name in ("o", "o_", "T", "R_") else "link"
    one, two = ast.unparse(old.slice), ast.unparse(new.slice)
    back = "- 1" in two or ("+ 1" in one and "+ 1" not in two)
    words = {
        ("joint", True): _("{what} of the joint before"),
        ("joint", False): _("{what} of the next joint"),
        ("frame", True): _("{what} of the frame before"),
        ("frame", False): _("{what} of the next frame"),
        ("link", True): _("{what} of the link before"),
        ("link", False): _("{what} of the next link"),
    }
    return words[thing, bool(back)].format(what=_meant(new))


# -------- expressions


def _minus(node: ast.expr) -> ast.expr:
    if isinstance(node, ast.BinOp) and isinstance(node.left, ast.UnaryOp):
        return ast.BinOp(node.left.operand, node.op, node.right)
    return node.operand if isinstance(node, ast.UnaryOp) else ast.UnaryOp(ast.USub(), again(node))


def _times(factor: float, node: ast.expr) -> ast.expr:
    return ast.BinOp(ast.Constant(factor), ast.Mult(), again(node))


def _across(node: ast.expr) -> ast.expr:
    return ast.Attribute(again(node), "T")


def _name(node: ast.expr) -> str:
    if isinstance(node, ast.Subscript):
        node = node.value
    return node.id if isinstance(node, ast.Name) else ""


def _meant(node: ast.expr) -> str:
    found = MEANT.get(_name(node))
    return spelt(node) if found is None else _(found)


def _told(node: ast.expr) -> str:
    """A term, with what it is called."""
    text = spelt(node)
    called = _KNOWN.get(text, MEANT.get(_name(node), ""))
    return f"{text} ({_(called)})" if called and called != text else text


def spelt(node: ast.expr, indexed: bool = False) -> str:
    """An expression as textbooks write it."""
    if isinstance(node, ast.Constant):
        return f"{float(str(node.value)):g}"
    if isinstance(node, ast.Subscript):
        name = spelt(node.value)
        index = ast.unparse(node.slice).replace(" ", "")
        return (
            name if not indexed else f"{name}_{index}" if len(index) == 1 else f"{name}_({index})"
        )
    if isinstance(node, ast.Name):
        return _SPELT.get(node.id, node.id)
    if isinstance(node, ast.Attribute):
        return f"{_closed(node.value, indexed)}^T"
    if isinstance(node, ast.UnaryOp):
        return f"-{_closed(node.operand, indexed)}"
    if isinstance(node, ast.Call):
        assert isinstance(node.func, ast.Name)
        if node.func.id == "cross":
            return " x ".join(_closed(x, indexed) for x in node.args)
        if node.func.id in ("ikj", "jki"):
            return f"D_{node.func.id}"
        if node.func.id == "solve":
            return f"{spelt(node.args[0])}^-1 {_closed(node.args[1], indexed)}"
        return f"{node.func.id}({', '.join(spelt(x, indexed) for x in node.args)})"
    if isinstance(node, ast.BinOp):
        if _is_sum(node):
            sign = "+" if isinstance(node.op, ast.Add) else "-"
            return f"{spelt(node.left, indexed)} {sign} {spelt(node.right, indexed)}"
        joint = {ast.MatMult: " ", ast.Mult: "*", ast.Div: "/", ast.Pow: "**"}[type(node.op)]
        one: ast.expr | None = (
            node.left if isinstance(node.left, ast.BinOp) and not _is_sum(node.left) else None
        )
        if isinstance(node.left, ast.UnaryOp):
            one = node.left
        left = spelt(one, indexed) if one is not None else _closed(node.left, indexed)
        loose = isinstance(node.right, ast.Call) and isinstance(node.op, ast.Mult)
        right = spelt(node.right, indexed) if loose else _closed(node.right, indexed)
        return f"{left}{joint}{right}"
    return spelt(node.body, indexed) if isinstance(node, ast.IfExp) else ast.unparse(node)


def _closed(node: ast.expr, indexed: bool) -> str:
    """In parentheses where it is more than a name."""
    text = spelt(node, indexed)
    plain = isinstance(node, ast.Name | ast.Subscript | ast.Constant | ast.Attribute)
    call = isinstance(node, ast.Call) and " x " not in text and " " not in text
    return text if plain or call else f"({text})"
