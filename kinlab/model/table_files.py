"""DH tables as files: TOML (read and written) and CSV (read), as plain values.

TOML keys: ``name``, ``convention``, ``source``, ``gravity``, ``base``, ``tool``, ``tool_name``,
``unphysical`` and one ``[[links]]`` per row with the fields of :class:`kinlab.DHLink`. Numbers may
be text: ``alpha = "pi/2"``, ``theta = "-90 deg"``. ``base`` and ``tool`` are 4x4 matrices or
``{ xyz = [..], rpy = [..] }``; ``inertia`` is 3x3 or ``{ ixx, iyy, izz, ixy, ixz, iyz }``
(the products are the tensor's own entries, as in URDF).

CSV has a header row of the same names, with ``com_x`` ... ``com_z`` and ``ixx`` ... ``iyz``
instead of ``com`` and ``inertia``; the convention is a column, or given by the caller.

``unphysical = true`` (in CSV a column with a true in it) is for tables whose inertias no body can
have, as some are printed.
"""

from __future__ import annotations

import csv
import io
from collections.abc import Iterator, Mapping, Sequence
from pathlib import Path
from typing import Any

import numpy as np
import tomli_w

from kinlab.arrays import Array, truth
from kinlab.errors import ExpressionError, FileError, TableError, near
from kinlab.formulas.numbers import parse_angle, parse_number
from kinlab.host.files import read_text, read_toml
from kinlab.model.link import FRICTION, read_convention
from kinlab.model.rotations import rpy_matrix

MOST_LINKS = 100
"""Most links of a table: the engine's memory grows with the cube, 70 MB at 100."""

_REQUIRED = ("joint", "a", "alpha", "d", "theta")
_LENGTHS = ("a", "d", "velocity", "effort", "mass", "armature", *FRICTION)
_ANGLES = ("alpha", "theta")
_LIMITS = ("lower", "upper")
TENSOR = ("ixx", "iyy", "izz", "ixy", "ixz", "iyz")
COM = ("com_x", "com_y", "com_z")
_DYNAMICS = ("velocity", "effort", "mass", "com", "inertia", "armature", *FRICTION)
_LINK_KEYS = (*_REQUIRED, "flip", *_LIMITS, *_DYNAMICS, "name")
_TABLE_KEYS = (
    *("name", "convention", "source", "gravity", "base", "tool", "tool_name"),
    *("unphysical", "links"),
)
_PLAIN_KEYS = tuple(k for k in _LINK_KEYS if k not in ("com", "inertia"))
_CSV_COLUMNS = (*_PLAIN_KEYS, *COM, *TENSOR, "convention", "unphysical")


def read(path: str | Path, convention: str | None = None) -> dict[str, Any]:
    """Reads the values of a DH table.

    Args:
        path: a ``.toml`` or ``.csv`` file.
        convention: for a CSV without a ``convention`` column.

    Returns:
        The fields of a :class:`kinlab.model.dh.DHTable`, with ``links`` as a list of mappings.

    Raises:
        FileError: the file cannot be read, or is of another kind.
        TableError: a missing or unknown column, or an impossible value, with its place.
    """
    file = Path(path)
    match file.suffix.lower():
        case ".toml":
            return loads(read_text(file), str(file))
        case ".csv":
            return _from_csv(read_text(file), file.stem, convention)
        case other:
            raise FileError(f"{file}: a DH table is a .toml or .csv file, not {other or 'this'!r}")


