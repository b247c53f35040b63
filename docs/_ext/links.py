"""Links inside the built site: each leads to a file, and to a place in it, or is a warning."""

from __future__ import annotations

from collections.abc import Iterator
from functools import cache
from pathlib import Path
from typing import Any
from urllib.parse import unquote, urlsplit

from lxml import html
from sphinx.application import Sphinx
from sphinx.util import logging

logger = logging.getLogger(__name__)


def broken(root: Path) -> Iterator[tuple[Path, str]]:
    """The page and the link of everything that leads nowhere within the site."""

    @cache
    def places(path: Path) -> set[str]:
        tree = html.parse(str(path))
        return {*tree.xpath("//@id"), *tree.xpath("//a/@name")}

    for page in sorted(root.rglob("*.html")):
        if page.relative_to(root).parts[0] in ("_static", "_modules"):
            continue  # a viewer's page makes its own links
        tree = html.parse(str(page))
        for link in tree.xpath("//a/@href | //img/@src | //iframe/@src | //script/@src"):
            target = urlsplit(str(link))
            if target.scheme or target.netloc:
                continue
            path = (page.parent / unquote(target.path)).resolve() if target.path else page
            if path.is_dir():
                path = path / "index.html"
            place = unquote(target.fragment) if path.suffix == ".html" else ""
            if not path.exists() or (place and place not in places(path)):
                yield page.relative_to(root), str(link)


def elsewhere(root: Path) -> Iterator[tuple[Path, str]]:
    """What a page would fetch from another host when it is opened."""
    for page in sorted(root.rglob("*.html")):
        tree = html.parse(str(page))
        wanted = "//img/@src | //iframe/@src | //script/@src | //link[@rel='stylesheet']/@href"
        for link in tree.xpath(wanted):
            if urlsplit(str(link)).netloc:
                yield page.relative_to(root), str(link)


def check(app: Sphinx, error: Exception | None) -> None:
    """Warns of what is broken, and of what would be fetched."""
    if error is not None or app.builder.name != "html":
        return
    root = Path(app.outdir)
    for page, link in broken(root):
        logger.warning("%s: %s leads nowhere", page, link)
    for page, link in elsewhere(root):
        logger.warning("%s: fetches %s when it is opened", page, link)


def setup(app: Sphinx) -> dict[str, Any]:
    app.connect("build-finished", check, priority=900)  # the notebooks are written by then
    return {"parallel_read_safe": True, "parallel_write_safe": True}
