"""One slip of the pen, two or three: the changes that make a line right, and the line then."""

from __future__ import annotations

import ast
import re
from collections.abc import Iterator, Sequence
from dataclasses import dataclass, replace
from itertools import pairwise, permutations

import numpy as np

from kinlab.arrays import Array
from kinlab.doctor.text.alternatives import study, study_what_stands
from kinlab.doctor.text.line import (
    Change,
    Line,
    Place,
    inside_wave,
    is_product,
    is_sum,
    is_term,
)
from kinlab.doctor.text.pairs import pairs_adding_up, pairs_in_product
from kinlab.formulas import tree
from kinlab.formulas.signs.brackets import closes
from kinlab.formulas.text import words_in
from kinlab.tolerances import TOLERANCES

_TRIED = 60
_BESIDE = 12
"""Changes beside which two of one product are looked for."""
_LONG = 8
"""Names in a formula from which on three slips are looked for."""
_PLAIN = 1.1
"""Cost up to which a change is the first of three that are tried one after another."""
_NOTED = 40_000
"""Changes that may be noted, all in all, where three are tried one after another."""
_EXCHANGED = 0.6
"""What it costs to exchange a whole term beside mending it."""
_TERMS = {"extra term", "missing term"}
_TERMS_OFF = 3
"""Terms with slips up to which each is put right by itself."""
_FAR = 4
"""Names in a formula from which on three slips in several terms are believed."""


@dataclass(frozen=True)
class Mended:
    """A text with its slips mended.

    Attributes:
        changes: one to three.
        text: the formula after them.
        cost: the sum of theirs.
    """

    changes: tuple[Change, ...]
    text: str
    cost: float


def mended(line: Line, most: int = 3) -> list[Mended]:
    """The fewest changes that make the text right, the likeliest first; empty where none do."""
    if not line.source.isascii():
        return []  # places are counted in bytes
    study(line)
    wanted = line.target - line.root.value
    if not line.rows:
        return []
    effects = np.array(line.rows)
    allowed = TOLERANCES.effect_matches * line.scale
    gaps = np.max(np.abs(effects - wanted), axis=1)
    found: list[tuple[int, ...]] = [(int(k),) for k in np.flatnonzero(gaps <= allowed)]
    for more in (_pairs, _covers)[: most - 1]:
        good = list(_checked(line, found))
        if good:
            return sorted(good, key=lambda m: m.cost)
        found = more(line, effects, wanted, allowed)
    several = _term_by_term(line, effects, allowed) if most > 2 else []
    return sorted([*_checked(line, found), *several], key=lambda m: m.cost)


def _pairs(line: Line, effects: Array, wanted: Array, allowed: float) -> list[tuple[int, ...]]:
    found = [tuple(pair) for pair in pairs_adding_up(effects, wanted, allowed)]
    return _cheapest(line, [*found, *_in_products(line, effects, wanted)])


def _in_products(line: Line, effects: Array, wanted: Array) -> list[tuple[int, ...]]:
    """Pairs of changes of one product."""
    found: list[tuple[int, ...]] = []
    for place in line.places:
        whole = place is line.root  # a factor of all of it, and a slip in it
        if not is_term(place) or inside_wave(place) or (is_sum(place.node) and not whole):
            continue
        inside = _inside(line, place)
        if len(inside) > 1:
            pairs = pairs_in_product(effects[inside], wanted, _share(line, place))
            found += [(inside[a], inside[b]) for a, b in pairs]
    return found


def _inside(line: Line, place: Place) -> list[int]:
    """The changes within a term, and of the sign in front of it."""
    start, end = place.span if place is not line.root else (0, len(line.source))
    if place.role == 1 and place.above is not None and is_sum(place.above.node):
        start = line.siblings[id(place.above)][0].span[1]
    return [k for k in line.inside(start, end) if line.changes[k].kind not in _TERMS]


