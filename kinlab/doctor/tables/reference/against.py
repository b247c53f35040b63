"""What a table is compared with: a table, a name, a URDF, a robot, or poses at joint positions."""

from __future__ import annotations

import re
from collections.abc import Sequence
from dataclasses import dataclass, field, replace
from pathlib import Path
from typing import Any

import numpy as np
import pinocchio as pin
from numpy.typing import ArrayLike

from kinlab.arrays import Array, real_array
from kinlab.doctor.tables.bodies import Bodies
from kinlab.doctor.tables.chain import Chain, frames, inverse
from kinlab.doctor.tables.reference.target import Target
from kinlab.engine.kinematics import fk, jacobian
from kinlab.errors import KinlabError, StateError, StructureError, TableError
from kinlab.host.language import _
from kinlab.model.dh import DHTable
from kinlab.model.library import load
from kinlab.model.robot import Robot
from kinlab.model.urdf_records import EXTENSION
from kinlab.tolerances import TOLERANCES

STATES = 40
"""Random states at which an arm that is known as a whole is compared."""


@dataclass(frozen=True, eq=False)
class ReferenceAxes:
    """Joint axes in the world at q = 0.

    Attributes:
        direction: unit vectors in the sense of the joints, (n, 3).
        point: a point on each axis, (n, 3); of no meaning for prismatic joints.
        slides: which joints are prismatic, (n,).
    """

    direction: Array
    point: Array
    slides: Array

    @staticmethod
    def of(chain: Chain) -> ReferenceAxes:
        """The axes of a table."""
        poses = frames(chain, np.zeros((1, chain.n)))[0]
        carriers = poses[1:-1] if chain.modified else poses[:-2]
        return ReferenceAxes(
            carriers[:, :3, 2] * chain.sign[:, None], carriers[:, :3, 3], chain.prismatic
        )


@dataclass(frozen=True, eq=False)
class Reference:
    """The other side of the comparison.

    Attributes:
        name: what to call it.
        target: its poses.
        chain: its own rows, where it is a DH table.
        base, tool: frames it is known to have; candidates for those of the user's table.
        axes: its joint axes; None where only poses are known.
        zero_pose: its tool at q = 0, (4, 4), likewise.
        bodies: None where it has no masses or nothing is known of them.
        joint_names: None where it names none.
        notes: what the user should know about it.
        sharper: the same with rounded angles read as what they round.
    """

    name: str
    target: Target
    chain: Chain | None = None
    base: list[Array] = field(default_factory=list)
    tool: list[Array] = field(default_factory=list)
    axes: ReferenceAxes | None = None
    zero_pose: Array | None = None
    bodies: Bodies | None = None
    joint_names: tuple[str, ...] | None = None
    notes: tuple[str, ...] = ()
    sharper: Reference | None = None

    @property
    def n(self) -> int:
        """Number of joints."""
        return int(self.target.q.shape[1])

    @property
    def still(self) -> tuple[int, ...]:
        """The joints that move in none of the poses, counted from 1."""
        moved = np.ptp(self.target.q, axis=0)
        return tuple(int(k) + 1 for k in np.flatnonzero(moved <= TOLERANCES.still))

    def unseen(self, mine: Chain) -> set[int]:
        """The rows that poses tell nothing for sure of: those around the axes of joints at rest."""
        if self.axes is not None:
            return set()
        around = (0, 1) if mine.modified else (-1, 0)
        rows = {joint + k for joint in self.still for k in around}
        return {row for row in rows if 1 <= row <= mine.n}

    def facts(self, mine: DHTable, before: float, notes: Sequence[str]) -> dict[str, Any]:
        """What every diagnosis of a table says of the comparison; ``before``: its error."""
        return {
            "mine": mine,
            "reference": self.name,
            "states": len(self.target.q),
            "error_before": before,
            "tolerance": self.target.tolerance,
            "notes": tuple(notes),
            "unseen_rows": tuple(sorted(self.unseen(Chain.of(mine)))),
        }


def read_mine(mine: DHTable | Robot | str | Path) -> DHTable:
    """The user's table: as given, from a file, by a shipped name, or of a robot that has one.

    Raises:
        TableError: it is no DH table.
        FileError, NameUnknownError: the file or name does not exist.
    """
    if isinstance(mine, DHTable):
        return mine
    if isinstance(mine, (str, Path)):
        text = str(mine)
        if text.lower().endswith((".toml", ".csv")):
            return DHTable.load(text)
        if not text.lower().endswith((".urdf", ".xml")):
            mine = load(text)
        else:
            raise TableError(
                f"{text}: the table to judge is a .toml or .csv file; a URDF can be "
                "what it is held against"
            )
    if isinstance(mine, Robot) and mine.table is not None:
        return mine.table
    raise TableError(
        f"{getattr(mine, 'name', type(mine).__name__)!r} is no DH table; give a DHTable or a .toml "
        "or .csv file (kl.to_dh reads a table off a robot)"
    )


