"""DH tables as TOML and CSV, with numbers in every spelling, and an own DH product."""

from __future__ import annotations

import math
import random
import tempfile
from pathlib import Path
from typing import Any

import numpy as np

REFUSE = None
"""The value of a spelling that has none."""

KNOWN_ONLY = "any"
"""A spelling that may be refused or read as its value."""


def spelled(rng: random.Random, value: float, angle: bool) -> tuple[str, float | None]:
    """Text for (about) a value, and what the text evidently means."""
    form = rng.randrange(11)
    if form == 0:
        return repr(value), value
    if form == 1:
        half = value / 2
        return f"{half!r} + {half!r}", half + half
    if form == 2:
        return f"-({-value!r})", value
    if form == 3 and angle:
        degrees = round(math.degrees(value))
        return f"{degrees} deg", math.radians(degrees)
    if form == 4 and angle:
        degrees = round(math.degrees(value))
        return f"{degrees}°", math.radians(degrees)
    if form == 5:
        k = rng.choice([2, 3, 4, 6, 180])
        return f"pi/{k}", math.pi / k
    if form == 6:
        return f"  {value!r}  ", value
    if form == 7:
        return f"{value!r} * sqrt(2)/2", value * math.sqrt(2) / 2
    if form == 8:
        return f"sin(pi/6)*{value!r}", math.sin(math.pi / 6) * value
    if form == 9:
        return f"+{abs(value)!r}", abs(value)
    return f"2*({value!r} - 1) + 2", 2 * (value - 1) + 2


HOSTILE: list[tuple[str, float | None]] = [
    ("0.5#7", REFUSE), ("0.5 # seven", REFUSE), ("tan(pi/2)", REFUSE), ("1/0", REFUSE),
    ("0/0", REFUSE), ("nan", REFUSE), ("inf", REFUSE), ("1e400", REFUSE), ("-1e999", REFUSE),
    ("1e308*10", REFUSE), ("1e200*1e200", REFUSE), ("sqrt(-1)", REFUSE), ("asin(2)", REFUSE),
    ("", REFUSE), (" ", REFUSE), ("0,5", REFUSE), ("1;2", REFUSE), ("(1,)", REFUSE), ("[1]", REFUSE),
    ("0.5\n+7", REFUSE), ("0.5\\\n", REFUSE), ("True", REFUSE), ("None", REFUSE), ("1j", REFUSE),
    ("0.5 deg deg", REFUSE), ("deg", REFUSE), ("pi pi", REFUSE), ("2pi", REFUSE), ("1 2", REFUSE),
    ("__import__('os')", REFUSE), ("9**9**9", REFUSE), ("lambda: 1", REFUSE), ("1 if 1 else 2", REFUSE),
    ("1e", REFUSE), ("--", REFUSE), ("'0.5'", REFUSE), ("0.5;", REFUSE), ("=0.5", REFUSE),
    ("1 and 2", REFUSE), ("pi.real", REFUSE), ("sin 1", REFUSE), ("sin()", REFUSE), ("max(1)", REFUSE),
    ("0.5 rad m", REFUSE), ("5 cm", REFUSE), ("5 mm", REFUSE), ("1:2", REFUSE), ("x := 1", REFUSE),
    ("1" + "0" * 400, REFUSE), ("1" * 5000, REFUSE), ("(" * 300 + "1" + ")" * 300, REFUSE),
    ("-" * 150 + "1", 1.0), ("0x10", 16.0), ("0b11", 3.0), ("0o17", 15.0), ("1_0.5", 10.5),
    ("٥", 5.0), ("０.５", 0.5), ("1e-400", 0.0), (".5", 0.5), ("5.", 5.0), ("+.5e+0", 0.5),
    ("\u00a00.5", 0.5), ("0.5\u2003", 0.5), ("π", math.pi), ("\u22120.5", -0.5), ("007", 7.0),
    ("tan(pi/2)*0", REFUSE), ("1/tan(pi/2)", 0.0), ("cos(pi/2)", 0.0), ("sin(pi)", 0.0),
    ("-0.0", 0.0), ("1//2", REFUSE), ("7 % 4", REFUSE), ("~1", REFUSE), ("1 << 3", REFUSE),
    ("(0.5)#)", REFUSE), ("0.5 if", REFUSE), ("0.5\x00", REFUSE), ("0.5\x0c", 0.5), ("#", REFUSE),
]  # fmt: skip
ANGLE_HOSTILE: list[tuple[str, float | None]] = [
    ("90 deg", math.pi / 2), ("90deg", math.pi / 2), ("90°", math.pi / 2), ("1.5 rad", 1.5),
    ("90 degree", REFUSE), ("90 DEG", REFUSE), ("90 grad", REFUSE), ("90 # deg", REFUSE),
    ("90 deg # x", REFUSE), ("1 + 89 deg", REFUSE), ("pi/2 deg", math.pi / 360), ("90 °", math.pi / 2),
    ("1e308 deg", math.radians(1e308)), ("45#°", REFUSE),
]  # fmt: skip
ANY_REFUSABLE = True


