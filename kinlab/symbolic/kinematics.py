"""Symbolic forward kinematics and Jacobian, by the product of link transforms.

Sources: Craig, section 3.4 and 5.7 (modified); Siciliano et al., sections 2.8 and 3.1 (standard).
"""

from __future__ import annotations

from functools import lru_cache

import numpy as np
import sympy

from kinlab.arrays import Array
from kinlab.errors import NameUnknownError, near
from kinlab.model.link import Convention
from kinlab.symbolic.arm import SymbolicArm, cos_sin, snapped
from kinlab.symbolic.trig import Poly
from kinlab.symbolic.vocabulary import exact

Grid = list[list[Poly]]
"""Rows of polynomials."""

FRAMES = ("base", "tool", "spatial")


def fk(arm: SymbolicArm) -> sympy.Matrix:
    """Pose of the tool in the base, (4, 4)."""
    return as_matrix(arm, tool_frame(arm))


def frames(arm: SymbolicArm) -> list[sympy.Matrix]:
    """DH frames 1 to n in the base, each (4, 4); the tool is not applied."""
    return [as_matrix(arm, frame) for frame in link_frames(arm)[1:]]


def jacobian(arm: SymbolicArm, frame: str = "base") -> sympy.Matrix:
    """Geometric Jacobian (6, n), linear rows first.

    Args:
        arm: the arm.
        frame: ``"base"``, ``"tool"`` or ``"spatial"``, as in :func:`kinlab.jacobian`.

    Raises:
        NameUnknownError: another frame.
    """
    return as_matrix(arm, jacobian_grid(arm, frame))


@lru_cache(maxsize=32)
def link_frames(arm: SymbolicArm) -> list[Grid]:
    """Frame 0 (the base) and the DH frames 1 to n, as polynomials."""
    out = [_placed(arm, np.asarray(arm.table.base), "base")]
    for i in range(arm.n):
        out.append(product(arm, out[-1], link_step(arm, i)))
    return out


def tool_frame(arm: SymbolicArm) -> Grid:
    """DH frame n times the tool, as polynomials."""
    return product(arm, link_frames(arm)[-1], _placed(arm, np.asarray(arm.table.tool), "tool"))


def axes(arm: SymbolicArm, placed: list[Grid]) -> list[tuple[list[Poly], list[Poly], bool]]:
    """Each joint's axis (signed), a point on it, and whether it turns, all in the base."""
    shift = 1 if arm.table.convention is Convention.MODIFIED else 0
    out = []
    for i, link in enumerate(arm.table.links):
        frame = placed[i + shift]
        axis = [-z if link.flip else z for z in column(frame, 2)]
        out.append((axis, column(frame, 3), link.joint == "revolute"))
    return out


def jacobian_grid(arm: SymbolicArm, frame: str) -> Grid:
    """:func:`jacobian` as polynomials."""
    if frame not in FRAMES:
        raise NameUnknownError(f"frame {frame!r} is unknown; {near(str(frame), FRAMES)}")
    tool = tool_frame(arm)
    point = column(tool, 3)
    if frame == "spatial":
        point = [arm.trig.ring.zero] * 3
    rows = jacobian_at(arm, point)
    if frame == "tool":
        to_tool = [[tool[c][r] for c in range(3)] for r in range(3)]
        rows = [*product(arm, to_tool, rows[:3]), *product(arm, to_tool, rows[3:])]
    return rows


def jacobian_at(arm: SymbolicArm, point: list[Poly], upto: int | None = None) -> Grid:
    """Jacobian of a point, (6, n): rows v then w, in base axes.

    Args:
        arm: the arm.
        point: the reference point in the base.
        upto: only the first so many joints move it; the other columns are zero.
    """
    zero = arm.trig.ring.zero
    columns = []
    for i, (axis, origin, turns) in enumerate(axes(arm, link_frames(arm))):
        if upto is not None and i >= upto:
            columns.append([zero] * 6)
        elif turns:
            arm_of = [p - o for p, o in zip(point, origin, strict=True)]
            columns.append([*cross(arm, axis, arm_of), *axis])
        else:
            columns.append([*axis, zero, zero, zero])
    return [list(row) for row in zip(*columns, strict=True)]


def product(arm: SymbolicArm, one: Grid, two: Grid) -> Grid:
    """The matrix product, reduced."""
    zero = arm.trig.ring.zero
    return [
        [
            arm.trig.reduce(sum((a * b for a, b in zip(row, col, strict=True) if a and b), zero))
            for col in zip(*two, strict=True)
        ]
        for row in one
    ]


def cross(arm: SymbolicArm, one: list[Poly], two: list[Poly]) -> list[Poly]:
    """The vector product, reduced."""
    (a, b, c), (x, y, z) = one, two
    return [arm.trig.reduce(p) for p in (b * z - c * y, c * x - a * z, a * y - b * x)]


def column(grid: Grid, k: int) -> list[Poly]:
    """The upper three entries of column k."""
    return [grid[r][k] for r in range(3)]


def as_matrix(arm: SymbolicArm, rows: Grid) -> sympy.Matrix:
    """Polynomials as a sympy matrix."""
    return sympy.Matrix([[arm.expression(entry) for entry in row] for row in rows])


def _placed(arm: SymbolicArm, transform: Array, which: str) -> Grid:
    """A constant transform: its rotation as numbers, its translation with the arm's names."""
    number = arm.trig.number
    rows = [
        [*(number(exact(snapped(float(x)))) for x in transform[r, :3]), arm.entry(which + axis)]
        for r, axis in enumerate("xyz")
    ]
    zero, one = arm.trig.ring.zero, arm.trig.ring.one
    return [*rows, [zero, zero, zero, one]]


def link_step(arm: SymbolicArm, i: int) -> Grid:
    """^{i-1}T_i of row i (from 0), as :func:`kinlab.model.dh.link_transform` writes it."""
    link, trig = arm.table.links[i], arm.trig
    zero, one = trig.ring.zero, trig.ring.one
    c0, s0 = (trig.number(x) for x in cos_sin(link.theta))
    ca, sa = (trig.number(x) for x in cos_sin(link.alpha))
    a, d = arm.entry(f"a{i + 1}"), arm.entry(f"d{i + 1}")
    sign = -1 if link.flip else 1
    if link.joint == "revolute":
        cq, sq = trig.gens[f"cos q{i + 1}"], trig.gens[f"sin q{i + 1}"] * sign
        c, s = c0 * cq - s0 * sq, s0 * cq + c0 * sq
    else:
        c, s, d = c0, s0, d + trig.gens[f"q{i + 1}"] * sign
    if arm.table.convention is Convention.MODIFIED:
        return [
            [c, -s, zero, a],
            [s * ca, c * ca, -sa, -sa * d],
            [s * sa, c * sa, ca, ca * d],
            [zero, zero, zero, one],
        ]
    return [
        [c, -s * ca, s * sa, a * c],
        [s, c * ca, -c * sa, a * s],
        [zero, sa, ca, d],
        [zero, zero, zero, one],
    ]
