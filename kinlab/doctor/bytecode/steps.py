"""What each step does to the stack of syntax trees."""

from __future__ import annotations

import ast
import sys
from collections.abc import Callable, Sequence
from types import CodeType

from kinlab.doctor.bytecode.expressions import (
    NULL,
    SAVED,
    SELF,
    Changed,
    CodeHand,
    Hole,
    Imported,
    Iterated,
    Made,
    Module,
    Unpacked,
    at,
    is_none,
    limits,
    literal,
    needed,
    span_of,
)
from kinlab.doctor.bytecode.instructions import CodeStep, UnreadError

NULL_ABOVE = sys.version_info >= (3, 13)
"""Whether the empty entry of a call lies above its function, not below."""

BINARY: list[type[ast.operator]] = [
    ast.Add, ast.BitAnd, ast.FloorDiv, ast.LShift, ast.MatMult, ast.Mult, ast.Mod, ast.BitOr,
    ast.Pow, ast.RShift, ast.Sub, ast.Div, ast.BitXor,
]  # fmt: skip
"""In the order of BINARY_OP's argument; behind them stand the augmented ones, then ``[]``."""

CONTEXTS = {"LOAD": ast.Load, "BINARY": ast.Load, "STORE": ast.Store, "DELETE": ast.Del}
"""What is done with a variable or a part, by the first word of a step's name."""

COMPARE: dict[object, type[ast.cmpop]] = {
    "<": ast.Lt,
    "<=": ast.LtE,
    "==": ast.Eq,
    "!=": ast.NotEq,
    ">": ast.Gt,
    ">=": ast.GtE,
    ("IS_OP", 0): ast.Is,
    ("IS_OP", 1): ast.IsNot,
    ("CONTAINS_OP", 0): ast.In,
    ("CONTAINS_OP", 1): ast.NotIn,
}

TAKING: dict[str, tuple[int | None, Callable[[list[ast.expr]], ast.expr]]] = {
    "UNARY_NEGATIVE": (1, lambda e: ast.UnaryOp(ast.USub(), *e)),
    "UNARY_POSITIVE": (1, lambda e: ast.UnaryOp(ast.UAdd(), *e)),
    "UNARY_INVERT": (1, lambda e: ast.UnaryOp(ast.Invert(), *e)),
    "UNARY_NOT": (1, lambda e: ast.UnaryOp(ast.Not(), *e)),
    "YIELD_VALUE": (1, lambda e: ast.Yield(*e)),
    "YIELD_FROM": (1, lambda e: ast.YieldFrom(*e)),
    "LIST_TO_TUPLE": (1, lambda e: ast.Tuple(needed(e[0], ast.List).elts, ast.Load())),
    "BUILD_SLICE": (None, lambda e: limits(*e)),
    "BUILD_TUPLE": (None, lambda e: ast.Tuple(e, ast.Load())),
    "BUILD_LIST": (None, lambda e: ast.List(e, ast.Load())),
    "BUILD_SET": (None, ast.Set),
    "BUILD_STRING": (None, lambda e: _joined(e)),
}
"""Steps that take values and give one: how many (None: as the step says), and which."""

CONVERSIONS: dict[object, int] = {None: -1, str: ord("s"), repr: ord("r"), ascii: ord("a")}
"""The letters of ``!s``, ``!r`` and ``!a`` in an f-string, by their functions."""


