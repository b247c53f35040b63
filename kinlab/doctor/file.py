"""A file of formulas as text: what its names claim to be, each examined entry by entry."""

from __future__ import annotations

import re
from collections.abc import Iterable
from dataclasses import replace
from pathlib import Path

import numpy as np

from kinlab.arrays import Array
from kinlab.check.diagnosis import Diagnosis
from kinlab.check.quantities.registry import quantities
from kinlab.doctor.changes import Case
from kinlab.doctor.derived import LETTERS
from kinlab.doctor.examine import examine, prepare
from kinlab.doctor.terms import split_name
from kinlab.doctor.written import Written, literal
from kinlab.errors import ExpressionError, FileError, KinlabError, NameUnknownError, near
from kinlab.formulas import tree, typed
from kinlab.formulas.lines import Lines, read_lines
from kinlab.formulas.retyped import Typing
from kinlab.formulas.text import MOST_NODES, FormulaFile, canonical, formula_file, parse, tidied
from kinlab.formulas.tree import Node
from kinlab.host.files import read_text
from kinlab.host.language import _
from kinlab.model.dh import DHTable
from kinlab.model.library import load
from kinlab.model.robot import Robot
from kinlab.symbolic.vocabulary import is_planar, vocabulary
from kinlab.tolerances import TOLERANCES

_DECIMAL = re.compile(r"(?<![\w.])\d+\.\d+(?![\w.])")

# -------- What the names in a formula file claim to be: tau1, g2, M12, C11, J11, x, T, V

_VECTORS = {
    "inverse_dynamics": "tau Q torque",
    "gravity_torques": "g G D",
    "coriolis_torques": "c h V b",
}
_MATRICES = {
    "mass_matrix": "M D H B",
    "coriolis_matrix": "C",
    "jacobian": "J",
    "fk": "T R r",
}
_NUMBERS = {
    "fk[0,3]": "x px",
    "fk[1,3]": "y py",
    "fk[2,3]": "z pz",
    "kinetic_energy": "T K kinetic",
    "potential_energy": "V U P potential",
}
"""Each quantity with the letters that its vectors, matrices and numbers go by."""


def _by_letter(table: dict[str, str]) -> dict[str, str]:
    return {letter: name for name, letters in table.items() for letter in letters.split()}


_VECTOR_OF, _MATRIX_OF, _NUMBER_OF = map(_by_letter, (_VECTORS, _MATRICES, _NUMBERS))
_VECTOR = re.compile(r"([A-Za-z]+)_?(\d)")
_MATRIX = re.compile(r"([A-Za-z]+)_?(\d)_?(\d)")


def quantity_of(entry: str, table: DHTable | None) -> str:
    """The quantity that an entry's name stands for, such as ``"inverse_dynamics[0]"``.

    Args:
        entry: ``tau1``, ``M12``, ... (rows and columns from 1), or the quantity itself.
        table: the robot's table; of a planar arm ``J11`` ... are the rows vx, vy, wz.

    Raises:
        ExpressionError: a name that says nothing.
    """
    plain = entry.split("[")[0].strip()
    if plain in quantities():
        return entry.strip()
    if entry in _NUMBER_OF:
        return _NUMBER_OF[entry]
    matrix = _MATRIX.fullmatch(entry)
    if matrix and matrix.group(1) in _MATRIX_OF:
        name = _MATRIX_OF[matrix.group(1)]
        if name == "jacobian" and table is not None and is_planar(table):
            name = "planar_jacobian"
        return f"{name}[{int(matrix.group(2)) - 1},{int(matrix.group(3)) - 1}]"
    vector = _VECTOR.fullmatch(entry)
    if vector and vector.group(1) in _VECTOR_OF:
        return f"{_VECTOR_OF[vector.group(1)]}[{int(vector.group(2)) - 1}]"
    choices = near(entry, ["tau1", "g1", "M11", "C11", "J11", "x", "y", *quantities()])
    raise ExpressionError(f"{entry!r} names no quantity; {choices}")


# -------- A file of formulas as text, examined entry by entry

