"""What speaks against an edit: that what it changes is already what a textbook has.

A function that returns the mass matrix at every call has no slip in it, nor has a statement whose
value is the angular velocity of a link: what makes the program right by spoiling it is a
coincidence of the numbers.
"""

from __future__ import annotations

import ast
import re
from collections import Counter
from collections.abc import Iterator, Sequence
from typing import Any

import numpy as np

from kinlab.arrays import Array
from kinlab.doctor.bytecode.syntax import beginning, called, factors, names, nodes, pieces
from kinlab.doctor.glossary.meaning import in_space
from kinlab.doctor.glossary.textbook import Glossary, Row, Sense
from kinlab.doctor.program.edits.scope.forms import summands
from kinlab.doctor.program.edits.scope.part import CENTRES
from kinlab.doctor.program.grounds.called import kinds_called, stem, unlike
from kinlab.doctor.program.grounds.helpers import true_helpers
from kinlab.doctor.program.grounds.scaled import is_free, is_own
from kinlab.doctor.program.observed import Observed, Seen
from kinlab.doctor.program.places import DATA, ProgramEdit, paired
from kinlab.doctor.program.trial import Trial, named_in
from kinlab.tolerances import TOLERANCES

_SOUND = 0.2
"""What an edit costs more in a function whose answers are all right."""
_TRUSTED = 0.1
"""What it costs more in a function of which a right value is made."""
_COINCIDENT = 0.04
"""What a factor costs more that a name of the program has as its value: 1/2 where l1 is 0.5."""
_TWICE = 2
_UNLIKE = 0.15
"""What it costs more to add numbers whose names are those of a mass and of a length."""
_BESIDE_NOTHING = 0.15
"""What it costs more to add a term beside one like it that is nothing at all."""
_AS_PARTS = 0.1
"""What it costs less to turn a part of what is turned elsewhere by the same matrix."""
_SPOILED = 0.15
"""What an edit costs more that spoils what is right."""
_SHARED = 0.05
"""What it costs more to add to a right value that is used in several places."""
_USED = 0.07
"""What it costs more to put right where a value is used than where it is worked out."""
_RENAMED = 0.09
"""The same of a name that is another name for something."""
_MEANT = 0.1
"""What it costs less to make a textbook's function of one with the other sign, or a chain of
transforms of one whose names do not follow on one another."""
_AGREED = 0.04
"""What it costs more to give a function something else for what has the argument's own name."""
_WHOLE = (
    "M",
    "J",
    "C",
    "Jv",
    "Jw",
    "gravity",
    "tool_pose",
    "kinetic",
    "potential",
    "C v",
    "bias",
    "tau",
)
"""Things of which an arm has one."""
_STEPS = ("T", "T0", "R", "R0", "frame_inertia")
"""Things of which it has one for each joint, which a function of the joint's number returns."""
_POINTS = ("coordinate", "centre_coordinate", "tool_coordinate", "origin", "centre", "tool_point")
"""A point of the arm, or one coordinate of it."""
_OWN = ("cell", "mass", "centre_distance", "Izz", "joint_Izz", "parameter")
"""The arm's own numbers, which do not vary: any value may meet one."""
_LAYOUTS = ("entries swapped", "rows", "rows swapped", "transposed", "order", "index")
"""Kinds of edit that make another of the textbooks' functions of one."""
_OF_A_FORMULA = ("factor", "missing factor", "extra factor", "power", "missing term", "extra term")
"""Kinds of edit that leave nothing of a textbook's function as it is."""
_WHOLLY = ("sign", "factor")
"""Kinds of edit that leave a value right at no pass, where they change it as a whole."""
_STATES = ("q", "qd", "qdd", "positions", "velocities", "accelerations", "given")
"""What is given: another name for it may be meant to be more."""
_OF_THE_WHOLE = (*_WHOLLY, "transposed", "missing matrix", "missing term")
"""Kinds of edit that may as well stand where a value is worked out."""
_OF_A_TWIST = "vwlop"
"""Last letters of names for the two halves of a twist: ``Jv``, ``Jw``; ``Jl``, ``Jo``."""
_MASSES = ("m", "mass")
"""Names of the mass of a link, without their numbers."""
_SPOILING = ("sign", "factor", "number", "power", "parentheses", "extra term", "missing factor")
"""Kinds of edit that leave no right value right; another index makes another thing."""


