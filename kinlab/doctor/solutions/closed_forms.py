"""The closed forms of inverse kinematics as the textbooks derive them, walked branch by branch.

The planar arm by the cosine law (Craig 4.4, Siciliano 2.12.1, Spong 1.4, Lynch and Park 6.1), with
a third joint, with a slide; SCARA; the elbow arm (Siciliano 2.12.4); note 000's spatial arm; and
the PUMA with its spherical wrist (Craig 4.7). Each is taken only of an arm of which Pinocchio's
forward kinematics confirms every branch of it.
"""

from __future__ import annotations

import re
from collections.abc import Iterator
from dataclasses import dataclass, replace
from itertools import product
from typing import Any

import numpy as np

from kinlab.arrays import Array
from kinlab.check.quantities.inverse import TASKS, reached
from kinlab.doctor.changes import Case
from kinlab.doctor.derivations.givens import Stacks
from kinlab.doctor.derivations.roads import Road, Ways
from kinlab.doctor.derivations.walk import Walk, program
from kinlab.engine.kinematics import fk, jacobian
from kinlab.host.language import N_
from kinlab.model.link import Convention
from kinlab.model.robot import Robot
from kinlab.tolerances import TOLERANCES

TWO_LINKS = """
# the cosine of q2
c2 = clamp((x**2 + y**2 - l1**2 - l2**2)/(2*l1*l2))
# the sine of q2
s2 = elbow*sqrt(1 - c2**2)
# the angle q2
q[2] = arctan2(s2, c2)
# the angle q1
q[1] = arctan2(y, x) - arctan2(l2*s2, l1 + l2*c2)
"""
COSINE_LAW = """
# the cosine of q2
c2 = clamp((x**2 + y**2 - l1**2 - l2**2)/(2*l1*l2))
# the angle q2
q[2] = elbow*arccos(c2)
# the angle q1
q[1] = arctan2(y, x) - arctan2(l2*sin(q[2]), l1 + l2*cos(q[2]))
"""
TRIANGLE = """
# the distance of the tool
r = sqrt(x**2 + y**2)
# the angle between the links
beta = arccos(clamp((l1**2 + l2**2 - r**2)/(2*l1*l2)))
# the angle at the base
psi = arccos(clamp((r**2 + l1**2 - l2**2)/(2*l1*r)))
# the angle q2
q[2] = elbow*(pi - beta)
# the angle q1
q[1] = arctan2(y, x) - elbow*psi
"""
PLANAR = (TWO_LINKS, COSINE_LAW, TRIANGLE)
"""Two links in the plane, solved in three ways."""
_WRIST = """
# the wrist's x
xw = x - l3*cos(phi)
# the wrist's y
yw = y - l3*sin(phi)
{two}
# the angle q3
q[3] = phi - (q[1] + q[2])
"""
_SCARA = """
{two}
# the way of the slide
q[3] = {z}
# the angle q4
q[4] = {turn}
"""
SLIDE_ON_HINGE = """
# the way of the slide
q[2] = side*sqrt(x**2 + y**2 - e**2) - d0
# the angle q1
q[1] = arctan2(y, x) - arctan2(e, q[2] + d0) - theta0
"""
ELBOW_ARM = """
# the angle q1
q[1] = arctan2(front*y, front*x)
# the distance from the first axis
r = front*sqrt(x**2 + y**2)
# the height above the shoulder
h = z - d1
# the cosine of q3
c3 = clamp((r**2 + h**2 - l2**2 - l3**2)/(2*l2*l3))
# the sine of q3
s3 = elbow*sqrt(1 - c3**2)
# the angle q3
q[3] = arctan2(s3, c3)
# the angle q2
q[2] = arctan2(h, r) - arctan2(l3*s3, l2 + l3*c3)
"""
_TURNED_HAND = """
# the sine of q3
s3 = z/l3
# the cosine of q3
c3 = front*sqrt(1 - s3**2)
# the angle q3
q[3] = arctan2(s3, c3)
# the length of the second link up to the tool
lh = l2 + l3*c3
{two}
"""
_PUMA = """
# the angle q1
q[1] = arctan2(py, px) {minus} arctan2(d3, front*sqrt(px**2 + py**2 - d3**2))
# Craig's K
K = (px**2 + py**2 + pz**2 - a2**2 - a3**2 - d3**2 - d4**2)/(2*a2)
# the angle q3
q[3] = arctan2(a3, d4) - arctan2(K, elbow*sqrt(a3**2 + d4**2 - K**2))
c1 = cos(q[1])
s1 = sin(q[1])
c3 = cos(q[3])
s3 = sin(q[3])
# the distance from the first axis
r = c1*px + s1*py
# the angle q2 + q3
q23 = arctan2(({back}a3 {minus} a2*c3)*pz - (d4 - a2*s3)*r, {elbow}*pz + (a3 + a2*c3)*r)
# the angle q2
q[2] = q23 - q[3]
c23 = cos(q23)
s23 = sin(q23)
# the angle q4
q[4] = arctan2(wrist*({across}), wrist*({back2}r33*s23 - r13*c1*c23 - r23*s1*c23))
c4 = cos(q[4])
s4 = sin(q[4])
# the sine of q5
s5 = {back2}r33*s23*c4 - r13*(c1*c23*c4 {plus} s1*s4) - r23*(s1*c23*c4 {minus} c1*s4)
# the cosine of q5
c5 = -r13*c1*s23 - r23*s1*s23 {minus} r33*c23
# the angle q5
q[5] = arctan2(s5, c5)
# the sine of q6
s6 = {back2}r31*s23*s4 - r11*(c1*c23*s4 {minus} s1*c4) - r21*(s1*c23*s4 {plus} c1*c4)
# the cosine of q6
c6 = (r11*((c1*c23*c4 {plus} s1*s4)*c5 - c1*s23*s5) + r21*((s1*c23*c4 {minus} c1*s4)*c5 - s1*s23*s5)
      {minus} r31*(s23*c4*c5 + c23*s5))
# the angle q6
q[6] = arctan2(s6, c6)
"""
PUMA = {
    "alpha1 = -90 degrees": _PUMA.format(
        plus="+", minus="-", back="-", back2="", elbow="(a2*s3 - d4)", across="r23*c1 - r13*s1"
    ),
    "alpha1 = 90 degrees": _PUMA.format(
        plus="-", minus="+", back="", back2="-", elbow="(d4 - a2*s3)", across="r13*s1 - r23*c1"
    ),
}
"""Craig's 4.7, and the same with the second axis the other way."""

