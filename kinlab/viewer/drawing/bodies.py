"""The bodies of a URDF that can be drawn: read strictly, meshes tried one by one.

What cannot be read is left out with a note that names it; a rod stands in its place where the
joint carries nothing else.
"""

from __future__ import annotations

import warnings
from pathlib import Path
from typing import Any

import numpy as np
import pinocchio as pin

from kinlab.arrays import Array
from kinlab.errors import UrdfError
from kinlab.host.language import _
from kinlab.model import urdf_read
from kinlab.model.robot import Robot
from kinlab.model.strict_numbers import strict_numbers
from kinlab.model.urdf_engine import document
from kinlab.model.urdf_records import read_numbers, read_origin, read_tree

_FORMATS = (".dae", ".obj", ".stl")
_SIZES = {"box": ("size", 3), "sphere": ("radius", 1)}
_MESH_LIMIT = 256 << 20
"""Bytes of a mesh; a page with more does not open."""
_GREY = "0.57 0.64 0.68 1.0"


class DrawnBodies:
    """What is drawn of a robot's URDF.

    Attributes:
        visuals: the ``pin.GeometryModel``.
        bare: indices of joints of which a body is missing.
        notes: one line for each body that is left out.
    """

    def __init__(self, robot: Robot, folders: list[Path], meshes: bool) -> None:
        """Reads the bodies; with ``meshes`` false every mesh is left out silently."""
        from lxml import etree

        self.notes: list[str] = []
        self.bare: set[int] = set()
        self._robot, self._folders, self._meshes = robot, folders, meshes
        self._left_out: list[tuple[str, int | None]] = []
        self._tried: dict[tuple[str, str], str] = {}
        self._loader = _loader()
        place = f"robot {robot.name!r}"
        source = urdf_read.parse(robot.urdf, place)
        tree = read_tree(source, place)
        plain = document(tree, robot.joint_names)
        links = {element.get("name"): element for element in plain.findall("link")}
        paints = {m.get("name"): m for m in source.findall("material")}
        for link in source.findall("link"):
            for visual in link.findall("visual"):
                self._add(links[link.get("name")], visual, paints)
        text = etree.tostring(plain, encoding="unicode")
        self.visuals = pin.GeometryModel()
        try:
            self.visuals = pin.buildGeomFromUrdfString(
                robot.model, text, pin.GeometryType.VISUAL, mesh_loader=self._loader
            )
        except (ValueError, RuntimeError) as problem:
            reason = " ".join(str(problem).split())[:200]
            told = _("the bodies cannot be drawn ({reason}); rods stand for them")
            self.notes.append(told.format(reason=reason))
        drawn = {int(body.parentJoint) for body in self.visuals.geometryObjects}
        if not drawn:
            self.bare = set(range(robot.model.njoints))
        for reason, joint in self._left_out:
            if joint is not None and joint not in drawn:
                self.bare.add(joint)
            stands = joint is not None and joint in self.bare - {0}
            told = _("{reason}; a rod stands for it") if stands else _("{reason}; it is left out")
            self.notes.append(told.format(reason=reason))

    def _add(self, link: Any, visual: Any, paints: dict[str, Any]) -> None:
        """Writes one visual into our own document, or a note why not."""
        from lxml import etree

        name = link.get("name")
        where = f"link {name!r}"
        made = etree.Element("visual")
        try:
            xyz, rpy = read_origin(visual, where)
            shape = self._geometry(visual, where)
            if shape is None:
                joint = self._joint(name)
                if joint is not None:
                    self.bare.add(joint)
                return
            color = _color(visual, paints, where)
        except UrdfError as problem:
            self._left_out.append((str(problem), self._joint(name)))
            return
        words = {"xyz": xyz, "rpy": rpy}
        etree.SubElement(
            made, "origin", {k: " ".join(map(repr, v.tolist())) for k, v in words.items()}
        )
        etree.SubElement(made, "geometry").append(shape)
        if color:
            paint = etree.SubElement(made, "material", name="paint_" + color.replace(" ", "_"))
            etree.SubElement(paint, "color", rgba=color)
        link.append(made)

    def _joint(self, link: str) -> int | None:
        """The joint that carries a link, 0 for the base; None of a link the engine dropped."""
        model = self._robot.model
        if not model.existFrame(link, pin.FrameType.BODY):
            return None
        return int(model.frames[model.getFrameId(link, pin.FrameType.BODY)].parentJoint)

    def _geometry(self, visual: Any, where: str) -> Any:
        """The shape with its numbers rewritten; None for a mesh that is not to be drawn.

        Raises:
            UrdfError: no shape, an unknown one, or one that cannot be read.
        """
        from lxml import etree

        found = visual.findall("geometry/*")
        if len(found) != 1:
            raise UrdfError(f"{where}: a <visual> has {len(found)} shapes")
        given = found[0]
        if given.tag == "mesh":
            return self._mesh(given, where)
        if given.tag in _SIZES:
            key, count = _SIZES[given.tag]
            sizes = {key: _sizes(given, key, count, where)}
        elif given.tag in ("cylinder", "capsule"):
            sizes = {key: _sizes(given, key, 1, where) for key in ("radius", "length")}
        else:
            raise UrdfError(f"{where}: shape <{given.tag}> is unknown")
        return etree.Element(given.tag, sizes)

    def _mesh(self, given: Any, where: str) -> Any:
        from lxml import etree

        name = given.get("filename") or ""
        if not self._meshes:
            return None
        file = urdf_read.mesh_file(name, self._folders)
        what = f"{where}: mesh {name!r}"
        if file is None:
            raise UrdfError(f"{what} is missing")
        if file.suffix.lower() not in _FORMATS:
            raise UrdfError(f"{what} cannot be shown in a browser")
        scale = read_numbers(given.get("scale"), 3, (1.0, 1.0, 1.0), f"{what}: scale")
        if not scale.all():
            raise UrdfError(f"{what}: scale has a zero")
        written = _words(scale)
        if (str(file), written) not in self._tried:
            self._tried[str(file), written] = mesh_problem(file, self._loader, scale)
        problem = self._tried[str(file), written]
        if problem:
            raise UrdfError(f"{what} cannot be read ({problem})")
        return etree.Element("mesh", filename=str(file), scale=written)


