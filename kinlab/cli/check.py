"""The command check: hand formulas beside the engine."""

from __future__ import annotations

from pathlib import Path
from typing import TYPE_CHECKING, Annotated, Any, Literal

import typer

from kinlab.cli.robots import TOOL
from kinlab.cli.screen import Screen, echo, screen, styled, visible

if TYPE_CHECKING:
    from collections.abc import Sequence

    from kinlab.check.catalogue import Row
    from kinlab.check.diagnosis import Diagnosis
    from kinlab.check.targets import Task

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

Document = tuple[str, dict[str, Any]]
"""A path and the TOML document that was read from it."""


def register(app: typer.Typer) -> None:
    """Adds the command of this file."""
    app.command("check")(check)


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
) -> None:
    """Put hand formulas beside the engine, or a DH table beside another description of the arm.

    A .py file is run, like any program, in a process of its own: only check files you trust.
    A formula of yours that differs is taken apart: what is wrong, and how far off it is before
    and after the repair. With --against the same is done to a table, cell by cell. Exit code 0 if
    every correct form agrees (and every misprint shows), 1 if not, 2 for bad input.
    """
    if against is not None:
        from kinlab.cli.against import check_against

        check_against(what or [], against, tool, report or [], json, seed)
        return
    from kinlab.check.catalogue import Row
    from kinlab.check.report.write import check_report_path, write_report
    from kinlab.check.targets import tasks

    if quantities:
        _list_quantities()
        return
    for file in report or ():
        check_report_path(file)
    texts, rest = _formula_files(what or [])
    todo = tasks(rest, tool) if rest or not texts else []
    judged = _examine(texts, samples, seed)
    done = []
    for one in _run(todo, samples, seed):
        if isinstance(one, Row):
            done.append(one)
        else:
            judged.append(one)
    if json:
        _print_json(done, judged)
    else:
        _print_all(done, judged, rows)
    for file in report or ():
        write_report(file, done, judged)
        echo(f"wrote {file}", err=json)
    if not all(row.ok for row in done) or not all(one.agrees for one in judged):
        raise typer.Exit(1)


def _formula_files(what: list[str]) -> tuple[list[Document], list[str]]:
    """Files of formulas as text with what they hold, and the other arguments."""
    if not any(w.lower().endswith(".toml") for w in what):
        return [], what
    from kinlab.doctor.file import formula_document

    texts: list[Document] = []
    rest = []
    for path in what:
        document = formula_document(path)
        if document is None:
            rest.append(path)
        else:
            texts.append((path, document))
    return texts, rest


def _examine(texts: list[Document], samples: int, seed: int) -> list[Diagnosis]:
    if not texts:
        return []
    from kinlab.doctor.report import of_file
    from kinlab.formulas.text import formula_file

    files = [formula_file(document, path) for path, document in texts]
    return [found for file in files for found in of_file(file, samples, seed)]


def _run(todo: Sequence[Task], samples: int, seed: int) -> list[Row | Diagnosis]:
    from rich.progress import BarColumn, MofNCompleteColumn, Progress, TextColumn

    columns = (BarColumn(), MofNCompleteColumn(), TextColumn("{task.description}", markup=False))
    done: list[Row | Diagnosis] = []
    with Progress(*columns, console=screen(stderr=True), transient=True) as progress:
        bar = progress.add_task("", total=len(todo))
        for task in todo:
            progress.update(bar, description=visible(task.label))
            done.append(_one(task, samples, seed))
            progress.advance(bar)
    return done


def _one(task: Task, samples: int, seed: int) -> Row | Diagnosis:
    if not task.file:
        return task.run(samples, seed)
    from kinlab.doctor.report import of_task

    return of_task(task, samples, seed)


def _print_json(done: Sequence[Row], judged: Sequence[Diagnosis]) -> None:
    import json

    from kinlab.check.report.summary import as_data

    data = as_data(done, judged)
    echo(json.dumps(data, indent=1, ensure_ascii=False, allow_nan=False))


def _print_all(done: Sequence[Row], judged: Sequence[Diagnosis], each: bool) -> None:
    if done:
        _print_table(done, each)
    for k, found in enumerate(judged):
        echo(("\n" if k or done else "") + str(found))


def _print_table(done: Sequence[Row], each: bool) -> None:
    from rich.table import Table

    from kinlab.check.report.summary import Group, grouped, size

    console = screen()
    if not console.is_terminal:
        console = screen(width=160)
    groups = [Group(row.formula, (row,)) for row in done] if each else grouped(done)
    table = Table(box=None, header_style="bold", pad_edge=False)
    for name in ("formula", "what", "robot", "error", "printed", "verdict"):
        justify: Literal["left", "right"] = "right" if name in ("error", "printed") else "left"
        table.add_column(name, justify=justify, no_wrap=name not in ("what", "verdict"))
    for group in groups:
        style = "" if group.ok else "bold red"
        shown = group.ok and group.printed_error is not None
        table.add_row(
            group.formula.key,
            group.formula.title,
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
        if not row.corrected.agrees:
            told = row.verdict if row.failure else row.corrected
            console.print(f"\n{row.formula.key}: {told}", style="red")
            if row.diagnosis is not None:
                _print_diagnosis(console, row.diagnosis)


def _print_diagnosis(console: Screen, found: Diagnosis) -> None:
    from kinlab.check.report.summary import size

    def line(text: str) -> None:
        console.print(text, style="bold" if found.known else "", highlight=False, soft_wrap=True)

    line(f"diagnosis: {found.sentence}")
    if found.known:
        before, after = size(found.error_before), size(found.error_after)
        line(f"  relative error before {before}, after {after}")
        for name, text in found.causes[0].corrected.items():
            line(f"  correct: {name} = {text}")
    for text in found.others:
        line(f"  or: {text}")


def _print_closing(console: Screen, done: Sequence[Row], formulas: int) -> None:
    from kinlab.check.report.words import several

    wrong = sum(not row.ok for row in done)
    misprints = len({id(row.formula) for row in done if row.printed is not None})
    agree = sum(row.corrected.agrees for row in done)
    text = f"\n{several(formulas, 'formula')}, {several(len(done), 'row')}: {agree} agree to 1e-9"
    if misprints:
        text += f", {several(misprints, 'misprint')} shown"
    console.print(text + (f", {wrong} WRONG" if wrong else ""), highlight=False)


def _list_quantities() -> None:
    from rich.table import Table

    from kinlab.check.quantities.registry import quantities

    table = Table(box=None, header_style="bold", pad_edge=False)
    for name in ("quantity", "arguments", "about"):
        table.add_column(name)
    for one in quantities().values():
        table.add_row(one.name, ", ".join(one.arguments), one.about)
    screen().print(table)
