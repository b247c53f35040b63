"""Which words beside a formula may change what it claims: ``in the upright pose``, ``elbow``.

Whether such words change anything is not known. A formula beside them that holds at every state
is right all the same; one that does not is not judged.
"""

from __future__ import annotations

import re
from collections.abc import Iterable, Iterator
from dataclasses import dataclass
from functools import lru_cache

from kinlab.formulas.language.vocabulary import (
    BEHIND,
    CHINESE,
    LATIN,
    STEPS,
    chinese_left,
    leads_over,
    says_nothing,
)
from kinlab.formulas.typed import begins_with

_FONT = re.compile(r"\\(?:text|textrm|textit|textbf|mbox|textnormal|mathrm|rm|hbox)\s*\{([^{}]*)\}")
_BELOW = re.compile(rf"_\s*(?:\{{[^{{}}]*(?:\{{[^{{}}]*\}})?[^{{}}]*\}}|[{LATIN}]+|\w)")
_NAMES_BELOW = re.compile(
    r"(?<![A-Za-z])(?:[vw][xyz]|com|cog|cm|cg|tcp|ee|lin|rot|ang|pos|vec|mat|sym)(?![a-z])"
)
"""What stands below a name and says of what it is, as its places do."""
_AROUND = re.compile(r"\\(?:begin|end|label|tag|ref|color|textcolor|operatorname)\*?\s*\{[^{}]*\}")
_COMMAND = re.compile(r"\\(?:[A-Za-z]+\*?|.)")
MATHS = re.compile(r"\$\$[^$]*\$\$|\$[^$]*\$|\\\(.*?\\\)|\\\[.*?\\\]", re.DOTALL)
"""Formulas in LaTeX between signs that say so."""
_WHERE = re.compile(
    r"\b(?:where|in which|(?:with|mit)(?!\s+(?:respect|bezug))|wobei|dabei|hierbei|here)\b"
    r"|其中|式中|这里",
    re.IGNORECASE,
)


def _words(least: int) -> re.Pattern[str]:
    beside = rf"(?<![\w.{{\[*/^+])(?P<latin>[{LATIN}]{{{least},}}(?:['’-][{LATIN}]{{2,}})*)"
    latin = rf"{beside}(?![\w(\[*/^+]|\s*&?\s*:?=)"
    return re.compile(rf"{latin}|(?P<chinese>[{CHINESE}]+)")


