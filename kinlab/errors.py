"""Every error kinlab raises on purpose, and its one warning.

A message names the place (table, link, joint, file, row), says what is wrong, and says what
would be right. Catch ``KinlabError`` to catch them all; the command line turns each into one
line and exit code 2.

:class:`KinlabWarning` says at the door that a value is sound but hardly meant; the answer follows.
"""

from __future__ import annotations

import difflib
import sys
import warnings
from collections.abc import Iterable, Iterator
from contextlib import contextmanager
from contextvars import ContextVar


class KinlabError(Exception):
    """Root of the tree: something the caller gave cannot be used."""


class TableError(KinlabError, ValueError):
    """A DH table is incomplete or contradicts itself."""


class ExpressionError(KinlabError, ValueError):
    """A number or angle written as text cannot be read."""


class UrdfError(KinlabError, ValueError):
    """A URDF is not a tree of single-degree-of-freedom joints with sound numbers."""


class StructureError(KinlabError, ValueError):
    """A mechanism has the wrong shape for the request (a tree or loop where a chain is needed)."""


class StateError(KinlabError, ValueError):
    """A joint vector, pose or wrench has the wrong shape or type, or is not finite."""


class InertiaError(KinlabError, ValueError):
    """Dynamics were asked of a robot whose mass matrix is singular or absent."""


class MechanismError(KinlabError, ValueError):
    """A closed-chain mechanism has impossible lengths or masses, or cannot be assembled."""


class UnreachableError(StateError):
    """A point or joint vector at which the mechanism cannot be assembled."""


class LimitError(StateError):
    """A motion, or a point of one, breaks a limit of a joint: of position, velocity, ..."""


class SingularError(StateError):
    """The quantity asked for does not exist at a singular pose."""


class MotorError(KinlabError, ValueError):
    """A motor or gearbox lacks a figure that sizing needs, or has an impossible one."""


class NameUnknownError(KinlabError, KeyError):
    """A robot, frame, task, metric or quantity of that name does not exist."""

    def __str__(self) -> str:  # KeyError would show the repr of the message
        return str(self.args[0]) if self.args else ""


class OptionError(KinlabError, ValueError):
    """An option or tolerance has a value outside its valid range."""


class FileError(KinlabError, OSError):
    """A file cannot be read or written."""


class SweepError(KinlabError, RuntimeError):
    """A sweep cannot go on: its workers keep dying. What is finished stays in its folder."""


class MissingExtraError(KinlabError, ImportError):
    """A feature needs an optional package that is not installed."""


class KinlabWarning(UserWarning):
    """Something the caller gave can be used, but is hardly what was meant.

    Python shows each once for the line of the caller that it points to; ``warnings.simplefilter(
    "error", kl.errors.KinlabWarning)`` makes errors of them.
    """


_SAID: ContextVar[bool] = ContextVar("kinlab_said", default=False)


def warn(message: str) -> None:
    """Gives a :class:`KinlabWarning` that points to the first line outside this package."""
    if _SAID.get():
        return
    frame, level = sys._getframe(1), 2
    while frame.f_back is not None and str(frame.f_globals.get("__name__")).startswith("kinlab."):
        frame, level = frame.f_back, level + 1
    warnings.warn(message, KinlabWarning, stacklevel=level)


@contextmanager
def already_said() -> Iterator[None]:
    """Within it :func:`warn` is silent: for what is made out of tables that passed a door."""
    token = _SAID.set(True)
    try:
        yield
    finally:
        _SAID.reset(token)


def near(name: str, valid: Iterable[str], *, limit: int = 5) -> str:
    """Says which of the valid names are close to ``name``, or lists them when none is.

    Args:
        name: what the user wrote.
        valid: the names that exist.
        limit: how many near names to give.

    Returns:
        A sentence for the end of an error message.
    """
    names = list(dict.fromkeys(valid))
    close = difflib.get_close_matches(name, names, n=limit, cutoff=0.5)
    if not close:  # capitals do not count
        plain = {n.lower(): n for n in reversed(names)}
        found = difflib.get_close_matches(name.lower(), plain, n=limit, cutoff=0.5)
        close = [plain[n] for n in found]
    if close:
        return "did you mean " + ", ".join(repr(c) for c in close) + "?"
    shown = ", ".join(repr(n) for n in names[:40])
    return f"choose one of {shown}" + (" ..." if len(names) > 40 else "")
