"""What objects and dictionaries have, with its shapes; of it, what no function uses."""

from __future__ import annotations

import ast
from collections.abc import Iterable, Iterator, Mapping, Sequence
from dataclasses import dataclass, field
from typing import Any

from kinlab.doctor.bytecode.syntax import called, copied, nodes
from kinlab.doctor.program.edits.numbers.data import is_object
from kinlab.doctor.program.edits.scope.forms import entry, member, named
from kinlab.doctor.program.edits.scope.pieces import Pieces, Sized
from kinlab.doctor.program.edits.scope.values import is_number, shape_of
from kinlab.doctor.program.observed import Observed, Shape
from kinlab.doctor.program.read import OwnFunction
from kinlab.doctor.program.trial import Trial


@dataclass
class Members:
    """What a program's objects and dictionaries have.

    Attributes:
        attributes: of objects, by their shapes.
        keys: of dictionaries, by the shapes of what is there.
        asked: the keys that a program asks for; what others hold is never used.
    """

    attributes: dict[str, Shape] = field(default_factory=dict)
    keys: dict[str, Shape] = field(default_factory=dict)
    asked: set[str] = field(default_factory=set)

    def read(self, node: ast.AST, observed: Observed) -> None:
        """What a line of the program asks an object for, or sets."""
        for name, value in _entries(node):
            given = observed.shape(value)
            if given is not None:
                self.keys.setdefault(name, given)
        if isinstance(node, ast.Assign) and isinstance(node.targets[0], ast.Attribute):
            given = observed.shape(node.value)  # what is set and used nowhere
            if given is not None:
                self.attributes.setdefault(node.targets[0].attr, given)
        shape = observed.shape(node)
        if shape is None:
            return
        owner = node.value if isinstance(node, ast.Attribute) and node.attr != "T" else None
        owner = owner.value if isinstance(owner, ast.Subscript) else owner
        if isinstance(owner, ast.Name) and owner.id not in ("np", "math", "numpy"):
            assert isinstance(node, ast.Attribute)
            self.attributes.setdefault(node.attr, shape)
        key = node.slice if isinstance(node, ast.Subscript) else None
        if isinstance(key, ast.Constant) and isinstance(key.value, str):
            self.keys.setdefault(key.value, shape)
            self.asked.add(key.value)

    def hold(self, held: Any) -> None:
        """What an object or a dictionary holds, or the first of a list of them."""
        with_names = isinstance(held, tuple) and hasattr(held, "_asdict")
        first = held[0] if isinstance(held, list | tuple) and held and not with_names else 0.0
        if not is_number(first) or isinstance(first, tuple):
            self.hold(first)
        own = self.keys if isinstance(held, dict) else self.attributes
        inside = held if isinstance(held, dict) else getattr(held, "__dict__", {})
        inside = held._asdict() if with_names else inside
        for name, value in inside.items():
            if isinstance(name, str) and name[:1] != "_" and is_number(value):
                known = shape_of(value)
                if known is not None:
                    own.setdefault(name, known)

    def beside(self, node: ast.expr, shape: Shape, counters: Sequence[str]) -> Iterator[ast.expr]:
        """What else an object or a dictionary has: ``link.length`` beside ``link.centre``."""
        if isinstance(node, ast.Attribute) and node.attr in self.attributes:
            for one in _owners(node.value, counters):
                for name, own in self.attributes.items():
                    if own == shape:
                        yield member(copied(one), name)
        key = node.slice if isinstance(node, ast.Subscript) else None
        if isinstance(node, ast.Subscript) and isinstance(key, ast.Constant):
            for one in _owners(node.value, counters) if key.value in self.keys else ():
                for name, own in self.keys.items():
                    if own == shape and (name != key.value or one is not node.value):
                        yield entry(copied(one), ast.Constant(name))

    def unread_beside(
        self, node: ast.expr, keys: Iterable[str], attributes: Iterable[str]
    ) -> Iterator[Sized]:
        """What nothing asks for of an object or a dictionary that is asked for something else."""
        if isinstance(node, ast.Attribute) and node.attr in self.attributes:
            for name in sorted(attributes):
                yield self.attributes[name], member(copied(node.value), name)
        elif isinstance(node, ast.Subscript) and isinstance(node.slice, ast.Constant):
            for name in sorted(keys) if node.slice.value in self.keys else ():
                yield self.keys[name], entry(copied(node.value), ast.Constant(name))


def _entries(node: ast.AST) -> Iterator[tuple[str, ast.expr]]:
    """What a dictionary is made of: ``{"r": r}``, ``dict(r=r)``."""
    if isinstance(node, ast.Dict):
        for key, value in zip(node.keys, node.values, strict=True):
            if isinstance(key, ast.Constant) and isinstance(key.value, str):
                yield key.value, value
    elif isinstance(node, ast.Call) and called(node) == "dict":
        yield from ((word.arg, word.value) for word in node.keywords if word.arg)


