"""The live page: loopback only, keeps its scene, ends cleanly."""

from __future__ import annotations

import contextlib
import os
import re
import signal
import socket
import subprocess
import sys
import time
import urllib.error
import urllib.request
from pathlib import Path

import numpy as np
import pytest
from browser import chromium, ready, slide, tab, wait_until, world  # noqa: F401

import kinlab as kl
from kinlab.errors import OptionError
from kinlab.viewer.scene import Scene

ROOT = Path(__file__).resolve().parents[2]


def listening(pid):
    """Addresses on which a process listens, from the kernel's own tables."""
    inodes = set()
    for entry in Path(f"/proc/{pid}/fd").iterdir():
        with contextlib.suppress(FileNotFoundError):  # closed since the folder was read
            found = re.fullmatch(r"socket:\[(\d+)\]", str(entry.readlink()))
            if found:
                inodes.add(found[1])
    addresses = []
    for table, family in (("tcp", socket.AF_INET), ("tcp6", socket.AF_INET6)):
        file = Path(f"/proc/{pid}/net/{table}")
        if not file.exists():
            continue
        for line in file.read_text().splitlines()[1:]:
            words = line.split()
            if words[3] == "0A" and words[9] in inodes:
                raw = bytes.fromhex(words[1].split(":")[0])
                parts = [raw[i : i + 4][::-1] for i in range(0, len(raw), 4)]
                addresses.append(socket.inet_ntop(family, b"".join(parts)))
    return addresses


@pytest.fixture
def scene():
    return Scene(kl.load("planar3r"))


@pytest.fixture
def server(scene):
    running = scene.serve(port=0)
    yield running
    running.stop()


def test_only_loopback_listens(server):
    assert urllib.request.urlopen(server.url).status == 200
    assert "127.0.0.1" in listening(os.getpid())
    assert set(listening(os.getpid())) <= {"127.0.0.1"}


def test_a_taken_port_moves_on(scene, server):
    second = scene.serve(port=server.port)
    try:
        assert server.port < second.port <= server.port + 50
    finally:
        second.stop()


def test_impossible_addresses(scene):
    with pytest.raises(OptionError, match="port 70000"):
        scene.serve(port=70000)
    with pytest.raises(OptionError, match=r"cannot listen on 192\.0\.2\.1"):
        scene.serve(host="192.0.2.1", port=0)


def test_stop_frees_the_port(scene):
    server = scene.serve(port=0)
    server.stop()
    with pytest.raises(urllib.error.URLError):
        urllib.request.urlopen(server.url, timeout=2)
    again = scene.serve(port=server.port)
    assert again.port == server.port
    again.stop()


def test_sliders_and_script_share_one_scene(tab, scene, server):  # noqa: F811
    robot = scene.robot
    page = tab
    page.goto(server.url)
    ready(page)
    for joint in range(robot.n):
        slide(page, joint, 0.2 + 0.1 * joint)
    q = np.array([0.2, 0.3, 0.4])
    tool = "/meshcat/robot/joint_1/joint_2/joint_3/dh/tool_frame"
    assert np.abs(world(page, tool) - kl.fk(robot, q)).max() < 1e-9
    wait_for(lambda: np.array_equal(scene.q, q))
    page.reload()  # closed and opened again: as it was
    ready(page)
    assert page.evaluate("page.q") == q.tolist()
    scene.show([-0.5, 0.6, 0.7])  # the script moves it
    wait_until(page, "page.q[0] === -0.5")
    assert np.abs(world(page, tool) - kl.fk(robot, [-0.5, 0.6, 0.7])).max() < 1e-9
    scene.path("line", [[0, 0, 0], [1, 0, 0], [1, 1, 0]])  # and adds to it
    wait_until(page, "kinlab.node('/meshcat/added/line').children.length > 0")
    scene.frame("goal", np.eye(4))
    # the page loads itself anew for a label; it comes back where it was
    wait_until(
        page, "document.body.innerText.includes('goal') && window.page && page.q[0] === -0.5"
    )


def test_a_slide_before_the_server_is_there_is_not_lost(tab, scene, server):  # noqa: F811
    tab.add_init_script(
        "addEventListener('DOMContentLoaded', () => page.setJoints([0.7, 0.8, 0.9]))"
    )
    tab.goto(server.url)
    wait_for(lambda: np.array_equal(scene.q, [0.7, 0.8, 0.9]))


def test_page_says_when_its_server_has_ended(chromium, scene):  # noqa: F811
    server = scene.serve(port=0)
    page = chromium.new_page()
    page.goto(server.url)
    ready(page)
    assert page.locator("#ended").is_hidden()
    server.stop()
    page.locator("#ended").wait_for(state="visible")
    slide(page, 0, 0.4)
    assert page.evaluate("page.q[0]") == 0.4
    page.close()


@pytest.mark.parametrize("number", [signal.SIGINT, signal.SIGTERM])
def test_command_serves_and_ends_cleanly(number):
    command = [sys.executable, "-m", "kinlab", "view", "planar2r", "--no-browser", "--port", "0"]
    environment = {**os.environ, "PYTHONUNBUFFERED": "1"}
    process = subprocess.Popen(command, stdout=subprocess.PIPE, stderr=subprocess.PIPE, text=True,
                               cwd=ROOT, env=environment)  # fmt: skip
    try:
        url = re.search(r"http://\S+", process.stdout.readline())[0]
        wait_for(lambda: listening(process.pid))
        assert "planar2r" in urllib.request.urlopen(url).read().decode()
        assert listening(process.pid) == ["127.0.0.1"]
        process.send_signal(number)
        out, err = process.communicate(timeout=10)
    finally:
        process.kill()
    assert (process.returncode, err) == (0, "")
    assert "viewer closed" in out
    with pytest.raises(urllib.error.URLError):
        urllib.request.urlopen(url, timeout=2)


def wait_for(condition, seconds=30.0):
    """Waits until something another thread does has happened."""
    end = time.monotonic() + seconds
    while not condition():
        assert time.monotonic() < end, "it did not happen"
        time.sleep(0.02)
