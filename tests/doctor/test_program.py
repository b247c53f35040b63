"""The doctor of programs: what it says should stand there makes the program right; what is not
plain arithmetic it does not try; what is the user's stays as it was."""

from __future__ import annotations

import ast
import copy
import functools
import os
import re
import subprocess
import sys
import textwrap
import types
from pathlib import Path

import numpy as np
import pytest
from hand_programs import PROGRAMS, lines_named, names_a_line, repaired, slipped, written

import kinlab as kl
from kinlab.doctor.examine import prepare
from kinlab.doctor.program.read import read
from kinlab.doctor.program.trial import FieldChange, NoProgramError, Trial
from kinlab.doctor.program.words import _WHAT
from kinlab.host.language import _, speaking

HEAD = "import numpy as np\nfrom math import cos, sin\nl1, l2 = 0.5, 0.4\n"
TAIL = """
    c, s = cos(q[0] + q[1]), sin(q[0] + q[1])
    return np.array([[c, -s, 0, x], [s, c, 0, y], [0, 0, 1, 0], [0, 0, 0, 1]])
"""
WRONG = (
    """
def f(q):
    x = l1*cos(q[0]) - l2*cos(q[0] + q[1])
    y = l1*sin(q[0]) + l2*sin(q[0] + q[1])"""
    + TAIL
)
SHOULD = (
    "`x = l1*cos(q[0]) - l2*cos(q[0] + q[1])` should be `x = l1*cos(q[0]) + l2*cos(q[0] + q[1])`"
)


@pytest.fixture
def student(tmp_path):
    """Loads a text as a module of a file; ``None`` for a file: of no file at all."""

    def load(text, file="hand.py", **more):
        path = "<no file>"
        if file is not None:
            path = str(tmp_path / file)
            (tmp_path / file).write_text(text)
        space = {"__name__": "hand", **more}
        exec(compile(text, path, "exec"), space)  # noqa: S102  texts of this file
        return space

    return load


def said(function, robot="planar2r", quantity="fk"):
    found = kl.diagnose(robot, quantity, function, samples=20)
    assert not found.agrees
    return found.sentence


def answers(function, program):
    case, _engine = prepare(program.robot, program.quantity, (), 10, 3)
    stacks = case.arguments.values()
    with np.errstate(all="ignore"):
        return np.array([function(*map(np.copy, state)) for state in zip(*stacks, strict=True)])


# -------- What it says makes the program right


def judged(name, seed, load):
    """What became of one slip: exact, elsewhere (and right), derivation, unknown, false; or None."""
    program = PROGRAMS[name]
    slip = slipped(program.text, seed)
    if slip is None:
        return None
    text, line = slip
    right = answers(load(program.text, None)["f"], program)
    try:
        function = load(text, f"hand{seed}.py")["f"]
        values = answers(function, program)
    except (IndexError, ValueError, TypeError, NameError, AttributeError, ZeroDivisionError):
        return None
    if values.shape != right.shape or not np.isfinite(values).all():
        return None
    same = np.abs(values - right).max() <= 1e-10 * np.abs(right).max()
    found = kl.diagnose(program.robot, program.quantity, function)
    assert found.agrees == same, (text, found.sentence)
    if same:
        return None
    if not found.causes or not names_a_line(found.causes[0].sentence):
        return "derivation" if found.causes else "unknown"
    sentence = found.causes[0].sentence
    for space in repaired(text, sentence):
        repair = answers(space["f"], program)
        if np.abs(repair - right).max() <= 1e-8 * np.abs(right).max():
            return "exact" if lines_named(sentence) in ([line], []) else "elsewhere"
    return f"false: {sentence}"


QUICK = ("planar fk", "planar jacobian", "planar mass matrix", "planar energy", "dh fk")


@pytest.mark.parametrize("name", QUICK)
def test_what_it_says_makes_it_right(name, student) -> None:
    tried = (judged(name, 1000 * k, student) for k in range(1, 9))
    mark = next(one for one in tried if one is not None)
    assert mark in ("exact", "elsewhere", "derivation", "unknown"), mark


@pytest.mark.campaign
@pytest.mark.parametrize("name", PROGRAMS)
def test_no_repair_is_false(name, student) -> None:
    marks = [judged(name, seed, student) for seed in range(2000, 2040)]
    told = [one for one in marks if one is not None]
    assert not [one for one in told if one.startswith("false")]
    assert sum(one == "exact" for one in told) >= 0.6 * len(told)


