"""All solutions of inverse kinematics, for one pose or many, by the structure of the arm."""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from dataclasses import dataclass, replace
from typing import Any, NamedTuple
from weakref import WeakKeyDictionary

import numpy as np
from numpy.typing import ArrayLike

from kinlab.arrays import Array, number, real_array, whole
from kinlab.engine.fast.arrays import chain
from kinlab.engine.fast.compiled import kernel
from kinlab.engine.kinematics import tool_poses
from kinlab.errors import NameUnknownError, OptionError, StateError, StructureError, near
from kinlab.host.introductions import Introduction, Rows, counted, numbered, shown_cells
from kinlab.inverse.branches.families import IKFamily, families_at
from kinlab.inverse.branches.names import distinct, words_of
from kinlab.inverse.branches.rows import (
    DOUBLE,
    MOST,
    SLIPPED,
    TOLERANCE,
    UNDECIDED,
    Branches,
    all_branches,
    branch_rows,
    miss,
)
from kinlab.inverse.branches.structures import GENERAL, Known, known_form
from kinlab.inverse.request import read_target, read_targets
from kinlab.model.library import ArmLike, as_robot
from kinlab.model.robot import Robot

SAMPLES = 16
"""Values at which the spare joint of a seven-joint arm is held, where none is given."""


@dataclass(frozen=True, eq=False, repr=False)
class IKBranches(Rows):
    """All solutions found for one pose.

    Attributes:
        q: (m, n); angles turned into the limits where a whole turn does it.
        names: which shoulder, elbow and wrist, one text a row, no two alike.
        within_limits: (m,), bool.
        position_error, rotation_error: (m,), by Pinocchio, in the coordinates that count.
        method: ``"spherical wrist"``, ``"three parallel axes"``, ``"planar"``, ``"point of three
            joints"`` or ``"continuation"``.
        complete: whether these are all. False where infinitely many exist, where a path was lost
            or a candidate could neither be taken nor dismissed, and where a spare joint was
            sampled.
        evidence: what ``complete`` rests on, or why it is False.
        families: the infinite sets of solutions through some of the branches.
    """

    q: Array
    names: tuple[str, ...]
    within_limits: Any
    position_error: Array
    rotation_error: Array
    method: str
    complete: bool
    evidence: str = ""
    families: tuple[IKFamily, ...] = ()

    def __len__(self) -> int:
        return len(self.q)

    def __iter__(self) -> Iterator[Array]:
        return iter(self.q)

    def columns(self) -> dict[str, Any]:
        """Solution by solution: its name, the joints, limits and errors."""
        return {
            "name": list(self.names),
            **numbered("q", self.q),
            "within_limits": self.within_limits,
            "position_error": self.position_error,
            "rotation_error": self.rotation_error,
        }

    def introduction(self) -> Introduction:
        """How many solutions there are, whether these are all, and what that rests on."""
        sure = "these are all" if self.complete else "there may be MORE"
        inside = f"{int(np.sum(self.within_limits))} within the limits"
        lines = [self.evidence] if self.evidence else []
        if self.families:
            lines.append(f"{counted(len(self.families), 'infinite set')} of solutions among them")
        shown = {key: x for key, x in self.columns().items() if not key.endswith("error")}
        return Introduction(
            f"{counted(len(self), 'solution')}, {inside}; {sure} ({self.method})",
            tuple(lines),
            tuple(key.replace("_", " ") for key in shown) if len(self) else (),
            shown_cells(shown) if len(self) else (),
            len(self),
            "good" if self.complete and len(self) else "unsure",
        )


@dataclass(frozen=True, eq=False)
class IKBranchesBatch:
    """All solutions of many poses; ``batch[i]`` is what :func:`ik_branches` answers for pose i.

    Attributes:
        q: (N, m, n), m the largest number of solutions; NaN in rows that a pose does not have.
        counts: (N,), how many solutions each pose has.
        within_limits: (N, m), bool.
        position_error, rotation_error: (N, m), by Pinocchio; NaN where there is no solution.
        complete: (N,), bool.
        method: as in :class:`IKBranches`.
    """

    q: Array
    counts: Any
    within_limits: Any
    position_error: Array
    rotation_error: Array
    complete: Any
    method: str
    _one: Any

    def __len__(self) -> int:
        return len(self.counts)

    @property
    def evidence(self) -> str:
        """How many poses have all their branches; what that rests on stands at each pose."""
        whole = int(np.sum(self.complete))
        return f"{whole} of {len(self)} poses with all their solutions, by {self.method}"

    def __getitem__(self, row: int) -> IKBranches:
        answer: IKBranches = self._one(range(len(self.counts))[row])
        return answer

    def __iter__(self) -> Iterator[IKBranches]:
        return (self[row] for row in range(len(self)))


