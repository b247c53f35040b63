"""Readings of the robot itself: convention, offsets, base and tool, gravity, inertias."""

from __future__ import annotations

from collections.abc import Callable, Iterator
from dataclasses import replace
from functools import lru_cache
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
    "+x": (1, 0, 0),
    "-x": (-1, 0, 0),
    "+y": (0, 1, 0),
    "-y": (0, -1, 0),
    "+z": (0, 0, 1),
    "-z": (0, 0, -1),
}

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
    yield _table(
        "convention",
        _(_READ_AS[Convention(str(table.convention))]),
        lambda t: replace(t, convention=other),
        cost=1.05,
    )
    for which in ("base", "tool"):
        if not np.array_equal(getattr(table, which), np.eye(4)):
            yield _table(which, _(_LEFT_OUT[which]), _setting(which, np.eye(4)))
            inverse = np.linalg.inv(np.asarray(getattr(table, which)))
            yield _table(which, _(_INVERTED[which]), _setting(which, inverse), cost=1.5)
    yield from _column_readings(table)
    for i, link in enumerate(table.links):
        yield _table(
            "turning sense",
            _("turns joint {joint} the other way").format(joint=i + 1),
            _linked(i, flip=not link.flip),
            cost=1.3,
            place=f"joint {i + 1}",
        )
        for column in ("theta", "d", "a", "alpha"):
            yield from _entry_readings(i, link, column)
        if table.convention is Convention.STANDARD and np.any(link.com) and (link.a or link.alpha):
            com, tensor = _from_the_joint(link)
            yield _inertial(
                "centre's frame",
                _(
                    "measures the centre of mass of link {number} in the frame at its joint, not "
                    "at its far end"
                ).format(number=i + 1),
                i,
                _placed(com, tensor),
                cost=1.15,
            )


def _column_readings(table: DHTable) -> Iterator[Confusion]:
    for column, words in (
        ("theta", _("leaves all theta offsets out")),
        ("d", _("leaves all d offsets out")),
    ):
        changed = [i for i, link in enumerate(table.links) if getattr(link, column)]
        if len(changed) > 1:
            yield _table("offset", words, _emptied(column))
    if any(link.alpha for link in table.links):
        yield _table(
            "alpha sign",
            _("has every alpha with the opposite sign"),
            lambda t: replace(t, links=[replace(k, alpha=-k.alpha) for k in t.links]),
            cost=1.2,
        )
    for shift, words in (
        (1, _("takes a and alpha of the row before")),
        (-1, _("takes a and alpha of the row behind")),
    ):
        a = np.roll([link.a for link in table.links], shift)
        alpha = np.roll([link.alpha for link in table.links], shift)
        yield _table("row shift", words, _shifted(a, alpha), cost=1.4)


def _entry_readings(i: int, link: DHLink, column: str) -> Iterator[Confusion]:
    value, place = getattr(link, column), f"link {i + 1}"
    if not value:
        return
    kind = "offset" if column in ("theta", "d") else "table entry"
    forgets = _("leaves {column} of link {number} out").format(column=column, number=i + 1)
    yield _table(kind, forgets, _linked(i, **{column: 0.0}), cost=1.2, place=place)
    yield _table(
        f"{column} sign",
        _("has {column} of link {number} with the opposite sign").format(
            column=column, number=i + 1
        ),
        _linked(i, **{column: -value}),
        cost=1.3,
        place=place,
    )


def gravity_readings(robot: Robot) -> Iterator[Confusion]:
    """Gravity's sign and axis."""
    gravity = np.array(robot.model.gravity.linear)
    size = float(np.linalg.norm(gravity))
    if not size:
        return
    yield _model("gravity sign", _("has gravity with the opposite sign"), _gravity(-gravity))
    yield _model("gravity left out", _("leaves gravity out"), _gravity(0 * gravity))
    for name, direction in _DIRECTIONS.items():
        turned = size * np.array(direction, dtype=float)
        if not (np.allclose(turned, gravity) or np.allclose(turned, -gravity)):
            yield _model(
                "gravity axis",
                _("has gravity along {axis}").format(axis=name),
                _gravity(turned),
                cost=1.1,
            )
    base = np.eye(3) if robot.table is None else np.asarray(robot.table.base)[:3, :3]
    for name, direction in _DIRECTIONS.items():
        turned = size * base @ np.array(direction, dtype=float)
        if np.max(np.abs(turned)) < size and not np.allclose(abs(turned @ gravity), size**2):
            said = _("has gravity along {axis} of the base frame").format(axis=name)
            yield _model("gravity axis", said, _gravity(turned), cost=1.12)


