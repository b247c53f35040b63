"""What may stand at a place of a text instead of what stands there, tried place by place.

A repair replaces the changed piece of the text; the rest stays as the writer wrote it, in his names
and his order.
"""

from __future__ import annotations

import ast
import math
import re
from collections.abc import Iterator
from dataclasses import replace
from fractions import Fraction
from typing import Any

import numpy as np

from kinlab.arrays import Array
from kinlab.doctor.text.line import (
    Change,
    Line,
    Place,
    inside_wave,
    is_product,
    is_sum,
    is_term,
)
from kinlab.doctor.text.meanings import CLOSE
from kinlab.doctor.text.throughout import NUMBERS, alike, throughout
from kinlab.formulas import tree
from kinlab.formulas.signs.brackets import closes
from kinlab.formulas.text import canonical, words_in
from kinlab.formulas.tree import Node
from kinlab.host.language import N_

_FACTORS = {"2": 2.0, "3": 3.0, "4": 4.0, "/2": 0.5, "/3": 1 / 3, "/4": 0.25, "pi": math.pi}
_LENGTHS = ({"l", "lc"}, {"L", "lc"}, {"a", "lc"}, {"L", "Lc"}, {"l", "r"})
"""A link's length, and how far its centre of mass is: the one is taken for the other."""
_CENTRES = {"lc", "Lc", "r", "lg"}
_LARGE, _DOUBLED = 10, 1.05
"""Whole numbers that are rather typed double, or half, than that a 2 is lost in front."""
"""Letters of the distances of centres."""
_OF_LINKS = set().union(*_LENGTHS)
_MOTION = re.compile(r"(qdd|qd|q)(\d+)")
_OWN = 0.2
"""What another number of the robot's costs less for one of its own."""
_LACKS = N_("the factor {factor} is missing in {term}")
_NAMED = 0.3
"""What a factor costs more in a number of the robot's that is put in for its name."""
_ANGLE, _NEAR_ANGLE = math.pi / 12, 0.1
"""Angles that a decimal in a sine may be meant for, and how near, relative."""
_REDUCED = 0.05
"""What a fraction costs more that nobody would leave as it is."""
_UNDONE = 1.05
"""Cost of a number too many that a division behind it undoes: ``2*(a*b/2)``."""
_OF_A_PRODUCT = 0.12
"""What a term costs more that is missing beside a product alone, as in a fraction's numerator."""
_FACTOR_MORE = 0.035
"""What each factor of a missing term costs: of five it is no likelier than qd2 for qd1 + qd2."""


def study(line: Line) -> None:
    """Notes every change, once."""
    if line.changes:
        return
    for place in list(line.places):
        if _of_place(line, place):
            _as_factor(line, place)
            _as_term(line, place)
    _whole_terms(line)
    throughout(line)


def study_definition(line: Line) -> None:
    """Notes what else a name may be set to: another angle, or another name of the writer's more."""
    node = line.meant(line.source)
    if tree.names(node) <= {f"q{i + 1}" for i in range(line.names.n)}:
        for angle in dict.fromkeys((*line.names.angles, *_beside(line, node))):
            if angle != node:
                _node(line, line.root, angle, "argument", 1.2)
        return
    end, told = len(line.source), N_("the term {term} is missing")
    there = {*words_in(line.source)}
    own = {name: replace(line.text, text=name).values(line.at) for name in line.text.symbols}
    own = {x: value for x, value in own.items() if line.meaning(x) not in line.names.angles}
    moments = {name: value for name, value in line.atoms.items() if name[0] in "IJ"}
    for name, value in (own | moments).items():
        if np.ptp(value) > 0 and name not in there:
            span = (end, end, f"{line.gap}+{line.gap}{name}")
            new = line.root.value + value
            line.edit(line.root, new, span, "missing term", 1.15, told, {"term": name})


def study_what_stands(line: Line) -> None:
    """Notes the changes of what stands there: of nothing that is missing."""
    for place in list(line.places):
        _of_place(line, place)


def _of_place(line: Line, place: Place) -> bool:
    """Notes what may stand in a place; whether something may be missing beside it."""
    if inside_wave(place) or _is_exponent(place):
        _angle(line, place)
        return False
    node = place.node
    if isinstance(node, ast.Name):
        _name(line, place, node.id)
    elif isinstance(node, ast.Constant):
        _number(line, place)
    elif isinstance(node, ast.Call):
        _call(line, place, node)
    elif isinstance(node, ast.BinOp):
        _operation(line, place, node)
    elif isinstance(node, ast.UnaryOp) and isinstance(node.op, ast.USub):
        inner = line.source[place.span[0] + 1 : place.span[1]].lstrip()
        line.instead(place, inner, -place.value, "sign", 1.0)
    return True


def _name(line: Line, place: Place, name: str) -> None:
    meant = canonical(name) if name not in line.text.symbols else tree.sym(name)
    if line.turns(name) and name in line.text.symbols:
        meant = line.meaning(name)
    if meant.op in ("sin", "cos"):
        _wave(line, place, meant)
        return
    if meant.op != "sym":
        return
    if name in line.text.symbols:
        _rate_alone(line, place, line.meaning(name))
    joint = _MOTION.fullmatch(str(meant.value))
    if joint:
        head, index = joint.group(1), int(joint.group(2))
        for i in range(1, line.names.n + 1):
            if i == index:
                continue
            _node(line, place, tree.sym(f"{head}{i}"), "index", 1.2)
            if not _is_whole_term(place):
                pair = [tree.sym(f"{head}{k}") for k in sorted((i, index))]
                _node(line, place, tree.add(*pair), "missing term", 1.25)
        for word, value in line.atoms.items() if head == "q" else ():
            line.instead(place, f"({name} + {word})", place.value + value, "missing term", 1.5)
            if name in line.slides:
                line.instead(place, word, value, "parameter", 1.4)
        for order in line.names.letters:
            if order != head:
                other = tree.sym(f"{order}{index}")
                _node(line, place, other, "velocity for acceleration", 1.3)
                _node(line, place, tree.power(other, Fraction(2)), "velocity for acceleration", 1.5)
        return
    for word, value in line.slides.items():
        line.instead(place, word, value, "parameter", 1.4)
    for word, value in line.atoms.items():
        if word != name:
            near = _letters(word) == _letters(name)
            cost = 1.2 if near else 1.4 if word[0].lower() == name[0].lower() else 1.8
            same = word[-1] == name[-1] or not (word[-1].isdigit() or name[-1].isdigit())
            if same and {_letters(word), _letters(name)} in _LENGTHS:
                cost = 1.3 if _beside_a_length(line, place) else 1.1
                cost = 1.35 if _with_a_two(line, place) and word[-2:-1] == "c" else cost
                cost = 1.4 if halves_lengths(line) and word not in words_in(line.source) else cost
            line.instead(place, word, value, "index" if near else "parameter", cost)
            if not np.any(place.value):
                continue  # what is added to nothing comes instead of it
            more, less = f"({name} + {word})", f"({name} - {word})"
            line.instead(place, more, place.value + value, "missing term", 1.5)
            line.instead(place, less, place.value - value, "missing term", 1.7)


