"""Motions of an arm: planned between joint positions or along paths of the tool, and judged.

================  ================================================================================
module            what it holds
================  ================================================================================
``checks``        What a motion meets on its way: limits, singularities, changes of branch; said
                  where and when
``follow``        Joint positions along a way of the tool: on one branch, clear of singularities,
                  or refused
``jerk_limited``  Jerk-limited motions from point to point by ruckig (the optional extra
                  ``motion``)
``joint_space``   Motions between joint positions: trapezoid, quintic, spline, jerk-limited,
                  time-optimal
``limits``        Limits of a motion: read at the door, held exactly, and what would hold them
                  where they break
``paths``         Paths of the tool in space: lines and arcs from pose to pose, blended where they
                  meet
``record``        ``Motion``: joint positions, velocities and accelerations over time, exact
                  between the samples
``simulation``    Motion under torques: an arm or a five-bar in time, with friction, and its balance
                  of energy
``time_optimal``  Time-optimal motions along a path in joint space by toppra (the optional extra
                  ``motion``)
``tool_space``    Motions of the tool: straight lines with slerp, arcs, blends; joints by inverse
                  kinematics
================  ================================================================================
"""

from kinlab.motion.checks import Finding, MotionCheck, check
from kinlab.motion.joint_space import joint
from kinlab.motion.paths import Arc
from kinlab.motion.record import Motion, from_samples, read_motion
from kinlab.motion.tool_space import cartesian

__all__ = [
    "Arc",
    "Finding",
    "Motion",
    "MotionCheck",
    "cartesian",
    "check",
    "from_samples",
    "joint",
    "read_motion",
]
