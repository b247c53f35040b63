"""How often the formula doctor is right: seeded mistakes, false alarms, times.

Mistakes are made by :mod:`mutants` (slips in formulas, on Python's syntax tree) and
:mod:`confusions` (answers of somebody who is confused), neither of which knows the doctor's own
lists. A mutant whose values are the original's is no mistake and is left out, with a count.

*exact*: the first cause names the class of the mistake, or one of the causes of equal length
does that repair the same formula (counted apart as *tied*), and a repaired text agrees with the
right one to 1e-9 at random parameters. *wrong*: a cause is given, and none of the leading ones
is the mistake. *unknown*: no cause. Writes results/bench_doctor.json and .md.
"""

from __future__ import annotations

import argparse
import json
import platform
import random
import tempfile
import time
from collections import Counter
from collections.abc import Iterator
from dataclasses import asdict, dataclass, field
from pathlib import Path
from typing import Any

import numpy as np
import sympy
from confusions import CONFUSIONS, plain, random_arm
from mutants import RULES, every, mutate, rewritten, value

import kinlab as kl
from kinlab import symbolic
from kinlab.doctor.file import examine_file
from kinlab.symbolic.kinematics import jacobian as symbolic_jacobian

ROBOTS = ("single_link", "planar2r", "planar2r_rods", "planar3r", "spatial3r", "scara", "stanford")
CONFUSED = ("planar2r", "spatial3r", "scara", "stanford", "puma560", "panda", "ur5")
DERIVED = {
    "fk": symbolic.fk, "jacobian": symbolic_jacobian,
    "jacobian_tool": lambda a: symbolic_jacobian(a, "tool"),
    "jacobian_spatial": lambda a: symbolic_jacobian(a, "spatial"),
    "mass_matrix": symbolic.mass_matrix, "coriolis_matrix": symbolic.coriolis_matrix,
    "coriolis_torques": lambda a: symbolic.coriolis_matrix(a) * sympy.Matrix(a.qd),
    "gravity_torques": symbolic.gravity_torques, "inverse_dynamics": symbolic.inverse_dynamics,
    "kinetic_energy": symbolic.kinetic_energy, "potential_energy": symbolic.potential_energy,
}  # fmt: skip
KINEMATIC = ("fk", "jacobian", "jacobian_tool", "jacobian_spatial")
NAMES = {
    "sign": ("sign", "row sign"), "factor 2 or 1/2": ("factor", "coefficient", "row half"),
    "missing term": ("missing term",), "doubled term": ("extra term", "factor", "coefficient"),
    "extra term": ("extra term", "coefficient"), "power": ("power",), "sin/cos": ("sin/cos",),
    "wrong argument": ("argument",), "velocity for acceleration": ("velocity for acceleration",),
    "wrong index": ("index",), "missing factor": ("missing factor",),
}  # fmt: skip
"""Kinds of the doctor that name a class. By values alone a term twice is a coefficient."""
ADDED = ("doubled term", "extra term")


@dataclass
class Tally:
    """One class of mistake."""

    total: int = 0
    first: int = 0
    tied: int = 0
    repaired: int = 0
    wrong: int = 0
    unknown: int = 0

    def row(self) -> str:
        """A row of the table."""
        share = 100 * (self.first + self.tied) / max(self.total, 1)
        return (f"{self.total} | {share:.1f} % | {self.first} | {self.tied} | {self.repaired} | "
                f"{self.wrong} | {self.unknown}")  # fmt: skip

    def plus(self, other: Tally) -> Tally:
        """The sum of two."""
        return Tally(*(a + b for a, b in zip(asdict(self).values(), asdict(other).values(),
                                             strict=True)))  # fmt: skip


@dataclass
class Formula:
    """A correct entry of one robot as text."""

    robot: str
    quantity: str
    index: tuple[int, ...]
    text: str
    names: list[str]
    parameters: dict[str, float]
    others: list[str]

    @property
    def entry(self) -> str:
        """Its name in a file."""
        return f"{self.quantity}[{','.join(map(str, self.index))}]" if self.index else self.quantity


