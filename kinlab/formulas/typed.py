r"""Formulas as people type them, made plain: LaTeX, MATLAB, Python, letters of Unicode, matrices.

``\tau_2 = ...``, ``θ̇₁²``, ``cos(q(2))``, ``np.cos(q[1])``, ``M = [a, b; c, d]`` become names and
arithmetic that :mod:`kinlab.formulas.text` reads. What two people would read differently is
refused, with what to write instead: a formula misread is worse than one not read.
"""

from __future__ import annotations

import re
import unicodedata
from collections.abc import Container, Iterable, Sequence
from contextlib import suppress
from dataclasses import dataclass
from functools import lru_cache, partial

import numpy as np

from kinlab.errors import ExpressionError
from kinlab.formulas import tree
from kinlab.formulas.signs import latex
from kinlab.formulas.signs.beside import with_products
from kinlab.formulas.signs.brackets import closes, parts_at
from kinlab.formulas.signs.degrees import in_radians
from kinlab.formulas.signs.letters import ABOVE, BELOW, SIGNS, WIDE, ascii_text, with_dots
from kinlab.formulas.signs.named import is_named, is_named_elsewhere, plain_name
from kinlab.formulas.signs.refusals import refused
from kinlab.formulas.signs.remarks import without_remarks
from kinlab.formulas.text import SQUARED, canonical, parse, square_of
from kinlab.host.language import N_, _

# -------- Which writing it is

_LATEX = re.compile(r"\\[A-Za-z,;:!]|\$|[_^]\{")
_MODULES = "np|numpy|math|Math|sp|sympy"
_PREFIX = re.compile(rf"(?<![\w.])(?:{_MODULES})\.(?=[A-Za-z])")
_CONSTANT = re.compile(r"(?<![\w.])Math\.PI(?!\w)")
_BRACKETS = re.compile(r"(?<![\w.])([A-Za-z]\w*)\s*\[\s*(-?\d+)\s*\]")
_INDEXED = re.compile(r"(?<![\w.])([A-Za-z]\w*)\(\s*(\d+)\s*\)")
_UPPER = re.compile(r"(?<![\w.])([CS])_?([1-9]+)(?!\w)")
_RATES = re.compile(r"(?<![A-Za-z])(?:(?:q|th|theta)d{1,2}|d{1,2}(?:q|th|theta))_?\d|dot|omega")
_OMEGA = re.compile(r"(?<![\w.])(omega|w)_?([1-9])(?!\w)")


@dataclass(frozen=True)
class Hand:
    """What all formulas of one writer together say about the writing.

    Attributes:
        from_zero: whether an index in brackets counts from 0; None where nothing says so.
        capitals: whether S1 and S12 stand somewhere, so that C12 is a cosine too.
        known: names that the writer explains elsewhere.
    """

    from_zero: bool | None = None
    capitals: bool = False
    known: frozenset[str] = frozenset()


def hand(texts: Iterable[str], known: Iterable[str] = ()) -> Hand:
    """Looks for what the writing is, over all formulas of one writer."""
    whole = "\n".join(texts)
    zero = any(int(k) == 0 for _, k in _BRACKETS.findall(whole)) or bool(_PREFIX.search(whole))
    capitals = any(letter == "S" for letter, _ in _UPPER.findall(latexless(whole)))
    return Hand(True if zero else None, capitals, frozenset(known))


def latexless(text: str) -> str:
    """``S_{12}`` as ``S12``, for a look at the names."""
    return re.sub(r"_\{?(\w+)\}?", r"\1 ", text)


# -------- Products without a sign

_ALONE = re.compile(
    r"(?:(?<![A-Za-z])(?:sin|cos|tan|sqrt)(?![A-Za-z])|(?<![A-Za-z])[A-Za-z](?![A-Za-z])|[^A-Za-z])*"
)
"""Text without words: names of one letter, and functions."""
_GLUED_NUMBER = re.compile(r"(?<![\w.])\d+[A-Za-z]{2}")
_WORD_BELOW = re.compile(r"_[A-Za-z]{2}")
_NUMBERED_NAME = re.compile(r"(?<![A-Za-z])[A-Za-z]\d")
_WORDS = """
    lc qd qdd th thd dq ddq dth tau phi psi eta pi xd yd xdd ydd dx dy ddx ddy xt yt zt xb yb zb uHw
    vx vy vz ax ay az ux uy wx wy wz px py pz
    rx ry rz cx cy cz mx my mz nx ny nz fx fy fz Ix Iy Iz Ixx Iyy Izz Ixy Ixz Iyz Ia IA Im IL Jm Jv
    Jw mp me mA mB rA np sin cos tan mod abs exp log det rot dot
""".split()  # noqa: SIM905  a list of seventy
"""Names and functions of several letters, of which none is a product."""
_GLUED = re.compile(r"_\w[A-Za-z]")
"""A product of names without a sign or a blank, as only LaTeX has it."""
_CENTRE = re.compile(r"l_?c_?([₀-₉]+|(?<=_c)[1-9](?![A-Za-z0-9_.]))")

# -------- A formula

_CHAINED = re.compile(r"(?:\*\*|\^)\s*[+-]?\s*(?:[\w.]+|\([^()]*\))\s*(?:\*\*|\^)")
_ELEMENTWISE = re.compile(r"(?<=[\w)\]\s])\.\s?([*/^])")
_FOLLOWING = re.compile(r"[A-Za-z]\w*\d$")
_NO_INDEX = {"c", "s", "C", "S", "pi"}


def plain_formula(text: str, place: str = "expression", writing: Hand | None = None) -> str:
    """The right side of a formula as plain text: names and arithmetic.

    Args:
        text: LaTeX (told by a backslash, a dollar or a brace), or text with the signs of
            kinlab, MATLAB or Python.
        place: what to put in front of a message.
        writing: what the writer's formulas together say; None looks at this one alone.

    Raises:
        ExpressionError: what cannot be read surely.
    """
    writing = hand([text]) if writing is None else writing
    typeset = is_latex(text)
    text = _CAPITAL_FUNCTION.sub(_small, with_dots(bare(text)))
    text = in_radians(text, "pi" if text.isascii() and not typeset else "π", calls=not typeset)
    if not typeset and _side_by_side(text, writing):
        text = _CENTRE.sub(lambda m: f"l_{{c{m[1].translate(BELOW)}}}", text)
        typeset, text = True, text.replace("**", "^")
    text = ascii_text(text, place, as_latex=typeset)
    if typeset:
        text = latex.expression(text, place, known=writing.known)
    else:
        text = _waves_apart(_plain_signs(text, place), place, writing)
        text = with_products(_without_indices(text, place, writing), _FUNCTIONS, place)
        text = _LAMBDA.sub(latex.LAMBDA, text)
    return _with_squares(_capitals(text, place, writing), place, writing)


_LAMBDA = re.compile(r"(?<![\w.])lambda(?!\w)")
"""A name that Python has a use for."""

_OF_ONE_LETTER = (
    r"sin|cos|tan|sqrt|lc[₀-₉]+|[FM][xyz](?![^\W\d_])|[^\W\d_][\u0307\u0308]?(?:_?\d+|[₀-₉]+)?"
)
_OF_LETTERS = (
    rf"[csCS]\d+(?=(?:[csCS]\d+)+(?!\w))|(?:(?:{_MODULES})\.)?[^\W\d][^\W⁰¹²³⁴-⁹½]*[\u0307\u0308]?[^\W⁰¹²³⁴-⁹½]*"
    r"(?:\(\s*\d+\s*\)|\[\s*\d+\s*\])?['′″]*"
)
_REST = r"|[⁰¹²³⁴-⁹]|\d+\.?\d*(?:[eE][+-]?\d+)?|[-+−–]"


def leaves_of(text: str, place: str, writing: Hand, typeset: bool) -> list[latex.Leaf]:
    """The leaves of a formula as typed: names, numbers, functions and signs, with their places.

    Args:
        text: without dollars or a left side; what :func:`plain_formula` can read.
        place, writing: as there.
        typeset: whether there were dollars around it.
    """
    found: list[latex.Leaf] = []
    text = _CAPITAL_FUNCTION.sub(_small, text)
    typeset = typeset or _side_by_side(text, writing)
    if typeset and text.isascii():
        latex.expression(text.replace("**", " ^"), place, found, writing.known)
        return found
    for piece in re.finditer((_OF_ONE_LETTER if typeset else _OF_LETTERS) + _REST, text):
        plain = piece.group().translate(ABOVE)
        if not plain.isdigit():
            with suppress(ExpressionError):  # a function's name alone is no formula
                plain = plain_formula(plain.translate(SIGNS), place, writing)
        found.append(latex.Leaf(plain, *piece.span()))
    return found


