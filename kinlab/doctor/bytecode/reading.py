"""Steps as statements: loops and branches told from where the paths part and meet."""

from __future__ import annotations

import ast
import inspect
from collections import Counter
from types import CodeType

from kinlab.doctor.bytecode.comprehensions import comprehension, gathers, only_value
from kinlab.doctor.bytecode.conditions import Decision, joined, negated, place, together
from kinlab.doctor.bytecode.expressions import (
    ELEMENT,
    Changed,
    CodeHand,
    Imported,
    Iterated,
    Made,
    Module,
    at,
    is_none,
    span_of,
)
from kinlab.doctor.bytecode.instructions import (
    LAST,
    CodeStep,
    Span,
    UnreadError,
    arguments,
    docstring,
    entry,
    folded,
    leading,
    reachable,
    unchain,
)
from kinlab.doctor.bytecode.steps import do
from kinlab.doctor.bytecode.syntax import nodes

BRANCHES = {"TEST", "AND", "OR"}
GROWING = {"LIST_APPEND", "SET_ADD", "MAP_ADD"}
"""What puts an element into what lies below on the stack: at once, so not to be tried."""

Stops = dict[CodeStep, str]
"""Where a part of a function ends, and how one gets there: ``on``, ``continue``, ``break``."""


def definition(made: Made, name: str) -> ast.FunctionDef:
    """A function's definition from its code object."""
    code = made.code
    reader = Reader(code)
    body = reader.statements()
    if body and isinstance(body[-1], ast.Return) and is_none(body[-1].value) and len(body) > 1:
        body.pop()
    outer = sorted(reader.outside & set(code.co_freevars))
    world = sorted(reader.world)
    head: list[ast.stmt] = [ast.Global(world)] if world else []
    head += [ast.Nonlocal(outer)] if outer else []
    if (text := docstring(code)) is not None:
        head.insert(0, ast.Expr(ast.Constant(text)))
    body, notes = head + (body or [ast.Pass()]), made.notes
    tree = ast.FunctionDef(name, _arguments(made), body, made.decorators, notes.get("return"))
    line = code.co_firstlineno
    last = max((span_of(n) or (line, line))[1] for n in nodes(tree))
    at(tree, (line, max(line, last), 0, 0))
    place(tree)
    return tree


def _arguments(made: Made) -> ast.arguments:
    code, names = made.code, list(arguments(made.code))
    args = [ast.arg(name, made.notes.get(name)) for name in names]
    plain, only = code.co_argcount, code.co_kwonlyargcount
    rest = args[plain + only :]
    star = rest.pop(0) if code.co_flags & inspect.CO_VARARGS else None
    twice = rest.pop(0) if code.co_flags & inspect.CO_VARKEYWORDS else None
    first, keywords = code.co_posonlyargcount, args[plain : plain + only]
    given = [made.keywords.get(arg.arg) for arg in keywords]
    both = args[:first], args[first:plain]
    return ast.arguments(*both, star, keywords, given, twice, made.defaults)


