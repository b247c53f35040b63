"""Formulas as they stand in programs: ``lambda q: ...``, ``def x(q):``, ``self.l1``, ``// why``.

What is around the formula is left out, and what only programs have is written as a formula.
"""

from __future__ import annotations

import re
from itertools import islice

from kinlab.formulas.language.vocabulary import is_listed, names_a_part, words_of
from kinlab.formulas.signs.brackets import closes, outside, parts_at
from kinlab.formulas.signs.refusals import refused
from kinlab.host.language import N_

_FENCE = re.compile(r"^\s*```[\w+-]*\s*\n(.*?)\n?\s*```\s*$", re.DOTALL)
_TICKS = re.compile(r"^\s*`([^`]+)`\s*[.;]?\s*$")
_TWO_INDICES = re.compile(r"(?<![\w.\]])([A-Za-z]\w*)\[\s*(\d)\s*\]\[\s*(\d)\s*\]")
_ONE_INDEX = re.compile(r"(?<![\w.\]])([A-Za-z]\w*)\[\s*([0-8])\s*\](?!\s*\[)")
_TYPE = re.compile(
    r"(?m)^[ \t]{0,40}(?:const\s+)?(?:double|float|auto|var|let|const)\s+(?=[A-Za-z_]\w*\s*=)"
)
"""What C writes in front of a name."""
_GOES_ON = re.compile(r"[ \t]*(?:\.{3}[^\n]*|(?<!\\)\\[ \t]*)\n\s*")
"""The end of a line that goes on in the next one, in MATLAB and in Python."""
_NOTES = re.compile(r"/\*.*?\*/|\(\*.*?\*\)", re.DOTALL)
_COMMENT = re.compile(
    r"[ \t]//(?:[ \t]*(?!(?:sin|cos|tan|sqrt)\b)[A-Za-z\u4e00-\u9fff',.:-]+)+[ \t]*$", re.MULTILINE
)
"""Behind two slashes words alone; what may be a divisor stays."""
_REMARK = re.compile(r"(?m)(?:^|[ \t])#(?![\d{])[^\n]*$")
"""What Python leaves out."""
_LONG_WORD = re.compile(r"[A-Za-z]{3}|[\u4e00-\u9fff]")
_STATE = r"(?:q|qd|qdd|dq|ddq|th|theta|thd|thetad|θ|t|v|a)_?\d?"
_STATES = rf"{_STATE}(?:\s*,\s*{_STATE})*"
_LAMBDA = re.compile(rf"^(\s*\w+\s*=\s*)?(?:lambda\s+{_STATES}\s*:|@\(\s*{_STATES}\s*\))\s*(?=\S)")
"""A function without a name of its own, also MATLAB's: ``x = @(q1, q2) ...``."""
_UNPACKED = re.compile(r"((?:[A-Za-z]+_?\d[ \t]*,[ \t]*)+[A-Za-z]+_?\d)[ \t]*=[ \t]*([A-Za-z]+)")
_ANGLES = ("q", "th", "theta", "t")
_GIVEN_BACK = re.compile(r"return[ \t]+(\w+)[ \t;]*")
_DEFINED = re.compile(rf"^\s*def\s+(\w+)\s*\(\s*(?:self\s*,\s*)?{_STATES}\s*\)[^:\n]*:\s*")
_RETURN = re.compile(r"^[ \t]*return\s+(?=\S)", re.MULTILINE)
_IMPORT = re.compile(r"^[ \t]*(?:import|from)[ \t]+\w[^\n;]*(?:\n|;[ \t]*)", re.MULTILINE)
_OWNER = re.compile(
    r"(?<![\w.])(self|this|p|par|param|params|robot|arm|obj|model|cfg|config|prm)\.(?=[A-Za-z_])"
)
_SINGLE = re.compile(r"(?<![\w.])(sin|cos|tan|sqrt|pow|atan2|fabs|asin|acos)f(?=\s*\()")
_STANDARD = re.compile(r"(?<![\w.])std::(?=[a-z])")
_GLUED = re.compile(r"(?<![\w.\\])([A-Za-z]+_?\d+)(sin|cos|tan|sqrt)(?=\s?\()")
_TWO_SIGNS = re.compile(r"(?<![<>!=:])==(?!=)")
_NAMES = re.compile(r"\s*([A-Za-z]\w*(?:\s*,\s*[A-Za-z]\w*)+)\s*=(?!=)\s*(\S.*)")
_BRACES = re.compile(r"^(\s*[A-Za-z]\w*(?:\([\w, ]*\))?\s*:?=)?\s*(?=\{)")
_COMMA = re.compile(r"(?<![\w.,{\[])(\d+),(\d+)(?![\d,.])")
_OTHER_COMMA = re.compile(r"(?<!\d),|,(?!\d)")
_CALL = re.compile(r"(?:(?<![A-Za-z])(?!(?:sin|cos|tan|sqrt)\()[A-Za-z_]\w*|[\])])\s?\(\s*-?$")
_POINT = re.compile(r"\d\.\d")
_SUMS = re.compile(r"(?<![\w.])(?:np\.|numpy\.)?(?:linalg\.)?(dot|sum|norm)\s*\((?=\s*\[)")
_HYPOT = re.compile(r"(?<![\w.])(?:(?:np|numpy|math)\.)?hypot\s*\(")
_NUMBERED = re.compile(
    r"^\s*(?:\(\s*\d+(?:[.-]\d+)?[a-z]?\s*\)|\d+[.)])\s*(?=[\\A-Za-zα-ω][^=\n]{0,30}=)"
    r"|(?<=\n)[ \t]*\d+[.)][ \t]+(?=[\\A-Za-zα-ω][^=\n]{0,30}=)"
)
_SQUARE = re.compile(r"(?:^|[-+*/^=(\[ ]|(?<![\w.])\d)\[(?=[^\[\]]{3})")
_ANY_SQUARE = re.compile(r"\[(?=[^\[\]]{3})")
_BELOW = re.compile("[₀-₉]")
_PROMPT = re.compile(
    r"^[ \t]*(?:(?:In|Out)[ \t]?\[\d+\](?:[ \t]?//[ \t]?\w+)?[ \t]?:?=?|>{2,3}(?=[ \t]))[ \t]*",
    re.MULTILINE,
)
"""Prompts of IPython, Python, MATLAB and Mathematica."""
_ANSWER = re.compile(r"[ \t]*Out")
_PRINTED = re.compile(r"^\s*(?:[A-Za-z]+:[ \t]*)?print\s*\(([^\n=]*)\)[ \t;]*\n(?=\s*\S)")
"""What prints the formula below."""
_SHOWING = re.compile(
    r"(?:(?:sp|sympy)\.)?(?:simplify|print|pprint|expand|factor|trigsimp|latex|vpa|disp|Simplify|FullSimplify|Expand)"
    r"[ \t]*(?:\(|\[)(.*)(?:\)|\])"
)
"""What only shows something, or gathers its terms."""
_NAME = re.compile(
    r"([A-Za-z]\w*?)(?:(\[+[ \t]*\d+(?:[ \t]*(?:,|\]\[)[ \t]*\d+)?[ \t]*\]+)"
    r"|(\([ \t]*\d+(?:[ \t]*,[ \t]*\d+)?[ \t]*\)))?"
)
_OF_MATLAB = re.compile(r"^[ \t]*ans[ \t]*=[ \t]*")
_COMMENTED = re.compile(
    r"[ \t]*(?:(?<!\\)%+|(?<![:/])//(?!=)|(?<![^\s;])#(?![\d{]))([^\n]*=[^\n]*)"
    r"|/\*((?:(?!\*/)[^\n]){1,400})\*/|\(\*((?:(?!\*\))[^\n]){1,400})\*\)"
)
"""Comments with equations, of Python, MATLAB, LaTeX, C and Mathematica."""
_SO_ON = re.compile(r"(?:\betc\.?|\.{3}|…|\busw\.?|等)[\s.]*$|\b(?:where|with|and|mit|wobei|und)\b")
_GIVES = re.compile(r"([A-Za-z]{1,5}_?\d{0,3}|\\?[A-Za-z]+_\{?\w{1,4}\}?)\s*=(?!=)\s*([^=]+)")
_ROWS = re.compile(
    r"(\s*[A-Za-z]\w*(?:\([\w, ]*\))?[ \t]*:?=)?\s*"
    r"(\[[^\n]*\][ \t,;]*(?:\n[ \t]*\[[^\n]*\][ \t,;]*)+)\s*"
)
_MOST = 40
_NEAR = 30
"""Letters in front of a number that say whether it is an index."""


