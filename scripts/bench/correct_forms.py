"""Correct formulas as people write them, none of which may be called wrong.

Kinds: numbers for some names, all numbers, numbers to three or four digits, constants such as 0.333
and 1.5708, g as 9.8 or 10, symbols with rounded numbers, a C that is not Christoffel's, a potential
with another zero, sums set in several lines with names of their writer's before or behind them,
functions with rounded numbers, and recursions of which some numbers are rounded.
``python scripts/bench/correct_forms.py --count 10000`` prints the count by kind and every false
alarm.
"""

from __future__ import annotations

import argparse
import linecache
import random
import re
import tempfile
import time
from collections import Counter
from collections.abc import Iterator
from pathlib import Path
from typing import Any

import numpy as np
import sympy

import kinlab as kl
from kinlab import symbolic
from kinlab.doctor.file import examine_file
from kinlab.errors import KinlabError
from kinlab.formulas import typeset
from kinlab.formulas.text import parse
from kinlab.symbolic.kinematics import jacobian as symbolic_jacobian

ROBOTS = ("single_link", "planar2r", "planar2r_rods", "planar3r", "spatial3r")
DERIVED = {
    "fk": symbolic.fk, "jacobian": symbolic_jacobian, "mass_matrix": symbolic.mass_matrix,
    "gravity_torques": symbolic.gravity_torques, "inverse_dynamics": symbolic.inverse_dynamics,
    "kinetic_energy": symbolic.kinetic_energy, "potential_energy": symbolic.potential_energy,
}  # fmt: skip
LONGEST = 40


def pool() -> list[tuple[str, str, sympy.Expr, dict[str, float]]]:
    """Robot, entry, the derived expression, the robot's numbers."""
    found = []
    for robot in ROBOTS:
        arm = symbolic.arm(kl.load(robot).table)
        numbers = {name: float(value) for name, value in arm.values.items()}
        for quantity, derive in DERIVED.items():
            derived = derive(arm)
            if not isinstance(derived, sympy.MatrixBase):
                found.append((robot, quantity, sympy.expand(derived), numbers))
                continue
            column = quantity.endswith(("torques", "dynamics"))
            for r in range(derived.rows):
                for c in range(derived.cols):
                    index = f"{r}" if column else f"{r},{c}"
                    entry = sympy.expand(derived[r, c])
                    if entry.free_symbols and len(sympy.Add.make_args(entry)) <= LONGEST:
                        found.append((robot, f"{quantity}[{index}]", entry, numbers))
    return found


def put(text: str, name: str, number: str) -> str:
    """A number in place of a name, everywhere."""
    shown = f"({number})" if number.startswith("-") else number
    return re.sub(rf"\b{name}\b", shown, text)


def digits(value: float, count: int) -> str:
    """A decimal with so many significant digits, never in powers of ten."""
    shown = np.format_float_positional(
        value, precision=count, fractional=False, trim="k", unique=False
    )
    return shown if "." in shown else shown + ".0"


def some_numbers(text: str, numbers: dict[str, float], rng: random.Random) -> str:
    """The robot's numbers in full for some names."""
    inside = [n for n in numbers if re.search(rf"\b{n}\b", text)]
    for name in rng.sample(inside, rng.randint(min(1, len(inside)), len(inside))):
        text = put(text, name, repr(numbers[name]))
    return text


def one_rounded(text: str, numbers: dict[str, float], rng: random.Random) -> str:
    """One name as its number to three or four digits, the same everywhere."""
    inside = [n for n in numbers if re.search(rf"\b{n}\b", text)]
    if inside:
        name = rng.choice(inside)
        text = put(text, name, digits(numbers[name], rng.choice([3, 4])))
    return text


def gravity(text: str, numbers: dict[str, float], rng: random.Random) -> str:
    """9.8, 9.80 or 10 for g."""
    return put(text, "g", rng.choice(["9.8", "9.80", "10", "10.0"][:3]))


