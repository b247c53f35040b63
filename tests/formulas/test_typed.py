"""Formulas as people type them: written by sympy's printers, read back; what is unsure is refused."""

from __future__ import annotations

import re
import time

import numpy as np
import pytest
import sympy

import kinlab as kl
from kinlab.errors import ExpressionError
from kinlab.formulas import tree
from kinlab.formulas.files import formula_file
from kinlab.formulas.grids import cells, opened
from kinlab.formulas.text import canonical, parse
from kinlab.formulas.typed import entry_name, explained, plain_formula, sides
from kinlab.symbolic.vocabulary import vocabulary

PLAIN = ("q1", "q2", "qd1", "qd2", "qdd1", "qdd2", "l1", "l2", "lc1", "m1", "m2", "I2", "g")
AT = dict(zip(PLAIN, np.random.default_rng(8).uniform(0.4, 1.9, (len(PLAIN), 7)), strict=True))


def meant(text: str, writing=None):
    """The values of a formula at the states, by the reader and the tree."""
    node = parse(plain_formula(text, "here", writing))
    node = tree.renamed(node, {name: canonical(name) for name in tree.names(node)})
    return np.broadcast_to(tree.evaluate(node, AT), 7)


def random_formula(rng, symbols, depth: int = 3):
    """A sum, product, power, quotient or cosine of the names, as sympy builds it."""
    kind = rng.integers(0, 7) if depth else 6
    if kind == 6:
        return symbols[PLAIN[rng.integers(len(PLAIN))]]
    one = random_formula(rng, symbols, depth - 1)
    if kind == 0:
        return one ** int(rng.integers(2, 4))
    if kind == 1:
        angle = [symbols["q1"], symbols["q2"], symbols["q1"] + symbols["q2"]][rng.integers(3)]
        return one * [sympy.cos, sympy.sin][rng.integers(2)](angle) ** int(rng.integers(1, 3))
    other = random_formula(rng, symbols, depth - 1)
    if kind == 2:
        return one / (other**2 + sympy.Rational(int(rng.integers(1, 5)), 2))
    if kind == 3:
        return one * other
    return one - other * sympy.Float("0.25") if kind == 4 else one + 2 * other


def truth(formula, symbols):
    back = {symbols[name]: sympy.Symbol(name) for name in PLAIN}
    names = [sympy.Symbol(name) for name in PLAIN]
    values = sympy.lambdify(names, formula.xreplace(back), "numpy")(*AT.values())
    return np.broadcast_to(np.asarray(values, dtype=float), 7)


def index(name: str) -> tuple[str, str]:
    head, number = re.fullmatch(r"([A-Za-z]+)(\d*)", name).groups()
    return head, number


def latex_name(name: str, angle: str, braced: bool) -> str:
    head, number = index(name)
    dotted = {"q": angle, "qd": rf"\dot{{{angle}}}", "qdd": rf"\ddot{{{angle}}}"}.get(head, head)
    if head == "lc":
        return rf"l_{{c{number}}}" if braced else rf"l_{{\mathrm{{c}}{number}}}"
    return dotted + (f"_{{{number}}}" if number and braced else f"_{number}" if number else "")


LETTER = {"q": "q", "qd": "dq", "qdd": "ddq"}


def as_latex(formula, symbols, rng):
    angle, braced = (("q", r"\theta")[rng.integers(2)], bool(rng.integers(2)))
    names = {symbols[name]: latex_name(name, angle, braced) for name in PLAIN}
    text = sympy.latex(
        formula, symbol_names=names, mul_symbol=(None, "dot", "times")[rng.integers(3)]
    )
    return rf"$\displaystyle {text}$" if rng.integers(2) else text


def as_matlab(formula, symbols, rng):
    names = {symbols[name]: sympy.Symbol(f"{LETTER.get(h, h)}({k})" if k else h)
             for name in PLAIN for h, k in [index(name)]}  # fmt: skip
    text = sympy.octave_code(formula.xreplace(names))
    return text if rng.integers(2) else re.sub(r"\.([*/^])", r"\1", text) + ";"


