"""What a motion meets on its way: limits, singularities, changes of branch; said where and when.

Limits are compared with exact extremes. For singularities the time is cut into pieces: on one of
half-length h about its middle, |q - q_mid| <= |v_mid| h + A h²/2 with A the largest acceleration,
and sigma_min(J) changes by at most K |q - q_mid|
(:func:`kinlab.analysis.singularities.nearest.slope_bound`), so that a piece is free for certain, or
is cut again. What is left at the end is either a change of sign of det J, which is a singularity
for certain, or is said to be undecided.
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any

import numpy as np
from numpy.typing import ArrayLike
from scipy.optimize import brentq

from kinlab.analysis.singularities.nearest import slope_bound
from kinlab.analysis.structure.task_space import TaskSpace, read_reachable_task
from kinlab.arrays import Array
from kinlab.drives.arm import demand_of
from kinlab.engine.fast.stacks import fk
from kinlab.errors import StructureError
from kinlab.host.evidence import Evidence
from kinlab.host.introductions import Told, counted
from kinlab.inverse.branches.solutions import ik_branches
from kinlab.model.library import ArmLike, as_robot
from kinlab.model.robot import Robot
from kinlab.motion.limits import positions_outside, read_limits
from kinlab.motion.record import Motion, peak_of
from kinlab.tolerances import TOLERANCES

_MOST = 20_000
"""Pieces of time looked at before what is left counts as undecided."""


@dataclass(frozen=True)
class Finding:
    """One thing that a motion meets.

    Attributes:
        kind: ``"position"``, ``"velocity"``, ``"acceleration"``, ``"effort"``, ``"singularity"``,
            ``"near singularity"`` or ``"branch"``.
        t: when, s. tool: where, (3,), m.
        sentence: the whole in words.
    """

    kind: str
    t: float
    tool: tuple[float, float, float]
    sentence: str


@dataclass(frozen=True, eq=False, repr=False)
class MotionCheck(Told):
    """What :func:`check` found.

    Attributes:
        findings: in order of time.
        sigma: J's sigma_min stays above this all the way, between the samples too (metres over
            the arm's own length); ``None``: not shown.
        task: coordinates that singularities are judged by.
        branches: name of the branch at the start and at the end; empty where the arm has no names.
        instants: at how many the efforts were compared; 0 where the arm states none.
    """

    robot: str
    findings: tuple[Finding, ...]
    sigma: float | None
    task: str
    branches: tuple[str, str]
    instants: int = 0

    @property
    def evidence(self) -> Evidence:
        """What holds at all times, and what was looked at in instants only."""
        proved = (
            "limits of positions, velocities and accelerations are compared with exact extremes"
        )
        if self.sigma is not None:
            proved += f"; sigma_min stays above {self.sigma:.3g}, so that no singularity is met"
        efforts = f"efforts at {self.instants:,} instants" if self.instants else ""
        return Evidence("the whole motion, piece by piece", proved=proved, found=efforts)

    @property
    def ok(self) -> bool:
        """Nothing was found, and no singularity is shown for all times."""
        return not self.findings and self.sigma is not None

    def __str__(self) -> str:
        if self.ok:
            efforts = f" (efforts compared at {self.instants:,} instants)" if self.instants else ""
            return (
                f"robot {self.robot!r}: within all limits{efforts}; no singularity on the way "
                f"(sigma_min above {self.sigma:.3g} at all times, task {self.task})"
            )
        lines = [f"robot {self.robot!r}: {counted(len(self.findings), 'finding')} on the way"]
        return "\n".join([*lines, *(f"  {one.sentence}" for one in self.findings)])


def check(
    robot: ArmLike,
    motion: Motion,
    *,
    velocity: ArrayLike | None = None,
    acceleration: ArrayLike | None = None,
    task: Any = "auto",
) -> MotionCheck:
    """What a motion meets: limits of the joints, singularities, changes of branch.

    Args:
        robot: the arm.
        motion: of this arm.
        velocity: largest |v|, one number or (n,); left out, the robot's own.
        acceleration: largest |a|; left out, any.
        task: coordinates that singularities are judged by, as in :func:`kinlab.manipulability`.

    Returns:
        The findings. Efforts are compared at instants of :func:`kinlab.drives.arm.demand_of`,
        whatever the samples of the motion, the rest at all times.

    Raises:
        StructureError: the motion has another number of joints.
        OptionError, NameUnknownError: limits or a task that cannot be used.
    """
    robot = as_robot(robot)
    if motion.q.shape[1] != robot.n:
        raise StructureError(
            f"robot {robot.name!r} has {robot.n} joints; the motion has {motion.q.shape[1]}"
        )
    space = read_reachable_task(robot, task)
    found = _limit_findings(robot, motion, velocity, acceleration)
    over, instants = _effort_findings(robot, motion)
    found += over
    sigma, singular = _singularities(space, motion)
    names = _branch(space, motion.q[0]), _branch(space, motion.q[-1])
    found += singular + _changes(space, motion, singular)
    found.sort(key=lambda one: one.t)
    return MotionCheck(robot.name, tuple(found), sigma, space.name, names, instants)


def _finding(robot: Robot, motion: Motion, kind: str, t: float, text: str) -> Finding:
    x, y, z = (float(c) for c in fk(robot, motion.at(t)[0])[:3, 3])
    return Finding(
        kind, t, (x, y, z), f"t = {t:.6g} s, tool at ({x:.4g}, {y:.4g}, {z:.4g}) m: {text}"
    )


def _limit_findings(
    robot: Robot,
    motion: Motion,
    velocity: ArrayLike | None,
    acceleration: ArrayLike | None,
) -> list[Finding]:
    limits = read_limits(robot, velocity, acceleration)
    names, found = robot.joint_names, []
    for joint, (when, by, bound) in positions_outside(robot, motion.curve).items():
        text = f"{names[joint]} is {by:.4g} beyond its limit {bound:.6g}"
        found.append(_finding(robot, motion, "position", when, text))
    for kind, order, bounds in (
        ("velocity", 1, limits.velocity),
        ("acceleration", 2, limits.acceleration),
    ):
        peak = peak_of(motion.curve, order)
        for joint in map(int, np.flatnonzero(peak.value > bounds * (1.0 + 1e-9))):
            text = f"{kind} of {names[joint]} is {peak.value[joint]:.6g}, above {bounds[joint]:.6g}"
            found.append(_finding(robot, motion, kind, float(peak.when[joint]), text))
    return found


def _effort_findings(robot: Robot, motion: Motion) -> tuple[list[Finding], int]:
    """Joints that need more than their effort, and at how many instants that was looked at."""
    effort = np.array(robot.model.upperEffortLimit)
    known = (effort > 0.0) & (effort < 1e100)
    if not known.any() or robot.singular_mass:
        return [], 0
    demand, _ = demand_of(robot, motion)
    tau, found = np.abs(demand.tau), []
    for joint in map(int, np.flatnonzero(known & (tau.max(axis=0) > effort * (1.0 + 1e-9)))):
        row = int(tau[:, joint].argmax())
        name = robot.joint_names[joint]
        text = f"{name} needs {tau[row, joint]:.4g}, above its effort {effort[joint]:.4g}"
        found.append(_finding(robot, motion, "effort", float(demand.t[row]), text))
    return found, len(demand.t)


def _changes(space: TaskSpace, motion: Motion, singular: list[Finding]) -> list[Finding]:
    """Changes of branch: where a singularity is met, by the names close on both sides of it.

    Names alone tell nothing: "elbow up" becomes "elbow down" without a singularity where the
    wrist passes over the shoulder.
    """
    times = [one.t for one in singular]
    found = []
    for k, one in enumerate(singular):
        before = times[k - 1] if k else 0.0
        after = times[k + 1] if k + 1 < len(times) else motion.duration
        low = one.t - min(TOLERANCES.beside_singularity * motion.duration, 0.5 * (one.t - before))
        high = one.t + min(TOLERANCES.beside_singularity * motion.duration, 0.5 * (after - one.t))
        names = [_branch(space, motion.at(t)[0]) for t in (low, high)]
        if not _other_branch(*names):
            continue
        way = f"from {names[0]!r} to {names[1]!r} through the singularity at t = {one.t:.6g} s"
        sure = one.kind == "singularity"
        text = f"branch changes {way}" if sure else f"branch may change {way}: undecided"
        found.append(_finding(space.robot, motion, "branch", one.t, text))
    return found


def _other_branch(one: str, two: str) -> bool:
    """Whether two names differ in a word that neither of them leaves undecided."""
    pairs = zip(one.split(", "), two.split(", "), strict=False)
    between = ("aligned", "over", "straight")
    return any(a != b and not a.endswith(between) and not b.endswith(between) for a, b in pairs)


def _branch(space: TaskSpace, q: Array) -> str:
    """The name of the branch that q lies on; empty where the arm has no names for them."""
    robot = space.robot
    if space.m < robot.n:
        return ""  # the spare joints join what would be branches
    try:
        found = ik_branches(robot, fk(robot, q))
    except StructureError:
        return ""
    if not len(found):
        return ""
    apart = np.abs(np.exp(1j * found.q) - np.exp(1j * q)).max(axis=1)
    return str(found.names[int(np.argmin(apart))]).partition(" #")[0]


# -------- Singularities


def _singularities(space: TaskSpace, motion: Motion) -> tuple[float | None, list[Finding]]:
    """A lower bound of sigma_min for all times, or what was met."""
    slope = slope_bound(space)
    push = float(np.linalg.norm(motion.peak_acceleration.value))
    knots = motion.knots
    centre, half = 0.5 * (knots[1:] + knots[:-1]), 0.5 * np.diff(knots)
    bound, looked = np.inf, 0
    left: list[Array] = []
    while len(centre):
        looked += len(centre)
        q, v, _ = motion.at(centre)
        values = space.sigma(q)
        least = values[:, -1] - TOLERANCES.singular_value_rounding * values[:, 0]
        reach = slope * (np.linalg.norm(v, axis=1) * half + 0.5 * push * half**2)
        good = reach <= 0.5 * least
        if good.any():
            bound = min(bound, float((least - reach)[good].min()))
        narrow = ~good & (half <= TOLERANCES.narrowest_piece * motion.duration)
        left.extend(centre[narrow])
        again = ~good & ~narrow
        if looked > _MOST:
            left.extend(centre[again])
            break
        centre, half = centre[again], 0.5 * half[again]
        centre, half = np.concatenate([centre - half, centre + half]), np.concatenate([half, half])
    if not left:
        return float(bound), []
    return None, _met(space, motion, np.sort(np.array(left)))


def _met(space: TaskSpace, motion: Motion, times: Array) -> list[Finding]:
    """The pieces that could not be shown free, as findings: crossings of det J = 0, or near."""
    robot = space.robot
    found = []
    apart = np.flatnonzero(np.diff(times) > TOLERANCES.same_finding * motion.duration) + 1
    for group in np.split(times, apart):
        wide = max(2e-6 * motion.duration, 0.05 * float(group[-1] - group[0]))
        low = max(0.0, float(group[0]) - wide)
        high = min(motion.duration, float(group[-1]) + wide)
        where = _crossing(space, motion, low, high)
        if where is not None:
            text = f"det J changes its sign (task {space.name}): a singularity"
            found.append(_finding(robot, motion, "singularity", where, text))
            continue
        inside = np.unique(np.concatenate([[low, high], group, np.linspace(low, high, 201)]))
        values = _sigma(space, motion, inside)
        at = int(values.argmin())
        text = (
            f"at or near a singularity (task {space.name}): sigma_min / sigma_max is "
            f"{values[at]:.2g}; whether it is one is undecided"
        )
        found.append(_finding(robot, motion, "near singularity", float(inside[at]), text))
    return found


def _sigma(space: TaskSpace, motion: Motion, t: Array) -> Array:
    values = space.sigma(motion.at(t)[0])
    return values[:, -1] / values[:, 0]


def _crossing(space: TaskSpace, motion: Motion, low: float, high: float) -> float | None:
    """When det J changes its sign between two times, if its signs there are beyond rounding."""
    if space.m != space.robot.n:
        return None

    def det(t: float) -> float:
        return float(np.linalg.det(space.jacobian(motion.at(t)[0], space.scale)))

    if _sigma(space, motion, np.array([low, high])).min() < 1e-10 or det(low) * det(high) >= 0.0:
        return None
    return float(brentq(det, low, high, xtol=1e-13 * motion.duration, rtol=1e-14))