_FEWEST = 10
"""States that :func:`prepare` asks for at least."""

_FILE_LIMIT = 1 << 20
_MIRRORED = ("mass_matrix",)
"""Quantities whose missing lower half is the upper one."""


Answers = tuple[Case, Array, list[str], dict[str, Written], dict[str, Array]]
"""A case, the engine's answers, every place there is, and the formulas with their values."""


def formula_document(path: str | Path) -> Lines | None:
    """What a file of formulas holds (it names a robot); None of any other file.

    Raises:
        FileError: the file cannot be read.
    """
    if Path(path).suffix.lower() != ".toml":
        return None
    lines = read_lines(read_text(path, limit=_FILE_LIMIT), str(path))
    known = {*lines.document, *(key for key, _problem in lines.problems)}
    return lines if "links" not in known and known & {"robot", "formulas", "latex"} else None


def examine_file(path: str | Path, samples: int = 200, seed: int = 0) -> list[Diagnosis]:
    """Judges every formula of a file; :func:`kinlab.formulas.text.formula_file` has the format.

    Args:
        path: the TOML file.
        samples, seed: the states, as in :func:`kinlab.diagnose`.

    Raises:
        FileError, ExpressionError: the file, an expression or a name cannot be read.
        NameUnknownError: no such robot.
    """
    lines = read_lines(read_text(path, limit=_FILE_LIMIT), str(path))
    for _key, problem in lines.problems:
        raise problem
    file = formula_file(lines.document, str(path))
    return examine_formulas(file, robot_of(file), samples, seed)


def examine_formulas(
    file: FormulaFile, robot: Robot, samples: int = 200, seed: int = 0
) -> list[Diagnosis]:
    """Judges formulas that are read already, of a robot that is loaded.

    Entries that make up a whole quantity are judged together, so that a confusion of the whole
    (a frame, gravity's sign) is seen; others each for itself.

    Args:
        file: the formulas.
        robot: from :func:`robot_of`.
        samples, seed: the states, as in :func:`kinlab.diagnose`.

    Raises:
        ExpressionError: a name that means nothing.
    """
    file = _with_slides(file, robot)
    done = _by_quantity(file, robot, samples, seed)
    if all(one.agrees for found in done.values() for one in found):
        return [one for found in done.values() for one in found]
    named, said = _gravity_named(file, robot)
    if not said:
        return [one for found in done.values() for one in found]
    again = _by_quantity(named, robot, samples, seed)
    return [
        _read_better(first, second, file, said)
        for plain, found in done.items()
        for first, second in zip(found, again[plain], strict=True)
    ]


def _with_slides(file: FormulaFile, robot: Robot) -> FormulaFile:
    """The file with d3 for q3 where joint 3 slides, and nothing else is called so."""
    words = vocabulary(robot.table) if robot.table is not None else None
    if words is None or robot.table is None:
        return file
    slides = [k for k, link in enumerate(robot.table.links, 1) if link.joint == "prismatic"]
    spelled = (("d{k}",), ("dd{k}", "d{k}dot", "ddot{k}"), ("ddd{k}", "d{k}ddot", "dddot{k}"))
    meant = {
        way.format(k=k): f"q{'d' * n}{k}" for k in slides for n in range(3) for way in spelled[n]
    }
    used = {
        n for node in (*file.formulas.values(), *file.symbols.values()) for n in tree.names(node)
    }
    new = {}
    for name in sorted(used - {*words.values, *file.symbols}):
        plain = name.replace("_", "")
        if plain in meant and plain not in words.values:
            new[name] = meant[plain]
    symbols = file.symbols | {name: tree.sym(value) for name, value in new.items()}
    return replace(file, symbols=symbols, symbol_texts=file.symbol_texts | new)


def _by_quantity(
    file: FormulaFile, robot: Robot, samples: int, seed: int
) -> dict[str, list[Diagnosis]]:
    wanted, titles = _claims(file, robot)
    done: dict[str, list[Diagnosis]] = {}
    for plain, formulas in wanted.items():
        answers = _answers(plain, formulas, titles, robot, file, samples, seed)
        done[plain] = list(_of_quantity(plain, answers, titles))
    return done


