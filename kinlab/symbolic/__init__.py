"""Symbolic derivation of an arm from its DH table: FK, J, det J, M, C, G, tau.

===============  =================================================================================
module           what it holds
===============  =================================================================================
``arm``          SymbolicArm: a DH table with names for its numbers, ready to derive from
``derive``       Derived formulas as text, by the letters of the textbooks
``determinant``  det J in factors: each factor that can vanish is one family of singularities
``dynamics``     Symbolic M, Christoffel's C, g, tau and D_ijk, by Lagrange's equations
``fourier``      From polynomials in c_i, s_i to readable expressions: cos(q1 + q2) instead of c1
                 c2 - s1 s2
``kinematics``   Symbolic forward kinematics and Jacobian, by the product of link transforms
``output``       What to do with a derived expression: a fast function, LaTeX, or Python text
``trig``         Exact arithmetic in cos q_i and sin q_i: sparse polynomials with s_i² = 1 - c_i²
``vocabulary``   What the numbers of a DH table are called in formulas: l1, m1, lc1, I1, a2, d4, g
===============  =================================================================================

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
