"""What is known in one part of a program: its names, their shapes, its expressions."""

from __future__ import annotations

import ast
from collections import Counter
from collections.abc import Iterable, Sequence

from kinlab.arrays import Array
from kinlab.doctor.bytecode.syntax import called, copied, names, nodes, text_of
from kinlab.doctor.program.edits.chains import without_numbers
from kinlab.doctor.program.edits.scope import counters, functions, idle, members, pieces, terms
from kinlab.doctor.program.edits.scope import names as of_names
from kinlab.doctor.program.edits.scope.forms import Turned, entry, named
from kinlab.doctor.program.edits.scope.values import named_numbers
from kinlab.doctor.program.observed import Observed, Shape
from kinlab.doctor.program.places import ANGLES
from kinlab.doctor.program.trial import Trial

_LONG = 60
"""Letters up to which an expression is tried in other places."""
_FEW_NUMBERS, _FEW_ROWS = 6, 4
"""Names of a module's numbers, and of its rows, up to which a part may have forgotten any."""


class Knowledge:
    """What is known in one part: its names with their shapes, and its expressions.

    Attributes:
        observed: what its expressions were.
        space: what the module's names stand for.
        functions, methods: the program's own, each with how many arguments it asks for.
        called: the names of these, and of its methods.
        has_numpy: whether numpy is called ``np``.
        summed_from: the entries of which names are the sums: ``w = v[0] + v[1]``.
        sums_with: the names that are sums with an entry, by its text.
        accumulating: what itertools' function of sums up to each is called.
        shapes: names of numbers, by their shapes.
        lists: names of lists, by the shapes of their entries.
        levels: names of numbers that stay the same, with these.
        vectors: names of rows, with what they were.
        attributes: of objects, by their shapes.
        keys: of dictionaries, by the shapes of what is there.
        idle_keys: of these, those that the program never asks for.
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
        alike: the same, as they are typed but for the numbers of names.
        idle: calls that nothing makes, of functions or for joints that are used nowhere, by shape.
        inner: the terms of the sums that are factors, without their numbers.
        factors: what stands in front of a product of matrices, by the statements' identities.
        beside: names that are entries of one thing: ``w, dh, dr = v``.
        tests: conditions on what a counter counts, of kinds of joints that nothing asks, too.
        present, set_at: the names that it has, and the lines in which it sets them first.
        fronts: names in what stands in front of any product of matrices.
        divisors: what something is divided by, as text.
        differences: the two sides of each difference, as text.
        pi: how the program may write it; None where it cannot.
        root: what gives square roots, where it is known.
        cross: what gives the product of two vectors, where it is known.
        whole: names of whole numbers that are given to a function, and counters.
        dots: products of two vectors that are given to one function together.
        measures: names of whole numbers that count nothing.
        indices: the names by which entries of a row are taken, by the row's text.
    """

    def __init__(self, trial: Trial, observed: Observed, part: int) -> None:
        tree = trial.trees[part]
        self.observed, self.space = observed, trial.space
        self.shapes: dict[str, Shape] = {}
        self.lists: dict[str, Shape] = {}
        self.angles: dict[str, ast.expr] = {}
        self.dots: dict[str, ast.expr] = {}
        self.taken: Counter[str] = Counter()
        self.pieces: pieces.Pieces = {}
        self.idle: list[pieces.Sized] = []
        self.levels: dict[str, float] = {}
        self.vectors: dict[str, Sequence[Array]] = {}
        self._ask_for_functions(trial, tree)
        self._take_sums_apart(tree)
        gathered = self._enter_loops(trial, tree)
        self._members = members.members_of(trial, observed)
        self.attributes, self.keys = self._members.attributes, self._members.keys
        self.idle_keys = {*self.keys} - self._members.asked
        self.idle_attributes = {*self.attributes} - members.read_attributes(trial)
        self.shapes |= of_names.given(trial, part, observed)
        self._read_expressions(trial, tree, gathered)
        self._tell_names(tree)
        self._count(trial, tree)
        self._know_numbers(trial)
        self._find_unused(trial, part)
        self._put_names(trial)
        self._put_members(trial, part)
        self._put_idle(trial, part)
        self._put_all(pieces.unit_matrices(self.pieces) if self.has_numpy else ())
        self._put_all(pieces.counted(self.lists, self.counters))
        read = pieces.read_from(tree)
        unread = [name for name in self.lists if name not in read]
        self._put_all(pieces.of_the_next(self.pieces, self.lists, unread))

    def _ask_for_functions(self, trial: Trial, tree: ast.AST) -> None:
        """What the part may call: the program's functions, and others."""
        space, parts = trial.space, trial.program.parts
        calls = [node for node in nodes(tree) if isinstance(node, ast.Call)]
        self.functions = {p.name: len(p.tree.args.args) for p in parts[1:] if p.owner is None}
        self.methods = functions.methods_of(trial)
        self.called = {p.name for p in parts[1:]}
        self.uncalled = [*idle.not_called(trial)]
        self._angular = {name for name in ANGLES if callable(space.get(name))}
        self.has_numpy = functions.has_numpy(space)
        self.summed_from, self.sums_with = pieces.summed_from(tree), pieces.sums_with(tree)
        self.accumulating = functions.accumulating(space)
        self.pi = functions.pi_of(space)
        self.ranges = [copied(node) for node in calls if called(node) == "range"]
        self.cross = functions.cross_of(calls, self.observed, space)
        self.crossing = functions.crossing_of(trial, self.observed)
        self.root = functions.root_of(calls, space)

    def _take_sums_apart(self, tree: ast.AST) -> None:
        """The terms and factors of its sums and products."""
        self.divisors, self.fronts = terms.divisors_of(tree), terms.fronts_of(tree)
        self.differences = terms.differences_of(tree)
        self.alike = terms.alike_of(tree)
        self.addends, self.factors = terms.addends_of(tree), terms.factors_of(tree)
        self.inner = terms.inner_terms_of(tree, self.observed)

    def _enter_loops(self, trial: Trial, tree: ast.FunctionDef) -> set[str]:
        """What its loops set and count; gives the names that only comprehensions set."""
        self.counters: list[str] = []
        inner, outer = set[str](), set[str]()
        things, self._run_over = counters.things(tree), list[str]()
        for node in nodes(tree):
            if isinstance(node, ast.For | ast.comprehension):
                set_here = names(node.target)
                passed = of_names.of_loop(node, trial, self.observed)
                self.shapes |= {n: s for n, s in passed.items() if n not in self.shapes}
                known = (*self.counters, *passed, *things)
                self.counters += [name for name in set_here if name not in known]
                self._run_over += [name for name in set_here if name in things]
                (inner if isinstance(node, ast.comprehension) else outer).update(set_here)
        self._counted = frozenset(counters.while_counters(tree, self.observed))
        self.counters += [name for name in sorted(self._counted) if name not in self.counters]
        return inner - outer

    def _read_expressions(self, trial: Trial, tree: ast.AST, gathered: set[str]) -> None:
        """Its expressions as pieces, and the shapes of its names.

        Args:
            trial: the program.
            tree: the part.
            gathered: names that are known in comprehensions alone.
        """
        for node in nodes(tree):
            if isinstance(node, ast.expr):
                self._read_expression(node, gathered)
            if isinstance(node, ast.Assign) and len(node.targets) == 1:
                target, value = node.targets[0], node.value
                for name, shape in of_names.unpacked(target, value, trial, self.observed):
                    self.shapes.setdefault(name, shape)
                self._read_levels(target, value)

    def _read_levels(self, target: ast.expr, value: ast.expr) -> None:
        """Numbers of names that are set, also of one that nothing uses: ``l1, lc1 = 0.5, 0.25``."""
        lists = isinstance(target, ast.Tuple) and isinstance(value, ast.Tuple | ast.List)
        pairs = zip(target.elts, value.elts, strict=False) if lists else [(target, value)]  # type: ignore[attr-defined]
        for name, given in pairs:
            if not isinstance(name, ast.Name) or name.id in self.levels:
                continue
            seen = self.observed.of(given)
            if isinstance(given, ast.Constant) and type(given.value) is float:
                self.levels[name.id] = given.value
            elif seen is not None and (only := seen.only) is not None:
                self.levels[name.id] = only

    def _read_expression(self, node: ast.expr, gathered: set[str]) -> None:
        seen = self.observed.of(node)
        if seen is not None and seen.entries is not None and isinstance(node, ast.Name):
            self.lists.setdefault(node.id, seen.entries)
        if seen is None or seen.shape is None or isinstance(node, ast.Constant):
            return
        if isinstance(node, ast.Name):
            self.shapes.setdefault(node.id, seen.shape)
            if len(seen.shape) == 1 and seen.values:
                self.vectors.setdefault(node.id, seen.values)
            if (only := seen.only) is not None:
                self.levels[node.id] = only
            if seen.whole and seen.shape == () and {*map(float, seen.values)} != {-1.0, 1.0}:
                return  # it counts, and is no sign
        text = text_of(node)
        if not (gathered - {*self.counters}).isdisjoint(names(node)) or len(text) > _LONG:
            return
        known = self.pieces.setdefault(seen.shape, {})
        for other in pieces.others_of_the_row(node, self.observed):
            known.setdefault(text_of(other), other)
        for other in self._members.beside(node, seen.shape, self.counters):
            known.setdefault(text_of(other), other)
        for shape, other in self._members.unread_beside(node, self.idle_keys, self.idle_attributes):
            pieces.put(self.pieces, shape, other)
        own = known[text] = known.get(text) or copied(node)
        bare = without_numbers(node) if seen.shape == () else None
        if bare is not None:
            known.setdefault(text_of(bare), copied(bare))
        if isinstance(own, ast.Call) and called(own) in ANGLES and own.args:
            self._read_angle(own, known)
        if isinstance(own, ast.Call) and len(own.args) == 2 and not own.keywords:
            self._read_pair(*own.args)

    def _read_pair(self, one: ast.expr, other: ast.expr) -> None:
        """Two vectors that are given on together: what is asked of them beside is their product."""
        shapes = {self.shapes.get(getattr(x, "id", ""), ()) for x in (one, other)}
        if len(shapes) == 1 and len(*shapes) == 1:
            dot = ast.BinOp(one, ast.MatMult(), other)
            self.dots.setdefault(text_of(dot), dot)

    def _read_angle(self, call: ast.Call, known: dict[str, ast.expr]) -> None:
        """What a sine or cosine is taken of; the other of the two is as good a piece."""
        text = text_of(call.args[0])
        self.angles.setdefault(text, call.args[0])
        self.taken[text] += 1
        turned = Turned().visit(copied(call))
        if isinstance(turned.func, ast.Attribute) or turned.func.id in self._angular:
            known.setdefault(text_of(turned), turned)

    def _tell_names(self, tree: ast.FunctionDef) -> None:
        """What its names are: arguments, angles, what is set together."""
        here = {*names(tree, ast.Load)}
        self._local = {n.arg for n in nodes(tree.args) if isinstance(n, ast.arg)}
        self._local |= {*names(tree)} - here
        self.present = here | self._local
        self.set_at = of_names.first_lines(tree)
        self.beside = of_names.set_together(tree)
        self.arcs = of_names.set_by(tree, functions.ARCS)
        self.sines = of_names.set_by(tree, ANGLES)
        self.turned = {name for one in self.angles.values() for name in names(one)}

    def _count(self, trial: Trial, tree: ast.FunctionDef) -> None:
        """What is asked of its counters; those that are numbers."""
        self.tests = counters.tests(tree, trial, [*self.counters, *self._run_over])
        self.counters = [name for name in self.counters if self.shapes.get(name, ()) == ()]
        self.measures = counters.measures(trial)
        self.indices = counters.indices(tree)
        self.whole = [*self.counters, *counters.counts(tree, self.observed, self.counters)]

    def _know_numbers(self, trial: Trial) -> None:
        """The module's numbers."""
        space = trial.program.space
        self.constants = {name for name, x in space.items() if isinstance(x, float)}
        for name, shape in named_numbers(space):
            self.shapes.setdefault(name, shape)

    def _find_unused(self, trial: Trial, part: int) -> None:
        """What is set or given, and used nowhere."""
        known = (*self.shapes, *self.lists)
        self.unused = idle.unused_names(trial, trial.trees[part], self._local, known)
        self.idle_entries = set[str]() if part else idle.idle_entries(trial, self.shapes)

    def _put(self, shape: Shape, piece: ast.expr) -> None:
        pieces.put(self.pieces, shape, piece)

    def _put_all(self, found: Iterable[pieces.Sized]) -> None:
        for shape, piece in found:
            self._put(shape, piece)

    def _put_as_idle(self, found: Iterable[pieces.Sized]) -> None:
        for shape, piece in found:
            self._put(shape, piece)
            self.idle_entries.add(text_of(piece))

    def _put_names(self, trial: Trial) -> None:
        """Names that nothing uses and those that it may have forgotten, and their entries."""
        data = trial.program.data
        rows = [name for name in data if len(self.shapes.get(name, ())) == 1]
        for name, shape in self.shapes.items():
            if name in self.counters:
                continue
            plain, unused = named(name), name in self.unused
            if unused:
                self._put(shape, plain)
            forgotten = name in data and name not in self.present
            if forgotten and not shape and len(data) <= _FEW_NUMBERS:
                self._put((), plain)
            if forgotten and len(shape) == 1 and len(rows) <= _FEW_ROWS:
                self._put(shape, plain)
            if shape and (unused or len(shape) > 1 or forgotten):
                self.lists.setdefault(name, shape[1:])
            if unused and len(shape) == 1 and shape[0] <= idle.JOINTS:
                for k in range(shape[0]):
                    self._put((), entry(copied(plain), ast.Constant(k)))

    def _put_members(self, trial: Trial, part: int) -> None:
        """What objects have and nothing uses, or others of their kind have."""
        method, counting = trial.program.parts[part], (*self.counters, *self.whole)
        filled = members.filled_attributes(trial) - members.read_attributes(trial)
        self._put_as_idle(members.rows_beside(self.pieces, filled))
        self._put_all(members.of_its_object(method, self.pieces, self.attributes))
        unused = {name: self.attributes[name] for name in self.idle_attributes}
        self._put_all(members.idle_members(method, unused, counting))
        self._put_all(members.of_siblings(trial, self.pieces))

    def _put_idle(self, trial: Trial, part: int) -> None:
        """Joints, rows and functions that are used nowhere."""
        tree, sine = trial.trees[part], functions.sine_of(trial.space)
        if sine is not None and not part:
            for joint in idle.idle_joints(trial, self.shapes):
                self._put_all(((), one) for one in idle.with_its_angle(joint, sine))
                self.idle += idle.calls_for(joint, tree, self.functions, self.observed)
            for angle in idle.unturned(tree, self.turned):
                if self.shapes.get(angle.id) == ():
                    self._put_as_idle(((), x) for x in idle.with_its_angle(angle, sine))
        self._put_as_idle(idle.idle_rows(trial, tree, self.observed))
        own = self.functions
        at_hand = [*self.unused, *self.counters, *(n for n, shape in self.shapes.items() if shape)]
        self.idle += idle.uncalled(trial, self.observed, own, self.uncalled, at_hand)
        rows = sorted(one for one in self.unused if len(self.shapes[one]) == 1)
        self.idle += idle.calls_with_idle(trial, self.observed, own, rows, self.counters)
