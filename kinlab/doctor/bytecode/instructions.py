"""A code object as a graph of steps, and whether two code objects do the same.

Jumps are edges, not steps; what only paces the interpreter (``NOP``, ``RESUME``, ``CACHE``) is left
out. Two graphs that agree step by step on every path from their entries do the same, however the
compiler has laid them out: with a short exit copied or not, a jump threaded or not.

Source: the ``dis`` chapter of the Python library reference, 3.11 to 3.14.
"""

from __future__ import annotations

import dis
import inspect
import re
import sys
from collections.abc import Iterable
from dataclasses import dataclass, field
from types import CodeType

Span = tuple[int, int, int, int]
"""Line, last line, column and last column."""


class UnreadError(Exception):
    """Byte code that is not known here: the reader gives up. Never leaves this room."""


@dataclass(eq=False, slots=True)
class CodeStep:
    """One thing the interpreter does.

    Attributes:
        op: Its name; the conditional jumps are ``TEST`` (goes on at ``after[0]`` where its value is
            true or, with ``value`` None, where it is None), ``AND`` and ``OR`` (which keep their
            value where they jump, to ``after[1]``).
        value: What it works on: a name, a constant, a number.
        bit: The low bit of its argument, where that has a meaning of its own.
        span: Where in the source it stands, if known.
        index: Its place in the byte code.
        after: The steps that may be next.
        falls: Which of ``after`` stands next in the byte code.
        ends: Of a ``for``: the index at which its lines have ended.
    """

    op: str
    value: object
    bit: int
    span: Span | None
    index: int
    after: list[CodeStep] = field(default_factory=list)
    falls: int = 0
    ends: int = 0


PACING = {"NOP", "RESUME", "CACHE", "PRECALL", "EXTENDED_ARG", "MAKE_CELL", "COPY_FREE_VARS"}
PACING |= {"TO_BOOL", "NOT_TAKEN", "END_SEND"}
JUMPS = {"JUMP_FORWARD", "JUMP_BACKWARD", "JUMP_BACKWARD_NO_INTERRUPT"}
ENDING = 0 if sys.version_info < (3, 12) else 1 if sys.version_info < (3, 13) else 2
"""How many instructions end a loop that has run out: ``END_FOR``, then ``POP_TOP`` too."""

SAME: dict[object, str] = {
    "LOAD_FAST_CHECK": "LOAD_FAST",
    "LOAD_FAST_BORROW": "LOAD_FAST",
    "LOAD_SMALL_INT": "LOAD_CONST",
    "POP_ITER": "POP_TOP",
    ("CALL_INTRINSIC_1", 5): "UNARY_POSITIVE",
    ("CALL_INTRINSIC_1", 6): "LIST_TO_TUPLE",
    ("BINARY_OP", 26): "BINARY_SUBSCR",  # 3.14
}
"""Steps by another name, some with their argument only."""

LAST = {"RETURN_CONST", "RETURN_VALUE", "RAISE_VARARGS", "RERAISE"}
BITS = {"LOAD_GLOBAL"} if sys.version_info < (3, 12) else {"LOAD_GLOBAL", "LOAD_ATTR"}
FLAGS = inspect.CO_OPTIMIZED | inspect.CO_NEWLOCALS | inspect.CO_VARARGS | inspect.CO_VARKEYWORDS
FLAGS |= inspect.CO_GENERATOR | inspect.CO_COROUTINE | inspect.CO_ASYNC_GENERATOR


def entry(code: CodeType) -> CodeStep:
    """The first step of a code object, its graph behind it.

    Raises:
        UnreadError: It catches exceptions, waits, or loops without doing anything.
    """
    instructions = list(dis.get_instructions(code))
    if code.co_exceptiontable and (
        sys.version_info < (3, 12) or any(i.opname == "PUSH_EXC_INFO" for i in instructions)
    ):  # from 3.12 on generators and comprehensions have tables of their own
        raise UnreadError("exceptions are caught")
    place = {i.offset: n for n, i in enumerate(instructions)}
    steps = [_step(code, n, i) for n, i in enumerate(instructions)]

    def at(n: int) -> CodeStep:
        seen: set[int] = set()
        while n not in seen:
            seen.add(n)
            if n >= len(steps):
                break
            if steps[n].op in JUMPS:
                n = place[int(instructions[n].argval)]
            elif steps[n].op in PACING:
                n += 1
            else:
                return steps[n]
        raise UnreadError("a jump to nowhere")

    for n, step in enumerate(steps):
        if step.op in PACING or step.op in JUMPS or step.op in LAST:
            continue
        name = instructions[n].opname
        try:
            following = at(n + 1)
        except UnreadError:
            continue  # behind the last line of a loop that never ends: nothing gets here
        if step.op == "TEST":
            other = at(place[int(instructions[n].argval)])
            holds = name.endswith(("IF_TRUE", "IF_NONE"))
            step.after = [other, following] if holds else [following, other]
            behind = next(s for s in steps[n + 1 :] if s.op != "NOT_TAKEN")
            turned = behind.op == "JUMP_BACKWARD" and behind.span == step.span
            step.falls = int(holds != turned)  # a test may only leap over its own jump (3.12)
        elif step.op in ("AND", "OR", "FOR_ITER"):
            ending = ENDING if step.op == "FOR_ITER" else 0
            step.ends = 2 * place[int(instructions[n].argval)] if step.op == "FOR_ITER" else 0
            step.after = [following, at(place[int(instructions[n].argval)] + ending)]
        elif step.op == "SEND":
            step.after = [at(place[int(instructions[n].argval)])]
        else:
            step.after = [following]
    for step in steps:
        _in_parts(step)
    for step in steps:
        _keeping(step)
        _passing_on(step)
    first = at(0)
    if first.op == "RETURN_GENERATOR":
        first = first.after[0].after[0]
    return first


