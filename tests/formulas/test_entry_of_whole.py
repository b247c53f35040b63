"""One entry that is asked for, given in the whole it belongs to, or among other quantities."""

from __future__ import annotations

import pytest

import kinlab as kl
from kinlab.doctor.report import of_document
from kinlab.errors import ExpressionError

M = "M = [(m1+m2)*l1^2 + m2*l2^2 + 2*m2*l1*l2*c2, m2*l2^2 + m2*l1*l2*c2; %s, m2*l2^2]"
P = r"\begin{bmatrix} l_1 c_1 + l_2 c_{12} \\ l_1 s_1 + l_2 s_{12} \end{bmatrix}"
GIVEN = {
    "M12": ("M12", M % "m2*l2^2 + m2*l1*l2*c2", "m2*l1*l2*c2;", "m2*l1*l2*s2;", "s2 should be c2"),
    "J12": (
        "J12",
        "J = [-l1*s1-l2*s12, -l2*s12; l1*c1+l2*c12, l2*c12]",
        ", -l2*s12",
        ", -l1*s12",
        "l1 should be l2",
    ),
    "y": ("y", rf"$\mathbf{{p}} = {P}$", "l_2 s_{12}", "l_2 s_2", "s_2 should be s_{12}"),
    "T14": (
        "x",
        "T = [c12, -s12, 0, l1*c1 + l2*c12; s12, c12, 0, l1*s1 + l2*s12; 0, 0, 1, 0; 0, 0, 0, 1]",
        "l1*c1",
        "l1*s1",
        "s1 should be c1",
    ),
    "g1": (
        "g1",
        r"$G = \begin{bmatrix} (m_1+m_2) g l_1 c_1 + m_2 g l_2 c_{12} \\ m_2 g l_2 c_{12} \end{bmatrix}$",
        "l_1 c_1",
        "l_2 c_1",
        "l_2 should be l_1",
    ),
}  # fmt: skip


@pytest.mark.parametrize("case", GIVEN.values(), ids=GIVEN.keys())
def test_the_entry_is_judged_and_no_other(case):
    entry, text, old, new, told = case
    found = kl.diagnose("planar2r", entry, text)
    assert found.agrees and f"{entry} alone is judged" in found.remarks[-1], found
    wrong = kl.diagnose("planar2r", entry, text.replace(old, new))
    assert f"{entry}: {told}" in wrong.sentence, wrong


@pytest.mark.parametrize(
    "text",
    [
        M.partition(";")[0] + "]",  # one row of two
        "p_1 = [l1*c1 + l2*c12; l1*s1 + l2*s12]",  # the point of another link
        "q = [l1*c1 + l2*c12; l1*s1 + l2*s12]",
    ],
)
def test_what_is_no_such_whole_is_refused(text):
    with pytest.raises(ExpressionError):
        kl.diagnose("planar2r", "M12" if text[0] == "M" else "x", text)


def test_a_matrix_of_its_own_entries():
    """It was refused: M21 was explained by itself."""
    entries = r"M_{11} = (m_1+m_2)l_1^2 + m_2l_2^2 + 2m_2l_1l_2c_2, \quad M_{12} = M_{21} = m_2l_2^2 + m_2l_1l_2c_2, \quad M_{22} = m_2 l_2^2"
    text = rf"$$M = \begin{{bmatrix}} M_{{11}} & M_{{12}} \\ M_{{21}} & M_{{22}} \end{{bmatrix}}, \quad {entries}$$"
    found = kl.diagnose("planar2r", "M", text)
    assert found.agrees and not found.remarks, found
    wrong = kl.diagnose("planar2r", "M", text.replace("m_2l_1l_2c_2,", "m_2l_1l_2s_2,"))
    assert "s_2 should be c_2" in wrong.sentence, wrong


K = "1/2*m1*l1^2*qd1^2 + 1/2*m2*(l1^2*qd1^2 + l2^2*(qd1+qd2)^2 + 2*l1*l2*c2*qd1*(qd1+qd2))"
V = "m1*g*l1*s1 + m2*g*(l1*s1+l2*s12)"


