"""What each step does to the stack of syntax trees."""

from __future__ import annotations

import ast
import sys
from collections.abc import Callable
from types import CodeType

from kinlab.doctor.bytecode.expressions import (
    BINARY,
    COMPARE,
    NULL,
    SELF,
    UNARY,
    Changed,
    CodeHand,
    Hole,
    Imported,
    Iterated,
    Made,
    Module,
    Raw,
    Saved,
    Unpacked,
    at,
    literal,
    span_of,
)
from kinlab.doctor.bytecode.instructions import CodeStep, Span, UnreadError

NULL_ABOVE = sys.version_info >= (3, 13)
"""Whether the empty entry of a call lies above its function, not below."""

Finish = Callable[[Made, "ast.expr | None", "Span | None"], ast.expr]
"""A function just made as an expression: a lambda, or a comprehension over what is given."""


def do(step: CodeStep, hand: CodeHand, finish: Finish) -> None:
    """One step that does not jump.

    Raises:
        UnreadError: The step is not known, or the stack is not as it needs.
    """
    op, span, stack = step.op, step.span, hand.stack
    value = step.value
    number = value if isinstance(value, int) else 0
    name = value if isinstance(value, str) else ""

    def push(node: ast.expr) -> None:
        setattr(node, "turn", step.index)  # noqa: B010
        stack.append(at(node, span))

    def pop() -> ast.expr:
        top = hand.pop()
        if isinstance(top, Made):
            return finish(top, None, span)
        return hand.as_expr(top)

    def many(count: int) -> list[ast.expr]:
        return [pop() for _ in range(count)][::-1]

    def under(depth: int) -> object:
        if not 1 <= depth <= len(stack):
            raise UnreadError("an empty stack")
        return stack[-depth]

    match op:
        case "LOAD_FAST" | "LOAD_GLOBAL" | "LOAD_DEREF" | "LOAD_NAME":
            if step.bit and not NULL_ABOVE:
                stack.append(NULL)
            push(ast.Name(name, ast.Load()))
            if step.bit and NULL_ABOVE:
                stack.append(NULL)
        case "LOAD_FAST_AND_CLEAR":
            stack.append(Saved())
        case "LOAD_CLOSURE":
            push(ast.Name(name, ast.Load()))
        case "LOAD_CONST":
            if isinstance(value, CodeType):
                stack.append(Raw(value))
            else:
                push(literal(value, span))
        case "PUSH_NULL":
            stack.append(NULL)
        case "LOAD_ASSERTION_ERROR":
            push(ast.Name("AssertionError", ast.Load()))
            setattr(stack[-1], "asserted", True)  # noqa: B010
        case "POP_TOP":
            _pop_top(hand, pop, span)
        case "COPY":
            stack.append(under(number))
        case "SWAP":
            under(number)
            stack[-1], stack[-number] = stack[-number], stack[-1]
        case _ if op in UNARY:
            push(ast.UnaryOp(UNARY[op](), pop()))
        case "BINARY_OP":
            right, left = pop(), pop()
            if number < len(BINARY):
                push(ast.BinOp(left, BINARY[number](), right))
            elif number < 2 * len(BINARY):
                stack.append(Changed(left, BINARY[number - len(BINARY)](), right))
            else:  # 3.14
                push(ast.Subscript(left, right, ast.Load()))
        case "BINARY_SUBSCR":
            index, whole = pop(), pop()
            push(ast.Subscript(whole, index, ast.Load()))
        case "BINARY_SLICE":
            parts = [None if _none(part) else part for part in many(2)]
            push(ast.Subscript(pop(), at(ast.Slice(*parts), span), ast.Load()))
        case "STORE_SLICE":
            parts = [None if _none(part) else part for part in many(2)]
            whole = ast.Subscript(pop(), at(ast.Slice(*parts), span), ast.Store())
            hand.store(hand.pop(), at(whole, span))
        case "COMPARE_OP" | "IS_OP" | "CONTAINS_OP" | "CHAIN":
            _compare(step, hand, pop)
        case "LOAD_ATTR":
            push(ast.Attribute(pop(), name, ast.Load()))
        case "LOAD_METHOD":
            push(ast.Attribute(pop(), name, ast.Load()))
            stack.append(SELF)
        case "BUILD_SLICE":
            parts = [None if _none(part) else part for part in many(number)]
            push(ast.Slice(*parts))
        case "BUILD_TUPLE":
            push(ast.Tuple(many(number), ast.Load()))
        case "BUILD_LIST":
            push(ast.List(many(number), ast.Load()))
        case "BUILD_SET":
            push(ast.Set(many(number)))
        case "BUILD_MAP":
            pairs = many(2 * number)
            push(ast.Dict(list(pairs[::2]), pairs[1::2]))
        case "BUILD_CONST_KEY_MAP":
            keys = pop()
            if not isinstance(keys, ast.Tuple):
                raise UnreadError("keys that are no tuple")
            push(ast.Dict(list(keys.elts), many(number)))
        case "LIST_EXTEND" | "SET_UPDATE":
            more = pop()
            into = under(number)
            if not isinstance(into, (ast.List, ast.Set)):
                raise UnreadError("not extended here")
            if isinstance(more, (ast.Tuple, ast.Set)) and not into.elts and len(more.elts) > 2:
                into.elts.extend(more.elts)
            else:
                into.elts.append(at(ast.Starred(more, ast.Load()), span))
        case "LIST_APPEND" | "SET_ADD":
            element = pop()
            into = under(number)
            if not isinstance(into, (ast.List, ast.Set)):
                raise UnreadError("not appended here")
            into.elts.append(element)
        case "MAP_ADD":
            element, key = pop(), pop()
            _dict(under(number)).keys.append(key)
            _dict(under(number)).values.append(element)
        case "DICT_UPDATE" | "DICT_MERGE":
            more = pop()
            into = _dict(under(number))
            if op == "DICT_UPDATE" and isinstance(more, ast.Dict) and None not in more.keys:
                into.keys.extend(more.keys)  # a long literal, made piece by piece
                into.values.extend(more.values)
            else:
                into.keys.append(None)
                into.values.append(more)
        case "LIST_TO_TUPLE":
            push(ast.Tuple(_list(pop()).elts, ast.Load()))
        case "CALL_INTRINSIC_1" if number == 5:
            push(ast.UnaryOp(ast.UAdd(), pop()))
        case "CALL_INTRINSIC_1" if number == 6:
            push(ast.Tuple(_list(pop()).elts, ast.Load()))
        case "FORMAT_VALUE":
            flags = step.value
            if not isinstance(flags, tuple):
                raise UnreadError("FORMAT_VALUE")
            spec = _joined([pop()], span) if flags[1] else None
            conversion = _conversion(flags[0])
            push(ast.JoinedStr([at(ast.FormattedValue(pop(), conversion, spec), span)]))
        case "CONVERT_VALUE":
            push(ast.FormattedValue(pop(), _conversion(value), None))
        case "FORMAT_SIMPLE" | "FORMAT_WITH_SPEC":
            spec = _joined([pop()], span) if op == "FORMAT_WITH_SPEC" else None
            part = pop()
            if not isinstance(part, ast.FormattedValue):
                part = at(ast.FormattedValue(part, -1, None), span)
            part.format_spec = spec
            push(ast.JoinedStr([part]))
        case "BUILD_STRING":
            stack.append(_joined(many(number), span))
        case "KW_NAMES":
            if not isinstance(value, tuple):
                raise UnreadError("KW_NAMES")
            hand.keywords = value
        case "CALL_KW":
            hand.keywords = _names(hand.pop())
            _call(hand, number, pop, many, finish, span)
        case "SET_FUNCTION_ATTRIBUTE":
            function = hand.pop()
            if not isinstance(function, Made):
                raise UnreadError("no function")
            _attribute(function, number, pop)
            stack.append(function)
        case "CALL":
            _call(hand, number, pop, many, finish, span)
        case "CALL_FUNCTION_EX":
            _call_stars(hand, number & 1, pop, span)
        case "MAKE_FUNCTION":
            stack.append(_made(hand, number, pop))
        case "GET_ITER":
            stack.append(Iterated(pop()))
        case "YIELD_VALUE":
            push(ast.Yield(pop()))
        case "UNPACK_SEQUENCE" | "UNPACK_EX":
            star = None
            if op == "UNPACK_EX":
                star = number & 0xFF
                number = star + 1 + (number >> 8)
            parted = Unpacked(hand.pop(), [None] * number, star)
            stack.extend(Hole(parted, n) for n in reversed(range(number)))
        case "STORE_FAST" | "STORE_GLOBAL" | "STORE_DEREF" | "STORE_NAME":
            hand.store(hand.pop(), at(ast.Name(name, ast.Store()), span))
        case "STORE_ATTR":
            target = at(ast.Attribute(pop(), name, ast.Store()), span)
            hand.store(hand.pop(), target)
        case "STORE_SUBSCR":
            index, whole_ = pop(), pop()
            hand.store(hand.pop(), at(ast.Subscript(whole_, index, ast.Store()), span))
        case "DELETE_FAST" | "DELETE_GLOBAL" | "DELETE_DEREF" | "DELETE_NAME":
            hand.out.append(ast.Delete([at(ast.Name(name, ast.Del()), span)]))
        case "DELETE_SUBSCR":
            index, whole_ = pop(), pop()
            hand.out.append(ast.Delete([at(ast.Subscript(whole_, index, ast.Del()), span)]))
        case "DELETE_ATTR":
            hand.out.append(ast.Delete([at(ast.Attribute(pop(), name, ast.Del()), span)]))
        case "RETURN_VALUE":
            given = pop()
            alone = _none(given) and span_of(given) == span
            hand.out.append(at(ast.Return(None if alone else given), span))
        case "RAISE_VARARGS":
            parts_ = many(number)
            hand.out.append(at(ast.Raise(*parts_), span))
        case "IMPORT_NAME":
            names, level = pop(), pop()
            if not isinstance(level, ast.Constant) or not isinstance(level.value, int):
                raise UnreadError("an import from no level")
            stack.append(Module(name, level.value, not _none(names)))
        case "IMPORT_FROM":
            module = under(1)
            if isinstance(module, Imported):
                module = module.module
            if not isinstance(module, Module):
                raise UnreadError("not from a module")
            stack.append(Imported(module, name))
        case _:
            raise UnreadError(op)


