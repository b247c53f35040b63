"""What the mass of a rod does at its two ends: exact, left out, or lumped.

A rod moves as the straight line between its elbow B and the tool P, so its kinetic energy is
½ (alpha_B |v_B|² + 2 kappa v_B·v_P + alpha_C |v_P|²) with the three coefficients below, and its
weight acts as (1 - rho) of the rod at B and rho at P. Every rod model is one such row of
coefficients; only the exact one keeps kappa, the coupling that two point masses cannot have.

Source: derived here by the kinetic energy of a rigid bar; ``massless`` is Huang et al. 2005.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass

import numpy as np
from numpy.typing import ArrayLike

from kinlab.arrays import Array
from kinlab.errors import OptionError, near
from kinlab.fivebar.linkage import Linkage
from kinlab.options import shown


@dataclass(frozen=True)
class RodModel:
    """What a rod's mass does at its two ends; each entry is a pair over the legs, kg.

    Attributes:
        elbow: alpha_B, inertia of the elbow's motion.
        coupling: kappa, inertia shared by elbow and tool.
        tool: alpha_C, inertia of the tool's motion.
        elbow_weight: mass whose weight acts at the elbow.
        tool_weight: mass whose weight acts at the tool.
    """

    elbow: Array
    coupling: Array
    tool: Array
    elbow_weight: Array
    tool_weight: Array


def exact_rods(linkage: Linkage) -> RodModel:
    """alpha_B = m(1-rho)² + I/l2², alpha_C = m rho² + I/l2², kappa = m rho(1-rho) - I/l2²."""
    mass, rho = np.asarray(linkage.rod_mass), _fraction(linkage)
    spin = np.asarray(linkage.rod_inertia) / np.asarray(linkage.l2) ** 2
    return RodModel(
        elbow=mass * (1.0 - rho) ** 2 + spin,
        coupling=mass * rho * (1.0 - rho) - spin,
        tool=mass * rho**2 + spin,
        elbow_weight=mass * (1.0 - rho),
        tool_weight=mass * rho,
    )


def _fraction(linkage: Linkage) -> Array:
    rho: Array = np.asarray(linkage.rod_com) / np.asarray(linkage.l2)
    return rho


def _two_masses(linkage: Linkage, at_tool: ArrayLike) -> RodModel:
    mass = np.asarray(linkage.rod_mass)
    tool = mass * np.asarray(at_tool)
    return RodModel(mass - tool, np.zeros(2), tool, mass - tool, tool)


ROD_MODELS: dict[str, Callable[[Linkage], RodModel]] = {
    "exact": exact_rods,
    "massless": lambda linkage: RodModel(*np.zeros((5, 2))),
    "half": lambda linkage: _two_masses(linkage, 0.5),
    "third": lambda linkage: _two_masses(linkage, 1.0 / 3.0),
    "static": lambda linkage: _two_masses(linkage, _fraction(linkage)),
}
"""Models of the rods by name.

``exact``: rigid rods. ``massless``: Huang's form, rods left out. The lumpings put two point
masses in the rod's place: ``half`` ½ at the elbow and ½ at the tool, ``third`` ⅔ and ⅓ (usual
for Delta robots), ``static`` so that weight and centre are right and only inertia is not.
"""


def rod_model(linkage: Linkage, model: str) -> RodModel:
    """The coefficients of a named model.

    Raises:
        OptionError: no model of that name.
    """
    if not isinstance(model, str) or model not in ROD_MODELS:
        choices = near(model if isinstance(model, str) else "", ROD_MODELS)
        raise OptionError(f"rod model {shown(model)} does not exist; {choices}")
    return ROD_MODELS[model](linkage)
