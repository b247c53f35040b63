r"""What books call entries of quantities that have a long name: x_2, y_{c2}, \dot M_{12}, J_v.

A row of the table has places of a quantity, counted from 1, and the names that may stand in front
of a formula for them. A name of other places is none of them.
"""

from __future__ import annotations

import re
from functools import lru_cache
from typing import NamedTuple

_CENTRE = "(?:c|C|g|G|s|S|m|com|COM|cm|CM|cg|CG|sp|SP)"
"""What stands below a centre of mass: of the centre, of gravity, of the Schwerpunkt."""
_LINEAR = "(?:v|V|p|P|l|L|lin|pos|xyz)"
_ANGULAR = "(?:w|W|omega|o|O|r|R|rot|ang)"
_LAST = r"(?:e|E|ee|EE|tcp|TCP|tool|n|(?<=0)\d)"
"""What stands below a pose of the tool; of a number it is asked whether it is the last joint's."""
_POINT = "(?:[pPrdt](?:0?(?:e|E|ee|EE|tcp|TCP|tool|n))?|pos|position|[xX]e)"
_TABLE = (
    (r"dh_poses (?P<k>\d),(?P<x>[123]),4", "[pPord]?<x>0?<k>|[pPord]0?<k><x>"),
    (r"dh_poses (?P<k>\d),:[23],4", "[pPOordt]0?<k>"),
    (r"dh_poses (?P<k>\d),:[23],:[23]", "R0?<k>"),
    (r"dh_poses 1", "[TH]0?1|A0?1"),
    (r"dh_poses (?P<k>\d)", "[TH]0?<k>|A0<k>"),
    (r"link_transforms (?P<k>\d)", "[TAH]<before><k>|A<k>"),
    (
        r"com_positions (?P<k>\d),(?P<x>[123])",
        f"[prscPR]?<x>{_CENTRE}?<k>|[prscPR]{_CENTRE}?<k><x>",
    ),
    (r"com_positions (?P<k>\d)(?:,:[23])?", f"[prscPR]{_CENTRE}?<k>"),
    (r"christoffel (?P<i>\d),(?P<j>\d),(?P<k>\d)", "(?:[DdcC]|Gamma)(?:<i>(?:<j><k>|<k><j>))?"),
    (r"mass_matrix_dot (?P<i>\d),(?P<j>\d)", "[MDHBmdb]dot<i><j>"),
    (r"mass_matrix_dot", "[MDHB]dot"),
    (r"jacobian_dot (?P<i>\d),(?P<j>\d)", "Jdot<i><j>"),
    (r"jacobian_dot", "Jdot"),
    (r"fk", rf"[TAH](?:0?{_LAST})?"),
    (r"fk :[23],4", rf"{_POINT}|[pPdo]0\d"),
    (r"fk :[23],:[23]", rf"R(?:0?{_LAST})?"),
    (r"(?:planar_)?jacobian(?:_tool)? (?P<x>[123])", f"J{_LINEAR}?<x>"),
    (r"jacobian(?:_tool)? 4,(?P<k>\d)", f"J{_ANGULAR}[x1]<k>"),
    (r"jacobian(?:_tool)? 5,(?P<k>\d)", f"J{_ANGULAR}[y2]<k>"),
    (r"jacobian(?:_tool)? 6,(?P<k>\d)", f"J{_ANGULAR}[z3]<k>"),
    (r"jacobian(?:_tool)? 4", f"J{_ANGULAR}x"),
    (r"jacobian(?:_tool)? 5", f"J{_ANGULAR}y"),
    (r"planar_jacobian 3", f"J(?:{_ANGULAR}z?|phi)"),
    (r"jacobian(?:_tool)? 6", f"J(?:{_ANGULAR}z?|phi)"),
    (r"(?:planar_)?jacobian(?:_tool)? :[23]", f"J(?:{_LINEAR}|xy)?"),
    (r"jacobian(?:_tool)? 4:6?", f"J{_ANGULAR}"),
    (r"(?:planar_)?jacobian(?:_tool)? :,(?P<k>\d)", "J<k>"),
    (r"(?:planar_)?jacobian(?:_tool)? :[23],(?P<k>\d)", f"J{_LINEAR}?<k>"),
    (r"jacobian(?:_tool)? 4:6?,(?P<k>\d)", f"J{_ANGULAR}<k>"),
    (r"fivebar_jacobian (?P<k>\d)", "J<k>"),
    (r"fivebar_leg_angles", "theta|q|alpha|phi"),
    (r"fk (?P<x>[123]),4", "p?<x>(?:e|E|ee|EE|tcp|TCP|tool)?"),
)
"""Quantities with their places, and what books call these."""
_ROWS = tuple((re.compile(asked), names) for asked, names in _TABLE)
_ANY = {"x": "[xyz]", **dict.fromkeys(("i", "j", "k", "before"), r"\d")}
_FIELD = re.compile(r"<(\w+)>")