def as_python(formula, symbols, rng):
    names = {symbols[name]: sympy.Symbol(f"{LETTER.get(h, h)}[{int(k) - 1}]" if k else h)
             for name in PLAIN for h, k in [index(name)]}  # fmt: skip
    text = sympy.pycode(formula.xreplace(names))
    return text.replace("math.", ("np.", "math.", "numpy.")[rng.integers(3)]) + " + 0*math.pi"


def as_unicode(formula, symbols, rng):
    below = str.maketrans("0123456789", "₀₁₂₃₄₅₆₇₈₉")
    angle = "qθ"[rng.integers(2)]
    text = str(formula)
    for name in sorted(PLAIN, key=len, reverse=True):
        head, number = index(name)
        letter = {"q": angle, "qd": angle + "\u0307", "qdd": angle + "\u0308"}.get(head, head)
        text = re.sub(rf"\b{name}\b", letter + number.translate(below), text)
    text = re.sub(r"\*\*([23])(?!\d)", lambda m: "²³"[int(m[1]) - 2], text)
    return text.replace("*", "·") if rng.integers(2) and "**" not in text else text


WRITERS = {"latex": as_latex, "matlab": as_matlab, "python": as_python, "unicode": as_unicode}
SYMBOLS = {name: sympy.Symbol(name) for name in PLAIN}


def read_back(writer: str, count: int, seed: int) -> None:
    rng = np.random.default_rng(seed)
    for _ in range(count):
        formula = random_formula(rng, SYMBOLS)
        if any(power.exp > 6 for power in formula.atoms(sympy.Pow)):
            continue  # refused by design
        text = WRITERS[writer](formula, SYMBOLS, rng)
        expected = truth(formula, SYMBOLS)
        np.testing.assert_allclose(meant(text), expected, rtol=1e-9, atol=1e-9, err_msg=text)


@pytest.mark.parametrize("writer", WRITERS)
def test_what_sympy_writes_is_read_back(writer):
    read_back(writer, 30, 1)


@pytest.mark.campaign
@pytest.mark.parametrize("writer", WRITERS)
def test_what_sympy_writes_is_read_back_often(writer):
    read_back(writer, 2000, 2)


@pytest.mark.parametrize(
    ("typed", "plain"),
    [
        (r"$m_2 l_2^2 \ddot{\theta}_1$", "m2*l2**2*qdd1"), (r"\cos\theta_2 \dot{\theta}_1^2", "cos(q2)*qd1**2"),
        (r"C_{12} l_2 + S_1", "cos(q1+q2)*l2 + sin(q1)"), (r"\theta_{12}", "q1 + q2"), (r"\dot\theta_{12}", "qd1 + qd2"),
        (r"\omega_1^2", "qd1**2"), (r"\mathrm{l}_{\mathrm{c1}} m1", "lc1*m1"), ("m₁l₁²θ̇₁ cos θ₂", "m1*l1**2*qd1*cos(q2)"),
        ("θ₁ + θ1", "2*q1"), ("l1.*cos(q(1)).^2", "l1*cos(q1)**2"), ("np.cos(q[1])*q[0]", "cos(q2)*q1"),
        ("½m₁l₁²", "m1*l1**2/2"),
        ("(m₁+m₂)gl₁cosθ₁ + m₂gl₂cos(θ₁+θ₂)", "(m1+m2)*g*l1*cos(q1) + m2*g*l2*cos(q1+q2)"),
        ("(m_1+m_2)gl_1cos(θ_1)", "(m1+m2)*g*l1*cos(q1)"), ("2gl_1 + l_1^2 + m_1", "2*g*l1 + l1**2 + m1"),
        ("- 0.25 l_1 m_2 + l_2", "-0.25*l1*m2 + l2"), (r"\frac12 m_1", "m1/2"), (r"{\dot q}_1^2", "qd1**2"), ("l_2*c_12", "l2*cos(q1+q2)"),
        (r"\begin{equation} 1/2 m_1 l_1 \end{equation}", "m1*l1/2"), (r"\sin^{2}{\left(q_{1} \right)}", "sin(q1)**2"),
        (r"m_1 l_1/2\cos q_1", "m1*l1/2*cos(q1)"), (r"\cos\frac{q_1}{2}", "cos(q1/2)"), ("2^-1*l1", "l1/2"),
        (r"l_{1}\cos{q_1 + q_2}", "l1*cos(q1 + q2)"), ("q̈₁ + θ̈₂", "qdd1 + qdd2"), (r"\text{g} m_1,", "g*m1"),
    ],
)  # fmt: skip
def test_by_hand(typed, plain):
    rng = {name: AT[name] for name in PLAIN}
    expected = eval(plain, {"__builtins__": {}, "cos": np.cos, "sin": np.sin}, rng)  # noqa: S307
    np.testing.assert_allclose(meant(typed), expected, rtol=1e-13)


