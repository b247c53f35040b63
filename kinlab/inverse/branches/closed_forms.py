"""Closed forms of arms by the structure of their axes; compiled, one pose at a time.

Frames are those of the chain, in which every joint turns about or slides along its own z, so
that standard DH, modified DH and URDF arms are one case: T = F1 M1 F2 M2 ... Fn Mn Ftool.

- :func:`place_point`: three joints (the third may slide) that carry a point (Pieper 1968; Craig,
  section 4.6): the position of a spherical wrist's centre, or the tool of a 3R arm.
- :func:`spherical_wrist`: that and three intersecting axes behind it.
- :func:`three_parallel`: axes 2, 3 and 4 parallel, the rest anything (Elias and Wen, "IK-Geo",
  2022, family "three parallel"): the UR arms.
- :func:`in_the_plane`: two or three parallel revolute joints, and perhaps one slide along them.

An arm turned end for end is the same kind of arm: :func:`reversed_chain` serves axes 1 to 3
meeting in a point and axes 3 to 5 parallel.

Every function writes candidates; forward kinematics decides which are solutions.
"""

from __future__ import annotations

import math

import numpy as np

from kinlab.engine.fast.compiled import kernel
from kinlab.engine.fast.kinematics_kernels import put
from kinlab.inverse.branches.equations import (
    add_square,
    circle_pair,
    half_angle,
    joint_roots,
    linear_trig,
)

PARALLEL = 1e-9
"""sin of the angle between two axes below which they are parallel."""

MEETS = 1e-9
"""Metres between lines that intersect."""

FREE_WRIST, FREE_SHOULDER, FREE_ELBOW = 1, 2, 4
"""Flags of a pose with infinitely many solutions: joints 4 and 6 in line (or, with three parallel
axes, joint 6 along them); the point on axis 1; a position that joint 2 or 3 does not change."""

_ON_AXIS = 1e-10
"""Metres from axis 1, or sine from alignment, at which a joint counts as free."""


@kernel
def times(a, b, out):  # type: ignore[no-untyped-def]
    """Product of two transforms, rows of [R | p], (12,) each."""
    for i in range(3):
        for j in range(4):
            value = a[4 * i] * b[j] + a[4 * i + 1] * b[4 + j] + a[4 * i + 2] * b[8 + j]
            out[4 * i + j] = value + a[4 * i + 3] if j == 3 else value


@kernel
def turn_about_z(goal, here):  # type: ignore[no-untyped-def]
    """Angle that brings ``here`` nearest to ``goal``, (12,): tr(G^T Rz(angle) H) is largest."""
    x, y, z, gx, gy, gz = here[0], here[1], here[2], goal[0], goal[1], goal[2]
    s = goal[4] * x + goal[5] * y + goal[6] * z - gx * here[4] - gy * here[5] - gz * here[6]
    c = gx * x + gy * y + gz * z + goal[4] * here[4] + goal[5] * here[5] + goal[6] * here[6]
    return math.atan2(s, c)


@kernel
def inverse(a, out):  # type: ignore[no-untyped-def]
    """Inverse of a rigid transform, (12,); out must be another array."""
    for i in range(3):
        for j in range(3):
            out[4 * i + j] = a[4 * j + i]
        out[4 * i + 3] = -(a[i] * a[3] + a[4 + i] * a[7] + a[8 + i] * a[11])


@kernel
def move(a, value, slides, out):  # type: ignore[no-untyped-def]
    """a M(value): behind a, a turn about z or a slide along it."""
    put(a, out)
    if slides:
        for i in range(3):
            out[4 * i + 3] += value * a[4 * i + 2]
    else:
        c, s = math.cos(value), math.sin(value)
        for i in range(3):
            x, y = a[4 * i], a[4 * i + 1]
            out[4 * i], out[4 * i + 1] = x * c + y * s, y * c - x * s


@kernel
def back(a, value, slides, out):  # type: ignore[no-untyped-def]
    """M(value)^-1 a; out may be a itself."""
    put(a, out)
    if slides:
        out[11] -= value
    else:
        c, s = math.cos(value), math.sin(value)
        for j in range(4):
            x, y = a[j], a[4 + j]
            out[j], out[4 + j] = x * c + y * s, y * c - x * s


