"""Slips within single entries: the derived formula beside a user's text or function."""

from __future__ import annotations

import re
from collections.abc import Collection, Iterator, Mapping
from dataclasses import dataclass, replace
from itertools import chain, product
from typing import Any

import numpy as np

from kinlab.arrays import Array
from kinlab.check.diagnosis import shown_entry
from kinlab.doctor.changes import ANY_ZERO
from kinlab.doctor.confusions.centres import FreeCentres
from kinlab.doctor.derived import POINTS, Derivation, searchable
from kinlab.doctor.entries import regression, search
from kinlab.doctor.entries.search import Edit, Repair
from kinlab.doctor.linkages.looked_up import Reference
from kinlab.doctor.text.alternatives import halves_lengths
from kinlab.doctor.text.line import Line, Names, brief
from kinlab.doctor.text.mend import Mended, mended, one_after_another, rewritten, together
from kinlab.doctor.text.numbers_off import as_meant, beside_rounded, rounded_in
from kinlab.doctor.text.written import Written
from kinlab.formulas import tree
from kinlab.formulas.text import parse, words_in
from kinlab.formulas.tree import Node
from kinlab.host.language import N_, _
from kinlab.symbolic.trig import Poly
from kinlab.tolerances import TOLERANCES

_FEWEST = 8
"""Points at which a text must have a value."""
_SEED = 11
"""Of the random points at which a text is looked at."""
_LINES = 2
"""Ways to read a text in which three slips are looked for one after another."""
_RATHER = 0.04
"""How much less what is right of rods costs than what is right of any centres, to be told."""
_WAYS = 3
"""Repairs of one part that are tried beside those of the others."""
_WRITTEN_OUT = 60
"""Terms of an entry up to which a function may have been written out by hand."""
_SHORT = 30
"""Terms of an entry up to which two slips of a function are looked for."""

_TURNED = {
    "extra term": "missing term",
    "missing term": "extra term",
    "extra factor": "missing factor",
    "missing factor": "extra factor",
}
"""A kind of edit of the engine's formula, told as a slip of the user's."""


@dataclass(frozen=True)
class Slip:
    """An explanation of one entry.

    Attributes:
        entry: which entry, such as ``"inverse_dynamics[0]"``.
        kinds: the kinds of slip, one per place.
        sentence: what is wrong, in plain words.
        corrected: the right formula of the entry, or ``""``.
        cost: how far-fetched it is.
        values: what the engine's entry becomes with the slips (for a function), or the user's
            entry repaired (for a text), at the states of the comparison.
        repaired: whether ``values`` are the user's repaired ones.
        error: relative error that is left with the slip repaired.
        typed: the right formula as the writer would type it, where otherwise, or ``""``.
        defined: of a slip in what a name of the writer's stands for, the name and what it should.
        replaced: the pieces of a text that are replaced as a whole.
    """

    entry: str
    kinds: tuple[str, ...]
    sentence: str
    corrected: str
    cost: float
    values: Array
    repaired: bool
    error: float = np.inf
    typed: str = ""
    defined: tuple[str, str] | None = None
    replaced: tuple[str, ...] = ()

    def with_error(self, error: float) -> Slip:
        """The slip with its evidence."""
        return replace(self, error=error)


def names_for(derived: Reference, arguments: tuple[str, ...]) -> Names:
    """What may stand in a formula of this quantity."""
    loads = derived.loads
    own = tuple(p for p in derived.parameters if p not in loads)
    return Names(own, derived.n, derived.letters(arguments), loads, derived.spelling)


