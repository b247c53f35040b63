"""Readings of the robot itself: convention, offsets, base and tool, gravity, inertias."""

from __future__ import annotations

from collections.abc import Callable, Iterator
from dataclasses import replace
from functools import lru_cache, partial
from typing import Any

import numpy as np
import pinocchio as pin

from kinlab.arrays import Array
from kinlab.doctor.changes import Confusion
from kinlab.errors import already_said
from kinlab.host.language import N_, _
from kinlab.model.dh import DHLink, DHTable
from kinlab.model.link import Convention, steiner
from kinlab.model.robot import Robot
from kinlab.model.urdf_engine import build, document
from kinlab.model.urdf_write import placements, records

_DIRECTIONS = {
    f"{s}{x}": row
    for x, e in zip("xyz", np.eye(3), strict=True)
    for s, row in (("+", e), ("-", -e))
}

TableChange = Callable[[DHTable], DHTable]

_READ_AS = {
    Convention.STANDARD: N_("reads the standard table as modified"),
    Convention.MODIFIED: N_("reads the modified table as standard"),
}
_LEFT_OUT = {
    "base": N_("leaves the base transform out"),
    "tool": N_("leaves the tool transform out"),
}
_INVERTED = {"base": N_("inverts the base transform"), "tool": N_("inverts the tool transform")}


def table_readings(robot: Robot) -> Iterator[Confusion]:
    """What can be read differently in the DH table; nothing for a robot without one."""
    table = robot.table
    if table is None:
        return
    other = Convention.STANDARD if table.convention is Convention.MODIFIED else Convention.MODIFIED
    said = _(_READ_AS[Convention(str(table.convention))])
    yield _table("convention", said, lambda t: replace(t, convention=other), 1.05)
    for which in ("base", "tool"):
        if not np.array_equal(getattr(table, which), np.eye(4)):
            out: dict[str, Any] = {which: np.eye(4)}
            turned: dict[str, Any] = {which: np.linalg.inv(np.asarray(getattr(table, which)))}
            yield _table(which, _(_LEFT_OUT[which]), partial(replace, **out))
            yield _table(which, _(_INVERTED[which]), partial(replace, **turned), 1.5)
    yield from _column_readings(table)
    for i, link in enumerate(table.links):
        said = _("turns joint {joint} the other way").format(joint=i + 1)
        flipped = _linked(i, flip=not link.flip)
        yield _table("turning sense", said, flipped, 1.3, f"joint {i + 1}")
        for column in ("theta", "d", "a", "alpha"):
            yield from _entry_readings(i, link, column)
        if table.convention is Convention.STANDARD and np.any(link.com) and (link.a or link.alpha):
            said = _(
                "measures the centre of mass of link {number} in the frame at its joint, not at "
                "its far end"
            ).format(number=i + 1)
            yield _inertial("centre's frame", said, i, _placed(link), 1.15)


def _column_readings(table: DHTable) -> Iterator[Confusion]:
    for column, words in (
        ("theta", _("leaves all theta offsets out")),
        ("d", _("leaves all d offsets out")),
    ):
        changed = [i for i, link in enumerate(table.links) if getattr(link, column)]
        if len(changed) > 1:
            yield _table("offset", words, _emptied(column))
    if any(link.alpha for link in table.links):
        said = _("has every alpha with the opposite sign")
        yield _table("alpha sign", said, _each(lambda i, k: replace(k, alpha=-k.alpha)), 1.2)
    for shift, words in (
        (1, _("takes a and alpha of the row before")),
        (-1, _("takes a and alpha of the row behind")),
    ):
        rows = [table.links[(i - shift) % len(table.links)] for i in range(len(table.links))]
        taken = [(row.a, row.alpha) for row in rows]
        yield _table("row shift", words, _a_and_alpha(taken), 1.4)


def _emptied(column: str) -> TableChange:
    none: dict[str, Any] = {column: 0.0}
    return _each(lambda i, link: replace(link, **none))


def _a_and_alpha(taken: list[tuple[float, float]]) -> TableChange:
    return _each(lambda i, link: replace(link, a=taken[i][0], alpha=taken[i][1]))


def _entry_readings(i: int, link: DHLink, column: str) -> Iterator[Confusion]:
    value, place = getattr(link, column), f"link {i + 1}"
    if not value:
        return
    kind = "offset" if column in ("theta", "d") else "table entry"
    forgets = _("leaves {column} of link {number} out").format(column=column, number=i + 1)
    yield _table(kind, forgets, _linked(i, **{column: 0.0}), cost=1.2, place=place)
    turned = _("has {column} of link {number} with the opposite sign")
    turned = turned.format(column=column, number=i + 1)
    yield _table(f"{column} sign", turned, _linked(i, **{column: -value}), 1.3, place)


