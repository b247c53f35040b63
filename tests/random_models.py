"""Random chains straight in Pinocchio: joints of every kind, axes and placements at random."""

import numpy as np
import pinocchio as pin

KINDS = ["RX", "RY", "RZ", "PX", "PY", "PZ", "RevoluteUnaligned", "PrismaticUnaligned"]


def random_model(rng: np.random.Generator) -> pin.Model:
    model = pin.Model()
    parent = 0
    for i in range(int(rng.integers(1, 9))):
        kind = KINDS[int(rng.integers(len(KINDS)))]
        axis = rng.normal(size=3)
        axis /= np.linalg.norm(axis)
        make = getattr(pin, f"JointModel{kind}")
        joint = make(axis) if kind.endswith("Unaligned") else make()
        placement = pin.SE3(pin.Quaternion(rng.normal(size=4)).normalized(), rng.normal(size=3))
        parent = model.addJoint(parent, joint, placement, f"j{i}")
    tool = pin.SE3(pin.Quaternion(rng.normal(size=4)).normalized(), rng.normal(size=3))
    model.addFrame(pin.Frame("tool", parent, tool, pin.FrameType.OP_FRAME))
    return model
