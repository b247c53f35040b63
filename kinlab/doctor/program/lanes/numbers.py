"""A number that has another value in each lane.

A lane is one way to edit a program. Where an edit stands, what it makes of a value is computed
for its lanes alone and put among the others': inside such a place numbers are narrower.
"""

from __future__ import annotations

import copy
import operator
from collections.abc import Callable, Sequence
from typing import Any

import numpy as np

_STEP, _NUMBERS = 40, 25
"""What an operation amounts to beside its numbers, and how many of these amount to one."""
_EDIT, _ARRAY, _PICK = 300, 700, 50
"""What evaluating an edit amounts to beside its operations; where it gives an array; and asking
a place for its edits."""


_FLOAT = np.dtype(float)
_PLAIN = (float, int, np.float64, complex, bool)


def operation(lanes: int) -> float:
    """What an operation of numbers with so many lanes amounts to."""
    return _STEP + lanes / _NUMBERS


def lanes_within(work: float) -> int:
    """How many lanes the numbers of an operation may have for it to amount to no more."""
    return int((work - _STEP) * _NUMBERS)


class TooMuchError(Exception):
    """More work than may be done: a recursion with an edit in each call."""


class LaneGroup:
    """Some of the lanes: all, or those of an edit.

    Args:
        chosen: the numbers of the edits of every lane, (L, most); -1 for none.
        which: the numbers of the lanes here, ascending; None for all.
    """

    __slots__ = ("_apart", "_begins", "_chosen", "_edits", "_inner", "_places", "_rest", "_where",
                 "amount", "at", "size", "which")  # fmt: skip

    def __init__(self, chosen: Any, which: Any = None, apart: bool | None = None) -> None:
        self._chosen, self.which = chosen, which
        self.size = len(chosen) if which is None else len(which)
        self.amount = _STEP + self.size // _NUMBERS
        self.at: dict[int, list[int]] = {}
        self._apart = apart
        self._edits: dict[int, int] | None = None
        self._inner: dict[int, LaneGroup] = {}
        self._rest: dict[tuple[int, ...], LaneGroup] = {}
        self._where: dict[LaneGroup, Any] = {}

    @property
    def edits(self) -> dict[int, int]:
        """The edits that any lane here has, numbered."""
        if self._edits is None and not self.size:
            self._edits = {}
        if self._edits is None:
            chosen = self._chosen if self.which is None else self._chosen.take(self.which, axis=0)
            flat = chosen.ravel()
            order = flat.argsort(kind="stable")
            flat = flat[order]
            starts = np.concatenate([_FIRST, (flat[1:] != flat[:-1]).nonzero()[0] + 1])
            edits = flat[starts].tolist()
            self._places, self._begins = order // chosen.shape[1], starts
            self._edits = dict(zip(edits, range(len(edits)), strict=True))
        return self._edits

    def inner(self, edit: int) -> LaneGroup:
        """Those of the lanes here that have an edit."""
        found = self._inner.get(edit)
        if found is None:
            k, begins = self.edits[edit], self._begins
            end = begins[k + 1] if k + 1 < len(begins) else len(self._places)
            places = self._places[begins[k] : end]
            if self._apart is None:
                self._apart = _apart(self._chosen)
            which = places if self.which is None else self.which[places]
            found = self._inner[edit] = LaneGroup(self._chosen, which, self._apart)
            if self._apart:
                found._where[self] = places
        return found

    def without(self, edits: Sequence[int]) -> LaneGroup:
        """Those of the lanes here that have none of some edits."""
        key = tuple(edits)
        if key not in self._rest:
            which = np.arange(self.size) if self.which is None else self.which
            rest = ~np.isin(self._chosen[which], key).any(axis=1)
            self._rest[key] = LaneGroup(self._chosen, which[rest], self._apart)
        return self._rest[key]

    def where(self, outer: LaneGroup) -> Any:
        """At which places of an outer one these lanes are."""
        if outer.which is None:
            return self.which
        if outer not in self._where:
            self._where[outer] = outer.which.searchsorted(self.which)
        return self._where[outer]


_FIRST = np.zeros(1, dtype=int)


def _apart(chosen: Any) -> bool:
    """Whether the edits of each lane are different ones."""
    ordered = np.sort(chosen, axis=1)
    return not ((ordered[:, 1:] == ordered[:, :-1]) & (ordered[:, 1:] >= 0)).any()


Edited = list[tuple[LaneGroup, Any]]
"""What a value is in some lanes."""


