"""The textbooks' derivations walked with one step, then two, taken otherwise: which gives this?"""

from __future__ import annotations

from collections.abc import Callable, Iterator
from dataclasses import dataclass
from itertools import combinations
from typing import Any

import numpy as np

from kinlab.arrays import Array
from kinlab.check.compare import error_sizes
from kinlab.check.quantities.serial import SERIAL
from kinlab.doctor.changes import Case
from kinlab.doctor.confusions.columns import column_steps, jacobians, lagrange
from kinlab.doctor.confusions.links import matrix_steps, products
from kinlab.doctor.confusions.otherwise import mass_slope
from kinlab.doctor.confusions.recursion import Step, geometry, steps, torques
from kinlab.host.language import _
from kinlab.tolerances import TOLERANCES

Ways = list[tuple[Step, ...]]
Road = Callable[[Ways, dict[str, Array]], Array]

_SCREEN = 3
_PAIRED = 110
"""Steps that are tried two at a time, the likeliest first."""
_SMALL = 3
"""Joints up to which pairs of steps of Lagrange's way are tried."""


@dataclass(frozen=True)
class Found:
    """Steps of a derivation that, taken otherwise, give the hand formula at every state.

    Attributes:
        steps: one or two.
        error: the relative error that is left.
        cost: how far-fetched they are.
    """

    steps: tuple[Step, ...]
    error: float
    cost: float


def taken_otherwise(case: Case) -> list[Found]:
    """What explains the hand formula by one step; nothing where none does."""
    return [
        found for road, tried in _roads(case) for found in _tried(case, road, [(s,) for s in tried])
    ]


def two_taken_otherwise(case: Case) -> list[Found]:
    """What explains the hand formula by two steps."""
    found: list[Found] = []
    for road, tried in _roads(case, pairs=True):
        likely = sorted((s for s in tried if s.joint is None), key=lambda s: s.cost)[:_PAIRED]
        ways: Ways = [
            (one, two)
            for one, two in combinations(likely, 2)
            if one.weights.keys().isdisjoint(two.weights)
        ]
        found += _tried(case, road, ways)
    return found


def _tried(case: Case, road: Road, ways: Ways) -> Iterator[Found]:
    if not ways:
        return
    few = case.few(_SCREEN)
    size = error_sizes(np.asarray(case.answer(())))
    right = road([()], few.arguments)[0]
    near = road(ways, few.arguments)
    good = [k for k in range(len(ways)) if _error(near[k], few, size[:_SCREEN]) <= _LOOSE]
    moved = [k for k in good if np.max(np.abs(near[k] - right)) > TOLERANCES.formula_agrees]
    if not moved:
        return
    full = road([ways[k] for k in moved], case.arguments)
    for k, values in zip(moved, full, strict=True):
        error = _error(values, case, size)
        if error <= _LOOSE:
            cost = sum(s.cost for s in ways[k]) + 0.4 * (len(ways[k]) - 1)
            yield Found(ways[k], error, cost)


_LOOSE = TOLERANCES.formula_agrees


def _error(values: Array, case: Case, size: Array) -> float:
    chosen = values[(slice(None), *case.index)]
    if chosen.shape != case.hand.shape:
        return np.inf
    gap = np.abs(chosen - case.hand).reshape(len(chosen), -1)
    worst = np.max(gap, axis=1) / size
    return float(np.max(np.where(np.isfinite(worst), worst, np.inf)))


def _roads(case: Case, pairs: bool = False) -> Iterator[tuple[Road, list[Step]]]:
    """The derivations of a quantity, with their steps."""
    if case.quantity.domain is not SERIAL or case.robot.n > 7 or "q" not in case.arguments:
        return
    robot, name = case.robot, case.quantity.name
    slides = (
        bool(geometry(robot, case.arguments["q"][:1]).slide.any())
        if "q" in case.arguments
        else False
    )
    n = robot.n
    if name == "fk" and robot.table is not None:
        table = robot.table
        yield lambda ways, x: products(table, x["q"], ways), matrix_steps(table)
    if name in _RECURSIVE:
        yield _newton_euler(case), steps(n, slides, name)
    if name in _LAGRANGE and not (pairs and n > _SMALL):
        yield _by_links(case), column_steps(n, slides, True)
    if name in _FRAMES:
        frame = _FRAMES[name]
        yield lambda ways, x: _jacobian(robot, ways, x, frame, name), column_steps(n, slides, False)


_RECURSIVE = ("inverse_dynamics", "gravity_torques", "coriolis_torques", "mass_matrix")
_LAGRANGE = ("inverse_dynamics", "gravity_torques", "coriolis_torques", "coriolis_matrix",
             "mass_matrix", "kinetic_energy", "forward_dynamics")  # fmt: skip
_FRAMES = {"jacobian": "base", "jacobian_tool": "tool", "jacobian_spatial": "spatial",
           "planar_jacobian": "base", "statics": "base", "statics_tool": "tool"}  # fmt: skip