def without_prompts(text: str) -> str:
    """What a shell answers, without its prompts: ``Out[7]: ...``.

    What it was asked is the answer's left side where that is a name, ``M[0,1]`` of Python being
    M(1,2); what a prompt's line gives a name stays, and so do the last line and all comments.
    """
    if not _PROMPT.search(text) and not _PRINTED.match(text):
        return text
    python = ">>>" in text or bool(re.search(r"In[ \t]?\[\d+\][ \t]?:(?!=)", text))
    printed = _PRINTED.match(text)
    lines = [line for line in _PRINTED.sub("", text).split("\n") if line.strip()]
    kept: list[str] = []
    name = "" if printed is None else _asked(printed[1], True)
    for k, line in enumerate(lines):
        plain = _PROMPT.sub("", line)
        prompted = plain != line and not _ANSWER.match(line)
        if prompted and k < len(lines) - 1 and "=" not in [sign for _at, sign in outside(plain)]:
            name = _asked(plain, python)
            kept += [remark[0].strip()] if (remark := _REMARK.search(plain)) else []
            continue
        if name and not prompted:
            plain = _OF_MATLAB.sub("", plain)
            given = "=" in [sign for _at, sign in outside(plain)]
            plain, name = plain if given else f"{name} = {plain.strip()}", ""
        kept.append(plain)
    return "\n".join(one for one in kept if one.strip())


