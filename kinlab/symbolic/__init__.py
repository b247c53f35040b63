"""Symbolic derivation of an arm from its DH table: FK, J, det J, M, C, G, tau.

    >>> import kinlab as kl
    >>> from kinlab import symbolic
    >>> arm = symbolic.arm(kl.load("planar2r").table)
    >>> symbolic.det_jacobian(arm).expression
    l1*l2*sin(q2)

Everything is computed with sparse polynomials in the parameters and the pairs (cos q_i, sin q_i),
exactly, and becomes a sympy expression at the end.
"""

from kinlab.symbolic.arm import SymbolicArm, arm
from kinlab.symbolic.determinant import Determinant, det_jacobian
from kinlab.symbolic.dynamics import (
    christoffel,
    coriolis_matrix,
    gravity_torques,
    inverse_dynamics,
    kinetic_energy,
    mass_matrix,
    potential_energy,
)
from kinlab.symbolic.kinematics import fk, frames, jacobian
from kinlab.symbolic.output import to_function, to_latex, to_python

__all__ = [
    "Determinant",
    "SymbolicArm",
    "arm",
    "christoffel",
    "coriolis_matrix",
    "det_jacobian",
    "fk",
    "frames",
    "gravity_torques",
    "inverse_dynamics",
    "jacobian",
    "kinetic_energy",
    "mass_matrix",
    "potential_energy",
    "to_function",
    "to_latex",
    "to_python",
]
