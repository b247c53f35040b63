"""Dynamics of the five-bar against a Lagrangian derived from nothing but the drawing.

The oracle places the masses by intersecting circles with 50-digit numbers, and takes every
derivative by differences that are exact to 20 digits. It shares no formula with the package.
"""

from __future__ import annotations

import mpmath
import numpy as np
import pytest
from fivebars import random_fivebar, random_state

import kinlab as kl
from kinlab.errors import InertiaError
from kinlab.fivebar.dynamics import ROD_MODELS

STEP = mpmath.mpf(10) ** -16


@pytest.fixture(autouse=True)
def fifty_digits():
    with mpmath.workdps(50):
        yield


class Lagrangian:
    """T and U of a linkage in its crank angles, and Lagrange's equation by differences."""

    def __init__(self, fivebar, assembly):
        self.f, self.assembly = fivebar, assembly

    def places(self, theta):
        """Centres of mass and tool as complex numbers, and the four bars' angles."""
        f = self.f
        base = [mpmath.mpf(f.e), -mpmath.mpf(f.e)]
        l1, l2 = [[mpmath.mpf(float(x)) for x in pair] for pair in (f.l1, f.l2)]
        unit = [mpmath.expj(t) for t in theta]
        elbow = [b + a * u for b, a, u in zip(base, l1, unit, strict=True)]
        span = elbow[1] - elbow[0]
        d = abs(span)
        along = (d**2 + l2[0] ** 2 - l2[1] ** 2) / (2 * d)
        height = mpmath.sqrt(l2[0] ** 2 - along**2) * self.assembly
        tool = elbow[0] + span / d * (along + 1j * height)
        rod = [(tool - b) / a for b, a in zip(elbow, l2, strict=True)]
        centres = []
        for i in range(2):
            centres.append(base[i] + mpmath.mpf(float(f.crank_com[i])) * unit[i])
            centres.append(elbow[i] + mpmath.mpf(float(f.rod_com[i])) * rod[i])
        angles = [x for i in range(2) for x in (theta[i], mpmath.arg(rod[i]))]
        return [*centres, tool], angles

    def energies(self, theta, rate):
        f = self.f
        ahead = self.places([t + r * STEP for t, r in zip(theta, rate, strict=True)])
        behind = self.places([t - r * STEP for t, r in zip(theta, rate, strict=True)])
        masses = [f.crank_mass[0], f.rod_mass[0], f.crank_mass[1], f.rod_mass[1], f.payload]
        spins = [f.crank_inertia[0], f.rod_inertia[0], f.crank_inertia[1], f.rod_inertia[1]]
        kinetic = potential = mpmath.mpf(0)
        here = self.places(theta)[0]
        for mass, a, b, at in zip(masses, ahead[0], behind[0], here, strict=True):
            kinetic += mpmath.mpf(float(mass)) / 2 * abs((a - b) / (2 * STEP)) ** 2
            pull = mpmath.mpf(float(f.gravity[0])) * at.real
            pull += mpmath.mpf(float(f.gravity[1])) * at.imag
            potential -= mpmath.mpf(float(mass)) * pull
        for spin, a, b in zip(spins, ahead[1], behind[1], strict=True):
            kinetic += mpmath.mpf(float(spin)) / 2 * ((a - b) / (2 * STEP)) ** 2
        for i in range(2):
            rotor = float(f.gear_ratio[i]) ** 2 * float(f.rotor_inertia[i])
            kinetic += mpmath.mpf(rotor) / 2 * rate[i] ** 2
        return kinetic, potential

    def torque(self, theta, rate, turn):
        """d/dt dL/d(rate) - dL/d(theta) along theta + rate t + turn t²/2."""
        h = mpmath.mpf(10) ** -10
        out = []
        for i in range(2):

            def momentum(t, i=i):
                at = [a + b * t + c * t * t / 2 for a, b, c in zip(theta, rate, turn, strict=True)]
                speed = [b + c * t for b, c in zip(rate, turn, strict=True)]
                up, down = list(speed), list(speed)
                up[i] += 1
                down[i] -= 1  # T is quadratic in the rates: this difference is exact
                return (self.energies(at, up)[0] - self.energies(at, down)[0]) / 2

            def lagrangian(x, i=i):
                at = list(theta)
                at[i] += x
                kinetic, potential = self.energies(at, rate)
                return kinetic - potential

            change = (momentum(h) - momentum(-h)) / (2 * h)
            slope = (lagrangian(h) - lagrangian(-h)) / (2 * h)
            out.append(float(change - slope))
        return np.array(out)


