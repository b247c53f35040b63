"""The commands of ``kinlab``, from what each says of itself with ``--help``."""

from __future__ import annotations

from collections.abc import Iterator
from pathlib import Path
from typing import Any

import typer.main
from made_pages import write_if_changed

from kinlab.cli import app


def write(docs: Path) -> None:
    """Writes ``reference/generated/commands.md``."""
    write_if_changed(docs / "reference" / "generated" / "commands.md", page())


def page() -> str:
    """Every command with its arguments and options."""
    lines = ["# The command line", ""]
    lines += [
        "Exit code 0: all is well; 1: something differs or was not found; 2: the input cannot"
    ]
    lines += ["be used. Every command takes `--help`.", ""]
    for name, command in commands(typer.main.get_command(app)):
        lines += [f"## `kinlab {name}`", "", plain(command.help or ""), ""]
        rows = [row(one) for one in command.params if one.name != "help"]
        if rows:
            lines += ["| | |", "|---|---|", *rows, ""]
    return "\n".join(lines) + "\n"


def commands(group: Any, before: str = "") -> Iterator[tuple[str, Any]]:
    """The commands of a group by their whole names, those of its groups among them."""
    for name, command in group.commands.items():
        if hasattr(command, "commands"):
            yield from commands(command, f"{before}{name} ")
        else:
            yield f"{before}{name}", command


def row(one: Any) -> str:
    """An argument or option, what it is, and what it is where it is left out."""
    if one.param_type_name == "argument":
        name = f"`{one.name.upper()}`" + (" …" if one.nargs == -1 else "")
    else:
        name = ", ".join(f"`{option}`" for option in (*one.opts, *one.secondary_opts))
    words = plain(one.help or "")
    default = one.default
    if isinstance(default, (str, int, float)) and not isinstance(default, bool) and default != "":
        words += f" Left out: `{default}`."
    return f"| {name} | {words} |"


def plain(text: str) -> str:
    """Help as Markdown that shows it as it is; what stands in backquotes stays code."""
    parts = text.split("`")
    for k in range(0, len(parts), 2):
        for sign in "\\*_<>|$[]":
            parts[k] = parts[k].replace(sign, f"\\{sign}")
    return "`".join(parts)
