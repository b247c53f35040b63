"""Files are read with a clear error and written whole or not at all."""

from __future__ import annotations

import hashlib
import os
import re
import secrets
import socket
import stat
import sys
import tomllib
from pathlib import Path
from typing import Any

from kinlab.errors import FileError, KinlabError

_HOST = hashlib.sha256(socket.gethostname().encode("utf-8", "replace")).hexdigest()[:8]
_PREFIX = ".kinlab-"
_SWEPT: set[Path] = set()
_STREAMS = {"/dev/stdout": 1, "/dev/stderr": 2}
_INVALID = re.compile(r"Invalid value \((?:at line (\d+), column (\d+)|at end of document)\)")
_KEY = re.compile(r"([\w.-]+)\s*=\s*$")
_OPEN = re.compile(r"(?:/dev|/proc/self)/fd/([0-9]{1,6})")


def read_text(path: str | Path, *, limit: int = 64 << 20) -> str:
    """Reads a UTF-8 text file, without the mark that some editors put in front.

    Raises:
        FileError: missing, no regular file, unreadable, not UTF-8, or larger than ``limit`` bytes.
    """
    file = Path(path)
    try:
        about = file.stat()
        if stat.S_ISDIR(about.st_mode):
            raise FileError(f"{file}: is a folder; name a file")
        if not stat.S_ISREG(about.st_mode):
            raise FileError(f"{file}: is a device or pipe; name a file")
        if about.st_size > limit:
            raise FileError(f"{file}: {about.st_size} bytes; at most {limit} are read")
        return file.read_text(encoding="utf-8").removeprefix("\ufeff")
    except FileError:
        raise
    except FileNotFoundError:
        raise FileError(f"{file}: no such file") from None
    except UnicodeDecodeError as problem:
        raise FileError(f"{file}: not UTF-8 text ({problem.reason})") from None
    except OSError as problem:
        raise FileError(f"{file}: cannot be read ({problem.strerror})") from None
    except ValueError:
        raise FileError(f"{str(file)!r}: no name of a file") from None


def read_toml(text: str, place: str, error: type[KinlabError]) -> dict[str, Any]:
    """Reads TOML text; every way in which that can fail is one error.

    Args:
        text: the TOML.
        place: what to put in front of a message.
        error: the class to raise.

    Raises:
        KinlabError: (the class given) not TOML, nested too deep, or a number of thousands of
            digits.
    """
    try:
        return tomllib.loads(text)
    except tomllib.TOMLDecodeError as problem:
        raise error(f"{place}: not TOML: {_in_words(text, str(problem))}") from None
    except RecursionError:
        raise error(f"{place}: not TOML: nested too deep") from None
    except ValueError:  # Python's bound on the digits of a whole number
        raise error(f"{place}: not TOML: a number or date that cannot be held") from None


def _in_words(text: str, problem: str) -> str:
    """What the TOML reader found, with the key whose value it could not read."""
    found = _INVALID.fullmatch(problem)
    if found is None:
        return problem[:200]
    lines = text.splitlines() or [""]
    line, column = int(found[1] or len(lines)), int(found[2] or len(lines[-1]) + 1)
    row = lines[line - 1] if line <= len(lines) else ""
    key = _KEY.search(row[: column - 1])
    if key is None:
        return problem[:200]
    value = re.split(r"[,}#]", row[column - 1 :])[0].strip()
    told = f"cannot be {value[:40]}; text stands in quotes" if value else "has no value"
    return f'line {line}: {key[1]!r} {told}: {key[1]} = 0.5, or {key[1]} = "pi/2"'


def write_bytes(path: str | Path, content: bytes) -> None:
    """Writes a file whole or not at all.

    The bytes go to a temporary name in the same folder, which is then renamed; an old file stays
    whole if anything fails, and keeps its permissions. A link is followed. A character device
    (``/dev/null``, a terminal) and an open descriptor (``/dev/stdout``, ``/dev/fd/3``) are
    written into.

    Raises:
        FileError: the folder is missing or not writable, or ``path`` is a folder, a pipe, a
            socket or a disk.
    """
    file = Path(path)
    try:
        descriptor = _descriptor(file)
        if descriptor is not None:
            _write_open(descriptor, content)
            return
        target = Path(os.path.realpath(file))
        if target.is_symlink():
            raise FileError(f"{file}: cannot be written (links in a ring)")
        mode = target.stat().st_mode if target.exists() else None
        if mode is not None and stat.S_ISCHR(mode):
            with target.open("wb", buffering=0) as device:
                device.write(content)
            return
        if mode is not None and not stat.S_ISREG(mode):
            kind = "a folder" if stat.S_ISDIR(mode) else "a pipe, socket or disk"
            raise FileError(f"{file}: is {kind}; name a file, or /dev/stdout")
        if mode is not None and not os.access(target, os.W_OK):
            raise FileError(f"{file}: cannot be written (it is read-only)")
        _replace(target, mode, content)
    except FileError:
        raise
    except OSError as problem:
        raise FileError(f"{file}: cannot be written ({problem.strerror})") from None
    except ValueError:
        raise FileError(f"{str(file)!r}: no name of a file") from None


def _replace(target: Path, mode: int | None, content: bytes) -> None:
    sweep_leftovers(target.parent)
    temporary = target.parent / f"{_PREFIX}{_HOST}-{os.getpid()}-{secrets.token_hex(6)}"
    handle = os.open(temporary, os.O_WRONLY | os.O_CREAT | os.O_EXCL, 0o666)  # less the umask
    try:
        with os.fdopen(handle, "wb") as stream:
            if mode is not None:
                os.fchmod(stream.fileno(), mode & 0o777)
            stream.write(content)
            stream.flush()
            os.fsync(stream.fileno())
        temporary.replace(target)
    except BaseException:
        temporary.unlink(missing_ok=True)
        raise


def sweep_leftovers(folder: Path) -> None:
    """Removes the temporary files of runs of this machine that were killed.

    A folder is looked through once in a process.
    """
    if folder in _SWEPT:
        return
    _SWEPT.add(folder)
    with os.scandir(folder) as found:
        names = [entry.name for entry in found if entry.name.startswith(_PREFIX)]
    for name in names:
        host, _, rest = name.removeprefix(_PREFIX).partition("-")
        number = rest.partition("-")[0]
        if host == _HOST and number.isdecimal() and not _alive(int(number)):
            (folder / name).unlink(missing_ok=True)


def _alive(process: int) -> bool:
    try:
        os.kill(process, 0)
    except ProcessLookupError:
        return False
    except (OSError, OverflowError):
        return True  # another user's
    return True


def _descriptor(file: Path) -> int | None:
    """The open descriptor that a name such as /dev/stdout stands for."""
    text = str(file)
    if text in _STREAMS:
        return _STREAMS[text]
    found = _OPEN.fullmatch(text)
    return int(found[1]) if found else None


def _write_open(descriptor: int, content: bytes) -> None:
    for stream in (sys.stdout, sys.stderr):
        stream.flush()
    left = memoryview(content)
    while left:
        left = left[os.write(descriptor, left) :]


def write_text(path: str | Path, text: str) -> None:
    """As :func:`write_bytes`, for text in UTF-8."""
    write_bytes(path, text.encode("utf-8", "replace"))
