"""The classes of the doctor's bench: what is spoiled, how, and which words name it.

Formulas are derived by kinlab, which the doctor is asked about, and spoiled by :mod:`mutants`
(slips of the pen on Python's syntax tree) and :mod:`confusions` (answers of somebody who is
confused); :mod:`bench_doctor_books` has derivations of the textbooks by hand. Of the doctor only
its doors are used, ``kl.diagnose`` and the reader of files: none of its lists.
"""

from __future__ import annotations

import random
import re
import tempfile
from collections.abc import Callable
from dataclasses import dataclass, replace
from functools import cache
from pathlib import Path
from typing import Any

import bench_doctor_books
import correct_forms
import numpy as np
import sympy
from bench_doctor_books import BOOKS, FIVEBAR, fivebar
from bench_doctor_class import as_latex
from confusions import CONFUSIONS, plain, random_arm
from mutants import RULES, every, mutate, rewritten, value

import kinlab as kl
from kinlab import symbolic
from kinlab.check.catalogue import catalogue
from kinlab.check.quantities.registry import quantity as find_quantity
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
class Case:
    """One thing that the doctor is asked.

    Attributes:
        label: what was done, such as ``"sign"``.
        about: for the list of misses.
        examine: asks.
        named: whether a cause is the mistake; None where nothing is wrong.
        repaired: whether what the doctor proposes is the true formula; None where it is not asked.
        made: how many mistakes were made.
    """

    label: str
    about: dict[str, Any]
    examine: Callable[[], Any]
    named: Callable[[Any], bool] | None = None
    repaired: Callable[[Any], bool] | None = None
    made: int = 1


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


@cache
def formulas(robots: tuple[str, ...] = ROBOTS) -> list[Formula]:
    """Every entry of the derived quantities with two terms or more, in three forms."""
    found = []
    for robot in robots:
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
    try:
        other = value(one, at)
    except KeyError:  # a name that the right one has not: lc3 of a rod
        return True
    return bool(np.max(np.abs(other - right)) > 1e-9 * np.max(np.abs(right)))


def merged(formula: Formula, bad: str, numbers: bool) -> bool:
    """Whether two slips are one by value: a multiple of one term, or what one slip makes too."""
    at = points(formula, numbers)
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


def by_text(formula: Formula, text: str) -> Any:
    """The diagnosis of a text."""
    with tempfile.TemporaryDirectory() as folder:
        file = Path(folder) / "f.toml"
        head = f'robot = "{formula.robot}"\n[formulas]\n'
        file.write_text(f"{head}\"{formula.entry}\" = '{text}'\n", encoding="utf-8")
        return examine_file(file, samples=60)[0]


def by_function(formula: Formula, text: str, samples: int = 200) -> Any:
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

    return kl.diagnose(robot, formula.quantity, hand, samples=samples)


def named(kinds: tuple[str, ...], classes: list[tuple[str, ...]]) -> bool:
    """Whether the kinds are one of each class, in any order."""
    if len(kinds) != len(classes):
        return False
    if not classes:
        return True
    return any(kinds[0] in one and named(kinds[1:], classes[:k] + classes[k + 1 :])
               for k, one in enumerate(classes))  # fmt: skip


def repaired(formula: Formula, answer: Any) -> bool:
    """Whether every leading cause's corrected text is the right one, at random parameters."""
    if not answer.causes:
        return False
    texts = [c.corrected[formula.entry] for c in answer.causes if formula.entry in c.corrected]
    return not any(differs(formula, text, False) for text in texts)


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
        wrong, right = np.asarray(function(*state)), np.asarray(right)
        if wrong.shape != right.shape:
            return False
        if np.max(np.abs(wrong - right)) > 1e-9 * (np.max(np.abs(right)) or 1.0):
            return False
    return True


def another_form(formula: Formula, rng: random.Random) -> str:
    """sympy's other forms at times, and always a shuffle with identities."""
    text = formula.text
    if rng.random() < 0.1 and len(text) < 300:
        names = {n: sympy.Symbol(n) for n in formula.names}
        change = rng.choice([sympy.factor, sympy.expand_trig, sympy.trigsimp, sympy.simplify])
        text = str(change(sympy.sympify(text, locals=names)))
    return rewritten(text, rng)


# -------- Slips of the pen


