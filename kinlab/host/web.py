"""What every page we write has in common: a policy that runs our own scripts and no others."""

from __future__ import annotations

import base64
import hashlib
import re
from collections.abc import Sequence
from pathlib import Path
from typing import TYPE_CHECKING

from kinlab.host.language import _, language_tag

if TYPE_CHECKING:
    from jinja2 import Environment

_CONTROL = re.compile("[\x00-\x08\x0b\x0c\x0e-\x1f\x7f-\x9f\ud800-\udfff]")


def policy(scripts: Sequence[str] = (), *, live: bool = False) -> str:
    """The ``<meta>`` element of a content-security policy.

    Args:
        scripts: the texts of the page's inline scripts; nothing else runs, neither another
            script nor a handler in an attribute.
        live: whether the page keeps in touch with the server it comes from.

    Returns:
        HTML for the head of the page, in front of the scripts. Nothing is fetched from anywhere;
        pictures may stand in the page itself.
    """
    digests = (hashlib.sha256(text.encode("utf-8")).digest() for text in scripts)
    allowed = " ".join(f"'sha256-{base64.b64encode(d).decode('ascii')}'" for d in digests)
    own = " 'self'" if live else ""
    rules = [
        "default-src 'none'",
        "script-src " + (allowed or "'none'"),
        "style-src 'unsafe-inline'",
        "img-src data: blob:",
        "font-src data:",
        f"connect-src data: blob:{own}",
        "base-uri 'none'",
        "form-action 'none'",
    ]
    return f'<meta http-equiv="Content-Security-Policy" content="{"; ".join(rules)}">'


def templates(*folders: Path) -> Environment:
    """Templates of pages, looked for in the folders in turn.

    What is put into one is escaped; a name that a template does not know is an error. Every
    template knows ``_`` and ``language_tag``.
    """
    from jinja2 import Environment, FileSystemLoader, StrictUndefined

    made = Environment(
        loader=FileSystemLoader(folders),
        autoescape=True,
        undefined=StrictUndefined,
        trim_blocks=True,
        lstrip_blocks=True,
        keep_trailing_newline=True,
    )
    made.globals |= {"_": _, "language_tag": language_tag}
    return made


def page_text(text: str) -> str:
    """The text of a page without the characters that no page may hold."""
    return _CONTROL.sub("\N{REPLACEMENT CHARACTER}", text)
