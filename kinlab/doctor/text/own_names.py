"""A file's formulas in the robot's names: the writer's own names and numbers, what they mean."""

from __future__ import annotations

import ast
import re
from collections.abc import Collection, Iterator
from dataclasses import replace
from functools import partial

import numpy as np

from kinlab.doctor.changes import Mechanism
from kinlab.doctor.derived import LETTERS, WRENCH
from kinlab.doctor.linkages import five_bar
from kinlab.doctor.linkages.named_numbers import named_numbers
from kinlab.doctor.text.claims import claimed_of
from kinlab.doctor.text.joints import given_names
from kinlab.doctor.text.meanings import Meanings, exact_angle, stands_for
from kinlab.doctor.text.written import Written, literal
from kinlab.errors import ExpressionError
from kinlab.fivebar import FiveBar
from kinlab.formulas import tree, typed
from kinlab.formulas.files import FormulaFile
from kinlab.formulas.retyped import Typing
from kinlab.formulas.signs.refusals import near_names, refused
from kinlab.formulas.text import MOST_NODES, canonical, parse, tidied
from kinlab.formulas.tree import Node
from kinlab.host.language import N_, _
from kinlab.tolerances import TOLERANCES

_OF_LINK = re.compile(r"(?:alpha|w)_?[2-9]")
"""A rate or an acceleration of a joint to some, of a link to others."""
DECIMAL = re.compile(r"(?<![\w.])\d+\.\d+(?![\w.])")
_LENGTH = re.compile(r"(?:l|r|lc|l_c|r_c)_?\d+")
_JOINT = re.compile(r"(?:theta|th|q)_?\d+")


def in_robot_names(text: Node, file: FormulaFile, robot: Mechanism, entry: str) -> Node:
    """A formula with the robot's own names in place of the user's.

    Raises:
        ExpressionError: a name without a meaning; the message names the entry.
    """
    words = named_numbers(robot, entry)
    if isinstance(robot, FiveBar):
        known = {*words, *five_bar.known_names(entry)}
    else:
        joints = range(1, robot.n + 1)
        known = {*words, *(f"{letter}{i}" for letter in LETTERS.values() for i in joints)}
        known |= {*given_names(entry, robot.table), *WRENCH}
        if claimed_of(entry, robot).startswith("forward_dynamics"):
            known |= {f"tau{i}" for i in joints}
    place = f"{file.path}: {entry}"
    _refuse_large(text, file, place, {}, ())
    return _resolved(text, file, words, known, place)


def with_underscores(file: FormulaFile, robot: Mechanism) -> FormulaFile:
    """The formulas with V_1 as what the writer explains as V1, unless that is the same by habit.

    Args:
        file: the formulas as they were read; of ``V_1 = ...`` the name is V1.
        robot: whose they are.
    """
    nodes = (*file.formulas.values(), *file.symbols.values())
    used = {name for node in nodes for name in tree.names(node)}
    words = named_numbers(robot)
    symbols, texts = dict(file.symbols), dict(file.symbol_texts)
    for name in sorted(used - {*file.symbols}):
        plain = name.replace("_", "")
        given = symbols.get(plain)
        if given is None or _by_habit(name, given, words) or name in _made_of(given, file):
            continue
        if plain in used or plain in words:
            symbols[name], texts[name] = tree.sym(plain), plain
        else:
            symbols[name], texts[name] = symbols.pop(plain), texts.pop(plain)
    return replace(file, symbols=symbols, symbol_texts=texts)


def _by_habit(name: str, given: Node, words: dict[str, float]) -> bool:
    """Whether what a writer explains a name by is what it means anyway: ``l_1 = 0.5``."""
    meant = canonical(name)
    if given.op == "num" and meant.value in words:
        return may_be(_digits(given), words[str(meant.value)])
    return tree.renamed(given, {word: canonical(word) for word in tree.names(given)}) == meant


def _made_of(text: Node, file: FormulaFile) -> set[str]:
    """Every name in a text and in what stands behind its names."""
    found: set[str] = set()
    waiting = {*tree.names(text)}
    while waiting:
        found |= waiting
        inner = (file.symbols[name] for name in waiting if name in file.symbols)
        waiting = {name for node in inner for name in tree.names(node)} - found
    return found


