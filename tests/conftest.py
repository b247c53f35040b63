"""Settings of the whole suite."""

from __future__ import annotations

import hypothesis

hypothesis.settings.register_profile(
    "kinlab",
    deadline=None,
    derandomize=True,
    database=None,
    suppress_health_check=[hypothesis.HealthCheck.too_slow, hypothesis.HealthCheck.data_too_large],
)
hypothesis.settings.load_profile("kinlab")
