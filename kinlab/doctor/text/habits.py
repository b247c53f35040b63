"""Names by habit: ``L1`` for l1, ``lc1`` for half of it, ``t1`` for an angle, ``d3`` of a slide.

A name that the writer explains nowhere is read so where the robot has no such name and nothing else
can be meant. ``M12`` in another formula is the formula that the file gives it.
"""

from __future__ import annotations

import re
from dataclasses import replace

from kinlab.doctor.changes import Mechanism
from kinlab.doctor.linkages import five_bar
from kinlab.doctor.text.claims import claimed_of, with_wrench
from kinlab.fivebar import FiveBar
from kinlab.formulas import tree
from kinlab.formulas.files import FormulaFile
from kinlab.formulas.signs.refusals import refused
from kinlab.formulas.text import canonical, parse
from kinlab.formulas.tree import Node
from kinlab.host.language import N_
from kinlab.model.dh import DHTable
from kinlab.symbolic.vocabulary import Linear, vocabulary

_INDEXED = re.compile(r"([A-Za-z]+)(\d*)")
_MOTION = re.compile(r"q(d{0,2})\d+")
_SEVERAL = re.compile(r"(q|qd|qdd|dq|ddq)([1-9]{2,})")
_SLIDES = (
    ("d{k}",),
    ("dd{k}", "d{k}dot", "ddot{k}", "d{k}d", "d{k}_dot"),
    ("ddd{k}", "d{k}ddot", "dddot{k}", "d{k}dd", "d{k}_ddot"),
)
_SUMMED = re.compile(r"phi_?(\d) *\+ *phi_?\d")
_OF_CENTRE = re.compile(r"I(?:C|c|G|S|cm)(\d)")
"""I_{C_1} and I_{G1}: the inertia about the centre of mass, which the robot's I1 is."""
_FIRST = {"w1": "qd1", "alpha1": "qdd1"}
"""Of the first link, which turns as its joint does; of others it may be the link or the joint."""
_ONLY = {"L": "l", "M": "m"}
"""Capitals of an arm of one link, where they are not the Lagrangian or the mass matrix."""
_MAY_MOVE = re.compile(r"a\d")
"""A length, or an acceleration."""
NOTHING = "0"
"""What a name of a book's stands for where the robot has none of it."""


def with_habits(file: FormulaFile, robot: Mechanism) -> FormulaFile:
    """The file with a meaning for each name that has one by habit.

    Args:
        file: the formulas.
        robot: whose they are.
    """
    if isinstance(robot, FiveBar):
        return five_bar.with_habits(file, robot)
    if robot.table is None:
        return file
    file = _with_entries(file)
    named = vocabulary(robot.table)
    words = set(named.values)
    nodes = (*file.formulas.values(), *file.symbols.values())
    used = {name for node in nodes for name in tree.names(node)}
    turning = {name for node in nodes for name in _in_functions(node)}
    motion = {f"q{'d' * k}{i + 1}" for k in range(3) for i in range(robot.n)}
    known = {name for name in used if tree.names(canonical(name)) <= motion}
    angles = {name for name in known if _positions(canonical(name))}
    rates = any(str(canonical(name)).startswith("qdd") for name in known)
    slides = _of_slides(robot.table)
    claims = {entry: with_wrench(file, claimed_of(entry, robot)) for entry in file.formulas}
    torques = [entry for entry, name in claims.items() if name.startswith("inverse_dynamics")]
    arrays = _of_arrays(file, known, bool(torques))
    summed = any(_SUMMED.search(text) for text in file.texts.values())
    solved = any(name.startswith("forward_dynamics") for name in claims.values())
    given = {f"tau{i + 1}" for i in range(robot.n)} if solved else set()
    new: dict[str, str] = {}
    for name in sorted(used - words - known - {*file.symbols}):
        plain = name.replace("_", "")
        free = motion if not angles else set()
        found = arrays.get(plain) or slides.get(plain)
        found = found or _by_letter(plain, words, used, free, summed)
        if _MAY_MOVE.fullmatch(plain) and plain not in arrays and not rates:
            _refuse_unclear(name, file, torques)
        if not found and plain in _FIRST and name not in turning:
            found = _FIRST[plain]
        found = found or _of_several(plain, robot.n)
        centre = _OF_CENTRE.fullmatch(plain)
        if not found and centre and (own := f"I{centre[1]}") not in used:
            found = own if own in words else as_text(named.others.get(own, ()))
            found = "" if own not in words and own not in named.others else found
        if not found and plain[0] == "L" and (own := plain.lower()) in named.others:
            found = as_text(named.others[own])  # L3 of l3, where that is the tool's
        if not found and robot.n == 1:  # m and l of the only link
            alone = f"{_ONLY.get(plain, plain)}1"
            if tree.names(canonical(alone)) <= motion | words | given:
                found = alone
            elif alone in named.others:
                found = as_text(named.others[alone])
        if found:
            new[name] = found
            continue
        for k in range(robot.n) if in_books(name) in named.others else ():
            alike = f"{name[:-1]}{k + 1}"  # lc2 may be meant where lc1 stands
            meant = named.others.get(in_books(alike))
            if meant is not None and alike not in words and alike not in file.symbols:
                new[alike] = as_text(meant)
    symbols = file.symbols | {name: parse(value) for name, value in new.items()}
    return replace(file, symbols=symbols, symbol_texts=file.symbol_texts | new)