@pytest.mark.parametrize("name", PROGRAMS)
def test_a_right_program_is_right(name, student) -> None:
    program = PROGRAMS[name]
    assert kl.diagnose(
        program.robot, program.quantity, student(program.text)["f"], samples=20
    ).agrees


@pytest.mark.parametrize(
    ("name", "slips"),
    [
        ("planar fk", [("x = l1 * np.cos(q1) +", "x = l1 * np.cos(q1) -"), ("y = l1 *", "y = l2 *")]),
        ("planar jacobian", [("l1 * s1 - l2", "l1 * s1 + l2"), ("J[1, 1] = l2", "J[1, 1] = l1")]),
        pytest.param(
            "three links statics",
            [("x1 * fy - y1", "x1 * fy + y1"), ("x2 * fy -", "x2 * fx -"),
             ("x3 * fy - y3", "x3 * fy - y2")],
            marks=pytest.mark.campaign),
    ],
)  # fmt: skip
def test_several_slips(name, slips, student) -> None:
    program = PROGRAMS[name]
    text = program.text
    for right, wrong in slips:
        assert text.count(right) == 1
        text = text.replace(right, wrong)
    sentence = said(student(text)["f"], program.robot, program.quantity)
    changed = {k for k, line in enumerate(text.splitlines(), 1) if line not in program.text}
    assert {*lines_named(sentence)} <= changed
    wanted = answers(student(program.text, None)["f"], program)
    repairs = [answers(space["f"], program) for space in repaired(text, sentence)]
    assert any(np.allclose(one, wanted, rtol=1e-9, atol=1e-9) for one in repairs)


def test_a_repair_holds_at_every_state(student) -> None:
    """One sign makes the first states right; elsewhere a second slip stands."""
    case, _engine = prepare("planar2r", "fk", (), 20, 0)
    first = float(case.arguments["q"][:2, 0].max())
    assert (case.arguments["q"][:, 0] > first).any()
    end = "    if q[0] > 0:\n        x = x + 0.3*exp(q[0])" + TAIL
    text = (
        HEAD
        + "from math import exp\n"
        + WRONG.replace(TAIL, "\n" + end.replace("0:", f"{first!r}:", 1))
    )
    sentence = said(student(text)["f"])
    right = answers(student(HEAD + WRONG.replace("- l2", "+ l2"), None)["f"], PROGRAMS["planar fk"])
    for space in repaired(text, sentence) if names_a_line(sentence) else ():
        assert np.allclose(answers(space["f"], PROGRAMS["planar fk"]), right)


# -------- Lines are those of the file


FILES = {
    "comments": (HEAD + "# one\n\n# two\n" + WRONG, 9, "f"),
    "docstring": (HEAD + WRONG.replace("def f(q):\n", 'def f(q):\n    """A\n\n\n    b."""\n'), 10, "f"),
    "decorated": (HEAD + "def same(g):\n    return g\n\n@same\n@same" + WRONG, 10, "f"),
    "nested": (
        HEAD + "def make():" + textwrap.indent(WRONG, "    ") + "    return f\n\nf = make()\n", 6, "f"),
    "part": (HEAD + WRONG.replace("def f", "def g") + "\ndef f(q):\n    return g(q)\n", 6, "f"),
}  # fmt: skip


@pytest.mark.parametrize("name", FILES)
@pytest.mark.parametrize("file", ["hand.py", None])
def test_the_line_is_that_of_the_file(name, file, student) -> None:
    text, line, function = FILES[name]
    sentence = said(student(text, file)[function])
    assert SHOULD in sentence
    assert lines_named(sentence) == [line]
    assert text.splitlines()[line - 1].strip() in SHOULD


def test_a_method_and_its_line(student) -> None:
    text = HEAD + "class Arm:\n    def __init__(self):\n        self.n = 2\n"
    text += textwrap.indent(WRONG.replace("def f(q)", "def f(self, q)"), "    ")
    sentence = said(student(text)["Arm"]().f)
    assert lines_named(sentence) == [9]
    assert SHOULD in sentence


def test_what_is_no_plain_function_is_judged_all_the_same(student) -> None:
    space = student(HEAD + WRONG)
    called = type("Called", (), {"__call__": lambda self, q: space["f"](q)})()
    for one in (functools.partial(space["f"]), called):
        assert kl.diagnose("planar2r", "fk", one, samples=20).causes