@pytest.mark.parametrize(
    "names", [("K", "P"), ("T", "U"), ("E_k", "E_p"), ("E_{kin}", "E_{pot}"), ("Ek", "Ep")]
)
@pytest.mark.parametrize("entry", ["T", "V"])
def test_energies_by_their_letters_beside_one_another(entry, names):
    """The last was judged whatever was asked for: a right E_k was called wrong by its E_p."""
    lines = (f"{names[0]} = {K}", f"{names[1]} = {V}")
    for text in ("; ".join(lines), "; ".join(lines[::-1])):
        found = kl.diagnose("planar2r", entry, text)
        assert found.agrees, found
        other = names[entry == "T"]
        assert found.remarks[-1] == f"not judged: what is given for {other}", found
    of = "qd1^2" if entry == "T" else "l2*s12"
    wrong = kl.diagnose("planar2r", entry, "; ".join(lines).replace(of, "l1"))
    assert not wrong.agrees, wrong


def test_equations_of_which_none_has_the_name_are_not_judged_by_the_last():
    """M22 was called wrong by w, which nobody said is M22."""
    with pytest.raises(ExpressionError, match="2 signs of equality"):
        kl.diagnose("planar2r", "M22", "u = m2*l2^2; w = m2*l2")


def test_terms_that_are_left_out_are_told_alone():
    """It added "or: the formula leaves M out in the rotors' inertia", of an arm without rotors."""
    found = kl.diagnose("planar2r", "tau2", "m2*g*l2*c12")
    assert [one.kinds for one in found.causes] == [("acceleration left out",)], found


NUMBERS = M % "m2*l2^2 + m2*l1*l2*c2"


@pytest.mark.parametrize("other", ["C = [1, 2; 3, 4]", "g = [m1*g*l1; m2]"])
@pytest.mark.parametrize("asked", ["M", "M12"])
def test_another_matrix_beside_is_told(asked, other):
    """A matrix that nothing uses was passed over."""
    for text in (f"{other}; {NUMBERS}", f"{NUMBERS}; {other}"):
        found = kl.diagnose("planar2r", asked, text)
        assert found.agrees, found
        assert found.remarks[-1].endswith(f"not judged: what is given for {other[0]}"), found


def test_a_matrix_that_is_used_or_of_names_is_not_told():
    used = r"$T = \frac12 \dot q^T M \dot q$ with $M = \begin{bmatrix} (m_1+m_2)l_1^2 + m_2l_2^2 + 2m_2l_1l_2c_2 & m_2l_2^2 + m_2l_1l_2c_2 \\ m_2l_2^2 + m_2l_1l_2c_2 & m_2l_2^2 \end{bmatrix}$"
    names = "M12 = m2*l2^2 + m2*l1*l2*c2; M22 = m2*l2^2; M = [M11 M12; M12 M22]"
    for asked, text in (("T", used), ("M12", names.replace("M22 = m2*l2^2; ", ""))):
        found = kl.diagnose("planar2r", asked, text)
        assert found.agrees and not found.remarks, found


def test_a_file_of_several_has_each_out_of_its_own_whole():
    """Where each can be read alone, and not all together, the whole file was refused."""
    document = {
        "robot": "planar2r",
        "formulas": {
            "M12": NUMBERS,
            "V": f"P = {V}",
            "g1": "K = [1, 2]",
            "y": "p = [l1*c1 + l2*c12; l1*s1 + l2*s2]",
        },
    }
    judged, unread = of_document(document, "hand.toml")
    assert [(one.function, one.agrees) for one in judged] == [
        ("M12", True),
        ("y", False),
        ("V", True),
    ]
    assert [one.what for one in unread] == ["hand.toml: g1"]
    judged, unread = of_document(document | {"formulas": {"M12": NUMBERS}}, "hand.toml")
    assert judged[0].agrees and not unread
