"""Pages that are made from the project's own data before Sphinx looks for its sources.

A generator is a module of this folder with ``write(docs: Path) -> None``. What it writes goes into
a folder ``generated`` that git ignores.
"""

from __future__ import annotations

from importlib import import_module
from importlib.util import find_spec
from pathlib import Path
from typing import TYPE_CHECKING, Any

if TYPE_CHECKING:  # the generators do without Sphinx, and so do their tests
    from sphinx.application import Sphinx

GENERATORS = (
    "reference_pages",
    "command_pages",
    "note_pages",
    "bench_pages",
    "drawings",
    "robot_pages",
)


def write_all(app: Sphinx) -> None:
    """Calls every generator that is there."""
    for name in GENERATORS:
        if find_spec(name) is not None:
            import_module(name).write(Path(app.srcdir))


def write_if_changed(path: Path, text: str) -> None:
    """Writes a page, unless it stands there already: Sphinx then need not read it again."""
    path.parent.mkdir(parents=True, exist_ok=True)
    if not path.exists() or path.read_text(encoding="utf-8") != text:
        path.write_text(text, encoding="utf-8")


def setup(app: Sphinx) -> dict[str, Any]:
    app.connect("builder-inited", write_all)
    return {"parallel_read_safe": True, "parallel_write_safe": True}
