"""What people take differently: a known confusion, and what the engine would say if one does.

=============  ====================================================================================
module         what it holds
=============  ====================================================================================
``centres``    Centres of mass apart from the lengths: an arm of which lc1 is a number of its own,
               not l1/2
``known``      The table of known confusions: every reading that makes sense for a quantity
``otherwise``  What the engine says if asked otherwise: another frame, another split of C, terms
               left out
``robots``     Readings of the robot itself: convention, offsets, base and tool, gravity, inertias
``tried``      A known confusion, or two at once, held against the answers: which explain every
               state
=============  ====================================================================================
"""