def own(table: dict[str, Any], q: np.ndarray) -> dict[str, np.ndarray]:
    """Pose, mass matrix and gravity torques by the DH product, in plain numpy."""

    def turn_z(t: float) -> np.ndarray:
        out = np.eye(4)
        out[:2, :2] = [[math.cos(t), -math.sin(t)], [math.sin(t), math.cos(t)]]
        return out

    def turn_x(t: float) -> np.ndarray:
        out = np.eye(4)
        out[1:3, 1:3] = [[math.cos(t), -math.sin(t)], [math.sin(t), math.cos(t)]]
        return out

    def shift(x: float, z: float) -> np.ndarray:
        out = np.eye(4)
        out[0, 3], out[2, 3] = x, z
        return out

    links = table["links"]
    n = len(links)
    T = np.eye(4)
    axes, points, frames = [], [], []
    for link, x in zip(links, q, strict=True):
        sign = -1.0 if link.get("flip") else 1.0
        theta = link["theta"] + (sign * x if link["joint"] == "revolute" else 0.0)
        d = link["d"] + (sign * x if link["joint"] == "prismatic" else 0.0)
        if table["convention"] == "standard":
            axes.append(sign * T[:3, 2])
            points.append(T[:3, 3])
            T = T @ turn_z(theta) @ shift(0, d) @ shift(link["a"], 0) @ turn_x(link["alpha"])
        else:
            before = T @ turn_x(link["alpha"]) @ shift(link["a"], 0)
            axes.append(sign * before[:3, 2])
            points.append(before[:3, 3])
            T = before @ turn_z(theta) @ shift(0, d)
        frames.append(T)
    M, g = np.zeros((n, n)), np.zeros(n)
    gravity = np.array(table["gravity"])
    for k, link in enumerate(links):
        centre = frames[k][:3, 3] + frames[k][:3, :3] @ np.array(link["com"])
        v, w = np.zeros((3, n)), np.zeros((3, n))
        for i in range(k + 1):
            if links[i]["joint"] == "revolute":
                v[:, i], w[:, i] = np.cross(axes[i], centre - points[i]), axes[i]
            else:
                v[:, i] = axes[i]
        R = frames[k][:3, :3]
        M += link["mass"] * v.T @ v + w.T @ R @ np.diag(link["inertia"]) @ R.T @ w
        g -= link["mass"] * v.T @ gravity
        M[k, k] += link["armature"]
    return {"fk": T, "mass_matrix": M, "gravity_torques": g}


def sound(rng: random.Random) -> dict[str, Any]:
    """A random table of plain numbers."""
    links = []
    for _ in range(rng.choice([1, 2, 2, 3])):
        body = [round(rng.uniform(0.05, 0.1), 3) for _ in range(3)]
        links.append({
            "joint": rng.choice(["revolute", "revolute", "prismatic"]),
            "a": round(rng.uniform(-0.5, 0.5), 3), "alpha": round(rng.uniform(-3, 3), 3),
            "d": round(rng.uniform(-0.5, 0.5), 3), "theta": round(rng.uniform(-3, 3), 3),
            "flip": rng.random() < 0.3, "lower": -1.5, "upper": 2.5,
            "mass": round(rng.uniform(0.5, 3), 3),
            "com": [round(rng.uniform(-0.2, 0.2), 3) for _ in range(3)],
            "inertia": body, "armature": round(rng.uniform(0, 0.1), 3),
        })  # fmt: skip
    return {"convention": rng.choice(["standard", "modified"]), "links": links,
            "gravity": [0.0, 0.0, -9.81]}  # fmt: skip


Case = tuple[str, str, Any]


def toml_text(text: str) -> str:
    out = "".join(c if c >= " " and c not in '"\\\x7f' else f"\\u{ord(c):04X}" for c in text)
    return f'"{out}"'


def _cells(table: dict[str, Any]) -> list[tuple[int, str, int | None]]:
    out: list[tuple[int, str, int | None]] = []
    for i in range(len(table["links"])):
        out += [(i, key, None) for key in ("a", "alpha", "d", "theta", "mass", "armature", "lower")]
        out += [(i, key, k) for key in ("com", "inertia") for k in range(3)]
    return out


