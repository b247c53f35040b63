"""Joint positions as text: q1 = atan2(y, x) - ..., q2 = acos(...), each from the target's numbers.

One may stand on another (``s2`` is the sine of the ``q2`` that another line gives). A name such as
``elbow`` is +1 and then -1: two solutions.
"""

from __future__ import annotations

import re

import numpy as np

from kinlab.arrays import Array
from kinlab.check.quantities.inverse import TASKS
from kinlab.doctor.changes import Case
from kinlab.doctor.text.written import Written
from kinlab.formulas import tree
from kinlab.formulas.record import SIDES
from kinlab.formulas.signs.refusals import refused
from kinlab.host.language import N_
from kinlab.model.dh import DHTable
from kinlab.symbolic.vocabulary import is_planar, vocabulary

_JOINT = re.compile(r"(?:q|theta|th|d)_?([1-9])")
_POSE = (*(f"r{i}{j}" for i in "123" for j in "123"), "px", "py", "pz")


def joint_claimed(entry: str, table: DHTable | None) -> str:
    """The entry of an inverse kinematics that a name is, or ``""``: q2 of a planar 2R arm."""
    found = _JOINT.fullmatch(entry)
    if found is None or table is None:
        return ""
    third = "inverse_kinematics_xyphi" if is_planar(table) else "inverse_kinematics_xyz"
    names = {2: "inverse_kinematics_xy", 3: third, 4: "inverse_kinematics_xyzphi"}
    name = names.get(len(table.links), "inverse_kinematics")
    return f"{name}[{int(found[1]) - 1}]"


def given_names(entry: str, table: DHTable | None) -> tuple[str, ...]:
    """The names of the target's numbers, and of the branch, in an entry that is a joint's."""
    claimed = joint_claimed(entry, table)
    if not claimed:
        return ()
    arguments = TASKS[claimed.partition("[")[0]].arguments.split()
    return (*(_POSE if arguments == ["pose"] else arguments), *SIDES)


def joint_values(
    case: Case, formulas: dict[str, Written], titles: dict[str, str], path: str
) -> dict[str, Array]:
    """The values of every joint's text at the targets, (N, 1), or (N, 2) where a branch is named.

    Raises:
        ExpressionError: a joint without a text, or texts that stand on each other.
    """
    name, n = case.quantity.name, case.robot.n
    labels = [f"{name}[{k}]" for k in range(n)]
    for k, label in enumerate(labels):
        if label not in formulas:
            raise refused(
                path,
                N_(
                    "q{number} is missing; joint positions are judged together, by where they put "
                    "the tool"
                ),
                number=k + 1,
            )
    if len(formulas) > n:
        odd = next(label for label in formulas if label not in labels)
        raise refused(f"{path}: {titles[odd]}", N_("the arm has {n} joints"), n=n)
    used = {word for text in formulas.values() for word in tree.names(text.node)}
    sides = [side for side in SIDES if side in used]
    rows = [_row(case, formulas, labels, dict.fromkeys(sides, sign), path) for sign in (1.0, -1.0)]
    kept = rows if sides else rows[:1]
    return {label: np.stack([row[label] for row in kept], axis=1) for label in labels}


def _row(
    case: Case,
    formulas: dict[str, Written],
    labels: list[str],
    sides: dict[str, float],
    path: str,
) -> dict[str, Array]:
    at = named_values(case, sides)
    found: dict[str, Array] = {}
    while len(found) < len(labels):
        ready = [
            k
            for k, label in enumerate(labels)
            if label not in found and tree.names(formulas[label].node) <= set(at)
        ]
        if not ready:
            left = next(label for label in labels if label not in found)
            missing = tree.names(formulas[left].node) - set(at)
            odd = min(missing, key=lambda word: (bool(_JOINT.fullmatch(word)), word))
            raise refused(
                path,
                N_(
                    "{entry}: {odd} has no value from the target; joints that stand on each other "
                    "have none"
                ),
                entry=formulas[left].entry,
                odd=odd,
            )
        for k in ready:
            found[labels[k]] = at[f"q{k + 1}"] = formulas[labels[k]].values(at)
    return found


def named_values(case: Case, sides: dict[str, float]) -> dict[str, Array]:
    """What a joint's text may stand on but the other joints: (N,) by name."""
    count = len(next(iter(case.arguments.values())))
    words = vocabulary(case.robot.table).values if case.robot.table is not None else {}
    at = {word: np.full(count, value) for word, value in (words | sides).items()}
    for argument, stack in case.arguments.items():
        if argument != "pose":
            at[argument] = stack
            continue
        for i, j in np.ndindex(3, 3):
            at[f"r{i + 1}{j + 1}"] = stack[:, i, j]
        at |= {f"p{axis}": stack[:, i, 3] for i, axis in enumerate("xyz")}
    return at