def _gravity_named(file: FormulaFile, robot: Robot) -> tuple[FormulaFile, dict[str, str]]:
    """The file with a name for g for each decimal that is g rounded, and what is to be said of it.

    A slip is told beside a rounded number only where the number is read as what it stands for.
    """
    words = vocabulary(robot.table).values if robot.table is not None else {}
    size = words.get("g", 0.0)
    said: dict[str, str] = {}
    numbers: dict[str, str] = {}

    def named(found: re.Match[str]) -> str:
        if not size or not _stands_for(found[0], size):
            return found[0]
        if abs(float(found[0]) - size) > TOLERANCES.same_number * abs(size):
            told = _("{written} stands for {meant}")
            said[found[0]] = told.format(written=found[0], meant=f"g = {size:.10g}")
        name = f"g_{found[0].replace('.', '_')}"
        numbers[name] = found[0]
        return name

    texts = {entry: _DECIMAL.sub(named, text) for entry, text in file.texts.items()}
    if not said:
        return file, said
    formulas = {
        entry: formula if texts[entry] == file.texts[entry] else parse(texts[entry], entry)
        for entry, formula in file.formulas.items()
    }
    return (
        replace(
            file,
            texts=texts,
            formulas=formulas,
            numbers=numbers,
            symbols=file.symbols | dict.fromkeys(numbers, tree.sym("g")),
            symbol_texts=file.symbol_texts | dict.fromkeys(numbers, "g"),
        ),
        said,
    )


def _read_better(
    first: Diagnosis, second: Diagnosis, file: FormulaFile, said: dict[str, str]
) -> Diagnosis:
    """The second reading, in which rounded numbers are what they stand for, where it says more."""
    if first.agrees or not (second.agrees or second.causes):
        return first
    here = " ".join(file.texts.get(entry, "") for entry in first.function.split(", "))
    notes = tuple(told for digits, told in said.items() if digits in here)
    second = replace(second, error_before=first.error_before)
    if second.agrees:
        form = second.form or "rounded"
        return replace(second, form=form, remarks=(*notes, *second.remarks))
    first_cause, *rest = second.causes
    told = _("; ").join((first_cause.sentence, *notes))
    causes = (replace(first_cause, sentence=told), *rest)
    return replace(second, causes=causes)


def require_sound(file: FormulaFile, robot: Robot) -> None:
    """Refuses what :func:`examine_formulas` would refuse, without judging anything.

    Raises:
        ExpressionError: a name that means nothing, an entry that does not exist.
    """
    file = _with_slides(file, robot)
    wanted, titles = _claims(file, robot)
    for plain, formulas in wanted.items():
        _answers(plain, formulas, titles, robot, file, _FEWEST, 0)


def _claims(
    file: FormulaFile, robot: Robot
) -> tuple[dict[str, dict[str, Written]], dict[str, str]]:
    """The formulas by quantity and by the place they claim, and the entries' names by place."""
    wanted: dict[str, dict[str, Written]] = {}
    titles: dict[str, str] = {}
    for entry, text in file.formulas.items():
        try:
            name = quantity_of(entry, robot.table)
            plain, index = split_name(name)
        except KinlabError as problem:
            raise ExpressionError(f"{file.path}: {entry}: {problem}") from None
        if any(isinstance(k, slice) for k in index):
            raise ExpressionError(f"{file.path}: {entry}: name one entry, not a range")
        label = f"{plain}[{','.join(map(str, index))}]" if index else plain
        node = in_robot_names(text, file, robot, entry)
        wanted.setdefault(plain, {})[label] = _written(entry, node, file, robot)
        titles[label] = entry
    return wanted, titles


