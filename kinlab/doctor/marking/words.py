"""What a student is told of a slip: its kind in words that hold no formula."""

from __future__ import annotations

import re
from collections.abc import Iterable

_WORDS = re.compile(r"[a-z]{3,}(?: [a-z]+){0,4}")
"""A kind that speaks for itself, and surely is no formula."""

KINDS: dict[str, str] = {
    "sign": "a sign is the other way",
    "factor": "a numerical factor is off",
    "coefficient": "the coefficient of a term is off",
    "power": "a power is off",
    "index": "an index is off",
    "parameter": "a parameter stands where another belongs",
    "argument": "the angle of a sine or cosine is off",
    "sin/cos": "sine and cosine are exchanged",
    "missing term": "a term is missing",
    "extra term": "a term does not belong there",
    "missing factor": "a factor is missing",
    "extra factor": "a factor does not belong there",
    "velocity for acceleration": "a velocity stands for an acceleration, or the reverse",
    "a sign": "a length of the table has the other sign",
    "d sign": "an offset of the table has the other sign",
    "alpha sign": "a twist of the table has the other sign",
    "table entry": "a number of the DH table is left out or another",
    "offset": "an offset of the DH table is left out",
    "row shift": "the rows of the DH table are shifted",
    "convention": "the DH table is read in the other convention",
    "tool": "the tool's transform is left out or inverted",
    "turning sense": "a joint is counted the other way round",
    "degrees": "degrees and radians are mixed",
    "absolute angles": "joint angles and angles from the base are mixed",
    "order": "the transforms are multiplied in another order",
    "slide as hinge": "a slide is treated as a hinge",
    "hinge as slide": "a hinge is treated as a slide",
    "slide left out": "a slide is left out",
    "joint order": "the joints are counted from the tool",
    "frame": "the frame or the point it refers to is another",
    "inverse": "it is the inverse of what is asked",
    "inverse for transpose": "an inverse stands for a transpose",
    "transposed": "it is transposed",
    "rotation transposed": "the rotation is transposed",
    "column sign": "a column has the other sign",
    "column half": "a column is half as large",
    "column twice": "a column is twice as large",
    "column zero": "a column is left out",
    "row sign": "an entry has the other sign",
    "row half": "an entry is half as large",
    "row twice": "an entry is twice as large",
    "row zero": "an entry is left out",
    "rows swapped": "entries are exchanged",
    "row order": "the rows are in another order",
    "gravity axis": "gravity points along another axis",
    "gravity left out": "gravity is left out",
    "gravity sign": "gravity has the other sign",
    "centre": "the distance of a centre of mass is another",
    "centre's frame": "a centre of mass is measured in another frame",
    "inertia frame": "an inertia tensor is taken in another frame",
    "inertia left out": "an inertia tensor is left out",
    "inertia point": "an inertia is about another point",
    "gyroscopic term": "the gyroscopic term is left out",
    "rotor inertia": "the rotors' inertia is left out",
    "mass": "a mass is counted otherwise",
    "mass left out": "a mass is left out",
    "link left out": "a link is left out",
    "Coriolis split": "the Coriolis terms are split otherwise",
    "Coriolis terms": "the Coriolis products are counted otherwise",
    "symmetric Coriolis": "the symbols are not Christoffel's",
    "centrifugal terms": "the centrifugal terms are left out",
    "Mdot for C": "the rate of M stands for C",
    "velocity terms factor": "the velocity terms have another factor",
    "velocity terms sign": "the velocity terms have the other sign",
    "velocity left out": "the velocity terms are left out",
    "velocity sign": "a velocity has the other sign",
    "acceleration left out": "the acceleration terms are left out",
    "acceleration sign": "the acceleration has the other sign",
    "wrench sign": "the wrench has the other sign",
    "wrench order": "force and moment are exchanged",
    "force left out": "the force is left out",
    "moment left out": "the moment is left out",
    "other": "a known confusion",
    "unknown": "the cause is not known",
    "rounded": "numbers are rounded",
    "unusual": "written unusually",
}
"""Kinds of slips, as a sheet may name them, with what is said of them."""


def _phrase(kind: str) -> str:
    named = kind if _WORDS.fullmatch(kind) else KINDS["other"]
    return KINDS.get(kind, named)


def told(kinds: Iterable[str]) -> str:
    """Kinds of slips as one phrase."""
    phrases = dict.fromkeys(_phrase(kind) for kind in kinds)
    return "; ".join(phrases)
