"""Programs as students write them, all right; one slip at a time put into their text; and what a
diagnosis says should stand there, put back.

Nothing here knows what the doctor tries: slips are made on tokens, repairs are read from sentences.
"""

from __future__ import annotations

import ast
import copy
import io
import random
import re
import tokenize
from dataclasses import dataclass
from pathlib import Path

import numpy as np

import kinlab as kl
from kinlab.check.diagnosis import Cause
from kinlab.doctor.changes import Case
from kinlab.doctor.examine import prepare
from kinlab.doctor.program.read import read
from kinlab.doctor.program.search.repair import LineSearch


@dataclass(frozen=True)
class OwnProgram:
    """A right program: its robot, its quantity, its text; the function is called ``f``."""

    robot: str
    quantity: str
    text: str


PROGRAMS = {
    "planar fk": OwnProgram(
        "planar2r",
        "fk",
        '''
import numpy as np

l1, l2 = 0.5, 0.4

def f(q):
    """The tool of a planar arm."""
    q1, q2 = q
    x = l1 * np.cos(q1) + l2 * np.cos(q1 + q2)
    y = l1 * np.sin(q1) + l2 * np.sin(q1 + q2)
    c, s = np.cos(q1 + q2), np.sin(q1 + q2)
    return np.array([[c, -s, 0, x],
                     [s, c, 0, y],
                     [0, 0, 1, 0],
                     [0, 0, 0, 1]])
''',
    ),
    "planar jacobian": OwnProgram(
        "planar2r",
        "jacobian",
        """
from math import cos, sin
import numpy as np

def f(q):
    l1 = 0.5
    l2 = 0.4
    s1, c1 = sin(q[0]), cos(q[0])
    s12, c12 = sin(q[0] + q[1]), cos(q[0] + q[1])
    J = np.zeros((6, 2))
    J[0, 0] = -l1 * s1 - l2 * s12
    J[0, 1] = -l2 * s12
    J[1, 0] = l1 * c1 + l2 * c12
    J[1, 1] = l2 * c12
    J[5, 0] = 1
    J[5, 1] = 1
    return J
""",
    ),
    "planar mass matrix": OwnProgram(
        "planar2r",
        "mass_matrix",
        """
import numpy as np

m1, m2 = 2.0, 1.5
l1, l2 = 0.5, 0.4

def f(q):
    c2 = np.cos(q[1])
    M11 = m1 * l1**2 + m2 * (l1**2 + l2**2 + 2 * l1 * l2 * c2)
    M12 = m2 * (l2**2 + l1 * l2 * c2)
    M22 = m2 * l2**2
    return np.array([[M11, M12], [M12, M22]])
""",
    ),
    "planar torques": OwnProgram(
        "planar2r",
        "inverse_dynamics",
        """
import numpy as np

m1, m2, l1, l2, g = 2.0, 1.5, 0.5, 0.4, 9.81

def f(q, qd, qdd):
    t1, t2 = q
    w1, w2 = qd
    a1, a2 = qdd
    c1, c2, c12 = np.cos(t1), np.cos(t2), np.cos(t1 + t2)
    s2 = np.sin(t2)
    # Craig's example, both lines
    tau1 = (m2 * l2**2 * (a1 + a2) + m2 * l1 * l2 * c2 * (2 * a1 + a2)
            + (m1 + m2) * l1**2 * a1 - m2 * l1 * l2 * s2 * w2**2
            - 2 * m2 * l1 * l2 * s2 * w1 * w2
            + m2 * l2 * g * c12 + (m1 + m2) * l1 * g * c1)
    tau2 = (m2 * l1 * l2 * c2 * a1 + m2 * l1 * l2 * s2 * w1**2
            + m2 * l2 * g * c12 + m2 * l2**2 * (a1 + a2))
    return np.array([tau1, tau2])
""",
    ),
    "planar energy": OwnProgram(
        "planar2r",
        "kinetic_energy",
        """
import numpy as np

m1, m2 = 2.0, 1.5

def f(q, qd):
    l1, l2 = 0.5, 0.4
    v1 = l1 * qd[0]
    w = qd[0] + qd[1]
    v2sq = v1**2 + l2**2 * w**2 + 2 * l2 * v1 * w * np.cos(q[1])
    T1 = 0.5 * m1 * v1**2
    T2 = 0.5 * m2 * v2sq
    return T1 + T2
""",
    ),
    "rods mass matrix": OwnProgram(
        "planar2r_rods",
        "mass_matrix",
        """
import numpy as np

m = [2.0, 1.5]
l = [0.5, 0.4]

def f(q):
    M = np.zeros((2, 2))
    cx, cy = [], []
    lc1, lc2 = l[0] / 2, l[1] / 2
    Jv1 = np.array([[-lc1 * np.sin(q[0]), 0], [lc1 * np.cos(q[0]), 0]])
    Jv2 = np.array([[-l[0] * np.sin(q[0]) - lc2 * np.sin(q[0] + q[1]), -lc2 * np.sin(q[0] + q[1])],
                    [l[0] * np.cos(q[0]) + lc2 * np.cos(q[0] + q[1]), lc2 * np.cos(q[0] + q[1])]])
    Jw = [np.array([[1, 0]]), np.array([[1, 1]])]
    for i, Jv in enumerate([Jv1, Jv2]):
        I = m[i] * l[i]**2 / 12
        M += m[i] * Jv.T @ Jv + I * Jw[i].T @ Jw[i]
    return M
""",
    ),
    "dh fk": OwnProgram(
        "puma560",
        "fk",
        """
import numpy as np
from numpy import cos, sin, pi

a = [0, 0.4318, 0.0203, 0, 0, 0]
alpha = [pi/2, 0, -pi/2, pi/2, -pi/2, 0]
d = [0, 0, 0.15005, 0.4318, 0, 0]

def A(theta, d, a, alpha):
    ct, st = cos(theta), sin(theta)
    ca, sa = cos(alpha), sin(alpha)
    return np.array([[ct, -st * ca, st * sa, a * ct],
                     [st, ct * ca, -ct * sa, a * st],
                     [0, sa, ca, d],
                     [0, 0, 0, 1]])

def f(q):
    T = np.eye(4)
    for i in range(6):
        T = T @ A(q[i], d[i], a[i], alpha[i])
    return T
""",
    ),
    "dh jacobian": OwnProgram(
        "puma560",
        "jacobian",
        """
import numpy as np

ROWS = [(0, np.pi/2, 0), (0.4318, 0, 0), (0.0203, -np.pi/2, 0.15005),
        (0, np.pi/2, 0.4318), (0, -np.pi/2, 0), (0, 0, 0)]

def link(th, row):
    a, al, d = row
    Rz = np.array([[np.cos(th), -np.sin(th), 0, 0], [np.sin(th), np.cos(th), 0, 0],
                   [0, 0, 1, d], [0, 0, 0, 1]])
    Rx = np.array([[1, 0, 0, a], [0, np.cos(al), -np.sin(al), 0],
                   [0, np.sin(al), np.cos(al), 0], [0, 0, 0, 1]])
    return Rz @ Rx

def f(q):
    frames = [np.eye(4)]
    for i in range(6):
        frames.append(frames[-1] @ link(q[i], ROWS[i]))
    pe = frames[6][:3, 3]
    J = np.zeros((6, 6))
    for i in range(6):
        z = frames[i][:3, 2]
        p = frames[i][:3, 3]
        J[:3, i] = np.cross(z, pe - p)
        J[3:, i] = z
    return J
""",
    ),
    "three links gravity": OwnProgram(
        "planar3r",
        "gravity_torques",
        """
import numpy as np

class Arm:
    m = [3.0, 2.0, 1.0]
    l = [0.5, 0.4, 0.25]
    g = 9.81

def f(q):
    arm = Arm()
    a = np.cumsum(q)
    lc = [x / 2 for x in arm.l]
    out = np.zeros(3)
    for k in range(3):
        total = 0.0
        for i in range(k, 3):
            x = lc[i] * np.cos(a[i])
            for j in range(k, i):
                x += arm.l[j] * np.cos(a[j])
            total += arm.m[i] * arm.g * x
        out[k] = total
    return out
""",
    ),
    "three links statics": OwnProgram(
        "planar3r",
        "statics",
        """
import numpy as np

def f(q, W):
    l1, l2, l3 = 0.5, 0.4, 0.25
    th1 = q[0]
    th2 = q[0] + q[1]
    th3 = q[0] + q[1] + q[2]
    x3, y3 = l3 * np.cos(th3), l3 * np.sin(th3)
    x2, y2 = x3 + l2 * np.cos(th2), y3 + l2 * np.sin(th2)
    x1, y1 = x2 + l1 * np.cos(th1), y2 + l1 * np.sin(th1)
    fx, fy, nz = W[0], W[1], W[5]
    return np.array([x1 * fy - y1 * fx + nz,
                     x2 * fy - y2 * fx + nz,
                     x3 * fy - y3 * fx + nz])
""",
    ),
    "newton-euler": OwnProgram(
        "planar3r",
        "inverse_dynamics",
        """
import numpy as np

L = np.array([0.5, 0.4, 0.25])
m = np.array([3.0, 2.0, 1.0])
IZZ = m * L**2 / 12
Z = np.array([0.0, 0.0, 1.0])

def Rot(t):
    return np.array([[np.cos(t), -np.sin(t), 0], [np.sin(t), np.cos(t), 0], [0, 0, 1]])

def f(q, qd, qdd):
    w = np.zeros(3)
    wd = np.zeros(3)
    vd = np.array([0, 9.81, 0])
    F, N = [], []
    r = np.zeros(3)
    for i in range(3):
        R = Rot(q[i]).T
        vd = R @ (np.cross(wd, r) + np.cross(w, np.cross(w, r)) + vd)
        w = R @ w + qd[i] * Z
        wd = R @ wd + qdd[i] * Z
        r = np.array([L[i], 0, 0])
        rc = r / 2
        ac = vd + np.cross(wd, rc) + np.cross(w, np.cross(w, rc))
        F.append(m[i] * ac)
        N.append(IZZ[i] * wd)
    ff = np.zeros(3)
    nn = np.zeros(3)
    tau = np.zeros(3)
    for i in range(2, -1, -1):
        R = Rot(q[i + 1]) if i < 2 else np.eye(3)
        r = np.array([L[i], 0, 0])
        fi = R @ ff
        nn = R @ nn + N[i] + np.cross(r / 2, F[i]) + np.cross(r, fi)
        ff = fi + F[i]
        tau[i] = nn @ Z
    return tau
""",
    ),
    "three links potential": OwnProgram(
        "spatial3r",
        "gravity_torques",
        """
import numpy as np

TABLE = np.array([[0.0, 0.0, 0.0], [0.45, 0.0, 0.0], [0.35, np.pi/2, 0.0]])
MASS = np.array([3.0, 2.0, 1.2])
COM = np.array([[0.2, 0.02, -0.01], [0.15, -0.01, 0.03], [0.12, 0.03, 0.01]])

def step(a, alpha, d, t):
    ca, sa, ct, st = np.cos(alpha), np.sin(alpha), np.cos(t), np.sin(t)
    return np.array([[ct, -st, 0, a], [st * ca, ct * ca, -sa, -d * sa],
                     [st * sa, ct * sa, ca, d * ca], [0, 0, 0, 1]])

def f(q):
    g = np.array([0, 0, -9.81])
    T = np.eye(4)
    zs, ps, cs = [], [], []
    for k in range(3):
        T = T @ step(*TABLE[k], q[k])
        zs.append(T[:3, 2])
        ps.append(T[:3, 3])
        cs.append(T[:3, :3] @ COM[k] + T[:3, 3])
    tau = np.zeros(3)
    for i in range(3):
        for k in range(i, 3):
            tau[i] -= MASS[k] * g @ np.cross(zs[i], cs[k] - ps[i])
    return tau
""",
    ),
}