@pytest.mark.parametrize(
    "text",
    [
        "class Arm:\n    def __init__(self):\n        self.__l = l1\n"
        + textwrap.indent(WRONG, "    ").replace("f(q)", "f(self, q)").replace("l1*", "self.__l*")
        + "\nf = Arm().f\n",
        WRONG.replace("def f", "class A:\n    pass\n\ndef g")
        + "\nclass B(A):\n    def f(self, q):\n        super().__init__()\n        return g(q)\n"
        "\nf = B().f\n",
    ],
    ids=["a private name", "super"],
)
def test_methods_that_stand_in_no_other_place_are_judged(text, student) -> None:
    assert kl.diagnose("planar2r", "fk", student(HEAD + text)["f"], samples=20).causes


def test_what_wraps_a_function_is_not_left_out(student) -> None:
    """The source of a wrapped function is not what is called: degrees, in the wrapper."""
    text = HEAD + "import functools\n"
    text += "def degrees(g):\n    @functools.wraps(g)\n    def inner(q):\n"
    text += "        return g(np.deg2rad(q))\n    return inner\n\n@degrees"
    text += WRONG.replace("- l2", "+ l2")
    sentence = said(student(text)["f"])
    assert "deg" in sentence
    assert not set(lines_named(sentence)) - {8}


# -------- What is not tried


@pytest.mark.parametrize(
    "use",
    [
        "import pinocchio as pin\n    pin.neutral",
        "import kinlab",
        "import os",
        "from subprocess import run",
        "open",
        "np.savetxt('x', q)",
        "np.asarray(q).tofile('x')",
        "getpid()",
        "cached(0.0)",
        "part(0)",
        "method()",
        "log.append(1)",
        "memo[0] = 1",
        "seen.append(1)",
        "itertools.count()",
        "(yield)",
        "yield from q",
        "global l1\n    l1 = 0.5",
        "while q[0]:\n        try:\n            pass\n        finally:\n            pass",
        "with open('x'):\n        pass",
        "with cached:\n        pass",
        "time.sleep(1)",
    ],
)
def test_what_reaches_out_is_not_tried(use, student) -> None:
    head = (
        HEAD + "import functools, itertools\nfrom os import getpid\nimport os\nlog, memo = [], {}\n"
    )
    head += "cached = functools.lru_cache(sin)\npart = functools.partial(os.kill)\n"
    head += "method = types.MethodType(os.kill, 3)\n"
    text = head + WRONG.replace("f(q):", f"f(q, seen=[]):\n    {use}")
    assert read(student(text, types=types)["f"]) is None
    assert read(student(head + WRONG, types=types)["f"]) is not None


def test_what_calls_another_module_runs_only_as_it_is(student, monkeypatch) -> None:
    seen = []
    outside = types.ModuleType("outside")
    outside.mark = lambda q: seen.append(sys._getframe(1).f_code)
    monkeypatch.setitem(sys.modules, "outside", outside)
    text = HEAD + "import outside\n" + WRONG.replace("f(q):", "f(q):\n    outside.mark(q)")
    function = student(text)["f"]
    said(function)
    assert {*seen} == {function.__code__}


def test_nothing_of_the_users_is_touched(student, capsys) -> None:
    text = HEAD + textwrap.dedent("""
        A = np.array([0.5, 0.4])
        TABLE = {"a": [0.5, 0.4], "deep": {"b": (1.0, np.eye(2))}}
        WORK = np.zeros(2)

        class Arm:
            kept = [0.5, 0.4]

            def __init__(self):
                self.l = [0.5, 0.4]

        arm = Arm()

        def g(q, scale=[1.0, 1.0]):
            print("asked", q)
            WORK[0] = TABLE["a"][0] * cos(q[0]) * scale[0]
            return WORK[0] - arm.l[1] * Arm.kept[0] / 0.5 * cos(q[0] + q[1])
    """)
    text += WRONG.replace("x = l1*cos(q[0]) - l2*cos(q[0] + q[1])", "x = g(q)")
    text = text.replace("+ l2*sin", "+ A[1]*sin")
    space = student(text)
    kept = ("A", "TABLE", "l1", "l2")

    def held():
        own = [copy.deepcopy(space[name]) for name in kept]
        own += [vars(space["arm"]), [*space["Arm"].kept], space["g"].__defaults__]
        return copy.deepcopy([own, space["f"].__code__.co_code, sorted(space)])

    before = held()
    sentence = said(space["f"])
    assert "should be" in sentence
    np.testing.assert_equal(held(), before)
    assert space["g"].__globals__ is space
    printed = capsys.readouterr().out
    space["f"](np.zeros(2))
    assert printed.count("asked") == printed.count("\n")  # nothing but what the user's own prints


