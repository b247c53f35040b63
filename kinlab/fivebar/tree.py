"""Builds the Pinocchio tree of a five-bar, with payload, rotors and the anchor of its loop."""

from __future__ import annotations

import numpy as np
import pinocchio as pin

from kinlab.fivebar.closed_chain import ClosedChain
from kinlab.fivebar.linkage import JOINTS, Linkage


def build(linkage: Linkage) -> ClosedChain:
    """Builds the tree, the payload and the anchor."""
    model = pin.Model()
    model.name = linkage.name
    model.gravity.linear = np.array([*np.asarray(linkage.gravity), 0.0])
    l1, l2 = np.asarray(linkage.l1), np.asarray(linkage.l2)
    rotor = np.square(linkage.gear_ratio) * np.asarray(linkage.rotor_inertia)
    ends = []
    for leg in range(2):
        base = pin.SE3(np.eye(3), np.array([linkage.base_x[leg], 0.0, 0.0]))
        elbow = pin.SE3(np.eye(3), np.array([l1[leg], 0.0, 0.0]))
        crank = model.addJoint(0, pin.JointModelRZ(), base, JOINTS[2 * leg])
        rod = model.addJoint(crank, pin.JointModelRZ(), elbow, JOINTS[2 * leg + 1])
        for joint, part in ((crank, "crank"), (rod, "rod")):
            mass, com, spin = (
                float(getattr(linkage, f"{part}_{what}")[leg])
                for what in ("mass", "com", "inertia")
            )
            body = pin.Inertia(mass, np.array([com, 0.0, 0.0]), spin * np.eye(3))
            model.appendBodyToJoint(joint, body, pin.SE3.Identity())
        model.armature[model.joints[crank].idx_v] = rotor[leg]
        ends.append((rod, pin.SE3(np.eye(3), np.array([l2[leg], 0.0, 0.0]))))
    load = pin.Inertia(linkage.payload, ends[0][1].translation, np.zeros((3, 3)))
    model.appendBodyToJoint(ends[0][0], load, pin.SE3.Identity())
    tool = model.addFrame(pin.Frame("tool", ends[0][0], *ends[0][1:], pin.FrameType.OP_FRAME))
    anchor = pin.PointAnchorConstraintModel(model, *ends[0], *ends[1])
    return ClosedChain(linkage, model, anchor, tool)