def _rate_alone(line: Line, place: Place, meant: Node) -> None:
    """A joint's rate alone, for the writer's own name of a link's: ``qd1`` for ``w12``."""
    rates = [_MOTION.fullmatch(name) for name in tree.names(meant)]
    heads = {found.group(1) for found in rates if found} & {"qd", "qdd"}
    if len(rates) < 2 or None in rates or len(heads) != 1 or meant.op != "add":
        return
    for i in range(1, line.names.n + 1):
        _node(line, place, tree.sym(f"{min(heads)}{i}"), "index", 1.2)


def _letters(name: str) -> str:
    return re.sub(r"[\d_]+", "", name)


def halves_lengths(line: Line) -> bool:
    """Whether a text has ``l/2`` for the centres of rods: they have no names of their own then."""
    names = {_letters(word) for word in words_in(line.source)}
    return not names & _CENTRES and bool(re.search(r"/ *[24]\b|0\.(?:5|25)\b", line.source))


def _beside_a_length(line: Line, place: Place) -> bool:
    """Whether a length stands beside another link's without a 2, which is lost there as often.

    Not where no mass is: only the distance of a centre of mass has half a length there.
    """
    if not any(_letters(word) in ("m", "M") for word in words_in(line.source)):
        return False
    name, product = line.segment(place), line.segment(_whole_product(place))
    others = (w for w in words_in(product) if _letters(w) in _OF_LINKS and w[-1] != name[-1])
    return any(others) and not re.search(r"(?<![\w.*^])\d", product)


def _with_a_two(line: Line, place: Place) -> bool:
    """Whether a 2 stands in the product: rather that is too many than a length is for its half."""
    product = line.segment(_whole_product(place))
    return bool(re.search(r"(?<![\w.*^/])2(?:\.(?=\*))?(?![\w.])", product))


def _whole_product(place: Place) -> Place:
    """The largest product, or quotient, that a place is a factor of; itself where of none."""
    while place.above is not None and is_product(place.above.node):
        place = place.above
    return place


def _node(line: Line, place: Place, node: Node, kind: str, cost: float) -> None:
    if tree.names(node) <= set(line.at):
        new = line.spelled(node)
        value = np.broadcast_to(tree.evaluate(node, line.at), (line.count,))
        tight = node.op == "add" and place.above is not None
        line.instead(place, f"({new})" if tight else new, value, kind, cost)


def _number(line: Line, place: Place) -> None:
    decimal = "." in line.segment(place)
    above = place.above
    if above is not None and isinstance(above.node, ast.UnaryOp):  # the 2 of -2*m2
        above = above.above
    idle = above is not None and is_product(above.node)
    typed = float(line.segment(place))
    of_a_name = _stands_for_a_name(line, place, typed)
    for shown, size in NUMBERS.items():
        shown = "0.25" if decimal and size == 0.25 else shown
        if size != typed and not (size == 1.0 and idle):
            cost = 1.25 + _REDUCED * _may_be_reduced(place, size) + _NAMED * of_a_name
            line.instead(place, shown, np.full(line.count, size), "factor", cost)
    if of_a_name:
        _put_in(line, place, typed)
    for factor in (2, 0.5) if typed.is_integer() and typed >= _LARGE else ():
        if (factor * typed).is_integer():  # 60 for 30
            shown = f"{factor * typed:.0f}"
            value = np.full(line.count, factor * typed)
            line.instead(place, shown, value, "factor", _DOUBLED)
    if not decimal and not line.only_numbers:
        return
    for word, value in line.atoms.items():  # a length's number, mistaken: 0.41 for l2 = 0.4
        line.instead(place, word, value, "parameter", 1.2)
    if line.numeric:
        right = _fitting(line, place)
        shown = np.format_float_positional(right, 12, fractional=False, trim="-")
        held = line.meanings.holds(typed)
        means = line.meanings.holds(right) or (not decimal and shown.isdigit())
        # an error of all numbers that are written so would be laid into this one
        sure = means or (decimal and len(alike(line, line.segment(place))) < 2)
        if _beside_names(line, place):  # what is wrong with them comes to a number too
            sure = line.meanings.parameter(right) is not None
        if _among_numbers(place):  # any of these, or of the constant's, may be the wrong one
            sure = means
        sure = sure and math.isfinite(right)
        if sure and not shown.startswith("-") and not (idle and shown == "1"):
            own = line.meanings.parameter(right) is not None
            doubt = 0.5 * held + 0.3 * (not means) - _OWN * (own and held)
            value = np.full(line.count, right)
            line.instead(place, shown, value, "coefficient", 1.15 + doubt)
    if line.numeric and line.only_numbers:
        for size in line.fronts:  # a coefficient, beside another slip: 17 for 17.1675
            gap = abs(size - place.value[0])
            if gap > 0:
                cost = 1.2 if gap <= CLOSE * size else 1.5
                shown = np.format_float_positional(size, 12, fractional=False, trim="-")
                line.instead(place, shown, np.full(line.count, size), "coefficient", cost)


def _may_be_reduced(place: Place, size: float) -> bool:
    """Whether a number would stand above one that it has a divisor in common with: 4/12, 0.5/2."""
    above = None if place.above is None else place.above.node
    if not isinstance(above, ast.BinOp) or not isinstance(above.op, ast.Div):
        return False
    below = above.right.value if isinstance(above.right, ast.Constant) else None
    if not isinstance(below, int) or above.left is not place.node:
        return False
    return size != int(size) or math.gcd(int(size), below) > 1


def _angle(line: Line, place: Place) -> None:
    """A decimal in a sine that is near an angle of 15, 30, 45, ... degrees: 1.6 for pi/2."""
    digits = line.segment(place)
    if not isinstance(place.node, ast.Constant) or "." not in digits:
        return
    exact = round(float(digits) / _ANGLE) * _ANGLE
    if 0 < abs(exact - float(digits)) <= _NEAR_ANGLE * exact:
        shown = line.meanings.named(exact)
        line.instead(place, shown, np.full(line.count, exact), "coefficient", 1.15)


def _among_numbers(place: Place) -> bool:
    """Whether a number stands in a product of nothing but numbers."""
    term = _term_of(place)
    return term is not place and not any(isinstance(x, ast.Name) for x in ast.walk(term.node))


def _stands_for_a_name(line: Line, place: Place, size: float) -> bool:
    """Whether a number is one of the robot's, put in beside others: the 0.4 of ``1.5*9.81*0.4``."""
    if line.meanings.parameter(size) is None:
        return False
    while place.above is not None and (is_product(place.above.node) or _is_base(place)):
        place = place.above
    return sum(isinstance(one, ast.Constant) for one in _in_product(place.node)) > 1


def _in_product(node: ast.expr) -> list[ast.expr]:
    """What is multiplied, or divided, whatever its power."""
    if is_product(node):
        return [*_in_product(node.left), *_in_product(node.right)]
    if isinstance(node, ast.BinOp) and isinstance(node.op, ast.Pow):
        return [node.left]
    return [node]


