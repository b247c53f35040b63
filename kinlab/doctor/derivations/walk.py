"""Walks a textbook's derivation, written as text, with one step or several taken otherwise.

A derivation is a short program in the textbooks' notation (:mod:`kinlab.doctor.derivations.books`):
assignments, with or without an index, and loops over the joints, outward or inward. It is walked
for all alternatives and all states at once: the leading axes of every value are the alternatives
and the states. An alternative puts another expression in the place of one or several of the
program's; only its own rows are worked out anew.
"""

from __future__ import annotations

import ast
from collections.abc import Callable, Iterable, Mapping
from copy import copy
from dataclasses import dataclass
from functools import lru_cache
from typing import Any

import numpy as np

from kinlab.arrays import Array
from kinlab.doctor.bytecode.syntax import nodes, text_of

Rows = Any
"""Which alternatives are worked out: their numbers in order, or None for all."""
Inputs = Callable[[Array], dict[str, Any]]
"""From positions (N, n), real or complex, to the values of the program's names."""


@dataclass(frozen=True, eq=False)
class Assignment:
    """One line of a derivation: the assignment, and what it is, in words; ``""`` for plumbing."""

    statement: ast.Assign
    about: str


@dataclass(frozen=True, eq=False)
class Program:
    """A derivation as text, read. Attributes: body; lines: all assignments."""

    body: tuple[ast.stmt, ...]
    lines: tuple[Assignment, ...]

    def work(self, n: int) -> int:
        """Assignments that one walk with n joints makes, those for slopes included."""
        return _assignments(self.body, n)


def _assignments(body: Iterable[ast.stmt], n: int) -> int:
    count = 0
    for statement in body:
        if isinstance(statement, ast.For):
            count += n * _assignments(statement.body, n)
        elif "slope(" in text_of(statement):
            count += 2 * n * count
        else:
            count += 1
    return count


@lru_cache(maxsize=256)
def program(text: str) -> Program:
    """Reads a derivation; the comment above a line says what it is."""
    tree = ast.parse(text)
    rows = text.splitlines()
    lines = []
    for node in nodes(tree):
        if isinstance(node, ast.Assign):
            above = rows[node.lineno - 2].strip() if node.lineno > 1 else ""
            lines.append(Assignment(node, above[2:] if above.startswith("# ") else ""))
    return Program(tuple(tree.body), tuple(sorted(lines, key=lambda x: x.statement.lineno)))


@dataclass(frozen=True, eq=False)
class Step:
    """One thing done otherwise in a derivation.

    Attributes:
        kind: its name. sentence: what the formula does, to follow "the formula ".
        edits: expressions of the program, each with what stands there instead.
        cost: how far-fetched it is.
        joint: where, from 1; None for all.
        about: the line that it is in, as the derivation has it; ``""`` where it is in several.
    """

    kind: str
    sentence: str
    edits: tuple[tuple[ast.expr, ast.expr], ...]
    cost: float = 1.1
    joint: int | None = None
    about: str = ""


class Absent(Exception):
    """A name or an index that the walk does not have: the alternative makes no sense."""


