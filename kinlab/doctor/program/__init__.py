"""A student's Python function, read: which edit of which line makes it right.

================  =================================================================================
module            what it holds
================  =================================================================================
``additions``     What may be missing in a program: a sign, a transpose, a factor, a matrix, a term
``data``          The numbers of a program: those in its text, and those in the data that it uses
``elsewhere``     The lines of a function that lives in another process
``edits``         What could stand in a place of a program instead
``kept``          What a program's data hold, so that what an edited run writes into them is put
                  back
``named``         What the pieces of a program around an edit are: ``z`` is the axis of joint 2
``observed``      What every expression of a program was when it ran: its values, their shapes
``operators``     Single expressions of a program otherwise: their operators, calls, indices, names,
                  numbers
``places``        The places of a program, and what is put there instead
``read``          The functions that a formula is made of, as syntax trees, and the data they use
``repair``        The edits that make a program right
``several``       Two or three edits that together make a program right
``trial``         A program run with edits in it
``words``         A repair in words: the line, what stands there, what should
================  =================================================================================
"""
