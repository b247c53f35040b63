"""Names and attributes of a program otherwise."""

from __future__ import annotations

import ast
import re
from collections.abc import Iterator

from kinlab.doctor.bytecode.syntax import factors, text_of
from kinlab.doctor.program.edits.scope.counters import counters_around
from kinlab.doctor.program.edits.scope.forms import Turned, block_of, statement_of
from kinlab.doctor.program.edits.scope.functions import PI
from kinlab.doctor.program.edits.scope.part import Scope
from kinlab.doctor.program.edits.single.constants import OF_RODS
from kinlab.doctor.program.edits.single.entries import is_of_three
from kinlab.doctor.program.observed import Observed
from kinlab.doctor.program.places import Here, ProgramEdit, root

_FEW = 8
"""Attributes among which a wrong one is looked for early."""
_OF_ITS_MASS = 0.015
"""What it costs less where the mass of its link stands beside it."""
_AT_THE_END = 0.08
"""What a length costs more that would carry the mass of its own link, as its centre does."""
_OF_ROD = 0.04
"""What that costs more in a rod's moment of inertia, whose number is as soon mistaken."""
_OF_ANOTHER = 0.1
"""What the distance of a centre costs more that would carry the mass of another link alone."""
_ENTRY, _ENTRY_NEAR = 1.16, 1.2
"""Cost of an entry of what stands in the same line, or in one beside it, for a name."""
_HALF = 1.03
"""Cost of a length for the distance of the centre, where that is half of it, or that for it."""
_OF_THE_TURN = 1.06
"""Cost of a row's entry for the row itself, in a product in a loop: ``dJ*v[k]``."""
_COUNTERS = 1.08
"""Cost of one loop's counter for another's."""
_NUMBERED = 1.07
"""Cost of a name for another that differs from it by a number."""
_ADDEND = 1.06
"""Cost of one of two that a name is the sum of: the joint's rate for the link's."""
_IDLE = 1.03
"""Cost of a vector, or a matrix, that is set and used nowhere for another: ``force``."""
_IDLE_NUMBER = 1.06
"""The same of a number that moves: ``w`` of ``w += rate``."""
_COPIED = 1.15
"""Cost of another vector for one that is kept under another name: ``last = p``."""
_IN_BLOCK = 1.13
"""Cost of a row for another whose entry is taken in the same way in the lines around."""
_IN_LINE = 1.12
"""Cost of a name for another that stands in the same line."""


def of_name(here: Here, scope: Scope, observed: Observed, index: bool) -> Iterator[ProgramEdit]:
    node = here.node
    shape = observed.shape(node)
    if shape is None:
        return
    if index:
        for other in scope.whole:
            if other != node.id and not is_of_three(here, other):
                both = other in scope.counters and node.id in scope.counters
                cost = _COUNTERS if both else _IN_LINE
                yield here.instead(ast.Name(other, ast.Load()), "index", cost)
        return
    if node.id in scope.arcs and scope.has_numpy:
        yield here.instead(ast.BinOp(PI, ast.Sub(), node), "argument", 1.12)
    across = Turned(scope.shapes).visit_Name(node).id
    copied = bool(shape) and isinstance(here.parent, ast.Assign) and here.field == "value"
    taken, around = _taken_around(here)
    for other, known in scope.shapes.items():
        if other != node.id and known == shape and other not in scope.counters:
            near = _alike(other, node.id)
            kind = "index" if near and _letters(other) == _letters(node.id) else "name"
            beside = other in scope.beside.get(node.id, ())
            cost = 1.1 if near else 1.14 if beside else _COPIED if copied else 1.25
            digits = node.id[len(_letters(node.id)) :]
            cost = _NUMBERED if kind == "index" and len(digits) == 1 else cost
            if cost > _IN_BLOCK and f"{other}{taken}" in around:
                cost = _IN_BLOCK
            if cost > _IN_LINE and other in scope.names_in(statement_of(here.above)):
                cost = _IN_LINE  # of what stands in one line one is taken for another
            if scope.are_halves(other, node.id):
                cost = _HALF + _OF_ROD * _in_a_rods_moment(here)
                of_mass = _is_of_the_mass(here, other)
                longer = abs(scope.level_of(other)) > abs(scope.level_of(node.id))
                cost += (_AT_THE_END if longer else -_OF_ITS_MASS) * of_mass
                cost += _OF_ANOTHER * _is_a_centre_of_another(here, scope, other)
            elif _carries_another(here, other):
                cost = _HALF
            if other == across and {other, node.id} <= scope.sines:
                kind, cost = "sin/cos", 1.04
            if other in scope.unused:
                idle = _IDLE if shape else cost if scope.level_of(other) else _IDLE_NUMBER
                cost = min(cost, idle)
            yield here.instead(ast.Name(other, ast.Load()), kind, cost)
    if shape == ():
        yield from _entries_beside(here, scope)
    if len(shape) == 1 and isinstance(getattr(here.parent, "op", None), ast.Mult):
        for counter in counters_around(here, scope.counting):
            one = ast.Subscript(node, ast.Name(counter, ast.Load()), ast.Load())
            yield here.instead(one, "index", _OF_THE_TURN)
    if shape and not isinstance(here.parent, ast.Subscript | ast.Attribute):
        for text, entry in scope.simple(shape):  # an entry of a list by a counter
            if isinstance(entry, ast.Subscript) and text != node.id:
                yield here.instead(entry, "name", 1.2)
    if isinstance(here.parent, ast.Subscript) and here.field == "value" and shape:
        for other, entries in scope.lists.items():
            if other != node.id and entries == shape[1:] and scope.shapes.get(other) != shape:
                cost = 1.15 if _alike(other, node.id) else 1.2
                yield here.instead(ast.Name(other, ast.Load()), "name", cost)