@pytest.mark.parametrize(
    ("typed", "message"),
    [
        ("q[1] + 1", "counted from 0"), (r"\cos\theta_1 + \theta_2", "parentheses before"), (r"\cos^{-1} x", "two ways"),
        ("l1^q1^2", "power of a power"), ("2^(1)^2", "power of a power"), ("C12*qd1", "a cosine, or an entry"),
        (r"c_12 \cdot 2", r"write _\{12\}"), (r"g/2l_1 \cdot 1", "two ways"), (r"\sqrt[3]{x}", "square roots"),
        (r"g(q_1) \cdot 1", "two ways"), ("q(0)", "counts from 1"), (r"\cos\theta_2^2", "a power behind"),
        (r"\sin q_1 q_2", "parentheses before"), (r"\cos q_1/2", "a slash behind"), ("q[0]*q(1)", "counted from"),
        ("l1(2)", "no sure meaning"), ("c(2)", "no sure meaning"), ("q[-1]", "from the end"), ("m₁ л", "no meaning"),
        (r"9 81 \cdot m_1", "two ways"), (r"\log q_1", "cannot be read"),
    ],
)  # fmt: skip
def test_what_can_be_read_in_two_ways_is_refused(typed, message):
    with pytest.raises(ExpressionError, match=message) as caught:
        parse(plain_formula(typed, "f.toml: tau1"), "f.toml: tau1")
    assert "f.toml: tau1" in str(caught.value)


@pytest.mark.parametrize(
    ("typed", "name"),
    [
        (r"\tau_2", "tau2"), (r"$\tau_{2}$", "tau2"), ("tau(2)", "tau2"), ("τ₂", "tau2"), ("M_{12}(q)", "M12"),
        ("M(1,2)", "M12"), (r"\mathbf{M}_{1,2}", "M12"), ("fk14", "T14"), ("L", "lagrangian"), ("fk[0,3]", "fk[0,3]"),
        (r"\boldsymbol{\tau}", "tau"), ("C_12(q, qd)", "C12"), ("mass_matrix[0,0]", "mass_matrix[0,0]"), ("x", "x"),
    ],
)  # fmt: skip
def test_names_of_entries(typed, name):
    assert entry_name(typed) == name


@pytest.mark.parametrize(
    "typed",
    [
        r"\begin{bmatrix} a & b \\ c & d \end{bmatrix}", r"\left(\begin{array}{cc} a & b\\ c & d\\ \end{array}\right)",
        r"$\begin{pmatrix}a&b\\[2pt]c&d\end{pmatrix}$", "[a, b; c, d]", "[[a, b], [c, d]]", "np.array([[a, b], [c, d]])",
    ],
)  # fmt: skip
def test_matrices(typed):
    found = cells(typed)
    assert [[cell.strip("$") for cell in row] for row in found] == [["a", "b"], ["c", "d"]]


def test_a_file_of_one_writer():
    file = formula_file(
        {
            "robot": "planar2r",
            "M": r"M(q) = \begin{bmatrix} m_1 & m_2 c_2 \\ m_2 c_2 & I_2 \end{bmatrix}",
            "tau": "[np.cos(q[0]), q[1]]",
            "g2": r"g_2 = S_{12} C_{12} \dot q_1",
        },
        "f.toml",
    )
    assert list(file.formulas) == ["M11", "M12", "M21", "M22", "tau1", "tau2", "g2"]
    assert str(file.formulas["tau2"]) == "q2"
    assert str(file.formulas["g2"]) == "s12*c12*qd1"
    for formulas, message in (
        ({"tau1": "tau2 = m1"}, "another"), ({"tau1": "m1", r"\tau_1": "m2"}, "given twice"),
        ({"tau1": "omega2*m1"}, "angular velocity of link 2"), ({"M": "[a, b]"}, "a row or a column"),
        ({"M": "[a, b; c]"}, "different lengths"), ({"tau1": "a = b = c"}, "signs of equality"),
    ):  # fmt: skip
        with pytest.raises(ExpressionError, match=message):
            formula_file({"robot": "planar2r", "formulas": formulas}, "f.toml")
    given = {"robot": "planar2r", "symbols": {"omega2": "qd2"}, "tau1": "omega2*m1"}
    assert formula_file(given, "f.toml").texts["tau1"] == "omega2*m1"


