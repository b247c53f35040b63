"""Newton-Euler as the textbooks have it, written once, with what people do otherwise at each step.

Outward w, its rate and the acceleration; the force and moment of each link; inward f and n (Craig
6.45 to 6.53, Siciliano 7.107 to 7.114; note 000, 000.ne). All vectors are in base axes. Every term
has a weight, and every alternative (left out, another sign, another frame, another link) is a
change of weights at one joint or at all. All alternatives are worked out at once: the leading
axis of every array is the alternatives.
"""

from __future__ import annotations

from collections.abc import Callable, Collection, Mapping
from dataclasses import dataclass
from typing import Any

import numpy as np
import pinocchio as pin

from kinlab.arrays import Array
from kinlab.host.language import N_, _
from kinlab.model.dh import DHTable
from kinlab.model.link import Convention, steiner
from kinlab.model.robot import Robot, scratch

_STANDARD = {
    "z x qd": 1.0, "wd x P": 1.0, "w x w x P": 1.0, "2w x d": 1.0, "qdd z": 1.0, "a0": 1.0,
    "wd x c": 1.0, "w x w x c": 1.0, "I wd": 1.0, "w x Iw": 1.0, "f next": 1.0, "n next": 1.0,
    "c x F": 1.0, "P x f": 1.0, "rotor": 1.0, "slide qdd": 1.0,
}  # fmt: skip
"""The terms of the recursion and their weights; all others are alternatives of weight zero."""


@dataclass(frozen=True)
class Step:
    """One thing done otherwise in the recursion.

    Attributes:
        kind: its name. sentence: what the formula does, to follow "the formula ".
        weights: the terms whose weights are others.
        cost: how far-fetched it is.
        joint: where, from 0; None for all.
    """

    kind: str
    sentence: str
    weights: Mapping[str, float]
    cost: float = 1.1
    joint: int | None = None


@dataclass(frozen=True, eq=False)
class Geometry:
    """An arm at several states, in base axes.

    Attributes:
        z: joint axes, (N, n, 3). o: joint origins, (N, n, 3), and of the last link's end (N, 3).
        turn: link frames, (N, n, 3, 3). c: centres from the joint, in base axes, (N, n, 3).
        body: tensors about the centres in link axes, (n, 3, 3). lever: centres from the link's
            frame, in link axes.
        mass, rotor: (n,). slide: (n,) bool. gravity: (3,).
        last_axis: z of the last frame, (N, 3).
        offset: from each joint's origin to its link's frame, (N, n, 3): not zero in the standard
            convention, where centres are measured from there.
        standard: whether it is the standard convention, whose recursion goes from end to end.
    """

    z: Array
    o: Array
    end: Array
    turn: Array
    c: Array
    body: Array
    lever: Array
    mass: Array
    rotor: Array
    slide: Any
    gravity: Array
    last_axis: Array
    offset: Array
    standard: bool

    @property
    def n(self) -> int:
        """Number of joints."""
        return len(self.mass)


def geometry(robot: Robot, q: Array) -> Geometry:
    """The arm's axes, origins and bodies at the states, (N, n).

    Link axes are the DH frames' where there is a table, as the textbooks have them.
    """
    model, data, count = robot.model, scratch(robot), len(q)
    n = robot.n
    turns, places = np.empty((count, n, 3, 3)), np.empty((count, n, 3))
    for row, position in enumerate(q):
        pin.forwardKinematics(model, data, position)
        for i in range(n):
            turns[row, i], places[row, i] = data.oMi[i + 1].rotation, data.oMi[i + 1].translation
    joints = turns.copy()
    lever = np.array([model.inertias[i + 1].lever for i in range(n)])
    body = np.array([model.inertias[i + 1].inertia for i in range(n)])
    axes = np.array([_axis(model.joints[i + 1]) for i in range(n)])
    c = np.einsum("nijk,ik->nij", joints, lever)
    z = np.einsum("nijk,ik->nij", joints, axes)
    slide = np.array(["P" in model.joints[i + 1].shortname()[9:] for i in range(n)])
    end, last_axis = places[:, -1], turns[:, -1, :, 2]
    offset = np.zeros_like(places)
    if robot.table is not None:
        frames = robot.table.frames(q)
        dh = frames[..., :3, :3]
        if dh.shape == turns.shape:
            between = np.einsum("nikj,nikl->nijl", dh, joints)[
                0
            ]  # constant: joint axes in link axes
            body = np.einsum("ijk,ikl,iml->ijm", between, body, between)
            turns = dh
            places, moved = _textbook_origins(robot.table, frames, places), places
            c = c + moved - places
            offset = frames[..., :3, 3] - places
            lever = np.einsum("nji,nj->ni", turns[0], c[0] - offset[0])
            last_axis, end = frames[:, -1, :3, 2], frames[:, -1, :3, 3]
    mass = np.array([model.inertias[i + 1].mass for i in range(n)])
    standard = robot.table is not None and robot.table.convention is Convention.STANDARD
    return Geometry(z, places, end, turns, c, body, lever, mass, np.array(model.armature), slide,
                    np.array(model.gravity.linear), last_axis, offset, standard)  # fmt: skip


