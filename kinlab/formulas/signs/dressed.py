r"""LaTeX as it is dressed for a page: ``\boxed``, ``\vec``, colours, eqnarray, ``{1 \over 2}``.

What only looks is left out; old commands become those of :mod:`kinlab.formulas.signs.latex`.
"""

from __future__ import annotations

import re

from kinlab.formulas.signs.brackets import closes

_BRACES = ("{", "}")
_BOX = re.compile(r"\\(?:boxed|fbox|framebox|underline|colorbox\s*\{\w*\})\s*(?=\{)")
_COLOUR = re.compile(r"\\(?:text)?color\s*(?:\[\w*\])?\s*\{[\w!.]*\}")
_ARROW = re.compile(r"\\(?:vec|overrightarrow|bm|boldsymbol|mathbf|mathbfit)(?![A-Za-z])\s*")
_FONT = re.compile(r"\\(mathcal|mathscr|mathrm|mathit|mathsf)\s+([A-Za-z])(?![A-Za-z])")
_SCRIPT = re.compile(r"\\mathscr\s*(?=\{)")
_FIRST = re.compile(
    r"^\s*(?:\$+\s*)?(?:(?:\\(?:therefore|because|Rightarrow|Longrightarrow|implies|to|rightarrow|quad)"
    r"(?![A-Za-z])|=>|->|[∴⇒→])\s*)+"
)
_STOP = re.compile(r"(?:\\[,;:! ]|~)+\s*([.,;]?)\s*(?=$|\$|\\end\b|\\\])")
_LINES = re.compile(r"\\(begin|end)\{(?:eqnarray|flalign|alignat|IEEEeqnarray)(\*?)\}(?:\{\w*\})?")
_AMPERSANDS = re.compile(r"&\s*=\s*&")
_COMMAND = re.compile(r"(?<!\\)\\[A-Za-z]")
_DISPLAY = re.compile(
    r"(?P<before>\s{0,40}(?:\$\$?|\\\[)?\s{0,40})(?P<begin>\\begin\{(?P<name>(?:equation|align|aligned|gather|gathered|"
    r"multline|split|displaymath)\*?)\})(?P<inside>.*)(?P<end>\\end\{(?P=name)\})"
    r"(?P<behind>[\s.,;]{0,40}(?:\$\$?|\\\])?[\s.,;]{0,40}|[\s.,;]{0,40}\b(?:where|with|wobei|mit)\s(?:(?!\\begin).)*)",
    re.DOTALL,
)
_BIG = re.compile(r"\\(begin|end)\{(?:B|V)matrix\*?\}")
_CASES = re.compile(
    r"\\left\s*\\(?:\{|lbrace)\s*\\begin\{(array|aligned|matrix|split)\}(?:\{[lcr| ]*\})?(.*?)"
    r"\\end\{\1\}\s*\\right\s*\.",
    re.DOTALL,
)
_NAMED_CASES = re.compile(
    r"^(\s{0,40}\${0,2}\s{0,40})\\?[A-Za-z][^=:&]{0,20}[=:]\s*(?=\\begin\{d?cases\}\s*\\?[A-Za-z][^&=]{0,20}=)"
)
"""``C = \\begin{cases} C_{11} = ...``"""
_FRACTION = re.compile(r"\\(?:nicefrac|sfrac|cfrac)(?![A-Za-z])")
_OVER = re.compile(r"\\over(?![A-Za-z])")
_ANGLE = r"(?:\\(?:var)?theta|q|th|theta|θ)_?(?:\{\d\}|\d|[₁-₉])"
_WAVE = re.compile(
    rf"(?<![\w\\}}])(?P<sign>\\mathrm\s*\{{\s*[cs]\s*\}}|[csCS])\s*(?:\\left\s*)?\(\s*"
    rf"(?P<angle>{_ANGLE}(?:\s*[-+]\s*{_ANGLE})*)\s*(?:\\right\s*)?\)"
)
_CAPITAL = re.compile(r"(?<![A-Za-z\\])([CS])\s*(?=\\(?:var)?theta\s*_)")
_LETTER = re.compile(r"(?<![\w\\{])(?:[csCS])(?![\w(])(?!\s*(?:\\theta|\\vartheta|_|\())")
_NUMBERED = re.compile(r"\\(cos|sin)\s*_\s*(\{\d+\}|\d)(?!\s*\^|\s*(?:\\theta|\\left|q|\())")
_WORD_NUMBERED = re.compile(r"(?<![\w.\\])(cos|sin)_?([1-9]{1,3})(?=\s*(?:$|[-+*/^),;\]\n=]))")
"""cos12, but not sin2 q1, which may be a square."""
_DETERMINANT = re.compile(
    r"\\begin\{vmatrix\}(.*?)\\end\{vmatrix\}"
    r"|(?:\\left\s*\||\\lvert|\|)\s*\\begin\{matrix\}(.*?)\\end\{matrix\}\s*(?:\\right\s*\||\\rvert|\|)",
    re.DOTALL,
)
_OF_J = re.compile(
    r"^\s*\$*\s*(?:\\det\s*(?:\\left)?\s*\(?|\\left\s*\||\|)\s*"
    r"\{?\s*(?:\\(?:mathbf|boldsymbol|mathrm|bm)\s*\{)?\s*J\s*\}?(?:\s*\(\s*\\?\w+\s*\))?\s*\}?\s*"
    r"(?:\\right)?\s*[)|]?\s*(?==)"
)
_PLAIN_DET = re.compile(r"^\s*det\s+(?:of\s+)?J(?:\s*\(\s*\w+\s*\))?\s*(?==)")
_TORQUE = re.compile(r"^(\s*\$*\s*)(?:\\Gamma|Γ|Gamma)_?(\{\d\}|\d|[₁-₉])?\s*(?==)")
_ROOM = re.compile(
    r"\\(?:tag\*?|label)\s*\{[^{}]{0,60}\}|"
    r"\\(?:hspace|hskip|mspace|kern)\*?\s*(?:\{[^{}]{0,20}\}|-?[\d.]+\s*(?:pt|em|ex|mm|cm|mu))"
    r"|\\math(?:rel|bin|ord|open|close)\s*\{\s*(?:\\[hv]?phantom\s*\{[^{}]{0,20}\}\s*)?\}"
    r"|\\[hv]?phantom\s*\{(?:[^{}]|\{[^{}]{0,9}\}){0,20}\}"
    r"|\\(?:enspace|enskip|thinspace|negthinspace|nonumber|notag|displaystyle|textstyle|hfill)(?![A-Za-z])"
    r"|(?<![\w}\]])\{\s*\}(?!\s*[\^_])"
)
"""Room and signs that are not seen, of which sums in several lines have some."""
_UNSEEN_LEFT, _UNSEEN_RIGHT = re.compile(r"\\left\s*\."), re.compile(r"\\right\s*\.")
_MOST = 60


