"""Symbolic M, Christoffel's C, g, tau and D_ijk, by Lagrange's equations.

M = sum m V^T V + W^T I W, with the centre's velocity and the angular velocity of each link in
the link's own axes, where I is constant (note 002, 002.M; Siciliano et al., section 7.1).
"""

from __future__ import annotations

from functools import lru_cache

import numpy as np
import sympy

from kinlab.model.link import Convention
from kinlab.symbolic import kinematics
from kinlab.symbolic.arm import SymbolicArm
from kinlab.symbolic.kinematics import Grid, as_matrix, product
from kinlab.symbolic.trig import Poly

Cube = list[list[list[Poly]]]


def mass_matrix(arm: SymbolicArm) -> sympy.Matrix:
    """M(q), (n, n), armatures included."""
    return as_matrix(arm, mass_grid(arm))


def christoffel(arm: SymbolicArm) -> list[list[list[sympy.Expr]]]:
    """D_ijk = ½ (dM_ij/dq_k + dM_ik/dq_j - dM_jk/dq_i), as [i][j][k] from 0.

    Note 001's D_ijk: tau_i = sum D_ij qdd_j + sum D_ijk qd_j qd_k + D_i.
    """
    cube = christoffel_cube(arm)
    return [[[arm.expression(entry) for entry in row] for row in grid] for grid in cube]


def coriolis_matrix(arm: SymbolicArm) -> sympy.Matrix:
    """Christoffel's C(q, qd), (n, n); Mdot - 2C is skew."""
    return as_matrix(arm, coriolis_grid(arm))


def gravity_torques(arm: SymbolicArm) -> sympy.Matrix:
    """g(q) = dV/dq, (n, 1)."""
    return as_matrix(arm, gravity_column(arm))


def inverse_dynamics(arm: SymbolicArm) -> sympy.Matrix:
    """tau = M qdd + C qd + g, (n, 1)."""
    return as_matrix(arm, torque_column(arm))


def kinetic_energy(arm: SymbolicArm) -> sympy.Expr:
    """T = ½ qd^T M qd."""
    return arm.expression(kinetic_poly(arm))


def potential_energy(arm: SymbolicArm) -> sympy.Expr:
    """V = -sum m g^T p_C, zero at the base origin."""
    return arm.expression(potential_poly(arm))


@lru_cache(maxsize=32)
def mass_grid(arm: SymbolicArm) -> Grid:
    """M as polynomials."""
    n, trig = arm.n, arm.trig
    total = [[trig.ring.zero] * n for _ in range(n)]
    for i, (linear, angular) in enumerate(_link_velocities(arm), 1):
        centre = [arm.entry(f"com{i}{axis}") for axis in "xyz"]
        columns = range(n)
        turned = [kinematics.cross(arm, _col(angular, j), centre) for j in columns]
        velocity = [[linear[r][j] + turned[j][r] for j in columns] for r in range(3)]
        spin = product(arm, _tensor(arm, i), angular)
        mass = arm.entry(f"mass{i}")
        for j in columns:
            for k in range(j + 1):
                entry = mass * sum(
                    (velocity[r][j] * velocity[r][k] for r in range(3)), trig.ring.zero
                ) + sum((angular[r][j] * spin[r][k] for r in range(3)), trig.ring.zero)
                total[j][k] += trig.reduce(entry)
    for j in range(n):
        total[j][j] += arm.entry(f"armature{j + 1}")
        for k in range(j):
            total[k][j] = total[j][k]
    return total


@lru_cache(maxsize=32)
def christoffel_cube(arm: SymbolicArm) -> Cube:
    """Christoffel's symbols of the first kind, [i][j][k]."""
    n, trig = arm.n, arm.trig
    mass = mass_grid(arm)
    slope = [[[trig.by_joint(mass[i][j], k) for k in range(n)] for j in range(n)] for i in range(n)]
    half = sympy.QQ(1, 2)
    return [
        [
            [(slope[i][j][k] + slope[i][k][j] - slope[j][k][i]) * half for k in range(n)]
            for j in range(n)
        ]
        for i in range(n)
    ]