def in_text(
    label: str,
    written: Written,
    derived: Reference,
    poly: Any,
    arguments: tuple[str, ...],
    states: dict[str, Array],
    elsewhere: FreeCentres | None = None,
    most: int = 3,
    least: int = 1,
) -> list[Slip]:
    """Slips that turn the user's text into the derived formula, at random parameters.

    Of as many slips those come first that are slips wherever the centres are; of a text that names
    centres one or two more of these come before what is right only for this arm.

    Args:
        label: the entry's name.
        written: the user's text.
        derived, poly: the derivation and the entry's polynomial.
        arguments: the quantity's arguments.
        states: the comparison's states.
        elsewhere: the same of an arm with its centres elsewhere, where that is asked.
        most, least: how many slips are looked for.
    """
    if not searchable(poly):
        return []
    here = derived.environment(states)
    named = [name for name in derived.loads if np.any(here[name])]
    poly, names = derived.held(poly, named), names_for(derived, arguments)
    names = replace(names, loads=tuple(named))
    right = derived.tree(poly)
    forms = [list(form.terms) for form in derived.forms(poly)]
    # other numbers first: they cannot hide a slip; then the robot's, for texts with numbers
    own = {name: values[:POINTS] for name, values in here.items()}
    # names that are not there may be there as their numbers: whole ones too
    left_out = (tree.names(right) & set(names.parameters)) - tree.names(written.node)
    held = [float(derived.values[name]) for name in left_out]
    bare = tree.names(written.node).isdisjoint(names.parameters)
    numbers = any(
        not one.exponent and (bare or "." in one.text or one.value in held)
        for one in written.literals
    )
    plain, lines = [], []
    for text in dict.fromkeys((as_meant(written, right, own) if numbers else written, written)):
        for of in (as_rods(derived.anywhere(_SEED), written, derived), own)[: 1 + numbers]:
            line = _line_at(text, names, _with_value(text, of), right, forms, of is own)
            lines.append(line)
            plain += [line] if text is written else []
    free, rods = derived.anywhere(_SEED), as_rods(derived.anywhere(_SEED), written, derived)
    unlike = []
    if any(not np.array_equal(rods[name], free[name]) for name in tree.names(right) & free.keys()):
        unlike.append(_line_at(written, names, free, right, forms))
    if any(line.wrong_by <= TOLERANCES.effect_matches * line.scale for line in lines):
        lines = plain  # nothing else is wrong: the digits are too few
    moved = [] if elsewhere is None else _elsewhere(elsewhere, named, arguments)
    sure = elsewhere is not None and elsewhere.named
    # a moment that is left out comes before one that would be a rod's
    tried = [(line, 2 if sure else 1) for line in moved]
    tried += [(line, 1) for line in unlike]
    tried += [(line, 1) for line in dict.fromkeys((*plain, *lines)) if numbers and left_out]
    if bare:  # without a name the other numbers are the robot's own
        lines.sort(key=lambda line: not line.numeric)
    moments = any(name[0] == "I" for name in tree.names(written.node))
    if moments:  # who names one names them all
        tried += [(line, 1) for line in lines * bool(unlike)]
        tried += [(line, 2) for line in unlike]
    tried += [(line, 1) for line in lines * bool(moved)]
    tried += [(line, 3 if sure else 2) for line in moved]
    if numbers and not isinstance(derived, Derivation):
        tried += [(line, 1) for line in lines]
    tried += [(line, 2) for line in lines]
    all_ = (*moved, *unlike * moments, *lines) if most > 2 else ()
    asked = dict.fromkeys((line, min(count, most)) for line, count in tried if least <= count)
    ways: Iterator[tuple[Line, list[Mended]]] = chain(
        ((line, mended(line, count)) for line, count in asked),
        ((line, _part_by_part(line)) for line in all_ if not line.numeric),
        ((line, mended(line)) for line in all_),
        ((line, one_after_another(line)) for line in all_[:_LINES] if not line.numeric),
    )
    for line, found in ways:
        if line.numeric:
            found = [one for one in found if _no_coincidence(line, one, right, derived)]
        if found and line in moved and not sure:
            line, found = _or_of_rods(line, found, plain)
        text = elsewhere.here if elsewhere is not None and line in moved else line.text
        if found:
            return [_of_any_zero(line, one, text, here, label) for one in found]
    if not numbers or most == 1:
        return []
    apart = [
        (at, np.array(np.broadcast_to(tree.evaluate(right, at), np.shape(next(iter(at.values()))))))
        for at in parts(right, own)
    ]
    written, found = beside_rounded(plain[-1], apart)
    return [slip_of(written, one, here) for one in found]