@kernel
def place_point(fixed, slides, centre, goal, out):  # type: ignore[no-untyped-def]
    """(q1, q2, q3) that bring a point behind joint 3 to a goal.

    Seen from joint 1's frame, w = F2 Rz(q2) h(q3), h(q3) = F3 M3(q3) c. The height of w along
    axis 1 and its distance from the foot of the common normal of axes 1 and 2 do not depend on
    q1. With m the x-y part of Rz(q2) h, both are linear in m: a.m = C1(q3), b.m = C2(q3), and
    |m|^2 = H(q3):

    - axes 1 and 2 parallel, a = 0: C1(q3) = 0, then b.m = C2 gives q2;
    - axes 1 and 2 intersect, b = 0: C2(q3) = 0, then a.m = C1 gives q2;
    - otherwise |M^-1 (C1, C2)|^2 = H(q3), Pieper's quartic; q2 from m.

    Args:
        fixed: (>= 3, 12), the chain. slides: whether joint 3 does; joints 1 and 2 turn.
        centre: (3,), in the frame behind joint 3's motion. goal: (3,), in the base.
        out: (4, 3), written.

    Returns:
        Their number, and flags.
    """
    base = np.empty(12)
    inverse(fixed[0], base)
    px = base[0] * goal[0] + base[1] * goal[1] + base[2] * goal[2] + base[3]
    py = base[4] * goal[0] + base[5] * goal[1] + base[6] * goal[2] + base[7]
    pz = base[8] * goal[0] + base[9] * goal[1] + base[10] * goal[2] + base[11]
    f, g = fixed[1], fixed[2]
    zx, zy, zz = f[2], f[6], f[10]  # axis 2 in joint 1's frame
    sine = math.hypot(zx, zy)
    foot = 0.0
    if sine > PARALLEL:  # (shift x z2) . (z1 x z2) / sine^2
        foot = (-(f[7] * zz - f[11] * zy) * zy + (f[11] * zx - f[3] * zz) * zx) / (sine * sine)
    lx, ly, lz = f[3], f[7], f[11] - foot
    pz -= foot
    a0, a1 = f[8], f[9]
    b0 = 2.0 * (f[0] * lx + f[4] * ly + f[8] * lz)
    b1 = 2.0 * (f[1] * lx + f[5] * ly + f[9] * lz)
    b2 = 2.0 * (f[2] * lx + f[6] * ly + f[10] * lz)
    apart = math.sqrt(
        (ly * zz - lz * zy) ** 2 + (lz * zx - lx * zz) ** 2 + (lx * zy - ly * zx) ** 2
    )
    h, square = np.empty((3, 3)), np.zeros(3)  # h as coefficients of (1, c, s) or (1, x, x^2)
    for i in range(3):
        r0, r1, r2, t = g[4 * i], g[4 * i + 1], g[4 * i + 2], g[4 * i + 3]
        if slides:
            h[i, 0] = t + r0 * centre[0] + r1 * centre[1] + r2 * centre[2]
            h[i, 1], h[i, 2] = r2, 0.0
        else:
            h[i, 0] = t + r2 * centre[2]
            h[i, 1] = r0 * centre[0] + r1 * centre[1]
            h[i, 2] = r1 * centre[0] - r0 * centre[1]
    for i in range(3):
        square[0] += h[i, 0] * h[i, 0]
        square[1] += 2.0 * h[i, 0] * h[i, 1]
        if slides:
            square[2] += h[i, 1] * h[i, 1]
        else:
            square[2] += 2.0 * h[i, 0] * h[i, 2]
    if not slides:
        square[0] += centre[0] * centre[0] + centre[1] * centre[1]
    c1, c2 = np.empty(3), np.empty(3)
    for i in range(3):
        c1[i] = -zz * h[2, i]
        c2[i] = -square[i] - b2 * h[2, i]
    c1[0] += pz - lz
    c2[0] += px * px + py * py + pz * pz - lx * lx - ly * ly - lz * lz
    equation, thirds, pair = np.zeros(5), np.empty(4), np.empty(4)
    count, flags = 0, 0
    general = sine > PARALLEL and apart > MEETS
    m = np.zeros((2, 3))
    if general:
        det = a0 * b1 - a1 * b0
        for i in range(3):
            m[0, i] = (b1 * c1[i] - a1 * c2[i]) / det
            m[1, i] = (a0 * c2[i] - b0 * c1[i]) / det
            equation[i] = -square[i]
        add_square(equation, m[0, 0], m[0, 1], m[0, 2], 1.0, slides)
        add_square(equation, m[1, 0], m[1, 1], m[1, 2], 1.0, slides)
        add_square(equation, h[2, 0], h[2, 1], h[2, 2], 1.0, slides)
    else:
        for i in range(3):
            equation[i] = c1[i] if sine <= PARALLEL else c2[i]
    number = joint_roots(equation, slides, thirds)
    if number < 0:
        return 0, FREE_ELBOW
    for i in range(number):
        q3 = thirds[i]
        u = q3 if slides else math.cos(q3)
        v = q3 * q3 if slides else math.sin(q3)
        hx = h[0, 0] + h[0, 1] * u + h[0, 2] * v
        hy = h[1, 0] + h[1, 1] * u + h[1, 2] * v
        hz = h[2, 0] + h[2, 1] * u + h[2, 2] * v
        seconds = 1
        if general:
            mx = m[0, 0] + m[0, 1] * u + m[0, 2] * v
            my = m[1, 0] + m[1, 1] * u + m[1, 2] * v
            pair[0] = math.atan2(my, mx) - math.atan2(hy, hx)
            if hx * hx + hy * hy < _ON_AXIS * _ON_AXIS:
                flags |= FREE_ELBOW
        else:
            r0, r1, right = a0, a1, c1[0] + c1[1] * u + c1[2] * v
            if sine <= PARALLEL:
                r0, r1, right = b0, b1, c2[0] + c2[1] * u + c2[2] * v
            cosine, turned = r0 * hx + r1 * hy, r1 * hx - r0 * hy
            if math.hypot(cosine, turned) < _ON_AXIS and abs(right) < _ON_AXIS:
                flags |= FREE_ELBOW  # every q2 would do
                seconds = 1
                pair[0] = 0.0
            else:
                seconds = linear_trig(cosine, turned, right, pair)
        for j in range(seconds):
            if count == 4:
                break
            q2 = pair[j]
            c, s = math.cos(q2), math.sin(q2)
            wx, wy = c * hx - s * hy, s * hx + c * hy
            ox = f[3] + f[0] * wx + f[1] * wy + f[2] * hz
            oy = f[7] + f[4] * wx + f[5] * wy + f[6] * hz
            out[count, 1], out[count, 2] = q2, q3
            if math.hypot(px, py) < _ON_AXIS:
                flags |= FREE_SHOULDER
                out[count, 0] = 0.0
            else:
                out[count, 0] = math.atan2(py, px) - math.atan2(oy, ox)
            count += 1
    return count, flags


