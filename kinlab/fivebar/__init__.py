"""The five-bar linkage: closed form, closed chain, singularities, workspace, servo sizing.

================  ================================================================================
module            what it holds
================  ================================================================================
``linkage``       ``FiveBar``: the numbers of a linkage, and the table of its methods
``arguments``     What the functions are given: points of the plane, modes, how to refuse
``geometry``      Kinematics in closed form: poses, positions, rates, accelerations
``dynamics``      Dynamics in closed form: rods of mass, torque, mass matrix, energy, power
``metrics``       How good a pose is: determinant, condition, angles, stiffness, isotropy
``singularity``   Where the loci of singular poses are, and how far a pose is from them
``workspace``     What is reachable, and the regions free of singularities in it
``servo``         Worst case over a workspace, and the motors that meet it
``closed_chain``  The five-bar as Pinocchio sees it: a tree of four joints and one loop constraint
``simulation``    Forward dynamics and simulation of the closed chain
``export``        Files for other programs: MJCF with its loop, or URDF with a loop sidecar
``files``         Five-bars as TOML: the presets in ``robots/fivebar/`` and files of one's own
================  ================================================================================

``FiveBar`` binds the functions as methods, so ``fivebar.ik(xy)`` is ``geometry.ik(fivebar, xy)``.
The closed form (geometry, dynamics, metrics) and the closed chain (closed_chain, simulation) do
not know each other: each is an oracle for the other.
"""

from kinlab.fivebar.linkage import FiveBar

__all__ = ["FiveBar"]
