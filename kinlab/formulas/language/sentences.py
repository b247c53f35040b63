"""The equations in a text with sentences: ``Differentiating x by q2 we get J12 = ...``.

What words are is told by the lists of :mod:`kinlab.formulas.language.vocabulary`, and by their
length; they are taken out, and of what is left the equation of the entry is kept, with those that
explain its names.
"""

from __future__ import annotations

import re

from kinlab.formulas.language.prose import MATHS, is_condition
from kinlab.formulas.language.vocabulary import (
    ASIDE,
    CHINESE,
    LATIN,
    is_linking,
    is_listed,
    is_program,
)
from kinlab.formulas.signs.brackets import parts_at
from kinlab.formulas.typed import (
    begins_with,
    explains_another,
    is_name,
    is_name_of,
    says_what_it_is,
)

_PROGRAM = re.compile(r"\b(?:def|lambda|return|import)\b|```|^\s*`")
_FONT = re.compile(r"\\(?:text|textrm|textit|textbf|mbox|textnormal|hbox)\s*\{([^{}]*)\}")
_WORD = re.compile(
    rf"(?<![\w\\{{.])[{LATIN}]{{2,}}(?:['’-][{LATIN}]{{2,}}|['’]s)*(?![\w(\[{{}}])|[{CHINESE}]+"
)
_DOTTED = re.compile(
    r"\b(?:i\.\s?e|e\.\s?g|d\.\s?h|z\.\s?b|q\.\s?e\.\s?d|bzw|w\.\s?r\.\s?t|resp|ans|eqn?|no|nr|sol|fig|vgl|abb|gl|cf|sec|ch|tab|kap|abschn|aufg|bsp|thm|prop|lect|chap|pp)\.(?=\s|,|$|:)",
    re.IGNORECASE,
)
_MEANS = r"\s+(?:denotes|means|stands for|is short for|steht für|表示)\s+"
_WORKED_OUT = r"(?=[^,;.=$]{0,60}(?:[-+*/(^]|\\?(?:cos|sin|tan)(?![a-z])))"
_DENOTES = re.compile(rf"([\\\w{{}}]{{1,15}}){_MEANS}{_WORKED_OUT}")
_DENOTES_IN_MATHS = re.compile(rf"(\$[^$=]{{1,15}})\${_MEANS}\${_WORKED_OUT}")
_AND = re.compile(r"and|und|plus|minus|times|twice")
_OPEN_END = re.compile(r"[\w)}\]²³₀-₉']$")
_LETTERS = re.compile(
    rf"(?<![\w\\{{.])(?!(?:sin|cos|tan|sqrt)\b)[{LATIN}]{{3,}}(?![\w(])|[{CHINESE}]"
)
_COMMENT = re.compile(r"(?<!\\)(?<![\d ] )(?:^|(?<=[\s;]))%[^\n=]*$", re.MULTILINE)
"""A comment of LaTeX's or MATLAB's, without an equation in it."""
_ABOUT = re.compile(
    rf"(?<![\w*/^+=-])[xyz]-(?=(?:coordinate|component|position|koordinate|komponente)[{LATIN}]*)"
    r"|[(（]\s*(?:units?|einheit(?:en)?|单位)\s*[:：]?\s*(?:kg|rad|Nm|N|m|J|s|SI)(?![A-Za-z])[\s/^0-9*·kgNmJsrad,，、]{0,8}[)）]"
    rf"|{ASIDE}",
    re.IGNORECASE,
)
"""Letters that are part of a word, a unit in parentheses, and words in parentheses."""
_OPERATOR = re.compile(r"[*/^+=<>]|\\(?:sin|cos|tan|d?frac|sqrt)(?![A-Za-z])")
_UNIT = re.compile(r"\s*(?:(?:SI|the|units?|of)\s+)*(?:mm|cm|dm|km|m|kg|N|Nm|J|rad|s|deg)\b")
_GAP = "\0"
_BETWEEN = re.compile(
    rf"(?<=\0)\s*[,;:]?\s*\b[{LATIN}]{{1,3}}\b(?=[\s,;:.!?]*\0)|(?:^|(?<=[(\n])|(?<=[.,;:]\s))[{LATIN}]{{1,3}}(?=\s+\0)"
)
"""A short word that no list has, between others or behind a comma."""
_BRACKETS = re.compile(r"\(\s*[\0\s,.;:?!'-]*\0[\0\s,.;:?!'-]*\)|\[\s*\0[\0\s]*\]")
_LABEL = re.compile(
    r"^\s*(?:(?:[QqAa]?\s?\d{0,2}\s?\(?[a-h]?|\(?[ivx]{1,4})[).:](?![\d*/^=])\s*)+(?=\S)"
)
_SUBJECT = re.compile(r"(?<==)([^=,;]+)[,;]\s*I_?\{?[a-z]{0,2}\d\}?\s*$")
"""Whose moment of inertia a sentence behind a formula is about: ``..., I2 taken at the pivot``."""
_BEHIND_DOLLARS = re.compile(
    r"(?<=\$)\s{0,3}(?:N\s?m|N·m|J|N|kg\s?m(?:\^2|²)?|m|rad|(?:m|rad)/s(?:\^2|²)?)\s{0,3}$"
)
"""A unit behind a formula's dollars, which is no factor of it."""
_OF_A_WRENCH = re.compile(r"[FfMmNn][xyz]")
"""Names of forces and moments, of which one is a word, too: ``My``."""
_SHORT = 4
_LONG = 4
"""Letters from which on what is in no list is a word."""
_MOST = 200
"""Words of a text beside a formula."""
_EDGES = " \t\r\n,.;:!?'’–—#%~"
_FRONT = re.compile(
    r"^(?:[\s,.;:!?'’–—#%~]|/{2}|/\*|\*/|=>|->|-->|\\Rightarrow|\\q?quad|\\[,;! ]|\)"
    r"|-\s(?=[\\A-Za-z][^=\n]{0,30}=))+"
)
_BACK = re.compile(
    r"(?:-{2,}|[\s,;:!?'’–—#%~(]|/{2}|/\*|\*/|=>|->|\\q?quad|\\[,;! ]|(?<=[\s\w)}\]])\.)+$"
)
_SIDES = re.compile(r"^(?P<left>[^=]{1,80}?)(?P<sign>\s*&?\s*:?==?(?!=))(?P<right>.*)$", re.DOTALL)
_ALIGNED = re.compile(
    r"\\(?:begin|end)\{(?:equation|align|aligned|gather|gathered|split|multline)\*?\}"
)
_NAME = re.compile(
    r"\s*&?\s*(?:det\s*\(?\s*J\s*\)?(?:\(\w+\))?"
    r"|(?:(?:\{\s?\}\s?)?(?:[_^]\{?\s?\d\s?\}?\s?){1,2}(?=\\?\{?[TAHR]))?"
    r"\\?[A-Za-zα-ωΑ-Ω][\w\\{}'₀-₉ ̇̈^,]*"
    r"(?:\s*\([^()]{0,30}\)|\[[\d,\[\]]+\])?"
    r"|\\(?:det|dot|ddot|mathrm|text|boldsymbol|mathbf)[^=]{1,40})\s*"
)
_NEXT_LINE = re.compile(
    r"\n(?=[ \t&]{0,40}[^\s=&][^\n=]{0,40}=)"
    r"|\\\\(?:\[[^\]]*\])?\s*(?=[&\s]{0,9}\\?[A-Za-z][^\n=+*/-]{0,30}=)"
)
_SIGNS = re.compile(r"[_{}\\\s$&]")