def _share(line: Line, place: Place) -> Array:
    """What a term adds to the whole."""
    share: Array = line.root.value - line.climbed(place, np.zeros(line.count))
    return share


def _term_by_term(line: Line, effects: Array, allowed: float) -> list[Mended]:
    """Slips in several terms of a sum: each term is put right beside the derived one it may be."""
    places = _summands(line, line.root)
    shares = [_share(line, place) for place in places]
    good: list[Mended] = []
    for form in line.forms:
        if not 2 <= len(places) == len(form):
            continue
        goals = [np.broadcast_to(tree.evaluate(t, line.at), (line.count,)) for t in form]
        left = list(range(len(goals)))
        off = []
        for place, share in zip(places, shares, strict=True):
            same = [k for k in left if np.max(np.abs(goals[k] - share)) <= allowed]
            left = [k for k in left if k not in same[:1]]
            off += [] if same else [(place, share)]
        if not 2 <= len(off) <= _TERMS_OFF:
            continue
        ways = {
            (i, k): _of_term(line, effects, place, share, goals[k], allowed)
            for i, (place, share) in enumerate(off)
            for k in left
        }
        for order in permutations(left):
            chosen = [ways[i, k] for i, k in enumerate(order)]
            if all(chosen):
                good += _checked(line, [tuple(n for way in chosen for n in way)], _FAR)
    return good


def _summands(line: Line, place: Place) -> list[Place]:
    if not is_sum(place.node):
        return [place]
    return [one for part in line.siblings[id(place)] for one in _summands(line, part)]


def _of_term(
    line: Line, effects: Array, place: Place, share: Array, goal: Array, allowed: float
) -> tuple[int, ...]:
    """The likeliest change, or the likeliest two, that make one term another."""
    inside = _inside(line, place)
    if not inside:
        return ()
    rows, wanted = effects[inside], goal - share
    alone = np.flatnonzero(np.max(np.abs(rows - wanted), axis=1) <= allowed)
    if len(alone):
        return _cheapest(line, [(inside[k],) for k in alone])[0]
    pairs = [*pairs_in_product(rows, wanted, share), *pairs_adding_up(rows, wanted, allowed)]
    found = [(inside[a], inside[b]) for a, b in pairs]
    apart: list[tuple[int, ...]] = [
        way for way in found if not _overlap(_nested(line.source, [line.changes[k] for k in way]))
    ]
    return next(iter(_cheapest(line, apart)), ())


def _overlap(changes: Sequence[Change]) -> bool:
    """Whether two changes touch the same letters."""
    ranked = sorted(changes, key=lambda c: (c.start, c.end))
    return any(a.end > b.start or a.everywhere or b.everywhere for a, b in pairwise(ranked))


def _cheapest(line: Line, found: list[tuple[int, ...]]) -> list[tuple[int, ...]]:
    ranked = sorted(set(found), key=lambda way: (_cost([line.changes[k] for k in way]), way))
    return ranked[:_TRIED]


def _cost(changes: Sequence[Change]) -> float:
    """How far-fetched several changes are together."""
    terms = {c.kind for c in changes} >= _TERMS
    return sum(c.cost for c in changes) + 0.4 * (len(changes) - 1) + _EXCHANGED * terms


def _covers(line: Line, effects: Array, wanted: Array, allowed: float) -> list[tuple[int, ...]]:
    """Three changes: one of them leaves what two others add up to.

    Only changes that take a whole term of the difference away are tried as the first.
    """
    rest = np.sum((wanted[:, None] - effects.T) ** 2, axis=0)
    order = np.argsort(rest + 1e-9 * np.array([c.cost for c in line.changes]), kind="stable")
    found: list[tuple[int, ...]] = []
    for first in order[:_TRIED]:
        pairs = pairs_adding_up(effects, wanted - effects[first], allowed)
        found += [tuple(sorted((int(first), *pair))) for pair in pairs if first not in pair]
    for first in order[:_BESIDE]:
        both = _in_products(line, effects, wanted - effects[first])
        found += [tuple(sorted((int(first), *pair))) for pair in both if first not in pair]
    return _cheapest(line, found)