def _or_of_rods(line: Line, found: list[Mended], plain: list[Line]) -> tuple[Line, list[Mended]]:
    """Of a text with halves for centres what is likelier where these are the rods' middles.

    The 2 that does not belong in ``2*m3*l3/2``, and not lc3 for l3.
    """
    for other in plain if halves_lengths(line) else ():
        way = [] if other.numeric else mended(other, 1)
        if way and way[0].cost < found[0].cost - _RATHER:
            return other, way
    return line, found


def _with_value(text: Written, at: dict[str, Array]) -> dict[str, Array]:
    """The points at which a text has a value, if they are many: a root may have none at some."""
    known: Any = np.isfinite(text.values(at))
    if known.all() or np.sum(known) < _FEWEST:
        return at
    return {name: x[known] for name, x in at.items()}


def _elsewhere(of: FreeCentres, named: list[str], arguments: tuple[str, ...]) -> list[Line]:
    """The text of an arm with its centres elsewhere.

    Its moments are free; who names centres may also have them as those of rods.
    """
    poly, names = of.derived.held(of.poly, named), names_for(of.derived, arguments)
    names, right = replace(names, loads=tuple(named)), of.derived.tree(poly)
    forms = [list(form.terms) for form in of.derived.forms(poly)]
    free = of.derived.anywhere(_SEED)
    rods = as_rods(free, of.text, of.derived)
    tied = any(not np.array_equal(rods[name], free[name]) for name in tree.names(right) & {*free})
    every = (free, rods) if tied and of.named else (free,)
    return [_line_at(of.text, names, at, right, forms) for at in every]


def _line_at(
    text: Written,
    names: Names,
    at: dict[str, Array],
    right: Node,
    forms: list[list[Node]],
    numeric: bool = False,
) -> Line:
    """A text beside the values that it should have."""
    target = np.broadcast_to(tree.evaluate(right, at), np.shape(next(iter(at.values()))))
    return Line(text, names, at, np.array(target), forms, numeric)


def _of_any_zero(
    line: Line, one: Mended, written: Written, here: dict[str, Array], label: str
) -> Slip:
    """The slip that a repair is; of a potential without what moves nothing but its zero."""
    whole, kept = slip_of(written, one, here), one
    if label.split("[")[0] not in ANY_ZERO or len(one.changes) == 1:
        return whole
    at = dict(line.at)
    elsewhere = {n: np.roll(x, 1) if _MOVES.fullmatch(n) else x for n, x in at.items()}
    for change in one.changes:
        rest = tuple(x for x in kept.changes if x is not change)
        text = rewritten(line.source, rest) if rest else None
        if text is None:
            continue
        moved = replace(line.text, text=text)
        gap, there = (moved.values(x) - tree.evaluate(line.right, x) for x in (at, elsewhere))
        if np.max(np.abs(gap - there)) <= TOLERANCES.effect_matches * line.scale:
            kept = Mended(rest, text, kept.cost - change.cost)
    return whole if kept is one else replace(slip_of(written, kept, here), values=whole.values)


def lines_apart(
    written: Written,
    derived: Reference,
    poly: Any,
    arguments: tuple[str, ...],
    states: dict[str, Array],
    elsewhere: FreeCentres | None,
) -> list[tuple[Line, Written]]:
    """A text beside what it should be at other numbers than the robot's, and as it is told.

    With its centres elsewhere first, where that is asked; nothing of what is too long.
    """
    if not searchable(poly):
        return []
    here, names = derived.environment(states), names_for(derived, arguments)
    named = [name for name in derived.loads if np.any(here[name])]
    poly, names = derived.held(poly, named), replace(names, loads=tuple(named))
    at = as_rods(derived.anywhere(_SEED), written, derived)
    forms = [list(form.terms) for form in derived.forms(poly)]
    moved = [] if elsewhere is None else _elsewhere(elsewhere, named, arguments)
    told = written if elsewhere is None else elsewhere.here
    plain = _line_at(written, names, _with_value(written, at), derived.tree(poly), forms)
    return [*((line, told) for line in moved), (plain, written)]


