"""Recursions from link to link: Newton-Euler in three forms, spatial vectors, composite bodies."""

from __future__ import annotations

import re
from collections.abc import Iterator

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
_SPATIAL_TWIST = """
    # the twist V of the link
    tw[i] = X[i] @ tw[i-1] + qd[i]*S[i]
"""
_SPATIAL_FORCES = """
    # the acceleration of the link as a twist
    dtw[i] = X[i] @ dtw[i-1] + qdd[i]*S[i] + motion(tw[i], qd[i]*S[i])
    # the link's own force and moment
    F[i] = Is[i] @ dtw[i] + force(tw[i], Is[i] @ tw[i])
"""
_SPATIAL_MOMENTUM = """
    # the link's own momentum
    F[i] = Is[i] @ tw[i]
"""
_SPATIAL_INWARD = """f[n+1] = none
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
    return _spatial(standard) + _SPATIAL_TWIST + _SPATIAL_FORCES + _SPATIAL_INWARD


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
    "# the force f of the link\n": "# the momentum of the link and those behind\n",
    "# the moment n of the link\n": "# the angular momentum of the link and those behind\n",
    "# the joint torque\n": "# the momentum\n",
    "# the moment about the base's origin\n": "# the angular momentum about the base's origin\n",
    r"\bqdd\b": "qd",
    r"\bF\b(?=\[)": "hl",
    r"\bN\b(?=\[)": "ha",
    r"\bf\b(?=\[)": "bl",
    r"\bnn\b(?=\[)": "ba",
    r"\bno\b(?=\[)": "hb",
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
    vectors = _spatial(standard) + _SPATIAL_TWIST + _SPATIAL_MOMENTUM + _SPATIAL_INWARD
    for in_base, text in (
        (False, moved + _OWN_MOMENTUM + rest),
        (True, _based(moved + _OWN_MOMENTUM + rest)),
        (True, _based(moved + _OWN_MOMENTUM) + _ABOUT_ORIGIN),
        (False, vectors),
    ):
        for old, new in _MOMENTA.items():
            text = re.sub(old, new, text)
        yield text, in_base


_SPATIAL_ENERGY = """
    # the kinetic energy
    each[i] = 0.5*tw[i] @ (Is[i] @ tw[i])
    # the sum over the links
    E = E + each[i] + 0.5*Ia[i]*qd[i]**2
"""


def spatial_energies(standard: bool) -> str:
    """The kinetic energy by the links' spatial inertias."""
    return "E = number" + _spatial(standard) + _SPATIAL_TWIST + _SPATIAL_ENERGY


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