def is_named(name: str, asked: str) -> bool:
    """Whether a plain name is one that books have for places of a quantity.

    Args:
        name: as :func:`plain_name` or the reader of names has it: ``yc2``, ``Mdot12``.
        asked: the quantity and its places from 1: ``"com_positions 2,2"``, ``"fk :3,4"``.
    """
    pattern = _of(asked)
    return pattern is not None and bool(pattern.fullmatch(name.replace("_", "")))


def is_named_elsewhere(name: str, asked: str) -> bool:
    """Whether a plain name is one that books have for other places of the same quantity."""
    plain, (quantity, *places) = name.replace("_", ""), asked.split(" ")
    if not places or is_named(name, asked):
        return False
    return any(pattern.fullmatch(plain) for pattern in _family(quantity))


@lru_cache(maxsize=64)
def _family(quantity: str) -> tuple[re.Pattern[str], ...]:
    """What books call any places of a quantity."""
    own = (names for asked, names in _TABLE if re.match(f"{asked.partition(' ')[0]}$", quantity))
    return tuple(re.compile(_FIELD.sub(lambda field: _ANY[field[1]], names)) for names in own)


@lru_cache(maxsize=256)
def _of(asked: str) -> re.Pattern[str] | None:
    for pattern, names in _ROWS:
        found = pattern.fullmatch(asked)
        if found is None:
            continue
        told = {key: str(value) for key, value in found.groupdict().items()}
        if "x" in told:
            told["x"] = "xyz"[int(told["x"]) - 1]
        if "k" in told:
            told["before"] = str(int(told["k"]) - 1)
        for field, value in told.items():
            names = names.replace(f"<{field}>", value)
        return re.compile(names)
    return None


