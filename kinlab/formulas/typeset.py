"""Formulas as LaTeX and MathML: the records' own LaTeX, and trees in the order of the writer."""

from __future__ import annotations

import html
import math
import re
from dataclasses import dataclass, field
from fractions import Fraction

from kinlab.formulas import tree
from kinlab.formulas.text import SHORTHAND, base_of
from kinlab.formulas.tree import Node, Path

# -------- LaTeX of the records to MathML for a page and to plain LaTeX for Markdown
# A record marks what differs between the printed and the corrected form with ``\wrong{...}`` and
# ``\fixed{...}``.

_ELEMENT = re.compile(
    r"\{http://www\.w3\.org/1998/Math/MathML\}"
    r"(?:math|mrow|mi|mn|mo|ms|mtext|mspace|msup|msub|msubsup|mfrac|msqrt|mroot|mover|munder"
    r"|munderover|mtable|mtr|mtd|mfenced|mpadded|mphantom|mstyle|menclose)"
)
_ATTRIBUTE = re.compile(
    "class|display|displaystyle|scriptlevel|mathvariant|mathcolor|stretchy|fence|form|separator"
    "|accent|accentunder|width|height|depth|lspace|rspace|linethickness|minsize|maxsize|largeop"
    "|movablelimits|symmetric|columnalign|rowspacing|columnspacing|columnlines|rowlines|open|close"
)


def mathml(latex: str) -> str:
    """MathML of one formula; the marked pieces are elements of class wrong and fixed.

    Args:
        latex: from a record. What the converter cannot read is shown as it is written.
    """
    from latex2mathml import exceptions
    from latex2mathml.converter import convert

    failures: tuple[type[Exception], ...] = (IndexError, KeyError, ValueError, TypeError)
    failures += tuple(
        value
        for value in vars(exceptions).values()
        if isinstance(value, type) and issubclass(value, Exception)
    )
    marked = latex.replace(r"\wrong{", r"\class{wrong}{").replace(r"\fixed{", r"\class{fixed}{")
    try:
        return _sound(_fenced(convert(marked, display="block")))
    except failures:
        return f"<code>{html.escape(latex)}</code>"


def _sound(text: str) -> str:
    """The text, written anew from its elements, where these are of mathematics and no others.

    The converter passes on what stands in ``\\text{...}``; a script there would run.

    Raises:
        ValueError: it holds anything else.
    """
    from lxml import etree

    parser = etree.XMLParser(
        resolve_entities=False, no_network=True, remove_comments=True, remove_pis=True
    )
    try:
        root = etree.fromstring(text.encode("utf-8"), parser)
    except etree.XMLSyntaxError:
        raise ValueError("not XML") from None
    for element in root.iter():
        if not isinstance(element.tag, str) or not _ELEMENT.fullmatch(element.tag):
            raise ValueError("not mathematics")
        if not all(_ATTRIBUTE.fullmatch(key) for key in element.attrib):
            raise ValueError("an attribute that mathematics has not")
    written: str = etree.tostring(root, encoding="unicode")
    return written


def _fenced(text: str) -> str:
    """Gives large parentheses and brackets to the style sheet.

    A browser stretches them only with a mathematical font, which many machines lack.
    """
    text = re.sub(
        r"<mo>&#x00028;</mo><mtable>(.*?</mtable>)<mo>&#x00029;</mo>",
        r'<mtable class="round">\1',
        text,
    )
    grow = '<mo stretchy="true" fence="true" form='
    for name, opening, closing in (("round", "&#x00028;", "&#x00029;"), ("square", "[", "]")):
        text = text.replace(f'<mrow>{grow}"prefix">{opening}</mo>', f'<mrow class="{name}">')
        text = text.replace(f'{grow}"postfix">{closing}</mo></mrow>', "</mrow>")
    return text


def plain(latex: str) -> str:
    """LaTeX that Markdown viewers read, the marked pieces in colour."""
    return latex.replace(r"\wrong{", r"\textcolor{red}{").replace(r"\fixed{", r"\textcolor{green}{")


# -------- Formula trees as LaTeX, in the order the writer chose

_LINE = 76
"""Visible characters of one line of a long sum."""

