"""The four notes, formula by formula, from the catalogue: printed, as it should be, verdicts.

Every formula is run beside the engine when the pages are made. One page a note and language; a
language is made where kinlab has a catalogue of it.
"""

from __future__ import annotations

import hashlib
import re
from collections.abc import Iterable, Iterator, Sequence
from html import escape
from itertools import groupby
from pathlib import Path

from made_pages import write_if_changed
from words import Language, languages

import kinlab
from kinlab.check.catalogue import catalogue, plan, run
from kinlab.check.report.summary import Group, grouped, size
from kinlab.formulas.typeset import mathml

LONG = 70
"""Characters of LaTeX above which a form gets the whole width of the page."""

_HOME = Path(kinlab.__file__).parent

Position = tuple[int, int]
"""First and last line of a stretch of a note."""


def write(docs: Path) -> None:
    """Writes ``notes/generated`` of each language, unless nothing changed since."""
    mark = docs / "notes" / "generated" / ".made"
    now = fingerprint()
    if mark.exists() and mark.read_text() == now:
        return
    groups = grouped(run(plan(catalogue())))
    for language in languages():
        folder = docs / language.folder / "notes" / "generated"
        with language:
            write_if_changed(folder / "summary.md", summary(groups, language))
            for number in sorted({group.formula.note for group in groups}):
                own = [group for group in groups if group.formula.note == number]
                write_if_changed(folder / f"{number}.md", page(number, own, language))
    write_if_changed(mark, now)


def fingerprint() -> str:
    """Changes with any file of kinlab, of its robots and of this folder."""
    found = hashlib.sha256()
    places = (_HOME, _HOME.parent / "robots", Path(__file__).parent)
    for path in sorted(path for place in places for path in place.rglob("*")):
        if path.is_file() and path.suffix in (".py", ".tsv", ".toml", ".po"):
            found.update(path.name.encode() + path.read_bytes())
    return found.hexdigest()


# -------- Where a formula stands


def stretches(number: str) -> Iterator[tuple[Position, tuple[str, ...], str]]:
    """The stretches of a note: lines, the ids of the formulas in them, and what they say."""
    for line in (_HOME / "notes" / "lines.tsv").read_text(encoding="utf-8").splitlines():
        if line.startswith(f"{number}\t"):
            _, lines, ids, words = line.split("\t")
            first, _, last = lines.partition("-")
            yield (int(first), int(last or first)), tuple(ids.split()), words


def positions(number: str) -> dict[str, list[Position]]:
    """Where each id stands."""
    found: dict[str, list[Position]] = {}
    for lines, ids, _ in stretches(number):
        for id in ids:
            found.setdefault(id, []).append(lines)
    return found


def spelled(lines: Iterable[Position]) -> str:
    """``62–65, 70``; stretches that follow one another are one."""
    joined: list[Position] = []
    for first, last in lines:
        if joined and first <= joined[-1][1] + 1:
            joined[-1] = (joined[-1][0], last)
        else:
            joined.append((first, last))
    return ", ".join(f"{a}–{b}" if a != b else f"{a}" for a, b in joined)


# -------- Pages


def summary(groups: Sequence[Group], say: Language) -> str:
    """What was found, note by note, as a table."""
    rows = ["| " + " | ".join(map(say, ("note", "formulas", "agree as printed", "misprints",
            "largest error of a correct form"))) + " |", "|---|---:|---:|---:|---:|"]  # fmt: skip
    for number, several in groupby(groups, lambda group: group.formula.note):
        own = list(several)
        wrong = sum(group.printed_error is not None for group in own)
        worst = max(group.worst.corrected.max_error for group in own)
        cells = (f"[{number}](generated/{number}.md)", len(own), len(own) - wrong, wrong)
        rows.append("| " + " | ".join(map(str, (*cells, size(worst)))) + " |")
    total = sum(group.printed_error is not None for group in groups)
    states = sum(row.corrected.samples for group in groups for row in group.rows)
    words = say("{formulas} formulas, {misprints} misprints, {states} random states.")
    rows += ["", words.format(formulas=len(groups), misprints=total, states=f"{states:,}")]
    return "\n".join(rows) + "\n"


def page(number: str, groups: Sequence[Group], say: Language) -> str:
    """The page of a note."""
    where = positions(number)
    first = {id: lines[0] for id, lines in where.items()}
    ordered = sorted(groups, key=lambda group: first.get(group.formula.id, (10**6, 0)))
    lines = [f"# {say(TITLES[number])}", "", say(HEAD), ""]
    wrong = [group for group in ordered if group.printed_error is not None]
    if wrong:
        lines += [f"## {say('Misprints of this note')}", ""]
        for group in wrong:
            label = f"`{group.formula.key}`"
            what = ended(say(group.formula.printed.misprint)) if group.formula.printed else ""
            lines.append(f"- [{label}](#{anchor(group)}): {what}")
        lines.append("")
    for source, several in groupby(ordered, lambda group: group.formula.source):
        section = say(source.removeprefix(f"note {number}, "))
        lines += [f"## {section[:1].upper()}{section[1:]}", ""]
        for group in several:
            lines += card(group, where.get(group.formula.id, []), say)
    lines += line_by_line(number, {group.formula.id for group in groups}, say)
    return "\n".join(lines) + "\n"