def _put_in(line: Line, place: Place, size: float) -> None:
    """What is meant by a number for a name: its square, half a length, and g beside."""
    written, name = line.segment(place), line.meanings.parameter(size) or ""

    def should_be(where: Place, shown: str, value: float, cost: float = 1.2) -> None:
        line.instead(where, shown, np.full(line.count, value), "coefficient", cost)

    squares = 1.35 if size in NUMBERS.values() else 1.2  # a square of 1/4 is a quarter of it
    should_be(place, f"{written}**2", size**2, squares)
    if place.above is not None and _is_base(place):
        should_be(place.above, written, size, squares)
    if name[0] == "l":  # of l2*l3 the last link's is rather its centre's
        further = 0.01 * int(name[1:]) if name[1:].isdigit() else 0.0
        should_be(place, f"{size / 2:.12g}", size / 2, 1.2 - further)
    for other, mass in line.meanings.own.items() if name[0] == "m" else ():
        if other[0] == "m" and other != name:
            should_be(place, f"({written} + {mass:.12g})", size + mass, 1.3)
    gravity = line.meanings.own.get("g")
    if name[0] == "m" and gravity:
        told, pieces = line.told(place, _LACKS, _LACKS)
        end, factor = place.span[1], f"{gravity:.12g}"
        pieces = {"term": written} | pieces | {"factor": factor}
        new, span = np.full(line.count, size * gravity), (end, end, f"*{factor}")
        line.edit(place, new, span, "coefficient", 1.2, told, pieces)


def _term_of(place: Place) -> Place:
    """The term of a sum, or the whole, that a place stands in."""
    while place.above is not None and not is_sum(place.above.node):
        place = place.above
    return place


def _beside_names(line: Line, place: Place) -> bool:
    """Whether the robot's numbers stand by their names in the term of a number."""
    words = words_in(line.segment(_term_of(place)))
    return any(not tree.names(line.meaning(w)).isdisjoint(line.names.parameters) for w in words)


def _fitting(line: Line, place: Place) -> float:
    """The number that would do best at a place, of which the whole is a multiple or a quotient.

    Of one that is squared the root of that.
    """
    if place.above is not None and _is_base(place) and line.segment(place.above).endswith("**2"):
        square = _fitting(line, place.above)
        return math.sqrt(square) if square > 0 else math.nan
    above = place.above.node if place.above is not None and place.role == 1 else None
    below = isinstance(above, ast.BinOp) and isinstance(above.op, ast.Div)
    turned = 1.0 / place.value if below else place.value
    moved = line.climbed(place, 1.0 / (turned + 1.0) if below else turned + 1.0) - line.root.value
    size = float(np.sum(moved * moved))
    share = np.sum(moved * (line.target - line.root.value)) / (size or 1.0)
    with np.errstate(all="ignore"):
        right = 1.0 / (turned + share) if below else turned + share
    return float(np.ravel(right)[0])


def _call(line: Line, place: Place, node: ast.Call) -> None:
    name = node.func.id if isinstance(node.func, ast.Name) else ""
    if name in ("sin", "cos", "tan"):
        argument = line.siblings[id(place)][0] if name != "tan" else None
        _wave(line, place, tree.call(name, line.meant(ast.unparse(node.args[0]))), argument)
    elif name == "sqrt":
        root = line.siblings[id(place)][0]
        line.instead(place, f"({line.segment(root)})", root.value, "power", 1.3)
    elif tree.SYNONYMS.get(name, name) == "atan2":
        y, x = line.siblings[id(place)]
        turned = f"{name}({line.segment(x)}, {line.segment(y)})"
        line.instead(place, turned, np.arctan2(x.value, y.value), "argument", 1.2)


def _wave(line: Line, place: Place, wave: Node, typed: Place | None = None) -> None:
    other = {"sin": "cos", "cos": "sin", "tan": "sin"}[wave.op]
    argument = wave.args[0]
    if typed is None:
        _node(line, place, tree.call(other, argument), "sin/cos", 1.0)
        _node(line, place, tree.mul(tree.num(-1), tree.call(other, argument)), "sin/cos", 1.7)
    else:  # of the angle as it is typed
        value = np.cos(typed.value) if other == "cos" else np.sin(typed.value)
        line.instead(place, f"{other}({line.segment(typed)})", value, "sin/cos", 1.0)
        line.instead(place, f"-{other}({line.segment(typed)})", -value, "sin/cos", 1.7)
    for angle in (*line.names.angles, *_beside(line, argument)):
        if angle != argument and not (_is_turned(angle) and not _is_turned(argument)):
            _node(line, place, tree.call(wave.op, angle), "argument", 1.2)
            _node(line, place, tree.call(other, angle), "argument", 2.0)


def _is_turned(angle: Node) -> bool:
    """Whether all of a sum of angles is negative: that is a sign, and another argument."""
    return all(any(one.op == "num" and one.value < 0 for one in x.factors) for x in angle.terms)


def _beside(line: Line, angle: Node) -> Iterator[Node]:
    """A sum of angles with one turned the other way, one less, or one more."""
    terms = angle.args if angle.op == "add" else (angle,)
    terms = (*sorted(terms, key=lambda one: one.op == "num"),)  # pi/2 behind the angles
    for k, term in sorted(enumerate(terms), key=lambda one: not _is_turned(one[1])):
        rest = (*terms[:k], *terms[k + 1 :])
        yield tree.add(*terms[:k], tree.mul(tree.num(-1), term), *terms[k + 1 :])
        if rest:
            yield tree.add(*rest)
    inside = tree.names(angle)
    for joint in (f"q{i + 1}" for i in range(line.names.n)):
        if joint not in inside:
            more = (*terms, tree.sym(joint))
            plain = all(one.op == "sym" for one in more)
            yield tree.add(*(sorted(more, key=str) if plain else more))
            yield tree.add(*terms, tree.mul(tree.num(-1), tree.sym(joint)))


