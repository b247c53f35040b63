r"""What stands beside a formula and says nothing of its value: tags, units, words, old fonts.

``\tag{3.7}``, ``\,\mathrm{N\,m}``, ``[Nm]``, ``\quad\text{(gravity)}``, ``，重力项`` are left out;
``\approx`` is a sign of equality, ``其中`` is ``where``, ``{\rm c}`` is ``\mathrm{c}``. A unit
that may be a name (``\mathrm{m}``) stays.
"""

from __future__ import annotations

import re
from functools import lru_cache

from kinlab.formulas.signs.brackets import closes, outside
from kinlab.formulas.signs.refusals import refused
from kinlab.host.language import N_, _

_CHINESE = "\u4e00-\u9fff\u3040-\u30fa\u30fc-\u30ff\u3001"
_SPACES = r"(?:\s|~|\\[,;:! ]|\\q?quad(?![A-Za-z])){0,20}+"
_BEHIND = rf"(?:(?<!\\)[,;]|\\q?quad(?![A-Za-z])){_SPACES}"
_WORDS = r"\\(?:text|textrm|textit|textbf|mbox)"
_FONT = r"\\(?:mathrm|mathsf|text|textrm|textit|textbf|operatorname|mbox|unit|si)"
_UNIT = r"(?:N|kg|rad|deg|mm|cm|m|s|J|W)"
_BETWEEN = r"(?:\s|~|\\[,;:! ]|\\cdot|[.*·⋅/]|\^\{?-?\d\}?|[²³]){0,9}+"
_UNITS = rf"{_UNIT}{_BETWEEN}(?:{_UNIT}{_BETWEEN}){{0,9}}"
_MORE = rf"(?:N|kg|{_UNIT}(?:{_BETWEEN}{_UNIT}){{1,9}}){_BETWEEN}"
"""Units that are no name of a length, a mass or an inertia: N, Nm, not m or J."""

_OF_EQUATION = (
    r"(?:(?:Gl|Eqn?|eqn?|式|公式)\.?\s*)?(?:[A-Z][.\-–]?)?\d{1,3}(?:[.\-–]\d{1,3}){0,2}\s?[a-z]?"
)
"""``3.12``, ``2-7``, ``A.3``, ``4b``: in parentheses behind a formula its number."""
_APART = (
    r"\\q?quad(?![A-Za-z])|\\hfill?(?![A-Za-z])|\\[lcd]?dots(?![A-Za-z])"
    r"|…|\.{3}|·{3}|-{2,9}|[—–―]|[,;，；]\s"
)
_AHEAD = (
    rf"(?<=[\w)}}\]²³$.,])"
    rf"(?=\s{{2}}|\s{{0,9}}(?:&\s{{0,9}})?(?:{_APART}))(?:\s|&|{_APART}){{1,40}}+"
)
_END = r"(?=[ \t]*(?:\$|\\\\|\\[\])]|\n|\Z|\\end\b))"
_CLOSE_BY = r"(?<=[)}\]²³$])(?:[ \t]?\\[;:!,]|[ \t])?"
_NUMBERS = (
    re.compile(rf"\s?\\l?eqno\s*(?:\{{[^{{}}]*\}}|\([^()]*\)|\S+){_END}"),
    re.compile(rf"{_AHEAD}(?:[(（\[]\s*{_OF_EQUATION}\s*[)）\]]|[①-⒇]){_END}"),
    re.compile(rf"{_CLOSE_BY}(?:\(\s*(?:\*{{1,3}}|[ivx]{{1,4}})\s*\)|[①-⒇]){_END}"),
    re.compile(r"(?<![ \t])[ \t]{0,40}[✓✔☑∎■□]+[ \t]*$"),
)
"""Numbers of equations, set apart from these."""
_MAY_BE_FACTORS = (
    re.compile(rf"{_CLOSE_BY}\s?\(\s*{_OF_EQUATION}\s*\){_END}"),
    re.compile(rf"(?<=[)}}\]²³$])[ \t]\[\d{{1,3}}\]{_END}"),
    re.compile(
        rf"(?<=\w)[ \t]\(\s*(?:[A-Z]|\d{{1,2}})[.\-–]\d{{1,3}}(?:[.\-–]\d{{1,3}})?[a-z]?\s*\){_END}"
    ),
)
"""The same close behind; ``q (2)`` is an index."""
_NAME_AHEAD = r"(?=[$\\]{0,3}[A-Za-zα-ωΑ-Ωϑϕ][\w{}\\,]{0,20}(?:\([\w,\s]{0,20}\))?\s*=)"
_OF_ITEM = re.compile(rf"(?m)^[ \t]*(?:[①-⒇]|\([a-h]\)|[*•–—])[ \t]+{_NAME_AHEAD}")
_DISPLAY = re.compile(r"(?<!\\)\\[\[(\])]")
_DASH = re.compile(rf"[ \t]*-[ \t]+{_NAME_AHEAD}")

