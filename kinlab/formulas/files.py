r"""Files of formulas: entries, symbols, and what both stand on.


A file looks like this (see :func:`formula_file`)::

    robot = "planar2r"

    [symbols]                 # only what the robot's own names (kinlab derive) do not cover
    th1 = "q1"
    L = 0.5

    [formulas]
    tau1 = "(m1 + m2)*l1**2*qdd1 + ..."
    "mass_matrix[0,0]" = "..."

    [latex]
    tau2 = '(m_2 l_2^2 + m_2 l_1 l_2 c_2) \ddot{q}_1 + ...'
"""

from __future__ import annotations

import math
import re
from collections.abc import Callable, Iterable, Iterator, Mapping
from contextlib import suppress
from dataclasses import dataclass, field, replace
from fractions import Fraction
from functools import partial
from typing import Any

from kinlab.errors import ExpressionError, FileError
from kinlab.formulas import grids, tree, typed
from kinlab.formulas.handed.columns import with_matrices
from kinlab.formulas.handed.displays import in_lines
from kinlab.formulas.handed.equations import solved
from kinlab.formulas.handed.rates import MOVING
from kinlab.formulas.handed.reading import as_formula
from kinlab.formulas.language.cases import without_special_cases, without_words_of_parts
from kinlab.formulas.language.clauses import Claim, Holds
from kinlab.formulas.language.derivations import conclusion, steps_beside, values_beside
from kinlab.formulas.language.prose import (
    Doubt,
    behind_the_first,
    doubtful,
    left_over,
    say_of_what,
)
from kinlab.formulas.language.words import refuse_meanings_of_steps
from kinlab.formulas.signs.latex import LAMBDA
from kinlab.formulas.signs.letters import WIDE
from kinlab.formulas.signs.named import (
    LastJoint,
    is_another,
    is_another_slope,
    is_craigs_last,
    without_its_axes,
)
from kinlab.formulas.signs.refusals import refused
from kinlab.formulas.text import LENGTH, parse, square_of, tidied
from kinlab.formulas.tree import Node
from kinlab.host.language import N_, _

_FORMULAS = 200
_SHOWN = 60
"""Signs of a formula in a remark."""
_EMPTY = re.compile(r"=\s{0,9}\{\s?\}(?=\s*[&\\\w+({-])")
"""What LaTeX has for the space behind a sign of equality: ``c = {} & a + b``."""
_EQUATION_BEHIND = re.compile(r"; (?=[^;=\]]{1,40} = )")
PartsOf = Callable[[str], grids.Grid | None]
"""The entries of a name that is of several, row by row; None of a name that is of one or of all."""


@dataclass(frozen=True)
class FormulaFile:
    """What a formula file holds.

    Attributes:
        path: where it was read.
        robot: a name or path for ``kl.load``.
        symbols: the user's own names: a number, or text over other names.
        formulas: entry name to expression, in the order of the file.
        texts: the formulas as they are written, for plain evaluation.
        as_typed: the same as they were typed: LaTeX, MATLAB, ...
        writing: what all of them say about the writing.
        numbers: names in the texts that stand for a number that was written.
        symbol_texts: the same for symbols; a number as its digits.
        symbols_typed: symbols as they were typed, where that is a text.
        others: the file with another part of a chain of equalities for an entry's formula.
        broken: what a part of a chain of equalities could not be read for; empty where all were.
        line: of one of the others, an earlier equation of which words may say that it is of a part.
        apart: whether words behind it may say that the last one is.
        remarks: what is to be said of how an entry was read.
        unread: words beside an entry's formula that may change what it claims.
        parts: rows, columns and blocks of a quantity that were given, with their entries.
        matrices: entries that were given in a matrix, with what that one is called.
        whole: the quantity that its only entry was taken out of; empty where it was given alone.
    """

    path: str
    robot: str
    symbols: dict[str, Node]
    formulas: dict[str, Node]
    texts: dict[str, str]
    symbol_texts: dict[str, str]
    as_typed: dict[str, str]
    writing: typed.Hand
    numbers: Mapping[str, str] = field(default_factory=dict)
    others: tuple[FormulaFile, ...] = ()
    broken: str = ""
    line: str = ""
    apart: bool = False
    remarks: Mapping[str, str] = field(default_factory=dict)
    unread: Mapping[str, Doubt] = field(default_factory=dict)
    symbols_typed: Mapping[str, str] = field(default_factory=dict)
    parts: Mapping[str, list[str]] = field(default_factory=dict)
    matrices: Mapping[str, str] = field(default_factory=dict)
    whole: str = ""


