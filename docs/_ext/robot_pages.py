"""A page for every shipped arm and five-bar: drawing, table, viewer, workspace, singularities.

Whatever a page says comes from the library and the robot's own file. Making all of them takes a
minute; a page is made again only when something of the library, of its robot's file or of this
generator has changed: the digest of all that heads the page.
"""

from __future__ import annotations

import hashlib
import math
import re
from collections.abc import Callable
from fractions import Fraction
from functools import partial
from pathlib import Path

import numpy as np
from drawings_dh import arm, five_bar
from numpy.typing import ArrayLike
from robot_postures import hanging, posture

import kinlab as kl
from kinlab.model.library import presets, robots_dir, shipped
from kinlab.tolerances import TOLERANCES

MODES = ((-1, 1), (1, -1), (1, 1), (-1, -1))


def write(docs: Path) -> None:
    """Writes ``robots/generated``: the pages, their pictures, and the cards of the overview.

    Args:
        docs: the folder of the site's sources.
    """
    folder = docs / "robots" / "generated"
    folder.mkdir(parents=True, exist_ok=True)
    shared = library_digest()
    arms = {name: entry.path for name, entry in shipped().items()}
    bars = presets()
    for files, make in ((arms, arm_page), (bars, bar_page)):
        for name, source in files.items():
            _renew(folder / f"{name}.md", [source], shared, partial(make, name, source, folder))
    kept = {*arms, *bars, "cards"}
    for old in folder.iterdir():
        if old.stem not in kept:
            old.unlink()
    every = [*arms.values(), *bars.values()]
    _renew(folder / "cards.txt", every, shared, partial(cards, list(arms), list(bars)))


def _renew(page: Path, sources: list[Path], shared: str, make: Callable[[], str]) -> None:
    """Writes a page, unless it was made from the same before."""
    digest = hashlib.sha256(shared.encode())
    for source in sources:
        digest.update(source.name.encode() + source.read_bytes())
    head = f"% made by docs/_ext/robot_pages.py from {digest.hexdigest()[:16]}\n"
    if page.exists():
        with page.open(encoding="utf-8") as old:
            if old.readline() == head:
                return
    page.write_text(head + make(), encoding="utf-8", newline="\n")


def library_digest() -> str:
    """One digest of what pages are made by: the library's files and these helpers."""
    digest = hashlib.sha256()
    own = Path(kl.__file__).parent
    helpers = [Path(__file__).with_name(f"{x}.py") for x in ("drawings_dh", "robot_postures")]
    files = [p for p in own.rglob("*") if p.suffix in (".py", ".js", ".css")]
    for file in sorted(files) + [Path(__file__), *helpers]:
        digest.update(file.name.encode() + file.read_bytes())
    return digest.hexdigest()


# -------- An arm's page


def arm_page(name: str, source: Path, folder: Path) -> str:
    """The page of a shipped arm, as Markdown; its picture is written into the folder."""
    robot = kl.load(name)
    table = robot.table
    q = posture(table)
    return "\n\n".join(
        [
            f"# {name}",
            _arm_lead(robot, table),
            f'```python\nrobot = kl.load("{name}")\n```',
            _figure(arm(table, q), _arm_caption(table, q)),
            "## DH table",
            _dh_table(table),
            _ends(table),
            "## Move it",
            "Drag the sliders; click a row of the table to see its a, α, d and θ on the arm.",
            _viewer(kl.viewer.Scene(robot, q)),
            "## Workspace",
            _arm_workspace(robot, folder),
            "## Singularities",
            _arm_singularities(robot),
            "## Masses",
            _masses(table),
            "## Sources",
            _sources(table.source, source),
        ]
    )


def _arm_lead(robot: kl.Robot, table: kl.DHTable) -> str:
    slides = sum(link.joint == "prismatic" for link in table.links)
    joints = f"{robot.n} joint{'s' if robot.n > 1 else ''}"
    kinds = f"{robot.n - slides} revolute and {slides} prismatic" if slides else "revolute"
    mass = sum(link.mass for link in table.links)
    weight = f"; its moving links weigh {mass:.4g} kg" if mass else "; no masses are given"
    return f"{joints}, {kinds}, {table.convention} DH convention{weight}."


