"""A DH table as plain arrays: its frames at many states, and the elementary motions of its cells.

Every cell of a row is an elementary motion: theta and d turn about and slide along the z axis
that carries the joint, a and alpha along and about x. Changing a cell by delta moves all that
lies behind it by exp(delta) in one frame of the chain, the same at every state. Everything that
the search knows follows from this (Siciliano et al., section 2.8; Craig, section 3.4).
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, replace
from typing import Any

import numpy as np

from kinlab.arrays import Array
from kinlab.model.dh import DHLink, DHTable
from kinlab.model.link import Convention

COLUMNS = ("a", "alpha", "d", "theta")
A, ALPHA, D, THETA = range(4)
AXIS_OF = {A: 0, ALPHA: 0, D: 2, THETA: 2}
"""The axis, x or z, along or about which a column of the table moves the frame."""


@dataclass(frozen=True, eq=False)
class Chain:
    """The kinematic part of a DH table.

    Attributes:
        modified: the convention is Craig's.
        cells: a, alpha, d, theta of each row, (n, 4), m and rad.
        prismatic: which joints slide, (n,).
        sign: -1 where the joint is flipped, (n,).
        base, tool: as in the table, (4, 4).
        source: the row of the user's table that each row comes from; None where it is new.
    """

    modified: bool
    cells: Array
    prismatic: Array
    sign: Array
    base: Array
    tool: Array
    source: tuple[int | None, ...]

    @property
    def n(self) -> int:
        """Number of joints."""
        return len(self.cells)

    @staticmethod
    def of(table: DHTable) -> Chain:
        """Reads a table."""
        rows = [[link.a, link.alpha, link.d, link.theta] for link in table.links]
        return Chain(
            table.convention is Convention.MODIFIED,
            np.array(rows),
            np.array([link.joint == "prismatic" for link in table.links]),
            np.array([-1.0 if link.flip else 1.0 for link in table.links]),
            np.array(table.base),
            np.array(table.tool),
            tuple(range(table.n)),
        )

    def but(self, **changes: object) -> Chain:
        """The chain with some attributes replaced; ``dataclasses.replace`` takes ten times as long
        and the search makes thousands."""
        new = object.__new__(Chain)
        new.__dict__.update(self.__dict__, **changes)
        return new

    def permuted(self, order: list[int]) -> Chain:
        """The rows of these numbers, with their joints, in this order."""
        source = tuple(self.source[k] for k in order)
        taken = {name: getattr(self, name)[order] for name in ("cells", "prismatic", "sign")}
        return self.but(source=source, **taken)

    def with_cell(self, row: int, column: int, value: float) -> Chain:
        """The chain with one cell (0-based) replaced."""
        cells = self.cells.copy()
        cells[row, column] = value
        return self.but(cells=cells)

    def with_cells(self, cells: Array) -> Chain:
        """The chain with other cells."""
        return self.but(cells=cells)

    def frame_of(self, row: int, column: int) -> int:
        """Index of the frame in which a cell (0-based) moves what lies behind it."""
        along_z = column in (D, THETA)
        return row + (along_z if self.modified else not along_z)

    def apply(self, table: DHTable) -> DHTable:
        """The table with this chain's rows in place of its own."""
        links = []
        for i, origin in enumerate(self.source):
            numbers: dict[str, Any] = dict(zip(COLUMNS, map(float, self.cells[i]), strict=True))
            numbers["joint"] = "prismatic" if self.prismatic[i] else "revolute"
            link = table.links[origin] if origin is not None else DHLink(joint=numbers["joint"])
            if link.joint != numbers["joint"]:
                numbers |= {"lower": None, "upper": None}
            if self.source.count(origin) > 1:
                numbers["name"] = None
            links.append(replace(link, flip=bool(self.sign[i] < 0), **numbers))
        convention = Convention.MODIFIED if self.modified else Convention.STANDARD
        ends: dict[str, Any] = {"base": _rigid(self.base), "tool": _rigid(self.tool)}
        return replace(table, convention=convention, links=links, **ends)


def _rigid(pose: Array) -> Array:
    """A pose whose rotation is orthonormal to rounding."""
    U, _, Vt = np.linalg.svd(pose[:3, :3])
    out = np.array(pose)
    if np.max(np.abs(U @ Vt - pose[:3, :3])) > 1e-15:
        out[:3, :3] = U @ Vt
    out[3] = (0.0, 0.0, 0.0, 1.0)
    return out


def frames(chain: Chain, q: Array) -> Array:
    """Frames 0 to n in the world and last the tool, (N, n + 2, 4, 4), for q (N, n)."""
    out: Array = stacked_frames([chain], q)[0]
    return out


def tool_poses(chain: Chain, q: Array) -> Array:
    """Tool poses, (N, 4, 4)."""
    return frames(chain, q)[:, -1]


