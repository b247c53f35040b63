"""Robot: a small frozen handle of a serial arm in Pinocchio. It only looks things up.

Every robot has nq == nv == n: a continuous joint becomes a revolute one with wide limits, and
what does not lie on the way from the root to the tool is locked at zero.
"""

from __future__ import annotations

import threading
from collections.abc import Iterator
from dataclasses import dataclass, field, fields
from pathlib import Path
from typing import Any

import numpy as np
import pinocchio as pin

from kinlab.arrays import Array, frozen, set_fields, shown
from kinlab.errors import InertiaError, NameUnknownError, StructureError, near
from kinlab.host.introductions import Answer, Introduction, brief, counted, vector
from kinlab.model import urdf_read
from kinlab.model.dh import DHTable
from kinlab.model.link import inertia_flaw
from kinlab.model.urdf_engine import build
from kinlab.model.urdf_records import read_tree
from kinlab.model.urdf_write import records, text_of
from kinlab.tolerances import TOLERANCES


@dataclass(frozen=True, eq=False, repr=False)
class Robot(Answer):
    """A serial arm: a Pinocchio model and the frame that counts as its tool.

    Build one with :meth:`from_dh`, :meth:`from_urdf` or :func:`kinlab.load`.

    Attributes:
        name: what messages call it.
        model: the ``pin.Model``; nq == nv == n. Do not write to it.
        tool: index of the tool frame in ``model.frames``.
        urdf: the URDF text the model was built from.
        table: the DH table, where the robot comes from one.
        folder: where meshes are looked for, where the robot comes from a file.
        source: where the numbers come from.
        n: number of joints.
        lower, upper: limits of q, (n,), rad or m.
        joint_kinds: ``"revolute"`` or ``"prismatic"``, joint by joint.
        slack: how far beyond its limits each joint's q is hardly meant, (n,), rad or m.
        near_square: |q|² up to which no entry of q lies beyond its limits by its slack.
    """

    name: str
    model: Any = field(repr=False)
    tool: int
    urdf: str = field(default="", repr=False)
    table: DHTable | None = field(default=None, repr=False)
    folder: Path | None = None
    source: str = ""
    n: int = field(init=False)
    lower: Array = field(init=False, repr=False)
    upper: Array = field(init=False, repr=False)
    singular_mass: str = field(init=False, repr=False)
    """Why the mass matrix is singular, or an empty string."""
    shape: tuple[int] = field(init=False, repr=False)
    joint_kinds: tuple[str, ...] = field(init=False, repr=False)
    slack: Array = field(init=False, repr=False)
    near_square: float = field(init=False, repr=False)
    _scratch: threading.local = field(init=False, repr=False, default_factory=threading.local)

    def __post_init__(self) -> None:
        if self.model.nq != self.model.nv or self.model.nv != self.model.njoints - 1:
            raise StructureError(
                f"robot {self.name!r}: nq {self.model.nq}, nv {self.model.nv}, joints "
                f"{self.model.njoints - 1}; every joint must have one degree of freedom (no "
                "floating base; continuous joints as revolute)"
            )
        n = int(self.model.nv)
        if not n:
            raise StructureError(f"robot {self.name!r}: the model has no joint; see kl.load")
        lower, upper = (
            frozen(limits)
            for limits in (self.model.lowerPositionLimit, self.model.upperPositionLimit)
        )
        kinds = tuple(_kind(joint) for joint in list(self.model.joints)[1:])
        with np.errstate(over="ignore"):  # limits of a model may be as wide as numbers are
            stroke = np.maximum(10.0 * (upper - lower), 1.0)
            slack = np.where([kind == "revolute" for kind in kinds], 2.0 * np.pi, stroke)
            nearest = float(np.min(np.minimum(upper + slack, slack - lower)))
        set_fields(
            self,
            n=n,
            shape=(n,),
            lower=lower,
            upper=upper,
            joint_kinds=kinds,
            slack=frozen(slack),
            near_square=min(max(nearest, 0.0), 1e150) ** 2,
            singular_mass=_why_singular(self.model, self.name),
        )

    def __repr__(self) -> str:
        return f"<Robot {self.name!r}: {counted(self.n, 'joint')}, tool {self.tool_name!r}>"

    def introduction(self) -> Introduction:
        """The joints, what moves, and what must be said of it."""
        mass = sum(float(body.mass) for body in list(self.model.inertias)[1:])
        gravity = vector(self.model.gravity.linear)
        rows = tuple(
            (name, kind, _reach(low, kind), _reach(high, kind))
            for name, kind, low, high in zip(
                self.joint_names, self.joint_kinds, self.lower, self.upper, strict=True
            )
        )
        said = (self.singular_mass, *remarks(self))
        lines = (brief(self.source), f"moving mass {mass:.4g} kg, gravity {gravity} m/s²", *said)
        return Introduction(
            f"robot {self.name}: {counted(self.n, 'joint')}, tool frame {self.tool_name}",
            tuple(line for line in lines if line),
            ("joint", "kind", "from", "to"),
            rows,
        )

    def __reduce__(self) -> tuple[Any, ...]:
        given = tuple(getattr(self, one.name) for one in fields(self) if one.init)
        return Robot, given

    @property
    def joint_names(self) -> tuple[str, ...]:
        """Names of the joints in the order of q."""
        return tuple(str(name) for name in list(self.model.names)[1:])

    @property
    def tool_name(self) -> str:
        """Name of the tool frame."""
        return str(self.model.frames[self.tool].name)

    @staticmethod
    def from_dh(table: DHTable) -> Robot:
        """Builds a robot from a DH table, by way of its URDF.

        Args:
            table: the DH table.

        Returns:
            The robot; its tool frame is DH frame n times ``table.tool``.
        """
        tree = records(table)
        text = text_of(table, tree)
        model = build(text, tree, list(table.joint_names), f"table {table.name!r}")
        tool = int(model.getFrameId(table.tool_name, pin.FrameType.BODY))
        return Robot(table.name, model, tool, text, table, None, table.source)

    @staticmethod
    def from_urdf(path_or_xml: str | Path, tool: str | None = None) -> Robot:
        """Builds a robot from a URDF file or text.

        Args:
            path_or_xml: a file, or the XML itself.
            tool: name of the link that is the tool. May be left out where all moving joints
                lie on one chain; then it is that chain's last link, and of several links fixed
                to it one with a usual tool name (tool, tool0, ee_link, ...), or the outermost.

        Returns:
            The robot of the joints between root and tool; all others are locked at zero.

        Raises:
            FileError: the file cannot be read.
            UrdfError: not a sound URDF; the message names the link or joint.
            StructureError: a tree and no tool named, no moving joint on the way to the tool, or
                a mimic or multi-degree-of-freedom joint on it.
            NameUnknownError: no link of that name.
        """
        text, file = urdf_read.load_source(path_or_xml)
        chain = urdf_read.read(text, f"urdf {file.name!r}" if file else None, tool)
        name = chain.name or (file.stem if file else "robot")
        folder = file.resolve().parent if file else None
        source = str(file) if file else "URDF text"
        return Robot(name, chain.model, chain.tool, text, None, folder, source)

    @staticmethod
    def from_model(model: Any, tool: str | None = None) -> Robot:
        """Wraps a ``pin.Model`` whose joints form one chain.

        Args:
            model: the model; every joint one degree of freedom with nq == nv.
            tool: name of the tool frame; left out, the last body frame.

        Raises:
            StructureError: the joints branch, or a joint has another number of freedoms.
            NameUnknownError: no frame of that name.
        """
        where = f"model {model.name!r}"
        for j in range(1, model.njoints):
            if model.parents[j] != j - 1:
                raise StructureError(
                    f"{where}: joint {model.names[j]!r} branches off; reduce the model to one "
                    "chain, or load the URDF with a tool named"
                )
        names = [str(frame.name) for frame in model.frames]
        if tool is not None and tool not in names:
            raise NameUnknownError(f"{where}: frame {tool!r} does not exist; {near(tool, names)}")
        frame = _frame_index(model, tool) if tool is not None else len(names) - 1
        return Robot(str(model.name), model, frame, source="pin.Model")


