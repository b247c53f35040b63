"""Slips one after another, in the order in which a program runs into them.

Of a program with several slips the statement to look at first is one that is wrong though all its
parts are right. An edit with which it gives what a textbook has stands from then on, and shows the
next such statement: three slips of a recursion take three looks, not all threes of edits.
"""

from __future__ import annotations

from kinlab.doctor.program.grounds.suspects import behind, suspects
from kinlab.doctor.program.places import DATA, ProgramEdit, changed
from kinlab.doctor.program.search.repair import LineSearch, ProgramRepair
from kinlab.doctor.program.several.effects import Effects, Way
from kinlab.doctor.program.several.two_of_one import TwoOfOne
from kinlab.doctor.program.several.witnesses import FirstStep, Witnesses
from kinlab.doctor.program.trial import NoProgramError

_SLIPS = 4
"""Edits that may stand."""
_BESIDE = 2
"""Edits that stand beside which one more is looked for, and fewer for two more."""
_WAYS, _TRIED = 2, 12
"""Edits from which is gone on at first, and of which it is looked whether all is right."""
_EACH = 14_000_000
"""Work for one look."""
_FARTHER = 0.12
"""How much likelier an edit is of a statement that is wrong by what it is made of."""
_TWO = 24_000_000
"""Work for two edits that are a step together."""
_LOOKING = 700_000
"""What watching a program anew amounts to, beside running it."""


class InOrder:
    """The search for one slip after another.

    Args:
        search: whose single edits were tried already.
        known: what they do to the answer: one of each effect is enough.
        most: operations that may be done.

    Attributes:
        reached: the edits that were gone on from: two, one, and then others, more at the end.
    """

    def __init__(self, search: LineSearch, known: Effects, most: int) -> None:
        self.search, self.left = search, most
        self.of_two = _TWO if most else 0
        self.reached: list[Way] = []
        self.firsts = [edits[0] for edits in known.alike]
        self.like_others = [edit for edits in known.alike for edit in edits[1:]]
        others = {*self.like_others}
        self.edits = [edit for edit, _values in search.tried if edit not in others]

    def found(self) -> ProgramRepair | None:
        """The edits that make the program right, if the last of them does."""
        repair = self._from((), set())
        # beside two one more is looked for; a third that is not the last is rather none
        self.reached.sort(key=lambda way: (len(way) > _BESIDE, -len(way)))
        alone = next((k for k, way in enumerate(self.reached) if len(way) == 1), 0)
        if alone > 1:  # all of two may have the same wrong second one
            self.reached.insert(1, self.reached.pop(alone))
        return repair

    def _from(self, stand: Way, before: set[int]) -> ProgramRepair | None:
        """What makes it right beside edits that stand.

        Args:
            stand: the edits.
            before: what was suspected already before the last of them.
        """
        steps, suspected = self._steps(stand, before)
        ways = [(*stand, *step.edits) for step in steps]
        for way in ways[:_TRIED]:
            repair = self._verdict(way)
            if repair is not None:
                return repair
        for way in ways[: _WAYS if len(stand) < _WAYS else 1]:
            repair = self._from(way, suspected) if len(way) < _SLIPS else None
            if repair is not None:
                return repair
        return None

    def _verdict(self, way: Way) -> ProgramRepair | None:
        try:
            with changed(self.search.trial, way):
                return self.search.verdict((*self.search.stand, *way))
        except NoProgramError:
            return None

    def _steps(self, stand: Way, before: set[int]) -> tuple[list[FirstStep], set[int]]:
        """Edits of what is suspected with which more of the program is right, and what that is.

        What an edit that stands has brought under suspicion is looked at first.
        """
        search = self.search
        if self.left <= 0:
            return [], before
        if stand and {*stand} not in map(set, self.reached):
            self.reached.append(stand)
        try:
            with changed(search.trial, stand):
                here = search.beside((*search.stand, *stand))
                here.look_again()
                self.left -= _LOOKING
                suspected = behind(here.trial, here.observed, here.known)
                placed = {id(change.holder) for edit in stand for change in edit.changes}
                every = self.edits if stand else self.firsts
                wrong = suspects(here.trial, here.observed, here.known)
                # what does the same to the answer may be in another statement: in that which is
                # wrong by what it is made of, which comes before what may have a share in it
                alike = [x for x in self.like_others if id(x.node) in wrong]
                some = [x for x in every if id(x.node) in suspected and not _at(x, placed)]
                some += [x for x in alike if not _at(x, placed)]
                some.sort(key=lambda x: here.likely(x) + _FARTHER * (id(x.node) not in wrong))
                new = [x for x in some if id(x.node) not in before]
                old = [x for x in some if id(x.node) in before]
                # what is made of wrong numbers alone is wrong by nothing else
                data = [x for x in every if self._is_of_data(x)]
                steps: list[FirstStep] = []
                for few in (new, old, data):
                    steps += self._looked(here, few)
                    if any(step.whole for step in steps):
                        break
                if not any(step.whole for step in steps) and len(stand) < _BESIDE:
                    steps = self._looked_at_two(here, some) or steps
                steps.sort(key=lambda step: (not step.whole, step.cost))
        except NoProgramError:
            return [], before
        return steps, suspected

    def _looked_at_two(self, here: LineSearch, some: list[ProgramEdit]) -> list[FirstStep]:
        """Two of some edits that are a step together: a statement may have two slips."""
        two = TwoOfOne(here, some, self.of_two)
        steps: list[FirstStep] = []
        for pairs in two.pairs():
            witnesses = Witnesses(here)
            steps = witnesses.steps(pairs, self.of_two)
            self.of_two -= witnesses.done
            self.search.work.done += witnesses.done
            if steps:
                break
        self.of_two -= two.done
        self.search.work.done += two.done
        return steps

    def _is_of_data(self, edit: ProgramEdit) -> bool:
        parts = self.search.trial.program.parts
        return edit.part == DATA or bool(parts[edit.part].sets)

    def _looked(self, here: LineSearch, some: list[ProgramEdit]) -> list[FirstStep]:
        """Those of some edits that are a step."""
        if not some:
            return []
        witnesses = Witnesses(here)
        steps = witnesses.steps([(edit,) for edit in some], min(self.left, _EACH))
        self.left -= witnesses.done
        self.search.work.done += witnesses.done
        return steps


def _at(edit: ProgramEdit, placed: set[int]) -> bool:
    return any(id(change.holder) in placed for change in edit.changes)