def _side_by_side(text: str, writing: Hand) -> bool:
    """Whether a text without a backslash has its factors side by side: m₁l₁² cos θ₂, m_1 gl_1.

    A name that the writer explains is none of these, whatever its letters.
    """
    text = _CENTRE.sub(r"l\1", text)
    indexed = "_" in text and not _NUMBERED_NAME.search(text)
    if text.isascii() and not _GLUED.search(text) and not (indexed and _GLUED_NUMBER.search(text)):
        return False
    if _ALONE.fullmatch(text):
        return True
    own = (re.split(r"[\d_]", name)[0] for name in writing.known)
    return "*" not in text and _runs_together(text, {*_WORDS, *own})


def _runs_together(text: str, names: Container[str]) -> bool:
    """Whether its words are letters side by side, and functions behind these: gl₁cosθ₁, 2ex."""
    words = re.findall(r"[A-Za-z]+", text)
    letters = [re.sub(r"(?:sin|cos|tan|sqrt)$", "", word) for word in words]
    apart = (len(x) < 2 or (x not in names and len(x) < 4) for x in letters)
    return not _WORD_BELOW.search(text) and "[" not in text and all(apart)


def is_latex(text: str) -> bool:
    """Whether a formula is LaTeX."""
    return bool(_LATEX.search(text))


_DISPLAYS = (
    "equation equation* align align* aligned gather gather* gathered multline multline* split "
    "cases dcases displaymath math"
)
_OUTSIDE = (
    *(("$$", "$$"), ("$", "$"), (r"\[", r"\]"), (r"\(", r"\)")),
    *((rf"\begin{{{name}}}", rf"\end{{{name}}}") for name in _DISPLAYS.split()),
)


_COMMENT = re.compile(r"(?<!\\)%.*")
"""What MATLAB and LaTeX leave out."""


_LONG_BARS = re.compile(r"\\left\s*\|\s*J\s*\\right\s*\||\\lvert\s*J\s*\\rvert")
_GAP = re.compile(r"\s{12,}")


def without_gaps(text: str) -> str:
    """The text with one blank for many, or one end of a line."""
    return _GAP.sub(lambda gap: "\n" if "\n" in gap[0] else " ", text)


def bare(text: str) -> str:
    """A formula without the dollars and environments around it, and what says nothing behind it."""
    text = without_gaps(text.translate(WIDE))
    text, before = _LONG_BARS.sub("|J|", _COMMENT.sub("", text)).strip(), ""
    while text != before:
        before = text = without_remarks(text).strip()
        for opening, closing in _OUTSIDE:
            long_enough = len(text) >= len(opening) + len(closing)
            if long_enough and text.startswith(opening) and text.endswith(closing):
                text = text[len(opening) : -len(closing)].strip()
        text = text.rstrip("\\;, \n\t")
        if re.search(r"[\w)}]\s*\.$", text):
            text = text[:-1].strip()
    return text


_POWER = re.compile(r"(?<![\w.])(?:power|pow)\s*(?=\()")
_CAPITAL_FUNCTION = re.compile(r"(?<![\w.\\])[A-Z][A-Za-z]+2?(?=\s*\()")
_DEGREES = re.compile(r"(?<![\w.])a?(sin|cos|tan)d\s*\(")


def _plain_signs(text: str, place: str) -> str:
    text = _PREFIX.sub("", _CONSTANT.sub("pi", text))
    text = _with_powers(_ELEMENTWISE.sub(r"\1", text))
    if found := _DEGREES.search(text):
        raise refused(
            place,
            N_("{found}...) takes degrees, and joints are in radians; write {found2}"),
            found=found[0],
            found2=found[1],
        )
    if _CHAINED.search(text):
        raise refused(
            place,
            N_(
                "a power of a power without parentheses: Python reads a^b^c from the right, "
                "MATLAB from the left; write (a^b)^c"
            ),
        )
    return text


_WAVES = re.compile(r"(?<![\w.])(\d*\.?\d+)?((?:[cs]\d+){2,}|(?:[CS]\d+){2,})(?!\w)")
_WAVE = re.compile(r"[csCS]\d+")


def _waves_apart(text: str, place: str, writing: Hand) -> str:
    """``5.89s1s2`` as ``5.89s1 s2``, a product of sines and cosines, unless s1s2 is a name."""

    def apart(found: re.Match[str]) -> str:
        number, name = found.groups()
        if name in writing.known:
            return found[0]
        waves, behind = _WAVE.findall(name), text[found.end() :].lstrip()
        if behind[:1] == "^" or behind[:2] == "**":
            remedy = _("{call}, with parentheses").format(call="*".join(waves))
            said = N_("{what} can be read in two ways; write {remedy}")
            raise refused(place, said, what=f"{name}^", remedy=remedy)
        return (number or "") + " ".join(waves)

    return _WAVES.sub(apart, text)


_NUMBERED = re.compile(r"([A-Za-z]+)(\d*)")
_TWO = r"\s*(?:\*\*|\^)\s*(?:2|\(2\))(?![\w.]|\s*(?:\*\*|\^))"


def _with_squares(text: str, place: str, writing: Hand) -> str:
    """``v2**2`` as v2_squared where the writer explains v2^2 and not v2.

    Raises:
        ExpressionError: v2 stands there without its square.
    """
    for square in sorted(one for one in writing.known if one.endswith(SQUARED)):
        name = square.removesuffix(SQUARED)
        found = _NUMBERED.fullmatch(name)
        if found is None:
            continue
        alone = rf"(?<![\w.]){found[1]}_?{found[2]}(?!\w)"
        text = re.sub(alone + _TWO, square_of(square), text)
        if name not in writing.known and re.search(alone, text):
            said = N_("{name} stands alone, and only {square} is explained; explain {name}")
            raise refused(place, said, name=name, square=square)
    return text


def _small(found: re.Match[str]) -> str:
    """A function's name in small letters: ``COS(``, ``Sqrt(``, ``Atan2(``."""
    name = found[0]
    known = name.lower() in _FUNCTIONS and name in (name.upper(), name.capitalize())
    return name.lower() if known else name


def _with_powers(text: str) -> str:
    """``power(a, 2)`` and ``pow(a, 2)`` as ``(a)**(2)``."""
    while found := _POWER.search(text):
        end = closes(text, found.end())
        parts = parts_at(text[found.end() + 1 : end], ",")
        if end < found.end() or len(parts) != 2:
            break
        base, power = (part if part.isalnum() else f"({part})" for part in parts)
        text = f"{text[: found.start()]}{base}**{power}{text[end + 1 :]}"
    return text


def _without_indices(text: str, place: str, writing: Hand) -> str:
    """``q(2)`` and ``q[1]`` as ``q2``; what may count from 0 or from 1 is refused."""
    called = _INDEXED.search(text)
    if _BRACKETS.search(text):
        if called and called[1] not in _FUNCTIONS:
            raise refused(
                place,
                N_(
                    "{found} beside an index in brackets: counted from 1 as in MATLAB, or from 0 "
                    "as in Python? write q1, q2, ... for the joints"
                ),
                found=called[0],
            )
        text = _BRACKETS.sub(lambda found: _numbered(found, place, writing), text)
    return _INDEXED.sub(lambda found: _matlab(found, place), text)


def _numbered(found: re.Match[str], place: str, writing: Hand) -> str:
    name, number = found[1], int(found[2])
    if number < 0:
        raise refused(
            place, N_("{found} counts from the end; write the joint's number"), found=found[0]
        )
    if writing.from_zero is None:
        raise refused(
            place,
            N_(
                "{found}: counted from 0 as in Python, or from 1? nothing else in the formulas "
                "says so; write {name}1, {name}2, ... for joints 1, 2, ..."
            ),
            found=found[0],
            name=name,
        )
    return _joined(name, number + 1, found[0], place)


def _matlab(found: re.Match[str], place: str) -> str:
    name, number = found[1], int(found[2])
    if name in _FUNCTIONS:
        return found[0]
    if number == 0:
        raise refused(place, N_("{found}: an index in parentheses counts from 1"), found=found[0])
    return _joined(name, number, found[0], place)


def _joined(name: str, number: int, shown: str, place: str) -> str:
    if _FOLLOWING.fullmatch(name) or name in _NO_INDEX:
        raise refused(
            f"{place}: {shown}",
            N_("an index behind {name!r} has no sure meaning; write * for a product"),
            name=name,
        )
    return f"{name.rstrip('_')}{number}"


