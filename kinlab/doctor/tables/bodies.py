"""Dynamic slips: masses, centres, inertias, armatures and gravity, link by link.

A body is told by what no choice of link frames can change: its mass, the place of its centre and
its inertia about it with the axes of the world, all at q = 0; what is welded together counts as
one body. Both sides are brought into that form, and what differs is brought back into the frame
of the user's row, so that the numbers meant are known; the relation of the written ones to them
names the slip.
"""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass, replace
from itertools import combinations, permutations, product
from typing import Any

import numpy as np

from kinlab.arrays import Array
from kinlab.doctor.tables.chain import Chain, frames, inverse
from kinlab.doctor.tables.words import Cause, at_row, listed, number
from kinlab.host.language import N_, _
from kinlab.model.dh import DHLink, DHTable, with_links
from kinlab.model.link import steiner
from kinlab.tolerances import TOLERANCES


@dataclass(frozen=True, eq=False)
class Bodies:
    """The moving bodies of an arm at q = 0, in the world.

    Attributes:
        mass: kg, (n,).
        com: centres, (n, 3), m.
        inertia: about the centres, axes of the world, (n, 3, 3), kg m².
        armature: (n,), or None where the reference has no place for it.
        gravity: (3,), m/s², or None likewise.
    """

    mass: Array
    com: Array
    inertia: Array
    armature: Array | None
    gravity: Array | None
    digit: float = 0.0
    """One unit of the last digit of printed numbers; 0 where all digits are known."""

    @property
    def any(self) -> bool:
        """Whether any body has mass or inertia."""
        return bool(self.mass.any() or self.inertia.any())

    @staticmethod
    def of(table: DHTable) -> Bodies:
        """The bodies of a table."""
        poses = frames(Chain.of(table), np.zeros((1, table.n)))[0, 1:-1]
        com = np.array([link.com for link in table.links])
        inertia = np.array([link.inertia for link in table.links])
        rotation = poses[:, :3, :3]
        return Bodies(
            np.array([link.mass for link in table.links]),
            (rotation @ com[..., None])[..., 0] + poses[:, :3, 3],
            rotation @ inertia @ np.swapaxes(rotation, -1, -2),
            np.array([link.armature for link in table.links]),
            np.array(table.gravity),
        )


@dataclass(frozen=True, eq=False)
class _Link:
    """A row's written and meant body, in its own frame."""

    row: int
    written: DHLink
    mass: float
    com: Array
    inertia: Array
    slack: float
    """Absolute error of the numbers meant, from printed digits."""
    poses: Array
    """Frames 0 to n and the tool at q = 0, (n + 2, 4, 4)."""

    def alike(self, one: Array, two: Array, scale: float = 0.0) -> bool:
        """Whether two arrays are the same to rounding and printed digits."""
        return _alike(one, two, scale, self.slack)

    def power(self, one: float, two: float) -> int:
        """k where one is 10^k times two, k not 0; else 0."""
        return _power(one / two, self.slack / min(abs(one), abs(two)))


