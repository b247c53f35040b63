"""How often the formula doctor is right: seeded mistakes, right formulas, times.

The classes are in :mod:`bench_doctor_cases`. Every case has a seed of its own, so that a run that
was stopped goes on where it was, and the same ``--seed`` makes the same cases in any order.

*exact*: the first cause names the mistake, or one of the causes of equal length does (counted
apart as *tied*), and a repaired text agrees with the right one to 1e-9 at random parameters.
*other*: none of them is what was done, but the repaired text is the right one, with no more changes
than were made, or the difference is told term by term. *wrong*: a cause is given, and it is
neither. *part*: the cause is not known, but a part of the formula is said to be right, or wrong.
*unknown*: not even that. Writes results/bench_doctor.json and .md, and the tables of
docs/benchmarks.md are made of the first.
"""

from __future__ import annotations

import argparse
import json
import platform
import random
import tempfile
import time
from collections import Counter
from pathlib import Path
from typing import Any

import numpy as np
from bench_doctor_cases import Case, classes, right

import kinlab as kl

EXACT = ("first", "tied", "right")
MISSED = ("other", "wrong", "part", "unknown", "unnoticed", "refused", "false alarm")
HEADS = ("exact", "tied", "other", "wrong", "part", "unknown", "unnoticed", "refused")
DRAWS = 40
"""Draws until a maker has a case: many an arm has no slide, many a formula no square."""


def judged(case: Case) -> tuple[str, Any]:
    """What the doctor made of a case, and its answer."""
    try:
        answer = case.examine()
    except kl.KinlabError as problem:
        return "refused", problem
    if case.named is None:
        return "right" if answer.agrees else "false alarm", answer
    if answer.agrees:
        return "unnoticed", answer
    if not answer.causes:
        return "part" if answer.partial else "unknown", answer
    kinds = answer.causes[0].kinds
    leading = [c for c in answer.causes if len(c.kinds) == len(kinds)]
    mended = case.repaired is None or case.repaired(answer)
    if mended and case.named(leading[0]):
        return "first", answer
    if mended and any(case.named(c) for c in leading):
        return "tied", answer
    otherwise = len(kinds) <= case.made or {*kinds} == {"coefficient"}
    return ("other" if case.repaired and mended and otherwise else "wrong"), answer


def record(group: str, key: str, number: int, seed: int) -> dict[str, Any]:
    """One case, made, asked and counted; ``made`` is false where nothing could be spoiled."""
    rng = random.Random(f"{seed} {group} {key} {number}")
    make = classes()[group][key]
    case = next(filter(None, (make(rng) for _ in range(DRAWS))), None)
    head = {"group": group, "key": key, "number": number, "made": case is not None}
    if case is None:
        return head
    start = time.process_time()
    verdict, answer = judged(case)
    took = time.process_time() - start
    head |= {"label": case.label, "verdict": verdict, "seconds": took}
    if verdict in MISSED:
        told = [str(answer)[:400]]
        if getattr(answer, "causes", ()):
            told = [c.sentence[:300] for c in answer.causes[:3]]
        head |= {**case.about, "said": told}
    return head


