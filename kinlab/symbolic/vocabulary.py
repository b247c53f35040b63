"""What the numbers of a DH table are called in formulas: l1, m1, lc1, I1, a2, d4, g.

A planar arm (parallel axes, no offsets) gets the textbook's names: l_i from joint i to the next
(or the tool), lc_i from joint i to the centre of mass, I_i about the centre of mass. Any other
arm gets the table's own: a_i, d_i with the index the convention prints (a modified table's row
i holds a_{i-1}), (cx, cy, cz)_i, Ixx_i ... in DH frame i. Both: m_i, Ia_i (armature), g.
"""

from __future__ import annotations

from dataclasses import dataclass, field
from fractions import Fraction

import numpy as np

from kinlab.model.dh import DHLink, DHTable
from kinlab.model.link import Convention
from kinlab.tolerances import TOLERANCES

Linear = tuple[tuple[Fraction, str], ...]
"""A sum of multiples of names; the empty name is the number 1."""

_AXES = "xyz"


@dataclass
class Vocabulary:
    """Names and their values, and each entry of the table written with them.

    Attributes:
        values: what each name stands for, SI units.
        entries: entry of the table, such as ``"a2"`` or ``"com1x"``, as a sum of names.
            Rows are numbered from 1 as they stand in the table.
        others: names by which books call what has another name here, or is zero: ``lc1`` is
            l1/2 of a rod, ``I1`` nothing where all the mass is in one point.
    """

    values: dict[str, float] = field(default_factory=dict)
    entries: dict[str, Linear] = field(default_factory=dict)
    others: dict[str, Linear] = field(default_factory=dict)

    def put(self, entry: str, name: str, value: float, sign: int = 1) -> None:
        """Calls an entry ``sign`` times ``name``; an entry of zero stays zero."""
        if value == 0.0:
            self.entries[entry] = self.others[name] = ()
            return
        self.values[name] = sign * value
        self.entries[entry] = ((Fraction(sign), name),)


def exact(value: float) -> Fraction:
    """The decimal number that prints as ``value``: 0.1 is one tenth."""
    return Fraction(repr(float(value)))


def is_planar(table: DHTable) -> bool:
    """Whether all joints are revolute about parallel axes and everything lies in one plane."""
    still = all(
        link.joint == "revolute" and link.alpha == 0.0 and link.d == 0.0 for link in table.links
    )
    coms = np.array([link.com for link in table.links])
    tensors = np.array([link.inertia for link in table.links])
    cross = np.abs(tensors[:, [0, 0, 1], [1, 2, 2]])
    flat = not np.any(coms[:, 1:]) and not np.any(cross)
    tool = np.asarray(table.tool)
    straight = np.array_equal(tool[:3, :3], np.eye(3)) and not np.any(tool[1:3, 3])
    first = table.convention is Convention.STANDARD or table.links[0].a == 0.0
    behind = table.convention is Convention.MODIFIED or not np.any(tool[:3, 3])
    return bool(still and flat and straight and first and behind)


def vocabulary(table: DHTable) -> Vocabulary:
    """Names every number of the table that is not zero.

    Args:
        table: the table.

    Returns:
        The names, their values, and the entries written with them.
    """
    words = Vocabulary()
    if is_planar(table):
        _planar_lengths(words, table)
    else:
        _spatial_lengths(words, table)
    for i, link in enumerate(table.links, 1):
        words.put(f"mass{i}", f"m{i}", link.mass)
        words.put(f"armature{i}", f"Ia{i}", link.armature)
    gravity = np.asarray(table.gravity)
    along = np.flatnonzero(gravity)
    for k, axis in enumerate(_AXES):
        if len(along) == 1:
            words.put(f"gravity{axis}", "g", gravity[k], -1 if gravity[k] < 0 else 1)
        else:
            words.put(f"gravity{axis}", f"g{axis}", gravity[k])
    for which, suffix in (("base", "b"), ("tool", "t")):
        offset = np.asarray(getattr(table, which))[:3, 3]
        for k, axis in enumerate(_AXES):
            if f"{which}{axis}" not in words.entries:
                words.put(f"{which}{axis}", f"{axis}{suffix}", offset[k])
    if not is_planar(table):
        _of_books(words, table)
    return words


def _planar_lengths(words: Vocabulary, table: DHTable) -> None:
    modified = table.convention is Convention.MODIFIED
    for i, link in enumerate(table.links, 1):
        words.entries[f"d{i}"] = ()
        if modified:
            last = i == table.n
            length = float(np.asarray(table.tool)[0, 3]) if last else table.links[i].a
            words.put("toolx" if last else f"a{i + 1}", f"l{i}", length)
            words.entries.setdefault("a1", ())
            centre, behind = float(np.asarray(link.com)[0]), 0.0
        else:
            length = link.a
            words.put(f"a{i}", f"l{i}", length)
            centre, behind = float(np.asarray(link.com)[0]) + length, length
        from_joint = _centre(words, i, centre, length)
        words.others |= dict.fromkeys((f"lc{i}", f"lg{i}", f"r{i}"), from_joint)
        minus = ((Fraction(-1), f"l{i}"),) if behind else ()
        words.entries[f"com{i}x"] = _add(from_joint, minus)
        words.entries[f"com{i}y"] = words.entries[f"com{i}z"] = ()
        tensor = np.asarray(link.inertia)
        for k, axis in enumerate(_AXES):  # only the moment about z can be felt
            words.entries[f"inertia{i}{axis}{axis}"] = ((exact(tensor[k, k]), ""),)
        words.put(f"inertia{i}zz", f"I{i}", tensor[2, 2])
        moment = words.entries[f"inertia{i}zz"]
        words.others |= dict.fromkeys((f"I{i}", f"Izz{i}", f"Iz{i}", f"J{i}"), moment)
        for pair in ("xy", "xz", "yz"):
            words.entries[f"inertia{i}{pair}"] = ()