class Lanes:
    """Which edits each lane has, and where in the program it is just now.

    Args:
        chosen: the numbers of the edits of each lane, (L, most); -1 for none.
        most: work that may be done.
    """

    def __init__(self, chosen: Any, most: int) -> None:
        self.all = self.here = LaneGroup(chosen)
        self.lost = np.zeros(len(chosen), dtype=bool)
        self.work, self.most = 0, most

    def pick(
        self, edits: Sequence[int], old: Callable[[], Any], new: Callable[[int], Any] | None
    ) -> Any:
        """What a place of the program gives: for the lanes of its edits what these make of it.

        Without a function for them these lanes are lost. A place gives the same sequence of edits
        each time, which lives as long as the lanes do.
        """
        if self.work > self.most:
            raise TooMuchError
        self.work += _PICK
        here = self.here
        try:
            value = old()
        except NameError:  # a line more sets it for the first time
            value = None
        some = here.at.get(id(edits))
        if some is None:
            known = here.edits
            none = known.keys().isdisjoint(edits)
            some = here.at[id(edits)] = [] if none else [x for x in edits if x in known]
        if not some:
            return value
        found: Edited = []
        for edit in some:
            inner = here.inner(edit)
            self.work += _EDIT
            if new is None:
                self.lose(inner)
                continue
            self.here = inner
            try:
                found.append((inner, new(edit)))
            except Exception:  # noqa: BLE001  what edited programs may raise
                self.lose(inner)
            finally:
                self.here = here
        return self.joined(value, found) if found else value

    def there(self, edits: Sequence[int], old: Callable[[], Any]) -> tuple[int, ...]:
        """A number where there is an entry that lines of edits set; else their lanes are lost."""
        try:
            old()
        except NameError:
            pass  # told where it is set
        except Exception:  # noqa: BLE001  what edited programs may raise
            for edit in self.here.edits.keys() & {*edits}:
                self.lose(self.here.inner(edit))
            return ()
        return (0,)

    def lose(self, place: LaneGroup, some: Any = slice(None)) -> None:
        """Lanes whose answers are not to be believed."""
        self.lost[some if place.which is None else place.which[some]] = True

    def joined(self, value: Any, found: Edited) -> Any:
        """A value with what it is in some lanes."""
        if is_number(value):
            return self._number(value, found)
        if isinstance(value, np.ndarray):
            return self._array(value, found)
        if type(value) is dict:
            return self._fields(value, found)
        if type(value) not in (list, tuple) and hasattr(value, "__dict__") and not callable(value):
            return self._object(value, found)
        rows = isinstance(value, list | tuple)
        same: Edited = []
        for place, new in found:
            if rows and type(new) is type(value) and len(new) == len(value):
                same.append((place, new))
            elif new is not value:
                self.lose(place)
        if not same:
            return value
        make = getattr(type(value), "_make", type(value))  # of a tuple with names
        return make(
            self.joined(old, [(place, new[k]) for place, new in same])
            for k, old in enumerate(value)
        )

    def _object(self, value: Any, found: Edited) -> Any:
        """An object of the program's with what its members are in some lanes."""
        own = vars(value)
        same: Edited = []
        for place, new in found:
            if type(new) is type(value) and vars(new).keys() == own.keys():
                same.append((place, vars(new)))
            elif new is not value:
                self.lose(place)
        if not same:
            return value
        other = copy.copy(value)
        vars(other).update(self._fields(own, same))
        return other

    def _number(self, value: Any, found: Edited) -> Any:
        sound = [(place, new) for place, new in found if new is not value]
        numbers: Edited = []
        for place, new in sound:
            if isinstance(new, np.ndarray) and new.shape == ():
                new = new[()]
            if is_number(new):
                numbers.append((place, values_in(new, place)))
            else:
                self.lose(place)
        if not numbers:
            return value
        here = self.here
        own = values_in(value, here)
        plain = _is_real(own) and all(_is_real(new) for _place, new in numbers)
        kind = float if plain else np.result_type(float, own, *(new for _place, new in numbers))
        values = np.empty(here.size, dtype=kind)
        values[:] = own
        for place, new in numbers:
            values[place.where(here)] = new
        self.work += here.amount
        return Laned(values, self, here)

    def _fields(self, value: dict[Any, Any], found: Edited) -> dict[Any, Any]:
        same: Edited = []
        for place, new in found:
            if type(new) is dict and new.keys() == value.keys():
                same.append((place, new))
            else:
                self.lose(place)
        return (
            {
                key: self.joined(old, [(place, new[key]) for place, new in same])
                for key, old in value.items()
            }
            if same
            else value
        )

    def _array(self, value: Any, found: Edited) -> Any:
        self.work += _ARRAY * len(found)
        arrays = []
        for place, new in found:
            try:
                new = np.asarray(new)
                arrays.append((place, np.broadcast_to(new, value.shape).ravel()))
            except ValueError:
                self.lose(place)
        flat = value.ravel()
        joined = np.empty(flat.size, dtype=object)
        for k, old in enumerate(flat):
            other = [(place, new[k]) for place, new in arrays if not _same(new[k], old)]
            joined[k] = self._number(old, other) if other else old
        return joined.reshape(value.shape)


def _same(one: Any, other: Any) -> bool:
    if one is other:
        return True
    return not isinstance(one, Laned) and not isinstance(other, Laned) and bool(one == other)


def is_number(value: Any) -> bool:
    """Whether it is one number, with lanes or without."""
    return isinstance(value, _NUMBER)


