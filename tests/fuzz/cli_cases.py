"""Command lines: hostile names, hostile files, random words."""

from __future__ import annotations

import contextlib
import io
import json
import os
import random
import signal
import stat
import sys
import tempfile
from pathlib import Path
from typing import Any

NAMES = [
    "[/bold]", "[left]", "[red]arm[/red]", "[link=http://evil]x[/link]", "[[x]]", "\\[x]", "{x}",
    "%s%n", "a\x1b[31mred", "\x1b]0;owned\x07", "\x9b31m", "a\rb", "a\x08b", "<b>x</b>", "a\u202eb",
    ":warning:", "-x", "--help", "[", "]", "[]", "[bold", "é日本", "[/]", "[@click=x]y[/]",
]  # fmt: skip

TABLE = """name = {name}
convention = "standard"
source = {source}
tool_name = {tool}
[[links]]
joint = "revolute"
a = 0.5
alpha = 0
d = 0
theta = 0
mass = 1
com = [-0.2, 0, 0]
inertia = {{ ixx = 0.1, iyy = 0.1, izz = 0.1 }}
name = {joint}
[[links]]
joint = "revolute"
a = 0.4
alpha = 0
d = 0
theta = 0
mass = 1
inertia = {{ ixx = 0.1, iyy = 0.1, izz = 0.1 }}
"""

URDF = """<robot name={name}><link name="base"/>
<link name={link}><inertial><mass value="1"/><inertia ixx="1" ixy="0" ixz="0" iyy="1" iyz="0" izz="1"/></inertial></link>
<link name={tool}/>
<joint name={joint} type="revolute"><parent link="base"/><child link={link}/><axis xyz="0 0 1"/>
<limit lower="-1" upper="1" effort="1" velocity="1"/></joint>
<joint name="end" type="fixed"><parent link={link}/><child link={tool}/><origin xyz="1 0 0"/></joint></robot>"""

FORMULAS = """robot = "planar2r"
[symbols]
{symbol} = 0.5
[formulas]
{entry} = {text}
"""

PYTHON = """import kinlab as kl
import numpy as np

@kl.hand_formula("gravity_torques", robot="single_link", source={source}, latex={latex})
def gravity(q):
    {source}
    return np.array([2.5 * 9.81 * 0.3 * np.cos(q[0]) + 1])
"""

FIVE = """name = {name}
l1 = [0.4, 0.4]
l2 = [0.6, 0.6]
e = 0.1
source = {source}
"""


def quoted(text: str) -> str:
    return json.dumps(text)


def attribute(text: str) -> str:
    safe = "".join(c if c >= " " or c in "\t\n\r" else "" for c in text)
    for old, new in (("&", "&amp;"), ("<", "&lt;"), ('"', "&quot;")):
        safe = safe.replace(old, new)
    return f'"{safe}"'


def named(seed: int, count: int) -> list[tuple[str, Any]]:
    """Files with hostile names in every place; label, and (files, words, text that must be seen)."""
    rng = random.Random(seed)
    out = []
    for n in range(count):
        name = rng.choice(NAMES)
        plain = {"name": "arm", "source": "here", "tool": "tip", "joint": "j1", "link": "l1"}
        kind = rng.choice(["table", "table", "urdf", "urdf", "formulas", "python", "five", "file"])
        seen = None
        if kind in ("table", "urdf"):
            place = rng.choice(
                [
                    k
                    for k in plain
                    if (kind == "urdf" and k != "source") or (kind == "table" and k != "link")
                ]
            )
            plain[place] = name
            quote = quoted if kind == "table" else attribute
            text = (TABLE if kind == "table" else URDF).format(
                **{k: quote(v) for k, v in plain.items()}
            )
            file = "arm.toml" if kind == "table" else "arm.urdf"
            words = rng.choice([
                ["info", file], ["check", file], ["check", "--rows", file], ["urdf", file], ["dh", file], ["ik", file, "--xyz", ".5", ".1", "0", "--task", "xy"],
                ["view", file, "--save", "x.html"], ["check", file, "--report", "r.html"], ["check", file, "--report", "r.md"],
                ["derive", file, "--what", "fk"], ["info", file, "--tip", name], ["singular", file, "--task", "xy"],
            ])  # fmt: skip
            if words[0] == "info" and place in ("name", "joint", "tool") and name.isprintable():
                seen = name
        elif kind == "formulas":
            place = rng.choice(["symbol", "entry", "text"])
            fill = {"symbol": "k", "entry": "g2", "text": quoted("m2*g*l2*cos(q1)")}
            fill[place] = quoted(name)
            text, file, words = FORMULAS.format(**fill), "f.toml", ["check", "f.toml"]
        elif kind == "python":
            text = PYTHON.format(source=quoted(name), latex=quoted(name))
            file, words, place = (
                "f.py",
                [
                    "check",
                    "f.py",
                    *rng.choice([[], ["--rows"], ["--json"], ["--report", "r.html"]]),
                ],
                "source",
            )
        elif kind == "five":
            text = FIVE.format(name=quoted(name), source=quoted(name))
            file, words, place = "five.toml", ["fivebar", "analyse", "five.toml"], "name"
        else:
            file = name.replace("/", "_") + ".toml"
            text = TABLE.format(**{k: quoted(v) for k, v in plain.items()})
            words, place = [rng.choice(["info", "check", "dh"]), "./" + file], "file name"
        out.append((f"#{n} {place} {name!r}: {' '.join(words)!r}", ({file: text}, words, seen)))
    return out