def without_sentences(text: str, entry: str) -> tuple[str, list[str]]:
    """The equations of a text with words; the text as it is where there are no words.

    Args:
        text: as typed.
        entry: what the formula is asked for.

    Returns:
        Them; and the sides of equations with words, or a derivative, in place of a name that are
        left out: ``V = ..., its derivative = ...``.
    """
    if _PROGRAM.search(text) or len(_WORD.findall(text)) > _MOST:
        return text, []
    opened, marked = _without_words(text)
    kept = _kept(opened, marked, entry)
    return kept, _left_out(_pieces(marked), kept) if "=" in text and kept != text else []


def _kept(text: str, marked: str, entry: str) -> str:
    """The equation of the entry, with those that explain its names."""
    if _GAP not in marked and MATHS.search(marked) and "=" in MATHS.sub(" ", marked):
        lines = MATHS.sub(lambda found: f";\n{_bare(found[0])};\n", marked).split(";\n")
        return f"${';'.join(line.strip() for line in lines if line.strip())}$"
    if _GAP not in marked and len(MATHS.findall(text)) < 2:
        return text
    pieces = _pieces(marked)
    dollars = any(mark in piece for piece in pieces for mark in ("$", r"\[", r"\("))
    pieces = [_bare(_BEHIND_DOLLARS.sub("", piece)) for piece in pieces]
    kept = _of_entry([piece for piece in pieces if piece], entry)
    if not kept:
        return text
    told = ";\n".join(kept)
    return f"${told}$" if dollars else told


