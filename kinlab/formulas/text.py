"""Formulas as text, read by a whitelist over Python's syntax tree. Nothing is ever evaluated."""

from __future__ import annotations

import ast
import math
import re
from collections.abc import Iterable, Mapping
from fractions import Fraction
from itertools import pairwise

from kinlab.formulas import tree
from kinlab.formulas.arithmetic import Meaning, is_arithmetic, read
from kinlab.formulas.signs.refusals import near_names, refused
from kinlab.formulas.tree import Node
from kinlab.host.language import N_, _

LENGTH = 20_000
MOST_NODES = 5_000
_DEPTH = 60
_NESTING = 50
_CHAIN = 400
_DIGITS = 40
_EXPONENT = 6

SHORTHAND = re.compile(r"([cs])_?([1-9]+)")
"""c12 is cos(q1 + q2), s1 is sin(q1), as in every textbook."""
_SYMBOL = 3
"""Digits of a Christoffel symbol."""

_DOTTED = r"dtheta|thetad|dth|thd|qd|dq|theta_?dot_?|q_?dot_?|th_?dot_?"
_TWICE_DOTTED = r"ddtheta|thetadd|ddth|thdd|qdd|ddq|theta_?ddot_?|q_?ddot_?|th_?ddot_?"
_JOINT = tuple(
    (re.compile(rf"(?:{heads})_?([1-9]\d?)"), letter)
    for heads, letter in (("theta|th|q", "q"), (_DOTTED, "qd"), (_TWICE_DOTTED, "qdd"))
)
_DOTTED_BEHIND = re.compile(r"(?:theta|th|q)_?([1-9]\d?)_?(d{1,2})(?:ot)?")
WORD = re.compile(r"(?<![\w.])[A-Za-z_]\w*")
"""A name in a formula; the e of ``1e-4`` is none."""
_ABSOLUTE = re.compile(r"(?:theta|th)(d{0,2})_?((?=[1-9]{2})1?2?3?4?5?6?7?8?9?)")
"""theta12 is q1 + q2, as c12 is its cosine: joints in ascending order."""
_UNDERSCORED = re.compile(r"[A-Za-z]+(?:_[A-Za-z]+)?_?[0-9]+")
_MOTION = re.compile(r"(qdd|qd|q)(\d+)")
_FIRST_RATE = re.compile(r"omega_?1")


def parse(text: str, place: str = "expression") -> Node:
    """Reads one arithmetic expression.

    Args:
        text: numbers, names, ``+ - * / **``, parentheses, and the functions of
            :data:`kinlab.formulas.tree.FUNCTIONS`; ``^`` is read as a power, ``pi`` as the number.
        place: what to put in front of a message.

    Raises:
        ExpressionError: too long, too deep, a huge power, or anything but arithmetic.
    """
    if len(text) > LENGTH:
        raise refused(
            place, N_("{count} characters; at most {length}"), count=len(text), length=LENGTH
        )
    given, text = text, tidied(text)
    _refuse_deep(text, place)
    try:
        parsed = ast.parse(text, mode="eval")
    except (SyntaxError, ValueError) as problem:
        column = getattr(problem, "offset", None)
        said = N_("no arithmetic near column {column}: {text}")
        if column is None:
            said = N_("no arithmetic: {text}")
        elif not 0 < column <= len(text):  # where Python has read it all
            said = N_("no arithmetic, something is missing at the end: {text}")
        shown = f"{_short(given)}{_remedy(text)}"
        raise refused(place, said, column=column, text=shown) from None
    except (RecursionError, MemoryError):
        raise refused(place, N_("nested too deep")) from None
    if sum(1 for _ in ast.walk(parsed)) > 3 * MOST_NODES:
        raise refused(place, N_("more than {most_nodes} terms and factors"), most_nodes=MOST_NODES)
    return _Reader(place).read(parsed.body)


def _remedy(text: str) -> str:
    """What is likely to be missing in a text that is no arithmetic."""
    opened, closed = text.count("("), text.count(")")
    if opened != closed:
        much = _("a bracket is not closed"), _("a bracket is closed too often")
        return _("; ") + much[opened < closed]
    if re.search(r"[\w)] +[\w(]", text):
        return _("; ") + _("write * between factors")
    return ""