_EVERYWHERE = (
    (re.compile(r"\\(?:tag\*?|label)\s*\{[^{}]*\}|\\(?:nonumber|notag)(?![A-Za-z])"), " "),
    (re.compile(r"\{\s*\\(?:rm|bf|it|sf)\s+(\w+)\s*\}"), r"\\mathrm{\1}"),
    (re.compile(r"\\(?:overset|stackrel)\s*\{[^{}]*\}\s*\{\s*=\s*\}"), "="),
    (re.compile(r"\\(?:approx|simeq|cong|equiv|triangleq)(?![A-Za-z])|[≈≃≅≡]"), "="),
    (re.compile(rf"\\text\s*\{{[\s,]*(?:其中|式中|这里)[\s:]*\}}{_SPACES}"), r" \\text{where} "),
    (re.compile(r"(?:其中|式中|这里)\s*:?"), " where "),
    (re.compile(r"((?:theta|th|q|θ)(?:_?\{?\d+\}?|[₀-₉]+)\}?)\(\s*t\s*\)"), r"\1"),
    (re.compile(r"\.\.\.[^\n]*\n"), " "),
    (re.compile(r"(?<![\w.])(Sin|Cos|Tan|Sqrt)\[([^\[\]]*)\]"), r"\1(\2)"),
    (re.compile(r"(?<!\\)#.*"), ""),
)
_AROUND = (
    re.compile(rf"^return\s+(?=\S)|^[{_CHINESE}\s]+[:=]\s*"),
    re.compile(rf"(?<![-+*/^=(,\s]){_SPACES}\[\s*(?:{_FONT}\s*)?\{{?\s*{_UNITS}\s*\}}?\s*\]\s*$"),
    re.compile(rf"{_SPACES}\(?\s*{_FONT}\s*\{{\s*{_MORE}\s*\}}\s*\)?\s*$"),
    re.compile(r"(?<=[\w)])\s+(?:Nm|N m|N\*m|N·m)\s*$"),
    re.compile(rf"{_BEHIND}\(?\s*{_WORDS}\s*\{{(?!\s*(?:where|with)\b)[^{{}}=\\]*\}}\s*\)?\s*$"),
    re.compile(rf"{_SPACES}{_WORDS}\s*\{{[^{{}}=\\]*[{_CHINESE}][^{{}}=\\]*\}}\s*$"),
    re.compile(rf"(?:\s*[,;]\s*|\s+)[{_CHINESE}\s]*[{_CHINESE}][.\s]*$"),
    re.compile(rf"\s*\([{_CHINESE}\s]*[{_CHINESE}]\s*\)\s*$"),
)
_EXPLAINED = re.compile(
    rf"(?:(?<!\\),|\\q?quad(?![A-Za-z])){_SPACES}\(([\\\w{{}}]+\s*=[^=]*)\)\s*$"
)
r"""``\quad (r = a_2 c_2)``, a name in parentheses."""


