"""Words around a formula: ``末端的 x 坐标为 $x = ...$``, ``where q1 is the angle of joint 1``.

Words in front are left out. Of what is said behind, equations are kept, and words that only say
what a name is anyway are left out; what may change a name's meaning is refused.
"""

from __future__ import annotations

import re

from kinlab.errors import ExpressionError
from kinlab.formulas.signs.brackets import parts_at
from kinlab.formulas.signs.refusals import refused
from kinlab.formulas.typed import entry_name, of_one_name
from kinlab.host.language import N_

_CHINESE = "\u4e00-\u9fff"
_ANY_CHINESE = re.compile(f"[{_CHINESE}]")
_NAME = r"[\\A-Za-zα-ωΑ-Ω∂{][\\\w{}()\[\], ̇̈₀-₉'/]*"
_FRONT = re.compile(
    rf"^(?P<words>[^-+*/^\\=\n]*[{_CHINESE}][^-+*/^\\=\n]*?[\s:,]*)(?P<name>(?:{_NAME})?)\s*(?P<sign>&?:?=)"
)
_COLON = re.compile(rf"^[^-+*/^\\=:\n]*[{_CHINESE}][^-+*/^\\=:\n]*:\s*(?=\S)")
_LATIN = re.compile(
    r"^(?P<words>(?:[A-Za-zÄÖÜäöüß]+[,:]?\s+){1,9})(?P<name>[\\A-Za-zα-ω][\\\w{}₀-₉()]*)\s*(?P<sign>&?:?=)"
)
_HEAD = re.compile(r"^(?P<head>[A-Za-zÄÖÜäöüß][\w äöüß]{0,40}?)\s*:(?![=:])\s*(?=\S)")
_LONG = re.compile(r"[A-Za-zÄÖÜäöüß]{4}")
_FUNCTIONS = re.compile(r"\b(?:sin|cos|tan|sqrt|exp|log|atan2|lambda|def|return)\b")
_DOLLARS = re.compile(r"(\$\$?)([^$]+)\1")
_NO_WORDS = re.compile(r"[=+*/^\\<>_]|\d[a-z]")
_INLINE = re.compile(rf"[{_CHINESE}]|\b(?!where\b|with\b|and\b)[A-Za-z]{{3,}}")
_WORD_FONT = re.compile(r"\\(?:text|textrm|mbox|mathrm|textnormal)\s*\{([^{}]*)\}")
_WHERE = re.compile(
    r"(?:[,;.]\s*|\s+|\\q?quad\s*|(?<=[)\]}\w]))(?:\\text\s*\{[\s,]*)?"
    r"(?:\bwhere\b|\bin which\b|\bwobei\b|\bdabei\s+(?:ist|sind|gilt)\b|\bhierbei\s+(?:ist|sind)\b"
    r"|\bhere\b|(?<![\\A-Za-z])(?:mit|with)\b(?=\s|\})|其中|式中|这里)[\s:,]*(?:\})?"
)
_AND_SO_ON = re.compile(r"[\s,]*(?:\betc\b\.?|\busw\b\.?|等等?[.]?)\s*$")
_NEXT_NAME = re.compile(r"([\\A-Za-zα-ω][\\\w{}₀-₉ ]{0,14}?)\s*(:?=.*)$", re.DOTALL)
_MEANS = re.compile(
    r"^(.{1,20}?)\s+(?:denotes|means|stands for|is short for|steht für|表示)\s+(.*)$"
)
_WORDS = """
    the a an of is are be and respectively joint joints first second third angle angles link links
    length lengths mass masses gravity acceleration gravitational variables variable der die das des
    den dem ist sind und ersten zweiten dritten gelenks gelenk gelenke winkel gelenkwinkel länge
    längen masse massen glied glieds glieder gliedes erdbeschleunigung jeweils bzw in m kg rad arm
    arms robot constant
"""
_HARMLESS = {*_WORDS.split()}
_HARMLESS_CHINESE = re.compile(
    "(?:为|是|即|分别|表示|各|第|一|二|三|两|个|连杆|杆件|杆|长度|长|质量|关节角度|关节角|关节变量|关节|"
    "角度|转角|角|重力加速度|重力|加速度|的|和|与|及|机械臂|机器人)+"
)
_AN_ANGLE = re.compile(r"\bangles?\b|winkel|角", re.IGNORECASE)
_A_LINK = re.compile(r"\blinks?\b|\bglied|连杆|杆", re.IGNORECASE)
_A_JOINT = re.compile(r"\bjoints?\b|gelenk|关节", re.IGNORECASE)
_A_STATE = re.compile(r"(?:d{1,2}ot)?(?:q|th|theta|θ|ϑ)_?\d*")
"""What an equation sets that tells of a state: ``q_1 = 0``."""
_BARE = re.compile(r"[-\s]*(?:\\?[A-Za-z]+(?:\d{1,2}|_\s*(?:\w|\{\w{1,3}\}))?|[\d.]+)[\s.,]*")
"""A right side that says what is alike, and works nothing out: ``l_1 = l_2``."""
_NAMES = re.compile(r"(?:\\?[A-Za-zα-ω]\w{0,6}(?:_?\{\w{1,4}\}|[₀-₉]{1,2})?(?![A-Za-z])|\d+)")
_EXPLAINS = re.compile(
    r"其中|式中|这里|竖直|铅垂|水平|夹角|绝对|相对|量起|角度制"
    r"|(?:\\?\b(?:theta|th|q)|[θϑ])_?\{?[\d₀-₉]+\}?\s*(?:为|是|表示|is\b|are\b|denotes\b|means\b)"
    r"|\b(?:measured|absolute|relative|vertical|horizontal|degrees?|gemessen|absolute[rn]?|senkrecht"
    r"|waagerecht|grad|not|nicht|unless|only|nur|if|falls|wenn|assum\w+|wrong|falsch)\b"
    r"|不是|错|如果|假设|仅|只有",
    re.IGNORECASE,
)
"""Words in front that may say what a name means: the angle from the vertical."""
_KNOWN = re.compile(r"\\?(?:theta|th|q|l|L|m|g|I|alpha|beta)(?:_?\{?\w{0,2}\}?|[₀-₉]{1,2})")