@pytest.mark.parametrize(
    ("text", "plain"),
    [
        (r"$l_1 C_1 + l_2 C_{1+2}$", "l1*c1 + l2*c12"),
        (r"$m_2 l_{c_2}^2 \ddot{q_1}$", "m2*lc2**2*qdd1"),
        (r"$m_2 l_{c_{2}}$", "m2*lc2"),
        ("m2*θ1'' + θ2'²", "m2*thetadd1 + thetad2**2"),
        ("m₂lc₂² + m₂l₁lc₂cosθ₂", "m2*lc2**2 + m2*l1*lc2*cos(theta2)"),
        ("lc2² + l1·lc2·cos(q2)", "lc2**2 + l1*lc2*cos(q2)"),
        ("m1＊（l1＋l２）", "m1*(l1+l2)"),
        ("0。5*m1", "0.5*m1"),
        ("l1 c1 + l2 c12", "l1*c1 + l2*c12"),
        ("l_1 cos(theta_1) + 2 l2 (c1 + c2)", "l_1*cos(theta_1) + 2*l2*(c1 + c2)"),
        ("(m1+m2)l1^2 + 2m2 l1 l2 cos(q2)", "(m1+m2)*l1^2 + 2*m2*l1*l2*cos(q2)"),
        ("1/2 m1 v1^2 + m1 l1/2 c1", "1/2*m1*v1^2 + m1*l1/2*c1"),
        ("a1 cos q1 sin^2(q1 + q2)", "a1*cos(q1)*sin(q1 + q2)**2"),
        ("a_1 c_1 + a_2 c_12", "a_1*c_1 + a_2*c_12"),
        ("m2*np.power(l1 + l2, 2) + pow(q1,2)", "m2*(l1 + l2)**2 + q1**2"),
        ("l1*c1; % the elbow = here", "l1*c1"),
    ],
)
def test_more_ways_of_typing(text, plain):
    assert " ".join(plain_formula(text).split()) == plain


@pytest.mark.parametrize(
    "text",
    [
        *(r"$c_{2+1}$", r"$c_{1+}$", r"$l_{1+x}$", "m1*l1'", "q1'''", "l1*cos q1 + q2"),
        *(
            "m1*g/l1 l2",
            "m1*g/2l1",
            "m1*g2(q1)",
            "g (q1)",
            "l1*cosd(q1)",
            "l1 2",
            "2 3",
            "2 cos q1^2",
        ),
    ],
)
def test_what_has_two_meanings_or_none_is_refused(text):
    with pytest.raises(ExpressionError):
        parse(plain_formula(text))


def test_a_left_side_of_the_same_entry_by_another_letter():
    given = {"robot": "planar2r", "formulas": {"g2": "G_2 = m2*g", "tau1": r"$\tau = m_1$"}}
    assert formula_file(given, "f.toml").texts == {"g2": "m2*g", "tau1": "m1"}
    with pytest.raises(ExpressionError, match="another"):
        formula_file({"robot": "planar2r", "formulas": {"g2": "G_1 = m2*g"}}, "f.toml")


@pytest.mark.parametrize(
    ("entry", "left"),
    [
        ("M11", "d_{11}"),
        ("M11", "B_{11}(q)"),
        ("mass_matrix[0,0]", "H11"),
        ("g1", r"\phi_1"),
        ("V", "P"),
        ("V", r"E_p(\theta)"),
        ("V", "my_potential"),
        ("g2", "^{0}G_2"),
    ],
)
def test_a_left_side_by_the_name_of_another_book(entry, left):
    assert list(opened({entry: f"{left} = 2*m1"}, "f.toml").values()) == ["2*m1"]


