"""Closed form of six-joint arms with a spherical wrist (Pieper 1968; Craig, section 4.6).

Frames come from the chain, in which every joint turns about its own z, so that standard DH,
modified DH and URDF arms are one case. The wrist centre w does not depend on q4, q5, q6:

1. Position. Seen from joint 1's frame, w = F2 Rz(q2) h(q3), h(q3) = F3 M3(q3) c. The height of w
   along axis 1 and its distance from a point on it do not depend on q1. With m the x-y part of
   Rz(q2) h, both are linear in m: a.m = C1(q3), b.m = C2(q3), and |m|^2 = H(q3).
   - axes 1 and 2 parallel, a = 0: C1(q3) = 0, then b.m = C2 gives q2;
   - axes 1 and 2 intersect, b = 0: C2(q3) = 0, then a.m = C1 gives q2;
   - otherwise |M^-1 (C1, C2)|^2 = H(q3), Pieper's quartic; q2 from m.
   Each is a polynomial in e^{i q3} (or in q3, where joint 3 slides), found from its values.
2. Orientation. Rz(q4) A5 Rz(q5) A6 Rz(q6) = R: its last entry is linear in cos q5 and sin q5.

Up to four ways to bring w to its place and two for each of them to turn the wrist.
"""

from __future__ import annotations

import math
from collections.abc import Callable

import numpy as np

from kinlab.arrays import Array
from kinlab.chain_arrays import Chain
from kinlab.errors import StructureError
from kinlab.inverse.planar import linear_trig

_PARALLEL = 1e-9
"""sin of the angle between axes 1 and 2."""

_MEETS = 1e-9
"""Metres between lines that intersect."""

_ON_CIRCLE = 1e-4
"""How far a root may lie from the unit circle: a double root is found to the square root of
rounding. What is too much is thrown out when Pinocchio measures it."""

_ALIGNED = 1e-7
"""sin of the angle between axes 4 and 6 below which only q4 +- q6 is fixed; q4 = 0 is taken."""


def wrist_centre(chain: Chain) -> tuple[Array, Array] | None:
    """Where the last three axes intersect, or ``None``.

    Args:
        chain: of six joints; 1, 2, 4, 5, 6 revolute.

    Returns:
        The centre in the frame behind joint 3's motion, (3,), and in the tool's frame, (3,).
    """
    prismatic = chain.prismatic
    if len(prismatic) != 6 or prismatic[[0, 1, 3, 4, 5]].any():
        return None
    steps = _steps(chain)
    fourth = steps[3]
    fifth = fourth @ steps[4]
    sixth = fifth @ steps[5]
    lines = [(f[:3, 3], f[:3, 2]) for f in (fourth, fifth, sixth)]
    (p4, z4), (p5, z5), _ = lines
    normal = np.cross(z4, z5)
    square = float(normal @ normal)
    if square < _PARALLEL:
        return None
    centre = p4 + z4 * (float(np.cross(p5 - p4, z5) @ normal) / square)
    if any(np.linalg.norm(np.cross(centre - p, z)) > _MEETS for p, z in lines):
        return None
    tool = np.linalg.inv(sixth @ steps[6])
    return centre, tool[:3, :3] @ centre + tool[:3, 3]


def solve(chain: Chain, target: Array, centre: tuple[Array, Array]) -> list[Array]:
    """All q that bring the tool to the target.

    Args:
        chain: the arm.
        target: (4, 4).
        centre: from :func:`wrist_centre`.

    Returns:
        Up to eight (6,), angles not wrapped, limits not looked at; to be polished and measured.

    Raises:
        StructureError: the first three joints cannot move the wrist's centre in space.
    """
    steps = _steps(chain)
    goal = target[:3, :3] @ centre[1] + target[:3, 3]
    answers = []
    for first in _position(steps, bool(chain.prismatic[2]), centre[0], goal):
        pose = np.eye(4)
        for step, value, slides in zip(steps[:3], first, chain.prismatic[:3], strict=True):
            pose = pose @ step @ _move(value, bool(slides))
        answers += [np.array([*first, *rest]) for rest in _orientation(steps, pose, target)]
    return answers


def _position(
    steps: Array, slides: bool, centre: Array, goal: Array
) -> list[tuple[float, float, float]]:
    """(q1, q2, q3) that bring the wrist centre to the goal."""
    base = np.linalg.inv(steps[0])
    p = base[:3, :3] @ goal + base[:3, 3]
    turn, shift = steps[1][:3, :3], steps[1][:3, 3]
    # count heights and distances from the foot of the common perpendicular of axes 1 and 2
    z2 = turn[:, 2]
    sine = math.hypot(z2[0], z2[1])
    foot = 0.0
    if sine > _PARALLEL:
        normal = np.array([-z2[1], z2[0], 0.0])  # z1 x z2
        foot = float(np.cross(shift, z2) @ normal) / sine**2
    lifted = shift - np.array([0.0, 0.0, foot])
    p = p - np.array([0.0, 0.0, foot])
    a = turn[2, :2]
    b = 2.0 * (turn.T @ lifted)
    apart = float(np.linalg.norm(np.cross(lifted, z2)))

    def h(q3: float) -> Array:
        moved: Array = (steps[2] @ _move(q3, slides) @ np.append(centre, 1.0))[:3]
        return moved

    def c1(q3: float) -> float:
        return float(p[2] - lifted[2] - turn[2, 2] * h(q3)[2])

    def c2(q3: float) -> float:
        v = h(q3)
        return float(p @ p - v @ v - lifted @ lifted - b[2] * v[2])

    if sine <= _PARALLEL:
        thirds, row, right = _roots(c1, slides), b[:2], c2
    elif apart <= _MEETS:
        thirds, row, right = _roots(c2, slides), a, c1
    else:
        inverse = np.linalg.inv(np.array([a, b[:2]]))

        def quartic(q3: float) -> float:
            m, v = inverse @ np.array([c1(q3), c2(q3)]), h(q3)
            return float(m @ m - v[0] ** 2 - v[1] ** 2)

        pairs = []
        for q3 in _roots(quartic, slides):
            m, v = inverse @ np.array([c1(q3), c2(q3)]), h(q3)
            pairs.append((math.atan2(m[1], m[0]) - math.atan2(v[1], v[0]), q3))
        return [_with_first(p, lifted, turn, h, *pair) for pair in pairs]
    pairs = []
    for q3 in thirds:
        v = h(q3)
        cosine = float(row[0] * v[0] + row[1] * v[1])
        sine_ = float(row[1] * v[0] - row[0] * v[1])
        pairs += [(q2, q3) for q2 in linear_trig(cosine, sine_, right(q3))]
    return [_with_first(p, lifted, turn, h, *pair) for pair in pairs]