PATHS = ["folder", "fifo", "loop", "dangling", "missing", "empty.toml", "empty.urdf", "binary.toml", "binary.urdf",
         "binary.csv", "/dev/null", "/dev/zero", "/dev/stdin", "folder.toml", "folder.urdf", "fifo.toml", "fifo.urdf", "zero.toml",
         "latin.toml", "utf16.toml", "utf16.urdf", "wide.csv", "cell.csv", "lines.csv", "long.toml", "sparse.toml", "fifo.py",
         "nul.toml", "link.toml", ".", "..", "", "/", "~", "a\nb.toml", "x" * 300 + ".toml", "\udcff.toml", "folder.py", "binary.py", "syntax.py"]  # fmt: skip
LINES = [["info"], ["check"], ["dh"], ["urdf"], ["derive"], ["view", "--save", "x.html"], ["singular"], ["fivebar", "analyse"],
         ["ik", "--xyz", "0", "0", "0"]]  # fmt: skip
OUTPUTS = [["urdf", "planar2r", "-o"], ["dh", "planar2r", "-o"], ["check", "planar2r", "--report"], ["view", "planar2r", "--save"],
           ["derive", "planar2r", "--what", "fk", "-o"]]  # fmt: skip
TARGETS = ["folder", "missing/x.html", "full.html", "loop", "x" * 300 + ".html", "", "folder/", "a\0b", "readme.html/x.html", "x.html", "x.toml",
           "x.urdf", "x.md"]  # fmt: skip


def paths() -> list[tuple[str, Any]]:
    """Every command on every hostile path, and every output to every hostile target."""
    out = [(f"{' '.join(line)} {path[:40]!r}", (None, [*line[:1], *(line[1:2] if line[0] == "fivebar" else []), path, *(line[1:] if line[0] != "fivebar" else [])], None))
           for path in PATHS for line in LINES]  # fmt: skip
    out += [
        (f"{' '.join(line)} {t[:40]!r}", (None, [*line, t], None))
        for t in TARGETS
        for line in OUTPUTS
    ]
    return out


WORDS = ["planar2r", "puma560", "isotropic", "no-such", "--xyz", "0", "0.5", "-1", "nan", "inf", "1e400", "pi/2", "90 deg", "--rpy",
         "--seed", "--task", "xy", "pose", "110001", "999", "--tip", "tool", "[/bold]", "--report", "x.html", "x.pdf", "--json", "--rows",
         "-o", "x.png", "x.nope", "--what", "M", "fk", "--format", "latex", "--numbers", "--at", "0,0", "0;0", "0,nan", "1e308,1e308", "--slice", "1,2", "2,2", "0,9",
         "--free", "a2,tool.x", "a9", "--samples", "10", "-n", "--workers", "--folder", "--metric", "--length", "optimal", "--q0", "--branches",
         "--history", "-q", "--save", "--animate", "sweep", "--port", "--host", "", "--no-meshes", "--method", "newton", "--seeds", "3", "--plane",
         "--quantities", "001", "002.C", "\x1b[31m", "é", "--", "-", "--help", "--tol-position", "--sampling", "grid", "--", "--no-browser"]  # fmt: skip
COMMANDS = [
    "list",
    "info",
    "urdf",
    "dh",
    "check",
    "derive",
    "ik",
    "singular",
    "isotropy",
    "workspace",
    "fivebar",
    "view",
    "nonsense",
    "",
]


def random_lines(seed: int, count: int) -> list[tuple[str, Any]]:
    """Lines of random words; ``view`` always saves, so that nothing is served."""
    rng = random.Random(seed)
    out = []
    for _ in range(count):
        command = rng.choice(COMMANDS)
        words = [command]
        if command == "fivebar":
            words.append(rng.choice(["list", "analyse", "size", "export", "nonsense"]))
        words.append(rng.choice(["planar2r", "planar2r", "spatial3r", "isotropic", "no-such"]))
        words += rng.choices(WORDS, k=rng.randrange(0, 6))
        if command == "view":
            words += ["--save", "x.html"]
        if command in ("workspace", "isotropy"):
            words += [["--samples", "20"], ["--seeds", "2"]][command == "isotropy"]
        out.append((" ".join(map(repr, words)), (None, words, None)))
    return out


