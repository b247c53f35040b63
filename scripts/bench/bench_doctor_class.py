"""A class marked: how long it takes, whether order and stops matter, and whether anything leaks.

``python scripts/bench/bench_doctor_class.py --students 200 --seed 1`` makes a class (five
questions about the planar arm; TOML, LaTeX and text; right in many forms, one slip, two slips,
unreadable, missing, and every twentieth file hostile), and then

* marks it with ``kinlab mark`` in a process of its own: clock and processor seconds;
* stops a second run by Ctrl-C in its middle, goes on, and compares marks.csv byte by byte;
* marks it once more from a shuffled list of files with one worker, and compares the marks;
* counts right answers with less than full points, and wrong ones with full points;
* marks it at ``place`` and at ``cause`` and evaluates everything in the written files that can
  be read as a formula, in all its parts, beside the model answers (``--leaks``).

The truth of an answer is this file's arithmetic (:mod:`mutants`), not the doctor's.
"""

from __future__ import annotations

import argparse
import ast
import csv
import html
import json
import os
import random
import re
import resource
import signal
import subprocess
import sys
import time
from collections import Counter
from collections.abc import Iterable, Iterator
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import numpy as np
from lxml import etree
from mutants import RULES, mutate, rewritten, value

import kinlab as kl
from kinlab.formulas import tree
from kinlab.formulas.text import parse
from kinlab.formulas.typed import plain_formula

SHEET = """
title = "The planar arm"
robot = "planar2r"
feedback = "{feedback}"

[slips]
sign = 0.25
factor = 0.25

[[questions]]
id = "q1"
text = "The x coordinate of the tool."
entry = "x"
points = 2

[[questions]]
id = "q2"
text = "The velocity of the tool along x."
entry = "v"
answer = "-(l1*sin(q1) + l2*sin(q1 + q2))*qd1 - l2*sin(q1 + q2)*qd2"
points = 2

[[questions]]
id = "q3"
text = "The mass matrix."
quantity = "mass_matrix"
points = 3

[[questions]]
id = "q4"
text = "The torque of joint 1."
entry = "tau1"
points = 4

[[questions]]
id = "q5"
text = "The torque of gravity at joint 1."
entry = "g1"
points = 1
"""
NAMES = {"m1": 2.0, "m2": 1.5, "l1": 0.5, "l2": 0.4, "g": 9.81}
JOINTS = ["q1", "q2", "qd1", "qd2", "qdd1", "qdd2"]
M11 = "(m1 + m2)*l1**2 + m2*l2**2 + 2*m2*l1*l2*cos(q2)"
M12 = "m2*l2**2 + m2*l1*l2*cos(q2)"
G1 = "(m1 + m2)*g*l1*cos(q1) + m2*g*l2*cos(q1 + q2)"
TRUTH = {
    "q1": ["l1*cos(q1) + l2*cos(q1 + q2)"],
    "q2": ["-(l1*sin(q1) + l2*sin(q1 + q2))*qd1 - l2*sin(q1 + q2)*qd2"],
    "q3": [M11, M12, M12, "m2*l2**2"],
    "q4": [f"({M11})*qdd1 + ({M12})*qdd2 - m2*l1*l2*sin(q2)*(2*qd1*qd2 + qd2**2) + {G1}"],
    "q5": [G1],
}
LEFT = {"q1": "x", "q2": "v", "q3": "M", "q4": "tau_1", "q5": "g_1"}
KINDS = ["right"] * 8 + ["one slip"] * 6 + ["two slips"] * 3 + ["unreadable", "missing"]


@dataclass
class Answer:
    """One answer of the class: what it is, and how it is written."""

    kind: str
    texts: list[str]


def at_random(seed: int, numbers: bool) -> dict[str, np.ndarray]:
    """Twelve states; the robot's own numbers, or any."""
    draw = np.random.default_rng(seed)
    at = {name: draw.uniform(0.3, 2.3, 12) * draw.choice([-1, 1], 12) for name in JOINTS}
    for name, number in NAMES.items():
        at[name] = np.full(12, number) if numbers else draw.uniform(0.4, 2.4, 12)
    return at


def same(one: str, other: str, numbers: bool) -> bool:
    """Whether two formulas have the same values."""
    at = at_random(5, numbers)
    a, b = value(one, at), value(other, at)
    return bool(np.max(np.abs(a - b)) <= 1e-9 * max(1e-300, float(np.max(np.abs(b)))))


