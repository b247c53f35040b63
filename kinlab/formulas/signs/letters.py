"""Letters and signs of Unicode as plain text or LaTeX: ``θ̇₁²``, ``√``, ``½``, primes for dots."""

from __future__ import annotations

import re
import unicodedata

from kinlab.formulas.signs.refusals import refused
from kinlab.host.language import N_

BELOW = str.maketrans("₀₁₂₃₄₅₆₇₈₉", "0123456789")
ABOVE = str.maketrans("⁰¹²³⁴⁵⁶⁷⁸⁹", "0123456789")
WIDE = {code: chr(code - 0xFEE0) for code in range(0xFF01, 0xFF5F)}
WIDE |= {0x3000: " ", 0x3001: ",", 0x3002: ".", 0xA1: " ", 0xBF: " "}
"""Signs, digits and letters of a Chinese keyboard, and the plain ones."""
SIGNS = WIDE | str.maketrans(
    {"·": "*", "⋅": "*", "×": "*", "−": "-", "–": "-", "÷": "/", "√": " sqrt", "½": "(1/2)"}
)
_LETTERS = (
    "α alpha β beta γ gamma δ delta ε epsilon ϵ epsilon ζ zeta η eta θ theta ϑ theta ι iota "
    "κ kappa λ lambda μ mu ν nu ξ xi π pi ρ rho σ sigma τ tau υ upsilon φ phi ϕ phi χ chi ψ psi "
    "ω omega Γ Gamma Δ Delta Θ Theta Λ Lambda Ξ Xi Φ Phi Ψ Psi Ω Omega ℓ l"
)
_GREEK = dict(zip(_LETTERS.split()[::2], _LETTERS.split()[1::2], strict=True))
GREEK = tuple(dict.fromkeys(name for name in _GREEK.values() if name != "l"))
"""The names of Greek letters."""
_PRIMED = re.compile(r"(?<![A-Za-z])(q|th|theta|θ)(_?[\d₀-₉]+)('{1,2}|′{1,2}|″)(?!')")
"""θ1' and q2'', the rates of a joint."""
_DOTTED = re.compile(r"([A-Za-zα-ωϑϕℓ])([\u0307\u0308])")
_SUBSCRIPTS = re.compile("([₀-₉]+)")
_SUPERSCRIPTS = re.compile("([⁰¹²³⁴-⁹]+)")


def ascii_text(text: str, place: str = "expression", *, as_latex: bool = False) -> str:
    """``θ̇₁² + l₂`` as ``thetad1**2 + l2``, or as LaTeX.

    Raises:
        ExpressionError: a letter that no formula has.
    """
    text = unicodedata.normalize("NFD", text).translate(SIGNS)
    if text.isascii():
        return text
    text = _DOTTED.sub(lambda found: _dotted(found, as_latex), text)
    below, above = (r"_{\1}", r"^{\1}") if as_latex else (r"\1", r"**\1 ")
    if not as_latex:
        text = re.sub(r"([₀-₉⁰¹²³⁴-⁹])(?=[0-9])", r"\1 ", text)
    text = _SUPERSCRIPTS.sub(above, _SUBSCRIPTS.sub(below, text))
    text = text.translate(BELOW).translate(ABOVE)
    for letter, name in _GREEK.items():
        text = text.replace(letter, rf"\{name} " if as_latex and name != "l" else name)
    text = re.sub(r" (?=_\{|[0-9])", "", text) if as_latex else text
    if not text.isascii():
        strange = next(c for c in text if not c.isascii())
        raise refused(place, N_("{strange!r} has no meaning in a formula"), strange=strange)
    return text


def with_dots(text: str) -> str:
    """``θ1'`` as ``θ̇1``: the primes of a joint's rates as the dots that they mean."""
    return _PRIMED.sub(_rate, text)


def _rate(found: re.Match[str]) -> str:
    """A prime as the dots that it means."""
    twice = len(found[3]) == 2 or found[3] == "″"
    return found[1] + ("\u0308" if twice else "\u0307") + found[2]


def _dotted(found: re.Match[str], as_latex: bool) -> str:
    letter, dot = found.groups()
    dots = 1 if dot == "\u0307" else 2
    if as_latex:
        return rf"\{'d' * dots}ot{{{letter}}}"
    return letter + "d" * dots