LINES = (
    N_("the cosine of q2"), N_("the sine of q2"), N_("the angle q1"),
    N_("the angle q2"), N_("the angle q3"), N_("the angle q4"), N_("the angle q5"),
    N_("the angle q6"), N_("the distance of the tool"),
    N_("the angle between the links"), N_("the angle at the base"), N_("the wrist's x"),
    N_("the wrist's y"), N_("the way of the slide"),
    N_("the distance from the first axis"), N_("the height above the shoulder"),
    N_("the cosine of q3"), N_("the sine of q3"),
    N_("the length of the second link up to the tool"), N_("Craig's K"),
    N_("the angle q2 + q3"), N_("the sine of q5"), N_("the cosine of q5"),
    N_("the sine of q6"), N_("the cosine of q6"),
)  # fmt: skip
"""What the lines are, to be translated."""

_SIDES = ("elbow", "front", "side", "wrist")
"""Names that stand for +1 or -1: which branch."""
_MOST_FOR_PAIRS = 4
"""Joints up to which two steps are tried together."""
Numbers = dict[str, float]
_FEWEST = 10
"""Targets that a branch must reach to be looked at."""


@dataclass(frozen=True, eq=False)
class Branch:
    """One branch of a closed form, as the engine of a case.

    Attributes:
        road: the derivation; what it gives is :func:`compared`.
        arguments: the names of what is given.
    """

    road: Road
    arguments: tuple[str, ...]

    def __call__(self, robot: Robot, *given: Any) -> Array:
        del robot
        values = self.road.walked([()], dict(zip(self.arguments, given, strict=True)))[0]
        return np.asarray(values[0])

    def joints(self, given: Stacks) -> Array:
        """The joint positions at the targets, (N, n), as the formulas have them; NaN for none."""
        return np.asarray(self.road.walked([()], given)[1].stacked("q")[0])