def scratch(robot: Robot) -> Any:
    """The ``pin.Data`` of this robot for this thread; overwritten by every call."""
    try:
        return robot._scratch.data
    except AttributeError:
        robot._scratch.data = robot.model.createData()
        return robot._scratch.data


def model_pool(robot: Robot, threads: int) -> Any:
    """The ``pin.ModelPool`` of this robot for this thread, for calls on so many threads."""
    pools: dict[int, Any] = robot._scratch.__dict__.setdefault("pools", {})
    if threads not in pools:
        pools[threads] = pin.ModelPool(robot.model, threads)
    return pools[threads]


def require_inertia(robot: Robot) -> None:
    """Refuses dynamics of a robot whose mass matrix is singular.

    Raises:
        InertiaError: naming the joint that moves nothing.
    """
    if robot.singular_mass:
        raise InertiaError(robot.singular_mass)


def remarks(robot: Robot) -> tuple[str, ...]:
    """What must be said of a robot before its dynamics are used, a sentence each.

    Joint friction, which counts only where it is asked for; masses without inertia; inertias that
    no body can have but that its table or URDF says are meant, or that rounding made so.
    """
    said = []
    model = robot.model
    losses = zip(robot.joint_names, model.damping, model.friction, strict=True)
    rough = [name for name, viscous, coulomb in losses if viscous or coulomb]
    if rough:
        said.append(
            f"joint friction of {_listed(rough)}: counted in simulations, in drives for motions, "
            "and with friction=True in inverse_dynamics and forward_dynamics; left out otherwise"
        )
    bodies = list(_moving_bodies(robot))
    points = [name for name, mass, inertia in bodies if mass and not inertia.any()]
    if points:
        said.append(f"mass without inertia: {_listed(points)}: computed as point masses")
    for name, _, inertia in bodies:
        flaw = inertia_flaw(inertia)
        if flaw is not None:
            said.append(f"unphysical: {name}: {flaw.told}; computed with as it stands")
    return tuple(said)


