"""The four notes, formula by formula, from the catalogue: printed, as it should be, verdicts.

Every formula is run beside the engine when the pages are made. One page a note and language; a
language is made where kinlab has a catalogue of it.
"""

from __future__ import annotations

import hashlib
import re
from collections.abc import Sequence
from html import escape
from itertools import groupby
from pathlib import Path

from made_pages import write_if_changed
from words import Language, languages

import kinlab
from kinlab.check.catalogue import catalogue, plan, run
from kinlab.check.places import places, told_of
from kinlab.check.report.summary import Group, grouped, size
from kinlab.formulas.typeset import mathml

LONG = 70
"""Characters of LaTeX above which a form gets the whole width of the page."""

_HOME = Path(kinlab.__file__).parent


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
    first: dict[str, int] = {}
    for place in places():
        for id in place.ids if place.note == number else ():
            first.setdefault(id, place.first)
    ordered = sorted(groups, key=lambda group: first.get(group.formula.id, 10**6))
    lines = [f"# {say(TITLES[number])}", "", say(HEAD), ""]
    wrong = [group for group in ordered if group.printed_error is not None]
    if wrong:
        lines += [f"## {say('Misprints of this note')}", ""]
        for group in wrong:
            label = f"`{group.formula.key}`"
            told = told_of(group.formula, say.name)
            lines.append(f"- [{label}](#{anchor(group, say)}){say(': ')}{ended(told['misprint'])}")
        lines.append("")
    for source, several in groupby(ordered, lambda group: group.formula.source):
        section = re.sub(r"^\w+ \d{3}[,，] *", "", say(source))  # the page's title names the note
        lines += [f"## {section[:1].upper()}{section[1:]}", ""]
        for group in several:
            lines += card(group, say)
    lines += line_by_line(number, {group.formula.id for group in groups}, say)
    return "\n".join(lines) + "\n"


def card(group: Group, say: Language) -> list[str]:
    """One formula: place, forms, verdict, how far each form is from the engine, robot by robot."""
    record = group.formula
    told = told_of(record, say.name)
    lines = [f"({anchor(group, say)})=", f"### `{record.key}` {literal(told['title'])}", ""]
    engine = say("engine: {quantity}").format(quantity=f"`{record.quantity}`")
    lines += ["{.place}", " · ".join(filter(None, (literal(told["place"]), engine))), ""]
    forms = []
    if record.printed is not None and group.printed_error is not None:
        forms.append(form("printed", say("printed"), record.printed.latex))
    if record.latex:
        name = ("corrected", say("should be")) if forms else ("only", "")
        forms.append(form(*name, record.latex))
    lines += ["```{raw} html", f'<div class="forms">{"".join(forms)}</div>', "```", ""]
    lines += [verdict(group, say), ""]
    if record.remark:
        lines += [sentence(told["remark"]), ""]
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
        return f"{{.fails}}\n**{sentence(group.verdict)}** {figures}{say('.')}"
    if group.printed_error is None or group.formula.printed is None:
        return f"{{.agrees}}\n**{say('Agrees.')}** {figures}{say('.')}"
    what = ended(told_of(group.formula, say.name)["misprint"])
    off = say("the printed form is off by {error} or more").format(error=size(group.printed_error))
    both = f"{figures}{say('; ')}{off}{say('.')}"
    return f"{{.misprint}}\n**{say('Misprint')}{say(': ')}{what}** {both}"


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
    for row in (_HOME / "notes" / "lines.tsv").read_text(encoding="utf-8").splitlines():
        if row.startswith(f"{number}\t"):
            _, span, ids, words = row.split("\t")[:4]
            here = ", ".join(f"`{id}`" for id in ids.split() if id in known)
            lines.append(f"| {span.replace('-', '–')} | {literal(words)} | {here} |")
    return [*lines, ""]


def anchor(group: Group, say: Language) -> str:
    """The label of a formula on its page; labels are one for the whole site."""
    plain = "".join(c if c.isalnum() else "-" for c in group.formula.key)
    return f"formula-{plain}" if say.folder == "." else f"formula-{say.name}-{plain}"


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