def answer(question: str, rng: random.Random) -> Answer:
    """One answer of a random kind."""
    texts = list(TRUTH[question])
    kind = rng.choice(KINDS)
    if kind in ("missing", "unreadable"):
        broken = [texts[0] + ")", "???", texts[0].replace("*", " mal ", 1), "\\frac{1}{"]
        return Answer(kind, [] if kind == "missing" else [rng.choice(broken)])
    where = rng.randrange(len(texts))
    if kind != "right":
        for _ in range(200):
            bad: str | None = texts[where]
            for _slip in range(1 if kind == "one slip" else 2):
                bad = bad and mutate(bad, rng.choice([*RULES]), [*NAMES, *JOINTS], [], rng)
            if bad and not same(bad, texts[where], True):
                texts[where] = bad
                break
        else:
            kind = "right"
    return Answer(kind, [rewritten(t, rng) if rng.random() < 0.7 else t for t in texts])


# -------- How it is written


def latex(text: str) -> str:
    """A formula as LaTeX, as people write it."""

    def name(word: str) -> str:
        found = re.fullmatch(r"(qdd|qd|q|[A-Za-z]+?)(\d*)", word)
        assert found is not None
        letter = {"qdd": r"\ddot\theta", "qd": r"\dot\theta", "q": r"\theta"}.get(found[1])
        return f"{letter or found[1]}_{found[2]}" if found[2] else word

    def of(node: ast.expr, tight: bool = False) -> str:
        match node:
            case ast.Constant(value=number):
                return str(number)
            case ast.Name(id=word):
                return name(word)
            case ast.UnaryOp(operand=inner):
                return f"(-{of(inner, True)})" if tight else f"-{of(inner, True)}"
            case ast.Call(func=ast.Name(id=word), args=[inner]):
                return rf"\{word}({of(inner)})"
            case ast.BinOp(left=left, op=ast.Mult(), right=right):
                second = of(right, True)
                cdot = r" \cdot " if second[:1].isdigit() else " "
                return f"{of(left, True)}{cdot}{second}"
            case ast.BinOp(left=left, op=ast.Div(), right=right):
                return rf"\frac{{{of(left)}}}{{{of(right)}}}"
            case ast.BinOp(left=left, op=ast.Pow(), right=right):
                base = of(left, True)
                return f"{base if isinstance(left, ast.Name) else f'({base})'}^{{{of(right)}}}"
            case ast.BinOp(left=left, op=op, right=right):
                sum_ = f"{of(left)} {'+' if isinstance(op, ast.Add) else '-'} {of(right, True)}"
                return f"({sum_})" if tight else sum_
        raise ValueError(ast.dump(node))

    return of(ast.parse(text, mode="eval").body)


def as_latex(text: str) -> str:
    """LaTeX where the text can be read, as it is where it cannot."""
    try:
        return latex(text)
    except (SyntaxError, ValueError):
        return text


def typed(text: str, rng: random.Random) -> str:
    """A formula with its writer's habits."""
    style = rng.choice(["python", "caret", "short"])
    if style != "python":
        text = text.replace("**", "^")
    if style == "short":
        text = re.sub(r"\b(cos|sin)\(q1 \+ q2\)", lambda m: m[1][0] + "12", text)
        text = re.sub(r"\b(cos|sin)\(q(\d)\)", lambda m: m[1][0] + m[2], text)
    return text


def written(who: str, answers: dict[str, Answer], rng: random.Random) -> tuple[str, str]:
    """A submission: the ending of its file, and what stands in it."""
    form = rng.choice(["toml", "tex", "txt"])
    lines = []
    for question, one in answers.items():
        if not one.texts:
            continue
        matrix = len(one.texts) == 4
        if form == "tex":
            cells = [as_latex(t) for t in one.texts]
            body = cells[0]
            if matrix:
                body = r"\begin{bmatrix} %s & %s \\ %s & %s \end{bmatrix}" % tuple(cells)  # noqa: UP031
            left = LEFT[question].replace("tau", r"\tau")
            lines.append(f"\\begin{{equation}}\n  {left} = {body}\n\\end{{equation}}")
        else:
            cells = [typed(t, rng) for t in one.texts]
            body = "[{}, {}; {}, {}]".format(*cells) if matrix else cells[0]
            quoted = f"{question} = '{body}'"
            lines.append(quoted if form == "toml" else f"{question}: {body}")
    rng.shuffle(lines)
    if form == "toml":
        return form, "\n".join([f'student = "{who}"', "[answers]", *lines]) + "\n"
    if form == "txt":
        return form, "\n".join([f"student: {who}", *lines]) + "\n"
    head = f"\\documentclass{{article}}\n% student: {who}\n\\begin{{document}}"
    return form, "\n".join([head, *lines, r"\end{document}"]) + "\n"


