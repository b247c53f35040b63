"""The textbooks' derivations as text, each written once, for any serial arm, and for the five-bar.

Newton-Euler as Craig has it (6.45 to 6.53), as Siciliano (7.107 to 7.114) and Spong (7.146 to
7.151) have it, and in base axes; forces passed on at rest (Craig 5.80 to 5.82); the Jacobian's
columns (Siciliano 3.30, Spong 4.57, Craig 5.9); the mass matrix by the links' Jacobians (Spong
7.50; note 002, 002.M), Christoffel's C and Lagrange's equation; the product of link transforms; the
five-bar's closed chain (note 003); Newton's step and gradient descent (note 000). The comment above
a line says what it is; a line without one is plumbing, which nobody gets wrong. Indices run from 1;
``T[0]`` is the base.
"""

from __future__ import annotations

import re
from collections.abc import Iterator

from kinlab.host.language import N_

VELOCITIES = """
w[0] = zero
v[0] = zero
for i in outward:
    # the angular velocity w of the link
    w[i] = R[i].T @ w[i-1] + (qd[i]*z[i] if hinge[i] else zero)
    # the velocity v of the link's origin
    v[i] = R[i].T @ (v[i-1] + cross(w[i-1], P[i]))
    # the velocity v of the link's origin
    v[i] = v[i] if hinge[i] else v[i] + qd[i]*z[i]
    asked[i] = twist(v[i], w[i])
"""

_OUTWARD = """
w[0] = zero
dw[0] = zero
# the start of the recursion
dv[0] = -g
for i in outward:
    # the angular velocity w of the link
    w[i] = R[i].T @ w[i-1] + (qd[i]*z[i] if hinge[i] else zero)
    # the angular acceleration omega_dot of the link
    dw[i] = (R[i].T @ dw[i-1] + cross(R[i].T @ w[i-1], qd[i]*z[i]) + qdd[i]*z[i]
             if hinge[i] else R[i].T @ dw[i-1])
    # the acceleration of the link's origin
    dv[i] = R[i].T @ (dv[i-1] + cross(dw[i-1], P[i]) + cross(w[i-1], cross(w[i-1], P[i])))
    # the acceleration of the link's origin
    dv[i] = dv[i] if hinge[i] else dv[i] + 2*cross(w[i], qd[i]*z[i]) + qdd[i]*z[i]
"""
ACCELERATIONS = (
    _OUTWARD
    + """
    asked[i] = twist(dv[i], dw[i])
"""
)
CRAIG = (
    _OUTWARD
    + """
    # the acceleration of the centre of mass
    dvc[i] = dv[i] + cross(dw[i], c[i]) + cross(w[i], cross(w[i], c[i]))
    # the link's own force F
    F[i] = m[i]*dvc[i]
    # the link's own moment N
    N[i] = I[i] @ dw[i] + cross(w[i], I[i] @ w[i])
f[n+1] = zero
nn[n+1] = zero
P[n+1] = end
R[n+1] = one
for i in inward:
    # the force f of the link
    f[i] = R[i+1] @ f[i+1] + F[i]
    # the moment n of the link
    nn[i] = N[i] + R[i+1] @ nn[i+1] + cross(c[i], F[i]) + cross(P[i+1], R[i+1] @ f[i+1])
    # the joint torque
    tau[i] = (nn[i] @ z[i] if hinge[i] else f[i] @ z[i]) + Ia[i]*qdd[i]
"""
)

SICILIANO = """
w[0] = zero
dw[0] = zero
# the start of the recursion
dv[0] = -g
for i in outward:
    # the angular acceleration omega_dot of the link
    dw[i] = (R[i].T @ (dw[i-1] + qdd[i]*z[i] + cross(w[i-1], qd[i]*z[i]))
             if hinge[i] else R[i].T @ dw[i-1])
    # the angular velocity w of the link
    w[i] = R[i].T @ (w[i-1] + qd[i]*z[i]) if hinge[i] else R[i].T @ w[i-1]
    # the acceleration of the link's origin
    dv[i] = (R[i].T @ dv[i-1] if hinge[i] else R[i].T @ (dv[i-1] + qdd[i]*z[i])
             + 2*cross(w[i], qd[i]*(R[i].T @ z[i])))
    # the acceleration of the link's origin
    dv[i] = dv[i] + cross(dw[i], P[i]) + cross(w[i], cross(w[i], P[i]))
    # the acceleration of the centre of mass
    dvc[i] = dv[i] + cross(dw[i], c[i]) + cross(w[i], cross(w[i], c[i]))
    # the link's own force F
    F[i] = m[i]*dvc[i]
    # the link's own moment N
    N[i] = I[i] @ dw[i] + cross(w[i], I[i] @ w[i])
f[n+1] = zero
nn[n+1] = zero
R[n+1] = one
for i in inward:
    # the force f of the link
    f[i] = R[i+1] @ f[i+1] + F[i]
    # the moment n of the link
    nn[i] = (N[i] + R[i+1] @ nn[i+1] + cross(P[i], R[i+1] @ f[i+1])
             + cross(P[i] + c[i], F[i]))
    # the joint torque
    tau[i] = ((nn[i] @ (R[i].T @ z[i]) if hinge[i] else f[i] @ (R[i].T @ z[i]))
              + Ia[i]*qdd[i])
"""