def undressed(text: str, entry: str) -> str:
    """The text without what is only for the eye.

    Args:
        text: as typed.
        entry: what the formula is asked for.
    """
    if entry.startswith("tau"):
        text = _TORQUE.sub(lambda m: f"{m[1]}tau{m[2] or ''} ".replace("tau{", "tau_{"), text)
    if "det" in entry:
        chained = text.count("=") > 1 or "{" in text.partition("=")[0]
        text = _OF_J.sub("det ", text) if chained else _PLAIN_DET.sub("det ", text)
        text = _DETERMINANT.sub(lambda m: _determinant(m[1] or m[2]) or m[0], text)
    text = _FIRST.sub(lambda m: "$" * m[0].count("$"), text)
    text = _with_waves(text)
    text = _STOP.sub(lambda m: m[1] if m[1] in (",", ";") else "", _ROOM.sub(" ", text))
    if "\\" not in text:
        return text
    text = _COLOUR.sub(" ", text)
    text = _without(_BOX, text)
    text = _loosened(text)
    text = _ARROW.sub("", _plain_arrows(text)) if r"\vec" in text or "overright" in text else text
    text = _FONT.sub(r"\\\1{\2}", _SCRIPT.sub(r"\\mathcal", text))
    text = _CASES.sub(r"\\begin{cases}\2\\end{cases}", text)
    text = _NAMED_CASES.sub(r"\1", text)
    if len(_UNSEEN_LEFT.findall(text)) == len(_UNSEEN_RIGHT.findall(text)):
        text = _UNSEEN_LEFT.sub(" ", _UNSEEN_RIGHT.sub(" ", text))
    text = _LINES.sub(r"\\\1{align\2}", _AMPERSANDS.sub("&=", text))
    text = _without_display(_BIG.sub(r"\\\1{bmatrix}", text))
    return _with_fractions(_FRACTION.sub(r"\\frac", text))


