"""Vectors and matrices of six: screws, twists, wrenches, adjoints, and spatial inertias.

Featherstone and Lynch & Park put the angular part first, Murray and Siciliano the linear one: both
are known. A body's frame is that of the table, or lies with the same axes in its centre of mass.
"""

from __future__ import annotations

from collections.abc import Callable, Iterator
from dataclasses import dataclass

import numpy as np

from kinlab.arrays import Array

Thing = tuple[int, str, Array, str]
"""Rank, what it is, its values for each link or joint, and the axes."""
_RANKS = {"V": 0, "dV": 0, "dV-g": 0, "wrench": 0, "net": 1}
"""What is no term of a sum."""
_SWAP = np.eye(6)[[3, 4, 5, 0, 1, 2]]


@dataclass(frozen=True)
class PlacedLinks:
    """An arm's links at one state.

    Attributes:
        frames: their frames in the base, (n, 4, 4).
        before: the frames before them, (n, 4, 4).
        home: their frames where all joints are at 0.
        tool: the tool's pose, (4, 4), and at home.
        axes: of the joints, base axes, (n, 3).
        points: on these.
        hinge: which joints turn.
        mass, centre, inertia: the centres as seen from the frames, base axes; about the centres.
    """

    frames: Array
    before: Array
    home: Array
    tool: tuple[Array, Array]
    axes: Array
    points: Array
    hinge: Array
    mass: Array
    centre: Array
    inertia: Array

    @property
    def centred(self) -> Array:
        """Frames with the same axes in the centres of mass."""
        out = self.frames.copy()
        out[:, :3, 3] += self.centre
        return out

    @property
    def screws(self) -> Array:
        """The joints' axes as twists in the base, (n, 6): angular part first."""
        turning = np.concatenate([self.axes, np.cross(self.points, self.axes)], axis=1)
        sliding = np.concatenate([np.zeros_like(self.axes), self.axes], axis=1)
        return np.where(self.hinge[:, None], turning, sliding)

    @property
    def tensors(self) -> Array:
        """The links' inertias about the base's origin, (n, 6, 6)."""
        at = self.frames[:, :3, 3] + self.centre
        arm, m = _skew(at), self.mass[:, None, None]
        out = np.zeros((len(arm), 6, 6))
        out[:, :3, :3] = self.inertia - m * arm @ arm
        out[:, :3, 3:], out[:, 3:, :3] = m * arm, -m * arm
        out[:, 3:, 3:] = m * np.eye(3)
        return out


def still(bodies: PlacedLinks) -> Iterator[Thing]:
    """Poses, screws, adjoints and inertias."""
    frames, home, screws = bodies.frames, bodies.home, bodies.screws
    up_to = frames @ _inverse(home)
    steps = np.concatenate([up_to[:1], _inverse(up_to[:-1]) @ up_to[1:]])
    yield 2, "exponential", steps, ""
    yield 2, "exponential", steps[:, :3, :3], ""
    yield 2, "exponentials", up_to, ""
    yield 2, "exponentials", up_to[:, :3, :3], ""
    yield 2, "home", home, ""
    yield 2, "home_inverse", _inverse(home), ""
    yield 2, "home_tool", bodies.tool[1][None], ""
    at_home = _moved(_inverse(up_to), screws)
    yield from _vectors(1, "screw", "base", screws)
    yield from _vectors(2, "home_screw", "base", at_home)
    for tool, screw in zip(bodies.tool, (screws, at_home), strict=True):
        yield from _vectors(2, "screw", "tool", _moved(_inverse(tool)[None], screw))
    for at in (frames, bodies.centred):
        yield from _vectors(1, "screw", "own", _moved(_inverse(at), screws))
    centred = bodies.centred
    between = _inverse(centred[:-1]) @ centred[1:]
    to_next = np.concatenate([_inverse(bodies.before[:1]) @ centred[:1], between])
    yield 2, "centred", centred, ""
    yield 2, "centred_step", to_next, ""
    yield 2, "centred_inverse", _inverse(to_next), ""
    for what, poses in (
        ("adjoint", _inverse(bodies.before) @ frames),
        ("adjoint", to_next),
        ("adjoint0", frames),
        ("adjoint0", centred),
        ("exponentials_adjoint", up_to),
        ("exponential_adjoint", steps),
    ):
        for form, pose in ((what, poses), (what + "_inverse", _inverse(poses))):
            yield from _matrices(1, form, "", adjoint(pose), True)
    tensors = bodies.tensors
    outward = np.cumsum(tensors[::-1], axis=0)[::-1]
    for rank, what, some in ((0, "spatial_inertia", tensors), (1, "composite_inertia", outward)):
        yield from _matrices(rank, what, "base", some, False)
        for at in (frames, centred):
            yield from _matrices(rank, what, "own", _about(at, some), False)
    mass = outward[:, 5, 5]
    if mass.all():
        first = outward[:, [2, 0, 1], [4, 5, 3]]  # of m S(c): -mz, -mx, -my
        whole = -first[:, [1, 2, 0]] / mass[:, None]
        turn = np.swapaxes(frames[:, :3, :3], 1, 2)
        yield 2, "composite_centre", whole, "base"
        yield 2, "composite_centre", _each(turn, whole - frames[:, :3, 3]), "own"
        arm = _skew(whole)
        about = outward[:, :3, :3] + mass[:, None, None] * arm @ arm
        yield 2, "composite_tensor", about, "base"
        yield 2, "composite_tensor", turn @ about @ np.swapaxes(turn, 1, 2), "own"


