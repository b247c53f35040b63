"""Sweeps: one answer for every number of workers and chunks, kept through stops and deaths."""

from __future__ import annotations

import json
import os
import signal
import subprocess
import sys
import threading
import time
import tracemalloc
from concurrent.futures import ProcessPoolExecutor, ThreadPoolExecutor
from functools import partial
from itertools import pairwise
from multiprocessing import get_context
from pathlib import Path

import numpy as np
import pytest
import sweep_measures

import kinlab as kl
from kinlab.errors import FileError, NameUnknownError, OptionError, StateError, SweepError
from kinlab.sweeps.pools import Pool
from kinlab.sweeps.run import missing
from kinlab.sweeps.samples import BLOCK

COUNT = 5 * BLOCK + 123
NAMES = ("position", "min_singular", "condition")


@pytest.fixture(scope="module")
def robot():
    return kl.load("puma560")


@pytest.fixture(scope="module")
def alone(robot):
    return kl.sweep(robot, NAMES, COUNT, seed=4, workers=1)


def same(one, two):
    assert one.names == two.names
    assert np.array_equal(one.states, two.states)
    for name in one.names:
        assert one[name].dtype == two[name].dtype
        assert np.array_equal(one[name], two[name])


def test_columns_are_the_single_calls(robot, alone):
    q = alone.states
    assert len(alone) == COUNT == len(q)
    assert (q >= robot.lower).all() and (q <= robot.upper).all()
    assert len(np.unique(q[:, 0])) == COUNT  # no two blocks drew the same
    for i in (0, 1, BLOCK - 1, BLOCK, 3 * BLOCK + 17, COUNT - 1):
        sigma = np.linalg.svd(kl.jacobian(robot, q[i]), compute_uv=False)
        assert alone["position"][i] == pytest.approx(kl.fk(robot, q[i])[:3, 3], abs=1e-12)
        assert alone["min_singular"][i] == pytest.approx(sigma[-1], abs=1e-12)
        assert 1 / alone["condition"][i] == pytest.approx(sigma[-1] / sigma[0], abs=1e-12)


@pytest.mark.parametrize(("workers", "chunk"), [(1, 1), (1, 10**9), (2, 2 * BLOCK)])
def test_neither_workers_nor_chunks_change_a_bit(robot, alone, workers, chunk, tmp_path):
    same(kl.sweep(robot, NAMES, COUNT, seed=4, workers=workers, chunk=chunk), alone)
    folder = tmp_path / "parts"
    kept = kl.sweep(robot, NAMES, COUNT, seed=4, workers=1, chunk=chunk, folder=folder)
    same(kept, alone)


def test_any_executor_gives_the_same(robot, alone):
    with ThreadPoolExecutor(3) as threads:
        same(kl.sweep(robot, NAMES, COUNT, seed=4, chunk=1, executor=threads), alone)
        assert threads.submit(int, 3).result() == 3  # the caller's pool is left open
    with ProcessPoolExecutor(2, mp_context=get_context("spawn")) as processes:
        same(kl.sweep(robot, NAMES, COUNT, seed=4, chunk=1, executor=processes), alone)
        assert processes.submit(int, 3).result() == 3


def test_dask_on_two_processes_over_tcp_gives_the_same(robot, alone):
    from distributed import Client, LocalCluster

    with (
        LocalCluster(
            n_workers=2, threads_per_worker=1, processes=True, protocol="tcp://",
            host="127.0.0.1", dashboard_address=None,
        ) as cluster,
        Client(cluster) as client,
    ):  # fmt: skip
        assert all(address.startswith("tcp://127.0.0.1:") for address in client.nthreads())
        same(kl.sweep(robot, NAMES, COUNT, seed=4, chunk=1, executor=client.get_executor()), alone)


def test_a_seed_is_a_sweep(robot):
    first, again, other = (kl.sweep(robot, "condition", 10, seed=s, workers=1) for s in (1, 1, 2))
    same(first, again)
    assert not np.array_equal(first.states, other.states)


def test_a_longer_sweep_begins_like_a_shorter_one(robot, alone):
    short = kl.sweep(robot, NAMES, 2 * BLOCK, seed=4, workers=1)
    assert np.array_equal(short["condition"], alone["condition"][: 2 * BLOCK])


