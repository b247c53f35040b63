"""What a student's program is made of beside plain functions: generators, the lines of a module
that run when it is loaded, what wraps or makes a function. A slip in each is told with its line."""

from __future__ import annotations

import ast
import contextlib
import importlib.util
import re
import sys
import textwrap

import numpy as np
import pytest
from hand_programs import lines_named

import kinlab as kl
from kinlab.doctor.program.read import read
from kinlab.doctor.program.trial import FailedError, FieldChange, Trial

RODS = "planar2r_rods"
"""Lengths 0.5 and 0.4, masses 2 and 1.5, uniform rods, y up."""


@pytest.fixture
def load(tmp_path, monkeypatch):
    """Loads a text as a module of a file, or without one."""
    monkeypatch.syspath_prepend(str(tmp_path))

    def loaded(text, name="homework", file=True, **beside):
        for other, own in beside.items():
            (tmp_path / f"{other}.py").write_text(own)
            monkeypatch.delitem(sys.modules, other, raising=False)
        if not file:
            space = {}
            exec(text, space)  # noqa: S102  texts of this file
            return space
        (tmp_path / f"{name}.py").write_text(text)
        spec = importlib.util.spec_from_file_location(name, tmp_path / f"{name}.py")
        module = importlib.util.module_from_spec(spec)
        monkeypatch.setitem(sys.modules, name, module)
        spec.loader.exec_module(module)
        return vars(module)

    return loaded


