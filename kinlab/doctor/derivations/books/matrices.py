"""The links' matrices, entry by entry and as products."""

from __future__ import annotations

STANDARD = """
    # the link's matrix
    A[i] = [[ct, -st*ca, st*sa, a[i]*ct],
            [st, ct*ca, -ct*sa, a[i]*st],
            [0, sa, ca, dd],
            [0, 0, 0, 1]]
"""
MODIFIED = """
    # the link's matrix
    A[i] = [[ct, -st, 0, a[i]],
            [st*ca, ct*ca, -sa, -sa*dd],
            [st*sa, ct*sa, ca, ca*dd],
            [0, 0, 0, 1]]
"""
MATRIX = """
T[0] = base
for i in outward:
    # the angle theta, with q at a hinge (revolute joint)
    th = theta[i] + q[i] if hinge[i] else theta[i]
    # the offset d, with q at a slide (prismatic joint)
    dd = d[i] if hinge[i] else d[i] + q[i]
    # the cosine and sine of theta
    ct = cos(th)
    # the cosine and sine of theta
    st = sin(th)
    # the cosine and sine of alpha
    ca = cos(alpha[i])
    # the cosine and sine of alpha
    sa = sin(alpha[i])
{matrix}
    # the product of the link transforms
    T[i] = T[i-1] @ A[i]
# the tool's pose
pose = T[n] @ tool
"""
ELEMENTARY = """
T[0] = base
for i in outward:
    # the product of the elementary transforms
    T[i] = T[i-1] @ {order}
# the tool's pose
pose = T[n] @ tool
"""


def product_of_links(standard: bool) -> str:
    """The product of link matrices, written out in the convention."""
    return MATRIX.format(matrix=STANDARD if standard else MODIFIED)


def product_of_elements(standard: bool) -> str:
    """The product of elementary transforms, in the convention's order."""
    order = "Rz[i] @ Tz[i] @ Tx[i] @ Rx[i]" if standard else "Rx[i] @ Tx[i] @ Rz[i] @ Tz[i]"
    return ELEMENTARY.format(order=f"({order})")