def without_words(text: str, entry: str, place: str) -> str:
    """The text without the words around the formula.

    Args:
        text: as typed.
        entry: what the formula is asked for.
        place: what to put in front of a message.

    Raises:
        ExpressionError: words that may change what a name means.
    """
    text, typeset = _inline(text)
    front, mark, tail = _cut(text)
    front = "\n".join(_without_front(line, entry, place) for line in front.split("\n"))
    said = _kept(tail, place) if mark else None
    if said is not None:
        text = f"{front}, where {said}" if said else front
        text = text.replace(", where ", r" \text{where} ") if "\\" in text else text
    else:
        text = front + mark + tail
    return f"${text.strip()}$" if typeset and "$" not in text else text


def _inline(text: str) -> tuple[str, bool]:
    """A sentence with formulas between dollars without these; and whether it was one."""
    if "$" not in text:
        return text, False
    outside = _DOLLARS.sub(" ", text)
    if "$" in outside or _NO_WORDS.search(outside):
        return text, False
    equations = [found[2].strip() for found in _DOLLARS.finditer(text) if "=" in found[2]]
    left = [re.sub(r"[\s{}\\&]", "", one.partition("=")[0]) for one in equations]
    told = not _EXPLAINS.search(outside) and not any(map(_A_STATE.fullmatch, left))
    told = told and not any(_BARE.fullmatch(one.partition("=")[2]) for one in equations[:-1])
    if len(equations) > 1 and len({*left}) == len(left) and told:
        return "\n".join(equations), True
    if not _INLINE.search(outside):
        return text, False
    ends = _DOLLARS.sub("\0", text).rpartition("\0")[2].strip(" \n.;。")
    if len(equations) == 1 and told and not ends:  # words in front of it alone
        return equations[0], True
    return _DOLLARS.sub(lambda found: f" {found[2]} ", text).strip(), True


def _cut(text: str) -> tuple[str, str, str]:
    """The text before the first word that explains, that word, and what it explains."""
    found = _WHERE.search(text)
    return (text[: found.start()], found[0], text[found.end() :]) if found else (text, "", "")


# -------- In front


