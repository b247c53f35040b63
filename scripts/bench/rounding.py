"""Whether the doctor says the same under rounding: its bench and the notes' misprints, shaken.

Every value of the engine and of the hand formula is multiplied by 1 + 1e-15 times a random
number; verdict, sentences, kinds and their order must stay, numbers in them to their printed
digits. ``python scripts/bench/rounding.py`` runs the whole bench of ``bench_doctor.py`` with
20 seeds (hours); ``tests/doctor/test_rounding.py`` runs a part of it.
"""

from __future__ import annotations

import argparse
import random
import re
import sys
from collections.abc import Callable, Iterator
from contextlib import contextmanager
from typing import Any

import numpy as np
from bench_doctor_cases import CONFUSED, ROBOTS, same
from bench_doctor_cases import slips as bench_slips
from confusions import CONFUSIONS, random_arm

import kinlab as kl
from kinlab.check.catalogue import catalogue
from kinlab.check.quantities.serial import SERIAL
from kinlab.doctor import examine
from kinlab.doctor.changes import Case

SIZE = 1e-15
DIGITS = 1e-9
"""One unit in the last of the ten digits that a sentence prints, relative."""
NUMBER = re.compile(r"(?<![\w.])\d+(?:\.\d+)?(?:e[+-]?\d+)?")

Judged = tuple[str, Callable[[], Any]]
"""A label, and what makes the diagnosis."""


@contextmanager
def shaken(seed: int) -> Iterator[None]:
    """Every answer of the engine and of the hand formula, rounded a little differently."""
    rng = np.random.default_rng(seed)
    engine, read = Case.engine, examine._read

    def moved(values: Any) -> Any:
        return values * (1.0 + SIZE * rng.standard_normal(np.shape(values)))

    Case.engine = lambda self, *which: moved(engine(self, *which))
    examine._read = lambda *given: moved(read(*given))
    try:
        yield
    finally:
        Case.engine, examine._read = engine, read


def said(found: Any) -> list[str]:
    """What a diagnosis tells, in order."""
    causes = [f"{cause.kinds} {cause.places} {cause.sentence}" for cause in found.causes]
    return [found.verdict, found.sentence, *causes, *found.partial]


def alike(one: list[str], two: list[str]) -> bool:
    """Equal words in equal order, and numbers equal to their printed digits."""
    if len(one) != len(two):
        return False
    for left, right in zip(one, two, strict=True):
        if NUMBER.sub("#", left) != NUMBER.sub("#", right):
            return False
        pairs = zip(NUMBER.findall(left), NUMBER.findall(right), strict=True)
        if any(abs(float(a) - float(b)) > DIGITS * abs(float(a)) for a, b in pairs):
            return False
    return True


def changes(judged: list[Judged], seeds: range) -> list[str]:
    """Each diagnosis that is told differently under one of the seeds, with both tellings."""
    found = []
    for number, (label, make) in enumerate(judged):
        plain = said(make())
        for seed in seeds:
            with shaken(1000 * number + seed):
                other = said(make())
            if not alike(plain, other):
                found.append("\n  ".join([f"{label}, seed {seed}:", *plain, "became", *other]))
                break
    return found


def misprints(chosen: set[tuple[str, str]] | None = None, samples: int = 60) -> list[Judged]:
    """The printed forms of the notes as plain functions.

    Args:
        chosen: keys and robots; without it every misprint on the first robot that shows it.
        samples: states of each diagnosis.
    """
    found: list[Judged] = []
    for row in catalogue():
        quantity = examine.find_quantity(row.quantity)
        if row.printed is None or quantity.domain is not SERIAL:
            continue
        names = [one for name in (row.printed.robots or row.robots)
                 for one in SERIAL.members(name)]  # fmt: skip
        for name in names[:1] if chosen is None else names:
            if chosen is None or (row.key, name) in chosen:
                found.append((f"{row.key} {name}", _printed(row, SERIAL.load(name), samples)))
    return found


def _printed(row: Any, robot: Any, samples: int) -> Callable[[], Any]:
    arm = SERIAL.numbers(robot)
    return lambda: kl.diagnose(
        robot, row.quantity, lambda *state: row.printed.function(arm, *state), samples=samples
    )


def slips(count: int, seed: int, robots: tuple[str, ...] = ROBOTS) -> list[Judged]:
    """The bench's slips of the pen, one and two, as texts and as functions."""
    found: list[Judged] = []
    for form in ("text", "function"):
        for many in (1, 2):
            for number in range(count):
                rng = random.Random(f"{seed} {form} {many} {number}")
                case = bench_slips(many, form)(rng, robots)
                if case is not None:
                    about = case.about
                    label = f"{about['robot']} {about['entry']} {form} {case.label}"
                    found.append((label, case.examine))
    return found


def confusions(rounds: int, seed: int, robots: tuple[str, ...] = ()) -> list[Judged]:
    """The bench's confusions, on shipped and random arms."""
    rng = random.Random(seed)
    found: list[Judged] = []
    for _ in range(rounds):
        shipped = robots or rng.random() < 0.5
        arm = (kl.load(rng.choice(robots or CONFUSED)) if shipped
               else random_arm(rng, rng.choice([2, 3, 4, 6])))  # fmt: skip
        for name, (make, _) in CONFUSIONS.items():
            made = make(arm, rng)
            if made is not None and not same(arm, *made):
                found.append((f"{arm.name} {made[0]} {name}", _confused(arm, *made)))
    return found


def _confused(arm: Any, quantity: str, function: Any) -> Callable[[], Any]:
    return lambda: kl.diagnose(arm, quantity, function, samples=40)


def main() -> None:
    """Runs the whole bench."""
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--count", type=int, default=200, help="formulas that are mutated")
    parser.add_argument("--rounds", type=int, default=8, help="arms that are confused")
    parser.add_argument("--seeds", type=int, default=20)
    parser.add_argument("--seed", type=int, default=0, help="of the bench")
    options = parser.parse_args()
    judged = misprints() + confusions(options.rounds, options.seed)
    judged += slips(options.count, options.seed)
    changed = []
    for k, one in enumerate(judged):
        changed += changes([one], range(options.seeds))
        print(f"{k + 1} of {len(judged)}, {len(changed)} changed", flush=True)
    print("\n".join(changed))
    print(f"{len(judged)} diagnoses, {options.seeds} seeds: {len(changed)} told differently")
    sys.exit(bool(changed))


if __name__ == "__main__":
    main()