def _moving_bodies(robot: Robot) -> Iterator[tuple[str, float, Array]]:
    """Name, mass and tensor, as they were written, of each body that the arm moves."""
    if robot.table is not None:
        for i, link in enumerate(robot.table.links, 1):
            yield f"link {i}", link.mass, np.asarray(link.inertia)
    elif robot.urdf:
        tree = read_tree(urdf_read.parse(robot.urdf, robot.name), robot.name)
        for name in tree.links_behind(tree.joints[robot.joint_names[0]].child):
            inertial = tree.links[name].inertial
            if inertial is not None:
                yield name, inertial.mass, inertial.inertia
    else:
        for name, body in zip(robot.joint_names, list(robot.model.inertias)[1:], strict=True):
            yield f"the links behind joint {name}", float(body.mass), np.array(body.inertia)


def _listed(names: list[str], most: int = 8) -> str:
    rest = len(names) - most
    return ", ".join(names[:most]) + (f" and {rest} more" if rest > 0 else "")


def _reach(limit: float, kind: str) -> str:
    return f"{np.degrees(limit):.5g}°" if kind == "revolute" else f"{limit:.5g} m"


def _kind(joint: Any) -> str:
    prismatic = "P" in joint.shortname().removeprefix("JointModel")
    return "prismatic" if prismatic else "revolute"


def frame_id(robot: Robot, name: str) -> int:
    """Index of a frame by name.

    Raises:
        NameUnknownError: with the near names.
    """
    names = [str(frame.name) for frame in robot.model.frames]
    if not isinstance(name, str) or name not in names:
        told = near(name if isinstance(name, str) else "", names)
        message = f"robot {robot.name!r}: frame {shown(name)} does not exist; {told}"
        raise NameUnknownError(message)
    return _frame_index(robot.model, name)


def _frame_index(model: Any, name: str) -> int:
    """Index of a frame of that name; a body's frame where a joint has the same name."""
    same = [i for i, frame in enumerate(model.frames) if str(frame.name) == name]
    bodies = [i for i in same if model.frames[i].type == pin.FrameType.BODY]
    return (bodies or same)[0]


def _why_singular(model: Any, name: str) -> str:
    """Says which joint moves no inertia, or nothing where M is regular.

    Judged by M = U D U^T: D_i is the inertia that joint i feels with all joints behind it free,
    and the articulated-body algorithm divides by it. A special pose can make it vanish, so M
    counts as singular only if it is so at three seeded states.
    """
    data = model.createData()
    rng = np.random.default_rng(0)
    joint = 0
    for q in rng.uniform(-3.0, 3.0, (3, model.nv)):
        diagonal = np.diag(pin.crba(model, data, q))
        if not diagonal.any():
            return f"robot {name!r}: no link has mass: kinematics only; give mass and inertia"
        pin.cholesky.decompose(model, data)
        # from the tip on: behind a singular joint the factors mean nothing
        light = np.flatnonzero(~(TOLERANCES.massless * diagonal < data.D))
        if not len(light):
            return ""
        joint = int(light[-1])
    return (
        f"robot {name!r}: the mass matrix is singular: joint {model.names[joint + 1]!r} moves no "
        "inertia; give its link mass, inertia or armature (kinematics work without)"
    )
