"""All that is done to a formula as it is handed in, in the order in which it is done."""

from __future__ import annotations

import re
import unicodedata

from kinlab.formulas.handed.code import (
    added_up,
    with_definitions,
    without_code,
    without_prompts,
)
from kinlab.formulas.handed.columns import of_column
from kinlab.formulas.handed.constants import without_constant
from kinlab.formulas.handed.displays import with_displays_inline
from kinlab.formulas.handed.letters import plain_letters, siciliano_s_letters, without_marks
from kinlab.formulas.handed.rates import MOVING, plain_rates
from kinlab.formulas.handed.units import with_units_inside, without_units
from kinlab.formulas.language.clauses import Holds, without_clauses
from kinlab.formulas.language.prose import doubtful
from kinlab.formulas.language.words import (
    refuse_comments,
    without_remark_behind,
    without_words,
)
from kinlab.formulas.signs.brackets import closes
from kinlab.formulas.signs.dressed import undressed
from kinlab.formulas.signs.general import for_each_joint
from kinlab.formulas.signs.macros import written_out
from kinlab.formulas.signs.packages import STEP, of_packages
from kinlab.formulas.signs.printed import as_typed
from kinlab.formulas.signs.remarks import without_numbers
from kinlab.formulas.text import refuse_nested
from kinlab.formulas.typed import begins_with, without_gaps
from kinlab.host.language import _