_LETTERS = (
    "alpha beta gamma delta epsilon zeta eta theta lambda mu nu xi rho sigma tau phi psi omega pi"
)
_GREEK = set(_LETTERS.split())
_WORST = "Thetad"
"""The largest rate of a five-bar's cranks, as note 003 writes it."""
_PI, _PARTS = Fraction(repr(math.pi)), 12
"""Pi as it is read, and into how many parts of it a number may fall."""
_JOINT = re.compile(r"(d{0,2})(theta|th|q)(d{1,2}(?![a-z])|_?dot|_?ddot)?_?([1-9]\d?)?")
_NAMED = {
    "asin": r"\arcsin",
    "acos": r"\arccos",
    "atan": r"\arctan",
    "log": r"\ln",
    "atan2": r"\operatorname{atan2}",
    "sign": r"\operatorname{sign}",
    "exp": r"\exp",
    "abs": r"\operatorname{abs}",
}


@dataclass(frozen=True)
class Marks:
    """Pieces to stand out.

    Attributes:
        command: what wraps them: ``"wrong"`` or ``"fixed"``.
        paths: where they are.
    """

    command: str = "wrong"
    paths: frozenset[Path] = field(default_factory=frozenset)


def equation(name: str, formula: Node, marks: Marks | None = None) -> tuple[str, str]:
    """A name and its formula as LaTeX; long sums are broken into lines.

    Args:
        name: such as ``"tau1"`` or ``"fk[0,3]"``.
        formula: its tree.
        marks: pieces to stand out.
    """
    marks = marks or Marks()
    terms = formula.args if formula.op == "add" and () not in marks.paths else ()
    if not terms:
        return symbol(name), latex(formula, marks)
    lines: list[str] = [""]
    used = 0
    for k, term in enumerate(terms):
        piece = _joined(term, marks, (k,))
        length = _visible(piece)
        if used and used + length > _LINE:
            lines.append("")
            used = 0
        lines[-1] += piece
        used += length
    if len(lines) == 1:
        return symbol(name), lines[0].strip()
    rows = r" \\ {} ".join(line.strip() for line in lines)
    return symbol(name), rf"\begin{{array}}{{l}} {rows} \end{{array}}"


def symbol(name: str) -> str:
    """A name as LaTeX: ``qdd1`` is \\ddot{q}_{1}, ``lc2`` is l_{c2}, ``c12`` is c_{12}."""
    joint = _JOINT.fullmatch(name)
    if joint:
        before, letter, after, index = joint.groups()
        dots = max(len(before), (after or "").replace("dot", "d").strip("_").count("d"))
        base = "q" if letter == "q" else r"\theta"
        dotted = {0: base, 1: rf"\dot{{{base}}}", 2: rf"\ddot{{{base}}}"}[dots]
        return f"{dotted}_{{{index}}}" if index else dotted
    if name.startswith(_WORST):
        return rf"\dot{{\Theta}}_{{{name.removeprefix(_WORST).replace('_', '')}}}"
    if name in ("det", "det J"):
        return rf"\{name}"
    short = SHORTHAND.fullmatch(name)
    if short:
        return f"{short.group(1)}_{{{short.group(2)}}}"
    if "[" in name:
        plain, inside = name.rstrip("]").split("[", 1)
        plain = plain.replace("_", r"\_")
        return rf"\text{{{plain}}}[{inside}]"
    if base := base_of(name):
        return f"{symbol(base)}^{{2}}"
    head, index = re.fullmatch(r"(.*?)_?(\d*)", name).groups()  # type: ignore[union-attr]
    head, _, rest = head.partition("_")
    if head in _GREEK:
        head = rf"\{head}"
    elif len(head) > 3 or (rest and len(head) > 1):
        head = rf"\mathrm{{{head}}}"
    elif len(head) > 1:
        head, rest = head[0], head[1:] + rest
    below = rest.replace("_", "") + index
    return f"{head}_{{{below}}}" if below else head


def latex(node: Node, marks: Marks | None = None, path: Path = ()) -> str:
    """A tree as LaTeX.

    Args:
        node: the tree.
        marks: pieces to stand out, by path from the root.
        path: where this node is in the whole.
    """
    marks = marks or Marks()
    text = _plain(node, marks, path)
    if path in marks.paths:
        return rf"\{marks.command}{{{text}}}"
    return text