def differences(table: DHTable, bodies: Bodies) -> tuple[DHTable, list[Cause]]:
    """Compares a table's bodies with a reference's, kinematics being the same.

    Args:
        table: the table, its kinematic slips taken back.
        bodies: of the reference.

    Returns:
        The table with the bodies of the reference, and one cause for each cell that differs.
    """
    mine = Bodies.of(table)
    poses = frames(Chain.of(table), np.zeros((1, table.n)))[0]
    size = max(1.0, float(np.max(np.abs(poses[:, :3, 3]))))
    causes: list[Cause] = []
    links = list(table.links)
    slack = 2.0 * bodies.digit
    for i, link in enumerate(table.links):
        back = inverse(poses[i + 1])
        com = back[:3, :3] @ bodies.com[i] + back[:3, 3]
        inertia = back[:3, :3] @ bodies.inertia[i] @ back[:3, :3].T
        one = _Link(
            i + 1, link, float(bodies.mass[i]), com, 0.5 * (inertia + inertia.T), slack, poses
        )
        changes: dict[str, object] = {}
        if abs(one.mass - link.mass) > TOLERANCES.same_body * max(one.mass, link.mass) + slack:
            causes.append(_mass_cause(one))
            changes["mass"] = one.mass
        massive = one.mass > 0.0
        if (
            massive
            and np.max(np.abs(com - np.asarray(link.com)))
            > 1e-9 * size + slack * (table.n + 1) * size
        ):
            clean = _tidy(com)
            causes.append(_com_cause(replace(one, com=clean, slack=slack * (table.n + 1) * size)))
            changes["com"] = clean
        limit = slack * (table.n + 1) * max(1.0, float(np.max(np.abs(inertia)))) + (
            TOLERANCES.same_body * float(np.max(np.abs(inertia)))
            + 1e-14
            + 1e-10 * float(np.max(np.abs(link.inertia)))
        )
        if np.max(np.abs(one.inertia - np.asarray(link.inertia))) > limit:
            clean = _tidy(one.inertia)
            causes.append(
                _inertia_cause(replace(one, inertia=clean, slack=limit if slack else 0.0))
            )
            changes["inertia"] = clean
        if bodies.armature is not None:
            meant = float(bodies.armature[i])
            if abs(meant - link.armature) > TOLERANCES.same_body * max(meant, link.armature):
                causes.append(_armature_cause(i + 1, link.armature, meant))
                changes["armature"] = meant
        if changes:
            links[i] = replace(link, **changes)  # type: ignore[arg-type]
    repaired = with_links(table, links)
    if bodies.gravity is not None and mine.gravity is not None:
        gap = float(np.max(np.abs(bodies.gravity - mine.gravity)))
        if gap > 1e-9 * max(1.0, float(np.max(np.abs(bodies.gravity)))):
            causes.append(_gravity_cause(mine.gravity, bodies.gravity, poses))
            repaired = replace(repaired, gravity=bodies.gravity)
    return repaired, _together(causes, table.n)


def _together(causes: list[Cause], n: int) -> list[Cause]:
    """The same slip in three rows or more, or in all of them, is one."""
    out: list[Cause] = []
    for cause in causes:
        same = [c for c in causes if (c.column, c.kind) == (cause.column, cause.kind)]
        every = len(same) > 1 and len(same) == n
        if (len(same) < 3 and not every) or cause.kind == "value" or cause.row is None:
            out.append(cause)
            continue
        if same[0] is not cause:
            continue
        rows = tuple(row for c in same for row in c.rows)
        told = _("rows {rows}: {slip}")
        named = _(", ").join(map(str, rows))
        if rows == tuple(range(rows[0], rows[-1] + 1)):
            told = _("rows {first} to {last}: {slip}")
        out.append(
            Cause(
                rows,
                cause.column,
                [c.written for c in same],
                [c.meant for c in same],
                cause.kind,
                told.format(rows=named, first=rows[0], last=rows[-1], slip=cause.short),
                cause.cost,
            )
        )
    return out


_BOTH = N_("{slip}: {written} written, {meant} meant")
_MEANT = N_("{slip}: {meant}")
_WRITTEN = N_("{slip}: {written} written")


def _body_cause(
    row: int,
    column: str,
    values: tuple[Any, Any],
    kind: str,
    slip: str,
    cost: float,
    told: tuple[str, str, str],
) -> Cause:
    """A slip of a body: ``told`` is the form of the sentence and both numbers in words."""
    form, written, meant = told
    said = _(form).format(slip=slip, written=written, meant=meant)
    return Cause(row, column, *values, kind, at_row(row, said), cost, slip)


def _mass_cause(one: _Link) -> Cause:
    written, meant = float(one.written.mass), one.mass

    def cause(kind: str, slip: str, cost: float, form: str = _BOTH, unit: str = "") -> Cause:
        told = (form, f"{number(written)}{unit}", f"{number(meant)} kg")
        return _body_cause(one.row, "mass", (written, meant), kind, slip, cost, told)

    if written == 0.0:
        return cause("missing", _("mass is forgotten"), 1.0, _MEANT)
    if meant == 0.0:
        return cause("superfluous", _("mass must be zero"), 1.5, _WRITTEN, " kg")
    if one.power(written, meant) == 3:
        return cause("grams", _("mass is in grams"), 1.0)
    power = one.power(meant, written)
    if power:
        return cause("decimal", _("mass: the decimal point is displaced"), 1.0)
    return cause("value", _("mass is wrong"), 2.0)