_FONT = re.compile(
    r"\\(?:mathbf|mathrm|mathcal|mathit|boldsymbol|bm|vec|text|textrm|operatorname)(?![A-Za-z])"
)
_OF_STATE = re.compile(r"\s*\([^()]*[A-Za-zθ][^()]*\)\s*$")
_DOT = re.compile(r"\\dot(?![A-Za-z])\s*|\\dot(?=\s*\{)")
_BY_TIME = re.compile(
    r"\\[dt]?frac\s*\{\s*(?:\\mathrm\{d\}|d)\s*(?P<a>[^{}]*(?:\{[^{}]*\})?)\s*\}\s*"
    r"\{\s*(?:\\mathrm\{d\}|d)\s*t\s*\}\s*(?P<b>[^/]*)|d\s*(?P<c>[^/=]{1,12})/\s*d\s*t"
)
_RATE = re.compile(
    r"(?:(?P<dotted>[MDHBJ]|[mdb](?=dot\d\d))(?:dot|\u0307)|dot(?P<behind>[MDHBJ]|[mdb](?=\d\d))"
    r"|d(?P<by>[MDHBJ])(?:dt)?(?=\d|$))(?P<places>\d\d|)"
)
_JACOBIAN = re.compile(r"J(?:(?:omega|ω)([xyz]?\d?)|(?:var)?(?:phi|φ|theta|θ))")
_AXIS_LAST = re.compile(rf"[prsPR]({_CENTRE}?)(\d)([xyz])")
_END = r"(?P<end>\{?(?:\d|[eEn]|ee|EE|tcp|TCP)\}?)"
_LETTER = r"\\?\{?(?P<letter>[RTAHpPdo])\}?"
_ABOVE = r"\^\{?(?P<base>\d)\}?"
_BELOW = rf"_{_END}"
_IN_FRAMES = tuple(
    re.compile(rf"(?:\{{\}})?{one}")
    for one in (
        rf"{_LETTER}{_ABOVE}{_BELOW}",
        rf"{_LETTER}{_BELOW}{_ABOVE}",
        rf"{_LETTER}_\{{?(?P<base>0)\}}?\^{_END}",
        rf"{_ABOVE}{_LETTER}_?{_END}",
        rf"{_ABOVE}{_BELOW}{_LETTER}",
        rf"{_BELOW}{_ABOVE}{_LETTER}",
    )
)
"""A pose of a frame in another one, as Craig and others write it: ``{}^2_3T``, ``T_3^2``."""
_CHRISTOFFEL = re.compile(r"(?:Gamma|Γ)(\d)(\d)(\d)")
_LONGEST = 80


def plain_name(text: str) -> str:
    r"""The plain name of a left side that has more on it than letters and one subscript.

    ``\dot M_{12}`` and ``dM_{12}/dt`` are Mdot12, ``J_\omega`` is Jw, ``p_{c2,y}`` is yc2; empty
    of any other.
    """
    if len(text) > _LONGEST:
        return ""
    text = _BY_TIME.sub(lambda m: f"dot {m['a'] or m['b'] or m['c']}", text)
    dotted = _DOT.sub("dot", _FONT.sub("", _OF_STATE.sub("", text)))
    plain = re.sub(r"\\[,;! ]|[\s_{}\\,$&]", "", dotted.translate(_SMALL))
    if found := _RATE.fullmatch(plain):
        return f"{found['dotted'] or found['behind'] or found['by']}dot{found['places']}"
    if found := _JACOBIAN.fullmatch(plain):
        return "Jphi" if found[1] is None else f"Jw{found[1]}"
    if found := _AXIS_LAST.fullmatch(plain):
        return f"{found[3]}{found[1]}{found[2]}"
    spaceless = re.sub(r"\s", "", dotted.translate(_SMALL))
    for pattern in _IN_FRAMES:
        if found := pattern.fullmatch(spaceless):
            return f"{found['letter']}{found['base']}{found['end'].strip('{}')}"
    found = _CHRISTOFFEL.fullmatch(plain)
    return f"Gamma{found[1]}{found[2]}{found[3]}" if found else ""


_SMALL = str.maketrans("₀₁₂₃₄₅₆₇₈₉", "0123456789") | {ord("Ṁ"): "Mdot", ord("Ḋ"): "Ddot"}


_FRAME = r"\{?\s{0,2}(\w)\s{0,2}\}?"
_POSE = r"\\?\{?\s{0,2}[TRAHpPdo]\s{0,2}\}?"
_FRAMES = (
    rf"\{{?\s{{0,2}}\}}?\s{{0,2}}(?:\^{_FRAME}_{_FRAME}|_{_FRAME}\^{_FRAME})\s{{0,2}}{_POSE}",
    rf"\{{?\s{{0,2}}\}}?\s{{0,2}}\^{_FRAME}\s{{0,2}}{_POSE}_{_FRAME}",
    rf"{_POSE}(?:\^{_FRAME}_{_FRAME}|_{_FRAME}\^{_FRAME})\s{{0,2}}(?:\(|$)",
    rf"{_POSE}_?\{{?(0)(\d)\}}?\s{{0,2}}(?:\(|$)",
)
_WITH_FRAMES = re.compile("|".join(_FRAMES))
_CRAIGS = re.compile("|".join(_FRAMES[:2]))
_OF_THE_TOOL = re.compile(r"fk(?:\[.*)?|[TR]\d\d")


