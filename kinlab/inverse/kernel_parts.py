"""What one step of the compiled search is made of: errors, normal equations, limits.

Importing this module imports numba.
"""

from __future__ import annotations

import math

from kinlab.compiled import kernel


@kernel
def rotation_vector(r, e):  # type: ignore[no-untyped-def]
    """Logarithm of a rotation, angle times axis; well defined up to and at half a turn.

    Args:
        r: (9,), the rotation row by row.
        e: (3,), written; norm at most pi.
    """
    x, y, z = 0.5 * (r[7] - r[5]), 0.5 * (r[2] - r[6]), 0.5 * (r[3] - r[1])
    c = 0.5 * (r[0] + r[4] + r[8] - 1.0)
    s = math.sqrt(x * x + y * y + z * z)
    scale = 1.0
    if s > 1e-6:
        scale = math.atan2(s, c) / s
    elif c < 0.0:  # at half a turn the axis is in the symmetric part: R = 2 u u^T - 1
        scale = math.pi
        if r[0] >= r[4] and r[0] >= r[8]:
            x = math.sqrt(0.5 * (r[0] + 1.0))
            y, z = 0.25 * (r[1] + r[3]) / x, 0.25 * (r[2] + r[6]) / x
        elif r[4] >= r[8]:
            y = math.sqrt(0.5 * (r[4] + 1.0))
            x, z = 0.25 * (r[1] + r[3]) / y, 0.25 * (r[5] + r[7]) / y
        else:
            z = math.sqrt(0.5 * (r[8] + 1.0))
            x, y = 0.25 * (r[2] + r[6]) / z, 0.25 * (r[5] + r[7]) / z
    e[0], e[1], e[2] = scale * x, scale * y, scale * z


@kernel
def pose_error(pose, target, r, e):  # type: ignore[no-untyped-def]
    """Twist-like error (p_d - p, log(R_d R^T)) in the base's axes.

    Args:
        pose, target: (12,), rows of [R | p].
        r: (9,), overwritten.
        e: (6,), written.
    """
    for i in range(3):
        e[i] = target[4 * i + 3] - pose[4 * i + 3]
        for j in range(3):
            r[3 * i + j] = (
                target[4 * i] * pose[4 * j]
                + target[4 * i + 1] * pose[4 * j + 1]
                + target[4 * i + 2] * pose[4 * j + 2]
            )
    rotation_vector(r, e[3:])


@kernel
def turn_rows(jac, e, n):  # type: ignore[no-untyped-def]
    """Turns the angular rows of J into the derivative of the rotation vector.

    -d/dt log(R_d R^T) = Jr^-1(phi) omega. Where all three angles are asked for, Jr^-1 leaves phi
    itself unchanged and may be left out; where some are free, the rows must be the true ones.

    Args:
        jac: (6, n), rows 3 to 5 overwritten.
        e: (6,), the error; phi = e[3:].
        n: columns.
    """
    x, y, z = e[3], e[4], e[5]
    square = x * x + y * y + z * z
    angle = math.sqrt(square)
    if angle < 1e-4:
        factor = 1.0 / 12.0
    else:
        factor = 1.0 / square - (1.0 + math.cos(angle)) / (2.0 * angle * math.sin(angle))
    for i in range(n):
        a, b, c = jac[3, i], jac[4, i], jac[5, i]
        dot = x * a + y * b + z * c
        jac[3, i] = a + 0.5 * (y * c - z * b) + factor * (x * dot - square * a)
        jac[4, i] = b + 0.5 * (z * a - x * c) + factor * (y * dot - square * b)
        jac[5, i] = c + 0.5 * (x * b - y * a) + factor * (z * dot - square * c)


