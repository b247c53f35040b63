"""Products of matrices in a program under trial: what they cannot multiply does no harm."""

from __future__ import annotations

import ast
import sys
from typing import Any

import numpy as np
import pytest
from hand_programs import PROGRAMS, searched

from kinlab.doctor.program.own.calls import PRODUCTS, multiplied, product


class _Number:
    """A number of which it is known how many hold it."""

    made: list[_Number] = []  # noqa: RUF012

    def _another(self, other: Any) -> _Number:
        if not isinstance(other, _Number):
            raise TypeError("no number")
        new = _Number()
        _Number.made += [new, new]
        return new

    __mul__ = __add__ = _another


def _objects(shape: tuple[int, ...]) -> Any:
    found = np.empty(shape, dtype=object)
    for place in np.ndindex(shape):
        found[place] = _Number()
    return found


@pytest.mark.parametrize("shape", [(2, 2), (2,), (3, 2, 2)])
@pytest.mark.parametrize("place", range(4))
def test_what_a_failed_product_has_made_is_let_go_once(shape: tuple[int, ...], place: int) -> None:
    one, other = _objects(shape), _objects((2, 2))
    other.ravel()[place] = None
    _Number.made.clear()
    with pytest.raises(TypeError):
        product(one, other)
    made = _Number.made[::2]
    assert made or place == 0
    # in both lists, thrice, as the loop's own, and as what is asked
    assert all(sys.getrefcount(new) == 5 for new in made)


@pytest.mark.parametrize(
    ("one", "other"), [((3, 3), (3, 3)), ((3,), (3, 3)), ((3, 3), (3,)), ((2, 3, 3), (3,)),
                       ((2, 3, 3), (2, 3, 3)), ((3,), (2, 3, 3)), ((3,), (3,))]
)  # fmt: skip
def test_products_of_objects_are_those_of_numbers(
    one: tuple[int, ...], other: tuple[int, ...]
) -> None:
    rng = np.random.default_rng(3)
    first, last = rng.normal(size=one), rng.normal(size=other)
    found = product(first.astype(object), last.astype(object))
    np.testing.assert_allclose(np.asarray(found, dtype=float), first @ last, rtol=1e-13)
    assert np.shape(found) == np.shape(first @ last)


def test_a_product_in_place_is_seen_by_all_who_have_the_matrix() -> None:
    rng = np.random.default_rng(4)
    first, last = rng.normal(size=(2, 3, 3))
    also = first
    wanted = first @ last
    assert multiplied(first, last) is also
    np.testing.assert_allclose(also, wanted)


def test_no_edit_writes_the_doctors_own_names() -> None:
    program = PROGRAMS["dh fk"]
    search = searched(program.robot, program.quantity, program.text)
    search.singles()
    assert len(search.tried) > 100
    written = {
        node.id
        for edit, _values in search.tried
        for change in edit.changes
        for new in (change.new if isinstance(change.new, list) else [change.new])
        if isinstance(new, ast.AST)
        for node in ast.walk(new)
        if isinstance(node, ast.Name)
    }
    assert written.isdisjoint(PRODUCTS)