_POINTED_AT = re.compile(r"(=[^\n]{1,300}?)[ \t](?:<-+|←)[ \t]+(?=[^\W\d_]{3})")
"""What is pointed at with words behind a formula: ``N1 = ...   <- coriolis``."""
_ALONE = re.compile(
    r"(?:p_?)?[xyz]|[VUPTKL]|phi|det\w*|E_?[pk]|\w*energy|lagrangian|[\w,\[\]]*[\d\]]"
)
"""Entries that are one number."""
_SCORE = re.compile(
    r"[(\[（【]\s*\d+(?:[.,/]\d+)?\s*(?:points?|pts?\.?|marks?|Punkte?|Pkt\.?|分)\s*[)\]）】]",
    re.IGNORECASE,
)
"""What an answer gives: ``(3 points)``."""
_OF_STATE = re.compile(
    r"(?<![A-Za-z\\_])((?:\\(?:mathbf|boldsymbol|bm)\s*\{\s*)?[MBDHCVNGgJh](?:\s*\})?)\s?"
    r"\((?:[\s{},]|\\d{0,2}dot(?![A-Za-z])|\\(?:mathbf|boldsymbol|bm|theta)(?![A-Za-z])|(?:q|th|theta|θ)d{0,2}(?![\w])|d{1,2}q)+\)"
)
"""``M(q)``, ``C(q, \\dot q)``: a matrix with all joints' positions, which says nothing more."""
_DOLLARS = re.compile(r"\${3,}")
_MEANS = re.compile(
    r"(?<==)([^=]+?)[,，;；]\s*(?=\$?[lLmI]_?\{?c?\d\}?\$?\s*(?:为|是|表示|(?:is|are|denotes?|being|ist)\s))"
)
"""What explains a name behind a formula without saying where: ``x = ..., l1 is the length``."""
_STATIC_TORQUE = re.compile(
    r"(?:(?P<typeset>\\tau)|(?<![A-Za-z\\])(?:tau|τ))_?(?:\{\s{0,2}g?\s{0,2},?\s{0,2}(?P<a>[1-9])\s{0,2}\}"
    r"|g?_?(?P<b>[1-9₁-₉]))(?![\w])"
)
"""A joint's torque, which is gravity's where nothing moves: ``\\tau_{g2}``, ``tau2``."""
_DIGITS = str.maketrans("₁₂₃₄₅₆₇₈₉", "123456789")
_PLACE_BELOW = re.compile(r"_\{\s{0,2}([A-Za-z]{2,8})\s{0,2},\s{0,2}([1-9])\s{0,2}\}")
_OF_A_WRENCH = ("tau", "statics", "inverse_dynamics_loaded", "Q", "u")
_NUMBERS = re.compile(
    r"^\s*((?:\$?\\?[A-Za-z]\w*\{?\w*\}?\s*=\s*\d[\d.]*[^=:：,，;；\n]{0,12}"
    r"(?:[,，;；]\s*|\s+(?:and|und)\s+|\s*[和与]\s*|\s*(?=[:：])))+)[:：]\s*(?=\S)"
)
"""Numbers of names in front of a formula: ``l1 = 0.5 m, l2 = 0.4 m: x = ...``."""
_BETWEEN = re.compile(r"[,，;；]\s*|\s+(?:and|und)\s+|\s*[和与]\s*")
_REMARK = re.compile(r"^(\s*\([A-Za-z]{3,}[ ,.][^()=+*/^]*\))\s+(?=\\?[A-Za-z])")
"""A remark in front: ``(see Craig, section 6.7)``."""
_BRACED_COMMA = re.compile(r"(?<=\d)\{,\}(?=\d)")
_COMMA = re.compile(r"(=\s*\d+),(\d+)(?=\s*(?:kg|m|N)\b)")
_GIVEN = re.compile(r"\b(?:da|weil|because|since|using)(?=\s+\$?\w{1,3}(?:_\{?\w\}?)?\$?\s*=\s*\d)")
_TWICE = re.compile(
    r"(?<![\w\\=<>!:])(?P<name>\\?[A-Za-z][\w{}\\]{0,30}?)(?P<sign>\s{0,9}=(?!=)\s{0,9})(?P=name)(?P<again>\s{0,9}=(?!=))"
)
"""A name that is given twice over: ``h = h = m2*l1*l2*s2``."""
_PART = r"\s*(?:F_?\{?x\}?|f_?\{?x\}?)\s*[,;]\s*(?:[Ff]_?\{?y\}?)\s*(?:[,;]\s*[Ff]_?\{?z\}?\s*)?"
_WRENCH = re.compile(
    rf"[,;]?\s*\b[FfWwh]\s*=\s*[\[(]{_PART}"
    r"(?:[,;]\s*[NnMm]_?\{?x\}?\s*[,;]\s*[NnMm]_?\{?y\}?\s*)?"
    r"(?:[,;]\s*[NnMm]_?\{?z\}?\s*)?[\])](?:\s*\^?\s*(?:T\b|\\top)|')?"
)
"""The tool's force and moment by their parts, in their order: ``F = [Fx, Fy, Nz]``."""
_LAW = re.compile(
    r"^\s*\$?(?:\\tau|tau|τ)\s*=\s*J\s?(?:ᵀ|\^\s?(?:T|\{\s?T\s?\}|\\top)|['’]|\.T)\s?[*@]?\s?[FfWwh]"
    r"(?:\s*[:：]\s*|[ \t]*\n\s*)(?=\S)"
)
"""What static torques are, in front of them: ``τ = Jᵀ F : tau1 = ...``."""
_CONSTANT = re.compile(
    r"[,;，；]\s*(?:(?:which|it|das)\s+)?(?:(?:is|ist)\s+)?(?:an?\s+|为|是)?"
    r"(?:constants?|konstante?|costante|constante|常数|常量)\s*[.。]?\s*$",
    re.IGNORECASE,
)
_MOVING = re.compile(r"theta|θ|q|(?<![A-Za-z])th|cos|sin|(?<![A-Za-z\\])[cs]_?\{?\d|\\d?dot")
_ACCENTED = re.compile("[aeiouAEIOU][\u0300-\u0303\u0308]|[nN]\u0303|[cC]\u0327")
"""Letters of words whose accent is a sign of its own."""
_STAR_SAID = re.compile(
    r"[,;.\s(]{0,9}(?:\b(?:where|with|wobei|mit)\s+)?\$?\\?(?:\*|ast|star)\$?\s+"
    r"(?:denotes?|is|means|stands\s+for|steht\s+für|表示)\s+[^=\n]{0,60}symm[^=\n]{0,60}$"
)
"""What a star in a symmetric matrix is said to be, behind it."""
_ABBREVIATED = re.compile(
    r"\s(?:\(\s*(?:(?:abbreviations?|abkürzungen|where|with|wobei|mit)\s*:?\s+(?=[^\n=]{1,40}=)"
    r"|(?=\\?[A-Za-z][A-Za-z]?_?\{?[\w,]{0,5}\}?\s*=))(?P<inside>[^\n]*)\)"
    r"|\[\s*(?P<squared>\\?[A-Za-z]_?\{?[\w,]{1,5}\}?\s*=[^\n\[\]]*)\])\s*\.?\s*$",
    re.IGNORECASE,
)
_NAMED = r"\$?\\?[A-Za-zα-ωΑ-Ω]{1,6}_?\{?[\w,]{0,5}\}?\s{0,3}:?=(?!=)"
_USED = re.compile(
    r"\s*\(\s*(?:using|with|where|since|as|because|mit|da|wobei|设|其中|因为|由于|代入|用)[ :：]*"
    rf"(?P<given>{_NAMED}[^()=\n]{{1,40}})\)"
    r"(?=\s*(?:\\\\\s*)?&?\s*=)"
)
"""A definition in parentheses between two sides of an equation."""
_DEFINED = re.compile(r"[ \t]{0,9}(?::\s?=|\\coloneqq(?![A-Za-z]))(?!=)\s*")
_OF_MAPLE = re.compile(r"(?<![\w.])([A-Za-z]\w*)\[\s*([1-9])\s*(?:,\s*([1-9])\s*)?\](?=\s*:=)")
_OF_TIME = re.compile(r"(?<![\w.])(?:q|th|theta|θ)\[\s*[1-9]\s*\]\s*\(\s*t\s*\)")
"""Maple's ``theta[2](t)``: as nothing else has it, all indices count from 1."""
_PLACE = re.compile(r"(?<![\w.])([A-Za-zθ]\w*)\[\s*([1-9])\s*\](?:\s*\(\s*t\s*\))?")
_ANY_ZERO = re.compile(r"\[\s*0\s*[\],]|\*\*")
_BOLD = re.compile(
    r"\*\*([A-Za-zÀ-ž\u4e00-\u9fff][^*\n=+/]{0,60}[:.：])\*\*"
    r"|(?<=\n)\*\*([A-Za-zÀ-ž\u4e00-\u9fff][^*\n=+/]{2,60})\*\*(?=[ \t]*\n)"
)
"""Markdown's ``**Answer:**``."""
_BOLD_SIDES = re.compile(
    r"(?<!\S)\*\*([A-Za-z]\w{0,8})\*\*(?=\s*=)"
    r"|(?<==)\s{0,9}\*\*(?=[^\s*])([^\n]{1,400}?)(?<=[^\s*])\*\*(?=\s*(?:\n|$))"
)
"""A bold name, or a bold end of a chain: ``**M33** = ... = **m3*l3^2/3**``."""
_BULLET = re.compile(r"(?<=\n)[ \t]{0,9}[-*•·][ \t]{1,9}(?=\$\\?[A-Za-z][^\n]{0,40}=)")
"""What begins a line of a list, where no minus may stand."""
_GREEK_ANGLE = re.compile(r"(?<![A-Za-z])(sin|cos|tan)([θϑφϕ](?:[₁-₉]|[1-9])?)(?![\w₁-₉²³(^])")
"""A function with its angle, and nothing between: ``cosθ2``."""
_MAPLES = re.compile(r":(?=\s*(?:$|\n|[A-Za-z]\w{0,20}(?:\[[\d,\s]{1,5}\])?\s*:=))")
"""A colon that ends a statement of Maple's."""
_WHERE = re.compile(
    rf"(?<!\w)(?:avec|con|com|donde|dove|où|onde|где|ただし)(?=\s+{_NAMED})", re.IGNORECASE
)
_AND = re.compile(rf"(?<=\s)(?:et|y|e|и)\s+(?={_NAMED})")
"""What stands between a formula and what is explained behind it, and between two such."""
_FULL_STOP = re.compile(r"(?<=\$)\s{0,9}[。．]\s*$")
_UNIT = re.compile(
    r"(?<=\$)\s{0,9}[(\[]\s?(?:(?:in\s)?(?:N\s?[·.]?\s?m|N|J|kg(?:\s?[·.]?\s?m(?:\^2|²))?|m|rad)(?:/s(?:\^2|²)?)?)\s?[)\]]"
    r"\s{0,9}\.?\s*$"
)
"""An SI unit in brackets behind a formula's dollars."""
_NUMBERED = re.compile(
    r"(?P<unit>[\w)}\]]\s(?:N\s?m|kg\s?m(?:\^2|²)|[mJN]|rad))\s{1,9}\(\d{1,2}[a-z]?\)\s*$"
)
"""The number of an equation behind a unit: ``0.6 sin(q1) m (1)``."""
_IN_WORDS = re.compile(r"\\text\s*\{\s*([()\[\]])\s*\}")
"""A bracket that is set as words are: ``\\text{(}d_3 = q_3)``."""
_SPACED = r"(?:\\q?quad|\\[,;: ]|\s){0,4}"
_FOLLOWS = re.compile(
    r"\s*(?:(?<![<=>])=>|⇒|⟹"
    rf"|{_SPACED}\\(?:Rightarrow|Longrightarrow|implies)(?![A-Za-z]){_SPACED}(?=\\?[A-Za-z]))\s*"
    r"|[,;.]?\s{0,9}(?<!\w)d['’]où\s{0,9}[,:]?\s*"
    r"|\s*(?:→|⟶|∴)\s*(?=\$?\\?[A-Za-zα-ωΑ-Ω][\w{},₁-₉]{0,12}\s*=)"
)
"""What follows from what stands before is an equation of its own."""
_AT = r"(?!\$?\\?(?:q|theta|vartheta|θ|th)_?\{?[\d₀-₉]?\}?\s{0,9}=\s{0,9}[-+±]?\s?[\dπ\\])"
"""No state: ``so q2 = 0 is singular``."""
_SLOPE = (
    r"\$?(?:[d∂]\s?[A-Za-z]\w{0,5}\s?/\s?[d∂]\s?\\?\w{1,9}"
    r"|\\d?frac\s?\{\s?(?:\\partial|∂|d)\s?\w{1,6}\s?\}\s?\{[^{}=]{1,20}(?:\{\w\})?\s?\})\s{0,3}="
)
"""A derivative in front of a sign of equality."""
_OF_PLACE = re.compile(r"(∂|\\partial\s?|(?<![A-Za-z])d)p_?\{?([xyz])\}?(?=\s?/|\s?\}\s?\{)")
"""The derivative of a coordinate with p in its name: ``∂p_x/∂q2``."""
_HENCE = re.compile(
    r"(?<=\S)(?<!\([a-z]\))(?<!^\w\))\s{0,9}[.,;]?\s{1,9}(?:hence|so|thus|therefore|then|(?:it\s+follows|we\s+find)\s+that"
    r"|we\s+get|donc|alors|also|daher|somit|folglich|damit|quindi|dunque|luego|entonces|por\s+tanto)"
    rf"\s{{0,9}}[,:]?\s{{1,9}}{_AT}(?={_NAMED}|{_SLOPE})"
    rf"|(?<=\S)[,，。;；]?\s{{0,9}}(?:因此|所以|于是|したがって|従って|ゆえに|よって)[,，]?\s{{0,9}}{_AT}(?={_NAMED})",
    re.IGNORECASE,
)
"""What follows, behind what is explained: ``where y = ... . Hence U = ...``."""
_ANGLE_BELOW = r"\\?(?:var)?(?:theta|phi|q|θ|φ)_?(?:\d|\{\d{1,4}\})"
_WAVE_OF_ANGLES = re.compile(
    rf"(?<![A-Za-z\\_])([csCS])_\{{\s?({_ANGLE_BELOW}(?:\s?\+\s?{_ANGLE_BELOW}){{0,5}})\s?\}}"
)
_PRIMED = re.compile(
    r"(\\(?:var)?(?:theta|phi)_(?:\d|\{\d\})|(?<![A-Za-z\\])q_(?:\d|\{\d\}))('{1,2})(?!')"
)
"""A joint of LaTeX's with primes for its rate."""
_AND_SO_ON = re.compile(
    r"(?:\\[ ,;:!]|\\q?quad|[\s,;~]){0,6}"
    r"(?:\\(?:text|mbox|textrm|mathrm)\s?\{\s*(?:usw|etc|u\.\s?s\.\s?w)\.?\s*\}|(?<=[\s,;])(?:usw|etc)\.)"
    r"(?=[\s$.]*$)"
)
"""``usw.`` behind definitions."""
_ELLIPSIS = re.compile(r"(?<=\$)\s*(?:\.{3}|…)(?=\s+[^\W\d_]{3})")
"""Between definitions and words."""
_EXPLAINED_BELOW = re.compile(rf"\n\s{{0,9}}(?:with|mit|wobei)\s+(?={_NAMED})")
_ON_A_LINE = re.compile(r"\n\s*(?=(?:with|mit)\s)")


