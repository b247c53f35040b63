"""Words around a formula: ``末端的 x 坐标为 $x = ...$``, ``where q1 is the angle of joint 1``.

What may change a name's meaning, or denies the formula, is refused. All other words are left out,
and :mod:`kinlab.formulas.language.prose` tells which of them may mean something all the same.
"""

from __future__ import annotations

import re

from kinlab.errors import ExpressionError
from kinlab.formulas.language.prose import (
    around,
    condition_in_front,
    explained_by,
    flat,
    moment_elsewhere,
    of_another_part,
    of_another_point,
    of_other_axes,
    outside_formulas,
    own_sentence,
)
from kinlab.formulas.language.sentences import without_sentences
from kinlab.formulas.language.vocabulary import is_program
from kinlab.formulas.signs.refusals import refused
from kinlab.formulas.typed import begins_with, entry_name, of_one_name
from kinlab.host.language import N_

_HEAD = re.compile(r"^([A-Za-z][\w ]{0,20}?)\s*:(?![=:])\s*(?=\S)")
_SPOKEN = re.compile(r"^(?P<words>[^=*/^+:\n\\$]{4,90}?)\s?[:：]\s+(?=\S)")
_LONG_WORD = re.compile(r"[^\W\d_]{4,}")
"""What a formula without a sign of equality begins with: ``x of the tool: l1*c1``."""
_OTHERWISE = re.compile(
    r"竖直|铅垂|水平(?!面)|夹角|绝对|相对|量起|角度制|错|有误|应再|不对|不正确|不是|并非|不等于"
    r"|\b(?:measured|absolute[rn]?|relative(?!\s+(?:joint\s+)?angles?\b)"
    r"|(?<!move )(?<!moves )verti[ck]al\w*"
    r"|horizontal\w*(?!\s+plane)|gemessen|misst"
    r"|senkrechte?n?"
    r"|waage?recht|grad|(?<!not )(?<!not in )(?<!no )degrees?(?!\s+of\s+freedom)"
    r"|degrees?(?=\s+but\b)"
    r"|wrong\w*|incorrect\w*|mistak\w*|false"
    r"|falsch\w*|per\s+(?:unit|kg|kilogram|met(?:er|re))|pro\s+(?:kg|einheit|meter|masse\w*))\b"
    r"|\b(?:not|n['’]t|never)\s+(?:\w+\s+){0,2}"
    r"(?:correct|right|true|valid|equal\w*|holds?|appl(?:y|ies)|the\s+case)\b"
    r"|\bshould(?:\s+not|n['’]t)\s+(?:\w+\s+)?be\s+(?!\w+e[dn]\b)"
    r"|\bnicht\s+(?:\w+\s+){0,2}(?:richtig|korrekt|wahr|gültig|gleich|zutreffend)\b"
    r"|\b(?:stimmt|gilt|passt)\s+(?:\w+\s+)?nicht\b(?!\s+nur)"
    r"|\bup\s+to\s+(?:the\s+|a\s+|its\s+)?(?:\w+\s+)?(?:sign|factor|scale|order)\w*"
    r"|\bbis\s+auf\s+(?:das\s+|den\s+|einen\s+|ein\s+)?(?:\w+\s+)?(?:vorzeichen|faktor)\w*"
    r"|(?:相差|差|除了|除)一?个?(?:正负|负)?(?:符号|号|系数|因子)|符号相反|单位质量|单位长度"
    r"|\b(?:units?|einheit(?:en)?)\s*[:=]?\s*(?:(?:in|is|are|of|ist|sind)\s+)?"
    r"(?:mm|cm|dm|km|kN|N?cm|N?mm|deg|grad|inch\w*|milli\w+|centi\w+|zenti\w+)\b"
    r"|(?:单位[:：为是]*|以)(?:度|毫米|厘米)|单位\s*[:：为是]?[^，。,;；\n]{0,12}(?:[cm]m|毫米|厘米)"
    r"|\b(?:opposite|other|reversed?|changed)\s+sign\b|\bnegative\s+of\b|\bumgekehrte\w*\s+vorzeichen"
    r"|\b(?:must|has\s+to|have\s+to|needs?\s+to|should|ought\s+to)\s+be\s+(?:dropped|removed|added"
    r"|replaced|corrected|changed|multiplied|divided|halved|doubled|negated|inverted|transposed)\b"
    r"|\b(?:twice|half|double|triple)\s+(?:of\s+)?(?:the|its)\s+(?:\w+\s+)?"
    r"(?:energy|torque|value|result|entry|matrix|lagrangian)\b"
    r"|\b(?:for|of)\s+(?:the\s+|an)other\s+(?:\w+\s+)?(?:arm|robot|manipulator)\b"
    r"|\b(?:multipl|divid)\w*\s+(?:\w+\s+){0,3}by\s+(?:two|three|four|half|minus|-?\s?\d)"
    r"|\black(?:s|ing)?\b|\b(?:half|twice)\s+(?:of\s+)?(?:what|this|that)\b|去掉"
    r"|\b(?:holds?|valid|true|gilt|gültig)\s+(?:\w+\s+){0,2}(?:only|nur|just|lediglich)\b"
    r"|\b(?:only|nur|lediglich)\s+(?:holds?|valid|true|für|for|if|when|falls|wenn|gültig)\b"
    r"|(?<=\w )in\s+(?:mm|cm|milli?met\w+|centimet\w+|zentimet\w+)\b|仅当|仅在"
    r"|\bminus\s+the\s+(?:potential|kinetic|total)\b|\bequal\s+(?:links?|lengths?|masses)\b"
    r"|(?<![\w*/^+-])m_?\{?\d\}?\s+(?:is|denotes|means|ist)\s+(?:the\s+|die\s+)?mass\w*\s+(?:of|der)\s+"
    r"(?:the\s+|a\s+)?(?:payload|load|tool|nutzlast|last)\b"
    r"|\b(?:moving|accelerat\w+)\s+base\b|\bbase\s+(?:is\s+)?(?:mov|accelerat)\w+"
    r"|\bfactor\s+(?:of\s+)?(?:two|2|1/2|0\.5|½|one\s+half|-1|minus\s+one)\b"
    r"|\b(?:neglect|ignor|disregard|vernachlässig)\w*\s+(?:\w+\s+){0,3}"
    r"(?:mass\w*|gravity|weight|inertia|masse|gewicht\w*|schwerkraft|trägheit)"
    r"|(?:忽略|不计|不考虑|略去)[^，。,;；=]{0,8}(?:质量|重力|惯量|惯性|自重|动能|势能|科氏|哥氏|离心)"
    r"|\b(?:without|ohne|senza|sans|sin|sem)\s+(?:the\s+|die\s+|der\s+|les\s+|la\s+)?"
    r"(?:coriolis|[cz]entrifugal|gravit|schwerkraft|pesanteur)"
    r"|\bnot\s+(?:yet\s+)?(?:been\s+)?(?:included|considered|contained|added)\b"
    r"|\bnicht\s+(?:enthalten|berücksichtigt)\b"
    r"|(?<!no )(?<!without )\b(?:friction|damping)\s+(?:torque|force|moment)\b(?!\s+is)"
    r"|\breib(?:ungs)?moment\b"
    r"|\b(?:correct|right|true)\s+(?:result|answer|value|formula|entry|form|one|signs?)\s+"
    r"(?:is|are|would|reads)\b|\b(?:richtige|korrekte)s?\s+vorzeichen\s+(?:ist|wäre)\b|正确的?(?:符号|结果|答案)(?:是|为|应)"
    r"|\b(?:rpm|rev/min|u/min|(?:revolutions?|rotations?|turns?)\s+per|umdrehung\w*)\b|转每分|每分钟|转/分"
    r"|\b(?:rotor\w*|armature|motor\w*|antrieb\w*|payload|nutzlast|wrist)\s+(?:\w+\s+){0,4}"
    r"(?:neglect|ignor|vernachlässig|omit|weggelassen|néglig|desprec|trascur)"
    r"|\bdans\s+(?:le\s+repère\s+(?:de\s+)?l['’]outil)|\bpas\s+(?:dans\s+)?(?:celui|celle)\b"
    r"|\bno\s+(?:en\s+)?(?:el|la)\s+(?:de|del)\b|\bnon\s+(?:in\s+)?quell[ao]\b"
    r"|没有包括|未包括|不包括|只算了|只考虑|忘(?:记|了)|鉛直|omgekeerde?\s+teken"
    r"|\boubli[ée]\w*|\bmultiplier\s+par\b|\bmultiplicar\s+por\b|\bmoltiplicare\s+per\b"
    r"|\baproxima(?:ção|ción)\b|\bapprossimazione\b|\bdesprez\w*|\bolvid\w+|\bdimenticat\w+"
    r"|\bno\s+(?:es\s+)?la\s+(?:cinética|potencial|energía)\b|\bnon\s+è\b|\bn['’]est\s+pas\b"
    r"|(?<!no )(?<!without )\bapproximat\w*|\bapproximat\w*(?=,?\s+but\b)"
    r"|\b(?:näherung\w*|genähert\w*|missing|fehl(?:t|en)"
    r"|forgot(?:ten)?(?![^.;]{0,60}\b(?:but|then|now)\b[^.;]{0,20}\b(?:correct|fix|add)(?:ed)?\b))\b|近似|缺少|漏掉"
    r"|(?<!counter)(?<!counter[ -])(?<!anti)(?<!anti[ -])\bclockwise\b"
    r"|\bim\s+uhrzeigersinn\b|顺时针"
    r"|(?<!no )(?<!assume )\bsmall[- ](?:angles?|q\b|motions?|rotations?)"
    r"|\bkleine[nr]?\s+winkel|小角度|微小な?角"
    r"|\b(?:kgf|kp|lbf?|pounds?|inch(?:es)?|ounces?|feet|pieds?|pouces?|libras?"
    r"|pulgadas?|zoll|pfund)\b|\ben\s+(?:livres|pies)\b|\bg[·* ]?[cm]m"
    r"|\binstead\s+of\b|\banstatt\b|而不是"
    r"|\b(?:comes?|goes|added)\s+on\s+top\b|\bhold\s+on\b|\bsign\s+is\s+the\s+other\b"
    r"|,\s?not\s+[xyz]\b|\b(?:has|have)\s+to\s+take\b[^.;]{0,40}\binstead\b"
    r"|\b(?:q|th|theta)_?\d\s+is\s+not\b|\bsó\s+(?:é\s+)?v[aá]lid|\bbez\s+grawitac"
    r"|\b(?:en|em|in|i)\s+(?:mil[ií]m[eè]?tr|millim[eè]tr|cent[ií]m[eè]?tr|centim[eè]tr)\w*"
    r"|\bbeneden\s+positief|\bdu\s+double\s+de\b"
    r"|\b(?:milli|centi|zenti|kilo|micro|mikro|mega)(?:joule|newton|watt)\w*"
    r"|\bnewton[- ]?(?:milli|centi|zenti)met\w+"
    r"|(?<!no )(?<!pas )(?<!non )\b(?:en|em|in)\s+"
    r"(?:grados|graus|gradi|degrés|stopniach|graden|grader)\b"
    r"|ただし(?!\s{0,9}\$?\\?[A-Za-z]\w*\s{0,9}=)"
    r"|\b(?:elbow|shoulder|wrist|ellbogen|coude|codo|gomito)\s+(?:only|nur|seulement|solo)\b"
    r"|\bsign\s+(?:is|would\s+be)\s+(?:opposite|reversed|the\s+other)\b"
    r"|,\s?(?:não|no|pas|non)\s+(?:a|la|le|l['’])\s?(?:potenci|cin[eé]ti|poten[zt]i|énergie|energ)"
    r"|\b(?:yalnızca|sadece)\b|\b(?:misurat|medid)[ao]s?\s+(?:dal|da|desde|a\s+partir)"
    r"|\bcamera\b|\bleft[- ]handed\b|\blinkshändig\w*|左手(?:系|坐标)"
    r"|\b(?:senza|sans|utan|zonder|sin|sem|bez)\s+(?:\w+['’]?\s*){0,2}"
    r"(?:gravi|coriolis|pes|masse?|termi)"
    r"|\b(?:first|second|third|last|erste[sn]?|zweite[sn]?)\s+(?:link|glied|rod|body|term)\s+"
    r"(?:only|allein|alone)\b"
    r"|\bonly\s+the\s+(?:first|second|third|last)\s+(?:link|rod|body|term)\b"
    r"(?!\s+(?:depends|contains|involves|has|appears|changes|varies|moves)\b)"
    r"|\b(?:roughly|ungefähr|etwa|environ|circa|approssimat\w*|aproximad\w*|ongeveer)\b"
    r"|(?<![а-яё])(?:не(?!\s+завис)|нет|без|ошиб\w*|неверн\w*|неправильн\w*|приближ\w*|вместо|только"
    r"|противоположн\w*|обратн\w*\s+знак\w*|вертикал\w*|горизонтал\w*|градус\w*|пренебр\w*|отброш\w*"
    r"|половин\w*|удво\w*|умнож\w*|раздел\w*|мм|см(?!\.)|миллиметр\w*|сантиметр\w*)(?![а-яё])"
    r"|\b(?:rough|crude|first)\s+(?:estimate|guess)\b|\b(?:grobe\s+)?schätzung\b|\bgeschätzt\b"
    r"|大约|大概|およそ|約(?=\d)"
    r"|\bnot\s+(?:yet\s+)?(?:been\s+)?(?:checked|verified|tested|finished|complete)\b"
    r"|\bvorzeichen\s+(?:\w+\s+){0,3}(?:umgekehrt|falsch|vertauscht)\b"
    r"|\bin\s+(?:milli|centi|zenti)met(?:re|er)n?s?\b|\bvernachlässigung\s+(?:de[sr]|von)\s+term"
    r"|\b(?:arm|case|pose|posture|configuration)s?\s+only\b|\bnon\s+per\s+l[aeo]\b"
    r"|\bnicht\s+(?:das|die|der|den)\s+gesuchte\w*|\b(?:das|die)\s+negative\s+davon\b"
    r"|\bnicht\s+(?:die|das|der|den)\s+(?:der|des|von|vom)\b|\bnot\s+(?:that|the\s+one|those)\s+of\b"
    r"|未验证|未検証|\bdas\s+doppelte\b|\bdie\s+hälfte\b|\b(?:la\s+)?moitié\b"
    r"|\b(?:el|il|le)\s+(?:doble|doppio|double)\b"
    r"|\bmuss\s+(?:\w+\s+){0,4}(?:multipliziert|geteilt|halbiert|verdoppelt|addiert|ergänzt)\b"
    r"|\bbe\s+(?:reversed|flipped|switched|swapped)\b"
    r"|\b(?:falta|faltan|manque|manquent|manca|mancano)\b"
    r"|無視|無い|足りない|ではなく|(?<!は)ではない|負号が逆"
    r"|\bv[aá]lid[oae]?s?\s+(?:\w+\s+)?(?:solo|sólo|solamente|soltanto|únicamente|unicamente|apenas)\b"
    r"|\bvalables?\s+(?:\w+\s+)?(?:seulement|uniquement)\b"
    r"|\b(?:seulement|uniquement)\s+(?:valables?|pour|si|quand)\b"
    r"|\b(?:solo|sólo|soltanto|solamente|slechts|alleen)\s+"
    r"(?:per|si|para|se|quando|cuando|voor|als|v[aá]l\w+)\b"
    r"|\bvale\s+(?:solo|sólo|soltanto|solamente)\b|のみ(?:有効|成立|成り立つ)|だけ(?:で成立|有効)",
    re.IGNORECASE,
)
"""Words that say what a name means in another way than the robot's, or that a formula is none."""
_COORDINATE = re.compile(
    r"(?<![\w*/^+-])([xyz](?:[ ,/-]{0,2}(?:and|und|bzw\.|和|与|、)?[ -]{0,2}[xyz]\b){0,2})[ -]{0,2}"
    r"(?:coordinates?|components?|positions?|koordinaten?|komponenten?|坐标|分量)",
    re.IGNORECASE,
)
_FORMULA = re.compile(r"[=*^]")
"""Where a formula begins, or its name ended."""
_HARMLESS_NOT = "depend|contain|appear|matter|change|enter|vary|forget"
_DENIED = re.compile(
    r"\b(?:if|falls|wenn|assum\w+|never|unless|kein\w*|inverse\s+(?:of|der|des)"
    rf"|(?:not|nicht)(?!\s+(?:{_HARMLESS_NOT})))\b|如果|假设|n['’]t\b(?!\s+forget)"
    r"|(?:\\?\b(?:theta|th|q)|[θϑ])_?\{?[\d₀-₉]+\}?\s*"
    r"(?:为|是|表示|is\b|are\b|denotes\b|means\b)",
    re.IGNORECASE,
)
"""The same, in front of a formula alone."""
_MORE = re.compile(
    r"\b(?:(?<!translation )plus(?!\s+(?:the\s+)?(?:parallel[- ]axis|steiner))|times"
    r"|(?<!checked )(?<!verified )twice|multiplied|divided|except"
    r"|(?<!no )(?<!hence the )(?<!therefore the )(?<!thus the )(?<!explains the )"
    r"minus(?!\s+signs?\s+(?:is|are|comes?|follows?|arises?|results?|stems?|must|has)\b)"
    r"|apart|without|zuzüglich|abzüglich|ohne|außer"
    r"|mal|geteilt)\b|加上|减去|乘以|除以|再加|再乘",
    re.IGNORECASE,
)
"""The same, behind it: what is still to be added."""


