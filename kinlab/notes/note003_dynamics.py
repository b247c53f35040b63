"""Note 003: inverse dynamics of the five-bar, and what follows for the servomotors.

The note's rods have no mass. The row of the exact torque is not in the note: it is what the
engine has when they do. Vector g points down; the note writes m g e2 for minus the weight.
"""

from __future__ import annotations

from functools import partial
from typing import Any

import numpy as np

from kinlab.formulas.record import formula
from kinlab.notes.loop import E2, Array, Loop, dot, inverse_transpose, legs, times
from kinlab.notes.note003_kinematics import bars, bias, jacobian, turn

HEAVY = ("isotropic", "unequal")
INVERSE = "note 003, inverse dynamics"
SERVO = "note 003, servomotor parameter estimation"


def _crank_gravity(loop: Loop, u: Array) -> Any:
    return loop.crank * loop.crank_com * loop.g * u[..., 0]


_inverse = partial(formula, source=INVERSE, robots=HEAVY)


@_inverse(
    "003.vw",
    quantity="fivebar_torque_massless",
    latex=r"\boldsymbol\tau = (I_A \boldsymbol J + m \boldsymbol J^{-T}) \boldsymbol a"
    r" + I_A f(\boldsymbol v) + \boldsymbol\tau_{Ag} + m g \boldsymbol J^{-T} \boldsymbol e_2",
    remark="Holds for rods without mass and a point payload.",
)
def torque(loop: Loop, xy: Array, v: Array, a: Array, mode: Array) -> Any:
    """Virtual work: crank torques with massless rods."""
    u, _, _ = bars(loop, xy, mode)
    held = loop.payload * loop.g * times(inverse_transpose(jacobian(loop, xy, mode)), E2)
    moved = times(linear(loop, xy, mode), a) + loop.arm * bias(loop, xy, v, mode)
    return moved + _crank_gravity(loop, u) + held


@_inverse(
    "003.vw",
    part="joint",
    quantity="fivebar_torque_massless",
    latex=r"\boldsymbol\tau = (I_A + m \boldsymbol J^{-T} \boldsymbol J^{-1})"
    r" \ddot{\boldsymbol\theta} - m \boldsymbol J^{-T} \boldsymbol J^{-1} f + \boldsymbol\tau_{Ag}"
    r" + m g \boldsymbol J^{-T} \boldsymbol e_2",
)
def torque_in_joints(loop: Loop, xy: Array, v: Array, a: Array, mode: Array) -> Any:
    """The same in the crank accelerations."""
    u, _, _ = bars(loop, xy, mode)
    reflected = loop.payload * tool_inertia(loop, xy, mode)
    held = loop.payload * loop.g * times(inverse_transpose(jacobian(loop, xy, mode)), E2)
    theta_ddot = turn(loop, xy, v, a, mode)
    payload = times(reflected, theta_ddot) - times(reflected, bias(loop, xy, v, mode))
    return loop.arm * theta_ddot + payload + _crank_gravity(loop, u) + held


def tool_inertia(loop: Loop, xy: Array, mode: Array) -> Any:
    """J^-T J^-1."""
    back = inverse_transpose(jacobian(loop, xy, mode))
    return back @ np.swapaxes(back, -1, -2)


@_inverse(
    "003.vw",
    part="rods",
    source="not in the note; Lagrange's equation with rigid rods",
    quantity="fivebar_torque",
    latex=r"\tau_i = I_{A,i}^* \ddot\theta_i + \kappa_i l_1 \boldsymbol n_i \cdot \boldsymbol a"
    r" + \tau_{Ag,i}^* + [\boldsymbol J^{-T} ((m + \Sigma\alpha_C) \boldsymbol a"
    r" + \Sigma \kappa_i \boldsymbol a_{B,i} + (m + \Sigma \rho m_d) g \boldsymbol e_2)]_i",
)
def torque_with_rods(loop: Loop, xy: Array, v: Array, a: Array, mode: Array) -> Any:
    """Crank torques with rods of mass."""
    u, _, _ = bars(loop, xy, mode)
    n = np.stack([-u[..., 1], u[..., 0]], axis=-1)
    rho, inertia = loop.rod_com / loop.l2, loop.rod_inertia / loop.l2**2
    alpha_b, alpha_c = loop.rod * (1 - rho) ** 2 + inertia, loop.rod * rho**2 + inertia
    kappa = loop.rod * rho * (1 - rho) - inertia
    jac = jacobian(loop, xy, mode)
    rate, theta_ddot = times(jac, v), turn(loop, xy, v, a, mode)
    elbow = loop.l1[:, None] * (theta_ddot[..., None] * n - rate[..., None] ** 2 * u)
    force = (loop.payload + alpha_c.sum()) * a
    force = force + np.einsum("i,...ij->...j", kappa, elbow)
    force = force + (loop.payload + np.sum(rho * loop.rod)) * loop.g * E2
    held = (loop.crank * loop.crank_com + loop.rod * (1 - rho) * loop.l1) * loop.g * u[..., 0]
    own = (loop.arm + alpha_b * loop.l1**2) * theta_ddot + kappa * loop.l1 * dot(n, legs(a))
    return own + held + times(inverse_transpose(jac), force)