@kernel
def spherical_wrist(fixed, prismatic, centre, centre_tool, target, out):  # type: ignore[no-untyped-def]
    """All q of a six-joint arm whose last three axes meet (joints 1, 2, 4, 5, 6 turn).

    The last entry of Rz(q4) A5 Rz(q5) A6 Rz(q6) = R is linear in cos q5 and sin q5.

    Args:
        fixed, prismatic: the chain.
        centre: (3,), in the frame behind joint 3. centre_tool: (3,), in the tool's frame.
        target: (12,).
        out: (8, 6), written.

    Returns:
        Their number, and flags.
    """
    goal, firsts = np.empty(3), np.empty((4, 3))
    for i in range(3):
        goal[i] = (
            target[4 * i] * centre_tool[0]
            + target[4 * i + 1] * centre_tool[1]
            + target[4 * i + 2] * centre_tool[2]
            + target[4 * i + 3]
        )
    number, flags = place_point(fixed, prismatic[2], centre, goal, firsts)
    one, two, asked = np.empty(12), np.empty(12), np.empty((3, 3))
    pair, turn, tool = np.empty(2), np.empty((3, 3)), fixed[6]
    a5, a6 = fixed[4], fixed[5]
    for i in range(3):  # the target's rotation before the tool's own
        for j in range(3):
            turn[i, j] = (
                target[4 * i] * tool[4 * j]
                + target[4 * i + 1] * tool[4 * j + 1]
                + target[4 * i + 2] * tool[4 * j + 2]
            )
    ux, uy, uz = a5[8], a5[9], a5[10]
    vx, vy, vz = a6[2], a6[6], a6[10]
    cosine, sine = ux * vx + uy * vy, uy * vx - ux * vy
    size, middle = math.hypot(cosine, sine), math.atan2(sine, cosine)
    count = 0
    for k in range(number):
        put(fixed[0], one)
        for joint in range(3):
            move(one, firsts[k, joint], prismatic[joint], two)
            times(two, fixed[joint + 1], one)
        for i in range(3):
            for j in range(3):
                asked[i, j] = (
                    one[i] * turn[0, j] + one[4 + i] * turn[1, j] + one[8 + i] * turn[2, j]
                )
        right = asked[2, 2] - uz * vz
        below, above = size - right, size + right
        flat = asked[0, 2] ** 2 + asked[1, 2] ** 2
        # near alignment without cancellation: 1 - |asked22| = flat / (1 + |asked22|)
        if abs(uz - vz) < 1e-12 and asked[2, 2] > 0.5:
            below = flat / (1.0 + asked[2, 2])
        elif abs(uz + vz) < 1e-12 and asked[2, 2] < -0.5:
            above = flat / (1.0 - asked[2, 2])
        if not half_angle(below, above, pair):
            continue
        half = pair[0]
        aligned = flat < _ON_AXIS * _ON_AXIS
        for turned in range(1 if aligned else 2):
            q5 = middle + half if turned == 0 else middle - half
            c, s = math.cos(q5), math.sin(q5)
            # middle = A5 Rz(q5) A6, its last column and what q6 needs
            tx, ty, tz = c * vx - s * vy, s * vx + c * vy, vz
            mx = a5[0] * tx + a5[1] * ty + a5[2] * tz
            my = a5[4] * tx + a5[5] * ty + a5[6] * tz
            q4 = 0.0
            if aligned:
                flags |= FREE_WRIST
            else:
                q4 = math.atan2(asked[1, 2], asked[0, 2]) - math.atan2(my, mx)
            c4, s4 = math.cos(q4), math.sin(q4)
            xx = xy = yx = yy = 0.0
            for j in range(2):  # first two columns of Rz(q4) A5 Rz(q5) A6, against asked
                wx, wy, wz = a6[j], a6[4 + j], a6[8 + j]
                tx, ty = c * wx - s * wy, s * wx + c * wy
                m0 = a5[0] * tx + a5[1] * ty + a5[2] * wz
                m1 = a5[4] * tx + a5[5] * ty + a5[6] * wz
                m2 = a5[8] * tx + a5[9] * ty + a5[10] * wz
                n0, n1 = c4 * m0 - s4 * m1, s4 * m0 + c4 * m1
                along = n0 * asked[0, 0] + n1 * asked[1, 0] + m2 * asked[2, 0]
                across = n0 * asked[0, 1] + n1 * asked[1, 1] + m2 * asked[2, 1]
                if j == 0:
                    xx, xy = along, across
                else:
                    yx, yy = along, across
            put(firsts[k], out[count, :3])
            out[count, 3], out[count, 4] = q4, q5
            out[count, 5] = math.atan2(yx - xy, xx + yy)
            count += 1
    return count, flags