def _arm_caption(table: kl.DHTable, q: np.ndarray) -> str:
    values = ", ".join(
        f"{math.degrees(x):.4g}°" if link.joint == "revolute" else f"{x:.3g} m"
        for x, link in zip(q, table.links, strict=True)
    ).replace("-", "−")
    last = table.n
    return (
        f"DH frames 0 to {last} at q = ({values}). Red: x, and what a row measures along it (a); "
        "blue: z, and what a row measures along it (d). Frames that lie in each other share a "
        "name. A cylinder is a revolute joint, a box a prismatic one; the green dot is the tool."
    )


def _figure(svg: str, caption: str) -> str:
    flat = svg.replace("\n", "")
    return (
        f'```{{raw}} html\n<figure class="robot-drawing">{flat}\n'
        f"<figcaption>{caption}</figcaption></figure>\n```"
    )


def angle(value: float) -> str:
    """An angle in degrees, as a part of π beside it where it is one."""
    degrees = round(math.degrees(value), 6) + 0.0
    part = Fraction(degrees / 180.0).limit_denominator(12)
    if (
        degrees
        and abs(float(part) * 180.0 - degrees) < 1e-6
        and part.denominator in (1, 2, 3, 4, 6)
    ):
        top = {1: "", -1: "−"}.get(part.numerator, f"{part.numerator}".replace("-", "−"))
        below = f"/{part.denominator}" if part.denominator > 1 else ""
        return f"{top}π{below}"
    return f"{degrees:.6g}°".replace("-", "−")


def metres(value: float) -> str:
    """A length, six digits."""
    return f"{round(value, 9) + 0.0:.6g}".replace("-", "−")


def _rows(head: list[str], rows: list[list[str]]) -> str:
    lines = [f"| {' | '.join(head)} |", "|" + "---|" * len(head)]
    return "\n".join(lines + [f"| {' | '.join(row)} |" for row in rows])


def _dh_table(table: kl.DHTable) -> str:
    i = "i−1" if str(table.convention) == "modified" else "i"
    rows = []
    for k, (link, name) in enumerate(zip(table.links, table.joint_names, strict=True), 1):
        turns = link.joint == "revolute"
        show = angle if turns else metres
        own = f"q{k}" if not link.flip else f"−q{k}"
        constant = link.theta if turns else link.d
        moving = own if abs(constant) < 1e-12 else f"{own} + {show(constant)}".replace("+ −", "− ")
        rows.append(
            [
                f"{k}",
                f"`{name}`",
                angle(link.alpha),
                metres(link.a),
                metres(link.d) if turns else moving,
                moving if turns else angle(link.theta),
                f"{_limit(link.lower, turns)} to {_limit(link.upper, turns)}",
            ]
        )
    heads = ["i", "joint", f"α<sub>{i}</sub>", f"a<sub>{i}</sub>, m", "d<sub>i</sub>, m"]
    return _rows([*heads, "θ<sub>i</sub>", "limits of q"], rows)


def _limit(value: float, turns: bool) -> str:
    return (f"{math.degrees(value):.5g}°" if turns else f"{value:.4g} m").replace("-", "−")


def _ends(table: kl.DHTable) -> str:
    words = []
    for which, pose in (
        ("frame 0 in the world", table.base),
        ("tool in the last frame", table.tool),
    ):
        pose = np.asarray(pose)
        if not np.allclose(pose, np.eye(4)):
            place = ", ".join(metres(x) for x in pose[:3, 3])
            turned = "" if np.allclose(pose[:3, :3], np.eye(3)) else ", turned"
            words.append(f"{which}: at ({place}) m{turned}")
    gravity = ", ".join(f"{x:g}".replace("-", "−") for x in np.asarray(table.gravity))
    return "; ".join([*words, f"gravity ({gravity}) m/s²"]).capitalize() + "."


