"""Every sentence of kinlab that has to be translated, and the catalogues that hold translations.

``python tests/sentences.py`` brings the catalogues up to date: sentences that are new are added with
an empty translation, those that nobody says any more are taken out. The tests of the languages
fail where a translation is empty.
"""

from __future__ import annotations

import ast
import json
import re
import string
from dataclasses import dataclass, field
from pathlib import Path

from kinlab.host import language

PACKAGE = Path(language.__file__).resolve().parents[1]
CATALOGUES = Path(language.__file__).parent / "locale"

MARKS = {"_": 1, "N_": 1, "ngettext": 2}
"""What marks a sentence, and how many of its arguments are sentences."""


@dataclass
class Sentence:
    """A marked sentence.

    Attributes:
        text: the English source.
        more: of one with a number, the source for several.
        rooms: the rooms that say it.
        places: where, for a message.
    """

    text: str
    more: str = ""
    rooms: list[str] = field(default_factory=list)
    places: list[str] = field(default_factory=list)


class NotPlain(AssertionError):
    """What is marked is not one plain piece of text, so that no catalogue can hold it."""


def room_of(file: Path) -> str:
    inside = file.relative_to(PACKAGE)
    return inside.parts[0] if len(inside.parts) > 1 else "kinlab"


def marked_in_python(tree: ast.AST, place: str) -> list[tuple[str, str, int]]:
    """The marked sentences of a module: (text, more, line)."""
    found = []
    for node in ast.walk(tree):
        if not isinstance(node, ast.Call) or not isinstance(node.func, ast.Name):
            continue
        count = MARKS.get(node.func.id)
        if count is None:
            continue
        texts = []
        for one in node.args[:count]:
            if isinstance(one, ast.Constant) and isinstance(one.value, str):
                texts.append(one.value)
            elif node.func.id != "_" or not _is_looked_up(one):
                raise NotPlain(f"{place}:{node.lineno}: {ast.unparse(node)} marks no plain text")
        if texts:
            found.append((texts[0], texts[1] if count == 2 else "", node.lineno))
    return found


def _is_looked_up(node: ast.expr) -> bool:
    """Whether an expression is a text that is marked elsewhere, and not one that is put together."""
    if isinstance(node, ast.Call):
        return getattr(node.func, "attr", "") not in ("format", "join")
    return isinstance(node, ast.Name | ast.Attribute | ast.Subscript | ast.IfExp)


_TEXT = r'"((?:[^"\\]|\\.)*)"'
_IN_OTHERS = re.compile(rf"(?<![\w.])(?:_\(\s*{_TEXT}|ngettext\(\s*{_TEXT}\s*,\s*{_TEXT})")


def marked_in_text(text: str) -> list[tuple[str, str, int]]:
    """The marked sentences of a template or a script: double quotes only."""
    found = []
    for match in _IN_OTHERS.finditer(text):
        one, first, more = (json.loads(f'"{x}"') if x is not None else "" for x in match.groups())
        found.append((one or first, more, text.count("\n", 0, match.start()) + 1))
    return found


def records() -> list[tuple[str, str, str]]:
    """What the catalogue of formulas says in words: (text, room, place)."""
    from kinlab.check.catalogue import catalogue
    from kinlab.check.quantities.registry import quantities
    from kinlab.check.table_check import DYNAMIC, KINEMATIC

    found = []
    for record in (*catalogue(), *KINEMATIC, *DYNAMIC):
        room = "notes" if record.note else "check"
        printed = record.printed.misprint if record.printed else ""
        said = (record.title, record.source, record.remark, printed)
        found += [(text, room, record.key) for text in said if text]
    found += [(one.about, "check", one.name) for one in quantities().values()]
    return found


def help_texts() -> list[tuple[str, str]]:
    """What ``--help`` says: (text, command)."""
    import typer

    from kinlab.cli import all_commands, app

    group = typer.main.get_command(app)
    found = []
    for one in (group, *all_commands(group)):
        texts = [one.help, *(getattr(parameter, "help", None) for parameter in one.params)]
        found += [(text, one.name) for text in texts if text]
    return found


def sentences() -> dict[str, Sentence]:
    """Every sentence of the package, by its source."""
    found: dict[str, Sentence] = {}

    def add(text: str, more: str, room: str, place: str) -> None:
        one = found.setdefault(text, Sentence(text, more))
        assert one.more == more or not (one.more and more), f"{place}: {text!r} has two plurals"
        one.more = one.more or more
        if room not in one.rooms:
            one.rooms.append(room)
        one.places.append(place)

    for file in sorted(PACKAGE.rglob("*")):
        if file.suffix not in (".py", ".js", ".j2") or file.name == "language.py":
            continue
        text = file.read_text(encoding="utf-8")
        place = file.relative_to(PACKAGE).as_posix()
        if file.suffix == ".py":
            marked = marked_in_python(ast.parse(text), place)
        else:
            marked = marked_in_text(text)
        for one, more, line in marked:
            add(one, more, room_of(file), f"{place}:{line}")
    for one, room, place in records():
        add(one, "", room, place)
    for one, command in help_texts():
        add(one, "", "cli", f"kinlab {command} --help")
    return found