def _textbook_origins(table: DHTable, frames: Array, places: Array) -> Array:
    """The joints' origins as the table has them: o_(i-1) in the standard convention, o_i else."""
    if table.convention is not Convention.STANDARD:
        return np.array(frames[..., :3, 3])
    first = np.broadcast_to(np.asarray(table.base)[:3, 3], places[:, :1].shape)
    return np.concatenate([first, frames[:, :-1, :3, 3]], axis=1)


def _axis(joint: Any) -> Array:
    """A joint's axis in its own frame."""
    column: Array = np.asarray(joint.createData().S).reshape(6, -1)[:, 0]
    return column[3:] if np.any(column[3:]) else column[:3]


def steps(n: int, slides: bool, quantity: str) -> list[Step]:
    """Every alternative of the recursion, at all joints and at each."""
    found: list[Step] = []
    for kind, words, term, moving in _TERMS:
        if (
            not moving
            or quantity == "inverse_dynamics"
            or (quantity == "coriolis_torques" and moving == "v")
            or (quantity == "mass_matrix" and moving == "a")
        ):
            what = _(words)
            for said, weight, cost in _OTHERWISE:
                found.append(Step(kind, _(said).format(what=what), {term: weight}, cost))
    for kind, words, weights, cost in _INSTEAD:
        found.append(Step(kind, _(words), weights, cost))
    at_joint = _("{does} at joint {joint}")
    single = [
        Step(
            s.kind,
            at_joint.format(does=s.sentence, joint=i + 1),
            s.weights,
            s.cost + 0.15,
            i,
        )
        for s in found
        for i in range(n)
        if s.kind != "inertia point" and not _COUNTED & set(s.weights.values())
    ]
    kept = [*found, *single] if n > 1 else found
    return [s for s in kept if slides or s.kind != "Coriolis of a slide"]


_OTHERWISE = (
    (N_("leaves {what} out"), 0.0, 1.1),
    (N_("has {what} with the opposite sign"), -1.0, 1.15),
    (N_("counts {what} twice"), 2.0, 1.3),
    (N_("counts {what} half"), 0.5, 1.3),
)
"""What is said of a term of another weight, and how far-fetched it is."""

_COUNTED = {2.0, 0.5}
"""Weights that are not looked for at single joints."""

_TERMS = (
    ("omega_dot cross term", N_("w x z qd (the term of the angular acceleration omega_dot)"),
     "z x qd", "v"),
    ("tangential term", N_("omega_dot x P (the joint origin's tangential "
                           "acceleration)"), "wd x P", ""),
    ("centripetal term", N_("w x (w x P) (the joint origin's centripetal acceleration)"),
     "w x w x P", "v"),
    ("Coriolis of a slide", N_("2 w x z d_dot (the Coriolis acceleration of a slide)"),
     "2w x d", "v"),
    ("tangential term of the centre", N_("omega_dot x c (the centre's tangential acceleration)"),
     "wd x c", ""),
    ("centripetal term of the centre",
     N_("w x (w x c) (the centre of mass's centripetal acceleration)"), "w x w x c", "v"),
    ("Euler moment", N_("I omega_dot (the inertia tensor's moment)"), "I wd", ""),
    ("gyroscopic term", N_("w x I w (the gyroscopic term)"), "w x Iw", "v"),
    ("force of the next link", N_("the force f of the next link"), "f next", ""),
    ("moment of the next link", N_("the moment n of the next link"), "n next", ""),
    ("moment of F", N_("P_C x F (the moment of F at the centre of mass)"), "c x F", ""),
    ("moment of f", N_("P x f (the lever arm of the next link's force)"), "P x f", ""),
    ("rotor inertia", N_("the rotor inertia"), "rotor", "a"),
)  # fmt: skip
"""Kind, words, weight, and which motion it needs."""