def work(options: argparse.Namespace) -> list[tuple[str, str, int]]:
    """Every case of the run."""
    wanted = []
    for group, makers in classes().items():
        each = options.count if len(makers) == 1 else max(1, round(options.count / 40))
        if group.startswith("misprints"):
            each = 1
        wanted += [(group, key, number) for number in range(each) for key in makers]
    wanted += [("right", "", number) for number in range(options.right // 40)]
    return wanted


def run(options: argparse.Namespace) -> list[dict[str, Any]]:
    """All records, those of an earlier run that was stopped among them."""
    kept: dict[tuple[str, str, int], dict[str, Any]] = {}
    if options.part.exists():
        for line in options.part.read_text(encoding="utf-8").splitlines():
            one = json.loads(line)
            kept[one["group"], one["key"], one["number"]] = one
    wanted = work(options)
    start = time.perf_counter()
    with options.part.open("a", encoding="utf-8") as stream:
        for done, (group, key, number) in enumerate(wanted):
            if done % 25 == 0:
                clock = time.perf_counter() - start
                print(f"{done} of {len(wanted)}, {clock:.0f} s: {group}", flush=True)
            if (group, key, number) in kept:
                continue
            if group == "right":
                begun = time.process_time()
                counts, alarms = right(random.Random(f"{options.seed} right {number}"))
                one = {"group": group, "key": key, "number": number, "made": True, "counts": counts,
                       "alarms": alarms, "seconds": time.process_time() - begun}  # fmt: skip
            else:
                one = record(group, key, number, options.seed)
            kept[group, key, number] = one
            stream.write(json.dumps(one, default=str) + "\n")
            stream.flush()
    return [kept[one] for one in wanted if kept[one]["made"]]


def summary(records: list[dict[str, Any]]) -> dict[str, Any]:
    """Counts by class and by what was done, right formulas, times, misses."""
    groups: dict[str, dict[str, Counter[str]]] = {}
    correct: Counter[str] = Counter()
    alarms: list[str] = []
    for one in records:
        if one["group"] == "right":
            correct.update(one["counts"])
            alarms += one["alarms"]
        else:
            tally = groups.setdefault(one["group"], {}).setdefault(one["label"], Counter())
            tally["cases"] += 1
            tally[one["verdict"]] += 1
    asked = [one for one in records if one["group"] != "right"]
    spent = {}
    for group in groups:
        seconds = [one["seconds"] for one in asked if one["group"] == group]
        spent[group] = {"median": float(np.median(seconds)), "longest": max(seconds)}
    missed = [one for one in asked if one["verdict"] in MISSED]
    # nothing explains it: unknown is the answer, and only what is named is a miss
    fine = [("nothing explains it", verdict) for verdict in ("unknown", "part")]
    missed = [one for one in missed if (one["group"], one["verdict"]) not in fine]
    return {"groups": {g: {k: dict(c) for k, c in t.items()} for g, t in groups.items()},
            "right": dict(correct), "alarms": alarms, "seconds": spent, "missed": missed,
            "all seconds": {"median": float(np.median([one["seconds"] for one in asked])),
                            "longest": max(one["seconds"] for one in asked)}}  # fmt: skip


def row(tally: Counter[str]) -> str:
    """Cases, share named, and each verdict."""
    exact = sum(tally[v] for v in EXACT)
    cells = [tally["tied"], tally["other"], tally["wrong"] + tally["false alarm"],
             *(tally[v] for v in HEADS[4:])]  # fmt: skip
    return f"{tally['cases']} | {exact / tally['cases']:.1%} | " + " | ".join(map(str, cells))


def report(found: dict[str, Any], options: argparse.Namespace, took: float) -> str:
    """The results as Markdown: figures per class, then every miss."""
    asked = f"--count {options.count} --right {options.right} --seed {options.seed}"
    lines = [f"`python scripts/bench/bench_doctor.py {asked}`, {platform.machine()}, "
             f"Python {platform.python_version()}, {took:.0f} s of processor time."]  # fmt: skip
    head = "| {} | cases | " + " | ".join(HEADS) + " |\n" + "|---" * (len(HEADS) + 2) + "|"
    lines += ["", head.format("class")]
    for group, tallies in found["groups"].items():
        total: Counter[str] = Counter()
        for tally in tallies.values():
            total.update(tally)
        lines.append(f"| {group} | {row(total)} |")
    for group, tallies in found["groups"].items():
        if len(tallies) > 1 and not group.startswith(("two", "three")):
            lines += ["", head.format(group)]
            lines += [f"| {k.replace('|', '/')} | {row(Counter(c))} |"
                      for k, c in sorted(tallies.items())]  # fmt: skip
    total_right = sum(found["right"].values())
    lines += ["", "| right formulas | number |", "|---|---|"]
    lines += [f"| {kind} | {count} |" for kind, count in sorted(found["right"].items())]
    lines += ["", f"False alarms: {len(found['alarms'])} in {total_right} right formulas.",
              *(f"- {one}".replace("\n", " ")[:400] for one in found["alarms"])]  # fmt: skip
    lines += ["", "| processor seconds of a diagnosis | median | longest |", "|---|---|---|"]
    lines += [f"| {group} | {s['median']:.2f} | {s['longest']:.2f} |"
              for group, s in found["seconds"].items()]  # fmt: skip
    lines += ["", f"## Missed: {len(found['missed'])}", ""]
    for one in found["missed"]:
        what = " ".join(str(one[k]) for k in ("robot", "entry") if k in one)
        lines.append(f"- {one['group']}, {one['label']} ({what}): **{one['verdict']}**")
        for k in ("right", "is", "misprint"):
            if k in one:
                lines.append(f"  - {k}: `{one[k]}`")
        lines += [f"  - said: {text}".replace("\n", " ") for text in one["said"]]
    return "\n".join(lines) + "\n"


def main() -> None:
    """Runs the bench."""
    parser = argparse.ArgumentParser(description=__doc__.partition("\n")[0])
    parser.add_argument("--count", type=int, default=120, help="cases of each class")
    parser.add_argument("--right", type=int, default=10_000, help="right formulas")
    parser.add_argument("--seed", type=int, default=0)
    parser.add_argument("--out", type=Path, default=Path(__file__).parent / "results")
    parser.add_argument("--part", type=Path, help="what a stopped run goes on from")
    options = parser.parse_args()
    if options.part is None:
        name = f"bench_doctor_{options.count}_{options.right}_{options.seed}.jsonl"
        options.part = Path(tempfile.gettempdir()) / name
    records = run(options)
    found = summary(records)
    text = report(found, options, sum(one["seconds"] for one in records))
    print(text)
    options.out.mkdir(parents=True, exist_ok=True)
    (options.out / "bench_doctor.md").write_text(text, encoding="utf-8")
    (options.out / "bench_doctor.json").write_text(
        json.dumps(found, indent=1, default=str) + "\n", encoding="utf-8"
    )
    options.part.unlink()


if __name__ == "__main__":
    main()
