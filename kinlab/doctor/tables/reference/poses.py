"""Files of measured or simulated poses.

A CSV with one header line and one line per state. First come the joint positions ``q1`` ... ``qn``,
then the tool's pose in the frame in which the table's base stands, in one of four forms:

- ``T11, T12, T13, T14, T21, ... T34``: the first three rows of T (twelve numbers), or all four;
- ``x, y, z, roll, pitch, yaw``: R = Rz(yaw) Ry(pitch) Rx(roll), as in URDF;
- ``x, y, z, qx, qy, qz, qw``: a unit quaternion, the scalar part last by its name.

A unit may stand behind a name: ``q1 [deg]``, ``x [mm]``, ``roll [deg]``; without it, SI and rad.
"""

from __future__ import annotations

import csv
import io
import math
from collections.abc import Sequence
from pathlib import Path

import numpy as np

from kinlab.arrays import Array
from kinlab.errors import FileError
from kinlab.host.files import read_text
from kinlab.model.rotations import rpy_matrix

_UNITS = {"rad": 1.0, "deg": math.pi / 180.0, "m": 1.0, "mm": 1e-3}
_MATRIX = [f"t{i}{j}" for i in range(1, 5) for j in range(1, 5)]
_RPY = ["x", "y", "z", "roll", "pitch", "yaw"]
_QUATERNION = ["x", "y", "z", "qx", "qy", "qz", "qw"]
_FORMS = (_MATRIX, _MATRIX[:12], _RPY, _QUATERNION)
_SAID = "q1 ... qn and then T11 ... T34, or x, y, z, roll, pitch, yaw, or x, y, z, qx, qy, qz, qw"


def is_poses_file(path: str | Path) -> bool:
    """Whether a CSV holds poses: a DH table has a column alpha.

    Raises:
        FileError: the file cannot be read.
    """
    first = read_text(path).lstrip("\ufeff").split("\n", 1)[0]
    return "alpha" not in [name.strip().lower() for name in first.split(",")]


def read_poses(path: str | Path, n: int) -> tuple[Array, Array]:
    """Reads a CSV of poses.

    Args:
        path: the file.
        n: number of joints of the table, for the message where the file has another.

    Returns:
        q (N, n) and T (N, 4, 4).

    Raises:
        FileError: the file cannot be read, or a column, number or unit is not as described above;
            the message names the line.
    """
    reader = csv.reader(io.StringIO(read_text(path).lstrip("\ufeff")), skipinitialspace=True)
    lines = [row for row in reader if any(cell.strip() for cell in row)]
    if len(lines) < 2:
        raise FileError(f"{path}: no poses; a header and one line per state: {_SAID}")
    names, scales = _header(lines[0], str(path))
    joints = [k for k, name in enumerate(names) if name[0] == "q" and name[1:].isdigit()]
    form = next(
        (f for f in _FORMS if set(f) == {x for k, x in enumerate(names) if k not in joints}), None
    )
    if form is None or not joints:
        raise FileError(f"{path}: columns {', '.join(names)} are no poses; expected {_SAID}")
    order = sorted(joints, key=lambda k: int(names[k][1:]))
    if [int(names[k][1:]) for k in order] != list(range(1, len(order) + 1)):
        raise FileError(f"{path}: joint columns must be q1 to q{len(order)} without a gap")
    if abs(len(order) - n) > 1:
        raise FileError(
            f"{path}: {len(order)} joint columns, the table has {n} rows; give q1 ... q{n}"
        )
    numbers = np.array(
        [_numbers(row, len(names), k + 2, str(path)) for k, row in enumerate(lines[1:])]
    )
    numbers = numbers * scales
    values = numbers[:, [names.index(name) for name in form]]
    return numbers[:, order], _transforms(values, form, str(path))


def _header(cells: Sequence[str], path: str) -> tuple[list[str], Array]:
    names, scales = [], []
    for cell in cells:
        name, _, rest = cell.partition("[")
        unit = rest.rstrip(" ]").strip()
        if unit and unit not in _UNITS:
            raise FileError(
                f"{path}: unit {unit!r} of column {cell.strip()!r}; choose one of "
                f"{', '.join(_UNITS)}"
            )
        names.append(name.strip().lower() or "?")
        scales.append(_UNITS[unit] if unit else 1.0)
    for name in names:
        if names.count(name) > 1:
            raise FileError(f"{path}: column {name!r} stands twice")
    return names, np.array(scales)


def _numbers(row: Sequence[str], count: int, line: int, path: str) -> list[float]:
    if len(row) != count:
        raise FileError(f"{path}: line {line} has {len(row)} cells; expected {count}")
    values = []
    for cell in row:
        try:
            value = float(cell)
        except ValueError:
            raise FileError(f"{path}: line {line}: {cell.strip()!r} is not a number") from None
        if not math.isfinite(value):
            raise FileError(f"{path}: line {line}: {cell.strip()!r} is not finite")
        values.append(value)
    return values


def _transforms(values: Array, form: list[str], path: str) -> Array:
    out = np.zeros((len(values), 4, 4))
    out[:, 3, 3] = 1.0
    if form[0] == "t11":
        full = values.reshape(len(values), -1, 4)
        out[:, : full.shape[1]] = full
        return out
    out[:, :3, 3] = values[:, :3]
    if form is _RPY:
        out[:, :3, :3] = [rpy_matrix(*row[3:]) for row in values]
        return out
    size = np.linalg.norm(values[:, 3:], axis=1)
    bad = np.flatnonzero(np.abs(size - 1.0) > 1e-3)
    if len(bad):
        raise FileError(
            f"{path}: line {int(bad[0]) + 2}: the quaternion has length {size[bad[0]]:.6g}; "
            "expected 1"
        )
    x, y, z, w = (values[:, 3:] / size[:, None]).T
    out[:, 0, :3] = np.stack([1 - 2 * (y * y + z * z), 2 * (x * y - w * z), 2 * (x * z + w * y)], 1)
    out[:, 1, :3] = np.stack([2 * (x * y + w * z), 1 - 2 * (x * x + z * z), 2 * (y * z - w * x)], 1)
    out[:, 2, :3] = np.stack([2 * (x * z - w * y), 2 * (y * z + w * x), 1 - 2 * (x * x + y * y)], 1)
    return out
