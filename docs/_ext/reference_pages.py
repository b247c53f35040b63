"""The reference: every public name once, by topic, each from its docstring.

``TOPICS`` says where a public name stands; a test fails if one is missing or named twice. The
records that a topic's functions answer with follow them on the page, found by their annotations.
"""

from __future__ import annotations

import importlib
import inspect
import pkgutil
import re
import types
import typing
from collections.abc import Iterable, Iterator
from dataclasses import dataclass
from pathlib import Path
from typing import Any

from made_pages import write_if_changed

import kinlab as kl

ROOMS = ("arrays", "check", "errors", "fivebar", "motion", "plots", "tolerances", "viewer")
"""Public names of ``kinlab`` that are modules: their names are public too."""


@dataclass(frozen=True)
class Topic:
    """One page: its file, title, what stands above, and the names behind ``kinlab.``."""

    page: str
    title: str
    words: str
    names: tuple[str, ...]


def topic(page: str, title: str, words: str, names: str) -> Topic:
    return Topic(page, title, words, tuple(names.split()))


TOPICS = (
    topic(
        "robots",
        "Robots and tables",
        "What an arm is, and the files it comes from. Whatever names an arm serves as ``robot`` "
        "everywhere: a :class:`~kinlab.Robot`, a :class:`~kinlab.DHTable`, a ``pin.Model``, a "
        "name, a path.",
        "load Robot DHTable DHLink Convention to_urdf to_dh with_payload",
    ),
    topic(
        "kinematics",
        "Kinematics and statics",
        "Twists and wrenches are linear first. ``frame`` is ``base`` (axes of the base, reference "
        "point the tool), ``tool`` or ``spatial`` (reference point the base's origin).",
        "fk jacobian jacobian_dot statics",
    ),
    topic(
        "dynamics",
        "Dynamics",
        "M, C, g and both directions of the equation of motion, by Pinocchio.",
        "inverse_dynamics forward_dynamics mass_matrix coriolis_matrix gravity_torques "
        "friction_torques kinetic_energy potential_energy",
    ),
    topic(
        "links",
        "The single links",
        "The quantities of Newton and Euler's recursion, link by link.",
        "link_poses link_velocities link_accelerations com_positions com_jacobians "
        "com_accelerations inertial_wrenches joint_wrenches static_wrenches "
        "link_kinetic_energies link_potential_energies",
    ),
    topic(
        "lagrange",
        "Lagrange's quantities",
        "What Lagrange's equations are made of, with exact derivatives of M.",
        "lagrangian lagrangian_gradient lagrange_torques momentum momentum_rate action "
        "mass_matrix_dot mass_matrix_derivatives christoffel coriolis_coefficients "
        "centrifugal_coefficients",
    ),
    topic(
        "formulas",
        "Formulas beside the engine",
        "A formula of yours against the engine, what is wrong in it, and the same for a DH table "
        "and for a class.",
        "compare Comparison hand_formula diagnose diagnose_table mark",
    ),
    topic(
        "singularity",
        "Singularity, isotropy, manipulability",
        "From singular values only. Every search carries its evidence: what was searched, what is "
        "proved, what is only found.",
        "manipulability dexterity ellipsoid characteristic_length find_singularities "
        "describe_singularity nearest_singularity singular_loci factored_determinant "
        "find_isotropic design_isotropic redundancy",
    ),
    topic(
        "workspace",
        "Workspace and sweeps",
        "Where the tool can be, and one measure over very many states or designs.",
        "sample_workspace WorkspaceMap planar_boundary workspace_section sweep SweepResult",
    ),
    topic(
        "inverse",
        "Inverse kinematics and postures",
        "One solution, many poses, all branches; how many there are and how they hang together.",
        "ik ik_batch ik_branches ik_path solution_count solution_map aspects is_cuspidal "
        "posture_path",
    ),
    topic(
        "motion",
        "Motion, drives, simulation",
        "Motions in joint and tool space, what they meet on their way, drives that suit them, and "
        "motion under torques.",
        "motion.joint motion.cartesian motion.Arc motion.from_samples motion.read_motion "
        "motion.Motion motion.check motion.MotionCheck motion.Finding size_servos simulate",
    ),
    topic(
        "fivebar",
        "The five-bar",
        "The linkage in closed form and as Pinocchio's closed chain, and the lengths that suit a "
        "rectangle.",
        "FiveBar design_fivebar fivebar_front",
    ),
    topic(
        "plots",
        "Figures",
        "Each draws into the axes ``ax`` that it is given, or into a new figure, and returns the "
        "axes. With ``pip install 'kinlab[plots]'``.",
        "plots.workspace plots.workspace_map plots.workspace_cloud plots.ellipses "
        "plots.singular_loci plots.singular_values plots.solutions plots.ik_history "
        "plots.torque_speed plots.fivebar plots.fivebar_cycle plots.fivebar_gains "
        "plots.fivebar_design plots.fivebar_front plots.save",
    ),
    topic(
        "viewer",
        "Viewer",
        "The page in the browser: one file without a server, or a small server on loopback.",
        "view viewer.Scene viewer.FiveBarScene",
    ),
    topic(
        "symbolic",
        "Symbolic derivation",
        "Formulas from the DH table: ``from kinlab import symbolic``.",
        "symbolic.arm symbolic.SymbolicArm symbolic.fk symbolic.frames symbolic.jacobian "
        "symbolic.det_jacobian symbolic.Determinant symbolic.mass_matrix "
        "symbolic.coriolis_matrix symbolic.christoffel symbolic.gravity_torques "
        "symbolic.inverse_dynamics symbolic.kinetic_energy symbolic.potential_energy "
        "symbolic.to_function symbolic.to_latex symbolic.to_python",
    ),
    topic(
        "errors",
        "Errors and tolerances",
        "Whatever kinlab refuses on purpose is a :exc:`~kinlab.KinlabError`; the command line "
        "turns it into one line and exit code 2. Every tolerance has a name and a reason.",
        "KinlabError tolerances.Tolerances tolerances.TOLERANCES",
    ),
)

