"""Where brackets are closed, and what stands outside of all of them."""

from __future__ import annotations

from collections.abc import Iterator

_OPENING, _CLOSING = "([{", ")]}"


def closes(text: str, start: int = 0, pairs: tuple[str, str] = (_OPENING, _CLOSING)) -> int:
    """Where the bracket at ``start`` is closed; -1 where it is not.

    Args:
        text: any.
        start: where the bracket is.
        pairs: the brackets that count, those that open and those that close.
    """
    opening, closing = pairs
    depth = 0
    for k in range(start, len(text)):
        depth += (text[k] in opening) - (text[k] in closing)
        if depth == 0:
            return k
    return -1


def outside(text: str) -> Iterator[tuple[int, str]]:
    """The characters that stand outside of all brackets, each with its place."""
    depth = 0
    for k, character in enumerate(text):
        depth += (character in _OPENING) - (character in _CLOSING)
        if depth == 0:
            yield k, character


def parts_at(text: str, signs: str) -> list[str]:
    """The text, cut at signs outside of all brackets."""
    cuts = [k for k, one in outside(text) if one in signs and text[k - 1 : k] != "\\"]
    pairs = zip([-1, *cuts], [*cuts, len(text)], strict=True)
    return [text[k + 1 : end].strip() for k, end in pairs]