_WORDS = {typeset: _words(least) for typeset, least in ((False, 2), (True, 4))}
"""In LaTeX a few letters side by side are a product."""
_PHRASE = re.compile(rf"[{LATIN}{CHINESE}\d'’ ,.;:-]*")
_SIGNS_IN = ("*", "/", "^", "+", "=", "(", ")", "}", "]")
_ENDING = re.compile(rf"^(?:\d+[.,]\d+|[{LATIN}]*\d\w*|\w)[ ,.;:-]+(?=\S)")
"""The last name of a formula, in front of words."""
_FRAME = re.compile(
    r"\bpart \(?[a-h1-9]\b"
    r"|\b(?:base|world|inertial|fixed|reference)[ -](?:frame|system|coordinates?)\b"
    r"|\bsi\s+(?:ha|ottiene|trova|ricava)\b|\b(?:since|because|as)\s+only\b|\b(?:da|weil)\s+nur\b"
    r"|\b(?:basis|welt|inertial)(?:koordinaten)?system\b|基坐标系|世界坐标系|固定坐标系",
    re.IGNORECASE,
)
_ORDER = {"first": 1, "second": 2, "third": 3, "fourth": 4}
_ORDER |= {"erste": 1, "zweite": 2, "dritte": 3, "vierte": 4}
_ORDER |= {"ersten": 1, "zweiten": 2, "dritten": 3, "vierten": 4}
_ROMANCE = (
    ("primer primera primero premier première primo prima", 1),
    ("segundo segunda deuxième seconde secondo seconda", 2),
    ("tercer tercera tercero troisième terzo terza", 3),
    ("cuarto cuarta quatrième quarto quarta", 4),
)
_ORDER |= {word: k for words, k in _ROMANCE for word in words.split()}
_ORDER |= {"一": 1, "二": 2, "三": 3, "四": 4}
_PART = re.compile(
    r"(?:\b(?P<order>first|second|third|fourth|ersten?|zweiten?|dritten?|vierten?"
    rf"|{'|'.join(words.replace(' ', '|') for words, _k in _ROMANCE)})\s+)?"
    r"\b(?:joints?|links?|axis|axes|motors?|actuators?|bod(?:y|ies)|gelenks?|achsen?|glied(?:e?s)?|legs?|arms?|rods?"
    r"|articulaci[oó]n(?:es)?|articulations?|eslab[oó]n(?:es)?|giunt[oi]|liaisons?|segments?)\b"
    r"(?:\s*(?:no\.?|nr\.?|number|#)?\s*(?P<number>[1-9]))?"
    r"|(?:第(?P<chinese>[一二三四1-9])个?)?(?:关节|连杆|杆|支链|杆件|轴)(?P<behind>[1-9])?",
    re.IGNORECASE,
)
_SUBJECT = re.compile(
    r"\W*(?:the\s+|das\s+)?(?:joint\s+|driving\s+|motor\s+)?"
    r"(?:torque|moment|drehmoment|gelenkmoment|antriebsmoment)\s+"
    r"(?:of|at|for|in|on|des|am|im|an)\s+(?:the\s+|der\s+)?",
    re.IGNORECASE,
)
"""What begins a text that says whose torque it gives."""
_SAID_TO_BE = re.compile(
    rf"\b(?:this|that|it|das|dies)\s+(?:is|ist)\b{_SUBJECT.pattern}", re.IGNORECASE
)
"""The same behind a formula: ``This is the torque of joint 1``."""
_AXIS = re.compile(r"achsen?\b", re.IGNORECASE)
_ORDINAL = re.compile("第[一二三四1-9]轴")
"""A joint, where a number says which."""
_MOST = 60
_CONDITION = re.compile(
    r"(?<![\w*/+-])(?<!partial )(?<!partial)(?<!∂)"
    r"(?:(?:theta|vartheta|θ|ϑ|th|q)[d']{0,2}[1-9₁-₉]?\s*:?=\s*(?:[-±]?\s*(?:\d|π|pi\b))"
    r"|[lmI]c?[1-9]\s*=\s*0(?![\w.])"
    r"|(?P<letter>[lLmI])[1-9]\s*=\s*(?P=letter)[1-9](?![\w*/+-]|\s*[*/^+-]))"
)
_WORKED_OUT = re.compile(
    r"[\d./]*\s*(?:\\?(?:arc|a?tan|a?cos|a?sin|sqrt|operatorname|[dt]?frac|left)|[*(^]"
    r"|[lmI]c?\d|(?:theta|θ|q)(?!\s*[d'1-9₁-₉]*\s*=))"
)
"""What goes on behind a number as a formula: ``theta = 2 arctan ...``."""
_IN_CHAIN = re.compile(
    r"=(?:[^,;，；。:=\nA-Za-z]|(?<!\d)\."
    r"|(?<![A-Za-z])(?:(?:sin|cos|tan|sqrt|pi|[dt]?frac|partial|left|right|cdot){1,4}|[A-Za-z])"
    r"(?![A-Za-z])){1,400}$"
)
"""What stands between two signs of equality of a chain: no word, and nothing that ends it."""
_OPERATION = re.compile(r"[-+*/^(\d]|sin|cos")
_ALONE = re.compile(r"[\d.]*°?(?:\s*/\s*\d+)?\s*(?:$|[,;，；\n)])")
"""What ends a number."""
_INERTIA = re.compile(
    r"\b(?:mass\s+)?(?:moments?\s+of\s+)?inertias?\b(?:[^,;=]*\b(?:cent(?:re|er)s?|of|mass(?:es)?|gravity|centroids?)\b)?"
    r"|\b(?:massen)?trägheitsmomente?\b(?:[^,;=]*\bschwerpunkte?[sn]?\b)?|(?:绕|对|关于)?质心的?转动惯量|转动惯量",
    re.IGNORECASE,
)
_TURNED = re.compile(
    r"\bax[ei]s\b|achse|\b(?:frame|system|origin|convention|pointing|points?|downwards?|upwards?"
    r"|(?:counter-?|anti-?)?clockwise|direction|sense|opposite|mirror\w*|revers\w*|negative|positive"
    r"|count\w*|reckon\w*|tak(?:e|ing|en)\s+from|seen\s+from|relativ\w*|nullage|zero\s+pos\w+|uhrzeiger\w*"
    r"|richtung|nach\s+(?:unten|oben)|bezug\w*|koordinatensystem\w*|aus\s+(?:gez|gem)\w*)\b"
    r"|朝|轴|坐标系|方向|顺时针|逆时针|正向|负|反向|原点|零位",
    re.IGNORECASE,
)
"""Words that may tell of another axis, frame or sense of turning."""
_UP_TO = re.compile(
    r"\bup to (?:the |a |an |its )?(?:\w+ )?constant\w*"
    r"|\bbis auf (?:die |eine )?(?:\w+ )?konstante\w*|(?:相差|差|除了|除)一?个?常数",
    re.IGNORECASE,
)
_ELSEWHERE = re.compile(
    r"\b(?:I[a-z]{0,2}_?\d|I(?=\s(?:is|being|denotes|means|stands)\b)|inertias?)\b[^.;=]{0,40}?"
    r"\b(?:about|around|at) (?:the |its |their )?"
    r"(?:(?:first|second|third|fourth|axis of|axes of|own) (?:the )?)*"
    r"(?:joints?|pivots?|hinges?|ends?|axes|axis of rotation)\b"
    r"|\b(?:I_?\d|I(?=\s(?:das|ist|bezeichnet)\b)|trägheitsmomente?s?)\b[^.;=]{0,40}?"
    r"\b(?:um|bezüglich|bezogen auf)"
    r" (?:das |des |den |die |der |dem )?(?:gelenke?s?|drehpunkte?s?|drehachse|lagers?|endes?)\b"
    r"|(?:I_?\d|转动惯量)[^。；=]{0,20}?(?:绕|对|关于)(?:关节|铰链?|转轴|端点|端部)"
    r"|(?:绕|对|关于)(?:关节|铰链?|转轴|端点|端部)的?转动惯量",
    re.IGNORECASE,
)
"""Moments of inertia about another point than the robot's are."""
_NOT = re.compile(r"\bnot\b|\bnicht\b|不|非", re.IGNORECASE)
_OTHER_FRAME = re.compile(
    r"\b(?:in|into|with respect to|relative to) (?:the |its |their )?"
    r"(?:tool|hand|end-?effector|tcp|body|link|moving|local|own)(?:'s)?[ -]"
    r"(?:fixed )?(?:frames?|systems?|coordinates?|axes)\b"
    r"|\b(?:im|ins|bezüglich des) (?:werkzeug|tcp|körper|end-?effektor|greifer)-?(?:fest\w+ )?"
    r"(?:koordinaten)?systems?\b|(?:工具|末端|手爪|本体|连杆)坐标系",
    re.IGNORECASE,
)
"""Axes in which an entry's numbers are others, but for those of the tool's own."""
_IN_THE_BASE = re.compile(r"J|(?:planar_)?jacobian(?!_tool|_dot|_det)|fk|[xyzp](?![A-Za-z])")
"""Entries whose axes are the base's."""
_OTHER_AXES = (
    _OTHER_FRAME,
    re.compile(
        r"\b(?:expressed|given|written|resolved)\s+in\s+(?:the\s+)?(?:frame|axes\s+of\s+link)\s*[1-9]\b"
        r"|\bin\s+frame\s+[1-9]\b|\bim\s+(?:koordinaten)?system\s+[1-9]\b|坐标系\s*[1-9]\s*(?:中|下|内)",
        re.IGNORECASE,
    ),
)
_TOOL = r"(?:end[ -]?effectors?|tool(?:[ -]?(?:tip|point|frame))?|tip|tcp|hand|gripper)"
_WHAT = r"(?:positions?|coordinates?|locations?|velocity|accelerations?|jacobians?)"
_WHICH = rf"\b{_WHAT}\s+(?:of|for)\s+(?:the\s+)?"
_OF_THE_TOOL = re.compile(
    rf"{_WHICH}{_TOOL}\b"
    rf"|\b{_TOOL}(?:'s)?\s+(?:position|coordinates?|location|velocity|acceleration|jacobian)\b"
    r"|\b(?:position|lage|ort|koordinaten?|geschwindigkeit|beschleunigung)\s+(?:des|der)\s+"
    r"(?:werkzeugs?|werkzeugspitze|end-?effektors?|tcp|spitze|greifers?)\b"
    r"|(?:末端(?:执行器)?|手爪|工具)的?(?:位置|坐标|速度|加速度)",
    re.IGNORECASE,
)
_OF_A_CENTRE = re.compile(
    rf"{_WHICH}(?:cent(?:re|er)s?\s+of\s+(?:mass|gravity)|com|cog)\b|质心的?(?:位置|坐标|速度)"
    r"|\b(?:position|lage|ort|koordinaten?|geschwindigkeit)\s+des\s+(?:massen)?schwerpunkt(?:e?s)?\b",
    re.IGNORECASE,
)
_OTHER_POINTS = {"com_": _OF_THE_TOOL}
_OTHER_POINTS |= dict.fromkeys(("fk", "jacobian", "planar_"), _OF_A_CENTRE)
"""Words of another point, by how entries begin."""
_SCALED = re.compile(
    r"\bin (?:mm|cm|dm|km|inch(?:es)?|feet|grams?|tonnes?|(?:milli|centi)met(?:re|er)s?"
    r"|(?:milli|zenti)metern?|gramm)\b|\bk?N\s?[·.*]?\s?(?:mm|cm)\b|\bkN\s?m?\b|毫米|厘米|英寸",
    re.IGNORECASE,
)
"""Units in which the robot's numbers are not."""
_SHARE = re.compile(
    r"\b(?:half|halves|twice|double[sd]?|third|quarter|total|full|whole|combined|of both"
    r"|together|zusammen|beider|halb\w*|hälfte|doppel\w*|gesamt\w*)\b"
    r"|半|两倍|二倍|之和|总",
    re.IGNORECASE,
)
"""Words of another size than the thing beside them."""
_OWN = re.compile(
    r"(?<![A-Za-z])(?:(?P<own>[lLadrmMI][1-9]|e(?=\s))(?!\w|\s*/)|(?:[lLrad]c|I[cC]|[rsc])[1-9])"
)
"""Names of a link's own sizes, and of what may well be a share of them: a centre's distance."""
_DISTANCE = re.compile(r"\bdistance|\babst[aä]nd|距离", re.IGNORECASE)
_CLAUSE = re.compile(r"[;,:=，。；：、]|\.(?!\d)")
_ANGLE = re.compile(r"\bangles?\b|winkel|角", re.IGNORECASE)
_LINK = re.compile(r"\blinks?\b|\bglied|连杆|杆", re.IGNORECASE)
_JOINT = re.compile(r"\bjoints?\b|gelenk|关节", re.IGNORECASE)


