"""Singularity, isotropy, manipulability and workspace of serial arms.

=========================  =======================================================================
module                     what it holds
=========================  =======================================================================
``characteristic_length``  The characteristic length of a mixed task: the one that makes J best
                           conditioned at a q
``ellipsoids``             Velocity, force and dynamic ellipsoids: principal axes and lengths from
                           singular values
``metrics``                Measures of dexterity from singular values, never from det(J J^T)
``redundancy``             Redundant arms: motions that the task does not see, and the inverse that
                           suits them
``solver``                 A batched Levenberg-Marquardt for many small systems at once, square or
                           not
``isotropy/``              Isotropic configurations, the least condition number, and designs that
                           are isotropic
``singularities/``         Singular configurations: families, loci, factors of det J, edges, the
                           nearest one
``structure/``             What kind of arm it is: tasks, search boxes, the geometry of the joint
                           axes
``workspace/``             Exact boundary of planar arms, sections of spatial ones
=========================  =======================================================================
"""