def gravity_readings(robot: Robot) -> Iterator[Confusion]:
    """Gravity's sign and axis."""
    gravity = np.array(robot.model.gravity.linear)
    size = float(np.linalg.norm(gravity))
    if not size:
        return
    yield _model("gravity sign", _("has gravity with the opposite sign"), _gravity(-gravity))
    yield _model("gravity left out", _("leaves gravity out"), _gravity(0 * gravity))
    for name, direction in _DIRECTIONS.items():
        turned = size * direction
        if not (np.allclose(turned, gravity) or np.allclose(turned, -gravity)):
            said = _("has gravity along {axis}").format(axis=name)
            yield _model("gravity axis", said, _gravity(turned), 1.1)
    base = np.eye(3) if robot.table is None else np.asarray(robot.table.base)[:3, :3]
    for name, direction in _DIRECTIONS.items():
        turned = size * base @ direction
        if np.max(np.abs(turned)) < size and not np.allclose(abs(turned @ gravity), size**2):
            said = _("has gravity along {axis} of the base frame").format(axis=name)
            yield _model("gravity axis", said, _gravity(turned), cost=1.12)


def inertia_readings(robot: Robot) -> Iterator[Confusion]:
    """Masses, centres, tensors and rotors: each link alone, and all together."""
    model = robot.model
    if np.any(model.armature):
        said = _("leaves out the rotors' inertia (armature) of all joints")
        yield _model("rotor inertia", said, _armature(slice(None)))
        rotors = np.flatnonzero(model.armature).tolist()
        for i in rotors if len(rotors) > 1 else ():
            said = _("leaves out the rotor's inertia (armature) of joint {joint}")
            said = said.format(joint=i + 1)
            yield _model("rotor inertia", said, _armature(i), 1.2, f"joint {i + 1}")
    yield from _at_far_end(robot)
    for kind, words, times, cost in _BODY_CHANGES:
        change = _taken(times)
        touched = [i for i in range(robot.n) if _changes(model.inertias[i + 1], change)]
        if len(touched) > 1:
            yield _inertial(kind, _(words).format(link=_("every link")), None, change, cost)
        for i in touched:
            extra = 0.2 if len(touched) > 1 else 0.0
            link = _("link {number}").format(number=i + 1)
            yield _inertial(kind, _(words).format(link=link), i, change, cost + extra)


def _at_far_end(robot: Robot) -> Iterator[Confusion]:
    """Centres of mass at the next joint, or at the tool: the link's length for its centre's."""
    model = robot.model
    ends = [np.array(model.jointPlacements[i + 1].translation) for i in range(1, robot.n)]
    ends.append(np.array(model.frames[robot.tool].placement.translation))

    def change(links: list[int]) -> Callable[[Any], None]:
        def apply(changed: Any) -> None:
            for i in links:
                old = changed.inertias[i + 1]
                changed.inertias[i + 1] = _body(old.mass, ends[i], old.inertia)

        return apply

    levers = [body.lever for body in model.inertias[1:]]
    moved = [i for i in range(robot.n) if not np.allclose(ends[i], levers[i], atol=1e-12)]
    said = _("puts the centre of mass of {link} at its far end (its length for its centre's)")
    if len(moved) > 1:
        told = said.format(link=_("every link"))
        yield _model("centre", told, change(moved), 1.1)
    for i in moved:
        told = said.format(link=_("link {number}").format(number=i + 1))
        yield _model("centre", told, change([i]), 1.25, f"link {i + 1}")


Body = tuple[float, Array, Array]
"""Mass, centre and tensor."""
BodyChange = Callable[[Any], Body]

_BODY_CHANGES: tuple[tuple[str, str, tuple[float, ...], float], ...] = (
    (
        "inertia point",
        N_("counts m c² of {link} twice: takes its inertia about the joint and adds m c² again"),
        (1, 1, 1, 1, 1),
        1.0,
    ),
    (
        "inertia point",
        N_(
            "leaves m c² out for {link}: the inertia about the centre stands for that about the "
            "joint"
        ),
        (1, 1, 1, 1, -1),
        1.0,
    ),
    ("inertia left out", N_("leaves the inertia tensor of {link} out"), (1, 1, 0, 0, 0), 1.1),
    (
        "products of inertia",
        N_("has the products of inertia of {link} with the opposite sign"),
        (1, 1, 1, -1, 0),
        1.1,
    ),
    (
        "products of inertia",
        N_("leaves the products of inertia of {link} out"),
        (1, 1, 1, 0, 0),
        1.2,
    ),
    ("centre", N_("puts the centre of mass of {link} at the joint"), (1, 0, 1, 1, 0), 1.2),
    (
        "centre",
        N_("measures the centre of mass of {link} to the other side"),
        (1, -1, 1, 1, 0),
        1.2,
    ),
    ("centre", N_("has the centre of mass of {link} at half its distance"), (1, 0.5, 1, 1, 0), 1.3),
    ("centre", N_("has the centre of mass of {link} at twice its distance"), (1, 2, 1, 1, 0), 1.3),
    ("mass left out", N_("leaves the mass of {link} out"), (0, 1, 1, 1, 0), 1.2),
    ("link left out", N_("leaves {link} out of the dynamics"), (0, 1, 0, 0, 0), 1.3),
    ("mass", N_("counts the mass of {link} twice"), (2, 1, 1, 1, 0), 1.4),
)
"""Kind, sentence, how many times a link's mass, centre, moments and products of inertia and m c²
are taken, and cost."""