def without_words(text: str, entry: str, place: str) -> tuple[str, list[str]]:
    """The text without the words around the formula.

    Args:
        text: as typed.
        entry: what the formula is asked for.
        place: what to put in front of a message.

    Returns:
        It; and what of its equations is left out, as :func:`without_sentences` has it.

    Raises:
        ExpressionError: words that may change what a name means.
    """
    refuse_meanings(text, entry, place)
    spoken = None if "=" in text else _SPOKEN.match(text)
    if spoken and any(not is_program(one) for one in _LONG_WORD.findall(spoken["words"])):
        text = text[spoken.end() :]
    found = _HEAD.match(text)
    if found and _is_name(found[1], entry) and "=" not in text:
        text = f"{found[1]} = {text[found.end() :]}"
    plain, left = without_sentences(text, entry)
    return (_HEADING.sub("", text), []) if plain == text else (plain, left)


_HEADING = re.compile(
    r"^\s*(?=[^\n]{0,80}[^\W\d_]{4})[^=\n*/^+\\$]{4,90}[:：][ \t]*\n(?=[^\n]{1,60}=)"
)
"""Words on a line of their own, above formulas."""
_COMMENTS = re.compile(
    r"(?<![:/])//(?!=)([^\n]+)|/\*(.+?)\*/|\(\*(.+?)\*\)"
    r"|(?:^|[ \t\n])#(?![\d{])([^\n]+)",
    re.DOTALL,
)
_BEHIND = re.compile(
    r"(?<=[\w)}\]])[ \t]{1,9}\(([^()]{8,100})\)(?:\s{0,9}\.?\s{0,9}$|(?=[ \t]{0,9}:[ \t]{0,9}\n))"
)
_PLAIN_WORDS = re.compile(r"(?:[^\W\d_]|\d|(?<=\d)[.,](?=\d)|(?<=\w)[-'’](?=\w)|[.,;:]?\s|[.,;:])+")
_NO_WORDS = re.compile(
    r"[^\W\d_]\d|\d[^\W\d_]|[\u0370-\u03ff]|(?<![^\W\d_])(?:sin|cos|tan|sqrt|exp)"
)
"""Names with numbers, Greek letters and functions."""
_ROUNDED = re.compile(
    r"rounded|gerundet|arrondie?s?|redondead[oa]s?|arrotondat[oiae]", re.IGNORECASE
)
"""What is said of numbers."""
_A_WORD = 9
"""Letters that no name has."""
_SMALL_WORDS = (
    r"\b(?:the|of|from|for|is|are|in|by|with|and|as|see|to|only|without|der|die|das|ist|sind|von|vom|aus"
    r"|im|mit|und|nur|ohne|siehe|la|le|les|el|du|de|des|del|della|est|es)\b"
    r"|(?<=\w)['’]s\b"
)
"""Words that no formula has."""


