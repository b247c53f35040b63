"""What is known in one part of a program: names, entries, angles, and what may stand in a place."""

from __future__ import annotations

import ast
from collections import Counter
from collections.abc import Callable, Container, Iterator, Sequence
from functools import lru_cache
from math import pi
from types import FunctionType, ModuleType
from typing import Any

import numpy as np

from kinlab.doctor.bytecode.syntax import copied, names, nodes
from kinlab.doctor.program.edits.chains import without_numbers
from kinlab.doctor.program.edits.numbers.data import is_object
from kinlab.doctor.program.observed import Observed, Shape
from kinlab.doctor.program.places import ANGLES, Here, called, paired, places, reads
from kinlab.doctor.program.read import OwnFunction, read
from kinlab.doctor.program.trial import Trial

ARCS = ("arccos", "acos", "arcsin", "asin", "arctan2", "atan2", "arctan", "atan")
PI = ast.Attribute(ast.Name("np", ast.Load()), "pi", ast.Load())
_SQUARES = {(2, 2), (3, 3), (4, 4)}
"""Shapes of matrices to which the unit matrix may be added."""
_VECTOR, _MATRIX, _TWISTS = (3,), (3, 3), (6, 6)
_JOINTS = 7
"""Entries of a row that nothing uses up to which each is tried."""
_LONG = 60
"""Letters up to which an expression is tried in other places."""
_SHORT = 7
"""Entries of a row of which any may be meant."""
_FEW_NUMBERS = 6
"""Names of a module's numbers up to which a part may have forgotten any of them."""
_UNUSED = 0.2
"""What it is likelier that something is missing which is set and used nowhere."""


