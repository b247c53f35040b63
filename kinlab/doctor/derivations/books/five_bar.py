"""The five-bar: its loop, rates, torques, rods with mass."""

from __future__ import annotations

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
    IA[i] = Iz[i] + mc[i]*cc[i]**2 + Im[i]*j[i]**2
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