def as_formula(
    text: str, entry: str, place: str, holds: Holds | None = None, several: bool = False
) -> tuple[str, str, list[tuple[str, str]]]:
    """The formula in what was handed in, as :mod:`kinlab.formulas.typed` reads it.

    Args:
        text: as typed, with the words, code and units around it.
        entry: what the formula is asked for.
        place: what to put in front of a message.
        holds: what is known of the arm, of clauses that say something of it.
        several: whether it is asked for several entries, as rows are.

    Returns:
        The formula, nothing changed in it where nothing is around it; what is to be said of how it
        was read, or nothing; and the words left out that may change what it claims, as
        :func:`kinlab.formulas.language.prose.doubtful` has them.

    Raises:
        ExpressionError: what can be read in two ways, or a clause that is not so.
    """
    refuse_nested(text, place)
    text = _with_joints_below(with_displays_inline(_AND_SO_ON.sub("", as_typed(text))))
    unjudged = _("the step {words!r} was not judged")
    steps = [unjudged.format(words=one[0].strip("=& ")) for one in STEP.finditer(text)]
    text, label = _without_label(_MIRRORED.sub("", _as_asked(_unlisted(of_packages(text)), entry)))
    text = without_prompts(without_gaps(_OF_PLACE.sub(r"\1\2", text)))
    text = _HENCE.sub("\n", added_up(text, place))
    text = _BOLD_SIDES.sub(lambda found: found[1] or f" {found[2]}", text)
    text = _BULLET.sub("", text)
    text = written_out(with_definitions(text), place)
    text = _BOLD.sub(lambda found: found[1] or f"{found[2]}:", text)
    text = _GREEK_ANGLE.sub(r"\1(\2)", text) if "\\" not in text else text
    text = _ACCENTED.sub(lambda letter: unicodedata.normalize("NFC", letter[0]), text)
    text = _NUMBERED.sub(r"\g<unit>", _UNIT.sub("", _FULL_STOP.sub("", text)))
    text = _FOLLOWS.sub("\n", _IN_WORDS.sub(r"\1", _ELLIPSIS.sub(".", text)))
    text = for_each_joint(_in_english(with_units_inside(_STAR_SAID.sub("", text))))
    text = _ABBREVIATED.sub(_where, text)
    text = _defined(_DOLLARS.sub("$$", text))
    text, numbered = without_numbers(plain_letters(text, place), place)
    text = without_gaps(text)
    text = _OF_STATE.sub(r"\1", text) if text.count("=") > 1 else text
    if holds is not None:
        text = without_clauses(text, place, holds)
    text = _GIVEN.sub("where", _COMMA.sub(r"\1.\2", _BRACED_COMMA.sub(".", text)))
    text = _TWICE.sub(lambda found: f"{found['name']}{found['again']}", text)
    text = _EXPLAINED_BELOW.sub("\nwhere ", _REMARK.sub(r"\1: ", text))
    text = _ON_A_LINE.sub(" ", text)
    text = _PLACE_BELOW.sub(r"_{\1\2}", text)
    if entry.startswith("gravity_torques") and not MOVING.search(text):
        text = _STATIC_TORQUE.sub(_of_gravity, text)
    text = _NUMBERS.sub(lambda found: f"{_BETWEEN.sub('; ', found[1]).rstrip('; ')}; ", text)
    text = _MEANS.sub(r"\1, where ", _SCORE.sub(" ", text), count=1)
    text = _LAW.sub("", text) if entry.startswith("statics") else text
    text = _WRENCH.sub("", text) if entry.startswith(_OF_A_WRENCH) else text
    constant = _CONSTANT.search(text)
    if constant and not _MOVING.search(text[: constant.start()].partition("=")[2]):
        text = text[: constant.start()]
    text, tried = _without_a_check(text)
    doubts = doubtful(text, entry)
    text, marks = without_marks(siciliano_s_letters(text))
    text = _POINTED_AT.sub(r"\1 # ", text)
    refuse_comments(text, place)
    text = without_remark_behind(text, place)
    text = without_code(text, not several and bool(_ALONE.fullmatch(entry)))
    text = _ANSWERED.sub(
        lambda found: "" if begins_with(f"{found[1]} = 0", entry) else found[0], text
    )
    text = undressed(text, entry)
    text = _behind(text)
    text, left = without_words(text, entry, place)
    steps += [unjudged.format(words=one) for one in left]
    text = plain_rates(text)
    text, said = without_constant(without_units(text, entry, place), entry)
    return (
        of_column(text, entry, place),
        "; ".join(filter(None, (label, numbered, marks, said, tried, *steps))),
        doubts,
    )