def _left_out(pieces: list[str], kept: str) -> list[str]:
    """What of the pieces is neither judged nor has a name by which it is told."""
    pieces = [*map(_bare, pieces)]
    judged = {_plain(side) for one in re.split(r"[;\n]", kept) for side in one.split("=")}
    found = [one for one in _behind_an_equation(pieces) if _plain(one) not in judged]
    for left, *sides in (one.split("=") for piece in pieces for one in _equations(piece)):
        name = left.strip("& ,:").rpartition(" ")[2]
        word = len(name) > 1 and (is_listed(name) or _is_said(name))
        if not name or word or _DERIVED.search(left):
            sides = [x.strip() for x in sides if _plain(x) not in judged]
            found += [f"= {one}" for one in sides if re.search(r"\d|[*/^+(\\]", one)]
    return found


def _behind_an_equation(pieces: list[str]) -> list[str]:
    """Sums without a sign of equality behind an equation: what words say of them is not known."""
    begun = next((k for k, one in enumerate(pieces) if "=" in one), len(pieces))
    plain = [one.strip(" ,.;:") for one in pieces[begun:] if "=" not in one]
    return [one for one in plain if re.search(r"\d", one) and _SUM_OR_DECIMALS.search(one)]


_SUM_OR_DECIMALS = re.compile(r"[A-Za-zα-ω]\w*[^\w+−-]*[+−-]\s*[\w\\(]|^[−-]?\d+\.\d+(?![.\d])")
"""A sum with names, or a number with decimals."""


_DERIVED = re.compile(
    r"d\s?/\s?d\s?t|∂|\\partial|\\frac\s?\{\s?(?:\\mathrm\s?\{\s?)?d|\bd\w+\s?/\s?d\w"
)
"""A derivative."""


def _without_words(text: str) -> tuple[str, str]:
    """A text with the sides of its equations joined, and the same with a mark for each word."""
    text = _DENOTES.sub(r"\1 = ", _DENOTES_IN_MATHS.sub(r"\1 = ", text))
    text = _ABOUT.sub(" ", _COMMENT.sub("", text))
    opened = _FONT.sub(lambda found: _opened(found, text), text)
    joined = _with_the_last(_joined(_THAT_IS.sub("that is", opened)))
    return text if joined == opened else joined, _marked(joined)


def _pieces(marked: str) -> list[str]:
    """What stands between words."""
    *spoken, ending = marked.split(_GAP)
    parts = [
        one
        for part in [*(_SUBJECT.sub(r"\1", part) for part in spoken), ending]
        for one in re.split(r"(?<=\$)\s*[\n,;]\s*(?=\$)", part)
    ]
    return [piece for part in parts for piece in _apart(part) if piece]


_SIGN = re.compile(r"\$?\s*&?\s*(?<![<>=!:])=(?!=)")
_IN_BRACKETS = re.compile(
    rf"(?P<dollar>\$?)\s*[(（\[]\s*(?P<words>[{LATIN}{CHINESE}'’ .,-]{{2,60}})[)）\]]"
    r"[\s,;:，；：]*$"
)
_BEFORE = re.compile(
    rf"(?P<dollar>\$?)[\s,;.，；。]*(?P<words>(?:[{CHINESE}]+|(?<![{LATIN}\w\\])[{LATIN}][{LATIN}.'’-]*)"
    rf"(?:[\s,，]+[{LATIN}][{LATIN}.'’-]*|[\s,，]*[{CHINESE}]+)*)[\s,:，：]*$"
)
_SIDES_AT_MOST, _NEAR = 40, 120
"""Signs of equality of a text with words between them; letters of these at most."""
_OTHERWISE = re.compile(r"deriv|differen|ableit|abgeleitet|导|微分|求偏", re.IGNORECASE)
"""What makes another quantity of it."""


