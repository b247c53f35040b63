"""How many solutions, where, and what lies between: counts, maps, aspects, cuspidality, paths.

==================  ==============================================================================
module              what it holds
==================  ==============================================================================
``aspects``         Aspects: the regions of joint space, within the limits, that singularities do
                    not cut
``cuspidality``     Whether an arm can change its posture without meeting a singularity: cuspidal
                    arms
``nonsingular``     Paths that meet no singularity, shown between the samples too
``path``            Inverse kinematics along a path: stay on one branch, and say where that was
                    not possible
``posture_change``  Changes of posture along a path of joint positions, and whether each meets no
                    singularity
``regional``        Cusps, crossings and nodes of the singular curves of a 3R arm, by exact
                    conditions
``roadmap``         A roadmap within one side of det J: sampled joint positions, lines between
                    neighbours
``solution_count``  How many solutions a pose has, and how many each point of a section of the
                    workspace has
``solution_map``    How many solutions each point of a section of the workspace has, with its
                    singular curves
==================  ==============================================================================
"""
