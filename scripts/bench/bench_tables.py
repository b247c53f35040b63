"""How many slips in DH tables are named, how many wrongly, how long it takes.

The slips are made here, from the words that people use for them; nothing is taken from the
doctor, and what a repaired table is worth is judged by its poses and its mass matrix in Pinocchio.

    python scripts/bench/bench_tables.py   # 300 singles, 100 pairs, 10000 equivalents
    python scripts/bench/bench_tables.py --singles 60 --pairs 20 --equivalents 500 --seed 3
"""

from __future__ import annotations

import argparse
import json
import math
import time
from collections import Counter
from collections.abc import Callable, Iterator
from dataclasses import dataclass, replace
from pathlib import Path

import numpy as np

import kinlab as kl
from kinlab.doctor.tables.result import TableDiagnosis
from kinlab.doctor.tables.words import Cause

ARMS = ("planar3r", "scara", "stanford", "puma560", "puma560_modified", "ur5", "panda", "spatial3r")
ROUND = (0.0, math.pi / 2, -math.pi / 2, math.pi)


@dataclass(frozen=True)
class Slip:
    """One slip: the spoiled table, and where it was made (rows 1-based, empty for the whole)."""

    what: str
    table: kl.DHTable
    rows: tuple[int, ...]
    columns: tuple[str, ...]


def random_arm(seed: int, n: int, convention: str) -> kl.DHTable:
    """An arm with round and general angles, about one prismatic joint in six, masses."""
    rng = np.random.default_rng(seed)
    links = []
    for _ in range(n):
        spread = rng.uniform(0.01, 0.2, 3)
        links.append(
            kl.DHLink(
                joint="prismatic" if rng.random() < 0.17 else "revolute",
                a=round(float(rng.uniform(-0.5, 0.5)), 3) if rng.random() < 0.7 else 0.0,
                alpha=float(rng.choice(ROUND)) if rng.random() < 0.7 else
                math.radians(round(float(rng.uniform(-150, 150)))),
                d=round(float(rng.uniform(-0.5, 0.5)), 3) if rng.random() < 0.7 else 0.0,
                theta=float(rng.choice(ROUND)),
                mass=round(float(rng.uniform(0.5, 6)), 3),
                com=np.round(rng.uniform(-0.2, 0.2, 3), 4),
                inertia=np.diag(np.round(spread.sum() - spread, 4)),
                armature=round(float(rng.uniform(0.05, 1)), 3),
            )
        )  # fmt: skip
    tool = np.eye(4)
    tool[:3, 3] = np.round(rng.uniform(-0.2, 0.2, 3), 3)
    base = np.eye(4)
    base[:3, :3] = [[0, -1, 0], [0, 0, -1], [1, 0, 0]]
    base[:3, 3] = np.round(rng.uniform(-0.4, 0.4, 3), 3)
    return kl.DHTable(f"random{n}_{seed}", convention, links, base=base, tool=tool)


def arms() -> list[kl.DHTable]:
    """Fifteen arms of three to seven joints."""
    named = [kl.load(name).table for name in ARMS]
    drawn = [random_arm(100 + n, n, c) for n, c in
             ((3, "modified"), (4, "standard"), (5, "modified"), (5, "standard"), (6, "modified"),
              (6, "standard"), (7, "standard"))]  # fmt: skip
    return [table for table in named if table is not None] + drawn


def with_row(table: kl.DHTable, i: int, **cells: object) -> kl.DHTable:
    """The table with cells of row i (0-based) replaced."""
    links = list(table.links)
    links[i] = replace(links[i], **cells)  # type: ignore[arg-type]
    return replace(table, links=links)


def cell_slip(
    name: str, column: str, change: Callable[[float, np.random.Generator], float]
) -> Callable[[kl.DHTable, np.random.Generator], Slip | None]:
    """A slip in one number of a random row."""

    def make(table: kl.DHTable, rng: np.random.Generator) -> Slip | None:
        i = int(rng.integers(table.n))
        old = float(getattr(table.links[i], column))
        new = change(old, rng)
        if new == old:
            return None
        return Slip(name, with_row(table, i, **{column: new}), (i + 1,), (column,))

    return make


