"""Letters and signs of word processors and web pages: 𝑥, 〖θ〗, ∙, ⅓, ``<sub>1</sub>``."""

from __future__ import annotations

import re
import unicodedata

from kinlab.formulas.signs.refusals import refused
from kinlab.formulas.typed import with_energies
from kinlab.host.language import N_, _

_MATHEMATICAL = re.compile("[\U0001d400-\U0001d7ff\u210e\u2112]")
"""Italic, bold and script letters and digits, Planck's h and the Lagrangian's L."""
_UNSEEN = dict.fromkeys(
    (0x00AD, 0x200B, 0x200C, 0x200D, 0x200E, 0x200F, 0x2060, 0x2061, 0x2063, 0xFEFF)
)
_PLAIN = str.maketrans(
    {"∙": "*", "∗": "*", "•": "*", "⁎": "*", "⨯": "*", "∕": "/", "⁄": "/"}
    | {"\u2062": " ", "\u00a0": " ", "\u2009": " ", "\u202f": " ", "\u2003": " "}
    | {"ᵢ": "_i", "ⱼ": "_j", "ₖ": "_k"}
    | {"〖": "(", "〗": ")", "∴": " "}
)
_FRACTION = re.compile("(\\d\\s?)?([⅓⅔¼¾⅕⅖⅗⅘⅙⅚⅛⅜⅝⅞½])")
_APART = re.compile("(?<=[A-Za-z\u03b1-\u03c9\u03d1\u03d5]) ([\u0307\u0308])")
"""A dot above a letter with a blank between, as word processors leave it."""
_ALIKE = re.compile("(?<![\u0400-\u04ff\\w])[ТКМСВАЕНРХПГ](?=[\\d₁-₉]{0,2}\\s{0,3}[=*·])")
_AS_LATIN = str.maketrans("ТКМСВАЕНРХПГ", "TKMCBAEHPXVG")
"""Letters of Cyrillic that a formula may have for Latin ones; ``П`` is the potential energy."""
_BELOW = re.compile(r"<sub>\s*(\w{1,6})\s*</sub>", re.IGNORECASE)
_ABOVE = re.compile(r"<sup>\s*(\d)\s*</sup>", re.IGNORECASE)
_BREAK = re.compile(r"<br\s*/?>", re.IGNORECASE)
_FRAME = re.compile(r"(?<![^\s(=$])([⁰¹²³⁴⁵⁶])(?=[TRAH][₀-₉\d_])")
"""The frame that a pose is in: ``²T₃``."""
_IN_PARENTHESES = re.compile(r"_\(\s*([A-Za-z0-9](?:[A-Za-z0-9 ,]{0,6}[A-Za-z0-9])?)\s*\)")
"""A subscript of Word's or Typst's: ``l_(c 1)``."""
_DOTTED = re.compile("\\(\\s?([A-Za-z\u03b1-\u03c9])(_?[\\w{}₁-₉]{0,4})\\s?\\)\\s?([\u0307\u0308])")
"""A dot of Word's, behind what it stands above."""
_SUBSCRIPT = str.maketrans("0123456789", "₀₁₂₃₄₅₆₇₈₉")
_RUSSIAN_UNIT = re.compile(r"(?<=[\d$)] )(Н|кг|Дж|рад)(?:[·*⋅ ]?(м))?(?![а-яё\w])")
_UNITS = {"Н": "N", "кг": "kg", "Дж": "J", "рад": "rad"}
_SUPERSCRIPT = str.maketrans("0123456789", "⁰¹²³⁴⁵⁶⁷⁸⁹")