@_inverse(
    "003.G",
    quantity="fivebar_torque_per_acceleration",
    latex=r"\boldsymbol G = I_A \boldsymbol J + m \boldsymbol J^{-T}"
    r" = I_A (\boldsymbol J + \eta \boldsymbol J^{-T}), \quad \eta = m/I_A",
    remark="The note corrects the paper: eta = m/I_A, whose dimension is 1/m².",
)
def linear(loop: Loop, xy: Array, mode: Array) -> Any:
    """Torque per acceleration of the tool, massless rods."""
    jac = jacobian(loop, xy, mode)
    eta = loop.payload / loop.arm
    return loop.arm[:, None] * (jac + eta[:, None] * inverse_transpose(jac))


@_inverse(
    "003.G",
    part="sigma",
    quantity="fivebar_torque_gains",
    robots="isotropic",
    latex=r"\sigma_i(\boldsymbol G) = I_A (\sigma_i + \eta/\sigma_i) \ge 2\sqrt{m I_A}",
    remark="For legs of one inertia; least where sigma_i = sqrt(eta).",
)
def gains(loop: Loop, xy: Array, mode: Array) -> Any:
    """Singular values of G from those of J, largest first."""
    sigma = np.linalg.svd(jacobian(loop, xy, mode), compute_uv=False)
    found = loop.arm[0] * sigma + loop.payload / sigma
    return np.sort(found, axis=-1)[..., ::-1]


@_inverse("003.P", quantity="fivebar_power_massless", latex=r"P_i = \tau_i \dot\theta_i")
def power(loop: Loop, xy: Array, v: Array, a: Array, mode: Array) -> Any:
    """Power of each crank."""
    return torque(loop, xy, v, a, mode) * times(jacobian(loop, xy, mode), v)


_servo = partial(formula, source=SERVO, robots=HEAVY)


@_servo(
    "003.speed",
    quantity="fivebar_rate_per_speed",
    robots=("fivebar",),
    latex=r"\dot\Theta = \max\sqrt{\boldsymbol J_i \boldsymbol J_i^T}\, v_{\max}, \quad"
    r" j = \frac{\pi N_{\max}}{30 \dot\Theta}",
    remark="Printed with J_1 only; both rows are needed: they are equally bad only on a workspace "
    "that is symmetric about the y axis. The transpose stands under the root, behind the product: "
    "it belongs to the second factor.",
)
def rate_per_speed(loop: Loop, xy: Array, mode: Array) -> Any:
    """Worst crank rate per speed of the tool, over all directions."""
    jac = jacobian(loop, xy, mode)
    return np.sqrt(dot(jac, jac))


@_servo(
    "003.IM",
    quantity="fivebar_load_inertia_massless",
    latex=r"I_L = \operatorname{diag}(I_A + m \boldsymbol J^{-T} \boldsymbol J^{-1}), \quad"
    r" \frac{I_L}{3 j^2} < I_M < \frac{I_L}{j^2}",
    remark="The note writes I_L for the whole 2x2 matrix; a motor feels its diagonal entry.",
)
def load_inertia(loop: Loop, xy: Array, mode: Array) -> Any:
    """Inertia that each crank's motor carries, massless rods."""
    reflected = np.diagonal(tool_inertia(loop, xy, mode), axis1=-2, axis2=-1)
    return loop.arm + loop.payload * reflected


@_servo(
    "003.Tmax",
    quantity="fivebar_torque_per_acceleration_worst",
    latex=r"T_{\max} = \max\sqrt{\boldsymbol G_i \boldsymbol G_i^T}\, a_{\max}",
    remark="Printed with G_1 only; both rows are needed, and the transpose behind the product "
    "belongs to the second factor. Leaves out f(v), gravity, rods and efficiency; "
    "FiveBar.size_servo gives both.",
)
def torque_per_acceleration(loop: Loop, xy: Array, mode: Array) -> Any:
    """Worst crank torque per acceleration of the tool, over all directions."""
    rows = linear(loop, xy, mode)
    return np.sqrt(dot(rows, rows))