class Scope:
    """What may be written in one part: its names with their shapes, and its expressions.

    Attributes:
        observed: what its expressions were.
        space: what the module's names stand for.
        functions: the program's own, each with how many arguments it asks for.
        has_numpy: whether numpy is called ``np``.
        shapes: names of numbers, by their shapes.
        lists: names of lists, by the shapes of their entries.
        attributes: of objects, by their shapes.
        keys: of dictionaries, by the shapes of what is there.
        counters: names that count.
        ranges: what they count through.
        idle_attributes: of objects those that no function uses.
        unused: names that are set, in the part or in the module, and used nowhere.
        idle_entries: entries of what the function is given that it uses nowhere, as text.
        arcs: names of angles whose sine, cosine or tangent was known.
        turned: names of which sines and cosines are taken.
        angles: what sines and cosines are taken of.
        taken: how often they are.
        pieces: expressions that occur, and entries of lists by a counter, by shape and text.
        crossing: the program's functions that make a matrix of a twist.
        addends: the terms of the sums that are set, by what is set, without its number.
        idle: calls that nothing makes, of functions or for joints that are used nowhere, by shape.
        inner: the terms of the sums that are factors, without their numbers.
        factors: what stands in front of a product of matrices, by the statements' identities.
        beside: names that are entries of one thing: ``w, dh, dr = v``.
        tests: conditions on what a counter counts, of kinds of joints that nothing asks, too.
        present, set_at: the names that it has, and the lines in which it sets them first.
        fronts: names in what stands in front of any product of matrices.
        divisors: what something is divided by, as text.
        pi: how the program may write it; None where it cannot.
        root: what gives square roots, where it is known.
        cross: what gives the product of two vectors, where it is known.
        whole: names of whole numbers that are given to a function, and counters.
    """

    def __init__(self, trial: Trial, observed: Observed, part: int) -> None:
        tree = trial.trees[part]
        self.observed = observed
        self.space = trial.space
        parts = trial.program.parts
        self.functions = {p.name: len(p.tree.args.args) for p in parts[1:] if p.owner is None}
        self.angular = {name for name in ANGLES if callable(trial.space.get(name))}
        self.has_numpy = isinstance(trial.space.get("np"), ModuleType)
        self.shapes: dict[str, Shape] = {}
        self.lists: dict[str, Shape] = {}
        self.attributes: dict[str, Shape] = {}
        self.keys: dict[str, Shape] = {}
        self.counters: list[str] = []
        self.angles: dict[str, ast.expr] = {}
        self.taken: Counter[str] = Counter()
        self.pieces: dict[Shape, dict[str, ast.expr]] = {}
        calls = [node for node in nodes(tree) if isinstance(node, ast.Call)]
        self.addends: dict[str, set[str]] = {}
        self.idle: list[tuple[Shape, ast.expr]] = []
        self.inner: set[str] = set()
        self.factors: dict[int, set[str]] = {}
        operations = [x for x in nodes(tree) if isinstance(x, ast.BinOp)]
        self.divisors = {ast.unparse(x.right) for x in operations if isinstance(x.op, ast.Div)}
        fronts = (x.left for x in operations if isinstance(x.op, ast.MatMult))
        self.fronts = {name for one in fronts for name in names(one)}
        self.pi = _pi_of(trial.space)
        self._inside: frozenset[str] = frozenset()
        self._known_here: dict[tuple[frozenset[str], Shape], dict[str, ast.expr]] = {}
        self.ranges = [copied(node) for node in calls if called(node) == "range"]
        self.cross = _cross(calls, observed, self.has_numpy)
        self.crossing = _crossing(trial, observed)
        self.root = _root(calls, trial.space)
        inner, outer = set[str](), set[str]()
        for node in nodes(tree):
            if isinstance(node, ast.For | ast.comprehension):
                set_here = names(node.target)
                over = _as_rows(node.iter, trial)
                passed = dict(_passed(node.target, over, observed))
                self.shapes |= {n: s for n, s in passed.items() if n not in self.shapes}
                self.counters += [n for n in set_here if n not in (*self.counters, *passed)]
                (inner if isinstance(node, ast.comprehension) else outer).update(set_here)
        self._counted = frozenset(_while_counters(tree, observed))
        self.counters += [name for name in sorted(self._counted) if name not in self.counters]
        for one in trial.trees:
            for node in nodes(one):
                self._of_member(node, observed)
        kept = [*trial.program.data, *sorted(trial.program.held)]
        for held in (*trial.bound, *(trial.space[name] for name in kept)):
            self._of_object(held)
        for kind in trial.classes.values():
            self._of_object(kind)
            for name, told in getattr(kind, "__annotations__", {}).items():
                if told in (float, "float"):
                    self.attributes.setdefault(name, ())
        here = {*names(tree, ast.Load)}
        local = {n.arg for n in nodes(tree.args) if isinstance(n, ast.arg)}
        local |= {*names(tree)} - here
        self.present = here | local
        stores = (
            x for x in nodes(tree) if isinstance(x, ast.Name) and isinstance(x.ctx, ast.Store)
        )
        self.set_at: dict[str, int] = {}
        for store in sorted(stores, key=lambda one: one.lineno):
            self.set_at.setdefault(store.id, store.lineno)
        self.shapes |= _given(trial, part, observed)
        for node in nodes(tree):
            if isinstance(node, ast.expr):
                self._of_expression(node, observed, inner - outer)
                if isinstance(node, ast.BinOp) and isinstance(node.op, ast.Mult):
                    self._of_factors(node, observed)
            if isinstance(node, ast.Assign | ast.AugAssign):
                self._of_addends(node)
            if isinstance(node, ast.Assign | ast.AugAssign | ast.Return):
                products = (x for x in nodes(node) if isinstance(x, ast.BinOp))
                turned = [x.left for x in products if isinstance(x.op, ast.MatMult)]
                self.factors[id(node)] = {ast.unparse(one) for one in turned}
            if isinstance(node, ast.Assign) and len(node.targets) == 1:
                for name, shape in _unpacked(node.targets[0], node.value, observed):
                    self.shapes.setdefault(name, shape)
        self.beside = _set_together(tree)
        self._names_in: dict[int, frozenset[str]] = {}
        self.tests = _tests(tree, trial, self.counters)
        self.arcs, self.sines = _set_by(tree, ARCS), _set_by(tree, ANGLES)
        self.counters = [name for name in self.counters if self.shapes.get(name, ()) == ()]
        self.whole = [*self.counters, *_counts(tree, observed, self.counters)]
        self.constants = {n for n, x in trial.program.space.items() if isinstance(x, float)}
        for name, value in trial.program.space.items():
            of_each = isinstance(value, dict) and all(type(key) is int for key in value)
            if name[:1] != "_" and (_is_number(value) or of_each):
                known = _shape([*value.values()] if isinstance(value, dict) else value)
                if known is not None:
                    self.shapes.setdefault(name, known)
        self.turned = {name for one in self.angles.values() for name in names(one)}
        every, used = set[str]().union(*map(_used, trial.trees)), _used(tree)
        self.unused = {
            name
            for name in (*self.shapes, *self.lists)
            if name not in (used if name in local else every)
        }
        self.idle_entries = set[str]() if part else _idle_entries(trial, self.shapes)
        for name, shape in self.shapes.items():
            if name in self.counters:
                continue
            plain = ast.Name(name, ast.Load())
            if name in self.unused:
                self.pieces.setdefault(shape, {}).setdefault(name, plain)
            forgotten = name in trial.program.data and name not in self.present
            if forgotten and not shape and len(trial.program.data) <= _FEW_NUMBERS:
                self.pieces.setdefault((), {}).setdefault(name, plain)
            if shape and (name in self.unused or len(shape) > 1 or forgotten):
                self.lists.setdefault(name, shape[1:])
            if name in self.unused and len(shape) == 1 and shape[0] <= _JOINTS:
                for k in range(shape[0]):
                    entry = ast.Subscript(copied(plain), ast.Constant(k), ast.Load())
                    self.pieces.setdefault((), {}).setdefault(ast.unparse(entry), entry)
        read_ = _read_attributes(trial)
        self.idle_attributes = {*self.attributes} - read_
        self._of_objects_beside(_filled_attributes(trial) - read_)
        self._of_its_object(parts[part])
        self._of_idle_attributes(parts[part])
        self._of_siblings(trial)
        self._of_idle_joints(trial, part)
        self._of_idle_rows(trial, part)
        self._of_idle_functions(trial, part)
        if self.has_numpy:
            for size in _SQUARES & self.pieces.keys():
                unit = ast.parse(f"np.eye({size[0]})", mode="eval").body
                self.pieces[size].setdefault(ast.unparse(unit), unit)
        for name, shape in self.lists.items():
            for counter in self.counters:
                counted = ast.Name(counter, ast.Load())
                entry = ast.Subscript(ast.Name(name, ast.Load()), counted, ast.Load())
                self.pieces.setdefault(shape, {}).setdefault(ast.unparse(entry), entry)

    def _of_its_object(self, method: OwnFunction) -> None:
        """What the object of a method has, where the method asks it for no number."""
        if method.owner is None or not method.tree.args.args or method.kept is staticmethod:
            return
        own = ast.Name(method.tree.args.args[0].arg, ast.Load())
        known = {text for some in self.pieces.values() for text in some}
        if any(text.startswith(f"{own.id}.") for text in known):
            return
        for name, shape in self.attributes.items():
            one = ast.Attribute(own, name, ast.Load())
            self.pieces.setdefault(shape, {}).setdefault(ast.unparse(one), one)

    def _of_idle_attributes(self, method: OwnFunction) -> None:
        """What the object of a method has and no function uses: ``self.I2``, ``self.d[i]``."""
        if method.owner is None or not method.tree.args.args or method.kept is staticmethod:
            return
        for name in sorted(self.idle_attributes):
            own = ast.Name(method.tree.args.args[0].arg, ast.Load())
            one, shape = ast.Attribute(own, name, ast.Load()), self.attributes[name]
            self.pieces.setdefault(shape, {}).setdefault(ast.unparse(one), one)
            for counter in (*self.counters, *self.whole) if shape else ():
                entry = ast.Subscript(copied(one), ast.Name(counter, ast.Load()), ast.Load())
                self.pieces.setdefault(shape[1:], {}).setdefault(ast.unparse(entry), entry)

    def are_halves(self, one: str, other: str) -> bool:
        """Whether one of two numbers of one link is half of the other: ``lc1`` of ``l1``."""
        digits = {name[len(name.rstrip("0123456789")) :] for name in (one, other)}
        values = [self.space.get(name) for name in (one, other)]
        floats = [x for x in values if isinstance(x, float)]
        return len(digits) == 1 and len(floats) == 2 and min(floats) * 2 == max(floats)

    def is_idle(self, node: ast.AST) -> bool:
        """Whether it is what is set and used nowhere, or an entry of that."""
        while isinstance(node, ast.Subscript):
            node = node.value
        if isinstance(node, ast.Attribute):
            return node.attr in self.idle_attributes
        return isinstance(node, ast.Name) and node.id in self.unused

    def uses_idle(self, node: ast.AST) -> bool:
        """Whether there is anything in it that is set or given, and used nowhere."""
        if not self.unused.isdisjoint(names(node)):
            return True
        entries = [one for one in nodes(node) if isinstance(one, ast.Subscript)]
        return bool(self.idle_entries) and any(ast.unparse(x) in self.idle_entries for x in entries)

    def _of_objects_beside(self, idle: set[str]) -> None:
        """What nothing reads of an object that has as much beside it: ``arm.v[i]`` of ``arm.p[i]``.

        Args:
            idle: the lists that are filled and never read.
        """
        for shape, known in self.pieces.items():
            rows = [x for x in known.values() if shape and isinstance(x, ast.Subscript)]
            for row in rows:
                kept = row.value
                if not isinstance(kept, ast.Attribute) or not isinstance(kept.value, ast.Name):
                    continue
                for name in sorted(idle):
                    other = ast.Attribute(kept.value, name, ast.Load())
                    entry = ast.Subscript(other, row.slice, ast.Load())
                    self.pieces[shape].setdefault(ast.unparse(entry), entry)
                    self.idle_entries.add(ast.unparse(entry))

    def _of_siblings(self, trial: Trial) -> None:
        """What other objects of the module have where one has it: ``two.m`` beside ``one.m``."""
        kinds: dict[str, set[str]] = {}
        known = [node for some in self.pieces.values() for node in some.values()]
        kept = {name: trial.space.get(name) for name in (*trial.program.data, *trial.sets)}
        objects = {name: value for name, value in kept.items() if is_object(value)}
        for node in known:
            if isinstance(node, ast.Attribute) and isinstance(node.value, ast.Name):
                kinds.setdefault(type(objects.get(node.value.id)).__name__, set()).add(node.attr)
        for name, value in objects.items():
            for attr in sorted(kinds.get(type(value).__name__, ())):
                shape = _shape(vars(value).get(attr))
                if shape is not None:
                    one = ast.Attribute(ast.Name(name, ast.Load()), attr, ast.Load())
                    self.pieces.setdefault(shape, {}).setdefault(ast.unparse(one), one)

    def _of_idle_joints(self, trial: Trial, part: int) -> None:
        """Sine and cosine of a joint's position that the function uses nowhere."""
        tree = trial.trees[part]
        func = _sine(trial.space)
        if part or func is None:
            return
        given = [one.arg for one in tree.args.args][len(trial.bound) :]
        name = given[0] if given else ""
        rows = (self.shapes.get(one, ()) for one in given)  # of as many joints
        sizes = next((one for one in rows if len(one) == 1), ())
        calls = [x for x in nodes(tree) if isinstance(x, ast.Call) and called(x) in self.functions]
        for k in _idle_of(tree, name, sizes):
            entry = ast.Subscript(ast.Name(name, ast.Load()), ast.Constant(k), ast.Load())
            one: Any = ast.Call(copied(func), [entry], [])
            known = self.pieces.setdefault((), {})
            for made in (entry, one, Turned().visit(copied(one))):
                known.setdefault(ast.unparse(made), made)
            for call in calls:
                args = [entry if _is_entry_of(x, name) else x for x in call.args]
                made = ast.Call(call.func, args, call.keywords)
                if entry in args:
                    self.idle.append((self.observed.shape(call) or (), made))

    def _of_idle_rows(self, trial: Trial, part: int) -> None:
        """Entries that nothing uses of a list whose others are used one by one: ``P[2]``."""
        tree = trial.trees[part]
        lines = (node for node in nodes(tree) if isinstance(node, ast.Assign))
        rows = {
            line.targets[0].id: [self.observed.shape(one) for one in line.value.elts]
            for line in lines
            if isinstance(line.targets[0], ast.Name) and isinstance(line.value, ast.List)
        }
        within: dict[str, Sequence[ast.AST]] = {name: [tree] for name in rows}
        for name in trial.program.data:
            value = trial.space[name]
            if isinstance(value, list | tuple) and name not in rows:
                rows[name], within[name] = [_shape(one) for one in value], trial.trees
        for name, shapes in rows.items():
            idle = [_idle_of(one, name, (len(shapes),)) for one in within[name]]
            for k in set(idle[0]).intersection(*idle) if len(shapes) <= _JOINTS else ():
                entry = ast.Subscript(ast.Name(name, ast.Load()), ast.Constant(k), ast.Load())
                if (shape := shapes[k]) is not None:
                    self.pieces.setdefault(shape, {}).setdefault(ast.unparse(entry), entry)
                    self.idle_entries.add(ast.unparse(entry))

    def _of_idle_functions(self, trial: Trial, part: int) -> None:
        """Calls of the program's own functions that nothing calls, with what is at hand."""
        every = [x for one in trial.trees for x in nodes(one) if isinstance(x, ast.Call)]
        known = {self.observed.shape(x) for x in every if called(x) in self.functions}
        shapes = {_VECTOR, _MATRIX, _TWISTS, *(one for one in known if one)}
        here = [*self.unused, *self.counters, *(n for n, shape in self.shapes.items() if shape)]
        for name in _not_called(trial, {called(x) for x in every}):
            for given in here:
                call = ast.Call(ast.Name(name, ast.Load()), [ast.Name(given, ast.Load())], [])
                self.idle += [(shape, call) for shape in sorted(shapes)]
        rows = [one for one in self.unused if len(self.shapes[one]) == 1]
        counters = [ast.Name(one, ast.Load()) for one in self.counters]
        entries = [
            ast.Subscript(ast.Name(row, ast.Load()), counter, ast.Load())
            for row in sorted(rows)
            for counter in counters
        ]
        for name, count in self.functions.items() if entries else ():
            calls = (x for x in every if called(x) == name)
            shape = next(map(self.observed.shape, calls), None) or _MATRIX
            for k in range(count if len(shape) == 2 else 0):
                for entry in entries:
                    args: list[ast.expr] = [ast.Constant(0)] * k
                    args += [entry, *[ast.Constant(0)] * (count - k - 1)]
                    call = ast.Call(ast.Name(name, ast.Load()), args, [])
                    self.idle.append((shape, call))

    def _of_addends(self, statement: ast.Assign | ast.AugAssign) -> None:
        known = self.addends.setdefault(stem_of([statement]), set())
        literal = isinstance(statement.value, ast.List | ast.Tuple | ast.Call)
        for value in _entries(statement.value) if literal else (statement.value,):
            for one in summands(value) if isinstance(value, ast.BinOp | ast.Call) else ():
                bare = without_numbers(one)
                known |= {ast.unparse(one)} if bare is None else {ast.unparse(bare)}

    def _of_factors(self, product: ast.BinOp, observed: Observed) -> None:
        for one in (product.left, product.right):
            terms = [*summands(one)] if observed.shape(one) == () else []
            for term in terms if len(terms) > 1 else ():
                bare = without_numbers(term)
                self.inner.add(ast.unparse(term if bare is None else bare))

    def _of_member(self, node: ast.AST, observed: Observed) -> None:
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

    def _of_object(self, held: Any) -> None:
        named = isinstance(held, tuple) and hasattr(held, "_asdict")
        first = held[0] if isinstance(held, list | tuple) and held and not named else 0.0
        if not _is_number(first) or isinstance(first, tuple):
            self._of_object(first)
        own = self.keys if isinstance(held, dict) else self.attributes
        members = held if isinstance(held, dict) else getattr(held, "__dict__", {})
        members = held._asdict() if named else members
        for name, value in members.items():
            if isinstance(name, str) and name[:1] != "_" and _is_number(value):
                known = _shape(value)
                if known is not None:
                    own.setdefault(name, known)

    def _of_expression(self, node: ast.expr, observed: Observed, inner: set[str]) -> None:
        seen = observed.of(node)
        if seen is not None and seen.entries is not None and isinstance(node, ast.Name):
            self.lists.setdefault(node.id, seen.entries)
        if seen is None or seen.shape is None or isinstance(node, ast.Constant):
            return
        if isinstance(node, ast.Name):
            self.shapes.setdefault(node.id, seen.shape)
            if seen.whole and seen.shape == () and {*map(float, seen.values)} != {-1.0, 1.0}:
                return  # it counts, and is no sign
        text = ast.unparse(node)
        if not (inner - {*self.counters}).isdisjoint(names(node)) or len(text) > _LONG:
            return
        known = self.pieces.setdefault(seen.shape, {})
        for other in (*_entries_of_the_row(node, observed), *self._of_the_object(node, seen.shape)):
            known.setdefault(ast.unparse(other), other)
        own = known[text] = known.get(text) or copied(node)
        bare = without_numbers(node) if seen.shape == () else None
        if bare is not None:
            known.setdefault(ast.unparse(bare), copied(bare))
        if isinstance(own, ast.Call) and called(own) in ANGLES and own.args:
            self.angles.setdefault(ast.unparse(own.args[0]), own.args[0])
            self.taken[ast.unparse(own.args[0])] += 1
            turned = Turned().visit(copied(own))
            if isinstance(turned.func, ast.Attribute) or turned.func.id in self.angular:
                known.setdefault(ast.unparse(turned), turned)

    def _of_the_object(self, node: ast.expr, shape: Shape) -> Iterator[ast.expr]:
        """What else an object or a dictionary has: ``link.length`` beside ``link.centre``."""
        if isinstance(node, ast.Attribute) and node.attr in self.attributes:
            for one in self._owners(node.value):
                for name, own in self.attributes.items():
                    if own == shape:
                        yield ast.Attribute(copied(one), name, ast.Load())
        key = node.slice if isinstance(node, ast.Subscript) else None
        if isinstance(node, ast.Subscript) and isinstance(key, ast.Constant):
            for one in self._owners(node.value) if key.value in self.keys else ():
                for name, own in self.keys.items():
                    if own == shape and (name != key.value or one is not node.value):
                        yield ast.Subscript(copied(one), ast.Constant(name), ast.Load())

    def _owners(self, owner: ast.expr) -> list[ast.expr]:
        """An object or a dictionary, or those that counters count: ``links[k]`` of ``links[i]``."""
        if not isinstance(owner, ast.Subscript) or not isinstance(owner.slice, ast.Name):
            return [owner]
        counters = (ast.Name(one, ast.Load()) for one in self.counters)
        return [owner, *(ast.Subscript(owner.value, one, ast.Load()) for one in counters)]

    def dear(self, node: ast.expr) -> float:
        """What a piece costs more than one that is used nowhere."""
        if isinstance(node, ast.Name):
            return 0.0 if node.id in self.unused else _UNUSED / 2
        if self.idle_attributes and self.is_idle(node):
            return 0.0
        return 0.0 if self.uses_idle(node) else _UNUSED

    def crosses(self, node: ast.AST) -> bool:
        """Whether a call takes the product of two vectors, by whatever name."""
        if not isinstance(node, ast.Call) or len(node.args) != 2:
            return False
        own = self.cross is not None and ast.unparse(node.func) == ast.unparse(self.cross)
        return own or called(node) == "cross"

    def is_pose(self, node: ast.AST) -> bool:
        """Whether a matrix is a transform, which nobody transposes."""
        seen = self.observed.of(node)
        rows = [x[3] for x in seen.values if x.shape == (4, 4)] if seen is not None else []
        return bool(rows) and all(np.array_equal(row, (0, 0, 0, 1)) for row in rows)

    def stand(self, above: Sequence[ast.AST]) -> None:
        """Goes to a place of the part: counters of loops around it alone are known there."""
        around = [getattr(one, "generators", [one]) for one in above]
        loops = [x.target for some in around for x in some if hasattr(x, "iter")]
        self._inside = self._counted.union(name for target in loops for name in names(target))

    def pieces_here(self, shape: Shape) -> dict[str, ast.expr]:
        """The expressions of one shape that may stand there, by their text."""
        known = self._known_here.get((self._inside, shape))
        if known is None:
            outside = {*self.counters} - self._inside
            every = self.pieces.get(shape, {}).items()
            known = {text: one for text, one in every if outside.isdisjoint(names(one))}
            self._known_here[self._inside, shape] = known
        return known

    @property
    def counting(self) -> frozenset[str]:
        """The counters of the loops around the place."""
        return self._inside

    def names_in(self, statement: ast.stmt) -> frozenset[str]:
        """The names that a statement reads."""
        if id(statement) not in self._names_in:
            simple = isinstance(statement, ast.Assign | ast.AugAssign | ast.Return)
            read = names(statement, ast.Load) if simple else ()
            self._names_in[id(statement)] = frozenset(read)
        return self._names_in[id(statement)]

    def tests_here(self) -> list[ast.expr]:
        """The conditions that may stand there."""
        outside = {*self.counters} - self._inside
        return [one for one in self.tests.values() if outside.isdisjoint(names(one))]

    def simple(self, shape: Shape) -> Iterator[tuple[str, ast.expr]]:
        """Names, entries of lists and attributes of one shape."""
        for text, node in self.pieces_here(shape).items():
            if isinstance(node, ast.Name | ast.Subscript | ast.Attribute):
                yield text, node


