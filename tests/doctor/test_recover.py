"""A function without source text gives its syntax tree back, or says nothing."""

from __future__ import annotations

import ast
import dis
import inspect
import textwrap
import types
from pathlib import Path

import numpy as np
import pytest

import kinlab
from kinlab.doctor.bytecode.instructions import alike
from kinlab.doctor.bytecode.recover import recovered

PROGRAMS = {
    "straight": """
        def f(q):
            '''Two links.'''
            l1, l2 = (0.4, 0.3)
            c1, s1 = (cos(q[0]), sin(q[0]))
            c12, s12, one = (cos(q[0] + q[1]), sin(q[0] + q[1]), 1.0)
            (a, b), c = ((l1, l2), q[-1])
            x = y = l1 * c1 + l2 * c12
            x -= l1 / 2 ** a
            y += b // 3 % 2 + c
            return np.array([x, y, -s1 * s12, one])
    """,
    "numpy": """
        def f(q):
            J = np.zeros((3, 2))
            R = np.eye(3)
            for i in range(2):
                J[:, i] = np.cross(R[:3, 2], np.array([q[i], 1, 0.5]))
                J[:2, i] *= 2
                J[0, i] -= i
                R = R @ np.array([[cos(q[i]), -sin(q[i]), 0], [sin(q[i]), cos(q[i]), 0], [0, 0, 1]])
            J[2] += J[::2, 0].sum() + J[..., 1:][0].max() + J[None, 0, 1][0]
            return J.T @ R
    """,
    "guards": """
        def f(q):
            if q[0] > 0.5:
                return 1
            if q[0] is None or (not q[1] and q[0] < 0):
                return 2
            if 0 < q[0] <= 0.2 < q[1]:
                return 3
            assert q[1] is not None, 'no q'
            if len(q) > 3:
                raise ValueError('too many')
            return 4
    """,
    "chain": """
        def f(q):
            out = []
            for x in (-1.0, 0.0, 0.5, 1.0, q[0]):
                if x == 0:
                    s = 'none'
                elif x < 0:
                    s = 'minus'
                elif x > 0.7 and x != 2:
                    s = 'much'
                else:
                    s = 'some'
                out.append(s)
            return out
    """,
    "loops": """
        def f(q):
            tau = [0] * 3
            for i, (a, b) in enumerate(zip(q, q[1:])):
                for j in reversed(range(3)):
                    if j == i:
                        continue
                    if a > 0.9:
                        break
                    tau[j] -= a * b
                else:
                    tau[0] += 1
            n = 0
            while n < 10 and tau[0] < 100:
                n += 1
                if n == 3:
                    continue
                tau[0] += n
                if tau[0] > 20:
                    break
            return (tau, n)
    """,
    "found": """
        def f(q):
            for i, x in enumerate(q):
                if x > 0.6:
                    break
            else:
                i = -1
            k = 5
            while k > i:
                k -= 1
                if k == 2:
                    break
            else:
                k = 100
            return (i, k)
    """,
    "ternaries": """
        def f(q):
            a = q[0] if q[0] > 0 else -q[0]
            b = np.array([1 if a > 0.3 else 2, a and 3, q[1] or 4, (a or b0) if a else b0])
            c = sum(x if x > 0 else 0 for x in q) + (1 if a < 0.1 else 2 if a < 0.2 else 3)
            d = a if a > 0.5 and c else c
            return (b, c, d, not a, a if not b0 else None)
    """,
    "comprehensions": """
        def f(q):
            A = [[i * j + q[0] for j in range(3) if j != i] for i in range(3)]
            m = {k: v for k, v in zip('ab', q)}
            s = {round(x, 3) for x in q if x > 0 and x < 1}
            t = sum((x * y for x in q for y in q if x < y))
            return (A, m, s, t, [*q, 1], {**m, 'c': 3}, max((abs(x) for x in q), default=0))
    """,
    "nested": """
        def f(q):

            def A(i, th=0.5, *, d=1):
                return th + q[i] * d

            def count():
                nonlocal n
                n += 1
                return n
            n = 0
            g = lambda x, y=2: x * y if x > 0 else A(0)
            h = lambda: n
            return (A(0) + g(A(1, d=2)), count(), count(), h())
    """,
    "calls": """
        def f(q):
            args = (1, 2)
            kw = {'z': 3}

            def g(*a, **k):
                return (a, sorted(k.items()))
            return (g(*args), g(0, *args, w=1), g(**kw), g(5, y=q[0], **kw), g(a=1, b=2))
    """,
    "imports": """
        def f(q):
            import numpy as np
            import math
            import os.path
            from math import sin as s, cos
            x = s(q[0]) + cos(q[0]) + math.pi + np.pi
            return (x, os.path.sep)
    """,
    "strings": """
        def f(q):
            x = q[0]
            w = 8
            return (f'{x:.3f} m', f'{x!r}', f'a{x:>{w}}b{w}', 'x' 'y', b'c', 'a' in 'abc', x not in q)
    """,
    "names": """
        def f(q):
            global seen
            seen = list(q)
            x: float = 1.0
            y = [1, 2, 3, 4]
            y[0], y[1] = (y[1], y[0])
            y[1:3] = [7]
            del y[0]
            del seen[0]
            o = types.SimpleNamespace(a=1)
            o.a += 2
            n = 3
            o.b = ~y[0] | 6 & n ^ n << 2 >> 1
            first, *rest = q
            x, y0 = (y, x)
            if (n := len(x)) > 1:
                x.append(n)
            return (x, y0, o.a, o.b, first, rest, -0.0, 1e301, {1, 2, 3} & {2})
    """,
    "newton": """
        def f(q):
            x = q[0]
            while True:
                step = (x * x - 2) / (2 * x)
                x -= step
                if abs(step) < 1e-12:
                    break
            return x
    """,
    "ways out": """
        def f(q):
            x = q[0]
            for it in range(8):
                step = (x * x - 0.4) / (2 * x)
                if abs(step) < 1e-09:
                    break
                x = x - step
            else:
                raise ValueError('no convergence')
            for a in q:
                for b in q:
                    if b > 0.6:
                        x = x + b
                        break
                else:
                    continue
                y = x + a
                if y > 2:
                    for c in q:
                        if c > 0.6:
                            return (x, c, 1)
                elif y < 0.1:
                    return 3
            return (x, it)
    """,
    "generator": """
        def f(q):
            def each(n):
                for i in range(n):
                    yield i * i
                    if i > 1:
                        return
            return list(each(5))
    """,
    "decorated": """
        def f(q):
            def twice(g):
                return lambda x: 2 * g(x)

            @twice
            def g(x):
                return x + 1
            return g(q[0])
    """,
    "energy": """
        def f(q):
            m, l, g = ([1.0, 2.0], [0.3, 0.2], 9.81)
            tau = np.zeros(2)
            for i in range(2):
                for k in range(i, 2):
                    s = 0.0
                    for j in range(k + 1):
                        s += l[j] * (0.5 if j == k else 1.0) * cos(sum(q[:j + 1])) if j >= i else 0
                    tau[i] += m[k] * g * s
            return tau
    """,
    "generators": """
        def f(q):
            def links(q):
                angle = 0.0
                for k, x in enumerate(q):
                    angle += x
                    if x > 0.5:
                        yield (k, angle)
                    else:
                        angle = yield angle
                        angle = 0.1
            def all(q):
                last = yield from links(q)
                yield last
                yield from (x * x for x in q)
            return list(all(q))
    """,
}
Q = ([0.3, 0.7], [-0.4, 0.1, 0.2], [0.95, 0.05], [0.1, 0.9, 0.2, 0.7])
WORLD = {"np": np, "cos": np.cos, "sin": np.sin, "b0": 0.25, "types": types}