_CALLED = (
    "sin cos tan sqrt atan2 asin acos atan abs exp log sign arcsin arccos arctan arctan2 Abs ln"
)
_FUNCTIONS = set(_CALLED.split())
"""As in :mod:`kinlab.formulas.tree`, with the other names."""


def _of_equation(found: re.Match[str], text: str) -> bool:
    """Whether C1 stands beside A1 and B1, as in A1 cos + B1 sin = C1."""
    return found[1] == "C" and all(
        re.search(rf"(?<![\w.]){letter}_?{found[2]}(?!\w)", text) for letter in "AB"
    )


_OF_CORIOLIS = re.compile(r": (?:C_?\d\d|coriolis_matrix\[\d,\d\])$")
"""The place of an entry of the matrix whose other entries are no cosines."""


def _capitals(text: str, place: str, writing: Hand) -> str:
    """``C12`` and ``S1`` as ``c12`` and ``s1``, unless C12 may be an entry of a matrix."""
    known = writing.known | {m[0] for m in _UPPER.finditer(text) if _of_equation(m, text)}
    found = [m for m in _UPPER.finditer(text) if m[0] not in known]
    if not found:
        return text
    own = [m for m in found if m[1] == "C" and len(m[2]) > 1 and _OF_CORIOLIS.search(place)]
    unsure = not writing.capitals and not any(m[1] == "S" for m in found) and _RATES.search(text)
    if own or unsure:
        name = (own or found)[0][0]
        raise refused(
            f"{place}: {name}",
            N_("a cosine, or an entry of the matrix C? write {small} or cos(...) for the cosine"),
            small=name.lower(),
        )

    def small(m: re.Match[str]) -> str:
        return m[0] if m[0] in known else f"{m[1].lower()}{m[2]}"

    return _UPPER.sub(small, text)


def rates_of_joints(text: str, place: str, known: Iterable[str]) -> dict[str, str]:
    """What ``omega2`` means, which is a joint's rate to some, and a link's to others.

    Where it is added to the one before, ``omega1 + omega2``, it is a joint's.

    Args:
        text: a formula as plain text.
        place: what to put in front of a message.
        known: names that the writer explains.

    Raises:
        ExpressionError: it stands there, and nothing says what it is.
    """
    found: dict[str, str] = {}
    for one in _OMEGA.finditer(text):
        name, letter, k = one[0], one[1], int(one[2])
        if name in known:
            continue
        added = rf"\b{letter}_?(?:{k - 1}\s*\+\s*{letter}_?{k}|{k}\s*\+\s*{letter}_?{k + 1})(?!\w)"
        if re.search(added, text):
            found[name] = f"qd{k}"
        elif letter == "omega" and k > 1:
            raise refused(
                place,
                N_(
                    "{found}: the rate of joint {k}, or the angular velocity of link {k}? write "
                    "qd{k} or the sum of rates, or explain it in [symbols]"
                ),
                found=name,
                k=k,
            )
    return found


# -------- Left sides, and several equations

_ENTRY = re.compile(r"([A-Za-z]+)_?((?:\d_?\d?_?\d?)?)", re.ASCII)
_PRINTED = {"fk": "T", "L": "lagrangian"}
"""What ``kinlab derive`` calls a quantity whose name elsewhere is another."""
_OF_STATE = re.compile(
    r"\s*(?:\\left)?\s?\((?=[^()]*[A-Za-zθ])(?:[\s,;{}_·'~\d₀-₉]|\\[,;:! ]|\\right(?![A-Za-z])"
    r"|\\?(?:d{0,3}dot|boldsymbol|mathbf|mathrm|vec|bm|var|theta|Theta|phi|psi|xi|tau|omega|alpha|th|qd{0,2}|d{0,2}q"
    r"|[qQtxXvaT]|[θΘϑφτω]|q̇|q̈|θ̇|θ̈|[\u0300-\u036f])(?![A-Za-z])|\\var(?=theta|phi)){1,60}\)$"
)
"""The state behind a name, ``C(\\theta, \\dot\\theta)``, and no factor: ``m_3(l_3 + ...)``."""
_TIMES_RATES = re.compile(r"(?<=\))\s*(?:\\cdot\s*)?\\dot\s*(?:\{\s*)?\\?[A-Za-z]+\s*\}?$")
"""The rates that a matrix is multiplied by, behind its name: C(q, \\dot q) \\dot q."""
_IN_BASE = re.compile(r"^(?:\{\s*\})?\^(?:0|\{\s*0\s*\})(?:_(?:\w|\{\s*\w\s*\}))?")
"""The base frame in front of a name, and of which frame: {}^0_4T."""
_NAMED = re.compile(r"([a-z_]{2,})(\[[\d:,\s-]+\])?")
_LONGEST_NAME = 120


def sides(text: str, place: str = "expression") -> tuple[str, str]:
    """Left and right of the sign of equality; the left is empty where there is none.

    Raises:
        ExpressionError: more than one sign of equality, or none of its sides.
    """
    typeset = is_latex(text)
    text = bare(text)
    parts = re.sub(r"&?\s*:?=\s*(?:\{\s*\})?\s*&?", "=", text).split("=")
    if len(parts) > 2 or any(p.rstrip()[-1:] in ("<", ">", "!") for p in parts[:-1]):
        raise refused(
            place,
            N_(
                "{count} signs of equality; write one name = formula, and of several each as "
                "an entry of [formulas] in a file for kinlab check"
            ),
            count=len(parts) - 1,
        )
    if len(parts) == 1:
        return "", f"${text}$" if typeset else text
    if not parts[1].strip():
        raise refused(place, N_("nothing stands behind the sign of equality"))
    left, right = (part.strip() for part in parts)
    typeset = typeset and (is_latex(right) or "*" not in right or "$" in text)
    return left, f"${right}$" if typeset else right


_NAMED_NEXT = r"(?=(?:\\d?dot\s+)?[\\\w{}]{1,40}(?:\(q\)|\^\{?2\}?|\*\*2)?\s*&?\s*:?=)"
_AND = r"(?:and|和|且)(?=\s)"
_SPACES = r"\s|~|\\[,;:! ]|\\q?quad(?![A-Za-z])"
_NEXT = re.compile(
    r"(\n|(?<!\\);|\\\\(?:\[[^\]]*\])?|(?:(?<!\\),|\\q?quad(?![A-Za-z])"
    rf"|\\text\s*\{{\s*(?:and|和|且)|(?<=\s){_AND})"
    rf"(?:\s*\}}|\\text\s*\{{\s*(?:and|和|且)\s*\}}|{_AND}|{_SPACES}){{0,20}}+{_NAMED_NEXT})"
)
"""What ends an equation: a line's end, a semicolon, a comma or an "and" before the next name."""
_WHERE = re.compile(
    r"[,;]?\s*(?:\\q?quad\s*)?(?:\\text\{\s*(?:where|with)\s*\}|\bwhere\b"
    rf"|(?<=[\s,;])with\s+{_NAMED_NEXT})\s*"
)
"""What stands between a formula and what is explained behind it."""
_GOES_ON = re.compile(
    r"(?<=\\\\)[ \t]*\n|(?<=[-+*/^=(,])\s*\n"
    r"|\n(?=\s*(?:[-+*/^=),]|(?:\\text\s*\{\s*)?(?:where|with)\b))"
)
_DEFINED = re.compile(r":\s*=|\\coloneqq(?![A-Za-z])")
_SIGNED = re.compile(r"(?:[&\s]|\\q?quad(?![A-Za-z])|\\[,;:! ])*+[-+*/=]")
_MATRIX = re.compile(r"\[|\\begin|diag")
_LONG_NAME = re.compile(r"[a-z]{4}|fk")
_EDGES = re.compile(rf"^(?:[&]|{_SPACES})+|(?:[&]|{_SPACES})+$")
_UNENDED = re.compile(r"[-+*/=](?:[&\s]|\\[,;:! ]|\\q?quad){0,9}$")
_OWN_NAME = re.compile(r"[\\\w{} ]+")
_NAME = re.compile(r"[A-Za-z]\w*(?:\[[\d,]+\])?")
EXPLAINED_TWICE = N_("{name} is explained twice; keep one, in front of the formula or in [symbols]")