def card(group: Group, where: list[Position], say: Language) -> list[str]:
    """One formula: place, forms, verdict, how far each form is from the engine, robot by robot."""
    record = group.formula
    lines = [f"({anchor(group)})=", f"### `{record.key}` {say(record.title)}", ""]
    place = [say("lines {lines} of the note").format(lines=spelled(where))] if where else []
    place += [say("engine: {quantity}").format(quantity=f"`{record.quantity}`")]
    lines += ["{.place}", " · ".join(place), ""]
    forms = []
    if record.printed is not None and group.printed_error is not None:
        forms.append(form("printed", say("printed"), record.printed.latex))
    if record.latex:
        name = ("corrected", say("should be")) if forms else ("only", "")
        forms.append(form(*name, record.latex))
    lines += ["```{raw} html", f'<div class="forms">{"".join(forms)}</div>', "```", ""]
    lines += [verdict(group, say), ""]
    if record.remark:
        lines += [sentence(say(record.remark)), ""]
    if len(group.rows) > 1:
        lines += robots(group, say)
    return lines


def verdict(group: Group, say: Language) -> str:
    """What was found, with the largest errors."""
    states = sum(row.corrected.samples for row in group.rows)
    figures = say("Largest relative error {error} over {states} states").format(
        error=size(group.worst.corrected.max_error), states=f"{states:,}"
    )
    if len(group.rows) > 1:
        figures += say(" on {count} robots").format(count=len(group.rows))
    if not group.ok:
        return f"{{.fails}}\n**{sentence(group.verdict)}** {figures}."
    if group.printed_error is None or group.formula.printed is None:
        return f"{{.agrees}}\n**{say('Agrees.')}** {figures}."
    what = ended(say(group.formula.printed.misprint))
    off = say("the printed form is off by {error} or more").format(error=size(group.printed_error))
    return f"{{.misprint}}\n**{say('Misprint')}: {what}** {figures}; {off}."


def robots(group: Group, say: Language) -> list[str]:
    """A table of the robots, folded."""
    both = group.printed_error is not None
    heads = [say("robot"), say("error")] + ([say("printed")] if both else [])
    lines = [f":::{{dropdown}} {say('robot by robot')}", "| " + " | ".join(heads) + " |"]
    lines.append("|---|" + "---:|" * (len(heads) - 1))
    for row in group.rows:
        printed = f" {size(row.printed.max_error) if row.printed else ''} |" if both else ""
        lines.append(f"| {row.robot} | {size(row.corrected.max_error)} |{printed}")
    return [*lines, ":::", ""]


def form(kind: str, name: str, latex: str) -> str:
    """A typeset form with its caption; the marked pieces keep their colours."""
    typeset = mathml(latex)
    if typeset.startswith("<code>"):
        raise ValueError(f"LaTeX of the catalogue that cannot be typeset: {latex}")
    caption = f"<figcaption>{escape(name)}</figcaption>" if name else ""
    long = " long" if len(latex) > LONG else ""
    return f'<figure class="form {kind}{long}" tabindex="0">{caption}{typeset}</figure>'


def line_by_line(number: str, known: set[str], say: Language) -> list[str]:
    """What each stretch of the note says and which formulas hold it; in English."""
    if say.folder != ".":
        return []
    lines = ["## Line by line", "", "What each stretch of the note says, and the formulas above "]
    lines[-1] += "that hold it."
    lines += ["", "| lines | what they say | formulas |", "|---|---|---|"]
    for where, ids, words in stretches(number):
        here = ", ".join(f"`{id}`" for id in ids if id in known)
        lines.append(f"| {spelled([where])} | {literal(words)} | {here} |")
    return [*lines, ""]


def anchor(group: Group) -> str:
    """The label of a formula on its page."""
    plain = "".join(c if c.isalnum() else "-" for c in group.formula.key)
    return f"formula-{plain}"


def literal(text: str) -> str:
    """Text that Markdown must not read."""
    return "".join(f"\\{c}" if c in "\\`*_{}[]<>|$#^~" else c for c in text)


def ended(text: str) -> str:
    """A line with its full stop, safe in Markdown."""
    stop = "" if text.endswith((".", "。")) else "。" if _CJK.search(text) else "."
    return literal(text) + stop


def sentence(text: str) -> str:
    """A line as a sentence, safe in Markdown; a capital in front of words, not of formulas."""
    words = re.match(r"[a-z]{2,}[ ,]", text)
    return ended(text[0].upper() + text[1:] if words else text)


_CJK = re.compile("[\u4e00-\u9fff]")

TITLES: dict[str, str] = {
    "000": "Note 000: kinematics, Jacobian, inverse kinematics, statics, dynamics",
    "001": "Note 001: Lagrange, the planar 2R arm with point masses",
    "002": "Note 002: Lagrange in general, standard DH",
    "003": "Note 003: the two-degree-of-freedom parallel robot",
}
HEAD = (
    "Each formula was evaluated by hand and by Pinocchio at random states. The error of a state is "
    "the largest difference of an entry over the largest entry of the engine's answer. A correct "
    "form stays below 1e-9; a misprint shows above 1e-3."
)
