"""Five-bars as TOML: the presets in ``robots/fivebar/`` and files of one's own.

Keys are the arguments of :class:`kinlab.FiveBar`; numbers may be text such as
``"0.2/sqrt(2)"``, and a pair is a list (leg 1, leg 2).
"""

from __future__ import annotations

from collections.abc import Collection
from pathlib import Path
from typing import TYPE_CHECKING, Any

import tomli_w

from kinlab.drives.records import require_known
from kinlab.errors import ExpressionError, FileError, MechanismError, NameUnknownError, near
from kinlab.formulas.numbers import parse_number
from kinlab.host.files import read_text, read_toml, write_text
from kinlab.model.library import presets as presets

if TYPE_CHECKING:
    from kinlab.fivebar.linkage import FiveBar

_TEXT = ("name", "source")


def read(name_or_path: str | Path, keys: Collection[str]) -> dict[str, Any]:
    """Reads the arguments of a five-bar.

    Args:
        name_or_path: a preset ("isotropic"), or a path ending in .toml.
        keys: what the file may hold.

    Returns:
        Arguments for ``FiveBar(**...)``; the name is the file's where it states none.

    Raises:
        NameUnknownError: no preset of that name.
        FileError: the file cannot be read.
        MechanismError: not TOML, a key that does not exist or is missing, or not a number.
    """
    text = str(name_or_path)
    if text.lower().endswith(".toml"):
        path = Path(text)
    elif text in presets():
        path = presets()[text]
    else:
        raise NameUnknownError(f"no five-bar {text!r}; {near(text, presets())}")
    return loads(read_text(path), path.stem, keys)


def holds_five_bar(name_or_path: str | Path) -> bool:
    """Whether a name is a preset's, or a TOML file a five-bar's: those have crank lengths.

    Raises:
        FileError: a .toml file that cannot be read.
    """
    text = str(name_or_path)
    if not text.lower().endswith(".toml"):
        return text in presets()
    content = read_text(text)
    try:
        return "l1" in read_toml(content, text, FileError)
    except FileError:
        return False  # the arm's reader says what is wrong with it


def loads(text: str, name: str, keys: Collection[str]) -> dict[str, Any]:
    """As :func:`read`, from TOML text."""
    data = read_toml(text, f"five-bar {name!r}", MechanismError)
    place = f"five-bar {data.get('name', name)!r}"
    require_known(data, keys, place, MechanismError)
    for key in ("l1", "l2", "e"):
        if key not in data:
            raise MechanismError(f"{place}: key {key!r} is missing")
    return {"name": name, **{key: _value(key, data[key], place) for key in data}}


def _value(key: str, value: object, place: str) -> Any:
    if key in _TEXT:
        if not isinstance(value, str):
            raise MechanismError(f"{place}: {key} must be text")
        return value
    try:
        if not isinstance(value, list):
            return parse_number(value)
        if len(value) == 2:
            return [parse_number(v) for v in value]
    except ExpressionError as problem:
        raise MechanismError(f"{place}: {key}: {problem}") from None
    raise MechanismError(f"{place}: {key} is a list of {len(value)}; a list holds two numbers")


def write(linkage: FiveBar, path: str | Path) -> None:
    """Writes a five-bar; reading it again gives the same one, bit for bit.

    Raises:
        FileError: the file cannot be written; an old one stays whole.
    """
    write_text(path, tomli_w.dumps(linkage.values()))
