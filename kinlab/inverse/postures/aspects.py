"""Aspects: the regions of joint space, within the limits, that singularities do not cut.

det J is a product of functions of a few joints each (:mod:`kinlab.analysis.singularities.minors`).
Joint space within the limits is cut into boxes until a function is shown to keep its sign in a box,
by bounds of the function over it; boxes of one sign that share a face are one region. What is left
are thin boxes around the zeros. Functions of separate joints cut joint space separately: regions of
the groups multiply.

Borrel & Liegeois, "A study of multiple manipulator inverse kinematic solutions with applications
to trajectory planning and workspace determination", IEEE ICRA 1986, where aspects are named.
"""

from __future__ import annotations

from dataclasses import dataclass, field
from typing import Any

import numpy as np
from numpy.typing import ArrayLike

from kinlab.analysis.singularities.factor import Factor
from kinlab.analysis.singularities.minors import factors
from kinlab.analysis.structure.task_space import revolute
from kinlab.arrays import Array, frozen, truth
from kinlab.engine.states import joint_vector
from kinlab.errors import OptionError
from kinlab.host.evidence import Evidence
from kinlab.host.progress import pulse, takes_long
from kinlab.inverse.postures.cuspidality import square_task
from kinlab.model.library import ArmLike, as_robot
from kinlab.model.robot import Robot

_MOST_JOINTS = 3
"""Joints of one group up to which boxes are few enough."""
_DEPTHS = {1: 14, 2: 8, 3: 6}
"""Cells along a joint, a power of two, by the number of joints of a group."""
_MOST_CELLS = 4_000_000


@dataclass(frozen=True, eq=False)
class Aspect:
    """One region without a singularity.

    Attributes:
        signs: of the functions of the group, in their order, 1 or -1.
        q: a configuration within, (n,); joints that do not decide stand in the middle of their
            range.
        share: of the group's joint space that is shown to belong to it.
    """

    signs: tuple[int, ...]
    q: Array
    share: float


@dataclass(frozen=True, eq=False)
class AspectGroup:
    """Regions of the joints that some functions share.

    Attributes:
        joints: their names; empty: no joint decides.
        aspects: the regions, the largest first.
        undecided: share of the group's joint space in boxes around the zeros.
        separate: whether the regions are shown to be distinct: no two of one sign pattern can be
            joined through such boxes.
        cell: (d,), the smallest box, rad or m: regions thinner than this may be missing.
    """

    joints: tuple[str, ...]
    aspects: tuple[Aspect, ...]
    undecided: float
    separate: bool
    cell: Array
    _labels: Any = field(repr=False)
    _index: tuple[int, ...] = field(repr=False)
    _lower: Array = field(repr=False)
    _turning: Any = field(repr=False)

    def at(self, q: Array) -> int | None:
        """Number of the region that q (n,) lies in; ``None`` in a box around a zero, or outside."""
        shape = np.array(self._labels.shape)
        x = (q[list(self._index)] - self._lower) / self.cell
        place = np.floor(x).astype(np.int64)
        place = np.where(
            self._turning, np.mod(place, shape), np.where(x == shape, shape - 1, place)
        )
        if np.any((place < 0) | (place >= shape)):
            return None
        label = int(self._labels[tuple(place)])
        return label if label >= 0 else None


@dataclass(frozen=True, eq=False)
class Aspects:
    """Answer of :func:`aspects`.

    Attributes:
        robot: its name. task: what a pose is.
        groups: functions of separate joints cut separately; an aspect is one region of each.
        count: how many aspects there are: the product; ``None`` where a group has too many joints.
        evidence: what was searched, and what is proved.
    """

    robot: Robot = field(repr=False)
    task: str
    groups: tuple[AspectGroup, ...]
    count: int | None
    evidence: Evidence = field(repr=False)

    def at(self, q: ArrayLike) -> tuple[int, ...] | None:
        """The aspect q (n,) lies in: the region in each group; ``None`` too near a singularity.

        Raises:
            StateError: q of the wrong shape, or not finite.
        """
        state = joint_vector(self.robot, q, "q")
        found = [group.at(state) for group in self.groups]
        numbers = tuple(number for number in found if number is not None)
        return numbers if len(numbers) == len(found) else None