class _Arm(NamedTuple):
    """What one call needs of a robot, kept for the next: joints solved for, limits, names."""

    known: Known
    joints: Any
    rest: Array
    limits: tuple[Array, Array, Array]
    words: tuple[str, ...]
    whole: bool


_ARMS: WeakKeyDictionary[Robot, dict[Any, _Arm]] = WeakKeyDictionary()


def ik_branches(
    robot: ArmLike,
    T: ArrayLike,
    *,
    given: Mapping[str | int, float] | None = None,
    samples: int = SAMPLES,
    threads: int | None = None,
) -> Any:
    """The joint positions at which the tool is at T, whether within limits or not.

    ``complete`` says whether they are all there are, and ``evidence`` what that rests on.
    Six joints, of any kind and order: the whole pose. Arms whose last (or first) three axes meet
    and arms with three parallel axes are solved in closed form, all others by following the 16
    or fewer complex solutions of a generic pose. Three joints: the position (planar arms: also
    the angle in the plane, two joints the point in it). Parallel axes with a slide (SCARA): the
    position and the angle. Five joints: the position and the direction of the tool's z axis,
    where the arm can hold these. Any other arm of fewer joints: the whole pose, which it meets
    only on its own way. Seven joints: with one ``given``, the solutions there; otherwise a sample.

    Args:
        robot: the robot.
        T: target of the tool in the base, (4, 4), or a stack (N, 4, 4).
        given: joints that are held, by name or index, at a value, rad or m.
        samples: values of the spare joint of a seven-joint arm, where none is given.
        threads: for a stack; left out, as many as there are processors.

    Returns:
        :class:`IKBranches`, or :class:`IKBranchesBatch` for a stack: the solutions, each
        measured by Pinocchio to 1e-9 m and rad; none where T is out of reach.

    Raises:
        StateError: T is not a rigid transform (a stack: names the row).
        StructureError: more joints than one pose fixes, or an arm no pose of which has a finite
            number of solutions.
        NameUnknownError: a given joint does not exist.
        OptionError: a value that is no finite number.
    """
    robot = as_robot(robot)
    if threads is not None:
        threads = whole(threads, "threads")
    held = () if given is None else _read_given(robot, given)
    T = T if isinstance(T, np.ndarray) else real_array(T, f"robot {robot.name!r}: T")
    if T.ndim not in (2, 3):
        shapes = "(4, 4) or (N, 4, 4)"
        raise StateError(f"robot {robot.name!r}: T has shape {T.shape}; expected {shapes}")
    if T.ndim == 3:
        targets = read_targets(robot, T)
        return _many(robot, held, targets, samples, threads)
    target = read_target(robot, T)
    if not held and len(chain(robot).prismatic) == 7:
        return _sampled(robot, target, whole(samples, "samples", 1))
    arm = _arm(robot, held)
    form, one = arm.known.form, target[:3].reshape(1, 12)
    found = Branches.empty(1, form.real)
    branch_rows(form, arm.limits, one, found, 0, 1)
    count = int(found.counts[0])
    errors = np.empty((count, 2))
    q = _full(arm, found.q[0, :count])
    _measure(robot, arm, q, found.goals, np.zeros(count, np.int64), errors)
    return _answer(
        robot, arm, q, found.codes[0, :count], errors, int(found.states[0]), found.goals[0]
    )