def _with_first(
    p: Array, shift: Array, turn: Array, h: Callable[[float], Array], q2: float, q3: float
) -> tuple[float, float, float]:
    """Adds q1, which turns the arm about axis 1 onto the goal (0 where the goal lies on it)."""
    out = shift + turn @ (_move(q2, False)[:3, :3] @ h(q3))
    if math.hypot(p[0], p[1]) < _MEETS:
        return 0.0, q2, q3
    return math.atan2(p[1], p[0]) - math.atan2(out[1], out[0]), q2, q3


def _orientation(steps: Array, third: Array, target: Array) -> list[tuple[float, float, float]]:
    """(q4, q5, q6) for the pose behind joint 3."""
    a5, a6 = steps[4][:3, :3], steps[5][:3, :3]
    asked = (third[:3, :3] @ steps[3][:3, :3]).T @ target[:3, :3] @ steps[6][:3, :3].T
    u, v = a5[2], a6[:, 2]  # asked[2, 2] = u . Rz(q5) v
    cosine, sine = u[0] * v[0] + u[1] * v[1], u[1] * v[0] - u[0] * v[1]
    answers = []
    for q5 in linear_trig(float(cosine), float(sine), float(asked[2, 2] - u[2] * v[2])):
        middle = a5 @ _move(q5, False)[:3, :3] @ a6
        q4 = 0.0
        if math.hypot(middle[0, 2], middle[1, 2]) > _ALIGNED:
            q4 = math.atan2(asked[1, 2], asked[0, 2]) - math.atan2(middle[1, 2], middle[0, 2])
        last = (_move(q4, False)[:3, :3] @ middle).T @ asked
        answers.append((q4, q5, math.atan2(last[1, 0] - last[0, 1], last[0, 0] + last[1, 1])))
    return answers


def _roots(function: Callable[[float], float], slides: bool) -> list[float]:
    """Real roots of a function that is a polynomial of degree four in q, or two in e^{iq}.

    Its coefficients follow from five of its values: exactly, so that nothing is expanded by hand.

    Raises:
        StructureError: it does not depend on q at all.
    """
    x = np.array([-1.0, -0.5, 0.0, 0.5, 1.0]) if slides else 2.0 * np.pi * np.arange(5) / 5.0
    values = np.array([function(float(v)) for v in x])
    if np.ptp(values) < 1e-12 * max(1.0, float(np.abs(values).max())):
        raise StructureError(
            "joint 3 does not change the height or distance of the wrist's centre: such an arm "
            "has no isolated branches"
        )
    if slides:
        coefficients = np.linalg.solve(np.vander(x), values)
        coefficients[np.abs(coefficients) < 1e-12 * np.abs(coefficients).max()] = 0.0
        found = np.roots(coefficients)
        near = np.abs(found.imag) < _ON_CIRCLE * (1.0 + np.abs(found))
        return _distinct(found.real[near])
    wave = np.fft.fft(values) / 5.0  # of e^0, e^iq, e^2iq, e^-2iq, e^-iq
    coefficients = np.array([wave[2], wave[1], wave[0], wave[4], wave[3]])
    if np.abs(wave[[2, 3]]).max() < 1e-12 * np.abs(wave).max():
        a, b = 2.0 * wave[1].real, -2.0 * wave[1].imag
        return linear_trig(float(a), float(b), -float(wave[0].real))
    found = np.roots(coefficients)
    near = np.abs(np.abs(found) - 1.0) < _ON_CIRCLE
    return _distinct(np.angle(found[near]))


def _distinct(values: Array) -> list[float]:
    """Without the second of a double root."""
    kept: list[float] = []
    for value in np.sort(values):
        if not kept or value - kept[-1] > 1e-9:
            kept.append(float(value))
    return kept


def _steps(chain: Chain) -> Array:
    steps = np.tile(np.eye(4), (len(chain.fixed), 1, 1))
    steps[:, :3] = chain.fixed.reshape(-1, 3, 4)
    return steps


def _move(value: float, slides: bool) -> Array:
    pose = np.eye(4)
    if slides:
        pose[2, 3] = value
    else:
        c, s = math.cos(value), math.sin(value)
        pose[:2, :2] = [[c, -s], [s, c]]
    return pose