_ANSWERED = re.compile(r"(?<=\n)[ \t]*([A-Za-z]\w*)\s*$")
"""What a function answers, where that is a name."""
_MIRRORED = re.compile(
    r"\s{0,9}\((?:[^()=\n]{0,40}[\s,:])?[A-Za-z]_?\{?([1-9])([1-9])\}?\s{0,9}=\s{0,9}[A-Za-z]_?\{?\2\1\}?\s{0,9}\)"
)
"""What a symmetric matrix has on its other side, too: ``(symmetric, so M21 = M12)``."""
_ASKED = re.compile(r"^(\s*)([A-Za-z]\w{0,20})\[(\d)\](?=\s*=(?!=))")
_INDEX = re.compile(r"\w+\[(\d)\]")


_LISTED = re.compile(r"\s*(?:(?:np|numpy|sp|sympy)\.)?(?:(?:array|Matrix)\s*\()?\s*(?=\[)")


def _with_joints_below(text: str) -> str:
    """``c_{12}`` for ``c_{\\theta_1 + \\theta_2}``, and dots for the primes of LaTeX's joints."""
    text = _WAVE_OF_ANGLES.sub(
        lambda found: f"{found[1]}_{{{''.join(re.findall(r'[0-9]', found[2]))}}}", text
    )
    if any(text[found.end() :].lstrip("& $")[:1] == "=" for found in _PRIMED.finditer(text)):
        return text  # another angle, which is explained
    return _PRIMED.sub(
        lambda found: rf"\{'dd' if len(found[2]) > 1 else 'd'}ot{{{found[1]}}}", text
    )


