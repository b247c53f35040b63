"""Joint vectors at the door: cheap on the good path, exact about what is wrong on the other."""

from __future__ import annotations

from typing import TypeVar

import numpy as np
from numpy.typing import ArrayLike

from kinlab.arrays import LARGEST, Array, real_array
from kinlab.errors import StateError
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
    if (
        type(value) is np.ndarray
        and value.dtype is _FLOAT
        and value.shape == robot.shape
        and -LARGEST < sum(value.tolist()) < LARGEST  # a tenth of np.isfinite(value).all()
    ):
        return value
    array = real_array(value, f"robot {robot.name!r}: {name}")
    if array.ndim not in (1, 2) or array.shape[-1] != robot.n:
        raise StateError(
            f"robot {robot.name!r}: {name} has shape {array.shape}; "
            f"expected ({robot.n},) or (N, {robot.n})"
        )
    return _packed(array)


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
    packed: Array = np.require(array, requirements=["C", "W"])
    return packed