_BRACE = re.compile(r"\\(under|over)brace\s*(?=\{)")
_SAID = {
    "under": re.compile(rf"\s*_\s*(?:{_WORDS}\s*)?(?=\{{)"),
    "over": re.compile(rf"\s*\^\s*(?:{_WORDS}\s*)?(?=\{{)"),
}
_FRONT, _BEHIND_IT = re.compile(r"(?:^|[-+=(\[{&])\s*$"), re.compile(r"\s*(?:$|[-+=)\]},;&\n])")
_MOST = 40
_BRACES = ("{", "}")


def _without_braces(text: str) -> str:
    r"""``\underbrace{X}_{Y}`` as X, unless X is a sum that may be a factor, or has a power."""
    start = 0
    for _turn in range(_MOST):
        found = _BRACE.search(text, start)
        end = closes(text, found.end(), _BRACES) + 1 if found else 0
        if found is None or not end:
            break
        said = _SAID[found[1]].match(text, end)
        behind = closes(text, said.end(), _BRACES) + 1 if said else end
        inside, before = text[found.end() + 1 : end - 1], text[: found.start()]
        alone = _FRONT.search(before) and before.rstrip()[-1:] != "-"
        raised = text[behind:].lstrip()[:1] in ("_", "^")
        is_sum = any(one in "+-" for _k, one in outside(inside))
        sure = not is_sum or (alone and _BEHIND_IT.match(text, behind))
        if behind and sure and not raised:
            text = f"{before} {inside} {text[behind:]}"
        else:
            start = found.end()
    return text


def without_numbers(text: str, place: str) -> tuple[str, str]:
    """The text without the numbers of its equations, and of items: ``x = l*c1  (3.12)``.

    Args:
        text: as typed.
        place: what to put in front of a message.

    Returns:
        The text, and what is to be said of a number that may have been a factor.

    Raises:
        ExpressionError: a dash that may be a list's, or a minus.
    """
    lines = text.split("\n")
    if len(lines) > 1 and all(_DASH.match(line) for line in lines if line.strip()):
        text = "\n".join(_DASH.sub("", line, count=1) for line in lines)
    elif _DASH.match(text):
        said = N_("a dash in front: of a list, or a minus? leave it out, or the blank behind it")
        raise refused(place, said)
    text = _OF_ITEM.sub("", text)
    taken: list[str] = []

    def left_out(found: re.Match[str]) -> str:
        if _is_within(text, found.start()):
            return found[0]
        taken.append(found[0].strip(" \t\\;:!,"))
        return ""

    for pattern in _NUMBERS:
        text = pattern.sub(left_out, text)
    taken.clear()
    for pattern in _MAY_BE_FACTORS:
        text = pattern.sub(left_out, text)
    said = _("{number} behind it is read as the number of an equation, not as a factor")
    return text, said.format(number=", ".join(taken)) if taken else ""


def _is_within(text: str, at: int) -> bool:
    """Whether a place is between brackets, or in a matrix: there stands no equation."""
    before = _DISPLAY.sub("", text[:at])
    depth = sum(before.count(one) for one in "([{") - sum(before.count(one) for one in ")]}")
    begun, ended = (
        len(re.findall(rf"\\{x}\{{\w*(?:matrix|array)", before)) for x in ("begin", "end")
    )
    return depth > 0 or begun > ended


@lru_cache(maxsize=1024)
def without_remarks(text: str) -> str:
    """The text without what says nothing of the formula's value."""
    text = _without_braces(text)
    for pattern, instead in _EVERYWHERE:
        text = pattern.sub(instead, text)
    for pattern in _AROUND:
        text = pattern.sub("", text, count=1)
    found = _EXPLAINED.search(text)
    if found and found[1].count("(") == found[1].count(")"):
        text = rf"{text[: found.start()]} \text{{where}} {found[1]}"
    return text
