"""The closed form of the five-bar beside Pinocchio's closed chain, with speeds and lumpings.

    python scripts/compare/compare_five_bar.py --states 1000 --points 1000000

Random linkages with unequal legs and tilted gravity, at random poses whose bars are at least
0.1 (sine) from being in line. Errors are relative to the larger of 1 and the largest entry,
except for positions, which are in metres. Exit code 1 if a figure is missed.
"""

from __future__ import annotations

import argparse
import sys
import time

import numpy as np

import kinlab as kl
from kinlab.errors import MechanismError, UnreachableError
from kinlab.fivebar.arguments import MODES
from kinlab.fivebar.dynamics import ROD_MODELS
from kinlab.fivebar.simulation import forward_dynamics

LIMITS = {
    "FK, m": 1e-12, "J": 1e-12, "theta_ddot": 1e-11, "torque, exact": 1e-11, "mass matrix": 1e-12,
    "kinetic energy": 1e-12, "potential energy": 1e-12, "forward dynamics": 1e-9,
}  # fmt: skip


def random_linkage(rng: np.random.Generator) -> kl.FiveBar:
    """Unequal legs, masses off the middle, geared rotors, gravity in any direction."""
    while True:
        try:
            return kl.FiveBar(
                rng.uniform(0.1, 0.5, 2), rng.uniform(0.2, 0.8, 2), rng.uniform(0.0, 0.3),
                rng.uniform(0.1, 2.0, 2), rng.uniform(-0.1, 0.3, 2), rng.uniform(1e-3, 0.05, 2),
                rng.uniform(0.1, 2.0, 2), rng.uniform(0.0, 0.5, 2), rng.uniform(1e-3, 0.05, 2),
                rng.uniform(0.1, 3.0), rng.uniform(0.0, 1e-3, 2), rng.uniform(1.0, 10.0, 2),
                rng.uniform(-10.0, 10.0, 2),
            )  # fmt: skip
        except MechanismError:
            continue


def random_pose(chain, rng):
    """A closed pose drawn in the crank angles, its tool, its mode and its assembly."""
    while True:
        assembly = int(rng.choice([-1, 1]))
        try:
            q = chain.assemble(rng.uniform(-np.pi, np.pi, 2), assembly)
        except UnreachableError:
            continue
        sines = np.sin([q[1], q[3], q[2] + q[3] - q[0] - q[1]])
        if np.abs(sines).min() > 0.1:
            return q, chain.fk(q), tuple(np.sign(sines[:2]).astype(int)), assembly


def gap(one, two, floor=1.0):
    return float(np.max(np.abs(one - two)) / max(floor, np.max(np.abs(two))))


def compare(states: int, seed: int) -> dict[str, float]:
    rng = np.random.default_rng(seed)
    worst = dict.fromkeys(LIMITS, 0.0)
    for _ in range(states):
        linkage = random_linkage(rng)
        chain = linkage.closed_chain()
        q, xy, mode, assembly = random_pose(chain, rng)
        v, a = rng.uniform(-1, 1, 2), rng.uniform(-10, 10, 2)
        qd = chain.joint_rates(q, v)
        qdd = chain.joint_accelerations(q, qd, a)
        tau = linkage.inverse_dynamics(xy, v, a, mode)
        turn = linkage.joint_accelerations(xy, v, a, mode)
        kinetic, potential = chain.energy(q, qd)
        found = {
            "FK, m": float(np.abs(linkage.fk(q[[0, 2]], assembly) - xy).max()),
            "J": gap(linkage.jacobian(xy, mode), chain.jacobian(q)),
            "theta_ddot": gap(turn, qdd[[0, 2]]),
            "torque, exact": gap(tau, chain.inverse_dynamics(q, qd, qdd)),
            "mass matrix": gap(linkage.mass_matrix(xy, mode), chain.mass_matrix(q)),
            "kinetic energy": gap(linkage.kinetic_energy(xy, v, mode), kinetic),
            "potential energy": gap(linkage.potential_energy(xy, mode), potential),
            "forward dynamics": gap(forward_dynamics(chain, q, qd, tau)[[0, 2]], turn),
        }
        worst = {name: max(worst[name], found[name]) for name in worst}
    return worst


