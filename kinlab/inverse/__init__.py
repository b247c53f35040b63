"""Inverse kinematics: one pose, many poses, all branches, along a path.

==================  ==============================================================================
module              what it holds
==================  ==============================================================================
``aspects``         Aspects: the regions of joint space, within the limits, that singularities do
                    not cut
``branch_names``    Names of branches: shoulder, elbow, wrist, after Lee and Ziegler (1984), from
                    the geometry
``branch_rows``     All branches of many poses: candidates of the closed forms, sharpened,
                    measured, told apart
``branches``        All solutions of inverse kinematics, for one pose or many, by the structure of
                    the arm
``closed_forms``    Closed forms of arms by the structure of their axes; compiled, one pose at a
                    time
``continuation``    All branches of any six-joint arm, by following them from a pose where all are
                    known
``cuspidality``     Whether an arm can change its posture without meeting a singularity: cuspidal
                    arms
``equations``       Real roots of the equations that closed forms come down to; compiled
``families``        Infinite sets of solutions of one pose: found at singular branches, said and
                    parametrised
``kernel``          The compiled search: Levenberg-Marquardt with restarts on a serial chain
``methods``         The readable search: one step of each method, and searches over Pinocchio
                    calls on record
``nonsingular``     Paths that meet no singularity, shown between the samples too
``path``            Inverse kinematics along a path: stay on one branch, and say where that was
                    not possible
``posture_change``  Changes of posture along a path of joint positions, and whether each meets no
                    singularity
``regional``        Cusps, crossings and nodes of the singular curves of a 3R arm, by exact
                    conditions
``request``         What a caller of inverse kinematics may ask for, read and refused in one place
``result``          What inverse kinematics answers: always a status and errors measured by
                    Pinocchio
``roadmap``         A roadmap within one side of det J: sampled joint positions, lines between
                    neighbours
``search``          Inverse kinematics by search, of one pose or many: one pipeline
``setup``           What a search needs to know about an arm and a task, worked out once and kept
``solution_count``  How many solutions a pose has, and how many each point of a section of the
                    workspace has
``solution_map``    How many solutions each point of a section of the workspace has, with its
                    singular curves
``structures``      Which closed form an arm has: from the lines of its joint axes, whatever it
                    was read from
==================  ==============================================================================
"""