def one_after_another(line: Line) -> list[Mended]:
    """Three changes of what stands there: a plain one first, and two of the text that it leaves.

    What two of them do may depend on the third: each is tried in the text with the first.
    """
    study(line)
    at = {(c.start, c.end, c.new): k for k, c in enumerate(line.changes)}
    ranked = sorted(range(len(line.changes)), key=lambda k: line.changes[k].cost)
    plain = [k for k in ranked if line.changes[k].kind not in _TERMS]
    found: list[tuple[int, ...]] = []
    for k in plain[: _NOTED // max(len(plain), 1)]:
        one = line.changes[k]
        if one.cost > _PLAIN:
            break
        text = rewritten(line.source, (one,))
        longer = len(one.new) - (one.end - one.start)
        if text is None or one.everywhere or len(text) != len(line.source) + longer:
            continue
        then = replace(line, text=replace(line.text, text=text), places=[], changes=[], rows=[])
        for two in _pairs_of_what_stands(then):
            spans = [_before(then.changes[n], one, longer) for n in two]
            before = [at[span] for span in spans if span in at]
            if len(before) == len(two):
                found.append((k, *before))
    return sorted(_checked(line, _cheapest(line, found)), key=lambda m: m.cost)


def _pairs_of_what_stands(line: Line) -> list[tuple[int, ...]]:
    """Two changes of what stands there that may make a line right."""
    study_what_stands(line)
    if not line.rows:
        return []
    allowed = TOLERANCES.effect_matches * line.scale
    return _pairs(line, np.array(line.rows), line.target - line.root.value, allowed)


def right_with_two(line: Line) -> bool:
    """Whether two changes of what stands there make a line right."""
    return any(True for _one in _checked(line, _pairs_of_what_stands(line)))


def _before(change: Change, one: Change, longer: int) -> tuple[int, int, str]:
    """Where a change of a text is in the text before another one, which made it longer."""
    moved = longer if change.start >= one.start + len(one.new) else 0
    return change.start - moved, change.end - moved, change.new


def together(line: Line, changes: tuple[Change, ...]) -> list[Mended]:
    """Changes that were found one by one, as one repair, if they are."""
    line.changes += changes
    behind = len(line.changes)
    found = [tuple(range(behind - len(changes), behind))]
    done = list(_checked(line, found))
    del line.changes[behind - len(changes) :]
    return done


def _checked(line: Line, found: list[tuple[int, ...]], words: int = _LONG) -> Iterator[Mended]:
    """Those that really give the values wanted once they are written down.

    Three slips are believed of a formula with so many words.
    """
    seen: set[str] = set()
    for way in found:
        changes = tuple(sorted((line.changes[k] for k in way), key=lambda c: (c.start, c.end)))
        if _overlap(_nested(line.source, changes)) or _is_written_anew(line, way):
            continue
        text = rewritten(line.source, changes)
        if text is None or text in seen:
            continue
        seen.add(text)
        if (len(changes) > 2 and len(words_in(line.source)) < words) or not _same_formula(changes):
            continue
        values = replace(line.text, text=text).values(line.at)
        with np.errstate(all="ignore"):
            gap = np.max(np.abs(values - line.target))
        if gap <= TOLERANCES.effect_matches * line.scale:
            yield Mended(changes, text, _cost(changes))


def _is_written_anew(line: Line, way: Sequence[int]) -> bool:
    """Whether one of several changes puts all of the right formula in, and others take it away."""
    several = [k for k in way if k < len(line.rows)] if len(way) > 1 else []
    allowed = TOLERANCES.effect_matches * line.scale
    return any(
        line.changes[k].kind == "missing term"
        and float(np.max(np.abs(line.rows[k] - line.target))) <= allowed
        for k in several
    )


def _same_formula(changes: tuple[Change, ...]) -> bool:
    """Whether something of the formula is left: terms out and other terms in make any other."""
    return sum(c.kind in _TERMS for c in changes) < 3


def _nested(source: str, changes: Sequence[Change]) -> list[Change]:
    """The changes, with one that keeps a piece and one within that piece as one change."""
    wide = sorted(changes, key=lambda c: c.start - c.end)
    for k, outer in enumerate(wide):
        piece = source[outer.start : outer.end]
        if len(piece) < 2 or outer.everywhere:
            continue
        kept = [*re.finditer(rf"(?<!\w){re.escape(piece)}(?!\w)", outer.new)]
        if len(kept) != 1:
            continue  # Ia1 for a1 keeps no a1
        inner = [c for c in wide[k + 1 :] if outer.start <= c.start and c.end <= outer.end]
        others = [c for c in changes if c is not outer and c not in inner]
        if inner and not any(c.everywhere for c in inner) and not _overlap(inner):
            at = kept[0].start() - outer.start
            new = outer.new
            for c in sorted(inner, key=lambda c: -c.start):
                new = new[: at + c.start] + c.new + new[at + c.end :]
            return _nested(source, [*others, replace(outer, new=new)])
    return [*changes]


_NOUGHT = r"^\s*0(?:\.0*)?(?![\w.])\s*"


def rewritten(source: str, changes: tuple[Change, ...]) -> str | None:
    """The text with the changes in place; None where it is no formula any more."""
    text = source
    for change in sorted(_nested(source, changes), key=lambda c: (-c.start, -c.end)):
        before, behind = text[: change.start], text[change.end :]
        inside = before.rstrip().endswith("(") and behind.lstrip().startswith(")")
        new = change.new[1:-1] if inside and _in_parentheses(change.new) else change.new
        text = before + new + behind
    if any(change.new.startswith("-") for change in changes):
        text = _signs_in_front(text)
    text = re.sub(_NOUGHT, "", text) if re.fullmatch(_NOUGHT, source) else text
    text = re.sub(r"^\s*\+\s*", "", text.strip())
    text = re.sub(r"\(\s*\+\s*", "(", text)
    text = re.sub(r"(^|\()\s*-\s+", r"\1-", re.sub(r"  +", " ", text))
    try:
        ast.parse(text, mode="eval")
    except SyntaxError:
        return None
    return text


def _in_parentheses(text: str) -> bool:
    """Whether one pair of parentheses stands around all of it."""
    return text.startswith("(") and closes(text) == len(text) - 1


_INNER_SIGN = re.compile(r"[*/(]\s*-")


def _signs_in_front(text: str) -> str:
    """The text with a sign inside a product in front of its term: l2*-s12 as -l2*s12."""
    if not _INNER_SIGN.search(text):
        return text
    try:
        root = ast.parse(text, mode="eval").body
    except SyntaxError:
        return text
    above = {id(part): node for node in ast.walk(root) for part in ast.iter_child_nodes(node)}
    for node in ast.walk(root):
        if not isinstance(node, ast.UnaryOp) or not isinstance(node.op, ast.USub):
            continue
        term: ast.AST = node
        while is_product(above.get(id(term))):
            term = above[id(term)]
        at, start = node.col_offset, term.col_offset  # type: ignore[attr-defined]
        if at == start:
            continue
        bare = f"{text[:at]}{text[at + 1 :].lstrip()}"
        over = above.get(id(term))
        if is_sum(over) and over.right is term:
            sign = max(text.rfind("+", 0, start), text.rfind("-", 0, start))
            turned = {"+": "-", "-": "+"}[text[sign]]
            return _signs_in_front(f"{text[:sign]}{turned}{bare[sign + 1 :]}")
        if text[start] == "-":
            return _signs_in_front(bare[:start] + bare[start + 1 :].lstrip())
        return _signs_in_front(f"{bare[:start]}-{bare[start:]}")
    return text
