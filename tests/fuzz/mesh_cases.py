"""Meshes cut, flipped and filled with nonsense, in a robot that is drawn into a page."""

from __future__ import annotations

import contextlib
import io
import logging
import math
import random
import struct
import sys
import tempfile
import warnings
from pathlib import Path
from typing import Any

URDF = """<robot name="meshes"><link name="base"/>
<link name="arm"><visual><geometry><mesh filename="{file}" scale="{scale}"/></geometry></visual>
<inertial><mass value="1"/><inertia ixx="1" ixy="0" ixz="0" iyy="1" iyz="0" izz="1"/></inertial></link>
<joint name="turn" type="revolute"><parent link="base"/><child link="arm"/><axis xyz="0 0 1"/>
<limit lower="-1" upper="1" effort="1" velocity="1"/></joint></robot>"""

DAE = """<?xml version="1.0" encoding="utf-8"?>
<COLLADA xmlns="http://www.collada.org/2005/11/COLLADASchema" version="1.4.1">
<asset><unit name="meter" meter="1"/><up_axis>Z_UP</up_axis></asset>
<library_geometries><geometry id="g" name="g"><mesh>
<source id="p"><float_array id="pa" count="9">0 0 0 1 0 0 0 1 0</float_array>
<technique_common><accessor source="#pa" count="3" stride="3"><param name="X" type="float"/><param name="Y" type="float"/><param name="Z" type="float"/></accessor></technique_common></source>
<vertices id="v"><input semantic="POSITION" source="#p"/></vertices>
<triangles count="1"><input semantic="VERTEX" source="#v" offset="0"/><p>0 1 2</p></triangles>
</mesh></geometry></library_geometries>
<library_visual_scenes><visual_scene id="s"><node id="n"><instance_geometry url="#g"/></node></visual_scene></library_visual_scenes>
<scene><instance_visual_scene url="#s"/></scene></COLLADA>"""


def _points() -> list[list[tuple[float, float, float]]]:
    ring = [(math.cos(a), math.sin(a), 0.0) for a in (i * math.pi / 6 for i in range(12))]
    return [[(0.0, 0.0, 0.5), ring[i], ring[(i + 1) % 12]] for i in range(12)]


def _binary() -> bytes:
    out = b"made for a test".ljust(80) + struct.pack("<I", 12)
    for face in _points():
        out += struct.pack("<12fH", 0, 0, 1, *(x for p in face for x in p), 0)
    return out


def _ascii() -> bytes:
    lines = ["solid cone"]
    for face in _points():
        lines += ["facet normal 0 0 1", "outer loop"]
        lines += [f"vertex {x:.6f} {y:.6f} {z:.6f}" for x, y, z in face]
        lines += ["endloop", "endfacet"]
    return "\n".join([*lines, "endsolid cone", ""]).encode()


def _obj() -> bytes:
    lines = []
    for i, face in enumerate(_points()):
        lines += [f"v {x:.6f} {y:.6f} {z:.6f}" for x, y, z in face]
        lines.append(f"f {3 * i + 1} {3 * i + 2} {3 * i + 3}")
    return "\n".join(lines).encode()


SOUND = {"binary.stl": _binary, "ascii.stl": _ascii, "cone.obj": _obj, "cone.dae": DAE.encode}
WORDS = [
    b"nan",
    b"inf",
    b"1e400",
    b"-1e39",
    b"",
    b"x",
    b"1,5",
    b"999999999",
    b"0/0",
    b"-7",
    b"\xff\xfe",
    b"1e-45",
    b"<a>",
    b"0",
]


