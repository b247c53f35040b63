"""Functions and angles as other languages have them: COS, Math.sin, cosd, 90°, ∂V/∂q2."""

from __future__ import annotations

import pytest

import kinlab as kl
from kinlab.errors import ExpressionError
from kinlab.formulas.typed import entry_name, plain_formula


def judged(text: str, entry: str = "g2") -> kl.Diagnosis:
    return kl.diagnose("planar2r", entry, text)


@pytest.mark.parametrize(
    "angle",
    [
        "sin(q1+q2+90°)",
        "sin(q1 + q2 + 90 º)",
        "sin(q1 + q2 + deg2rad(90))",
        "np.sin(q1 + q2 + np.deg2rad(90))",
        "sin(q1 + q2 + math.radians(45 + 45))",
        "cosd(rad2deg(q1 + q2))",
        "cosd((q1 + q2)*180/pi)",
        "cosd(180/pi*(q1 + q2))",
        "sind(90 + rad2deg(q1 + q2))",
        "cosd(rad2deg(q1) + q2*180/pi)",
        "cos(q1+q2)*sind(90)",
        "COS(q1+q2)",
        "Cos[θ1 + θ2]",
        "Math.cos(q1 + q2)",
        "Math.sin(q1 + q2 + Math.PI/2)",
    ],
)
def test_an_angle_as_other_languages_have_it(angle):
    found = judged(f"m2*g*l2*{angle}")
    assert found.agrees and not found.form, str(found)
    assert not judged(f"m1*g*l2*{angle}").agrees


@pytest.mark.parametrize(
    "text",
    [
        r"m_2 g l_2 \sin(\theta_1+\theta_2+90°)",
        "m₂ g l₂ sin(θ₁+θ₂+90°)",
        "m2 g l2 Cos[θ₁ + θ₂]",
        "m2 g l2 COS(q1 + q2)",
        "∂V/∂q2 = m2*g*l2*cos(q1+q2)",
        "∂U/∂θ₂ = m₂ g l₂ cos(θ₁+θ₂)",
        "g2 = ∂V/∂q2 = m2*g*l2*c12",
        "m2*g*l2*c12 = ∂V/∂q_2",
    ],
)
def test_signs_of_a_derivative_and_of_degrees(text):
    found = judged(text)
    assert found.agrees and found.function == "g2", str(found)


@pytest.mark.parametrize(
    ("text", "said"),
    [
        ("m2*g*l2*sin(q1+q2-90°)", "correct: g2 = -m2*g*l2*sin(q1+q2-90°)"),
        ("m1*g*l2*COS(q1+q2)", "correct: g2 = m2*g*l2*COS(q1+q2)"),
        ("m2*g*l2*Math.sin(q1+q2)", "correct: g2 = m2*g*l2*Math.cos(q1+q2)"),
        ("m2*g*l2*cosd(180)*cos(q1+q2)", "correct: g2 = -m2*g*l2*cosd(180)*cos(q1+q2)"),
        ("m1 g l2 Cos[θ1 + θ2]", "correct: g2 = m2 g l2 Cos(θ1 + θ2)"),
    ],
)
def test_what_is_wrong_is_told_as_it_was_typed(text, said):
    assert said in str(judged(text))


@pytest.mark.parametrize(
    ("text", "said"),
    [
        ("m2*g*l2*cosd(q1+q2)", "takes degrees"),
        ("m2*g*l2*cosd(rad2deg(q1)+q2)", "takes degrees"),
        ("m2*g*l2*cosd(90*q1)", "takes degrees"),
        ("m2*g*l2*acosd(90)", "takes degrees"),
        ("m2*g*l2*sin(q1°+q2)", "no meaning"),
        ("m2*g*l2*cos((q1+q2)°)", "no meaning"),
        ("∂V/∂q1 = m2*g*l2*cos(q1+q2)", "which is another"),
        ("m2*g*l2*CoS(q1+q2)", "unknown"),
    ],
)
def test_what_is_not_sure_is_refused(text, said):
    with pytest.raises(ExpressionError, match=said):
        judged(text)


def test_derivatives_by_their_names():
    assert entry_name("∂V/∂θ₂") == "g2" and entry_name("∂x/∂q_1") == "J11"
    assert judged("∂x/∂θ₁ = -l1*s1 - l2*s12", "J11").agrees
    assert plain_formula("Atan2(y, x) + SQRT(x)") == "atan2(y, x) + sqrt(x)"