# -------- A slip, made on tokens


EXPONENTIALS = """
import numpy as np

def exp6(screw, theta):
    w, v = screw[:3], screw[3:]
    W = np.array([[0, -w[2], w[1]], [w[2], 0, -w[0]], [-w[1], w[0], 0]])
    G = np.eye(3)*theta + (1 - np.cos(theta))*W + (theta - np.sin(theta))*W @ W
    T = np.eye(4)
    T[:3, :3] = np.eye(3) + np.sin(theta)*W + (1 - np.cos(theta))*W @ W
    T[:3, 3] = G @ v
    return T

HOME = np.array([[1, 0, 0, 0.9], [0, 1, 0, 0], [0, 0, 1, 0], [0, 0, 0, 1.0]])
S1, S2 = np.array([0, 0, 1, 0, 0, 0.0]), np.array([0, 0, 1, 0, -0.5, 0])

def f(q):
    return exp6(S1, q[0]) @ exp6(S2, q[1]) @ HOME
"""
BACK = """
import numpy as np
from math import cos, pi, sin

def step(alpha, a, t):
    R = np.array([[cos(t), -sin(t), 0], [sin(t)*cos(alpha), cos(t)*cos(alpha), -sin(alpha)],
                  [sin(t)*sin(alpha), cos(t)*sin(alpha), cos(alpha)]])
    return R, np.array([a, 0.0, 0.0])

def f(q, wrench):
    R1, P1 = step(0, 0, q[0])
    R2, P2 = step(0, 0.45, q[1])
    R3, P3 = step(pi/2, 0.35, q[2])
    to = (R1 @ R2 @ R3).T
    push, turn = to @ wrench[:3], to @ wrench[3:]
    n3 = turn + np.cross([0.3, 0, 0], push)
    f2 = R3 @ push
    n2 = R3 @ n3 + np.cross(P3, f2)
    f1 = R2 @ f2
    n1 = R2 @ n2 + np.cross(P2, f1)
    return np.array([n1[2], n2[2], n3[2]])
"""
"""Statics of spatial3r, from the tool back to the base."""


