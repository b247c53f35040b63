"""Reports and viewer pages made of hostile text, in a browser; and the viewer's server under attack."""

from __future__ import annotations

import contextlib
import http.client
import os
import re
import shutil
import signal
import socket
import subprocess
import sys
import time
from pathlib import Path

import cli_cases
import fuzz_pool
import numpy as np
import processes_helpers as helpers
import pytest

import kinlab as kl

pytestmark = pytest.mark.campaign

FLAGS = ["--no-sandbox", "--disable-quic", "--no-first-run", "--disable-background-networking", "--disable-component-update",
         "--disable-sync", "--use-angle=swiftshader", "--enable-unsafe-swiftshader"]  # fmt: skip
MARKUP = [
    r"\text{<script>window.pwned=1</script>}",
    r"\text{<img src=x onerror=window.pwned=1>}",
    r"\href{javascript:window.pwned=1}{x}",
    "</script><script>window.pwned=1</script>",
    "<img src=x onerror=window.pwned=1>",
    "'\"><svg onload=window.pwned=1>",
    "<!--<script>window.pwned=1",
    "</style><script>window.pwned=1</script>",
    "](javascript:window.pwned=1)<iframe srcdoc='<script>parent.pwned=1</script>'>",
    "${window.pwned=1}{{constructor.constructor('window.pwned=1')()}}",
    "\u2028window.pwned=1\u2029",
    "</title><script>window.pwned=1</script>",
]


@pytest.fixture(scope="module")
def browser():
    try:
        from playwright.sync_api import sync_playwright
    except ImportError:
        sync_playwright = None
    program = next(
        filter(None, map(shutil.which, ("chromium", "chromium-browser", "google-chrome"))), None
    )
    if sync_playwright is None or program is None:
        if os.environ.get("CI") == "true":
            pytest.fail("playwright and a browser are needed in CI")
        pytest.skip("playwright or a browser is missing")
    with sync_playwright() as playwright:
        running = playwright.chromium.launch(executable_path=program, args=FLAGS)
        yield running
        running.close()


def _wrong_with(browser, page: Path) -> str:
    text = page.read_text()
    if not re.search(r'<meta[^>]+http-equiv=["\']?content-security-policy', text, re.I):
        wrong = ["no content-security-policy"]
    else:
        wrong = []
        policy = re.search(
            r'content=(["\'])(.*?)\1',
            re.search(r"<meta[^>]+content-security-policy[^>]*>", text, re.I)[0],
            re.I,
        )
        policy_text = policy[2] if policy else ""
        if "script-src" not in policy_text and "default-src" not in policy_text:
            wrong.append("the policy names no scripts")
        scripts = re.search(r"(?:script-src|default-src)([^;]*)", policy_text)
        if (
            scripts
            and "'unsafe-inline'" in scripts[1]
            and "nonce-" not in scripts[1]
            and "sha256-" not in scripts[1]
        ):
            wrong.append("the policy lets every inline script run")
    tab = browser.new_page()
    asked: list[str] = []
    tab.on("request", lambda request: asked.append(request.url))
    tab.on("dialog", lambda dialog: dialog.dismiss())
    tab.goto(page.as_uri())
    tab.wait_for_timeout(80)
    if tab.evaluate("window.pwned !== undefined"):
        wrong.append("a script of the file ran")
    bad = tab.evaluate("""[...document.querySelectorAll('*')].filter(e => [...e.attributes].some(
        a => a.name.startsWith('on') || /^\\s*javascript:/i.test(a.value))).length
        + document.querySelectorAll('iframe, object, embed, svg[onload]').length""")
    if bad:
        wrong.append(f"{bad} elements with handlers, frames or javascript addresses")
    if [url for url in asked if not url.startswith(("file:", "data:", "blob:"))]:
        wrong.append(f"the page asked for {asked}")
    tab.close()
    return "; ".join(wrong)


