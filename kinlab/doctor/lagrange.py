"""What stands between the energies and the torques, derived: momentum, its rate, gradients.

By Lagrange's way, d/dt dL/dqd - dL/dq = tau (note 001, section 2; note 002, section 4).
"""

from __future__ import annotations

from kinlab.symbolic import dynamics, kinematics
from kinlab.symbolic.arm import SymbolicArm
from kinlab.symbolic.kinematics import Grid
from kinlab.symbolic.trig import Poly


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
    for i, (speed, turn) in enumerate(zip(a.qd, a.qdd, strict=True)):
        moving = a.trig.gens[speed.name]
        total += a.trig.by_joint(poly, i) * moving
        total += poly.diff(moving) * a.trig.gens[turn.name]
    return a.trig.reduce(total)