class Reader:
    """Reads one code object."""

    def __init__(self, code: CodeType) -> None:
        self.code = code
        self.first = folded(entry(code))
        unchain(self.first)
        steps = reachable([self.first])
        self.left = 4 * len(steps)
        self.into = Counter(after for step in steps for after in step.after)
        self.into[self.first] += 1
        self.world = {str(s.value) for s in steps if s.op in ("STORE_GLOBAL", "DELETE_GLOBAL")}
        self.outside = {str(s.value) for s in steps if s.op in ("STORE_DEREF", "DELETE_DEREF")}
        self.heads = {a for s in steps for a in s.after if a.index <= s.index}

    def statements(self) -> list[ast.stmt]:
        """The statements of a function."""
        return self.region(self.first, [], {})

    def region(self, step: CodeStep | None, stack: list[object], stops: Stops) -> list[ast.stmt]:
        """The statements from a step on, up to the stops."""
        out: list[ast.stmt] = []
        while step is not None:
            if step in stops:
                if stops[step] != "on":
                    out.append(ast.Continue() if stops[step] == "continue" else ast.Break())
                break
            returned = step in self.heads and step.op != "FOR_ITER"
            if returned and step in reachable(step.after, stops):
                step = self.loop(step, stack, stops, out)
            else:
                step = self.statement(step, stack, stops, out)
        return out

    def statement(
        self, step: CodeStep, stack: list[object], stops: Stops, out: list[ast.stmt], base: int = -1
    ) -> CodeStep | None:
        """One statement; the step after it."""
        base = len(stack) if base < 0 else base
        self.left -= 1
        if self.left < 0:
            raise UnreadError("read again and again")
        hand = CodeHand(stack, self.finish, out)
        start, lines = step, len(out)
        while True:
            if step.op in BRANCHES:
                decision = self.reduced(self.branch(step, hand), stack)
                if not decision.value:
                    if len(stack) != base:
                        raise UnreadError("a branch within an expression")
                    return self.condition(decision, stack, stops, out)
                if decision.paths[decision.yes] != self.into[decision.yes]:
                    raise UnreadError("a value from elsewhere")
                stack.append(decision.test)
                step = decision.yes
                continue
            if step.op == "FOR_ITER" and gathers(stack):
                step = self.gathered(step, stack)
                continue
            if step.op == "FOR_ITER":
                if len(stack) != base + 1:
                    raise UnreadError("a loop within an expression")
                return self.turns(step, stack, stops, out)
            do(step, hand)
            if len(stack) <= base:
                self.flush(hand)
                _stamp(out[lines:], start)
                return step.after[0] if step.after else None
            if not step.after:
                raise UnreadError("an end within an expression")
            step = step.after[0]

    def flush(self, hand: CodeHand) -> None:
        """Make what was stored into statements."""
        stored, hand.stored = hand.stored, []
        values = {id(value): value for value, _ in stored}
        targets: dict[int, list[ast.expr]] = {}
        for value, target in stored:
            targets.setdefault(id(value), []).append(target)
        if len(stored) == 1 and (line := self.bound(*stored[0])) is not None:
            hand.out.append(line)
            return
        pairs = [(hand.as_expr(value), targets[key]) for key, value in values.items()]
        if len(pairs) == 1:
            hand.out.append(ast.Assign(pairs[0][1], pairs[0][0]))
        elif pairs:
            if len(stored) > len(pairs):
                raise UnreadError("several values, several times")
            pairs.sort(key=lambda pair: _turn(pair[0]))
            left = ast.Tuple([found[0] for _, found in pairs], ast.Store())
            hand.out.append(ast.Assign([left], ast.Tuple([node for node, _ in pairs], ast.Load())))

    def bound(self, value: object, target: ast.expr) -> ast.stmt | None:
        """A name given to what is no expression; None where it is one, or becomes one."""
        if isinstance(value, Changed):
            return ast.AugAssign(_stored(value.target, target), value.op, value.by)
        if value is ELEMENT:
            return ast.Assign([target], ast.Constant(None))
        name = target.id if isinstance(target, ast.Name) else ""
        if isinstance(value, Made) and name and value.code.co_name != "<lambda>":
            return definition(value, name)
        if isinstance(value, (Module, Imported)) and name:
            module = value if isinstance(value, Module) else value.module
            plain = value is module and name == module.name.partition(".")[0]
            return ast.Import([ast.alias(module.name, None if plain else name)])
        return None

    # Conditions

    def branch(self, step: CodeStep, hand: CodeHand) -> Decision:
        """A conditional jump as a decision, its value taken from the stack."""
        test = hand.expr()
        if hand.stored or hand.keywords:
            raise UnreadError("stored before a branch")
        first, second = step.after
        if step.op == "OR":
            first, second = second, first
        if step.op == "TEST" and step.value is None:
            none = at(ast.Constant(None), step.span)
            test = at(ast.Compare(test, [ast.Is()], [none]), step.span)
        falls = step.after[step.falls]
        return Decision(test, first, second, False, falls, Counter(step.after), step.span)

    def decide(self, step: CodeStep, stack: list[object]) -> Decision | None:
        """The condition or the value that begins at a step; None if a statement begins there."""
        try:
            return self._decide(step, stack)
        except UnreadError:
            return None

    def _decide(self, step: CodeStep, stack: list[object]) -> Decision | None:
        hand = CodeHand(list(stack), self.finish)
        height, fresh, start = len(stack), False, step
        while True:
            if step.op in BRANCHES:
                decision = self.reduced(self.branch(step, hand), hand.stack)
                inner = len(hand.stack) > height
                if decision.value and decision.paths[decision.yes] == self.into[decision.yes]:
                    hand.stack.append(decision.test)
                    step, fresh = decision.yes, True
                    continue
                return None if inner else decision
            whole = len(hand.stack) == height + 1 and step is not start and not fresh
            if whole and self.into[step] > 1:
                test = hand.expr()
                if hand.stored:
                    return None
                return Decision(test, step, step, True, None, Counter([step]), None)
            fresh = False
            if step.op == "FOR_ITER" and gathers(hand.stack[height:]):
                step = self.gathered(step, hand.stack)
                continue
            if step.op in LAST or step.op == "FOR_ITER":
                return None
            size = step.value if isinstance(step.value, int) else 0
            if step.op in GROWING and size + 1 > len(hand.stack) - height:
                return None
            do(step, hand)
            if (
                len(hand.stack) <= height
                or hand.out
                or any(a is not b for a, b in zip(stack, hand.stack, strict=False))
            ):
                return None
            step = step.after[0]

    def reduced(self, one: Decision, stack: list[object]) -> Decision:
        """A decision with those that follow within the same expression taken in."""
        while not one.value and (falls := one.falls) is not None:
            if self.into[falls] != one.paths[falls]:
                break
            two = self.decide(falls, stack)
            if two is None or not together(one, two):
                break
            other = one.no if falls is one.yes else one.yes
            both = joined(one, two, falls, other)
            if both is None and self.into[other] == one.paths[other]:
                three = self.decide(other, stack)
                if three is not None and two.leads == three.leads:
                    test = one.test if falls is one.yes else negated(one.test)
                    node = ast.IfExp(test, two.test, three.test)
                    paths = two.paths + three.paths
                    both = Decision(node, two.yes, two.no, two.value, three.falls, paths, one.span)
            if both is None:
                break
            one = both
        return one

    def condition(
        self, decision: Decision, stack: list[object], stops: Stops, out: list[ast.stmt]
    ) -> CodeStep | None:
        """An ``if``; the step after it."""
        body_step = decision.falls or decision.yes
        holds = body_step is decision.yes
        other = decision.no if holds else decision.yes
        test = decision.test if holds else negated(decision.test)
        follow = self.meeting(body_step, other, stops)
        inner = stops if follow is None else {**stops, follow: "on"}
        body = self.region(body_step, list(stack), inner) or [ast.Pass()]
        if follow is body_step or follow not in (None, other):
            out.append(ast.If(test, body, self.region(other, list(stack), inner)))
            return follow
        raised = body[0]
        if len(body) == 1 and isinstance(raised, ast.Raise) and _asserts(raised.exc):
            message = raised.exc.args[0] if isinstance(raised.exc, ast.Call) else None
            out.append(ast.Assert(negated(test), message))
        else:
            out.append(ast.If(test, body, []))
        return other

    def meeting(self, one: CodeStep, two: CodeStep, stops: Stops) -> CodeStep | None:
        """Where two paths meet again before the part of the function ends."""
        if one in stops and stops[one] != "on":
            return None
        both = reachable([one], stops) & reachable([two], stops)
        for kind in (None, "on", "continue"):
            found = [step for step in both if stops.get(step) == kind]
            if found:
                return min(found, key=lambda step: step.index)
        on = [step for step in reachable([one], stops) if stops.get(step) == "on"]
        return min(on, key=lambda step: step.index, default=None)

    # Loops

    def loop(
        self, head: CodeStep, stack: list[object], stops: Stops, out: list[ast.stmt]
    ) -> CodeStep | None:
        """A ``while``; the step after it."""
        decision = self.decide(head, stack)
        around = [*stops, head]
        if decision is not None and not decision.value and decision.yes is not decision.no:
            turns = [head in reachable([s], stops) for s in (decision.yes, decision.no)]
            if turns[0] != turns[1]:
                body, leave, test = decision.yes, decision.no, decision.test
                if turns[1]:
                    body, leave, test = leave, body, negated(test)
                end, orelse = self.leaving(head, body, leave, stack, stops)
                inner: Stops = {head: "continue", end: "break"}
                lines = _tail(self.region(body, list(stack), inner))
                out.append(ast.While(test, lines, orelse))
                return end
        inside = leading(head, reachable(head.after, around), stops)
        ends = [a for s in inside for a in s.after if a not in inside]
        last = max(ends, key=lambda step: step.index, default=None)
        inner = {head: "continue"} if last is None else {head: "continue", last: "break"}
        self.heads.discard(head)
        lines, held = list[ast.stmt](), list(stack)
        first = self.statement(head, held, inner, lines)
        lines += self.region(first, held, inner)
        out.append(ast.While(ast.Constant(True), _tail(lines), []))
        return last

    def turns(
        self, head: CodeStep, stack: list[object], stops: Stops, out: list[ast.stmt]
    ) -> CodeStep | None:
        """A ``for``; the step after it."""
        through = stack.pop()
        over = through.over if isinstance(through, Iterated) else through
        if not isinstance(over, ast.expr):
            raise UnreadError("a loop over no expression")
        body, leave = head.after
        end, orelse = self.leaving(head, body, leave, stack, stops)
        inside: list[object] = [*stack, Iterated(over), ELEMENT]
        first: list[ast.stmt] = []
        step = self.statement(body, inside, {}, first, base=len(inside) - 1)
        stored = first[0] if len(first) == 1 else None
        if not isinstance(stored, ast.Assign):
            raise UnreadError("a loop without a name")
        lines = _tail(self.region(step, inside, {head: "continue", end: "break"}))
        out.append(ast.For(stored.targets[0], over, lines, orelse))
        return end

    def leaving(
        self, head: CodeStep, body: CodeStep, leave: CodeStep, stack: list[object], stops: Stops
    ) -> tuple[CodeStep, list[ast.stmt]]:
        """Where a loop's ``break`` leads, and the lines of its ``else``."""
        around = [*stops, head]
        within = leading(head, reachable([body], around), stops)
        broken = [a for s in within - {head} for a in s.after if a not in within]
        broken += [] if body in within else [body]
        out = reachable(broken, around)
        last = max((step.index for step in within), default=head.index) + 1
        first = head.ends or (last if leave in stops else leave.index)
        inside = [s for s in within | out if head.index < s.index < first]
        beyond = {a for s in inside for a in s.after if not head.index <= a.index < first}
        if leave in beyond or (leave in out and leave not in stops):
            return leave, []
        beyond = beyond or (out & reachable([leave], around)) - set(stops) - {head}
        if not beyond:
            return leave, []
        end = min(beyond, key=lambda step: step.index)
        return end, self.region(leave, list(stack), {**stops, end: "on"})

    # Functions within

    def finish(self, made: Made, over: ast.expr | None, span: Span | None) -> ast.expr:
        """A lambda, or a comprehension, as an expression."""
        reader = Reader(made.code)
        if made.code.co_name == "<lambda>" and over is None:
            return at(ast.Lambda(_arguments(made), only_value(reader.statements())), span)
        if made.code.co_name == "__annotate__":
            return only_value(reader.statements()[-1:])
        if over is None or made.defaults or made.keywords:
            raise UnreadError("a function without a name")
        first, stack = reader.first, list[object]()
        if first.op in ("BUILD_LIST", "BUILD_SET", "BUILD_MAP"):  # what it fills, not yet given
            do(first, CodeHand(stack, reader.finish))
            first = first.after[0]
        filled = stack[0] if stack else None
        return at(comprehension(reader.region(first, stack, {}), filled, over), span)

    def gathered(self, head: CodeStep, stack: list[object]) -> CodeStep:
        """A comprehension within its function (3.12 on), left on the stack; the step after it."""
        through, made, lines = stack[-1], stack[-2], list[ast.stmt]()
        behind = self.turns(head, stack, {}, lines)
        if behind is None or not isinstance(through, Iterated):
            raise UnreadError("no comprehension")
        stack[-1] = at(comprehension(lines, made, through.over), head.span)
        return behind