def made(text: str) -> types.FunctionType:
    """A function ``f`` as ``exec`` makes it: without source text."""
    world = dict(WORLD)
    exec(compile(textwrap.dedent(text), "<prompt>", "exec"), world)  # noqa: S102
    function = world["f"]
    with pytest.raises(OSError):
        inspect.getsource(function)
    return function


def again(tree: ast.FunctionDef, function: types.FunctionType) -> types.FunctionType:
    """The function that the printed tree makes."""
    world = dict(function.__globals__)
    exec(ast.unparse(ast.fix_missing_locations(tree)), world)  # noqa: S102
    return world[tree.name]


def answer(function: types.FunctionType, q: list[float]) -> str:
    try:
        return repr(function(list(q)))
    except (ValueError, AssertionError, TypeError) as problem:
        return repr(problem)


@pytest.mark.parametrize("name", PROGRAMS)
def test_a_program_comes_back_as_it_was_written(name):
    function = made(PROGRAMS[name])
    tree = recovered(function)
    assert tree is not None
    source = ast.parse(textwrap.dedent(PROGRAMS[name])).body[0]
    assert ast.unparse(ast.fix_missing_locations(tree)).split("\n") == written(source)
    copy = again(tree, function)
    for q in Q:
        assert answer(copy, q) == answer(function, q)


