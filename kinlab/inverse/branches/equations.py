"""Real roots of the equations that closed forms come down to; compiled.

Three kinds: a cos x + b sin x = c; a trigonometric polynomial of degree two (four roots at most);
a polynomial of degree four. Roots of the last two come from Aberth's simultaneous iteration
("Iteration methods for finding all zeros of a polynomial simultaneously", 1973) in the complex
plane, so that none is passed over; real ones are then sharpened on the real function itself.
"""

from __future__ import annotations

import cmath
import math

import numpy as np

from kinlab.engine.fast.compiled import kernel

_NEAR_REAL = 1e-4
"""How far from the real line, or from the unit circle, a root may lie and still be offered: a
double root is found to the square root of rounding. Forward kinematics has the last word."""

_BEYOND = 1e-9
"""Relative amount by which |c| may exceed its bound: rounding of a stretched arm, and no more than
the tolerance that the answer is measured with."""

_NOTHING = 1e-13
"""Coefficients below this share of the largest are rounding."""


@kernel
def half_angle(below, above, out):  # type: ignore[no-untyped-def]
    """x >= 0 with cos x = c / size, from size - c and size + c, without cancellation.

    Args:
        below, above: size - c and size + c.
        out: (1,), written.

    Returns:
        False where |c| is larger than the size.
    """
    size = 0.5 * (below + above)
    if not size > 0.0 or below < -_BEYOND * size or above < -_BEYOND * size:
        return False
    out[0] = 2.0 * math.atan2(math.sqrt(max(below, 0.0)), math.sqrt(max(above, 0.0)))
    return True


@kernel
def linear_trig(a, b, c, out):  # type: ignore[no-untyped-def]
    """Solutions x of a cos x + b sin x = c: atan2(b, a) +- acos(c / hypot(a, b)).

    Args:
        a, b, c: numbers.
        out: (2,), written.

    Returns:
        Their number: two (equal ones at the edge), none where |c| is larger than hypot(a, b), and
        none where a and b vanish (every x or none would do).
    """
    size = math.hypot(a, b)
    if not half_angle(size - c, size + c, out):
        return 0
    half, middle = out[0], math.atan2(b, a)
    out[0], out[1] = middle + half, middle - half
    return 2


@kernel
def _aberth(coefficients, degree, roots):  # type: ignore[no-untyped-def]
    """All complex roots of sum coefficients[i] x^i, i up to ``degree`` (at most four)."""
    lead = coefficients[degree]
    bound = 0.0
    for i in range(degree):
        size = abs(coefficients[i] / lead)
        if size > 0.0:
            bound = max(bound, size ** (1.0 / (degree - i)))
    for i in range(degree):
        roots[i] = bound * cmath.exp(1j * (2.0 * math.pi * i / degree + 0.4)) + 1e-300
    for _ in range(60):
        most = 0.0
        for i in range(degree):
            x = roots[i]
            value, slope = lead, 0.0j
            for j in range(degree - 1, -1, -1):
                slope = slope * x + value
                value = value * x + coefficients[j]
            if value == 0.0:
                continue
            pull = 0.0j
            for j in range(degree):
                if j != i and x != roots[j]:
                    pull += 1.0 / (x - roots[j])
            below = slope - value * pull
            if below == 0.0:
                continue
            change = value / below
            roots[i] = x - change
            most = max(most, abs(change) / (abs(x) + 1e-300))
        if most < 1e-14:
            break


@kernel
def trig_quartic(f, out):  # type: ignore[no-untyped-def]
    """Solutions x of f0 + f1 cos x + f2 sin x + f3 cos 2x + f4 sin 2x = 0.

    Args:
        f: (5,).
        out: (4,), written.

    Returns:
        Their number; -1 where f vanishes for every x.
    """
    largest = 0.0
    for i in range(5):
        largest = max(largest, abs(f[i]))
    if not largest > 1e-12:
        return -1
    if math.hypot(f[3], f[4]) <= _NOTHING * largest:
        if math.hypot(f[1], f[2]) <= 1e-12 * largest:
            return 0
        return linear_trig(f[1], f[2], -f[0], out)
    # a polynomial in z = exp(ix), its own mirror in the unit circle
    c = np.empty(5, np.complex128)
    c[4], c[3], c[2] = complex(f[3], -f[4]), complex(f[1], -f[2]), complex(2.0 * f[0], 0.0)
    c[1], c[0] = c[3].conjugate(), c[4].conjugate()
    roots = np.empty(4, np.complex128)
    _aberth(c, len(roots), roots)
    count = 0
    for i in range(4):
        if abs(abs(roots[i]) - 1.0) < _NEAR_REAL:
            x = math.atan2(roots[i].imag, roots[i].real)
            for _ in range(3):
                c1, s1 = math.cos(x), math.sin(x)
                c2, s2 = c1 * c1 - s1 * s1, 2.0 * s1 * c1
                value = f[0] + f[1] * c1 + f[2] * s1 + f[3] * c2 + f[4] * s2
                slope = f[2] * c1 - f[1] * s1 + 2.0 * (f[4] * c2 - f[3] * s2)
                if abs(slope) < 1e-6 * largest or abs(value) > 1e-3 * abs(slope):
                    break
                x -= value / slope
            out[count] = x
            count += 1
    return count


