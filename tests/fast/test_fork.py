"""A process that has computed on many threads can be forked: its child computes too."""

from __future__ import annotations

import subprocess
import sys

import pytest

SCRIPT = """
import faulthandler, os, signal, sys, threading
import numpy as np
import kinlab as kl

robot = kl.load("ur5")
q = np.random.default_rng(0).uniform(-1.0, 1.0, (40_000, 6))
target = kl.fk(robot, q[:1200])
work = {
    "fk": lambda: kl.fk(robot, q), "jacobian": lambda: kl.jacobian(robot, q),
    "mass_matrix": lambda: kl.mass_matrix(robot, q),
    "inverse_dynamics": lambda: kl.inverse_dynamics(robot, q, q, q),
    "forward_dynamics": lambda: kl.forward_dynamics(robot, q, q, q),
    "ik_batch": lambda: kl.ik_batch(robot, target).q,
}[sys.argv[1]]
here = work()

# the child compares, and says so by its exit status; one that never answers is ended by the alarm,
# as is the parent, and says where it was
faulthandler.enable()
faulthandler.register(signal.SIGALRM, chain=True)
signal.alarm(100)
def child():
    pid = os.fork()
    if pid == 0:
        signal.alarm(60)
        os._exit(0 if np.array_equal(here, work()) else 1)
    return pid

stop = threading.Event()
def busy():
    while not stop.is_set():
        kl.fk(robot, q[:8192])
threads = [threading.Thread(target=busy) for _ in range(4)] if sys.argv[2] == "busy" else []
for thread in threads:
    thread.start()
children = [child() for _ in range(4)]
stop.set()
for thread in threads:
    thread.join()
print([os.waitpid(pid, 0)[1] for pid in children])
"""


@pytest.mark.parametrize(
    ("what", "how"),
    [
        ("fk", "idle"), ("fk", "busy"), ("jacobian", "idle"), ("mass_matrix", "idle"),
        ("inverse_dynamics", "idle"), ("forward_dynamics", "idle"), ("ik_batch", "idle"),
    ],
)  # fmt: skip
def test_a_forked_child_gives_the_same_answers(what, how, monkeypatch):
    monkeypatch.setenv("KINLAB_THREADS", "16")
    done = subprocess.run(
        [sys.executable, "-W", "ignore", "-c", SCRIPT, what, how],
        capture_output=True, text=True, timeout=150, check=False,
    )  # fmt: skip
    assert done.stdout == "[0, 0, 0, 0]\n", done.stderr[-4000:]
