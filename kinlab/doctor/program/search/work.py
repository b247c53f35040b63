"""What trying edits of a program amounts to, in operations: the same on every machine."""

from __future__ import annotations

import ast

from kinlab.doctor.bytecode.syntax import nodes
from kinlab.doctor.program.observed import Observed, amounts
from kinlab.doctor.program.places import ProgramEdit
from kinlab.doctor.program.search.asked import Asked

_NODE = 30
"""What compiling one node amounts to."""
_ENDING, _LONGER = ast.While | ast.Break, 6
"""What ends when it is near enough, and how much longer it runs with an edit in it."""


class Work:
    """What running and compiling a program amounts to.

    Args:
        asked: the program, and what it should answer.
        observed: what its expressions were.

    Attributes:
        done: operations that were.
        amounts: those of a run in which a part, or the data, is another.
        nodes: how large each part is.
        longer: how many times as long a program may run with an edit in it.
    """

    def __init__(self, asked: Asked, observed: Observed) -> None:
        self.done = 0
        trees = asked.trial.trees
        self.amounts = amounts(asked.trial, observed, asked.states)
        self.nodes = [len(nodes(tree)) for tree in trees]
        ending = (isinstance(one, _ENDING) for tree in trees for one in nodes(tree))
        self.longer = _LONGER if any(ending) else 1
        self.first, self.watched = len(asked.first), len(asked.watched)

    def of(self, edit: ProgramEdit) -> int:
        """What running and compiling the program amounts to, to try an edit at the first states."""
        run = self.longer * self.amounts[edit.part] * self.first // self.watched
        return run + (_NODE * self.nodes[edit.part] if edit.part >= 0 else 0)

    def of_all(self, count: int) -> int:
        """What running the whole program at so many states amounts to."""
        return self.amounts[0] * count // self.watched