def _operation(line: Line, place: Place, node: ast.BinOp) -> None:
    left, right = line.siblings[id(place)]
    start, end = place.span
    gap = line.source[left.span[1] : right.span[0]]
    sign = {ast.Add: "+", ast.Sub: "-", ast.Mult: "*", ast.Div: "/", ast.Pow: "**"}[type(node.op)]
    at = left.span[1] + gap.index(sign)
    first, second = line.source[start:at].strip(), line.source[at + len(sign) : end].strip()
    if is_sum(node):
        plus = sign == "+"
        other = "-" if plus else "+"
        shown = {"old": f"{sign} {second}", "new": f"{other} {second}"}
        turned = left.value - right.value if plus else left.value + right.value
        told = N_("{old} should be {new}")
        undone = plus and first.rpartition("+")[2].strip() == second  # a - a is nobody's
        span = at, at + 1, other
        opened = re.match(r"\(*-", second)
        if opened and not is_sum(right.node):  # + -a, where the second sign is told
            second_sign = line.source.index("-", at + 1)
            span, less = (
                (second_sign, second_sign + 1, ""),
                second.replace("-", "", 1).replace("( ", "("),
            )
            shown = {"old": second, "new": less} if plus else shown | {"new": f"- {less}"}
        line.edit(place, turned, span, "sign", 1.0 + undone, told, shown)
        told, term = N_("the term {term} does not belong there"), second if plus else f"-{second}"
        line.edit(place, left.value, (at, end, ""), "extra term", 1.1, told, {"term": term})
        alone = right.value if plus else -right.value
        line.edit(place, alone, (start, at + plus, ""), "extra term", 1.15, told, {"term": first})
        if plus:
            _plus_for_times(line, place, at)
        _enclosed(line, place, at)
        _enclosed_further(line, place, at)
        _into_the_angle(line, place)
        _laid_open(line, place)
        if plus:
            _wave_of_the_sum(line, place, left, right)
        return
    if isinstance(node.op, ast.Pow):
        base = left.value
        told, pieces = line.told(
            place, N_("{old} should be {new}"), N_("{old} should be {new} in {term}")
        )
        pieces["old"] = line.segment(place)
        cost = 1.1 if second.strip("()") == "2" else 1.5
        line.edit(place, base, (at, end, ""), "power", cost, told, pieces | {"new": first})
        for power in (2, 3, 4, -1):
            with np.errstate(all="ignore"):
                value = np.power(base, float(power))
            span = (at + 2, end, str(power))
            line.edit(place, value, span, "power", 1.3, told, pieces | {"new": f"{first}**{power}"})
        return
    if isinstance(node.op, ast.Div):
        told, pieces = line.told(
            place, N_("/{factor} does not belong"), N_("/{factor} does not belong in {term}")
        )
        span = (at, end, "")
        if _in_brackets(line, place) and not is_sum(left.node):  # a fraction
            span = (start, end, line.segment(left))
        if not _is_share(place, left):
            line.edit(place, left.value, span, "factor", 1.25, told, pieces | {"factor": second})
        _as_fraction(line, place, left, right)
        _upside_down(line, place, left, right)
        line.instead(place, f"{first}*{second}", left.value * right.value, "factor", 1.4)
        return
    if not any(isinstance(one.node, ast.Constant) for one in (left, right)):
        with np.errstate(all="ignore"):
            line.instead(place, f"{first}/{second}", left.value / right.value, "factor", 1.45)
    _linear(line, place, left, right)
    _times_for_plus(line, place, left, right)
    told, pieces = line.told(
        place,
        N_("the factor {factor} does not belong"),
        N_("the factor {factor} does not belong in {term}"),
    )
    for kept, gone, factor, span in (
        (left, right, second, (at, end, "")),
        (right, left, first, (start, at + 1, "")),
    ):
        plain = isinstance(gone.node, ast.Constant)
        kind = "factor" if plain else "extra factor"
        again = plain and re.search(rf"/\s*\(?{re.escape(factor)}\b", _outside(line.segment(kept)))
        cost = _UNDONE if again else 1.3
        line.edit(place, kept.value, span, kind, cost, told, pieces | {"factor": factor})
    minus = left.node
    if isinstance(minus, ast.UnaryOp) and isinstance(minus.operand, ast.Constant):
        inner = minus.operand
        factor = line.source[inner.col_offset : inner.end_col_offset]
        span = (inner.col_offset, right.span[0] if sign == "*" else at + 1, "")
        told_of = pieces | {"factor": factor}
        line.edit(place, -right.value, span, "factor", _BEHIND_A_MINUS, told, told_of)


_ENCLOSED, _ENCLOSED_TERMS = 1.2, 3
"""Cost of lost parentheses around the end of a term and the next one; terms before the last."""
_MISSING_RATHER = 0.35
"""What parentheses cost more outside of which one factor stands: it is missing in a term."""
_OF_NUMBERS = 0.7
"""What another sign costs more in a sum of numbers."""
_BEHIND_A_MINUS = 1.25
"""Cost of a number that does not belong behind a minus: the 2 of ``-2*m2``."""


def _is_of_numbers(place: Place | None) -> bool:
    """Whether it is a sum of numbers alone: of what was worked out no sign is lost."""
    every = [] if place is None else [*ast.walk(place.node)]
    return all(isinstance(x, ast.BinOp | ast.Constant | ast.operator) for x in every)


def _takes_away(place: Place) -> bool:
    """Whether it is a difference."""
    return is_sum(place.node) and isinstance(place.node.op, ast.Sub)


def _last_of(line: Line, sum_: Place) -> tuple[Place | None, Place]:
    """What stands before the last term of a sum, and this; of a term alone nothing, and it."""
    if not is_sum(sum_.node):
        return None, sum_
    before, last = line.siblings[id(sum_)]
    return before, last


def _with_last(before: Place | None, sum_: Place, value: Array) -> Array:
    """A sum's value with another one of its last term."""
    if before is None:
        return value
    return before.value - value if _takes_away(sum_) else before.value + value


def _enclosed(line: Line, place: Place, at: int) -> None:
    """A term with what stands behind its product, or quotient, in parentheses that are lost.

    ``a/(b + c)`` for ``a/b + c``, ``a*b*(c + d)`` for ``a*b*c + d``; of one factor alone it is
    rather missing in the other term.
    """
    left, right = line.siblings[id(place)]
    before, term = _last_of(line, left)
    term_at = term.span[0]
    back = right.value if line.source[at] == "+" else -right.value
    inner: Array | None = None
    while is_product(term.node):
        front, last = line.siblings[id(term)]
        quotient = isinstance(term.node.op, ast.Div)
        if quotient and inner is not None:
            return  # ``a/b*c + d``
        inner = last.value if inner is None else inner * last.value
        if quotient or is_product(front.node):
            with np.errstate(all="ignore"):
                value = front.value / (inner + back) if quotient else front.value * (inner + back)
            gap = line.source[front.span[1] : last.span[0]]
            cut = front.span[1] + gap.index("/" if quotient else "*") + 1
            behind = f"({line.source[cut : place.span[1]].strip()})"
            if closes(behind) < len(behind) - 1:
                return  # it stands in parentheses that end here
            value = _with_last(before, left, value)
            shown = {"old": line.source[term_at : place.span[1]]}
            shown["new"] = line.source[term_at:cut] + behind
            told = N_("{old} should be {new}")
            span = (cut, place.span[1], behind)
            alone = not quotient and _is_one_factor(line.source[term_at:cut].strip(" */"))
            line.edit(
                place, value, span, "parentheses", _ENCLOSED + _MISSING_RATHER * alone, told, shown
            )
        if quotient:
            return
        term = front


