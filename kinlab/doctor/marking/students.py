"""One student's files together, and the files beside them that are not read."""

from __future__ import annotations

import difflib
from collections.abc import Iterable, Sequence
from dataclasses import replace
from pathlib import Path

from kinlab.doctor.marking.marks import MISSING, UNREAD, Mark, Outcome
from kinlab.doctor.marking.submission import KINDS, joined
from kinlab.host.language import _

_TOLD = 5


def by_student(marks: Iterable[Mark]) -> list[Mark]:
    """One mark for each student, in the order of their ids.

    Several files of a student are one submission: each question has the answer of the file that
    answers it. Where two do, the one that is later by name counts, if it could be read.

    Args:
        marks: one for each file.
    """
    students: dict[str, list[Mark]] = {}
    for one in sorted(
        _under_own_names([*marks]), key=lambda m: (m.student.casefold(), m.file.casefold(), m.file)
    ):
        students.setdefault(one.student.casefold(), []).append(one)
    return [files[0] if len(files) == 1 else _together(files) for files in students.values()]


def _under_own_names(marks: Sequence[Mark]) -> list[Mark]:
    """The marks, those under a name whose own folder is another under their folder's name.

    Nobody's answers count in place of those in another's folder.
    """
    owned = {one.student.casefold() for one in marks if _folder(one) == one.student.casefold()}
    result = []
    for one in marks:
        folder = _folder(one)
        if folder and folder != one.student.casefold() in owned:
            said = _("the file says {student}, who has a folder: its own folder's name is taken")
            note = joined(one.note, said.format(student=one.student))
            one = replace(one, student=Path(one.file).parts[0], note=note)
        result.append(one)
    return result


def _folder(mark: Mark) -> str:
    """The folder of a submission; empty where all are in one."""
    parts = Path(mark.file).parts
    return parts[0].casefold() if len(parts) > 1 else ""


def _together(files: Sequence[Mark]) -> Mark:
    names = [one.file for one in files]
    count = _("handed in {count} times: {files}")
    told = [count.format(count=len(files), files=_(", ").join(names[:_TOLD]))]
    outcomes, pictures = [], {}
    for k, first in enumerate(files[0].outcomes):
        ranked = sorted(files, key=lambda one: _rank(one, one.outcomes[k]))
        chosen = ranked[-1]
        outcomes.append(chosen.outcomes[k])
        if chosen.pictures and first.question in chosen.pictures:
            pictures[first.question] = chosen.pictures[first.question]
        answers = [one.file for one in files if _rank(one, one.outcomes[k]) >= 2]
        if len(answers) > 1:
            said = _("{question} is answered in {files}; {file} counts")
            fields = {"question": first.question, "files": _(", ").join(answers[:_TOLD])}
            told.append(said.format(**fields, file=chosen.file))
    notes = [one.unread or one.note for one in files]
    asides = dict.fromkeys(one.aside for one in files)
    unread = [one.unread for one in files]
    return Mark(
        _(", ").join(names),
        files[0].student,
        next((one.name for one in files if one.name), ""),
        tuple(outcomes),
        joined(*dict.fromkeys(notes), *told),
        files[0].slug,
        pictures,
        joined(*asides),
        joined(*unread) if all(unread) else "",
    )


def _rank(mark: Mark, outcome: Outcome) -> int:
    """How much there is of an answer: none, none of a file that is not read, unreadable, read."""
    if outcome.verdict == MISSING:
        return 0
    return 1 if mark.unread else 2 + (outcome.verdict != UNREAD)


def not_read(folder: str | Path) -> list[str]:
    """The files of a class's folder that no submission is read from, such as ``a.pdf``.

    Args:
        folder: of the submissions; folders in it are looked into once.
    """
    root = Path(folder)
    found = []
    for path in sorted(root.iterdir(), key=lambda p: p.name):
        if path.name.startswith("."):
            continue
        if path.is_dir() and not path.is_symlink():
            found += [p for p in sorted(path.iterdir(), key=lambda p: p.name) if _is_other(p)]
        elif _is_other(path):
            found.append(path)
    return [str(path.relative_to(root)) for path in found]


def _is_other(path: Path) -> bool:
    hidden = path.name.startswith((".", "~$")) or path.name in ("Thumbs.db", "desktop.ini")
    return not hidden and path.suffix.lower() not in KINDS


def with_not_read(marks: Sequence[Mark], names: Iterable[str]) -> list[Mark]:
    """The marks, with a note of each file that is not read where its name says whose it is.

    Args:
        marks: one for each student.
        names: of the files, as :func:`not_read` has them.
    """
    whose: dict[str, list[str]] = {}
    for name in names:
        path = Path(name)
        owner = path.parts[0] if len(path.parts) > 1 else path.stem
        whose.setdefault(owner.casefold(), []).append(name)
    result = []
    for one in marks:
        files = [Path(file) for file in one.file.split(_(", "))]
        known = {file.parts[0] if len(file.parts) > 1 else file.stem for file in files}
        known |= {one.student, one.name}
        mine = [
            name for key in sorted({k.casefold() for k in known}) for name in whose.get(key, [])
        ]
        if mine:
            said = _("not read: {names}").format(names=_(", ").join(mine[:_TOLD]))
            one = replace(one, note=joined(one.note, said))
        result.append(one)
    return result


def with_strangers(marks: Sequence[Mark], known: Sequence[str]) -> list[Mark]:
    """The marks, with a note of each student whose numbers were handed out to nobody.

    Args:
        marks: one for each student.
        known: the ids of those who were given numbers; empty: nobody is a stranger.
    """
    ids = {who.strip().casefold(): who for who in known}
    result = []
    for one in marks:
        if ids and one.student.strip().casefold() not in ids:
            close = difflib.get_close_matches(one.student.casefold(), ids, n=3, cutoff=0.6)
            said = _("{student} is in no line of the ids: its numbers were handed out to nobody")
            if close:
                said = _(
                    "{student} is in no line of the ids: its numbers were handed out to nobody; "
                    "did you mean {names}?"
                )
            names = _(", ").join(ids[name] for name in close)
            told = said.format(student=one.student, names=names)
            one = replace(one, note=joined(one.note, told), stranger=told)
        result.append(one)
    return result
