"""Formulas as LaTeX: parts of pi, and names as note 003 writes them."""

from __future__ import annotations

import pytest

from kinlab.formulas import typeset
from kinlab.formulas.text import parse


@pytest.mark.parametrize(
    ("text", "shown"),
    [
        ("cos(q1 + pi/2)", r"\cos(q_{1} + \frac{\pi}{2})"),
        ("q1 - 3*pi/4", r"q_{1} - \frac{3 \pi}{4}"),
        ("2*pi*x", r"2 \pi \, x"),
        ("3.14159265359*x", r"3.14159265359 \, x"),
        ("pi*j/Thetadmax", r"\frac{\pi \, j}{\dot{\Theta}_{max}}"),
        ("Thetad_1", r"\dot{\Theta}_{1}"),
    ],
)
def test_parts_of_pi_and_the_servos_rate(text, shown) -> None:
    assert typeset.latex(parse(text)) == shown
