"""The command mark: a class's formulas against a sheet of questions."""

from __future__ import annotations

from pathlib import Path
from typing import Annotated

import typer

from kinlab.cli.screen import echo, visible, wrote
from kinlab.errors import OptionError
from kinlab.host.language import _, ngettext
from kinlab.host.progress import progress

SHEET = Annotated[Path, typer.Argument(help="The sheet: a TOML file of questions.")]
SUBMISSIONS = Annotated[
    Path | None, typer.Argument(help="A folder of submissions: .toml, .tex, .txt, .md, .py.")
]
OUTPUT = Annotated[Path, typer.Option("--output", "-o", help="The folder for marks and pages.")]
FEEDBACK = Annotated[
    str | None, typer.Option(help="verdict, place, cause or answer; the sheet's own without it.")
]
HANDOUT = Annotated[
    Path | None,
    typer.Option(help="Write each student's sheet instead: a file of ids, one on each line."),
]
PYTHON = Annotated[
    bool, typer.Option("--run-python", help="Run .py submissions, each with limits of its own.")
]
_MOST = 20
"""Files that could not be read, of which the command speaks; the class's page has all."""
WORKERS = Annotated[int | None, typer.Option(help="Processes; as many as processors without it.")]


def mark(
    sheet: SHEET,
    submissions: SUBMISSIONS = None,
    output: OUTPUT = Path("marks"),
    feedback: FEEDBACK = None,
    handout: HANDOUT = None,
    run_python: PYTHON = False,
    workers: WORKERS = None,
) -> None:
    """Mark a class: every answer beside the engine, with points, pages and results.

    A run that was stopped goes on where it was; pages of submissions that are no longer there are
    removed. Below `answer` nothing that is written holds a right formula. Exit code 1 if kinlab
    itself failed on an answer.
    """
    from kinlab.doctor.marking.handout import students_of, write_handouts
    from kinlab.doctor.marking.run import mark as mark_all
    from kinlab.doctor.marking.sheet import read_sheet

    read = read_sheet(sheet)
    if handout is not None:
        count = write_handouts(read, students_of(handout), output)
        told = ngettext(
            "wrote {count} sheet into {folder}", "wrote {count} sheets into {folder}", count
        )
        echo(told.format(count=count, folder=output))
        return
    if submissions is None:
        raise OptionError("mark: submissions are missing; name their folder, or use --handout")
    with progress("mark") as tell:

        def show(done: int, total: int, name: str) -> None:
            so_far = _("{done} of {total}").format(done=done, total=total)
            tell(done, f"{so_far}  {visible(name)}")

        marks = mark_all(
            read,
            submissions,
            output,
            feedback=feedback,
            run_python=run_python,
            workers=workers,
            progress=show,
        )
    echo(str(marks))
    for line in marks.said()[:_MOST]:
        echo(f"  {visible(line)}")
    for (question, kind), count in marks.slips().most_common(10):
        said = _("  {question}: {kind}, {count} of {all}")
        echo(said.format(question=question, kind=_(kind), count=count, all=len(marks)))
    wrote(output)
    if any(one.failed for one in marks.marks):
        raise typer.Exit(1)


COMMANDS = {"mark": mark}