def _is_real(value: Any) -> bool:
    """Whether it is a real number, or an array of these."""
    kind = type(value)
    return kind is float or kind is int or getattr(value, "dtype", None) is _FLOAT


def values_in(value: Any, place: LaneGroup) -> Any:
    """What a number is in some lanes; of one without lanes itself."""
    return value.within(place) if isinstance(value, Laned) else value


def _both(operate: Callable[[Any, Any], Any], turned: bool = False) -> Any:
    """An operation of two numbers, the second of which may have no lanes."""

    def operated(self: Laned, other: Any) -> Any:
        lanes = self.lanes
        here = lanes.here
        kind = type(other)
        if kind is Laned:
            others = other.values if other.place is here else other.within(here)
        elif kind in _PLAIN or isinstance(other, np.number):
            others = other
        elif kind is np.ndarray:
            return _entries(operate, self, turned)(other)
        else:
            return NotImplemented
        values = self.values if self.place is here else self.within(here)
        lanes.work += here.amount
        return Laned(operate(others, values) if turned else operate(values, others), lanes, here)

    return operated


def _entries(operate: Callable[[Any, Any], Any], one: Laned, turned: bool) -> Any:
    if turned:
        return np.frompyfunc(lambda entry: operate(entry, one), 1, 1)
    return np.frompyfunc(lambda entry: operate(one, entry), 1, 1)


def _plus(turned: bool = False) -> Any:
    operated = _both(operator.add, turned)

    def plus(self: Laned, other: Any) -> Any:
        kind = type(other)
        return self if (kind is float or kind is int) and other == 0 else operated(self, other)

    return plus


def _times(turned: bool = False) -> Any:
    operated = _both(operator.mul, turned)

    def times(self: Laned, other: Any) -> Any:
        kind = type(other)
        if kind is float or kind is int:
            if other == 0:
                return 0.0
            if other == 1:
                return self
        return operated(self, other)

    return times


class Laned:
    """A number with another value in each lane.

    Args:
        values: of the lanes of a place.
        lanes: all of them.
        place: those that have values.
    """

    __slots__ = ("lanes", "place", "values")
    __array_ufunc__ = None

    def __init__(self, values: Any, lanes: Lanes, place: LaneGroup) -> None:
        self.values, self.lanes, self.place = values, lanes, place

    def within(self, place: LaneGroup) -> Any:
        """The values in some of the lanes that have any."""
        if self.place is place:
            return self.values
        return self.values[place.where(self.place)]

    def of(self, function: Callable[[Any], Any]) -> Laned:
        """A function of it."""
        lanes = self.lanes
        lanes.work += _STEP + 4 * lanes.here.size // _NUMBERS
        return Laned(function(self.within(lanes.here)), lanes, lanes.here)

    __add__, __radd__ = _plus(), _plus(turned=True)
    __mul__, __rmul__ = _times(), _times(turned=True)
    __sub__, __rsub__ = _both(operator.sub), _both(operator.sub, turned=True)
    __truediv__ = _both(operator.truediv)
    __rtruediv__ = _both(operator.truediv, turned=True)
    __pow__, __rpow__ = _both(operator.pow), _both(operator.pow, turned=True)
    __mod__, __rmod__ = _both(operator.mod), _both(operator.mod, turned=True)
    __lt__, __le__ = _both(operator.lt), _both(operator.le)
    __gt__, __ge__ = _both(operator.gt), _both(operator.ge)
    __eq__, __ne__ = _both(operator.eq), _both(operator.ne)
    __hash__ = object.__hash__

    def __neg__(self) -> Laned:
        return self.of(operator.neg)

    def __pos__(self) -> Laned:
        return self

    def __abs__(self) -> Laned:
        return self.of(np.abs)

    def __round__(self, digits: int = 0) -> Laned:
        return self.of(lambda values: np.round(values, digits))

    def conjugate(self) -> Laned:
        """As of any number."""
        return self.of(np.conjugate)

    conj = conjugate

    @property
    def real(self) -> Laned:
        """As of any number."""
        return self.of(np.real)

    @property
    def imag(self) -> Laned:
        """As of any number."""
        return self.of(np.imag)

    def __bool__(self) -> bool:
        """What it is in most lanes; the others are lost."""
        values = np.asarray(self.within(self.lanes.here), dtype=bool)
        yes = 2 * int(values.sum()) > len(values)
        if (values != yes).any():
            self.lanes.lose(self.lanes.here, values != yes)
        return yes

    def __index__(self) -> int:
        """The same, as a count or an index."""
        values = np.asarray(self.within(self.lanes.here))
        each, counts = np.unique(values, return_counts=True)
        most = each[np.argmax(counts)]
        if most != int(most):
            raise TypeError("no whole number")
        self.lanes.lose(self.lanes.here, values != most)
        return int(most)

    def __float__(self) -> float:
        values = self.within(self.lanes.here)
        if len(values) and (values == values[0]).all():
            return float(values[0])
        raise TypeError("one number of several")


_NUMBER = (Laned, int, float, complex, np.number)