@kernel
def quartic(f, out):  # type: ignore[no-untyped-def]
    """Real roots of f0 + f1 x + ... + f4 x^4; as :func:`trig_quartic` otherwise."""
    largest = 0.0
    for i in range(5):
        largest = max(largest, abs(f[i]))
    if not largest > 1e-12:
        return -1
    degree = 4
    while degree > 0 and abs(f[degree]) <= _NOTHING * largest:
        degree -= 1
    if degree == 0:
        return 0
    c = f.astype(np.complex128)
    roots = np.empty(4, np.complex128)
    _aberth(c, degree, roots)
    count = 0
    for i in range(degree):
        if abs(roots[i].imag) < _NEAR_REAL * (1.0 + abs(roots[i])):
            x = roots[i].real
            for _ in range(3):
                value, slope = f[degree], 0.0
                for j in range(degree - 1, -1, -1):
                    slope = slope * x + value
                    value = value * x + f[j]
                if abs(slope) < 1e-6 * largest or abs(value) > 1e-3 * abs(slope):
                    break
                x -= value / slope
            out[count] = x
            count += 1
    return count


@kernel
def add_square(f, a, b, c, sign, slides):  # type: ignore[no-untyped-def]
    """Adds sign * (a + b c + c s)^2 to f (5,), or of (a + b x + c x^2) where the joint slides."""
    if slides:
        f[0] += sign * a * a
        f[1] += sign * 2.0 * a * b
        f[2] += sign * (b * b + 2.0 * a * c)
        f[3] += sign * 2.0 * b * c
        f[4] += sign * c * c
    else:
        f[0] += sign * (a * a + 0.5 * (b * b + c * c))
        f[1] += sign * 2.0 * a * b
        f[2] += sign * 2.0 * a * c
        f[3] += sign * 0.5 * (b * b - c * c)
        f[4] += sign * b * c


@kernel
def joint_roots(f, slides, out):  # type: ignore[no-untyped-def]
    """Roots in a joint variable; see :func:`trig_quartic` and :func:`quartic`."""
    return quartic(f, out) if slides else trig_quartic(f, out)


@kernel
def circle_pair(a, b, d, out):  # type: ignore[no-untyped-def]
    """All (x, y) with A (cos x, sin x) + B (cos y, sin y) = d (Elias and Wen, subproblem 6).

    Args:
        a, b: (2, 2). d: (2,). b does not depend on the pose, so its rank decides the road.
        out: (4, 2), written.

    Returns:
        Their number; -1 where there are infinitely many.
    """
    pair, other = np.empty(4), np.empty(4)
    det = b[0, 0] * b[1, 1] - b[0, 1] * b[1, 0]
    size = b[0, 0] ** 2 + b[0, 1] ** 2 + b[1, 0] ** 2 + b[1, 1] ** 2
    first = math.hypot(b[0, 0], b[0, 1])
    second = math.hypot(b[1, 0], b[1, 1])
    count = 0
    if size < 1e-18:
        return -1
    if abs(det) > 1e-9 * size:
        m = np.empty((3, 2))  # (cos y, sin y) = m0 + m1 cos x + m2 sin x
        for i in range(3):
            r0 = d[0] if i == 0 else -a[0, i - 1]
            r1 = d[1] if i == 0 else -a[1, i - 1]
            m[i, 0] = (b[1, 1] * r0 - b[0, 1] * r1) / det
            m[i, 1] = (b[0, 0] * r1 - b[1, 0] * r0) / det
        f = np.zeros(5)
        f[0] = -1.0
        add_square(f, m[0, 0], m[1, 0], m[2, 0], 1.0, False)
        add_square(f, m[0, 1], m[1, 1], m[2, 1], 1.0, False)
        number = trig_quartic(f, pair)
        if number < 0:
            return -1
        for i in range(number):
            c, s = math.cos(pair[i]), math.sin(pair[i])
            out[i, 0] = pair[i]
            out[i, 1] = math.atan2(
                m[0, 1] + m[1, 1] * c + m[2, 1] * s, m[0, 0] + m[1, 0] * c + m[2, 0] * s
            )
        return number
    # one combination of the rows is free of y
    keep = 0 if first >= second else 1
    drop = 1 - keep
    square = b[keep, 0] ** 2 + b[keep, 1] ** 2
    ratio = (b[keep, 0] * b[drop, 0] + b[keep, 1] * b[drop, 1]) / square
    a0, a1 = a[drop, 0] - ratio * a[keep, 0], a[drop, 1] - ratio * a[keep, 1]
    right = d[drop] - ratio * d[keep]
    if math.hypot(a0, a1) < 1e-10 * (1.0 + abs(ratio)):
        return -1 if abs(right) < 1e-9 else 0
    for i in range(linear_trig(a0, a1, right, pair)):
        c, s = math.cos(pair[i]), math.sin(pair[i])
        rest = d[keep] - a[keep, 0] * c - a[keep, 1] * s
        for j in range(linear_trig(b[keep, 0], b[keep, 1], rest, other)):
            out[count, 0], out[count, 1] = pair[i], other[j]
            count += 1
    return count
