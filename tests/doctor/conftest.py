"""What several tests of the doctor are given."""

from __future__ import annotations

import pytest

from kinlab.doctor.program import words


@pytest.fixture
def without_lines(monkeypatch) -> None:
    """No function's lines can be read: what is then told of it."""
    monkeypatch.setattr(words, "read", lambda _function: None)
