"""Forward dynamics and simulation of the closed chain with Pinocchio's constraint solver.

Two things in Pinocchio 4.1 give NaN or nonsense without a word, and are guarded here: the
default proximal settings (the planar anchor has rank 2 of 3; mu = 1e-12 with 20 iterations
reaches 4e-15), and a tree whose mass matrix is singular. The solver's own residual does not
vanish at a correct solution, so the loop's acceleration is checked instead.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from typing import Any

import numpy as np
import pinocchio as pin
from numpy.typing import ArrayLike

from kinlab.arrays import Array, shaped
from kinlab.engine.integrator import integrate
from kinlab.errors import InertiaError, SingularError
from kinlab.fivebar.closed_chain import CRANKS, ClosedChain
from kinlab.tolerances import TOLERANCES

Torque = Callable[[float, Array, Array], ArrayLike]


@dataclass(frozen=True)
class LoopMotion:
    """A simulated motion of K steps.

    Attributes:
        t: (K+1,), s.
        q: all four joints, (K+1, 4), rad.
        qd: (K+1, 4), rad/s. qdd: (K+1, 4), rad/s².
        tau: at the cranks, (K+1, 2), N m. work: by them, (K+1,), J.
        energy: kinetic plus potential, (K+1,), J.
    """

    t: Array
    q: Array
    qd: Array
    qdd: Array
    tau: Array
    work: Array
    energy: Array


class ConstraintSolver:
    """Scratch memory for repeated calls of Pinocchio's constraint dynamics on one chain."""

    def __init__(self, chain: ClosedChain) -> None:
        model, anchor = chain.model, chain.anchor
        self._chain = chain
        self._data = model.createData()
        contact = pin.RigidConstraintModel(
            pin.ContactType.CONTACT_3D,
            model,
            anchor.joint1_id,
            anchor.joint1_placement,
            anchor.joint2_id,
            anchor.joint2_placement,
            pin.ReferenceFrame.LOCAL,
        )
        self._models: Any = pin.StdVec_RigidConstraintModel()
        self._models.append(contact)
        self._datas: Any = pin.StdVec_RigidConstraintData()
        self._datas.append(self._models[0].createData())  # append copies
        pin.initConstraintDynamics(model, self._data, self._models, self._datas)
        self._refuse_massless(model)

    def _refuse_massless(self, model: Any) -> None:
        mass = pin.crba(model, model.createData(), np.zeros(model.nv))
        least = np.linalg.eigvalsh(np.triu(mass) + np.triu(mass, 1).T)
        if least[0] <= TOLERANCES.massless * abs(least[-1]):
            raise InertiaError(
                f"{self._chain.linkage.name}: the mass matrix of the open tree is singular "
                "(a rod without mass moves at no cost once the loop is cut); give both rods a "
                "mass or an inertia, or use the closed form, forward_dynamics(xy, v, tau)"
            )

    def solve(self, q: Array, qd: Array, tau: Array) -> Array:
        """qdd under crank torques, (4,), rad/s², at a state that may be slightly off the loop.

        Raises:
            SingularError: the solver returned NaN.
        """
        full = np.zeros(4)
        full[[*CRANKS]] = tau
        settings = pin.ProximalSettings(1e-12, 1e-12, 1e-10, 20)
        qdd = np.array(
            pin.constraintDynamics(
                self._chain.model, self._data, q, qd, full, self._models, self._datas, settings
            )
        )
        if not np.isfinite(qdd).all():
            raise self._open(q, np.nan)
        return qdd

    def acceleration(self, q: Array, qd: Array, tau: Array) -> Array:
        """As :meth:`solve`, for a state on the loop, with the loop's acceleration checked.

        Raises:
            SingularError: the solver does not keep the loop closed.
        """
        qdd = self.solve(q, qd, tau)
        _, rows = self._chain.closure(q)
        bias = self._chain.closure_bias(q, qd)
        left = float(np.linalg.norm(rows @ qdd + bias))
        scale = np.linalg.norm(bias) + np.linalg.norm(qdd) * self._chain.size
        if left > TOLERANCES.loop_acceleration * scale:
            raise self._open(q, left)
        return qdd

    def _open(self, q: Array, left: float) -> SingularError:
        return SingularError(
            f"{self._chain.linkage.name}: the constraint solver left the loop open by {left:.3g} "
            f"m/s^2 at q = {np.array2string(q, precision=6)}; the state is off the loop, or "
            "singular in both ways"
        )


def forward_dynamics(chain: ClosedChain, q: ArrayLike, qd: ArrayLike, tau: ArrayLike) -> Array:
    """All joint accelerations under crank torques, by ``pin.constraintDynamics``.

    Args:
        chain: from ``FiveBar.closed_chain()``.
        q: a closed pose, (4,), rad. qd: rates that keep the loop, (4,), rad/s.
        tau: crank torques, (2,), N m.

    Returns:
        (4,), rad/s²; exists at type II singularities too.

    Raises:
        StateError: another shape, or not finite.
        InertiaError: a rod without mass.
        SingularError: the loop has no unique motion.
    """
    name = chain.linkage.name
    pose, rates = shaped(q, (4,), f"{name}: q"), shaped(qd, (4,), f"{name}: qd")
    return ConstraintSolver(chain).acceleration(pose, rates, shaped(tau, (2,), f"{name}: tau"))


def follow(
    chain: ClosedChain,
    q: Array,
    qd: Array,
    times: Array,
    torque: Callable[[float, Array, Array], Array],
) -> LoopMotion:
    """Integrates the loop with adaptive steps, putting position and velocity back onto it.

    Args:
        chain: from ``FiveBar.closed_chain()``.
        q: a closed pose, (4,), rad. qd: rates that keep the loop, (4,), rad/s.
        times: of the answers, (K+1,), s.
        torque: crank torques (2,) from (t, q, qd).

    Raises:
        OptionError: torques too stiff to integrate.
        InertiaError, SingularError: as :func:`forward_dynamics`.
    """
    solver = ConstraintSolver(chain)

    def slope(t: float, state: Array) -> Array:
        at, rate = state[:4], state[4:8]
        tau = torque(t, at, rate)
        power = float(tau @ rate[[*CRANKS]])
        return np.concatenate([rate, solver.solve(at, rate, tau), [power]])

    def settle(state: Array) -> Array:
        return np.append(_project(chain, state[:8]), state[8])

    start = settle(np.concatenate([q, qd, [0.0]]))
    solver.acceleration(start[:4], start[4:8], torque(float(times[0]), start[:4], start[4:8]))
    rows = integrate(slope, start, times, settle=settle).rows
    places, rates = rows[:, :4], rows[:, 4:8]
    tau = np.array([torque(t, *x) for t, *x in zip(times, places, rates, strict=True)])
    return LoopMotion(
        t=times,
        q=places,
        qd=rates,
        qdd=np.array([solver.acceleration(*x) for x in zip(places, rates, tau, strict=True)]),
        tau=tau,
        work=rows[:, 8],
        energy=np.array([sum(chain.energy(*x)) for x in zip(places, rates, strict=True)]),
    )


def _project(chain: ClosedChain, state: Array) -> Array:
    """The nearest closed pose, and the nearest rates that keep it closed."""
    q, qd = state[:4].copy(), state[4:]
    for _ in range(10):
        error, rows = chain.closure(q)
        if np.linalg.norm(error) <= 1e-2 * TOLERANCES.closure * chain.size:
            break
        q -= np.linalg.pinv(rows) @ error
    _, rows = chain.closure(q)
    return np.concatenate([q, qd - np.linalg.pinv(rows) @ (rows @ qd)])
