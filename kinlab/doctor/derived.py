"""The engine's quantities as derived formulas, entry by entry, for arms with a DH table."""

from __future__ import annotations

from collections.abc import Callable, Collection, Mapping
from dataclasses import dataclass, replace
from functools import cached_property, lru_cache
from typing import Any

import numpy as np
import sympy

from kinlab.arrays import Array
from kinlab.doctor.changes import Case, table_of
from kinlab.formulas import tree
from kinlab.formulas.tree import Node
from kinlab.model.dh import DHTable
from kinlab.model.link import Convention
from kinlab.symbolic import dynamics, fourier, kinematics
from kinlab.symbolic.arm import SymbolicArm, arm
from kinlab.symbolic.determinant import det_poly
from kinlab.symbolic.kinematics import Grid
from kinlab.symbolic.trig import Poly, TrigRing
from kinlab.symbolic.vocabulary import is_planar

# -------- What stands between the energies and the torques, derived: momentum, its rate,
#          gradients
# By Lagrange's way, d/dt dL/dqd - dL/dq = tau (note 001, section 2; note 002, section 4).


def lagrangian(a: SymbolicArm) -> Poly:
    """L = T - V."""
    return dynamics.kinetic_poly(a) - dynamics.potential_poly(a)


def momentum(a: SymbolicArm) -> list[Poly]:
    """dL/dqd_i."""
    energy = dynamics.kinetic_poly(a)
    return [energy.diff(a.trig.gens[s.name]) for s in a.qd]


def momentum_rate(a: SymbolicArm) -> list[Poly]:
    """d/dt dL/dqd_i."""
    return [_rate(a, poly) for poly in momentum(a)]


def lagrangian_gradient(a: SymbolicArm) -> list[Poly]:
    """dL/dq_i."""
    whole = lagrangian(a)
    return [a.trig.by_joint(whole, i) for i in range(a.n)]


def kinetic_gradient(a: SymbolicArm) -> list[Poly]:
    """dT/dq_i."""
    energy = dynamics.kinetic_poly(a)
    return [a.trig.by_joint(energy, i) for i in range(a.n)]


def mass_rate(a: SymbolicArm) -> Grid:
    """Mdot."""
    return [[_rate(a, entry) for entry in row] for row in dynamics.mass_grid(a)]


def mass_rate_velocity(a: SymbolicArm) -> list[Poly]:
    """Mdot qd."""
    speeds = [[a.trig.gens[s.name]] for s in a.qd]
    return [row[0] for row in kinematics.product(a, mass_rate(a), speeds)]


def tip_speed_squared(a: SymbolicArm) -> Poly:
    """|v|² of the tool's origin."""
    speeds = [[a.trig.gens[s.name]] for s in a.qd]
    rows = kinematics.product(a, kinematics.jacobian_grid(a, "base")[:3], speeds)
    return a.trig.reduce(sum((row[0] ** 2 for row in rows), a.trig.ring.zero))


def _rate(a: SymbolicArm, poly: Poly) -> Poly:
    """The time derivative along a motion."""
    total = a.trig.ring.zero
    for i, (speed, acceleration) in enumerate(zip(a.qd, a.qdd, strict=True)):
        moving = a.trig.gens[speed.name]
        total += a.trig.by_joint(poly, i) * moving
        total += poly.diff(moving) * a.trig.gens[acceleration.name]
    return a.trig.reduce(total)


# -------- The engine's quantities as derived formulas, entry by entry, for arms with a DH
#          table

_DYNAMIC_JOINTS = 4
_OF_MORE = 100
"""Terms of an entry of M, C, g or tau up to which an arm of more than three joints is derived: of a
SCARA they are few, of others too many to search for a slip in."""
_KINEMATIC_JOINTS = 7
_ROWS = 6
"""Rows of a Jacobian."""
_AXES = 3
"""Coordinates of a point's velocity."""
_FACTORED = 20
"""Terms of one entry up to which its factors are looked for."""
POINTS = 24
"""Random points at which formulas are looked at."""
_LONGEST = 1500
"""Terms of one entry above which it is not searched."""


