"""Command lines over hostile names, files and words: an exit code and clean text, never a traceback."""

from __future__ import annotations

import random

import cli_cases
import fuzz_pool

KNOWN = [
    ({"arm.toml": cli_cases.TABLE.format(name='"[/bold]"', source='"x"', tool='"tip"', joint='"j"')}, ["info", "arm.toml"], "[/bold]"),
    ({"arm.toml": cli_cases.TABLE.format(name='"arm"', source='"[left] hand"', tool='"tip"', joint='"j"')}, ["info", "arm.toml"], "[left] hand"),
    ({"arm.urdf": cli_cases.URDF.format(name='"[left]"', link='"l"', tool='"[/bold]"', joint='"[left]"')}, ["info", "arm.urdf"], "[left]"),
    ({"arm.urdf": cli_cases.URDF.format(name='"a"', link='"l"', tool='"[/bold]"', joint='"[left]"')}, ["check", "arm.urdf"], None),
    ({"arm.toml": cli_cases.TABLE.format(name='"arm"', source=r'"\u001b[31mred\u001b]0;x\u0007"', tool='"tip"', joint='"j"')}, ["info", "arm.toml"], None),
    ({"f.py": cli_cases.PYTHON.format(source='"[/bold] \\x1b[31m"', latex='"x"')}, ["check", "f.py"], None),
]  # fmt: skip


def test_known():
    fuzz_pool.demand("cli_cases:judge", [(f"{c[1]} {c[2]}", c) for c in KNOWN])


def test_names():
    fuzz_pool.demand("cli_cases:judge", cli_cases.named(fuzz_pool.SEED + 40, fuzz_pool.count(16)))


def test_paths():
    cases = cli_cases.paths()
    random.Random(fuzz_pool.SEED + 41).shuffle(cases)
    fuzz_pool.demand("cli_cases:judge", cases[: fuzz_pool.count(24)], seconds=15)


def test_random_lines():
    cases = cli_cases.random_lines(fuzz_pool.SEED + 42, fuzz_pool.count(20))
    fuzz_pool.demand("cli_cases:judge", cases, seconds=60)