def do(step: CodeStep, hand: CodeHand) -> None:
    """One step that does not jump.

    Raises:
        UnreadError: The step is not known, or the stack is not as it needs.
    """
    op, span, stack, value = step.op, step.span, hand.stack, step.value
    number = value if isinstance(value, int) else 0
    if op in TAKING:
        count, make = TAKING[op]
        hand.push(make(hand.many(number if count is None else count)), step)
        return
    verb, _, kind = op.partition("_")
    if verb in CONTEXTS and (part := _part(kind, CONTEXTS[verb](), step, hand)) is not None:
        _used(verb, part, step, hand)
        return
    match op:
        case "LOAD_FAST_AND_CLEAR":
            stack.append(SAVED)
        case "LOAD_CONST" if isinstance(value, CodeType):
            stack.append(value)
        case "LOAD_CONST":
            hand.push(literal(value, span), step)
        case "PUSH_NULL":
            stack.append(NULL)
        case "LOAD_ASSERTION_ERROR" | "LOAD_COMMON_CONSTANT" if number < 2:
            hand.push(ast.Name(("AssertionError", "NotImplementedError")[number], ast.Load()), step)
            setattr(stack[-1], "asserted", True)  # noqa: B010
        case "POP_TOP":
            _pop_top(step, hand)
        case "COPY":
            stack.append(hand.under(number))
        case "SWAP":
            hand.under(number)
            stack[-1], stack[-number] = stack[-number], stack[-1]
        case "BINARY_OP":
            left, right = hand.many(2)
            if number < len(BINARY):
                hand.push(ast.BinOp(left, BINARY[number](), right), step)
            else:
                stack.append(Changed(left, BINARY[number - len(BINARY)](), right))
        case "COMPARE_OP" | "IS_OP" | "CONTAINS_OP" | "CHAIN":
            _compare(step, hand)
        case "BUILD_MAP":
            pairs = hand.many(2 * number)
            hand.push(ast.Dict(list(pairs[::2]), pairs[1::2]), step)
        case "BUILD_CONST_KEY_MAP":
            keys = needed(hand.expr(), ast.Tuple)
            hand.push(ast.Dict(list(keys.elts), hand.many(number)), step)
        case "LIST_EXTEND" | "SET_UPDATE" | "LIST_APPEND" | "SET_ADD":
            more = hand.expr()
            into = hand.under(number)
            if not isinstance(into, (ast.List, ast.Set)):
                raise UnreadError("not extended here")
            if op in ("LIST_APPEND", "SET_ADD"):
                into.elts.append(more)
            elif isinstance(more, (ast.Tuple, ast.Set)) and not into.elts and len(more.elts) > 2:
                into.elts.extend(more.elts)
            else:
                into.elts.append(at(ast.Starred(more, ast.Load()), span))
        case "MAP_ADD" | "DICT_UPDATE" | "DICT_MERGE":
            element = hand.expr()
            key = hand.expr() if op == "MAP_ADD" else None
            mapping = needed(hand.under(number), ast.Dict)
            if op == "DICT_UPDATE" and isinstance(element, ast.Dict) and None not in element.keys:
                mapping.keys.extend(element.keys)  # a long literal, made piece by piece
                mapping.values.extend(element.values)
            else:
                mapping.keys.append(key)
                mapping.values.append(element)
        case "CONVERT_VALUE":
            hand.push(ast.FormattedValue(hand.expr(), CONVERSIONS[value], None), step)
        case "FORMAT_VALUE" | "FORMAT_SIMPLE" | "FORMAT_WITH_SPEC":
            by, given_so = value if isinstance(value, tuple) else (None, op.endswith("SPEC"))
            spec = at(_joined([hand.expr()]), span) if given_so else None
            shown = hand.expr()
            if not isinstance(shown, ast.FormattedValue):
                shown = at(ast.FormattedValue(shown, CONVERSIONS[by], None), span)
            shown.format_spec = spec
            hand.push(ast.JoinedStr([shown]), step)
        case "KW_NAMES":
            hand.keywords = needed(value, tuple)
        case "CALL_KW":
            named = needed(hand.pop(), ast.Tuple).elts
            hand.keywords = tuple(str(e.value) for e in named if isinstance(e, ast.Constant))
            _call(step, hand, number)
        case "CALL":
            _call(step, hand, number)
        case "CALL_FUNCTION_EX":
            if hand.under(1) is NULL:  # 3.14: an empty entry where no keywords are
                hand.pop()
                number = 0
            _call_stars(step, hand, number & 1)
        case "MAKE_FUNCTION":
            function = Made(needed(hand.pop(), CodeType))
            for flag in (8, 4, 2, 1):
                _attribute(function, number & flag, hand)
            stack.append(function)
        case "SET_FUNCTION_ATTRIBUTE":
            function = needed(hand.pop(), Made)
            _attribute(function, number, hand)
            stack.append(function)
        case "GET_ITER":
            stack.append(Iterated(hand.expr()))
        case "UNPACK_SEQUENCE" | "UNPACK_EX":
            star = number & 0xFF if op == "UNPACK_EX" else None
            parts = number if star is None else star + 1 + (number >> 8)
            parted = Unpacked(hand.pop(), [None] * parts, star)
            stack.extend(Hole(parted, n) for n in reversed(range(parts)))
        case "RETURN_VALUE":
            told = hand.expr()
            alone = is_none(told) and span_of(told) == span
            hand.out.append(at(ast.Return(None if alone else told), span))
        case "RAISE_VARARGS":
            hand.out.append(at(ast.Raise(*hand.many(number)), span))
        case "IMPORT_NAME":
            level, names = hand.many(2)
            depth = needed(needed(level, ast.Constant).value, int)
            stack.append(Module(str(value), depth, not is_none(names)))
        case "IMPORT_FROM":
            top = hand.under(1)
            module = top.module if isinstance(top, Imported) else needed(top, Module)
            stack.append(Imported(module, str(value)))
        case _:
            raise UnreadError(op)