@takes_long("aspects")
def aspects(robot: ArmLike, *, limits: bool = True) -> Aspects:
    """The regions of joint space that singularities do not cut.

    Args:
        robot: an arm with as many joints as its task has coordinates.
        limits: within the joint limits. False: revolute joints turn round without end, whatever
            their limits, as the literature has it; slides keep theirs.

    Returns:
        The regions. Where a function of det J has more than three joints, that group is left out,
        ``count`` is ``None`` and the evidence says so: ask :func:`kinlab.is_cuspidal` there.

    Raises:
        OptionError: a task with more or fewer coordinates than joints, or an arm singular
            everywhere.
    """
    robot = as_robot(robot)
    space = square_task(robot)
    limits = truth(limits, "limits")
    parts = factors(space)
    if parts is None:
        searched = "nothing: the polynomial det J is too large"
        return Aspects(robot, space.name, (), None, Evidence(searched))
    groups, left = [], []
    for together in _groups(parts):
        joints = tuple(sorted({j for part in together for j in part.joints}))
        if len(joints) > _MOST_JOINTS:
            left.append(" and ".join(robot.joint_names[j] for j in joints))
            continue
        groups.append(_cut(robot, joints, together, limits))
    count = None if left else int(np.prod([len(g.aspects) for g in groups], dtype=int))
    return Aspects(robot, space.name, tuple(groups), count, _evidence(groups, left, limits))


def _evidence(groups: list[AspectGroup], left: list[str], limits: bool) -> Evidence:
    where = "within the joint limits" if limits else "with joints that turn round without end"
    boxes = "; ".join(
        f"{' and '.join(g.joints)}: {100.0 * g.undecided:.2g} % left around the zeros"
        for g in groups
    )
    searched = f"all of joint space {where}, in boxes ({boxes or 'no joint decides'})"
    proved = "det J is not zero in the regions, each of which is connected"
    if all(g.separate for g in groups):
        proved += "; no two of them are one"
        found = "that there is no further region, smaller than a box"
    else:
        found = (
            "that no two regions of one sign are joined within the boxes that are left, and that "
            "there is no further region, smaller than a box"
        )
    if left:
        found += f"; of the function of {'; '.join(left)} nothing is known: too many joints"
    return Evidence(searched, proved=proved if groups else "", found=found)


def _groups(parts: tuple[Factor, ...]) -> list[list[Factor]]:
    """Functions that share a joint, together."""
    groups: list[list[Factor]] = []
    for part in parts:
        if part.coefficients.shape[-1] != 1:
            raise OptionError("an arm whose J is not square has no aspects")
        touching = [g for g in groups if any(set(part.joints) & set(o.joints) for o in g)]
        groups = [g for g in groups if g not in touching]
        groups.append([part, *(o for g in touching for o in g)])
    return [sorted(g, key=lambda f: (len(f.joints), f.joints)) for g in groups]


def _cut(robot: Robot, joints: tuple[int, ...], parts: list[Factor], limits: bool) -> AspectGroup:
    index = list(joints)
    d = len(index)
    lower, upper = robot.lower[index].copy(), robot.upper[index].copy()
    turns = revolute(robot)[index]
    turning = turns & (~np.isfinite(upper - lower) | (not limits))
    lower, upper = np.where(turning, -np.pi, lower), np.where(turning, np.pi, upper)
    if not np.all(np.isfinite(upper - lower)):
        raise OptionError(f"robot {robot.name!r}: a slide without limits; give it limits")
    # cells of about one size: a joint of two turns has twice as many
    span = np.where(turns, (upper - lower) / (2.0 * np.pi), 1.0)
    fold = np.maximum(0, np.ceil(np.log2(np.maximum(span, 1e-9)) - 1e-9)).astype(int)
    depth = _DEPTHS[d]
    while np.prod(2.0 ** (depth + fold)) > _MOST_CELLS:
        depth -= 1
    counts = 2 ** (depth + fold)
    cell = (upper - lower) / counts
    signs = np.zeros((*counts, len(parts)), dtype=np.int8)
    for number, part in enumerate(parts):
        own = [index.index(j) for j in part.joints]
        grid = _signs(part, lower[own], cell[own], counts[own])
        shape = [int(counts[i]) if i in own else 1 for i in range(d)]
        signs[..., number] = grid.reshape(shape)
    decided = np.all(signs != 0, axis=-1)
    code = np.where(decided, (signs > 0) @ (1 << np.arange(len(parts))), -1)
    labels = _components(code, turning)
    names = tuple(robot.joint_names[j] for j in index)
    rest = np.where(
        np.isfinite(robot.lower) & np.isfinite(robot.upper), 0.5 * (robot.lower + robot.upper), 0.0
    )
    sizes = np.bincount(labels[labels >= 0])
    order = np.argsort(-sizes, kind="stable")
    rank = np.empty_like(order)
    rank[order] = np.arange(len(order))
    labels = np.where(labels >= 0, rank[labels], -1)
    found = []
    for label in range(len(order)):
        place = _deepest(labels == label, turning)
        q = rest.copy()
        q[index] = lower + (np.array(place) + 0.5) * cell
        found.append(
            Aspect(
                tuple(int(v) for v in signs[place]),
                frozen(q),
                float(sizes[order[label]]) / labels.size,
            )
        )
    return AspectGroup(
        names,
        tuple(found),
        float(np.mean(labels < 0)),
        _separate(signs, labels, turning),
        frozen(cell),
        labels,
        joints,
        frozen(lower),
        turning,
    )


