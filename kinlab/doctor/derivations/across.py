"""What one can do otherwise in several lines of a derivation at once.

A slide treated as a hinge; the data, the axis or the rotation of another link; a rotation
transposed or left out everywhere; a loop one link short; lines exchanged; halves exchanged.
"""

from __future__ import annotations

import ast
from collections.abc import Iterator, Mapping

from kinlab.doctor.bytecode.syntax import nodes, text_of
from kinlab.doctor.derivations.operations import turns, without_own
from kinlab.doctor.derivations.walk import Assignment, Program, Step, again
from kinlab.doctor.derivations.words import (
    halves,
    is_sum,
    meant,
    name_of,
    shifted,
    spelt,
    times,
    together,
    which,
)
from kinlab.host.language import N_, _

_LINES = 2
"""Lines of a loop up to which it is called by what they make."""


def everywhere(of: Program) -> Iterator[Step]:
    """What stands in every line, or in every column, taken otherwise."""
    yield from _everywhere(of)
    yield from _halves_exchanged(of)


def across(of: Program, axes: Mapping[int, tuple[int, ...]], n: int) -> Iterator[Step]:
    """What two lines or more have in common, taken otherwise.

    Args:
        of: the derivation.
        axes: the shape of each of its expressions at one state.
        n: number of joints.
    """
    yield from _updated(of, axes)
    yield from _not_turned(of, axes)
    yield from _short_loops(of, axes, n)
    yield from _other_axes(of)
    yield from _other_links(of)
    yield from _in_base(of)
    yield from _after_product(of)


def slides(of: Program) -> Iterator[Step]:
    """A slide treated as a hinge in every line, and the other way; every link without its joint."""
    every = [
        node
        for line in of.lines
        if line.about
        for node in nodes(line.statement)
        if isinstance(node, ast.IfExp)
    ]
    asking = [node for node in every if isinstance(node.test, ast.Subscript)]
    if len(asking) > 1:
        yield Step(
            "slide as hinge",
            _("treats a slide (prismatic joint) as a hinge (revolute)"),
            tuple((node, node.body) for node in asking),
            1.0,
        )
        yield Step(
            "hinge as slide",
            _("treats a hinge (revolute) as a slide (prismatic joint)"),
            tuple((node, node.orelse) for node in asking),
            1.15,
        )
    bounded = [node for node in every if isinstance(node.test, ast.Compare)]
    if len(bounded) > 1:
        does = _("leaves the link's own joint out (j < i for j <= i)")
        yield Step("own joint", does, tuple((x, without_own(x)) for x in bounded), 1.02)
    inner = [x for x in bounded if text_of(x.test) == "j <= k"]
    if len(inner) > 1:
        does = _("gives every joint a column, also those behind the link")
        yield Step("sum", does, tuple((x, x.body) for x in inner), 1.05)
        for does, one, op, two in (
            (
                _("has a column for the link's own joint only, none for the joints before"),
                "j",
                ast.Eq(),
                "k",
            ),
            (
                _("has columns for the joints from the link on, none for those before"),
                "k",
                ast.LtE(),
                "j",
            ),
        ):
            test = ast.Compare(ast.Name(one), [op], [ast.Name(two)])
            edits = tuple((x, ast.IfExp(test, x.body, x.orelse)) for x in inner)
            yield Step("sum", does, edits, 1.06)


def _everywhere(of: Program) -> Iterator[Step]:
    """The data of another link, or a rotation transposed, in every line where it stands."""
    assigned = {name_of(target) for line in of.lines for target in line.statement.targets}
    places: dict[str, list[tuple[int, ast.expr]]] = {}
    for number, line in enumerate(of.lines):
        for node in nodes(line.statement.value) if line.about else ():
            turned = isinstance(node, ast.Attribute) and name_of(node.value) == "R"
            if turned or (isinstance(node, ast.Subscript) and isinstance(node.slice, ast.Name)):
                assert isinstance(node, ast.expr)
                places.setdefault(text_of(node), []).append((number, node))
    in_every = _("{does} in every line")
    for found in places.values():
        if len({number for number, _node in found}) < 2:
            continue
        node = found[0][1]
        if isinstance(node, ast.Attribute):
            does = _("has {new} for {old} (not transposed)").format(
                new=spelt(node.value), old=spelt(node)
            )
            plain = tuple((x, x.value) for _n, x in found if isinstance(x, ast.Attribute))
            yield Step("transposed", in_every.format(does=does), plain, 1.0)
            continue
        assert isinstance(node, ast.Subscript)
        if name_of(node) in assigned or name_of(node) in ("hinge", "R", "z"):
            continue
        for shift in (-1, 1):
            index = shifted(node.slice, shift)
            assert index is not None
            new = ast.Subscript(node.value, index)
            does = _("takes {what} ({new} for {old})").format(
                what=which(node, new), new=spelt(new, True), old=spelt(node, True)
            )
            edits = tuple((x, again(new)) for _n, x in found)
            yield Step("index", in_every.format(does=does), edits, 1.05)


