"""What is missing of several names at once: a cross product, a moment about another axis."""

from __future__ import annotations

import ast
from collections.abc import Iterator
from functools import reduce
from itertools import product

from kinlab.doctor.bytecode.syntax import called, copied, factors, names, nodes, text_of
from kinlab.doctor.program.edits.chains import chain, joined
from kinlab.doctor.program.edits.scope.forms import statement_of
from kinlab.doctor.program.edits.scope.part import Scope
from kinlab.doctor.program.edits.single.whole import plus
from kinlab.doctor.program.observed import Observed, Shape
from kinlab.doctor.program.places import ANGLES, Here, ProgramEdit, called_with, number

_RATES = ("w", "o", "W", "O")
"""How names of angular velocities begin."""
_MASSES, _MOMENTS, _LENGTHS = ("m", "M"), ("I", "J", "i"), ("l", "L", "r", "R", "a", "c", "d")
"""How names of masses, of moments of inertia, and of lengths begin."""
_ARMS = ("p", "P", "r", "c", "C", "l", "d", "s", "o", "v")
"""How names of what leads from one point to another begin, and of velocities."""
_NO_ARMS = ("R", "T", "I", "J", "A", "E")
"""How names of matrices begin that are no arm's."""
_TENSORS = ("tensor", "Tensor", "TENSOR", "theta", "Theta", "THETA")
"""How names of tensors of inertia begin, beside those of their moments."""
_ROTATIONS = ("R", "r")
"""How names of rotation matrices begin."""
_VECTOR, _TENSOR = (3,), (3, 3)
_OF_ONE_LINK = 1.0
"""Cost of the moment about another axis, where mass, distance and moment are of one link."""
_ALL_AXES = 1.06
"""Cost of a body's energy about all axes for that about one."""
_BESIDE = 1.06
"""Cost of what the same statement has the parts of."""
_NEAR = 1.08
"""The same of what another statement has the parts of."""
_OF_SUMMANDS = 1.08
"""Cost of the cross product of a rate that is turned and of what is added to it elsewhere."""
_AS_LEVER = 1.07
"""Cost of a lever more that another product of the statement has."""
_OF_A_POINT = 1.05
"""Cost of a lever from the point whose coordinates are used nowhere."""
_OUTWARD = 1.1
"""Cost of a sum over a part of an array for one over all of it."""
_CHAIN = 1.1
"""Cost of the rate that the chain rule asks for."""
_LAST = 0.01
"""What a factor of the last matrix of a product costs more."""
_FEW = 8
"""Angular velocities that are tried; twice as many arms."""


def of_composites(here: Here, scope: Scope, shape: Shape) -> Iterator[ProgramEdit]:
    """What may be missing beside an expression."""
    parent, node = here.parent, here.node
    op = parent.op if isinstance(parent, ast.BinOp) else None
    term = isinstance(op, ast.Add | ast.Sub) or isinstance(
        parent, ast.Assign | ast.AugAssign | ast.Return
    )
    if isinstance(node, ast.Constant | ast.List | ast.Tuple):
        return
    if shape == ():
        yield from _from_where_it_turns(here, scope)
        if isinstance(node, ast.Name | ast.Subscript | ast.Attribute):
            if _begins(node, _MOMENTS) and (term or isinstance(op, ast.Mult)):
                yield from _parallel_axes(here, scope)
            if isinstance(node, ast.Subscript) and _begins(node, _MASSES):
                yield from _from_there_on(here, scope.observed)
            yield from _next_entry(here, scope.observed)
        yield from _by_the_chain_rule(here, scope)
        yield from _spread(here, scope)
        yield from _squares(here, scope)
        yield from _about_all_axes(here, scope)
        return
    factor = isinstance(op, ast.MatMult)
    if isinstance(node, ast.Subscript) and isinstance(node.slice, ast.Name) and len(shape) == 1:
        yield from _of_list_from_there_on(here, scope)
    method = here.field == "value" and getattr(parent, "attr", "") == "sum"
    summed = method or (isinstance(parent, ast.Call) and called(parent) == "sum")
    if isinstance(node, ast.Name | ast.Attribute) and summed:
        yield from _of_a_counter_on(here, scope)
    if shape == _TENSOR and (term or isinstance(parent, ast.List | ast.Tuple)):
        yield from _parallel_axes_of_tensors(here, scope)
    if shape == _TENSOR and (term or factor or isinstance(parent, ast.List | ast.Tuple)):
        yield from _turned_tensors(here, scope)
    sum_ = isinstance(node, ast.BinOp) and isinstance(node.op, ast.Add | ast.Sub)
    sum_ = sum_ and here.field != "right"  # which stands in parentheses
    if (term or factor) and not sum_:
        yield from _times_scalars(here, scope)
    if shape == _VECTOR and (term or (factor and here.field == "right")):
        yield from _cross_products(here, scope)
    if shape == _VECTOR:
        yield from _of_the_product_rule(here, scope)
        yield from _of_turning(here, scope)
        if isinstance(parent, ast.Assign | ast.AugAssign | ast.Return):
            yield from _carried_on(here, scope)
        if scope.crosses(parent) and _is_arm(node):
            yield from _of_levers(here, scope)