def test_exact_torque_is_lagranges():
    rng = np.random.default_rng(7)
    for _ in range(12):
        fivebar = random_fivebar(rng)
        xy, mode, assembly = random_state(fivebar, rng, clear=0.25)
        v, a = rng.uniform(-1, 1, 2), rng.uniform(-5, 5, 2)
        theta = [mpmath.mpf(float(t)) for t in fivebar.ik(xy, mode)]
        rate = [mpmath.mpf(float(x)) for x in fivebar.joint_rates(xy, v, mode)]
        turn = [mpmath.mpf(float(x)) for x in fivebar.joint_accelerations(xy, v, a, mode)]
        oracle = Lagrangian(fivebar, assembly)
        expected = oracle.torque(theta, rate, turn)
        found = fivebar.inverse_dynamics(xy, v, a, mode)
        np.testing.assert_allclose(found, expected, rtol=0, atol=1e-12 * np.abs(expected).max())
        kinetic, potential = oracle.energies(theta, rate)
        assert abs(fivebar.kinetic_energy(xy, v, mode) - float(kinetic)) < 1e-11 * float(kinetic)
        assert abs(fivebar.potential_energy(xy, mode) - float(potential)) < 1e-11


@pytest.mark.parametrize("model", sorted(ROD_MODELS))
def test_parts_make_the_whole_in_every_model(model):
    rng = np.random.default_rng(11)
    for _ in range(30):
        fivebar = random_fivebar(rng)
        xy, mode, _ = random_state(fivebar, rng)
        v, a = rng.uniform(-1, 1, 2), rng.uniform(-5, 5, 2)
        tau = fivebar.inverse_dynamics(xy, v, a, mode, model)
        mass = fivebar.mass_matrix(xy, mode, model)
        turn = fivebar.joint_accelerations(xy, v, a, mode)
        scale = np.abs(tau).max()
        parts = mass @ turn + fivebar.bias_torques(xy, v, mode, model)
        np.testing.assert_allclose(parts, tau, atol=1e-12 * scale)
        np.testing.assert_allclose(mass, mass.T, rtol=1e-13)
        assert np.all(np.linalg.eigvalsh(mass) > 0)
        jac = fivebar.jacobian(xy, mode)
        np.testing.assert_allclose(
            fivebar.task_mass_matrix(xy, mode, model), jac.T @ mass @ jac, rtol=1e-12, atol=1e-12
        )
        rest = fivebar.inverse_dynamics(xy, [0, 0], [0, 0], mode, model)
        np.testing.assert_allclose(fivebar.gravity_torques(xy, mode, model), rest, atol=1e-12)
        back = fivebar.forward_dynamics(xy, v, tau, mode, model)
        np.testing.assert_allclose(back, turn, atol=1e-10 * np.abs(turn).max())


@pytest.mark.parametrize("model", sorted(ROD_MODELS))
def test_power_is_the_change_of_energy(model):
    """tau·theta_dot = d(T + U)/dt holds of each model with its own energies."""
    rng = np.random.default_rng(13)
    for _ in range(20):
        fivebar = random_fivebar(rng)
        xy, mode, _ = random_state(fivebar, rng, clear=0.25)
        v, a = rng.uniform(-1, 1, 2), rng.uniform(-5, 5, 2)

        def energy(t, fivebar=fivebar, xy=xy, v=v, a=a, mode=mode):
            at = xy + v * t + 0.5 * a * t * t
            return fivebar.kinetic_energy(at, v + a * t, mode, model) + fivebar.potential_energy(
                at, mode, model
            )

        h = 1e-5
        change = (8 * (energy(h) - energy(-h)) - (energy(2 * h) - energy(-2 * h))) / (12 * h)
        power = fivebar.joint_power(xy, v, a, mode, model)
        np.testing.assert_allclose(
            power, fivebar.inverse_dynamics(xy, v, a, mode, model)
            * fivebar.joint_rates(xy, v, mode), rtol=1e-14,
        )  # fmt: skip
        assert abs(power.sum() - change) < 1e-6 * max(1.0, np.abs(power).max())