def formula_file(
    document: Mapping[str, Any],
    place: str,
    writing: typed.Hand | None = None,
    holds: Holds | None = None,
    parts_of: PartsOf | None = None,
    last: LastJoint | None = None,
) -> FormulaFile:
    """Reads the formulas of a TOML document.

    Args:
        document: as it was read. ``robot`` is required; ``[symbols]`` gives numbers or other
            names to the user's symbols; every entry of ``[formulas]`` (or of the top level) is a
            formula: its name says what it claims to be (``tau1``, ``g2``, ``M12``, ``C11``,
            ``J11``, ``x``, or a quantity such as ``"fk[0,3]"``). A formula may be typed as
            text, MATLAB, Python or LaTeX, with its left side, or be a matrix
            (:mod:`kinlab.formulas.typed`). Entries of ``[latex]`` are LaTeX.
        place: the file, for messages.
        writing: what more of the same writer's formulas say; None looks at these.
        holds: what is known of the robot, of clauses beside a formula that say something of it.
        parts_of: the entries of a name that is of several: of rows, columns and blocks.
        last: the robot's last joint, whose frame a pose may be of.

    Raises:
        FileError: the document holds no formulas, or what is none.
        ExpressionError: an expression that is no arithmetic, with the entry's name.
    """
    read = partial(_formula_file, document, place, writing, holds, parts_of, last)
    try:
        return read({})
    except ExpressionError:
        for alone in (False, True):
            found = {key: _conclusion(key, text, alone) for key, text in _every_text(document)}
            ends = {key: end for key, end in found.items() if end}
            with suppress(ExpressionError):
                if ends:
                    return read(ends)
        raise


def _every_text(document: Mapping[str, Any]) -> Iterator[tuple[str, str]]:
    """Each entry's text."""
    for name in entries_of(document):
        for table in (document, *(document.get(key, {}) for key in _TABLES)):
            if isinstance(table, dict) and isinstance(value := table.get(name), str):
                yield name, _EMPTY.sub("=", value[:LENGTH])


def _conclusion(entry: str, text: str, alone: bool) -> str:
    """What a derivation comes to; empty where it is none, or words in it mean something else."""
    with suppress(ExpressionError):
        text, _cases = without_special_cases(text, entry)
        found = conclusion(text, entry, alone)
        if found:
            refuse_meanings_of_steps(text, entry, "")
        return found
    return ""


