"""DH tables with numbers in every spelling: refused, or read as an own DH product reads them."""

from __future__ import annotations

import fuzz_pool
import table_cases
from hypothesis import given, settings
from hypothesis import strategies as st


def test_numbers_are_read_as_written_or_refused():
    cases = table_cases.numbers(fuzz_pool.SEED + 10, fuzz_pool.count(150))
    found = fuzz_pool.demand("table_cases:judge", cases)
    assert found["right"] > len(cases) / 4


@settings(max_examples=fuzz_pool.count(100))
@given(st.integers(0, 2**32 - 1))
def test_any_table(seed):
    [(label, case)] = table_cases.numbers(fuzz_pool.seeded(seed), 1)
    fuzz_pool.demand_one("table_cases:judge", label, case)


def test_every_hostile_spelling_once():
    cases = []
    for _i, (text, value) in enumerate(table_cases.HOSTILE):
        toml = (
            'name = "t"\nconvention = "standard"\n[[links]]\njoint = "revolute"\na = '
            + table_cases.toml_text(text)
            + "\nalpha = 0\nd = 0\ntheta = 0\nmass = 1\ninertia = { ixx = 1, iyy = 1, izz = 1 }\n"
            "lower = -1\n"
        )
        link = {"joint": "revolute", "a": value, "alpha": 0, "d": 0, "theta": 0, "mass": 1,
                "com": [0, 0, 0], "inertia": [1, 1, 1], "armature": 0, "lower": -1}  # fmt: skip
        table = {"convention": "standard", "links": [link], "gravity": [0, 0, -9.81]}
        cases.append((f"a = {text[:40]!r}", (".toml", toml, None if value is None else table)))
    fuzz_pool.demand("table_cases:judge", cases)


def test_structure_is_refused_in_words():
    fuzz_pool.demand("table_cases:judge", table_cases.structures(fuzz_pool.SEED + 11))