def _answer(
    robot: Robot, arm: _Arm, q: Array, codes: Any, errors: Array, state: int, goal: Array
) -> IKBranches:
    """One pose's answer from the kernel's arrays."""
    within = ((q >= robot.lower) & (q <= robot.upper)).all(axis=1)
    names = distinct([arm.words[code] for code in codes.tolist()])
    families: tuple[IKFamily, ...] = ()
    complete, why = state == 0, arm.known.evidence
    if len(errors) and errors.max() > TOLERANCE:
        keep = np.asarray(errors.max(axis=1) <= TOLERANCE)
        q, errors, complete = q[keep], errors[keep], False
        within = np.asarray(within)[keep]
        names = tuple(name for name, kept in zip(names, keep, strict=True) if kept)
        why = f"a solution of the compiled chain misses {TOLERANCE:g} by Pinocchio"
    elif state:
        # a closed form flags its singular branches itself; beside them there is no family
        if state != UNDECIDED or arm.known.form.family == GENERAL:
            families = families_at(robot, arm.known.form, arm.joints, q, goal)
        complete = state == DOUBLE and not families and len(q) > 0
        why = _doubts(state, families, why)
    return IKBranches(
        q,
        names,
        within,
        errors[:, 0],
        errors[:, 1],
        arm.known.method,
        complete and arm.whole,
        why,
        families,
    )


def _doubts(state: int, families: tuple[IKFamily, ...], evidence: str) -> str:
    if families:
        return f"infinitely many solutions: {'; '.join(f.text for f in families)}"
    if state & SLIPPED:
        return f"{evidence}; a path was lost, so that some may be missing"
    if state & UNDECIDED:
        return f"{evidence}; a candidate came within 1e-6 and could not be decided"
    if state == DOUBLE:
        return f"{evidence}; some branches run together in one solution"
    return f"{evidence}; a singular pose, at which some joint is free"


def _many(
    robot: Robot,
    held: tuple[tuple[int, float], ...],
    targets: Array,
    samples: int,
    threads: int | None,
) -> IKBranchesBatch:
    """A stack: solved on all processors, each range measured while others run."""
    if not held and len(chain(robot).prismatic) == 7:
        answers = [_sampled(robot, T, whole(samples, "samples", 1)) for T in targets]
        return _stacked(answers, robot.n)
    arm = _arm(robot, held)
    count = len(targets)
    flat = np.ascontiguousarray(targets[:, :3]).reshape(count, 12)
    errors = np.full((count, MOST, 2), np.nan)
    slots = np.arange(MOST)

    def verify(found: Branches, first: int, last: int) -> None:
        here = slots < found.counts[first:last, np.newaxis]
        row, slot = np.nonzero(here)
        row += first
        measured = np.empty((len(row), 2))
        _measure(robot, arm, _full(arm, found.q[row, slot]), found.goals, row, measured)
        errors[row, slot] = measured

    found = all_branches(arm.known.form, arm.limits, flat, threads, verify)
    most = int(found.counts.max(initial=0))
    here = slots[:most] < found.counts[:, np.newaxis]
    q = np.full((count, most, robot.n), np.nan)
    q[here] = _full(arm, found.q[:, :most][here])
    within = np.zeros((count, most), dtype=np.bool_)
    within[here] = ((q[here] >= robot.lower) & (q[here] <= robot.upper)).all(axis=1)
    complete = found.states == 0

    def one(row: int) -> IKBranches:
        number = int(found.counts[row])
        return _answer(
            robot,
            arm,
            q[row, :number].copy(),
            found.codes[row, :number],
            errors[row, :number].copy(),
            int(found.states[row]),
            found.goals[row],
        )

    bad = np.nanmax(errors, axis=(1, 2), initial=0.0) > TOLERANCE
    for row in np.flatnonzero(bad | (found.states == DOUBLE)):
        complete[row] = one(int(row)).complete
    return IKBranchesBatch(
        q,
        found.counts,
        within,
        errors[:, :most, 0],
        errors[:, :most, 1],
        complete & arm.whole,
        arm.known.method,
        one,
    )


def _stacked(answers: list[IKBranches], n: int) -> IKBranchesBatch:
    counts = np.array([len(a) for a in answers], dtype=np.int64)
    most = int(counts.max(initial=0))
    q = np.full((len(answers), most, n), np.nan)
    within = np.zeros((len(answers), most), dtype=np.bool_)
    errors = np.full((len(answers), most, 2), np.nan)
    for i, a in enumerate(answers):
        q[i, : len(a)], within[i, : len(a)] = a.q, a.within_limits
        errors[i, : len(a), 0], errors[i, : len(a), 1] = a.position_error, a.rotation_error
    complete = np.array([a.complete for a in answers], dtype=np.bool_)
    return IKBranchesBatch(
        q,
        counts,
        within,
        errors[..., 0],
        errors[..., 1],
        complete,
        answers[0].method if answers else "",
        answers.__getitem__,
    )


