"""Orthogonal 3R arms of Wenger's family, and their kinematics written out by hand."""

import math

import numpy as np

import kinlab as kl

HALF = math.pi / 2


def orthogonal(d2, d3, d4, r2, r3=0.0, limit=math.pi):
    """Baili, Wenger & Chablat's arm: alpha_2 = -90, alpha_3 = 90 degrees, lengths in their names."""
    rows = [(d2, -HALF, 0.0), (d3, HALF, r2), (d4, 0.0, r3)]
    links = [
        kl.DHLink(a=a, alpha=alpha, d=d, theta=0.0, lower=-limit, upper=limit)
        for a, alpha, d in rows
    ]
    return kl.Robot.from_dh(kl.DHTable("orthogonal3r", "standard", links))


def position(d2, d3, d4, r2, q):
    """Tool positions (N, 3) for joints (N, 3), by hand."""
    q1, q2, q3 = np.moveaxis(np.asarray(q), -1, 0)
    # along: the way from axis 2 in the plane across it; y: along axis 2
    along, y = d3 + d4 * np.cos(q3), r2 + d4 * np.sin(q3)
    x, z = d2 + np.cos(q2) * along, -np.sin(q2) * along
    return np.stack([np.cos(q1) * x - np.sin(q1) * y, np.sin(q1) * x + np.cos(q1) * y, z], axis=-1)


def quartic_roots(d2, d3, d4, r2, rho, z):
    """Angles q3 of the solutions at (rho, z), from the quartic in tan(q3 / 2)."""
    # (d3 + d4 c)^2 = z^2 + (w - m c - n s)^2, all over t = tan(q3/2): c = (1-t^2)/(1+t^2)
    rho, z = float(rho), float(z)
    w = (rho**2 + z**2 - d2**2 - d3**2 - d4**2 - r2**2) / (2 * d2)
    m, n = d3 * d4 / d2, r2 * d4 / d2
    one, cos, sin = np.poly1d([1, 0, 1]), np.poly1d([-1, 0, 1]), np.poly1d([2, 0])
    equation = (d3 * one + d4 * cos) ** 2 - z**2 * one**2 - (w * one - m * cos - n * sin) ** 2
    roots = equation.roots
    return 2 * np.arctan(roots[np.abs(roots.imag) < 1e-9 * (1 + np.abs(roots))].real)


def surfaces(d3, r2):
    """Values of d4 (d2 = 1) that part the domains, from Baili, Wenger & Chablat 2004."""
    a, b = math.hypot(d3 + 1, r2), math.hypot(d3 - 1, r2)
    c1 = math.sqrt(0.5 * (d3**2 + r2**2 - ((d3**2 + r2**2) ** 2 - d3**2 + r2**2) / (a * b)))
    return c1, d3 / (1 + d3) * a, d3 / abs(d3 - 1) * b