def _frames_of(one: _Link) -> Iterator[tuple[str, Array]]:
    """Other frames and their poses in frame i, at q = 0."""
    here = inverse(one.poses[one.row])
    n = len(one.poses) - 2
    yield _frame(one.row - 1), here @ one.poses[one.row - 1]
    if one.row < n:
        yield _frame(one.row + 1), here @ one.poses[one.row + 1]
    yield _("the tool"), here @ one.poses[-1]
    yield _("the world"), here
    if one.row > 1:
        yield _("the base"), here @ one.poses[0]
    for other in range(1, n + 1):
        if abs(other - one.row) > 1:
            yield _frame(other), here @ one.poses[other]


def _frame(number_: int) -> str:
    return _("frame {number}").format(number=number_)


def _com_cause(one: _Link) -> Cause:
    written, meant = np.asarray(one.written.com), one.com

    def cause(kind: str, slip: str, cost: float) -> Cause:
        told = (_BOTH, _vector(written), _vector(meant))
        return _body_cause(one.row, "com", (written, meant), kind, slip, cost, told)

    if not written.any():
        return cause("missing", _("com is missing"), 1.2)
    for signs in _signs(3):
        if one.alike(written, signs * meant):
            some = [name for name, s, x in zip("xyz", signs, meant, strict=True) if s < 0 and x]
            if len(some) == 3:
                return cause("sign", _("com has the wrong sign"), 1.0)
            told = _("com has the wrong sign in {axes}").format(axes=", ".join(some))
            return cause("sign", told, 1.0)
    for factor in (1000.0, 100.0, 10.0, 0.1, 0.01, 0.001):
        if one.alike(written, factor * meant):
            if factor == 1000.0:
                return cause("millimetres", _("com is in millimetres"), 1.0)
            return cause("decimal", _("com has the decimal point displaced"), 1.0)
    wrong = np.flatnonzero(
        np.abs(written - meant) > 1e-8 * np.max(np.abs(meant)) + 1e-12 + one.slack
    )
    if len(wrong) == 1:
        k = int(wrong[0])
        if meant[k] and written[k] and one.power(float(meant[k]), float(written[k])):
            return cause(
                "decimal",
                _("com has the decimal point displaced in {axis}").format(axis="xyz"[k]),
                1.0,
            )
    for order in permutations(range(3)):
        if one.alike(written, meant[list(order)]):
            return cause("axes", _("com has its axes in another order"), 1.0)
    for name, pose in _frames_of(one):
        plain = name == _frame(one.row + 1) and np.allclose(pose[:3, :3], np.eye(3), atol=1e-9)
        if plain and one.alike(written, meant - pose[:3, 3]):  # as well in that frame
            return cause(
                "other end", _("com is counted from the origin of {name}").format(name=name), 1.0
            )
        if one.alike(written, (inverse(pose) @ [*meant, 1.0])[:3]):
            return cause("frame", _("com is given in {name}").format(name=name), 1.0)
        if one.alike(written, meant - pose[:3, 3]):
            return cause(
                "other end", _("com is counted from the origin of {name}").format(name=name), 1.0
            )
        if one.alike(written, pose[:3, :3].T @ meant):
            return cause("frame", _("com has the axes of {name}").format(name=name), 1.05)
    for order in permutations(range(3)):
        for signs in _signs(3):
            if one.alike(written, signs * meant[list(order)]):
                return cause("axes", _("com has its axes turned"), 1.2)
    for name, pose in _frames_of(one):
        if one.alike(written, meant + pose[:3, 3]):
            return cause(
                "other end", _("com is shifted against the origin of {name}").format(name=name), 1.2
            )
        if one.alike(written, (pose @ [*meant, 1.0])[:3]):
            return cause(
                "frame", _("com is transformed the wrong way from {name}").format(name=name), 1.2
            )
        if one.alike(written, pose[:3, :3] @ meant):
            return cause(
                "frame",
                _("com is turned the wrong way from the axes of {name}").format(name=name),
                1.2,
            )
    return cause("value", _("com is wrong"), 2.0)


