r"""Sines and cosines in short, typed together: s1s2, ``5.89c1c2``, ``c\theta_{12}``."""

from __future__ import annotations

import pytest

import kinlab as kl
from kinlab.errors import ExpressionError


def judged(text: str, entry: str = "g2") -> kl.Diagnosis:
    return kl.diagnose("planar2r", entry, text)


@pytest.mark.parametrize(
    "text",
    [
        "m2 g l2 (c1c2 - s1s2)",
        "m2*g*l2*(c1c2 - s1s2)",
        "5.886c1c2 - 5.886*s1s2",
        "5.886 c1c2 - 5.886 s1s2",
        "m2*g*l2*(C1C2 - S1S2)",
        r"m_2 g l_2 c\theta_{12}",
        r"m_2 g l_2\,\mathrm{c}\theta_{12}",
        r"m_2 g l_2 (c\theta_1 c\theta_2 - s\theta_1\,s\theta_2)",
        "m₂gl₂cθ₁₂",
        "m2 g l2 cθ12",
        "s1s2 = sin(q1)*sin(q2); m2*g*l2*(c1*c2 - s1s2)",
        "c1 = cos(q1); s1 = sin(q1); m2*g*l2*(c1c2 - s1s2)",
    ],
)
def test_products_of_sines_and_cosines_in_short(text):
    found = judged(text)
    assert found.agrees and found.function == "g2", str(found)


@pytest.mark.parametrize(
    ("text", "said"),
    [
        ("m2*g*l2*(c1c2 + s1s2)", "correct: g2 = m2*g*l2*(c1c2 - s1s2)"),
        ("m1*g*l2*(c1c2 - s1s2)", "correct: g2 = m2*g*l2*(c1c2 - s1s2)"),
        ("5.886c1c2 - 5.886s1c2", "c2 should be s2 in 5.886s1c2"),
        (r"m_2 g l_2 s\theta_{12}", r"correct: g2 = m_2 g l_2 c\theta_{12}"),
        (
            r"m_2 g l_2 (c\theta_1 c\theta_2 - s\theta_1 s\theta_1)",
            r"s\theta_1 should be s\theta_2",
        ),
    ],
)
def test_what_is_wrong_in_them_is_told(text, said):
    assert said in str(judged(text))


@pytest.mark.parametrize(
    ("text", "said"),
    [
        ("s1s2^2*m2", "two ways"),
        ("m2*s1s2**2", "two ways"),
        ("m2/s1s2", "two ways"),
        ("m2*g*l2*(c1c2 - s1q2)", "'s1q2' is unknown"),
        ("m2*g*l2*(c1c2 - s1s3)", "'s3' is unknown"),
        ("l1c1*m2", "'l1c1' is unknown"),
        (r"m_2 g l_2 c\theta_{21}", "'c' is unknown"),
        (r"m_2 g l_2 c\theta_1^2", "two ways"),
        (r"m_2 g l_2 c\dot\theta_1", "'c' is unknown"),
        (r"\theta_1 = q_1; m_2 g l_2 c\theta_1", "'c' is unknown"),
    ],
)
def test_what_is_no_such_product_is_refused(text, said):
    with pytest.raises(ExpressionError, match=said):
        judged(text)


def test_a_letter_that_the_writer_explains_is_a_factor():
    assert not judged(r"c = m_2 g l_2; g_2 = c\theta_{12}").agrees
    assert judged(r"c = m_2 g l_2; g_2 = c \cos(q_1 + q_2)").agrees