def _in_parts(step: CodeStep) -> None:
    """A step that does two things, as two."""
    parts = re.findall(r"(?:LOAD|STORE)_FAST", step.op)
    if step.op == "RETURN_CONST":
        step.op, second = "LOAD_CONST", CodeStep("RETURN_VALUE", None, 0, step.span, step.index + 1)
    elif len(parts) == 2 and isinstance(step.value, tuple):
        (step.op, op), (step.value, name) = parts, step.value
        second = CodeStep(op, name, 0, step.span, step.index + 1, step.after)
    else:
        return
    step.after = [second]


def _keeping(step: CodeStep) -> None:
    """``COPY``, a test and ``POP_TOP`` as one step that keeps its value where it jumps.

    From 3.14 on a call such as ``any(x for x in y)`` has a short way of its own where the name is
    still the builtin's: it is left out.
    """
    path = _path(step, 4)
    if [s.op for s in path] == ["COPY", "LOAD_COMMON_CONSTANT", "IS_OP", "TEST"]:
        plain = path[3].after[1]
        step.op, step.value, step.after = plain.op, plain.value, plain.after
    test = step.after[0] if step.op == "COPY" and step.value == 1 and step.after else step
    if test.op == "TEST" and test.value is True:
        falls, jumps = test.after[test.falls], test.after[1 - test.falls]
        if falls.op == "POP_TOP" and step is not test:
            step.op, step.value = ("OR" if test.falls else "AND"), True
            step.span, step.after = test.span, [falls.after[0], jumps]


def _passing_on(step: CodeStep) -> None:
    """All that ``yield from`` does as one step; it goes on where the inner iterator has ended."""
    path = _path(step, 3)
    if [s.op for s in path] == ["GET_YIELD_FROM_ITER", "LOAD_CONST", "SEND"]:
        step.op, step.after = "YIELD_FROM", path[2].after


def _step(code: CodeType, n: int, instruction: dis.Instruction) -> CodeStep:
    op = instruction.opname
    value: object = instruction.argval
    bit = (instruction.arg or 0) & 1 if op in BITS else 0
    if "_IF_" in op:
        if op.endswith("OR_POP"):
            op, value = ("AND" if "FALSE" in op else "OR"), True
        else:
            op, value = "TEST", None if op.endswith("NONE") else True
    elif op in JUMPS or op == "FOR_ITER":
        value = None
    elif op == "KW_NAMES":
        value = code.co_consts[instruction.arg or 0]
    elif op == "LOAD_ATTR" and bit:
        op = "LOAD_METHOD"
    else:
        if op == "BINARY_OP":
            value = instruction.arg
        if op == "CALL_FUNCTION_EX" and value is None:
            value = 1  # 3.14: keywords, or an empty entry for them
        op = SAME.get(op) or SAME.get((op, instruction.arg), op)
    p = instruction.positions
    span = None
    if p is not None and p.lineno is not None:
        end = p.lineno if p.end_lineno is None else p.end_lineno
        span = (p.lineno, end, p.col_offset or 0, p.end_col_offset or 0)
    return CodeStep(op, value, bit, span, 2 * n)


def reachable(starts: Iterable[CodeStep], stops: Iterable[CodeStep] = ()) -> set[CodeStep]:
    """The steps that can follow, with the stops that are met but not what is behind these."""
    end = set(stops)
    seen: set[CodeStep] = set()
    left = list(starts)
    while left:
        step = left.pop()
        if step not in seen:
            seen.add(step)
            if step not in end:
                left.extend(step.after)
    return seen


