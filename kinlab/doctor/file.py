"""A file of formulas as text, each examined entry by entry."""

from __future__ import annotations

import re
from collections.abc import Iterable, Mapping, Sequence
from contextlib import suppress
from dataclasses import replace
from pathlib import Path
from typing import Any

import numpy as np

from kinlab.arrays import Array
from kinlab.check.diagnosis import Diagnosis, shown_entry
from kinlab.check.quantities.fivebar import FIVEBAR
from kinlab.check.quantities.registry import split_name
from kinlab.doctor.changes import Case, Mechanism, label_of
from kinlab.doctor.derived import WRENCH
from kinlab.doctor.examine import examine, prepare
from kinlab.doctor.glossary.facts import holding
from kinlab.doctor.linkages import as_right, five_bar
from kinlab.doctor.linkages.mechanisms import mechanism_beside
from kinlab.doctor.shapes import entry_of, in_full, last_joint, parts_of, wholes_of
from kinlab.doctor.text.claims import alone, claimed_of, named_alone, with_forces, with_wrench
from kinlab.doctor.text.habits import with_habits
from kinlab.doctor.text.joints import joint_values
from kinlab.doctor.text.own_names import (
    DECIMAL,
    as_distances,
    constants_named,
    in_robot_names,
    with_underscores,
    written_as,
)
from kinlab.doctor.text.written import Written
from kinlab.doctor.verdicts import numbers_at
from kinlab.errors import ExpressionError, FileError, KinlabError, NameUnknownError
from kinlab.fivebar import FiveBar
from kinlab.formulas import tree
from kinlab.formulas.files import FormulaFile, formula_file
from kinlab.formulas.language.prose import Doubt
from kinlab.formulas.lines import Lines, read_lines
from kinlab.formulas.signs.refusals import refused
from kinlab.formulas.text import canonical, parse, words_in
from kinlab.formulas.tree import Node
from kinlab.host.files import read_text
from kinlab.host.language import N_, _
from kinlab.tolerances import TOLERANCES

_FEWEST = 10
"""States that :func:`prepare` asks for at least."""