def round_trip(count: int, seed: int) -> None:
    linkage = kl.FiveBar.load("isotropic")
    rng = np.random.default_rng(seed)
    points = rng.uniform([-0.7, -0.85], [0.7, 0.85], (2 * count, 2))
    points = points[linkage.reachable(points)][:count]
    print(f"\nIK and FK, all four working modes, both assemblies, {len(points)} points")
    spent, worst, scaled = 0.0, 0.0, 0.0
    for mode in MODES:
        start = time.perf_counter()
        theta = linkage.ik(points, mode)
        tools = [linkage.fk(theta, assembly) for assembly in (1, -1)]
        spent += time.perf_counter() - start
        errors = [np.abs(tool - points).max(axis=1) for tool in tools]
        error = np.minimum(*errors)
        elbow = np.array([linkage.e, -linkage.e]) + linkage.l1 * np.exp(1j * theta)
        w = (points[:, :1] + 1j * points[:, 1:] - elbow) / linkage.l2
        rods = np.abs((np.conj(w[:, 0]) * w[:, 1]).imag)
        worst = max(worst, float(error[rods > 1e-3].max()))
        scaled = max(scaled, float((error * rods).max()))
    print(f"  worst round trip where |w1 x w2| > 1e-3: {worst:.2g} m")
    print(f"  worst |w1 x w2| times error, everywhere: {scaled:.2g} m (rounding of theta)")
    print(f"  {1e6 * spent / (8 * len(points)):.3f} µs a point, mode and assembly")


def lumpings() -> None:
    print("\nrod models against the exact one: largest torque error over 2000 random motions")
    rng = np.random.default_rng(0)
    for rods in (0.1, 0.4, 1.0):
        linkage = kl.FiveBar.load("isotropic")
        values = linkage.values()
        values |= {"rod_mass": rods, "rod_inertia": rods * 0.5**2 / 12}
        linkage = kl.FiveBar(**values)
        xy = rng.uniform([-0.3, -0.65], [0.3, -0.35], (2000, 2))
        v, a = rng.uniform(-2, 2, (2000, 2)), rng.uniform(-40, 40, (2000, 2))
        exact = linkage.inverse_dynamics(xy, v, a)
        line = []
        for model in ROD_MODELS:
            error = np.abs(linkage.inverse_dynamics(xy, v, a, model=model) - exact).max()
            line.append(f"{model} {100 * error / np.abs(exact).max():.1f} %")
        print(f"  rods of {rods:g} kg, payload 1 kg: " + ", ".join(line))


def fall() -> bool:
    linkage = kl.FiveBar((0.3, 0.28), (0.5, 0.52), 0.14, 1.0, 0.15, 0.0075, 0.5, 0.25, 0.0104, 1.0)
    chain = linkage.closed_chain()
    motion = kl.simulate(linkage, linkage.ik([0.1, -0.5]), duration=3.0, step=1e-3)
    drift = float(np.ptp(motion.energy))
    open_by = max(float(np.linalg.norm(chain.closure(q)[0])) for q in motion.q)
    print(f"\nfree fall, 3 s, sampled at 1 ms: energy drift {drift:.2g} J, closure {open_by:.2g} m")
    return drift <= 5e-6 and open_by <= 1e-12


def main() -> int:
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--states", type=int, default=1000)
    parser.add_argument("--points", type=int, default=1_000_000)
    parser.add_argument("--seed", type=int, default=0)
    options = parser.parse_args()
    worst = compare(options.states, options.seed)
    print(f"closed form against Pinocchio's closed chain, {options.states} states, worst error")
    for name, error in worst.items():
        verdict = "agrees" if error <= LIMITS[name] else "MISSES"
        print(f"  {name:18} {error:8.2g}  limit {LIMITS[name]:.0e}  {verdict}")
    round_trip(options.points, options.seed)
    lumpings()
    fine = fall()
    return 0 if fine and all(worst[name] <= LIMITS[name] for name in LIMITS) else 1


if __name__ == "__main__":
    sys.exit(main())
