"""Notes 001 and 002, Lagrange, on the planar 2R arm with point masses.

The torque of joint 1 right and as printed, the Coriolis matrix right and as printed, and the
action along a simulated fall: varying it by eps changes S by O(eps²).

Run: python scripts/compare/compare_lagrange.py
"""

from __future__ import annotations

import numpy as np

import kinlab as kl

robot = kl.load("planar2r")
m1, m2, l1, l2, g = 2.0, 1.5, 0.5, 0.4, 9.81


def tau1(q, v, a):
    """Note 001's tau1, corrected."""
    return (
        ((m1 + m2) * l1**2 + m2 * l2**2 + 2 * m2 * l1 * l2 * np.cos(q[1])) * a[0]
        + (m2 * l2**2 + m2 * l1 * l2 * np.cos(q[1])) * a[1]
        - m2 * l1 * l2 * np.sin(q[1]) * (2 * v[0] * v[1] + v[1] ** 2)
        + (m1 + m2) * g * l1 * np.cos(q[0])
        + m2 * g * l2 * np.cos(q[0] + q[1])
    )


def tau1_printed(q, v, a):
    """As printed: m2 l2² twice, and theta2_ddot squared."""
    slip = m2 * l2 * (l2 * a[0] + (l2 + l1 * np.cos(q[1])) * (a[1] ** 2 - a[1]))
    return tau1(q, v, a) + slip


def coriolis(q, v):
    """Christoffel's C of the 2R arm."""
    h = m2 * l1 * l2 * np.sin(q[1])
    return np.array([[-h * v[1], -h * (v[0] + v[1])], [h * v[0], 0.0]])


def coriolis_printed(q, v):
    """Note 002: C_ij = ½ Σ (dM_ik/dq_j + dM_jk/dq_i) qdot_k."""
    h = m2 * l1 * l2 * np.sin(q[1])
    slope = np.array([[-2 * h, -h], [-h, 0.0]])  # dM/dq2; dM/dq1 = 0
    one = np.column_stack([np.zeros(2), slope @ v])
    return 0.5 * (one + one.T)


def action_changes(steps=2000, duration=0.5):
    """S(eps) - S(0) of a free fall, varied by eps sin(pi t / T)."""
    t = np.linspace(0.0, duration, steps + 1)
    h = t[1]
    q, v = np.array([0.4, -0.3]), np.array([1.0, -0.5])
    path = [(q, v)]
    for _ in range(steps):  # Runge-Kutta of order 4
        k = []
        for share in (0.0, 0.5, 0.5, 1.0):
            q1, v1 = (q, v) if not k else (q + share * h * k[-1][0], v + share * h * k[-1][1])
            k.append((v1, kl.forward_dynamics(robot, q1, v1, np.zeros(2))))
        q = q + h / 6 * (k[0][0] + 2 * k[1][0] + 2 * k[2][0] + k[3][0])
        v = v + h / 6 * (k[0][1] + 2 * k[1][1] + 2 * k[2][1] + k[3][1])
        path.append((q, v))
    qs, vs = (np.array(part) for part in zip(*path, strict=True))
    weights = h / 3 * np.r_[1, np.tile([4, 2], steps // 2 - 1), 4, 1]  # Simpson's rule
    shape, rate = np.sin(np.pi * t / duration), np.pi / duration * np.cos(np.pi * t / duration)

    def action(eps):
        return kl.action(robot, qs + eps * shape[:, None], vs + eps * rate[:, None], weights)

    return [(eps, action(eps) - action(0.0)) for eps in (0.1, 0.01, 0.001)]


def main() -> None:
    print("Notes 001 and 002, Lagrange, on the planar 2R arm with point masses")
    print(kl.compare(robot, "inverse_dynamics[0]", tau1))
    slip = kl.compare(robot, "inverse_dynamics[0]", tau1_printed)
    print(f"tau1 as printed: largest relative error {slip.max_error:.2g}")
    print(kl.compare(robot, "coriolis_matrix", coriolis))
    slip = kl.compare(robot, "coriolis_matrix", coriolis_printed)
    print(f"C as printed: largest relative error {slip.max_error:.2g}")
    print("\nAction of a fall, varied by eps sin(pi t / T): the change over eps² stays the same")
    for eps, change in action_changes():
        print(f"  eps {eps:5}: S changes by {change: .3e} J s, over eps² {change / eps**2:.4f}")


if __name__ == "__main__":
    main()