def _without_front(line: str, entry: str, place: str) -> str:
    front = line.partition("=")[0]
    if _EXPLAINS.search(front):
        said = N_("{words!r} in front of the formula may change what its names mean; leave it out")
        raise refused(place, said, words=front.strip()[:60])
    given = line
    plain = line.lstrip("$ \t")
    dollars = line[: len(line) - len(plain)].strip()
    line = plain
    found = _FRONT.match(plain)
    if found:
        if found["name"].strip():
            return f"{dollars}{found['name']}{plain[found.start('sign') :]}"
        name = _ANY_CHINESE.sub("", found["words"]).strip(" :,")
        behind = plain[found.end() :]
        if _is_name(name, entry):
            return f"{dollars}{name} ={behind}"
        return given if name else f"{dollars}{behind}"
    if "=" not in plain:
        plain = _COLON.sub("", plain)
    found = _LATIN.match(plain)
    if found and _LONG.search(found["words"]) and not _FUNCTIONS.search(found["words"]):
        if _is_name(found["name"], entry):
            plain = plain[found.start("name") :]
        return f"{dollars}{plain}"
    found = _HEAD.match(plain)
    if found and not _FUNCTIONS.search(found["head"]):
        head, rest = found["head"].strip(), plain[found.end() :]
        if " " not in head and "=" not in rest and _is_name(head, entry):
            plain = f"{head} = {rest}"
        elif _LONG.search(head) or _is_name(head, entry):
            plain = rest
    return given if plain == line else f"{dollars}{plain}"


def _is_name(text: str, entry: str) -> bool:
    """Whether a word is the entry's name: x of x, tau_2 of tau2."""
    try:
        name = entry_name(text)
        known = of_one_name(name, entry_name(entry))
    except ExpressionError:
        return False
    return known and (name[:1] == entry[:1] or len(name.rstrip("0123456789_")) <= 3)


# -------- Behind


def _kept(tail: str, place: str) -> str | None:
    """The equations of what is explained; None where nothing but equations stands there.

    Raises:
        ExpressionError: words that may change a meaning.
    """
    plain = _AND_SO_ON.sub("", _WORD_FONT.sub(r" \1 ", tail.replace("、", ", ")).rstrip("$ .;}"))
    pieces = [one for part in parts_at(plain.replace("\n", ";"), ",;") for one in _apart(part)]
    pieces = [piece.strip() for piece in pieces if piece.strip()]
    if pieces and all("=" in piece and not _spoken(piece) for piece in pieces):
        return None if plain == tail.rstrip("$ .;}") else ", ".join(pieces)
    kept = []
    words = []
    for piece in pieces:
        means = _MEANS.match(piece)
        if "=" in piece:
            found = _NEXT_NAME.search(piece)
            kept.append(f"{found[1]} {found[2]}".strip() if found else piece)
            words.append(piece[: found.start()] if found else "")
        elif means and re.search(r"[-+*/(^]", means[2]):
            kept.append(f"{means[1]} = {means[2]}")
        else:
            words.append(piece)
    said = " ".join(words)
    if not _harmless(said):
        raise refused(
            place,
            N_(
                "{words!r} behind the formula may change what its names mean; leave it out, or "
                "write name = formula"
            ),
            words=said.strip()[:60],
        )
    return ", ".join(kept)


def _apart(part: str) -> list[str]:
    return re.split(r"\s(?:and|und)\s|[和且](?=\s*\S{1,12}\s*=)", part)


def _spoken(piece: str) -> bool:
    """Whether there are words in front of an equation's name."""
    return bool(re.search(r"[A-Za-zäöü]{2,}\s+\S+\s*=", piece) or _ANY_CHINESE.search(piece))


def _harmless(said: str) -> bool:
    """Whether words say of names only what these are anyway."""
    if _AN_ANGLE.search(said) and _A_LINK.search(said) and not _A_JOINT.search(said):
        return False  # the angle of link 2 may be a sum
    for word in re.findall(rf"[{_CHINESE}]+|[^\s{_CHINESE}]+", said):
        if _ANY_CHINESE.search(word):
            if not _HARMLESS_CHINESE.fullmatch(word):
                return False
        elif word.lower().strip(".:") not in _HARMLESS | {""} and not (
            _KNOWN.fullmatch(word) or word.isdigit()
        ):
            return False
    return True
