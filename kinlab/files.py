"""Files are read with a clear error and written whole or not at all."""

from __future__ import annotations

import os
import tempfile
import tomllib
from pathlib import Path
from typing import Any

from kinlab.errors import FileError, KinlabError


def read_text(path: str | Path, *, limit: int = 64 << 20) -> str:
    """Reads a UTF-8 text file.

    Raises:
        FileError: missing, a folder, unreadable, not UTF-8, or larger than ``limit`` bytes.
    """
    file = Path(path)
    try:
        if file.stat().st_size > limit:
            raise FileError(f"{file}: {file.stat().st_size} bytes; at most {limit} are read")
        return file.read_text(encoding="utf-8")
    except FileError:
        raise
    except FileNotFoundError:
        raise FileError(f"{file}: no such file") from None
    except UnicodeDecodeError as problem:
        raise FileError(f"{file}: not UTF-8 text ({problem.reason})") from None
    except OSError as problem:
        raise FileError(f"{file}: cannot be read ({problem.strerror})") from None


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
        raise error(f"{place}: not TOML: {str(problem)[:200]}") from None
    except RecursionError:
        raise error(f"{place}: not TOML: nested too deep") from None
    except ValueError:  # Python's bound on the digits of a whole number
        raise error(f"{place}: not TOML: a number or date that cannot be held") from None


def write_bytes(path: str | Path, content: bytes) -> None:
    """Writes to a temporary name in the same folder and renames it over ``path``.

    The old file stays whole if anything fails.

    Raises:
        FileError: the folder is missing, not writable, or ``path`` is a folder.
    """
    file = Path(path)
    if file.is_dir():
        raise FileError(f"{file}: is a folder; name a file")
    temporary = ""
    try:
        handle, temporary = tempfile.mkstemp(prefix=f".{file.name}.", dir=file.parent)
        with os.fdopen(handle, "wb") as stream:
            stream.write(content)
            stream.flush()
            os.fsync(stream.fileno())
        umask = os.umask(0)
        os.umask(umask)
        Path(temporary).chmod((file.stat().st_mode & 0o777) if file.exists() else 0o666 & ~umask)
        Path(temporary).replace(file)
    except OSError as problem:
        if temporary:
            Path(temporary).unlink(missing_ok=True)
        raise FileError(f"{file}: cannot be written ({problem.strerror})") from None


def write_text(path: str | Path, text: str) -> None:
    """As :func:`write_bytes`, for text in UTF-8."""
    write_bytes(path, text.encode("utf-8"))
