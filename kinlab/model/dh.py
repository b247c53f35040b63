"""DH tables: links, conventions, and the hand product of link transforms.

Nothing from Pinocchio is used here, so ``DHTable.fk`` is an oracle for the engine.

Sources: note 000 section 3 and Craig, *Introduction to Robotics*, section 3.4 (modified);
note 002 and Siciliano et al., *Robotics*, section 2.8 (standard).
"""

from __future__ import annotations

import math
import re
from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field, fields, replace
from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import ArrayLike

from kinlab.arrays import (
    Array,
    frozen,
    real_array,
    rigid_transform,
    set_fields,
    shaped,
    shown,
    truth,
)
from kinlab.errors import FileError, StateError, TableError, already_said, warn
from kinlab.host.files import write_text
from kinlab.host.introductions import Introduction, Rows, brief, counted, vector
from kinlab.model import table_files as table_io
from kinlab.model.link import (
    Convention,
    DHLink,
    check_name,
    read_convention,
    refuse_flaw,
    same_value,
)

__all__ = ["DHLink", "DHTable", "link_transform"]

GRAVITY = (0.0, 0.0, -9.81)

_WAY_OUT = (
    "correct the numbers, or say unphysical = true in the table to compute with them as they are"
)

_LINK_NAME = re.compile(r"base_link|(link|dh)_\d+")