def _without_display(text: str) -> str:
    """The text without the environments around the whole of it; dollars stay."""
    for _ in range(_MOST):
        found = _DISPLAY.fullmatch(text)
        inside = found["inside"] if found else ""
        nested = found and inside.count(found["begin"]) != inside.count(found["end"])
        if found is None or nested or not _COMMAND.search(inside):  # by one it is known as LaTeX
            break
        text = f"{found['before']}{inside}{found['behind']}"
    return text


def _without(command: re.Pattern[str], text: str) -> str:
    """``\\boxed{X}`` as X, in braces where it is no equation."""
    for _ in range(_MOST):
        found = command.search(text)
        end = closes(text, found.end(), _BRACES) if found else -1
        if found is None or end < 0:
            break
        inside = text[found.end() + 1 : end]
        inside = inside if "=" in inside else f"{{{inside}}}"
        text = f"{text[: found.start()]} {inside} {text[end + 1 :]}"
    return text


def _loosened(text: str) -> str:
    """An equation without the braces that a colour had: ``{x = ...}``."""
    plain = text.strip()
    dollars = plain[: len(plain) - len(plain.lstrip("$"))]
    core = plain[len(dollars) : len(plain) - len(dollars)].strip() if dollars else plain
    whole = core[:1] == "{" and closes(core, 0, _BRACES) == len(core) - 1 and "=" in core
    return f"{dollars}{core[1:-1]}{dollars}" if whole else text


def _plain_arrows(text: str) -> str:
    """``\\vec{g}`` as g; of more than a letter the braces stay."""
    return re.sub(
        r"\\(?:vec|overrightarrow)\s*\{\s*(\\?[A-Za-z]+)\s*\}", lambda m: f"{m[1]} ", text
    )


def _with_fractions(text: str) -> str:
    """``{a \\over b}`` as ``\\frac{a}{b}``; without braces around it stays."""
    for _ in range(_MOST):
        found = _OVER.search(text)
        if found is None:
            break
        start, depth = found.start() - 1, 0
        while start >= 0 and (text[start] != "{" or depth):
            depth += (text[start] == "}") - (text[start] == "{")
            start -= 1
        end = closes(text, start, _BRACES) if start >= 0 else -1
        if end < found.end():
            break
        above, under = text[start + 1 : found.start()].strip(), text[found.end() : end].strip()
        text = rf"{text[:start]}\frac{{{above}}}{{{under}}}{text[end + 1 :]}"
    return text


def _with_waves(text: str) -> str:
    """``c(\\theta_1 + \\theta_2)`` as a cosine, where no c stands alone; ``\\cos_{12}`` as c12."""
    text = _NUMBERED.sub(lambda m: f"{m[1][0]}_{m[2]}", text)
    if "\\" not in text:
        text = _WORD_NUMBERED.sub(lambda m: f"{m[1][0]}{m[2]}", text)
    found = _WAVE.search(text)
    plain = "\\" if "\\" in text or "$" in text else ""
    if found and not _LETTER.search(_WAVE.sub(" ", text)):
        text = _WAVE.sub(lambda m: _wave(m, plain), text)
    return _CAPITAL.sub(lambda m: m[1].lower(), text)


def _wave(found: re.Match[str], plain: str) -> str:
    letter = re.sub(r"\\mathrm|[\s{}]", "", found["sign"])
    angle = found["angle"]
    if letter.isupper() and not re.search(r"[-+]", angle):
        return found[0]  # C(q1) may be a matrix
    return f"{plain}{'cos' if letter in 'cC' else 'sin'}({angle})"


def _determinant(inside: str) -> str:
    """A determinant of two or three rows, written out."""
    rows = [row.split("&") for row in re.split(r"\\\\(?:\[[^\]]*\])?", inside) if row.strip()]
    if len(rows) not in (2, 3) or any(len(row) != len(rows) for row in rows):
        return ""
    cells = [[f"({cell.strip()})" for cell in row] for row in rows]
    if len(rows) == 2:
        (a, b), (c, d) = cells
        return rf"({a} \cdot {d} - {b} \cdot {c})"
    terms = []
    for sign, (i, j, k) in (
        *(("+", order) for order in ((0, 1, 2), (1, 2, 0), (2, 0, 1))),
        *(("-", order) for order in ((2, 1, 0), (1, 0, 2), (0, 2, 1))),
    ):
        terms.append(rf"{sign} {cells[0][i]} \cdot {cells[1][j]} \cdot {cells[2][k]}")
    return f"({' '.join(terms)[2:]})"
