r"""Units behind numbers and formulas: ``0.24 kg m^2``, ``(in m)``, ``l1 = 50 cm``, ``\text{ m}``.

SI units of what is asked for are left out, numbers in other units are converted, and a formula
that is as a whole in another unit is refused. A letter that may be a name stays one.
"""

from __future__ import annotations

import re
from decimal import Decimal

from kinlab.formulas.signs.refusals import refused
from kinlab.host.language import N_

_BEHIND_MATHS = re.compile(
    r"(?<=\d)\s?\$(?:\s|~|\\[,;: ]){0,3}"
    r"((?:mm|cm|kg|rad|Nm|N|m|s)(?:\s?[·*/]?\s?(?:m|s))?(?:\^\{?-?\d\}?|[²³])?)(?=[\s,.;)]|$)"
)


def with_units_inside(text: str) -> str:
    """Units behind a number's dollars within these: ``$l_1 = 0.5$ m``; and behind a formula's."""
    return _AT_THE_END.sub(r"\\,\\mathrm{ \g<unit>}$", _BEHIND_MATHS.sub(_within, text))


def _within(found: re.Match[str]) -> str:
    """A unit of the SI is left out."""
    return rf"\,\text{{ {found[1]}}}$" if found[1][:2] in ("mm", "cm") else "$"


