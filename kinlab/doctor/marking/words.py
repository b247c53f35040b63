"""What a student is told of a slip: its kind in words that hold no formula."""

from __future__ import annotations

import re
from collections.abc import Iterable

from kinlab.host.language import N_, _

_WORDS = re.compile(r"[a-z]{3,}(?: [a-z]+){0,4}")
"""A kind that speaks for itself, and surely is no formula."""

KINDS: dict[str, str] = {
    N_("sign"): N_("a sign is the other way"),
    N_("factor"): N_("a numerical factor is off"),
    N_("coefficient"): N_("the coefficient of a term is off"),
    N_("power"): N_("a power is off"),
    N_("index"): N_("an index is off"),
    N_("parameter"): N_("a parameter stands where another belongs"),
    N_("argument"): N_("the angle of a sine or cosine is off"),
    N_("sin/cos"): N_("sine and cosine are exchanged"),
    N_("missing term"): N_("a term is missing"),
    N_("extra term"): N_("a term does not belong there"),
    N_("missing factor"): N_("a factor is missing"),
    N_("extra factor"): N_("a factor does not belong there"),
    N_("velocity for acceleration"): N_("a velocity stands for an acceleration, or the reverse"),
    N_("a sign"): N_("a length of the table has the other sign"),
    N_("d sign"): N_("an offset of the table has the other sign"),
    N_("alpha sign"): N_("a twist of the table has the other sign"),
    N_("table entry"): N_("a number of the DH table is left out or another"),
    N_("offset"): N_("an offset of the DH table is left out"),
    N_("row shift"): N_("the rows of the DH table are shifted"),
    N_("convention"): N_("the DH table is read in the other convention"),
    N_("tool"): N_("the tool's transform is left out or inverted"),
    N_("turning sense"): N_("a joint is counted the other way round"),
    N_("degrees"): N_("degrees and radians are mixed"),
    N_("absolute angles"): N_("joint angles and angles from the base are mixed"),
    N_("order"): N_("the factors of a product stand in another order"),
    N_("slide as hinge"): N_("a slide is treated as a hinge"),
    N_("hinge as slide"): N_("a hinge is treated as a slide"),
    N_("slide left out"): N_("a slide is left out"),
    N_("joint order"): N_("the joints are counted from the tool"),
    N_("frame"): N_("the frame or the point it refers to is another"),
    N_("inverse"): N_("an inverse is taken or left out where it should not be"),
    N_("inverse for transpose"): N_("an inverse stands for a transpose"),
    N_("transposed"): N_("it is transposed"),
    N_("rotation transposed"): N_("the rotation is transposed"),
    N_("column sign"): N_("a column has the other sign"),
    N_("column half"): N_("a column is half as large"),
    N_("column twice"): N_("a column is twice as large"),
    N_("column zero"): N_("a column is left out"),
    N_("row sign"): N_("an entry has the other sign"),
    N_("row half"): N_("an entry is half as large"),
    N_("row twice"): N_("an entry is twice as large"),
    N_("row zero"): N_("an entry is left out"),
    N_("rows swapped"): N_("entries are exchanged"),
    N_("row order"): N_("the rows are in another order"),
    N_("gravity axis"): N_("gravity points along another axis"),
    N_("gravity left out"): N_("gravity is left out"),
    N_("gravity sign"): N_("gravity has the other sign"),
    N_("centre"): N_("the distance of a centre of mass is another"),
    N_("centre's frame"): N_("a centre of mass is measured in another frame"),
    N_("inertia frame"): N_("an inertia tensor is taken in another frame"),
    N_("inertia left out"): N_("an inertia tensor is left out"),
    N_("inertia point"): N_("an inertia is about another point"),
    N_("parallel-axis term"): N_("the parallel-axis term is left out"),
    N_("loop"): N_("a loop begins or ends at another link"),
    N_("direction"): N_("a loop, or a sum, runs the other way"),
    N_("products' signs"): N_("products of inertia have the other sign"),
    N_("gyroscopic term"): N_("the gyroscopic term is left out"),
    N_("rotor inertia"): N_("the rotors' inertia is left out"),
    N_("mass"): N_("a mass is counted otherwise"),
    N_("mass left out"): N_("a mass is left out"),
    N_("link left out"): N_("a link is left out"),
    N_("Coriolis split"): N_("the Coriolis terms are split otherwise"),
    N_("Coriolis terms"): N_("the Coriolis products are counted otherwise"),
    N_("symmetric Coriolis"): N_("the symbols are not Christoffel's"),
    N_("centrifugal terms"): N_("the centrifugal terms are left out"),
    N_("Mdot for C"): N_("the rate of M stands for C"),
    N_("velocity terms factor"): N_("the velocity terms have another factor"),
    N_("velocity terms sign"): N_("the velocity terms have the other sign"),
    N_("velocity left out"): N_("the velocity terms are left out"),
    N_("velocity sign"): N_("a velocity has the other sign"),
    N_("acceleration left out"): N_("the acceleration terms are left out"),
    N_("acceleration sign"): N_("the acceleration has the other sign"),
    N_("wrench sign"): N_("the wrench has the other sign"),
    N_("wrench order"): N_("force and moment are exchanged"),
    N_("force left out"): N_("the force is left out"),
    N_("moment left out"): N_("the moment is left out"),
    N_("parentheses"): N_("parentheses are missing, or stand elsewhere"),
    N_("number"): N_("a number is off"),
    N_("name"): N_("a name stands where another belongs"),
    N_("function"): N_("a function stands where another belongs"),
    N_("sum"): N_("a sum forgets what was there before"),
    N_("axes"): N_("a vector is in the axes of another frame"),
    N_("order of lines"): N_("a line stands too early or too late"),
    N_("extra statement"): N_("a line is one too many"),
    N_("condition"): N_("a condition is off"),
    N_("entries swapped"): N_("two entries are exchanged"),
    N_("another term"): N_("a term stands where another belongs"),
    N_("names exchanged"): N_("two names are exchanged"),
    N_("columns swapped"): N_("two columns are exchanged"),
    N_("reversed"): N_("numbers stand in the reverse order"),
    N_("shifted"): N_("numbers stand one place on"),
    N_("whole division"): N_("a division leaves the remainder out"),
    N_("missing statement"): N_("a line is missing"),
    N_("missing argument"): N_("an argument is missing"),
    N_("aliased"): N_("an array is changed in place where a copy is meant"),
    N_("too deep"): N_("a line stands in a block and belongs behind it"),
    N_("not deep enough"): N_("a line stands behind a loop or condition and belongs in it"),
    N_("operator"): N_("a sum stands for a product, or a product for a sum"),
    N_("in the loop"): N_("a line stands in a loop and belongs before it"),
    N_("before the loop"): N_("a line stands before a loop and belongs in it"),
    N_("rows"): N_("other rows or columns are taken"),
    N_("product"): N_("a product of matrices and one of entries are mixed"),
    N_("cross product"): N_("the cross product and the dot product are exchanged"),
    N_("kind of joint"): N_("a slide is treated as a hinge, or a hinge as a slide"),
    N_("missing entry"): N_("an entry is not set"),
    N_("missing matrix"): N_("a product with a matrix is missing"),
    N_("other"): N_("a known confusion"),
    N_("unknown"): N_("the cause is not known"),
    N_("rounded"): N_("numbers are rounded"),
    N_("unusual"): N_("written unusually"),
}
"""Kinds of slips, as a sheet may name them, with what is said of them."""