def doubtful(text: str, entry: str) -> list[tuple[str, str]]:
    """Words in a text that are in no list of what says nothing, each with the words around it.

    Args:
        text: as typed.
        entry: what the formula is asked for.
    """
    found = [("", clause) for clause in _shares(text)]
    begin = own_sentence(text, entry)
    for prose, typeset in _proses(text[:begin]):
        found += _of(_DOES_NOT.sub(" ", _FRAME.sub(" ", prose)), STEPS, typeset)
    for prose, typeset in _proses(text[begin:]):
        front, behind = _cut(_FRAME.sub(" ", prose))
        found += _of(front, entry, typeset) + _parts(front, entry)
        found += _of_names(behind, typeset, text)
    for prose in outside_formulas(text):
        frames = () if "tool" in entry else (_OTHER_FRAME,)
        for kind in (_UP_TO, _ELSEWHERE, _SCALED, *frames):
            found += [(one[0], around(prose, *one.span())) for one in kind.finditer(prose)]
    return found + _conditions(text)


def own_sentence(text: str, entry: str) -> int:
    """Where the sentence begins in which a derivation gives the entry last; 0 of what is none.

    Args:
        text: as typed.
        entry: what it is asked for.
    """
    last = max((found.start() for found in equations_of(text, entry)), default=0)
    ends = [found.end() for found in _SENTENCE_ENDS.finditer(text, 0, last)]
    while ends and not re.search(rf"=|[{LATIN}]{{2,}}|[{CHINESE}]", text[ends[-1] : last]):
        last = ends.pop()  # what leads over to the equation stands on a line above
    begin = ends[-1] if ends else 0
    return begin if "=" in text[:begin] else 0