@dataclass
class Bench:
    """What was counted."""

    text: dict[str, Tally] = field(default_factory=dict)
    function: dict[str, Tally] = field(default_factory=dict)
    readings: dict[str, Tally] = field(default_factory=dict)
    double: dict[str, Tally] = field(default_factory=dict)
    seconds: dict[str, list[float]] = field(default_factory=dict)
    equal: int = 0
    merged: int = 0
    undetected: int = 0
    missed: list[dict[str, Any]] = field(default_factory=list)


def formulas(rng: random.Random) -> list[Formula]:
    """Every entry of the derived quantities with two terms or more, in three forms."""
    found = []
    for robot in ROBOTS:
        table = kl.load(robot).table
        arm = symbolic.arm(table)
        for quantity, derive in DERIVED.items():
            if table.n > 3 and quantity not in KINEMATIC:
                continue
            derived = derive(arm)
            whole = derived if isinstance(derived, sympy.MatrixBase) else sympy.Matrix([[derived]])
            vector = quantity.endswith(("torques", "dynamics"))
            entries = {(r, c): sympy.expand(whole[r, c])
                       for r in range(whole.rows) for c in range(whole.cols)}  # fmt: skip
            letters = {"a": "qdd", "v": "qd", "q": "q"}
            used = _arguments(quantity)
            joints = [f"{letters[x]}{i + 1}" for x in used for i in range(table.n)]
            for (r, c), entry in entries.items():
                if not 2 <= len(sympy.Add.make_args(entry)) <= 60:
                    continue
                index = () if whole is not derived else (r,) if vector else (r, c)
                others = [str(t) for other in entries.values() if other != entry
                          for t in sympy.Add.make_args(other)
                          if t != 0 and t not in entry.args and -t not in entry.args]  # fmt: skip
                rates = [sympy.Symbol(n) for n in joints if n.startswith("qd")]
                forms = [entry, sympy.collect(entry, rates), sympy.factor_terms(entry)]
                for form in dict.fromkeys(map(str, forms)):
                    found.append(Formula(robot, quantity, index, form, [*arm.values, *joints],
                                         dict(arm.values), others[:20]))  # fmt: skip
    rng.shuffle(found)
    return found


def _arguments(quantity: str) -> str:
    if quantity == "inverse_dynamics":
        return "qva"
    return "qv" if quantity.startswith(("coriolis", "kinetic")) else "q"


def points(formula: Formula, numbers: bool, count: int = 100) -> dict[str, Any]:
    """Random values of all names; the robot's own numbers, or any."""
    draw = np.random.default_rng(77)
    return {name: np.full(count, formula.parameters[name])
            if numbers and name in formula.parameters else draw.uniform(0.3, 2.3, count)
            for name in formula.names}  # fmt: skip


def differs(formula: Formula, one: str, numbers: bool) -> bool:
    """Whether a text differs from the right one, by value."""
    at = points(formula, numbers)
    right = value(formula.text, at)
    return bool(np.max(np.abs(value(one, at) - right)) > 1e-9 * np.max(np.abs(right)))


def merged(formula: Formula, bad: str) -> bool:
    """Whether two slips are one by value: a multiple of one term, or what one slip makes too."""
    at = points(formula, False)
    right = value(formula.text, at)
    gap = value(bad, at) - right
    size = np.max(np.abs(right))
    expanded = sympy.expand(sympy.sympify(formula.text))
    added = [f"({t})" for t in (formula.text, *expanded.args, *formula.others)]
    for term in added:
        ratio = gap / value(term, at)
        if np.ptp(ratio) <= 1e-9 * (1.0 + np.max(np.abs(ratio))):
            return True
    singles = (one for rule in RULES for one in every(formula.text, rule, formula.names))
    return any(np.max(np.abs(value(one, at) - right - gap)) <= 1e-9 * size for one in singles)


def by_text(formula: Formula, text: str, folder: Path) -> Any:
    """The diagnosis of a text."""
    file = folder / "f.toml"
    head = f'robot = "{formula.robot}"\n[formulas]\n'
    file.write_text(f'{head}"{formula.entry}" = "{text}"\n', encoding="utf-8")
    return examine_file(file, samples=60)[0]