def _formula_file(
    document: Mapping[str, Any],
    place: str,
    writing: typed.Hand | None,
    holds: Holds | None,
    parts_of: PartsOf | None,
    last: LastJoint | None,
    ends: Mapping[str, str],
) -> FormulaFile:
    """As :func:`formula_file`; of some derivations only what they come to."""
    document = dict(document)
    robot = document.pop("robot", None)
    if not isinstance(robot, str) or not robot:
        raise FileError(f"{place}: " + _('robot is missing; write robot = "planar2r" or a path'))
    symbols = _table(document.pop("symbols", {}), f"{place}: [symbols]")
    if "lambda" in symbols:
        symbols.setdefault(LAMBDA, symbols.pop("lambda"))
    entries = _table(document.pop("formulas", {}), f"{place}: [formulas]")
    typeset = _table(document.pop("latex", {}), f"{place}: [latex]")
    for key, value in document.items():
        if key in _ABOUT:
            continue
        if not isinstance(value, str):
            raise FileError(
                f"{place}: "
                + _("{key!r} is no formula; write it as text in [formulas]").format(key=key)
            )
        entries[key] = value
    for key in typeset.keys() & entries.keys():
        raise FileError(
            f"{place}: "
            + _("{key!r} is given twice, as text and as LaTeX; keep one").format(key=key)
        )
    entries |= {key: f"${_text(value, f'{place}: {key}')}$" for key, value in typeset.items()}
    if not entries:
        raise FileError(
            f"{place}: " + _('no formulas; write [formulas] and lines such as tau1 = "..."')
        )
    for found, what in ((entries, "formulas"), (symbols, "symbols")):
        if len(found) > _FORMULAS:
            raise FileError(f"{place}: {len(found)} {what}; at most {_FORMULAS}")
    whole = {key: grid for key in entries if parts_of and (grid := parts_of(key))}
    remarks: dict[str, str] = {}
    doubts: dict[str, tuple[str, list[tuple[str, str]]]] = {}
    for key, value in list(entries.items()):
        at = f"{place}: {key}"
        text, cases = without_special_cases(_text(value, at), key)
        plain = ends.get(key, text)
        plain = plain if last is None else without_its_axes(plain, key, last)
        entries[key], remarks[key], told = as_formula(plain, key, at, holds, key in whole)
        bare = without_words_of_parts(text, key)
        if key in ends or bare != text:
            told = doubtful(bare, key)
        if key in ends:
            said = _("of the derivation {formula!r} is judged, and no other step")
            end = plain.strip("$")
            end = _EQUATION_BEHIND.split(end)[-1] if say_of_what(text) else end
            remarks[key] = said.format(formula=end[:_SHOWN])
        if cases:
            said = _("not judged: the special case {case!r}").format(case=cases[0][:_SHOWN])
            remarks[key] = "; ".join(filter(None, (remarks[key], said)))
        doubts[key] = text, told
        entries[key] = typed.as_column(entries[key], key)
        ways = dict.fromkeys((in_lines(entries[key]), entries[key]))  # one where none is displayed
        every = (typed.several(one, key) for one in ways if key not in whole)
        parts = next(filter(None, every), dict[str, str]())
        if parts and not parts.keys() & entries.keys():
            del entries[key]
            entries |= parts
            whole |= {one: grid for one in parts if parts_of and (grid := parts_of(one))}
            doubts |= dict.fromkeys(parts, doubts[key])
    explained, opened = set[str](), set[str]()
    before: dict[str, list[str]] = {}
    for key, value in entries.items():
        at = f"{place}: {key}"
        own, entries[key] = typed.explained(_text(value, at), key, at)
        explained |= own.keys()
        earlier = typed.lines_before(value, key, own) if entries[key] != value else []
        if steps := typed.unjudged_steps(value, own):
            said = _("of what is given for {name} the last step is taken; another was not judged")
            taken = said.format(name=", ".join(steps))
            remarks[key] = "; ".join(filter(None, (remarks.get(key), taken)))
        put_in = dict(own)
        texts = {**own, "": entries[key]}
        before[key] = [with_matrices(own, one, f"{place}: {key}")[1] for one in earlier]
        own, entries[key] = with_matrices(own, entries[key], f"{place}: {key}")
        for name in put_in.keys() - own.keys():
            beside = (text for other, text in texts.items() if other != name)
            opened |= {name} if any(map(partial(typed.stands_in, name), beside)) else set()
        alone = last is not None and last.number == 1
        before[key] = [_by_its_entry(one, key, alone) for one in before[key]]
        entries[key] = _by_its_entry(entries[key], key, alone)
        left = entries[key].partition("=")[0]
        other = [side for side in entries[key].split("=")[:-1] if is_another_slope(side, key)]
        of_angle = key.startswith("planar_pose[") and typed.is_angle(left)  # it has its cosine
        if other or of_angle or (last is not None and is_another(left, key, last)):
            said = N_("the formula begins with {text} =, which is another")
            shown = [*other, left][0].strip("$& ")[:40]
            raise refused(f"{place}: {key}", said, text=shown)
        if last is not None and is_craigs_last(left, key, last):
            said = _(
                "it is the tool's pose; frame {number} of the table lies in its joint, and the "
                "tool beyond it"
            ).format(number=last.number)
            remarks[key] = "; ".join(filter(None, (remarks.get(key), said)))
        used = typed.joined_up(" ".join([*own.values(), *before[key], entries[key]]))
        for name, formula in own.items():
            unused = name not in used or name[0] == "L"
            if unused and not _readable(formula):
                continue  # beside the formula, and not used in it
            if unused and holds is not None:
                _refuse_untrue(name, formula, holds, f"{place}: {key}")
            if symbols.setdefault(name, formula) != formula:
                raise refused(f"{place}: {key}", typed.EXPLAINED_TWICE, name=name)
    entries = {key: solved(value, key, f"{place}: {key}") for key, value in entries.items()}
    chains = {key: typed.readings(value, key, explained) for key, value in entries.items()}
    sides = [(key, part, "", False) for key, parts in chains.items() for part in parts[1:]]
    for key, lines in ((key, lines) for key, lines in before.items() if lines):
        lines = [solved(line, key, f"{place}: {key}") for line in lines]
        sides += _sides_before(lines, key, doubts[key][0], explained)
    entries = {key: parts[0] for key, parts in chains.items()}
    read = partial(_read, place, robot, symbols, writing, whole)
    file, others, broken = read(entries), list[FormulaFile](), ""
    for key, part, shown, behind in sides:
        try:
            others.append(replace(read({**entries, key: part}), line=shown, apart=behind))
        except ExpressionError as problem:  # Im(l1*e^(i*q1) + ...) = ...
            broken = broken or str(problem)
    remarks = {key: remark for key, remark in remarks.items() if remark}
    names = {*file.symbols, *explained}.union(
        *map(tree.names, [*file.formulas.values(), *file.symbols.values()])
    )
    matrices: dict[str, str] = {}
    laid_out: set[str] = set()
    for key, doubt in list(doubts.items()):  # what is said of a matrix is said of its entries
        if key not in file.formulas and key in chains:
            apart, _writing = _opened({key: chains[key][0]}, symbols, place, writing, whole)
            doubts |= dict.fromkeys(apart, doubt)
            laid_out |= apart.keys()
            matrices |= dict.fromkeys(apart, key) if key not in whole and len(apart) > 1 else {}
            remarks |= dict.fromkeys(apart, remarks[key]) if key in remarks else {}
    left = {key: left_over(*doubts[key], names) for key in doubts.keys() & file.formulas.keys()}
    unread = {key: words for key, words in left.items() if words}
    given = {_bare_name(x) for x in opened.union(*map(_used, (file, *others)))}
    used_up = {*map(_bare_name, file.symbols)}
    for key in left:
        for name, value in values_beside(doubts[key][0]):
            if holds and _bare_name(name) not in used_up:  # no formula has it
                _refuse_untrue(name, value, holds, f"{place}: {key}")
    for key in left.keys() - ends.keys():
        steps = [*dict.fromkeys(steps_beside(doubts[key][0], key))]
        steps = [one for one in steps if _bare_name(one) not in given]
        judged = file.formulas.keys()
        steps = [x for x in steps if not any(typed.is_name_of(x, other) for other in judged)]
        mine = re.sub(r"[\d\[].*", "", key) if key in laid_out else ""  # M of M11
        steps = [x for x in steps if not (mine and typed.is_name_of(x, mine))]
        if last is not None and last.number == 1:
            steps = [x for x in steps if not _is_its_only_entry(x, key)]
        if steps:
            said = _("not judged: what is given for {names}").format(names=", ".join(steps))
            remarks[key] = "; ".join(filter(None, (remarks.get(key), said)))
    file = replace(file, others=tuple(others), broken=broken)
    return replace(file, remarks=remarks, unread=unread, matrices=matrices)