@pytest.mark.parametrize(("workers", "chunk"), [(1, 10**9), (1, 1), (2, 1)])
def test_states_that_are_given(robot, workers, chunk):
    axis = np.linspace(-1, 1, 41)
    grid = np.stack(np.meshgrid(axis, axis, [0.1, 0.2, 0.3, 0.4]), -1).reshape(-1, 4)
    grid = np.hstack([grid, grid[:, :2] / 2])
    result = kl.sweep(robot, sweep_measures.total, grid, workers=workers, chunk=chunk)
    assert np.array_equal(result.states, grid)
    assert np.array_equal(result["value"], grid.sum(axis=1))


def test_a_design_scan_needs_no_robot():
    result = kl.sweep(
        2.0, sweep_measures.design_volume, 9000, lower=[1, 2], upper=[3, 4], workers=2, chunk=1
    )
    x = result.states
    assert (x >= [1, 2]).all() and (x <= [3, 4]).all()
    assert np.array_equal(result["value"], 2.0 * x[:, 0] * x[:, 1])


def test_best_is_a_stable_sort_over_all_parts(robot, alone, tmp_path):
    values, q = alone["condition"], alone.states
    for largest in (False, True):
        order = np.argsort(-values if largest else values, kind="stable")[:7]
        states, got = alone.best("condition", 7, largest=largest)
        assert np.array_equal(got, values[order])
        assert np.array_equal(states, q[order])
    ones = kl.sweep(robot, sweep_measures.total, np.ones((9000, 6)), workers=1, chunk=1)
    assert np.array_equal(ones.best("value", 3)[0], np.ones((3, 6)))
    with pytest.raises(OptionError, match="'position' has rows of shape"):
        alone.best("position")
    with pytest.raises(NameUnknownError, match="no column 'conditio'; did you mean 'condition'"):
        alone.best("conditio")
    with pytest.raises(OptionError, match="count is 0"):
        alone.best("condition", 0)


# stops, deaths, and going on


def part_files(folder):
    return {file.name: file.stat().st_mtime_ns for file in folder.glob("part-*.npz")}


def test_what_is_finished_is_not_worked_out_again(robot, tmp_path):
    run = partial(kl.sweep, robot, sweep_measures.total, COUNT, folder=tmp_path)
    first = run(workers=1, chunk=2 * BLOCK)
    values, before = first["value"], part_files(tmp_path)
    assert len(before) == 3
    (tmp_path / "part-00000002-00000004.npz").unlink()
    assert np.array_equal(run(workers=2, chunk=1)["value"], values)  # others fill the gap
    after = part_files(tmp_path)
    assert set(after) - set(before) == {"part-00000002-00000003.npz", "part-00000003-00000004.npz"}
    assert all(before[name] == after[name] for name in set(before) & set(after))