def plain_letters(text: str, place: str) -> str:
    """The text with the letters that a keyboard, or the reader of Unicode, has.

    Raises:
        ExpressionError: ``2½``, which may be two and a half or 1.
    """
    if "<" in text:
        text = _BREAK.sub("\n", _BELOW.sub(_below, _ABOVE.sub(_above, text)))
    text = with_energies(text)
    text = _IN_PARENTHESES.sub(lambda found: f"_{{{found[1].replace(' ', '')}}}", text)
    if text.isascii():
        return text
    text = _DOTTED.sub(r"\1\3\2", text)
    text = _RUSSIAN_UNIT.sub(lambda found: _UNITS[found[1]] + (" m" if found[2] else ""), text)
    text = _MATHEMATICAL.sub(lambda found: unicodedata.normalize("NFKC", found[0]), text)
    text = text.translate(_UNSEEN).translate(_PLAIN)
    text = _FRAME.sub(lambda found: f"^{unicodedata.normalize('NFKC', found[1])}", text)
    text = _ALIKE.sub(lambda found: found[0].translate(_AS_LATIN), _APART.sub(r"\1", text))
    return _FRACTION.sub(lambda found: _fraction(found, place), text)


_ELL = r"\\ell(?![A-Za-z])"
_OF_LINK = re.compile(rf"_\s*(?:\{{\s*{_ELL}\s*_?\s*(?:\{{\s*(\w)\s*\}}|(\w))\s*\}})")
_LENGTH_A = re.compile(r"(?<![A-Za-z\\])a_(?:\d|\{\d\})")
_CENTRE_A = re.compile(r"(?<![A-Za-z\\])a_\{\s?c\s?_?\s?([1-9])\s?\}")
_OF_CENTRE = re.compile(rf"{_ELL}\s*_\s*(?:\{{\s*(\w)\s*\}}|(\w))")


def siciliano_s_letters(text: str) -> str:
    r"""``m_{\ell_1}`` as ``m_1``; beside ``a_1``, ``\ell_1`` and ``a_{c1}`` lead to the centre."""
    if _LENGTH_A.search(text):
        text = _CENTRE_A.sub(r"l_{c\1}", text)
    if "\\ell" not in text:
        return text
    text = _OF_LINK.sub(lambda found: f"_{found[1] or found[2]}", text)
    if not _LENGTH_A.search(text):
        return text
    return _OF_CENTRE.sub(lambda found: f"l_{{c{found[1] or found[2]}}}", text)


_MARK = r"\\(?:tilde|widetilde|bar|overline|hat|widehat|check)(?![A-Za-z])\s*"
_MARKED = re.compile(rf"{_MARK}(?:\{{\s*([A-Za-z])\s*\}}|([A-Za-z])(?![A-Za-z]))")


def without_marks(text: str) -> tuple[str, str]:
    r"""Letters without a mark above, ``I_1`` of ``\tilde I_1``, and what is to be said of it.

    Where a letter stands with a mark and without, all stay as they are.
    """
    marked = {found[1] or found[2]: found[0] for found in _MARKED.finditer(text)}
    rest = _MARKED.sub(" ", text)
    if not marked or any(re.search(rf"(?<![A-Za-z\\]){x}(?![A-Za-z])", rest) for x in marked):
        return text, ""
    shown = ", ".join(re.sub(r"\s+", " ", one) for one in marked.values())
    said = _("{marked} is read without the mark").format(marked=shown)
    return _MARKED.sub(lambda found: f" {found[1] or found[2]}", text), said


def _below(found: re.Match[str]) -> str:
    inside = found[1]
    return inside.translate(_SUBSCRIPT) if inside.isdigit() else f"_{inside}"


def _above(found: re.Match[str]) -> str:
    return found[1].translate(_SUPERSCRIPT)


def _fraction(found: re.Match[str], place: str) -> str:
    number, sign = found.groups()
    share = unicodedata.normalize("NFKC", sign).replace("\u2044", "/")
    if number:
        remedy = _("{sum} or {product}").format(
            sum=f"({number.strip()} + {share})", product=f"{number.strip()}*({share})"
        )
        said = N_("{what} can be read in two ways; write {remedy}")
        raise refused(place, said, what=found[0], remedy=remedy)
    return sign if sign == "½" else f"({share})"
