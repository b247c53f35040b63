"""Jacobians column by column, what is made of them: statics, rates, steps, isotropy."""

from __future__ import annotations

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
RATE = """
D = slope(Jb)
# the Jacobian's rate
E = D @ v
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
    "tip_speed_squared": (
        "linear",
        "# the velocity of the tool's point\ndp = J @ v\n# the square of the speed\nE = dp @ dp",
    ),
    "isotropy_defect": ("position", ISOTROPY),
    "isotropy_conditions": ("position", CONDITIONS),
}
"""By quantity: the rows of the Jacobian, and what is made of them."""


def of_columns(name: str) -> str:
    """What is made of a Jacobian, with its columns."""
    rows, rest = OF_COLUMNS[name]
    return f"{COLUMNS}\nJ = {rows}(Jb)\n{rest}\n"
