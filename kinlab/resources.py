"""Where the robots that kinlab ships lie: inside the wheel, or beside the package in a checkout."""

from __future__ import annotations

from pathlib import Path

_PACKAGE = Path(__file__).resolve().parent


def robots_dir() -> Path:
    """The folder of the shipped DH tables (``*.toml``)."""
    shipped = _PACKAGE / "robots"
    return shipped if shipped.is_dir() else _PACKAGE.parent / "robots"
