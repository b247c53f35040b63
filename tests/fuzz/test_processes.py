"""Fork, threads, signals, files that are no files, formula files that end the program, and size."""

from __future__ import annotations

import contextlib
import os
import signal
import stat
import subprocess
import sys
import threading
import time
from pathlib import Path

import fuzz_pool
import numpy as np
import processes_helpers as helpers
import pytest

import kinlab as kl
from kinlab.check import guest

pytestmark = pytest.mark.campaign

FORK = """
import multiprocessing, numpy as np, kinlab as kl
robot = kl.load("planar2r")
q = np.random.default_rng(0).uniform(-1, 1, (20000, robot.n))
small = q[:2000]
def call(q):
    {call}
first = call(q)
def child(i):
    return float(np.sum(np.asarray(call(small), dtype=float)))
if __name__ == "__main__":
    with multiprocessing.get_context("fork").Pool(2) as pool:
        got = pool.map_async(child, range(4)).get({seconds})
    assert len(set(got)) == 1 and np.isclose(got[0], child(0), rtol=1e-12), got
    assert np.array_equal(np.asarray(call(q)), np.asarray(first))
    print("done")
"""
CALLS = {
    "fk": "return kl.fk(robot, q)",
    "jacobian": "return kl.jacobian(robot, q)",
    "mass_matrix": "return kl.mass_matrix(robot, q)",
    "inverse_dynamics": "return kl.inverse_dynamics(robot, q, q, q)",
    "forward_dynamics": "return kl.forward_dynamics(robot, q, q, q)",
    "coriolis_matrix": "return kl.coriolis_matrix(robot, q, q)",
    "ik_batch": "return kl.ik_batch(robot, kl.fk(robot, q[:400]), seed=1).q",
}


def _together(jobs):
    """Runs jobs two at a time; what each returned."""
    out = {}

    def work(names):
        for name in names:
            out[name] = jobs[name]()

    names = list(jobs)
    threads = [threading.Thread(target=work, args=(names[i::2],)) for i in range(2)]
    [t.start() for t in threads]
    [t.join() for t in threads]
    return out


def test_a_pool_by_fork_returns_after_a_large_stack():
    found = _together(
        {
            name: lambda call=call: helpers.python(
                FORK.format(call=call, seconds=20), 45, KINLAB_THREADS="2"
            )
            for name, call in fuzz_pool.some(CALLS, 1, ("fk", "ik_batch")).items()
        }
    )
    bad = {
        name: (code, out[-200:])
        for name, (code, out) in found.items()
        if code != 0 or "done" not in out
    }
    assert not bad, bad


def test_sixteen_threads_get_the_same_answers():
    robot = kl.load("planar2r")
    rng = np.random.default_rng(1)
    q = rng.uniform(-1, 1, (3000, 2))
    poses = kl.fk(robot, q[:50])
    want = [
        kl.fk(robot, q),
        kl.mass_matrix(robot, q),
        kl.inverse_dynamics(robot, q, q, q),
        kl.ik_batch(robot, poses, seed=2).q,
    ]
    bad: list[object] = []
    start = threading.Barrier(16)

    def work():
        try:
            start.wait()
            for _ in range(3):
                have = [
                    kl.fk(robot, q),
                    kl.mass_matrix(robot, q),
                    kl.inverse_dynamics(robot, q, q, q),
                    kl.ik_batch(robot, poses, seed=2).q,
                ]
                bad.extend(
                    i
                    for i, (a, b) in enumerate(zip(want, have, strict=True))
                    if not np.array_equal(a, b)
                )
        except Exception as problem:  # noqa: BLE001
            bad.append(repr(problem))

    threads = [threading.Thread(target=work) for _ in range(16)]
    [t.start() for t in threads]
    [t.join() for t in threads]
    assert not bad


