"""What is wrong with a body's number, told from what is written and what is meant.

As in :mod:`kinlab.doctor.tables.words`: the first relation that turns the one into the other is the
slip that is named.
"""

from __future__ import annotations

from collections.abc import Callable, Iterator
from dataclasses import dataclass
from itertools import combinations, permutations, product
from typing import Any

import numpy as np

from kinlab.arrays import Array
from kinlab.doctor.tables.chain import inverse
from kinlab.doctor.tables.words import Cause, at_row, listed, number
from kinlab.host.language import N_, _
from kinlab.model.dh import DHLink
from kinlab.model.link import steiner


@dataclass(frozen=True, eq=False)
class Body:
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

    def alike(self, one: Array, two: Array) -> bool:
        """Whether two arrays are the same to rounding and printed digits."""
        return _alike(one, two, self.slack)

    def power(self, one: float, two: float) -> int:
        """k where one is 10^k times two, k not 0; else 0."""
        if one * two <= 0.0:
            return 0
        return _power(one / two, self.slack / min(abs(one), abs(two)))


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


def mass_cause(one: Body) -> Cause:
    """Names a slip in a mass."""
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


def _frames_of(one: Body) -> Iterator[tuple[str, Array]]:
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


_Slip = tuple[Array, str, str, float]
"""What would be written, the kind of the slip, the slip in words, and its cost."""


def com_cause(one: Body) -> Cause:
    """Names a slip in a centre of mass."""
    return _first(one, "com", one.written.com, one.com, _com_slips(one), _vector)


def inertia_cause(one: Body) -> Cause:
    """Names a slip in an inertia."""
    return _first(one, "inertia", one.written.inertia, one.inertia, _inertia_slips(one), _tensor)


def _first(
    one: Body,
    column: str,
    given: Any,
    meant: Array,
    slips: Iterator[_Slip],
    shown: Callable[[Array], str],
) -> Cause:
    """The first of the slips that gives what is written; a wrong value where none does."""
    written = np.asarray(given)
    found = (slip[1:] for slip in slips if one.alike(written, slip[0]))
    kind, slip, cost = next(found, ("value", _(_WRONG[column]), 2.0))
    told = (_BOTH, shown(written), shown(meant))
    return _body_cause(one.row, column, (written, meant), kind, slip, cost, told)


_WRONG = {"com": N_("com is wrong"), "inertia": N_("inertia is wrong")}


def _com_slips(one: Body) -> Iterator[_Slip]:
    """Slips in a centre of mass, in the order in which they are believed."""
    written, meant = np.asarray(one.written.com), one.com
    if not written.any():
        yield written, "missing", _("com is missing"), 1.2
    for signs in _signs(3):
        some = [name for name, s, x in zip("xyz", signs, meant, strict=True) if s < 0 and x]
        told = _("com has the wrong sign in {axes}").format(axes=", ".join(some))
        if len(some) == 3:
            told = _("com has the wrong sign")
        yield signs * meant, "sign", told, 1.0
    yield 1000.0 * meant, "millimetres", _("com is in millimetres"), 1.0
    for factor in (100.0, 10.0, 0.1, 0.01, 0.001):
        yield factor * meant, "decimal", _("com has the decimal point displaced"), 1.0
    wrong = np.flatnonzero(
        np.abs(written - meant) > 1e-8 * np.max(np.abs(meant)) + 1e-12 + one.slack
    )
    if len(wrong) == 1 and one.power(float(meant[wrong[0]]), float(written[wrong[0]])):
        told = _("com has the decimal point displaced in {axis}").format(axis="xyz"[wrong[0]])
        yield written, "decimal", told, 1.0
    for order in permutations(range(3)):
        yield meant[list(order)], "axes", _("com has its axes in another order"), 1.0
    for name, pose in _frames_of(one):
        rotation, origin = pose[:3, :3], pose[:3, 3]
        elsewhere = _("com is counted from the origin of {name}").format(name=name)
        if name == _frame(one.row + 1) and np.allclose(rotation, np.eye(3), atol=1e-9):
            yield meant - origin, "other end", elsewhere, 1.0  # as well in that frame
        told = _("com is given in {name}").format(name=name)
        yield (inverse(pose) @ [*meant, 1.0])[:3], "frame", told, 1.0
        yield meant - origin, "other end", elsewhere, 1.0
        yield rotation.T @ meant, "frame", _("com has the axes of {name}").format(name=name), 1.05
    for order in permutations(range(3)):
        for signs in _signs(3):
            yield signs * meant[list(order)], "axes", _("com has its axes turned"), 1.2
    for name, pose in _frames_of(one):
        told = _("com is shifted against the origin of {name}").format(name=name)
        yield meant + pose[:3, 3], "other end", told, 1.2
        told = _("com is transformed the wrong way from {name}").format(name=name)
        yield (pose @ [*meant, 1.0])[:3], "frame", told, 1.2
        told = _("com is turned the wrong way from the axes of {name}").format(name=name)
        yield pose[:3, :3] @ meant, "frame", told, 1.2


