"""Formulas as MathML, which every current browser draws by itself: no script, no network.

LaTeX that latex2mathml cannot read is a warning, and so ends a build with ``-W``.
"""

from __future__ import annotations

from html import escape
from typing import Any

from docutils import nodes
from latex2mathml.converter import convert
from sphinx.application import Sphinx
from sphinx.util import logging

logger = logging.getLogger(__name__)


def markup(latex: str, display: str, where: nodes.Element | None = None) -> str:
    """The MathML of a formula; what cannot be read stands as it was typed, with a warning."""
    try:
        return convert(latex, display=display)
    except Exception as problem:  # noqa: BLE001  (latex2mathml raises what it likes)
        logger.warning("formula %r cannot be read: %s", latex, problem, location=where)
        return f"<code>{escape(latex)}</code>"


def inline(self: Any, node: nodes.math) -> None:
    self.body.append(f'<span class="math">{markup(node.astext(), "inline", node)}</span>')
    raise nodes.SkipNode


def block(self: Any, node: nodes.math_block) -> None:
    latex = node.astext().strip()
    parts = [markup(part, "block", node) for part in latex.split("\n\n") if part.strip()]
    self.body.append(f'<div class="math" tabindex="0">{"".join(parts)}</div>\n')
    raise nodes.SkipNode


def setup(app: Sphinx) -> dict[str, Any]:
    app.add_html_math_renderer("mathml", (inline, None), (block, None))
    return {"parallel_read_safe": True, "parallel_write_safe": True}