def _no_coincidence(line: Line, one: Mended, right: Node, derived: Reference) -> bool:
    """Whether a repair at the robot's own numbers is one where the names in the text have others.

    A text with decimals may have a number in one place and its name in another.
    """
    text, own = replace(line.text, text=one.text), dict(line.at)
    if _names_a_number(text):
        return True
    if any(not n.whole and 12 * n.value % 1 and not n.exponent for n in text.literals):
        return True
    here, held = text.values(own), {}
    for name in line.names.parameters:
        moved = text.values(own | {name: 1.3 * own[name]})
        if np.array_equal(moved, here):
            held[name] = float(own[name][0])  # it stands there as a number, or not at all
    other = as_rods(derived.anywhere(_SEED, held), text, derived)
    target = tree.evaluate(right, other)
    gap = np.max(np.abs(text.values(other) - target))
    return bool(gap <= TOLERANCES.effect_matches * (np.max(np.abs(target)) or 1.0))


def _names_a_number(text: Written) -> bool:
    """Whether a name in a text stands for a number that is none of the robot's: M for m1 + m2."""
    own = ({*words_in(text.text)} & text.symbols.keys()) - text.known.keys()
    return any(not tree.names(parse(text.symbols[name])) for name in own)


_MOVES = re.compile(r"qd{0,2}\d+")
_MOTION = re.compile(r"(qdd?)\d+")
_PARTS = (("qd", "g"), ("qdd", "g"), ("qd", "qdd"))
"""What is zero where a formula is one of its parts alone: accelerations, velocities, gravity."""
_SLIPS = 4
"""Slips in all parts together above which a list of them is no diagnosis."""


def parts(right: Node, at: dict[str, Array]) -> list[dict[str, Array]]:
    """The names' values at which a formula is one of its parts, for those that it has."""
    met = {found[1] if (found := _MOTION.fullmatch(n)) else n for n in tree.names(right)}
    if len(met & {"qd", "qdd", "g"}) < 2:
        return []
    alone = []
    for gone in _PARTS:
        zero = [n for n in at if n in gone or ((m := _MOTION.fullmatch(n)) and m[1] in gone)]
        inside = at | {n: np.zeros_like(at[n]) for n in zero}
        if np.max(np.abs(tree.evaluate(right, inside))) > 0:
            alone.append(inside)
    return alone if len(alone) > 1 else []


def _part_by_part(line: Line) -> list[Mended]:
    """One or two slips in each of several parts, each found where the other parts are zero."""
    ways: list[list[Mended]] = []
    for at in parts(line.right, dict(line.at)):
        target = np.array(np.broadcast_to(tree.evaluate(line.right, at), line.target.shape))
        part = Line(line.text, line.names, at, target, line.forms)
        if np.max(np.abs(part.root.value - target)) <= TOLERANCES.effect_matches * line.scale:
            continue
        ways.append(mended(part, 2)[:_WAYS])
    good = []
    for chosen in product(*ways) if len(ways) > 1 else ():
        changes = tuple(dict.fromkeys(change for way in chosen for change in way.changes))
        if len(changes) <= _SLIPS:
            good += together(line, changes)
    return sorted(good, key=lambda m: m.cost)[:_WAYS]


def as_rods(at: dict[str, Array], written: Written, derived: Reference) -> dict[str, Array]:
    """The numbers with I = m l²/12 where the robot's links are rods and the text has no I."""
    return rods_following(at, derived.values, tree.names(written.node))


def rods_following(
    at: Mapping[str, Array], values: Mapping[str, Any], named: Collection[str]
) -> dict[str, Array]:
    """Numbers of a robot with I = m l²/12 where its links are rods by its own ``values``.

    Moments in ``named`` stay what they are.
    """
    out = dict(at)
    for name in values:
        found = re.fullmatch(r"I(?:xx|yy|zz)?(\d+)", name)
        if found is None or name in named:
            continue
        m, k = f"m{found[1]}", found[1]
        length = next((one for one in (f"l{k}", f"a{k}") if one in values), "")
        if m not in values or not length:
            continue
        rod = float(values[m]) * float(values[length]) ** 2 / 12
        if abs(float(values[name]) - rod) <= TOLERANCES.same_length * rod:
            out[name] = out[m] * out[length] ** 2 / 12
    return out