def _name(node: ast.expr) -> str:
    """What tells of which kind a number is: ``lc`` of ``self.lc``, ``m`` of ``m[1]``."""
    while isinstance(node, ast.Subscript):
        if isinstance(node.slice, ast.Constant) and isinstance(node.slice.value, str):
            return node.slice.value
        node = node.value
    return node.attr if isinstance(node, ast.Attribute) else getattr(node, "id", "")


def _begins(node: ast.expr, letters: tuple[str, ...]) -> bool:
    return _name(node).startswith(letters)


def _parallel_axes(here: Here, scope: Scope) -> Iterator[ProgramEdit]:
    """The moment about another axis: ``I + m*lc**2`` for ``I``."""
    simple = dict(scope.simple(()))
    if isinstance(here.node, ast.Attribute):  # and what the object has besides
        for name, known in scope.attributes.items():
            if known == ():
                one = ast.Attribute(here.node.value, name, ast.Load())
                simple.setdefault(text_of(one), one)
    masses = [one for one in simple.values() if _begins(one, _MASSES)]
    lengths = [one for one in simple.values() if _begins(one, _LENGTHS)]
    for mass in masses:
        for length in lengths:
            square = ast.BinOp(length, ast.Pow(), number(2))
            new = ast.BinOp(here.node, ast.Add(), ast.BinOp(mass, ast.Mult(), square))
            near = _digits(mass) in ("", _digits(here.node)) and _digits(length) == _digits(mass)
            own = {_name(one)[1:] for one in (here.node, mass, length)}
            cost = _OF_ONE_LINK if len(own) == 1 and "" not in own else 1.1 if near else 1.2
            yield here.instead(new, "missing term", cost)


