"""Formulas of the planar two-link arm as text and as LaTeX: true ones, and rewritten ones.

Every formula is a tree of our own. It is written as text or LaTeX in a random spelling and
evaluated by plain Python, state by state; the closed forms of the arm are our own too.
"""

from __future__ import annotations

import contextlib
import io
import json
import math
import random
import tempfile
from pathlib import Path
from typing import Any

import numpy as np

Tree = Any
"""A number, a name, or (operation, argument, ...)."""

NUMBERS = {"l1": 0.5, "l2": 0.4, "m1": 2.0, "m2": 1.5, "g": 9.81}
STATES = ("q1", "q2", "qd1", "qd2", "qdd1", "qdd2")

_Q12 = ("+", "q1", "q2")
_G2 = ("*", "m2", "g", "l2", ("cos", _Q12))
_G1 = ("+", ("*", ("+", "m1", "m2"), "g", "l1", ("cos", "q1")), _G2)
_M22 = ("*", "m2", ("**", "l2", 2))
_M12 = ("+", _M22, ("*", "m2", "l1", "l2", ("cos", "q2")))
_M11 = ("+", ("*", ("+", "m1", "m2"), ("**", "l1", 2)), _M22,
        ("*", 2, "m2", "l1", "l2", ("cos", "q2")))  # fmt: skip
_TAU2 = ("+", ("*", _M12, "qdd1"), ("*", _M22, "qdd2"),
         ("*", "m2", "l1", "l2", ("sin", "q2"), ("**", "qd1", 2)), _G2)  # fmt: skip
_TAU1 = ("+", ("*", _M11, "qdd1"), ("*", _M12, "qdd2"),
         ("*", -1, "m2", "l1", "l2", ("sin", "q2"), ("**", "qd2", 2)),
         ("*", -2, "m2", "l1", "l2", ("sin", "q2"), "qd1", "qd2"), _G1)  # fmt: skip
_X = ("+", ("*", "l1", ("cos", "q1")), ("*", "l2", ("cos", _Q12)))
_Y = ("+", ("*", "l1", ("sin", "q1")), ("*", "l2", ("sin", _Q12)))
TRUE: dict[str, Tree] = {
    "g2": _G2, "g1": _G1, "M22": _M22, "M12": _M12, "M11": _M11, "tau2": _TAU2, "tau1": _TAU1,
    "x": _X, "y": _Y,
}  # fmt: skip

RARE = ("\\arc", "\\ln", "\\exp", "|", "operatorname")
"""LaTeX that kinlab need not know; most such formulas are left out."""

Undefined = (ValueError, ZeroDivisionError, OverflowError)


def value(tree: Tree, state: dict[str, float]) -> float:
    """Plain evaluation over the reals; raises where the formula has no real value."""
    if isinstance(tree, (int, float)):
        return float(tree)
    if isinstance(tree, str):
        return math.pi if tree == "pi" else state[tree]
    name, *rest = tree
    args = [value(part, state) for part in rest]
    if name == "+":
        return math.fsum(args)
    if name == "*":
        return math.prod(args)
    if name == "-":
        return args[0] - args[1]
    if name == "/":
        return args[0] / args[1]
    if name == "**":
        result = args[0] ** args[1]
        if isinstance(result, complex):
            raise ValueError("not real")
        return result
    if name == "abs":
        return abs(args[0])
    if name == "neg":
        return -args[0]
    return float(getattr(math, name)(*args))