def explained(text: str, entry: str = "", place: str = "expression") -> tuple[dict[str, str], str]:
    """A formula with what its writer explains: ``h = m2*l1*l2*s2; C11 = -h*qd2``.

    Args:
        text: as typed.
        entry: what the formula is asked for.
        place: what to put in front of a message.

    Returns:
        The writer's names with their formulas, as typed; and the formula itself: the one with the
        entry's name, the one without a name, the one in front of ``where``, or the last one.

    Raises:
        ExpressionError: a name is explained twice, and not alike.
    """
    lines, gives = _in_order(text, entry)
    others = [line for line in lines[:-1] if line not in gives]
    own = [*map(_ends, others)]
    if not lines[:-1] or not all(map(_may_be_taken, lines[:-1])):
        return {}, text
    left = lines[-1].partition("=")[0] if "=" in lines[-1] else ""
    if not all(_is_own_name(name.strip("& ")) for name, *_rest in own):
        return {}, text
    if left and lines[-1] not in gives and _may_be_another(lines):
        return {}, text
    if entry and left:
        named = entry_name(left, writing=hand([text]))
        if not of_one_name(named, entry_name(entry)):
            return {}, text
    for name, sides in _explaining(others).values():
        if _held_against_the_last(sides)[0]:
            raise refused(place, EXPLAINED_TWICE, name=name)
    dollars = "$" if is_latex(text) else ""
    formulas = {own_name(name): f"{dollars}{bare(right)}{dollars}" for name, _sign, right in own}
    for line in others:
        for name in _also_given(line):
            formulas.setdefault(own_name(name), f"{dollars}{bare(_ends(line)[2])}{dollars}")
    return formulas, f"{dollars}{lines[-1]}{dollars}"


def _may_be_another(lines: Sequence[str]) -> bool:
    """Whether an equation before the last may as well be meant: of a last one with a letter that no
    book has, and one before it whose letter no other uses.
    """
    *others, last = (name.strip("& ") for name, *_rest in map(_ends, lines))
    if not _is_letter(last) or any(last.lower() in group for group in _MEANT):
        return False
    every = zip(others, lines, strict=False)
    return any(_is_letter(name) and not explains_another(x, list(lines)) for name, x in every)


def _is_letter(name: str) -> bool:
    """Whether a name has no number, and is no coordinate of the tool."""
    with suppress(ExpressionError):
        letter = is_name(name) and not _head_and_places(entry_name(name))[1]
        return letter and name not in _COORDINATES
    return False


@lru_cache(maxsize=16)
def _in_order(text: str, entry: str) -> tuple[tuple[str, ...], frozenset[str]]:
    """The equations of a text, the one that is meant last; and those that give the entry."""
    lines, writing = _equations(text), hand([text])
    gives = {
        line
        for line in lines
        if begins_with(line, entry, writing)
        or _is_its_place(line, entry, writing)
        or (_is_meant(line, entry, writing) and not explains_another(line, lines))
    }
    gives = gives or {line for line in lines if _is_its_letter(line, entry, writing)}
    lines.sort(key=lambda line: (line in gives, "=" not in line))
    if lines and lines[-1] not in gives and "=" in lines[-1]:
        lines = sorted(lines, key=lambda line: not explains_another(line, lines))
    return (*lines,), frozenset(gives)


def _is_its_place(line: str, entry: str, writing: Hand) -> bool:
    """Whether a line gives the entry by another book's letter: ``b_{12} = ...`` of M12."""
    with suppress(ExpressionError):
        head, places = _head_and_places(entry_name(entry))
        mine, here = _head_and_places(entry_name(line.partition("=")[0], writing=writing))
        alike = _are_in_one_group(head, mine)
        return "=" in line and len(places) > 1 and here == places and alike
    return False


def _is_its_letter(line: str, entry: str, writing: Hand) -> bool:
    """Whether a line gives an energy by another book's letter: ``K = ...`` of T."""
    with suppress(ExpressionError):
        return "=" in line and _are_one_energy(
            entry_name(line.partition("=")[0], writing=writing), entry
        )
    return False


def _are_one_energy(name: str, entry: str) -> bool:
    """Whether books have both names for one energy: capitals, for t and u are torques."""
    both = {name, entry}
    return both <= _ONE_NUMBER and any(both <= {*group.split()} for group in _IN_BOOKS)


def lines_before(text: str, entry: str, given: Container[str]) -> list[str]:
    """The equations that give the entry in front of the one that :func:`explained` takes.

    They are how the writer came to it; not what says of what it is made, as L = K - P does.

    Args:
        text: as typed.
        entry: what the formula is asked for.
        given: names that are explained.
    """
    lines, gives = _in_order(text, entry)
    left = lines[-1].partition("=")[0] if lines and "=" in lines[-1] else ""
    told = [line.partition("=")[2] for line in lines[:-1] if left and line in gives]
    sides = [
        [x for x in one.split("=") if not says_what_it_is(x) and not _is_of_parts(x, given)]
        for one in told
    ]
    dollars = "$" if is_latex(text) else ""
    return [f"{dollars}{'='.join([left, *one])}{dollars}" for one in sides if one]


_OF_PARTS = re.compile(r"([A-Za-z])_?\{?\d\}?(?:\s*\+\s*\1_?\{?\d\}?)+")
"""A sum of one letter's parts: ``T1 + T2``."""


def _is_of_parts(step: str, given: Container[str]) -> bool:
    """Whether a step says of what parts something is, which are not all explained."""
    plain = step.strip(" .,;$&")
    return bool(_OF_PARTS.fullmatch(plain)) and not _rests_on(plain, given)


def _may_be_taken(line: str) -> bool:
    """Whether a line gives a name, and its steps, as far as they have the same names, are equal."""
    _name, *steps = line.split("=")
    return bool(steps) and not _held_against_the_last(steps)[0]


def unjudged_steps(text: str, own: Container[str]) -> list[str]:
    """The writer's names of which a step, or an earlier line, was held against no other.

    Args:
        text: as typed.
        own: the names.
    """
    told = _explaining(_equations(text)).items()
    return [
        shown for name, (shown, sides) in told if name in own and _held_against_the_last(sides)[1]
    ]


def _explaining(lines: Iterable[str]) -> dict[str, tuple[str, list[str]]]:
    """The writer's names, as he has them, with all that is given for each, the last at the end."""
    found: dict[str, tuple[str, list[str]]] = {}
    for line in lines:
        left, *sides = line.split("=")
        given = _also_given(line)
        for name in (left, *given):
            with suppress(ExpressionError):  # a derivative is no name
                told = found.setdefault(own_name(name), (name.strip("& "), []))[1]
                told += [side for side in sides if side not in given]
    return found


def _also_given(line: str) -> list[str]:
    """The names of the same letter that a line gives too: M21 of ``M12 = M21 = ...``."""
    left, *sides = line.split("=")
    return [side for side in sides[:-1] if is_name(side) and is_sister(side, left)]


def _held_against_the_last(steps: list[str]) -> tuple[bool, bool]:
    """Whether steps of the last one's names are unequal to it; and whether one has other names."""
    if len(steps) == 1:
        return False, False
    nodes = []
    for step in steps:
        with suppress(ExpressionError):
            node = parse(plain_formula(f"${step}$" if is_latex(step) else step))
            nodes.append(tree.renamed(node, {name: canonical(name) for name in tree.names(node)}))
    last: frozenset[str] = frozenset(tree.names(nodes[-1])) if nodes else frozenset()
    alike = [node for node in nodes if {*tree.names(node)} == last]
    at = {name: np.array([0.7 + 0.13 * k, 1.9 - 0.31 * k]) for k, name in enumerate(sorted(last))}
    values = [np.broadcast_to(tree.evaluate(node, at), (2,)) for node in alike]
    unequal = any(not np.allclose(one, values[-1]) for one in values)
    return unequal, len(alike) < len(steps)


def _ends(line: str) -> tuple[str, str, str]:
    """A name and what it comes to: ``s23 = ... = ...`` by its last part."""
    name, sign, right = line.partition("=")
    return name, sign, right.rpartition("=")[2]


def explains_another(line: str, lines: list[str]) -> bool:
    """Whether a line gives a name that another line uses.

    Args:
        line: an equation.
        lines: all there are.
    """
    name = line.partition("=")[0].strip("& ")
    return any(stands_in(name, one.partition("=")[2]) for one in lines)


def stands_in(name: str, text: str) -> bool:
    """Whether a name is used in a text.

    Args:
        name, text: as typed.
    """
    one = re.escape(joined_up(name))
    if re.search(rf"(?<![A-Za-z\\]){one}(?![A-Za-z_\d₀-₉])", text):
        return True
    used = re.compile(rf"(?<![A-Za-z]){one}(?![\d₀-₉])")
    return any(map(used.search, _both_ways(text)))


@lru_cache(maxsize=256)
def _both_ways(text: str) -> tuple[str, str]:
    """A text joined up, with its commands and as names alone."""
    return joined_up(text), joined_up(_COMMAND.sub(" +", text))


