"""The names that may stand in a formula of an arm, and the angles made of them."""

from __future__ import annotations

from dataclasses import dataclass
from itertools import combinations

from kinlab.formulas import tree
from kinlab.formulas.tree import Node


@dataclass(frozen=True)
class Names:
    """The names that may stand in a formula.

    Attributes:
        parameters: l1, m1, g, ...
        n: number of joints.
        letters: which of q, qd, qdd the quantity depends on.
    """

    parameters: tuple[str, ...]
    n: int
    letters: tuple[str, ...]

    @property
    def angles(self) -> tuple[Node, ...]:
        """Sums of neighbouring joint positions, differences of two, and doubled ones.

        Joints that slide are among them: a wrong index may point at one.
        """
        joints = [tree.sym(f"q{i + 1}") for i in range(self.n)]
        sums = [
            tree.add(*joints[i:j])
            for i in range(len(joints))
            for j in range(i + 1, len(joints) + 1)
        ]
        differences = [tree.add(a, tree.mul(tree.num(-1), b)) for a, b in combinations(joints, 2)]
        gaps = [tree.add(a, b) for a, b in combinations(joints, 2)]
        twice = [tree.mul(tree.num(2), a) for a in joints]
        return tuple(dict.fromkeys([*sums, *gaps, *differences, *twice]))