def _formulas(folder: Path, text: str) -> list[str]:
    (folder / "f.py").write_text(
        "import kinlab as kl, numpy as np\n"
        f"@kl.hand_formula('gravity_torques', robot='single_link', source={text!r}, latex={text!r})\n"
        f"def gravity(q):\n    {text!r}\n    return np.array([2.5 * 9.81 * 0.3 * np.cos(q[0]) + 1])\n"
    )
    return ["check", "f.py", "--report", "out.html"]


def _table(folder: Path, text: str) -> list[str]:
    quote = cli_cases.quoted
    (folder / "t.toml").write_text(
        cli_cases.TABLE.format(
            name=quote("arm"), source=quote(text), tool=quote("tip"), joint=quote(text)
        ).replace('name = "arm"', f"name = {quote(text)}", 1)
    )
    return ["check", "t.toml", "--report", "out.html"]


def _urdf(folder: Path, text: str) -> list[str]:
    quote = cli_cases.attribute
    (folder / "r.urdf").write_text(
        cli_cases.URDF.format(
            name=quote(text),
            link=quote("L" + text),
            tool=quote("T" + text),
            joint=quote("J" + text),
        )
    )
    return ["view", "r.urdf", "--save", "out.html"]


def _view_table(folder: Path, text: str) -> list[str]:
    return ["view", _table(folder, text)[1], "--save", "out.html"]


def _view_five(folder: Path, text: str) -> list[str]:
    quote = cli_cases.quoted
    (folder / "five.toml").write_text(cli_cases.FIVE.format(name=quote(text), source=quote(text)))
    return ["view", "five.toml", "--save", "out.html"]


def _symbols(folder: Path, text: str) -> list[str]:
    (folder / "f.toml").write_text(
        f'robot = "planar2r"\nsource = {cli_cases.quoted(text)}\n[latex]\ng2 = {cli_cases.quoted(text)}\n'
    )
    return ["check", "f.toml", "--report", "out.html"]


MAKERS = [_formulas, _table, _urdf, _view_table, _view_five, _symbols]


def _save(folder: Path, words: list[str]) -> tuple[int, str]:
    import contextlib
    import io

    from kinlab.cli import main

    if any(
        word.endswith(".py") for word in words
    ):  # run in a child, which must not be the browser's
        command = [sys.executable, "-m", "kinlab", *words]
        environment = {**os.environ, "PYTHONPATH": os.pathsep.join(sys.path)}
        done = subprocess.run(
            command, cwd=folder, env=environment, capture_output=True, text=True, check=False
        )
        return done.returncode, done.stdout + done.stderr
    printed, before, place = io.StringIO(), sys.argv, os.getcwd()  # noqa: PTH109
    try:
        os.chdir(folder)
        sys.argv = ["kinlab", *words]
        with contextlib.redirect_stdout(printed), contextlib.redirect_stderr(printed):
            main()
        return 0, printed.getvalue()
    except SystemExit as end:
        return int(end.code or 0), printed.getvalue()
    finally:
        sys.argv = before
        os.chdir(place)


def test_pages_run_nothing_that_a_file_says(browser, tmp_path):
    bad, pages = {}, 0
    texts = MARKUP if fuzz_pool.LONG else MARKUP[:2]
    for i, text in enumerate(texts):
        for make in MAKERS:
            folder = tmp_path / f"{i}{make.__name__}"
            folder.mkdir()
            try:
                code, out = _save(folder, make(folder, text))
            except Exception as problem:  # noqa: BLE001
                bad[f"{make.__name__} {text[:40]!r}"] = (
                    f"raw {type(problem).__name__}: {str(problem)[:100]}"
                )
                continue
            page = folder / "out.html"
            if page.is_file():
                pages += 1
                wrong = _wrong_with(browser, page)
            else:
                wrong = (
                    "" if code == 2 and out.strip() else f"exit code {code}, no page: {out[:100]}"
                )
            if wrong:
                bad[f"{make.__name__} {text[:40]!r}"] = wrong
    assert pages >= len(texts)
    if bad:
        pytest.fail("\n".join(f"{name}: {what}" for name, what in bad.items()), pytrace=False)