def _part(kind: str, use: ast.expr_context, step: CodeStep, hand: CodeHand) -> ast.expr | None:
    """A variable, an attribute, an element or a slice; None where a step is about none of them."""
    match kind:
        case "FAST" | "GLOBAL" | "DEREF" | "NAME" | "CLOSURE":
            return ast.Name(str(step.value), use)
        case "ATTR" | "METHOD":
            return ast.Attribute(hand.expr(), str(step.value), use)
        case "SUBSCR":
            whole, index = hand.many(2)
            return ast.Subscript(whole, index, use)
        case "SLICE":
            whole, *ends = hand.many(3)
            return ast.Subscript(whole, at(limits(*ends), step.span), use)
    return None


def _used(verb: str, part: ast.expr, step: CodeStep, hand: CodeHand) -> None:
    """A variable or a part loaded, stored or deleted."""
    if verb == "STORE":
        hand.store(hand.pop(), at(part, step.span))
    elif verb == "DELETE":
        hand.out.append(ast.Delete([at(part, step.span)]))
    else:
        above = SELF if step.op == "LOAD_METHOD" else NULL if step.bit else None
        hand.push(part, step)
        if above is not None:
            below = above is NULL and not NULL_ABOVE
            hand.stack.insert(len(hand.stack) - below, above)


def _joined(parts: Sequence[ast.expr]) -> ast.JoinedStr:
    values: list[ast.expr] = []
    for part in parts:
        values.extend(part.values if isinstance(part, ast.JoinedStr) else [part])
    return ast.JoinedStr(values)


def _pop_top(step: CodeStep, hand: CodeHand) -> None:
    top = hand.under(1)
    if isinstance(top, (Iterated, Imported, Module)):
        hand.pop()
        if isinstance(top, Module) and top.aliases:
            line = ast.ImportFrom(top.name or None, top.aliases, top.level)
            hand.out.append(at(line, step.span))
    else:
        node = hand.expr()
        if isinstance(node, ast.NamedExpr):
            raise UnreadError("a value stored and left")
        hand.out.append(ast.Expr(node))


