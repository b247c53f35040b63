"""Jerk-limited motions from point to point by ruckig (the optional extra ``motion``).

Source: Berscheid and Kröger, *Jerk-limited Real-time Trajectory Generation with Arbitrary Target
States*, RSS 2021. Ruckig plans; the curve is put together here from the jerks and times of its
profiles, so that what the answer holds does not rest on its sampling.
"""

from __future__ import annotations

from typing import Any

import numpy as np
from scipy.interpolate import PPoly

from kinlab.arrays import Array
from kinlab.errors import MissingExtraError, OptionError
from kinlab.motion.limits import Limits, within_time_limits
from kinlab.motion.record import along_lines


def plan(rows: Array, limits: Limits) -> Any:
    """The curve through points (K, n), at rest in each, all joints in proportion.

    Raises:
        MissingExtraError: ruckig is not installed. OptionError: it finds no motion.
    """
    try:
        import ruckig
    except ImportError:
        raise MissingExtraError(
            "jerk-limited motions need ruckig: install it with pip install 'kinlab[motion]'"
        ) from None

    def law(line: Array) -> Any:
        # from 0 to 1: one freedom, so that all joints keep in proportion
        displacement = np.abs(line)
        moves = displacement > 0.0
        asked = ruckig.InputParameter(1)
        asked.current_position, asked.target_position = [0.0], [1.0]
        for name in ("velocity", "acceleration", "jerk"):
            bound = float(np.min(getattr(limits, name)[moves] / displacement[moves]))
            setattr(asked, f"max_{name}", [bound])
        found = ruckig.Trajectory(1)
        status = ruckig.Ruckig(1).calculate(asked, found)
        if status not in (ruckig.Result.Working, ruckig.Result.Finished):
            raise OptionError(f"jerk-limited motion: ruckig finds none ({status})")
        profile = found.profiles[0][0]
        lengths, jerks = np.array(profile.t), np.array(profile.j)
        kept = lengths > 1e-12 * found.duration
        state = np.zeros(3)  # position, speed, acceleration along the line
        rows_here = []
        for length, jerk in zip(lengths[kept], jerks[kept], strict=True):
            s, speed, gain = state
            rows_here.append([jerk / 6.0, 0.5 * gain, speed, s])
            state = np.array(
                [
                    s + length * (speed + length * (0.5 * gain + length * jerk / 6.0)),
                    speed + length * (gain + 0.5 * length * jerk),
                    gain + length * jerk,
                ]
            )
        if abs(state[0] - 1.0) > 1e-6:
            raise OptionError("jerk-limited motion: ruckig's profile does not end at its target")
        return PPoly(np.array(rows_here).T, np.concatenate([[0.0], np.cumsum(lengths[kept])]))

    return within_time_limits(along_lines(rows, law), limits)