def _none(node: ast.expr) -> bool:
    return isinstance(node, ast.Constant) and node.value is None


def _conversion(by: object) -> int:
    """The letter of ``!s``, ``!r`` or ``!a`` in an f-string, by its function; -1 for none."""
    for function, letter in ((None, -1), (str, ord("s")), (repr, ord("r")), (ascii, ord("a"))):
        if by is function:
            return letter
    raise UnreadError("a conversion")


def _dict(node: object) -> ast.Dict:
    if not isinstance(node, ast.Dict):
        raise UnreadError("no dict")
    return node


def _list(node: object) -> ast.List:
    if not isinstance(node, ast.List):
        raise UnreadError("no list")
    return node


def _joined(parts: list[ast.expr], span: Span | None) -> ast.JoinedStr:
    values: list[ast.expr] = []
    for part in parts:
        values.extend(part.values if isinstance(part, ast.JoinedStr) else [part])
    return at(ast.JoinedStr(values), span)


def _pop_top(hand: CodeHand, pop: Callable[[], ast.expr], span: Span | None) -> None:
    top = hand.stack[-1] if hand.stack else None
    if isinstance(top, Module):
        hand.pop()
        if top.aliases:
            hand.out.append(at(ast.ImportFrom(top.name or None, top.aliases, top.level), span))
    elif isinstance(top, (Iterated, Imported)):
        hand.pop()
    else:
        node = pop()
        if isinstance(node, ast.NamedExpr):
            raise UnreadError("a value stored and left")
        hand.out.append(at(ast.Expr(node), None))


