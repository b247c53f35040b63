"""Measures of a robot by name, and what any measure may answer."""

from __future__ import annotations

import hashlib
import inspect
from collections.abc import Callable, Iterable
from dataclasses import dataclass
from functools import partial
from typing import Any

import numpy as np

from kinlab.analysis.structure.task_space import suggest_rows
from kinlab.arrays import Array, shown
from kinlab.engine.fast.stacks import fk, jacobian
from kinlab.errors import NameUnknownError, OptionError, near

Measure = Callable[[Any, Array], Any]
"""f(robot, q (m, n)) -> an array with m rows, or a dict of such arrays."""

_BY_SIGMA = ("yoshikawa", "inverse_condition", "min_singular", "isotropy")
"""Names of :func:`kinlab.manipulability` that need the singular values only."""

NAMES = ("pose", "position", "jacobian", "singular_values", "condition", *_BY_SIGMA)


@dataclass(frozen=True)
class Named:
    """A measure made of names, each worked out once; picklable.

    Attributes:
        names: of :data:`NAMES`.
    """

    names: tuple[str, ...]

    def __call__(self, robot: Any, q: Array) -> dict[str, Array]:
        """The named values of each row of q."""
        from kinlab.analysis import metrics

        out: dict[str, Array] = {}
        if {"pose", "position"} & set(self.names):
            pose = fk(robot, q)
            out.update(pose=pose, position=pose[:, :3, 3])
        if set(self.names) - {"pose", "position"}:
            out["jacobian"] = jacobian(robot, q)
        if set(self.names) - {"pose", "position", "jacobian"}:
            rows = list(suggest_rows(robot))
            sigma = metrics.singular_values(out["jacobian"][:, rows])
            out["singular_values"] = sigma
            out["condition"] = metrics.condition_number(sigma)
            out.update({name: metrics.KINDS[name](sigma) for name in _BY_SIGMA})
        return {name: out[name] for name in self.names}


def read_measure(measure: str | Iterable[str] | Measure) -> Measure:
    """Names to a measure; a function stays what it is.

    Raises:
        NameUnknownError: a name that is none.
        OptionError: neither a name, names, nor a function; no name at all; a name twice.
    """
    if callable(measure):
        _takes_two(measure)
        return measure
    if isinstance(measure, bytes) or not isinstance(measure, Iterable):
        raise OptionError(f"sweep: measure is {shown(measure)}; give a name or a function")
    names = (measure,) if isinstance(measure, str) else tuple(measure)
    for name in names:
        if not isinstance(name, str) or name not in NAMES:
            raise NameUnknownError(
                f"sweep: measure {shown(name)} is unknown; {near(str(name), NAMES)}; for other "
                "tasks give a function f(robot, q)"
            )
    if not names or len(set(names)) < len(names):
        raise OptionError(f"sweep: measures {list(names)}; name at least one, each once")
    return Named(names)


def _takes_two(measure: Measure) -> None:
    try:
        inspect.signature(measure).bind(None, None)
    except ValueError:  # some of C's functions do not say what they take
        return
    except TypeError as problem:
        raise OptionError(f"sweep: measure {shown(measure)}: {problem}; f(robot, q)") from None


def evaluate(measure: Measure, robot: Any, q: Array) -> dict[str, Array]:
    """One block's answer as named arrays with a row for each state.

    Raises:
        OptionError: the function answers something else.
    """
    answer = measure(robot, q)
    columns = answer if isinstance(answer, dict) else {"value": answer}
    out = {}
    for name, value in columns.items():
        column = np.asarray(value)
        if not isinstance(name, str) or column.dtype.kind not in "biufc":
            raise OptionError(f"sweep: the measure answered {name!r}: {column.dtype}; numbers only")
        if column.ndim == 0 or len(column) != len(q):
            raise OptionError(
                f"sweep: the measure answered {name!r} of shape {column.shape} for {len(q)} "
                "states; expected a row for each"
            )
        out[name] = column
    if not out:
        raise OptionError("sweep: the measure answered an empty dict; expected named arrays")
    return out


def describe(measure: Measure) -> str:
    """A name that changes when the measure does, as far as a function shows it.

    Functions are told apart by where they stand and by their code, not by what they call.
    """
    if isinstance(measure, Named):
        return "+".join(measure.names)
    if isinstance(measure, partial):
        given = [repr(a) for a in measure.args]
        given += [f"{k}={v!r}" for k, v in sorted(measure.keywords.items())]
        return f"{describe(measure.func)}({', '.join(given)})"
    place = f"{getattr(measure, '__module__', '')}.{getattr(measure, '__qualname__', measure)}"
    code = getattr(measure, "__code__", None)
    if code is None:
        return place
    numbers = [c for c in code.co_consts if isinstance(c, (bool, int, float, str, type(None)))]
    digest = hashlib.sha256(code.co_code + repr((numbers, code.co_names)).encode())
    return f"{place}#{digest.hexdigest()[:16]}"
