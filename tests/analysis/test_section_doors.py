"""Arguments of the section, the nearest singularity, loading and the table doctor, at the door."""

from __future__ import annotations

import numpy as np
import pytest

import kinlab as kl
from kinlab.errors import NameUnknownError, OptionError, StructureError

ARM = kl.load("stanford")


@pytest.mark.parametrize("step", [0.0, -1.0, np.nan, "0.1", None, [0.1, 0.2], 5e-324])
def test_a_step_of_a_section_is_a_number_of_use(step):
    with pytest.raises(OptionError, match="step"):
        kl.workspace_section(ARM, step=step)


@pytest.mark.parametrize("seed", [-1, 1.5, "1", None, np.nan, [1]])
def test_a_seed_is_a_whole_number(seed):
    with pytest.raises(OptionError, match="seed"):
        kl.workspace_section(ARM, seed=seed)
    with pytest.raises(OptionError, match="seed"):
        kl.nearest_singularity(ARM, np.zeros(6), seed=seed)
    with pytest.raises(OptionError, match="seed"):
        kl.diagnose_table("planar2r", "planar2r", seed=seed)


def test_what_is_no_robot_has_no_section():
    with pytest.raises(StructureError, match="give a Robot"):
        kl.workspace_section(3.0)


@pytest.mark.parametrize("name", ["x" * 5000, "a\0b", "\ud800"])
def test_a_name_that_can_be_no_path_is_unknown(name):
    with pytest.raises(NameUnknownError, match="is unknown") as problem:
        kl.load(name)
    assert "x" * 100 not in str(problem.value)


@pytest.mark.parametrize("tool", [np.arange(3), 5, b"tool", ["tool"]])
def test_a_tool_is_a_name(tool):
    with pytest.raises(NameUnknownError, match="tool"):
        kl.load("planar2r", tool)