def _by_its_entry(text: str, key: str, alone: bool) -> str:
    """A formula by its entry's name, where it has another: as gravity's torque, of one joint."""
    text = _of_gravity(text, key)
    return _of_one_joint(text, key) if alone else text


def _sides_before(
    lines: list[str], key: str, text: str, explained: set[str]
) -> Iterator[tuple[str, str, str, bool]]:
    """The entry and a side of each of its earlier lines, the last one first; that line where words
    may say of what it is; and whether words behind it may say of what the last line is.
    """
    of_a_part, behind = say_of_what(text), say_of_what(behind_the_first(text, key))
    for line in reversed(lines):
        for part in typed.readings(line, key, explained):
            yield key, part, _beginning(line.strip("$")) if of_a_part else "", behind


def _beginning(text: str) -> str:
    return text if len(text) <= _SHOWN else f"{text[:_SHOWN]}..."


_STATIC = re.compile(r"(?:tau|u|Q)g?(\d?)")


def _of_gravity(text: str, key: str) -> str:
    """``tau_2 = ...`` without its left side, where gravity's torque is asked for."""
    left, sign, right = text.partition("=")
    place = re.fullmatch(r"gravity_torques\[(\d)\]", key)
    if not sign or not place or "=" in right or MOVING.search(right):
        return text
    try:
        found = _STATIC.fullmatch(typed.entry_name(left.strip("$& ")).replace("_", ""))
    except ExpressionError:
        return text
    same = found and found[1] in ("", str(int(place[1]) + 1))
    dollars = "$" if typed.is_latex(text) else ""
    return f"{dollars}{right.strip(' $&')}{dollars}" if same else text


