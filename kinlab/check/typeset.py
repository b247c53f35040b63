"""LaTeX of the records to MathML for a page and to plain LaTeX for Markdown.

A record marks what differs between the printed and the corrected form with ``\\wrong{...}`` and
``\\fixed{...}``.
"""

from __future__ import annotations

import html
import re

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
    for name, opening, closing in (
        ("round", "&#x00028;", "&#x00029;"),
        ("square", "[", "]"),
    ):
        text = text.replace(f'<mrow>{grow}"prefix">{opening}</mo>', f'<mrow class="{name}">')
        text = text.replace(f'{grow}"postfix">{closing}</mo></mrow>', "</mrow>")
    return text


def plain(latex: str) -> str:
    """LaTeX that Markdown viewers read, the marked pieces in colour."""
    return latex.replace(r"\wrong{", r"\textcolor{red}{").replace(r"\fixed{", r"\textcolor{green}{")