_ABOUT_ORIGIN = (
    N_("inertia is about the origin of frame {number}, not the centre of mass"),
    N_(
        "inertia is about the origin of frame {number}, not the centre of mass (of the com written)"
    ),
)
_TWICE = (
    N_("inertia has the shift of origin taken off twice"),
    N_("inertia has the shift of origin taken off twice (of the com written)"),
)


def _inertia_slips(one: Body) -> Iterator[_Slip]:
    """Slips in an inertia, in the order in which they are believed."""
    written, meant = np.asarray(one.written.inertia), one.inertia
    if not written.any():
        yield written, "missing", _("inertia is missing"), 1.0
    coms = (one.com, np.asarray(one.written.com))
    for com, about, twice in zip(coms, _ABOUT_ORIGIN, _TWICE, strict=True):
        shift = steiner(one.mass, com)
        if shift.any():
            yield meant + shift, "origin", _(about).format(number=one.row), 1.0
            yield meant - shift, "origin", _(twice), 1.1
    yield from _product_slips(one)
    for factor in (10.0, 0.1, 100.0, 0.01, 1e3, 1e-3):
        yield factor * meant, "decimal", _("inertia has the decimal point displaced"), 1.0
    for factor in (1e4, 1e6, 1e9):
        told = _("inertia is {factor:g} times too large, as in other units").format(factor=factor)
        yield factor * meant, "units", told, 1.0
    off = np.abs(written - meant) > 1e-8 * float(np.max(np.abs(meant))) + one.slack
    wrong = [(i, j) for i in range(3) for j in range(i, 3) if off[i, j]]
    if len(wrong) == 1:
        (place,) = wrong
        name = f"I{'xyz'[place[0]]}{'xyz'[place[1]]}"
        if one.power(float(written[place]), float(meant[place])):
            told = _("inertia has the decimal point displaced in {name}").format(name=name)
            yield written, "decimal", told, 1.0
        if written[place] == 0.0:
            yield written, "missing", _("inertia lacks {name}").format(name=name), 1.2
    for order in permutations(range(3)):
        other = meant.copy()
        np.fill_diagonal(other, np.diag(meant)[list(order)])
        yield other, "order", _("inertia has its principal values in another order"), 1.0
    if not written[~np.eye(3, dtype=bool)].any():
        yield np.diag(np.diag(meant)), "missing", _("inertia lacks its products"), 1.2
    for name, pose in _frames_of(one):
        rotation = pose[:3, :3]
        told = _("inertia has the axes of {name}").format(name=name)
        yield rotation.T @ meant @ rotation, "frame", told, 1.0
        told = _("inertia is turned the wrong way from the axes of {name}").format(name=name)
        yield rotation @ meant @ rotation.T, "frame", told, 1.1
    for order in permutations(range(3)):
        told = _("inertia has its axes in another order")
        yield meant[np.ix_(order, order)], "axes", told, 1.1
    for name, pose in _frames_of(one):
        shift = steiner(one.mass, one.com - pose[:3, 3])
        if shift.any():
            told = _("inertia is about the origin of {name}").format(name=name)
            yield meant + shift, "origin", told, 1.1


def _product_slips(one: Body) -> Iterator[_Slip]:
    """Products of inertia with the wrong sign and nothing else, the most of them first."""
    nonzero = [place for place in ((0, 1), (0, 2), (1, 2)) if abs(one.inertia[place]) > one.slack]
    for count in range(len(nonzero), 0, -1):
        for some in combinations(nonzero, count):
            other = one.inertia.copy()
            for i, j in some:
                other[i, j] = other[j, i] = -one.inertia[i, j]
            named = listed(f"I{'xyz'[i]}{'xyz'[j]}" for i, j in some)
            told = _("inertia has the wrong sign of {entries}").format(entries=named)
            if count == len(nonzero):
                told = _("inertia has the wrong sign of its products")
            yield other, "products", told, 1.0


def armature_cause(row: int, written: float, meant: float) -> Cause:
    """Names a slip in the inertia of a joint's drive."""

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


def gravity_cause(written: Array, meant: Array, poses: Array) -> Cause:
    """Names a slip in gravity; ``poses`` are the frames at q = 0."""

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


def _alike(one: Array, two: Array, slack: float = 0.0) -> bool:
    scale = float(np.max(np.abs(two), initial=0.0))
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
