"""The five-bar linkage: closed form, closed chain, singularities, workspace, servo sizing.

================  ================================================================================
module            what it holds
================  ================================================================================
``arguments``     What the functions of a five-bar are given: points of the plane, modes, how to
                  refuse
``bounds/``       The worst case over a rectangle, with a proved bound
``closed_chain``  The five-bar as Pinocchio sees it: a tree of four joints and one loop constraint
``cycle``         What a path asks of a five-bar's drives: motors for a cycle's time, and the time
                  for a motor
``design/``       Dimensional synthesis: the lengths of a five-bar for a rectangle
``dynamics``      Dynamics of a five-bar in closed form: rods of mass, torque, mass matrix, energy
                  and power
``export``        A five-bar as files for other programs: MJCF with its loop, or URDF with a loop
                  sidecar
``files``         Five-bars as TOML: the presets in ``robots/fivebar/`` and files of one's own
``geometry``      Kinematics of a five-bar in closed form: positions, rates, accelerations
``linkage``       ``FiveBar``: the numbers of a five-bar linkage, and the table of its methods
``metrics``       How good a pose of a five-bar is: determinant, condition, angles, stiffness,
                  isotropy
``servo``         Servo sizing of a five-bar: the worst case over a workspace, and the motors that
                  meet it
``simulation``    Forward dynamics and simulation of the closed chain with Pinocchio's constraint
                  solver
``singularity``   Where a five-bar is singular, and how far a pose is from the three kinds of
                  singularity
``workspace``     The workspace of a five-bar: what is reachable, and the regions free of
                  singularities
================  ================================================================================

``FiveBar`` binds the functions as methods, so ``fivebar.ik(xy)`` is ``geometry.ik(fivebar, xy)``.
The closed form (geometry, dynamics, metrics) and the closed chain (closed_chain, simulation) do
not know each other: each is an oracle for the other.
"""

from kinlab.fivebar.linkage import FiveBar

__all__ = ["FiveBar"]
