"""The Jacobian column by column and the mass matrix link by link, with what people do otherwise.

A column is (z x (p - o), z) for a hinge and (z, 0) for a slide (Siciliano 3.30, Spong 4.57, Craig
5.9); M = sum m Jv^T Jv + Jw^T R I R^T Jw, Jv at each centre of mass (Spong 7.50, note 002, 002.M);
C by Christoffel from that M. As in :mod:`kinlab.doctor.confusions.recursion`, every alternative is
a change of weights, and all are worked out at once.
"""

from __future__ import annotations

from typing import Any

import numpy as np

from kinlab.arrays import Array
from kinlab.doctor.confusions.recursion import (
    Geometry,
    Step,
    Weights,
    centre_of,
    geometry,
    mixed,
)
from kinlab.engine.kinematics import fk
from kinlab.host.language import N_, _
from kinlab.model.link import steiner
from kinlab.model.robot import Robot

_COLUMN: tuple[tuple[str, str, dict[str, float], float], ...] = (
    ("joint axis", N_("takes the axis z of the next joint for the joint's own (z_i for z_(i-1))"),
     {"z own": 0.0, "z next": 1.0}, 1.1),
    ("joint axis", N_("takes the axis z of the joint before for the joint's own (z_(i-1) for z_i)"),
     {"z own": 0.0, "z back": 1.0}, 1.1),
    ("joint axis", N_("takes the base's z for the joint axis"), {"z own": 0.0, "z base": 1.0}, 1.2),
    ("point", N_("takes the origin o of the next frame for the joint's own point (o_i for "
                 "o_(i-1))"),
     {"o own": 0.0, "o next": 1.0}, 1.1),
    ("point", N_("takes the origin o of the frame before for the joint's own point"),
     {"o own": 0.0, "o back": 1.0}, 1.15),
    ("point", N_("leaves the joint's origin o out: z x p for z x (p - o)"), {"o own": 0.0}, 1.1),
    ("cross product order", N_("has the cross product's order exchanged: (p - o) x z for z x (p "
                               "- o), "
     "the opposite sign"), {"linear": -1.0}, 1.15),
    ("slide as hinge", N_("treats a slide (prismatic joint) as a hinge (revolute)"),
     {"slide": 0.0, "slide turns": 1.0}, 1.1),
    ("slide turns", N_("gives a slide (prismatic joint) an angular part z"), {"slide z": 1.0}, 1.1),
    ("slide left out", N_("leaves the column of a slide (prismatic joint) "
                          "out"), {"slide": 0.0}, 1.2),
    ("hinge as slide", N_("treats a hinge as a slide: z for z x (p - o)"),
     {"linear": 0.0, "linear z": 1.0, "angular": 0.0}, 1.2),
    ("angular rows", N_("leaves the angular part out"), {"angular": 0.0}, 1.2),
    ("linear rows", N_("leaves the linear part out"), {"linear": 0.0, "slide": 0.0}, 1.2),
)  # fmt: skip
"""Kind, words, weights, cost of what may be otherwise in a column."""

_TIP: tuple[tuple[str, str, dict[str, float], float], ...] = (
    ("point", N_("refers to the origin of the last DH frame, not the tool"), {"p own": 0.0,
     "p last": 1.0}, 1.1),
    ("point", N_("refers to the last joint's origin, not the tool"), {"p own": 0.0,
     "p joint": 1.0}, 1.15),
    ("angular rows", N_("takes the axis z of the next joint in the angular rows"),
     {"za next": 1.0}, 1.15),
    ("angular rows", N_("takes the axis z of the joint before in the angular rows"),
     {"za back": 1.0}, 1.15),
)  # fmt: skip