def _jacobian(frame: str) -> Callable[[SymbolicArm], Any]:
    return lambda a: kinematics.jacobian_grid(a, frame)


def _column(grid: Any) -> Any:
    return [row[0] for row in grid]


def _planar_pose(a: SymbolicArm) -> Any:
    pose = kinematics.tool_frame(a)
    return [pose[0][3], pose[1][3], pose[0][0], pose[1][0]]


def _determinant(a: SymbolicArm, rows: tuple[int, ...] | None) -> Poly | None:
    """det of some rows of J, of arms with as many joints."""
    return det_poly(a, rows) if a.n == len(rows or range(a.n)) <= _ROWS else None


def _coriolis_torques(a: SymbolicArm) -> Any:
    speeds = [[a.trig.gens[s.name]] for s in a.qd]
    return _column(kinematics.product(a, dynamics.coriolis_grid(a), speeds))


def _statics(frame: str) -> Callable[[SymbolicArm], Any]:
    """J^T of a wrench whose parts are names."""

    def torques(a: SymbolicArm) -> Any:
        parts = [[a.trig.gens[name]] for name in WRENCH]
        turned = [list(column) for column in zip(*_jacobian(frame)(a), strict=True)]
        return _column(kinematics.product(a, turned, parts))

    return torques


def _loaded_torques(a: SymbolicArm) -> Any:
    free, held = _column(dynamics.torque_column(a)), _statics("base")(a)
    return [one + two for one, two in zip(free, held, strict=True)]


def _isotropy_conditions(a: SymbolicArm) -> Any:
    one, two = _jacobian("base")(a)[:2]
    both = list(zip(one, two, strict=True))
    sums = (
        sum((x * x - y * y for x, y in both), a.trig.ring.zero),
        sum((x * y for x, y in both), a.trig.ring.zero),
    )
    return [a.trig.reduce(poly) for poly in sums]


def _centres_jacobians(a: SymbolicArm) -> Any:
    return [kinematics.jacobian_at(a, c, i) for i, c in enumerate(dynamics.centres(a), 1)]


def _of_links(a: SymbolicArm, points: Any, rows: int, times: int) -> Any:
    """Velocities, or accelerations, of a point of each link in the axes of its frame.

    Args:
        a: the arm; None of one whose links' frames are not those of their joints.
        points: of each link, in the base.
        rows: 3 of the point's alone, 6 with those of the turning.
        times: how often they are derived: 1 for accelerations.
    """
    turned_over = any(link.flip for link in a.table.links)
    twisted = rows > _AXES or any(link.alpha for link in a.table.links)
    if turned_over or (twisted and a.table.convention is not Convention.MODIFIED):
        return None
    speeds = [[a.trig.gens[s.name]] for s in a.qd]
    found = []
    for i, (point, frame) in enumerate(zip(points, kinematics.link_frames(a)[1:], strict=True), 1):
        moved = kinematics.product(a, kinematics.jacobian_at(a, point, i)[:rows], speeds)
        for _time in range(times):
            moved = [[_rate(a, x)] for x in _column(moved)]
        back = [[frame[c][r] for c in range(3)] for r in range(3)]
        halves = (moved[k : k + 3] for k in range(0, rows, 3))
        found.append([x for half in halves for x in _column(kinematics.product(a, back, half))])
    return found


def _origins(a: SymbolicArm) -> Any:
    return [kinematics.column(frame, 3) for frame in kinematics.link_frames(a)[1:]]