def _answers(
    plain: str,
    formulas: dict[str, Written],
    titles: dict[str, str],
    robot: Robot,
    file: FormulaFile,
    samples: int,
    seed: int,
) -> Answers:
    """The case, the engine's answers, every place there is, and the formulas with their values."""
    case, engine = prepare(robot, plain, (), samples, seed)
    shape = engine.shape[1:]
    labels = [f"{plain}[{','.join(map(str, k))}]" for k in np.ndindex(shape)] if shape else [plain]
    for label in formulas:
        if label not in labels:
            raise ExpressionError(
                f"{file.path}: {titles[label]}: {label} does not exist; {plain} has shape {shape}"
            )
    if plain in _MIRRORED:
        mirrored = {
            f"{plain}[{j},{i}]": formulas[f"{plain}[{i},{j}]"]
            for i, j in np.ndindex(shape)
            if f"{plain}[{i},{j}]" in formulas
        }
        if len({**mirrored, **formulas}) == len(labels):
            formulas = {**mirrored, **formulas}
    values = {
        label: _values(text, case, file, _entry_of(label, titles))
        for label, text in formulas.items()
    }
    return case, engine, labels, formulas, values


def _of_quantity(plain: str, answers: Answers, titles: dict[str, str]) -> Iterable[Diagnosis]:
    case, engine, labels, formulas, values = answers
    if len(formulas) == len(labels):
        hand = np.stack([values[label] for label in labels], axis=-1).reshape(engine.shape)
        shown = ", ".join(titles[label] for label in labels if label in titles)
        yield examine(case, hand, engine, plain, shown, formulas)
        return
    if plain == "coriolis_matrix":
        yield from _complete_rows(case, engine, formulas, values, titles)
    for label, answer in values.items():
        _plain, index = split_name(label)
        part = replace(case, index=index)
        one = {label: formulas[label]}
        found = examine(part, answer, engine[(slice(None), *index)], label, titles[label], one)
        yield _of_one_split(found) if plain == "coriolis_matrix" else found


def _of_one_split(found: Diagnosis) -> Diagnosis:
    """An entry of C without the rest of its row: it may belong to another valid C."""
    if found.agrees or not found.causes:
        return found
    told = _("Christoffel's C is meant; with the whole row given, another valid C would be told")
    first, *rest = found.causes
    sentence = _("; ").join((first.sentence, told))
    return replace(found, causes=(replace(first, sentence=sentence), *rest))


def _complete_rows(
    case: Case,
    engine: Array,
    formulas: dict[str, Written],
    values: dict[str, Array],
    titles: dict[str, str],
) -> Iterable[Diagnosis]:
    """Rows of C that are whole, taken out of the entries: one row has many valid splits."""
    for i in range(case.robot.n):
        labels = [f"coriolis_matrix[{i},{j}]" for j in range(case.robot.n)]
        if not all(label in values for label in labels):
            continue
        row = replace(case, index=(i,))
        hand = np.stack([values.pop(label) for label in labels], axis=-1)
        texts = {label: formulas[label] for label in labels}
        shown = ", ".join(titles[label] for label in labels)
        yield examine(row, hand, engine[:, i], f"coriolis_matrix[{i}]", shown, texts)


def robot_of(file: FormulaFile) -> Robot:
    """The robot of a file, by name, or by a path that may be relative to the file.

    Raises:
        NameUnknownError, FileError: no such robot; the message names the file.
    """
    beside = Path(file.path).parent / file.robot
    try:
        return load(beside if beside.suffix and beside.is_file() else file.robot)
    except NameUnknownError as problem:
        raise NameUnknownError(f"{file.path}: {problem}") from None
    except FileError as problem:
        raise FileError(f"{file.path}: robot: {problem}") from None