def stacked_frames(chains: Sequence[Chain], q: Array) -> Array:
    """As :func:`frames` for chains of equally many joints, (K, N, n + 2, 4, 4)."""
    n, states = chains[0].n, len(q)
    cells = np.array([chain.cells for chain in chains])
    slides = np.array([chain.prismatic for chain in chains])
    move = np.array([chain.sign for chain in chains])[:, None, :] * q
    theta = cells[:, None, :, THETA] + np.where(slides[:, None], 0.0, move)
    d = cells[:, None, :, D] + np.where(slides[:, None], move, 0.0)
    modified = np.array([chain.modified for chain in chains])
    steps = np.zeros((len(chains), states, n, 4, 4))
    steps[..., 3, 3] = 1.0
    ca, sa = np.cos(cells[:, None, :, ALPHA]), np.sin(cells[:, None, :, ALPHA])
    a = cells[:, None, :, A]
    c, s = np.cos(theta), np.sin(theta)
    for which, form in ((modified, _modified), (~modified, _standard)):
        if which.any():
            form(steps, which, a, ca, sa, d, c, s)
    out = np.empty((len(chains), states, n + 2, 4, 4))
    out[:, :, 0] = np.array([chain.base for chain in chains])[:, None]
    for i in range(n):
        out[:, :, i + 1] = out[:, :, i] @ steps[:, :, i]
    out[:, :, -1] = out[:, :, -2] @ np.array([chain.tool for chain in chains])[:, None]
    return out


def _modified(
    steps: Array, k: Array, a: Array, ca: Array, sa: Array, d: Array, c: Array, s: Array
) -> None:
    a, ca, sa, d, c, s = a[k], ca[k], sa[k], d[k], c[k], s[k]
    part = np.zeros((*c.shape, 3, 4))
    part[..., 0, 0], part[..., 0, 1], part[..., 0, 3] = c, -s, a
    part[..., 1, 0], part[..., 1, 1] = s * ca, c * ca
    part[..., 1, 2], part[..., 1, 3] = -sa, -sa * d
    part[..., 2, 0], part[..., 2, 1], part[..., 2, 2], part[..., 2, 3] = s * sa, c * sa, ca, ca * d
    steps[k, ..., :3, :] = part


def _standard(
    steps: Array, k: Array, a: Array, ca: Array, sa: Array, d: Array, c: Array, s: Array
) -> None:
    a, ca, sa, d, c, s = a[k], ca[k], sa[k], d[k], c[k], s[k]
    part = np.zeros((*c.shape, 3, 4))
    part[..., 0, 0], part[..., 0, 1], part[..., 0, 2], part[..., 0, 3] = c, -s * ca, s * sa, a * c
    part[..., 1, 0], part[..., 1, 1], part[..., 1, 2], part[..., 1, 3] = s, c * ca, -c * sa, a * s
    part[..., 2, 1], part[..., 2, 2], part[..., 2, 3] = sa, ca, d
    steps[k, ..., :3, :] = part


def inverse(poses: Array) -> Array:
    """Inverses of rigid transforms (..., 4, 4)."""
    out = np.zeros_like(poses)
    rotation = np.swapaxes(poses[..., :3, :3], -1, -2)
    out[..., :3, :3] = rotation
    out[..., :3, 3] = -(rotation @ poses[..., :3, 3, None])[..., 0]
    out[..., 3, 3] = 1.0
    return out


def row_transform(modified: bool, row: Array) -> Array:
    """Transform of one row a, alpha, d, theta at q = 0, (4, 4)."""
    cells, plain = np.asarray(row, dtype=float)[None], np.eye(4)
    one = Chain(modified, cells, np.array([False]), np.ones(1), plain, plain, (None,))
    out: Array = tool_poses(one, np.zeros((1, 1)))[0]
    return out


def row_of(modified: bool, step: Array, tolerance: float) -> Array | None:
    """The row whose transform at q = 0 is ``step``, or None where no row has it.

    Args:
        modified: the convention.
        step: (4, 4).
        tolerance: of the entries, relative to lengths of 1.
    """
    if modified:
        alpha, theta = np.arctan2(-step[1, 2], step[2, 2]), np.arctan2(-step[0, 1], step[0, 0])
        a, d = step[0, 3], -np.sin(alpha) * step[1, 3] + np.cos(alpha) * step[2, 3]
    else:
        alpha, theta = np.arctan2(step[2, 1], step[2, 2]), np.arctan2(step[1, 0], step[0, 0])
        a, d = np.cos(theta) * step[0, 3] + np.sin(theta) * step[1, 3], step[2, 3]
    row = np.array([a, alpha, d, theta])
    scale = max(1.0, float(np.max(np.abs(step))))
    if np.max(np.abs(row_transform(modified, row) - step)) > tolerance * scale:
        return None
    return row