def moving(bodies: PlacedLinks, v: Array, a: Array | None, gravity: Array) -> Iterator[Thing]:
    """Twists, and with accelerations what is differentiated of them, and wrenches.

    Args:
        bodies: at a state.
        v: the joints' velocities, (n,).
        a: their accelerations.
        gravity: base axes, (3,).
    """
    screws, tensors = bodies.screws, bodies.tensors
    own = screws * v[:, None]
    twist = np.cumsum(own, axis=0)
    turned = np.stack([crossed(x) @ y for x, y in zip(twist, own, strict=True)])
    momentum = _each(tensors, twist)
    gyroscopic = np.stack([-crossed(x).T @ y for x, y in zip(twist, momentum, strict=True)])
    yield from _seen(bodies, {"S qd": own, "V": twist, "V x S qd": turned}, _moved)
    yield from _seen(bodies, {"I V": momentum, "V x I V": gyroscopic}, _pushed)
    if a is None:
        return
    rate = np.cumsum(screws * a[:, None] + turned, axis=0)
    lifted = rate - np.concatenate([np.zeros(3), gravity])
    yield from _seen(bodies, {"S qdd": screws * a[:, None], "dV": rate, "dV-g": lifted}, _moved)
    pushes = _each(tensors, rate), _each(tensors, lifted)
    net = pushes[0] + gyroscopic, pushes[1] + gyroscopic
    through = np.cumsum(net[1][::-1], axis=0)[::-1]
    wrenches = {"I dV": pushes[1], "net": net[1], "wrench": through}
    yield from _seen(bodies, wrenches, _pushed)
    yield from _seen(bodies, {"I dV": pushes[0], "net": net[0]}, _pushed)


def adjoint(poses: Array) -> Array:
    """What takes twists from moved axes to those that they are seen in, (N, 6, 6)."""
    turn = poses[:, :3, :3]
    out = np.zeros((len(poses), 6, 6))
    out[:, :3, :3] = out[:, 3:, 3:] = turn
    out[:, 3:, :3] = _skew(poses[:, :3, 3]) @ turn
    return out


def crossed(twist: Array) -> Array:
    """The product of a twist with others as a matrix, (6, 6): Featherstone's crm."""
    w, v = _skew(twist[None, :3])[0], _skew(twist[None, 3:])[0]
    return np.block([[w, np.zeros((3, 3))], [v, w]])


def pushing(bodies: PlacedLinks, load: Array) -> Iterator[Thing]:
    """What the joints carry where a wrench, force first, acts at the tool and no link is heavy.

    Args:
        bodies: at a state.
        load: that the tool exerts, base axes, (6,).
    """
    force, moment = load[:3], load[3:] + np.cross(bodies.tool[0][:3, 3], load[:3])
    wrench = np.concatenate([moment, force])
    every = np.broadcast_to(wrench, (len(bodies.frames), 6))
    yield from _seen(bodies, {"wrench": every}, _pushed)
    yield from _vectors(1, "load", "tool", _pushed(_inverse(bodies.tool[0])[None], every[:1]))


def _seen(
    bodies: PlacedLinks, things: dict[str, Array], turned: Callable[[Array, Array], Array]
) -> Iterator[Thing]:
    """Twists or wrenches in the base, in the links' frames, and in those in the centres."""
    for what, values in things.items():
        rank = _RANKS.get(what, 2)
        yield from _vectors(rank, what, "base", values)
        for at in (bodies.frames, bodies.centred):
            yield from _vectors(rank, what, "own", turned(_inverse(at), values))


def _moved(poses: Array, twists: Array) -> Array:
    """Twists as they are seen from moved axes."""
    return _each(adjoint(poses), twists)


def _pushed(poses: Array, wrenches: Array) -> Array:
    """Wrenches, moments first, as they are seen from moved axes."""
    back = adjoint(_inverse(poses))
    return _each(np.swapaxes(back, 1, 2), wrenches)


def _about(frames: Array, tensors: Array) -> Array:
    """Inertias about the base's origin as they are in other frames."""
    turn = adjoint(frames)
    return np.swapaxes(turn, 1, 2) @ tensors @ turn


def _vectors(rank: int, what: str, axes: str, values: Array) -> Iterator[Thing]:
    yield rank, what, values, axes
    yield rank, what, values @ _SWAP, axes


def _matrices(rank: int, what: str, axes: str, some: Array, turned: bool) -> Iterator[Thing]:
    for values in (some, _SWAP @ some @ _SWAP):
        yield rank, what, values, axes
        if turned:
            yield rank + 1, what, np.swapaxes(values, 1, 2), axes


def _each(matrices: Array, vectors: Array) -> Array:
    out: Array = (matrices @ vectors[:, :, None])[:, :, 0]
    return out


def _inverse(poses: Array) -> Array:
    return np.asarray(np.linalg.inv(poses), dtype=np.float64)


def _skew(vectors: Array) -> Array:
    out = np.zeros((len(vectors), 3, 3))
    x, y, z = vectors.T
    out[:, 0, 1], out[:, 0, 2], out[:, 1, 2] = -z, y, -x
    out[:, 1, 0], out[:, 2, 0], out[:, 2, 1] = z, -y, x
    return out
