"""Texts of what is asked for each link: derived, and slips are told in the line."""

from __future__ import annotations

import numpy as np
import pytest

import kinlab as kl
from kinlab.doctor.derived import derivation
from kinlab.doctor.examine import prepare
from kinlab.formulas import tree

QUANTITIES = (
    "com_jacobians",
    "link_transforms",
    "com_accelerations",
    "link_velocities",
    "link_accelerations",
)


@pytest.mark.parametrize("robot", ["planar2r", "planar3r", "spatial3r", "single_link", "scara"])
@pytest.mark.parametrize("quantity", QUANTITIES)
def test_what_is_derived_is_what_the_engine_has(robot: str, quantity: str) -> None:
    arm = kl.load(robot)
    case, engine = prepare(arm, quantity, (), 10, 3)
    derived = derivation(arm.table, quantity)
    if derived is None:  # frames that are not those of the joints
        assert robot in ("single_link", "scara")
        assert quantity not in ("com_jacobians", "link_transforms")
        return
    at = derived.environment(case.arguments)
    shape = engine.shape[1:]
    assert np.shape(derived.polys) == shape
    for k in np.ndindex(shape):
        value = tree.evaluate(derived.tree(derived.entry(k)), at)
        np.testing.assert_allclose(value, engine[(slice(None), *k)], rtol=0, atol=1e-13)


@pytest.mark.parametrize(
    ("robot", "quantity", "text", "good", "slip", "kind"),
    [
        ("planar2r", "link_accelerations[1,0]", "a_x = l1*(s2*ddq1 - c2*dq1^2)", "- c2", "+ c2",
         "sign"),
        ("planar2r", "com_accelerations[0]", "[-l1*dq1^2; l1*ddq1; 0]", "dq1^2", "dq1", "power"),
        ("planar2r_rods", "com_jacobians[1]", "[-l1*s1 - l2/2*s12, -l2/2*s12; l1*c1 + l2/2*c12, "
         "l2/2*c12; 0, 0; 0, 0; 0, 0; 1, 1]", "l1*c1", "l2*c1", "index"),
        ("spatial3r", "link_transforms[2]", "[c3, -s3, 0, 0.35; 0, 0, -1, 0; s3, c3, 0, 0; "
         "0, 0, 0, 1]", "0, 0, -1, 0", "0, 0, 1, 0", "sign"),
        ("planar3r", "link_velocities[1,1]", "l1*cos(q2)*qd1", "cos", "sin", "sin/cos"),
    ],
)  # fmt: skip
def test_a_slip_is_told_in_the_line(
    robot: str, quantity: str, text: str, good: str, slip: str, kind: str
) -> None:
    assert kl.diagnose(robot, quantity, text).agrees
    found = kl.diagnose(robot, quantity, text.replace(good, slip, 1))
    assert not found.agrees
    assert found.causes[0].kinds == (kind,), found