def as_distances(
    file: FormulaFile, robot: Mechanism, given: Collection[str]
) -> tuple[FormulaFile, dict[str, str]]:
    """The formulas with lengths as their writer may have them, where the table's are negative.

    Args:
        file: the formulas, with a meaning for each name that has one by habit.
        robot: whose they are.
        given: names that the writer explains.

    Returns:
        They, and of each such name what is said of it; nothing of a robot without a DH table.
    """
    words = named_numbers(robot)
    values = {name: np.asarray(value, dtype=float) for name, value in words.items()}
    used = {name for text in file.formulas.values() for name in tree.names(text)} - {*given}
    symbols, texts = dict(file.symbol_texts), dict(file.texts)
    said: dict[str, str] = {}
    told = _("{name} is a distance, {length:g} m: in the table it is {value:g} m along the axis")
    for name in sorted(used) if not isinstance(robot, FiveBar) else ():
        meant = tree.sym(name) if name in words else file.symbols.get(name)
        if meant is None or not _LENGTH.fullmatch(name) or not tree.names(meant) <= {*words}:
            continue
        value = float(tree.evaluate(meant, values))
        if value < 0.0:
            said[name] = told.format(name=name, length=-value, value=value)
            if name in words:
                minus = rf"(-{name})"
                texts = {k: re.sub(rf"\b{name}\b", minus, text) for k, text in texts.items()}
            else:
                symbols[name] = f"-({file.symbol_texts[name]})"
    turned = {name: tree.mul(tree.num(-1), tree.sym(name)) for name in said if name in words}
    formulas = {entry: tree.renamed(text, turned) for entry, text in file.formulas.items()}
    meant_ = file.symbols | {name: parse(symbols[name]) for name in said if name in symbols}
    new = replace(file, formulas=formulas, texts=texts, symbols=meant_, symbol_texts=symbols)
    return new, said


def _refuse_large(
    text: Node, file: FormulaFile, place: str, sizes: dict[str, int], open_names: tuple[str, ...]
) -> int:
    """Counts the terms and factors with all symbols written out, before they are.

    Raises:
        ExpressionError: more than a formula of an arm can have, or a symbol explained by itself.
    """
    total = 0
    for _path, node in tree.nodes(text):
        total += 1
        if node.op != "sym" or node.value not in file.symbols:
            continue
        name = node.value
        if name in open_names:
            raise refused(place, N_("symbol {name!r} is explained by itself"), name=name)
        if name not in sizes:
            way = (*open_names, name)
            sizes[name] = _refuse_large(file.symbols[name], file, place, sizes, way)
        total += sizes[name]
        if total > MOST_NODES:
            break
    if total > MOST_NODES:
        raise refused(
            place,
            N_("with its symbols written out it has more than {most_nodes} terms and factors"),
            most_nodes=MOST_NODES,
        )
    return total


def _resolved(
    text: Node, file: FormulaFile, words: dict[str, float], known: set[str], place: str
) -> Node:
    mapping = {}
    for name in sorted(tree.names(text)):
        if name in file.symbols:
            given = file.symbols[name]
            if given.op == "num":
                mapping[name] = _by_value(name, given, words, place)
            else:
                mapping[name] = _resolved(given, file, words, known, place)
            continue
        if name in words:
            continue
        meant = canonical(name)
        if not tree.names(meant) <= known:
            if _OF_LINK.fullmatch(name):
                joint = f"q{'dd' if name[0] == 'a' else 'd'}{name[-1]}"
                raise refused(
                    f"{place}: {name}",
                    N_(
                        "of joint {text}, or of link {text}? write {joint} or the sum of the "
                        "joints', or explain it in [symbols]"
                    ),
                    text=name[-1],
                    joint=joint,
                )
            choices = near_names(name, [*words, *sorted(known - set(words)), *file.symbols])
            raise refused(
                place,
                N_("{text!r} is unknown; {choices}; or give it a meaning in [symbols]"),
                text=name[:40],
                choices=choices,
            )
        mapping[name] = meant
    return tree.renamed(text, mapping)


def _by_value(name: str, given: Node, words: dict[str, float], place: str) -> Node:
    """A user's symbol with a number: the robot's parameter of that value, or the number."""
    value = float(given.value)
    if name in words:
        if not may_be(_digits(given), words[name]):
            raise refused(
                place,
                N_(
                    "{name} is {value:g} in [symbols] and {text:g} in the robot; give the robot's "
                    "number, or another name"
                ),
                name=name,
                value=value,
                text=words[name],
            )
        return tree.sym(name)
    alike = [w for w, x in words.items() if abs(x - value) <= TOLERANCES.same_number * abs(x)]
    close = [w for w in alike if w[0].lower() == name[0].lower()]
    numbered = [w for w in close if w[-1] == name[-1] and w[-1].isdigit()]
    for found in (alike, close, numbered):
        if len(found) == 1:
            return tree.sym(found[0])
    return given


def _digits(given: Node) -> str:
    """A symbol's number as digits; 10.0 was 10 before it was read."""
    return repr(float(given.value)).removesuffix(".0")


def may_be(digits: str, value: float) -> bool:
    """Whether a number is another one, or that one rounded to its digits."""
    one = literal(digits.lstrip("-"))
    gap = abs((-one.value if digits.startswith("-") else one.value) - value)
    return gap <= max(TOLERANCES.same_number * abs(value), 1.0001 * one.reach)