def rewrites(rng: random.Random, u: Tree) -> tuple[str, Tree]:
    """Another form of u: some are u for every real, some for some, some undefined for some."""
    w = rng.choice(["q1", "q2", ("+", "q1", "q2"), ("sin", "q1"), ("cos", "q2"), "l1", "m2"])
    forms: list[tuple[str, Tree]] = [
        ("sqrt(u**2)", ("sqrt", ("**", u, 2))),
        ("(u**2)**0.5", ("**", ("**", u, 2), 0.5)),
        ("(u**2)**(1/2)", ("**", ("**", u, 2), ("/", 1, 2))),
        ("(u**4)**0.25", ("**", ("**", u, 4), 0.25)),
        ("sqrt(u)**2", ("**", ("sqrt", u), 2)),
        ("(u**3)**(1/3)", ("**", ("**", u, 3), ("/", 1, 3))),
        ("sqrt(u*u)", ("sqrt", ("*", u, u))),
        ("sqrt(u**4)/u", ("/", ("sqrt", ("**", u, 4)), u)),
        ("sqrt(u**2)**2/u", ("/", ("**", ("sqrt", ("**", u, 2)), 2), u)),
        ("abs(u)", ("abs", u)),
        ("abs(u)**2/u", ("/", ("**", ("abs", u), 2), u)),
        ("abs(-u)", ("abs", ("neg", u))),
        ("exp(log(u))", ("exp", ("log", u))),
        ("log(exp(u))", ("log", ("exp", u))),
        ("exp(log(u**2)/2)", ("exp", ("/", ("log", ("**", u, 2)), 2))),
        ("log(u**2)/2+u", ("-", ("+", ("/", ("log", ("**", u, 2)), 2), u), ("log", ("abs", u)))),
        ("log(u**2)-2log(u)+u", ("+", ("-", ("log", ("**", u, 2)), ("*", 2, ("log", u))), u)),
        ("atan(tan(u))", ("atan", ("tan", u))),
        ("tan(atan(u))", ("tan", ("atan", u))),
        ("asin(sin(u))", ("asin", ("sin", u))),
        ("sin(asin(u))", ("sin", ("asin", u))),
        ("acos(cos(u))", ("acos", ("cos", u))),
        ("cos(acos(u))", ("cos", ("acos", u))),
        ("atan2(sin u, cos u)", ("atan2", ("sin", u), ("cos", u))),
        ("u*w/w", ("/", ("*", u, w), w)),
        ("u*(w/w)", ("*", u, ("/", w, w))),
        ("u+w-w", ("-", ("+", u, w), w)),
        ("u*w**0", ("*", u, ("**", w, 0))),
        ("u*(w-w)**0", ("*", u, ("**", ("-", w, w), 0))),
        ("u*0**(w-w)", ("*", u, ("**", 0, ("-", w, w)))),
        ("u+0*log(w)", ("+", u, ("*", 0, ("log", w)))),
        ("u+0*sqrt(w)", ("+", u, ("*", 0, ("sqrt", w)))),
        ("u+0*asin(2*w)", ("+", u, ("*", 0, ("asin", ("*", 2, w))))),
        ("u*sqrt(w)/sqrt(w)", ("/", ("*", u, ("sqrt", w)), ("sqrt", w))),
        ("u*sqrt(w)*sqrt(w)/w", ("/", ("*", u, ("sqrt", w), ("sqrt", w)), w)),
        ("u*sqrt(w**2)/w", ("/", ("*", u, ("sqrt", ("**", w, 2))), w)),
        ("u*abs(w)/w", ("/", ("*", u, ("abs", w)), w)),
        ("u**2/u", ("/", ("**", u, 2), u)),
        ("1/(1/u)", ("/", 1, ("/", 1, u))),
        ("u*(s²+c²)", ("*", u, ("+", ("**", ("sin", w), 2), ("**", ("cos", w), 2)))),
        ("u*sqrt(1-s²)/cos", ("/", ("*", u, ("sqrt", ("-", 1, ("**", ("sin", w), 2)))), ("cos", w))),
        ("u*sqrt(s²+c²)", ("*", u, ("sqrt", ("+", ("**", ("sin", w), 2), ("**", ("cos", w), 2))))),
        ("-(-u)", ("neg", ("neg", u))),
        ("(2u)/2", ("/", ("*", 2, u), 2)),
        ("u**1", ("**", u, 1)),
        ("(u**-1)**-1", ("**", ("**", u, -1), -1)),
        ("(u**0.5)**2", ("**", ("**", u, 0.5), 2)),
        ("(-u)**2/u", ("/", ("**", ("neg", u), 2), u)),
        ("-u**2/-u", ("/", ("neg", ("**", u, 2)), ("neg", u))),
        ("sqrt(u)*sqrt(u)", ("*", ("sqrt", u), ("sqrt", u))),
        ("sqrt(u**2*w**2)/w", ("/", ("sqrt", ("*", ("**", u, 2), ("**", w, 2))), w)),
        ("sqrt(u**2)*w/sqrt(w**2)", ("/", ("*", ("sqrt", ("**", u, 2)), w), ("sqrt", ("**", w, 2)))),
        ("u", u),
    ]  # fmt: skip
    return rng.choice(forms)


