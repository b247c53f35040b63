"""The textbooks' derivations, walked with any of their steps taken otherwise.

==============  ===================================================================================
module          what it holds
==============  ===================================================================================
``across``      What one can do otherwise in several lines of a derivation at once
``angles``      What one can do otherwise where an angle is found: atan2, acos, roots, quotients,
                exchanges
``givens``      The numbers of an arm or a five-bar as the derivations ask for them
``joined``      The textbooks' derivations walked with one step, then two or three, taken otherwise
``operations``  What one can do otherwise at one operator, call, choice or matrix of a derivation
``parts``       A formula taken apart by kind of term: what is right of it, what is not, one step
                for each
``roads``       Which derivation gives what: a quantity's roads, each walked with any of its steps
                otherwise
``shown``       Whether a program computes what a derivation does where a step of it is taken
                otherwise
``steps``       Everything that one can do otherwise in one place of a derivation
``walk``        Walks a textbook's derivation, written as text, with one step or several taken
                otherwise
``words``       The words and signs in which a derivation's expressions are told; small ways to
                change them
``books/``      The derivations as text
==============  ===================================================================================
"""