def _asked(text: str, python: bool) -> str:
    """The name that a shell was asked for, its places from 1; empty where it was more."""
    while found := _SHOWING.fullmatch(_REMARK.sub("", text).strip("; \t")):
        text = found[1]
    found = _NAME.fullmatch(_REMARK.sub("", text).strip("; \t"))
    if found is None:
        return ""
    places = [int(one) + python for one in re.findall(r"\d+", found[2] or found[3] or "")]
    return f"{found[1]}({','.join(map(str, places))})" if places else found[1]


def with_definitions(text: str) -> str:
    """What comments give names of the formula, in front of it: ``# c12 = cos(q1 + q2)``.

    What else a comment says stays in it.
    """
    rest, made = _COMMENTED.sub("", text), list[str]()

    def left(comment: re.Match[str]) -> str:
        inside = next(part for part in comment.groups() if part is not None)
        kept: list[str] = []
        for piece in parts_at(_SO_ON.sub("", inside), ",;"):
            found = _GIVES.fullmatch(piece)
            name = re.escape(found[1]) if found else ""
            used = found and re.search(rf"(?<![\w\\]){name}(?![\w(]|\s*:?=)", rest)
            (made if used else kept).append(piece)
        if not any(kept):
            return ""
        return comment[0].replace(inside, f" {', '.join(filter(None, kept))}")

    other = _COMMENTED.sub(left, text)
    return "; ".join([*made, other.strip()]) if made else text


def _is_of_a_part(comment: str) -> bool:
    """Whether a comment says of which part of the arm a line is, and nothing else."""
    return not re.search("[=<>*^]", comment) and all(map(names_a_part, words_of(comment)))


_ADDED = r"[A-Za-z]\w*(?:\[[\d, ]+\]|\([\d, ]+\))?"
_ADDS = re.compile(rf"({_ADDED})\s*(?:([-+])=|=\s*\1(?![\w\[(])\s*([-+]))\s*(\S[^=]*)")
"""What is added to a name that has a value: ``M11 += b``, ``M11 = M11 + b``."""
_BEHIND = re.compile(
    r"(?:^|[ \t]+)(?:%|#|//)[^\n]*$|[ \t]+\([^()=*/^+\n]*[^\W\d_]{3}[^()=*/^+\n]*\)$"
)
"""A comment at a line's end, or words in parentheses."""
_A_VALUE = re.compile(rf"({_ADDED})\s*=\s*(\S[^=]*)")