OTHERS = (
    N_("centripetal term"), N_("tangential term"), N_("tensor not rotated"),
    N_("tensor transposed"), N_("own joint"), N_("theta sign"),
    N_("products of inertia"), N_("Christoffel"), N_("unread"), N_("missing entries"),
    N_("another quantity"), N_("exchanged"), N_("rotation left out"),
    N_("rotated twice"), N_("only one term"), N_("no value"), N_("gravity added"),
    N_("arguments exchanged"), N_("quadrant"), N_("supplementary angle"), N_("root"),
    N_("branches mixed"), N_("constant angle"), N_("singular matrix"), N_("one number"),
)  # fmt: skip
"""Kinds that a sheet cannot name: steps of the textbooks' derivations, and what is no slip."""


_SAID = {
    **KINDS,
    "unread": N_("could not be read"),
    "missing entries": N_("entries are missing"),
    "fault": N_("kinlab itself failed"),
    "no value": N_("it gives zero everywhere, or no number"),
}


_LISTED = re.compile(
    r"('[^'\n]{1,40}'(?:\s?[,，、]\s?'[^'\n]{1,40}'){5})(?:\s?[,，、]\s?'[^'\n]{1,40}')+(?:\s*\.\.\.)?"
)
_SYMBOLS = re.compile(r"([;；,，]\s*)((?:or|或)?[^;；,，]*)\[symbols\][^;；,，]*")


def for_student(problem: str) -> str:
    """Why a formula cannot be read, as a student needs it: six names, and nothing of [symbols].

    Args:
        problem: as it is said of a file of formulas.
    """
    problem = _LISTED.sub(r"\1 ...", problem.removeprefix("expression: "))
    explain = _("or explain it on a line of its own: name = formula")

    def instead(found: re.Match[str]) -> str:
        return f"{_('; ')}{explain}" if found[2].startswith(("or", "或")) else ""

    return _SYMBOLS.sub(instead, problem).replace("[symbols]", _("the lines that explain names"))


def _phrase(kind: str) -> str:
    named = kind if _WORDS.fullmatch(kind) else KINDS["other"]
    return _(_SAID.get(kind, named))


def told(kinds: Iterable[str]) -> str:
    """Kinds of slips as one phrase."""
    phrases = dict.fromkeys(_phrase(kind) for kind in kinds)
    return _("; ").join(phrases)