def spoiled(formula: Formula, rules: list[str], numbers: bool, rng: random.Random) -> str | None:
    """A formula with slips of these classes; None where they are none, or fewer by value."""
    bad: str | None = formula.text
    seen = [formula.text]
    # what is added comes last: a slip in an added term would be one mistake, not two
    for rule in sorted(rules, key=ADDED.__contains__):
        bad = bad and mutate(bad, rule, formula.names, formula.others, rng)
        if bad is None or not all(_apart(formula, bad, one) for one in seen):
            return None
        seen.append(bad)
    assert bad is not None
    if not (differs(formula, bad, True) and (numbers or differs(formula, bad, False))):
        return None
    return None if len(rules) > 1 and merged(formula, bad, numbers) else bad


def _apart(formula: Formula, one: str, other: str) -> bool:
    at = points(formula, False)
    a, b = value(one, at), value(other, at)
    return bool(np.max(np.abs(a - b)) > 1e-9 * np.max(np.abs(b)))


def slips(count: int, form: str) -> Callable[[random.Random], Case | None]:
    """Maker of formulas with that many slips, as text or as function."""

    def make(rng: random.Random, robots: tuple[str, ...] = ROBOTS) -> Case | None:
        formula = rng.choice(formulas(robots))
        rules = [rng.choice([*RULES, "extra term"]) for _ in range(count)]
        bad = spoiled(formula, rules, form == "function", rng)
        if bad is None:
            return None
        by = by_text if form == "text" else by_function
        about = {"robot": formula.robot, "entry": formula.entry, "right": formula.text, "is": bad}
        return Case(
            " + ".join(sorted(rules)), about, lambda: by(formula, bad),
            lambda cause: named(cause.kinds, [NAMES[rule] for rule in rules]),
            lambda answer: repaired(formula, answer), count,
        )  # fmt: skip

    return make


# -------- Typed input

_CALL = re.compile(r"\b(sin|cos)\(")
_JOINT = re.compile(r"\b(qdd|qd|q)(\d)\b")
_GREEK = {"q": "θ", "qd": "θ\u0307", "qdd": "θ\u0308"}
_LOW = str.maketrans("0123456789", "₀₁₂₃₄₅₆₇₈₉")


def _latex(text: str) -> str:
    return f"${as_latex(text)}$"


def _braces(text: str) -> str:
    """With ``\\left(``, and every index in braces."""
    body = as_latex(text).replace("(", r"\left(").replace(")", r"\right)")
    body = re.sub(r"_(\d)", r"_{\1}", body)
    return f"${body}$"


def _matlab(text: str) -> str:
    return _JOINT.sub(r"\1(\2)", text).replace("**", ".^").replace("*", ".*")


def _numpy(text: str) -> str:
    text = _JOINT.sub(lambda m: f"{m[1]}[{int(m[2]) - 1}]", text)
    return _CALL.sub(r"np.\1(", text)


def _greek(text: str) -> str:
    text = _JOINT.sub(lambda m: _GREEK[m[1]] + m[2].translate(_LOW), text)
    return text.replace("**2", "²").replace("**", "^").replace("*", "·")


def _short(text: str) -> str:
    text = re.sub(r"\b([cs])(?:os|in)\(q1 \+ q2\)", r"\g<1>12", text)
    return re.sub(r"\b([cs])(?:os|in)\(q(\d)\)", r"\1\2", text).replace("**", "^")


HANDS = {"LaTeX": _latex, "LaTeX, braces": _braces, "MATLAB": _matlab, "NumPy": _numpy,
         "Greek letters": _greek, "c12 and ^": _short}  # fmt: skip
"""How people type, each from the plain text."""


def typed(slip: bool) -> Callable[[random.Random], Case | None]:
    """Maker of formulas as people type them, right ones or with one slip."""

    def make(rng: random.Random) -> Case | None:
        formula = rng.choice(formulas(("planar2r", "planar2r_rods", "planar3r")))
        hand = rng.choice([*HANDS])
        text: str | None = formula.text
        rule = rng.choice([*RULES])
        if slip:
            text = spoiled(formula, [rule], False, rng)
        if text is None:
            return None
        shown = HANDS[hand](text)
        about = {"robot": formula.robot, "entry": formula.entry, "right": formula.text, "is": shown}
        return Case(
            hand, about, lambda: by_text(formula, shown),
            (lambda cause: named(cause.kinds, [NAMES[rule]])) if slip else None,
        )  # fmt: skip

    return make


