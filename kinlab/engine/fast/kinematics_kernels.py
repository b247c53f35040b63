"""Kernels of a serial chain on plain arrays: pose, Jacobian, singular values; one or many.

Importing this module imports numba. A chain is two arrays
(:func:`kinlab.engine.fast.arrays.chain`):

- ``fixed`` (k + 1, 12): for each joint the fixed transform in front of it, rows of [R | p], and
  last the tool's. Every joint turns about or slides along the z axis of its own frame.
- ``prismatic`` (k,): True where the joint slides.

``q`` may be longer than k: joints behind the tool do not move it, and their columns are zero.
"""

from __future__ import annotations

import math

import numpy as np

from kinlab.engine.fast.compiled import kernel

_SWEEPS = 30
"""Jacobi sweeps at most; 6 x n matrices of arms converge in 4 to 8."""

_ORTHOGONAL = 1e-15
"""Cosine between two columns below which Jacobi takes them as orthogonal."""


@kernel
def put(values, out):  # type: ignore[no-untyped-def]
    """Copies (n,) into ``out``, (n,).

    ``out[:] = values`` does so, too, and brings numba's words for shapes that differ into the
    machine code of whoever calls: strings, which take longer to compile than the arithmetic.
    """
    for i in range(out.shape[0]):
        out[i] = values[i]


@kernel
def frames(fixed, prismatic, q, axes, pose):  # type: ignore[no-untyped-def]
    """Joint axes and tool pose.

    Args:
        fixed, prismatic: the chain.
        q: (n,), real or complex; the arrays written are then complex too.
        axes: (k, 6), written: z axis of each joint and the origin of its frame, in the base.
        pose: (12,), written: the tool's [R | p] row by row.
    """
    # [a | x y z]: the frame reached so far in the base; [b | bx by bz]: the fixed step of joint i;
    # c = a b. Then the joint: c Rot(z, q), which leaves column 2, or a shift of q along column 2.
    # Numbers, not arrays, so that they stay in registers: this loop is the whole cost.
    a00, a01, a02, a10, a11, a12, a20, a21, a22 = 1.0, 0.0, 0.0, 0.0, 1.0, 0.0, 0.0, 0.0, 1.0
    x, y, z = 0.0, 0.0, 0.0
    k = prismatic.shape[0]
    for i in range(k + 1):
        b00, b01, b02, bx = fixed[i, 0], fixed[i, 1], fixed[i, 2], fixed[i, 3]
        b10, b11, b12, by = fixed[i, 4], fixed[i, 5], fixed[i, 6], fixed[i, 7]
        b20, b21, b22, bz = fixed[i, 8], fixed[i, 9], fixed[i, 10], fixed[i, 11]
        x += a00 * bx + a01 * by + a02 * bz
        y += a10 * bx + a11 * by + a12 * bz
        z += a20 * bx + a21 * by + a22 * bz
        c00 = a00 * b00 + a01 * b10 + a02 * b20
        c01 = a00 * b01 + a01 * b11 + a02 * b21
        c02 = a00 * b02 + a01 * b12 + a02 * b22
        c10 = a10 * b00 + a11 * b10 + a12 * b20
        c11 = a10 * b01 + a11 * b11 + a12 * b21
        c12 = a10 * b02 + a11 * b12 + a12 * b22
        c20 = a20 * b00 + a21 * b10 + a22 * b20
        c21 = a20 * b01 + a21 * b11 + a22 * b21
        c22 = a20 * b02 + a21 * b12 + a22 * b22
        if i == k:
            pose[0], pose[1], pose[2], pose[3] = c00, c01, c02, x
            pose[4], pose[5], pose[6], pose[7] = c10, c11, c12, y
            pose[8], pose[9], pose[10], pose[11] = c20, c21, c22, z
            return
        axes[i, 0], axes[i, 1], axes[i, 2] = c02, c12, c22
        a02, a12, a22 = c02, c12, c22
        if prismatic[i]:
            x += c02 * q[i]
            y += c12 * q[i]
            z += c22 * q[i]
            a00, a01, a10, a11, a20, a21 = c00, c01, c10, c11, c20, c21
        else:
            c, s = np.cos(q[i]), np.sin(q[i])
            a00, a01 = c00 * c + c01 * s, c01 * c - c00 * s
            a10, a11 = c10 * c + c11 * s, c11 * c - c10 * s
            a20, a21 = c20 * c + c21 * s, c21 * c - c20 * s
        axes[i, 3], axes[i, 4], axes[i, 5] = x, y, z


