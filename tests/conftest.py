"""Settings of the whole suite."""

from __future__ import annotations

import os

import hypothesis
import pytest

os.environ["KINLAB_LANG"] = "en"  # ours and that of all we start, whatever the locale
# workers fill the processors; BLAS's own threads would wait for each other in loops: from a tenth
# to three tenths of the processor's time of the doctor's tests under rounding
os.environ.setdefault("OPENBLAS_NUM_THREADS", "1")

hypothesis.settings.register_profile(
    "kinlab",
    deadline=None,
    derandomize=True,
    database=None,
    suppress_health_check=[hypothesis.HealthCheck.too_slow, hypothesis.HealthCheck.data_too_large],
)
hypothesis.settings.load_profile("kinlab")


@pytest.fixture(autouse=True)
def _faults_are_raised(monkeypatch) -> None:
    """A fault in the search for a cause fails a test: a user is told of it beside the verdict."""
    monkeypatch.setattr("kinlab.doctor.examine.LOUD", True)


def pytest_addoption(parser):
    parser.addoption("--every-case", action="store_true", help="of tests marked many: all cases")


def pytest_configure(config):
    """Who names files, or tests, wants all that they hold; a worker is told by who sent it."""
    if not hasattr(config, "workerinput") and config.args_source is config.ArgsSource.ARGS:
        config.option.every_case = True


def pytest_collection_modifyitems(config, items):
    """Marks the tests that open a browser, whose arithmetic is its own; the files with them first.

    A file stays on one worker, and these are the longest: begun last, they would leave the other
    worker idle. Of a test marked ``many`` the whole suite takes one case; the others are counted as
    deselected.
    """
    long = set()
    for item in items:
        if "chromium" in getattr(item, "fixturenames", ()):
            item.add_marker(pytest.mark.browser)
            long.add(item.path)
    items.sort(key=lambda item: item.path not in long)
    if not config.option.every_case:
        _keep_one_of_many(config, items)


def _keep_one_of_many(config, items):
    begun, kept, others = set(), [], []
    for item in items:
        name = item.nodeid.partition("[")[0]
        again = name in begun and item.get_closest_marker("many")
        (others if again else kept).append(item)
        begun.add(name)
    config.hook.pytest_deselected(items=others)
    items[:] = kept
