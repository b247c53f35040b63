"""What a user gets: a light import, a wheel that finds its robots, a clean contract."""

from __future__ import annotations

import ast
import json
import os
import subprocess
import sys
import zipfile
from importlib import import_module
from pathlib import Path

import pytest

ROOT = Path(__file__).resolve().parents[2]
HEAVY = ("yourdfpy", "meshcat", "matplotlib", "sympy", "numba", "scipy", "lxml", "trimesh", "rich")


def run(*arguments, cwd=None):
    return subprocess.run(
        [sys.executable, *arguments], capture_output=True, text=True, cwd=cwd, check=False
    )


def loaded_by(code):
    code = f"import json, sys, kinlab as kl; {code}; print(json.dumps(sorted(sys.modules)))"
    return set(json.loads(run("-c", code).stdout))


def test_import_brings_nothing_heavy():
    assert "kinlab.errors" in loaded_by("kl.errors")
    assert loaded_by("kl.errors").isdisjoint({*HEAVY, "pinocchio", "numpy"})


def test_the_daily_names_bring_nothing_heavy():
    daily = (
        "kl.load, kl.to_urdf, kl.fk, kl.inverse_dynamics, kl.christoffel, kl.compare, kl.FiveBar"
    )
    loaded = loaded_by(f"{daily}, kl.view, kl.hand_formula, kl.link_poses, kl.to_dh")
    assert "kinlab.engine.dynamics" in loaded
    assert loaded.isdisjoint(HEAVY)


def test_import_takes_a_fifth_of_a_second_at_most():
    code = "import time; t = time.perf_counter(); import kinlab; print(time.perf_counter() - t)"
    assert min(float(run("-c", code).stdout) for _ in range(3)) < 0.2


def stub_names():
    """Public names in the stub, each with the module it is taken from."""
    tree = ast.parse((ROOT / "kinlab" / "__init__.pyi").read_text(encoding="utf-8"))
    nodes = [node for node in tree.body if isinstance(node, ast.ImportFrom)]
    return {alias.asname: (node.module, alias.name) for node in nodes for alias in node.names}


def test_every_public_name_shows_and_is_the_one_of_the_stub():
    import kinlab as kl

    names = stub_names()
    assert {*names, "__version__"} == set(kl.__all__) == set(dir(kl))
    assert len(names) >= 70
    for name, (module, original) in names.items():
        assert name == original
        home = import_module(f"kinlab.{module}" if module else "kinlab")
        assert getattr(kl, name) is getattr(home, name), name
    with pytest.raises(AttributeError, match="no_such_name"):
        kl.no_such_name  # noqa: B018


def test_a_user_s_type_checker_knows_the_types(tmp_path):
    """The whole of a user's view: strict, no configuration, the package seen by its path."""
    (tmp_path / "use.py").write_text(
        "import kinlab as kl\n"
        "reveal_type(kl.diagnose)\n"
        "reveal_type(kl.load('puma560'))\n"
        "robot: str = kl.load('puma560')\n",
        encoding="utf-8",
    )
    done = subprocess.run(
        [sys.executable, "-m", "mypy", "--strict", "--follow-imports=silent", "use.py",
         "--config-file", str(ROOT / "pyproject.toml")],
        cwd=tmp_path, capture_output=True, text=True, check=False,
        env={**os.environ, "MYPYPATH": str(ROOT), "MYPY_CACHE_DIR": str(ROOT / ".mypy_cache")},
    )  # fmt: skip
    lines = done.stdout.splitlines()
    assert "kinlab.check.diagnosis.Diagnosis" in lines[0], done.stdout + done.stderr
    assert 'Revealed type is "kinlab.model.robot.Robot"' in lines[1]
    assert "Incompatible types in assignment" in lines[2]
    assert lines[3].startswith("Found 1 error")


def test_import_contract():
    """In a process of its own: import-linter sets logging up and switches all other loggers off."""
    code = "import sys; from importlinter.cli import lint_imports; "
    code += "sys.exit(lint_imports(config_filename=sys.argv[1], no_cache=True))"
    command = [sys.executable, "-c", code, str(ROOT / "pyproject.toml")]
    done = subprocess.run(command, cwd=ROOT, capture_output=True, text=True, timeout=300)
    assert done.returncode == 0, done.stdout + done.stderr


def test_installed_wheel_finds_its_robots(tmp_path):
    """Builds the wheel, unpacks it far from the checkout, and loads a robot from there."""
    built = run("-m", "pip", "wheel", "--no-deps", "--no-build-isolation", "-q",
                "-w", str(tmp_path), str(ROOT))  # fmt: skip
    assert built.returncode == 0, built.stderr
    wheel = next(tmp_path.glob("kinlab-*.whl"))
    site = tmp_path / "site"
    zipfile.ZipFile(wheel).extractall(site)
    files = (
        "py.typed",
        "__init__.pyi",
        "viewer/page/page.js",
        "viewer/page/page.css",
        "check/report/base.html.j2",
    )
    for file in files:
        assert (site / "kinlab" / file).is_file(), file
    code = (
        f"import sys; sys.path.insert(0, {str(site)!r}); import kinlab as kl\n"
        "r = kl.load('puma560'); print(kl.__file__); print(r.n, r.table.name)"
    )
    result = run("-c", code, cwd=tmp_path)
    assert result.stderr == ""
    assert result.stdout.splitlines()[0].startswith(str(site))
    assert result.stdout.splitlines()[1] == "6 puma560"


def test_every_public_name_is_documented():
    import kinlab as kl

    for name in kl.__all__:
        if name != "__version__":
            assert getattr(kl, name).__doc__, name