def _unlisted(text: str) -> str:
    """``M = a = b`` of ``M = [a] = [b]``: lists of one number, as an arm of one joint has them."""
    sides = text.split("=")
    if "[" not in text or not any(map(_only, sides)) or "\\" in text:
        return text
    return "=".join(_only(side) or side for side in sides)


def _only(side: str) -> str:
    """What a list holds, if that is all that stands there and one number; else nothing."""
    found = _LISTED.match(side)
    begin = found.end() if found else 0
    end = begin + closes(side[begin:]) if found else -1
    inside = side[begin + 1 : end]
    rest = side[end + 1 :].strip()
    made = bool(found and "(" in found[0])
    alone = end > begin and not re.search(r"[,;\[\]\n]", inside)
    plain = alone and re.search(r"[-+*/^(\d]", inside) and rest == (")" if made else "")
    return f" {inside.strip()} " if plain else ""


def _as_asked(text: str, entry: str) -> str:
    """``tau3 =`` of ``tau[2] =`` where ``statics[2]`` is asked for, and no other index stands."""
    found, asked = _ASKED.match(text), _INDEX.fullmatch(entry)
    if found is None or asked is None or asked[1] != found[3] or text.count("[") > 1:
        return text
    return f"{found[1]}{found[2]}{int(found[3]) + 1}{text[found.end() :]}"