def mutate(rng: random.Random, data: bytes) -> tuple[bytes, str]:
    """One change; and what it was."""
    i = rng.randrange(len(data))
    kind = rng.randrange(9)
    if kind == 0:
        return data[:i], f"cut at {i}"
    if kind == 1:
        return data[:i] + bytes(rng.randrange(256) for _ in range(8)) + data[
            i + 8 :
        ], f"noise at {i}"
    if kind == 2:
        words = data.split(b" ")
        j, word = rng.randrange(len(words)), rng.choice(WORDS)
        words[j] = word
        return b" ".join(words), f"word {j} is {word!r}"
    if kind == 3:
        return b"", "empty"
    if kind == 4 and len(data) > 84 and data[:4] == b"made":
        count = rng.choice([0, 1, 13, 1 << 20, (1 << 32) - 1])
        return data[:80] + struct.pack("<I", count) + data[84:], f"{count} faces"
    if kind == 5 and len(data) > 140 and data[:4] == b"made":
        value = rng.choice([math.nan, math.inf, 3e38, -math.inf])
        j = 84 + 12 + 50 * rng.randrange(12)
        return data[:j] + struct.pack("<f", value) + data[j + 4 :], f"a coordinate is {value}"
    if kind == 6:
        return data + data[:i], "doubled"
    if kind == 7:
        return data.replace(b"\n", b"\r", 3), "line ends"
    return data[:i] + data[i + rng.randrange(1, 200) :], f"bytes dropped at {i}"


def cases(seed: int, count: int) -> list[tuple[str, Any]]:
    """Mutants; label, and (file name, bytes, scale)."""
    rng = random.Random(seed)
    out: list[tuple[str, Any]] = [
        (f"sound {name}", (name, make(), "1 1 1")) for name, make in SOUND.items()
    ]
    while len(out) < count:
        name = rng.choice(list(SOUND))
        data, what = mutate(rng, SOUND[name]())
        scale = rng.choice(
            ["1 1 1"] * 8 + ["0 0 0", "1e300 1 1", "nan 1 1", "-1 1 1", "1", "a b c", ""]
        )
        file = (
            name
            if rng.random() < 0.85
            else rng.choice(["x.nope", "noext", "x.STL", "x.stl.gz", "a b.stl", "é.stl", "x.svg"])
        )
        out.append((f"{file} ({name}): {what}, scale {scale!r}", (file, data, scale)))
    return out


def judge(case: tuple[str, bytes, str]) -> tuple[str, str]:
    """``kinlab view --save``: a page; drawn, or the mesh named."""
    from kinlab.cli import main

    file, data, scale = case
    printed, before = io.StringIO(), sys.argv
    handler = logging.StreamHandler(printed)
    logging.getLogger().addHandler(handler)
    with tempfile.TemporaryDirectory() as name:
        folder = Path(name)
        (folder / file).write_bytes(data)
        (folder / "arm.urdf").write_text(URDF.format(file=file, scale=scale))

        def save(*more: str) -> tuple[int, str]:
            sys.argv = [
                "kinlab",
                "view",
                str(folder / "arm.urdf"),
                "--save",
                str(folder / "x.html"),
                *more,
            ]
            (folder / "x.html").unlink(missing_ok=True)
            try:
                with (
                    contextlib.redirect_stdout(printed),
                    contextlib.redirect_stderr(printed),
                    warnings.catch_warnings(),
                ):
                    warnings.simplefilter("always")
                    main()
                code = 0
            except SystemExit as end:
                code = int(end.code or 0)
            page = folder / "x.html"
            return code, page.read_text() if page.is_file() else ""

        try:
            code, page = save()
            if code == 2:
                text = printed.getvalue()
                return (
                    ("refused", text[:100])
                    if text.strip()
                    else ("wrong", "exit code 2 without a word")
                )
            rods = save("--no-meshes")[1]
        finally:
            sys.argv = before
            logging.getLogger().removeHandler(handler)
        if not page:
            return "wrong", f"exit code {code} and no page"
        drawn = abs(len(page) - len(rods)) > 40
        if "NaN" in page[len(page) // 2 :] and "NaN" not in rods[len(rods) // 2 :]:
            return "wrong", "NaN in the page"
        if not drawn and Path(file).name not in printed.getvalue():
            return "wrong", "neither drawn nor named"
    return "right", "drawn" if drawn else "named"
