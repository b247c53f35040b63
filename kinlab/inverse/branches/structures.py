"""Which closed form an arm has: from the lines of its joint axes, whatever it was read from."""

from __future__ import annotations

from typing import Any, NamedTuple
from weakref import WeakKeyDictionary

import numpy as np

from kinlab.analysis.structure.axes import Axes, meeting_point
from kinlab.arrays import Array
from kinlab.engine.fast.arrays import ChainArrays, chain
from kinlab.engine.fast.kinematics_kernels import columns, frames
from kinlab.errors import StructureError
from kinlab.inverse.branches.closed_forms import PARALLEL, reversed_chain
from kinlab.inverse.branches.continuation import BOUNDS, generic_solutions
from kinlab.model.robot import Robot
from kinlab.tolerances import TOLERANCES

WRIST, TRIPLE, POINT, PLANE, GENERAL = 0, 1, 2, 3, 4
"""Families: spherical wrist, three parallel axes, a point carried by three joints, all axes
parallel, and any other arm."""

POSE, POSITION, POINTING = 0, 1, 2
"""What of T counts: all of it, its origin, or its origin and the direction of its z axis."""

_METHODS = {
    WRIST: "spherical wrist",
    TRIPLE: "three parallel axes",
    POINT: "point of three joints",
    PLANE: "planar",
    GENERAL: "continuation",
}

_ENDLESS = (
    "robot {0!r}: its {1} moving joints leave J singular everywhere, so that no pose has a finite "
    "number of solutions"
)


class Form(NamedTuple):
    """One arm as the compiled branches need it; do not write to the arrays.

    Attributes:
        fixed, prismatic: the chain that is solved, of six joints where it was completed by
            virtual ones (or of three, for a point; as it is, in the plane).
        real: number of joints that exist; the first of the chain.
        arm_fixed, arm_prismatic: the chain that exists, which every answer is measured on.
        turned_fixed, turned_prismatic: the solved chain from tool to base, where ``turned``.
        turned: whether the closed form is applied to the arm turned end for end.
        family: which closed form. task: what of T counts.
        centre, centre_tool: a spherical wrist's centre behind joint 3 and in the tool's frame;
            for a point of three joints the first; (3,).
        marker: a point in the tool's frame, (3,), that names the shoulder.
        poses, starts, length: of :class:`~kinlab.inverse.branches.continuation.Starts`; empty
            otherwise.
    """

    fixed: Array
    prismatic: Any
    real: int
    arm_fixed: Array
    arm_prismatic: Any
    turned_fixed: Array
    turned_prismatic: Any
    turned: bool
    family: int
    task: int
    centre: Array
    centre_tool: Array
    marker: Array
    poses: Any
    starts: Any
    length: float


class Known(NamedTuple):
    """What is kept of an arm: its form, what it is called, what its completeness rests on.

    ``sure`` is false where branches may be missing at any pose; the evidence says why.
    """

    form: Form
    method: str
    evidence: str
    solutions: int
    sure: bool


_FORMS: WeakKeyDictionary[Robot, dict[tuple[tuple[int, float], ...], Known]] = WeakKeyDictionary()

_KEPT = 64


def known_form(robot: Robot, given: tuple[tuple[int, float], ...] = ()) -> Known:
    """The closed form of a robot, worked out once.

    Args:
        robot: the robot.
        given: joints that are held, and where.

    Raises:
        StructureError: more than six joints are left, or no pose has isolated solutions.
    """
    kept = _FORMS.setdefault(robot, {})
    found = kept.get(given)
    if found is None:
        if len(kept) >= _KEPT:
            kept.clear()
        found = kept[given] = _work_out(robot, given)
    return found


def steps_of(fixed: Array) -> Array:
    """Chain rows as transforms, (n, 4, 4)."""
    steps = np.tile(np.eye(4), (len(fixed), 1, 1))
    steps[:, :3] = fixed.reshape(-1, 3, 4)
    return steps


def _rows(steps: Any) -> Array:
    return np.array([np.asarray(step)[:3].ravel() for step in steps])


