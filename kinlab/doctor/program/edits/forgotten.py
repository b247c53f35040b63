"""What is forgotten as one writes: a term of two names, a vector behind its number, a moment."""

from __future__ import annotations

import ast
from collections.abc import Iterator, Sequence
from functools import reduce
from itertools import combinations, permutations

import numpy as np

from kinlab.doctor.bytecode.syntax import called, copied, factors, names, nodes, text_of
from kinlab.doctor.program.edits.additions import OtherAxis, summed
from kinlab.doctor.program.edits.exchanges import Renamed
from kinlab.doctor.program.edits.scope.forms import Turned, block_of, named, summands
from kinlab.doctor.program.edits.scope.part import Scope
from kinlab.doctor.program.edits.single.entries import keys_of
from kinlab.doctor.program.edits.single.whole import whole_constant
from kinlab.doctor.program.observed import Shape
from kinlab.doctor.program.places import ANGLES, Here, ProgramEdit, number, written_into

_FORCES = ("f", "F")
"""How names of forces begin."""
_RATES = ("w", "o", "W", "O")
"""How names of angular velocities begin."""
_ARMS = ("p", "P", "r", "c", "C", "l", "L", "d", "s")
"""How names of what leads from one point to another begin."""
_VECTOR, _TWIST, _HOMOGENEOUS = (3,), (6,), (4,)
_DIAGONAL = 1.06
"""What it is to forget what is used nowhere on a diagonal."""
_IDLE_DIAGONAL = 0.96
"""The same where the matrix is given on."""
_BESIDE_A_LIST = 1.06
"""Cost of a term with an array that nothing uses, beside a list."""
_LINES, _AS_BESIDE = 3, 1.07
"""Lines above and below that are like one; cost of a number that these end with."""
_FEW = 8
"""Names of one kind that are tried."""
_BOTH, _INDICES = 2, 3
"""Terms of Christoffel's symbol that are there, where the third is lost; their indices."""
_SUMS = ast.Add | ast.Sub
_SET = ast.Assign | ast.AugAssign | ast.Return


def of_forgotten(here: Here, scope: Scope, shape: Shape) -> Iterator[ProgramEdit]:
    """What may have been forgotten beside an expression."""
    node, parent = here.node, here.parent
    if isinstance(node, ast.Constant | ast.List | ast.Tuple):
        return
    op = parent.op if isinstance(parent, ast.BinOp) else None
    given = isinstance(parent, ast.Call) and called(parent) not in ANGLES and here.field != "func"
    if given or isinstance(op, ast.Mult) or isinstance(parent, ast.List | ast.Tuple):
        yield from _under_a_wave(here, scope, shape)
    if shape == ():
        if isinstance(node, ast.BinOp) and not isinstance(op, _SUMS):
            yield from _with_indices_exchanged(here, scope)
            yield from _half_of_its_own(here, scope)
        if isinstance(parent, ast.List | ast.Tuple) or _is_entry(parent):
            yield here.instead(number(0.0), "extra term", 1.18)
        if isinstance(op, _SUMS):
            yield from _with_vectors(here, scope)
            for dot in scope.dots.values():
                yield here.instead(ast.BinOp(node, ast.Mult(), dot), "missing factor", 1.12)
        if isinstance(parent, _SET):
            yield from _energies(here, scope)
            yield from _of_all_joints(here, scope)
            yield from _as_in_lines_beside(here)
        if isinstance(parent, _SET | ast.List | ast.Tuple):
            yield from _crosswise(here)
        if isinstance(parent, ast.List | ast.Tuple):
            yield from _as_beside(here, parent.elts)
        if isinstance(parent, _SET) or isinstance(op, ast.Mult):
            yield from _of_idle_numbers(here, scope)
        if isinstance(op, _SUMS) and isinstance(node, ast.BinOp):
            yield from _part_across(here, scope)
        wave = isinstance(node, ast.Call) and called(node) == "cos"
        wave = wave or (isinstance(node, ast.Name) and node.id in scope.sines)
        if isinstance(op, ast.Mult) and wave:
            yield here.instead(ast.BinOp(number(1), ast.Sub(), node), "missing term", 1.1)
        if isinstance(op, ast.Mult) and not isinstance(node, ast.Name | ast.Call):
            yield from _inside_products(here, scope)
        if isinstance(node, ast.BinOp) and isinstance(node.op, _SUMS) and not isinstance(op, _SUMS):
            yield from _of_the_third(here, scope)
        yield from _of_another_row(here, scope)
        yield from _of_the_point(here, scope)
        return
    if isinstance(node, ast.Call) and called(node) == "zeros" and len({*shape}) == 1 < len(shape):
        yield from _with_a_diagonal(here, scope, shape[0])
    if isinstance(node, ast.Name) and len({*shape}) == 1 < len(shape):
        yield from _less_a_diagonal(here, scope, shape[0])
    if isinstance(node, ast.Call) and called(node) == "zeros" and len(shape) == 1:
        yield from _of_unread_rows(here, scope, shape)
    if isinstance(node, ast.Call) and called(node) == "zeros" and not _is_filled(here):
        for _text, vector in scope.simple(shape):
            if not isinstance(getattr(vector, "slice", None), ast.Tuple):  # a part of a matrix
                yield here.instead(vector, "name", 1.12)
    if shape == _VECTOR and scope.has_numpy and isinstance(parent, ast.List | ast.Tuple):
        zeros = ast.Attribute(ast.Name("np", ast.Load()), "zeros", ast.Load())
        nothing = ast.Call(zeros, [ast.Constant(_VECTOR[0])], [])
        yield here.instead(nothing, "extra term", 1.15)
    if shape == _VECTOR and isinstance(node, ast.Subscript):
        yield from _of_idle_points(here, scope)
    if isinstance(op, _SUMS):
        yield from _with_angles(here, scope)
    if len(shape) == 1 and scope.has_numpy and isinstance(parent, ast.BinOp):
        yield from _as_a_diagonal(here, scope, shape)
    if len(shape) == 1 and isinstance(parent, _SET):
        yield from _of_idle_numbers_along(here, scope, shape)
    if len(shape) == 1 and isinstance(op, ast.Mult) and isinstance(node, ast.Name | ast.Subscript):
        yield from _beside_in_a_product(here, scope, shape)
    if shape == _VECTOR and isinstance(op, ast.Add):
        yield from _turned_beside(here)
    if scope.has_numpy and len(shape) == 1 and isinstance(node, ast.Name | ast.Subscript):
        added = isinstance(parent, _SET) or isinstance(op, ast.Mult)
        outer = ast.Attribute(ast.Name("np", ast.Load()), "outer", ast.Load())
        yield from [here.instead(ast.Call(outer, [node] * 2, []), "product", 1.1)] * added
    if isinstance(op, ast.Mult) and isinstance(node, ast.BinOp):
        yield from _other_axes(here, scope, shape)
    if isinstance(parent, ast.Call) and here.holder is parent.args:
        yield from _by_unused(here, scope)
    yield from _calls(here, scope, shape)
    if shape == _TWIST and isinstance(node, ast.Call) and called(node) == "array":
        yield from _of_kinds(here, scope)
    if isinstance(parent, _SET):
        if shape == _VECTOR:
            yield from _moments(here, scope)
        if shape == _TWIST:
            yield from _of_twists(here, scope)
        if len(shape) == 2:
            yield from _turned_matrices(here, scope, shape)


