"""Every public function with hostile arguments: the clean answer, a finite one, or a KinlabError."""

from __future__ import annotations

import inspect

import api_cases
import fuzz_pool

import kinlab as kl


def test_clean_calls_work():
    names = [n for n in api_cases.CALLS if fuzz_pool.LONG or n not in api_cases.HEAVY]
    fuzz_pool.demand("api_cases:judge_clean", [(name, name) for name in names], seconds=120)


def test_every_public_function_is_attacked():
    attacked = {function for function, _ in api_cases.CALLS.values()}
    left = {"Comparison", "Convention", "KinlabError", "Robot", "SweepResult", "WorkspaceMap",
            "__version__", "errors", "hand_formula", "view", "viewer"}  # fmt: skip
    rooms = {name for name in kl.__all__ if inspect.ismodule(getattr(kl, name))}
    assert set(kl.__all__) - attacked - rooms <= left


def test_hostile_arguments():
    cases = api_cases.cases(fuzz_pool.SEED + 30, fuzz_pool.count(250))
    found = fuzz_pool.demand("api_cases:judge", cases, seconds=180)  # a cold cache compiles first
    assert found["right"] + found["refused"] == len(cases)