SPONG = SICILIANO.replace(
    """    nn[i] = (N[i] + R[i+1] @ nn[i+1] + cross(P[i], R[i+1] @ f[i+1])
             + cross(P[i] + c[i], F[i]))
""",
    """    nn[i] = (N[i] + R[i+1] @ nn[i+1] - cross(f[i], P[i] + c[i])
             + cross(R[i+1] @ f[i+1], c[i]))
""",
)
"""The same with moments about the centre of mass (Spong 7.149)."""

_SPATIAL = """
none = twist(zero, zero)
tw[0] = none
# the start of the recursion
dtw[0] = twist(-g, zero)
for i in outward:
"""
_AXIS = """
    # the joint's axis S
    S[i] = twist(zero, z[i]) if hinge[i] else twist(z[i], zero)
    # the transform X of twists
    X[i] = blocks(R[i].T, -(R[i].T @ skew(P[i])), nil, R[i].T)
"""
_AXIS_AT_START = """
    # the joint's axis S
    S[i] = (twist(cross(R[i].T @ z[i], P[i]), R[i].T @ z[i]) if hinge[i]
            else twist(R[i].T @ z[i], zero))
    # the transform X of twists
    X[i] = blocks(R[i].T, -(skew(P[i]) @ R[i].T), nil, R[i].T)
"""
"""The same of a standard table: the axis is that of the frame before."""
_INERTIA = """
    # the link's spatial inertia
    Is[i] = blocks(m[i]*one, -(m[i]*skew(c[i])), m[i]*skew(c[i]),
                   I[i] - m[i]*skew(c[i]) @ skew(c[i]))
"""
_SPATIAL_FORCES = """
    # the twist V of the link
    tw[i] = X[i] @ tw[i-1] + qd[i]*S[i]
    # the acceleration of the link as a twist
    dtw[i] = X[i] @ dtw[i-1] + qdd[i]*S[i] + motion(tw[i], qd[i]*S[i])
    # the link's own force and moment
    F[i] = Is[i] @ dtw[i] + force(tw[i], Is[i] @ tw[i])
f[n+1] = none
X[n+1] = blocks(one, nil, nil, one)
for i in inward:
    # the force f of the link
    f[i] = F[i] + X[i+1].T @ f[i+1]
    # the joint torque
    tau[i] = f[i] @ S[i] + Ia[i]*qdd[i]
"""
_COMPOSITE = """
Ic[n+1] = blocks(nil, nil, nil, nil)
X[n+1] = blocks(one, nil, nil, one)
for i in inward:
    # the composite body's inertia
    Ic[i] = Is[i] + X[i+1].T @ Ic[i+1] @ X[i+1]
f[n+1] = none
for k in outward:
    for j in inward:
        # the force f of the link
        f[j] = Ic[k] @ S[k] if k <= j else X[j+1].T @ f[j+1]
        # the mass matrix
        H[j] = S[j] @ f[j] if j <= k else number
    row[k] = columns(H)
M = columns(row)
# the mass matrix
M = M + M.T - both_(M)
# the rotors' inertia
M = M + diagonal(rotors)
"""


def spatial(standard: bool) -> str:
    """The recursion with spatial vectors, the linear part first (Featherstone's)."""
    return _spatial(standard) + _SPATIAL_FORCES


def composite(standard: bool) -> str:
    """The mass matrix by composite bodies (Featherstone's)."""
    return _spatial(standard) + _COMPOSITE


def _spatial(standard: bool) -> str:
    return _SPATIAL + (_AXIS_AT_START if standard else _AXIS) + _INERTIA