_BELOW = r"(?:\w|\{[^={}]{0,20}(?:\{[^={}]{0,9}\}[^={}]{0,9}){0,2}\})"
_RATED = r"(?:\\d{0,2}dot\s*(?:\{\s*[vaw]\s*\}|[vaw])|[vawV])(?![A-Za-z])"
_LABEL = re.compile(
    r"^(?P<begin>\s*\$*\s*)(?P<label>"
    rf"(?:\{{\s*\}}\s*\^\s*{_BELOW}\s*)(?:_\s*{_BELOW}\s*)?{_RATED}(?:_\s*{_BELOW})?"
    rf"|[vaw]\s*_\s*\{{\s*\w{{1,2}}\s*,\s*[xyz]\s*\}}"
    rf"|[\[(]\s*\\?[A-Za-z]{{1,6}}(?:\s*[_^]\s*{_BELOW}){{1,3}}\s*[\])]\s*_\s*{_BELOW}"
    r")(?P<equals>\s*&?\s*=(?!=))(?=[^=]*$)"
)
"""A name in brackets, or with its frame and axis: ``{}^2v_{2,y} =``, ``[J_{v_{c2}}]_{21} =``."""


def _without_label(text: str) -> tuple[str, str]:
    """The formula without a name in front that no list has, and what is said of that."""
    found = _LABEL.match(text)
    if found is None:
        return text, ""
    said = _("the left side {words!r} was not read").format(words=found["label"].strip())
    return f"{found['begin']}{text[found.end() :].lstrip()}", said