@kernel
def three_parallel(fixed, target, out):  # type: ignore[no-untyped-def]
    """All q of a six-joint revolute arm with axes 2, 3 and 4 parallel.

    With G = F1^-1 T Ftool^-1, joints 2 to 4 leave heights along axis 2 alone, so that axis 6's
    direction and the height of its point give two equations linear in (cos, sin) of q1 and of
    q5; then q6 from the direction of axis 2, and joints 2 to 4 as a planar arm.

    Args:
        fixed: (7, 12). target: (12,).
        out: (8, 6), written.

    Returns:
        Their number, and flags.
    """
    one, two, g, x = np.empty(12), np.empty(12), np.empty(12), np.empty(12)
    a, b, d = np.empty((2, 2)), np.empty((2, 2)), np.empty(2)
    pairs, q3s, planar = np.empty((4, 2)), np.empty(2), np.empty(12)
    f2, f3, f4, f5, f6 = fixed[1], fixed[2], fixed[3], fixed[4], fixed[5]
    inverse(fixed[0], one)
    times(one, target, two)
    inverse(fixed[6], one)
    times(two, one, g)
    w0, w1, w2 = f2[2], f2[6], f2[10]
    s3 = 1.0 if f3[10] > 0.0 else -1.0
    sign = s3 if f4[10] > 0.0 else -s3
    ux, uy, uz = f5[8], f5[9], f5[10]
    for row in range(2):
        # row 0: direction of axis 6; row 1: its point, the origin of joint 6's frame
        k = 2 if row == 0 else 3
        gx, gy, gz = g[k], g[4 + k], g[8 + k]
        vx, vy, vz = f6[k], f6[4 + k], f6[8 + k]
        a[row, 0], a[row, 1] = w0 * gx + w1 * gy, w0 * gy - w1 * gx
        b[row, 0], b[row, 1] = -sign * (ux * vx + uy * vy), -sign * (uy * vx - ux * vy)
        d[row] = sign * uz * vz - w2 * gz
    d[1] += w0 * f2[3] + w1 * f2[7] + w2 * f2[11] + f3[11] + s3 * f4[11] + sign * f5[11]
    number = circle_pair(a, b, d, pairs)
    if number < 0:
        return 0, FREE_ELBOW
    count, flags = 0, 0
    for k in range(number):
        q1, q5 = pairs[k, 0], pairs[k, 1]
        back(g, q1, False, two)
        inverse(f2, one)
        times(one, two, x)  # F2^-1 M1^-1 G
        c, s = math.cos(q5), math.sin(q5)
        r0 = sign * (f6[0] * (c * ux + s * uy) + f6[4] * (c * uy - s * ux) + f6[8] * uz)
        r1 = sign * (f6[1] * (c * ux + s * uy) + f6[5] * (c * uy - s * ux) + f6[9] * uz)
        q6 = 0.0
        if math.hypot(x[8], x[9]) < _ON_AXIS:
            flags |= FREE_WRIST
        else:
            q6 = math.atan2(r1, r0) - math.atan2(x[9], x[8])
        move(x, -q6, False, two)
        inverse(f6, one)
        times(two, one, x)
        move(x, -q5, False, two)
        inverse(f5, one)
        times(two, one, x)  # M2 F3 M3 F4 M4, a planar motion
        bx, by = f3[0] * f4[3] + f3[1] * f4[7], f3[4] * f4[3] + f3[5] * f4[7]
        cx, cy = f3[1] * f4[3] - f3[0] * f4[7], f3[5] * f4[3] - f3[4] * f4[7]
        far = x[3] * x[3] + x[7] * x[7]
        near = f3[3] ** 2 + f3[7] ** 2 + f4[3] ** 2 + f4[7] ** 2
        along, across = f3[3] * bx + f3[7] * by, f3[3] * cx + f3[7] * cy
        bends = linear_trig(2.0 * along, 2.0 * across, far - near, q3s)
        for j in range(bends):
            q3 = q3s[j]
            c, s = math.cos(q3), math.sin(q3)
            ox, oy = f3[3] + c * bx + s * cx, f3[7] + c * by + s * cy
            q2 = 0.0
            if far < _ON_AXIS * _ON_AXIS:
                flags |= FREE_ELBOW
            else:
                q2 = math.atan2(x[7], x[3]) - math.atan2(oy, ox)
            back(x, q2, False, two)
            inverse(f3, one)
            times(one, two, planar)
            back(planar, q3, False, two)
            inverse(f4, one)
            times(one, two, planar)
            out[count, 0], out[count, 1], out[count, 2] = q1, q2, q3
            out[count, 3] = math.atan2(planar[4] - planar[1], planar[0] + planar[5])
            out[count, 4], out[count, 5] = q5, q6
            count += 1
    return count, flags