def _masses(table: kl.DHTable) -> str:
    if not any(link.mass for link in table.links):
        return "The file gives none."
    rows = []
    for k, link in enumerate(table.links, 1):
        inertia = np.asarray(link.inertia)
        products = [inertia[0, 1], inertia[0, 2], inertia[1, 2]]
        rows.append(
            [
                f"{k}",
                f"{link.mass:.4g}",
                "(" + ", ".join(metres(x) for x in np.asarray(link.com)) + ")",
                "(" + ", ".join(f"{x:.4g}" for x in np.diag(inertia)) + ")",
                "(" + ", ".join(f"{x:.4g}".replace("-", "−") for x in products) + ")"
                if any(products)
                else "0",
                f"{link.armature:.4g}",
            ]
        )
    head = [
        "link",
        "mass, kg",
        "centre, m",
        "I<sub>xx</sub>, I<sub>yy</sub>, I<sub>zz</sub>, kg m²",
    ]
    head += ["I<sub>xy</sub>, I<sub>xz</sub>, I<sub>yz</sub>", "armature, kg m²"]
    return (
        _rows(head, rows)
        + "\n\nCentre and inertia (about the centre) in the link's own DH frame; armature is the "
        "rotor's inertia as the joint feels it."
    )


def _viewer(scene: object) -> str:
    return f"```{{raw}} html\n{scene._repr_html_()}\n```"


def _picture(path: Path, axes: object, said: str) -> str:
    kl.plots.save(axes, path)
    return f"```{{image}} {path.name}\n:alt: {said}\n:class: on-white\n```"


def _arm_workspace(robot: kl.Robot, folder: Path) -> str:
    axes = kl.plots.workspace(robot)
    shown = _picture(folder / f"{robot.name}.png", axes, f"Workspace of {robot.name}")
    words = (
        f'`kl.plots.workspace("{robot.name}")`: in each cell the best of 1/κ among 20,000 random '
        "states within the joint limits. The coloured area is what the samples met, so its edge "
        "is ragged."
    )
    labels = {text.get_text() for legend in axes.figure.legends for text in legend.get_texts()}
    if "boundary" in labels:
        words += " The dashed line is the boundary, exact arcs (`kl.planar_boundary`)."
    if labels & {"edge", "inside: solutions change", "with a joint at a limit"}:
        words += (
            " Black: the edge of the section through the first axis; red: curves inside, across "
            "which the number of solutions for the position changes; dashed: with a joint at a "
            "limit (`kl.workspace_section`)."
        )
    return f"{shown}\n\n{words}"


def _arm_singularities(robot: kl.Robot) -> str:
    if robot.n == 1:
        return (
            "None: the one column of J has the same length at every q, since a single joint keeps "
            "the tool at one distance from its axis."
        )
    found = kl.find_singularities(robot)
    chosen = ", chosen for this arm" if found.suggested else ""
    lines = [f'Task {found.task}{chosen}. `print(kl.find_singularities("{robot.name}"))`:']
    rows, rests = [], []
    for k, family in enumerate(found.families, 1):
        pairs = zip(family.deciding, family.pinned, strict=False)  # pinned may be empty
        values = ", ".join(_value(robot, name, value) for name, value in pairs)
        names = ", ".join(f"`{name}`" for name in family.deciding)
        beyond = {True: "yes", False: "no", None: "undecided"}[family.beyond]
        lost = family.representative.lost_direction.replace("-", "−")
        wide = f'<span class="wide">{lost}</span>'
        rows.append([f"{k}", family.kind, names, values or "together", wide, beyond])
        rests.append(f"{k}. {str(family.evidence)[0].upper()}{str(family.evidence)[1:]}")
    head = ["", "kind", "decided by", "at", "lost direction at one of them", "tool passes on"]
    if rows:
        lines.append(_rows(head, rows))
        lines.append(
            "*Decided by*: the fewest joints that hold the arm singular; the others are free. "
            "*Together*: these joints vary along a curve or surface. *Tool passes on*: whether the "
            "tool can go on in the lost direction there, or stands on the edge of the workspace."
        )
    else:
        lines.append("No singular configuration was found within the joint limits.")
    lines.append(f"What it rests on: {found.evidence}")
    if rests:
        lines.append(":::{dropdown} What each family rests on\n" + "\n".join(rests) + "\n:::")
    if found.families and len(found.families[0].representative.rows) == robot.n:
        lines.append(_determinant(robot))
    return "\n\n".join(line for line in lines if line)


def _value(robot: kl.Robot, name: str, value: float) -> str:
    kind = robot.table.links[robot.joint_names.index(name)].joint
    value = 0.0 if abs(value) < 1e-9 else value
    return angle(value) if kind == "revolute" else f"{metres(value)} m"