EXTENDING = (
    ("kinlab.formulas.record", "formula Formula Printed"),
    ("kinlab.check.catalogue", "catalogue plan run run_one Row"),
    ("kinlab.check.quantities.registry", "quantity"),
    ("kinlab.check.quantities.quantity", "Quantity"),
    ("kinlab.arrays", ""),
)
"""What those who add to kinlab use, by module; no names: all functions of the module."""


def public_names() -> set[str]:
    """Every name that the reference must hold, written behind ``kinlab.``."""
    names = {n for n in kl.__all__ if n not in ROOMS and not n.startswith("_")}
    for room in (*ROOMS, "symbolic"):
        module = importlib.import_module(f"kinlab.{room}")
        names |= {f"{room}.{n}" for n in getattr(module, "__all__", ())}
    names |= {"tolerances.Tolerances", "tolerances.TOLERANCES"}
    return names - {"fivebar.FiveBar", "viewer.view"}  # they stand at the top as well


def found(name: str) -> Any:
    """The object of a public name."""
    *room, last = name.split(".")
    return getattr(importlib.import_module(".".join(["kinlab", *room])), last)


def records(names: Iterable[str], known: set[str]) -> list[type]:
    """Kinlab's own classes that these names answer with or hold, in the order they are met."""
    public = {found(n) for n in public_names() if inspect.isclass(found(n))}
    met: dict[type, None] = {}
    todo = [found(n) for n in names]
    while todo:
        for one in answers(todo.pop(0)):
            if one in public or one in met or one.__name__.startswith("_"):
                continue
            if full_name(one) not in known:
                met[one] = None
                todo.append(one)
    return list(met)


def full_name(one: type) -> str:
    return f"{one.__module__}.{one.__qualname__}"


def answers(thing: Any) -> Iterator[type]:
    """The classes in a function's answer; of a class, in its fields and its methods' answers."""
    if inspect.isclass(thing):
        hints = [h for n, h in hints_of(thing).items() if not n.startswith("_")]
        for name, member in inspect.getmembers(thing):
            call = member.fget if isinstance(member, property) else member
            call = getattr(call, "__func__", call)
            if not name.startswith("_") and inspect.isfunction(call):
                hints.append(hints_of(call).get("return"))
    else:
        hints = [hints_of(thing).get("return")]
        told = (inspect.getdoc(thing) or "").partition("Returns:")[2].partition("Raises:")[0]
        room = getattr(inspect.getmodule(thing), "__dict__", {})
        hints += [room.get(name) for name in re.findall(r":class:`~?(\w+)`", told)]
    for hint in hints:
        yield from classes(hint)