class Walk:
    """One walk of a program for all alternatives.

    Args:
        of: the program.
        inputs: the values of its names: (N, ...) each, or a list of them by joint, from 1 (None
            where there is none), or plain flags by joint.
        q: the positions at which they are asked for, (N, n).
        ways: the alternatives, each a combination of steps; ``()`` is the derivation itself.
        n: number of joints.
    """

    def __init__(
        self, of: Program, inputs: Inputs, q: Array, ways: list[tuple[Step, ...]], n: int
    ) -> None:
        self.of, self.inputs, self.q, self.ways, self.n = of, inputs, q, ways, n
        self.names: dict[str, Any] = {}
        self.given: frozenset[str] = frozenset()
        self.joint = 0
        self.axes: dict[int, tuple[int, ...]] = {}
        self.worked_out: dict[int, Array] = {}
        self.instead: dict[int, list[tuple[ast.expr, Any, Any]]] = {}
        marks: dict[tuple[int, int], tuple[ast.expr, ast.expr, list[int], list[int]]] = {}
        for row, way in enumerate(ways):
            for step in way:
                for old, new in step.edits:
                    mark = marks.setdefault((id(old), id(new)), (old, new, [], []))
                    mark[2].append(row)
                    mark[3].append(step.joint or 0)
        for old, new, rows, joints in marks.values():
            found = self.instead.setdefault(id(old), [])
            found.append((new, np.array(rows), np.array(joints) if any(joints) else None))

    def values(self, name: str) -> Array:
        """A name of the program after the walk, (B, N, ...)."""
        self.walk()
        return self.stacked(name)

    def walk(self) -> None:
        """Runs the program."""
        self.names = _lifted(self.inputs(self.q))
        self.given = frozenset(self.names)
        with np.errstate(all="ignore"):
            for statement in self.of.body:
                self._run(statement)

    def stacked(self, name: str) -> Array:
        """A name after the walk, (B, N, ...); of an indexed one all entries."""
        value = self.names[name]
        if isinstance(value, dict):
            parts = [self._full(value[k]) for k in range(1, max(value) + 1) if k in value]
            return np.stack(parts, axis=2)
        return self._full(value)

    def _full(self, value: Array) -> Array:
        return np.broadcast_to(value, (len(self.ways), len(self.q), *value.shape[2:]))

    def _run(self, statement: ast.stmt) -> None:
        if isinstance(statement, ast.For):
            assert isinstance(statement.target, ast.Name)
            assert isinstance(statement.iter, ast.Name)
            outer = self.joint
            order = range(1, self.n + 1)
            for k in reversed(order) if statement.iter.id == "inward" else order:
                self.joint = self.names[statement.target.id] = k
                for inner in statement.body:
                    self._run(inner)
            self.joint = outer
            return
        assert isinstance(statement, ast.Assign)
        target = statement.targets[0]
        if isinstance(statement.value, ast.Call) and _called(statement.value) == "slope":
            assert isinstance(target, ast.Name)
            self.names[target.id] = self._slope(statement)
            return
        self.worked_out = {}
        value = self.value(statement.value, None)
        if isinstance(target, ast.Subscript):
            assert isinstance(target.value, ast.Name)
            kept = self.names.setdefault(target.value.id, {})
            kept[self._index(target.slice)] = value
        else:
            assert isinstance(target, ast.Name)
            self.names[target.id] = value

    def _slope(self, statement: ast.Assign) -> Array:
        """d/dq of a name so far, by complex steps: the last axis is the joint."""
        assert isinstance(statement.value, ast.Call)
        name = statement.value.args[0]
        assert isinstance(name, ast.Name)
        parts = []
        for k in range(self.n):
            q = self.q + 1e-30j * np.eye(self.n)[k]
            other = Walk(self.of, self.inputs, q, self.ways, self.n)
            other.names = _lifted(self.inputs(q))
            other.given = self.given
            for before in self.of.body:
                if before is statement:
                    break
                other._run(before)
            parts.append(other._full(other.names[name.id]).imag / 1e-30)
        return np.stack(parts, axis=-1)

    # -------- expressions

    def value(self, node: ast.expr, rows: Rows) -> Array:
        """An expression for some alternatives, (B or 1, N, ...)."""
        if rows is not None:
            known = self.worked_out.get(id(node))
            if known is not None:  # for all of them, by the line that is being run
                return _chosen(known, rows)
        plain = self._plain(node, rows)
        self.axes[id(node)] = plain.shape[2:]
        marks = self.instead.get(id(node))
        value = plain if marks is None else self._with_others(plain, rows, marks)
        if rows is None:
            self.worked_out[id(node)] = value
        return value

    def _with_others(
        self, plain: Array, rows: Rows, marks: list[tuple[ast.expr, Any, Any]]
    ) -> Array:
        """A value in whose rows of alternatives their own expressions stand."""
        out = plain
        for new, which, joints in marks:
            here = which if joints is None else which[(joints == 0) | (joints == self.joint)]
            at = here
            if rows is not None:
                at = np.searchsorted(rows, here)
                met = rows.take(at, mode="clip") == here
                at, here = at[met], here[met]
            if not len(here):
                continue
            if out is plain:
                count = len(self.ways) if rows is None else len(rows)
                out = np.array(np.broadcast_to(plain, (count, *plain.shape[1:])))
            try:
                part = self.value(new, here)
            except (Absent, ValueError, TypeError, IndexError, np.linalg.LinAlgError):
                out[at] = np.nan
                continue
            if part.shape[2:] != out.shape[2:] and part.ndim != 2:
                out[at] = np.nan
                continue
            if np.iscomplexobj(part) and not np.iscomplexobj(out):
                out = out.astype(complex)
            if part.shape[1] > out.shape[1]:
                out = np.repeat(out, part.shape[1], axis=1)
            out[at] = _deep(part, out.ndim)
        return out

    def _plain(self, node: ast.expr, rows: Rows) -> Array:
        if isinstance(node, ast.Constant):
            return np.full((1, 1), float(node.value))  # type: ignore[arg-type]
        if isinstance(node, ast.Name):
            return _chosen(self._named(node.id), rows)
        if isinstance(node, ast.Subscript):
            assert isinstance(node.value, ast.Name)
            return _chosen(self._at(node.value.id, self._index(node.slice)), rows)
        if isinstance(node, ast.UnaryOp):
            return -self.value(node.operand, rows)
        if isinstance(node, ast.Attribute):
            return np.swapaxes(self.value(node.value, rows), -1, -2)
        if isinstance(node, ast.IfExp):
            return self.value(node.body if self._holds(node.test) else node.orelse, rows)
        if isinstance(node, ast.List):
            table = [self.value(entry, rows) for row in node.elts for entry in row.elts]  # type: ignore[attr-defined]
            shape = (len(node.elts), len(table) // len(node.elts))
            joined = np.stack(np.broadcast_arrays(*table), axis=-1)
            return joined.reshape(*joined.shape[:-1], *shape)
        if isinstance(node, ast.Call):
            if _called(node) == "columns":
                return self._columns(node, rows)
            return self._call(_called(node), [self.value(x, rows) for x in node.args])
        assert isinstance(node, ast.BinOp)
        if isinstance(node.op, ast.Pow):
            assert isinstance(node.right, ast.Constant)
            exponent: Any = node.right.value
            return np.asarray(self.value(node.left, rows) ** exponent)
        one, two = self.value(node.left, rows), self.value(node.right, rows)
        if isinstance(node.op, ast.MatMult):
            return _product(one, two)
        deep = max(one.ndim, two.ndim)
        if one.ndim != two.ndim and min(one.ndim, two.ndim) != 2:
            raise Absent
        one, two = _deep(one, deep), _deep(two, deep)
        if isinstance(node.op, ast.Add):
            return one + two
        if isinstance(node.op, ast.Sub):
            return one - two
        if isinstance(node.op, ast.Div):
            return one / two
        return one * two

    def _holds(self, test: ast.expr) -> bool:
        """A question about the joint: ``hinge[i]``, ``j <= k``."""
        if isinstance(test, ast.Subscript):
            assert isinstance(test.value, ast.Name)
            return bool(self.names[test.value.id][self._index(test.slice)])
        assert isinstance(test, ast.Compare)
        one, two = self._index(test.left), self._index(test.comparators[0])
        if isinstance(test.ops[0], ast.Eq):
            return one == two
        return one < two if isinstance(test.ops[0], ast.Lt) else one <= two

    def _index(self, node: ast.expr) -> int:
        if isinstance(node, ast.BinOp):
            side = 1 if isinstance(node.op, ast.Add) else -1
            return self._index(node.left) + side * self._index(node.right)
        if isinstance(node, ast.Constant):
            return int(node.value)  # type: ignore[arg-type]
        assert isinstance(node, ast.Name)
        return self.n if node.id == "n" else int(self.names[node.id])

    def _named(self, name: str) -> Array:
        found = self.names.get(name)
        if not isinstance(found, np.ndarray):
            raise Absent(name)
        return found

    def _at(self, name: str, k: int) -> Array:
        """An entry by its index; of given data the last is before the first, as in code."""
        values = self.names.get(name)
        if not isinstance(values, dict):
            raise Absent(name)
        if k not in values:
            if not values or name not in self.given:
                raise Absent(name)
            k = self.n if k <= 0 else 1
        if k not in values:
            raise Absent(name)
        found: Array = values[k]
        return found

    def _columns(self, node: ast.Call, rows: Rows) -> Array:
        """All entries of an indexed name as the columns of a matrix (of numbers: a vector)."""
        assert isinstance(node.args[0], ast.Name)
        values = self.names[node.args[0].id]
        parts = [_chosen(values[k], rows) for k in range(1, self.n + 1)]
        return np.stack(np.broadcast_arrays(*parts), axis=-1)

    def _call(self, name: str, x: list[Array]) -> Array:
        out: Any
        if name == "cross":
            a, b = x
            if a.ndim != 3 or b.ndim != 3:
                raise Absent(name)
            out = a[..., _ON] * b[..., _BACK] - a[..., _BACK] * b[..., _ON]
        elif name == "vector":
            out = np.stack(np.broadcast_arrays(*x), axis=-1)
        elif name == "twist":
            out = np.concatenate(np.broadcast_arrays(*x), axis=-1)
        elif name == "skew":
            out = skew(x[0])
        elif name == "blocks":
            rows = [np.concatenate(np.broadcast_arrays(*x[k : k + 2]), axis=-1) for k in (0, 2)]
            out = np.concatenate(np.broadcast_arrays(*rows), axis=-2)
        elif name == "stacked":
            out = np.concatenate(np.broadcast_arrays(*x), axis=-2)
        elif name == "motion":
            out = _product(_crossing(x[0]), x[1])
        elif name == "force":
            out = -_product(np.swapaxes(_crossing(x[0]), -1, -2), x[1])
        elif name == "both_":
            out = x[0] * np.eye(x[0].shape[-1])
        elif name == "diagonal":
            out = x[0][..., None] * np.eye(x[0].shape[-1])
        elif name == "inv":
            out = np.linalg.inv(regular(x[0]))
        elif name == "solve":
            out = np.linalg.solve(regular(x[0]), x[1][..., None])[..., 0]
        elif name == "defect":
            products = (
                x[0] / np.mean(np.diagonal(x[0], axis1=-2, axis2=-1), axis=-1)[..., None, None]
            )
            out = np.sum((products - np.eye(x[0].shape[-1])) ** 2, axis=(-2, -1))
        elif name == "conditions":
            out = np.stack([x[0][..., 0, 0] - x[0][..., 1, 1], x[0][..., 0, 1]], axis=-1)
        elif name == "times_j":
            out = np.sum(x[0], axis=-1) * x[1][..., None, :]
        elif name == "times_i":
            out = np.sum(x[0], axis=-1) * x[1][..., None]
        elif name == "pose":
            shape = (*np.broadcast_shapes(x[0].shape[:2], x[1].shape[:2]), 4, 4)
            out = np.zeros(shape, np.result_type(x[0], x[1]))
            out[..., :3, :3], out[..., :3, 3], out[..., 3, 3] = x[0], x[1], 1.0
        elif name == "ikj":
            out = np.swapaxes(x[0], -1, -2)
        elif name == "jki":
            out = np.moveaxis(x[0], -1, -3)
        elif name == "outer":
            out = x[0][..., :, None] * x[1][..., None, :]
        elif name in _WITHOUT:
            gone = np.arange(3) == _WITHOUT[name]
            out = np.where(gone if x[0].ndim == 3 else gone[:, None], 0.0, x[0])
        elif name in _SOME_ROWS:
            out = x[0][..., _SOME_ROWS[name], :]
        elif name == "norm":
            out = np.sqrt(np.sum(x[0] * x[0], axis=-1))
        elif name == "clamp":
            out = np.clip(x[0], -1.0, 1.0)
        else:
            out = getattr(np, name)(*x)
        return np.asarray(out)


_WITHOUT = {"without_x": 0, "without_y": 1, "without_z": 2}
_SOME_ROWS = {"planar": [0, 1, 5], "linear": [0, 1, 2], "position": [0, 1], "all_of": [*range(6)]}
_ON, _BACK = np.array([1, 2, 0]), np.array([2, 0, 1])


def _called(node: ast.Call) -> str:
    assert isinstance(node.func, ast.Name)
    return node.func.id


def _lifted(inputs: Mapping[str, Any]) -> dict[str, Any]:
    """Inputs with an axis of alternatives in front, lists as dictionaries from 1."""
    out: dict[str, Any] = {}
    for name, value in inputs.items():
        if isinstance(value, list):
            out[name] = {
                k: x if isinstance(x, bool) else np.asarray(x)[None]
                for k, x in enumerate(value, 1)
                if x is not None
            }
        elif isinstance(value, dict):
            out[name] = {k: np.asarray(x)[None] for k, x in value.items()}
        else:
            out[name] = np.asarray(value)[None]
    return out


def _chosen(value: Array, rows: Rows) -> Array:
    return value if rows is None or len(value) == 1 else value[rows]


def _deep(value: Array, ndim: int) -> Array:
    """A number with as many axes as a vector or matrix."""
    return value.reshape(*value.shape, *(1,) * (ndim - value.ndim))


def _product(one: Array, two: Array) -> Array:
    """Matrix, vector or tensor times matrix or vector."""
    if two.ndim == 3 and one.ndim == 3:
        return np.asarray(np.sum(one * two, axis=-1))
    if two.ndim == 3:
        out: Array = np.einsum(
            "...ij,...j->...i" if one.ndim == 4 else "...ijk,...k->...ij", one, two
        )
        return out
    if one.ndim == 3:
        left: Array = np.einsum("...i,...ij->...j", one, two)
        return left
    if one.ndim != 4 or two.ndim != 4:
        raise Absent
    both: Array = np.matmul(one, two)
    return both


def skew(vector: Array) -> Array:
    """The matrix of the cross product with a vector."""
    turned: Array = np.cross(vector[..., None, :], np.eye(3))
    return np.swapaxes(turned, -1, -2)


def _crossing(twist: Array) -> Array:
    """The matrix of a twist's product with a twist, the linear part first."""
    if twist.shape[-1] != 6:
        raise Absent
    moving, turning = skew(twist[..., :3]), skew(twist[..., 3:])
    top = np.concatenate([turning, moving], axis=-1)
    return np.concatenate([top, np.concatenate([0 * turning, turning], axis=-1)], axis=-2)


def regular(matrix: Array) -> Array:
    """Singular matrices as NaN: an alternative without an inverse has no answer."""
    with np.errstate(all="ignore"):
        flat = np.linalg.det(matrix) == 0
    return np.asarray(np.where(flat[..., None, None], np.nan, matrix))


def again(node: ast.expr) -> ast.expr:
    """The same expression as another node: what stands inside it may still be otherwise."""
    return copy(node)
