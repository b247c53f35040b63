"""Kernels of a serial chain's dynamics on plain arrays: M, Christoffel's C and V of many states.

Importing this module imports numba. The arrays are those of
:class:`kinlab.fast.arrays.InertialChain`. Everything is expressed in the base's axes; a body's
moments are taken about the origin of its joint, so that a light hand far out keeps its digits.

A composite body (link i and all behind it) is its mass m, first moment h and second moment
E = Σ m r r^T; its rotational inertia is tr(E) 1 - E. Sources: composite bodies, Featherstone,
*Rigid Body Dynamics Algorithms* (2008), chapter 6; Christoffel's matrix, Echeandia and Wensing,
"Numerical methods to compute the Coriolis matrix and Christoffel symbols for rigid-body systems",
J. Comput. Nonlinear Dyn. 16 (2021). With moments their 6 x 6 matrix B reduces to a vector
P = Σ m c' and a matrix K: the force of B on a twist (u, w) is (-P x w, K w).
"""

from __future__ import annotations

import math

import numpy as np

from kinlab.fast.compiled import kernel


@kernel
def _cross(a, b, out):  # type: ignore[no-untyped-def]
    out[0] = a[1] * b[2] - a[2] * b[1]
    out[1] = a[2] * b[0] - a[0] * b[2]
    out[2] = a[0] * b[1] - a[1] * b[0]


@kernel
def _dot(a, b):  # type: ignore[no-untyped-def]
    return a[0] * b[0] + a[1] * b[1] + a[2] * b[2]


@kernel
def place(fixed, prismatic, q, turn, origin):  # type: ignore[no-untyped-def]
    """Joint frames in the base: turn (n, 3, 3) and origin (n, 3), written."""
    for i in range(prismatic.shape[0]):
        c, s = 1.0, 0.0
        if not prismatic[i]:
            c, s = math.cos(q[i]), math.sin(q[i])
        for r in range(3):
            f0, f1, f2 = fixed[i, r], fixed[i, 4 + r], fixed[i, 8 + r]  # column r of [R | p]
            for k in range(3):
                if i == 0:
                    turn[0, k, r] = fixed[0, 4 * k + r]
                else:
                    last = turn[i - 1]
                    turn[i, k, r] = last[k, 0] * f0 + last[k, 1] * f1 + last[k, 2] * f2
        for k in range(3):
            if i == 0:
                origin[0, k] = fixed[0, 4 * k + 3]
            else:
                last = turn[i - 1]
                origin[i, k] = (
                    origin[i - 1, k]
                    + last[k, 0] * fixed[i, 3]
                    + last[k, 1] * fixed[i, 7]
                    + last[k, 2] * fixed[i, 11]
                )
            if prismatic[i]:
                origin[i, k] += turn[i, k, 2] * q[i]
            x, y = turn[i, k, 0], turn[i, k, 1]
            turn[i, k, 0], turn[i, k, 1] = c * x + s * y, c * y - s * x


@kernel
def _steps(turn, origin, axis, step):  # type: ignore[no-untyped-def]
    """Each joint's axis, and the way to its origin from the one before: (n, 3), written."""
    for i in range(turn.shape[0]):
        for a in range(3):
            axis[i, a] = turn[i, a, 2]
            if i > 0:
                step[i, a] = origin[i, a] - origin[i - 1, a]


@kernel
def _link(mass, com, second, turn, i, lever, spread):  # type: ignore[no-untyped-def]
    """Link i in the base's axes: centre of mass and second moment about it, written."""
    r = turn[i]
    for a in range(3):
        lever[a] = r[a, 0] * com[i, 0] + r[a, 1] * com[i, 1] + r[a, 2] * com[i, 2]
    for a in range(3):
        for b in range(a + 1):
            total = 0.0
            for k in range(3):
                total += r[a, k] * (
                    second[i, k, 0] * r[b, 0]
                    + second[i, k, 1] * r[b, 1]
                    + second[i, k, 2] * r[b, 2]
                )
            spread[a, b] = total
            spread[b, a] = total


@kernel
def _momentum(m, h, e, u, w, force, moment):  # type: ignore[no-untyped-def]
    """Momentum of a composite body that moves with the twist (u, w): force and moment, written."""
    trace = e[0, 0] + e[1, 1] + e[2, 2]
    _cross(w, h, force)
    _cross(h, u, moment)
    for a in range(3):
        force[a] += m * u[a]
        moment[a] += trace * w[a] - _dot(e[a], w)