def constants(text: str, numbers: dict[str, float], rng: random.Random) -> str:
    """0.333 for 1/3, and a quarter turn as 1.5708."""
    text = re.sub(r"/3\b", rng.choice(["*0.333", "*0.3333", "*0.33"]), text)
    text = re.sub(r"/12\b", rng.choice(["*0.0833", "*0.083333"]), text)
    found = re.search(r"sin\(([^()]*)\)", text)
    if found and rng.random() < 0.5:
        quarter = rng.choice(["1.5708", "3.1416/2", "1.571", "3.14159/2"])
        text = text.replace(found.group(), f"cos({quarter} - ({found.group(1)}))", 1)
    return text


def coefficients(entry: sympy.Expr, numbers: dict[str, float], count: int) -> str:
    """All numbers, each coefficient to so many digits."""
    plain = entry.subs({sympy.Symbol(n): x for n, x in numbers.items()})
    parts: dict[Any, float] = {}
    for term in sympy.Add.make_args(sympy.expand(plain)):
        factor, rest = term.as_coeff_Mul()
        parts[rest] = parts.get(rest, 0.0) + float(factor)
    shown = [f"{digits(x, count)}*({rest})" for rest, x in parts.items() if x]
    return " + ".join(shown).replace("+ -", "- ") or "0.0"


KINDS = {"numbers for names": some_numbers, "one number rounded": one_rounded,
         "rounded g": gravity, "rounded constants": constants}  # fmt: skip


def texts(formulas: list[Any], rng: random.Random) -> Iterator[tuple[str, str, list[str]]]:
    """Kind, robot and the lines of a file, for ever."""
    while True:
        robot, entry, expression, numbers = rng.choice(formulas)
        kind = rng.choice([*KINDS, "coefficients", "symbols", "potential", "C", "lines"])
        if kind in KINDS:
            text = KINDS[kind](str(expression), numbers, rng)
        elif kind == "coefficients":
            text = coefficients(expression, numbers, rng.choice([3, 4, 5]))
        elif kind == "lines":
            yield kind, robot, ["[formulas]", f"\"{entry}\" = '''{in_lines(expression, rng)}'''"]
            continue
        elif kind == "symbols":
            inside = [n for n in numbers if re.search(rf"\b{n}\b", str(expression))]
            if not inside:
                continue
            name = rng.choice(inside)
            shown = digits(numbers[name], rng.choice([3, 4, 8]))
            yield kind, robot, ["[symbols]", f"{name} = {shown}", "[formulas]",
                                f'"{entry}" = "{expression}"']  # fmt: skip
            continue
        elif kind == "potential":
            if entry != "potential_energy":
                continue
            extra = rng.choice(["m1*g", "3.2", "g*(m1 + 1)", "7"])
            text = f"{expression} {rng.choice('+-')} {extra}"
        else:
            if robot not in ("planar2r", "planar2r_rods"):
                continue
            yield kind, robot, ["[formulas]", *another_c(robot, rng)]
            continue
        yield kind, robot, ["[formulas]", f'"{entry}" = "{text}"']


BREAKS = ["\\\\", "\\\\\n", "\\\\[3pt]\n", "\\nonumber\\\\\n", " \\notag \\\\ "]
AHEAD = [r"&\quad ", "& ", r"&\qquad {}", r"\quad ", r"&\phantom{=} ", r"&\hspace{2em} ", "&& "]
DISPLAYS = [
    ("", ""), ("$", "$"), ("$$", "$$"), (r"\[", r"\]"), (r"\begin{aligned}", r"\end{aligned}"),
    ("\\begin{align*}\n", "\n\\end{align*}"), ("$$\\begin{split}", "\\end{split}$$"),
    (r"\begin{equation}\begin{split}", r"\end{split}\end{equation}"),
]  # fmt: skip
BEHIND = [", where ", r", \quad \text{where}\quad ", r" \text{with } ", "，其中 ", "; ", "\n"]


