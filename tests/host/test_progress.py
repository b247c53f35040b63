"""The line that says how far a long calculation is: who sees it, when, and that it goes."""

from __future__ import annotations

import io
import sys
import threading
import types

import numpy as np
import pytest

import kinlab as kl
from kinlab.host import progress as lines
from kinlab.host.progress import progress, pulse, takes_long


class Terminal(io.StringIO):
    def isatty(self):
        return True


def look_at(monkeypatch, stream):
    """Makes this the stderr of the module; pytest takes sys.stderr for itself between phases."""
    monkeypatch.setattr(lines, "sys", types.SimpleNamespace(stderr=stream, modules=sys.modules))


@pytest.fixture
def terminal(monkeypatch):
    made = Terminal()
    look_at(monkeypatch, made)
    return made


@pytest.fixture
def clock(monkeypatch):
    """A clock that stands still until it is set."""
    now = types.SimpleNamespace(value=100.0)
    monkeypatch.setattr(lines.time, "monotonic", lambda: now.value)
    return now


def screen(written):
    """What stands on the line after all that was written over it."""
    shown = ""
    for piece in written.split("\r"):
        shown = piece + shown[len(piece) :]
    return shown.rstrip()


def test_the_line_comes_after_two_seconds_and_goes(terminal, clock):
    with progress("sweep", 10) as tell:
        clock.value += 1.9
        tell(1)
        assert terminal.getvalue() == ""
        clock.value += 0.6
        tell(5, "block 5")
        assert screen(terminal.getvalue()) == "sweep: 5/10, 2 s left  block 5"
        before = terminal.getvalue()
        clock.value += 0.1
        tell(6)
        assert terminal.getvalue() == before, "drawn again at once"
        clock.value += 0.2
        tell(7)
        assert screen(terminal.getvalue()).startswith("sweep: 7/10")
    assert screen(terminal.getvalue()) == ""


def test_a_pipe_sees_nothing(monkeypatch, clock):
    pipe = io.StringIO()
    look_at(monkeypatch, pipe)
    with progress("sweep", 10) as tell:
        clock.value += 50.0
        tell(5)
    assert pipe.getvalue() == ""


def test_asked_for_it_is_shown_anywhere_and_refused_nowhere(monkeypatch, terminal, clock):
    with progress("sweep", 10, show=False) as tell:
        clock.value += 50.0
        tell(5)
    assert terminal.getvalue() == ""
    pipe = io.StringIO()
    look_at(monkeypatch, pipe)
    with progress("sweep", 10, show=True) as tell:
        tell(5)
    assert "5/10" in pipe.getvalue()


def test_a_notebook_sees_it(monkeypatch, clock):
    pipe = io.StringIO()
    look_at(monkeypatch, pipe)
    ZMQInteractiveShell = type("ZMQInteractiveShell", (), {})
    notebook = types.SimpleNamespace(get_ipython=ZMQInteractiveShell)
    monkeypatch.setitem(sys.modules, "IPython", notebook)
    with progress("sweep", 10) as tell:
        clock.value += 3.0
        tell(5)
    assert "5/10" in pipe.getvalue()


def test_a_notebook_that_is_run_to_be_printed_does_not_see_it(terminal, monkeypatch, clock):
    monkeypatch.setenv("KINLAB_PROGRESS", "0")
    with progress("sweep", 10) as tell:
        clock.value += 3.0
        tell(5)
    assert terminal.getvalue() == ""


def test_what_runs_inside_only_moves_the_line_on(terminal, clock):
    @takes_long("inner")
    def inner():
        clock.value += 1.0
        pulse()
        return 7

    @takes_long("outer")
    def outer():
        return [inner() for _ in range(4)]

    assert outer() == [7, 7, 7, 7]
    assert "outer, 4 s" in terminal.getvalue()
    assert "inner" not in terminal.getvalue()
    assert screen(terminal.getvalue()) == ""


def test_the_line_goes_where_the_calculation_fails(terminal, clock):
    @takes_long("search")
    def search():
        clock.value += 3.0
        pulse()
        raise ValueError

    with pytest.raises(ValueError):
        search()
    assert "search" in terminal.getvalue() and screen(terminal.getvalue()) == ""
    pulse()  # no line is left to be moved
    assert screen(terminal.getvalue()) == ""


def test_another_thread_writes_nothing(terminal, clock):
    def work():
        with progress("sweep", 10) as tell:
            clock.value += 50.0
            tell(5)

    thread = threading.Thread(target=work)
    thread.start()
    thread.join()
    assert terminal.getvalue() == ""


def test_answers_do_not_hang_on_it(terminal, monkeypatch):
    monkeypatch.setattr(lines, "DELAY", 0.0)
    monkeypatch.setattr(lines, "_PAUSE", 0.0)
    robot = kl.load("planar3r")
    loud = kl.find_singularities(robot, task="xy", seed=3)
    swept = kl.sweep(robot, "position", 3000, workers=1)
    assert "singularities" in terminal.getvalue() and "sweep: " in terminal.getvalue()
    look_at(monkeypatch, io.StringIO())
    quiet = kl.find_singularities(robot, task="xy", seed=3)
    assert np.array_equal(
        swept["position"], kl.sweep(robot, "position", 3000, workers=1)["position"]
    )
    assert [f.deciding for f in loud.families] == [f.deciding for f in quiet.families]
    members = [[m for f in found.families for m in f.members] for found in (loud, quiet)]
    for one, two in zip(*members, strict=True):
        assert np.array_equal(one.q, two.q)


def test_the_long_ones_are_marked():
    long = (
        kl.find_singularities, kl.nearest_singularity, kl.find_isotropic, kl.design_isotropic,
        kl.singular_loci, kl.workspace_section, kl.is_cuspidal, kl.aspects, kl.solution_map,
        kl.solution_count, kl.ik_batch,
    )  # fmt: skip
    assert all(hasattr(function, "__wrapped__") for function in long)