def _signs(part: Factor, lower: Array, cell: Array, counts: Any) -> Any:
    """Sign of a function over each cell of a grid; 0 where a zero was not excluded."""
    d = len(counts)
    out = np.zeros(tuple(counts), dtype=np.int8)
    # boxes of cells, coarse ones first: corner and size, both in cells, powers of two
    start = int(np.gcd.reduce(counts))
    size = start
    origins = np.stack(
        np.meshgrid(*[np.arange(0, c, size) for c in counts], indexing="ij"), axis=-1
    ).reshape(-1, d)
    while len(origins):
        value = np.empty(len(origins))
        reach = np.empty(len(origins))
        for i in range(0, len(origins), 4096):
            pulse()
            some = origins[i : i + 4096]
            half = np.broadcast_to(0.5 * size * cell, some.shape)
            over = part.enclosures(lower + (some + 0.5 * size) * cell, half)
            value[i : i + 4096] = over.value[:, 0]
            reach[i : i + 4096] = (
                np.einsum("nd,nd->n", np.abs(over.gradient[:, 0]), half) + over.rest[:, 0]
            )
        known = np.abs(value) > reach
        for corner, positive in zip(origins[known], value[known] > 0.0, strict=True):
            out[tuple(slice(c, c + size) for c in corner)] = 1 if positive else -1
        origins = origins[~known]
        if size == 1:
            break
        size //= 2
        offsets = size * np.stack(np.meshgrid(*[[0, 1]] * d, indexing="ij"), -1).reshape(-1, d)
        origins = (origins[:, np.newaxis] + offsets).reshape(-1, d)
    return out


def _components(code: Any, turning: Any) -> Any:
    """Labels of cells with one code (>= 0) that share faces; -1 elsewhere."""
    labels = np.full(code.shape, -1, dtype=np.int64)
    count = 0
    for value in np.unique(code[code >= 0]):
        own = _joined(code == value, turning, corners=False)
        labels[own >= 0] = own[own >= 0] + count
        count = int(labels.max()) + 1
    return labels


def _joined(mask: Any, turning: Any, *, corners: bool) -> Any:
    """Labels 0, 1, ... of the connected parts of a mask, -1 elsewhere; joints that turn close.

    Args:
        mask: (c_1, ..., c_d) of booleans. turning: (d,), which axes close in themselves.
        corners: whether cells that share only a corner or an edge are joined too.
    """
    from scipy.ndimage import generate_binary_structure, label
    from scipy.sparse import coo_matrix
    from scipy.sparse.csgraph import connected_components

    d = mask.ndim
    around = [(1, 1) if closed else (0, 0) for closed in turning]
    padded, count = label(
        np.pad(mask, around, mode="wrap"), generate_binary_structure(d, d if corners else 1)
    )
    own = padded[tuple(slice(a, s - a) for (a, _), s in zip(around, padded.shape, strict=True))]
    image = np.pad(own, around, mode="wrap")  # each cell beside its copies beyond the edge
    pairs = np.unique(np.stack([padded[padded > 0], image[padded > 0]]), axis=1) - 1
    graph = coo_matrix((np.ones(pairs.shape[1]), tuple(pairs)), shape=(count, count))
    _, parts = connected_components(graph, directed=False)
    labels = np.full(mask.shape, -1, dtype=np.int64)
    labels[own > 0] = parts[own[own > 0] - 1]
    return labels


def _separate(signs: Any, labels: Any, turning: Any) -> bool:
    """Whether no two regions of one sign pattern can be joined through cells that are left.

    A way that keeps all signs runs only through cells whose known signs are these. Where such
    cells hold two regions together, corners included, nothing is shown.
    """
    for pattern in np.unique(signs[labels >= 0], axis=0):
        open_ = np.all((signs == pattern) | (signs == 0), axis=-1)
        together = _joined(open_, turning, corners=True)
        inside = (labels >= 0) & np.all(signs == pattern, axis=-1)
        pairs = np.unique(np.stack([together[inside], labels[inside]]), axis=1)
        if len(np.unique(pairs[0])) < pairs.shape[1]:
            return False
    return True


def _deepest(region: Any, turning: Any) -> tuple[int, ...]:
    """The cell of a region that is farthest from its edge."""
    from scipy.ndimage import distance_transform_edt

    padded = np.pad(region, [(1, 1)] * region.ndim)
    depth = distance_transform_edt(padded)[(slice(1, -1),) * region.ndim]
    place = np.unravel_index(int(np.argmax(depth)), region.shape)
    return tuple(int(i) for i in place)