_COMMAND = re.compile(r"\\(?:(?:begin|end)\{\w+\*?\}|(?=[A-Za-z]))")


def joined_up(text: str) -> str:
    """A text without blanks, braces and signs of what stands below the line.

    Args:
        text: as typed.
    """
    return re.sub(r"[_{}\\\s]", "", text)


_SQUARE = re.compile(r"(.*?)\s*(?:(?:\^|\*\*)\s*(?:2|\{\s*2\s*\})|²)")
_BEHIND_WORDS = re.compile(r"(?<![\\\w])(?!det )(?:[A-Za-z]{2,}|\w*[^\x00-\u2fff]) +[\\\w]")
"""A word, and a name behind it: ``first x``."""
_STATE = re.compile(r"(?:[csCS]|(?:q|th|theta)d{0,2}|d{1,2}(?:q|th|theta))_?\d+")


def _is_own_name(text: str) -> bool:
    """Whether a left side may be a name of the writer's, or the square of one: not of c2 or q2."""
    square = _SQUARE.fullmatch(text)
    if square is None:
        return bool(_OWN_NAME.fullmatch(text)) and not _BEHIND_WORDS.search(text)
    with suppress(ExpressionError):
        name = entry_name(square[1])
        return bool(_NUMBERED.fullmatch(name)) and not _STATE.fullmatch(name)
    return False


def own_name(text: str) -> str:
    """A name that is explained: L3 of ``L3 = 0.3``, for L is the Lagrangian only as an entry.

    Of ``v_2^2 = ...`` it is v2^2.
    """
    square = _SQUARE.fullmatch(text.strip("& "))
    if square:
        return f"{own_name(square[1])}{SQUARED}"
    name, long = entry_name(text), _PRINTED["L"]
    return name.replace(long, "L") if name.startswith(long) and long not in text else name


def several(text: str, entry: str) -> dict[str, str]:
    """The equations of a whole vector or matrix by their names: ``g1 = ..., g2 = ...`` of g.

    Args:
        text: as typed.
        entry: the whole: ``g``, ``gravity_torques``.

    Returns:
        Each with the equations that explain the writer's own names; empty where none, or only
        one, is an entry of the whole, and where a line has no name: nobody knows whose it is.
    """
    cut, writing = _in_dollars(text) or _equations(text), hand([text])
    lines = [line for line in cut if "=" in line]
    named: dict[str, str] = {}
    own: list[str] = []
    with suppress(ExpressionError):
        head, places = _head_and_places(entry_name(entry))
        for line in lines if not places else []:
            name = entry_name(line.partition("=")[0], writing=writing)
            mine, here = _head_and_places(name)
            alike = _are_in_one_group(head, mine)
            whole = alike and not here
            if whole and not explains_another(line, lines):  # as h does the entries of C
                return {}
            own_letter = head == mine or entry not in _ONE_NUMBER  # h1 beside V is a height
            if alike and here and own_letter:
                short = name.partition("[")[0]
                if len(here) > 1 and short[:1] not in TWO and short not in LONG:  # b11, of M
                    named[_place_of(entry, here)] = line
                else:
                    named[name if short in (name, *LONG) else f"{short}{here}"] = line
            else:
                own.append(line)
    named = named if len(named) > 1 else _rows(lines, entry, writing)
    own = [line for line in lines if line not in named.values()]
    if len(named) < 2 or len(lines) < len(cut):
        return {}
    named = {name: _copied(line, named, writing) for name, line in named.items()}
    dollars = "$" if is_latex(text) else ""
    return {name: f"{dollars}{'; '.join([*own, line])}{dollars}" for name, line in named.items()}


def _place_of(entry: str, places: str) -> str:
    """An entry of a whole: ``M12``, or ``mass_matrix[0,1]``."""
    numbers = ",".join(str(int(k) - 1) for k in places)
    return f"{entry}[{numbers}]" if entry in LONG else f"{entry}{places}"


_DOLLARS = re.compile(r"\$\$?([^$]+)\$\$?")


def _in_dollars(text: str) -> list[str]:
    """The equations of a text each of which stands between dollars of its own; else none."""
    spans = [found.strip(" .,;") for found in _DOLLARS.findall(text)]
    alone = text.count("$") % 2 == 0 and "=" not in _DOLLARS.sub("", text)
    found = [span for span in spans if "=" in span]
    return found if alone and len(found) > 1 else []


def as_column(text: str, entry: str) -> str:
    """``x = ...; y = ...; phi = ...`` as the column that a planar pose is."""
    if entry != "planar_pose":
        return text
    lines = _equations(text)
    given: dict[str, str] = {}
    own = []
    for line in lines:
        left, sign, right = line.partition("=")
        name = _PLANAR.get(joined_up(left.strip("&$ ")).lower())
        if not sign or "=" in right or name in given:
            return text
        if name is None:
            own.append(line)
        else:
            given[name] = right
    order = next((one for one in ("xyp", "xycs") if {*one} == {*given}), "")
    if not order:
        return text
    given = {name: given[name] for name in order}
    if not is_latex(text):
        return "; ".join([*own, f"[{'; '.join(given.values())}]"])
    column = r"\begin{bmatrix}" + r"\\".join(given.values()) + r"\end{bmatrix}"
    return f"${'; '.join([*own, column])}$"


_PLANAR = {"x": "x", "y": "y", "px": "x", "py": "y"}
_ORIENTATION = ("phi", "varphi", "φ", "ϕ", "theta", "θ", "psi", "alpha")
_PLANAR |= dict.fromkeys(_ORIENTATION, "p")
_PLANAR |= {
    f"{wave}{angle}": wave[0] for wave in ("cos", "sin", "c", "s") for angle in _ORIENTATION
}
_PLANAR |= {f"{wave}({angle})": wave[0] for wave in ("cos", "sin") for angle in _ORIENTATION}


def is_angle(left: str) -> bool:
    """Whether a left side is the angle of a planar arm's tool."""
    return _PLANAR.get(joined_up(left.strip("&$ ")).lower()) == "p"


def _rows(lines: list[str], entry: str, writing: Hand) -> dict[str, str]:
    """The rows of a whole by what books call these: ``r_1 = [...], r_2 = [...]``."""
    found = {}
    with suppress(ExpressionError):
        names = {line: entry_name(line.partition("=")[0], writing=writing) for line in lines}
        for line, name in names.items() if entry in _WITH_ROWS else ():
            for k in range(1, 10):
                if is_named(name, f"{entry} {k}"):
                    found[f"{entry}[{k - 1}]"] = line
    return found


_WITH_ROWS = ("com_positions",)


def _copied(line: str, named: dict[str, str], writing: Hand) -> str:
    """``M21 = M12`` with what M12 is."""
    left, sign, right = line.partition("=")
    with suppress(ExpressionError):
        asked = _head_and_places(entry_name(right, writing=writing)) if is_name(right) else None
        same = [one for name, one in named.items() if _head_and_places(name) == asked]
        other = same[0] if same else line
        if other != line:
            return f"{left}{sign}{other.partition('=')[2]}"
    return line


_STARTS_FORMULA = re.compile(r"^[-(\d.]")
_BY_DEFINITION = re.compile(
    r"\\partial|∂|\\nabla|\\(?:sum|int)(?![A-Za-z])|\\d?t?frac\s*\{\s*(?:\\mathrm\s*\{)?d|\bd\w*\s*/\s*d\w"
    r"|\{\s{0,2}\}\s{0,2}[\^_]|[TRA]_\{?\d\}?\^\{?\d\}?\s{0,2}(?:\\[,;:! ]\s{0,2})?[TRA]_"
    r"|\^\s*\{?(?:T\b|\\top|\\mathrm\s*\{?T)|^-?\s*[xyzVUPTKL](?:_\{?\w+\}?)?$|^[TK]\s*-\s*[VUP]$"
)
"""A part of a chain of equalities that says what the entry is: a derivative, -y, J^T f, T - V, a
product of poses by their frames."""


_SCRIPT = re.compile(r"\\(?:mathcal|mathrm|mathbf|boldsymbol)\s*\{\s*([A-Za-z])\s*\}")


def says_what_it_is(text: str) -> bool:
    """Whether a part of a chain of equalities says what the entry is, and not what it comes to."""
    plain = _SCRIPT.sub(r"\1", text.replace("−", "-")).strip(" .$")
    return bool(_BY_DEFINITION.search(plain))


