"""The command check: hand formulas beside the engine."""

from __future__ import annotations

from contextlib import ExitStack
from dataclasses import dataclass, field
from pathlib import Path
from typing import TYPE_CHECKING, Annotated

import typer

from kinlab.check.together import ENOUGH, Helpers
from kinlab.cli.robots import TOOL
from kinlab.cli.screen import Screen, complain, echo, plain_table, screen, styled, visible, wrote
from kinlab.errors import KinlabError, OptionError
from kinlab.host.language import N_, _
from kinlab.host.progress import progress

if TYPE_CHECKING:
    from collections.abc import Sequence

    from kinlab.check.catalogue import Row
    from kinlab.check.diagnosis import Diagnosis
    from kinlab.check.targets import PlannedRow
    from kinlab.check.unread import Unread

WHAT = Annotated[
    list[str] | None,
    typer.Argument(
        help="Robots, .toml/.csv/.urdf files of robots, your formulas (.py files with marked "
        "functions, which are run; .toml files of text), notes (001) or formula ids (002.C). "
        "Nothing: the whole catalogue on the shipped robots.",
        show_default=False,
    ),
]
REPORT = Annotated[
    list[Path] | None,
    typer.Option("--report", help="Write a report to this .html or .md file; may be repeated."),
]
JSON = Annotated[bool, typer.Option("--json", help="Print the rows as JSON.")]
ROWS = Annotated[bool, typer.Option("--rows", help="One line for each robot of a formula.")]
ONLY = Annotated[
    str | None,
    typer.Option(
        "--only", help="Of the notes, only the formulas with a misprint: --only misprints."
    ),
]
COMPACT = Annotated[
    bool, typer.Option("--compact", help="In the report, one line for a formula that agrees.")
]
QUANTITIES = Annotated[
    bool, typer.Option("--quantities", help="List the engine's quantities and stop.")
]
SAMPLES = Annotated[int, typer.Option("--samples", help="Random states for each row.", min=1)]
SEED = Annotated[int, typer.Option("--seed", help="Same seed, same states.", min=0)]
AGAINST = Annotated[
    str | None,
    typer.Option(
        "--against",
        help="Another description of the same arm: a robot, a .toml, .csv or .urdf file, or a "
        ".csv of poses (q1 ... qn, then x, y, z, roll, pitch, yaw or T11 ... T34). Says which "
        "cell of the tables is wrong.",
    ),
]


_COLUMNS = (
    N_("formula"),
    N_("what"),
    N_("robot"),
    N_("error"),
    N_("printed"),
    N_("verdict"),
)


def check(
    what: WHAT = None,
    report: REPORT = None,
    json: JSON = False,
    rows: ROWS = False,
    quantities: QUANTITIES = False,
    samples: SAMPLES = 200,
    seed: SEED = 0,
    against: AGAINST = None,
    tool: TOOL = None,
    only: ONLY = None,
    compact: COMPACT = False,
) -> None:
    """Put hand formulas beside the engine, or a DH table beside another description of the arm.

    A .py file is run, like any program, in a process of its own: only check files you trust.
    A formula of yours that differs is taken apart: what is wrong, and how far off it is before
    and after the repair. With --against the same is done to a table, cell by cell. Exit code 0 if
    every correct form agrees (and every misprint shows), 1 if not, 2 for bad input; what cannot
    be read is listed with its reason, and the rest is judged.
    """
    _refuse(only, compact, report or (), against)
    if against is not None:
        from kinlab.cli.against import check_against

        check_against(what or [], against, tool, report or [], json, seed)
        return
    if quantities:
        _list_quantities()
        return
    with ExitStack() as stack:
        # first, so that they import while we do
        helpers = stack.enter_context(Helpers()) if not what else None
        from kinlab.check.report.write import check_report_path, write_report
        from kinlab.check.targets import read_tasks

        for file in report or ():
            check_report_path(file)
        found = _Found()
        todo: Sequence[PlannedRow] = ()
        rest = _formula_files(what or [], samples, seed, found)
        if tool is not None and found.judged:
            raise OptionError("--tool is of a robot that is named; a formula file names its own")
        if only is not None and found.judged:
            raise OptionError("check --only misprints: it is of the notes; leave your files out")
        if rest or not what:
            todo, unread = read_tasks(rest, tool)
            found.unread += unread
            if only is not None:
                todo = _misprints(todo)
            if helpers is None and sum(task.ships for task in todo) >= ENOUGH:
                helpers = stack.enter_context(Helpers())
            _run(todo, samples, seed, helpers, found)
    found.unread.sort(key=lambda one: _place(one.what, what or []))
    if found.nothing and len(found.unread) == 1 and not report:
        raise found.unread[0].problem
    if json:
        _print_json(found)
    else:
        _print_all(found, rows)
    for line in _remarks(todo if what else ()):
        echo(line, err=json)
    for file in report or ():
        write_report(file, found.rows, found.judged, found.unread, compact=compact)
        wrote(file, err=json)
    for missed in found.unread:
        told = _("not judged: {what}: {reason}").format(what=missed.what, reason=missed.reason)
        complain(KinlabError(told))
    if found.unread:
        raise typer.Exit(2)
    if not all(row.ok for row in found.rows) or not all(one.agrees for one in found.judged):
        raise typer.Exit(1)


