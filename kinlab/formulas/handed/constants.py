"""A free constant behind a potential: ``V = ... + const``, ``+ C``, ``+ V_0``."""

from __future__ import annotations

import re

from kinlab.host.language import _

_POTENTIALS = re.compile(r"[VUPL]|E_?p|potential(?:_energy)?|lagrangian")
_CONSTANT = (
    r"(?:\\(?:text|mathrm|textrm|operatorname)\s*\{\s*(?:const|Const|constant|konst)\.?\s*\}"
    r"|(?:const|Const|constant|konst)(?![A-Za-z])\.?|C(?:_?\{?0\}?)?(?![\w(])"
    r"|(?:[VUP]|E_?\{?p?\}?)_?\{?(?:0|ref|₀)\}?(?![\w(])|常数|常量)"
)
_AT_END = re.compile(
    rf"\s*\+\s*(?P<name>{_CONSTANT})\s*(?P<rest>\$*\s*(?:[,;.].*|其中.*)?)$", re.DOTALL
)
_MOST = 400
"""Letters behind a constant that may explain other names."""


def without_constant(text: str, entry: str) -> tuple[str, str]:
    """The text without a free constant of a potential, and what is to be said of it.

    Args:
        text: as typed.
        entry: what the formula is asked for; of others than a potential nothing is left out.
    """
    found = _AT_END.search(text) if _POTENTIALS.fullmatch(entry) else None
    if found is None or len(found["rest"]) > _MOST:
        return text, ""
    name = found["name"]
    word = re.sub(r"\\\w+|[\s{}.]", "", name) or name
    elsewhere = text[: found.start()].partition("=")[2] + " " + found["rest"]
    bare = re.sub(r"[{}\\]", " ", elsewhere)
    if re.search(rf"(?<![A-Za-z])(?:{re.escape(word)}|[Ss])(?!\w)", bare):  # S beside C is a sine
        return text, ""
    said = _("{name} is read as zero: a potential's zero is free").format(name=word)
    return text[: found.start()] + found["rest"], said
