"""What the answer of a search rests on: what was searched, how often it was met, what is proved."""

from __future__ import annotations

from dataclasses import dataclass


@dataclass(frozen=True)
class Evidence:
    """What an answer of a search rests on; printed, one sentence.

    Attributes:
        searched: what was searched and how, in words: ``"352 starts within the joint limits"``.
        met: how often the answer was met independently; ``None`` where that has no meaning.
        tried: out of how many tries; ``None`` as above.
        proved: what is proved, up to rounding; empty: nothing.
        found: what is found and not proved; empty: nothing.
    """

    searched: str
    met: int | None = None
    tried: int | None = None
    proved: str = ""
    found: str = ""

    def __str__(self) -> str:
        parts = [f"searched: {self.searched}"]
        if self.met is not None:
            of = "" if self.tried is None else f" of {self.tried}"
            parts.append(f"met: {self.met}{of} times")
        parts.append(f"proved: {self.proved or 'nothing'}")
        if self.found:
            parts.append(f"found, not proved: {self.found}")
        return "; ".join(parts) + "."