HOSTILE: list[tuple[str, str | bytes]] = [
    ("bomb.toml", "q1 = '9**9**9**9'\nq4 = '" + "(" * 5000 + "'\n"),
    ("nul.txt", b"q1: l1\x00*c1\n"),
    ("latin.txt", "q1: l1*c1 % \u00fc\n".encode("latin-1")),
    ("huge.txt", b"q1: " + b"l1*c1 + " * 100_000),
    ("nested.toml", "q1 = " + "[" * 30_000),
    ("long.txt", "q4: " + " + ".join(["cos(q1)*qdd1"] * 3000)),
    ("tower.txt", "q1: " + "cos(" * 300 + "q1" + ")" * 300),
    ("who.toml", "student = '=cmd|\"/c calc\"!A1'\nname = '<script>alert(1)</script>'\nq1 = '1'\n"),
    ("path.toml", "student = '../../../etc/passwd'\nq1 = '<img src=x onerror=alert(1)>'\n"),
    ("loop.py", "while True: pass\n"),
]  # fmt: skip


def made(folder: Path, students: int, seed: int) -> dict[str, dict[str, Answer]]:
    """Writes a class; what each student answered."""
    rng = random.Random(seed)
    folder.mkdir(parents=True)
    given: dict[str, dict[str, Answer]] = {}
    for k in range(students):
        if k % 20 == 19:
            name, content = HOSTILE[(k // 20) % len(HOSTILE)]
            data = content if isinstance(content, bytes) else content.encode()
            (folder / f"h{k:03}-{name}").write_bytes(data)
            continue
        who = f"s{k:03}"
        given[who] = {question: answer(question, rng) for question in TRUTH}
        ending, text = written(who, given[who], rng)
        (folder / f"{who}.{ending}").write_text(text, encoding="utf-8")
    return given


# -------- What is measured


def command(sheet: Path, folder: Path, out: Path) -> list[str]:
    """The command that marks."""
    return [sys.executable, "-m", "kinlab", "mark", str(sheet), str(folder), "-o", str(out)]


def timed(words: list[str]) -> tuple[float, float]:
    """Clock and processor seconds of a command."""
    before, start = resource.getrusage(resource.RUSAGE_CHILDREN), time.perf_counter()
    subprocess.run(words, check=True, stdout=subprocess.DEVNULL)
    after = resource.getrusage(resource.RUSAGE_CHILDREN)
    spent = after.ru_utime + after.ru_stime - before.ru_utime - before.ru_stime
    return time.perf_counter() - start, spent


def stopped(words: list[str], records: Path, half: int) -> tuple[int, int]:
    """Ctrl-C once half of the class is marked: the exit code, and how many were kept."""
    process = subprocess.Popen(words, stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL)
    while process.poll() is None and len(list(records.glob("*.json"))) < half:
        time.sleep(0.05)
    process.send_signal(signal.SIGINT)
    return process.wait(), len(list(records.glob("*.json")))


def judged(out: Path, given: dict[str, dict[str, Answer]]) -> tuple[Counter[str], list[str]]:
    """Kinds of answers by verdict, and what is false."""
    counts: Counter[str] = Counter()
    false = []
    with (out / "marks.csv").open(encoding="utf-8-sig", newline="") as stream:
        rows = {row["student"]: row for row in csv.DictReader(stream)}
    for who, answers in given.items():
        for question, one in answers.items():
            verdict = rows[who][f"{question} verdict"]
            counts[f"{one.kind} | {verdict}"] += 1
            right = verdict.startswith("right")
            full = {"q1": 2, "q2": 2, "q3": 3, "q4": 4, "q5": 1}[question]
            paid = float(rows[who][question]) == full
            if (one.kind == "right") != (right and paid) or right != paid:
                false.append(f"{who} {question} ({one.kind}): {verdict}: {one.texts}")
    return counts, false


# -------- Leaks

Values = list[np.ndarray]
_RUN = re.compile(r"[A-Za-z0-9_.^*/+\-() ]+")
_NAME = re.compile(r"[A-Za-z_]\w*")
_KNOWN = {*NAMES, *JOINTS, "sin", "cos", "c1", "s1", "c2", "s2", "c12", "s12", "sqrt", "pi"}


def linear(element: Any) -> str:
    """MathML as one line of text."""
    tag, parts = etree.QName(element).localname, [linear(child) for child in element]
    match tag, parts:
        case "mfrac", [top, below]:
            return f"(({top})/({below}))"
        case "msup", [base, top]:
            return f"{base}^({top})"
        case "msub", [base, below]:
            return f" {base.strip()}_{below.strip()} "
        case "msubsup", [base, below, top]:
            return f" {base.strip()}_{below.strip()}^({top})"
        case "mover", [base, dots]:
            twice = dots.strip() in ("\u00a8", "..", "\u0308")
            return rf"\{'dd' if twice else 'd'}ot{{{base.strip()}}}"
        case "mrow" | "math" | "mstyle", _:
            return "".join(parts)
    return f" {element.text or ''} "


def strings(path: Path) -> Iterator[str]:
    """Every text of a file that was written."""
    text = path.read_text(encoding="utf-8")
    if path.suffix == ".json":

        def inside(given: Any) -> Iterator[str]:
            if isinstance(given, dict | list):
                for one in given.values() if isinstance(given, dict) else given:
                    yield from inside(one)
            elif isinstance(given, str):
                yield from pieces(given)

        yield from inside(json.loads(text))
        return
    yield from pieces(text)


def pieces(text: str) -> Iterator[str]:
    """What stands between tags, and each piece of MathML in one line."""
    for found in re.finditer(r"<math.*?</math>", text, re.DOTALL):
        yield linear(etree.fromstring(re.sub(r"&(?!#|amp|lt|gt|quot)\w+;", " ", found[0])))
    text = re.sub(r"<math.*?</math>", "\n", text, flags=re.DOTALL)
    text = re.sub(r"<style>.*?</style>", "\n", text, flags=re.DOTALL)
    yield from html.unescape(re.sub(r"<[^>]*>", "\n", text)).splitlines()


def plain(text: str) -> str:
    """LaTeX and other writings as plain text."""
    text = text.replace(r"\wrong{", "{")
    if "\\" in text:
        try:
            return plain_formula(f"${text.rpartition('=')[2].strip('$ ')}$")
        except kl.KinlabError:
            return ""
    return text.replace("\u2212", "-").replace("\u00b7", "*")


def parts(text: str) -> Iterator[tree.Node]:
    """Every formula in a text, and all that is contiguous in it."""
    for run in _RUN.findall(plain(text)):
        cut = _NAME.sub(lambda m: m[0] if m[0].replace("_", "") in _KNOWN else "\n", run)
        for one in cut.splitlines():
            one = one.strip(" +*/^.")
            for tried in (one, one.strip("()"), f"{one})", f"({one}"):
                try:
                    whole = parse(tried)
                except kl.KinlabError:
                    continue
                for _path, node in tree.nodes(whole):
                    yield node
                    if node.op in ("add", "mul") and len(node.args) < 30:
                        join = tree.add if node.op == "add" else tree.mul
                        count = len(node.args)
                        for low in range(count):
                            for high in range(low + 2, count + 1 if low else count):
                                yield join(*node.args[low:high])
                break


def values(texts: Iterable[str], at: dict[str, np.ndarray]) -> Values:
    """The values of all that can be read as a formula."""
    found = {}
    for text in texts:
        for node in parts(text):
            try:
                out = np.asarray(tree.evaluate(node, at) + np.zeros(12), dtype=float)
            except (KeyError, ArithmeticError, ValueError, TypeError):
                continue
            if np.all(np.isfinite(out)):
                found[out.round(9).tobytes()] = out
    return list(found.values())


def holds(found: Values, model: np.ndarray) -> bool:
    """Whether one of the values is the model's."""
    size = float(np.max(np.abs(model)))
    return any(float(np.max(np.abs(one - model))) <= 1e-9 * size for one in found)


def all_names(at: dict[str, np.ndarray]) -> dict[str, np.ndarray]:
    """With the short forms of sines and cosines."""
    angles = {"1": at["q1"], "2": at["q2"], "12": at["q1"] + at["q2"]}
    return {**at, **{f"{f}{k}": (np.cos if f == "c" else np.sin)(a)
                     for f in "cs" for k, a in angles.items()}}  # fmt: skip


def leaks(out: Path, folder: Path, given: dict[str, dict[str, Answer]]) -> tuple[int, list[str]]:
    """How many model answers were looked for, and which stood where their student had none."""
    looked, found = 0, []
    for at in (all_names(at_random(11, False)), all_names(at_random(12, True))):
        shared = values(strings(out / "marks.csv"), at)
        for who, answers in given.items():
            files = [path for path in out.rglob(f"{who}*") if path.is_file()]
            told = values((s for path in files for s in strings(path)), at) + shared
            typed_ = [
                line for path in folder.glob(f"{who}.*") for line in path.read_text().splitlines()
            ]
            own = values([*typed_, *(t for a in answers.values() for t in a.texts)], at)
            for question, one in answers.items():
                if one.kind in ("right", "missing"):
                    continue
                for model in dict.fromkeys(TRUTH[question]):
                    true = value(model, at) + np.zeros(12)
                    if not holds(own, true):
                        looked += 1
                        if holds(told, true):
                            found.append(f"{who} {question}: {model} in {out.name}")
    return looked, found


def main() -> None:
    """Runs it."""
    parser = argparse.ArgumentParser(description=__doc__.partition("\n")[0])
    parser.add_argument("--students", type=int, default=200)
    parser.add_argument("--seed", type=int, default=1)
    parser.add_argument("--folder", type=Path, required=True, help="a new folder, for all of it")
    parser.add_argument("--leaks", action="store_true", help="only mark at place and cause")
    options = parser.parse_args()
    folder, sheet = options.folder / "submissions", options.folder / "sheet.toml"
    given = made(folder, options.students, options.seed)
    sheet.write_text(SHEET.format(feedback="cause"), encoding="utf-8")
    load = os.getloadavg()[0]
    if options.leaks:
        for level in ("place", "cause", "answer"):
            paths = sorted(folder.iterdir() if level != "answer" else folder.glob("s*"))
            asked = given if level != "answer" else dict(list(given.items())[:20])
            out = options.folder / level
            kl.mark(sheet, paths[: None if asked is given else 20], out, feedback=level)
            looked, found = leaks(out, folder, asked)
            print(f"{level}: {looked} model answers looked for, {len(found)} found")
            print("\n".join(found[:5] if level == "answer" else found))
            if level == "answer" and not found:
                raise SystemExit("what is told at answer was not found: nothing was measured")
        return
    first = options.folder / "first"
    clock, spent = timed(command(sheet, folder, first))
    print(f"{options.students} submissions, 5 questions: {clock:.1f} s by the clock, "
          f"{spent:.1f} s of processor time; load {load:.1f} before")  # fmt: skip
    again = options.folder / "again"
    code, kept = stopped(command(sheet, folder, again), again / ".records", options.students // 2)
    print(f"stopped by Ctrl-C: exit code {code}, {kept} kept, "
          f"marks.csv {'there' if (again / 'marks.csv').exists() else 'not there'}")  # fmt: skip
    clock, spent = timed(command(sheet, folder, again))
    equal = (first / "marks.csv").read_bytes() == (again / "marks.csv").read_bytes()
    print(f"gone on: {clock:.1f} s, {spent:.1f} s of processor time, marks.csv equal: {equal}")
    paths = list(folder.iterdir())
    random.Random(options.seed).shuffle(paths)
    shuffled = options.folder / "shuffled"
    kl.mark(sheet, paths, shuffled, workers=1)
    equal = (first / "marks.csv").read_bytes() == (shuffled / "marks.csv").read_bytes()
    print(f"in another order, one worker: marks.csv equal: {equal}")
    counts, false = judged(first, given)
    for line, count in sorted(counts.items()):
        print(f"  {line}: {count}")
    print(f"false: {len(false)}", *false, sep="\n  ")


if __name__ == "__main__":
    main()