def with_held(arm: ChainArrays, given: tuple[tuple[int, float], ...]) -> ChainArrays:
    """The chain of the joints that are left when some are held."""
    values = dict(given)
    steps = steps_of(arm.fixed)
    rest, kinds, behind = [], [], np.eye(4)
    for i, slides in enumerate(arm.prismatic):
        behind = behind @ steps[i]
        if i in values:
            motion = np.eye(4)
            if slides:
                motion[2, 3] = values[i]
            else:
                c, s = np.cos(values[i]), np.sin(values[i])
                motion[:2, :2] = [[c, -s], [s, c]]
            behind = behind @ motion
        else:
            rest.append(behind)
            kinds.append(bool(slides))
            behind = np.eye(4)
    return ChainArrays(_rows([*rest, behind @ steps[-1]]), np.array(kinds, dtype=np.bool_))


def _work_out(robot: Robot, given: tuple[tuple[int, float], ...]) -> Known:
    arm = with_held(chain(robot), given)
    n = len(arm.prismatic)
    if n > 6:
        raise StructureError(
            f"robot {robot.name!r}: {n} joints move the tool, one pose leaves {n - 6} of them "
            "free; hold some with given={joint: value}"
        )
    family, task, solved = _family(arm)
    if not _moves(solved, task if family in (PLANE, POINT) else POSE):
        raise StructureError(_ENDLESS.format(robot.name, n))
    turned, centre, centre_tool, marker = False, np.zeros(3), np.zeros(3), np.zeros(3)
    if family == GENERAL:
        found = _six(solved)
        if found is not None:
            family, turned, centre, centre_tool, marker = found
    elif family == POINT:
        centre = arm.fixed[3, [3, 7, 11]].copy()
    poses, starts = np.empty((0, 12), np.complex128), np.empty((0, 0, 6), np.complex128)
    length, count, evidence = 1.0, 0, "closed form; every real root of its equations was tried"
    if family == GENERAL:
        generic = generic_solutions(*solved)
        if generic is None:
            raise StructureError(_ENDLESS.format(robot.name, n))
        poses, starts, length = generic.poses, generic.q, generic.length
        count = starts.shape[1]
        most = BOUNDS.get(int(np.sum(solved.prismatic)), 2)
        why = (
            "as many as such an arm can have"
            if count == most
            else (f"{generic.quiet} loops of the pose in a row brought no further one")
        )
        evidence = f"{count} solutions in complex joints at a generic pose ({why}), each followed"
    doubt = _doubt(arm, family, count)
    if doubt:
        evidence = f"{evidence}; {doubt}"
    back, kinds = np.empty_like(solved.fixed), np.empty_like(solved.prismatic)
    reversed_chain(solved.fixed, solved.prismatic, back, kinds)
    form = Form(
        solved.fixed,
        solved.prismatic,
        n,
        arm.fixed,
        arm.prismatic,
        back,
        kinds,
        turned,
        family,
        task,
        centre,
        centre_tool,
        marker,
        poses,
        starts,
        length,
    )
    return Known(form, _METHODS[family], evidence, count, not doubt)


def _doubt(arm: ChainArrays, family: int, count: int) -> str:
    """Why branches of this arm may be missing at any pose, or nothing.

    Real solutions are even in number and complex ones come in pairs, so an odd count lacks one.
    Where axes nearly meet or are nearly parallel, solutions crowd together: loops of the pose may
    not tell them apart, and a closed form of the exact arm is not this arm's.
    """
    if family == GENERAL and count % 2 == 1:
        return "an odd count, so that some may be missing"
    full = family == GENERAL and count >= BOUNDS.get(int(np.sum(arm.prismatic)), 2)
    if full or family == PLANE:
        return ""
    steps, turns = steps_of(arm.fixed), ~arm.prismatic
    lines, pose = [], np.eye(4)
    for step in steps[:-1]:
        pose = pose @ step
        lines.append((pose[:3, 3].copy(), pose[:3, 2].copy()))
    size = max(float(np.linalg.norm(arm.fixed[1:, [3, 7, 11]], axis=1).sum()), 1e-9)
    feet: list[Array | None] = []
    for i in range(len(lines) - 1):
        (p, u), (o, w) = lines[i], lines[i + 1]
        normal = np.cross(u, w)
        sine = float(np.linalg.norm(normal))
        if TOLERANCES.structure_holds < sine < TOLERANCES.structure_nearly:
            return f"axes {i + 1} and {i + 2} are nearly parallel, so that some may be missing"
        foot = None
        if sine >= TOLERANCES.structure_nearly and turns[i] and turns[i + 1]:
            gap = abs(float(normal @ (o - p))) / sine
            if TOLERANCES.structure_holds * size < gap < TOLERANCES.structure_nearly * size:
                return f"axes {i + 1} and {i + 2} nearly meet, so that some may be missing"
            if gap <= TOLERANCES.structure_holds * size:
                foot = p + u * float(np.cross(o - p, w) @ normal) / sine**2
        feet.append(foot)
    for i in range(len(feet) - 1):
        one, other = feet[i], feet[i + 1]
        if one is not None and other is not None:
            gap = float(np.linalg.norm(one - other))
            if TOLERANCES.structure_holds * size < gap < TOLERANCES.structure_nearly * size:
                return f"axes {i + 1} to {i + 3} nearly meet, so that some may be missing"
    return ""


