"""kinlab: DH tables become URDF, load into Pinocchio, and stand beside your formulas."""

from importlib import import_module
from typing import TYPE_CHECKING, Any

from kinlab.check.compare import Comparison, compare
from kinlab.engine.kinematics import jacobian_dot
from kinlab.engine.lagrange import (
    action,
    centrifugal_coefficients,
    christoffel,
    coriolis_coefficients,
    lagrange_torques,
    lagrangian,
    lagrangian_gradient,
    mass_matrix_derivatives,
    mass_matrix_dot,
    momentum,
    momentum_rate,
)
from kinlab.engine.links import (
    com_accelerations,
    com_jacobians,
    com_positions,
    inertial_wrenches,
    joint_wrenches,
    link_accelerations,
    link_kinetic_energies,
    link_poses,
    link_potential_energies,
    link_velocities,
    static_wrenches,
)
from kinlab.errors import KinlabError
from kinlab.fast.stacks import (
    coriolis_matrix,
    fk,
    forward_dynamics,
    gravity_torques,
    inverse_dynamics,
    jacobian,
    kinetic_energy,
    mass_matrix,
    potential_energy,
    statics,
)
from kinlab.fivebar import FiveBar
from kinlab.formulas.record import hand_formula
from kinlab.host.version import __version__
from kinlab.model.dh import DHLink, DHTable
from kinlab.model.extract import to_dh
from kinlab.model.library import load
from kinlab.model.link import Convention
from kinlab.model.robot import Robot
from kinlab.model.urdf_write import to_urdf

if TYPE_CHECKING:
    from kinlab.analysis.boundary import planar_boundary
    from kinlab.analysis.design import design_isotropic
    from kinlab.analysis.determinant import factored_determinant
    from kinlab.analysis.ellipsoids import ellipsoid
    from kinlab.analysis.isotropy import find_isotropic
    from kinlab.analysis.lengths import characteristic_length
    from kinlab.analysis.loci import singular_loci
    from kinlab.analysis.metrics import dexterity, manipulability
    from kinlab.analysis.nearest import nearest_singularity
    from kinlab.analysis.redundancy import redundancy
    from kinlab.analysis.sections import workspace_section
    from kinlab.analysis.singularity import describe_singularity, find_singularities
    from kinlab.doctor.tables.diagnosis import diagnose_table
    from kinlab.inverse.branches import ik_branches
    from kinlab.inverse.path import ik_path
    from kinlab.inverse.search import ik, ik_batch
    from kinlab.sweeps.run import SweepResult, sweep
    from kinlab.sweeps.workspace import WorkspaceMap, sample_workspace

_LATER = {
    "SweepResult": "kinlab.sweeps.run",
    "WorkspaceMap": "kinlab.sweeps.workspace",
    "characteristic_length": "kinlab.analysis.lengths",
    "describe_singularity": "kinlab.analysis.singularity",
    "design_isotropic": "kinlab.analysis.design",
    "dexterity": "kinlab.analysis.metrics",
    "diagnose": "kinlab.doctor.examine",
    "diagnose_table": "kinlab.doctor.tables.diagnosis",
    "ellipsoid": "kinlab.analysis.ellipsoids",
    "factored_determinant": "kinlab.analysis.determinant",
    "find_isotropic": "kinlab.analysis.isotropy",
    "find_singularities": "kinlab.analysis.singularity",
    "ik": "kinlab.inverse.search",
    "ik_batch": "kinlab.inverse.search",
    "ik_branches": "kinlab.inverse.branches",
    "ik_path": "kinlab.inverse.path",
    "manipulability": "kinlab.analysis.metrics",
    "nearest_singularity": "kinlab.analysis.nearest",
    "planar_boundary": "kinlab.analysis.boundary",
    "redundancy": "kinlab.analysis.redundancy",
    "sample_workspace": "kinlab.sweeps.workspace",
    "singular_loci": "kinlab.analysis.loci",
    "sweep": "kinlab.sweeps.run",
    "view": "kinlab.viewer.show",
    "workspace_section": "kinlab.analysis.sections",
}
"""Public names that few programs need, or whose modules import heavy packages (numba, sympy,
scipy): imported at first use."""


def __getattr__(name: str) -> Any:
    """Imports what is in ``_LATER`` when it is first asked for, and keeps it."""
    if name not in _LATER:
        raise AttributeError(f"module 'kinlab' has no attribute {name!r}")
    value = globals()[name] = getattr(import_module(_LATER[name]), name)
    return value


__all__ = [
    "Comparison",
    "Convention",
    "DHLink",
    "DHTable",
    "FiveBar",
    "KinlabError",
    "Robot",
    "SweepResult",
    "WorkspaceMap",
    "__version__",
    "action",
    "centrifugal_coefficients",
    "characteristic_length",
    "christoffel",
    "com_accelerations",
    "com_jacobians",
    "com_positions",
    "compare",
    "coriolis_coefficients",
    "coriolis_matrix",
    "describe_singularity",
    "design_isotropic",
    "dexterity",
    "diagnose",
    "diagnose_table",
    "ellipsoid",
    "factored_determinant",
    "find_isotropic",
    "find_singularities",
    "fk",
    "forward_dynamics",
    "gravity_torques",
    "hand_formula",
    "ik",
    "ik_batch",
    "ik_branches",
    "ik_path",
    "inertial_wrenches",
    "inverse_dynamics",
    "jacobian",
    "jacobian_dot",
    "joint_wrenches",
    "kinetic_energy",
    "lagrange_torques",
    "lagrangian",
    "lagrangian_gradient",
    "link_accelerations",
    "link_kinetic_energies",
    "link_poses",
    "link_potential_energies",
    "link_velocities",
    "load",
    "manipulability",
    "mass_matrix",
    "mass_matrix_derivatives",
    "mass_matrix_dot",
    "momentum",
    "momentum_rate",
    "nearest_singularity",
    "planar_boundary",
    "potential_energy",
    "redundancy",
    "sample_workspace",
    "singular_loci",
    "static_wrenches",
    "statics",
    "sweep",
    "to_dh",
    "to_urdf",
    "view",
    "workspace_section",
]