def read_reference(against: Any, table: DHTable, *, tool: str | None, seed: int) -> Reference:
    """Reads what the table is held against.

    Args:
        against: a DHTable, Robot, name, path of a table, URDF or CSV of poses, URDF text, or
            ``(q, T)``.
        table: the user's table, which a message may need.
        tool: for a URDF: the link that is the tool.
        seed: of the states.

    Raises:
        KinlabError: what cannot be used, with its remedy.
    """
    poses = poses_of(against, table.n)
    if poses is not None:
        given = isinstance(against, (str, Path))
        return of_poses(*poses, name=Path(str(against)).name if given else "")
    against = reference_robot(against, tool)
    if isinstance(against, DHTable):
        return _of_table(against, seed)
    if against.table is not None:
        return _of_table(against.table, seed)
    reference = _of_robot(against, seed)
    text = _sharpened(against.urdf)
    if text is None:
        return reference
    try:
        sharp = _of_robot(Robot.from_urdf(text, against.tool_name), seed)
    except KinlabError:
        return reference
    note = _("the angles of the URDF are printed with few digits; read as the multiples of 15 deg")
    sharp = replace(sharp, name=reference.name, notes=(*sharp.notes, note))
    return replace(reference, sharper=sharp)


def poses_of(against: Any, n: int) -> tuple[ArrayLike, ArrayLike] | None:
    """q and T, where poses are given as arrays or as a CSV; else None.

    Args:
        against: as for :func:`read_reference`.
        n: joints of the user's table.

    Raises:
        FileError: a CSV that cannot be read.
    """
    if isinstance(against, tuple) and len(against) == 2:
        return against
    if isinstance(against, (str, Path)) and str(against).lower().endswith(".csv"):
        from kinlab.doctor.tables.reference.poses import is_poses_file, read_poses

        if is_poses_file(against):
            return read_poses(against, n)
    return None


def reference_robot(against: Any, tool: str | None) -> Robot | DHTable:
    """The robot or table that a reference other than poses is.

    Raises:
        TableError: it is none.
        KinlabError: a file or name that cannot be used.
    """
    if isinstance(against, DHTable):
        return against
    if isinstance(against, Path) or (isinstance(against, str) and "<" not in against):
        against = load(against, tool)
    elif isinstance(against, str):
        against = Robot.from_urdf(against, tool)
    elif isinstance(against, pin.Model):
        against = Robot.from_model(against, tool)
    if not isinstance(against, Robot):
        raise TableError(
            f"{type(against).__name__} is nothing to compare a table with; give a DHTable, a "
            "robot, a name, a .toml, .csv or .urdf file, or poses=(q, T)"
        )
    return against


def of_poses(q: ArrayLike, T: ArrayLike, name: str = "") -> Reference:
    """Measured or simulated poses.

    Args:
        q: (N, n), rad and m. T: (N, 4, 4), in the frame in which the table's base stands.
        name: what to call them; empty: the poses.

    Raises:
        StateError: shapes that do not agree, too few poses, or T that is not rigid.
    """
    states = real_array(q, "poses: q")
    poses = real_array(T, "poses: T")
    if states.ndim != 2 or poses.shape != (len(states), 4, 4):
        raise StateError(
            f"poses: q has shape {states.shape} and T {poses.shape}; expected (N, n) and (N, 4, 4)"
        )
    if len(states) < 3:
        raise StateError(f"poses: {len(states)} of them; give three or more, at differing q")
    if states.shape[1] and np.all(np.ptp(states, axis=0) <= TOLERANCES.still):
        raise StateError("poses: all are at one q; give three or more, at differing q")
    rotation = poses[:, :3, :3]
    off = np.max(np.abs(np.swapaxes(rotation, -1, -2) @ rotation - np.eye(3)), axis=(1, 2))
    last = np.abs(poses[:, 3] - (0.0, 0.0, 0.0, 1.0)).max(axis=1)
    bad = np.flatnonzero((off > 1e-3) | (last > 1e-12) | (np.linalg.det(rotation) < 0))
    if len(bad):
        raise StateError(
            f"poses: T of state {int(bad[0]) + 1} is no rigid transform (R^T R misses 1 by "
            f"{off[bad[0]]:.2g}); give [R p; 0 0 0 1] with R a rotation"
        )
    U, _sizes, Vt = np.linalg.svd(rotation)
    clean = poses.copy()
    clean[:, :3, :3] = U @ Vt
    rounding = float(np.max(np.abs(clean - poses)))  # of printed rotations
    target = Target(states, clean, max(1e-9, 4.0 * rounding))
    return Reference(name or _("the poses"), target)


def _states(n: int, slides: Array, seed: int) -> Array:
    rng = np.random.default_rng(seed)
    q = rng.uniform(-np.pi, np.pi, (STATES, n))
    q[:, slides] /= np.pi
    return q


def _of_table(table: DHTable, seed: int) -> Reference:
    chain = Chain.of(table)
    q = _states(table.n, chain.prismatic, seed)
    bodies = Bodies.of(table)
    names = tuple(link.name or "" for link in table.links)
    return Reference(
        table.name,
        Target(q, table.fk(q)[:, -1]),
        chain,
        [np.array(table.base)],
        [np.array(table.tool)],
        ReferenceAxes.of(chain),
        table.fk(np.zeros(table.n))[-1],
        bodies if bodies.any else None,
        names if all(names) else None,
    )