def with_slips(text: str, slips: list[tuple[str, str]]) -> str:
    """A text with other pieces for some that stand in it once."""
    for old, new in slips:
        assert text.count(old) == 1, old
        text = text.replace(old, new)
    return text


def slipped(text: str, seed: int) -> tuple[str, int] | None:
    """A text with one slip of the pen, and its line; None where this throw makes none."""
    dice = random.Random(seed)
    tokens = [t for t in tokenize.generate_tokens(io.StringIO(text).readline) if t.string.strip()]
    lines = text.splitlines()
    inside = [k for k, t in enumerate(tokens[:-3]) if _bare(lines[t.start[0] - 1])]
    for _throw in range(50):
        k = dice.choice(inside)
        found = dice.choice(_SLIPS)(tokens, k, dice)
        if found is None:
            continue
        first, last, new = found  # tokens first..last become new
        row, begin, end = tokens[first].start[0], tokens[first].start[1], tokens[last].end[1]
        if tokens[last].end[0] != row:
            continue
        line = lines[row - 1]
        changed = line[:begin] + new + line[end:]
        whole = "\n".join([*lines[: row - 1], changed, *lines[row:]]) + "\n"
        try:
            ast.parse(whole)
        except SyntaxError:
            continue
        if ast.dump(ast.parse(whole)) != ast.dump(ast.parse(text)):
            return whole, row
    return None