def _centre(words: Vocabulary, i: int, centre: float, length: float) -> Linear:
    """The centre's distance from joint i as l_i, l_i/2, or a name of its own."""
    for part in (Fraction(1), Fraction(1, 2)):
        if length and _is_part(centre, part, length):
            return ((part, f"l{i}"),)
    if abs(centre) <= TOLERANCES.same_length * abs(length):
        return ()
    words.values[f"lc{i}"] = centre
    return ((Fraction(1), f"lc{i}"),)


def _is_part(value: float, part: Fraction, length: float) -> bool:
    """Whether a number is a part of a length, but for how decimals are kept."""
    return bool(abs(value - part * length) <= TOLERANCES.same_length * abs(length))


def _spatial_lengths(words: Vocabulary, table: DHTable) -> None:
    before = 1 if table.convention is Convention.MODIFIED else 0
    for i, link in enumerate(table.links, 1):
        words.put(f"a{i}", f"a{i - before}", link.a)
        words.put(f"d{i}", f"d{i}", link.d)
        _inertial(words, i, link)


def _of_books(words: Vocabulary, table: DHTable) -> None:
    """What books call lengths, centres and moments of an arm that is not planar."""
    before = 1 if table.convention is Convention.MODIFIED else 0
    if before and words.entries["toolx"]:
        words.others[f"a{table.n}"] = words.entries["toolx"]
    for (i, link), axis in zip(enumerate(table.links, 1), _about(table), strict=True):
        behind = f"a{i + before}" if i + before <= table.n else "toolx"
        _rod(words, i, link, behind)
        _as_in_books(words, i, link, behind, before)
        moment = words.entries[f"inertia{i}{axis}{axis}"] if axis else ()
        if moment:
            words.others |= dict.fromkeys((f"I{i}", f"J{i}"), moment)


def _rod(words: Vocabulary, i: int, link: DHLink, along: str) -> None:
    """The centre of a link in the middle of its length: it is called so, and has no other name."""
    length, com = words.entries[along], np.asarray(link.com)
    if len(length) != 1 or not com[0] or com[1:].any():
        return
    ((_one, name),) = length
    for share in (Fraction(1, 2), Fraction(-1, 2)):
        if _is_part(com[0], share, words.values[name]):
            words.values.pop(f"cx{i}")
            words.entries[f"com{i}x"] = words.others[f"cx{i}"] = ((share, name),)


def _about(table: DHTable) -> list[str]:
    """The axis of each link's frame about which the link turns, where it is always the same one.

    Empty where it is none: hinges that are not parallel, a frame that stands askew.
    """
    modified = table.convention is Convention.MODIFIED
    turn, hinges, frames = np.eye(3), [], []
    for link, transform in zip(table.links, table.link_transforms(np.zeros(table.n)), strict=True):
        before, turn = turn, turn @ transform[:3, :3]
        if link.joint == "revolute":
            hinges.append((turn if modified else before)[:, 2])
        frames.append(turn)
    parallel = hinges and all(
        np.linalg.norm(np.cross(hinges[0], one)) <= TOLERANCES.right_angle for one in hinges
    )
    if not parallel:
        return [""] * table.n
    along = [np.abs(frame.T @ hinges[0]) for frame in frames]
    return [
        _AXES[int(np.argmax(one))] if 1.0 - np.max(one) <= TOLERANCES.right_angle else ""
        for one in along
    ]


def _inertial(words: Vocabulary, i: int, link: DHLink) -> None:
    com, tensor = np.asarray(link.com), np.asarray(link.inertia)
    for k, axis in enumerate(_AXES):
        words.put(f"com{i}{axis}", f"c{axis}{i}", com[k])
        for m in range(k, 3):
            pair = axis + _AXES[m]
            words.put(f"inertia{i}{pair}", f"I{pair}{i}", tensor[k, m])


def _as_in_books(words: Vocabulary, i: int, link: DHLink, behind: str, modified: int) -> None:
    """l_i, lc_i and I_i of a link, where only one number of the table can be meant."""
    length = [words.entries[name] for name in (behind, f"d{i}") if words.entries.get(name)]
    centre = [words.entries[f"com{i}{axis}"] for axis in _AXES if words.entries[f"com{i}{axis}"]]
    parallel = not modified and abs(np.sin(link.alpha)) <= TOLERANCES.right_angle
    if link.joint == "revolute" and (len(length) == 1 or (length and parallel and link.a)):
        words.others[f"l{i}"] = length[0]
    along = () if modified else words.entries[f"a{i}"]
    if len(centre) == 1 and (modified or centre[0] == words.entries[f"com{i}x"] or not length):
        from_joint = _add(along, centre[0]) if along else centre[0]
        words.others |= dict.fromkeys((f"lc{i}", f"lg{i}", f"r{i}"), from_joint)
        if not length:
            words.others[f"l{i}"] = from_joint
    moments = {words.entries[f"inertia{i}{axis}{axis}"] for axis in _AXES} - {()}
    if len(moments) == 1:
        words.others |= dict.fromkeys((f"I{i}", f"J{i}"), moments.pop())


def _add(one: Linear, two: Linear) -> Linear:
    total: dict[str, Fraction] = {}
    for factor, name in (*one, *two):
        total[name] = total.get(name, Fraction(0)) + factor
    return tuple((factor, name) for name, factor in total.items() if factor)
