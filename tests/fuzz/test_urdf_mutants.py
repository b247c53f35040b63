"""Mutated URDFs: refused, or read as an own reading of the XML reads them."""

from __future__ import annotations

import fuzz_pool
import urdf_mutate
from hypothesis import given, settings
from hypothesis import strategies as st


def test_no_mutant_is_read_otherwise_than_it_is_written():
    cases = urdf_mutate.mutants(fuzz_pool.SEED + 1, fuzz_pool.count(400))
    found = fuzz_pool.demand("urdf_judge:judge", cases)
    assert found["right"] > len(cases) / 20 and found["refused"] > len(cases) / 20


@settings(max_examples=fuzz_pool.count(200))
@given(st.integers(0, 2**32 - 1))
def test_any_mutant(seed):
    [(label, (text, tool, _))] = urdf_mutate.mutants(fuzz_pool.seeded(seed), 1)
    fuzz_pool.demand_one("urdf_judge:judge", label, (text, tool, seed))


def test_other_spellings_of_sound_numbers_are_read():
    cases = urdf_mutate.benign(fuzz_pool.SEED + 2, fuzz_pool.count(25))
    fuzz_pool.demand("urdf_judge:judge", cases, (*fuzz_pool.BAD, "refused"))


def test_check_of_a_mutant_ends_without_a_traceback():
    cases = urdf_mutate.mutants(fuzz_pool.SEED + 3, fuzz_pool.count(14))
    fuzz_pool.demand("urdf_judge:judge_check", cases)


def _two(old: str, new: str) -> str:
    assert old in urdf_mutate.TWO_LINK
    return urdf_mutate.TWO_LINK.replace(old, new, 1)


KNOWN = {
    "a product of inertia missing": _two('ixy="0.001" ', ""),
    "mass ' 3 '": _two('value="3"', 'value=" 3 "'),
    "mass 5_0": _two('value="3"', 'value="5_0"'),
    "mass of Arabic digits": _two('value="3"', 'value="٥"'),
    "mass after a no-break space": _two('value="3"', 'value="\u00a03"'),
    "com with a no-break space": _two('xyz="0.3 0.02 -0.01"', 'xyz="0.3\u00a00.02 -0.01"'),
    "inertial origin 5_0": _two('xyz="0.3 0.02 -0.01"', 'xyz="5_0 0.02 -0.01"'),
    "axis without xyz": _two('<axis xyz="0 0 1"/>', "<axis/>"),
    "axis misspelt": _two('<axis xyz="0 0 1"/>', '<axis xzy="0 0 1"/>'),
    "axis 1e200": _two('<axis xyz="0 0 1"/>', '<axis xyz="0 0 1e200"/>'),
    "axis 1e-200": _two('<axis xyz="0 0 1"/>', '<axis xyz="0 0 1e-200"/>'),
    "a joint named like a link": _two('name="shoulder"', 'name="upper"'),
    "a joint named like the tool": _two('name="elbow"', 'name="hand"'),
}


def test_known():
    fuzz_pool.demand("urdf_judge:judge", [(what, (KNOWN[what], None, 0)) for what in KNOWN])


DRAWN = {
    "empty geometry": _two('<link name="hand"/>', '<link name="hand"><visual><geometry/></visual></link>'),
    "rgba of letters": _two(
        '<link name="hand"/>',
        '<link name="hand"><visual><geometry><sphere radius="1"/></geometry>'
        '<material name="m"><color rgba="a"/></material></visual></link>',
    ),
    "braces in a name": _two('name="hand"', 'name="{x}"').replace('link="hand"', 'link="{x}"'),
    "markup in a name": _two('name="hand"', 'name="[/bold]"').replace('link="hand"', 'link="[/bold]"'),
}  # fmt: skip


def test_check_of_known():
    fuzz_pool.demand("urdf_judge:judge_check", [(what, (DRAWN[what], None, 0)) for what in DRAWN])