def inertia_readings(robot: Robot) -> Iterator[Confusion]:
    """Masses, centres, tensors and rotors: each link alone, and all together."""
    model = robot.model
    if np.any(model.armature):
        yield _model(
            "rotor inertia",
            _("leaves out the rotors' inertia (armature) of all joints"),
            _armature(None),
        )
        for i in np.flatnonzero(model.armature).tolist():
            if np.count_nonzero(model.armature) > 1:
                yield _model(
                    "rotor inertia",
                    _("leaves out the rotor's inertia (armature) of joint {joint}").format(
                        joint=i + 1
                    ),
                    _armature(i),
                    cost=1.2,
                    place=f"joint {i + 1}",
                )
    yield from _at_far_end(robot)
    for kind, words, change, cost in _BODY_CHANGES:
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

    moved = [
        i
        for i in range(robot.n)
        if not np.allclose(ends[i], model.inertias[i + 1].lever, atol=1e-12)
    ]
    said = _("puts the centre of mass of {link} at its far end (its length for its centre's)")
    if len(moved) > 1:
        told = said.format(link=_("every link"))
        yield _model("centre", told, change(moved), 1.1)
    for i in moved:
        told = said.format(link=_("link {number}").format(number=i + 1))
        yield _model("centre", told, change([i]), 1.25, f"link {i + 1}")


def _about_joint(old: Any) -> tuple[float, Array, Array]:
    return old.mass, old.lever, old.inertia + steiner(old.mass, old.lever)


def _about_centre(old: Any) -> tuple[float, Array, Array]:
    return old.mass, old.lever, old.inertia - steiner(old.mass, old.lever)


def _no_tensor(old: Any) -> tuple[float, Array, Array]:
    return old.mass, old.lever, np.zeros((3, 3))


def _products(old: Any) -> tuple[float, Array, Array]:
    return old.mass, old.lever, 2 * np.diag(np.diag(old.inertia)) - old.inertia


def _no_products(old: Any) -> tuple[float, Array, Array]:
    return old.mass, old.lever, np.diag(np.diag(old.inertia))


def _at_joint(old: Any) -> tuple[float, Array, Array]:
    return old.mass, np.zeros(3), old.inertia


def _mirrored(old: Any) -> tuple[float, Array, Array]:
    return old.mass, -old.lever, old.inertia


def _no_mass(old: Any) -> tuple[float, Array, Array]:
    return 0.0, old.lever, old.inertia


def _without_mass(old: Any) -> tuple[float, Array, Array]:
    return 0.0, old.lever, np.zeros((3, 3))


def _double_mass(old: Any) -> tuple[float, Array, Array]:
    return 2 * old.mass, old.lever, old.inertia


def _half_centre(old: Any) -> tuple[float, Array, Array]:
    return old.mass, old.lever / 2, old.inertia


def _double_centre(old: Any) -> tuple[float, Array, Array]:
    return old.mass, 2 * old.lever, old.inertia