@pytest.mark.parametrize("damage", [b"", b"PK\x03\x04 cut short", "half"])
def test_a_damaged_part_is_worked_out_again(robot, alone, tmp_path, damage):
    run = partial(kl.sweep, robot, NAMES, COUNT, seed=4, workers=1, chunk=1, folder=tmp_path)
    run()
    part = tmp_path / "part-00000001-00000002.npz"
    whole = part.read_bytes()
    part.write_bytes(whole[: len(whole) // 2] if damage == "half" else damage)
    same(run(), alone)
    assert len(part.read_bytes()) == len(whole)


def _in_a_group_of_its_own(script: Path) -> subprocess.Popen[str]:
    here = Path(__file__).parent
    path = os.pathsep.join([str(here), str(here.parent), *sys.path])
    return subprocess.Popen(
        [sys.executable, str(script)], env={**os.environ, "PYTHONPATH": path},
        stderr=subprocess.PIPE, text=True, start_new_session=True,
    )  # fmt: skip


@pytest.mark.parametrize("workers", [1, 2])
@pytest.mark.parametrize("stop", [signal.SIGINT, signal.SIGKILL])
def test_a_run_that_is_stopped_goes_on(tmp_path, stop, workers):
    """A real process is interrupted or killed in the middle; the next one finishes its work."""
    folder = tmp_path / "parts"
    script = tmp_path / "script.py"
    script.write_text(
        "import signal, sys, kinlab as kl, sweep_measures\n"
        "if __name__ == '__main__':\n"
        # a shell starts what runs in the background deaf to Ctrl-C, and that is inherited
        "    signal.signal(signal.SIGINT, signal.default_int_handler)\n"
        f"    kl.sweep(1.0, sweep_measures.slow, {30 * BLOCK}, lower=[0], upper=[1],\n"
        f"             workers={workers}, chunk=1, folder={str(folder)!r})\n"
    )
    process = _in_a_group_of_its_own(script)
    while len(part_files(folder) if folder.exists() else ()) < 3:
        assert process.poll() is None, process.stderr.read()
        time.sleep(0.01)
    os.killpg(process.pid, stop)
    stderr = process.communicate()[1]
    assert process.returncode != 0
    if stop is signal.SIGINT:
        assert stderr.rstrip().endswith("KeyboardInterrupt")
        assert stderr.count("Traceback") == 1  # the workers are silent
    kept = part_files(folder)
    assert 3 <= len(kept) < 30
    run = partial(kl.sweep, 1.0, lower=[0], upper=[1], chunk=1)
    resumed = run(sweep_measures.slow, 30 * BLOCK, workers=2, folder=folder)
    assert {k: v for k, v in part_files(folder).items() if k in kept} == kept
    assert np.array_equal(
        resumed["value"], run(sweep_measures.total, 30 * BLOCK, workers=1)["value"]
    )
    assert not list(folder.glob(".*"))  # no half-written file is left


def test_a_worker_that_begins_is_silent_too(tmp_path):
    """Ctrl-C while a worker still imports: the run ends, and the worker prints no traceback."""
    script, begun = tmp_path / "script.py", tmp_path / "begun"
    script.write_text(
        "import pathlib, signal, time, kinlab as kl, sweep_measures\n"
        "if __name__ == '__main__':\n"
        "    signal.signal(signal.SIGINT, signal.default_int_handler)\n"
        f"    kl.sweep(1.0, sweep_measures.total, {4 * BLOCK}, lower=[0], upper=[1],\n"
        "             workers=2, chunk=1)\n"
        "else:\n"
        f"    pathlib.Path({str(begun)!r}).touch()\n"
        "    time.sleep(60)\n"
    )
    process = _in_a_group_of_its_own(script)
    while not begun.exists():
        assert process.poll() is None, process.stderr.read()
        time.sleep(0.01)
    os.killpg(process.pid, signal.SIGINT)
    stderr = process.communicate()[1]
    assert process.returncode != 0
    assert stderr.rstrip().endswith("KeyboardInterrupt")
    assert stderr.count("Traceback") == 1


def test_a_pool_that_is_closed_leaves_no_thread():
    """The executor's own thread closes a pipe that the interpreter's end would write to."""
    before = {*threading.enumerate()}
    pool = Pool(None, 2)
    pool.executor.submit(time.sleep, 60)
    begun = {*threading.enumerate()} - before
    pool.close()
    assert begun
    assert not any(thread.is_alive() for thread in begun)


def test_a_part_that_was_half_written_is_swept_away(tmp_path):
    run = partial(kl.sweep, 1.0, sweep_measures.total, 2 * BLOCK, lower=[0], upper=[1])
    whole = run(folder=tmp_path, workers=1, chunk=1)
    (tmp_path / ".part-00000001-00000002.npz.abc123").write_bytes(b"half")
    again = run(folder=tmp_path, workers=1, chunk=1)
    assert np.array_equal(whole["value"], again["value"])
    assert not list(tmp_path.glob(".*"))


def test_a_worker_that_dies_costs_nothing(tmp_path):
    flag = str(tmp_path / "died")
    run = partial(kl.sweep, [flag], sweep_measures.dies_once, COUNT, lower=[0, 0], upper=[1, 2])
    result = run(workers=2, chunk=1)
    assert Path(flag).exists()
    assert np.array_equal(result["value"], result.states.sum(axis=1))
    same(run(workers=1), result)


def test_workers_that_always_die_end_the_sweep_with_a_word():
    with pytest.raises(SweepError, match="workers died 3 times in a row .*use workers=1"):
        kl.sweep(1, sweep_measures.dies_always, 9000, lower=[0], upper=[1], workers=2, chunk=1)


def test_a_broken_pool_of_the_callers_is_reported(tmp_path):
    with (
        ProcessPoolExecutor(1, mp_context=get_context("spawn")) as pool,
        pytest.raises(SweepError, match="executor died .*blocks 0.*the same folder="),
    ):
        kl.sweep(1, sweep_measures.dies_always, 9000, lower=[0], upper=[1], executor=pool, chunk=1)


def test_a_script_without_a_main_guard_is_told_so(tmp_path):
    script = tmp_path / "script.py"
    script.write_text(
        "import kinlab as kl\nkl.sweep(kl.load('planar2r'), 'position', 9000, workers=2, chunk=1)\n"
    )
    path = os.pathsep.join([str(Path(__file__).parents[1]), *sys.path])
    done = subprocess.run(
        [sys.executable, str(script)], env={**os.environ, "PYTHONPATH": path},
        capture_output=True, text=True, check=False, timeout=60,
    )  # fmt: skip
    # Python's own resource tracker may have a line of its own after ours
    told = [line for line in done.stderr.splitlines() if line.startswith("kinlab.errors.")]
    assert "call sweep under `if __name__ == '__main__':`" in told[-1]


@pytest.mark.parametrize("workers", [1, 2])
def test_what_the_measure_raises_arrives(workers):
    with pytest.raises(ZeroDivisionError, match="in the measure"):
        kl.sweep(1, sweep_measures.raises, 9000, lower=[0], upper=[1], workers=workers, chunk=1)
    with pytest.raises(StateError, match=r"q has shape \(4096, 2\); expected \(6,\)"):
        kl.sweep(kl.load("puma560"), "position", 9000, lower=[0, 0], upper=[1, 1], workers=workers,
                 chunk=1)  # fmt: skip


def test_the_first_block_that_fails_is_told_whichever_is_faster():
    with pytest.raises(ZeroDivisionError, match=f"block of {BLOCK}"):
        kl.sweep(1, sweep_measures.raises_late, BLOCK + 100, lower=[0], upper=[1], workers=2,
                 chunk=1)  # fmt: skip


def test_memory_is_that_of_a_chunk(tmp_path):
    """20 blocks of 3.3 MB each go to disk and are searched with few of them in memory."""
    block = BLOCK * 100 * 8
    tracemalloc.start()
    try:
        result = kl.sweep(
            1, sweep_measures.wide, 20 * BLOCK, lower=[0], upper=[1], workers=1, chunk=1,
            folder=tmp_path,
        )  # fmt: skip
        result.best("value", 3)
        peak = tracemalloc.get_traced_memory()[1]
    finally:
        tracemalloc.stop()
    assert result["rows"].nbytes == 20 * block
    assert peak < 6 * block


def test_a_folder_of_another_sweep_is_refused(robot, tmp_path):
    def run(subject=robot, measure=sweep_measures.total, samples=100, **options):
        return kl.sweep(subject, measure, samples, workers=1, folder=tmp_path, **options)

    run()
    changes = {
        "robot": {"subject": kl.load("ur5"), "lower": robot.lower, "upper": robot.upper},
        "measure": {"measure": sweep_measures.reach},
        "samples": {"samples": 101},
        "seed": {"seed": 1},
        "lower": {"lower": robot.lower * 0.5},
        "upper": {"upper": robot.upper * 0.5},
    }
    for key, change in changes.items():
        with pytest.raises(OptionError, match=f"holds another sweep: {key} is .* name another"):
            run(**change)
    with pytest.raises(OptionError, match="holds another sweep: "):
        run(samples=np.zeros((100, 6)))
    run()  # and the first still goes on
    (tmp_path / "sweep.json").write_text("{")
    with pytest.raises(FileError, match=r"sweep\.json: not JSON"):
        run()


def test_two_given_stacks_are_two_sweeps(robot, tmp_path):
    run = partial(kl.sweep, robot, sweep_measures.total, workers=1, folder=tmp_path)
    run(np.zeros((5, 6)))
    with pytest.raises(OptionError, match="holds another sweep: states"):
        run(np.ones((5, 6)))


def test_a_folder_that_cannot_be_one(robot, tmp_path):
    (tmp_path / "file").touch()
    with pytest.raises(FileError, match="cannot be made a folder"):
        kl.sweep(robot, "position", 10, workers=1, folder=tmp_path / "file")


def test_parts_and_manifest_are_plain_files(robot, tmp_path):
    kl.sweep(robot, sweep_measures.reach, 100, workers=1, folder=tmp_path)
    with np.load(tmp_path / "part-00000000-00000001.npz") as part:
        assert sorted(part.files) == ["reach", "square"]
    manifest = json.loads((tmp_path / "sweep.json").read_text())
    assert manifest["seed"] == 0 and manifest["block"] == BLOCK
    assert manifest["robot"].startswith("puma560#")


# arguments


@pytest.mark.parametrize(
    ("change", "message"),
    [
        ({"samples": 0}, "samples is 0; at least 1"),
        ({"samples": np.zeros(6)}, r"samples has shape \(6,\); give a whole number, or states"),
        ({"samples": np.zeros((0, 6))}, r"samples has shape \(0, 6\)"),
        ({"samples": [[np.nan] * 6]}, "samples: nan at index"),
        ({"samples": True}, "dtype bool"),
        ({"samples": np.zeros((2, 6)), "lower": [0] * 6}, "the states are given"),
        ({"seed": -1}, "seed is -1; it must be a whole number >= 0"),
        ({"seed": 1.5}, "seed is 1.5"),
        ({"lower": [0, 0]}, r"lower and upper have shapes \(2,\) and \(6,\)"),
        ({"lower": [[0]]}, r"lower has shape \(1, 1\); expected \(n,\)"),
        ({"upper": [9, 9, -99, 9, 9, 9]}, r"lower\[2\] .* is above upper -99"),
        ({"upper": [9, 9, np.inf, 9, 9, 9]}, "upper: inf at index 2"),
        ({"robot": 3.0}, "float has no limits of its own; give lower="),
        ({"workers": 0}, "workers is 0; it must be a whole number above zero"),
        ({"workers": 1.5}, "workers is 1.5"),
        ({"chunk": 0}, "chunk is 0"),
        ({"executor": 2}, r"executor is a int; give .*client.get_executor\(\)"),
        ({"measure": ()}, "name at least one"),
        ({"measure": ["position", "position"]}, "each once"),
        ({"measure": lambda robot, q: q[0]}, r"'value' of shape \(6,\) for 100 states"),
        ({"measure": lambda robot, q: 1.0}, r"'value' of shape \(\) for 100 states"),
        ({"measure": lambda robot, q: None}, "'value': object; numbers only"),
        ({"measure": lambda robot, q: {1: q}}, "numbers only"),
        ({"measure": lambda robot, q: {}}, "an empty dict"),
        ({"workers": 2, "samples": 9000, "chunk": 1, "measure": lambda robot, q: q},
         "the measure cannot be sent to worker processes .* or use workers=1"),
        ({"robot": lambda: 0, "lower": [0], "upper": [1]},
         "the robot cannot be sent to worker processes"),
        ({"samples": 9000, "measure": lambda robot, q: q[:, : 1 + (len(q) == BLOCK)]},
         "answered .* for one block and .* later"),
        ({"samples": 9000, "chunk": 1, "measure": lambda robot, q: q[:, : 1 + (len(q) == BLOCK)]},
         "answered .* for one block and .* later"),
    ],
)  # fmt: skip
def test_a_bad_argument_is_named(robot, change, message):
    arguments = {"robot": robot, "measure": "position", "samples": 100, "workers": 1, **change}
    with pytest.raises(OptionError, match=message):
        kl.sweep(**arguments)


def test_a_name_that_is_none(robot):
    with pytest.raises(NameUnknownError, match="measure 'conditon' is unknown; did you mean 'cond"):
        kl.sweep(robot, "conditon", 10)


def test_missing_fills_every_gap_once():
    rng = np.random.default_rng(0)
    for _ in range(300):
        blocks, size = int(rng.integers(1, 40)), int(rng.integers(1, 12))
        cuts = np.unique(rng.integers(0, blocks + 1, 6))
        done = [(int(a), int(b)) for a, b in pairwise(cuts)][::2]
        plan = missing(done, blocks, size)
        assert all(0 < b - a <= size for a, b in plan)
        covered = [i for a, b in [*done, *plan] for i in range(a, b)]
        assert sorted(covered) == list(range(blocks))


def test_the_bar_counts_to_the_end(robot, capsys):
    kl.sweep(robot, "position", 5000, workers=1, progress=True)
    captured = capsys.readouterr()
    assert captured.out == ""
    assert "5000/5000 states" in captured.err
    kl.sweep(robot, "position", 5000, workers=1)
    assert capsys.readouterr().err == ""