def without_remark_behind(text: str, place: str) -> str:
    """The text without words in parentheses behind it: ``(2.0 kg from the rotor)``.

    Nor behind a definition in front: ``h = m*l1*l2 (Spong's symbols):``.

    Raises:
        ExpressionError: they change what the formula claims.
    """
    for found in reversed([*_BEHIND.finditer(text)]):
        inside = found[1]
        words = re.findall(r"[^\W\d_]{3,}", inside)
        small = words and re.search(_SMALL_WORDS, inside, re.IGNORECASE)
        long = [word for word in words if len(word) > len("sin") and not is_program(word)]
        told = small or len(long) > 1 or len(max(long, default="")) >= _A_WORD
        told = told or bool(_ROUNDED.fullmatch(inside))
        if not told or _NO_WORDS.search(inside) or not _PLAIN_WORDS.fullmatch(inside):
            continue  # (alpha beta gamma) may be a factor
        if _OTHERWISE.search(inside) or _MORE.search(inside):
            raise refused(place, _CHANGED, words=inside)
        text = text[: found.start()] + text[found.end() :]
    return text


def refuse_comments(text: str, place: str) -> None:
    """Refuses comments of programs with words that change what a formula claims.

    Args:
        text: as typed, with its comments.
        place: what to put in front of a message.

    Raises:
        ExpressionError: with the words.
    """
    for comment in _COMMENTS.finditer(text):
        inside = next(part for part in comment.groups() if part)
        found = _OTHERWISE.search(inside) or _MORE.search(inside)
        if found:
            raise refused(place, _CHANGED, words=around(inside, *found.span()))


