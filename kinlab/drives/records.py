"""Catalogues of one's own: TOML or CSV files of motors and gearboxes, read with every row named."""

from __future__ import annotations

import csv
import io
from collections.abc import Callable, Iterable, Mapping, Sequence
from dataclasses import fields
from pathlib import Path
from typing import Any, Protocol, TypeVar

import numpy as np

from kinlab.errors import ExpressionError, KinlabError, MotorError, OptionError, near
from kinlab.formulas.numbers import parse_number
from kinlab.host.files import read_text, read_toml

TEXT = ("name", "maker", "data_sheet")
"""What of a record is no figure."""

TABLES = ("motors", "gears")
"""The tables that a catalogue in TOML may hold."""


class Record(Protocol):
    """A dataclass with a name."""

    @property
    def name(self) -> str: ...


T = TypeVar("T", bound=Record)


def check_figures(record: Record, kind: str, may_be_zero: tuple[str, ...] = ()) -> None:
    """Refuses a record whose text is no text, or with a figure that is no positive number.

    Args:
        record: the dataclass; figures that are ``None`` are not stated.
        kind: ``"motor"`` or ``"gearbox"``, for the message.
        may_be_zero: figures of which zero is a value.

    Raises:
        MotorError: what is wrong, and with which record.
    """
    for figure, value in vars(record).items():
        if figure in TEXT:
            if not isinstance(value, str):
                raise MotorError(f"{kind} {record.name!r}: {figure} is {value!r}; it must be text")
        elif value is not None:
            sound = isinstance(value, (int, float)) and not isinstance(value, bool)
            zero = figure in may_be_zero
            least = "zero or a positive" if zero else "a positive"
            if not sound or not np.isfinite(value) or value < 0 or (value == 0 and not zero):
                raise MotorError(
                    f"{kind} {record.name!r}: {figure} is {value!r}; it must be {least} number"
                )


def check_order(record: Record, kind: str, low: str, high: str) -> None:
    """Refuses a record whose figure ``low`` is larger than its figure ``high``.

    Raises:
        MotorError: with both.
    """
    small, large = getattr(record, low), getattr(record, high)
    if small is not None and large is not None and small > large:
        raise MotorError(
            f"{kind} {record.name!r}: {low} is {small:g} and {high} {large:g}; {high} must not be "
            "the smaller one"
        )


def read_records(
    path: str | Path, table: str, record: type[T], needed: tuple[str, ...] = ("name",)
) -> dict[str, T]:
    """Reads a catalogue: TOML with one ``[[motors]]`` or ``[[gears]]`` each, or CSV.

    A CSV file has the same keys in its first line, separated by commas or semicolons, and one
    record a line; an empty cell is not stated.

    Args:
        path: a file; one that ends in .csv is CSV.
        table: ``"motors"`` or ``"gears"``.
        record: the dataclass of one row.
        needed: the keys that every row must state.

    Returns:
        Records by name, in the order of the file.

    Raises:
        FileError: the file cannot be read.
        MotorError: not TOML or CSV, an unknown key, a key missing, a name twice, an impossible
            figure.
    """
    text = read_text(path)
    is_csv = Path(path).suffix.lower() == ".csv"
    rows = csv_rows(text, str(path)) if is_csv else _toml_rows(text, str(path), table)
    kind = table.removesuffix("s")
    out: dict[str, T] = {}
    for i, row in enumerate(rows, 1):
        place = f"{path}, {kind} {i}"
        one = _record(row, place, record, needed)
        if one.name in out:
            raise MotorError(f"{place}: the name {one.name!r} is used twice")
        out[one.name] = one
    return out


def require_known(
    data: Iterable[str], keys: Iterable[str], place: str, error: type[KinlabError]
) -> None:
    """Refuses a key that is none, with the nearest ones.

    Raises:
        KinlabError: (the class given) naming the key.
    """
    known = list(keys)
    for key in data:
        if key not in known:
            raise error(f"{place}: key {key!r} is unknown; {near(key, known)}")


def several(
    given: Any, kind: type[T], what: str, read: Callable[[str | Path], Mapping[str, T]]
) -> list[T]:
    """Reads records in any of the forms that sizing takes: a file, one, or several.

    Raises:
        OptionError: anything else, or an empty list. KinlabError: as ``read``.
    """
    if isinstance(given, (str, Path)):
        return list(read(given).values())
    rows = [given] if isinstance(given, kind) else given
    rows = list(rows) if isinstance(rows, Sequence) else []
    if not rows or not all(isinstance(one, kind) for one in rows):
        plural = "Gearboxes" if what == "gears" else "Motors"
        raise OptionError(
            f"{what}: give a .toml or .csv file, a {kind.__name__}, or a list of {plural}"
        )
    return rows


def _toml_rows(text: str, path: str, table: str) -> list[Mapping[str, Any]]:
    data = read_toml(text, path, MotorError)
    require_known(data, TABLES, path, MotorError)
    rows = data.get(table, [])
    if not isinstance(rows, list) or not rows or not all(isinstance(row, dict) for row in rows):
        raise MotorError(f"{path}: no [[{table}]] in it")
    return rows


def csv_rows(
    text: str, path: str, error: type[KinlabError] = MotorError
) -> list[Mapping[str, Any]]:
    """The rows of a CSV file by the names in its first line; empty cells are left out.

    Raises:
        KinlabError: (the class given) not CSV, no rows, a row of another length, a column twice.
    """
    head = text.partition("\n")[0]
    mark = ";" if head.count(";") > head.count(",") else ","
    try:
        lines = list(csv.reader(io.StringIO(text), delimiter=mark, strict=True))
    except csv.Error as problem:
        raise error(f"{path}: not CSV: {problem}") from None
    filled = [(i, line) for i, line in enumerate(lines, 1) if any(cell.strip() for cell in line)]
    if len(filled) < 2:
        raise error(f"{path}: no rows in it; the first line names the columns")
    keys = [cell.strip() for cell in filled[0][1]]
    if len(set(keys)) < len(keys):
        twice = next(key for key in keys if keys.count(key) > 1)
        raise error(f"{path}: the column {twice!r} stands twice in the first line")
    rows: list[Mapping[str, Any]] = []
    for i, line in filled[1:]:
        if len(line) != len(keys):
            raise error(f"{path}, line {i}: {len(line)} cells; the first line has {len(keys)}")
        cells = dict(zip(keys, (cell.strip() for cell in line), strict=True))
        rows.append({key: cell for key, cell in cells.items() if cell})
    return rows


def _record(row: Mapping[str, Any], place: str, record: type[T], needed: tuple[str, ...]) -> T:
    keys = [f.name for f in fields(record)]  # type: ignore[arg-type]
    require_known(row, keys, place, MotorError)
    if not isinstance(row.get("name"), str) or not row["name"].strip():
        raise MotorError(f"{place}: name is missing")
    for key in needed:
        if key not in row:
            raise MotorError(f"{place} ({row['name']}): {key} is missing")
    values = {
        key: _figure(value, f"{place} ({row['name']}): {key}")
        if isinstance(value, str) and key not in TEXT
        else value
        for key, value in row.items()
    }
    return record(**values)


def _figure(text: str, place: str) -> float:
    try:
        return parse_number(text)
    except ExpressionError as problem:
        raise MotorError(f"{place}: {problem}") from None
