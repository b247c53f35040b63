"""A real browser for the viewer's tests: Debian's Chromium, driven by Playwright.

Locally the tests that need it skip where it is missing; in CI that is a failure.
"""

from __future__ import annotations

import os
import shutil
import time

import numpy as np
import pytest

FLAGS = ("--use-angle=swiftshader", "--enable-unsafe-swiftshader", "--no-sandbox")
NAMES = ("chromium", "chromium-browser", "google-chrome")


def missing(what: str) -> None:
    """Skips here, fails in CI."""
    if os.environ.get("CI") == "true":
        pytest.fail(f"{what} is missing, and CI must not skip the browser tests")
    pytest.skip(f"{what} is missing")


@pytest.fixture(scope="module")
def chromium():
    """One headless browser for a file of tests."""
    try:
        from playwright.sync_api import sync_playwright
    except ImportError:
        missing("the Python package playwright")
    executable = next(filter(None, map(shutil.which, NAMES)), None)
    if executable is None:
        missing(f"a browser ({', '.join(NAMES)})")
    with sync_playwright() as playwright:
        browser = playwright.chromium.launch(executable_path=executable, args=list(FLAGS))
        yield browser
        browser.close()


@pytest.fixture
def tab(chromium):
    """A page that must not report an error, nor fetch anything but itself."""
    page = chromium.new_page(viewport={"width": 600, "height": 400})
    page.errors, page.asked = [], []
    page.on("console", lambda m: page.errors.append(m.text) if m.type == "error" else None)
    page.on("pageerror", lambda problem: page.errors.append(str(problem)))
    page.on("request", lambda request: page.asked.append(request.url))
    yield page
    page.close()
    assert page.errors == []


def open_file(tab, scene, folder):
    """Saves a scene, opens the file, and waits until it is drawn."""
    path = folder / "page.html"
    scene.save(path)
    tab.goto(path.as_uri())
    return ready(tab)


def ready(tab):
    """Waits until our script has started and the first frame is on the screen."""
    wait_until(tab, "window.page && !viewer.needs_render")
    return tab


def wait_until(tab, expression, seconds=30.0):
    """Waits until an expression is true in the page.

    Playwright's own way evaluates text within the page, which the page's policy forbids.
    """
    end = time.monotonic() + seconds
    while not _true(tab, expression):
        assert time.monotonic() < end, f"{expression} stayed false"
        tab.wait_for_timeout(20)


def _true(tab, expression):
    try:
        return tab.evaluate(f"() => Boolean({expression})")
    except Exception as problem:
        if "context was destroyed" in str(problem):  # the page is loading itself anew
            return False
        raise


def world(tab, path):
    """Pose of a node in the base, as three.js computed it, (4, 4)."""
    columns = tab.evaluate(
        """path => {
          viewer.scene.updateMatrixWorld(true);
          const scene = viewer.scene.matrixWorld.clone().invert();
          return scene.multiply(kinlab.node(path).matrixWorld).toArray();
        }""",
        path,
    )
    return np.array(columns).reshape(4, 4).T


def slide(tab, joint, value):
    """Moves a slider as a hand does: sets it and fires the event."""
    tab.evaluate(
        """([joint, value]) => {
          const range = document.querySelectorAll('.joint input[type=range][aria-label]');
          const sliders = [...range].filter(r => r.id !== 'scrub');
          sliders[joint].value = value;
          sliders[joint].dispatchEvent(new Event('input'));
        }""",
        [joint, value],
    )