_LINK: tuple[tuple[str, str, dict[str, float], float], ...] = (
    ("centre", N_("takes the link's frame origin for its centre of mass"), {"c own": 0.0,
     "c frame": 1.0}, 1.15),
    ("centre", N_("takes the joint's origin for the centre of mass"), {"c own": 0.0}, 1.15),
    ("centre not rotated", N_("takes the centre of mass in link axes as if in base axes (com not "
     "rotated)"), {"c own": 0.0, "c plain": 1.0}, 1.1),
    ("centre transposed", N_("rotates the centre of mass with R transposed"), {"c own": 0.0,
     "c back": 1.0}, 1.15),
    ("centre", N_("measures the centre of mass to the other side of the link's "
                  "frame"), {"c own": 0.0,
     "c mirrored": 1.0}, 1.15),
    ("tensor not rotated", N_("takes the inertia tensor in link axes as if in base axes (tensor "
                              "not "
     "rotated: I for R I R^T)"), {"I own": 0.0, "I plain": 1.0}, 1.05),
    ("tensor transposed", N_("rotates the inertia tensor the wrong way (R^T I R for R I R^T)"),
     {"I own": 0.0, "I back": 1.0}, 1.05),
    ("tensor of another link", N_("takes the inertia tensor of the next link"), {"I own": 0.0,
     "I next": 1.0}, 1.25),
    ("tensor of another link", N_("takes the inertia tensor of the link before"), {"I own": 0.0,
     "I before": 1.0}, 1.25),
    ("inertia point", N_("counts m c² twice: the inertia tensor about the joint where that about "
                         "the "
     "centre of mass belongs"), {"I steiner": 1.0}, 1.15),
    ("inertia left out", N_("leaves the inertia tensor's part Jw^T I Jw "
                            "out"), {"turning": 0.0}, 1.1),
    ("mass part", N_("leaves the part m Jv^T Jv out"), {"moving": 0.0}, 1.15),
    ("mass of another link", N_("takes the mass of the next link"), {"m own": 0.0,
     "m next": 1.0}, 1.25),
    ("mass of another link", N_("takes the mass of the link before"), {"m own": 0.0,
     "m back": 1.0}, 1.25),
    ("own joint", N_("leaves the link's own joint out of its Jacobian (j < i for j <= i)"),
     {"own joint": 0.0}, 1.15),
    ("rotor inertia", N_("leaves the rotor inertia out"), {"rotor": 0.0}, 1.1),
    ("gravity left out", N_("leaves gravity out"), {"gravity": 0.0}, 1.05),
    ("gravity sign", N_("has gravity with the opposite sign"), {"gravity": -1.0}, 1.05),
)  # fmt: skip

_PLAIN = {
    "z own", "o own", "linear", "angular", "slide", "p own", "c own", "I own", "m own",
    "turning", "moving", "own joint", "rotor", "gravity",
}  # fmt: skip


def column_steps(n: int, slides: bool, of_links: bool) -> list[Step]:
    """Every alternative of the columns, for all joints and each; of a mass matrix too."""
    found = []
    at_joint = _("{does}, at joint {joint}")
    for kind, words, weights, cost in (*_COLUMN, *(_LINK if of_links else _TIP)):
        if not slides and ("slide" in kind and kind != "hinge as slide"):
            continue
        does = _(words)
        found.append(Step(kind, does, weights, cost))
        if n > 1 and not any(name.startswith(("p ", "gravity")) for name in weights):
            found += [
                Step(kind, at_joint.format(does=does, joint=i + 1), weights, cost + 0.15, i)
                for i in range(n)
            ]
    return found


def _near(g: Geometry, i: int) -> tuple[Array, Array, Array]:
    """The axes of the next joint and of the one before, and the base's z."""
    base = np.broadcast_to(np.array([0.0, 0.0, 1.0]), g.last_axis.shape)
    after = g.z[:, i + 1] if i + 1 < g.n else g.last_axis
    return after, g.z[:, i - 1] if i else base, base


def _axes(at: Any, g: Geometry, i: int) -> Any:
    return mixed(at, ("z own", "z next", "z back", "z base"), (g.z[:, i], *_near(g, i)))


def _other_axes(at: Any, g: Geometry, i: int) -> Any:
    """What other axes in the angular rows alone add to them."""
    after, before, _base = _near(g, i)
    return at("za next") * (after - g.z[:, i]) + at("za back") * (before - g.z[:, i])


def _origin(at: Any, g: Geometry, i: int) -> Any:
    after = g.o[:, i + 1] if i + 1 < g.n else g.end
    before = g.o[:, i - 1] if i else np.zeros_like(g.end)
    return mixed(at, ("o own", "o next", "o back"), (g.o[:, i], after, before))


def _column(at: Any, g: Geometry, i: int, p: Any) -> tuple[Any, Any]:
    """Linear and angular part of one column for the point p."""
    z = _axes(at, g, i)
    lever = np.cross(z, p - _origin(at, g, i))
    if g.slide[i]:
        linear = at("slide") * z + at("slide turns") * lever
        return linear, (at("slide turns") + at("slide z")) * z
    return at("linear") * lever + at("linear z") * z, at("angular") * z