def compared(robot: Robot, q: Array) -> Array:
    """Joint positions (..., n) without whole turns: cosines and sines of hinges, ways of slides."""
    slide = slides(robot)
    with np.errstate(invalid="ignore"):
        one = np.where(slide, q, np.cos(q))
        two = np.where(slide, 0.0 * q, np.sin(q))
    return np.concatenate([one, two], axis=-1)


def slides(robot: Robot) -> Any:
    """Which joints slide, (n,)."""
    turning = np.linalg.norm(jacobian(robot, np.zeros(robot.n))[3:], axis=0)
    return turning < TOLERANCES.vanishes


Branches = list[tuple[Case, Any]]
"""The case of the targets that a branch reaches, and which of all these are, (N,)."""


def closed_forms(case: Case, limited: bool) -> Iterator[Branches]:
    """The branches of each closed form of the arm, as cases that still have no answer.

    Args:
        case: of a quantity of inverse kinematics.
        limited: with the cosines limited to [-1, 1], as careful writers have them.
    """
    for text, numbers in _closed_forms(case.robot, case.quantity.name):
        if limited and "clamp(" not in text:
            continue
        lines = re.sub("#.*", "", text)
        names = [side for side in _SIDES if re.search(rf"\b{side}\b", lines)]
        written = text if limited else text.replace("clamp(", "(")
        found = []
        for signs in product((1.0, -1.0), repeat=len(names)):
            sides = dict(zip(names, signs, strict=True))
            branch = Branch(_road(case, written, numbers | sides), case.quantity.arguments)
            gap = _misses(case, branch)
            at = np.isfinite(gap)
            given = {name: x[at] for name, x in case.arguments.items()}
            quantity = replace(case.quantity, engine=branch, read=None)
            found.append((replace(case, quantity=quantity, arguments=given), at, gap))
        every = np.stack([gap for _case, _at, gap in found])
        known = np.isfinite(every)
        if known.any(axis=0).all() and np.max(every[known]) <= TOLERANCES.formula_agrees:
            yield [(one, at) for one, at, _gap in found if np.sum(at) >= _FEWEST]


def _misses(case: Case, branch: Branch) -> Array:
    """How far Pinocchio finds the tool from each target, (N,); NaN where there is no solution."""
    task = TASKS[case.quantity.name]
    places = reached(case.robot, task, branch.joints(case.arguments))
    gap = np.abs(places - task.target(*case.arguments.values()))
    out: Array = np.max(gap.reshape(len(gap), -1), axis=1)
    return out


def _road(case: Case, text: str, numbers: Numbers) -> Road:
    of, robot = program(text), case.robot
    given = {name: np.full(1, value) for name, value in {**numbers, "pi": np.pi}.items()}

    def walked(ways: Ways, x: Stacks) -> tuple[Array, Walk]:
        named = {**given, **_entries(robot, x)}
        walk = Walk(of, lambda _: named, next(iter(x.values())), ways, 0)
        return compared(robot, walk.values("q")), walk

    return Road(of, walked, 0, of.work(0), pairs=robot.n <= _MOST_FOR_PAIRS)


def _entries(robot: Robot, x: Stacks) -> Stacks:
    """What is given, by name; of a pose the entries of that of the last frame in the base."""
    if "pose" not in x or robot.table is None:
        return x
    base, tool = np.asarray(robot.table.base), np.asarray(robot.table.tool)
    pose = np.linalg.inv(base) @ x["pose"] @ np.linalg.inv(tool)
    turned = {f"r{i + 1}{j + 1}": pose[:, i, j] for i in range(3) for j in range(3)}
    return {**turned, "px": pose[:, 0, 3], "py": pose[:, 1, 3], "pz": pose[:, 2, 3]}