def words_in(text: str) -> list[str]:
    """The names in a formula, in their order; of functions, too."""
    return WORD.findall(text)


def tidied(text: str) -> str:
    """The text with ``**`` for ``^``, plain signs and single blanks, as Python reads it."""
    return " ".join(text.replace("^", "**").replace("·", "*").replace("−", "-").split())


SQUARED = "^2"


def square_of(name: str) -> str:
    """What the square of a name is called in plain text: v2_squared of v2^2; others stay."""
    return f"{name.removesuffix(SQUARED)}_squared" if name.endswith(SQUARED) else name


def base_of(name: str) -> str:
    """The name whose square it is: v2 of v2_squared; empty where it is none's."""
    found = re.fullmatch(r"([A-Za-z]{1,8}\d+)_squared", name)
    return found[1] if found else ""


def canonical(name: str) -> Node:
    """What a name means by the field's habits: th1 is q1, c12 is cos(q1 + q2)."""
    angles = _ABSOLUTE.fullmatch(name)
    if angles:
        return tree.add(*(tree.sym(f"q{angles.group(1)}{k}") for k in angles.group(2)))
    if _FIRST_RATE.fullmatch(name):
        return tree.sym("qd1")
    for pattern, letter in _JOINT:
        found = pattern.fullmatch(name)
        if found:
            return tree.sym(f"{letter}{found.group(1)}")
    found = _DOTTED_BEHIND.fullmatch(name)
    if found:
        return tree.sym(f"q{found.group(2)}{found.group(1)}")
    found = SHORTHAND.fullmatch(name)
    if found and _is_a_sum(found.group(2)):
        angle = tree.add(*(tree.sym(f"q{digit}") for digit in found.group(2)))
        return tree.call("cos" if found.group(1) == "c" else "sin", angle)
    return tree.sym(name.replace("_", "") if _UNDERSCORED.fullmatch(name) else name)


def _is_a_sum(digits: str) -> bool:
    """Whether the angles of joints are added: not those of c211, which is Christoffel's symbol."""
    return len(digits) < _SYMBOL or all(a < b for a, b in pairwise(digits))


def joint_spelling(words: Iterable[str], joints: int) -> dict[str, str]:
    """How a writer spells the joints' numbers: where he has th1, q1 is th1 and q2 is th2."""
    found: dict[str, str] = {}
    for word in words:
        meant = canonical(word)
        joint = _MOTION.fullmatch(str(meant.value)) if meant.op == "sym" else None
        if joint and word != meant.value and word.endswith(joint.group(2)):
            head = word[: -len(joint.group(2))]
            for i in range(1, joints + 1):
                found.setdefault(f"{joint.group(1)}{i}", f"{head}{i}")
    return found


def respelled(node: Node, spelling: Mapping[str, str], short: bool) -> Node:
    """A formula as a writer has it.

    Args:
        node: its tree.
        spelling: his names, by the usual ones.
        short: whether he has c12 for cos(q1 + q2).
    """
    if short and node.op in ("sin", "cos"):
        inside = node.args[0].args if node.args[0].op == "add" else node.args
        if all(a.op == "sym" and re.fullmatch(r"q[1-9]", str(a.value)) for a in inside):
            return tree.sym(node.op[0] + "".join(sorted(str(a.value)[1:] for a in inside)))
    if node.op == "sym":
        return tree.sym(spelling.get(str(node.value), str(node.value)))
    if not node.args:
        return node
    return Node(node.op, tuple(respelled(a, spelling, short) for a in node.args), node.value)


