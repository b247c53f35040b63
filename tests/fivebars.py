"""Random five-bars and states for the tests, independent of the code under test."""

from __future__ import annotations

import numpy as np

import kinlab as kl
from kinlab.errors import MechanismError

MODES = [(1, 1), (1, -1), (-1, 1), (-1, -1)]


def random_fivebar(rng, *, payload=True):
    """Unequal legs, masses off the middle, tilted gravity, geared rotors."""
    while True:
        try:
            return kl.FiveBar(
                l1=rng.uniform(0.1, 0.5, 2),
                l2=rng.uniform(0.2, 0.8, 2),
                e=rng.uniform(0.0, 0.3),
                crank_mass=rng.uniform(0.1, 2.0, 2),
                crank_com=rng.uniform(-0.1, 0.3, 2),
                crank_inertia=rng.uniform(0.001, 0.05, 2),
                rod_mass=rng.uniform(0.1, 2.0, 2),
                rod_com=rng.uniform(0.0, 0.5, 2),
                rod_inertia=rng.uniform(0.001, 0.05, 2),
                payload=rng.uniform(0.1, 3.0) if payload else 0.0,
                rotor_inertia=rng.uniform(0.0, 1e-3, 2),
                gear_ratio=rng.uniform(1.0, 10.0, 2),
                gravity=rng.uniform(-10.0, 10.0, 2),
            )
        except MechanismError:
            continue


def random_state(fivebar, rng, clear=0.1):
    """A point, a mode, and the assembly there, with both kinds of sines above ``clear``.

    Sines by plain vector geometry from the crank angles, not by the module's own pose.
    """
    while True:
        xy = rng.uniform(-1.2, 1.2, 2)
        mode = MODES[rng.integers(4)]
        if not fivebar.reachable(xy):
            continue
        theta = fivebar.ik(xy, mode)
        legs, rods = bars(fivebar, theta, xy)
        if np.abs(legs).min() > clear and abs(rods) > clear:
            return xy, mode, int(np.sign(rods))


def bars(fivebar, theta, xy):
    """u_i x w_i (2,) and w_1 x w_2, from the elbows."""
    u = np.exp(1j * np.asarray(theta))
    elbow = np.array([fivebar.e, -fivebar.e]) + np.asarray(fivebar.l1) * u
    w = (complex(*xy) - elbow) / np.asarray(fivebar.l2)
    return (np.conj(u) * w).imag, (np.conj(w[0]) * w[1]).imag