def _joined(text: str) -> str:
    """The text without what stands between two sides of one equation: ``= a (Steiner) = b``."""
    signs = [*_SIGN.finditer(text)]
    for sign in reversed(signs if len(signs) <= _SIDES_AT_MOST else []):
        front = text[: sign.start()]
        near = max(0, len(front) - _NEAR)
        found = _IN_BRACKETS.search(front, near) or _BEFORE.search(front, near)
        if found is None or not _ends_formula(front[: found.start()].rstrip("$ ")):
            continue
        words = re.findall(rf"[{LATIN}][{LATIN}.'’-]*|[{CHINESE}]+", found["words"])
        said = all(map(_is_said if found.re is _IN_BRACKETS else is_linking, words))
        if words and said and not _OTHERWISE.search(found["words"]):
            dollars = found["dollar"] + ("$" if sign[0].startswith("$") else "")
            rest = text[sign.start() :].lstrip("$") if dollars else text[sign.start() :]
            text = f"{front[: found.start()]}{'$' if dollars == '$' else ''} {rest}"
    return text


def _with_the_last(text: str) -> str:
    """The text with a sign of equality for words in front of its last formula: ``a, or b``."""
    words = [x for x in _WORD.finditer(text) if is_word(x[0], text, x)]
    if "=" not in text or not words or len(words) > _MOST:
        return text
    run = [words[-1]]
    for one in reversed(words[:-1]):
        if text[one.end() : run[0].start()].strip(" ,，\n"):
            break
        run = [one, *run]
    while run and not is_linking(run[0][0]):
        run = run[1:]
    front = text[: run[0].start()].rstrip(" ,;，；:：\n") if run else ""
    rest = text[words[-1].end() :].strip(" .。,，:：\n")
    plain = front.rstrip("$ ")
    side = "=" not in rest and _A_SUM.search(rest) and not MATHS.search(rest.strip("$"))
    linked = run and not _OF_A_REASON.search(run[-1][0]) and all(is_linking(x[0]) for x in run)
    if not side or not linked or not _ends_formula(plain) or plain.endswith("("):
        return text
    front, given = _without_what_is_given(front, rest)
    if front.endswith("$") and rest.startswith("$"):
        return f"{front.rstrip('$ ')} = {rest.lstrip('$')}{given}"
    return f"{front} = {rest}{given}" if "$" not in front[-1:] + rest[:1] else text


def _without_what_is_given(front: str, rest: str) -> tuple[str, str]:
    """What the last formula goes on with: ``C11 = -h*qd2`` of ``C11 = -h*qd2 with h = ..., i.e.``;
    and what is explained behind it, where that has not all the names of the last formula.
    """
    found = next(reversed([*_GIVEN.finditer(front)]), None)
    if found is None or "=" not in front[: found.start()]:
        return front, ""
    main, given = front[: found.start()].rstrip(" ,;，；"), front[found.end() :]
    names = {*_A_NAME.findall(rest)}
    here, there = ({*_A_NAME.findall(one)} for one in (given, main))
    more = names - here
    of_the_last = more & there or any(_A_RATE.match(one) for one in more)
    return (main, f" where {given}") if of_the_last else (front, "")


_GIVEN = re.compile(
    r"(?:[,;，；]?\s*(?:(?<!\w)(?:with|where|mit|wobei|avec|où|con)\s+|其中\s*)|[,;，；]\s*)"
    r"(?=\$?\\?[A-Za-z]\w{0,5}\s*=)"
)
_A_RATE = re.compile(r"qd|thd|thetad|\\dot|dq|d?dth|omega")
_A_NAME = re.compile(r"\\?[A-Za-zα-ω]+_?\{?\w*\}?")