def added_up(text: str, place: str) -> str:
    """``M11 = a; M11 += b`` as ``M11 = a + (b)``; what is added to nothing stays as it is.

    What comments say of the parts, ``# link 2``, is left out.

    Args:
        text: as typed.
        place: what to put in front of a message.

    Raises:
        ExpressionError: ``M11 += b`` without what it adds to.
    """
    parts = [(_BEHIND.sub("", one), _BEHIND.search(one)) for one in parts_at(text, ";\n")]
    adding = [one for one, _comment in parts if _ADDS.fullmatch(one)]
    given = [one for one, _comment in parts if _A_VALUE.fullmatch(one)]
    if not adding or any(map(is_listed, words_of(" ".join([*given, *adding])))):
        _refuse_additions(text, place)
        return text
    sums: dict[str, str] = {}
    made: list[str] = []
    for one, comment in parts:
        adds, gives = _ADDS.fullmatch(one), _A_VALUE.fullmatch(one)
        made += [comment[0].strip()] if comment and not _is_of_a_part(comment[0]) else []
        if adds and adds[1] in sums:
            name = adds[1]
            made.remove(f"{name} = {sums[name]}")
            sums[name] += f" {adds[2] or adds[3]} ({adds[4].strip()})"
        elif gives:
            name = gives[1]
            sums[name] = gives[2]
        else:
            made += [one] if one else []
            continue
        made.append(f"{name} = {sums[name]}")
    whole = "\n".join(made)
    _refuse_additions(whole, place)
    return whole


_ADDITION = re.compile(rf"(?<![\w.\\]){_ADDED}[ \t]*([-+])=(?!=)")


def _refuse_additions(text: str, place: str) -> None:
    """Refuses what is added to a name that has no value, or one with words behind it."""
    if found := _ADDITION.search(text):
        said = N_("{sign} adds to what is not there; write the whole formula")
        raise refused(place, said, sign=f"{found[1]}=")


def _rows_together(text: str) -> str:
    """Rows in brackets, each in a line of its own, as one matrix."""
    found = _ROWS.fullmatch(text)
    rows = [row.strip(" \t,;") for row in found[2].split("\n") if row.strip()] if found else []
    if found is None or any(closes(row) != len(row) - 1 for row in rows):
        return text
    return f"{found[1] or ''}[{', '.join(rows)}]"


def without_code(text: str, alone: bool) -> str:
    """The formula of a piece of a program.

    Args:
        text: as typed.
        alone: whether it is one number, no vector and no matrix.
    """
    text = _GOES_ON.sub(" ", text)
    for around in (_FENCE, _TICKS):
        found = around.match(text)
        text = found[1] if found else text
    text = _NOTES.sub(" ", text)
    text = _REMARK.sub("", text)
    text = _COMMENT.sub(lambda m: " " if _LONG_WORD.search(m[0]) else m[0], text)
    text = _NUMBERED.sub("", text)
    text = _of_function(text)
    if "\\" in text or "$" in text:
        return text
    text = _TYPE.sub("", text)
    if any("0" in found[1:] for found in _TWO_INDICES.findall(text)):  # C's q[1] beside M[0][0]
        text = _ONE_INDEX.sub(lambda found: f"{found[1]}{int(found[2]) + 1}", text)
    text = _TWO_INDICES.sub(r"\1[\2,\3]", text)
    text = _without_hypot(text)
    owner, *others = sorted({*_OWNER.findall(text)}) or [""]
    if owner and not others and not re.search(rf"(?<![\w.]){owner}(?![\w.])", text):
        text = _OWNER.sub("", text)
    text = _STANDARD.sub("math.", _SINGLE.sub(r"\1", text))
    text = _TWO_SIGNS.sub("=", _GLUED.sub(r"\1 \2", text))
    text = _rows_together("\n".join(map(_one_each, text.split("\n"))))
    text = _without_lists(_in_brackets(text))
    text = _in_parentheses(text) if alone else text
    if alone and not _POINT.search(text) and not _OTHER_COMMA.search(text):
        text = _COMMA.sub(lambda found: _with_point(found, text), text)
    return text


def _with_point(found: re.Match[str], text: str) -> str:
    """``0,5`` as ``0.5``, but for two indices or arguments: ``C(1,2)``, ``atan2(1,2)``."""
    listed = _CALL.search(text[max(0, found.start() - _NEAR) : found.start()])
    return found[0] if listed else f"{found[1]}.{found[2]}"


def _of_function(text: str) -> str:
    """What a function answers, with the lines before."""
    text = _LAMBDA.sub(lambda found: found[1] or "", _IMPORT.sub("", text))
    found = _DEFINED.match(text)
    if found is None:
        return text
    lines = [line.strip() for line in text[found.end() :].split("\n") if line.strip()]
    lines = [line for line in lines if not _takes_joints(line)]
    back = _GIVEN_BACK.fullmatch(lines[-1]) if len(lines) > 1 else None
    above = re.match(rf"{back[1]}[ \t]*=(?!=)[ \t]*", lines[-2]) if back else None
    if above is not None:  # whatever it is called there
        lines[-2:] = [lines[-2][above.end() :]]
    return _RETURN.sub("", "\n".join(lines))


