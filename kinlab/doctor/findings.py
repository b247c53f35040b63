"""Diagnoses as findings: with the formulas typeset and the differences marked, for a report."""

from __future__ import annotations

import pathlib
from collections.abc import Iterator

import numpy as np

from kinlab.check.catalogue import Row
from kinlab.check.finding import Finding, Typeset
from kinlab.check.quantities.registry import quantity as find_quantity
from kinlab.check.quantities.serial import SERIAL
from kinlab.check.targets import Task
from kinlab.doctor.derived import derivation
from kinlab.doctor.diagnosis import Diagnosis
from kinlab.doctor.examine import examine, prepare
from kinlab.doctor.file import examine_file, meant, quantity_of, robot_of
from kinlab.doctor.terms import split_name
from kinlab.formulas.marks import differences
from kinlab.formulas.record import AnswerShapeError
from kinlab.formulas.text import FormulaFile, parse, read_file
from kinlab.formulas.tree import Node, Path, names, sym
from kinlab.formulas.typeset import Marks, equation
from kinlab.model.robot import Robot

FEWEST = 10
"""States that a diagnosis needs at least."""
_OTHERS = 3
_NONE: frozenset[Path] = frozenset()
_SHORT = 40
"""Terms up to which a derived formula is worth showing."""

_LETTERS = {
    "inverse_dynamics": "tau", "gravity_torques": "g", "coriolis_torques": "c",
    "mass_matrix": "M", "coriolis_matrix": "C", "jacobian": "J", "planar_jacobian": "J",
    "fk": "T", "kinetic_energy": "T", "potential_energy": "V",
}  # fmt: skip
"""What a quantity is called where the user gave no name."""


def of_file(path: str | pathlib.Path, samples: int = 200, seed: int = 0) -> list[Finding]:
    """Judges a file of formulas; see :func:`kinlab.doctor.file.examine_file`.

    Args:
        path: the TOML file.
        samples, seed: the states; at least :data:`FEWEST` are taken.

    Raises:
        FileError, ExpressionError, NameUnknownError: what cannot be used, with its place.
    """
    judged = examine_file(path, max(samples, FEWEST), seed)
    file = read_file(path)
    robot = robot_of(file)
    return [_of_text(diagnosis, file, robot) for diagnosis in judged]


def of_task(task: Task, samples: int = 200, seed: int = 0) -> Row | Finding:
    """Runs one row, and looks for what is wrong where it is a user's formula that differs.

    Args:
        task: from :func:`kinlab.check.targets.tasks`.
        samples, seed: the states.

    Returns:
        The row, with its finding; the finding alone where the answer has the wrong shape, so
        that nothing can be compared, and the doctor knows why.

    Raises:
        KinlabError: as :func:`kinlab.compare`.
    """
    serial = find_quantity(task.record.quantity).domain is SERIAL
    try:
        row = task.run(samples, seed)
    except AnswerShapeError:
        finding = _of_function(task, samples, seed) if task.file and serial else None
        if finding is None or not finding.known:
            raise
        return finding
    if row.corrected.agrees or row.failure or not task.file or not serial:
        return row
    return Row(
        row.formula, row.robot, row.corrected, row.printed, _of_function(task, samples, seed)
    )


def _of_function(task: Task, samples: int, seed: int) -> Finding:
    record = task.record
    plain, index = split_name(record.quantity)
    case, engine = prepare(task.robot, plain, index, max(samples, FEWEST), seed)
    numbers = SERIAL.numbers(case.robot)
    hand = record.function(numbers, *(np.array(s) for s in case.arguments.values()))
    found = examine(case, hand, engine, record.quantity, record.id, {})
    right = _corrected(found)
    corrected = tuple(equation(_name(label), parse(text)) for label, text in right.items())
    return _finding(found, task.file, (), corrected)


def _of_text(found: Diagnosis, file: FormulaFile, robot: Robot) -> Finding:
    pointed = _corrected(found)
    right = pointed or _derived(found, robot)
    given: list[Typeset] = []
    corrected: list[Typeset] = []
    for entry, label in _entries(found, file, robot):
        written = file.formulas[entry]
        if label not in right:
            given.append(equation(entry, written))
            continue
        formula = parse(right[label])
        meaning = {name: _meaning(name, file, robot, entry) for name in names(written)}
        wrong, fixed = differences(written, formula, meaning) if pointed else (_NONE, _NONE)
        given.append(equation(entry, written, Marks("wrong", wrong)))
        corrected.append(equation(entry, formula, Marks("fixed", fixed)))
    return _finding(found, file.path, tuple(given), tuple(corrected))


def _corrected(found: Diagnosis) -> dict[str, str]:
    """The right formulas of the first cause that has them: all causes mean the same formula."""
    return next((cause.corrected for cause in found.causes if cause.corrected), {})


def _derived(found: Diagnosis, robot: Robot) -> dict[str, str]:
    """The derived formulas, where no cause points at single terms."""
    if found.agrees or robot.table is None:
        return {}
    plain, index = split_name(found.quantity)
    derived = derivation(robot.table, plain)
    if derived is None:
        return {}
    shape = np.shape(derived.polys)
    places = [tuple(index)] if index or not shape else list(np.ndindex(shape))
    right = {}
    for place in places:
        poly = derived.polys[place] if place else np.asarray(derived.polys).item()
        if len(poly) <= _SHORT:
            label = f"{plain}[{','.join(map(str, place))}]" if place else plain
            right[label] = str(derived.collected(poly))
    return right


def _meaning(name: str, file: FormulaFile, robot: Robot, entry: str) -> Node:
    return meant(sym(name), file, robot, entry)


def _entries(found: Diagnosis, file: FormulaFile, robot: Robot) -> Iterator[tuple[str, str]]:
    """The file's entries that a diagnosis is about, with the places they claim."""
    for entry in file.formulas:
        plain, index = split_name(quantity_of(entry, robot.table))
        label = f"{plain}[{','.join(map(str, index))}]" if index else plain
        if found.quantity in (plain, label):
            yield entry, label


def _name(label: str) -> str:
    plain, index = split_name(label)
    if plain not in _LETTERS or not all(isinstance(k, int) and 0 <= k < 9 for k in index):
        return label
    return _LETTERS[plain] + "".join(str(k + 1) for k in index)


def _finding(
    found: Diagnosis, source: str, given: tuple[Typeset, ...], corrected: tuple[Typeset, ...]
) -> Finding:
    evidence: list[str] = []
    if not found.agrees and not found.causes:
        evidence = [f"Explained: {text}" for text in found.partial]
        with np.printoptions(precision=6, suppress=True, linewidth=200):
            state = ", ".join(f"{name} = {value}" for name, value in found.worst_state.items())
            evidence.append(f"Worst entry {found.worst_entry} at {state}: hand {found.hand}, "
                            f"engine {found.engine}")  # fmt: skip
    return Finding(
        title=found.function,
        source=source,
        quantity=found.quantity,
        robot=found.robot,
        agrees=found.agrees,
        known=bool(found.causes),
        sentence=found.sentence,
        error_before=found.error_before,
        error_after=found.causes[0].error_after if found.causes else None,
        others=tuple(cause.sentence for cause in found.causes[1 : _OTHERS + 1]),
        evidence=tuple(evidence),
        given=given,
        corrected=corrected,
        text=str(found),
        data={"file": source, "ok": found.agrees, **found.as_dict()},
    )