_ENERGY = """
    # the velocity of the centre of mass
    vc[i] = v[i] + cross(w[i], c[i])
    # the kinetic energy
    each[i] = 0.5*m[i]*vc[i] @ vc[i] + 0.5*w[i] @ I[i] @ w[i]
    # the sum over the links
    E = E + each[i] + 0.5*Ia[i]*qd[i]**2
"""
_MOVED = """
w[0] = zero
v[0] = zero
for i in outward:
    # the angular velocity w of the link
    w[i] = R[i].T @ (w[i-1] + qd[i]*z[i]) if hinge[i] else R[i].T @ w[i-1]
    # the velocity v of the link's origin
    v[i] = R[i].T @ v[i-1] if hinge[i] else R[i].T @ (v[i-1] + qd[i]*z[i])
    # the velocity v of the link's origin
    v[i] = v[i] + cross(w[i], P[i])
"""
ENERGIES = {"kinetic_energy": "E", "link_kinetic_energies": "each"}
"""By quantity: what is asked for."""


def energies(standard: bool, in_base: bool) -> str:
    """The kinetic energy by the links' velocities, in their axes or in the base's."""
    moved = _MOVED if standard else VELOCITIES.partition("    asked[i]")[0]
    text = "E = number" + moved + _ENERGY
    return _based(text) if in_base else text


_OWN_MOMENTUM = """
    # the velocity of the centre of mass
    vc[i] = v[i] + cross(w[i], c[i])
    # the link's own momentum
    F[i] = m[i]*vc[i]
    # the link's own angular momentum
    N[i] = I[i] @ w[i]
"""
_MOMENTA = {
    "the force f of the link": "the momentum of the link and those behind",
    "the moment n of the link": "the angular momentum of the link and those behind",
    "the joint torque": "the momentum",
    "the moment about the base's origin": "the angular momentum about the base's origin",
    "qdd": "qd",
    r"F\b(?=\[)": "hl",
    r"N\b(?=\[)": "ha",
    r"f\b(?=\[)": "bl",
    r"nn\b(?=\[)": "ba",
    r"no\b(?=\[)": "hb",
}
"""What a recursion of forces is called where it is one of momenta."""
_ABOUT_ORIGIN = """
    # the moment about the base's origin
    no[i] = N[i] + cross(o_[i] + cb[i], F[i])
f[n+1] = zero
nn[n+1] = zero
for i in inward:
    # the force f of the link
    f[i] = f[i+1] + F[i]
    # the moment n of the link
    nn[i] = nn[i+1] + no[i]
    # the joint torque
    tau[i] = ((nn[i] - cross(o[i], f[i])) @ z[i] if hinge[i] else f[i] @ z[i]) + Ia[i]*qdd[i]
"""


def about_origin(standard: bool) -> str:
    """Newton-Euler in base axes with all moments about the base's origin."""
    text = (SICILIANO if standard else CRAIG).partition("f[n+1]")[0]
    return _based(text) + _ABOUT_ORIGIN


def momenta(standard: bool) -> Iterator[tuple[str, bool]]:
    """The momentum by the links' own: each derivation, and whether it is in base axes.

    In link axes, in the base's, about the base's origin, and with spatial vectors.
    """
    moved = _MOVED if standard else VELOCITIES.partition("    asked[i]")[0]
    rest = "".join((SICILIANO if standard else CRAIG).partition("f[n+1]")[1:])
    for in_base, text in (
        (False, moved + _OWN_MOMENTUM + rest),
        (True, _based(moved + _OWN_MOMENTUM + rest)),
        (True, _based(moved + _OWN_MOMENTUM) + _ABOUT_ORIGIN),
    ):
        for old, new in _MOMENTA.items():
            text = re.sub(rf"\b{old}", new, text)
        yield text, in_base
    rest = _SPATIAL_FORCES.partition("    # the acceleration")[0]
    head = _spatial(standard).replace("dtw[0] = twist(-g, zero)", "dtw[0] = none")
    yield head + rest + _SPATIAL_MOMENTA, False


_SPATIAL_MOMENTA = """
    # the link's own momentum
    hl[i] = Is[i] @ tw[i]
bl[n+1] = none
X[n+1] = blocks(one, nil, nil, one)
for i in inward:
    # the momentum of the link and those behind
    bl[i] = hl[i] + X[i+1].T @ bl[i+1]
    # the momentum
    tau[i] = bl[i] @ S[i] + Ia[i]*qd[i]
"""
_SPATIAL_ENERGY = """
    # the kinetic energy
    each[i] = 0.5*tw[i] @ (Is[i] @ tw[i])
    # the sum over the links
    E = E + each[i] + 0.5*Ia[i]*qd[i]**2
"""