@pytest.mark.parametrize(
    ("entry", "left"),
    [("M11", "d_{22}"), ("V", "T"), ("V", "K"), ("g1", "phi2"), ("M11", "tau1"), ("tau", "tau2")],
)
def test_a_left_side_of_another_entry_is_refused(entry, left):
    with pytest.raises(ExpressionError, match="which is another"):
        opened({entry: f"{left} = 2*m1"}, "f.toml")


@pytest.mark.parametrize(
    ("typed", "own", "formula"),
    [
        ("h = -m2*l1*s2; C11 = h*qd2;", {"h": "-m2*l1*s2"}, "C11 = h*qd2"),
        ("a = 2*m1\nb = a*l1\na + b", {"a": "2*m1", "b": "a*l1"}, "a + b"),
        (r"\phi = q_1+q_2 \\ g_2 = \cos\phi", {"phi": "$q_1+q_2$"}, r"$g_2 = \cos\phi$"),
        (r"C_{11} = h \dot q_2, \quad h = -m_2", {"h": "$-m_2$"}, r"$C_{11} = h \dot q_2$"),
        ("C11 = h*qd2, where h = -m2", {"h": "-m2"}, "C11 = h*qd2"),
        ("M = [m1, 0; 0, m2]", {}, "M = [m1, 0; 0, m2]"),
        ("tau1 = m1 +\n m2", {}, "tau1 = m1 +\n m2"),
    ],
)
def test_what_a_writer_explains_in_front_of_a_formula(typed, own, formula):
    assert explained(typed) == (own, formula)


@pytest.mark.parametrize(
    ("typed", "plain"),
    [
        (r"\left\{ m_1 + 0{,}5 m_2 \right\} \dot{q_1^2}", "(m1 + 0.5*m2)*qd1**2"),
        ("l1*Cos(q1) + Sqrt(m1)", "l1*cos(q1) + sqrt(m1)"),
        (r"\mathcal{L} ={}& m_1", "m1"),
    ],
)
def test_marks_of_other_hands(typed, plain):
    assert plain_formula(sides(typed)[1]) == plain


def test_entries_set_apart_by_blanks():
    assert cells("[m1*l1 m2; m2 -m1*l2]") == [["m1*l1", "m2"], ["m2", "-m1*l2"]]
    assert cells("[m1*l1 + m2 -m2; m2 - m1 (m1 + m2)]") == [["m1*l1 + m2", "-m2"],
                                                           ["m2 - m1", "(m1 + m2)"]]  # fmt: skip
    assert cells("[m1*l1 + m2; m2 * c1]") == [["m1*l1 + m2"], ["m2 * c1"]]
    assert cells("[M11 M12; M12 0]") == [["M11", "M12"], ["M12", "0"]]


@pytest.mark.parametrize("entry", ["x", "y"])
def test_of_several_equations_the_one_of_the_entry(entry):
    text = r"x = l_1 c_1, \quad y = l_1 s_1"
    assert explained(text, entry)[1] == ("$x = l_1 c_1$" if entry == "x" else "$y = l_1 s_1$")


@pytest.mark.parametrize(
    ("entry", "formula"), [("fk14", "c1*a2"), ("T24", "s1*a2"), ("fk[2,3]", "d1 + a2")]
)
@pytest.mark.parametrize("between", ["; ", ", ", ",\\; "])
def test_of_the_coordinates_of_a_point_the_one_of_the_entry(entry, formula, between):
    text = between.join(("p_x = c1*a2", "y = s1*a2", "z = d1 + a2"))
    assert explained(text, entry)[1].strip("$").partition("=")[2].strip() == formula


def test_an_equation_the_other_way_round():
    assert opened({"g2": "m2*g*l2*c12 = g2"}, "f.toml") == {"g2": "m2*g*l2*c12"}


def test_a_row_with_a_mark_is_a_column():
    assert cells(r"\begin{bmatrix} a & b \end{bmatrix}^T") == [["$a$"], ["$b$"]]
    assert entry_name("D_{1,1,2}") == "D112"


def test_a_formula_over_several_lines():
    text = r"\begin{aligned}\tau_1 &= m_1 l_1 \\&\quad + m_2 l_2\end{aligned}"
    assert plain_formula(sides(text)[1]) == "m1*l1 + m2*l2"