def _inertia_cause(one: _Link) -> Cause:
    written, meant = np.asarray(one.written.inertia), one.inertia

    def cause(kind: str, slip: str, cost: float) -> Cause:
        told = (_BOTH, _tensor(written), _tensor(meant))
        return _body_cause(one.row, "inertia", (written, meant), kind, slip, cost, told)

    if not written.any():
        return cause("missing", _("inertia is missing"), 1.0)
    for com, own in ((one.com, True), (np.asarray(one.written.com), False)):
        shift = steiner(one.mass, com)
        if shift.any() and one.alike(written, meant + shift):
            told = (
                _("inertia is about the origin of frame {number}, not the centre of mass")
                if own
                else _(
                    "inertia is about the origin of frame {number}, not the centre of mass (of "
                    "the com written)"
                )
            )
            return cause("origin", told.format(number=one.row), 1.0)
        if shift.any() and one.alike(written, meant - shift):
            told = (
                _("inertia has the shift of origin taken off twice")
                if own
                else _("inertia has the shift of origin taken off twice (of the com written)")
            )
            return cause("origin", told, 1.1)
    found = _products(one)
    if found:
        return cause("products", found, 1.0)
    for factor in (10.0, 0.1, 100.0, 0.01, 1e3, 1e-3, 1e4, 1e6, 1e9):
        if one.alike(written, factor * meant):
            if factor >= 1e4:
                return cause(
                    "units",
                    _("inertia is {factor:g} times too large, as in other units").format(
                        factor=factor
                    ),
                    1.0,
                )
            return cause("decimal", _("inertia has the decimal point displaced"), 1.0)
    limit = 1e-8 * float(np.max(np.abs(meant))) + one.slack
    off = np.abs(written - meant) > limit
    wrong = [(i, j) for i in range(3) for j in range(i, 3) if off[i, j]]
    if len(wrong) == 1:
        i, j = wrong[0]
        name = f"I{'xyz'[i]}{'xyz'[j]}"
        if meant[i, j] and one.power(float(written[i, j]), float(meant[i, j])):
            return cause(
                "decimal",
                _("inertia has the decimal point displaced in {name}").format(name=name),
                1.0,
            )
        if written[i, j] == 0.0:
            return cause("missing", _("inertia lacks {name}").format(name=name), 1.2)
    off = ~np.eye(3, dtype=bool)
    if one.alike(written[off], meant[off], np.max(np.abs(meant))):
        for order in permutations(range(3)):
            if one.alike(np.diag(written), np.diag(meant)[list(order)]):
                return cause("order", _("inertia has its principal values in another order"), 1.0)
    if not written[off].any() and one.alike(np.diag(written), np.diag(meant)):
        return cause("missing", _("inertia lacks its products"), 1.2)
    for name, pose in _frames_of(one):
        rotation = pose[:3, :3]
        if one.alike(written, rotation.T @ meant @ rotation):
            return cause("frame", _("inertia has the axes of {name}").format(name=name), 1.0)
        if one.alike(written, rotation @ meant @ rotation.T):
            return cause(
                "frame",
                _("inertia is turned the wrong way from the axes of {name}").format(name=name),
                1.1,
            )
    for order in permutations(range(3)):
        if one.alike(written, meant[np.ix_(order, order)]):
            return cause("axes", _("inertia has its axes in another order"), 1.1)
    for name, pose in _frames_of(one):
        shift = steiner(one.mass, one.com - pose[:3, 3])
        if shift.any() and one.alike(written, meant + shift):
            return cause(
                "origin", _("inertia is about the origin of {name}").format(name=name), 1.1
            )
    return cause("value", _("inertia is wrong"), 2.0)


def _products(one: _Link) -> str:
    """Which products of inertia have the wrong sign and nothing else, in words."""
    written, meant = np.asarray(one.written.inertia), one.inertia
    places = [(0, 1), (0, 2), (1, 2)]
    if not one.alike(np.diag(written), np.diag(meant)):
        return ""
    nonzero = [p for p in places if abs(meant[p]) > one.slack]
    for count in range(len(nonzero), 0, -1):
        for some in combinations(nonzero, count):
            other = meant.copy()
            for i, j in some:
                other[i, j] = other[j, i] = -meant[i, j]
            if one.alike(written, other):
                if count == len(nonzero):
                    return _("inertia has the wrong sign of its products")
                named = listed(f"I{'xyz'[i]}{'xyz'[j]}" for i, j in some)
                return _("inertia has the wrong sign of {entries}").format(entries=named)
    return ""