def _furnish(folder: Path) -> None:
    (folder / "folder").mkdir()
    for suffix in ("toml", "urdf", "py"):
        (folder / f"folder.{suffix}").mkdir()
        (folder / f"binary.{suffix}").write_bytes(bytes(range(256)) * 20)
        os.mkfifo(folder / f"fifo.{suffix}")
    os.mkfifo(folder / "fifo")
    (folder / "binary.csv").write_bytes(bytes(range(256)) * 20)
    (folder / "loop").symlink_to("loop")
    (folder / "dangling").symlink_to("nowhere")
    (folder / "zero.toml").symlink_to("/dev/zero")
    (folder / "link.toml").symlink_to("/dev/stdin")
    (folder / "empty.toml").touch()
    (folder / "empty.urdf").touch()
    (folder / "latin.toml").write_bytes('name = "é"'.encode("latin-1"))
    (folder / "utf16.toml").write_text('name = "a"', encoding="utf-16")
    (folder / "utf16.urdf").write_text(
        '<?xml version="1.0" encoding="utf-16"?><robot name="a"/>', encoding="utf-16"
    )
    (folder / "nul.toml").write_bytes(b'name = "a\0b"')
    (folder / "syntax.py").write_text("def (:")
    (folder / "wide.csv").write_text(",".join(["a"] * 20000))
    head = "joint,a,alpha,d,theta,convention\n"
    (folder / "cell.csv").write_text(head + "revolute," + "1" * 200_000 + ",0,0,0,standard\n")
    (folder / "lines.csv").write_text(head + "revolute,1,0,0,0,standard\n" * 100_000)
    (folder / "long.toml").write_text('name = "a"\n' + "# x\n" * 2_000_000)
    with (folder / "sparse.toml").open("wb") as file:
        file.truncate(3 << 30)
    (folder / "readme.html").write_text("mine")
    with contextlib.suppress(PermissionError):  # a copy: no case may name a real device to write to
        os.mknod(folder / "full.html", 0o666 | stat.S_IFCHR, os.makedev(1, 7))


def _visible(name: str, printed: str) -> bool:
    squeezed = "".join(printed.split())
    return "".join(name.split()) in squeezed or "".join(repr(name)[1:-1].split()) in squeezed


def judge(case: tuple[dict[str, str] | None, list[str], str | None]) -> tuple[str, str]:
    """One line in this process: exit code 0, 1 or 2, no control characters, names whole."""
    from kinlab import KinlabError
    from kinlab.cli import main

    files, words, seen = case
    printed, before, place = io.StringIO(), sys.argv, os.getcwd()  # noqa: PTH109
    handlers = {s: signal.getsignal(s) for s in (signal.SIGINT, signal.SIGTERM)}
    with tempfile.TemporaryDirectory() as name:
        folder = Path(name)
        if files is None:
            _furnish(folder)
        for file, text in (files or {}).items():
            (folder / file).write_text(text, encoding="utf-8", errors="surrogatepass")
        try:
            os.chdir(folder)
            sys.argv = ["kinlab", *words]
            with contextlib.redirect_stdout(printed), contextlib.redirect_stderr(printed):
                main()
            code: Any = 0
        except SystemExit as end:
            code = end.code or 0
        except KinlabError as problem:
            return "raw", f"a KinlabError escaped main: {problem}"
        finally:
            sys.argv = before
            os.chdir(place)
            for number, handler in handlers.items():
                signal.signal(number, handler)
        full = folder / "full.html"
        if files is None and full.exists() and not stat.S_ISCHR(full.lstat().st_mode):
            return "wrong", "a device became a file"
        if files is None and (folder / "readme.html").read_text() != "mine":
            return "wrong", "wrote over a file that it was not told to write"
    text = printed.getvalue()
    if code not in (0, 1, 2):
        return "raw", f"exit code {code!r}"
    if "Traceback" in text:
        return "raw", "a traceback was printed"
    bad = {
        c
        for c in text
        if (ord(c) < 32 and c not in "\n\t")
        or 127 <= ord(c) < 160
        or (c in "\u202e\u2066" and words[0] not in ("dh", "urdf"))
    }
    if bad:
        return "wrong", f"control characters {sorted(map(hex, map(ord, bad)))} reach the terminal"
    if seen is not None and code == 0 and not _visible(seen, text):
        return "wrong", "the name is not shown whole"
    if code == 2 and not text.strip():
        return "wrong", "exit code 2 without a word"
    return ("refused", "2") if code == 2 else ("right", str(code))