def whole(
    name: str, columns: tuple[str, ...], spoil: Callable[[kl.DHTable], kl.DHTable]
) -> Callable[[kl.DHTable, np.random.Generator], Slip | None]:
    """A slip of the whole table."""
    return lambda table, rng: Slip(name, spoil(table), (), columns)


def scaled(table: kl.DHTable, columns: tuple[str, ...], factor: float) -> kl.DHTable:
    """Columns in another unit."""
    links = [replace(k, **{c: getattr(k, c) * factor for c in columns}) for k in table.links]
    return replace(table, links=links)


def toggled(table: kl.DHTable) -> kl.DHTable:
    """The same rows under the other convention's name."""
    other = "modified" if table.convention == "standard" else "standard"
    return replace(table, convention=other)


def swapped_cells(table: kl.DHTable, rng: np.random.Generator) -> Slip | None:
    """a and d of one row."""
    i = int(rng.integers(table.n))
    link = table.links[i]
    return Slip("a and d", with_row(table, i, a=link.d, d=link.a), (i + 1,), ("a", "d"))


def swapped_rows(table: kl.DHTable, rng: np.random.Generator) -> Slip | None:
    """Two neighbouring rows."""
    i = int(rng.integers(table.n - 1))
    links = list(table.links)
    links[i], links[i + 1] = links[i + 1], links[i]
    return Slip("rows", replace(table, links=links), (i + 1, i + 2), ("order",))


def other_joint(table: kl.DHTable, rng: np.random.Generator) -> Slip | None:
    """Revolute for prismatic, or the other way round."""
    i = int(rng.integers(table.n))
    kind = "prismatic" if table.links[i].joint == "revolute" else "revolute"
    new = with_row(table, i, joint=kind, lower=None, upper=None)
    return Slip("joint type", new, (i + 1,), ("joint",))


def other_sense(table: kl.DHTable, rng: np.random.Generator) -> Slip | None:
    """A joint that turns the other way."""
    i = int(rng.integers(table.n))
    return Slip("sense", with_row(table, i, flip=not table.links[i].flip), (i + 1,), ("flip",))


def end(which: str, how: str) -> Callable[[kl.DHTable, np.random.Generator], Slip | None]:
    """The base or the tool forgotten, inverted or with its rotation transposed."""

    def make(table: kl.DHTable, rng: np.random.Generator) -> Slip | None:
        pose = np.array(getattr(table, which))
        new = np.eye(4)
        if how == "inverted":
            new = np.linalg.inv(pose)
            new[3] = (0, 0, 0, 1)
        elif how == "transposed":
            new = pose.copy()
            new[:3, :3] = pose[:3, :3].T
        return Slip(f"{which} {how}", replace(table, **{which: new}), (), (which,))

    return make


def left_out(table: kl.DHTable, rng: np.random.Generator) -> Slip | None:
    """A row too few."""
    if table.n < 4:
        return None
    i = int(rng.integers(table.n))
    links = [link for k, link in enumerate(table.links) if k != i]
    return Slip("left out", replace(table, links=links), (i + 1,), ("order",))


def doubled(table: kl.DHTable, rng: np.random.Generator) -> Slip | None:
    """A row twice."""
    i = int(rng.integers(table.n))
    again = replace(table.links[i], name=None)
    links = [replace(k, name=None) for k in table.links[: i + 1]]
    links += [again, *(replace(k, name=None) for k in table.links[i + 1 :])]
    return Slip("doubled", replace(table, links=links), (i + 1, i + 2), ("order",))


def body(
    name: str, column: str, change: Callable[[kl.DHLink], object]
) -> Callable[[kl.DHTable, np.random.Generator], Slip | None]:
    """A slip in the mass, com, inertia or armature of a random row."""

    def make(table: kl.DHTable, rng: np.random.Generator) -> Slip | None:
        i = int(rng.integers(table.n))
        link = table.links[i]
        if not link.mass or not np.any(getattr(link, column)):
            return None
        try:
            new = with_row(table, i, **{column: change(link)})
        except kl.KinlabError:
            return None  # no body can have such a tensor, and the table says so itself
        return Slip(name, new, (i + 1,), (column,))

    return make