def _less_a_diagonal(here: Here, scope: Scope, size: int) -> Iterator[ProgramEdit]:
    """A matrix that lacks on its diagonal what nothing uses, where it is given on."""
    if isinstance(here.parent, ast.Call | ast.Return):
        for text in _idle_diagonals(scope, size):
            diagonal = ast.parse(text, mode="eval").body
            new = ast.BinOp(here.node, ast.Add(), diagonal)
            yield here.instead(new, "missing term", _IDLE_DIAGONAL)


def _idle_diagonals(scope: Scope, size: int) -> list[str]:
    """Rows that nothing uses, each as a diagonal."""
    every = scope.shapes.items() if scope.has_numpy else ()
    return [f"np.diag({x})" for x, shape in every if x in scope.unused and shape == (size,)]


def _with_a_diagonal(here: Here, scope: Scope, size: int) -> Iterator[ProgramEdit]:
    """What nothing uses on the diagonal of a matrix that begins as zeros: the rotors' inertias."""
    if not scope.has_numpy:
        return
    idle = _idle_diagonals(scope, size)
    over = {pair for one in nodes(here.above[0]) for pair in _gone_through(one)}
    idle += [
        f"np.diag([{one}.{name} for {one} in {every}])"
        for name in sorted(scope.idle_attributes)
        if scope.attributes[name] == ()
        for one, every in sorted(over)
    ]
    for text in idle:
        yield here.instead(ast.parse(text, mode="eval").body, "missing term", _DIAGONAL)


def _gone_through(node: ast.AST) -> Iterator[tuple[str, str]]:
    """The names of what a loop takes, each with the name of the list that it takes it from."""
    if not isinstance(node, ast.For | ast.comprehension):
        return
    target, over = node.target, node.iter
    parts = target.elts if isinstance(target, ast.Tuple) else [target]
    given = over.args if isinstance(over, ast.Call) else [over]
    if isinstance(over, ast.Call) and called(over) == "enumerate":
        parts = parts[1:]
    for one, every in zip(parts, given, strict=False):
        if isinstance(one, ast.Name) and isinstance(every, ast.Name):
            yield one.id, every.id


def less_a_row(here: Here, scope: Scope) -> Iterator[ProgramEdit]:
    """Points less the point of a list that a loop has come to: ``c[j:] - o[j]`` for ``c[j:]``."""
    seen = scope.observed.of(here.node)
    points = seen is not None and bool(seen.values) and seen.values[0].shape[1:] == _VECTOR
    if not points or not isinstance(here.node.slice, ast.Slice):
        return
    for name, shape in scope.lists.items():
        if shape != _VECTOR or name in names(here.node):
            continue
        for counter in scope.counters:
            row = ast.Subscript(ast.Name(name, ast.Load()), ast.Name(counter, ast.Load()))
            row.ctx = ast.Load()
            cost = 1.05 if name in scope.unused else 1.14
            yield here.instead(ast.BinOp(here.node, ast.Sub(), row), "missing term", cost)