class LastJoint(NamedTuple):
    """The last joint of an arm: its number, and whether its frame in the table is the tool's."""

    number: int
    is_tool: bool


def _is_of_other_frames(left: str, entry: str, last: LastJoint) -> bool:
    """Whether a left side has the frames of another pose than the tool's in the base."""
    frames = _frames(_WITH_FRAMES, left, entry)
    return bool(frames) and frames not in ({"0", str(last.number)}, {"0", str(last.number + 1)})


def is_craigs_last(left: str, entry: str, last: LastJoint) -> bool:
    r"""Whether a left side is the last frame in Craig's writing, and that is not the tool's.

    ``T_3^0`` is said of standard tables as well, whose last frame is at the far end of its link;
    ``{}^0_3T`` of Craig's, whose last frame lies in its joint.

    Args:
        left: as typed.
        entry: what the formula is asked for; nothing but the tool's pose is looked at.
        last: of the arm.
    """
    return not last.is_tool and _frames(_CRAIGS, left, entry) == {"0", str(last.number)}


_IN_ITS_AXES = re.compile(
    r"(?:\{\s{0,3}\}\s{0,3})?\^\s{0,3}(?:\{\s{0,3}(?P<braced>\w)\s{0,3}\}|(?P<plain>\w))\s{0,3}"
    r"(?=(?:\\\w{1,12}\s{0,3}\{\s{0,3})?J(?![A-Za-z]))"
)


def without_its_axes(text: str, entry: str, last: LastJoint) -> str:
    r"""The tool's Jacobian without the frame it is in: ``{}^3J`` of two joints is in the tool's.

    Args:
        text: as typed.
        entry: what the formula is asked for; nothing but that Jacobian is looked at.
        last: of the arm.
    """
    own = (str(last.number), str(last.number + 1), "n", "N", "e", "E", "T")
    found = _IN_ITS_AXES.search(text) if entry.startswith("jacobian_tool") else None
    if found is None or (found["braced"] or found["plain"]) not in own:
        return text
    return _IN_ITS_AXES.sub("", text, count=1)


def _frames(written: re.Pattern[str], left: str, entry: str) -> set[str]:
    """The numbers of the frames that a left side has, where the tool's pose is asked for."""
    found = written.match(_FONT.sub("", left.strip("& $"))[:_LONGEST])
    if found is None or not _OF_THE_TOOL.fullmatch(entry):
        return set()
    frames = {x for x in found.groups() if x is not None}
    return frames if all(one.isdigit() for one in frames) else set()


_TRANSPOSE = re.compile(
    r"\^\s{0,2}\{?\s{0,2}(?:\\top|\\intercal|T|\\mathrm\s*\{?T\}?)\s{0,2}\}?|\.T$|['’]$"
)
_OF_JACOBIAN = re.compile(
    rf"(?:\{{?\s{{0,2}}\}}?\s{{0,2}}\^{_FRAME}\s{{0,2}}\\?\{{?\s{{0,2}}J"
    rf"|\\?\{{?J\}}?\s{{0,2}}\^\{{?\(?\s{{0,2}}([0-9BbEeSs])\s{{0,2}}\)?\}}?"
    r"|\\?\{?J\}?_\{?\s{0,2}((?:body|[bBsS]|spatial))\s{0,2}\}?)\s{0,2}(?:\(|$|_)"
)
_ITS_ENTRY = re.compile(r"J(?:\d|$)|jacobian(?!_dot)|planar_jacobian")
_TOOLS = {"e", "E", "b", "B", "n", "body"}