_CHANGED = N_("{words!r} beside the formula may change what its names mean; leave it out")
_NOUN = {
    "kinetic_energy T K": (
        r"kinetic\s+energy|kinetische\w*\s+energie|(?:平动|转动)?动能|énergie\s+cinétique"
    ),
    "potential_energy V U P": (
        r"potential\s+energy|potentielle\w*\s+energie|势能|位能|énergie\s+potentielle"
    ),
    "mass_matrix M": (
        r"(?:mass|inertia)\s+matrix|massenmatrix|trägheitsmatrix|(?:质量|惯量|惯性)矩阵"
    ),
    "coriolis_matrix C": r"coriolis\s*-?(?:matrix|matrize|term)|(?:科氏|哥氏|科里奥利)\w*矩阵",
    "gravity_torques g": (
        r"gravity\s+(?:vector|torques?|term)|gravitationsvektor|重力(?:项|矢量|向量|力矩)"
    ),
}
"""What quantities are called, as far as a sentence says of a formula that it is that."""
_ENERGY = (
    r"(?:total|whole|mechanical)\s+energy|gesamtenergie|总能量|机械能"
    r"|énergie\s+(?:totale|mécanique)"
)
_SAYS_BEHIND = (
    r"(?:(?:(?<=[)\]}}])|\b(?:this|that|it|which|das|dies|ce|c['’]))\s*(?:is|ist|est)\s+"
    r"|\bsondern\s+|[这它]是\s*)(?:the\s+|die\s+|das\s+|der\s+|l['’])?(?:{noun})"
)
"""The same behind it: ``This is the total energy``."""
_SAYS = (
    r"(?:^|[.;。\n])\s*(?:(?:the|our|its|die|das|der|la|l['’])\s+)?(?:{noun})"
    r"(?:\s+(?:is|are|reads|ist|lautet|est|vaut|becomes)|\s*[:：为是])?(?:\s+given\s+by)?\s*[:：]?\s*$"
)