def _newton_euler(case: Case) -> Road:
    robot, name = case.robot, case.quantity.name

    def road(ways: Ways, x: dict[str, Array]) -> Array:
        q = x["q"]
        g, zero = geometry(robot, q), np.zeros_like(q)
        if name == "mass_matrix":
            columns = [torques(g, ways, zero, zero + unit, 0.0) for unit in np.eye(robot.n)]
            return np.stack(columns, axis=-1)
        weight = 0.0 if name == "coriolis_torques" else 1.0
        return torques(g, ways, x.get("v", zero), x.get("a", zero), weight)

    return road


def _by_links(case: Case) -> Road:
    robot, name = case.robot, case.quantity.name

    def road(ways: Ways, x: dict[str, Array]) -> Array:
        q = x["q"]
        v = x.get("v", np.zeros_like(q))
        mass, matrix, coriolis, weight = lagrange(robot, ways, q, v, name not in _SLOPELESS)
        if name == "mass_matrix":
            return mass
        if name == "gravity_torques":
            return weight
        if name == "coriolis_matrix":
            return matrix
        if name == "coriolis_torques":
            return coriolis
        if name == "kinetic_energy":
            energy: Array = 0.5 * np.einsum("ni,bnij,nj->bn", v, mass, v)
            return energy
        if name == "forward_dynamics":
            with np.errstate(all="ignore"):
                rest = x["tau"] - coriolis - weight
                return np.asarray(np.linalg.pinv(mass) @ rest[..., None])[..., 0]
        torque: Array = np.einsum("bnij,nj->bni", mass, x["a"]) + coriolis + weight
        return torque

    return road


_SLOPELESS = ("mass_matrix", "gravity_torques", "kinetic_energy")


def _jacobian(robot: Any, ways: Ways, x: dict[str, Array], frame: str, name: str) -> Array:
    jac = jacobians(robot, x["q"], ways, frame)
    if name == "planar_jacobian":
        return jac[:, :, [0, 1, 5]]
    if name.startswith("statics"):
        torque: Array = np.einsum("bnij,ni->bnj", jac, x["wrench"])
        return torque
    return jac


# -------- Christoffel's three terms, by least squares

_WHOLE: tuple[float, ...] = (0.5, 0.5, -0.5)
_NAMED: tuple[str, ...] = ("dM_ij/dq_k", "dM_ik/dq_j", "-dM_jk/dq_i")


def christoffel_terms(case: Case) -> tuple[str, float, int] | None:
    """Which of Christoffel's terms ½ (dM_ij/dq_k + dM_ik/dq_j - dM_jk/dq_i) are otherwise.

    Returns:
        What the formula does, the relative error that is left, and how many terms; or None.
    """
    name = case.quantity.name
    if name not in ("coriolis_matrix", "coriolis_torques", "inverse_dynamics") or case.index:
        return None
    engine = np.asarray(case.answer(()))
    if case.hand.shape != engine.shape:
        return None
    v = case.arguments["v"]
    slope = mass_slope(case.robot, case.arguments["q"])
    if name == "coriolis_matrix":
        parts = [np.einsum(f"{x},nk->nij", slope, v) for x in ("nijk", "nikj", "njki")]
        base, whole, said = np.zeros_like(engine), _WHOLE, _NAMED
    else:
        parts = [np.einsum("nijk,nj,nk->ni", slope, v, v), np.einsum("njki,nj,nk->ni", slope, v, v)]
        base = engine - parts[0] + 0.5 * parts[1]
        whole, said = (1.0, -0.5), ("dM_ij/dq_k", "-½ dM_jk/dq_i")
    columns = np.array([part.ravel() for part in parts]).T
    if np.linalg.matrix_rank(columns) < len(parts):
        return None
    found, *_rest = np.linalg.lstsq(columns, (case.hand - base).ravel(), rcond=None)
    gap = np.abs((columns @ found).reshape(engine.shape) + base - case.hand)
    error = float(np.max(np.max(gap.reshape(len(gap), -1), axis=1) / error_sizes(engine)))
    share = found / np.array(whole)
    if error > TOLERANCES.formula_agrees or np.max(np.abs(2 * share - np.rint(2 * share))) > 1e-7:
        return None
    share = np.rint(2 * share) / 2
    if np.all(share == share[0]):
        return None  # a factor of all the velocity terms: the readings say so
    wrong = [_other(word, float(k)) for word, k in zip(said, share, strict=True) if k != 1]
    told = _(
        "in Christoffel's C_ij = Σ ½ (dM_ij/dq_k + dM_ik/dq_j - dM_jk/dq_i) qd_k it {does}"
    ).format(does=_(" and ").join(wrong))
    return told, error, len(wrong)


def _other(word: str, share: float) -> str:
    if share == 0:
        return _("leaves {term} out").format(term=word.lstrip("-"))
    if share == -1:
        return _("has {term} with the opposite sign").format(term=word.lstrip("-"))
    return _("has {term} {times:g} times").format(term=word.lstrip("-"), times=share)