def _refuse(only: str | None, compact: bool, report: Sequence[Path], against: str | None) -> None:
    """Refuses what would not be obeyed, before any work is done.

    Raises:
        OptionError: another ``--only``, or an option without what it is of.
    """
    if only not in (None, "misprints"):
        raise OptionError(f"check --only {only}: there is only 'misprints'")
    if compact and not report:
        raise OptionError("check --compact: it is of a report; name one with --report")
    if against is not None and (only is not None or compact):
        raise OptionError("check --against: it judges tables; leave --only and --compact out")


def _misprints(todo: Sequence[PlannedRow]) -> list[PlannedRow]:
    """Of the tasks, those of formulas with a misprint.

    Raises:
        OptionError: formulas of a user are among them, or no misprint is.
    """
    if any(task.file for task in todo):
        raise OptionError("check --only misprints: it is of the notes; leave your files out")
    left = [task for task in todo if task.record.printed is not None]
    if todo and not left:
        raise OptionError("check --only misprints: there is none among these formulas")
    return left


def _remarks(todo: Sequence[PlannedRow]) -> list[str]:
    """What must be said of the robots that were named."""
    from kinlab.model.robot import Robot, remarks

    robots = {task.name: task.robot for task in todo if isinstance(task.robot, Robot)}
    return [f"{name}: {line}" for name, robot in robots.items() for line in remarks(robot)]


@dataclass
class _Found:
    """What a check has found so far.

    Attributes:
        rows: formulas beside the engine.
        judged: formulas that were taken apart.
        unread: what could not be judged.
    """

    rows: list[Row] = field(default_factory=list)
    judged: list[Diagnosis] = field(default_factory=list)
    unread: list[Unread] = field(default_factory=list)

    @property
    def nothing(self) -> bool:
        """Whether nothing at all was judged."""
        return not self.rows and not self.judged


def _formula_files(what: list[str], samples: int, seed: int, found: _Found) -> list[str]:
    """Judges the files of formulas as text; the other arguments are left."""
    if not any(w.lower().endswith(".toml") for w in what):
        return what
    from kinlab.check.unread import Unread
    from kinlab.doctor.file import formula_document

    rest = []
    for path in what:
        try:
            lines = formula_document(path)
        except KinlabError as problem:
            found.unread.append(Unread(path, problem))
            continue
        if lines is None:
            rest.append(path)
            continue
        from kinlab.doctor.report import of_document

        judged, unread = of_document(lines.document, path, samples, seed, lines.problems)
        found.judged += judged
        found.unread += unread
    return rest


def _place(unread: str, what: list[str]) -> int:
    """Which argument something belongs to; behind all, where it belongs to none."""
    mine = (k for k, one in enumerate(what) if unread == one or unread.startswith(f"{one}: "))
    return next(mine, len(what))


def _run(
    todo: Sequence[PlannedRow], samples: int, seed: int, helpers: Helpers | None, found: _Found
) -> None:
    """Runs the tasks; what they say stands in the order of the tasks."""
    from kinlab.check.catalogue import Row
    from kinlab.check.together import run_together
    from kinlab.check.unread import Unread

    def one(task: PlannedRow) -> Row | Diagnosis | Unread:
        tell(len(done), visible(task.label))
        try:
            return _one(task, samples, seed)
        except KinlabError as problem:
            place = f"{task.file}: {task.record.key}" if task.file else task.name
            return Unread(place, problem)

    done: dict[int, Row | Diagnosis | Unread] = {}
    with progress("check", len(todo)) as tell:
        for place, answer in run_together(todo, one, samples, seed, helpers):
            done[place] = answer
            tell(len(done))
    for place in range(len(todo)):
        answer = done[place]
        if isinstance(answer, Row):
            found.rows.append(answer)
        elif isinstance(answer, Unread):
            found.unread.append(answer)
        else:
            found.judged.append(answer)