_SECOND_KIND = re.compile(
    r"\b(?:second\s+kind|zweiter\s+art|deuxième\s+espèce|segunda\s+(?:especie|espécie)"
    r"|seconda\s+specie)\b|第二类",
    re.IGNORECASE,
)
"""Christoffel's symbols times the inverse of the metric."""


def _of_another_quantity(text: str, entry: str) -> str:
    """Words right in front of a formula that say of it that it is another quantity."""
    head = re.split(r"[\d\[]", entry)[0]
    others = {names: noun for names, noun in _NOUN.items() if head not in names.split()}
    behind = _FORMULA.split(text)[-1]
    for noun in (*others.values(), _ENERGY):
        if found := re.search(_SAYS_BEHIND.format(noun=noun), behind, re.IGNORECASE):
            return found[0].strip(" .;。\n)")
    if head == "christoffel" and (found := _SECOND_KIND.search(text)):
        return found[0]
    if len(others) == len(_NOUN):
        return ""  # of what it is asked for nobody has a noun here
    front = _NAME_BEHIND.sub("", _FORMULA.split(text)[0]).rstrip("$ \\")
    for noun in others.values():
        if found := re.search(_SAYS.format(noun=noun), front, re.IGNORECASE):
            return found[0].strip(" .;。\n")
    return ""


