"""What a user gets: a light import, a wheel that finds its robots, a clean contract."""

from __future__ import annotations

import json
import subprocess
import sys
import zipfile
from pathlib import Path

ROOT = Path(__file__).resolve().parents[2]
HEAVY = ("yourdfpy", "meshcat", "matplotlib", "sympy", "numba", "scipy", "lxml", "trimesh", "rich")


def run(*arguments, cwd=None):
    return subprocess.run(
        [sys.executable, *arguments], capture_output=True, text=True, cwd=cwd, check=False
    )


def test_import_brings_nothing_heavy():
    code = "import json, sys, kinlab; print(json.dumps(sorted(sys.modules)))"
    loaded = set(json.loads(run("-c", code).stdout))
    assert "kinlab.engine.dynamics" in loaded
    assert loaded.isdisjoint(HEAVY)


def test_import_contract():
    from importlinter.cli import lint_imports

    assert lint_imports(config_filename=str(ROOT / "pyproject.toml"), no_cache=True) == 0


def test_installed_wheel_finds_its_robots(tmp_path):
    """Builds the wheel, unpacks it far from the checkout, and loads a robot from there."""
    built = run("-m", "pip", "wheel", "--no-deps", "--no-build-isolation", "-q",
                "-w", str(tmp_path), str(ROOT))  # fmt: skip
    assert built.returncode == 0, built.stderr
    wheel = next(tmp_path.glob("kinlab-*.whl"))
    site = tmp_path / "site"
    zipfile.ZipFile(wheel).extractall(site)
    for file in ("py.typed", "viewer/page.js", "viewer/page.css"):
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