def _enclosed_further(line: Line, place: Place, at: int) -> None:
    """Parentheses lost around a part of several terms.

    ``(a + b)*c`` for ``a + b*c``, ``k*(a + b)*c`` for ``k*a + b*c``, ``k*(a + b + c)`` for
    ``k*a + b + c``; :func:`_enclosed` has those of two terms with nothing behind.
    """
    sum_, last = line.siblings[id(place)]
    inside, sign = 0.0 * last.value, 1.0 if line.source[at] == "+" else -1.0
    then, close = _with_its_own(line, last)
    heads = [*_heads(line, last, close)]
    for count in range(0 if is_sum(last.node) else _ENCLOSED_TERMS):
        before, first = _last_of(line, sum_)
        begin, _end = _with_its_own(line, first)
        if not _is_closed(line.source[begin:then]):
            return  # a parenthesis ends there
        old = line.source[begin:close]
        for start, front, tail in _cuts(line, first, begin):
            for end, inner, behind in heads[not count :]:  # behind two whole terms: ``_enclosed``
                with np.errstate(all="ignore"):
                    value = front * (tail + inside + sign * inner) * behind
                cut, stop = start - begin, end - begin
                shown = {"old": old, "new": f"{old[:cut]}({old[cut:stop]}){old[stop:]}"}
                span = (start, end, f"({line.source[start:end]})")
                told = N_("{old} should be {new}")
                value = _with_last(before, sum_, value)
                outside = [old[:cut].strip(" */"), old[stop:].strip(" */")]
                alone = not count and all(map(_is_one_factor, filter(None, outside)))
                cost = _ENCLOSED + _MISSING_RATHER * (alone and "" in outside)
                line.edit(place, value, span, "parentheses", cost, told, shown)
        if before is None:
            return
        inside = inside - first.value if _takes_away(sum_) else inside + first.value
        sum_ = before


def _is_closed(text: str) -> bool:
    """Whether as many parentheses end in a piece of text as begin there."""
    return text.count("(") == text.count(")")


def _outside(text: str) -> str:
    """What stands outside of parentheses, of which there may be some in others."""
    text = text.strip()
    while text.startswith("(") and closes(text) == len(text) - 1:
        text = text[1:-1].strip()
    before = ""
    while text != before:
        before, text = text, re.sub(r"\([^()]*[-+][^()]*\)", "", text)
    return text


def _is_one_factor(text: str) -> bool:
    """Whether it is a name, a number, or a sine: that is rather missing in the other term."""
    if re.fullmatch(r"[(\s]*1[)\s]*/[(\s]*\d[)\s]*", text):
        return True
    return bool(re.fullmatch(r"[\d.]+|[A-Za-z]\w*(?:\([^()]*\))?", text))


def _is_plain(text: str) -> bool:
    """Whether it is a product of factors without quotients, or signs behind the first."""
    return _is_closed(text) and not re.search(r"/|\*\s*[-+]", text)


def _into_the_angle(line: Line, place: Place) -> None:
    """Parentheses that are closed before an angle's end: ``cos(q1)+q2`` for ``cos(q1+q2)``."""
    sum_, more = place, 0.0 * place.value
    for _one in range(_ENCLOSED_TERMS):
        if not is_sum(sum_.node):
            return
        sign = -1.0 if _takes_away(sum_) else 1.0
        sum_, angle = line.siblings[id(sum_)]
        meant = line.meaning(angle.node.id) if isinstance(angle.node, ast.Name) else None
        found = None if meant is None else _MOTION.fullmatch(str(meant.value))
        if found is None or found[1] != "q":
            return
        more = more + sign * angle.value
        before, term = _last_of(line, sum_)
        wave = _multiplied(line, term)[-1]
        name = getattr(getattr(wave.node, "func", None), "id", "")
        if name in ("sin", "cos") and wave.span[1] == term.span[1]:
            turned = (np.sin if name == "sin" else np.cos)(line.siblings[id(wave)][0].value + more)
            front, behind = _around(line, wave, term)
            value = _with_last(before, sum_, front * turned * behind)
            start, inner, close = wave.span[0], wave.span[1] - 1, place.span[1]
            moved = f"{line.source[inner + 1 : close]})"
            shown = {"old": line.source[start:close], "new": line.source[start:inner] + moved}
            told = N_("{old} should be {new}")
            span = (inner, close, moved)
            line.edit(place, value, span, "parentheses", _ENCLOSED, told, shown)
            return


def _laid_open(line: Line, place: Place) -> None:
    """Parentheses too many around a factor, or around too many of its terms.

    ``I + m*l**2`` for ``(I + m)*l**2``, ``m*(a + b) + c`` for ``m*(a + b + c)``.
    """
    start, end = _with_its_own(line, place)
    whole = place
    while whole.above is not None and is_product(whole.above.node):
        if whole is not place and _with_its_own(line, whole) != whole.span:
            break  # a product in parentheses of its own
        if isinstance(whole.above.node.op, ast.Div) and whole.role:
            return  # below a line
        whole = whole.above
    if whole is place or start == place.span[0]:
        return
    front, behind = _around(line, place, whole)
    taken = whole.above is not None and _takes_away(whole.above) and whole.role == 1
    turn = -1.0 if taken else 1.0  # what comes out of the parentheses has the sign that it shows
    first, *rest = _terms_of(line, place)
    values, inner = [first[0], *(value for value, _at in rest)], line.segment(place)
    out = [turn * one for one in values]
    opened: list[tuple[Any, str]] = [(front * values[0] + sum(out[1:-1]) + out[-1] * behind, inner)]
    in_front, is_last = start > whole.span[0], end == whole.span[1]
    for k, (_value, (left, right)) in enumerate(rest, 1):
        if k > 1 and in_front and is_last:
            kept = line.source[place.span[0] : left].rstrip()
            last = line.source[left : place.span[1]]
            opened.append((front * sum(values[:k]) + sum(out[k:]), f"({kept}) {last}"))
        if not in_front and k < len(rest) and line.source[left] == "+":
            kept = line.source[right : place.span[1]].lstrip()
            moved = f"{line.source[place.span[0] : right]} ({kept})"
            opened.append((values[0] + sum(out[1:k]) + sum(out[k:]) * behind, moved))
    told = N_("{old} should be {new}")
    old, (begin, close) = line.segment(whole), whole.span
    for value, new in opened:
        shown = {"old": old, "new": line.source[begin:start] + new + line.source[end:close]}
        span = (start, end, new)
        line.edit(whole, np.asarray(value), span, "parentheses", _ENCLOSED, told, shown)


def _around(line: Line, place: Place, whole: Place) -> tuple[Array, Array]:
    """What is multiplied in front of a factor of a product, and behind it."""
    front = behind = np.ones_like(place.value)
    while place is not whole and place.above is not None:
        above = place.above
        if isinstance(above.node, ast.UnaryOp):
            front = -front
        else:
            other = line.siblings[id(above)][1 - place.role].value
            with np.errstate(all="ignore"):
                if place.role:
                    front = other * front
                elif is_product(above.node) and isinstance(above.node.op, ast.Div):
                    behind = behind / other
                else:
                    behind = behind * other
        place = above
    return front, behind


def _terms_of(line: Line, place: Place) -> list[tuple[Array, tuple[int, int]]]:
    """The terms of a sum, each with where its sign stands, and where that ends."""
    found: list[tuple[Array, tuple[int, int]]] = []
    while is_sum(place.node):
        taken = _takes_away(place)
        left, last = line.siblings[id(place)]
        gap = line.source[left.span[1] : last.span[0]]
        sign = left.span[1] + gap.index("-" if taken else "+")
        found.insert(0, (-last.value if taken else last.value, (sign, sign + 1)))
        place = left
    return [(place.value, (place.span[0], place.span[0])), *found]