def _parallel_axes_of_tensors(here: Here, scope: Scope) -> Iterator[ProgramEdit]:
    """The same of a tensor, with a vector or its matrix: ``I + m*S @ S.T``; of the matrix of
    second moments ``m*np.outer(c, c)``."""
    node = here.node
    targets = here.parent.targets if isinstance(here.parent, ast.Assign) else []
    inner = [x for x in nodes(node) if isinstance(x, ast.Name | ast.Attribute | ast.Subscript)]
    if not any(_begins(one, _MOMENTS) for one in (*inner, *targets)):
        return
    masses = [one for _text, one in scope.simple(()) if _begins(one, _MASSES)][:_FEW]
    arms = [one for _text, one in scope.simple(_VECTOR) if _begins(one, _ARMS)][:_FEW]
    crossing = [one for _text, one in scope.simple(_TENSOR) if not _begins(one, _NO_ARMS)][:_FEW]
    added: list[ast.expr] = []
    for one in crossing:
        turned = ast.Attribute(one, "T", ast.Load())
        added.append(ast.BinOp(one, ast.MatMult(), turned))
    for one in arms if scope.has_numpy else ():
        text = text_of(one)
        squares = f"({text} @ {text}*np.eye(3) - np.outer({text}, {text}))"
        for more in (squares, f"np.outer({text}, {text})"):
            added.append(ast.parse(more, mode="eval").body)
    for mass in masses:
        for one in added:
            first = isinstance(one.op, ast.MatMult) if isinstance(one, ast.BinOp) else False
            times = ast.BinOp(mass, ast.Mult(), one)
            if first and isinstance(one, ast.BinOp):  # as it is typed: m*S @ S.T
                times = ast.BinOp(ast.BinOp(mass, ast.Mult(), one.left), one.op, one.right)
            beside = {*names(times)} <= scope.names_in(statement_of(here.above))  # m*S stands there
            near = first and text_of(times.left) in scope.pieces_here(_TENSOR)
            arm = one.args[0] if isinstance(one, ast.Call) else None  # np.outer(c, c) beside m*c
            moment = None if arm is None else ast.BinOp(mass, ast.Mult(), arm)
            near = near or (moment is not None and text_of(moment) in scope.pieces_here(_VECTOR))
            cost = _BESIDE if beside else _NEAR if near else 1.14
            yield here.instead(ast.BinOp(node, ast.Add(), times), "missing term", cost)


def _turned_tensors(here: Here, scope: Scope) -> Iterator[ProgramEdit]:
    """A tensor in other axes: ``R @ I @ R.T`` for ``I``."""
    rotations = [
        one
        for _text, one in scope.simple(_TENSOR)
        if _begins(one, _ROTATIONS) or isinstance(getattr(one, "slice", None), ast.Tuple)
    ]
    target = here.parent.targets[0] if isinstance(here.parent, ast.Assign) else None
    called_so = target if isinstance(here.node, ast.Call) and target is not None else here.node
    if isinstance(here.node, ast.BinOp) or not _begins(called_so, (*_MOMENTS, *_TENSORS)):
        return
    for one in rotations[:_FEW]:
        turned = ast.Attribute(one, "T", ast.Load())
        for first, last, cost in ((one, turned, 1.04), (turned, one, 1.06)):
            inner = ast.BinOp(first, ast.MatMult(), here.node)
            yield here.instead(ast.BinOp(inner, ast.MatMult(), last), "missing matrix", cost)


def _spread(here: Here, scope: Scope) -> Iterator[ProgramEdit]:
    """A factor of a sum that belongs to one of its terms: ``a*x + b*c`` for ``(a + b)*c``."""
    parts = factors(here.node)
    if len(parts) == 1 or _is_product(here.parent):
        return
    for k, total in enumerate(parts):
        if not isinstance(total, ast.BinOp) or not isinstance(total.op, ast.Add | ast.Sub):
            continue
        for n, factor in enumerate(parts):
            if n == k or not isinstance(factor, ast.Name | ast.Subscript | ast.Attribute):
                continue
            for text, other in scope.simple(()):
                if text == text_of(factor) or text in scope.counters:
                    continue
                for first, last in ((other, factor), (factor, other)):
                    left = ast.BinOp(total.left, ast.Mult(), first)
                    right = ast.BinOp(total.right, ast.Mult(), last)
                    sum_ = ast.BinOp(left, total.op, right)
                    rest = [*(x for m, x in enumerate(parts) if m not in (k, n)), sum_]
                    new = reduce(lambda one, x: ast.BinOp(one, ast.Mult(), x), rest)
                    yield here.instead(new, "parentheses", 1.2)