_KINEMATIC: dict[str, Callable[[SymbolicArm], Any]] = {
    "fk": kinematics.tool_frame,
    "dh_poses": lambda a: kinematics.link_frames(a)[1:],
    "link_transforms": lambda a: [kinematics.link_step(a, i) for i in range(a.n)],
    "jacobian": _jacobian("base"),
    "jacobian_tool": _jacobian("tool"),
    "jacobian_spatial": _jacobian("spatial"),
    "planar_pose": _planar_pose,
    "jacobian_determinant": lambda a: _determinant(a, None),
    "planar_determinant": lambda a: _determinant(a, (0, 1, 5)),
    "planar_position_determinant": lambda a: _determinant(a, (0, 1)),
    "planar_jacobian": lambda a: [_jacobian("base")(a)[r] for r in (0, 1, 5)],
}
_AT_REST: dict[str, Callable[[SymbolicArm], Any]] = {
    "gravity_torques": lambda a: _column(dynamics.gravity_column(a)),
    "potential_energy": dynamics.potential_poly,
    "com_positions": dynamics.centres,
    "com_jacobians": _centres_jacobians,
}
_DYNAMIC: dict[str, Callable[[SymbolicArm], Any]] = {
    "mass_matrix": dynamics.mass_grid,
    "coriolis_matrix": dynamics.coriolis_grid,
    "coriolis_torques": _coriolis_torques,
    "com_accelerations": lambda a: _of_links(a, dynamics.centres(a), 3, 1),
    "link_velocities": lambda a: _of_links(a, _origins(a), 6, 0),
    "link_accelerations": lambda a: _of_links(a, _origins(a), 6, 1),
    "jacobian_dot": lambda a: [[_rate(a, x) for x in row] for row in _jacobian("base")(a)],
    "inverse_dynamics": lambda a: _column(dynamics.torque_column(a)),
    "lagrange_torques": lambda a: _column(dynamics.torque_column(a)),
    "kinetic_energy": dynamics.kinetic_poly,
    "lagrangian": lagrangian,
    "momentum": momentum,
    "momentum_rate": momentum_rate,
    "lagrangian_gradient": lagrangian_gradient,
    "kinetic_gradient": kinetic_gradient,
    "mass_matrix_dot": mass_rate,
    "mass_rate_velocity": mass_rate_velocity,
    "christoffel": dynamics.christoffel_cube,
    "tip_speed_squared": tip_speed_squared,
    "isotropy_conditions": _isotropy_conditions,
}

_LOADED: dict[str, Callable[[SymbolicArm], Any]] = {
    "statics": _statics("base"),
    "statics_tool": _statics("tool"),
    "inverse_dynamics_loaded": _loaded_torques,
}
"""Those with a force and a moment of the tool."""
WRENCH = ("fx", "fy", "fz", "nx", "ny", "nz")
"""The names of a wrench's parts, in order."""
LETTERS = {"q": "q", "v": "qd", "a": "qdd"}
"""Arguments of the quantities and the letters of their symbols."""