def loads(text: str, where: str = "text") -> dict[str, Any]:
    """As :func:`read`, from TOML text; ``where`` names it in messages."""
    data = read_toml(text, where, TableError)
    place = f"table {data['name']!r}" if isinstance(data.get("name"), str) else where
    if "l1" in data:
        raise TableError(f"{where}: a five-bar, not a serial arm: kinlab fivebar analyse {where}")
    for key in data:
        if key not in _TABLE_KEYS:
            raise _unknown_column(key, _TABLE_KEYS, place)
    if "name" not in data:
        raise TableError(f"{where}: name is missing")
    rows = data.get("links", [])
    if not isinstance(rows, list) or not all(isinstance(r, dict) for r in rows):
        raise TableError(f"{place}: links must be [[links]] tables, one per row")
    if len(rows) > MOST_LINKS:
        raise TableError(f"{place}: {len(rows)} links; at most {MOST_LINKS}")
    read_convention(data.get("convention"), place)
    optional: dict[str, Any] = {}
    for key in ("base", "tool"):
        if key in data:
            optional[key] = _transform(data[key], f"{place}: {key}")
    if "gravity" in data:
        optional["gravity"] = _numbers(data["gravity"], f"{place}: gravity")
    for key in ("source", "tool_name"):
        if key in data:
            if not isinstance(data[key], str):
                raise TableError(f"{place}: {key} must be text")
            optional[key] = data[key]
    if "unphysical" in data:
        optional["unphysical"] = truth(data["unphysical"], f"{place}: unphysical", TableError)
    links = [_link(row, f"{place}, link {i}") for i, row in enumerate(rows, 1)]
    return {"name": data["name"], "convention": data["convention"], "links": links, **optional}


def dumps(values: Mapping[str, Any]) -> str:
    """TOML text of the values of a table, with every digit; :func:`loads` reads them back."""
    return tomli_w.dumps(_plain(values))


def _plain(value: Any) -> Any:
    if isinstance(value, Mapping):
        return {k: _plain(v) for k, v in value.items() if v is not None}
    if isinstance(value, np.ndarray):
        return value.tolist()
    if isinstance(value, (list, tuple)):
        return [_plain(v) for v in value]
    return str(value) if isinstance(value, str) else value


def _unknown_column(name: str, valid: Sequence[str], place: str) -> TableError:
    return TableError(f"{place}: column {name!r} is unknown; {near(name, valid)}")


def _link(row: Mapping[str, Any], place: str) -> dict[str, Any]:
    for key in row:
        if key == "unphysical":
            raise TableError(f"{place}: unphysical belongs to the whole table, above [[links]]")
        if key not in _LINK_KEYS:
            raise _unknown_column(key, _LINK_KEYS, place)
    for key in _REQUIRED:
        if key not in row:
            raise TableError(f"{place}: column {key!r} is missing")
    values: dict[str, Any] = {}
    try:
        for key, value in row.items():
            if key in _LENGTHS:
                values[key] = parse_number(value)
            elif key in _ANGLES or (key in _LIMITS and row["joint"] == "revolute"):
                values[key] = parse_angle(value)
            elif key in _LIMITS:
                values[key] = parse_number(value)
            elif key == "com":
                values[key] = _numbers(value, f"{place}: com")
            elif key == "inertia":
                values[key] = _tensor(value, f"{place}: inertia")
            else:
                values[key] = value
    except ExpressionError as problem:
        raise TableError(f"{place}: {key}: {problem}") from None
    return values


def _numbers(value: object, place: str) -> Array:
    if not isinstance(value, list):
        raise TableError(f"{place}: must be a list of numbers")
    try:
        return np.array([parse_number(v) for v in value])
    except ExpressionError as problem:
        raise TableError(f"{place}: {problem}") from None


def _matrix(value: object, place: str) -> Array:
    if not isinstance(value, list) or not all(isinstance(r, list) for r in value):
        raise TableError(f"{place}: must be a list of rows")
    rows = [_numbers(row, place) for row in value]
    if len({len(row) for row in rows}) > 1:
        raise TableError(f"{place}: rows of unequal length")
    return np.array(rows)


