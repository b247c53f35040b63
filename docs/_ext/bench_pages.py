"""The benchmarks' tables, from the JSON files in ``scripts/bench/results``."""

from __future__ import annotations

import json
from collections.abc import Callable, Iterable, Sequence
from pathlib import Path
from typing import Any

from made_pages import write_if_changed

Record = dict[str, Any]

PARTIES = {"pinocchio": "Pinocchio", "mujoco": "MuJoCo", "toolbox": "Robotics Toolbox"}
ARMS = {"puma560": "Puma 560", "ur5": "UR5", "ur10": "UR10", "panda": "Panda"}
ARMS["stanford"] = "Stanford arm"


def write(docs: Path) -> None:
    """Writes one piece for each section of ``benchmarks.md``."""
    results = docs.parent / "scripts" / "bench" / "results"
    folder = docs / "benchmarks" / "generated"
    for name, make in PIECES.items():
        file, _, _ = name.partition(".")
        data = json.loads((results / f"{file}.json").read_text(encoding="utf-8"))
        write_if_changed(folder / f"{name}.md", "\n".join(make(data)) + "\n")


def table(heads: Sequence[str], rows: Iterable[Sequence[str]]) -> list[str]:
    """A Markdown table, its numbers to the right."""
    lines = ["| " + " | ".join(heads) + " |", "|---|" + "---:|" * (len(heads) - 1)]
    return lines + ["| " + " | ".join(row) + " |" for row in rows]


def digits(value: float) -> str:
    """Two digits, three from a hundred up."""
    if value >= 9.95:
        return f"{value:,.0f}"
    return f"{value:.1f}" if value >= 0.995 else f"{value:.2f}"


# -------- bench.json: single calls, stacks, growth, sweeps


def machine(data: Record) -> list[str]:
    """Where and when it was measured."""
    about = data["machine"]
    versions = ", ".join(f"{name} {version}" for name, version in about["versions"].items())
    return [
        f"Measured {about['date']} on {about['system']}, {about['cores']} cores, Python "
        f"{about['python']}; {versions}."
    ]


def single(section: str) -> Callable[[Record], list[str]]:
    """One call: kinlab's time, and how many times longer the others take."""

    def make(data: Record) -> list[str]:
        rows = [row for row in data["rows"] if row["section"] == section]
        parties = [p for p in PARTIES if any(row["party"] == p for row in rows)]
        apart = max(row["apart"] for row in rows)
        lines = []
        for what in dict.fromkeys(row["what"] for row in rows):
            by = {row["party"]: row for row in rows if row["what"] == what}
            others = [f"{digits(by[p]['ratio'])} ×" if p in by else "" for p in parties]
            lines.append([f"`{what}`", f"{digits(by['kinlab']['us'])} µs", *others])
        found = table(["", "kinlab", *(PARTIES[p] for p in parties)], lines)
        return [*found, "", f"The answers of all parties agree to {apart:.0e}, relative."]

    return make


def grid(section: str, across: str, unit: str) -> Callable[[Record], list[str]]:
    """µs a state, a row for each function and a column for each number of joints or states."""

    def make(data: Record) -> list[str]:
        rows = [row for row in data["rows"] if row["section"] == section]
        columns = sorted({row[across] for row in rows})
        at = {(row["what"], row[across]): row["us"] for row in rows}
        lines = [
            [f"`{what}`", *(digits(at[what, c]) if (what, c) in at else "" for c in columns)]
            for what in dict.fromkeys(row["what"] for row in rows)
        ]
        return table([f"µs a state at … {unit}", *(f"{c:,}" for c in columns)], lines)

    return make


def sweep(data: Record) -> list[str]:
    """Whole sweeps: seconds and memory."""
    rows = [row for row in data["rows"] if row["section"] == "sweep"]
    lines = [
        [
            f"{row['what']}, {row['party'].removeprefix('workers: ')} workers".replace(
                " 1 workers", " 1 worker"
            ),
            f"{row['states']:,}",
            f"{row['us'] * row['states'] / 1e6:.1f} s",
            f"{row['memory_mb'] / 1000:.2f} GB",
        ]
        for row in rows
    ]
    return table(["sweep", "states", "time", "memory"], lines)