# -------- Whole answers


def _arm(rng: random.Random) -> Any:
    if rng.random() < 0.5:
        return kl.load(rng.choice(CONFUSED))
    return random_arm(rng, rng.choice([2, 3, 4, 6]))


def _with_slide(rng: random.Random) -> Any:
    """A random arm of three joints with a slide in it."""
    table = random_arm(rng, 3).table
    at = rng.randrange(1, 3)
    links = [replace(link, joint="prismatic" if k == at else "revolute")
             for k, link in enumerate(table.links)]  # fmt: skip
    return kl.Robot.from_dh(replace(table, name="random_slide", links=links))


def confused(label: str) -> Callable[[random.Random], Case | None]:
    """Maker of one of the confusions."""
    make_one, kinds = CONFUSIONS[label]

    def make(rng: random.Random) -> Case | None:
        arm = _arm(rng)
        made = make_one(arm, rng)
        if made is None or same(arm, *made):
            return None
        return Case(label, {"robot": arm.name, "entry": made[0]},
                    lambda: kl.diagnose(arm, *made, samples=40),
                    lambda cause: named(cause.kinds, [kinds]))  # fmt: skip

    return make


def of_a_book(
    derive: Callable[[Any, str], Any], slip: str, words: str
) -> Callable[[random.Random], Case | None]:
    """Maker of a textbook's derivation with one step spoiled."""

    def make(rng: random.Random) -> Case | None:
        arm = _arm(rng)
        if derive is bench_doctor_books.absolute:
            arm = kl.load(rng.choice(["planar2r", "planar2r_rods", "planar3r"]))
        elif "slide" in slip:
            arm = _with_slide(rng)
        if not bench_doctor_books.suits(derive, slip, arm):
            return None
        made = derive(arm, slip)
        if same(arm, *made):
            return None
        return Case(f"{made[0]}: {slip}", {"robot": arm.name, "entry": made[0]},
                    lambda: kl.diagnose(arm, *made, samples=40), said(words))  # fmt: skip

    return make


def said(words: str) -> Callable[[Any], bool]:
    """Whether a cause's sentence has the words."""
    return lambda cause: re.search(words, cause.sentence, re.IGNORECASE) is not None


def of_the_fivebar(number: int) -> Callable[[random.Random], Case | None]:
    """Maker of one of the five-bar's formulas, spoiled."""
    quantity, text, words = FIVEBAR[number]

    def make(rng: random.Random) -> Case | None:
        name = rng.choice(["isotropic", "unequal"])
        spoiled_ = fivebar(name, quantity, text)
        return Case(f"{quantity}: {text}", {"robot": name, "entry": quantity},
                    lambda: kl.diagnose(name, quantity, spoiled_, samples=60),
                    said(words))  # fmt: skip

    return make


def unexplained(rng: random.Random) -> Case | None:
    """A function that nothing explains: any cause is wrong."""
    arm = kl.load(rng.choice([*ROBOTS, "puma560", "ur5"]))
    quantity = rng.choice(["fk", "jacobian", "gravity_torques", "mass_matrix", "inverse_dynamics"])
    right, by = plain(quantity), rng.uniform(0.2, 0.9)

    def strange(*state: Any) -> Any:
        return right(arm, *state) + np.tanh(state[0][0] * state[0][-1] + by)

    return Case(quantity, {"robot": arm.name, "entry": quantity},
                lambda: kl.diagnose(arm, quantity, strange), lambda cause: False)  # fmt: skip