def spatial_energies(standard: bool) -> str:
    """The kinetic energy by the links' spatial inertias."""
    rest = _SPATIAL_FORCES.partition("    # the acceleration")[0]
    return "E = number" + _spatial(standard) + rest + _SPATIAL_ENERGY


def lagrangian(standard: bool) -> str:
    """L = T - V, by the links' energies, in base axes."""
    return (
        energies(standard, True)
        + """
V = number
for i in outward:
    # the potential energy
    V = V - m[i]*g @ (o_[i] + cb[i])
# the Lagrangian L = T - V
E = E - V
"""
    )


COMPOSITE_IN_BASE = """
Ic[n+1] = blocks(nil, nil, nil, nil)
for i in inward:
    # the centre of mass
    pc[i] = o_[i] + R_[i] @ c[i]
    # the link's spatial inertia
    Is[i] = blocks(m[i]*one, -(m[i]*skew(pc[i])), m[i]*skew(pc[i]),
                   R_[i] @ I[i] @ R_[i].T - m[i]*skew(pc[i]) @ skew(pc[i]))
    # the composite body's inertia
    Ic[i] = Is[i] + Ic[i+1]
    # the joint's axis S
    S[i] = twist(cross(o[i], z[i]), z[i]) if hinge[i] else twist(z[i], zero)
for k in outward:
    for j in outward:
        # the mass matrix
        H[j] = S[j] @ (Ic[k] @ S[k]) if j <= k else number
    row[k] = columns(H)
M = columns(row)
# the mass matrix
M = M + M.T - both_(M)
# the rotors' inertia
M = M + diagonal(Ia)
"""
"""The same with all about the base's origin."""

EXPONENTIALS = """
T[0] = base
for i in outward:
    # the joint's axis, where it is at rest
    K[i] = skew(z[i])
    # Rodrigues' rotation
    R[i] = one + sin(q[i])*K[i] + (1 - cos(q[i]))*(K[i] @ K[i]) if hinge[i] else one
    # the joint's displacement
    E[i] = pose((R[i]), (one - R[i]) @ o[i] if hinge[i] else q[i]*z[i])
    # the product of exponentials
    T[i] = T[i-1] @ E[i]
# the tool's pose
pose = T[n] @ home @ tool
"""

RATES = """
# the tool's point
p = last + Rn @ tool
w[0] = zero
u[0] = zero
for i in outward:
    # the angular velocity w of the link
    w[i] = w[i-1] + qd[i]*z[i] if hinge[i] else w[i-1]
    # the velocity of the joint's origin
    u[i] = u[i-1] + cross(w[i-1], o[i] - o[i-1])
    # the velocity of the joint's origin
    u[i] = u[i] if hinge[i] else u[i] + qd[i]*z[i]
# the velocity of the tool's point
dp = u[n] + cross(w[n], p - o[n])
for i in outward:
    # the rate of the joint's axis
    dz[i] = cross(w[i-1], z[i])
    # the rate of the Jacobian's column
    J[i] = (twist(cross(dz[i], p - o[i]) + cross(z[i], dp - u[i]), dz[i]) if hinge[i]
            else twist(dz[i], zero))
E = columns(J)
"""

COLUMNS = """
# the tool's point
p = last + Rn @ tool
for i in outward:
    # the Jacobian's column
    J[i] = twist(cross(z[i], p - o[i]), z[i]) if hinge[i] else twist(z[i], zero)
# the Jacobian
Jb = columns(J)
"""

STATICS = """
# the joint torques of a wrench
tau = Jb.T @ wrench
"""

THROUGH = """
for i in outward:
    # the force and moment through the joint
    asked[i] = twist(f[i], nn[i])
"""

WRENCHES = """
for i in outward:
    # the link's own force and moment
    asked[i] = twist(F[i], N[i])
"""
"""What is asked for of the recursion besides the torques."""

RATE = """
D = slope(Jb)
# the Jacobian's rate
E = D @ v
"""

PASSED_ON = """
P[n+1] = end
R[n+1] = one
for i in inward:
    # the force f of the link
    f[i] = R[i+1] @ f[i+1]
    # the moment n of the link
    nn[i] = R[i+1] @ nn[i+1] + cross(P[i+1], f[i])
    # the joint torque
    tau[i] = nn[i] @ z[i] if hinge[i] else f[i] @ z[i]
"""