def behind_the_first(text: str, entry: str) -> str:
    """What stands behind the name of the first equation that gives the entry; all of no such text.

    Args:
        text: as typed.
        entry: what it is asked for.
    """
    return text[min((found.end() for found in equations_of(text, entry)), default=0) :]


def equations_of(text: str, entry: str) -> list[re.Match[str]]:
    """Where equations for an entry begin, each with its name and its sign of equality.

    Args:
        text: as typed.
        entry: what it is asked for.
    """
    found = _LEFT_SIDE.finditer(text)
    return [one for one in found if begins_with(f"{one['name']} = 0", entry)]


_LEFT_SIDE = re.compile(
    rf"(?:^|(?<=[\s$&:：,，;；{CHINESE}]))"
    r"(?P<name>\\?[A-Za-zα-ωΑ-Ω][^\s=+*/^-]{0,24})\s?&?\s?:?=(?!=)"
)
_DOES_NOT = re.compile(
    r"\b(?:does|do)(?:\s+not|n['’]t)\s+(?:depend|contain|appear|matter|enter|vary|occur|contribute"
    r"|change|affect)\w*"
    r"|\bonly\s+(?:;\s*)?(?:appears?|occurs?|enters?|contributes?)\b"
    r"|\bonly\s+(?:the\s+)?(?:first|second|third|last)\s+(?:term|row|column|part)\b"
    r"|\b(?:appears?|depends?|occurs?|contains?|enters?)\s+only\b|\bhäng\w+\s+nicht\b|\bnicht\s+(?:von|ab)\b",
    re.IGNORECASE,
)
"""What other sentences say of a term, and not of when something holds."""
_SENTENCE_ENDS = re.compile(r"[。;；\n]|\.(?=\s)|\\\\")