def standing(
    trial: Trial, scopes: Sequence[Scope], asked: Callable[[Here], bool]
) -> Iterator[tuple[Here, Scope]]:
    """The places of a program that are asked for, each with the scope, which stands there.

    Args:
        trial: a program.
        scopes: those of its parts.
        asked: whether a place is meant.
    """
    for part, tree in enumerate(trial.trees):
        for here in places(part, tree):
            if asked(here):
                scopes[part].stand((*here.above, here.node))
                yield here, scopes[part]


def _used(tree: ast.AST) -> set[str]:
    """The names that are used for more than to be filled: ``J`` in ``J[:, j] = z``."""
    grown = {id(one) for node in nodes(tree) for one in _appended_to(node)}
    kept = (one for one in nodes(tree) if isinstance(one, ast.Name) and id(one) not in grown)
    return {one.id for one in kept if isinstance(one.ctx, ast.Load)} & reads(tree)


def _appended_to(node: ast.AST) -> Iterator[ast.expr]:
    """The list into which a statement only puts an entry more."""
    call = node.value if isinstance(node, ast.Expr) else None
    if isinstance(call, ast.Call) and isinstance(call.func, ast.Attribute):
        yield from [call.func.value] * (call.func.attr == "append")


def _filled_attributes(trial: Trial) -> set[str]:
    """The attributes at the end of which a program puts something."""
    every = [x for tree in trial.trees for x in nodes(tree) if isinstance(x, ast.Attribute)]
    kept = [x.value for x in every if x.attr == "append"]
    return {x.attr for x in kept if isinstance(x, ast.Attribute)}


