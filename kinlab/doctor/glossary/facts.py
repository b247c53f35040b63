"""What is true of an arm, or of a five-bar: which way it hangs, what slides, where its centres are.

Who hands a formula in says such things beside it. True ones say nothing new.
"""

from __future__ import annotations

import re
from collections.abc import Callable, Iterable
from dataclasses import dataclass, replace
from functools import cached_property

import numpy as np

from kinlab.arrays import Array
from kinlab.check.quantities.special import jacobian_determinant
from kinlab.doctor.changes import Mechanism, table_of
from kinlab.errors import KinlabError
from kinlab.fivebar import FiveBar
from kinlab.formulas.language.clauses import Claim, Holds, arms_named
from kinlab.model.dh import DHTable
from kinlab.model.link import FRICTION, Convention
from kinlab.model.robot import Robot
from kinlab.symbolic.vocabulary import is_planar, vocabulary
from kinlab.tolerances import TOLERANCES

_UP = {"up", "upward", "upwards", "upright", "oben", "aufwärts", "向上", "竖直向上", "朝上"}
_DOWN = {"down", "downward", "downwards", "unten", "abwärts", "向下", "竖直向下", "朝下"}
_LEVEL = {"horizontal", "horizontalen", "waagerechten", "水平", "水平面"}
_HALF = {"half", "hälfte", "halbe", "halber", "halben", "一半", "半", "half-distance"}
_CRANKS = {"crank", "cranks", "driving", "driven", "active", "proximal", "inner", "kurbel"}
_CRANKS |= {"kurbeln", "曲柄", "主动", "主动杆"}
_RODS = {
    "rod",
    "rods",
    "stäbe",
    "distal",
    "passive",
    "outer",
    "coupler",
    "koppel",
    "koppeln",
    "从动",
    "被动",
    "从动杆",
}
_BETWEEN = {"between", "zwischen", "之间", "夹角"}
_WHOLE = {"full", "whole", "gesamte", "volle"}
_BEFORE = {"previous", "preceding", "before", "vorigen", "前"}
_DISTANCE = {"distance", "distances", "abstand", "abstände", "距离"}
_TOOL = {"tool", "tip", "tcp", "effector", "end-effector", "hand", "flange", "werkzeug"}
_TOOL |= {"werkzeugspitze", "endeffektor", "末端", "末端执行器", "工具"}
_SLIDING = {"stroke", "prismatic", "行程"}
_AXES = {"axes", "gelenkachsen", "achsen", "轴"}
_NEGATIVE = {"negative", "minus", "negativer", "negativen", "负"}
_SIGNS = {"signed", "sign", "signs", "vorzeichen", "minuszeichen", "符号", "正负号", "负号", "正号"}
_NUMBER = re.compile(r"(\d+(?:\.\d+)?)(?:\s*(?:m|kg|rad|kg\s?m\^?2|m/s\^?2))?")
_PLAIN = re.compile(r"\^\{?\\circ\}?")
_ANGLE = re.compile(
    r"(?P<times>\d+|[kn])?(?P<pi>pi)(?:/(?P<part>\d))?|(?P<degrees>\d+(?:\.\d+)?)°|0"
)
_OF_EACH = ("always", "independent", "units", "mass", "zero_level")
"""Kinds of claims that are true of every arm."""


def holding(mechanism: Mechanism) -> Holds:
    """Whether claims are true of an arm or a five-bar; None where that is not known.

    Args:
        mechanism: whose formulas they stand beside.
    """
    if isinstance(mechanism, FiveBar):
        return _of_five_bar
    table = table_of(mechanism)
    facts = None if table is None else _Facts(table)
    own = arms_named(mechanism.name)

    def holds(claim: Claim) -> bool | None:
        if claim.kind == "right_sign":
            return _is_right_sign(claim)
        if claim.kind == "arm":
            return bool(own & claim.words) if own else None
        if claim.kind in _OF_EACH:
            return _is_of_joint_one(claim) if claim.kind == "zero_level" else _is_own(claim)
        known = getattr(facts, claim.kind, None)
        return None if known is None else known(claim)

    return holds


def _of_five_bar(claim: Claim) -> bool | None:
    if claim.kind in ("always", "independent", "units", "either_sign"):
        return True
    if claim.kind == "right_sign":
        return _is_right_sign(claim)
    if claim.kind == "base_pins":
        whole = "2" in claim.words
        return whole != bool(claim.words & _HALF)
    if claim.kind == "cranks":
        cranks, rods = bool(claim.words & _CRANKS), bool(claim.words & _RODS)
        if cranks == rods:
            return None
        return set(claim.names) == ({"l1"} if cranks else {"l2"})
    return None


