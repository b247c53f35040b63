"""kinlab: DH tables become URDF, load into Pinocchio, and stand beside your formulas."""

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

__version__ = "0.1.0"

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
