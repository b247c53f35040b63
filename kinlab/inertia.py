"""What an inertia tensor can be."""

from __future__ import annotations

import numpy as np

from kinlab.arrays import Array
from kinlab.tolerances import TOLERANCES


def check_inertia(inertia: Array, place: str, error: type[Exception]) -> None:
    """Refuses a tensor that no distribution of mass can have.

    Args:
        inertia: (3, 3) about the centre of mass, kg m².
        place: what to put in front of the message.
        error: the class to raise.

    Raises:
        Exception: (the class given) not symmetric, negative, or I1 + I2 < I3 for the
            principal moments (the triangle inequality).
    """
    scale = max(float(np.max(np.abs(inertia), initial=0.0)), TOLERANCES.inertia_floor)
    skew = float(np.max(np.abs(inertia - inertia.T)))
    if skew > TOLERANCES.inertia_symmetry * scale:
        raise error(f"{place}: inertia is not symmetric (off by {skew:.3g} kg m^2)")
    principal = np.linalg.eigvalsh(0.5 * (inertia + inertia.T))
    allowance = TOLERANCES.inertia_triangle * scale
    if principal[0] < -allowance:
        raise error(
            f"{place}: inertia is not positive (a principal moment is {principal[0]:.3g} kg m^2)"
        )
    if principal[0] + principal[1] < principal[2] - allowance:
        raise error(
            f"{place}: inertia breaks the triangle inequality: principal moments "
            f"{principal[0]:.4g} + {principal[1]:.4g} < {principal[2]:.4g} kg m^2"
        )
