"""What a caller of inverse kinematics may ask for, read and refused in one place."""

from __future__ import annotations

from functools import lru_cache
from typing import Any, NamedTuple

import numpy as np
from numpy.typing import ArrayLike

from kinlab.arrays import LARGEST, Array, number, real_array, rigid_transform, seed_of, whole
from kinlab.engine.fast.compiled import kernel
from kinlab.engine.states import warn_far
from kinlab.errors import StateError
from kinlab.model.robot import Robot
from kinlab.tolerances import TOLERANCES

_FLOAT = np.dtype(np.float64)

RESTARTS = 40
"""Searches after the first. Of 100,000 random poses on ten arms one needed more than 30; an
unreachable pose costs all of them."""


@kernel
def _sound(pose, miss):  # type: ignore[no-untyped-def]
    """Whether (4, 4) is a rigid transform; NaN fails every comparison."""
    for i in range(3):
        for j in range(i, 3):
            dot = pose[0, i] * pose[0, j] + pose[1, i] * pose[1, j] + pose[2, i] * pose[2, j]
            if not abs(dot - (1.0 if i == j else 0.0)) <= miss:
                return False
        if not abs(pose[i, 3]) < np.inf:
            return False
    det = (
        pose[0, 0] * (pose[1, 1] * pose[2, 2] - pose[1, 2] * pose[2, 1])
        - pose[0, 1] * (pose[1, 0] * pose[2, 2] - pose[1, 2] * pose[2, 0])
        + pose[0, 2] * (pose[1, 0] * pose[2, 1] - pose[1, 1] * pose[2, 0])
    )
    last = pose[3, 0] == 0.0 and pose[3, 1] == 0.0 and pose[3, 2] == 0.0 and pose[3, 3] == 1.0
    return last and det > 0.0


@kernel
def _first_unsound(poses, miss):  # type: ignore[no-untyped-def]
    """Index of the first of (N, 4, 4) that is no rigid transform; N where all are."""
    for row in range(poses.shape[0]):
        if not _sound(poses[row], miss):
            return row
    return poses.shape[0]


@kernel
def _within(q, lower, upper):  # type: ignore[no-untyped-def]
    """Whether (n,) is finite and within the limits; NaN fails every comparison."""
    for i in range(q.shape[0]):  # noqa: SIM110  (numba knows no all())
        if not (lower[i] <= q[i] <= upper[i] and abs(q[i]) < LARGEST):
            return False
    return True


class Request(NamedTuple):
    """What was asked of a search, read.

    Attributes:
        targets: (N, 4, 4). tolerances: metres, radians. seed: of the starts.
        searches: how many at most. iterations: of one search, or ``None``.
        start: q0, (n,) or (N, n), or ``None``. remarks: what was done to the input.
    """

    targets: Array
    tolerances: tuple[float, float]
    seed: int
    searches: int
    iterations: int | None
    start: Array | None
    remarks: tuple[str, ...]


def read_request(
    robot: Robot, poses: ArrayLike, many: bool, q0: ArrayLike | None, *options: Any
) -> Request:
    """Reads and checks the arguments that :func:`kinlab.ik` and ``ik_batch`` share.

    Args:
        robot: the robot.
        poses: one target, or where ``many`` is true a stack of them.
        many: see there.
        q0: as in those, or ``None``.
        options: tol_position, tol_rotation, seed, restarts, max_iterations.

    Raises:
        StateError, OptionError, StructureError: as those.
    """
    targets = read_targets(robot, poses) if many else read_target(robot, poses)[np.newaxis]
    try:
        read = _read_options(*options)
    except TypeError:  # no key: an array of one number
        read = _read_options.__wrapped__(*options)
    start: Array | None = None
    remarks: list[str] = []
    if q0 is not None:
        start, remarks = read_guess(robot, q0, len(targets) if many else None)
    return Request(targets, *read, start, tuple(remarks))


@lru_cache(maxsize=64, typed=True)
def _read_options(
    position: Any, rotation: Any, seed: Any, restarts: Any, iterations: Any
) -> tuple[tuple[float, float], int, int, int | None]:
    """What of a request is plain numbers; kept, since call after call gives the same ones."""
    tolerances = (
        number(position, "tol_position", above=0.0),
        number(rotation, "tol_rotation", above=0.0),
    )
    most = None if iterations is None else whole(iterations, "max_iterations", 1)
    return tolerances, seed_of(seed), 1 + whole(restarts, "restarts", 0), most


def read_target(robot: Robot, pose: ArrayLike) -> Array:
    """A copy of one rigid transform, (4, 4).

    Raises:
        StateError: not 4x4, not finite, not orthonormal (says by how much), or a mirror.
    """
    if type(pose) is np.ndarray and pose.shape == (4, 4) and pose.dtype.kind == "f":
        copy = np.array(pose, dtype=np.float64, order="C")
        if _sound(copy, TOLERANCES.orthonormal):
            return copy
    where = f"robot {robot.name!r}: T"
    checked = real_array(pose, where)
    if checked.ndim <= 2:
        checked = rigid_transform(checked, where)
    if checked.shape != (4, 4):
        raise StateError(f"{where}: shape {checked.shape}; expected (4, 4); for many use ik_batch")
    return np.array(checked, order="C")


def read_targets(robot: Robot, poses: ArrayLike) -> Array:
    """A copy of a stack of rigid transforms, (N, 4, 4).

    Raises:
        StateError: as :func:`read_target`, naming the first bad pose.
    """
    where = f"robot {robot.name!r}: Ts"
    array = real_array(poses, where) if not isinstance(poses, np.ndarray) else poses
    if array.ndim != 3 or array.shape[1:] != (4, 4):
        raise StateError(f"{where}: shape {array.shape}; expected (N, 4, 4)")
    real_array(array, where)
    copy = np.array(array, dtype=np.float64, order="C")
    bad = int(_first_unsound(copy, TOLERANCES.orthonormal))
    if bad < len(copy):
        rigid_transform(copy[bad], f"{where}[{bad}]")
    return copy


def read_guess(robot: Robot, guess: ArrayLike, rows: int | None = None) -> tuple[Array, list[str]]:
    """A copy of q0, put back onto the limits where it breaks them, and a remark on that.

    Args:
        robot: the robot.
        guess: (n,), or where ``rows`` is given also (rows, n).
        rows: how many poses there are.

    Raises:
        StateError: another shape, not finite.
    """
    if type(guess) is np.ndarray and guess.dtype is _FLOAT and guess.shape == robot.shape:
        copy = guess.copy()
        if _within(copy, robot.lower, robot.upper):
            return copy, []
    q0 = np.array(real_array(guess, f"robot {robot.name!r}: q0"), order="C")
    shapes = [(robot.n,)] if rows is None else [(robot.n,), (rows, robot.n)]
    if q0.shape not in shapes:
        wanted = " or ".join(map(str, shapes))
        raise StateError(f"robot {robot.name!r}: q0 has shape {q0.shape}; expected {wanted}")
    outside = np.atleast_2d((q0 < robot.lower) | (q0 > robot.upper)).any(axis=0)
    if not outside.any():
        return q0, []
    warn_far(robot, q0, "q0")
    names = ", ".join(repr(robot.joint_names[i]) for i in np.flatnonzero(outside))
    remark = f"q0 is outside the limits of {names}; started on the limit instead"
    return np.clip(q0, robot.lower, robot.upper), [remark]