def numbers(seed: int, count: int) -> list[tuple[str, Case]]:
    """Tables whose numbers are spelled at random; label, and (suffix, text, expected table)."""
    rng = random.Random(seed)
    out = []
    for n in range(count):
        table = sound(rng)
        texts: dict[tuple[int, str, int | None], str] = {}
        doomed, label = False, []
        suffix = rng.choice([".toml", ".toml", ".csv"])
        for where in _cells(table):
            i, key, k = where
            value = table["links"][i][key] if k is None else table["links"][i][key][k]
            angle = key in ("alpha", "theta") or (
                key == "lower" and table["links"][i]["joint"] == "revolute"
            )
            if rng.random() < 0.3 and key not in ("inertia", "lower", "mass", "armature"):
                texts[where], value = spelled(rng, value, angle)
            if k is None:
                table["links"][i][key] = value
            else:
                table["links"][i][key][k] = value
        where = rng.choice(_cells(table))
        i, key, k = where
        if rng.random() < 0.6:
            angle = key in ("alpha", "theta") or (
                key == "lower" and table["links"][i]["joint"] == "revolute"
            )
            text, value = rng.choice(HOSTILE + (ANGLE_HOSTILE if angle else []))
            if suffix == ".csv" and not text.strip() and key not in ("a", "alpha", "d", "theta"):
                value = {"lower": 0.0}.get(key, 0.0)  # an empty cell is the column's default
                if key == "lower":
                    value = -math.pi if angle else -1.0
            doomed = value is None
            label.append(f"{key}={text[:40]!r}")
            texts[where] = text
            if k is None:
                table["links"][i][key] = value
            else:
                table["links"][i][key][k] = value
        text = (_write_toml if suffix == ".toml" else _write_csv)(table, texts)
        out.append((f"#{n} {suffix} {'; '.join(label)}", (suffix, text, None if doomed else table)))
    return out


def _write_toml(table: dict[str, Any], texts: dict[Any, str]) -> str:
    lines = ['name = "fuzz"', f'convention = "{table["convention"]}"']
    for i, link in enumerate(table["links"]):
        lines += ["[[links]]", f'joint = "{link["joint"]}"', f"flip = {str(link['flip']).lower()}"]
        for key in ("a", "alpha", "d", "theta", "mass", "armature", "lower", "upper"):
            where = (i, key, None)
            word = toml_text(texts[where]) if where in texts else repr(link[key])
            lines.append(f"{key} = {word}")
        for key, names in (("com", None), ("inertia", ("ixx", "iyy", "izz"))):
            words = [
                toml_text(texts[i, key, k]) if (i, key, k) in texts else repr(link[key][k])
                for k in range(3)
            ]
            if names is None:
                lines.append(f"{key} = [{', '.join(words)}]")
            else:
                pairs = [f"{a} = {b}" for a, b in zip(names, words, strict=True)]
                lines.append(f"{key} = {{ {', '.join(pairs)} }}")
    return "\n".join(lines) + "\n"


def _write_csv(table: dict[str, Any], texts: dict[Any, str]) -> str:
    import csv
    import io

    plain = ["a", "alpha", "d", "theta", "mass", "armature", "lower", "upper"]
    head = ["joint", "flip", "convention", *plain, "com_x", "com_y", "com_z", "ixx", "iyy", "izz"]
    file = io.StringIO()
    writer = csv.writer(file)
    writer.writerow(head)
    for i, link in enumerate(table["links"]):
        row = [link["joint"], str(link["flip"]).lower(), table["convention"]]
        row += [texts.get((i, key, None), repr(link[key])) for key in plain]
        for key in ("com", "inertia"):
            row += [texts.get((i, key, k), repr(link[key][k])) for k in range(3)]
        writer.writerow(row)
    return file.getvalue()