def across(here: Here) -> Iterator[ProgramEdit]:
    """The entry across from one that is set, forgotten: ``M[0, 1] = M[1, 0] = x``."""
    target = here.node.targets[0]
    every = [one for one in nodes(here.above[0]) if isinstance(one, ast.Assign)]
    filled = {ast.unparse(one) for line in every for one in line.targets}
    for i, j in combinations(range(len(keys_of(target))), 2):
        other = copied(target)
        (one, field, key), (last, place, behind) = (keys_of(other)[k] for k in (i, j))
        if not (whole_constant(key) and whole_constant(behind)):
            continue
        for holder, where, new in ((one, field, behind), (last, place, key)):
            if isinstance(holder, list):
                holder[where] = new
            else:
                setattr(holder, where, new)
        if ast.unparse(other) not in filled:
            yield here.within(here.node, "targets", [target, other], "missing entry", 1.08)


def _of_kinds(here: Here, scope: Scope) -> Iterator[ProgramEdit]:
    """A hinge's axis for any joint, of which a slide has the other half of its twist."""
    row = here.node.args[0] if here.node.args else None
    if not isinstance(row, ast.List | ast.Tuple) or len(row.elts) != _TWIST[0]:
        return
    half = _TWIST[0] // 2
    turned = ast.List([*row.elts[half:], *row.elts[:half]], ast.Load())
    other = ast.Call(here.node.func, [turned], [])
    for test in scope.tests_here():
        for both in ((here.node, other), (other, here.node)):
            yield here.instead(ast.IfExp(test, *both), "condition", 1.08)


def of_kinds_of_joints(here: Here, scope: Scope) -> Iterator[ProgramEdit]:
    """A rate that turns a link, for any joint, where a slide's moves it: ``v = v + qd[i]*z``."""
    node = here.node
    value = node.value
    if not isinstance(value, ast.BinOp) or not isinstance(value.op, ast.Add):
        return
    own, rate = node.targets[0], value.right
    if not isinstance(own, ast.Name) or not isinstance(rate, ast.BinOp):
        return
    shape = scope.shapes.get(own.id)
    if not shape or not isinstance(rate.op, ast.Mult):
        return
    for name, known in scope.shapes.items():
        if known == shape and name != own.id and scope.set_at.get(name, node.lineno) < node.lineno:
            moved = ast.BinOp(ast.Name(name, ast.Load()), ast.Add(), rate)
            other = ast.Assign([ast.Name(name, ast.Store())], moved)
            for test in scope.tests_here():
                for one, last in ((other, node), (node, other)):
                    yield here.instead(ast.If(test, [one], [last]), "condition", 1.1)


def _of_another_row(here: Here, scope: Scope) -> Iterator[ProgramEdit]:
    """An entry of a row that nothing uses, for one link: ``half[i] if i == k else L[i]``."""
    node = here.node
    if not isinstance(node, ast.Subscript) or not isinstance(node.slice, ast.Name):
        return
    for text, one in scope.simple(()):
        if isinstance(one, ast.Subscript) and scope.is_idle(one) and text != ast.unparse(node):
            if ast.dump(one.slice) != ast.dump(node.slice):
                continue
            for other in dict.fromkeys((*scope.counters, *scope.whole)):
                if other != node.slice.id:
                    last = ast.Name(other, ast.Load())
                    test = ast.Compare(node.slice, [ast.Eq()], [last])
                    yield here.instead(ast.IfExp(test, one, node), "condition", 1.12)


def _with_indices_exchanged(here: Here, scope: Scope) -> Iterator[ProgramEdit]:
    """A term whose indices are those of the others in another order: Christoffel's third."""
    terms = [*summands(here.node)]
    known = {ast.unparse(one) for one in terms}
    own = [name for name in dict.fromkeys(names(terms[0])) if name in scope.counting]
    alike = all(sorted(_counted(x, own)) == sorted(own) for x in terms)
    if len(terms) != _BOTH or len(own) != _INDICES or not alike:
        return
    for order in permutations(own):
        others: dict[str, ast.expr] = dict(zip(own, map(named, order), strict=True))
        new = Renamed(others).of(terms[0])
        if ast.unparse(new) not in known:
            for op, cost in ((ast.Sub(), 1.04), (ast.Add(), 1.06)):
                yield here.instead(ast.BinOp(here.node, op, new), "missing term", cost)