# -------- Which closed forms an arm may have, with its numbers; whether it has, Pinocchio says


def _closed_forms(robot: Robot, name: str) -> Iterator[tuple[str, Numbers]]:
    slide = slides(robot).tolist()
    if name == "inverse_kinematics_xy" and slide == [False, True]:
        yield SLIDE_ON_HINGE, _slide_on_hinge(robot)
    elif name == "inverse_kinematics_xyzphi" and slide == [False, False, True, False]:
        speed = jacobian(robot, np.zeros(4))
        z = "z - z0" if speed[2, 2] > 0 else "z0 - z"
        turn = "phi - (q[1] + q[2])" if speed[5, 3] > 0 else "q[1] + q[2] - phi"
        numbers = {**_lengths(robot, 2), "z0": float(fk(robot, np.zeros(4))[2, 3])}
        for two in PLANAR:
            yield _SCARA.format(two=two, z=z, turn=turn), numbers
    elif any(slide):
        return
    elif name in ("inverse_kinematics_xy", "inverse_kinematics_xyphi"):
        for two in PLANAR:
            text = two if robot.n == 2 else _WRIST.format(two=_renamed(two, x="xw", y="yw"))
            yield text, _lengths(robot, robot.n)
    elif name == "inverse_kinematics_xyz":
        yield ELBOW_ARM, _elbow_arm(robot)
        for two in PLANAR:
            yield _TURNED_HAND.format(two=_renamed(two, l2="lh")), _turned_hand(robot)
    elif name == "inverse_kinematics" and robot.n == 6 and robot.table is not None:
        _one, two_, three, four, *_rest = robot.table.links
        offsets = {"d3": three.d, "d4": four.d}
        if robot.table.convention is Convention.STANDARD:
            rows = {"a2": two_.a, "a3": three.a}
        else:
            rows = {"a2": three.a, "a3": four.a}
        for text in PUMA.values():
            yield text, {**rows, **offsets}


def _renamed(text: str, **names: str) -> str:
    for old, new in names.items():
        text = re.sub(rf"(?<!\[)\b{old}\b(?!\])", new, text)
    return text


def _lengths(robot: Robot, count: int) -> Numbers:
    """The distances of parallel axes, and of the last of them from the tool."""
    speed = jacobian(robot, np.zeros(robot.n))[:3, :count]
    steps = np.linalg.norm(speed - np.column_stack([speed[:, 1:], np.zeros(3)]), axis=0)
    return {f"l{k + 1}": float(length) for k, length in enumerate(steps)}


def _slide_on_hinge(robot: Robot) -> Numbers:
    start, along = fk(robot, np.zeros(2))[:2, 3], jacobian(robot, np.zeros(2))[:2, 1]
    return {
        "theta0": float(np.arctan2(along[1], along[0])),
        "d0": float(start @ along),
        "e": float(along[0] * start[1] - along[1] * start[0]),
    }


def _elbow_arm(robot: Robot) -> Numbers:
    zero = np.zeros(3)
    speed, height = jacobian(robot, zero), fk(robot, zero)[2, 3]
    two, three, axis = speed[:3, 1], speed[:3, 2], speed[3:, 1]
    return {
        "l2": float(np.linalg.norm(two - three)),
        "l3": float(np.linalg.norm(three)),
        "d1": float(height - np.cross(two, axis)[2]),
    }


def _turned_hand(robot: Robot) -> Numbers:
    one, two, three = jacobian(robot, np.zeros(3))[:3].T
    last = float(np.linalg.norm(three))
    return {
        "l1": float(np.linalg.norm(one - two)),
        "l2": float(np.linalg.norm(two)) - last,
        "l3": last,
    }