def _transform(value: object, place: str) -> Array:
    if not isinstance(value, dict):
        return _matrix(value, place)
    for key in value:
        if key not in ("xyz", "rpy"):
            raise _unknown_column(key, ("xyz", "rpy"), place)
    out = np.eye(4)
    if "xyz" in value:
        xyz = _numbers(value["xyz"], f"{place}.xyz")
        if xyz.shape != (3,):
            raise TableError(f"{place}.xyz: {len(xyz)} numbers; expected 3")
        out[:3, 3] = xyz
    if "rpy" in value:
        angles = value["rpy"]
        if not isinstance(angles, list) or len(angles) != 3:
            raise TableError(f"{place}.rpy: expected 3 angles")
        try:
            out[:3, :3] = rpy_matrix(*(parse_angle(v) for v in angles))
        except ExpressionError as problem:
            raise TableError(f"{place}.rpy: {problem}") from None
    return out


def _tensor(value: object, place: str) -> Array:
    if not isinstance(value, dict):
        return _matrix(value, place)
    for key in value:
        if key not in TENSOR:
            raise _unknown_column(key, TENSOR, place)
    try:
        return _assemble({k: parse_number(v) for k, v in value.items()})
    except ExpressionError as problem:
        raise TableError(f"{place}: {problem}") from None


def _assemble(entries: Mapping[str, float]) -> Array:
    ixx, iyy, izz, ixy, ixz, iyz = (entries.get(k, 0.0) for k in TENSOR)
    return np.array([[ixx, ixy, ixz], [ixy, iyy, iyz], [ixz, iyz, izz]])


def _from_csv(text: str, name: str, convention: str | None) -> dict[str, Any]:
    place = f"table {name!r}"
    reader = csv.DictReader(io.StringIO(text.lstrip("\ufeff")), skipinitialspace=True)
    try:
        header = [h.strip() for h in reader.fieldnames or []]
    except csv.Error as problem:
        raise TableError(f"{place}: not CSV: {problem}") from None
    reader.fieldnames = header
    for column in header:
        if column not in _CSV_COLUMNS:
            raise _unknown_column(column, _CSV_COLUMNS, place)
        if header.count(column) > 1:
            raise TableError(f"{place}: column {column!r} stands twice")
    for column in _REQUIRED:
        if column not in header:
            raise TableError(f"{place}: column {column!r} is missing")
    links, unphysical = [], False
    for i, row in enumerate(_rows(reader, place), 1):
        if i > MOST_LINKS:
            raise TableError(f"{place}: more than {MOST_LINKS} links")
        where = f"{place}, link {i}"
        if None in row or None in row.values():
            raise TableError(f"{where}: the row does not have {len(header)} cells")
        cells = {k: v.strip() for k, v in row.items() if v.strip()}
        if "convention" in header:
            stated = read_convention(cells.pop("convention", None), where)
            if convention not in (None, stated):
                raise TableError(f"{where}: convention '{stated}' differs from '{convention}'")
            convention = stated
        unphysical |= _csv_truth(cells.pop("unphysical", "false"), f"{where}: unphysical")
        links.append(_link(_csv_link(cells, where), where))
    values = {"name": name, "convention": convention, "links": links, "source": "CSV import"}
    return {**values, "unphysical": unphysical}


def _rows(reader: csv.DictReader[str], place: str) -> Iterator[dict[str, str]]:
    try:
        yield from reader
    except csv.Error as problem:
        raise TableError(f"{place}: not CSV: line {reader.line_num}: {problem}") from None


def _csv_link(cells: Mapping[str, str], place: str) -> dict[str, Any]:
    row: dict[str, Any] = {k: v for k, v in cells.items() if k not in (*COM, *TENSOR)}
    for column in _REQUIRED:
        if column not in row:
            raise TableError(f"{place}: column {column!r} is empty")
    if "flip" in row:
        row["flip"] = _csv_truth(row["flip"], f"{place}: flip")
    if any(c in cells for c in COM):
        row["com"] = [cells.get(c, "0") for c in COM]
    if any(c in cells for c in TENSOR):
        row["inertia"] = {c: cells.get(c, "0") for c in TENSOR}
    return row


def _csv_truth(cell: str, place: str) -> bool:
    words = {"true": True, "1": True, "yes": True, "false": False, "0": False, "no": False}
    if cell.lower() not in words:
        raise TableError(f"{place} is {cell!r}; it must be true or false")
    return words[cell.lower()]
