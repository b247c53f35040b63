"""All solutions of one pose or many: closed forms by the structure of the axes, continuation.

================  ================================================================================
module            what it holds
================  ================================================================================
``closed_forms``  Closed forms of arms by the structure of their axes; compiled, one pose at a
                  time
``continuation``  All branches of any six-joint arm, by following them from a pose where all are
                  known
``equations``     Real roots of the equations that closed forms come down to; compiled
``families``      Infinite sets of solutions of one pose: found at singular branches, said and
                  parametrised
``names``         Names of branches: shoulder, elbow, wrist, after Lee and Ziegler (1984), from
                  the geometry
``rows``          All branches of many poses: candidates of the closed forms, sharpened, measured,
                  told apart
``solutions``     All solutions of inverse kinematics, for one pose or many, by the structure of
                  the arm
``structures``    Which closed form an arm has: from the lines of its joint axes, whatever it was
                  read from
================  ================================================================================
"""