def _squares(here: Here, scope: Scope) -> Iterator[ProgramEdit]:
    """The square of another coordinate as well: ``x**2 + y**2`` for ``y**2``."""
    node = here.node
    if not isinstance(node, ast.BinOp) or not isinstance(node.op, ast.Pow):
        return
    own = getattr(node.left, "id", "")
    others = {own.replace(one, other) for one in "xyz" for other in "xyz" if one in own} - {own}
    for text, other in scope.simple(()):
        if text in others or (text in scope.unused and isinstance(node.left, ast.Name)):
            square = ast.BinOp(other, ast.Pow(), number(2))
            yield here.instead(ast.BinOp(square, ast.Add(), node), "missing term", 1.1)


def _about_all_axes(here: Here, scope: Scope) -> Iterator[ProgramEdit]:
    """The energy of turning about one axis alone: ``w @ I @ w`` for ``I[2, 2]*w[2]**2``."""
    node, shape = here.node, scope.observed.shape
    if not isinstance(node, ast.BinOp) or not isinstance(node.op, ast.Mult):
        return
    every = [*factors(node)]
    squares = (x for x in every if isinstance(x, ast.BinOp) and isinstance(x.op, ast.Pow))
    rates = [(x, x.left.value) for x in squares if isinstance(x.left, ast.Subscript)]
    tensors = [(x, x.value) for x in every if isinstance(x, ast.Subscript)]
    for (square, rate), (entry, tensor) in product(rates, tensors):
        if shape(rate) == _VECTOR and shape(tensor) == _TENSOR:
            turned = ast.BinOp(rate, ast.MatMult(), tensor)
            whole: ast.expr = ast.BinOp(turned, ast.MatMult(), rate)
            for other in every:
                if other is not square and other is not entry:
                    whole = ast.BinOp(other, ast.Mult(), whole)
            yield here.instead(whole, "missing factor", _ALL_AXES)


def _is_product(node: ast.AST) -> bool:
    return isinstance(node, ast.BinOp) and isinstance(node.op, ast.Mult)


def _of_list_from_there_on(here: Here, scope: Scope) -> Iterator[ProgramEdit]:
    """The sum of an entry of a list and all behind it, as of the forces on the links outward."""
    node = here.node
    if isinstance(node.value, ast.Name) and node.value.id in scope.lists:
        rest = ast.Subscript(node.value, ast.Slice(node.slice, None, None), ast.Load())
        total = called_with("sum", rest)
        yield here.instead(total, "missing term", 1.16)


def _of_a_counter_on(here: Here, scope: Scope) -> Iterator[ProgramEdit]:
    """The sum of what is outward of a joint for that of all: ``m[i:].sum()`` for ``m.sum()``."""
    for name in sorted({*scope.counters} & scope.counting):
        own = ast.Name(name, ast.Load())
        for end in (own, plus(own, 1)):
            for cut in (ast.Slice(end, None, None), ast.Slice(None, end, None)):
                part = ast.Subscript(here.node, cut, ast.Load())
                yield here.instead(part, "index", _OUTWARD)


def _by_the_chain_rule(here: Here, scope: Scope) -> Iterator[ProgramEdit]:
    """The rate that an object has beside its value: ``cos(x.v)*x.d`` for ``cos(x.v)``."""
    node = here.node
    inner = node.args[0] if isinstance(node, ast.Call) and len(node.args) == 1 else None
    if not isinstance(inner, ast.Attribute) or called(node) not in ANGLES:
        return
    for name, known in scope.attributes.items():
        if name != inner.attr and known == ():
            rate = ast.Attribute(inner.value, name, ast.Load())
            yield here.instead(ast.BinOp(node, ast.Mult(), rate), "missing factor", _CHAIN)


def _digits(node: ast.expr) -> str:
    """The number of a link: ``2`` of ``m2``, and of ``m[1]`` its index."""
    text = text_of(node)
    return "".join(letter for letter in text if letter.isdigit())