SWEEP = """
import numpy as np, kinlab as kl, processes_helpers
if __name__ == "__main__":
    print("ready", flush=True)
    kl.sweep(np.array([0.0]), processes_helpers.slow, samples=4096 * 3000, lower=[0.0], upper=[1.0],
             workers=2, chunk=4096, folder="parts")
"""


def _descendants(pid):
    found, todo = [], [pid]
    while todo:
        parent = todo.pop()
        for status in Path("/proc").glob("[0-9]*/stat"):
            try:
                fields = status.read_text().rsplit(")", 1)[1].split()
            except OSError:
                continue
            if int(fields[1]) == parent and fields[0] != "Z":
                child = int(status.parent.name)
                found.append(child)
                todo.append(child)
    return found


def _alive(pid):
    try:
        return Path(f"/proc/{pid}/stat").read_text().rsplit(")", 1)[1].split()[0] != "Z"
    except OSError:
        return False


def _sweep_until_signal(number, folder):
    process = subprocess.Popen(
        [sys.executable, "-c", SWEEP], env=helpers.environment(), cwd=folder, start_new_session=True,
        stdout=subprocess.DEVNULL, stderr=subprocess.PIPE, text=True,
        # a job in the background of a shell ignores it, and so would its children
        preexec_fn=lambda: signal.signal(signal.SIGINT, signal.SIG_DFL),
    )  # fmt: skip
    try:
        end = time.monotonic() + 40
        while len(list(folder.glob("parts/*.npz"))) < 2 and time.monotonic() < end:
            time.sleep(0.1)
        assert list(folder.glob("parts/*.npz")), "the sweep never began"
        workers = _descendants(process.pid)
        assert len(workers) >= 2
        os.kill(process.pid, number)
        end = time.monotonic() + 15
        while (_alive(process.pid) or any(map(_alive, workers))) and time.monotonic() < end:
            time.sleep(0.1)
        left = [pid for pid in [process.pid, *workers] if _alive(pid)]
    finally:
        helpers.kill_group(process.pid)
    error = process.communicate()[1]
    return (
        left,
        process.returncode,
        error,
        sorted(
            p.name for p in folder.rglob("*") if "tmp" in p.name.lower() or p.name.startswith(".")
        ),
    )


@pytest.mark.parametrize("number", [signal.SIGTERM, signal.SIGINT, signal.SIGKILL])
def test_the_workers_of_a_sweep_end_with_it(number, tmp_path):
    left, code, error, _ = _sweep_until_signal(number, tmp_path)
    assert not left, (
        f"{len(left)} processes are alive 15 s after {number!r}; the parent's code {code}"
    )
    if number == signal.SIGTERM:
        assert code != 0 and "resource_tracker" not in error and error.count("Traceback") <= 1