Size = tuple[int, int, int]
"""Powers of metre, kilogram and second."""
_SIZES = {
    **{"m": (1, 0, 0), "kg": (0, 1, 0), "s": (0, 0, 1), "rad": (0, 0, 0)},
    **{
        "N": (1, 1, -2),
        "J": (2, 1, -2),
        "W": (2, 1, -3),
        "Nm": (2, 1, -2),
        "Nms": (2, 1, -1),
        "kgm": (1, 1, 0),
    },
}
"""Powers of metre, kilogram and second in each unit."""
_ENTRIES = (
    (
        re.compile(
            r"(?:p_?)?[xyz](?:_?e)?|[TAH]_?[123]4|fk\[[012],3\]"
            r"|com_positions\[\d,[012]\]|dh_poses\[\d,[012],3\]|planar_pose\[[01]\]"
        ),
        {(1, 0, 0)},
    ),
    (re.compile(r"[VUPTKL]|E_?[pk]|kinetic\w*|potential\w*|lagrangian"), {(2, 1, -2)}),
    (
        re.compile(
            r"(?:tau|g|G|Q|cv|inverse_dynamics|gravity_torques|coriolis_torques|statics)\W?\d?\]?"
        ),
        {(2, 1, -2), (1, 1, -2)},
    ),
    (re.compile(r"(?:M|D|H|B|mass_matrix).*"), {(2, 1, 0), (1, 1, 0), (0, 1, 0)}),
    (re.compile(r"(?:C|coriolis_matrix).*"), {(2, 1, -1), (1, 1, -1), (0, 1, -1)}),
    (re.compile(r"(?:J|jacobian|planar_jacobian).*"), {(1, 0, 0)}),
    (re.compile(r"det.*"), {(2, 0, 0)}),
)
"""The units that entries have, of joints that turn and joints that slide."""
_NAMES = (
    (re.compile(r"(?:l|L|a|b|d|r|h|lc|Lc|e|[xyz](?=_?\{?[tb]))_?\{?\w{0,2}\}?"), (1, 0, 0)),
    (re.compile(r"(?:m|M)_?\{?\w{0,2}\}?"), (0, 1, 0)),
    (re.compile(r"g"), (1, 0, -2)),
    (re.compile(r"(?:I|J)_?\{?\w{0,4}\}?"), (2, 1, 0)),
    (re.compile(r"(?:q|th|theta|\\theta|alpha|\\alpha)_?\{?\w?\}?"), (0, 0, 0)),
)
"""The units of what a writer gives a number to, by its letter."""
_OTHERS = {
    **{"mm": ((1, 0, 0), Decimal("0.001")), "cm": ((1, 0, 0), Decimal("0.01"))},
    **{"dm": ((1, 0, 0), Decimal("0.1")), "km": ((1, 0, 0), Decimal(1000))},
    **{"g": ((0, 1, 0), Decimal("0.001")), "gram": ((0, 1, 0), Decimal("0.001"))},
}
_SPACE = r"(?:\s|~|\\[,;:! ]|\\quad(?![A-Za-z])){0,9}+"
_POWER = r"(?:\s?(?:\^|\*\*)\s?(?:\{\s*-?[1-4]\s*\}|-?[1-4])|[²³⁴]|⁻[¹²])?"
_ATOM = rf"(?:Nms|Nm|kgm|kg|rad|N|J|m|s)(?![A-Za-z]){_POWER}"
_BETWEEN = r"(?:\s|~|\\[,;:! ]|\\cdot(?![A-Za-z])|[*·⋅/]){0,6}+"
_UNIT = rf"{_ATOM}(?:{_BETWEEN}{_ATOM}){{0,5}}"
_AT_THE_END = re.compile(rf"(?<=[\w}})\]])\s?\$\s{{1,9}}(?P<unit>{_UNIT})\s{{0,9}}\.?\s*$")
_FONT = r"\\(?:text|textrm|mathrm|mbox|si|unit|rm)\s*"
_IN = r"(?:in\s+)?"
_DRESSED = (
    rf"(?:\(\s*{_IN}(?:{_FONT}\{{\s*)?(?P<a>{{unit}})\s*\}}?\s*\)|\[\s*{_IN}(?:{_FONT}\{{\s*)?(?P<b>{{unit}})\s*\}}?\s*\]"
    rf"|{_FONT}\{{\s*[(\[]?\s*{_IN}(?P<c>{{unit}})\s*[)\]]?\s*\}}|{_IN}(?P<d>{{unit}}))"
)
_END = (
    rf"(?={_SPACE}(?:$|\$|\\\]|\\\)|\\end\b|[\n;]|\\\\|,|\.\s*$|(?:\\text\s*\{{\s*|,\s*|\\quad\s*)?"
    r"(?:where|with|wobei|mit)\b|其中"
    r"|\s(?:and|und|et|y|e)\s+\$?\\?[A-Za-z]\w{0,5}_?\{?\w{0,4}\}?\s*=))"
)
_OTHER_UNITS = r"(?:mm|cm|dm|km|deg|degrees|Grad|kN|mJ|kJ|Ncm|Nmm)(?![A-Za-z])(?:\^\d|²)?"
_AT_END = re.compile(
    rf"(?P<before>[\w)\]}}²³⁴₀-₉'])(?P<gap>{_SPACE})" + _DRESSED.replace("{unit}", _UNIT) + _END
)
_OTHER_AT_END = re.compile(
    rf"(?P<before>[\w)\]}}²³⁴₀-₉'])(?P<gap>{_SPACE})"
    + _DRESSED.replace("{unit}", _OTHER_UNITS)
    + _END
)
_PIECE = rf"{_FONT}\{{\s*(?:kg|rad|N|J|m|s)\s*\}}{_POWER}"
_PIECES = re.compile(rf"{_PIECE}(?:{_BETWEEN}{_PIECE}){{1,5}}")
_FONTS = re.compile(rf"{_FONT}\{{\s*(\w+)\s*\}}")
_NUMBER = r"(?<![\w.])-?\d+(?:\.\d+)?(?:[eE]-?\d+)?"
_GIVEN = re.compile(
    rf"(?P<name>(?<![\w.])\\?[A-Za-z]\w*(?:\{{\w{{1,4}}\}})?)\s*&?\s*:?=\s*(?P<number>{_NUMBER})"
    rf"(?P<gap>{_SPACE})"
    + _DRESSED.replace("{unit}", rf"(?:{_UNIT}|mm|cm|dm|km|gram|g|deg)(?![A-Za-z])")
    + _END
)
_CONVERTED = re.compile(
    rf"(?P<frac>frac\s*)?(?P<number>{_NUMBER}){_SPACE}"
    rf"(?:(?P<a>mm|cm|dm|km|deg)(?![\w(])|{_FONT}\{{\s*(?P<b>mm|cm|dm|km|deg)\s*\}})"
)
_OWN_UNITS = re.compile(r"(?<![\w.\\])(mm|cm|dm|km|deg)\s*=")
_METRES = re.compile(rf"(?P<number>{_NUMBER})[ ]m(?!\w)")
_SYMBOL_OF = re.compile(r",\s*\[\s*\w+\s*\]\s*=\s*[\w ^*·/]{1,12}$")
_WORD_M = re.compile(r"(?<![\w.\\])m(?!\w)")


_NO_NAME = re.compile(r"N\s?[·.]?\s?m(?![A-Za-z])|kg")
"""Units behind a formula that are none of its names."""