def _determinant(robot: kl.Robot) -> str:
    found = kl.factored_determinant(robot)
    return (
        f"The determinant of J in factors (`kl.factored_determinant`), by exact algebra on the "
        f"table's numbers:\n\n$$\\det J = {found.latex}$$"
    )


def _sources(text: str, source: Path) -> str:
    remarks = re.match(r"(?:#.*\n)*", source.read_text(encoding="utf-8")).group(0)
    text = text.strip().rstrip(".")
    lines = [f"{text[:1].upper()}{text[1:]}." if text else "The file names none."]
    if remarks:
        lines.append("The file's own remarks:")
        lines.append("\n".join(f"> {line[1:].strip()}" for line in remarks.splitlines()))
    below = source.relative_to(robots_dir())
    plain = source.read_text(encoding="utf-8").strip()
    lines.append(f"::::{{dropdown}} robots/{below.as_posix()}\n```toml\n{plain}\n```\n::::")
    return "\n\n".join(line for line in lines if line)


# -------- A five-bar's page


def bar_page(name: str, source: Path, folder: Path) -> str:
    """The page of a shipped five-bar, as Markdown; its picture is written into the folder."""
    bar = kl.FiveBar.load(name)
    theta = hanging(bar)
    degrees = ", ".join(f"{math.degrees(x):.4g}°" for x in theta).replace("-", "−")
    caption = (
        f"At θ = ({degrees}): cranks A<sub>i</sub>B<sub>i</sub>, rods B<sub>i</sub>P, tool P; the "
        "crank angles count from x, counter-clockwise."
    )
    return "\n\n".join(
        [
            f"# {name}",
            "Five-bar: two cranks on fixed pins, two rods that meet at the tool.",
            f'```python\nbar = kl.FiveBar.load("{name}")\n```',
            _figure(five_bar(bar, theta), caption),
            "## Lengths and masses",
            _bar_table(bar),
            "## Move it",
            "Two sliders, one for each crank; the loop stays closed. A crank that is dragged into "
            "a type II singularity stops there.",
            _viewer(kl.viewer.FiveBarScene(bar, theta)),
            "## Workspace",
            _bar_workspace(bar, folder),
            "## Singularities",
            _bar_singularities(bar),
            "## Sources",
            _sources(bar.source, source),
        ]
    )


def _bar_table(bar: kl.FiveBar) -> str:
    words = {
        "l1": "crank length l₁, m",
        "l2": "rod length l₂, m",
        "crank_mass": "crank mass, kg",
        "crank_com": "crank's centre from its pin, m",
        "crank_inertia": "crank's inertia about its centre, kg m²",
        "rod_mass": "rod mass, kg",
        "rod_com": "rod's centre from the elbow, m",
        "rod_inertia": "rod's inertia about its centre, kg m²",
    }
    rows = []
    for field, word in words.items():
        one, two = getattr(bar, field)
        if one or two:
            rows.append([word, f"{one:.5g}", f"{two:.5g}"])
    text = _rows(["", "leg 1", "leg 2"], rows)
    rest = f"The pins stand at (±{bar.e:.5g}, 0) m; leg 1 is the one at +e."
    if bar.payload:
        rest += f" Payload at the tool {bar.payload:g} kg."
    if not bar.crank_mass.any() and not bar.rod_mass.any():
        rest += " The file gives no masses, and nothing is guessed: they count as zero."
    gravity = ", ".join(f"{x:g}".replace("-", "−") for x in bar.gravity)
    return f"{text}\n\n{rest} Gravity ({gravity}) m/s²."


def _bar_workspace(bar: kl.FiveBar, folder: Path) -> str:
    shown = _picture(folder / f"{bar.name}.png", kl.plots.fivebar(bar), f"Workspace of {bar.name}")
    circle, box = bar.largest_circle(), bar.largest_rectangle()
    return (
        f'{shown}\n\n`kl.plots.fivebar("{bar.name}")`: condition number of J in the working mode '
        f"(−, +), whose elbows point outward. Free of singularities in assembly +1: a circle of "
        f"radius {metres(circle.radius)} m about {_place(circle.centre)}, and a rectangle of "
        f"{metres(box.x_max - box.x_min)} m by {metres(box.y_max - box.y_min)} m. Both are the "
        "largest that a search from a grid found: local bests, not proved to be the largest."
    )