@dataclass(frozen=True, eq=False, repr=False)
class DHTable(Rows):
    """A serial arm as a DH table.

    Attributes:
        name: the arm's name.
        convention: ``"standard"`` or ``"modified"``; required.
        links: the rows, from base to tool.
        base: frame 0 in the world, (4, 4).
        tool: the tool in DH frame n, (4, 4).
        gravity: acceleration of gravity in the world, m/s², (3,).
        source: where the numbers come from.
        tool_name: name of the tool frame in the URDF.
        unphysical: inertias that no body can have are meant, as some published tables print
            them: the table loads and computes, and its URDF says so.

    Raises:
        TableError: convention missing or unknown, no links, transforms not rigid, an inertia that
            no body can have (unless ``unphysical``).

    Warns:
        KinlabWarning: an inertia that only rounding keeps from being a body's; an angle of more
            than one turn.
    """

    name: str
    convention: Convention | str | None = None
    links: Sequence[DHLink] = ()
    base: ArrayLike = field(default_factory=lambda: np.eye(4))
    tool: ArrayLike = field(default_factory=lambda: np.eye(4))
    gravity: ArrayLike = GRAVITY
    source: str = ""
    tool_name: str = "tool"
    unphysical: bool = False

    def __post_init__(self) -> None:
        check_name(self.name, "table: name")
        place = f"table {self.name!r}"
        check_name(self.tool_name, f"{place}: tool_name")
        if _LINK_NAME.fullmatch(self.tool_name):
            raise TableError(f"{place}: tool_name {self.tool_name!r} is the name of a link")
        if not isinstance(self.source, str):
            raise TableError(f"{place}: source is {shown(self.source)}; it must be text")
        convention = read_convention(self.convention, place)
        try:
            links = tuple(self.links)
        except TypeError:
            raise TableError(f"{place}: links is {shown(self.links)}; give DHLinks") from None
        if not links:
            raise TableError(f"{place}: it has no links")
        if len(links) > table_io.MOST_LINKS:
            raise TableError(f"{place}: {len(links)} links; at most {table_io.MOST_LINKS}")
        for i, link in enumerate(links, 1):
            if not isinstance(link, DHLink):
                raise TableError(f"{place}, link {i}: {type(link).__name__} is not a DHLink")
        names = [link.name or f"joint_{i}" for i, link in enumerate(links, 1)]
        for i, name in enumerate(names, 1):
            if name in names[: i - 1]:
                raise TableError(f"{place}, link {i}: the name {name!r} is used twice")
        unphysical = truth(self.unphysical, f"{place}: unphysical", TableError)
        for i, link in enumerate(links, 1):
            _check_link(link, " ".join([f"{place}, link {i}", *_quoted(link)]), unphysical)
        ends = {}
        for which in ("base", "tool"):
            transform = rigid_transform(getattr(self, which), f"{place}: {which}", TableError)
            ends[which] = frozen(shaped(transform, (4, 4), f"{place}: {which}", TableError))
        gravity = frozen(shaped(self.gravity, (3,), f"{place}: gravity", TableError))
        set_fields(
            self,
            convention=convention,
            links=links,
            gravity=gravity,
            unphysical=unphysical,
            **ends,
        )

    def __repr__(self) -> str:
        return f"<DHTable {self.name!r}: {self.convention}, {counted(self.n, 'joint')}>"

    def columns(self) -> dict[str, Any]:
        """Row by row, under the names that :meth:`load` reads from CSV, angles in radians.

        Base, tool and gravity have no place there; :meth:`save` keeps them.
        """
        links = self.links
        plain = [f.name for f in fields(DHLink) if f.name not in ("com", "inertia", "name")]
        out = {name: [getattr(link, name) for link in links] for name in plain}
        for k, name in enumerate(table_io.COM):
            out[name] = [float(np.asarray(link.com)[k]) for link in links]
        for name in table_io.TENSOR:
            i, j = ("xyz".index(letter) for letter in name[1:])
            out[name] = [float(np.asarray(link.inertia)[i, j]) for link in links]
        whole = {"convention": str(self.convention), "unphysical": self.unphysical}
        return {"name": list(self.joint_names)} | out | {k: [x] * self.n for k, x in whole.items()}

    def to_csv(self, path: str | Path) -> None:
        """Writes the rows as CSV, numbers with every digit; warns of what has no place there.

        Raises:
            FileError: the file cannot be written; an old one stays whole.
        """
        usual = {"base": np.eye(4), "tool": np.eye(4), "gravity": np.array(GRAVITY)}
        lost = [k for k, value in usual.items() if not np.array_equal(getattr(self, k), value)]
        if lost:
            warn(
                f"{path}: CSV has no place for {' and '.join(lost)} of table {self.name!r}: loaded "
                "again it is another arm; save() keeps the whole table"
            )
        super().to_csv(path)

    def introduction(self) -> Introduction:
        """The rows, with the joints' q in them."""
        slides = sum(link.joint == "prismatic" for link in self.links)
        kinds = counted(self.n, "joint") + (f", {slides} prismatic" if slides else "")
        parts = []
        for which, given in (("base", self.base), ("tool", self.tool)):
            pose = np.asarray(given)
            turned = "" if np.allclose(pose[:3, :3], np.eye(3)) else ", turned"
            if not np.array_equal(pose, np.eye(4)):
                parts.append(f"{which} at {vector(pose[:3, 3])} m{turned}")
        marks = ("unphysical: inertias that no body can have are meant",) if self.unphysical else ()
        lines = (brief(self.source), "; ".join(parts), *marks)
        return Introduction(
            f"DH table {self.name}, {self.convention} convention: {kinds}",
            tuple(line for line in lines if line),
            *row_words(self),
            mood="unsure" if self.unphysical else "",
        )

    def __eq__(self, other: object) -> bool:
        if not isinstance(other, DHTable):
            return NotImplemented
        return all(same_value(getattr(self, f.name), getattr(other, f.name)) for f in fields(self))

    def __hash__(self) -> int:
        return hash((self.name, self.convention, self.links))

    @property
    def n(self) -> int:
        """Number of joints."""
        return len(self.links)

    @property
    def joint_names(self) -> tuple[str, ...]:
        """Names of the joints, numbered where the table names none."""
        return tuple(link.name or f"joint_{i}" for i, link in enumerate(self.links, 1))

    def link_transforms(self, q: ArrayLike) -> Array:
        """Each link's own transform ^{i-1}T_i, without base and tool.

        Args:
            q: joint positions, (n,) or (N, n), rad or m.

        Returns:
            (n, 4, 4) or (N, n, 4, 4).

        Raises:
            StateError: q of another length or type, or not finite.
        """
        values = self._read_q(q)
        transforms = np.empty((*values.shape, 4, 4))
        for i, link in enumerate(self.links):
            move = -values[..., i] if link.flip else values[..., i]
            revolute = link.joint == "revolute"
            theta = link.theta + move if revolute else np.full_like(move, link.theta)
            d = np.full_like(move, link.d) if revolute else link.d + move
            transforms[..., i, :, :] = link_transform(
                Convention(str(self.convention)), link.a, link.alpha, d, theta
            )
        return transforms

    def frames(self, q: ArrayLike) -> Array:
        """DH frames 1 to n in the world, (n, 4, 4) or (N, n, 4, 4); the tool is not applied."""
        steps = self.link_transforms(q)
        out = np.empty_like(steps)
        current = np.asarray(self.base)
        for i in range(self.n):
            current = current @ steps[..., i, :, :]
            out[..., i, :, :] = current
        return out

    def fk(self, q: ArrayLike) -> Array:
        """Forward kinematics by hand: the product of the link transforms (note 000, 000.chain).

        Args:
            q: joint positions, (n,) or (N, n), rad or m.

        Returns:
            (n+1, 4, 4) or (N, n+1, 4, 4) in the world: the base frame 0, DH frames 1 to n-1,
            and last the tool (DH frame n times ``tool``).

        Raises:
            StateError: q of another length or type, or not finite.
        """
        frames = self.frames(q)
        base = np.broadcast_to(np.asarray(self.base), (*frames.shape[:-3], 1, 4, 4))
        out = np.concatenate([base, frames], axis=-3)
        out[..., -1, :, :] = out[..., -1, :, :] @ np.asarray(self.tool)
        return out

    def _read_q(self, q: ArrayLike) -> Array:
        values = real_array(q, f"table {self.name!r}: q")
        if values.ndim not in (1, 2) or values.shape[-1] != self.n:
            raise StateError(
                f"table {self.name!r}: q has shape {values.shape}; "
                f"expected ({self.n},) or (N, {self.n})"
            )
        return values

    @staticmethod
    def load(path: str | Path, convention: str | None = None) -> DHTable:
        """Reads a table from TOML or CSV; :mod:`kinlab.model.table_files` describes the formats.

        Args:
            path: a ``.toml`` or ``.csv`` file.
            convention: for a CSV without a ``convention`` column.

        Raises:
            FileError: the file cannot be read, or is of another kind.
            TableError: a missing or unknown column, or an impossible value, with its place.
        """
        return DHTable.from_columns(table_io.read(path, convention))

    @staticmethod
    def from_columns(columns: Mapping[str, Any]) -> DHTable:
        """Builds a table from plain values, naming the row in every error.

        Args:
            columns: the fields of a table, with ``links`` as a list of mappings.

        Raises:
            TableError: an impossible value, with its place.
        """
        links = []
        for i, row in enumerate(columns["links"], 1):
            try:
                links.append(DHLink(**row))
            except TableError as problem:
                said = str(problem).split(": ", 1)[1]  # the link does not know its row
                raise TableError(f"table {columns['name']!r}, link {i}: {said}") from None
        return DHTable(**{**columns, "links": links})

    def save(self, path: str | Path) -> None:
        """Writes the table as TOML; loading it again gives the same table, bit for bit.

        Raises:
            FileError: the name ends in .csv or .urdf, which hold another text; or the file cannot
                be written; an old one stays whole.
        """
        if Path(path).suffix.lower() in (".csv", ".urdf", ".xml"):
            raise FileError(
                f"{path}: a table is saved as TOML; name a .toml file (to_csv writes the rows, "
                "kl.to_urdf the URDF)"
            )
        write_text(path, self.to_toml())

    def to_toml(self) -> str:
        """The text that :meth:`save` writes."""
        document = {f.name: getattr(self, f.name) for f in fields(self) if f.name != "links"}
        document["unphysical"] = self.unphysical or None
        rows = [{f.name: getattr(link, f.name) for f in fields(link)} for link in self.links]
        return table_io.dumps({**document, "links": rows})