_MASS_MATRIX = re.compile(r"\s*\$?\s*[MDHB](?:\([^()=]{1,9}\))?\s*")


def _is_its_only_entry(left: str, key: str) -> bool:
    """Whether a left side is the mass matrix of an arm with one joint, where its entry is asked."""
    entry = key in ("M11", "mass_matrix[0][0]", "mass_matrix[0]")
    return entry and bool(_MASS_MATRIX.fullmatch(left))


def _of_one_joint(text: str, key: str) -> str:
    """``M11 = ...`` for ``M = ...``, where an arm has one joint; ``M = 2.5`` is a mass."""
    left, sign, right = text.partition("=")
    if not re.search("[A-Za-z]", right.partition("=")[0]) or not _is_its_only_entry(left, key):
        return text
    return f"{'$' if '$' in left else ''}M11 {sign}{right}"


def _bare_name(name: str) -> str:
    with suppress(ExpressionError):
        name = typed.own_name(name)
    return typed.joined_up(square_of(name))


def _used(file: FormulaFile) -> set[str]:
    """The names that stand in formulas, and in what explains them."""
    waiting, used = [*file.formulas.values()], set[str]()
    while waiting:
        more = {*tree.names(waiting.pop())} - used
        used |= more
        waiting += [file.symbols[name] for name in more if name in file.symbols]
    return used


def _refuse_untrue(name: str, formula: str, holds: Holds, place: str) -> None:
    """Refuses a number, or a name, that is said to be one of the arm's and is another.

    Raises:
        ExpressionError: with both.
    """
    claim = Claim("value", (name,), words=frozenset((formula.strip(" $"),)))
    if holds(claim) is False:
        said = N_("{words!r} beside the formula is not so of this robot; leave it out")
        raise refused(place, said, words=f"{name} = {formula.strip(' $')}"[:80])


def _readable(text: str) -> bool:
    try:
        parse(typed.plain_formula(text))
    except ExpressionError:
        return False
    return True


def _read(
    place: str,
    robot: str,
    symbols: dict[str, Any],
    writing: typed.Hand | None,
    parts: Mapping[str, grids.Grid],
    entries: dict[str, str],
) -> FormulaFile:
    as_typed, writing = _opened(entries, symbols, place, writing, parts)
    typed_ = {square_of(k): value for k, value in symbols.items() if isinstance(value, str)}
    entries, symbols = _plain(as_typed, symbols, place, writing)
    return FormulaFile(
        place,
        robot,
        {name: _symbol(value, f"{place}: symbol {name!r}") for name, value in symbols.items()},
        {name: parse(value, f"{place}: {name}") for name, value in entries.items()},
        {name: tidied(value) for name, value in entries.items()},
        {
            name: tidied(value if isinstance(value, str) else repr(float(value)))
            for name, value in symbols.items()
        },
        as_typed,
        writing,
        symbols_typed=typed_,
        parts={key: [one for row in grid for one in row] for key, grid in parts.items()},
    )


_ABOUT = ("title", "source", "name")
"""Keys of a formula file that tell about it."""

_TABLES = ("formulas", "latex")
_WORD = re.compile(r"[A-Za-z]\w*")


def entries_of(document: Mapping[str, Any]) -> list[str]:
    """The names of the entries of a formula file's document, readable or not."""
    tables = [table for key in _TABLES if isinstance(table := document.get(key), dict)]
    plain = (key for key in document if key not in (*_ABOUT, *_TABLES, "robot", "symbols"))
    return list(dict.fromkeys([*(name for table in tables for name in table), *plain]))