def _read_attributes(trial: Trial) -> set[str]:
    """The attributes that a program reads, but to put something at the end of them."""
    every = [x for tree in trial.trees for x in nodes(tree) if isinstance(x, ast.Attribute)]
    filled = {id(x.value) for x in every if x.attr == "append"}
    return {x.attr for x in every if isinstance(x.ctx, ast.Load) and id(x) not in filled}


def _idle_entries(trial: Trial, shapes: dict[str, Shape]) -> set[str]:
    """The entries of rows that the function is given, and of which it uses others alone."""
    tree = trial.trees[0]
    given = [one.arg for one in tree.args.args][len(trial.bound) :]
    idle = [(name, k) for name in given for k in _idle_of(tree, name, shapes.get(name, ()))]
    return {f"{name}[{k}]" for name, k in idle}


def _idle_of(tree: ast.AST, name: str, sizes: Shape) -> list[int]:
    """The entries of a row that nothing uses, where single ones are used alone."""
    entries = [x for x in nodes(tree) if isinstance(x, ast.Subscript)]
    used = [k for k in (_entry_of(x, name) for x in entries) if k is not None]
    loads = [x for x in names(tree, ast.Load) if x == name]
    alone = len(loads) == len(used) and len(sizes) == 1
    return sorted({*range(sizes[0])}.difference(used)) if alone else []