_EITHER = re.compile(
    r"(?P<first>[=({\[,$]\s*)?(?P<sign>\\(?:pm|mp)(?![A-Za-z])|[±∓]|\+\s?/\s?-(?!\d))\s*"
)
"""Plus or minus, where it stands between two terms or in front of one."""
_OF_TWO_SOLUTIONS = ("fivebar_angles", "fivebar_leg_angles")
"""Entries of which either solution is right."""


def _either(text: str) -> tuple[str, str]:
    """A formula with the upper signs, and with the lower ones."""

    def signed(found: re.Match[str], upper: bool) -> str:
        plus = (found["sign"] not in ("\\mp", "∓")) is upper
        first = found["first"] or ""
        return f"{first}{'' if first and plus else '+ ' if plus else '- '}"

    return _EITHER.sub(partial(signed, upper=True), text), _EITHER.sub(
        partial(signed, upper=False), text
    )


_LONGEST_CHAIN = 8


_EQUATION = re.compile(r"loop_?\d?")
"""Entries that are equations: each side is one formula, a name alone too."""


_LINE_ENDS = re.compile(r"^[&\s]+|(?:\\\\(?:\[[\w. ]{0,9}\])?|[&\s]){1,20}$")
"""Between two lines of a chain: ``\\\\`` and ``&``."""


def readings(text: str, entry: str, given: Container[str] = ()) -> list[str]:
    r"""The equations in a chain of equalities, each with one formula, the last one first.

    ``M_{12} = M_{21} = ...`` is one, ``g2 = m2*g*l2*c12 = 5.886*c12`` is two; of ``J_{11} =
    \frac{\partial x}{\partial\theta_1} = ...`` the derivative is left out. ``a \pm b`` is two.

    Args:
        text: as typed.
        entry: what it is asked for.
        given: names that are explained: ``L = T - V = ...`` is two where T and V are.
    """
    if entry.startswith(_OF_TWO_SOLUTIONS) and _EITHER.search(text):
        return [one for both in _either(text) for one in readings(both, entry, given)]
    parts = [_LINE_ENDS.sub("", part) for part in bare(text).split("=")]
    dollars = "$" if is_latex(text) else ""
    if _EQUATION.fullmatch(entry) and len(parts) == 2 and all(parts) and parts[0] != entry:
        return [f"{dollars}{part}{dollars}" for part in reversed(parts)]
    unended = any(part[-1:] in ("", *"<>!+*/-") for part in parts)
    if not 2 <= len(parts) <= _LONGEST_CHAIN or unended:
        return [text]
    rests = [k > 0 and _rests_on(one, given) for k, one in enumerate(parts)]
    named = [
        is_name(one) and not rests[k] and not (k and _is_formula_of(one, entry))
        for k, one in enumerate(parts)
    ]
    names = [part for part, is_one in zip(parts, named, strict=True) if is_one]
    formulas = [part for part in parts if part not in names] or parts[-1:]
    left = next((name for name in names if begins_with(f"{name} =", entry)), "")
    strange = any(name != left and not _also(name, entry) for name in names)
    says = named[-1] or says_what_it_is(parts[-1])
    strange |= len(parts) > 2 and says and not _may_end(parts[-1], entry)
    strange |= named[-1] and _is_of_fewer_joints(parts[-1], "=".join(formulas))
    several = any(
        len(parts_at(formula, ",;")) > 1 or _is_of_two_lines(formula) for formula in parts
    )
    alone = len(parts) == 2 and (names or not _is_formula(parts[0]))
    if alone or strange or several:
        return [text]
    told = [one for one, known in zip(parts, rests, strict=True) if known]
    formulas = [x for x in formulas if x in told or not says_what_it_is(x)] or formulas[-1:]
    left = f"{left or names[0]} = " if names else ""
    return [f"{dollars}{left}{formula}{dollars}" for formula in reversed(formulas)]


def _rests_on(part: str, given: Container[str]) -> bool:
    """Whether a part is made of explained names alone: ``h``, ``T - V``."""
    with suppress(ExpressionError):
        found = [own_name(one.strip()) for one in re.split(r"\s*[-−+]\s*", part.strip("&$ ."))]
        return all(one in given for one in found)
    return False


_NEW_LINE = re.compile(
    r"(?:\n|\\\\(?:\[[\w. ]{0,9}\])?)(?:[&\s]|\\[,;:! ]|\\q?quad(?![A-Za-z])){0,20}+"
    r"(?=[^\s+*/·^)\]}&=\\-]|\\[A-Za-df-z])"
)


def _is_of_two_lines(part: str) -> bool:
    """Whether another equation begins on a new line within what stands between two signs.

    Or in an environment that is opened there and not closed.
    """
    part = part.strip()
    for found in _NEW_LINE.finditer(part):
        front = part[: found.start()]
        inside = front.count("\\begin") != front.count("\\end")
        if not inside and sum(map(front.count, "([{")) == sum(map(front.count, ")]}")):
            return True
    return part.count("\\begin{aligned}") > part.count("\\end{aligned}")


def _is_formula(text: str) -> bool:
    """Whether a left side without a name is a formula: a sum, a number first, three factors."""
    words = re.findall(r"[A-Za-z]+", re.sub(r"_\{?\w+\}?", " ", text))
    return bool(_STARTS_FORMULA.match(text) or "+" in text or "*" in text or len(words) > 2)


def is_name(text: str) -> bool:
    """Whether a side of an equation is a name alone: ``M_{21}``, ``\\tau_2``, not ``-y``."""
    with suppress(ExpressionError):
        return "∂" not in text and bool(_NAME.fullmatch(entry_name(text.strip("& "))))
    return False


def _is_formula_of(text: str, entry: str) -> bool:
    r"""Whether a name behind a sign of equality is no name of the entry's, but what it comes to.

    ``m_2`` and ``m_2(q_2)`` are a mass and its product where M12 is asked for; with rates in
    parentheses it is a product: ``h(\dot q_1 \dot q_2)``.
    """
    if _PRODUCT.fullmatch(text.strip("& .")):
        return True
    (head, places), (mine, asked) = map(_head_and_places, map(entry_name, (text, entry)))
    meant = _of_one_quantity(head, mine)
    if places and asked and len(places) != len(asked) and (meant or "(" in text):
        return True
    return "(" in text and head != mine and not (meant and bool(places) == bool(asked))


_PRODUCT = re.compile(r"(?:[A-Za-z]_?(?:\d{1,2}|\{\w{1,3}\})\s?){2,}")
"""Names with indices side by side: ``l_1l_2s_2``."""


def _may_end(name: str, entry: str) -> bool:
    r"""Whether a chain of equalities may end in a name, or in what the entry is: ``M21`` of M12.

    ``g_2 = ... = g_1`` says something of g1, ``= I_2`` of a number of the arm's, and ``= -x``, or a
    derivative, what is true of one entry of the Jacobian alone.
    """
    name = _SLOPE.sub(r"d\1/dq\2", name).strip("& .$")
    if says_what_it_is(name) and not is_name(name):
        whole = re.sub(r"\s", "", _SCRIPT.sub(r"\1", name))
        told = (_head_and_places(entry_name(entry))[1], whole) == ("11", "-y")
        told |= entry in ("L", "lagrangian") and bool(re.fullmatch("[TK]-[VUP]", whole))
        return told or begins_with(f"{name} =", entry)
    of_state = re.sub(r"[^(]*", "", name, count=1)
    if of_state and not re.search(r"[qθΘϑ]|[tT]h(?:eta)?", of_state):
        return False
    plain = entry_name(name)
    (head, places), (mine, _wanted) = map(_head_and_places, (plain, entry_name(entry)))
    across = [plain, f"{head}{places[::-1]}"] if head in _SYMMETRIC else [plain]
    others = _of_one_quantity(head, mine) and any(of_one_name(one, entry) for one in across)
    point = plain.replace("_", "") in _POINT and plain[-1] == entry
    point |= plain == "x" and _heads("J21", entry, None) == (("j", "21"), ("j", "21"))
    return begins_with(f"{name} =", entry) or others or point


def _is_of_fewer_joints(name: str, formula: str) -> bool:
    """Whether a name with states in parentheses lacks one that stands in the formula: M12(q1)."""
    _head, _, states = name.partition("(")
    stated = set("".join(_JOINTS.findall(states)))
    return bool(stated) and not stated >= set("".join(_JOINTS.findall(formula)))


_JOINTS = re.compile(
    r"(?<![A-Za-z])(?:\\?(?:var)?theta|\\?q|\\?(?:sin|cos)|th(?:eta)?|[qcsθϑΘSC])[ ]?_?\{?(\d+)"
)
"""The joints in a name of an angle, or of its sine: ``q2``, ``\\theta_{2}``, ``c12``."""