TOOLWARD = """
Ru[n+1] = one
pu[n+1] = zero
R[n+1] = Rt
P[n+1] = e
for i in inward:
    # the tool's rotation, seen from the link
    Ru[i] = R[i+1] @ Ru[i+1]
    # the tool's place, seen from the link
    pu[i] = P[i+1] + R[i+1] @ pu[i+1]
    # the Jacobian's column
    J[i] = (twist(Ru[i].T @ cross(z[i], pu[i]), Ru[i].T @ z[i]) if hinge[i]
            else twist(Ru[i].T @ z[i], zero))
E = columns(J)
"""
"""The Jacobian in tool axes from the tool inward (Paul's)."""


def toolward(standard: bool) -> str:
    """The tool Jacobian by the products of the link transforms behind each joint."""
    if not standard:
        return TOOLWARD
    text = TOOLWARD.partition("for i")
    head = "Ru[n+1] = Rt\npu[n+1] = e\n"
    body = text[2].replace("R[i+1] @ Ru", "R[i] @ Ru")
    body = body.replace("P[i+1] + R[i+1] @ pu[i+1]", "R[i] @ (P[i] + pu[i+1])")
    return head + text[1] + body


TWISTED = {
    "base": "",
    "tool": "# the Jacobian in tool axes\nJb = both.T @ Jb\n",
    "spatial": "# the Jacobian with the base's origin as its point\nJb = carried @ Jb\n",
}
"""What follows the Jacobian in base axes at the tool."""

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

VELOCITY = """
D = slope(M)
# the velocity torques: Mdot v and the gradient of ½ v^T M v
c = (D @ v) @ v - 0.5*(jki(D) @ v) @ v
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

STANDARD = """
    # the link's matrix
    A[i] = [[ct, -st*ca, st*sa, a[i]*ct],
            [st, ct*ca, -ct*sa, a[i]*st],
            [0, sa, ca, dd],
            [0, 0, 0, 1]]
"""
MODIFIED = """
    # the link's matrix
    A[i] = [[ct, -st, 0, a[i]],
            [st*ca, ct*ca, -sa, -sa*dd],
            [st*sa, ct*sa, ca, ca*dd],
            [0, 0, 0, 1]]
"""
MATRIX = """
T[0] = base
for i in outward:
    # the angle theta, with q at a hinge (revolute joint)
    th = theta[i] + q[i] if hinge[i] else theta[i]
    # the offset d, with q at a slide (prismatic joint)
    dd = d[i] if hinge[i] else d[i] + q[i]
    # the cosine and sine of theta
    ct = cos(th)
    # the cosine and sine of theta
    st = sin(th)
    # the cosine and sine of alpha
    ca = cos(alpha[i])
    # the cosine and sine of alpha
    sa = sin(alpha[i])
{matrix}
    # the product of the link transforms
    T[i] = T[i-1] @ A[i]
# the tool's pose
pose = T[n] @ tool
"""
ELEMENTARY = """
T[0] = base
for i in outward:
    # the product of the elementary transforms
    T[i] = T[i-1] @ {order}
# the tool's pose
pose = T[n] @ tool
"""


def product_of_links(standard: bool) -> str:
    """The product of link matrices, written out in the convention."""
    return MATRIX.format(matrix=STANDARD if standard else MODIFIED)


def product_of_elements(standard: bool) -> str:
    """The product of elementary transforms, in the convention's order."""
    order = "Rz[i] @ Tz[i] @ Tx[i] @ Rx[i]" if standard else "Rx[i] @ Tx[i] @ Rz[i] @ Tz[i]"
    return ELEMENTARY.format(order=f"({order})")


def newton_euler(standard: bool, in_base: bool) -> str:
    """The recursion in the links' axes, or with all vectors in base axes."""
    text = SICILIANO if standard else CRAIG
    if not in_base:
        return text
    return _based(text)


def _based(text: str) -> str:
    """A recursion in the links' axes with all vectors in base axes."""
    text = text.replace("R[i].T @ ", "").replace("R[i+1] @ ", "")
    text = text.replace("vc[i]", "v_").replace("c[i]", "cb[i]").replace("v_", "vc[i]")
    text = text.replace("I[i]", "Ib[i]")
    return text.replace("for i in outward:\n", _IN_BASE, 1)


def loaded(text: str) -> str:
    """A recursion whose last link holds a load."""
    for name in ("f", "nn"):
        text = text.replace(f"{name}[n+1] = zero\n", "")
    return text


def held(in_tool: bool, in_base: bool) -> str:
    """The wrench at the tool about the last link's origin, in the link's axes or in the base's."""
    turn = {(False, False): "Rn.T @ ", (True, False): "Rt @ ", (True, True): "Rn @ Rt @ "}
    to = turn.get((in_tool, in_base), "")
    arm = "arm" if in_base else "e"
    return f"""
# the wrench in the axes of the recursion
f[n+1] = {to}fw
# the wrench about the last link's origin
nn[n+1] = {to}nw + cross({arm}, f[n+1])
"""