_INSTEAD: tuple[tuple[str, str, dict[str, float], float], ...] = (
    ("centre not rotated", N_("takes the centre of mass in link axes as if in base axes (com not "
     "rotated)"), {"c own": 0.0, "c plain": 1.0}, 1.1),
    ("centre transposed", N_("rotates the centre of mass with R transposed"), {"c own": 0.0,
     "c back": 1.0}, 1.15),
    ("tensor not rotated", N_("takes the inertia tensor in link axes as if in base axes (tensor "
                              "not "
     "rotated: I for R I R^T)"), {"I own": 0.0, "I plain": 1.0}, 1.1),
    ("tensor transposed", N_("rotates the inertia tensor the wrong way (R^T I R for R I R^T)"),
     {"I own": 0.0, "I back": 1.0}, 1.1),
    ("inertia point", N_("counts m c² twice: the inertia tensor about the joint where that about "
                         "the "
     "centre of mass belongs"), {"I steiner": 1.0}, 1.15),
    ("force of the wrong link", N_("has P x F, the link's own force, for P x f of the next link"),
     {"P x f": 0.0, "P x F": 1.0}, 1.15),
    ("force of the wrong link", N_("has P x f with the force f of the same link, not of the next"),
     {"P x f": 0.0, "P x f own": 1.0}, 1.15),
    ("lever arm", N_("takes the link's own P_i for the lever arm P of the next link's force"),
     {"P x f": 0.0, "Pi x f": 1.0}, 1.2),
    ("lever arm", N_("has P_C x f for P_C x F: the lever arm of the centre of mass with the whole "
     "force f"), {"c x F": 0.0, "c x f": 1.0}, 1.2),
    ("acceleration of the centre", N_("takes the acceleration of the joint's origin for that of "
                                      "the "
     "centre of mass"), {"wd x c": 0.0, "w x w x c": 0.0}, 1.15),
    ("index of w", N_("takes w_(i-1) for w_i in the centre of mass's centripetal acceleration"),
     {"w x w x c": 0.0, "w- x w- x c": 1.0}, 1.25),
    ("index of w", N_("takes w_i for w_(i-1) in w x (w x P)"), {"w x w x P": 0.0,
     "w+ x w+ x P": 1.0}, 1.25),
    ("index of w", N_("takes omega_dot_i for omega_dot_(i-1) in omega_dot x P"), {"wd x P": 0.0,
     "wd+ x P": 1.0}, 1.25),
    ("mass of another link", N_("takes the mass of the next "
                                "link"), {"m own": 0.0, "m next": 1.0}, 1.3),
    ("mass of another link", N_("takes the mass of the link before"), {"m own": 0.0,
     "m back": 1.0}, 1.3),
    ("tensor of another link", N_("takes the inertia tensor of the next link"), {"I own": 0.0,
     "I next": 1.0}, 1.3),
    ("tensor of another link", N_("takes the inertia tensor of the link before"), {"I own": 0.0,
     "I before": 1.0}, 1.3),
    ("joint axis", N_("takes the axis z of the next joint"), {"z own": 0.0, "z next": 1.0}, 1.25),
    ("joint axis", N_("takes the axis z of the joint before"), {"z own": 0.0, "z back": 1.0}, 1.25),
    ("torque axis", N_("projects the moment n on the axis z of the next joint"), {"tau z": 0.0,
     "tau z next": 1.0}, 1.2),
    ("torque axis", N_("projects the moment n on the axis z of the joint before"), {"tau z": 0.0,
     "tau z back": 1.0}, 1.2),
    ("slide as hinge", N_("treats a slide (prismatic joint) as a hinge: n z for f "
                          "z"), {"tau f": 0.0,
     "tau n": 1.0}, 1.15),
    ("force not rotated", N_("does not rotate the force f of the next link into the link's frame "
     "(R left out)"), {"f turned": 0.0, "f plain": 1.0}, 1.15),
    ("force transposed", N_("rotates the force f of the next link with R transposed"),
     {"f turned": 0.0, "f back": 1.0}, 1.15),
    ("moment not rotated", N_("does not rotate the moment n of the next link (R left out)"),
     {"n turned": 0.0, "n plain": 1.0}, 1.15),
    ("moment transposed", N_("rotates the moment n of the next link with R transposed"),
     {"n turned": 0.0, "n back": 1.0}, 1.15),
    ("force not rotated", N_("does not rotate the next link's force f in P x f (R left out)"),
     {"P x f": 0.0, "P x f plain": 1.0}, 1.1),
    ("lever arm", N_("takes the centre of mass from the link's frame, not from the joint, for the "
     "lever arm of F (P x F is left out)"), {"c x F": 0.0, "com x F": 1.0}, 1.15),
    ("acceleration of a slide", N_("leaves the acceleration qdd z (d_ddot) of a slide out"),
     {"slide qdd": 0.0}, 1.1),
    ("acceleration of a hinge", N_("leaves z qdd out of the angular acceleration"), {"qdd z": 0.0},
     1.15),
    ("moment of the link", N_("leaves the link's own moment N (I omega_dot + w x I w) out"),
     {"I wd": 0.0, "w x Iw": 0.0}, 1.05),
    ("tensor transposed", N_("rotates the inertia tensor the wrong way in I omega_dot (R^T I R "
                             "for I)"),
     {"I wd": 0.0, "RtIR wd": 1.0}, 1.1),
    ("tensor transposed", N_("rotates the inertia tensor the wrong way (R^T I R for I)"),
     {"I wd": 0.0, "RtIR wd": 1.0, "w x Iw": 0.0, "w x RtIRw": 1.0}, 1.1),
    ("tensor rotated", N_("rotates the inertia tensor, which is in link axes already (R I R^T "
                          "for I)"),
     {"I wd": 0.0, "RIRt wd": 1.0, "w x Iw": 0.0, "w x RIRtw": 1.0}, 1.1),
    ("tensor rotated", N_("rotates the inertia tensor in I omega_dot, which is in link axes "
                          "already "
     "(R I R^T for I)"), {"I wd": 0.0, "RIRt wd": 1.0}, 1.1),
    ("w not rotated", N_("does not rotate w of the link before (R left out)"), {"w turned": 0.0,
     "w plain": 1.0}, 1.15),
    ("w transposed", N_("rotates w of the link before with R transposed"), {"w turned": 0.0,
     "w back": 1.0}, 1.15),
    ("acceleration not rotated", N_("does not rotate the acceleration of the link before"),
     {"a turned": 0.0, "a plain": 1.0}, 1.15),
    ("acceleration transposed", N_("rotates the acceleration of the link before with R transposed"),
     {"a turned": 0.0, "a back": 1.0}, 1.15),
    ("gravity left out", N_("leaves gravity out (v_dot_0 = -g)"), {"gravity": 0.0}, 1.0),
    ("gravity sign", N_("has gravity with the opposite sign (v_dot_0 = g for -g)"),
     {"gravity": -1.0}, 1.0),
)  # fmt: skip
"""Kind, words, weights and cost of what stands in place of something."""