def is_name_of(name: str, entry: str) -> bool:
    """Whether a name in a formula is the entry's own: tau of an arm's only joint, too."""
    with suppress(ExpressionError):
        both = entry_name(name), entry_name(entry)
        if {*both} <= _ONE_NUMBER:
            return _are_one_energy(*both)
        (head, places), (mine, wanted) = map(_head_and_places, both)
        known = [group for group in _MEANT if head in group]
        same = head == mine or any(mine in group for group in known)
        return same and (places == wanted or (head == "tau" and not places and wanted == "1"))
    return False


def is_sister(name: str, entry: str) -> bool:
    """Whether a name is that of another entry of the same quantity: g1 beside g2.

    Args:
        name: as typed.
        entry: what the formula is asked for.
    """
    with suppress(ExpressionError):
        head, places = _head_and_places(entry_name(name))
        mine, wanted = _head_and_places(entry_name(entry))
        alike = _of_one_quantity(head, mine)
        return alike and len(places) == len(wanted) and places != wanted
    return False


def _of_one_quantity(head: str, mine: str) -> bool:
    return head == mine or _are_in_one_group(head, mine)


def _are_in_one_group(head: str, mine: str) -> bool:
    """Whether both are letters that books have for one quantity, of those that are listed."""
    return any({head, mine} <= group for group in _MEANT)


def _also(name: str, entry: str) -> bool:
    """Whether a name may stand in a chain of an entry: M21 beside M12, a name of one's own."""
    with suppress(ExpressionError):
        head, places = _head_and_places(entry_name(name))
        mine, wanted = _head_and_places(entry_name(entry))
        known = [group for group in _MEANT if head in group]
        return not known or (places != wanted and head == mine) or any(mine in g for g in known)
    return False


def turned(left: str, right: str, entry: str) -> bool:
    """Whether the entry's own name stands behind the sign of equality, and no name before it."""
    name = right.strip("$ ")
    named = begins_with(f"{name} =", entry) or (is_name(name) and is_name_of(name, entry))
    return bool(left) and named and not is_name(left)


def claims(text: str, entry: str = "", writing: Hand | None = None) -> str:
    """The plain name that a formula gives itself, or ``""``: tau2 of ``h = ...; tau2 = ...``.

    Args:
        text: as typed.
        entry: what the formula is asked for.
        writing: as for :func:`entry_name`.

    Raises:
        ExpressionError: what cannot be read, as in :func:`sides` and :func:`entry_name`.
    """
    left, right = sides(readings(explained(text, entry)[1], entry)[0])
    return entry_name(left, writing=writing) if left and not turned(left, right, entry) else ""


def named_in(text: str) -> list[str]:
    """What stands on the left of each equation of a text, and then what stands on the right."""
    equations = [line.split("=") for line in _equations(text) if "=" in line]
    ends = [(parts[0], parts[-1]) for parts in equations]
    found = [end.strip("$&: ") for column in zip(*ends, strict=True) for end in column]
    return [name for name in found if name and _OWN_NAME.fullmatch(re.sub(r"[()\[\],]", "", name))]


def begins_with(line: str, entry: str, writing: Hand | None = None) -> bool:
    """Whether a line gives the entry by its own name."""
    left, sign, _right = line.partition("=")
    heads = _heads(left, entry, writing) if sign and entry else None
    if heads is None:
        return False
    own, asked = heads
    rotation = {own[0], asked[0]} <= {*_POSES, "r"} and own[1] == asked[1]
    return (
        own == asked
        or is_named(entry_name(left, writing=writing), _asked(entry))
        or (":" in asked[1] and of_one_name(entry_name(left, writing=writing), entry))
        or (rotation and bool(_ROTATION.fullmatch(own[1])))
        or (asked[0] in _POSES and _POINT.get("".join(own).replace("_", "")) == asked[1])
    )


def _heads(
    left: str, entry: str, writing: Hand | None
) -> tuple[tuple[str, str], tuple[str, str]] | None:
    """The letters and places of a left side, and those of the entry; None of what is no name."""
    try:
        own = _head_and_places(entry_name(left, writing=writing))
        return own, _head_and_places(entry_name(entry))
    except ExpressionError:
        return None


def _is_meant(line: str, entry: str, writing: Hand) -> bool:
    """Whether a line gives an entry that is asked for by its long name: g1 of gravity_torques[0].

    ``g = 9.81`` is no gravity_torques, and Jv a part of the Jacobian.
    """
    left, _sign, right = line.partition("=")
    heads = _heads(left, entry, writing) if _LONG_NAME.match(entry) else None
    if heads is None:
        return False
    own, asked = heads
    sure = (
        bool(asked[1]) or entry in _ONE_NUMBER or (bool(_MATRIX.search(right)) and own[0] != "jv")
    )
    return sure and own[1] == asked[1] and _are_in_one_group(own[0], asked[0])


def _equations(text: str) -> list[str]:
    """The text, cut where an equation ends outside of brackets and matrices.

    What is explained behind a comma, or behind ``where``, comes before what it stands behind.
    """
    lines = [[""]]
    pieces = _NEXT.split(_GOES_ON.sub(" ", _DEFINED.sub("=", bare(text))))
    for k, piece in enumerate(pieces):
        last = lines[-1][-1]
        depth = sum(last.count(c) for c in "([{") - sum(last.count(c) for c in ")]}")
        if k % 2 == 0 or depth or last.count("\\begin") != last.count("\\end"):
            lines[-1][-1] += piece
        elif _goes_on(last, piece, pieces[k + 1]):
            lines[-1][-1] += " "
        elif piece[0] in "\n;" or piece[:2] == "\\\\":
            lines.append([""])
        else:
            lines[-1].append("")
    found = []
    for line in lines:
        first, *behind = [_EDGES.sub("", x) for piece in line for x in _WHERE.split(piece)]
        found += [one.rstrip(": ") for one in (*behind, first)]
    # of $x = ...$ and $J = ...$ on a line each the dollars between them are left
    found = [one.replace("$", "") if one.count("$") == 1 else one for one in found]
    return [line for line in found if line]


def _goes_on(line: str, end: str, following: str) -> bool:
    """Whether a sum goes on below: its next sign ends the line, or begins the following one."""
    return end[0] in "\n\\" and bool(_SIGNED.match(following) or _UNENDED.search(line))


_DETERMINANT = re.compile(r"\\det\s*(?:\(?\s*J\s*\)?)?|\|\s*J\s*\|")
"""The determinant of J as it is typed."""


_DERIVATIVE = re.compile(r"(?:∂\s*|d)([VUPxyz])\s*/\s*(?:∂\s*|d)(?:q|th|theta|θ)_?\{?([1-9])\}?")
_DERIVED = {"V": "g", "U": "g", "P": "g", "x": "J1", "y": "J2", "z": "J3"}
"""What the derivative of something by a joint's position is called."""


def entry_name(text: str, place: str = "expression", writing: Hand | None = None) -> str:
    r"""The name on a left side: ``\tau_{2}``, ``τ₂``, ``tau(2)`` and ``tau_2`` are tau2.

    Args:
        text: as typed; a state behind it, as in ``M_{12}(q)``, is dropped.
        place: what to put in front of a message.
        writing: says whether ``tau[0]`` counts from 0.

    Raises:
        ExpressionError: a name that can be read in two ways.
    """
    if len(text) > _LONGEST_NAME:
        raise refused(place, N_("{text}... is no name of an entry"), text=text[:30])
    text = with_energies(text)
    whole = _OF_STATE.sub("", _TIMES_RATES.sub("", bare(text).strip("& "))).strip()
    typed = _IN_BASE.sub("", whole)
    if _LAMBDA.fullmatch(typed):
        return latex.LAMBDA
    if _DETERMINANT.fullmatch(typed):
        return "det J"
    if name := plain_name(whole) or plain_name(typed) or _range_name(typed):
        return name
    plain = _SLOPE.sub(r"d\1/dq\2", unicodedata.normalize("NFKC", typed))
    slope = _DERIVATIVE.fullmatch(plain)
    if slope or "∂" in typed:
        return f"{_DERIVED[slope[1]]}{slope[2]}" if slope else typed
    named = _NAMED.fullmatch(typed)
    if named and (not named[2] or named[1] == "fk" or "_" in named[1] or named[1] in LONG):
        return typed  # a quantity by its own name
    if is_latex(typed) or not typed.isascii():
        typed = re.sub(r"(?<=\d)\s*,\s*(?=\d\s*[,}])", "", typed)
        name = latex.expression(ascii_text(with_dots(typed), place, as_latex=True), place)
    else:
        name = re.sub(r"\(\s*(\d)\s*,\s*(\d)\s*\)$", r"\1\2", typed)
        name = _without_indices(name, place, writing or hand([]))
    found = _ENTRY.fullmatch(name.strip("()"))
    if found is None:
        return typed
    head, index = found.groups()
    return f"{_PRINTED.get(head, head)}{index.replace('_', '')}"


