"""``FiveBar``: a linkage whose methods delegate to the free functions of this package."""

from __future__ import annotations

from dataclasses import dataclass
from pathlib import Path
from typing import TYPE_CHECKING

from numpy.typing import ArrayLike

from kinlab.arrays import Array
from kinlab.fivebar import dynamics, files, geometry, metrics, pose
from kinlab.fivebar.linkage import Linkage
from kinlab.fivebar.pose import HANGING, Mask, Mode, OnUnreachable

if TYPE_CHECKING:
    from kinlab.drives.motors import Motor
    from kinlab.fivebar.closed_chain import ClosedChain
    from kinlab.fivebar.servo import ServoSizing


@dataclass(frozen=True, eq=False)
class FiveBar(Linkage):
    """A five-bar linkage; its data and their units are those of :class:`Linkage`.

    ``FiveBar(l1, l2, e, crank_mass, crank_com, crank_inertia, rod_mass, rod_com, rod_inertia,
    payload, rotor_inertia, gear_ratio, gravity)``, SI units, numbers or (leg 1, leg 2) pairs.
    Leg 1 is based at (+e, 0), leg 2 at (-e, 0); theta_i and u_i belong to crank i, w_i to rod i.
    A mode is (sign of u_1 x w_1, sign of u_2 x w_2); the default (-1, +1) hangs below the base
    with its elbows outward. Methods take points (2,) or (N, 2). Everything that has no method
    is a free function of ``kinlab.fivebar.*`` on a FiveBar.

    Raises:
        MechanismError: impossible lengths or masses, or lengths that cannot close.
    """

    @staticmethod
    def load(name_or_path: str | Path) -> FiveBar:
        """A preset by name, or a TOML file; see :func:`kinlab.fivebar.files.read`."""
        return FiveBar(**files.read(name_or_path))

    def save(self, path: str | Path) -> None:
        """Writes TOML that :meth:`load` reads back; see :func:`kinlab.fivebar.files.write`."""
        files.write(self, path)

    def ik(
        self, xy: ArrayLike, mode: Mode = HANGING, on_unreachable: OnUnreachable = "raise"
    ) -> Array:
        """Crank angles; see :func:`kinlab.fivebar.geometry.ik`."""
        return geometry.ik(self, xy, mode, on_unreachable)

    def fk(
        self, theta: ArrayLike, assembly: int = 1, on_unreachable: OnUnreachable = "raise"
    ) -> Array:
        """The tool; see :func:`kinlab.fivebar.geometry.fk`."""
        return geometry.fk(self, theta, assembly, on_unreachable)

    def reachable(self, xy: ArrayLike) -> Mask:
        """Which points can be reached; see :func:`kinlab.fivebar.pose.reachable`."""
        return pose.reachable(self, xy)

    def jacobian(
        self, xy: ArrayLike, mode: Mode = HANGING, on_unreachable: OnUnreachable = "raise"
    ) -> Array:
        """J of theta_dot = J v; see :func:`kinlab.fivebar.geometry.jacobian`."""
        return geometry.jacobian(self, xy, mode, on_unreachable)

    def acceleration_bias(
        self,
        xy: ArrayLike,
        v: ArrayLike,
        mode: Mode = HANGING,
        on_unreachable: OnUnreachable = "raise",
    ) -> Array:
        """f(v) of theta_ddot = J a + f; see :func:`kinlab.fivebar.geometry.acceleration_bias`."""
        return geometry.acceleration_bias(self, xy, v, mode, on_unreachable)

    def condition_number(
        self, xy: ArrayLike, mode: Mode = HANGING, on_unreachable: OnUnreachable = "raise"
    ) -> Array:
        """kappa of J; see :func:`kinlab.fivebar.metrics.condition_number`."""
        return metrics.condition_number(self, xy, mode, on_unreachable)

    def inverse_dynamics(
        self,
        xy: ArrayLike,
        v: ArrayLike,
        a: ArrayLike,
        mode: Mode = HANGING,
        model: str = "exact",
        on_unreachable: OnUnreachable = "raise",
    ) -> Array:
        """Crank torques; see :func:`kinlab.fivebar.dynamics.inverse_dynamics`."""
        return dynamics.inverse_dynamics(self, xy, v, a, mode, model, on_unreachable)

    def mass_matrix(
        self,
        xy: ArrayLike,
        mode: Mode = HANGING,
        model: str = "exact",
        on_unreachable: OnUnreachable = "raise",
    ) -> Array:
        """M of tau = M theta_ddot + h; see :func:`kinlab.fivebar.dynamics.mass_matrix`."""
        return dynamics.mass_matrix(self, xy, mode, model, on_unreachable)

    def forward_dynamics(
        self,
        xy: ArrayLike,
        v: ArrayLike,
        tau: ArrayLike,
        mode: Mode = HANGING,
        model: str = "exact",
    ) -> Array:
        """Crank accelerations; see :func:`kinlab.fivebar.dynamics.forward_dynamics`."""
        return dynamics.forward_dynamics(self, xy, v, tau, mode, model)

    def closed_chain(self) -> ClosedChain:
        """The same linkage in Pinocchio; see :mod:`kinlab.fivebar.closed_chain`."""
        from kinlab.fivebar.closed_chain import build

        return build(self)

    def size_servo(
        self,
        workspace: ArrayLike,
        v_max: float,
        a_max: float,
        motor: str | Motor | None = None,
        gear_ratio: float | None = None,
        mode: Mode = HANGING,
        efficiency: float = 0.9,
    ) -> ServoSizing:
        """Worst case over a rectangle, and motors; see :func:`kinlab.fivebar.servo.size_servo`."""
        from kinlab.fivebar.servo import size_servo

        return size_servo(self, workspace, v_max, a_max, motor, gear_ratio, mode, efficiency)