def _plain(node: Node, marks: Marks, path: Path) -> str:
    if node.op == "num":
        return _number(node.value)
    if node.op == "sym":
        return symbol(str(node.value))
    children = [(child, (*path, k)) for k, child in enumerate(node.args)]
    if node.op == "add":
        return "".join(_joined(child, marks, at) for child, at in children).strip()
    if node.op == "mul":
        return _product(children, marks)
    if node.op == "pow":
        return _power(node, marks, path)
    inside = ", ".join(latex(child, marks, at) for child, at in children)
    name = _NAMED.get(node.op, rf"\{node.op}")
    return rf"{name}({inside})"


def _joined(term: Node, marks: Marks, path: Path) -> str:
    """A term of a sum with the sign that joins it to the one before; a mark takes the sign in."""
    body = _plain(term, marks, path)
    if body.startswith("-"):
        body = body if path[-1] == 0 else f" - {body[1:].lstrip()}"
    elif path[-1] > 0:
        body = f" + {body}"
    return rf" \{marks.command}{{{body.strip()}}}" if path in marks.paths else body


def _product(children: list[tuple[Node, Path]], marks: Marks) -> str:
    sign, above, below = "", [], []
    for child, at in children:
        if child.op == "num" and child.value < 0 and at not in marks.paths:
            sign = "-"
            if child.value == -1:
                continue
            child = tree.num(-child.value)
        if child.op == "pow" and child.value == -1 and at not in marks.paths:
            below.append(latex(child.args[0], marks, (*at, 0)))
        else:
            above.append(_wrapped(child, marks, at, ("add",)))
    text = r" \, ".join(above) or "1"
    if below:
        text = rf"\frac{{{text}}}{{{' '.join(below)}}}"
    return f"{sign}{text}"


def _power(node: Node, marks: Marks, path: Path) -> str:
    base, at = node.args[0], (*path, 0)
    exponent: Fraction = node.value
    if exponent == Fraction(1, 2):
        return rf"\sqrt{{{latex(base, marks, at)}}}"
    if exponent == -1:
        return rf"\frac{{1}}{{{latex(base, marks, at)}}}"
    shown = _number(exponent)
    if base.op in ("sin", "cos", "tan") and at not in marks.paths:
        return rf"\{base.op}^{{{shown}}}({latex(base.args[0], marks, (*at, 0))})"
    return f"{_wrapped(base, marks, at, ('add', 'mul', 'pow', 'num'))}^{{{shown}}}"


def _wrapped(node: Node, marks: Marks, path: Path, ops: tuple[str, ...]) -> str:
    text = latex(node, marks, path)
    return f"({text})" if node.op in ops and not (node.op == "num" and node.value >= 0) else text


def _number(value: Fraction) -> str:
    part = value / _PI
    if part and part.denominator <= _PARTS:
        return _of_pi(part)
    text = tree.to_text(tree.num(value))
    sign, text = ("-", text[1:]) if text.startswith("-") else ("", text)
    if "/" in text:
        above, below = text.split("/")
        return rf"{sign}\frac{{{above}}}{{{below}}}"
    mantissa, _, exponent = text.partition("e")
    if exponent:
        return rf"{sign}{mantissa} \cdot 10^{{{int(exponent)}}}"
    return sign + text


def _of_pi(part: Fraction) -> str:
    """A part of pi, or a multiple."""
    above = rf"{abs(part.numerator)} \pi" if abs(part.numerator) > 1 else r"\pi"
    shown = above if part.denominator == 1 else rf"\frac{{{above}}}{{{part.denominator}}}"
    return f"-{shown}" if part < 0 else shown


def _visible(text: str) -> int:
    """About how many characters wide LaTeX will be."""
    text = re.sub(r"\\(?:dot|ddot|wrong|fixed|mathrm|frac|operatorname|,)", "", text)
    text = re.sub(r"\\(sin|cos|tan|exp|ln)", r"\1", text)
    text = re.sub(r"\\[a-z]+", "x", text)
    return len(re.sub(r"[{}_^\s]", "", text))
