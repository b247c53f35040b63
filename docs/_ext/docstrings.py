"""Docstrings as they are written: bars, colons and short references mean what their writers mean.

A bar is an absolute value, never reStructuredText's sign; the words before a colon in the text of
an attribute are no type; a reference to a public name is found wherever it is written.
"""

from __future__ import annotations

import inspect
import re
from typing import Any

from docutils import nodes
from sphinx.application import Sphinx
from sphinx.environment import BuildEnvironment
from sphinx.util.inspect import stringify_signature

# literals, which keep their bars, or a bar that is not escaped yet
_BAR = re.compile(r"``.*?``|(?<!\\)\|")
_COLON = "\ue000"  # stands for a colon while napoleon looks for types


def escape_bars(lines: list[str]) -> list[str]:
    """The lines with their bars escaped outside literals and literal blocks."""
    block: int | None = None  # how far the line is indented that opened a literal block
    out = []
    for line in lines:
        depth = len(line) - len(line.lstrip())
        if block is not None and line.strip() and depth <= block:
            block = None
        if block is None:
            line = _BAR.sub(lambda m: m[0] if m[0].startswith("`") else r"\|", line)
            if line.rstrip().endswith("::"):
                block = depth
        out.append(line)
    return out


def before(app: Sphinx, what: str, name: str, obj: Any, options: Any, lines: list[str]) -> None:
    """Hides the colons of attributes from napoleon."""
    if what in ("attribute", "property", "data"):
        lines[:] = [line.replace(":", _COLON) for line in lines]


def after(app: Sphinx, what: str, name: str, obj: Any, options: Any, lines: list[str]) -> None:
    """Escapes bars and brings the colons back."""
    lines[:] = escape_bars([line.replace(_COLON, ":") for line in lines])


def signature(
    app: Sphinx, what: str, name: str, obj: Any, options: Any, args: str, answer: str
) -> tuple[str, str | None] | None:
    """Annotations as the source has them: ``ArrayLike``, not the union that it stands for."""
    call = obj.__init__ if inspect.isclass(obj) else obj
    if what not in ("function", "method", "class") or not args or not callable(call):
        return None
    written = inspect.signature(call)
    parameters = list(written.parameters.values())
    if what != "function" and parameters and parameters[0].name in ("self", "cls"):
        parameters = parameters[1:]
    if what == "class":
        written = written.replace(return_annotation=inspect.Signature.empty)
    head, _, tail = stringify_signature(written.replace(parameters=parameters)).rpartition(" -> ")
    return (head, tail) if head else (tail, None)


def resolve(
    app: Sphinx, env: BuildEnvironment, node: nodes.Element, inner: nodes.Element
) -> nodes.Element | None:
    """A reference to a name of another module: the public name, or the only one that ends so."""
    target = str(node.get("reftarget", ""))
    if node.get("refdomain") != "py" or not target:
        return None
    domain = env.domains.python_domain
    short = target.rpartition(".")[2] if target.startswith("kinlab.") else target
    ends = [name for name in domain.objects if name.endswith(f".{short}")]
    public = [name for name in ends if name == f"kinlab.{short}"]
    if len(full := public or ends) != 1:
        return None
    entry = domain.objects[full[0]]
    uri = app.builder.get_relative_uri(str(node["refdoc"]), entry.docname)
    return nodes.reference("", "", inner, internal=True, refuri=f"{uri}#{entry.node_id}")


def setup(app: Sphinx) -> dict[str, Any]:
    app.connect("autodoc-process-docstring", before, priority=100)
    app.connect("autodoc-process-docstring", after, priority=900)
    app.connect("autodoc-process-signature", signature)
    app.connect("missing-reference", resolve)
    return {"parallel_read_safe": True, "parallel_write_safe": True}