def passed_on(standard: bool, in_base: bool) -> str:
    """Forces at rest from link to link, in the links' axes or in the base's."""
    text = PASSED_ON
    if standard:
        # P[i] leads to frame i, and the moment is that about the frame before
        text = text.replace("P[i+1]", "P[i]")
        text = text.replace("@ z[i]", "@ (R[i].T @ z[i])")
    return text.replace("R[i].T @ ", "").replace("R[i+1] @ ", "") if in_base else text


_IN_BASE = """for i in outward:
    # the centre of mass in base axes
    cb[i] = R_[i] @ c[i]
    # the inertia tensor in base axes
    Ib[i] = R_[i] @ I[i] @ R_[i].T
"""

ANGULAR = """
for i in outward:
    # the rotation from the link to the last one
    Rn[i] = R_[n].T @ R_[i]
    # the Jacobian's column
    J[i] = Rn[i] @ z[i] if hinge[i] else zero
# the Jacobian in the last link's axes
asked = columns(J)
"""
CONDITIONS = """
# the products of the Jacobian's rows
E = conditions(J @ J.T)
"""
ISOTROPIC = {
    "orthogonal_columns_cosine": "-l2/l1",
    "equal_columns_cosine": "-l1/(2*l2)",
}
"""Where the columns of a planar 2R arm are orthogonal, and where equally long (note 000)."""

ISOTROPY = """
# the products of the Jacobian's rows
E = defect(J @ J.T)
"""

BOUNDARY = """
# the boundary term
b = late @ later - early @ earlier
# the variation with its boundary term
E = inner + b
"""
"""The action's variation between free ends: by parts, with dL/dqd and dq at both ends."""

ITERATIVE = {
    "newton_step": "q + solve(J, target - x)",
    "loss": "0.5*(target - x) @ (target - x)",
    "loss_gradient": "-J.T @ (target - x)",
    "gradient_step": "q + 0.1*(J.T @ (target - x))",
    "least_rates": "J.T @ inv(J @ J.T) @ twist",
}
"""Steps of iterative inverse kinematics, by quantity."""

OF_COLUMNS = {
    **{name: ("planar", f"# the step\nE = {text}") for name, text in ITERATIVE.items()},
    "least_rates": ("all_of", f"# the step\nE = {ITERATIVE['least_rates']}"),
    "tip_speed_squared": ("linear", "# the velocity of the tool's point\ndp = J @ v\n"
                          "# the square of the speed\nE = dp @ dp"),
    "isotropy_defect": ("position", ISOTROPY),
    "isotropy_conditions": ("position", CONDITIONS),
}  # fmt: skip
"""By quantity: the rows of the Jacobian, and what is made of them."""


def of_columns(name: str) -> str:
    """What is made of a Jacobian, with its columns."""
    rows, rest = OF_COLUMNS[name]
    return f"{COLUMNS}\nJ = {rows}(Jb)\n{rest}\n"