def _tail(lines: list[ast.stmt]) -> list[ast.stmt]:
    """The lines of a loop without a ``continue`` at their end, where it goes without saying."""
    if lines and isinstance(lines[-1], ast.Continue):
        lines = lines[:-1]
    if lines and isinstance(last := lines[-1], ast.If):
        last.body = _tail(last.body)
        if last.orelse:
            last.orelse = _tail(last.orelse)
    return lines or [ast.Pass()]


def _stored(loaded: ast.expr, target: ast.expr) -> ast.Name | ast.Attribute | ast.Subscript:
    """The target of an augmented assignment: what was loaded before."""
    if not isinstance(target, (ast.Name, ast.Attribute, ast.Subscript)):
        raise UnreadError("stored in several places")
    if ast.unparse(loaded) != ast.unparse(target):
        raise UnreadError("stored in another place")
    return target


def _asserts(raised: ast.expr | None) -> bool:
    named = raised.func if isinstance(raised, ast.Call) else raised
    if isinstance(raised, ast.Call) and (len(raised.args) != 1 or raised.keywords):
        return False
    return isinstance(named, ast.Name) and getattr(named, "asserted", False)


def _turn(node: ast.expr) -> int:
    """When an expression is done, among the others of its statement."""
    return max(getattr(part, "turn", -1) for part in nodes(node))


def _stamp(lines: list[ast.stmt], step: CodeStep) -> None:
    """A place for statements that have no expression to take it from."""
    for line in lines:
        if isinstance(line, (ast.Import, ast.ImportFrom)):
            at(line, step.span)