def explained_by(text: str) -> str:
    """Words behind ``where`` that are in no list of what names mean anyway; mostly empty."""
    found = []
    shares = [("", clause) for clause in _shares(text, own=True)]
    for prose, typeset in _proses(text):
        _front, behind = _cut(prose)
        if behind:
            found += shares
            found += _of_names(behind, typeset, text)
            if _ANGLE.search(behind) and _LINK.search(behind) and not _JOINT.search(behind):
                found.append(("", behind.strip()[:_MOST]))  # the angle of link 2 may be a sum
            found += [("", clause) for clause in _to_elsewhere(flat(behind))]
    return found[0][1] if found else ""


def _of_names(behind: str, typeset: bool, text: str) -> list[tuple[str, str]]:
    """Words behind ``where`` that are in no list, but for names of the formula."""
    found = _of(_INERTIA.sub(" ", behind), BEHIND, typeset)
    return [one for one in found if not _used(one[0], text)]


def _to_elsewhere(text: str) -> list[str]:
    """Distances from a joint of another number than the name's own: ``xt`` from joint 2."""
    found = []
    for clause in _CLAUSE.split(text):
        name, far = re.search(r"[A-Za-z]\w*", clause), _DISTANCE.search(clause)
        numbers = {number for one in _PART.finditer(clause) if (number := one["number"])}
        if name and far and numbers and numbers.isdisjoint(re.findall(r"\d", name[0])):
            found.append(clause.strip()[:_MOST])
    return found


def _shares(text: str, own: bool = False) -> list[str]:
    """What makes a size of the robot's another one: ``l1 and l2 denote half the lengths``.

    Args:
        text: as typed.
        own: only of what is no share itself: ``lc1 is half of l1`` is true of a rod.
    """
    found = []
    for clause in _CLAUSE.split(_WHERE.sub(";", flat(text))):
        name = _OWN.search(clause)
        if name and (name["own"] or not own) and _SHARE.search(clause):
            found.append(clause.strip()[:_MOST])
    return found


def outside_formulas(text: str) -> list[str]:
    """The pieces of a text in which words may stand."""
    return [prose for prose, _typeset in _proses(text)]


def moment_elsewhere(text: str) -> str:
    """What says of a name in the formula that it is a moment of inertia about another point."""
    plain = flat(text)
    found = _ELSEWHERE.search(plain)
    name = re.match(r"I[a-z]{0,2}_?\d|I\b", found[0]) if found else None
    if found is None or name is None or _NOT.search(found[0]):
        return ""
    if len(re.findall(rf"(?<![A-Za-z]){re.escape(name[0])}(?![A-Za-z])", plain)) < 2:
        return ""
    return found[0][:_MOST]


def of_other_axes(text: str, entry: str) -> str:
    """What says that numbers of the base's axes are in others: ``J in the end-effector frame``."""
    if not _IN_THE_BASE.match(entry):
        return ""
    every = (*outside_formulas(text), flat(text))
    found = (said for prose in every for kind in _OTHER_AXES if (said := kind.search(prose)))
    return next((one[0].strip()[:_MOST] for one in found), "")