def in_lines(expression: sympy.Expr, rng: random.Random) -> str:
    """A sum as LaTeX, set in several lines, some of its terms under names of their writer's."""
    terms = [typeset.latex(parse(str(x))) for x in sympy.Add.make_args(expression)]
    names = {}
    for name in rng.sample(["A", "B", r"\beta", "k_1"], rng.choice([0, 0, 1, 2])):
        k = rng.randrange(len(terms))
        if terms[k] not in names:
            names[name], terms[k] = terms[k], name
    whole = ""
    for k, term in enumerate(terms):
        sign, body = ("-", term[1:].lstrip()) if term.startswith("-") else ("+", term)
        start = f"{sign} " if k or sign == "-" else ""
        if k and rng.random() < 0.4:
            end, ahead = rng.choice(BREAKS), rng.choice(AHEAD)
            trailing = rng.random() < 0.3
            start = f" {start}{end} {ahead}" if trailing else f" {end} {ahead}{start}"
        whole += f"{start}{body} "
    own = rng.choice([", ", "; ", r" \\ ", ",\\quad "]).join(f"{x} = {y}" for x, y in names.items())
    if own:
        front = rng.random() < 0.4
        whole = (
            f"{own} {rng.choice(BREAKS[:3])} w = {whole}"
            if front
            else whole + rng.choice(BEHIND) + own
        )
    opened, closed = rng.choice(DISPLAYS)
    ending = rng.choice(["", ".", " ,", r" \tag{3}", r" \qquad (7)"])
    return f"{opened}{whole}{ending}{closed}"


def another_c(robot: str, rng: random.Random) -> list[str]:
    """C of a planar 2R arm with its velocity products shared out at will."""
    h = "m2*l1*l2*sin(q2)" + ("/2" if robot == "planar2r_rods" else "")
    share = rng.choice(["1", "0", "2", "0.25", "3"])
    other = f"(2 - {share})"
    return [f'C11 = "-{share}*{h}*qd2"', f'C12 = "-{other}*{h}*qd1 - {h}*qd2"',
            f'C21 = "{h}*qd1"', 'C22 = "0"']  # fmt: skip


def functions(rng: random.Random) -> Iterator[tuple[str, str, str, Any]]:
    """Kind, robot, quantity and a function with rounded numbers, for ever."""
    names = (*ROBOTS, "puma560", "ur5", "stanford")
    while True:
        robot = kl.load(rng.choice(names))
        quantity = rng.choice(["gravity_torques", "inverse_dynamics", "potential_energy"])
        factor = rng.choice([9.8, 10.0, 9.807, 9.80665]) / 9.81
        plain = getattr(kl, quantity)

        def rounded_g(
            *x: Any, plain: Any = plain, robot: Any = robot, factor: float = factor
        ) -> Any:
            if plain is not kl.inverse_dynamics:
                return plain(robot, *x) * factor
            return plain(robot, *x) + (factor - 1.0) * kl.gravity_torques(robot, x[0])

        def another_zero(q: Any, robot: Any = robot, up: float = rng.uniform(-9, 9)) -> Any:
            return kl.potential_energy(robot, q) + up

        def another_split(q: Any, v: Any, robot: Any = robot, k: float = rng.uniform(-2, 2)) -> Any:
            c = kl.coriolis_matrix(robot, q, v)
            skew = np.outer(v, np.roll(v, 1))
            return c + k * np.outer(np.cos(q), (skew - skew.T) @ v)

        if not np.linalg.norm(robot.model.gravity.linear):
            continue
        yield "function, rounded g", robot.name, quantity, rounded_g
        yield "function, another zero", robot.name, "potential_energy", another_zero
        yield "program, some numbers rounded", *recursion(rng)
        if robot.n > 1:
            yield "function, another C", robot.name, "coriolis_matrix", another_split


RECURSION = """
import numpy as np
ROWS = {rows}
G = {gravity}

def f(q, qd, qdd):
    x, z, n = np.cross, np.array([0, 0, 1.0]), len(ROWS)
    w, wd, vd, links = np.zeros(3), np.zeros(3), -np.array(G), []
    for k, (a, alpha, d, theta, slides, m, c, I, Ia) in enumerate(ROWS):
        t, d = (theta, d + q[k]) if slides else (theta + q[k], d)
        ct, st, ca, sa = np.cos(t), np.sin(t), np.cos(alpha), np.sin(alpha)
        R = np.array([[ct, -st*ca, st*sa], [st, ct*ca, -ct*sa], [0, sa, ca]])
        p, c, I = np.array([a, d*sa, d*ca]), np.array(c), np.array(I)
        if not slides:
            wd = wd + z*qdd[k] + x(w, z*qd[k])
            w = w + z*qd[k]
        w, wd, vd = R.T @ w, R.T @ wd, R.T @ vd
        vd = vd + x(wd, p) + x(w, x(w, p))
        if slides:
            vd = vd + R.T @ z*qdd[k] + 2*x(w, R.T @ z*qd[k])
        F = m*(vd + x(wd, c) + x(w, x(w, c)))
        links.append((R, p, c, F, I @ wd + x(w, I @ w)))
    f_, n_, tau, R_next = np.zeros(3), np.zeros(3), np.zeros(n), np.eye(3)
    for k in reversed(range(n)):
        R, p, c, F, N = links[k]
        f_, n_ = R_next @ f_, R_next @ n_
        n_ = n_ + x(p, f_) + x(p + c, F) + N
        f_, R_next = f_ + F, R
        tau[k] = (f_ if ROWS[k][4] else n_) @ (R.T @ z) + ROWS[k][8]*qdd[k]
    return tau
"""