def _not_called(trial: Trial, called_: Container[str]) -> Iterator[str]:
    """The module's functions of one argument that the program does not call, and could."""
    program = trial.program
    for name, value in program.space.items():
        if name in called_ or not isinstance(value, FunctionType):
            continue
        own = value.__module__ in program.modules and value.__name__ == name
        known = {part.name for part in program.parts}
        alone = value.__code__.co_argcount == 1 and name not in known
        if own and alone and _is_readable(value):
            yield name


@lru_cache(maxsize=64)
def _is_readable(function: FunctionType) -> bool:
    return read(function) is not None


def _pi_of(space: dict[str, Any]) -> ast.expr | None:
    if isinstance(space.get("np"), ModuleType):
        return PI
    for name, value in space.items():
        if isinstance(value, float) and value == pi:
            return ast.Name(name, ast.Load())
        if isinstance(value, ModuleType) and getattr(value, "pi", None) == pi:
            return ast.Attribute(ast.Name(name, ast.Load()), "pi", ast.Load())
    return None


def _sine(space: dict[str, Any]) -> ast.expr | None:
    """How a program may call the sine; None where it cannot."""
    if callable(space.get("sin")) and callable(space.get("cos")):
        return ast.Name("sin", ast.Load())
    known = [name for name, x in space.items() if isinstance(x, ModuleType) and hasattr(x, "sin")]
    name = "np" if "np" in known else next(iter(known), None)
    return None if name is None else ast.Attribute(ast.Name(name, ast.Load()), "sin", ast.Load())


