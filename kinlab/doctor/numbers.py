"""The robot's numbers taken otherwise: one of them another, or all of a kind rounded.

One number is solved for from the hand formula's values; it is named only if it is a number that
somebody writes (four digits or fewer, or one that stands elsewhere in the robot's data).
"""

from __future__ import annotations

import math
from collections.abc import Callable, Iterator
from dataclasses import dataclass, replace
from typing import Any

import numpy as np

from kinlab.arrays import Array
from kinlab.check.quantities.serial import SERIAL
from kinlab.doctor.changes import Case, Confusion
from kinlab.doctor.confusions.robots import bodies_in_links, with_body
from kinlab.doctor.text.meanings import stands_for
from kinlab.errors import KinlabError, already_said
from kinlab.host.language import N_, _
from kinlab.model.dh import DHTable
from kinlab.model.robot import Robot
from kinlab.tolerances import TOLERANCES

_FEW = 3
_ALIKE = 0.3
"""Cosine squared between what a number moves and what is off, above which it is solved for."""
_STEPS = 12
_DIGITS = 4
"""Digits up to which a solved number is one that somebody wrote."""
_AXES = "xyz"
_STILL = {"fk", "planar_pose", "planar_jacobian", "jacobian_dot", "tip_speed_squared"}


@dataclass(frozen=True)
class Number:
    """A number of the robot.

    Attributes:
        what: its name, in words. place: its link. value: what it is.
        put: the robot with another one.
    """

    what: str
    place: str
    value: float
    put: Callable[[float], Robot]


def numbers_of(robot: Robot, still: bool) -> Iterator[Number]:
    """Every number of a robot with a table; of a ``still`` one only the geometry."""
    table = robot.table
    if table is None:
        return
    for i, link in enumerate(table.links):
        place = _("link {number}").format(number=i + 1)
        for column in ("a", "alpha", "d", "theta"):
            what = _("{column} of {link}").format(column=column, link=place)
            value = float(getattr(link, column))
            yield Number(what, f"link {i + 1}", value, _in_table(robot, i, column))
    if still:
        return
    for i, (mass, com, tensor) in enumerate(bodies_in_links(table)):
        place = _("link {number}").format(number=i + 1)
        if not mass and not np.any(tensor):
            continue
        said = _("the mass of {link}").format(link=place)
        yield Number(said, f"link {i + 1}", mass, _in_body(robot, i, "mass", (0, 0)))
        for k in range(3):
            said = _("the {axis} of the centre of mass of {link}").format(axis=_AXES[k], link=place)
            yield Number(said, f"link {i + 1}", float(com[k]), _in_body(robot, i, "com", (k, k)))
        for j, k in ((0, 0), (1, 1), (2, 2), (0, 1), (0, 2), (1, 2)):
            said = _("the inertia I{axes} of {link}").format(axes=_AXES[j] + _AXES[k], link=place)
            value = float(tensor[j, k])
            yield Number(said, f"link {i + 1}", value, _in_body(robot, i, "inertia", (j, k)))


def _in_table(robot: Robot, i: int, column: str) -> Callable[[float], Robot]:
    table = robot.table
    assert table is not None

    def put(value: float) -> Robot:
        links: list[Any] = list(table.links)
        links[i] = replace(links[i], **{column: value})
        with already_said():
            return Robot.from_dh(replace(table, links=links))

    return put


def _in_body(robot: Robot, i: int, what: str, at: tuple[int, int]) -> Callable[[float], Robot]:
    assert robot.table is not None
    mass, com, tensor = bodies_in_links(robot.table)[i]

    def put(value: float) -> Robot:
        centre, inertia = np.array(com), np.array(tensor)
        if what == "mass":
            return with_body(robot, i, value, centre, inertia)
        if what == "com":
            centre[at[0]] = value
        else:
            inertia[at] = inertia[at[::-1]] = value
        return with_body(robot, i, mass, centre, inertia)

    return put


def other_numbers(case: Case, held: Array | None = None) -> Iterator[Confusion]:
    """Readings with one of the robot's numbers another, each solved for from the values.

    Args:
        case: the states, and the hand formula's answers.
        held: the numbers that a program comes to, of which the other one is one.
    """
    if case.quantity.domain is not SERIAL or not np.isfinite(case.hand).all():
        return
    still = case.quantity.name in _STILL or case.quantity.name.startswith(("jacobian", "statics"))
    few = case.few(_FEW)
    engine = np.asarray(few.answer(()), dtype=float)
    if engine.shape != few.hand.shape:
        return
    every = [number for number in numbers_of(case.robot, still) if number.value]
    for number in every:
        solved = _solved(few, engine, number)
        if solved is None:
            continue
        value = _written(solved, number, [x.value for x in every])
        if value is None or not _held(value, held):
            continue
        does = _("takes {new} for {what}, which is {old}").format(
            new=_shown(value), what=number.what, old=_shown(number.value)
        )

        def apply(_robot: Robot, number: Number = number, value: float = value) -> Robot:
            return number.put(value)

        yield Confusion("number", does, "robot", apply, 1.15, number.place)


def _held(value: float, numbers: Array | None) -> bool:
    """Whether a program comes to a number, or to its opposite; of none nothing is known."""
    if numbers is None:
        return True
    return bool(np.isclose(np.abs(numbers), abs(value), rtol=TOLERANCES.same_number, atol=0).any())