def _family(arm: ChainArrays) -> tuple[int, int, ChainArrays]:
    """Family, task and the chain to solve, of an arm of at most six joints."""
    n = len(arm.prismatic)
    if n == 6:
        return GENERAL, POSE, arm
    turns = int(np.sum(~arm.prismatic))
    rotations = arm.fixed[1:-1].reshape(-1, 3, 4)[:, :, :3]
    parallel = bool(np.all(np.hypot(rotations[:, 0, 2], rotations[:, 1, 2]) < PARALLEL))
    if n > 1 and parallel and turns in (2, 3) and n - turns <= 1:
        return PLANE, POSE if turns == 3 else POSITION, arm
    if n == 3 and _holds(arm, (0, 1, 2)):
        if not arm.prismatic[:2].any():
            return POINT, POSITION, arm
        return GENERAL, POSITION, _with_wrist(arm)
    if n == 5:
        extra = np.eye(4)[:3].reshape(1, 12)
        pointing = ChainArrays(np.vstack([arm.fixed, extra]), np.append(arm.prismatic, False))
        if _holds(pointing, (0, 1, 2, 3, 4, 5)):
            return GENERAL, POINTING, pointing
    return GENERAL, POSE, _with_strangers(arm)


def _moves(arm: ChainArrays, task: int) -> bool:
    """Whether no joint can do what others do: J has independent columns in general position."""
    n = len(arm.prismatic)
    return (
        _rank_share(arm, (0, 1, 2) if task == POSITION else (0, 1, 2, 3, 4, 5), n)
        > TOLERANCES.task_holds
    )


def _holds(arm: ChainArrays, rows: tuple[int, ...]) -> bool:
    """Whether J has full rank in these rows at a state in general position."""
    return _rank_share(arm, rows, len(rows)) > TOLERANCES.task_holds


def _rank_share(arm: ChainArrays, rows: tuple[int, ...], rank: int) -> float:
    """Largest ratio of the rank-th singular value of these rows of J to the first, of some q."""
    n = len(arm.prismatic)
    best = 0.0
    for q in np.random.default_rng(5).uniform(-2.0, 2.0, (6, n)):
        jac, _ = jacobian_and_pose(arm.fixed, arm.prismatic, q)
        values = np.linalg.svd(jac[list(rows)], compute_uv=False)
        if len(values) >= rank and values[0] > 0.0:
            best = max(best, float(values[rank - 1] / values[0]))
    return best


def jacobian_and_pose(fixed: Array, prismatic: Any, q: Array) -> tuple[Array, Array]:
    """Jacobian in the base's axes, (6, n), and tool pose, (12,), of a chain at q (n,)."""
    n = len(prismatic)
    axes, pose, jac = np.empty((n, 6)), np.empty(12), np.zeros((6, n))
    frames(fixed, prismatic, q, axes, pose)
    columns(prismatic, axes, pose, jac)
    return jac, pose


def _with_wrist(arm: ChainArrays) -> ChainArrays:
    """Adds three virtual axes that meet in the tool, so that its orientation is free."""
    tilt = np.array([[1.0, 0, 0], [0, 0, -1], [0, 1, 0]])
    step, other, last = np.eye(4), np.eye(4), np.eye(4)
    step[:3, :3], other[:3, :3] = tilt, tilt.T
    # a rotation in general position, so that the arm's own orientation finds no aligned wrist
    turn, _ = np.linalg.qr(np.random.default_rng(11).normal(size=(3, 3)))
    last[:3, :3] = turn * np.linalg.det(turn)
    extra = _rows([step, other, last])
    return ChainArrays(np.vstack([arm.fixed, extra]), np.append(arm.prismatic, [False] * 3))