def by_function(formula: Formula, text: str) -> Any:
    """The diagnosis of a function with one mistaken entry."""
    robot = kl.load(formula.robot)
    letters = {"q": "q", "v": "qd", "a": "qdd"}

    def hand(*state: Any) -> Any:
        at: dict[str, Any] = dict(formula.parameters)
        for letter, x in zip(_arguments(formula.quantity), state, strict=True):
            at |= {f"{letters[letter]}{i + 1}": x[i] for i in range(len(x))}
        wrong = value(text, at)
        if not formula.index:
            return wrong
        name = formula.quantity
        if name.startswith("jacobian_"):
            out = np.array(kl.jacobian(robot, *state, name.removeprefix("jacobian_")))
        else:
            out = np.array(plain(name)(robot, *state))
        out[formula.index] = wrong
        return out

    return kl.diagnose(robot, formula.quantity, hand, samples=200)


def judge(tally: Tally, answer: Any, classes: list[tuple[str, ...]], right: bool) -> str:
    """Counts one diagnosis; ``right``: the repaired formula is the true one."""
    tally.total += 1
    if not answer.causes:
        tally.unknown += 1
        return "unknown"
    tally.repaired += right
    shortest = len(answer.causes[0].kinds)
    leading = [c for c in answer.causes if len(c.kinds) == shortest]
    if right and _named(leading[0].kinds, classes):
        tally.first += 1
        return "first"
    if right and any(_named(c.kinds, classes) for c in leading):
        tally.tied += 1
        return "tied"
    tally.wrong += 1
    return "wrong"


def _named(kinds: tuple[str, ...], classes: list[tuple[str, ...]]) -> bool:
    """Whether the kinds are one of each class, in any order."""
    if len(kinds) != len(classes):
        return False
    if not classes:
        return True
    return any(kinds[0] in one and _named(kinds[1:], classes[:k] + classes[k + 1 :])
               for k, one in enumerate(classes))  # fmt: skip


def repaired(formula: Formula, answer: Any) -> bool:
    """Whether every leading cause's corrected text is the right one, at random parameters."""
    if not answer.causes:
        return False
    texts = [c.corrected[formula.entry] for c in answer.causes if formula.entry in c.corrected]
    return not any(differs(formula, text, False) for text in texts)


def slips(bench: Bench, pool: list[Formula], count: int, rng: random.Random, folder: Path) -> None:
    """One and two slips of the pen, as text and as function."""
    for number, formula in enumerate(pool[:count]):
        progress("slips", number, count)
        rules = [*RULES, "extra term"]
        for form, tallies in (("text", bench.text), ("function", bench.function)):
            rule = rng.choice(rules)
            bad = mutate(formula.text, rule, formula.names, formula.others, rng)
            if bad is None:
                continue
            one_slip(bench, tallies, formula, form, [rule], bad, folder)
        # what is added comes last: a slip in an added term would be one mistake, not two
        rule, other = sorted((rng.choice(rules), rng.choice(rules)), key=ADDED.__contains__)
        first = mutate(formula.text, rule, formula.names, formula.others, rng)
        bad = first and mutate(first, other, formula.names, formula.others, rng)
        form = rng.choice(["text", "function"])
        if bad and merged(formula, bad):
            bench.merged += 1
        elif bad:
            one_slip(bench, bench.double, formula, form, [rule, other], bad, folder)


def one_slip(bench: Bench, tallies: dict[str, Tally], formula: Formula, form: str,
             rules: list[str], bad: str, folder: Path) -> None:  # fmt: skip
    """One mutant, diagnosed and counted."""
    if not differs(formula, bad, form == "function"):
        bench.equal += 1
        return
    start = time.perf_counter()
    answer = by_text(formula, bad, folder) if form == "text" else by_function(formula, bad)
    spent(bench, kl.load(formula.robot).n, answer, start)
    bench.undetected += answer.agrees
    key = rules[0] if len(rules) == 1 else f"two slips, {form}"
    verdict = judge(tallies.setdefault(key, Tally()), answer, [NAMES[r] for r in rules],
                    repaired(formula, answer))  # fmt: skip
    if verdict in ("wrong", "unknown"):
        bench.missed.append({
            "form": form, "classes": rules, "robot": formula.robot, "entry": formula.entry,
            "right": formula.text, "mutant": bad, "verdict": verdict,
            "said": [[*c.kinds, c.sentence[:200]] for c in answer.causes[:3]],
        })  # fmt: skip


