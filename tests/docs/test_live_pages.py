"""Live pages of the site: cut out of a notebook's output, sharing their scripts, still whole."""

from __future__ import annotations

import base64
import hashlib
import html
import re
import sys
from pathlib import Path

import pytest

import kinlab as kl

sys.path.insert(0, str(Path(__file__).parents[2] / "docs" / "_ext"))
import live


@pytest.fixture(scope="module")
def shown():
    """What a notebook is given to show."""
    return kl.viewer.Scene("planar2r", [0.3, 0.5])._repr_html_()


def test_what_a_notebook_shows_is_found_and_is_the_page(shown):
    found = live.FRAME.fullmatch(shown)
    assert found
    page = html.unescape(found.group(1))
    assert page.startswith("<!DOCTYPE html>") and page.rstrip().endswith("</html>")


def test_a_page_and_its_shared_scripts_make_the_whole_page_again(shown):
    whole = html.unescape(live.FRAME.fullmatch(shown).group(1))
    page, shared = live.split_page(whole)
    assert len(page) < 0.15 * len(whole)
    assert len(shared) == 2
    for name, script in shared.items():
        assert page.count(f'<script src="{name}"></script>') == 1
        page = page.replace(f'<script src="{name}"></script>', f"<script>{script}</script>")
    policy = r"script-src [^;]*"
    assert re.sub(policy, "", page) == re.sub(policy, "", whole)


def test_the_policy_lets_the_pages_own_script_run_and_no_other(shown):
    page, _ = live.split_page(html.unescape(live.FRAME.fullmatch(shown).group(1)))
    allowed = re.search(r"script-src ([^;]*);", page).group(1).split()
    (own,) = re.findall(r"<script>(.*?)</script>", page, re.DOTALL)
    digest = base64.b64encode(hashlib.sha256(own.encode()).digest()).decode()
    assert allowed == ["'self'", "file:", f"'sha256-{digest}'"]


def test_pages_share_their_scripts_on_disk(shown, tmp_path):
    other = kl.viewer.Scene("planar3r")._repr_html_()
    names = {
        live.write_page(html.unescape(live.FRAME.fullmatch(text).group(1)), tmp_path)
        for text in (shown, other, shown)
    }
    assert len(names) == 2
    assert len(list(tmp_path.iterdir())) == 4