def in_books(name: str) -> str:
    """A name as :attr:`Vocabulary.others` has it: lc1 for Lc_1."""
    return name.replace("_", "").replace("Lc", "lc")


def as_text(total: Linear) -> str:
    """A sum of multiples of names as one types it."""
    parts = (word if factor == 1 else f"{factor}*{word}" for factor, word in total)
    return " + ".join(parts) or NOTHING


def _of_several(plain: str, joints: int) -> str:
    """q1 + q2 for q12, where no joint 12 is."""
    found = _SEVERAL.fullmatch(plain)
    if found is None or joints > 9 or found[2] not in "123456789" or int(found[2][-1]) > joints:
        return ""
    head = f"q{'d' * found[1].count('d')}"
    return " + ".join(f"{head}{k}" for k in found[2])


def _of_arrays(file: FormulaFile, known: set[str], moved: bool) -> dict[str, str]:
    """v[0] and a[0] beside q[0], the arguments of a function of the state, for its rates.

    Of what does not depend on accelerations a[0] is none.
    """
    typed = " ".join(file.as_typed.values())
    rates = {str(node.value)[:-1] for node in map(canonical, known) if node.op == "sym"}
    return {
        f"{letter}{k}": f"{rate}{k}"
        for letter, rate in (("v", "qd"), ("a", "qdd"))[: 1 + moved]
        if rate not in rates and all(re.search(rf"(?<!\w){x}\[", typed) for x in ("q", letter))
        for k in range(1, 10)
    }


def _of_slides(table: DHTable) -> dict[str, str]:
    """d3 and its rates for q3 where joint 3 slides."""
    joints = [k for k, link in enumerate(table.links, 1) if link.joint == "prismatic"]
    return {
        way.format(k=k): f"q{'d' * n}{k}" for k in joints for n in range(3) for way in _SLIDES[n]
    }


def _by_letter(plain: str, words: set[str], used: set[str], angles: set[str], summed: bool) -> str:
    """The robot's name, or the angle, that a letter with an index is."""
    alike = [word for word in words if word.lower() == plain.lower()]
    if alike:
        return alike[0] if len(alike) == 1 and alike[0] not in used else ""
    found = _INDEXED.fullmatch(plain)
    if found is None or not found[2]:
        return ""
    length, angle = f"l{found[2]}", f"q{found[2]}"
    if found[1] == "a" and length in words - used:
        return length
    joint = found[1] == "t" or (found[1] == "phi" and summed)  # phi2 alone may be q1 + q2
    return angle if joint and angle in angles else ""


def _refuse_unclear(name: str, file: FormulaFile, torques: list[str]) -> None:
    """Refuses a1 in a torque without accelerations: it may be a length, or one of these.

    Raises:
        ExpressionError: the name, and what to write.
    """
    for entry in torques:
        if name in tree.names(file.formulas[entry]):
            raise refused(
                f"{file.path}: {entry}",
                N_("{name!r} may be a length or an acceleration; write l{joint} or qdd{joint}"),
                name=name,
                joint=name[-1],
            )


def _positions(node: Node) -> bool:
    return any((found := _MOTION.fullmatch(n)) and not found[1] for n in tree.names(node))


def _in_functions(node: Node) -> set[str]:
    """The names that stand in a function: an angle, and no rate."""
    return {
        name
        for _path, one in tree.nodes(node)
        if one.op in tree.FUNCTIONS
        for name in tree.names(one)
    }


def _with_entries(file: FormulaFile) -> FormulaFile:
    """The file with M12 in other formulas as what it is there; M21 = M12 is M12's own line."""
    entries = {n for n, node in file.formulas.items() if node.op != "sym" or node.value == n}
    free = {
        name
        for node in file.formulas.values()
        for name in tree.names(node)
        if name in entries - {*file.symbols} and canonical(name) == tree.sym(name)
    }
    same = {
        n: str(node.value)
        for n, node in file.formulas.items()
        if node.op == "sym" and node.value in free
    }
    return replace(
        file,
        formulas=file.formulas | {n: file.formulas[other] for n, other in same.items()},
        texts=file.texts | {n: file.texts[other] for n, other in same.items()},
        as_typed=file.as_typed | {n: file.as_typed[other] for n, other in same.items()},
        symbols=file.symbols | {n: file.formulas[n] for n in free},
        symbol_texts=file.symbol_texts | {n: file.texts[n] for n in free},
    )
