"""The same arm in other frames: other zeros of its joints, another base, another tool.

Joint axes are compared as lines with a sense (screws, Lynch & Park, chapter 4). Two descriptions
are of one arm when its axes can be brought onto one another by moving the base and turning the
joints to other zeros; the tool is then whatever remains.
"""

from __future__ import annotations

from dataclasses import replace

import numpy as np

from kinlab.arrays import Array
from kinlab.doctor.tables.cells import changed, one_change
from kinlab.doctor.tables.chain import THETA, Chain, D, frames, inverse, tool_poses
from kinlab.doctor.tables.readings import Reading
from kinlab.doctor.tables.reference.against import Reference, ReferenceAxes
from kinlab.doctor.tables.words import pose_cause, tidy_length, wrapped
from kinlab.tolerances import TOLERANCES


def same_arm(chain: Chain, reference: Reference) -> Reading | None:
    """The changes of zeros, base and tool that make a table the reference's arm, if any do."""
    axes = reference.axes
    if axes is None or chain.n != reference.n or not np.array_equal(chain.prismatic, axes.slides):
        return None
    starts = [chain]
    moved = _base_moved(chain, axes)
    if moved is not None:
        starts.append(moved)
    for start in starts:
        turned = _zeros(start, axes)
        if turned is None:
            continue
        for end in _with_tool(turned, reference):
            values = {
                (i, c): float(end.cells[i, c])
                for i in range(chain.n)
                for c in (THETA, D)
                if abs(end.cells[i, c] - chain.cells[i, c]) > 1e-9
            }
            told = changed(Reading(chain), values)
            causes = list(told.causes)
            for which in ("tool", "base"):
                one, two = getattr(chain, which), getattr(end, which)
                if np.max(np.abs(one - two)) > 1e-9:
                    causes.insert(0, pose_cause(which, one, two))
            return Reading(end, tuple(causes))
    return None


def _with_tool(turned: Chain, reference: Reference) -> list[Chain]:
    """The last joint's zero from the tool's pose, or else another tool."""
    if reference.target.met(turned):
        return [turned]
    found = [r for r in one_change([Reading(turned)], reference.target) if _zeros_only(r)]
    found.sort(key=lambda r: (r.causes[0].column == "tool", r.cost))
    return [r.chain for r in found[:1]]


def _zeros_only(one: Reading) -> bool:
    for cause in one.causes:
        if cause.column == "tool":
            continue
        if cause.column not in ("theta", "d"):
            return False
        if bool(one.chain.prismatic[cause.rows[0] - 1]) != (cause.column == "d"):
            return False
    return True


def _zeros(chain: Chain, axes: ReferenceAxes) -> Chain | None:
    """Zeros that bring every axis onto the reference's, one joint after the other."""
    current = chain
    for i in range(chain.n):
        mine = ReferenceAxes.of(current)
        if not _on(mine, axes, i):
            return None
        if i + 1 == chain.n:
            break
        change = _change(mine, axes, i)
        if change is None or abs(change) < 1e-9:
            continue
        column = D if chain.prismatic[i] else THETA
        written = float(current.cells[i, column])
        value = written + change * float(chain.sign[i])
        value = tidy_length(value, written) if column == D else wrapped(value)
        current = current.with_cell(i, column, value)
    return current


def _on(one: ReferenceAxes, two: ReferenceAxes, i: int) -> bool:
    """Whether axis i is the same line with the same sense in both."""
    if np.max(np.abs(one.direction[i] - two.direction[i])) > TOLERANCES.same_line:
        return False
    if one.slides[i]:
        return True
    gap = np.cross(one.point[i] - two.point[i], two.direction[i])
    size = max(1.0, float(np.max(np.abs(two.point))))
    return bool(np.max(np.abs(gap)) < TOLERANCES.same_line * size)


def _change(mine: ReferenceAxes, axes: ReferenceAxes, i: int) -> float | None:
    """Motion of joint i that brings the next axis onto the reference's; None where none shows."""
    z, j = axes.direction[i], i + 1
    if axes.slides[i]:
        if axes.slides[j]:
            return None
        across = np.cross(z, axes.direction[j])
        length = float(across @ across)
        if length < 1e-12:
            return None
        shift = axes.point[j] - mine.point[j]
        return float(np.cross(shift, axes.direction[j]) @ across) / length
    pairs = [(mine.direction[j], axes.direction[j])]
    if not axes.slides[j]:
        feet = [_foot(side.point[j], side.direction[j], axes.point[i], z) for side in (mine, axes)]
        pairs.append((feet[0], feet[1]))
    total = 0j
    for was, shall in pairs:
        was, shall = was - (was @ z) * z, shall - (shall @ z) * z
        total += complex(float(was @ shall), float(np.cross(was, shall) @ z))
    return float(np.angle(total)) if abs(total) > 1e-10 else None