def recursion(rng: random.Random) -> tuple[str, str, Any]:
    """Newton-Euler of a standard table with some of its numbers rounded, as a program."""
    name = rng.choice(["planar2r_rods", "puma560", "stanford", "ur5", "ur10"])
    table = kl.load(name).table
    share, count = rng.choice([0.1, 0.5, 1.0]), rng.choice([3, 4, 5, 6])

    def typed(value: float) -> float:
        near = any(abs(value - k * np.pi / 12) < 1e-9 for k in range(-24, 25))
        return value if near or rng.random() > share else float(f"{value:.{count}g}")

    rows = []
    for link in table.links:
        plain = [typed(float(x)) for x in (link.a, link.alpha, link.d, link.theta)]
        com = [typed(float(x)) for x in np.ravel(link.com)]
        inertia = [[typed(float(x)) for x in row] for row in np.asarray(link.inertia)]
        inertia = [[inertia[min(i, j)][max(i, j)] for j in range(3)] for i in range(3)]
        slides = link.joint == "prismatic"
        rows.append((*plain, slides, typed(link.mass), com, inertia, typed(link.armature)))
    turn = np.asarray(table.base)[:3, :3]
    gravity = [round(float(x), 12) for x in turn.T @ np.asarray(table.gravity)]
    text = RECURSION.format(rows=rows, gravity=gravity)
    space: dict[str, Any] = {"__name__": "recursion"}
    place = f"<recursion {rng.random()}>"
    linecache.cache[place] = (len(text), None, text.splitlines(keepends=True), place)
    exec(compile(text, place, "exec"), space)  # noqa: S102  the program above
    return name, "inverse_dynamics", space["f"]


def run(count: int, seed: int, folder: Path) -> tuple[Counter[str], list[str]]:
    """Judges that many correct formulas: the count by kind, and what was called wrong."""
    rng = random.Random(seed)
    done: Counter[str] = Counter()
    alarms: list[str] = []
    texts_, functions_ = texts(pool(), rng), functions(rng)
    file = folder / "right.toml"
    while done.total() < count:
        if rng.random() < 0.9:
            kind, robot, lines = next(texts_)
            file.write_text("\n".join([f'robot = "{robot}"', *lines]) + "\n", encoding="utf-8")
            try:
                found = examine_file(file, samples=30, seed=done.total())
            except KinlabError:  # not read, and not called wrong
                done[f"{kind}, refused"] += 1
                continue
            told = "\n".join([robot, *lines])
        else:
            kind, robot, quantity, function = next(functions_)
            found = [kl.diagnose(robot, quantity, function, samples=20, seed=done.total())]
            told = f"{robot} {quantity}"
        done[kind] += len(found)
        alarms += [f"{kind}: {told[:600]}\n{one}" for one in found if not one.agrees]
    return done, alarms


def main() -> None:
    """Runs the campaign."""
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--count", type=int, default=10_000)
    parser.add_argument("--seed", type=int, default=0)
    options = parser.parse_args()
    start = time.perf_counter()
    with tempfile.TemporaryDirectory() as folder:
        done, alarms = run(options.count, options.seed, Path(folder))
    for alarm in alarms:
        print("FALSE ALARM", alarm)
    for kind, number in sorted(done.items()):
        print(f"{kind}: {number}")
    took = time.perf_counter() - start
    print(f"{len(alarms)} false alarms in {done.total()} correct formulas, {took:.0f} s")


if __name__ == "__main__":
    main()