def _compare(step: CodeStep, hand: CodeHand, pop: Callable[[], ast.expr]) -> None:
    right, left = pop(), pop()
    kind, value = step.op, step.value
    if kind == "CHAIN":
        if not isinstance(value, tuple):
            raise UnreadError("CHAIN")
        kind, value = value
    if kind == "COMPARE_OP":
        if str(value) not in COMPARE:
            raise UnreadError(f"a comparison by {value}")
        op: ast.cmpop = COMPARE[str(value)]()
    elif kind == "IS_OP":
        op = ast.IsNot() if value else ast.Is()
    else:
        op = ast.NotIn() if value else ast.In()
    node = ast.Compare(left, [op], [right])
    if isinstance(left, ast.Compare) and getattr(left, "open", False):
        node = ast.Compare(left.left, [*left.ops, op], [*left.comparators, right])
    if step.op == "CHAIN":
        setattr(node, "open", True)  # noqa: B010
    hand.stack.append(at(node, step.span))


def _call(
    hand: CodeHand,
    count: int,
    pop: Callable[[], ast.expr],
    many: Callable[[int], list[ast.expr]],
    finish: Finish,
    span: Span | None,
) -> None:
    arguments = many(count)
    names, hand.keywords = hand.keywords, ()
    positional = len(arguments) - len(names)
    keywords = [
        at(ast.keyword(name, node), span)
        for name, node in zip(names, arguments[positional:], strict=True)
    ]
    arguments = arguments[:positional]
    upper, lower = hand.pop(), hand.pop()
    if upper is SELF:
        function = hand.as_expr(lower)
    elif lower is NULL or upper is NULL:
        upper, lower = (lower, upper) if upper is NULL else (upper, lower)
        function = finish(upper, None, span) if isinstance(upper, Made) else hand.as_expr(upper)
    elif isinstance(lower, Made) and isinstance(upper, Iterated):
        hand.stack.append(finish(lower, upper.over, span))
        return
    elif getattr(lower, "asserted", False) and not count:
        node = ast.Call(hand.as_expr(lower), [hand.as_expr(upper)], [])
        hand.stack.append(at(node, span))
        return
    elif isinstance(upper, Made) and not upper.code.co_name.startswith("<"):
        upper.decorators.insert(0, hand.as_expr(lower))
        hand.stack.append(upper)
        return
    else:
        raise UnreadError("a call of nothing known")
    node = at(ast.Call(function, arguments, keywords), span)
    if lower is NULL and isinstance(function, ast.Attribute):
        setattr(node, "of_import", True)  # noqa: B010
    hand.stack.append(node)