def about_origin(link: kl.DHLink) -> np.ndarray:
    """The parallel-axis theorem, once too often."""
    c = np.asarray(link.com)
    out: np.ndarray = np.asarray(link.inertia) + link.mass * (c @ c * np.eye(3) - np.outer(c, c))
    return out


def rotated_gravity(table: kl.DHTable, rng: np.random.Generator) -> Slip | None:
    """Gravity along another axis."""
    return Slip("gravity", replace(table, gravity=np.roll(table.gravity, 1)), (), ("gravity",))


KINEMATIC = [
    whole("convention", ("convention",), toggled),
    cell_slip("theta offset missing", "theta", lambda x, r: 0.0),
    cell_slip("theta sign", "theta", lambda x, r: -x),
    cell_slip("theta 90", "theta", lambda x, r: x + float(r.choice([-1, 1])) * math.pi / 2),
    cell_slip("theta 180", "theta", lambda x, r: x + math.pi),
    cell_slip("alpha sign", "alpha", lambda x, r: -x),
    cell_slip("alpha 90", "alpha", lambda x, r: x + float(r.choice([-1, 1])) * math.pi / 2),
    swapped_cells,
    cell_slip("a sign", "a", lambda x, r: -x),
    cell_slip("d sign", "d", lambda x, r: -x),
    cell_slip("theta in degrees", "theta", lambda x, r: math.degrees(x)),
    cell_slip("alpha in degrees", "alpha", lambda x, r: math.degrees(x)),
    cell_slip("a in mm", "a", lambda x, r: 1000 * x),
    cell_slip("d in mm", "d", lambda x, r: 1000 * x),
    whole("all angles in degrees", ("alpha", "theta"),
          lambda t: scaled(t, ("alpha", "theta"), 180 / math.pi)),
    whole("all lengths in mm", ("a", "d"), lambda t: scaled(t, ("a", "d"), 1000.0)),
    other_sense,
    other_joint,
    swapped_rows,
    left_out,
    doubled,
    end("tool", "forgotten"),
    end("tool", "inverted"),
    end("base", "forgotten"),
    end("base", "inverted"),
    end("base", "transposed"),
    cell_slip("decimal point of a", "a", lambda x, r: x * float(r.choice([0.1, 10.0]))),
    cell_slip("decimal point of d", "d", lambda x, r: x * float(r.choice([0.1, 10.0]))),
]  # fmt: skip

DYNAMIC = [
    body("mass forgotten", "mass", lambda k: 0.0),
    body("decimal point of the mass", "mass", lambda k: 10 * k.mass),
    body("com sign", "com", lambda k: -np.asarray(k.com)),
    body("com axes", "com", lambda k: np.roll(k.com, 1)),
    body("inertia about the origin", "inertia", about_origin),
    body("principal order", "inertia", lambda k: np.roll(np.asarray(k.inertia), 1, (0, 1))),
    body("decimal point of the inertia", "inertia", lambda k: 10 * np.asarray(k.inertia)),
    body("armature J for G^2 J", "armature", lambda k: k.armature / 80.0**2),
    rotated_gravity,
]


def size_of(table: kl.DHTable) -> float:
    """Largest length of a table, at least 1 m."""
    return max(1.0, *(max(abs(k.a), abs(k.d)) for k in table.links))


def same(one: kl.DHTable, two: kl.DHTable, bodies: bool = True) -> bool:
    """Whether two tables are one arm: poses, mass matrix and gravity torques at random states."""
    if one.n != two.n or any(a.joint != b.joint for a, b in zip(one.links, two.links, strict=True)):
        return False
    q = np.random.default_rng(7).uniform(-2.0, 2.0, (8, one.n))
    if np.max(np.abs(one.fk(q)[:, -1] - two.fk(q)[:, -1])) > 1e-8 * size_of(two):
        return False
    if not bodies:
        return True
    first, second = kl.Robot.from_dh(one), kl.Robot.from_dh(two)
    if first.singular_mass or second.singular_mass:
        return bool(first.singular_mass) == bool(second.singular_mass)
    M1, M2 = kl.mass_matrix(first, q), kl.mass_matrix(second, q)
    g1, g2 = kl.gravity_torques(first, q), kl.gravity_torques(second, q)
    return bool(
        np.max(np.abs(M1 - M2)) <= 1e-7 * np.max(np.abs(M2))
        and np.max(np.abs(g1 - g2)) <= 1e-7 * max(1.0, float(np.max(np.abs(g2))))
    )