def _other_axes(of: Program) -> Iterator[Step]:
    """Axis and origin of the frame before or behind, in every line; another axis of the frame."""
    places: dict[str, list[ast.Subscript]] = {"z": [], "o": []}
    for line in of.lines:
        for node in nodes(line.statement.value) if line.about else ():
            if isinstance(node, ast.Subscript) and name_of(node) in places:
                places[name_of(node)].append(node)
    if not places["z"] or not places["o"]:
        return
    for shift in (-1, 1):
        edits = []
        for node in (*places["z"], *places["o"]):
            index = shifted(node.slice, shift)
            if index is not None:
                edits.append((node, ast.Subscript(node.value, index)))
        words = (
            N_("takes the axis z and the origin o of the frame before"),
            N_("takes the axis z and the origin o of the next frame"),
        )
        yield Step("index", _(words[shift > 0]), tuple(edits), 1.04)
    for axis in "xy":
        edits = [(node, ast.Subscript(ast.Name(axis + "_"), node.slice)) for node in places["z"]]
        does = _("takes the frame's axis {axis} for the joint's axis z").format(axis=axis)
        yield Step("another quantity", does, tuple(edits), 1.12)


def _other_links(of: Program) -> Iterator[Step]:
    """Rotation and place of the link before or behind, in every line where they stand together."""
    places: dict[str, list[ast.Subscript]] = {}
    for line in of.lines:
        for node in nodes(line.statement.value) if line.about else ():
            if isinstance(node, ast.Subscript) and name_of(node) in ("R", "P"):
                places.setdefault(text_of(node.slice), []).append(node)
    words = {
        ("R", -1): N_("takes the rotation R of the link before in every line"),
        ("R", 1): N_("takes the rotation R of the next link in every line"),
        ("P R", -1): N_(
            "takes the rotation R and the lever arm P of the link before in every line"
        ),
        ("P R", 1): N_("takes the rotation R and the lever arm P of the next link in every line"),
    }
    for found in places.values():
        for (names, shift), does in words.items():
            chosen = [node for node in found if name_of(node) in names.split()]
            index = shifted(found[0].slice, shift)
            if index is not None and {name_of(node) for node in chosen} == set(names.split()):
                edits = tuple((node, ast.Subscript(node.value, index)) for node in chosen)
                yield Step("index", _(does), edits, 1.06)


def _in_base(of: Program) -> Iterator[Step]:
    """What is asked for of every link, in the base's axes for the link's."""
    turn = ast.parse("R_[i]", mode="eval").body
    for line in of.lines:
        if text_of(line.statement.targets[0]) == "asked[i]":
            value = line.statement.value
            parts = value.args if isinstance(value, ast.Call) else [value]
            edits = tuple((x, ast.BinOp(turn, ast.MatMult(), again(x))) for x in parts)
            yield Step("frame", _("answers in base axes, not in the link's axes"), edits, 1.0)


def _after_product(of: Program) -> Iterator[Step]:
    """What a loop inward multiplies up, taken after the link's own matrix and not before."""
    for loop in of.body:
        if not isinstance(loop, ast.For) or text_of(loop.iter) != "inward":
            continue
        lines = [line for line in of.lines if line.statement in loop.body]
        made = {text_of(line.statement.targets[0]): line for line in lines}
        products = {
            name: line
            for name, line in made.items()
            if name.replace("i]", "i + 1]") in text_of(line.statement.value)
            and "R[i" in text_of(line.statement.value)
        }
        for name, line in made.items():
            edits = []
            for node in nodes(line.statement.value) if name not in products else ():
                if isinstance(node, ast.Subscript) and text_of(node) in products:
                    text = text_of(products[text_of(node)].statement.value)
                    text = text.replace("[i]", "[i-1]").replace("[i + 1]", "[i]")
                    edits.append((node, ast.parse(text, mode="eval").body))
            if edits:
                does = _("takes {line} after the product with the link's own matrix, not before")
                yield Step("order", does.format(line=_(line.about)), tuple(edits), 1.08)