def _bare(line: str) -> bool:
    return not line.strip().startswith(("import", "from", "def", "class", "#", '"""'))


def _sign(tokens, k, dice):
    other = {"+": "-", "-": "+", "+=": "-=", "-=": "+="}.get(tokens[k].string)
    return None if other is None else (k, k, other)


def _function(tokens, k, dice):
    other = {"sin": "cos", "cos": "sin"}.get(tokens[k].string)
    return None if other is None else (k, k, other)


def _digit(tokens, k, dice):
    """l2 for l1, t1 for t12, m2 for m1: names that occur."""
    name = tokens[k].string
    stem = name.rstrip("0123456789")
    known = sorted({t.string for t in tokens if re.fullmatch(re.escape(stem) + r"\d+", t.string)})
    if not name.isidentifier() or name == stem or len(known) < 2:
        return None
    return k, k, dice.choice([other for other in known if other != name])


def _index(tokens, k, dice):
    if tokens[k].type != tokenize.NUMBER or tokens[k - 1].string not in ("[", ",", ":"):
        return None
    if not tokens[k].string.isdigit():
        return None
    return k, k, str(max(0, int(tokens[k].string) + dice.choice((1, -1))))


def _shifted(tokens, k, dice):
    if tokens[k].string in ("i", "j", "k") and tokens[k + 1].string in ("]", ",", ")"):
        return k, k, tokens[k].string + dice.choice((" + 1", " - 1"))
    return None