def slip_of(written: Written, found: Mended, here: dict[str, Array]) -> Slip:
    """A repair of a text as a slip."""
    form = _("{entry}: {slip} ({kind})")
    slips = [
        form.format(entry=shown_entry(written.entry), slip=c.sentence(written.told), kind=_(c.kind))
        for c in found.changes
    ]
    repaired = replace(written, text=found.text)
    told = _("; ").join((*slips, *rounded_in(repaired, here)))
    kinds = tuple(c.kind for c in found.changes)
    values = repaired.values(here)
    text = written.restored(found.text)
    typed = written.typing.corrected(text) if written.typing is not None else ""
    old = tuple(c.pieces["old"] for c in found.changes if "old" in c.pieces)
    return Slip(
        written.entry, kinds, told, text, found.cost, values, True, typed=typed, replaced=old
    )


def turned(written: Written) -> Slip:
    """The sign of a whole text, which needs no derivation: of an arm with many joints, too."""
    plain, body = written.text.strip(), written.text.strip().removeprefix("-")
    new = (body if body != plain else f"-{plain}") if _ONE_TERM.fullmatch(body) else f"-({plain})"
    return _whole(written, new, "sign", np.empty(0), 1.0)


def nothing(written: Written, entry: Array) -> Slip:
    """Of an entry that is nothing at all: no term of a text belongs there."""
    return _whole(written, "0", "extra term", np.zeros_like(entry), _OF_NOTHING)


def _whole(written: Written, new: str, kind: str, values: Array, cost: float) -> Slip:
    """Another text in place of a whole one."""
    pieces = {"old": written.told(written.text.strip()), "new": written.told(new)}
    told = _("{old} should be {new}").format(**pieces)
    said = _("{entry}: {slip} ({kind})").format(
        entry=shown_entry(written.entry), slip=told, kind=_(kind)
    )
    text = written.restored(new)
    typed = written.typing.corrected(text) if written.typing is not None else ""
    return Slip(written.entry, (kind,), said, text, cost, values, True, typed=typed)


_OF_NOTHING = 0.6
"""Cost of an entry that should be nothing: that is known whatever stands there."""
_ONE_TERM = re.compile(r"[^-+]*(?:\([^()]*\)[^-+]*)*")
"""A product without a sign in front, whatever stands between its parentheses."""


def in_function(
    label: str,
    hand: Array,
    engine: Array,
    derived: Derivation,
    poly: Poly,
    arguments: tuple[str, ...],
    states: dict[str, Array],
    others: list[Node],
) -> list[Slip]:
    """Slips that turn the derived formula into the user's function, by values only.

    Args:
        label: the entry's name.
        hand, engine: both answers at the states, (N,).
        derived, poly: the derivation and the entry's polynomial.
        arguments: the quantity's arguments.
        states: the comparison's states.
        others: derived entries whose joint functions may be met.
    """
    if len(poly) > _WRITTEN_OUT:
        return []  # nobody has written that out term by term
    names = names_for(derived, arguments)
    everywhere = derived.environment(states)
    at = {name: values[:POINTS] for name, values in everywhere.items()}
    target = hand[:POINTS]
    right = derived.tree(poly)
    forms = derived.forms(poly)
    cases = [search.study(form, target, at, names, []) for form in forms]
    repairs = [(c.root, r) for c in cases for r in search.single(c)]
    if repairs:
        return _by_effect(label, right, repairs, everywhere)
    circles = regression.dictionaries([right, *others], names)
    sums = (regression.explain(hand - engine, words, everywhere) for words in circles)
    alone = [found for found in sums if len(found) == 1][:1]
    if len(poly) <= _SHORT:
        repairs = [(c.root, r) for c in cases for r in search.double(c)]
        repairs += [(c.root, r) for c in cases for r in search.double_in_term(c)]
    slips = _by_effect(label, right, repairs, everywhere)
    slips += [_as_terms(label, right, found, names, everywhere) for found in alone]
    if not slips:
        for words in circles:
            found = regression.explain(hand - engine, words, everywhere)
            if found:
                return [_as_terms(label, right, found, names, everywhere)]
    return slips