_ENERGY = re.compile(
    r"(?<![A-Za-z\\])E_\s?\{?\s?(?:\\(?:mathrm|text|rm)\s?\{?\s?)?([pk])(?:ot|in)?(?![A-Za-z])\s?\}{0,2}"
)
"""An energy whose letter has a word below it: ``E_{kin}``."""


def with_energies(text: str) -> str:
    """``Ek`` and ``Ep`` for ``E_k``, ``E_{pot}``.

    Args:
        text: as typed.
    """
    return _ENERGY.sub(lambda found: f"E{found[1]}", text)


_RANGE = re.compile(
    r"([A-Za-z]\w*)\s*(?:\[\s*([-\d:,\s]*:[-\d:,\s]*)\]|\(\s*([\d:,\s]*:[\d:,\s]*)\))"
)
"""Rows or columns of a matrix, as programs have them: J[:3], T(1:3,4)."""


def _range_name(text: str) -> str:
    """``T[:3,3]`` of ``T(1:3, 4)``; empty of what is no range."""
    found = _RANGE.fullmatch(text)
    if found is None or found[2]:
        return re.sub(r"\s", "", text) if found else ""
    places = []
    for place in found[3].split(","):
        first, *more = (one.strip() for one in place.split(":"))
        start = str(int(first) - 1) if first else ""
        places.append(":".join([start if start != "0" or not more else "", *more]))
    return f"{found[1]}[{','.join(places)}]"


_IN_BOOKS = (
    "M D H B A mass_matrix",
    "C coriolis_matrix",
    "g phi gravity_torques",
    "V P U Ep potential potential_energy",
    "T K Ek kinetic kinetic_energy",
    "L lagrangian",
    "T K E link_kinetic_energies",
    "r rho fivebar_rod_length",
    "phi planar_angle",
    "j n servo_ratio",
    "v^2 tip_speed_squared",
    "T A H fk",
    "Mdot Ddot Hdot Bdot mdot mass_matrix_dot",
    "Jdot jacobian_dot",
    "J Jv planar_jacobian jacobian jacobian_tool jacobian_spatial",
    "tau u Q t inverse_dynamics inverse_dynamics_loaded lagrange_torques",
    "tau t statics statics_tool",
    "V C H N B cv coriolis_torques",
    "N S skew_matrix",
    "p momentum",
    "qdd ddq forward_dynamics",
    "q th theta inverse_kinematics inverse_kinematics_xy inverse_kinematics_xyphi "
    "inverse_kinematics_xyz inverse_kinematics_xyzphi fivebar_angles fivebar_leg_angles",
)
"""What books call the same thing: Spong's d11 and phi1, Craig's V, Siciliano's B."""
_MEANT = tuple({word.lower() for word in group.split()} for group in _IN_BOOKS)
_SYMMETRIC = _MEANT[0]
_SLOPE = re.compile(
    r"\\[dt]?frac\s*\{\s*\\partial\s*\\?(?:mathcal\s*)?\{?([A-Za-z])\}?\s*\}"
    r"\s*\{\s*\\partial\s*\\?(?:q|theta)_?\{?([1-9])\}?\s*\}"
)
"""The derivative of a coordinate, or an energy, by a joint's position, in LaTeX."""
_POSES = {"t", "a", "h", "fk"}
_ROTATION = re.compile(r"[123]{2}")
"""The places of a rotation, alone or in a transform: r11 is T11."""
_POINT = {"x": "14", "y": "24", "z": "34", "px": "14", "py": "24", "pz": "34"}
"""Which entries of a pose the coordinates of its point are."""
_COORDINATES = {*"xyz"}
_ONE_NUMBER = {*"VPUTKL", "Ep", "Ek"}
_ONE_NUMBER |= {"potential", "kinetic", "potential_energy", "kinetic_energy", "lagrangian"}
"""Entries that are one number by themselves, though V1 and V2 are parts of a vector."""
_VECTORS = (
    "gravity_torques inverse_dynamics forward_dynamics coriolis_torques momentum statics "
    "statics_tool"
)
_MATRICES = "mass_matrix coriolis_matrix jacobian jacobian_tool jacobian_spatial fk planar_jacobian"
LONG = {*_MATRICES.split(), *_VECTORS.split(), "christoffel"}
TWO = {*"MHBJTRC", "Jv", "Jw", "coriolis_coefficients", *_MATRICES.split()}
"""Quantities of two indices, whose one column is no vector."""
_SPEED_SQUARED = re.compile(r"\\?\|?v(?:_\{?\w{1,3}\}?)?\|?\s*(?:(?:\^|\*\*)\s*\{?\s*2\s*\}?|²)")
_PLACES = re.compile(r"(\D+?)[_\[]?([\d,]*)\]?", re.ASCII)


_OF_NO_POINT = (
    "j", "jacobian", "planar_jacobian", "m", "mass_matrix", "c", "coriolis_matrix", "g",
    "gravity_torques", "tau", "inverse_dynamics", "statics", "v", "t", "l", "det",
)  # fmt: skip
"""Entries before which no coordinate stands: ``x = ...`` is no entry of the Jacobian."""


_UNFINISHED = re.compile(r"[(\[]\s*,|,\s*[)\]]")
"""Places of which one is lacking: ``J(1,)``."""


def of_one_name(left: str, name: str) -> bool:
    """Whether a left side may stand before an entry: G2 and phi_2 before g2, tau before tau1.

    A name that no book has for anything else may be the writer's own.
    """
    if _UNFINISHED.search(left):
        return False
    if {left, name} <= _ONE_NUMBER:
        return _are_one_energy(left, name)
    (head, places), (mine, wanted) = _head_and_places(left), _head_and_places(name)
    asked = _asked(name if name not in _COORDINATES else f"fk[{'xyz'.index(name)},3]")
    known = [group for group in _MEANT if head in group]
    same = places == wanted != "" and any(mine in group for group in known)
    if is_named(left, asked) or (is_named_elsewhere(left, asked) and not same):
        return is_named(left, asked)
    if ":" in wanted and not places:  # of some of its rows the whole's name, but no T of R or p
        part = mine in _POSES and "," in wanted
        whole = all(":" in place for place in wanted.split(",")) and not part
        return whole and (head == mine or any(mine in group for group in known))
    if not known and not places and head != mine:
        pose = mine == "t" and wanted != ""
        return head.replace("_", "") not in _POINT or mine not in _OF_NO_POINT or pose
    if places != wanted and (places or wanted not in ("", "1")):
        return False
    if {mine, head} <= {*_POSES, "r"} and (mine == "r" or _ROTATION.fullmatch(places)):
        return True  # the rotation of a transform: T12 of R12, and r12 of T12
    return head == mine or not known or any(mine in group for group in known)


def _head_and_places(name: str) -> tuple[str, str]:
    """``("m", "12")`` of M12, ``("mass_matrix", "12")`` of ``mass_matrix[0,1]``."""
    if _SPEED_SQUARED.fullmatch(name.strip("& $")):
        return "v^2", ""
    if ":" in name:
        head, _blank, places = _asked(name).partition(" ")
        return head.lower(), places
    found = _PLACES.fullmatch(name.replace(" ", ""))
    if found is None:
        return name.lower(), ""
    head, places = found.groups()
    if "[" in name:
        places = "".join(str(int(k) + 1) for k in places.split(",") if k)
    if head == "fivebar_equation" and len(places) == 2:  # A, B and C of a leg
        return "abc"[int(places[1]) - 1 : int(places[1])], places[0]
    return head.lower(), places.replace(",", "")


def _asked(entry: str) -> str:
    """An entry or a range with its places from 1: ``fk :3,4`` of ``fk[:3,3]``.

    Places that leave out nothing are left out.
    """
    head, _bracket, inside = entry.replace(" ", "").rstrip("]").partition("[")
    places = []
    for place in inside.split(",") if inside else ():
        first, *end = place.split(":")
        if not re.fullmatch(r"\d*", first):
            return ""  # counted from the end
        start = str(int(first) + 1) if first and (first != "0" or not end) else ""
        places.append(":".join([start, *end]))
    while places and places[-1] == ":":
        places.pop()
    return f"{head} {','.join(places)}".strip()
