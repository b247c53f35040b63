"""One thing for another in the whole text: a name, a number, the joints, sines and cosines."""

from __future__ import annotations

from dataclasses import replace

import numpy as np

from kinlab.doctor.text.line import Line
from kinlab.formulas.text import WORD, words_in
from kinlab.host.language import N_

NUMBERS = {"1": 1.0, "2": 2.0, "3": 3.0, "4": 4.0, "6": 6.0, "8": 8.0, "12": 12.0, "0.5": 0.5}
NUMBERS |= {"(1/3)": 1 / 3, "(1/4)": 0.25, "(1/12)": 1 / 12}
"""What may stand for another number, as it is typed."""


def throughout(line: Line) -> None:
    """One name for another in the whole text; sines and cosines exchanged; gravity turned."""
    words = words_in(line.source)
    joints = {f"{x}{i + 1}" for x in ("q", "qd", "qdd") for i in range(line.names.n)}
    inside = [w for w in dict.fromkeys(words) if w in line.atoms and words.count(w) > 1]
    for word in inside:
        for other in line.atoms:
            if other != word:
                told = N_("{old} should be {new} throughout")
                _global(line, ((word, other),), "parameter", 1.9, told, {"old": word, "new": other})
    shown = {line.spelling.get(j, j) for j in joints}
    for i in range(1, line.names.n + 1):
        for k in range(i + 1, line.names.n + 1):
            swap = []
            for x in ("q", "qd", "qdd"):
                one, two = (line.spelling.get(name, name) for name in (f"{x}{i}", f"{x}{k}"))
                swap += [(one, two), (two, one)]
            if {a for a, _ in swap} & set(words) & shown:
                told, (one, two) = N_("{one} and {two} are exchanged throughout"), swap[0]
                _global(line, tuple(swap), "index", 2.2, told, {"one": one, "two": two})
    if {"sin", "cos"} & set(words):
        told = N_("sin and cos are exchanged throughout")
        _global(line, (("sin", "cos"), ("cos", "sin")), "sin/cos", 1.9, told, {})
    _same_numbers(line)
    weight = line.spelling.get("g", "g")
    if words.count(weight) > 1:
        told = N_("gravity has the opposite sign: every g should be -g")
        _global(line, ((weight, f"(-{weight})"),), "gravity sign", 1.5, told, {})


def alike(line: Line, digits: str) -> list[int]:
    """Which of the numbers are written so."""
    spans = line.text.spans
    return [k for k, one in enumerate(line.text.literals[: len(spans)]) if one.text == digits]


def _same_numbers(line: Line) -> None:
    """One number for another in the whole text: 0.3 for 1/3."""
    decimals = dict.fromkeys(one.text for one in line.text.literals if "." in one.text)
    for old in decimals:
        places = alike(line, old)
        if len(places) < 2:
            continue
        for shown, size in NUMBERS.items():
            numbers = np.array([one.value for one in line.text.literals])
            numbers[places] = size
            new = line.source
            for start, end in (line.text.spans[k] for k in reversed(places)):
                new = f"{new[:start]}{shown}{new[end:]}"
            told, span = N_("{old} should be {new} throughout"), (0, len(line.source), new)
            value, swap = line.text.values(line.at, numbers), ((old, shown),)
            line.edit(line.root, value, span, "factor", 1.3, told, {"old": old, "new": shown}, swap)


def _global(
    line: Line,
    swap: tuple[tuple[str, str], ...],
    kind: str,
    cost: float,
    told: str,
    pieces: dict[str, str],
) -> None:
    table = dict(swap)
    new = WORD.sub(lambda m: table.get(m.group(), m.group()), line.source)
    if new == line.source:
        return
    try:
        values = replace(line.text, text=new).values(line.at)
    except KeyError:
        return
    line.edit(line.root, values, (0, len(line.source), new), kind, cost, told, pieces, swap)
