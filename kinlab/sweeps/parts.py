"""What a sweep has finished: runs of blocks, in memory or as ``.npz`` parts in a folder."""

from __future__ import annotations

import io
import json
import re
from collections.abc import Iterator
from pathlib import Path
from typing import Any, Protocol

import numpy as np

from kinlab.arrays import Array
from kinlab.errors import FileError, OptionError
from kinlab.host.files import read_text, write_bytes, write_text
from kinlab.sweeps.samples import BLOCK

Columns = dict[str, Array]
Run = tuple[int, int]
"""Blocks first to last - 1."""

MANIFEST = "sweep.json"
_PART = re.compile(r"part-(\d{8})-(\d{8})\.npz")
_HALF = ".part-*.npz.*"
"""What a run that was killed while it wrote leaves behind (see :mod:`kinlab.host.files`)."""


class Parts(Protocol):
    """Finished runs of blocks."""

    def runs(self) -> list[Run]:
        """The finished runs, ascending, without overlap."""

    def read(self, run: Run) -> Columns:
        """The columns of one run."""

    def write(self, run: Run, columns: Columns) -> None:
        """Keeps the columns of one run."""


class Memory:
    """Parts in memory: bounded by the sweep's answers."""

    def __init__(self) -> None:
        self._parts: dict[Run, Columns] = {}

    def runs(self) -> list[Run]:
        """See :class:`Parts`."""
        return sorted(self._parts)

    def read(self, run: Run) -> Columns:
        """See :class:`Parts`."""
        return self._parts[run]

    def write(self, run: Run, columns: Columns) -> None:
        """See :class:`Parts`."""
        self._parts[run] = columns


class Folder:
    """Parts as files: bounded by a chunk, and a run that was stopped goes on from them.

    Args:
        path: the folder; made if it is missing.
        fingerprint: what must be equal for parts to be used again.
        blocks: how many blocks the sweep has.

    Raises:
        FileError: not a folder, or not writable.
        OptionError: it holds the parts of another sweep; the message names the difference.
    """

    def __init__(self, path: str | Path, fingerprint: dict[str, Any], blocks: int) -> None:
        self.path = Path(path)
        try:
            self.path.mkdir(parents=True, exist_ok=True)
        except OSError as problem:
            raise FileError(f"{self.path}: cannot be made a folder ({problem.strerror})") from None
        manifest = self.path / MANIFEST
        if manifest.exists():
            _same_sweep(manifest, fingerprint)
        else:
            write_text(manifest, json.dumps(fingerprint, indent=1) + "\n")
        for half in self.path.glob(_HALF):
            half.unlink(missing_ok=True)
        self._runs: set[Run] = set()
        covered = np.zeros(blocks, dtype=bool)
        for run in self._found():
            if run[1] <= blocks and not covered[slice(*run)].any() and self._intact(run, blocks):
                covered[slice(*run)] = True
                self._runs.add(run)

    def runs(self) -> list[Run]:
        """See :class:`Parts`."""
        return sorted(self._runs)

    def read(self, run: Run) -> Columns:
        """See :class:`Parts`."""
        with np.load(self._file(run), allow_pickle=False) as part:
            return {name: part[name] for name in part.files}

    def write(self, run: Run, columns: Columns) -> None:
        """See :class:`Parts`; whole or not at all."""
        buffer = io.BytesIO()
        np.savez(buffer, allow_pickle=False, **columns)
        write_bytes(self._file(run), buffer.getvalue())
        self._runs.add(run)

    def _file(self, run: Run) -> Path:
        return self.path / f"part-{run[0]:08d}-{run[1]:08d}.npz"

    def _found(self) -> Iterator[Run]:
        for file in sorted(self.path.iterdir()):
            match = _PART.fullmatch(file.name)
            if match:
                yield int(match[1]), int(match[2])

    def _intact(self, run: Run, blocks: int) -> bool:
        """Whether a part can be read and has its rows; one that cannot is worked out again."""
        try:
            lengths = {len(column) for column in self.read(run).values()}
        except Exception:  # noqa: BLE001  whatever a damaged archive makes its reader raise
            return False
        least = (run[1] - run[0] - 1) * BLOCK
        full = (run[1] - run[0]) * BLOCK
        return len(lengths) == 1 and (
            lengths == {full} or (run[1] == blocks and least < min(lengths) <= full)
        )


def _same_sweep(manifest: Path, fingerprint: dict[str, Any]) -> None:
    try:
        found = json.loads(read_text(manifest))
    except (ValueError, RecursionError) as problem:
        raise FileError(f"{manifest}: not JSON ({problem}); name another folder") from None
    wanted = json.loads(json.dumps(fingerprint))
    for key in [*wanted, *(found if isinstance(found, dict) else ())]:
        there = found.get(key) if isinstance(found, dict) else None
        if there != wanted.get(key):
            raise OptionError(
                f"{manifest.parent}: holds another sweep: {key} is {there!r} there and "
                f"{wanted.get(key)!r} here; name another folder"
            )