def _with_its_own(line: Line, place: Place) -> tuple[int, int]:
    """Where a piece begins and ends, with parentheses that stand around nothing else."""
    start, end = place.span
    while True:
        before = re.search(r"(?<![\w\s])\s*\(\s*$", f" {line.source[:start]}")
        behind = re.match(r"\s*\)", line.source[end:])
        if before is None or behind is None:
            return start, end
        start, end = line.source.rindex("(", 0, start), end + behind.end()


def _cuts(line: Line, term: Place, begin: int) -> Iterator[tuple[int, Array | float, Array]]:
    """Where parentheses may begin in a term: in front of it, or of one of its factors.

    Each with what stands in front of them, and what is inside.
    """
    yield begin, 1.0, term.value
    if line.source[begin] == "-":
        yield begin + 1, -1.0, -term.value
    factors = _multiplied(line, term)
    for k, place in enumerate(factors[1:], 1):
        tail = line.source[place.span[0] : term.span[1]]
        if _is_plain(tail) and not is_sum(place.node):
            inner = np.asarray(math.prod(x.value for x in factors[k:]))
            yield place.span[0], _around(line, place, term)[0], inner


def _heads(line: Line, term: Place, close: int) -> Iterator[tuple[int, Array, Array | float]]:
    """Where they may end: behind a term, or behind one of its factors; inside, and behind them."""
    yield close, term.value, 1.0
    inner: Array | float = -1.0 if line.source[term.span[0]] == "-" else 1.0
    for place in _multiplied(line, term)[:-1]:
        end, inner = place.span[1], inner * place.value
        head = line.source[term.span[0] : end]
        if _is_plain(head) and not is_sum(place.node):
            yield end, np.asarray(inner), _around(line, place, term)[1]


def _plus_for_times(line: Line, place: Place, at: int) -> None:
    """The term in front of a plus multiplied by the one behind it: 2*l1*l2 + c2 for 2*l1*l2*c2."""
    left, right = line.siblings[id(place)]
    before, last, value = left, left, left.value * right.value
    if is_sum(left.node) and ")" not in line.source[left.span[1] : at]:
        before, last = line.siblings[id(left)]
        shown = last.value if isinstance(left.node.op, ast.Add) else -last.value
        value = before.value + shown * right.value
    old = line.source[last.span[0] : place.span[1]]
    piece = old[: at - last.span[0]].rstrip(), old[at - last.span[0] + 1 :].lstrip()
    told = N_("{old} should be {new}")
    shown_so = {"old": old, "new": "*".join(piece)}
    line.edit(place, value, (at, at + 1, "*"), "operator", 1.25, told, shown_so)


def _times_for_plus(line: Line, place: Place, left: Place, right: Place) -> None:
    """Two rates multiplied where their sum belongs: ``h*qd1*qd2`` for ``h*(qd1 + qd2)``."""
    last, front = left, np.ones(line.count)
    if isinstance(left.node, ast.BinOp) and isinstance(left.node.op, ast.Mult):
        before, last = line.siblings[id(left)]
        front = before.value
    names = [one.node.id for one in (last, right) if isinstance(one.node, ast.Name)]
    if len({*names}) != 2 or not all(_is_rate(line, name) for name in names):
        return
    start, end = last.span[0], right.span[1]
    new = f"({names[0]} + {names[1]})"
    told, pieces = line.told(
        place, N_("{old} should be {new}"), N_("{old} should be {new} in {term}")
    )
    pieces |= {"old": line.source[start:end], "new": new}
    value = front * (last.value + right.value)
    line.edit(place, value, (start, end, new), "operator", 1.2, told, pieces)


def _is_rate(line: Line, word: str) -> bool:
    """Whether a name is a joint's rate."""
    found = _MOTION.fullmatch(str(line.meaning(word).value))
    return found is not None and found[1] == "qd"


def _wave_of_the_sum(line: Line, place: Place, left: Place, right: Place) -> None:
    """The sine or cosine of a sum as the sum of two: ``sin(q1) + sin(q2)`` for ``sin(q1 + q2)``."""
    wave = _of_both_angles(line, left, right)
    if wave is not None:
        _node(line, place, wave, "argument", 1.2)


def _linear(line: Line, place: Place, left: Place, right: Place) -> None:
    """A sine or cosine of a sum taken for the product: s1*s2 for s12."""
    last = left
    if is_product(left.node) and isinstance(left.node.op, ast.Mult):
        last = line.siblings[id(left)][1]
    wave = _of_both_angles(line, last, right)
    if wave is None:
        return
    start, end = last.span[0], right.span[1]
    told, pieces = line.told(
        place, N_("{old} should be {new}"), N_("{old} should be {new} in {term}")
    )
    pieces |= {"old": line.source[start:end], "new": line.spelled(wave)}
    with np.errstate(all="ignore"):
        value = place.value / (last.value * right.value) * tree.evaluate(wave, line.at)
    line.edit(place, value, (start, end, pieces["new"]), "argument", 1.2, told, pieces)


def _of_both_angles(line: Line, left: Place, right: Place) -> Node | None:
    """The sine or cosine of the sum of two angles, of which both places are that; else None."""
    one, two = _as_wave(line, left), _as_wave(line, right)
    if one is None or two is None or one.op != two.op or one.args == two.args:
        return None
    return tree.call(one.op, tree.add(*one.args, *two.args))


def _as_wave(line: Line, place: Place) -> Node | None:
    """A place that is the sine or cosine of an angle, as such."""
    node, meant = place.node, None
    if isinstance(node, ast.Name):
        meant = line.meaning(node.id)
    elif isinstance(node, ast.Call):
        meant = line.meant(line.segment(place))
    return meant if meant is not None and meant.op in ("sin", "cos") else None


def _is_share(place: Place, left: Place) -> bool:
    """Whether a quotient is ``1/2`` in front of something: a factor of its own."""
    above = place.above.node if place.above is not None else None
    product = isinstance(above, ast.BinOp) and isinstance(above.op, ast.Mult)
    return product and isinstance(left.node, ast.Constant) and left.node.value == 1


def _upside_down(line: Line, place: Place, left: Place, right: Place) -> None:
    """A quotient turned over, whole or in one factor above and one below."""
    start, end = place.span
    above, below = _multiplied(line, left), _multiplied(line, right)
    for one in above:
        for other in below:
            names = [line.source[slice(*x.span)] for x in (one, other)]
            if all(isinstance(x.node, ast.Constant) for x in (one, other)):
                continue
            middle = line.source[one.span[1] : other.span[0]]
            front, behind = line.source[start : one.span[0]], line.source[other.span[1] : end]
            new = f"{front}{names[1]}{middle}{names[0]}{behind}"
            with np.errstate(all="ignore"):
                value = place.value * (other.value / one.value) ** 2
            line.instead(place, new, value, "factor", 1.4)
    if len(above) * len(below) > 1:
        top, bottom = (line.source[slice(*x.span)] for x in (left, right))
        with np.errstate(all="ignore"):
            line.instead(place, f"({bottom})/({top})", 1.0 / place.value, "factor", 1.4)