def _from_there_on(here: Here, observed: Observed) -> Iterator[ProgramEdit]:
    """The sum of an entry and all behind it, as of the masses that a joint carries."""
    node = here.node
    if len(observed.shape(node.value) or ()) == 1 and not isinstance(node.slice, ast.Slice):
        rest = ast.Subscript(node.value, ast.Slice(node.slice, None, None), ast.Load())
        total = called_with("sum", rest)
        yield here.instead(total, "missing term", 1.15)


def _next_entry(here: Here, observed: Observed) -> Iterator[ProgramEdit]:
    """The entry before or behind as well: ``m[1] + m[2]`` for ``m[1]``."""
    node, parent = here.node, here.parent
    if not isinstance(node, ast.Subscript) or not isinstance(node.slice, ast.Constant):
        return
    factor = isinstance(parent, ast.BinOp) and not isinstance(parent.op, ast.Pow)
    if not (factor or isinstance(parent, ast.Assign | ast.Return | ast.Tuple)):
        return
    k, sizes = node.slice.value, observed.shape(node.value) or ()
    for other in (k + 1, k - 1) if type(k) is int and len(sizes) == 1 else ():
        if 0 <= other < sizes[0]:
            beside = ast.Subscript(node.value, number(other), ast.Load())
            new = ast.BinOp(node, ast.Add(), beside)
            yield here.instead(new, "missing term", 1.14)


def _times_scalars(here: Here, scope: Scope) -> Iterator[ProgramEdit]:
    """A vector or matrix times a number, which stands in front of a product of matrices."""
    node, above = here.node, here.parent
    matrices = isinstance(node, ast.BinOp) and isinstance(node.op, ast.MatMult)
    last = isinstance(getattr(above, "op", None), ast.MatMult) and here.field == "right"
    for text, scalar in scope.simple(()):
        if text not in scope.counters:
            cost = 1.12 + scope.dear(scalar) + _LAST * last
            new: ast.expr = ast.BinOp(node, ast.Mult(), scalar)
            if matrices:
                first, others = chain(node, (ast.MatMult,))
                new = joined(ast.BinOp(scalar, ast.Mult(), first), others)
            yield here.instead(new, "missing factor", cost)


def _cross_products(here: Here, scope: Scope) -> Iterator[ProgramEdit]:
    """A velocity, or an acceleration, of another point: ``w x r``, ``w x (w x r)``."""
    if scope.cross is None:
        return
    plain = [one for one in scope.pieces_here(_VECTOR).values() if _plain(one)]
    names = [one for one in plain if not isinstance(one, ast.BinOp)]
    turned = [x for x in scope.pieces_here(_VECTOR).values() if _is_turned(x)]
    rates = [one for one in (*names, *turned) if _begins(_last(one), _RATES)][:_FEW]
    axial = [x for x in scope.pieces_here(_VECTOR).values() if isinstance(x, ast.BinOp)]
    axial = [x for x in axial if isinstance(x.op, ast.Mult) and _begins(x.left, _RATES)]
    rates += [x for x in axial if isinstance(x.left, ast.Name | ast.Subscript)][:_FEW]
    vectors = [one for one in plain if isinstance(one, ast.BinOp) or _begins(one, _ARMS)]
    own = text_of(here.node)
    for both in scope.pieces_here(_VECTOR).values():  # of w = R.T @ w + qd*z
        if isinstance(both, ast.BinOp) and isinstance(both.op, ast.Add) and _begins_turned(both):
            across = ast.Call(scope.cross, [both.left, both.right], [])
            new = ast.BinOp(here.node, ast.Add(), across)
            yield here.instead(new, "missing term", _OF_SUMMANDS)
    for rate in rates:
        for vector in vectors[: 2 * _FEW]:
            if text_of(vector) in (text_of(rate), own):
                continue
            cost = 1.17 + scope.dear(vector) / 2
            product: ast.expr = vector
            for turn in range(2):
                product = ast.Call(scope.cross, [rate, product], [])
                new = ast.BinOp(here.node, ast.Add(), product)
                yield here.instead(new, "missing term", cost + 0.05 * turn)


