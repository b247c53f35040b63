r"""What programs and packages print: ``\pdv`` of physics, ``\SI`` of siunitx, rates of sympy.

And Typst, which is LaTeX without its backslashes. They become LaTeX of the textbooks, or the name
of a rate.
"""

from __future__ import annotations

import re

from kinlab.formulas.signs.brackets import closes

_GROUP = r"\{((?:[^{}]|\{(?:[^{}]|\{[^{}]*\})*\})*)\}"
_OF_SI = (
    r"\{(?:\\(?:kilogram|kilo\s?\\gram|metre|meter|second|radian|newton|joule|watt|per|squared|square"
    r"|cubed|cdot)(?![A-Za-z])|kg|rad|Nm|[NJWs]|m(?!m)|[\s.~*/^\d-])*\}"
)
"""A unit that changes no number: ``\\milli`` does, and stays to be refused."""
_NUMBER = re.compile(
    rf"\\(?:SI|qty)\s*(?:\[[^\]]*\])?\s*\{{\s*([-+]?[\d.,]+)\s*\}}\s*{_OF_SI}"
    r"|\\num\s*(?:\[[^\]]*\])?\s*\{\s*([-+]?[\d.,]+)\s*\}"
)
_UNIT = re.compile(rf"\\(?:si|unit)\s*(?:\[[^\]]*\])?\s*{_OF_SI}")
_SLOPE = re.compile(rf"\\(?P<kind>p?dv|pderiv|deriv)\s*{_GROUP}\s*{_GROUP}")
_FENCE = re.compile(r"\\(?:qty|quantity)\s*(?=[(\[{|])|\\(?:pqty|bqty)\s*(?=\{)")
_OF_TIME = re.compile(
    r"(?P<name>(?:\\(?:var)?theta|q|\\dot\{q\}|\\dot\{\\theta\})_(?:\{\d+\}|\d))\s*"
    r"(?:\{\s*\\left\(\s*t\s*\\right\)\s*\}|\\left\(\s*t\s*\\right\))"
)
_RATE = re.compile(
    r"\\frac\s*\{\s*d(?P<twice>\s*\^\s*(?:\{\s*2\s*\}|2))?\s*\}"
    r"\s*\{\s*d\s*t(?:\s*\^\s*(?:\{\s*2\s*\}|2))?\s*\}\s*"
    r"(?P<head>\\(?:var)?theta|q)_(?P<k>\{\d+\}|\d)"
)
_MATHEMATICAS = re.compile(
    r"Derivative\[\s*(?P<order>[12])\s*\]\[\s*(?P<head>q|th|theta|θ)_?(?P<k>\d)\s*\]\[\s*t\s*\]"
)
_OF_TYPST = re.compile(
    r"(?<![A-Za-z.\\])dot(?P<twice>\.double)?\(\s{0,9}(?P<name>[A-Za-z]+)(?P<k>_?\{?\d?\}?)\s{0,9}\)"
    r"|(?<![A-Za-z\\])frac\((?P<above>[^(),=]{1,40}),(?P<below>[^(),=]{1,40})\)"
)
_MATRIX_OF_TYPST = re.compile(r"(?<![A-Za-z\\])mat\((?=[^()]*(?:\([^()]*\)[^()]*){0,40};)")
_PRINTED = re.compile(r"^\s*tex\([^()\n]*\)\s*[;$]\s*")
_SINE = re.compile(
    r"\\operatorname\s*\{\s*(sen|tg)\s*\}|\\(sen|tg)(?![A-Za-z])"
    r"|(?<![A-Za-z\\])(sen|tg)(?=\s*(?:[(²^]|\\left|\\?theta|θ|q_?\d))"
)
_EQ = re.compile(r"^\s*(?:sp\.|sympy\.)?Eq\(\s*([A-Za-z]\w*)\s*,\s*(\S.*)\)\s*$", re.DOTALL)
"""An equation of sympy's."""
_ONE_BASED = re.compile(
    r"(?:#|%|//)[^\n]*\b(?:1-based|one-based|from\s+1|ab\s+1|Maple|MATLAB|Octave|Julia)\b",
    re.IGNORECASE,
)
_ENTRY = re.compile(r"^(\s*[A-Za-z])\[\s*([1-9])\s*(?:,\s*([1-9])\s*)?\](?=\s*=)")
_DISPLAY = re.compile(r"(?<=\S)\s*\\begin\{(equation\*?|displaymath)\}(.*?)\\end\{\1\}", re.DOTALL)
_WAVES = {"sen": "sin", "tg": "tan"}
_BELOW = re.compile(r"(?<=_\{)(\d)\s*,\s*(?:(\d)\s*,\s*(\d)|(\d\d))(?=\})")
"""Three indices with commas, as Christoffel's symbols have them: ``c_{3,22}``."""
STEP = re.compile(
    r"=\s*(?:(?:\\sum(?![A-Za-z])|[Σ∑])[^=]*"
    r"|(?:(?:\{\s*\}\s*\^\s*\{?\d\}?\s*)?[ATR]_?\{?\d{1,2}\}?\s*(?:[*·@]|\\cdot)?\s*){2,8})(?==)"
)
"""A step of a chain that says what is worked out: ``= Σ m_i g y_i =``, ``= A1 A2 A3 =``."""


def of_packages(text: str) -> str:
    """The text with LaTeX that needs no package, and no program's way of writing rates."""
    text = STEP.sub("", _PRINTED.sub("", text))
    text = _MATHEMATICAS.sub(_of_mathematica, text)
    if _ONE_BASED.search(text):
        text = _ENTRY.sub(lambda found: "".join(filter(None, found.groups())), text)
    text = _EQ.sub(r"\1 = \2", text)
    text = _OF_TYPST.sub(_of_typst, text)
    while found := _MATRIX_OF_TYPST.search(text):
        end = closes(text, found.end() - 1)
        if end < 0:
            break
        text = f"{text[: found.start()]}[{text[found.end() : end].strip()}]{text[end + 1 :]}"
    if "\\" in text:
        text = _DISPLAY.sub(lambda found: f"\n\\[{found[2]}\\]", text)
        text = _NUMBER.sub(lambda found: found[1] or found[2], text)
        text = _FENCE.sub("", _UNIT.sub("", text))
        text = _SLOPE.sub(_slope, text)
        text = _OF_TIME.sub(lambda found: found["name"], text)
        text = _RATE.sub(_rate, text)
    text = _BELOW.sub(lambda found: "".join(filter(None, found.groups())), text)
    return _SINE.sub(_wave, text)


def _slope(found: re.Match[str]) -> str:
    d = "d" if found["kind"] in ("dv", "deriv") else r"\partial"
    return rf"\frac{{{d} {found[2]}}}{{{d} {found[3]}}}"


def _of_typst(found: re.Match[str]) -> str:
    if found["above"]:
        return rf"\frac{{{found['above'].strip()}}}{{{found['below'].strip()}}}"
    name = found["name"] if len(found["name"]) == 1 else f"\\{found['name']}"
    return rf"\{'d' if found['twice'] else ''}dot{{{name}}}{found['k']}"


def _rate(found: re.Match[str]) -> str:
    dots = r"\ddot" if found["twice"] else r"\dot"
    return rf"{dots}{{{found['head']}}}_{found['k']}"


def _of_mathematica(found: re.Match[str]) -> str:
    head = {"θ": "theta", "th": "theta"}.get(found["head"], found["head"])
    return f"{head}{'d' * int(found['order'])}{found['k']}"


def _wave(found: re.Match[str]) -> str:
    name = _WAVES[found[1] or found[2] or found[3]]
    return name if found[3] else rf"\{name}"