_OWN = ("c own", "I own", "m own", "z own", "tau z", "tau f", "f turned", "n turned", "w turned",
        "a turned", "gravity")  # fmt: skip


class Weights:
    """The weights of all alternatives, (B, 1, 1) each or one number.

    Args:
        ways: the alternatives, each a combination of steps.
        plain: the terms whose weight is 1 where nothing is said; all others have 0.
    """

    def __init__(self, ways: list[tuple[Step, ...]], plain: Collection[str]) -> None:
        self.count = len(ways)
        self.plain = plain
        self.changed: dict[tuple[str, int | None], list[tuple[int, float]]] = {}
        for row, way in enumerate(ways):
            for step in way:
                for term, value in step.weights.items():
                    self.changed.setdefault((term, step.joint), []).append((row, value))

    def at(self, term: str, joint: int) -> Any:
        """The weight of a term at a joint."""
        plain = 1.0 if term in self.plain else 0.0
        rows = [*self.changed.get((term, None), ()), *self.changed.get((term, joint), ())]
        if not rows:
            return plain
        out = np.full((self.count, 1, 1), plain)
        for row, value in rows:
            out[row] = value
        return out

    def here(self, joint: int) -> Callable[[str], Any]:
        """The weights at one joint."""
        return lambda term: self.at(term, joint)


