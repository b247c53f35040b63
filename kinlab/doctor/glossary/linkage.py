"""The notes' vectors, matrices and numbers of a five-bar at one state, each with what it is."""

from __future__ import annotations

from collections.abc import Mapping
from contextlib import suppress

import numpy as np
from numpy.typing import ArrayLike

from kinlab.arrays import Array
from kinlab.check.quantities.fivebar import numbers as plain_numbers
from kinlab.check.quantities.registry import quantities
from kinlab.doctor.glossary.textbook import Glossary, Row, Sense
from kinlab.doctor.linkages.five_bar import asked, turn_and_weight
from kinlab.errors import KinlabError
from kinlab.fivebar.linkage import FiveBar

_LETTERS = {
    "fivebar_equation": ("A", "B", "C"),
    "fivebar_angles": "theta",
    "fivebar_rates": "thetad",
    "fivebar_cranks": "u",
    "fivebar_rods": "w",
    "fivebar_jacobian": "J",
    "fivebar_turn": "thetadd",
    "fivebar_torque": "tau",
    "fivebar_torque_massless": "tau",
    "fivebar_torque_per_acceleration": "G",
}
"""Quantities with what the notes call them; of the loop's equation its three coefficients."""
_LEGS = (0, 1)


def linkage_meanings(fivebar: FiveBar, arguments: Mapping[str, Array]) -> Glossary:
    """What the notes name in the five-bar's kinematics and dynamics, at one state.

    Args:
        fivebar: the linkage.
        arguments: what the quantity has: ``xy`` and, where they are asked for, ``mode``, ``v``,
            ``a``, ``theta``, one state each.
    """
    found = _Named()
    answers: dict[str, Array] = {}
    stacks = {name: np.asarray(value)[None] for name, value in arguments.items()}
    for name, letters in _LETTERS.items():
        if any(one not in arguments for one in quantities()[name].arguments):
            continue
        with suppress(KinlabError, np.linalg.LinAlgError), np.errstate(all="ignore"):
            answer = asked(name, fivebar, stacks)[0]
            if np.isfinite(answer).all():
                answers[name] = answer
                found.of([letters] if isinstance(letters, str) else [*letters], answer)
    plain = plain_numbers(fivebar)
    for letter in ("xy", "v", "a"):
        if letter in arguments:
            found.put("given", np.asarray(arguments[letter]), letter)
    for name, pair in {"l1": plain.l1, "l2": plain.l2, "I_A": plain.arm}.items():
        for value in pair:
            found.put("parameter", value, name)
    if "fivebar_angles" in answers or "theta" in arguments:
        angles = answers.get("fivebar_angles", arguments.get("theta", np.zeros(2)))
        for i in _LEGS:
            found.put("symbol", np.sin(angles[i]), f"sin(theta_{i + 1})", 1)
            found.put("symbol", np.cos(angles[i]), f"cos(theta_{i + 1})", 1)
    if "fivebar_rods" in answers:
        _of_legs(found, fivebar, arguments, answers)
    if "fivebar_turn" in answers:
        with suppress(KinlabError, np.linalg.LinAlgError), np.errstate(all="ignore"):
            parts = zip(("f", "tau_Ag"), turn_and_weight(fivebar, stacks), strict=True)
            for letters, answer in ((name, legs[:, 0]) for name, legs in parts):
                if np.isfinite(answer).all():
                    found.of([letters], answer)
    if "fivebar_jacobian" in answers:
        J = answers["fivebar_jacobian"]
        if abs(np.linalg.det(J)) > 0:
            found.put("symbol", np.linalg.inv(J), "J^-1")
            found.put("symbol", np.linalg.inv(J).T, "J^-T")
        found.put("symbol", np.linalg.det(J), "det J")
    return found.glossary()


def _of_legs(
    found: _Named, fivebar: FiveBar, arguments: Mapping[str, Array], answers: dict[str, Array]
) -> None:
    """Products of the bars' directions, and where their ends are."""
    plain, xy = plain_numbers(fivebar), np.asarray(arguments["xy"])
    u, w = answers["fivebar_cranks"], answers["fivebar_rods"]
    for i in _LEGS:
        leg = str(i + 1)
        base = np.array([plain.e if i == 0 else -plain.e, 0.0])
        across = u[i, 0] * w[i, 1] - u[i, 1] * w[i, 0]
        found.put("symbol", across, f"u_{leg} x w_{leg}")
        found.put("symbol", plain.l1[i] * across, f"l1 (u_{leg} x w_{leg})", 1)
        found.put("symbol", u[i] @ w[i], f"u_{leg} w_{leg}", 1)
        found.put("symbol", plain.l1[i] * u[i], f"l1 u_{leg}", 1)
        found.put("symbol", plain.l2[i] * w[i], f"l2 w_{leg}", 1)
        found.put("symbol", base + plain.l1[i] * u[i], f"elbow {leg}", 1)
        found.put("symbol", xy - base, f"xy - base {leg}", 1)
        for bar, one in (("u", u[i]), ("w", w[i])):
            found.put("symbol", np.array([-one[1], one[0]]), f"z x {bar}_{leg}", 1)
            if "v" in arguments:
                found.put("symbol", arguments["v"] @ one, f"v {bar}_{leg}", 1)
                found.put("symbol", (arguments["v"] @ one) ** 2, f"(v {bar}_{leg})^2", 2)


class _Named:
    """The things of one state while they are gathered."""

    def __init__(self) -> None:
        self.found: dict[tuple[int, ...], tuple[list[Row], list[Array]]] = {}

    def put(self, what: str, value: ArrayLike, of: str, rank: int = 0) -> None:
        array = np.asarray(value, dtype=float)
        rows, values = self.found.setdefault(array.shape, ([], []))
        rows.append((rank, Sense(what, of=of)))
        values.append(array)

    def of(self, names: list[str], answer: Array) -> None:
        """An answer as a whole, its rows, and its entries."""
        if len(names) > 1:
            for (i, k), value in np.ndenumerate(answer):
                self.put("symbol", value, f"{names[k]}_{i + 1}")
            return
        self.put("symbol", answer, names[0])
        for i, row in enumerate(answer):
            self.put("symbol", row, f"{names[0]}_{i + 1}", int(answer.ndim > 1))
            for j, value in enumerate(row if answer.ndim > 1 else ()):
                self.put("symbol", value, f"{names[0]}_{i + 1}{j + 1}", 1)

    def glossary(self) -> Glossary:
        """All of it."""
        return Glossary({shape: (rows, np.stack(x)) for shape, (rows, x) in self.found.items()})
