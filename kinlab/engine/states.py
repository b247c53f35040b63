"""Joint vectors at the door: cheap on the good path, exact about what is wrong on the other."""

from __future__ import annotations

from typing import TypeVar

import numpy as np
from numpy.typing import ArrayLike

from kinlab.arrays import LARGEST, Array, real_array, sum_of_squares
from kinlab.errors import StateError, warn
from kinlab.model.robot import Robot

_FLOAT = np.dtype(np.float64)
Number = TypeVar("Number", Array, np.float64)


def plain(robot: Robot, *values: ArrayLike) -> bool:
    """Whether each value is one state (n,) in a float64 array, so that nothing needs converting.

    Says nothing about NaN: callers on the fast path look at the answer, one sum for all inputs
    together, and take the slow path to find the culprit.
    """
    shape = robot.shape
    for value in values:  # a loop, since all() over a generator costs more than the engine's call
        if type(value) is not np.ndarray or value.dtype is not _FLOAT or value.shape != shape:
            return False
    return True


def finite_answer(robot: Robot, answer: Number, what: str) -> Number:
    """Refuses an answer that overflowed, though every input was finite.

    Raises:
        StateError: NaN or infinity in the answer.
    """
    if not np.isfinite(answer).all():
        raise StateError(
            f"robot {robot.name!r}: {what} overflows; the joint vectors are finite but too large"
        )
    return answer


def joint_vector(robot: Robot, value: ArrayLike, name: str) -> Array:
    """Reads a joint vector (n,) or a stack of them (N, n); a stack comes back C-contiguous.

    Args:
        robot: whose joints.
        value: the numbers.
        name: what to call them in a message: ``"q"``, ``"v"``, ...

    Returns:
        float64 array of shape (n,) or (N, n); the caller's own object where it is sound.

    Raises:
        StateError: wrong length, not real numbers, NaN or infinity.
    """
    if type(value) is np.ndarray and value.dtype is _FLOAT:
        if value.shape == robot.shape:
            if -LARGEST < sum(value.tolist()) < LARGEST:  # a tenth of np.isfinite(value).all()
                return value
        elif value.ndim == 2 and value.shape[1] == robot.n and sum_of_squares(value) <= LARGEST:
            return _packed(value)
    array = real_array(value, f"robot {robot.name!r}: {name}")
    if array.ndim not in (1, 2) or array.shape[-1] != robot.n:
        raise StateError(
            f"robot {robot.name!r}: {name} has shape {array.shape}; "
            f"expected ({robot.n},) or (N, {robot.n})"
        )
    if name == "q" and isinstance(value, (list, tuple)):  # typed by somebody, not computed
        warn_far(robot, array)
    return _packed(array)


def warn_far(robot: Robot, q: Array, name: str = "q") -> None:
    """Asks whether degrees or millimetres were meant where q lies far outside the limits.

    Far is more than a turn beyond the limits of a revolute joint, and more than 1 m and ten times
    its stroke beyond those of a prismatic one. It is asked at the doors where people type q.

    Args:
        robot: whose joints.
        q: (n,) or (N, n), checked.
        name: what to call it.

    Warns:
        KinlabWarning: naming the first joint that is far outside.
    """
    if sum_of_squares(q) <= robot.near_square:  # no entry can be far outside
        return
    rows = np.atleast_2d(q)
    far = np.abs(rows - np.clip(rows, robot.lower, robot.upper)) > robot.slack
    if not far.any():
        return
    row, joint = (int(k) for k in np.argwhere(far)[0])
    value, kind = rows[row, joint], robot.joint_kinds[joint]
    turns = kind == "revolute"
    unit, meant = ("rad", "degrees") if turns else ("m", "millimetres")
    inside = np.radians(value) if turns else 1e-3 * value
    limits = f"{robot.lower[joint]:.4g} to {robot.upper[joint]:.4g}"
    warn(
        f"robot {robot.name!r}: {name} = {value:.6g} {unit} of joint {robot.joint_names[joint]!r} "
        f"is far outside its limits, {limits}: {meant}? "
        f"({value:.6g} {'deg' if turns else 'mm'} = {inside:.4g} {unit})"
    )


def joint_vectors(robot: Robot, **values: ArrayLike) -> tuple[Array, ...]:
    """Reads several joint vectors of one call and brings them to one leading length.

    A single vector beside stacks is repeated. The answers are all (n,), or all (N, n) with
    rows next to each other in memory, as the engine's batches need them.

    Raises:
        StateError: as :func:`joint_vector`, or stacks of different length.
    """
    arrays = [joint_vector(robot, value, name) for name, value in values.items()]
    lengths = {len(a) for a in arrays if a.ndim == 2}
    if not lengths:
        return tuple(arrays)
    if len(lengths) > 1:
        shapes = ", ".join(f"{k} {a.shape}" for k, a in zip(values, arrays, strict=True))
        raise StateError(f"robot {robot.name!r}: stacks of different length: {shapes}")
    shape = (lengths.pop(), robot.n)
    return tuple(_packed(np.broadcast_to(a, shape)) for a in arrays)


def _packed(array: Array) -> Array:
    """Rows next to each other and writeable, copied where they are not.

    The engine's batches need the first; kernels would be compiled anew for read-only arrays.
    """
    flags = array.flags
    if flags.c_contiguous and flags.writeable:  # asked here, since np.require takes 1 µs to see it
        return array
    packed: Array = np.require(array, requirements=["C", "W"])
    return packed
