"""What stands around a formula in people's files, in front of it, behind it and about it.

The formula is the mass matrix of two links with a lost sign in one line. Whatever keeps its numbers
and whatever it is wrapped in, the answer is that line.
"""

from __future__ import annotations

import importlib.util
import sys
import textwrap

import pytest

import kinlab as kl

ARM = """
import numpy as np
import kinlab as kl

links = [kl.DHLink(a=0.53, mass=2.1, com=(-0.25, 0, 0), inertia=np.diag([0, 0.05, 0.05])),
         kl.DHLink(a=0.41, mass=1.3, com=(-0.2, 0, 0), inertia=np.diag([0, 0.023, 0.023]))]
arm = kl.DHTable(name="mine", convention="standard", links=links)
"""
NAMES = "l1, l2, m1, m2, lc1, lc2, I1, I2"
NUMBERS = "0.53, 0.41, 2.1, 1.3, 0.28, 0.21, 0.05, 0.023"
FORMULA = """\
h = l1*lc2*np.cos(q[1])
a = I1 + m1*lc1**2 + I2 + m2*(l1**2 + lc2**2 + 2*h)
b = I2 + m2*(lc2**2 - h)
return np.array([[a, b], [b, I2 + m2*lc2**2]])
"""
TOLD = "the sign is wrong: `b = I2 + m2*(lc2**2 - h)` should be `b = I2 + m2*(lc2**2 + h)`"
FIELDS = "l: float\n    m: float\n    lc: float\n    I: float"
BY_LINK = "(l1, m1, lc1, I1), (l2, m2, lc2, I2) = ((x.l, x.m, x.lc, x.I) for x in (A, B))"
MADE = "A, B = Link(0.53, 2.1, 0.28, 0.05), Link(0.41, 1.3, 0.21, 0.023)"
EACH = "; ".join(f"{name} = p.{name}" for name in NAMES.split(", "))
EQUAL = ", ".join(map("=".join, zip(NAMES.split(", "), NUMBERS.split(", "), strict=True)))