def _of_the_product_rule(here: Here, scope: Scope) -> Iterator[ProgramEdit]:
    """The other term of a rate of a cross product: ``z3d x (p - p3)`` beside ``z3 x (v - v3)``."""
    node = here.node
    if not scope.crosses(node):
        return
    factors_, known = node.args, [x for x, shape in scope.shapes.items() if shape == _VECTOR]
    for own, other in (factors_, factors_[::-1]):
        if not isinstance(own, ast.Name) or not isinstance(other, ast.BinOp):
            continue
        others = [x for x in known if x != own.id and own.id in x.replace("d", "")]
        others += [x for x in known if x != own.id and x in own.id.replace("d", "")]
        points = {x.id for x in nodes(other) if isinstance(x, ast.Name)}
        beside = {x: [y for y in known if y[1:] == x[1:] and y[0] != x[0]] for x in points}
        for head in sorted({y[0] for some in beside.values() for y in some}):
            put = {x: y for x, some in beside.items() for y in some if y[0] == head}
            for rate in others if len(put) == len(points) else ():
                turned = copied(other)
                for one in nodes(turned):
                    if isinstance(one, ast.Name):
                        one.id = put.get(one.id, one.id)
                given = [ast.Name(rate, ast.Load()), turned]
                given = given if own is factors_[0] else given[::-1]
                both = ast.BinOp(ast.Call(node.func, given, []), ast.Add(), node)
                yield here.instead(both, "missing term", _OF_SUMMANDS)


def _begins_turned(both: ast.BinOp) -> bool:
    """Whether a rate is turned, and another one added to it."""
    return _is_turned(both.left) and _begins(_last(both.left), _RATES)


def _carried_on(here: Here, scope: Scope) -> Iterator[ProgramEdit]:
    """What comes from the link before, turned: ``R @ n`` of ``n = R @ n + ...``."""
    own = [n.id for n in nodes(here.parent) if isinstance(n, ast.Name)][:1]
    vectors = [x for text, x in scope.simple(_VECTOR) if text in own or text in scope.unused]
    for _text, matrix in [*scope.simple(_TENSOR)][:_FEW]:
        for one in (matrix, ast.Attribute(matrix, "T", ast.Load())):
            for vector in vectors[:_FEW]:
                turned = ast.BinOp(one, ast.MatMult(), vector)
                yield here.instead(ast.BinOp(here.node, ast.Add(), turned), "missing term", 1.15)


def _is_arm(node: ast.expr) -> bool:
    if isinstance(node, ast.Call) and called(node) in ("array", "asarray") and len(node.args) == 1:
        return _is_arm(node.args[0])
    return isinstance(node, ast.Name | ast.Subscript | ast.Attribute) and _begins(node, _ARMS)


def _from_where_it_turns(here: Here, scope: Scope) -> Iterator[ProgramEdit]:
    """Two coordinates less those of a point that is used nowhere: ``(x - jx)*fy - (y - jy)*fx``."""
    node = here.node
    both = (node.left, node.right) if isinstance(node, ast.BinOp) else ()
    idle = sorted(name for name in scope.unused if scope.shapes.get(name) == ())
    if len(both) != 2 or not isinstance(node.op, ast.Sub) or len(idle) != 2:
        return
    if not all(isinstance(x, ast.BinOp) and isinstance(x.op, ast.Mult) for x in both):
        return
    for order in (idle, idle[::-1]):
        new = copied(node)
        for side, name in zip((new.left, new.right), order, strict=True):
            side.left = ast.BinOp(side.left, ast.Sub(), ast.Name(name, ast.Load()))
        yield here.instead(new, "missing term", _OF_A_POINT)