def written(tree: ast.stmt) -> list[str]:
    """A program's lines as Python prints them, without what leaves no trace in byte code."""
    return ast.unparse(tree).replace("x: float = 1.0", "x = 1.0").split("\n")


@pytest.mark.parametrize("name", PROGRAMS)
def test_every_statement_stands_in_its_line(name):
    tree = recovered(made(PROGRAMS[name]))
    (source,) = ast.parse(textwrap.dedent(PROGRAMS[name])).body
    silent = (ast.Global, ast.Nonlocal, ast.Pass, ast.Break, ast.Continue, ast.FunctionDef)
    lines = []
    for part in (tree, source):
        nodes = [n for n in ast.walk(part) if isinstance(n, ast.stmt) and not isinstance(n, silent)]
        lines.append([n.lineno for n in nodes if not said(n) and not endless(n)])
    assert lines[0] == lines[1]


def said(node: ast.stmt) -> bool:
    """A docstring: its line is not in the byte code."""
    return isinstance(node, ast.Expr) and isinstance(node.value, ast.Constant)


def endless(node: ast.stmt) -> bool:
    """``while True``: nothing is done in its line."""
    return isinstance(node, ast.While) and isinstance(node.test, ast.Constant)


@pytest.mark.parametrize(
    "text",
    [
        "def f(q):\n    try:\n        return q[0]\n    except IndexError:\n        return 0\n",
        "def f(q):\n    with open(q) as file:\n        return file.read()\n",
        "def f(q):\n    class A:\n        x = 1\n    return A\n",
        "async def f(q):\n    return await q\n",
        "def f(q):\n    match q:\n        case [x, y]:\n            return x\n",
    ],
)
def test_what_is_not_read_is_not_answered(text):
    assert recovered(made(text)) is None


PAIRS = [
    ("x + 1", "x - 1"),
    ("x + 1", "x + 1.0"),
    ("x + 1", "x + True"),
    ("x + 0.0", "x + -0.0"),
    ("x < 1", "x <= 1"),
    ("x and y", "x or y"),
    ("x if y else z", "x if not y else z"),
    ("g(a=1)", "g(b=1)"),
    ("g(1)", "g(*[1])"),
    ("[x for x in y if x]", "[x for x in y if not x]"),
    ("lambda: 1", "lambda: 2"),
    ("lambda a=1: a", "lambda a=2: a"),
    ("x[1:2]", "x[1:]"),
    ("x.a", "x.b"),
    ("y", "z"),
    ("(1, (2.0, 3))", "(1, (2, 3))"),
    ("f'{x:.3f}'", "f'{x:.4f}'"),
]


@pytest.mark.parametrize(("one", "two"), PAIRS)
def test_programs_that_differ_are_told_apart(one, two):
    code = [made(f"def f(x, y=0):\n    return {text}\n").__code__ for text in (one, two)]
    assert alike(code[0], code[0])
    assert not alike(*code)


@pytest.mark.parametrize(
    ("one", "two", "same"),
    [
        ("if x:\n  return 1\n return 2", "if x:\n  return 1\n else:\n  return 2", True),
        ("if x:\n  return 1\n return 2", "if not x:\n  return 2\n return 1", True),
        ("if x:\n  return 1\n return 2", "if x:\n  return 2\n return 1", False),
        (
            "while x:\n  x = y\n return x",
            "while True:\n  if not x:\n   break\n  x = y\n return x",
            True,
        ),
        ("while x:\n  x = y\n return x", "if x:\n  x = y\n return x", False),
        ("for k in x:\n  y\n return 1", "for k in x:\n  y\n  break\n return 1", False),
    ],
)
def test_only_what_is_done_counts(one, two, same):
    code = [made(f"def f(x, y=0):\n {text}\n").__code__ for text in (one, two)]
    assert alike(*code) is same