def _places(tree: Tree, path: tuple[int, ...] = ()) -> list[tuple[int, ...]]:
    out = [path]
    if isinstance(tree, tuple):
        for i, part in enumerate(tree[1:], 1):
            out += _places(part, (*path, i))
    return out


def _at(tree: Tree, path: tuple[int, ...]) -> Tree:
    for i in path:
        tree = tree[i]
    return tree


def _put(tree: Tree, path: tuple[int, ...], new: Tree) -> Tree:
    if not path:
        return new
    i = path[0]
    return (*tree[:i], _put(tree[i], path[1:], new), *tree[i + 1 :])


def text(rng: random.Random, tree: Tree, level: int = 0) -> str:
    """The tree as text, with random spaces, parentheses and synonyms."""
    space = rng.choice(["", "", " "])
    if isinstance(tree, (int, float)):
        out, own = (repr(tree), 9 if tree >= 0 else 2)
    elif isinstance(tree, str):
        out, own = tree, 9
        if tree in ("q1", "q2") and rng.random() < 0.1:
            out = rng.choice(["theta", "th", "theta_"]) + tree[1]
    else:
        name, *rest = tree
        if name == "+":
            out, own = f"{space}+{space}".join(text(rng, part, 1) for part in rest), 0
        elif name == "-":
            out, own = f"{text(rng, rest[0], 0)}{space}-{space}{text(rng, rest[1], 2)}", 0
        elif name == "*":
            out, own = f"{space}*{space}".join(text(rng, part, 2) for part in rest), 1
        elif name == "/":
            out, own = f"{text(rng, rest[0], 1)}{space}/{space}{text(rng, rest[1], 3)}", 1
        elif name == "**":
            power = rng.choice(["**", "^"])
            out, own = f"{text(rng, rest[0], 4)}{power}{text(rng, rest[1], 3)}", 3
        elif name == "neg":
            out, own = f"-{text(rng, rest[0], 3)}", 2
            own = 0 if level > 0 else 2
        else:
            spelled = name
            if rng.random() < 0.2:
                spelled = {"asin": "arcsin", "acos": "arccos", "atan": "arctan", "log": "ln",
                           "atan2": "arctan2"}.get(name, name)  # fmt: skip
            out, own = f"{spelled}({', '.join(text(rng, part) for part in rest)})", 9
    if own < level or (rng.random() < 0.05 and own < 9):
        return f"({out})"
    return out


def latex(rng: random.Random, tree: Tree, level: int = 0) -> str:
    """The tree as LaTeX of the textbooks."""
    if isinstance(tree, (int, float)):
        out, own = (repr(tree), 9 if tree >= 0 else 0)
    elif isinstance(tree, str):
        head, tail = tree.rstrip("0123456789"), tree[len(tree.rstrip("0123456789")) :]
        symbol = rng.choice(["\\theta", "q"])
        if head in ("q", "qd", "qdd"):
            dot = {"q": symbol, "qd": f"\\dot{{{symbol}}}", "qdd": f"\\ddot{{{symbol}}}"}[head]
            out = f"{dot}_{tail}" if rng.random() < 0.5 else f"{dot}_{{{tail}}}"
        elif tree == "pi":
            out = "\\pi"
        else:
            out = f"{head}_{tail}" if tail else head
        own = 9
    else:
        name, *rest = tree
        open_, close = rng.choice([("(", ")"), ("\\left(", "\\right)")])
        if name == "+":
            out, own = " + ".join(latex(rng, part, 1) for part in rest), 0
        elif name == "-":
            out, own = f"{latex(rng, rest[0], 0)} - {latex(rng, rest[1], 2)}", 0
        elif name == "*":
            joint = rng.choice([" ", " \\cdot ", " \\, "])
            parts = [latex(rng, part, 2) for part in rest]
            if any(not isinstance(part, str) for part in rest):
                joint = " \\cdot "
            out, own = joint.join(parts), 1
        elif name == "/":
            out, own = f"\\frac{{{latex(rng, rest[0])}}}{{{latex(rng, rest[1])}}}", 3
        elif name == "**":
            out, own = f"{latex(rng, rest[0], 4)}^{{{latex(rng, rest[1])}}}", 3
        elif name == "neg":
            out, own = f"-{latex(rng, rest[0], 3)}", 0 if level > 0 else 2
        elif name == "sqrt":
            out, own = f"\\sqrt{{{latex(rng, rest[0])}}}", 9
        elif name == "abs":
            out, own = f"\\left|{latex(rng, rest[0])}\\right|", 9
        elif name == "log":
            out, own = f"\\ln{open_}{latex(rng, rest[0])}{close}", 9
        elif name in ("asin", "acos", "atan"):
            out, own = f"\\arc{name[1:]}{open_}{latex(rng, rest[0])}{close}", 9
        elif name == "atan2":
            inner = ", ".join(latex(rng, part) for part in rest)
            out, own = f"\\operatorname{{atan2}}{open_}{inner}{close}", 9
        else:
            out, own = f"\\{name}{open_}{latex(rng, rest[0])}{close}", 9
    if own < level:
        return f"\\left({out}\\right)"
    return out


