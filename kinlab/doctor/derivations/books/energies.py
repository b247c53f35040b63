"""Masses and energies: the mass matrix, Christoffel symbols, Lagrange's equation."""

from __future__ import annotations

MASSES = """
M = nothing
G = zeros
V = number
for k in outward:
    # the centre of mass
    pc = o_[k] + R_[k] @ c[k]
    for j in outward:
        # the linear part of the link's Jacobian
        Lv[j] = (cross(z[j], pc - o[j]) if hinge[j] else z[j]) if j <= k else zero
        # the angular part of the link's Jacobian
        Lw[j] = (z[j] if hinge[j] else zero) if j <= k else zero
    Jv = columns(Lv)
    Jw = columns(Lw)
    each[k] = stacked(Jv, Jw)
    # the mass matrix
    M = M + m[k]*Jv.T @ Jv + Jw.T @ (R_[k] @ I[k] @ R_[k].T) @ Jw
    # the gravity torques
    G = G - m[k]*Jv.T @ g
    # the potential energy
    V = V - m[k]*g @ pc
    com[k] = pc
# the rotors' inertia
M = M + diagonal(Ia)
"""
CHRISTOFFEL = """
D = slope(M)
# Christoffel's C_ij = Σ ½ (dM_ij/dq_k + dM_ik/dq_j - dM_jk/dq_i) qd_k
C = 0.5*(D + ikj(D) - jki(D)) @ v
"""
LAGRANGE = {
    "mass_matrix": ("M", ""),
    "gravity_torques": ("G", ""),
    "potential_energy": ("V", ""),
    "com_positions": ("com", ""),
    "com_jacobians": ("each", ""),
    "kinetic_energy": (
        "E",
        """
# the kinetic energy
E = 0.5*v @ M @ v
""",
    ),
    "momentum": (
        "E",
        """
# the momentum
E = M @ v
""",
    ),
    "lagrangian": (
        "E",
        """
# the Lagrangian L = T - V
E = 0.5*v @ M @ v - V
""",
    ),
    "coriolis_matrix": ("C", CHRISTOFFEL),
    "coriolis_torques": (
        "c",
        CHRISTOFFEL
        + """
# the velocity torques
c = C @ v
""",
    ),
    "inverse_dynamics": (
        "tau",
        CHRISTOFFEL
        + """
# the equation of motion
tau = M @ a + C @ v + G
""",
    ),
    "inverse_without_gravity": (
        "tau",
        CHRISTOFFEL
        + """
# the equation of motion
tau = M @ a + C @ v
""",
    ),
    "inverse_dynamics_loaded": (
        "tau",
        CHRISTOFFEL
        + """
q = q  # a name of this line, so that it may stand for G, which looks like it in print
# the equation of motion
tau = M @ a + C @ v + G + Jt.T @ wrench
""",
    ),
    "forward_dynamics": (
        "a",
        CHRISTOFFEL
        + """
# the equation of motion
a = solve(M, tau - C @ v - G)
""",
    ),
    "mass_matrix_derivatives": (
        "E",
        """
D = slope(M)
# dM_ij/dq_k
E = 1*D
""",
    ),
    "mass_matrix_dot": (
        "E",
        """
D = slope(M)
# Mdot
E = D @ v
""",
    ),
    "mass_rate_velocity": (
        "E",
        """
D = slope(M)
# Mdot v
E = (D @ v) @ v
""",
    ),
    "skew_matrix": (
        "E",
        CHRISTOFFEL
        + """
# Mdot - 2C
E = D @ v - 2*C
""",
    ),
    "kinetic_gradient": (
        "E",
        """
D = slope(M)
# the gradient of ½ v^T M v
E = 0.5*(jki(D) @ v) @ v
""",
    ),
    "lagrangian_gradient": (
        "E",
        """
D = slope(M)
# the gradient of the Lagrangian
E = 0.5*(jki(D) @ v) @ v - G
""",
    ),
    "momentum_rate": (
        "E",
        """
D = slope(M)
# the momentum's rate
E = M @ a + (D @ v) @ v
""",
    ),
    "christoffel": (
        "E",
        """
D = slope(M)
# Christoffel's ½ (dM_ij/dq_k + dM_ik/dq_j - dM_jk/dq_i)
E = 0.5*(D + ikj(D) - jki(D))
""",
    ),
}
"""By quantity: what is asked for, and what follows the mass matrix."""
BOUNDARY = """
# the boundary term
b = late @ later - early @ earlier
# the variation with its boundary term
E = inner + b
"""
"""The action's variation between free ends: by parts, with dL/dqd and dq at both ends."""
