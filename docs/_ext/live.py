"""Live viewer pages in the built site: what a notebook shows inline becomes a page of its own.

A cell of a tutorial ends in the plain call, ``kl.view("puma560")``. In Jupyter that shows the
viewer's page inside the cell, as ``<iframe srcdoc="...">``, nearly a megabyte each. Here every
such frame, from whatever source it comes, is cut out: its page is written to ``_static/live``,
named by its own digest, the viewer's two scripts stand there once for all pages, and the frame
points to the file. Nothing else changes, so a downloaded notebook shows the same page inline.

A generator of pages that draws a scene writes ``scene._repr_html_()`` into a raw block of HTML.
"""

from __future__ import annotations

import base64
import hashlib
import html
import re
from pathlib import Path
from typing import TYPE_CHECKING, Any

if TYPE_CHECKING:  # the tests of what is cut out do without Sphinx
    from docutils import nodes
    from sphinx.application import Sphinx

FRAME = re.compile(r'<iframe srcdoc="([^"]*)"[^>]*></iframe>')
_SCRIPT = re.compile(r"<script>(.*?)</script>", re.DOTALL)
_SHARED = ("meshcat.js", "page.js")
"""Names of the page's first two scripts, which are the same in every page; the third is its own."""

_SHOWN = """<figure class="live">
<iframe src="{url}" title="{title}" loading="lazy"
 style="width:100%;height:600px;border:1px solid rgba(128,128,128,.4);border-radius:6px"></iframe>
<figcaption style="font-size:.8em;text-align:right"><a href="{url}">{words}</a></figcaption>
</figure>"""
_WORDS = {"en": "This page by itself", "zh": "单独打开此页面"}


def split_page(text: str) -> tuple[str, dict[str, str]]:
    """The page with links to the shared scripts in place of their text, and these scripts.

    The page's policy lets through scripts by their digests: those of the shared scripts give way
    to "from where the page is from", in a browser's terms ``'self'``, or ``file:`` on a disk.

    Args:
        text: a page of :func:`kinlab.viewer.page.static_page.page_html`.

    Returns:
        The page and the text of each script by file name.

    Raises:
        ValueError: a page of another build.
    """
    scripts = _SCRIPT.findall(text)
    if len(scripts) != len(_SHARED) + 1:
        raise ValueError(f"a viewer's page has three scripts, this one has {len(scripts)}")
    shared: dict[str, str] = {}
    for name, script in zip(_SHARED, scripts, strict=False):
        raw = hashlib.sha256(script.encode("utf-8"))
        digest = f"'sha256-{base64.b64encode(raw.digest()).decode('ascii')}'"
        if digest not in text:
            raise ValueError(f"the page's policy does not name the digest of {name}")
        text = text.replace(digest, "'self' file:" if name == _SHARED[0] else "", 1)
        file = name.replace(".", f"-{raw.hexdigest()[:8]}.")
        text = text.replace(f"<script>{script}</script>", f'<script src="{file}"></script>', 1)
        shared[file] = script
    return text, shared


def write_page(text: str, folder: Path) -> str:
    """Writes a viewer's page, and the shared scripts where they are missing.

    Args:
        text: a page of :func:`kinlab.viewer.page.static_page.page_html`.
        folder: where the pages stand.

    Returns:
        The page's file name.
    """
    page, shared = split_page(text)
    folder.mkdir(parents=True, exist_ok=True)
    name = hashlib.sha256(page.encode("utf-8")).hexdigest()[:12] + ".html"
    for file, content in {**shared, name: page}.items():
        if not (folder / file).exists():
            (folder / file).write_text(content, encoding="utf-8", newline="\n")
    return name


def _cut_out(app: Sphinx, doctree: nodes.document) -> None:
    from docutils import nodes

    docname = app.env.docname
    up = "../" * docname.count("/")
    words = _WORDS["zh" if docname.startswith("zh/") else "en"]

    def linked(found: re.Match[str]) -> str:
        text = html.unescape(found.group(1))
        title = re.search(r"<title>(.*?)</title>", text, re.DOTALL)
        name = write_page(text, Path(app.outdir) / "_static" / "live")
        return _SHOWN.format(
            url=f"{up}_static/live/{name}",
            title=title.group(1) if title else "kinlab",
            words=words,
        )

    for node in doctree.findall(nodes.raw):
        if node.get("format") == "html" and "<iframe srcdoc=" in node.astext():
            shown = FRAME.sub(linked, node.astext())
            node.rawsource, node.children = shown, []
            node += nodes.Text(shown)


def setup(app: Sphinx) -> dict[str, Any]:
    """Sphinx calls this."""
    app.connect("doctree-read", _cut_out)
    return {"version": "1", "parallel_read_safe": True, "parallel_write_safe": True}