LOADED = """
import numpy as np
from math import cos
L = [0.5, 0.4]
m1, m2 = 2.0, 1.5
LC = [x/2 for x in L]
I1 = m1*L[0]**2/12
I2 = m2*L[1]**2/12
P = [m1*LC[0]**2, 0.0]
P[1] = m2*LC[1]**2

def f(q):
    h = m2*L[0]*LC[1]*cos(q[1])
    d = I2 + P[1]
    return np.array([[I1 + P[0] + m2*L[0]**2 + 2*h + d, h + d], [h + d, d]])
"""
MATRICES = """
import numpy as np
from numpy import cos, sin

def rot(t):
    return np.array([[cos(t), -sin(t), 0, 0], [sin(t), cos(t), 0, 0], [0, 0, 1, 0], [0, 0, 0, 1.0]])

def trans(x, y, z):
    T = np.eye(4)
    T[:3, 3] = [x, y, z]
    return T

l1, l2 = 0.5, 0.4
A1 = trans(l1, 0, 0)
A2 = trans(l2, 0, 0)
CHAIN = [A1, A2]

def f(q):
    T = np.eye(4)
    for t, A in zip(q, CHAIN):
        T = T @ rot(t) @ A
    return T
"""
YIELDS = """
import numpy as np
l, m = (0.5, 0.4), (2.0, 1.5)

def angles(q):
    yield 0, q[0]
    yield from rest(q)

def rest(q):
    yield 1, q[0] + q[1]

def centres(q):
    p = np.zeros(2)
    for i, angle in angles(q):
        u = np.array([np.cos(angle), np.sin(angle)])
        yield m[i], p + l[i]/2*u
        p = p + l[i]*u

def f(q):
    return sum(mi*9.81*p[1] for mi, p in centres(q))
"""
WRAPPED = """
import numpy as np
from functools import lru_cache, partial
l, m = (0.5, 0.4), (2.0, 1.5)

@lru_cache(maxsize=None)
def inertia(i):
    return m[i]*l[i]**2/12

def along(k, t):
    return np.array([np.cos(t), np.sin(t), 0])*k

half, whole = partial(along, 0.5), partial(along, 1.0)

def f(q):
    M = np.zeros((2, 2))
    t, p, axes = 0.0, np.zeros(3), []
    z = np.array([0, 0, 1.0])
    for i in range(2):
        t += q[i]
        axes.append(p)
        c = p + l[i]*half(t)
        p = p + l[i]*whole(t)
        J = np.zeros((3, 2))
        w = np.zeros(2)
        for j in range(i + 1):
            J[:, j] = np.cross(z, c - axes[j])
            w[j] = 1
        M += m[i]*J.T @ J + inertia(i)*np.outer(w, w)
    return M
"""
INNER = """
import numpy as np

def f(q):
    x, y, t = 0.0, 0.0, 0.0

    def add(a, dt):
        nonlocal x, y, t
        t += dt
        x += a*np.cos(t)
        y += a*np.sin(t)

    for a, dt in zip((0.5, 0.4), q):
        add(a, dt)
    c, s = np.cos(t), np.sin(t)
    return np.array([[c, -s, 0, x], [s, c, 0, y], [0, 0, 1, 0], [0, 0, 0, 1]])
"""
MADE = """
import numpy as np

def make(m1, m2, l1=0.5, l2=0.4):
    lc1, lc2 = l1/2, l2/2
    I1 = m1*l1**2/12
    I2 = m2*l2**2/12

    def mass(q):
        h = m2*l1*lc2*np.cos(q[1])
        d = I2 + m2*lc2**2
        return np.array([[I1 + m1*lc1**2 + m2*l1**2 + 2*h + d, h + d], [h + d, d]])

    return mass

f = make(2.0, 1.5)
"""
CLASSES = """
import numpy as np

class Rods:
    l, m = [0.5, 0.4], [2.0, 1.5]
    I = [m[0]*l[0]**2/12, m[1]*l[1]**2/12]

    def __init__(self, share):
        self.lc1, self.lc2 = self.l[0]*share, self.l[1]*share

    @property
    def last(self):
        return self.I[1] + self.m[1]*self.lc2**2

    @staticmethod
    def squared(x):
        return x**2

    def mass(self, q):
        h = self.m[1]*self.l[0]*self.lc2*np.cos(q[1])
        first = self.I[0] + self.m[0]*self.squared(self.lc1) + self.m[1]*self.squared(self.l[0])
        return np.array([[first + 2*h + self.last, h + self.last], [h + self.last, self.last]])

rods = Rods(0.5)

def f(q):
    return rods.mass(q)
"""
FIELDS = """
import numpy as np
from dataclasses import dataclass

@dataclass
class Rod:
    l: float
    m: float
    g: float = 9.81

    def weight(self):
        return self.m*self.g

    @classmethod
    def first(cls):
        return cls(0.5, 2.0)

one, two = Rod.first(), Rod(0.4, 1.5)

def f(q):
    y1 = one.l/2*np.sin(q[0])
    y2 = one.l*np.sin(q[0]) + two.l/2*np.sin(q[0] + q[1])
    return one.weight()*y1 + two.weight()*y2
"""
DEFAULTS = """
import numpy as np

def energy(q, l1=0.5, l2=0.4, m1=2.0, *, m2=1.5):
    y1 = l1/2*np.sin(q[0])
    y2 = l1*np.sin(q[0]) + l2/2*np.sin(q[0] + q[1])
    return m1*9.81*y1 + m2*9.81*y2

def f(q):
    return energy(q)
"""
TWO_FILES = """
import numpy as np
from moving import rot, trans

def f(q):
    return rot(q[0]) @ trans(0.5, 0) @ rot(q[1]) @ trans(0.4, 0)
"""
MOVING = """
import numpy as np

def rot(t):
    T = np.eye(4)
    T[:2, :2] = [[np.cos(t), -np.sin(t)], [np.sin(t), np.cos(t)]]
    return T

def trans(x, y):
    T = np.eye(4)
    T[:2, 3] = x, y
    return T
"""
SLIPS = {
    "a constant of others": (LOADED, "mass_matrix", "L[1]**2/12", "L[1]/12"),
    "an entry written later": (LOADED, "mass_matrix", "P[1] = m2*LC[1]**2", "P[1] = m2*L[1]**2"),
    "a matrix of the module": (MATRICES, "fk", "trans(l2, 0, 0)", "trans(-l2, 0, 0)"),
    "a list of matrices": (MATRICES, "fk", "CHAIN = [A1, A2]", "CHAIN = [A2, A1]"),
    "what the module calls": (MATRICES, "fk", "[x, y, z]", "[y, x, z]"),
    "a generator": (YIELDS, "potential_energy", "p = p + l[i]*u", "p = p - l[i]*u"),
    "yield from": (YIELDS, "potential_energy", "yield 1, q[0] + q[1]", "yield 1, q[0] - q[1]"),
    "a cache": (WRAPPED, "mass_matrix", "l[i]**2/12", "l[i]/12"),
    "a partial": (WRAPPED, "mass_matrix", "np.sin(t), 0", "np.sin(k), 0"),
    "nonlocal": (INNER, "fk", "y += a*np.sin(t)", "y += a*np.cos(t)"),
    "a factory": (MADE, "mass_matrix", "l1/2, l2/2", "l1/2, l1/2"),
    "a class's body": (CLASSES, "mass_matrix", "m[1]*l[1]**2/12]", "m[1]*l[1]/12]"),
    "what makes an object": (CLASSES, "mass_matrix", "self.l[1]*share", "self.l[0]*share"),
    "a property": (CLASSES, "mass_matrix", "self.I[1] + self", "self.I[0] + self"),
    "a static method": (CLASSES, "mass_matrix", "return x**2", "return x**3"),
    "a dataclass's method": (FIELDS, "potential_energy", "self.m*self.g", "self.m/self.g"),
    "a default": (DEFAULTS, "potential_energy", "l2=0.4", "l2=0.3"),
    "a default by name": (DEFAULTS, "potential_energy", "m2=1.5", "m2=1.2"),
    "another file": (TWO_FILES, "fk", "[[np.cos(t), -np.sin", "[[np.cos(t), np.sin"),
}
WITHOUT_FILE = (
    "a generator",
    "yield from",
    "a cache",
    "a partial",
    "nonlocal",
    "a factory",
    "a property",
    "a static method",
    "a default",
)
WAYS = [(name, True) for name in SLIPS] + [(name, False) for name in WITHOUT_FILE]