def _short_loops(of: Program, axes: Mapping[int, tuple[int, ...]], n: int) -> Iterator[Step]:
    """Loops that leave their first or last joint out: what they make stays zero there."""
    for loop in (x for statement in of.body for x in nodes(statement)):
        if not isinstance(loop, ast.For) or n < 2:
            continue
        lines = [line for line in of.lines if line.statement in loop.body]
        told_of = list(dict.fromkeys(_(line.about) for line in lines if line.about))
        edits = []
        for line in lines:
            value, target = line.statement.value, line.statement.targets[0]
            if id(value) not in axes:
                continue
            sums = isinstance(target, ast.Name) and text_of(target) in text_of(value)
            edits.append((value, again(target) if sums else times(0, value)))
        if not told_of or not edits:
            continue
        yield from _not_carried(loop, lines, n)
        for joint in (1, n):
            does = _("leaves link {number} out of the loop that gives {line}: it is one too short")
            if len(told_of) > _LINES:  # of so many, what is asked may be another
                does = _("leaves link {number} out of the loop over the links: it is one too short")
            said = does.format(number=joint, line=together(told_of[-2:]))
            yield Step("loop", said, tuple(edits), 1.12, joint)


def _not_carried(loop: ast.For, lines: list[Assignment], n: int) -> Iterator[Step]:
    """Inward loops that begin or end one link short: what comes from the next link is left out."""
    carried = tuple(
        (part, times(0, part))
        for line in lines
        for node in nodes(line.statement.value)
        if isinstance(node, ast.expr) and is_sum(node)
        for part in halves(node)
        if not is_sum(part) and "i + 1" in text_of(part)
    )
    if carried and text_of(loop.iter) == "inward":
        late = _("does not carry the last link's part inward: the loop begins one link too late")
        early = _("carries nothing inward to the first link: the loop ends one link too early")
        alone = _("has each link's own part alone: carries nothing inward from the links behind")
        yield Step("sum", alone, carried, 1.1)
        yield Step("loop", late, carried, 1.1, n - 1)
        yield Step("loop", early, carried, 1.1, 1)


def _not_turned(of: Program, axes: Mapping[int, tuple[int, ...]]) -> Iterator[Step]:
    """A rotation left out wherever it stands."""
    places: dict[str, list[ast.BinOp]] = {}
    for line in of.lines:
        for node in nodes(line.statement.value) if line.about else ():
            if not (isinstance(node, ast.BinOp) and isinstance(node.op, ast.MatMult)):
                continue
            if turns(node.left) and len(axes.get(id(node.right), ())) == 1:
                places.setdefault(spelt(node.left, True), []).append(node)
    for factor, found in places.items():
        if len(found) > 1:
            does = _("leaves the rotation {factor} out in every line").format(factor=factor)
            edits = tuple((node, node.right) for node in found)
            yield Step("rotation left out", does, edits, 1.08)


def _halves_exchanged(of: Program) -> Iterator[Step]:
    """The angular part above the linear one, in every column."""
    calls = [
        node
        for line in of.lines
        if line.about
        for node in nodes(line.statement.value)
        if isinstance(node, ast.Call) and name_of(node.func) == "twist"
    ]
    if calls:
        edits = tuple((x, ast.Call(x.func, [x.args[1], x.args[0]], [])) for x in calls)
        yield Step("row order", _("has the angular rows first"), edits, 1.0)


def _updated(of: Program, axes: Mapping[int, tuple[int, ...]]) -> Iterator[Step]:
    """The link's own new value where that of the link before is meant: two lines exchanged."""
    for loop in of.body:
        if not isinstance(loop, ast.For):
            continue
        lines = [line for line in of.lines if line.statement in loop.body]
        made = [text_of(target) for line in lines for target in line.statement.targets]
        for k, line in enumerate(lines):
            for later in lines[k + 1 :]:
                name = text_of(later.statement.targets[0])
                if made.count(name) != 1:
                    continue
                before = name.replace("[i]", "[i-1]").replace("-", " - ")
                edits = tuple(
                    (node, again(later.statement.value))
                    for node in nodes(line.statement.value)
                    if isinstance(node, ast.Subscript)
                    and text_of(node) == before
                    and id(node) in axes
                )
                if edits:
                    does = _(
                        "takes {what} of the link itself for that of the link before in {line}: it "
                        "is renewed too early"
                    ).format(what=meant(edits[0][0]), line=_(line.about))
                    yield Step("order of lines", does, edits, 1.08)
