"""What a report shows of a formula that was taken apart: plain words, LaTeX and numbers.

The doctor, which stands above this package, fills it in.
"""

from __future__ import annotations

from dataclasses import dataclass, field
from typing import Any

Typeset = tuple[str, str]
"""A name and a formula, both as LaTeX."""


@dataclass(frozen=True)
class Finding:
    """One judged formula, or several that were judged together.

    Attributes:
        title: the entries' names, or the function's.
        source: the file.
        quantity, robot: what it was compared with.
        agrees: whether it is the engine's, to rounding.
        known: whether what is wrong is known.
        sentence: the verdict or diagnosis in one sentence.
        error_before, error_after: relative error as written, and once repaired.
        others: what explains the difference equally well.
        evidence: the worst entry and state where the cause is unknown.
        given, corrected: the formulas as written, and as they should be where that is known.
        text: everything, in plain lines.
        data: everything, for machines.
    """

    title: str
    source: str
    quantity: str
    robot: str
    agrees: bool
    known: bool
    sentence: str
    error_before: float
    error_after: float | None = None
    others: tuple[str, ...] = ()
    evidence: tuple[str, ...] = ()
    given: tuple[Typeset, ...] = ()
    corrected: tuple[Typeset, ...] = ()
    text: str = field(default="", repr=False)
    data: dict[str, Any] = field(default_factory=dict, repr=False)

    @property
    def verdict(self) -> str:
        """``"agrees"``, ``"differs"`` or ``"differs, cause unknown"``."""
        if self.agrees:
            return "agrees"
        return "differs" if self.known else "differs, cause unknown"
