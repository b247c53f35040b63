"""URDF text: where it comes from, XML that fetches and expands nothing, and its mesh files."""

from __future__ import annotations

from collections.abc import Iterator
from pathlib import Path
from typing import Any

from kinlab.errors import UrdfError
from kinlab.files import read_text


def parse(text: str, place: str) -> Any:
    """Parses URDF text without ever fetching or expanding anything.

    Args:
        text: the XML.
        place: what to call it in messages.

    Returns:
        The lxml root element, comments dropped.

    Raises:
        UrdfError: not XML, a document type or entity declaration, or the root is not <robot>.
    """
    from lxml import etree

    if "<!DOCTYPE" in text or "<!ENTITY" in text:
        raise UrdfError(
            f"{place}: document type and entity declarations are not accepted; remove <!DOCTYPE>"
        )
    if "\0" in text:
        raise UrdfError(f"{place}: not XML: it holds a null character")
    parser = etree.XMLParser(
        encoding="utf-8",  # what the text was read as, whatever its first line says
        resolve_entities=False,
        no_network=True,
        load_dtd=False,
        remove_comments=True,
        remove_pis=True,
    )
    try:
        root = etree.fromstring(text.lstrip("\ufeff \t\r\n").encode("utf-8"), parser)
    except UnicodeEncodeError:
        raise UrdfError(f"{place}: not XML: it holds half a surrogate pair") from None
    except etree.XMLSyntaxError as problem:
        raise UrdfError(f"{place}: not XML: {' '.join(str(problem.msg).split())}") from None
    if root.tag != "robot":
        raise UrdfError(f"{place}: the root element is <{root.tag}>; a URDF starts with <robot>")
    return root


def load_source(path_or_xml: str | Path) -> tuple[str, Path | None]:
    """URDF text and, where it came from a file, that file.

    Raises:
        FileError: the file cannot be read.
    """
    if isinstance(path_or_xml, str) and path_or_xml.lstrip("\ufeff \t\r\n").startswith("<"):
        return path_or_xml, None
    file = Path(path_or_xml)
    return read_text(file), file


def missing_meshes(root: Any, folders: list[Path]) -> Iterator[str]:
    """One line for each mesh that is not on the disk.

    Args:
        root: the URDF.
        folders: where ``package://`` and relative names may start.

    Yields:
        ``link 'x': mesh 'y' is missing``.
    """
    for link in root.findall("link"):
        for mesh in link.iter("mesh"):
            name = mesh.get("filename") or ""
            if mesh_file(name, folders) is None:
                yield f"link {link.get('name')!r}: mesh {name!r} is missing"


def mesh_file(name: str, folders: list[Path]) -> Path | None:
    """The file a URDF's mesh name stands for, or None where it does not exist."""
    plain = name.removeprefix("package://").removeprefix("model://").removeprefix("file://")
    if Path(plain).is_absolute():
        return Path(plain) if Path(plain).is_file() else None
    for folder in folders:
        if plain and (folder / plain).is_file():
            return folder / plain
    return None