def _root(calls: list[ast.Call], space: dict[str, Any]) -> ast.expr | None:
    """The function with which a part takes roots, or with which it may."""
    own = next((call.func for call in calls if called(call) == "sqrt"), None)
    if own is not None or "sqrt" in space:
        return own or ast.Name("sqrt", ast.Load())
    for name, value in space.items():
        if isinstance(value, ModuleType) and hasattr(value, "sqrt"):
            return ast.Attribute(ast.Name(name, ast.Load()), "sqrt", ast.Load())
    return None


def _cross(calls: list[ast.Call], observed: Observed, has_numpy: bool) -> ast.expr | None:
    """The function with which a part takes products of vectors; without one numpy's."""
    for call in calls:
        seen = [observed.of(one) for one in (*call.args, call)]
        rows = [one.values[:1] for one in seen if one is not None and one.shape == (3,)]
        if len(call.args) == 2 and len(rows) == len(seen) and all(rows):
            (one,), (other,), (found,) = rows
            if found.any() and np.allclose(found, np.cross(one, other)):
                return call.func
    return ast.Attribute(ast.Name("np", ast.Load()), "cross", ast.Load()) if has_numpy else None


def _crossing(trial: Trial, observed: Observed) -> list[str]:
    """The program's own functions that make a matrix of a twist, as to cross others with it."""
    own = {part.name for part in trial.program.parts}
    found: list[str] = []
    for node in (node for tree in trial.trees for node in nodes(tree)):
        alone = isinstance(node, ast.Call) and len(node.args) == 1 and called(node) in own
        if alone and isinstance(node, ast.Call) and observed.shape(node) == (6, 6):
            found += [called(node)] * (observed.shape(node.args[0]) == (6,))
    return [*dict.fromkeys(found)]


