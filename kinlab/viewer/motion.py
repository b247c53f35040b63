"""A motion for the page: joint positions at given times, with straight lines between them."""

from __future__ import annotations

from typing import Any

import numpy as np
from numpy.typing import ArrayLike

from kinlab.arrays import Array, real_array
from kinlab.errors import OptionError, StateError


def motion_json(q: Array, duration: float | ArrayLike, name: str) -> dict[str, Any]:
    """Checks a motion and gives it as plain values.

    Args:
        q: joint positions, (N, n), N at least 2.
        duration: seconds for the whole motion at even steps, or the times themselves, (N,).
        name: heading in the page.

    Raises:
        StateError: fewer than two rows.
        OptionError: a duration that is not positive, or times that do not grow.
    """
    if q.ndim != 2 or len(q) < 2:
        raise StateError(f"motion {name!r}: q has shape {q.shape}; expected (N, n), N at least 2")
    times = real_array(duration, f"motion {name!r}: duration", OptionError)
    if times.ndim == 0:
        if times <= 0:
            raise OptionError(f"motion {name!r}: duration is {times:g} s; it must be positive")
        times = np.linspace(0.0, float(times), len(q))
    if times.shape != (len(q),) or np.any(np.diff(times) <= 0):
        raise OptionError(f"motion {name!r}: give {len(q)} times that grow, one for each row of q")
    return {"name": name, "times": (times - times[0]).tolist(), "q": q.tolist()}