@dataclass(frozen=True, eq=False)
class Derivation:
    """A quantity of one arm, derived.

    Attributes:
        arm: the arm with its names.
        polys: the polynomials, an object array of the quantity's shape.
    """

    arm: SymbolicArm
    polys: Any

    @property
    def n(self) -> int:
        """Number of joints."""
        return self.arm.n

    @property
    def parameters(self) -> tuple[str, ...]:
        """The names of the arm's numbers, and of the wrench's parts."""
        return self.arm.trig.parameters

    @property
    def values(self) -> Mapping[str, float]:
        """What the arm's numbers are."""
        return self.arm.values

    @property
    def spelling(self) -> Mapping[str, str]:
        """How joints are written where the writer has none: as they are."""
        return {}

    def letters(self, arguments: tuple[str, ...]) -> tuple[str, ...]:
        """Which of q, qd and qdd may stand in a formula of a quantity with these arguments."""
        return tuple(LETTERS[a] for a in arguments if a in LETTERS)

    @property
    def loads(self) -> tuple[str, ...]:
        """The names of the wrench's parts, where there is one."""
        return tuple(name for name in WRENCH if name in self.arm.trig.parameters)

    def entry(self, index: tuple[Any, ...]) -> Poly:
        """The polynomial of one entry; of a number the whole."""
        found: Poly = self.polys[index] if index else np.asarray(self.polys).item()
        return found

    def held(self, poly: Poly, named: Collection[str]) -> Poly:
        """An entry where only some parts of the wrench are not zero."""
        gone = [self.arm.trig.index[name] for name in self.loads if name not in named]
        if not gone:
            return poly
        left = {powers: x for powers, x in poly.items() if not any(powers[k] for k in gone)}
        return self.arm.trig.ring.from_dict(left)

    def tree(self, poly: Poly) -> Node:
        """One entry as a sum of terms."""
        if poly not in self._trees:
            self._trees[poly] = tree.from_sympy(self.arm.expression(poly))
        return self._trees[poly]

    @cached_property
    def _trees(self) -> dict[Poly, Node]:
        return {}

    def collected(self, poly: Poly) -> Node:
        """One entry by speeds and accelerations: (m2*l2**2 + m2*l1*l2*cos(q2))*qdd2 + ..."""
        return collected(self.arm, poly)

    def grouped(self, poly: Poly) -> Node:
        """One entry with equal joint functions collected: (m1 + m2)*l1**2*qdd1 + ..."""
        return grouped(self.arm, poly)

    def forms(self, poly: Poly) -> list[Node]:
        """The ways in which people write the same entry."""
        if poly not in self._forms:
            made = [self.tree(poly), self.grouped(poly), self.collected(poly)]
            self._forms[poly] = list(dict.fromkeys([*made, *self.factored(poly)]))
        return self._forms[poly]

    @cached_property
    def _forms(self) -> dict[Poly, list[Node]]:
        return {}

    def environment(self, states: Mapping[str, Array]) -> dict[str, Array]:
        """Values of every name: the joints' from the states, the parameters' from the table."""
        return environment(self, dict(states))

    def anywhere(self, seed: int, held: Mapping[str, float] | None = None) -> dict[str, Array]:
        """Random values for every name: positive parameters but those ``held``, any states."""
        rng = np.random.default_rng(seed)
        own = [name for name in self.parameters if name not in self.loads]
        at = {name: rng.uniform(0.4, 2.0, POINTS) for name in own}
        for letter in LETTERS.values():
            for i in range(self.n):
                at[f"{letter}{i + 1}"] = rng.uniform(-2.5, 2.5, POINTS)
        at |= {name: rng.uniform(-2.0, 2.0, POINTS) for name in self.loads}
        return at | {name: np.full(POINTS, value) for name, value in (held or {}).items()}

    def another(self, seed: int) -> dict[str, Array]:
        """The same with one set of numbers at every state."""
        at, own = self.anywhere(seed), {*self.parameters} - {*self.loads}
        return {n: np.full_like(x, x[0]) if n in own else x for n, x in at.items()}

    def but_for(self, name: str, here: Mapping[str, Array]) -> dict[str, Array]:
        """Values with another number for one name."""
        return {**here, name: here[name] * 1.37 + 0.1}

    def factored(self, poly: Poly) -> list[Node]:
        """One entry with what all terms share in front: l2*m2*(l1*cos(q2) + l2), if short."""
        if len(poly) > _FACTORED:
            return []
        plain = self.arm.expression(poly)
        forms = [sympy.factor_terms(plain), sympy.factor(plain)]
        return [tree.from_sympy(form) for form in dict.fromkeys(forms)]


@lru_cache(maxsize=64)
def derivation(table: DHTable, quantity: str) -> Derivation | None:
    """The quantity (without index) derived for the table, or None where none is offered."""
    if quantity == "planar_angle":
        return _planar_angle(table)
    if quantity in _KINEMATIC and table.n <= _KINEMATIC_JOINTS:
        make = _KINEMATIC[quantity]
    elif quantity in _AT_REST and table.n <= _KINEMATIC_JOINTS:
        make = _AT_REST[quantity]
    elif quantity in _DYNAMIC and table.n <= _DYNAMIC_JOINTS:
        make = _DYNAMIC[quantity]
    elif quantity in _LOADED and table.n <= _DYNAMIC_JOINTS:
        make = _LOADED[quantity]
    else:
        return None
    named = _with_wrench(arm(table)) if quantity in _LOADED else arm(table)
    made = make(named)
    if made is None:
        return None
    polys = _objects(made)
    if table.n > 3 and quantity not in _KINEMATIC and max(map(len, polys.ravel())) > _OF_MORE:
        return None
    return Derivation(named, polys)


def derivation_of(case: Case) -> Derivation | None:
    """What a case asks for, derived; None of an arm without a table, or where none is offered."""
    table = table_of(case.robot)
    return derivation(table, case.quantity.name) if table is not None else None


