"""Broken meshes: a page is written all the same, with the mesh drawn or named."""

from __future__ import annotations

import fuzz_pool
import mesh_cases


def test_meshes():
    cases = mesh_cases.cases(fuzz_pool.SEED + 50, fuzz_pool.count(30))
    fuzz_pool.demand("mesh_cases:judge", cases)
