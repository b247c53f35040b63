"""What is imported is declared, and no module reaches round to itself, not even by a string."""

from __future__ import annotations

import ast
import re
import sys
import tomllib
from collections.abc import Iterator
from functools import cache
from importlib.metadata import distributions
from pathlib import Path

ROOT = Path(__file__).resolve().parents[2]
PACKAGE = ROOT / "kinlab"
PROJECT = tomllib.loads((ROOT / "pyproject.toml").read_text(encoding="utf-8"))["project"]


def module_of(path: Path) -> str:
    parts = path.relative_to(ROOT).with_suffix("").parts
    return ".".join(parts[:-1] if parts[-1] == "__init__" else parts)


@cache
def trees() -> dict[str, ast.Module]:
    return {
        module_of(path): ast.parse(path.read_text(encoding="utf-8"))
        for path in sorted(PACKAGE.rglob("*.py"))
    }


PACKAGES = {module_of(path) for path in PACKAGE.rglob("__init__.py")}


def canonical(name: str) -> str:
    return re.sub(r"[-_.]+", "-", name).lower()


def declared(requirements: list[str]) -> set[str]:
    found = (re.match(r"[A-Za-z0-9._-]+", one) for one in requirements)
    return {canonical(one.group()) for one in found if one}


def imports(tree: ast.AST, late: bool = False) -> Iterator[tuple[str, bool]]:
    """Every imported module, and whether the import waits inside a function."""
    for node in ast.iter_child_nodes(tree):
        if isinstance(node, ast.Import):
            yield from ((alias.name, late) for alias in node.names)
        elif isinstance(node, ast.ImportFrom):
            assert not node.level, "relative imports are not read here"
            yield str(node.module), late
        else:
            inside = isinstance(node, ast.FunctionDef | ast.AsyncFunctionDef)
            yield from imports(node, late or inside)


@cache
def owners() -> dict[str, set[str]]:
    """Installed distributions by the names they let one import."""
    found: dict[str, set[str]] = {}
    # Pinocchio's wheels keep their packages in a second site-packages of their own
    top = re.compile(r"^(?:[^,\n]*/site-packages/)?(\w+)(?:/|\.py,|\.[^/,\n]*\.so,)", re.MULTILINE)
    for dist in distributions():
        for name in set(top.findall(dist.read_text("RECORD") or "")):
            found.setdefault(name, set()).add(canonical(dist.metadata["Name"]))
    return found


def undeclared(read: dict[str, ast.Module], required: set[str], optional: set[str]) -> list[str]:
    """Third-party imports that nothing declares, or that an extra does but are not lazy."""
    found = set()
    for module, tree in read.items():
        for name, late in imports(tree):
            top = name.split(".")[0]
            if top == "kinlab" or top in sys.stdlib_module_names:
                continue
            dists = owners().get(top, set())
            if not dists & (required | optional if late else required):
                found.add(f"{module}: {top} of {sorted(dists) or 'nobody'}")
    return sorted(found)


REQUIRED = declared(PROJECT["dependencies"])
EXTRAS = {
    one
    for name in ("plots", "dask", "motion", "dataframes")
    for one in declared(PROJECT["optional-dependencies"][name])
}


def test_every_import_is_declared():
    assert undeclared(trees(), REQUIRED, EXTRAS) == []


def test_the_scan_sees_what_is_not_declared():
    late = ast.parse(
        "def f():\n    if True:\n        import matplotlib.figure\n        import lxml"
    )
    at_once = ast.parse("from matplotlib import figure\nimport numpy, no_such_package")
    assert undeclared({"one": late}, {"numpy"}, {"matplotlib"}) == ["one: lxml of ['lxml']"]
    assert undeclared({"two": at_once}, {"numpy"}, {"matplotlib"}) == [
        "two: matplotlib of ['matplotlib']", "two: no_such_package of nobody"
    ]  # fmt: skip


BINDS_FUNCTIONS = {"kinlab.fivebar.linkage"}
"""Modules of a class that binds functions as methods; the functions know it by its type only."""


def types_only(tree: ast.AST) -> set[int]:
    """Imports under ``if TYPE_CHECKING``, which never run, by identity."""
    blocks = [n for n in ast.walk(tree) if isinstance(n, ast.If)]
    guarded = [b for b in blocks if ast.unparse(b.test) == "TYPE_CHECKING"]
    return {id(node) for block in guarded for line in block.body for node in ast.walk(line)}


def reached(tree: ast.AST) -> set[str]:
    """kinlab modules that a module imports, or names in a string for a later import."""
    found, guarded = set(), types_only(tree)
    for node in ast.walk(tree):
        if isinstance(node, ast.ImportFrom) and node.module:
            if id(node) in guarded and node.module in BINDS_FUNCTIONS:
                continue
            children = {f"{node.module}.{alias.name}" for alias in node.names}
            found |= children if children <= trees().keys() else {node.module, *children}
        elif isinstance(node, ast.Import):
            found |= {alias.name for alias in node.names}
        elif isinstance(node, ast.Constant) and isinstance(node.value, str):
            # a package's name in a string asks for a file in it
            found |= {node.value} - PACKAGES
    return {name for name in found if name in trees() and name.count(".")}


def circle(edges: dict[str, set[str]]) -> list[str]:
    """One circle of the graph, or nothing."""
    done: set[str] = set()

    def walk(node: str, way: list[str]) -> list[str]:
        if node in way:
            return [*way[way.index(node) :], node]
        if node in done:
            return []
        for child in sorted(edges.get(node, ())):
            if found := walk(child, [*way, node]):
                return found
        done.add(node)
        return []

    return next((found for node in sorted(edges) if (found := walk(node, []))), [])


def test_no_module_reaches_itself():
    # kinlab/__init__ names its public names' modules, all of which lie below it
    edges = {module: reached(tree) - {module} for module, tree in trees().items() if "." in module}
    assert circle(edges) == []
    assert circle({"a": {"b"}, "b": {"c"}, "c": {"b"}}) == ["b", "c", "b"]


def test_an_import_for_types_only_is_left_out_of_one_class_alone():
    guard = "if TYPE_CHECKING:\n    from kinlab.fivebar.{0} import X"
    assert reached(ast.parse(guard.format("linkage"))) == set()
    assert reached(ast.parse(guard.format("metrics"))) == {"kinlab.fivebar.metrics"}
    runs = ast.parse("from kinlab.fivebar.linkage import X")
    assert reached(runs) == {"kinlab.fivebar.linkage"}