def _taken_around(here: Here) -> tuple[str, set[str]]:
    """How an entry of a row is taken, ``[i]``, and all that stands so in the lines around."""
    if not isinstance(here.parent, ast.Subscript) or here.field != "value":
        return "", set()
    taken = f"[{ast.unparse(here.parent.slice)}]"
    lines = " ".join(map(text_of, block_of(here.above)[0]))
    return taken, {*re.findall(rf"[A-Za-z_]\w*{re.escape(taken)}", lines)}


def _entries_beside(here: Here, scope: Scope) -> Iterator[ProgramEdit]:
    """An entry of what stands in the same line, for a name: ``crank["c"][i]`` for l1."""
    read = scope.names_in(statement_of(here.above))
    block, at = block_of(here.above)
    lines = [*block[max(at - 1, 0) : at], *block[at + 1 : at + 2]]
    near = {name for line in lines for name in scope.names_in(line)} - {*read}
    for _text, entry in scope.simple(()):
        if isinstance(entry, ast.Subscript) and root(entry) in read:
            yield here.instead(entry, "name", _ENTRY)
        elif isinstance(getattr(entry, "slice", None), ast.Constant) and root(entry) in near:
            yield here.instead(entry, "name", _ENTRY_NEAR)
    for entry in scope.summed_from.get(here.node.id, ()):
        yield here.instead(entry, "name", _ADDEND)


def _is_a_centre_of_another(here: Here, scope: Scope, name: str) -> bool:
    """Whether a centre's distance, half a length, would carry the mass of another link alone."""
    masses = {one[len(_letters(one)) :] for one in _masses_beside(here)}
    half = abs(scope.level_of(name)) < abs(scope.level_of(here.node.id))
    return half and bool(masses) and name[len(_letters(name)) :] not in masses


def _carries_another(here: Here, length: str) -> bool:
    """Whether a centre's distance carries another link's mass, as lengths do: ``m2*lc1``."""
    own = here.node.id
    centre = own != length and own.replace("c", "", 1) == length
    masses = {one[len(_letters(one)) :] for one in _masses_beside(here)}
    return centre and bool(masses) and own[len(_letters(own)) :] not in masses


def _is_of_the_mass(here: Here, name: str) -> bool:
    """Whether a name has the number of a mass that it is multiplied with: ``m2*l1*lc2``."""
    own = name[len(_letters(name)) :]
    return own != "" and any(one[len(_letters(one)) :] == own for one in _masses_beside(here))


def _masses_beside(here: Here) -> list[str]:
    """The masses that a name is multiplied with, alone or in a sum."""
    found: list[ast.expr] = []
    inner: ast.AST = here.node
    for above in reversed(here.above):
        if isinstance(above, ast.BinOp) and isinstance(above.op, ast.Mult):
            found += factors(above.left if above.right is inner else above.right)
        elif not isinstance(above, ast.BinOp | ast.UnaryOp):
            break
        inner = above
    parts = (x.operand if isinstance(x, ast.UnaryOp) else x for x in found)
    return [x.id for x in parts if isinstance(x, ast.Name) and x.id[0] in "mM"]


def _in_a_rods_moment(here: Here) -> bool:
    """Whether it stands in ``m*l**2/12`` or in ``m*l**2/3``, or is gone through for that."""
    divided = [one for one in here.above if isinstance(one, ast.BinOp)]
    for one in here.above:
        if isinstance(one, ast.ListComp | ast.GeneratorExp) and isinstance(one.elt, ast.BinOp):
            divided.append(one.elt)
    below = (one.right for one in divided if isinstance(one.op, ast.Div))
    return any(isinstance(one, ast.Constant) and one.value in OF_RODS for one in below)


def _letters(name: str) -> str:
    return name.rstrip("0123456789")


def _alike(one: str, other: str) -> bool:
    """Names that are easily mistaken: of one first letter, or of one number."""
    same = one[0].lower() == other[0].lower() or _letters(one)[-1:] == _letters(other)[-1:]
    return same or one[len(_letters(one)) :] == other[len(_letters(other)) :] != ""


def of_attribute(here: Here, scope: Scope, observed: Observed) -> Iterator[ProgramEdit]:
    """Another attribute of the same object: ``arm.r`` for ``arm.l``."""
    node = here.node
    shape = observed.shape(node)
    if shape is None:
        return
    for one, other in (("real", "imag"), ("imag", "real")):
        if node.attr == one:
            yield here.within(node, "attr", other, "function", 1.05)
    if not isinstance(node.value, ast.Name | ast.Subscript | ast.Attribute):
        return
    product = isinstance(getattr(here.parent, "op", None), ast.MatMult)
    for other, known in scope.attributes.items():
        if other != node.attr and known == shape:
            cost = 1.07 if _alike(other, node.attr) else 1.15
            cost = 1.05 if len(scope.attributes) <= _FEW else cost
            yield here.within(node, "attr", other, "name", cost)
        elif other != node.attr and product:
            yield here.within(node, "attr", other, "name", 1.15)
    for _text, piece in scope.simple(shape):
        if isinstance(piece, ast.Attribute) and ast.dump(piece.value) != ast.dump(node.value):
            cost = 1.12 if piece.attr == node.attr else 1.15  # of another object
            yield here.instead(piece, "name", cost)
    for other, known in scope.shapes.items():
        if known == shape and other not in scope.counters and shape == ():
            cost = 1.2 if other[:1].lower() == node.attr[:1].lower() else 1.25
            yield here.instead(ast.Name(other, ast.Load()), "name", cost)
