"""Singularity, isotropy, manipulability and workspace of serial arms.

==================  ==============================================================================
module              what it holds
==================  ==============================================================================
``best_condition``  The least condition number an arm can reach, by smooth minimisation from many
                    starts
``boundary``        The boundary of a planar arm's workspace as exact circular arcs, joint limits
                    included
``certified``       The nearest common zero of a few functions, by branch and bound: a point, and
                    a proved bound
``design``          Link lengths and twists that make an arm isotropic, solved together with the
                    configuration
``design_model``    A DH table with some of its numbers open: its Jacobian and how it changes with
                    them
``determinant``     det J in factors, each with what it means: on top of the derivation in
                    :mod:`kinlab.symbolic`
``edge``            Whether a singular configuration lies on the edge of the workspace, or the
                    tool passes on
``isotropy``        Isotropic configurations: J J^T = a 1, where the tool moves equally well in
                    every direction
``loci``            Curves of the singular set in a slice of joint space, by pseudo-arclength
                    continuation
``metrics``         Measures of dexterity from singular values, never from det(J J^T)
``minors``          The minors of J as trigonometric polynomials: where all of them vanish the arm
                    is singular
``nearest``         How far a configuration is from the nearest singular one, where that is, and
                    what is proved
``redundancy``      Redundant arms: motions that the task does not see, and the inverse that suits
                    them
``sections``        Sections of a spatial arm's workspace through the first joint's axis: edges,
                    voids, and the curves inside across which the number of solutions changes
``singular_set``    The singular set as a smooth system of equations, and where to start solving
                    it
``singularity``     Singular configurations: found from many seeds, grouped into families, each
                    with its meaning
``solver``          A batched Levenberg-Marquardt for many small systems at once, square or not
``structure/``      What kind of arm it is: tasks, search boxes, the geometry of the joint axes
==================  ==============================================================================
"""