def _solved(few: Case, engine: Array, number: Number) -> float | None:
    """The number with which the engine answers as the hand formula does, at a few states."""
    wanted = (few.hand - engine).ravel()
    size = float(np.max(np.abs(engine))) or 1.0
    step = 1e-5 * max(abs(number.value), 0.1)

    def answer(value: float) -> Array | None:
        try:
            with np.errstate(all="ignore"):
                found = np.asarray(replace(few, robot=number.put(value)).answer(()), dtype=float)
        except (KinlabError, np.linalg.LinAlgError):
            return None
        return found.ravel() if np.isfinite(found).all() else None

    value, here = number.value, engine.ravel()
    best = math.inf
    for turn in range(_STEPS):
        there = answer(value + step)
        if there is None:
            return None
        slope = (there - here) / step
        length, rest = float(slope @ slope), few.hand.ravel() - here
        if length <= (1e-9 * size) ** 2:
            return None
        along = float(slope @ rest)
        if not turn and along**2 < _ALIKE * length * float(wanted @ wanted):
            return None
        value += along / length
        new = answer(value)
        if new is None:
            return None
        here = new
        left = float(np.max(np.abs(few.hand.ravel() - here)))
        if left <= 0.1 * TOLERANCES.formula_agrees * size:
            return value
        if turn > 1 and left > 0.7 * best:
            return None
        best = left
    return None


def _written(value: float, number: Number, others: list[float]) -> float | None:
    """The number that somebody wrote for a solved one, or None."""
    if abs(value) <= 1e-6 * max(abs(number.value), 1e-3):
        return 0.0
    near = [float(f"{value:.{_DIGITS}g}"), *others, *(-x for x in others)]
    near += [round(value / (math.pi / 12)) * math.pi / 12]
    slack = 1e-6 * abs(value)
    fits = [x for x in near if abs(x - value) <= slack and x != number.value]
    return fits[0] if fits else None


def _shown(value: float) -> str:
    return f"{value:.7g}"


# -------- All numbers of a kind rounded

_PI = (3.14, 3.142, 3.1416, 3.14159, 3.141593)


def rounded_robots(robot: Robot) -> Iterator[tuple[Robot, tuple[str, ...]]]:
    """The robot with pi, angles, or all other numbers to fewer digits, and what is to be said."""
    table = robot.table
    if table is None:
        return
    angles = [*_angles(table)]
    data = [*_data(table)]
    plain: list[tuple[DHTable, tuple[str, ...]]] = [*angles, *data]
    for turned, said in angles:
        plain += [(other, (*said, *more)) for other, more in _data(turned)]
    for changed, said in plain:
        try:
            with already_said():
                rounded = Robot.from_dh(changed)
        except KinlabError:
            continue  # rounded, it is no body's tensor
        if bool(rounded.singular_mass) == bool(robot.singular_mass):
            yield rounded, said


def _angles(table: DHTable) -> Iterator[tuple[DHTable, tuple[str, ...]]]:
    seen = {_key(table)}
    ways: list[tuple[Callable[[float], float], str]] = [
        (lambda x, p=p: x * p / math.pi, stands_for(p, "pi"))  # type: ignore[misc]
        for p in _PI
    ]
    to_places = _("angles to {places} decimals")
    ways += [
        (lambda x, k=k: round(x, k), to_places.format(places=k))  # type: ignore[misc]
        for k in (2, 3, 4, 5)
    ]
    for change, said in ways:

        def turned(x: float, change: Callable[[float], float] = change) -> float:
            whole = abs(x / (math.pi / 12) - round(x / (math.pi / 12))) < 1e-9
            return change(x) if x and whole else x

        links = [replace(k, alpha=turned(k.alpha), theta=turned(k.theta)) for k in table.links]
        other = replace(table, links=links)
        if _key(other) not in seen:
            seen.add(_key(other))
            yield other, (said,)


def _key(table: DHTable) -> tuple[float, ...]:
    return tuple(round(x, 12) for link in table.links for x in (link.alpha, link.theta))


def _data(table: DHTable) -> Iterator[tuple[DHTable, tuple[str, ...]]]:
    """Lengths, masses, centres and tensors to a number of digits, or of decimals."""
    seen = [_flat(table)]
    for form, words in (
        ("{:.2g}", N_("the robot's numbers to 2 digits")),
        ("{:.3g}", N_("the robot's numbers to 3 digits")),
        ("{:.4g}", N_("the robot's numbers to 4 digits")),
        ("{:.2f}", N_("the robot's numbers to 2 decimals")),
        ("{:.3f}", N_("the robot's numbers to 3 decimals")),
        ("{:.4f}", N_("the robot's numbers to 4 decimals")),
    ):
        cut = np.vectorize(lambda x, form=form: float(form.format(x)), otypes=[float])
        links: list[Any] = []
        try:
            with already_said():
                for link in table.links:
                    a, d, mass = map(float, cut([link.a, link.d, link.mass]))
                    com, inertia = cut(link.com), cut(link.inertia)
                    links.append(replace(link, a=a, d=d, mass=mass, com=com, inertia=inertia))
                other = replace(table, links=links)
        except KinlabError:
            continue
        flat = _flat(other)
        if not any(np.array_equal(flat, x) for x in seen):
            seen.append(flat)
            yield other, (_(words),)


def _flat(table: DHTable) -> Array:
    rows = [
        np.concatenate([[k.a, k.d, k.mass], np.ravel(k.com), np.ravel(k.inertia)])
        for k in table.links
    ]
    return np.concatenate(rows)