def _takes_joints(line: str) -> bool:
    """Whether a line takes the joints out of their row in order: ``q1, q2 = q``, no ``q2, q1``."""
    found = _UNPACKED.fullmatch(line.rstrip("; "))
    if found is None:
        return False
    every = [re.sub(r"[_ \t]", "", name) for name in found[1].split(",")]
    heads = {name[:-1] for name in every}
    same = heads == {found[2]} or (heads <= {*_ANGLES} and found[2] in _ANGLES)
    return same and [int(name[-1]) for name in every] == [*range(1, len(every) + 1)]


def _one_each(line: str) -> str:
    """``c1, s1 = cos(q1), sin(q1)`` as two lines."""
    found = _NAMES.fullmatch(line)
    if found is None:
        return line
    names, values = parts_at(found[1], ","), parts_at(found[2].rstrip("; \t"), ",")
    if len(names) != len(values) or any("=" in value for value in values):
        return line
    return "\n".join(f"{name} = {value}" for name, value in zip(names, values, strict=True))


def _in_brackets(text: str) -> str:
    """``{a, b}`` as ``[a, b]``, a list of Mathematica's or C's."""
    found = _BRACES.match(text)
    start = found.end() if found else 0
    body = text.rstrip("; \t\n")
    if (
        found is None
        or closes(body, start) != len(body) - 1
        or body[start + 1 :].lstrip()[:1] == "{"
    ):
        return text
    inside = body[start + 1 : -1]
    return f"{body[:start]}[{inside}]" if len(parts_at(inside, ",")) > 1 else text


def _in_parentheses(text: str) -> str:
    """``[a + b]θ̈₁`` as ``(a + b)θ̈₁``: a sum in brackets, which is no list.

    Behind a name, ``g[a + b]``, only where indices are small letters: ``m₃g[½l₂ + l₃]``.
    """
    pattern = _SQUARE if text.isascii() or not _BELOW.search(text) else _ANY_SQUARE
    for found in islice(pattern.finditer(text), _MOST):
        start, end = found.end() - 1, closes(text, found.end() - 1)
        inside = text[start + 1 : end]
        if end > 0 and _is_sum(inside) and len(parts_at(inside, ",;\n")) == 1:
            text = f"{text[:start]}({inside}){text[end + 1 :]}"
    return text


def _without_lists(text: str) -> str:
    """``dot([a, b], [c, d])``, ``sum([a, b])`` and ``norm([a, b])`` written out."""
    start = 0
    for _ in range(_MOST):
        found = _SUMS.search(text, start)
        end = closes(text, found.end() - 1) if found else -1
        if found is None or end < 0:
            break
        lists = [_members(one) for one in parts_at(text[found.end() : end], ",")]
        told = _written_out(found[1], lists)
        start = found.start() + 1
        if told:
            text = f"{text[: found.start()]}{told}{text[end + 1 :]}"
    return text


def _without_hypot(text: str) -> str:
    """``hypot(a, b)`` as the root of a sum of squares."""
    for _ in range(_MOST):
        found = _HYPOT.search(text)
        end = closes(text, found.end() - 1) if found else -1
        sides = parts_at(text[found.end() : end], ",") if found and end > 0 else []
        if found is None or len(sides) != 2:
            break
        squares = " + ".join(f"({side})**2" for side in sides)
        text = f"{text[: found.start()]}sqrt({squares}){text[end + 1 :]}"
    return text


def _members(text: str) -> list[str]:
    if text[:1] != "[" or closes(text) != len(text) - 1 or "[" in text[1:]:
        return []
    return [one for one in parts_at(text[1:-1], ",;") if one]


def _written_out(name: str, lists: list[list[str]]) -> str:
    if not all(lists) or len(lists) != (2 if name == "dot" else 1):
        return ""
    if name == "dot":
        if len(lists[0]) != len(lists[1]):
            return ""
        return f"({' + '.join(f'({a})*({b})' for a, b in zip(*lists, strict=True))})"
    if name == "sum":
        return f"({' + '.join(f'({a})' if _is_sum(a) else a for a in lists[0])})"
    return f"sqrt({' + '.join(f'({a})**2' for a in lists[0])})"


def _is_sum(text: str) -> bool:
    return any(one in "+-" for _k, one in outside(text))