def confused(bench: Bench, count: int, rng: random.Random) -> None:
    """Every confusion on shipped and random arms."""
    for number in range(count):
        progress("confusions", number, count)
        arm = (kl.load(rng.choice(CONFUSED)) if rng.random() < 0.5
               else random_arm(rng, rng.choice([2, 3, 4, 6])))  # fmt: skip
        for name, (make, kinds) in CONFUSIONS.items():
            made = make(arm, rng)
            if made is None or same(arm, *made):
                bench.equal += made is not None
                continue
            start = time.perf_counter()
            answer = kl.diagnose(arm, *made, samples=40)
            spent(bench, arm.n, answer, start)
            bench.undetected += answer.agrees
            tally = bench.readings.setdefault(name, Tally())
            verdict = judge(tally, answer, [kinds], bool(answer.causes))
            if verdict in ("wrong", "unknown"):
                bench.missed.append({
                    "form": "reading", "classes": [name], "robot": arm.name, "entry": made[0],
                    "verdict": verdict, "said": [[*c.kinds, c.sentence] for c in answer.causes[:3]],
                })  # fmt: skip


def same(arm: Any, quantity: str, function: Any) -> bool:
    """Whether the confusion changes nothing on this arm."""
    draw = np.random.default_rng(3)
    for _ in range(5):
        arguments = {"q": arm.n, "v": arm.n, "a": arm.n, "w": 6}
        letters = "qw" if quantity == "statics" else _arguments(quantity)
        state = [draw.uniform(-1, 1, arguments[x]) for x in letters]
        if quantity.startswith("jacobian_"):
            right = kl.jacobian(arm, *state, quantity.removeprefix("jacobian_"))
        else:
            right = plain(quantity)(arm, *state)
        wrong = np.asarray(function(*state))
        if wrong.shape != right.shape:
            return False
        if np.max(np.abs(wrong - right)) > 1e-9 * (np.max(np.abs(right)) or 1.0):
            return False
    return True


def spent(bench: Bench, joints: int, answer: Any, start: float) -> None:
    """Books the time of one diagnosis by the size of the arm."""
    kind = "named" if answer.causes else "unknown"
    bench.seconds.setdefault(f"{joints} joints, {kind}", []).append(time.perf_counter() - start)


def unexplained(bench: Bench) -> None:
    """Functions that nothing explains, for the time that the doctor takes to give up."""
    for name in (*ROBOTS, "puma560", "ur5"):
        arm = kl.load(name)
        for quantity in ("fk", "jacobian", "gravity_torques", "mass_matrix", "inverse_dynamics"):
            function = plain(quantity)
            start = time.perf_counter()
            answer = kl.diagnose(arm, quantity, lambda *s, f=function, r=arm: f(r, *s)
                                 + np.tanh(s[0][0] * s[0][-1] + 0.3))  # fmt: skip
            spent(bench, arm.n, answer, start)
            if answer.causes:
                said = [[c.sentence] for c in answer.causes[:3]]
                bench.missed.append({"form": "nothing fits", "robot": name, "entry": quantity,
                                     "said": said})  # fmt: skip


def alarms(pool: list[Formula], wanted: int, rng: random.Random, folder: Path) -> tuple[int, int]:
    """Comparisons of correct formulas in other forms, and how many were called wrong."""
    by_robot: dict[str, list[Formula]] = {}
    for formula in pool:
        by_robot.setdefault(formula.robot, []).append(formula)
    compared = wrong = 0
    for formulas_ in cycle(by_robot):
        if compared >= wanted:
            break
        progress("correct formulas", compared, wanted)
        chosen = {f.entry: f for f in rng.sample(formulas_, min(60, len(formulas_)))}
        lines = [f'robot = "{formulas_[0].robot}"', "[formulas]"]
        lines += [f'"{entry}" = "{another_form(f, rng)}"' for entry, f in chosen.items()]
        file = folder / "right.toml"
        file.write_text("\n".join(lines) + "\n", encoding="utf-8")
        for answer in examine_file(file, samples=40, seed=compared):
            count = answer.function.count(", ") + 1
            compared += count
            wrong += 0 if answer.agrees else 1
            if not answer.agrees:
                print("FALSE ALARM", answer, file.read_text(encoding="utf-8")[:2000])
    return compared, wrong


def cycle(by_robot: dict[str, list[Formula]]) -> Iterator[list[Formula]]:
    """The robots in turn, for ever."""
    while True:
        yield from by_robot.values()