_THAT_IS = re.compile(r"\b(?:i\.\s?e|d\.\s?h)\.(?=[\s,$])", re.IGNORECASE)
_OF_A_REASON = re.compile(
    r"^(?:by|using|with|since|because|from|the|axis|parallel|theorem|terms|steiner|law|mit|nach|von|dem|satz)$"
    r"|(?:由|根据|利用|用|轴|定理|代入|项)$",
    re.IGNORECASE,
)
"""A last word that has a reason behind it, and no other side."""
_A_SUM = re.compile(r"[A-Za-zα-ω][^,;]{0,200}[+*/^·−-]|\\[a-z]+")
"""A formula with names, and signs between them."""


def _is_said(word: str) -> bool:
    """Whether letters in brackets, or in front of a sign of equality, are a word and no name."""
    if not re.fullmatch(rf"[{LATIN}{CHINESE}'’.-]+", word) or is_program(word):
        return False
    return "\u4e00" <= word[0] <= "\u9fff" or is_listed(word) or len(word) >= _LONG


def _opened(found: re.Match[str], text: str) -> str:
    """Words in a font of their own as words; what stands in a brace, or is a unit, as it is."""
    front = text[: found.start()]
    inside = front.count("{") != front.count("}")
    words = any(is_word(one[0], found[1], one) for one in _WORD.finditer(found[1]))
    return f" {found[1]} " if words and not inside else found[0]


def _marked(text: str) -> str:
    """The text with a mark in each word's place."""
    text = _DOTTED.sub(_GAP, text)
    maths = [found.span() for found in MATHS.finditer(text)]
    out, last = [], 0
    for found in _WORD.finditer(text):
        if any(start <= found.start() < end for start, end in maths):
            continue
        if is_word(found[0], text, found):
            out += [text[last : found.start()], _GAP]
            last = found.end()
    text = "".join([*out, text[last:]])
    if _GAP not in text:
        return text
    for _again in range(_SHORT):
        text = _BETWEEN.sub(_GAP, text)
    return _BRACKETS.sub(_GAP, text)


def is_word(word: str, text: str, found: re.Match[str]) -> bool:
    """Whether letters are a word of a sentence, and no name in a formula.

    Args:
        word: the letters.
        text: what they stand in.
        found: where.
    """
    if "\u4e00" <= word[0] <= "\u9fff":
        return word not in ("常数", "常量")
    if "\u0400" <= word[0] <= "\u04ff":
        return True  # no formula has names like these
    front, behind = text[: found.start()].rstrip(" "), text[found.end() :]
    listed = is_listed(word)
    if is_program(word) or re.match(r"\s*&?\s*:?=", behind):
        return False
    if _OF_A_WRENCH.fullmatch(word) and _ends_formula(front):
        return False  # - c12 My, where ...
    dash = front.endswith("--")
    if (front[-1:] in ("*", "^", "+", "-", "=") and not dash) or (
        front[-1:] == "/" and front[-2:] != "//"
    ):
        return False
    if re.search(r"[\w*/^]\($", front) or re.match(r"\s?(?:[*/^](?![*/])|\+)", behind):
        return False
    if re.match(r"\s?-", behind) and not listed:
        return False
    if word.lower() == "in" and _UNIT.match(behind):
        return False
    if re.search(rf"(?<![\w.]){re.escape(word)}\s*:?=(?!=)", text):
        return False
    if not listed and not front.endswith("\n") and _ends_formula(front):
        return False  # l2*c12 friction
    if _AND.fullmatch(word) and _ends_formula(front):
        after = _WORD.search(behind)
        return bool("=" in behind or (after and is_listed(after[0])))
    return listed or len(word) >= _LONG


def _ends_formula(front: str) -> bool:
    """Whether a formula ends here, with no sign and no word behind it."""
    formula = front.rpartition("=")[2].rstrip(" (")
    return bool("=" in front and _OPEN_END.search(formula) and not _LETTERS.search(formula))


def _apart(part: str) -> list[str]:
    """A piece without words, cut where a sentence, a label or a line ends."""
    pieces = []
    for one in re.split(
        r"(?<=[\w)}\]²])\.\s+(?=[\\A-Za-z$(=])|:\s+(?=\S)|(?<=\S)\s*(?:=>|-->|⇒|\\Rightarrow)\s*",
        part,
    ):
        pieces += [_trimmed(piece) for piece in _enumerated(one)]
    return pieces


