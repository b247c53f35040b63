"""Names that have one meaning by habit are read; what may be two things is refused with a remedy."""

from __future__ import annotations

import pytest

from kinlab.doctor.report import of_document

ARM = "planar2r"


def judged(robot=ARM, **formulas):
    found, unread = of_document({"robot": robot, "formulas": formulas}, "f.toml", 20)
    return [one.agrees for one in found], [str(one.problem) for one in unread], found


@pytest.mark.parametrize(
    ("entry", "text"),
    [
        ("tau1", "m*l**2*qdd1/3 + m*g*l*cos(q1)/2"),
        ("tau1", r"\frac13 m l^2 \ddot\theta + m g l_c \cos\theta"),
        ("V", "m*g*lc*sin(theta)"),
        ("tau1", "m1*l1^2*theta1_ddot/3 + m*g*l/2*cos(q)"),
    ],
)
def test_the_only_joint_needs_no_number(entry, text):
    assert judged("single_link", **{entry: text})[0] == [True]


@pytest.mark.parametrize(
    ("entry", "text"),
    [
        ("x", "L1*cos(q1) + L2*cos(q1+q2)"),
        ("x", "L_1 cos(t1) + L_2 cos(t1 + t2)"),
        ("x", "a1*cos(q1) + a2*cos(q12)"),
        ("M11", "(M1+M2)*L1^2 + M2*L2^2 + 2*M2*L1*L2*cos(q2)"),
        ("x", "l1*cos(q1)+l2*cos(q1+q2); % the tool"),
        ("M22", "m2*np.power(l2, 2)"),
        ("y", "l1*sin q1 + l2*sin(q1+q2)"),
        ("T", "m1*l1^2*w1^2/2 + m2*(l1^2*w1^2 + l2^2*(w1+qd2)^2 + 2*l1*l2*c2*w1*(w1+qd2))/2"),
    ],
)
def test_names_by_habit(entry, text):
    assert judged(**{entry: text})[:2] == ([True], [])


def test_an_entry_in_another_formula_is_that_formula():
    given = {"M12": "m2*l2^2 + m2*l1*l2*c2", "M21": "M12", "M22": "M12 - m2*l1*l2*c2"}
    assert judged(**given)[:2] == ([True] * 3, [])
    agrees, unread, _found = judged(**given, M11="m1*")
    assert (agrees, len(unread)) == ([True] * 3, 1)
    agrees, _unread, found = judged(**given | {"M12": "m2*l2^2 + m2*l1*l2*s2", "M22": "m2*l2^2"})
    assert agrees == [False, False, True]
    assert found[1].causes[0].shown == {"M21": "m2*l2^2 + m2*l1*l2*c2"}


def test_a_matrix_as_a_table_of_toml():
    rows = [["(m1+m2)*l1^2 + m2*l2^2 + 2*m2*l1*l2*c2", "m2*l2^2 + m2*l1*l2*c2"], ["M12", "m2*l2^2"]]
    assert judged(M=rows)[:2] == ([True], [])
    assert judged(g=["(m1+m2)*g*l1*c1 + m2*g*l2*c12", "m2*g*l2*c12"])[:2] == ([True], [])
    assert "int; write the formula as text" in judged(M=[[1, "2"], ["3", "4"]])[1][0]


@pytest.mark.parametrize(
    ("entry", "text", "told"),
    [
        ("M11", "(m1 + M2)*l1^2 + m2*l2^2", "'M2' is unknown"),
        ("x", "l1*c1 + a2*c12 + l2", "'a2' is unknown"),
        ("x", "l1*cos(t1) + l2*cos(q1+q2)", "'t1' is unknown"),
        ("C11", "-m2*l1*l2*s2*w2", "write qd2 or the sum"),
        ("tau1", "m1*alpha2", "write qdd2 or the sum"),
        ("tau1", "m1*l1^2*cos(alpha1)", "'alpha1' is unknown"),
        ("x", "l1*cosd(q1)", "write cos"),
        ("M12", "M21", "'M21' is unknown"),
    ],
)
def test_what_may_be_two_things_is_refused(entry, text, told):
    agrees, unread, _found = judged(**{entry: text})
    assert agrees == []
    assert told in unread[0]


def test_entries_that_explain_each_other_are_refused():
    assert "unknown" in judged(M12="M21", M21="M12")[1][0]
    assert "itself" in judged(M12="2*M21", M21="M12 + m1")[1][0]


def test_a_slip_in_the_names_by_habit():
    (found,) = judged(x="L1 cos(t1) + L2 sin(t1 + t2)")[2]
    assert found.causes[0].shown == {"x": "L1 cos(t1) + L2 cos(t1 + t2)"}
    (found,) = judged(y="a1*sin(q1) + a2*cos(q12)")[2]
    assert found.causes[0].shown == {"y": "a1*sin(q1) + a2*sin(q12)"}


def test_a_symbol_with_a_line_below_is_also_what_latex_reads():
    own = {"robot": ARM, "symbols": {"L_1": "l1", "L_2": 0.4}}
    typed = r"L_1 \cos\theta_1 + L_2 \cos(\theta_1 + \theta_2)"
    (found,), unread = of_document(own | {"latex": {"x": typed}}, "f.toml", 20)
    assert found.agrees and not unread
    (found,), unread = of_document(own | {"formulas": {"x": "L_1*c1 + L_2*c12"}}, "f.toml", 20)
    assert found.agrees and not unread
    same = {"robot": ARM, "symbols": {"m_2": "m2"}, "latex": {"g2": r"m_2 g l_2 c_{12}"}}
    (found,), unread = of_document(same, "f.toml", 20)
    assert found.agrees and not unread
    bad = typed.replace(r"L_2 \cos", r"L_1 \cos")
    (found,), unread = of_document(own | {"latex": {"x": bad}}, "f.toml", 20)
    assert found.causes[0].shown == {"x": typed} and not unread
