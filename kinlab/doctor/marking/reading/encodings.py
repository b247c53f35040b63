"""In which encoding a submission is written: UTF-8, UTF-16, GB18030 or Windows-1252.

A mark at the beginning settles it, and so does a file that is UTF-8. Of the rest the bytes tell:
in Chinese text they come in pairs of which most stand for common characters, in a Western one
they stand alone, for letters with an accent. What is neither is refused.
"""

from __future__ import annotations

import codecs
import re

from kinlab.errors import FileError
from kinlab.host.language import _

_MARKS = (
    (codecs.BOM_UTF8, "utf-8", ""),
    (codecs.BOM_UTF32_LE, "utf-32", "UTF-32"),
    (codecs.BOM_UTF32_BE, "utf-32", "UTF-32"),
    (codecs.BOM_UTF16_LE, "utf-16", "UTF-16"),
    (codecs.BOM_UTF16_BE, "utf-16", "UTF-16"),
)
_SAID = re.compile(
    rb"\A(?:[^\n]*\n)?[ \t\f]*#.*?coding[:=][ \t]*([-\w.]+)|\\usepackage\s*\[(\w+)\]\s*\{inputenc\}"
)
"""What a program, or LaTeX, says of itself."""
_KNOWN = {"gbk": "GB18030", "gb2312": "GB18030", "gb18030": "GB18030", "cp1252": "Windows-1252"}
_KNOWN |= {"iso8859-1": "Windows-1252", "iso8859-15": "ISO 8859-15"}
_LATIN = frozenset("ŠŒŽšœžŸ°²³·µ§«»‘’“”–—…•×÷±¹¼½¾¿¡€£´¨")
"""Signs of Windows-1252, beside its letters, that stand in a text."""
_COMMON = 0.6
"""Share of common characters from which a text is Chinese."""
_RUN = 3
"""Bytes above 127 that may stand side by side in a Western text."""


def decoded(data: bytes, shown: str) -> tuple[str, str]:
    """The text of a file, and the encoding's name where it is not UTF-8.

    Args:
        data: of the file.
        shown: its name, for messages.

    Raises:
        FileError: it is no text, or its encoding cannot be told.
    """
    for mark, codec, name in _MARKS:
        if data.startswith(mark):
            return _text(data, codec, shown).removeprefix("\ufeff"), name
    if b"\x00" in data:
        raise FileError(f"{shown}: " + _("not text"))
    try:
        return data.decode("utf-8"), ""
    except UnicodeDecodeError:
        codec = _codec(data)
    if not codec:
        raise _unknown(shown)
    return _text(data, codec, shown), _KNOWN[codec]


def _text(data: bytes, codec: str, shown: str) -> str:
    try:
        text = data.decode(codec)
    except UnicodeDecodeError:
        raise _unknown(shown) from None
    if "\x00" in text:
        raise FileError(f"{shown}: " + _("not text"))
    return text


def _unknown(shown: str) -> FileError:
    said = _("its encoding cannot be told; save it as UTF-8 and hand it in again")
    return FileError(f"{shown}: {said}")


def _codec(data: bytes) -> str:
    said = _SAID.search(data)
    if said:
        name = (said[1] or said[2]).decode("ascii", "replace").replace("ansinew", "cp1252")
        try:
            found = codecs.lookup(name.replace("latin9", "iso8859-15")).name
            data.decode(found)
        except (LookupError, ValueError):
            found = ""
        if found in _KNOWN:
            return found
    runs = re.findall(rb"[\x80-\xff]+", data)
    if _chinese(data):
        return "gb18030"
    try:
        signs = {c for c in data.decode("cp1252") if not c.isascii()}
    except UnicodeDecodeError:
        return ""
    western = all(c.isalpha() or c in _LATIN for c in signs)
    return "cp1252" if western and max(map(len, runs)) <= _RUN else ""


def _chinese(data: bytes) -> bool:
    """Whether most of what is not ASCII is a common character, or a sign, of GB 2312."""
    try:
        text = data.decode("gb18030")
    except UnicodeDecodeError:
        return False
    codes = [c.encode("gb18030") for c in text if not c.isascii()]
    common = [k for k in codes if len(k) == 2 and k[1] >= 0xA1 and _is_common(k[0])]
    return len(common) >= _COMMON * len(codes)


def _is_common(first: int) -> bool:
    return 0xA1 <= first <= 0xA9 or 0xB0 <= first <= 0xD7
