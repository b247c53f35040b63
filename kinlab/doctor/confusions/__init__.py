"""What people take differently: a known confusion, and what the engine would say if one does.

===============  =================================================================================
module           what it holds
===============  =================================================================================
``angles``       What one can do otherwise where an angle is found: atan2, acos, roots, quotients,
                 exchanges
``books``        The textbooks' derivations as text, each written once, for any serial arm, and for
                 the five-bar
``derivations``  The textbooks' derivations walked with one step, then two or three, taken otherwise
``givens``       The numbers of an arm or a five-bar as the derivations ask for them
``known``        The table of known confusions: every reading that makes sense for a quantity
``operations``   What one can do otherwise at one operator, call, choice or matrix of a derivation
``otherwise``    What the engine says if asked otherwise: another frame, another split of C, terms
                 left out
``parts``        A formula taken apart by kind of term: what is right of it, what is not, one step
                 for each
``roads``        Which derivation gives what: a quantity's roads, each walked with any of its steps
                 otherwise
``robots``       Readings of the robot itself: convention, offsets, base and tool, gravity,
                 inertias
``steps``        Everything that one can do otherwise in one place of a derivation
``walk``         Walks a textbook's derivation, written as text, with one step or several taken
                 otherwise
``words``        The words and signs in which a derivation's expressions are told; small ways to
                 change them
===============  =================================================================================
"""