def _foot(point: Array, direction: Array, on: Array, z: Array) -> Array:
    """Point of a line nearest to the line through ``on`` along z, from ``on``."""
    away = point - on
    across = np.cross(z, direction)
    length = float(across @ across)
    if length < 1e-12:
        return away
    s = float(np.cross(away, z) @ across) / length
    return away + s * direction


def _base_moved(chain: Chain, axes: ReferenceAxes) -> Chain | None:
    """The chain with its base moved so that its first two axes are the reference's."""
    if chain.n < 2:
        return None
    mine = _pair_frame(ReferenceAxes.of(chain), 0)
    theirs = _pair_frame(axes, 0)
    if mine is None or theirs is None:
        return None
    return replace(chain, base=theirs @ inverse(mine) @ chain.base)


def _pair_frame(axes: ReferenceAxes, i: int) -> Array | None:
    """A frame that axes i and i + 1 determine: z along the first, x along the normal."""
    z, z2 = axes.direction[i], axes.direction[i + 1]
    if axes.slides[i] or axes.slides[i + 1]:
        return None
    foot = _foot(axes.point[i + 1], z2, axes.point[i], z)
    normal = foot - (foot @ z) * z
    length = float(np.linalg.norm(normal))
    if length < 1e-9:
        normal = np.cross(z, z2)
        length = float(np.linalg.norm(normal))
        if length < 1e-9:
            return None
    x = normal / length
    out = np.eye(4)
    out[:3, 0], out[:3, 1], out[:3, 2] = x, np.cross(z, x), z
    out[:3, 3] = axes.point[i] + (foot @ z) * z
    return out


def ends(chain: Chain, reference: Reference) -> tuple[list[Array], list[Array]]:
    """Bases and tools that bring one pair of neighbouring axes onto the reference's.

    The base is the right one where the rows in front of the pair are, the tool where those
    behind it are.
    """
    axes, last = reference.axes, reference.zero_pose
    if axes is None or last is None or chain.n != reference.n:
        return [], []
    mine = ReferenceAxes.of(chain)
    end = frames(chain, np.zeros((1, chain.n)))[0, -2]
    bases: list[Array] = []
    tools: list[Array] = []
    for i in range(chain.n - 1):
        one, two = _pair_frame(mine, i), _pair_frame(axes, i)
        if one is None or two is None:
            continue
        for found, pose in (
            (bases, two @ inverse(one) @ chain.base),
            (tools, inverse(end) @ one @ inverse(two) @ last),
        ):
            if not any(np.max(np.abs(pose - other)) < 1e-9 for other in found):
                found.append(pose)
    return bases, tools


def sure_rows(chain: Chain, reference: Reference) -> tuple[int, ...]:
    """Rows (1-based) that are right for certain: the screws before and behind them agree.

    Args:
        chain: the user's table, of as many joints as the reference.
        reference: with known axes.
    """
    axes = reference.axes
    if axes is None or chain.n != reference.n:
        return ()
    zero = np.zeros((1, chain.n))
    last = reference.zero_pose
    if last is None:
        return ()
    mine = ReferenceAxes.of(chain)
    ahead = 0
    while ahead < chain.n and _on(mine, axes, ahead):
        ahead += 1
    whole = last @ inverse(tool_poses(chain, zero)[0])
    moved = ReferenceAxes(
        mine.direction @ whole[:3, :3].T, mine.point @ whole[:3, :3].T + whole[:3, 3], mine.slides
    )
    behind = chain.n
    while behind > 0 and _on(moved, axes, behind - 1):
        behind -= 1
    # row i is told by the normals in front of and behind axis i, so by axes i - 1, i and i + 1
    rows = {*range(1, ahead), *range(behind + 2, chain.n + 1)}
    return tuple(i for i in sorted(rows) if _tells(axes, i))


def _tells(axes: ReferenceAxes, i: int) -> bool:
    """Whether the axes about row i fix all its cells: no slide has a place, no parallel a d."""
    near = [k for k in (i - 2, i - 1, i) if 0 <= k < len(axes.slides)]
    if any(axes.slides[k] for k in near):
        return False
    normals = [np.cross(axes.direction[k], axes.direction[k + 1]) for k in near[:-1]]
    return all(float(np.linalg.norm(normal)) > TOLERANCES.same_line for normal in normals)
