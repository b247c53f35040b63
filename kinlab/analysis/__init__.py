"""Singularity, isotropy, manipulability and workspace of serial arms.

========================  =====================================================================
module                    what it holds
========================  =====================================================================
``task_space``            which rows of J, in which length unit; the derivative of J
``metrics``               Yoshikawa, condition, smallest singular value, Asada, isotropy index
``lengths``               the characteristic length of a mixed task
``ellipsoids``            velocity, force and dynamic ellipsoids
``redundancy``            null space and the right pseudo-inverse
``solver``                a batched Levenberg-Marquardt for small systems
``singular_set``          projection onto the singular set, and where to start
``structure``             wrist, shoulder, elbow: names from the geometry of the axes
``singularity``           ``find_singularities``
``reach``                 whether a pose is reachable within the limits, by many bounded solves
``nearest``               distance to the nearest singularity
``determinant``           det J in factors, each with its meaning
``loci``                  curves of the singular set by continuation
``isotropy_system``       J J^T = a 1 as smooth equations; ``best_condition`` where it has no zero
``isotropy``              ``find_isotropic``
``design_model``          a table with open numbers; ``design_system`` its isotropy equations
``design``                ``design_isotropic``
``workspace``             maps of reach and dexterity; ``boundary`` the planar boundary
========================  =====================================================================
"""
