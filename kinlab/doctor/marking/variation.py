"""Numbers of the robot for each student, from the sheet's seed and the student's id."""

from __future__ import annotations

import hashlib
import re
from dataclasses import replace
from functools import lru_cache
from typing import Any

import numpy as np

from kinlab.doctor.changes import Mechanism
from kinlab.doctor.linkages.named_numbers import named_numbers
from kinlab.doctor.marking.sheet import Sheet, Variation
from kinlab.errors import already_said
from kinlab.fivebar import FiveBar
from kinlab.model.dh import DHTable
from kinlab.model.link import DHLink
from kinlab.model.robot import Robot
from kinlab.symbolic.vocabulary import Vocabulary, exact, vocabulary

_DIGITS = 3
_AXES = "xyz"
_TENSOR = re.compile(r"I[xyz]{2}(\d+)")


def robot_for(sheet: Sheet, student: str) -> Mechanism:
    """The robot with the numbers of one student; the sheet's own where nothing is varied.

    Args:
        sheet: the sheet.
        student: the id; upper and lower case are the same student.
    """
    if sheet.variation is None or isinstance(sheet.robot, FiveBar):
        return sheet.robot
    return _varied(sheet.robot, sheet.variation, student.strip().lower())


def numbers_for(sheet: Sheet, student: str) -> dict[str, float]:
    """What each name stands for, for one student; empty without a DH table."""
    return named_numbers(robot_for(sheet, student))


@lru_cache(maxsize=512)
def _varied(robot: Robot, variation: Variation, student: str) -> Robot:
    assert robot.table is not None
    words = vocabulary(robot.table)
    chosen = variation.names or tuple(
        name for name in words.values if name not in ("g", "gx", "gy", "gz")
    )
    values = dict(words.values)
    for name in set(chosen) & set(values):
        shared = _TENSOR.sub(r"I\1", name)  # a tensor stays one of a body
        share = 2.0 * _fraction(variation.seed, student, shared) - 1.0
        share = 1.0 + variation.spread * share
        values[name] = float(f"{values[name] * share:.{_DIGITS}g}")
    with already_said():  # what these digits leave of a rod's tensor is no fault of the sheet's
        return Robot.from_dh(_with_numbers(robot.table, words, values))


def _fraction(seed: int, student: str, name: str) -> float:
    """A number from 0 to 1 that only these three decide, on every machine."""
    digest = hashlib.sha256(f"{seed}\0{student}\0{name}".encode("utf-8", "replace")).digest()
    return int.from_bytes(digest[:6], "big") / float(2**48 - 1)


def _with_numbers(table: DHTable, words: Vocabulary, values: dict[str, float]) -> DHTable:
    def entry(key: str, old: float) -> float:
        if key not in words.entries:
            return old
        parts = (f * (exact(values[name]) if name else 1) for f, name in words.entries[key])
        return float(sum(parts, start=exact(0.0)))

    links: list[DHLink] = []
    for i, link in enumerate(table.links, 1):
        tensor = np.array(link.inertia, dtype=float)
        places = [(k, m, f"inertia{i}{_AXES[k]}{_AXES[m]}") for k in range(3) for m in range(k, 3)]
        named = [
            (k, m, key) for k, m, key in places if any(n for _f, n in words.entries.get(key, ()))
        ]
        shares = [entry(key, 0.0) / tensor[k, m] for k, m, key in named if tensor[k, m]]
        for k, m, key in places:
            value = entry(key, tensor[k, m])
            if (k, m, key) not in named:  # of a rod the moment across its plane
                value *= shares[0] if shares else 1.0
            tensor[k, m] = tensor[m, k] = value
        com = np.asarray(link.com, dtype=float)
        plain = ("a", "d", "mass", "armature")
        numbers: dict[str, Any] = {n: entry(f"{n}{i}", getattr(link, n)) for n in plain}
        place = [entry(f"com{i}{axis}", float(com[k])) for k, axis in enumerate(_AXES)]
        links.append(replace(link, com=place, inertia=tensor, **numbers))
    ends: dict[str, Any] = {}
    for which in ("base", "tool"):
        frame = np.array(getattr(table, which), dtype=float)
        frame[:3, 3] = [entry(f"{which}{a}", frame[k, 3]) for k, a in enumerate(_AXES)]
        ends[which] = frame
    return replace(table, links=links, **ends)