def test_names_added_to_a_scene_run_nothing(browser, tmp_path):
    robot = kl.load("planar2r")
    bad = {}
    for i, text in enumerate(MARKUP if fuzz_pool.LONG else MARKUP[:2]):
        scene = kl.viewer.Scene(robot, [0.1, 0.2])
        with contextlib.suppress(kl.KinlabError):
            scene.frame(text, np.eye(4))
        with contextlib.suppress(kl.KinlabError):
            scene.points(text, np.zeros((3, 3)), np.arange(3.0))
        page = tmp_path / f"{i}.html"
        scene.save(page)
        wrong = _wrong_with(browser, page)
        if wrong:
            bad[text] = wrong
    if bad:
        pytest.fail("\n".join(f"{name}: {what}" for name, what in bad.items()), pytrace=False)


@pytest.fixture
def server():
    scene = kl.viewer.Scene(kl.load("planar2r"), [0.1, 0.2])
    running = scene.serve(port=0)
    yield scene, running
    running.stop()


def _status(port: int, path: str, host: str | None, **headers: str) -> int:
    connection = http.client.HTTPConnection("127.0.0.1", port, timeout=5)
    connection.putrequest("GET", path, skip_host=True)
    if host is not None:
        connection.putheader("Host", host)
    for key, value in headers.items():
        connection.putheader(key.replace("_", "-"), value)
    connection.endheaders()
    try:
        return connection.getresponse().status
    except (http.client.HTTPException, OSError):
        return 400  # closed without an answer: refused as well
    finally:
        connection.close()


SOCKET = {
    "Upgrade": "websocket",
    "Connection": "Upgrade",
    "Sec_WebSocket_Key": "dGhlIHNhbXBsZSBub25jZQ==",
    "Sec_WebSocket_Version": "13",
}
EVIL = ["evil.example", "evil.example:{port}", "127.0.0.1.evil.example", "localhost.evil.example:{port}", "", "[::1].evil", "127.0.0.1@evil.example", "0x7f000001.evil",
        "a b", "127.0.0.1:{port}:{port}", "evil.example, localhost", "*"]  # fmt: skip


def test_a_foreign_host_is_refused(server):
    _, running = server
    assert _status(running.port, "/", f"127.0.0.1:{running.port}") == 200
    assert (
        _status(
            running.port,
            "/socket",
            f"127.0.0.1:{running.port}",
            Origin=f"http://127.0.0.1:{running.port}",
            **SOCKET,
        )
        == 101
    )
    bad = {}
    for host in EVIL:
        name = host.format(port=running.port)
        for path, more in (("/", {}), ("/socket", SOCKET | {"Origin": f"http://{name}"})):
            code = _status(running.port, path, name, **more)
            if not 400 <= code < 500:
                bad[f"{path} Host: {name!r}"] = code
    for origin in ("http://evil.example", "null", "http://localhost.evil"):
        code = _status(
            running.port, "/socket", f"127.0.0.1:{running.port}", Origin=origin, **SOCKET
        )
        if not 400 <= code < 500:
            bad[f"/socket Origin: {origin}"] = code
    if bad:
        pytest.fail("\n".join(f"{name}: {what}" for name, what in bad.items()), pytrace=False)


@pytest.mark.parametrize("host", ["", " ", "no-such-host.invalid", "256.1.1.1", "a\tb"])
def test_a_host_that_is_none_is_refused(host):
    code, out = helpers.kinlab(
        ["view", "planar2r", "--no-browser", "--port", "0", "--host", host], 12
    )
    assert code == 2 and len(out.strip().splitlines()) == 1, (code, out[-300:])