FIVE_BAR = """
for i in outward:
    # the coefficient A
    A[i] = 2*(s[i]*e - x)*l1[i]
    # the coefficient B
    B[i] = -2*y*l1[i]
    # the right side C
    C[i] = l2[i]**2 - l1[i]**2 - e**2 - x**2 - y**2 + 2*s[i]*e*x
"""
_CRANKS = """
    # the crank's angle theta, by the half tangent
    theta[i] = 2*arctan((B[i] + mode[i]*sqrt(A[i]**2 + B[i]**2 - C[i]**2))/(A[i] + C[i]))
"""
_BARS = """
    # the crank's direction u
    crank[i] = vector(cos(theta[i]), sin(theta[i]))
    # the rod's direction w
    rod[i] = (r - s[i]*e*E1 - l1[i]*crank[i])/l2[i]
    # the sine u^T H w
    k[i] = crank[i] @ H @ rod[i]
    # the row of J
    J[i] = rod[i]/(l1[i]*k[i])
"""
_MOVING = """
    # the bias f(v) of the crank's acceleration
    fv[i] = ((v @ rod[i])**2*(crank[i] @ rod[i])/l1[i] + (v @ crank[i])**2/l2[i])/(l1[i]*k[i]**3)
    # the crank's acceleration
    acc[i] = J[i] @ a + fv[i]
    # the crank's inertia about its base pin
    IA[i] = Iz[i] + mc[i]*cc[i]**2 + Im[i]*j[i]**2
    # the crank's own torque
    own[i] = IA[i]*acc[i] + mc[i]*cc[i]*g*(crank[i] @ E1)
"""
_TORQUE = """
Jm = columns(J).T
own = columns(own)
# the torque by virtual work
tau = own + inv(Jm).T @ (m*(a + g*E2))
"""
_RODS = """
    # the crank's rate
    rate[i] = J[i] @ v
    # the rod's turn per motion of the tool
    K[i] = (H.T @ rod[i] - l1[i]*(rod[i] @ crank[i])*J[i])/l2[i]
    # the rod's rate
    spin[i] = K[i] @ v
    # the rod's angular acceleration
    alpha[i] = ((H.T @ rod[i]) @ (a - l1[i]*acc[i]*(H.T @ crank[i]) + l1[i]*rate[i]**2*crank[i])
                /l2[i])
    # the acceleration of the rod's centre
    ac[i] = (l1[i]*acc[i]*(H.T @ crank[i]) - l1[i]*rate[i]**2*crank[i]
             + cd[i]*alpha[i]*(H.T @ rod[i]) - cd[i]*spin[i]**2*rod[i])
    # the rod's inertia force, with its weight
    F[i] = md[i]*(ac[i] + g*E2)
    # the force on the tool that the rod asks for
    Q[i] = (l1[i]*(F[i] @ (H.T @ crank[i]))*J[i] + cd[i]*(F[i] @ (H.T @ rod[i]))*K[i]
            + Id[i]*alpha[i]*K[i])
"""
_HEAVY = """
Jm = columns(J).T
own = columns(own)
pull = columns(Q) @ legs
# the torque by virtual work
tau = own + inv(Jm).T @ (m*(a + g*E2) + pull)
"""
_GAIN = """
for i in outward:
    # the crank's inertia about its base pin
    IA[i] = Iz[i] + mc[i]*cc[i]**2 + Im[i]*j[i]**2
Jm = columns(J).T
# G, the torque per acceleration
E = diagonal(columns(IA)) @ Jm + m*inv(Jm).T
"""
_LOOP = FIVE_BAR + _CRANKS + _BARS
CLOSED = {
    "fivebar_rod_length": (
        "L",
        """
for i in outward:
    # the length of the rod
    L[i] = sqrt((s[i]*e + l1[i]*cos(theta[i]) - x)**2 + (l1[i]*sin(theta[i]) - y)**2)
""",
    ),
    "fivebar_projection": ("C", FIVE_BAR),
    "fivebar_cranks": ("crank", _LOOP),
    "fivebar_rods": ("rod", _LOOP),
    "fivebar_jacobian": ("J", _LOOP),
    "fivebar_turn": ("acc", _LOOP + _MOVING),
    "fivebar_torque_massless": ("tau", _LOOP + _MOVING + _TORQUE),
    "fivebar_torque": ("tau", _LOOP + _MOVING + _RODS + _HEAVY),
    "fivebar_load_inertia_massless": (
        "E",
        _LOOP
        + """
    # the crank's inertia about its base pin
    IA[i] = Ic[i] + mc[i]*cc[i]**2 + Im[i]*j[i]**2
Jm = columns(J).T
# the load's inertia
E = columns(IA) + m*norm(inv(Jm).T)**2
""",
    ),
    "fivebar_torque_per_acceleration": ("E", _LOOP + _GAIN),
    "fivebar_torque_per_acceleration_worst": (
        "E",
        _LOOP
        + _GAIN
        + """
# the worst torque per acceleration
E = norm(E)
""",
    ),
    "fivebar_rate_per_speed": (
        "E",
        _LOOP
        + """
Jm = columns(J).T
# the worst crank rate per speed
E = norm(Jm)
""",
    ),
    "fivebar_power_massless": (
        "E",
        _LOOP
        + _MOVING
        + _TORQUE
        + """
# the power
E = tau*(Jm @ v)
""",
    ),
}
"""By quantity: what is asked for, and the derivation."""
OTHER_SIDE = """
for i in outward:
    # the left side A cos(theta) + B sin(theta)
    C[i] = 2*(s[i]*e - x)*l1[i]*cos(theta[i]) - 2*y*l1[i]*sin(theta[i])
"""