def _with_strangers(arm: ChainArrays) -> ChainArrays:
    """Completes an arm to six joints by virtual ones in general position.

    Where all virtual joints are zero the tool is the arm's own: these are the solutions sought.
    """
    rng = np.random.default_rng(7)
    size = max(float(np.linalg.norm(arm.fixed[1:, [3, 7, 11]], axis=1).sum()), 0.1)
    steps = list(steps_of(arm.fixed))
    behind = np.eye(4)
    for _ in range(6 - len(arm.prismatic)):
        turn, _ = np.linalg.qr(rng.normal(size=(3, 3)))
        step = np.eye(4)
        step[:3, :3] = turn * np.linalg.det(turn)
        step[:3, 3] = size * rng.uniform(-0.3, 0.3, 3)
        steps[-1] = steps[-1] @ step
        behind = behind @ step
        steps.append(np.eye(4))
    steps[-1] = steps[-1] @ np.linalg.inv(behind)
    return ChainArrays(_rows(steps), np.append(arm.prismatic, [False] * (6 - len(arm.prismatic))))


def _six(arm: ChainArrays) -> tuple[int, bool, Array, Array, Array] | None:
    """Family of a six-joint chain, or ``None``: family, turned, centre, centre_tool, marker."""
    back, kinds = np.empty_like(arm.fixed), np.empty_like(arm.prismatic)
    reversed_chain(arm.fixed, arm.prismatic, back, kinds)
    for turned, each in ((False, arm), (True, ChainArrays(back, kinds))):
        centre = wrist_in_frames(each)
        if centre is not None and not _constant_height(each):
            return WRIST, turned, *centre, centre[1]
    for turned, each in ((False, arm), (True, ChainArrays(back, kinds))):
        if each.prismatic.any():
            continue
        third, fourth, fifth = each.fixed[2:5]
        flat = max(np.hypot(third[2], third[6]), np.hypot(fourth[2], fourth[6])) < PARALLEL
        # neither axis 1 nor axis 5 along the three
        if flat and np.hypot(each.fixed[1, 2], each.fixed[1, 6]) > PARALLEL:
            slope = np.hypot(fifth[2], fifth[6]) > PARALLEL
            if slope:
                last = steps_of(each.fixed[6:])[0]
                marker = -last[:3, :3].T @ last[:3, 3]  # the origin of joint 6's frame
                return TRIPLE, turned, np.zeros(3), np.zeros(3), marker
    return None


def _constant_height(arm: ChainArrays) -> bool:
    """Whether axes 1, 2 and 3 are parallel: the wrist's centre is then not moved in space."""
    second, third = arm.fixed[1], arm.fixed[2]
    return not arm.prismatic[2] and bool(
        max(np.hypot(second[2], second[6]), np.hypot(third[2], third[6])) < PARALLEL
    )


def wrist_in_frames(arm: ChainArrays) -> tuple[Array, Array] | None:
    """Where the last three axes intersect, neighbours not parallel; or ``None``.

    Args:
        arm: of six joints; 1, 2, 4, 5, 6 revolute.

    Returns:
        The centre in the frame behind joint 3's motion, (3,), and in the tool's frame, (3,).
    """
    prismatic = arm.prismatic
    if len(prismatic) != 6 or prismatic[[0, 1, 3, 4, 5]].any():
        return None
    steps = steps_of(arm.fixed)
    fourth = steps[3]
    fifth = fourth @ steps[4]
    sixth = fifth @ steps[5]
    lines = np.stack([fourth, fifth, sixth])
    axes = Axes(np.ones(3, dtype=np.bool_), lines[:, :3, 2], lines[:, :3, 3])
    across = np.cross(axes.direction[:-1], axes.direction[1:])
    if np.min(np.sum(across**2, axis=1)) < PARALLEL:
        return None
    centre = meeting_point(axes, (0, 1, 2))
    if centre is None:
        return None
    tool = np.linalg.inv(sixth @ steps[6])
    return centre, tool[:3, :3] @ centre + tool[:3, 3]