def _is_another_jacobian(left: str, entry: str, last: LastJoint) -> bool:
    """Whether a left side is the transpose of a Jacobian, or one in other axes."""
    plain = _FONT.sub("", left.strip("& $"))[:_LONGEST].strip()
    if not _ITS_ENTRY.match(entry):
        return False
    if _TRANSPOSE.search(plain):
        return True
    found = _OF_JACOBIAN.match(plain)
    frame = next((x for x in found.groups() if x), "") if found else ""
    tool = frame in _TOOLS or frame in (str(last.number), str(last.number + 1))
    spatial = frame in ("s", "S", "spatial")
    if entry.startswith("jacobian_tool"):
        return bool(frame) and not tool
    if entry.startswith("jacobian_spatial"):
        return bool(frame) and not (spatial or frame == "0")
    return bool(frame) and frame != "0"


_BY_JOINT = r"(?:q|th|theta|\\theta|θ|\\vartheta|\\varphi)_?\{?(?P<k>\d)\}?"
_OF_WHAT = (
    r"(?P<what>[VUPxyz]|E_?\{?p\w{0,2}\}?)"
    r"(?:_?\{?(?:[cCgGsS]_?\{?)?(?P<link>\d)\}{0,2}|_\{?(?:e|E|ee|tcp|n)\}?)?"
)
_PARTIAL = r"(?:∂|\\partial|\\mathrm\{d\}|d)"
_SLOPE = re.compile(
    rf"(?:\\[dt]?frac\{{{_PARTIAL}{_OF_WHAT}\}}\{{{_PARTIAL}{_BY_JOINT}\}}"
    rf"|{_PARTIAL}{_OF_WHAT.replace('?P<what>', '?P<a>').replace('?P<link>', '?P<b>')}"
    rf"/{_PARTIAL}{_BY_JOINT.replace('?P<k>', '?P<c>')})"
)
_PLACES_OF = re.compile(r"(gravity_torques|(?:planar_|com_)?jacobians?)\[([\d,\s]+)\]")


def _with_places(entry: str) -> str:
    """``jacobian[0,1]`` of J12, ``gravity_torques[1]`` of g2."""
    found = re.fullmatch(r"([gJ])(\d)(\d?)", entry)
    if found is None or (found[1] == "g") is bool(found[3]):
        return entry
    places = ",".join(str(int(k) - 1) for k in found.groups()[1:] if k)
    return f"{'gravity_torques' if found[1] == 'g' else 'jacobian'}[{places}]"


def is_another_slope(side: str, entry: str) -> bool:
    r"""Whether a side is the derivative of another coordinate, or by another joint.

    ``\frac{\partial y}{\partial q_2}`` is entry 2, 2 of the Jacobian and no other.

    Args:
        side: of an equation, as typed.
        entry: what the formula is asked for.
    """
    plain = re.sub(r"\s|\\[,;! ]", "", side.strip("& $"))[:_LONGEST]
    found, asked = _SLOPE.fullmatch(plain), _PLACES_OF.fullmatch(_with_places(entry))
    if found is None or asked is None:
        return False
    what, link, joint = (
        found[x] or found[y] for x, y in (("what", "a"), ("link", "b"), ("k", "c"))
    )
    places = [int(k) + 1 for k in asked[2].split(",")]
    if asked[1] == "gravity_torques":
        return what in "xyz" or places != [int(joint)]
    if what not in "xyz":
        return True
    row = ["xyz".index(what) + 1, int(joint)]
    if asked[1] == "com_jacobians":
        return places[1:] != row or link != str(places[0])
    return places != row


def is_another(left: str, entry: str, last: LastJoint) -> bool:
    r"""Whether a left side is another pose than the tool's in the base, or another Jacobian.

    ``{}^0_2T`` and ``T_2^0`` are right of an arm of two joints, and ``{}^0_3T`` where the tool has
    a frame of its own; ``{}^1_2T`` is another pose. ``{}^2J`` is right of the tool's axes alone,
    and ``J^T`` is no Jacobian.

    Args:
        left: as typed.
        entry: what the formula is asked for.
        last: of the arm.
    """
    pose = _is_of_other_frames(left, entry, last)
    return pose or _is_another_jacobian(left, entry, last)