class _Reader:
    """Walks one syntax tree; holds the place for its messages."""

    def __init__(self, place: str) -> None:
        self.place = place

    def read(self, node: ast.expr) -> Node:
        meaning: Meaning[Node] = Meaning(
            number=lambda number: tree.num(self._number(number)),
            name=lambda name: tree.num(Fraction(repr(math.pi))) if name == "pi" else tree.sym(name),
            negative=lambda value: tree.mul(tree.num(-1), value),
            binary=self._binary,
            call=self._call,
            admit=self._admit,
        )
        return read(node, meaning)

    def _admit(self, node: ast.expr, depth: int) -> None:
        if depth > _DEPTH + _CHAIN:
            raise refused(self.place, N_("nested deeper than {depth}"), depth=_DEPTH)
        if not is_arithmetic(node):
            kind = type(node).__name__
            raise refused(
                self.place,
                N_(
                    "{kind} is not arithmetic; write numbers, names, + - * / ** ( ) and functions "
                    "such as sin, cos, sqrt"
                ),
                kind=kind,
            )

    def _number(self, number: float) -> Fraction:
        if not math.isfinite(number):
            raise refused(self.place, N_("a number is not finite"))
        value = Fraction(repr(number)) if isinstance(number, float) else Fraction(number)
        return self._bounded(value)

    def _bounded(self, value: Fraction) -> Fraction:
        if max(value.numerator.bit_length(), value.denominator.bit_length()) > 4096:
            raise refused(self.place, N_("a number is too large or too small"))
        return value

    def _binary(self, op: ast.operator, left: Node, right: Node) -> Node:
        if isinstance(op, ast.Pow):
            return self._power(left, right)
        if isinstance(op, ast.Div):
            if right.op == "num" and right.value == 0:
                raise refused(self.place, N_("division by zero"))
            made = tree.mul(left, tree.power(right, Fraction(-1)))
        elif isinstance(op, ast.Mult):
            made = tree.mul(left, right)
        elif isinstance(op, ast.Sub):
            made = tree.add(left, tree.mul(tree.num(-1), right))
        else:
            made = tree.add(left, right)
        if made.op == "num":
            self._bounded(made.value)
        elif made.op == "mul" and made.args[0].op == "num":
            self._bounded(made.args[0].value)
        return made

    def _power(self, base: Node, exponent: Node) -> Node:
        if exponent.op != "num":
            raise refused(self.place, N_("the power {exponent} is not a number"), exponent=exponent)
        value = exponent.value
        if abs(value) > _EXPONENT or value.denominator > 2:
            shown = str(value) if value.numerator.bit_length() < 64 else _("huge")
            raise refused(
                self.place,
                N_(
                    "the power {shown} is beyond what formulas of arms need (up to {exponent}, and "
                    "halves)"
                ),
                shown=shown,
                exponent=_EXPONENT,
            )
        if base.op == "num" and base.value == 0 and value < 0:
            raise refused(self.place, N_("division by zero"))
        made = tree.power(base, value)
        if made.op == "num":
            self._bounded(made.value)
        return made

    def _call(self, name: str, args: list[Node]) -> Node:
        plain = tree.SYNONYMS.get(name, name)
        if plain not in tree.FUNCTIONS:
            choices = near_names(name, [*tree.FUNCTIONS, *tree.SYNONYMS])
            raise refused(
                self.place,
                N_("function {text!r} is unknown; {choices}"),
                text=_short(name),
                choices=choices,
            )
        wanted = 2 if plain == "atan2" else 1
        if len(args) != wanted:
            raise refused(
                self.place,
                N_("{plain} takes {wanted} argument, not {count}"),
                plain=plain,
                wanted=wanted,
                count=len(args),
            )
        if plain == "sqrt":
            return tree.power(args[0], Fraction(1, 2))
        return tree.call(plain, *args)


def refuse_nested(text: str, place: str) -> None:
    """Bounds nesting, before anything looks for where brackets are closed.

    Raises:
        ExpressionError: too many levels.
    """
    depth = deepest = 0
    for character in text:
        depth += {"(": 1, "[": 1, "{": 1, ")": -1, "]": -1, "}": -1}.get(character, 0)
        deepest = max(deepest, depth)
    if deepest > _NESTING:
        raise refused(
            place,
            N_("{deepest} levels of parentheses; at most {nesting}"),
            deepest=deepest,
            nesting=_NESTING,
        )


def _refuse_deep(text: str, place: str) -> None:
    """Bounds nesting and chains before Python's own parser sees the text."""
    refuse_nested(text, place)
    signs = sum(text.count(character) for character in "+-*/")
    if signs > _CHAIN * 4:
        raise refused(place, N_("{signs} operators; at most {most}"), signs=signs, most=_CHAIN * 4)
    if re.search(r"(?:[+-]\s*){8,}", text):
        raise refused(place, N_("a row of signs without numbers"))
    if re.search(rf"\d{{{_DIGITS + 1},}}", text):
        raise refused(place, N_("a number of more than {digits} digits"), digits=_DIGITS)


def _short(text: str) -> str:
    return text if len(text) <= 60 else text[:57] + "..."