_NAME_BEHIND = re.compile(r"[$\\]{0,3}[A-Za-z][\w{},]{0,12}(?:\([\w,\s]{1,12}\))?\s*&?$")


def refuse_meanings(text: str, entry: str, place: str) -> None:
    """Refuses words that change what a formula claims whether it is right or not.

    Args:
        text: as typed.
        entry: what the formula is asked for.
        place: what to put in front of a message.

    Raises:
        ExpressionError: with the words.
    """
    for prose in outside_formulas(text):
        front, sign, _behind = prose.partition("=")
        found = _OTHERWISE.search(prose) or _MORE.search(prose, len(front) if sign else 0)
        if found:
            raise refused(place, _CHANGED, words=around(prose, *found.span()))
    other = (
        _of_another_coordinate(text, entry) or moment_elsewhere(text) or of_other_axes(text, entry)
    )
    other = other or of_another_point(text, entry) or _of_another_quantity(text, entry)
    if said_otherwise := other or of_another_part(text, entry):
        said = N_("{words!r} beside the formula is not what it is asked for; leave it out")
        raise refused(place, said, words=said_otherwise)
    if _DENIED.search(_FORMULA.split(text)[0]) or condition_in_front(text, entry):
        said = N_("{words!r} in front of the formula may change what its names mean; leave it out")
        raise refused(place, said, words=text.strip()[:60])
    if words := explained_by(text):
        said = N_(
            "{words!r} behind the formula may change what its names mean; leave it out, or "
            "write name = formula"
        )
        raise refused(place, said, words=words)