def _as_fraction(line: Line, place: Place, left: Place, right: Place) -> None:
    """A fraction of two numbers behind a term that does not belong there: ``*180/pi``."""
    if not isinstance(left.node, ast.BinOp) or not isinstance(left.node.op, ast.Mult):
        return
    front, above = line.siblings[id(left)]
    numbers = (above.node, right.node)
    if not all(isinstance(x, ast.Constant) or ast.unparse(x) == "pi" for x in numbers):
        return
    start, end = front.span[1], place.span[1]
    told, pieces = line.told(
        place,
        N_("the factor {factor} does not belong"),
        N_("the factor {factor} does not belong in {term}"),
    )
    pieces |= {"factor": line.source[above.span[0] : end]}
    line.edit(place, front.value, (start, end, ""), "factor", 1.1, told, pieces)


_DECIMAL = re.compile(r"\s*[-+]?\s*(\d+\.\d*[1-9]\d*)(?![\d.eE/]|\s*/)")
"""A number with decimals that a term begins with."""
_TIMES_A_NUMBER = re.compile(r"\s*[*·]\s*\d")


def _is_beside_a_square(place: Place) -> bool:
    """Whether it is a product of two next to a square, as the legs of a triangle are: l*sin(q)."""
    node, above = place.node, None if place.above is None else place.above.node
    if not (isinstance(node, ast.BinOp) and isinstance(node.op, ast.Mult)):
        return False
    if not is_sum(above) or not all(
        isinstance(x, ast.Name | ast.Call) for x in (node.left, node.right)
    ):
        return False
    beside = above.left if node is above.right else above.right
    return isinstance(beside, ast.BinOp) and isinstance(beside.op, ast.Pow)


def _as_factor(line: Line, place: Place) -> None:
    """Squares, and factors that are missing in front of a term."""
    node = place.node
    piece = line.segment(place)
    whole = is_sum(node)
    wrapped = f"({piece})" if isinstance(node, (ast.BinOp, ast.UnaryOp)) else piece
    share = isinstance(node, ast.BinOp) and not whole and _in_brackets(line, place)
    share = share and bool(words_in(piece)) and piece[:1] != "("  # (l1/2), and no \\frac
    leg = _is_beside_a_square(place)
    if (isinstance(node, (ast.Name, ast.Call)) or whole or share or leg) and not _is_base(place):
        rates = whole and all(_is_rate(line, word) for word in words_in(piece))
        cost = 1.4 if whole and not rates else 1.1  # a link's rate is squared as a joint's
        closed = re.match(r"\s*\)", line.source[place.span[1] :])
        outside = _outer_start(line, place) < place.span[0] and closed is not None
        behind = place.span[1] + (closed.end() if closed else 0)
        squared = (behind, behind, "**2") if outside else None
        line.instead(place, f"{wrapped}**2", place.value**2, "power", cost, squared)
    if _is_divisor(place):
        alone = _in_brackets(line, place)
        for name, value in line.atoms.items():
            for power, more in ((1, 0.0), (2, 0.4)):
                word = name if power == 1 else f"{name}**{power}"
                new = f"{word}*{wrapped}" if alone else f"({word}*{wrapped})"
                line.instead(place, new, place.value * value**power, "missing factor", 1.5 + more)
    if whole and not (place.above is not None and isinstance(place.above.node, ast.Call)):
        opened = line.source.rindex("(", 0, place.span[0]) if _in_brackets(line, place) else -1
        with np.errstate(all="ignore"):
            span = None if opened < 0 else (opened, opened, "sqrt")
            line.instead(place, f"sqrt({piece})", np.sqrt(place.value), "power", 1.35, span)
    if not is_term(place):
        return
    start, end = place.span
    first = start + len(piece) - len(piece.lstrip("+- "))
    extra = 0.3 if whole else 0.0
    body = wrapped if whole else piece
    numbered = 0.15 * bool(re.search(r"(?<![\w.*])(?:/\s*)?\d", body))  # 2*x/2 is x
    decimal = re.search(r"(?<![\d.])0?\.5(?!\d)", line.source)
    front_ = _DECIMAL.match(piece)
    for shown, size in _FACTORS.items():
        shown = "0.5" if decimal and shown == "/2" else shown
        number = "" if front_ is None else f"{size * float(front_[1]):.12g}"
        if front_ is not None and 1 < len(number) <= len(front_[1]) + 1:  # 2.943 for 5.886/2
            retyped = (start + front_.start(1), start + front_.end(1), number)
            new = f"{piece[: front_.start(1)]}{number}{piece[front_.end(1) :]}"
            named = line.meanings.parameter(float(front_[1])) is not None
            named &= bool(_TIMES_A_NUMBER.match(piece, front_.end(1)))
            cost = 1.35 + _NAMED * named
            line.instead(place, new, size * place.value, "factor", cost, retyped)
            continue
        new = f"{body}{shown}" if shown[0] == "/" else f"{shown}*{body}"
        cost = (1.2 if size in (2.0, 0.5) else 1.6) + extra + numbered
        span = (end, end, shown) if shown[0] == "/" else (first, first, f"{shown}*")
        line.instead(place, new, size * place.value, "factor", cost, None if whole else span)
    signed = place.above is not None and isinstance(place.above.node, ast.BinOp)
    if not signed or place.role == 0:
        span = (start, first, "" if piece.startswith("-") else "-")
        turned, only = _turned(line, place), None if whole else span
        extra += _OF_NUMBERS * (signed and _is_of_numbers(place.above))
        line.instead(place, turned, -place.value, "sign", 1.0 + extra, only)
    front, before = _openings(line, place)
    for name, value in line.atoms.items():
        at = front if name[0] in "mM" else before
        at = end if name in line.names.loads else at
        for power, more in ((1, 0.0), (2, 0.4)):
            word = name if power == 1 else f"{name}**{power}"
            _times(line, place, word, value**power, 1.4 + more + extra, at)
    moving = [tree.sym(f"{x}{i + 1}") for x in line.names.letters for i in range(line.names.n)]
    waves = [tree.call(f, angle) for angle in line.names.angles for f in ("cos", "sin")]
    for factor in (*moving, *waves):
        value = tree.evaluate(factor, line.at)
        at = before if whole else end
        _times(line, place, line.spelled(factor), value, 1.45 + extra, at)


def _times(line: Line, place: Place, word: str, value: Array, cost: float, at: int) -> None:
    """A factor that is missing in a term, at a place in it; in front of a sum in parentheses."""
    piece, (start, end) = line.segment(place), place.span
    told = _LACKS
    span = (at, at, f"*{word}" if at == end else f"{word}*")
    if is_sum(place.node) and at in place.span:  # no parentheses around it
        span = (start, end, f"{word}*({piece})")
    new = place.value * value
    line.edit(place, new, span, "missing factor", cost, told, {"factor": word, "term": piece})