def _compare(step: CodeStep, hand: CodeHand) -> None:
    left, right = hand.many(2)
    chained = step.op == "CHAIN"
    kind, value = needed(step.value, tuple) if chained else (step.op, step.value)
    op = COMPARE.get(value if kind == "COMPARE_OP" else (kind, value))
    if op is None:
        raise UnreadError(f"a comparison by {value}")
    node = ast.Compare(left, [op()], [right])
    if isinstance(left, ast.Compare) and getattr(left, "open", False):
        node = ast.Compare(left.left, [*left.ops, op()], [*left.comparators, right])
    setattr(node, "open", chained)  # noqa: B010
    hand.stack.append(at(node, step.span))


def _call(step: CodeStep, hand: CodeHand, count: int) -> None:
    arguments = hand.many(count)
    names, hand.keywords = hand.keywords, ()
    positional = len(arguments) - len(names)
    given = zip(names, arguments[positional:], strict=True)
    keywords = [at(ast.keyword(name, node), step.span) for name, node in given]
    arguments = arguments[:positional]
    upper, lower = hand.pop(), hand.pop()
    if upper is SELF:
        function = hand.as_expr(lower)
    elif lower is NULL or upper is NULL:
        function = hand.as_expr(lower if upper is NULL else upper)
    elif isinstance(lower, Made) and isinstance(upper, Iterated):
        hand.stack.append(hand.finish(lower, upper.over, step.span))
        return
    elif getattr(lower, "asserted", False) and not count:
        function, arguments = hand.as_expr(lower), [hand.as_expr(upper)]
    elif isinstance(upper, Made) and not upper.code.co_name.startswith("<"):
        upper.decorators.insert(0, hand.as_expr(lower))
        hand.stack.append(upper)
        return
    else:
        raise UnreadError("a call of nothing known")
    node = at(ast.Call(function, arguments, keywords), step.span)
    if isinstance(function, ast.Attribute) and NULL in (lower, upper):
        setattr(node, "of_import", True)  # noqa: B010
    hand.stack.append(node)


def _call_stars(step: CodeStep, hand: CodeHand, named: int) -> None:
    pairs: list[tuple[ast.expr | None, ast.expr]] = []
    if named:
        given = hand.expr()
        pairs = [(None, given)]
        if isinstance(given, ast.Dict) and given.keys:
            pairs = [*zip(given.keys, given.values, strict=True)]
    keywords: list[ast.keyword] = []
    for key, node in pairs:
        name = None if key is None else str(needed(key, ast.Constant).value)
        keywords.append(at(ast.keyword(name, node), step.span))
    stars = hand.expr()
    arguments: list[ast.expr] = [at(ast.Starred(stars, ast.Load()), step.span)]
    if isinstance(stars, ast.Tuple):
        starred = any(isinstance(element, ast.Starred) for element in stars.elts)
        if named or len(stars.elts) > 15 or starred:
            arguments = stars.elts
    pair = [hand.pop(), hand.pop()]
    if NULL not in pair:
        raise UnreadError("a call of nothing known")
    pair.remove(NULL)
    hand.stack.append(at(ast.Call(hand.as_expr(pair[0]), arguments, keywords), step.span))


def _attribute(made: Made, flags: int, hand: CodeHand) -> None:
    """What a function is made with: closure, annotations, defaults."""
    if flags & 8:
        hand.pop()
    if flags & 4:
        notes = needed(hand.expr(), ast.Tuple).elts
        made.notes = _named(notes[::2], notes[1::2])
    if flags & (2 | 16):  # 16 from 3.14 on: the annotations, given by a function
        given = needed(hand.expr(), ast.Dict)
        named = _named(given.keys, given.values)
        made.keywords, made.notes = (named, made.notes) if flags & 2 else (made.keywords, named)
    if flags & 1:
        made.defaults = needed(hand.expr(), ast.Tuple).elts


def _named(keys: Sequence[ast.expr | None], values: list[ast.expr]) -> dict[str, ast.expr]:
    pairs = zip(keys, values, strict=False)
    return {str(needed(key, ast.Constant).value): value for key, value in pairs}