@kernel
def _shift(m, h, e, d):  # type: ignore[no-untyped-def]
    """Moves the reference point of a composite body by -d."""
    for a in range(3):
        for b in range(3):
            e[a, b] += h[a] * d[b] + d[a] * h[b] + m * d[a] * d[b]
    for a in range(3):
        h[a] += m * d[a]


@kernel
def _screw(prismatic, turn, i, u, w):  # type: ignore[no-untyped-def]
    """Twist of joint i per unit rate about its own origin: u, w written."""
    for a in range(3):
        z = turn[i, a, 2]
        u[a] = z if prismatic[i] else 0.0
        w[a] = 0.0 if prismatic[i] else z


@kernel
def mass_matrix_rows(fixed, prismatic, mass, com, second, armature, q, out, first, last):  # type: ignore[no-untyped-def]
    """M of rows first to last - 1: q (N, n), out (N, n, n) written."""
    n = prismatic.shape[0]
    turn, origin = np.empty((n, 3, 3)), np.empty((n, 3))
    lever, spread = np.empty(3), np.empty((3, 3))
    axis, step = np.empty((n, 3)), np.zeros((n, 3))
    h, e = np.empty(3), np.empty((3, 3))
    u, w, force, moment = np.empty(3), np.empty(3), np.empty(3), np.empty(3)
    for row in range(first, last):
        place(fixed, prismatic, q[row], turn, origin)
        _steps(turn, origin, axis, step)
        m = 0.0
        h[:] = 0.0
        e[:] = 0.0
        for i in range(n - 1, -1, -1):
            if i < n - 1:
                _shift(m, h, e, step[i + 1])
            _link(mass, com, second, turn, i, lever, spread)
            m += mass[i]
            for a in range(3):
                h[a] += mass[i] * lever[a]
                for b in range(3):
                    e[a, b] += spread[a, b] + mass[i] * lever[a] * lever[b]
            _screw(prismatic, turn, i, u, w)
            _momentum(m, h, e, u, w, force, moment)
            out[row, i, i] = _dot(u, force) + _dot(w, moment) + armature[i]
            fx, fy, fz = force[0], force[1], force[2]
            nx, ny, nz = moment[0], moment[1], moment[2]
            for j in range(i - 1, -1, -1):  # numbers, not arrays: this loop is the whole cost
                dx, dy, dz = step[j + 1, 0], step[j + 1, 1], step[j + 1, 2]
                nx += dy * fz - dz * fy
                ny += dz * fx - dx * fz
                nz += dx * fy - dy * fx
                if prismatic[j]:
                    value = axis[j, 0] * fx + axis[j, 1] * fy + axis[j, 2] * fz
                else:
                    value = axis[j, 0] * nx + axis[j, 1] * ny + axis[j, 2] * nz
                out[row, i, j] = value
                out[row, j, i] = value


