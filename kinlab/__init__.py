"""kinlab: DH tables become URDF, load into Pinocchio, and stand beside your formulas."""

from kinlab.convention import Convention
from kinlab.dh import DHLink, DHTable
from kinlab.errors import KinlabError

__version__ = "0.1.0"

__all__ = ["Convention", "DHLink", "DHTable", "KinlabError", "__version__"]