@kernel
def cholesky_solve(a, x, n):  # type: ignore[no-untyped-def]
    """Solves a x = b for a symmetric positive definite matrix.

    Args:
        a: (n, n), lower triangle; overwritten.
        x: (n,), b on entry, the solution on exit.
        n: size.
    """
    for j in range(n):
        d = a[j, j]
        for k in range(j):
            d -= a[j, k] * a[j, k]
        d = 1.0 / math.sqrt(d)
        a[j, j] = d
        for i in range(j + 1, n):
            v = a[i, j]
            for k in range(j):
                v -= a[i, k] * a[j, k]
            a[i, j] = v * d
    for i in range(n):
        v = x[i]
        for k in range(i):
            v -= a[i, k] * x[k]
        x[i] = v * a[i, i]
    for i in range(n - 1, -1, -1):
        v = x[i]
        for k in range(i + 1, n):
            v -= a[k, i] * x[k]
        x[i] = v * a[i, i]


@kernel
def normal_equations(jac, e, weight, q, lower, upper, free, a, g):  # type: ignore[no-untyped-def]
    """J^T W J and J^T W e, with the joints held that stand at a limit and would leave it.

    Args:
        jac: (6, n). e, weight: (6,). q, lower, upper: (n,). free: (n,), joints without limits.
        a: (n, n), lower triangle written. g: (n,), written.
    """
    n = g.shape[0]
    for i in range(n):
        slope = 0.0
        for c in range(6):
            slope += weight[c] * jac[c, i] * e[c]
        g[i] = slope
        for j in range(i + 1):
            h = 0.0
            for c in range(6):
                h += weight[c] * jac[c, i] * jac[c, j]
            a[i, j] = h
    for i in range(n):
        if not free[i] and ((q[i] >= upper[i] and g[i] > 0.0) or (q[i] <= lower[i] and g[i] < 0.0)):
            a[i, :i] = 0.0
            a[i + 1 :, i] = 0.0
            a[i, i] = 1.0
            g[i] = 0.0


@kernel
def half_square(weight, e):  # type: ignore[no-untyped-def]
    """E = e^T W e / 2."""
    energy = 0.0
    for i in range(6):
        energy += 0.5 * weight[i] * e[i] * e[i]
    return energy


@kernel
def some_angles(weight):  # type: ignore[no-untyped-def]
    """Whether some but not all of the three angles are asked for."""
    asked = 0
    for i in range(3, 6):
        asked += weight[i] > 0.0
    return 0 < asked < 3


@kernel
def wrap(prismatic, lower, upper, centre, q):  # type: ignore[no-untyped-def]
    """Turns angles by whole turns into their limits, as near to ``centre`` as that allows.

    Args:
        prismatic: (k,). lower, upper, centre: (n,); centre within the limits.
        q: (n,), changed in place.

    Returns:
        True where every entry is within its limits.
    """
    inside = True
    turn = 2.0 * math.pi
    for i in range(q.shape[0]):
        if i < prismatic.shape[0] and not prismatic[i]:
            q[i] -= turn * math.floor((q[i] - centre[i]) / turn + 0.5)
            if q[i] > upper[i] and q[i] - turn >= lower[i]:
                q[i] -= turn
            elif q[i] < lower[i] and q[i] + turn <= upper[i]:
                q[i] += turn
        inside = inside and lower[i] <= q[i] <= upper[i]
    return inside


@kernel
def nearest(table, target, weight, distance):  # type: ignore[no-untyped-def]
    """Distance of every pose of the table to the target, squared and weighted.

    Args:
        table: (12, S), poses.
        target: (12,).
        weight: (6,), of the squared error; the orientation counts where all of it is asked for.
        distance: (S,), written.
    """
    distance[:] = 0.0
    turned = weight[3] * weight[4] * weight[5] > 0.0
    for i in range(3):
        if weight[i] > 0.0:
            for s in range(distance.shape[0]):
                d = table[4 * i + 3, s] - target[4 * i + 3]
                distance[s] += weight[i] * d * d
        if turned:
            for j in range(4 * i, 4 * i + 3):
                for s in range(distance.shape[0]):
                    # half of 3 - trace(R^T R_d) = 1 - cos(angle), about half the angle squared
                    distance[s] -= 0.5 * table[j, s] * target[j]