@kernel
def in_the_plane(fixed, prismatic, target, whole, out):  # type: ignore[no-untyped-def]
    """All q of an arm with two or three parallel revolute joints, and at most one slide along.

    Args:
        fixed, prismatic: the chain, whose axes are all parallel.
        target: (12,), already moved into the plane (:func:`onto_plane`).
        whole: whether the angle counts (three revolute joints) or the point alone (two).
        out: (2, n), written.

    Returns:
        Their number, and flags.
    """
    n = prismatic.shape[0]
    one, two, g = np.empty(12), np.empty(12), np.empty(12)
    points, signs, turns = np.zeros((4, 2)), np.ones(n), np.empty(3, np.int64)
    inverse(fixed[0], one)
    times(one, target, g)
    # the arm at q = 0, seen along axis 1: where its axes cross the plane
    one[:] = 0.0
    one[0] = one[5] = one[10] = 1.0
    bars, slide, height = 0, -1, 0.0
    for i in range(n):
        if i > 0:
            times(one, fixed[i], two)
            put(two, one)
        signs[i] = 1.0 if one[10] > 0.0 else -1.0
        if prismatic[i]:
            slide = i
        else:
            points[bars, 0], points[bars, 1] = one[3], one[7]
            turns[bars] = i
            bars += 1
    times(one, fixed[n], two)
    height = two[11]
    angle = turn_about_z(g, two)
    # the first revolute axis is where a and the goal are counted from
    gx, gy = g[3] - points[0, 0], g[7] - points[0, 1]
    bx, by = two[3] - points[1, 0], two[7] - points[1, 1]
    if whole:
        c, s = math.cos(angle), math.sin(angle)
        lx, ly = two[3] - points[2, 0], two[7] - points[2, 1]
        gx, gy = gx - (c * lx - s * ly), gy - (s * lx + c * ly)
        bx, by = points[2, 0] - points[1, 0], points[2, 1] - points[1, 1]
    ax, ay = points[1, 0] - points[0, 0], points[1, 1] - points[0, 1]
    far, pair = gx * gx + gy * gy, np.empty(2)
    number = linear_trig(
        2.0 * (ax * bx + ay * by),
        2.0 * (ay * bx - ax * by),
        far - ax * ax - ay * ay - bx * bx - by * by,
        pair,
    )
    flags = FREE_SHOULDER if number and far < _ON_AXIS * _ON_AXIS else 0
    for k in range(number):
        c, s = math.cos(pair[k]), math.sin(pair[k])
        ox, oy = ax + c * bx - s * by, ay + s * bx + c * by
        first = 0.0 if flags else math.atan2(gy, gx) - math.atan2(oy, ox)
        out[k, turns[0]] = signs[turns[0]] * first
        out[k, turns[1]] = signs[turns[1]] * pair[k]
        if whole:
            out[k, turns[2]] = signs[turns[2]] * (angle - first - pair[k])
        if slide >= 0:
            out[k, slide] = signs[slide] * (g[11] - height)
    return number, flags