def _call_stars(hand: CodeHand, named: int, pop: Callable[[], ast.expr], span: Span | None) -> None:
    keywords: list[ast.keyword] = []
    if named:
        given = pop()
        if isinstance(given, ast.Dict) and given.keys:
            for key, node in zip(given.keys, given.values, strict=True):
                if key is not None and not isinstance(key, ast.Constant):
                    raise UnreadError("a keyword that is no name")
                arg = None if key is None else str(key.value)
                keywords.append(at(ast.keyword(arg, node), span))
        else:
            keywords.append(at(ast.keyword(None, given), span))
    stars = pop()
    if isinstance(stars, ast.Tuple) and (named or len(stars.elts) > 15 or _starred(stars)):
        arguments = stars.elts
    else:
        arguments = [at(ast.Starred(stars, ast.Load()), span)]
    pair = [hand.pop(), hand.pop()]
    if NULL not in pair:
        raise UnreadError("a call of nothing known")
    pair.remove(NULL)
    function = hand.as_expr(pair[0])
    hand.stack.append(at(ast.Call(function, arguments, keywords), span))


def _starred(node: ast.Tuple) -> bool:
    return any(isinstance(element, ast.Starred) for element in node.elts)


def _made(hand: CodeHand, flags: int, pop: Callable[[], ast.expr]) -> Made:
    code = hand.pop()
    if not isinstance(code, Raw) or not isinstance(code.value, CodeType):
        raise UnreadError("a function without code")
    made = Made(code.value, [], {}, {})
    for flag in (8, 4, 2, 1):
        _attribute(made, flags & flag, pop)
    return made


def _attribute(made: Made, flags: int, pop: Callable[[], ast.expr]) -> None:
    """What a function is made with: closure, annotations, defaults."""
    if flags & 8:
        pop()
    if flags & 4:
        notes = pop()
        if not isinstance(notes, ast.Tuple):
            raise UnreadError("annotations")
        made.notes = _named(notes.elts[::2], notes.elts[1::2])
    if flags & 2:
        given = _dict(pop())
        made.keywords = _named(given.keys, given.values)
    if flags & 1:
        defaults = pop()
        if not isinstance(defaults, ast.Tuple):
            raise UnreadError("defaults")
        made.defaults = defaults.elts


def _names(node: object) -> tuple[str, ...]:
    """The names of keywords, a tuple of strings."""
    if not isinstance(node, ast.Tuple):
        raise UnreadError("names that are no tuple")
    return tuple(str(e.value) for e in node.elts if isinstance(e, ast.Constant))


def _named(
    keys: list[ast.expr | None] | list[ast.expr], values: list[ast.expr]
) -> dict[str, ast.expr]:
    if len(keys) != len(values):
        raise UnreadError("names without values")
    return {
        str(key.value): value
        for key, value in zip(keys, values, strict=True)
        if isinstance(key, ast.Constant)
    }