STRUCTURE = [
    ("flip = true", "flip = 1"), ("flip = false", 'flip = "false"'), ("flip = false", "flip = 0"),
    ('joint = "revolute"', 'joint = "Revolute"'), ('joint = "revolute"', "joint = 1"),
    ('joint = "revolute"', 'joint = ["revolute"]'), ('joint = "revolute"', 'joint = "fixed"'),
    ('convention = "standard"', 'convention = "Standard"'), ('convention = "standard"', 'convention = ""'),
    ('convention = "standard"', "convention = 1"), ('convention = "standard"', 'convention = ["standard"]'),
    ('convention = "standard"', ""), ('name = "fuzz"', "name = 5"), ('name = "fuzz"', 'name = ""'),
    ('name = "fuzz"', 'name = "[/bold]{x}\\u001B[31m"'), ('name = "fuzz"', 'name = ["a"]'),
    ('name = "fuzz"', 'name = "a\\u0000b"'), ('name = "fuzz"', "name = 1979-05-27"),
    ("[[links]]", "[links]"), ("[[links]]", "[[link]]"), ("[[links]]", "[[links.x]]"),
    ("com = [", "com = [[1,2,3], "), ("com = [", "com = [1, "), ("com = [", "com = { x = ["),
    ("inertia = {", "inertia = { ixy = 9.0,"), ("inertia = {", "inertia = { foo = 9.0,"),
    ("a = ", "a = true #"), ("a = ", "a = 1979-05-27 #"), ("a = ", "a = {} #"), ("a = ", "a = [1] #"),
    ("a = ", "a = nan #"), ("a = ", "a = inf #"), ("a = ", "a = 1e999 #"), ("a = ", "b = 0 #"),
    ("a = ", "a = " + "1" * 5000 + " #"), ("a = ", "a = 0xfffffffffffffffffffffffffffffffff" + "f" * 300 + " #"),
    ("mass = ", "mass = -"), ("upper = ", "upper = -9 #"), ("lower = ", "lower = 9 #"),
    ('name = "fuzz"', 'name = "fuzz"\ngravity = "down"'), ('name = "fuzz"', 'name = "fuzz"\ngravity = [1,2]'),
    ('name = "fuzz"', 'name = "fuzz"\ngravity = [[1,2,3]]'), ('name = "fuzz"', 'name = "fuzz"\ngravity = [1,2,nan]'),
    ('name = "fuzz"', 'name = "fuzz"\ntool = 5'), ('name = "fuzz"', 'name = "fuzz"\ntool = { xyz = 1 }'),
    ('name = "fuzz"', 'name = "fuzz"\ntool = { rpy = [1,2] }'), ('name = "fuzz"', 'name = "fuzz"\ntool = [[1]]'),
    ('name = "fuzz"', 'name = "fuzz"\nbase = [[1,0,0,0],[0,1,0,0],[0,0,-1,0],[0,0,0,1]]'),
    ('name = "fuzz"', 'name = "fuzz"\nbase = [[2,0,0,0],[0,2,0,0],[0,0,2,0],[0,0,0,1]]'),
    ('name = "fuzz"', 'name = "fuzz"\ntool_name = "base_link"'), ('name = "fuzz"', 'name = "fuzz"\ntool_name = ""'),
    ('name = "fuzz"', 'name = "fuzz"\ntool_name = 5'), ('name = "fuzz"', 'name = "fuzz"\nsource = 5'),
    ('name = "fuzz"', 'name = "fuzz"\nx = ' + "[" * 2000 + "]" * 2000),
    ('name = "fuzz"', 'name = "fuzz"\nx = ' + "{a=" * 500 + "1" + "}" * 500),
    ('name = "fuzz"', 'name = "fuzz"\n' + "a." * 3000 + "b = 1"),
]  # fmt: skip
"""Changes after which a TOML table must be refused, or (where harmless) mean what it meant."""


def structures(seed: int) -> list[tuple[str, Case]]:
    """The changes of :data:`STRUCTURE`, each on a table that has the place."""
    rng = random.Random(seed)
    out = []
    for old, new in STRUCTURE:
        text = ""
        while old not in text:
            table = sound(rng)
            text = _write_toml(table, {})
        out.append((f"{old!r} -> {new[:60]!r}", (".toml", text.replace(old, new, 1), "raw only")))
    return out


def judge(case: Case) -> tuple[str, str]:
    """Loads the table as a file and compares it with the own product."""
    import kinlab as kl

    suffix, text, table = case
    with tempfile.TemporaryDirectory() as folder:
        file = Path(folder) / f"fuzz{suffix}"
        file.write_text(text, encoding="utf-8", newline="")
        robot = kl.load(file)
    if table is None:
        return "wrong", "accepted a number that has no value"
    if table == "raw only":
        kl.fk(robot, np.zeros(robot.n))
        return "right", "accepted"
    rng = np.random.default_rng(len(text))
    for i, link in enumerate(table["links"]):
        if abs(robot.lower[i] - link["lower"]) > 1e-12 * max(1, abs(link["lower"])):
            return "wrong", f"lower {robot.lower[i]} instead of {link['lower']}"
    for q in rng.uniform(-1, 1, (2, robot.n)):
        want = own(table, q)
        size = 1 + sum(
            abs(link["a"]) + abs(link["d"]) + max(map(abs, link["com"])) for link in table["links"]
        )
        weight = 1 + sum(
            link["mass"] + sum(link["inertia"]) + link["armature"] for link in table["links"]
        )
        with np.errstate(all="ignore"):
            for name, scale in (
                ("fk", size), ("mass_matrix", weight * size**2), ("gravity_torques", 9.81 * weight * size),
            ):  # fmt: skip
                if name != "fk" and not all(link["mass"] > 0 for link in table["links"]):
                    continue
                error = np.abs(getattr(kl, name)(robot, q) - want[name]).max() / scale
                if not error <= 1e-9:
                    return "wrong", f"{name} differs by {error:.1e}"
    return "right", ""
