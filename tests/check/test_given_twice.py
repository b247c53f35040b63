"""A file of formulas in which one entry stands twice, under two names: each is told, none lost."""

from kinlab.doctor.report import of_document

FORMULAS = {
    "x": "l1*c1 + l2*c12",
    "g1": "(m1 + m2)*g*l1*c1 - m2*g*l2*c12",
    "gravity_torques": "[(m1 + m2)*g*l1*c1 + m2*g*l2*c12, m2*g*l2*c12]",
}


def test_an_entry_that_stands_in_a_vector_too_is_told():
    judged, unread = of_document({"robot": "planar2r", "formulas": FORMULAS}, "f.toml")
    assert [one.function for one in judged] == ["x", "g1"]
    assert [one.agrees for one in judged] == [True, False]
    (told,) = unread
    assert "g1 is given twice; keep one" in str(told.problem)
