"""Equations that give an entry otherwise than by its name alone: ``tau2/m2 = ...``, ``-x = ...``.

The side with the entry is solved for it, where the entry stands there once and to the first power;
the other side stays as its writer typed it.
"""

from __future__ import annotations

import re
from collections.abc import Callable
from fractions import Fraction

from kinlab.errors import ExpressionError
from kinlab.formulas import tree, typeset
from kinlab.formulas.signs.refusals import refused
from kinlab.formulas.text import parse
from kinlab.formulas.tree import Node
from kinlab.formulas.typed import bare, is_latex, is_name, is_name_of, plain_formula
from kinlab.host.language import N_

_ENTRY = re.compile(r"\\?[A-Za-z]\w*\s*[\[(]\s*\d+\s*(?:,\s*\d+\s*)?[\])]")
"""An entry by its place: tau[0], M(1,2)."""
_NOTHING, _ONE = tree.num(0), tree.num(1)


def solved(text: str, entry: str, place: str) -> str:
    """A formula with its equation solved for the entry; what is none that may be solved stays.

    Args:
        text: as typed.
        entry: what it is asked for.
        place: for messages.

    Raises:
        ExpressionError: the entry stands on both sides, or not as one factor of one term.
    """
    sides = [side.strip("& ") for side in bare(text).split("=")]
    if len(sides) != 2 or any(not side or side[-1] in "<>!:" for side in sides):
        return text
    if any(is_name(side) or _ENTRY.fullmatch(side) for side in sides):
        return text
    latex = is_latex(text)
    nodes = [_read(side, latex) for side in sides]
    found = [(k, name) for k, node in enumerate(nodes) if (name := _entry_in(node, entry))]
    if not found:
        if _is_quotient(nodes[0]):
            raise refused(
                place, N_("the formula begins with {text} =, which is another"), text=sides[0][:40]
            )
        return text
    k, name = found[0]
    factor, rest = _linear(nodes[k], name)
    if len(found) > 1 or factor is None:
        raise refused(place, N_("write {entry} = ..., with {entry} nowhere else"), entry=entry)
    other = sides[1 - k]
    whole = _over(_less(other, rest, latex), factor, latex)
    return f"${whole}$" if latex else whole


def _read(side: str, latex: bool) -> Node:
    """The tree of a side; nothing of what cannot be read."""
    try:
        return parse(plain_formula(f"${side}$" if latex else side))
    except ExpressionError:
        return _NOTHING


def _is_quotient(node: Node) -> bool:
    """Whether a side is plainly no name: tau2/m2, 2*x."""
    factors = node.args if node.op == "mul" else ()
    return any(one.op == "pow" or (one.op == "num" and abs(one.value) != 1) for one in factors)


def _entry_in(node: Node, entry: str) -> str:
    """The entry's name in a side where it stands among other things; empty where it does not."""
    names = [name for name in sorted(tree.names(node)) if is_name_of(name, entry)]
    return names[0] if len(names) == 1 and node != tree.sym(names[0]) else ""


def _linear(node: Node, name: str) -> tuple[Node | None, Node]:
    """What a name is multiplied by, None where it is not to be had so; and the other terms."""
    mine = [term for term in node.terms if name in tree.names(term)]
    rest = tree.add(*(term for term in node.terms if name not in tree.names(term)))
    factors = mine[0].factors if len(mine) == 1 else ()
    others = [one for one in factors if one != tree.sym(name)]
    if len(others) != len(factors) - 1 or any(name in tree.names(one) for one in others):
        return None, rest
    return tree.mul(*others) if others else _ONE, rest


def _less(text: str, rest: Node, latex: bool) -> str:
    """A side as typed without terms that stand beside the entry on the other side."""
    if rest == _NOTHING:
        return text
    gone = tree.mul(tree.num(-1), rest)
    shown = map(_shown(latex), gone.terms)
    signs = [one if one[0] == "-" else f"+ {one}" for one in shown]
    return f"{text} {' '.join(signs)}" if text != "0" else " ".join(signs).lstrip("+ ")


def _over(text: str, factor: Node, latex: bool) -> str:
    """A side as typed, divided by what the entry is multiplied by."""
    inverse = tree.mul(*(tree.power(one, Fraction(-1)) for one in factor.factors))
    if inverse == _ONE:
        return text
    opened, closed = (r"\left(", r"\right)") if latex else ("(", ")")
    if inverse == tree.num(-1):
        return f"-{opened}{text}{closed}"
    sign = " " if latex else "*"
    return f"{_shown(latex)(inverse)}{sign}{opened}{text}{closed}"


def _shown(latex: bool) -> Callable[[Node], str]:
    return typeset.latex if latex else tree.to_text
