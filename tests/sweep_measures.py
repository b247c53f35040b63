"""Measures that worker processes can import."""

from __future__ import annotations

import os
import signal
import time
from pathlib import Path

import numpy as np

import kinlab as kl


def reach(robot, q):
    """Distance of the tool from the base, and the sum of q squared, as two columns."""
    return {"reach": np.linalg.norm(kl.fk(robot, q)[:, :3, 3], axis=1), "square": (q**2).sum(1)}


def total(robot, q):
    """One plain array."""
    return q.sum(axis=1)


def wide(_, q):
    """A hundred numbers a state, and one."""
    return {"rows": np.repeat(q, 100, axis=1), "value": q[:, 0]}


def design_volume(design, x):
    """For subjects that are no robots."""
    return x.prod(axis=1) * design


def dies_once(flag, q):
    """Kills its own worker process the first time it is called by anyone."""
    try:
        Path(flag[0]).touch(exist_ok=False)
    except FileExistsError:
        return q.sum(axis=1)
    os.kill(os.getpid(), signal.SIGKILL)
    return None


def dies_always(_, q):
    """Kills its own worker process."""
    os.kill(os.getpid(), signal.SIGKILL)


def slow(_, q):
    """Takes long enough for a test to stop the sweep in the middle."""
    time.sleep(0.15)
    return q.sum(axis=1)


def raises(_, q):
    """Fails like a wrong formula does."""
    raise ZeroDivisionError("in the measure")


def raises_late(_, q):
    """A long block fails after a second, a short one at once."""
    time.sleep(len(q) // 4096)
    raise ZeroDivisionError(f"block of {len(q)}")