def hints_of(thing: Any) -> dict[str, Any]:
    """Annotations with their names looked up, the ones for type checkers only among them."""
    try:
        return typing.get_type_hints(thing)
    except (NameError, TypeError):
        every = {c.__name__: c for c in all_classes()}
        try:
            return typing.get_type_hints(thing, localns=every)
        except (NameError, TypeError):
            return {}


def classes(hint: Any) -> Iterator[type]:
    own = inspect.isclass(hint) and not isinstance(hint, types.GenericAlias)
    if own and hint.__module__.startswith("kinlab."):
        yield hint
    for inner in typing.get_args(hint):
        yield from classes(inner)


_CLASSES: list[type] = []


def all_classes() -> list[type]:
    """Every class of kinlab's modules."""
    if not _CLASSES:
        for info in pkgutil.walk_packages(kl.__path__, "kinlab."):
            if info.name.rsplit(".", 1)[-1] in ("__main__",):
                continue
            module = importlib.import_module(info.name)
            for value in vars(module).values():
                if inspect.isclass(value) and value.__module__ == info.name:
                    _CLASSES.append(value)
    return _CLASSES


def errors() -> list[type]:
    """Kinlab's errors and its warning, root first, each below its parent's place in the file."""
    every = [c for c in all_classes() if issubclass(c, (kl.KinlabError, Warning))]
    every = [c for c in every if c is not kl.KinlabError and not c.__name__.startswith("_")]
    return sorted(every, key=lambda c: (c.__module__ != "kinlab.errors", c.__module__))


def rooms() -> str:
    """The rooms of the package, each with the table of its files, from its own docstring."""
    text = heading("The rooms, file by file", "=")
    text += "What :doc:`/architecture` puts in order, from the rooms' own docstrings.\n\n"
    for file in sorted(Path(kl.__path__[0]).rglob("__init__.py")):
        name = ".".join(file.parent.relative_to(Path(kl.__path__[0]).parent).parts)
        text += heading(name, "-") + f".. automodule:: {name}\n\n"
    return text


def entry(full: str, thing: Any) -> str:
    """The directive that documents one name."""
    if inspect.isclass(thing):
        if issubclass(thing, BaseException):
            return f".. autoexception:: {full}\n   :show-inheritance:\n"
        return f".. autoclass:: {full}\n   :members:\n"
    if callable(thing):
        return f".. autofunction:: {full}\n"
    return f".. autodata:: {full}\n   :no-value:\n"


def line(full: str, thing: Any) -> str:
    """A row of the table at the head of a page."""
    text = inspect.getdoc(thing) or ""
    first = text.split("\n\n")[0].replace("\n", " ").replace("|", "\\|")
    role = "class" if inspect.isclass(thing) else "func" if callable(thing) else "data"
    short = full.removeprefix("kinlab.")
    return f"   * - :{role}:`{short} <{full}>`\n     - {first}\n"


def table(rows: Iterable[str]) -> str:
    return ".. list-table::\n   :widths: 30 70\n   :class: names\n\n" + "".join(rows) + "\n"


def heading(text: str, mark: str) -> str:
    return f"{text}\n{mark * len(text)}\n\n"


def write(docs: Path) -> None:
    """Writes the pages of the reference into ``docs/reference/generated``."""
    folder = docs / "reference" / "generated"
    known: set[str] = set()
    for one in TOPICS:
        things = [(f"kinlab.{n}", found(n)) for n in one.names]
        if one.page == "errors":
            things[1:1] = [(full_name(c), c) for c in errors()]
        further = [(full_name(c), c) for c in records(one.names, known)]
        known |= {full for full, _ in further}
        text = heading(one.title, "=") + one.words + "\n\n"
        text += table(line(*pair) for pair in things)
        text += "\n".join(entry(*pair) for pair in things)
        if further:
            text += "\n" + heading("What they answer with", "-")
            text += "\n".join(entry(*pair) for pair in further)
        write_if_changed(folder / f"{one.page}.rst", text)
    write_if_changed(folder / "rooms.rst", rooms())
    text = heading("For those who add to kinlab", "=")
    text += "What :doc:`/architecture` and CONTRIBUTING.md speak of.\n\n"
    for module, names in EXTENDING:
        text += heading(module, "-")
        loaded = importlib.import_module(module)
        chosen = names.split() or [
            n
            for n, f in vars(loaded).items()
            if inspect.isfunction(f) and f.__module__ == module and not n.startswith("_")
        ]
        text += "\n".join(entry(f"{module}.{n}", getattr(loaded, n)) for n in chosen) + "\n"
    write_if_changed(folder / "extending.rst", text)