def coriolis_grid(arm: SymbolicArm) -> Grid:
    """Christoffel's C as polynomials."""
    speeds = [arm.trig.gens[s.name] for s in arm.qd]
    return [[_dot(arm, row, speeds) for row in grid] for grid in christoffel_cube(arm)]


def centres(arm: SymbolicArm) -> Grid:
    """The links' centres of mass in the base as polynomials, (n, 3)."""
    found = []
    for i, frame in enumerate(kinematics.link_frames(arm)[1:], 1):
        place = [*(arm.entry(f"com{i}{axis}") for axis in "xyz"), arm.trig.ring.one]
        found.append([_dot(arm, frame[r], place) for r in range(3)])
    return found


@lru_cache(maxsize=32)
def potential_poly(arm: SymbolicArm) -> Poly:
    """V as a polynomial."""
    gravity = [arm.entry(f"gravity{axis}") for axis in "xyz"]
    total = arm.trig.ring.zero
    for i, centre in enumerate(centres(arm), 1):
        total -= arm.entry(f"mass{i}") * _dot(arm, gravity, centre)
    return arm.trig.reduce(total)


def gravity_column(arm: SymbolicArm) -> Grid:
    """g as polynomials, (n, 1)."""
    potential = potential_poly(arm)
    return [[arm.trig.by_joint(potential, i)] for i in range(arm.n)]


def kinetic_poly(arm: SymbolicArm) -> Poly:
    """T as a polynomial."""
    speeds = [arm.trig.gens[s.name] for s in arm.qd]
    momentum = [_dot(arm, row, speeds) for row in mass_grid(arm)]
    return _dot(arm, momentum, speeds) * sympy.QQ(1, 2)


@lru_cache(maxsize=32)
def torque_column(arm: SymbolicArm) -> Grid:
    """tau as polynomials, (n, 1)."""
    speeds = [arm.trig.gens[s.name] for s in arm.qd]
    turns = [arm.trig.gens[s.name] for s in arm.qdd]
    inertial = [_dot(arm, row, turns) for row in mass_grid(arm)]
    circling = [_dot(arm, row, speeds) for row in coriolis_grid(arm)]
    held = gravity_column(arm)
    return [[a + b + c[0]] for a, b, c in zip(inertial, circling, held, strict=True)]


def _link_velocities(arm: SymbolicArm) -> list[tuple[Grid, Grid]]:
    """Each link's partial velocities of its frame's origin and of its turning, (3, n), own axes."""
    modified = arm.table.convention is Convention.MODIFIED
    zero, one = arm.trig.ring.zero, arm.trig.ring.one
    linear = [[zero] * arm.n for _ in range(3)]
    angular = [[zero] * arm.n for _ in range(3)]
    out = []
    for i, link in enumerate(arm.table.links):
        step = kinematics.link_step(arm, i)
        sign = -one if link.flip else one
        moved = angular if link.joint == "revolute" else linear
        if not modified:  # the axis is z of the frame before
            moved[2][i] += sign
        shift = kinematics.column(step, 3)
        swept = [kinematics.cross(arm, _col(angular, j), shift) for j in range(arm.n)]
        back = [[step[c][r] for c in range(3)] for r in range(3)]
        carried = [[linear[r][j] + swept[j][r] for j in range(arm.n)] for r in range(3)]
        linear, angular = product(arm, back, carried), product(arm, back, angular)
        if modified:  # the axis is z of the link's own frame
            moved = angular if link.joint == "revolute" else linear
            moved[2][i] += sign
        out.append(([[*row] for row in linear], [[*row] for row in angular]))
    return out


def _tensor(arm: SymbolicArm, i: int) -> Grid:
    pairs = np.array([["xx", "xy", "xz"], ["xy", "yy", "yz"], ["xz", "yz", "zz"]])
    return [[arm.entry(f"inertia{i}{pair}") for pair in row] for row in pairs]


def _col(grid: Grid, j: int) -> list[Poly]:
    return [grid[r][j] for r in range(3)]


def _dot(arm: SymbolicArm, one: list[Poly], two: list[Poly]) -> Poly:
    pairs = zip(one, two, strict=True)
    return arm.trig.reduce(sum((a * b for a, b in pairs if a and b), arm.trig.ring.zero))
