"""Task names and masks become rows, and an arm is told which of them it can have."""

import numpy as np
import pytest

from kinlab.analysis.structure import tasks
from kinlab.errors import KinlabError, NameUnknownError, OptionError

RNG = np.random.default_rng(0)


def planar(n: int) -> np.ndarray:
    stack = np.zeros((5, 6, n))
    stack[:, [0, 1, 5]] = RNG.normal(size=(5, 3, n))
    return stack


@pytest.mark.parametrize(
    ("task", "rows"),
    [
        ("pose", (0, 1, 2, 3, 4, 5)),
        ("xytheta", (0, 1, 5)),
        ([1, 1, 0, 0, 0, 1], (0, 1, 5)),
        (np.array([False, False, True, True, False, False]), (2, 3)),
    ],
)
def test_rows(task, rows):
    assert tasks.task_rows(task) == rows


@pytest.mark.parametrize(
    ("task", "error", "said"),
    [
        ("positon", NameUnknownError, "'position'"),
        ("", NameUnknownError, "'xytheta'"),
        ([True] * 5, OptionError, "shape (6,)"),
        (None, OptionError, "mask of six"),
        ([0] * 6, OptionError, "asks for nothing"),
        ([0, 1, 2, 0, 0, 0], OptionError, "other than true"),
        ([0, 1, np.nan, 0, 0, 0], OptionError, "other than true"),
        ([[1], [1, 2]], OptionError, "not a mask"),
    ],
)
def test_bad_tasks_are_named(task, error, said):
    with pytest.raises(error) as caught:
        tasks.task_rows(task)
    assert said in str(caught.value)
    assert isinstance(caught.value, KinlabError)


def test_suggestions():
    assert tasks.suggest(planar(2)) == "'xy'"
    assert tasks.suggest(planar(4)) == "'xytheta'"
    assert tasks.suggest(RNG.normal(size=(3, 6, 7))) == "'pose'"
    assert tasks.suggest(RNG.normal(size=(3, 6, 5))) == "'position'"
    slide = np.zeros((2, 6, 1))
    slide[:, 2] = 1.0
    assert tasks.suggest(slide) == "(False, False, True, False, False, False)"


def test_a_task_the_arm_cannot_have():
    tasks.require_task(tasks.TASKS["xy"], planar(2), "robot 'p'")
    with pytest.raises(OptionError, match=r"'xytheta' asks for 3 .* 2 joints.*'xy'"):
        tasks.require_task(tasks.TASKS["xytheta"], planar(2), "robot 'p'")
    with pytest.raises(OptionError, match=r"never moves in z\); use task 'xytheta'"):
        tasks.require_task(tasks.TASKS["position"], planar(3), "robot 'p'")