def with_entries(document: Mapping[str, Any], kept: set[str]) -> dict[str, Any]:
    """The document of a formula file with those entries alone, and what they stand on."""
    left = {
        key: value
        for key, value in document.items()
        if key in (*_ABOUT, *_TABLES, "robot", "symbols") or key in kept
    }
    for key in _TABLES:
        if isinstance(table := left.get(key), dict):
            left[key] = {name: value for name, value in table.items() if name in kept}
    return left


def alone(document: Mapping[str, Any], entry: str) -> dict[str, Any]:
    """The document of a formula file with one entry, and those that its text names."""
    kept, waiting = {entry}, [entry]
    while waiting:
        one = with_entries(document, {waiting.pop()})
        texts = [one, *(one.get(key, {}) for key in _TABLES)]
        words = {w for text in texts for value in text.values() for w in _WORD.findall(str(value))}
        more = (words & {*entries_of(document)}) - kept
        waiting += sorted(more)
        kept |= more
    return with_entries(document, kept)


def _table(value: Any, place: str) -> dict[str, Any]:
    if not isinstance(value, dict):
        raise FileError(f"{place} is {type(value).__name__}; it must be a table of names")
    return dict(value)


def _symbol(value: Any, place: str) -> Node:
    if isinstance(value, bool) or not isinstance(value, (int, float, str)):
        raise refused(place, N_("{kind}; give a number, or other names"), kind=type(value).__name__)
    if isinstance(value, str):
        return parse(value, place)
    if not math.isfinite(value) or abs(value) > 1e30:
        raise refused(place, N_("{value} is not a usable number"), value=value)
    return tree.num(Fraction(repr(float(value))))


def _opened(
    entries: dict[str, Any],
    symbols: dict[str, Any],
    place: str,
    writing: typed.Hand | None,
    parts: Mapping[str, grids.Grid],
) -> tuple[dict[str, str], typed.Hand]:
    """Formulas as typed, a matrix as its entries; and what they say about the writing."""
    meant = [value for value in symbols.values() if isinstance(value, str)]
    if writing is None:
        writing = typed.hand([*entries.values(), *meant], symbols)
    writing = replace(writing, known=writing.known | {*symbols})
    return grids.opened(entries, place, writing, parts), writing


def _plain(
    entries: dict[str, str], symbols: dict[str, Any], place: str, writing: typed.Hand
) -> tuple[dict[str, str], dict[str, Any]]:
    """Formulas and symbols as typed, made plain."""
    formulas, rates = {}, dict[str, str]()
    for name, value in entries.items():
        formulas[name] = typed.plain_formula(value, f"{place}: {name}", writing)
        rates |= typed.rates_of_joints(formulas[name], f"{place}: {name}", symbols)
    explained = rates | {
        name: typed.plain_formula(value, f"{place}: symbol {name!r}", writing)
        for name, value in symbols.items()
        if isinstance(value, str)
    }
    named = {square_of(name): value for name, value in (symbols | explained).items()}
    return formulas, _as_read(named, formulas.values(), explained.values())


def _as_read(
    symbols: dict[str, Any], formulas: Iterable[str], explained: Iterable[str]
) -> dict[str, Any]:
    """The symbols by the names that LaTeX's are read as: L_1 is L1 where no text has it as L_1."""
    met, meant = ({w for text in x for w in _WORD.findall(text)} for x in (formulas, explained))
    joined = {name: name.replace("_", "") for name in symbols.keys() - met - meant if "_" in name}
    return {
        joined[name] if joined.get(name) in met - meant - symbols.keys() else name: value
        for name, value in symbols.items()
    }


def _text(value: Any, place: str) -> str:
    if isinstance(value, list):  # a matrix as TOML has it
        value = "[" + ", ".join(_text(one, place) for one in value) + "]"
    if not isinstance(value, str):
        raise refused(place, N_("{kind}; write the formula as text"), kind=type(value).__name__)
    if len(value) > LENGTH:
        raise refused(
            place, N_("{count} characters; at most {length}"), count=len(value), length=LENGTH
        )
    return _EMPTY.sub("=", value.translate(WIDE))