def _enumerated(text: str) -> list[str]:
    """``2, tau2 = ...`` as two: a comma in front of the sign of equality and none behind it."""
    front, sign, behind = text.partition("=")
    if not sign:
        return [text]
    *before, last = parts_at(front, ",;")
    return [*before, f"{last}{sign}{behind}"]


def _trimmed(piece: str) -> str:
    piece = _FRONT.sub("", _LABEL.sub("", piece.strip(_EDGES)))
    piece = _BACK.sub("", _LABEL.sub("", piece))
    while piece.endswith("(") or (piece.count("(") > piece.count(")") and piece.endswith("(")):
        piece = piece[:-1].rstrip(_EDGES)
    if piece.count(")") > piece.count("(") and piece.endswith(")"):
        piece = piece[:-1]
    return piece.strip(" \t\r\n,;:")


def _bare(piece: str) -> str:
    return (
        re.sub(r"\\[()\[\]]|\$", " ", piece).strip(" \t\r\n,;:")
        if "$" in piece or r"\(" in piece or r"\[" in piece
        else piece
    )


def _of_entry(pieces: list[str], entry: str) -> list[str]:
    """The entry's equation behind those that explain its names; none where it is not sure."""
    pieces = [piece.removeprefix("=").strip() for piece in pieces]
    equations = [one for piece in pieces for one in _equations(piece) if _is_equation(one)]
    mine = [one for one in equations if begins_with(_ALIGNED.sub("", one).strip(), entry)]
    if any(_gives_behind_words(one, entry) for one in equations if one not in mine):
        return []
    formulas = [one for one in pieces if "=" not in one and _OPERATOR.search(one)]
    if not mine:  # by another of its names
        named = [one for one in equations if is_name_of(one.partition("=")[0], entry)]
        named = [one for one in named if not explains_another(one, equations)]
        mine = named if len(named) == 1 else []
    if not mine:  # a formula without its name, or by another
        given = {_plain(one.partition("=")[0]) for one in equations}
        formulas = [one for one in formulas if len(one) > _SHORT]
        formulas = formulas or [one for one in pieces[:1] if _plain(one) in given]
        last = [one for one in equations if not explains_another(one, equations)]
        said = [one for one in last if not _explains(one, formulas)]
        if said and all(len(one) < min(map(len, said)) for one in formulas):
            formulas = []  # a sum that a sentence speaks of
        mine = formulas or last or [one for one in pieces if "=" in one]
    if len(mine) > 1:  # "L = T - V" says what it is, and the next line what it comes to
        mine = [one for one in mine if not says_what_it_is(one.partition("=")[2])] or mine
        mine = [one for one in mine if not is_name(one.partition("=")[2])] or mine  # d12 = d21
    if len({_plain(one) for one in mine}) != 1:
        return []
    kept = [mine[0]]
    others = [one for one in equations if one is not mine[0]]
    left, sign, right = mine[0].partition("=")
    used = _plain(right if sign else left)
    while more := [one for one in others if _plain(one.partition("=")[0]) in used]:
        kept = [*more, *kept]
        used += _plain(" ".join(one.partition("=")[2] for one in more))
        others = [one for one in others if not any(one is known for known in more)]
    return kept


def _gives_behind_words(equation: str, entry: str) -> bool:
    """Whether an equation gives the entry behind words that were not taken out: ``this M22 =``."""
    words = equation.partition("=")[0].split()
    return len(words) > 1 and begins_with(f"{words[-1]} = 0", entry)


def _explains(equation: str, formulas: list[str]) -> bool:
    """Whether an equation gives a name that stands in one of the formulas."""
    name = _plain(equation.partition("=")[0])
    return any(name in _plain(one) for one in formulas)


def _equations(piece: str) -> list[str]:
    if _ALIGNED.search(piece):
        return [piece]
    parts = parts_at(piece, ";")
    return [x for one in parts for x in _NEXT_LINE.split(one) if x.strip()]


def _is_equation(text: str) -> bool:
    found = _SIDES.match(_ALIGNED.sub("", text).strip())
    named = found is not None and _NAME.fullmatch(found["left"]) and found["right"].strip()
    return bool(named) and not is_condition(text)


def _plain(text: str) -> str:
    return _SIGNS.sub("", text)