def another_form(formula: Formula, rng: random.Random) -> str:
    """sympy's other forms at times, and always a shuffle with identities."""
    text = formula.text
    if rng.random() < 0.1 and len(text) < 300:
        names = {n: sympy.Symbol(n) for n in formula.names}
        change = rng.choice([sympy.factor, sympy.expand_trig, sympy.trigsimp, sympy.simplify])
        text = str(change(sympy.sympify(text, locals=names)))
    return rewritten(text, rng)


def progress(what: str, done: int, of: int) -> None:
    """One line that moves."""
    if done % max(1, of // 20) == 0:
        print(f"{what}: {done} of {of}", flush=True)


def summed(tallies: dict[str, Tally]) -> Tally:
    """All classes together."""
    total = Tally()
    for tally in tallies.values():
        total = total.plus(tally)
    return total


def report(bench: Bench, compared: int, false: int, options: Any, took: float) -> str:
    """The results as Markdown."""
    head = (
        "| {} | mutants | exact | first | tied | repaired | wrong | unknown |\n" + "|---" * 8 + "|"
    )
    asked = f"--count {options.count} --rounds {options.rounds} --seed {options.seed}"
    lines = [f"`python scripts/bench/bench_doctor.py {asked}`, {platform.machine()}, "
             f"Python {platform.python_version()}, {took:.0f} s."]  # fmt: skip
    single = summed({"t": summed(bench.text), "f": summed(bench.function),
                     "r": summed(bench.readings)})  # fmt: skip
    lines += ["", head.format("all"), f"| single mistakes | {single.row()} |",
              f"| two mistakes | {summed(bench.double).row()} |"]  # fmt: skip
    for title, tallies in (("slip, as text", bench.text), ("slip, as function", bench.function),
                           ("confusion, as function", bench.readings),
                           ("two mistakes", bench.double)):  # fmt: skip
        lines += ["", head.format(title)]
        lines += [f"| {name} | {tally.row()} |" for name, tally in sorted(tallies.items())]
        lines.append(f"| **sum** | {summed(tallies).row()} |")
    lines += ["", f"False alarms: {false} in {compared} comparisons of correct formulas.",
              f"Mutants equal to the original, left out: {bench.equal}. Pairs of slips that are "
              f"one by value, left out: {bench.merged}. Mutants not noticed: {bench.undetected}.",
              "", "| diagnosis | count | median s | longest s |", "|---|---|---|---|"]  # fmt: skip
    lines += [f"| {name} | {len(s)} | {np.median(s):.2f} | {max(s):.2f} |"
              for name, s in sorted(bench.seconds.items())]  # fmt: skip
    return "\n".join(lines) + "\n"


def main() -> None:
    """Runs the bench."""
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--count", type=int, default=200, help="formulas that are mutated")
    parser.add_argument("--rounds", type=int, default=8, help="arms that are confused")
    parser.add_argument("--correct", type=int, default=10_000, help="correct comparisons")
    parser.add_argument("--seed", type=int, default=0)
    parser.add_argument("--out", type=Path, default=Path(__file__).parent / "results")
    options = parser.parse_args()
    rng = random.Random(options.seed)
    start = time.perf_counter()
    pool = formulas(rng)
    print(f"{len(pool)} formulas of {len({f.robot for f in pool})} robots and "
          f"{len({f.quantity for f in pool})} quantities")  # fmt: skip
    bench = Bench()
    with tempfile.TemporaryDirectory() as folder:
        slips(bench, pool, options.count, rng, Path(folder))
        confused(bench, options.rounds, rng)
        unexplained(bench)
        compared, false = alarms(pool, options.correct, rng, Path(folder))
    text = report(bench, compared, false, options, time.perf_counter() - start)
    print(text)
    options.out.mkdir(parents=True, exist_ok=True)
    (options.out / "bench_doctor.md").write_text(text, encoding="utf-8")
    kept = {**asdict(bench), "compared": compared, "false_alarms": false}
    kept["seconds"] = {k: {"count": len(v), "longest": max(v)} for k, v in bench.seconds.items()}
    kept["kinds"] = dict(Counter(m.get("verdict", "given") for m in bench.missed))
    (options.out / "bench_doctor.json").write_text(
        json.dumps(kept, indent=1, default=str) + "\n", encoding="utf-8"
    )


if __name__ == "__main__":
    main()
