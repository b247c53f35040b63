r"""Formulas as text, read by a whitelist over Python's syntax tree. Nothing is ever evaluated.

A file looks like this (see :func:`formula_file`)::

    robot = "planar2r"

    [symbols]                 # only what the robot's own names (kinlab derive) do not cover
    th1 = "q1"
    L = 0.5

    [formulas]
    tau1 = "(m1 + m2)*l1**2*qdd1 + ..."
    "mass_matrix[0,0]" = "..."

    [latex]
    tau2 = '(m_2 l_2^2 + m_2 l_1 l_2 c_2) \ddot{q}_1 + ...'
"""

from __future__ import annotations

import ast
import math
import re
from collections.abc import Iterable, Mapping
from dataclasses import dataclass, field, replace
from fractions import Fraction
from functools import partial
from typing import Any

from kinlab.errors import ExpressionError, FileError
from kinlab.formulas import grids, tree, typed
from kinlab.formulas.arithmetic import Meaning, is_arithmetic, read
from kinlab.formulas.handed.reading import as_formula
from kinlab.formulas.signs.latex import LAMBDA
from kinlab.formulas.signs.letters import WIDE
from kinlab.formulas.signs.refusals import near_names, refused
from kinlab.formulas.tree import Node
from kinlab.host.language import N_, _

_LENGTH = 20_000
MOST_NODES = 5_000
_DEPTH = 60
_NESTING = 50
_CHAIN = 400
_DIGITS = 40
_EXPONENT = 6
_FORMULAS = 200

SHORTHAND = re.compile(r"([cs])_?([1-9]+)")
"""c12 is cos(q1 + q2), s1 is sin(q1), as in every textbook."""

_DOTTED = r"dtheta|thetad|dth|thd|qd|dq|theta_?dot_?|q_?dot_?|th_?dot_?"
_TWICE_DOTTED = r"ddtheta|thetadd|ddth|thdd|qdd|ddq|theta_?ddot_?|q_?ddot_?|th_?ddot_?"
_JOINT = tuple(
    (re.compile(rf"(?:{heads})_?([1-9]\d?)"), letter)
    for heads, letter in (("theta|th|q", "q"), (_DOTTED, "qd"), (_TWICE_DOTTED, "qdd"))
)
_DOTTED_BEHIND = re.compile(r"(?:theta|th|q)_?([1-9]\d?)_?(d{1,2})(?:ot)?")
_ABSOLUTE = re.compile(r"(?:theta|th)(d{0,2})_?((?=[1-9]{2})1?2?3?4?5?6?7?8?9?)")
"""theta12 is q1 + q2, as c12 is its cosine: joints in ascending order."""
_UNDERSCORED = re.compile(r"[A-Za-z]+(?:_[A-Za-z]+)?_?[0-9]+")
_MOTION = re.compile(r"(qdd|qd|q)(\d+)")
_FIRST_RATE = re.compile(r"omega_?1")


@dataclass(frozen=True)
class FormulaFile:
    """What a formula file holds.

    Attributes:
        path: where it was read.
        robot: a name or path for ``kl.load``.
        symbols: the user's own names: a number, or text over other names.
        formulas: entry name to expression, in the order of the file.
        texts: the formulas as they are written, for plain evaluation.
        as_typed: the same as they were typed: LaTeX, MATLAB, ...
        writing: what all of them say about the writing.
        numbers: names in the texts that stand for a number that was written.
        symbol_texts: the same for symbols; a number as its digits.
        others: the file with another part of a chain of equalities for an entry's formula.
        remarks: what is to be said of how an entry was read.
    """

    path: str
    robot: str
    symbols: dict[str, Node]
    formulas: dict[str, Node]
    texts: dict[str, str]
    symbol_texts: dict[str, str]
    as_typed: dict[str, str]
    writing: typed.Hand
    numbers: Mapping[str, str] = field(default_factory=dict)
    others: tuple[FormulaFile, ...] = ()
    remarks: Mapping[str, str] = field(default_factory=dict)