def _resident() -> int:
    return int(Path("/proc/self/statm").read_text().split()[1]) * os.sysconf("SC_PAGE_SIZE")


def test_a_deaf_client_costs_no_memory(server):
    scene, running = server
    client = socket.create_connection(("127.0.0.1", running.port))
    client.setsockopt(socket.SOL_SOCKET, socket.SO_RCVBUF, 4096)
    client.sendall(
        f"GET /socket HTTP/1.1\r\nHost: 127.0.0.1:{running.port}\r\nUpgrade: websocket\r\nConnection: Upgrade\r\n"
        f"Origin: http://127.0.0.1:{running.port}\r\nSec-WebSocket-Key: dGhlIHNhbXBsZSBub25jZQ==\r\nSec-WebSocket-Version: 13\r\n\r\n".encode()
    )
    assert b"101" in client.recv(100)
    line = np.random.default_rng(0).uniform(-1, 1, (3000, 3))
    for _ in range(20):
        scene.path("line", line)
    time.sleep(0.5)
    before = _resident()
    for i in range(400):
        scene.path("line", line + i * 1e-3)
        scene.show([1e-3 * i, 0.2])
        if i % 20 == 0:
            time.sleep(0.05)
    time.sleep(1.0)
    grown = (_resident() - before) / 2**20
    client.close()
    assert _status(running.port, "/", f"127.0.0.1:{running.port}") == 200
    assert grown < 20, f"{grown:.0f} MB after 400 updates that nobody read"


def test_departed_clients_leave_no_traceback():
    code = """
import socket, time, numpy as np, kinlab as kl
scene = kl.viewer.Scene(kl.load("planar2r"), [0.1, 0.2])
server = scene.serve(port=0)
for i in range(10):
    s = socket.create_connection(("127.0.0.1", server.port))
    s.sendall(f"GET /socket HTTP/1.1\\r\\nHost: 127.0.0.1:{server.port}\\r\\nUpgrade: websocket\\r\\nConnection: Upgrade\\r\\nOrigin: http://127.0.0.1:{server.port}\\r\\nSec-WebSocket-Key: dGhlIHNhbXBsZSBub25jZQ==\\r\\nSec-WebSocket-Version: 13\\r\\n\\r\\n".encode())
    s.recv(100)
    s.setsockopt(socket.SOL_SOCKET, socket.SO_LINGER, __import__("struct").pack("ii", 1, 0))
    scene.show([0.1 * i, 0.2])
    s.close()
    for _ in range(20):
        scene.show([0.01 * i, 0.3])
time.sleep(0.5)
server.stop()
print("done")
"""
    status, out = helpers.python(code, 40)
    assert status == 0 and out == "done\n", (status, out[-600:])


@pytest.mark.parametrize("delay", [0.2, 0.8, None])
def test_ctrl_c_during_the_start_ends_it(delay):
    process = subprocess.Popen(
        [sys.executable, "-u", "-m", "kinlab", "view", "planar2r", "--no-browser", "--port", "0"], env=helpers.environment(),
        stdout=subprocess.PIPE, stderr=subprocess.STDOUT, text=True, start_new_session=True,
        # a job in the background of a shell ignores it, and so would its children
        preexec_fn=lambda: signal.signal(signal.SIGINT, signal.SIG_DFL),
    )  # fmt: skip
    try:
        if delay is None:  # as soon as it says its address, which is before it serves
            assert process.stdout is not None
            assert "http://" in process.stdout.readline()
        else:
            time.sleep(delay)
        process.send_signal(signal.SIGINT)
        out, _ = process.communicate(timeout=10)
    except subprocess.TimeoutExpired:
        pytest.fail("it did not end")
    finally:
        helpers.kill_group(process.pid)
    assert process.returncode in ((0, 130) if delay is None else (0, 130, 1, -signal.SIGINT))
    if delay is None:  # before that Python itself may still be importing
        assert "Traceback" not in out, out[-300:]