def truth(tree: Tree, right: Tree, seed: int) -> str:
    """``agrees``, ``differs``, or ``open`` where few states, the arm's numbers or rounding decide."""
    said = {_truth(tree, right, seed, own) for own in (True, False)}
    return said.pop() if len(said) == 1 else "open"


def _truth(tree: Tree, right: Tree, seed: int, own: bool) -> str:
    rng = np.random.default_rng(seed)
    total, off, near = 300, 0, 0
    for row in rng.uniform(-3.0, 3.0, (total, len(STATES))):
        state = dict(zip(STATES, row.tolist(), strict=True))
        state |= NUMBERS if own else {key: float(rng.uniform(0.1, 5.0)) for key in NUMBERS}
        want = value(right, state)
        try:
            have = value(tree, state)
        except Undefined:
            off += 1
            continue
        if not math.isfinite(have):
            off += 1
        else:
            error = abs(have - want) / max(abs(want), 1e-3)
            off += error > 1e-5
            near += error > 1e-10
    if off >= 0.1 * total:
        return "differs"
    return "agrees" if near == 0 and off == 0 else "open"


def cases(seed: int, count: int, typeset: bool) -> list[tuple[str, Any]]:
    """Formulas with a rewritten part; label, and (entry, text, typeset, truth)."""
    rng = random.Random(seed)
    out: list[tuple[str, Any]] = []
    while len(out) < count:
        entry = rng.choice(list(TRUE))
        right = tree = TRUE[entry]
        done = []
        for _ in range(rng.choice([1, 1, 2])):
            place = rng.choice(_places(tree))
            name, new = rewrites(rng, _at(tree, place))
            tree = _put(tree, place, new)
            done.append(name)
        verdict = truth(tree, right, rng.randrange(1 << 30))
        if verdict == "open":
            continue
        written = (latex if typeset else text)(rng, tree)
        if typeset and rng.random() < 0.8 and any(word in written for word in RARE):
            continue
        out.append(
            (f"{entry} = {written}  [{', '.join(done)}]", (entry, written, typeset, verdict))
        )
    return out


def judge(case: tuple[str, str, bool, str]) -> tuple[str, str]:
    """The verdict of ``kinlab check file.toml --json`` beside the plain evaluation."""
    import sys

    from kinlab.cli import main

    entry, written, typeset, verdict = case
    with tempfile.TemporaryDirectory() as folder:
        file = Path(folder) / "formulas.toml"
        table = "latex" if typeset else "formulas"
        file.write_text(
            f'robot = "planar2r"\n[{table}]\n{entry} = {json.dumps(written)}\n', encoding="utf-8"
        )
        printed, before = io.StringIO(), sys.argv
        try:
            sys.argv = ["kinlab", "check", str(file), "--json"]
            with contextlib.redirect_stdout(printed), contextlib.redirect_stderr(printed):
                main()
            code: Any = 0
        except SystemExit as end:
            code = end.code or 0
        finally:
            sys.argv = before
    if code == 2:
        return "refused", printed.getvalue()[:200]
    said = json.loads(printed.getvalue())["formulas"][0]["verdict"]
    agrees = "agree" in said and "differ" not in said
    if agrees and verdict == "differs":
        return "wrong", f"said {said!r}, but plain evaluation differs"
    if not agrees and verdict == "agrees":
        return "wrong", f"said {said!r}, but plain evaluation agrees"
    return "right", said
