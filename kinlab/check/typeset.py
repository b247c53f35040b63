"""LaTeX of the records to MathML for a page and to plain LaTeX for Markdown.

A record marks what differs between the printed and the corrected form with ``\\wrong{...}`` and
``\\fixed{...}``.
"""

from __future__ import annotations

import html


def mathml(latex: str) -> str:
    """MathML of one formula; the marked pieces are elements of class wrong and fixed.

    Args:
        latex: from a record. What the converter cannot read is shown as it is written.
    """
    from latex2mathml import exceptions
    from latex2mathml.converter import convert

    failures: list[type[Exception]] = [
        value
        for value in vars(exceptions).values()
        if isinstance(value, type) and issubclass(value, Exception)
    ]
    marked = latex.replace(r"\wrong{", r"\class{wrong}{").replace(r"\fixed{", r"\class{fixed}{")
    try:
        return str(convert(marked, display="block"))
    except (*failures, IndexError, KeyError, ValueError, TypeError):
        return f"<code>{html.escape(latex)}</code>"


def plain(latex: str) -> str:
    """LaTeX that Markdown viewers read, the marked pieces in colour."""
    return latex.replace(r"\wrong{", r"\textcolor{red}{").replace(r"\fixed{", r"\textcolor{green}{")
