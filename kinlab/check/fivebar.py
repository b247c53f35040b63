"""Five-bars as a domain: names and groups, the plain numbers, random closed poses."""

from __future__ import annotations

from functools import cache
from pathlib import Path
from typing import Any

import numpy as np

from kinlab.arrays import Array
from kinlab.check.quantity import Domain
from kinlab.errors import MechanismError, NameUnknownError, UnreachableError, near
from kinlab.fivebar import FiveBar
from kinlab.fivebar.files import presets
from kinlab.notes.loop import Loop

_CLEAR = 0.15
"""Least sine between two bars in a drawn pose: what is compared is the formula, not rounding."""

_TRIES = 200
"""Poses tried for each one drawn."""

DRAWS = ("theta", "xy", "mode", "v", "a")


def numbers(fivebar: FiveBar) -> Loop:
    """The plain numbers of a five-bar.

    Raises:
        MechanismError: gravity is not along -y, as the note has it.
    """
    gravity = np.asarray(fivebar.gravity)
    if gravity[0] != 0.0:
        raise MechanismError(f"{fivebar.name}: the note's formulas need gravity along -y")
    return Loop(
        name=fivebar.name,
        l1=np.asarray(fivebar.l1),
        l2=np.asarray(fivebar.l2),
        e=fivebar.e,
        crank=np.asarray(fivebar.crank_mass),
        crank_com=np.asarray(fivebar.crank_com),
        crank_inertia=np.asarray(fivebar.crank_inertia),
        rotor=np.square(fivebar.gear_ratio) * np.asarray(fivebar.rotor_inertia),
        rod=np.asarray(fivebar.rod_mass),
        rod_com=np.asarray(fivebar.rod_com),
        rod_inertia=np.asarray(fivebar.rod_inertia),
        payload=fivebar.payload,
        g=-float(gravity[1]),
    )


def load(fivebar: Any) -> FiveBar:
    """A five-bar from itself, a preset's name or a path."""
    if isinstance(fivebar, FiveBar):
        return fivebar
    if isinstance(fivebar, (str, Path)):
        name = str(fivebar)
        return _preset(name) if name in presets() else FiveBar.load(name)
    raise NameUnknownError(f"five-bar: {type(fivebar).__name__} is no FiveBar, name or path of one")


@cache
def _preset(name: str) -> FiveBar:
    return FiveBar.load(name)


def members(name: str) -> tuple[str, ...]:
    """``"fivebar"`` is every preset; another name stands for itself."""
    return tuple(presets()) if name == "fivebar" else (name,)


def sample(
    fivebar: FiveBar, arguments: tuple[str, ...], count: int, rng: np.random.Generator
) -> tuple[Array, ...]:
    """Random closed poses away from singularities, with motions of the tool.

    Crank angles and the assembly are drawn, and Pinocchio closes the loop; so the states do not
    come from the formulas that they are to test.

    Raises:
        NameUnknownError: an argument that cannot be drawn.
        MechanismError: hardly any pose is that far from a singularity.
    """
    for name in arguments:
        if name not in DRAWS:
            raise NameUnknownError(f"argument {name!r} cannot be drawn; {near(name, DRAWS)}")
    chain = fivebar.closed_chain()
    drawn: dict[str, list[Array]] = {name: [] for name in DRAWS}
    for _ in range(_TRIES * count):
        theta = rng.uniform(-np.pi, np.pi, 2)
        try:
            q = chain.assemble(theta, int(rng.choice([-1, 1])))
        except UnreachableError:
            continue
        sines = np.sin([q[1], q[3], q[2] + q[3] - q[0] - q[1]])
        if np.abs(sines).min() < _CLEAR:
            continue
        state = (theta, chain.fk(q), np.sign(sines[:2]), *rng.standard_normal((2, 2)))
        for name, value in zip(DRAWS, state, strict=True):
            drawn[name].append(value * (5.0 if name == "a" else 1.0))
        if len(drawn["theta"]) == count:
            return tuple(np.array(drawn[name]) for name in arguments)
    raise MechanismError(f"{fivebar.name}: hardly any pose is clear of singularities")


def _label(fivebar: FiveBar) -> str:
    return fivebar.name


FIVEBAR = Domain("fivebar", load, _label, numbers, members, sample)