def torques(
    g: Geometry, ways: list[tuple[Step, ...]], qd: Array, qdd: Array, gravity: float = 1.0
) -> Array:
    """The joint torques of every alternative.

    Args:
        g: the arm at N states.
        ways: alternatives, each a combination of steps; ``()`` is the recursion as it should be.
        qd, qdd: (N, n).
        gravity: 0 leaves it out of the question.

    Returns:
        (B, N, n).
    """
    w_ = Weights(ways, (*_STANDARD, *_OWN))
    n = g.n
    zero = np.zeros((1, len(qd), 3))
    w: list[Any] = []
    wd: list[Any] = []
    acc: list[Any] = []
    forces: list[Any] = []
    moments: list[Any] = []
    centres: list[Any] = []
    origin = g.o
    speed, rate = zero, zero
    accel = -gravity * w_.at("gravity", 0) * g.gravity + zero
    axes = []
    for i in range(n):
        at = w_.here(i)
        z = mixed(at, ("z own", "z next", "z back"), (g.z[:, i], g.z[:, min(i + 1, n - 1)],
                                                        g.z[:, max(i - 1, 0)]))  # fmt: skip
        axes.append(z)
        before = g.turn[:, i - 1] if i else np.broadcast_to(np.eye(3), g.turn[:, 0].shape)
        arm = origin[:, i] - (origin[:, i - 1] if i else origin[:, i])
        old, old_rate = speed, rate
        speed = _turned(at, "w", old, before, g.turn[:, i])
        rate = _turned(at, "w", old_rate, before, g.turn[:, i])
        carried = old if not i else speed
        if not g.slide[i]:
            rate = rate + at("qdd z") * z * qdd[:, i, None]
            rate = rate + at("z x qd") * np.cross(carried, z) * qd[:, i, None]
            turned = speed + z * qd[:, i, None]
        else:
            turned = speed
        if not g.standard:
            accel = accel + at("wd x P") * np.cross(old_rate, arm)
            accel = accel + at("w x w x P") * np.cross(old, np.cross(old, arm))
            accel = accel + at("wd+ x P") * np.cross(rate, arm)
            accel = accel + at("w+ x w+ x P") * np.cross(turned, np.cross(turned, arm))
        accel = _turned(at, "a", accel, before, g.turn[:, i])
        if g.slide[i]:
            accel = accel + at("slide qdd") * z * qdd[:, i, None]
            accel = accel + at("2w x d") * 2.0 * np.cross(turned, z) * qd[:, i, None]
        speed = turned
        c = centre_of(at, g, i)
        lever = c
        if g.standard:
            out_there = g.offset[:, i]
            accel = accel + at("wd x P") * np.cross(rate, out_there)
            accel = accel + at("w x w x P") * np.cross(speed, np.cross(speed, out_there))
            accel = accel + at("wd+ x P") * np.cross(old_rate, out_there)
            accel = accel + at("w+ x w+ x P") * np.cross(old, np.cross(old, out_there))
            lever = c - out_there
        centre = accel + at("wd x c") * np.cross(rate, lever)
        centre = centre + at("w x w x c") * np.cross(speed, np.cross(speed, lever))
        centre = centre + at("w- x w- x c") * np.cross(old, np.cross(old, lever))
        mass = (at("m own") * g.mass[i] + at("m next") * g.mass[min(i + 1, n - 1)]
                + at("m back") * g.mass[max(i - 1, 0)])  # fmt: skip
        forces.append(mass * centre)
        moments.append(_moment(at, g, i, c, speed, rate))
        centres.append(c)
        w.append(speed)
        wd.append(rate)
        acc.append(accel)
    f, moment = zero, zero
    out: list[Any] = [None] * n
    for i in reversed(range(n)):
        at = w_.here(i)
        arm = (origin[:, i + 1] if i + 1 < n else g.end) - origin[:, i]
        own = origin[:, i] - (origin[:, i - 1] if i else origin[:, i])
        behind = g.turn[:, min(i + 1, n - 1)]
        f_old = f
        f_next = _turned(at, "f", f, behind, g.turn[:, i])
        n_next = _turned(at, "n", moment, behind, g.turn[:, i])
        f = forces[i] + at("f next") * f_next
        moment = moments[i] + at("n next") * n_next
        moment = moment + at("c x F") * np.cross(centres[i], forces[i])
        moment = moment + at("c x f") * np.cross(centres[i], f)
        moment = moment + at("com x F") * np.cross(centres[i] - g.offset[:, i], forces[i])
        moment = moment + at("P x f plain") * np.cross(arm, _as_if(f_old, behind, g.turn[:, i]))
        moment = moment + at("P x f") * np.cross(arm, f_next)
        moment = moment + at("P x F") * np.cross(arm, forces[i])
        moment = moment + at("P x f own") * np.cross(arm, f)
        moment = moment + at("Pi x f") * np.cross(own, f_next)
        axis = mixed(at, ("tau z", "tau z next", "tau z back"), (
            axes[i], axes[min(i + 1, n - 1)], axes[max(i - 1, 0)]))  # fmt: skip
        felt = moment
        if g.slide[i]:
            felt = at("tau f") * f + at("tau n") * moment
        tau = np.sum(felt * axis, axis=-1) + _flat(at("rotor")) * g.rotor[i] * qdd[:, i]
        out[i] = np.broadcast_to(tau, (len(ways), len(qd)))
    return np.stack(out, axis=-1)