def test_truncated_kernels_are_compiled_again(tmp_path):
    code = "import numpy as np, kinlab as kl; r = kl.load('planar2r'); print(kl.fk(r, np.ones((3000, 2)))[0, 0, 3])"
    cache = {"NUMBA_CACHE_DIR": str(tmp_path / "cache")}
    first = helpers.python(code, 200, tmp_path, **cache)
    assert first[0] == 0, first
    files = list((tmp_path / "cache").rglob("*.nb?"))
    if not files:
        pytest.skip("kernels are not cached in NUMBA_CACHE_DIR")
    for i, file in enumerate(sorted(files)):
        data = file.read_bytes()
        file.write_bytes([data[: len(data) // 2], b"", b"nonsense" * 20][i % 3])
    again = helpers.python(code, 200, tmp_path, **cache)
    assert again == first


WRITES = [["urdf", "planar2r", "-o"], ["dh", "planar2r", "-o"], ["check", "planar2r", "--report"]]
ENDS = {"urdf": ".urdf", "dh": ".toml", "check": ".md"}


def _write_jobs(tmp_path):
    """Each job: a name, and a function that answers what is wrong, or nothing."""

    def symlink(words):
        folder = tmp_path / f"symlink{words[0]}"
        folder.mkdir()
        real, link = folder / f"real{ENDS[words[0]]}", folder / f"link{ENDS[words[0]]}"
        real.write_text("old")
        link.symlink_to(real.name)
        code, out = helpers.kinlab([*words, str(link)], 60)
        if not link.is_symlink():
            return "the link became a file"
        if code == 0 and real.read_text() == "old":
            return "said 0, but the target is old"
        return "" if code in (0, 2) and "Traceback" not in out else f"{code} {out[-200:]}"

    def fifo(words):
        path = tmp_path / f"fifo{words[0]}{ENDS[words[0]]}"
        os.mkfifo(path)
        got: list[bytes] = []

        def read():
            number = os.open(path, os.O_RDONLY | os.O_NONBLOCK)
            end = time.monotonic() + 60
            while time.monotonic() < end and not stop.is_set():
                with contextlib.suppress(BlockingIOError):
                    got.append(os.read(number, 1 << 16))
                time.sleep(0.02)
            os.close(number)

        stop = threading.Event()
        reader = threading.Thread(target=read)
        reader.start()
        code, out = helpers.kinlab([*words, str(path)], 60)
        time.sleep(0.1)
        stop.set()
        reader.join()
        if not stat.S_ISFIFO(path.lstat().st_mode):
            return "the FIFO became a file"
        if code == 0 and not b"".join(got):
            return "said 0, but nothing came through"
        return "" if code in (0, 2) and "Traceback" not in out else f"{code} {out[-200:]}"

    def device(words):
        path = tmp_path / f"null{words[0]}{ENDS[words[0]]}"
        try:
            os.mknod(path, 0o666 | stat.S_IFCHR, os.makedev(1, 3))
        except PermissionError:
            return ""
        code, out = helpers.kinlab([*words, str(path)], 60)
        if not stat.S_ISCHR(path.lstat().st_mode):
            return "the device became a file"
        return "" if code in (0, 2) and "Traceback" not in out else f"{code} {out[-200:]}"

    def stdout(words):
        # never /dev/stdout itself: as root, a program that replaces it breaks the whole machine
        link = tmp_path / f"stdout{words[0]}{ENDS[words[0]]}"
        link.symlink_to("/proc/self/fd/1")
        code, out = helpers.kinlab([*words, str(link)], 60)
        if not link.is_symlink():
            return "the link to standard output was replaced"
        if code == 0 and len(out) < 300:
            return f"said 0, but wrote only {out!r}"
        return "" if code in (0, 2) and "Traceback" not in out else f"{code} {out[-200:]}"

    def umask(words):
        folder = tmp_path / f"umask{words[0]}"
        folder.mkdir()
        path = folder / f"x{ENDS[words[0]]}"
        code = f"import os, sys; os.umask(0o027); sys.argv = ['kinlab', *{words!r}, {str(path)!r}]; from kinlab.cli import main; main()"
        helpers.python(code, 60)
        mode = stat.S_IMODE(path.stat().st_mode)
        if mode != 0o640:
            return f"permissions {mode:o} under umask 027, not 640"
        path.write_text("old")
        path.chmod(0o604)
        helpers.python(code, 60)
        mode = stat.S_IMODE(path.stat().st_mode)
        left = [p.name for p in folder.iterdir() if p != path]
        if left:
            return f"left behind {left}"
        return "" if mode in (0o604, 0o640) else f"permissions {mode:o} of a file written over"

    return {
        f"{check.__name__} {words[0]}": lambda check=check, words=words: check(words)
        for check in (symlink, fifo, device, stdout, umask)
        for words in WRITES
    }


def test_files_that_are_no_files(tmp_path):
    always = ("symlink urdf", "fifo check", "device dh", "stdout urdf", "umask dh")
    jobs = fuzz_pool.some(_write_jobs(tmp_path), 2, always)
    bad = {name: what for name, what in _together(jobs).items() if what}
    assert not bad, bad


ENDERS = {
    "exit()": "exit()",
    "sys.exit(0)": "import sys; sys.exit(0)",
    "os._exit(0)": "import os; os._exit(0)",
    "SystemExit": "raise SystemExit",
    "KeyboardInterrupt": "raise KeyboardInterrupt",
    "segfault": "import ctypes; ctypes.string_at(0)",
    "kill": "import os, signal; os.kill(os.getpid(), signal.SIGKILL)",
    "abort": "import os; os.abort()",
    "deep": "f = lambda: f(); f()",
    "hang": "while True: pass",
    "atexit": "import atexit, os; atexit.register(os._exit, 0); raise ValueError",
}
MODULE = """import kinlab as kl, numpy as np
{top}
@kl.hand_formula("gravity_torques", robot="single_link")
def gravity(q):
    {inside}
    return np.array([2.5 * 9.81 * 0.3 * np.cos(q[0])])
"""


def test_a_formula_file_that_ends_the_program_is_a_failure(tmp_path, monkeypatch):
    monkeypatch.setenv(guest.VARIABLE, "6")  # what a hang may take
    jobs = {}
    for name, line in ENDERS.items():
        for where in ("top", "inside"):
            file = tmp_path / f"{where}{len(jobs)}.py"
            fill = {"top": "", "inside": "pass", where: line}
            file.write_text(MODULE.format(**fill))
            words = ["check", str(file), "--rows"]
            jobs[f"{name} {where}"] = lambda words=words: helpers.kinlab(words, 40)
    jobs = fuzz_pool.some(
        jobs, 3, ("exit() inside", "os._exit(0) top", "hang inside", "segfault inside")
    )
    bad = {}
    for name, (code, out) in _together(jobs).items():
        if code not in (1, 2) or "Traceback" in out or not out.strip():
            bad[name] = (code, out[-160:])
    assert not bad, "\n".join(f"{name}: {what}" for name, what in bad.items())


def _urdf_of(joints, kind):
    parts = ['<robot name="long"><link name="l0"/>']
    for i in range(joints):
        moving = kind != "fixed" or i == 0
        parts.append(
            f'<link name="l{i + 1}"><inertial><mass value="1"/><inertia ixx="1" ixy="0" ixz="0" iyy="1" iyz="0" izz="1"/></inertial></link>'
            f'<joint name="j{i}" type="{"revolute" if moving else "fixed"}"><parent link="l{i}"/><child link="l{i + 1}"/>'
            '<origin xyz="0.01 0 0"/><axis xyz="0 0 1"/><limit lower="-1" upper="1" effort="1" velocity="1"/></joint>'
        )
    return "".join([*parts, "</robot>"])


def _deep_xml():
    return '<robot name="d"><link name="a"/>' + "<x>" * 20000 + "</x>" * 20000 + "</robot>"


ROW = 'name = "t"\nconvention = "standard"\n[[links]]\njoint = "revolute"\na = {a}\nalpha = 0\nd = 0\ntheta = 0\n'
HEAD = "joint,a,alpha,d,theta,convention\n"
LARGE = {
    "symbols double": ("f.toml", 'robot = "planar2r"\n[symbols]\n' + 'k0 = "m2"\n' + "".join(f'k{i + 1} = "k{i}+k{i}"\n' for i in range(50)) + '[formulas]\ng2 = "k50*cos(q1)"\n'),
    "symbols square": ("f.toml", 'robot = "planar2r"\n[symbols]\n' + 'k0 = "q1+q2"\n' + "".join(f'k{i + 1} = "k{i}*k{i}"\n' for i in range(50)) + '[formulas]\ng2 = "k50*cos(q1)"\n'),
    "symbols in a ring": ("f.toml", 'robot = "planar2r"\n[symbols]\na = "b"\nb = "a"\n[formulas]\ng2 = "a"\n'),
    "a power tower": ("f.toml", 'robot = "planar2r"\n[formulas]\ng2 = "((((((q1+q2+1)**6)**6)**6)**6)**6)**6"\n'),
    "a product of sums": ("f.toml", 'robot = "planar2r"\n[formulas]\ng2 = "' + "*".join(["(q1+q2+m1+m2)"] * 60) + '"\n'),
    "integer of 5,000 digits in a formula": ("f.toml", f'robot = "planar2r"\n[formulas]\ng2 = "{"1" * 5000}*q1"\n'),
    "integer of 5,000 digits in a symbol": ("f.toml", f'robot = "planar2r"\n[symbols]\nk = {"1" * 5000}\n[formulas]\ng2 = "k*q1"\n'),
    "integer of 5,000 digits in a table": ("t.toml", ROW.format(a="1" * 5000)),
    "hexadecimal of 5,000 digits in a table": ("t.toml", ROW.format(a="0x" + "f" * 5000)),
    "deep TOML": ("t.toml", "x = " + "[" * 100_000 + "]" * 100_000),
    "deep formula TOML": ("f.toml", 'robot = "planar2r"\nx = ' + "[" * 100_000 + "]" * 100_000),
    "deep keys": ("t.toml", "a." * 20_000 + "b = 1"),
    "a table of 2,000 rows": ("t.toml", 'name = "t"\nconvention = "standard"\n' + '[[links]]\njoint = "revolute"\na = 0.1\nalpha = 0\nd = 0\ntheta = 0\nmass = 1\n' * 2000),
    "a wide CSV cell": ("t.csv", HEAD + "revolute," + "1" * 200_000 + ",0,0,0,standard\n"),
    "a quoted CSV cell": ("t.csv", HEAD + 'revolute,"' + "1\n" * 200_000 + '",0,0,0,standard\n'),
    "CSV of 100,000 rows": ("t.csv", HEAD + "revolute,1,0,0,0,standard\n" * 100_000),
    "1,000 joints": ("r.urdf", _urdf_of(1000, "revolute")),
    "1,100 fixed joints": ("r.urdf", _urdf_of(1100, "fixed")),
    "5,000 links": ("r.urdf", _urdf_of(5000, "fixed")),
    "deep XML": ("r.urdf", _deep_xml()),
    "an attribute of 20 MB": ("r.urdf", '<robot name="' + "x" * 20_000_000 + '"><link name="a"/></robot>'),
    "deep formula": ("f.toml", 'robot = "planar2r"\n[formulas]\ng2 = "' + "sin(" * 2000 + "q1" + ")" * 2000 + '"\n'),
    "LaTeX, deep": ("f.toml", "robot = 'planar2r'\n[latex]\ng2 = '" + "\\frac{" * 2000 + "1" + "}{2}" * 2000 + "'\n"),
}  # fmt: skip


def test_what_is_too_large_is_said_in_one_line(tmp_path):
    jobs = {}
    for i, (name, (file, text)) in enumerate(LARGE.items()):
        folder = tmp_path / str(i)
        folder.mkdir()
        (folder / file).write_text(text)
        for word in ["check"] if file.startswith("f.") else ["info", "check"]:
            jobs[f"{word}: {name}"] = lambda words=[word, str(folder / file)]: helpers.kinlab(
                words, 30, limit=4 << 30
            )
    always = (
        "check: symbols double",
        "info: 1,000 joints",
        "info: a wide CSV cell",
        "check: deep formula TOML",
    )
    jobs = fuzz_pool.some(jobs, 6, always)
    bad = {}
    for name, (code, out) in _together(jobs).items():
        lines = [line for line in out.splitlines() if line.strip()]
        if code not in (0, 1, 2) or "Traceback" in out:
            bad[name] = "no end in 30 s" if code == -1000 else f"code {code}: {out[-160:]!r}"
        elif code == 2 and (len(lines) != 1 or len(lines[0]) > 1000):
            bad[name] = (
                f"{len(lines)} lines, the first of {len(lines[0]) if lines else 0} characters"
            )
    assert not bad, "\n".join(f"{name}: {what}" for name, what in bad.items())
