"""Inverse kinematics: one pose, many poses, all branches, along a path.

================  ================================================================================
module            what it holds
================  ================================================================================
``branch_names``  Names of branches: shoulder, elbow, wrist, after Lee and Ziegler (1984), from
                  the geometry
``branch_rows``   All branches of many poses: candidates of the closed forms, sharpened, measured,
                  told apart
``branches``      All solutions of inverse kinematics, for one pose or many, by the structure of
                  the arm
``closed_forms``  Closed forms of arms by the structure of their axes; compiled, one pose at a
                  time
``continuation``  All branches of any six-joint arm, by following them from a pose where all are
                  known
``equations``     Real roots of the equations that closed forms come down to; compiled
``families``      Infinite sets of solutions of one pose: found at singular branches, said and
                  parametrised
``kernel``        The compiled search: Levenberg-Marquardt with restarts on a serial chain
``methods``       The readable search: one step of each method, and searches over Pinocchio calls
                  on record
``request``       What a caller of inverse kinematics may ask for, read and refused in one place
``result``        What inverse kinematics answers: always a status and errors measured by
                  Pinocchio
``search``        Inverse kinematics by search, of one pose or many: one pipeline
``setup``         What a search needs to know about an arm and a task, worked out once and kept
``structures``    Which closed form an arm has: from the lines of its joint axes, whatever it was
                  read from
``postures/``     Counts of solutions, aspects, cuspidality, changes of posture and paths along
                  branches
================  ================================================================================
"""