_FILE_LIMIT = 1 << 20
_OF_JOINT = re.compile(r"q\d+")
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
    """Judges every formula of a file; :func:`kinlab.formulas.files.formula_file` has the format.

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
    file = read_formulas(lines.document, str(path))
    robot = robot_of(file)
    require_whole(as_judged(file, robot), robot)
    found = examine_formulas(file, robot, samples, seed)
    refuse_unjudged(found)
    return found


def refuse_unjudged(found: Iterable[Diagnosis]) -> None:
    """Refuses what was not judged for the words beside it.

    Raises:
        ExpressionError: with these words.
    """
    for one in found:
        if one.form == "words":
            raise ExpressionError(one.sentence)


def examine_formulas(
    file: FormulaFile, robot: Mechanism, samples: int = 200, seed: int = 0
) -> list[Diagnosis]:
    """Judges formulas that are read already, of a robot that is loaded.

    Entries that make up a whole quantity are judged together, so that a confusion of the whole
    (a frame, gravity's sign) is seen; others each for itself.

    Args:
        file: the formulas.
        robot: from :func:`robot_of`.
        samples, seed: the states, as in :func:`kinlab.diagnose`.

    Raises:
        ExpressionError: a name that means nothing, or a part of a chain of equalities that is none
            where the last one is wrong, and nobody knows why.
    """
    file = as_judged(file, robot)
    parts, unheld = [_examined(file, robot, samples, seed)], list[str]()
    files = [file]
    unread, unsure = file.broken, ""
    right = all(one.agrees for one in parts[0])
    if unread and not all(one.agrees or one.causes for one in parts[0]):
        raise ExpressionError(file.broken)
    for other in file.others:
        try:
            part = _examined(other, robot, samples, seed)
        except ExpressionError as problem:  # T = T_1 + T_2 = ...
            unread = unread or str(problem)
            continue
        same = all(one.agrees for one in part)
        if other.apart and same and not right:
            return [_given_twice(one) for one in parts[0]]
        if other.line and right and not same:
            unheld += [other.line]
        elif right and _may_mean_another(other, file) and not same:
            unsure = unsure or _("its names may be of another point, or another link")
        else:
            parts.append(part)
            files.append(other)
    if unread and right and not all(one.agrees for part in parts for one in part):
        raise ExpressionError(unread)  # what was not read may say of what the rest is
    unknown = (file.broken or unsure or unread).removeprefix(f"{file.path}: ")
    alike = [
        [_judged_with(one, file.unread, of.formulas) for one in part]
        for part, of in zip(parts, files, strict=True)
        if len(part) == len(parts[0])
    ]
    told = [_of_chain(list(same)) for same in zip(*alike, strict=True)]
    if unknown:
        said = _("a part of the chain of equalities was not judged ({why})").format(why=unknown)
        told = [replace(one, remarks=(*one.remarks, said)) for one in told]
    for line in dict.fromkeys(reversed(unheld)):
        said = _("another line, {line!r}, was not judged: it may be of a part")
        told = [replace(one, remarks=(*one.remarks, said.format(line=line))) for one in told]
    return [_with_remarks(one, file.remarks) for one in told] if file.remarks else told


def _given_twice(found: Diagnosis) -> Diagnosis:
    """A diagnosis of a formula that is wrong where a line before it, with other words, is right."""
    if found.agrees:
        return found
    said = _(
        "it is given in several lines that are not the same, and the words beside them may say of "
        "what each of them is; leave one"
    )
    return replace(found, causes=(), partial=(), proved=(), form="words", remarks=(said,))


_UNCONDITIONED = {"sign", "sin/cos", "index", "power", "argument"}
"""Kinds of slips that no special case, no part and no other point of the arm can be."""


def _counted(label: str) -> str:
    """The entry of a label, counted from 1: ``(1, 3)`` of ``planar_jacobian[0,2]``."""
    told = ", ".join(str(int(k) + 1) for k in re.findall(r"-?\d+", label.partition("[")[2]))
    return f"({told})" if "," in told else told


def _judged_with(
    found: Diagnosis, words: Mapping[str, Doubt], formulas: Mapping[str, Node]
) -> Diagnosis:
    """A diagnosis of a formula with words that were not read: right as it stands, or not judged.

    What holds in a special case alone has fewer terms and names; a slip that leaves them as many
    is none of that, unless the words tell of other axes. The sign of the whole may be another sense
    of turning, or another gravity, by whatever words: ``on the ceiling``.
    """
    unread = [words[one] for one in found.function.split(", ") if one in words]
    if not unread:
        return found
    if found.agrees:
        said = _("the words {words!r} beside the formula were not read: it is judged without them")
        return replace(found, remarks=(*found.remarks, said.format(words=unread[0].words)))
    turned = any(one.turned for one in unread) or _is_negative(found)
    if not turned and _names_as_much(found, formulas):
        return found
    told = [words_unread(unread[0].words)]
    if found.causes:
        then = _("if it is {entry} in every state, it has a slip: {cause}")
        if turned:
            then = _(
                "if it is {entry} in every state, by the robot's own axes, it has a slip: {cause}"
            )
        told += [then.format(entry=found.title, cause=found.causes[0].sentence)]
    return replace(found, causes=(), partial=(), proved=(), form="words", remarks=tuple(told))


def words_unread(words: str) -> str:
    """What is told of a formula with words beside it that nobody has listed.

    Args:
        words: these words.
    """
    said = _(
        "the words {words!r} beside the formula were not read and may say when it holds or of "
        "what it is; leave them out if it is meant for every state"
    )
    return said.format(words=words)


def _is_negative(found: Diagnosis) -> bool:
    """Whether a formula is minus the right one, as far as its worst state tells."""
    if found.hand is None or found.engine is None:
        return False
    return bool(np.allclose(found.hand, -found.engine, rtol=TOLERANCES.formula_agrees, atol=0.0))


def _names_as_much(found: Diagnosis, formulas: Mapping[str, Node]) -> bool:
    """Whether a formula with a slip has as many angles in it as the right one."""
    if not found.causes or not {*found.causes[0].kinds} <= _UNCONDITIONED:
        return False
    right = found.causes[0].corrected
    pairs = [(parse(right[one]), formulas[one]) for one in right if one in formulas]
    return all(_angles(new) <= _angles(old) for new, old in pairs)


def _angles(formula: Node) -> int:
    """How often angles stand in a formula: two of c12."""
    plain = tree.renamed(formula, {name: canonical(name) for name in tree.names(formula)})
    found = [str(one.value) for _path, one in tree.nodes(plain) if one.op == "sym"]
    return sum(bool(_OF_JOINT.fullmatch(name)) for name in found)


def as_judged(file: FormulaFile, robot: Mechanism) -> FormulaFile:
    """The formulas as they are judged and shown: both sides of a loop, names as they are meant."""
    if not isinstance(robot, FiveBar):
        return file
    return five_bar.with_habits(five_bar.with_equations(file), robot)


def _with_remarks(found: Diagnosis, remarks: Mapping[str, str]) -> Diagnosis:
    """A diagnosis with what is to be said of how its entries were read."""
    said = dict.fromkeys(remarks[one] for one in found.function.split(", ") if one in remarks)
    return replace(found, remarks=(*found.remarks, *said))


_OF_A_POINT = re.compile(r"[IJ](?:_?[A-Za-z]\w{0,3})?|(?:J|omega|w|v|h|r)_?\d?")
"""A moment of inertia, a velocity, a height: of what point, or of which body, nobody says."""


def _may_mean_another(other: FormulaFile, file: FormulaFile) -> bool:
    """Whether a step has names that mean what its writer says, and says nowhere: J, omega."""
    names = {name for node in other.formulas.values() for name in tree.names(node)}
    return any(map(_OF_A_POINT.fullmatch, names - {*file.symbols}))


def _of_chain(parts: list[Diagnosis]) -> Diagnosis:
    """What is told of ``a = b = c``: the part that is wrong, or the one that holds most widely.

    Of several wrong ones it is the last, which is what was meant; where all have its values, the
    first of those with the fewest slips: there it was made, and the others carry it on.
    """
    wrong = [one for one in parts if not one.agrees]
    if not wrong:
        return min(parts, key=lambda one: (bool(one.form), len(one.remarks)))
    alike = [one for one in wrong if one.causes and _has_the_values_of(one, wrong[0])]
    made = min(reversed(alike), key=lambda one: len(one.causes[0].kinds), default=wrong[0])
    notes = list[str]()
    if made.causes and made.causes[0].sentence not in [x.sentence for x in wrong[0].causes[:1]]:
        notes += [_("another side of the chain of equalities carries it on")]
    if len(wrong) < len(parts):
        notes += [_("another part of the chain of equalities is right")]
        made = replace(made, proved=(*made.proved, notes[-1]))
    return _also_said(made, (*notes,)) if made.causes else made


def _has_the_values_of(one: Diagnosis, other: Diagnosis) -> bool:
    """Whether two formulas have one value at their worst states, to rounded numbers."""
    if one.hand is None or other.hand is None or np.shape(one.hand) != np.shape(other.hand):
        return False
    if not np.isfinite(other.hand).all():
        return False
    near = TOLERANCES.carried_on * np.abs(other.hand).max(initial=0.0)
    return bool(np.allclose(one.hand, other.hand, rtol=0.0, atol=near))


def _examined(file: FormulaFile, robot: Mechanism, samples: int, seed: int) -> list[Diagnosis]:
    file, shape = in_full(file, robot)
    return [_noted(one, shape) for one in _as_it_is(file, robot, samples, seed)]


def _as_it_is(file: FormulaFile, robot: Mechanism, samples: int, seed: int) -> list[Diagnosis]:
    given = {*file.symbols}
    file = with_names(file, robot)

    def judged(other: FormulaFile) -> list[Diagnosis]:
        done = _by_quantity(other, robot, samples, seed)
        return [one for found in done.values() for one in found]

    found = judged(file)
    if all(one.agrees for one in found):
        return found
    named, said = constants_named(file, robot)
    if said:
        pairs = zip(found, judged(named), strict=True)
        found = [_read_better(one, other, file, said) for one, other in pairs]
    away, said = as_distances(file, robot, given)
    if said:
        pairs = zip(found, judged(away), strict=True)
        found = [_by_distances(one, other, file, said) for one, other in pairs]
    return found


def with_names(file: FormulaFile, robot: Mechanism) -> FormulaFile:
    """The formulas with a meaning for each name that has one elsewhere in them, or by habit.

    Args:
        file: the formulas.
        robot: whose they are.
    """
    return with_habits(with_forces(with_underscores(file, robot), robot), robot)


def _by_distances(
    first: Diagnosis, second: Diagnosis, file: FormulaFile, said: dict[str, str]
) -> Diagnosis:
    """The second reading, in which lengths are distances, where only that one is right."""
    if first.agrees or not second.agrees:
        return first
    texts = (file.formulas.get(entry) for entry in first.function.split(", "))
    here = {name for text in texts if text is not None for name in tree.names(text)}
    notes = tuple(told for name, told in said.items() if name in here)
    return replace(second, remarks=(*notes, *second.remarks))


def _by_quantity(
    file: FormulaFile, robot: Mechanism, samples: int, seed: int
) -> dict[str, list[Diagnosis]]:
    wanted, titles = _claims(file, robot)
    done: dict[str, list[Diagnosis]] = {}
    for plain, formulas in wanted.items():
        answers = _answers(plain, formulas, titles, robot, file, samples, seed)
        done[plain] = list(_of_quantity(plain, answers, titles, file.parts))
        with_one = _with_one_force(plain, answers, titles, robot, file, samples, seed)
        in_tool_axes = False
        if plain == "statics" and not all(one.agrees for one in done[plain]):
            turned = _in_tool_axes(formulas, titles, robot, file, samples, seed)
            settled = [all(x.agrees or x.known for x in found) for found in (done[plain], turned)]
            if all(one.agrees for one in turned) or settled == [False, True]:
                done[plain], in_tool_axes = turned, True
            felt = False
            for force, there in with_one.items():
                if not np.array_equal(there[1], answers[1]):
                    felt = True
                    found = [*_of_quantity(plain, there, titles, file.parts)]
                    done[plain] = _simpler(done[plain], found, force, formulas)
            if felt:  # what is taken out may be of a force that is taken as zero
                done[plain] = [
                    replace(one, causes=()) if _lost([one], formulas) else one
                    for one in done[plain]
                ]
        told = all(one.agrees or one.causes for one in done[plain])
        if with_one and told and not in_tool_axes:
            said = _without_forces(answers, with_one, done[plain])
            done[plain] = [replace(one, remarks=(*one.remarks, *said)) for one in done[plain]]
    return done


def _with_one_force(
    plain: str,
    answers: Answers,
    titles: dict[str, str],
    robot: Mechanism,
    file: FormulaFile,
    samples: int,
    seed: int,
) -> dict[str, Answers]:
    """The answers with each force and moment of the tool that no formula names."""
    if "wrench" not in answers[0].arguments:
        return {}
    formulas = answers[3]
    return {
        force: _answers(plain, formulas, titles, robot, file, samples, seed, (force,))
        for force in WRENCH
        if force not in _named(formulas)
    }


def _without_forces(
    right: Answers, with_one: dict[str, Answers], found: list[Diagnosis]
) -> tuple[str, ...]:
    """What is said of right torques that have not all of the tool's forces and moments.

    Those of a formula are right or set right. A force that their joints do not feel is not missed.
    """
    _case, engine, labels, formulas, _values = right
    told = [cause for one in found for cause in one.causes[:1]]
    put = {name for one in told for text in one.corrected.values() for name in words_in(text)}
    own = [labels.index(label) for label in formulas]
    felt = []
    for force, there in with_one.items():
        more = (there[1] - engine).reshape(len(engine), -1)[:, own]
        size = np.abs(there[0].arguments["wrench"]).max()
        if force not in put and np.abs(more).max() > TOLERANCES.force_felt * size:
            felt.append(force)
    said = _("it has no {forces} of the tool: as if there were none")
    return (said.format(forces=", ".join(felt)),) if felt else ()


def _named(formulas: dict[str, Written]) -> set[str]:
    return {name for text in formulas.values() for name in tree.names(text.node)}


def _simpler(
    named: list[Diagnosis], with_one: list[Diagnosis], force: str, formulas: dict[str, Written]
) -> list[Diagnosis]:
    """The diagnoses with one force more that is not zero, where these are simpler.

    A force that no line names may be one that stands there by another's name. A repair that takes
    a force out holds only where this one is zero: one that puts it in its place comes first.
    """
    kinds = [[kind for one in found for kind in _kinds_of(one)] for found in (named, with_one)]
    if not all(one.agrees or one.causes for one in with_one):
        return named
    if any(lost[0] == force[0] for lost in _lost(named, formulas)):
        instead = "parameter" in kinds[1] and not _lost(with_one, formulas)
        return with_one if instead else named
    if "missing term" in kinds[1]:
        return named
    fewer = len(kinds[1]) < len(kinds[0])
    instead = "extra term" in kinds[0] and len(kinds[1]) <= len(kinds[0])
    unknown = any(not one.agrees and not one.causes for one in named)
    return with_one if fewer or instead or unknown else named


def _lost(found: list[Diagnosis], formulas: dict[str, Written]) -> set[str]:
    """The parts of the wrench that a repair takes out of a formula."""
    right = {k: text for one in found for c in one.causes[:1] for k, text in c.corrected.items()}
    lost: set[str] = set()
    for text in formulas.values():
        if text.entry in right:
            typed, now = words_in(text.restored(text.text)), words_in(right[text.entry])
            old, new = ([word for word in words if word in WRENCH] for words in (typed, now))
            gone = {name for name in old if new.count(name) < old.count(name)}
            lost |= gone if len(new) < len(old) else set()
    return lost


def _kinds_of(found: Diagnosis) -> Sequence[str]:
    return found.causes[0].kinds if found.causes else ()


def _in_tool_axes(
    formulas: dict[str, Written],
    titles: dict[str, str],
    robot: Mechanism,
    file: FormulaFile,
    samples: int,
    seed: int,
) -> list[Diagnosis]:
    """The diagnoses where the wrench is in tool axes, which its names leave open."""
    there = {label.replace("statics", "statics_tool"): text for label, text in formulas.items()}
    named = {label.replace("statics", "statics_tool"): name for label, name in titles.items()}
    answers = _answers("statics_tool", there, named, robot, file, samples, seed)
    parts = {
        name.replace("statics", "statics_tool"): [
            one.replace("statics", "statics_tool") for one in part
        ]
        for name, part in file.parts.items()
    }
    found = list(_of_quantity("statics_tool", answers, named, parts))
    said = _("the wrench is read in tool axes")
    return [_noted(one, said) for one in found]


def _noted(found: Diagnosis, note: str) -> Diagnosis:
    """A diagnosis with what is to be said of how the formula was read, if anything."""
    if not note:
        return found
    if found.causes:
        return _also_said(found, (note,))
    return replace(found, remarks=(*found.remarks, note))


def _also_said(found: Diagnosis, notes: tuple[str, ...]) -> Diagnosis:
    """A diagnosis with more in the sentence of its first cause."""
    first, *rest = found.causes
    told = _("; ").join((first.sentence, *notes))
    return replace(found, causes=(replace(first, sentence=told), *rest))


def _read_better(
    first: Diagnosis, second: Diagnosis, file: FormulaFile, said: dict[str, str]
) -> Diagnosis:
    """The second reading, in which rounded numbers are what they stand for, where it says more."""
    if first.agrees or not (second.agrees or second.causes):
        return first
    if first.causes and second.causes and len(second.causes[0].kinds) > len(first.causes[0].kinds):
        return first
    texts = (file.texts.get(entry, "") for entry in first.function.split(", "))
    here = {digits for text in texts for digits in DECIMAL.findall(text)}
    notes = tuple(told for digits, told in said.items() if digits in here)
    second = replace(second, error_before=first.error_before)
    if second.agrees:
        form = second.form or "rounded"
        return replace(second, form=form, remarks=(*notes, *second.remarks))
    return _also_said(second, notes)


def twice(entry: str, other: str) -> str:
    """What is told of two entries for one place: tau2 and a second line of [tau1, tau2]."""
    one, two = shown_entry(entry), shown_entry(other)
    if one == two:
        return _("{one} is given twice; keep one").format(one=one)
    return _("{one} is given twice, also as {two}; keep one").format(one=one, two=two)


_ROTATION = re.compile(r"R(?![A-Za-z])")
_AXES = 2
"""Of a matrix."""


def require_whole(file: FormulaFile, robot: Mechanism) -> None:
    """Refuses a matrix that lacks rows or columns: what is not there cannot be right.

    What is zero everywhere may be left out: z of a planar arm. Of a Jacobian any rows may be given,
    and of a pose all but the last; R is its first three rows and columns.

    Args:
        file: as it is judged.
        robot: whose formulas they are.

    Raises:
        ExpressionError: with the sizes.
    """
    file, _shape = in_full(file, robot)
    titles = _claims(with_names(file, robot), robot)[1] if file.matrices else {}
    given: dict[str, dict[tuple[Any, ...], str]] = {}
    for label, entry in titles.items():
        plain, index = split_name(label)
        if entry in file.matrices and not _ROTATION.match(entry):
            given.setdefault(plain, {})[index] = file.matrices[entry]
    for key, labels in file.parts.items():
        for label in labels:
            plain, index = split_name(label) if label not in file.formulas else ("", ())
            if plain and np.any(prepare(robot, plain, index, _FEWEST, 0)[1]):
                said = N_("write it as a matrix of {size} entries")
                raise refused(f"{file.path}: {key}", said, size=str(len(labels)))
    for plain, places in given.items():
        case, engine = prepare(robot, plain, (), _FEWEST, 0)
        if case.quantity.read is not None or engine.ndim != 1 + _AXES:
            continue
        places = {(*index, 0)[:_AXES]: entry for index, entry in places.items()}  # a column
        rows, columns = (len({index[k] for index in places}) for k in range(_AXES))
        enough = 1 if "jacobian" in plain else 3 if plain == "fk" else len(engine[0])
        if np.any(engine[:, rows:enough]) or np.any(engine[:, :, columns:]):
            raise refused(
                f"{file.path}: {next(iter(places.values()))}",
                N_("a matrix of {given} is given; {plain} is {shape}"),
                given=f"{rows} x {columns}",
                plain=plain,
                shape=" x ".join(map(str, engine.shape[1:])),
            )


def require_sound(file: FormulaFile, robot: Mechanism) -> dict[str, str]:
    """Refuses what :func:`examine_formulas` would refuse, without judging anything.

    Returns:
        The entries by the place that they claim: ``{"fk[0,3]": "x"}``.

    Raises:
        ExpressionError: a name that means nothing, an entry that does not exist.
    """
    file = as_judged(file, robot)
    for part in (*file.others, file):
        part = with_names(part, robot)
        wanted, titles = _claims(part, robot)
        for plain, formulas in wanted.items():
            _answers(plain, formulas, titles, robot, part, _FEWEST, 0)
    require_whole(file, robot)
    return titles


def _claims(
    file: FormulaFile, robot: Mechanism
) -> tuple[dict[str, dict[str, Written]], dict[str, str]]:
    """The formulas by quantity and by the place they claim, and the entries' names by place."""
    wanted: dict[str, dict[str, Written]] = {}
    titles: dict[str, str] = {}
    for entry, text in file.formulas.items():
        try:
            name = claimed_of(entry, robot)
            if isinstance(robot, FiveBar):
                five_bar.refuse_massless(name, robot)
            else:
                name = with_wrench(file, alone(name) if robot.n == 1 else name)
            plain, index = split_name(name)
        except KinlabError as problem:
            raise ExpressionError(f"{file.path}: {entry}: {problem}") from None
        if any(isinstance(k, slice) for k in index):
            raise refused(f"{file.path}: {entry}", N_("name one entry, not a range"))
        label = label_of(plain, index)
        if label in titles:
            raise ExpressionError(f"{file.path}: {twice(entry, titles[label])}")
        node = in_robot_names(text, file, robot, entry)
        wanted.setdefault(plain, {})[label] = written_as(entry, node, file, robot)
        titles[label] = entry
    return wanted, titles


def _answers(
    plain: str,
    formulas: dict[str, Written],
    titles: dict[str, str],
    robot: Mechanism,
    file: FormulaFile,
    samples: int,
    seed: int,
    forces: Sequence[str] = (),
) -> Answers:
    """The case, the engine's answers, every place there is, and the formulas with their values.

    Of a wrench the parts that no formula names are zero, but for those of ``forces``; static
    torques that name no force are of all of them.
    """
    case, engine = prepare(robot, plain, (), samples, seed)
    if case.quantity.read is not None:
        joints = joint_values(case, formulas, titles, file.path)
        return case, engine, list(joints), formulas, joints
    if "wrench" in case.arguments:
        named = _named(formulas)
        static = plain.startswith("statics")  # a torque of nothing else
        of_all = WRENCH if static and named.isdisjoint(WRENCH[:3]) else ()
        case = named_alone(case, named.union(forces, of_all))
        engine = case.answer(())
    shape = engine.shape[1:]
    labels = [label_of(plain, k) for k in np.ndindex(shape)]
    for label in formulas:
        if label not in labels:
            whole = N_("{plain} is {shape}; write it as a matrix, or ask for one entry of it")
            raise refused(
                f"{file.path}: {titles[label]}",
                N_("entry {entry} does not exist; {plain} is {shape}")
                if _counted(label)
                else whole,
                entry=_counted(label),
                plain=plain,
                shape=" x ".join(map(str, shape)) or "1",
            )
    if plain in _MIRRORED:
        turned = {label_of(plain, k): label_of(plain, k[::-1]) for k in np.ndindex(shape)}
        mirrored = {label: formulas[other] for label, other in turned.items() if other in formulas}
        if len({**mirrored, **formulas}) == len(labels):
            formulas = {**mirrored, **formulas}
    formulas = {
        label: x.with_what_is_known({*numbers_at(_alone_in(case, label))}) if x.symbols else x
        for label, x in formulas.items()
    }
    entries = {label: _entry_of(label, titles) for label in formulas}
    values = {
        label: _values(x, _alone_in(case, label), file, entries[label])
        for label, x in formulas.items()
    }
    return case, engine, labels, formulas, values


def _alone_in(case: Case, label: str) -> Case:
    """The case of one entry of a five-bar, whose names are those of its leg."""
    return replace(case, index=split_name(label)[1]) if case.quantity.domain is FIVEBAR else case


def _of_quantity(
    plain: str, answers: Answers, titles: dict[str, str], parts: Mapping[str, list[str]]
) -> Iterable[Diagnosis]:
    case, engine, labels, formulas, values = answers
    if len(formulas) == len(labels) and case.quantity.domain is not FIVEBAR:
        hand = np.stack([values[label] for label in labels], axis=-1)
        if case.quantity.read is None:
            hand = hand.reshape(engine.shape)
        shown = ", ".join(titles[label] for label in labels if label in titles)
        yield examine(case, hand, engine, plain, shown, formulas)
        return
    if case.quantity.domain is FIVEBAR:
        yield from _of_five_bar(case, formulas, values, titles)
        return
    asked = {name: part for name, part in parts.items() if split_name(name)[0] == plain}
    if plain in ("coriolis_matrix", "jacobian") or asked:
        yield from _parts_given(plain, case, engine, formulas, values, titles, asked)
    for label, answer in values.items():
        _plain, index = split_name(label)
        part = replace(case, index=index)
        one = {label: formulas[label]}
        found = examine(part, answer, engine[(slice(None), *index)], label, titles[label], one)
        yield _of_one_split(found) if plain == "coriolis_matrix" else found


def _of_five_bar(
    case: Case,
    formulas: dict[str, Written],
    values: dict[str, Array],
    titles: dict[str, str],
) -> Iterable[Diagnosis]:
    """Each entry by itself; A, B and C of a leg with the factor that most of them have."""
    cases = {label: _alone_in(case, label) for label in values}
    legs: dict[Any, list[str]] = {}
    for label in values if case.quantity.name.endswith("_equation") else ():
        legs.setdefault(cases[label].index[:-1], []).append(label)
    factors = {
        label: as_right.common_factor((cases[one], values[one], formulas[one]) for one in leg)
        for leg in legs.values()
        for label in leg
    }
    for label, answer in values.items():

        def judge(case: Case, hand: Array, right: Array, label: str = label) -> Diagnosis:
            return examine(case, hand, right, label, titles[label], {label: formulas[label]})

        factor = factors.get(label, "")
        yield as_right.judged_kindly(cases[label], answer, formulas[label], factor, judge)


def _of_one_split(found: Diagnosis) -> Diagnosis:
    """An entry of C without the rest of its row: it may belong to another valid C."""
    if found.agrees or not found.causes:
        return found
    told = _("Christoffel's C is meant; with the whole row given, another valid C would be told")
    return _also_said(found, (told,))


def _parts_given(
    plain: str,
    case: Case,
    engine: Array,
    formulas: dict[str, Written],
    values: dict[str, Array],
    titles: dict[str, str],
    asked: Mapping[str, list[str]],
) -> Iterable[Diagnosis]:
    """Parts that are whole, taken out of the entries, which are judged each for itself.

    Those that are asked for; rows of C, for one row has many valid splits; the linear or the
    angular half of a Jacobian.
    """
    n = case.robot.n
    rows = {f"{plain}[{i}]": [i] for i in range(n)} if plain == "coriolis_matrix" else {}
    if plain == "jacobian":
        rows = {"jacobian[:3]": [0, 1, 2], "jacobian[3:]": [3, 4, 5]}
    whole = {
        name: [f"{plain}[{i},{j}]" for i in some for j in range(n)] for name, some in rows.items()
    }
    for name, labels in {**whole, **asked}.items():
        if not all(label in values for label in labels):
            continue
        _plain, index = split_name(name)
        wanted = engine[(slice(None), *index)]
        hand = np.stack([values.pop(label) for label in labels], axis=-1).reshape(wanted.shape)
        texts = {label: formulas[label] for label in labels}
        shown = ", ".join(titles[label] for label in labels)
        yield examine(replace(case, index=index), hand, wanted, name, shown, texts)


def read_formulas(document: Mapping[str, Any], path: str) -> FormulaFile:
    """Formulas, and the clauses beside them that are true of the robot that they name.

    Args:
        document: as :func:`kinlab.formulas.files.formula_file` has it.
        path: the file.

    Raises:
        FileError, ExpressionError: as there; a robot that there is not is told with its formulas.
    """
    name = document.get("robot")
    try:
        robot = mechanism_beside(name, path) if isinstance(name, str) and name else None
    except KinlabError:
        robot = None
    if robot is None:
        return formula_file(document, path)
    return of_robot(document, path, robot)


def of_robot(document: Mapping[str, Any], path: str, robot: Mechanism) -> FormulaFile:
    """The formulas of a document that is read already, held against what is known of the robot.

    Raises:
        FileError, ExpressionError: the document holds no formulas, or what is none.
    """
    known = holding(robot), parts_of(robot), last_joint(robot)
    try:
        return formula_file(document, path, None, *known)
    except ExpressionError:
        entries = document.get("formulas", {})
        entry, text = next(iter(entries.items())) if len(entries) == 1 else ("", "")
        for whole in wholes_of(entry, str(text), robot):
            with suppress(ExpressionError):
                given = {**document, "formulas": {whole: text}}
                file = formula_file(given, path, None, *known)
                require_whole(as_judged(file, robot), robot)
                return replace(entry_of(file, entry, robot), whole=whole)
        raise


def robot_of(file: FormulaFile) -> Mechanism:
    """The robot of a file, by name, or by a path that may be relative to the file.

    Raises:
        NameUnknownError, FileError: no such robot; the message names the file.
    """
    try:
        return mechanism_beside(file.robot, file.path)
    except NameUnknownError as problem:
        raise NameUnknownError(f"{file.path}: {problem}") from None
    except FileError as problem:
        raise FileError(f"{file.path}: robot: {problem}") from None


def _entry_of(label: str, titles: dict[str, str]) -> str:
    """The file's entry that gives a place, its mirror image where only that is given."""
    if label in titles:
        return titles[label]
    plain, index = split_name(label)
    return titles[label_of(plain, index[::-1])]


def _values(text: Written, case: Case, file: FormulaFile, entry: str) -> Array:
    """The values of an entry, by its text as it is written."""
    at = numbers_at(case)
    foreign = sorted(tree.names(text.node) - set(at)) or text.foreign(set(at))
    if foreign:
        raise refused(
            f"{file.path}: {entry}",
            N_("{text} does not belong into {name}, which depends on {value}"),
            text=foreign[0],
            name=case.quantity.name,
            value=", ".join(case.quantity.arguments),
        )
    return text.values(at)