def _sampled(robot: Robot, target: Array, samples: int) -> IKBranches:
    """A selection of a seven-joint arm's solutions: its spare joint held at some values."""
    spare = _spare(robot)
    low = max(float(robot.lower[spare]), -np.pi)
    high = min(float(robot.upper[spare]), np.pi)
    parts = []
    values = low + (high - low) * (np.arange(samples) + 0.5) / samples
    for value in values:
        part = ik_branches(robot, target, given={spare: float(value)})
        label = f"{robot.joint_names[spare]} {value:+.4f}"
        names = [", ".join(filter(None, (label, name))) for name in part.names]
        parts.append(replace(part, names=tuple(names)))
    return IKBranches(
        np.vstack([p.q for p in parts]),
        tuple(name for p in parts for name in p.names),
        np.concatenate([p.within_limits for p in parts]),
        np.concatenate([p.position_error for p in parts]),
        np.concatenate([p.rotation_error for p in parts]),
        parts[0].method,
        False,
        f"{robot.joint_names[spare]} held at {samples} values; hold it with given= for all "
        "solutions at one value",
    )


def _spare(robot: Robot) -> int:
    """The joint of a seven-joint arm to hold: the last that leaves a closed form."""
    for joint in reversed(range(7)):
        try:
            if _arm(robot, ((joint, 0.3),)).known.form.family != GENERAL:
                return joint
        except StructureError:
            continue
    return 2


def _read_given(robot: Robot, given: Mapping[str | int, float]) -> tuple[tuple[int, float], ...]:
    held: dict[int, float] = {}
    names = robot.joint_names
    for key, value in given.items():
        if isinstance(key, str):
            if key not in names:
                raise NameUnknownError(
                    f"robot {robot.name!r}: joint {key!r} does not exist; {near(key, names)}"
                )
            joint = names.index(key)
        else:
            joint = whole(key, "a joint of given", 0)
            if joint >= robot.n:
                raise StateError(
                    f"robot {robot.name!r}: given names joint {joint}; it has 0 to {robot.n - 1}"
                )
        if joint in held:
            raise OptionError(
                f"robot {robot.name!r}: given names joint {names[joint]!r} twice, by its name and "
                f"by its index {joint}; give one"
            )
        held[joint] = number(value, f"given[{key!r}]")
    return tuple(sorted(held.items()))


def _arm(robot: Robot, held: tuple[tuple[int, float], ...]) -> _Arm:
    kept = _ARMS.get(robot)
    if kept is None:
        kept = _ARMS[robot] = {}
    found = kept.get(held)
    if found is None:
        if len(kept) > 64:
            kept.clear()
        moving = len(chain(robot).prismatic)
        known = known_form(robot, tuple(pair for pair in held if pair[0] < moving))
        values = dict(held)
        joints = np.array([i for i in range(moving) if i not in values], dtype=np.int64)
        rest = np.clip(0.0, robot.lower, robot.upper)
        for joint, value in held:
            rest[joint] = value
        lower, upper = robot.lower[joints], robot.upper[joints]
        free = robot.n - len(joints) - len(values)
        found = kept[held] = _Arm(
            known,
            None if len(joints) == robot.n else joints,
            rest,
            (lower, upper, np.clip(0.0, lower, upper)),
            words_of(known.form),
            free == 0 and known.sure,
        )
    return found


def _full(arm: _Arm, q: Array) -> Array:
    """Solutions with the joints that were held, (m, n)."""
    if arm.joints is None:
        return q
    answer = np.tile(arm.rest, (len(q), 1))
    answer[:, arm.joints] = q
    return answer


@kernel
def _misses(task, poses, rows, goals, errors):  # type: ignore[no-untyped-def]
    pose, r, e = np.empty(12), np.empty(9), np.empty(6)
    for i in range(rows.shape[0]):
        for j in range(12):
            pose[j] = poses[i, j // 4, j % 4]
        errors[i, 0], errors[i, 1] = miss(task, pose, goals[rows[i]], r, e)


def _measure(robot: Robot, arm: _Arm, q: Array, goals: Array, rows: Any, errors: Array) -> None:
    """Errors of q (m, n) at goals[rows], by Pinocchio; errors (m, 2) is written."""
    _misses(arm.known.form.task, tool_poses(robot, q), rows, goals, errors)