def _of_robot(robot: Robot, seed: int) -> Reference:
    model, data = robot.model, robot.model.createData()
    zero = np.zeros(robot.n)
    pin.forwardKinematics(model, data, zero)
    spatial = jacobian(robot, zero, "spatial").T.reshape(robot.n, 6)
    linear, angular = spatial[:, :3], spatial[:, 3:]
    slides = np.linalg.norm(angular, axis=1) < 0.5
    direction = np.where(slides[:, None], linear, angular)
    q = _states(robot.n, slides, seed)
    digit = _last_digit(robot.urdf)
    rounding = 0.5 * digit * 2.0 * (robot.n + 1)
    mass, com, inertia = [], [], []
    for j in range(1, model.njoints):
        body = data.oMi[j].act(model.inertias[j])
        mass.append(float(body.mass))
        com.append(np.array(body.lever))
        inertia.append(np.array(body.inertia))
    stated = f"<{EXTENSION}" in robot.urdf or not robot.urdf
    bodies = Bodies(
        np.array(mass),
        np.array(com),
        np.array(inertia),
        np.array(model.armature) if stated else None,
        np.array(model.gravity.linear) if stated else None,
        digit,
    )
    last = model.frames[robot.tool].placement.homogeneous
    tools = [last]
    if model.existFrame(f"dh_{robot.n}"):
        dh = model.frames[model.getFrameId(f"dh_{robot.n}")].placement.homogeneous
        tools.insert(0, inverse(dh) @ last)
    notes = () if stated else (_("a URDF states neither gravity nor armature: not compared"),)
    return Reference(
        robot.name,
        Target(q, fk(robot, q), max(1e-9, rounding)),
        None,
        [np.eye(4), model.jointPlacements[1].homogeneous],
        tools,
        ReferenceAxes(direction, np.cross(angular, linear), slides),
        fk(robot, zero),
        bodies if bodies.any else None,
        robot.joint_names,
        notes if bodies.any else (),
    )


def check_joints(table: DHTable, reference: Reference) -> tuple[str, ...]:
    """Refuses a reference whose number of joints is too far off; notes on the names.

    Raises:
        StructureError: the numbers of joints differ by more than one.
    """
    if abs(table.n - reference.n) > 1:
        raise StructureError(joint_counts(table, reference))
    mine = [link.name for link in table.links]
    theirs = reference.joint_names
    if theirs and all(mine) and not set(mine) & set(theirs) and table.n == reference.n:
        said = _(
            "no joint name in common: joints are paired in order, {mine!r} with {theirs!r}; if "
            "that is wrong, give the tool, or name the rows as the reference names its joints"
        )
        return (said.format(mine=mine[0], theirs=theirs[0]),)
    return ()


def joint_counts(table: DHTable, reference: Reference) -> str:
    """One line on different numbers of joints."""
    remedy = "; of a URDF name the tool where that chain ends" if reference.joint_names else ""
    mine = [link.name for link in table.links if link.name]
    common = ""
    if reference.joint_names and mine and not set(mine) & set(reference.joint_names):
        common = ", and no joint name in common"
    return (
        f"table {table.name!r} has {table.n} joints, {reference.name!r} has {reference.n}{common}; "
        f"compare descriptions of the same joints{remedy}"
    )


def _last_digit(text: str) -> float:
    """One unit of the last printed digit of the numbers of a URDF; 0 where all are printed.

    Told by its angles: a file that prints pi/2 with six decimals has rounded its lengths too.
    Fewer than four decimals are not taken for a rounding: lengths may be meant so.
    """
    words = " ".join(m[1] for m in _RPY.finditer(text)).split()
    places = max((_places(word) for word in words), default=0)
    if not 4 <= places <= 9:
        return 0.0
    lengths = " ".join(m[1] for m in _XYZ.finditer(text)).split()
    return float(10.0 ** -min(9, max([places, *(_places(word) for word in lengths)])))


def _places(word: str) -> int:
    """Decimals of a printed number that is not whole."""
    if "." not in word or float(word) == round(float(word)):
        return 0
    head, _mark, power = word.lower().partition("e")
    return len(head.split(".")[1]) - (int(power) if power else 0)


_XYZ = re.compile(r'xyz="([^"]*)"')
_RPY = re.compile(r'rpy="([^"]*)"')


def _sharpened(text: str) -> str | None:
    """URDF text with rounded angles replaced by the multiples of 15° they round."""
    count = 0

    def angle(word: str) -> str:
        nonlocal count
        try:
            value = float(word)
        except ValueError:
            return word
        meant = round(value / (np.pi / 12)) * (np.pi / 12)
        places = len(word.split(".")[1]) if "." in word and "e" not in word.lower() else 0
        if meant == 0.0 or not 2 <= places <= 12 or value == meant:
            return word
        if abs(value - meant) >= 10.0**-places:
            return word
        count += 1
        return repr(meant)

    out = _RPY.sub(lambda m: f'rpy="{" ".join(angle(w) for w in m[1].split())}"', text)
    return out if count else None