def named(cause: Cause, slips: list[Slip]) -> bool:
    """Whether a cause points at one of the slips."""
    rows = set(cause.rows)
    columns = {c.strip() for c in cause.column.split(",")}
    for slip in slips:
        wide = not slip.rows and bool(columns & {*slip.columns, "units"})
        exact = bool(rows) and rows <= set(slip.rows) and columns <= set(slip.columns)
        if wide or exact:
            return True
    return False


def judge(found: TableDiagnosis, right: kl.DHTable, slips: list[Slip]) -> str:
    """``exact``, ``equal`` (another explanation that repairs as well), ``unknown``, ``wrong``."""
    if found.agrees:
        return "wrong"
    if not found.causes:
        return "unknown"
    if found.repaired is None or not same(found.repaired, right):
        return "wrong"
    for causes in (found.causes, *found.alternatives):
        told = all(named(cause, slips) for cause in causes)
        if told and all(any(named(cause, [slip]) for cause in causes) for slip in slips):
            return "exact"
    return "equal"


def spoiled(
    rng: np.random.Generator, count: int, slips: int
) -> Iterator[tuple[kl.DHTable, kl.DHTable, list[Slip]]]:
    """Right tables, spoiled ones, and the slips made, one rule after the other."""
    pool = arms()
    rules = [*KINEMATIC, *DYNAMIC]
    made = 0
    k = 0
    while made < count:
        table = pool[int(rng.integers(len(pool)))]
        spoiled_table, done = table, []
        for step in range(slips):
            rule = rules[k % len(rules)] if step == 0 else rules[int(rng.integers(len(rules)))]
            slip = rule(spoiled_table, rng)
            if slip is None or (slips > 1 and slip.columns == ("order",)):
                break
            if same(slip.table, spoiled_table):
                break
            spoiled_table = slip.table
            done.append(slip)
        k += 1
        if len(done) < slips or same(spoiled_table, table):
            continue
        if slips > 1 and any(same(slip.table, spoiled_table) for slip in done[:-1]):
            continue
        made += 1
        yield table, spoiled_table, done


def about(axis: str, angle: float, shift: float = 0.0) -> np.ndarray:
    """A turn about and a shift along x or z, (4, 4)."""
    c, s = math.cos(angle), math.sin(angle)
    turn = {"x": [[1, 0, 0], [0, c, -s], [0, s, c]], "z": [[c, -s, 0], [s, c, 0], [0, 0, 1]]}
    out = np.eye(4)
    out[:3, :3] = turn[axis]
    out["xz".index(axis) * 2, 3] = shift
    return out


def frame_moved(link: kl.DHLink, move: np.ndarray) -> dict[str, object]:
    """The body of a link whose frame has been moved by ``move`` in itself."""
    R, p = move[:3, :3], move[:3, 3]
    return {"com": R.T @ (np.asarray(link.com) - p), "inertia": R.T @ np.asarray(link.inertia) @ R}


def regauged(table: kl.DHTable, i: int, how: str, rng: np.random.Generator) -> kl.DHTable:
    """Frame i (1-based, not the last) placed otherwise: x turned over, z turned over, slid.

    T_i becomes T_i G and T_{i+1} becomes G^-1 T_{i+1}, both again rows of a table.
    """
    one, two = table.links[i - 1], table.links[i]
    modified = table.convention == "modified"
    if how == "x":  # G = Rz(pi)
        sign = two if modified else one
        changed = {"a": -sign.a, "alpha": -sign.alpha}
        first = {"theta": one.theta + math.pi, **({} if modified else changed)}
        second = {"theta": two.theta - math.pi, **(changed if modified else {})}
        move = about("z", math.pi)
    elif how == "z":  # G = Rx(pi)
        joint = one if modified else two
        turned = {"theta": -joint.theta, "d": -joint.d, "flip": not joint.flip}
        first = {"alpha": one.alpha + math.pi, **(turned if modified else {})}
        second = {"alpha": two.alpha - math.pi, **({} if modified else turned)}
        move = about("x", math.pi)
    else:  # G = Tz(s), where the axes before and behind are parallel
        if abs(math.sin((two if modified else one).alpha)) > 1e-12:
            return table
        way = 1.0 if math.cos((two if modified else one).alpha) > 0 else -1.0
        s = round(float(rng.uniform(-0.3, 0.3)), 3)
        first = {"d": one.d + (s if modified else way * s)}
        second = {"d": two.d - (way * s if modified else s)}
        move = about("z", 0.0, s)
    moved = with_row(table, i - 1, **first, **frame_moved(one, move))
    return with_row(moved, i, **second)


