"""kinlab: DH tables become URDF, load into Pinocchio, and stand beside your formulas."""

from importlib import import_module
from typing import TYPE_CHECKING, Any

from kinlab.convention import Convention
from kinlab.dh import DHLink, DHTable
from kinlab.dynamics import (
    coriolis_matrix,
    forward_dynamics,
    gravity_torques,
    inverse_dynamics,
    kinetic_energy,
    mass_matrix,
    potential_energy,
)
from kinlab.errors import KinlabError
from kinlab.extract import to_dh
from kinlab.fivebar import FiveBar
from kinlab.kinematics import fk, jacobian, jacobian_dot, statics
from kinlab.library import load
from kinlab.robot import Robot
from kinlab.urdf import to_urdf

if TYPE_CHECKING:
    from kinlab.inverse.batch import ik_batch
    from kinlab.inverse.single import ik

__version__ = "0.1.0"

_LATER = {
    "ik": "kinlab.inverse.single",
    "ik_batch": "kinlab.inverse.batch",
}
"""Public names whose modules import heavy packages (numba): imported at first use."""


def __getattr__(name: str) -> Any:
    """Imports what is in ``_LATER`` when it is first asked for, and keeps it."""
    if name not in _LATER:
        raise AttributeError(f"module 'kinlab' has no attribute {name!r}")
    value = globals()[name] = getattr(import_module(_LATER[name]), name)
    return value


__all__ = [
    "Convention",
    "DHLink",
    "DHTable",
    "FiveBar",
    "KinlabError",
    "Robot",
    "__version__",
    "coriolis_matrix",
    "fk",
    "forward_dynamics",
    "gravity_torques",
    "ik",
    "ik_batch",
    "inverse_dynamics",
    "jacobian",
    "jacobian_dot",
    "kinetic_energy",
    "load",
    "mass_matrix",
    "potential_energy",
    "statics",
    "to_dh",
    "to_urdf",
]
