"""The arm or the five-bar that formulas are of: from a name, a path, or what one has."""

from __future__ import annotations

from pathlib import Path
from typing import Any

from kinlab.check.quantities.fivebar import FIVEBAR
from kinlab.check.quantities.quantity import Domain
from kinlab.check.quantities.serial import SERIAL
from kinlab.doctor.changes import Mechanism
from kinlab.fivebar import FiveBar
from kinlab.fivebar.files import holds_five_bar
from kinlab.fivebar.linkage import as_five_bar
from kinlab.model.library import load


def mechanism(given: Any) -> Mechanism:
    """What is no five-bar is an arm, or refused as one.

    Raises:
        KinlabError: as :func:`kinlab.load`, or :meth:`kinlab.FiveBar.load`.
    """
    named = isinstance(given, (str, Path)) and holds_five_bar(given)
    return as_five_bar(given) if named or isinstance(given, FiveBar) else SERIAL.load(given)


def mechanism_beside(name: str, file: str) -> Mechanism:
    """The mechanism that a file names; a path may be relative to the file.

    Raises:
        KinlabError: as :func:`mechanism`.
    """
    beside = Path(file).parent / name
    place = beside if beside.suffix and beside.is_file() else name
    return FiveBar.load(place) if holds_five_bar(place) else load(place)


def domain_of(given: Mechanism) -> Domain:
    """The domain whose quantities its formulas are."""
    return FIVEBAR if isinstance(given, FiveBar) else SERIAL