def test_an_edit_does_not_write_into_the_users_array(student) -> None:
    """Without the product the program would write into ``T0``."""
    text = HEAD + textwrap.dedent("""
        T0 = np.eye(4)
        TURN = np.eye(4)

        def f(q):
            T = T0 @ TURN
            T[0, 3] += l1*cos(q[0]) - l2*cos(q[0] + q[1])*0.9
            T[1, 3] += l1*sin(q[0]) + l2*sin(q[0] + q[1])*0.9
            c, s = cos(q[0] + q[1]), sin(q[0] + q[1])
            T[:2, :2] = [[c, -s], [s, c]]
            return T
    """)
    space = student(text)
    said(space["f"])
    assert (space["T0"] == np.eye(4)).all()
    assert (space["TURN"] == np.eye(4)).all()


def test_an_edit_does_not_write_into_data_that_only_the_module_has(student) -> None:
    """An edit that takes ``G`` for ``out`` would write into it: it is an array of two, too."""
    text = HEAD + textwrap.dedent("""
        G = np.array([0.0, -9.81])
        ALSO = [0.0, -9.81]
        M = [2.0, 1.5]

        def f(q):
            out = np.zeros(2)
            x = np.cumsum(q)
            for i in range(2):
                for j in range(i + 1):
                    out[j] += M[i]*9.81*sum([l1, l2][k]*cos(x[k]) for k in range(j, i + 1))*1.3
                    out[j] -= M[i]*np.array([0, 0.0, -9.81])@np.array([q[j], 1.0, 0.1])
            return out
    """)
    space = student(text)
    said(space["f"], quantity="gravity_torques")
    assert space["G"].tolist() == space["ALSO"] == [0.0, -9.81]


def test_a_file_that_was_changed_since_is_not_believed(student, tmp_path) -> None:
    function = student(HEAD + WRONG)["f"]
    (tmp_path / "hand.py").write_text(
        HEAD + WRONG.replace("- l2", "+ l2").replace("+ l2*s", "- l2*s")
    )
    sentence = said(function)
    assert "l2*sin(q[0]" not in sentence
    assert 7 not in lines_named(sentence)


ENDLESS = {
    "while": "    t, k = 0.0, 0\n    x = y = 0.0\n    while k < 2:\n        t += q[k]\n"
    "        x = x + (l1, l2)[k]*cos(t)\n        y = y - (l1, l2)[k]*sin(t)\n        k = k + 1\n",
    "recursion": "    x = l1*cos(q[0]) - l2*cos(q[0] + q[1])*fib(5)/5\n"
    "    y = l1*sin(q[0]) + l2*sin(q[0] + q[1])\n",
    "range": "    n = 1000\n    x = sum([l1*cos(q[0])/n for k in range(n)]) - l2*cos(q[0] + q[1])\n"
    "    y = l1*sin(q[0]) + l2*sin(q[0] + q[1])\n",
}


@pytest.mark.parametrize("name", ENDLESS)
def test_edits_that_would_never_end(name, student) -> None:
    """Every edit of these was tried; that this test ends is what it is about."""
    text = (
        HEAD + "def fib(n):\n    if n < 2:\n        return n\n    return fib(n - 1) + fib(n - 2)\n"
    )
    sentence = said(student(text + "\ndef f(q):\n" + ENDLESS[name] + TAIL[1:])["f"])
    assert "the sign is wrong" in sentence
    assert "_turn" not in sentence


def test_what_ends_a_loop_is_not_shown(student) -> None:
    text = ENDLESS["while"].replace("y - (l1", "y + (l1").replace("k < 2", "k < 1")
    sentence = said(student(HEAD + "\ndef f(q):\n" + text + TAIL[1:])["f"])
    assert "while" in sentence
    assert "_turn" not in sentence


# -------- The same answer


ASKED = """
import sys
sys.path.insert(0, {tests!r})
import kinlab as kl
from hand_programs import PROGRAMS, written
for name, old, new in {slips!r}:
    f = written(PROGRAMS[name].text.replace(old, new))
    print(kl.diagnose("planar2r", PROGRAMS[name].quantity, f, samples=20).sentence)
"""
SLIPS = (
    ("planar fk", "c, s = np.cos", "c, s = np.sin"),
    ("planar jacobian", "s1, c1 = sin(q[0])", "s1, c1 = sin(q[1])"),
)