def centre_of(at: Any, g: Geometry, i: int) -> Any:
    """The centre of mass from the joint's origin, turned into base axes, or not, or wrongly."""
    turn, lever = g.turn[:, i], g.lever[i]
    terms = ("c own", "c plain", "c back", "c frame", "c mirrored")
    offset = g.offset[:, i]
    turned = g.c[:, i] - offset
    return mixed(at, terms, (
        g.c[:, i], offset + lever, offset + np.einsum("nkj,k->nj", turn, lever), offset,
        offset - turned))  # fmt: skip


def _flat(weight: Any) -> Any:
    return weight[..., 0] if isinstance(weight, np.ndarray) else weight


def mixed(at: Any, terms: tuple[str, ...], parts: tuple[Array, ...]) -> Any:
    total: Any = 0.0
    for term, part in zip(terms, parts, strict=True):
        weight = at(term)
        if isinstance(weight, np.ndarray) or weight:
            total = total + weight * part
    return total


def _turned(at: Any, name: str, x: Any, there: Array, here: Array) -> Any:
    """A vector of another link's axes: turned, taken as it is, or turned the wrong way."""
    plain, back = at(f"{name} plain"), at(f"{name} back")
    out = at(f"{name} turned") * x
    if isinstance(plain, np.ndarray):
        out = out + plain * _as_if(x, there, here)
    if isinstance(back, np.ndarray):
        inside = np.einsum("nji,bnj->bni", there, x)
        between = np.einsum("nji,njk->nik", here, there)  # link there as seen from link here
        out = out + back * np.einsum("nij,nkj,bnk->bni", here, between, inside)
    return out


def _as_if(x: Any, there: Array, here: Array) -> Any:
    """A vector's components in another link's axes, taken for those in this link's."""
    return np.einsum("nij,nkj,bnk->bni", here, there, x)


def _moment(at: Any, g: Geometry, i: int, c: Any, w: Any, wd: Any) -> Any:
    turn = g.turn[:, i]

    def rotated(tensor: Array) -> Array:
        out: Array = np.einsum("nij,jk,nlk->nil", turn, tensor, turn)
        return out

    def times(tensor: Array, x: Any) -> Any:
        return np.einsum("nij,bnj->bni", tensor, x)

    total: Any = 0.0
    back = np.einsum("nji,jk,nkl->nil", turn, g.body[i], turn)
    n = g.n
    choices = {
        "I own": rotated(g.body[i]),
        "I plain": np.broadcast_to(g.body[i], turn.shape),
        "I back": back,
        "I next": rotated(g.body[min(i + 1, n - 1)]),
        "I before": rotated(g.body[max(i - 1, 0)]),
        "I steiner": rotated(steiner(g.mass[i], g.lever[i])),
    }
    for term, tensor in choices.items():
        weight = at(term)
        if isinstance(weight, np.ndarray) or weight:
            part = at("I wd") * times(tensor, wd)
            part = part + at("w x Iw") * np.cross(w, times(tensor, w))
            total = total + weight * part
    before = g.turn[:, i - 1] if i else np.broadcast_to(np.eye(3), turn.shape)
    step = np.einsum("nji,njk->nik", before, turn)
    for name, between in (("RtIR", np.swapaxes(step, 1, 2)), ("RIRt", step)):
        about = np.einsum("nij,njk->nik", turn, between)
        tensor = np.einsum("nij,jk,nlk->nil", about, g.body[i], about)
        euler, gyro = at(f"{name} wd"), at(f"w x {name}w")
        if isinstance(euler, np.ndarray):
            total = total + euler * times(tensor, wd)
        if isinstance(gyro, np.ndarray):
            total = total + gyro * np.cross(w, times(tensor, w))
    return total + 0.0 * np.asarray(c)  # of the right shape where there is no tensor
