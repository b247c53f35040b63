"""A code object as a graph of steps, and whether two code objects do the same.

Jumps are edges, not steps; what only paces the interpreter (``NOP``, ``RESUME``, ``CACHE``) is left
out. Two graphs that agree step by step on every path from their entries do the same, however the
compiler has laid them out: with a short exit copied or not, a jump threaded or not.

Source: the ``dis`` chapter of the Python library reference, 3.11 to 3.13.
"""

from __future__ import annotations

import dis
import inspect
import sys
from collections.abc import Iterable
from dataclasses import dataclass, field
from types import CodeType

Span = tuple[int, int, int, int]
"""Line, last line, column and last column."""


class UnreadError(Exception):
    """Byte code that is not known here: the reader gives up. Never leaves this room."""


@dataclass(eq=False, slots=True)
class Step:
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
    """

    op: str
    value: object
    bit: int
    span: Span | None
    index: int
    after: list[Step] = field(default_factory=list)
    falls: int = 0


PACING = {"NOP", "RESUME", "CACHE", "PRECALL", "EXTENDED_ARG", "MAKE_CELL", "COPY_FREE_VARS"}
PACING |= {"TO_BOOL", "NOT_TAKEN"}
JUMPS = {"JUMP_FORWARD", "JUMP_BACKWARD", "JUMP_BACKWARD_NO_INTERRUPT"}
LAST = {"RETURN_VALUE", "RAISE_VARARGS", "RERAISE"}
BITS = {"LOAD_GLOBAL"} if sys.version_info < (3, 12) else {"LOAD_GLOBAL", "LOAD_ATTR"}
FLAGS = inspect.CO_OPTIMIZED | inspect.CO_NEWLOCALS | inspect.CO_VARARGS | inspect.CO_VARKEYWORDS
FLAGS |= inspect.CO_GENERATOR | inspect.CO_COROUTINE | inspect.CO_ASYNC_GENERATOR


def entry(code: CodeType) -> Step:
    """The first step of a code object, its graph behind it.

    Raises:
        UnreadError: It catches exceptions, waits, or loops without doing anything.
    """
    if code.co_exceptiontable:
        raise UnreadError("exceptions are caught")
    instructions = list(dis.get_instructions(code))
    place = {i.offset: n for n, i in enumerate(instructions)}
    steps = [_step(code, n, i) for n, i in enumerate(instructions)]

    def at(n: int) -> Step:
        seen: set[int] = set()
        while n not in seen:
            seen.add(n)
            if n >= len(steps):
                break
            if steps[n].op in JUMPS:
                n = place[_target(instructions[n])]
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
            other = at(place[_target(instructions[n])])
            holds = name.endswith(("IF_TRUE", "IF_NONE"))
            step.after = [other, following] if holds else [following, other]
            step.falls = 1 if holds else 0
        elif step.op in ("AND", "OR", "FOR_ITER"):
            step.after = [following, at(place[_target(instructions[n])])]
        else:
            step.after = [following]
    first = at(0)
    if first.op == "RETURN_GENERATOR":
        first = first.after[0].after[0]
    return first


def _target(instruction: dis.Instruction) -> int:
    return int(instruction.argval)


def _step(code: CodeType, n: int, instruction: dis.Instruction) -> Step:
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
    elif op == "BINARY_OP":
        value = instruction.arg
    p = instruction.positions
    span = None
    if p is not None and p.lineno is not None:
        end = p.lineno if p.end_lineno is None else p.end_lineno
        span = (p.lineno, end, p.col_offset or 0, p.end_col_offset or 0)
    return Step(op, value, bit, span, n)


def reachable(starts: Iterable[Step], stops: Iterable[Step] = ()) -> set[Step]:
    """The steps that can follow, with the stops that are met but not what is behind these."""
    end = set(stops)
    seen: set[Step] = set()
    left = list(starts)
    while left:
        step = left.pop()
        if step not in seen:
            seen.add(step)
            if step not in end:
                left.extend(step.after)
    return seen


def folded(first: Step) -> Step:
    """The graph with the compiler's copies of one piece of source made one again.

    Copies (of a short exit, of the test of a ``while``) stand at the same place of the source, do
    the same and lead to the same.
    """
    steps = sorted(reachable([first]), key=lambda step: step.index)
    same: dict[Step, Step] = {}

    def root(step: Step) -> Step:
        while step in same:
            step = same[step]
        return step

    changed = True
    while changed:
        changed = False
        known: dict[object, Step] = {}
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
    seen: set[tuple[Step, Step]] = set()
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