@kernel
def onto_plane(fixed, height, target, out):  # type: ignore[no-untyped-def]
    """What counts for an arm of parallel axes: the target put upright, the rest being met.

    Args:
        fixed: (n + 1, 12).
        height: whether the height along the axes counts (a slide), or is the arm's own.
        target: (12,). out: (12,), written; another array.
    """
    n = fixed.shape[0] - 1
    one, two, g = np.empty(12), np.empty(12), np.empty(12)
    inverse(fixed[0], one)
    times(one, target, g)
    put(fixed[1], one)
    for i in range(2, n + 1):
        times(one, fixed[i], two)
        put(two, one)
    if not height:
        g[11] = one[11]
    angle = turn_about_z(g, one)
    c, s = math.cos(angle), math.sin(angle)
    for j in range(3):
        x, y = one[j], one[4 + j]
        g[j], g[4 + j], g[8 + j] = c * x - s * y, s * x + c * y, one[8 + j]
    times(fixed[0], g, out)


@kernel
def reversed_chain(fixed, prismatic, fixed_out, prismatic_out):  # type: ignore[no-untyped-def]
    """The same arm from tool to base: T^-1, with joints n..1 at minus their values."""
    n = prismatic.shape[0]
    for i in range(n + 1):
        inverse(fixed[n - i], fixed_out[i])
    for i in range(n):
        prismatic_out[i] = prismatic[n - 1 - i]