def _with_wrench(a: SymbolicArm) -> SymbolicArm:
    trig = TrigRing((*a.trig.parameters, *WRENCH), a.trig.angles, a.n)
    return replace(a, trig=trig)


def _planar_angle(table: DHTable) -> Derivation | None:
    """The sum of the joint positions, which stand in it themselves; None where it is none."""
    turned = any(link.theta for link in table.links) or not np.array_equal(table.base, np.eye(4))
    if turned or not is_planar(table):
        return None
    plain = arm(table)
    named = replace(plain, trig=TrigRing(plain.trig.parameters, (), plain.n), groups=())
    return Derivation(named, _objects(sum(named.trig.gens[s.name] for s in named.q)))


def searchable(poly: Poly) -> bool:
    """Whether an entry is short enough to look for slips in."""
    return len(poly) <= _LONGEST


def environment(derived: Derivation, states: dict[str, Array]) -> dict[str, Array]:
    """Values of every name: the joints' from the states, the parameters' from the table."""
    count = len(next(iter(states.values())))
    values = derived.arm.values
    at = {n: np.full(count, values[n]) for n in derived.arm.trig.parameters if n in values}
    for argument, stack in states.items():
        if argument in LETTERS:
            for i in range(derived.arm.n):
                at[f"{LETTERS[argument]}{i + 1}"] = stack[:, i]
        if argument == "wrench" and derived.loads:
            at |= dict(zip(WRENCH, stack.T, strict=True))
    return at


def grouped(a: SymbolicArm, poly: Poly) -> Node:
    """Sums the parameters in front of each product of joint functions, common factors outside."""
    parameters = {str(name) for name in a.trig.parameters}
    fronts: dict[Any, list[Any]] = {}
    for term, factor in fourier.terms(a.trig, poly, a.groups).items():
        joint: list[Any] = []
        front: list[Any] = [factor]
        for part in term.as_ordered_factors():
            inside = {s.name for s in part.free_symbols}
            (front if inside <= parameters else joint).append(part)
        key = tuple(sorted(joint, key=str))
        fronts.setdefault(key, []).append(front)
    return tree.add(*(_outside(key, rows) for key, rows in fronts.items()))


def collected(a: SymbolicArm, poly: Poly) -> Node:
    """Sums what stands in front of each product of speeds and accelerations."""
    rates = {*(s.name for s in (*a.qd, *a.qdd)), *WRENCH}
    fronts: dict[Any, list[Node]] = {}
    for term, factor in fourier.terms(a.trig, poly, a.groups).items():
        parts = [p for p in term.as_ordered_factors() if {s.name for s in p.free_symbols} & rates]
        rest = tree.from_sympy(factor * term / sympy.Mul(*parts))
        fronts.setdefault(tuple(sorted(parts, key=str)), []).append(rest)
    pieces = []
    for parts, rests in fronts.items():
        whole, speeds = tree.add(*rests), [tree.from_sympy(p) for p in parts]
        pieces += [tree.mul(whole, *speeds)] if speeds else rests
    return tree.add(*pieces)


def _outside(joint: tuple[Any, ...], rows: list[list[Any]]) -> Node:
    """Common factors * (sum) * joint functions."""
    common = [f for f in rows[0] if all(f in row for row in rows[1:])]
    inner = []
    for row in rows:
        rest = list(row)
        for factor in common:
            rest.remove(factor)
        inner.append(tree.mul(*(tree.from_sympy(f) for f in rest)) if rest else tree.num(1))
    factors = [tree.from_sympy(f) for f in (*common, *joint)]
    whole = tree.add(*inner)
    return tree.mul(whole, *factors) if factors else whole


def _objects(value: Any) -> Any:
    shape: list[int] = []
    inner = value
    while isinstance(inner, list):
        shape.append(len(inner))
        inner = inner[0]
    flat: list[Any] = []

    def walk(part: Any) -> None:
        if isinstance(part, list):
            for one in part:
                walk(one)
        else:
            flat.append(part)

    walk(value)
    out = np.empty(len(flat), dtype=object)
    out[:] = flat
    return out.reshape(shape)