G1, G2 = "(m1+m2)*g*l1*c1 + m2*g*l2*c12", "m2*g*l2*c12"
LINE = r"m_2 g l_2 \cos(\theta_1+\theta_2)"


def diagnosed(entry, text):
    return kl.diagnose("planar2r", entry, text)


@pytest.mark.parametrize(
    "text",
    [
        rf"{LINE} \tag{{3.7}}", rf"{LINE}\,\mathrm{{N\,m}}", rf"{LINE}\;[\mathrm{{N\,m}}]",
        rf"{LINE}\ \text{{N m}}", f"{G2} [Nm]", f"{G2} # gravity", f"return {G2}",
        r"m_2\,g\,l_2\,{\rm c}_{12}", r"m_2 g l_2 \cos(\vartheta_1+\vartheta_2)",
        r"m_2 g l_2 \cos(\varphi_1+\varphi_2)", "m2*g*l2*cos(q1(t)+q2(t))", "m2*g*l2*Cos[q1+q2]",
        f"{G2}，重力项", f"{G2}（重力矩）", f"{G2}，其中 g = 9.81", rf"{LINE} \quad \text{{（重力项）}}",
        rf"{LINE} \text{{，其中 }} g = 9.81", rf"{LINE} \quad\text{{(gravity)}}", f"重力矩 = {G2}",
        r"c_{12} l_2\,m_2\,\mathrm{g}", r"c_{12} l_2 g\quad m_2",
        r"\begin{split}g_2 ={}& m_2 g l_2 c_1 c_2 \\ & - m_2 g l_2 s_1 s_2\end{split}",
    ],
)  # fmt: skip
def test_what_stands_beside_a_formula_is_left_out(text):
    found = diagnosed("g2", text)
    assert found.agrees and not found.form, str(found)


@pytest.mark.parametrize(
    ("entry", "text"),
    [
        ("g2", f"g2 = {G2} = 5.886*cos(q1+q2)"), ("g2", rf"{LINE} \approx 5.89\,c_{{12}}"),
        ("g2", rf"g_2 = \frac{{\partial V}}{{\partial q_2}} = {LINE}"), ("g2", f"{G2} = g2"),
        ("g2", rf"g_2 = {LINE} = \frac{{\partial V}}{{\partial q_2}}"),
        ("M12", r"M_{12} = M_{21} = m_2 l_2^2 + m_2 l_1 l_2 c_2"), ("J31", "J_{31} = J_{32} = 1"),
        ("J11", r"J_{11} = \frac{\partial x}{\partial\theta_1} = -y = -l_1 s_1 - l_2 s_{12}"),
        ("g", f"g1 = {G1}, g2 = {G2}"), ("g", f"{G1}, {G2}"), ("g2", f"g1 = {G1}; g2 = {G2}"),
        ("J11", r"J_{11} = -r \quad (r = l_1 s_1 + l_2 s_{12})"),
        ("g", r"\begin{cases} g_1 = k + (m_1+m_2) g l_1 c_1 \\ g_2 = k \\ k = m_2 g l_2 c_{12}"
         r"\end{cases}"),
    ],
)  # fmt: skip
def test_chains_and_several_equations_are_read(entry, text):
    found = diagnosed(entry, text)
    assert (found.agrees, found.form, found.remarks) == (True, "", ()), str(found)


@pytest.mark.parametrize(
    ("text", "said"),
    [
        ("g2 = m1*g*l2*c12 = 5.886*cos(q1+q2)", "m1 should be m2"),
        (f"g2 = {G2} = 5.5*cos(q1+q2)", "5.5 should be 5.886"),
    ],
)
def test_parts_of_a_chain_that_differ_are_told(text, said):
    found = diagnosed("g2", text)
    assert not found.agrees and said in str(found)
    assert "another part of the chain of equalities is right" in str(found)


@pytest.mark.parametrize(
    "text",
    [
        f"g2 = {G2} = 5.886*c12 = 2.9 at q = 60", f"tau2 = g2 = {G2}", f"{G2} = h, k = 3 = 4",
        rf"g_2 = {LINE} \,\mathrm{{m}}", f"{G2}，q1为角",
    ],
)  # fmt: skip
def test_what_stands_beside_a_formula_and_may_mean_something_is_refused(text):
    with pytest.raises(ExpressionError):
        diagnosed("g2", text)


