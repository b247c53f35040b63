"""The languages of pages that are made: kinlab's own catalogues, and the words of these pages."""

from __future__ import annotations

from contextlib import ExitStack
from pathlib import Path

_LOCALE = Path(__file__).parent / "locale"


class Language:
    """Says English sentences in a language; with ``with``, kinlab speaks it too.

    Args:
        name: such as ``"zh"``.
        folder: of its pages in ``docs``.
    """

    def __init__(self, name: str, folder: str) -> None:
        self.name, self.folder = name, folder
        self._own: dict[str, str] = {}
        self._open = ExitStack()
        own = _LOCALE / f"{name}.po"
        if own.exists():
            from kinlab.host.language import read_catalogue

            for entry in read_catalogue(own.read_text(encoding="utf-8")):
                self._own[entry["msgid"]] = entry["msgstr"]

    def __call__(self, text: str) -> str:
        if self.name == "en":
            return text
        from kinlab.host.language import _

        return self._own.get(text) or _(text)

    def __enter__(self) -> Language:
        if self.name != "en":
            from kinlab.host.language import speaking

            self._open.enter_context(speaking(self.name))
        return self

    def __exit__(self, *problem: object) -> None:
        self._open.close()


def languages() -> list[Language]:
    """English, and Chinese where kinlab has its catalogues."""
    found = [Language("en", ".")]
    try:
        from kinlab.host import language
    except ImportError:
        return found
    if any((Path(language.__file__).parent / "locale").rglob("*.po")):
        found.append(Language("zh", "zh"))
    return found
