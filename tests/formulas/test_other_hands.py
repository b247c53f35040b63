"""Formulas in other hands: angles below a cosine, primes for rates, functions of MATLAB's."""

from __future__ import annotations

import pytest

import kinlab as kl

X = [
    (r"x = l_1 c_{\theta_1} + l_2 c_{\theta_1 + \theta_2}", r"l_2 c_{\theta_1", r"l_1 c_{\theta_1"),
    (r"x = l_1 C_{q_1} + l_2 C_{q_1+q_2}", "l_2", "l_1"),
    (r"$x_e = l_1 c_{\theta_1} + l_2 c_{\theta_{12}}$", "l_2", "l_1"),
    (r"x_{ee} = l_1 c_1 + l_2 c_{12}", "l_2", "l_1"),
    ("x = @(q1,q2) l1*cos(q1) + l2*cos(q1+q2);", "l2", "l1"),
    ("@(q) l1*cos(q(1)) + l2*cos(q(1)+q(2))", "l2", "l1"),
    (
        "import numpy as np\ndef tip(q):\n    q1, q2 = q\n    x = l1*np.cos(q1) + l2*np.cos(q1 + q2)\n"
        "    return x",
        "l2*",
        "l1*",
    ),
]
TAU = (
    r"\tau_2 = m_2 l_2^2 (\theta_1'' + \theta_2'') + m_2 l_1 l_2 \cos(\theta_2) \theta_1''"
    r" + m_2 l_1 l_2 \sin(\theta_2) \theta_1'^2 + m_2 g l_2 \cos(\theta_1+\theta_2)"
)


@pytest.mark.parametrize(("text", "right", "wrong"), X, ids=range(len(X)))
def test_an_angle_below_and_functions_without_a_name(text, right, wrong):
    assert kl.diagnose("planar2r", "x", text).agrees
    found = kl.diagnose("planar2r", "x", text.replace(right, wrong, 1))
    assert found.causes and found.causes[0].kinds == ("index",), found


@pytest.mark.parametrize("joint", [r"\theta", "q", r"\vartheta"])
def test_primes_of_a_joint_are_its_rates(joint):
    text = TAU.replace(r"\theta", joint)
    assert kl.diagnose("planar2r", "tau2", text).agrees
    found = kl.diagnose("planar2r", "tau2", text.replace("'^2", "'"))
    assert found.causes and found.causes[0].kinds == ("power",), found


def test_a_primed_angle_that_is_explained_is_no_rate():
    text = r"$\theta_1' = \pi/2 - \theta_1$, $x = l_1 \sin\theta_1' + l_2 \cos(\theta_1+\theta_2)$"
    with pytest.raises(kl.KinlabError):
        kl.diagnose("planar2r", "x", text)


@pytest.mark.parametrize("names", ["q2, q1 = q", "qd1, qd2 = q", "q1, q2 = v", "l1, l2 = q"])
def test_joints_that_are_taken_out_in_another_order_are_not_passed_over(names):
    text = f"def tip(q):\n    {names}\n    return l1*np.cos(q1) + l2*np.cos(q1 + q2)"
    with pytest.raises(kl.KinlabError):
        kl.diagnose("planar2r", "x", text)


def test_another_frame_s_coordinate_is_another():
    """``x_1`` is no end effector's."""
    with pytest.raises(kl.KinlabError, match="another"):
        kl.diagnose("planar2r", "x", "x_1 = l1*cos(q1) + l2*cos(q1+q2)")


def test_a_planar_arm_s_jacobian_may_have_all_six_rows():
    rows = "[-l1*s1 - l2*s12, -l2*s12; l1*c1 + l2*c12, l2*c12; 0, 0; 0, 0; 0, 0; 1, 1]"
    found = kl.diagnose("planar2r", "J", rows)
    assert found.agrees and "vx, vy, vz, wx, wy, wz" in " ".join(found.remarks)
    wrong = kl.diagnose("planar2r", "J", rows.replace("1, 1]", "1, 0]"))
    assert wrong.sentence.startswith("J62: 0 should be 1"), wrong
