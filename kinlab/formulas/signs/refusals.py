"""What is said of a formula that cannot be read, in the language of the reader."""

from __future__ import annotations

from collections.abc import Iterable
from typing import Any

from kinlab.errors import ExpressionError, near
from kinlab.host.language import N_, _


def refused(place: str, sentence: str, **fields: Any) -> ExpressionError:
    """The error for a formula that cannot be read.

    Args:
        place: what to put in front of the sentence.
        sentence: marked with ``N_``, with fields.
        fields: what stands in them.
    """
    return ExpressionError(f"{place}: {_(sentence).format(**fields)}")


_NEAR = (
    ("did you mean ", N_("did you mean {names}")),
    ("choose one of ", N_("choose one of {names}")),
)


def near_names(name: str, valid: Iterable[str]) -> str:
    """What :func:`kinlab.errors.near` says, in the language of the reader."""
    told = near(name, valid)
    begins, sentence = next(one for one in _NEAR if told.startswith(one[0]))
    return _(sentence).format(names=told.removeprefix(begins))