PARTS = r"\begin{bmatrix} (m_1+m_2) l_1 & m_2 l_2\\ 0 & m_2 l_2\end{bmatrix}"


@pytest.mark.parametrize(
    ("entry", "text"),
    [
        ("g", rf"g {PARTS} \begin{{bmatrix}} c_1 \\ c_{{12}}\end{{bmatrix}}"),
        ("g", rf"\begin{{bmatrix}} c_1 & c_{{12}}\end{{bmatrix}} {PARTS}^T \cdot g"),
        ("g", f"[{G1}, {G2}]^T"), ("g", rf"\left[ (m_1+m_2) g l_1 c_1 + {LINE},\; {LINE} \right]^\top"),
        ("g", f"[{G1} {G2}]'"), ("g", f"G = [ {G1}\n  {G2} ];"), ("g", f"[{G1}, {G2}].'"),
        ("g", f"{G2}*[1; 1] + (m1+m2)*g*l1*c1*[1; 0]"), ("g", f"[1, 0; 1, 1]'*[{G1} - {G2}; {G2}]"),
        ("C", "m2*l1*l2*sin(q2)*[-qd2, -qd1-qd2; qd1, 0]"), ("g", f"{{{{{G1}}}, {{{G2}}}}}"),
        ("C", "h = m2*l1*l2*s2\nC = [-h*qd2 -h*(qd1+qd2)\n h*qd1 0]"),
        ("M", "a = m2*l2^2; b = m2*l1*l2*c2; M = [a+2*b, a+b; a+b, a] + diag([(m1+m2)*l1^2, 0])"),
        ("T", r"T = \frac12 \begin{bmatrix}\dot q_1 & \dot q_2\end{bmatrix} \begin{bmatrix} "
         r"(m_1+m_2) l_1^2 + m_2 l_2^2 + 2 m_2 l_1 l_2 c_2 & m_2 l_2^2 + m_2 l_1 l_2 c_2 \\ "
         r"m_2 l_2^2 + m_2 l_1 l_2 c_2 & m_2 l_2^2 \end{bmatrix} "
         r"\begin{bmatrix}\dot q_1\\ \dot q_2\end{bmatrix}"),
        ("statics", "[fx*(-l1*s1-l2*s12) + fy*(l1*c1+l2*c12) + nz, -fx*l2*s12 + fy*l2*c12 + nz]"),
    ],
)  # fmt: skip
def test_sums_and_products_of_matrices(entry, text):
    found = diagnosed(entry, text)
    assert found.agrees, str(found)


ROWS = "[(m1+m2)*l1^2 + m2*l2^2 + 2*m2*l1*l2*cos(q2), m2*l2^2 + m2*l1*l2*cos(q2); m2*l2^2 + m2*l1*l2*cos(q2), m2*l2^2]"
REST = f"[-m2*l1*l2*sin(q2)*(2*dq1*dq2 + dq2^2) + {G1}; m2*l1*l2*sin(q2)*dq1^2 + {G2}]"
SOLVED = [
    "M = {M}\nn = {n}\nqdd = inv(M)*(tau - n)",
    "M = {M}\nn = {n}\nqdd = M \\ (tau - n)",
    "M = {M}\nn = {n}\nqdd = np.linalg.solve(M, tau - n)",
    "qdd = inv({M})*([tau1; tau2] - {n})",
]


@pytest.mark.parametrize("text", SOLVED)
def test_accelerations_that_are_solved_for(text):
    """Right ones agree; of wrong ones nothing is named that does not stand there."""
    right = text.format(M=ROWS, n=REST)
    found = diagnosed("forward_dynamics", right)
    assert found.agrees, str(found)
    wrong = diagnosed("forward_dynamics", right.replace("- n)", "+ n)").replace("] - [", "] + ["))
    assert not wrong.agrees
    assert not wrong.causes, str(wrong)