def _power(tokens, k, dice):
    return (k, k + 1, "") if tokens[k].string == "**" else None


def _transpose(tokens, k, dice):
    return (k, k + 1, "") if (tokens[k].string, tokens[k + 1].string) == (".", "T") else None


def _factor(tokens, k, dice):
    if tokens[k].type == tokenize.NUMBER and tokens[k + 1].string == "*":
        return k, k + 1, ""
    if tokens[k].string == "/" and tokens[k + 1].type == tokenize.NUMBER:
        return k, k + 1, ""
    return None


def _another(tokens, k, dice):
    """Another name of the same line."""
    row = tokens[k].start[0]
    names = sorted({t.string for t in tokens if t.type == tokenize.NAME and t.start[0] == row})
    if tokens[k].type != tokenize.NAME or len(names) < 2:
        return None
    return k, k, dice.choice(names)


def _left_out(tokens, k, dice):
    """One factor of a product."""
    if tokens[k].string in ("*", "@") and tokens[k + 1].string.isidentifier():
        return (k, k + 1, "") if tokens[k + 2].string not in (".", "(", "[") else None
    return None


def _number(tokens, k, dice):
    text = tokens[k].string
    if tokens[k].type != tokenize.NUMBER or "." not in text:
        return None
    return k, k, repr(round(float(text) * dice.choice((2, 0.5, 1.1, 10)) + 0.0, 6))


_SLIPS = (_sign, _sign, _function, _digit, _index, _shifted, _power, _transpose, _factor,
          _another, _left_out, _number)  # fmt: skip


# -------- What is said, put into the text

_LINE = re.compile(r"after line (?P<line>\d+)(?: \(in \w+\))?, a line is missing: `(?P<new>[^`]*)`")
_SAID = re.compile(
    r"line (?P<line>\d+)(?: of \S+)?(?: \(in (?P<part>\w+)\))?, "
    r"(?:[^`]*: `(?P<old>[^`]*)` should be `(?P<new>[^`]*)`"
    r"|`(?P<moved>[^`]*)`: [^;`]*; it should stand (?P<side>before|after) line (?P<to>\d+)"
    r"|`(?P<dropped>[^`]*)`: the line is one too many)"
)
_OF_DATA = re.compile(
    r"(?:^|[;:] )(?:line \d+, )?(?P<name>[A-Za-z_]\w*)(?P<keys>(?:\[[^\]]*\])*), [^`:;]*: "
    r"(?P<old>[-+.e\d]+) should be (?P<new>[-+.e\d]+)"
)
_OF_ARRAY = re.compile(
    r"(?:^|[;:] )(?:line \d+, )?(?P<name>[A-Za-z_]\w*)(?P<keys>(?:\[[^\]]*\])*), "
    r"(?P<what>the sign|the transpose) is wrong(?=$|;)"
)


_OF_EXCHANGE = re.compile(r"entries are exchanged: `[^`]*` should be `(?P<new>[^`]*)`")
_SET = re.compile(r"[A-Za-z_]\w*(?:\[[^\]]*\])* = [-+.e\d]+")


