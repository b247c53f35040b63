"""Names of branches: shoulder, elbow, wrist, after Lee and Ziegler (1984), from the geometry.

- shoulder ``right`` / ``left``: turning joint 2 forwards lifts (lowers) the wrist along axis 1;
  ``over`` where it does neither. The wrist is the point where the last three axes meet, with
  three parallel axes the point of axis 6, for three joints the tool, else the fourth axis;
- elbow ``up`` / ``down``: joint 3 lies above (below) the line from joint 2 to the wrist (with
  three parallel axes: to joint 4), seen along axis 2, up meaning along axis 1; where axes 1 and
  2 are parallel ``left`` / ``right``, the way joint 2 bends the arm seen against axis 1, and no
  shoulder;
- wrist ``no flip`` / ``flip``: the sign of (z4 x z5) . z6; ``aligned`` where it vanishes.

An arm with more branches than these words can tell apart gets ``#1``, ``#2``, ... behind equal
names, in the order of q.
"""

from __future__ import annotations

from collections.abc import Iterable, Sequence

import numpy as np

from kinlab.errors import NameUnknownError
from kinlab.inverse.branches.closed_forms import PARALLEL
from kinlab.inverse.branches.structures import PLANE, Form

_SHOULDER, _ELBOW = ("left", "over", "right"), ("down", "straight", "up")
_BEND, _WRIST = ("right", "straight", "left"), ("flip", "aligned", "no flip")


def words_of(form: Form) -> tuple[str, ...]:
    """The name of each of the 27 codes of :func:`~kinlab.inverse.branches.rows.posture`."""
    bent = form.family == PLANE or (
        form.real > 1 and bool(np.hypot(form.arm_fixed[1, 2], form.arm_fixed[1, 6]) < PARALLEL)
    )
    names = []
    for code in range(27):
        shoulder, elbow, wrist = code // 9, code // 3 % 3, code % 3
        words = []
        if form.family != PLANE and form.real < 3:
            names.append("")
            continue
        if bent:
            words.append(f"elbow {_BEND[elbow]}")
        else:
            words.append(f"shoulder {_SHOULDER[shoulder]}")
            if not form.arm_prismatic[2]:
                words.append(f"elbow {_ELBOW[elbow]}")
        if form.real == 6:
            words.append(f"wrist {_WRIST[wrist]}")
        names.append(", ".join(words))
    return tuple(names)


def distinct(names: Sequence[str]) -> tuple[str, ...]:
    """The same names, equal ones numbered."""
    if len(set(names)) == len(names):
        return tuple(names)
    total = {name: names.count(name) for name in names}
    seen: dict[str, int] = {}
    answer = []
    for name in names:
        seen[name] = seen.get(name, 0) + 1
        answer.append(f"{name} #{seen[name]}".strip() if total[name] > 1 else name)
    return tuple(answer)


def matching(branch: str, names: Iterable[str], where: str) -> list[int]:
    """Rows of the branches that a name means: all whose words it leaves open count.

    Args:
        branch: such as ``"shoulder left, elbow up"``; a whole name, or some of its words.
        names: those the pose has.
        where: in front of the message.

    Raises:
        NameUnknownError: none is meant; those the pose has are listed.
    """
    names = list(names)
    words = [word.strip() for word in str(branch).split(",") if word.strip()]
    rows = []
    for row, name in enumerate(names):
        plain, _, number = name.partition(" #")
        has = set(plain.split(", ")) | {name.split(", ")[-1]}
        if name == branch or (words and all(w in has or w == f"#{number}" for w in words)):
            rows.append(row)
    if not rows:
        have = ", ".join(repr(name) for name in names) or "none: it is out of reach"
        raise NameUnknownError(f"{where}: this pose has no branch {branch!r}; it has {have}")
    return rows