def start(data: Record) -> list[str]:
    """What it takes before the first answer."""
    rows = [row for row in data["rows"] if row["section"] == "cold start"]
    return table(
        ["from a cold start", "time"],
        [[f"`{row['what']}`", f"{row['us'] / 1e6:.1f} s"] for row in rows],
    )


# -------- bench_ik.json, bench_branches.json, bench_doctor.json


def inverse(data: Record) -> list[str]:
    """One solution: success and time beside Robotics Toolbox's ik_LM."""
    lines = []
    for name, arm in data["arms"].items():
        mine, batch = arm["parties"]["kinlab ik"], arm["parties"]["kinlab ik_batch"]
        other = arm["parties"]["Robotics Toolbox ik_LM"]
        lines.append(
            [
                ARMS.get(name, f"`{name}`"),
                f"{mine['success_percent']:g} %",
                f"{digits(mine['median_us'])} µs",
                f"{digits(batch['mean_us'])} µs",
                f"{other['success_percent']:g} %",
                f"{digits(other['median_us'])} µs",
            ]
        )
    heads = ["arm", "`kl.ik` solved", "median", "`kl.ik_batch`, a pose", "`ik_LM` solved", "median"]
    false = data["false_successes_of_kinlab"]
    count = min(arm["parties"]["kinlab ik"]["poses"] for arm in data["arms"].values())
    return [
        *table(heads, lines),
        "",
        f"{count:,} random poses of the whole joint range for each arm, 1e-6 m and 1e-6 rad. "
        f"Answers of kinlab that were called solved and were not: {false}.",
    ]


def branches(data: Record) -> list[str]:
    """All branches beside ssik and EAIK."""
    lines = []
    for name, arm in data["arms"].items():
        peers = [f"{digits(arm[p])} µs" if p in arm else "" for p in ("ssik", "EAIK")]
        lines.append(
            [
                name,
                arm["method"],
                f"{arm['solutions']:.1f}",
                f"{digits(arm['one pose'])} µs",
                f"{digits(arm['stack'])} µs",
                *peers,
            ]
        )
    heads = ["arm", "method", "solutions", "one pose", "stack, a pose", "ssik", "EAIK"]
    found = all(arm["own q found"] == 1.0 for arm in data["arms"].values())
    said = (
        ["", "The joint position that each pose was made from is among kinlab's answers each time."]
        if found
        else []
    )
    return [*table(heads, lines), *said]


def doctor(data: Record) -> list[str]:
    """Mistakes that were made on purpose: how many are named."""
    lines, strange = [], ""
    for name, tallies in data["groups"].items():
        sums: dict[str, int] = {}
        for tally in tallies.values():
            for verdict, count in tally.items():
                sums[verdict] = sums.get(verdict, 0) + count
        named = sum(sums.get(one, 0) for one in ("first", "tied", "right"))
        false = sums.get("wrong", 0) + sums.get("false alarm", 0)
        other = sums.get("other", 0)
        silent = sums["cases"] - named - other - false
        if name == "nothing explains it":
            strange = f"Of {sums['cases']} functions that nothing explains {false} were explained."
            continue
        counts = [
            sums["cases"],
            f"{named / sums['cases']:.0%}",
            sums.get("tied", 0),
            other,
            false,
            silent,
        ]
        lines.append([name, *map(str, counts)])
    right, seconds = sum(data["right"].values()), data["all seconds"]
    heads = [
        "mistakes",
        "number",
        "named",
        "of these tied",
        "mended otherwise",
        "named wrongly",
        "not named",
    ]
    return [
        *table(heads, lines),
        "",
        f"Right formulas in other forms, with numbers for names or rounded numbers: {right:,}, of "
        f"which {len(data['alarms'])} were called wrong. A diagnosis took {seconds['median']:.1f} "
        f"s of processor time in the median, {seconds['longest']:.1f} s at most. {strange}",
    ]


PIECES: dict[str, Callable[[Record], list[str]]] = {
    "bench.machine": machine,
    "bench.single": single("single ur5"),
    "bench.states": grid("states", "states", "states in one call"),
    "bench.joints": grid("joints, single", "joints", "joints, one call"),
    "bench.joints_stack": grid("joints, batch", "joints", "joints, stacks of 10,000"),
    "bench.sweep": sweep,
    "bench.start": start,
    "bench_ik.arms": inverse,
    "bench_branches.arms": branches,
    "bench_doctor.slips": doctor,
}