def _by_effect(
    label: str, right: Node, repairs: list[tuple[Node, Repair]], everywhere: dict[str, Array]
) -> list[Slip]:
    slips: list[Slip] = []
    for form, repair in sorted(repairs, key=lambda pair: pair[1].cost):
        told = _("; ").join(_told_function(label, form, e) for e in repair.edits)
        kinds = tuple(_TURNED.get(e.kind, e.kind) for e in repair.edits)
        if tree.names(form) and not tree.names(repair.result):
            continue  # a bare number: any formula becomes one if enough is left out
        values = tree.evaluate(repair.result, everywhere)
        if all(s.sentence != told for s in slips):
            slips.append(Slip(label, kinds, told, str(right), repair.cost, values, False))
    return slips


_COEFFICIENT = (
    N_("the coefficient of {term} is smaller than the engine's by {size}"),
    N_("the coefficient of {term} is larger than the engine's by {size}"),
)
_CONSTANT = (
    N_("the constant term is smaller than the engine's by {size}"),
    N_("the constant term is larger than the engine's by {size}"),
)


def _as_terms(
    label: str, right: Node, found: list[regression.Term], names: Names, at: dict[str, Array]
) -> Slip:
    pieces = []
    total = tree.evaluate(right, at)
    for term in found:
        total = total + term.coefficient * tree.evaluate(term.product, at)
        size = _as_parameters(term, right, names, at)
        said = _CONSTANT if term.product == tree.num(1) else _COEFFICIENT
        told = _(said[term.coefficient > 0])
        pieces.append(told.format(term=brief(str(term.product)), size=brief(size)))
    told = _("{entry}: {slip}").format(entry=shown_entry(label), slip=_(", and ").join(pieces))
    kinds = ("coefficient",) * len(found)
    # one term is simpler than most pairs of slips
    cost = 2.25 if len(found) == 1 else 2.0 + len(found)
    return Slip(label, kinds, told, str(right), cost, total, False)


def _as_parameters(term: regression.Term, right: Node, names: Names, at: dict[str, Array]) -> str:
    """A coefficient's size, as a product of parameters where the derived formula has one."""
    size = abs(term.coefficient)
    parameters = set(names.parameters)
    for piece in right.terms:
        front = tree.mul(tree.num(1), *(f for f in piece.factors if tree.names(f) <= parameters))
        value = abs(float(np.ravel(tree.evaluate(front, at))[0]))
        if tree.names(front) and abs(value - size) <= 1e-8 * size:
            return f"{front} = {size:.10g}".replace("-", "", 1)
    return f"{size:.10g}"


def _told_function(label: str, form: Node, edit: Edit) -> str:
    old = tree.at_path(form, edit.path)
    term = _context(form, edit.path, old)
    kind = _TURNED.get(edit.kind, edit.kind)
    if edit.kind == "extra term":
        said = _("{entry}: the term {old} is missing")
    elif edit.kind == "extra factor" and term:
        said = _("{entry}: the factor {old} is missing in {term}")
    elif edit.kind == "extra factor":
        said = _("{entry}: the factor {old} is missing")
    elif edit.kind == "factor" and tree.names(old) and edit.new == tree.mul(tree.num(2), old):
        said = _("{entry}: {old} is there twice")
    elif term:
        said = _("{entry}: it has {new} where the engine has {old} in {term} ({kind})")
    else:
        said = _("{entry}: it has {new} where the engine has {old} ({kind})")
    return said.format(
        entry=shown_entry(label),
        old=brief(str(old)),
        new=brief(str(_unsigned(edit.new))),
        term=brief(term),
        kind=_(kind),
    )


def _unsigned(node: Node) -> Node:
    """A product without a sign in front of a sum that begins with one: a - b for -(-a + b)."""
    if node.op != "mul" or node.args[0].op != "num" or node.args[0].value >= 0:
        return node
    for k, factor in enumerate(node.args):
        if factor.op == "add" and str(factor).startswith("-"):
            turned = tree.add(*(tree.mul(tree.num(-1), term) for term in factor.args))
            return tree.mul(tree.num(-1), *node.args[:k], turned, *node.args[k + 1 :])
    return node


def _context(root: Node, path: tuple[int, ...], old: Node) -> str:
    """The term around a place."""
    depth = 1 if root.op == "add" else 0
    if len(path) <= depth:
        return ""
    term = tree.at_path(root, path[:depth])
    return str(term) if term != old else ""
