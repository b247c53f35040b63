"""A whole matrix or vector whose entries are given one by one, in a line, in lines, in displays."""

from __future__ import annotations

import pytest

import kinlab as kl

M = (
    r"M_{11} = (m_1+m_2)l_1^2 + m_2l_2^2 + 2m_2l_1l_2c_2",
    r"M_{12} = M_{21} = m_2l_2^2 + m_2l_1l_2c_2",
    r"M_{22} = m_2l_2^2",
)
C = (
    r"C_{11} = -h \dot q_2",
    r"C_{12} = -h(\dot q_1 + \dot q_2)",
    r"C_{21} = h \dot q_1",
    r"C_{22} = 0",
)
H = r"h = m_2 l_1 l_2 \sin q_2"
ALIGNED = r" \\ ".join(one.replace("=", "&=") for one in C)
TEXTS = {
    "line": ", ".join(f"${one}$" for one in C) + f" with ${H}$.",
    "front": f"With ${H}$: " + ", ".join(f"${one}$" for one in C),
    "lines": "\n".join(f"${one}$" for one in C) + f"\nwhere ${H}$",
    "plain": "\n".join((*C, H)),
    "align": rf"\begin{{align}} {ALIGNED} \end{{align}} with ${H}$",
    "one align": rf"\begin{{align}} {ALIGNED} \\ {H.replace('=', '&=')} \end{{align}}",
    "columns": r"\begin{align} C_{11} &= -h \dot q_2, & C_{12} &= -h(\dot q_1 + \dot q_2) \\"
    rf" C_{{21}} &= h \dot q_1, & C_{{22}} &= 0 \end{{align}} with ${H}$",
}  # fmt: skip


@pytest.mark.parametrize("text", TEXTS.values(), ids=TEXTS.keys())
def test_entries_with_a_name_that_is_explained(text):
    found = kl.diagnose("planar2r", "C", text)
    assert found.agrees and not found.remarks, found
    wrong = kl.diagnose("planar2r", "C", text.replace(r"\sin", r"\cos"))
    assert wrong.sentence.startswith(r"h: \cos"), wrong


@pytest.mark.parametrize("between", [", ", ",\n", "\n", " and "])
def test_entries_between_dollars(between):
    found = kl.diagnose("planar2r", "M", "Entries: " + between.join(f"${one}$" for one in M) + ".")
    assert found.agrees and not any("not given" in one for one in found.remarks), found
    slip = (M[0], M[1].replace("c_2", "s_2"), M[2])
    wrong = kl.diagnose("planar2r", "M", between.join(f"${one}$" for one in slip))
    assert wrong.sentence.startswith("M12: s_2 should be c_2"), wrong


def test_what_is_not_given_is_told():
    """It was passed over: what is there is right, and nobody said that it is not all."""
    found = kl.diagnose("planar2r", "M", f"${M[0]}$, ${M[2]}$")
    assert found.agrees and found.remarks[-1].endswith("not judged: M12, M21"), found
    found = kl.diagnose("planar2r", "C", "\n".join((*C[:3], H)))  # C22 is zero everywhere
    assert found.agrees and not found.remarks, found
    found = kl.diagnose("planar2r", "J", "J11 = -l1*s1 - l2*s12; J12 = -l2*s12")
    assert "J21, J22, J31, J32" in found.remarks[-1], found


@pytest.mark.parametrize("words", ["For $q_2 = 0$: ", "With $m_1 = m_2 = 1$: "])
def test_when_they_hold_is_refused(words):
    with pytest.raises(kl.KinlabError):
        kl.diagnose("planar2r", "M", words + ", ".join(f"${one}$" for one in M))