def without_units(text: str, entry: str, place: str) -> str:
    """The text without units.

    Args:
        text: as typed.
        entry: what the formula is asked for.
        place: what to put in front of a message.

    Raises:
        ExpressionError: a formula in centimetres or degrees.
    """
    text = _PIECES.sub(lambda found: f"\\mathrm{{{_FONTS.sub(_inside, found[0])}}}", text)
    wanted = next((sizes for pattern, sizes in _ENTRIES if pattern.fullmatch(entry)), set())
    length = wanted == {(1, 0, 0)}
    text = _GIVEN.sub(lambda found: _as_number(found, length), _SYMBOL_OF.sub("", text))
    own = {*_OWN_UNITS.findall(text)}
    text = _CONVERTED.sub(lambda found: _converted(found, "\\" in text, own), text)
    text = _without_units_of_numbers(text, place)
    if wanted == {(1, 0, 0)} and "\\" not in text:
        every = len(_WORD_M.findall(text))
        if (
            every
            and every == len(_METRES.findall(text))
            and not _METRES.sub("", text).endswith("=")
        ):
            text = _METRES.sub(r"\g<number>", text)
    for found in _OTHER_AT_END.finditer(text):
        unit = found["a"] or found["b"] or found["c"] or (found["gap"] and found["d"])
        if unit and not re.search(rf"(?<![\w.\\]){re.escape(unit)}\s*=", text):
            said = N_("the formula is in {unit}; write it in SI units: m, kg, s, rad, N, J")
            raise refused(place, said, unit=unit)
    for found in _AT_END.finditer(text):
        size, sure = _size(unit := _unit(found)), not found["d"] or _NO_NAME.match(unit)
        if wanted and sure and size is not None and size not in wanted:
            said = N_("{unit} is no unit of what is asked for; leave it out, or put it right")
            raise refused(place, said, unit=unit.strip())
    return _AT_END.sub(lambda found: _behind(found, text, wanted), text)


_QUANTITY = re.compile(
    rf"(?P<number>{_NUMBER})[ ]?(?P<unit>kg(?:[ *·]?m(?:\^2|\*\*2|²))?|m/s(?:\^2|\*\*2|²)"
    r"|N(?:[ ]?m)?|m|s|rad)(?![\w/^²(])"
)
_SURE = re.compile(rf"{_NUMBER}[ ]?(?:kg|m/s(?:\^2|\*\*2|²))(?![\w(])")
_NUMBER_ALONE = re.compile(rf"=\s*{_NUMBER}[ ]?[a-zA-Z/^*0-9²]{{1,9}}\s*(?:$|[,;\n])")
_LETTERS_OF_UNITS = re.compile(r"(?<![\w.\\])(?:kg|N|m|s|rad)(?![\w])")


def _without_units_of_numbers(text: str, place: str) -> str:
    """``2 kg * 9.81 m/s^2 * 0.5 m`` as numbers.

    Raises:
        ExpressionError: a letter that is a unit behind numbers and stands elsewhere, too.
    """
    if "\\" in text or not _SURE.search(text) or _NUMBER_ALONE.search(text):
        return text
    plain = _QUANTITY.sub(r"\g<number>", text)
    other = _LETTERS_OF_UNITS.search(plain)
    units = [one["unit"] for one in _QUANTITY.finditer(text)]
    if other and other[0] in units:
        said = N_("{unit}: a unit, or a name? leave the units out")
        raise refused(place, said, unit=other[0])
    return plain


_WRITTEN_OUT = (
    (re.compile(r"\bnew?tons?\b|牛顿?", re.IGNORECASE), "N"),
    (re.compile(r"\bmet(?:er|re)s?\b|米", re.IGNORECASE), "m"),
    (re.compile(r"\b(?:kilograms?|kilogramm|kilos?)\b|千克|公斤", re.IGNORECASE), "kg"),
    (re.compile(r"\bradians?\b|\bradiant\b|弧度", re.IGNORECASE), "rad"),
    (re.compile(r"\bseconds?\b|\bsekunden?\b|秒", re.IGNORECASE), "s"),
    (re.compile(r"\bjoules?\b|焦耳?", re.IGNORECASE), "J"),
    (re.compile(r"\bdegrees?\b|\bgrad\b|°|度", re.IGNORECASE), "deg"),
    (re.compile(r"\\cdot|[·⋅∙•⸱⋆×*~-](?!\d)"), " "),
)
_THOUSANDS = {"k": "1000", "M": "1000000", "m": "0.001", "c": "0.01", "d": "0.1"}
_TURN = "pi/180"


