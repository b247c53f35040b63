"""What is no arithmetic is refused with what is likely to be missing."""

from __future__ import annotations

import pytest

from kinlab.errors import ExpressionError
from kinlab.formulas.text import parse


@pytest.mark.parametrize(
    ("text", "remedy"),
    [
        ("m1*(l1 + l2*c2", "a bracket is not closed"),
        ("m1*l1 + l2)*c2", "a bracket is closed too often"),
        ("l1 s1 + l2 s12", "write * between factors"),
        ("l1*s1 +", None),
    ],
)
def test_no_arithmetic(text, remedy):
    with pytest.raises(ExpressionError, match="no arithmetic") as caught:
        parse(text, "x")
    said = str(caught.value)
    assert said.endswith(remedy) if remedy else ";" not in said


def test_a_power_is_quoted_as_it_was_typed():
    with pytest.raises(ExpressionError, match=r"m1\*\(l1\^2; a bracket is not closed"):
        parse("m1*(l1^2", "x")