def mesh_problem(file: Path, loader: Any, scale: Any) -> str:
    """Why a mesh cannot be drawn, or an empty string.

    Args:
        file: .dae, .obj or .stl.
        loader: a coal mesh loader, which keeps what it read.
        scale: (3,).
    """
    from pinocchio.visualize import meshcat_visualizer

    try:
        if file.stat().st_size > _MESH_LIMIT:
            told = _("{size} bytes; at most {most}")
            return told.format(size=file.stat().st_size, most=_MESH_LIMIT)
        mesh = loader.load(str(file), np.asarray(scale, dtype=float))
        points = mesh.vertices()
        if not len(points) or not np.isfinite(points).all():
            return _("it has no points, or points that are not finite")
        if file.suffix.lower() == ".dae":
            with warnings.catch_warnings():
                warnings.simplefilter("ignore")
                meshcat_visualizer.DaeMeshGeometry(str(file))
        elif file.suffix.lower() == ".obj":
            file.read_text(encoding="utf-8")
    except UnicodeDecodeError:
        return _("it is not UTF-8 text")
    except Exception as problem:  # noqa: BLE001  whatever a hostile mesh makes the two readers raise
        words = " ".join(str(problem).split())
        return f"{type(problem).__name__}: {words}"[:160].replace(str(file), file.name)
    return ""


def _words(values: Array) -> str:
    return " ".join(map(repr, values.tolist()))


def _loader() -> Any:
    import coal

    return coal.CachedMeshLoader()


def _sizes(shape: Any, key: str, count: int, where: str) -> str:
    text = shape.get(key)
    if text is None:
        raise UrdfError(f"{where}: <{shape.tag}> has no {key}")
    values = read_numbers(text, count, (), f"{where}: {shape.tag} {key}")
    if np.any(values < 0):
        raise UrdfError(f"{where}: {shape.tag} {key} is negative")
    return _words(values)


def _color(visual: Any, paints: dict[str, Any], where: str) -> str:
    """rgba as text, empty where none is given; a colour that cannot be read is grey."""
    material = visual.find("material")
    if material is None:
        return ""
    color = material.find("color")
    if color is None and material.get("name") in paints:
        color = paints[material.get("name")].find("color")
    if color is None:
        return ""
    try:
        rgba = strict_numbers(color.get("rgba") or "", 4, f"{where}: rgba", UrdfError)
    except UrdfError:
        return _GREY
    return _words(np.clip(rgba, 0.0, 1.0))