def in_robot_names(text: Node, file: FormulaFile, robot: Robot, entry: str) -> Node:
    """A formula with the robot's own names in place of the user's.

    Raises:
        ExpressionError: a name without a meaning; the message names the entry.
    """
    words = vocabulary(robot.table).values if robot.table is not None else {}
    known = {*words, *(f"{letter}{i + 1}" for letter in LETTERS.values() for i in range(robot.n))}
    place = f"{file.path}: {entry}"
    _refuse_large(text, file, place, {}, ())
    return _resolved(text, file, words, known, place)


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
            raise ExpressionError(f"{place}: symbol {name!r} is explained by itself")
        if name not in sizes:
            way = (*open_names, name)
            sizes[name] = _refuse_large(file.symbols[name], file, place, sizes, way)
        total += sizes[name]
        if total > MOST_NODES:
            break
    if total > MOST_NODES:
        raise ExpressionError(
            f"{place}: with its symbols written out it has more than {MOST_NODES} terms and factors"
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
            choices = near(name, [*words, *sorted(known - set(words)), *file.symbols])
            raise ExpressionError(
                f"{place}: {name[:40]!r} is unknown; {choices}; or give it a meaning in [symbols]"
            )
        mapping[name] = meant
    return tree.renamed(text, mapping)


def _by_value(name: str, given: Node, words: dict[str, float], place: str) -> Node:
    """A user's symbol with a number: the robot's parameter of that value, or the number."""
    value = float(given.value)
    if name in words:
        if not _stands_for(_digits(given), words[name]):
            raise ExpressionError(
                f"{place}: {name} is {value:g} in [symbols] and {words[name]:g} in the robot; "
                "give the robot's number, or another name"
            )
        return tree.sym(name)
    alike = [w for w, x in words.items() if abs(x - value) <= TOLERANCES.same_number * abs(x)]
    close = [w for w in alike if w[0].lower() == name[0].lower()]
    for found in (alike, close):
        if len(found) == 1:
            return tree.sym(found[0])
    return given


def _digits(given: Node) -> str:
    """A symbol's number as digits; 10.0 was 10 before it was read."""
    return repr(float(given.value)).removesuffix(".0")


def _stands_for(digits: str, value: float) -> bool:
    """Whether a number is another one, or that one rounded to its digits."""
    one = literal(digits.lstrip("-"))
    gap = abs((-one.value if digits.startswith("-") else one.value) - value)
    return gap <= max(TOLERANCES.same_number * abs(value), 1.0001 * one.reach)


def _written(entry: str, node: Node, file: FormulaFile, robot: Robot) -> Written:
    """A formula with what its writer's names stand for."""
    words = vocabulary(robot.table).values if robot.table is not None else {}
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
                rounded[name] = _("{name} = {written} in [symbols] stands for {meant:.10g}").format(
                    name=name, written=texts[name], meant=exact
                )
    inside = tree.names(file.formulas[entry])
    used = [note for name, note in rounded.items() if name in inside]
    written = file.texts[entry]
    return Written(
        entry, written, node, texts, known, tuple(used), file.numbers, typing_of(entry, file)
    )


def typing_of(entry: str, file: FormulaFile) -> Typing | None:
    """An entry as it was typed; None where that is its plain text."""
    given = file.as_typed[entry]
    core, dollars = typed.bare(given), typed.is_latex(given)

    def reads(line: str) -> str:
        return typed.plain_formula(f"${line}$" if dollars else line, entry, file.writing)

    plain = tidied(reads(core))
    if tidied(core) == plain and "^" not in core:
        return None
    return Typing(core, plain, tuple(typed.leaves_of(core, entry, file.writing, dollars)), reads)


def _entry_of(label: str, titles: dict[str, str]) -> str:
    """The file's entry that gives a place, its mirror image where only that is given."""
    if label in titles:
        return titles[label]
    plain, index = split_name(label)
    return titles[f"{plain}[{index[1]},{index[0]}]"]


def _values(text: Written, case: Case, file: FormulaFile, entry: str) -> Array:
    """The values of an entry, by its text as it is written."""
    count = len(next(iter(case.arguments.values())))
    words = vocabulary(case.robot.table).values if case.robot.table is not None else {}
    at = {name: np.full(count, value) for name, value in words.items()}
    for argument, stack in case.arguments.items():
        if argument in LETTERS:
            for i in range(case.robot.n):
                at[f"{LETTERS[argument]}{i + 1}"] = stack[:, i]
    foreign = sorted(tree.names(text.node) - set(at)) or text.foreign(set(at))
    if foreign:
        raise ExpressionError(
            f"{file.path}: {entry}: {foreign[0]} does not belong into "
            f"{case.quantity.name}, which depends on {', '.join(case.quantity.arguments)}"
        )
    return text.values(at)