class Grounds:
    """What is right in a program before anything is changed.

    Args:
        trial: the program.
        observed: what its expressions were at the states that it was watched at.
        known: the textbook's things at these states; none of a robot without a table.
        stepping: whether it may take differences: its vectors are then those of states beside.
        robot: whose own numbers are right as they are.
    """

    def __init__(
        self,
        trial: Trial,
        observed: Observed,
        known: list[Glossary],
        stepping: bool = False,
        robot: Any = None,
    ) -> None:
        self.robot = robot
        self.trial, self.observed = trial, observed
        self.near = TOLERANCES.of_a_state_beside if stepping else TOLERANCES.same_relation
        self.known = known
        self.right: set[int] = set()
        self.partly: set[int] = set()
        self.flags: set[int] = set()
        self.central: set[int] = set()
        self.values: set[float] = set()
        self.sound: set[int] = set()
        self.trusted: set[int] = set()
        self.doubted: set[int] = set()
        self.shared: set[int] = set()
        self.helpers: set[int] = set()
        self.mirrored: set[int] = set()
        self.crossing: set[int] = set()
        self._of_data: dict[str, float] = {}
        self._wholes: dict[tuple[int, int], frozenset[str]] = {}
        self.worked_out = {
            (part, name) for part, tree in enumerate(trial.trees) for name in _worked_out(tree)
        }
        self.used = Counter(name for tree in trial.trees for name in names(tree, ast.Load))
        self.once = {name for name, count in self.used.items() if count == 1}
        self.renamed = {name for tree in trial.trees for name in _renamed(tree)} & self.once
        self.chains = {
            id(node.value): step
            for tree in trial.trees
            for node in nodes(tree)
            if isinstance(node, ast.Assign) and isinstance(node.value, ast.BinOp)
            if isinstance(node.value.op, ast.MatMult) and (step := _step(node.targets[0]))
        }
        self.agreed = {id(node) for tree in trial.trees for node in self._agreed(tree)}
        self.silent = self._silent()
        taken = (
            node.right
            for tree in trial.trees
            for node in nodes(tree)
            if isinstance(node, ast.BinOp) and isinstance(node.op, ast.Sub)
        )
        self.downhill = {name for one in taken for name in _gradients(one)}
        self.parts = {part.name for part in trial.program.parts[1:]}
        every = (node for tree in trial.trees for node in nodes(tree))
        self.turned = {_turned_part(node) for node in every} - {None}
        self.helpers, self.mirrored = true_helpers(trial, observed)
        self.crossing = {k for k in self.helpers if self._has_one_order(trial.trees[k])}
        if not known:
            return
        for part, tree in enumerate(trial.trees):
            self._look(part, tree, observed)
            for node in nodes(tree):
                seen = observed.of(node) if isinstance(node, ast.Name | ast.Attribute) else None
                own = None if seen is None else seen.only
                self.values |= {own, 1 / own} if own else set()
        self.trusted -= self.doubted  # at rest what moves is silent
        self._below()

    def spoils_a_helper(self, edit: ProgramEdit) -> bool:
        """Whether a function would be spoilt that is right whatever it is given."""
        return edit.kind in _OF_A_FORMULA and edit.part in self.helpers

    def against(self, edit: ProgramEdit) -> float:
        """What an edit costs more than it would where nothing is known to be right."""
        # a helper may be right for twists that are laid out in the other order
        turned = edit.kind in _LAYOUTS and edit.part not in self.crossing
        helps = edit.part in self.helpers and not turned
        if edit.part in self.sound or helps:
            return _SOUND
        if edit.part == DATA:
            name = str(edit.node)
            if name not in self._of_data:
                self._of_data[name] = self._against_data(name)
            return self._of_data[name]
        if edit.kind in _SPOILING and id(edit.node) in self.right and not _about_the_other(edit):
            return _SPOILED
        if edit.kind in _SPOILING and id(edit.node) in self.central:
            return _SPOILED
        whole = edit.changes[0].holder is not edit.node
        if whole and edit.kind in _WHOLLY and id(edit.node) in self.partly:
            return _SPOILED
        if edit.kind == "factor" and id(edit.node) in self.flags:
            return _SPOILED
        if edit.kind == "sign" and (self._is_typed(edit.node) or self._mirrors(edit)):
            return _SPOILED
        if edit.kind == "sign" and (_goes_uphill(edit) or self._takes_a_mass_away(edit)):
            return _SPOILED
        if edit.kind == "missing matrix" and self._turns_a_table(edit):
            return _SPOILED
        if edit.kind in ("missing term", "transposed") and id(edit.node) in self.shared:
            return _SHARED
        if self.coincident(edit):
            return _COINCIDENT
        mirrored = edit.kind == "sign" and edit.part in self.mirrored
        if mirrored or self._makes_a_chain(edit) or self._turns_a_gradient(edit):
            return -_MEANT
        unlike_ = self._adds_unlike(edit.changes[0].new) or self._takes_another_centre(edit)
        more = _UNLIKE if unlike_ or self._spoils_a_number(edit) else 0.0
        more += _BESIDE_NOTHING if self._is_beside_nothing(edit) else 0.0
        more += _UNLIKE if _doubles(edit) or self._takes_a_point_twice(edit) else 0.0
        more -= _AS_PARTS if self._is_as_another_part(edit) else 0.0
        more += _AGREED if id(edit.node) in self.agreed else 0.0
        more += _USED * self._where_it_is_used(edit) + _RENAMED * self._turns_a_renamed(edit)
        return more + (_TRUSTED if edit.part in self.trusted else 0.0)

    def _is_as_another_part(self, edit: ProgramEdit) -> bool:
        """Whether a matrix is put in front of a part of what it stands in front of elsewhere.

        ``R @ wrench[3:]`` beside ``R @ wrench[:3]``.
        """
        return edit.kind == "missing matrix" and _turned_part(edit.changes[0].new) in self.turned

    def _is_beside_nothing(self, edit: ProgramEdit) -> bool:
        """Whether a term is added beside one like it that is nothing: rather that one is wrong.

        ``cross(w, z*qd)`` of this arm, where ``cross(R.T @ w, z*qd)`` would be added.
        """
        silent, new = self.silent.get(id(edit.node), []), edit.changes[0].new
        if edit.kind != "missing term" or not silent or not isinstance(new, ast.BinOp):
            return False
        known = {*map(ast.dump, summands(edit.node))}
        put = [x for x in summands(new) if isinstance(x, ast.Call) and ast.dump(x) not in known]
        return any(_are_alike(one, other) for one in put for other in silent)

    def _silent(self) -> dict[int, list[ast.Call]]:
        """Of sums, and what they are made of, the terms that are nothing; by identity."""
        found: dict[int, list[ast.Call]] = {}
        for tree in self.trial.trees:
            for node in nodes(tree):
                if not isinstance(node, ast.BinOp) or not isinstance(node.op, ast.Add | ast.Sub):
                    continue
                calls = [
                    x for x in summands(node) if isinstance(x, ast.Call) and self._is_nothing(x)
                ]
                for inner in (node, *_sums_in(node)) if calls else ():
                    found.setdefault(id(inner), calls)
        return found

    def _is_nothing(self, node: ast.expr) -> bool:
        """Whether an expression was zero wherever it was seen."""
        seen = self.observed.of(node)
        return seen is not None and seen.nothing

    def _takes_a_point_twice(self, edit: ProgramEdit) -> bool:
        """Whether an edit takes a point's coordinate twice: rather another point is meant."""
        node, new = edit.node, edit.changes[0].new
        if edit.kind != "factor" or not isinstance(node, ast.Name) or not self.known:
            return False
        twice = isinstance(new, ast.BinOp) and getattr(new.left, "value", None) == _TWICE
        senses = (self._of(node, self.observed) if twice else None) or ()
        return bool(senses) and all(one.what in _POINTS for one in senses)

    def _spoils_a_number(self, edit: ProgramEdit) -> bool:
        """Whether an edit turns round a number that the robot has as it is typed."""
        if edit.kind != "sign" or self.robot is None:
            return False
        node: Any = edit.node
        down = isinstance(node, ast.UnaryOp) and isinstance(node.op, ast.USub)
        value = getattr(node.operand if down else node, "value", None)
        if not isinstance(value, float) or not np.isfinite(value) or not is_free(value):
            return False
        value = -value if down else value
        return is_own(self.robot, value) and not is_own(self.robot, -value)

    def _mirrors(self, edit: ProgramEdit) -> bool:
        """Whether an edit puts a sign in front of a rotation matrix: of space it is none then."""
        new = edit.changes[0].new
        seen = self.observed.of(new.operand) if isinstance(new, ast.UnaryOp) else None
        if seen is None or seen.shape != (3, 3) or not seen.values:
            return False
        return all(map(_is_rotation, seen.values))

    def _turns_a_table(self, edit: ProgramEdit) -> bool:
        """Whether an edit turns all the vectors of a list, of which one is taken."""
        entry = edit.changes[0].holder
        if not isinstance(entry, ast.Subscript) or edit.changes[0].field != "value":
            return False
        shape = self.observed.shape(entry.value)
        return shape is not None and len(shape) > 1 and not isinstance(entry.slice, ast.Tuple)

    def _makes_a_chain(self, edit: ProgramEdit) -> bool:
        """Whether names follow on one another with an edit alone: ``T03 = T02 @ T23``."""
        holder, side = edit.changes[0].holder, edit.changes[0].field
        if id(holder) not in self.chains or side not in ("left", "right"):
            return False
        steps = [_step(edit.changes[0].new), _step(holder.right if side == "left" else holder.left)]
        first, last = steps if side == "left" else steps[::-1]
        kind, start, end = self.chains[id(holder)]
        if first is None or last is None:
            return False
        return first == (kind, start, last[1]) and last == (kind, first[2], end)

    def _turns_a_gradient(self, edit: ProgramEdit) -> bool:
        """Whether an edit turns round all that is called a gradient, and is taken away later:
        ``grad = -J.T @ (target - x)``; or takes away one that was added.
        """
        if edit.kind != "sign":
            return False
        change = edit.changes[0]
        if isinstance(change.new, ast.Sub) and isinstance(change.holder, ast.BinOp):
            return any(_gradients(change.holder.right))
        whole = isinstance(change.holder, ast.Assign) and change.field == "value"
        targets = change.holder.targets if whole else []
        return any(isinstance(one, ast.Name) and one.id in self.downhill for one in targets)

    def _takes_a_mass_away(self, edit: ProgramEdit) -> bool:
        """Whether a term that holds a mass is taken from another, both the arm's own numbers:
        ``m*lc - M*l`` for ``m*lc + M*l``. Masses add up.
        """
        holder = edit.changes[0].holder
        if not isinstance(holder, ast.BinOp) or not isinstance(holder.op, ast.Add):
            return False
        sides = [self.observed.of(x) for x in (holder.left, holder.right)]
        rows = [[] if x is None or x.shape != () else [*map(float, x.values)] for x in sides]
        fixed = all(_TWICE * len({*row}) <= len(row) for row in rows)  # at every state the same
        return fixed and all(
            row and min(row) > 0 and any(kinds_called(name) == ("mass",) for name in names(side))
            for row, side in zip(rows, (holder.left, holder.right), strict=True)
        )

    def _is_typed(self, node: Any) -> bool:
        """Whether it is an array of several numbers that are typed, whose signs are their own."""
        given = node.args if isinstance(node, ast.Call) else []
        if not given or not isinstance(given[0], ast.List):
            return False
        seen = self.observed.of(node)
        if seen is None or not seen.shape or not seen.values:
            return False
        first = seen.values[0]
        constant = all(np.array_equal(first, value) for value in seen.values)
        return constant and int(np.count_nonzero(first)) > 1

    def _turns_a_renamed(self, edit: ProgramEdit) -> bool:
        """Whether an edit turns round a term with another name for something: ``c112 = h``."""
        if edit.kind != "sign" or not isinstance(edit.node, ast.BinOp):
            return False
        if isinstance(edit.node.op, ast.MatMult):
            return False
        every = (x for term in summands(edit.node) for x in factors(term))
        return any(isinstance(x, ast.Name) and x.id in self.renamed for x in every)

    def _where_it_is_used(self, edit: ProgramEdit) -> bool:
        """Whether an edit turns round, or multiplies, a value that was worked out before.

        A term of a sum has its sign there.
        """
        node, holder = edit.node, edit.changes[0].holder
        if edit.kind not in _OF_THE_WHOLE:
            return False
        if edit.kind in _WHOLLY and isinstance(node, ast.Call) and called(node) in self.parts:
            return True  # half of what a function of the program's gives
        if edit.kind == "transposed" and isinstance(node, ast.BinOp):
            return isinstance(node.op, ast.Mult) and any(
                self._is_once(edit.part, side) for side in (node.left, node.right)
            )
        if edit.kind == "sign" and isinstance(node, ast.BinOp):
            if isinstance(node.op, ast.MatMult):  # ``R @ v`` of a vector that is used once
                return self._is_once(edit.part, node.right)
            return False
        if edit.kind == "sign" and isinstance(node, ast.Call) and called(node) == "solve":
            return self._is_once(edit.part, node.args[-1])
        targets = holder.targets if isinstance(holder, ast.Assign) else []
        alone = _one_name(node) if isinstance(node, ast.Call) else []
        if alone and [one.id for one in targets if isinstance(one, ast.Name)] == alone:
            return True  # ``t4 = arctan2(sin(t4), cos(t4))``
        if any(isinstance(one, ast.Name) and one.id in self.renamed for one in targets):
            return False  # another name for it
        while isinstance(node, ast.Call) and len(node.args) == 1:  # ``wrap(t4)``
            node, holder = node.args[0], node
        if isinstance(node, ast.Name) and (edit.part, node.id) in self.worked_out:
            term = isinstance(holder, ast.BinOp) and isinstance(holder.op, ast.Add | ast.Sub)
            known = self._whole(node)
            known -= {*_STATES} if edit.kind not in _WHOLLY else set()
            return not (known or (term and edit.kind in ("sign", "missing term")))
        return False

    def _whole(self, node: ast.expr) -> frozenset[str]:
        """What of a textbook's an expression was, as it stands there; asked for many edits."""
        seen = self.observed.of(node)
        key = id(seen), len(self.known)
        if key not in self._wholes:
            senses = self._of(node, self.observed) or ()
            self._wholes[key] = frozenset(one.what for one in senses if not one.form)
        return self._wholes[key]

    def _has_one_order(self, tree: ast.AST) -> bool:
        """Whether a part gives what is laid out in one way: a translation, or what turns round.

        The matrix of a cross product is the opposite of its transpose.
        """
        given = (node.value for node in nodes(tree) if isinstance(node, ast.Return) and node.value)
        seen = [self.observed.of(value) for value in given]
        values = [x for one in seen if one is not None for x in one.values]
        shape = values[0].shape if values else ()
        if shape == (4, 4):
            return all(x.shape == shape and np.array_equal(x[:3, :3], np.eye(3)) for x in values)
        return shape == (3, 3) and all(x.shape == shape and np.array_equal(x, -x.T) for x in values)

    def _is_once(self, part: int, node: ast.expr) -> bool:
        """Whether it is a name of what is worked out before, and used here alone."""
        name = node.id if isinstance(node, ast.Name) else ""
        return (part, name) in self.worked_out and name in self.once

    def _agreed(self, tree: ast.AST) -> Iterator[ast.Name]:
        """Names that are given to a function whose arguments are called so."""
        for call in (node for node in nodes(tree) if isinstance(node, ast.Call)):
            for part, other in zip(self.trial.program.parts, self.trial.trees, strict=True):
                if part.name == called(call):
                    taken = other.args.args[part.owner is not None :]
                    for given, one in zip(call.args, taken, strict=False):
                        if isinstance(given, ast.Name) and given.id == one.arg:
                            yield given

    def _adds_unlike(self, new: Any) -> bool:
        """Whether an edit makes a sum of the arm's numbers that are of different kinds."""
        if not isinstance(new, ast.BinOp) or not isinstance(new.op, ast.Add | ast.Sub):
            return False
        one, other = new.left, new.right
        if not isinstance(one, ast.Name) or not isinstance(other, ast.Name):
            return False
        known = (self.trial.space.get(name) for name in (one.id, other.id))
        return all(isinstance(x, int | float) for x in known) and unlike(one.id, other.id)

    def _takes_another_centre(self, edit: ProgramEdit) -> bool:
        """Whether a mass would be multiplied by the centre of another link: ``m2*lc1``."""
        name = _label_of(edit.changes[0].new)
        if edit.kind != "name" or stem(name) not in CENTRES:
            return False
        products = (
            node
            for node in nodes(self.trial.trees[edit.part])
            if isinstance(node, ast.BinOp) and isinstance(node.op, ast.Mult)
            if any(inner is edit.node for inner in nodes(node))
        )
        beside = {_label_of(one) for node in products for one in factors(node)}
        masses = {_digits_of(one) for one in beside if stem(one) in _MASSES}
        return bool(masses - {""}) and _digits_of(name) not in masses

    def _against_data(self, name: str) -> float:
        using = [k for k in self.trial.above[DATA] if name in names(self.trial.trees[k])]
        if using and all(k in self.sound for k in using):
            return _SOUND
        return _TRUSTED if using and all(k in self.trusted for k in using) else 0.0

    def coincident(self, edit: ProgramEdit) -> bool:
        """Whether an edit multiplies by a number that a name of the program has as its value."""
        return edit.kind == "factor" and _factor(edit) in self.values

    def count(self, observed: Observed) -> int:
        """How many statements give what a textbook has."""
        given = (_given(node) for tree in self.trial.trees for node in nodes(tree))
        return sum(self._of(one, observed) is not None for one in given if one is not None)

    def _look(self, part: int, tree: ast.FunctionDef, observed: Observed) -> None:
        """Statements that give what a textbook has, and whether the part returns it."""
        returned: list[bool] = []
        for node in nodes(tree):
            if not isinstance(node, ast.Assign | ast.Return) or node.value is None:
                continue
            if isinstance(node.value, ast.Tuple):
                for one in node.value.elts:
                    self._right_alone(one, observed)
                    self.partly |= {id(one)} if self._at_a_pass(one, observed) else set()
            if isinstance(node.value, ast.Call) and isinstance(node.value.func, ast.Name):
                for one in node.value.args:  # what is put into an object
                    if isinstance(one, ast.BinOp):
                        self._right_alone(one, observed)
            senses = self._of(node.value, observed)
            good = senses is not None
            if not good and self._at_a_pass(node.value, observed):
                self.partly.add(id(node.value))
            if _are_flags(observed.of(node.value)):
                self.flags |= {id(inner) for inner in nodes(node.value)}
            target = node.targets[0] if isinstance(node, ast.Assign) else None
            computed = good and not isinstance(node.value, ast.Name)
            if computed and isinstance(target, ast.Name) and self.used[target.id] > 1:
                self.shared.add(id(node.value))
            if isinstance(target, ast.Name) and self._is_moment(target.id, node.value, observed):
                self.right |= {id(node.value)}
                if re.search(r"[Ii]_?[cCgG]", target.id):  # about the centre, as its name says
                    self.central |= {id(inner) for inner in nodes(node.value)}
            if good and not isinstance(node.value, ast.Name) and not _of_either_sign(senses):
                self.right |= {id(inner) for inner in nodes(node)}
            near = self._is_whole(node.value, observed)
            if near:
                self.trusted |= self._called(node) - {0}
            elif isinstance(node.value, ast.Call) and observed.of(node.value) is not None:
                self.doubted |= {k for k in self._called(node.value.func) if not good}
            if isinstance(node, ast.Return) and observed.of(node.value) is not None:
                told = senses or []
                numbers = {one.number for one in told}
                apart = len(numbers) == len(told) > 1 and None not in numbers
                steps = good and apart and all(one.what in _STEPS for one in told)
                returned.append(near or steps)
        self._look_at_sums(tree, observed)
        if part and returned and all(returned):
            self.sound.add(part)

    def _look_at_sums(self, tree: ast.FunctionDef, observed: Observed) -> None:
        """Statements that add to what is a thing of the arm's once all is added: ``V += m*g*h``."""
        added: dict[str, list[ast.AugAssign]] = {}
        for node in nodes(tree):
            if isinstance(node, ast.AugAssign) and isinstance(node.target, ast.Name):
                added.setdefault(node.target.id, []).append(node)
        for node in nodes(tree) if added else ():
            if isinstance(node, ast.Name) and node.id in added and isinstance(node.ctx, ast.Load):
                senses = self._of(node, observed) or ()
                if senses and all(one.what in _WHOLE and not one.form for one in senses):
                    self.right |= {id(inner) for one in added[node.id] for inner in nodes(one)}

    def _is_moment(self, name: str, node: ast.expr, observed: Observed) -> bool:
        """Whether a moment of inertia is worked out, which a link of the arm's has."""
        seen = observed.of(node)
        if kinds_called(name) != ("moment",) or isinstance(node, ast.Constant | ast.Name):
            return False
        if seen is None or seen.shape != () or len({*map(float, seen.values)}) != 1:
            return False
        rows, gap = self.known[0].gaps(seen.values[0])
        own = [one.what == "Izz" for _rank, one in rows]
        return bool(gap[own].min(initial=np.inf) <= TOLERANCES.same_relation * seen.values[0])

    def _at_a_pass(self, node: ast.expr, observed: Observed) -> bool:
        """Whether a vector or matrix is a thing of its own at one of the passes."""
        seen = observed.of(node)
        if seen is None or not seen.shape or not self.known or not seen.values:
            return False
        for value in (
            seen.values[: seen.count // len(self.known)] if np.size(seen.values[0]) else ()
        ):
            rows, gap = self.known[0].gaps(value)
            near = TOLERANCES.same_relation * float(np.max(np.abs(value)))
            size = len(value)
            if value.shape == (size, size) and np.array_equal(value, np.eye(size)):
                # nothing turned or moved yet
                return True
            if not zeros_and_ones(value) and bool(rows) and bool(gap.min() <= near):
                return True
        return False

    def _right_alone(self, node: ast.expr, observed: Observed) -> None:
        senses = self._of(node, observed)
        if senses is not None and not _of_either_sign(senses):
            self.right |= {id(inner) for inner in nodes(node)}

    def _is_whole(self, node: ast.expr, observed: Observed) -> bool:
        """Whether a value is nearly one of the things that an arm has one of: also a little beside
        the state, where differences are taken."""
        seen = observed.of(node)
        if seen is None or not seen.shape or len(seen.values) < seen.count:
            return False
        return all(self._near(value) for value in seen.values)

    def _near(self, value: Array) -> bool:
        close = TOLERANCES.nearly_agrees * float(np.max(np.abs(value), initial=0.0))
        for known in self.known:
            rows, things = known.things.get(value.shape, ((), value))
            for (_rank, sense), thing in zip(rows, things, strict=False):
                if sense.what in _WHOLE and close and np.max(np.abs(thing - value)) <= close:
                    return True
        return False

    def _of(self, node: ast.expr, observed: Observed) -> list[Sense] | None:
        """What an expression was at each of its passes, the same at all the states.

        None where it was something unknown at one of them, or nothing but zeros and ones.
        """
        seen, count = observed.of(node), len(self.known)
        if seen is None or seen.shape is None or not count or seen.count % count:
            return None
        if len(seen.values) < seen.count:
            return None
        passes = seen.count // count
        found: list[Sense] = []
        for k in range(passes):
            values = [seen.values[k + passes * j] for j in range(count)]
            if not all(map(zeros_and_ones, values)):
                sense = self.thing(values)
                if sense is None:
                    return None
                found.append(sense)
        return found or None

    def thing(self, values: list[Array]) -> Sense | None:
        """A thing of the arm's that a value is at all the states: the first of several."""
        found = self._row(values)
        if found is None and 1 in values[0].shape:  # a column, or a row
            values = [np.squeeze(value) for value in values]
            found = self._row(values)
        if found is None and self.known[0].plane:
            found = next(filter(None, map(self._row, in_space(values))), None)
        return found

    def _row(self, values: list[Array]) -> Sense | None:
        same: Any = None
        rows: Sequence[Row] = ()
        for known, value in zip(self.known, values, strict=True):
            rows, gap = known.gaps(value)
            if not rows:
                return None
            near = self.near if value.size > 1 else TOLERANCES.same_relation
            here = gap <= near * float(np.max(np.abs(value)))
            same = here if same is None else same & here
        for k in np.flatnonzero(same) if same is not None else ():
            if rows[int(k)][1].what not in _OWN:
                return rows[int(k)][1]
        return None

    def _below(self) -> None:
        """Parts that only sound ones use are sound too; what a trusted one uses is trusted."""
        called = [self._called(tree) for tree in self.trial.trees]
        for _round in called:
            for k in range(1, len(called)):
                callers = [j for j, inside in enumerate(called) if j != k and k in inside]
                if callers and all(j in self.sound for j in callers):
                    self.sound.add(k)
                if any(j in self.sound | self.trusted for j in callers):
                    self.trusted.add(k)

    def _called(self, tree: ast.AST) -> set[int]:
        """The parts that are named in a tree."""
        inside = named_in(tree)
        return {k for k, part in enumerate(self.trial.program.parts) if part.name in inside}


def _doubles(edit: ProgramEdit) -> bool:
    """Whether an edit makes ``F + F``, or ``F - F``, of a sum: nobody writes that."""
    (change, *more) = edit.changes
    row = change.holder
    if more or not isinstance(row, ast.BinOp) or change.field not in ("left", "right"):
        return False
    beside = row.right if change.field == "left" else row.left
    new = change.new
    return (
        isinstance(row.op, ast.Add | ast.Sub)
        and isinstance(new, ast.Name | ast.Subscript | ast.Attribute)
        and ast.dump(new) == ast.dump(beside)
    )


def _of_either_sign(senses: list[Sense] | None) -> bool:
    """Whether they are things of which the opposite is one, too: -h, where h is D_122, is D_211."""
    return any(one.what == "christoffel_entry" for one in senses or ())


def _given(node: ast.AST) -> ast.expr | None:
    """What a statement returns, gives a name to, or puts at the end of a list."""
    if isinstance(node, ast.Assign | ast.Return):
        return node.value
    call = node.value if isinstance(node, ast.Expr) else None
    if isinstance(call, ast.Call) and called(call) == "append" and len(call.args) == 1:
        return call.args[0]
    return None


_STEP = re.compile(r"(.*?)_?(\d)_?(\d)")
"""The name of what leads from one frame to another: ``T03``, ``R_1_2``."""


def _label_of(node: Any) -> str:
    """What a name, or an attribute, is called; of a word, itself."""
    return node if isinstance(node, str) else str(getattr(node, "id", getattr(node, "attr", "")))


def _digits_of(name: str) -> str:
    return "".join(filter(str.isdigit, name))


def _one_name(node: Any) -> list[str]:
    """The name that an expression is made of, beside functions; empty where there are others."""
    calls = [one.func for one in pieces(node) if isinstance(one, ast.Call)]
    inside = {name for one in calls for name in names(one)}
    found = {*names(node)} - inside
    return [*found] if len(found) == 1 else []


def _step(node: Any) -> tuple[str, str, str] | None:
    """What a name of a transform says: which, from where, to where."""
    found = _STEP.fullmatch(node.id) if isinstance(node, ast.Name) else None
    return None if found is None else (found[1], found[2], found[3])


def _worked_out(tree: ast.AST) -> set[str]:
    """The names to which one statement gives what it works out, be it wrapped by a next one."""
    given = Counter(
        node.id
        for node in nodes(tree)
        if isinstance(node, ast.Name) and isinstance(node.ctx, ast.Store)
    )
    lines = [node for node in nodes(tree) if isinstance(node, ast.Assign)]
    given -= Counter(
        one.id
        for line in lines
        for one in line.targets
        if isinstance(one, ast.Name) and _one_name(line.value) == [one.id]
    )
    pairs = (pair for line in lines for pair in paired(line.targets[0], line.value))
    return {
        one.id
        for one, what in pairs
        if isinstance(one, ast.Name) and not isinstance(what, ast.Constant) and given[one.id] == 1
    }


def _renamed(tree: ast.AST) -> set[str]:
    """Names of what has another name too: ``c112 = h``."""
    lines = (node for node in nodes(tree) if isinstance(node, ast.Assign))
    pairs = (pair for line in lines for pair in paired(line.targets[0], line.value))
    every = ((one, what) for one, what in pairs if isinstance(what, ast.Name))
    return {one.id for one, _what in every if isinstance(one, ast.Name)}


def _goes_uphill(edit: ProgramEdit) -> bool:
    """Whether an edit adds what is called a gradient, and was taken away: ``q + rate*grad``."""
    change = edit.changes[0]
    added = isinstance(change.new, ast.Add) and isinstance(change.holder, ast.BinOp)
    return added and any(_gradients(change.holder.right))


def _gradients(node: ast.expr) -> Iterator[str]:
    """The names in an expression that gradients have."""
    return (name for name in names(node) if name.lower().startswith("grad"))


def _about_the_other(edit: ProgramEdit) -> bool:
    """Whether one right thing becomes another: a rod's moment about its middle that about its end,
    and the vector ``append(r, 0)`` a point.
    """
    both = getattr(edit.node, "value", None), edit.changes[0].new
    return edit.kind == "number" and both in ((3, 12), (12, 3), (0, 1))


def _are_flags(seen: Seen | None) -> bool:
    """Whether an array is of zeros and ones at every pass, and of more than zeros at one."""
    if seen is None or not seen.shape:
        return False
    return all(map(zeros_and_ones, seen.values)) and any(map(np.any, seen.values))


def zeros_and_ones(value: Array) -> bool:
    """Whether there is nothing else in a value, up to rounding, so that anything could be it."""
    near = TOLERANCES.rounding_leaves
    return all(min(abs(x), abs(abs(x) - 1)) <= near for x in value.ravel().tolist())


def _factor(edit: ProgramEdit) -> float:
    """The number by which an edit multiplies; 0 where it does something else."""
    new, old = edit.changes[0].new, 1.0
    if isinstance(new, ast.BinOp) and isinstance(new.op, ast.Div):  # ``a/(2*b)``
        below = _in_front(new.right)
        return 1.0 / below if below else 0.0
    if isinstance(new, ast.BinOp):
        return _in_front(new)
    if isinstance(edit.node, ast.Constant) and isinstance(edit.node.value, int | float):
        old = float(edit.node.value)
    return float(new) / old if isinstance(new, int | float) and old else 0.0


def _in_front(node: ast.expr) -> float:
    """The number that an expression begins with, 0.5 of ``0.5*w @ I @ w``; 0 without one."""
    first = beginning(node)
    value = getattr(getattr(first, "left", first), "value", 0.0)
    return float(value) if isinstance(value, int | float) else 0.0


def _is_rotation(value: Array) -> bool:
    """Whether a 3 x 3 matrix is one."""
    near = np.allclose(value @ value.T, np.eye(3), atol=TOLERANCES.formula_agrees)
    return near and bool(np.linalg.det(value) > 0.0)


def _turned_part(node: Any) -> tuple[str, str] | None:
    """The matrix and the name in ``R @ wrench[:3]``, and what names such as ``Jv`` and ``Jw`` have
    in common in ``R @ Jv``; None of anything else.
    """
    if not isinstance(node, ast.BinOp) or not isinstance(node.op, ast.MatMult):
        return None
    part = node.right
    if isinstance(part, ast.Name) and part.id[-1] in _OF_A_TWIST and part.id[:-1].isalpha():
        return ast.dump(node.left), part.id[:-1]
    if not isinstance(part, ast.Subscript) or not isinstance(part.slice, ast.Slice):
        return None
    return ast.dump(node.left), ast.dump(part.value)


def _sums_in(node: ast.expr) -> Iterator[ast.expr]:
    """The terms of a sum, and the sums that it is made of."""
    if isinstance(node, ast.BinOp) and isinstance(node.op, ast.Add | ast.Sub):
        for side in (node.left, node.right):
            yield side
            yield from _sums_in(side)


def _are_alike(one: ast.Call, other: ast.Call) -> bool:
    """Whether two calls are of one function, with an argument that is the same."""
    given = ({*map(ast.dump, call.args)} for call in (one, other))
    return called(one) == called(other) and bool(set.intersection(*given))