def test_the_same_answer_in_another_process(student) -> None:
    """With other hashes of names, and on the routines of another processor."""
    program = ASKED.format(tests=str(Path(__file__).parents[1]), slips=SLIPS)
    run = subprocess.run(
        [sys.executable, "-c", program],
        env={**os.environ, "PYTHONHASHSEED": "7", "OPENBLAS_CORETYPE": "Nehalem"},
        capture_output=True,
        text=True,
        check=True,
    )
    here = [
        said(student(PROGRAMS[name].text.replace(old, new), None)["f"], "planar2r", quantity)
        for name, old, new in SLIPS
        for quantity in [PROGRAMS[name].quantity]
    ]
    assert run.stdout.splitlines() == here
    assert all("should be" in one for one in here)


def test_the_same_answer_twice(student) -> None:
    function = student(HEAD + WRONG)["f"]
    assert said(function) == said(function)


# -------- In Chinese


def test_in_chinese(student) -> None:
    with speaking("zh_CN"):
        sentence = said(student(HEAD + WRONG)["f"])
    assert "`x = l1*cos(q[0]) + l2*cos(q[0] + q[1])`" in sentence
    assert "第 6 行" in sentence
    assert "符号有误" in sentence
    assert not re.search(r"[A-Za-z]{2,}", re.sub(r"`[^`]*`", "", sentence))


@pytest.mark.parametrize("kind", sorted(_WHAT))
def test_every_kind_is_said_in_chinese(kind) -> None:
    with speaking("zh_CN"):
        told = _(_WHAT[kind])
    assert not re.search(r"[A-Za-z]", told)


def test_functions_of_numpy_that_are_imported_by_name_are_read(student) -> None:
    source = """from numpy import array, cos, cross, sin
def f(q):
    z = array([0.0, 0.0, 1.0])
    o2 = array([0.5 * cos(q[0]), 0.5 * sin(q[0]), 0.0])
    p = o2 + array([0.4 * cos(q[0] + q[1]), 0.4 * sin(q[0] + q[1]), 0.0])
    one, two = cross(z, p), cross(p - o2, z)
    return array([[one[0], two[0]], [one[1], two[1]], [1.0, 1.0]])
"""
    space = student(source, file=None)
    arm = kl.load("planar2r")
    found = kl.diagnose(arm, "planar_jacobian", space["f"], samples=40)
    assert found.causes[0].places[0] == "line 6", found


def test_changes_that_stand_are_seen_through_what_else_is_changed(student) -> None:
    source = """
def a(x): return 2.0 * x
def b(x): return a(x) + 1.0
def c(x): return 10.0 * x
def f(x): return b(x) + c(x)
"""
    space = student(source, file=None)
    trial = Trial(read(space["f"]))

    def other(name: str, old: float, new: float):
        k = [part.name for part in trial.program.parts].index(name)
        nodes = (n for n in ast.walk(trial.trees[k]) if isinstance(n, ast.Constant))
        node = next(n for n in nodes if n.value == old)
        return trial.changed({k}, [FieldChange(node, "value", new)])

    with other("c", 10.0, 20.0):
        assert trial.function(3.0) == 6.0 + 1.0 + 60.0
        with other("a", 2.0, 5.0):
            assert trial.function(3.0) == 15.0 + 1.0 + 60.0
        assert trial.function(3.0) == 6.0 + 1.0 + 60.0
    with other("a", 2.0, 5.0):
        assert trial.function(3.0) == 15.0 + 1.0 + 30.0  # nothing is left of what stood before
        with other("c", 10.0, 20.0), other("b", 1.0, 0.0):
            assert trial.function(3.0) == 15.0 + 0.0 + 60.0
    assert trial.function(3.0) == 6.0 + 1.0 + 30.0


def test_an_edit_that_would_hold_itself_is_no_program() -> None:
    trial = Trial(read(written("def g(x):\n    return x\n\ndef f(q):\n    return g(q[0])")))
    part = next(k for k, tree in enumerate(trial.trees) if tree.name == "f")
    call = next(node for node in ast.walk(trial.trees[part]) if isinstance(node, ast.Call))
    change = FieldChange(call.args, 0, call)
    with pytest.raises(NoProgramError), trial.changed({part}, [change]):
        raise AssertionError("it was compiled")
