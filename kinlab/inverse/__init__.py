"""Inverse kinematics: one pose, many poses, all branches, along a path.

=============  ===================================================================================
module         what it holds
=============  ===================================================================================
``kernel``     The compiled search: Levenberg-Marquardt with restarts on a serial chain
``methods``    The readable search: one step of each method, and searches over Pinocchio calls on
               record
``request``    What a caller of inverse kinematics may ask for, read and refused in one place
``result``     What inverse kinematics answers: always a status and errors measured by Pinocchio
``search``     Inverse kinematics by search, of one pose or many: one pipeline
``setup``      What a search needs to know about an arm and a task, worked out once and kept
``branches/``  All solutions: closed forms by the structure of the arm, or followed by
               continuation
``postures/``  Counts of solutions, aspects, cuspidality, changes of posture and paths along
               branches
=============  ===================================================================================
"""
