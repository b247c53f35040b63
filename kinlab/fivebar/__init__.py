"""The five-bar linkage: closed form, closed chain, singularities, workspace, servo sizing.

================  ================================================================================
module            what it holds
================  ================================================================================
``closed_chain``  The five-bar as Pinocchio sees it: a tree of four joints and one loop constraint
``demand``        What a rectangle, a speed and an acceleration ask of the cranks at the worst
                  place
``dynamics``      Dynamics of a five-bar in closed form: rods of mass, torque, mass matrix, energy
                  and power
``export``        A five-bar as files for other programs: MJCF with its loop, or URDF with a loop
                  sidecar
``files``         Five-bars as TOML: the presets in ``robots/fivebar/`` and files of one's own
``fitting``       One motor against what a task asks of it, and the gear ratio that suits it
``geometry``      Kinematics of a five-bar in closed form: positions, rates, accelerations
``isotropy``      Isotropic poses of a five-bar: those where the tool moves equally well in every
                  direction
``linkage``       The numbers of a five-bar linkage, checked once and then immutable
``loci``          Where a five-bar is singular: curves of the plane, by formula and by contour
``metrics``       How good a pose of a five-bar is: determinant, condition, angles, stiffness
``model``         ``FiveBar``: a linkage whose methods delegate to the free functions of this
                  package
``pose``          Poses of a five-bar: the closed-form triangles that everything else is built on
``servo``         Servo sizing of a five-bar: the worst case over a workspace, and the motors that
                  meet it
``simulation``    Forward dynamics and simulation of the closed chain with Pinocchio's constraint
                  solver
``singularity``   How far a pose of a five-bar is from the three kinds of singularity
``trajectory``    The pick-and-place cycle: up, across, down, and back, with blended corners
``workspace``     The workspace of a five-bar: what is reachable, the free room in it and its
                  bounds
================  ================================================================================
"""

from kinlab.fivebar.model import FiveBar

__all__ = ["FiveBar"]