@pytest.mark.parametrize(
    ("text", "said"),
    [
        (r"\begin{bmatrix}1&0\end{bmatrix}\begin{bmatrix}1&0\end{bmatrix}", "has no product"),
        (r"m_2(\begin{bmatrix}1\\0\end{bmatrix}, \begin{bmatrix}1\\1\end{bmatrix})", "in brackets"),
        ("inv([1, 0, 0; 0, 1, 0; 0, 0, 1])*[a; b; c]", "three rows or more"),
        (r"\begin{bmatrix}1\\0\end{bmatrix} \times \begin{bmatrix}1\\0\end{bmatrix}", "beside"),
        (r"\begin{bmatrix}1\\0\end{bmatrix} + \begin{bmatrix}1\\0\\1\end{bmatrix}", "no sum"),
    ],
)
def test_products_that_are_none_are_refused(text, said):
    with pytest.raises(ExpressionError, match=said):
        cells(text)


@pytest.mark.parametrize(
    "piece",
    [
        "\\\\",
        r"\quad ",
        "N m ",
        r"\quad\text{a",
        "= ",
        "x = y = ",
        "  ",
        "\n",
        "diag(",
        r"\,",
        "其中",
        "; a = 1",
        r"\underbrace{",
        r"\underbrace{a}_{b}",
    ],
)
def test_what_is_typed_without_end_is_refused_soon(piece):
    began = time.process_time()
    with pytest.raises(ExpressionError):
        diagnosed("g2", "[" + piece * (15_000 // len(piece)))
    assert time.process_time() - began < 5.0


@pytest.mark.parametrize(
    "text",
    [
        "ab = m2*g*l2; g2 = ab·cos(θ₁+θ₂)",
        "mg = m2*g\ng2 = mg·l₂·cos(θ₁+θ₂)",
        "gl = g*l2; g2 = m_2 gl cos(θ_1+θ_2)",
        "m₂gl₂cos(θ₁+θ₂)",
    ],
)
def test_a_name_that_is_explained_is_no_product_of_its_letters(text):
    assert kl.diagnose("planar2r", "g2", text).agrees


def test_no_name_of_a_robot_is_a_product_of_its_letters():
    """Whatever stands beside it without a sign: ``xt·c₃``."""
    table = kl.load("spatial3r").table
    assert table is not None and "xt" in vocabulary(table).values
    for name in vocabulary(table).values:
        text = f"l₁ + {name}"
        assert name in plain_formula(text).replace(" ", ""), name


# -------- Braces with a remark

FIRST = r"\underbrace{(m_1+m_2) g l_1 c_1}_{\text{link 1}}"


@pytest.mark.parametrize(
    ("entry", "text"),
    [
        ("g2", r"\underbrace{m_2 g l_2 c_{12}}_{\text{gravity} = g_2}"),
        ("g1", rf"{FIRST} + \underbrace{{m_2 g l_2 c_{{12}}}}_\text{{2}}"),
        ("g1", r"g_1 = \underbrace{m_1 g l_1 c_1 + m_2 g l_1 c_1}_{a} + \overbrace{m_2 g l_2 c_{12}}^{g_2}"),
        ("g2", r"m_2 g l_2 \underbrace{(c_1 c_2 - s_1 s_2)}_{c_{12}}"),
        ("g2", r"\underbrace{\underbrace{m_2 g}_{F} l_2}_{a} c_{12}"),
    ],
)  # fmt: skip
def test_braces_with_a_remark_are_left_out(entry, text):
    assert diagnosed(entry, text).agrees
    assert not diagnosed(entry, text.replace("m_2 g", "m_1 g", 1)).agrees


@pytest.mark.parametrize(
    "text",
    [
        r"m_2 g l_2 \underbrace{c_1 c_2 - s_1 s_2}_{c_{12}}",
        r"-\underbrace{m_2 g + m_1}_{a}",
        r"\underbrace{m_2 g}_2 l_2",
        r"\underbrace{m_2 g}_{a}^2 l_2",
        r"\underbrace{m_2 g}^{2} l_2",
    ],
)
def test_braces_around_what_may_be_read_otherwise_are_refused(text):
    with pytest.raises(ExpressionError, match="brace"):
        diagnosed("g2", text)


def test_a_small_space_of_latex_alone_tells_that_it_is() -> None:
    r"""Of ``m_2\,l_2^2`` nothing else is LaTeX's."""
    assert kl.diagnose("planar2r", "M22", r"m_2\,l_2^2").agrees