_BODY_CHANGES: tuple[tuple[str, str, Callable[[Any], tuple[float, Array, Array]], float], ...] = (
    (
        "inertia point",
        N_("counts m c² of {link} twice: takes its inertia about the joint and adds m c² again"),
        _about_joint,
        1.0,
    ),
    (
        "inertia point",
        N_(
            "leaves m c² out for {link}: the inertia about the centre stands for that about the "
            "joint"
        ),
        _about_centre,
        1.0,
    ),
    ("inertia left out", N_("leaves the inertia tensor of {link} out"), _no_tensor, 1.1),
    (
        "products of inertia",
        N_("has the products of inertia of {link} with the opposite sign"),
        _products,
        1.1,
    ),
    ("products of inertia", N_("leaves the products of inertia of {link} out"), _no_products, 1.2),
    ("centre", N_("puts the centre of mass of {link} at the joint"), _at_joint, 1.2),
    ("centre", N_("measures the centre of mass of {link} to the other side"), _mirrored, 1.2),
    ("centre", N_("has the centre of mass of {link} at half its distance"), _half_centre, 1.3),
    ("centre", N_("has the centre of mass of {link} at twice its distance"), _double_centre, 1.3),
    ("mass left out", N_("leaves the mass of {link} out"), _no_mass, 1.2),
    ("link left out", N_("leaves {link} out of the dynamics"), _without_mass, 1.3),
    ("mass", N_("counts the mass of {link} twice"), _double_mass, 1.4),
)


def _changes(old: Any, change: Callable[[Any], tuple[float, Array, Array]]) -> bool:
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


def _setting(which: str, value: Array) -> Callable[[DHTable], DHTable]:
    def change(table: DHTable) -> DHTable:
        settings: dict[str, Any] = {which: value}
        return replace(table, **settings)

    return change


def _emptied(column: str) -> Callable[[DHTable], DHTable]:
    def change(table: DHTable) -> DHTable:
        zero: dict[str, Any] = {column: 0.0}
        return replace(table, links=[replace(link, **zero) for link in table.links])

    return change


def _shifted(a: Array, alpha: Array) -> Callable[[DHTable], DHTable]:
    def change(table: DHTable) -> DHTable:
        rows = zip(table.links, a, alpha, strict=True)
        return replace(table, links=[replace(link, a=x, alpha=y) for link, x, y in rows])

    return change


def _body(mass: float, lever: Array, tensor: Array) -> Any:
    """An inertia that may be impossible, as mistaken ones are: the constructor would refuse it."""
    body = pin.Inertia.Zero()
    body.mass, body.lever, body.inertia = mass, lever, tensor
    return body


Body = tuple[float, Array, Array]


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

    changed: Robot = _model("body", "", change).apply(robot)
    return changed


def _placed(com: Array, tensor: Array) -> Callable[[Any], tuple[float, Array, Array]]:
    return lambda old: (old.mass, com, tensor)


def _linked(i: int, **columns: Any) -> Callable[[DHTable], DHTable]:
    def change(table: DHTable) -> DHTable:
        links = list(table.links)
        links[i] = replace(links[i], **columns)
        return replace(table, links=links)

    return change


def with_gravity(robot: Robot, value: Array) -> Robot:
    """The robot under another gravity, (3,) m/s² in the base."""
    changed: Robot = _model("gravity", "", _gravity(value)).apply(robot)
    return changed


def _model(
    kind: str, sentence: str, change: Callable[[Any], None], cost: float = 1.0, place: str = ""
) -> Confusion:
    def apply(robot: Robot) -> Robot:
        model = pin.Model(robot.model)
        change(model)
        return Robot(robot.name, model, robot.tool, "", robot.table, None, robot.source)

    return Confusion(kind, sentence, "robot", apply, cost, place)


def _gravity(value: Array) -> Callable[[Any], None]:
    def change(model: Any) -> None:
        model.gravity.linear = value

    return change


def _armature(joint: int | None) -> Callable[[Any], None]:
    def change(model: Any) -> None:
        kept = np.array(model.armature)
        kept[slice(None) if joint is None else joint] = 0.0
        model.armature = kept

    return change


def _inertial(
    kind: str,
    sentence: str,
    link: int | None,
    change: Callable[[Any], tuple[float, Array, Array]],
    cost: float = 1.0,
) -> Confusion:
    def apply(model: Any) -> None:
        for i in range(1, model.njoints) if link is None else (link + 1,):
            model.inertias[i] = _body(*change(model.inertias[i]))

    place = "" if link is None else f"link {link + 1}"
    return _model(kind, sentence, apply, cost, place)


def _from_the_joint(link: DHLink) -> tuple[Array, Array]:
    """Centre and tensor as if given in the frame at the joint (no Tail in front)."""
    return np.array(link.com), np.array(link.inertia)