@pytest.mark.many
@pytest.mark.parametrize(("name", "file"), WAYS)
def test_a_slip_is_told_with_its_line_and_its_repair(name, file, load):
    right, quantity, old, new = SLIPS[name]
    text, moving = right.replace(old, new), MOVING.replace(old, new)
    assert (text, moving) != (right, MOVING)
    found = kl.diagnose(RODS, quantity, load(text, file=file, moving=moving)["f"], samples=20)
    (row,) = [
        (number, line)
        for one, own in ((right, text), (MOVING, moving))
        for number, (line, other) in enumerate(
            zip(one.split("\n"), own.split("\n"), strict=True), start=1
        )
        if line != other
    ]
    assert lines_named(found.sentence) == [row[0]]
    (told,) = re.findall(r"should be `(.*?)`", found.sentence)
    assert re.sub(r"[ ().]", "", told) in re.sub(r"[ ().]", "", row[1])


@pytest.mark.parametrize("text", sorted({one[0] for one in SLIPS.values()}))
def test_what_is_read_answers_as_the_program_does(text, load):
    function = load(text, moving=MOVING)["f"]
    trial = Trial(read(function))
    q = np.array([0.3, -0.7])
    np.testing.assert_allclose(trial.function(q.copy()), function(q), rtol=1e-12)
    with trial.as_loaded():
        trial.load()
        np.testing.assert_allclose(trial.function(q.copy()), function(q), rtol=1e-12)


FELT = {
    "what prints": ("shift = [0.0*lone, print('loaded')][0]", "None"),
    "random numbers": ("shift = lone*0*np.random.rand()", "np.random.get_state()[2]"),
    "random numbers by name": (
        "from numpy.random import rand\nshift = lone*0*rand()",
        "np.random.get_state()[2]",
    ),
    "a source of them": (
        "rng = np.random.default_rng(4)\nshift = lone*0*rng.normal()",
        "rng.bit_generator.state",
    ),
    "an iterator": (
        "turns = iter([1.0, 2.0, 3.0])\nfor turn in turns:\n    shift = 0*lone*turn\n    break",
        "turns.__length_hint__()",
    ),
    "a file": ("shift = 0*lone*len(open(__file__).read())", "None"),
    "a list that is kept": (
        "kept = []\ndef noted(x):\n    kept.append(x)\n    return x\nshift = noted(0*lone)",
        "kept",
    ),
    "a list that is given": (
        "kept = []\ndef noted(box, x):\n    box.append(str(x))\n    return x\n"
        "shift = noted(kept, 0*lone)",
        "kept",
    ),
    "what makes objects": (
        "kept = []\nclass Base:\n    def __init__(self, x):\n        kept.append(x)\n"
        "        self.x = x\nclass Own(Base):\n    pass\nobject_ = Own(0*lone)\n"
        "shift = object_.x",
        "kept",
    ),
    "a function's own list": (
        "class Own:\n    kept = []\n    def note(self, x):\n        self.kept.append(x)\n"
        "        return x\nown = Own()\nnote = own.note\nshift = note(0*lone)",
        "Own.kept",
    ),
}


@pytest.mark.parametrize("name", FELT)
def test_what_is_felt_when_a_module_is_loaded_happens_once(name, load, capsys, monkeypatch):
    lines, state = FELT[name]
    space = load(f"import numpy as np\nlone = 0.5*1\n{lines}\nl2 = 0.2*2\n" + BELOW)
    before, opened = repr(eval(state, space)), []  # noqa: S307  texts of this file
    capsys.readouterr()
    program = read(space["f"])
    monkeypatch.setitem(space, "open", lambda *_given: opened.append(1))
    trial = Trial(program)
    for length in (0.25, 0.3, 0.35):
        part = len(trial.trees) - 1
        held = [node for node in ast.walk(trial.trees[part]) if isinstance(node, ast.Constant)]
        change = FieldChange(held[0], "value", length)
        with trial.changed({part}, [change]), contextlib.suppress(RuntimeError, StopIteration):
            trial.function(np.array([0.3, -0.7]))
    found = kl.diagnose(RODS, "fk", space["f"], samples=20)
    assert "`l2*c`" in found.sentence or "- l2*s" in found.sentence
    assert repr(eval(state, space)) == before  # noqa: S307
    assert capsys.readouterr().out == ""
    assert not opened