VECTORS = {
    "g": (r"(m_1+m_2) g l_1 c_1 + m_2 g l_2 c_{12}", r"m_2 g l_2 c_{12}"),
    "p": (
        r"(m_1+m_2)l_1^2\dot q_1 + m_2l_2^2(\dot q_1+\dot q_2) + m_2l_1l_2c_2(2\dot q_1+\dot q_2)",
        r"m_2l_2^2(\dot q_1+\dot q_2) + m_2l_1l_2c_2\dot q_1",
    ),
}
SQUARES = {
    "M": (M[0].split(" = ")[1], M[1].split(" = ")[2], M[1].split(" = ")[2], M[2].split(" = ")[1]),
    "J": ("-l_1s_1-l_2s_{12}", "-l_2s_{12}", "l_1c_1+l_2c_{12}", "l_2c_{12}"),
}
LETTERS = {"g": ["g", "G", r"\phi"], "p": ["p", "P"], "M": [*"MDHBdbh"], "J": ["J", "j"]}
LAID_OUT = {
    "align": lambda eqs: rf"\begin{{align}} {_rows(eqs)} \end{{align}}",
    "aligned": lambda eqs: rf"\[ \begin{{aligned}} {_rows(eqs)} \end{{aligned}} \]",
    "breaks": r" \\ ".join,
    "lines": "\n".join,
    "dollars": lambda eqs: ", ".join(f"${one}$" for one in eqs),
    "semicolons": "; ".join,
}


def _rows(eqs):
    return r" \\ ".join(one.replace("=", "&=", 1) for one in eqs)


@pytest.mark.parametrize("laid_out", LAID_OUT.values(), ids=LAID_OUT.keys())
@pytest.mark.parametrize(("asked", "letter"), [(x, y) for x in LETTERS for y in LETTERS[x]])
def test_one_of_several_right_ones_is_never_called_wrong(asked, letter, laid_out):
    r"""``b_{11} = ... \\ b_{12} = ...`` was taken for a chain of equalities of M11."""
    if asked in VECTORS:
        named = {f"{k + 1}": right for k, right in enumerate(VECTORS[asked])}
    else:
        named = dict(zip(("11", "12", "21", "22"), SQUARES[asked], strict=True))
    text = laid_out([f"{letter}_{{{place}}} = {right}" for place, right in named.items()])
    agreed = 0
    for place in named:
        try:
            found = kl.diagnose("planar2r", f"{asked}{place}", text)
        except kl.KinlabError:
            continue
        assert found.agrees, (place, text, found)
        agreed += 1
    assert agreed or letter in ("G", "P", "j", "b", "h", "d"), text


def test_a_matrix_and_its_entries_beside_it():
    matrix = r"B(q) = \begin{bmatrix} b_{11} & b_{12} \\ b_{12} & b_{22} \end{bmatrix}, \qquad "
    rows = (
        r"b_{11} &= I_1 + m_1 r_1^2 + I_2 + m_2 (a_1^2 + r_2^2 + 2 a_1 r_2 c_2) \\"
        r" b_{12} &= I_2 + m_2 (r_2^2 + a_1 r_2 c_2) \\ b_{22} &= I_2 + m_2 r_2^2"
    )
    text = rf"{matrix}\begin{{aligned}} {rows} \end{{aligned}}"
    for entry in ("M11", "M22"):
        assert kl.diagnose("planar2r_rods", entry, text).agrees


@pytest.mark.parametrize("letter", ["b", "d", "h"])
@pytest.mark.parametrize("whole", ["M", "mass_matrix"])
def test_entries_by_small_letters_of_another_book(whole, letter):
    """They were refused: b11 names no quantity, where M is asked for it is clear."""
    eqs = [one.replace("M_", f"{letter}_") for one in M]
    found = kl.diagnose("planar2r", whole, ", ".join(f"${one}$" for one in eqs))
    assert found.agrees and not found.remarks, found
    slip = ", ".join(f"${one.replace('l_2^2', 'l_2', 1)}$" for one in eqs)
    wrong = kl.diagnose("planar2r", whole, slip)
    assert "M22: l_2 should be l_2^2" in wrong.sentence, wrong