def equivalent(table: kl.DHTable, rng: np.random.Generator) -> object:
    """Another description of the same arm: frames placed elsewhere, other signs, a URDF."""
    kind = int(rng.integers(5))
    if kind == 0:
        return kl.to_dh(kl.Robot.from_dh(table))
    if kind == 1:
        return kl.to_urdf(table)
    if kind == 2:  # the base along its own z; the first row takes it back
        link = table.links[0]
        if table.convention == "modified" or link.joint == "prismatic":
            return kl.Robot.from_dh(table)
        move = about("z", float(rng.uniform(-2, 2)), float(rng.uniform(-0.5, 0.5)))
        turn = math.atan2(move[1, 0], move[0, 0])
        moved = with_row(table, 0, d=link.d - move[2, 3], theta=link.theta - turn)
        return replace(moved, base=np.asarray(table.base) @ move)
    for _ in range(int(rng.integers(1, 5))):
        i = int(rng.integers(1, table.n))
        table = regauged(table, i, str(rng.choice(["x", "z", "slid"])), rng)
    return kl.to_urdf(table) if rng.random() < 0.2 else table


def main() -> None:
    """Runs the bench and prints its figures."""
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--singles", type=int, default=300)
    parser.add_argument("--pairs", type=int, default=100)
    parser.add_argument("--equivalents", type=int, default=10000)
    parser.add_argument("--seed", type=int, default=0)
    parser.add_argument("--show", action="store_true", help="print what was not named exactly")
    parser.add_argument("--json", type=Path)
    options = parser.parse_args()
    figures: dict[str, object] = {"seed": options.seed}
    for name, count, slips in (("singles", options.singles, 1), ("pairs", options.pairs, 2)):
        rng = np.random.default_rng([options.seed, slips])
        tally: Counter[str] = Counter()
        times, six = [], []
        for table, wrong, done in spoiled(rng, count, slips):
            start = time.perf_counter()
            found = kl.diagnose_table(wrong, table)
            times.append(time.perf_counter() - start)
            if table.n == 6:
                six.append(times[-1])
            verdict = judge(found, table, done)
            tally[verdict] += 1
            if options.show and verdict != "exact":
                told = "; ".join(f"{s.what} {s.rows} {s.columns}" for s in done)
                print(f"  {verdict}: {table.name}: {told} -> {found.sentence[:160]}")
        figures[name] = {**tally, "median_s": float(np.median(times)) if times else None,
                         "longest_s": max(times, default=None),
                         "longest_six_joints_s": max(six, default=None)}  # fmt: skip
        median = float(np.median(times or [0]))
        longest = f"{max(times, default=0):.2f} s, on six joints {max(six, default=0):.2f} s"
        print(f"{name}: {dict(tally)} of {count}, median {median:.3f} s, longest {longest}")
    rng = np.random.default_rng([options.seed, 3])
    pool = arms()
    alarms = 0
    for _ in range(options.equivalents):
        table = pool[int(rng.integers(len(pool)))]
        found = kl.diagnose_table(table, equivalent(table, rng))
        if not found.agrees:
            alarms += 1
            if options.show:
                print(f"  false alarm: {table.name}: {found.sentence[:160]}")
    figures["equivalents"] = {"count": options.equivalents, "false_alarms": alarms}
    print(f"equivalents: {alarms} false alarms in {options.equivalents}")
    if options.json:
        options.json.write_text(json.dumps(figures, indent=1) + "\n", encoding="utf-8")


if __name__ == "__main__":
    main()