def _half_of_its_own(here: Here, scope: Scope) -> Iterator[ProgramEdit]:
    """Half a length for the link's own alone: ``L[k]/2 if k == i else L[k]``."""
    node = here.node
    halved = isinstance(node.op, ast.Div) and getattr(node.right, "value", 0) == 2
    whole = node.left if halved else node.right
    half = halved or (isinstance(node.op, ast.Mult) and getattr(node.left, "value", 0) == 0.5)
    if not half or not isinstance(whole, ast.Subscript) or not isinstance(whole.slice, ast.Name):
        return
    for other in scope.counting:
        if other != whole.slice.id and whole.slice.id in scope.counting:
            test = ast.Compare(whole.slice, [ast.Eq()], [ast.Name(other, ast.Load())])
            yield here.instead(ast.IfExp(test, node, whole), "condition", 1.12)


def _counted(term: ast.expr, counters: Sequence[str]) -> list[str]:
    return [name for name in names(term) if name in counters]


def _of_the_point(here: Here, scope: Scope) -> Iterator[ProgramEdit]:
    """A coordinate of the frame's origin for that of a point: ``(p + c)[2]``."""
    node = here.node
    if not isinstance(node, ast.Subscript) or not whole_constant(node.slice):
        return
    shape = scope.observed.shape(node.value)
    if shape not in ((2,), _VECTOR) or not _begins(node.value, _ARMS):
        return
    own = ast.unparse(node.value)
    arms = [x for text, x in scope.simple(shape) if text != own and _begins(x, _ARMS)]
    for arm in arms[:_FEW]:
        whole = ast.BinOp(node.value, ast.Add(), arm)
        yield here.instead(ast.Subscript(whole, node.slice, ast.Load()), "missing term", 1.1)


def _of_idle_numbers(here: Here, scope: Scope) -> Iterator[ProgramEdit]:
    """A number that nothing uses any more, times something: ``r*F + I*alpha``."""
    if isinstance(here.node, ast.Name | ast.Subscript | ast.Attribute):
        return
    every = [x for _text, x in scope.simple(())]
    idle = [x for x in every if scope.is_idle(x)]
    if isinstance(here.node, ast.IfExp):  # ``theta + (q if turns else 0)``
        for one in idle[:_FEW]:
            yield here.instead(ast.BinOp(one, ast.Add(), here.node), "missing term", 1.08)
    for one in idle[:_FEW]:
        for other in [x for x in every if x not in idle][: 2 * _FEW]:
            term = ast.BinOp(one, ast.Mult(), other)
            yield here.instead(ast.BinOp(here.node, ast.Add(), term), "missing term", 1.12)


def _of_unread_rows(here: Here, scope: Scope, shape: Shape) -> Iterator[ProgramEdit]:
    """A row that nothing reads times another, for a sum that begins with nothing: ``Jm*qdd``."""
    rows = [x for _text, x in scope.simple(shape)]
    unread = [x for x in rows if scope.is_idle(x) or _key_of(x) in scope.idle_keys]
    others = [x for x in rows if x not in unread and isinstance(x, ast.Name)]
    for one in unread[:_FEW]:
        for other in others[:_FEW]:
            yield here.instead(ast.BinOp(one, ast.Mult(), other), "name", 1.08)


def _key_of(node: ast.AST) -> str:
    """The key that a dictionary is asked for; empty of anything else."""
    key = getattr(node.slice, "value", "") if isinstance(node, ast.Subscript) else ""
    return key if isinstance(key, str) else ""