_CHECK = re.compile(
    r"[,;.]\s{1,9}(?:checked|check|tested|test|verified|probe|kontrolle|contr[oô]le|verifica|验证|检验)\b"
    r"[:\s]{1,9}(?:(?:with|at|for|in|mit|bei|für|pour|per|para)\s{1,9})?"
    r"(?P<state>(?:q|θ|\\?theta|th)_?\{?\d?\}?\s{0,9}=[^\n]{0,80})$",
    re.IGNORECASE,
)
_NO_CHECK = re.compile(r"\b(?:only|nur|just|where|else|other\w*|but)\b|[;&\\]", re.IGNORECASE)


def _without_a_check(text: str) -> tuple[str, str]:
    """The text without what its writer tried it at, and what is said of that.

    ``..., check: q1 = q2 = 0 gives 0.9``
    """
    found = _CHECK.search(text)
    if found is None or "=" not in text[: found.start()] or _NO_CHECK.search(found["state"]):
        return text, ""
    said = _("the check {words!r} was not read").format(words=found["state"].strip())
    return text[: found.start()], said


def _defined(text: str) -> str:
    """``:=`` as a sign of equality, and the colon that ends such a statement as a semicolon.

    Maple counts from 1: ``tau[2] := ...`` is tau2.
    """
    if _OF_TIME.search(text) and not _ANY_ZERO.search(text):
        text = _PLACE.sub(_without_brackets, text)
    if ":=" not in text:
        return _DEFINED.sub(" = ", text)
    return _DEFINED.sub(" = ", _MAPLES.sub(";", _OF_MAPLE.sub(r"\1\2\3", text)))


def _in_english(text: str) -> str:
    """What explains names in another language: ``donde P1 = ... y P2 = ...``."""
    found = _WHERE.search(text)
    return _AND.sub("and ", _WHERE.sub("where", text)) if found else text


def _of_gravity(found: re.Match[str]) -> str:
    """``g_{2}`` of ``\\tau_{g2}``, ``g2`` of ``tau2``."""
    place = (found["a"] or found["b"]).translate(_DIGITS)
    return f"g_{{{place}}}" if found["typeset"] else f"g{place}"


def _without_brackets(found: re.Match[str]) -> str:
    """``m1`` of ``m[1]``, ``theta2(t)`` of ``theta[2](t)``."""
    return f"{found[1]}{found[2]}{'(t)' if found[0].endswith(')') else ''}"


def _behind(text: str) -> str:
    """``a (using l_c = l/2) = b`` as ``a = b where l_c = l/2``."""
    given = [found["given"].strip() for found in _USED.finditer(text)]
    if not given or text.count("$"):
        return text
    return f"{_USED.sub('', text)} where {'; '.join(given)}"


def _where(found: re.Match[str]) -> str:
    """Definitions in parentheses as those behind ``where``."""
    inside = found["inside"] or found["squared"]
    return f" where {inside}" if closes(f"({inside})") == len(inside) + 1 else found[0]