BELOW = """
def f(q):
    c, s = np.cos(q[0] + q[1]), np.sin(q[0] + q[1])
    x = lone*np.cos(q[0]) + l2*c + shift
    y = lone*np.sin(q[0]) - l2*s
    return np.array([[c, -s, 0, x], [s, c, 0, y], [0, 0, 1, 0], [0, 0, 0, 1]])
"""


def test_a_trial_leaves_what_the_module_made_as_it_was(load):
    space = load(CLASSES.replace("self.l[1]*share", "self.l[0]*share"))
    rods, kept = space["rods"], dict(vars(space["Rods"]))
    assert kl.diagnose(RODS, "mass_matrix", space["f"], samples=20).causes
    assert vars(rods) == {"lc1": 0.25, "lc2": 0.25}
    assert space["rods"] is rods
    assert dict(vars(space["Rods"])) == kept


def test_lines_that_do_not_give_what_is_there_are_left_alone(load):
    """A module whose names were set anew from outside, or whose lines take long."""
    space = load(LOADED)
    space["I2"] = 0.5
    assert not Trial(read(space["f"])).sets
    long = LOADED.replace("P[1] =", "for n in range(10**5):\n    P[1] = n\nP[1] =")
    assert not Trial(read(load(long, "long")["f"])).sets
    assert Trial(read(load(LOADED, "short")["f"])).sets


def test_what_makes_much_is_left_alone(load):
    large = "B = np.arange(10**6)*1.0\nI1 = B[1]*m1*L[0]**2/12"
    text = LOADED.replace("I1 = m1*L[0]**2/12", large)
    assert Trial(read(load(text)["f"])).sets == ["I2", "LC", "P"]


def test_a_tuple_with_names_is_no_table(load):
    head = "import numpy as np\nfrom collections import namedtuple\n"
    head += "Rods = namedtuple('Rods', 'a b')\nk = Rods(0.25*2, 0.4)\nlone, l2, shift = *k, 0.0\n"
    body = BELOW.replace("l2", "k.b")
    for file in (True, False):
        found = kl.diagnose(RODS, "fk", load(head + body, file=file)["f"], samples=20)
        assert lines_named(found.sentence) in ([10], [])
        assert not found.agrees


def test_a_class_that_is_registered_is_registered_once(load):
    head = "import numpy as np\nmade = []\nclass Base:\n    def __init_subclass__(cls):\n"
    head += "        made.append(cls.__name__)\nclass Rods(Base):\n    lone, l2 = 0.5, 0.4\n"
    head += "lone, l2, shift = 0.5, 0.4, 0.0\nrods = Rods()\n"
    space = load(head + BELOW.replace("l2", "rods.l2"))
    assert not kl.diagnose(RODS, "fk", space["f"], samples=20).agrees
    assert space["made"] == ["Rods"]


def test_an_edit_of_data_runs_the_lines_that_use_them(load):
    function = load(LOADED)["f"]
    trial = Trial(read(function))
    other = load(LOADED.replace("L = [0.5, 0.4]", "L = [0.5, 0.3]"), "other")["f"]
    q = np.array([0.3, -0.7])
    with trial.changed({-1}, [FieldChange(trial.space["L"], 1, 0.3)]):
        np.testing.assert_allclose(trial.function(q.copy()), other(q), rtol=1e-12)
    np.testing.assert_allclose(trial.function(q.copy()), function(q), rtol=1e-12)


def test_a_name_that_is_set_later_is_not_put_in(load):
    """An edit of a line knows only what the lines above it have set."""
    text = LOADED.replace("I1 = m1*L[0]**2/12", "I1 = m1*L[0]**2/12 + I3").replace(
        "m1, m2 =", "I3 = 0.0*1\nm1, m2 ="
    )
    trial = Trial(read(load(text)["f"]))
    tree = trial.trees[-1]
    moved = [*tree.body[1:], tree.body[0]]
    change = FieldChange(tree, "body", moved)
    with (
        trial.changed({len(trial.trees) - 1}, [change]),
        pytest.raises(FailedError, match="NameError"),
    ):
        trial.function(np.zeros(2))
    assert np.isfinite(trial.function(np.zeros(2))).all()


def test_a_generator_that_is_asked_for_is_no_formula(load):
    text = textwrap.dedent("""
        def f(q):
            yield q[0]
    """)
    assert read(load(text)["f"]) is None
