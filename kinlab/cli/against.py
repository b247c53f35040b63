"""``kinlab check mine.toml --against other``: which cell of a DH table is wrong?"""

from __future__ import annotations

from collections.abc import Sequence
from pathlib import Path

import typer

from kinlab.cli.screen import wrote


def check_against(
    tables: Sequence[str],
    against: str,
    tool: str | None,
    report: Sequence[Path],
    json: bool,
    seed: int,
) -> None:
    """Judges tables against another description of their arm; exit code 1 where one differs.

    Raises:
        KinlabError: what cannot be compared, with its remedy.
    """
    from kinlab.check.report.write import check_report_path
    from kinlab.doctor.tables.diagnosis import diagnose_table
    from kinlab.doctor.tables.report import write_table_report
    from kinlab.errors import OptionError

    if not tables:
        raise OptionError("check --against: name the table to judge, a .toml or .csv file")
    for file in report:
        check_report_path(file)
    found = [diagnose_table(one, against, tool=tool, seed=seed) for one in tables]
    if json:
        _print_json(
            [{"file": file, **one.as_dict()} for file, one in zip(tables, found, strict=True)]
        )
    else:
        for k, one in enumerate(found):
            typer.echo(("\n" if k else "") + str(one))
    for file in report:
        write_table_report(file, found)
        wrote(file, err=json)
    if not all(one.agrees for one in found):
        raise typer.Exit(1)


def _print_json(found: list[dict[str, object]]) -> None:
    import json

    data = {"ok": all(one["agrees"] for one in found), "tables": found}
    typer.echo(json.dumps(data, indent=1, ensure_ascii=False, allow_nan=False))
