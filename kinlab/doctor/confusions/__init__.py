"""What people take differently: a known confusion, and what the engine would say if one does.

===============  =================================================================================
module           what it holds
===============  =================================================================================
``columns``      The Jacobian column by column and the mass matrix link by link, with what people
                 do otherwise
``derivations``  The textbooks' derivations walked with one step, then two, taken otherwise
``known``        The table of known confusions: every reading that makes sense for a quantity
``links``        The product of link transforms, with what people write otherwise in the link's
                 matrix
``otherwise``    What the engine says if asked otherwise: another frame, another split of C, terms
                 left out
``recursion``    Newton-Euler as the textbooks have it, with what people do otherwise at each step
``robots``       Readings of the robot itself: convention, offsets, base and tool, gravity,
                 inertias
===============  =================================================================================
"""