MISPRINTS = {
    "000.dh": "opposite sign",
    "000.Jv": "no number",
    "000.vel": "hinge|slide",
    "000.omega:last frame": "rotat|transpos|R",
    "000.Jframe:singular": "no number",
    "000.iso": "order|column|J\\^T J",
    "000.iso2r:135 degrees": "no number at 3. of 60",
    "000.pinv:redundant": "J\\^T J|inverse",
    "000.JTF:base": "moment|rotat",
    "000.ne.out": "rotated after",
    "000.ne.in:tau": "gravity",
    "000.lag:u": "opposite sign",
    "001.eom": "q for G",
    "001.v2": "qd1\\*qd2 is smaller",
    "001.L": "qd1\\*qd2 is smaller",
    "001.ddt1": "qdd1\\*qdd2",
    "001.tau1": "qdd2\\*\\*2 where",
    "001.D:tau": "qd2 where the engine has qd2\\*\\*2",
    "002.el": "opposite sign",
    "002.pend:torque": "opposite sign",
    "002.pend:L": "opposite sign",
    "002.action:boundary term": "ends|boundary",
    "002.action:least": "least",
    "002.dhdef": "modified",
    "002.elem": "R_x|another|label|d",
    "002.com:example": "opposite sign",
    "002.T2r:T_02": "angle|q1|argument",
    "002.M:M": "not rotated",
    "002.G:general": "along|axis",
    "002.C:C": "symmetric",
    "002.C:symmetry": "C|symmetric",
    "002.C:torque": "symmetric",
    "002.C:Mdot qd": "C|twice",
    "002.C:gradient": "qd|sum",
    "002.C:reduction": "dM_ij/dq_k for D_jki|Mdot|takes D for",
    "002.skew:matrix": "dM_ij/dq_k.*out.*opposite sign|symmetric",
    "003.ABC": "leaves 2\\*s\\*e\\*x out",
}
"""The notes' misprints, and the words that name them, from what the record says is wrong."""


def misprint(key: str) -> Callable[[random.Random], Case | None]:
    """Maker of a printed form, on a mechanism that shows it."""

    def make(rng: random.Random) -> Case | None:
        row = next(one for one in catalogue() if one.key == key)
        domain = find_quantity(row.quantity.partition("[")[0]).domain
        shown = row.printed.robots or row.robots
        name = next(r for one in shown for r in domain.members(one))
        numbers = domain.numbers(domain.load(name))

        def printed(*state: Any) -> Any:
            return row.printed.function(numbers, *state)

        return Case(key, {"robot": name, "entry": row.quantity, "misprint": row.printed.misprint},
                    lambda: kl.diagnose(name, row.quantity, printed, samples=60),
                    said(MISPRINTS[key]))  # fmt: skip

    return make


# -------- Right formulas

FORMS = "another algebraic form"


def right(rng: random.Random) -> tuple[dict[str, int], list[str]]:
    """Forty right formulas: how many of each kind, and which were called wrong."""
    with tempfile.TemporaryDirectory() as folder:
        done, alarms = correct_forms.run(20, rng.randrange(1 << 30), Path(folder))
        counts = dict(done)
        robot = rng.choice(ROBOTS)
        some = [f for f in formulas() if f.robot == robot]
        chosen = {f.entry: f for f in rng.sample(some, min(20, len(some)))}
        lines = [f'robot = "{robot}"', "[formulas]"]
        lines += [f'"{entry}" = "{another_form(f, rng)}"' for entry, f in chosen.items()]
        file = Path(folder) / "right.toml"
        file.write_text("\n".join(lines) + "\n", encoding="utf-8")
        for answer in examine_file(file, samples=40):
            counts[FORMS] = counts.get(FORMS, 0) + answer.function.count(", ") + 1
            if not answer.agrees:
                alarms.append(f"{FORMS}: {lines[0]}: {answer}")
    return counts, alarms


# -------- All of them

Makers = dict[str, dict[str, Callable[[random.Random], Case | None]]]


def classes() -> Makers:
    """Class of the bench: its makers by name; a class with one maker is drawn from often."""
    return {
        "one slip, as text": {"": slips(1, "text")},
        "one slip, as a function": {"": slips(1, "function")},
        "typed input, right": {"": typed(False)},
        "typed input, one slip": {"": typed(True)},
        "one confusion, as a function": {name: confused(name) for name in CONFUSIONS},
        "one step of a textbook, as a function": {
            f"{derive.__name__} {slip}": of_a_book(derive, slip, words)
            for derive, slip, words in BOOKS
        },
        "the five-bar, as a function": {f"{k}": of_the_fivebar(k) for k in range(len(FIVEBAR))},
        "misprints of the notes": {key: misprint(key) for key in MISPRINTS},
        "two slips, as text": {"": slips(2, "text")},
        "two slips, as a function": {"": slips(2, "function")},
        "three slips, as text": {"": slips(3, "text")},
        "three slips, as a function": {"": slips(3, "function")},
        "nothing explains it": {"": unexplained},
    }