def refuse_meanings_of_steps(text: str, entry: str, place: str) -> None:
    """The same of a derivation: in sentences before the entry's own what changes the whole.

    What is to be added there, and of what another line is, says nothing of the last one.

    Args:
        text, entry, place: as for :func:`refuse_meanings`.

    Raises:
        ExpressionError: with the words.
    """
    begin = own_sentence(text, entry)
    for prose in outside_formulas(text[:begin]):
        if found := _OTHERWISE.search(prose) or _DENIED.search(prose):
            raise refused(place, _CHANGED, words=around(prose, *found.span()))
    said = moment_elsewhere(text) or of_other_axes(text, entry)
    if said or condition_in_front(text, entry):
        raise refused(place, _CHANGED, words=said or text.strip()[:60])
    refuse_meanings(text[begin:], entry, place)


def _of_another_coordinate(text: str, entry: str) -> str:
    """Words that say that it is another coordinate than the entry's; empty where none do."""
    own = {one for one in "xyz" if begins_with(f"{one} =", entry)}
    for found in _COORDINATE.finditer(flat(text)) if own else ():
        if own.isdisjoint(found[1].lower()):
            return found[0]
    return ""


def _is_name(text: str, entry: str) -> bool:
    """Whether a word is the entry's name: x of x, tau_2 of tau2."""
    try:
        name = entry_name(text)
        known = of_one_name(name, entry_name(entry))
    except ExpressionError:
        return False
    return known and (name[:1] == entry[:1] or len(name.rstrip("0123456789_")) <= 3)