def _place(point: ArrayLike) -> str:
    x, y = (metres(round(float(value), 6)) for value in np.asarray(point))
    return f"({x}, {y}) m"


def _bar_singularities(bar: kl.FiveBar) -> str:
    first = []
    for leg, circles in enumerate(bar.type_one(), 1):
        for which, circle in zip(("inner", "outer"), circles, strict=True):
            first.append([f"{leg}", which, _place(circle.centre), metres(circle.radius)])
    second = [
        f"{locus.kind}, tool x from {metres(round(float(locus.points[:, 0].min()), 4))} to "
        f"{metres(round(float(locus.points[:, 0].max()), 4))} m, y from "
        f"{metres(round(float(locus.points[:, 1].min()), 4))} to "
        f"{metres(round(float(locus.points[:, 1].max()), 4))} m"
        for locus in bar.type_two()
    ]
    lines = [
        "**Type I**, crank and rod of a leg in line: the tool loses a direction. Exactly on these "
        "circles, the edges of each leg's reach (radius 0: a point).",
        _rows(["leg", "", "centre", "radius, m"], first),
        "**Type II**, rods in line: the tool can move while the cranks stand. By formula, on "
        "closed curves (a point of a four-bar's coupler), folded or stretched:",
        "\n".join(f"- {line}" for line in second) or "- none: no pose has its rods in line so.",
    ]
    if bar.e == 0.0 and bar.l1[0] == bar.l1[1] and bar.l2[0] == bar.l2[1]:
        lines.append(
            "With both cranks on one axis, equal cranks and equal rods, both legs also coincide "
            "wherever both have the same working mode: the modes (+, +) and (−, −) are singular "
            "everywhere."
        )
    rows = []
    for mode in MODES:
        area = bar.workspace_map(mode).area
        poses = [
            _place(pose.xy) + (", fully" if max(pose.pressure) < TOLERANCES.pressure_angle else "")
            for pose in bar.isotropic_poses(mode)
        ]
        signs = "(" + ", ".join("+" if sign > 0 else "−" for sign in mode) + ")"
        rows.append([signs, *(f"{x:.4g}" for x in area), "; ".join(poses) or "none found"])
    lines += [
        "**By working mode**, the signs of u₁ × w₁ and u₂ × w₂ (areas on a grid):",
        _rows(["mode", "area, w₁ × w₂ > 0, m²", "area, w₁ × w₂ < 0, m²", "isotropic at"], rows),
    ]
    if any("fully" in row[-1] for row in rows):
        lines.append("*Fully*: the pressure angles are zero there too.")
    return "\n\n".join(lines)


# -------- The overview


def cards(arms: list[str], bars: list[str]) -> str:
    """Two grids of thumbnails that link to the pages."""
    parts = ["## Arms", "::::{grid} 1 2 3 3\n:gutter: 3"]
    for name in arms:
        table = kl.load(name).table
        slides = "".join("P" if x.joint == "prismatic" else "R" for x in table.links)
        drawn = arm(table, posture(table), frames=False, most=330.0)
        parts.append(_card(name, f"{table.n} joints: {slides}, {table.convention}", drawn))
    parts += ["::::", "## Five-bars", "::::{grid} 1 2 3 3\n:gutter: 3"]
    for name in bars:
        bar = kl.FiveBar.load(name)
        drawn = five_bar(bar, hanging(bar), names=False, most=330.0)
        words = f"l₁ {_pair(bar.l1)}, l₂ {_pair(bar.l2)}, e {bar.e:.4g} m"
        parts.append(_card(name, words, drawn))
    tree = "\n".join(f"generated/{name}" for name in (*arms, *bars))
    parts += ["::::", f"```{{toctree}}\n:hidden:\n\n{tree}\n```"]
    return "\n\n".join(parts) + "\n"


def _card(name: str, words: str, drawn: str) -> str:
    words = words.replace("1 joints", "1 joint")
    flat = drawn.replace("\n", "")
    return (
        f":::{{grid-item-card}} {name}\n:link: generated/{name}\n:link-type: doc\n"
        f'```{{raw}} html\n<div class="robot-drawing thumbnail">{flat}</div>\n```\n{words}\n:::'
    )


def _pair(values: np.ndarray) -> str:
    one, two = values
    return f"{one:.4g}" if one == two else f"{one:.4g} and {two:.4g}"