def _while_counters(tree: ast.FunctionDef, observed: Observed) -> Iterator[str]:
    """The names of whole numbers that a ``while`` loop counts on."""
    for loop in (node for node in nodes(tree) if isinstance(node, ast.While)):
        for node in (one for line in loop.body for one in nodes(line)):
            target = node.targets[0] if isinstance(node, ast.Assign) else getattr(node, "target", 0)
            if isinstance(node, ast.Assign | ast.AugAssign) and isinstance(target, ast.Name):
                uses = (x for x in nodes(loop) if isinstance(x, ast.Name) and x.id == target.id)
                seen = next((y for y in map(observed.of, uses) if y is not None), None)
                if seen is not None and seen.whole and seen.shape == ():
                    yield target.id


def _counts(tree: ast.FunctionDef, observed: Observed, known: list[str]) -> list[str]:
    """Names of whole numbers that a part is given, and that are no counters of its own."""
    given = {one.arg for one in tree.args.args}
    found: list[str] = []
    for node in nodes(tree):
        if isinstance(node, ast.Name) and node.id in given and node.id not in (*known, *found):
            seen = observed.of(node)
            if seen is not None and seen.whole and seen.shape == ():
                found.append(node.id)
    return found


def _entries(value: ast.expr) -> Iterator[ast.expr]:
    """The entries of what is written as rows: ``np.array([[a, b], [c, d]])``."""
    inner = value.args[:1] if isinstance(value, ast.Call) else getattr(value, "elts", None)
    if inner is None:
        yield value
    for one in inner or ():
        yield from _entries(one) if isinstance(one, ast.List | ast.Tuple) else (one,)


def summands(node: ast.expr) -> Iterator[ast.expr]:
    if isinstance(node, ast.BinOp) and isinstance(node.op, ast.Add | ast.Sub):
        yield from summands(node.left)
        yield from summands(node.right)
    else:
        yield node


class Turned(ast.NodeTransformer):
    """Sine for cosine and cosine for sine.

    Args:
        known: names; ``c12`` is taken for ``s12`` where both are among them.
    """

    def __init__(self, known: Container[str] = ()) -> None:
        self.known = known

    def visit_Call(self, node: ast.Call) -> ast.expr:
        self.generic_visit(node)
        other = {"sin": "cos", "cos": "sin"}.get(called(node))
        if other is not None:
            if isinstance(node.func, ast.Attribute):
                node.func.attr = other
            else:
                node.func = ast.Name(other, ast.Load())
        return node

    def visit_Name(self, node: ast.Name) -> ast.Name:
        other = {"s": "c", "c": "s"}.get(node.id[:1], "") + node.id[1:]
        both = node.id in self.known and other in self.known
        return ast.Name(other, node.ctx) if both else node


def statement_of(above: Sequence[ast.AST]) -> ast.stmt:
    """The innermost statement."""
    return next(one for one in reversed(above) if isinstance(one, ast.stmt))


def stem_of(above: Sequence[ast.AST]) -> str:
    """What a statement sets, without its number or indices: ``m`` of ``m12``, ``M`` of an entry."""
    statement = statement_of(above)
    if not isinstance(statement, ast.Assign | ast.AugAssign):
        return ""
    target = statement.target if isinstance(statement, ast.AugAssign) else statement.targets[0]
    return ast.unparse(target).split("[")[0].rstrip("0123456789")


def _given(trial: Trial, part: int, observed: Observed) -> dict[str, Shape]:
    """What a part is given, by the names that it has for it."""
    names = [one.arg for one in trial.trees[part].args.args]
    owned = trial.program.parts[part].owner is not None
    own = () if part else zip(names[len(trial.bound) :], observed.given, strict=False)
    found = {name: shape for name, shape in own if shape is not None}
    for tree in trial.trees if part else ():
        for node in nodes(tree):
            if isinstance(node, ast.Call) and called(node) == trial.program.parts[part].name:
                for name, value in zip(names[owned:], node.args, strict=False):
                    seen = observed.of(value)
                    if seen is not None and seen.shape is not None and not seen.whole:
                        found.setdefault(name, seen.shape)
    return found


def _entries_of_the_row(node: ast.expr, observed: Observed) -> Iterator[ast.expr]:
    """The other entries of a row of which one is used, the other columns: ``T[:3, 3]``."""
    if not isinstance(node, ast.Subscript):
        return
    sizes = observed.shape(node.value) or ()
    key = node.slice
    if isinstance(key, ast.Constant) and type(key.value) is int:
        for k in range(sizes[0] if len(sizes) == 1 and sizes[0] <= _SHORT else 0):
            yield ast.Subscript(copied(node.value), ast.Constant(k), ast.Load())
    elif isinstance(key, ast.Tuple) and isinstance(key.elts[0], ast.Slice) and sizes == (4, 4):
        column = key.elts[-1]
        if isinstance(column, ast.Constant) and type(column.value) is int:
            for k in range(sizes[1]):
                other = ast.Tuple([copied(key.elts[0]), ast.Constant(k)], ast.Load())
                yield ast.Subscript(copied(node.value), other, ast.Load())


def _entry_of(node: ast.Subscript, name: str) -> int | None:
    """Which entry of a row it is; None where it is none."""
    own = isinstance(node.value, ast.Name) and node.value.id == name
    index = node.slice.value if own and isinstance(node.slice, ast.Constant) else None
    return index if type(index) is int else None


def _is_entry_of(node: ast.expr, name: str) -> bool:
    return isinstance(node, ast.Subscript) and _entry_of(node, name) is not None


