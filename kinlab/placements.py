"""Where the joints and links of a DH table stand in URDF's terms.

With Tail = Tx(a) Rx(alpha) of a row (the part of its transform behind the joint):

- modified: the row's Tail stands in front of its joint, origin_i = Tail_i Rz(theta) Tz(d), and
  the URDF link frame is DH frame i;
- standard: the Tail of row i stands behind joint i, so origin_i = Tail_{i-1} Rz(theta) Tz(d),
  and DH frame i is a fixed frame behind the joint.

A standard table gives centre and inertia in DH frame i, at the *far* end of the link, so the
inertial origin in the URDF link frame is Tail_i [1 | com]. Leaving that Tail out changes no
frame, only M, g and tau.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from kinlab.arrays import Array
from kinlab.convention import Convention
from kinlab.dh import DHLink, DHTable


@dataclass(frozen=True)
class LinkPlacement:
    """Where a DH row's joint and link stand in URDF's terms.

    Attributes:
        origin: the joint in the parent's link frame, at q = 0, (4, 4).
        tail: what stands between this link frame and DH frame i, (4, 4).
    """

    origin: Array
    tail: Array


def placements(table: DHTable) -> list[LinkPlacement]:
    """The joint origins and tails of every row, by the recipe in the module's docstring."""
    result = []
    behind = np.asarray(table.base)
    for link in table.links:
        tail = _tail(link)
        joint = _screw_z(link.d, link.theta)
        if table.convention is Convention.MODIFIED:
            result.append(LinkPlacement(behind @ tail @ joint, np.eye(4)))
            behind = np.eye(4)
        else:
            result.append(LinkPlacement(behind @ joint, tail))
            behind = tail
    return result


def _tail(link: DHLink) -> Array:
    c, s = np.cos(link.alpha), np.sin(link.alpha)
    return np.array(
        [[1.0, 0.0, 0.0, link.a], [0.0, c, -s, 0.0], [0.0, s, c, 0.0], [0.0, 0.0, 0.0, 1.0]]
    )


def _screw_z(d: float, theta: float) -> Array:
    c, s = np.cos(theta), np.sin(theta)
    return np.array([[c, -s, 0.0, 0.0], [s, c, 0.0, 0.0], [0.0, 0.0, 1.0, d], [0.0, 0.0, 0.0, 1.0]])