KEPT = {
    "the arm, its engine": ("robot = kl.Robot.from_dh(arm)\nmodel = robot.model", ""),
    "slots": (
        "class P:\n    __slots__ = ('v', 'unset')\n    def __init__(self, v): self.v = v\n"
        f"p = P([{NUMBERS}])",
        f"{NAMES} = p.v",
    ),
    "a dataclass with slots": (
        f"from dataclasses import dataclass\n@dataclass(slots=True)\nclass Link:\n    {FIELDS}\n{MADE}",
        BY_LINK,
    ),
    "a frozen dataclass": (
        "from dataclasses import dataclass\n@dataclass(frozen=True, slots=True)\n"
        f"class Link:\n    {FIELDS}\n{MADE}",
        BY_LINK,
    ),
    "fields with factories": (
        "from dataclasses import dataclass, field\n@dataclass(frozen=True)\nclass P:\n"
        "    l: tuple = (0.53, 0.41)\n"
        "    m: np.ndarray = field(default_factory=lambda: np.array([2.1, 1.3]))\n"
        "    lc: np.ndarray = None\n    I: tuple = field(default=(0.05, 0.023))\n"
        "    def __post_init__(self):\n"
        "        object.__setattr__(self, 'lc', np.array([0.28, 0.21]))\np = P()",
        "(l1, l2), (m1, m2), (lc1, lc2), (I1, I2) = p.l, p.m, p.lc, p.I",
    ),
    "records": (
        f"from typing import NamedTuple\nclass Link(NamedTuple):\n    {FIELDS}\n{MADE}",
        "(l1, m1, lc1, I1), (l2, m2, lc2, I2) = A, B",
    ),
    "an enumeration": (
        "from enum import Enum\nclass P(Enum):\n    "
        + "\n    ".join(EQUAL.replace("=", " = ").split(", ")),
        EACH.replace("p.", "P.").replace(";", ".value;") + ".value",
    ),
    "options": (
        "import argparse\np = argparse.Namespace(" + EQUAL + ")",
        EACH,
    ),
    "attributes that are looked up": (
        f"class P:\n    def __getattr__(self, name):\n        return dict({EQUAL})[name]\np = P()",
        EACH,
    ),
    "an object that is not to be written to": (
        "class P:\n    def __init__(self, **given): self.__dict__.update(given)\n"
        f"    def __setattr__(self, name, value): raise AttributeError\np = P({EQUAL})",
        EACH,
    ),
    "an array that is not to be written to": (
        f"A = np.array([{NUMBERS}])\nA.setflags(write=False)",
        f"{NAMES} = A",
    ),
    "an array with named fields": (
        "A = np.array([(0.53, 2.1, 0.28, 0.05), (0.41, 1.3, 0.21, 0.023)],\n"
        "             dtype=[(k, float) for k in ('l', 'm', 'lc', 'I')])",
        "(l1, l2), (m1, m2), (lc1, lc2), (I1, I2) = (A[k] for k in ('l', 'm', 'lc', 'I'))",
    ),
    "the arm itself": (
        "robot = kl.Robot.from_dh(arm)",
        "m1, m2 = robot.table.links[0].mass, links[1].mass; l1 = arm.links[0].a",
    ),
    "names of the module": (f"{NAMES} = {NUMBERS}", "global l1, m1"),
    "the matrix exponential": ("from scipy.linalg import expm", "expm(np.zeros((2, 2)))"),
    "a logger": ("import logging\nlog = logging.getLogger('hand')", "log.info('q = %s', q)"),
    "an object that makes its arm": (
        f"class P:\n    def __init__(self):\n        {NAMES.replace(', ', ', self.').replace('l1', 'self.l1', 1)} = {NUMBERS}\n"
        "        self.arm = kl.DHTable(name='own', convention='standard', links=links)\n"
        "    def show(self):\n        import matplotlib.pyplot as plt\n        plt.show()\np = P()",
        EACH,
    ),
    "a class that has the numbers": (
        "class P:\n    " + EQUAL.replace(", ", "; ") + "\n"
        "    def table(self):\n        return kl.DHTable('own', 'standard', links)\np = P()",
        EACH,
    ),
    "a clock": ("import time", "start = time.perf_counter()"),
}
ABOUT = {
    "try": "try:\n    n = q[5]\nexcept IndexError:\n    n = 2\n",
    "with": "with np.errstate(all='ignore'):\n    n = 2\n",
    "match": "match len(q):\n    case 2: pass\n    case other: raise ValueError(other)\n",
    "a warning": "if abs(q[0]) > 9:\n    import warnings\n    warnings.warn('far')\n",
}
BODY = textwrap.indent(FORMULA, "    ")
INNER = textwrap.indent(FORMULA, "        ")
SET = f"{NAMES} = {NUMBERS}\n"
WRAPPED = {
    "a partial": f"{SET}from functools import partial\ndef g(q, g): \n{BODY}\nf = partial(g, g=9.8)",
    "an object that is called": f"{SET}class A:\n    def __call__(self, q):\n{INNER}\nf = A()",
    "an object of a class below": (
        f"{SET}class A:\n    def __call__(self, q): return self.M(q)\n"
        f"class B(A):\n    def M(self, q):\n{INNER}\nf = B()"
    ),
    "a method of the class": f"{SET}class A:\n    @classmethod\n    def M(cls, q):\n{INNER}\nf = A.M",
    "compiled": f"{SET}import numba\n@numba.njit\ndef f(q):\n{BODY}",
    "defaults by name": (
        "L1, LC2 = 0.53, 0.21\n_, l2, m1, m2, lc1, _, I1, I2 = " + NUMBERS + "\n"
        f"def f(q, l1=L1, *, lc2=LC2):\n{BODY}"
    ),
    "a table by default": (
        f"{SET}P = {{'l': [0.53, 0.41], 'lc': [0.28, 0.21]}}\n"
        f"def f(q, p=P):\n    l1, lc2 = p['l'][0], p['lc'][1]\n{BODY}"
    ),
    "a table written by default": (
        f"{SET}def f(q, l=np.array([0.53, 0.41]), p={{'lc': [0.28, 0.21]}}):\n"
        f"    l1, lc2 = l[0], p['lc'][1]\n{BODY}"
    ),
}


@pytest.fixture
def sentence(tmp_path, monkeypatch):
    """What is told of the ``f`` of a file that describes the arm as well."""

    def told(text):
        (tmp_path / "homework.py").write_text(ARM + text)
        spec = importlib.util.spec_from_file_location("homework", tmp_path / "homework.py")
        module = importlib.util.module_from_spec(spec)
        monkeypatch.setitem(sys.modules, "homework", module)
        spec.loader.exec_module(module)
        before = str(module.links)
        found = kl.diagnose(module.arm, "mass_matrix", module.f, samples=20)
        assert str(module.links) == before
        return found.sentence

    return told


@pytest.mark.many
@pytest.mark.parametrize("name", KEPT)
def test_where_numbers_are_kept(name, sentence) -> None:
    kept, taken = KEPT[name]
    own = "" if "l2" in kept + taken else f"    {NAMES} = {NUMBERS}\n"
    assert TOLD in sentence(f"{kept}\ndef f(q):\n{own}    {taken or 'pass'}\n{BODY}")


@pytest.mark.parametrize("name", ABOUT)
def test_what_stands_before_the_formula(name, sentence) -> None:
    lines = textwrap.indent(ABOUT[name], "    ")
    assert TOLD in sentence(f"{SET}\ndef f(q):\n{lines}{BODY}")


@pytest.mark.parametrize("name", WRAPPED)
def test_what_a_function_is_wrapped_in(name, sentence) -> None:
    assert TOLD in sentence(WRAPPED[name])


def test_a_number_of_a_default_is_told_as_it_is_written(sentence) -> None:
    right = WRAPPED["a table written by default"].replace("lc2**2 - h", "lc2**2 + h")
    told = sentence(right.replace("[0.28, 0.21]", "[0.28, 0.12]"))
    assert "`{'lc': [0.28, 0.12]}` should be `{'lc': [0.28, 0.21]}`" in told
    assert "_default" not in told