def names_a_line(sentence: str) -> bool:
    """Whether a sentence says what should stand in the program."""
    return any(p.search(sentence) for p in (_SAID, _OF_DATA, _OF_ARRAY))


def lines_named(sentence: str) -> list[int]:
    return [int(found["line"]) for found in _SAID.finditer(sentence)]


def repaired(text: str, sentence: str):
    """Every program that follows from a sentence, as what it defines: fresh name spaces.

    Of two places that do equally the first is taken.
    """
    sentence = sentence.partition("; or else ")[0]
    trees = [ast.parse(text)]
    for found in _SAID.finditer(sentence):
        trees = [after for tree in trees for after in _with(tree, found)]
    for found in _LINE.finditer(sentence):
        trees = [after for tree in trees for after in _with_line(tree, found)]
    for tree in trees:
        space = {"__name__": "repaired"}
        exec(compile(ast.fix_missing_locations(tree), "<repaired>", "exec"), space)  # noqa: S102  texts of the tests
        for found in _OF_DATA.finditer(sentence):
            _data(space, found, float(found["new"]))
        for found in _OF_ARRAY.finditer(sentence):
            _data(space, found, None)
        for exchange in _OF_EXCHANGE.finditer(sentence):
            for found in _SET.finditer(exchange["new"]):
                exec(found[0], space)  # noqa: S102  texts of the tests
        yield space


def _typed(node: ast.AST) -> str:
    return re.sub(r" (\*\*|\*|/) ", r"\1", ast.unparse(node).partition("\n")[0].rstrip(":"))


def _with(tree: ast.Module, found: re.Match[str]):
    """The trees in which a sentence's repair stands, one for each place that it may mean."""
    number = int(found["line"])
    old = found["old"] or found["moved"] or found["dropped"]
    for k, one in enumerate(ast.walk(tree)):
        first, last = getattr(one, "lineno", 0), getattr(one, "end_lineno", 0)
        if not first <= number <= last or _typed(one) != old:
            continue
        fresh = copy.deepcopy(tree)
        node = [*ast.walk(fresh)][k]
        if found["new"] is not None:
            new = _parsed(found["new"], node)
            if new is not None and _replace(fresh, node, new):
                yield fresh
        elif isinstance(node, ast.stmt):
            _replace(fresh, node, ast.copy_location(ast.Pass(), node))
            if found["moved"] is None or _put(fresh, node, found["side"], int(found["to"])):
                yield fresh


def _with_line(tree: ast.Module, found: re.Match[str]):
    """The trees in which a line stands that was missing: behind another one, or first in a loop."""
    number = int(found["line"])
    blocks = [k for k, one in enumerate(ast.walk(tree)) if hasattr(one, "body")]
    for k in blocks:
        fresh = copy.deepcopy(tree)
        node = [*ast.walk(fresh)][k]
        line = ast.parse(found["new"]).body[0]
        for name in ("body", "orelse"):
            block = getattr(node, name, None)
            for j, one in enumerate(block if isinstance(block, list) else []):
                if one.end_lineno == number or (j == 0 and getattr(node, "lineno", 0) == number):
                    block.insert(j + (one.end_lineno == number), line)
                    yield fresh
                    break


def _parsed(text: str, node: ast.AST) -> ast.AST | None:
    if isinstance(node, ast.For | ast.If | ast.While):
        new = ast.parse(text + ":\n    pass").body[0]
        new.body, new.orelse = node.body, node.orelse
        return new
    try:
        body = ast.parse(text).body
    except SyntaxError:
        return _slice(text)
    if len(body) != 1:
        return None
    return (
        body[0].value if isinstance(node, ast.expr) and isinstance(body[0], ast.Expr) else body[0]
    )


def _slice(text: str) -> ast.AST | None:
    try:
        return ast.parse(f"x[{text}]").body[0].value.slice
    except SyntaxError:
        return None