def written_as(entry: str, node: Node, file: FormulaFile, robot: Mechanism) -> Written:
    """A formula with what its writer's names stand for."""
    words = named_numbers(robot, entry)
    known: dict[str, Node] = {}
    texts: dict[str, str] = {}
    rounded: dict[str, str] = {}
    for name, given in file.symbols.items():
        texts[name] = file.symbol_texts[name]
        if given.op != "num":
            continue
        texts[name] = _digits(given)
        meant = _by_value(name, given, words, f"{file.path}: {entry}")
        if meant.op == "sym":
            known[name] = meant
            exact = words[str(meant.value)]
            if abs(float(given.value) - exact) > TOLERANCES.same_number * abs(exact):
                rounded[name] = _("{name} = {written} stands for {meant:.10g}").format(
                    name=name, written=texts[name], meant=exact
                )
    if isinstance(robot, FiveBar):
        texts = five_bar.of_entry(texts, entry)
    inside = tree.names(file.formulas[entry])
    used = [note for name, note in rounded.items() if name in inside]
    written = file.texts[entry]
    typing, of_definition = typing_of(entry, file), partial(_definition_typed, file)
    rest = (known, tuple(used), file.numbers, typing, of_definition)
    return Written(entry, written, node, texts, *rest)


def _definition_typed(file: FormulaFile, name: str, text: str) -> Typing | None:
    """A definition as it was typed; None where that is its plain text, or another's."""
    given = file.symbols_typed.get(name)
    if given is None:
        return None
    try:
        found = _typing(given, name, file)
    except ExpressionError:
        return None
    return found if found is not None and found.plain == text else None


def typing_of(entry: str, file: FormulaFile) -> Typing | None:
    """An entry as it was typed; None where that is its plain text."""
    return _typing(file.as_typed[entry], entry, file)


def _typing(given: str, entry: str, file: FormulaFile) -> Typing | None:
    core, dollars = typed.bare(given), typed.is_latex(given)

    def reads(line: str) -> str:
        return typed.plain_formula(f"${line}$" if dollars else line, entry, file.writing)

    plain = tidied(reads(core))
    if tidied(core) == plain and "^" not in core:
        return None
    return Typing(core, plain, tuple(typed.leaves_of(core, entry, file.writing, dollars)), reads)


# -------- Constants that are written as rounded decimals


def constants_named(file: FormulaFile, robot: Mechanism) -> tuple[FormulaFile, dict[str, str]]:
    """The file with names for decimals that are g or an angle rounded, and what is to be said.

    A slip is told beside a rounded number only where the number is read as what it stands for.
    """
    words = named_numbers(robot)
    said: dict[str, str] = {}
    numbers: dict[str, str] = {}
    meant: dict[str, str] = {}

    def named(entry: str, text: str) -> str:
        angles = set(_angles_in(text, _JOINT.fullmatch(entry) is not None))

        def name(found: re.Match[str]) -> str:
            meaning = _constant(found[0], found.start() in angles, words.get("g", 0.0))
            if meaning is None:
                return found[0]
            letter, told = meaning
            if told:
                said[found[0]] = told
            name = f"{'g' if letter == 'g' else 'pi'}_{found[0].replace('.', '_')}"
            numbers[name], meant[name] = found[0], letter
            return name

        return DECIMAL.sub(name, text)

    texts = {entry: named(entry, text) for entry, text in file.texts.items()}
    own = {
        symbol: named(symbol, text)
        for symbol, text in file.symbol_texts.items()
        if file.symbols[symbol].op != "num"
    }
    if not said:
        return file, said
    made = own | meant
    return (
        replace(
            file,
            texts=texts,
            formulas={
                entry: node if texts[entry] == file.texts[entry] else parse(texts[entry], entry)
                for entry, node in file.formulas.items()
            },
            numbers=numbers,
            symbols=file.symbols | {symbol: parse(text) for symbol, text in made.items()},
            symbol_texts=file.symbol_texts | made,
        ),
        said,
    )


def _constant(digits: str, angle: bool, weight: float) -> tuple[str, str] | None:
    """What a decimal stands for, and the sentence where it is not that to its last digit."""
    if angle:
        exact = exact_angle(float(digits))
        shown = Meanings({}).named(exact) if exact is not None else ""
        return (shown, stands_for(digits, shown)) if "pi" in shown else None
    if not weight or not may_be(digits, weight):
        return None
    near = abs(float(digits) - weight) <= TOLERANCES.same_number * abs(weight)
    return "g", "" if near else stands_for(digits, f"g = {weight:.10g}")


def _angles_in(text: str, joint: bool) -> Iterator[int]:
    """Where decimals stand that can only be angles: in a sine's argument, in a joint's sum."""
    root = ast.parse(text, mode="eval").body
    waiting = [
        node.args[0]
        for node in ast.walk(root)
        if isinstance(node, ast.Call) and getattr(node.func, "id", "") in ("sin", "cos", "tan")
    ]
    waiting += [root] if joint else []
    while waiting:
        match waiting.pop():
            case ast.Constant() as one:
                yield one.col_offset
            case ast.UnaryOp(operand=inside):
                waiting.append(inside)
            case ast.BinOp(left=left, op=ast.Add() | ast.Sub(), right=right):
                waiting += [left, right]
            case ast.BinOp(left=left, op=ast.Div(), right=ast.Constant()):
                waiting.append(left)