def formula_file(
    document: Mapping[str, Any], place: str, writing: typed.Hand | None = None
) -> FormulaFile:
    """Reads the formulas of a TOML document.

    Args:
        document: as it was read. ``robot`` is required; ``[symbols]`` gives numbers or other
            names to the user's symbols; every entry of ``[formulas]`` (or of the top level) is a
            formula: its name says what it claims to be (``tau1``, ``g2``, ``M12``, ``C11``,
            ``J11``, ``x``, or a quantity such as ``"fk[0,3]"``). A formula may be typed as
            text, MATLAB, Python or LaTeX, with its left side, or be a matrix
            (:mod:`kinlab.formulas.typed`). Entries of ``[latex]`` are LaTeX.
        place: the file, for messages.
        writing: what more of the same writer's formulas say; None looks at these.

    Raises:
        FileError: the document holds no formulas, or what is none.
        ExpressionError: an expression that is no arithmetic, with the entry's name.
    """
    document = dict(document)
    robot = document.pop("robot", None)
    if not isinstance(robot, str) or not robot:
        raise FileError(f"{place}: " + _('robot is missing; write robot = "planar2r" or a path'))
    symbols = _table(document.pop("symbols", {}), f"{place}: [symbols]")
    if "lambda" in symbols:
        symbols.setdefault(LAMBDA, symbols.pop("lambda"))
    entries = _table(document.pop("formulas", {}), f"{place}: [formulas]")
    typeset = _table(document.pop("latex", {}), f"{place}: [latex]")
    for key, value in document.items():
        if key in _ABOUT:
            continue
        if not isinstance(value, str):
            raise FileError(
                f"{place}: "
                + _("{key!r} is no formula; write it as text in [formulas]").format(key=key)
            )
        entries[key] = value
    for key in typeset.keys() & entries.keys():
        raise FileError(
            f"{place}: "
            + _("{key!r} is given twice, as text and as LaTeX; keep one").format(key=key)
        )
    entries |= {key: f"${_text(value, f'{place}: {key}')}$" for key, value in typeset.items()}
    if not entries:
        raise FileError(
            f"{place}: " + _('no formulas; write [formulas] and lines such as tau1 = "..."')
        )
    for found, what in ((entries, "formulas"), (symbols, "symbols")):
        if len(found) > _FORMULAS:
            raise FileError(f"{place}: {len(found)} {what}; at most {_FORMULAS}")
    remarks: dict[str, str] = {}
    for key, value in list(entries.items()):
        at = f"{place}: {key}"
        entries[key], remarks[key] = as_formula(_text(value, at), key, at)
        parts = typed.several(entries[key], key)
        if parts and not parts.keys() & entries.keys():
            del entries[key]
            entries |= parts
    for key, value in entries.items():
        own, entries[key] = typed.explained(_text(value, f"{place}: {key}"), key)
        used = _SIGNS.sub("", " ".join([*own.values(), entries[key]]))
        for name, formula in own.items():
            unused = name not in used or name[0] == "L"
            if unused and not _readable(formula):
                continue  # beside the formula, and not used in it
            if symbols.setdefault(name, formula) != formula:
                said = N_(
                    "{name} is explained twice; keep one, in front of the formula or in [symbols]"
                )
                raise refused(f"{place}: {key}", said, name=name)
    chains = {key: typed.readings(value, key) for key, value in entries.items()}
    entries = {key: parts[0] for key, parts in chains.items()}
    read = partial(_read, place, robot, symbols, writing)
    others = (read({**entries, key: part}) for key, parts in chains.items() for part in parts[1:])
    remarks = {key: remark for key, remark in remarks.items() if remark}
    return replace(read(entries), others=tuple(others), remarks=remarks)


_SIGNS = re.compile(r"[_{}\\\s]")


def _readable(text: str) -> bool:
    try:
        parse(typed.plain_formula(text))
    except ExpressionError:
        return False
    return True


def _read(
    place: str,
    robot: str,
    symbols: dict[str, Any],
    writing: typed.Hand | None,
    entries: dict[str, str],
) -> FormulaFile:
    as_typed, writing = _opened(entries, symbols, place, writing)
    entries, symbols = _plain(as_typed, symbols, place, writing)
    return FormulaFile(
        place,
        robot,
        {name: _symbol(value, f"{place}: symbol {name!r}") for name, value in symbols.items()},
        {name: parse(value, f"{place}: {name}") for name, value in entries.items()},
        {name: tidied(value) for name, value in entries.items()},
        {
            name: tidied(value if isinstance(value, str) else repr(float(value)))
            for name, value in symbols.items()
        },
        as_typed,
        writing,
    )


_ABOUT = ("title", "source", "name")
"""Keys of a formula file that tell about it."""

_TABLES = ("formulas", "latex")
_WORD = re.compile(r"[A-Za-z]\w*")


def entries_of(document: Mapping[str, Any]) -> list[str]:
    """The names of the entries of a formula file's document, readable or not."""
    tables = [table for key in _TABLES if isinstance(table := document.get(key), dict)]
    plain = (key for key in document if key not in (*_ABOUT, *_TABLES, "robot", "symbols"))
    return list(dict.fromkeys([*(name for table in tables for name in table), *plain]))


def with_entries(document: Mapping[str, Any], kept: set[str]) -> dict[str, Any]:
    """The document of a formula file with those entries alone, and what they stand on."""
    left = {
        key: value
        for key, value in document.items()
        if key in (*_ABOUT, *_TABLES, "robot", "symbols") or key in kept
    }
    for key in _TABLES:
        if isinstance(table := left.get(key), dict):
            left[key] = {name: value for name, value in table.items() if name in kept}
    return left


def alone(document: Mapping[str, Any], entry: str) -> dict[str, Any]:
    """The document of a formula file with one entry, and those that its text names."""
    kept, waiting = {entry}, [entry]
    while waiting:
        one = with_entries(document, {waiting.pop()})
        texts = [one, *(one.get(key, {}) for key in _TABLES)]
        words = {w for text in texts for value in text.values() for w in _WORD.findall(str(value))}
        more = (words & {*entries_of(document)}) - kept
        waiting += sorted(more)
        kept |= more
    return with_entries(document, kept)