def _is_of_joint_one(claim: Claim) -> bool | None:
    return True if all(number == 1 for _kind, number in claim.refs) else None


def _is_right_sign(claim: Claim) -> bool | None:
    """Of the sign that stands there it is said; of a sign that ought to be another it may be."""
    return True if len(claim.words & _SIGNS) == 1 else None


def _is_own(claim: Claim) -> bool | None:
    """Whether the numbers in it are those of its names: m2 of link 2; of several one by one."""
    own = [int(found) for name in claim.names for found in re.findall(r"\d", name)]
    told = [number for _kind, number in claim.refs]
    if len(told) > 1 and len(told) == len(own) == len(claim.names):
        return told == own
    return {*told} <= {*own} if own or not told else None


@dataclass(frozen=True, eq=False)
class _Facts:
    """What is known of an arm by its table.

    Each method says whether a claim of its kind is true.
    """

    table: DHTable

    # -------- Where everything is while all joints are at zero

    @cached_property
    def _frames(self) -> Array:
        """The base's frame, those of the links, and the tool's, (n + 2, 4, 4)."""
        still = np.zeros(self.table.n)
        base = np.asarray(self.table.base, dtype=float)[None]
        return np.concatenate([base, self.table.frames(still), self.table.fk(still)[-1:]])

    @cached_property
    def _axes(self) -> Array:
        """The frames on whose z the joints turn, and the tool's, (n + 1, 4, 4)."""
        first = 1 if self.table.convention is Convention.MODIFIED else 0
        return np.concatenate([self._frames[first : first + self.table.n], self._frames[-1:]])

    @cached_property
    def _centres(self) -> Array:
        """The links' centres of mass, (n, 3)."""
        own = np.array([np.asarray(link.com, dtype=float) for link in self.table.links])
        frames = self._frames[1 : self.table.n + 1]
        return np.asarray(frames[:, :3, 3] + np.einsum("nij,nj->ni", frames[:, :3, :3], own))

    @cached_property
    def _down(self) -> Array:
        """Which way gravity acts, (3,); nothing where it does not."""
        gravity = np.asarray(self.table.gravity, dtype=float)
        size = float(np.linalg.norm(gravity))
        return gravity / size if size else gravity

    def _turns(self, k: int) -> bool:
        return 1 <= k <= self.table.n and self.table.links[k - 1].joint == "revolute"

    def _moves(self, k: int) -> Array:
        """Which way a slide goes."""
        along = self._axes[k - 1][:3, 2]
        return np.asarray(-along if self.table.links[k - 1].flip else along)

    def _length(self, k: int) -> float:
        """From a joint's axis to the next one's, or to the tool."""
        return _beside(self._axes[k - 1], self._axes[k][:3, 3])

    def _to_centre(self, k: int) -> float:
        return _beside(self._axes[k - 1], self._centres[k - 1])

    def _of(self, claim: Claim) -> list[int]:
        """The links that a claim is of; all where it names none."""
        told = [number for _kind, number in claim.refs]
        told += [int(found) for name in claim.names for found in re.findall(r"\d", name)]
        return sorted({*told}) or [*range(1, self.table.n + 1)]

    def _each(self, claim: Claim, so: Callable[[int], bool]) -> bool | None:
        some = self._of(claim)
        return all(map(so, some)) if all(1 <= k <= self.table.n for k in some) else None

    def _is_value(self, name: str, value: float) -> bool | None:
        """Whether a name of the arm's, or of books, stands for a number."""
        words = vocabulary(self.table)
        if name in words.values:
            own = words.values[name]
        elif name in words.others:
            own = sum(float(x) * words.values.get(word, np.nan) for x, word in words.others[name])
        else:
            return None
        return bool(abs(abs(own) - value) <= TOLERANCES.formula_agrees * max(abs(value), 1.0))

    def value(self, claim: Claim) -> bool | None:
        """Of a name whether the arm's number is that, or that of another name; else not known."""
        (name,), (typed,) = claim.names, claim.words
        found = _NUMBER.fullmatch(typed)
        other = vocabulary(self.table).values.get(typed.replace("_", ""))
        value = other if found is None else float(found[1])
        return None if value is None else self._is_value(name.replace("_", ""), value)

    def singular(self, claim: Claim) -> bool | None:
        """Whether the arm is singular wherever a joint is at an angle, whatever the others."""
        (name,), (typed,) = claim.names, claim.words
        found = _ANGLE.fullmatch(
            re.sub(r"[\s*{}^\\±-]|pm", "", _PLAIN.sub("°", typed.replace("π", "pi")))
        )
        k = int(name[1:] or 0)
        if found is None or not self._turns(k):
            return None
        turn = float(found["times"] or 1) if found["times"] not in ("k", "n") else 1.0
        value = np.pi * turn / float(found["part"] or 1) if found["pi"] else 0.0
        value = np.deg2rad(float(found["degrees"])) if found["degrees"] else value
        states = np.random.default_rng(0).uniform(-2.0, 2.0, (8, self.table.n))
        there = np.array(states)
        there[:, k - 1] = value
        try:
            arm = Robot.from_dh(self.table)
            free, here = (np.abs(jacobian_determinant(arm, q)) for q in (states, there))
        except KinlabError:
            return None
        return bool(np.max(here) <= TOLERANCES.formula_agrees * np.max(free))

    # -------- Gravity and axes

    def gravity(self, claim: Claim) -> bool | None:
        if not claim.axes:
            return True if claim.words & _DOWN and self._down.any() else None
        return _alike(claim.axes, self._down)

    def axis(self, claim: Claim) -> bool | None:
        if not claim.axes or not self._down.any():
            return None
        if claim.words & _UP:
            return _alike(claim.axes, -self._down)
        if claim.words & _DOWN:
            return _alike(claim.axes, self._down)
        return _alike(claim.axes, self._down) or _alike(claim.axes, -self._down)

    def plane(self, claim: Claim) -> bool | None:
        if not is_planar(self.table):
            return None
        along = abs(float(self._down @ self._axes[0][:3, 2]))
        if claim.words & _LEVEL:
            return along > 1 - TOLERANCES.formula_agrees or not self._down.any()
        return bool(self._down.any()) and along < TOLERANCES.formula_agrees

    # -------- Joints

    def relative_angle(self, claim: Claim) -> bool | None:
        own = [int(found) for name in claim.names for found in re.findall(r"\d", name)]
        told = [number for _kind, number in claim.refs]
        if len(own) != 1 or not self._turns(own[0]):
            return None
        (k,) = own
        if not told:
            return (
                True if claim.words & {"previous", "preceding", "before", "vorigen", "前"} else None
            )
        if claim.words & _BETWEEN:
            return sorted(told) == [k - 1, k] or None
        return True if told in ([k - 1], [k, k - 1]) else None

    def angle_from(self, claim: Claim) -> bool | None:
        """Of the first joint of an arm in a plane whose first link lies along x at zero."""
        level = np.array_equal(np.asarray(self.table.base, dtype=float), np.eye(4))
        if not claim.names or not is_planar(self.table) or not level:
            return None
        if not all(re.fullmatch(r"\D+1" if self.table.n > 1 else r"\D+1?", x) for x in claim.names):
            return None
        if any(number != 1 for _kind, number in claim.refs) or claim.axes not in ((), ("x",)):
            return None
        if self.table.links[0].flip or claim.words & _NEGATIVE:
            return None
        along = self._axes[1][:3, 3] - self._axes[0][:3, 3]
        right = along[0] > 0 and abs(along[1]) <= TOLERANCES.same_length * along[0]
        told = bool(claim.axes) or abs(float(self._down[0])) <= TOLERANCES.formula_agrees
        return bool(right and told) or None

    def joint_coordinate(self, claim: Claim) -> bool | None:
        some = self._of(claim)
        angle = claim.words & {"angle", "angles", "winkel", "gelenkwinkel", "转角", "角", "关节角"}
        if any(not self._turns(k) for k in some) and angle:
            return False if _is_own(claim) else None
        return _is_own(claim)

    def slide(self, claim: Claim) -> bool | None:
        some = self._of(claim)
        if any(not 1 <= k <= self.table.n or self._turns(k) for k in some):
            return (
                False if len(some) == 1 and claim.words & {"stroke", "prismatic", "行程"} else None
            )
        way = claim.words & (_UP | _DOWN)
        if not way or not self._down.any():
            return not claim.names or _is_own(claim)
        before = [self._axes[k][:3, 2] for k in range(max(some) - 1)]
        if any(abs(float(axis @ self._down)) < 1 - TOLERANCES.formula_agrees for axis in before):
            return None  # which way is up depends on the joints before
        right = self._down if way & _DOWN else -self._down
        return all(_along(self._moves(k), right) for k in some)

    def third_slides(self, claim: Claim) -> bool | None:
        """Of a joint by its number alone, or of the only slide."""
        if not claim.refs:
            slides = [k for k in range(1, self.table.n + 1) if not self._turns(k)]
            claim = replace(claim, refs=tuple(("joint", k) for k in slides if len(slides) == 1))
        return self.slide(claim) if claim.refs and not claim.names else None

    def no_friction(self, _claim: Claim) -> bool:
        """Whether no joint has any."""
        return not any(getattr(link, name) for link in self.table.links for name in FRICTION)

    def rotor(self, claim: Claim) -> bool | None:
        own = vocabulary(self.table).values
        some = self._of(claim) if claim.names or claim.refs else ()
        return (all(f"Ia{k}" in own for k in some) and any(x[:2] == "Ia" for x in own)) or None

    # -------- Links

    def centre(self, claim: Claim) -> bool | None:
        """The distance of a centre from its own joint."""
        if not claim.names or any(name.endswith("i") for name in claim.names):
            return True if claim.names and not claim.refs else None
        for name in claim.names:
            k = int(name[-1])
            if {number for _kind, number in claim.refs} - {k} or not 1 <= k <= self.table.n:
                return None
            if self._is_value(f"lc{k}", self._to_centre(k)) is False:
                return None
        return True

    def centres_coordinates(self, claim: Claim) -> bool | None:
        return _is_own(claim)

    def inertia(self, claim: Claim) -> bool | None:
        return _is_own(claim)

    def point_masses(self, claim: Claim) -> bool | None:
        return self._each(claim, self._is_point)

    def rods(self, claim: Claim) -> bool | None:
        return self._each(claim, self._is_rod)

    def middle(self, claim: Claim) -> bool | None:
        return self._each(claim, self._is_half)

    def length(self, claim: Claim) -> bool | None:
        if claim.words & _WHOLE and not claim.refs:
            return None
        if claim.words & _DISTANCE and claim.names and any(k == "joint" for k, _n in claim.refs):
            return self._reaches(claim)
        for name in claim.names:
            k = int(name[-1])
            if _is_own(claim) is False:
                return False
            if name[0] == "l" and (not 1 <= k <= self.table.n or not self._turns(k)):
                return None
            if name not in {**vocabulary(self.table).values, **vocabulary(self.table).others}:
                return None
        return True if claim.names or claim.words & _AXES else None

    def _reaches(self, claim: Claim) -> bool | None:
        """Whether a length is from one joint to the next, or from the last one to the tool."""
        own = [int(name[-1]) for name in claim.names]
        ends = sorted(number for _kind, number in claim.refs)
        ends += [self.table.n + 1] if claim.words & _TOOL else []
        if len(own) != 1 or len(ends) != 2:
            return None
        right = self._is_value(claim.names[0], _apart(self._axes, *ends))
        return None if right is None else right and ends[1] == ends[0] + 1

    def tool(self, claim: Claim) -> bool | None:
        last = [number for _kind, number in claim.refs]
        if any(number != self.table.n for number in last):
            return False
        return all(name in vocabulary(self.table).values for name in claim.names) or None

    def _is_half(self, k: int) -> bool:
        length = self._length(k)
        return bool(length) and _same(self._to_centre(k), length / 2)

    def _is_point(self, k: int) -> bool:
        link = self.table.links[k - 1]
        return _same(self._to_centre(k), self._length(k)) and not np.any(np.asarray(link.inertia))

    def _is_rod(self, k: int) -> bool:
        link, length = self.table.links[k - 1], self._length(k)
        moment = np.asarray(link.inertia, dtype=float)
        axis = np.linalg.inv(self._frames[k])[:3, :3] @ self._axes[k - 1][:3, 2]
        rod = link.mass * length**2 / 12
        return self._is_half(k) and bool(
            abs(float(axis @ moment @ axis) - rod) <= TOLERANCES.same_number * rod
        )


def _apart(axes: Array, one: int, other: int) -> float:
    """From a joint's axis to another one's, or to the tool behind the last; nan of what is none."""
    if not 1 <= one < other <= len(axes):
        return float("nan")
    return _beside(axes[one - 1], axes[other - 1][:3, 3])


def _beside(frame: Array, point: Array) -> float:
    """How far a point is from a frame's z axis."""
    gap = point - frame[:3, 3]
    return float(np.linalg.norm(gap - (gap @ frame[:3, 2]) * frame[:3, 2]))


def _same(one: float, other: float) -> bool:
    return abs(one - other) <= TOLERANCES.formula_agrees * max(abs(other), 1.0)


def _along(one: Array, other: Array) -> bool:
    return float(one @ other) >= 1.0 - TOLERANCES.formula_agrees


def _alike(axes: Iterable[str], way: Array) -> bool:
    """Whether axes, as they are named, all go one way."""
    return all(
        _along((-1.0 if axis[0] == "-" else 1.0) * np.eye(3)["xyz".index(axis[-1])], way)
        for axis in axes
    )