def jacobians(robot: Robot, q: Array, ways: list[tuple[Step, ...]], frame: str) -> Array:
    """The Jacobian of every alternative, (B, N, 6, n), in base axes, tool axes or spatial."""
    g, weights = geometry(robot, q), Weights(ways, _PLAIN)
    pose = fk(robot, q)
    out = np.empty((len(ways), len(q), 6, g.n))
    for i in range(g.n):
        at = weights.here(i)
        p = mixed(at, ("p own", "p last", "p joint"), (pose[:, :3, 3], g.end, g.o[:, -1]))
        linear, angular = _column(at, g, i, p)
        if not g.slide[i]:
            angular = angular + at("angular") * _other_axes(at, g, i)
        out[..., :3, i], out[..., 3:, i] = linear, angular
    if frame == "tool":
        turn = pose[:, :3, :3]
        out[..., :3, :] = np.einsum("nki,bnkj->bnij", turn, out[..., :3, :])
        out[..., 3:, :] = np.einsum("nki,bnkj->bnij", turn, out[..., 3:, :])
    if frame == "spatial":
        turning = np.swapaxes(out[..., 3:, :], -1, -2)
        out[..., :3, :] += np.swapaxes(np.cross(pose[:, None, :3, 3], turning), -1, -2)
    return out


def masses(robot: Robot, q: Array, ways: list[tuple[Step, ...]]) -> tuple[Array, Array]:
    """M, (B, N, n, n), and the gravity torques, (B, N, n), of every alternative."""
    g, weights = geometry(robot, q), Weights(ways, _PLAIN)
    n, count = g.n, len(q)
    mass = np.zeros((len(ways), count, n, n))
    weight = np.zeros((len(ways), count, n))
    for k in range(n):
        at = weights.here(k)
        turn = g.turn[:, k]
        c = centre_of(at, g, k)
        point = g.o[:, k] + c
        linear = np.zeros((len(ways), count, 3, k + 1))
        angular = np.zeros_like(linear)
        for j in range(k + 1):
            one, two = _column(weights.here(j), g, j, point)
            own = at("own joint") if j == k else 1.0
            linear[..., j], angular[..., j] = own * one, own * two
        m = (at("m own") * g.mass[k] + at("m next") * g.mass[min(k + 1, n - 1)]
             + at("m back") * g.mass[max(k - 1, 0)])  # fmt: skip
        moving = np.einsum("bnki,bnkj->bnij", linear, linear)
        mass[..., : k + 1, : k + 1] += _deep(m * at("moving")) * moving
        for term, tensor in _tensors(g, k, turn).items():
            share = at(term)
            if isinstance(share, np.ndarray) or share:
                spun = np.einsum("bnki,nkl,bnlj->bnij", angular, tensor, angular)
                mass[..., : k + 1, : k + 1] += _deep(share * at("turning")) * spun
        pull = np.einsum("bnki,k->bni", linear, g.gravity)
        weight[..., : k + 1] -= m * at("gravity") * pull
    for k in range(n):
        share = weights.at("rotor", k)
        flat = share[..., 0] if isinstance(share, np.ndarray) else share
        mass[..., k, k] += flat * g.rotor[k]
    return mass, weight


def _deep(weight: Any) -> Any:
    return weight[..., None] if isinstance(weight, np.ndarray) else weight


def _tensors(g: Geometry, k: int, turn: Array) -> dict[str, Array]:
    def rotated(tensor: Array) -> Array:
        out: Array = np.einsum("nij,jk,nlk->nil", turn, tensor, turn)
        return out

    n = g.n
    return {
        "I own": rotated(g.body[k]),
        "I plain": np.broadcast_to(g.body[k], turn.shape),
        "I back": np.einsum("nji,jk,nkl->nil", turn, g.body[k], turn),
        "I next": rotated(g.body[min(k + 1, n - 1)]),
        "I before": rotated(g.body[max(k - 1, 0)]),
        "I steiner": rotated(steiner(g.mass[k], g.lever[k])),
    }


def lagrange(
    robot: Robot, ways: list[tuple[Step, ...]], q: Array, v: Array, sloping: bool
) -> tuple[Array, Array, Array, Array]:
    """M, C (by Christoffel from that M), C v and g of every alternative.

    The slopes of M are differences of fourth order: 1e-12 of M. Without ``sloping`` C and C v are
    not worked out, and what stands for them means nothing.
    """
    n, step = robot.n, 1e-3
    mass, weight = masses(robot, q, ways)
    if not sloping:
        return mass, mass, weight, weight
    slopes = []
    for k in range(n):
        unit = step * np.eye(n)[k]
        near = masses(robot, q + unit, ways)[0] - masses(robot, q - unit, ways)[0]
        far = masses(robot, q + 2 * unit, ways)[0] - masses(robot, q - 2 * unit, ways)[0]
        slopes.append((8 * near - far) / (12 * step))
    slope = np.stack(slopes, axis=-1)  # dM_ij/dq_k at [..., i, j, k]
    c = 0.5 * (slope + np.swapaxes(slope, -1, -2) - np.moveaxis(slope, -1, -3))
    matrix = np.einsum("bnijk,nk->bnij", c, v)
    return mass, matrix, np.einsum("bnij,nj->bni", matrix, v), weight
