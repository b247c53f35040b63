"""Settings of the whole suite."""

from __future__ import annotations

import hypothesis
import pytest

hypothesis.settings.register_profile(
    "kinlab",
    deadline=None,
    derandomize=True,
    database=None,
    suppress_health_check=[hypothesis.HealthCheck.too_slow, hypothesis.HealthCheck.data_too_large],
)
hypothesis.settings.load_profile("kinlab")


def pytest_collection_modifyitems(items):
    """Marks the tests that open a browser, whose arithmetic is its own."""
    for item in items:
        if "chromium" in getattr(item, "fixturenames", ()):
            item.add_marker(pytest.mark.browser)