LINES = (
    N_("the angular velocity w of the link"),
    N_("the velocity v of the link's origin"),
    N_("the start of the recursion"),
    N_("the angular acceleration omega_dot of the link"),
    N_("the acceleration of the link's origin"),
    N_("the acceleration of the centre of mass"),
    N_("the link's own force F"),
    N_("the link's own moment N"),
    N_("the link's own force and moment"),
    N_("the force f of the link"),
    N_("the moment n of the link"),
    N_("the joint torque"),
    N_("the Jacobian's column"),
    N_("the Jacobian"),
    N_("the tool's point"),
    N_("the Jacobian in tool axes"),
    N_("the Jacobian with the base's origin as its point"),
    N_("the Jacobian's rate"),
    N_("the joint torques of a wrench"),
    N_("the centre of mass"),
    N_("the linear part of the link's Jacobian"),
    N_("the angular part of the link's Jacobian"),
    N_("the mass matrix"),
    N_("the gravity torques"),
    N_("the potential energy"),
    N_("the rotors' inertia"),
    N_("Christoffel's C_ij = Σ ½ (dM_ij/dq_k + dM_ik/dq_j - dM_jk/dq_i) qd_k"),
    N_("the velocity torques: Mdot v and the gradient of ½ v^T M v"),
    N_("the kinetic energy"),
    N_("the momentum"),
    N_("the Lagrangian L = T - V"),
    N_("the velocity torques"),
    N_("the equation of motion"),
    N_("the joint's axis S"),
    N_("the joint's axis, where it is at rest"),
    N_("Rodrigues' rotation"),
    N_("the joint's displacement"),
    N_("the product of exponentials"),
    N_("the force and moment through the joint"),
    N_("the tool's rotation, seen from the link"),
    N_("the tool's place, seen from the link"),
    N_("the wrench in the axes of the recursion"),
    N_("the wrench about the last link's origin"),
    N_("the transform X of twists"),
    N_("the link's spatial inertia"),
    N_("the twist V of the link"),
    N_("the acceleration of the link as a twist"),
    N_("the composite body's inertia"),
    N_("the velocity of the centre of mass"),
    N_("the sum over the links"),
    N_("the link's own momentum"),
    N_("the link's own angular momentum"),
    N_("the momentum of the link and those behind"),
    N_("the angular momentum of the link and those behind"),
    N_("the moment about the base's origin"),
    N_("the angular momentum about the base's origin"),
    N_("the square of the speed"),
    N_("the velocity of the joint's origin"),
    N_("the velocity of the tool's point"),
    N_("the rate of the joint's axis"),
    N_("the rate of the Jacobian's column"),
    N_("dM_ij/dq_k"),
    N_("Mdot"),
    N_("Mdot v"),
    N_("Mdot - 2C"),
    N_("the gradient of ½ v^T M v"),
    N_("the gradient of the Lagrangian"),
    N_("the momentum's rate"),
    N_("Christoffel's ½ (dM_ij/dq_k + dM_ik/dq_j - dM_jk/dq_i)"),
    N_("the link's matrix"),
    N_("the angle theta, with q at a hinge (revolute joint)"),
    N_("the offset d, with q at a slide (prismatic joint)"),
    N_("the cosine and sine of theta"),
    N_("the cosine and sine of alpha"),
    N_("the product of the link transforms"),
    N_("the tool's pose"),
    N_("the product of the elementary transforms"),
    N_("the centre of mass in base axes"),
    N_("the inertia tensor in base axes"),
    N_("the products of the Jacobian's rows"),
    N_("the coefficient A"),
    N_("the coefficient B"),
    N_("the right side C"),
    N_("the crank's angle theta, by the half tangent"),
    N_("the crank's direction u"),
    N_("the rod's direction w"),
    N_("the sine u^T H w"),
    N_("the row of J"),
    N_("the bias f(v) of the crank's acceleration"),
    N_("the crank's acceleration"),
    N_("the crank's inertia about its base pin"),
    N_("the crank's own torque"),
    N_("the torque by virtual work"),
    N_("G, the torque per acceleration"),
    N_("the worst torque per acceleration"),
    N_("the worst crank rate per speed"),
    N_("the power"),
    N_("the left side A cos(theta) + B sin(theta)"),
    N_("the step"),
    N_("the rotation from the link to the last one"),
    N_("the Jacobian in the last link's axes"),
    N_("the length of the rod"),
    N_("the crank's rate"),
    N_("the rod's turn per motion of the tool"),
    N_("the rod's rate"),
    N_("the rod's angular acceleration"),
    N_("the acceleration of the rod's centre"),
    N_("the rod's inertia force, with its weight"),
    N_("the force on the tool that the rod asks for"),
    N_("the load's inertia"),
    N_("the cosine of theta2"),
    N_("the boundary term"),
    N_("the variation with its boundary term"),
)
"""What the lines of the derivations are, to be translated."""