@kernel
def columns(prismatic, axes, pose, jac):  # type: ignore[no-untyped-def]
    """Jacobian in the base's axes at the tool origin, from the answers of :func:`frames`.

    Args:
        prismatic: (k,).
        axes: (k, 6). pose: (12,).
        jac: (6, n), n >= k; its first k columns are written.
    """
    for i in range(prismatic.shape[0]):
        zx, zy, zz = axes[i, 0], axes[i, 1], axes[i, 2]
        if prismatic[i]:
            jac[0, i], jac[1, i], jac[2, i] = zx, zy, zz
            jac[3, i], jac[4, i], jac[5, i] = 0.0, 0.0, 0.0
        else:
            rx, ry, rz = pose[3] - axes[i, 3], pose[7] - axes[i, 4], pose[11] - axes[i, 5]
            jac[0, i] = zy * rz - zz * ry
            jac[1, i] = zz * rx - zx * rz
            jac[2, i] = zx * ry - zy * rx
            jac[3, i], jac[4, i], jac[5, i] = zx, zy, zz


@kernel
def singular_values(matrix, work, out):  # type: ignore[no-untyped-def]
    """Singular values, largest first, by one-sided Jacobi rotations (Hestenes 1958).

    Each value is accurate relative to itself where the columns' scaling allows, which values by
    way of J J^T are not (Demmel and Veselic 1992).

    Args:
        matrix: (m, n).
        work: (min(m, n), max(m, n)), overwritten.
        out: (min(m, n),), written.
    """
    m, n = matrix.shape
    short, long = min(m, n), max(m, n)
    for i in range(short):
        for j in range(long):
            work[i, j] = matrix[i, j] if m <= n else matrix[j, i]
    for _ in range(_SWEEPS):
        turned = False
        for i in range(short - 1):
            for j in range(i + 1, short):
                aa, bb, ab = 0.0, 0.0, 0.0
                for c in range(long):
                    aa += work[i, c] * work[i, c]
                    bb += work[j, c] * work[j, c]
                    ab += work[i, c] * work[j, c]
                if abs(ab) <= _ORTHOGONAL * math.sqrt(aa * bb) or ab == 0.0:
                    continue
                turned = True
                zeta = (bb - aa) / (2.0 * ab)
                t = math.copysign(1.0, zeta) / (abs(zeta) + math.hypot(1.0, zeta))
                c0 = 1.0 / math.sqrt(1.0 + t * t)
                s0 = c0 * t
                for c in range(long):
                    first, second = work[i, c], work[j, c]
                    work[i, c] = c0 * first - s0 * second
                    work[j, c] = s0 * first + c0 * second
        if not turned:
            break
    for i in range(short):
        square = 0.0
        for c in range(long):
            square += work[i, c] * work[i, c]
        value = math.sqrt(square)
        k = i
        while k > 0 and out[k - 1] < value:
            out[k] = out[k - 1]
            k -= 1
        out[k] = value


@kernel
def fk_rows(fixed, prismatic, q, out, first, last):  # type: ignore[no-untyped-def]
    """Tool poses of rows first to last - 1: q (N, n), out (N, 4, 4) written."""
    axes = np.empty((prismatic.shape[0], 6))
    pose = np.empty(12)
    for row in range(first, last):
        frames(fixed, prismatic, q[row], axes, pose)
        for i in range(3):
            for j in range(4):
                out[row, i, j] = pose[4 * i + j]
            out[row, 3, i] = 0.0
        out[row, 3, 3] = 1.0


@kernel
def jacobian_rows(fixed, prismatic, q, out, first, last):  # type: ignore[no-untyped-def]
    """Jacobians in the base's axes of rows first to last - 1: q (N, n), out (N, 6, n) written."""
    axes = np.empty((prismatic.shape[0], 6))
    pose = np.empty(12)
    for row in range(first, last):
        frames(fixed, prismatic, q[row], axes, pose)
        out[row, :, prismatic.shape[0] :] = 0.0
        columns(prismatic, axes, pose, out[row])


@kernel
def singular_value_rows(fixed, prismatic, q, task, out, first, last):  # type: ignore[no-untyped-def]
    """Singular values of the task's rows of J.

    Args:
        fixed, prismatic: the chain.
        q: (N, n).
        task: (r,), row indices into J.
        out: (N, min(r, n)), written, largest first.
        first, last: the range of rows.
    """
    n, r = q.shape[1], task.shape[0]
    axes = np.empty((prismatic.shape[0], 6))
    pose = np.empty(12)
    jac = np.zeros((6, n))
    part = np.empty((r, n))
    work = np.empty((min(r, n), max(r, n)))
    for row in range(first, last):
        frames(fixed, prismatic, q[row], axes, pose)
        columns(prismatic, axes, pose, jac)
        for i in range(r):
            put(jac[task[i]], part[i])
        singular_values(part, work, out[row])