def _one(task: PlannedRow, samples: int, seed: int) -> Row | Diagnosis:
    if not task.file:
        return task.run(samples, seed)
    from kinlab.doctor.report import of_task

    return of_task(task, samples, seed)


def _print_json(found: _Found) -> None:
    import json

    from kinlab.check.report.summary import as_data

    data = as_data(found.rows, found.judged, found.unread)
    echo(json.dumps(data, indent=1, ensure_ascii=False, allow_nan=False))


def _print_all(found: _Found, each: bool) -> None:
    if found.rows:
        _print_table(found.rows, each)
    for k, one in enumerate(found.judged):
        echo(("\n" if k or found.rows else "") + str(one))


def _print_table(done: Sequence[Row], each: bool) -> None:
    from kinlab.check.report.summary import Group, grouped, size

    console = screen()
    if not console.is_terminal:
        console = screen(width=160)
    groups = [Group(row.formula, (row,)) for row in done] if each else grouped(done)
    table = plain_table(*map(_, _COLUMNS), right=(3, 4))
    for k in (0, 2, 3, 4):
        table.columns[k].no_wrap = True
    for group in groups:
        style = "" if group.ok else "bold red"
        shown = group.ok and group.printed_error is not None
        table.add_row(
            group.formula.key,
            _(group.formula.title),
            group.robots,
            size(group.worst.corrected.max_error),
            size(group.printed_error),
            styled((group.verdict, "yellow" if shown else "")),
            style=style,
        )
    console.print(table)
    _print_failures(console, done)
    _print_closing(console, done, len(groups))


def _print_failures(console: Screen, done: Sequence[Row]) -> None:
    for row in done:
        if row.corrected.agrees:
            continue
        if row.right and row.diagnosis is not None:
            console.print(f"\n{row.diagnosis}", highlight=False, soft_wrap=True)
        else:
            told = row.verdict if row.failure else row.corrected
            console.print(f"\n{row.formula.key}: {told}", style="red")
            if row.diagnosis is not None:
                _print_diagnosis(console, row.diagnosis)


def _print_diagnosis(console: Screen, found: Diagnosis) -> None:
    from kinlab.check.diagnosis import shown_entry
    from kinlab.check.report.summary import size

    def line(text: str) -> None:
        console.print(text, style="bold" if found.known else "", highlight=False, soft_wrap=True)

    line(_("diagnosis: {sentence}").format(sentence=found.sentence))
    if found.known:
        before, after = size(found.error_before), size(found.error_after)
        told = _("relative error before {before}, after {after}")
        line("  " + told.format(before=before, after=after))
        for name, text in found.causes[0].shown.items():
            line("  " + _("correct: {formula}").format(formula=f"{shown_entry(name)} = {text}"))
    for text in found.others:
        line("  " + _("or: {slip}").format(slip=text))


def _print_closing(console: Screen, done: Sequence[Row], formulas: int) -> None:
    from kinlab.check.report.words import several

    wrong = sum(not row.ok for row in done)
    misprints = len({id(row.formula) for row in done if row.printed is not None})
    agree = sum(row.corrected.agrees for row in done)
    told = _("{formulas}, {rows}: {agree} agree to 1e-9")
    text = told.format(
        formulas=several(formulas, "formula"), rows=several(len(done), "row"), agree=agree
    )
    otherwise = sum(row.right for row in done) - agree
    if otherwise:
        text += _(", {count} right but written otherwise").format(count=otherwise)
    if misprints:
        text += _(", {misprints} shown").format(misprints=several(misprints, "misprint"))
    if wrong:
        text += _(", {count} WRONG").format(count=wrong)
    console.print("\n" + text, highlight=False)


def _list_quantities() -> None:
    from kinlab.check.quantities.registry import quantities

    table = plain_table(_("quantity"), _("arguments"), _("about"))
    for one in quantities().values():
        table.add_row(one.name, ", ".join(one.arguments), _(one.about))
    screen().print(table)


COMMANDS = {"check": check}