def of_another_point(text: str, entry: str) -> str:
    """What says that a centre of mass is the tool, or the tool one: ``position of the tip``."""
    own = next((said for begin, said in _OTHER_POINTS.items() if entry.startswith(begin)), None)
    found = own.search(flat(text)) if own else None
    return found[0].strip()[:_MOST] if found else ""


def of_another_part(text: str, entry: str) -> str:
    """What says first that it is of another joint: ``torque of the first joint`` of tau2."""
    plain, own = flat(text), {*re.findall(r"\d", _counted_from_1(entry))}
    begins = None if "=" in plain else _SUBJECT.match(plain)  # tau2 = ... says what it is
    begins = begins or _SAID_TO_BE.search(plain)
    found = _PART.match(plain, begins.end()) if begins and own else None
    number = _number_of(found) if found else ""
    return plain[: found.end()].strip()[:_MOST] if found and number and number not in own else ""


def _used(word: str, text: str) -> bool:
    """Whether a word is a name in the formula."""
    name = rf"(?<![A-Za-z]){re.escape(word)}(?![A-Za-z])"
    return bool(re.search(rf"\(\s*{name}\s*\)|{name}\s*[*/^+=]|[*/^+=-]\s*{name}", text))


def condition_in_front(text: str, entry: str) -> bool:
    """Whether an equation in front of the formula says when it holds: ``for q2 = 0``."""
    plain = flat(text)
    found = next(_conditions_in(plain), None)
    if found is None:
        return False
    front = plain[: found.start()]
    name = rf"(?<!\w){re.escape(flat(entry))}\s*="
    return not re.search(rf"[*^]|{name}", front) and _words_in(front)


def has_condition(text: str) -> bool:
    """Whether an equation in a text says when something holds: ``for q2 = 0: g2 = ...``."""
    return next(_conditions_in(flat(text)), None) is not None


def is_condition(equation: str) -> bool:
    """Whether an equation says when a formula holds, and no name's meaning: ``q2 = 0``."""
    found = next(_conditions_in(flat(equation).strip()), None)
    return found is not None and found.start() == 0


def _conditions(text: str) -> list[tuple[str, str]]:
    """Equations that say when a formula holds: ``q2 = 0``, ``l_1 = l_2``.

    Without words, only what nothing but a number is said of: no ``theta1 = 2*atan(...)``.
    """
    plain, words = flat(text), _words_in(text)
    found = _conditions_in(plain)
    return [(one[0], one[0]) for one in found if words or _ALONE.match(plain, one.end())]


def _conditions_in(plain: str) -> Iterator[re.Match[str]]:
    """Equations of an angle with a number, but for those that go on as a formula."""
    for found in _CONDITION.finditer(plain):
        number = found.end() - 1 if plain[found.end() - 1].isdigit() else found.end()
        goes_on = not found["letter"] and _WORKED_OUT.match(plain, number)
        step = _IN_CHAIN.search(plain, 0, found.start())
        if not goes_on and not (step and _OPERATION.search(step[0])):
            yield found


def flat(text: str) -> str:
    """A text without braces, dollars, dots over letters and what stands below the line."""
    return re.sub(r"[{}_\\$]|d{1,2}ot\b\s*", "", re.sub(r"\\[,;:! ]", " ", text))


_LETTERS = 4
"""Of a product that is written as one word."""


def _words_in(text: str) -> bool:
    return any(_every_word(text))


def _every_word(text: str) -> Iterator[str]:
    for prose, typeset in _proses(text):
        yield from (one[0] for one in _WORDS[typeset].finditer(prose))


def say_of_what(text: str) -> bool:
    """Whether words of a text may say of what each of its equations is: ``of the first link``.

    Such as lead from one to the next do not: ``so``, ``by Steiner``.

    Args:
        text: as typed.
    """
    return not all(map(leads_over, _every_word(text)))


@dataclass(frozen=True)
class Doubt:
    """Words beside a formula that may change what it claims.

    Attributes:
        words: the first of them, for a message.
        turned: whether they may be of another axis or sense of turning.
    """

    words: str
    turned: bool


