"""The command check: hand formulas beside the engine."""

from __future__ import annotations

from pathlib import Path
from typing import TYPE_CHECKING, Annotated, Literal

import typer

from kinlab.errors import OptionError

if TYPE_CHECKING:
    from collections.abc import Sequence

    from rich.console import Console

    from kinlab.check.catalogue import Row
    from kinlab.check.targets import Task

WHAT = Annotated[
    list[str] | None,
    typer.Argument(
        help="Robots, .toml/.csv/.urdf files, .py files with marked functions, notes (001) or "
        "formula ids (002.C). Nothing: the whole catalogue on the shipped robots.",
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
) -> None:
    """Put hand formulas beside the engine over seeded random states.

    Exit code 0 if every correct form agrees (and every misprint shows), 1 if not, 2 for bad input.
    """
    from kinlab.check.report import check_report_path, write_report
    from kinlab.check.targets import tasks

    if quantities:
        _list_quantities()
        return
    for file in report or ():
        check_report_path(file)
    texts, rest = _formula_files(what or [])
    if texts and (rest or report):
        raise OptionError("check: give files of formulas alone, without robots, notes or --report")
    if texts:
        _examine(texts, json, max(samples, 10), seed)
        return
    done = _run(tasks(what or ()), samples, seed)
    if json:
        _print_json(done)
    else:
        _print_table(done, rows)
    for file in report or ():
        write_report(file, done)
        typer.echo(f"wrote {file}", err=json)
    if not all(row.ok for row in done):
        raise typer.Exit(1)


def _formula_files(what: list[str]) -> tuple[list[str], list[str]]:
    from kinlab.doctor.file import is_formula_file

    texts = [w for w in what if w.endswith(".toml") and is_formula_file(w)]
    return texts, [w for w in what if w not in texts]


def _examine(files: list[str], as_json: bool, samples: int, seed: int) -> None:
    """Formulas as text: what is wrong in each."""
    import json

    from kinlab.doctor.file import examine_file

    found = [d for file in files for d in examine_file(file, samples, seed)]
    if as_json:
        rows = [d.as_dict() for d in found]
        typer.echo(json.dumps(rows, indent=1, ensure_ascii=False, allow_nan=False))
    else:
        for diagnosis in found:
            typer.echo(str(diagnosis))
    if not all(d.agrees for d in found):
        raise typer.Exit(1)


def _run(todo: Sequence[Task], samples: int, seed: int) -> list[Row]:
    from rich.console import Console
    from rich.progress import BarColumn, MofNCompleteColumn, Progress, TextColumn

    columns = (BarColumn(), MofNCompleteColumn(), TextColumn("{task.description}"))
    done = []
    with Progress(*columns, console=Console(stderr=True), transient=True) as progress:
        bar = progress.add_task("", total=len(todo))
        for task in todo:
            progress.update(bar, description=task.label)
            done.append(task.run(samples, seed))
            progress.advance(bar)
    return done


def _print_json(done: Sequence[Row]) -> None:
    import json

    from kinlab.check.summary import as_data

    typer.echo(json.dumps(as_data(done), indent=1, ensure_ascii=False, allow_nan=False))


def _print_table(done: Sequence[Row], each: bool) -> None:
    from rich.console import Console
    from rich.markup import escape
    from rich.table import Table

    from kinlab.check.summary import Group, grouped, size

    console = Console()
    if not console.is_terminal:
        console = Console(width=160)
    groups = [Group(row.formula, (row,)) for row in done] if each else grouped(done)
    table = Table(box=None, header_style="bold", pad_edge=False)
    for name in ("formula", "what", "robot", "error", "printed", "verdict"):
        justify: Literal["left", "right"] = "right" if name in ("error", "printed") else "left"
        table.add_column(name, justify=justify, no_wrap=name not in ("what", "verdict"))
    for group in groups:
        style = "" if group.ok else "bold red"
        verdict = group.verdict
        if group.ok and group.printed_error is not None:
            verdict = f"[yellow]{escape(verdict)}[/yellow]"
        else:
            verdict = escape(verdict)
        table.add_row(
            escape(group.formula.key), escape(group.formula.title), escape(group.robots),
            size(group.worst.corrected.max_error), size(group.printed_error), verdict,
            style=style,
        )  # fmt: skip
    console.print(table)
    _print_failures(console, done)
    _print_closing(console, done, len(groups))


def _print_failures(console: Console, done: Sequence[Row]) -> None:
    for row in done:
        if not row.corrected.agrees:
            console.print(f"\n{row.formula.key}: {row.corrected}", style="red", markup=False)


def _print_closing(console: Console, done: Sequence[Row], formulas: int) -> None:
    from kinlab.check.headings import several

    wrong = sum(not row.ok for row in done)
    misprints = len({id(row.formula) for row in done if row.printed is not None})
    agree = sum(row.corrected.agrees for row in done)
    text = f"\n{several(formulas, 'formula')}, {several(len(done), 'row')}: {agree} agree to 1e-9"
    if misprints:
        text += f", {several(misprints, 'misprint')} shown"
    console.print(text + (f", {wrong} WRONG" if wrong else ""), highlight=False)


def _list_quantities() -> None:
    from rich.console import Console
    from rich.markup import escape
    from rich.table import Table

    from kinlab.check.quantities import quantities

    table = Table(box=None, header_style="bold", pad_edge=False)
    for name in ("quantity", "arguments", "about"):
        table.add_column(name)
    for one in quantities().values():
        table.add_row(one.name, ", ".join(one.arguments), escape(one.about))
    Console().print(table)