def _of_levers(here: Here, scope: Scope) -> Iterator[ProgramEdit]:
    """A lever that begins, or ends, elsewhere: ``cross(r + c, F)`` for ``cross(c, F)``."""
    own, statement = text_of(here.node), statement_of(here.above)
    arms = [(text, one) for text, one in scope.simple(_VECTOR) if _begins(one, _ARMS)]
    calls = [x for x in nodes(statement) if isinstance(x, ast.Call) and x.args]
    levers = {text_of(x.args[0]) for x in calls if scope.crosses(x)}
    for text, other in arms[: 2 * _FEW]:
        if text != own:
            first = _AS_LEVER if text in levers else 1.12
            for op, cost in ((ast.Add(), first), (ast.Sub(), 1.14)):
                yield here.instead(ast.BinOp(here.node, op, other), "missing term", cost)


def _of_turning(here: Here, scope: Scope) -> Iterator[ProgramEdit]:
    """The term of a velocity that goes with one of an acceleration, and is easily forgotten.

    ``w x (w x r)`` with ``dw x r``, ``w x I w`` with ``I dw``, ``w x z qd`` with ``z qdd``.
    """
    if scope.cross is None:
        return
    node = here.node
    if scope.crosses(node) and _begins(node.args[0], _RATES):
        twice = ast.Call(node.func, [node.args[0], node], [])
        yield here.instead(twice, "missing factor", 1.09)
    vectors = scope.pieces_here(_VECTOR).values()
    for rate in [one for one in vectors if _plain(one) and _begins(one, _RATES)][:_FEW]:
        for inner in _turned_with(here.node, rate, scope):
            product = ast.Call(scope.cross, [rate, inner], [])
            yield here.instead(ast.BinOp(here.node, ast.Add(), product), "missing term", 1.1)


def _turned_with(node: ast.expr, rate: ast.expr, scope: Scope) -> Iterator[ast.expr]:
    """What turns with a velocity, where a term is of an acceleration."""
    own = text_of(rate)
    if isinstance(node, ast.Call) and scope.crosses(node):
        if text_of(node.args[0]) != own:
            yield ast.Call(node.func, [rate, node.args[1]], [])
    elif isinstance(node, ast.BinOp) and isinstance(node.op, ast.MatMult):
        if text_of(node.right) != own:
            yield ast.BinOp(node.left, node.op, rate)
    elif isinstance(node, ast.BinOp) and isinstance(node.op, ast.Mult):
        if {scope.observed.shape(one) for one in (node.left, node.right)} == {_VECTOR}:
            yield ast.BinOp(node.left, node.op, rate)  # a tensor's diagonal
        for scalar, vector in ((node.left, node.right), (node.right, node.left)):
            if isinstance(scalar, ast.Subscript) and scope.observed.shape(scalar) == ():
                for text, other in scope.simple(()):
                    if not isinstance(other, ast.Subscript) or text == text_of(scalar):
                        continue
                    if ast.dump(other.slice) == ast.dump(scalar.slice):
                        yield ast.BinOp(other, node.op, vector)
            elif isinstance(scalar, ast.Name):  # z*rate beside z*rate2
                for piece in scope.pieces_here(_VECTOR).values():
                    product = isinstance(piece, ast.BinOp) and isinstance(piece.op, ast.Mult)
                    if product and text_of(vector) in map(text_of, factors(piece)):
                        yield piece


def _is_turned(node: ast.expr) -> bool:
    """A matrix times a name: ``R.T @ w``."""
    product = isinstance(node, ast.BinOp) and isinstance(node.op, ast.MatMult)
    return product and isinstance(_last(node), ast.Name | ast.Subscript)


def _last(node: ast.expr) -> ast.expr:
    return node.right if isinstance(node, ast.BinOp) else node


def _plain(node: ast.expr) -> bool:
    """A name, an entry, or a number times one."""
    if isinstance(node, ast.BinOp) and isinstance(node.op, ast.Mult):
        return _plain(node.left) and _plain(node.right)
    return isinstance(node, ast.Name | ast.Subscript | ast.Attribute)
