"""What a check was asked to judge and could not: it is listed with its reason, the rest goes on."""

from __future__ import annotations

from dataclasses import dataclass

from kinlab.errors import KinlabError


@dataclass(frozen=True)
class Unread:
    """Something that was not judged.

    Attributes:
        what: the argument, or the file and what in it: ``"mine.py: weight"``.
        problem: why.
    """

    what: str
    problem: KinlabError

    @property
    def reason(self) -> str:
        """Why, in one line, without the words that ``what`` says already."""
        text = " ".join(str(self.problem).split())
        return text.removeprefix(f"{self.what}: ").removeprefix(f"{self.what.split(': ')[0]}: ")
