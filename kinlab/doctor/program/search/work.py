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
_REACHED = 4
"""Which part of the turns that a loop may take it takes where an edit keeps it from ending."""


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
        loops = [one for tree in trees for one in nodes(tree) if isinstance(one, ast.For)]
        longest = max((_turns_left(one, observed) for one in loops), default=0)
        self.longer = max(_LONGER, longest // _REACHED) if any(ending) else 1
        if self.longer > 1:  # what begins otherwise is iterated anew, wherever it is changed
            self.amounts = dict.fromkeys(self.amounts, max(self.amounts.values()))
        self.first, self.watched = len(asked.first), len(asked.watched)

    def of(self, edit: ProgramEdit) -> int:
        """What running and compiling the program amounts to, to try an edit at the first states."""
        run = self.longer * self.amounts[edit.part] * self.first // self.watched
        return run + (_NODE * self.nodes[edit.part] if edit.part >= 0 else 0)

    def of_one_call(self, edit: ProgramEdit, calls: int) -> int:
        """What one of so many calls of a function at a state amounts to, to try an edit in it."""
        return self.of(edit) // max(1, self.first * calls)

    def of_all(self, count: int) -> int:
        """What running the whole program at so many states amounts to."""
        return self.amounts[0] * count // self.watched


def _turns_left(loop: ast.For, observed: Observed) -> int:
    """How many times as many turns as it took a loop may take that breaks off; 0 of others."""
    ends = any(isinstance(one, ast.Break) for one in nodes(loop))
    of = loop.iter.args[-1:] if isinstance(loop.iter, ast.Call) else []
    most, begun = (observed.of(of[0]) if ends and of else None), observed.of(loop.iter)
    body = [seen.count for one in nodes(loop) if (seen := observed.of(one)) is not None]
    if most is None or begun is None or not most.values or not most.whole or most.shape != ():
        return 0
    return int(max(map(float, most.values)) * begun.count // max(body, default=1))