def test_variables_from_outside_and_defaults():
    tree = recovered(
        made(
            "def g(a):\n    def h(q, b=(1, 2.5), *, c=None):\n        nonlocal a\n        a += q[0]\n        return a\n    return h\nf = g(3)\n"
        )
    )
    assert ast.unparse(ast.fix_missing_locations(tree)) == (
        "def h(q, b=(1, 2.5), *, c=None):\n    nonlocal a\n    a += q[0]\n    return a"
    )


def test_a_default_that_is_no_literal_is_left_to_the_function():
    function = made("def f(q, table=np.zeros(2)):\n    return table + q[0]\n")
    assert ast.unparse(ast.fix_missing_locations(recovered(function))).startswith(
        "def f(q, table):"
    )


def test_a_lambda_is_a_function_that_returns():
    tree = recovered(made("f = lambda q: q[0] if q[1] > 0 else 2\n"))
    assert ast.unparse(ast.fix_missing_locations(tree)) == (
        "def function(q):\n    return q[0] if q[1] > 0 else 2"
    )


def functions_in(code: types.CodeType):
    for constant in code.co_consts:
        if isinstance(constant, types.CodeType):
            # <lambda>, <genexpr>; from 3.14 on the compiler's own __annotate__
            written = not constant.co_name.startswith(("<", "__annotate"))
            if constant.co_flags & inspect.CO_OPTIMIZED and written:
                yield constant
            yield from functions_in(constant)


def done(code: types.CodeType) -> set[tuple[str, str]]:
    """What a code object does, as a set: its operations with their operands, nested ones too."""
    pacing = ("JUMP", "NOP", "RESUME", "CACHE", "EXTENDED", "PRECALL", "MAKE_CELL", "COPY_FREE")
    found = set()
    for i in dis.get_instructions(code):
        if isinstance(i.argval, types.CodeType):
            found |= done(i.argval)
        elif isinstance(i.argval, frozenset):  # printed in an order that the process's seed gives
            found.add((i.opname, repr(sorted(i.argval, key=repr))))
        elif isinstance(i.argval, tuple) and i.opname.count("_FAST") == 2:  # 3.13: two in one
            first, second = i.opname.replace("_LOAD", " LOAD").replace("_STORE", " STORE").split()
            found |= {(first, repr(i.argval[0])), (second, repr(i.argval[1]))}
        elif i.opname == "RETURN_CONST":  # 3.12
            found |= {("LOAD_CONST", repr(i.argval)), ("RETURN_VALUE", "None")}
        elif i.opname not in ("FOR_ITER", "SEND", "PUSH_NULL") and not any(
            w in i.opname for w in pacing
        ):
            found.add((i.opname.replace("LOAD_METHOD", "LOAD_ATTR"), repr(i.argval)))
    return found


def test_the_house_itself_is_read():
    """Functions of a whole package: each the same again, or none."""
    read = total = 0
    for file in sorted(Path(kinlab.__file__).parent.rglob("*.py"))[::12]:
        module = compile(file.read_text(encoding="utf-8"), "<house>", "exec", dont_inherit=True)
        for code in functions_in(module):
            if code.co_exceptiontable:
                continue
            cells = tuple(types.CellType() for _ in code.co_freevars)
            function = types.FunctionType(code, {}, closure=cells or None)
            tree = recovered(function)
            total += 1
            if tree is None:
                continue
            read += 1
            outer = [ast.parse(f"{name} = 0").body[0] for name in code.co_freevars]
            text = ast.unparse(ast.fix_missing_locations(tree))
            if outer:
                none = ast.arguments([], [], None, [], [], None, [])
                around = ast.FunctionDef("around", none, [*outer, tree], [])
                text = ast.unparse(ast.fix_missing_locations(around))
            same = compile(text, "<again>", "exec", dont_inherit=True)
            for _ in range(2 if outer else 1):
                (same,) = (c for c in same.co_consts if isinstance(c, types.CodeType))
            assert done(same) == done(code), code.co_name
    assert total > 100
    assert read > 0.97 * total