def leading(to: CodeStep, within: set[CodeStep], stops: Iterable[CodeStep] = ()) -> set[CodeStep]:
    """The steps among some that can lead to one, not past the stops."""
    end = set(stops)
    before: dict[CodeStep, list[CodeStep]] = {}
    for step in within - end:
        for after in step.after:
            before.setdefault(after, []).append(step)
    seen: set[CodeStep] = set()
    left = [to]
    while left:
        step = left.pop()
        if step not in seen:
            seen.add(step)
            left.extend(before.get(step, ()))
    return seen & (within | {to})


def folded(first: CodeStep) -> CodeStep:
    """The graph with the compiler's copies of one piece of source made one again.

    Copies (of a short exit, of the test of a ``while``) stand at the same place of the source, do
    the same and lead to the same.
    """
    steps = sorted(reachable([first]), key=lambda step: step.index)
    same: dict[CodeStep, CodeStep] = {}

    def root(step: CodeStep) -> CodeStep:
        while step in same:
            step = same[step]
        return step

    changed = True
    while changed:
        changed = False
        known: dict[object, CodeStep] = {}
        for step in steps:
            if step in same or step.span is None:
                continue
            here = (step.op, constant(step.value), step.bit, step.span)
            earlier = known.setdefault((here, tuple(id(root(s)) for s in step.after)), step)
            if earlier is not step:
                same[step] = earlier
                changed = True
    for step in steps:
        step.after = [root(s) for s in step.after]
    return root(first)


def unchain(first: CodeStep) -> None:
    """Make ``a < b < c`` one path: the way out in its middle only throws a value away."""
    for step in sorted(reachable([first]), key=lambda step: step.index):
        path = _path(step, 4)
        if [s.op for s in path[:2]] != ["SWAP", "COPY"] or len(path) < 4:
            continue
        compare, branch = path[2:]
        if branch.op not in ("TEST", "AND") or (path[0].value, path[1].value) != (2, 2):
            continue
        out = branch.after[1]
        if branch.op == "TEST" and out.op != "POP_TOP":
            continue
        step.op, step.value = "CHAIN", (compare.op, compare.value)
        step.span, step.after = compare.span, [branch.after[0]]


def _path(step: CodeStep, most: int) -> list[CodeStep]:
    """The steps that must follow one another, from one on."""
    path = [step]
    while len(path) < most and len(path[-1].after) == 1:
        path.append(path[-1].after[0])
    return path


def constant(value: object) -> object:
    """A constant as what it is told apart by: its type and its digits, -0.0 not as 0.0."""
    if isinstance(value, tuple):
        return ("tuple", *map(constant, value))
    if isinstance(value, frozenset):
        return ("frozenset", frozenset(map(constant, value)))
    if isinstance(value, CodeType):
        return ("code", id(value))
    return (type(value).__name__, repr(value))


def alike(one: CodeType, two: CodeType, *, named: bool = True) -> bool:
    """Whether two code objects do the same on every path.

    Compared are the arguments, the kinds of variables, the flags, the docstring and the steps.

    Raises:
        UnreadError: A graph cannot be made.
    """
    if _signature(one) != _signature(two) or (named and one.co_name != two.co_name):
        return False
    pairs = [(entry(one), entry(two))]
    seen: set[tuple[CodeStep, CodeStep]] = set()
    while pairs:
        pair = pairs.pop()
        if pair in seen:
            continue
        seen.add(pair)
        a, b = pair
        if (a.op, a.bit, len(a.after)) != (b.op, b.bit, len(b.after)):
            return False
        if isinstance(a.value, CodeType) and isinstance(b.value, CodeType):
            if not alike(a.value, b.value):
                return False
        elif constant(a.value) != constant(b.value):
            return False
        pairs.extend(zip(a.after, b.after, strict=True))
    return True


def arguments(code: CodeType) -> tuple[str, ...]:
    """The names of the arguments, with those of ``*args`` and ``**keywords`` last."""
    stars = bool(code.co_flags & inspect.CO_VARARGS) + bool(code.co_flags & inspect.CO_VARKEYWORDS)
    return code.co_varnames[: code.co_argcount + code.co_kwonlyargcount + stars]


def docstring(code: CodeType) -> str | None:
    """The docstring of a function: its first constant, if that is a string."""
    if sys.version_info >= (3, 14) and not code.co_flags & 0x4000000:  # CO_HAS_DOCSTRING
        return None
    first = code.co_consts[0] if code.co_consts else None
    return first if isinstance(first, str) and not code.co_name.startswith("<") else None


def _signature(code: CodeType) -> tuple[object, ...]:
    return (
        arguments(code),
        code.co_argcount,
        code.co_posonlyargcount,
        code.co_kwonlyargcount,
        code.co_flags & FLAGS,
        sorted(code.co_cellvars),
        sorted(code.co_freevars),
        docstring(code),
    )