def left_over(text: str, found: Iterable[tuple[str, str]], names: Iterable[str]) -> Doubt | None:
    """What is left of doubtful words without those that are names of the formula's.

    Args:
        text: as typed.
        found: from :func:`doubtful`.
        names: of the formula and of what explains it.
    """
    known = {name.lower() for name in names}

    def is_product(word: str) -> bool:  # + mgl*cos(q)
        letters = 0 < len(word) <= _LETTERS and known.issuperset(word.lower())
        return letters and bool(re.search(rf"[-+*/=(·−½⅓¼\d]\s*{re.escape(word)}(?!\w)", text))

    left = (one for one in found if one[0].lower() not in known and not is_product(one[0]))
    phrase = next((phrase for _word, phrase in left), "")
    turned = any(_TURNED.search(prose) for prose in outside_formulas(text))
    return Doubt(phrase, turned) if phrase else None


@lru_cache(maxsize=64)
def _proses(text: str) -> tuple[tuple[str, bool], ...]:
    """The pieces of a text in which words may stand, and whether letters may be products there."""
    left = text.partition("=")[0] if "=" in text else ""
    found = [one[0].lstrip("_ ") for one in _BELOW.finditer(left)]
    if "\\" in text:  # without braces one letter stands below: _eT
        found = [one for one in found if one[:1] == "{"]
    below = " ".join(_FONT.sub(r" \1 ", one) for one in found)
    below = _NAMES_BELOW.sub(" ", below)
    said = [(re.sub(r"[{}\\]", " ", below), False)]
    text = _BELOW.sub("_0", text)
    said += [(one[1], False) for one in _FONT.finditer(text)]
    outside = _FONT.sub(" ; ", _AROUND.sub(" ", text))
    typeset = "\\" in outside
    if MATHS.search(outside):
        outside, typeset = MATHS.sub(" ; ", outside), False
    return (*said, (_COMMAND.sub(" ; ", outside), typeset))


def _cut(prose: str) -> tuple[str, str]:
    """What is said of the formula, and what of the names behind it."""
    found = _WHERE.search(prose)
    if found is None or "=" not in prose[: found.start()]:
        return prose, ""
    return prose[: found.start()], prose[found.end() :]


def _of(prose: str, entry: str, typeset: bool) -> list[tuple[str, str]]:
    found = []
    for one in _WORDS[typeset].finditer(prose):
        if one["latin"] and _AXIS.fullmatch(one["latin"]) and _is_numbered(prose, *one.span()):
            continue
        word = one["latin"] or chinese_left(_ORDINAL.sub("", one["chinese"]), entry)
        if word and not (one["latin"] and says_nothing(word, entry)):
            found.append((word, around(prose, one.start(), one.end())))
    return found


def _is_numbered(prose: str, start: int, end: int) -> bool:
    """Whether an axis is told by its number: ``Achse 1``, ``die dritte Achse``."""
    before = prose[:start].split()[-1:]
    return bool(re.match(r"\s+[1-9]", prose[end:]) or (before and before[0].lower() in _ORDER))


def around(prose: str, start: int, end: int) -> str:
    """The words on both sides of one.

    Args:
        prose: from :func:`outside_formulas`.
        start, end: where the one is.
    """
    behind = _PHRASE.match(prose, end)
    front = _PHRASE.match(prose[:start][::-1])
    end += len(behind[0]) if behind else 0
    start -= len(front[0]) if front else 0
    said = prose[start:end].strip(" ,.;:-")
    if prose[:start].rstrip()[-1:] in _SIGNS_IN:
        said = _ENDING.sub("", said)
    if prose[end : end + 1] in ("=", "_") and " " in said:
        said = said.rpartition(" ")[0]  # the name of the formula
    return re.sub(r"\s+;\s+", " ... ", said.strip(" ,.;:-"))[:_MOST]


def _parts(prose: str, entry: str) -> list[tuple[str, str]]:
    """Links and joints by their number that are not the entry's own: joint 2 of x, or of tau1."""
    own = {*re.findall(r"\d", _counted_from_1(entry))}
    every = ((one, _number_of(one)) for one in _PART.finditer(prose))
    other = (one for one, number in every if number and number not in own)
    return [(one[0], around(prose, *one.span())) for one in other]


def _counted_from_1(entry: str) -> str:
    """An entry with its places counted from 1: those of a quantity are from 0."""
    return re.sub(r"\d", lambda k: str(int(k[0]) + 1), entry) if "[" in entry else entry


def _number_of(part: re.Match[str]) -> str:
    told = part["order"] or part["chinese"] or ""
    return part["number"] or part["behind"] or str(_ORDER.get(told.lower(), told))
