"""Each page with code that is run also downloads as a notebook; its link heads the page.

The notebook is the page's text, unexecuted: it runs where kinlab is installed.
"""

from __future__ import annotations

from pathlib import Path
from typing import Any

import nbformat
from docutils import nodes
from jupyter_cache import get_cache
from myst_nb.core.read import is_myst_markdown_notebook, read_myst_markdown_notebook
from sphinx.application import Sphinx

WORDS = {"en": "This page is a notebook:", "zh": "本页也是一个笔记本："}


def as_notebook(text: str, path: str = "") -> nbformat.NotebookNode:
    """A page's text as a notebook of Markdown and code cells."""
    notebook = read_myst_markdown_notebook(text, path=path)
    notebook.metadata = nbformat.from_dict(
        {
            "kernelspec": {"display_name": "Python 3", "language": "python", "name": "python3"},
            "language_info": {"name": "python"},
        }
    )
    for number, cell in enumerate(notebook.cells):
        cell.id = f"cell-{number}"
        cell.metadata.pop("language", None)
    return notebook


def link(app: Sphinx, doctree: nodes.document) -> None:
    """Puts the link under the first title of a page with code cells."""
    name = app.env.docname
    source = Path(app.env.doc2path(name))
    if source.suffix != ".md" or not is_myst_markdown_notebook(source.read_text(encoding="utf-8")):
        return
    target = f"{Path(name).name}.ipynb"
    words = WORDS["zh" if name.startswith("zh/") else "en"]
    reference = nodes.reference("", target, refuri=target, internal=True, classes=["notebook"])
    reference["download"] = target
    line = nodes.paragraph("", "", nodes.Text(words + " "), reference, classes=["notebook-line"])
    for section in doctree.findall(nodes.section):
        section.insert(1, line)
        break
    if not hasattr(app.env, "kinlab_notebooks"):
        app.env.kinlab_notebooks = {}
    app.env.kinlab_notebooks[name] = str(source)


def merge(app: Sphinx, env: Any, _docnames: Any, other: Any) -> None:
    """Takes over what another process has read."""
    del app
    env.kinlab_notebooks = {
        **getattr(env, "kinlab_notebooks", {}),
        **getattr(other, "kinlab_notebooks", {}),
    }


def write(app: Sphinx, error: Exception | None) -> None:
    """Writes the notebooks beside their pages."""
    if error is not None or app.builder.format != "html":
        return
    for name, source in getattr(app.env, "kinlab_notebooks", {}).items():
        if name not in app.env.found_docs:
            continue
        target = Path(app.outdir) / f"{name}.ipynb"
        target.parent.mkdir(parents=True, exist_ok=True)
        notebook = as_notebook(Path(source).read_text(encoding="utf-8"), source)
        nbformat.write(notebook, target)


def one_store(app: Sphinx) -> None:
    """Makes the store of executed pages before the processes that read pages begin.

    Each makes it where it finds none, and of two that find none at once the second fails.
    """
    get_cache(app.config.nb_execution_cache_path).get_cache_limit()


def setup(app: Sphinx) -> dict[str, Any]:
    app.connect("builder-inited", one_store)
    app.connect("doctree-read", link)
    app.connect("env-merge-info", merge)
    app.connect("build-finished", write)
    return {"version": "1", "parallel_read_safe": True, "parallel_write_safe": True}