def fields(text: str) -> set[str]:
    """The named fields of a template; of plain text, none."""
    try:
        return {name for _, name, _, _ in string.Formatter().parse(text) if name is not None}
    except ValueError:  # a brace that is one
        return set()


# -------- The catalogues


def catalogue_files(folder: str) -> list[Path]:
    return sorted((CATALOGUES / folder / "LC_MESSAGES").glob("*.po"))


def entries(file: Path) -> list[dict[str, str]]:
    return [e for e in language.read_catalogue(file.read_text(encoding="utf-8")) if e["msgid"]]


HEAD = """\
msgid ""
msgstr ""
"Language: {folder}\\n"
"MIME-Version: 1.0\\n"
"Content-Type: text/plain; charset=UTF-8\\n"
"Content-Transfer-Encoding: 8bit\\n"
"Plural-Forms: nplurals=1; plural=0;\\n"
"""


def written(entry: dict[str, str]) -> str:
    def quoted(text: str) -> str:
        lines = text.splitlines(keepends=True)
        if len(lines) < 2:
            return json.dumps(text, ensure_ascii=False)
        return "\n".join(['""', *(json.dumps(line, ensure_ascii=False) for line in lines)])

    lines = [f"msgid {quoted(entry['msgid'])}"]
    if entry.get("msgid_plural"):
        lines.append(f"msgid_plural {quoted(entry['msgid_plural'])}")
    form = "msgstr[0]" if entry.get("msgid_plural") else "msgstr"
    return "\n".join([*lines, f"{form} {quoted(entry['msgstr'])}"]) + "\n"


def update(folder: str) -> None:
    """Writes a language's catalogues anew, in the order of the code, one file for each room."""
    known = {
        e["msgid"]: (file.stem, e["msgstr"])
        for file in catalogue_files(folder)
        for e in entries(file)
    }
    rooms: dict[str, list[dict[str, str]]] = {}
    for one in sentences().values():
        room, translated = known.get(one.text, (one.rooms[0], ""))
        if room not in one.rooms:
            room = one.rooms[0]
        entry = {"msgid": one.text, "msgid_plural": one.more, "msgstr": translated}
        rooms.setdefault(room, []).append(entry)
    place = CATALOGUES / folder / "LC_MESSAGES"
    place.mkdir(parents=True, exist_ok=True)
    for file in place.glob("*.po"):
        if file.stem not in rooms:
            file.unlink()
    for room, listed in rooms.items():
        text = "\n".join([HEAD.format(folder=folder), *map(written, listed)])
        (place / f"{room}.po").write_text(text, encoding="utf-8", newline="\n")
        missing = sum(not entry["msgstr"] for entry in listed)
        print(f"{folder}/{room}.po: {len(listed)} sentences, {missing} without translation")


# -------- What should be marked and is not

_MARKUP = re.compile(r"<[^>]*>?")
WORDS = re.compile(r"[A-Za-z]{2,}[,:;.]? +[A-Za-z]{2,}")
"""Two words beside each other: what makes a piece of text a sentence."""


def unmarked(tree: ast.AST) -> list[tuple[int, str]]:
    """The pieces of text with words in them that are neither marked nor documentation.

    What an error says is left out (errors are English), and so is the help of an option (the
    command line's own help is translated by its text).
    """
    free: set[int] = set()
    for node in ast.walk(tree):
        if isinstance(node, ast.Raise):
            free.update(map(id, ast.walk(node)))
        elif isinstance(node, ast.Expr) and isinstance(node.value, ast.Constant):
            free.add(id(node.value))
        elif isinstance(node, ast.Call):
            name = getattr(node.func, "id", "")
            for one in node.args[: MARKS.get(name, 0)]:
                free.add(id(one))
            for keyword in node.keywords:
                if keyword.arg == "help":
                    free.update(map(id, ast.walk(keyword.value)))
            if name.endswith("Error"):
                free.update(map(id, ast.walk(node)))
    return [
        (node.lineno, node.value)
        for node in ast.walk(tree)
        if isinstance(node, ast.Constant)
        and isinstance(node.value, str)
        and id(node) not in free
        and WORDS.search(_MARKUP.sub("", node.value))
    ]


if __name__ == "__main__":
    for name in filter(None, language.LANGUAGES.values()):
        update(name)