def measured(unit: str) -> tuple[Size | None, str]:
    """The size of a unit as people write it, and what a number in it is to be multiplied with.

    Of what is no unit the size is None.
    """
    plain = unit.replace("**", "^")
    for pattern, short in _WRITTEN_OUT:
        plain = pattern.sub(short, plain)
    plain = plain.replace("%", "?").strip(" .")
    if plain == "deg":
        return (0, 0, 0), f"({_TURN})"
    factor = Decimal(1)
    found = re.match(r"(kN|MN|mN|kJ|mJ|km|cm|mm|dm)(?=m?(?![A-Za-z]))", plain)
    if found:
        factor, plain = Decimal(_THOUSANDS[found[0][0]]), found[0][1:] + plain[found.end() :]
    elif plain == "g":
        factor, plain = Decimal("0.001"), "kg"
    tail = re.search(r"(?<=N)(\s?)(mm|cm)$", plain)
    if tail:
        factor, plain = factor * Decimal(_THOUSANDS[tail[2][0]]), plain[: tail.start()] + "m"
    if not re.fullmatch(r"(?:[A-Za-z]+(?:\s?(?:\^|\*\*)\s?-?\d|[²³]|⁻[¹²])?[\s/]*)+", plain):
        return None, ""
    return _size(plain), f"{factor:f}"


def size_of_name(name: str) -> Size | None:
    """The powers of metre, kilogram and second in what a name is, by its letter."""
    return next((size for pattern, size in _NAMES if pattern.fullmatch(name)), None)


def _inside(found: re.Match[str]) -> str:
    return f" {found[1]}"


def _size(unit: str) -> Size | None:
    """The powers of metre, kilogram and second in a unit; None where its sign is unclear."""
    plain = re.sub(r"\\cdot|\\[,;:! ]|~", " ", unit)
    plain = plain.replace("²", "^2").replace("³", "^3").replace("⁻¹", "^-1").replace("⁻2", "^-2")
    total, sign = [0, 0, 0], 1
    for piece in re.finditer(r"/|([A-Za-z]+)\s?(?:(?:\^|\*\*)\s?\{?\s*(-?\d))?", plain):
        if piece[0] == "/":
            if sign < 0:
                return None
            sign = -1
            continue
        size = _SIZES.get(piece[1])
        if size is None:
            return None
        for k in range(3):
            total[k] += sign * size[k] * int(piece[2] or 1)
    return total[0], total[1], total[2]


def _unit(found: re.Match[str]) -> str:
    return next(found[name] for name in "abcd" if found[name])


def _behind(found: re.Match[str], text: str, wanted: set[tuple[int, int, int]]) -> str:
    """A formula's end without its unit, if that is the unit of what is asked for."""
    unit = _unit(found)
    bare = bool(found["d"])
    if _size(unit) not in wanted or (bare and not found["gap"]):
        return found[0]
    if bare and "\\" in text and not re.search(r"kg|N", unit):
        return found[0]  # in LaTeX a letter is a name
    if re.fullmatch(r"[A-Za-z]", unit):
        elsewhere = text[: found.start("gap")] + text[found.end() :]
        if re.search(rf"(?<![A-Za-z\\]){unit}(?![\w])", elsewhere.partition("=")[2] or elsewhere):
            return found[0]
    return found["before"]


_OF_TABLE = re.compile(r"[ad]_?\{?\d\}?")
"""A length of a row of the table: no mass is taken a2 times."""


def _as_number(found: re.Match[str], length: bool) -> str:
    """``l1 = 50 cm`` as ``l1 = 0.5``; a unit that the name's letter does not have stays.

    ``h = 2 m`` may be two masses, unless the whole is a length.
    """
    unit, name = _unit(found), found["name"].lstrip("\\")
    wanted = size_of_name(name)
    of_table = _OF_TABLE.fullmatch(name) or name[0] in "lLg"
    if wanted is None or (found["d"] == "m" and not length and not of_table):
        return found[0]
    if unit == "deg":
        number = rf"{found['number']}*pi/180" if wanted == (0, 0, 0) else ""
        return f"{found['name']} = {number}" if number else found[0]
    other = _OTHERS.get(unit)
    if other:
        size, factor = other
        number = f"{Decimal(found['number']) * factor:f}"
    else:
        size, number = _size(unit) or (9, 9, 9), found["number"]
    return f"{found['name']} = {number}" if size == wanted else found[0]


def _converted(found: re.Match[str], typeset: bool, own: set[str]) -> str:
    """``50 cm`` as ``0.5``; letters that LaTeX or the writer has for names stay."""
    unit = found["a"] or found["b"]
    if found["frac"] or (found["a"] and (typeset or unit in own)):
        return found[0]
    if unit == "deg":
        pi = r"\pi" if typeset else "pi"
        return f"({found['number']}*{pi}/180)"
    return f"{Decimal(found['number']) * _OTHERS[unit][1]:f}"
