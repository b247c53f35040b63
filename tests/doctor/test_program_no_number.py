"""Programs whose module holds what is no number, or no end: judged as if it were not there."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest

import kinlab as kl

HEADS = {
    "math": "from math import *\n",
    "numpy": "from numpy import *\n",
    "number": "from math import cos, sin\nSPARE = {bad}\n",
    "tuple": "from math import cos, sin\nSPARE = (0.5, {bad}, 0.4)\n",
    "list": "from math import cos, sin\nSPARE = [0.5, {bad}, 0.4]\n",
    "table": "from math import cos, sin\nSPARE = [[0.5, {bad}], [0.4, 1.0]]\n",
    "dict": "from math import cos, sin\nSPARE = dict(l1=0.5, limit={bad})\n",
    "array": "from math import cos, sin\nimport numpy as np\nSPARE = np.array([0.5, {bad}])\n",
    "attribute": "from math import cos, sin\nclass Arm:\n    l1, limit = 0.5, {bad}\nSPARE = Arm\n",
}
BODY = """
def f(q, limit={limit}):
    spare = [{spare}]
    best = {bad}
    best = 1.0 if best > limit else -1.0
    return [{first}*cos(q[0]) + {last}*{wave}, {last}*cos(q[0] + q[1])]
"""
RIGHT, TO_DIGITS, WRONG = "cos(q[0] + q[1])", "cos(q[0] + q[1])*1.0000001", "sin(q[0] + q[1])"


def planar(rng: np.random.Generator) -> tuple[kl.DHTable, float, float]:
    """An arm of two links, and what it weighs at its joints."""
    a, mass, share = rng.uniform(0.3, 0.7, 2), rng.uniform(1, 4, 2), rng.uniform(0.3, 0.6, 2)
    links = [
        kl.DHLink("revolute", a=x, mass=m, com=(-s * x, 0, 0), inertia=np.diag([0, 0.1, 0.1]))
        for x, m, s in zip(a, mass, share, strict=True)
    ]
    last = 9.81 * mass[1] * a[1] * (1 - share[1])
    first = 9.81 * (mass[0] * a[0] * (1 - share[0]) + mass[1] * a[0])
    return kl.DHTable("arm", "standard", links, gravity=(0, -9.81, 0)), first, last


def program(path: Path, text: str):
    space = {"__name__": path.stem}
    path.write_text(text)
    exec(compile(text, str(path), "exec"), space)  # noqa: S102
    return space["f"]


@pytest.mark.parametrize("bad", ["float('nan')", "float('inf')", "-1e999", "10**400"])
@pytest.mark.parametrize("where", HEADS)
def test_what_is_no_number_ends_no_diagnosis(tmp_path: Path, where: str, bad: str) -> None:
    bad = "np.inf" if (where, bad) == ("array", "10**400") else bad  # no array of floats holds it
    seed = 10 * [*HEADS].index(where) + len(bad)
    arm, first, last = planar(np.random.default_rng(seed))
    for k, wave in enumerate((RIGHT, TO_DIGITS, WRONG)):
        head = HEADS[where].format(bad=bad)
        spare = "nan, inf" if where in ("math", "numpy") else "SPARE"
        known = {"limit": bad, "spare": spare, "bad": bad, "wave": wave}
        text = head + BODY.format(first=float(first), last=float(last), **known)
        found = kl.diagnose(arm, "gravity_torques", program(tmp_path / f"{where}{k}.py", text))
        assert found.agrees == (wave != WRONG)
        if wave == WRONG:
            assert found.causes[0].kinds == ("sin/cos",)