def _of_idle_numbers_along(here: Here, scope: Scope, shape: Shape) -> Iterator[ProgramEdit]:
    """The same along a vector, alone or times another number: ``Q + I*alpha*J``."""
    every = [x for _text, x in scope.simple(()) if not whole_constant(getattr(x, "slice", x))]
    idle = [x for x in every if scope.is_idle(x)][: _FEW // 4]
    vectors = [x for _text, x in scope.simple(shape)][: 2 * _FEW] if idle else []
    for one in idle:
        for vector in vectors:
            term = ast.BinOp(one, ast.Mult(), vector)
            yield here.instead(ast.BinOp(here.node, ast.Add(), term), "missing term", 1.1)
            for other in [x for x in every if x not in idle][: 2 * _FEW]:
                both = ast.BinOp(one, ast.Mult(), other)
                term = ast.BinOp(both, ast.Mult(), vector)
                yield here.instead(ast.BinOp(here.node, ast.Add(), term), "missing term", 1.14)


def along_a_list(here: Here, scope: Scope) -> Iterator[ProgramEdit]:
    """An array that nothing uses, times another one, beside a list that is set or given back."""
    node = here.node
    if not isinstance(node.value, ast.List | ast.ListComp):
        return
    for name in sorted(scope.unused):
        array = isinstance(scope.space.get(name), np.ndarray)
        shape = scope.shapes.get(name, ())
        for _text, vector in scope.simple(shape) if array and len(shape) == 1 else ():
            if getattr(vector, "id", "") != name:
                term = ast.BinOp(ast.Name(name, ast.Load()), ast.Mult(), vector)
                new = ast.BinOp(term, ast.Add(), node.value)
                yield here.within(node, "value", new, "missing term", _BESIDE_A_LIST)


def _beside_in_a_product(here: Here, scope: Scope, shape: Shape) -> Iterator[ProgramEdit]:
    """A vector less another one, or with it, in a product: ``m*(a - g)`` for ``m*a``."""
    own = ast.unparse(here.node)
    for text, other in scope.simple(shape):
        if text != own:
            for op, cost in ((ast.Sub(), 1.06), (ast.Add(), 1.08)):
                new = ast.BinOp(here.node, op, other)
                yield here.instead(new, "missing term", cost + scope.dear(other))


def _as_a_diagonal(here: Here, scope: Scope, shape: Shape) -> Iterator[ProgramEdit]:
    """A row for the matrix that has it on the diagonal: ``M + np.diag(I)``, ``np.diag(I) @ w``."""
    parent = here.parent
    assert isinstance(parent, ast.BinOp)
    beside = parent.right if parent.left is here.node else parent.left
    other = scope.observed.shape(beside)
    added = isinstance(parent.op, _SUMS) and other == (*shape, *shape)
    turned = isinstance(parent.op, ast.MatMult) and beside is parent.right and other == shape
    if added or turned:
        diagonal = ast.Attribute(ast.Name("np", ast.Load()), "diag", ast.Load())
        yield here.instead(ast.Call(diagonal, [here.node], []), "function", 1.06)


def _is_entry(parent: ast.AST) -> bool:
    """Whether it sets an entry of a vector or a matrix, which may be 0."""
    return isinstance(parent, ast.Assign) and isinstance(parent.targets[0], ast.Subscript)


def _begins(node: ast.expr, letters: tuple[str, ...]) -> bool:
    while isinstance(node, ast.Subscript):
        node = node.value
    name = node.attr if isinstance(node, ast.Attribute) else getattr(node, "id", "")
    return name.startswith(letters)


def _moments(here: Here, scope: Scope) -> Iterator[ProgramEdit]:
    """The moment of a force: ``cross(P, f)``, and ``cross(P, R @ f)`` of the next link's."""
    if scope.cross is None:
        return
    simple = dict(scope.simple(_VECTOR))
    arms = [(text, one) for text, one in simple.items() if _begins(one, _ARMS)][:_FEW]
    forces = [one for one in simple.values() if _begins(one, _FORCES)][:_FEW]
    for piece in scope.pieces_here(_VECTOR).values():
        if isinstance(piece, ast.BinOp) and isinstance(piece.op, ast.MatMult):
            forces += [piece] if _begins(piece.right, _FORCES) else []
    if any(map(scope.crosses, nodes(here.node))):  # it is a sum of moments
        plain = [one for one in forces if not isinstance(one, ast.BinOp)]
        turns = _rotations(scope)
        forces += [ast.BinOp(turn, ast.MatMult(), one) for turn in turns for one in plain]
    for force in forces:
        for text, arm in arms:
            unused = text in scope.unused or not scope.unused.isdisjoint(names(arm))
            moment = ast.Call(scope.cross, [arm, force], [])
            new = ast.BinOp(here.node, ast.Add(), moment)
            yield here.instead(new, "missing term", 1.1 if unused else 1.14)


def _rotations(scope: Scope) -> list[ast.expr]:
    """Rotations that are worked out where they are used, and their transposes: ``R(q[1]).T``."""
    found: dict[str, ast.expr] = {}
    for piece in scope.pieces_here((3, 3)).values():
        one = piece.value if isinstance(piece, ast.Attribute) and piece.attr == "T" else piece
        if isinstance(one, ast.Call) and isinstance(one.func, ast.Name):
            found[text_of(one)] = one
            found[f"{text_of(one)}.T"] = ast.Attribute(one, "T", ast.Load())
    return [*found.values()][:_FEW]


def _of_twists(here: Here, scope: Scope) -> Iterator[ProgramEdit]:
    """The product of two twists, or of one and a momentum: ``crm(v) @ (s*qd)``, ``crf(v) @ I @ v``.

    The program's own function makes a matrix of a twist.
    """
    twists = [one for _text, one in scope.simple(_TWIST)][:_FEW]
    tensors = [one for _text, one in scope.simple(_TWIST * 2)][:_FEW]
    every = scope.pieces_here(_TWIST).values()
    rates = [x for x in every if isinstance(x, ast.BinOp) and isinstance(x.op, ast.Mult)][:_FEW]
    for function in scope.crossing:
        for one in twists:
            crossed = ast.Call(ast.Name(function, ast.Load()), [one], [])
            products: list[ast.expr] = [
                ast.BinOp(ast.BinOp(crossed, ast.MatMult(), tensor), ast.MatMult(), one)
                for tensor in tensors
            ]
            products += [ast.BinOp(crossed, ast.MatMult(), x) for x in (*twists, *rates)]
            for new in products:
                yield here.instead(ast.BinOp(here.node, ast.Add(), new), "missing term", 1.12)


def _energies(here: Here, scope: Scope) -> Iterator[ProgramEdit]:
    """Half a moment or a mass that nothing uses any more, times the square of a rate."""
    simple = dict(scope.simple(()))
    idle = [one for text, one in simple.items() if text in scope.unused]
    for one in [one for one in idle if isinstance(one, ast.Name)][:_FEW]:
        for text, rate in [*simple.items()][: 4 * _FEW]:
            if text not in scope.unused:
                half = ast.BinOp(number(0.5), ast.Mult(), one)
                term = ast.BinOp(half, ast.Mult(), ast.BinOp(rate, ast.Pow(), number(2)))
                yield here.instead(ast.BinOp(here.node, ast.Add(), term), "missing term", 1.12)


def _of_all_joints(here: Here, scope: Scope) -> Iterator[ProgramEdit]:
    """Half a row that nothing uses, times the squares of the rates: the rotors' energy."""
    rows = [(name, shape) for name, shape in scope.shapes.items() if len(shape) == 1]
    for idle, size in [one for one in rows if one[0] in scope.unused][:_FEW]:
        for rates, shape in rows:
            if shape == size and rates not in scope.unused:
                squares = ast.BinOp(ast.Name(rates, ast.Load()), ast.Pow(), number(2))
                half = ast.BinOp(number(0.5), ast.Mult(), ast.Name(idle, ast.Load()))
                term = ast.BinOp(half, ast.MatMult(), squares)
                yield here.instead(ast.BinOp(here.node, ast.Add(), term), "missing term", 1.1)


def _with_vectors(here: Here, scope: Scope) -> Iterator[ProgramEdit]:
    """A number in a sum of vectors, whose vector is forgotten: ``qdd*z``."""
    parent = here.parent
    assert isinstance(parent, ast.BinOp)
    other = parent.right if parent.left is here.node else parent.left
    shape = scope.observed.shape(other) or ()
    for _text, vector in [*scope.simple(shape)][: 2 * _FEW] if shape else ():
        yield here.instead(ast.BinOp(here.node, ast.Mult(), vector), "missing factor", 1.07)


def _turned_beside(here: Here) -> Iterator[ProgramEdit]:
    """A vector as the frame has it whose origin it is added to: ``T[:3, 3] + T[:3, :3] @ c``."""
    parent = here.parent
    assert isinstance(parent, ast.BinOp)
    origin = parent.right if parent.left is here.node else parent.left
    if isinstance(origin, ast.Subscript) and ast.unparse(origin.slice) == "(:3, 3)":
        key = ast.Tuple([ast.Slice(None, number(3), None) for _axis in range(2)], ast.Load())
        turn = ast.Subscript(origin.value, key, ast.Load())
        yield here.instead(ast.BinOp(turn, ast.MatMult(), here.node), "missing matrix", 1.02)


def _of_idle_points(here: Here, scope: Scope) -> Iterator[ProgramEdit]:
    """For the origin of a frame a point in it that nothing uses any more: ``(T @ tool)[:3]``."""
    node = here.node
    if ast.unparse(node.slice) != "(:3, 3)" or not scope.is_pose(node.value):
        return
    for _text, point in scope.simple(_HOMOGENEOUS):
        if scope.is_idle(point):
            rows = ast.Slice(None, number(_VECTOR[0]), None)
            yield here.instead(ast.Subscript(point, rows, ast.Load()), "name", 1.04)
            moved = ast.BinOp(node.value, ast.MatMult(), point)
            yield here.instead(ast.Subscript(moved, rows, ast.Load()), "missing matrix", 1.06)
    for _text, point in scope.simple(_VECTOR):
        if scope.is_idle(point):
            key = ast.Tuple([ast.Slice(None, number(3), None) for _axis in range(2)], ast.Load())
            turn = ast.Subscript(node.value, key, ast.Load())
            moved = ast.BinOp(turn, ast.MatMult(), point)
            yield here.instead(ast.BinOp(node, ast.Add(), moved), "missing term", 1.06)


def _with_angles(here: Here, scope: Scope) -> Iterator[ProgramEdit]:
    """A vector in a sum, whose sine or cosine is forgotten: ``cos(q)*x + sin(q)*y``."""
    for piece in scope.pieces_here(()).values():
        if isinstance(piece, ast.Call) and called(piece) in ANGLES:
            new = ast.BinOp(piece, ast.Mult(), here.node)
            yield here.instead(new, "missing factor", 1.12)


def _as_beside(here: Here, entries: Sequence[ast.expr]) -> Iterator[ProgramEdit]:
    """A factor that an entry beside it has, with its sign: ``[s12, a2*c12]`` for ``-a2*s12``."""
    used = {*names(here.node)}
    every = [x for one in entries if one is not here.node for x in factors(one)]
    for factor in {x.id: x for x in every if isinstance(x, ast.Name)}.values():
        if factor.id not in used:
            new = ast.BinOp(ast.UnaryOp(ast.USub(), factor), ast.Mult(), here.node)
            yield here.instead(new, "missing factor", 1.15)


def _as_in_lines_beside(here: Here) -> Iterator[ProgramEdit]:
    """A number that the sums above or below end with: ``a12 = x*y`` beside ``a11 = x*x + 1``."""
    block, at = block_of(here.above)
    near = block[max(at - _LINES, 0) : at + _LINES + 1] if isinstance(here.node, ast.BinOp) else []
    sums = (line.value for line in near if isinstance(line, ast.Assign))
    ends = [x for x in sums if isinstance(x, ast.BinOp) and isinstance(x.op, _SUMS)]
    told = {(type(x.op), text_of(x.right)): x for x in ends if isinstance(x.right, ast.Constant)}
    if not any(one is here.node for one in told.values()):
        for one in told.values():
            yield here.instead(ast.BinOp(here.node, one.op, one.right), "missing term", _AS_BESIDE)


def _under_a_wave(here: Here, scope: Scope, shape: Shape) -> Iterator[ProgramEdit]:
    """An angle whose sine or cosine is meant: ``l1*th2`` for ``l1*sin(th2)``."""
    text = text_of(here.node)
    for piece in scope.pieces.get(shape, {}).values() if text in scope.angles else ():
        if not isinstance(piece, ast.Call) or called(piece) not in ANGLES or not piece.args:
            continue
        if text_of(piece.args[0]) == text:
            yield here.instead(copied(piece), "function", 1.08)


def _of_the_third(here: Here, scope: Scope) -> Iterator[ProgramEdit]:
    """A term as the others, of a name like theirs that is set here, too: ``A*A + B*B - C*C``."""
    node, used = here.node, {*names(here.node)}
    free = [one for one in scope.set_at if one not in used and scope.shapes.get(one) == ()]
    for term in summands(node):
        for name in dict.fromkeys(names(term)):
            for other in (one for one in free if _are_of_one_row(one, name)):
                new = Renamed({name: ast.Name(other, ast.Load())}).of(term)
                for op in (ast.Add(), ast.Sub()):
                    yield here.instead(ast.BinOp(node, op, new), "missing term", 1.08)


def _are_of_one_row(one: str, other: str) -> bool:
    """Whether two names differ by their last sign alone: A and B, vx and vy, m1 and m2."""
    cased = one[-1].isupper() == other[-1].isupper() and one[-1].isdigit() == other[-1].isdigit()
    return cased and one[:-1] == other[:-1]


def with_slices(here: Here, scope: Scope) -> Iterator[ProgramEdit]:
    """Entries from a place on, times those of another row: ``l[j:]*sin(phi[j:])``."""
    node = here.node
    one = node.args[0] if isinstance(node, ast.Call) and len(node.args) == 1 else node
    if one is not node and called(node) not in ANGLES:
        return
    if not isinstance(one, ast.Subscript) or not isinstance(one.slice, ast.Slice):
        return
    if not isinstance(one.value, ast.Name):
        return
    for name, shape in scope.shapes.items():
        if len(shape) != 1 or name == one.value.id:
            continue
        rest: ast.expr = ast.Subscript(ast.Name(name, ast.Load()), one.slice, ast.Load())
        factors = [rest]
        for angle in ("sin", "cos") if one is node and scope.has_numpy else ():
            function = ast.Attribute(ast.Name("np", ast.Load()), angle, ast.Load())
            factors.append(ast.Call(function, [rest], []))
        for factor in factors:
            yield here.instead(ast.BinOp(node, ast.Mult(), factor), "missing factor", 1.1)


def _is_filled(here: Here) -> bool:
    """Whether what is set is filled in later, entry by entry."""
    targets = here.parent.targets if isinstance(here.parent, ast.Assign) else []
    filled = {one.id for one in written_into(here.above[0])}
    return any(isinstance(one, ast.Name) and one.id in filled for one in targets)


def _inside_products(here: Here, scope: Scope) -> Iterator[ProgramEdit]:
    """One term of a sum in parentheses: ``a*(b*c + d*e)``, of which ``a*b*c`` is left."""
    own = {ast.unparse(one) for one in nodes(here.node) if isinstance(one, ast.expr)}
    known = [ast.parse(text, mode="eval").body for text in sorted(scope.inner)]
    turned = [Turned(scope.shapes).visit(copied(one)) for one in known]
    across = OtherAxis(scope.shapes).visit(copied(here.node))
    for cost, pieces in ((1.12, known), (1.13, [*turned, across])):
        for piece in pieces:
            text = ast.unparse(piece)
            if not isinstance(piece, ast.BinOp | ast.UnaryOp) or text in own:
                continue
            own.add(text)
            for op, more in ((ast.Add(), 0.0), (ast.Sub(), 0.02)):
                yield here.instead(summed(here.node, op, piece), "missing term", cost + more)


def _crosswise(here: Here) -> Iterator[ProgramEdit]:
    """The other half of a product of two vectors: ``- a[1]*b[0]`` of ``a[0]*b[1] - a[1]*b[0]``."""
    node = here.node
    one, other = (node.left, node.right) if isinstance(node, ast.BinOp) else (None, None)
    if isinstance(one, ast.UnaryOp):
        one = one.operand  # -a[1]*b[0]
    if not isinstance(one, ast.Subscript) or not isinstance(other, ast.Subscript):
        return
    if isinstance(node.op, ast.Mult) and ast.dump(one.slice) != ast.dump(other.slice):
        left = ast.Subscript(one.value, other.slice, ast.Load())
        right = ast.Subscript(other.value, one.slice, ast.Load())
        across = ast.BinOp(left, ast.Mult(), right)
        for op, cost in ((ast.Sub(), 1.1), (ast.Add(), 1.12)):
            yield here.instead(ast.BinOp(node, op, across), "missing term", cost)


def _part_across(here: Here, scope: Scope) -> Iterator[ProgramEdit]:
    """The part along the other axis: ``l1*c2*fy + l1*s2*fx``, of which the first is left."""
    parts = factors(here.node)
    if len(parts) < 2:
        return
    turned = Turned(scope.shapes)
    for i, one in enumerate(parts):
        other = turned.visit(copied(one))
        if ast.dump(other) == ast.dump(one):
            continue
        for j, last in enumerate(parts):
            if j != i and isinstance(last, ast.Name) and last.id[-1:] in _ACROSS:
                name = last.id[:-1] + _ACROSS[last.id[-1]]
                if scope.shapes.get(name) == ():
                    new = [*parts]
                    new[i], new[j] = other, ast.Name(name, ast.Load())
                    term = reduce(lambda a, b: ast.BinOp(a, ast.Mult(), b), new)
                    for op, cost in ((ast.Add(), 1.06), (ast.Sub(), 1.07)):
                        whole = ast.BinOp(here.node, op, term)
                        yield here.instead(whole, "missing term", cost)


_ACROSS = {"x": "y", "y": "x"}
"""Letters of axes of a plane."""


def _other_axes(here: Here, scope: Scope, shape: Shape) -> Iterator[ProgramEdit]:
    """The part along another axis: ``cos(q)*x + sin(q)*z``, of which ``cos(q)*x`` is left."""
    node = here.node
    if not isinstance(node.op, ast.Mult):
        return
    for scalar, vector in ((node.left, node.right), (node.right, node.left)):
        if not isinstance(vector, ast.Name) or not isinstance(scalar, ast.Call):
            continue
        turned = Turned().visit(copied(scalar))
        for text, other in scope.simple(shape):
            if isinstance(other, ast.Name) and text != vector.id and text[0] == vector.id[0]:
                across = ast.BinOp(turned, ast.Mult(), other)
                for op, cost in ((ast.Add(), 1.12), (ast.Sub(), 1.14)):
                    yield here.instead(ast.BinOp(node, op, across), "missing term", cost)


def _by_unused(here: Here, scope: Scope) -> Iterator[ProgramEdit]:
    """What is given on, without the number that nothing uses any more: ``expm(S*angle)``."""
    for text, scalar in scope.simple(()):
        if text in scope.unused:
            new = ast.BinOp(here.node, ast.Mult(), scalar)
            yield here.instead(new, "missing factor", 1.06)


def _calls(here: Here, scope: Scope, shape: Shape) -> Iterator[ProgramEdit]:
    """A call that nothing makes: the rotation of a joint, the way to the next one."""
    node = here.node
    if isinstance(here.parent, ast.Subscript | ast.Attribute):
        return
    for size, call in scope.idle:
        if len(shape) == 1 and size == shape * 2:
            yield here.instead(ast.BinOp(call, ast.MatMult(), node), "missing matrix", 1.06)
        if size != shape:
            continue
        if len(shape) == 2:
            cost = 1.04 if isinstance(here.parent, _SET) else 1.07
            yield here.instead(ast.BinOp(node, ast.MatMult(), call), "missing matrix", cost)
            yield here.instead(ast.BinOp(call, ast.MatMult(), node), "missing matrix", cost)
            continue
        added: list[ast.expr] = [call]
        if shape == _VECTOR and scope.cross is not None:
            rates = [one for _text, one in scope.simple(_VECTOR) if _begins(one, _RATES)]
            added += [ast.Call(scope.cross, [one, call], []) for one in rates[:_FEW]]
        for one in added:
            yield here.instead(ast.BinOp(node, ast.Add(), one), "missing term", 1.1)
            yield here.instead(ast.BinOp(node, ast.Sub(), one), "missing term", 1.12)


def _turned_matrices(here: Here, scope: Scope, shape: Shape) -> Iterator[ProgramEdit]:
    """The term of Rodrigues' formula that goes with a sine or a cosine: ``sin(t)*W``."""
    used = {*names(here.node)}
    for text, matrix in scope.simple(shape):
        if not isinstance(matrix, ast.Name) or text not in used:
            continue
        for piece in scope.pieces_here(()).values():
            if isinstance(piece, ast.Call) and called(piece) in ANGLES:
                term = ast.BinOp(piece, ast.Mult(), matrix)
                new = ast.BinOp(here.node, ast.Add(), term)
                yield here.instead(new, "missing term", 1.15)