def row_words(table: DHTable) -> tuple[tuple[str, ...], tuple[tuple[str, ...], ...]]:
    """Heads and rows of a table as people read them: degrees, metres, q where it stands."""
    below = "i-1" if table.convention is Convention.MODIFIED else "i"
    rows = []
    for i, link in enumerate(table.links, 1):
        variable = f"-q{i}" if link.flip else f"q{i}"
        a, alpha, d, theta = (
            f"{round(link.a, 9) + 0.0:.8g}",
            f"{round(math.degrees(link.alpha), 7) + 0.0:.8g}°",
            f"{round(link.d, 9) + 0.0:.8g}",
            f"{round(math.degrees(link.theta), 7) + 0.0:.8g}°",
        )
        if link.joint == "revolute":
            theta = _plus(variable, theta)
        else:
            d = _plus(variable, d)
        rows.append((str(i), alpha, a, d, theta))
    return ("i", f"alpha_{below}", f"a_{below} [m]", "d_i [m]", "theta_i"), tuple(rows)


def _plus(variable: str, constant: str) -> str:
    if constant in ("0", "0°"):
        return variable
    return f"{variable} - {constant[1:]}" if constant[0] == "-" else f"{variable} + {constant}"


def with_links(table: DHTable, links: Sequence[DHLink]) -> DHTable:
    """The table with links made out of its own: nothing about them is said or refused again.

    Where a tensor passed the door by the rounding of its digits, ones computed from it stand.
    """
    flawed = any(link.inertia_flaw is not None for link in links)
    with already_said():
        return replace(table, links=links, unphysical=table.unphysical or flawed)