def _is_number(value: object) -> bool:
    return isinstance(value, int | float | list | tuple | np.ndarray)


def _shape(value: object) -> Shape | None:
    if isinstance(value, bool):
        return None
    try:
        numbers = np.asarray(value)
    except ValueError:
        return None
    return numbers.shape if numbers.dtype.kind in "fi" else None


def _as_rows(over: ast.expr, trial: Trial) -> ast.expr:
    """What a loop goes over, with what a function of the program's yields in its place."""
    if not isinstance(over, ast.Call):
        return over
    for part, tree in zip(trial.program.parts, trial.trees, strict=True):
        given = [one.value for one in nodes(tree) if isinstance(one, ast.Yield) and one.value]
        if part.name == called(over) and given:
            return ast.List(given[-1:], ast.Load())
    return ast.Call(over.func, [_as_rows(one, trial) for one in over.args], over.keywords)


def _passed(target: ast.expr, over: ast.expr, observed: Observed) -> Iterator[tuple[str, Shape]]:
    """The names that a loop sets to entries of tables and lists, each with its shape."""
    inner = over.args if isinstance(over, ast.Call) else []
    parts = target.elts if isinstance(target, ast.Tuple) else []
    if isinstance(over, ast.Call) and called(over) == "zip" and len(inner) == len(parts):
        for one, own in zip(parts, inner, strict=True):
            yield from _passed(one, own, observed)
        return
    if isinstance(over, ast.Call) and called(over) == "enumerate" and inner and len(parts) == 2:
        yield from _passed(parts[1], inner[0], observed)
        return
    rows = over.elts if isinstance(over, ast.List | ast.Tuple) else []
    first = rows[0] if rows else None
    if parts and isinstance(first, ast.Tuple):
        for one, entry in zip(parts, first.elts, strict=False):
            known = observed.shape(entry)
            if isinstance(one, ast.Name) and known is not None and not _whole(entry, observed):
                yield one.id, known
        return
    shape = observed.shape(over)
    if not shape or (isinstance(over, ast.Call) and called(over) in ("range", "reversed")):
        return
    if isinstance(target, ast.Name) and (shape[1:] or not _whole(over, observed)):
        yield target.id, shape[1:]
    for one in parts if len(shape) > 1 else ():
        if isinstance(one, ast.Name):
            yield one.id, shape[2:]


def _whole(node: ast.AST, observed: Observed) -> bool:
    seen = observed.of(node)
    return seen is not None and seen.whole


def _set(target: ast.expr, value: ast.expr) -> Iterator[tuple[str, ast.expr]]:
    """The names that an assignment sets, each with its value."""
    for one, part in paired(target, value):
        if isinstance(one, ast.Name):
            yield one.id, part


def _set_by(tree: ast.AST, functions: Container[str]) -> set[str]:
    """The names that are set to what one of some functions gives."""
    lines = [node for node in nodes(tree) if isinstance(node, ast.Assign)]
    pairs = (pair for one in lines for target in one.targets for pair in _set(target, one.value))
    return {name for name, x in pairs if isinstance(x, ast.Call) and called(x) in functions}


def _tests(tree: ast.AST, trial: Trial, counters: Sequence[str]) -> dict[str, ast.expr]:
    """Conditions on what a counter counts, by their text."""
    every = [node for one in trial.trees for node in nodes(one)]
    asked = [node.test for node in every if isinstance(node, ast.If | ast.IfExp)]
    here = {*names(tree), *counters}
    found = [one for one in asked if not {*counters}.isdisjoint(names(one))]
    found = [one for one in found if here.union(trial.space) >= {*names(one)}]
    found = [one for one in found if not {*names(one)} <= {*counters}]  # no first or last joint
    used = {name for one in trial.trees for name in names(one)}
    for name, value in trial.space.items():
        listed = isinstance(value, str | list | tuple) and name not in used
        if not listed or not all(isinstance(one, str | bool) for one in value):
            continue
        kinds = {*value}
        if len(kinds) != 2:
            continue
        for counter in counters:
            entry = ast.Subscript(ast.Name(name, ast.Load()), ast.Name(counter, ast.Load()))
            entry.ctx = ast.Load()
            kind = sorted(kinds)[0]
            test = ast.Compare(entry, [ast.Eq()], [ast.Constant(kind)])
            found.append(entry if isinstance(kind, bool) else test)
    return {ast.unparse(one): copied(one) for one in found}


def _set_together(tree: ast.AST) -> dict[str, set[str]]:
    """Names that are set to the entries of one thing."""
    found: dict[str, set[str]] = {}
    for node in nodes(tree):
        if isinstance(node, ast.Assign) and not isinstance(node.value, ast.Tuple | ast.List):
            for target in node.targets:
                every = names(target) if isinstance(target, ast.Tuple) else []
                for name in every:
                    found.setdefault(name, set()).update(every)
    return found


def _unpacked(target: ast.expr, value: ast.expr, observed: Observed) -> Iterator[tuple[str, Shape]]:
    """The names that an assignment sets, each with the shape of its value."""
    for name, part in _set(target, value):
        shape = observed.shape(part)
        if shape is not None:
            yield name, shape
    if isinstance(target, ast.Tuple) and not isinstance(value, ast.Tuple):
        shape = observed.shape(value)
        for one in target.elts:
            if isinstance(one, ast.Name) and shape:
                yield one.id, shape[1:]
