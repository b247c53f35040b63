"""How often the formula doctor is right: seeded mistakes in derived formulas and in functions.

The mistakes are made on the text of formulas by rules of this file, not by the doctor's own list.
A single mistake counts as named when the first cause restores the entry (text) or states the
reading that was applied (function); it counts as named wrongly when a cause is given that does
neither. Prints one line per class.
"""

from __future__ import annotations

import argparse
import random
import re
import tempfile
import time
from collections import Counter
from pathlib import Path

import numpy as np

import kinlab as kl
from kinlab.doctor.derived import derivation
from kinlab.doctor.file import examine_file

ROBOTS = ("single_link", "planar2r", "planar2r_rods", "planar3r", "spatial3r", "scara")
QUANTITIES = ("fk", "planar_pose", "planar_jacobian", "jacobian", "mass_matrix", "coriolis_matrix",
              "coriolis_torques", "gravity_torques", "inverse_dynamics", "kinetic_energy",
              "potential_energy")  # fmt: skip
OTHER = {"sin": "cos", "cos": "sin"}


def places(pattern: str, text: str) -> list[re.Match[str]]:
    """Every place of a pattern."""
    return list(re.finditer(pattern, text))


def put(text: str, at: re.Match[str], new: str) -> str:
    """The text with one match replaced."""
    return text[: at.start()] + new + text[at.end() :]


def outer_terms(text: str) -> list[str]:
    """The terms of the outermost sum, signs with them."""
    terms, depth = [""], 0
    for piece in re.split(r"( (?=[+-] )|[()])", text):
        depth += {"(": 1, ")": -1}.get(piece, 0)
        if piece == " " and depth == 0:
            terms.append("")
        else:
            terms[-1] += piece
    return terms


def mistakes(text: str, rng: random.Random) -> dict[str, str]:
    """One mistaken text per class that fits."""
    made: dict[str, str] = {}
    rules = {
        "sign": (r" [+-] ", lambda m: " - " if m.group() == " + " else " + "),
        "sin/cos": (r"\b(sin|cos)(?=\()", lambda m: OTHER[m.group()]),
        "argument": (r"\(q1 \+ q2\)|\(q2 \+ q3\)", lambda m: f"({m.group()[-3:-1]})"),
        "power": (r"(?<=[a-z]\d)\*\*2", lambda m: ""),
        "power up": (r"\bl[12]\b(?!\*\*)", lambda m: f"{m.group()}**2"),
        "index": (r"\b[ml]([12])\b", lambda m: f"{m.group()[0]}{3 - int(m.group(1))}"),
        "velocity for acceleration": (r"\bqdd", lambda m: "qd"),
        "missing factor": (r"\b[ml]\d\*(?!\*)", lambda m: ""),
        "half": (r"(?<!\*)\b2\*(?=[a-z])", lambda m: ""),
    }
    for name, (pattern, change) in rules.items():
        found = places(pattern, text)
        if found:
            at = rng.choice(found)
            made[name] = put(text, at, change(at))
    terms = outer_terms(text)
    if len(terms) > 1:
        k = rng.randrange(1, len(terms))
        made["missing term"] = " ".join(terms[:k] + terms[k + 1 :])
        made["term twice"] = f"{text} {terms[k]}"
    return made


def formulas() -> list[tuple[str, str, str]]:
    """(robot, entry, text) of every entry that is long enough to be got wrong."""
    out = []
    for robot in ROBOTS:
        for quantity in QUANTITIES:
            derived = derivation(kl.load(robot).table, quantity)
            if derived is None:
                continue
            for index in np.ndindex(derived.polys.shape):
                poly = derived.polys[index] if index else derived.polys.item()
                if 1 < len(poly) <= 60:
                    label = f"{quantity}[{','.join(map(str, index))}]" if index else quantity
                    for form in (derived.tree(poly), derived.collected(poly)):
                        out.append((robot, label, str(form)))
    return out


def judge(robot: str, entry: str, text: str, folder: Path):
    """The doctor's answer to one text."""
    file = folder / "f.toml"
    file.write_text(f'robot = "{robot}"\n[formulas]\n"{entry}" = "{text}"\n', encoding="utf-8")
    return examine_file(file, samples=40)[0]


def main() -> None:
    """Runs the bench."""
    options = argparse.ArgumentParser(description=__doc__)
    options.add_argument("--count", type=int, default=150)
    options.add_argument("--seconds", type=float, default=100.0)
    options.add_argument("--seed", type=int, default=0)
    chosen = options.parse_args()
    rng = random.Random(chosen.seed)
    pool = formulas()
    rng.shuffle(pool)
    named, wrong, total, slowest = Counter(), Counter(), Counter(), 0.0
    false_alarms = compared = 0
    start = time.perf_counter()
    with tempfile.TemporaryDirectory() as folder:
        for robot, entry, text in pool[: chosen.count]:
            if time.perf_counter() - start > chosen.seconds:
                break
            compared += 1
            false_alarms += not judge(robot, entry, text, Path(folder)).agrees
            singles = mistakes(text, rng)
            cases = [(name, bad) for name, bad in singles.items()]
            first = rng.choice(list(singles.values())) if singles else text
            second = mistakes(first, rng)
            if second:
                cases.append(("two mistakes", rng.choice(list(second.values()))))
            for name, bad in cases:
                began = time.perf_counter()
                try:
                    answer = judge(robot, entry, bad, Path(folder))
                except kl.KinlabError:  # a name that this robot does not have is refused
                    continue
                slowest = max(slowest, time.perf_counter() - began)
                if answer.agrees:
                    continue  # the mistake changed nothing
                total[name] += 1
                repaired = next(
                    (c.corrected.get(entry) for c in answer.causes if c.corrected), None
                )
                if repaired and judge(robot, entry, repaired, Path(folder)).agrees:
                    named[name] += 1
                elif answer.causes and not repaired:
                    wrong[name] += 1
    for name in total:
        print(f"{name:28s} {named[name]:4d} of {total[name]:4d} named, {wrong[name]} as a reading")
    single = [n for n in total if n != "two mistakes"]
    count = sum(total[n] for n in single)
    print(f"single: {sum(named[n] for n in single)} of {count}; "
          f"reading only {sum(wrong[n] for n in single)}")  # fmt: skip
    print(f"false alarms {false_alarms} of {compared}; slowest diagnosis {slowest:.2f} s")


if __name__ == "__main__":
    main()
