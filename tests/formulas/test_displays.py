"""Definitions and formulas that LaTeX sets in lines of their own, beside one another."""

from __future__ import annotations

import pytest

import kinlab as kl
from kinlab.formulas.handed.displays import rows_of, with_displays_inline

M11 = r"M_{11} = a + b + 2 d \cos q_2"
A, B, D = (
    r"a &= \tfrac13 m_1 l_1^2 + m_2 l_1^2",
    r"b &= \tfrac13 m_2 l_2^2",
    r"d &= \tfrac12 m_2 l_1 l_2",
)
ROWS = rf"{A} \\ {B} \\ {D}"
TEXTS = {
    "with": rf"${M11}$ with \begin{{align}} {ROWS} \end{{align}}",
    "where": f"$${M11}$$ where\n\\begin{{align*}} {A}, & {B} \\\\ {D} \\end{{align*}}",
    "equation": f"\\begin{{equation}} {M11} \\label{{eq:m}} \\end{{equation}}\nwhere\n"
    f"\\begin{{align}} {ROWS} \\label{{eq:a}} \\end{{align}}",
    "before": f"With\n\\begin{{align}} {ROWS} \\end{{align}}\nwe get ${M11}$.",
    "aligned": rf"${M11}$ with \[ \begin{{aligned}} {ROWS} \end{{aligned}} \]",
    "split": f"\\[ {M11} \\]\nwhere\n\\begin{{equation}}\\begin{{split}} {ROWS} \\end{{split}}."
    "\\end{equation}",
    "gather": f"\\begin{{equation*}} {M11} \\end{{equation*}}\n其中\n"
    f"\\begin{{gather}} {ROWS.replace('&', '')} \\end{{gather}}",
    "eqnarray": f"Es ist ${M11}$ mit\n\\begin{{eqnarray}} {ROWS.replace('&=', '&=&')} \\end{{eqnarray}}",
}  # fmt: skip


@pytest.mark.parametrize("text", TEXTS.values(), ids=TEXTS.keys())
def test_definitions_in_a_display_are_read(text):
    assert kl.diagnose("planar2r_rods", "M11", text).agrees
    wrong = text.replace("m_1 l_1^2", "m_1 l_2^2")
    found = kl.diagnose("planar2r_rods", "M11", wrong)
    assert found.causes and found.causes[0].kinds == ("index",), found
    assert found.sentence.startswith("a: l_2 should be l_1 in"), found


@pytest.mark.parametrize("front", ["Lagrangian $L = T - V$:\n", "拉格朗日函数 $L = T - V$：\n"])
@pytest.mark.parametrize("again", [r"", r" \\ L &= T - V"])
def test_an_energy_is_announced_and_then_set_in_lines(front, again):
    rows = r"T &= \frac16 m_1 l_1^2 \dot\theta_1^2 \\ V &= \frac12 m_1 g l_1 \sin\theta_1"
    text = front + r"\begin{align} " + rows + again + r" \end{align}"
    assert kl.diagnose("single_link", "L", text).agrees
    wrong = kl.diagnose("single_link", "L", text.replace(r"\frac12 m_1", "m_1"))
    assert wrong.sentence.startswith("V: "), wrong


def test_a_sum_goes_on_in_the_next_row_and_a_chain_behind_its_sign():
    rows = rows_of(
        r"c_1 &= a \\ & - b \\[2pt] &= c, & d &= \begin{bmatrix} 1 & 2 \\ 3 & 4 \end{bmatrix}"
    )
    assert rows[0].split() == ["c_1", "=", "a", "-", "b"]
    assert rows[-1].endswith(r"\begin{bmatrix} 1 & 2 \\ 3 & 4 \end{bmatrix}")
    pair = [row.split() for row in rows_of(r"a &= 1, & b &= 2")]
    assert pair == [["a", "=", "1"], ["b", "=", "2"]]
    text = r"$x = 1$ \begin{align} M_{22} &= a \\ &= b \end{align}"
    assert "".join(with_displays_inline(text).split()) == "$x=1$$M_{22}=a=b$"


@pytest.mark.parametrize(
    "text",
    [
        r"\begin{align} a &= 1 \\ b &= 2 \end{align}",
        r"$x = 1$ \begin{align} \frac{d}{dt} a &= 1 \end{align}",
        r"$x = 1$ \begin{align} a &= 1",
        r"\begin{align}" * 400,
    ],
)
def test_what_stands_alone_or_is_no_name_stays(text):
    assert with_displays_inline(text) == text
