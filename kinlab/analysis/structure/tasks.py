"""Task spaces: which of the six coordinates of the tool are asked for.

Rows are linear first, as in every twist here: 0, 1, 2 are x, y, z and 3, 4, 5 the rotations
about the base's x, y, z. A task is a name of :data:`TASKS` or a mask of six booleans.
"""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any

import numpy as np
from numpy.typing import ArrayLike

from kinlab.arrays import Array, shown
from kinlab.errors import NameUnknownError, OptionError, near
from kinlab.tolerances import TOLERANCES

TASKS: dict[str, tuple[int, ...]] = {
    "pose": (0, 1, 2, 3, 4, 5),
    "position": (0, 1, 2),
    "orientation": (3, 4, 5),
    "xy": (0, 1),
    "xytheta": (0, 1, 5),
}
"""Name to rows. ``xy`` and ``xytheta`` are those of an arm in the base's x-y plane."""

COORDINATES = ("x", "y", "z", "rotation about x", "rotation about y", "rotation about z")
"""What each row is called in messages."""


def task_rows(task: Any) -> tuple[int, ...]:
    """Row indices of a task.

    Args:
        task: a name of :data:`TASKS`, or a mask of six booleans (or zeros and ones).

    Returns:
        Indices into the six rows, ascending.

    Raises:
        NameUnknownError: no task of that name; the valid ones are listed.
        OptionError: a mask of another length, of other values, or with nothing in it.
    """
    if isinstance(task, str):
        try:
            return TASKS[task]
        except KeyError:
            raise NameUnknownError(
                f"task {task!r} is unknown; {near(task, TASKS)} Or give a mask of six booleans."
            ) from None
    choice = f"give one of {', '.join(map(repr, TASKS))}, or a mask of six booleans"
    try:
        mask = np.asarray(task)
    except Exception:  # noqa: BLE001  whatever an object's own __array__ raises
        raise OptionError(f"task {shown(task)}: not a mask; {choice}") from None
    if mask.shape != (6,):
        which = f"task {shown(task)}: a mask of shape {mask.shape}"
        raise OptionError(f"{which}; {choice} (shape (6,))")
    if mask.dtype.kind not in "biuf" or not np.isin(mask, (0, 1)).all():
        raise OptionError(f"task {shown(task)}: entries other than true and false; {choice}")
    rows = tuple(int(i) for i in np.flatnonzero(mask))
    if not rows:
        raise OptionError(f"task {shown(task)}: the mask asks for nothing; {choice}")
    return rows


def task_name(rows: Sequence[int]) -> str:
    """What to call these rows in a message: the task's name, or its coordinates."""
    for name, members in TASKS.items():
        if members == tuple(rows):
            return repr(name)
    return "(" + ", ".join(COORDINATES[i] for i in rows) + ")"


def generic_rank(jacobians: ArrayLike, rows: Sequence[int]) -> int:
    """How many of the rows an arm can move independently: the best rank over a sample.

    Args:
        jacobians: (N, 6, n), ``frame="base"``, at states in general position.
        rows: which rows.

    Returns:
        The largest rank found, by singular values.
    """
    values = np.linalg.svd(_stack(jacobians)[:, list(rows), :], compute_uv=False)
    floor = TOLERANCES.never_moves * values[:, :1]
    return int(((values > floor) & (values > 0.0)).sum(axis=1).max(initial=0))


def suggest(jacobians: ArrayLike) -> str:
    """The largest named task that an arm can do, judged from a sample of its Jacobians.

    Args:
        jacobians: (N, 6, n), ``frame="base"``, at states in general position.

    Returns:
        A name of :data:`TASKS`, or, where no name fits, the mask as text.
    """
    stack = _stack(jacobians)
    for name in ("pose", "position", "xytheta", "xy", "orientation"):
        if generic_rank(stack, TASKS[name]) == len(TASKS[name]):
            return repr(name)
    mask = [False] * 6
    for i in range(6):  # greedy: a row is taken where it can move beside those taken before
        rows = [k for k in range(6) if mask[k]] + [i]
        mask[i] = generic_rank(stack, rows) == len(rows)
    return str(tuple(mask))


def require_task(rows: Sequence[int], jacobians: ArrayLike, where: str) -> None:
    """Refuses a task with coordinates that the arm cannot move independently.

    Args:
        rows: the task's rows.
        jacobians: (N, 6, n), ``frame="base"``, at states in general position.
        where: put in front of the message, such as ``"robot 'planar2r'"``.

    Raises:
        OptionError: naming the coordinates that never move, and a task that fits.
    """
    stack = _stack(jacobians)
    rank = generic_rank(stack, rows)
    if rank == len(rows):
        return
    largest = np.abs(stack).max(axis=(0, 2), initial=0.0)
    still = [COORDINATES[i] for i in rows if largest[i] <= TOLERANCES.never_moves * largest.max()]
    why = f"it never moves in {', '.join(still)}" if still else f"it has {stack.shape[2]} joints"
    raise OptionError(
        f"{where}: task {task_name(rows)} asks for {len(rows)} coordinates, the arm can move "
        f"{rank} of them independently ({why}); use task {suggest(stack)}"
    )


def _stack(jacobians: ArrayLike) -> Array:
    array = np.asarray(jacobians, dtype=np.float64)
    return array[np.newaxis] if array.ndim == 2 else array