@kernel
def coriolis_rows(fixed, prismatic, mass, com, second, q, v, out, first, last):  # type: ignore[no-untyped-def]
    """Christoffel's C of rows first to last - 1: q, v (N, n), out (N, n, n) written."""
    n = prismatic.shape[0]
    turn, origin = np.empty((n, 3, 3)), np.empty((n, 3))
    axis, step = np.empty((n, 3)), np.zeros((n, 3))
    rate, spin = np.empty((n, 3)), np.empty((n, 3))
    su, sw, tu, tw = np.empty((n, 3)), np.empty((n, 3)), np.empty((n, 3)), np.empty((n, 3))
    lever, spread, c_rate = np.empty(3), np.empty((3, 3)), np.empty(3)
    h, e, arm = np.empty(3), np.empty((3, 3)), np.empty(3)
    p, k = np.empty(3), np.empty((3, 3))
    f1, n1, f2, n2, n3 = np.empty(3), np.empty(3), np.empty(3), np.empty(3), np.empty(3)
    for row in range(first, last):
        place(fixed, prismatic, q[row], turn, origin)
        _steps(turn, origin, axis, step)
        for i in range(n):
            _screw(prismatic, turn, i, su[i], sw[i])
            if i == 0:
                rate[0] = 0.0
                spin[0] = 0.0
            else:
                _cross(spin[i - 1], step[i], arm)
                for a in range(3):
                    rate[i, a] = rate[i - 1, a] + arm[a]
                    spin[i, a] = spin[i - 1, a]
            for a in range(3):
                rate[i, a] += su[i, a] * v[row, i]
                spin[i, a] += sw[i, a] * v[row, i]
            # the screw's own rate of change: (rate, spin) x (su, sw)
            _cross(spin[i], su[i], tu[i])
            _cross(rate[i], sw[i], arm)
            _cross(spin[i], sw[i], tw[i])
            for a in range(3):
                tu[i, a] += arm[a]
        m = 0.0
        h[:] = 0.0
        e[:] = 0.0
        p[:] = 0.0
        k[:] = 0.0
        for j in range(n - 1, -1, -1):
            if j < n - 1:
                _shift(m, h, e, step[j + 1])
                along = _dot(step[j + 1], p)
                for a in range(3):
                    for b in range(3):
                        k[a, b] -= p[a] * step[j + 1, b]
                    k[a, a] += along
            _link(mass, com, second, turn, j, lever, spread)
            m += mass[j]
            _cross(spin[j], lever, c_rate)
            for a in range(3):
                c_rate[a] += rate[j, a]
            along = _dot(lever, c_rate)
            for b in range(3):
                _cross(spin[j], spread[b], arm)  # spread is symmetric: its rows are its columns
                h[b] += mass[j] * lever[b]
                p[b] += mass[j] * c_rate[b]
                for a in range(3):
                    e[a, b] += spread[a, b] + mass[j] * lever[a] * lever[b]
                    k[a, b] -= mass[j] * c_rate[a] * lever[b] + arm[a]
                k[b, b] += mass[j] * along
            _momentum(m, h, e, tu[j], tw[j], f1, n1)
            _momentum(m, h, e, su[j], sw[j], f2, n2)
            _cross(p, sw[j], arm)
            _cross(p, su[j], n3)
            for a in range(3):
                f1[a] -= arm[a]
                n1[a] += _dot(k[a], sw[j])
                n3[a] += k[0, a] * sw[j, 0] + k[1, a] * sw[j, 1] + k[2, a] * sw[j, 2]
            out[row, j, j] = _dot(su[j], f1) + _dot(sw[j], n1)
            fx, fy, fz, nx, ny, nz = f1[0], f1[1], f1[2], n1[0], n1[1], n1[2]
            gx, gy, gz, kx, ky, kz = f2[0], f2[1], f2[2], n2[0], n2[1], n2[2]
            for i in range(j - 1, -1, -1):
                dx, dy, dz = step[i + 1, 0], step[i + 1, 1], step[i + 1, 2]
                nx += dy * fz - dz * fy
                ny += dz * fx - dx * fz
                nz += dx * fy - dy * fx
                kx += dy * gz - dz * gy
                ky += dz * gx - dx * gz
                kz += dx * gy - dy * gx
                zx, zy, zz = axis[i, 0], axis[i, 1], axis[i, 2]
                below = tu[i, 0] * gx + tu[i, 1] * gy + tu[i, 2] * gz
                below += tw[i, 0] * kx + tw[i, 1] * ky + tw[i, 2] * kz
                if prismatic[i]:
                    out[row, i, j] = zx * fx + zy * fy + zz * fz
                else:
                    out[row, i, j] = zx * nx + zy * ny + zz * nz
                    below += zx * n3[0] + zy * n3[1] + zz * n3[2]
                out[row, j, i] = below


@kernel
def potential_rows(fixed, prismatic, mass, com, gravity, q, out, first, last):  # type: ignore[no-untyped-def]
    """V = -Σ m g^T p_C of rows first to last - 1: q (N, n), out (N,) written."""
    n = prismatic.shape[0]
    turn, origin = np.empty((n, 3, 3)), np.empty((n, 3))
    for row in range(first, last):
        place(fixed, prismatic, q[row], turn, origin)
        total = 0.0
        for i in range(n):
            for a in range(3):
                total -= mass[i] * gravity[a] * (origin[i, a] + _dot(turn[i, a], com[i]))
        out[row] = total