def _taken(times: tuple[float, ...]) -> BodyChange:
    mass, centre, moments, products, about_joint = times

    def change(old: Any) -> Body:
        straight = np.diag(np.diag(old.inertia))
        tensor = moments * straight + products * (old.inertia - straight)
        tensor = tensor + about_joint * steiner(old.mass, old.lever)
        return mass * old.mass, centre * old.lever, tensor

    return change


def _changes(old: Any, change: BodyChange) -> bool:
    mass, lever, tensor = change(old)
    return not (
        mass == old.mass
        and np.array_equal(lever, old.lever)
        and np.allclose(tensor, old.inertia, rtol=0, atol=1e-14)
    )


def _table(
    kind: str,
    sentence: str,
    change: Callable[[DHTable], DHTable],
    cost: float = 1.0,
    place: str = "",
) -> Confusion:
    def apply(robot: Robot) -> Robot:
        assert robot.table is not None
        with already_said():
            return _built(change(robot.table))

    return Confusion(kind, sentence, "robot", apply, cost, place)


@lru_cache(maxsize=1024)
def _built(table: DHTable) -> Robot:
    """The robot of a changed table: entries of one file and pairs of readings ask for it again.

    As :meth:`Robot.from_dh` has it, but without its picture, which takes half of the time.
    """
    from lxml import etree

    tree, names = records(table), list(table.joint_names)
    text = etree.tostring(document(tree, names), encoding="unicode")
    model = build(text, tree, names, f"table {table.name!r}")
    tool = int(model.getFrameId(table.tool_name, pin.FrameType.BODY))
    return Robot(table.name, model, tool, "", table, None, table.source)


def _each(change: Callable[[int, DHLink], DHLink]) -> TableChange:
    return lambda t: replace(t, links=[change(i, link) for i, link in enumerate(t.links)])


def _linked(i: int, **columns: Any) -> TableChange:
    return _each(lambda k, link: replace(link, **columns) if k == i else link)


def _body(mass: float, lever: Array, tensor: Array) -> Any:
    """An inertia that may be impossible, as mistaken ones are: the constructor would refuse it."""
    body = pin.Inertia.Zero()
    body.mass, body.lever, body.inertia = mass, lever, tensor
    return body


def bodies_in_links(table: DHTable) -> list[Body]:
    """Mass, centre and tensor of every link in its own axes, as its row has them."""
    return [
        (float(x.mass), np.array(x.com, dtype=float), np.array(x.inertia, dtype=float))
        for x in table.links
    ]


def with_body(robot: Robot, link: int, mass: float, com: Array, tensor: Array) -> Robot:
    """The robot with another body for a link, in the axes of its row; it may be impossible."""
    assert robot.table is not None
    tail = placements(robot.table)[link].tail
    turn = tail[:3, :3]
    body = _body(mass, turn @ com + tail[:3, 3], turn @ tensor @ turn.T)

    def change(model: Any) -> None:
        model.inertias[link + 1] = body

    return _with_model(robot, change)


def _placed(link: DHLink) -> BodyChange:
    """Centre and tensor as if given in the frame at the joint (no Tail in front)."""
    return lambda old: (old.mass, np.array(link.com), np.array(link.inertia))


def with_gravity(robot: Robot, value: Array) -> Robot:
    """The robot under another gravity, (3,) m/s² in the base."""
    return _with_model(robot, _gravity(value))


def _model(
    kind: str, sentence: str, change: Callable[[Any], None], cost: float = 1.0, place: str = ""
) -> Confusion:
    return Confusion(kind, sentence, "robot", partial(_with_model, change=change), cost, place)


def _with_model(robot: Robot, change: Callable[[Any], None]) -> Robot:
    model = pin.Model(robot.model)
    change(model)
    return Robot(robot.name, model, robot.tool, "", robot.table, None, robot.source)


def _gravity(value: Array) -> Callable[[Any], None]:
    def change(model: Any) -> None:
        model.gravity.linear = value

    return change


def _armature(joints: int | slice) -> Callable[[Any], None]:
    def change(model: Any) -> None:
        kept = np.array(model.armature)
        kept[joints] = 0.0
        model.armature = kept

    return change


def _inertial(
    kind: str,
    sentence: str,
    link: int | None,
    change: BodyChange,
    cost: float = 1.0,
) -> Confusion:
    def apply(model: Any) -> None:
        for i in range(1, model.njoints) if link is None else (link + 1,):
            model.inertias[i] = _body(*change(model.inertias[i]))

    place = "" if link is None else f"link {link + 1}"
    return _model(kind, sentence, apply, cost, place)
