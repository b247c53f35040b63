"""Writing: links are followed, devices survive, permissions follow the umask, leftovers go."""

from __future__ import annotations

import os
import stat
import subprocess
import sys
from pathlib import Path

import pytest

from kinlab.errors import FileError
from kinlab.host.files import read_text, write_text


def test_a_link_is_followed_and_stays_a_link(tmp_path):
    (tmp_path / "store").mkdir()
    target, link = tmp_path / "store" / "real.txt", tmp_path / "link.txt"
    target.write_text("old", encoding="utf-8")
    link.symlink_to(target)
    write_text(link, "new")
    assert link.is_symlink()
    assert target.read_text(encoding="utf-8") == "new"
    assert [p.name for p in (tmp_path / "store").iterdir()] == ["real.txt"]


def test_a_link_to_nothing_makes_its_target(tmp_path):
    (tmp_path / "link.txt").symlink_to(tmp_path / "later.txt")
    write_text(tmp_path / "link.txt", "new")
    assert (tmp_path / "link.txt").is_symlink()
    assert (tmp_path / "later.txt").read_text(encoding="utf-8") == "new"


def test_a_ring_of_links_is_refused(tmp_path):
    (tmp_path / "a").symlink_to(tmp_path / "b")
    (tmp_path / "b").symlink_to(tmp_path / "a")
    with pytest.raises(FileError, match="cannot be"):
        write_text(tmp_path / "a", "new")
    assert (tmp_path / "a").is_symlink()


def test_a_pipe_is_refused_and_stays_a_pipe(tmp_path):
    pipe = tmp_path / "pipe.txt"
    os.mkfifo(pipe)
    for work in (lambda: write_text(pipe, "new"), lambda: read_text(pipe)):
        with pytest.raises(FileError, match="pipe"):
            work()
    assert stat.S_ISFIFO(pipe.stat().st_mode)


def test_a_device_stays_a_device():
    write_text("/dev/null", "new")
    assert stat.S_ISCHR(Path("/dev/null").stat().st_mode)


def test_standard_output_is_written_into():
    done = subprocess.run(
        [sys.executable, "-m", "kinlab", "urdf", "planar2r", "-o", "/dev/stdout"],
        capture_output=True, text=True, check=True,
    )  # fmt: skip
    assert done.stdout.startswith("<?xml")
    assert done.stdout.endswith("</robot>\nwrote /dev/stdout\n")


@pytest.mark.parametrize("umask", [0o022, 0o077, 0o002])
def test_permissions_are_the_umask_s(tmp_path, umask):
    before = os.umask(umask)
    try:
        write_text(tmp_path / "new.txt", "new")
    finally:
        os.umask(before)
    assert stat.S_IMODE((tmp_path / "new.txt").stat().st_mode) == 0o666 & ~umask


def test_an_old_file_keeps_its_permissions(tmp_path):
    file = tmp_path / "old.txt"
    file.write_text("old", encoding="utf-8")
    file.chmod(0o640)
    write_text(file, "new")
    assert stat.S_IMODE(file.stat().st_mode) == 0o640


def test_a_killed_run_leaves_nothing_for_long(tmp_path):
    script = (
        "import os, signal, sys\nfrom kinlab.host import files\n"
        "os.fsync = lambda handle: os.kill(os.getpid(), signal.SIGKILL)\n"
        "files.write_text(sys.argv[1], 'x')\n"
    )
    subprocess.run([sys.executable, "-c", script, str(tmp_path / "new.txt")], check=False)
    (left,) = tmp_path.iterdir()  # .kinlab-<host>-<process>-<random>
    mine = tmp_path / f"{left.name.rsplit('-', 2)[0]}-{os.getpid()}-abc"
    mine.write_text("of a run that lives", encoding="utf-8")
    write_text(tmp_path / "other.txt", "y")
    assert sorted(p.name for p in tmp_path.iterdir()) == sorted([mine.name, "other.txt"])


def test_a_long_name_can_be_written(tmp_path):
    file = tmp_path / ("n" * 250 + ".txt")
    write_text(file, "new")
    assert read_text(file) == "new"


@pytest.mark.parametrize("name", ["a\0b", "n" * 300, "file.txt/in", ""])
def test_a_name_that_is_none(tmp_path, monkeypatch, name):
    monkeypatch.chdir(tmp_path)
    (tmp_path / "file.txt").write_text("", encoding="utf-8")
    for work in (lambda: write_text(name, "new"), lambda: read_text(name)):
        with pytest.raises(FileError):
            work()
