"""LaTeX of the records to MathML for a page and to plain LaTeX for Markdown.

A record marks what differs between the printed and the corrected form with ``\\wrong{...}`` and
``\\fixed{...}``.
"""

from __future__ import annotations

import html
import re


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
        return _fenced(convert(marked, display="block"))
    except failures:
        return f"<code>{html.escape(latex)}</code>"


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