def members_of(trial: Trial, observed: Observed) -> Members:
    """What the objects of a program have, by its lines, its data and its classes."""
    found = Members()
    for tree in trial.trees:
        for node in nodes(tree):
            found.read(node, observed)
    kept = [*trial.program.data, *sorted(trial.program.held)]
    for held in (*trial.bound, *(trial.space[name] for name in kept)):
        found.hold(held)
    for kind in trial.classes.values():
        found.hold(kind)
        for name, told in getattr(kind, "__annotations__", {}).items():
            if told in (float, "float"):
                found.attributes.setdefault(name, ())
    return found


def _owners(owner: ast.expr, counters: Sequence[str]) -> list[ast.expr]:
    """An object or a dictionary, or those that counters count: ``links[k]`` of ``links[i]``."""
    if not isinstance(owner, ast.Subscript) or not isinstance(owner.slice, ast.Name):
        return [owner]
    return [owner, *(entry(owner.value, named(one)) for one in counters)]


# -------- What no function uses


def read_attributes(trial: Trial) -> set[str]:
    """The attributes that a program reads, but to put something at the end of them."""
    every = [x for tree in trial.trees for x in nodes(tree) if isinstance(x, ast.Attribute)]
    filled = {id(x.value) for x in every if x.attr == "append"}
    return {x.attr for x in every if isinstance(x.ctx, ast.Load) and id(x) not in filled}


def filled_attributes(trial: Trial) -> set[str]:
    """The attributes at the end of which a program puts something."""
    every = [x for tree in trial.trees for x in nodes(tree) if isinstance(x, ast.Attribute)]
    kept = [x.value for x in every if x.attr == "append"]
    return {x.attr for x in kept if isinstance(x, ast.Attribute)}


def rows_beside(pieces: Pieces, idle: set[str]) -> Iterator[Sized]:
    """What nothing reads of an object that has as much beside it: ``arm.v[i]`` of ``arm.p[i]``.

    Args:
        pieces: the expressions that occur.
        idle: the lists that are filled and never read.
    """
    for shape, known in pieces.items():
        rows = [x for x in known.values() if shape and isinstance(x, ast.Subscript)]
        for row in rows:
            kept = row.value
            if not isinstance(kept, ast.Attribute) or not isinstance(kept.value, ast.Name):
                continue
            for name in sorted(idle):
                yield shape, entry(member(kept.value, name), row.slice)


def of_its_object(
    method: OwnFunction, pieces: Pieces, attributes: Mapping[str, Shape]
) -> Iterator[Sized]:
    """What the object of a method has, where the method asks it for no number."""
    own = _own_object(method)
    if own is None:
        return
    known = {text for some in pieces.values() for text in some}
    if any(text.startswith(f"{own.id}.") for text in known):
        return
    for name, shape in attributes.items():
        yield shape, member(own, name)


def idle_members(
    method: OwnFunction, idle: Mapping[str, Shape], counters: Sequence[str]
) -> Iterator[Sized]:
    """What the object of a method has and no function uses: ``self.I2``, ``self.d[i]``."""
    own = _own_object(method)
    if own is None:
        return
    for name in sorted(idle):
        one, shape = member(copied(own), name), idle[name]
        yield shape, one
        for counter in counters if shape else ():
            yield shape[1:], entry(copied(one), named(counter))


def _own_object(method: OwnFunction) -> ast.Name | None:
    """The name that a method has for its object; None where it has none."""
    if method.owner is None or not method.tree.args.args or method.kept is staticmethod:
        return None
    return named(method.tree.args.args[0].arg)


def of_siblings(trial: Trial, pieces: Pieces) -> Iterator[Sized]:
    """What other objects of the module have where one has it: ``two.m`` beside ``one.m``."""
    kinds: dict[str, set[str]] = {}
    known = [node for some in pieces.values() for node in some.values()]
    kept = {name: trial.space.get(name) for name in (*trial.program.data, *trial.sets)}
    objects = {name: value for name, value in kept.items() if is_object(value)}
    for node in known:
        if isinstance(node, ast.Attribute) and isinstance(node.value, ast.Name):
            kinds.setdefault(type(objects.get(node.value.id)).__name__, set()).add(node.attr)
    for name, value in objects.items():
        for attr in sorted(kinds.get(type(value).__name__, ())):
            shape = shape_of(vars(value).get(attr))
            if shape is not None:
                yield shape, member(named(name), attr)