def parse(text: str, place: str = "expression") -> Node:
    """Reads one arithmetic expression.

    Args:
        text: numbers, names, ``+ - * / **``, parentheses, and the functions of
            :data:`kinlab.formulas.tree.FUNCTIONS`; ``^`` is read as a power, ``pi`` as the number.
        place: what to put in front of a message.

    Raises:
        ExpressionError: too long, too deep, a huge power, or anything but arithmetic.
    """
    if len(text) > _LENGTH:
        raise refused(
            place, N_("{count} characters; at most {length}"), count=len(text), length=_LENGTH
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


def tidied(text: str) -> str:
    """The text with ``**`` for ``^``, plain signs and single blanks, as Python reads it."""
    return " ".join(text.replace("^", "**").replace("·", "*").replace("−", "-").split())


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
    if found:
        angle = tree.add(*(tree.sym(f"q{digit}") for digit in found.group(2)))
        return tree.call("cos" if found.group(1) == "c" else "sin", angle)
    return tree.sym(name.replace("_", "") if _UNDERSCORED.fullmatch(name) else name)


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
            return tree.sym(node.op[0] + "".join(str(a.value)[1:] for a in inside))
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


def _refuse_deep(text: str, place: str) -> None:
    """Bounds nesting and chains before Python's own parser sees the text."""
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
    signs = sum(text.count(character) for character in "+-*/")
    if signs > _CHAIN * 4:
        raise refused(place, N_("{signs} operators; at most {most}"), signs=signs, most=_CHAIN * 4)
    if re.search(r"(?:[+-]\s*){8,}", text):
        raise refused(place, N_("a row of signs without numbers"))
    if re.search(rf"\d{{{_DIGITS + 1},}}", text):
        raise refused(place, N_("a number of more than {digits} digits"), digits=_DIGITS)


def _table(value: Any, place: str) -> dict[str, Any]:
    if not isinstance(value, dict):
        raise FileError(f"{place} is {type(value).__name__}; it must be a table of names")
    return dict(value)


def _symbol(value: Any, place: str) -> Node:
    if isinstance(value, bool) or not isinstance(value, (int, float, str)):
        raise refused(place, N_("{kind}; give a number, or other names"), kind=type(value).__name__)
    if isinstance(value, str):
        return parse(value, place)
    if not math.isfinite(value) or abs(value) > 1e30:
        raise refused(place, N_("{value} is not a usable number"), value=value)
    return tree.num(Fraction(repr(float(value))))


def _opened(
    entries: dict[str, Any], symbols: dict[str, Any], place: str, writing: typed.Hand | None
) -> tuple[dict[str, str], typed.Hand]:
    """Formulas as typed, a matrix as its entries; and what they say about the writing."""
    meant = [value for value in symbols.values() if isinstance(value, str)]
    if writing is None:
        writing = typed.hand([*entries.values(), *meant], symbols)
    writing = replace(writing, known=writing.known | {*symbols})
    return grids.opened(entries, place, writing), writing


def _plain(
    entries: dict[str, str], symbols: dict[str, Any], place: str, writing: typed.Hand
) -> tuple[dict[str, str], dict[str, Any]]:
    """Formulas and symbols as typed, made plain."""
    formulas = {}
    for name, value in entries.items():
        formulas[name] = typed.plain_formula(value, f"{place}: {name}", writing)
        typed.refuse_omega(formulas[name], f"{place}: {name}", symbols)
    explained = {
        name: typed.plain_formula(value, f"{place}: symbol {name!r}", writing)
        for name, value in symbols.items()
        if isinstance(value, str)
    }
    named = {typed.square_of(name): value for name, value in (symbols | explained).items()}
    return formulas, _as_read(named, formulas.values(), explained.values())


def _as_read(
    symbols: dict[str, Any], formulas: Iterable[str], explained: Iterable[str]
) -> dict[str, Any]:
    """The symbols by the names that LaTeX's are read as: L_1 is L1 where no text has it as L_1."""
    met, meant = ({w for text in x for w in _WORD.findall(text)} for x in (formulas, explained))
    joined = {name: name.replace("_", "") for name in symbols.keys() - met - meant if "_" in name}
    return {
        joined[name] if joined.get(name) in met - meant - symbols.keys() else name: value
        for name, value in symbols.items()
    }


def _text(value: Any, place: str) -> str:
    if isinstance(value, list):  # a matrix as TOML has it
        value = "[" + ", ".join(_text(one, place) for one in value) + "]"
    if not isinstance(value, str):
        raise refused(place, N_("{kind}; write the formula as text"), kind=type(value).__name__)
    if len(value) > _LENGTH:
        raise refused(
            place, N_("{count} characters; at most {length}"), count=len(value), length=_LENGTH
        )
    return value.translate(WIDE)


def _short(text: str) -> str:
    return text if len(text) <= 60 else text[:57] + "..."