def test_virtual_work_at_rest():
    """At rest the torques move no energy along any small motion: tau = dU/dtheta."""
    fivebar = kl.FiveBar.load("isotropic")
    xy, h = np.array([0.08, -0.5]), 1e-6
    slope = [
        (fivebar.potential_energy(xy + s) - fivebar.potential_energy(xy - s)) / (2 * h)
        for s in h * np.eye(2)
    ]
    expected = np.linalg.solve(fivebar.jacobian(xy).T, slope)
    np.testing.assert_allclose(fivebar.gravity_torques(xy), expected, atol=1e-8)


def test_huangs_form_is_the_limit_of_light_rods():
    """The difference falls linearly with the rods' mass and is nothing at zero."""
    rng = np.random.default_rng(17)
    for _ in range(10):
        heavy = random_fivebar(rng)
        xy, mode, _ = random_state(heavy, rng)
        v, a = rng.uniform(-1, 1, 2), rng.uniform(-5, 5, 2)
        gaps = []
        for share in (1e-3, 1e-6, 0.0):
            light = kl.FiveBar(
                **{
                    **heavy.values(),
                    "rod_mass": share * heavy.rod_mass,
                    "rod_inertia": share * heavy.rod_inertia,
                }
            )
            exact = light.inverse_dynamics(xy, v, a, mode)
            gaps.append(np.abs(exact - light.inverse_dynamics(xy, v, a, mode, "massless")).max())
        assert gaps[2] < 1e-13 * np.abs(exact).max()
        assert abs(gaps[0] / gaps[1] - 1000.0) < 1e-3 * 1000.0


def test_lumpings_are_exact_where_they_should_be_and_wrong_elsewhere():
    """A rod that is two point masses at its ends, half and half, is what "half" says it is."""
    base = {"l1": 0.3, "l2": 0.5, "e": 0.1, "crank_mass": 1.0, "crank_com": 0.1, "payload": 0.5}
    rod = {"rod_mass": 0.8, "rod_com": 0.25, "rod_inertia": 0.8 * 0.25**2}
    dumbbell = kl.FiveBar(**base, **rod)
    state = ([0.1, -0.5], [0.5, -0.3], [2.0, 1.0])
    np.testing.assert_allclose(
        dumbbell.inverse_dynamics(*state), dumbbell.inverse_dynamics(*state, model="half"),
        rtol=1e-13,
    )  # fmt: skip
    uniform = kl.FiveBar(**base, **{**rod, "rod_inertia": 0.8 * 0.5**2 / 12})
    still = ([0.1, -0.5], [0.0, 0.0], [0.0, 0.0])
    for model in ("half", "static"):  # the middle is the centre of mass: weight is right
        np.testing.assert_allclose(
            uniform.inverse_dynamics(*still), uniform.inverse_dynamics(*still, model=model)
        )
    for model in ("half", "third", "massless"):
        gap = uniform.inverse_dynamics(*state) - uniform.inverse_dynamics(*state, model=model)
        assert np.abs(gap).max() > 1e-2


def test_no_inertia_is_refused_by_forward_dynamics_only():
    bare = kl.FiveBar(0.3, 0.5, 0.1)
    assert np.all(bare.inverse_dynamics([0, -0.5], [1, 0], [1, 1]) == 0.0)
    with pytest.raises(InertiaError, match="mass matrix is singular"):
        bare.forward_dynamics([0, -0.5], [1, 0], [1, 1])


def test_horizontal_plane_needs_no_holding_torque():
    flat = kl.FiveBar(0.3, 0.5, 0.1, 1.0, 0.1, 0.01, 1.0, 0.2, 0.01, 1.0, gravity=(0, 0))
    assert np.all(flat.gravity_torques([[0.1, -0.5], [0.0, -0.6]]) == 0.0)