def _openings(line: Line, place: Place) -> tuple[int, int]:
    """Where a mass, and where another number of the robot, stands in a product: a length before
    the sines, the rates and the parentheses."""
    factors = [f for f in _multiplied(line, place) if not isinstance(f.node, ast.Constant)]
    moving = (_outer_start(line, f) for f in factors if _moves(line, f.node))
    first = _outer_start(line, factors[0]) if factors else place.span[1]
    return first, next(moving, place.span[1])


def _multiplied(line: Line, place: Place) -> list[Place]:
    """The factors of a product in the order of reading, without what it is divided by."""
    node = place.node
    if isinstance(node, ast.UnaryOp):
        return _multiplied(line, line.siblings[id(place)][0])
    if not is_product(node):
        return [place]
    left, right = line.siblings[id(place)]
    more = _multiplied(line, right) if isinstance(node.op, ast.Mult) else []
    return [*_multiplied(line, left), *more]


def _moves(line: Line, node: ast.expr) -> bool:
    """Whether a factor is a sine, a rate or a sum."""
    if isinstance(node, ast.BinOp) and isinstance(node.op, ast.Pow):
        return _moves(line, node.left)
    if isinstance(node, ast.Name):
        meant = line.meaning(node.id)
        word = str(meant.value)
        return meant.op != "sym" or word in line.names.loads or bool(_MOTION.fullmatch(word))
    return isinstance(node, ast.Call) or is_sum(node)


def _outer_start(line: Line, place: Place) -> int:
    """Where a factor begins, with the parentheses around it."""
    start, end = place.span
    if is_sum(place.node):
        closed = re.match(r"[\s)]*", line.source[end:])
        opened = re.search(r"[\s(]*$", line.source[:start])
        many = min(one[0].count(sign) for one, sign in ((closed, ")"), (opened, "(")) if one)
        for _one in range(many):
            start = line.source.rindex("(", 0, start)
    return start


def _turned(line: Line, place: Place) -> str:
    """A piece with the opposite sign, without a sign in front of a sign."""
    if not is_sum(place.node):
        piece = line.segment(place)
        bare = piece.removeprefix("+").lstrip()
        return piece[1:].lstrip() if piece.startswith("-") else f"-{bare}"
    left, right = line.siblings[id(place)]
    gap = line.source[left.span[1] : right.span[0]]
    sign = next(c for c in gap if c in "+-")
    start, end = place.span
    behind = line.source[left.span[1] : end].replace(sign, {"+": "-", "-": "+"}[sign], 1)
    if line.source[start : left.span[0]].strip():  # brackets: -(a + b) - c
        inner = line.source[start : left.span[1]] + ")" * gap[: gap.index(sign)].count(")")
        return f"-{inner}{behind[behind.index({'+': '-', '-': '+'}[sign]) :]}"
    return _turned(line, left) + behind


def _as_term(line: Line, place: Place) -> None:
    """Terms that are missing in a sum between parentheses."""
    node = place.node
    chain = is_sum(node) and not (place.above is not None and is_sum(place.above.node))
    if place.above is None or not (chain or (is_product(node) and _in_brackets(line, place))):
        return
    inside = line.segment(place)
    there = [_factors(line, term) for term in re.split(r"[-+]", inside)]
    rates = {_rates(one) for one in there}
    told, end = N_("the term {term} is missing in {sum}"), place.span[1]
    pieces = [*line.pieces]
    values = np.array([np.broadcast_to(x, (line.count,)) for x in line.pieces.values()])

    def change(k: int) -> Change:
        piece, (sign, near) = pieces[k // 2], (("+", 1.12), ("-", 1.6))[k % 2]
        own = _factors(line, piece)
        twice = 0.4 * (own in there) + _OTHER_RATES * (_rates(own) not in rates)
        cost = near + _FACTOR_MORE * piece.count("*") + twice + _OF_A_PRODUCT * (not chain)
        shown = {"term": piece if sign == "+" else f"-{piece}", "sum": f"({inside})"}
        typed = f"{line.gap}{sign}{line.gap}{piece}"
        return Change(end, end, typed, "missing term", cost, told, (), shown)

    line.put_terms(place, np.stack([values, -values], axis=1).reshape(-1, line.count), change)


_OTHER_RATES = 0.3
"""Cost of a term in a sum whose terms have other rates: of gravity among velocities' squares."""


def _rates(factors: list[str]) -> tuple[int, int]:
    """How many velocities and accelerations stand in a product."""
    count = [0, 0]
    for factor in factors:
        name, _power, exponent = factor.partition("**")
        found = _MOTION.fullmatch(str(canonical(name).value))
        if found and found[1] != "q":
            count[found[1] == "qdd"] += int(exponent or 1)
    return count[0], count[1]


def _in_brackets(line: Line, place: Place) -> bool:
    """Whether a piece stands in parentheses of its own: a sum may have stood there."""
    start, end = place.span
    before, behind = line.source[:start].rstrip(), line.source[end:].lstrip()
    return bool(re.search(r"(?<!\w)\($", before)) and behind.startswith(")")


def _factors(line: Line, term: str) -> list[str]:
    """The robot's names of a product, whatever number stands in front of it."""
    if term not in line.factored:
        found = re.findall(r"(?<![\w.])([A-Za-z_]\w*)((?:\*\*\d)?)", term)
        own = ((words_in(line.text.symbols.get(name, name)), power) for name, power in found)
        line.factored[term] = sorted(f"{word}{power}" for words, power in own for word in words)
    return line.factored[term]


def _whole_terms(line: Line) -> None:
    end = len(line.source)
    for term in line.terms:
        value = line.root.value + np.broadcast_to(tree.evaluate(term, line.at), (line.count,))
        shown = line.spelled(term)
        sign, body = ("-", shown[1:]) if shown.startswith("-") else ("+", shown)
        span = (end, end, f"{line.gap}{sign}{line.gap}{body}")
        told = N_("the term {term} is missing")
        line.edit(line.root, value, span, "missing term", 1.3, told, {"term": shown})


def _is_whole_term(place: Place) -> bool:
    """Whether a piece is a term of the whole formula, beside which another would be one too."""
    while place.above is not None and is_sum(place.above.node):
        place = place.above
    return place.above is None


def _is_exponent(place: Place) -> bool:
    while place.above is not None:
        node = place.above.node
        if isinstance(node, ast.BinOp) and isinstance(node.op, ast.Pow) and place.role == 1:
            return True
        place = place.above
    return False


def _is_divisor(place: Place) -> bool:
    """Whether a piece that is no number is what something is divided by."""
    above = place.above.node if place.above is not None else None
    divided = isinstance(above, ast.BinOp) and isinstance(above.op, ast.Div)
    return divided and place.role == 1 and not isinstance(place.node, ast.Constant)


def _is_base(place: Place) -> bool:
    above = place.above.node if place.above is not None else None
    return isinstance(above, ast.BinOp) and isinstance(above.op, ast.Pow)