def _armature_cause(row: int, written: float, meant: float) -> Cause:

    def cause(kind: str, slip: str, cost: float, form: str = _BOTH) -> Cause:
        told = (form, number(written), number(meant))
        return _body_cause(row, "armature", (written, meant), kind, slip, cost, told)

    if written == 0.0:
        return cause("missing", _("armature is missing"), 1.0, _MEANT)
    if meant == 0.0:
        return cause("superfluous", _("armature must be zero"), 1.5, _WRITTEN)
    power = _power(meant / written)
    if abs(power) in (1, 3):
        return cause("decimal", _("armature: the decimal point is displaced"), 1.0)
    gear = float(np.sqrt(meant / written))
    if gear > 1.0:
        told = _("armature is that of the motor, J in place of G^2 J with G = {gear:.6g}")
        return cause("gear", told.format(gear=gear), 1.0)
    told = _("armature has a factor {factor} too much")
    return cause("gear", told.format(factor=number(written / meant)), 1.5)


def _gravity_cause(written: Array, meant: Array, poses: Array) -> Cause:

    def cause(kind: str, slip: str, cost: float) -> Cause:
        told = _(_BOTH).format(slip=slip, written=_vector(written), meant=_vector(meant))
        return Cause(None, "gravity", written, meant, kind, told, cost)

    if not written.any():
        return cause("missing", _("gravity is missing"), 1.0)
    if _alike(written, -meant):
        return cause("sign", _("gravity points the other way"), 1.0)
    for order in permutations(range(3)):
        for signs in _signs(3, True):
            if _alike(written, signs * meant[list(order)]):
                return cause("direction", _("gravity points along another axis"), 1.0)
    rotation = poses[0, :3, :3]
    if _alike(written, rotation.T @ meant) or _alike(written, rotation @ meant):
        return cause("frame", _("gravity is given in the axes of frame 0"), 1.0)
    if abs(np.linalg.norm(written) - np.linalg.norm(meant)) < 1e-8 * np.linalg.norm(meant):
        return cause("direction", _("gravity points in another direction"), 1.5)
    power = _power(float(np.linalg.norm(meant) / np.linalg.norm(written)))
    if power and _alike(written * 10.0**power, meant):
        return cause("decimal", _("gravity has the decimal point displaced"), 1.0)
    return cause("value", _("gravity is wrong"), 2.0)


def _signs(count: int, all_plus: bool = False) -> Iterator[Array]:
    """Sign patterns, the fewest minuses first but all three before two."""
    patterns = sorted(product((1.0, -1.0), repeat=count), key=lambda s: (s.count(-1.0) % 3, s))
    for pattern in patterns:
        if all_plus or -1.0 in pattern:
            yield np.array(pattern)


def _tidy(values: Array) -> Array:
    """Without rounding residue, relative to the largest entry."""
    scale = float(np.max(np.abs(values), initial=0.0)) or 1.0
    digits = 13 - int(np.floor(np.log10(scale)))
    return np.asarray(np.round(values, digits) + 0.0) if digits < 300 else values


def _alike(one: Array, two: Array, scale: float = 0.0, slack: float = 0.0) -> bool:
    scale = scale or float(np.max(np.abs(two), initial=0.0))
    return bool(np.max(np.abs(np.asarray(one) - two), initial=0.0) <= 1e-7 * scale + 1e-13 + slack)


def _power(ratio: float, slack: float = 0.0) -> int:
    """k where the ratio is 10^k, k from -4 to 4 and not 0; else 0."""
    if ratio <= 0.0:
        return 0
    k = round(float(np.log10(ratio)))
    close = abs(ratio - 10.0**k) <= (1e-7 + slack) * 10.0**k
    return k if k and abs(k) <= 4 and close else 0


def _vector(values: Array) -> str:
    return f"({', '.join(f'{float(x) + 0.0:.6g}' for x in values)})"


def _tensor(values: Array) -> str:
    entries = [values[0, 0], values[1, 1], values[2, 2], values[0, 1], values[0, 2], values[1, 2]]
    return _vector(np.array(entries))