def _quoted(link: DHLink) -> list[str]:
    return [repr(link.name)] if link.name else []


def _check_link(link: DHLink, place: str, unphysical: bool) -> None:
    """What a link may hold but a table asks about: its inertia, and angles beyond one turn.

    Raises:
        TableError: an inertia that no body can have.
    """
    if not unphysical:
        refuse_flaw(link.inertia_flaw, place, TableError, _WAY_OUT)
    for column in ("alpha", "theta"):
        angle = getattr(link, column)
        if abs(angle) > 2.0 * math.pi:
            turns = abs(angle) / (2.0 * math.pi)
            warn(
                f"{place}: {column} is {angle:g} rad, {turns:.3g} turns: degrees? "
                f'({angle:g} deg = {math.radians(angle):.4g} rad; files take "{angle:g} deg")'
            )


def link_transform(
    convention: Convention, a: float, alpha: float, d: ArrayLike, theta: ArrayLike
) -> Array:
    """The transform ^{i-1}T_i of one row, written out entry by entry.

    Args:
        convention: which product of elementary transforms (see :class:`Convention`).
        a: metres. alpha: radians.
        d: metres, any shape S. theta: radians, shape S.

    Returns:
        (*S, 4, 4).
    """
    c, s = np.cos(theta), np.sin(theta)
    ca, sa = math.cos(alpha), math.sin(alpha)
    zero, one = np.zeros_like(c), np.ones_like(c)
    if convention is Convention.MODIFIED:
        rows: list[list[Any]] = [
            [c, -s, zero, a * one],
            [s * ca, c * ca, -sa * one, -sa * np.asarray(d)],
            [s * sa, c * sa, ca * one, ca * np.asarray(d)],
            [zero, zero, zero, one],
        ]
    else:
        rows = [
            [c, -s * ca, s * sa, a * c],
            [s, c * ca, -c * sa, a * s],
            [zero, sa * one, ca * one, np.asarray(d)],
            [zero, zero, zero, one],
        ]
    return np.stack([np.stack(row, axis=-1) for row in rows], axis=-2)
