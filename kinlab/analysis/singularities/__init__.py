"""Where an arm is singular: found, described, traced, in factors, and how far away.

================  ================================================================================
module            what it holds
================  ================================================================================
``certified``     The nearest common zero of a few functions, by branch and bound: a point, and a
                  proved bound
``determinant``   det J in factors, each with what it means: on top of the derivation in
                  :mod:`kinlab.symbolic`
``edge``          Whether a singular configuration lies on the edge of the workspace, or the tool
                  passes on
``factor``        Trigonometric polynomials of a few joints, with what they leave of a box around
                  any centre
``families``      Singular configurations of an arm: found from many seeds, grouped into families
``loci``          Curves of the singular set in a slice of joint space, by pseudo-arclength
                  continuation
``minors``        The minors of J as trigonometric polynomials: where all of them vanish the arm
                  is singular
``nearest``       How far a configuration is from the nearest singular one, where that is, and
                  what is proved
``singular_set``  The singular set as a smooth system of equations, and where to start solving it
``singularity``   One singular configuration: what is lost there, which joints hold the arm, and
                  its class
================  ================================================================================
"""