def _replace(tree: ast.AST, old: ast.AST, new: ast.AST) -> bool:
    for parent in ast.walk(tree):
        for name, value in ast.iter_fields(parent):
            if value is old:
                setattr(parent, name, new)
                return True
            if isinstance(value, list):
                for k, one in enumerate(value):
                    if one is old:
                        value[k] = new
                        return True
    return False


def _put(tree: ast.AST, node: ast.stmt, side: str, line: int) -> bool:
    for parent in ast.walk(tree):
        for value in (getattr(parent, "body", None), getattr(parent, "orelse", None)):
            for k, one in enumerate(value if isinstance(value, list) else []):
                if one.lineno == line and not isinstance(one, ast.Pass):
                    value.insert(k if side == "before" else k + 1, node)
                    return True
    return False


def _data(space: dict, found: re.Match[str], new: float | None) -> None:
    keys = [ast.literal_eval(key) for key in re.findall(r"\[([^\]]*)\]", found["keys"])]
    space[found["name"]] = _changed(space[found["name"]], keys, found, new)


def _changed(value, keys, found, new):
    """A copy with another number in it, or all of it with another sign or transposed."""
    if keys:
        if isinstance(value, tuple):
            inner = _changed(value[keys[0]], keys[1:], found, new)
            return (*value[: keys[0]], inner, *value[keys[0] + 1 :])
        fresh = copy.deepcopy(value)
        fresh[keys[0]] = _changed(value[keys[0]], keys[1:], found, new)
        return fresh
    if new is None:
        return -value if found["what"] == "the sign" else np.transpose(value)
    old = float(found["old"])  # of 1.5708 told, the digits that are not told stay
    assert abs(value - old) <= 1e-5 * abs(old)
    return value * (new / old) if old else new


def written(text, file=None):
    """The ``f`` of a text, in a module of its own."""
    space = {"__name__": "hand"}
    code = compile(text, str(file or "<no file>"), "exec", dont_inherit=True)
    exec(code, space)  # noqa: S102  texts of the tests
    return space["f"]


def searched(robot, quantity, text, beside=1.0):
    """A search in a program, right or wrong, for what lies beside the engine's answers."""
    case, engine = prepare(robot, quantity, (), 10, 3)
    f = written(text)
    states = zip(*case.arguments.values(), strict=True)
    hand = np.array([f(*map(np.copy, state)) for state in states], dtype=float)
    program = read(f)
    assert program is not None
    return LineSearch(program, Case(**{**vars(case), "hand": hand}), engine + beside, 1e-9)


def asked(text, robot, quantity, file=None):
    """What is said of a text, or of a file of it, and whether it is right once that stands in it."""
    if file is not None:
        file.write_text(text)
    found = kl.diagnose(robot, quantity, written(text, file), samples=20)
    assert not found.agrees
    case, engine = prepare(robot, quantity, (), 10, 3)
    states = [*zip(*case.arguments.values(), strict=True)]
    good = False
    for after in repaired(text, found.sentence):
        values = np.array([after["f"](*map(np.copy, state)) for state in states])
        good |= bool(np.allclose(values, engine, rtol=1e-9, atol=1e-9))
    return found, good


def told_in_its_line(
    robot: str, quantity: str, text: str, right: str, slip: str, file: Path | None = None
) -> Cause:
    """The only cause that is told of a program with a slip: in its line, and what is said makes
    the program right.

    Args:
        robot, quantity, text: a right program.
        right, slip: what stands there, and what instead.
        file: where the program is written to, if its lines outside of functions are read, too.
    """
    wrong = with_slips(text, [(right, slip)])
    if file is not None:
        file.write_text(wrong)
    found = kl.diagnose(robot, quantity, written(wrong, *([] if file is None else [file])))
    assert not found.agrees and len(found.causes) == 1, found
    (cause,) = found.causes
    line = wrong[: wrong.index(slip)].count("\n") + 1
    assert f"line {line}" in " ".join(cause.places) and len(cause.kinds) == 1, found
    others = [*repaired(wrong, cause.sentence)]
    assert any(kl.diagnose(robot, quantity, one["f"]).agrees for one in others), cause.sentence
    return cause
